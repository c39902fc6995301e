"""The table of topics against the contract (design, "The contract on the wire")."""

from __future__ import annotations

import re
from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.messages import ros, topics
from parley.messages.topics import ALL_SERVICES, ALL_TOPICS, actor_graph_get, display_topic

STRING = "std_msgs/msg/String"
CONTRACT = {
    "chat_interface_input": STRING,
    "chat_interface_feedback": STRING,
    "chat_action": STRING,
    "umrf_correction": STRING,
    "error_handling_message": STRING,
    "add_to_memory": STRING,
    "remove_memory": STRING,
    "display_feed": STRING,
    "umrf_graph_start": "temoto_msgs/msg/UmrfGraphStart",
    "umrf_graph_modify": "temoto_msgs/msg/UmrfGraphModify",
    "umrf_graph_pause": "temoto_msgs/msg/UmrfGraphPause",
    "umrf_pause_pause": "temoto_msgs/msg/UmrfGraphPause",
    "umrf_graph_resume": "temoto_msgs/msg/UmrfGraphResume",
    "umrf_graph_stop": "temoto_msgs/msg/UmrfGraphStop",
    "umrf_graph_feedback": "temoto_msgs/msg/UmrfGraphFeedback",
}
SERVICES = {
    "get_memory": "nl_interface_msgs/srv/Chat",
    "umrf_graph_get": "temoto_msgs/srv/UmrfGraphGet",
}
ROS_NAME = re.compile(r"/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


def test_names_and_types_are_those_other_programs_depend_on() -> None:
    theirs = {topic.name: topic.ros_type for topic in ALL_TOPICS if not topic.name.startswith("/parley/")}
    assert theirs == CONTRACT
    services = {service.name: service.ros_type for service in ALL_SERVICES}
    assert {name: kind for name, kind in services.items() if not name.startswith("/parley/")} == SERVICES
    assert {kind for name, kind in services.items() if name not in SERVICES} == {SERVICES["get_memory"]}


def test_what_is_ours_stands_under_one_prefix_as_json_text() -> None:
    ours = {topic.name: topic.ros_type for topic in ALL_TOPICS if topic.name not in CONTRACT}
    assert set(ours.values()) == {STRING}
    assert all(re.fullmatch(r"/parley/[a-z_]+", name) for name in ours)
    assert {"/parley/actor_status", "/parley/graph_events", "/parley/plan", "/parley/plan_decision",
            "/parley/stop", "/parley/rejection", "/parley/sync"} <= set(ours)  # fmt: skip


def test_the_table_holds_every_topic_and_service_of_the_module_once() -> None:
    defined = [item for item in vars(topics).values() if isinstance(item, topics.Topic)]
    assert sorted(topic.name for topic in defined) == sorted(topic.name for topic in ALL_TOPICS)
    assert len({topic.name for topic in ALL_TOPICS}) == len(ALL_TOPICS)
    assert {item for item in vars(topics).values() if isinstance(item, topics.Service)} == set(ALL_SERVICES)


@pytest.mark.parametrize("topic", ALL_TOPICS, ids=lambda topic: str(topic.name))
def test_the_python_type_of_a_topic_is_named_like_its_ros_type(topic: topics.Topic[object]) -> None:
    assert topic.type.__name__ == topic.ros_type.split("/")[-1]
    assert topic.type() == topic.type(), "messages are equal by content and every field has ROS's default"


def test_ros_messages_have_the_fields_of_their_definitions() -> None:
    def names(kind: type) -> list[str]:
        return [field.name for field in fields(kind)]

    assert names(ros.UmrfGraphStart) == [
        "umrf_graph_name", "umrf_graph_json", "targets", "name_match_required",
    ]  # fmt: skip
    assert names(ros.UmrfGraphModify) == ["umrf_graph_name", "targets", "modified_graph", "continue_from"]
    for kind in (ros.UmrfGraphStop, ros.UmrfGraphPause, ros.UmrfGraphResume):
        assert names(kind) == ["umrf_graph_name", "targets"]
    assert names(ros.UmrfGraphFeedback) == ["actor", "history"]
    assert names(ros.ChatRequest) == ["message"]
    assert names(ros.ChatResponse) == ["response"]
    assert names(ros.CompressedImage) == ["header", "format", "data"]


def test_a_finished_display_feed_is_latched_and_keeps_only_the_newest() -> None:
    topic = display_topic("A", "front_camera")
    assert topic.name == "/webapp/display_feed/A/front_camera"
    assert topic.ros_type == "sensor_msgs/msg/CompressedImage"
    assert topic.qos.latched
    assert topic.qos.depth == 1


@given(st.text(max_size=20), st.text(max_size=20))
def test_names_made_of_what_people_write_are_valid_in_ros(target: str, name: str) -> None:
    assert ROS_NAME.fullmatch(display_topic(target, name).name)
    assert ROS_NAME.fullmatch(actor_graph_get(target).name)


def test_an_engine_answers_under_its_actor_s_name() -> None:
    assert actor_graph_get("robot 1").name == "/robot_1/umrf_graph_get"
