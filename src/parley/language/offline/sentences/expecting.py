"""Conditions that are told: "A ought to be S; if it is not, V", "unless you find X there, V", "V if so".

They are put as a look and an order that hangs on it, in the words that the rest reads.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["FINDING", "with_looks"]

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
_ELSE = (("else",), ("otherwise",), ("or", "else"))
_ECHOES = sorted((*_SO, *_NOT_SO, *_ELSE), key=len, reverse=True)
_STILL = (("if", "it", "is"), ("if", "that", "is"), ("if", "they", "are"))
_TURNED_ROUND = {
    ("is", "it", "not"): "if not", ("are", "they", "not"): "if not", ("is", "it"): "if so",
    ("are", "they"): "if so", ("is", "that", "so"): "if so", ("is", "that", "not", "so"): "if not",
}  # fmt: skip
FINDING = frozenset(
    {"find", "see", "spot", "notice", "discover", "meet", "encounter", "detect", "catch", "hear"}
)
"""How people say that something turns up."""
_ANY = {
    "somebody": "somebody", "someone": "somebody", "anybody": "somebody", "anyone": "somebody",
    "something": "something", "anything": "something", "nobody": "nobody", "nothing": "nothing",
}  # fmt: skip

_FOUND_AGAIN = frozenset({"it", "that", "them", "him", "her", "one", "any", "some", "this"})
_NONE_FOUND = frozenset({"none", "nothing", "nobody"})
_WHEN = tuple(
    tuple(text.split())
    for text in ("if", "when", "once", "as soon as", "unless", "in case", "should", "only if", "only when")
)
_HELPING = frozenset({"do", "can", "could", "did", "manage", "to", "happen", "should", "actually", "really"})
_PLACES = (("there",), ("in", "there"), ("at", "all"), ("anywhere",), ("on", "it"), ("in", "it"))
_THERE = ("there is", "there are", "it is there", "he is there", "she is there", "it is still there")
_AWAY = (
    "there is not", "there are not", "it is not there", "he is not there", "she is not there", "it is gone",
    "it has gone", "it is missing", "it is no longer there", "he is gone", "she is gone", "he has left",
    "she has left", "it is not there any more", "it is not there anymore",
)  # fmt: skip
_EXISTING = sorted(
    ((tuple(text.split()), text in _AWAY) for text in (*_THERE, *_AWAY)), key=lambda one: -len(one[0])
)
_LOOKING = frozenset(
    {
        "look",
        "search",
        "find",
        "check",
        "inspect",
        "see",
        "scan",
        "locate",
        "whether",
        "seek",
        "hunt",
        "watch",
    }
)


def with_looks(words: Phrase, is_stop: IsStop) -> Phrase:
    """The message with what orders hang on said as a look.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
    """
    flat = set(keys(words))
    if not flat & {"if", "unless", "case", "depending", "is", "are", "find", "see", "spot"}:
        return words
    return _or_nothing(_both(_found(_found_again(_turned_round(_supposed(words, is_stop))), is_stop)))


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
            ((m, "if so" if m in _SO else "if not") for m in _ECHOES
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


def _found_again(words: Phrase) -> Phrase:
    """For "look for X and V it if you find one", "if there is none, W": if so V it, if not W."""
    flat = keys(words)
    for at in range(3, len(flat) - 1):
        end, denied = _finding(flat, at)
        if not end or not _LOOKING & set(flat[:at]):
            continue
        if flat[at - 1] in {"see", "check", "know", "sure", "whether", "look", "tell"}:
            continue
        echo = _said(". if not ," if denied else ". if so ,")
        closes = (
            end >= len(flat)
            or flat[end] in _MARKS | {"else", "otherwise"}
            or flat[end : end + 2] == (",", "else")
        )
        if closes or (flat[end] in {",", "and"} and not opens_command(words[end + 1 :])):
            starts = (i for i in range(at - 1, 1, -1) if flat[i - 1] in {",", "and", "then"} | _MARKS)
            begin = next((i for i in starts if opens_command(words[i:at])), 0)
            if not begin or not _LOOKING & set(flat[: begin - 1]):
                continue
            return (*_closed(words[:begin]), *echo, *_closed(words[begin:at]), *words[end:])
        behind = end
        while flat[behind : behind + 1] and flat[behind] in {",", "then", "you", "please"}:
            behind += 1
        if opens_command(words[behind:]):
            return _found_again((*_closed(words[:at]), *echo, *words[behind:]))
    return words


def _or_nothing(words: Phrase) -> Phrase:
    """For "if S, V, otherwise leave it": if S, V."""
    flat = keys(words)
    for at in range(3, len(flat)):
        lead = next((m for m in (*_NOT_SO, *_ELSE, *_NOT_THERE) if flat[at : at + len(m)] == m), ())
        end = at + len(lead)
        while lead and flat[end : end + 1] and flat[end] in {",", "then", "just", "simply"}:
            end += 1
        done = next((m for m in _NOTHING_TO_DO if flat[end : end + len(m)] == m), ()) if lead else ()
        close = end + len(done)
        if done and _IFS & set(flat[:at]) and (close >= len(flat) or flat[close] in _MARKS):
            return (*_closed(words[:at]), *words[close:])
    return words


_IFS = frozenset({"if", "unless", "whether"})
_NOT_THERE = (("if", "there", "is", "not"), ("if", "there", "is", "none"), ("if", "there", "are", "none"))
_NOTHING_TO_DO = tuple(
    tuple(text.split())
    for text in (
        "forget about it", "forget it", "leave it", "leave it at that", "leave it alone", "do nothing",
        "nothing", "never mind", "do not bother", "it is fine", "that is fine", "fine", "stay there",
        "stay where you are", "stay put", "do not do anything", "ignore it", "no problem",
    )
)  # fmt: skip


def _closed(words: Phrase) -> Phrase:
    """Without the marks and joints at the end."""
    while words and (not words[-1].is_word or words[-1].key in {"and", "then", "but", "only"}):
        words = words[:-1]
    return words


def _finding(flat: tuple[str, ...], at: int) -> tuple[int, bool]:
    """Where "if you find it" and "if there is none" end, and whether they deny it; 0 if none begins here."""
    lead = next((m for m in _WHEN if flat[at : at + len(m)] == m), ())
    start = at + len(lead)
    if not lead:
        return 0, False
    denied = lead == ("unless",)
    existing = next(((m, no) for m, no in _EXISTING if flat[start : start + len(m)] == m), None)
    if existing is not None:
        end, thing = start + len(existing[0]), "" if existing[0][0] == "there" else "one"
        denied ^= existing[1]
    elif flat[start : start + 1] == ("you",):
        end = start + 1
        while flat[end : end + 1] and flat[end] in _HELPING | {"not"}:
            denied ^= flat[end] == "not"
            end += 1
        finds = flat[end : end + 1] != () and flat[end] in FINDING
        thing = "" if finds else "one" if end > start + 1 and flat[end - 1] in {"do", "can", "not"} else "?"
        end += finds
    else:
        return 0, False
    if not thing:
        thing = flat[end] if end < len(flat) else "?"
        denied ^= thing in _NONE_FOUND
        end += 1
    if thing not in _FOUND_AGAIN | _NONE_FOUND:
        return 0, False
    end += next((len(m) for m in _PLACES if flat[end : end + len(m)] == m), 0)
    return end, denied


def _found(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to A and if you find X there V": if there is X there, V."""
    flat = keys(words)
    at = next((i for i in range(3, len(flat) - 3) if flat[i] in {"if", "unless"} and flat[i + 1] == "you"), 0)
    if (
        not at
        or flat[at + 2] not in FINDING
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
    if not what or end == len(flat):
        return words
    if what[0].key in _FOUND_AGAIN | {"out"}:
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
