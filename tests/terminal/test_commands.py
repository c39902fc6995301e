"""What typed words mean."""

from __future__ import annotations

import pytest

from parley.messages.chat import ChatInput
from parley.messages.status import PlanDecision, PlanProposal
from parley.terminal.commands import COMMANDS, Command, chosen, compose, help_rows, parse, suggest
from parley.terminal.view import Question, RobotView

PROPOSAL = PlanProposal(id="p1", target="Ada")
QUESTION = Question("q1", "Which?", ("red box", "blue box"))


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("/plan", Command("plan")),
        ("/Robot  Ada ", Command("robot", "Ada")),
        ("/", Command("")),
        ("go to the box", None),
        ("either/or", None),
    ],
)
def test_a_line_that_begins_with_a_slash_is_a_command(text: str, command: Command | None) -> None:
    assert parse(text) == command


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("1", "red box"),
        ("2.", "blue box"),
        ("2)", "blue box"),
        ("3", "3"),
        ("0", "0"),
        ("²", "²"),
        ("red", "red"),
    ],
)
def test_a_number_stands_for_the_choice_of_that_number(text: str, answer: str) -> None:
    assert chosen(text, QUESTION.choices) == answer


def test_words_are_a_request_when_nothing_was_asked() -> None:
    message = compose(RobotView("Ada"), "1", "m1")
    assert message == ChatInput(message="1", targets=("Ada",), type="request", id="m1")


def test_words_answer_the_open_question_once() -> None:
    robot = RobotView("Ada", pending=[QUESTION])
    first, second = compose(robot, "2", "m1"), compose(robot, "2", "m2")
    assert first == ChatInput(message="blue box", targets=("Ada",), type="response", id="m1", reply_to="q1")
    assert second == ChatInput(message="2", targets=("Ada",), type="request", id="m2")


@pytest.mark.parametrize(
    ("text", "decision"), [("yes", "approve"), ("OK.", "approve"), ("no", "reject"), ("No!", "reject")]
)
def test_yes_and_no_decide_on_a_proposed_plan(text: str, decision: str) -> None:
    robot = RobotView("Ada", pending=[PROPOSAL])
    message = compose(robot, text, "m1")
    assert isinstance(message, PlanDecision)
    assert (message.id, message.target, message.decision) == ("p1", "Ada", decision)
    assert robot.pending == []


def test_other_words_leave_a_proposed_plan_open() -> None:
    robot = RobotView("Ada", pending=[PROPOSAL])
    message = compose(robot, "go to the blue box instead", "m1")
    assert isinstance(message, ChatInput)
    assert message.type == "request"
    assert robot.pending == [PROPOSAL]


def test_yes_answers_a_question_that_came_after_the_proposal() -> None:
    robot = RobotView("Ada", pending=[PROPOSAL, QUESTION])
    message = compose(robot, "yes", "m1")
    assert isinstance(message, ChatInput)
    assert (message.type, message.reply_to) == ("response", "q1")


def test_a_yes_to_something_else_that_was_said_since_begins_no_plan() -> None:
    robot = RobotView("Ada", pending=[PROPOSAL], spoke_since=True)
    message = compose(robot, "yes", "m1")
    assert isinstance(message, ChatInput)
    assert robot.pending == [PROPOSAL]
    assert isinstance(compose(robot, "no", "m2"), PlanDecision)


def test_estonian_yes_is_yes() -> None:
    message = compose(RobotView("Ada", pending=[PROPOSAL]), "jah", "m1")
    assert isinstance(message, PlanDecision)
    assert message.decision == "approve"


def test_a_misspelt_command_gets_a_suggestion() -> None:
    assert suggest("memry") == "memory"
    assert suggest("xyzzy") == ""


def test_help_names_every_command() -> None:
    rows = help_rows("en")
    assert len(rows) == len(COMMANDS)
    assert all(row.startswith(f"/{name}") for row, name in zip(rows, COMMANDS, strict=True))


@pytest.mark.parametrize("text", ["stop", "Ada, stop!", "skip it", "cancel everything"])
def test_stop_and_its_kin_leave_a_question_open(text: str) -> None:
    robot = RobotView("Ada", pending=[QUESTION])
    message = compose(robot, text, "m1")
    assert isinstance(message, ChatInput)
    assert message.type == "request"
    assert robot.question is QUESTION


def test_carry_on_may_be_an_answer() -> None:
    message = compose(RobotView("Ada", pending=[QUESTION]), "carry on", "m1")
    assert isinstance(message, ChatInput)
    assert message.type == "response"


def test_a_number_chooses_once_from_what_an_answer_offered() -> None:
    robot = RobotView("Ada", offered=("red box", "blue box"))
    first, second = compose(robot, "1", "m1"), compose(robot, "1", "m2")
    assert first == ChatInput(message="red box", targets=("Ada",), id="m1")
    assert second == ChatInput(message="1", targets=("Ada",), id="m2")
