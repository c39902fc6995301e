"""Actions in a process of their own, for code that may crash: drivers in C, models, experiments.

``@action(isolated=True)`` is all it takes. A segmentation fault or ``os._exit`` ends
that process, and the node fails as `internal`; the engine and its other robots go on.

What such an action gets is less than what others get, because little can cross to another process:

- its inputs, and what it returns, as plain values (dataclasses of them included);
- as the context what `parley.umrf.action.RunHandle` offers: names, `log`, `progress`, `stop_requested`, and
  a clock of wall time. There is no robot, world, memory, display, operator or language;
- a pause lets it finish and holds its children;
- a stop sets `stop_requested` and cancels an `async` one; what has not ended `STOP_GRACE_S` later is killed;
- a class action is made anew for each run, so it remembers nothing.

Its module is imported again in that process, so it must be found there: by its name, or as a file of a folder
of actions. The first one starts a process that has Parley loaded and waits (with the environment variables of
that moment); each run is a fresh copy of that, begun within a tenth of a second or two besides the import.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import importlib
import inspect
import multiprocessing
import os
import pickle
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final

from parley.clock import Clock, WallClock
from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import Action, ActionSpec, Outcome, RunHandle, bind_inputs, outcome_of
from parley.umrf.modules import PRIVATE, import_file
from parley.umrf.motion import Motion
from parley.umrf.reports import harmless, raised_text, text_of
from parley.umrf.signature import flatten_value
from parley.umrf.threads import in_thread

__all__ = ["STOP_GRACE_S", "IsolatedContext", "isolated"]

STOP_GRACE_S: Final = 2.0
"""Wall time between asking such an action to stop and killing it; less than an engine gives a node."""

_END_S: Final = 1.0
"""A process that has said its last word, or was killed, is gone by then."""


@functools.cache
def _processes() -> Any:
    """Where processes come from: copies of a warm one where the system can do that (not on Windows)."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["parley.__main__", __name__])  # not the script, which may begin something
    return context


@dataclass(frozen=True, slots=True)
class _Order:
    """What the other process has to do."""

    module: str
    file: str
    """Where the module is, if it cannot be found by its name."""
    attribute: str
    values: Mapping[str, Any]
    actor: str
    graph_name: str
    node: str
    result_asked: bool


def isolated(spec: ActionSpec) -> Callable[..., Any]:
    """What runs `spec` in a process of its own, each time it is called; takes what `spec.run` takes."""

    async def run(context: Any, **arguments: Any) -> Outcome:
        handle: RunHandle = getattr(context, "run", context)
        worker = _Worker(_order(spec, handle, arguments), spec.name, handle)
        task = asyncio.create_task(in_thread(f"isolated {handle.node}", worker.converse), name=handle.node)
        task.add_done_callback(
            lambda done: done.cancelled() or done.exception()
        )  # seen, also if nobody waits
        try:
            return await asyncio.shield(task)
        except asyncio.CancelledError:
            try:
                worker.ask_to_stop()
                await asyncio.wait([task], timeout=STOP_GRACE_S)
            finally:
                worker.kill()
            await asyncio.wait([task], timeout=_END_S)
            raise

    return run


def _order(spec: ActionSpec, handle: RunHandle, arguments: Mapping[str, Any]) -> _Order:
    target: Any = spec.make or spec.run
    module = sys.modules[target.__module__]
    file = str(module.__file__) if module.__name__.startswith(PRIVATE) else ""
    values: dict[str, Any] = {}
    for name, value in arguments.items():
        values |= flatten_value(value, name)
    return _Order(
        module=module.__name__,
        file=file,
        attribute=_attribute(module, spec),
        values=values,
        actor=handle.actor,
        graph_name=handle.graph_name,
        node=handle.node,
        result_asked=handle.result_asked,
    )


def _attribute(module: Any, spec: ActionSpec) -> str:
    """Under which name the module holds the action (a class action may have another than its class)."""
    for name, value in vars(module).items():
        if isinstance(value, Action) and value.spec.name == spec.name:
            return str(name)
    raise ActionFailure(
        FailureCode.INTERNAL, f"{spec.name} is not at the top of its module, so it cannot be isolated."
    )


class _Worker:
    """This side of one other process."""

    def __init__(self, order: _Order, name: str, handle: RunHandle) -> None:
        self._order, self._name, self._handle = order, name, handle
        self._ours, self._theirs = _processes().Pipe()
        self._process: Any = None
        self._killed = False

    def converse(self) -> Outcome:
        """Start it, hand on what it tells, and return what it returned; in a thread."""
        try:
            if not self._start():
                raise ActionFailure(FailureCode.INTERNAL, f"{self._name} was stopped before it began.")
            return self._listen()
        finally:
            self._ours.close()
            self._reap()

    def _start(self) -> bool:
        if self._killed:
            self._theirs.close()
            return False
        process = _processes().Process(
            target=_work, args=(self._theirs, self._order), name=self._order.node, daemon=True
        )
        try:
            with _ctrl_c_held():
                process.start()  # the first one may take seconds, and nobody may wait for that to kill it
        finally:
            self._theirs.close()  # so that the end of the process is the end of what it tells
        self._process = process
        if self._killed:
            process.kill()
        return True

    def _listen(self) -> Outcome:
        while True:
            try:
                kind, *what = self._ours.recv()
            except (EOFError, OSError):
                raise ActionFailure(FailureCode.INTERNAL, self._crash_text()) from None
            match kind:
                case "log":
                    self._handle.log(what[0])
                case "progress":
                    self._handle.progress(what[0], what[1])
                case "returned":
                    return Outcome(*what)
                case "failed":
                    code, message, details = what
                    raise ActionFailure(FailureCode(code), message, details)

    def ask_to_stop(self) -> None:
        """Ask the action to end."""
        with contextlib.suppress(OSError, ValueError):  # it has ended already
            self._ours.send("stop")

    def kill(self) -> None:
        """End the process whatever it does. Idempotent."""
        self._killed, process = True, self._process
        if process is not None and process.is_alive():
            process.kill()

    def _reap(self) -> None:
        process = self._process
        if process is None:
            return
        process.join(_END_S)
        if process.is_alive():
            process.kill()
            process.join()

    def _crash_text(self) -> str:
        self._process.join(_END_S)
        code = self._process.exitcode
        if code is not None and code < 0:
            return f"{self._name} crashed: its process was ended by {signal.Signals(-code).name}."
        return f"{self._name} crashed: its process ended with exit code {code}."


@contextlib.contextmanager
def _ctrl_c_held() -> Iterator[None]:
    """What this thread starts meanwhile hears Ctrl-C when it says how it takes it, not while it loads."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


# -- in the other process -----------------------------------------------------------------------------------


class IsolatedContext:
    """What an isolated action gets as its first argument; implements `RunHandle`."""

    def __init__(self, order: _Order, connection: Connection) -> None:
        self.actor, self.graph_name, self.node = order.actor, order.graph_name, order.node
        self.result_asked = order.result_asked
        """See `RunHandle.result_asked`; as it was when the run began."""
        self.clock: Clock = WallClock()
        self.motion = Motion(order.node)
        self.run: RunHandle = self
        """Itself, so that ``ctx.run.log`` works here as in other actions."""
        self._connection = connection
        self._lock = threading.Lock()
        self._stopping = False
        self._stop_calls: list[Callable[[], None]] = []

    def log(self, text: str) -> None:
        """See `RunHandle.log`."""
        self.send("log", str(text))

    def progress(self, fraction: float | None, text: str = "") -> None:
        """See `RunHandle.progress`."""
        self.send("progress", fraction, text)

    @property
    def paused(self) -> bool:
        """Never: a pause lets it finish."""
        return False

    async def wait_while_paused(self) -> None:
        """Return at once."""

    @property
    def stop_requested(self) -> bool:
        """See `RunHandle.stop_requested`."""
        return self._stopping

    def send(self, *message: Any) -> None:
        """Tell the engine's process."""
        with self._lock:
            self._connection.send(message)

    def on_stop(self, call: Callable[[], None]) -> None:
        """Have `call` called, in another thread, when a stop is requested."""
        self._stop_calls.append(call)
        if self._stopping:
            call()

    def listen(self) -> None:
        """Wait for a stop; without an engine nobody could ever end this process, so it ends itself."""
        try:
            self._connection.recv()
        except (EOFError, OSError):
            os._exit(1)
        self._stopping = True
        for call in self._stop_calls:
            call()
        try:
            self._connection.recv()
        except (EOFError, OSError):
            os._exit(1)


def _work(connection: Connection, order: _Order) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the engine's to handle
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    context, action = IsolatedContext(order, connection), order.node.rpartition("_")[0]
    threading.Thread(target=context.listen, name="stop", daemon=True).start()
    try:
        found = _find(order)
        spec = replace(found.spec, isolated=False)
        outcome = outcome_of(spec, _call(spec, context, order.values))
        facts = {name: value for name, value in outcome.facts.items() if _can_leave(name, value, context)}
        last: tuple[Any, ...] = ("returned", outcome.result, dict(outcome.outputs), facts)
    except ActionFailure as failure:
        last = ("failed", failure.code.value, failure.message, failure.details)
    except asyncio.CancelledError:
        last = ("failed", FailureCode.INTERNAL.value, "It was cancelled.", {})
    except BaseException as raised:  # noqa: BLE001 - told to the engine, which tells people
        last = ("failed", FailureCode.INTERNAL.value, raised_text(action, harmless(raised)), {})
    try:
        context.send(*last)
    except Exception as error:  # noqa: BLE001 - told to the engine, which tells people
        text = f"What {action} gave cannot leave its process: {text_of(error)}"
        context.send("failed", FailureCode.INTERNAL.value, text, {})


def _can_leave(name: str, value: Any, context: IsolatedContext) -> bool:
    """Whether a fact can be told to the engine; if not, the log of the node says so."""
    try:
        pickle.dumps(value)
    except Exception as error:  # noqa: BLE001 - told in the node's log
        context.log(f"{name} is not told, as it cannot leave its process: {text_of(error)}")
        return False
    return True


def _find(order: _Order) -> Action[..., Any]:
    if order.file:
        module = import_file(Path(order.file), order.module)
    else:
        module = importlib.import_module(order.module)
    found = getattr(module, order.attribute)
    assert isinstance(found, Action)
    return found


def _call(spec: ActionSpec, context: IsolatedContext, values: Mapping[str, Any]) -> Any:
    run = spec.runner()
    assert run is not None
    arguments = bind_inputs(spec, values) if spec.arguments else dict(values)
    if not inspect.iscoroutinefunction(run):
        return run(context, **arguments)

    async def cancellable() -> Any:
        loop = asyncio.get_running_loop()
        task = asyncio.ensure_future(run(context, **arguments))

        def cancel() -> None:
            loop.call_soon_threadsafe(task.cancel)

        context.on_stop(cancel)
        return await task

    return asyncio.run(cancellable())
