"""Which robots there are, how they fare, and how far their emergency stops have come. No loop, no clock."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from parley.messages.status import ActorStatus, PlanUpdate, StopCommand, StopReport
from parley.web.models import AbilityView, Change, Policy, RobotChange, RobotGone, RobotView, StopView

__all__ = ["LOST_AFTER_S", "STOP_DEADLINE_S", "RobotBook"]

LOST_AFTER_S: Final = 2.0
"""Wall time without a heartbeat, of which there is one a second, after which a robot does not answer."""
STOP_DEADLINE_S: Final = 3.0
"""Wall time from an emergency stop within which the robot must have confirmed that it stands."""
RELEASE_HOLDS_S: Final = 30.0
"""Wall time for which a release waits for a robot out of reach: who pressed it still looks."""
AGAIN_S: Final = 1.0
_AFTER: Final = {"sent": "silent", "received": "moves"}
"""What a stop that is not confirmed becomes after the deadline."""


@dataclass(slots=True)
class _Release:
    """One that a robot has not confirmed."""

    command: StopCommand
    pressed_s: float
    told_s: float


class RobotBook:
    """All robots by name.

    Args:
        emit: Gets each change.
    """

    def __init__(self, emit: Callable[[Change], None]) -> None:
        self._emit = emit
        self.views: dict[str, RobotView] = {}
        self._seen_s: dict[str, float] = {}
        self._sequence: dict[str, int] = {}
        self._stop_s: dict[str, float] = {}
        self._stops: dict[str, StopCommand] = {}
        """The newest stop of each robot."""
        self._received: set[str] = set()
        """Whose engine confirmed the stop that is on."""
        self._known_stops: dict[str, frozenset[str]] = {}
        """The stops of each robot that were heard of here since it was released, by id."""
        self._releases: dict[str, _Release] = {}
        """Whose release is not confirmed."""
        self._policies: dict[str, Policy] = {}
        """What the planner told, of robots too that were not heard of yet."""

    def resolve(self, name: str) -> str | None:
        """The robot that `name` means, whatever its capitals."""
        wanted = name.strip().casefold()
        return next((known for known in self.views if known.casefold() == wanted), None)

    def add(self, name: str) -> RobotView:
        """List a robot that was named by a person; one that is known already stays as it is."""
        known = self.resolve(name)
        if known is not None:
            return self.views[known]
        self._put(self._new(name))
        return self.views[name]

    def _new(self, name: str) -> RobotView:
        return RobotView(name=name, policy=self._policies.get(name, "run_at_once"))

    def remove(self, name: str) -> None:
        """Take a robot off the list; it comes back with its next heartbeat."""
        if self.views.pop(name, None) is not None:
            for book in (self._seen_s, self._sequence, self._stop_s, self._stops, self._known_stops):
                book.pop(name, None)
            self._releases.pop(name, None)
            self._received.discard(name)
            self._emit(RobotGone(seq=0, name=name))

    def on_status(self, status: ActorStatus, *, now_s: float, unix_ms: int) -> bool:
        """A heartbeat.

        Args:
            status: What the robot says of itself.
            now_s: Wall time, monotonic.
            unix_ms: Wall time for people.

        Returns:
            Whether the robot was started anew since its last heartbeat.
        """
        name = status.actor
        view = self.views.get(name) or self._new(name)
        if status.state == "leaving":
            self._seen_s.pop(name, None)
            self._put(view.model_copy(update={"connection": "left", "state": "leaving"}))
            return False
        restarted = status.sequence < self._sequence.get(name, 0) or view.connection == "left"
        self._seen_s[name], self._sequence[name] = now_s, status.sequence
        self._put(
            view.model_copy(
                update={
                    "state": status.state,
                    "connection": "here",
                    "last_seen_unix_ms": unix_ms,
                    "pose": status.pose,
                    "at_rest": status.at_rest,
                    "battery": status.battery,
                    "trouble": status.trouble,
                    "map_name": status.map_name,
                    "graphs": status.graphs,
                    "catalogue": tuple(map(AbilityView.of, status.catalogue)),
                    "stop": self._stop_after(view.stop, status, restarted=restarted, unix_ms=unix_ms),
                }
            )
        )
        return restarted

    def on_plan(self, update: PlanUpdate) -> None:
        """Take over the policy that the planner tells with each plan."""
        self._policies[update.target] = update.policy
        view = self.views.get(update.target)
        if view is not None:
            self._put(view.model_copy(update={"policy": update.policy}))

    def on_stop(self, command: StopCommand, *, now_s: float, unix_ms: int) -> None:
        """Somebody pressed stop, or reset it; holding for a moment is none of the two."""
        if command.command not in ("stop", "reset"):
            return
        for name in self._meant(command.targets):
            view = self.views[name]
            if command.command == "stop":
                self._stop_s[name], self._stops[name] = now_s, command
                self._received.discard(name)
                self._learn_stop(name, command.id)
                self._releases.pop(name, None)
                stop = StopView(state="sent", id=command.id, sent_unix_ms=unix_ms)
                self._put(view.model_copy(update={"stop": stop}))
                continue
            told = self._releases.get(name)
            if view.stop.state != "none" and (told is None or told.command.id != command.id):
                known = self.known_stops((name,))
                release = command.model_copy(update={"targets": (name,), "stops": command.stops or known})
                self._releases[name] = _Release(release, now_s, now_s)
                stop = view.stop.model_copy(update={"release": "sent"})
                if name not in self._received and view.stop.state in ("sent", "silent"):
                    stop = StopView()  # nobody ever took it, so nobody will confirm that it is taken back
                self._put(view.model_copy(update={"stop": stop}))

    def _learn_stop(self, name: str, id: str) -> None:
        self._known_stops[name] = self._known_stops.get(name, frozenset()) | {id}

    def known_stops(self, targets: Iterable[str]) -> tuple[str, ...]:
        """The stops of these robots, or of all, that whoever looks here knows of."""
        return tuple(sorted({id for name in self._meant(targets) for id in self._known_stops.get(name, ())}))

    def not_taken(self, name: str) -> StopCommand | None:
        """The stop that a robot did not hear, though it is heard itself: it was out of reach then."""
        view = self.views.get(name)
        if view is None or name in self._received or view.stop.state not in ("sent", "silent"):
            return None
        stop = self._stops.get(name)
        return None if stop is None else stop.model_copy(update={"targets": (name,)})

    def untaken(self) -> tuple[StopCommand, ...]:
        """The stops that robots have not confirmed, each robot's."""
        return tuple(stop for name in self.views if (stop := self.not_taken(name)) is not None)

    def not_released(self, name: str, *, now_s: float) -> StopCommand | None:
        """The release that a robot did not hear, though it is heard itself: it was out of reach."""
        release, view = self._releases.get(name), self.views.get(name)
        if release is None or view is None or view.state != "stopped" or now_s - release.told_s < AGAIN_S:
            return None
        release.told_s = now_s
        return release.command

    def on_stop_report(self, report: StopReport, *, unix_ms: int) -> None:
        """A robot tells what became of a stop."""
        view = self.views.get(report.actor)
        if view is None:
            return
        stop = view.stop
        if report.state == "reset":
            self._releases.pop(report.actor, None)
            self._known_stops.pop(report.actor, None)
            self._received.discard(report.actor)
            stop = StopView()
        else:
            self._received.add(report.actor)
            stop = stop.model_copy(update={"id": stop.id or report.id})
            if report.state == "at_rest":
                stop = stop.model_copy(update={"state": "at_rest", "at_rest_unix_ms": unix_ms})
            elif report.state == "silent":
                stop = stop.model_copy(update={"state": "silent"})
            elif stop.state in ("none", "sent"):
                stop = stop.model_copy(update={"state": "received"})
            elif stop.state == "silent":
                stop = stop.model_copy(update={"state": "moves"})
        self._put(view.model_copy(update={"stop": stop}))

    def tick(self, *, now_s: float, late_s: float = 0.0) -> None:
        """Time passes: notice who is silent and which stops are overdue.

        Args:
            now_s: Wall time.
            late_s: How much later than it wanted the caller comes. So long no robot was heard here, and none
                counts as silent for it; a stop is overdue all the same.
        """
        for name, view in list(self.views.items()):
            if name in self._seen_s:
                self._seen_s[name] = min(now_s, self._seen_s[name] + max(0.0, late_s))
            if view.connection == "here" and now_s - self._seen_s.get(name, now_s) > LOST_AFTER_S:
                view = view.model_copy(update={"connection": "lost"})
            if now_s - self._stop_s.get(name, now_s) > STOP_DEADLINE_S and view.stop.state in _AFTER:
                late = {"state": _AFTER[view.stop.state]}
                view = view.model_copy(update={"stop": view.stop.model_copy(update=late)})
            release = self._releases.get(name)
            if release is not None and now_s - release.pressed_s > RELEASE_HOLDS_S:
                view = view.model_copy(update={"stop": self._lost(name, view.stop)})
            self._put(view)

    def _lost(self, name: str, stop: StopView) -> StopView:
        """Nobody is told of that release any more."""
        self._releases.pop(name, None)
        return stop if stop.state == "none" else stop.model_copy(update={"release": "lost"})

    def _meant(self, targets: Iterable[str]) -> list[str]:
        named = [name for target in targets if (name := self.resolve(target)) is not None]
        return named if targets else [name for name, view in self.views.items() if view.connection != "left"]

    def _stop_after(self, stop: StopView, status: ActorStatus, *, restarted: bool, unix_ms: int) -> StopView:
        """A heartbeat says too whether a stop is on, for those who came later than the stop."""
        name = status.actor
        if status.state != "stopped":
            if restarted and name not in self._received and stop.state in ("sent", "silent"):
                return stop  # it is told of it again
            self._releases.pop(name, None)
            if restarted:
                self._received.discard(name)
                return StopView()
            return stop
        self._received.add(name)
        if status.stop:
            self._learn_stop(name, status.stop)
        if (release := self._releases.get(name)) is not None:
            # It may have been stopped anew meanwhile, or before it was started anew.
            other = restarted or (bool(status.stop) and status.stop not in release.command.stops)
            stop = self._lost(name, stop) if other else stop.model_copy(update={"release": "sent"})
        if status.at_rest and stop.state != "at_rest":
            return stop.model_copy(update={"state": "at_rest", "at_rest_unix_ms": unix_ms})
        return stop.model_copy(update={"state": "received"}) if stop.state == "none" else stop

    def _put(self, view: RobotView) -> None:
        """Keep `view`, and tell it if more changed than the time of the last heartbeat."""
        before = self.views.get(view.name)
        self.views[view.name] = view
        if before is None or before.model_copy(update={"last_seen_unix_ms": view.last_seen_unix_ms}) != view:
            self._emit(RobotChange(seq=0, robot=view))
