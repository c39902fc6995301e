"""What to do when a step failed, and how answers are meant: choices by their words, else ask."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, ReplyReading
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.tokens import tokenize
from parley.language.control import control_of
from parley.messages.chat import ActionCall, ChatAction, SystemCommand

__all__ = ["chosen", "head_of", "read_reply", "resolve"]

_AGAIN, _WITHOUT, _STOP = "try again", "go on without it", "stop"
_ORDINALS = {"first": 0, "second": 1, "third": 2, "fourth": 3, "one": 0, "two": 1, "three": 2, "last": -1}


def resolve(situation: ErrorSituation, lexicon: Lexicon) -> ChatAction:
    """Repair a failure by what the operator answered, or ask."""
    names = _candidates(situation)
    if situation.reply is None:
        return _ask(situation, names)
    words = _words(situation.reply)
    command = control_of(situation.reply)
    choice = chosen(words, names)
    if choice is not None:
        step = _with_words(situation.failed_action, choice)
        return _solved(situation, f"Thank you. I take the {choice}.", (step,))
    if command in ("stop", "clear", "emergency_stop"):
        kind = "clear" if command == "clear" else "stop"
        return _solved(situation, "I stop here.", (), (SystemCommand(command=kind),))
    if command == "skip" or words & {"without", "skip", "leave"}:
        return _solved(situation, "I go on without it.", ())
    if words & _DONE and not words & _NOT:
        helped = situation.code in (FailureCode.NOT_CAPABLE, FailureCode.DECLINED)
        return _solved(situation, "Thank you. I go on.", () if helped else (situation.failed_action,))
    if words & {"again", "retry", "yes", "try"} and not words & _NOT:
        return _solved(situation, "I try again.", (situation.failed_action,))
    return _ask(situation, names, "I did not understand that. ")


_DONE = frozenset(
    {"done", "did", "moved", "cleared", "removed", "fixed", "ready", "finished", "opened", "have"}
)
_NOT = frozenset({"not", "no", "don't", "never", "can't", "didn't", "haven't"})


def _candidates(situation: ErrorSituation) -> tuple[str, ...]:
    listed = situation.details.get("candidates")
    if situation.code is not FailureCode.AMBIGUOUS or not isinstance(listed, list):
        return ()
    return tuple(
        str(item["description"]) for item in listed if isinstance(item, dict) and "description" in item
    )


def _ask(situation: ErrorSituation, names: Sequence[str], before: str = "") -> ChatAction:
    if names:
        shown = " and ".join([", ".join(f"the {name}" for name in names[:-1]), f"the {names[-1]}"])
        question = f"{before}I know {len(names)} things that fit: {shown}. Which one do you mean?"
        return ChatAction(success=False, message_response=question, choices=tuple(names))
    text = situation.error_message.strip() or "A step did not work."
    question = f"{before}{text} Shall I {_AGAIN}, {_WITHOUT}, or {_STOP}?"
    return ChatAction(success=False, message_response=question, choices=(_AGAIN, _WITHOUT, _STOP))


def _solved(
    situation: ErrorSituation, text: str, steps: Sequence[ActionCall], commands: Sequence[SystemCommand] = ()
) -> ChatAction:
    targets = (situation.robot,) if situation.robot else ()
    return ChatAction(
        success=True, message_response=text, queue=tuple(steps), system_cmd=tuple(commands), targets=targets
    )


def _with_words(step: ActionCall, words: str) -> ActionCall:
    inputs = dict(step.input_parameters)
    for name, parameter in inputs.items():
        if parameter.type == "string":
            inputs[name] = replace(parameter, value=words)
            break
    return step.model_copy(update={"input_parameters": inputs})


def _words(text: str) -> set[str]:
    return {token.low for token in tokenize(text) if token.is_word}


def chosen(words: Collection[str], names: Sequence[str]) -> str | None:
    """The one of several names that words tell from the others."""
    own = [{stem(word) for word in name.lower().split()} for name in names]
    said = {stem(word) for word in words}
    scores = [len(said & (mine - set().union(*(o for at, o in enumerate(own) if at != number))))
              for number, mine in enumerate(own)]  # fmt: skip
    if scores and sum(score > 0 for score in scores) == 1:
        return names[scores.index(max(scores))]
    place = next((_ORDINALS[word] for word in words if word in _ORDINALS and word != "one"), None)
    return names[place] if place is not None and names and place < len(names) else None


def head_of(words: Sequence[str], lexicon: Lexicon) -> int:
    """Which word of a description names the thing: the last one before a preposition."""
    small = lexicon.classes["prepositions"]
    first = next(
        (at for at, word in enumerate(words) if word not in small | lexicon.classes["determiners"]), 0
    )
    stop = next((at for at in range(first + 1, len(words)) if words[at] in small), len(words))
    return stop - 1


_YES = frozenset(
    {"yes", "yep", "yeah", "ok", "okay", "sure", "done", "ready", "correct", "right", "did", "put", "have"}
)
_NO = frozenset({"no", "nope", "nah", "not", "don't", "never", "can't", "won't"})


def read_reply(reply: str, choices: Sequence[str], acts: frozenset[str]) -> ReplyReading:
    """How an answer to a question is meant."""
    words = _words(reply)
    if not words:
        return ReplyReading("unclear")
    if control_of(reply) is not None:
        return ReplyReading("control")
    if choices:
        choice = chosen(words, choices)
        if choice is not None and not words & _NO:
            return ReplyReading("choice", choice)
    if reply.strip().endswith("?") or acts & {"question", "order", "alarm", "need"}:
        return ReplyReading("aside")
    if words & _NO:
        return ReplyReading("no")
    if words & _YES:
        return ReplyReading("yes")
    return ReplyReading("unclear" if choices or acts & {"control", "social"} else "answer")
