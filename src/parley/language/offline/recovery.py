"""What to do when a step failed: decided by the failure's code and facts, never by its prose.

Without an answer of the operator only memory may decide; else a question is asked. With an answer the failed
step is repaired, tried again or left out, or the plan is cancelled; an answer that says nothing is asked
again in other words.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, Situation
from parley.language.control import control_of
from parley.language.offline.catalogue import Catalogue
from parley.language.offline.choosing import choose, choose_object, strip_lead_ins
from parley.language.offline.clauses import opens_command
from parley.language.offline.commands import read_command
from parley.language.offline.facts import read_statement
from parley.language.offline.failed_step import (
    AGAIN,
    STOP,
    WITHOUT,
    ask_again,
    ask_what,
    ask_which,
    candidates_of,
    perceives,
    with_words,
    words_of,
)
from parley.language.offline.grounding import describe, ground_phrase
from parley.language.offline.interpreter import interpret
from parley.language.offline.nouns import noun_phrase
from parley.language.offline.remembering import memory_name, remembered
from parley.language.offline.replies import agrees
from parley.language.offline.saying import capital, the, whole_sentence
from parley.language.offline.scene import place_said
from parley.language.offline.text import keys, tokens
from parley.language.word_lists import load_data
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.world.object_map import MapObject

__all__ = ["resolve"]


def resolve(situation: ErrorSituation) -> ChatAction:
    """Repair a failure, or ask."""
    candidates = candidates_of(situation)
    if situation.reply is None:
        if situation.code is FailureCode.AMBIGUOUS:
            return _from_memory(situation, candidates) or ask_which(situation, candidates)
        return _corrected_by_memory(situation) or ask_what(situation)
    reply = situation.reply.strip()
    if situation.code is FailureCode.AMBIGUOUS or candidates:
        chosen = choose_object(candidates, reply, situation.objects, situation.robot_pose)
        if chosen is not None:
            words = describe(chosen, candidates)
            return _solved(
                situation, f"Thank you. I take {the(words)}.", [with_words(situation.failed_action, words)]
            )
    return _answered(situation, reply) or ask_again(situation, candidates)


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
    if situation.code not in {FailureCode.NO_MATCH, FailureCode.AMBIGUOUS} or perceives(situation):
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
        situation, f"Thank you. I take {the(words)}.", [with_words(situation.failed_action, words)], commands
    )


def _new_place(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For a step that looks for something: the place where it really is."""
    if not perceives(situation):
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
    wanted = words_of(situation.failed_action)
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
                [with_words(situation.failed_action, words)],
            )
            return solved.model_copy(update={"sources": (item.entry.name,)})
    return None


def _corrected_by_memory(situation: ErrorSituation) -> ChatAction | None:
    """What was looked for under one name on the map is remembered to be somewhere that the map knows."""
    if situation.code is not FailureCode.NO_MATCH or perceives(situation) or not situation.memory:
        return None
    wanted = tokens(words_of(situation.failed_action))
    for item in remembered(situation.memory):
        if not item.fact.is_location or item.fact.negated or keys(item.fact.subject) != keys(wanted):
            continue
        found = ground_phrase(item.fact.place, situation.objects)
        if found.outcome == "match":
            words = describe(found.candidates[0], situation.objects)
            solved = _solved(
                situation,
                f"I remember: {whole_sentence(item.fact.sentence)}",
                [with_words(situation.failed_action, words)],
            )
            return solved.model_copy(update={"sources": (item.entry.name,)})
    return None
