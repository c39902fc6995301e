"""Conditions that are told: "A ought to be S; if it is not, V", "unless you find X there, V", "V if so".

They are put as a look and an order that hangs on it, in the words that the rest reads.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.echoes import FINDING, STATES, Echo, echo, phrases, put_briefly
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["with_looks"]

IsStop = Callable[[Phrase], bool]

_MARKS = frozenset({".", "!", "?", ";", "\n"})
_LONGEST_NAME = 7
_IFS = frozenset({"if", "unless", "whether"})
_STILL = (("if", "it", "is"), ("if", "that", "is"), ("if", "they", "are"))
_ANY = {
    "somebody": "somebody", "someone": "somebody", "anybody": "somebody", "anyone": "somebody",
    "something": "something", "anything": "something", "nobody": "nobody", "nothing": "nothing",
}  # fmt: skip
_LATER = frozenset({"now", "always", "future"})
"""Words before an "if" by which it is a rule for whatever comes: "from now on"."""
_NOT_WHAT = frozenset({"it", "that", "them", "him", "her", "one", "any", "some", "this", "out"})
_LOOKING = frozenset(
    {"look", "search", "find", "check", "inspect", "see", "scan", "locate", "whether", "seek", "hunt",
     "watch"}
)  # fmt: skip


def with_looks(words: Phrase, is_stop: IsStop) -> Phrase:
    """The message with what orders hang on said as a look.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
    """
    words = _or_else(put_briefly(words, opens_command))
    if not set(keys(words)) & {"if", "unless", "otherwise", "depending", "is", "are", "find", "see", "spot"}:
        return words
    return _or_nothing(_both(_found(_found_again(_turned_round(_supposed(words, is_stop))), is_stop)))


def _or_else(words: Phrase) -> Phrase:
    """For "check whether S, otherwise V" "check whether S. If not, V"."""
    flat = keys(words)
    for at in range(4, len(flat) - 1):
        if flat[at] != "otherwise":
            continue
        start = next((i for i in range(at - 1, -1, -1) if flat[i] in _MARKS), -1) + 1
        asked = next((i for i in range(start + 1, at) if flat[i] in {"if", "whether"}), 0)
        if (
            asked
            and flat[asked - 1] in {"check", "see", "look"}
            and not (_IFS & set(flat[asked + 1 : at]) or _acts(words[asked + 1 : at]))
        ):
            comma = flat[at + 1 : at + 2] == (",",)
            return (*_closed(words[:at]), *_said(". if not ,"), *words[at + 1 + comma :])
    return words


def _acts(words: Phrase) -> bool:
    """Whether an order stands behind a mark or "and" within a sentence."""
    joints = (i for i in range(1, len(words)) if words[i - 1].key in {",", "and", "then"})
    return any(opens_command(words[i:]) for i in joints)


def _again(words: Phrase, at: int, *kinds: str) -> Echo | None:
    """What only repeats a condition there, if it is of some kinds and something follows."""
    found = echo(words, at, opens_command)
    follows = found is not None and at + found.size < len(words)
    return found if found is not None and follows and found.kind in kinds else None


def _supposed(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "A ought to be S; if it is not, V": check whether A is S. If not, V."""
    flat = keys(words)
    for start in _starts(flat):
        at = start + (phrases("guessing").match(flat, start) or (0, ""))[0]
        end = next(
            (
                at + n
                for n in range(min(_LONGEST_NAME, len(words) - at), 0, -1)
                if is_stop(words[at : at + n])
            ),
            0,
        )
        guessed = at > start and flat[end : end + 1] in {("is",), ("are",)}
        size = 1 if guessed else (phrases("supposed").match(flat, end) or (0, ""))[0]
        close = next((i for i in range(end + size, len(flat)) if flat[i] in _MARKS | {","}), 0)
        if not end or not size or close < end + size + 1:
            continue
        behind = close + 1 + (flat[close + 1 : close + 2] in {("but",), ("and",), ("so",)})
        again = _again(words, behind, "state", "there", "else", "found")
        still = behind + 3 if again is None and flat[behind : behind + 3] in _STILL else 0
        state = still + (flat[still : still + 1] == ("still",)) if still else 0
        if state and flat[state : state + 1] and flat[state] not in {",", "not", "then"}:
            return (
                *words[:start],
                *tokens("if"),
                *words[at:end],
                *words[behind + 2 : behind + 3],
                *words[state:],
            )
        if again is None:
            continue
        rest = words[behind + again.size :]
        rest = rest[1:] if keys(rest[:1]) in {(",",), ("then",)} else rest
        plural = flat[end - 1].endswith("s") and not flat[end - 1].endswith("ss")
        link = tokens("are" if plural or "are" in flat[end : end + size] else "is")
        look = (*tokens("check whether"), *words[at:end], *link, *words[end + size : close])
        return (*words[:start], *look, *_said(f". {_so(again)} ,"), *rest)
    return words


def _so(again: Echo) -> str:
    return "if so" if again.holds else "if not"


def _starts(flat: tuple[str, ...]) -> list[int]:
    return [i for i in range(len(flat)) if i == 0 or flat[i - 1] in _MARKS | {",", "and", "but"}]


def _turned_round(words: Phrase) -> Phrase:
    """For "(See that A is shut.) Is it not, then V": if not, V."""
    flat = keys(words)
    for start in _starts(flat)[1:]:
        if flat[start : start + 2] not in {("is", "it"), ("are", "they"), ("is", "that")}:
            continue
        denied = flat[start + 2 : start + 3] == ("not",)
        end = start + 2 + denied
        end += flat[end : end + 1] == ("so",)
        comma = end + (flat[end : end + 1] == (",",))
        behind = comma + (flat[comma : comma + 1] == ("then",))
        if behind == end or not opens_command(words[behind:]):
            continue
        return (*words[:start], *_said("if not ," if denied else "if so ,"), *words[behind:])
    return words


def _found_again(words: Phrase) -> Phrase:
    """For "look for X and V it if you find one", "if there is none, W": if so V it, if not W."""
    flat = keys(words)
    for at in range(3, len(flat) - 1):
        again = echo(words, at, opens_command)
        if again is None or again.kind not in {"found", "there"} or not _LOOKING & set(flat[:at]):
            continue
        end = at + again.size
        if flat[at - 1] in {"see", "check", "know", "sure", "whether", "look", "tell"}:
            continue
        said = _said(f". {_so(again)} ,")
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
            return (*_closed(words[:begin]), *said, *_closed(words[begin:at]), *words[end:])
        behind = end
        while flat[behind : behind + 1] and flat[behind] in {",", "then", "you", "please"}:
            behind += 1
        if opens_command(words[behind:]):
            return _found_again((*_closed(words[:at]), *said, *words[behind:]))
    return words


def _or_nothing(words: Phrase) -> Phrase:
    """For "if S, V, otherwise leave it": if S, V."""
    flat = keys(words)
    for at in range(3, len(flat)):
        again = _again(words, at, "state", "there", "else")
        if again is None or again.holds or not _IFS & set(flat[:at]):
            continue
        end = at + again.size
        while end < len(flat) and flat[end] in {",", "then", "just", "simply"}:
            end += 1
        close = end + (phrases("nothing_to_do").match(flat, end) or (0, ""))[0]
        if close > end and (close >= len(flat) or flat[close] in _MARKS):
            return (*_closed(words[:at]), *words[close:])
    return words


def _closed(words: Phrase) -> Phrase:
    """Without the marks and joints at the end."""
    while words and (not words[-1].is_word or words[-1].key in {"and", "then", "but", "only"}):
        words = words[:-1]
    return words


def _found(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to A and if you find X there V": if there is X there, V.

    "If you find X at A, V" looks at A; where no place is named, "if you find X" is a rule for later.
    """
    flat = keys(words)
    for at in range(len(flat) - 4):
        if flat[at] not in {"if", "unless"} or flat[at + 1] != "you" or flat[at + 2] not in FINDING:
            continue
        state = _found_so(words[at + 3 :], is_stop)
        if state:
            return (*words[: at + 1], *state)
        end = _end_of_finding(words, at + 4, is_stop)
        what = words[at + 3 : end]
        if end == len(flat) or what[0].key in _NOT_WHAT:
            continue
        inside = _said_where(what, is_stop)
        before = any(is_stop(words[i : i + n]) for i in range(at) for n in range(1, 5))
        rest = words[end + (flat[end] == "there") :]
        rest = rest[1:] if keys(rest[:1]) in {(",",), ("then",)} else rest
        other = _otherwise_at(rest)
        if not (before or (inside and opens_command(rest) and not _LATER & set(flat[:at]))):
            continue
        thing = what[0].key
        first = next((w.key for w in what if w.key not in lexicon().determiners), thing)
        plural = inside and first.endswith("s") and not first.endswith("ss")
        said = _said(f"{_ANY[thing]} is" if thing in _ANY else "there are" if plural else "there is")
        said = (*said, *what[thing in _ANY :], *(() if inside else _said("there")), *_said(","))
        if inside and other[1]:
            rest = (*_closed(rest[: other[0]]), *_said(". if not ,"), *rest[sum(other) :])
        return (*words[: at + 1], *said, *rest)
    return words


def _said_where(what: Phrase, is_stop: IsStop) -> bool:
    """Whether "(if you see) water on the floor in A" says where that is to be seen."""
    flat = keys(what)
    places = ((i, lexicon().places.match(flat, i)) for i in range(1, len(what)))
    return any(found is not None and is_stop(what[i + found[0] :]) for i, found in places)


def _found_so(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "(if you see) that A is open, V", "(if you find) A open, V": A is open, V; empty otherwise."""
    flat = keys(words)
    told = int(flat[:1] == ("that",))
    sizes = range(min(_LONGEST_NAME, len(words) - told - 1), 0, -1)
    size = next((n for n in sizes if is_stop(words[told : told + n])), 0)
    end = told + size
    if told and size and flat[end] in lexicon().be | {"has", "have"}:
        return words[told:]
    return (*words[:end], *tokens("is"), *words[end:]) if size and not told and flat[end] in STATES else ()


def _end_of_finding(words: Phrase, start: int, is_stop: IsStop) -> int:
    """Where "(if you find) oil at press 2" ends: at a mark or "there", or where an order begins."""
    flat = keys(words)
    ends = {",", "then", "there"} | _MARKS
    mark = next((i for i in range(start, len(flat)) if flat[i] in ends), len(flat))
    if mark < len(flat) and any(is_stop(words[i:mark]) for i in range(start, mark)):
        return mark
    return next((i for i in range(start, mark) if opens_command(words[i:])), mark)


def _otherwise_at(words: Phrase) -> tuple[int, int]:
    """Where what is done otherwise is led in, and how many words do; zeros if nothing is."""
    flat = keys(words)
    for at in range(1, len(words)):
        again = _again(words, at, "state", "there", "else", "found")
        if again is not None and not again.holds:
            return at, again.size + (flat[at + again.size : at + again.size + 1] == (",",))
    return 0, 0


def _both(words: Phrase) -> Phrase:
    """For "(depending on whether S,) V A if so and B if not": check whether S. If so, V A. If not, B."""
    flat = keys(words)
    found = [(i, again) for i in range(2, len(words)) if (again := echo(words, i, opens_command))]
    found = [(i, again) for i, again in found if again.kind in {"state", "else"}]
    if len(found) != 2 or not found[0][1].holds or found[1][1].holds:
        return words
    (one, so), (other, otherwise) = found
    first, second = so.size, otherwise.size
    if flat[one - 1] in _MARKS | {",", "and", "but", "then"} or _MARKS & set(flat[one:other]):
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


def _said(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
