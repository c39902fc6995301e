"""A failed step: its words, what it does, and the questions about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.tasks.catalogue import roles_of, text_inputs
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import keys, tokens
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

__all__ = [
    "AGAIN",
    "STOP",
    "WITHOUT",
    "ask_again",
    "ask_what",
    "ask_which",
    "candidates_of",
    "in_words",
    "is_plain",
    "perceives",
    "solved",
    "with_words",
    "words_of",
]


AGAIN = "try again"


WITHOUT = "go on without it"


STOP = "stop"


_ASKING: dict[FailureCode, tuple[str, str]] = {
    FailureCode.UNREACHABLE: (
        "I cannot find a way to get there.",
        "Is there a door to open, or should I go on without it?",
    ),
    FailureCode.BLOCKED: (
        "Something is in my way.",
        "Can you clear the way, so that I can try again, or should I go on without it?",
    ),
    FailureCode.TIMED_OUT: ("It took too long, so I gave up for now.", "Should I try again?"),
    FailureCode.UNAVAILABLE: ("Something I need does not answer.", "Should I try again?"),
    FailureCode.NOT_CAPABLE: (
        "I am not able to do this.",
        "Can you do it for me and tell me when it is done?",
    ),
    FailureCode.DECLINED: ("You said no to this step.", "Should I go on without it?"),
    FailureCode.NOT_UNDERSTOOD: (
        "I could not understand the answer.",
        "Is it done, or should I go on without it?",
    ),
    FailureCode.FORBIDDEN: ("A rule forbids this step.", "Should I go on without it?"),
    FailureCode.HARDWARE: ("A part of me does not work.", "Please have a look at me. Should I try again?"),
    FailureCode.INTERNAL: ("Something went wrong inside me.", "Should I try again?"),
    FailureCode.ATTENTION: ("I found something that you should decide about.", "Should I go on?"),
    FailureCode.NO_MATCH: ("I cannot find it.", "What should I do?"),
    FailureCode.AMBIGUOUS: ("Several things fit.", "Which one do you mean?"),
}


def candidates_of(situation: ErrorSituation) -> list[MapObject]:
    """What the failure lists, as objects of the map where it knows them."""
    listed = situation.details.get("candidates", ())
    known = {item.id: item for item in situation.objects}
    result: list[MapObject] = []
    for entry in listed if isinstance(listed, Sequence) else ():
        if isinstance(entry, dict) and isinstance(entry.get("description"), str):
            identifier = str(entry.get("id", entry["description"]))
            result.append(known.get(identifier) or MapObject(identifier, entry["description"], 0.0, 0.0))
        elif isinstance(entry, str):
            named = next((item for item in situation.objects if entry in {item.id, item.description}), None)
            result.append(named or MapObject(entry, entry, 0.0, 0.0))
    return result or _fitting(situation)


def _fitting(situation: ErrorSituation) -> list[MapObject]:
    """What an ambiguous name may mean where nothing is listed: by the failure's words, else by the map."""
    if situation.code is not FailureCode.AMBIGUOUS:
        return []
    said = f" {' '.join(keys(w for w in tokens(situation.error_message) if w.is_word))} "
    named = [item for item in situation.objects if f" {' '.join(keys(tokens(item.description)))} " in said]
    if len(named) > 1:
        places = {item.id: said.index(f" {' '.join(keys(tokens(item.description)))} ") for item in named}
        return sorted(named, key=lambda item: places[item.id])
    wanted = words_of(situation.failed_action)
    found = ground_phrase(tokens(wanted), situation.objects, situation.robot_pose) if wanted else None
    return list(found.candidates) if found is not None and found.outcome == "ambiguous" else []


def ask_which(situation: ErrorSituation, candidates: Sequence[MapObject]) -> ChatAction:
    """Ask which of several things is meant."""
    if not candidates:
        return _question(
            f"Several things fit “{words_of(situation.failed_action)}”. Which one do you mean?", ()
        )
    names = [describe(item, candidates) for item in candidates]
    shown = listing([the(name) for name in names])
    wanted = words_of(situation.failed_action)
    about = f" that could be “{wanted}”" if wanted else ""
    return _question(f"I know {len(names)} things{about}: {shown}. Which one do you mean?", names)


def ask_what(situation: ErrorSituation) -> ChatAction:
    """Say what went wrong and ask what to do."""
    said, question = _ASKING.get(situation.code, _ASKING[FailureCode.INTERNAL])
    wanted = words_of(situation.failed_action)
    if situation.code is FailureCode.NO_MATCH:
        looking = perceives(situation)
        said = (
            f"I looked, but I cannot see {the(wanted)}."
            if looking
            else f"I do not know where {the(wanted)} is."
        )
        if wanted.startswith(("whether", "what")):
            said = "I looked, but I could not see what you asked about."
        question = (
            "Should I try again, go on without it, or stop?"
            if looking
            else "Where is it? Or should I go on without it, or stop?"
        )
    elif is_plain(situation.error_message):
        said = whole_sentence(situation.error_message)
    if situation.tried:
        # The same way once more is the last thing to offer.
        return _question(f"That did not help. {said} {question}", (WITHOUT, STOP, AGAIN))
    return _question(f"{said} {question}", (AGAIN, WITHOUT, STOP))


def in_words(situation: ErrorSituation) -> str:
    """What went wrong, as a sentence for people."""
    if is_plain(situation.error_message):
        return whole_sentence(situation.error_message)
    return _ASKING.get(situation.code, _ASKING[FailureCode.INTERNAL])[0]


def is_plain(message: str) -> bool:
    """Whether a failure's own sentence can be shown to people."""
    technical = any(
        mark in message
        for mark in ("/", "_", "::", "{", "}", "Error", "Exception", "Traceback", "<", "0x", "()", "=")
    )
    return bool(message.strip()) and len(message) < 200 and "\n" not in message and not technical


def ask_again(situation: ErrorSituation, candidates: Sequence[MapObject]) -> ChatAction:
    """Ask once more in other words, after an answer that said nothing."""
    asked = sum(turn.role == "assistant" for turn in situation.dialogue)
    if situation.code is FailureCode.AMBIGUOUS and candidates:
        names = [describe(item, candidates) for item in candidates]
        numbered = listing([f"{index}, {the(name)}" for index, name in enumerate(names, 1)], "or")
        start = (
            "I am sorry, I still do not see which one you mean."
            if asked > 1
            else "I did not understand which one you mean."
        )
        return _question(f"{start} Please say one of these or its number: {numbered}?", names)
    start = "I am sorry, I still do not understand." if asked > 1 else "I did not understand that."
    return _question(
        f"{start} You can say “{AGAIN}”, “{WITHOUT}” or “{STOP}”. What should I do?", (AGAIN, WITHOUT, STOP)
    )


def _question(text: str, choices: Sequence[str]) -> ChatAction:
    return ChatAction(message_response=text, success=False, choices=tuple(choices))


def solved(
    situation: ErrorSituation, text: str, steps: Sequence[ActionCall], commands: Sequence[SystemCommand] = ()
) -> ChatAction:
    """A correction: `steps` in place of the failed one."""
    return ChatAction(
        message_response=text,
        queue=tuple(steps),
        system_cmd=tuple(commands),
        success=True,
        targets=(situation.robot,) if situation.robot else (),
    )


def words_of(step: ActionCall) -> str:
    """What the failed step was given in words; empty if nothing."""
    return next((p.value for p in step.input_parameters.values() if isinstance(p.value, str) and p.value), "")


def with_words(step: ActionCall, words: str) -> ActionCall:
    """The same step with other words in its first worded input."""
    inputs = dict(step.input_parameters)
    for name, parameter in inputs.items():
        if parameter.type == "string":
            inputs[name] = replace(parameter, value=words)
            break
    return step.model_copy(update={"input_parameters": inputs})


def perceives(situation: ErrorSituation) -> bool:
    """Whether the failed step is one that perceives."""
    info = next((info for info in situation.catalogue if info.name == situation.failed_action.name), None)
    step = situation.failed_action
    if info is None:
        info = ActionInfo(
            name=step.name,
            inputs={name: p.type for name, p in step.input_parameters.items()},
            outputs={name: p.type for name, p in step.output_parameters.items()},
        )
    finds = roles_of(info) & {"look", "search", "count", "meet", "follow"}
    return bool(finds) and bool(text_inputs(info))
