"""What a model answered, checked before it is used; no model needed."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from parley.agents.planner.check import plan_problems
from parley.errors import FailureCode
from parley.language.base import ErrorSituation, ReplyReading
from parley.language.llm.answers import (
    GroundAnswer,
    InspectAnswer,
    PlanAnswer,
    ReplyAnswer,
    ResolveAnswer,
    SelectAnswer,
)
from parley.language.llm.reading import (
    AnswerRefusedError,
    read_grounding,
    read_plan,
    read_reading,
    read_report,
    read_resolution,
    read_selection,
)
from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.messages.memory import MemoryEntry
from parley.messages.pvf import Parameter
from tests.agents.crew import drive, find
from tests.language.llm.rig import BOX, DRIVE, FIND, LOOK, LOOK_PLAN, situation


def plan(**changes: object) -> PlanAnswer:
    return PlanAnswer.model_validate(LOOK_PLAN | changes)


def test_value_that_an_earlier_step_gives_may_be_left_out() -> None:
    steps = [{"action": "Find", "parameters": {"target": "box"}}, {"action": "Drive"}]
    order = read_plan(plan(queue=steps), situation(), plan_problems)
    assert [call.name for call in order.queue] == ["Find", "Drive"]


def test_value_that_nobody_gives_is_asked_for() -> None:
    with pytest.raises(AnswerRefusedError, match="x"):
        read_plan(plan(queue=[{"action": "Drive"}]), situation(), plan_problems)


@pytest.mark.parametrize(("given", "meant"), [("2.5", 2.5), (2, 2.0), (2.5, 2.5)])
def test_numbers_are_taken_as_they_are_plainly_meant(given: object, meant: float) -> None:
    order = read_plan(
        plan(queue=[{"action": "Drive", "parameters": {"x": given}}]), situation(), plan_problems
    )
    assert order.queue[0].input_parameters["x"].value == meant


@pytest.mark.parametrize("given", [True, "far", [1], "inf", "nan", 1e999])
def test_what_is_no_number_is_refused(given: object) -> None:
    with pytest.raises(AnswerRefusedError, match="number"):
        read_plan(plan(queue=[{"action": "Drive", "parameters": {"x": given}}]), situation(), plan_problems)


def test_all_problems_are_told_at_once() -> None:
    steps = [{"action": "Fly"}, {"action": "Look", "parameters": {"where": "box"}}]
    with pytest.raises(AnswerRefusedError) as caught:
        read_plan(plan(queue=steps, targets=["Nobody"]), situation(), plan_problems)
    assert len(caught.value.problems) == 3


def test_repetition_of_a_step_is_kept() -> None:
    steps = [{"action": "Look", "parameters": {"what": "box"}, "repeat": 3}]
    order = read_plan(plan(queue=steps), situation(), plan_problems)
    assert order.queue[0].flow is not None
    assert order.queue[0].flow.repeat == 3


def test_conditions_between_steps_are_kept() -> None:
    look = {"action": "Look", "parameters": {"what": "box"}}
    other = look | {"only_if": {"step": 0, "result": False}}
    order = read_plan(plan(queue=[look, other]), situation(), plan_problems)
    assert order.queue[1].flow == Flow(if_=FlowIf(step=0, result=False))
    beside = read_plan(plan(queue=[look, look | {"together_with": 0}]), situation(), plan_problems)
    assert beside.queue[1].flow == Flow(together_with=0)


def test_condition_on_a_later_step_is_refused() -> None:
    look = {"action": "Look", "parameters": {"what": "box"}}
    with pytest.raises(AnswerRefusedError, match="earlier"):
        read_plan(plan(queue=[look | {"only_if": {"step": 1}}, look]), situation(), plan_problems)


def test_sources_are_memories_that_there_are() -> None:
    known = situation(memory=(MemoryEntry(name="box", data="It is red."),))
    assert read_plan(plan(sources=["box", "made_up"]), known, plan_problems).sources == ("box",)


def test_another_robot_is_found_whatever_its_capitals() -> None:
    assert read_plan(plan(targets=["b"]), situation(), plan_problems).targets == ("B",)


@pytest.mark.parametrize(
    "form",
    [
        {"command": "pop", "index": 1},
        {"pop": {"parameters": 1}},
        {"pop": 1},
        {"command": "pop", "index": "1"},
    ],
)
def test_pop_is_read_in_every_form(form: object) -> None:
    queue = (find("box"), drive())
    order = read_plan(plan(queue=[], system_cmd=[form]), situation(queue=queue), plan_problems)
    assert order.system_cmd[0].pop_index == 1


def test_empty_memory_is_not_kept() -> None:
    with pytest.raises(AnswerRefusedError, match="data"):
        read_plan(plan(system_cmd=[{"command": "add_memory", "data": " "}]), situation(), plan_problems)


@pytest.mark.parametrize(
    "changes",
    [{"message_response": ""}, {"queue": "Look"}, {"system_cmd": [{"command": "__class__"}]}, {"choices": 3}],
)
def test_answer_of_the_wrong_form_is_no_answer(changes: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        plan(**changes)


def failure(**known: object) -> ErrorSituation:
    call = ActionCall(name="Look", input_parameters={"what": Parameter("string", "box")})
    given = {"code": FailureCode.BLOCKED, "robot": "A", "catalogue": (LOOK, FIND, DRIVE)} | known
    return ErrorSituation("There is something in the way.", call, **given)  # type: ignore[arg-type]


def resolution(**changes: object) -> ResolveAnswer:
    return ResolveAnswer.model_validate(LOOK_PLAN | {"success": True} | changes)


def test_correction_may_use_what_the_steps_before_gave() -> None:
    answer = resolution(queue=[{"action": "Drive"}])
    assert read_resolution(answer, failure(completed=(find("box"),)), plan_problems).success
    with pytest.raises(AnswerRefusedError):
        read_resolution(answer, failure(), plan_problems)


def test_question_carries_no_steps() -> None:
    with pytest.raises(AnswerRefusedError, match="queue"):
        read_resolution(resolution(success=False), failure(), plan_problems)
    asked = resolution(success=False, queue=[], choices=["red", "blue"])
    assert read_resolution(asked, failure(), plan_problems).choices == ("red", "blue")


def test_order_for_later_is_read_wherever_the_model_puts_it() -> None:
    aside = read_resolution(resolution(success=None), failure(), plan_problems)
    assert (aside.queue, [call.name for call in aside.afterwards]) == ((), ["Look"])
    steps = [{"action": "Look", "parameters": {"what": "door"}}]
    cases: tuple[dict[str, object], ...] = (
        {"success": True},
        {"success": False, "queue": []},
        {"success": None, "queue": []},
    )
    for changes in cases:
        answer = read_resolution(resolution(afterwards=steps, **changes), failure(), plan_problems)
        assert [call.name for call in answer.afterwards] == ["Look"]


def test_order_for_later_is_checked_like_any_other() -> None:
    with pytest.raises(AnswerRefusedError, match=r"afterwards\[0\]"):
        read_resolution(resolution(afterwards=[{"action": "Fly"}]), failure(), plan_problems)
    with pytest.raises(AnswerRefusedError, match="afterwards"):
        read_resolution(resolution(afterwards=[{"action": "Drive"}]), failure(), plan_problems)


def test_only_a_correction_waits() -> None:
    assert read_resolution(resolution(delay_s=5), failure(), plan_problems).delay_s == 5.0
    aside = resolution(success=None, queue=[], delay_s=5)
    assert read_resolution(aside, failure(), plan_problems).delay_s == 0.0


def test_selection_keeps_to_the_list() -> None:
    index = [MemoryEntry(name=name, data="x") for name in ("one", "two", "three")]
    assert read_selection(SelectAnswer(names=["three", "four", "one"]), index) == ["one", "three"]


def test_grounding_goes_with_its_outcome() -> None:
    assert read_grounding(GroundAnswer(outcome="match", ids=["box_1"]), [BOX]).candidates == (BOX,)
    assert read_grounding(GroundAnswer(outcome="none", ids=["made_up"]), [BOX]).candidates == ()
    for answer in (
        GroundAnswer(outcome="match", ids=["box_2"]),
        GroundAnswer(outcome="match"),
        GroundAnswer(outcome="ambiguous", ids=["box_1", "box_1"]),
    ):
        with pytest.raises(AnswerRefusedError):
            read_grounding(answer, [BOX])


def test_choice_is_one_of_those_offered() -> None:
    answer = ReplyAnswer(kind="choice", choice="RED box")
    assert read_reading(answer, ["red box", "blue box"]) == ReplyReading("choice", "red box")
    with pytest.raises(AnswerRefusedError):
        read_reading(answer, ["blue box"])


def test_steps_are_meant_by_what_they_are_and_not_by_their_place() -> None:
    known = situation(queue=(find("box"), drive()), steps=("id-a", "id-b"), status="running")
    commands = [{"command": "pop", "step": "s2"}, {"command": "skip"}]
    order = read_plan(plan(queue=[], system_cmd=commands), known, plan_problems)
    assert [command.arguments.get("step") for command in order.system_cmd] == ["id-b", "id-a"]
    with pytest.raises(AnswerRefusedError, match="s1, s2"):
        read_plan(plan(queue=[], system_cmd=[{"command": "pop", "step": "s3"}]), known, plan_problems)


def test_waiting_step_is_dropped_while_a_failure_is_resolved_and_the_failed_one_is_skipped() -> None:
    known = failure(pending=(find("box"), drive()), steps=("id-a", "id-b"))
    commands = [{"command": "pop", "step": "s1"}, {"command": "skip"}]
    order = read_resolution(resolution(queue=[], system_cmd=commands), known, plan_problems)
    assert [command.arguments.get("step") for command in order.system_cmd] == ["id-a", None]


def test_calls_leave_as_a_graph_needs_them() -> None:
    steps = [
        {"action": "Find", "parameters": {"target": "box"}},
        {"action": "Drive", "parameters": {"x": None}},
    ]
    order = read_plan(plan(queue=steps), situation(), plan_problems)
    found, driven = order.queue
    assert (found.output_parameters, driven.input_parameters) == (
        {"x": Parameter("number")}, {"x": Parameter("number")},
    )  # fmt: skip


def test_level_that_is_left_out_is_no_parameter() -> None:
    steps = [{"action": "Look", "parameters": {"what": "box", "pose": None}}]
    assert read_plan(plan(queue=steps), situation(), plan_problems).queue[0].name == "Look"


def test_one_answer_may_hold_orders_for_several_robots() -> None:
    look = {"action": "Look", "parameters": {"what": "box"}}
    steps = [
        look,
        look | {"robot": "B"},
        look | {"robot": "B", "only_if": {"step": 1}},
        look | {"only_if": {"step": 0}},
    ]
    order = read_plan(plan(queue=steps), situation(), plan_problems)
    (other,) = order.others
    assert (len(order.queue), len(other.queue), other.targets) == (2, 2, ("B",))
    assert other.queue[1].flow == Flow(if_=FlowIf(step=0))
    assert order.queue[1].flow == Flow(if_=FlowIf(step=0))
    across = [look, look | {"robot": "B", "only_if": {"step": 0}}]
    with pytest.raises(AnswerRefusedError, match="same robot"):
        read_plan(plan(queue=across), situation(), plan_problems)


def test_thing_named_by_its_id_is_shown_in_words() -> None:
    steps = [{"action": "Look", "parameters": {"what": "box_1"}}]
    order = read_plan(plan(queue=steps), situation(objects=(BOX,)), plan_problems)
    assert order.queue[0].input_parameters["what"].value == "box by the door"


def test_memories_are_named_by_label_or_name() -> None:
    known = situation(memory=(MemoryEntry(name="box", data="It is red."), MemoryEntry(name="m1", data="x")))
    forgets = [{"command": "remove_memory", "name": "m1"}]
    order = read_plan(plan(queue=[], sources=["m2", "box", "m9"], system_cmd=forgets), known, plan_problems)
    assert order.sources == ("m1", "box")
    assert order.system_cmd[0].arguments == {"name": "box"}


def test_rules_that_apply_are_those_that_were_given() -> None:
    report = read_report(InspectAnswer(text="A crack.", rules=["r2", "r7"]), ["one", "two"])
    assert report.rules == ("two",)
