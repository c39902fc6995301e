"""Words of stopping: which hold a robot, and which whole messages are no call to stop."""

from __future__ import annotations

import pytest

from parley.gate.stop_words import (
    asked_behind,
    called,
    calls_to_stop,
    has_stop_word,
    is_no,
    only_takes_back,
    opens_with_no,
)


@pytest.mark.parametrize(
    "said",
    [
        "stop", "Stop!", "please stop, Ada", "stop at once!", "you must stop now",
        "wrong way", "that's the wrong room", "you're too close", "that's not what I meant", "mind the step",
        "I want you to stop",
        "could you stop please", "there is smoke, stop everything", "don't stop!! no wait, stop",
        "be careful!",
        "that's enough", "hold on", "stand still", "don't move", "nobody move", "no one moves!",
        "don't anybody move", "halt!", "seis", "ära liigu", "стой",
        "stooop",
    ],
)  # fmt: skip
def test_a_call_holds_and_is_read_as_one(said: str) -> None:
    assert has_stop_word(said)
    assert calls_to_stop(said)


@pytest.mark.parametrize(
    "said",
    [
        "stop at the box", "don't stop", "the bus stop", "go to the door and wait there",
        "wait until Kim is back",
        "the stop button is red", "tell Kim to wait", "careful with the glass when you carry it",
        "bring enough cups", "why did you stop?", "without stopping", "go round till I say stop",
        "ära peatu", "peatu kasti juures",
    ],
)  # fmt: skip
def test_what_only_has_such_a_word_is_no_call(said: str) -> None:
    assert not calls_to_stop(said)


@pytest.mark.parametrize("said", ["go to the box", "the stopwatch", "unstoppable", "heat", "what?"])
def test_other_words_hold_nobody(said: str) -> None:
    assert not has_stop_word(said)


@pytest.mark.parametrize("said", ["nobody move", "everybody stop", "don't anybody move", "all robots stop"])
def test_a_call_to_all_is_for_all(said: str) -> None:
    assert called(said, ("Ada", "Kim")) == ("Ada", "Kim")


@pytest.mark.parametrize(
    "said", ["keep in mind that the gate is shut", "never mind the box", "do you mind the noise"]
)
def test_to_have_something_in_mind_is_no_call(said: str) -> None:
    assert not calls_to_stop(said)


def test_a_no_is_one_only_if_nothing_else_is_said() -> None:
    assert all(map(is_no, ("no", "No!", "no no no", "nope", "not there!", "Ei.")))
    assert not any(map(is_no, ("", "no problem", "no, go to the box", "go on", "not yet")))


@pytest.mark.parametrize(
    ("text", "rest"),
    [
        ("wait, is the door open?", "is the door open?"),
        ("no, hold on a second: where's the box?", "where's the box?"),
        ("Stop! Who told you that?", "Who told you that?"),
        ("wait, could you look at the box first?", ""),
        ("wait, what about the door?", ""),
        ("wait, do you mind going to the box?", ""),
        ("is the bus stop open?", ""),
        ("wait", ""),
    ],
)
def test_a_question_may_follow_words_of_stopping(text: str, rest: str) -> None:
    assert asked_behind(text) == rest


@pytest.mark.parametrize(
    ("text", "moves", "only"),
    [
        ("no wait, not the box, the door", True, True),
        ("hold on, I meant the door", True, True),
        ("wait, there is a child", True, False),
        ("stop, not the box, the door", True, False),
        ("wait", False, False),
        ("wait, the key is on the desk by now", False, True),
        ("not the box, the door", True, False),
    ],
)
def test_a_word_of_waiting_may_only_open_a_correction(text: str, moves: bool, only: bool) -> None:
    assert only_takes_back(text, moves=moves) is only


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("Everybody stop!", ("Ada", "Cart 2")),
        ("kõik seis!", ("Ada", "Cart 2")),
        ("stop all", ("Ada", "Cart 2")),
        ("alle stopp", ("Ada", "Cart 2")),
        ("careful, cart 2!", ("Cart 2",)),
        ("stop, that is Ada's box", ()),
        ("stop", ()),
        ("wait for Ada", ()),
        ("wait for Ada, Cart 2", ("Cart 2",)),
    ],
)
def test_a_call_is_for_those_whom_its_words_name_or_for_all(text: str, meant: tuple[str, ...]) -> None:
    assert called(text, ("Ada", "Cart 2")) == meant


@pytest.mark.parametrize(
    ("text", "opens"),
    [("no! I said the other one", True), ("wait, first the desk", True), ("hold on - not that one", True),
     ("no sugar", False), ("wait two minutes, then go", False), ("wait here, please", False)],
)  # fmt: skip
def test_a_message_that_opens_with_a_no_or_a_wait_holds_who_moves(text: str, opens: bool) -> None:
    assert opens_with_no(text) is opens
