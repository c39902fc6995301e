"""What is remembered: facts from memories, looked up and named."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from parley.language.offline.facts.facts import Fact, read_statement
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.sentences.finite import verb_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["Remembered", "find_fact", "memory_name", "remembered"]


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
        if fact is not None:
            result.append(Remembered(fact, entry))
    newest = result[::-1]
    return sorted(newest, key=lambda item: "/" in item.entry.source)


@lru_cache(maxsize=4096)
def _entry_fact(name: str, data: str) -> Fact | None:
    first = re.split(r"(?<=[.!;])\s", data.strip(), maxsplit=1)[0][:400]
    words = tokens(first)
    fact = read_statement(words)
    if fact is not None:
        return fact
    verb = verb_at(words) if not first.endswith("?") else 0
    about, _, kind = name.rpartition("_")
    if verb and verb < len(words) - 1 and kind not in {"location", "place", "position"}:
        said = tuple(word for word in words if word.is_word)
        return Fact(bare(said[:verb]), relation=said[verb].key, state=said[verb + 1 :], sentence=plain(said))
    if about and kind in {"location", "place", "position"} and words and len(words) < 12:
        noun = noun_phrase(words)
        place = noun.anchors[0] if not noun.core and noun.anchors else noun.phrase
        return Fact(tokens(about.replace("_", " ")), place, noun.relation or "at", sentence=data)
    return None


def find_fact(
    about: Phrase, facts: Sequence[Remembered], *, locations: bool = True
) -> tuple[Remembered | None, list[Remembered]]:
    """What is remembered about something: the one fact that holds, or several different things it may mean.

    Args:
        about: The words that name the thing.
        facts: Newest first.
        locations: Only where things are.
    """
    usable = [f for f in facts if f.fact.is_location and not f.fact.negated] if locations else list(facts)
    denied = {
        keys(f.fact.subject) + keys(f.fact.place) for f in facts if f.fact.is_location and f.fact.negated
    }
    newest: dict[tuple[str, ...], Remembered] = {}
    for item in usable:
        if keys(item.fact.subject) + keys(item.fact.place) in denied:
            continue
        name = item.entry.name if item.fact.another else ""
        newest.setdefault((*keys(item.fact.subject), name), item)
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
    return (hits[0], []) if len(hits) == 1 else (None, hits)


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
    return f"{subject}_{'state' if fact.relation in lexicon().be else _slug((fact.relation,))}"


def _slug(words: Iterable[str]) -> str:
    return "_".join(re.sub(r"[^\w]+", "_", word).strip("_") for word in words)[:80].strip("_") or "fact"
