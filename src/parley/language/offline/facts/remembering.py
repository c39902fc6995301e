"""What is remembered: facts from memories, looked up and named."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from parley.language.offline.facts.by_rule import placed_by_rule, without_time
from parley.language.offline.facts.facts import Fact, read_statement
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.sentences.finite import verb_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens, written_out
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = [
    "WORKING",
    "Remembered",
    "find_fact",
    "memory_name",
    "newest",
    "of_others",
    "remembered",
    "speaks_of_several",
]

ONLY_NOW = "only_now"
"""The name of what is only said for one order, and not kept."""


@dataclass(frozen=True, slots=True)
class Remembered:
    """A fact with the memory it comes from."""

    fact: Fact
    entry: MemoryEntry


def remembered(memory: Iterable[MemoryEntry]) -> list[Remembered]:
    """What the text memories say, newest first; what robots noted counts as older than what was told."""
    result: list[Remembered] = []
    for entry in memory:
        if entry.type != "text":
            continue
        fact = _entry_fact(entry.name, entry.data)
        if fact is not None and keys(fact.subject) not in _ROBOT:
            result.append(Remembered(fact, entry))
    newest_first = result[::-1]
    ordered = sorted(newest_first, key=lambda item: "/" in item.entry.source)
    placed = {keys(item.fact.subject) for item in ordered if item.fact.is_location}
    by_work = (by for item in ordered if (by := _by_work(item, placed)) is not None)
    return [*ordered, *by_work, *placed_by_rule(ordered, placed)]


_ROBOT = frozenset({("you",), ("yourself",), ("your",)})
"""What is kept about the robot itself names nothing in the world: "you" is no other name of it."""
WORKING = frozenset({"drives", "operates", "runs", "mans", "minds", "tends", "steers", "staffs"})
_BUSY = frozenset({
    "sells", "serves", "helps", "teaches", "cooks", "guards", "watches", "plays", "trains", "studies", "eats",
    "reads", "repairs", "paints", "cleans", "manages", "gives", "checks",
})  # fmt: skip
_WHERE = frozenset({"at", "in", "by", "behind"})
_ON_DUTY = frozenset({("on", "duty"), ("on", "shift"), ("on", "call"), ("in", "charge")})


def _by_work(item: Remembered, placed: set[tuple[str, ...]]) -> Remembered | None:
    """For "A drives the truck": A is found at the truck, if nothing better is known."""
    fact = item.fact
    if fact.negated or fact.is_location or not fact.subject[:1]:
        return None
    company = bare(fact.state[1:]) if keys(fact.state[:1]) == ("with",) else ()
    if company and fact.relation in lexicon().be and keys(company) in placed:
        # "The keys are with A".
        return Remembered(replace(fact, place=company, relation="at", state=()), item.entry)
    if not fact.subject[0].is_capital:
        return None
    if keys(fact.subject) in placed:
        return None
    doing = fact.relation in lexicon().be and keys(fact.state)[:1] and keys(fact.state)[0].endswith("ing")
    if doing or fact.relation in _BUSY or keys(fact.state[:2]) in _ON_DUTY:
        # "A sells tea at the kiosk".
        flat = keys(fact.state)
        at = next((i for i in range(1, len(flat) - 1) if flat[i] in _WHERE), 0)
        place = bare(fact.state[at + 1 :]) if at else ()
        return Remembered(replace(fact, place=place, relation="at", state=()), item.entry) if place else None
    if fact.relation not in WORKING:
        return None
    at = next((i for i, word in enumerate(fact.state) if word.key in lexicon().determiners), -1)
    place = bare(fact.state[at:]) if at >= 0 else ()
    return Remembered(replace(fact, place=place, relation="at", state=()), item.entry) if place else None


def speaks_of_several(sentence: str) -> bool:
    """For "Packages are stored in A", "Packages stored in A": no name, though it has no article."""
    flat = keys(tokens(sentence))
    plural = singular(flat[0]) != flat[0]
    return plural and not (flat[1:2] and (flat[1] in {"is", "was", "has"} or singular(flat[1]) != flat[1]))


@lru_cache(maxsize=4096)
def _entry_fact(name: str, data: str) -> Fact | None:
    fact = _read_entry(name, data)
    if fact is None or len(fact.subject) != 1 or not speaks_of_several(fact.sentence):
        return fact
    word = fact.subject[0]
    return replace(fact, subject=(Word(word.key, word.key),))


def _without_heading(words: Phrase) -> Phrase:
    """For "Correction: A is in B" what follows the mark."""
    headed = keys(words[:1]) in _HEADINGS and keys(words[1:2]) in {(":",), (",",)}
    return words[2:] if headed and len(words) > 3 else words


_HEADINGS = frozenset(
    (word,) for word in ("correction", "update", "note", "news", "attention", "important", "reminder", "now")
)


def _read_entry(name: str, data: str) -> Fact | None:
    first = re.split(r"(?<=[.!;])\s", written_out(data.strip()), maxsplit=1)[0][:400]
    words = _without_heading(without_time(tokens(first)))
    fact = read_statement(words)
    if fact is not None:
        return fact
    verb = (verb_at(words) or _verb_of_any(words)) if not first.endswith("?") else 0
    about, _, kind = name.rpartition("_")
    if verb and verb < len(words) - 1 and kind not in {"location", "place", "position"}:
        said = tuple(word for word in words if word.is_word)
        return Fact(bare(said[:verb]), relation=said[verb].key, state=said[verb + 1 :], sentence=plain(said))
    if about and kind in {"location", "place", "position"} and words and len(words) < 12:
        noun = noun_phrase(words)
        place = noun.anchors[0] if not noun.core and noun.anchors else noun.phrase
        return Fact(tokens(about.replace("_", " ")), place, noun.relation or "at", sentence=data)
    return None


_FURTHEST_VERB = 6


def _verb_of_any(words: Phrase) -> int:
    """Where a verb that no list has stands in something remembered ("A tunes the B"); 0 if there is none."""
    lex, flat = lexicon(), keys(words)
    for index in range(1, min(_FURTHEST_VERB, len(flat) - 1)):
        key, before, behind = flat[index], flat[index - 1], words[index + 1]
        if words[index].is_capital or before in lex.determiners or before.endswith("'s"):
            continue
        opens = behind.key in lex.determiners or behind.is_capital or behind.key.isdigit()
        opens = (
            opens or lex.places.match(flat, index + 1) is not None or behind.key in {"up", "out", "for", "to"}
        )
        several = singular(before) != before and singular(key) == key and key not in lex.vocabulary
        if opens and (several or (singular(key) != key and singular(before) == before)):
            return index
    return 0


def find_fact(
    about: Phrase, facts: Sequence[Remembered], *, locations: bool = True
) -> tuple[Remembered | None, list[Remembered]]:
    """What is remembered about something: the one fact that holds, or several different things it may mean.

    Args:
        about: The words that name the thing.
        facts: Newest first.
        locations: Only where things are.
    """
    found = _find_fact(about, facts, locations=locations)
    meant = _described(about, facts) if locations and found == (None, []) else ()
    return _find_fact(meant, facts, locations=True) if meant else found


def _find_fact(
    about: Phrase, facts: Sequence[Remembered], *, locations: bool
) -> tuple[Remembered | None, list[Remembered]]:
    usable = [f for f in facts if f.fact.is_location and not f.fact.negated] if locations else list(facts)
    denied = {
        keys(f.fact.subject) + keys(f.fact.place) for f in facts if f.fact.is_location and f.fact.negated
    }
    newest: dict[tuple[str, ...], Remembered] = {}
    for item in usable:
        if keys(item.fact.subject) + keys(item.fact.place) in denied:
            continue
        name = item.entry.name if item.fact.another else ""
        newest.setdefault((*map(singular, keys(item.fact.subject)), name), item)
    listed = list(newest.values())
    stand_ins = [
        MapObject(id=f"fact-{'i' * (i + 1)}", description=plain(f.fact.subject), x_m=0.0, y_m=0.0)
        for i, f in enumerate(listed)
    ]
    found = ground_phrase(about, stand_ins)
    for other in _compounds(about) if found.outcome == "none" else ():
        found = ground_phrase(other, stand_ins, strict=True)
        if found.outcome != "none":
            break
    if found.outcome == "none":
        return None, []
    hits = [listed[stand_ins.index(item)] for item in found.candidates]
    hits = [hit for hit in hits if not of_others(about, hit.fact.subject)]
    if not hits:
        return None, []
    return (hits[0], []) if len(hits) == 1 else (None, hits)


_LINKING = frozenset({"for", "from", "with", "to", "of", "by"})


def _described(about: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """For "the order for A" the subject of the one fact that says that it is for A; empty if none does."""
    wanted = {singular(word.key) for word in bare(about) if word.key not in lexicon().determiners}
    flat = keys(bare(about))
    cut = next((i for i in range(1, len(flat)) if flat[i] in _LINKING), 0)
    head = (singular(flat[cut - 1]),) if cut else ()
    if len(wanted) < 3 or not head or keys(about)[0] in lexicon().question_starts:
        return ()
    subjects: dict[tuple[str, ...], Phrase] = {}
    for item in facts:
        fact = item.fact
        named = {singular(word.key) for word in fact.subject}
        said = named | {singular(word.key) for word in fact.state} | {fact.relation}
        if not fact.is_location and not fact.negated and wanted <= said and set(head) <= named:
            subjects[keys(fact.subject)] = fact.subject
    (meant,) = subjects.values() if len(subjects) == 1 else ((),)
    return meant if meant and keys(meant) != keys(bare(about)) else ()


def newest(facts: Sequence[Remembered]) -> list[Remembered]:
    """Where things are as far as is known: the last word on each, newest first."""
    last: dict[tuple[str, ...], Remembered] = {}
    gone: set[tuple[str, ...]] = set()
    for item in facts:
        if not item.fact.is_location:
            continue
        name = item.entry.name if item.fact.another else ""
        key = (*keys(item.fact.subject), name)
        if item.fact.negated:
            gone.add((*keys(item.fact.subject), *keys(item.fact.place)))
        elif (*keys(item.fact.subject), *keys(item.fact.place)) not in gone:
            last.setdefault(key, item)
    return list(last.values())


def of_others(about: Phrase, subject: Phrase) -> bool:
    """Whether one thing is A's and the other one B's: then they are not the same."""
    owners, others = _owners(about), _owners(subject)
    return bool(owners) and bool(others) and not owners & others


def _owners(phrase: Phrase) -> set[str]:
    return {
        word.key.removesuffix("'s").removesuffix("'") for word in phrase if word.key.endswith(("'s", "s'"))
    }


def _compounds(about: Phrase) -> list[Phrase]:
    """Other ways to say "pot of tea": "tea pot", "teapot", and the tea itself."""
    words = bare(about)
    flat = keys(words)
    if "of" not in flat[1:-1]:
        return []
    at = flat.index("of", 1)
    head, content = words[:at], bare(words[at + 1 :])
    if not content or len(head) > 2 or flat[at + 1] in {"the", "my", "your"}:
        return []
    joined = content[-1].key + head[-1].key
    return [(*content, *head), (Word(joined, joined),), content]


def memory_name(fact: Fact, facts: Sequence[Remembered]) -> str:
    """A stable name for a fact: the one of the older fact it replaces, or made from subject and relation."""
    if not fact.another:
        for item in facts:
            same_kind = item.fact.is_location == fact.is_location and (
                fact.is_location or item.fact.relation == fact.relation
            )
            if same_kind and keys(item.fact.subject) == keys(fact.subject):
                return item.entry.name
    subject = _slug(keys(fact.subject))
    if fact.is_location:
        return f"{subject}_location" + (f"_{_slug(keys(fact.place))}" if fact.another else "")
    name = f"{subject}_{'state' if fact.relation in lexicon().be else _slug((fact.relation,))}"
    return f"{name}_{_slug(keys(fact.state))}" if fact.another else name


def _slug(words: Iterable[str]) -> str:
    return "_".join(re.sub(r"[^\w]+", "_", word).strip("_") for word in words)[:80].strip("_") or "fact"
