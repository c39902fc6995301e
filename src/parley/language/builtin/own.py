"""Actions that fit no frame: an order is held against what their makers say of them, by meaning and by words.

Names decide nothing. An action is meant for certain where two witnesses say so: its description (or a phrase)
is nearer in meaning than any other of the catalogue, and the verb of the order stands in it. Then every word
of the order has a place: in the description, or in an input of its kind.
"""

from __future__ import annotations

import itertools
import json
import re
from collections import OrderedDict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from parley.language.builtin.filling import Filling, Slots, fill, filled_by
from parley.language.builtin.lexicon import Lexicon, lemmas, stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.spans import Filler, Parse
from parley.language.builtin.tagger import Matrix, Tagger
from parley.language.builtin.tokens import tokenize
from parley.language.builtin.wishes import OwnAction, Wish
from parley.language.dialogue.facts import asks_to_keep
from parley.messages.status import ActionInfo
from parley.umrf.kinds import parameters_of, words_of_name

__all__ = ["OwnActions", "is_promised"]

_NEAR = 0.25
"""Less alike in meaning is no match, whatever the words."""
_MARGIN = 0.15
"""So far ahead of the next action one must be."""
_ALIKE = 0.6
"""So near in meaning an action is where it is offered though no word of the order stands in it."""
_LEADS, _STANDS, _FITS = 0.3, 0.15, 0.15
"""What it is worth that the verb opens what is said of an action; stands in it; that all words fit."""
_SHARES = 0.15
"""That all other words stand in it, too."""
_READ = 0.1
"""So much the tagger must believe in what fills an input."""
_OFFERED = 0.5
"""From so much on an action is offered in a question."""
_ANYTHING = frozenset({"object", "item", "thing", "person", "obj", "to", "at", "of"})
"""Words of a name that say nothing of what it takes."""
_KEPT = 64
_TEXTS = 2000
_LOGIC = frozenset("CUWE")


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
    patterns: tuple[re.Pattern[str], ...]
    """Its phrases and examples."""
    named: frozenset[str]
    """Stems of its name, all of which an order must say, if its maker says nothing else of it."""


class _Rank(NamedTuple):
    """How much speaks for an action."""

    worth: float
    meaning: float
    word: float
    """What the verb of the order is worth in what is said of it."""
    shared: float
    """Which share of the other words stands in it."""
    item: _Known
    filled: Filling


def is_promised(message: str, catalogue: Sequence[ActionInfo]) -> bool:
    """Whether a message is, word by word, one by which an action may be asked for."""
    words = re.findall(r"[\w']+", message.lower())
    phrases = (phrase for info in catalogue for phrase in (*info.phrases, *info.examples))
    return any(re.findall(r"[\w']+", phrase.lower()) == words for phrase in phrases)


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
        """A reading in which orders that mean an own action of the robot, none of the `framed`, are such."""
        known, vectors = self._prepared(catalogue)
        if not known:
            return reading
        said = " ".join(_words(parse.text(0, len(parse.tokens))))
        whole = any(
            not pattern.groups and pattern.fullmatch(said) for item in known for pattern in item.patterns
        )
        clauses = clauses_of(parse, reading, self._lexicon, whole=whole)
        found = [self._meant(clause, known, vectors, framed, reading) for clause in clauses]
        meant = [
            (clause, own)
            for clause, own in zip(clauses, found, strict=True)
            if own is not None and (own.certain or len(clauses) == 1 or _has_verb(clause, parse))
        ]
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
            if info.for_programs or any("::" in name for name in info.inputs):
                continue  # nobody says a pose in words, nor by what programs know something
            plain = [_without_holes(text) for text in said] or [" ".join(words_of_name(info.name))]
            words = frozenset(stem(word) for text in plain for word in _words(text))
            leading = frozenset(form for text in plain for word in _opening(text) for form in lemmas(word))
            rows = tuple(range(len(texts), len(texts) + len(plain)))
            texts += plain
            named = frozenset(stem(word) for name in info.inputs for word in words_of_name(name))
            slots = Slots(parameters_of(info), frozenset(info.optional), words | named)
            patterns = tuple(map(_pattern, (*info.phrases, *info.examples)))
            whole = frozenset() if said else words - _ANYTHING
            known.append(_Known(info, words, leading, rows, slots, patterns, whole))
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
        clause: Clause,
        known: Sequence[_Known],
        vectors: Matrix,
        framed: frozenset[str],
        reading: Reading,
    ) -> OwnAction | None:
        """The action that an order means; None if it means none, or one that its frame leads to."""
        phrased = [own for item in known if (own := self._phrased(clause, item, framed)) is not None]
        how = clause.verb[:1] == ("be",)  # "be quiet" is no deed
        if phrased or not clause.orders or how or asks_to_keep(clause.text):
            return phrased[0] if len(phrased) == 1 else None
        agreed = _is_framed(clause, reading)
        rivals = [item for item in known if item.action.name not in framed]
        if not clause.verb or (agreed and not any(self._word(clause, item) for item in rivals)):
            return None
        likeness = vectors @ self._tagger.meanings([clause.text])[0]
        ranked = sorted(
            (self._ranked(clause, item, likeness) for item in known), key=lambda rank: -rank.worth
        )
        spoken = {*clause.verb, *(word for filler in clause.fillers for word in filler.words)}
        spoken = {form for word in spoken for form in (stem(word), *lemmas(word))}
        told = [rank for rank in ranked if rank.item.named <= spoken]
        if told and self._is_sure(told) and not (agreed and told[0].item.action.name in framed):
            best = told[0]
            return OwnAction(best.item.action, best.filled.fills, best.item.slots, True, best.filled.missing)
        if not _is_framed(clause, reading, other_than="DO"):
            best = ranked[0]  # a name may be offered where nothing else is understood
        elif told:
            best = told[0]
        else:
            return None
        if agreed or best.item.action.name in framed:
            return None
        ahead = not best.item.named and _ahead(told) >= _MARGIN and best.meaning >= _ALIKE
        hinted = best.word > 0 or best.shared > 0 or ahead
        if best.worth >= _OFFERED and hinted:
            missing = best.filled.missing if best.filled.accounted else ()
            return OwnAction(best.item.action, best.filled.fills, best.item.slots, False, missing)
        return None

    def _ranked(self, clause: Clause, item: _Known, likeness: Matrix) -> _Rank:
        meaning = max(float(likeness[row]) for row in item.rows)
        word, shared = self._word(clause, item), self._shared(clause, item)
        filled = fill(clause.fillers, clause.content, clause.verb, item.slots, self._lexicon)
        worth = meaning + word + _SHARES * shared + (_FITS if filled.whole else 0.0)
        return _Rank(worth, meaning, word, shared, item, filled)

    @staticmethod
    def _is_sure(ranked: Sequence[_Rank]) -> bool:
        """Whether both witnesses speak for the first one, and every word of the order has a place in it."""
        best = ranked[0]
        read = all(one.filler.share >= _READ for one in best.filled.fills)
        both = best.meaning >= _NEAR and best.word > 0 and _ahead(ranked) >= _MARGIN
        missing = {*best.filled.missing} - {best.item.slots.counting}  # how often may be said behind it
        return both and best.filled.accounted and not missing and read

    def _shared(self, clause: Clause, item: _Known) -> float:
        """Which share of the words besides the verb stands in what is said of an action."""
        words = [word for filler in clause.fillers for word in filler.words]
        classes = self._lexicon.classes
        kinds = ("prepositions", "determiners", "small", "logic", "pronouns")
        small = frozenset().union(*(classes[kind] for kind in kinds))
        carrying = {stem(word) for word in words if word not in small and word.isalpha()}
        return len(carrying & item.words) / len(carrying) if carrying else 0.0

    def _phrased(self, clause: Clause, item: _Known, framed: frozenset[str]) -> OwnAction | None:
        """The action, if just these words are one of its phrases or examples."""
        if not clause.may_order:
            return None
        said = " ".join(_words(clause.text))
        for pattern in item.patterns:
            match = pattern.fullmatch(said)
            if match is None or (item.action.name in framed and (match.groupdict() or item.slots.parameters)):
                continue  # what it takes is grounded by its frame
            given = {name: tuple(text.split()) for name, text in match.groupdict().items()}
            fills = tuple(filled_by(name, words, item.slots, self._lexicon) for name, words in given.items())
            missing = set(item.slots.parameters) - set(given) - item.slots.optional
            if not missing and all(one is not None for one in fills):
                kept = tuple(one for one in fills if one is not None)
                return OwnAction(item.action, kept, item.slots, True)
        return None

    def _word(self, clause: Clause, item: _Known) -> float:
        forms = lemmas(clause.verb[0]) if clause.verb else ()
        beside = all(stem(word) in item.words for word in clause.verb[1:])
        if beside and any(form in item.leading for form in forms):
            return _LEADS
        return _STANDS if beside and any(stem(form) in item.words for form in forms) else 0.0


def _ahead(ranked: Sequence[_Rank]) -> float:
    return ranked[0].worth - (ranked[1].worth if len(ranked) > 1 else 0.0)


def _without_holes(text: str) -> str:
    """A phrase without what stands for values."""
    return " ".join(part for part in text.replace("{", " {").split() if not part.startswith("{"))


def _pattern(phrase: str) -> re.Pattern[str]:
    """What a phrase looks like in a message; a hole is a name that only stands once."""
    parts = re.split(r"\{(\w+)\}", phrase)
    names = parts[1::2]
    if len({*names}) < len(names) or not any(part.strip() for part in parts[::2]):
        return re.compile(r"(?!)")
    texts = [" ".join(_words(part)) for part in parts[::2]]
    holes = [f"(?P<{name}>.+)" for name in names]
    woven = [
        piece for pair in itertools.zip_longest(map(re.escape, texts), holes, fillvalue="") for piece in pair
    ]
    return re.compile(" ".join(piece for piece in woven if piece))


def _words(text: str) -> list[str]:
    return [token.low for token in tokenize(text) if token.is_word]


def _opening(text: str) -> Iterable[str]:
    """The words that may be the verb of what is said: those that open it, or stand behind "and", "or"."""
    words = [token.low for token in tokenize(text)]
    return [word for at, word in enumerate(words) if at == 0 or words[at - 1] in (".", "and", "or", "then")]


def _has_verb(clause: Clause, parse: Parse) -> bool:
    return any(clause.start <= verb.start < clause.end for verb in parse.verbs)


def _is_framed(clause: Clause, reading: Reading, other_than: str = "") -> bool:
    """Whether a clause is a frame: one that tagger and lexicon agree on, or any other than the one named."""
    inside = [wish for wish in reading.wishes if clause.start <= wish.start < clause.end]
    if other_than:
        return any(wish.frame != other_than for wish in inside)
    return bool(inside) and all(wish.witness == "agrees" for wish in inside)


def _replaced(
    parse: Parse, reading: Reading, meant: Sequence[tuple[Clause, OwnAction]], all_of_it: bool
) -> Reading:
    wishes, loose, left = list(reading.wishes), list(reading.loose), list(reading.left_over)
    for clause, own in meant:
        before = [wish for wish in wishes if clause.start <= wish.start < clause.end]
        logic = tuple(
            f for f in clause.fillers if f.role in _LOGIC or (f.role == "O" and not own.slots.counting)
        )
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
    return replace(
        reading, acts=acts, wishes=tuple(wishes), loose=tuple(loose), left_over=tuple(left), unsteady=()
    )


# -- the orders of a message: each from one verb to the next, whatever frame the tagger sees in them --


_ORDERING = frozenset({"order", "answer", "social"})
_TELLING = frozenset({*_ORDERING, "told", "edit"})


@dataclass(frozen=True, slots=True)
class Clause:
    """One order of a message."""

    start: int
    end: int
    verb: tuple[str, ...]
    content: tuple[int, ...]
    """Places of the words that carry something, without the verb's."""
    text: str
    """From its first word that carries something."""
    fillers: tuple[Filler, ...]
    orders: bool
    """Whether it is an order for all that the tagger sees in it."""
    may_order: bool
    """Whether it is at least neither a question, a need nor an alarm."""


def clauses_of(parse: Parse, reading: Reading, lexicon: Lexicon, *, whole: bool = False) -> list[Clause]:
    """The orders of a message: each from one verb to the next, or all of it as one."""
    size = len(parse.tokens)
    starts = [verb.start for verb in parse.verbs if not whole and _opens(parse, verb.start, lexicon)]
    bounds = [0, *(start for start in starts if _content(parse, 0, start, lexicon)), size]
    fillers = [filler for wish in reading.wishes for filler in wish.fillers] + [*reading.loose]
    found = []
    for start, end in itertools.pairwise(bounds):
        called = {at for f in fillers if f.role == "A" for at in range(f.start, f.end)}
        content = [at for at in _content(parse, start, end, lexicon) if at not in called]
        acts = {parse.acts[at] for at in content}
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
        roles = _sorted(inside, parse, rest, places)
        orders, may_order = acts <= _ORDERING, acts <= _TELLING
        found.append(Clause(start, end, words, rest, text, roles, orders, may_order))
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
