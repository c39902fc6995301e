"""AskOperator: a step for what no action of the robot can do: a person does it and says so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from parley.actions.context import ActionContext
from parley.errors import ActionFailure, FailureCode
from parley.gate.assent import assent_of, begins_with_no
from parley.gate.control import control_of
from parley.gate.stop_words import calls_to_stop
from parley.umrf.action import action

__all__ = ["ATTEMPTS", "Answer", "ask_operator"]

ATTEMPTS: Final = 3
"""How often the question is put before not being understood counts as a failure."""

_CANNOT: Final = "I can't"
_HANDED: Final = (("put ", " on me and tell me", "It is on you"), ("", " tell me when", "It is done"))
"""What a request asks for, how it ends, and what says that it is met."""


def _offers(question: str) -> Sequence[str]:
    """What can be tapped for an answer: that it is done, or not; an open question has nothing."""
    done = next((said for asks, ends, said in _HANDED if asks in question and ends in question), "")
    return (done, _CANNOT) if done else ()


async def _reading(ctx: ActionContext, question: str, reply: str) -> str:
    """How an answer is meant. A literal yes or no is read by code, and no engine turns a no into a yes."""
    if calls_to_stop(reply):
        return "control"
    if reply in _offers(question):
        return "no" if reply == _CANNOT else "yes"
    literal = assent_of(reply, (ctx.actor,))
    if literal:
        return "yes"
    kind = (await ctx.language.read_reply(question, reply)).kind
    if literal is False:
        return "aside" if kind == "aside" else "no"  # "not yet" is no refusal
    if kind in ("yes", "choice", "answer") and "?" in reply:
        return "aside"
    return "unclear" if kind == "yes" and begins_with_no(reply) else kind


@dataclass(frozen=True, slots=True)
class Answer:
    """What the operator said."""

    answer: str


@action(
    label="Ask you: {question}",
    phrases=("ask {question}",),
    effects=("asks_operator",),
    pausable=False,
)
async def ask_operator(ctx: ActionContext, question: str) -> Answer:
    """Ask the operator something and wait for the answer.

    Args:
        question: The question or request, in plain words.
    """
    asked, unclear = question, 0
    while unclear < ATTEMPTS:
        reply = await ctx.operator.ask(asked, _offers(question))
        if ctx.run.paused and control_of(reply) == "start":
            asked = question  # that was for the plan; the question is still open
            continue
        match await _reading(ctx, question, reply):
            case "yes" | "choice" | "answer":
                return Answer(reply)
            case "aside":
                await ctx.operator.refer(reply)
                asked = question
            case "no":
                raise ActionFailure(
                    FailureCode.DECLINED,
                    f"You said no to: {question}",
                    {"question": question, "reply": reply},
                )
            case "control":
                asked = question
            case "unclear":
                unclear += 1
                asked = f"I did not understand that. {question} You can also say “no”, “skip it” or “stop”."
    raise ActionFailure(
        FailureCode.NOT_UNDERSTOOD,
        f"I could not understand your answers to: {question}",
        {"question": question},
    )
