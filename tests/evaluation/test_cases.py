"""Sets are read strictly, and those that come with Parley are sound."""

from __future__ import annotations

from pathlib import Path

import pytest

from parley.errors import ConfigError, FileFormatError
from parley.evaluation.cases import Case, CaseSet, Expected
from parley.evaluation.gpsr import gpsr_cases
from parley.evaluation.sets import SET_NAMES, load_set
from parley.language.base import ErrorSituation, Situation
from tests.evaluation.rig import WORLD, one_case

PLAIN = {"go", "look", "ask", "locate", "driving", "back", "at"}


def test_a_misspelt_field_is_refused_with_its_place() -> None:
    with pytest.raises(FileFormatError, match="remembr"):
        one_case("{in: depot, say: hello, remembr: [[a]]}")


def test_a_world_or_catalogue_that_there_is_not_is_refused() -> None:
    with pytest.raises(FileFormatError, match="nowhere"):
        one_case("{in: nowhere, say: hello}")
    broken = WORLD.replace("catalogue: thesis", "catalogue: nothing")
    with pytest.raises(FileFormatError, match="known are"):
        CaseSet.parse(f"{broken}cases: {{}}", file="set.yaml")


def test_a_case_becomes_the_situation_that_it_says() -> None:
    situation = one_case(
        "{in: depot, say: and the door, history: [go to the red box, I go.], queue: [go box_1, look red box],"
        " status: running, robot: Ben}"
    ).situation
    assert isinstance(situation, Situation)
    assert [turn.role for turn in situation.history] == ["operator", "assistant"]
    assert [step.name for step in situation.queue] == ["GetCoordinates", "NavigateTo", "Inspect"]
    assert (situation.robot, situation.status, situation.message) == ("Ben", "running", "and the door")
    assert [item.id for item in situation.objects] == ["box_1", "box_2", "door_1"]


def test_a_world_like_another_has_what_it_does_not_say_itself() -> None:
    world = one_case("{in: store, say: hello}").world
    assert world.robots == ["Ada", "Ben"]
    assert [action.name for action in world.actions] == ["HandOver", "Wait"]


def test_a_reading_takes_the_place_of_the_fields_it_names() -> None:
    case = one_case("{in: depot, say: x, do: [go box_1], says: [red], either: [{}, {do: []}]}")
    first, second = case.expectations
    assert (first.do, first.says) == (["go box_1"], ["red"])
    assert (second.do, second.says) == ([], ["red"])


@pytest.mark.parametrize("name", SET_NAMES)
def test_every_case_of_a_set_is_a_situation_whose_steps_its_robot_has(name: str) -> None:
    cases = load_set(name)
    assert cases
    for case in cases:
        assert isinstance(case.situation, Situation | ErrorSituation)
        known = PLAIN | {action.name for action in case.world.actions}
        for step in steps_of(case):
            verb = step.split(": ")[-1].split(" ")[0].split("(")[0].rstrip("~")
            assert verb in known, (case.id, step)


def steps_of(case: Case) -> list[str]:
    def plans(one: Expected) -> list[list[str]]:
        return [one.do, one.final or [], *(one.do_any or []), *(one.final_any or [])]

    return [step for one in case.expectations for plan in plans(one) for step in plan]


def test_the_unread_set_is_large_and_marked_and_no_other_is() -> None:
    unread = load_set("unread")
    assert len(unread) >= 1400
    assert all(case.blind for case in unread)
    assert not any(case.blind for case in load_set("development"))


def test_a_set_of_ones_own_is_read_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        f"{WORLD}\nblind: true\ncases:\n  a:\n    - {{in: depot, say: hello}}\n", encoding="utf-8"
    )
    (case,) = load_set(str(file))
    assert (case.part, case.blind) == ("mine", True)
    with pytest.raises(ConfigError, match="there is no set"):
        load_set("nothing")


def test_commands_made_by_the_grammar_depend_on_the_seed_alone() -> None:
    first, again, other = gpsr_cases(1), gpsr_cases(1), gpsr_cases(2)
    assert first == again
    assert [case.body.say for case in first] != [case.body.say for case in other]


def test_commands_made_by_the_grammar_have_no_holes() -> None:
    for case in gpsr_cases(7, per_kind=12):
        texts = [case.body.say, *steps_of(case)]
        assert not any(mark in text for text in texts for mark in "{}="), case.id
        assert not any(mark in case.body.say for mark in "()|*"), case.id
