"""Whoever calls out while a robot drives is obeyed before anybody understands; the rest holds nobody."""

from __future__ import annotations

import asyncio
from typing import Final

import pytest

from parley.messages.chat import ChatAction
from tests.attacks.cases import START, a
from tests.attacks.conftest import COUNTS, FOUND
from tests.attacks.house import ADA, House, Houses
from tests.attacks.playing import under
from tests.attacks.wordings import NO_STOPS, STOPS

STANDS_M: Final = 0.01


async def _stands(house: House) -> bool:
    """Whether it does not move for two seconds of its time."""
    robot = house.system.robots[ADA]
    await house.passes(1.0)  # the way it takes to stand still
    before = robot.pose()
    await house.passes(2.0)
    return robot.pose().distance_to(before) < STANDS_M


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize("words", STOPS)
async def test_a_call_to_stop_holds_a_robot_before_it_is_understood_and_whatever_an_engine_makes_of_it(
    houses: Houses, words: str
) -> None:
    house = await houses.fresh("run_at_once")
    await under(house, "driving", "run_at_once")
    understood = asyncio.Event()
    house.language.will("interpret", understood, ChatAction.model_validate(a("Going on.", cmd=[START])))
    house.say(words)
    await house.settled(0.2)
    held = await _stands(house)
    understood.set()
    await house.settled()
    stays = await _stands(house) and house.witness.state(ADA) in ("paused", "idle")
    COUNTS["run_at_once"]["calls to stop"] += 1
    COUNTS["run_at_once"]["of them not obeyed"] += not (held and stays)
    if not held or not stays:
        FOUND[f"stop: {words}"]["did not hold" if not held else "did not stay"].append("run_at_once")
    assert held, "it drove on while it was understood"
    assert stays, "it went on by itself"


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize("words", NO_STOPS)
async def test_what_is_no_stop_holds_a_robot_at_most_until_it_is_understood(
    houses: Houses, words: str
) -> None:
    house = await houses.fresh("run_at_once")
    await under(house, "driving", "run_at_once")
    house.language.will("interpret", ChatAction.model_validate(a("All right.")))
    identity = house.say(words)
    await house.reply(identity)
    await house.settled()
    held = await _stands(house)
    COUNTS["run_at_once"]["other calls"] += 1
    COUNTS["run_at_once"]["of them held"] += held
    if held:
        FOUND[f"no stop: {words}"]["held"].append("run_at_once")
    assert not held, "it was held for good"


def test_there_are_as_many_as_were_promised() -> None:
    assert len(set(STOPS)) >= 40 and len(set(NO_STOPS)) >= 20
    assert not set(STOPS) & set(NO_STOPS)
