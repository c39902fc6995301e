"""Answers to questions, from the map and from what is remembered; never from sentences made up."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Container, Sequence
from dataclasses import replace
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.decision import Answer
from parley.language.builtin.facts import known_place, places
from parley.language.builtin.in_rooms import inside, room_in
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.saying import as_said, listed, with_article
from parley.language.builtin.spatial import picked
from parley.language.builtin.things import link, noun_phrase
from parley.language.builtin.tokens import Token, tokenize
from parley.language.dialogue.map_words import Named, distance_m, lies, named, named_alone, whereabouts
from parley.language.lexicon import word_set
from parley.world.object_map import MapObject

__all__ = ["answer", "look_asked_for", "most_asked", "sought"]


_IN_M: Final = 0.5
_NO_ANSWER: Final = "I cannot answer that. I can tell where a thing is, if it is on my map or was told to me."


def answer(
    situation: Situation,
    reading: Reading,
    lexicon: Lexicon,
    reader: Callable[[str], Reading],
    before: MapObject | None = None,
) -> Answer:
    """What is known about what is asked for; "it" is what was spoken of `before`."""
    if each := sought(situation.message):
        asked = [replace(situation, message=f"where is {one}?") for one in each]
        found = [answer(one, reader(one.message), lexicon, reader) for one in asked]
        return Answer(
            " ".join(one.text for one in found), tuple(name for one in found for name in one.sources)
        )
    fillers = [*(filler for wish in reading.wishes for filler in wish.fillers), *reading.loose]
    thing = next((filler for filler in fillers if filler.role == "T"), None)
    if len(most := most_asked(tokenize(situation.message), situation, lexicon)) == 1:
        return Answer(_lying(situation, most[0]))
    if thing is None:
        return _without_thing(situation, lexicon, before)
    mention = link(thing.words, thing.head, situation.objects, lexicon)
    if mention.kind == "pronoun":
        return _spoken_of(situation, before)
    name, _ = noun_phrase(thing.words, thing.head, lexicon)
    others = (one for one in situation.robots if one != situation.robot)
    if robot := next((one for one in others if one.lower() == " ".join(name)), ""):
        return Answer(f"{robot} is a robot. Ask {robot}: “{robot}, where are you?”")
    place = known_place(name, places(situation.memory, reader, lexicon))
    if place is not None:
        return Answer(f"I remember: {place.memory.data.rstrip('.')}.", (place.memory.name,))
    told = None if "where" in situation.message.lower() else _kept(situation, lexicon)
    if mention.kind == "one":
        tokens = tokenize(situation.message)
        if not told and look_asked_for(tokens, named(tokens, situation.objects, lexicon)):
            return Answer("How that is now I only see when I look there.")
        if tokens[0].low in _NOT_WHERE and not {"where", "know", "way"} & {token.low for token in tokens}:
            return told or Answer(_NO_ANSWER)
        return told or Answer(_lying(situation, mention.things[0]))
    if mention.kind == "several":
        return told or _among(mention.things, situation, lexicon)
    if {*thing.words} & _ANY:
        return Answer(_NO_ANSWER)
    shown = with_article(as_said(mention.text, situation.message))
    return _kept(situation, lexicon) or Answer(f"I do not know anything about {shown}.", unknown=shown)


def _without_thing(situation: Situation, lexicon: Lexicon, before: MapObject | None) -> Answer:
    """What is known where the words were not read as asking for a thing, though they may name one."""
    if _is_about_failure(situation, lexicon):
        return _spoken_of(situation, before)
    names = named_alone(tokenize(situation.message), situation.objects, lexicon)
    if "where" in situation.message.lower() and len(names) == 1:  # "where is area A?"
        return Answer(_lying(situation, names[0]))
    return _kept(situation, lexicon) or Answer(_NO_ANSWER)


def sought(message: str) -> tuple[str, ...]:
    """The things of "where are the pump, the gate and Kim?"; empty if fewer are asked for, or it is more."""
    found = _SOUGHT.fullmatch(" ".join(message.split()))
    return tuple(re.split(_AND, found["things"], flags=re.IGNORECASE)) if found is not None else ()


_AND: Final = r",? and (?:where(?:'s| is| are) )?|, "
_ONE: Final = r"(?:the |my |our )?(?!(?:and|the) )\w+(?: (?!(?:and|at|in|by|on|of|from|away)\b)\w+){0,2}"
_SOUGHT: Final = re.compile(
    rf"(?:\w+, )?(?:where|how far)(?:'s| is| are) (?P<things>{_ONE}(?:(?:{_AND}){_ONE})+)"
    r"(?: away| from (?:here|you))?\s*\?*",
    re.IGNORECASE,
)


def _among(things: Sequence[MapObject], situation: Situation, lexicon: Lexicon) -> Answer:
    """What the map knows of a kind: at the place that is named, else all of it."""
    tokens = tokenize(situation.message)
    if _STATE.search(situation.message) is not None:
        return Answer("How that is now I only see when I look there.")
    led = [at for at, token in enumerate(tokens) if token.low in lexicon.classes["prepositions"]]
    spots = named_alone(tokens[led[-1] :], situation.objects, lexicon) if led else []
    here = [item for item in things if any(one.gap_m(item.x_m, item.y_m) < _IN_M for one in spots)]
    words = [token.low for token in tokens if token.is_word]
    room, _ = room_in(words, situation.rooms, lexicon) if not spots else (None, ())
    here = [item for item in things if item in inside(room, situation.objects)] if room else here
    if (spots or room) and not here:
        return Answer("By my map there is none there. What is there now I only see when I look.")
    found = [with_article(item.description) for item in here or things]
    if len(found) == 1:
        return Answer(f"On my map there is {found[0]}.")
    return Answer(f"On my map there are {len(found)}: {listed(found)}.")


_STATE: Final = re.compile(
    r"^\W*(?:which|what) (?:of (?:the|your|our) )?(?:(?!(?:are|is|do|can)\b)[\w-]+ ){1,3}"
    r"(?:needs?|look|looks|seems?|(?:is|are|was|were) "
    r"(?!(?:there|on|in|at|by|near|next|behind|under|beside|closest|nearest|they|the|your|my|it|known|called|parked|kept|"
    r"standing|stored|placed|located)\b)\w)",
    re.IGNORECASE,
)
"""How things are: "which crates are open?"."""


def most_asked(tokens: Sequence[Token], situation: Situation, lexicon: Lexicon) -> tuple[MapObject, ...]:
    """What "which gate is nearest?", "where is the nearest crate to the gate?" ask for; empty for others."""
    low = [token.low for token in tokens if token.is_word]
    at = next((at for at, word in enumerate(low) if _MOST.fullmatch(word)), None)
    if at is None:
        return ()
    kind = [word for word in low[1:at] if word not in _IDLE] if low[0] in ("which", "what") else []
    most, rest = "nearest" if low[at][0] in "nc" else "farthest", low[at + 1 :]
    words = [most, *rest] if not kind else [*kind, most, *rest] if rest else [most, *kind]
    found = picked(words, situation.objects, lexicon, situation.robot_pose)
    names = named_alone(tokens, situation.objects, lexicon)
    if found is None and len(names) > 1 and (pose := situation.robot_pose) is not None:
        pick = min if most == "nearest" else max
        return (pick(names, key=lambda thing: distance_m(thing, pose)),)
    return found.things if found is not None else ()


_MOST: Final = re.compile(r"(near|clos|farth|furth)(?:est|er)")
_IDLE: Final = frozenset({"is", "'s", "are", "the", "one", "of", "them"})


def look_asked_for(tokens: Sequence[Token], names: Sequence[Named], called: Container[str] = ()) -> str:
    """The order that answers "is the gate clear?" or "is there a cat at the gate?"; empty for others.

    How something is now, no map and no memory can tell; where it is, they can.

    Args:
        tokens: Of the message.
        names: What it names on the map.
        called: Names of robots, in small letters.
    """
    ends = [at for at, token in enumerate(tokens) if token.text in ".!?;"]
    asked = next((at for at in ends if tokens[at].text == "?"), len(tokens))  # a sentence of several
    first = max((at + 1 for at in ends if at + 1 < asked), default=0)
    said = [token.low for token in tokens[first:asked] if token.is_word and token.low not in called]
    said = [word for at, word in enumerate(said) if word != "still" or at == len(said) - 1]
    low = list(itertools.dropwhile(_OPENING.__contains__, said))
    if len(names) == 1 and "or" in low[3:]:  # "is the gate open or closed?"
        low = low[: low.index("or", 3)]
    if {*low[:1]} & _ANY and len(names) == 1:  # "anything at the gate?"
        return f"check if there is {' '.join(low)}"
    if not {*low[:1]} & {"is", "are", "has", "have"} or len(names) != 1:
        return ""
    being, rest = low[0], low[1:]
    known = {word for thing in names[0].things for word in thing.description.lower().split()}
    at = next((at for at, word in enumerate(rest) if word in ("on", "off")), 0)
    if at and rest[at] in names[0].words and rest[at] not in known and rest[at + 1 : at + 2] == ["in"]:
        return f"check if {' '.join(rest[:at])} {being} {' '.join(rest[at:])}"  # its name has the room
    if rest[:1] == ["there"] or (rest and rest[0] in _ANY):
        return f"check if {rest[0]} {being} {' '.join(rest[1:])}"
    start = len(rest) - len(names[0].words)
    led = [word for word in rest[:start] if word != "the"]
    if rest[start:] == [*names[0].words] and len(led) > 1 and led[-1] in _WHERE and led[0] not in _PLACED:
        cut = start - 1 - (rest[start - 1] == "the")
        return f"check if {' '.join(rest[:cut])} {being} {' '.join(rest[cut:])}"  # "is the post in bay 2?"
    end = next(
        (at for at in range(len(rest), 0, -1) if rest[at - len(names[0].words) : at] == [*names[0].words]), 0
    )
    subject, state = rest[:end], rest[end:]
    switched = state[:1] == ["on"] and state[1:2] in ([], ["in"])  # "is the pump on in the yard?"
    if not state or len(subject) > len(names[0].words) + 1 or ({*state} & _PLACED and not switched):
        return ""
    return f"check if {' '.join(subject)} {being} {' '.join(state)}"


_NOT_WHERE: Final = word_set("was were did does do had has have")
"""How a question begins that no place answers."""
_OPENING: Final = word_set("so and ok okay hey please well hi hello good morning evening sorry quick listen")
_ANY: Final = word_set("anybody anyone somebody someone anything something everything nobody all")
_WHERE: Final = frozenset({"in", "at", "on", "inside", "under", "by", "near"})
_PLACED: Final = word_set("""at in on near far away close here by next behind beside under where to from or
called yours mine it that left right""")


def _is_about_failure(situation: Situation, lexicon: Lexicon) -> bool:
    """Whether a question has words of what went wrong: "what is in the way?"."""
    small = lexicon.classes["small"] | lexicon.classes["prepositions"] | lexicon.classes["logic"]
    small = small - lexicon.classes["trouble"]
    failed = situation.failure.error_message if situation.failure is not None else ""
    asked, told = ({token.low for token in tokenize(text)} - small for text in (situation.message, failed))
    return any(word.isalpha() for word in asked & told)


def _kept(situation: Situation, lexicon: Lexicon) -> Answer | None:
    """What is remembered in the words of a question, all but those that only ask; the newest."""
    asking = {"do", "does", "did", "whose", "when", "much", "many", "one", "ones"}
    asking = asking.union(*(lexicon.classes[kind] for kind in ("small", "logic", "prepositions", "being")))
    words = {
        stem(token.low) for token in tokenize(situation.message) if token.is_word and token.low not in asking
    }
    for memory in reversed(situation.memory):
        said = {stem(token.low) for token in tokenize(f"{memory.name.replace('_', ' ')} {memory.data}")}
        if words and words <= said and memory.type == "text":
            return Answer(f"I remember: {memory.data.rstrip('.')}.", (memory.name,))
    return None


def _lying(situation: Situation, thing: MapObject) -> str:
    name = with_article(thing.description)
    return f"{name[0].upper()}{name[1:]} is {lies(thing, situation.objects, situation.robot_pose)}."


def _spoken_of(situation: Situation, thing: MapObject | None) -> Answer:
    """What is known of "it": what failed, what was asked, else the thing that was spoken of last."""
    if situation.failure is not None:
        here = whereabouts(situation.objects, situation.robot_pose)
        return Answer(f"I know no more than this: {situation.failure.error_message} I am {here}.")
    if situation.question:
        return Answer(f"I know no more about it than I asked: {situation.question}")
    if thing is None or "where" not in situation.message.lower():
        return Answer(_NO_ANSWER)
    return Answer(_lying(situation, thing))
