"""What an action is good for by any word of its name, where the words it begins with do not tell.

"person_search", "BaseMove" and "tts" are names of actions, too. What their inputs are for must agree.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache

from parley.language.offline.words.text import lemma, split_name
from parley.language.word_lists import load_data

__all__ = ["kind_of", "name_words", "role_by_any_word"]

_SHORT: dict[str, list[str]] = {short: text.split() for short, text in load_data("names")["short"].items()}
_KINDS: dict[str, str] = {
    other: kind for kind, others in load_data("names")["types"].items() for other in (kind, *others)
}


@lru_cache(maxsize=4096)
def name_words(name: str) -> tuple[str, ...]:
    """The words of a name in any style, written out: "navGoal" is navigate, goal; "takeoff" take, off."""
    return tuple(word for part in split_name(name) for word in _SHORT.get(part, [part]) if not part.isdigit())


def kind_of(kind: str) -> str:
    """The native type that a type's name stands for ("float" is "number", "low|high" words), else itself."""
    if "|" in kind or kind.lower().startswith(("enum", "literal")):
        return "string"
    return _KINDS.get(kind.lower(), kind)


_ROLES = {
    role: (frozenset(entry["words"]), frozenset(entry["needs"]), frozenset(entry["without"]))
    for role, entry in load_data("names")["by_any_word"].items()
}


def role_by_any_word(name: str, inputs: Collection[str]) -> frozenset[str]:
    """What an action is good for; empty if its name tells nothing, or two things.

    Args:
        name: Of the action.
        inputs: What each of its inputs in words is for: place, person, text, object, or empty.
    """
    words = {word for part in name_words(name) for word in (part, lemma(part))}
    found = {
        role
        for role, (telling, needs, without) in _ROLES.items()
        if words & telling
        and not words & without
        and (needs & set(inputs) or (role == "answer" and not inputs))
    }
    if len(found) > 1:
        found -= {"motion"}
    return frozenset(found) if len(found) == 1 else frozenset()
