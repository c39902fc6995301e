"""Statements strung together with commas, each with a subject and a verb of its own, parted by full stops.

"A asked for tea, she is cold": two sentences. Lines of one message are put together where a line cannot
stand alone and parted where it can.
"""

from __future__ import annotations

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["dislocated", "has_verb", "joined_lines", "parted", "subject_apart", "verb_at"]

_STOP = Word(".", ".")
_MARKS = frozenset({".", "!", "?", ";", "\n", ":"})
_SUBORDINATE = frozenset(
    {
        "if",
        "when",
        "unless",
        "because",
        "since",
        "while",
        "as",
        "once",
        "after",
        "before",
        "although",
        "whether",
        "until",
        "whenever",
        "in",
        "should",
        "provided",
        "either",
        "neither",
        "first",
        "where",
        "what",
        "who",
        "which",
        "how",
        "why",
        "not",
        "suppose",
        "assuming",
        "depending",
        "whichever",
        "whatever",
        "wherever",
    }
)
_KEEPING = frozenset({("forget",), ("remember",), ("note",), ("delete",)})
_POINTING = frozenset({"it", "he", "she", "they", "there", "nobody", "somebody", "someone"})
_JOINTS = frozenset({"so", "and", "but"})
_SUBJECTS = frozenset(
    {
        "i",
        "we",
        "he",
        "she",
        "it",
        "they",
        "there",
        "somebody",
        "someone",
        "nobody",
        "everybody",
        "everyone",
        "something",
        "nothing",
        "you",
        "this",
        "that",
        "my",
        "our",
        "his",
        "her",
        "their",
    }
)
_VERBS = frozenset(
    {
        "has",
        "have",
        "had",
        "was",
        "were",
        "is",
        "are",
        "am",
        "does",
        "did",
        "do",
        "will",
        "would",
        "should",
        "could",
        "can",
        "must",
        "might",
        "may",
        "went",
        "came",
        "got",
        "needs",
        "wants",
        "likes",
        "says",
        "said",
        "seems",
        "looks",
        "feels",
        "belongs",
        "lives",
        "works",
        "keeps",
        "stands",
        "lies",
        "sits",
        "hangs",
        "left",
        "fell",
        "broke",
        "lost",
        "forgot",
        "found",
        "heard",
        "saw",
        "think",
        "thought",
        "know",
        "hear",
        "see",
        "smell",
        "feel",
        "want",
        "need",
        "hope",
        "guess",
        "believe",
        "owns",
        "stays",
        "smells",
        "sounds",
        "asks",
        "loves",
        "hates",
        "prefers",
        "knows",
        "opens",
        "closes",
        "starts",
        "ends",
        "misses",
        "hurts",
        "told",
        "gets",
    }
)
_OF_SEVERAL = frozenset(
    {
        "end",
        "start",
        "begin",
        "go",
        "come",
        "need",
        "have",
        "like",
        "want",
        "close",
        "open",
        "live",
        "work",
        "take",
        "get",
        "arrive",
        "leave",
        "stay",
        "belong",
        "eat",
        "drink",
        "last",
        "cost",
        "run",
        "sleep",
        "meet",
        "stand",
        "lie",
        "hang",
        "wait",
    }
)
_FURTHEST_VERB = 7


def parted(words: Phrase) -> Phrase:
    """A message with a full stop between statements that only a comma or a line end parts."""
    words = dislocated(joined_lines(words))
    flat = keys(words)
    result: list[Word] = []
    start = 0
    for index, word in enumerate(words):
        if word.key in _MARKS:
            start = index + 1
        elif (word.key == "," and index > start + 1 and _between(words, flat, start, index)) or (
            word.key == "so" and index > start + 3 and _follows(words, flat, start, index)
        ):
            result.append(_STOP)
            start = index + 1
            continue
        elif start == index and word.key in _JOINTS and result and result[-1] is _STOP:
            start = index + 1
            continue
        result.append(word)
    return tuple(result)


def dislocated(words: Phrase) -> Phrase:
    """For "the red one, that is mine" "the red one is mine"."""
    flat = keys(words)
    for index in range(1, len(flat) - 3):
        if flat[index] != "," or flat[index + 1] not in {
            "that",
            "it",
            "this",
            "he",
            "she",
            "they",
            "those",
            "these",
        }:
            continue
        start = next((i + 1 for i in range(index - 1, -1, -1) if flat[i] in _MARKS | {","}), 0)
        named = words[start:index]
        if flat[index + 2] in lexicon().be | {"belongs", "belong"} and 1 < len(named) < 7 and _is_name(named):
            return (*words[:index], *words[index + 2 :])
    return words


def subject_apart(words: Phrase) -> Phrase:
    """For "A, he is over there, has left B" "A is over there. A has left B"."""
    flat = keys(words)
    for index in range(1, len(flat) - 4):
        aside = flat[index] == "," and flat[index + 1] in {"he", "she", "they", "who"}
        if not aside or flat[index + 2] not in lexicon().be | {"has", "works", "sits", "lives", "stands"}:
            continue
        end = next((i for i in range(index + 3, len(flat)) if not words[i].is_word), len(flat))
        goes_on = flat[end : end + 1] == (",",) and flat[end + 1 : end + 2] != () and flat[end + 1] in _VERBS
        start = next(
            (i + 1 for i in range(index - 1, -1, -1) if not words[i].is_word or flat[i] in _JOINTS), 0
        )
        named = words[start:index]
        if goes_on and 0 < len(named) < 5 and _is_name(named):
            told = (*named, *words[index + 2 : end], _STOP, *named, *words[end + 1 :])
            before = words[:start]
            while before and (not before[-1].is_word or before[-1].key in _JOINTS):
                before = before[:-1]
            return (*before, *((_STOP,) if before else ()), *told)
    return words


_ASKED = frozenset({"please", "on", "off", "up", "down"})
"""With these at its end what stands before a comma asks for something ("lights off, it is late")."""


def _is_name(words: Phrase) -> bool:
    flat = keys(words)
    first = flat[0] in lexicon().determiners or words[0].is_capital
    asked = bool(_ASKED & set(flat[1:]))
    return first and not asked and not has_verb(words) and not opens_command(words)


def verb_at(words: Phrase, within: int = _FURTHEST_VERB) -> int:
    """Where the verb of a statement stands; 0 if there is none."""
    flat = keys(words)
    return next(
        (
            i
            for i in range(1, min(within, len(flat)))
            if not (flat[i] == "saw" and flat[i + 1 : i + 2] and flat[i + 1] in _AFTER_NAMES)
            and (
                flat[i] in _VERBS | _PASTS
                or (flat[i].endswith("ed") and len(flat[i]) > 4)
                or flat[i] in _PAST
                or _says(words, i)
            )
        ),
        0,
    )


_AFTER_NAMES = lexicon().be | {"has", "had", "got", "needs"}
"""Behind "the band saw", where that is no verb."""


def _says(words: Phrase, index: int) -> bool:
    """Whether a word is a verb of the third person or of several ("drinks", "end")."""
    key, before = words[index].key, words[index - 1].key
    if before in lexicon().determiners or before.endswith("'s"):
        return False
    base = lemma(key)
    if key.endswith("s") and base != key:
        return True
    return key in _OF_SEVERAL and before.endswith("s")


_PASTS = frozenset(
    {
        "sold",
        "bought",
        "lent",
        "sent",
        "built",
        "taught",
        "paid",
        "chose",
        "became",
        "drew",
        "grew",
        "hid",
        "hung",
        "laid",
        "rose",
        "shook",
        "shot",
        "slept",
        "spent",
        "stole",
        "swam",
        "threw",
        "wore",
        "won",
        "caught",
        "felt",
        "fought",
        "froze",
        "lit",
        "sank",
        "stuck",
        "swept",
        "tore",
        "woke",
        "began",
        "broke",
        "gave",
        "took",
        "spoke",
        "drove",
        "swallowed",
        "held",
        "meant",
        "sat",
        "stood",
        "lay",
        "rang",
        "burst",
    }
)


def has_verb(words: Phrase, within: int = _FURTHEST_VERB) -> bool:
    """Whether a subject and a verb that says something of it stand at the start of words."""
    flat = keys(words)
    return any(
        flat[i] in _VERBS | _PASTS or (flat[i].endswith("ed") and len(flat[i]) > 4) or flat[i] in _PAST
        for i in range(1, min(within, len(flat)))
    )


_PAST = frozenset(
    word for word, base in lexicon().irregular.items() if not word.endswith("ing") and base != word
)


def _between(words: Phrase, flat: tuple[str, ...], start: int, comma: int) -> bool:
    """Whether whole statements stand on both sides of a comma."""
    before = words[start:comma]
    end = next((i for i in range(comma + 1, len(flat)) if flat[i] in _MARKS | {","}), len(flat))
    after = words[comma + 1 : end]
    while after and after[0].key in _JOINTS:
        after = after[1:]
    if len(before) > 2 and keys(after)[:1] in _KEEPING and len(after) > 1 and has_verb(before):
        return True
    if keys(after)[:1] in {("maybe",), ("perhaps",), ("probably",)} and len(before) > 2 and has_verb(after):
        return not opens_command(before)
    if len(before) < 3 or len(after) < 3 or flat[start] in _SUBORDINATE or "if" in keys(before):
        return False
    if opens_command(before):
        return keys(after)[0] in _POINTING and has_verb(after, 3)
    if not has_verb(before) or flat[start] in lexicon().auxiliaries:
        return False
    if keys(after)[0] in _SUBJECTS | lexicon().determiners or (
        after[0].is_capital and after[0].key not in _SUBORDINATE
    ):
        return has_verb(after)
    return False


def _follows(words: Phrase, flat: tuple[str, ...], start: int, at: int) -> bool:
    """Whether "so" joins two statements ("I moved it away so the way is free")."""
    before, after = words[start:at], words[at + 1 :]
    if flat[start] in _SUBORDINATE or opens_command(before) or not has_verb(before) or len(after) < 2:
        return False
    if opens_command(after):
        return True
    begins = (
        keys(after)[0] in {"the", "it", "he", "she", "they", "there", "we", "this"} or after[0].is_capital
    )
    return begins and has_verb(after) and keys(after)[0] != "that"


def joined_lines(words: Phrase) -> Phrase:
    """Line ends put right: none within a statement, a full stop between two."""
    flat = keys(words)
    if "\n" not in flat:
        return words
    result: list[Word] = []
    for index, word in enumerate(words):
        if word.key != "\n":
            result.append(word)
            continue
        following = flat[index + 1 : index + 2]
        line = _line_behind(words, index)
        continues = following and (
            following[0] in lexicon().be | _CONTINUING or lexicon().places.match(flat, index + 1) is not None
        )
        if continues and result and result[-1].is_word:
            continue
        if (
            result
            and result[-1].is_word
            and line
            and has_verb(tuple(_last_sentence(result)))
            and (has_verb(line, 9) or _verb_on_next_line(words, index))
        ):
            result.append(_STOP)
            continue
        result.append(word)
    return tuple(result)


_CONTINUING = frozenset(
    {"has", "have", "and", "belongs", "to", "of", "because", "which", "but", "or", "was", "were"}
)


def _line_behind(words: Phrase, index: int) -> Phrase:
    end = next((i for i in range(index + 1, len(words)) if words[i].key == "\n"), len(words))
    return words[index + 1 : end]


def _verb_on_next_line(words: Phrase, index: int) -> bool:
    end = next((i for i in range(index + 1, len(words)) if words[i].key == "\n"), len(words))
    return keys(words[end + 1 : end + 2]) in {(verb,) for verb in lexicon().be | _CONTINUING}


def _last_sentence(words: list[Word]) -> list[Word]:
    at = next((i + 1 for i in range(len(words) - 1, -1, -1) if words[i].key in _MARKS), 0)
    return words[at:]
