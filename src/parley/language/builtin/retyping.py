"""Frames that differ by their roles alone: taking to a place is bringing, turning to a thing is facing it."""

from __future__ import annotations

from dataclasses import replace

from parley.language.builtin.amounts import amount_of, direction_of, is_compass
from parley.language.builtin.fillers import Filler
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.wishes import Wish

__all__ = ["BACKING", "retyped"]

BACKING = frozenset({"back", "backup", "reverse", "backing", "reversing", "retreat"})
"""Verbs that say the direction themselves."""
_HITHER = frozenset({"back", "here", "to", "over"})
_AT = frozenset(
    {"on", "in", "at", "near", "by", "under", "beside", "next", "behind", "inside", "from", "off"}
)
"""Prepositions that say where something is, and not where to."""
_JOINED = 2
"""So many marks and words at most stand between what is listed: ", and"."""
_FROM_THERE = frozenset({"from", "there", "here", "on"})
_TAKING = frozenset({"take", "grab", "pick", "collect", "lift"})


def retyped(wish: Wish, lexicon: Lexicon) -> Wish:
    """With the frame that its roles ask for."""
    if wish.frame in ("GO", "TURN"):
        wish = _renamed(wish, "G", "H", [f for f in wish.all("G") if _is_direction(f, lexicon)])
    if wish.frame == "WAIT" and wish.has("L") and not wish.has("DU"):
        return replace(_renamed(wish, "L", "G", list(wish.all("L"))), frame="GO")  # "stop at the gate"
    if wish.frame == "GUIDE" and not wish.has("T"):
        return _renamed(wish, "R", "T", list(wish.all("R")))
    if wish.frame == "GO":
        listed = [f for f in wish.all("T") if any(0 <= f.start - g.end <= _JOINED for g in wish.all("G"))]
        wish = _renamed(wish, "T", "G", listed if wish.has("G") else [*wish.all("T")])
        here = [f for f in wish.all("S") if {*f.words} <= _FROM_THERE]  # that is where it is then
        return _gone(replace(wish, fillers=tuple(f for f in wish.fillers if f not in here)))
    if wish.frame == "TURN" and not wish.has("N"):
        direction = next((direction_of(filler.words, lexicon) for filler in wish.all("H")), None)
        return replace(wish, frame="FACE") if wish.has("TG") or is_compass(direction or "") else wish
    if wish.frame == "TAKE":
        wish = _renamed(wish, "G", "S", [f for f in wish.all("G") if f.words[0] in _AT])
        return replace(wish, frame="BRING") if wish.has("RG") and wish.has("T") else wish
    if wish.frame == "BRING" and not wish.has("RG") and wish.verb.split(" ")[0] in _TAKING:
        return replace(wish, frame="TAKE")
    return wish


def _gone(wish: Wish) -> Wish:
    """Going with somebody is following, by an angle turning, without a goal moving."""
    amount = next((amount_of(filler.words) for filler in wish.all("N")), None)
    verb = wish.verb.split()
    told = {word for filler in wish.fillers for word in filler.words}
    if {*verb} & {"come", "return"} and told <= _HITHER and {*verb, *told} & {"back", "return"}:
        return replace(wish, verb="come back", fillers=())
    company = [filler for filler in wish.all("G") if filler.words[0] == "with"]
    if company:
        return replace(_renamed(wish, "G", "T", company), frame="FOLLOW")
    if wish.has("G"):
        return wish
    if amount is not None and amount.kind == "angle":
        return replace(wish, frame="TURN")
    backing = not wish.fillers and any(word in BACKING for word in verb) and verb[0] not in ("come", "get")
    return replace(wish, frame="MOVE") if wish.has("HN") or backing else wish


def _renamed(wish: Wish, role: str, other: str, fillers: list[Filler]) -> Wish:
    if not fillers:
        return wish
    return replace(
        wish,
        fillers=tuple(replace(f, role=other) if f.role == role and f in fillers else f for f in wish.fillers),
    )


def _is_direction(filler: Filler, lexicon: Lexicon) -> bool:
    """For "to your left", "forward": nothing but a direction."""
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"] | {"side", "direction"}
    rest = [word for word in filler.words if word not in small]
    return bool(rest) and all(direction_of([word], lexicon) for word in rest)
