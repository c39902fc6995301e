"""The ROS messages that cross our topics, as frozen Python types with the field names of their definitions.

Sources: std_msgs, sensor_msgs, builtin_interfaces; temoto_msgs as restated in `spec/umrf.md` 12.4;
nl_interface_msgs/srv/Chat of the thesis.
"""

from __future__ import annotations

from dataclasses import dataclass, field

__all__ = [
    "ChatRequest",
    "ChatResponse",
    "CompressedImage",
    "Duration",
    "Header",
    "String",
    "Time",
    "UmrfGraphFeedback",
    "UmrfGraphGetRequest",
    "UmrfGraphGetResponse",
    "UmrfGraphModify",
    "UmrfGraphPause",
    "UmrfGraphResume",
    "UmrfGraphStart",
    "UmrfGraphStop",
]


@dataclass(frozen=True, slots=True)
class String:
    """std_msgs/msg/String."""

    data: str = ""


@dataclass(frozen=True, slots=True, order=True)
class Time:
    """builtin_interfaces/msg/Time."""

    sec: int = 0
    nanosec: int = 0


@dataclass(frozen=True, slots=True)
class Duration:
    """builtin_interfaces/msg/Duration."""

    sec: int = 0
    nanosec: int = 0


@dataclass(frozen=True, slots=True)
class Header:
    """std_msgs/msg/Header."""

    stamp: Time = field(default_factory=Time)
    frame_id: str = ""


@dataclass(frozen=True, slots=True)
class CompressedImage:
    """sensor_msgs/msg/CompressedImage; `data` is the encoded picture."""

    header: Header = field(default_factory=Header)
    format: str = "jpeg"
    data: bytes = b""


@dataclass(frozen=True, slots=True)
class UmrfGraphStart:
    """temoto_msgs/msg/UmrfGraphStart: run an indexed graph by name, or the graph in `umrf_graph_json`."""

    umrf_graph_name: str = ""
    umrf_graph_json: str = ""
    targets: tuple[str, ...] = ()
    name_match_required: bool = False


@dataclass(frozen=True, slots=True)
class UmrfGraphStop:
    """temoto_msgs/msg/UmrfGraphStop."""

    umrf_graph_name: str = ""
    targets: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class UmrfGraphPause:
    """temoto_msgs/msg/UmrfGraphPause."""

    umrf_graph_name: str = ""
    targets: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class UmrfGraphResume:
    """temoto_msgs/msg/UmrfGraphResume."""

    umrf_graph_name: str = ""
    targets: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class UmrfGraphModify:
    """temoto_msgs/msg/UmrfGraphModify; the name inside `modified_graph` is the one that counts."""

    umrf_graph_name: str = ""
    targets: tuple[str, ...] = ()
    modified_graph: str = ""
    continue_from: str = ""


@dataclass(frozen=True, slots=True)
class UmrfGraphFeedback:
    """temoto_msgs/msg/UmrfGraphFeedback: whole graphs as JSON, newest first."""

    actor: str = ""
    history: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class UmrfGraphGetRequest:
    """temoto_msgs/srv/UmrfGraphGet, request."""


@dataclass(frozen=True, slots=True)
class UmrfGraphGetResponse:
    """temoto_msgs/srv/UmrfGraphGet, response: descriptors, indexed graphs, graphs the engine holds."""

    umrf_jsons: tuple[str, ...] = ()
    graph_jsons_indexed: tuple[str, ...] = ()
    graph_jsons_running: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ChatRequest:
    """nl_interface_msgs/srv/Chat, request."""

    message: str = ""


@dataclass(frozen=True, slots=True)
class ChatResponse:
    """nl_interface_msgs/srv/Chat, response."""

    response: str = ""
