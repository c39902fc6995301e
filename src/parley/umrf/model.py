"""UMRF graphs as values (`spec/umrf.md` sections 1 to 6 and 8).

Frozen and complete: reading, writing, checking and running all speak in these types.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from parley.messages.pvf import Parameter

__all__ = [
    "ACTIVE",
    "BUSY",
    "DEFAULT_CONDITIONS",
    "ENDED",
    "ENTRY",
    "EXIT",
    "MAX_MESSAGES",
    "NOTHING",
    "ChildRelation",
    "Graph",
    "GraphState",
    "LogMessage",
    "Node",
    "NodeRef",
    "NodeState",
    "ParentRelation",
    "Response",
    "Result",
]


NOTHING: Final[Mapping[str, Any]] = MappingProxyType({})
"""No values."""


class _Word(StrEnum):
    """A closed list of words that is looked up for each change: by the text's own hash, which is kept."""

    __hash__ = str.__hash__


class NodeState(_Word):
    """State of an action node (8.1); the spellings are the contract."""

    UNINITIALIZED = "UNINITIALIZED"
    INITIALIZED = "INITIALIZED"
    RUNNING = "RUNNING"
    PAUSE_REQUESTED = "PAUSE_REQUESTED"
    PAUSED = "PAUSED"
    STOPPING = "STOPPING"
    FINISHED = "FINISHED"
    BYPASSED = "BYPASSED"
    ERROR = "ERROR"


class GraphState(_Word):
    """State of a graph (8.2)."""

    UNINITIALIZED = "UNINITIALIZED"
    INITIALIZED = "INITIALIZED"
    RUNNING = "RUNNING"
    PAUSED = "PAUSED"
    STOPPING = "STOPPING"
    STOPPED = "STOPPED"
    FINISHED = "FINISHED"
    ERROR = "ERROR"
    HALTED = "HALTED"
    CLEARING = "CLEARING"


ENDED: Final = frozenset({GraphState.FINISHED, GraphState.STOPPED, GraphState.ERROR})
"""States of a graph that cannot be gone on with."""
BUSY: Final = frozenset({GraphState.INITIALIZED, GraphState.RUNNING, GraphState.PAUSED, GraphState.STOPPING})
"""Those of one that nothing else may take the name of."""
ACTIVE: Final = frozenset(
    {NodeState.RUNNING, NodeState.PAUSE_REQUESTED, NodeState.PAUSED, NodeState.STOPPING}
)
"""States of a node of which a run is going on, standing still included."""


class Result(_Word):
    """How a node ended (5.3), and how a whole graph did (8.3)."""

    ON_TRUE = "on_true"
    ON_FALSE = "on_false"
    ON_STOPPED = "on_stopped"
    ON_ERROR = "on_error"
    ON_HALTED = "on_halted"
    """Graphs only."""


class Response(_Word):
    """What a child does when a parent ended so (5.3)."""

    RUN = "run"
    STOP = "stop"
    PAUSE = "pause"
    BYPASS = "bypass"
    IGNORE = "ignore"
    RESTART = "restart"


DEFAULT_CONDITIONS: Mapping[Result, Response] = {
    Result.ON_TRUE: Response.RUN,
    Result.ON_FALSE: Response.RUN,
    Result.ON_STOPPED: Response.IGNORE,
    Result.ON_ERROR: Response.BYPASS,
}
"""Responses where a relation does not say (5.3)."""


class NodeRef(NamedTuple):
    """Names a node inside its graph; a tuple, as checking a graph compares hardly anything else."""

    name: str
    instance_id: int = 0

    @property
    def full_name(self) -> str:
        """``<name>_<instance_id>`` (1)."""
        return f"{self.name}_{self.instance_id}"


ENTRY = NodeRef("graph_entry", 0)
EXIT = NodeRef("graph_exit", 0)


class ChildRelation(NamedTuple):
    """An entry of `children` or `graph_entry` (5.1)."""

    node: NodeRef
    remap: tuple[tuple[str, str], ...] = ()
    """(parent output, child input), flat names."""


class ParentRelation(NamedTuple):
    """An entry of `parents` or `graph_exit` (5.2)."""

    node: NodeRef
    required: bool = True
    conditions: Mapping[Result, Response] = MappingProxyType({})
    """Only what was stated; `response` fills in the defaults."""

    def response(self, result: Result) -> Response:
        """What to do when the parent ended with `result`."""
        return self.conditions.get(result, DEFAULT_CONDITIONS[result])


MAX_MESSAGES: Final = 10
"""So many log lines of a node are kept (3)."""


@dataclass(frozen=True, slots=True)
class LogMessage:
    """One entry of `runtime.messages`."""

    timestamp: int
    """Milliseconds since the Unix epoch."""
    message: str


class Node(NamedTuple):
    """One action node (3); a tuple, as one is made for each change of a running graph."""

    name: str
    instance_id: int = 0
    type: str = "sync"
    actor: str = ""
    description: str = ""
    state: NodeState = NodeState.UNINITIALIZED
    input_parameters: Mapping[str, Parameter] = NOTHING
    output_parameters: Mapping[str, Parameter] = NOTHING
    parents: tuple[ParentRelation, ...] = ()
    children: tuple[ChildRelation, ...] = ()
    gui_attributes: Any = None
    messages: tuple[LogMessage, ...] = ()
    """At most the 10 newest, oldest first."""
    retries: int = 0
    """How often it is tried again after a failure."""
    timeout_s: float | None = None
    """Robot time that one attempt may take, pauses left out; None: as long as the action itself may."""
    skipped: Result | None = None
    """What was passed on instead of running it, the last time that an edge said `bypass`."""

    @property
    def ref(self) -> NodeRef:
        """How relations name this node."""
        return NodeRef(self.name, self.instance_id)

    @property
    def full_name(self) -> str:
        """``<name>_<instance_id>``."""
        return f"{self.name}_{self.instance_id}"


@dataclass(frozen=True, slots=True)
class Graph:
    """One UMRF graph (2)."""

    name: str
    nodes: tuple[Node, ...] = ()
    entry: tuple[ChildRelation, ...] = ()
    exit: tuple[ParentRelation, ...] = ()
    description: str = ""
    state: GraphState = GraphState.UNINITIALIZED

    def node(self, full_name: str) -> Node | None:
        """The node of that full name, or None."""
        return next((node for node in self.nodes if node.full_name == full_name), None)
