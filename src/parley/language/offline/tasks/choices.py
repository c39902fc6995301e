"""Inputs that take one of a few values: what a description or a type lists, and what is so or not."""

from __future__ import annotations

import re
from collections.abc import Iterator

from parley.language.offline.tasks.roles import parameter_role, text_inputs
from parley.language.offline.words.concepts import Concept, concepts, likeness, opposed, reversed_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import kind_of, name_words
from parley.language.offline.words.text import Phrase, keys, lemma, singular
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["choices_of", "chosen", "is_listed", "says_choice", "states_verb", "switched", "told_state"]

_LANGUAGES = frozenset(load_data("names")["languages"])
_IN_PROSE = re.compile(r"(?:\w+(?:, |\s*\|\s*|/)){1,9}\w+(?:,? or \w+)?|\w+ or \w+")
_ENUMERATED = re.compile(
    r"\((\w+(?:,\s*\w+)+)\)|one of:?\s*(\w+(?:,\s*\w+)+)|\w:\s*(\w+(?:,\s*\w+)+(?:,? (?:and|or) \w+)?)"
)
_FEW = 2


def _listings(text: str) -> Iterator[tuple[int, dict[str, str]]]:
    """The values that a text lists, each list with where it stands, by their lower case words."""
    for found in _IN_PROSE.finditer(text):
        values = [value for value in re.split(r"\s*(?:,|\||/|\bor\b)\s*", found[0]) if value]
        if len(values) > 1 and ("or" in found[0].split() or "|" in found[0] or "/" in found[0]):
            yield found.start(), {_said(value): value for value in values if not value.isdigit()}
    for found in _ENUMERATED.finditer(text):
        listed = re.split(r"\s*,\s*|\s+(?:and|or)\s+", found[1] or found[2] or found[3])
        yield found.start(), {_said(value): value for value in listed}


def _said(value: str) -> str:
    """A value as people say it: "deep_clean" is "deep clean"."""
    return value.replace("_", " ").strip().lower()


def choices_of(info: ActionInfo) -> dict[str, dict[str, str]]:
    """For each input in words that takes one of a few values: these, by what is said for them."""
    texts = [
        name
        for name in text_inputs(info)
        if parameter_role(name) not in {"person", "place"} or f"{name.lower()}:" in info.description.lower()
    ]
    found: dict[str, dict[str, str]] = {}
    for name in texts:
        kind = info.inputs[name]
        listed = {_said(v): v for v in re.findall(r"\w+", kind)[kind[:4].lower() == "enum" :]}
        if len(listed) > 1:
            found[name] = listed
    inputs = {name.lower() for name in info.inputs}
    for at, values in _listings(info.description):
        if values.keys() & inputs:
            # "Inputs: wall, colour".
            continue
        same = next((name for name in found if found[name].keys() & values.keys()), "")
        behind = set(re.findall(r"\w+", info.description[at:].lower())) - values.keys()
        # "Raise or lower a blind": what an input is called by is what that is done to, and takes neither.
        acted_on = {name for name in texts if not at and _is_deed(values) and set(name_words(name)) <= behind}
        free = (name for name in texts if name not in found and name not in acted_on)
        name = same or _told_before(info.description[:at].lower(), texts) or next(free, "")
        if name:
            found[name] = found.get(name, {}) | values
    for name in texts:
        if {"language", "lang"} & set(name_words(name)):
            found[name] = {word: word.capitalize() for word in _LANGUAGES} | found.get(name, {})
    return found


def _told_before(text: str, names: list[str]) -> str:
    """The input that was named last before a list."""
    at = {
        name: max(text.rfind(word) for word in (name.lower(), *name_words(name)) if len(word) > 1)
        for name in names
        if any(len(word) > 1 for word in (name, *name_words(name)))
    }
    best = max(at, key=lambda name: at[name], default="")
    return best if best and at[best] >= 0 else ""


def says_choice(info: ActionInfo, words: Phrase) -> bool:
    """Whether one of the values that an action chooses among is said."""
    return any(
        _value(values, keys(words), i) for values in choices_of(info).values() for i in range(len(words))
    )


def is_listed(name: str, info: ActionInfo) -> bool:
    """Whether an input takes nothing but the values that are listed for it."""
    values = choices_of(info).get(name, {})
    if "|" in info.inputs[name] or info.inputs[name][:4].lower() == "enum":
        return True
    told = re.search(rf"\b{re.escape(name)}(?:\b is |s?: )", info.description, re.IGNORECASE)
    alone = len(text_inputs(info)) == 1
    closed = len(values) > _FEW and alone and parameter_role(name) in {"", "object"}
    return closed or (told is not None and not alone and bool(values))


def chosen(info: ActionInfo, words: Phrase) -> dict[str, tuple[str, range]]:
    """The values that are said for inputs that choose among some, and where."""
    flat = keys(words)
    found: dict[str, tuple[str, range]] = {}
    for name, values in choices_of(info).items():
        none = next((values[said] for said in ("none", "no", "off") if said in values), "")
        denied = next(
            (
                i
                for i, w in enumerate(flat[:-1])
                if w in {"no", "without"} and flat[i + 1] in name_words(name)
            ),
            -1,
        )
        if none and denied >= 0:
            # "No spin" where the spin may be none.
            found[name] = none, range(denied, denied + 2)
            continue
        for index in range(len(flat)):
            value = _value(values, flat, index)
            taken = any(index in at for _, at in found.values())
            verb = index == 0 and len(flat) > 1 and lexicon().verbs.match((lemma(flat[0]),)) is not None
            if value is None or taken or (verb and not (_is_deed(values) or _is_about(info, flat[1:]))):
                continue
            found[name] = value[0], range(index, index + value[1])
            break
        meant = _BY_VERB.get(lemma(flat[0]), ()) if flat and name not in found else ()
        value_of_verb = next((values[one] for one in meant if one in values), None)
        if value_of_verb is not None:
            # "Lower the lamp" where it goes up or down.
            found[name] = value_of_verb, range(1)
    return found


_BY_VERB = {verb: tuple(said) for verb, said in load_data("deeds")["states"].items()}


def _is_about(info: ActionInfo, flat: tuple[str, ...]) -> bool:
    """Whether what an action is called by is named: "dim the lights" for "lights_level"."""
    return bool({singular(word) for word in name_words(info.name)} & {singular(word) for word in flat})


def _is_deed(values: dict[str, str]) -> bool:
    """Whether values are deeds themselves ("open or close")."""
    return all(lexicon().verbs.match((value,)) is not None for value in values)


def _value(values: dict[str, str], flat: tuple[str, ...], index: int) -> tuple[str, int] | None:
    """The value that is said at a word, and in how many words."""
    for said, value in values.items():
        several = tuple(said.split())
        if len(several) > 1 and flat[index : index + len(several)] == several:
            return value, len(several)
    word = flat[index]
    if word == "out" and {"on", "off"} <= values.keys() and index + 1 == len(flat):
        # "Lights out".
        return values["off"], 1
    graded = [
        word[:-cut] for end, cut in (("est", 2), ("est", 3), ("er", 1), ("er", 2)) if word.endswith(end)
    ]
    for form in (word, word.removesuffix("ly"), lemma(word), *graded, *lexicon().synonyms.get(word, ())):
        if form in values:
            return values[form], 1
    return _on_scale(values, flat, index)


def _on_scale(values: dict[str, str], flat: tuple[str, ...], index: int) -> tuple[str, int] | None:
    """For "at full power", where low, medium and high are offered: the one that says as much."""
    listed = next((words for words in _SCALE.values() if flat[index] in words), None)
    if listed is None:
        return None
    same = [value for said, value in values.items() if said in listed]
    behind, before = flat[index + 1 : index + 2], flat[index - 1 : index]
    measured = not behind or bool(set(behind) & _MEASURES)
    return (same[0], 1) if len(same) == 1 and len(values) > 1 and measured and before else None


_SCALE = {name: frozenset(words) for name, words in load_data("quantities")["scale"].items()}
_MEASURES = frozenset(load_data("quantities")["measures"])


_TRUE = frozenset({"on", "true", "yes", "with", "enabled"})
_FALSE = frozenset({"off", "false", "no", "without", "disabled"})
_GENERAL = frozenset({
    "on", "enabled", "enable", "running", "active", "activated", "power", "state", "status", "switch",
    "switched", "working", "run", "started", "mode",
})  # fmt: skip
"""Names of inputs that say only that something is on."""
_DENYING = frozenset({"not", "no", "without", "never", "un"})
_STARTING = concepts(("turn", "on"))[0], concepts(("start",))[0]
_STOPPING = concepts(("turn", "off"))[0], concepts(("stop",))[0]
_GOING_OVER = frozenset(
    (verb, way) for verb in ("switch", "go", "change", "turn") for way in ("to", "into", "over", "in")
)
"""How a state begins that is so or not ("switch to quiet mode")."""
_ON_OFF = frozenset({"on", "off", "open", "closed"})


def switched(info: ActionInfo, name: str, words: Phrase) -> tuple[bool | str, set[int]] | None:
    """What is said for an input that is so or not ("closed", "on"), and where; None if nothing."""
    kind, flat = kind_of(info.inputs[name]), keys(words)
    named = name_words(name)
    if kind == "string":
        at = next((i for i, word in enumerate(flat) if word in _ON_OFF), None)
        return (flat[at], {at}) if at is not None and set(named) & _GENERAL else None
    if kind != "bool":
        return None
    said, telling = concepts(flat), _telling(name)
    turned = next((where for part in telling if (where := reversed_at(part, said))), ())
    if turned:
        return False, set(turned)
    if (whole := _named(telling, said, flat)) is not None:
        return whole
    if any(opposed(part, said) for part in telling):
        return False, _where_opposed(telling, said)
    for words_for, value in ((_STARTING, True), (_STOPPING, False)):
        for one in said:
            like = any(likeness(one, word) >= _LIKE for word in words_for)
            if like and (set(named) & _GENERAL or not telling):
                return value, set(one.at)
    if set(named) & _GENERAL and flat[:2] in _GOING_OVER:
        return True, set()
    return _said_outright(flat, telling)


def _said_outright(flat: tuple[str, ...], telling: list[Concept]) -> tuple[bool, set[int]] | None:
    """Whether "on" or "off" and the like is said."""
    for index, word in enumerate(flat):
        if word == "out" and index + 1 == len(flat) and not telling:
            return False, {index}
        if word in _TRUE - {"with"} | _FALSE - {"without"} or (
            index and word in {"with", "without"} and telling
        ):
            return word in _TRUE, {index}
    return None


def _telling(name: str) -> list[Concept]:
    """The words of an input's name that say what is so or not."""
    return [Concept(lemma(w), concepts((w,))[-1].lines) for w in name_words(name) if w not in _GENERAL]


def _named(
    telling: list[Concept], said: tuple[Concept, ...], flat: tuple[str, ...]
) -> tuple[bool, set[int]] | None:
    """Whether all that an input's name says is said, so or denied, and where."""
    if not telling or not all(any(_same(part, one) for one in said) for part in telling):
        return None
    at_all = {i for part in telling for one in said if _same(part, one) for i in one.at}
    first = min(at_all)
    return not bool(_DENYING & set(flat[max(0, first - 2) : first])), at_all


def told_state(info: ActionInfo, name: str, message: Phrase) -> bool | None:
    """What a whole message tells of an input that is so or not, by its name; None if nothing."""
    if kind_of(info.inputs[name]) != "bool":
        return None
    found = _named(_telling(name), concepts(keys(message)), keys(message))
    return None if found is None else found[0]


def _same(part: Concept, said: Concept) -> bool:
    return likeness(part, said) >= _LIKE or lemma(said.text) == part.text


_LIKE = 0.8


def _where_opposed(telling: list[Concept], said: tuple[Concept, ...]) -> set[int]:
    return {i for one in said for part in telling if opposed(part, (one,)) for i in one.at}


def states_verb(info: ActionInfo, words: Phrase) -> bool:
    """Whether a clause begins with what an input can be: "open" for "closed", or a listed deed."""
    if any(0 in at for _, at in chosen(info, words).values()):
        return True
    bools = (name for name, kind in info.inputs.items() if kind_of(kind) == "bool")
    return any((found := switched(info, name, words)) is not None and 0 in found[1] for name in bools)
