"""Typing errors, and what is none."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.words.mending import mended
from parley.language.offline.words.text import plain, tokens
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

OFFICE = MapObject("office", "office", 1.0, 1.0, "room")
KNOWN = Situation(
    message="",
    objects=(OFFICE,),
    catalogue=(ActionInfo(name="unload", inputs={"machine": "string"}),),
    robot="Fern",
    robots=("Fern",),
)


@pytest.mark.parametrize(
    ("say", "meant"),
    [
        ("dissect the frog", "dissect the frog"),
        ("look for frost", "look for frost"),
        ("contact Maria", "contact Maria"),
        ("is the form ready", "is the form ready"),
        ("come form the office", "come from the office"),
        ("forgotten chargers", "forgotten chargers"),
        ("look for Goran", "look for Goran"),
        ("go to the ofice", "go to the ofice"),
        ("unlod machine 2", "unload machine 2"),
        ("get it 4 me", "get it for me"),
        ("chekc the office", "check the office"),
        ("go to the off ice", "go to the office"),
        ("are the ligths on", "are the lights on"),
        ("go ot the office adn wait", "go to the office and wait"),
        ("look fo a hat", "look for a hat"),
        ("take a picture fo the office", "take a picture of the office"),
        ("wait ta the office", "wait at the office"),
        ("say ta to Maria", "say ta to Maria"),
        ("Si is in the office", "Si is in the office"),
        ("wait for fiev minutes", "wait for five minutes"),
        ("tweny minutes", "twenty minutes"),
        ("look for the fivers", "look for the fivers"),
        ("wich door is nearst", "which door is nearest"),
    ],
)
def test_only_what_is_no_word_is_mended(say: str, meant: str) -> None:
    assert plain(mended(tokens(say), KNOWN)) == meant
