"""Graphs of several actors on one engine: starting them together, and commands that reach all (13)."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Collection, Coroutine, Mapping, Sequence
from typing import Any, Literal

from parley.clock import Clock
from parley.engine.runs import GraphRuns, stop_latched
from parley.engine.sync import PEER_TIMEOUT_S, Session, Sync
from parley.errors import GraphRefusedError, Problem
from parley.messages.status import ActorStatus, SyncEntry, SyncNotice
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import NOTHING, Graph, GraphState, Result

__all__ = ["Command", "Together"]

Command = Literal["stop", "pause", "resume", "modify", "end"]


class Together:
    """Starts graphs, with others where they name others, and keeps all of them in step.

    Args:
        actor: This actor.
        names: Its name and wake words.
        runs: Its graphs.
        clock: For the wall time.
        publish: Where notices to other engines go.
        refuse: Told what was refused after the command had been accepted: what, which graph, why.
        watch: Called before the first graph with others: from then on `note` must be told who lives.
        timeout_s: Wall time to wait for others.
    """

    def __init__(
        self,
        actor: str,
        names: Collection[str],
        runs: GraphRuns,
        clock: Clock,
        *,
        publish: Callable[[SyncNotice], None],
        refuse: Callable[[str, str, Sequence[Problem]], None],
        watch: Callable[[], Awaitable[None]],
        timeout_s: float = PEER_TIMEOUT_S,
    ) -> None:
        self._actor, self._names, self._runs = actor, frozenset(names), runs
        self._refuse, self._watch = refuse, watch
        self._sync = Sync(
            actor,
            clock,
            publish,
            complain=lambda name, problem: refuse("sync", name, [problem]),
            hear=self._hear,
            timeout_s=timeout_s,
        )
        self._watching = False
        self._tasks: set[asyncio.Task[None]] = set()

    # -- starting -------------------------------------------------------------------------------------------

    def start(
        self,
        graph: Graph | str,
        parameters: Mapping[str, Any] = NOTHING,
        result: Result = Result.ON_TRUE,
    ) -> GraphRun:
        """See `GraphRuns.start`; a graph that names other actors begins when all of them have taken it up.

        Raises:
            GraphRefusedError: See there. That others do not answer is told later.
        """
        found = self._runs.indexed(graph) if isinstance(graph, str) else graph
        named = self._runs.catalogue.actors(found)
        if not named:
            return self._runs.start(graph, parameters, result)
        self._runs.refuse_if_busy(found.name)  # before the session of a run that goes on is closed
        session = self._sync.open(found.name, named - {self._actor})
        try:
            run = self._runs.prepare(graph, parameters, session)
        except GraphRefusedError:
            session.close()
            raise
        if session.actors:
            self._spawn(self._begin(run, session, result))
        else:
            self._runs.begin(run, result)
        return run

    async def _begin(self, run: GraphRun, session: Session, result: Result) -> None:
        if not self._watching:
            self._watching = True
            await self._watch()
        remedy = f"send {run.name} to {{}}, too, and see that it runs"
        problems = [
            Problem("actor", self._sync.absence(name), remedy.format(name), "peer_silent")
            for name in await session.handshake()
        ]
        try:
            if problems:
                raise GraphRefusedError(run.name, problems)
            self._runs.begin(run, result)
        except GraphRefusedError as error:
            self._runs.drop(run)
            session.close()
            run.stop()  # so that whoever waits for it hears that it is over
            self._refuse("umrf_graph_start", run.name, error.problems)

    # -- commands -------------------------------------------------------------------------------------------

    def command(self, command: Command, name: str, targets: Sequence[str] = (), node: str = "") -> None:
        """Carry out a command here, and by the other actors of the graph.

        Args:
            command: What is to be done.
            name: The graph.
            targets: Who was told so directly.
            node: Which one is to end, by full name.

        Raises:
            GraphRefusedError: See the method of `GraphRuns`; also if anything is to go on while an emergency
                stop is in force at any actor of the graph.
        """
        if command == "resume":
            self._refuse_if_stopped(name)
        entry = SyncEntry(kind="command", graph_name=name, command=command, targets=tuple(targets), node=node)
        self._obey(entry)
        self._pass_on(entry)

    def modify(self, graph: Graph, text: str, continue_from: str, targets: Sequence[str]) -> None:
        """See `GraphRuns.modify`; of a graph of several actors only if all of them can do it.

        They are asked first, and nobody changes anything before all have said yes. What an actor does between
        its yes and the change may still make it impossible there; that actor then says so itself.

        Args:
            graph: The new form.
            text: The same as JSON, for the others.
            continue_from: See there.
            targets: Who was told so directly.

        Raises:
            GraphRefusedError: See there and `command`. That others cannot do it, or do not answer, is told
                later.
        """
        if continue_from:
            self._refuse_if_stopped(graph.name)
        session = self._session(graph.name)
        if session is None or not session.others:
            self._runs.modify(graph, continue_from)
            return
        self._runs.check_modify(graph, continue_from)
        change = SyncEntry(
            kind="command",
            graph_name=graph.name,
            command="modify",
            targets=tuple(targets),
            graph_json=text,
            continue_from=continue_from,
        )
        self._spawn(self._modify_all(session, graph, change))

    async def _modify_all(self, session: Session, graph: Graph, change: SyncEntry) -> None:
        async with session.changing:
            refusals = [
                f"{name}: {reason}" if reason else self._sync.absence(name, "did not answer")
                for name, reason in (await session.ask(change)).items()
            ]
            try:
                if refusals:
                    problems = [Problem("", text, "", "peer_refused") for text in refusals]
                    raise GraphRefusedError(graph.name, problems)
                self._runs.modify(graph, change.continue_from)
            except GraphRefusedError as error:
                self._refuse("umrf_graph_modify", graph.name, error.problems)
                return
            self._pass_on(change)

    def hold(self) -> None:
        """An emergency stop has paused what goes on here: nor may the others go on with it."""
        for run in self._runs.all:
            if run.state in (GraphState.RUNNING, GraphState.PAUSED):
                self._pass_on(SyncEntry(kind="command", graph_name=run.name, command="pause"))

    def _session(self, name: str) -> Session | None:
        run = self._runs.get(name)
        return run.peers if run is not None and isinstance(run.peers, Session) else None

    def _pass_on(self, entry: SyncEntry) -> None:
        if session := self._session(entry.graph_name):
            session.tell(entry)

    def _refuse_if_stopped(self, name: str) -> None:
        session = self._session(name)
        if stopped := self._sync.stopped(session.others if session else ()):
            raise stop_latched(name, ", ".join(stopped))

    def take(self, notice: SyncNotice) -> None:
        """Something came from another engine."""
        self._sync.take(notice)

    def _hear(self, session: Session, entry: SyncEntry) -> None:
        """Another engine passes on a command, or asks whether a change could be made here."""
        name, refused = entry.graph_name, ""
        if self._session(name) is not session or not self._names.isdisjoint(entry.targets):
            return
        try:
            if entry.kind == "ask":
                self._runs.check_modify(read_graph(entry.graph_json), entry.continue_from)
            else:
                self._obey(entry)
        except GraphRefusedError as error:
            refused = "; ".join(map(str, error.problems)) or "refused"
            if entry.kind == "command":
                self._refuse(f"sync {entry.command}", name, error.problems)
        if entry.kind == "ask":
            session.tell(SyncEntry(kind="answer", graph_name=name, id=entry.id, message=refused))

    def note(self, status: ActorStatus) -> None:
        """Another actor lives."""
        self._sync.note(status)

    async def close(self) -> None:
        """End what still waits for others."""
        tasks = list(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        self._sync.close()

    def _obey(self, entry: SyncEntry) -> None:
        name = entry.graph_name
        match entry.command:
            case "stop":
                self._runs.stop(name)
            case "pause":
                self._runs.pause(name)
            case "resume":
                self._runs.resume(name)
            case "modify":
                self._runs.modify(read_graph(entry.graph_json), entry.continue_from)
            case "end":
                self._runs.end_node(name, entry.node)

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work, name=f"start together {self._actor}")
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
