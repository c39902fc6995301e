"""What words of a message can be: the same place, what is looked for, what a story brings up."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from parley.language.offline.grammar.arguments import words_of
from parley.language.offline.grammar.small import is_past, small, verb_class
from parley.language.offline.grammar.things import Item
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, singular

__all__ = ["about_find", "is_what", "moved", "noun_of", "same_place", "says_where", "things_in"]


def same_place(a: Phrase, b: Phrase) -> bool:
    """Whether two names are the same words."""
    return bool(a) and keys(a) == keys(b)


def things_in(items: Iterable[Item]) -> list[Phrase]:
    """The names of all things among some items, one by one."""
    return [member for item in items if item.thing is not None for member in item.thing.members]


def is_what(words: Phrase) -> bool:
    """Whether a few words can be what is looked for ("leaks", "dirty cups", "lights left on please")."""
    flat = keys(words)
    while flat and flat[-1] in {"please", "thanks", "pls", "ta", "cheers"}:
        flat = flat[:-1]
    described = next((i for i in range(1, min(4, len(flat))) if _is_participle(flat[i])), 0)
    if described and singular(flat[described - 1]) != flat[described - 1] and len(flat) - described <= 5:
        flat = flat[:described]
    closed = (
        small().subjects | {"we", "you", "the", "not", "no", "yes", "please"} | lexicon().be | small().adverbs
    )
    if flat[:1] and flat[0] in small().prepositions:
        return False
    closed |= lexicon().question_starts | {"if", "once", "while", "as"}
    return 0 < len(flat) <= 3 and not set(flat) & closed and flat[-1].isalpha()


def _is_participle(word: str) -> bool:
    return bool(verb_class(word)) and (word.endswith("ing") or is_past(word))


def about_find(words: Phrase) -> bool:
    """Whether a condition is about what was just looked for ("if nobody is there", "if you find any")."""
    flat = set(keys(words))
    return bool(
        flat
        & {"there", "nobody", "none", "find", "see", "any", "some", "nothing", "found", "yes", "no", "not"}
        | (flat & small().sets["gone"])
    ) or (keys(words) in {("so",), ("it", "is"), ("they", "are"), ("that", "is", "the", "case")})


def noun_of(items: Sequence[Item]) -> Phrase:
    """The noun that a story brings up ("somebody left a jacket on the bench": a jacket)."""
    lost = bool(small().sets["gone"] & {item.key for item in items})
    for i, item in enumerate(items):
        owned = lost and item.key in {"my", "his", "her", "our", "their", "your", "the"}
        if item.key not in {"a", "an", "some", "another"} and not owned:
            continue
        end = i + 1
        follows = items[i + 2] if i + 2 < len(items) else None
        if follows is not None and items[end].key.endswith("ing") and is_noun(follows):
            end += 1
        while end < len(items) and is_noun(items[end]) and end - i < 4:
            end += 1
        links = end < len(items) and items[end].key in lexicon().be | {"has", "have", "'s", "went"}
        if end > i + 1 and (links or not owned):
            return words_of(items[i + 1 : end])
    return ()


def is_noun(item: Item) -> bool:
    key = item.key
    closed = (
        small().prepositions | small().adverbs | small().conjunctions | lexicon().be | small().determiners
    )
    return (
        item.thing is None
        and key[:1].isalpha()
        and key not in closed | {"who", "that", "which", "has", "have"}
        and not (verb_class(key) and key.endswith("ing"))
    )


def moved(what: Phrase, old: Sequence[Phrase], new: Sequence[Phrase]) -> Phrase:
    """What may be so, said of something else."""
    for phrase in old:
        wanted = keys(phrase)
        for at in range(len(what) - len(wanted) + 1):
            if keys(what[at : at + len(wanted)]) == wanted and new:
                return (*what[:at], *new[0], *what[at + len(wanted) :])
    return what


def says_where(items: Sequence[Item]) -> bool:
    """Whether somebody or something is said to be at a place ("the cart is parked in area C")."""
    flat = [item.key for item in items]
    if flat[:1] and flat[0] in {"nobody", "no", "none", "nothing", "if", "while"}:
        return False
    links = lexicon().be | {
        "moved",
        "gone",
        "went",
        "lies",
        "sits",
        "stands",
        "lives",
        "stays",
        "waits",
        "works",
    }
    at = next((i for i, item in enumerate(items) if i and item.thing is not None), 0)
    return at > 1 and flat[at - 1] in small().prepositions and bool(links & set(flat[:at]))
