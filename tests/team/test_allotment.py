"""Sharing tasks among robots: as good as trying everything."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator, Sequence

import pytest

from parley.team.allotment import MOST_EXACT, Member, allot, finish_s

Routes = tuple[tuple[int, ...], ...]


def team(random_: random.Random, robots: int, tasks: int) -> list[Member]:
    """Robots on a plane, of different speeds, some busy, some not able to do everything."""
    places = [(random_.uniform(0, 30), random_.uniform(0, 30)) for _ in range(tasks)]
    members = []
    for number in range(robots):
        here, speed = (random_.uniform(0, 30), random_.uniform(0, 30)), random_.choice([0.3, 0.5, 1.0])
        busy_s = random_.choice([0.0, 0.0, 25.0])
        able = [random_.random() < 0.9 for _ in range(tasks)]
        first = [busy_s + math.dist(here, to) / speed if able[t] else math.inf for t, to in enumerate(places)]
        more = [
            tuple(math.dist(one, to) / speed if able[t] else math.inf for t, to in enumerate(places))
            for one in places
        ]
        members.append(Member(f"R{number}", tuple(first), tuple(more)))
    return members


def value(members: Sequence[Member], routes: Sequence[Sequence[int]]) -> tuple[float, float]:
    times = [finish_s(member, route) for member, route in zip(members, routes, strict=True)]
    return max(times), sum(times)


def all_ways(members: Sequence[Member], tasks: int, *, one_each: bool) -> Iterator[Routes]:
    for owners in itertools.product(range(len(members)), repeat=tasks):
        own = [[t for t in range(tasks) if owners[t] == at] for at in range(len(members))]
        if not one_each or max(map(len, own)) <= 1:
            yield from itertools.product(*(itertools.permutations(each) for each in own))


@pytest.mark.parametrize("one_each", [False, True])
def test_two_hundred_random_teams_share_as_well_as_brute_force(one_each: bool) -> None:
    random_ = random.Random(16)
    solved = 0
    for _ in range(200):
        robots, tasks = random_.randint(1, 3), random_.randint(1, 4)
        members = team(random_, robots, tasks)
        found = allot(members, one_each=one_each)
        ways = (value(members, way) for way in all_ways(members, tasks, one_each=one_each))
        best = min(ways, default=(math.inf, math.inf))
        if found is None:
            assert math.isinf(best[0])
            continue
        solved += 1
        assert sorted(task for route in found for task in route) == [*range(tasks)]
        assert value(members, found) == pytest.approx(best)
    assert solved > 50


def test_more_tasks_than_are_weighed_exactly_are_all_given_out_and_sooner_done_than_by_one() -> None:
    tasks = MOST_EXACT + 4
    spots = [(float(x), 0.0) for x in range(tasks)]
    between = tuple(tuple(math.dist(one, to) for to in spots) for one in spots)
    members = [Member(f"R{x}", tuple(math.dist((x, 0.0), to) for to in spots), between) for x in (0, tasks)]
    found = allot(members)
    assert found is not None
    assert sorted(task for route in found for task in route) == [*range(tasks)]
    assert value(members, found)[0] < tasks - 1
