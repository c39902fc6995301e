"""What is found wrong about a queue before anything moves."""

from __future__ import annotations

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.agents.planner.check import plan_problems
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.umrf.catalogue import Catalogue

INFOS = Catalogue(BUILTIN_ACTIONS).infos()
DRIVE = ActionCall(name="NavigateTo")


def find(target: str) -> ActionCall:
    return ActionCall(name="GetCoordinates", input_parameters={"target": Parameter("string", target)})


def test_a_step_that_runs_already_is_not_asked_again_for_what_it_was_given() -> None:
    assert plan_problems([find("box"), DRIVE], INFOS, before=[DRIVE]) == []


def test_a_step_right_after_one_that_gives_nothing_lacks_what_it_needs() -> None:
    codes = {problem.code for problem in plan_problems([DRIVE], INFOS, before=[DRIVE])}
    assert codes == {"missing_input"}
