"""What a router denies, told in the log: who wanted to do what.

The library tells it only among the traces that it writes to the standard output, in a thread of its own.
"""

from __future__ import annotations

import os
import re
import sys
import threading
from dataclasses import dataclass
from types import TracebackType
from typing import Final, Self

import structlog
import zenoh

from parley.clock import Clock, WallClock
from parley.latest import Latest

__all__ = ["Denial", "Denials", "Reader"]

QUIET_S: Final = 60.0
"""For so long the same denial is not told again."""
REMEMBERED: Final = 1000
_HEADING: Final = re.compile(rb"ThreadId\((\d+)\).*: ACL \((in|e)gress\): caching permissions for `(.+)`")
_JUDGED: Final = re.compile(
    rb"ThreadId\((\d+)\).* (\S+) on (\S+) is (un)?authorized to (.+?) \(((?:in|e)gress)\) on (\S+)"
)
_AGAIN: Final = re.compile(rb"Using cached result: (\S+) is unauthorized to (.+?) \(ingress\) on (\S+)")
_NAME: Final = re.compile(r"(?:Username|CertCommonName)\((.*?)\)(?:\+|$)")
_DOES: Final = {"Put": "say", "Delete": "say", "Query": "ask", "Reply": "answer"}
_PARTS: Final = {
    "Liveliness Sub": "look for",
    "Liveliness Query": "look for",
    "Subscriber": "hear",
    "Queryable": "answer",
}
_KIND_AT, _NAME_AT = 5, 9
"""In the token of an end: see `keys`."""
_SHOWS: Final = {"MP": "say", "MS": "hear", "SS": "answer", "SC": "ask"}
_LEVELS: Final = "off,zenoh::net::routing::interceptor::access_control=trace"
_OUTPUT: Final = 1

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class Denial:
    """One thing that somebody may not do."""

    who: str
    """By its certificate or user name; else its id in the network."""
    does: str
    """`say`, `hear`, `ask`, `answer`, `show` (that it is there) or `look for` (who is there)."""
    name: str
    """Of the topic or service."""


class Reader:
    """Finds what was denied among the lines of the library's trace.

    For each key that is new it tells what would be denied, before anybody does anything: that is passed over.
    """

    def __init__(self) -> None:
        self._names: Latest[bytes, str] = Latest(REMEMBERED)
        """Session -> who it is."""
        self._foretold: dict[bytes, tuple[bytes, set[bytes]]] = {}
        """Thread -> the key of which it foretells, and what it has foretold."""

    def read(self, line: bytes) -> Denial | None:
        """What was denied; None: nothing, or what one is not to hear of, which is another's doing."""
        if b"Using cached result" in line:
            again = _AGAIN.search(line) if b" unauthorized " in line else None
            return None if again is None else self._denial(*again.groups())
        if (heading := _HEADING.search(line)) is not None:
            self._foretold[heading[1]] = heading[3], set()
            return None
        if (judged := _JUDGED.search(line)) is None:
            return None
        thread, session, subject, denied, what, way, key = judged.groups()
        names = dict.fromkeys(_NAME.findall(subject.decode(errors="replace")))
        self._names[session] = " and ".join(names) or session.decode()
        of, told = self._foretold.get(thread, (b"", {what}))
        if key == of and what not in told:
            told.add(what)
            return None
        return self._denial(session, what, key) if denied and way == b"ingress" else None

    def _denial(self, session: bytes, what: bytes, key: bytes) -> Denial:
        who = self._names.get(session) or session.decode()
        action, parts = what.decode(), key.decode(errors="replace").split("/")
        does = _DOES.get(action) or next((word for part, word in _PARTS.items() if part in action), "show")
        if does == "show" and len(parts) > _NAME_AT:
            # Who sees nobody that wants it says nothing: he only shows that he would.
            does = _SHOWS.get(parts[_KIND_AT], does)
        return Denial(who, does, _plain(parts))


class Denials:
    """Tells them while it is open; `with`, around a router, in its own process, whose output passes here.

    Args:
        clock: Wall time.
    """

    def __init__(self, clock: Clock | None = None) -> None:
        self._clock: Clock = clock or WallClock()
        self._told_s: Latest[Denial, float] = Latest(REMEMBERED)

    def __enter__(self) -> Self:
        sys.stdout.flush()
        self._output = os.dup(_OUTPUT)
        reads, writes = os.pipe()
        os.dup2(writes, _OUTPUT)
        os.close(writes)
        self._before, sys.stdout = sys.stdout, os.fdopen(os.dup(self._output), "w", buffering=1)
        self._thread = threading.Thread(target=self._read, args=(reads,), name="denials", daemon=True)
        self._thread.start()
        wished = {"RUST_LOG": _LEVELS, "NO_COLOR": "1"}
        before = {name: os.environ.get(name) for name in wished}
        os.environ.update(wished)
        zenoh.init_log_from_env_or(_LEVELS)
        for name, value in before.items():
            os.environ.pop(name) if value is None else os.environ.update({name: value})
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        sys.stdout.close()
        sys.stdout = self._before
        os.dup2(self._output, _OUTPUT)  # the last end of the pipe, so that who reads there ends
        os.close(self._output)
        self._thread.join()

    def _read(self, reads: int) -> None:
        reader = Reader()
        with os.fdopen(reads, "rb") as lines:
            for line in lines:
                denial = reader.read(line)
                if denial is not None:
                    self._tell(denial)

    def _tell(self, denial: Denial) -> None:
        now_s = self._clock.wall_s()
        if now_s - self._told_s.get(denial, -QUIET_S) < QUIET_S:
            return
        self._told_s[denial] = now_s
        log.error("denied", who=denial.who, may_not=denial.does, name=denial.name)


def _plain(parts: list[str]) -> str:
    """A key as ROS names it: `0/Ada/cmd_vel/<type>/<hash>` is `/Ada/cmd_vel`."""
    if parts[0] == "@ros2_lv":
        return parts[_NAME_AT].replace("%", "/") if len(parts) > _NAME_AT else "/".join(parts)
    end = next((at for at, part in enumerate(parts) if "::" in part or part == "@adv"), len(parts))
    return "/" + "/".join(parts[1:end])
