"""Why something is asked for ("because S", "so that they can V"): no order, and nothing hangs on it."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.words.text import Phrase, keys, tokens

__all__ = ["closed_reasons", "without_reason"]

Opens = Callable[[Phrase], bool]

_PURPOSES = frozenset({("so", "that"), ("in", "case")})
_WHOM_IT_HELPS = frozenset({
    "i", "we", "they", "he", "she", "it", "someone", "somebody", "people", "everyone", "everybody", "nobody",
})  # fmt: skip
_HELPS = frozenset({"can", "could", "may", "know", "knows", "will", "do", "does", "have", "has", "is", "are"})
_GOING_ON = frozenset({"if", "unless", "otherwise", "else", "when", "once"})


def _why(flat: tuple[str, ...], index: int) -> bool:
    """Whether it is said here why something is asked for ("because S", "so that S", "so they can V")."""
    if flat[index] == "because":
        return True
    if flat[index] == "so" and index and flat[index + 1] in _WHOM_IT_HELPS:
        return flat[index + 2 : index + 3] != () and flat[index + 2] in _HELPS
    joined = flat[index : index + 2] in _PURPOSES
    return joined and (flat[index] == "so" or (index > 0 and flat[index - 1] == "just"))


def _goes_on(sentence: Phrase, index: int, opens: Opens) -> bool:
    """Whether what is asked for goes on behind a mark or joint ("..., and if it is, V", "..., then to A")."""
    flat = keys(sentence)
    at = index + (flat[index] != "otherwise")
    while at < len(flat) and flat[at] in {"and", "but", "then"}:
        at += 1
    if flat[at : at + 1] in {("to",), ("at",)}:
        return flat[at - 1] == "then" or flat[index:at] == (",", "and")
    return opens(sentence[at:]) or (flat[at : at + 1] != () and flat[at] in _GOING_ON and at > index)


def without_reason(sentence: Phrase, opens: Opens) -> Phrase:
    """A sentence without why something is asked for ("because S", "so that S").

    Args:
        sentence: Its words and commas.
        opens: Whether words begin an order.
    """
    flat = keys(sentence)
    for index in range(len(flat) - 1):
        if not _why(flat, index):
            continue
        if index == 0:
            end = next((i for i in range(2, len(flat)) if flat[i] == ","), 0)
            end = end or next((i for i in range(3, len(flat)) if opens(sentence[i:])), 0)
            return sentence[end:] if end else sentence
        joints = {",", "and", "then", "otherwise"}
        behind = (
            i for i in range(index + 2, len(flat)) if flat[i] in joints and _goes_on(sentence, i, opens)
        )
        return (*sentence[:index], *sentence[next(behind, len(flat)) :])
    return sentence


def closed_reasons(words: Phrase) -> Phrase:
    """For "V so they can see you, and then to A" "V so they can see you. then go to A"."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 4) if _why(flat, i)), 0)
    end = next((i for i in range(at + 2, len(flat)) if flat[i] in {",", "."}), 0) if at else 0
    behind = end + 1 + (flat[end + 1 : end + 2] == ("and",))
    if not end or flat[end] != "," or flat[behind : behind + 2] != ("then", "to"):
        return words
    return (*words[:end], *tokens(". then go to"), *words[behind + 2 :])
