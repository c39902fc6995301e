"""What is done under conditions, with and without people, and what is only told."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

THINGS = ("hall", "yard", "cart", "north gate")
CATALOGUE = (
    ActionInfo(name="drive_to", inputs={"place": "string"}, description="Drive to a place."),
    ActionInfo(name="check", inputs={"thing": "string"}, outputs={"found": "boolean"}, effects=("looks",)),
    ActionInfo(name="tell", inputs={"person": "string", "message": "string"}, description="Give a message."),
    ActionInfo(name="open_gate", inputs={"gate": "string"}),
)


def steps(message: str) -> list[tuple[object, ...]]:
    objects = tuple(MapObject(name, name, x_m=float(x), y_m=0.0) for x, name in enumerate(THINGS))
    situation = Situation(message=message, catalogue=CATALOGUE, robot="Bo", robots=("Bo",))
    action = asyncio.run(OfflineLanguage().interpret(replace(situation, objects=objects)))
    return [(step.name, *(p.value for p in step.input_parameters.values())) for step in action.queue]


def test_whether_one_thing_is_on_another_is_seen_there() -> None:
    assert steps("check if the cart is in the hall")[0] == ("drive_to", "hall")


def test_whether_something_is_there_is_seen_where_it_goes() -> None:
    assert [step[1] for step in steps("go to the yard and see if the cart is there")][:1] == ["yard"]
    assert ("drive_to", "cart") not in steps("go to the yard and see if the cart is there")


def test_somebody_is_told_what_was_found() -> None:
    found = steps("go to the hall and look for a red bag. If it is not there, tell Mr Ott.")
    assert found[-1] == ("tell", "Mr Ott", "the red bag is not there")


def test_what_is_so_already_is_not_done() -> None:
    assert steps("the north gate is open.") == []


def test_what_is_sought_is_sought_where_it_may_be_otherwise() -> None:
    found = steps("look for a red bag in the hall. If it is not there, try the yard.")
    assert found[-2:] == [("drive_to", "yard"), ("check", "red bag")]


def test_a_part_of_a_place_is_looked_at_there_and_not_at_its_like_elsewhere() -> None:
    assert steps("if the tap in the yard is dripping, go to the hall")[0] == ("drive_to", "yard")
    assert ("drive_to", "north gate") not in steps("check whether the light in the hall is on")


def test_a_greeting_is_said_where_it_is_said_to_be() -> None:
    found = steps("say welcome at the yard")
    assert found[0] == ("drive_to", "yard")
    assert found[-1][-1] == "welcome"


def test_a_deed_that_somebody_is_told_of_is_not_done() -> None:
    told = steps("tell Mr Ott that the north gate is open")
    assert told[-1] == ("tell", "Mr Ott", "the north gate is open")
    assert all(step[0] != "open_gate" for step in told)
    assert all(step[0] != "open_gate" for step in steps("let Mr Ott know that the north gate was opened"))
