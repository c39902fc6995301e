"""Cases of the sets with one kind of thing in their world called by another word."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

from parley.evaluation.cases import Case, CaseBody
from parley.evaluation.sets import own_set
from parley.language.base import Situation

__all__ = ["kinds_of", "plain_cases", "renamed"]

_STEPS = frozenset({"do", "do_any", "final", "final_any", "queue", "pending"})
_KEPT = frozenset({"in", "targets", "robot", "commands", "forget", "may_forget", "uses"})
_BEHIND = re.compile(r"\b(?:by|near|next|for|with|of|in|at|on|behind|under)\b.*")
_SAYING = re.compile(r"((?:(?:if|unless|with|times) \d+: )?(?:look|say|ask)~? )(.*)$")
_ABOUT = re.compile(r"(.*?\()(.*)\)$")


def plain_cases(names: Sequence[str]) -> Iterator[Case]:
    """The cases of some sets that are messages to a robot."""
    for name in names:
        yield from (
            case for case in own_set(name).cases if not case.blind and isinstance(case.situation, Situation)
        )


def kinds_of(case: Case) -> list[str]:
    """The nouns of things on the map that a case's message names, unless the catalogue knows them too."""
    known = " ".join(f"{info.name} {info.description}" for info in case.world.actions).lower()
    said = set(_words(case.body.say))
    heads = {
        _words(_BEHIND.sub("", f" {item[1]}".lower()))[-1]
        for item in case.world.objects
        if _words(_BEHIND.sub("", f" {item[1]}".lower()))
    }
    return sorted(
        head for head in heads if len(head) > 2 and head not in known and said & {head, _plural(head)}
    )


def renamed(case: Case, kind: str, name: str) -> Case | None:
    """The same case where what is called `kind` is called `name`; None if that would not be told apart."""
    everything = " ".join(
        str(part)
        for part in (
            case.body.say, *case.body.history, *(item[1] for item in case.world.objects),
            *(text for _, text in case.world.memory), *(info.name for info in case.world.actions),
            *(info.description for info in case.world.actions),
        )
    )  # fmt: skip
    taken = {form for word in _words(everything.replace("_", " ")) for form in (word, word.rstrip("s"))}
    if set(_words(name)) & taken:
        return None
    ids = {str(item[0]).lower(): f"t{index}q" for index, item in enumerate(case.world.objects)}
    by_id = re.compile(
        r"(?<!\w)(" + "|".join(map(re.escape, sorted(ids, key=len, reverse=True))) + r")(?!\w)", re.I
    )

    def named(text: str) -> str:
        return by_id.sub(lambda found: ids[found[0].lower()], text)

    def step(text: str) -> str:
        saying = _SAYING.match(text)
        if saying is not None:
            return saying[1] + _put(saying[2], kind, name)
        about = _ABOUT.match(text)
        return about[1] + _put(named(about[2]), kind, name) + ")" if about is not None else named(text)

    def walk(key: str, value: Any) -> Any:
        if isinstance(value, str):
            if key in _STEPS:
                return step(value)
            return named(value) if key == "choices" else _put(value, kind, name)
        if isinstance(value, list):
            return [walk(key, part) for part in value]
        if isinstance(value, dict):
            return {k: part if k in _KEPT else walk(k, part) for k, part in value.items()}
        return value

    objects = [
        [ids[str(item[0]).lower()], _put(str(item[1]), kind, name), *item[2:4]]
        + ([_put(str(item[4]), kind, name.split()[-1]), *item[5:]] if len(item) > 4 else [])
        for item in case.world.objects
    ]
    memory = [(title, _put(text, kind, name)) for title, text in case.world.memory]
    body = CaseBody(**walk("", case.body.model_dump(exclude_unset=True, by_alias=True)))
    world = case.world.model_copy(update={"objects": objects, "memory": memory})
    return Case(case.phenomenon, body, world, case.part)


def _words(text: str) -> list[str]:
    return re.findall(r"[a-z]{2,}", text.lower())


def _plural(noun: str) -> str:
    if re.search(r"(?:s|x|ch|sh)$", noun):
        return f"{noun}es"
    return f"{noun[:-1]}ies" if re.search(r"[^aeiou]y$", noun) else f"{noun}s"


def _put(text: str, kind: str, name: str) -> str:
    """A text with another noun, in the same number and case."""

    def other(found: re.Match[str]) -> str:
        form = _plural(name) if found[0].lower() == _plural(kind) else name
        return form[0].upper() + form[1:] if found[0][0].isupper() else form

    return re.sub(rf"\b(?:{_plural(kind)}|{kind})\b", other, text, flags=re.I)
