"""What to do when a step failed: decided by the failure's code and facts, never by its prose.

Without an answer of the operator only memory may decide; else a question is asked. With an answer the failed
step is repaired, tried again or left out, or the plan is cancelled; an answer that says nothing is asked
again in other words.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, Situation
from parley.language.control import control_of
from parley.language.offline.catalogue import Catalogue, roles_of, text_inputs
from parley.language.offline.choosing import choose, choose_object, strip_lead_ins
from parley.language.offline.clauses import opens_command
from parley.language.offline.commands import read_command
from parley.language.offline.facts import memory_name, read_statement, remembered
from parley.language.offline.grounding import describe, ground_phrase
from parley.language.offline.interpreter import interpret
from parley.language.offline.nouns import noun_phrase
from parley.language.offline.replies import agrees
from parley.language.offline.saying import capital, listing, the, whole_sentence
from parley.language.offline.scene import place_said
from parley.language.offline.text import keys, tokens
from parley.language.word_lists import load_data
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

__all__ = ["resolve"]

AGAIN, WITHOUT, STOP = "try again", "go on without it", "stop"

_ASKING: dict[FailureCode, tuple[str, str]] = {
    FailureCode.UNREACHABLE: (
        "I cannot find a way to get there.",
        "Is there a door to open, or should I go on without it?",
    ),
    FailureCode.BLOCKED: (
        "Something is in my way.",
        "Can you move it, so that I can try again, or should I go on without it?",
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
    FailureCode.HARDWARE: ("A part of me does not work.", "Please have a look at me. Should I try again?"),
    FailureCode.INTERNAL: ("Something went wrong inside me.", "Should I try again?"),
    FailureCode.ATTENTION: ("I found something that you should decide about.", "Should I go on?"),
    FailureCode.NO_MATCH: ("I cannot find it.", "What should I do?"),
    FailureCode.AMBIGUOUS: ("Several things fit.", "Which one do you mean?"),
}


def resolve(situation: ErrorSituation) -> ChatAction:
    """Repair a failure, or ask."""
    candidates = _candidates(situation)
    if situation.reply is None:
        if situation.code is FailureCode.AMBIGUOUS:
            return _from_memory(situation, candidates) or _ask_which(situation, candidates)
        return _corrected_by_memory(situation) or _ask_what(situation)
    reply = situation.reply.strip()
    if situation.code is FailureCode.AMBIGUOUS or candidates:
        chosen = choose_object(candidates, reply, situation.objects, situation.robot_pose)
        if chosen is not None:
            words = describe(chosen, candidates)
            return _solved(
                situation, f"Thank you. I take {the(words)}.", [_with_words(situation.failed_action, words)]
            )
    return _answered(situation, reply) or _ask_again(situation, candidates)


# -- asking --


def _candidates(situation: ErrorSituation) -> list[MapObject]:
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
    return result


def _ask_which(situation: ErrorSituation, candidates: Sequence[MapObject]) -> ChatAction:
    if not candidates:
        return _question(
            f"Several things fit “{_words(situation.failed_action)}”. Which one do you mean?", ()
        )
    names = [describe(item, candidates) for item in candidates]
    shown = listing([the(name) for name in names])
    wanted = _words(situation.failed_action)
    about = f" that could be “{wanted}”" if wanted else ""
    return _question(f"I know {len(names)} things{about}: {shown}. Which one do you mean?", names)


def _ask_what(situation: ErrorSituation) -> ChatAction:
    said, question = _ASKING.get(situation.code, _ASKING[FailureCode.INTERNAL])
    wanted = _words(situation.failed_action)
    if situation.code is FailureCode.NO_MATCH:
        looking = _looks(situation)
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
    elif _is_plain(situation.error_message):
        said = whole_sentence(situation.error_message)
    return _question(f"{said} {question}", (AGAIN, WITHOUT, STOP))


def _is_plain(message: str) -> bool:
    """Whether a failure's own sentence can be shown to people."""
    technical = any(
        mark in message
        for mark in ("/", "_", "::", "{", "}", "Error", "Exception", "Traceback", "<", "0x", "()", "=")
    )
    return bool(message.strip()) and len(message) < 200 and "\n" not in message and not technical


def _ask_again(situation: ErrorSituation, candidates: Sequence[MapObject]) -> ChatAction:
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


# -- answers --


def _answered(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """The repair that an answer asks for; None if it says nothing that helps."""
    order = control_of(reply)
    index = choose((AGAIN, WITHOUT, STOP), reply) if order is None else None
    text = " " + " ".join(word.key for word in tokens(reply) if word.is_word) + " "
    if order in {"stop", "clear", "emergency_stop"} or index == 2:
        return _cancelled(situation)
    if order == "skip":
        return _without(situation)
    if order == "start":
        return _again(situation) if _mentions(text, _said("retry")) else _without(situation)
    for reader in (_new_words, _new_place):
        found = reader(situation, reply)
        if found is not None:
            return found
    if not _denied(text):
        for kind, action in (("retry", _again), ("without", _without), ("cancel", _cancelled)):
            if _mentions(text, _said(kind)):
                return action(situation)
    if index is not None:
        return (_again, _without)[index](situation)
    return _yes_or_no(situation, reply) or _other_order(situation, reply)


@cache
def _said(kind: str) -> tuple[str, ...]:
    """What people say when they mean to retry, go on without, or cancel."""
    return tuple(load_data("replies")["recovery"][kind])


def _mentions(text: str, phrases: Sequence[str]) -> bool:
    return any(f" {phrase} " in text for phrase in phrases)


def _denied(text: str) -> bool:
    return any(f" {word} " in text for word in ("not", "no")) and not _mentions(
        text, ("never mind", "does not matter", "not important", "do not bother", "no need")
    )


def _yes_or_no(situation: ErrorSituation, reply: str) -> ChatAction | None:
    agreed = agrees(reply)
    if agreed is None:
        return None
    helping = {
        FailureCode.NOT_CAPABLE,
        FailureCode.DECLINED,
        FailureCode.NOT_UNDERSTOOD,
        FailureCode.ATTENTION,
    }
    if agreed:
        # "Done", said where the robot could not do it itself, ends the step; elsewhere it clears the way.
        finished = situation.code in helping or (
            situation.code is FailureCode.NO_MATCH
            and len(tokens(reply)) > 0
            and not reply.lower().startswith("yes")
        )
        return _without(situation) if finished else _again(situation)
    return (
        None
        if situation.code is FailureCode.AMBIGUOUS
        else _cancelled(situation)
        if situation.code in helping
        else None
    )


def _again(situation: ErrorSituation) -> ChatAction:
    return _solved(situation, "All right, I try again.", [situation.failed_action])


def _without(situation: ErrorSituation) -> ChatAction:
    return _solved(situation, "All right, I go on with the next step.", [])


def _cancelled(situation: ErrorSituation) -> ChatAction:
    text = "All right, I stop here and drop the rest of the plan."
    return _solved(situation, text, [], [SystemCommand(command="clear")])


def _solved(
    situation: ErrorSituation, text: str, steps: Sequence[ActionCall], commands: Sequence[SystemCommand] = ()
) -> ChatAction:
    return ChatAction(
        message_response=text,
        queue=tuple(steps),
        system_cmd=tuple(commands),
        success=True,
        targets=(situation.robot,) if situation.robot else (),
    )


def _new_words(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For a step that turns words into a place: other words that the map knows."""
    if situation.code not in {FailureCode.NO_MATCH, FailureCode.AMBIGUOUS} or _looks(situation):
        return None
    ordered = read_command(tokens(reply), lambda _: False)
    where = (
        ("at", ordered.place)
        if ordered is not None and ordered.place
        else place_said(strip_lead_ins(tokens(reply)))
    )
    found = ground_phrase(where[1], situation.objects, situation.robot_pose) if where else None
    if found is None or found.outcome != "match" or where is None:
        return None
    words = describe(found.candidates[0], situation.objects)
    commands = _told(situation, where[0], words)
    return _solved(
        situation, f"Thank you. I take {the(words)}.", [_with_words(situation.failed_action, words)], commands
    )


def _new_place(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For a step that looks for something: the place where it really is."""
    if not _looks(situation):
        return None
    phrase = tokens(reply)
    fact = read_statement(phrase)
    if fact is not None and not fact.is_location:
        return None
    where = (fact.relation, fact.place) if fact is not None else place_said(phrase)
    if where is None or ground_phrase(where[1], situation.objects, situation.robot_pose).outcome != "match":
        return None
    place = describe(
        ground_phrase(where[1], situation.objects, situation.robot_pose).candidates[0], situation.objects
    )
    catalogue = Catalogue(situation.catalogue)
    mover = catalogue.mover
    steps = catalogue.chain(mover, {}, place, f"go to {the(place)}") if mover is not None else None
    if steps is None:
        return None
    text = f"Thank you. I will go to {the(place)} and look there."
    return _solved(situation, text, [*steps, situation.failed_action], _told(situation, where[0], place))


def _told(situation: ErrorSituation, relation: str, place: str) -> list[SystemCommand]:
    """The operator's answer as a memory."""
    wanted = _words(situation.failed_action)
    if not wanted or wanted.startswith(("whether", "what")):
        return []
    sentence = f"{capital(the(wanted))} is {relation} {the(place)}"
    fact = read_statement(tokens(sentence))
    if fact is None or set(keys(tokens(wanted))) <= set(keys(tokens(place))):
        return []
    name = memory_name(fact, remembered(situation.memory))
    return [
        SystemCommand(
            command="add_memory",
            arguments={"data": sentence, "info": f"Where {the(wanted)} is", "name": name},
        )
    ]


def _other_order(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """A different order takes the place of the failed step."""
    if not opens_command(tokens(reply)):
        return None
    understood = interpret(
        Situation(
            reply,
            memory=situation.memory,
            queue=(situation.failed_action, *situation.pending),
            objects=situation.objects,
            robot_pose=situation.robot_pose,
            robot=situation.robot,
            catalogue=situation.catalogue,
        )
    )
    if not understood.queue:
        return None
    return understood.model_copy(update={"success": True})


# -- memory --


def _from_memory(situation: ErrorSituation, candidates: Sequence[MapObject]) -> ChatAction | None:
    """The candidate that a fact about what this step is for singles out."""
    about = set(keys(tokens(situation.failed_action.reason)))
    for item in remembered(situation.memory):
        fact = item.fact
        subject = set(noun_phrase(fact.subject).core)
        if not fact.is_location or fact.negated or not subject or not subject <= about:
            continue
        found = ground_phrase(fact.place, candidates)
        if found.outcome == "match" and len(candidates) > 1:
            words = describe(found.candidates[0], candidates)
            solved = _solved(
                situation,
                f"I remember: {whole_sentence(fact.sentence)} So I take {the(words)}.",
                [_with_words(situation.failed_action, words)],
            )
            return solved.model_copy(update={"sources": (item.entry.name,)})
    return None


def _corrected_by_memory(situation: ErrorSituation) -> ChatAction | None:
    """What was looked for under one name on the map is remembered to be somewhere that the map knows."""
    if situation.code is not FailureCode.NO_MATCH or _looks(situation) or not situation.memory:
        return None
    wanted = tokens(_words(situation.failed_action))
    for item in remembered(situation.memory):
        if not item.fact.is_location or item.fact.negated or keys(item.fact.subject) != keys(wanted):
            continue
        found = ground_phrase(item.fact.place, situation.objects)
        if found.outcome == "match":
            words = describe(found.candidates[0], situation.objects)
            solved = _solved(
                situation,
                f"I remember: {whole_sentence(item.fact.sentence)}",
                [_with_words(situation.failed_action, words)],
            )
            return solved.model_copy(update={"sources": (item.entry.name,)})
    return None


# -- the failed step --


def _words(step: ActionCall) -> str:
    """What the failed step was given in words; empty if nothing."""
    return next((p.value for p in step.input_parameters.values() if isinstance(p.value, str) and p.value), "")


def _with_words(step: ActionCall, words: str) -> ActionCall:
    """The same step with other words in its first worded input."""
    inputs = dict(step.input_parameters)
    for name, parameter in inputs.items():
        if parameter.type == "string":
            inputs[name] = replace(parameter, value=words)
            break
    return step.model_copy(update={"input_parameters": inputs})


def _looks(situation: ErrorSituation) -> bool:
    """Whether the failed step is one that perceives."""
    info = next((info for info in situation.catalogue if info.name == situation.failed_action.name), None)
    step = situation.failed_action
    if info is None:
        info = ActionInfo(
            name=step.name,
            inputs={name: p.type for name, p in step.input_parameters.items()},
            outputs={name: p.type for name, p in step.output_parameters.items()},
        )
    return bool(roles_of(info) & {"look", "search", "count"}) and bool(text_inputs(info))
