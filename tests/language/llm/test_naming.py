"""Things that are named word for word need no model."""

from __future__ import annotations

import pytest

from parley.language.llm.naming import named
from parley.world.object_map import MapObject

RED = MapObject("box_1", "red box", 1.0, 1.0, "box", aliases=("parcel box",))
BLUE = MapObject("box_2", "blue box", 2.0, 1.0, "box")
GATE = MapObject("gate_1", "gate", 3.0, 1.0, "gate")
FENCE = MapObject("fence_1", "fence by the crane", 3.0, 1.0, "fence")
CRANE = MapObject("crane_1", "big crane", 4.0, 1.0, "crane")


@pytest.mark.parametrize(
    ("words", "things"),
    [
        ("box_2", [BLUE]), ("The red box", [RED]), ("a parcel box.", [RED]), ("the box", [RED, BLUE]),
        ("Gate", [GATE]), ("the box by the door", None), ("crane", None), ("", None), ("big red box", None),
    ],
)  # fmt: skip
def test_what_is_named(words: str, things: list[MapObject] | None) -> None:
    found = named(words, [RED, BLUE, GATE, FENCE, CRANE])
    if things is None:
        assert found is None
    else:
        assert found is not None
        assert (found.outcome == "match", list(found.candidates)) == (len(things) == 1, things)
