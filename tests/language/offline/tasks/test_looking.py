"""Where is looked: words that only occur in a name, or may mean a part of anything, are no other place."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

OBJECTS = (
    *(MapObject(f"hut_{n}", f"hut {n}", 4.0 * n, 2.0, "hut") for n in range(1, 5)),
    MapObject("boat_hut", "boat hut", 2.0, 12.0, "boat hut"),
    MapObject("kiln", "kiln", 6.0, 9.0, "kiln"),
    MapObject("gate", "garden entrance", 9.0, 9.0, "door"),
    MapObject("bin", "litter bin", 1.0, 9.0, "bin"),
    MapObject("seat", "seat under the lamp", 3.0, 9.0, "seat"),
    MapObject("bus", "bus stop", 9.0, 1.0, "stop"),
    MapObject("lift_a", "lift A", 12.0, 1.0, "lift"),
    MapObject("lift_b", "lift B", 14.0, 1.0, "lift"),
    MapObject("dock", "charging dock", 0.0, 1.0, "dock"),
    MapObject("bay_1", "tool bay 1", 0.0, 4.0, "bay"),
    MapObject("bay_2", "tool bay 2", 0.0, 6.0, "bay"),
)
CATALOGUE = (
    ActionInfo(name="drive_to", inputs={"place": "string"}),
    ActionInfo(name="look_at", inputs={"what": "string"}),
)


def answer(say: str, *, queue: tuple[str, ...] = (), history: tuple[str, ...] = ()) -> ChatAction:
    turns = tuple(Turn("operator" if i % 2 == 0 else "assistant", text) for i, text in enumerate(history))
    pending = tuple(
        ActionCall.model_validate(
            {"drive_to": {"input_parameters": {"place": {"pvf_type": "string", "pvf_value": p}}}}
        )
        for p in queue
    )
    situation = Situation(
        message=say, objects=OBJECTS, robot="Fern", robots=("Fern",), catalogue=CATALOGUE, history=turns,
        queue=pending, status="running" if pending else "idle",
    )  # fmt: skip
    return OfflineLanguage().explain(situation)[0]


def places(action: ChatAction) -> list[str]:
    steps = [step for step in action.queue if step.name == "drive_to"]
    return [str(next(iter(step.input_parameters.values())).value) for step in steps]


@pytest.mark.parametrize(
    ("say", "wanted"),
    [
        ("Look at the kiln and see if the door is closed.", ["kiln"]),
        ("Go to the garden entrance and see if the door is closed.", ["garden entrance"]),
        ("Go to hut 1 and check for litter.", ["hut 1"]),
        ("Go to hut 1 and then to the litter bin.", ["hut 1", "litter bin"]),
        ("See if the lamps are lit in huts 1 to 3.", ["hut 1", "hut 2", "hut 3"]),
        ("Check all four huts.", ["hut 1", "hut 2", "hut 3", "hut 4"]),
        ("Check all five huts.", ["hut 1", "hut 2", "hut 3", "hut 4", "boat hut"]),
        ("I wonder whether there is any space left in the kiln.", ["kiln"]),
        ("One last thing before I go home. Check hut 2.", ["hut 2"]),
        ("Check hut 2 before I leave, please.", ["hut 2"]),
        ("Check hut 2 before you go to the kiln.", ["hut 2", "kiln"]),
        ("Is there a stop button in lift A?", ["lift A"]),
        ("If the kiln is hot, go to hut 1, otherwise go to lift a.", ["kiln", "hut 1", "lift A"]),
    ],
)
def test_only_what_is_meant_is_gone_to(say: str, wanted: list[str]) -> None:
    assert places(answer(say)) == wanted


def test_the_rest_is_of_the_kind_that_was_spoken_of() -> None:
    history = ("Check huts 1 and 2.", "Huts 1 and 2 are dry.")
    assert places(answer("Now do the rest of the huts.", history=history)) == ["hut 3", "hut 4"]


@pytest.mark.parametrize("say", ["Cancel the last stop.", "Leave out the third stop."])
def test_a_stop_of_the_plan_is_no_stop_of_the_map(say: str) -> None:
    action = answer(say, queue=("hut 1", "kiln", "hut 3"))
    assert not action.queue
    assert [command.command for command in action.system_cmd] == ["pop"]


@pytest.mark.parametrize(
    "say",
    [
        "Check hut 2 before you do the rest.",
        "Before you carry on with the others, check hut 2.",
        "Something more urgent: check hut 2.",
    ],
)
def test_before_the_rest_is_before_what_is_pending(say: str) -> None:
    action = answer(say, queue=("hut 1", "kiln"))
    assert places(action) == ["hut 2", "hut 1", "kiln"]


@pytest.mark.parametrize(
    ("say", "where"),
    [
        ("look for rags at the kiln and at the bus stop", ["kiln", "bus stop"]),
        ("search for rags in hut 1, hut 3 and the boat hut", ["hut 1", "hut 3", "boat hut"]),
        ("look for rags and pegs at the kiln", ["kiln"]),
        ("look for rags at the kiln and then go to the bus stop", ["kiln", "bus stop"]),
    ],
)
def test_what_is_sought_in_several_places_is_sought_in_each(say: str, where: list[str]) -> None:
    action = answer(say)
    assert places(action) == where
    looks = [step for step in action.queue if step.name == "look_at"]
    assert len(looks) == (1 if "go" in say or "pegs" in say else len(where))
