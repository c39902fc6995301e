"""What people say that somebody needs, as orders."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.scene.needs import granted, needed
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="chair_1", description="red chair", x_m=1.0, y_m=1.0, class_name="chair"),
    MapObject(id="shelf_1", description="shelf", x_m=4.0, y_m=1.0, class_name="shelf"),
)
MEMORY = (
    MemoryEntry(name="ada_location", data="Ada is on the red chair"),
    MemoryEntry(name="soup_location", data="The soup is on the shelf"),
    MemoryEntry(name="gloves_location", data="Ada's gloves are on the shelf"),
)


def scene() -> Scene:
    return Scene.of(Situation(message="", objects=MAP, memory=MEMORY, catalogue=CATALOGUES["thesis"]))


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("Ada would like to drink something", "bring something to drink to Ada"),
        ("Ada has not eaten since yesterday", "bring something to eat to Ada"),
        ("it is time for Ada's soup", "bring soup to Ada"),
        ("Ada's throat is dry", "bring something to drink to Ada"),
        ("Ada can not work without her gloves", "bring Ada's gloves to Ada"),
        ("soup for Ada", "bring soup to Ada"),
        ("ada hungry", "bring something to eat to ada"),
        ("the woman on the red chair wants her soup now", "bring soup to woman on the red chair"),
    ],
)
def test_a_need_is_an_order_to_bring_what_helps(said: str, order: str) -> None:
    found = needed(tokens(said), scene())
    assert found is not None
    assert plain(found) == order


@pytest.mark.parametrize(
    "said",
    [
        "I have to eat now",
        "Ada is on the red chair",
        "Ada wants to go home",
        "the shelf has not been painted",
    ],
)
def test_what_nobody_lacks_is_no_order(said: str) -> None:
    assert needed(tokens(said), scene()) is None


def test_to_see_to_it_that_somebody_has_something_is_to_bring_it() -> None:
    found = granted(tokens("please see to it that Ada gets her soup"), scene())
    assert found is not None
    assert plain(found) == "bring soup to Ada"
