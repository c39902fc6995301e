"""Stops that operators press or say: carried out in whatever thread asks, and what is known of each robot."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Final

from parley.clock import Clock
from parley.gate.stop_line import StopLine
from parley.gate.stop_words import called
from parley.latest import Latest
from parley.messages.principal import Principal
from parley.messages.status import StopCommand
from parley.web.bodies import RobotStop
from parley.web.models import RobotView
from parley.web.robot_state import STOP_DEADLINE_S

__all__ = ["Stop", "Stopper"]

REMEMBERED: Final = 1000
"""Messages that are known to have held robots already, should they be sent again."""
WRITTEN_WITHIN_S: Final = 2.0
"""A stop that is not on disk after this time is said not to be kept."""


@dataclass(frozen=True, slots=True)
class Stop:
    """One emergency stop."""

    id: str
    robots: tuple[str, ...]
    halted: frozenset[str]
    """Whose drives were told here and now."""
    began_s: float


class Stopper:
    """Every method may be called from any thread and waits for nothing.

    Args:
        line: Of the engines in this process, if there are any; else the topic has to do.
        robots: Gives what is known of each robot.
        send: Publishes a command, sooner or later; may be called from any thread.
        clock: Wall time.
        at_rest: Whether a robot stands, measured now; None: that is not known here.
        known_stops: Gives the ids of the stops of these robots that are shown.
    """

    def __init__(
        self,
        line: StopLine | None,
        robots: Callable[[], Mapping[str, RobotView]],
        send: Callable[[StopCommand], None],
        clock: Clock,
        at_rest: Callable[[str], bool | None] = lambda _: None,
        known_stops: Callable[[Iterable[str]], tuple[str, ...]] = lambda _: (),
    ) -> None:
        self._known_stops = known_stops
        self._line, self._robots, self._send = line, robots, send
        self._clock, self._at_rest = clock, at_rest
        self._held: Latest[str, None] = Latest(REMEMBERED)
        self._lock = threading.Lock()

    def stop(self, targets: Iterable[str], *, by: Principal | None, id: str) -> Stop:
        """Emergency stop, of all robots where none is named. The same id again does no more."""
        named = self._named(targets)
        command = StopCommand(targets=named, id=id, by=by)
        halted: frozenset[str] = frozenset()
        names = named or tuple(name for name, view in self._views() if view.connection != "left")
        if self._line is not None:
            outcomes = self._line.pull(named, by=by, id=id, wait_s=0)
            halted = frozenset(outcome.robot for outcome in outcomes if outcome.state == "halted")
            names = tuple(dict.fromkeys((*names, *(outcome.robot for outcome in outcomes))))
        self._send(command)
        return Stop(id, names, halted, self._clock.wall_s())

    def reset(self, targets: Iterable[str], *, by: Principal | None, id: str) -> str:
        """Permit motion again; why not, if it is refused."""
        named = self._named(targets)
        command = StopCommand(command="reset", targets=named, id=id, by=by, stops=self._known_stops(named))
        if self._line is not None and (problems := self._line.reset(named, by=by, id=id)):
            return "; ".join(problem.message for problem in problems)
        self._send(command)
        return ""

    def hold(self, targets: Iterable[str], *, by: Principal | None, id: str, words: str) -> None:
        """Let robots, and whom the words call, stand while they are read; words sent again hold nobody."""
        with self._lock:
            if words and id in self._held:
                return
            self._held[id] = None
        named = self._named((*targets, *called(words, [name for name, _ in self._views()])))
        if self._line is not None:
            self._line.hold(named, id=id, by=by, words=words)
        else:
            self._send(StopCommand(command="hold", targets=named, id=id, by=by, words=words))

    def go_on(self, id: str, *, by: Principal | None = None) -> None:
        """Nobody will read that message, or the button was taken: let those go on whom it held."""
        if self._line is not None:
            self._line.go_on(id)
        else:
            self._send(StopCommand(command="go_on", id=id, by=by))

    def states(self, stop: Stop) -> dict[str, RobotStop]:
        """How the robots of a stop fare now."""
        views = dict(self._views())
        return {name: self._state(stop, name, views.get(name)) for name in stop.robots}

    @property
    def written(self) -> Future[str] | None:
        """Done once all that was stopped is on disk, with empty text; None: that is known elsewhere."""
        return None if self._line is None else self._line.written

    def is_kept(self, stop: Stop) -> bool:
        """Whether it stays so over a kill of this process; no: it could not be written, or it takes long."""
        written = self.written
        if written is None or not written.done():
            return written is None or self._clock.wall_s() - stop.began_s < WRITTEN_WITHIN_S
        return written.result() == ""

    def _state(self, stop: Stop, name: str, view: RobotView | None) -> RobotStop:
        rests = self._at_rest(name) if name in stop.halted else None
        if rests is not None:
            return "stands" if rests else "moves"
        state = view.stop.state if view is not None and view.stop.id == stop.id else "none"
        if state == "at_rest":
            return "stands"
        if state in ("received", "moves"):
            return "moves"
        return "silent" if self._clock.wall_s() - stop.began_s > STOP_DEADLINE_S else "sent"

    def _named(self, targets: Iterable[str]) -> tuple[str, ...]:
        """Robots by the names they have, whatever the capitals; unknown ones as they were called."""
        known = {name.casefold(): name for name, _ in self._views()}
        return tuple(dict.fromkeys(known.get(target.strip().casefold(), target) for target in targets))

    def _views(self) -> list[tuple[str, RobotView]]:
        return list(self._robots().items())  # at once: another thread may change it
