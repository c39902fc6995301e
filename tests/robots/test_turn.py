"""A robot before a place with room for one: it waits, says so, and asks where nobody can tell."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager

import pytest

from parley.clock import WallClock
from parley.errors import ActionFailure, FailureCode
from parley.messages.passages import PassageClaim
from parley.robots.turn import PATIENCE_S, UNHEARD_S, Turn
from parley.team.passages import PassageBook
from parley.world.geometry import Pose2D
from parley.world.object_map import MapArea
from tests.engine.rig import DummyRobot

DOOR = MapArea("door", ((4.0, -1.0), (5.0, -1.0), (5.0, 1.0), (4.0, 1.0)), 1)
NICHE = MapArea("niche", ((5.2, -1.0), (6.0, -1.0), (6.0, 1.0), (5.2, 1.0)), 1)
WAY = tuple((x / 10, 0.0) for x in range(100))


class QuickClock(WallClock):
    """Time passes as soon as somebody waits for it."""

    def __init__(self) -> None:
        self.time_s = 0.0

    def now_s(self) -> float:
        return self.time_s

    def wall_s(self) -> float:
        return self.time_s / self.speed

    speed = 1.0
    """Robot time for each second of wall time."""

    async def sleep(self, seconds: float) -> None:
        await asyncio.sleep(0)
        self.time_s += seconds


class Walker(DummyRobot):
    """A robot that is where the test puts it."""

    x_m = 0.0

    def pose(self) -> Pose2D:
        return Pose2D(self.x_m, 0.0)


class Person:
    """Hears, and answers what the test says; None: never."""

    def __init__(self, answer: str | None = "") -> None:
        self.answer, self.heard = answer, list[str]()

    def tell(self, text: str) -> None:
        self.heard.append(text)

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        self.heard.append(question)
        if self.answer is None:
            await asyncio.Event().wait()
        return self.answer or ""


class Door:
    """A robot, its turn, and who says whose turn it is; another robot is in."""

    def __init__(self, *, other: bool = True) -> None:
        self.robot, self.book = Walker(), PassageBook()
        self.turn = Turn(self.robot, lambda: (DOOR, NICHE), QuickClock())
        self.turn.changed = self.tell
        if other:
            self.book.take("Kim", PassageClaim(inside=("door",), capacity={"door": 1}))

    def tell(self) -> None:
        self.book.take("A", self.turn.claim())
        self.turn.hear(self.book.settle())

    async def at(self, x_m: float) -> bool:
        self.robot.x_m, way = x_m, tuple(point for point in WAY if point[0] >= x_m)
        self.turn.may_go(way)
        for _ in range(3):
            await asyncio.sleep(0)
        return self.turn.may_go(way)


@asynccontextmanager
async def waiting(door: Door, person: Person) -> AsyncIterator[asyncio.Task[None]]:
    door.turn.begin()
    attending = asyncio.create_task(door.turn.attend(person))
    assert not await door.at(3.2)
    yield attending
    attending.cancel()
    await asyncio.gather(attending, return_exceptions=True)


async def test_a_free_way_is_asked_for_in_time_and_given_back_behind() -> None:
    door = Door(other=False)
    assert await door.at(0.0)
    assert door.book.settle().places == ()  # far away nothing is taken
    assert await door.at(2.0)
    assert door.book.settle().places[0].robots == ("A",)
    assert await door.at(4.5)
    assert await door.at(7.0)
    assert door.book.settle().places == ()


async def test_places_with_no_room_between_are_taken_together() -> None:
    door = Door(other=False)
    await door.at(2.0)
    assert {place.name for place in door.book.settle().places} == {"door", "niche"}


async def test_it_waits_before_it_and_stopped_it_lets_others_go_first() -> None:
    door = Door()
    assert await door.at(2.0)  # it drives on as far as it may
    assert not await door.at(3.2)
    assert door.book.settle().places[0].waiting == ("A",)
    door.turn.rest()
    await asyncio.sleep(0)
    assert door.book.settle().places[0].waiting == ()
    door.book.take("Kim", None)
    assert await door.at(3.2)


async def test_it_says_once_whom_it_waits_for_and_is_not_patient_for_ever() -> None:
    door, person = Door(), Person()
    async with waiting(door, person) as attending:
        with pytest.raises(ActionFailure, match="for long, and Kim is still in it") as caught:
            await attending
    assert caught.value.code is FailureCode.BLOCKED
    assert person.heard == ["I am waiting before “door”: Kim goes first."]
    assert door.turn._clock.now_s() > PATIENCE_S


async def test_patience_with_others_begins_when_there_are_others() -> None:
    door, person = Door(other=False), Person()
    door.book.gives = False  # it is asked who holds what, for a moment of wall time
    door.turn._clock = clock = QuickClock()
    clock.speed = 1000.0
    async with waiting(door, person) as attending:
        for _ in range(20):  # turns of the loop, in which it may give up
            await clock.sleep(PATIENCE_S / 8)
        assert not attending.done()
        door.book.gives = True
        door.tell()
        assert await door.at(3.2)
    assert person.heard == []


async def test_who_waits_for_the_place_behind_says_who_is_there() -> None:
    door, person = Door(other=False), Person()
    door.book.take("Kim", PassageClaim(inside=("niche",), capacity={"niche": 1}))
    async with waiting(door, person) as attending:
        with pytest.raises(ActionFailure, match="Kim is still in it") as caught:
            await attending
    assert caught.value.code is FailureCode.BLOCKED


@pytest.mark.parametrize(("answer", "goes"), [("yes", True), ("no", False)])
async def test_whether_one_that_does_not_answer_is_out_of_the_way_a_person_says(
    answer: str, goes: bool
) -> None:
    door, person = Door(), Person(answer)
    door.book.lose("Kim")
    async with waiting(door, person) as attending:
        if goes:
            tries = [await door.at(3.2) for _ in range(20)]
            assert tries[-1]
            assert not attending.done()
        else:
            with pytest.raises(ActionFailure, match="Kim stands in “door” and does not answer"):
                await attending
    assert "Kim does not answer any more" in person.heard[-1]


async def test_who_answers_again_and_comes_out_is_asked_about_no_longer() -> None:
    door, person = Door(), Person(None)
    door.book.lose("Kim")
    async with waiting(door, person) as attending:
        for _ in range(20):
            await asyncio.sleep(0)
        assert "Is it out of the way?" in person.heard[-1]
        door.book.take("Kim", None)
        door.tell()
        tries = [await door.at(3.2) for _ in range(20)]
        assert tries[-1]
        assert not attending.done()
    assert person.heard[-1] == "“door” is free now, so I go on."


async def test_where_nobody_says_whose_turn_it_is_it_does_not_go_in() -> None:
    door = Door()
    door.turn.changed = lambda: None
    async with waiting(door, Person()) as attending:
        with pytest.raises(ActionFailure, match="Nobody tells me whose turn it is") as caught:
            await attending
    assert caught.value.code is FailureCode.UNAVAILABLE
    assert door.turn._clock.wall_s() > UNHEARD_S
