"""Which words of an order fill which inputs of an action: by kind first, then by role, name and order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from parley.language.builtin.amounts import UNITS, Amount, amount_of, direction_of
from parley.language.builtin.lexicon import Lexicon, lemmas, stem
from parley.language.builtin.spans import Filler
from parley.language.lexicon import word_map
from parley.messages.status import ParameterInfo
from parley.pairing import best_pairs
from parley.umrf.kinds import words_of_name

__all__ = ["Fill", "Filling", "Slots", "fill", "filled_by"]

_ROLES: Mapping[str, Mapping[str, float]] = {
    "place": {"G": 2, "L": 2, "S": 2, "T": 1, "P": 1, "R": 0.5, "I": 0.3},
    "thing": {"T": 2, "I": 2, "G": 1, "S": 1, "L": 1, "X": 0.7, "K": 0.5, "R": 0.3, "P": 0.5},
    "person": {"R": 2, "T": 2, "G": 1},
    "text": {"X": 2, "K": 2, "Y": 2, "T": 1, "M": 0.5, "G": 0.3, "L": 0.3},
}
_FROM = frozenset({"from", "source", "src", "origin", "start"})
_AMOUNTS = frozenset({"distance", "angle", "duration", "number"})
_LOGIC = frozenset("CUWE")


@dataclass(frozen=True, slots=True)
class Slots:
    """The inputs of an action."""

    parameters: Mapping[str, ParameterInfo]
    optional: frozenset[str]
    words: frozenset[str]
    """Stems of all that is said of the action and its inputs."""

    @property
    def counting(self) -> str:
        """The input that says how often it is done; empty if there is none."""
        names = [name for name, told in self.parameters.items() if told.kind == "number" and not told.unit]
        texts = {name: {*words_of_name(name), *self.parameters[name].help.lower().split()} for name in names}
        return next(
            (name for name in names if texts[name] & {"times", "often", "repeats", "repetitions"}), ""
        )


@dataclass(frozen=True, slots=True)
class Fill:
    """What an order says for one input."""

    name: str
    parameter: ParameterInfo
    filler: Filler
    amount: Amount | None = None
    word: str = ""
    """For a choice or a direction."""


@dataclass(frozen=True, slots=True)
class Filling:
    """What an order says for an action."""

    fills: tuple[Fill, ...]
    missing: tuple[str, ...]
    accounted: bool
    """Whether every word has a place."""

    @property
    def whole(self) -> bool:
        """Whether nothing is missing and nothing is left over."""
        return self.accounted and not self.missing


def fill(
    fillers: Sequence[Filler], content: Sequence[int], verb: Sequence[str], slots: Slots, lexicon: Lexicon
) -> Filling:
    """Fill the inputs of an action from the roles of an order.

    Args:
        fillers: Of the order.
        content: Places of its words that carry something, the verb's left out.
        verb: Its words, among which a choice may be.
        slots: The inputs.
        lexicon: Closed classes.
    """
    logical = _LOGIC if slots.counting else _LOGIC | {"O"}
    given = _parted([filler for filler in fillers if filler.role not in logical], slots)
    names = list(slots.parameters)
    fits = {
        (at, name): _fit(filler, name, slots, lexicon, at)
        for at, filler in enumerate(given)
        for name in names
    }
    found: dict[int, Fill] = {}
    if given and names:
        table = [[fits[at, name][0] for name in names] for at in range(len(given))]
        for row, column in best_pairs(table):
            if table[row][column] > 0:
                found[row] = fits[row, names[column]][1]
    filled = {one.name for one in found.values()}
    for name in names:
        chosen = _chosen(verb, slots.parameters[name], lexicon) if name not in filled else ""
        if chosen:
            at = len(given)
            given.append(Filler("?", -1, -1, 0, tuple(verb)))
            found[at] = Fill(name, slots.parameters[name], given[at], word=chosen)
            filled.add(name)
    taken = {at for row in found for at in range(given[row].start, given[row].end)}
    words = {
        at: word
        for filler in given
        for at, word in zip(range(filler.start, filler.end), filler.words, strict=False)
    }
    loose = [at for at in content if at not in taken and not _is_said(words.get(at, ""), slots, lexicon)]
    logic = {at for filler in fillers if filler.role in logical for at in range(filler.start, filler.end)}
    missing = tuple(name for name in names if name not in filled and name not in slots.optional)
    return Filling(tuple(found.values()), missing, not [at for at in loose if at not in logic])


def filled_by(name: str, words: tuple[str, ...], slots: Slots, lexicon: Lexicon) -> Fill | None:
    """An input filled with words that stand in its place; None if they are none of its kind."""
    kind = slots.parameters[name].kind if name in slots.parameters else None
    if kind is None:
        return None
    small = lexicon.classes["prepositions"]
    behind = (at - 1 for at, word in enumerate(words) if at and word in small)
    filler = Filler(_ROLE_OF.get(kind, "N"), -1, -1, next(behind, len(words) - 1), words)
    worth, found = _fit(filler, name, slots, lexicon, 0)
    return found if worth > 0 or kind in ("text", "place", "thing", "person") else None


_ROLE_OF = {"place": "G", "person": "R", "thing": "T", "text": "X", "direction": "H"}


def _parted(fillers: Sequence[Filler], slots: Slots) -> list[Filler]:
    """With the number in front of a thing apart from it, where an input takes it: "20 boxes of sand"."""
    if not any(parameter.kind == "number" for parameter in slots.parameters.values()):
        return [*fillers]
    found: list[Filler] = []
    for filler in fillers:
        words = filler.words
        size = next((n for n in range(len(words)) if amount_of(words[: n + 1]) is None), len(words))
        size += size < len(words) and words[size] in _OTHER_UNITS
        if filler.role in "TGSL" and 0 < size < len(words) and amount_of(words[:1]) is not None:
            found.append(Filler("N", filler.start, filler.start + size, 0, words[:size]))
            head = max(filler.head - size, 0)
            filler = Filler(filler.role, filler.start + size, filler.end, head, words[size:])
        found.append(filler)
    return found


def _is_said(word: str, slots: Slots, lexicon: Lexicon) -> bool:
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    return word in small or stem(word) in slots.words


def _is_nothing_new(filler: Filler, slots: Slots, lexicon: Lexicon) -> bool:
    """Whether what it names is what the action is about anyway: "the horn" of "sound the horn"."""
    among = lexicon.classes["quantifiers"]
    return all(_is_said(word, slots, lexicon) for word in filler.words) and not among & {*filler.words}


def _fit(filler: Filler, name: str, slots: Slots, lexicon: Lexicon, at: int) -> tuple[float, Fill]:
    """How well a role fills an input; 0 if it cannot."""
    parameter = slots.parameters[name]
    order = 0.05 * abs(at - list(slots.parameters).index(name))
    plain = Fill(name, parameter, filler)
    if parameter.kind in _AMOUNTS:
        worth, amount = _amount(filler, parameter, slots)
        return (worth - order, Fill(name, parameter, filler, amount=amount)) if amount else (0.0, plain)
    if parameter.kind == "direction":
        direction = direction_of(filler.words, lexicon)
        return (2.0 - order, Fill(name, parameter, filler, word=direction)) if direction else (0.0, plain)
    if parameter.kind == "choice":
        chosen = _chosen(filler.words, parameter, lexicon)
        return (2.0 - order, Fill(name, parameter, filler, word=chosen)) if chosen else (0.0, plain)
    worth = _ROLES[parameter.kind].get(filler.role, 0.0)
    if not worth or amount_of(filler.words) is not None or _is_nothing_new(filler, slots, lexicon):
        return 0.0, plain
    words = set(words_of_name(name))
    source = bool(words & _FROM)
    if filler.role in "SG" and (filler.role == "S") is source:
        worth += 0.5
    worth += 0.5 * bool(words & lexicon.hints.get(filler.role, frozenset())) + bool(
        {stem(word) for word in filler.words} & {stem(word) for word in words}
    )
    return worth - order, plain


def _amount(filler: Filler, parameter: ParameterInfo, slots: Slots) -> tuple[float, Amount | None]:
    """A number whose unit the input can take; in the input's unit, unless that is a length or a time."""
    words = [word for word in filler.words if word not in _IDLE]
    amount = amount_of(words) or amount_of(
        [word for word in words if word in UNITS or not _says(word, slots)]
    )
    if amount is not None and amount.kind == parameter.kind:
        return 2.0, amount
    if amount is not None and (amount.kind == "number" or parameter.unit == "celsius"):
        return 1.0, Amount(amount.value, "" if amount.kind == "number" else "degrees")
    if parameter.kind != "number":
        return 0.0, None
    units = {_OTHER_UNITS[word] for word in words if word in _OTHER_UNITS}
    amount = amount_of([word for word in words if word not in _OTHER_UNITS and not _says(word, slots)])
    if amount is None or amount.kind != "number" or len(units) > 1:
        return 0.0, None
    unit = units.pop() if units else parameter.unit
    if unit == parameter.unit or not parameter.unit:
        return 1.5, amount
    scale = _SCALES.get((unit, parameter.unit))
    return (1.5, Amount(round(amount.value * scale, 6), "")) if scale else (0.0, None)


def _says(word: str, slots: Slots) -> bool:
    return stem(word) in slots.words


_IDLE = frozenset({"deep", "high", "tall", "long", "wide", "thick", "times", "up", "down", "number"})
_OTHER_UNITS = word_map("""percent:percent %:percent celsius:celsius c:celsius °:celsius grams:grams
gram:grams g:grams kg:kilograms kilos:kilograms kilo:kilograms kilograms:kilograms litres:litres
liters:litres litre:litres liter:litres l:litres ml:millilitres millilitres:millilitres rpm:rpm""")
_SCALES = {
    ("grams", "kilograms"): 0.001, ("kilograms", "grams"): 1000.0, ("millilitres", "litres"): 0.001,
    ("litres", "millilitres"): 1000.0,
}  # fmt: skip


def _chosen(words: Sequence[str], parameter: ParameterInfo, lexicon: Lexicon) -> str:
    """The one choice that words name, or an empty text."""
    if parameter.kind != "choice":
        return ""
    said = {form for word in words for form in (stem(word), *lemmas(word))}
    found = [choice for choice in parameter.choices if {stem(w) for w in choice.lower().split()} <= said]
    return found[0] if len(found) == 1 else ""
