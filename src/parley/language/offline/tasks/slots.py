"""What a clause says for the inputs of one action: numbers, choices, things, places, people, words.

The clause is cut into parts by its prepositions; every part goes to the input that it fits best.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.choices import chosen, is_listed, switched
from parley.language.offline.tasks.parts import Part, map_spans, parts_of, trimmed, unquoted
from parley.language.offline.tasks.roles import number_inputs, parameter_role, pose_inputs, text_inputs
from parley.language.offline.tasks.stand_ins import kinds_on_map, with_stand_ins
from parley.language.offline.words.concepts import contrary
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.quantities import Quantity, levels, quantities, taken_by
from parley.language.offline.words.text import Phrase, keys, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

__all__ = [
    "COLOURS",
    "Filled",
    "fill_parts",
    "fill_slots",
    "kind_on_map",
]

_OF_PLACE = frozenset(
    {"to", "into", "onto", "in", "on", "at", "near", "inside", "by", "towards", "toward", "over"}
)


@dataclass
class Filled:
    """The outcome: values, what is still missing, and what was said for no input."""

    values: dict[str, Any] = field(default_factory=dict)
    phrases: dict[str, Phrase] = field(default_factory=dict)
    """The words behind each value in words."""
    missing: list[str] = field(default_factory=list)
    left: list[Part] = field(default_factory=list)
    numbers_left: int = 0
    counted: set[int] = field(default_factory=set)
    """Where what is counted stands behind a number ("24 boxes")."""
    measured: list[frozenset[str]] = field(default_factory=list)
    """For each number whose unit fits its input, what such inputs are called."""
    exact: bool = False
    """Whether a number is said with its unit, or with the name of its input."""
    of_kind: bool = False
    """Whether a thing of the map is of the kind that an input is called by."""
    states: bool = False
    """Whether it is said how something is to be, on or off."""
    chosen: bool = False
    """Whether one of the values that the description lists is said."""
    fit: float = 0.0
    """How well what is said fits the inputs."""
    recalled: list[Remembered] = field(default_factory=list)
    """The facts that tell what is not said."""


def fill_slots(info: ActionInfo, words: Phrase, explained: Iterable[int], scene: Scene) -> Filled:
    """Find values for the inputs of an action.

    Args:
        info: The action.
        words: The clause, verb first.
        explained: Which of its words say what is to be done, and are no values.
        scene: What is known.
    """
    filled = Filled()
    words, explained = _joined(words, set(explained))
    gone = set(explained)
    spans = map_spans(words, scene)
    free = unquoted(words)
    gone |= _choices(info, free, filled)
    gone |= _numbers(info, free, spans, filled, scene)
    gone |= _switches(info, free, filled)
    open_names = [
        name for name in text_inputs(info) if name not in filled.values and not is_listed(name, info)
    ]
    kinds = {part for name in open_names for part in name_words(name)}
    parts = parts_of(words, gone, spans, scene, kinds)
    if not _place_in_numbers(info, parts, filled):
        _words_for(info, words, parts, gone, filled, scene)
    else:
        _words_for(info, words, [part for part in parts if part.item is None], gone, filled, scene)
    filled.missing = _missing(info, filled)
    return filled


def fill_parts(
    info: ActionInfo, words: Phrase, parts: Sequence[Part], scene: Scene, known: Collection[str] = ()
) -> Filled:
    """Find values for the inputs of an action among parts of which it is known what they are to the deed.

    Args:
        info: The action.
        words: The clause.
        parts: What it names.
        scene: What is known.
        known: Inputs that have their values already.
    """
    filled = Filled(values=dict.fromkeys(known))
    gone = _choices(info, words, filled)
    gone |= _numbers(info, words, map_spans(words, scene), filled, scene)
    gone |= _switches(info, words, filled)
    kept = (replace(part, words=_without(part.words, words, gone)) for part in parts)
    _, filled.left = _assigned(info, [part for part in kept if part.words], filled, scene)
    filled.missing = _missing(info, filled)
    for name in known:
        filled.values.pop(name)
    return filled


def _missing(info: ActionInfo, filled: Filled) -> list[str]:
    """The inputs that are needed and have no value."""
    needed = (name for name in info.inputs if name not in info.optional and "::" not in name)
    return [name for name in needed if name not in filled.values]


def _without(part: Phrase, words: Phrase, gone: Collection[int]) -> Phrase:
    """A part of a clause without those of its words that are explained."""
    size = len(part)
    at = next((i for i in range(len(words) - size + 1) if words[i : i + size] == part), -1)
    if at < 0 or not any(at <= index < at + size for index in gone):
        return part
    return trimmed(tuple(word for i, word in enumerate(part) if at + i not in gone))


def _joined(words: Phrase, explained: set[int]) -> tuple[Phrase, set[int]]:
    """For "in A and in B": in A and B."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat) - 1) if flat[i - 1] == "and" and flat[i] in _OF_PLACE), 0)
    if not at or flat[at] not in flat[: at - 1]:
        return words, explained
    return (*words[:at], *words[at + 1 :]), {i - (i > at) for i in explained if i != at}


def _choices(info: ActionInfo, words: Phrase, filled: Filled) -> set[int]:
    """Values that inputs choose among."""
    used: set[int] = set()
    for name, (value, at) in chosen(info, words).items():
        filled.values[name], filled.phrases[name] = value, words[at.start : at.stop]
        filled.fit += 2
        filled.chosen = True
        used |= set(at)
    return used


def _numbers(
    info: ActionInfo,
    words: Phrase,
    spans: Sequence[tuple[int, int, MapObject | None]],
    filled: Filled,
    scene: Scene,
) -> set[int]:
    """Numbers for the inputs that take them; one in the name of a thing only if an input is named so."""
    names = number_inputs(info)
    if not names:
        return set()
    takes = {name: taken_by(name, info.description) for name in names}
    said = [
        q
        for q in (*quantities(words), *_ordinals(words))
        if not _in_name(q, spans) or any(q.before in t.words for t in takes.values())
    ]
    if any("ratio" in t.dimensions for t in takes.values()) and not any(
        "ratio" in q.dimensions for q in said
    ):
        taken = {index for q in said for index in range(q.start, q.end)}
        said += [q for q in levels(words) if not taken & set(range(q.start, q.end))]
    axes = {axis: name for name, axis in pose_inputs(info).items()}
    used: set[int] = set()
    if axes and len(said) >= 2 and not any(q.units and q.dimensions - {"length"} for q in said[:2]):
        order = iter(axis for axis in ("x", "y", "yaw", "z") if axis in axes)
        for quantity in said:
            axis = quantity.before if quantity.before in axes else next(order, "")
            if axis and axes[axis] not in filled.values:
                filled.values[axes[axis]] = quantity.value
                used |= set(range(quantity.start - (quantity.before in axes), quantity.end))
        filled.fit += 2
        return used
    left = [q for q in said if not _labels_text(q, info) and not _labels_thing(q, info, scene, said)]
    told = re.findall(r"[a-z]+", info.description.lower())
    for wanted in (3, 2, 1):
        for name in names:
            best = next((q for q in left if takes[name].fit(q) >= wanted), None)
            if name in filled.values or best is None or (name in axes.values()):
                continue
            if wanted == 1 and takes[name].words & {"seconds", "minutes", "hours"} and len(names) > len(left):
                continue
            filled.values[name] = takes[name].value_of(best)
            filled.fit += wanted / 2
            filled.exact = wanted > 1
            if best.units and wanted > 1:
                filled.measured.append(takes[name].names)
            if best.value > 0 and contrary(keys(words), (*name_words(info.name), *told)):
                filled.values[name] = -filled.values[name]
            left.remove(best)
            filled.counted |= set() if best.units else {best.end}
            named = best.start - 1 if best.before in takes[name].words else best.start
            used |= set(range(named, best.end))
    filled.numbers_left = len(left)
    return used


def _labels_text(quantity: Quantity, info: ActionInfo) -> bool:
    """Whether a number belongs to a name in words: the 2 of "line 2" for an input called `line`."""
    if quantity.units:
        return False
    named = {word for name in text_inputs(info) for word in name_words(name)}
    numbered = {word for name in number_inputs(info) for word in name_words(name)}
    return singular(quantity.before) in named - numbered


def _labels_thing(quantity: Quantity, info: ActionInfo, scene: Scene, said: Sequence[Quantity]) -> bool:
    """Whether a number is short for a thing of the map ("set A in 201 to 19"): one more than inputs take."""
    if quantity.units or quantity.before not in _OF_PLACE - {"to"} or len(said) <= len(number_inputs(info)):
        return False
    return any(_called_by_label(f"{quantity.value:g}", name, scene) for name in text_inputs(info))


def _called_by_label(label: str, name: str, scene: Scene) -> MapObject | None:
    """The thing of the kind that an input is called by that has a number or letter."""
    for kind in name_words(name):
        found = scene.ground(tokens(f"{kind} {label}"))
        if found.outcome == "match" and kind_on_map(name, scene.objects):
            return found.candidates[0]
    return None


def _ordinals(words: Phrase) -> list[Quantity]:
    """For "the third floor": floor 3."""
    ranks = lexicon().ordinals
    return [
        Quantity(float(ranks[word.key]), (), index, index + 2, words[index + 1].key)
        for index, word in enumerate(words[:-1])
        if word.key in ranks
    ]


def _in_name(quantity: Quantity, spans: Sequence[tuple[int, int, MapObject | None]]) -> bool:
    return any(start <= quantity.start < end for start, end, _ in spans)


def _switches(info: ActionInfo, words: Phrase, filled: Filled) -> set[int]:
    """Inputs that are so or not, in a type of their own or in words."""
    used: set[int] = set()
    for name in info.inputs:
        found = switched(info, name, words) if name not in filled.values else None
        if found is not None:
            filled.values[name], filled.states = found[0], True
            used |= found[1]
    return used


def _place_in_numbers(info: ActionInfo, parts: Sequence[Part], filled: Filled) -> bool:
    """A thing of the map for inputs that take coordinates, where no numbers are said."""
    axes = pose_inputs(info)
    if not axes or any(name in filled.values for name in axes):
        return False
    item = next((part.item for part in parts if part.item is not None), None)
    if item is None:
        return False
    for name, axis in axes.items():
        if axis in {"x", "y"}:
            filled.values[name] = item.x_m if axis == "x" else item.y_m
        elif name not in info.optional:
            filled.values[name] = 0.0
    return True


def _words_for(
    info: ActionInfo, words: Phrase, parts: Sequence[Part], gone: set[int], filled: Filled, scene: Scene
) -> None:
    """The parts of a clause for the inputs that take words, best fits first."""
    taken, left = _assigned(info, parts, filled, scene)
    filled.left = _with_all_said(words, taken, left, gone, filled)
    for name, part in taken.items():
        where = next((other for other in left if other.grounded and other.before in _OF_PLACE), None)
        general = set(keys(part.words)) <= {*name_words(name), *lexicon().person_words}
        if where is not None and general and part.end < where.start <= part.end + 2:
            # "The person at desk 7": only the place tells which one.
            said = words[part.end - len(part.words) : where.end]
            filled.values[name], filled.phrases[name] = plain(said), said


def _assigned(
    info: ActionInfo, parts: Sequence[Part], filled: Filled, scene: Scene
) -> tuple[dict[str, Part], list[Part]]:
    """Give parts to the inputs that take words, best fits first; those taken and those left."""
    names = [name for name in text_inputs(info) if name not in filled.values and not is_listed(name, info)]
    left, taken = [_labelled(_of_it(part, names), names, scene) for part in parts], dict[str, Part]()
    left = [with_stand_ins(part, names, filled.recalled, scene) for part in _all_of_kind(left, names, scene)]
    while names and left:
        fits = [
            (_fit(name, part, number, scene), -names.index(name), -number, name, part)
            for name in names
            for number, part in enumerate(left)
        ]
        score, _, _, name, part = max(fits, key=lambda fit: fit[:3])
        if score <= 0:
            break
        filled.values[name], filled.phrases[name] = plain(part.words), part.words
        filled.fit += min(score, 3) / 3
        filled.of_kind = filled.of_kind or bool(part.kinds & {singular(word) for word in name_words(name)})
        names.remove(name)
        left.remove(part)
        taken[name] = part
    return taken, left


def _of_it(part: Part, names: Sequence[str]) -> Part:
    """For "the lid of box 2", where an input takes a box: box 2."""
    at = keys(part.words).index("of") if "of" in keys(part.words) else 0
    if (
        not at
        or part.item is None
        or not part.kinds & {singular(word) for n in names for word in name_words(n)}
    ):
        return part
    return replace(part, words=trimmed(part.words[at + 1 :]), start=part.end - len(part.words) + at + 1)


def _all_of_kind(parts: list[Part], names: Sequence[str], scene: Scene) -> list[Part]:
    """For "everything except A", where an input takes a zone: all zones except A."""
    kind = next((word for name in names for word in kinds_on_map(name, scene.objects)), "")
    at = next((i for i, part in enumerate(parts) if keys(part.words)[:1] in _EVERYTHING), -1)
    if not kind or at < 0:
        return parts
    words, end = (*tokens(f"all {kind}s"), *parts[at].words[1:]), at + 1
    if words[-1].key in _EXCEPTING or (len(words) > 2 and words[2].key in _EXCEPTING):
        # What is excepted may be cut off by its article.
        words = (*words, *(word for part in parts[end:] for word in (*tokens("the"), *part.words)))
        end = len(parts)
    whole = replace(parts[at], words=words, grounded=True, kinds=frozenset({kind}))
    return [*parts[:at], whole, *parts[end:]]


_EXCEPTING = frozenset({"except", "but", "bar", "excluding", "apart", "besides"})
_ONLY_STATES = frozenset({("on",), ("off",)})
_EVERYTHING = frozenset({("everything",), ("everywhere",), ("all",)})


def _labelled(part: Part, names: Sequence[str], scene: Scene) -> Part:
    """With "201" as room 201, where an input takes a room."""
    label = part.words[0].key
    if len(part.words) != 1 or not (label.isdigit() or (len(label) == 1 and part.item is None)):
        return part
    if part.grounded and label.isdigit():
        return part
    found = (_called_by_label(label, name, scene) for name in names)
    item = next((one for one in found if one is not None), None)
    if item is None:
        return part
    return replace(part, words=tokens(item.description), item=item, grounded=True)


def _with_all_said(
    words: Phrase, taken: dict[str, Part], left: Sequence[Part], gone: set[int], filled: Filled
) -> list[Part]:
    """What is left once a text has all that follows its first words ("the gate is open" "at the back")."""
    rest = list(left)
    for name, part in taken.items():
        tail = [other for other in rest if other.start >= part.end]
        last = not any(p.start >= part.end for p in taken.values())
        if parameter_role(name) != "text" or part.role or not last:
            continue
        end = max(part.end, *(other.end for other in tail), 0)
        while end < len(words) and end not in gone and words[end].key not in _COURTEOUS:
            end += 1
        start = words.index(part.words[0], part.start)
        start -= start > 0 and start - 1 not in gone and words[start - 1].key in lexicon().determiners
        said = words[start:end]
        filled.values[name], filled.phrases[name] = plain(said), said
        rest = [other for other in rest if other not in tail]
    return rest


_COURTEOUS = frozenset({"please", "now", "again", "too"})


def _of_kind(part: Part, words: set[str], core: set[str]) -> bool:
    """Whether a part may be one of the things that an input is called by."""
    same = {other for word in words for other in lexicon().synonyms.get(word, ())} | words
    if same & (part.kinds | core) or (part.grounded and not part.kinds):
        return True
    return bool(words & _LAND and part.kinds & _LAND)


def kind_on_map(name: str, objects: Sequence[MapObject]) -> bool:
    """Whether an input is called by a kind of things that the map has: then it takes one of those."""
    return bool(kinds_on_map(name, objects))


_LAND = frozenset(load_data("names")["land"])
_SURE = 6.0
"""What it counts that a part is to the deed what an input takes."""
COLOURS = frozenset(load_data("names")["colours"])
_PRONOUNS = frozenset({("it",), ("there",), ("them",), ("that",)})
_POINTING = frozenset({"it", "that", "this", "there", "them", "here"})
_SOURCES = frozenset({"source", "origin", "start", "from"})
_GOALS = frozenset(
    {"destination", "goal", "target", "to", "end", "container", "vessel", "receptacle", "bowl", "pot", "pan"}
)
_WITH = frozenset({"with", "using"})
_MEANS = frozenset(load_data("names")["means"])
"""What something is done with is called so."""


def _placed(name: str, part: Part, scene: Scene, *, person: bool) -> float:
    """How well a part may be a place: by the map, but for names of what the map does not have at all."""
    if part.grounded or keys(part.words) in _PRONOUNS:
        return 0.0 if person else 2.0
    unknown = not scene.objects or part.words[0].is_capital
    if unknown and not kind_on_map(name, scene.objects):
        return 0.2 if person else 0.4
    return -3.0 if person else -1.0


def _fit(name: str, part: Part, number: int, scene: Scene) -> float:
    """How well a part of a clause fits an input."""
    role = parameter_role(name)
    words = {singular(word) for word in name_words(name)}
    core = {singular(word) for word in keys(part.words)}
    score = 3.0 if words & (core | part.kinds) and role != "text" else 0.0
    score += _SURE if role and role == part.role else 0.0
    if words & {"color", "colour"}:
        score += 3 if core & COLOURS else -1
    if words & _SOURCES:
        score += {"from": 3, "to": -4}.get(part.before, 0)
    elif part.before == "from":
        score -= 1 if part.grounded or role == "place" else 0.3
    if words & _GOALS:
        score += 1 if part.before in _OF_PLACE else -0.5
    if words & _MEANS:
        score += 1 if part.before in _WITH else -0.7
    if kind_on_map(name, scene.objects) and not _of_kind(part, words, core):
        there = role == "place" and part.grounded and part.before in _OF_PLACE
        called = all(word.is_capital for word in part.words) and not part.grounded
        score -= 0 if called or part.words[0].key in _POINTING else 1 if there else 3
    person = scene.is_person(part.words) and part.before != "from"
    match role:
        case "place":
            score += _placed(name, part, scene, person=person) + (1 if part.before in _OF_PLACE else 0)
        case "person":
            score += (3 if person else -1) + (1 if part.before in {"to", "for"} else 0)
        case "text":
            score += 3 if part.before in {"that", "saying", "about"} else 1
        case "object":
            score += (1.5 if part.before in {"", "of", "and", *_WITH} else 0.5) - (2 if person else 0)
        case _:
            score += (
                (1.0 if part.before in {"", "of", "and"} else 0.6) - 0.1 * number - (0.5 if person else 0)
            )
    return score
