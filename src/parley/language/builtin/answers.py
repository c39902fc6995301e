"""Answers to questions, from the map and from what is remembered; never from sentences made up."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.base import Situation
from parley.language.builtin.decision import Answer
from parley.language.builtin.facts import known_place, places
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading
from parley.language.builtin.saying import with_article
from parley.language.builtin.things import link, noun_phrase

__all__ = ["answer"]


def answer(
    situation: Situation, reading: Reading, lexicon: Lexicon, reader: Callable[[str], Reading]
) -> Answer:
    """What is known about what is asked for."""
    fillers = [*(filler for wish in reading.wishes for filler in wish.fillers), *reading.loose]
    thing = next((filler for filler in fillers if filler.role == "T"), None)
    if thing is not None:
        name, _ = noun_phrase(thing.words, thing.head, lexicon)
        place = known_place(name, places(situation.memory, reader, lexicon))
        if place is not None:
            return Answer(f"I remember: {place.memory.data.rstrip('.')}.", (place.memory.name,))
        mention = link(thing.words, thing.head, situation.objects, lexicon)
        if mention.kind in ("one", "several"):
            named = " and ".join(with_article(item.description) for item in mention.things)
            return Answer(f"On my map there is {named}.")
        return Answer(f"I do not know anything about {with_article(mention.text)}.")
    return Answer("I cannot answer that. I can tell where a thing is, if it is on my map or was told to me.")
