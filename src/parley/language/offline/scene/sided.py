"""Sides that stand behind a thing: "the door on the right", "the second desk from the left"."""

from __future__ import annotations

from dataclasses import replace

from parley.language.offline.scene.viewing import COMPASS, rank_word
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import NounPhrase, bare
from parley.language.offline.words.text import Phrase, keys

__all__ = ["is_side", "sided"]

_SIDES: dict[tuple[str, ...], str] = {
    ("left",): "left", ("right",): "right", ("left", "side"): "left", ("right", "side"): "right",
    ("left", "hand", "side"): "left", ("right", "hand", "side"): "right", ("your", "left"): "left",
    ("your", "right"): "right", ("far", "left"): "leftmost", ("far", "right"): "rightmost",
    ("left", "end"): "leftmost", ("right", "end"): "rightmost", ("left", "hand", "end"): "leftmost",
    ("right", "hand", "end"): "rightmost", ("very", "left"): "leftmost", ("very", "right"): "rightmost",
    ("middle",): "middle", ("center",): "middle", ("centre",): "middle", ("corner",): "corner",
    **{(name,): name for name in COMPASS}, **{(name, "side"): name for name in COMPASS},
    **{(name, "corner"): name for name in COMPASS}, **{(name, "end"): name for name in COMPASS},
    **{(f"{name}ern", "side"): name for name in COMPASS},
    **{tuple(name.split("-")): name for name in COMPASS if "-" in name},
}  # fmt: skip
_HERE = frozenset({
    ("you",), ("here",), ("where", "you", "are"), ("yourself",), ("position",),
    ("where", "you", "are", "now"),
    ("where", "you", "stand"), ("robot",), ("your", "position"),
})  # fmt: skip
_BEFORE_YOU = {"in front of": "ahead", "behind": "behind", "ahead of": "ahead"}


def sided(noun: NounPhrase) -> NounPhrase:
    """For "the door on the right": the right door."""
    near = noun.relation in {"closest to", "nearest to", "nearest", "closest", "next to", "near", "close to"}
    far = noun.relation.startswith(("far", "fur")) and noun.relation != "far from"
    here = len(noun.anchors) == 1 and noun.core and keys(bare(noun.anchors[0])) in _HERE
    if here and (near or far):
        return replace(noun, core=("nearest" if near else "farthest", *noun.core), relation="", anchors=())
    if len(noun.anchors) != 1 or not noun.core:
        return noun
    anchor = keys(bare(noun.anchors[0]))
    if anchor == ("you",) and noun.relation in _BEFORE_YOU:
        return replace(noun, core=(_BEFORE_YOU[noun.relation], *noun.core), relation="", anchors=())
    if noun.relation == "from" and anchor in _SIDES:
        return _counted_from(noun, _SIDES[anchor])
    if noun.relation not in {"on", "at", "to", "in"}:
        return noun
    side = _SIDES.get(anchor) or _SIDES.get(anchor[: anchor.index("of")] if "of" in anchor else ())
    return noun if side is None else replace(noun, core=(side, *noun.core), relation="", anchors=())


def _counted_from(noun: NounPhrase, side: str) -> NounPhrase:
    """For "the second door from the left"."""
    ordinals = {str(n) for word, n in lexicon().ordinals.items() if word in keys(noun.phrase)}
    number = next((word for word in noun.core if word in ordinals), "")
    rest = tuple(word for word in noun.core if word != number)
    if not number or not rest:
        return noun
    return replace(noun, core=(rank_word(int(number), side), *rest), relation="", anchors=())


def is_side(words: Phrase) -> bool:
    """Whether words are a side ("the right", "the far left") or the middle."""
    return bool(words) and keys(bare(words)) in _SIDES
