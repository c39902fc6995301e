"""`flow` of a queue: from "only if step 2 was true" and "together with step 1" to steps, and back. Pure.

In messages a flow names other steps by their place in the list it stands in.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Sequence

from parley.agents.planner.steps import OPEN_STATES, Step, When, handed_over, previous
from parley.errors import Problem
from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.messages.status import PlanUpdate

__all__ = [
    "check_flow", "listed", "pending_calls", "pending_ids", "placed_steps", "rebased", "shifted", "steps_of",
    "unrolled",
]  # fmt: skip


def unrolled(calls: Iterable[ActionCall], known: int = 0) -> list[ActionCall]:
    """`calls` with those that are to be repeated as often as they are to run.

    Copies instead of a cycle: people see how far it got, and can drop or skip one of them. A condition on a
    repeated step is one on its last run; what runs together with one begins with its first.

    Args:
        calls: With flows that are possible.
        known: How many steps the flows count before `calls`.
    """
    calls = list(calls)
    counts = [call.flow.repeat or 1 if call.flow is not None else 1 for call in calls]
    ends = list(itertools.accumulate(counts, initial=known))
    last = dict(enumerate([*range(known), *(end - 1 for end in ends[1:])]))
    first = dict(enumerate([*range(known), *ends[:-1]]))
    found: list[ActionCall] = []
    for call, count in zip(calls, counts, strict=True):
        once = _moved(call, last, first)
        if once.flow is not None and once.flow.repeat is not None:
            flow = once.flow.model_copy(update={"repeat": None})
            once = once.model_copy(update={"flow": flow if flow != Flow() else None})
        found += [once] * count
    return found


def steps_of(calls: Sequence[ActionCall], before: Sequence[Step], known: Sequence[Step] = ()) -> list[Step]:
    """New steps for `calls`; those that run together stand side by side. See `placed_steps`."""
    return [step for step, _ in placed_steps(calls, before, known)]


def placed_steps(
    calls: Sequence[ActionCall], before: Sequence[Step], known: Sequence[Step] = ()
) -> list[tuple[Step, int]]:
    """New steps in the order of the plan, each with the place of its call in `calls`.

    A step without a condition that lives on what a step with one gives depends on the same.

    Args:
        calls: Repetitions spelt out, flow checked.
        before: The plan so far; its last steps may hand something on to the first ones.
        known: Steps that come first in the list whose places the flows name.
    """
    listed_steps = [*known, *(Step(call.model_copy(update={"flow": None})) for call in calls)]
    found = [*before]
    for place, call in enumerate(calls, len(known)):
        step, at = listed_steps[place], len(found)
        flow = call.flow or Flow()
        if flow.if_ is not None:
            step.when = When(listed_steps[flow.if_.step], flow.if_.result)
        if flow.together_with is not None and flow.together_with >= len(known):
            step.together = listed_steps[flow.together_with].together
            at = max(index for index, other in enumerate(found) if other.together is step.together) + 1
        found.insert(at, step)
    for index in range(len(before), len(found)):
        step, givers = found[index], previous(found, index, found[index].together)
        step.fed = handed_over(step.call, givers)
        if step.when is None and step.fed:
            step.when = _inherited(found, index, givers)
    place_of = {id(step): place - len(known) for place, step in enumerate(listed_steps)}
    return [(step, place_of[id(step)]) for step in found[len(before) :]]


def _inherited(steps: Sequence[Step], index: int, givers: Sequence[Step]) -> When | None:
    """The condition of the giver, unless another way that leads here gives the same."""
    when = next((giver.when for giver in givers if giver.when is not None), None)
    if when is None or any(giver.when is None for giver in givers):
        return None
    for place in range(index):
        other = steps[place].when
        ends_here = place + 1 == index or not _same(steps[place + 1].when, other)
        gives = steps[index].fed <= set(steps[place].call.output_parameters)
        opposite = other is not None and other.step is when.step and other.result is not when.result
        if opposite and ends_here and gives:
            return None
    return when


def _same(first: When | None, second: When | None) -> bool:
    if first is None or second is None:
        return first is second
    return first.step is second.step and first.result is second.result


def listed(steps: Sequence[Step]) -> list[ActionCall]:
    """The calls of `steps` with their flows as places among them; what is no longer there is left out."""
    places = {id(step): index for index, step in enumerate(steps)}
    first: dict[int, int] = {}
    calls: list[ActionCall] = []
    for index, step in enumerate(steps):
        leader = first.setdefault(id(step.together), index)
        on = places.get(id(step.when.step)) if step.when is not None else None
        condition = None
        if step.when is not None and on is not None:
            condition = FlowIf.model_validate({"step": on, "result": step.when.result})
        flow = Flow.model_validate({"if": condition, "together_with": leader if leader != index else None})
        calls.append(step.call if flow == Flow() else step.call.model_copy(update={"flow": flow}))
    return calls


def pending_calls(update: PlanUpdate, *, failed: bool = True) -> list[ActionCall]:
    """What a plan as published has still to do, with flows as places in this list.

    Args:
        update: The plan.
        failed: Whether a step that failed is among it.
    """
    places = [index for index, step in enumerate(update.steps) if step.state in _pending(failed)]
    calls = [step.action for step in update.steps]
    return [_moved(calls[place], {old: new for new, old in enumerate(places)}) for place in places]


def pending_ids(update: PlanUpdate) -> tuple[str, ...]:
    """The ids of the steps that `pending_calls` gives; none of a plan that does not tell them."""
    ids = tuple(step.id for step in update.steps if step.state in _pending(True))
    return ids if all(ids) else ()


def _pending(failed: bool) -> frozenset[str]:
    return OPEN_STATES | ({"failed"} if failed else frozenset())


def rebased(
    calls: Sequence[ActionCall], old: Sequence[ActionCall], begun: Sequence[int] = ()
) -> tuple[list[ActionCall], list[Problem]]:
    """An edited list whose flows name places in the list it was made from: made to name its own.

    Args:
        calls: The list as edited.
        old: The list it was made from.
        begun: Which of `old` have begun; they are not among `calls`, and come before them.

    Returns:
        The calls with flows that count the begun steps and then `calls`; and what depends on a step that is
        no longer there.
    """
    free = [place for place in range(len(old)) if place not in set(begun)]
    places = {place: index for index, place in enumerate(begun)}
    matched: set[int] = set()
    for exact in (True, False):
        for new, call in enumerate(calls):
            if new in matched:
                continue
            fits = (p for p in free if old[p] == call or (not exact and old[p].name == call.name))
            place = next(fits, None)
            if place is not None:
                free.remove(place)
                matched.add(new)
                places[place] = len(begun) + new
    problems = [
        Problem(
            f"steps[{index}].flow",
            "it depends on a step that is no longer there",
            "leave it out too, or keep the other step",
            "unknown_step",
        )
        for index, call in enumerate(calls)
        if any(place not in places for place in _named(call))
    ]
    return [_moved(call, places) for call in calls], problems


def shifted(calls: Sequence[ActionCall], by: int) -> list[ActionCall]:
    """`calls` with flows for a list in which `by` other steps come before them."""
    return [_moved(call, {place: place + by for place in range(len(calls))}) for call in calls]


def _named(call: ActionCall) -> list[int]:
    flow = call.flow or Flow()
    named = [flow.if_.step] if flow.if_ is not None else []
    return named + ([flow.together_with] if flow.together_with is not None else [])


def _moved(call: ActionCall, places: dict[int, int], leaders: dict[int, int] | None = None) -> ActionCall:
    """The call with other places in its flow; `leaders` are those of steps that it runs together with."""
    if call.flow is None:
        return call
    condition, beside = call.flow.if_, call.flow.together_with
    if condition is not None:
        place = places.get(condition.step)
        condition = condition.model_copy(update={"step": place}) if place is not None else None
    beside = (leaders or places).get(beside) if beside is not None else None
    moved = call.flow.model_copy(update={"if_": condition, "together_with": beside})
    return call.model_copy(update={"flow": moved if moved != Flow() else None})


def check_flow(calls: Sequence[ActionCall], known: int = 0) -> list[Problem]:
    """What is impossible about the flows of `calls`.

    Args:
        calls: As received.
        known: How many steps come before them in the list whose places the flows name.
    """
    problems: list[Problem] = []
    for index, call in enumerate(calls):
        flow, path = call.flow or Flow(), f"queue[{index}].flow"
        if flow.if_ is not None:
            problems += _place(f"{path}.if.step", flow.if_.step, known + index, known + len(calls))
        if flow.together_with is not None:
            problems += _place(f"{path}.together_with", flow.together_with, known + index, known + len(calls))
            if 0 <= flow.together_with < known:
                text = "the step it is to run together with has begun already"
                problems.append(Problem(f"{path}.together_with", text, "let it run after that", "begun_step"))
            if flow.repeat is not None and flow.repeat > 1:
                problems.append(
                    Problem(
                        f"{path}.repeat",
                        "a step that runs together with another cannot be repeated",
                        "leave one of the two out",
                        "impossible_flow",
                    )
                )
    return problems or _circles(calls, known)


def _place(path: str, named: int, own: int, count: int) -> list[Problem]:
    if 0 <= named < own:
        return []
    if not 0 <= named < count:
        remedy = f"steps count from 0 to {count - 1}"
        return [Problem(path, f"there is no step {named}", remedy, "unknown_step")]
    text = "a step cannot depend on itself" if named == own else f"step {named} comes later"
    return [Problem(path, text, "name a step that comes earlier", "forward_step")]


def _circles(calls: Sequence[ActionCall], known: int) -> list[Problem]:
    """A step cannot run together with the one whose end it waits for."""
    problems: list[Problem] = []
    leaders = list(range(known))
    for index, call in enumerate(calls):
        flow = call.flow or Flow()
        leader = leaders[flow.together_with] if flow.together_with is not None else known + index
        leaders.append(leader)
        if flow.if_ is not None and leader <= leaders[flow.if_.step]:
            problems.append(
                Problem(
                    f"queue[{index}].flow.if.step",
                    "the step cannot begin before the one that decides about it has ended",
                    "let it depend on an earlier step, or do not run it together with that one",
                    "impossible_flow",
                )
            )
    return problems
