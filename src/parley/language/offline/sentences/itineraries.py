"""Stops listed in few words: "A, then B, C last", "B once you have been at A", "A and B, start with B".

A message, or one of its sentences, that consists of nothing but named places, words of order and at most a
verb for them is put as "go to A, then go to B". One word more that this grammar does not know, and it is
left alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["as_itinerary"]

IsStop = Callable[[Phrase], bool]

_CUTS = frozenset({",", ";", ".", ":", "!", "\n", "and", "then", "but", "&"})
_FIRST, _LAST, _ANY = 1, 99, 50


def _table(*groups: tuple[int, str]) -> dict[tuple[str, ...], int]:
    return {tuple(text.split()): rank for rank, listed in groups for text in listed.split(", ")}


_BEFORE_LAST = -1
"""In front of the stop that was named just before."""
_LEADS = _table(
    (_FIRST, "first, firstly, first of all, to start with, to begin with, initially"),
    (_FIRST, "start with, start at, start in, start from, begin with, begin at, begin in, starting with"),
    (_FIRST, "starting at, starting from, beginning with, beginning at"),
    (_LAST, "finally, lastly, last, last of all, at the end, in the end, at last, end with, end at, end in"),
    (_LAST, "finish with, finish at, finish in, ending with, ending at, finishing with, finishing at"),
    (_ANY, "in between, between them, next, afterwards, after that, after it, after this, after them"),
    (
        _ANY,
        "only then, second, secondly, third, thirdly, fourth, now, so, ok, okay, please, also, from there",
    ),
    (
        _ANY,
        "only after that, only afterwards, later, after, on the way back, on your way back, back to, "
        "back at, back in, home to, then home to, only after both, after both, only after all that, "
        "only after all of them",
    ),
    (
        _BEFORE_LAST,
        "before that, before it, before this, but before that, on the way there, on the way, on your way",
    ),
    (_BEFORE_LAST, "on your way there, before you go there"),
    (
        _ANY,
        "step one, step two, step three, step four, number one, number two, number three, stop one, stop two",
    ),
    (_ANY, "stop three, step 1, step 2, step 3, from, the second thing, second thing, the next thing"),
    (_FIRST, "the first thing, first thing, the first stop"),
    (_LAST, "the last thing, last thing, the last stop, and last"),
)
_TAILS = _table(
    (_FIRST, "first, first of all, to start with, to begin with, comes first, goes first, is first"),
    (
        _LAST,
        "last, last of all, at the end, in the end, at the very end, to finish with, comes last, goes last",
    ),
    (_LAST, "to finish, is last, for last, until last, till last, till the end, until the end, for the end"),
    (
        _ANY,
        "goes in between, goes between them, between them, in the middle, comes in between, between those",
    ),
    (_ANY, "in between, second, third, next, afterwards, after that, after it, after this, later, too, also"),
    (_ANY, "as well, please, now, comes after it, comes after that, comes next, comes second, thanks"),
    (_BEFORE_LAST, "before that, before it, beforehand, before this, comes before it, comes before that"),
)
_ALL = frozenset(
    tuple(text.split())
    for text in (
        "each", "all", "them", "all of them", "them all", "each of them", "each one", "both",
        "both of them", "every one", "every one of them", "all three",
    )
)  # fmt: skip
_ORDERS = frozenset(
    (*lead, which, what)
    for lead in (("in",), ("exactly", "in"), ("just", "in"))
    for which in ("that", "this")
    for what in ("order", "sequence")
)
_COURTESY = frozenset({("please",), ("thanks",), ("thank", "you"), ("ok",), ("okay",), ()})
_JOINTS = frozenset({"before", "after", "once", "when"})
_BEEN = (("you", "have", "been", "at"), ("you", "have", "been", "to"), ("you", "have", "been", "in"),
         ("you", "have", "visited"), ("you", "have", "done"), ("you", "are", "done", "at"),
         ("you", "are", "done", "with"), ("you", "were", "at"), ("you", "have", "seen"), ("you", "left"),
         ("you", "have", "finished", "at"), ("you", "have", "left"), ("you", "go", "to"))  # fmt: skip


@dataclass(frozen=True)
class _Stop:
    words: Phrase
    kind: str = ""
    """"motion" or "look"; empty if no verb was said."""
    rank: int = _ANY


class _UnknownError(Exception):
    """A part is no stop."""


def as_itinerary(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """The stops of a message in their order, as orders; None if it is more than stops.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one place.
    """
    if not words or "?" in keys(words) or len(words) > 60:
        return None
    return _whole(words, is_stop) or _by_sentence(words, is_stop)


def _by_sentence(words: Phrase, is_stop: IsStop) -> Phrase | None:
    ends = [i for i, word in enumerate(words) if word.key in {".", "!", "\n"}]
    if not ends or ends == [len(words) - 1]:
        return None
    result: list[Word] = []
    changed, start = False, 0
    for end in (*ends, len(words)):
        read = _whole(words[start:end], is_stop) if end > start else None
        changed = changed or read is not None
        result += (*(read or words[start:end]), *words[end : end + 1])
        start = end + 1
    return tuple(result) if changed else None


_AFTER = (
    ("but", "not", "before"),
    ("but", "not", "until"),
    ("not", "before"),
    ("not", "until"),
    ("but", "only", "after"),
    ("only", "after"),
    ("but", "only", "once"),
)


def _simpler(words: Phrase) -> Phrase:
    """With "after" for "but not before" and the like."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        marker = next((m for m in _AFTER if flat[index : index + len(m)] == m), ())
        if marker and keys(result[-1:]) == (",",):
            result.pop()
        result += (Word("after", "after"),) if marker else (words[index],)
        index += len(marker) or 1
    return tuple(result)


def _whole(words: Phrase, is_stop: IsStop) -> Phrase | None:
    words = _simpler(words)
    try:
        stops, ordered, shared = _stops(words, is_stop)
    except _UnknownError:
        return None
    verbless = any(not stop.kind for stop in stops[:1]) or bool(shared)
    if len(stops) < 2 or not (ordered or verbless):
        return None
    result: list[Word] = []
    for stop in sorted(stops, key=lambda one: one.rank):
        result += _words(", then") if result else ()
        result += (*_words("inspect" if (shared or stop.kind) == "look" else "go to"), *stop.words)
    return tuple(result)


def _stops(words: Phrase, is_stop: IsStop) -> tuple[list[_Stop], bool, str]:
    """The stops as they are said, whether words say their order, and the verb of all of them.

    Raises:
        _UnknownError: Something is no stop.
    """
    stops: list[_Stop] = []
    ordered, shared, kind, early, joined = False, "", "", False, False
    marked = _ANY
    for piece in _pieces(words):
        every = _of_all(piece)
        if every:
            shared = every
            continue
        if keys(piece) in _LEADS:
            # "On the way there, the desk".
            marked = _LEADS[keys(piece)]
            continue
        read = _read(piece, is_stop)
        if marked != _ANY:
            read, marked = [replace(stop, rank=marked) for stop in read], _ANY
        if joined and len(read) == 1 and not read[0].kind and read[0].rank == _ANY:
            # "A after B and C": whether C is before A nobody can tell by words of order alone.
            raise _UnknownError
        joined = len(read) > 1 and keys(piece[:1])[0] not in _JOINTS
        for stop in read:
            kind = stop.kind or kind
            ordered = ordered or stop.rank != _ANY
            _put(replace(stop, kind=kind), stops, early=early)
        early = keys(piece[:1]) == ("before",) and keys(piece[:2])[-1] not in {"that", "it", "this"}
        ordered = ordered or early or bool((_JOINTS | {"do", "only"}) & set(keys(piece)))
    return stops, ordered, shared


def _put(stop: _Stop, stops: list[_Stop], *, early: bool) -> None:
    same = next((i for i, other in enumerate(stops) if keys(bare(other.words)) == keys(bare(stop.words))), -1)
    round_trip = same >= 0 and stops[same].rank == _FIRST and len(stops) > same + 2
    if same >= 0 and not round_trip:
        # "A and B, start with B".
        kind = stops.pop(same).kind
        stop = replace(stop, kind=kind or stop.kind)
    if stop.rank == _BEFORE_LAST and stops and stops[-1].rank == _ANY and any(s.rank == _LAST for s in stops):
        stop = replace(stop, rank=_ANY)
    if (stop.rank == _BEFORE_LAST or early) and stops:
        stops.insert(len(stops) - 1, replace(stop, rank=stops[-1].rank))
    else:
        stops.append(replace(stop, rank=_ANY) if stop.rank == _BEFORE_LAST else stop)


def _pieces(words: Phrase) -> list[Phrase]:
    pieces: list[list[Word]] = [[]]
    for word in words:
        cut = word.key in _CUTS or (word.key == "to" and words[0].key == "from")
        if cut and keys(pieces[-1][-1:]) != ("only",):
            pieces.append([])
        else:
            pieces[-1].append(word)
    return [tuple(p) for p in pieces if keys(p) not in _COURTESY and keys(p) not in _ORDERS]


def _of_all(piece: Phrase) -> str:
    """For "inspect them in that order": the verb of all stops; empty if it is none."""
    kind, rest = _verb(piece)
    flat = keys(rest)
    order = next((o for o in _ORDERS if flat[-len(o) :] == o), ())
    flat = flat[: len(flat) - len(order)]
    return kind if kind and flat in _ALL else ""


def _read(piece: Phrase, is_stop: IsStop) -> list[_Stop]:
    """The stops of one part.

    Raises:
        _UnknownError: It is none.
    """
    rank = _ANY
    piece, rank = _stripped(piece, rank)
    kind, rest = _verb(piece)
    rest, rank = _stripped(rest, rank)
    if is_stop(rest):
        return [_Stop(rest, kind, rank)]
    flat = keys(rest)
    for at in range(len(flat)):
        if flat[at] not in _JOINTS:
            continue
        other, ahead = rest[at + 1 :], _ahead(rest[:at])
        been = next((b for b in _BEEN if keys(other)[: len(b)] == b), ())
        if flat[at] in {"once", "when"} and not been:
            continue
        other = other[len(been) :]
        if at == 0 and is_stop(other):
            return [_Stop(other, kind, rank)]
        if is_stop(ahead) and is_stop(other):
            pair = [_Stop(ahead, kind, rank), _Stop(other, kind, rank)]
            return pair if flat[at] == "before" else pair[::-1]
    raise _UnknownError


def _ahead(words: Phrase) -> Phrase:
    """The place in "A has to come (before B)"."""
    while len(words) > 1 and words[-1].key in _COMING:
        words = words[:-1]
    return words


_COMING = frozenset(
    {
        "has",
        "to",
        "come",
        "comes",
        "should",
        "must",
        "be",
        "is",
        "goes",
        "go",
        "needs",
        "please",
        "only",
        "ought",
        "first",
    }
)


def _stripped(piece: Phrase, rank: int) -> tuple[Phrase, int]:
    """Without the words of order around it."""
    changed = True
    while changed and piece:
        changed = False
        for table, front in ((_LEADS, True), (_TAILS, False)):
            flat = keys(piece)
            for size in range(min(4, len(flat) - 1), 0, -1):
                marker = flat[:size] if front else flat[-size:]
                if marker not in table:
                    continue
                if marker == ("after",) and flat[1:2] == ("you",):
                    continue
                rank = table[marker] if table[marker] != _ANY else rank
                if (
                    not front
                    and rank == _LAST
                    and flat[0] in {"leave", "save", "keep"}
                    and len(piece) > size + 1
                ):
                    piece = piece[1:]
                piece = piece[size:] if front else piece[:-size]
                changed = True
                break
    return piece, rank


def _verb(piece: Phrase) -> tuple[str, Phrase]:
    """Whether it begins with going or looking, and the rest."""
    flat = keys(piece)
    if flat[:1] in {("to",), ("do",), ("via",), ("take",), ("cover",), ("tackle",)} and len(flat) > 1:
        return "motion", piece[1:]
    found = lexicon().verbs.match((lemma(flat[0]), *flat[1:])) if flat else None
    kind = found[1].partition(":")[0] if found is not None else ""
    if found is None or kind not in {"motion", "look", "back"}:
        return "", piece
    size = found[0]
    goal = lexicon().goals.match(flat, size)
    size += goal[0] if goal is not None else 0
    if size == found[0] and flat[size : size + 1] in {("at",), ("in",), ("into",)}:
        size += 1
    return "look" if kind == "look" else "motion", piece[size:]


def _words(text: str) -> Phrase:
    return tuple(Word(part.strip() or ",", part.strip() or ",") for part in text.replace(",", " , ").split())
