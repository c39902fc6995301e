"""Questions about the robot itself: each shape is recognised, and answered from the state alone."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, Situation, Turn
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.following import in_turn
from parley.language.dialogue.map_words import rooms, whereabouts
from parley.language.dialogue.questions import plain, question_of
from parley.language.dialogue.state import Asked, Deed, Dialogue, Order, Stop
from parley.language.lexicon import load_data
from parley.messages.chat import ActionCall
from parley.messages.memory import MemoryEntry
from parley.messages.status import PlanStep
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import CATALOGUE, action

TESTS: dict[str, tuple[str, ...]] = load_data("questions")["tests"]
ENGINE = BuiltinLanguage()
WAY = action("drive_to", "Drive.", "place").model_copy(update={"effects": ("moves",)})
THINGS = (MapObject("b", "box in the hall", 0.0, 0.0), MapObject("g", "gate", 9.0, 0.0))
ORDER = Order("go to the gate", "Kim", 1_700_000_000_000)


def deed(label: str, **more: object) -> Deed:
    values: dict[str, object] = {"effects": ("moves",), "order": ORDER, "ending": "done", "unix_ms": 1}
    return Deed(label, ActionCall(name="drive_to"), **(values | more))  # type: ignore[arg-type]


LOOKED = deed(
    "Look: “crate”", effects=("looks",), told=("I can see the crate.",), seen=("crate", "rope", "gate")
)
EMPTY = replace(LOOKED, label="Look: “yard”", told=("I see nothing.",), seen=("gate",))
AREA = replace(LOOKED, label="Look: “Area B”")
RUNS = (PlanStep(action=ActionCall(name="drive_to"), label="Go to “gate”", state="running"),)
HELD = (RUNS[0].model_copy(update={"state": "paused"}),)
BEGUN = deed("Go to “gate”", ending="running")
GIVEN_UP = deed("Go to “gate”", ending="stopped")


async def said(message: str, dialogue: Dialogue, question: str = "") -> str:
    situation = Situation(
        message, objects=THINGS, robot="Ada", robots=("Ada",), catalogue=(*CATALOGUE, WAY), dialogue=dialogue,
        robot_pose=Pose2D(0.4, 0.0, 0.0), question=question, queue=tuple(s.action for s in dialogue.steps),
        status="running" if dialogue.plan == "running" else "idle",
    )  # fmt: skip
    answer = await ENGINE.interpret(situation)
    assert not answer.queue and not answer.system_cmd
    return answer.message_response


@pytest.mark.parametrize(("topic", "sentence"), [(topic, said) for topic in TESTS for said in TESTS[topic]])
def test_each_shape_is_read_as_its_topic(topic: str, sentence: str) -> None:
    for said_so in (f"ok so {sentence} now please?", f"Hi there, {sentence}?"):
        found = question_of(plain(tokenize(said_so), ("Bo",)))
        assert found is not None and found.topic == topic


@pytest.mark.parametrize(
    "sentence", ["where is Kim?", "is the gate open?", "can you clean the desk?", "go there"]
)
def test_what_is_about_the_world_is_left_to_others(sentence: str) -> None:
    assert question_of(plain(tokenize(sentence))) is None


@pytest.mark.parametrize(
    ("message", "dialogue", "words"),
    [
        ("where are you?", Dialogue(), "by the box in the hall"),
        ("which room are you in?", Dialogue(), "hall"),
        ("where are you going?", Dialogue("running", RUNS), "I go to the gate"),
        ("where are you going?", Dialogue(), "not going anywhere"),
        ("how long will that take?", Dialogue("running", RUNS, left_s=12.4), "12 seconds"),
        ("how long will that take?", Dialogue("running", RUNS, left_s=1.2), "About 1 second more"),
        ("why are you going there?", Dialogue("running", RUNS, orders=(ORDER,)), "Because Kim asked me"),
        ("why did you stop?", Dialogue("paused", RUNS, stopped=Stop("whoa", "Kim", 1)), "Kim told me to"),
        ("why did you stop?", Dialogue("paused", RUNS), "Say “carry on” and I go to the gate"),
        ("why are you waiting?", Dialogue("paused", HELD, deeds=(GIVEN_UP,)), "Say “carry on” and I go to"),
        ("what did you do?", Dialogue("running", RUNS, deeds=(BEGUN, BEGUN)), "begun to go to the gate."),
        ("why not?", Dialogue(refused="Ada must not go there."), "Ada must not go there"),
        ("are you there yet?", Dialogue("running", RUNS), "Not yet"),
        ("are you there yet?", Dialogue(deeds=(deed("Go to “gate”"),)), "Yes"),
        ("did you get there?", Dialogue(deeds=(deed("Go to “gate”", ending="failed"),)), "No"),
        ("have you been to the gate?", Dialogue(deeds=(deed("Go to “gate”"),)), "Yes"),
        ("have you been to the gate?", Dialogue(deeds=(deed("Go to “gate”", ending="stopped"),)), "No"),
        ("what did you do?", Dialogue(deeds=(deed("Go to “gate”"), LOOKED)), "go to the gate; look: the "
            "crate"),
        ("what did you see?", Dialogue(deeds=(LOOKED,)), "I can see the crate"),
        ("what did you see?", Dialogue(), "not looked"),
        ("did you find anything?", Dialogue(deeds=(LOOKED, EMPTY)), "I can see the crate. I see nothing."),
        ("did you find anything there?", Dialogue(deeds=(LOOKED, EMPTY)), "I see nothing. That was"),
        ("did you find the crate?", Dialogue(deeds=(LOOKED, EMPTY)), "I can see the crate. That was"),
        ("what did you see at the crate?", Dialogue(deeds=(LOOKED,)), "I can see the crate"),
        ("did you find anything strange in area A?", Dialogue(deeds=(AREA,)), "not looked there"),
        ("what have you found in Area B?", Dialogue(deeds=(AREA,)), "I can see"),
        ("is there a rope in there as well?", Dialogue(deeds=(LOOKED,)), "Yes"),
        ("is there a cat in there?", Dialogue(deeds=(LOOKED,)), "did not see"),
        ("what else is in it?", Dialogue(deeds=(LOOKED,)), "I also saw rope."),
        ("what is left to do?", Dialogue("running", RUNS), "go to the gate"),
        ("what is left to do?", Dialogue(), "Nothing"),
        ("what did you do?", Dialogue(deeds=(deed("Look: “whether it is shut”"),)), "look: whether it"),
        ("what did you do?", Dialogue("running", RUNS, deeds=(deed("Go to “gate”", ending="running"),)),
            "Nothing is done yet. I have begun to go to the gate"),
        ("what were you doing before I stopped you?", Dialogue("paused", HELD, stopped=Stop("", "", 1)),
            "I was to go to the gate, when I was told"),
        ("where were you going when I stopped you?", Dialogue(deeds=(GIVEN_UP,)),
            "I was to go to the gate"),
        ("how much battery is left?", Dialogue(battery=0.41), "41 %"),
        ("how much battery is left?", Dialogue(), "cannot tell"),
        ("how are you?", Dialogue(battery=0.9), "I am well"),
        ("how are you?", Dialogue(battery=0.04), "My battery is 4 % full."),
    ],
)  # fmt: skip
async def test_questions_are_answered_from_the_state(message: str, dialogue: Dialogue, words: str) -> None:
    assert words in await said(message, dialogue)


async def test_a_greeting_is_answered_with_one() -> None:
    assert await said("hello", Dialogue()) == "Hello. What can I do for you?"


async def test_what_it_waits_for_is_its_open_question() -> None:
    assert "Which gate?" in await said("what are you waiting for?", Dialogue("held"), "Which gate?")


async def test_a_choice_that_was_not_understood_is_asked_again() -> None:
    choices = ("box in the hall", "gate")
    asked = Dialogue(asked=Asked("go to it", choices))
    assert "the box in the hall or the gate" in await said("the pink one", asked)
    made = await ENGINE.interpret(Situation("the pink one", objects=THINGS, robot="Ada", dialogue=asked))
    assert (made.choices, made.left_open.about) == (choices, "go to it")


@pytest.mark.parametrize(
    ("words", "answers"),
    [
        ("the red one", True),
        ("wait, first the red one", False),
        ("then the red one", False),
        ("the red one then", True),
        ("the first", True),
    ],
)
async def test_a_name_with_what_comes_first_is_no_answer_to_which_one(words: str, answers: bool) -> None:
    boxes = (MapObject("r", "red box", 0.0, 0.0), MapObject("b", "blue box", 9.0, 0.0))
    asked = Dialogue(asked=Asked("drive to the box", ("red box", "blue box")))
    situation = Situation(words, objects=boxes, robot="Ada", catalogue=(*CATALOGUE, WAY), dialogue=asked)
    made = await ENGINE.interpret(situation)
    assert bool(made.queue) is answers, made.message_response


@pytest.mark.parametrize(
    "words",
    ["no", "none of them", "neither, thanks", "oh nothing", "never mind", "forget it", "no thanks",
     "nevermind", "oh, I changed my mind"],
)  # fmt: skip
async def test_a_choice_of_none_ends_the_question(words: str) -> None:
    asked = Dialogue(asked=Asked("go to it", ("box in the hall", "gate")))
    assert await said(words, asked) == "All right, then I leave it."


async def test_an_alarm_is_taken_back() -> None:
    alarm = await ENGINE.interpret(Situation("help, fire!", objects=THINGS, robot="Ada"))
    turns = (Turn("operator", "help, fire!"), Turn("assistant", alarm.message_response))
    over = await ENGINE.interpret(
        Situation("no, it was a false alarm", objects=THINGS, robot="Ada", history=turns)
    )
    assert (over.alarm, over.message_response) == (False, "I am glad to hear that. I stay here.")


async def test_a_place_that_nobody_knows_is_answered_with_places_that_are_known() -> None:
    answer = await said("go to the moon", Dialogue())
    assert "“moon”" in answer and "the box in the hall or the gate" in answer


async def test_what_a_name_ends_with_is_no_room_where_it_is_a_thing() -> None:
    things = (MapObject("d", "desk", 0.0, 0.0), MapObject("c", "end of the desk", 0.0, 1.0))
    assert rooms((*things, *THINGS)) == ("hall",)
    assert "in the desk" not in whereabouts(things, Pose2D(0.0, 0.5, 0.0))


@pytest.mark.parametrize("message", ["what's in the way?", "where is it?", "why?", "what were you doing?"])
async def test_while_a_failure_is_asked_about_questions_are_answered_from_it(message: str) -> None:
    step = ActionCall(name="drive_to", reason="go to the gate")
    failed = ErrorSituation("A crate is in the way.", step, FailureCode.BLOCKED)
    answer = await ENGINE.interpret(
        Situation(message, objects=THINGS, robot="Ada", question="Shall I try again?", failure=failed)
    )
    assert "A crate is in the way." in answer.message_response


@pytest.mark.parametrize(
    ("message", "kept"),
    [
        ("come to me when you are done", "come to me"),
        ("when you're finished with that, go to the gate", "go to the gate"),
        ("go to the gate once you have finished, please", "go to the gate please"),
        ("go to the gate after you're done with the boxes", None),
        ("tell me when you are done", None),
    ],
)
def test_an_order_for_afterwards_is_an_order(message: str, kept: str | None) -> None:
    assert in_turn(message) == (kept or message)


@pytest.mark.parametrize(
    ("message", "looks"),
    [
        ("is the gate clear?", "whether the gate is clear"),
        ("ok, is there a bag at the gate?", "whether there is a bag at the gate"),
        ("is anybody at the gate?", "whether anybody is at the gate"),
        ("where is the gate?", ""),
        ("is the gate near the box?", ""),
        ("is it far to the gate?", ""),
    ],
)
async def test_how_something_is_now_only_a_look_can_tell_and_that_is_offered(
    message: str, looks: str
) -> None:
    situation = Situation(message, objects=THINGS, robot="Ada", catalogue=CATALOGUE)
    made = await ENGINE.interpret(situation)
    values = [value.value for call in made.offer for value in call.input_parameters.values()]
    assert (made.queue, values[-1:]) == ((), [looks] if looks else [])
    told = (MemoryEntry(name="gate", data="The gate is clear"),)
    known = await ENGINE.interpret(replace(situation, memory=told))
    assert not known.offer or not looks.endswith("clear")


@pytest.mark.parametrize(
    ("message", "reply"),
    [
        ("how far is the gate?", "The gate is about 9 metres from me"),
        ("what is in the hall?", "By my map: the box in the hall."),
        ("what is next to the gate", "I cannot answer that."),
        ("how far is it?", "About 40 seconds more for this step."),
    ],
)
async def test_the_map_tells_how_far_and_what_is_where(message: str, reply: str) -> None:
    dialogue = Dialogue("running", RUNS, left_s=40.0) if " it" in message else Dialogue()
    assert (await said(message, dialogue)).startswith(reply)


async def test_what_was_found_before_a_restart_is_told_of_who_has_not_looked_since() -> None:
    known = (*THINGS, MapObject("k", "black bag", 3.0, 0.0, found=True))
    for message in ("did you find anything?", "did you see a bag?"):
        situation = Situation(message, objects=known, robot="Ada", robots=("Ada",), catalogue=CATALOGUE)
        told = (await ENGINE.interpret(situation)).message_response
        assert "since I was started. The map has what was found before: black bag." in told
    assert "Say “look around”" in await said("did you find anything?", Dialogue())
