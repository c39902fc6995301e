"""What the engines of several actors tell each other about the graphs they carry out together (13).

Every engine runs the whole graph; a node of another actor only waits there until that actor's engine says how
it ended. Plain objects: notices come in by `Sync.take`, go out by a function, and time is wall time.
"""

from __future__ import annotations

import asyncio
import uuid
from collections import Counter, deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Final

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode, Problem
from parley.latest import Latest
from parley.messages.status import ActorStatus, SyncNotice
from parley.umrf.model import GraphState, Node, Result
from parley.umrf.remote import RemoteEnd

__all__ = ["PEER_TIMEOUT_S", "Session", "Sync"]

PEER_TIMEOUT_S: Final = 5.0
"""How long an engine waits for the others: to answer a start, to confirm an end, to be heard of."""

RETRY_S: Final = 0.2
_KEPT: Final = 50
"""Sessions that are kept, so that late notices still find theirs."""

_REPLAYED: Final = 1000
"""So many ends are kept for an actor that takes part without being named in the graph."""

_AT_WORK: Final = frozenset(
    state.value
    for state in (GraphState.INITIALIZED, GraphState.RUNNING, GraphState.PAUSED, GraphState.STOPPING)
)


@dataclass(slots=True)
class _Ends:
    """Ends of one node that came from its actor, in whichever order."""

    came: dict[int, SyncNotice] = field(default_factory=dict)
    """How often the node had ended before -> what came."""
    following: int = 0
    gap_since_s: float | None = None
    """Wall time since when only later ends than `following` are there."""

    def take(self, now_s: float, patience_s: float) -> SyncNotice | None:
        """The one that follows the last; if that does not come for so long, the first of the others."""
        if self.following not in self.came:
            if not self.came:
                return None
            self.gap_since_s = now_s if self.gap_since_s is None else self.gap_since_s
            if now_s < self.gap_since_s + patience_s:
                return None
            self.following = min(self.came)
        self.gap_since_s = None
        self.following += 1
        return self.came.pop(self.following - 1)


@dataclass(slots=True)
class _Unconfirmed:
    notice: SyncNotice
    missing: set[str]
    until_s: float


class Session:
    """One run of one graph by several actors, as one of them sees it; see `parley.umrf.remote.Peers`."""

    def __init__(self, sync: Sync, graph_name: str, actors: Iterable[str]) -> None:
        self.id = uuid.uuid4().hex
        self.graph_name = graph_name
        self.known: dict[str, str] = {}
        """Actor -> its own id of this run."""
        self._sync, self._actors = sync, frozenset(actors)
        self._silent = set(self._actors)
        self._answered = asyncio.Event()
        self._inboxes: dict[tuple[str, str], _Ends] = {}
        self._ended: Counter[tuple[str, str]] = Counter()
        self._commands = 0
        self._newest: dict[str, int] = {}
        """Actor -> number of the newest command of its that says whether to go on."""
        self._arrived = asyncio.Event()
        self._taken: set[str] = set()
        self._sent: deque[SyncNotice] = deque(maxlen=_REPLAYED)
        self.changing = asyncio.Lock()
        self._asked = ""
        """Id of the change that the others are asked about."""
        self._answers: dict[str, str] = {}
        self._answer_came = asyncio.Event()
        self._count = 0
        self._opened_s = sync.clock.wall_s()
        self._unconfirmed: dict[str, _Unconfirmed] = {}
        self._retry: asyncio.TimerHandle | None = None

    @property
    def actors(self) -> frozenset[str]:
        """See `Peers.actors`."""
        return self._actors

    @property
    def others(self) -> frozenset[str]:
        """Everybody else who takes part: those named in the graph, and those who carry it out unnamed."""
        return self._actors | self.known.keys()

    # -- start ----------------------------------------------------------------------------------------------

    async def handshake(self) -> list[str]:
        """Wait until every other actor has taken up the graph, too; those that did not in time."""
        clock = self._sync.clock
        until_s = clock.wall_s() + self._sync.timeout_s
        while self._silent and clock.wall_s() < until_s:
            self._say(
                SyncNotice(kind="hello", actor=self._sync.actor, graph_name=self.graph_name, id=self.id)
            )
            try:
                async with asyncio.timeout(min(RETRY_S, self._sync.timeout_s)):
                    await self._answered.wait()
            except TimeoutError:
                continue
        return sorted(self._silent)

    def greeted(self, notice: SyncNotice) -> None:
        """Another actor has taken up the graph: answer, unless we are already in a run with its last one.

        One that the graph does not name could not be waited for; it gets what has happened before.
        """
        new = notice.actor not in self.others
        if new and self._sync.clock.wall_s() > self._opened_s + self._sync.timeout_s:
            return
        if self.known.setdefault(notice.actor, notice.id) != notice.id:
            if not self._silent:
                return
            self.known[notice.actor] = notice.id
        self._say(
            SyncNotice(
                kind="ready",
                actor=self._sync.actor,
                graph_name=self.graph_name,
                id=self.id,
                answers=notice.id,
            )
        )
        for sent in self._sent if new else ():
            self._hand_over(sent, {notice.actor})

    def answered(self, notice: SyncNotice) -> None:
        """Another actor has heard that we have taken up the graph."""
        if notice.answers == self.id and notice.actor in self._silent:
            self.known[notice.actor] = notice.id
            self._silent.discard(notice.actor)
            if not self._silent:
                self._answered.set()

    # -- changes --------------------------------------------------------------------------------------------

    async def ask(self, graph_json: str, continue_from: str) -> dict[str, str]:
        """Ask all others whether the graph could be changed so; who cannot, and why (empty: no answer came).

        One question at a time: hold `changing` meanwhile.

        Args:
            graph_json: The new form.
            continue_from: Where it is to go on.
        """
        clock, self._asked, self._answers = self._sync.clock, uuid.uuid4().hex, {}
        until_s = clock.wall_s() + self._sync.timeout_s
        while missing := self.others - self._answers.keys():
            if clock.wall_s() >= until_s:
                return self._answers_with_no() | dict.fromkeys(missing, "")
            self._say(
                SyncNotice(
                    kind="ask",
                    actor=self._sync.actor,
                    graph_name=self.graph_name,
                    id=self._asked,
                    command="modify",
                    graph_json=graph_json,
                    continue_from=continue_from,
                )
            )
            self._answer_came.clear()
            try:
                async with asyncio.timeout(min(RETRY_S, self._sync.timeout_s)):
                    while self.others - self._answers.keys():
                        await self._answer_came.wait()
                        self._answer_came.clear()
            except TimeoutError:
                continue
        return self._answers_with_no()

    def _answers_with_no(self) -> dict[str, str]:
        return {name: reason for name, reason in self._answers.items() if reason}

    def take_answer(self, notice: SyncNotice) -> None:
        """Another actor says whether the graph could be changed."""
        if notice.answers == self._asked:
            refused = notice.result != "yes"
            self._answers[notice.actor] = (notice.message or "refused") if refused else ""
            self._answer_came.set()

    # -- ends of nodes --------------------------------------------------------------------------------------

    def ended(self, graph_name: str, node: Node, end: RemoteEnd) -> None:
        """See `Peers.ended`; repeated until everybody has confirmed it or the time is over."""
        notice = SyncNotice(
            kind="ended",
            actor=self._sync.actor,
            graph_name=graph_name,
            id=self._next_id(),
            number=self._ended[graph_name, node.full_name],
            node=node.full_name,
            result=end.result.value,
            outputs=dict(end.outputs),
            message=end.message,
        )
        self._ended[graph_name, node.full_name] += 1
        self._sent.append(notice)
        if self.others:
            self._hand_over(notice, set(self.others))

    def _next_id(self) -> str:
        self._count += 1
        return f"{self.id}/{self._count}"

    def pass_on(self, notice: SyncNotice) -> None:
        """Tell the others what was done here, until those who carry out the graph too have confirmed it."""
        numbered = notice.model_copy(update={"id": self._next_id(), "number": self._commands})
        self._commands += 1
        if others := self.known.keys() - set(notice.targets):
            self._hand_over(numbered, others)
        else:
            self._say(numbered)

    def takes(self, notice: SyncNotice) -> bool:
        """Confirm a command of another actor; whether it is to be carried out.

        It is not if it came before, is of another run, or (unless it changes or ends something) if a later
        one of that actor came already.
        """
        run = notice.id.partition("/")[0]
        if not run:  # from who does not wait for an answer
            return True
        if self.known.get(notice.actor, run) != run:
            return False
        self._confirm(notice)
        if notice.id in self._taken:
            return False
        self._taken.add(notice.id)
        if notice.command in ("modify", "end"):
            return True
        late = notice.number < self._newest.get(notice.actor, 0)
        if not late:
            self._newest[notice.actor] = notice.number
        return not late or notice.command == "stop"

    def _confirm(self, notice: SyncNotice) -> None:
        self._say(
            SyncNotice(
                kind="received",
                actor=self._sync.actor,
                graph_name=notice.graph_name,
                answers=notice.id,
            )
        )

    def _hand_over(self, notice: SyncNotice, to: set[str]) -> None:
        until_s = self._sync.clock.wall_s() + self._sync.timeout_s
        waiting = self._unconfirmed.setdefault(notice.id, _Unconfirmed(notice, set(), until_s))
        waiting.missing |= to
        self._say(notice)
        if self._retry is None:
            self._retry = asyncio.get_running_loop().call_later(RETRY_S, self._say_again)

    def confirmed(self, notice: SyncNotice) -> None:
        """Another actor has got the end of one of our nodes."""
        waiting = self._unconfirmed.get(notice.answers)
        if waiting is not None:
            waiting.missing.discard(notice.actor)
            if not waiting.missing:
                del self._unconfirmed[notice.answers]

    def take_end(self, notice: SyncNotice) -> None:
        """A node of another actor has ended: confirm it, and keep it for who waits or will wait for it."""
        self._confirm(notice)
        inbox = self._inbox(notice.graph_name, notice.node)
        if notice.number >= inbox.following:
            inbox.came[notice.number] = notice
            self._arrived.set()

    async def end_of(self, graph_name: str, node: Node) -> RemoteEnd:
        """See `Peers.end_of`; ends of one node are given in the order in which they happened."""
        clock, patience_s = self._sync.clock, self._sync.timeout_s
        inbox, since_s = self._inbox(graph_name, node.full_name), clock.wall_s()
        while (notice := inbox.take(clock.wall_s(), patience_s)) is None:
            if reason := self._sync.lost(node.actor, self.graph_name, since_s):
                raise ActionFailure(
                    FailureCode.UNAVAILABLE, f"{node.full_name} is for {node.actor}, which {reason}."
                )
            self._arrived.clear()
            try:
                async with asyncio.timeout(min(RETRY_S, self._sync.timeout_s)):
                    await self._arrived.wait()
            except TimeoutError:
                continue
        return RemoteEnd(Result(notice.result), notice.outputs, notice.message)

    def close(self) -> None:
        """Say nothing more."""
        self._unconfirmed.clear()
        if self._retry is not None:
            self._retry.cancel()

    def _inbox(self, graph_name: str, node: str) -> _Ends:
        return self._inboxes.setdefault((graph_name, node), _Ends())

    def _say_again(self) -> None:
        self._retry = None
        now_s = self._sync.clock.wall_s()
        for waiting in list(self._unconfirmed.values()):
            if now_s < waiting.until_s:
                self._say(waiting.notice)
                continue
            del self._unconfirmed[waiting.notice.id]
            names = ", ".join(sorted(waiting.missing))
            self._sync.complain(
                self.graph_name,
                Problem(
                    "",
                    f"{names} did not confirm {_said(waiting.notice)}",
                    "see whether they still run",
                    "peer_lost",
                ),
            )
        if self._unconfirmed:
            self._retry = asyncio.get_running_loop().call_later(RETRY_S, self._say_again)

    def _say(self, notice: SyncNotice) -> None:
        self._sync.publish(notice)


def _said(notice: SyncNotice) -> str:
    if notice.kind == "ended":
        return f"that {notice.node} has ended"
    return f"the command to {notice.command} {notice.node or notice.graph_name}"


class Sync:
    """All sessions of one actor, and what is known of the others.

    Args:
        actor: Its name.
        clock: For the wall time.
        publish: Where notices go.
        complain: Told (with the graph's name) when others do not confirm.
        timeout_s: Wall time to wait for others.
    """

    def __init__(
        self,
        actor: str,
        clock: Clock,
        publish: Callable[[SyncNotice], None],
        complain: Callable[[str, Problem], None],
        *,
        timeout_s: float = PEER_TIMEOUT_S,
    ) -> None:
        self.actor, self.clock, self.publish, self.complain = actor, clock, publish, complain
        self.timeout_s = timeout_s
        self._sessions: dict[str, Session] = {}
        self._statuses: dict[str, ActorStatus] = {}
        self._at_work_s: Latest[tuple[str, str], float] = Latest()

    def open(self, graph_name: str, actors: Iterable[str]) -> Session:
        """Begin a run of a graph with others; a session of an older run of it is closed."""
        old = self._sessions.pop(graph_name, None)
        if old is not None:
            old.close()
        session = self._sessions[graph_name] = Session(self, graph_name, actors)
        while len(self._sessions) > _KEPT:
            self._sessions.pop(next(iter(self._sessions))).close()
        return session

    def drop(self, session: Session) -> None:
        """Forget a run that does not begin."""
        session.close()
        if self._sessions.get(session.graph_name) is session:
            del self._sessions[session.graph_name]

    def take(self, notice: SyncNotice) -> None:
        """Something came from another engine (commands apart)."""
        if notice.actor == self.actor:
            return
        session = self._sessions.get(notice.graph_name)
        match notice.kind:
            case "hello" if session is not None:
                session.greeted(notice)
            case "ready" if session is not None:
                session.answered(notice)
            case "answer" if session is not None:
                session.take_answer(notice)
            case "ended":
                run_id = notice.id.partition("/")[0]
                for item in self._sessions.values():  # a sub-graph's name is not that of its session
                    if item.known.get(notice.actor) == run_id:
                        item.take_end(notice)
            case "received":
                for item in self._sessions.values():
                    item.confirmed(notice)

    def note(self, status: ActorStatus) -> None:
        """Another actor lives."""
        if status.actor == self.actor:
            return
        self._statuses[status.actor] = status
        for name, state in status.graphs.items():
            if state in _AT_WORK and name in self._sessions:
                self._at_work_s[status.actor, name] = self.clock.wall_s()

    def stopped(self, actors: Iterable[str]) -> list[str]:
        """Those of `actors` in which an emergency stop is in force."""
        return sorted(
            name for name in actors if name in self._statuses and self._statuses[name].state == "stopped"
        )

    def absence(self, actor: str) -> str:
        """Why `actor` may not have answered, in words."""
        status = self._statuses.get(actor)
        if status is None or status.state == "leaving":
            return f"{actor} is not there"
        if status.state == "stopped":
            return f"{actor} was stopped by the emergency stop"
        return f"{actor} is there, but did not take up the graph"

    def silence(self, actor: str) -> str:
        """Why `actor` may not have answered a question, in words."""
        status = self._statuses.get(actor)
        gone = status is None or status.state == "leaving"
        return f"{actor} is not there" if gone else f"{actor} is there, but did not answer"

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
