"""Stops on the way, what is waited for and what is left alone: nothing too early, or against the order."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from parley.evaluation.steps import read_steps
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.language.offline.sentences.ranking import any_of_those
from parley.language.offline.sentences.under_way import under_way
from parley.language.offline.words.text import keys, tokens
from parley.messages.chat import ChatAction
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject
from tests.language.dev_set import CATALOGUES

PLACES = (
    MapObject("q1", "quay 1", 1, 4, "quay"),
    MapObject("q2", "quay 2", 1, 8, "quay"),
    MapObject("q3", "quay 3", 1, 12, "quay"),
    MapObject("hut", "ticket hut", 6, 2, "hut"),
    MapObject("winch", "winch", 8, 8, "winch"),
    MapObject("tram", "tram stop", -6, 2, "tram stop"),
)


async def understood(say: str, catalogue: Sequence[ActionInfo] = CATALOGUES["thesis"]) -> ChatAction:
    return await OfflineLanguage().interpret(
        Situation(
            message=say, catalogue=tuple(catalogue), objects=PLACES, robot="Ada", robots=("Ada", "Bo", "Cy")
        )
    )


async def steps(say: str) -> list[str]:
    action = await understood(say)
    return [str(step) for step in read_steps(action.queue, CATALOGUES["thesis"])]


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("Stop at the hut on your way to quay 2.", "Stop at the hut, then go to quay 2."),
        ("On the way to quay 2, check the winch", "check the winch, then go to quay 2"),
        ("Swing by the hut en route to the winch. Wave.", "Swing by the hut, then go to the winch. Wave."),
        ("Do not stop on your way to quay 2", "Do not stop on your way to quay 2"),
        ("I am on my way to the hut", "I am on my way to the hut"),
        ("If you see Tom on your way to the hut, wave", "If you see Tom on your way to the hut, wave"),
    ],
)
def test_a_stop_on_the_way_comes_first(said: str, read: str) -> None:
    assert keys(under_way(tokens(said))) == keys(tokens(read))


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("I don't care which quay, just go to one", "go to any quay"),
        ("it does not matter which hut, paint one please", "paint any hut please"),
        ("I don't care which quay, go to one of them", "I don't care which quay, go to one of them"),
        ("I do not care, go to the winch", "I do not care, go to the winch"),
    ],
)
def test_any_of_those_will_do(said: str, read: str) -> None:
    assert keys(any_of_those(tokens(said))) == keys(tokens(read))


@pytest.mark.parametrize(
    ("say", "done"),
    [
        ("Stop by the winch on the way to the hut", ["go ['winch']", "go ['ticket hut']"]),
        ("Please stop near the winch", ["go ['winch']"]),
        ("Go everywhere except the quays", ["go ['ticket hut']", "go ['winch']", "go ['tram stop']"]),
        ("The winch has not been checked, please do so.", ["go ['winch']", "look ['winch']"]),
        ("Is there a tram stop near here?", []),
    ],
)
async def test_places_are_gone_to_in_that_order_and_nowhere_else(say: str, done: list[str]) -> None:
    assert await steps(say) == done


@pytest.mark.parametrize(
    "say",
    [
        "When the harbour master is back, go to the winch",
        "As soon as the horn has sounded, go to the winch",
        "Go to the winch once the ferry has sailed.",
    ],
)
async def test_what_waits_for_something_is_not_done_at_once(say: str) -> None:
    asked, went = await steps(say)
    assert asked.startswith("ask") and "wait until the" in asked and went == "go ['winch']"
    mover = ActionInfo.model_validate(
        {"name": "drive_to", "description": "Drive to a place.", "inputs": {"place": "string"}}
    )
    alone = await understood(say, (mover,))
    assert not alone.queue and "cannot notice" in alone.message_response


@pytest.mark.parametrize(
    "say",
    [
        "Keep off the winch.",
        "I don't want the winch oiled.",
        "Nobody may enter the ticket hut.",
    ],
)
async def test_what_is_to_be_left_alone_is_acknowledged(say: str) -> None:
    action = await understood(say)
    assert not action.queue and action.message_response.startswith("All right, I will leave the ")


async def test_what_hangs_on_none_of_several_is_asked_of_all() -> None:
    done = await steps("If none of the quays is free, go to the hut.")
    assert done[1] == "look ['whether quay 1 is free']"
    assert done[5] == "look ['whether none of the quays is free']"
    assert done[6].startswith("if ") and done[6].endswith("go ['ticket hut']")


async def test_all_robots_but_one_go_where_only_a_place_is_named() -> None:
    action = await understood("all robots except Bo to the winch")
    assert list(action.targets) == ["Ada", "Cy"]
    assert action.queue
