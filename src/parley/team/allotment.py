"""Who does what: all of it done soonest, and with the least time together among such plans. Pure.

Up to `MOST_EXACT` tasks every way of sharing is weighed, by subsets (Held and Karp 1962): first how soon
the last robot can be done at all, then, of what is done by then, how little time all take together. The two
are not weighed in one go: who takes longer for a part may leave the better rest to the others. More tasks
are put in one by one where all is done soonest, the farthest first, which need not be the best.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from parley.world import grids

__all__ = ["MOST_EXACT", "Member", "allot", "finish_s"]

MOST_EXACT: Final = 9
"""So many tasks are shared in the best way: subsets grow by three per task."""
_EPS_S: Final = 1e-9


@dataclass(frozen=True, slots=True)
class Member:
    """One robot, as far as sharing concerns it. All times are of this robot; infinite: it cannot do that."""

    name: str
    first_s: tuple[float, ...]
    """By task: until it is done if it is this robot's first, with what it is still at."""
    next_s: tuple[tuple[float, ...], ...]
    """By task, and the one behind it: what that takes more."""


def finish_s(member: Member, route: Sequence[int]) -> float:
    """When a robot is done with tasks in this order; 0 with none."""
    if not route:
        return 0.0
    legs = (member.next_s[one][other] for one, other in itertools.pairwise(route))
    return member.first_s[route[0]] + sum(legs)


def allot(members: Sequence[Member], *, one_each: bool = False) -> list[tuple[int, ...]] | None:
    """Share all tasks: by robot its tasks in their order. None if some can be done by nobody.

    Args:
        members: The robots, with times for the same tasks.
        one_each: Whether nobody takes more than one.
    """
    count = len(members[0].first_s) if members else 0
    if one_each:
        return _one_each(members, count)
    if any(all(math.isinf(member.first_s[task]) for member in members) for task in range(count)):
        return None
    return _exact(members, count) if count <= MOST_EXACT else _by_insertion(members, count)


def _one_each(members: Sequence[Member], count: int) -> list[tuple[int, ...]] | None:
    """The same two aims where each robot takes one task at most: an assignment under the smallest bound."""
    if count > len(members):
        return None
    times = sorted({time for member in members for time in member.first_s if math.isfinite(time)})
    best: list[tuple[int, ...]] | None = None
    low, high = 0, len(times)
    while low < high:
        middle = (low + high) // 2
        found = _assigned(members, count, times[middle])
        if found is None:
            low = middle + 1
        else:
            best, high = found, middle
    return best if count else [() for _ in members]


def _assigned(members: Sequence[Member], count: int, bound_s: float) -> list[tuple[int, ...]] | None:
    costs = [[time if time <= bound_s else math.inf for time in member.first_s] for member in members]
    try:
        rows, columns = grids.linear_sum_assignment(costs)
    except ValueError:  # how it says that there is none
        return None
    taken = dict(zip((int(row) for row in rows), (int(column) for column in columns), strict=True))
    return (
        [(taken[at],) if at in taken else () for at in range(len(members))] if len(taken) == count else None
    )


def _exact(members: Sequence[Member], count: int) -> list[tuple[int, ...]]:
    routes = [_routes(member, count) for member in members]
    whole = (1 << count) - 1
    bound_s = _combined([[time for time, _ in each] for each in routes], whole, max)[0][whole]
    within = [[time if time <= bound_s + _EPS_S else math.inf for time, _ in each] for each in routes]
    _, choices = _combined(within, whole, lambda one, other: one + other)
    found: list[tuple[int, ...]] = []
    left = whole
    for at in range(len(members) - 1, -1, -1):
        own = choices[at][left]
        found.insert(0, routes[at][own][1])
        left &= ~own
    return found


def _routes(member: Member, count: int) -> list[tuple[float, tuple[int, ...]]]:
    """By set of tasks, as bits: the quickest order and its time."""
    ends: list[dict[int, tuple[float, tuple[int, ...]]]] = [{} for _ in range(1 << count)]
    best: list[tuple[float, tuple[int, ...]]] = [(0.0, ())]
    for tasks in range(1, 1 << count):
        for last in _bits(tasks):
            before = ends[tasks & ~(1 << last)]
            ways = [
                (time + member.next_s[end][last], (*route, last)) for end, (time, route) in before.items()
            ]
            ends[tasks][last] = min(ways, default=(member.first_s[last], (last,)))
        best.append(min(ends[tasks].values()))
    return best


def _combined(
    times: Sequence[Sequence[float]], whole: int, join: Callable[[float, float], float]
) -> tuple[list[float], list[list[int]]]:
    """By set of tasks the best time of all robots together, and what each robot but those before it takes."""
    best = [0.0 if tasks == 0 else math.inf for tasks in range(whole + 1)]
    choices: list[list[int]] = []
    for own_times in times:
        chosen, own_best = [0] * (whole + 1), list(best)
        for tasks in range(1, whole + 1):
            own = tasks
            while own:
                if own_times[own] < own_best[tasks]:
                    time = join(best[tasks & ~own], own_times[own])
                    if time < own_best[tasks]:
                        own_best[tasks], chosen[tasks] = time, own
                own = (own - 1) & tasks
        best = own_best
        choices.append(chosen)
    return best, choices


def _bits(tasks: int) -> Iterable[int]:
    return (at for at in range(tasks.bit_length()) if tasks >> at & 1)


def _by_insertion(members: Sequence[Member], count: int) -> list[tuple[int, ...]]:
    found: list[tuple[int, ...]] = [() for _ in members]
    least = [min(member.first_s[task] for member in members) for task in range(count)]
    for task in sorted(range(count), key=lambda task: -least[task]):
        ways = []
        for at, (member, route) in enumerate(zip(members, found, strict=True)):
            for place in range(len(route) + 1):
                tried = (*route[:place], task, *route[place:])
                before, after = finish_s(member, route), finish_s(member, tried)
                ways.append((after, after - before, at, tried))
        _, _, at, tried = min(ways)
        found[at] = tried
    return found
