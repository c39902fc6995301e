"""What crosses a network is what ROS 2 sends: the bytes of every type we use, its hash, and the keys."""

from __future__ import annotations

import tracemalloc
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from parley.errors import FileFormatError, TypeMismatchError, UnsupportedError
from parley.messages import ros
from parley.messages.actions import (
    ActionWire,
    CancelGoalRequest,
    CancelGoalResponse,
    GetResultRequest,
    GoalId,
    GoalInfo,
    GoalState,
    GoalStatus,
    GoalStatusArray,
    SendGoalResponse,
)
from parley.messages.topics import ALL_SERVICES, ALL_TOPICS, QoS, display_topic
from parley.transport.base import Endpoint
from parley.transport.zenoh.cdr import Codec
from parley.transport.zenoh.definitions import Definitions
from parley.transport.zenoh.keys import Attachment, Node, all_tokens, endpoint_of, gid_of, key
from tests.transport.backends import DEFINITIONS
from tests.transport.test_actions import TEN, WAIT, Duration, WaitFeedback, WaitResult

WIRE = ActionWire(WAIT)
GOAL = GoalId(bytes(range(16)))
GOAL_HEX = "000102030405060708090a0b0c0d0e0f"

HASHES = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "sensor_msgs/msg/CompressedImage": "15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a",
    "nl_interface_msgs/srv/Chat": "86239f836ac8b8f9ab9c98a316efd80b5841037f1f80032341a02bfbebe4dcb3",
    "temoto_msgs/msg/UmrfGraphStart": "cf1ea8c1f1a0083c8e5bbe5328e748c69b1cd4b6972f70760d2daba4f0499fee",
    "temoto_msgs/msg/UmrfGraphStop": "d78fabb652f2782cce1e4686a5e60af5eeaa9cbfb8dba9514b3949c0b29e087b",
    "temoto_msgs/msg/UmrfGraphPause": "70adc6062515240392d2d088f9b995462455bab347e58201050267c161ae9fa1",
    "temoto_msgs/msg/UmrfGraphResume": "b5deaa0c746c18a808605d531c7b9bb22d5b1ea4c012662a9ff81ea7d68ed5b2",
    "temoto_msgs/msg/UmrfGraphModify": "0c7c9bb77fc99636fa6fe7ea3af46a22a5935fa3d11e876b1029c936d06bd962",
    "temoto_msgs/msg/UmrfGraphFeedback": "a4cb748a63d26812a5c1d50c0d11d845624f801b261011e610d24588c52b5261",
    "temoto_msgs/srv/UmrfGraphGet": "bc4864c42c0e73f872edf8f96032ea18be9e466c8fab9c3260a4282e42a5b987",
    "action_msgs/srv/CancelGoal": "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
    "action_msgs/msg/GoalStatusArray": "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e",
    "nav2_msgs/action/Wait": "0c5d418b19d8d009bb5bce6dca27687d9d43659016a70dc08307e38a032af2c3",
    "nav2_msgs/action/Wait_SendGoal": "aa768b9f4248c70a9c68fcf3a52f10300d4b0d21cad3cf39f01f4f3d248c2490",
    "nav2_msgs/action/Wait_GetResult": "6fa1323df11147db06a24a126119f542104f535108774b930b8047cfa34df466",
    "nav2_msgs/action/Wait_FeedbackMessage": "cb143310afa60cc18ef814ac127a730d4ee190828ce9b9a943fa8f0cb1a09f7c",  # noqa: E501
    "nav2_msgs/action/NavigateToPose": "a56dba8a3234a1215e610180dc703ae25bbf406dded8b54887891c9732857eab",
    "nav2_msgs/action/NavigateToPose_SendGoal": "a4fcb3bee1bf32e21a0e541a943b221aa0826996e2c98f079b47022b256f48b5",  # noqa: E501
    "nav_msgs/msg/Odometry": "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
    "nav_msgs/msg/OccupancyGrid": "8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7",
    "sensor_msgs/msg/LaserScan": "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828",
    "sensor_msgs/msg/Image": "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47",
    "tf2_msgs/msg/TFMessage": "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e",  # noqa: E501
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "std_msgs/msg/Bool": "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9",
    "temoto_msgs/srv/UmrfGraphGet_Request": "a69ace519c1225efba3a21a1235cc6f879cb1009d187c70d012bcf46cc889dfb",  # noqa: E501
}
"""As a ROS 2 Jazzy that was built from its sources says."""

GOLDEN: list[tuple[str, Any, str]] = [
    ("std_msgs/msg/String", ros.String("h\u00e9"), "04000000 68c3a900"),
    ("std_msgs/msg/String", ros.String(), "01000000 00"),
    (
        "sensor_msgs/msg/CompressedImage",
        ros.CompressedImage(ros.Header(ros.Time(-1, 2), "map"), "jpeg", b"\xff\xd8\x00"),
        "ffffffff 02000000 04000000 6d617000 05000000 6a70656700 000000 03000000 ffd800",
    ),
    ("nl_interface_msgs/srv/Chat_Request", ros.ChatRequest("a"), "02000000 6100"),
    ("nl_interface_msgs/srv/Chat_Response", ros.ChatResponse("b"), "02000000 6200"),
    (
        "temoto_msgs/msg/UmrfGraphStart",
        ros.UmrfGraphStart("g", "{}", ("r1", "r2"), True),
        "02000000 6700 0000 03000000 7b7d00 00 02000000 03000000 723100 00 03000000 723200 01",
    ),
    *(
        (f"temoto_msgs/msg/{kind.__name__}", kind("g", ("r",)), "02000000 6700 0000 01000000 02000000 7200")
        for kind in (ros.UmrfGraphStop, ros.UmrfGraphPause, ros.UmrfGraphResume)
    ),
    (
        "temoto_msgs/msg/UmrfGraphModify",
        ros.UmrfGraphModify("g", (), "{}", "a_0"),
        "02000000 6700 0000 00000000 03000000 7b7d00 00 04000000 615f3000",
    ),
    (
        "temoto_msgs/msg/UmrfGraphFeedback",
        ros.UmrfGraphFeedback("", ("x",)),
        "01000000 00 000000 01000000 02000000 7800",
    ),
    ("temoto_msgs/srv/UmrfGraphGet_Request", ros.UmrfGraphGetRequest(), "00"),
    (
        "temoto_msgs/srv/UmrfGraphGet_Response",
        ros.UmrfGraphGetResponse(("x",), (), ("y",)),
        "01000000 02000000 7800 0000 00000000 01000000 02000000 7900",
    ),
    (
        "action_msgs/srv/CancelGoal_Request",
        CancelGoalRequest(GoalInfo(GOAL, ros.Time(1, 2))),
        GOAL_HEX + "01000000 02000000",
    ),
    (
        "action_msgs/srv/CancelGoal_Response",
        CancelGoalResponse(1, (GoalInfo(GOAL),)),
        "01 000000 01000000" + GOAL_HEX + "00000000 00000000",
    ),
    (
        "action_msgs/msg/GoalStatusArray",
        GoalStatusArray((GoalStatus(GoalInfo(GOAL), GoalState.CANCELED),) * 2),
        f"02000000 {GOAL_HEX} 00000000 00000000 05 {GOAL_HEX} 000000 00000000 00000000 05",
    ),
    (
        "nav2_msgs/action/Wait_SendGoal_Request",
        WIRE.send_goal.request(GOAL, TEN),
        GOAL_HEX + "0a000000 00000000",
    ),
    (
        "nav2_msgs/action/Wait_SendGoal_Response",
        SendGoalResponse(True, ros.Time(3, 4)),
        "01 000000 03000000 04000000",
    ),
    ("nav2_msgs/action/Wait_GetResult_Request", GetResultRequest(GOAL), GOAL_HEX),
    (
        "nav2_msgs/action/Wait_GetResult_Response",
        WIRE.get_result.response(4, WaitResult(Duration(1, 2), 7, "")),
        "04 000000 01000000 02000000 0700 0000 01000000 00",
    ),
    (
        "nav2_msgs/action/Wait_FeedbackMessage",
        WIRE.feedback.type(GOAL, WaitFeedback(Duration(5))),
        GOAL_HEX + "05000000 00000000",
    ),
]
"""Written by hand after the rules of CDR: four bytes of header, then each value at a multiple of its size."""


@pytest.fixture(scope="module")
def definitions() -> Definitions:
    return Definitions(*DEFINITIONS)


@pytest.mark.parametrize("ros_type", HASHES)
def test_the_hash_of_a_type_is_that_of_a_real_ros(definitions: Definitions, ros_type: str) -> None:
    assert definitions.hash(ros_type) == f"RIHS01_{HASHES[ros_type]}"


@pytest.mark.parametrize(
    ("ros_type", "message", "golden"), GOLDEN, ids=[ros_type for ros_type, _, _ in GOLDEN]
)
def test_the_bytes_of_a_message_are_those_of_ros(
    definitions: Definitions, ros_type: str, message: Any, golden: str
) -> None:
    codec = Codec(definitions, type(message), ros_type)
    assert codec.encode(message).hex() == "00010000" + golden.replace(" ", "")
    assert codec.decode(codec.encode(message)) == message


def test_every_topic_and_service_of_ours_has_its_hash_and_its_bytes_held_here() -> None:
    types = {topic.ros_type for topic in (*ALL_TOPICS, display_topic("a", "b"), WIRE.status, WIRE.feedback)}
    services = {service.ros_type for service in (*ALL_SERVICES, WIRE.send_goal, WIRE.get_result, WIRE.cancel)}
    parts = {f"{service}_{part}" for service in services for part in ("Request", "Response")}
    assert (types | services) - HASHES.keys() == set()
    assert (types | parts) - {ros_type for ros_type, _, _ in GOLDEN} == set()


@dataclass(frozen=True)
class Other:
    text: str = ""


def test_a_class_with_other_fields_than_its_definition_is_refused_naming_both(
    definitions: Definitions,
) -> None:
    with pytest.raises(TypeMismatchError, match=r"Other has the fields text, and std_msgs/msg/String data"):
        Codec(definitions, Other, "std_msgs/msg/String")


@pytest.mark.parametrize(
    "data", ["", "00010000", "00010000 ff000000 61", "00010000 02000000 ff00", "07010000 00"]
)
def test_bytes_that_are_no_such_message_are_refused(definitions: Definitions, data: str) -> None:
    with pytest.raises(TypeMismatchError, match="std_msgs/msg/String"):
        Codec(definitions, ros.String, "std_msgs/msg/String").decode(bytes.fromhex(data))


def test_a_value_that_a_field_cannot_carry_is_refused(definitions: Definitions) -> None:
    codec = Codec(definitions, ros.Time, "builtin_interfaces/msg/Time")
    with pytest.raises(TypeMismatchError, match="builtin_interfaces/msg/Time"):
        codec.encode(ros.Time(2**40))
    with pytest.raises(TypeMismatchError):
        codec.encode(ros.Time("now"))  # type: ignore[arg-type]


def test_a_type_without_definition_is_refused_saying_where_it_belongs(definitions: Definitions) -> None:
    with pytest.raises(UnsupportedError, match=r"my_msgs/msg/Thing\.msg"):
        definitions.hash("my_msgs/msg/Thing")
    with pytest.raises(UnsupportedError, match="Chat_Nothing"):
        definitions.hash("nl_interface_msgs/srv/Chat_Nothing")


def test_a_definition_that_cannot_be_read_is_refused_naming_the_file(tmp_path: Path) -> None:
    for name, text in (("msg/Bad.msg", "string"), ("srv/Half.srv", "string a\n")):
        file = tmp_path / "my_msgs" / name
        file.parent.mkdir(parents=True)
        file.write_text(text, encoding="utf-8")
        with pytest.raises(FileFormatError, match=name):
            Definitions(tmp_path).hash(f"my_msgs/{name.rpartition('.')[0]}")


def test_a_definition_may_use_others_of_its_package_constants_and_comments(tmp_path: Path) -> None:
    folder = tmp_path / "my_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Box.msg").write_text(
        "# A box.\nuint8 RED=1\nuint8 colour  # of it\nstring<=5 name\n", encoding="utf-8"
    )
    (folder / "Boxes.msg").write_text("Box[] boxes\nfloat64[2] at\nbool[] full\n", encoding="utf-8")

    @dataclass(frozen=True)
    class Box:
        colour: int
        name: str

    @dataclass(frozen=True)
    class Boxes:
        boxes: tuple[Box, ...]
        at: tuple[float, ...]
        full: tuple[bool, ...]

    Boxes.__annotations__.update(boxes=tuple[Box, ...])
    codec = Codec(Definitions(tmp_path), Boxes, "my_msgs/msg/Boxes")
    boxes = Boxes((Box(1, "a"), Box(2, "")), (0.5, -1.0), (True, False))
    assert codec.decode(codec.encode(boxes)) == boxes


def test_keys_and_tokens_are_those_of_rmw_zenoh() -> None:
    """As seen of `ros2 run demo_nodes_cpp talker`, but for the session's number."""
    string = f"RIHS01_{HASHES['std_msgs/msg/String']}"
    assert (
        key(0, "/chatter", "std_msgs/msg/String", string)
        == f"0/chatter/std_msgs::msg::dds_::String_/{string}"
    )
    talker = Node(0, "aac3178e146ba6f1fc6e6a4085e77f21", "talker")
    chatter = Endpoint("/chatter", "std_msgs/msg/String", "publisher")
    token = talker.end_token(10, chatter, string, QoS(depth=7))
    assert token == (
        "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/10/MP/%/%/talker/%chatter/"
        f"std_msgs::msg::dds_::String_/{string}/::,7:,:,:,,"
    )
    assert endpoint_of(token) == chatter
    assert all_tokens(0) == "@ros2_lv/0/**"
    assert talker.token() == "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/talker"
    assert endpoint_of(talker.token()) is None
    nested = Endpoint("/robot/umrf_graph_get", "temoto_msgs/srv/UmrfGraphGet", "server")
    assert endpoint_of(talker.end_token(3, nested, "RIHS01_x", QoS(latched=True, keep_all=True))) == nested


def test_what_goes_with_a_message_is_33_bytes_and_comes_back() -> None:
    attached = Attachment(7, 1_700_000_000_000_000_000, gid_of("x"))
    data = attached.to_bytes()
    assert data[:8] == (7).to_bytes(8, "little")
    assert data[16] == 16
    assert len(data) == 33
    assert Attachment.from_bytes(data) == attached
    assert Attachment.from_bytes(b"of no ROS") is None
    assert gid_of("x") != gid_of("y")


def test_a_picture_is_copied_once_to_be_sent_and_once_when_it_came() -> None:
    codec = Codec(Definitions(), ros.CompressedImage, "sensor_msgs/msg/CompressedImage")
    picture = ros.CompressedImage(ros.Header(ros.Time(1, 2), "camera"), "jpeg", bytes(1_000_000))
    data = bytes(codec.encode(picture))
    for work in (lambda: codec.encode(picture), lambda: codec.decode(data)):
        tracemalloc.start()
        work()
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert most < 1_500_000
