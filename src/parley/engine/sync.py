"""What the engines of several actors tell each other about the graphs they carry out together (13).

Every engine runs the whole graph; a node of another actor only waits there until that actor's engine says how
it ended. In each run an engine has one list of what it says to the others. A notice brings what of it not all
have confirmed, and tells how much of theirs was taken; it is said again until they have. So nothing is taken
twice or out of order, whatever the network loses. Plain objects: notices come in by `Sync.take`, go out by a
function, and time is wall time.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import uuid
from collections import defaultdict, deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from parley.clock import Clock
from parley.engine.runs import stopped_by_stop
from parley.errors import ActionFailure, FailureCode, Problem
from parley.latest import Latest
from parley.messages.status import ActorStatus, SyncEntry, SyncNotice
from parley.umrf.model import BUSY, Node, Result
from parley.umrf.remote import RemoteEnd

__all__ = ["PEER_TIMEOUT_S", "Session", "Sync"]

PEER_TIMEOUT_S: Final = 5.0
"""How long an engine waits for the others: to answer a start, to confirm an end, to be heard of."""

RETRY_S: Final = 0.2
_KEPT: Final = 50
"""Sessions that are kept, so that late notices still find theirs."""


@dataclass(slots=True)
class _Peer:
    """Another actor in one run."""

    run: str = ""
    """Its own id of this run."""
    ready: bool = False
    """Whether it knows ours: only then does what it says count."""
    taken: int = 0
    """How much of what it said was taken."""
    confirmed: int = 0
    """How much of what was said here it has taken, or was given up."""


class Session:
    """One run of one graph by several actors, as one of them sees it; see `parley.umrf.remote.Peers`."""

    def __init__(self, sync: Sync, graph_name: str, actors: Iterable[str]) -> None:
        self.id = uuid.uuid4().hex
        self.graph_name = graph_name
        self.changing = asyncio.Lock()
        self._sync, self._actors = sync, frozenset(actors)
        self._peers = {actor: _Peer() for actor in self._actors}
        self._said: deque[tuple[float, SyncEntry]] = deque()
        """What was said, and when (wall time), until the time to confirm it is over."""
        self._first = 0
        """Number of the first of them."""
        self._ends: defaultdict[tuple[str, str], deque[SyncEntry]] = defaultdict(deque)
        self._came = asyncio.Event()
        self._asked = ""
        """Id of the change that the others are asked about."""
        self._answers: dict[str, str] = {}
        self._opened_s = sync.clock.wall_s()
        self._next: asyncio.TimerHandle | None = None
        self._closed = False

    @property
    def actors(self) -> frozenset[str]:
        """See `Peers.actors`."""
        return self._actors

    @property
    def others(self) -> frozenset[str]:
        """Everybody else who takes part: those named in the graph, and those who carry it out unnamed."""
        return frozenset(self._peers)

    @property
    def settled(self) -> bool:
        """Whether the others have confirmed all that was said."""
        return all(peer.confirmed == self._count for peer in self._peers.values())

    @property
    def _count(self) -> int:
        return self._first + len(self._said)

    async def handshake(self) -> list[str]:
        """Wait until every other actor has taken up the graph, too; those that did not in time."""
        self._say()
        await self._until(lambda: not self._silent())
        return self._silent()

    def _silent(self) -> list[str]:
        return sorted(name for name in self._actors if not self._peers[name].ready)

    async def ask(self, change: SyncEntry) -> dict[str, str]:
        """Ask all others whether a change could be made; who cannot, and why (empty: no answer came).

        One question at a time: hold `changing` meanwhile.

        Args:
            change: The command to make it.
        """
        self._asked, self._answers = uuid.uuid4().hex, {}
        self.tell(change.model_copy(update={"kind": "ask", "id": self._asked, "targets": ()}))
        await self._until(lambda: self.others <= self._answers.keys())
        refusals = {name: reason for name, reason in self._answers.items() if reason}
        return refusals | dict.fromkeys(self.others - self._answers.keys(), "")

    def ended(self, graph_name: str, node: Node, end: RemoteEnd) -> None:
        """See `Peers.ended`; said until everybody has confirmed it or the time is over."""
        self._add(
            SyncEntry(
                kind="ended",
                graph_name=graph_name,
                node=node.full_name,
                result=end.result.value,
                outputs=dict(end.outputs),
                message=end.message,
            )
        )

    def tell(self, entry: SyncEntry) -> None:
        """Say a command, a question or an answer to those who do not know it already."""
        if not self.others <= set(entry.targets):
            self._add(entry)

    async def end_of(self, graph_name: str, node: Node) -> RemoteEnd:
        """See `Peers.end_of`; ends of one node are given in the order in which they happened."""
        came, since_s = self._ends[graph_name, node.full_name], self._sync.clock.wall_s()
        while not came:
            if reason := self._sync.lost(node.actor, self.graph_name, since_s):
                raise ActionFailure(
                    FailureCode.UNAVAILABLE, f"{node.full_name} is for {node.actor}, which {reason}."
                )
            await self._until(lambda: bool(came), RETRY_S)
        end = came.popleft()
        return RemoteEnd(Result(end.result), end.outputs, end.message)

    def take(self, notice: SyncNotice) -> None:
        """Another actor says something; what is of another run than the one that is shared does not count.

        One that the graph does not name could not be waited for; it gets what has happened before.
        """
        peer = self._peers.get(notice.actor)
        if self._closed or (peer is None and self._is_old()):
            return
        peer = self._peers.setdefault(notice.actor, peer or _Peer())
        new = peer.run != notice.run
        if new and peer.ready:
            return
        if new:
            peer.run, peer.taken = notice.run, 0
        known, confirmed = notice.heard.get(self._sync.actor, ("", 0))
        before = peer.taken
        if known == self.id:
            peer.ready = True
            peer.confirmed = max(peer.confirmed, min(confirmed, self._count))
            for number, entry in enumerate(notice.said, notice.first):
                if number >= peer.taken:  # if some are left out, they were given up
                    peer.taken = number + 1
                    self._hear(notice.actor, entry)
        if notice.answer or new or peer.taken > before:
            self._say(answer=False)
        self._came.set()

    def close(self) -> None:
        """Say what has happened, and nothing again; nothing is taken any more."""
        self._closed = True
        if self._next is not None:
            self._next.cancel()
            self._next = None
            self._say()

    def _hear(self, actor: str, entry: SyncEntry) -> None:
        if entry.kind == "ended":
            self._ends[entry.graph_name, entry.node].append(entry)
        elif entry.kind != "answer":
            self._sync.hear(self, entry)
        elif entry.id == self._asked:
            self._answers[actor] = entry.message

    async def _until(self, condition: Callable[[], bool], limit_s: float | None = None) -> None:
        """Wait until something comes that makes it true, for so long at most."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(self._sync.timeout_s if limit_s is None else limit_s):
                while not condition():
                    self._came.clear()
                    await self._came.wait()

    def _is_old(self) -> bool:
        return self._sync.clock.wall_s() > self._opened_s + self._sync.timeout_s

    def _add(self, entry: SyncEntry) -> None:
        self._said.append((self._sync.clock.wall_s(), entry))
        if self._closed:
            self._say()
        else:  # of much in one turn of the loop one notice is made
            self._say_in(0.0)

    def _say_in(self, wait_s: float) -> None:
        due_s = asyncio.get_running_loop().time() + wait_s
        if self._next is None or self._next.when() > due_s:
            if self._next is not None:
                self._next.cancel()
            self._next = asyncio.get_running_loop().call_at(due_s, self._go_on)

    def _go_on(self) -> None:
        self._next = None
        self._give_up()
        if self._waits():
            self._say()

    def _waits(self) -> bool:
        return not self.settled or (bool(self._silent()) and not self._is_old())

    def _say(self, *, answer: bool = True) -> None:
        """Say what not all have confirmed; `answer`: whether they are to say how far they are."""
        first = min((peer.confirmed for peer in self._peers.values()), default=self._first)
        self._sync.publish(
            SyncNotice(
                actor=self._sync.actor,
                graph_name=self.graph_name,
                run=self.id,
                heard={name: (peer.run, peer.taken) for name, peer in self._peers.items() if peer.run},
                first=first,
                said=tuple(entry for _, entry in itertools.islice(self._said, first - self._first, None)),
                answer=answer,
            )
        )
        if self._waits() and not self._closed:
            self._say_in(RETRY_S)

    def _give_up(self) -> None:
        """Forget what is too old for anybody to need it, and say who has not confirmed it."""
        until_s = self._sync.clock.wall_s() - self._sync.timeout_s
        while self._said and self._said[0][0] <= until_s:
            _, entry = self._said.popleft()
            late = {name: peer for name, peer in self._peers.items() if peer.confirmed <= self._first}
            self._first += 1
            for peer in late.values():
                peer.confirmed = self._first
            if (names := sorted(late.keys() - set(entry.targets))) and entry.kind in ("ended", "command"):
                what = f"{', '.join(names)} did not confirm {_named(entry)}"
                self._sync.complain(
                    self.graph_name, Problem("", what, "see whether they still run", "peer_lost")
                )


def _named(entry: SyncEntry) -> str:
    if entry.kind == "ended":
        return f"that {entry.node} has ended"
    return f"the command to {entry.command} {entry.node or entry.graph_name}"


class Sync:
    """All sessions of one actor, and what is known of the others.

    Args:
        actor: Its name.
        clock: For the wall time.
        publish: Where notices go.
        complain: Told (with the graph's name) when others do not confirm.
        hear: Told commands and questions of others.
        timeout_s: Wall time to wait for others.
    """

    def __init__(
        self,
        actor: str,
        clock: Clock,
        publish: Callable[[SyncNotice], None],
        complain: Callable[[str, Problem], None],
        hear: Callable[[Session, SyncEntry], None],
        *,
        timeout_s: float = PEER_TIMEOUT_S,
    ) -> None:
        self.actor, self.clock, self.publish = actor, clock, publish
        self.complain, self.hear = complain, hear
        self.timeout_s = timeout_s
        self._sessions: Latest[str, Session] = Latest(_KEPT)
        self._statuses: dict[str, ActorStatus] = {}
        self._at_work_s: Latest[tuple[str, str], float] = Latest()

    def open(self, graph_name: str, actors: Iterable[str]) -> Session:
        """Begin a run of a graph with others; a session of an older run of it is closed."""
        if (old := self._sessions.get(graph_name)) is not None:
            old.close()
        session = self._sessions[graph_name] = Session(self, graph_name, actors)
        return session

    def take(self, notice: SyncNotice) -> None:
        """Something came from another engine."""
        session = self._sessions.get(notice.graph_name)
        if session is not None and notice.actor != self.actor:
            session.take(notice)

    def note(self, status: ActorStatus) -> None:
        """Another actor lives."""
        if status.actor == self.actor:
            return
        self._statuses[status.actor] = status
        for name, state in status.graphs.items():
            if state in BUSY and name in self._sessions:
                self._at_work_s[status.actor, name] = self.clock.wall_s()

    def stopped(self, actors: Iterable[str]) -> list[str]:
        """Those of `actors` in which an emergency stop is in force."""
        return sorted(
            name for name in actors if name in self._statuses and self._statuses[name].state == "stopped"
        )

    def absence(self, actor: str, did_not: str = "did not take up the graph") -> str:
        """Why `actor` may not have answered, in words; `did_not`: what it left undone."""
        status = self._statuses.get(actor)
        if status is None or status.state == "leaving":
            return f"{actor} is not there"
        if status.state == "stopped":
            return stopped_by_stop(actor)
        return f"{actor} is there, but {did_not}"

    def lost(self, actor: str, graph_name: str, since_s: float) -> str:
        """Why nothing can be expected of `actor` any more, in words; empty if that is not known.

        Args:
            actor: Who is waited for.
            graph_name: The graph it should be at work on.
            since_s: Wall time since when it is waited for.
        """
        status = self._statuses.get(actor)
        if status is not None and status.state == "leaving":
            return "has left"
        silence_s = self.clock.wall_s() - max(since_s, self._at_work_s.get((actor, graph_name), 0.0))
        if silence_s <= self.timeout_s:
            return ""
        return f"has not been heard of at work on {graph_name} for {self.timeout_s:g} s"

    def close(self) -> None:
        """Say nothing more."""
        for session in self._sessions.values():
            session.close()
