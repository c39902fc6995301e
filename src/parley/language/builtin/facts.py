"""Facts: what is told, in lists too, becomes a memory, and what is remembered says where something is."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.decision import Told
from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.language.builtin.reading import Reading
from parley.language.builtin.saying import with_article
from parley.language.builtin.skills import Skills
from parley.language.builtin.spans import Filler
from parley.language.builtin.structure import Part
from parley.language.builtin.things import noun_phrase
from parley.language.builtin.tokens import Token, spoken, tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.questions import plain
from parley.language.dialogue.speaker import Again
from parley.language.dialogue.standing import read_rule
from parley.language.lexicon import word_set
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = [
    "Heard",
    "Place",
    "known_place",
    "listing",
    "places",
    "rule_of",
    "rule_of_sight",
    "told_of",
    "told_set",
]


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
        ahead = _AHEAD.search(message[: starts[wish.start]]) is not None or wish.verb.endswith("ing")
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
        if ahead and wish.start > 0:  # "I will put the box on the desk" is not done yet
            text = _SENTENCE.split(message[: starts[wish.start]])[-1] + message[starts[wish.start] :].rstrip(
                ".! "
            )
        elif moved and (where := wish.one("G") or wish.one("L")) is not None:  # "I moved the box to the desk"
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
_AHEAD = re.compile(
    r"(?:\bwill|['’]ll|\b(?:going|about|plans?|wants?|has|have) to)\s+(?:\w+ly )?$", re.IGNORECASE
)
_SENTENCE = re.compile(r"[.;!?,]\s+|\b(?:that|and|but)\s+", re.IGNORECASE)
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
    rule = read_rule(message)
    if (
        rule is None
        or (rule.about == "sight" and not rule.names)  # of "anything" nobody could tell that it is there
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
    return _protocol(words[2:] if sees else words, message, lexicon)


def rule_of_sight(message: str, lexicon: Lexicon) -> Told | None:
    """A rule that is all of a message, about what the robot may see: "tell me if you see anybody"."""
    rule = read_rule(message)
    if (
        rule is None
        or rule.about != "sight"
        or not rule.names
        or {act.kind for act in rule.acts} - {"stop", "tell", "cancel"}
    ):
        return None
    sees = rule.case[:1] == ("you",) and {*rule.case[1:2]} <= lexicon.classes["meeting"]
    sees = sees and not {"it", "them", "there"} & {*rule.case}  # of what was spoken of before
    return _protocol(rule.case[2:], message, lexicon) if sees else None


def _protocol(name: Sequence[str], message: str, lexicon: Lexicon) -> Told | None:
    """A rule about what is called so; None about "it": "look for the mug and take it if you see it"."""
    if {*name} <= lexicon.classes["pronouns"] | lexicon.classes["persons"]:
        return None
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


# -- what is told in a list ("there are two places of interest: ..."), and who is meant by its name later --


_LEAD: Final = (
    r"(?:(?:please|and|ok|okay|so|(?:just )?so you know|you should know|fyi|for your information|"
    r"keep in mind|remember|note)(?: that)?[:, ]+)*"
)
_COUNT: Final = r"(?:two|three|four|five|six|seven|eight|nine|ten|\d+)"
_THERE_ARE: Final = r"(?:there(?: are|'re|’re)|these are|(?:we|i)(?: have|'ve|’ve)(?: got)?)"
_LISTINGS: Final = tuple(
    re.compile(rf"{_LEAD}(?P<fact>{shape} ?(?P<items>[^?:]+))", re.IGNORECASE)
    for shape in (
        rf"{_THERE_ARE} (?P<head>[^:?]{{3,80}}):",
        rf"{_THERE_ARE} (?P<head>{_COUNT} \w+(?: \w+)?(?: of \w+)?),(?: namely)?",
        r"(?:the|our|my) (?P<head>\w+(?: \w+)?(?: of \w+)?) are(?: called)?:?",
    )
)
_WORD: Final = re.compile(r"[\w-]+")


def listing(message: str, objects: Sequence[MapObject], lexicon: Lexicon) -> Told | None:
    """The fact that some things of the map are something: behind the colon stand their names alone."""
    found = _found(" ".join(message.split()))
    if found is None or len(_items(found["items"], objects, found["head"])) < 2:
        return None
    counting = lexicon.classes["determiners"] | _COUNTS
    words = [word for word in _WORD.findall(found["head"].lower()) if word not in counting]
    fact = found["fact"]
    text = fact[:1].lower() + fact[1:] if not fact.lower().startswith("i") else fact
    return Told("_".join(words)[:150], text, f"The {' '.join(words)}") if words else None


def told_set(
    words: Sequence[str], memories: Sequence[MemoryEntry], objects: Sequence[MapObject], lexicon: Lexicon
) -> tuple[MapObject, ...]:
    """The things of a list that was told and is called so: "each place of interest"; the newest list."""
    small = lexicon.classes["determiners"] | lexicon.classes["prepositions"] | {"of", "those", "them"}
    wanted = {stem(word) for word in words if word not in small}
    for memory in reversed(memories):
        found = _found(memory.data) if memory.type == "text" else None
        if found is not None and wanted and wanted <= {stem(w) for w in _WORD.findall(found["head"].lower())}:
            return _items(found["items"], objects, found["head"])
    return ()


def _found(text: str) -> re.Match[str] | None:
    """The list that a text is."""
    return next((match for one in _LISTINGS if (match := one.fullmatch(text.rstrip(".! ")))), None)


_COUNTS: Final = word_set("two three four five six seven eight nine ten several some few 2 3 4 5 6 7 8 9 10")


def _items(text: str, objects: Sequence[MapObject], head: str) -> tuple[MapObject, ...]:
    """The things that a list names, with words of its `head` or without; none if anything else is in it."""
    parts = [part for part in re.split(r",\s*(?:and\s+)?|;\s*|\s+and\s+", text.strip(" .!")) if part]
    said = [re.sub(r"^(?:the|an?|my|our) ", "", part.lower()).split() for part in parts]
    kinds = [said[0][:-1] if said else [], *([word] for word in _WORD.findall(head.lower()))]
    called = [
        next((things for kind in ([], *kinds) if (things := _called([*kind, *words], objects))), [])
        for words in said
    ]
    return tuple(one[0] for one in called) if all(len(one) == 1 for one in called) else ()


def _called(words: Sequence[str], objects: Sequence[MapObject]) -> list[MapObject]:
    """What is called so; "2" behind "bay 1" is bay 2."""
    name = stems(words)
    return [item for item in objects if name in {stems(n.split()) for n in (item.description, *item.aliases)}]


# -- a message as it was heard: its words, its clauses, and all that is needed to decide about it --


@dataclass(frozen=True, slots=True)
class Heard:
    """One message in its situation."""

    situation: Situation
    tokens: Sequence[Token]
    parts: tuple[Part, ...]
    """Its clauses, each read."""
    reading: Reading
    """Of the whole."""
    skills: Skills
    """What the robot can do."""
    lexicon: Lexicon
    reader: Callable[[str], Reading]
    """Reads another text."""
    again: Again

    @property
    def bare(self) -> str:
        """The words without what only opens and closes them."""
        return plain(self.tokens, (self.situation.robot,))

    def told_in(self, text: str) -> tuple[Told, ...]:
        """The facts of a text."""
        starts = [token.start for token in spoken(tokenize(text)) or tokenize(text)]
        return told_of(self.reader(text), text, starts, self.lexicon)
