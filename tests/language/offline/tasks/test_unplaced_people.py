"""People of whom nobody knows where they are, people by their trades, and things by what holds them."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

FARM = tuple(
    MapObject(id=name.replace(" ", "_"), description=name, class_name=name.split()[0], x_m=float(i), y_m=2.0)
    for i, name in enumerate(["smokehouse", "cellar", "vat 1", "vat 2", "inlet", "hatch 1"])
)
HANDS = tuple(
    ActionInfo(name=name, inputs=dict.fromkeys(inputs.split(), "string"))
    for name, inputs in (
        ("move_to", "location"),
        ("look_for_obj", "object"),
        ("look_for_person", "person"),
        ("grasp", "object"),
        ("pass_to", "object person"),
        ("follow", "person"),
        ("answer", "question"),
    )
)
OWN = tuple(
    ActionInfo(name=name, inputs={kind: "string"})
    for name, kind in (("go_to", "place"), ("stir", "vat"), ("openHatch", "hatch"), ("closeHatch", "hatch"))
)


async def plan(say: str, infos: tuple[ActionInfo, ...], *told: str, before: str = "") -> list[str]:
    memory = tuple(MemoryEntry(name=f"m{i}", data=text) for i, text in enumerate(told))
    turns = (Turn("operator", before),) if before else ()
    situation = Situation(message=say, history=turns, memory=memory, objects=FARM, catalogue=infos)
    answer = await OfflineLanguage().interpret(situation)
    return [
        " ".join([step.name, *(str(value.value) for value in step.input_parameters.values())])
        for step in answer.queue
    ]


async def test_a_recipient_whom_nobody_knows_is_looked_for() -> None:
    assert await plan("Take the ham from the smokehouse and give it to Runa", HANDS) == [
        "move_to smokehouse", "look_for_obj ham", "grasp ham", "look_for_person Runa", "pass_to ham Runa",
    ]  # fmt: skip


async def test_what_was_looked_for_before_is_fetched_from_there() -> None:
    steps = await plan("and bring it to Grandpa", HANDS, before="Find the ladle in the cellar.")
    assert steps[:2] == ["move_to cellar", "look_for_obj ladle"]
    assert steps[-1] == "pass_to ladle Grandpa"


@pytest.mark.parametrize(
    ("say", "steps"),
    [
        (
            "Find the sausagemaker in the cellar and follow him",
            ["move_to cellar", "look_for_person sausagemaker", "follow sausagemaker"],
        ),
        ("Find the brewer in the cellar", ["move_to cellar", "look_for_person brewer"]),
        ("Find the skewer in the cellar", ["move_to cellar", "look_for_obj skewer"]),
        ("follow the woman in the blue apron", ["follow woman in the blue apron"]),
        ("Runa has fainted in the cellar", ["move_to cellar", "look_for_person Runa"]),
    ],
)
async def test_nouns_for_people_are_people(say: str, steps: list[str]) -> None:
    assert await plan(say, HANDS) == steps


@pytest.mark.parametrize(
    ("say", "steps"),
    [
        ("Stir the plum wine", ["stir vat 2"]),
        (
            "open hatch 1, stir vat 1 and close it again",
            ["openHatch hatch 1", "stir vat 1", "closeHatch hatch 1"],
        ),
    ],
)
async def test_what_is_in_a_thing_and_it_stand_for_the_thing(say: str, steps: list[str]) -> None:
    assert await plan(say, OWN, "The plum wine is in vat 2") == steps
