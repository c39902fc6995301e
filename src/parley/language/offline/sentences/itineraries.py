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
from parley.language.offline.words.order import phrases_due
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["as_itinerary", "warns"]

IsStop = Callable[[Phrase], bool]

_CUTS = frozenset({",", ";", ".", ":", "!", "\n", "and", "then", "but", "&"})
_FIRST, _LAST, _ANY = 1, 99, 50


def _table(*groups: tuple[int, str]) -> dict[tuple[str, ...], int]:
    return {tuple(text.split()): rank for rank, listed in groups for text in listed.split(", ")}


def _due(rank: int, *kinds: str) -> dict[tuple[str, ...], int]:
    return {tuple(text.split()): rank for text in phrases_due(*kinds)}


_BEFORE_LAST = -1
"""In front of the stop that was named just before."""
_LEADS = {
    **_table(
        (_ANY, "after them, now, so, ok, okay, please, also, after"),
        (_ANY, "back to, back at, back in, home to, then home to, only after both, only after all that"),
        (_ANY, "only after all of them, step one, step two, step three, step four, number one, number two"),
        (_ANY, "from there on to, from there to, on to, onward to, onwards to, number three, stop one"),
        (_ANY, "stop two, stop three, step 1, step 2, step 3, from"),
    ),
    **_due(_ANY, "following", "next", "counting", "between", "back", "next_thing"),
    **_due(_FIRST, "early", "opening", "beginning", "first_thing"),
    **_due(_LAST, "late", "closing", "ending", "last_thing"),
    **_due(_BEFORE_LAST, "earlier"),
    ("before", "you", "go", "there"): _BEFORE_LAST,
}
_TAILS = {
    **_table(
        (_ANY, "too, also, as well, please, now, thanks"),
    ),
    **_due(_ANY, "following", "next", "counting", "between", "placed_between"),
    **_due(_FIRST, "early", "opening", "placed_first"),
    **_due(_LAST, "late", "closing", "kept", "placed_last"),
    **_due(_BEFORE_LAST, "earlier", "placed_before"),
}
_ALL = frozenset(
    tuple(text.split())
    for text in (
        "each", "all", "them", "all of them", "them all", "each of them", "each one", "both",
        "both of them", "every one", "every one of them", "all three",
    )
)  # fmt: skip
_ORDERS = frozenset(
    (*lead, which, what)
    for lead in (
        ("in",),
        ("exactly", "in"),
        ("just", "in"),
        ("in", "just"),
        ("in", "exactly"),
        ("strictly", "in"),
    )
    for which in ("that", "this")
    for what in ("order", "sequence")
)
_REVERSED = frozenset({
    ("in", "reverse"), ("in", "reverse", "order"), ("in", "the", "reverse", "order"), ("backwards",),
    ("in", "the", "opposite", "order"), ("in", "reversed", "order"), ("the", "other", "way", "round"),
    ("the", "other", "way", "around"), ("from", "last", "to", "first"), ("from", "the", "end"),
})  # fmt: skip
_COURTESY = frozenset({("please",), ("thanks",), ("thank", "you"), ("ok",), ("okay",), ()})
_JOINTS = frozenset({"before", "after", "once", "when"})
_BEEN = (("you", "have", "been", "at"), ("you", "have", "been", "to"), ("you", "have", "been", "in"),
         ("you", "have", "visited"), ("you", "have", "done"), ("you", "are", "done", "at"),
         ("you", "are", "done", "with"), ("you", "were", "at"), ("you", "have", "seen"), ("you", "left"),
         ("you", "have", "finished", "at"), ("you", "have", "left"), ("you", "go", "to"))  # fmt: skip

_GONE = frozenset(been for been in _BEEN if been[-1] in {"at", "to", "in", "left", "visited"})


@dataclass(frozen=True)
class _Stop:
    words: Phrase
    kind: str = ""
    """"motion" or "look"; empty if no verb was said."""
    rank: int = _ANY
    again: bool = False
    """Whether it is said to be gone back to."""


class _UnknownError(Exception):
    """A part is no stop."""


def as_itinerary(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """The stops of a message in their order, as orders; None if it is more than stops.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one place.
    """
    if warns(words):
        return None
    if not words or "?" in keys(words) or len(words) > 60:
        return None
    return _whole(words, is_stop) or _by_sentence(words, is_stop)


def warns(words: Phrase) -> bool:
    """For "tower on your left", "van ahead": what the robot is to mind, no stop.

    Args:
        words: A message, or what is said to a robot by name.
    """
    flat = keys(word for word in words if word.is_word)
    sides = {"left", "right", "left-hand", "right-hand"}
    side = flat[-3:-2] in {("on",), ("to",)} and flat[-2] == "your" and flat[-1] in sides
    return (
        side
        or flat[-2:] in {("behind", "you"), ("before", "you"), ("beside", "you")}
        or flat[-1:] == ("ahead",)
    )


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
    words, backwards = _forwards(_simpler(words))
    try:
        stops, ordered, shared = _stops(words, is_stop)
    except _UnknownError:
        return None
    if backwards and not ordered:
        stops, ordered = stops[::-1], True
    verbless = any(not stop.kind for stop in stops[:1]) or bool(shared)
    if len(stops) < 2 or not (ordered or verbless):
        return None
    result: list[Word] = []
    for stop in sorted(stops, key=lambda one: one.rank):
        result += _words(", then") if result else ()
        going = _words("inspect" if (shared or stop.kind) == "look" else "go to")
        result += stop.words if stop.kind == "back" else (*going, *stop.words)
    return tuple(result)


def _forwards(words: Phrase) -> tuple[Phrase, bool]:
    """Without "in reverse order", and whether that was said."""
    body = tuple(word for word in words if word.is_word and word.key != "please")
    found = next((r for r in _REVERSED if keys(body)[-len(r) :] == r and len(r) < len(body)), ())
    at = next((i for i in range(len(words)) if keys(words[i : i + len(found)]) == found), 0) if found else 0
    return (words[:at], True) if at else (words, False)


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
        read = _back_here(piece) or _read(piece, is_stop)
        if len(read) == 1 and _RETURNING & set(keys(piece)):
            read = [replace(read[0], again=True)]
        if marked != _ANY:
            read, marked = [replace(stop, rank=marked) for stop in read], _ANY
        if joined and len(read) == 1 and not read[0].kind and read[0].rank == _ANY:
            # "A after B and C": whether C is before A nobody can tell by words of order alone.
            raise _UnknownError
        joined = len(read) > 1 and keys(piece[:1])[0] not in _JOINTS
        if len(read) > 1 and _known(read, stops):
            _put_pair(read[0], read[1], stops)
            ordered = True
            continue
        for stop in read:
            kind = stop.kind or kind
            ordered = ordered or stop.rank != _ANY or stop.kind == "back"
            _put(replace(stop, kind=kind), stops, early=early)
        early = keys(piece[:1]) == ("before",) and keys(piece[:2])[-1] not in {"that", "it", "this"}
        ordered = ordered or early or bool((_JOINTS | {"do", "only"}) & set(keys(piece)))
    return stops, ordered, shared


_RETURNING = frozenset({"back", "return", "again"})


def _back_here(piece: Phrase) -> list[_Stop]:
    """For "then back here": coming back, as the last stop."""
    return (
        [_Stop(_words("come back"), "back", again=True)] if keys(_stripped(piece, _ANY)[0]) in _HERE else []
    )


_HERE = frozenset(
    tuple(text.split())
    for text in (
        "back here", "return here", "come back", "come back here", "return", "here again", "back", "go back",
        "back again", "head back", "back to here", "return to here", "back to start", "back to the start",
    )
)  # fmt: skip


def _at(stop: _Stop, stops: list[_Stop]) -> int:
    """Where a place is among those named before; -1 if it is not."""
    return next((i for i, other in enumerate(stops) if keys(bare(other.words)) == keys(bare(stop.words))), -1)


def _known(pair: list[_Stop], stops: list[_Stop]) -> bool:
    return any(_at(stop, stops) >= 0 for stop in pair)


def _put_pair(early: _Stop, late: _Stop, stops: list[_Stop]) -> None:
    """One place before another, where one of them was named before ("A after B, B after C")."""
    first, second = _at(early, stops), _at(late, stops)
    if first < 0:
        stops.insert(second, replace(early, kind=early.kind or stops[second].kind))
    elif second < 0:
        stops.insert(first + 1, replace(late, kind=late.kind or stops[first].kind))
    elif first > second:
        stops.insert(second, stops.pop(first))


def _put(stop: _Stop, stops: list[_Stop], *, early: bool) -> None:
    same = _at(stop, stops)
    round_trip = same >= 0 and stops[same].rank == _FIRST and len(stops) > same + 2
    if same >= 0 and not round_trip and not stop.again:
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
    flat = keys(piece)
    way = flat.index("to") if flat[:1] == ("from",) and "to" in flat else 0
    if way and is_stop(piece[1:way]) and is_stop(piece[way + 1 :]):
        # "From A to B", where A was named before.
        return [_Stop(piece[1:way], "motion"), _Stop(piece[way + 1 :], "motion")]
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
            return [_Stop(other, "motion" if been in _GONE else kind, rank)]
        if is_stop(ahead) and is_stop(other):
            pair = [_Stop(ahead, kind, rank), _Stop(other, "motion" if been in _GONE else kind, rank)]
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
            for size in range(min(7, len(flat) - 1), 0, -1):
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
                piece = piece[size:] if front else _ahead(piece[:-size])
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
