"""What the operator is to be asked, and how much something is."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

OBJECTS = (
    MapObject("oven", "oven", 4.0, 4.0, "oven"),
    MapObject("cellar", "cellar", -4.0, 4.0, "room"),
    MapObject("plant_1", "potted plant", 5.0, 4.0, "plant"),
    MapObject("plant_2", "potted plant", -9.0, 9.0, "plant"),
)


async def steps(said: str) -> list[str]:
    """The plan for what is said, as the sets write it."""
    situation = Situation(
        message=said,
        robot="Rob",
        robots=("Rob",),
        catalogue=CATALOGUES["thesis"],
        objects=OBJECTS,
        robot_pose=Pose2D(0.0, 0.0),
    )
    action = await OfflineLanguage().interpret(situation)
    return [str(step) for step in read_steps(action.queue, situation.catalogue)]


@pytest.mark.parametrize(
    ("said", "question"),
    [
        ("Go to the oven and ask me which tray I want.", "I am to ask you which tray you want."),
        ("Check the oven and then ask me what to bake.", "I am to ask you what to bake."),
        ("If the oven is off, ask me when to start.", "I am to ask you when to start."),
        ("Go to the cellar and ask who is there.", "Please ask who is there and tell me the answer."),
    ],
)
async def test_what_the_operator_is_asked_is_a_step(said: str, question: str) -> None:
    assert question in (await steps(said))[-1]


@pytest.mark.parametrize(
    ("said", "looked"),
    [
        ("Go to the oven and check how hot it is.", "how hot the oven is"),
        ("Check how full the cellar is.", "how full the cellar is"),
        ("Check how warm it is in the cellar.", "how warm it is in the cellar"),
    ],
)
async def test_how_much_is_kept_in_what_is_looked_at(said: str, looked: str) -> None:
    assert looked in (await steps(said))[-1]


async def test_an_identifier_that_looks_like_an_order_is_a_name() -> None:
    assert await steps("Check the plant near the oven.") == ["go ['plant_1']", "look ['plant_1']"]


async def test_what_is_dark_somewhere_is_looked_at_there() -> None:
    plan = await steps("If it is dark in the cellar, go to the oven.")
    assert plan[:2] == ["go ['cellar']", "look ['whether the cellar is dark']"]
    assert plan[2] == "if 2: go ['oven']"
