"""The page about messages is held to the code: same names, same types, examples that can be read."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel

from parley.messages.attendance import Attendance
from parley.messages.audit import AuditEvent
from parley.messages.chat import (
    SYSTEM_COMMANDS,
    Aside,
    ChatAction,
    ChatFeedback,
    ChatInput,
    ChatRead,
    PressTaken,
    ReplyDraft,
)
from parley.messages.display import DisplayFeed
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.incident import Incident
from parley.messages.map import MapView, PlacesKept
from parley.messages.memory import AddToMemory, MemoryEvent, RemoveMemory
from parley.messages.passages import PassageList
from parley.messages.robot import Notice, RulesInForce
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanRuling,
    PlanUpdate,
    Pulse,
    Rejection,
    StepCommand,
    StopCommand,
    StopReport,
)
from parley.messages.team import MissionList
from parley.messages.topics import ALL_SERVICES, ALL_TOPICS, SYNC
from parley.messages.wire import decode, encode

PAGE = (Path(__file__).parent.parent / "docs" / "messages.md").read_text(encoding="utf-8")

PAYLOADS: dict[str, tuple[type[BaseModel], ...]] = {
    "chat_interface_input": (ChatInput,),
    "chat_interface_feedback": (ChatFeedback,),
    "chat_action": (ChatAction,),
    "umrf_correction": (ChatAction,),
    "error_handling_message": (ErrorHandlingMessage,),
    "add_to_memory": (AddToMemory,),
    "remove_memory": (RemoveMemory,),
    "display_feed": (DisplayFeed,),
    "/parley/actor_status": (ActorStatus,),
    "/parley/graph_events": (GraphEvent,),
    "/parley/plan": (PlanUpdate, PlanProposal),
    "/parley/plan_decision": (PlanDecision,),
    "/parley/ruling": (PlanRuling,),
    "/parley/step": (StepCommand,),
    "/parley/stop": (StopCommand,),
    "/parley/pulse": (Pulse,),
    "/parley/stop_report": (StopReport,),
    "/parley/rejection": (Rejection,),
    "/parley/memory_event": (MemoryEvent,),
    "/parley/reply_draft": (ReplyDraft,),
    "/parley/aside": (Aside,),
    "/parley/chat_read": (ChatRead,),
    "/parley/press_taken": (PressTaken,),
    "/parley/incident": (Incident,),
    "/parley/map_view": (MapView,),
    "/parley/audit": (AuditEvent,),
    "/parley/attendance": (Attendance,),
    "/parley/places_kept": (PlacesKept,),
    "/parley/rules_in_force": (RulesInForce,),
    "/parley/missions": (MissionList,),
    "/parley/passages": (PassageList,),
    "/parley/notice": (Notice,),
}


def section(title: str) -> str:
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


def rows(title: str) -> dict[str, str]:
    """The first two columns of a table: name and ROS type."""
    return dict(re.findall(r"^\| `([^`]+)` \| `([^`]+)` \|", section(title), re.MULTILINE))


def examples(topic: str) -> list[str]:
    text = section("Payloads").split(f"\n### `{topic}`\n")[1].split("\n### ")[0]
    return re.findall(r"```json\n(.*?)```", text, re.DOTALL)


def test_the_page_lists_every_topic_with_its_type() -> None:
    assert rows("Topics") == {topic.name: topic.ros_type for topic in ALL_TOPICS}


def test_the_page_lists_every_service_with_its_type() -> None:
    assert rows("Services") == {service.name: service.ros_type for service in ALL_SERVICES}


def test_every_json_topic_has_an_example() -> None:
    spoken = {topic.name for topic in ALL_TOPICS if topic.ros_type == "std_msgs/msg/String"} - {SYNC.name}
    assert set(re.findall(r"^### `([^`]+)`", section("Payloads"), re.MULTILINE)) == spoken == PAYLOADS.keys()


@pytest.mark.spec("W10")
@pytest.mark.parametrize(
    ("topic", "index"), [(topic, index) for topic, kinds in PAYLOADS.items() for index in range(len(kinds))]
)
def test_every_example_is_read_whole_and_shows_every_field(topic: str, index: int) -> None:
    text, kind = examples(topic)[index], PAYLOADS[topic][index]
    payload = decode(kind, text)
    shown, written = json.loads(text), json.loads(encode(payload))
    if kind is ChatAction:  # leaves out what says nothing
        shown = without_empty(shown)
        written = without_empty(written)
    assert shown == written


def without_empty(value: Any) -> Any:
    if not isinstance(value, dict):
        return [without_empty(item) for item in value] if isinstance(value, list) else value
    return {key: without_empty(item) for key, item in value.items() if item not in ("", [], {})}


def test_the_page_names_every_command() -> None:
    text = section("Payloads").split("\n### `chat_action`\n")[1].split("```")[0]
    assert [word for word in re.findall(r"`([a-z_]+)`", text) if word in SYSTEM_COMMANDS] == list(
        SYSTEM_COMMANDS
    )
