"""What is a literal yes or no, and what is neither."""

from __future__ import annotations

import pytest

from parley.gate.assent import assent_of, begins_with_no, gives_up, takes_all_back


@pytest.mark.parametrize(
    "said",
    [
        "yes",
        "Yes, please!",
        "OK",
        "do it",
        "yes, Ada",
        "Jah",
        "please do",
        "yes, like that",
        "fine by me",
        "ok do it then",
    ],
)
def test_a_yes_is_a_yes(said: str) -> None:
    assert assent_of(said, ["Ada"]) is True


@pytest.mark.parametrize(
    "said",
    [
        "no",
        "No, thanks.",
        "don't",
        "please don't do it",
        "ok, leave it",
        "fine, drop it then",
        "Ei",
        "not yet",
        "No, wait!",
        "NO NO NO",
        "ära tee",
        "nah, leave it",
        "no, I changed my mind",
    ],
)
def test_a_no_is_a_no(said: str) -> None:
    assert assent_of(said, ["Ada"]) is False


@pytest.mark.parametrize(
    "said",
    [
        "yes?",
        "ok, no",
        "fine, but later",
        "yes, but go to the chair first",
        "no, the other one",
        "",
        "Ada",
        "don't stop",
        "never cancel it",
    ],
)
def test_everything_else_is_neither(said: str) -> None:
    assert assent_of(said, ["Ada"]) is None


@pytest.mark.parametrize(
    ("said", "negated"),
    [
        ("no, the other one", True),
        ("Not that one", True),
        ("ei, teine", True),
        ("now", False),
        ("nobody", False),
    ],
)
def test_whatever_begins_with_a_no_is_no_yes(said: str, negated: bool) -> None:
    assert begins_with_no(said) is negated


@pytest.mark.parametrize(
    "said",
    ["go and see", "go and check it out", "yes, have a look", "go there and look please", "Ada, check"],
)
def test_who_is_offered_a_look_may_say_yes_in_these_words(said: str) -> None:
    assert assent_of(said, ["Ada"], to_see=True) is True
    assert assent_of(said, ["Ada"]) is None


@pytest.mark.parametrize(
    "said",
    [
        "go to the desk, never mind",
        "go to the desk but never mind",
        "and bring the... no never mind",
        "can you check the, oh never mind",
        "take a picture of the desk, actually don't",
        "go to the desk, no wait, don't",
        "go to the desk. Actually no.",
        "go to the desk, no, I've changed my mind",
    ],
)
def test_all_is_taken_back_that_somebody_began_to_say(said: str) -> None:
    assert takes_all_back(said)
    assert gives_up(said)


@pytest.mark.parametrize(
    "said",
    [
        "never mind",
        "no, never mind",
        "never mind, go to the desk",
        "go to the desk, never mind the lamp",
        "if the box is shut, leave it",
        "look for the box, and if it is there, never mind",
        "tell Kim: never mind",
        "take the box or leave it",
        "are you there or no",
        "go to the desk, no",
        "scrap the whole thing, I've changed my mind",
        "shall I drop it, or no?",
    ],
)
def test_what_is_said_otherwise_is_not(said: str) -> None:
    assert not takes_all_back(said)
