"""What is to be sent because of a plan: the only way in which a plan acts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from parley.messages.failure import ErrorHandlingMessage
from parley.umrf.model import Graph

__all__ = [
    "AwaitResult", "Effect", "EndStep", "ModifyGraph", "PauseGraph", "ReportFailure", "ResumeGraph", "Say",
    "StartGraph", "StopGraph",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class StartGraph:
    """Publish on `umrf_graph_start`."""

    graph: Graph


@dataclass(frozen=True, slots=True)
class ModifyGraph:
    """Publish on `umrf_graph_modify`."""

    graph: Graph
    continue_from: str = ""


@dataclass(frozen=True, slots=True)
class PauseGraph:
    """Publish on `umrf_graph_pause`."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class ResumeGraph:
    """Publish on `umrf_graph_resume`."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class StopGraph:
    """Publish on `umrf_graph_stop`."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class EndStep:
    """Publish on `/parley/step`."""

    graph_name: str
    node: str


@dataclass(frozen=True, slots=True)
class AwaitResult:
    """Wait for the event that says how a step ended; look again if it does not come."""

    graph_name: str


@dataclass(frozen=True, slots=True)
class ReportFailure:
    """Publish on `error_handling_message`."""

    message: ErrorHandlingMessage


@dataclass(frozen=True, slots=True)
class Say:
    """Tell the operator."""

    text: str
    type: Literal["info", "error"] = "info"
    asks_yes: bool = False


Effect = (
    StartGraph | ModifyGraph | PauseGraph | ResumeGraph | StopGraph | EndStep | AwaitResult | ReportFailure
    | Say
)  # fmt: skip
