"""Conditions that are told: "A ought to be S; if it is not, V", "unless you find X there, V", "V if so".

They are put as a look and an order that hangs on it, in the words that the rest reads.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["with_looks"]

IsStop = Callable[[Phrase], bool]

_MARKS = frozenset({".", "!", "?", ";", "\n"})
_LONGEST_NAME = 7
_SUPPOSED = tuple(
    tuple(text.split())
    for text in (
        "ought to be", "should be", "is supposed to be", "are supposed to be", "must be", "is meant to be",
        "might be", "may be", "could be", "should probably be", "ought to have been", "should have been",
        "has to be", "is probably", "are probably", "is hopefully", "will be", "is apparently",
    )
)  # fmt: skip
_GUESSING = tuple(
    tuple(text.split())
    for text in (
        "i think", "i believe", "i guess", "i reckon", "i suppose", "i hope", "i expect", "normally",
        "usually",
    )
)  # fmt: skip
_SO = tuple(
    tuple(text.split())
    for text in (
        "if so", "if yes", "in that case", "in which case", "if it is", "if that is", "if they are",
        "when so",
        "if that is so",
    )
)  # fmt: skip
_NOT_SO = tuple(
    tuple(text.split())
    for text in (
        "if not", "if no", "if it is not", "if that is not", "if they are not", "if i am wrong",
        "if that is wrong",
    )
)  # fmt: skip
_STILL = (("if", "it", "is"), ("if", "that", "is"), ("if", "they", "are"))
_TURNED_ROUND = {
    ("is", "it", "not"): "if not", ("are", "they", "not"): "if not", ("is", "it"): "if so",
    ("are", "they"): "if so", ("is", "that", "so"): "if so", ("is", "that", "not", "so"): "if not",
}  # fmt: skip
_FINDING = frozenset(
    {"find", "see", "spot", "notice", "discover", "meet", "encounter", "detect", "catch", "hear"}
)
_ANY = {
    "somebody": "somebody", "someone": "somebody", "anybody": "somebody", "anyone": "somebody",
    "something": "something", "anything": "something", "nobody": "nobody", "nothing": "nothing",
}  # fmt: skip


def with_looks(words: Phrase, is_stop: IsStop) -> Phrase:
    """The message with what orders hang on said as a look.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
    """
    flat = set(keys(words))
    if not flat & {"if", "unless", "case", "depending", "is", "are"}:
        return words
    return _both(_found(_turned_round(_supposed(words, is_stop)), is_stop))


def _supposed(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "A ought to be S; if it is not, V": check whether A is S. If not, V."""
    flat = keys(words)
    for start in _starts(flat):
        at = start + next((len(m) for m in _GUESSING if flat[start : start + len(m)] == m), 0)
        end = next(
            (
                at + n
                for n in range(min(_LONGEST_NAME, len(words) - at), 0, -1)
                if is_stop(words[at : at + n])
            ),
            0,
        )
        guessed = at > start and flat[end : end + 1] in {("is",), ("are",)}
        size = 1 if guessed else next((len(m) for m in _SUPPOSED if flat[end : end + len(m)] == m), 0)
        close = next((i for i in range(end + size, len(flat)) if flat[i] in _MARKS | {","}), 0)
        if not end or not size or close < end + size + 1:
            continue
        behind = close + 1 + (flat[close + 1 : close + 2] in {("but",), ("and",), ("so",)})
        echo = next(
            ((m, "if so" if m in _SO else "if not") for m in sorted((*_SO, *_NOT_SO), key=len, reverse=True)
             if flat[behind : behind + len(m)] == m),
            None,
        )  # fmt: skip
        still = behind + 3 if flat[behind : behind + 3] in _STILL else 0
        state = still + (flat[still : still + 1] == ("still",)) if still else 0
        if state and flat[state : state + 1] and flat[state] not in {",", "not", "then"}:
            return (
                *words[:start],
                *tokens("if"),
                *words[at:end],
                *words[behind + 2 : behind + 3],
                *words[state:],
            )
        if echo is None:
            continue
        rest = words[behind + len(echo[0]) :]
        rest = rest[1:] if keys(rest[:1]) in {(",",), ("then",)} else rest
        plural = flat[end - 1].endswith("s") and not flat[end - 1].endswith("ss")
        link = tokens("are" if plural or "are" in flat[end : end + size] else "is")
        told = words[end + size : close]
        return (
            *words[:start],
            *tokens("check whether"),
            *words[at:end],
            *link,
            *told,
            *_said(f". {echo[1]} ,"),
            *rest,
        )
    return words


def _starts(flat: tuple[str, ...]) -> list[int]:
    return [i for i in range(len(flat)) if i == 0 or flat[i - 1] in _MARKS | {",", "and", "but"}]


def _turned_round(words: Phrase) -> Phrase:
    """For "(See that A is shut.) Is it not, then V": if not, V."""
    flat = keys(words)
    for start in _starts(flat)[1:]:
        found = next((m for m in _TURNED_ROUND if flat[start : start + len(m)] == m), None)
        end = start + len(found) if found is not None else 0
        comma = end + (flat[end : end + 1] == (",",))
        behind = comma + (flat[comma : comma + 1] == ("then",))
        if found is None or behind == end or not opens_command(words[behind:]):
            continue
        return (*words[:start], *_said(f"{_TURNED_ROUND[found]} ,"), *words[behind:])
    return words


def _found(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to A and if you find X there V": if there is X there, V."""
    flat = keys(words)
    at = next((i for i in range(3, len(flat) - 3) if flat[i] in {"if", "unless"} and flat[i + 1] == "you"), 0)
    if (
        not at
        or flat[at + 2] not in _FINDING
        or not any(is_stop(words[i : i + n]) for i in range(at) for n in range(1, 5))
    ):
        return words
    start = at + 3
    end = next(
        (
            i
            for i in range(start + 1, len(flat))
            if flat[i] in {",", "then", "there"} | _MARKS or opens_command(words[i:])
        ),
        len(flat),
    )
    what = words[start:end]
    if not what or what[0].key in {"it", "that", "them", "him", "her", "out"} or end == len(flat):
        return words
    there = end + (flat[end] == "there")
    comma = there + (flat[there : there + 1] in {(",",), ("then",)})
    body = keys(what[:1])[0]
    said = (*_said(_ANY[body]), *_said("is"), *what[1:]) if body in _ANY else (*_said("there is"), *what)
    return (*words[: at + 1], *said, *_said("there ,"), *words[comma:])


def _both(words: Phrase) -> Phrase:
    """For "(depending on whether S,) V A if so and B if not": check whether S. If so, V A. If not, B."""
    flat = keys(words)
    one, first = _at(flat, _SO, 2)
    other, second = _at(flat, _NOT_SO, one + first) if one else (0, 0)
    if not other or flat[one - 1] in _MARKS | {","} or _MARKS & set(flat[one:other]):
        return words
    begins = [
        i
        for i in range(one)
        if opens_command(words[i:one]) and (not i or flat[i - 1] in _MARKS | {",", "and"})
    ]
    joint = one + first
    while flat[joint : joint + 1] and flat[joint] in {",", "and", "or", "but"}:
        joint += 1
    if not begins or joint >= other:
        return words
    start = begins[-1]
    lead = words[: start - (start > 0 and flat[start - 1] in {",", "and"})]
    depends = next((len(m) for m in _DEPENDING if keys(lead[: len(m)]) == m), 0)
    lead = (*_said("check whether"), *lead[depends:]) if depends else lead
    wanted = words[joint:other]
    wanted = wanted if opens_command(wanted) else (*_said("go"), *wanted)
    stop = _said(".") if lead else ()
    return (
        *lead,
        *stop,
        *_said("if so ,"),
        *words[start:one],
        *_said(". if not ,"),
        *wanted,
        *words[other + second :],
    )


_DEPENDING = (("depending", "on", "whether"), ("depending", "on", "if"))


def _at(flat: tuple[str, ...], phrases: tuple[tuple[str, ...], ...], start: int) -> tuple[int, int]:
    """Where one of some phrases stands first, and its size; zeros if none does."""
    longest = sorted(phrases, key=len, reverse=True)
    return next(
        ((i, len(m)) for i in range(start, len(flat)) for m in longest if flat[i : i + len(m)] == m), (0, 0)
    )


def _said(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
