"""A message said plainly: the orders in it, in the words that the reader knows best."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.grammar.composing import compose
from parley.language.offline.grammar.drafting import Plan, Step
from parley.language.offline.grammar.parsing import parse
from parley.language.offline.grammar.small import base, small
from parley.language.offline.scene.grouping import grouped
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, plain, tokens

__all__ = ["Plainly", "plainly_ordered"]

_STOP = Word(".", ".")


@dataclass(frozen=True, slots=True)
class Plainly:
    """What a message asks for, in plain orders."""

    words: Phrase
    unable: Phrase = ()
    """What is asked for, where nothing but things are asked for that nobody here knows how to do."""
    certain: bool = False
    """Whether nothing else reads it as well."""
    against: tuple[str, ...] = ()
    """Why it may be wrong; nothing if every word of an order was understood."""


def plainly_ordered(words: Phrase, scene: Scene) -> Plainly | None:
    """The orders of a message in plain words; None if it has none.

    Args:
        words: All words and punctuation, mended.
        scene: What is known.
    """
    if not scene.objects:
        return None
    plan = compose(parse(grouped(words, scene, pronouns=False), scene), scene.is_person)
    if "no order" in plan.against:
        return None
    against = [*plan.against, *(["pending steps are named"] if _edits(plan, scene) else [])]
    return Plainly(_written(plan), _strange(plan), plan.certain and not against, tuple(against))


def _strange(plan: Plan) -> Phrase:
    """The first order, if all of them are in verbs that are neither going nor looking."""
    if not plan.steps or any(step.kind != "other" or not step.words for step in plan.steps):
        return ()
    words = plan.steps[0].words
    return words if small().verbs.get(base(words[0].key)) == "other" and len(words) > 1 else ()


def _edits(plan: Plan, scene: Scene) -> bool:
    """Whether pending steps are named: then the plan is to be changed."""
    pending = {
        str(parameter.value).lower()
        for step in scene.situation.queue
        for parameter in step.input_parameters.values()
    }
    named = (scene.ground(step.place).candidates[:1] for step in plan.steps if step.place)
    return any({item.id.lower(), item.description.lower()} & pending for found in named for item in found)


def _written(plan: Plan) -> Phrase:
    result: list[Word] = []
    for step in plan.steps:
        result += [*_conditioned(step), _STOP]
    return tuple(result)


def _conditioned(step: Step) -> Phrase:
    words = _said(step)
    if not step.hangs or not words:
        return words
    if not step.condition:
        lead = tokens("otherwise" if step.otherwise else "if so")
    else:
        lead = (*tokens("unless" if step.otherwise else "if"), *step.condition)
    return (*lead, Word(",", ","), *words)


def _said(step: Step) -> Phrase:
    place = _named(step.place)
    match step.kind:
        case "go":
            return (*tokens("go to"), *place)
        case "look":
            return (*tokens("look at"), *place)
        case "search" | "count":
            verb = tokens("look for" if step.kind == "search" else "count the")
            if not place:
                return (*tokens("find"), *step.what)
            return (*verb, *step.what, Word("at", "at"), *place)
        case "whether":
            what = turned_round(step.what)
            asks = keys(what[:1]) in {("how",), ("what",), ("who",)}
            # What hangs on a condition is one order, so that all of it does.
            joint = Word("and", "and") if step.hangs else _STOP
            lead = (*tokens("go to"), *place, joint) if place else ()
            return (*lead, *(tokens("check") if asks else tokens("check whether")), *what)
    return step.words


def turned_round(words: Phrase) -> Phrase:
    """For "is anything stuck" "anything is stuck"."""
    if keys(words[:1])[:1] and words[0].key in lexicon().be | lexicon().auxiliaries and len(words) > 2:
        behind = (i for i in range(2, len(words)) if words[i].key in small().prepositions | {"there", "here"})
        end = min(next(behind, len(words) - 1), len(words) - 1)
        end = 2 if words[1].key in small().sets["plain_subjects"] else max(end, 2)
        verb = Word(words[0].key, words[0].key)
        return (*words[1:end], verb, *words[end:])
    return words


def _named(phrase: Phrase) -> Phrase:
    if not phrase or phrase[0].key in {"any", "the"}:
        return phrase
    return tokens(the(plain(phrase)))
