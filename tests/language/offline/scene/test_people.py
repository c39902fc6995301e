"""People are found before anything is done with them; parts of groups; names of actions."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.interpreter import interpret
from parley.language.offline.scene.people import read_somebody
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.catalogue import roles_of
from parley.language.offline.words.text import plain, tokens
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

NAMES = (
    "reading room", "cafe", "gallery", "piano", "round table", "kettle", "office", "blue locker",
    "red locker", "green locker", "grey locker",
)  # fmt: skip
LIBRARY = tuple(
    MapObject(name.replace(" ", "_"), name, float(i), float(i % 3), name.split()[-1])
    for i, name in enumerate(NAMES)
)
PRIMITIVES = tuple(
    ActionInfo(name=name, inputs=dict.fromkeys(inputs.split(), "string"))
    for name, inputs in (
        ("drive_to", "room"),
        ("find_thing", "object"),
        ("find_human", "person"),
        ("follow", "person"),
        ("grasp", "object"),
        ("hand_over", "object person"),
        ("say", "text"),
        ("answer", "question"),
    )
)


def asked(message: str) -> Situation:
    return Situation(message=message, objects=LIBRARY, catalogue=PRIMITIVES, robot="Pip", robots=("Pip",))


def plan(message: str) -> list[str]:
    queue = interpret(asked(message)).queue
    return [
        f"{step.name}({', '.join(str(p.value) for p in step.input_parameters.values())})" for step in queue
    ]


@pytest.mark.parametrize(
    ("message", "steps"),
    [
        (
            "greet the man in the red coat in the office",
            ["drive_to(office)", "find_human(man in the red coat)", "say(hello)"],
        ),
        (
            "tell the time to the lady waving in the cafe",
            ["drive_to(cafe)", "find_human(lady waving)", "say(the time)"],
        ),
        (
            "tell the person pointing left in the gallery what day it is",
            ["drive_to(gallery)", "find_human(person pointing left)", "say(what day it is)"],
        ),
        (
            "answer the question of the girl raising her hand in the cafe",
            ["drive_to(cafe)", "find_human(girl raising her hand)", "answer(question)"],
        ),
        ("follow Ben from the kettle to the office", ["drive_to(kettle)", "find_human(Ben)", "follow(Ben)"]),
        (
            "meet Lea at the piano, then look for her in the cafe",
            ["drive_to(piano)", "find_human(Lea)", "drive_to(cafe)", "find_human(Lea)"],
        ),
        (
            "guide the guest with the blue hat from the piano to the cafe",
            ["drive_to(piano)", "find_human(guest with the blue hat)", "drive_to(cafe)"],
        ),
        ("how many people in the office are standing", ["drive_to(office)", "find_human(people standing)"]),
        (
            "tell me what the heaviest thing on the round table is",
            ["drive_to(round table)", "find_thing(heaviest thing)", "say(the heaviest thing)"],
        ),
        (
            "tell the name of the person at the piano to the man at the kettle",
            [
                "drive_to(piano)",
                "find_human(person)",
                "drive_to(kettle)",
                "find_human(man)",
                "say(the name of the person at the piano)",
            ],
        ),
    ],
)
def test_people_are_found_before_anything_is_done_with_them(message: str, steps: list[str]) -> None:
    assert plan(message) == steps


def test_somebody_at_a_place_nobody_knows_is_not_looked_for_elsewhere() -> None:
    scene = Scene.of(asked(""))
    assert read_somebody(tokens("the man in the garage"), scene) is None


def test_clothes_belong_to_a_person_and_what_the_map_knows_is_where_they_are() -> None:
    found = read_somebody(
        tokens("the old woman in a green scarf at the piano that we close"), Scene.of(asked(""))
    )
    assert found is not None
    assert (plain(found.who), plain(found.where)) == ("old woman in a green scarf", "piano")


@pytest.mark.parametrize(
    ("message", "where"),
    [
        ("go to any two lockers", ["blue locker", "red locker"]),
        ("go to at least three lockers", ["blue locker", "red locker", "green locker"]),
        ("go to every other locker", ["blue locker", "green locker"]),
        ("apart from the red locker, visit all lockers", ["blue locker", "green locker", "grey locker"]),
    ],
)
def test_a_number_of_equals_is_taken_from_the_group(message: str, where: list[str]) -> None:
    assert plan(message) == [f"drive_to({name})" for name in where]


@pytest.mark.parametrize(
    ("name", "parameter", "role"),
    [
        ("BaseMove", "destination", "motion"),
        ("person_search", "query", "search"),
        ("shadow_person", "person", "follow"),
        ("tts", "utterance", "speak"),
        ("respond_to", "question", "answer"),
        ("LocateObject", "object", "search"),
    ],
)
def test_any_word_of_a_name_tells_what_an_action_is_good_for(name: str, parameter: str, role: str) -> None:
    assert roles_of(ActionInfo(name=name, inputs={parameter: "string"})) == {role}


@pytest.mark.parametrize("name", ["OpenTrackCover", "ScanBarcode", "SavePathTrack"])
def test_a_name_about_something_else_is_its_own_kind(name: str) -> None:
    assert "follow" not in roles_of(ActionInfo(name=name, inputs={"object": "string"}))
    assert "search" not in roles_of(ActionInfo(name=name, inputs={"object": "string"}))


def test_trouble_at_a_place_is_looked_at_there() -> None:
    looking = ActionInfo(name="Inspect", inputs={"inspect": "string"}, description="Look at something.")
    situation = Situation(
        message="a shopping trolley is blocking the piano",
        objects=LIBRARY,
        catalogue=(*PRIMITIVES[:1], looking),
    )
    assert [step.name for step in interpret(situation).queue] == ["drive_to", "Inspect"]
