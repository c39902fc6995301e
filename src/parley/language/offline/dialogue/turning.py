"""Yes-or-no questions turned into what follows "whether": "is the door open" into "the door is open"."""

from __future__ import annotations

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.facts.sharing import is_small
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["third", "turned"]

_ANY = frozenset(
    {"any", "anything", "anybody", "anyone", "some", "something", "somebody", "someone", "still", "anyone's"}
)
_SOMEBODY = frozenset(
    {"anything", "anybody", "anyone", "something", "somebody", "someone", "nobody", "nothing", "everything"}
)
_HELD_BACK = frozenset({"you", "we", "i"})


def turned(words: Phrase, scene: Scene) -> Phrase:
    """What a yes-or-no question asks about, as a statement; empty if it is no such question.

    Args:
        words: The question.
        scene: What is on the map.
    """
    words = tuple(word for word in words if word.is_word)
    flat = keys(words)
    if len(flat) < (2 if flat[:1] and flat[0] in _ANY else 3):
        return ()
    if flat[0] in _ANY:
        return (Word("there", "there"), Word("is", "is"), *words)
    if flat[0] == "do" and flat[1] in {"we", "they"} and "have" in flat[2:4] and "to" not in flat[3:5]:
        # "Do we still have any A in B": "we still have any A in B".
        return words[1:]
    if flat[0] not in lexicon().be | {"has", "have", "does", "do", "did", "can"} or flat[1] in _HELD_BACK:
        return ()
    verb, rest = Word(flat[0], flat[0]), words[1:]
    if flat[1] in {"there", "it", "he", "she", "they", "that", "this"}:
        return (rest[0], verb, *rest[1:])
    size = _subject(rest, scene)
    if flat[0] in {"does", "do", "did"}:
        done = () if size >= len(rest) else rest[size : size + 1]
        done = () if not done else (verb, *done) if flat[0] == "do" else (third(done[0]),)
        return (*rest[:size], *done, *rest[size + 1 :]) if done else ()
    return (*rest[:size], verb, *rest[size:]) if 0 < size < len(rest) else ()


def _subject(rest: Phrase, scene: Scene) -> int:
    """How many of the first words are what the question is about."""
    for size in range(len(rest) - 1, 0, -1):
        if ground_phrase(rest[:size], scene.objects, strict=True).outcome == "match":
            return scene.with_part(rest, size)
    if rest[0].key in _SOMEBODY and len(rest) > 1:
        return 2 if rest[1].key == "else" and len(rest) > 2 else 1
    placed = _with_place(rest, scene)
    if placed:
        return placed
    for size in (3, 2, 1):
        named = size < len(rest) and not is_small(rest[size - 1].key) and rest[size].key not in _TIED
        if named and bare(rest[:size]) and find_fact(rest[:size], scene.facts)[0] is not None:
            return size
    for size in (3, 2, 1):
        if size < len(rest) and scene.is_person(rest[:size]) and not scene.is_person(rest[: size + 1]):
            return size
    done = next((i for i in range(1, len(rest)) if rest[i].key in _DONE or rest[i].key.endswith("ed")), 0)
    if done:
        return done - 1 if done > 1 and rest[done - 1].key in _BETWEEN else done
    noun = noun_phrase(rest)
    if noun.relation:
        wanted = tuple(noun.relation.split())
        flat = keys(rest)
        cut = next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), len(flat))
        ending = next((i for i in range(1, cut) if flat[i].endswith(("ed", "ing"))), cut)
        return ending - 1 if ending < cut and flat[ending - 1] in _BETWEEN else ending
    return len(rest) - 1


def _with_place(rest: Phrase, scene: Scene) -> int:
    """Where "the lid of the tank", "the lamps in the hall" ends if something is said of it; 0 if not."""
    flat = keys(rest)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] == "of" or lexicon().places.match(flat, i)), 0)
    deed = at > 1 and flat[at - 1].endswith(("ing", "ed")) and flat[at - 2] not in lexicon().determiners
    if not at or deed or flat[0] in _ANY:
        return 0
    found = lexicon().places.match(flat, at)
    begin = at + (found[0] if found is not None and flat[at] != "of" else 1)
    for end in range(len(rest) - 1, begin, -1):
        if end < len(rest) - 1 and rest[end].key in _TIED:
            continue
        if ground_phrase(rest[begin:end], scene.objects, strict=True).outcome == "match":
            return end
    return 0


_TIED = frozenset({"of", "in", "on", "at", "with", "from", "for", "to", "and", "or", "by"})
_DONE = frozenset(
    word for word, base in lexicon().irregular.items() if base != word and not word.endswith("ing")
)
_BETWEEN = frozenset({"still", "already", "now", "really", "been"})


def third(verb: Word) -> Word:
    """A verb as it stands behind "it": "works", "has".

    Args:
        verb: Its base form.
    """
    ending = "es" if verb.key.endswith(("s", "sh", "ch", "x", "o")) else "s"
    said = "has" if verb.key == "have" else verb.key + ending
    return Word(said, said)
