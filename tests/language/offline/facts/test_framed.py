"""What is told is kept, whatever frames it; what is to be forgotten goes, however that is said."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.language.offline.facts.framed import told_plainly
from parley.language.offline.words.text import plain, tokens
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="hall_1", description="hall", x_m=1.0, y_m=1.0, class_name="room"),
    MapObject(id="ramp_1", description="ramp", x_m=5.0, y_m=1.0, class_name="ramp"),
)
MEMORY = (
    MemoryEntry(name="ladder", data="The ladder is in the hall"),
    MemoryEntry(name="paint", data="The paint belongs to Uncle Bo"),
)


async def heard(message: str) -> ChatAction:
    return await OfflineLanguage().interpret(
        Situation(message=message, objects=MAP, memory=MEMORY, catalogue=CATALOGUES["thesis"])
    )


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("just so you are aware, the ramp is closed", "remember that the ramp is closed"),
        ("Note. Ramp jammed again.", "remember that Ramp jammed again."),
        ("do not you go forgetting the van comes at five", "remember that the van comes at five"),
        ("the ramp is closed, keep that in mind", "remember that the ramp is closed"),
        ("I got that wrong earlier: the ramp is open", "remember that the ramp is open"),
        ("before you start: the ramp is closed", "remember that the ramp is closed"),
        ("let me know if the ramp is closed", "let me know if the ramp is closed"),
        ("remember to check the ramp", "remember to check the ramp"),
        ("what I want is this: the ramp gets checked", "what I want is this: the ramp gets checked"),
    ],
)
def test_what_only_frames_something_told_comes_off(said: str, meant: str) -> None:
    assert plain(told_plainly(tokens(said))) == meant


@pytest.mark.parametrize(
    ("said", "gone"),
    [
        ("drop that thing about the ladder", "ladder"),
        ("erase the bit about Uncle Bo and his paint", "paint"),
        ("what I said about the ladder no longer holds", "ladder"),
        ("the ladder was stolen, so you can delete that", "ladder"),
        ("strike the ladder off your list", "ladder"),
    ],
)
async def test_what_was_told_is_forgotten_however_that_is_asked_for(said: str, gone: str) -> None:
    action = await heard(said)
    removed = [c.arguments.get("name") for c in action.system_cmd if c.command == "remove_memory"]
    assert removed == [gone]
