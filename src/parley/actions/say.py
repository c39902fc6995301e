"""Say: speak a text, in the chat and aloud."""

from __future__ import annotations

from typing import Final

from parley.actions.context import ActionContext
from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import action

__all__ = ["say"]

_LONGEST: Final = 1000
_NOBODY: Final = ("", "operator", "me", "you")
"""Who speaks to the robot is not called by such a word."""


@action(
    label="Say: {text}",
    effects=("speaks",),
    pausable=False,
    kinds={"text": "text", "to": "person"},
    tests={
        "say hello to Kim": {"text": "hello", "to": "Kim"},
        "tell Kim that lunch is ready": {"text": "lunch is ready", "to": "Kim"},
        "say when you are there": None,
        "tell me where the box is": None,
        "tell me what you see": None,
        "don't say hello": None,
    },
)
async def say(ctx: ActionContext, text: str, to: str = "") -> None:
    """Say something aloud, to somebody or to everybody.

    Args:
        text: What to say, word for word.
        to: Whom it is said to.
    """
    words = " ".join(text.split()).rstrip(" .")
    if not words or len(words) > _LONGEST:
        raise ActionFailure(
            FailureCode.NOT_CAPABLE, f"I can say up to {_LONGEST} letters at once, and at least one."
        )
    mark = words[-1] if words[-1] in "?!" else "."
    called = f", {to}" if to.casefold() not in _NOBODY else ""
    said = f"{words[:1].upper()}{words[1:].rstrip('?!')}{called}{mark}"
    ctx.operator.tell(said)
    if "loudspeaker" in ctx.robot.capabilities:
        await ctx.robot.speak(said)
