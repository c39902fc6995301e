"""One decision of all that a message says: certain, or a question."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from parley.language.base import Situation
from parley.language.builtin.answers import answer
from parley.language.builtin.decision import Answer, Ask, Control, Decision, Deed, Do, Remember, Told
from parley.language.builtin.deeds import Builder
from parley.language.builtin.facts import places, told_of
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading
from parley.language.builtin.skills import Skills
from parley.language.builtin.spans import Parse
from parley.language.builtin.wishes import Wish
from parley.language.control import control_of

__all__ = ["AGREED", "ALONE", "decide"]

AGREED = 0.3
"""So much the tagger must believe in the least certain part of a wish that the lexicon agrees with."""
ALONE = 0.75
"""So much where the lexicon does not know the verb."""


def decide(
    situation: Situation,
    parse: Parse,
    reading: Reading,
    skills: Skills,
    lexicon: Lexicon,
    reader: Callable[[str], Reading],
) -> Decision:
    """What to do, ask, remember or say."""
    starts = [token.start for token in parse.tokens]
    told = told_of(reading, situation.message, starts, lexicon)
    orders = tuple(
        wish
        for wish in reading.wishes
        if wish.act in ("order", "edit", "answer") and wish.frame not in _NO_DEED
    )
    if not orders:
        return _without_order(situation, reading, told, lexicon, reader)
    doubt = _doubt(reading, orders) or _amends(situation, parse, lexicon) or _for_another(situation, reading)
    if doubt is not None:
        return replace(doubt, told=told)
    builder = Builder(situation, skills, lexicon, places(situation.memory, reader, lexicon))
    deeds: list[Deed] = []
    builder.told_about(reading.about)
    if reading.manner:
        builder.unheeded(" ".join(reading.manner))
    for filler in reading.loose:
        builder.loose(filler)
    for wish in reading.wishes:
        if wish.frame == "BELOC":
            for filler in wish.fillers:
                builder.loose(filler)
        if wish not in orders:
            continue
        made = builder.deeds(wish)
        if isinstance(made, Ask):
            return replace(made, told=told)
        deeds += _without_repeats(deeds, made)
    return Do(tuple(deeds), tuple(builder.notes), told)


def _without_repeats(deeds: list[Deed], more: list[Deed]) -> list[Deed]:
    """Without the way to where the last deeds have led already."""
    ways = [deed for deed in deeds if deed.frame == "GO"]
    size = len([deed for deed in more if deed.frame == "GO"])
    there = 0 < size < len(more) and deeds and deeds[-1].frame == "GO" and ways[-size:] == more[:size]
    return more[size:] if there else more


_NO_DEED = frozenset({"BELOC", "BECAT", "REMEMBER", "FORGET"})


def _doubt(reading: Reading, orders: tuple[Wish, ...]) -> Ask | None:
    """Why an order is not certain enough to be carried out."""
    if reading.left_over:
        return Ask(
            f"I do not understand “{' '.join(reading.left_over)}” in this. Please say it in other words."
        )
    if (
        "alarm" in reading.acts
        or "question" in reading.acts
        or "control" in reading.acts
        or "edit" in reading.acts
    ):
        return Ask("I am not sure what you want me to do. Please say one thing at a time.")
    for wish in orders:
        weak = wish.share < (AGREED if wish.witness == "agrees" else ALONE)
        if weak or wish.witness == "differs":
            what = f"“{wish.verb}”" if wish.verb else f"“{wish.fillers[0].text}”"
            return Ask(f"I am not sure what you mean by {what}. Please say it in other words.")
    for filler in reading.loose:
        if filler.role not in ("A", "T", "L", "M"):
            return Ask(f"I do not understand what “{filler.text}” belongs to. Please say it in other words.")
    return None


def _amends(situation: Situation, parse: Parse, lexicon: Lexicon) -> Ask | None:
    """A change of the plan that runs is not an order behind it."""
    words = [token.text for token in parse.tokens if token.low in lexicon.classes["amending"]]
    if not situation.queue or not words:
        return None
    return Ask(
        f"Is “{words[0]}” meant to change my plan? I cannot do that yet: cancel it, then say all anew."
    )


def _for_another(situation: Situation, reading: Reading) -> Ask | None:
    """An order to somebody else is not carried out by this robot."""
    called = {word for filler in reading.loose if filler.role == "A" for word in filler.words}
    other = next(
        (name for name in situation.robots if name.lower() in called and name != situation.robot), None
    )
    return Ask(f"Is that for {other}? Please say it to {other}.") if other else None


def _without_order(
    situation: Situation,
    reading: Reading,
    facts: tuple[Told, ...],
    lexicon: Lexicon,
    reader: Callable[[str], Reading],
) -> Decision:
    command = control_of(situation.message, situation.robots)
    if command is not None:
        return Control("stop" if command == "emergency_stop" else command)
    if "alarm" in reading.acts:
        return Answer(
            "That sounds like an emergency. I cannot help with my own hands: please call somebody who can. "
            "Shall I go somewhere or tell somebody something?"
        )
    if facts:
        return Remember(facts)
    if "question" in reading.acts:
        return answer(situation, reading, lexicon, reader)
    if "need" in reading.acts:
        return Ask("What can I do about it? Tell me what to bring, or where to go.")
    if reading.acts <= {"social"}:
        return Answer("Hello. Tell me what I can do for you.")
    if "told" in reading.acts:
        return Ask("I did not understand that as a fact about where something is. What shall I do with it?")
    return Ask("I did not understand that. Please say what I should do, and with what.")
