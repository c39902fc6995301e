"""The table of topics and services: name, ROS type, quality of service (design section 2).

Each name is written here and nowhere else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from parley.messages import ros

__all__ = ["ALL_SERVICES", "ALL_TOPICS", "QoS", "Service", "Topic", "display_topic", "ros_name"]

M = TypeVar("M")
Req = TypeVar("Req")
Res = TypeVar("Res")


@dataclass(frozen=True, slots=True)
class QoS:
    """Quality of service, as much of it as we use."""

    reliable: bool = True
    latched: bool = False
    """Late subscribers get the last message (ROS: transient local)."""
    depth: int = 10
    """How many messages wait for a slow subscriber; older ones are dropped (ROS: keep last)."""
    keep_all: bool = False
    """Nothing is dropped, whatever depth a subscriber asks for (ROS: keep all)."""
    kept: int = 0
    """How many each sender keeps for those who were cut off and want to hear late what they missed."""
    repeats: bool = False
    """Its messages bear ids and are said again until they are read: an equal one is the same."""
    urgent: bool = False
    """Waits for no other topic."""


@dataclass(frozen=True, slots=True)
class Topic(Generic[M]):
    """A topic and everything both sides must agree on."""

    name: str
    type: type[M]
    ros_type: str
    qos: QoS = QoS()


@dataclass(frozen=True, slots=True)
class Service(Generic[Req, Res]):
    """A service and everything both sides must agree on."""

    name: str
    request: type[Req]
    response: type[Res]
    ros_type: str


def _string(
    name: str, *, latched: bool = False, depth: int = 100, keep_all: bool = False, kept: int = 0,
    repeats: bool = False,
) -> Topic[ros.String]:  # fmt: skip
    qos = QoS(latched=latched, depth=depth, keep_all=keep_all, kept=kept, repeats=repeats)
    return Topic(name, ros.String, "std_msgs/msg/String", qos)


# What may carry pictures is kept less of.
CHAT_INPUT = _string("chat_interface_input", kept=20, repeats=True)
CHAT_FEEDBACK = _string("chat_interface_feedback", kept=100)
CHAT_ACTION = _string("chat_action", kept=100, repeats=True)
UMRF_CORRECTION = _string("umrf_correction", kept=100)
ERROR_HANDLING = _string("error_handling_message")
ADD_TO_MEMORY = _string("add_to_memory", kept=20)
REMOVE_MEMORY = _string("remove_memory")
DISPLAY_FEED = _string("display_feed", depth=10)

GRAPH_START = Topic("umrf_graph_start", ros.UmrfGraphStart, "temoto_msgs/msg/UmrfGraphStart", QoS(depth=10))
GRAPH_MODIFY = Topic(
    "umrf_graph_modify", ros.UmrfGraphModify, "temoto_msgs/msg/UmrfGraphModify", QoS(depth=10)
)
GRAPH_PAUSE = Topic("umrf_graph_pause", ros.UmrfGraphPause, "temoto_msgs/msg/UmrfGraphPause", QoS(depth=10))
GRAPH_PAUSE_TEMOTO = Topic(
    "umrf_pause_pause", ros.UmrfGraphPause, "temoto_msgs/msg/UmrfGraphPause", QoS(depth=10)
)
"""The reference engine's misspelling (spec W1); engines listen to both."""
GRAPH_RESUME = Topic(
    "umrf_graph_resume", ros.UmrfGraphResume, "temoto_msgs/msg/UmrfGraphResume", QoS(depth=10)
)
GRAPH_STOP = Topic("umrf_graph_stop", ros.UmrfGraphStop, "temoto_msgs/msg/UmrfGraphStop", QoS(depth=10))
GRAPH_FEEDBACK = Topic(
    "umrf_graph_feedback", ros.UmrfGraphFeedback, "temoto_msgs/msg/UmrfGraphFeedback", QoS(depth=10)
)

ACTOR_STATUS = _string("/parley/actor_status")
GRAPH_EVENTS = _string("/parley/graph_events", depth=10_000, kept=1000)
PLAN = _string("/parley/plan", kept=100)
PLAN_DECISION = _string("/parley/plan_decision", kept=100, repeats=True)
RULING = _string("/parley/ruling", depth=1000)
STEP = _string("/parley/step")
STOP = _string("/parley/stop", keep_all=True, kept=100, repeats=True)
PULSE = Topic("/parley/pulse", ros.String, "std_msgs/msg/String", QoS(depth=10, urgent=True))
STOP_REPORT = _string("/parley/stop_report", kept=100)
REJECTION = _string("/parley/rejection", kept=100)
SYNC = _string("/parley/sync")
MEMORY_EVENT = _string("/parley/memory_event", kept=100)
ASIDE = _string("/parley/aside")
REPLY_DRAFT = _string("/parley/reply_draft", depth=1)
CHAT_READ = _string("/parley/chat_read", latched=True, depth=100)
PRESS_TAKEN = _string("/parley/press_taken", latched=True, depth=100)
INCIDENT = _string("/parley/incident")
MAP_VIEW = _string("/parley/map_view", depth=10)
AUDIT = _string("/parley/audit", depth=10_000, kept=1000)
ATTENDANCE = _string("/parley/attendance", latched=True)
RULES_IN_FORCE = _string("/parley/rules_in_force", latched=True, depth=1)
PLACES_KEPT = _string("/parley/places_kept", latched=True, depth=1)
MISSIONS = _string("/parley/missions", latched=True, depth=1)
PASSAGES = _string("/parley/passages", latched=True, depth=1)
NOTICE = _string("/parley/notice")

GET_MEMORY = Service("get_memory", ros.ChatRequest, ros.ChatResponse, "nl_interface_msgs/srv/Chat")
GET_INCIDENTS = Service(
    "/parley/get_incidents", ros.ChatRequest, ros.ChatResponse, "nl_interface_msgs/srv/Chat"
)
GET_AUDIT = Service("/parley/get_audit", ros.ChatRequest, ros.ChatResponse, "nl_interface_msgs/srv/Chat")
GET_MAP = Service("/parley/get_map", ros.ChatRequest, ros.ChatResponse, "nl_interface_msgs/srv/Chat")
RULES = Service("/parley/rules", ros.ChatRequest, ros.ChatResponse, "nl_interface_msgs/srv/Chat")
PLACES = Service("/parley/places", ros.ChatRequest, ros.ChatResponse, "nl_interface_msgs/srv/Chat")
GRAPH_GET = Service(
    "umrf_graph_get", ros.UmrfGraphGetRequest, ros.UmrfGraphGetResponse, "temoto_msgs/srv/UmrfGraphGet"
)

ALL_TOPICS: tuple[Topic[Any], ...] = (
    CHAT_INPUT, CHAT_FEEDBACK, CHAT_ACTION, UMRF_CORRECTION, ERROR_HANDLING, ADD_TO_MEMORY, REMOVE_MEMORY,
    DISPLAY_FEED, GRAPH_START, GRAPH_MODIFY, GRAPH_PAUSE, GRAPH_PAUSE_TEMOTO, GRAPH_RESUME, GRAPH_STOP,
    GRAPH_FEEDBACK, ACTOR_STATUS, GRAPH_EVENTS, PLAN, PLAN_DECISION, STEP, STOP, STOP_REPORT, REJECTION, SYNC,
    MEMORY_EVENT, REPLY_DRAFT, CHAT_READ, PRESS_TAKEN, INCIDENT, MAP_VIEW, AUDIT, RULING, ATTENDANCE,
    RULES_IN_FORCE, PLACES_KEPT, MISSIONS, PASSAGES, NOTICE, ASIDE, PULSE,
)  # fmt: skip
ALL_SERVICES = (GET_MEMORY, GRAPH_GET, GET_INCIDENTS, GET_MAP, GET_AUDIT, RULES, PLACES)


def display_topic(target: str, name: str) -> Topic[ros.CompressedImage]:
    """The topic of one finished display feed; characters ROS does not allow become underscores."""
    return Topic(
        f"/webapp/display_feed/{ros_name(target)}/{ros_name(name)}",
        ros.CompressedImage, "sensor_msgs/msg/CompressedImage", QoS(latched=True, depth=1),
    )  # fmt: skip


def actor_graph_get(actor: str) -> Service[ros.UmrfGraphGetRequest, ros.UmrfGraphGetResponse]:
    """The query service of one engine."""
    return Service(
        f"/{ros_name(actor)}/umrf_graph_get", GRAPH_GET.request, GRAPH_GET.response, GRAPH_GET.ros_type
    )


def actor_site(actor: str) -> Topic[ros.String]:
    """Where one robot is and what it is like."""
    return _string(f"/{ros_name(actor)}/parley_site", latched=True, depth=1)


def actor_unfinished(actor: str) -> Service[ros.ChatRequest, ros.ChatResponse]:
    """What one engine has not brought to an end."""
    name = f"/{ros_name(actor)}/parley_unfinished"
    return Service(name, GET_MEMORY.request, GET_MEMORY.response, GET_MEMORY.ros_type)


def ros_name(text: str) -> str:
    """A name as ROS allows it: what else there is becomes underscores."""
    cleaned = "".join(char if char.isascii() and (char.isalnum() or char == "_") else "_" for char in text)
    return f"_{cleaned}" if not cleaned or cleaned[0].isdigit() else cleaned
