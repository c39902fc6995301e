"""Values for the inputs of an action, found among what a command says."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.catalogue import parameter_role, templates, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.slots import kind_on_map
from parley.language.offline.words.durations import duration_s, without_duration
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import kind_of, name_words
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.messages.status import ActionInfo

__all__ = ["arguments"]


_OF_STATE = frozenset({"state", "mode", "setting", "status", "power", "switch", "on"})
_STATES = frozenset({"on", "off", "open", "closed", "up", "down", "locked", "unlocked"})
_OF_TIME = frozenset({"duration", "time", "seconds", "second", "s", "sec", "secs", "timeout", "delay"})


def arguments(info: ActionInfo, command: Command, scene: Scene) -> dict[str, Any]:
    """What the command says for the inputs of `info`; inputs that nothing is said for are left out."""
    spans = any(set(name_words(name)) & _OF_TIME for name in info.inputs)
    if spans:
        theme, place = without_duration(command.theme), without_duration(command.place)
        command = replace(command, theme=theme, place=place, clause=without_duration(command.clause))
    values: dict[str, Any] = {
        name: _named(words, scene)
        for name, words in _by_phrase(info, command).items()
        if name in text_inputs(info)
    }
    command = _states(info, command, values)
    _texts(info, command, scene, values)
    _numbers(info, command, scene, values)
    return values


def _states(info: ActionInfo, command: Command, values: dict[str, Any]) -> Command:
    """For "switch the light off": how it is to be afterwards; the rest of the command is returned."""
    said = [word.key for word in command.clause if word.key in _STATES]
    for name in text_inputs(info):
        if name not in values and set(name_words(name)) & _OF_STATE and said:
            values[name] = said[-1]
            command = _without_state(command, said[-1])
    return command


def _texts(info: ActionInfo, command: Command, scene: Scene, values: dict[str, Any]) -> None:
    """Words for the inputs that take words, by what the inputs are called."""
    by_role: dict[str, Phrase] = {
        "place": command.place,
        "person": command.recipient or (command.theme if scene.is_person(command.theme) else ()),
        "object": command.theme,
        "text": command.words,
    }
    left: list[str] = []
    used: list[Phrase] = [()]
    for name in [name for name in text_inputs(info) if name not in values]:
        words = by_role.get(parameter_role(name), ())
        if words and words not in used:
            values[name] = plain(bare(words)) if parameter_role(name) == "text" else _named(words, scene)
            used.append(words)
        else:
            left.append(name)
    parts = (command.theme, command.place, command.recipient, command.words)
    # "Measure the temperature": what the action is about anyway is no value for it.
    spare = [w for w in parts if w and w not in used and not _is_topic(w, info, scene)]
    if left and kind_on_map(left[0], scene.objects):
        spare = [w for w in spare if scene.ground(w).outcome != "none" or {w[0].key} & _POINTING]
    if not values and left and spare:
        values[left[0]] = _named(spare[0], scene)
        used.append(spare[0])
        left = left[1:]
    for name in left:
        # "Pour water into the cup": what no name tells is taken in the order in which it is said.
        unused = [w for w in (command.theme, command.place) if w and w not in used]
        if parameter_role(name) == "" and unused and values:
            values[name] = _named(unused[0], scene)
            used.append(unused[0])


_POINTING = frozenset({"it", "that", "this", "there", "them", "here"})


def _is_topic(words: Phrase, info: ActionInfo, scene: Scene) -> bool:
    topic = {singular(n) for n in name_words(info.name)}
    return scene.ground(words).outcome == "none" and {singular(k) for k in keys(bare(words))} <= topic


def _numbers(info: ActionInfo, command: Command, scene: Scene, values: dict[str, Any]) -> None:
    """Numbers for the inputs that take numbers: said now, or in answer to a question about it."""
    numbers = [quantity.value for quantity in quantities(command.words)]
    for hint in list(scene.hints) if not numbers else ():
        # "How many?" was asked about this before.
        said = [
            w.key for w in tokens(hint) if w.key in lexicon().numbers or re.fullmatch(r"\d+(?:\.\d+)?", w.key)
        ]
        if len(said) == 1:
            numbers.append(float(lexicon().numbers.get(said[0], said[0])))
            scene.hints.remove(hint)
            break
    for name, kind in info.inputs.items():
        if kind_of(kind) != "number" or "::" in name:
            continue
        span_s = duration_s(command.words) if set(name_words(name)) & _OF_TIME else None
        if span_s is not None:
            values[name] = span_s
        elif numbers:
            values[name] = numbers.pop(0)


def _without_state(command: Command, state: str) -> Command:
    def cut(phrase: Phrase) -> Phrase:
        return tuple(word for word in phrase if word.key != state)

    theme = cut(command.theme)
    noun = noun_phrase(theme)
    place = command.place or (noun.anchors[0] if len(noun.anchors) == 1 and noun.core else ())
    return replace(command, theme=theme, place=place, words=cut(command.words))


def _named(words: Phrase, scene: Scene) -> str:
    """The words for something: an object of the map by its description, pronouns resolved."""
    words = bare(scene.referent(words))
    if keys(words) == ("operator",):
        return "operator"
    found = ground_phrase(words, scene.objects, scene.situation.robot_pose)
    if found.outcome == "match":
        return describe(found.candidates[0], scene.objects)
    if found.outcome == "ambiguous":
        return describe(scene.pick(words, found.candidates), scene.objects)
    return plain(words)


def _by_phrase(info: ActionInfo, command: Command) -> dict[str, Phrase]:
    """Values where one of the action's own phrases fits the whole clause."""
    whole = [word for word in command.clause if word.is_word]
    return _fitted(info, whole) or _fitted(info, [word for word in bare(command.clause) if word.is_word])


def _fitted(info: ActionInfo, clause: list[Any]) -> dict[str, Phrase]:
    text = " ".join([lemma(clause[0].key), *(word.key for word in clause[1:])]) if clause else ""
    for phrase in (*info.phrases, *templates(info)):
        names = re.findall(r"\{(\w+)\}", phrase)
        pattern = re.sub(r"\\\{\w+\\\}", "(.+)", re.escape(phrase.lower()))
        match = re.fullmatch(pattern, text)
        if match and names and set(names) <= set(info.inputs):
            return {name: _original(value, clause) for name, value in zip(names, match.groups(), strict=True)}
    return {}


def _original(value: str, clause: list[Any]) -> Phrase:
    wanted = tuple(value.split())
    flat = tuple(word.key for word in clause)
    for index in range(len(flat) - len(wanted) + 1):
        if flat[index : index + len(wanted)] == wanted:
            return tuple(clause[index : index + len(wanted)])
    return tokens(value)
