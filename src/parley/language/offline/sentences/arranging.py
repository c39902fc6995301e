"""Orders that change the place of others: "A, but on the way there B" is B, A; "A. B instead" is B."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.sentences.units import Unit
from parley.language.offline.words.lexicon import PhraseTable
from parley.language.offline.words.order import due, phrases_due
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["arranged", "each_in_turn", "without_end"]

_DATA = load_data("units")
_STOP = Word(".", ".")
_BEFORE_IT = due("earlier")
_EARLIER = PhraseTable.of([*_DATA["earlier"], *phrases_due("earlier")])
_PLACES = frozenset({"to", "back", "home", "from"})
_REFUSED = frozenset({"bother", "worry", "mind", "care", "do", "need", "trouble", "concern"})
_POINTING = frozenset({"that", "it", "this", "them", "about", "with", "yourself"})


def arranged(units: Sequence[Unit]) -> Phrase | None:
    """The message with each order where it is meant to come; None if all are.

    Args:
        units: The parts of the message, in their order.
    """
    parts = list(units)
    changed = False
    index = len(parts)
    while index > 1:
        index = min(index, len(parts)) - 1
        unit = parts[index]
        if unit.kind not in {"order", "name"}:
            continue
        before = _ordered_before(parts, index)
        if before < 0:
            continue
        early, late = _early(unit.words), _late(keys(unit.words))
        late = late if unit.kind == "order" and unit.names and len(unit.words) > late + 2 else 0
        if (early and len(unit.words) > early) or late:
            end = _joined_end(parts, index)
            words = unit.words[early:] if early else unit.words[:-late]
            moved = [_said(unit, words), *parts[index + 1 : end]]
            parts[before:end] = [*moved, *parts[before:index]]
            changed = True
        elif _instead(unit.words):
            parts[index] = _said(unit, tuple(word for word in unit.words if word.key != "instead"))
            del parts[before:index]
            changed = True
    parts, moved_ends = _ranked(parts)
    changed = changed or moved_ends
    kept = [u for i, u in enumerate(parts) if not _cancels(u, parts, i) and not _cancelled(parts, i)]
    if not changed and len(kept) == len(parts):
        return None
    return tuple(word for unit in kept if unit.words for word in (*unit.words, _mark(unit)))


_PAIR = 2
_PLURAL = frozenset({"each", "all", "both", "them", "every", "everyone"})
_COUNTED = frozenset(_DATA["counted"])
_THOSE_TWO = frozenset((those, many) for those in ("those", "these") for many in ("two", "three", "four"))


_ASIDES = PhraseTable.of(_DATA["asides"])
_ENDS = tuple(tuple(text.split()) for text in _DATA["ends"])


def without_end(words: Phrase) -> Phrase:
    """A message without "that is it" at the end of its sentences."""
    result: list[Word] = []
    flat = keys(words)
    index = 0
    while index < len(words):
        aside = _ASIDES.match(flat, index)
        if aside is not None:
            index += aside[0] + (flat[index + aside[0] : index + aside[0] + 1] in {(":",), (",",)})
            while result and result[-1].key in {",", "and"}:
                result.pop()
            result += (Word(",", ","),) if result and result[-1].is_word and index < len(words) else ()
            continue
        end = next((e for e in _ENDS if flat[index : index + len(e)] == e), ())
        behind = index + len(end)
        ends = end and (
            behind == len(flat) or not words[behind].is_word or flat[behind] in {"thanks", "thank", "please"}
        )
        if ends and sum(word.is_word for word in result) > 3:
            index = behind
            while result and result[-1].key in {",", "and", "so"}:
                result.pop()
            continue
        result.append(words[index])
        index += 1
    return tuple(result)


def each_in_turn(units: Sequence[Unit]) -> Phrase | None:
    """For "A, B, C. Look at each of them": look at A, look at B, look at C; None if it is not like that."""
    wanted = [i for i, unit in enumerate(units) if unit.kind in {"order", "wish"}]
    orders = [i for i in wanted if units[i].kind == "order"]
    at = (orders or wanted or [0])[0]
    start = at
    while start and (units[start - 1].kind == "name" or (start > 1 and _is_aside(units[start - 1]))):
        start -= 1
    start = at - 1 if start == at and at and len(units[at - 1].names) > 1 else start
    names = [name for unit in units[start:at] for name in unit.names]
    words = units[at].words if at else ()
    flat = keys(words)
    cut = next((i for i in range(1, len(flat)) if flat[i] in _PLURAL or flat[i : i + 2] in _THOSE_TWO), 0)
    rest = cut + 1
    while rest < len(flat) and flat[rest] in _COUNTED:
        rest += 1
    if flat[cut : cut + 1] == ("both",) and not any(unit.kind == "name" for unit in units[start:at]):
        start, names = at, _told_pair(units[:at])
    if len(names) < 2 or not cut or units[at].names or flat[rest : rest + 1] not in {(), ("for",)}:
        return None
    if any(set(keys(unit.words)) & {"after", "before", "not", "except", "or"} for unit in units[start:at]):
        return None
    before = [(*unit.words, _mark(unit)) for unit in units[:start] if unit.words]
    each = [(*words[:cut], *name, *words[rest:], _STOP) for name in names]
    after = [(*unit.words, _mark(unit)) for unit in units[at + 1 :] if unit.words]
    return tuple(word for part in (*before, *each, *after) for word in part)


def _told_pair(units: Sequence[Unit]) -> list[Phrase]:
    """The two things that a story was about last, if it was about two ("it came from A or B")."""
    names: dict[tuple[str, ...], Phrase] = {}
    for unit in reversed(units):
        if unit.kind not in {"told", "reason", "idle"}:
            return []
        names = {keys(name): name for name in unit.names} | names
        if len(names) > 1:
            break
    return list(names.values()) if len(names) == _PAIR else []


def _is_aside(unit: Unit) -> bool:
    """For "in that order" between names and what is to be done with them."""
    return unit.kind == "idle" and not unit.names and len(unit.words) < 5


_LAST = due("late", "closing", "kept")
_FIRST = due("opening", "early")


def _ranked(parts: list[Unit]) -> tuple[list[Unit], bool]:
    """Orders that end in "first" or "last" where they belong; whether any was moved."""
    orders = [i for i, unit in enumerate(parts) if unit.kind == "order" and unit.names]
    if len(orders) < 2:
        return parts, False
    front, middle, back = [], [], []
    changed = False
    for index, unit in enumerate(parts):
        flat = keys(unit.words)
        last = _LAST.match_end(flat) if index in orders else 0
        first = _FIRST.match_end(flat) if index in orders else 0
        begin = next((i for i, key in enumerate(flat) if key not in _AH), 0)
        hedged = {"if", "unless", "but", "when", "second"} & set(flat[begin:])
        early = _EARLY.match(flat, begin) if index in orders and index != orders[0] else None
        if early is not None and flat[begin + early[0] : begin + early[0] + 1] not in {(), ("of",)}:
            front.append(_said(unit, unit.words[begin + early[0] :]))
            changed = True
            continue
        later = index in orders and flat[-1:] == ("later",) and _now_first(parts[index + 1 :])
        if later:
            back.append(_said(unit, unit.words[:-1]))
            changed = True
            continue
        if last and not hedged and len(flat) > last + 1:
            back.append(_said(unit, _kept_for_last(unit.words[begin:-last])))
            changed = True
        elif first and not hedged and index != orders[0] and len(flat) > first + 1:
            front.append(_said(unit, unit.words[begin:-first]))
            changed = True
        else:
            middle.append(unit)
    at = next((i for i, unit in enumerate(middle) if unit.kind == "order"), len(middle))
    return [*middle[:at], *front, *middle[at:], *back], changed


_EARLY = due("early")
_AH = frozenset({"ah", "oh", "now", "please", "and", "but", "so", "ok", "well", ",", "yes", "right", "also"})


def _now_first(parts: Sequence[Unit]) -> bool:
    """Whether the next order is to be done first ("A later, first B")."""
    flat = keys(parts[0].words) if parts and parts[0].kind in {"order", "name"} else ()
    return bool({"first", "now"} & set(flat))


def _kept_for_last(words: Phrase) -> Phrase:
    """For "leave the desk (until last)": the desk."""
    at = next((i for i, word in enumerate(words) if word.key in _KEEPING), -1)
    return (*words[:at], *_GO_TO, *words[at + 1 :]) if at >= 0 else words


_KEEPING = frozenset({"leave", "save", "keep"})
_GO_TO = (Word("go", "go"), Word("to", "to"))


def _mark(unit: Unit) -> Word:
    return Word("?", "?") if unit.kind == "asked" else _STOP


def _said(unit: Unit, words: Phrase) -> Unit:
    while words and not words[0].is_word:
        words = words[1:]
    return Unit("order", unit.start, unit.end, words, unit.free, unit.names)


def _ordered_before(parts: Sequence[Unit], index: int) -> int:
    """The order before another one in a message that names something itself; -1 if there is none."""
    kinds = {"order", "name", "wish"}
    return next((i for i in range(index - 1, -1, -1) if parts[i].kind in kinds and parts[i].names), -1)


def _late(flat: tuple[str, ...]) -> int:
    """How many words at the end say that this comes before what was said last."""
    size = _BEFORE_IT.match_end(flat)
    return size or int(flat[-1:] == ("before",) and flat[-2:-1] not in _NO_BEFORE)


_NO_BEFORE = frozenset(
    (word,) for word in ("as", "like", "than", "the", "day", "night", "week", "ever", "from")
)


def _early(words: Phrase) -> int:
    """How many words say that this comes before what was said last."""
    found = _EARLIER.match(keys(words))
    if found is None or keys(words[found[0] : found[0] + 1])[:1] in {(word,) for word in _PLACES}:
        return 0
    return found[0]


def _joined_end(parts: Sequence[Unit], index: int) -> int:
    """Where what belongs to an order ends: "and look ..." behind "stop at the desk"."""
    end = index + 1
    while end < len(parts) and parts[end].kind == "order" and keys(parts[end].words[:1]) == ("and",):
        if parts[end].names and keys(parts[end].words[1:2]) != ("look",):
            break
        end += 1
    return end


def _instead(words: Phrase) -> bool:
    flat = keys(words)
    if (
        not flat
        or flat[0] in {"if", "unless", "in", "when", "not", "do", "otherwise", "should"}
        or "if" in flat
    ):
        return False
    return flat[-1] == "instead" and "of" not in flat


def _refuses(unit: Unit) -> bool:
    """Whether it says "do not bother with that"."""
    flat = keys(unit.words)
    while flat[:1] in {("but",), ("so",), ("and",)}:
        flat = flat[1:]
    rest = set(flat[3:])
    return (
        unit.kind == "order"
        and flat[:2] == ("do", "not")
        and flat[2:3] != ()
        and (flat[2] in _REFUSED and rest <= _POINTING and not unit.names)
    )


def _cancels(unit: Unit, parts: Sequence[Unit], index: int) -> bool:
    return _refuses(unit) and index > 0 and _cancelled(parts, index - 1)


def _cancelled(parts: Sequence[Unit], index: int) -> bool:
    """Whether a wish is taken back at once ("X needs Y, but do not bother with that")."""
    following = parts[index + 1 : index + 2]
    return parts[index].kind == "wish" and bool(following) and _refuses(following[0])
