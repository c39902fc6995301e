"""What an operator typed: a slash command, an answer by number, or words for a robot."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from parley.gate.control import control_of
from parley.messages.chat import ChatInput
from parley.messages.status import PlanDecision, PlanProposal
from parley.sentences import SpokenLanguage, in_language
from parley.terminal.view import RobotView

__all__ = ["COMMANDS", "Command", "chosen", "compose", "help_rows", "parse", "suggest"]

COMMANDS: Final = {
    "help": ("", "show this"),
    "plan": ("", "show the plan"),
    "approve": ("on|off", "on: be asked before a plan begins; off: plans begin at once"),
    "stop": ("[all]", "emergency stop; all: of every robot"),
    "reset": ("[all]", "let it move again after an emergency stop"),
    "robots": ("", "who is here"),
    "robot": ("NAME", "talk to another robot"),
    "memory": ("", "show what is remembered"),
    "quit": ("", "leave"),
}
"""Slash command -> how its argument is written, and what it does."""
_YES: Final = frozenset(["yes", "y", "ok", "okay", "sure", "agreed", "jah", "j", "jaa", "sobib", "olgu"])
_NO: Final = frozenset(["no", "n", "nope", "ei"])


@dataclass(frozen=True, slots=True)
class Command:
    """A slash command; `name` need not be a known one."""

    name: str
    argument: str = ""


def parse(text: str) -> Command | None:
    """The slash command in `text`, or None if it is meant for a robot."""
    if not text.startswith("/"):
        return None
    name, _, argument = text[1:].partition(" ")
    return Command(name.lower(), argument.strip())


def suggest(name: str) -> str:
    """The known command that looks most like `name`, or nothing."""
    close = difflib.get_close_matches(name, COMMANDS, n=1)
    return close[0] if close else ""


def chosen(text: str, choices: Sequence[str]) -> str:
    """The answer that a number stands for; any other text is an answer as it is."""
    number = text.rstrip(".)")
    if number.isascii() and number.isdecimal() and 1 <= int(number) <= len(choices):
        return choices[int(number) - 1]
    return text


def compose(robot: RobotView, text: str, message_id: str) -> ChatInput | PlanDecision:
    """The message that `text` is to `robot`: a decision on its plan, an answer to its question, or new words.

    What the text answers is no longer pending afterwards. "Stop" and its kin answer nothing: the question
    stays until whoever asked it takes it back. Nor does a yes begin a plan once the robot has said something
    else: whoever heard it last asks anew.
    """
    last = robot.pending[-1] if robot.pending else None
    decision = _decision(text)
    if isinstance(last, PlanProposal) and (decision == "no" or (decision and not robot.spoke_since)):
        robot.pending.remove(last)
        return PlanDecision(
            id=last.id,
            target=robot.name,
            decision="approve" if decision == "yes" else "reject",
            digest=last.digest,
        )
    question = robot.question
    message = chosen(text, question.choices if question is not None else robot.offered)
    robot.offered = ()
    if question is None or control_of(message, (robot.name,)) not in (None, "start"):
        return ChatInput(message=message, targets=(robot.name,), id=message_id)
    robot.pending.remove(question)
    return ChatInput(
        message=message, targets=(robot.name,), type="response", id=message_id, reply_to=question.id
    )


def _decision(text: str) -> str:
    word = text.lower().rstrip(".!")
    return "yes" if word in _YES else "no" if word in _NO else ""


def help_rows(language: SpokenLanguage) -> list[str]:
    """All commands, one a row, with what they do."""
    written = {f"/{name} {argument}".rstrip(): does for name, (argument, does) in COMMANDS.items()}
    width = max(map(len, written))
    return [f"{row:<{width}}  {in_language(does, language)}" for row, does in written.items()]
