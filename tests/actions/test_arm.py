"""PickUp and Place: what is in reach is in the hand and then where it was put; what cannot be is said."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from parley.actions.pick_up import pick_up
from parley.actions.place import place
from parley.agents.display.map_feed import view_of
from parley.errors import ActionFailure, FailureCode
from parley.language.builtin.engine import BuiltinLanguage
from parley.sim.solids import Solid
from parley.world.geometry import Pose2D
from tests.actions.room import Room, room
from tests.sim.worlds import box

ARM = "tiago_with_arm"


def cup(x: float = 1.9, y: float = 1.0, **more: Any) -> dict[str, Any]:
    return box("cup_1", x, y, (0.1, 0.1, 0.15), description="red cup", **more)


def crate_before(here: Room) -> None:
    """Turn the world so that the crate of the map is in front."""
    here.simulator.change({"move": {"A": (4.2, 2.0, 0.0)}})


def solids(here: Room) -> list[Solid]:
    world = here.simulator.world
    return [*world.thing("cup_1").solids(world.base_of(world.thing("cup_1")))]


async def refused(here: Room, code: FailureCode, words: str, thing: str = "cup") -> None:
    with pytest.raises(ActionFailure, match=words) as failed:
        await pick_up(here.context, thing)
    assert failed.value.code is code
    assert here.simulator.world.in_hand("A") is None


async def test_a_thing_is_taken_carried_and_put_where_the_robot_stands() -> None:
    async with room({"add": [cup()]}, BuiltinLanguage(), model=ARM) as here:
        await pick_up(here.context, "cup")
        assert here.robot.arm is not None
        assert (here.person.told, here.robot.arm.holds) == (["I have the red cup in my hand."], "red cup")
        assert view_of(here.robot, "hall", 0).holds == "red cup"
        photograph = await here.robot.image()
        assert [seen.label for seen in photograph.detections or ()] == ["green crate"]
        above = await here.simulator.top_down(300)
        crate_before(here)
        assert (await here.simulator.top_down(300) != above).any()
        await place(here.context)
        (lies,) = solids(here)
        assert Pose2D(lies.x_m, lies.y_m).distance_to(Pose2D(5.1, 2.0)) < 0.1
        assert lies.z_m == 0.5, "on the crate"
        assert here.person.told[-1] == "I have put the red cup on the green crate."


async def test_what_it_cannot_take_it_says_and_leaves() -> None:
    async with room({"add": [cup(2.4)]}, BuiltinLanguage(), model=ARM) as here:
        await refused(here, FailureCode.UNREACHABLE, "too short")
    large = box("cup_1", 1.9, 1.0, (0.5, 0.5, 0.3), description="red cup")
    async with room({"add": [large]}, BuiltinLanguage(), model=ARM) as here:
        await refused(here, FailureCode.NOT_CAPABLE, "too large")
    async with room(None, BuiltinLanguage(), model=ARM) as here:
        await refused(here, FailureCode.NO_MATCH, "cup")
    async with room({"add": [cup()]}, BuiltinLanguage()) as here:
        await refused(here, FailureCode.NOT_CAPABLE, "no arm. I can go there")


async def test_it_puts_nothing_down_where_there_is_nothing_and_takes_no_second_thing() -> None:
    async with room({"add": [cup()]}, BuiltinLanguage(), model=ARM) as here:
        with pytest.raises(ActionFailure, match="nothing in my hand"):
            await place(here.context)
        await pick_up(here.context, "cup")
        with pytest.raises(ActionFailure, match="Where shall I put it"):
            await place(here.context)
        here.simulator.change({"add": [cup() | {"name": "cup_2"}]})
        with pytest.raises(ActionFailure, match="Where shall I put it first"):
            await pick_up(here.context, "cup")


async def test_a_stopped_robot_does_not_take_anything() -> None:
    async with room({"add": [cup()]}, BuiltinLanguage(), model=ARM) as here:
        taking = asyncio.ensure_future(pick_up(here.context, "cup"))
        await asyncio.sleep(0)
        here.robot.halt()
        with pytest.raises(ActionFailure) as failed:
            await taking
        assert failed.value.code is FailureCode.DECLINED
        assert here.simulator.world.in_hand("A") is None
