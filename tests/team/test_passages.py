"""Places with room for so many robots: nobody enters one that is full, and everybody gets his turn."""

from __future__ import annotations

import random

import pytest

from parley.messages.passages import PassageClaim, PassageList
from parley.team.passages import PassageBook


class Keeper:
    """The book, and robots that tell it what they want."""

    def __init__(self) -> None:
        self.book = PassageBook()
        self.claims: dict[str, PassageClaim] = {}
        self.number = 0

    def tell(self, robot: str, *, wants: tuple[str, ...] = (), inside: tuple[str, ...] = ()) -> PassageList:
        before = self.claims.get(robot, PassageClaim())
        self.number += 1
        same = wants == before.wants or (before.held and {*wants} < {*before.wants})
        identity = before.id if wants and same else str(self.number) if wants else ""
        held = bool(wants) and same and before.held
        room = dict.fromkeys((*wants, *inside), 1)
        self.claims[robot] = PassageClaim(id=identity, wants=wants, held=held, inside=inside, capacity=room)
        return self.settle(robot)

    def settle(self, robot: str = "") -> PassageList:
        if robot:
            self.book.take(robot, self.claims[robot])
        told = self.book.settle()
        for name, claim in self.claims.items():
            if claim.id and told.granted.get(name) == claim.id:
                self.claims[name] = claim.model_copy(update={"held": True})
        return told

    def may(self, robot: str) -> bool:
        return self.claims[robot].held


def test_one_is_in_the_others_wait_in_their_turn() -> None:
    keeper = Keeper()
    for robot in ("Ada", "Kim", "Lee"):
        keeper.tell(robot, wants=("door",))
    assert [keeper.may(robot) for robot in ("Ada", "Kim", "Lee")] == [True, False, False]
    (place,) = keeper.tell("Ada", inside=("door",)).places
    assert (place.robots, place.waiting) == (("Ada",), ("Kim", "Lee"))
    keeper.tell("Kim", wants=("door",))  # said once more, it is the same wish
    keeper.tell("Ada")
    assert [keeper.may(robot) for robot in ("Kim", "Lee")] == [True, False]
    keeper.tell("Kim")  # told to do something else before it went in
    assert keeper.may("Lee")


def test_what_is_wanted_together_is_given_together_and_nobody_jumps_ahead() -> None:
    keeper = Keeper()
    keeper.tell("Ada", wants=("door",))
    keeper.tell("Kim", wants=("door", "lift"))
    keeper.tell("Lee", wants=("lift",))
    assert [keeper.may(robot) for robot in ("Ada", "Kim", "Lee")] == [True, False, False]
    keeper.tell("Ada")
    assert [keeper.may(robot) for robot in ("Kim", "Lee")] == [True, False]


def test_who_must_come_out_for_another_goes_before_it() -> None:
    keeper = Keeper()
    keeper.tell("Ada", inside=("lift",))
    keeper.tell("Kim", wants=("door", "lift"))
    keeper.tell("Ada", wants=("door",), inside=("lift",))
    assert keeper.may("Ada")
    assert not keeper.may("Kim")
    keeper.tell("Ada")
    assert keeper.may("Kim")


def test_robots_in_each_others_way_are_told_that_one_has_to_give_way() -> None:
    keeper = Keeper()
    keeper.tell("Ada", inside=("left",))
    keeper.tell("Kim", inside=("right",))
    keeper.tell("Ada", wants=("right",), inside=("left",))
    told = keeper.tell("Kim", wants=("left",), inside=("right",))
    assert told.stuck == ("Kim",)
    assert keeper.tell("Kim", inside=("right",)).stuck == ()


@pytest.mark.parametrize("where", ["inside", "before"])
def test_what_a_silent_robot_has_is_not_given_away_until_a_person_says_so(where: str) -> None:
    keeper = Keeper()
    keeper.tell("Ada", wants=("door",), inside=("door",) if where == "inside" else ())
    keeper.book.lose("Ada")
    (place,) = keeper.tell("Kim", wants=("door",)).places
    assert (place.robots, place.lost) == (("Ada",), ("Ada",))
    assert not keeper.may("Kim")
    keeper.claims["Kim"] = keeper.claims["Kim"].model_copy(update={"without": ("Ada",)})
    keeper.settle("Kim")
    assert keeper.may("Kim")
    told = keeper.tell("Ada", inside=("door",))  # it is back, and there all the same
    assert told.places[0].robots == ("Ada", "Kim")


def test_who_says_goodbye_keeps_only_where_it_stands() -> None:
    keeper = Keeper()
    keeper.tell("Ada", wants=("door",))
    keeper.book.leave("Ada")
    keeper.tell("Kim", wants=("door",))
    assert keeper.may("Kim")
    keeper.tell("Kim", inside=("door",))
    keeper.book.leave("Kim")
    keeper.tell("Lee", wants=("door",))
    assert not keeper.may("Lee")


def test_whoever_is_started_anew_learns_what_is_held_before_it_gives_anything() -> None:
    keeper = Keeper()
    keeper.tell("Ada", wants=("door",))
    keeper.book = PassageBook(gives=False)
    keeper.tell("Kim", wants=("door",))
    keeper.settle("Ada")
    keeper.book.gives = True
    keeper.settle()
    assert keeper.may("Ada")
    assert not keeper.may("Kim")


WAYS = (("west",), ("east",), ("west", "lift"), ("lift", "west"), ("east", "lift"), ("lift", "east"))
"""Single doorways, and doorways so near to the lift behind them that nobody can wait between."""


@pytest.mark.parametrize("seed", range(60))
def test_three_robots_get_through_two_doorways_and_a_lift_in_any_order(seed: int) -> None:
    """A robot is in each place of its way after the other; it stays in the last if that is the lift."""
    chance, keeper = random.Random(seed), Keeper()
    todo = {
        robot: [chance.choice(WAYS[:2] + WAYS[2:6:2]) for _ in range(4)] for robot in ("Ada", "Kim", "Lee")
    }
    going: dict[str, list[str]] = {}
    where: dict[str, str] = dict.fromkeys(todo, "")
    for _ in range(2000):
        busy = [robot for robot in todo if todo[robot] or going.get(robot) or where[robot]]
        if not busy:
            return
        robot = chance.choice(busy)
        inside = (where[robot],) if where[robot] else ()
        if not going.get(robot):
            if where[robot] == "lift":  # it has to come out again, by either doorway
                going[robot] = [chance.choice(("west", "east"))]
            elif todo[robot]:
                going[robot] = [*todo[robot].pop(0)]
            else:
                where[robot] = ""
                keeper.tell(robot)
                continue
        left = tuple(going[robot])
        told = keeper.tell(robot, wants=left, inside=inside)
        assert told.stuck == ()
        if keeper.may(robot):
            where[robot] = going[robot].pop(0)
            assert [*where.values()].count(where[robot]) == 1
            keeper.tell(robot, wants=tuple(going[robot]), inside=(where[robot],))
            if not going[robot] and where[robot] != "lift":
                where[robot] = ""
                keeper.tell(robot)
    pytest.fail(f"still on their way: {todo} {where}")
