"""What a running graph tells its observers: every change once, numbered without gaps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, NamedTuple

import structlog

from parley.clock import Clock
from parley.messages.pvf import Parameter, native_type
from parley.umrf.flow import FlowNode
from parley.umrf.model import NOTHING, GraphState, Node, NodeState, Result
from parley.umrf.text import clean_text

__all__ = ["Announcer", "Observer", "Transition"]

log = structlog.get_logger(__name__)


Kind = Literal["graph", "node", "progress"]


class Transition(NamedTuple):
    """One change of a graph or of one of its nodes, or a sign of progress; a tuple as very many are made."""

    sequence: int
    """From 0, per run of a graph."""
    kind: Kind
    robot_time_s: float = 0.0
    unix_ms: int = 0
    state: str = ""
    """Node or graph state afterwards; empty for progress."""
    node: str = ""
    """Full name; empty for the graph itself."""
    instance_id: int = -1
    cause: str = ""
    """`start`, `edge`, `bypass`, `run` (the action itself), `dry`, `exit`, `stop`, `pause`, `resume`,
    `modify`, `continue`, `restart`, `retry`, `round` (of a spontaneous node), `end` (of one step), `restore`
    (taken over from a process that was killed)."""
    result: Result | None = None
    """How a node or the graph ended."""
    outputs: Mapping[str, Parameter] = NOTHING
    """Of a node that ended, by flat name, with values."""
    message: str = ""
    """Newest log line of a node that failed; why a graph halted."""
    progress: float | None = None
    """0 to 1, None if not known."""
    progress_text: str = ""


Observer = Callable[[Transition], None]
"""Only looks; called on the loop, at once, in order."""


class Announcer:
    """Numbers and stamps the transitions of one graph and hands them to its observer."""

    def __init__(self, graph_name: str, clock: Clock, observer: Observer | None) -> None:
        self._graph_name, self._clock, self._observer = graph_name, clock, observer
        self._sequence = 0

    def graph(self, state: GraphState, cause: str, result: Result | None, message: str = "") -> None:
        """The graph is now in `state`."""
        self._tell(Transition(*self._next("graph"), state.value, cause=cause, result=result, message=message))

    def node(
        self,
        item: FlowNode,
        cause: str,
        result: Result | None = None,
        facts: Mapping[str, Any] = NOTHING,
    ) -> None:
        """A node has got the state it has now.

        Args:
            item: The node.
            cause: What brought it about.
            result: How it ended, if it did.
            facts: What it tells of its end besides its outputs, by flat name.
        """
        outputs = item.given_outputs() if cause == "run" else NOTHING
        if facts:
            told = {name: Parameter(native_type(value), value) for name, value in facts.items()}
            outputs = {**outputs, **told}
        message = item.log[-1].message if item.state is NodeState.ERROR and item.log else ""
        state, name, number = item.state.value, item.name, item.node.instance_id
        self._tell(Transition(*self._next("node"), state, name, number, cause, result, outputs, message))

    def progress(self, node: Node, fraction: float | None, text: str) -> None:
        """A node got on."""
        made = Transition(
            *self._next("progress"),
            node=node.full_name,
            instance_id=node.instance_id,
            progress=fraction,
            progress_text=clean_text(text),
        )
        self._tell(made)

    def _next(self, kind: Kind) -> tuple[int, Kind, float, int]:
        self._sequence += 1
        return self._sequence - 1, kind, self._clock.now_s(), self._clock.unix_ms()

    def _tell(self, transition: Transition) -> None:
        if self._observer is None:
            return
        try:
            self._observer(transition)
        except Exception:
            # An observer only looks: its defect must not derail the robot, but it must be seen.
            log.exception("observer failed", graph=self._graph_name, sequence=transition.sequence)
