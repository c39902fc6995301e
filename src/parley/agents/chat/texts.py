"""What the chat interface says of its own accord, in plain words."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.gate.control import Control
from parley.gate.stop_words import calls_to_stop, only_takes_back
from parley.sentences import sentence, together

__all__ = [
    "AFTERWARDS",
    "CANNOT",
    "CONTROL_REPLIES",
    "LEFT",
    "MAX_CHARS",
    "NEVER_MIND",
    "NOTHING_TO_RESUME",
    "NOT_DONE",
    "ONLY_LOOKS",
    "RELEASED_BY_PRESS",
    "RELEASING",
    "REST_LEFT",
    "SAID_AGAIN",
    "SAY_CARRY_ON",
    "UNSURE",
    "alarm",
    "asks_back",
    "concluded",
    "dropped",
    "forgotten",
    "is_never_mind",
    "left",
    "not_there",
    "nothing_started",
    "nothing_to_do",
    "settled",
    "still_standing",
    "still_thinking",
    "that_is_for",
    "undo",
    "undone",
    "unreadable",
    "which_robot",
]

MAX_CHARS: Final = 10_000
"""A longer message is not a request that a person wrote."""
_QUOTED_CHARS: Final = 200
AFTERWARDS: Final = sentence("I will do that afterwards; first I need your answer to my question.")
"""Added to the reply to an order that has to wait until a failed step is settled."""
AFTER_ANSWER: Final = "I go on as soon as you have answered this."
STILL_ASKED: Final = sentence("What I asked about still waits for your yes.")
"""Added when a robot goes on with its plan while something else waits."""

CANNOT: Final = "I worked out a plan that I cannot carry out, so I did nothing. Please say it another way."
RELEASED_BY_PRESS: Final = "A stop is released by a press, not by words. Then say “carry on”."
RELEASING: Final = re.compile(
    r"\W*(?:please |can you |could you )*(?:release|reset|lift|undo|unlock|end|clear)"
    r"(?: the| your| that| this)?(?: emergency)? stop(?: please| now| again)*\W*",
    re.IGNORECASE,
)
"""Asking for what only a press does."""
CONTROL_REPLIES: Final[dict[Control, str]] = {
    "stop": "I have stopped. Say “carry on” when I should go on.",
    "start": "I am going on.",
    "skip": "I will leave that step out.",
    "clear": "I have dropped everything.",
    "emergency_stop": "Emergency stop! I will not move until the stop is released.",
}
_NOTHING_TO_DO: Final[dict[Control, str]] = {
    "stop": "I am standing still.",
    "start": "There is nothing left to go on with.",
    "skip": "There is no step to skip.",
    "clear": "There was nothing to drop.",
}
_NOTHING_TO_FORGET: Final = (
    "There was nothing to drop. What you told me I still know; say “forget everything I told you” if you "
    "mean that."
)


NEVER_MIND: Final = "never mind"
"""What lets go of a message that takes long, and nothing else; "stop" stops the robot as well."""
_NEVER_MIND: Final = re.compile(
    r"(?:please )?(?:never ?mind(?: it| that| this)?|(?:forget|drop|leave) (?:it|that|this))(?: please)?"
    r"|(?:palun )?(?:jäta|unusta) see(?: palun)?|pole vaja"
)


_QUOTED: Final = re.compile(r"“[^”]*”")
_OFFERS_HELP: Final = re.compile(r"\b(?:do for you|help)\b")
FEW_WORDS: Final = 3
"""With more words than these a message that is no mere call to stop may say more than that."""
TALK_WORDS: Final = 6
"""With more words than these also a mere call to stop may."""
LEFT: Final = "All right, then I leave it."
ONLY_LOOKS: Final = "You may look and stop, but not give orders here."
REST_LEFT: Final = sentence("If there was more in what you said, please say it again.")
SAID_AGAIN: Final = sentence("The same comes again and again. I take it as said once.")
UNSURE: Final = sentence("I do not know yet whether I may do that.")
NOT_DONE: Final = sentence("I have not done that.")
SAY_CARRY_ON: Final = "I go on when you say “carry on”."
NOTHING_TO_RESUME: Final = "There is nothing left to go on with."
_UNDO: Final = re.compile(r"(?:forget|unusta)\s+“(.+)”\W*", re.IGNORECASE)


def asks_back(reply: str) -> bool:
    """Whether a reply asks for words that are missing; to offer one's help is no question of that kind.

    Examples:
        >>> asks_back("I do not know where you are. Which place is it near?")
        True
        >>> asks_back("Hello. What can I do for you?")
        False
    """
    last = re.split(r"(?<=[.!?]) +", _QUOTED.sub("", reply).strip())[-1]
    return (last.endswith("?") or last.startswith("Please ")) and not _OFFERS_HELP.search(last)


def still_standing(reply: str, message: str, *, paused: bool) -> str:
    """The reply to words of which nothing comes, said to a robot that stands.

    Args:
        reply: What would be said to them.
        message: The words. Who calls to stop is told that it stands; who asks wants just the answer.
        paused: Whether it has something to go on with.
    """
    if calls_to_stop(message) and not only_takes_back(message):
        more = len(message.split()) > TALK_WORDS
        reply = together(sentence(_NOTHING_TO_DO["stop"]), REST_LEFT if more else "")
    elif message.rstrip().endswith("?"):
        return reply
    return together(reply, sentence(SAY_CARRY_ON)) if paused and "carry on" not in reply else reply


def alarm(robot: str, words: str) -> str:
    """To everybody: somebody speaks of danger."""
    return sentence("Emergency! Somebody told {robot}: “{words}”", robot=robot, words=_short(words))


def concluded(data: str) -> str:
    """That a language engine keeps something that nobody said in these words."""
    return sentence(
        "I noted for myself, though you did not say it in these words: “{data}”", data=_short(data)
    )


def undo(name: str) -> str:
    """What is tapped to undo that."""
    return sentence("Forget “{name}”", name=name)


def undone(message: str) -> str:
    """The memory that somebody tapped to forget; empty if it was no such tap."""
    found = _UNDO.fullmatch(message.strip())
    return found[1] if found else ""


def forgotten(name: str) -> str:
    """That a memory was undone."""
    return sentence("I have forgotten “{name}”.", name=name)


def still_thinking(message: str, newer: str = "") -> str:
    """While an answer takes long; `newer`: what was said meanwhile, and waits."""
    if newer:
        return sentence(
            "I am still thinking about “{words}”. “{newer}” comes next. If I should leave it, "
            "say “{never_mind}”.",
            words=_short(message), newer=_short(newer), never_mind=NEVER_MIND,
        )  # fmt: skip
    return sentence(
        "I am still thinking about “{words}”. If I should leave it, say “{never_mind}”.",
        words=_short(message), never_mind=NEVER_MIND,
    )  # fmt: skip


def is_never_mind(message: str) -> bool:
    """Whether a message says that an answer is not wanted any more."""
    words = " ".join(re.findall(r"[^\W\d_]+", message.lower()))
    return _NEVER_MIND.fullmatch(words) is not None


def nothing_to_do(control: Control, message: str) -> str:
    """The reply to a control that changes nothing; empty if it is worth trying all the same."""
    if control == "clear" and re.search(r"\bforget\b", message, re.IGNORECASE):
        return _NOTHING_TO_FORGET
    return _NOTHING_TO_DO.get(control, "")


def dropped(message: str) -> str:
    """About what the operator does not want to be thought about any more."""
    return sentence("I leave this: “{words}”", words=_short(message))


def left(message: str) -> str:
    """About what was asked for before the robot was stopped."""
    return sentence("You told me to stop, so I leave this: “{words}”", words=_short(message))


def settled(message: str) -> str:
    """About an answer that comes too late."""
    return sentence("My question is settled already, so I leave this: “{words}”", words=_short(message))


def unreadable(message: str, *, bare: bool = False) -> str:
    """Why a message cannot be a request, in plain words; empty if it can."""
    if not message.strip() and not bare:
        return "I did not get any words. Please write what I should do."
    if len(message) > MAX_CHARS:
        return sentence(
            "That message is too long for me ({count} characters). Please use fewer words.",
            count=len(message),
        )
    return ""


def which_robot(known: str) -> str:
    """Where a message names no robot and there are several; `known`: who is there."""
    return sentence("Which robot do you mean? {known}", known=known)


def that_is_for(robots: Sequence[str]) -> str:
    """To a message that another robot was meant to get."""
    return sentence("That is for {names}.", names=" and ".join(robots))


def not_there(robot: str) -> str:
    """About a robot that cannot be asked."""
    return sentence("{robot} is not there at the moment, so I cannot ask it.", robot=robot)


def nothing_started(plain: str) -> str:
    """Why a message was not understood; `plain`: the engine's own words, perhaps none."""
    why = plain or sentence("I could not work that out just now.")
    return sentence("{plain} Nothing was started; please try again.", plain=why)


def _short(message: str) -> str:
    return message if len(message) <= _QUOTED_CHARS else f"{message[:_QUOTED_CHARS]} …"
