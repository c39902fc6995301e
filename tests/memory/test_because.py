"""Where a memory comes from, in words."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta, timezone

import pytest

from parley.memory.because import because, reasons, when
from parley.messages.memory import MemoryEntry

NOW = datetime(2026, 3, 10, 12, 0, tzinfo=UTC)


def unix_ms(moment: datetime) -> int:
    return round(moment.timestamp() * 1000)


def entry(source: str = "operator", at: datetime = NOW, **rest: str) -> MemoryEntry:
    fields = {"name": "box", "data": "The box is by the door.", "source": source, **rest}
    return MemoryEntry.model_validate({**fields, "updated_unix_ms": unix_ms(at)})


@pytest.mark.parametrize(
    ("at", "words"),
    [
        (NOW.replace(hour=10, minute=4), "at 10:04"),
        (NOW.replace(day=9, hour=23, minute=59), "yesterday at 23:59"),
        (NOW.replace(day=3), "on 3 March"),
        (NOW.replace(year=2024), "on 10 March 2024"),
    ],
)
def test_time_is_said_by_clock_and_day(at: datetime, words: str) -> None:
    assert when(entry(at=at), unix_ms(NOW), UTC) == words


def test_the_day_is_that_of_the_operator() -> None:
    east = timezone(timedelta(hours=3))
    at = NOW.replace(day=9, hour=22)
    assert when(entry(at=at), unix_ms(NOW), UTC) == "yesterday at 22:00"
    assert when(entry(at=at), unix_ms(NOW), east) == "at 01:00"


@pytest.mark.parametrize(
    ("source", "asker", "words"),
    [
        ("operator", "", "you told me"),
        ("", "Kim", "you told me"),
        ("Kim", "Kim", "you told me"),
        ("Kim", "Lee", "Kim told me"),
        ("Ada", "Kim", "I saw it"),
        ("Ada/Inspect", "", "I saw it"),
        ("Bob/Inspect", "", "Bob saw it"),
    ],
)
def test_who_said_or_saw_it_is_named_as_the_asker_would(source: str, asker: str, words: str) -> None:
    said = because(
        [entry(source)], now_unix_ms=unix_ms(NOW), asker=asker, robots=("Ada", "Bob"), robot="Ada", zone=UTC
    )
    assert said == f"I know that because {words} at 12:00."


def test_several_memories_are_named_once_each() -> None:
    entries = [entry(), entry(), entry("Kim", NOW.replace(day=9)), entry("Lee")]
    said = because(entries, now_unix_ms=unix_ms(NOW), zone=UTC)
    assert said == (
        "I know that because you told me at 12:00, Kim told me yesterday at 12:00 and Lee told me at 12:00."
    )


def test_nothing_to_found_a_reply_on_gives_no_sentence() -> None:
    assert because([], now_unix_ms=unix_ms(NOW)) == ""


def test_the_long_answer_has_the_words_themselves() -> None:
    picture = entry("Kim", type="image", info="the dock")
    said = reasons([entry(), picture], now_unix_ms=unix_ms(NOW), zone=UTC)
    assert said == (
        "Because you told me at 12:00: “The box is by the door.” "
        "Because Kim showed me at 12:00: a picture of the dock"
    )
