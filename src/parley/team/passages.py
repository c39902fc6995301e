"""Who may be where: places with room for so many robots are given in turn, and never by halves. Pure.

A robot is given all that it wants at once or nothing, so that nobody holds one place and waits for the next.
Where it stands counts by itself, however it came there. Whoever asked first goes first, unless he waits
himself for the one behind him to come out. Robots that stand in each other's way all the same are told so:
one has to give way.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

from parley.messages.passages import PassageClaim, PassageList, PassageState

__all__ = ["PassageBook"]


@dataclass(slots=True)
class _Entry:
    claim: PassageClaim
    number: int
    """In which turn it asked."""
    granted: bool = False
    lost: bool = False

    @property
    def uses(self) -> frozenset[str]:
        return frozenset((*self.claim.inside, *(self.claim.wants if self.granted else ())))

    @property
    def waits(self) -> bool:
        return bool(self.claim.wants) and not self.granted and not self.lost


class PassageBook:
    """All claims.

    Args:
        gives: Whether places are given yet: who has just been started does not know who holds which.
    """

    def __init__(self, *, gives: bool = True) -> None:
        self.gives = gives
        self._entries: dict[str, _Entry] = {}
        self._capacity: dict[str, int] = {}
        self._numbers = itertools.count()

    def take(self, robot: str, claim: PassageClaim | None) -> None:
        """What a robot tells, as often as it likes; None: it knows of no such places."""
        before = self._entries.pop(robot, None)
        claim = claim or PassageClaim()
        for place, room in claim.capacity.items():
            self._capacity[place] = room
        for name in claim.without:
            if (gone := self._entries.get(name)) is not None and gone.lost:
                del self._entries[name]
        same = before is not None and before.claim.id == claim.id and not before.lost
        entry = _Entry(claim, before.number if same and before else next(self._numbers))
        entry.granted = bool(claim.wants) and (claim.held or (same and before is not None and before.granted))
        if claim.wants or claim.inside:
            self._entries[robot] = entry

    def lose(self, robot: str) -> None:
        """A robot does not answer any more: what it had it keeps, until it is back or a person says more."""
        entry = self._entries.get(robot)
        if entry is not None:
            entry.lost = True
            if not entry.uses:
                del self._entries[robot]

    def leave(self, robot: str) -> None:
        """A robot says goodbye: it goes nowhere any more, but where it stands it stands."""
        entry = self._entries.get(robot)
        if entry is not None:
            entry.granted = False
            self.lose(robot)

    def settle(self) -> PassageList:
        """Give what can be given; how it stands then."""
        waiting = sorted((e.number, robot) for robot, e in self._entries.items() if e.waits)
        for _, robot in waiting if self.gives else ():
            entry = self._entries[robot]
            if all(self._has_room(place, robot) for place in entry.claim.wants) and not self._jumps(robot):
                entry.granted = True
        stuck = {max(circle, key=lambda r: self._entries[r].number) for circle in self._circles()}
        names = sorted({place for e in self._entries.values() for place in (*e.uses, *e.claim.wants)})
        return PassageList(
            places=tuple(self._state(name) for name in names),
            granted={robot: e.claim.id for robot, e in sorted(self._entries.items()) if e.granted},
            stuck=tuple(sorted(stuck)),
        )

    def _state(self, place: str) -> PassageState:
        there = [robot for robot, e in sorted(self._entries.items()) if place in e.uses]
        waiting = sorted(
            (e.number, r) for r, e in self._entries.items() if e.waits and place in e.claim.wants
        )
        return PassageState(
            name=place,
            robots=tuple(there),
            lost=tuple(robot for robot in there if self._entries[robot].lost),
            waiting=tuple(robot for _, robot in waiting),
        )

    def _has_room(self, place: str, robot: str) -> bool:
        others = sum(place in e.uses for name, e in self._entries.items() if name != robot)
        return others < self._capacity.get(place, 1)

    def _jumps(self, robot: str) -> bool:
        """Whether somebody who asked before wants a part of the same, and is not kept from it by this one."""
        return any(robot not in self._awaited(name, self._before) for name in self._before(robot))

    def _before(self, robot: str) -> set[str]:
        """Whose turn comes first, and who keeps a waiting robot from what it wants."""
        own = self._entries[robot]
        earlier = {
            name
            for name, e in self._entries.items()
            if own.waits and e.waits and e.number < own.number and {*e.claim.wants} & {*own.claim.wants}
        }
        return earlier | self._holders(robot)

    def _holders(self, robot: str) -> set[str]:
        """Who is where a waiting robot wants to be."""
        entry = self._entries[robot]
        wanted = entry.claim.wants if entry.waits else ()
        full = {place for place in wanted if not self._has_room(place, robot)}
        return {name for name, e in self._entries.items() if name != robot and full & e.uses}

    def _awaited(self, robot: str, before: Callable[[str], set[str]]) -> set[str]:
        """Who has to move before a robot can go on, whoever they wait for themselves included."""
        found: set[str] = set()
        new = before(robot)
        while new:
            found |= new
            new = {other for name in new for other in before(name)} - found
        return found

    def _circles(self) -> list[set[str]]:
        """Robots each of which stands where the next one wants to be."""
        awaited = {robot: self._awaited(robot, self._holders) for robot in self._entries}
        return [
            {robot, *(name for name in others if robot in awaited[name])}
            for robot, others in awaited.items()
            if robot in others
        ]
