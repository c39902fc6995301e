"""What the engine says about how it came to an answer."""

from __future__ import annotations

import json

from typer.testing import CliRunner

from parley.cli import command_line
from parley.language.offline import OfflineLanguage
from parley.language.situations import read_situation
from tests.language.dev_set import CATALOGUES

SITUATION = {
    "id": 7,
    "message": "Kim could use the ladder",
    "memory": [
        {"name": "kim_location", "type": "text", "data": "Kim is in the attic", "info": ""},
        {"name": "ladder_location", "type": "text", "data": "The ladder is in the shed", "info": ""},
    ],
    "objects": [
        {"id": "attic", "description": "attic", "x": 1, "y": 1},
        {"id": "shed", "description": "shed", "x": 5, "y": 1},
    ],
}


def explained(message: str) -> list[tuple[str, str]]:
    situation = read_situation(SITUATION | {"message": message}, CATALOGUES["thesis"])
    _, decisions = OfflineLanguage().explain(situation)  # type: ignore[arg-type]
    return [(decision.about, decision.text) for decision in decisions]


def test_clauses_frames_actions_and_arguments_are_told_in_order() -> None:
    told = explained("go to the shed, then inspect the attic")
    assert [text for about, text in told if about == "clause"] == ["“go to the shed”", "“inspect the attic”"]
    kinds = [about for about, _ in told]
    assert kinds.index("clause") < kinds.index("frame") < kinds.index("argument") < kinds.index("action")
    assert any(about == "action" and "GetCoordinates, NavigateTo" in text for about, text in told)


def test_an_argument_that_a_memory_gave_names_the_memory() -> None:
    told = explained("go to the ladder")
    assert any(
        about == "argument" and "shed on the map, from the memory ladder" in text for about, text in told
    )


def test_a_wish_is_told_with_the_order_it_means() -> None:
    told = explained("Kim could use the ladder")
    assert any(about == "recast" and "bring the ladder to Kim" in text for about, text in told)


def test_stop_is_told_to_be_a_control() -> None:
    assert explained("please stop") == [("control", "the whole message means “stop”, so the command is stop")]


def test_what_has_to_be_asked_is_told() -> None:
    told = explained("go to the pump")
    assert told[-1][0] == "question"
    assert "pump" in told[-1][1]


def test_interpret_adds_explanations_on_demand_only() -> None:
    line = json.dumps(SITUATION) + "\n"
    told = CliRunner().invoke(
        command_line("interpret"), ["interpret", "--situations", "-", "--explain"], input=line
    )
    quiet = CliRunner().invoke(command_line("interpret"), ["interpret", "--situations", "-"], input=line)
    assert told.exit_code == quiet.exit_code == 0
    answer, plain = json.loads(told.stdout), json.loads(quiet.stdout)
    assert {part["about"] for part in answer["explanation"]} >= {"clause", "frame", "action"}
    assert "explanation" not in plain
    assert plain["output"] == answer["output"]
