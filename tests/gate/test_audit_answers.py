"""Questions about who wanted what are told from all others, and answered from the log alone."""

from __future__ import annotations

from datetime import UTC, datetime

import pytest
import yaml

from parley.gate import audit_answers, audit_text
from parley.gate.audit import Head, Row, entry_of, sealed
from parley.gate.audit_answers import answer_from_log, question_of
from parley.messages.audit import AuditEntry, AuditEvent
from parley.messages.principal import Principal, person
from tests.test_sentences import ESTONIAN, SOURCE

KIM, LEE = person("Kim", device="phone"), person("Lee")


def at(hour: int, minute: int = 0) -> int:
    return int(datetime(2026, 3, 2, hour, minute, tzinfo=UTC).timestamp() * 1000)


def deed(effect: str, hour: int, graph: str, label: str, **facts: object) -> AuditEvent:
    detail = {"graph": graph, "labels": [label], **facts}
    return AuditEvent(effect=effect, robot="Ada", detail=detail, unix_ms=at(hour, 4))


ASKED = {"asked": "go to the box", "asked_by": KIM.model_dump()}
YES = {"approved_by": LEE.model_dump()}
EVENTS = [
    deed("start", 9, "a", "Look at the door"),
    deed("end", 9, "a", "Look at the door"),
    AuditEvent(
        effect="approve", by=LEE, robot="Ada", detail={"labels": ["Go to the box"]}, unix_ms=at(10, 3)
    ),
    deed("start", 10, "b", "Go to the box", **ASKED, **YES),
    AuditEvent(effect="stop", by=KIM, robot="", unix_ms=at(10, 9)),
    AuditEvent(effect="stop", by=Principal(kind="robot", name="Ada"), robot="Ada", unix_ms=at(10, 10)),
    AuditEvent(effect="stop", by=LEE, robot="Bo", unix_ms=at(10, 11)),
    AuditEvent(
        effect="reset", by=Principal(kind="engine"), robot="Ada", outcome="refused", unix_ms=at(10, 12)
    ),
]


SENT_ET = "Kim (phone) ütles mulle kell 10:04: „go to the box“. Lee ütles selle kohta jah."
DID_ET = "10:04: Ada alustas: Mine kohta box. Lee ütles selle kohta jah."


def entries(events: list[AuditEvent]) -> list[AuditEntry]:
    rows: list[Row] = []
    for event in events:
        rows.append(sealed(event, rows[-1].head if rows else Head()))
    return [entry_of(row) for row in reversed(rows)]


def answer(text: str, *, asker: str = "Pat", log: list[AuditEvent] = EVENTS) -> str | None:
    return answer_from_log(text, "Ada", entries(log), now_unix_ms=at(11), asker=asker, zone=UTC)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Who sent you there?", "Kim (phone) told me at 10:04: “go to the box”. Lee said yes to it."),
        ("why are you here", "Kim (phone) told me at 10:04: “go to the box”. Lee said yes to it."),
        ("who told you to do that?", "Kim (phone) told me at 10:04: “go to the box”. Lee said yes to it."),
        ("Who stopped you?", "Kim (phone) stopped me at 10:09."),
        ("who said yes to that?", "Lee said yes at 10:03: Go to the box."),
        ("who released you?", "I do not know: nothing about it is written down."),
        ("what did you do since ten?", "10:04: Ada began: Go to the box. Lee said yes to it."),
        (
            "What have you done today?",
            "09:04: Ada has finished: Look at the door. 10:04: Ada began: Go to the box. Lee said yes to it.",
        ),
        ("what did you do yesterday?", "Nothing about that time is written down for me."),
        ("Kes sind sinna saatis?", SENT_ET),
        ("kes käskis sul seda teha?", SENT_ET),
        ("kes su peatas?", "Kim (phone) peatas mu kell 10:09."),
        ("kes ütles sellele jah?", "Lee ütles jah kell 10:03: Mine kohta box."),
        ("mida sa täna tegid?", f"09:04: Ada tegi ära: Vaata door. {DID_ET}"),
        ("mida sa kella kümnest alates teinud oled?", DID_ET),
    ],
)  # fmt: skip
def test_the_answer_comes_from_the_log_with_time_and_name(text: str, expected: str) -> None:
    assert answer(text) == expected


def test_who_asks_is_spoken_to_and_two_without_a_name_are_not_taken_for_one() -> None:
    assert answer("who stopped you", asker="kim") == "You stopped me at 10:09."
    nameless = [AuditEvent(effect="stop", by=person(""), unix_ms=at(10))]
    assert answer("who stopped you", asker="", log=nameless) == "Somebody stopped me at 10:00."


def test_what_nobody_is_known_for_is_put_down_to_nobody() -> None:
    told = answer("who sent you there", log=[deed("start", 10, "b", "Go to the box")])
    assert told is not None
    assert "I do not know who wanted it" in told


@pytest.mark.parametrize(
    "text",
    [
        "who sent you the parcel?", "why are you here so early", "who told you that the box is red?",
        "who stopped the lift?", "what did you do with the box?", "go there",
        "who is there?", "what did you do since him", "what did you do?",
        "kes on siin?", "mida sa tegid kastiga?",
    ],
)  # fmt: skip
def test_other_questions_are_left_alone(text: str) -> None:
    assert question_of(text) is None


def test_every_sentence_about_the_log_is_there_in_estonian() -> None:
    table = yaml.safe_load((SOURCE / "sentences" / "et.yaml").read_text(encoding="utf-8"))
    assert len(table) == len(ESTONIAN)
    templates = [
        *audit_text._TEMPLATES.values(),
        *audit_answers._BY_YOU.values(),
        *audit_answers._BY_OTHERS.values(),
    ]
    assert [template for template in templates if template not in ESTONIAN] == []
