"""Where something that is sought may be."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.sought import thought_there
from parley.language.offline.words.text import keys, tokens
from parley.world.object_map import MapObject


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("Look for the cat, she may be in the shed.", "Look for the cat at the shed."),
        (
            "Go home, then find my cap, I think I left it in the shed, and rest",
            "Go home, then find my cap at the shed and rest",
        ),
        (
            "Look for the cat in the barn, it was in the shed",
            "Look for the cat in the barn, it was in the shed",
        ),
        ("Clean the barn, it should be done by noon", "Clean the barn, it should be done by noon"),
    ],
)
def test_where_it_may_be_is_where_it_is_looked_for(said: str, read: str) -> None:
    objects = tuple(MapObject(id=name, description=name, x_m=0.0, y_m=0.0) for name in ("shed", "barn"))
    scene = Scene.of(Situation(message=said, objects=objects))
    assert keys(thought_there(tokens(said), scene)) == keys(tokens(read))
