"""What only a machine or a driver could do is refused, not asked of somebody nearby."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.abilities import abilities
from parley.messages.chat import ChatAction
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="barge", description="green barge", x_m=2.0, y_m=0.0, class_name="barge"),
    MapObject(id="quay", description="quay", x_m=9.0, y_m=0.0, class_name="quay"),
)


async def told(message: str, catalogue: str = "thesis") -> ChatAction:
    return await OfflineLanguage().interpret(
        Situation(message=message, objects=MAP, catalogue=CATALOGUES[catalogue])
    )


@pytest.mark.parametrize(
    "said",
    [
        "Drive the coach to Bristol.",
        "Load the pallet of sacks onto the green barge.",
        "Move the piano to the quay.",
        "Take the green barge to the quay.",
    ],
)
async def test_it_is_refused(said: str) -> None:
    action = await told(said)
    assert not action.queue
    assert action.message_response.startswith(f"I cannot {said[:1].lower()}{said[1:-1]}")


@pytest.mark.parametrize("said", ["Drive to the green barge.", "Go to the barge."])
async def test_going_there_is_not(said: str) -> None:
    assert (await told(said)).queue


async def test_keys_and_toys_are_carried() -> None:
    for said in ("Bring the car keys to the quay.", "Bring the toy train to the quay."):
        assert not (await told(said)).message_response.startswith("I cannot bring")


async def test_whether_it_picks_things_up_is_answered() -> None:
    assert (await told("Can you pick things up?", "primitives")).message_response.startswith("Yes, I can")
    assert (await told("Can you pick things up?")).message_response.startswith("I cannot pick up things")


def test_what_is_done_to_one_kind_of_thing_is_named() -> None:
    shelve = ActionInfo(
        name="shelve_crate",
        inputs={"crate": "string", "rack": "string"},
        description="Put a crate on a rack.",
    )
    assert "put a crate on a rack" in abilities(Scene.of(Situation(message="x", catalogue=(shelve,))))
