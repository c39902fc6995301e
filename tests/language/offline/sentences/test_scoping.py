"""What a denial covers, and conditions in plainer shape."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.branching import branched
from parley.language.offline.sentences.scoping import scoped
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain, tokens

STOPS = {("gate",), ("hall",), ("yard",), ("gate", "2"), ("gates",)}


def is_stop(words: Phrase) -> bool:
    return keys(bare(words)) in STOPS and all(word.is_word for word in words)


def scope(text: str) -> str:
    return plain(scoped(tokens(text), is_stop, lambda part: False).words).rstrip(" ,.").lower()


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("do not go to the gate but to the hall", "go to the hall"),
        ("don't inspect the gate, inspect the hall", "inspect the hall"),
        ("not the gate, the hall", "go to the hall"),
        ("go to the hall rather than the gate", "go to the hall"),
        ("check the hall, not the gate", "check the hall"),
        ("I would rather you checked the hall than the gate", "i would rather you checked the hall"),
        (
            "go to the hall closer to the yard than to the gate",
            "go to the hall closer to the yard than to the gate",
        ),
        ("the hall is to be aired without being swept", "the hall is to be aired"),
        ("air the hall and leave the sweeping to me", "air the hall"),
        ("do not sweep the hall, just air it", "do not sweep the hall, just air it"),
        ("neither the gate nor the yard today, just the hall", "go to the hall"),
        ("i do not want the gates checked, i want the hall checked", "check the hall"),
        ("ignore the gate and check the hall", "check the hall"),
        ("stay away from the gate and go to the hall", "go to the hall"),
        ("the gate does not need checking but the hall does", "the hall needs checking"),
        ("the gate does not have to be checked but the hall does", "the hall has to be checked"),
        ("neither yard needs a visit, only the hall does", "the hall needs a visit"),
        ("the gate needs no look but the hall does", "the hall needs a look"),
        ("i do not want the gate checked, i only want you to go there", "i only want you to go to the gate"),
        ("no need to drive all the way to the gate, the hall is enough", "drive all the way to the hall"),
        ("check the hall, nothing else", "check the hall"),
    ],
)
def test_what_is_denied_gives_way_to_what_is_wanted(text: str, meant: str) -> None:
    assert scope(text) == meant


@pytest.mark.parametrize(
    "text", ["do not go to the gate", "the gate is not open", "go to the hall but do not stop"]
)
def test_a_denial_alone_stays(text: str) -> None:
    assert scope(text) == text


def test_a_denial_of_what_is_pending_stays_for_the_plan() -> None:
    text = "not the gate, the hall"
    assert plain(scoped(tokens(text), is_stop, is_stop).words) == text


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("if nobody is in the hall go to the gate", "unless somebody is in the hall go to the gate"),
        ("if there is no light in the hall, stop", "unless there is a light in the hall, stop"),
        ("go to the hall unless somebody is in it", "go to the hall unless somebody is in the hall"),
        ("go to the hall if it is open and to the gate if it is shut",
         "if it is open, go to the hall, otherwise go to the gate"),
        ("go to the hall unless the gate is shut, check that first",
         "go to the hall unless the gate is shut"),
        ("see the gate. if open, go to the hall", "see the gate. if it is open, go to the hall"),
        ("if the gate is shut go to the hall, and if it is painted go to the yard",
         "if the gate is shut go to the hall, and if the gate is painted go to the yard"),
        ("check whether the gate is shut and go to the hall if not",
         "check whether the gate is shut. if not, go to the hall"),
        ("if the gate is shut use the yard", "if the gate is shut, go to the yard"),
        ("depending on whether the gate is shut go to the hall or to the yard",
         "if the gate is shut, go to the hall, otherwise go to the yard"),
    ],
)  # fmt: skip
def test_conditions_are_put_in_plain_shape(text: str, meant: str) -> None:
    assert plain(branched(tokens(text), is_stop)) == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (
            "is the gate wet? yes, go to the hall. no, go to the yard",
            "if so, go to the hall. if not, go to the yard.",
        ),
        (
            "is the gate wet? if so the hall, otherwise the yard",
            "if so, go to the hall. if not, go to the yard.",
        ),
        ("is the gate wet? then go to the hall", "if so, go to the hall."),
    ],
)
def test_what_hangs_on_the_answer_to_a_question_hangs_on_a_look(text: str, meant: str) -> None:
    turned = {"is the gate wet": tokens("the gate is wet")}
    read = branched(tokens(text), is_stop, lambda asked: turned[plain(asked)])
    assert plain(read) == f"check whether the gate is wet. {meant}"


def test_a_question_that_no_order_hangs_on_stays() -> None:
    text = "is the gate wet? it rained all night"
    assert plain(branched(tokens(text), is_stop, lambda asked: tokens("the gate is wet"))) == text


def test_a_message_without_a_condition_stays() -> None:
    assert (
        plain(branched(tokens("go to the hall and there to the gate"), is_stop))
        == "go to the hall and there to the gate"
    )
