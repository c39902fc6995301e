"""Actions that fit no frame: an order is held against what their makers say of them, by meaning and by words.

Names decide nothing. An action is meant for certain where two witnesses say so: its description (or a phrase)
is nearer in meaning than any other of the catalogue, and the verb of the order stands in it. Then every word
of the order has a place: in the description, or in an input of its kind.
"""

from __future__ import annotations

import itertools
import json
from collections import OrderedDict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from parley.language.builtin.filling import Fill, Slots, fill
from parley.language.builtin.lexicon import Lexicon, lemmas, stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.spans import Parse
from parley.language.builtin.tagger import Matrix, Tagger
from parley.language.builtin.tokens import tokenize
from parley.language.builtin.wishes import Filler, Wish
from parley.messages.status import ActionInfo
from parley.umrf.kinds import parameters_of, words_of_name

__all__ = ["OwnAction", "OwnActions"]

_NEAR = 0.25
"""Less alike in meaning is no match, whatever the words."""
_MARGIN = 0.15
"""So far ahead of the next action one must be."""
_LEADS, _STANDS, _FITS = 0.3, 0.15, 0.15
"""What it is worth that the verb opens what is said of an action; stands in it; that all words fit."""
_READ = 0.1
"""So much the tagger must believe in what fills an input."""
_OFFERED = 0.35
"""From so much on an action is offered in a question."""
_KEPT = 64
_TEXTS = 2000
_LOGIC = frozenset("CUWE")
_ACTS = frozenset({"order", "answer", "social"})


@dataclass(frozen=True, slots=True)
class OwnAction:
    """An action that an order means, with what it says for each input."""

    action: ActionInfo
    fills: tuple[Fill, ...]
    words: frozenset[str]
    """Stems of all that is said of it."""
    certain: bool
    """Whether it is done without asking."""
    missing: tuple[str, ...] = ()
    """Inputs that are needed and were not said."""

    @property
    def label(self) -> str:
        """What it does, in words of its maker; those of its name where there are no others."""
        first = self.action.description.partition(". ")[0].rstrip(".").partition(";")[0].partition(":")[0]
        text = first if " " in first else " ".join(words_of_name(self.action.name))
        return text[:1].lower() + text[1:]


@dataclass(frozen=True, slots=True)
class _Known:
    """An action with what its maker says of it."""

    action: ActionInfo
    words: frozenset[str]
    """Stems of all that is said."""
    leading: frozenset[str]
    """Words that open a sentence or phrase of it."""
    rows: tuple[int, ...]
    slots: Slots
    told: bool
    """Whether its maker says what it does; else its name hints at it, and it is only offered."""


@dataclass(frozen=True, slots=True)
class _Clause:
    """One order of a message."""

    start: int
    end: int
    verb: tuple[str, ...]
    content: tuple[int, ...]
    """Places of the words that carry something."""
    text: str
    fillers: tuple[Filler, ...]


class OwnActions:
    """What catalogues hold besides the known frames; each is prepared once."""

    def __init__(self, tagger: Tagger, lexicon: Lexicon) -> None:
        self._tagger = tagger
        self._lexicon = lexicon
        self._vectors: OrderedDict[str, Matrix] = OrderedDict()
        self._known: OrderedDict[str, tuple[tuple[_Known, ...], Matrix]] = OrderedDict()

    def applied(
        self, parse: Parse, reading: Reading, catalogue: Sequence[ActionInfo], framed: frozenset[str]
    ) -> Reading:
        """A reading in which orders that mean an action of the robot's own are such.

        Args:
            parse: The message.
            reading: What it says, by frames.
            catalogue: What the robot can do.
            framed: Names of the actions that are known frames.
        """
        known, vectors = self._prepared(catalogue)
        if not known:
            return reading
        clauses = _clauses(parse, reading, self._lexicon)
        found = [self._meant(clause, known, vectors, framed, reading) for clause in clauses]
        meant = [(clause, own) for clause, own in zip(clauses, found, strict=True) if own is not None]
        return _replaced(parse, reading, meant, len(meant) == len(clauses)) if meant else reading

    def _prepared(self, catalogue: Sequence[ActionInfo]) -> tuple[tuple[_Known, ...], Matrix]:
        key = json.dumps([info.model_dump(mode="json") for info in catalogue])
        if key not in self._known:
            self._known[key] = self._prepare(catalogue)
            if len(self._known) > _KEPT:
                self._known.popitem(last=False)
        return self._known[key]

    def _prepare(self, catalogue: Sequence[ActionInfo]) -> tuple[tuple[_Known, ...], Matrix]:
        texts: list[str] = []
        known = []
        for info in catalogue:
            said = [text for text in (info.description, *info.phrases, *info.examples) if text]
            if any("::" in name for name in info.inputs):
                continue
            plain = [_without_holes(text) for text in said] or [" ".join(words_of_name(info.name))]
            words = frozenset(stem(word) for text in plain for word in _words(text))
            leading = frozenset(form for text in plain for word in _opening(text) for form in lemmas(word))
            rows = tuple(range(len(texts), len(texts) + len(plain)))
            texts += plain
            named = frozenset(stem(word) for name in info.inputs for word in words_of_name(name))
            slots = Slots(parameters_of(info), frozenset(info.optional), words | named)
            known.append(_Known(info, words, leading, rows, slots, bool(said)))
        return tuple(known), self._meanings(texts)

    def _meanings(self, texts: Sequence[str]) -> Matrix:
        for text in texts:
            if text not in self._vectors:
                self._vectors[text] = self._tagger.meanings([text])[0]
        while len(self._vectors) > max(_TEXTS, len(texts)):
            self._vectors.popitem(last=False)
        rows: Matrix = np.array([self._vectors[text] for text in texts], dtype=np.float32)
        return rows

    def _meant(
        self,
        clause: _Clause,
        known: Sequence[_Known],
        vectors: Matrix,
        framed: frozenset[str],
        reading: Reading,
    ) -> OwnAction | None:
        """The action that an order means; None if it means none, or one that its frame leads to."""
        agreed = _is_framed(clause, reading)
        rivals = [item for item in known if item.action.name not in framed]
        if not clause.verb or (agreed and not any(self._word(clause, item) for item in rivals)):
            return None
        likeness = vectors @ self._tagger.meanings([clause.text])[0]
        ranked = []
        for item in known:
            meaning = max(float(likeness[row]) for row in item.rows)
            word = self._word(clause, item)
            filled = fill(clause.fillers, clause.content, clause.verb, item.slots, self._lexicon)
            worth = meaning + word + (_FITS if filled.whole else 0.0)
            ranked.append((worth, meaning, word, item, filled))
        ranked.sort(key=lambda row: row[0], reverse=True)
        told = [row for row in ranked if row[3].told]
        if told:
            worth, meaning, word, item, filled = told[0]
            ahead = worth - told[1][0] if len(told) > 1 else worth
            sure = meaning >= _NEAR and word > 0 and ahead >= _MARGIN and filled.whole
            sure = sure and all(one.filler.share >= _READ for one in filled.fills)
            if sure and not (agreed and item.action.name in framed):
                return OwnAction(item.action, filled.fills, item.slots.words, True)
        worth, meaning, word, item, filled = ranked[0]
        if agreed or item.action.name in framed:
            return None
        ahead = worth - ranked[1][0] if len(ranked) > 1 else worth
        if worth >= _OFFERED + _FITS and (word > 0 or ahead >= _MARGIN):
            missing = filled.missing if filled.accounted else ()
            return OwnAction(item.action, filled.fills, item.slots.words, False, missing)
        return None

    def _word(self, clause: _Clause, item: _Known) -> float:
        forms = lemmas(clause.verb[0]) if clause.verb else ()
        beside = all(stem(word) in item.words for word in clause.verb[1:])
        if beside and any(form in item.leading for form in forms):
            return _LEADS
        return _STANDS if beside and any(stem(form) in item.words for form in forms) else 0.0


def _without_holes(text: str) -> str:
    """A phrase without what stands for values."""
    return " ".join(part for part in text.replace("{", " {").split() if not part.startswith("{"))


def _words(text: str) -> list[str]:
    return [token.low for token in tokenize(text) if token.is_word]


def _opening(text: str) -> Iterable[str]:
    """The words that may be the verb of what is said: those that open it, or stand behind "and", "or"."""
    words = [token.low for token in tokenize(text)]
    return [word for at, word in enumerate(words) if at == 0 or words[at - 1] in (".", "and", "or", "then")]


def _clauses(parse: Parse, reading: Reading, lexicon: Lexicon) -> list[_Clause]:
    """The orders of a message: each from one verb to the next."""
    size = len(parse.tokens)
    starts = [verb.start for verb in parse.verbs if _opens(parse, verb.start, lexicon)]
    bounds = [0, *(start for start in starts if _content(parse, 0, start, lexicon)), size]
    fillers = [filler for wish in reading.wishes for filler in wish.fillers] + [*reading.loose]
    found = []
    for start, end in itertools.pairwise(bounds):
        called = {at for f in fillers if f.role == "A" for at in range(f.start, f.end)}
        content = [at for at in _content(parse, start, end, lexicon) if at not in called]
        if not {parse.acts[at] for at in content} <= _ACTS:
            return []
        verb = next((verb for verb in parse.verbs if start <= verb.start < end), None)
        places = (
            [*range(verb.start, verb.end), *verb.particles]
            if verb is not None and content and verb.start <= content[0]
            else content[:1]
        )
        words = tuple(parse.tokens[at].low for at in places)
        inside = {f.start: f for f in fillers if start <= f.start < end and f.role != "A"}
        text = parse.text(content[0], end) if content else ""
        rest = tuple(at for at in content if at not in places)
        found.append(_Clause(start, end, words, (*rest,), text, _sorted(inside, parse, rest, places)))
    return found


def _sorted(
    inside: dict[int, Filler], parse: Parse, rest: Sequence[int], places: Sequence[int]
) -> tuple[Filler, ...]:
    """The roles of a clause, and as roles unknown the words that are in none."""
    taken = {at for filler in inside.values() for at in range(filler.start, filler.end)} | {*places}
    for at in rest:
        if at not in taken:
            inside[at] = Filler("?", at, at + 1, 0, (parse.tokens[at].low,))
    return tuple(inside[at] for at in sorted(inside))


def _opens(parse: Parse, at: int, lexicon: Lexicon) -> bool:
    """Whether a verb begins a clause: behind a mark or a linking word."""
    while (
        at
        and parse.tokens[at - 1].is_word
        and parse.tokens[at - 1].low in lexicon.classes["small"] - {"and", "then"}
    ):
        at -= 1
    return not at or not parse.tokens[at - 1].is_word or parse.tokens[at - 1].low in ("and", "then")


def _content(parse: Parse, start: int, end: int, lexicon: Lexicon) -> list[int]:
    small = lexicon.classes["small"]
    return [at for at in range(start, end) if parse.tokens[at].is_word and parse.tokens[at].low not in small]


def _is_framed(clause: _Clause, reading: Reading) -> bool:
    """Whether tagger and lexicon agree on what a clause wants."""
    inside = [wish for wish in reading.wishes if clause.start <= wish.start < clause.end]
    return bool(inside) and all(wish.witness == "agrees" for wish in inside)


def _replaced(
    parse: Parse, reading: Reading, meant: Sequence[tuple[_Clause, OwnAction]], all_of_it: bool
) -> Reading:
    wishes, loose, left = list(reading.wishes), list(reading.loose), list(reading.left_over)
    for clause, own in meant:
        before = [wish for wish in wishes if clause.start <= wish.start < clause.end]
        logic = tuple(f for f in clause.fillers if f.role in _LOGIC)
        wishes = [wish for wish in wishes if wish not in before]
        loose = [f for f in loose if not clause.start <= f.start < clause.end]
        for token in parse.tokens[clause.start : clause.end]:
            if token.text in left:
                left.remove(token.text)
        wish = Wish("DO", clause.start, " ".join(clause.verb), logic, 1.0, "agrees", own=own)
        negated = any(one.negated for one in before)
        wishes.append(replace(wish, negated=negated, otherwise=any(one.otherwise for one in before)))
    wishes.sort(key=lambda wish: wish.start)
    acts = frozenset({"order"}) if all_of_it else reading.acts
    return replace(reading, acts=acts, wishes=tuple(wishes), loose=tuple(loose), left_over=tuple(left))
