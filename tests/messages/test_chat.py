"""Chat Actions in all the spellings that the thesis's programs and language models use."""

from __future__ import annotations

import json
from typing import Any

import pytest

from parley.messages.chat import SYSTEM_COMMANDS, ActionCall, ChatAction, Flow, FlowIf, SystemCommand
from parley.messages.pvf import Parameter
from parley.messages.wire import decode, encode
from tests.messages.samples import LOOK, MOVE


def read(**fields: Any) -> ChatAction:
    return decode(ChatAction, json.dumps(fields))


def test_an_action_of_a_queue_is_named_by_its_key() -> None:
    (call,) = read(queue=[MOVE]).queue
    assert call == ActionCall(
        name="Move",
        input_parameters={
            "pose::position::x": Parameter("number", 1.5),
            "way": Parameter("strings", ["quick", "quiet"]),
        },
        output_parameters={"arrived": Parameter("bool")},
        reason="to fetch the box",
        flow=Flow(if_=FlowIf(step=0, result=False), together_with=1, repeat=3),
    )


def test_several_actions_in_one_queue_item_become_steps_of_their_own_in_order() -> None:
    assert [call.name for call in read(queue=[MOVE | LOOK, MOVE]).queue] == ["Move", "Look", "Move"]


@pytest.mark.parametrize("body", [None, {}, {"input_parameters": None}])
def test_an_action_without_parameters_may_leave_them_out(body: Any) -> None:
    assert read(queue=[{"Look": body}]).queue == (ActionCall(name="Look"),)


def test_our_extras_are_written_only_where_they_say_something() -> None:
    assert json.loads(encode(ActionCall(name="Look"))) == LOOK
    assert set(json.loads(encode(ChatAction()))) == {"message_response", "queue", "system_cmd", "targets"}


def test_message_stands_for_message_response_unless_both_are_there() -> None:
    assert read(message="solved").message_response == "solved"
    assert read(message="a", message_response="b").message_response == "b"


def test_target_stands_for_targets_unless_both_are_there() -> None:
    assert read(target="A").targets == ("A",)
    assert read(target="A", targets=["B", "C"]).targets == ("B", "C")


def test_success_is_written_for_error_resolutions_alone() -> None:
    assert json.loads(encode(ChatAction(success=False)))["success"] is False
    assert "success" not in json.loads(encode(ChatAction()))


@pytest.mark.parametrize("command", SYSTEM_COMMANDS)
@pytest.mark.parametrize("arguments", [{}, None])
def test_every_command_of_the_table_is_read_with_or_without_arguments(
    command: str, arguments: dict[str, Any] | None
) -> None:
    (read_command,) = read(system_cmd=[{command: arguments}]).system_cmd
    assert (read_command.command, read_command.arguments) == (command, {})


@pytest.mark.parametrize(
    "spelling", [["stop", "clear"], [{"stop": {}}, {"clear": {}}], {"stop": {}, "clear": None}]
)
def test_commands_may_be_texts_objects_or_one_object(spelling: Any) -> None:
    assert [command.command for command in read(system_cmd=spelling).system_cmd] == ["stop", "clear"]


@pytest.mark.parametrize(
    ("arguments", "index"),
    [
        ({"parameters": 2}, 2),
        ({"parameters": "2"}, 2),
        ({"parameters": " 02 "}, 2),
        ({"parameters": 2.0}, 2),
        ({"index": 0}, 0),
        (3, 3),
        ("3", 3),
        ({}, None),
        ({"parameters": 2.5}, None),
        ({"parameters": True}, None),
        ({"parameters": "second"}, None),
        ({"parameters": ""}, None),
        ({"parameters": [1]}, None),
        ({"parameters": "²"}, None),
        ({"parameters": "9" * 5000}, None),
    ],
)
def test_pop_takes_a_number_or_numeric_text(arguments: Any, index: int | None) -> None:
    (command,) = read(system_cmd=[{"pop": arguments}]).system_cmd
    assert command.pop_index == index


def test_arguments_of_a_command_survive_the_wire() -> None:
    command = SystemCommand(command="add_memory", arguments={"data": "d", "info": "i", "name": "n"})
    assert read(system_cmd=[json.loads(encode(command))]).system_cmd == (command,)
