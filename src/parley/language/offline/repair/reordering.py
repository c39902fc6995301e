"""Orders as the answer about a failed step: instead of it, instead of everything, or later."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from parley.language.base import ErrorSituation, Situation
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.protocols import first_act
from parley.language.offline.repair.failed_step import solved
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.messages.chat import ActionCall, ChatAction, SystemCommand

__all__ = ["instead_of_answer", "new_order", "orders_otherwise", "with_order_behind"]

_LATER = tuple(
    tuple(text.split())
    for text in (
        "when you are done with that", "when you have done that", "when you are finished",
        "when you are done", "when you have finished", "once you are done", "once that is done",
        "when that is done", "when it is done", "after you are done", "after that", "after this",
        "afterwards", "later on", "later",
        "at the end", "in the end",
    )
)  # fmt: skip
_PLANS = (
    "the tour",
    "the plan",
    "the round",
    "the rest",
    "the whole thing",
    "the trip",
    "all that",
    "it all",
)
_DROPPED = tuple(
    tuple(text.split())
    for text in (
        "forget it", "forget that", "forget about it", "forget about that", "forget everything", "never mind",
        "nevermind", "cancel it", "cancel that", "cancel everything", "cancel", "drop it", "drop that",
        "drop everything", "give up", "leave that", "leave it", "stop that", "stop it", "abort", "no need",
        *(f"{verb} {what}" for verb in ("cancel", "drop", "forget", "scrap", "abandon") for what in _PLANS),
        "neither", "none of them", "neither of them", "none of those", "no, neither",
    )
)  # fmt: skip
_LEFT_OUT = tuple(tuple(text.split()) for text in ("skip it", "skip that", "skip this", "skip"))
_AGAIN = tuple(tuple(text.split()) for text in ("try again", "try it again", "try once more", "retry"))
_WHAT_TO_DO = frozenset(
    (word, verb, "i")
    for word in ("where", "how", "what")
    for verb in ("should", "shall", "do", "must", "can")
)
"""How people ask what their part is."""
_KEEPING = ("add_memory", "remove_memory")
_JOINING = frozenset({"and", "then", ",", ".", "!", ";", "but", "just", "rather", "instead", "no", "well"})


def new_order(
    situation: ErrorSituation, reply: str, interpret: Callable[[Situation], ChatAction]
) -> ChatAction | None:
    """What an order asks for, or None if the reply is none (or only says what to do about the failed step).

    Args:
        situation: The failure.
        reply: What the operator said.
        interpret: Understands a message.
    """
    words = tokens(reply)
    words, later = _without_any(words, _LATER)
    rest, dropped = _behind(words, _DROPPED)
    rest, left_out = (rest, False) if dropped else _behind(words, _LEFT_OUT)
    rest, again = (rest, False) if dropped or left_out else _behind(rest, _AGAIN)
    if not _is_order(rest):
        return None
    text = plain(rest) if dropped or left_out or later or again else reply
    understood = interpret(_situation(situation, text))
    replanned = _replanned(situation, understood) if not (dropped or later or again) else None
    if replanned is not None:
        return replanned
    if not understood.queue:
        return None
    if again and not situation.pending:
        said = f"All right, I try again. {understood.message_response}"
        return solved(situation, said, [situation.failed_action, *understood.queue], _memories(understood))
    if later or again:
        said = f"{understood.message_response} I will do that afterwards."
        return understood.model_copy(
            update={"message_response": said, "success": None, "system_cmd": _memories(understood)}
        )
    commands = list(_memories(understood))
    if dropped:
        said = f"All right, I drop the rest of the plan. {understood.message_response}"
        return solved(situation, said, understood.queue, [SystemCommand(command="clear"), *commands])
    said = f"All right. {understood.message_response}"
    if situation.pending:
        said = f"{said} After that I go on with the rest of the plan."
    return solved(situation, said, _not_again(understood.queue, situation), commands)


def _replanned(situation: ErrorSituation, understood: ChatAction) -> ChatAction | None:
    """What is left of the plan where a reply leaves out pending steps; None if it leaves out none."""
    gone = {c.pop_index for c in understood.system_cmd if c.command == "pop"}
    if not gone:
        return None
    steps = (situation.failed_action, *situation.pending)
    plan = (*(step for i, step in enumerate(steps) if i not in gone), *understood.queue)
    count, text = len(situation.pending), understood.message_response
    if plan[len(plan) - count :] == situation.pending:
        return solved(situation, text, plan[: len(plan) - count], _memories(understood))
    return solved(situation, text, plan, [SystemCommand(command="clear"), *_memories(understood)])


_GIVING_IN = frozenset(
    {"ok", "okay", "well", "right", "all", "alright", "fine", "good", "no", "hm", "oh", "so", "never", "mind"}
)
_THEN = re.compile(r"[\s,;.!]+(?:and\s+)?(?:then|after\s+(?:that|this)|afterwards)[\s,]+", re.IGNORECASE)


def with_order_behind(
    situation: ErrorSituation,
    resolve: Callable[[ErrorSituation], ChatAction],
    interpret: Callable[[Situation], ChatAction],
) -> ChatAction | None:
    """The repair of an answer with another order behind it ("the small one, then go to the box").

    Args:
        situation: The failure.
        resolve: Understands an answer.
        interpret: Understands a message.

    Returns:
        None if the reply is something else.
    """
    first, *rest = _THEN.split(situation.reply or "", maxsplit=1)
    if not rest or not first.strip() or not _is_order(tokens(rest[0])):
        return None
    if "instead" in keys(tokens(rest[0])) and set(keys(w for w in tokens(first) if w.is_word)) <= _GIVING_IN:
        return None  # "OK then, go to the box instead": not that step again
    if any(_leads(tokens(first), starts) for starts in (_DROPPED, _LEFT_OUT)):
        return None  # what follows takes the place of what is dropped
    repair = resolve(replace(situation, reply=first))
    if not repair.success or any(c.command not in _KEEPING for c in repair.system_cmd):
        return None
    understood = interpret(_situation(situation, rest[0]))
    if understood.queue:
        said = f"{repair.message_response} After that: {understood.message_response}"
    else:
        said = f"{repair.message_response} But what follows I cannot plan: {understood.message_response}"
    commands = (*repair.system_cmd, *_memories(understood))
    changes = {"message_response": said, "afterwards": understood.queue, "system_cmd": commands}
    return repair.model_copy(update=changes)


def instead_of_answer(
    situation: Situation, interpret: Callable[[Situation], ChatAction]
) -> ChatAction | None:
    """What "forget it and go to the box" or "how should I do that?" means where the robot asked for a hand.

    Args:
        situation: With the robot's question.
        interpret: Understands a message.

    Returns:
        None if the message is something else.
    """
    words = tokens(situation.message)
    rest, dropped = _behind(words, _DROPPED)
    if dropped and _is_order(rest):
        alone = replace(situation, message=plain(rest), queue=(), status="idle", question="")
        understood = interpret(alone)
        if not understood.queue:
            return None
        said = f"All right, I drop the rest of the plan. {understood.message_response}"
        commands = (SystemCommand(command="clear"), *_memories(understood))
        return understood.model_copy(update={"message_response": said, "system_cmd": commands})
    if keys(strip_openers(words))[:3] in _WHAT_TO_DO:
        return ChatAction(message_response="What I asked you for is all that I know about it.")
    return None


def orders_otherwise(reply: str, *, dropping: bool = False) -> bool:
    """Whether a reply is an order of its own; with `dropping` only if it says to leave the present one."""
    words = tokens(reply)
    rest, dropped = _behind(words, _DROPPED)
    return _is_order(rest) and (dropped or not dropping)


def _leads(words: Phrase, starts: tuple[tuple[str, ...], ...]) -> bool:
    flat = keys(strip_openers(words))
    return any(flat[: len(start)] == start for start in starts)


def _is_order(words: Phrase) -> bool:
    """Whether it orders something other than what can be done about a failed step."""
    while words and words[0].key in _JOINING:
        words = words[1:]
    act = first_act(words)
    return opens_command(words) and (act is None or act.kind == "order")


def _behind(words: Phrase, starts: tuple[tuple[str, ...], ...]) -> tuple[Phrase, bool]:
    """What follows one of `starts`, and whether one was there."""
    begun = words
    while begun and (begun[0].key in _JOINING or not begun[0].is_word):
        begun = begun[1:]
    for stripped in (begun, strip_openers(begun)):
        flat = keys(stripped)
        for start in starts:
            if flat[: len(start)] == start and len(flat) > len(start):
                rest = stripped[len(start) :]
                if rest[0].key not in _JOINING:
                    continue
                while rest and rest[0].key in _JOINING:
                    rest = rest[1:]
                return rest, bool(rest)
    return words, False


def _without_any(words: Phrase, phrases: tuple[tuple[str, ...], ...]) -> tuple[Phrase, bool]:
    flat = keys(words)
    for phrase in phrases:
        for at in range(len(flat) - len(phrase) + 1):
            if flat[at : at + len(phrase)] == phrase:
                rest = (*words[:at], *words[at + len(phrase) :])
                while rest and rest[0].key in _JOINING:
                    rest = rest[1:]
                return rest, True
    return words, False


def _memories(understood: ChatAction) -> tuple[SystemCommand, ...]:
    """Of its commands those that keep facts: the plan is corrected as a whole."""
    return tuple(c for c in understood.system_cmd if c.command in _KEEPING)


def _not_again(queue: tuple[ActionCall, ...], situation: ErrorSituation) -> tuple[ActionCall, ...]:
    """Without what the rest of the plan begins with anyway."""
    last = queue[-1]
    following = situation.pending[0] if situation.pending else None
    blank = all(not value.has_data for value in last.input_parameters.values())
    doubled = following is not None and following.name == last.name and blank and len(queue) > 1
    return queue[:-1] if doubled and last.input_parameters else queue


def _situation(situation: ErrorSituation, text: str) -> Situation:
    return Situation(
        text,
        memory=situation.memory,
        queue=(situation.failed_action, *situation.pending),
        objects=situation.objects,
        robot_pose=situation.robot_pose,
        robot=situation.robot,
        catalogue=situation.catalogue,
    )
