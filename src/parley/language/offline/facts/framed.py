"""What is told, without what only frames it: "just so you are aware, S", "note. S", "S, keep that in mind".

A frame is made of small words and at least one that speaks of knowing or keeping, in any order.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.replacing import put_plainly
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.finite import has_verb, verb_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["asked_to_keep", "told_plainly"]

_DATA = load_data("telling")
_KEEPING = frozenset(_DATA["keeping"])
_AROUND = frozenset(_DATA["around_keeping"])
_BEHIND = frozenset(_DATA["behind_keeping"])
_ENDS = frozenset({".", "!", "?", ";", "\n"})
_MARKS = _ENDS | {",", ":", "-"}
_NEEDS = {
    "know": frozenset({"you", "everyone", "everybody", "good"}),
    "mind": frozenset({"in", "my", "our", "your"}),
    "forget": frozenset({"not", "before", "never"}),
    "forgetting": frozenset({"not", "before", "never"}),
    "forgot": frozenset({"almost", "nearly"}),
    "tell": frozenset({"to", "let"}),
    "told": frozenset({"be", "to"}),
    "aware": frozenset({"you", "be"}),
    "heard": frozenset({"i", "we", "you"}),
    "hear": frozenset({"you"}),
    "words": frozenset({"mark"}),
}
"""Words that frame something told only beside others."""
_MISTAKES = frozenset({"wrong", "mistake", "mistaken", "correction", "error", "misspoke", "mixed"})
_ORDERING = frozenset({
    "want", "need", "wants", "needs", "is", "are", "do", "like", "plan", "will", "would", "should", "go",
    "check", "whether", "if", "following", "find",
})  # fmt: skip
_DAYS = frozenset(load_data("words")["months_days"])
_LONGEST = 14


def told_plainly(words: Phrase) -> Phrase:
    """A message with "remember that" in place of what frames something told.

    Args:
        words: All words and punctuation.
    """
    if "?" in keys(words[-1:]):
        return _asked_to_keep_so(words)
    words = put_plainly(words)
    result: list[Word] = []
    start = before = 0
    while start < len(words):
        end = next((i for i in range(start, len(words)) if words[i].key in _ENDS), len(words))
        size = _frame(words[start:])
        if before < len(result) and _is_frame(words[start:end]) and _is_news(tuple(result[before:])):
            # "S. Keep that in mind."
            result[before:before] = _REMEMBER
            start = end + 1
            continue
        before = len(result)
        if size:
            start += size
            end = next((i for i in range(start, len(words)) if words[i].key in _ENDS), len(words))
            result += (*_REMEMBER, *words[start : end + 1])
        else:
            result += (*_without_tail(words[start:end]), *words[end : end + 1])
        start = end + 1
    return tuple(result)


def _asked_to_keep_so(words: Phrase) -> Phrase:
    """For "S, would you be so kind as to keep that in mind?": the same as without the question."""
    end = max((i for i, word in enumerate(words[:-1]) if word.key == ","), default=0)
    polite = strip_openers(words[end + 1 : -1], requests=True)
    asks = end and len(polite) < len(words) - end - 2 and _is_frame(polite)
    return (
        (*_REMEMBER, *words[:end], Word(".", ".")) if asks and _tells(words[:end], telegram=False) else words
    )


_REMEMBER = (Word("remember", "remember"), Word("that", "that"))


def asked_to_keep(sentence: Phrase) -> Phrase:
    """What a sentence asks to remember in so many words ("note that S", "make a note: S"); empty if nothing.

    Args:
        sentence: Its words, without courtesy at its start.
    """
    flat = keys(sentence)
    lead = next((lead for lead in _LEADS if flat[: len(lead)] == lead), ())
    end = next((i for i in range(len(lead), min(len(flat), _LONGEST)) if flat[i] in {"that", ":", ","}), 0)
    if not lead or not end or not set(flat[len(lead) : end]) <= _AROUND | _BEHIND | {"on", "from"}:
        return ()
    return sentence[end + 1 :] if _tells(sentence[end + 1 :], telegram=False) else ()


_LEADS = tuple(
    tuple(text.split())
    for text in (
        "remember", "note", "note down", "make a note", "bear in mind", "keep in mind", "do not forget",
        "never forget", "take note", "write down", "be aware", "please remember", "please note",
        "always remember", "for your information", "fyi", "just so you know", "for the record",
    )
)  # fmt: skip


def _is_frame(sentence: Phrase) -> bool:
    """Whether a sentence only asks to keep what was said before it."""
    flat = keys(word for word in sentence if word.is_word)
    kept = any(key in _KEEPING and _keeps(flat, i) for i, key in enumerate(flat))
    points = {"that", "it", "this", "down"} & set(flat)
    return 1 < len(flat) < 9 and kept and bool(points) and set(flat) <= _AROUND | _KEEPING | {"and"}


def _is_news(sentence: Phrase) -> bool:
    """Whether a sentence may be kept as it stands."""
    said = tuple(word for word in sentence if word.key not in _ENDS)
    return keys(said[:2]) != keys(_REMEMBER) and _tells(said, telegram=True) and not opens_command(said)


def _frame(words: Phrase) -> int:
    """How many words frame what is told behind them; 0 if nothing does."""
    flat = keys(words[:_LONGEST])
    before = flat.index(":") if ":" in flat[:7] else 0
    small = lexicon().small - _ORDERING
    if before and set(flat[:before]) <= small and _tells_plainly(words[before + 1 :]):
        # "Before you start: S".
        return before + 1
    size = next((i for i, key in enumerate(flat) if key not in _AROUND | _KEEPING | {","}), len(flat))
    kept = max((i for i in range(size) if flat[i] in _KEEPING and _keeps(flat[:size], i)), default=-1)
    if kept < 0 or flat[:1] == ("remember",):
        return 0
    end = _end_of_frame(words, kept + 1, size, late="before" in flat[:kept])
    mark = words[end].key if end < len(words) else ""
    mistaken = flat[kept] in _MISTAKES
    if mistaken and mark not in _MARKS - {"?"}:
        return 0
    telegram = mark in {":", ".", "!", "-"} and not mistaken
    while end < len(words) and (not words[end].is_word or words[end].key == "that"):
        end += 1
    return end if _tells(words[end:], telegram=telegram) else 0


def _end_of_frame(words: Phrase, end: int, size: int, *, late: bool) -> int:
    """Where the small words behind a frame end; `late` for "before it slips my mind again, ..."."""
    if late and "," in keys(words[end : end + 8]):
        end += keys(words[end : end + 8]).index(",")
    while end < len(words) and words[end].key in _BEHIND and _is_behind(words, end):
        end += 1
    mark = next((i for i in range(end, min(end + 4, len(words))) if words[i].key in {":", ".", "!"}), end)
    return mark if mark <= size else end


def _tells_plainly(words: Phrase) -> bool:
    """Whether a statement with a verb of its own begins here, that nobody can take for an order."""
    return bool(words) and words[0].key in lexicon().determiners and _tells(words, telegram=False)


def _keeps(flat: tuple[str, ...], index: int) -> bool:
    """Whether a word says there that something is to be known."""
    needed = _NEEDS.get(flat[index])
    return needed is None or bool(needed & set(flat[:index]))


def _is_behind(words: Phrase, index: int) -> bool:
    """Whether a small word still belongs to the frame ("this" in "note this: S")."""
    if words[index].key == "the":
        return keys(words[index + 1 : index + 2]) == ("following",)
    if words[index].key not in {"it", "this", "that", "down"}:
        return True
    following = keys(words[index + 1 : index + 2])
    return not following or following[0] in _MARKS | _BEHIND


def _tells(words: Phrase, *, telegram: bool) -> bool:
    """Whether what stands behind a frame says that something is so."""
    end = next((i for i, word in enumerate(words) if word.key in _ENDS), len(words))
    said = words[:end]
    flat = keys(said)
    if len(said) < 3 or keys(words[end : end + 1]) == ("?",):
        return False
    if flat[0] in lexicon().question_starts | {"if", "to", "you", "please", "whether", "do", "about"}:
        return False
    if flat[:2] in {("at", "rest"), ("at", "ease")}:
        # "It would put my mind at rest if ...": nothing is told.
        return False
    if telegram and _DAYS & set(flat):
        # "Do not forget: fire drill on Friday".
        return True
    if opens_command(said) and verb_at(said, 5) == 0:
        return False
    return telegram or has_verb(said) or verb_at(said) > 0


def _without_tail(sentence: Phrase) -> Phrase:
    """For "S, keep that in mind" "remember that S"."""
    flat = keys(sentence)
    for cut in range(max(3, len(flat) - 9), len(flat) - 1):
        tail = flat[cut + 1 :] if flat[cut] == "," else flat[cut:]
        joined = flat[cut] in {",", "and", "so", "just", "for", "in"}
        if not joined or not set(tail) <= _AROUND | _KEEPING | {"and"}:
            continue
        kept = any(tail[i] in _KEEPING and _keeps(tail, i) for i in range(len(tail)))
        head = sentence[:cut]
        while head and not head[-1].is_word:
            head = head[:-1]
        if kept and _tells(head, telegram=False) and not opens_command(head):
            return (*_REMEMBER, *head)
    return sentence
