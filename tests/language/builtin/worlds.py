"""A small world that the tests of the built-in engine share: things, people, and two catalogues."""

from __future__ import annotations

from parley.language.base import Situation
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject


def thing(name: str, number: int) -> MapObject:
    return MapObject(f"{name.replace(' ', '_')}_{number}", name, float(number), 1.0)


NAMES = ("red box", "blue crate", "desk", "front gate", "lamp", "office", "yard", "pump", "ramp", "printer")
THINGS = tuple(thing(name, number) for number, name in enumerate(NAMES))


def action(name: str, description: str, *inputs: str, optional: tuple[str, ...] = ()) -> ActionInfo:
    return ActionInfo(
        name=name, description=description, inputs=dict.fromkeys(inputs, "string"), optional=optional
    )


CATALOGUE = (
    action("drive_to", "Drive to a room, an object or a person.", "place"),
    action("shift", "Move forward, back or sideways by a distance.", "direction", "distance"),
    action("rotate", "Turn left or right on the spot by an angle.", "direction", "angle"),
    action("grab", "Pick up an object with the arm.", "item", "source", optional=("source",)),
    action("lay", "Put the held object down on a surface.", "item", "place", optional=("place",)),
    action("carry", "Fetch an object and deliver it to a person or a place.", "item", "to", optional=("to",)),
    action("on", "Switch a device on.", "device"),
    action("off", "Switch a device off.", "device"),
    action("open_it", "Open a door, a drawer or a window.", "what"),
    action("close_it", "Close a door, a drawer or a window.", "what"),
    action("search", "Search for an object or a person.", "what"),
    action("look", "Look at something and report its state.", "what"),
    action("go_along", "Follow a person.", "who"),
    action("snap", "Take a photo and send it."),
)

SENTENCES = tuple(
    """go to the office; drive to the front gate; bring the red box to the office; pick up the blue crate;
put the red box on the desk; turn on the lamp; switch off the pump; open the front gate; close the front gate;
look for the red box; take a picture; turn left by ninety degrees; move forward two metres; follow me;
take the red box and put it on the desk; go to the yard and open the front gate; inspect the pump;
fetch the blue crate from the yard""".replace("\n", " ").split("; ")
)


def situation(message: str, **more: object) -> Situation:
    values: dict[str, object] = {
        "objects": THINGS,
        "catalogue": CATALOGUE,
        "robot": "Ada",
        "robots": ("Ada",),
    }
    return Situation(message, **(values | more))  # type: ignore[arg-type]
