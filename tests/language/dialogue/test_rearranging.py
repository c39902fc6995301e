"""Another order of a plan, and the last order once more about something else."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import pytest

from parley.evaluation.steps import pending
from parley.language.base import Situation, Turn
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.changes import texts_of
from parley.language.dialogue.state import Asked, Deed, Dialogue
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo, PlanStep
from parley.world.object_map import MapObject

NAMES = ("gate 1", "gate 2", "gate 3", "workshop", "paint store", "red barrel", "blue barrel")
OBJECTS = tuple(MapObject(name.replace(" ", "_"), name, float(at), 0.0) for at, name in enumerate(NAMES))
CATALOGUE = (
    ActionInfo(name="drive", description="Drive to a place.", inputs={"place": "string"}, effects=("moves",)),
    ActionInfo(
        name="look",
        description="Look at something and report its state.",
        inputs={"what": "string"},
        effects=("looks",),
    ),
)
ENGINE = BuiltinLanguage()


def drive(place: str) -> ActionCall:
    return ActionCall(
        name="drive",
        input_parameters={"place": Parameter(type="string", value=place)},
        reason=f"go to the {place}",
    )


def answer(message: str, *queue: str, history: tuple[str, ...] = ()) -> tuple[Situation, ChatAction]:
    turns = tuple(
        Turn(role="assistant" if at % 2 else "operator", content=text) for at, text in enumerate(history)
    )
    situation = Situation(
        message,
        history=turns,
        queue=tuple(map(drive, queue)),
        status="running" if queue else "idle",
        objects=OBJECTS,
        robot="Ada",
        robots=("Ada",),
        catalogue=CATALOGUE,
    )
    return situation, asyncio.run(ENGINE.interpret(situation))


def after(message: str, *queue: str) -> list[str]:
    situation, made = answer(message, *queue)
    return [text for call in pending(situation.queue, made) for text in texts_of(call)]


PLAN = ("gate 1", "gate 2", "workshop")


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("skip the red one", "gate 1, blue barrel"),
        ("the blue one first", "blue barrel, gate 1, red barrel"),
        ("only the red one and the blue one", "red barrel, blue barrel"),
        ("everything but the blue one", "gate 1, red barrel"),
        ("leave gate 1 for later", "red barrel, blue barrel, gate 1"),
        ("no gates, just the red one", "red barrel"),
        ("not gate 1, the blue one only", "blue barrel"),
    ],
)
def test_one_is_one_of_the_plan(said: str, order: str) -> None:
    assert ", ".join(after(said, "gate 1", "red barrel", "blue barrel")) == order


@pytest.mark.parametrize("said", ["look at gate 3 instead", "no, look at gate 3", "rather look at gate 3"])
def test_any_order_may_come_in_the_place_of_what_is_done(said: str) -> None:
    assert ", ".join(after(said, "gate 1", "workshop")) == "gate 3, gate 3, workshop"


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("swap the first two", "gate 2, gate 1, workshop"),
        ("please switch gate 1 and the workshop", "workshop, gate 2, gate 1"),
        ("do the workshop first", "workshop, gate 1, gate 2"),
        ("I'd like the paint store first", "paint store, gate 1, gate 2, workshop"),
        ("gate 1 can wait till the end", "gate 2, workshop, gate 1"),
        ("move gate 1 to the end", "gate 2, workshop, gate 1"),
        ("the workshop before gate 2", "gate 1, workshop, gate 2"),
        ("squeeze in gate 3 after gate 1", "gate 1, gate 3, gate 2, workshop"),
        ("reverse the order", "workshop, gate 2, gate 1"),
        ("only the workshop", "workshop"),
        ("drop everything after gate 1", "gate 1"),
        ("finish this one and then cancel the rest", "gate 1"),
        ("skip to the workshop", "workshop"),
        ("gate 2 isn't needed any more", "gate 1, workshop"),
        ("the last two can go", "gate 1"),
        ("take gate 2 off your list", "gate 1, workshop"),
        ("no workshop today", "gate 1, gate 2"),
    ],
)
def test_a_plan_is_put_into_another_order(said: str, order: str) -> None:
    assert ", ".join(after(said, *PLAN)) == order


@pytest.mark.parametrize(
    "said",
    [
        "swap gate 1 and gate 3",  # that is not planned
        "the fourth one first",
        "drop everything after gate 3",
        "no, the workshop",  # in place of what? it is planned already
        "gate 1 before gate 1",
        "put the workshop frobnicated first",
    ],
)
def test_what_does_not_fit_the_plan_changes_nothing(said: str) -> None:
    assert after(said, *PLAN) == list(PLAN)


def test_a_number_counts_steps_and_a_name_takes_all_that_is_done_there() -> None:
    _, made = answer("go to gate 1 and inspect it and then go to the workshop")
    situation = Situation("", queue=made.queue, status="running", objects=OBJECTS, catalogue=CATALOGUE)
    for said, left in (
        ("drop the second step", ["drive gate 1", "drive workshop"]),
        ("skip gate 1", ["drive workshop"]),
        ("the workshop first", ["drive workshop", "drive gate 1", "look gate 1"]),
    ):
        asked = replace(situation, message=said)
        answered = asyncio.run(ENGINE.interpret(asked))
        calls = pending(asked.queue, answered)
        assert [f"{call.name} {texts_of(call)[0]}" for call in calls] == left, said


def test_a_step_that_stays_keeps_running() -> None:
    _, made = answer("swap gate 2 and the workshop", *PLAN)
    assert [command.pop_index for command in made.system_cmd] == [1, 2] or {
        command.pop_index for command in made.system_cmd
    } == {1, 2}


@pytest.mark.parametrize(
    ("first", "then", "deeds"),
    [
        ("go to gate 1", "and gate 2", ["gate 2"]),
        ("go to gate 1 and inspect it", "the same for the workshop", ["workshop", "workshop"]),
        ("go to gate 1", "now the next one", ["gate 2"]),
        ("go to the red barrel", "no, the other one", ["blue barrel"]),
        ("go to the red barrel", "sorry, the blue one I mean", ["blue barrel"]),
    ],
)
def test_the_last_order_is_done_once_more_about_something_else(
    first: str, then: str, deeds: list[str]
) -> None:
    _, made = answer(then, history=(first, "I will."))
    assert [text for call in made.queue for text in texts_of(call)] == deeds


@pytest.mark.parametrize("then", ["the blue one is leaking", "is gate 2 open?", "and the moon", "gate 2"])
def test_other_words_are_no_order_once_more(then: str) -> None:
    _, made = answer(then, history=("go to gate 1", "I will."))
    assert not made.queue


@pytest.mark.parametrize(
    "said",
    [
        "somebody should look at the workshop",
        "the paint store has to come before gate 1",
        "a customer is asking for the red barrel at gate 1",
        "gate 2 is where I need you",
        "not sure the workshop is locked",
        "I left my keys somewhere in the workshop",
    ],
)
def test_no_wish_is_kept_as_a_fact(said: str) -> None:
    _, made = answer(said)
    assert not [command for command in made.system_cmd if command.command == "add_memory"]


def test_an_order_that_names_one_of_the_choices_itself_is_not_asked_about_for_ever() -> None:
    asked = Asked("the red barrel", ("red barrel", "blue barrel"))
    situation = Situation(
        "the red barrel",
        objects=OBJECTS,
        robot="Ada",
        robots=("Ada",),
        catalogue=CATALOGUE,
        dialogue=Dialogue(asked=asked, now_unix_ms=1),
    )
    assert asyncio.run(ENGINE.interpret(situation)).message_response


@pytest.mark.parametrize(
    ("message", "left"),
    [
        ("leave out gate 2", "gate 1, oil, workshop, oil"),
        ("do the workshop before gate 2", "gate 1, oil, workshop, oil, gate 2, oil"),
    ],
)
def test_what_is_done_at_a_place_goes_with_it(message: str, left: str) -> None:
    look = ActionCall(name="look", input_parameters={"what": Parameter(type="string", value="oil")})
    queue = tuple(call for place in PLAN for call in (drive(place), look))
    situation = replace(answer(message)[0], queue=queue, status="running")
    made = asyncio.run(ENGINE.interpret(situation))
    assert ", ".join(text for call in pending(queue, made) for text in texts_of(call)) == left


def test_of_what_is_done_in_a_row_at_one_place_the_place_is_told_once() -> None:
    look = [
        ActionCall(name="look", input_parameters={"what": Parameter(type="string", value=place)})
        for place in PLAN
    ]
    queue = tuple(call for place, seen in zip(PLAN, look, strict=True) for call in (drive(place), seen))
    situation = replace(answer("no, the workshop first")[0], queue=queue, status="running")
    made = asyncio.run(ENGINE.interpret(situation))
    assert made.message_response == "All right, in this order: workshop, gate 1, gate 2."


AREAS = tuple(MapObject(f"area_{letter}", f"Area {letter.upper()}", 0.0, 0.0) for letter in "abc")


def round_of(message: str, *, over: int) -> tuple[Situation, ChatAction]:
    """A message during a round of three areas, of which so many are over."""
    calls = [drive(item.description) for item in AREAS]
    steps = tuple(
        PlanStep(
            label=f"Go to “{item.description}”", action=call, state="finished" if at < over else "queued"
        )
        for at, (item, call) in enumerate(zip(AREAS, calls, strict=True))
    )
    deeds = tuple(Deed(step.label, step.action, ("moves",), ending="done") for step in steps[:over])
    situation = Situation(
        message, queue=tuple(calls[over:]), status="running", objects=AREAS, robot="Ada", robots=("Ada",),
        catalogue=CATALOGUE, dialogue=Dialogue("running", steps, deeds=deeds),
    )  # fmt: skip
    return situation, asyncio.run(ENGINE.interpret(situation))


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("leave out area A", "Area B, Area C"),
        ("skip A", "Area B, Area C"),
        ("leave a out too", "Area B, Area C"),
        ("forget about area A please", "Area B, Area C"),
        ("skip A and C", "Area B"),
        ("hm, start with C please", "Area C, Area A, Area B"),
        ("A last", "Area B, Area C, Area A"),
        ("no hang on, only A and B", "Area A, Area B"),
        ("wait a bit", "Area A, Area B, Area C"),
    ],
)
def test_the_letter_a_is_a_name_where_no_noun_follows(said: str, left: str) -> None:
    situation, made = round_of(said, over=0)
    assert ", ".join(text for call in pending(situation.queue, made) for text in texts_of(call)) == left


def test_of_what_is_over_it_is_said_so_and_the_rest_is_left_out() -> None:
    situation, made = round_of("leave out area A", over=1)
    assert not (made.queue or made.system_cmd)
    told = "I am done with Area A already. Left to do: go to Area B; go to Area C."
    assert made.message_response == told
    situation, made = round_of("skip A and B", over=1)
    assert [text for call in pending(situation.queue, made) for text in texts_of(call)] == ["Area C"]


@pytest.mark.parametrize(
    ("over", "answers"), [(1, "Left to do: go to Area B; go to Area C."), (3, "Nothing is left to do.")]
)
def test_how_far_a_round_is_can_be_asked_of_its_places(over: int, answers: str) -> None:
    for said in ("which areas are left?", "have all areas been checked?", "have you checked every area?"):
        _, made = round_of(said, over=over)
        assert answers in made.message_response
        assert not (made.queue or made.system_cmd)
