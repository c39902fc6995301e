"""What ran, written down as it happens, so that the next process can go on with it.

One SQLite file holds each run of each graph: the graph as it was started and as it is now, and what
`parley.umrf.saved` keeps of its state. Recording only notes that a run has changed; it is written in batches
in the file's own thread (`journal_file`), the first at once and then one each `BATCH_S`. A batch is one
transaction and holds all graphs as they were at one moment.
"""

from __future__ import annotations

import asyncio
import functools
import weakref
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Final, Self

import structlog

from parley.clock import Clock
from parley.engine.interrupted import Interrupted
from parley.engine.journal_file import (
    KEPT_RUNS,
    VERSION,
    Batch,
    GraphText,
    prepare,
    read_left,
    write,
)
from parley.engine.journal_older import put_aside_other_form
from parley.errors import InvalidMessageError, StoreError
from parley.memory.database import Database
from parley.messages import topics
from parley.messages.ros import String
from parley.messages.status import PlanUpdate
from parley.messages.wire import decode_plan
from parley.sentences import sentence
from parley.transport.base import Subscription, Transport
from parley.umrf.executor import GraphRun
from parley.umrf.transition import Transition

__all__ = ["BATCH_S", "Interrupted", "Journal"]

log = structlog.get_logger(__name__)

BATCH_S: Final = 0.05
"""Wall time between two batches: how much a crash loses, besides what it takes to write one."""

NOT_WRITTEN: Final = sentence(
    "What robots are doing cannot be written down now. They go on and can be stopped, but after a crash I "
    "would not know of it."
)
WRITTEN_AGAIN: Final = sentence("What robots are doing is written down again.")


class Journal:
    """See `open`. Recording never raises: a full disk is told, and no reason for a robot to stop."""

    def __init__(
        self,
        database: Database,
        clock: Clock,
        interrupted: Sequence[Interrupted],
        last: int,
        tell: Callable[[str], None],
    ) -> None:
        self.interrupted = tuple(interrupted)
        """What was under way when an earlier process ended, oldest first."""
        self._database, self._clock, self._tell = database, clock, tell
        self._first = self._next = last + 1
        self._ids: weakref.WeakKeyDictionary[GraphRun, int] = weakref.WeakKeyDictionary()
        self._batch = Batch()
        self._text: GraphText | None = None
        self._changed: dict[GraphRun, tuple[int, int]] = {}
        """Runs that are to be written -> number, and time of the newest change."""
        self._unsaved: weakref.WeakSet[GraphRun] = weakref.WeakSet()
        """Runs of a batch that could not be written."""
        self._writer: asyncio.Task[None] | None = None
        self._hurry = asyncio.Event()
        self._broken = self._ending = False

    @classmethod
    async def open(
        cls, path: Path | str, clock: Clock, *, tell: Callable[[str], None] = lambda _: None
    ) -> Self:
        """Open or create the journal; use as ``async with await Journal.open(...)``.

        Args:
            path: The file, or ``:memory:``.
            clock: For time stamps.
            tell: Gets a sentence for people when it cannot be written, and when it can again.

        Raises:
            StoreError: The file cannot be created, read or written.
        """
        await asyncio.to_thread(put_aside_other_form, Path(path), VERSION)
        database = await Database.open(path, prepare=prepare, unix_ms=clock.unix_ms(), what="journal")
        try:
            interrupted, last = await database.run(read_left)
        except BaseException:
            await database.close()
            raise
        return cls(database, clock, interrupted, last, tell)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    def record(self, run: GraphRun, transition: Transition) -> None:
        """Note a transition of `run`; called on the loop, costs microseconds."""
        if transition.kind == "progress" or self._ending:
            return
        number = self._ids.get(run)
        if number is None:
            number = self._ids[run] = self._next
            self._next += 1
            shared = run.peers is not None and bool(run.peers.actors)
            known = self._text is not None and self._text.name == run.name
            graph = self._text if known and self._text is not None else run.snapshot()
            self._batch.begun.append((number, run.actor, run.outer, shared, graph, transition.unix_ms))
        elif transition.kind == "graph" and transition.cause == "modify":
            self._batch.modified.append((number, run.snapshot()))
        self._changed[run] = (number, transition.unix_ms)
        self._begin_writing()

    def _begin_writing(self) -> None:
        if self._writer is None:
            self._writer = asyncio.get_running_loop().create_task(self._write(), name="journal")

    @contextmanager
    def read_from(self, name: str, text: str) -> Iterator[None]:
        """If the graph of that name begins in here, it is the one that was read from `text`.

        That text is then what is kept, as writing a large graph takes longer than all that happens in it.
        """
        self._text = GraphText(name, text)
        try:
            yield
        finally:
            self._text = None

    async def flush(self) -> None:
        """Wait until everything recorded so far is durable."""
        while self._writer is not None:
            self._hurry.set()
            await asyncio.wait([self._writer])

    async def heed_plans(self, transport: Transport) -> Subscription:
        """Offer no more what an earlier process left of a robot once its plan is given up.

        To be called before the first robot is there: a plan that nobody heard of is not given up.
        """
        left = {was.actor for was in self.interrupted}
        held: set[str] = set()

        def hear(message: String) -> None:
            try:
                told = decode_plan(message.data)
            except InvalidMessageError:
                return  # whoever shows plans says so
            if not isinstance(told, PlanUpdate) or told.target not in left:
                return
            if told.state != "idle":
                held.add(told.target)
            elif told.target in held:  # before, whoever plans has not heard yet what was left
                left.discard(told.target)
                self._batch.given_up.append(told.target)
                self._begin_writing()

        return await transport.subscribe(topics.PLAN, hear)

    async def end(self) -> None:
        """The process ends: what is stopped by that is gone on with by the next one. Idempotent."""
        self._ending = True
        await self.flush()

    async def close(self) -> None:
        """Write what is left, and close the file. Idempotent."""
        await self.flush()
        await self._database.close()

    def _take(self) -> Batch:
        """Everything since the last batch, with the graphs as they are now."""
        batch, self._batch = self._batch, Batch()
        changed, self._changed = self._changed, {}
        for run, (number, unix_ms) in changed.items():
            batch.saved.append((number, unix_ms, *run.save(everything=run in self._unsaved)))
            self._unsaved.discard(run)
        return batch

    def _put_back(self, batch: Batch, changed: Iterable[GraphRun]) -> None:
        """A batch could not be written: what is in it is written with the next change."""
        self._batch.begun[:0] = batch.begun[-KEPT_RUNS:]
        self._batch.modified[:0] = batch.modified[-KEPT_RUNS:]
        self._batch.given_up[:0] = batch.given_up
        self._unsaved.update(changed)

    async def _write(self) -> None:
        try:
            while self._changed or (self._batch.given_up and not self._broken):
                changed = list(self._changed)
                batch = self._take()
                try:
                    await self._database.run(functools.partial(write, batch=batch, first=self._first))
                    if self._broken:
                        self._tell(WRITTEN_AGAIN)
                    self._broken = False
                except StoreError as error:
                    if not self._broken:
                        log.error("journal cannot be written", reason=str(error))
                        self._tell(NOT_WRITTEN)
                    self._broken = True
                    self._put_back(batch, changed)
                await self._rest()
        finally:
            self._writer = None
            self._hurry.clear()

    async def _rest(self) -> None:
        try:
            async with asyncio.timeout(BATCH_S):
                await self._hurry.wait()
        except TimeoutError:
            return
