"""Statements that are looked at: "whether the gate is shut", "if somebody is in there", "you see smoke"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.facts import Place, known_place
from parley.language.builtin.grounding import Value
from parley.language.builtin.lexicon import Lexicon, stems
from parley.language.builtin.saying import which_one, with_article
from parley.language.builtin.sets import group
from parley.language.builtin.things import link
from parley.language.builtin.tokens import tokenize
from parley.language.builtin.ways import Ways
from parley.language.lexicon import word_set
from parley.world.object_map import MapObject

__all__ = ["Look", "check", "seen_at", "whole_names"]

_SEEING = frozenset({"see", "find", "notice", "spot", "discover", "meet"})
_ANYBODY = {"somebody", "nobody", "anybody", "someone", "anyone", "anything", "something", "nothing"}
_SPEAKERS = frozenset({"i", "we", "you"})
_WHERE = word_set("in on at under behind near by inside into beside below above")


@dataclass(frozen=True, slots=True)
class Look:
    """The deeds that find out whether something is so."""

    deeds: list[Deed]
    holds: bool = True
    """The result that means yes: a statement with "not" is looked at without it."""


def check(builder: Ways, words: Sequence[str], text: str) -> Look | Ask:
    """The deeds that find out whether something is so: the way to where it is seen, and a look.

    Args:
        builder: Knows the situation and what was spoken of before.
        words: Of the statement, in small letters, without "if" or "whether".
        text: The same as it was said.
    """
    lexicon = builder.lexicon
    plain, holds = _without_not(_LED_TWICE.sub(r"\1 and ", text))
    if plain != text:
        text, words = plain, [token.low for token in tokenize(plain)]
    spoken = [word for word in words if word[0].isalnum() or word[0] in "'’"]
    unseen = [
        word for word in spoken if word in lexicon.classes["mental"] or word in lexicon.classes["clock"]
    ]
    sees = len(spoken) > 2 and spoken[0] in _SPEAKERS and spoken[1] in _SEEING
    if not spoken or unseen or (spoken[0] in _SPEAKERS and not sees) or "or" in spoken:
        return Ask(f"I cannot see whether {text}. What shall I do now?")
    looked = builder.skills.get("LOOK")
    slot = looked and (looked.roles.get("K") or looked.roles.get("T"))
    if looked is None or not slot:
        return Ask(f"I have no action to find out whether {text}.")
    where = _where(builder, [word for word in words if word == "," or word in spoken], text)
    if isinstance(where, Ask):
        return where
    found: list[Deed] = []
    for place, statement in where:
        if place is None and builder.before is not None and "there" in spoken[-1:] and not builder.at:
            there = builder.before.description  # "look if it is open there"
            place = Value(there, with_article(there), (builder.before,))
        way = builder.nearing(place) if place is not None and "GO" in builder.skills else []
        if isinstance(way, Ask):
            return way
        if place is None and not builder.at:
            who, being, _ = text.partition(" is ")
            named = bool(being) and who.lower() not in builder.lexicon.classes["pronouns"]
            return Ask(f"Where shall I look whether {text}?", where=who if named else "")
        seen = text.split(maxsplit=2)[2] if sees else ""
        frame, said = ("FIND", {"T": seen}) if sees else ("LOOK", {"K": statement})
        deed = Deed(frame, looked, {slot: seen or statement}, said)
        found += [*way, deed]
        builder.last_check = deed if len(where) == 1 else None
    builder.last_thing = _subject(builder, spoken) or where[-1][0] or builder.last_thing
    return Look(found, holds)


def _where(builder: Ways, said: Sequence[str], text: str) -> list[tuple[Value | None, str]] | Ask:
    """Where to look and what at: once, or for each of a set, which may be listed with commas."""
    words = [word for word in said if word != ","]
    each = _each(builder, words)
    if each:
        return each
    inside = _in_each(builder, said, text)
    if inside:
        return inside
    place = seen_at(builder, words)
    return place if isinstance(place, Ask) else [(place, f"whether {_named_anew(builder, text)}")]


_LED_TWICE = re.compile(r"\b((at|in|on|by|near) [\w ]+?) and \2 (?=\w)", re.IGNORECASE)
"""As in "at the desk and at the gate"."""
_NOTS = {"isn't": "is", "aren't": "are", "isn’t": "is", "aren’t": "are", "hasn't": "has", "wasn't": "was"}


def _without_not(text: str) -> tuple[str, bool]:
    """A statement without its one "not", and whether it stays as it was."""
    words = text.split()
    nots = [at for at, word in enumerate(words) if word.lower() in _NOTS or word.lower() == "not"]
    if len(nots) != 1 or nots[0] in (0, len(words) - 1):
        return text, True
    at = nots[0]
    words[at : at + 1] = [_NOTS[words[at].lower()]] if words[at].lower() in _NOTS else []
    return " ".join(words), False


def _subject(builder: Ways, words: Sequence[str]) -> Value | None:
    """What a statement is about, if that is not where it is looked at: "it" means that from then on."""
    lexicon = builder.lexicon
    at = next((n for n, word in enumerate(words) if word in ("is", "are", "'s")), 0)
    if not at or words[0] in lexicon.classes["pronouns"]:
        return None
    part = words[:at]
    if words[0] == "there":
        end = next(
            (n for n in range(at + 1, len(words)) if words[n] in lexicon.classes["prepositions"]), len(words)
        )
        part = words[at + 1 : end]
    name = [word for word in part if word not in lexicon.classes["determiners"]]
    if not name or {*name} & _ANYBODY:
        return None
    mention = link(name, len(name) - 1, builder.situation.objects, lexicon)
    if mention.kind == "one":
        thing = mention.things[0]
        return Value(thing.description, with_article(thing.description), mention.things)
    text = " ".join(name)
    return Value(text, with_article(text), (), known_place(name, builder.known))


def _named_anew(builder: Ways, text: str) -> str:
    """A statement in which "it" is called by its name: a picture knows nothing of what was said."""
    words = [part for word in text.split() for part in _parted(word)]
    for at, word in enumerate(words):
        refers = word.lower() in ("it", "they", "them") and (not at or words[at - 1].lower() in _WHERE)
        if refers and builder.last_thing is not None:
            words[at] = builder.last_thing.said
    return " ".join("is" if word == "be" else word for word in words)


def _parted(word: str) -> list[str]:
    ends = {"it's": ["it", "is"], "they're": ["they", "are"]}
    return ends.get(word.lower().replace("’", "'"), [word])


def _each(builder: Ways, words: Sequence[str]) -> list[tuple[Value | None, str]] | Ask:
    """The statement for each of a set: "all windows are shut", "any of the boxes is open"."""
    lexicon = builder.lexicon
    among = {*_before_verb(words)} & (
        lexicon.classes["quantifiers"] - {"everything", "everyone", "everybody"}
    )
    at = next((n for n, word in enumerate(words) if word in ("is", "are", "'s", "has", "have")), 0)
    if not at and {*words[:1]} <= {"you"}:
        among -= {"any"}  # "if you see any leaks"
    if not at:
        return Ask(f"I do not understand “{next(iter(among))}” in this. Please name them.") if among else []
    subject = [word for word in words[:at] if word not in ("any", "one", "no", "of", "either")]
    several = group(subject, builder.situation.objects, lexicon) if subject else None
    if several is None or several.doubt or len(several.things) < 2:
        if among and not set(words[:at]) & {"anyone", "anybody", "anything"}:
            return Ask(
                several.doubt
                if several and several.doubt
                else f"Which ones do you mean by “{' '.join(words[:at])}”?"
            )
        return []
    verb = "has" if words[at] in ("has", "have") else "is"
    rest = " ".join(words[at + 1 :])
    return [
        (
            Value(one.description, with_article(one.description), (one,)),
            f"whether {with_article(one.description)} {verb} {rest}",
        )
        for one in several.things
    ]


def _in_each(builder: Ways, words: Sequence[str], text: str) -> list[tuple[Value | None, str]] | Ask:
    """The statement for each of several places: "the windows are shut in rooms 1 to 3"."""
    at = next((n for n in range(len(words) - 2, 0, -1) if words[n] in _WHERE), 0)
    several = group(words[at + 1 :], builder.situation.objects, builder.lexicon) if at else None
    if several is None:
        return []
    if several.doubt:
        return Ask(several.doubt)
    head = text[: text.lower().rindex(f" {words[at]} ")]
    return [
        (Value(name, with_article(name), (one,)), f"whether {head} {words[at]} {with_article(name)}")
        for one in several.things
        for name in [one.description]
    ]


def _before_verb(words: Sequence[str]) -> Sequence[str]:
    """What a statement is about, as far as it stands before "is" and the like."""
    at = next((n for n, word in enumerate(words) if word in ("is", "are", "'s", "has", "have")), len(words))
    return words[:at]


def seen_at(builder: Ways, words: Sequence[str]) -> Value | Ask | None:
    """Where a statement is looked at: what it names, else what was spoken of; None: where the robot is."""
    named = whole_names(words, builder.situation.objects, builder.lexicon)
    for start, item in reversed(named):
        before = [
            word
            for word in words[max(start - 2, 0) : start]
            if word not in builder.lexicon.classes["determiners"]
        ]
        if before and before[-1] in _WHERE:
            return _one_called(words, start, item, builder.situation.objects)
    if named:
        return _one_called(words, *named[0], builder.situation.objects)
    if builder.at and {"there", "here", "in"} & {*words[1:]}:
        return None
    place = _remembered(builder, words)
    if place is not None:
        return Value(place.thing, with_article(place.thing), (), place)
    loose = _by_noun(builder, words)
    if loose is not None:
        return loose
    if builder.last_thing is not None and words[0] in builder.lexicon.classes["pronouns"]:
        return builder.last_thing if builder.last_thing.things or builder.last_thing.place else None
    return None


def _one_called(
    words: Sequence[str], start: int, item: MapObject, objects: Sequence[MapObject]
) -> Value | Ask:
    """The thing that is named there; a question if others have the same name."""
    said = [stems([word]) for word in words[start:]]
    flat = tuple(one[0] for one in said if one)

    def length(other: MapObject) -> int:
        names = (stems(name.split()) for name in (other.description, *other.aliases))
        return max((len(name) for name in names if flat[: len(name)] == name), default=0)

    same = [other for other in objects if length(other) == length(item)]
    if len(same) < 2:
        return Value(item.description, with_article(item.description), (item,))
    called = tuple(dict.fromkeys(other.description for other in same))[:6]
    return Ask(which_one(called), called)


def whole_names(
    words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon
) -> list[tuple[int, MapObject]]:
    """The things whose whole names stand in a row of words, with where; a longer name hides a shorter one.

    Another word for a thing hides what stands in it, too: a "sitting room table" is no sitting room.
    """
    flat = [next(iter(stems([word])), "") for word in words]
    found: list[tuple[int, int, MapObject | None]] = []
    for item in objects:
        own = {tuple(name.lower().split()) for name in (item.description, *item.aliases)}
        other = {words for name in own for words in lexicon.synonyms.get(name, ())}
        for name in own | other:
            wanted, size = list(stems(name)), len(name)
            ats = (at for at in range(len(flat) - size + 1) if flat[at : at + size] == wanted)
            found += [(at, size, item if name in own else None) for at in ats]
    found.sort(key=lambda one: (-one[1], one[2] is None))
    kept: list[tuple[int, int, MapObject | None]] = []
    for at, size, thing in found:
        if all(at + size <= other or at >= other + length for other, length, _ in kept):
            kept.append((at, size, thing))
    return sorted(((at, thing) for at, _, thing in kept if thing is not None), key=lambda one: one[0])


def _remembered(builder: Ways, words: Sequence[str]) -> Place | None:
    """The place of a remembered thing or person that a row of words names."""
    for size in range(min(4, len(words)), 0, -1):
        for at in range(len(words) - size + 1):
            part = words[at : at + size]
            small = builder.lexicon.classes["small"] | builder.lexicon.classes["determiners"]
            if part[0] in small or part[-1] in small or (at and words[at - 1] in ("a", "an", "any", "no")):
                continue
            place = known_place(part, builder.known)
            if place is not None and len(place.thing.split()) <= size + 1:
                return place
    return None


def _by_noun(builder: Ways, words: Sequence[str]) -> Value | Ask | None:
    """The thing that is named by a part of its name; a question if several could be."""
    lexicon = builder.lexicon
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"] | lexicon.classes["small"]
    for at, word in enumerate(words):
        before = words[at - 1] if at else ""
        if before not in lexicon.classes["determiners"] | _WHERE or word in small:
            continue
        end = next(
            (n for n in range(at, len(words)) if words[n] in small | lexicon.classes["predicates"]),
            len(words),
        )
        part = words[at:end]
        mention = link(part, len(part) - 1, builder.situation.objects, lexicon) if part else None
        if mention is not None and mention.kind == "one":
            item = mention.things[0]
            return Value(item.description, with_article(item.description), (item,))
        if mention is not None and mention.kind == "several":
            names = tuple(dict.fromkeys(thing.description for thing in mention.things))[:6]
            return Ask(which_one(names), names)
    return None
