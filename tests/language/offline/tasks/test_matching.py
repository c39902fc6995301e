"""Which action of a catalogue nobody has seen is meant, and with what values."""

from collections.abc import Sequence
from typing import Any

import pytest

from parley.language.base import Situation
from parley.language.offline.interpreter import interpret
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

PLANTS = (
    MapObject("row_a", "tomato row", 0.0, 4.0, "row"),
    MapObject("row_b", "pepper row", 3.0, 4.0, "row"),
    MapObject("door", "main door", 9.0, 9.0, "door"),
    MapObject("window", "window", 9.0, 4.0, "window"),
)


def steps(
    say: str, *infos: ActionInfo, objects: Sequence[MapObject] = PLANTS
) -> list[tuple[str, dict[str, Any]]]:
    action = interpret(
        Situation(message=say, catalogue=infos, objects=tuple(objects), robot="Fern", robots=("Fern",))
    )
    return [
        (call.name, {n: p.value for n, p in call.input_parameters.items() if p.has_data})
        for call in action.queue
    ]


WATER = ActionInfo(name="waterPlants", inputs={"row": "string", "litres": "number"})
VENTS = ActionInfo(name="openVents")
CLOSE = ActionInfo(name="closeVents")
SIREN = (ActionInfo(name="siren_on"), ActionInfo(name="siren_off"))
MOVE = ActionInfo(name="driveXY", inputs={"x": "float", "y": "float"})
LANGUAGE = ActionInfo(name="setLang", inputs={"lang": "string"})
DOOR = ActionInfo(name="openDoor", inputs={"door": "string"})
RECORD = (ActionInfo(name="startRecording"), ActionInfo(name="stopRecording"))
DETECT = ActionInfo(name="detect_object", inputs={"label": "string"}, outputs={"object_id": "string"})
LID = ActionInfo(name="lid", inputs={"open": "bool"}, description="Open or close the lid.")
FLEET = (
    ActionInfo(name="wh_fly", inputs={"height_m": "number"}),
    ActionInfo(name="wh_scan", inputs={"row": "string", "mode": "plain|infrared"}),
    ActionInfo(name="wh_blink"),
)
BELT = ActionInfo(name="setBeltSpeed", inputs={"mps": "number"})
BELL = ActionInfo(name="ringBell", inputs={"times": "number"})
SNAILS = ActionInfo(name="countSnails", inputs={"row": "string"}, outputs={"snails": "number"})
SOIL = ActionInfo(name="testSoil", inputs={"row": "string"}, outputs={"ph": "number"})
SHADE = ActionInfo(name="setShade", inputs={"row": "number", "pct": "number"}, description="Shade a row.")
SIGN = ActionInfo(name="showSign", inputs={"text": "string"}, description="Put up a sign.")
FEED = ActionInfo(name="feedGuest", inputs={"guest": "string", "food": "string"})
CALL = ActionInfo(
    name="ringService", inputs={"urgent": "bool"}, optional=("urgent",), description="Ring the service bell."
)
DUST = ActionInfo(name="dust", inputs={"powder": "string", "row": "string"})
VISITOR = ActionInfo(name="ask_visitor", inputs={"question": "string"}, outputs={"reply": "string"})
SNAILS_ON_BOTH = [("countSnails", {"row": row}) for row in ("tomato row", "pepper row")]
SOIL_OF_BOTH = [("testSoil", {"row": row}) for row in ("tomato row", "pepper row")]
SCAN = ActionInfo(name="scan_qr", inputs={"object_id": "string"}, outputs={"code": "string"})


@pytest.mark.parametrize(
    ("say", "infos", "right"),
    [
        ("turn the siren off", SIREN, [("siren_off", {})]),
        ("sound the alarm", SIREN, [("siren_on", {})]),
        ("give the tomato row 40 litres", (WATER,), [("waterPlants", {"row": "tomato row", "litres": 40.0})]),
        ("the pepper row needs 5 litres", (WATER,), [("waterPlants", {"row": "pepper row", "litres": 5.0})]),
        ("shut the vents", (VENTS, CLOSE), [("closeVents", {})]),
        ("drive to (4.5, -2)", (MOVE,), [("driveXY", {"x": 4.5, "y": -2.0})]),
        ("go over to the tomato row", (MOVE,), [("driveXY", {"x": 0.0, "y": 4.0})]),
        ("switch to French", (LANGUAGE,), [("setLang", {"lang": "French"})]),
        ("open the main door", (DOOR,), [("openDoor", {"door": "main door"})]),
        ("stop recording", RECORD, [("stopRecording", {})]),
        ("shut the lid", (LID,), [("lid", {"open": False})]),
        ("scan the tomato row in infrared", FLEET, [("wh_scan", {"row": "tomato row", "mode": "infrared"})]),
        ("set the belt speed to 1.5 metres per second", (BELT,), [("setBeltSpeed", {"mps": 1.5})]),
        ("ring the bell twice", (BELL,), [("ringBell", {"times": 2.0})]),
        ("count the snails on every row", (SNAILS,), SNAILS_ON_BOTH),
        ("test the soil in the tomato row and in the pepper row", (SOIL,), SOIL_OF_BOTH),
        ("shade row 5 by eighty per cent", (SHADE,), [("setShade", {"row": 5.0, "pct": 80.0})]),
        ("shade row 5 halfway", (SHADE,), [("setShade", {"row": 5.0, "pct": 50.0})]),
        ('put up the sign "do not stop here"', (SIGN,), [("showSign", {"text": "do not stop here"})]),
        ("feed Mr Ito an apple", (FEED,), [("feedGuest", {"guest": "Mr Ito", "food": "apple"})]),
        ("ring the bell, it is urgent", (CALL,), [("ringService", {"urgent": True})]),
        ("dust the pepper row with sulphur", (DUST,), [("dust", {"powder": "sulphur", "row": "pepper row"})]),
        ("ask the visitor how she is", (VISITOR,), [("ask_visitor", {"question": "how she is"})]),
    ],
)
def test_an_action_is_found_by_what_its_name_and_inputs_say(
    say: str, infos: tuple[ActionInfo, ...], right: list[tuple[str, dict[str, Any]]]
) -> None:
    assert steps(say, *infos) == right


def test_what_only_programs_know_is_fetched_first() -> None:
    assert steps("scan the code on the blue crate", DETECT, SCAN) == [
        ("detect_object", {"label": "blue crate"}),
        ("scan_qr", {}),
    ]


@pytest.mark.parametrize(
    ("say", "info"), [("open the window", DOOR), ("open the main door", VENTS), ("play football", VENTS)]
)
def test_an_action_is_not_used_on_what_is_not_its_business(say: str, info: ActionInfo) -> None:
    assert steps(say, info) == []


def test_a_number_that_is_needed_and_not_said_is_asked_for() -> None:
    action = interpret(Situation(message="water the pepper row", catalogue=(WATER,), objects=PLANTS))

    assert not action.queue
    assert "litres" in action.message_response


def test_standing_still_is_no_action_of_its_own() -> None:
    action = interpret(Situation(message="stop", catalogue=RECORD, objects=PLANTS))

    assert [command.command for command in action.system_cmd] == ["stop"]


def test_an_action_that_tells_something_is_used_to_look_whether_it_is_so() -> None:
    dry = ActionInfo(name="is_dry", inputs={"row": "string"}, outputs={"dry": "boolean"})
    action = interpret(
        Situation(
            message="If the tomato row is dry, open the vents.",
            catalogue=(dry, VENTS),
            objects=PLANTS,
            robot="Fern",
            robots=("Fern",),
        )
    )
    assert [call.name for call in action.queue] == ["is_dry", "openVents"]
    flow = action.queue[1].flow
    assert flow is not None and flow.if_ is not None and flow.if_.result


def test_what_an_own_action_has_just_looked_at_tells_whether_it_is_so() -> None:
    view = ActionInfo(name="view_leaf", inputs={"row": "string"}, outputs={"seen": "string"})
    heat = ActionInfo(name="checkHeat", inputs={"row": "string"}, outputs={"warm": "boolean"})
    message = "View the leaves of the tomato row; if they are yellow, open the vents."
    action = interpret(
        Situation(message=message, catalogue=(view, heat, VENTS), objects=PLANTS, robot="F", robots=("F",))
    )

    assert [call.name for call in action.queue] == ["view_leaf", "openVents"]


def test_what_is_on_board_is_not_taken_once_more_to_go_somewhere() -> None:
    load = ActionInfo(name="loadCrate", inputs={"crate": "string"}, description="Take a crate on board.")
    drive = ActionInfo(name="drive_to", inputs={"place": "string"})

    assert steps("Load the blue crate and take it to the main door.", load, drive) == [
        ("loadCrate", {"crate": "blue crate"}),
        ("drive_to", {"place": "main door"}),
    ]


def test_it_is_what_was_told_of_before() -> None:
    assert steps("The peppers look rather dry to me, can you test it?", SOIL) == [
        ("testSoil", {"row": "pepper row"})
    ]


FIELDS = (
    MapObject("north", "north field", 0.0, 9.0, "field"),
    MapObject("south", "south field", 9.0, 9.0, "field"),
    MapObject("orchard", "orchard", 9.0, 0.0, "field"),
)
MOWING = ActionInfo(name="start_mowing", inputs={"field": "string"})
STOVE = ActionInfo(name="set_burner", inputs={"level": "string"}, description="level: off|low|medium|high")
LAMP = ActionInfo(
    name="adjust_lamp",
    inputs={"direction": "string", "degrees": "number"},
    description="direction: up, down, left or right",
)


@pytest.mark.parametrize(
    "say", ["mow the orchard", "cut the grass in the orchard", "start mowing the orchard"]
)
def test_what_a_name_says_begins_is_asked_for_by_the_deed_alone(say: str) -> None:
    assert steps(say, MOWING, objects=FIELDS) == [("start_mowing", {"field": "orchard"})]


def test_everything_is_all_of_the_kind_that_an_input_takes() -> None:
    done = steps("mow everything except the orchard", MOWING, objects=FIELDS)
    assert [values["field"] for _, values in done] == ["north field", "south field"]


@pytest.mark.parametrize(
    ("say", "level"), [("turn the burner down to low", "low"), ("burner at full power", "high")]
)
def test_one_of_a_few_values_is_said_in_other_words(say: str, level: str) -> None:
    assert steps(say, STOVE, objects=()) == [("set_burner", {"level": level})]


def test_a_deed_says_where_something_is_to_go() -> None:
    down = steps("lower the lamp by 15 degrees", LAMP, objects=())
    assert down == [("adjust_lamp", {"direction": "down", "degrees": 15.0})]


def test_what_is_to_be_told_is_not_looked_at_for_other_inputs() -> None:
    page = ActionInfo(name="page_doctor", inputs={"doctor": "string", "reason": "string"})
    beds = (MapObject("bed", "bed 1", 0.0, 0.0, "bed"),)
    told = steps("tell Doctor Brandt that the patient in bed 1 is in pain", page, objects=beds)
    assert told == [("page_doctor", {"doctor": "Doctor Brandt", "reason": "the patient in bed 1 is in pain"})]


def test_an_action_that_ends_something_is_not_meant_by_the_deed_alone() -> None:
    stop = ActionInfo(name="stop_mowing")
    assert steps("mow the orchard", stop, objects=FIELDS) == []


def test_nothing_is_no_value() -> None:
    spray = ActionInfo(name="spray_row", inputs={"row": "string"})
    assert steps("nothing needs spraying", spray) == []
