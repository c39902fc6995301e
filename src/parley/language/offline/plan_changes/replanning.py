"""Changes of the order of what is pending: swapping, doing first, before or after something else, replacing.

A plan can only be shortened and continued at its end, so a new order is: what changes is taken out, from its
first step on, and put back in the new order.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.catalogue import text_inputs
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.messages.chat import ActionCall, SystemCommand

__all__ = [
    "Change", "Edit", "Visit", "left", "pops", "renamed", "same_steps", "visit_names", "visit_of", "visits",
    "without",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Edit:
    """What changes, and what is said about it."""

    commands: tuple[SystemCommand, ...]
    reply: str
    queue: tuple[ActionCall, ...] = ()
    """Pending steps that were taken out and are put back in another order."""


@dataclass(frozen=True, slots=True)
class Change:
    """What becomes of the plan."""

    edit: Edit | None = None
    order: Phrase = ()
    """A new order, to be done at `at`."""
    at: int = 0
    """The first pending step that comes after it."""


@dataclass(frozen=True, slots=True)
class Visit:
    """Consecutive pending steps that belong together: finding, going to and looking at one thing."""

    start: int
    steps: tuple[ActionCall, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The words its steps were given."""
        values = (p.value for step in self.steps for p in step.input_parameters.values())
        return tuple(value for value in values if isinstance(value, str) and value)


def visits(scene: Scene) -> list[Visit]:
    """The pending steps in groups."""
    groups: list[list[ActionCall]] = []
    starts: list[int] = []
    for index, step in enumerate(scene.situation.queue):
        info = scene.catalogue.get(step.name)
        roles = scene.catalogue.roles(info) if info is not None else frozenset()
        leads = "locate" in roles or ("motion" in roles and info is not None and bool(text_inputs(info)))
        if leads or not groups or (info is not None and _elsewhere(step, groups[-1], scene)):
            groups.append([])
            starts.append(index)
        groups[-1].append(step)
    return [Visit(start, tuple(group)) for start, group in zip(starts, groups, strict=True)]


def _elsewhere(step: ActionCall, group: Sequence[ActionCall], scene: Scene) -> bool:
    """Whether an action of a kind of its own is for another thing than the steps before it."""
    info = scene.catalogue.get(step.name)
    counts = info is not None and "count" in scene.catalogue.roles(info)
    if step.flow is not None or not (counts or info in scene.catalogue.of_own_kind):
        return False
    named, before = _texts([step]), _texts(group)
    there = _things(named, scene)
    if there:
        return not there & _things(before, scene)
    return scene.catalogue.get(group[0].name) in scene.catalogue.of_own_kind and not named & before


def _texts(steps: Iterable[ActionCall]) -> set[str]:
    values = (p.value for step in steps for p in step.input_parameters.values())
    return {value for value in values if isinstance(value, str) and value}


def _things(names: Iterable[str], scene: Scene) -> set[str]:
    """What is meant by names, by what the map calls it."""
    found = (scene.ground(tokens(name)) for name in names)
    return {one.candidates[0].id for one in found if one.outcome == "match"}


def visit_of(phrase: Phrase, scene: Scene) -> int | None:
    """The place among the visits of the one that a phrase names; None if none or several do."""
    listed = visits(scene)
    words = bare(_noun(phrase))
    if not words or not listed:
        return None
    flat = keys(words)
    if flat[-1] in {"one", "visit", "stop", "place"} and (flat[0] in lexicon().ordinals or flat[0] == "last"):
        index = len(listed) - 1 if flat[0] == "last" else lexicon().ordinals[flat[0]] - 1
        return index if index < len(listed) else None
    meant = scene.ground(words)
    item = meant.candidates[0] if meant.outcome == "match" else None
    wanted = {singular(word) for word in flat}
    hits = [
        index
        for index, visit in enumerate(listed)
        if any(
            wanted <= {singular(word.key) for word in tokens(name)}
            or (item is not None and name in {describe(item, scene.objects), item.id, item.description})
            for name in visit.names
        )
    ]
    return hits[0] if len(hits) == 1 else None


def _noun(phrase: Phrase) -> Phrase:
    """What is named, without the verb before it ("inspect the box", "going to the door")."""
    words = strip_openers(phrase, requests=True)
    flat = (lemma(words[0].key), *keys(words[1:])) if words else ()
    found = lexicon().verbs.match(flat) or ((1, "do") if flat[:1] in {("do",), ("doing",)} else None)
    rest = words[found[0] :] if found is not None and found[0] < len(words) else words
    goal = lexicon().goals.match(keys(rest))
    return rest[goal[0] :] if goal is not None and goal[0] < len(rest) else rest


def renamed(step: ActionCall, old: Phrase, new: str, scene: Scene) -> ActionCall:
    """The same step for something else."""
    inputs = dict(step.input_parameters)
    for name, parameter in inputs.items():
        if isinstance(parameter.value, str) and parameter.value:
            said, wanted = plain(bare(old)).lower(), parameter.value.lower()
            found = scene.ground(tokens(parameter.value))
            same = found.outcome == "match" and scene.ground(old).candidates == found.candidates
            value = new if same or said == wanted else parameter.value.replace(plain(bare(old)), new)
            inputs[name] = replace(parameter, value=value)
    return step.model_copy(update={"input_parameters": inputs, "reason": ""})


def same_steps(named: Phrase, scene: Scene, at: int) -> tuple[str, tuple[ActionCall, ...]] | None:
    """What a thing is called, and the steps that do there what is done at the stop from a place on.

    Args:
        named: Words for a thing on the map.
        scene: What is known, with its pending steps.
        at: The pending step from which on a stop is looked for; the last one counts if there is none.
    """
    found = scene.ground(named)
    listed = [visit for visit in visits(scene) if visit.names and len(visit.steps) > 1]
    model = next((visit for visit in listed if visit.start >= at), listed[-1] if listed else None)
    if found.outcome != "match" or model is None or any(step.flow is not None for step in model.steps):
        return None
    name, old = describe(found.candidates[0], scene.objects), tokens(model.names[0])
    return name, tuple(renamed(step, old, name, scene) for step in model.steps)


def visit_names(indices: Iterable[int], scene: Scene) -> str:
    """What the visits at these places are called, as a list in words."""
    listed = visits(scene)
    return listing([the(listed[i].names[0]) if listed[i].names else "this step" for i in indices])


def left(order: Sequence[int], scene: Scene, text: str = "") -> Edit:
    """The visits at these places of the plan in this order, and no others; what stays in front is left alone.

    Args:
        order: Places among the visits.
        scene: What is known, with its pending steps.
        text: What is said of it; the order if empty.
    """
    listed, kept = visits(scene), list(order)
    text = text or f"All right, in this order: {visit_names(kept, scene)}."
    if kept == sorted(kept):
        gone = [visit for i, visit in enumerate(listed) if i not in kept]
        return Edit(pops(visit.start + n for visit in gone for n in range(len(visit.steps))), text)
    same = next(i for i, index in enumerate([*kept, -1]) if index != i)
    again = tuple(step for index in kept[same:] for step in listed[index].steps)
    if any(step.flow is not None for step in again):
        text = "Some of these steps depend on others, so I leave the order as it is. Cancel and tell me anew?"
        return Edit((), text)
    return Edit(pops(range(listed[same].start, len(scene.situation.queue))), text, again)


def pops(indices: Iterable[int]) -> tuple[SystemCommand, ...]:
    """The commands that take out pending steps, the last one first so that places keep their meaning."""
    return tuple(
        SystemCommand(command="pop", arguments={"parameters": index})
        for index in sorted(indices, reverse=True)
    )


def without(at: int, scene: Scene) -> Edit:
    """Leave a whole visit out."""
    kept = [i for i in range(len(visits(scene))) if i != at]
    return left(kept, scene, f"I leave out {visit_names([at], scene)}.")
