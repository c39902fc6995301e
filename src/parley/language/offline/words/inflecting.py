"""Forms of regular verbs, for lists that give base forms only."""

from __future__ import annotations

from collections.abc import Iterable

__all__ = ["forms"]


def forms(verbs: Iterable[str]) -> frozenset[str]:
    """The third person, the form of what goes on and the past of each verb, by the rules of spelling."""
    result: set[str] = set()
    for verb in verbs:
        short = len(verb) < 5 and verb[-1] in "bdgmnpt" and verb[-2] in "aeiou"
        doubled = verb + verb[-1] if short else verb
        stem = verb if verb.endswith("ee") else verb.removesuffix("e")
        result |= {f"{doubled}ing", f"{stem}ing", f"{verb}s", f"{stem}ed", f"{doubled}ed"}
    return frozenset(result)
