"""The services of `rosapi`, which runs beside a bridge and tells who is there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from parley.messages.topics import Service

__all__ = [
    "ACTION_SERVERS", "GET_PARAM", "NODES", "NODE_DETAILS", "SERVICE_TYPE", "TOPICS", "ActionServersRequest",
    "ActionServersResponse", "GetParamRequest", "GetParamResponse", "NodeDetailsRequest",
    "NodeDetailsResponse", "NodesRequest", "NodesResponse", "ServiceTypeRequest", "ServiceTypeResponse",
    "TopicsRequest", "TopicsResponse",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class TopicsRequest:
    """rosapi_msgs/srv/Topics, request."""


@dataclass(frozen=True, slots=True)
class TopicsResponse:
    """rosapi_msgs/srv/Topics, response: names, and the type of each."""

    topics: tuple[str, ...] = ()
    types: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class NodesRequest:
    """rosapi_msgs/srv/Nodes, request."""


@dataclass(frozen=True, slots=True)
class NodesResponse:
    """rosapi_msgs/srv/Nodes, response."""

    nodes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class NodeDetailsRequest:
    """rosapi_msgs/srv/NodeDetails, request."""

    node: str = ""


@dataclass(frozen=True, slots=True)
class NodeDetailsResponse:
    """rosapi_msgs/srv/NodeDetails, response."""

    subscribing: tuple[str, ...] = ()
    publishing: tuple[str, ...] = ()
    services: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ServiceTypeRequest:
    """rosapi_msgs/srv/ServiceType, request."""

    service: str = ""


@dataclass(frozen=True, slots=True)
class ServiceTypeResponse:
    """rosapi_msgs/srv/ServiceType, response; empty: it is not there."""

    type: str = ""


@dataclass(frozen=True, slots=True)
class ActionServersRequest:
    """rosapi_msgs/srv/GetActionServers, request."""


@dataclass(frozen=True, slots=True)
class ActionServersResponse:
    """rosapi_msgs/srv/GetActionServers, response."""

    action_servers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class GetParamRequest:
    """rosapi_msgs/srv/GetParam, request: `node:parameter`."""

    name: str = ""
    default_value: str = ""


@dataclass(frozen=True, slots=True)
class GetParamResponse:
    """rosapi_msgs/srv/GetParam, response: as JSON."""

    value: str = ""


GET_PARAM: Final = Service("/rosapi/get_param", GetParamRequest, GetParamResponse, "rosapi_msgs/srv/GetParam")
TOPICS: Final = Service("/rosapi/topics", TopicsRequest, TopicsResponse, "rosapi_msgs/srv/Topics")
NODES: Final = Service("/rosapi/nodes", NodesRequest, NodesResponse, "rosapi_msgs/srv/Nodes")
NODE_DETAILS: Final = Service(
    "/rosapi/node_details", NodeDetailsRequest, NodeDetailsResponse, "rosapi_msgs/srv/NodeDetails"
)
SERVICE_TYPE: Final = Service(
    "/rosapi/service_type", ServiceTypeRequest, ServiceTypeResponse, "rosapi_msgs/srv/ServiceType"
)
ACTION_SERVERS: Final = Service(
    "/rosapi/action_servers", ActionServersRequest, ActionServersResponse, "rosapi_msgs/srv/GetActionServers"
)
