"""Corrections: exactly the steps that are meant go, and what stays is what was there."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.agents.chat.texts import asks_back, still_standing
from parley.language.base import Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Dialogue, Order
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.status import ActionInfo, PlanProposal, PlanStep
from parley.world.object_map import MapArea, MapObject

ENGINE = BuiltinLanguage()
FIND = ActionInfo(name="Locate", description="Find out where something is.", inputs={"what": "string"},
                  outputs={"pose::x": "number"}, effects=("locates",))  # fmt: skip
GO = ActionInfo(name="Way", description="Drive.", inputs={"pose::x": "number"}, effects=("moves",))
NAMES = ("box", "gate", "desk", "lamp", "red crate", "blue crate")
THINGS = tuple(MapObject(name.replace(" ", "_"), name, float(at), 0.0) for at, name in enumerate(NAMES))


def way(name: str) -> tuple[ActionCall, ActionCall]:
    find = {"input_parameters": {"what": {"pvf_type": "string", "pvf_value": name}}}
    return (
        ActionCall.model_validate({"Locate": find}),
        ActionCall.model_validate({"Way": {"input_parameters": {"pose::x": {"pvf_type": "number"}}}}),
    )


def steps(*names: str) -> tuple[PlanStep, ...]:
    """The way to the first is found already, and it is under way."""
    made = [PlanStep(action=call, label=f"Go to “{name}”") for name in names for call in way(name)]
    states = ["finished", "running"] + ["queued"] * len(made)
    return tuple(s.model_copy(update={"state": state}) for s, state in zip(made, states, strict=False))


def given(message: str, *names: str) -> Situation:
    plan = steps(*names)
    return Situation(
        message, objects=THINGS, robot="Ada", robots=("Ada",), catalogue=(FIND, GO), status="running",
        queue=tuple(s.action for s in plan if s.state != "finished"),
        dialogue=Dialogue("running", plan, orders=(Order("go", calls=tuple(s.action for s in plan)),)),
    )  # fmt: skip


def goals(answer: ChatAction) -> list[str]:
    return [str(c.input_parameters["what"].value) for c in answer.queue if c.name == "Locate"]


def dropped(answer: ChatAction) -> set[int | None]:
    return {command.pop_index for command in answer.system_cmd if command.command == "pop"}


async def test_a_thing_takes_the_place_of_all_that_is_taken_back() -> None:
    answer = await ENGINE.interpret(given("forget the crates, the lamp instead", "red crate", "blue crate"))
    assert (len(dropped(answer)), goals(answer)) == (3, ["lamp"]), answer.message_response


@pytest.mark.parametrize(
    ("message", "drops", "adds"),
    [
        ("no wait, not the box, the lamp", {0}, ["lamp"]),
        ("sorry, I meant the lamp", {0}, ["lamp"]),
        ("wait at the lamp", set(), ["lamp"]),
        ("make it the lamp instead", {0}, ["lamp"]),
        ("drop that and go to the lamp", {0}, ["lamp"]),
        ("go to the lamp instead", {0}, ["lamp"]),
        ("also the lamp", set(), ["lamp"]),
        ("no wait, the lamp as well", set(), ["lamp"]),
        ("no, also go to the lamp", set(), ["lamp"]),
        ("forget it, the lamp too", {0}, ["lamp"]),
        ("and add the lamp at the end", set(), ["lamp"]),
        ("and the lamp", set(), ["lamp"]),
        ("now the lamp", set(), ["lamp"]),
        ("never mind all that, go to the lamp", {0}, ["lamp"]),
        ("go to the lamp", set(), ["lamp"]),
    ],
)
async def test_of_one_way(message: str, drops: set[int], adds: list[str]) -> None:
    answer = await ENGINE.interpret(given(message, "box"))
    assert (dropped(answer), goals(answer)) == (drops, adds), answer.message_response


@pytest.mark.parametrize(
    "message",
    ["no wait, go to the lamp instead", "sorry, go to the lamp", "I meant go to the lamp",
     "go to the lamp instead", "hang on, I mean go to the lamp"],
)  # fmt: skip
async def test_what_is_taken_back_though_nothing_runs_is_just_the_order(message: str) -> None:
    assert goals(await ENGINE.interpret(given(message))) == ["lamp"]


async def test_another_place_is_said_by_the_deed() -> None:
    answer = await ENGINE.interpret(given("no, the gate", "box"))
    assert answer.message_response == "I do not go to the box. Instead I go to the gate."


@pytest.mark.parametrize(
    ("message", "drops", "adds"),
    [
        ("skip the gate", {1, 2}, []),
        ("leave out the gate and the desk", {1, 2, 3, 4}, []),
        ("skip the second one", {1, 2}, []),
        ("not the gate, the lamp", {1, 2, 3, 4}, ["lamp", "desk"]),
        ("first the lamp", {0, 1, 2, 3, 4}, ["lamp", "box", "gate", "desk"]),
        ("actually, go to the lamp first", {0, 1, 2, 3, 4}, ["lamp", "box", "gate", "desk"]),
    ],
)
async def test_of_three_ways(message: str, drops: set[int], adds: list[str]) -> None:
    answer = await ENGINE.interpret(given(message, "box", "gate", "desk"))
    assert (dropped(answer), goals(answer)) == (drops, adds), answer.message_response


@pytest.mark.parametrize(
    "message",
    ["no, the gate is locked", "to the desk, no wait, the lamp",
     "the lamp is better lit", "skip the seventh one", "not the crate, the lamp",
     "sorry, I meant the crate", "what about the gate?", "is the gate after the box?",
     "wait, is the lamp on?", "no, where is the desk?", "hold on, was that the lamp?"],
)  # fmt: skip
async def test_in_doubt_the_plan_stays(message: str) -> None:
    answer = await ENGINE.interpret(given(message, "box", "gate"))
    assert (dropped(answer), answer.queue) == (set(), ())


@pytest.mark.parametrize("waits", [False, True], ids=["runs", "waits"])
@pytest.mark.parametrize(
    "said", ["go to the desk, no, I mean the lamp", "go to the desk. Sorry, I meant the lamp"]
)
async def test_what_somebody_takes_back_while_speaking_is_no_word_about_the_plan(
    said: str, waits: bool
) -> None:
    about = given(said, "box", "gate")
    if waits:
        plan = PlanProposal(id="7", target="Ada", steps=(*way("box"), *way("gate")), labels=("",) * 4)
        about = replace(about, queue=(), dialogue=Dialogue("awaiting_approval", proposal=plan))
    plainly = await ENGINE.interpret(replace(about, message="go to the lamp"))
    assert goals(plainly)[-1] == "lamp"
    assert await ENGINE.interpret(about) == plainly


async def test_a_proposal_is_changed_as_a_whole() -> None:
    calls = (*way("box"), *way("gate"))
    labels = ("Find out where “box” is", "Go to “box”", "Find out where “gate” is", "Go to “gate”")
    waits = PlanProposal(id="7", target="Ada", steps=calls, labels=labels)
    situation = Situation(
        "without the box please", objects=THINGS, robot="Ada", catalogue=(FIND, GO),
        dialogue=Dialogue("awaiting_approval", proposal=waits),
    )  # fmt: skip
    answer = await ENGINE.interpret(situation)
    assert (answer.replaces, goals(answer), answer.system_cmd) == ("7", ["gate"], ())


@pytest.mark.parametrize(
    "message",
    ["yes but go to the lamp too", "and then go to the lamp", "also go to the lamp", "go to the lamp"],
)
async def test_what_is_said_on_top_of_a_proposal_joins_it(message: str) -> None:
    waits = PlanProposal(id="7", target="Ada", steps=(*way("box"), *way("gate")), labels=("", "", "", ""))
    situation = Situation(
        message, objects=THINGS, robot="Ada", catalogue=(FIND, GO),
        dialogue=Dialogue("awaiting_approval", proposal=waits),
    )  # fmt: skip
    answer = await ENGINE.interpret(situation)
    joined = message != "go to the lamp"  # that takes its place
    assert goals(answer) == (["box", "gate", "lamp"] if joined else ["lamp"]), answer.message_response
    assert answer.replaces == ("7" if joined else "")


async def test_who_drops_what_waits_drops_all_that_waits() -> None:
    waits = PlanProposal(id="7", target="Ada", steps=(*way("box"), *way("gate")), labels=("", "", "", ""))
    situation = Situation(
        "forget it, go to the lamp", objects=THINGS, robot="Ada", catalogue=(FIND, GO),
        dialogue=Dialogue("awaiting_approval", proposal=waits),
    )  # fmt: skip
    answer = await ENGINE.interpret(situation)
    assert (answer.replaces, goals(answer)) == ("7", ["lamp"])
    assert [command.command for command in answer.system_cmd] == ["clear"]


async def test_again_means_what_was_ordered_last() -> None:
    order = Order("go to the gate", calls=way("gate"))
    situation = Situation(
        "do that again", objects=THINGS, catalogue=(FIND, GO), dialogue=Dialogue(orders=(order,))
    )
    assert (await ENGINE.interpret(situation)).queue == order.calls


@pytest.mark.parametrize(
    ("last", "goes"), [("red crate", ["blue crate"]), ("gate", [])], ids=["one other", "no other of its kind"]
)
async def test_the_other_one_is_the_one_other_thing_of_that_kind(last: str, goes: list[str]) -> None:
    calls = tuple(call.model_copy(update={"reason": f"go to the {last}"}) for call in way(last))
    known = Dialogue(orders=(Order(f"go to the {last}", calls=calls),))
    situation = Situation("and now the other one", objects=THINGS, catalogue=(FIND, GO), dialogue=known)
    assert goals(await ENGINE.interpret(situation)) == goes


async def test_after_the_last_one_which_of_several_is_asked_or_told_by_what_it_stands_next_to() -> None:
    crates = tuple(MapObject(name, f"{name} crate", at, 4.0) for name, at in (("old", 1.0), ("new", 6.0)))
    known = Dialogue(orders=(Order("go to the gate", calls=way("gate")),))
    gate = MapObject("g", "gate", 1.0, 4.5)
    after = Situation("then the crate", objects=(gate, *crates), catalogue=(FIND, GO), dialogue=known)
    answer = await ENGINE.interpret(after)
    assert (answer.queue, answer.choices) == ((), ("old crate", "new crate"))
    beside = replace(after, message="and the crate next to it")
    assert goals(await ENGINE.interpret(beside)) == ["old crate"]


async def test_an_order_in_place_of_all_that_is_planned_says_so_and_leaves_nothing() -> None:
    answer = await ENGINE.interpret(given("forget it and go to the lamp", "box", "gate"))
    assert [command.command for command in answer.system_cmd] == ["clear"]
    assert (goals(answer), "drop the rest" in answer.message_response) == (["lamp"], True)


@pytest.mark.parametrize(
    ("message", "order"),
    [
        ("before the desk, go to the lamp", ["gate", "lamp", "desk"]),
        ("before you drive to the desk, go to the lamp", ["gate", "lamp", "desk"]),
        ("go to the lamp after the gate", ["gate", "lamp", "desk"]),
        ("when you are done with the desk, go to the lamp", ["gate", "desk", "lamp"]),
    ],
)
async def test_what_comes_before_or_after_a_place_of_the_plan_is_put_in_there(
    message: str, order: list[str]
) -> None:
    situation = given(message, "box", "gate", "desk")
    answer = await ENGINE.interpret(situation)
    gone = dropped(answer)
    kept = [call for at, call in enumerate(situation.queue) if at not in gone]
    assert goals(answer.model_copy(update={"queue": (*kept, *answer.queue)})) == order


@pytest.mark.parametrize(
    ("message", "looks"),
    [("no wait, go to the lamp instead", ["gate"]), ("no wait, the lamp", ["lamp", "gate"])],
)
async def test_a_look_goes_with_the_way_to_what_is_looked_at(message: str, looks: list[str]) -> None:
    look = ActionInfo(
        name="Look", description="Look at something.", inputs={"what": "string"}, effects=("looks",)
    )
    looking = [
        PlanStep(
            action=ActionCall.model_validate(
                {"Look": {"input_parameters": {"what": {"pvf_type": "string", "pvf_value": name}}}}
            ),
            label=f"Look at “{name}”",
            state="queued",
        )
        for name in ("box", "gate")
    ]
    box, gate = steps("box"), steps("box", "gate")[2:]
    plan = (*box, looking[0], *gate, looking[1])
    was = given(message, "box")
    said = replace(
        was,
        catalogue=(FIND, GO, look),
        queue=tuple(step.action for step in plan if step.state != "finished"),
        dialogue=replace(was.dialogue, steps=plan),
    )
    answer = await ENGINE.interpret(said)
    assert [str(c.input_parameters["what"].value) for c in answer.queue if c.name == "Look"] == looks
    assert goals(answer) == ["lamp", "gate"]


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ("what comes after the gate?", "After that: go to the desk; go to the lamp."),
        ("where do you go before the desk?", "Before that: go to the box; go to the gate."),
        ("what's next after the lamp", "Nothing is planned after that."),
        ("what comes before the box?", "Nothing comes before that."),
        ("what about after the red crate?",
         "That is not in my plan. Left to do: go to the box; go to the gate; go to the desk; "
         "go to the lamp."),
    ],
)  # fmt: skip
async def test_what_stands_beside_a_step_of_the_plan_can_be_asked(message: str, words: str) -> None:
    answer = await ENGINE.interpret(given(message, "box", "gate", "desk", "lamp"))
    assert (answer.message_response, answer.queue, answer.system_cmd) == (words, (), ())


async def test_a_yes_to_nothing_from_who_had_it_stand_is_told_how_it_goes_on() -> None:
    running = given("ok", "box")
    held = replace(running, dialogue=replace(running.dialogue, plan="paused"))
    answer = await ENGINE.interpret(held)
    assert "say “carry on”" in answer.message_response.lower()
    assert not asks_back(answer.message_response)
    assert still_standing(answer.message_response, "ok", paused=True) == answer.message_response


@pytest.mark.parametrize(
    "message", ["go on but skip the gate", "continue, but leave out the gate", "carry on without the gate"]
)
async def test_going_on_with_less_changes_the_plan_and_leaves_going_on_to_its_own_word(message: str) -> None:
    running = given(message, "box", "gate", "desk")
    held = replace(running, dialogue=replace(running.dialogue, plan="paused"))
    for situation, ends in ((running, "gate."), (held, "Say “carry on” when I should go on.")):
        answer = await ENGINE.interpret(situation)
        assert dropped(answer) == {1, 2} and goals(answer) == []
        assert answer.message_response.endswith(ends)


@pytest.mark.parametrize(
    "message",
    ["before you go on, go by the lamp", "go by the lamp before you carry on",
     "before leaving, go to the lamp", "before you do anything else, go to the lamp"],
)  # fmt: skip
async def test_what_is_to_be_done_before_going_on_comes_before_the_rest(message: str) -> None:
    answer = await ENGINE.interpret(given(message, "box", "gate"))
    assert goals(answer) == ["lamp", "box", "gate"], answer.message_response


LOOK = ActionInfo(
    name="Look", description="Look for something.", inputs={"what": "string"}, effects=("looks",)
)
GRASP = ActionInfo(name="Grasp", description="Pick up.", inputs={"what": "string"}, effects=("grasps",))


def doing(name: str, what: str) -> ActionCall:
    given = {"input_parameters": {"what": {"pvf_type": "string", "pvf_value": what}}}
    return ActionCall.model_validate({name: given})


@pytest.mark.parametrize(
    ("deeds", "stays"),
    [
        (("Look", "Grasp"), []),  # it is brought to the gate: without it there is nothing to bring
        (("Look",), ["gate"]),
        ((), ["gate"]),
    ],
)
async def test_what_was_to_be_done_there_is_not_done_elsewhere(
    deeds: tuple[str, ...], stays: list[str]
) -> None:
    plain = given("no wait, go to the desk", "box", "gate")
    there = [PlanStep(action=doing(name, "crown"), label=f"{name} at the crown") for name in deeds]
    plan = (*plain.dialogue.steps[:2], *there, *plain.dialogue.steps[2:])
    waits = tuple(step.action for step in plan if step.state != "finished")
    asked = replace(
        plain, catalogue=(FIND, GO, LOOK, GRASP), queue=waits, dialogue=replace(plain.dialogue, steps=plan)
    )
    answer = await ENGINE.interpret(asked)
    assert [call.name for call in answer.queue if call.name in deeds] == []
    assert goals(answer) == ["desk", *stays]
    all_go = any(command.command == "clear" for command in answer.system_cmd)
    assert all_go or dropped(answer) >= {*range(1 + len(deeds))}


async def test_what_is_looked_for_everywhere_is_looked_for_at_what_is_added_too() -> None:
    plain = given("and the lamp", "box", "gate")
    row = plain.dialogue.steps
    look = PlanStep(action=doing("Look", "leaks"), label="Look for leaks")
    plan = (*row[:2], look, *row[2:], look)
    waits = tuple(step.action for step in plan if step.state != "finished")
    answer = await ENGINE.interpret(
        replace(plain, catalogue=(FIND, GO, LOOK), queue=waits, dialogue=replace(plain.dialogue, steps=plan))
    )
    assert [call.name for call in answer.queue] == ["Locate", "Way", "Look"], answer.message_response
    assert goals(answer) == ["lamp"] and not dropped(answer)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ("skip the lamp", "The lamp is not in my plan."),
        ("are you going to the lamp too?", "No."),
        ("will you check the desk later?", "Yes."),
    ],
)
async def test_what_is_not_in_the_plan_is_said_not_to_be(message: str, words: str) -> None:
    answer = await ENGINE.interpret(given(message, "box", "desk"))
    assert answer.message_response.startswith(words) and not answer.system_cmd and not answer.queue


@pytest.mark.parametrize(
    ("message", "drops"), [("skip the yard", 2), ("not the shed", 2), ("skip the lamp", 0)]
)
async def test_rooms_are_taken_out_like_things(message: str, drops: int) -> None:
    corners = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    rooms = tuple(MapArea(name, corners).goal for name in ("yard", "shed"))
    answer = await ENGINE.interpret(replace(given(message, "box", "yard", "shed"), rooms=rooms))
    assert len(dropped(answer)) == drops, answer.message_response


async def test_what_is_seen_in_a_room_is_looked_at_in_the_one_that_is_added() -> None:
    corners = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    rooms = tuple(MapArea(name, corners).goal for name in ("yard", "shed"))
    plain = given("now the shed", "yard")
    look = PlanStep(action=doing("Look", "what can be seen in the yard"), label="Look around in the yard")
    plan = (*plain.dialogue.steps, look)
    waits = tuple(step.action for step in plan if step.state != "finished")
    dialogue = replace(plain.dialogue, steps=plan)
    answer = await ENGINE.interpret(
        replace(plain, rooms=rooms, catalogue=(FIND, GO, LOOK), queue=waits, dialogue=dialogue)
    )
    assert goals(answer) == ["shed"]
    assert str(answer.queue[-1].input_parameters["what"].value) == "what can be seen in the shed"
