"""What stands for a thing of the map that an action takes: what is remembered to be there, and "it"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.language.offline.facts.remembering import Remembered, find_fact
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.parts import Part
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.text import Phrase, keys, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["kinds_on_map", "with_stand_ins"]

_PRONOUNS = frozenset({("it",), ("that",), ("them",)})


def with_stand_ins(part: Part, names: Sequence[str], recalled: list[Remembered], scene: Scene) -> Part:
    """For "turn the red wine", where the only input takes a barrel: the one that it is remembered in.

    Args:
        part: What is said.
        names: The inputs that are still open.
        recalled: Gets the fact that is used.
        scene: What is known.
    """
    if part.grounded or part.role or len(names) != 1:
        return part
    kinds = set(kinds_on_map(names[0], scene.objects))
    if keys(part.words) in _PRONOUNS:
        return _last_of_kind(part, kinds, scene)
    fact = find_fact(_without_owning(part.words), scene.facts)[0] if kinds else None
    there = scene.ground(fact.fact.place) if fact is not None else None
    if fact is None or there is None or there.outcome != "match":
        return part
    item = there.candidates[0]
    called = frozenset(singular(word) for word in name_words(item.class_name))
    if not called & kinds:
        return part
    recalled.append(fact)
    return replace(part, words=tokens(describe(item, scene.objects)), item=item, grounded=True, kinds=called)


def _last_of_kind(part: Part, kinds: set[str], scene: Scene) -> Part:
    """For "it" that is to be closed behind "open the A valve, rinse tank B": the valve, not the tank."""
    things = scene.things[::-1] if kinds else []
    for number, thing in enumerate(things):
        found = scene.ground(thing)
        item = found.candidates[0] if found.outcome == "match" else None
        called = {singular(word) for word in name_words(item.class_name)} if item is not None else set()
        if item is not None and called & kinds:
            named = replace(part, words=tokens(describe(item, scene.objects)), item=item, grounded=True)
            return replace(named, kinds=frozenset(called)) if number else part
    return part


def _without_owning(phrase: Phrase) -> Phrase:
    """For "the family's" "the family"."""
    last = phrase[-1]
    owner = last.key.removesuffix("'s")
    return (
        phrase if owner == last.key else (*phrase[:-1], replace(last, key=owner, raw=last.raw[: len(owner)]))
    )


def kinds_on_map(name: str, objects: Sequence[MapObject]) -> list[str]:
    """The kinds of things on the map that an input is called by.

    Args:
        name: The input.
        objects: The map.
    """
    words = {singular(word) for word in name_words(name)}
    kinds = {singular(word) for item in objects for word in name_words(item.class_name)}
    return sorted(words & kinds)
