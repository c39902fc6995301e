"""Facts: what is told becomes a memory, and what is remembered says where something is."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from parley.language.builtin.decision import Told
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.saying import with_article
from parley.language.builtin.spans import Filler
from parley.language.builtin.structure import Part
from parley.language.builtin.things import noun_phrase
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.standing import read_rule
from parley.language.lexicon import word_set
from parley.messages.memory import MemoryEntry

__all__ = ["Place", "known_place", "places", "rule_of", "told_of"]


@dataclass(frozen=True, slots=True)
class Place:
    """That something is somewhere, as it is remembered."""

    thing: str
    where: tuple[str, ...]
    """The words for the place, without what leads to them."""
    head: int
    memory: MemoryEntry


def told_of(
    reading: Reading, message: str, starts: Sequence[int], lexicon: Lexicon, before: Sequence[Told] = ()
) -> tuple[Told, ...]:
    """The facts of a message, in which its words begin at `starts`, and those told just `before`."""
    found = [*before]
    for wish in reading.wishes:
        thing = wish.one("T")
        said = message[starts[wish.start - 1] : starts[wish.start]].strip().lower() if wish.start else ""
        behind = thing is not None and thing.start > wish.start  # "I left the box there"
        left = wish.frame == "BELOC" and said in ("i", "we", "just") and behind and wish.start < 3
        moved = left or (wish.frame in ("PUT", "BRING") and wish.start > 0)
        if not (moved or wish.frame in ("BELOC", "GO")) or wish.act != "told":
            continue
        name = _name(thing, lexicon) if thing is not None else (said,)
        if {*name} & (lexicon.classes["pronouns"] | lexicon.classes["persons"] | {"they"}):
            found = _moved(found, wish, reading)
            continue  # nobody knows later who or what was meant
        vague = reading.unsteady or {*name} <= lexicon.classes["determiners"] | {"there's"}
        if thing is None or vague or not wish.has("LG") or wish.frame == "GO":
            continue
        start = min(starts[min([wish.start, *(filler.start for filler in wish.fillers)])], len(message))
        last = max(filler.end for filler in wish.fillers)
        text = _whole(message, start, starts[last] if last < len(starts) else len(message), lexicon)
        key = "_".join(re.findall(r"\w+", " ".join(name)))[:150]
        if moved and (where := wish.one("G") or wish.one("L")) is not None:  # "I moved the box to the desk"
            be = "are" if name[-1].endswith("s") and not name[-1].endswith("ss") else "is"
            text = f"{thing.text} {be} {_TO.sub('at', where.text)}"
        if key and text:
            plain = re.search(re.escape(" ".join(name)), message, re.IGNORECASE)
            shown = plain[0] if plain else " ".join(name)
            found.append(Told(f"{key}_location", _quoted(text), f"Where {with_article(shown)} is"))
    return tuple(found)


def _moved(found: list[Told], wish: Wish, reading: Reading) -> list[Told]:
    """The facts with where that is now of which the last one told: "she isn't there, she is at the desk"."""
    places = [f for one in reading.wishes for f in one.fillers if f.role in "LG" and f.start > wish.start]
    if not found or not places:
        return found
    last = found[-1]
    owner = last.about.removeprefix("Where ").removesuffix(" is")
    gone = _GONE.search(last.text) is not None
    kept = found[:-1] if gone else found
    where = _TO.sub("at", places[0].text)
    return [*kept, Told(last.name, f"{owner} is {where}", last.about)]


_TO = re.compile(r"^(?:in|on)?to\b")
_GONE = re.compile(r"n['’]t\b|\b(?:not|no longer|never|left)\b")
_END = re.compile(r"[.,;:!?]|\b(?:and|but|so|because|or|then|please)\b|$", re.IGNORECASE)
_LINKED = re.compile(r"that\s+", re.IGNORECASE)
_LEADING_IN = word_set("remember note mind think believe guess yes no and but or")


def _whole(message: str, start: int, end: int, lexicon: Lexicon) -> str:
    """All that a sentence says in which a fact stands: "bay 6 belongs to the guard", to its end."""
    while before := re.search(r"(?:^|[\s,;:.!?])([\w'’-]+)\s+$", message[:start]):
        word = before[1].lower()
        if word != "i" and word in lexicon.classes["small"] | lexicon.classes["asking"] | _LEADING_IN:
            break
        start = before.start(1)
    if linked := _LINKED.match(message[start:]):
        start += linked.end() if before is not None and before[1].lower() in _LEADING_IN else 0
    stop = _END.search(message, len(message[:end].rstrip()))
    text = message[start : stop.start()] if stop is not None else message[start:]
    return text.strip().rstrip(".,;!?").removesuffix(" and").strip()


def rule_of(parts: Sequence[Part], message: str, lexicon: Lexicon) -> Told | None:
    """What people teach for a case that may come ("if you see smoke, stop"); None if it is no such rule.

    It has one condition, about what the robot may meet on any way: something seen, or something that goes
    wrong. Nothing is wanted before it. Only what can be carried out when it happens is promised.
    """
    cases = [part for part in parts if part.clause.link in ("if", "when")]
    others = [
        part for part in parts if part.clause.link not in ("if", "when", "main", "not", "times", "delay")
    ]
    if (
        read_rule(message) is None
        or len(cases) != 1
        or others
        or (not cases[0].clause.fronted and len(parts) > 2)
        or len(parts) < 2
    ):
        return None
    words = [word for word in cases[0].low if word.isalpha()]
    sees = (
        len(words) > 2
        and words[0] in ("you", "anybody", "somebody")
        and words[1] in lexicon.classes["meeting"]
    )
    wrong = bool({*words} & lexicon.classes["trouble"]) and cases[0].clause.link == "when"
    if not (sees or wrong) or (parts[0] is not cases[0] and cases[0].clause.fronted):
        return None
    name = words[2:] if sees else words
    if {*name} <= lexicon.classes["pronouns"] | lexicon.classes["persons"]:
        return None  # "look for the mug and take it if you see it"
    small = lexicon.classes["determiners"] | lexicon.classes["small"] | lexicon.classes["prepositions"]
    key = "_".join(word for word in name if word not in small)[:150]
    text = message.strip().rstrip(".!")
    return Told(f"{key}_protocol", text, f"What to do about {' '.join(name)}", is_rule=True) if key else None


def _quoted(text: str) -> str:
    """A fact as it stands inside a sentence."""
    first, _, rest = text.partition(" ")
    return f"{first.lower()} {rest}" if first.lower() in _SMALL else text


_SMALL = frozenset({"the", "a", "an", "there", "there's", "my", "our", "this", "that", "some", "your"})


def places(
    memories: Sequence[MemoryEntry], reader: Callable[[str], Reading], lexicon: Lexicon
) -> list[Place]:
    """Where things are, as far as memories say it; the newest first."""
    found = []
    for memory in reversed(memories):
        if memory.type != "text" or len(memory.data) > 200:
            continue
        for wish in reader(memory.data).wishes:
            where = wish.one("L") or wish.one("G")
            thing = wish.one("T")
            if wish.frame == "BELOC" and where is not None and thing is not None:
                name = _name(thing, lexicon)
                place, rest = noun_phrase(where.words, where.head, lexicon)
                words = (*place, *rest)
                found.append(Place(" ".join(name), words, len(place) - 1, memory))
    return found


def _name(thing: Filler, lexicon: Lexicon) -> tuple[str, ...]:
    """What a thing that is told of is called: up to the first preposition, as a name may have many words."""
    stop = next(
        (at for at, word in enumerate(thing.words) if at and word in lexicon.classes["prepositions"]),
        len(thing.words),
    )
    return noun_phrase(thing.words, max(thing.head, stop - 1), lexicon)[0]


def known_place(name: Sequence[str], known: Sequence[Place]) -> Place | None:
    """Where a thing is: one called so, else the only one whose name begins or ends like that."""
    wanted = [stem(word) for word in name]
    for place in known:
        if [stem(word) for word in place.thing.split()] == wanted:
            return place
    near = [p for p in known if set(wanted) <= {stem(word) for word in p.thing.split()}]
    names = {place.thing for place in near}
    return near[0] if len(names) == 1 else None
