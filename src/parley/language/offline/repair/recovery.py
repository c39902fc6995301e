"""What to do when a step failed: decided by the failure's code and facts, never by its prose.

Without an answer of the operator only what is known for certain may decide (`alone`); else a question is
asked. With an answer the failed step is repaired, tried again or left out, or the plan is changed; a question
is answered, and an answer that says nothing is asked again in other words.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.control import Control, control_of
from parley.language.offline.facts.facts import Fact, read_statement
from parley.language.offline.facts.protocols import first_act
from parley.language.offline.facts.remembering import memory_name, remembered
from parley.language.offline.grammar.small import is_past
from parley.language.offline.interpreter import interpret
from parley.language.offline.repair.alone import as_message, looked_there, remembered_places, repaired_alone
from parley.language.offline.repair.asides import answered_aside, asks
from parley.language.offline.repair.failed_step import (
    AGAIN,
    STOP,
    WITHOUT,
    ask_again,
    ask_what,
    ask_which,
    candidates_of,
    perceives,
    solved,
    with_words,
    words_of,
)
from parley.language.offline.repair.other_thing import way_to, with_other_thing
from parley.language.offline.repair.prose import with_code
from parley.language.offline.repair.reordering import new_order, with_order_behind
from parley.language.offline.repair.replies import agrees, without_apology
from parley.language.offline.scene.choosing import choose, choose_object, strip_lead_ins
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene, place_said
from parley.language.offline.sentences.clauses import clauses, opens_command
from parley.language.offline.sentences.forms import plainly_put
from parley.language.offline.tasks.catalogue import roles_of
from parley.language.offline.tasks.commands import read_command
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import capital, the
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.language.word_lists import load_data
from parley.messages.chat import ChatAction, SystemCommand

__all__ = ["resolve"]

_SUGGESTION = re.compile(
    r"^(?:why (?:don['’]?t|do not|not) (?:you )?|(?:can|could)(?:['’]?t|n['’]?t| not) you )(?:just )?(?=\w)",
    re.IGNORECASE,
)
"""How an order may be put as a question."""
_BLIND = "I cannot see what is in a picture."


def resolve(situation: ErrorSituation) -> ChatAction:
    """Repair a failure, or ask."""
    situation = _plainly(with_code(situation))
    if situation.pictures and not (situation.reply or "").strip():
        return ChatAction(success=None, message_response=f"{_BLIND} Please tell me in words.")
    resolution = with_order_behind(situation, _resolve, interpret) or _resolve(situation)
    if situation.pictures:
        said = f"{_BLIND} {resolution.message_response}".rstrip()
        resolution = resolution.model_copy(update={"message_response": said})
    return resolution


def _plainly(situation: ErrorSituation) -> ErrorSituation:
    """With the reply in plain orders ("it would be best if you skipped that one")."""
    said = tokens(situation.reply or "")
    plainer = plainly_put(said, Scene.of(as_message(situation, situation.reply or ""))) if said else said
    return situation if keys(plainer) == keys(said) else replace(situation, reply=plain(plainer))


def _resolve(situation: ErrorSituation) -> ChatAction:
    candidates = candidates_of(situation)
    fact, places = ("", []) if candidates else remembered_places(situation)
    candidates = candidates or places
    if situation.reply is None:
        repair = repaired_alone(situation, candidates, interpret)
        if repair is not None:
            return repair
        if not _is_ambiguous(situation) and not places:
            return ask_what(situation)
        asked = ask_which(situation, candidates)
        text = f"I remember: {fact} {asked.message_response}" if fact else asked.message_response
        return asked.model_copy(update={"message_response": text})
    reply = without_apology(_SUGGESTION.sub("", situation.reply.strip()))
    if _is_ambiguous(situation) or candidates:
        chosen = choose_object(candidates, reply, situation.objects, situation.robot_pose)
        if chosen is not None and not _asks_about(reply) and not _leaves_it(situation, reply):
            words = describe(chosen, candidates)
            return solved(
                situation, f"Thank you. I take {the(words)}.", [with_words(situation.failed_action, words)]
            )
    return _answered(situation, reply) or ask_again(situation, candidates)


def _is_ambiguous(situation: ErrorSituation) -> bool:
    return situation.code is FailureCode.AMBIGUOUS


def _asks_about(reply: str) -> bool:
    """Whether a reply that names a candidate only asks about it ("where is the red one?")."""
    first = keys(tokens(reply))[:1]
    return asks(reply) and first in {("where",), ("why",), ("who",), ("how",)}


def _leaves_it(situation: ErrorSituation, reply: str) -> bool:
    """Whether a reply that names a candidate asks for more than that ("forget it, go to the red one")."""
    order = new_order(situation, reply, interpret)
    if order is None:
        return False
    return order.success is None or any(command.command == "clear" for command in order.system_cmd)


# -- answers --


def _answered(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """The repair that an answer asks for; None if it says nothing that helps."""
    order = control_of(reply)
    text = " " + " ".join(word.key for word in tokens(reply) if word.is_word) + " "
    if order is not None:
        return _controlled(situation, order, text)
    for reader in (
        _later_again,
        _asked,
        _by_themselves,
        with_other_thing,
        _new_words,
        _ordered,
        _another_way,
        _new_place,
        _told,
        _promised,
    ):
        found = reader(situation, reply)
        if found is not None:
            return found
    index = choose((AGAIN, WITHOUT, STOP), reply)
    if index == 2 or (text.startswith(" stop ") and not _mentions(text, ("go on", "carry on", "continue"))):
        return _cancelled(situation)
    if not _denied(text):
        for kind, action in (("retry", _again), ("without", _without), ("cancel", _cancelled)):
            if _mentions(text, _said(kind)):
                return _done(situation, reply) or action(situation)
    if index is not None:
        return (_again, _without)[index](situation)
    return _done(situation, reply) or _yes_or_no(situation, reply)


def _controlled(situation: ErrorSituation, order: Control, text: str) -> ChatAction:
    if order == "skip":
        return _without(situation)
    if order == "start":
        acted = _done(situation, situation.reply or "")
        return acted or (_again(situation) if _mentions(text, _said("retry")) else _without(situation))
    return _cancelled(situation)


def _later_again(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For "wait a minute and try again", "try again in five minutes"."""
    words = tokens(reply)
    seconds = duration_s(words)
    text = " " + " ".join(keys(words)) + " "
    if not seconds or not (_mentions(text, ("wait", "give it")) or _mentions(text, _said("retry"))):
        return None
    again = solved(situation, "All right, I wait and then try again.", [situation.failed_action])
    return again.model_copy(update={"delay_s": min(seconds, 3600.0)})


def _ordered(situation: ErrorSituation, reply: str) -> ChatAction | None:
    there = looked_there(situation, reply) if situation.code is FailureCode.NO_MATCH else ()
    if there:
        return solved(situation, "All right, I go and look there.", there)
    return new_order(situation, reply, interpret)


def _another_way(situation: ErrorSituation, reply: str) -> ChatAction | None:
    act = first_act(tokens(reply))
    return _again(situation) if act is not None and act.kind == "around" else None


def _told(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """A fact about something else is remembered, and the question remains."""
    fact = read_statement(tokens(reply))
    text = f" {' '.join(keys(tokens(reply)))} "
    if fact is None or not fact.is_location or _is_about_step(fact, situation):
        return None
    if any(_mentions(text, _said(kind)) for kind in ("retry", "without", "cancel")):
        return None
    understood = interpret(as_message(situation, reply))
    if understood.queue or not understood.system_cmd:
        return None
    return understood.model_copy(update={"success": None})


def _is_about_step(fact: Fact, situation: ErrorSituation) -> bool:
    """Whether a fact says where the thing of the failed step is."""
    subject = {key for key in keys(fact.subject) if key not in {"the", "a", "an", "my", "your"}}
    step = set(keys(tokens(f"{words_of(situation.failed_action)} {situation.failed_action.reason}")))
    pronouns = lexicon().thing_pronouns | lexicon().person_pronouns
    return bool(subject & (step | set(pronouns))) or not subject


def _promised(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For "I will move it", "I am coming": wait for them to say that it is done."""
    flat = keys(word for word in tokens(reply) if word.is_word)
    text = f" {' '.join(flat)} "
    coming = flat[:2] in {("i", "will"), ("we", "will"), ("let", "me"), ("let", "us")} or _mentions(
        text, ("i am coming", "on my way")
    )
    coming = coming or bool(_ON_IT & set(flat[1:6]) and lexicon().be & set(flat[1:5]))
    if not coming or "not" in flat or _mentions(text, _said("without")):
        return None
    return ChatAction(message_response="All right, I wait. Please tell me when it is done.")


_CORRECTING = frozenset({"meant", "mean", "sorry", "mistake", "should", "oops", "fault"})
_ON_IT = frozenset({
    "opening", "moving", "coming", "clearing", "removing", "fixing", "bringing", "fetching", "looking",
    "working",
    "repairing", "unlocking", "cleaning", "mopping", "getting", "charging", "pushing", "seeing",
})  # fmt: skip
"""What somebody may be doing about a failure."""


def _asked(situation: ErrorSituation, reply: str) -> ChatAction | None:
    return answered_aside(situation, reply) if asks(reply) else None


_HELPED = frozenset(
    {
        FailureCode.BLOCKED,
        FailureCode.UNREACHABLE,
        FailureCode.HARDWARE,
        FailureCode.UNAVAILABLE,
        FailureCode.TIMED_OUT,
        FailureCode.INTERNAL,
    }
)
"""Failures about which the operator is asked to do something, after which it is worth another try."""
_HELPING = frozenset(
    {FailureCode.NOT_CAPABLE, FailureCode.DECLINED, FailureCode.NOT_UNDERSTOOD, FailureCode.ATTENTION}
)
"""Failures where the operator does the step: done, it is over."""


def _done(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For "I did it": what was asked for is done, which clears the way or ends the step."""
    said = keys(word for word in tokens(reply) if word.is_word)
    if said[:1] in {("skip",), ("ignore",), ("leave",), ("go",), ("never",)}:
        return None
    clauses_said = (keys(tokens(part)) for part in re.split(r"[.,;:!]+", reply))
    if agrees(reply) is not True and not any(_acted(part) for part in clauses_said):
        return None
    if situation.code in _HELPING or _asks_operator(situation):
        return _without(situation)
    return _again(situation) if situation.code in _HELPED else None


def _by_themselves(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For "I did it myself": the step is done; what only clears the way ("I moved it myself") is none."""
    said = keys(word for word in tokens(reply) if word.is_word)
    text = f" {' '.join(said)} "
    own = _SELVES & set(said) or _mentions(text, ("took care of that", "took care of it", "did that for you"))
    if not own or not _acted(said) or _mentions(text, _said("retry")) or _CLEARING & set(said):
        return None
    return _without(situation)


_SELVES = frozenset({"myself", "ourselves", "himself", "herself", "themselves"})
_CLEARING = frozenset({
    "moved", "removed", "opened", "unlocked", "cleared", "pushed", "pulled", "lifted", "unblocked",
    "fixed", "repaired", "restarted", "switched", "turned", "plugged", "put", "placed", "unstuck",
    "freed", "dragged", "rolled", "swept",
})  # fmt: skip


def _asks_operator(situation: ErrorSituation) -> bool:
    """Whether the failed step asks the operator for a hand."""
    named = [info for info in situation.catalogue if info.name == situation.failed_action.name]
    return any("ask_operator" in roles_of(info) for info in named)


def _acted(said: tuple[str, ...]) -> bool:
    """For "I've pushed it aside", "we unlocked the door", "it is open now": something was done."""
    if "now" in said[2:] and lexicon().be & set(said[1:4]) and "not" not in said:
        return True
    if said[:1] not in _ACTORS:
        return False
    rest = [word for word in said[1:5] if word not in _AROUND_DEEDS]
    return bool(rest) and "not" not in said and (rest[0].endswith("ed") or is_past(rest[0]))


_ACTORS = frozenset((who,) for who in ("i", "we", "he", "she", "they", "somebody", "someone", "it", "people"))
_AROUND_DEEDS = frozenset({
    "have", "has", "had", "just", "now", "already", "quickly", "simply", "is", "are", "was", "were", "been",
})  # fmt: skip


@cache
def _said(kind: str) -> tuple[str, ...]:
    """What people say when they mean to retry, go on without, or cancel."""
    return tuple(load_data("replies")["recovery"][kind])


def _mentions(text: str, phrases: Sequence[str]) -> bool:
    return any(f" {phrase} " in text for phrase in phrases)


def _denied(text: str) -> bool:
    return any(f" {word} " in text for word in ("not", "no")) and not _mentions(
        text,
        (
            "never mind",
            "does not matter",
            "not important",
            "do not bother",
            "no need",
            "no longer",
            "do not need",
            "not needed",
            "not necessary",
            "do not want",
            "does not have to",
            "no idea",
            "no matter",
        ),
    )


def _yes_or_no(situation: ErrorSituation, reply: str) -> ChatAction | None:
    agreed = agrees(reply)
    if agreed is None:
        return None
    if agreed:
        # "Done", said where the robot could not do it itself, ends the step; elsewhere it clears the way.
        finished = situation.code in _HELPING or (
            situation.code is FailureCode.NO_MATCH and not reply.lower().startswith("yes")
        )
        return _without(situation) if finished else _again(situation)
    if situation.code in _HELPING:
        return _cancelled(situation)
    if _is_ambiguous(situation):
        return None
    text = "All right, I do not try again. Should I go on without it, or stop?"
    return ChatAction(message_response=text, choices=(WITHOUT, STOP), success=False)


def _again(situation: ErrorSituation) -> ChatAction:
    around = situation.code in {FailureCode.BLOCKED, FailureCode.UNREACHABLE} and first_act(
        tokens(situation.reply or "")
    )
    if around and around.kind == "around":
        return solved(situation, "All right, I look for a way around it.", [situation.failed_action])
    return solved(situation, "All right, I try again.", [situation.failed_action])


def _without(situation: ErrorSituation) -> ChatAction:
    return solved(situation, "All right, I go on with the next step.", [])


def _cancelled(situation: ErrorSituation) -> ChatAction:
    text = "All right, I stop here and drop the rest of the plan."
    return solved(situation, text, [], [SystemCommand(command="clear")])


def _new_words(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For a step that turns words into a place: other words that the map knows."""
    if situation.code not in {FailureCode.NO_MATCH, FailureCode.AMBIGUOUS} or perceives(situation):
        return None
    if len(clauses(tokens(reply), opens_command)) > 1:
        return None
    ordered = read_command(tokens(reply), lambda _: False)
    looked = ordered.theme if ordered is not None and ordered.kind in {"look", "search"} else ()
    where = _where_said(situation, reply, looked if ordered is None else ordered.place or looked)
    if where is None:
        return None
    again = [with_words(situation.failed_action, where[1])]
    return solved(situation, f"Thank you. I take {the(where[1])}.", again, _as_memory(situation, *where))


def _new_place(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For a step that looks for something: the place where it really is."""
    parts = (reply, *re.split(r"[,;.!]+", reply)) if perceives(situation) else ()
    where = next((found for part in parts if part and (found := _where_said(situation, part))), None)
    steps = way_to(situation, where[1]) if where is not None else None
    if where is None or steps is None:
        return None
    text = f"Thank you. I will go to {the(where[1])} and look there."
    return solved(situation, text, [*steps, situation.failed_action], _as_memory(situation, *where))


def _where_said(situation: ErrorSituation, reply: str, ordered: Phrase = ()) -> tuple[str, str] | None:
    """The one thing on the map where a reply says that what the step is about is, with the relation to it.

    Args:
        situation: The failure.
        reply: What the operator said.
        ordered: The place that the reply, read as an order, names.
    """
    phrase = tokens(reply)
    fact = None if ordered else read_statement(phrase)
    step = keys(tokens(words_of(situation.failed_action)))
    if fact is not None and {*keys(fact.subject), fact.relation} <= set(step) and len(fact.state) > 1:
        # "The gate A likes": "A likes the east one".
        ordered, fact = fact.state[1:], None
    if fact is not None and not (fact.is_location and _is_about_step(fact, situation)):
        return None
    said = (fact.relation, fact.place) if fact is not None else place_said(strip_lead_ins(phrase))
    where = ("at", ordered) if ordered else said
    found = ground_phrase(where[1], situation.objects, situation.robot_pose) if where else None
    if where is None or found is None or found.outcome != "match":
        return None
    return where[0], describe(found.candidates[0], situation.objects)


def _as_memory(situation: ErrorSituation, relation: str, place: str) -> list[SystemCommand]:
    """The operator's answer as a memory."""
    wanted = words_of(situation.failed_action)
    corrects = _CORRECTING & set(keys(tokens(situation.reply or "")))
    if wanted and keys(tokens(wanted))[:-1] == keys(tokens(place))[:-1] != ():
        # "Paddock D" is no other name of paddock A.
        corrects = _CORRECTING
    if (
        corrects
        or not wanted
        or wanted.startswith(("whether", "what"))
        or "instead" in (situation.reply or "").lower()
    ):
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
