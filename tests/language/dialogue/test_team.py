"""How people spread work over several robots: what is read, and what is left alone."""

from __future__ import annotations

import pytest

from parley.language.dialogue.team import Part, team_wish
from parley.language.lexicon import load_data

ROBOTS = ("Ada", "Kim")
SAYS = [(kind, say) for kind, says in load_data("team")["tests"].items() for say in says]


@pytest.mark.parametrize(("kind", "say"), SAYS)
def test_sentences_of_the_data_are_read_as_it_says(kind: str, say: str) -> None:
    wish = team_wish(say, ROBOTS)
    assert (wish.kind if wish is not None else "none") == kind
    assert team_wish(say, ("Ada",)) is None  # one robot is no team


@pytest.mark.parametrize(
    ("say", "parts"),
    [
        ("Could one of you please check the gate?", [Part("one", "check the gate")]),
        (
            "one of you fetches the box, the others wait at the dock",
            [Part("one", "fetch the box"), Part("rest", "wait at the dock")],
        ),
        (
            "Ada opens the way to the gate, Kim follows when it is there",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the gate", "Kim", after=True)],
        ),
        (
            "Ada goes to the gate. When Ada is there, Kim goes to the desk.",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the desk", "Kim", after=True)],
        ),
        (
            "Ada goes to the gate, Kim goes to the desk when Ada is there",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the desk", "Kim", after=True)],
        ),
        ("go back home, all of you", [Part("all", "go back home")]),
        ("let Kim do that", [Part("named", "", "Kim")]),
    ],
)
def test_who_does_what_is_told_apart_from_the_work(say: str, parts: list[Part]) -> None:
    wish = team_wish(say, ROBOTS)
    assert wish is not None
    assert [*wish.parts] == parts
