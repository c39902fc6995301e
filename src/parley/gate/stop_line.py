"""The line that stops robots: pulled from any thread, it waits for no loop, no disk and no queue.

Each robot is tied to it by three functions. `halt` and `resume` are called at once, in the thread that pulls;
`told` puts the rest (pausing graphs, reports) on the loop of whoever owns the robot, and nobody waits for it.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Collection, Iterable
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

from parley.errors import ActionFailure, Problem
from parley.gate.latch_file import LatchFile
from parley.gate.notes import note
from parley.gate.table import Effect, verdict
from parley.messages.principal import Principal
from parley.messages.status import StopCommand

__all__ = ["WRITTEN_WITHIN_S", "StopLine", "StopOutcome"]

WRITTEN_WITHIN_S: Final = 0.25
"""How long whoever pulls may wait until it is on disk; the robots are halted before that."""
LET_GO_KEPT: Final = 1000


@dataclass(frozen=True, slots=True)
class StopOutcome:
    """What an emergency stop did to one robot."""

    robot: str
    state: Literal["halted", "absent", "failed"]
    """`halted`: its drive was told and refuses to move; `absent`: it is not tied to this line, and will be
    held when it comes; `failed`: its drive could not be told."""
    problem: str = ""
    """Why it failed."""
    written: bool = False
    """Whether it is on disk, and so in force even if the process is killed now."""


@dataclass(slots=True, eq=False)
class _Tied:
    """One robot on the line."""

    robot: str
    halt: Callable[[], None]
    resume: Callable[[], None]
    told: Callable[[StopCommand], None]
    lock: threading.RLock = field(default_factory=threading.RLock)
    """Held while its drive is told, so that no late `resume` undoes a `halt`."""
    last_id: str | None = None
    """Of the emergency stop in force that its owner knows of."""


class StopLine:
    """Stops, holds and releases robots; see the module's text. Every method may be called from any thread.

    Args:
        file: Where emergency stops are kept over the end of the process; None: nowhere.
        robots: Who belongs to it although they may not be tied yet.
    """

    def __init__(self, file: Path | None = None, robots: Iterable[str] = ()) -> None:
        self._file = LatchFile(file)
        self._latched = self._file.read()
        self.in_doubt = self._file.in_doubt
        """Whether everybody is latched because nobody knows who was."""
        self._lock = threading.Lock()
        self._known = set(robots)
        self._tied: dict[str, _Tied] = {}
        self._holds: dict[str, frozenset[str]] = {}
        self._let_go: deque[str] = deque(maxlen=LET_GO_KEPT)
        """The holds that were ended: a copy that comes late, or behind its end, holds nobody."""
        self._resets: deque[str] = deque(maxlen=100)
        """Ids of those that took effect: heard again, late, one must not release what was stopped since."""
        self._past: deque[str] = deque(maxlen=100)
        """Ids of emergency stops that were released."""
        self._newest: dict[str, str] = {}
        """Robot -> the id of the emergency stop in force, as far as it came to this line."""
        self._saved = self._file.save(self._latched)  # so that there is a file which can be emptied later

    def close(self) -> None:
        """Write what is still to be written; what is latched stays so. Idempotent."""
        self._file.close()

    # -- robots ---------------------------------------------------------------------------------------------

    def attach(
        self,
        robot: str,
        *,
        halt: Callable[[], None],
        resume: Callable[[], None],
        told: Callable[[StopCommand], None],
    ) -> Callable[[], None]:
        """Tie a robot to the line; it is halted at once if it is latched or held.

        Args:
            robot: Its name; whoever was tied by that name before is no longer. A latched one is stopped anew.
            halt: Brings its drive to rest and has it refuse every command until `resume`. Thread-safe,
                returns at once, may be called again; raises `ActionFailure` if the drive cannot be told.
            resume: Lets it take commands again; moves nothing. As `halt`.
            told: Gets every command that concerns it, in the thread that pulls; only schedules the rest.

        Returns:
            What unties it; latched it stays.
        """
        tied = _Tied(robot, halt, resume, told)
        with self._lock:
            self._known.add(robot)
            self._tied[robot] = tied

        def detach() -> None:
            with self._lock:
                if self._tied.get(robot) is tied:
                    del self._tied[robot]

        if self._stands(robot):
            self._tell_drive(tied)
        if self.latched(robot):
            self._tell_owner(tied, StopCommand(targets=(robot,)))
        return detach

    def latched(self, robot: str) -> bool:
        """Whether an emergency stop of that robot is in force."""
        return self._latched.holds(robot)

    def latched_elsewhere(self, robot: str) -> bool:
        """Whether that holds for a robot that is not tied to this line."""
        return robot not in self._tied and self.latched(robot)

    def in_force(self, robot: str) -> str:
        """The id of the emergency stop of that robot; empty: none, or one of an earlier process."""
        return self._newest.get(robot, "") if self.latched(robot) else ""

    def is_past(self, id: str) -> bool:
        """Whether that emergency stop was released: a copy of it that comes late is none."""
        return id in self._past

    def held_by(self, robot: str) -> tuple[str, ...]:
        """The ids of the holds by which it stands still, while a message is read or until it may go on."""
        return tuple(id for id, names in tuple(self._holds.items()) if not names or robot in names)

    # -- commands -------------------------------------------------------------------------------------------

    def pull(
        self,
        targets: Iterable[str] = (),
        *,
        by: Principal | None,
        id: str = "",
        words: str = "",
        wait_s: float = WRITTEN_WITHIN_S,
    ) -> tuple[StopOutcome, ...]:
        """Emergency stop: drives first, then the file, then whoever else has to know.

        Args:
            targets: Robots by name, also such as are away or unknown; none: all, strangers included.
            by: Who stops; anybody may.
            id: Names this stop; pulling again with the same id tells owners nothing new.
            words: What was said or pressed.
            wait_s: For so long it may wait until it is on disk. On a loop 0, and `written` instead.
        """
        command = StopCommand(targets=self._meant(targets), id=id, by=by, words=words)
        with self._lock:
            self._latched = self._latched.stopped(command.targets)
            self._saved = self._file.save(self._latched)
            saved = self._saved
            self._newest.update(dict.fromkeys(command.targets or (*self._known, *self._newest), id))
            tied = self._named(command.targets)
            absent = sorted({*(command.targets or self._known)} - {item.robot for item in tied})
        problems = {item.robot: self._tell_drive(item) for item in tied}
        for item in tied:
            if item.last_id != command.id:
                item.last_id = command.id
                self._tell_owner(item, command)
        written = _within(saved, wait_s)
        halted = [
            StopOutcome(name, "failed" if why else "halted", why, written) for name, why in problems.items()
        ]
        return (*halted, *(StopOutcome(name, "absent", "", written) for name in absent))

    def hold(
        self,
        targets: Iterable[str] = (),
        *,
        id: str,
        by: Principal | None,
        words: str = "",
    ) -> None:
        """Let drives stand still while something is read, until `go_on` with that id; not kept on disk.

        Args:
            targets: Robots by name; none: all.
            id: Names this hold; several may overlap.
            by: Who said it.
            words: What is being read.
        """
        command = StopCommand(command="hold", targets=self._meant(targets), id=id, by=by, words=words)
        with self._lock:
            if id in self._let_go:
                return
            self._holds[id] = frozenset(command.targets)
            tied = self._named(command.targets)
        for item in tied:
            self._tell_drive(item)
        for item in tied:
            self._tell_owner(item, command)

    def go_on(self, id: str) -> None:
        """Let go what `hold` with that id held, as far as no other hold and no emergency stop holds it."""
        with self._lock:
            self._let_go.append(id)
            targets = self._holds.pop(id, None)
            tied = () if targets is None else self._named(targets)
        for item in tied:
            self._tell_drive(item)
            self._tell_owner(item, StopCommand(command="go_on", targets=tuple(targets or ()), id=id))

    def reset(
        self,
        targets: Iterable[str] = (),
        *,
        by: Principal | None,
        id: str = "",
        stops: Collection[str] = (),
    ) -> tuple[Problem, ...]:
        """Permit motion again; nothing moves by it. Only a person's counts.

        Args:
            targets: Robots by name; none: all.
            by: Who releases.
            id: Names this reset; resetting again with the same id does nothing more.
            stops: See `StopCommand.stops`.

        Returns:
            Why it was refused, or which drives could not be told (these stay latched).
        """
        if verdict(by, Effect.RESET) != "allow":
            return (
                Problem(
                    "by",
                    "only a person releases an emergency stop",
                    "release it at the page or in the terminal",
                    "reset_refused",
                ),
            )
        named = self._meant(targets)
        with self._lock:
            if id and id in self._resets:
                return ()
            problems, named = self._stopped_since(named, stops)
            if problems and not named:
                return tuple(problems)
            self._resets.append(id)
            past = {self.in_force(name) for name in named or self._known} - {"", *self._past}
            self._past.extend(past)
            command = StopCommand(command="reset", targets=named, id=id, by=by)
            self._latched = self._latched.released(command.targets, self._known)
            for name in [name for name, held in self._holds.items() if _ended_by(held, command.targets)]:
                del self._holds[name]  # whoever reads may have died, and a person says that it may go on
            self._saved = self._file.save(self._latched)
            tied = self._named(command.targets)
        for item in tied:
            why = self._tell_drive(item)
            if why:
                with self._lock:
                    self._latched = self._latched.stopped([item.robot])
                    self._saved = self._file.save(self._latched)
                    self._resets.clear()  # trying again is no repetition
                text = f"the stop of {item.robot} cannot be released: {why}"
                problems.append(Problem("", text, "try again", "reset_failed"))
                continue
            item.last_id = None
            self._tell_owner(item, command)
        return tuple(problems)

    @property
    def written(self) -> Future[str]:
        """Done once all that was latched up to now is on disk (empty text) or could not be (the reason)."""
        return self._saved

    # -- inside ---------------------------------------------------------------------------------------------

    def _stopped_since(
        self, named: tuple[str, ...], stops: Collection[str]
    ) -> tuple[list[Problem], tuple[str, ...]]:
        """Whom a release that knows these stops leaves stopped, and whom not; the caller holds the lock."""
        every = named or tuple(sorted(self._known))
        since = [name for name in every if stops and self.in_force(name) not in ("", *stops)]
        problems = [
            Problem(
                "", f"{name} was stopped again since", "look at it, and release that stop", "stopped_since"
            )
            for name in since
        ]
        return problems, tuple(name for name in every if name not in since) if since else named

    def _stands(self, robot: str) -> bool:
        return self.latched(robot) or bool(self.held_by(robot))

    def _meant(self, targets: Iterable[str]) -> tuple[str, ...]:
        """The names as they are known, whatever their capitals; an unknown one stays as it is."""
        with self._lock:
            known = {name.casefold(): name for name in self._known}
        return tuple(known.get(name.casefold(), name) for name in targets)

    def _named(self, targets: Iterable[str]) -> tuple[_Tied, ...]:
        """Those who are tied, of these or of all; the caller holds the lock."""
        names = tuple(targets)
        return tuple(item for name, item in self._tied.items() if not names or name in names)

    def _tell_drive(self, item: _Tied) -> str:
        """Halt or release its drive, as is right now; why that did not work."""
        with item.lock:
            try:
                if self._stands(item.robot):
                    item.halt()
                else:
                    item.resume()
            except ActionFailure as failure:
                note("drive cannot be told", actor=item.robot, reason=failure.message)
                return failure.message
            except Exception as error:  # noqa: BLE001 - told to whoever pulls
                # Whatever is wrong with one robot, the others must be halted; whoever pulled is told.
                note("drive cannot be told", actor=item.robot, exc_info=True)
                return f"{type(error).__name__}: {error}"
        return ""

    def _tell_owner(self, item: _Tied, command: StopCommand) -> None:
        try:
            item.told(command)
        except RuntimeError:  # its loop is closed: there is nothing left that could be told
            note("nobody there to be told of a stop", actor=item.robot, command=command.command)


def _ended_by(held: frozenset[str], released: tuple[str, ...]) -> bool:
    return not released or (bool(held) and held.issubset(released))


def _within(saved: Future[str], wait_s: float) -> bool:
    try:
        return saved.result(wait_s) == ""
    except TimeoutError:
        return False
