"""What of an order can be shared, what a robot has before it, and why it is that robot."""

from __future__ import annotations

import math
from collections.abc import Sequence

from parley.gate.judge import Place, PlannedStep
from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo, PlanStep
from parley.team.outlook import Outlook, survey
from parley.team.sharing import alike, in_turn, is_search, left_of, place_of, shared, tasks_of, why
from parley.world.geometry import Pose2D
from parley.world.occupancy import NO_MAP

FIND = ActionInfo(name="Find", effects=("locates",))
DRIVE = ActionInfo(name="Drive", effects=("moves",))
LOOK = ActionInfo(name="Look", duration_s=10.0)
CATALOGUE = (FIND, DRIVE, LOOK)
SPOTS = {"gate": 10.0, "desk": 40.0}


def visit(place: str, *more: str) -> list[ActionCall]:
    found = Parameter("number")
    return [
        ActionCall(
            name="Find",
            input_parameters={"what": Parameter("string", place)},
            output_parameters={"x": found},
        ),
        ActionCall(name="Drive", input_parameters={"x": found}),
        *(ActionCall(name=name) for name in more),
    ]


def test_only_the_same_work_at_several_places_is_shared() -> None:
    tasks = tasks_of([*visit("gate", "Look"), *visit("desk", "Look")], CATALOGUE)
    assert [place_of(task) for task in tasks] == ["gate", "desk"]
    assert alike(tasks)
    assert not alike(tasks_of([*visit("gate", "Look"), *visit("desk")], CATALOGUE))  # fetch, and bring
    depends = ActionCall(name="Look", flow=Flow.model_validate({"if": FlowIf(step=1)}))
    assert len(tasks_of([*visit("gate", "Look"), *visit("desk"), depends], CATALOGUE)) == 1


def test_a_search_is_shared_by_places_and_each_robot_looks_no_longer_than_needed() -> None:
    tasks = tasks_of([*visit("gate", "Look"), *visit("desk", "Look"), *visit("door", "Look")], CATALOGUE)
    whole = in_turn(tasks, search=True)
    assert [call.flow and call.flow.if_ and call.flow.if_.step for call in whole] == [None] * 3 + [2] * 3 + [
        5
    ] * 3
    assert is_search(whole) and not is_search(in_turn(tasks, search=False))
    assert tasks_of(whole, CATALOGUE) == tasks


def test_what_is_left_begins_anew_without_what_the_other_robot_found_out() -> None:
    calls = [*visit("gate", "Look"), *visit("desk", "Look")]
    states = ("finished", "finished", "finished", "finished", "failed", "queued")
    drive = calls[4].model_copy(update={"input_parameters": {"x": Parameter("number", 7.0)}})
    steps = [PlanStep(action=drive if at == 4 else call, state=states[at]) for at, call in enumerate(calls)]
    (left,) = left_of(steps, CATALOGUE)
    assert left == tuple(calls[3:])
    assert left_of([PlanStep(action=call, state="finished") for call in calls], CATALOGUE) == []


async def test_ways_speed_work_and_what_is_still_to_be_done_count() -> None:
    async def resolve(calls: Sequence[ActionCall], start: Pose2D) -> list[PlannedStep]:
        infos = {info.name: info for info in CATALOGUE}
        steps, place = [], None
        for call in calls:
            text = call.input_parameters.get("what")
            place = Place(SPOTS[str(text.value)], 0.0) if text is not None else place
            steps.append(PlannedStep(call, infos[call.name], place if call.name != "Look" else None))
        return steps

    tasks = tasks_of([*visit("gate", "Look"), *visit("desk", "Look")], CATALOGUE)
    here = Pose2D(0.0, 0.0)
    free = await survey(resolve, NO_MAP, here, (), tasks, radius_m=0.2, speed_mps=0.5)
    assert free.ways_m == (10.0, 40.0)
    assert free.first_s == (30.0, 90.0)
    assert free.next_s[0][1] == 70.0
    busy = await survey(resolve, NO_MAP, here, visit("desk"), tasks, radius_m=0.2, speed_mps=0.5)
    assert busy.busy_s == 80.0
    assert busy.first_s == (150.0, 90.0)  # from the desk on


def outlook(*ways_m: float, busy_s: float = 0.0) -> Outlook:
    between = tuple(tuple(abs(one - other) for other in ways_m) for one in ways_m)
    return Outlook(ways_m, busy_s, tuple(busy_s + way for way in ways_m), between)


def test_ability_load_and_battery_decide_and_are_said() -> None:
    tasks = tasks_of(visit("gate"), CATALOGUE)
    near, far = outlook(2.0), outlook(9.0)
    both = {"Ada": [True], "Kim": [True]}

    def told(
        able: dict[str, list[bool]], battery: float | None = None, ada: Outlook = near
    ) -> tuple[str, str]:
        outlooks, batteries = {"Ada": ada, "Kim": far}, {"Ada": battery, "Kim": None}
        parts = shared(tasks, outlooks, able, batteries)
        assert parts is not None
        (robot,) = parts
        return robot, str(why(robot, tasks[0], 0, outlooks, able, batteries))

    assert told(both) == ("Ada", "Ada is nearer to “gate”")
    assert told({"Ada": [False], "Kim": [True]}) == ("Kim", "only Kim can do that")
    assert told(both, 0.1) == ("Kim", "Ada is nearer, but has little battery left")
    assert told({"Ada": [True], "Kim": [False]}, 0.1) == ("Ada", "only Ada can do that")
    busy = outlook(2.0, busy_s=60.0)
    assert told(both, ada=busy) == ("Kim", "Ada is nearer, but still has something else to do")
    nobody = shared(tasks, {"Ada": outlook(math.inf)}, {"Ada": [True]}, {"Ada": None})
    assert nobody is None
