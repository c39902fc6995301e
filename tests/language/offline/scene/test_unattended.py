"""Who waits, what lies about, who does not answer and what others complain of: somebody should see to it."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.language.offline.scene.incidents import happened
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="hut_2", description="hut 2", x_m=1.0, y_m=1.0, class_name="hut"),
    MapObject(id="pier", description="fishing pier", x_m=4.0, y_m=1.0, class_name="pier"),
    MapObject(id="wash", description="boys' washroom", x_m=4.0, y_m=9.0, class_name="room"),
)
MEMORY = (MemoryEntry(name="ranger_location", data="The ranger is on the fishing pier", source="operator"),)


def situation(said: str) -> Situation:
    return Situation(
        said, objects=MAP, memory=MEMORY, catalogue=CATALOGUES["thesis"], robot="Moss", robots=("Moss",)
    )


def order_of(said: str) -> str:
    found = happened(tokens(said), Scene.of(situation(said)))
    return "" if found is None else plain(found)


def answer(said: str) -> ChatAction:
    return OfflineLanguage().explain(situation(said))[0]


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("there is an angler waiting at hut 2", "inspect the hut 2 for angler"),
        ("there is a visitor waiting at hut 2", "inspect the hut 2 for visitor"),
        ("there are two people waiting on the fishing pier", "inspect the fishing pier for two people"),
        ("a kayak is lying across the fishing pier", "inspect the fishing pier for kayak"),
        ("there is a tent bag standing all alone at hut 2", "inspect the hut 2 for tent bag"),
        ("a lantern has been left in the middle of the fishing pier", "inspect the fishing pier for lantern"),
        ("there is a long queue at hut 2", "inspect the hut 2 for long queue"),
        ("the ranger is not picking up", "check the ranger"),
        ("nobody answers the phone in hut 2", "inspect the hut 2"),
        ("a hiker just told me the boys' washroom is blocked", "inspect the boys' washroom"),
        ("the family in hut 2 says that the stove is smoking", "inspect the hut 2"),
        ("the lamp in hut 2 has gone off", "inspect the hut 2 for lamp"),
    ],
)
def test_what_should_be_seen_to_is_an_order_to_have_a_look(said: str, order: str) -> None:
    assert order_of(said) == order


@pytest.mark.parametrize(
    "said",
    [
        "the visitors always wait at hut 2",
        "there is a mat on the floor in hut 2",
        "there is a kettle in hut 2",
        "there is a parcel waiting for Ida at hut 2",
        "there is a waiting area behind hut 2",
        "the family in hut 2 says that they come from Oslo",
        "the ranger never answers before noon",
        "there is no visitor waiting at hut 2",
        "Ranger Bo has gone off to hut 2",
    ],
)
def test_what_is_so_is_no_report(said: str) -> None:
    assert order_of(said) == ""


def test_how_somebody_looks_beside_a_report_is_nothing_to_keep() -> None:
    found = answer("A man is lying on the floor in hut 2, he looks pale.")
    assert found.queue
    assert not found.system_cmd


def test_what_several_people_say_is_no_order_to_say_it() -> None:
    found = answer("The guests in hut 2 say it is dripping from the roof.")
    assert [step.name for step in found.queue][-1] == "Inspect"


def test_what_is_told_in_the_same_message_says_where_to_go() -> None:
    found = answer("The ranger moved to hut 2 yesterday. Have a look at the washroom. Then go to the ranger.")
    said = [str(p.value) for step in found.queue for p in step.input_parameters.values() if p.has_data]
    assert said[-1] == "hut 2"
    assert [command.arguments["data"] for command in found.system_cmd] == [
        "The ranger moved to hut 2 yesterday"
    ]


def test_what_is_to_be_remembered_is_kept_beside_any_orders() -> None:
    found = answer(
        "A coach comes at two. Check hut 2 before that. And remember that the driver is called Nils."
    )
    assert [command.arguments["data"] for command in found.system_cmd] == ["The driver is called Nils"]


@pytest.mark.parametrize(
    "said",
    [
        "Nobody has looked into hut 2 since Monday. Please do that now.",
        "hut 2 has not been checked yet, could you do that",
    ],
)
def test_what_was_left_undone_and_is_asked_for_is_done(said: str) -> None:
    assert [step.name for step in answer(said).queue][-1] == "Inspect"


@pytest.mark.parametrize(
    "said",
    [
        "haha you are a funny machine",
        "bit chilly out here, isn't it",
        "wow you are quick",
        "my boss worries me",
    ],
)
def test_talk_is_neither_kept_nor_misunderstood(said: str) -> None:
    found = answer(said)
    assert not found.system_cmd
    assert "not sure what you mean" not in found.message_response


@pytest.mark.parametrize(
    "said",
    [
        "Hut 2 is closed before nine.",
        "There are three rules here: no fires, no radio after ten and no cars on the grass.",
    ],
)
def test_a_time_of_day_is_no_stop_and_is_kept_with_what_is_told(said: str) -> None:
    found = answer(said)
    assert not found.queue
    assert [command.arguments["data"] for command in found.system_cmd] == [said.removesuffix(".")]
