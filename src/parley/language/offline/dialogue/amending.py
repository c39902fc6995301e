"""The last order once more with another value: "make it 32", "it is room 15", "another two", "twice as much".

For values that no map knows; `elsewhere` and changes of the plan do that for what stands on the map.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.elsewhere import put_in_place
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.quantities import Quantity, quantities
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.language.word_lists import load_data

__all__ = ["Amended", "amended"]

_DATA: Final = load_data("amending")
_SMALL: Final = frozenset(_DATA["small"])
_CORRECTING: Final = frozenset(_DATA["correcting"])
_ADDING: Final = frozenset(_DATA["adding"])
_SHARES: Final = {
    tuple(phrase.split()): float(factor) for factor, phrases in _DATA["shares"].items() for phrase in phrases
}
_MAKING: Final = frozenset(
    (verb, what) for verb in ("make", "change", "set") for what in ("it", "that", "this")
)
_LONGEST: Final = 14


@dataclass(frozen=True, slots=True)
class Amended:
    """An order made of the last one."""

    words: Phrase
    instead: bool
    """Whether it takes the place of the last one, or comes on top of it."""


def amended(words: Phrase, situation: Situation) -> Amended | None:
    """The last order with what is said now in the place of what is like it; None for any other message.

    Args:
        words: All words and punctuation.
        situation: What is known, with what was said before.
    """
    said = tuple(word for word in words if word.is_word)
    flat = keys(said)
    order = _last_order(situation.history)
    if not order or not 0 < len(said) <= _LONGEST or "?" in keys(words):
        return None
    if opens_command(said) and flat[:2] not in _MAKING:
        return None
    if "but" in flat and {"again", "more"} & set(flat):
        return None
    adds = bool(_ADDING & set(flat))
    if not adds and not _CORRECTING & set(flat):
        return None
    denied = flat.index("not") if "not" in flat[1:] else len(flat)
    named, share = _inner(said[:denied])
    if named and ground_phrase(bare(named), situation.objects).outcome != "none":
        return None
    changed = _with_share(order, share) if share else order
    if named and changed is not None:
        changed = _of_another(changed, named, situation) or _with_value(changed, named)
    if changed is None or keys(changed) == keys(order):
        return None
    return Amended(changed, instead=not adds)


def _last_order(history: Sequence[Turn]) -> Phrase:
    """What the operator asked for last, if the robot did not ask anything back."""
    if not history or (history[-1].role != "operator" and "?" in history[-1].content[-80:]):
        return ()
    said = next((turn.content for turn in reversed(history) if turn.role == "operator"), "")
    words = tuple(word for word in tokens(said) if word.is_word or word.key == ",")
    return words if opens_command(words) or len(words) > 2 else ()


def _inner(said: Phrase) -> tuple[Phrase, float]:
    """What is named between small words, and the share of the amount that is said with it (0 if none)."""
    share = 0.0
    for phrase, factor in _SHARES.items():
        at = next((i for i in range(len(said)) if keys(said[i : i + len(phrase)]) == phrase), -1)
        if at >= 0:
            said, share = (*said[:at], *said[at + len(phrase) :]), factor
            break
    start, end = 0, len(said)
    while start < end and said[start].key in _SMALL:
        start += 1
    while end > start and said[end - 1].key in _SMALL:
        end -= 1
    return said[start:end], share


def _with_share(order: Phrase, share: float) -> Phrase | None:
    """The order with its one amount so many times as large."""
    found = quantities(order)
    return _put(order, found[-1], _written(found[-1].value * share)) if found else None


def _with_value(order: Phrase, named: Phrase) -> Phrase | None:
    """The order with a number, or something of the same kind, in the place of what is like it."""
    new = next((one for one in quantities(named) if (one.start, one.end) == (0, len(named))), None)
    if new is None:
        return _same_kind(order, named)
    old = [one for one in quantities(order) if not new.units or new.dimensions & one.dimensions]
    return _put(order, old[-1], named) if old else None


def _of_another(order: Phrase, named: Phrase, situation: Situation) -> Phrase:
    """For "(and) A for ten minutes" the order with A in it, and for so long; empty for one thing only."""
    found = quantities(named)
    new = found[-1] if found and found[-1].units and found[-1].end == len(named) else None
    old = [one for one in quantities(order) if new is not None and new.dimensions & one.dimensions]
    thing = named[: new.start] if new is not None else ()
    while thing and thing[-1].key in _SMALL:
        thing = thing[:-1]
    if new is None or not old or not thing:
        return ()
    return put_in_place(bare(thing), _put(order, old[-1], named[new.start :]), Scene.of(situation))


def _same_kind(order: Phrase, named: Phrase) -> Phrase | None:
    """For "room 15" in the place of "room 5", "the bean field" in the place of "the pea field"."""
    named = bare(named)
    labelled = len(named) > 1 and not named[-1].key.isalpha()
    head = named[-2] if labelled else named[-1]
    for at in range(len(order) - 1, 0, -1):
        if order[at].key != head.key:
            continue
        start = at
        while start > 1 and not labelled and order[start - 1].key not in lexicon().determiners | _SMALL:
            start -= 1
        if (start == at) != labelled:
            return None
        return (*order[:start], *named, *order[at + 1 + labelled :])
    return None


def _put(order: Phrase, old: Quantity, new: Phrase) -> Phrase:
    """The order with another number; it keeps its unit if the new one has none."""
    has_unit = any(one.units for one in quantities(new))
    return (*order[: old.start], *new, *order[old.end if has_unit else _digits_end(order, old) :])


def _digits_end(order: Phrase, number: Quantity) -> int:
    """Where a number ends and its unit begins."""
    for end in range(number.end, number.start + 1, -1):
        bare_number = quantities(order[number.start : end])
        if bare_number and bare_number[0].end == end - number.start and not bare_number[0].units:
            return end
    return number.start + 1


def _written(value: float) -> Phrase:
    text = f"{value:g}"
    return (Word(text, text),)
