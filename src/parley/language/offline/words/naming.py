"""What an action is good for by any word of its name, where the words it begins with do not tell.

"person_search", "BaseMove" and "tts" are names of actions, too. What their inputs are for must agree.
"""

from __future__ import annotations

from collections.abc import Collection

from parley.language.offline.words.text import lemma, split_name
from parley.language.word_lists import load_data

__all__ = ["role_by_any_word"]

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
    words = {word for part in split_name(name) for word in (part, lemma(part))}
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
