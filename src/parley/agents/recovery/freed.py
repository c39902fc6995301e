"""What kept a robot from its way when it had to ask, and does so no more: a place, another robot. Pure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from parley.latest import Latest
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.passages import TAKEN, PassageList
from parley.messages.status import ActorStatus
from parley.sentences import Sentence, sentence

__all__ = ["Freed"]

_BESIDE_M: Final = 1.2
"""Who stands so near to where the way is blocked is what blocks it."""
_AWAY_M: Final = 2.0


@dataclass(slots=True)
class _Block:
    place: str = ""
    robot: str = ""
    at: tuple[float, float] = (0.0, 0.0)
    asked: bool = False


class Freed:
    """Of all robots that ask about a failed step.

    Args:
        tell: Says to a robot's people that what was in its way is not any more, once for each failure.
    """

    def __init__(self, tell: Callable[[str, Sentence], None]) -> None:
        self._tell = tell
        self._blocks: Latest[str, _Block] = Latest()
        """By the robot that is kept from its way."""
        self._seen: dict[str, tuple[float, float]] = {}
        """Where robots are."""
        self._taken: dict[str, frozenset[str]] = {}

    def on_failure(self, failure: ErrorHandlingMessage) -> None:
        """A step failed."""
        self.forget(failure.target)
        place, at = failure.details.get(TAKEN), failure.details.get("at")
        if isinstance(place, str):
            self._blocks[failure.target] = _Block(place)
        elif isinstance(at, dict) and (found := self._nearest(failure.target, (at["x"], at["y"]))):
            self._blocks[failure.target] = _Block(robot=found, at=(at["x"], at["y"]))

    def on_asked(self, robot: str) -> None:
        """People are asked what a robot shall do about it."""
        if (block := self._blocks.get(robot)) is not None:
            block.asked = True
            self._look()

    def forget(self, robot: str) -> None:
        """It is asked about no longer."""
        self._blocks.pop(robot, None)

    def on_passages(self, told: PassageList) -> None:
        """Who is where."""
        self._taken = {one.name: frozenset(one.robots) for one in told.places}
        self._look()

    def on_status(self, status: ActorStatus) -> None:
        """A robot tells where it is."""
        if status.pose is not None:
            self._seen[status.actor] = (status.pose.x, status.pose.y)
            self._look()

    def _nearest(self, robot: str, at: tuple[float, float]) -> str:
        others = [(math.dist(here, at), name) for name, here in self._seen.items() if name != robot]
        far_m, name = min(others, default=(math.inf, ""))
        return name if far_m < _BESIDE_M else ""

    def _look(self) -> None:
        for name, block in [*self._blocks.items()]:
            if not block.asked or not self._is_free(name, block):
                continue
            self.forget(name)
            if block.place:
                self._tell(
                    name, sentence("“{place}” is free now. Say “try again” and I go on.", place=block.place)
                )
            else:
                text = "{robot} is out of the way now. Say “try again” and I go on."
                self._tell(name, sentence(text, robot=block.robot))

    def _is_free(self, name: str, block: _Block) -> bool:
        if block.place:
            return self._taken.get(block.place, frozenset()) <= {name}
        return math.dist(self._seen.get(block.robot, block.at), block.at) > _AWAY_M
