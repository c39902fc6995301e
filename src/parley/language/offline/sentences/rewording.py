"""Other ways to say the same, put into the order of words that the rest reads.

"Whichever door is closer" is "the nearest door", "A first, B second" is "A, then B", "pick any box and go
there" is "go to any box", "A or, if it is shut, B" is "A. If it is shut, B".
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.scene.marks import marks_of
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.laconic import SEEN, laconic
from parley.language.offline.sentences.ranking import participle_order, ranked
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, singular

__all__ = ["reworded"]

Grounds = Callable[[Phrase], bool]
_SUPERLATIVE = {
    "closer": "nearest", "nearer": "nearest", "closest": "nearest", "nearest": "nearest",
    "farther": "farthest", "further": "farthest", "farthest": "farthest", "furthest": "farthest",
    "bigger": "bigger", "larger": "larger", "smaller": "smaller", "biggest": "biggest", "largest": "largest",
    "smallest": "smallest",
}  # fmt: skip
_THEN = (Word(",", ","), Word("then", "then"))
_STOP = Word(".", ".")
_COMMA = Word(",", ",")
_PAUSES = {",", "and", "but", "then"}


def reworded(words: Phrase, grounds: Grounds, *, timed: bool = False) -> Phrase:
    """The same message in plainer order.

    Args:
        words: All words and punctuation.
        grounds: Whether words name something on the map.
        timed: Whether actions of this robot take how long they last: then "for a minute" belongs to them.
    """
    for change in (
        _left_out,
        _which_are,
        _you_do,
        _whichever,
        _that_is,
        _choosing,
        ranked,
        participle_order,
        _until,
    ):
        words = words if timed and change is _until else change(words)
    return laconic(_or_if(_fallback(words, grounds)), grounds)


def _you_do(words: Phrase) -> Phrase:
    """For "please you go to the desk, then you look": an order, as people say it who are new to English."""
    result: list[Word] = []
    flat = keys(words)
    for index, word in enumerate(words):
        before = flat[index - 1] if index else "."
        verb = lexicon().verbs.match(flat, index + 1)
        orders = verb is not None and not verb[1].startswith("other:") and flat[index + 1] not in _HELPING
        if word.key == "you" and orders and before in _BEFORE_YOU:
            continue
        result.append(word)
        if (
            word.key == "you"
            and orders
            and flat[max(index - 2, 0) : index] in {("i", "want"), ("i", "need"), ("we", "want")}
        ):
            result.append(_word("to"))
    return tuple(result)


_HELPING = lexicon().auxiliaries | lexicon().be | frozenset({"found", "left", "saw", "told"})
_BEFORE_YOU = frozenset({".", ",", "please", "then", "and", "now", "!", "?"})


def _left_out(words: Phrase) -> Phrase:
    """For "leave the desk out" "leave out the desk"."""
    flat = keys(words)
    at = next((i for i, word in enumerate(flat) if word in {"leave", "leaving"}), -1)
    out = next((i for i in range(at + 2, min(at + 7, len(flat))) if flat[i] == "out"), 0) if at >= 0 else 0
    if not out or (
        flat[out + 1 : out + 2] in {("of",), ("for",), ("in",)} and flat[out + 3 : out + 4] != ("plan",)
    ):
        return words
    return (*words[: at + 1], words[out], *words[at + 1 : out], *words[out + 1 :])


_WHICH = (
    ("tell", "me"),
    ("tell", "us"),
    ("find", "out"),
    ("see",),
    ("check",),
    ("report",),
    ("look",),
    ("say",),
)


def _which_are(words: Phrase) -> Phrase:
    """For "tell me which box is open", "go round all boxes and tell me which are open": each is looked at."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 2) if flat[i] == "which"), 0)
    start = next((at - len(m) for m in _WHICH if flat[max(at - len(m), 0) : at] == m), -1)
    link = next((i for i in range(at + 1, min(at + 7, len(flat) - 1)) if flat[i] in {"is", "are"}), 0)
    if start < 0 or not link or flat[link + 1] not in SEEN:
        return words
    noun = words[at + 1 : link]
    noun = noun[2:] if keys(noun[:2]) == ("of", "the") else noun
    if noun and keys(noun) not in {("ones",), ("one",), ("of", "them")}:
        last = noun[-1] if singular(noun[-1].key) != noun[-1].key else _word(_plural(noun[-1].key))
        return (
            *words[:start],
            *_words("check whether all"),
            *noun[:-1],
            last,
            _word("are"),
            *words[link + 1 :],
        )
    every = next((i for i in range(start) if flat[i] in lexicon().quantifiers or marks_of(words[i])), -1)
    end = next((i for i in range(every, start) if flat[i] in {"and", ",", "."}), start)
    if every < 0:
        return words
    return (*_words("check whether"), *words[every:end], _word("are"), *words[link + 1 :])


def _plural(noun: str) -> str:
    return f"{noun}es" if noun.endswith(("s", "x", "ch", "sh")) else f"{noun}s"


def _word(text: str) -> Word:
    return Word(text, text)


def _whichever(words: Phrase) -> Phrase:
    """For "whichever door is closer (to you)", "whatever is nearest to the desk"."""
    flat = keys(words)
    at = next((i for i, word in enumerate(flat) if word in {"whichever", "whatever"}), -1)
    links = lexicon().be | lexicon().location_verbs
    link = next((i for i in range(at + 1, min(at + 6, len(flat))) if flat[i] in links), 0)
    if at < 0 or not link:
        return words
    if link == at + 1 and lexicon().places.match(flat, link + 1) is not None:
        # "Whatever is next to the desk".
        return (*words[:at], _word("the"), _word("thing"), *words[link + 1 :])
    how = link + 1 + (flat[link + 1 : link + 2] == ("the",))
    best = _SUPERLATIVE.get(flat[how] if how < len(flat) else "", "")
    if not best:
        return words
    noun = words[at + 1 : link]
    noun = noun[2:] if keys(noun[:2]) == ("of", "the") else noun
    return (*words[:at], *_compared(best, noun or (_word("thing"),), words[how + 1 :]))


def _compared(best: str, noun: Phrase, rest: Phrase) -> Phrase:
    """For "the nearest door", or "the door nearest to X"."""
    flat = keys(rest)
    if flat[:1] == ("away",):
        rest, flat = rest[1:], flat[1:]
    if flat[:2] in {("to", "you"), ("from", "you"), ("from", "here"), ("to", "here"), ("by", "foot")}:
        rest, flat = rest[2:], flat[2:]
    if flat[:1] in {("to",), ("from",)}:
        return (_word("the"), *noun, _word(best), *rest)
    return (_word("the"), _word(best), *noun, *rest)


def _that_is(words: Phrase) -> Phrase:
    """For "the door that is farther away"."""
    flat = keys(words)
    for at in range(2, len(flat) - 2):
        if flat[at] not in {"that", "which"} or flat[at + 1] not in lexicon().be:
            continue
        how = at + 2 + (flat[at + 2] == "the")
        best = _SUPERLATIVE.get(flat[how] if how < len(flat) else "", "")
        start = next((i for i in range(at - 1, max(at - 6, -1), -1) if flat[i] == "the"), -1)
        if best and start >= 0:
            return (*words[:start], *_compared(best, words[start + 1 : at], words[how + 1 :]))
    return words


_CHOOSING = ("pick", "choose", "select", "take", "pick out", "decide on")
_FREE = (
    ("any", "of", "the"),
    ("one", "of", "the"),
    ("either", "of", "the"),
    ("any",),
    ("either",),
    ("some",),
    ("a",),
)


def _choosing(words: Phrase) -> Phrase:
    """For "pick any box and go there" "go to any box"."""
    flat = keys(words)
    start = next((i for i, word in enumerate(flat[:6]) if word in _CHOOSING), -1)
    if start < 0:
        return words
    free = next((f for f in _FREE if flat[start + 1 : start + 1 + len(f)] == f), ())
    end = next((i for i in range(start + 2, len(flat)) if flat[i] in _PAUSES), 0)
    if not free or not end or (flat[start] == "take" and free == ("a",)):
        return words
    rest = words[end + 1 :]
    while rest and (rest[0].key in _PAUSES or not rest[0].is_word):
        rest = rest[1:]
    noun = words[start + 1 + len(free) : end]
    at = next((i for i, w in enumerate(rest) if w.key in {"there", "it", "that", "one"}), -1)
    if at < 0 or not noun or not opens_command(rest):
        return words
    size = 2 if keys(rest[at : at + 2]) == ("that", "one") else 1
    going = (lexicon().verbs.match(keys(rest)) or (0, ""))[1].startswith("motion:")
    link = (_word("to" if going else "at"),) if rest[at].key == "there" else ()
    named = (*link, _word("any"), *noun)
    if len(free) > 1:
        named = (*link, *(_word(part) for part in ("one", "of", "the")), *noun)
    return (*words[:start], *rest[:at], *named, *rest[at + size :])


_STAYING = frozenset(
    {
        "wait",
        "stay",
        "remain",
        "hang",
        "stick",
        "linger",
        "hover",
        "pause",
        "stand",
        "park",
        "hold",
        "keep",
        "watch",
        "monitor",
        "guard",
        "observe",
    }
)


def _until(words: Phrase) -> Phrase:
    """For "wait at the desk until A comes", "stay there for five minutes": being there, then waiting."""
    flat = keys(words)
    verb = next(
        (i for i in range(len(flat)) if flat[i] in _STAYING and (i == 0 or opens_command(words[i:]))), -1
    )
    if verb >= 0 and flat[verb + 1 : verb + 2] == ("for",):
        return _waiting_there(words, verb)
    if verb < 0 or flat[verb + 1 : verb + 2] in {("until",), ("for",), ("till",), ()}:
        return words
    for at in range(verb + 2, len(flat) - 1):
        if flat[at] in {".", "!", "?", ";"}:
            break
        if flat[at] in {"until", "till"}:
            return (*words[:at], *_THEN, _word("wait"), _word("until"), *words[at + 1 :])
        end = next((e for e in range(at + 2, min(at + 6, len(flat) + 1)) if _is_span(words[at:e])), 0)
        if flat[at] == "for" and end and flat[at - 1] not in {"wait", "stay", "remain", "hold"}:
            return (*words[:at], *_THEN, _word("wait"), *_counted(words[at:end]), *words[end:])
    return words


def _waiting_there(words: Phrase, verb: int) -> Phrase:
    """For "wait for ten seconds at the desk": there, for ten seconds."""
    flat = keys(words)
    start = verb + 1
    end = next((e for e in range(start + 2, min(start + 6, len(flat))) if _is_span(words[start:e])), 0)
    stop = next(
        (i for i in range(end, len(flat)) if flat[i] in {".", ",", "!", "?", "and", "then"}), len(flat)
    )
    if not end or lexicon().places.match(flat, end) is None or stop - end < 2:
        return words
    return (
        *words[: verb + 1],
        *words[end:stop],
        *_THEN,
        _word("wait"),
        *_counted(words[start:end]),
        *words[stop:],
    )


def _counted(span: Phrase) -> Phrase:
    """For "for a minute" "for 1 minute": a time is meant, where "wait for a minute" alone means "stop"."""
    exact = keys(span[1:2]) in {("a",), ("an",)} and len(span) == 3
    return (span[0], _word("1"), *span[2:]) if exact else span


def _is_span(words: Phrase) -> bool:
    vague = words[1].key in {"a", "an"} and words[-1].key not in {"minute", "hour"}
    return words[-1].key not in {"a", "an"} and not vague and duration_s(words) is not None


def _or_if(words: Phrase) -> Phrase:
    """For "A or, if it is shut, B" and "A, or B if it is shut"."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat) - 3) if flat[i] == "or"), 0)
    if not at:
        return words
    end = next((i for i in range(at, len(flat)) if flat[i] in {".", "!", "?", ";"}), len(flat))
    rest = words[at + 1 : end]
    while rest and rest[0].key == ",":
        rest = rest[1:]
    head = words[:at]
    while head and head[-1].key == ",":
        head = head[:-1]
    told = keys(rest)
    if told[:1] in {("if",), ("in",)} and "," in told[2:] and told[:2] not in {("in", "the")}:
        return (*head, _STOP, *rest, *words[end:])
    late = next((i for i in range(1, len(told) - 2) if told[i] == "if" and told[i + 1] in _POINTING), 0)
    if late and not opens_command(rest[:late]):
        return (*head, _STOP, *rest[late:], _COMMA, *rest[:late], *words[end:])
    return words


_POINTING = frozenset({"it", "that", "this", "they", "one", "the"})


def _fallback(words: Phrase, grounds: Grounds) -> Phrase:
    """For "if it does not work the other one": a comma before what is named."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 4) if flat[i] == "if" and flat[i + 1] in {"it", "that"}), 0)
    end = next((i for i in range(at, len(flat)) if flat[i] in {".", "!", "?", ";", ","}), len(flat))
    if not at or end < len(flat) or any(opens_command(words[i:]) for i in range(at + 3, len(flat))):
        return words
    named = next((i for i in range(at + 4, len(flat)) if flat[i] == "the" and grounds(words[i:])), 0)
    return (*words[:named], _COMMA, *words[named:]) if named else words


def _words(text: str) -> Phrase:
    return tuple(_word(part) for part in text.split())
