"""From spans to what is wished and told: frames with their roles, who agrees on them, and what is left over."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from parley.language.builtin.amounts import amount_of, direction_of
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.spans import Parse, Span, Verb

__all__ = ["Filler", "Reading", "Wish", "read"]

Witness = Literal["agrees", "unknown", "differs"]


@dataclass(frozen=True, slots=True)
class Filler:
    """What fills a role: words of the message, by their places."""

    role: str
    start: int
    end: int
    head: int
    words: tuple[str, ...]
    """From start to end, in small letters."""
    share: float = 1.0

    @property
    def text(self) -> str:
        """Its words."""
        return " ".join(self.words)


@dataclass(frozen=True, slots=True)
class Wish:
    """One frame with its roles."""

    frame: str
    start: int
    verb: str
    fillers: tuple[Filler, ...]
    share: float
    """How much the tagger believes in the least certain part of it."""
    witness: Witness
    """What the lexicon says to it."""
    act: str = "order"
    negated: bool = False
    otherwise: bool = False

    def all(self, role: str) -> tuple[Filler, ...]:
        """What fills a role."""
        return tuple(filler for filler in self.fillers if filler.role == role)

    def one(self, role: str) -> Filler | None:
        """What fills a role first."""
        return next(iter(self.all(role)), None)

    def has(self, roles: str) -> bool:
        """Whether one of these roles is filled."""
        return any(filler.role in roles for filler in self.fillers)


@dataclass(frozen=True, slots=True)
class Reading:
    """What a message says."""

    acts: frozenset[str]
    wishes: tuple[Wish, ...]
    """In their order, facts that are told among them."""
    loose: tuple[Filler, ...]
    """What belongs to no frame."""
    left_over: tuple[str, ...]
    """Words that no part of the reading accounts for."""


def read(parse: Parse, lexicon: Lexicon) -> Reading:
    """What is wished and told."""
    wishes: list[Wish] = []
    fillers = [_filler(parse, span) for span in parse.spans]
    for number, verb in enumerate(parse.verbs):
        mine = [filler for filler, span in zip(fillers, parse.spans, strict=True) if span.owner == number]
        wishes.append(_wish(parse, verb, mine, lexicon))
    loose = [filler for filler, span in zip(fillers, parse.spans, strict=True) if span.owner is None]
    implied = [_implied(parse, filler, lexicon) for filler in loose]
    implied_wishes = _joined([wish for wish in implied if wish is not None])
    rest = tuple(filler for filler, wish in zip(loose, implied, strict=True) if wish is None)
    ordered = sorted([*wishes, *implied_wishes], key=lambda wish: wish.start)
    spread = [part for wish in ordered for part in _spread(_retyped(wish, lexicon))]
    return Reading(frozenset(parse.acts), tuple(spread), rest, _left_over(parse, lexicon))


def _filler(parse: Parse, span: Span) -> Filler:
    words = tuple(token.low for token in parse.tokens[span.start : span.end])
    return Filler(span.role, span.start, span.end, span.head - span.start, words, span.share)


def _wish(parse: Parse, verb: Verb, mine: list[Filler], lexicon: Lexicon) -> Wish:
    words = [token.low for token in parse.tokens[verb.start : verb.end]]
    particles = [parse.tokens[at].low for at in verb.particles]
    while words and (words[0] in ("don't", "dont", "not", "never", "do") and len(words) > 1):
        words = words[1:]
    known = lexicon.frames_of(words, particles)
    witness: Witness = "agrees" if verb.frame in known else "differs" if known else "unknown"
    act = parse.acts[verb.start]
    said = " ".join([*words, *particles])
    share = min([verb.share, *(filler.share for filler in mine)])
    return Wish(
        verb.frame, verb.start, said, tuple(mine), share, witness, act, verb.negated, verb.otherwise
    )


def _implied(parse: Parse, filler: Filler, lexicon: Lexicon) -> Wish | None:
    """The frame of a goal, a direction or an angle that stands without a verb."""
    if parse.acts[filler.start] not in ("order", "edit") or filler.role not in "GHN":
        return None
    frame = "GO"
    if filler.role == "N":
        amount = amount_of(filler.words)
        frame = "TURN" if amount is not None and amount.kind == "angle" else "GO"
    elif filler.role == "H":
        frame = "TURN" if direction_of(filler.words, lexicon) in ("left", "right") else "GO"
    return Wish(frame, filler.start, "", (filler,), filler.share, "unknown" if filler.role == "G" else "agrees")


def _joined(wishes: list[Wish]) -> list[Wish]:
    """A direction and an amount side by side are one wish."""
    found: list[Wish] = []
    for wish in wishes:
        last = found[-1] if found else None
        near = last is not None and wish.start - last.fillers[-1].end < 2
        if last is not None and near and {last.fillers[0].role, wish.fillers[0].role} == {"H", "N"}:
            frame = "TURN" if "TURN" in (last.frame, wish.frame) else "GO"
            fillers = (*last.fillers, *wish.fillers)
            found[-1] = replace(last, frame=frame, fillers=fillers, share=min(last.share, wish.share))
        else:
            found.append(wish)
    return found


def _retyped(wish: Wish, lexicon: Lexicon) -> Wish:
    """With the frame that its roles ask for: taking to somewhere is bringing, turning to a thing is facing it."""
    frame = wish.frame
    amount = next((amount_of(filler.words) for filler in wish.all("N")), None)
    if frame in ("TAKE", "FIND") and wish.has("RG") and wish.has("T") and not (frame == "FIND" and not wish.has("G")):
        frame = "BRING" if frame == "TAKE" else frame
    elif frame == "BRING" and not wish.has("RG") and wish.verb.split(" ")[0] in ("take", "grab", "pick", "collect", "lift"):
        frame = "TAKE"
    elif frame == "GO" and not wish.has("G") and amount is not None and amount.kind == "angle":
        frame = "TURN"
    elif frame == "GO" and not wish.has("G") and wish.has("HN"):
        frame = "MOVE"
    elif frame == "GO" and not wish.fillers and any(word in _BACKING for word in wish.verb.split()):
        frame = "MOVE"
    if frame == "TURN" and not wish.has("N"):
        direction = next((direction_of(filler.words, lexicon) for filler in wish.all("H")), None)
        if wish.has("TG") or (direction or "") in _COMPASS:
            frame = "FACE"
    return replace(wish, frame=frame)


_BACKING = frozenset({"back", "reverse", "backing", "reversing", "retreat"})
_COMPASS = frozenset({"north", "south", "east", "west", "northeast", "northwest", "southeast", "southwest"})
_MANY = {"T", "G"}


def _spread(wish: Wish) -> list[Wish]:
    """One wish for each of several goals or things."""
    for role in _MANY:
        several = wish.all(role)
        if len(several) > 1:
            others = tuple(filler for filler in wish.fillers if filler.role != role)
            return [
                replace(wish, start=wish.start if not number else one.start, fillers=(*others, one))
                for number, one in enumerate(several)
            ]
    return [wish]


def _left_over(parse: Parse, lexicon: Lexicon) -> tuple[str, ...]:
    taken: set[int] = set()
    for verb in parse.verbs:
        taken |= {*range(verb.start, verb.end), *verb.particles}
    for span in parse.spans:
        taken |= set(range(span.start, span.end))
    low = [token.low for token in parse.tokens]
    small = lexicon.classes["small"]
    left = []
    for at, token in enumerate(parse.tokens):
        if at in taken or not token.is_word or low[at] in small or parse.acts[at] in ("social", "told"):
            continue
        if any(" ".join(low[max(at - back, 0) : at - back + size]) in small for size in (2, 3) for back in range(size)):
            continue
        left.append(token.text)
    return tuple(left)
