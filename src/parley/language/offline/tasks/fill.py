"""Values for the inputs of an action, found among what a command says."""

from __future__ import annotations

import re
from typing import Any

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.catalogue import parameter_role, templates, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.parts import Part
from parley.language.offline.tasks.recalled import recall_inputs
from parley.language.offline.tasks.roles import number_inputs
from parley.language.offline.tasks.slots import fill_parts
from parley.language.offline.words.durations import without_duration
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.quantities import quantities, taken_by
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.messages.status import ActionInfo

__all__ = ["arguments", "by_phrase", "named"]


def arguments(info: ActionInfo, command: Command, scene: Scene) -> dict[str, Any]:
    """What the command says for the inputs of `info`; inputs that nothing is said for are left out."""
    values: dict[str, Any] = {
        name: named(words, scene)
        for name, words in by_phrase(info, command).items()
        if name in text_inputs(info)
    }
    filled = fill_parts(info, command.clause, _parts(info, command, scene), scene, known=values)
    recall_inputs(info, filled, command.clause, scene)
    for fact in filled.recalled:
        scene.use(fact)
    for name, value in filled.values.items():
        words = filled.phrases.get(name, ())
        listed = not words or value != plain(words)
        values[name] = value if listed or parameter_role(name) == "text" else named(words, scene)
    _said_before(info, scene, values)
    return values


def _parts(info: ActionInfo, command: Command, scene: Scene) -> list[Part]:
    """What a command names, each with what it is to the deed."""
    whom = command.recipient or (command.theme if scene.is_person(command.theme) else ())
    takes = {parameter_role(name) for name in text_inputs(info)}
    place = command.place
    if not place and "place" in takes and not takes & {"person", ""} and scene.is_person(whom):
        # "Bring A towels", where what is asked for is a room: the one where A is.
        known = find_fact(bare(whom), scene.facts)[0]
        place = known.fact.place if known is not None else ()
    roles = (
        ("place", "to", place),
        ("person", "for", whom),
        ("object", "", command.theme),
        ("text", "that", command.words if "text" in takes else ()),
    )
    parts: list[Part] = []
    for role, before, words in roles:
        spare = role not in takes and _is_topic(words, info, scene)
        if words and not spare and all(words != part.words for part in parts):
            grounded = scene.ground(words).outcome != "none"
            parts.append(Part(before, words, grounded=grounded, role=role))
    return parts


def _is_topic(words: Phrase, info: ActionInfo, scene: Scene) -> bool:
    """For "measure the temperature": what the action is about anyway is no value for it."""
    topic = {singular(n) for n in name_words(info.name)}
    return scene.ground(words).outcome == "none" and {singular(k) for k in keys(bare(words))} <= topic


def _said_before(info: ActionInfo, scene: Scene, values: dict[str, Any]) -> None:
    """A number said in answer to a question about it ("how many?")."""
    unsaid = next((name for name in number_inputs(info) if name not in values and "::" not in name), "")
    for hint in list(scene.hints) if unsaid else ():
        said = quantities(tokens(hint))
        if len(said) == 1:
            values[unsaid] = taken_by(unsaid, info.description).value_of(said[0])
            scene.hints.remove(hint)
            break


def named(words: Phrase, scene: Scene, *, strict: bool = False) -> str:
    """The words for something: an object of the map by its description, pronouns resolved."""
    words = bare(scene.referent(words))
    if keys(words) == ("operator",):
        return "operator"
    told = scene.told_apart(words) if len(words) > 1 else None
    if told is not None:
        return describe(told, scene.objects)
    found = ground_phrase(words, scene.objects, scene.situation.robot_pose, strict=strict)
    if found.outcome == "match":
        return describe(found.candidates[0], scene.objects)
    if found.outcome == "ambiguous":
        return describe(scene.pick(words, found.candidates), scene.objects)
    return plain(words)


def by_phrase(info: ActionInfo, command: Command) -> dict[str, Phrase]:
    """Values where one of the action's own phrases fits the whole clause; empty otherwise."""
    clause = without_duration(command.clause) if number_inputs(info) else command.clause
    whole = [word for word in clause if word.is_word]
    return _fitted(info, whole) or _fitted(info, [word for word in bare(clause) if word.is_word])


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
