"""Reads a message in more ways than one, where the first does not make enough sense, and takes the best."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from parley.language.base import Situation
from parley.language.offline.facts.declared import laid_down
from parley.language.offline.facts.facts import Fact
from parley.language.offline.facts.groups import with_members
from parley.language.offline.facts.noting import mention_listed
from parley.language.offline.facts.plain_names import plainly_named, without_hesitation
from parley.language.offline.grammar.canonical import plainly_ordered
from parley.language.offline.reader import Reader
from parley.language.offline.readings.judging import Judgement, is_odd, judge, texts_of
from parley.language.offline.scene.grouping import grouped, names_things
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.arranging import arranged, each_in_turn, without_end
from parley.language.offline.sentences.branching import branched
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.correcting import corrected
from parley.language.offline.sentences.distilling import context, distilled
from parley.language.offline.sentences.named import back_to_first, verb_first, with_articles
from parley.language.offline.sentences.numbering import unnumbered
from parley.language.offline.sentences.orderings import in_sequence
from parley.language.offline.sentences.passives import done_first
from parley.language.offline.sentences.scoping import scoped
from parley.language.offline.sentences.spoken import Names
from parley.language.offline.sentences.told import when_done
from parley.language.offline.sentences.units import Unit, units
from parley.language.offline.sentences.waiting import waiting_there
from parley.language.offline.tasks.abilities import cannot
from parley.language.offline.words.explaining import Trace
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.messages.chat import ChatAction

__all__ = ["best_reading"]

_SMALL = frozenset({"the", "a", "an", "is", "are", "whether", "of", "in", "at", "on", "it", "any"})
"""What makes no difference to what a step is about."""


@dataclass(frozen=True, slots=True)
class _Reading:
    action: ChatAction
    judged: Judgement
    trace: Trace
    how: str


def best_reading(
    words: Phrase, situation: Situation, hints: Sequence[str], trace: Trace, targets: tuple[str, ...]
) -> ChatAction:
    """Understand a whole message.

    Args:
        words: All words and punctuation, mended.
        situation: What is known.
        hints: Answers to questions that were asked about this message before.
        trace: Gets the decisions of the reading that is taken, and how the readings were judged.
        targets: The robots that are spoken to.
    """
    changed = _changed_plan(words, situation, hints, trace, targets)
    if changed is not None:
        return changed
    scene = Scene.of(situation, hints)
    told, words = laid_down(without_hesitation(words), scene)
    mention_listed(told, scene)
    words = _settled(words, scene)
    message = plainly_named(with_members(words, told), scene)
    raw = words
    if not situation.queue:
        names = names_things(scene)
        words = branched(scoped(grouped(words, scene), names, lambda part: False), names)
    # What was left out or put together already, the plain orders of the whole message would bring back.
    settled = keys(raw) != keys(words)
    words = plainly_named(with_members(words, told), scene)
    said, words = words, _plainer(words, scene)
    parts = _units(words, scene)
    placed = arranged(parts)
    if placed is not None:
        words, parts = placed, _units(placed, scene)
    if keys(said) != keys(words):
        trace.note("words", f"taken as “{plain(words)}”")
    best = _read(words, (), situation, hints, targets, parts, told, "as it is said")
    readings = [best]
    changes = bool(best.action.queue and best.action.system_cmd)
    made_out = settled and best.judged.cost <= 0 and not _is_idle(best)
    tells = all(unit.kind in {"told", "reason"} for unit in parts)
    ordered = None if changes or made_out or tells else plainly_ordered(message, scene)
    if ordered is not None and not ordered.against:
        how = f"in plain orders, “{plain(ordered.words)}”"
        readings.append(_read(ordered.words, (), situation, hints, targets, parts, told, how))
        best = _more_sense(best, readings[-1])
    stories = any(unit.kind in {"told", "reason"} for unit in parts)
    if readings[0].judged.cost > 0 and (best.judged.cost > 0 or stories):
        for how, others, about in _others(words, parts, scene):
            readings.append(_read(others, about, situation, hints, targets, parts, told, how))
            better = readings[-1].judged.cost < best.judged.cost
            if better or (
                stories and readings[-1].judged.cost == best.judged.cost and best is not readings[0]
            ):
                best = readings[-1]
    if ordered is not None and ordered.unable and not ordered.against:
        best = _unable(best, ordered.unable, scene)
    trace.decisions += best.trace.decisions
    if len(readings) > 1:
        for reading in readings:
            taken = ", taken" if reading is best else ""
            trace.note("reading", f"{reading.how}: against it {reading.judged}{taken}")
    action = _honest(best, scene)
    sources = tuple(dict.fromkeys((*scene.sources, *action.sources)))
    return action.model_copy(update={"sources": sources}) if scene.sources else action


def _changed_plan(
    words: Phrase, situation: Situation, hints: Sequence[str], trace: Trace, targets: tuple[str, ...]
) -> ChatAction | None:
    """What a message changes of the plan, before anything in it is put in other words."""
    if not situation.queue:
        return None
    reader = Reader(Scene.of(situation, hints, Trace()), targets=targets)
    action = reader.changed_plan(words)
    if action is not None:
        trace.decisions += reader.scene.trace.decisions
    return action


def _is_idle(reading: _Reading) -> bool:
    """Whether nothing is done or asked, and nothing changed but what is remembered."""
    action = reading.action
    told = all(command.command == "add_memory" for command in action.system_cmd)
    return told and not action.queue and not action.choices


def _more_sense(said: _Reading, ordered: _Reading) -> _Reading:
    """The message as it is said, or the plain orders that the grammar finds in it."""
    if ordered.judged.cost < said.judged.cost:
        return ordered
    judged = ordered.judged
    fails = judged.lost or judged.nonsense or judged.unable or judged.partly or judged.asks
    if fails or not ordered.action.queue:
        return said
    better = said.judged.cost > 0 or _is_idle(said) or _about(ordered) > _about(said) > set()
    return ordered if better else said


def _unable(reading: _Reading, words: Phrase, scene: Scene) -> _Reading:
    """What was not understood, though it is plain that something is asked for: that cannot be done."""
    judged = reading.judged
    if reading.action.queue or reading.action.system_cmd or not (judged.lost or judged.nonsense):
        return reading
    text = cannot(plain(words), scene)
    return replace(reading, action=reading.action.model_copy(update={"message_response": text}))


def _about(reading: _Reading) -> set[str]:
    """The words that the steps of a reading are about."""
    return {key for text in texts_of(reading.action.queue) for key in keys(tokens(text)) if key not in _SMALL}


def _honest(reading: _Reading, scene: Scene) -> ChatAction:
    """Without looks at what nothing can be called: the operator is told what was not understood."""
    queue = reading.action.queue
    odd = [step for step in queue if is_odd(step, scene)]
    if not odd or any(step.flow is not None for step in queue):
        return reading.action
    words = " and ".join(f"“{value}”" for step in odd for value in texts_of([step]))
    kept = tuple(step for step in queue if step not in odd)
    said = re.sub(r"I will (?!remember)[^.]*\.", "", reading.action.message_response).strip()
    said = f"{said} " if said else ""
    text = f"{said}I did not understand {words}. Please say it in other words."
    return reading.action.model_copy(update={"queue": kept, "message_response": text})


def _units(words: Phrase, scene: Scene) -> list[Unit]:
    return units(words, Names(scene).is_stop, lambda part: opens_command(part, scene.catalogue.verbs))


def _settled(words: Phrase, scene: Scene) -> Phrase:
    """With what is taken back gone, and lists as sentences."""
    is_stop = Names(scene).is_stop
    words = back_to_first(verb_first(unnumbered(when_done(without_end(words))), is_stop), is_stop)
    if {"each", "all", "both", "them"} & set(keys(words)):
        words = each_in_turn(_units(words, scene)) or words
    return corrected(words, is_stop, lambda part: opens_command(part, scene.catalogue.verbs))


def _plainer(words: Phrase, scene: Scene) -> Phrase:
    """With stops in the order that is said of them."""
    is_stop = Names(scene).is_stop

    def opens(part: Phrase) -> bool:
        return opens_command(part, scene.catalogue.verbs)

    words = waiting_there(words, is_stop)
    words = done_first(words, is_stop, opens)
    return in_sequence(words, is_stop) or with_articles(words, is_stop)


def _others(
    words: Phrase, parts: Sequence[Unit], scene: Scene
) -> Iterator[tuple[str, Phrase, Sequence[Phrase]]]:
    """Other ways to read a message: what they are called, their words, and what was told of before."""
    if all(
        unit.kind in {"told", "reason", "asked"} or (unit.kind == "idle" and not unit.names) for unit in parts
    ):
        return
    orders = distilled(parts)
    if orders is not None and keys(orders) != keys(words):
        yield (
            f"only what is asked for, “{plain(orders)}”",
            orders,
            context(parts, [item.fact.subject for item in scene.facts]),
        )


def _read(
    words: Phrase,
    about: Sequence[Phrase],
    situation: Situation,
    hints: Sequence[str],
    targets: tuple[str, ...],
    parts: Sequence[Unit],
    told: tuple[Fact, ...],
    how: str,
) -> _Reading:
    trace = Trace()
    scene = Scene.of(situation, hints, trace)
    reader = Reader(scene, targets=targets, about=tuple(about), told=told)
    action = reader.read(words)
    return _Reading(action, judge(action, reader.trouble, parts, scene), trace, how)
