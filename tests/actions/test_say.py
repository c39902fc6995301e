"""Say: in the chat, and aloud where the robot has a loudspeaker."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.actions.say import say
from parley.errors import ActionFailure, FailureCode
from parley.robots.own import RobotBase
from tests.actions.room import room
from tests.engine.rig import DummyRobot


@pytest.mark.parametrize(
    ("text", "person", "said"),
    [
        ("lunch is  ready.", "Kim", "Lunch is ready, Kim."),
        ("hello", "", "Hello."),
        ("hello", "operator", "Hello."),
        ("is anybody there?", "", "Is anybody there?"),
    ],
)
async def test_words_are_said_in_the_chat_and_aloud(text: str, person: str, said: str) -> None:
    robot = DummyRobot()
    robot.capabilities = frozenset({"loudspeaker"})
    async with room() as here:
        await say(replace(here.context, robot=robot), text, person)
        await say(here.context, text, person)
        assert here.person.told == [said, said]
        assert robot.told == [f"speak {said}"]  # the simulated robot has none


@pytest.mark.parametrize("text", ["", " . ", "x" * 1001])
async def test_nothing_and_too_much_are_refused(text: str) -> None:
    async with room() as here:
        with pytest.raises(ActionFailure) as failure:
            await say(here.context, text)
        assert failure.value.code is FailureCode.NOT_CAPABLE
        assert here.person.told == []


def test_robot_of_ones_own_sees_nobody_until_it_says_so() -> None:
    assert RobotBase.people(None) == ()  # type: ignore[arg-type]
