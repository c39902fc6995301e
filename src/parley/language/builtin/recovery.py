"""What to do when a step failed, and what of an answer settles it; all else is left to the chat."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.builtin.tokens import tokenize
from parley.language.control import control_of
from parley.language.dialogue.answers import differences
from parley.language.dialogue.questions import plain, question_of
from parley.language.dialogue.replies import chosen, is_done, names_deed, words_of
from parley.messages.chat import ActionCall, ChatAction, SystemCommand

__all__ = ["resolve"]

_AGAIN, _WITHOUT, _STOP = "try again", "go on without it", "stop"
_RETRY = frozenset({"again", "retry", "try", "repeat"})
_YES = frozenset({"yes", "yeah", "ok", "okay", "sure", "yep"})
_NOT = frozenset({"not", "no", "don't", "never", "can't", "didn't", "haven't"})
_GOING = frozenset({"go", "drive", "come", "move", "over", "to", "the", "please", "now", "then", "just"})
_LONGEST = 6
"""So many words an answer has at most that is no order, question or fact."""


def resolve(situation: ErrorSituation) -> ChatAction:
    """Repair a failure by what the operator answered, or ask; an empty answer leaves it to the chat."""
    names = _candidates(situation)
    if situation.reply is None:
        return _ask(situation, names)
    bare, words = plain(tokenize(situation.reply)), words_of(situation.reply)
    command = control_of(situation.reply)
    also = {item.description: item.aliases for item in situation.objects}
    choice = chosen(words, names, also) if len(words) <= 2 * _LONGEST and "?" not in situation.reply else None
    if choice is not None and (not names_deed(words) or _goes_there(situation, words, choice)):
        step = _with_words(situation.failed_action, choice)
        return _solved(situation, f"Thank you. I take the {choice}.", (step,))
    if command in ("stop", "clear", "emergency_stop"):
        kind = "clear" if command == "clear" else "stop"
        return _solved(situation, "I stop here.", (), (SystemCommand(command=kind),))
    short = len(words) <= _LONGEST and "?" not in situation.reply
    if command == "skip" or (short and {*words} & {"without", "skip"} and not {*words} & {"the", "to"}):
        return _solved(situation, "I go on without it.", ())
    if short and {*words} & _RETRY and not {*words} & _NOT:
        return _solved(situation, "I try again.", (situation.failed_action,))
    if is_done(bare):
        helped = situation.code in (FailureCode.NOT_CAPABLE, FailureCode.DECLINED)
        return _solved(situation, "Thank you. I go on.", () if helped else (situation.failed_action,))
    if short and {*words} <= _YES | {"please", "do", "it", "that"} and not names:
        return _solved(situation, "I try again.", (situation.failed_action,))
    question = question_of(bare)
    if names and question is not None and question.topic == "difference":
        return ChatAction(message_response=differences(names, situation.objects))
    return ChatAction()


def _goes_there(situation: ErrorSituation, words: Sequence[str], choice: str) -> bool:
    """Whether somebody orders just what the search that failed was made for: "go to the north gate"."""
    infos = (info for info in situation.catalogue if info.name == situation.failed_action.name)
    finds = next((info.only_finds for info in infos), False)
    return finds and {*words} <= _GOING | {*choice.lower().split()}


def _candidates(situation: ErrorSituation) -> tuple[str, ...]:
    listed = situation.details.get("candidates")
    if situation.code is not FailureCode.AMBIGUOUS or not isinstance(listed, list):
        return ()
    return tuple(
        str(item["description"]) for item in listed if isinstance(item, dict) and "description" in item
    )


def _ask(situation: ErrorSituation, names: Sequence[str]) -> ChatAction:
    if names:
        shown = " and ".join([", ".join(f"the {name}" for name in names[:-1]), f"the {names[-1]}"])
        question = f"I know {len(names)} things that fit: {shown}. Which one do you mean?"
        return ChatAction(success=False, message_response=question, choices=tuple(names))
    text = situation.error_message.strip() or "A step did not work."
    question = f"{text} Shall I {_AGAIN}, {_WITHOUT}, or {_STOP}?"
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
