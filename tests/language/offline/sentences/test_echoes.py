"""What only says once more that something is so, or is not."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.echoes import echo, put_briefly
from parley.language.offline.words.text import plain, tokens


@pytest.mark.parametrize(
    ("said", "briefly"),
    [
        ("check the hall. if it is, go to the yard", "check the hall. if so, go to the yard"),
        ("check the hall, and if it isn't go to the yard", "check the hall, and if not go to the yard"),
        ("if there are none, come back", "if not, come back"),
        ("if there is no water in the tank, come back", "if there is no water in the tank, come back"),
        ("if there isn't any paint left, come back", "if there is not any paint left, come back"),
        ("go to it if it is dry otherwise come back", "go to it if it is dry, otherwise come back"),
        ("in that case come back, failing that go on", "if so come back, otherwise go on"),
        ("is the hall free. it is? good, then come back", "is the hall free. if so come back"),
        ("look for the broom. no luck? come back", "look for the broom. if not come back"),
        ("check the hall. if so, come back; if all is well, go on",
         "check the hall. if so, come back; otherwise, go on"),
    ],
)  # fmt: skip
def test_what_repeats_a_condition_is_said_in_two_words(said: str, briefly: str) -> None:
    assert plain(put_briefly(tokens(said), opens_command)) == briefly


@pytest.mark.parametrize(
    "said",
    [
        "if it is open go to the yard",
        "if there is milk in the hall, come back",
        "if that is done shut the gate",
        "somebody else is there",
        "if nobody is there, come back",
        "if all is well, come back",
    ],
)
def test_what_says_more_stays(said: str) -> None:
    assert plain(put_briefly(tokens(said), opens_command)) == said


@pytest.mark.parametrize(
    ("said", "kind", "holds"),
    [
        ("if you can't find it there, come back", "found", False),
        ("unless you see one, come back", "found", False),
        ("if nobody is there, come back", "present", False),
        ("if it has gone missing, come back", "found", False),
        ("if it is missing, come back", "found", False),
        ("or else come back", "else", False),
        ("should it be so, come back", "state", True),
    ],
)
def test_kinds_are_told_apart(said: str, kind: str | None, *, holds: bool) -> None:
    found = echo(tokens(said), 0, opens_command)
    assert (found.kind if found else None) == kind
    assert found is None or found.holds == holds
