"""From one order to what each robot does of it, and why it is that one. Pure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Final

from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.messages.status import ActionInfo, PlanStep
from parley.sentences import Sentence, sentence
from parley.team.allotment import allot, finish_s
from parley.team.outlook import Outlook, Task

__all__ = ["alike", "in_turn", "is_search", "left_of", "place_of", "shared", "tasks_of", "why"]

OVER: Final = ("finished", "skipped", "stopped")
"""States of a step that is over and not to be done again."""
WEAK: Final = 0.15
"""With less battery than this a robot is given something only if nobody else can do it."""


def tasks_of(calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo]) -> list[Task]:
    """What of a row of steps may go to different robots; all in one where steps depend on others.

    Of a search, each place of which is gone to if the thing is not at the one before, each place may.
    """
    finding = {info.name for info in catalogue if info.only_finds}
    starts = [at for at, call in enumerate(calls) if call.name in finding]
    if not starts or starts[0] != 0:
        return [tuple(calls)]
    bare = [call.model_copy(update={"flow": None}) for call in calls]
    tasks = [tuple(bare[at:end]) for at, end in zip(starts, [*starts[1:], len(calls)], strict=True)]
    return tasks if in_turn(tasks, search=is_search(calls)) == tuple(calls) else [tuple(calls)]


def is_search(calls: Sequence[ActionCall]) -> bool:
    """Whether some of these steps depend on others."""
    return any(call.flow is not None for call in calls)


def in_turn(tasks: Sequence[Task], *, search: bool) -> tuple[ActionCall, ...]:
    """One robot's tasks as a row of steps; of a `search` those are done that are needed yet."""
    calls: list[ActionCall] = []
    for task in tasks:
        seen = FlowIf.model_validate({"step": len(calls) - 1, "result": False}) if calls and search else None
        flow = Flow.model_validate({"if": seen}) if seen is not None else None
        calls += [call.model_copy(update={"flow": flow}) if flow is not None else call for call in task]
    return tuple(calls)


def alike(tasks: Sequence[Task]) -> bool:
    """Whether the same is done at several places, so that none of it needs what came of another."""
    return len(tasks) > 1 and len({tuple(call.name for call in task) for task in tasks}) == 1


def left_of(steps: Sequence[PlanStep], catalogue: Sequence[ActionInfo]) -> list[Task]:
    """The tasks of a plan that are not over, each from its beginning, as somebody else would do it."""
    tasks = tasks_of([step.action for step in steps], catalogue)
    if len(tasks) == 1:
        return [_unfilled(tasks[0])] if any(step.state not in OVER for step in steps) else []
    found: list[Task] = []
    at = 0
    for task in tasks:
        own, at = steps[at : at + len(task)], at + len(task)
        if any(step.state not in OVER for step in own):
            found.append(_unfilled(task))
    return found


def _unfilled(task: Task) -> Task:
    """Without what its own steps found out for the robot that did them."""
    given: set[str] = set()
    calls: list[ActionCall] = []
    for call in task:
        inputs = {
            name: value.with_value(None) if name in given else value
            for name, value in call.input_parameters.items()
        }
        calls.append(call.model_copy(update={"input_parameters": inputs}))
        given |= {*call.output_parameters}
    return tuple(calls)


def place_of(task: Task) -> str:
    """How the place of a task is called."""
    values = (item.value for call in task for item in call.input_parameters.values() if item.has_data)
    return next((value for value in values if isinstance(value, str)), "")


def shared(
    tasks: Sequence[Task],
    outlooks: Mapping[str, Outlook],
    able: Mapping[str, Sequence[bool]],
    batteries: Mapping[str, float | None],
    *,
    one_each: bool = False,
    most: int = 0,
) -> dict[str, list[Task]] | None:
    """Which robot does which tasks, in this order; None if some can be done by nobody.

    Args:
        tasks: All of them.
        outlooks: What each robot has before it.
        able: Of each robot, by task, whether it can do it.
        batteries: How full each robot's battery is, if it tells.
        one_each: Whether nobody takes more than one.
        most: How many robots may have a part in it; 0: all.
    """
    strong = {name: not _is_weak(batteries.get(name)) for name in outlooks}
    covered = [any(strong[name] and able[name][at] for name in outlooks) for at in range(len(tasks))]
    members = [
        outlook.member(name, [can and (strong[name] or not covered[at]) for at, can in enumerate(able[name])])
        for name, outlook in outlooks.items()
    ]
    found = []
    for some in combinations(members, min(most or len(members), len(members))):
        if (routes := allot(some, one_each=one_each)) is not None:
            times = [finish_s(member, route) for member, route in zip(some, routes, strict=True)]
            found.append((max(times), sum(times), some, routes))
    if not found:
        return None
    _, _, takers, routes = min(found, key=lambda one: one[:2])
    return {
        member.name: [tasks[at] for at in route]
        for member, route in zip(takers, routes, strict=True)
        if route
    }


def why(
    robot: str,
    task: Task,
    at: int,
    outlooks: Mapping[str, Outlook],
    able: Mapping[str, Sequence[bool]],
    batteries: Mapping[str, float | None],
) -> Sentence:
    """Why a robot does a task, in a few words.

    Args:
        robot: Who does it.
        task: The first of its part.
        at: Its place among all tasks.
        outlooks: What each robot has before it.
        able: Of each robot, by task, whether it can do it.
        batteries: How full each robot's battery is, if it tells.
    """
    place = place_of(task)
    can = [name for name in outlooks if able[name][at]]
    if len(outlooks) == 1:
        return sentence("nobody else is there for it")
    if len(can) == 1:
        return sentence("only {robot} can do that", robot=robot)
    nearest = min(can, key=lambda name: (outlooks[name].ways_m[at], name != robot))
    if not math.isfinite(outlooks[nearest].ways_m[at]) or not place:
        return sentence("that way all of it is done soonest")
    if nearest == robot:
        if len(can) == 2:
            return sentence("{robot} is nearer to “{place}”", robot=robot, place=place)
        return sentence("{robot} is nearest to “{place}”", robot=robot, place=place)
    if _is_weak(batteries.get(nearest)):
        return sentence("{robot} is nearer, but has little battery left", robot=nearest)
    if outlooks[nearest].busy_s > outlooks[robot].busy_s:
        return sentence("{robot} is nearer, but still has something else to do", robot=nearest)
    return sentence("that way all of it is done soonest")


def _is_weak(battery: float | None) -> bool:
    return battery is not None and battery < WEAK
