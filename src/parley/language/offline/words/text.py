"""Words: cutting text into them, expanding contractions, base forms, mending typing errors."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from rapidfuzz.distance import OSA

from parley.language.offline.words.lexicon import lexicon

__all__ = [
    "Phrase",
    "Word",
    "keys",
    "lemma",
    "mend",
    "plain",
    "singular",
    "split_name",
    "tokens",
    "written_out",
]


@dataclass(frozen=True, slots=True)
class Word:
    """One word or punctuation mark."""

    key: str
    """Lower case, without accents of typography; what is compared."""
    raw: str
    """As written; what is repeated to people."""

    @property
    def is_word(self) -> bool:
        """Whether it is not punctuation."""
        first = self.key[:1]
        return first.isalnum() or (first == "-" and self.key.lstrip("-")[:1].isalnum())

    @property
    def is_capital(self) -> bool:
        """Whether it was written with a capital letter, as names are."""
        return self.raw[:1].isupper()


Phrase = tuple[Word, ...]

_TOKEN = re.compile(
    r"(?<![^\s(,;])-\d+(?:[.,]\d+)*|\d+(?:[.,]\d+)+|[^\W_]+(?:['-][^\W_]+)*'?|\.{2,}|[.,!?;:()\"]|\n",
    re.UNICODE,
)
_QUOTED = re.compile(r"(?<!\w)'([^\s'][^'\n]*)'(?!\w)")
"""Words between single quotation marks."""
_DASH = re.compile(r"\s+(?:[-=]+>|-+|[–—→])\s+")
"""Between words it parts them like a comma."""
_ABBREVIATIONS = tuple(
    (re.compile(pattern, re.IGNORECASE), full)
    for pattern, full in (
        (r"\b(mr|mrs|ms|dr|prof)\.(?=\s)", r"\1"),
        (r"(?<=\d)\s*([ap])\.m\.?(?!\w)", r"\1m"),
        (r"\be\.g\.,?", "for example"),
        (r"\bi\.e\.,?", "that is"),
        (r"\betc\.(?=\s+[a-z]|[,;:)])", ""),
        (r"\bapprox\.(?=\s)", "about"),
    )
)
"""Dots that end no sentence."""
_SUFFIX = {"n't": "not", "'re": "are", "'m": "am", "'ve": "have", "'ll": "will", "'d": "would"}


def written_out(text: str) -> str:
    """Text in which no dot belongs to an abbreviation ("Mr. X", "9 a.m.")."""
    for pattern, full in _ABBREVIATIONS if "." in text else ():
        text = pattern.sub(full, text)
    return text


_LABELLED = re.compile(r"(?<=[^\W_]_)[a-z](?![\w'])")


@lru_cache(maxsize=8192)
def tokens(text: str) -> Phrase:
    """Cut text into words and punctuation, contractions expanded.

    A possessive keeps its ``'s``; ``X's`` before something that can be said of X is read as "X is".
    """
    text = unicodedata.normalize("NFC", text).replace("’", "'").replace("‘", "'").replace("`", "'")
    text = text.replace("“", '"').replace("”", '"').replace("„", '"')
    text = _QUOTED.sub(r'"\1"', text)
    if "_" in text:
        # "lamp_a" is a name, whose letter is no article.
        text = _LABELLED.sub(lambda found: found.group().upper(), text)
    text = written_out(text)
    text = _DASH.sub(" , ", text).replace(" & ", " and ")
    raw = [match.group() for match in _TOKEN.finditer(text)]
    result: list[Word] = []
    for index, piece in enumerate(raw):
        following = raw[index + 1].lower() if index + 1 < len(raw) else ""
        behind = raw[index + 2].lower() if index + 2 < len(raw) else "."
        result.extend(_expand(piece, following, behind))
    return tuple(result)


_ANYBODY = frozenset(
    {"somebody", "someone", "everybody", "everyone", "nobody", "anybody", "something", "anyone"}
)
_BEHIND_STATE = frozenset({
    "now", "so", "and", "but", "again", "because", "at", "in", "on", "by", "with", "to", "until", "since",
    "today", "already", "too", "for", "please", "then", "or", "all", "as", "after", "before", "tonight",
    "up", "down", "anyway", "yet", "right", "till", "of", "from", "tomorrow", "properly", "fine", "over",
    "here", "there", "if", "when", "while", "though", "i", "we", "you", "they", "it", "he", "she", "open",
    "go", "drive", "come", "head", "wait", "carry", "stay", "tell", "just", "check", "bring", "apart",
})  # fmt: skip
"""What follows "the box's empty", as against "the box's empty lid"."""


_HAVING_DONE = frozenset({"been", "got", "gone", "moved", "had", "become", "come", "left", "run", "lost"})
"""What follows "the box's been moved"."""


def _expand(piece: str, following: str, behind: str) -> list[Word]:
    low = piece.lower()
    if low in lexicon().contractions:
        parts = lexicon().contractions[low].split()
        return [Word(part, piece if len(parts) == 1 else part) for part in parts]
    for suffix, meaning in _SUFFIX.items():
        if low.endswith(suffix) and len(low) > len(suffix):
            stem = piece[: -len(suffix)]
            return [Word(stem.lower(), stem), Word(meaning, meaning)]
    if low.endswith("'s") and len(low) > 2:
        stem = piece[:-2]
        anybody = stem.lower() in _ANYBODY and (following.endswith("ing") or following in lexicon().states)
        ends = behind in _BEHIND_STATE or not behind[0].isalnum()
        said = anybody or (following in lexicon().states and ends)
        has_done = following in _HAVING_DONE and (low, following) != ("what's", "left")
        if has_done and behind not in lexicon().nouns:
            return [Word(stem.lower(), stem), Word("has", "has")]
        if stem.lower() in lexicon().is_subjects or following in lexicon().after_is or said:
            return [Word(stem.lower(), stem), Word("is", "is")]
    # "The boxes' lids" keeps its mark where it is repeated to people.
    return [Word(low.rstrip("'"), piece if low.endswith("s'") else piece.rstrip("'"))]


def keys(phrase: Iterable[Word]) -> tuple[str, ...]:
    """What is compared, word by word."""
    return tuple([word.key for word in phrase])


def plain(phrase: Sequence[Word]) -> str:
    """The text of a phrase as written; marks stand at the word before, quotation marks at what they hold."""
    text, quoted, opened = "", False, False
    for word in phrase:
        mark = word.key == '"'
        close = opened or (not word.is_word and (not mark or quoted))
        text += word.raw if not text or close else " " + word.raw
        quoted ^= mark
        opened = mark and quoted
    return text.strip()


@lru_cache(maxsize=8192)
def lemma(word: str, verbs: frozenset[str] | None = None) -> str:
    """The base form of a verb as far as the list of known verbs tells; otherwise the word itself."""
    known = _verb_words() if verbs is None else verbs
    irregular = lexicon().irregular
    if word in irregular:
        return irregular[word]
    if word in known:
        return word
    for suffix, endings in (
        ("ing", ("", "e")),
        ("ied", ("y",)),
        ("ed", ("", "e")),
        ("ies", ("y",)),
        ("es", ("", "e")),
        ("s", ("",)),
    ):
        if word.endswith(suffix) and len(word) > len(suffix) + 1:
            stem = word[: -len(suffix)]
            for ending in endings:
                if stem + ending in known:
                    return stem + ending
            if suffix in ("ing", "ed") and len(stem) > 2 and stem[-1] == stem[-2] and stem[:-1] in known:
                return stem[:-1]
    return word


_KNOWN_VERBS: list[frozenset[str]] = []


def _verb_words() -> frozenset[str]:
    if not _KNOWN_VERBS:
        classes = lexicon().verb_classes.values()
        _KNOWN_VERBS.append(frozenset(verb.split()[0] for listed in classes for verb in listed))
    return _KNOWN_VERBS[0]


_US_PLURALS = ("buses", "ruses", "puses", "tuses", "cuses", "nuses", "gases", "lenses")
_USE_WORDS = ("ouses", "auses", "fuses", "peruses", "excuses", "abuses", "recuses", "accuses")


@lru_cache(maxsize=8192)
def singular(noun: str) -> str:
    """The singular of a regular English noun (words that are no plural come back unchanged)."""
    if noun in lexicon().plurals:
        return lexicon().plurals[noun]
    if len(noun) > 4 and noun.endswith("ies"):
        return noun[:-3] + "y"
    if len(noun) > 4 and noun.endswith(("ches", "shes", "sses", "xes", "zes")):
        return noun[:-2]
    if len(noun) > 4 and noun.endswith(_US_PLURALS) and not noun.endswith(_USE_WORDS):
        # "Buses", "viruses": not "houses", "uses".
        return noun[:-2]
    if len(noun) > 3 and noun.endswith("s") and not noun.endswith(("ss", "us", "is")):
        return noun[:-1]
    return noun


def split_name(name: str) -> tuple[str, ...]:
    """The words of a camel- or snake-case name, lower case."""
    spaced = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)
    return tuple(re.findall(r"[a-z]+|\d+", spaced.lower()))


def closest(word: str, vocabulary: Iterable[str], *, dropped: bool = False) -> str | None:
    """The one word that `word` is a typing error of, or None.

    Letters, digits and short words are never errors of one another; the first letter must be right unless two
    letters are swapped.

    Args:
        word: What was typed.
        vocabulary: What may be meant.
        dropped: Whether even in a word of four letters one may have been left out.
    """
    if len(word) < 3 or not word.isalpha():
        return None
    limit = 1 if len(word) < 7 else 2
    best: dict[int, set[str]] = {}
    for known in vocabulary:
        if abs(len(known) - len(word)) > limit or len(known) < 3 or not known.isalpha():
            continue
        swapped = sorted(known) == sorted(word)
        lengths = {len(word), len(known)}
        short = min(lengths) < 5 and lengths != {4, 5} and not (dropped and lengths == {3, 4})
        if short and not swapped:
            continue
        if known[0] != word[0] and not swapped:
            continue
        distance = OSA.distance(word, known, score_cutoff=limit)
        if distance <= limit:
            best.setdefault(distance, set()).add(known)
    if not best:
        return None
    nearest = best[min(best)]
    return nearest.pop() if len(nearest) == 1 else None


_COMMON = (
    "look",
    "find",
    "take",
    "move",
    "drive",
    "bring",
    "check",
    "visit",
    "stop",
    "tell",
    "inspect",
    "go",
)
"""What a short misspelt word at the start of an order most likely was."""
_BEFORE_VERBS = frozenset(
    [
        ",",
        ".",
        "!",
        "?",
        ";",
        "and",
        "then",
        "please",
        "you",
        "to",
        "first",
        "not",
        "but",
        "now",
        "just",
        "finally",
        "kindly",
        "let",
        "us",
    ]
)


def mend(phrase: Phrase, known: frozenset[str], small: frozenset[str], verbs: frozenset[str]) -> Phrase:
    """Replace typing errors among words that nobody knows; names keep their spelling.

    Args:
        phrase: The words.
        known: What is no error.
        small: Words that may be meant anywhere.
        verbs: Words that may be meant where a clause begins.
    """
    result: list[Word] = []
    for index, word in enumerate(phrase):
        name = word.is_capital and not word.raw.isupper() and (index > 0 or _is_subject(phrase))
        if not word.is_word or word.key in known or name or _inflected(word.key, known):
            result.append(word)
            continue
        opens = not result or result[-1].key in _BEFORE_VERBS
        better = closest(word.key, small | verbs if opens else small)
        if better not in _NOMINAL and result and result[-1].key in _ARTICLES:
            # "The form" is no "the from".
            better = None
        if better is None and opens and len(word.key) > 2:
            near = [verb for verb in _COMMON if OSA.distance(verb, word.key) == 1 and verb[0] == word.key[0]]
            better = near[0] if len(near) == 1 else None
        result.append(replace(word, key=better, raw=better) if better else word)
    return tuple(result)


_ARTICLES = frozenset({"the", "a", "an", "my", "your", "this"})
_NOMINAL = frozenset({
    "front", "room", "first", "second", "next", "other", "back", "step", "hungry", "thirsty", "inside",
    "outside",
})  # fmt: skip
"""What may stand behind an article."""


def _is_subject(phrase: Phrase) -> bool:
    """Whether a message begins with a name of which something is said ("Charly is in the hall")."""
    return len(phrase) > 2 and phrase[1].key in lexicon().be | {"has", "wants", "needs", "would", "and"}


def _inflected(word: str, known: frozenset[str]) -> bool:
    return singular(word) in known or lemma(word) in known
