"""Robots of other trades: catalogues in any style of naming, told in plain sentences."""

from collections.abc import Sequence
from typing import Any

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline.interpreter import interpret
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

BAKERY = (
    ActionInfo(name="go_to", inputs={"place": "string"}),
    ActionInfo(name="preheat_oven", inputs={"oven": "string", "degrees": "number"}),
    ActionInfo(name="knead_dough", inputs={"bowl": "string", "minutes": "number"}),
    ActionInfo(name="count_loaves", inputs={"shelf": "string"}, outputs={"count": "number"}),
    ActionInfo(
        name="measure_heat",
        inputs={"oven": "string"},
        outputs={"degrees": "number"},
        description="Measure the temperature inside an oven.",
    ),
)
OVENS = (
    MapObject("oven_1", "oven 1", -4.0, 5.0, "oven"),
    MapObject("oven_2", "oven 2", 4.0, 5.0, "oven"),
    MapObject("shelf_a", "shelf A", -4.0, 10.0, "shelf"),
    MapObject("shelf_b", "shelf B", 4.0, 10.0, "shelf"),
    MapObject("bowl_s", "steel bowl", 0.0, 4.0, "bowl"),
    MapObject("bowl_g", "glass bowl", 2.0, 2.0, "bowl"),
    MapObject("store", "flour store", -8.0, 8.0, "store"),
)
POOLS = (
    ActionInfo(name="DrivingTo", inputs={"area": "string"}, description="Driving to an area."),
    ActionInfo(name="SkimmingPool", inputs={"pool": "string"}, description="Skimming leaves off a pool."),
    ActionInfo(
        name="RefillingSoap", inputs={"dispenser": "string"}, description="Refilling a soap dispenser."
    ),
    ActionInfo(
        name="PlayingMusic",
        inputs={"area": "string", "mood": "string"},
        description="Playing music in an area. Moods: calm, lively, festive.",
    ),
)
WATERS = (
    MapObject("big", "big pool", 0.0, 10.0, "pool"),
    MapObject("kids", "children's pool", 8.0, 10.0, "pool"),
    MapObject("disp_1", "soap dispenser 1", 5.0, 2.0, "soap dispenser"),
    MapObject("disp_2", "soap dispenser 2", 7.0, 2.0, "soap dispenser"),
    MapObject("lounge", "lounge", -3.0, 3.0, "lounge"),
)
PLANT = (
    ActionInfo(name="navToPt", inputs={"loc": "string"}, description="Navigate to a point."),
    ActionInfo(name="opnVlv", inputs={"valve": "string"}, description="Open a valve."),
    ActionInfo(name="clsVlv", inputs={"valve": "string"}, description="Close a valve."),
    ActionInfo(name="rdGauge", inputs={"gauge": "string"}, outputs={"bar": "number"}),
    ActionInfo(
        name="swPump",
        inputs={"pump": "string", "state": "on|off"},
        description="Switch a pump on or off.",
    ),
    ActionInfo(
        name="smplOil", inputs={"machine": "string"}, description="Take an oil sample from a machine."
    ),
    ActionInfo(
        name="chkLeak",
        inputs={"machine": "string"},
        outputs={"leaking": "boolean"},
        description="Check a machine for leaks.",
    ),
)
MACHINES = (
    MapObject("v1", "valve V1", -5.0, 5.0, "valve"),
    MapObject("v2", "valve V2", -2.0, 5.0, "valve"),
    MapObject("gauge", "inlet gauge", 4.0, 5.0, "gauge"),
    MapObject("pump_f", "feed pump", -8.0, 2.0, "pump"),
    MapObject("pump_d", "drain pump", 8.0, 2.0, "pump"),
    MapObject("turbine", "turbine", 3.0, 8.0, "machine"),
    MapObject("compressor", "compressor", -6.0, 8.0, "machine"),
    MapObject("control", "control room", 10.0, -6.0, "room"),
)
RUNS = (MemoryEntry(name="varga", info="About Varga", data="Mr Varga operates the compressor"),)


def planned(
    say: str,
    infos: Sequence[ActionInfo],
    objects: Sequence[MapObject],
    *,
    history: Sequence[Turn] = (),
    memory: Sequence[MemoryEntry] = (),
) -> list[tuple[Any, ...]]:
    action = interpret(
        Situation(
            message=say,
            catalogue=tuple(infos),
            objects=tuple(objects),
            history=tuple(history),
            memory=tuple(memory),
            robot="Volt",
            robots=("Volt",),
            robot_pose=Pose2D(0.0, 0.0, 1.57),
        )
    )
    return [
        (
            *(() if call.flow is None or call.flow.if_ is None else (call.flow.if_.result,)),
            call.name,
            *(p.value for p in call.input_parameters.values() if p.has_data),
        )
        for call in action.queue
    ]


@pytest.mark.parametrize(
    ("say", "expected"),
    [
        (
            "If oven 2 is hotter than 200 degrees, go to the flour store, otherwise preheat it to 230.",
            [
                ("measure_heat", "oven 2"),
                (True, "go_to", "flour store"),
                (False, "preheat_oven", "oven 2", 230),
            ],
        ),
        (
            "If the temperature in oven 1 is under 150 preheat it to 180, else go to the flour store.",
            [
                ("measure_heat", "oven 1"),
                (True, "preheat_oven", "oven 1", 180),
                (False, "go_to", "flour store"),
            ],
        ),
        (
            "If there are fewer than 5 loaves on shelf A, go to the flour store.",
            [("count_loaves", "shelf A"), (True, "go_to", "flour store")],
        ),
        ("count the loaves on the shelf nearest to you", [("count_loaves", "shelf A")]),
        ("could you kneed the dough in the glas bowl for 8 minutes", [("knead_dough", "glass bowl", 8)]),
        ("preheat ovne 2 to 190 degrees", [("preheat_oven", "oven 2", 190)]),
        (
            "count the loaves on shelf A, next shelf B, and finally go to the flour store",
            [("count_loaves", "shelf A"), ("count_loaves", "shelf B"), ("go_to", "flour store")],
        ),
        (
            "The loaves should be counted on both shelves.",
            [("count_loaves", "shelf A"), ("count_loaves", "shelf B")],
        ),
    ],
)
def test_a_bakery_without_descriptions(say: str, expected: list[tuple[Any, ...]]) -> None:
    assert planned(say, BAKERY, OVENS) == expected


@pytest.mark.parametrize(
    ("say", "expected"),
    [
        ("Skim the big pool.", [("SkimmingPool", "big pool")]),
        ("skim teh big pol", [("SkimmingPool", "big pool")]),
        ("refil the soap dispensor 1", [("RefillingSoap", "soap dispenser 1")]),
        ("refill the soap in soap dispenser 1", [("RefillingSoap", "soap dispenser 1")]),
        ("play some calm music in the lounge", [("PlayingMusic", "lounge", "calm")]),
        (
            "first skim the big pool, next the children's one and finally go to the lounge",
            [("SkimmingPool", "big pool"), ("SkimmingPool", "children's pool"), ("DrivingTo", "lounge")],
        ),
    ],
)
def test_a_pool_whose_names_say_what_is_going_on(say: str, expected: list[tuple[Any, ...]]) -> None:
    assert planned(say, POOLS, WATERS) == expected


@pytest.mark.parametrize(
    ("say", "expected"),
    [
        ("go to the control room", [("navToPt", "control room")]),
        ("coud you opne valve v2", [("opnVlv", "valve V2")]),
        (
            "switch the feed pump on and the drain pump off",
            [("swPump", "feed pump", "on"), ("swPump", "drain pump", "off")],
        ),
        (
            "If the inlet gauge shows more than 6 bar, open valve V1, otherwise go to the control room.",
            [("rdGauge", "inlet gauge"), (True, "opnVlv", "valve V1"), (False, "navToPt", "control room")],
        ),
        (
            "read the inlet gauge, open valve V1 and then read it again",
            [("rdGauge", "inlet gauge"), ("opnVlv", "valve V1"), ("rdGauge", "inlet gauge")],
        ),
        ("Take an oil sample from the machine Mr Varga operates", [("smplOil", "compressor")]),
        ("is the turbine leaking?", [("chkLeak", "turbine")]),
        ("Leave valve V1 closed and open valve V2", [("opnVlv", "valve V2")]),
        ("keep the valve V2 open", []),
    ],
)
def test_a_plant_in_abbreviations(say: str, expected: list[tuple[Any, ...]]) -> None:
    assert planned(say, PLANT, MACHINES, memory=RUNS) == expected


def test_an_answer_to_what_was_asked_is_used_by_any_action() -> None:
    history = (
        Turn(role="operator", content="Knead the dough for 5 minutes."),
        Turn(role="assistant", content="Which bowl do you mean: steel bowl or glass bowl?"),
    )
    assert planned("the glass one", BAKERY, OVENS, history=history) == [("knead_dough", "glass bowl", 5)]


def test_the_same_once_more_keeps_what_else_was_said() -> None:
    history = (
        Turn(role="operator", content="Knead the dough in the steel bowl for 4 minutes."),
        Turn(role="assistant", content="Done."),
    )
    assert planned("What about the glass bowl?", BAKERY, OVENS, history=history) == [
        ("knead_dough", "glass bowl", 4)
    ]


LAB = (
    ActionInfo(name="Inspect", inputs={"inspect": "string"}, effects=("looks",)),
    ActionInfo(name="shake_sample", inputs={"sample": "string"}),
    ActionInfo(name="measure_salt", inputs={"sample": "string"}, outputs={"percent": "number"}),
    ActionInfo(name="scan_code", inputs={"item": "string"}, description="Scan the code of an item."),
)


@pytest.mark.parametrize(
    ("say", "expected"),
    [
        (
            "Measure the salt of sample 3, and if it's above 2 shake the sample",
            [("measure_salt", "sample 3"), (True, "shake_sample", "sample 3")],
        ),
        (
            "Shake sample 6, then measure its salt",
            [("shake_sample", "sample 6"), ("measure_salt", "sample 6")],
        ),
        ("scan the crate of jars", [("scan_code", "crate of jars")]),
    ],
)
def test_what_was_measured_tells_though_the_robot_can_look_too(
    say: str, expected: list[tuple[Any, ...]]
) -> None:
    assert planned(say, LAB, ()) == expected


SORTING = (
    ActionInfo(name="DriveTo", inputs={"location": "string"}),
    ActionInfo(
        name="weigh",
        inputs={"item": "string"},
        outputs={"kg": "number"},
        description="Put an item on the scales and weigh it.",
    ),
    ActionInfo(
        name="SortInto", inputs={"item": "string", "bin": "string"}, phrases=("put {item} into {bin}",)
    ),
    ActionInfo(name="count_sheep", inputs={"field": "string"}, outputs={"count": "number"}),
)
BINS = (
    MapObject("metal", "metal bin", 4.0, 10.0, "bin"),
    MapObject("glass", "glass bin", 4.0, 5.0, "bin"),
    MapObject("meadow", "lower meadow", 9.0, 9.0, "meadow"),
)


def test_a_phrase_says_more_than_a_description() -> None:
    assert planned("put the old kettle into the metal bin", SORTING, BINS) == [
        ("SortInto", "old kettle", "metal bin")
    ]


def test_any_stretch_of_land_is_a_field() -> None:
    assert planned("count the sheep in the lower meadow", SORTING, BINS)[-1] == (
        "count_sheep",
        "lower meadow",
    )


def test_each_deed_of_a_plan_is_a_stop_of_its_own() -> None:
    first, second = (
        interpret(
            Situation(message=f"Preheat oven {n} to 200 degrees.", catalogue=BAKERY, objects=OVENS)
        ).queue[0]
        for n in (1, 2)
    )
    action = interpret(
        Situation(
            message="Skip oven 2",
            catalogue=BAKERY,
            objects=OVENS,
            queue=(first, second),
            status="running",
        )
    )
    assert [(one.command, one.pop_index) for one in action.system_cmd] == [("pop", 1)]
