"""Names of things that begin like an order ("lift B", "copy room") get their article."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.units import spans
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular

__all__ = ["back_to_first", "verb_first", "with_articles"]

IsStop = Callable[[Phrase], bool]

_BEFORE = frozenset(
    {
        "and",
        "then",
        "or",
        "but",
        ",",
        ".",
        "!",
        ";",
        ":",
        "\n",
        "also",
        "first",
        "next",
        "finally",
        "please",
        "to",
        "at",
    }
)


def with_articles(words: Phrase, is_stop: IsStop) -> Phrase:
    """The same message with "the" before names that begin with a verb, where a clause may begin."""
    flat = keys(words)
    starts = {
        start
        for start, end in spans(words, is_stop)
        if end - start > 1
        and lexicon().verbs.match((lemma(flat[start]), *flat[start + 1 :])) is not None
        and (start == 0 or flat[start - 1] in _BEFORE)
    }
    result: list[Word] = []
    for i, word in enumerate(words):
        if i in starts and _stops_at(flat, i):
            result.append(Word("visit", "visit"))
        elif i - 1 not in starts or not _stops_at(flat, i - 1):
            result += (Word("the", "the"), word) if i in starts else (word,)
    return tuple(result)


def _stops_at(flat: tuple[str, ...], start: int) -> bool:
    """For "stop at A" where the map has a bus stop: what is done there, and no stop that is at A."""
    verb = lexicon().verbs.match(flat, start)
    return verb is not None and verb[0] == 2 and flat[start + 1] in {"at", "by", "near"}


_SMALL = frozenset(
    {"just", "only", "please", "it", "there", "this", "that", "one", "to", "also", "again", "quickly", "a"}
)
_ENDS = frozenset({".", "!", "?", ";", "\n"})


def verb_first(words: Phrase, is_stop: IsStop) -> Phrase:
    """For lists like "the desk: inspect": "inspect the desk"."""
    result: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _ENDS:
            continue
        result += (*_turned(words[start:index], is_stop), *words[index : index + 1])
        start = index + 1
    return tuple(result)


def _turned(sentence: Phrase, is_stop: IsStop) -> Phrase:
    flat = keys(sentence)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in {",", ":"}), 0)
    kind, name = _visit(sentence[:at])
    if not at or not is_stop(name):
        return sentence
    what = _sought(sentence[at + 1 :], listed=kind == "look" and flat[at] == ":")
    if what:
        return (*_plain("inspect"), *name, *_plain("for"), *what)
    deed = tuple(word for word in sentence[at + 1 :] if word.key not in _SMALL)
    found = lexicon().verbs.match(keys(deed)) if deed and not kind else None
    kind = found[1].partition(":")[0] if found is not None else ""
    if found is None or found[0] != len(deed) or kind not in {"look", "motion"}:
        return sentence
    return (*_plain("inspect" if kind == "look" else "go to"), *sentence[:at])


def _visit(words: Phrase) -> tuple[str, Phrase]:
    """What is to be done ("look", "motion"; empty if nothing says so), and where."""
    while words and words[0].key in _LEADS:
        words = words[1:]
    flat = keys(words)
    found = lexicon().verbs.match(flat) if flat else None
    kind = found[1].partition(":")[0] if found is not None else ""
    if found is None or kind not in {"look", "motion"}:
        return "", words
    goal = lexicon().goals.match(flat, found[0])
    return kind, words[found[0] + (goal[0] if goal is not None else 0) :]


def _sought(words: Phrase, *, listed: bool) -> Phrase:
    """What to look for: "for the bag", and behind a colon a list of things ("lights, windows")."""
    what = words[1:] if keys(words[:1]) == ("for",) else words if listed else ()
    flat = keys(what)
    if not flat or len(flat) > _LONGEST_LIST or set(flat) & _NO_THINGS or duration_s(what) is not None:
        return ()
    heads = [i for i in range(len(flat)) if not i or flat[i - 1] in {",", "and", "or"}]
    acts = any(lexicon().verbs.match(flat, i) and not _is_thing(flat, i) for i in heads)
    return () if acts or lexicon().places.match(flat) is not None else what


def _is_thing(flat: tuple[str, ...], at: int) -> bool:
    """Whether a word that may be a verb is a thing ("lights")."""
    return singular(flat[at]) in lexicon().nouns or singular(flat[at]) != flat[at]


def _plain(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())


_LEADS = frozenset({"just", "only", "please", "then", "and", "also", "next", "now"})
_LONGEST_LIST = 10
_NO_THINGS = (
    lexicon().be
    | lexicon().auxiliaries
    | lexicon().question_starts
    | frozenset(
        {
            "me",
            "us",
            "now",
            "today",
            "once",
            "it",
            "them",
            "that",
            "you",
            "i",
            "we",
            "if",
            "then",
            "not",
            "no",
        }
    )
)


_BEGAN = tuple(
    ("where", "you", *verb)
    for verb in (
        ("began",),
        ("started",),
        ("set", "off"),
        ("set", "out"),
        ("started", "from"),
        ("were", "first"),
    )
)


def back_to_first(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "begin at A, ... and finish where you began": the first name again."""
    flat = keys(words)
    at = next((i for i in range(3, len(flat)) if any(flat[i : i + len(m)] == m for m in _BEGAN)), 0)
    named = spans(words[:at], is_stop) if at else []
    if not named or flat[at - 1] in {"look", "check", "remember", "ask"}:
        return words
    size = next(len(m) for m in _BEGAN if flat[at : at + len(m)] == m)
    first = words[named[0][0] : named[0][1]]
    start = next((i for i in range(at - 1, max(at - 7, 0), -1) if flat[i] in {",", "and", "then", "."}), 0)
    said = words[:start]
    while said and (not said[-1].is_word or said[-1].key in {"and", "then"}):
        said = said[:-1]
    go = tuple(Word(part, part) for part in (".", "go", "to"))
    return (*said, *go, *first, *words[at + size :]) if said else words
