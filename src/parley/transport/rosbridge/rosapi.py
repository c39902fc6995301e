"""The services of `rosapi`, which runs beside a bridge and tells who is there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from parley.messages.topics import Service

__all__ = [
    "ACTION_SERVERS", "GET_PARAM", "NODES", "NODE_DETAILS", "PUBLISHERS", "SERVICES", "SERVICE_NODE",
    "SERVICE_TYPE", "SUBSCRIBERS", "TOPICS", "ActionServersRequest", "ActionServersResponse",
    "GetParamRequest", "GetParamResponse", "NodeDetailsRequest", "NodeDetailsResponse", "NodesRequest",
    "NodesResponse", "PublishersRequest", "PublishersResponse", "ServiceNodeRequest", "ServiceNodeResponse",
    "ServiceTypeRequest", "ServiceTypeResponse", "ServicesRequest", "ServicesResponse",
    "SubscribersRequest", "SubscribersResponse", "TopicsRequest", "TopicsResponse",
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
class ServicesRequest:
    """rosapi_msgs/srv/Services, request."""


@dataclass(frozen=True, slots=True)
class ServicesResponse:
    """rosapi_msgs/srv/Services, response: those that somebody answers, or only calls."""

    services: tuple[str, ...] = ()


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
class PublishersRequest:
    """rosapi_msgs/srv/Publishers, request."""

    topic: str = ""


@dataclass(frozen=True, slots=True)
class PublishersResponse:
    """rosapi_msgs/srv/Publishers, response: names of nodes."""

    publishers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SubscribersRequest:
    """rosapi_msgs/srv/Subscribers, request."""

    topic: str = ""


@dataclass(frozen=True, slots=True)
class SubscribersResponse:
    """rosapi_msgs/srv/Subscribers, response: names of nodes."""

    subscribers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ServiceNodeRequest:
    """rosapi_msgs/srv/ServiceNode, request."""

    service: str = ""


@dataclass(frozen=True, slots=True)
class ServiceNodeResponse:
    """rosapi_msgs/srv/ServiceNode, response: the node's name; empty: nobody answers it."""

    node: str = ""


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
SERVICES: Final = Service("/rosapi/services", ServicesRequest, ServicesResponse, "rosapi_msgs/srv/Services")
NODES: Final = Service("/rosapi/nodes", NodesRequest, NodesResponse, "rosapi_msgs/srv/Nodes")
NODE_DETAILS: Final = Service(
    "/rosapi/node_details", NodeDetailsRequest, NodeDetailsResponse, "rosapi_msgs/srv/NodeDetails"
)
PUBLISHERS: Final = Service(
    "/rosapi/publishers", PublishersRequest, PublishersResponse, "rosapi_msgs/srv/Publishers"
)
SUBSCRIBERS: Final = Service(
    "/rosapi/subscribers", SubscribersRequest, SubscribersResponse, "rosapi_msgs/srv/Subscribers"
)
SERVICE_NODE: Final = Service(
    "/rosapi/service_node", ServiceNodeRequest, ServiceNodeResponse, "rosapi_msgs/srv/ServiceNode"
)
SERVICE_TYPE: Final = Service(
    "/rosapi/service_type", ServiceTypeRequest, ServiceTypeResponse, "rosapi_msgs/srv/ServiceType"
)
ACTION_SERVERS: Final = Service(
    "/rosapi/action_servers", ActionServersRequest, ActionServersResponse, "rosapi_msgs/srv/GetActionServers"
)
