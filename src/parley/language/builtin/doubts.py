"""Why an order is not certain enough to be carried out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.language.builtin.decision import Ask
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading
from parley.language.builtin.spans import Filler
from parley.language.builtin.wishes import Wish

__all__ = ["AGREED", "ALONE", "doubt", "may_be_offered"]

AGREED = 0.1
"""So much the tagger must believe in the least certain part of a wish that the lexicon agrees with."""
ALONE = 0.6
"""So much where the lexicon does not know the verb."""

NAMED = 0.03
"""So much in a role whose words name something of the map."""
OFFERED = 0.1
"""So much in what is shown for a yes."""
_FEW = 2
"""So many words at most may be left over of what is shown for a yes."""


def doubt(
    reading: Reading, orders: tuple[Wish, ...], knows: Callable[[Filler], bool], *, idle: bool = False
) -> Ask | None:
    """What is to be asked before these orders of a reading are carried out; None if they are certain.

    Args:
        reading: Of the clause.
        orders: The wishes among it that are to be carried out.
        knows: Whether all words of a role name something of the map: another witness that it is one.
        idle: Whether there is no plan that a message could change: what sounds like a change is an order.
    """
    if reading.left_over:
        return Ask(
            f"I do not understand “{' '.join(reading.left_over)}” in this. Can you say it in other words?"
        )
    seen = orders and all(wish.frame in ("LOOK", "COUNT") and wish.has("TK") for wish in orders)
    unclear = {"alarm", "control"} | (set() if seen else {"question"}) | (set() if idle else {"edit"})
    if reading.acts & unclear:
        return Ask("I am not sure what you want me to do. Can you say one thing at a time?")
    if reading.unsteady:
        what = " ".join(dict.fromkeys(" ".join(reading.unsteady).split()))
        return Ask(f"I am not sure what you mean by “{what}”. Can you say it in other words?")
    for wish in orders:
        row = bool(orders[0].verb) or not any("there" in f.words for one in orders for f in one.fillers)
        listed = row and wish != orders[0] and not wish.verb and wish.frame == orders[0].frame
        named = listed and all(knows(filler) for filler in wish.fillers)
        least = AGREED if wish.witness == "agrees" or named else ALONE  # "go to bay 1 and bay 2"
        shares = [
            f.share for f in wish.fillers if wish.witness != "agrees" or not knows(f) or f.share < NAMED
        ]
        weak = min([wish.share, *shares]) < least
        if weak or wish.witness == "differs":
            what = f"“{wish.verb}”" if wish.verb else f"“{wish.fillers[0].text}”"
            return Ask(f"I am not sure what you mean by {what}. Can you say it in other words?")
    for filler in reading.loose:
        second = filler.role == "L" and any(w.start < filler.start and w.has("L") for w in reading.wishes)
        if second or filler.role not in ("A", "T", "L", "M"):
            return Ask(f"I do not understand what “{filler.text}” belongs to. Can you say it in other words?")
    return None


def may_be_offered(reading: Reading, orders: Sequence[Wish], lexicon: Lexicon) -> bool:
    """Whether orders that are not certain are sensible enough to be shown, for a person to say yes to."""
    if reading.acts & {"alarm", "question", "control", "edit"} or len(reading.left_over) > _FEW:
        return False
    named = any(len(word) == 1 or word.isdigit() for word in reading.left_over)  # "areas A, B and C"
    if named or {word.lower() for word in reading.left_over} & lexicon.classes["logic"]:
        return False
    if any(filler.role not in ("A", "T", "L", "M") for filler in reading.loose):
        return False
    return all(wish.witness != "differs" and wish.share >= OFFERED for wish in orders)
