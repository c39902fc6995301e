"""Stop and its kin: whole utterances, many languages, never part of something else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.gate.control import Control, control_of, stops_all
from parley.gate.stop_words import called


@pytest.mark.parametrize(
    ("text", "control"),
    [
        ("stop", "stop"),
        ("STOP!!!", "stop"),
        ("please stop", "stop"),
        ("Stop, Rob!", "stop"),
        ("wait", "stop"),
        ("hold on a second", "stop"),
        ("pause", "stop"),
        ("don't move", "stop"),
        ("stop stop stop", "stop"),
        ("ooh hang on a sec love", "stop"),
        ("hang on hang on, let me think", "stop"),
        ("attends une seconde", "stop"),
        ("basta, fermati subito!", "stop"),
        ("carry on, no wait, stop", "stop"),
        ("stop, no, I mean carry on", "start"),
        ("leave that bit out and move on to the next thing", "skip"),
        ("Leave it, cancel the lot", "clear"),
        ("stpo", "stop"),
        ("stooop", "stop"),
        ("okay, stop now", "stop"),
        ("Rob, wait!", "stop"),
        ("seis", "stop"),
        ("peatu", "stop"),
        ("oota", "stop"),
        ("alto", "stop"),
        ("arrête", "stop"),
        ("halt an", "stop"),
        ("стоп", "stop"),
        ("停止", "stop"),
        ("रुको", "stop"),
        ("توقف", "stop"),
        ("থামো", "stop"),
        ("espere", "stop"),
        ("carry on", "start"),
        ("continue please", "start"),
        ("go on", "start"),
        ("try again", "start"),
        ("jätka", "start"),
        ("weiter", "start"),
        ("continúa", "start"),
        ("skip it", "skip"),
        ("leave a step out", "skip"),
        ("move on", "start"),
        ("skip this step", "skip"),
        ("next step", "skip"),
        ("cancel everything", "clear"),
        ("abort the mission", "clear"),
        ("stop and cancel everything", "clear"),
        ("tühista kõik", "clear"),
        ("emergency stop", "emergency_stop"),
        ("hädaseiskamine", "emergency_stop"),
    ],
)
def test_a_whole_utterance_is_an_order(text: str, control: Control) -> None:
    assert control_of(text, ("Rob",)) == control


@pytest.mark.parametrize(
    "text",
    [
        "don't stop",
        "stop at the chair",
        "is there a bus stop?",
        "stop?",
        "",
        "   ",
        "!!!",
        "go to the bus stop",
        "wait at the door",
        "when should I stop",
        "the last stop",
        "now",
        "okay",
        "no",
        "strop",
        "shop",
        "go",
        "continue to the door",
        "skip the second step",
        "cancel the meeting with Anna",
        "forget that",
        "stop " * 60,
        "cancel my subscription to the paper",
        "hold the door",
        "pause the music in the hall",
    ],
)
def test_a_word_inside_a_sentence_is_no_order(text: str) -> None:
    assert control_of(text) is None


@given(st.sampled_from(["stop", "wait", "cancel"]), st.sampled_from(["chair", "door", "wug", "blicket"]))
def test_an_order_with_an_object_is_never_taken_for_the_order_alone(order: str, noun: str) -> None:
    assert control_of(f"{order} at the {noun}") is None


@pytest.mark.parametrize("whom", ["all", "everybody", "all of you", "kõik robotid", "alle", "tous", "все"])
@pytest.mark.parametrize(
    ("words", "control"),
    [("emergency stop", "emergency_stop"), ("hädapeatus", "emergency_stop"), ("halt", "stop")],
)
def test_who_stops_all_says_so_before_or_behind(words: str, control: Control, whom: str) -> None:
    for said in (f"{words} {whom}", f"{whom}, {words}!", f"{words} {whom} please"):
        assert control_of(said) == stops_all(said) == control
        assert called(said, ("Ada", "Kim")) == ("Ada", "Kim")


@pytest.mark.parametrize("said", ["all clear", "skip all", "that's all", "stop all of it", "all right"])
def test_all_is_no_word_of_stopping_itself(said: str) -> None:
    assert control_of(said) is stops_all(said) is None


@given(st.text(max_size=300))
def test_any_text_can_be_asked_about(text: str) -> None:
    assert control_of(text) in {None, "stop", "start", "skip", "clear", "emergency_stop"}


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("could you stop for a second?", "stop"),
        ("stop what you are doing", "stop"),
        ("stop following me", "stop"),
        ("pare agora", "stop"),
        ("pea kohe kinni", "stop"),
        ("call the whole thing off", "clear"),
        ("scrap the entire plan", "clear"),
        ("cancel all of it", "clear"),
        ("could you stop at the bench?", None),
        ("stop talking", None),
        ("drop the box", None),
        ("drop the last step", None),
        ("is there a stop?", None),
    ],
)
def test_an_order_to_stop_is_told_from_what_only_sounds_like_one(said: str, meant: str | None) -> None:
    assert control_of(said) == meant


@pytest.mark.parametrize(
    ("text", "control"),
    [
        ("could you hold off for a tick", "stop"),
        ("would you mind waiting a moment", "stop"),
        ("sit tight for now", "stop"),
        ("stop! there's a child", "stop"),
        ("pause please, somebody is in the corridor", "stop"),
        ("wait a moment, dogs crossing", "stop"),
        ("hold on, two pallets in the way", "stop"),
        ("you may resume now, all clear", "start"),
        ("continue with your round", "start"),
        ("right, off you go again", "start"),
        ("ok you can go", "start"),
        ("you can go home", None),
        ("leave that one, next please", "skip"),
        ("everything off, back to zero, cancel the lot", "clear"),
    ],
)
def test_a_control_word_is_found_among_small_words_and_what_is_told(text: str, control: Control) -> None:
    assert control_of(text, ("Rob",)) == control


@pytest.mark.parametrize(
    "text",
    [
        "wait, the red one",
        "wait, go to the desk",
        "wait, look at the dogs crossing",
        "hold my bag",
        "leave that chair",
        "move to the left",
        "continue to the library",
        "stop by the office",
        "drop the box",
        "halt, who goes there",
    ],
)
def test_what_goes_on_to_name_something_is_no_control(text: str) -> None:
    assert control_of(text) is None


@pytest.mark.parametrize("text", ["Leave out A", "leave A out", "can you move it?", "move it"])
def test_what_may_name_a_thing_is_no_order_of_the_plan(text: str) -> None:
    assert control_of(text) is None


@pytest.mark.parametrize("text", ["there is a box by the gate, ignore it", "the bin is full, leave it"])
def test_what_is_told_of_is_ignored_and_not_a_step(text: str) -> None:
    assert control_of(text) is None
