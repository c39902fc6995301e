"""One robot before places with room for so many only: it goes in when it is its turn, and waits before them.

Whoever drives asks `may_go` before each command. What comes up on the way is asked for some metres ahead, so
that a robot for which there is room need not stop. Who else is in, `parley.team.passages` says, over
`/parley/passages`.
"""

from __future__ import annotations

import asyncio
import contextlib
import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode
from parley.gate.assent import assent_of
from parley.messages.passages import TAKEN, PassageClaim, PassageList, PassageState
from parley.robots.base import Robot
from parley.sentences import Sentence, sentence
from parley.world.object_map import MapArea

__all__ = ["PATIENCE_S", "Asker", "Turn"]

PATIENCE_S: Final = 180.0
"""Robot time for which a place may be taken before a person is asked what shall be done."""
UNHEARD_S: Final = 5.0
"""Wall time within which somebody has to say whose turn it is."""
_ASK_M: Final = 2.5
_WAIT_M: Final = 1.0
"""So far before a place a robot waits, so that another one can come out past it."""
_TOUCH_M: Final = 0.1
_BRAKE_S: Final = 0.6
_BESIDE_M: Final = 0.5
"""What blocks a way so near to a place may well be who stands in it."""
_LOOK_AGAIN_M: Final = 0.2
_REST_S: Final = 2.0
"""Robot time after which what was driven towards without a goal is not asked for any more."""

Point = tuple[float, float]


class Asker(Protocol):
    """The person, as a waiting robot reaches them."""

    def tell(self, text: str) -> None:
        """Say something."""
        ...

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        """Ask and wait for the answer."""
        ...


@dataclass(frozen=True, slots=True)
class _Wait:
    """What a robot stands and waits for."""

    place: str
    others: tuple[str, ...] = ()
    """Who is in, or goes first."""
    lost: tuple[str, ...] = ()
    stuck: bool = False
    known: bool = False
    """Whether anybody has said how it stands."""


class Turn:
    """The turn of one robot.

    Args:
        robot: Which.
        places: The areas of its map.
        clock: Robot time for waiting, wall time for what others say.
    """

    def __init__(self, robot: Robot, places: Callable[[], Sequence[MapArea]], clock: Clock) -> None:
        self._robot, self._places, self._clock = robot, places, clock
        self.changed: Callable[[], None] = lambda: None
        """Called when what it claims is different."""
        self._claim = PassageClaim()
        self._told = PassageList()
        self._wait: _Wait | None = None
        self._news = asyncio.Event()
        self._loop = asyncio.get_running_loop()
        self._ahead: tuple[str, ...] = ()
        self._looked_at: tuple[Point, Point] | None = None
        self._drives = 0
        self._busy: set[str] = set()
        """In which places somebody else was when the drive began."""
        self._asked_s = 0.0

    @property
    def waits_for(self) -> str:
        """For what it stands and waits, as people read it; empty: for nothing, or nobody knows yet."""
        wait = self._wait
        return _told(wait) if wait is not None and wait.known and wait.others else ""

    def _limited(self) -> list[MapArea]:
        return [area for area in self._places() if area.capacity is not None]

    # -- told -----------------------------------------------------------------------------------------------

    def claim(self) -> PassageClaim | None:
        """What is to be told with each heartbeat; None: there are no such places."""
        limited = self._limited()
        if not limited:
            return None
        if not self._drives and self._claim.wants and self._clock.now_s() - self._asked_s > _REST_S:
            self._want((), ())
        try:
            pose = self._robot.pose()
        except ActionFailure:  # where it was last it may still be
            return self._claim
        self._stand((pose.x_m, pose.y_m), limited)
        return self._claim

    def hear(self, told: PassageList) -> None:
        """Somebody says who is where."""
        self._told = told
        held = bool(self._claim.id) and told.granted.get(self._robot.name) == self._claim.id
        if held and not self._claim.held:
            self._claim = self._claim.model_copy(update={"held": True})
        self._tell()

    # -- driving --------------------------------------------------------------------------------------------

    def may_go(self, way: Sequence[Point] = ()) -> bool:
        """Whether the robot may drive on now.

        Args:
            way: What is before it, in the map frame; without one only what it would touch next counts.
        """
        limited = self._limited()
        if not limited:
            return True
        self._asked_s = self._clock.now_s()
        pose, radius_m = self._robot.pose(), self._robot.radius_m
        here = (pose.x_m, pose.y_m)
        reach_m = self._robot.velocity().speed_mps * _BRAKE_S
        self._stand(here, limited)
        gaps = {area.name: area.gap_m(*here) - radius_m for area in limited}
        self._look_ahead(here, way, limited, radius_m)
        touched = [name for name, gap_m in gaps.items() if 0.0 < gap_m <= _TOUCH_M + reach_m]
        wanted = [*self._ahead, *(name for name in touched if name not in self._ahead)]
        self._want(wanted, limited)  # one that it is in, too: it may have to come back out a little
        mine = {*self._claim.inside, *(self._claim.wants if self._claim.held else ())}
        waits = self._wait.place if self._wait is not None else ""  # where it waits it stays
        near = [
            name for name in wanted if name not in mine and (name == waits or gaps[name] <= _WAIT_M + reach_m)
        ]
        self._wait_for(near[0] if near else "")
        return not near

    def begin(self) -> None:
        """A drive to a goal begins."""
        self._drives += 1
        self._busy = {area.name for area in self._limited() if self._others(area.name)}
        self._ahead, self._looked_at = (), None

    def end(self) -> None:
        """It is over: what it has not entered it gives back."""
        self._drives -= 1
        self.rest()

    def rest(self) -> None:
        """It stands: others may go first."""
        self._ahead, self._looked_at = (), None
        if self._claim.wants:
            self._want((), ())
        self._wait_for("")

    async def cleared(self, at: Point) -> bool:
        """Whether whoever is in a place was in the way there, and is out of it now; it is waited for.

        Args:
            at: Where the way is blocked: seen from afar, one who stands in a doorway closes it.
        """
        limited = self._limited()
        reach_m = self._robot.radius_m + _BESIDE_M
        near = [area.name for area in limited if area.gap_m(*at) < reach_m]
        place = next((name for name in near if self._others(name) or name in self._busy), "")
        if not place:
            return False
        self._busy.discard(place)  # who was in it may stand before it for a moment
        self._want((place,), limited)
        while self._others(place):
            self._wait_for(place)
            await self._some_time()
        self._wait_for("")
        return True

    def _others(self, place: str) -> tuple[str, ...]:
        """Who else is in a place."""
        told = next((one.robots for one in self._told.places if one.name == place), ())
        return tuple(name for name in told if name != self._robot.name)

    async def attend(self, person: Asker) -> None:
        """While a drive goes on: tell and ask what there is to say of its waiting; never returns.

        Raises:
            ActionFailure: `blocked`, `unavailable`: it has waited in vain.
        """
        while True:
            await self._until(lambda: self._wait is not None)
            began_s, since_s, told = self._clock.now_s(), self._clock.wall_s(), ""
            while (wait := self._wait) is not None:
                if wait.known and wait.others and (text := _told(wait)) != told:
                    told = text
                    person.tell(text)
                if wait.others:
                    since_s = self._clock.wall_s()
                else:  # whoever gives places, in wall time, has not given it yet
                    began_s = self._clock.now_s()
                if self._clock.wall_s() - since_s > UNHEARD_S:
                    raise ActionFailure(FailureCode.UNAVAILABLE, _in_vain(wait))
                if wait.stuck or self._clock.now_s() - began_s > PATIENCE_S:
                    raise ActionFailure(FailureCode.BLOCKED, _in_vain(wait), {TAKEN: wait.place})
                if wait.lost:
                    await self._ask_about(wait, person)
                await self._some_time()

    async def _ask_about(self, wait: _Wait, person: Asker) -> None:
        """Nobody but a person knows whether one that does not answer is still there."""
        who = ", ".join(wait.lost)
        question = sentence(
            "{robot} does not answer any more, and may still stand in “{place}”. Is it out of the way?",
            robot=who, place=wait.place,
        )  # fmt: skip
        asking = asyncio.ensure_future(person.ask(question, ("Yes", "No")))
        free = asyncio.ensure_future(self._until(lambda: not self._is_kept_by(wait)))
        try:
            await asyncio.wait((asking, free), return_when=asyncio.FIRST_COMPLETED)
            if not asking.done():
                person.tell(sentence("“{place}” is free now, so I go on.", place=wait.place))
                return
            reply = await asking
        finally:
            for one in (asking, free):
                one.cancel()
        if assent_of(reply, (self._robot.name,)) is not True:
            text = sentence("{robot} stands in “{place}” and does not answer, so I do not go in.",
                            robot=who, place=wait.place)  # fmt: skip
            raise ActionFailure(FailureCode.BLOCKED, text, {TAKEN: wait.place})
        self._claim = self._claim.model_copy(update={"without": tuple({*self._claim.without, *wait.lost})})
        self._change()
        await self._until(lambda: not self._is_kept_by(wait))

    def _is_kept_by(self, wait: _Wait) -> bool:
        """Whether it still waits for those that do not answer."""
        return self._wait is not None and bool({*self._wait.lost} & {*wait.lost})

    # -- what it claims -------------------------------------------------------------------------------------

    def _stand(self, here: Point, limited: Sequence[MapArea]) -> None:
        """Where it is now; what it has left it gives back."""
        radius_m = self._robot.radius_m
        inside = tuple(area.name for area in limited if area.gap_m(*here) < radius_m)
        if inside != self._claim.inside:
            room = {area.name: area.capacity for area in limited if area.name in inside}
            capacity = {**self._claim.capacity, **room}
            self._claim = self._claim.model_copy(update={"inside": inside, "capacity": capacity})
            self._looked_at = None
            self._change()

    def _look_ahead(
        self, here: Point, way: Sequence[Point], limited: Sequence[MapArea], radius_m: float
    ) -> None:
        """Which places the way leads through next, with those behind them that leave no room between."""
        if not way:  # it is being thought of anew
            return
        end = way[-1]
        if self._looked_at is not None and self._looked_at[1] == end:
            was = self._looked_at[0]
            if abs(was[0] - here[0]) + abs(was[1] - here[1]) < _LOOK_AGAIN_M:
                return
        self._looked_at = (here, end)
        along_m, last, found = 0.0, here, dict[str, tuple[float, float]]()
        for point in way[::2]:
            along_m += ((point[0] - last[0]) ** 2 + (point[1] - last[1]) ** 2) ** 0.5
            last = point
            for area in limited:
                if area.gap_m(*point) < radius_m:
                    found[area.name] = (found.get(area.name, (along_m, 0.0))[0], along_m)
        ahead: list[str] = []
        reached_m = _ASK_M
        for name, (enters_m, leaves_m) in sorted(found.items(), key=lambda one: one[1][0]):
            if enters_m <= reached_m:
                ahead.append(name)
                reached_m = max(reached_m, leaves_m + 2 * radius_m + _WAIT_M)
        self._ahead = tuple(ahead)

    def _want(self, names: Sequence[str], limited: Sequence[MapArea]) -> None:
        wants, before = tuple(names), self._claim
        if {*wants} == {*before.wants}:
            return
        fewer = before.held and {*wants} < {*before.wants}
        identity = before.id if fewer and wants else uuid.uuid4().hex if wants else ""
        room = {a.name: a.capacity for a in limited if a.name in wants and a.capacity is not None}
        self._claim = before.model_copy(
            update={
                "id": identity,
                "wants": wants,
                "held": fewer and bool(wants),
                "capacity": {**before.capacity, **room},
            }
        )
        self._change()

    def _wait_for(self, place: str) -> None:
        if not place:
            if self._wait is not None:
                self._wait = None
                self._tell()
            return
        state = next((one for one in self._told.places if one.name == place), PassageState(name=place))
        me = self._robot.name
        known = me in state.waiting or me in state.robots
        kept = (self._keep_out(name) for name in (place, *self._claim.wants))  # all is given, or nothing
        others = next(filter(None, kept), ())
        wait = _Wait(place, others, state.lost, me in self._told.stuck, known)
        if wait != self._wait:
            self._wait = wait
            self._tell()

    def _keep_out(self, place: str) -> tuple[str, ...]:
        """Who is in a place, or goes first."""
        waiting = next((one.waiting for one in self._told.places if one.name == place), ())
        me = self._robot.name
        return self._others(place) or (waiting[: waiting.index(me)] if me in waiting else ())

    # -- waiting --------------------------------------------------------------------------------------------

    def _tell(self) -> None:
        """There is something new; said in whichever thread the robot is driven."""
        with contextlib.suppress(RuntimeError):  # everything is being closed
            self._loop.call_soon_threadsafe(self._news.set)

    def _change(self) -> None:
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self.changed)

    async def _until(self, condition: Callable[[], bool]) -> None:
        while not condition():
            self._news.clear()
            await self._news.wait()

    async def _some_time(self) -> None:
        """Until something is new; robot time goes on meanwhile, whoever else needs none."""
        self._news.clear()
        news = asyncio.ensure_future(self._news.wait())
        time = asyncio.ensure_future(self._clock.sleep(1.0))
        try:
            await asyncio.wait((news, time), return_when=asyncio.FIRST_COMPLETED)
        finally:
            for one in (news, time):
                one.cancel()
                with contextlib.suppress(asyncio.CancelledError):
                    await one


def _told(wait: _Wait) -> Sentence:
    return sentence("I am waiting before “{place}”: {robots} goes first.",
                    place=wait.place, robots=", ".join(wait.others))  # fmt: skip


def _in_vain(wait: _Wait) -> Sentence:
    if not wait.others:
        return sentence("Nobody tells me whose turn it is at “{place}”, so I do not go in.", place=wait.place)
    who = ", ".join(wait.others)
    if wait.stuck:
        return sentence("{robots} and I are in each other’s way at “{place}”.", robots=who, place=wait.place)
    return sentence("I have waited before “{place}” for long, and {robots} is still in it.",
                    place=wait.place, robots=who)  # fmt: skip
