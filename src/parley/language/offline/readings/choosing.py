"""Reads a message in more ways than one, where the first does not make enough sense, and takes the best."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

from parley.language.base import Situation
from parley.language.offline.dialogue.turning import turned
from parley.language.offline.facts.declared import laid_down
from parley.language.offline.facts.facts import Fact
from parley.language.offline.facts.framed import told_plainly
from parley.language.offline.facts.groups import with_members
from parley.language.offline.facts.nicknames import by_their_real_names, remembered_plainly
from parley.language.offline.facts.noting import mention_listed
from parley.language.offline.facts.plain_names import plainly_named
from parley.language.offline.grammar.canonical import Plainly, plainly_ordered
from parley.language.offline.reader import Reader
from parley.language.offline.readings.by_catalogue import asked_of_catalogue
from parley.language.offline.readings.exceptions import unknown_exception, which_of_those, with_answer
from parley.language.offline.readings.judging import Judgement, gone_to, is_odd, judge, texts_of
from parley.language.offline.readings.kinds import (
    complains,
    done_by_others,
    only_news,
    only_to_be_seen_to,
    with_undone_deeds,
    without_vague_orders,
)
from parley.language.offline.readings.parts import Parts
from parley.language.offline.readings.told_besides import with_what_is_told
from parley.language.offline.repair.replies import agrees
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.grouping import grouped, ids_in, names_things
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.sought import thought_there
from parley.language.offline.sentences.arranging import arranged, each_in_turn, without_end
from parley.language.offline.sentences.branching import branched
from parley.language.offline.sentences.briefly import briefly
from parley.language.offline.sentences.conditioning import as_conditions, awaited_first
from parley.language.offline.sentences.correcting import corrected
from parley.language.offline.sentences.distilling import context, distilled, with_the_same
from parley.language.offline.sentences.expecting import with_looks
from parley.language.offline.sentences.named import back_to_first, verb_first, with_articles
from parley.language.offline.sentences.numbering import unnumbered
from parley.language.offline.sentences.scoping import scoped
from parley.language.offline.sentences.talk import without_talk
from parley.language.offline.sentences.told import told_apart, when_done
from parley.language.offline.sentences.under_way import under_way
from parley.language.offline.sentences.units import Unit
from parley.language.offline.tasks.abilities import cannot
from parley.language.offline.tasks.helping import helping, is_drastic
from parley.language.offline.tasks.tasks import Tasks
from parley.language.offline.words.explaining import Trace
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.messages.chat import ChatAction

__all__ = ["best_reading"]

_SMALL = frozenset({"the", "a", "an", "is", "are", "whether", "of", "in", "at", "on", "it", "any", "and"})
"""What makes no difference to what a step is about."""


@dataclass(frozen=True, slots=True)
class _Reading:
    action: ChatAction
    judged: Judgement
    trace: Trace
    how: str
    words: Phrase = ()
    about: tuple[Phrase, ...] = ()
    """What was told of before those words."""
    reported: bool = False
    """Whether it only looks at what was reported."""


_Reread = Callable[[Phrase, Sequence[Phrase], str], _Reading]


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
    scene = Scene.of(situation, hints)
    cut = Parts(scene)
    is_stop = cut.names.is_stop
    words = thought_there(by_their_real_names(remembered_plainly(words, scene), scene), scene)
    words = _to_the_point(told_plainly(words), cut, trace)
    changed = _changed_plan(words, situation, hints, trace, targets)
    if changed is not None:
        return changed
    words = with_looks(under_way(words), is_stop)
    told, words = laid_down(told_plainly(words), scene)
    mention_listed(told, scene)
    words = without_vague_orders(words, cut.of(words))
    words = with_undone_deeds(words, cut.of(words), scene)
    named = cache(lambda said: plainly_named(with_members(said, told), scene))
    whole = named(words)
    words = _settled(words, cut)
    names = names_things(scene)
    raw = with_answer(words, list(hints), scene)
    put_together = grouped(raw, scene)
    if (left_out := unknown_exception(put_together)) is not None:
        return _which_to_leave_out(put_together[left_out[0] : left_out[1]], targets, scene)
    kept = scoped(put_together, names, lambda part: False, ids_in(scene))
    spared = kept.spared
    if not situation.queue:
        shaped = as_conditions(kept.words, names, scene.is_person)
        words = branched(shaped, names, lambda asked: turned(asked, scene))
    hangs = keys(words) != keys(kept.words)
    if hangs and (event := awaited_first(words)) and not _can_wait(scene):
        return _when_it_happens(event, targets, scene)
    plainer = not situation.queue and (spared or hangs)
    free = not (plainer or situation.queue)
    # Where no group was found at all, none is without pronouns.
    groups = raw if plainer or put_together == raw else grouped(raw, scene, pronouns=False)
    message = named(words if plainer else groups)
    # What was left out or put together already, the plain orders of the whole message would bring back.
    settled = keys(put_together) != keys(words)
    words = named(words)
    said, words = words, with_articles(words, is_stop)
    parts = cut.of(words)
    placed = arranged(parts)
    if placed is not None:
        words, parts = placed, cut.of(placed)
    if keys(said) != keys(words):
        trace.note("words", f"taken as “{plain(words)}”")
    best = _read(words, (), situation, hints, targets, parts, told, "as it is said", spared)
    readings = [best]
    made_out = settled and best.judged.cost <= 0 and not _is_idle(best)
    tells = all(unit.kind in {"told", "reason"} for unit in parts)
    all_said = whole if free and keys(whole) != keys(message) else ()
    ordered, as_said = (None, None) if made_out or tells else _plain_orders(message, all_said, best, scene)

    def reread(said: Phrase, about: Sequence[Phrase], how: str) -> _Reading:
        known = next((one for one in readings if (one.words, one.about) == (said, tuple(about))), None)
        if known is None:
            known = _read(said, about, situation, hints, targets, parts, told, how, spared)
            readings.append(known)
        return known

    best = _in_plain_orders(best, ordered, as_said, reread)
    if readings[0].judged.cost > 0:
        best = _read_otherwise(best, readings[0], _others(words, parts, scene), parts, reread)
    wanted = kept.words if len(kept.words) < len(put_together) else message
    best = best if spared else _offered(best, wanted, parts, cut, reread)
    if ordered is not None and ordered.unable and not ordered.against:
        best = _unable(best, ordered.unable, scene)
    besides = with_what_is_told(best.action, readings[0].action, parts)
    best = best if besides is best.action else replace(best, action=besides)
    best = _helpful(best, message, parts, situation, hints, targets, scene)
    trace.decisions += best.trace.decisions
    for reading in readings if len(readings) > 1 else ():
        taken = ", taken" if reading.trace is best.trace else ""
        trace.note("reading", f"{reading.how}: against it {reading.judged}{taken}")
    action = _sparing(best, spared, scene) or which_of_those(best.action, scene) or _honest(best, scene)
    sources = tuple(dict.fromkeys((*scene.sources, *action.sources)))
    return action.model_copy(update={"sources": sources}) if scene.sources else action


def _offered(best: _Reading, message: Phrase, parts: Sequence[Unit], cut: Parts, reread: _Reread) -> _Reading:
    """The reading by what the robot offers, where that makes more of the message than the best one so far."""
    if any(step.flow is not None for step in best.action.queue) or only_news(parts, cut.scene):
        return best

    def tells(sentence: Phrase) -> bool:
        return all(unit.kind in {"told", "reason", "idle"} for unit in cut.of(sentence))

    asked = asked_of_catalogue(message, tells, cut.scene)
    if asked is None:
        return best
    found = reread(asked.words, (), f"by what the robot offers, “{plain(asked.words)}”")
    judged = found.judged
    if judged.lost or judged.nonsense or judged.unable or judged.asks or not found.action.queue:
        return best
    if any(step.flow is not None for step in found.action.queue):
        return best
    did, does = _calls(best), _calls(found)
    more = best.judged.cost > judged.cost or _is_idle(best)
    about = [call for call in does if " " in call]
    same = set(did) == set(does) and len(set(about)) == len(about)
    reordered = did != does and ((asked.ranked and same) or sorted(did) == sorted(does))
    more = more or (asked.own and len(does) > len(did)) or ((asked.own or asked.ranked) and reordered)
    more = more or (asked.own and _done_where_gone(best, found, cut.scene))
    return found if more else best


def _done_where_gone(one: _Reading, other: _Reading, scene: Scene) -> bool:
    """Whether a reading only goes where another does something ("empty A, B afterwards")."""
    mover, pairs = scene.catalogue.mover, list(zip(one.action.queue, other.action.queue, strict=False))
    differ = [(a, b) for a, b in pairs if (a.name, texts_of([a])) != (b.name, texts_of([b]))]
    same_length = len(one.action.queue) == len(other.action.queue)
    gone = mover is not None and all(
        a.name == mover.name and texts_of([a]) == texts_of([b]) for a, b in differ
    )
    return same_length and gone and bool(differ)


def _helpful(
    best: _Reading,
    message: Phrase,
    parts: Sequence[Unit],
    situation: Situation,
    hints: Sequence[str],
    targets: tuple[str, ...],
    scene: Scene,
) -> _Reading:
    """With what helps against what is only told, where nothing else comes of it."""
    if not (_is_idle(best) or best.reported or only_to_be_seen_to(parts)) or not complains(parts, scene):
        return best
    match = helping(message, scene, done_by_others(parts, scene))
    if match is None or (is_drastic(match) and not _is_idle(best)):
        return best
    trace = Trace()
    agreed = any(agrees(hint) for hint in hints)
    reader = Reader(Scene.of(situation, hints, trace), targets=targets)
    trace.note("action", f"{match.info.name}: it helps with what is told ({match.score:.1f})")
    return _Reading(reader.help_with(match, message, agreed=agreed), best.judged, trace, "what helps")


def _calls(reading: _Reading) -> list[str]:
    """The steps of a reading, each with what it is about."""
    return [" ".join((step.name, *texts_of([step]))) for step in reading.action.queue]


def _plain_orders(
    message: Phrase, whole: Phrase, said: _Reading, scene: Scene
) -> tuple[Plainly | None, Plainly | None]:
    """The plain orders of a message, if they settle anything, and those of all its words."""
    if _only_answers(message, said):
        return None, None
    ordered = plainly_ordered(message, scene)
    as_said = plainly_ordered(whole, scene) if whole else None
    ordered = as_said if as_said is not None and as_said.certain else ordered
    return ordered if _settles(ordered, said) else None, as_said


def _only_answers(message: Phrase, said: _Reading) -> bool:
    """Whether a message is one question ("is A in B?") that is answered without doing anything."""
    inner = {".", "!", "?", ";", ","} & set(keys(message[:-1]))
    asks = keys(message[:1]) and message[0].key in lexicon().be
    return bool(asks and not inner and said.judged.cost <= 0 and not said.action.queue)


def _which_to_leave_out(described: Phrase, targets: tuple[str, ...], scene: Scene) -> ChatAction:
    """A question about an exception that nothing tells."""
    text = f"I do not know which one you mean by “{plain(described)}”. Which one should I leave out?"
    robot = scene.situation.robot
    return ChatAction(message_response=text, targets=targets or ((robot,) if robot else ()))


def _can_wait(scene: Scene) -> bool:
    """Whether there is a way to wait for something to happen: an action for it, or somebody to ask."""
    catalogue = scene.catalogue
    waits = any("wait" in name_words(info.name) for info in catalogue.infos)
    return waits or catalogue.with_role("ask_operator") is not None


def _when_it_happens(event: Phrase, targets: tuple[str, ...], scene: Scene) -> ChatAction:
    """What is to be done only when something has happened must not be done at once."""
    text = f"I cannot notice by myself when {plain(event)}. Please tell me again then."
    robot = scene.situation.robot
    return ChatAction(message_response=text, targets=targets or ((robot,) if robot else ()))


def _changed_plan(
    words: Phrase, situation: Situation, hints: Sequence[str], trace: Trace, targets: tuple[str, ...]
) -> ChatAction | None:
    """What a message changes of the plan, before anything in it is put in other words."""
    if not situation.queue:
        return None
    reader = Reader(Scene.of(situation, hints, Trace()), targets=targets, reread=_read_again)
    action = reader.changed_plan(words)
    if action is not None:
        trace.decisions += reader.scene.trace.decisions
    return action


def _is_idle(reading: _Reading) -> bool:
    """Whether nothing is done or asked, and nothing changed but what is remembered."""
    action = reading.action
    told = all(command.command == "add_memory" for command in action.system_cmd)
    return told and not action.queue and not action.choices


def _in_plain_orders(
    best: _Reading, ordered: Plainly | None, as_said: Plainly | None, reread: _Reread
) -> _Reading:
    """The plain orders that the grammar finds, or the reading so far if they make no more sense.

    Args:
        best: The reading so far.
        ordered: The orders of the message as it was put plainly.
        as_said: The orders of the message word for word, for what is still wrong then.
        reread: Reads other words.
    """
    same = ordered is not None and as_said is not None and keys(ordered.words) == keys(as_said.words)
    for plainer in (ordered,) if same or as_said is ordered else (ordered, as_said):
        again = plainer is as_said is not ordered
        if plainer is None or plainer.against or (again and best.judged.cost <= 0):
            continue
        found = reread(plainer.words, (), f"in plain orders, “{plain(plainer.words)}”")
        best = _more_sense(best, found, certain=plainer.certain)
    return best


def _read_otherwise(
    best: _Reading,
    first: _Reading,
    others: Iterator[tuple[str, Phrase, Sequence[Phrase]]],
    parts: Sequence[Unit],
    reread: _Reread,
) -> _Reading:
    """The best of the other ways to read a message, where the first one makes too little sense."""
    stories = any(unit.kind in {"told", "reason"} for unit in parts)
    if best.judged.cost <= 0 and not stories:
        return best
    for how, words, about in others:
        found = reread(words, about, how)
        equal = found.judged.cost == best.judged.cost and best is not first
        if found.judged.cost < best.judged.cost or (stories and equal and not _says_less(found, best)):
            best = found
    return best


def _settles(ordered: Plainly | None, said: _Reading) -> bool:
    """Whether plain orders may say better what a message asks for."""
    if ordered is None or _changes_pending(said):
        return False
    both = bool(said.action.queue and said.action.system_cmd)
    return ordered.certain or not both or said.judged.cost > 0


def _changes_pending(reading: _Reading) -> bool:
    """Whether more comes of it than steps and memories."""
    return any(command.command != "add_memory" for command in reading.action.system_cmd)


def _more_sense(said: _Reading, ordered: _Reading, *, certain: bool) -> _Reading:
    """The message as it is said, or the plain orders that the grammar finds in it."""
    if ordered.judged.cost < said.judged.cost:
        return ordered
    judged = ordered.judged
    fails = judged.lost or judged.nonsense or judged.unable or judged.partly or judged.asks
    if fails or not ordered.action.queue:
        return said
    better = certain or said.judged.cost > 0 or _is_idle(said) or _about(ordered) > _about(said) > set()
    return ordered if better else said


def _says_less(reading: _Reading, other: _Reading) -> bool:
    """Whether a reading leaves out what another one makes of a message, and adds nothing to it."""
    said, whole = _about(reading), _about(other)
    fewer = len(reading.action.queue) < len(other.action.queue)
    return bool(other.action.queue) and (said < whole or (said == whole and fewer))


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


def _sparing(reading: _Reading, spared: frozenset[str], scene: Scene) -> ChatAction | None:
    """A question instead of a plan that does what was forbidden; a word of assent where that is all."""
    wrong = gone_to(reading.action, scene) & spared
    told = reading.judged.lost and not reading.action.system_cmd and "," not in scene.situation.message
    about = wrong or (spared if told else frozenset())
    if not about:
        return None
    names = listing([the(describe(item, scene.objects)) for item in scene.objects if item.id in about])
    text = f"All right, I will leave {names} alone."
    if wrong:
        text = f"I understood that I should leave {names} alone. What should I do instead?"
    return ChatAction(message_response=text, targets=reading.action.targets)


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


def _is_ours(part: Unit, words: Phrase, scene: Scene) -> bool:
    """For "we have to prepare for A": what people do themselves, if the robot does no such things."""
    ours = keys(words[part.start : part.start + 3]) in {
        ("we", "have", "to"),
        ("we", "need", "to"),
        ("i", "have", "to"),
    }
    found = (
        lexicon().verbs.match(keys(part.words)) if ours and part.kind == "order" and not part.names else None
    )
    usual = found is None or not found[1].startswith("other:")
    return ours and not usual and Tasks(scene).own_match(part.words, weak=True) is None


def _to_the_point(words: Phrase, cut: Parts, trace: Trace) -> Phrase:
    """A message without who is speaking and what is only said to the listener."""
    words = briefly(words)
    ended = without_end(words)
    parts = cut.of(ended)
    for part in parts if len(parts) > 1 else ():
        trace.note("part", f"{part.kind}: “{plain(part.words)}” ({part.why})")
    ours = [part for part in parts if _is_ours(part, ended, cut.scene)]
    orders = any(part.kind == "order" and part not in ours for part in parts)
    parts = [replace(part, kind="mood") if orders and part in ours else part for part in parts]
    kept = without_talk(ended, parts)
    kept = kept if keys(kept) != keys(ended) else words
    if any(part.same for part in parts):
        kept = with_the_same(kept, cut.of(kept))
    if keys(kept) != keys(words):
        trace.note("words", f"to the point, “{plain(kept)}”")
    return kept


def _settled(words: Phrase, cut: Parts) -> Phrase:
    """With what is taken back gone, and lists as sentences."""
    is_stop = cut.names.is_stop
    words = back_to_first(verb_first(unnumbered(when_done(without_end(words))), is_stop), is_stop)
    if {"each", "all", "both", "them", "those", "these"} & set(keys(words)):
        words = each_in_turn(cut.of(words)) or words
    words = corrected(words, is_stop, cut.opens)
    return told_apart(words, cut.of(words)) if "," in keys(words) else words


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
    spared: frozenset[str],
) -> _Reading:
    trace = Trace()
    scene = Scene.of(situation, hints, trace)
    reader = Reader(scene, targets=targets, about=tuple(about), told=told, reread=_read_again)
    action = reader.read(words)
    judged = judge(action, reader.trouble, parts, scene, spared)
    return _Reading(action, judged, trace, how, words, tuple(about), reader.reported)


def _read_again(words: Phrase, situation: Situation) -> ChatAction:
    """Understand an earlier message once more."""
    return best_reading(words, situation, (), Trace(), ())
