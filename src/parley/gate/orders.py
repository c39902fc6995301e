"""What of a language engine's answer may go on, on whose account, and what needs a person's yes. Pure.

The engine proposes; nothing it writes decides. Addressees, principals and the fields by which a yes is told
are set here, whatever the answer says about them.
"""

from __future__ import annotations

import re
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from parley.gate.assent import begins_with_no
from parley.gate.evidence import (
    is_about,
    is_said,
    speaks_of_all,
    speaks_of_change,
    speaks_of_forgetting,
)
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.memory import MemoryEntry, is_taught_name
from parley.messages.plain import one_line
from parley.messages.principal import Principal
from parley.sentences import Sentence, sentence

__all__ = ["NOT_SEEN", "UNSURE_OF_ALL", "Admitted", "Heard", "admit", "admit_repair", "engine", "is_chosen"]

SAID_NO: Final = sentence("you said no to something")
NOT_ASKED_FOR: Final = sentence("you did not say so in so many words")
NOT_SPOKEN_TO: Final = sentence("you spoke to another robot")
_DECIDING: Final = re.compile(
    r"\b(?:approve|reset|release|policy|vabasta|kinnita)\b",
    re.IGNORECASE,
)
"""What a person says with their own words or by a press of ours; no engine offers it to be tapped."""
_REFERRING: Final = re.compile(r"\b(?:it|that|this|those|them|seda|see|selle)\b", re.IGNORECASE)
UNSURE_OF_ALL: Final = "…"
"""What an engine gives as the words it did not understand where it doubts the whole."""
NOT_SEEN: Final = "?"
"""What it gives there where it was asked something that only a look can tell."""
_DOUBTS: Final = {
    UNSURE_OF_ALL: sentence("I am not sure that I understood you"),
    NOT_SEEN: sentence("I cannot tell that from here"),
}
MAX_MEMORIES: Final = 20
"""More than this in one answer nobody told."""


@dataclass(frozen=True, slots=True)
class Heard:
    """What a language engine was asked about."""

    words: str
    by: Principal
    """Whose words they are."""
    robot: str
    """Who was spoken to."""
    named: tuple[str, ...] = ()
    """Other robots that the words name, as code reads them."""
    engine: str = ""
    """Which engine answers."""
    own: bool = False
    """Whether a robot is told something for itself alone."""
    known: tuple[MemoryEntry, ...] = ()
    """Memories the engine was shown."""
    earlier: tuple[str, ...] = ()
    """What people said to the robot before, newest last."""


@dataclass(frozen=True, slots=True)
class Admitted:
    """What goes on."""

    order: ChatAction
    refused: tuple[Sentence, ...] = ()
    """What does not, and why, for the operator."""
    concluded: tuple[str, ...] = ()
    """Names of memories that the engine concluded; people are shown them."""
    resumes: bool = False
    """Whether the engine wanted to go on: the person may be asked."""
    others: tuple[ChatAction, ...] = ()
    """What other robots are to do; a robot that the person did not name asks first."""


def engine(name: str) -> Principal:
    """A language engine."""
    return Principal(kind="engine", name=one_line(name))


def admit(answer: ChatAction, heard: Heard) -> Admitted:
    """Keep of an answer what a language engine may want.

    Args:
        answer: As it came from the engine; nothing in it is believed.
        heard: What it was asked about.
    """
    allowed = (heard.robot, *heard.named)
    wanted = answer.targets or (heard.robot,)
    targets = tuple(name for name in dict.fromkeys(wanted) if name in allowed)
    refused: list[Sentence] = []
    if len(targets) < len(set(wanted)):
        refused.append(sentence("I only act where I was spoken to, so I leave the other robot alone."))
    commands: list[SystemCommand] = []
    concluded: list[str] = []
    needs_yes, resumes, added = _doubted(answer), False, 0
    for command in answer.system_cmd:
        match command.command:
            case "start":
                resumes = True
                continue
            case "add_memory":
                added += 1
                if added > MAX_MEMORIES:
                    if added == MAX_MEMORIES + 1:
                        refused.append(sentence("I keep {most} things at a time.", most=MAX_MEMORIES))
                    continue
                command = _memory(command, heard)
                if command.arguments["way"] == "concluded":
                    concluded.append(command.arguments["name"])
            case "remove_memory":
                name, entry = _named(command, heard)
                if not _may_forget(name, entry, heard):
                    needs_yes = NOT_ASKED_FOR
                where = {} if entry is None else {"scope": entry.scope}
                command = SystemCommand(command="remove_memory", arguments={"name": name, **where})
            case "clear" | "pop" | "skip":
                if not speaks_of_change(heard.words):
                    needs_yes = NOT_ASKED_FOR
        commands.append(command)
    order = answer.model_copy(
        update={
            "targets": targets,
            "system_cmd": tuple(commands),
            "by": engine(heard.engine),
            "behalf": heard.by,
            "words": heard.words,
            "needs_yes": needs_yes,
            "choices": tuple(choice for choice in answer.choices if not _DECIDING.search(choice)),
            "others": (),
            "press": None,
        }
    )
    others = tuple(_for_another(other, order, allowed) for other in answer.others if other.queue)
    return Admitted(order, tuple(refused), tuple(concluded), resumes, others)


def _for_another(other: ChatAction, order: ChatAction, named: Sequence[str]) -> ChatAction:
    """The steps, and nothing else, of an order for another robot, on the same account."""
    return ChatAction(
        queue=other.queue,
        targets=other.targets[:1],
        by=order.by,
        behalf=order.behalf,
        words=order.words,
        needs_yes="" if set(other.targets[:1]) <= set(named) else NOT_SPOKEN_TO,
    )


def _doubted(answer: ChatAction) -> str:
    """Why an engine wants a yes itself; it may always ask for one."""
    words = answer.needs_yes
    if not words:
        return ""
    if answer.called:
        return sentence("No robot here is called “{words}”", words=one_line(answer.called)[:80])
    if words in _DOUBTS:
        return _DOUBTS[words]
    return sentence("I did not understand “{words}”", words=one_line(words)[:80])


def admit_repair(answer: ChatAction, heard: Heard) -> ChatAction:
    """The same for how a failure is to be repaired: `start` there means to try the step again as it was."""
    order = admit(answer, heard).order
    retries = [command for command in answer.system_cmd if command.command == "start"]
    changes: dict[str, object] = {"system_cmd": (*order.system_cmd, *retries[:1])}
    if begins_with_no(heard.words) and answer.success:
        changes["needs_yes"] = SAID_NO
    return order.model_copy(update=changes)


def is_chosen(failed: ActionCall, answer: ChatAction, words: str, choices: Sequence[str]) -> bool:
    """Whether a repair is what a person chose, read by code: the same step with the words they gave.

    Args:
        failed: The step that failed.
        answer: What the engine made of the person's answer.
        words: The person's answer.
        choices: What they were offered.
    """
    if answer.system_cmd or answer.afterwards or len(answer.queue) != 1:
        return False
    (call,) = answer.queue
    if call.name != failed.name or call.flow is not None:
        return False
    given = {name: item for name, item in call.input_parameters.items() if item.has_data}
    changed = [item for name, item in given.items() if item != failed.input_parameters.get(name)]
    fitting = [choice for choice in choices if _overlaps(choice, words)]
    return bool(changed) and all(
        item.type == "string"
        and (str(item.value) == fitting[0] if len(fitting) == 1 else _borne(str(item.value), words))
        for item in changed
    )


def _borne(value: str, words: str) -> bool:
    wanted = set(re.findall(r"\w+", value.casefold()))
    return bool(wanted) and wanted <= set(re.findall(r"\w+", words.casefold())) | {"the", "a", "an"}


def _overlaps(choice: str, words: str) -> bool:
    said = set(re.findall(r"\w+", words.casefold())) - {"the", "a", "an", "one", "please"}
    return bool(said) and said <= set(re.findall(r"\w+", choice.casefold()))


_ONESELF: Final = re.compile(r"\b(?:i|i['’]m|me|my|we|our)\b", re.IGNORECASE)
"""Who speaks of themselves need not say their name."""


def _memory(command: SystemCommand, heard: Heard) -> SystemCommand:
    """A memory with its true source: told only if the person's words bear it out, else concluded."""
    given: dict[str, Any] = {
        key: value
        for key, value in command.arguments.items()
        if key in ("name", "data", "info", "type") and isinstance(value, str)
    }
    data = str(given.get("data", ""))
    words = f"{heard.words} {heard.by.name}" if _ONESELF.search(heard.words) else heard.words
    told = heard.by.is_person and is_said(data, words, heard.earlier)
    name = one_line(str(given.get("name", "")))[:200] or f"memory_{uuid.uuid4().hex[:12]}"
    told = told and not is_taught_name(name)  # what words mean is taught by a person, never by an engine
    before = next((entry for entry in heard.known if entry.name == name), None)
    if not told and before is not None and before.way != "concluded":
        name = f"{name[:180]} (concluded {uuid.uuid4().hex[:6]})"  # nothing a person told is written over
        before = None
    scope = heard.robot if heard.own else before.scope if before is not None else ""
    source = (heard.by.name or "operator") if told else heard.robot
    return SystemCommand(
        command="add_memory",
        arguments=given
        | {
            "name": name,
            "scope": scope,
            "source": source,
            "way": "told" if told else "concluded",
            "words": heard.words[:2000],
        },
    )


def _named(command: SystemCommand, heard: Heard) -> tuple[str, MemoryEntry | None]:
    """Which memory a command is about, and what is known of it."""
    name = str(command.arguments.get("name") or command.arguments.get("parameters") or "")
    return name, next((entry for entry in heard.known if entry.name == name), None)


def _may_forget(name: str, entry: MemoryEntry | None, heard: Heard) -> bool:
    """Whether the person's words ask to forget just this."""
    if not (heard.by.is_person and speaks_of_forgetting(heard.words)):
        return False
    if entry is not None and entry.way == "concluded":
        return True
    texts = [name] if entry is None or entry.type == "image" else [name, entry.info, entry.data]
    refers = heard.earlier[-1:] if _REFERRING.search(heard.words) else ()
    return speaks_of_all(heard.words) or is_about(texts, " ".join([heard.words, *refers]))
