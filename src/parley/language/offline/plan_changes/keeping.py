"""Keeping only a part of the plan: "drop everything but A", "only do A", "cancel the rest", "start over"."""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.plan_changes.edits import Edit, drop_verb
from parley.language.offline.plan_changes.replanning import visit_of, visits
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, keys, plain
from parley.messages.chat import SystemCommand

__all__ = ["kept_part", "restarts"]

_REST = frozenset(
    tuple(text.split())
    for text in (
        "the rest", "rest", "the rest of it", "the rest of the plan", "everything else", "all the rest",
        "what is left", "the remaining steps", "the others", "all the others",
    )
)  # fmt: skip
_BUT = (("except", "for"), ("except",), ("but",), ("apart", "from"), ("other", "than"), ("besides",))
_ALL = frozenset({("everything",), ("all",), ("all", "steps"), ("all", "of", "it"), ("every", "step")})
_ONLY = tuple(
    tuple(text.split())
    for text in (
        "only do", "just do", "only visit", "keep only", "only keep", "leave only", "just keep",
        "only inspect", "do only", "do just", "visit only", "keep just",
    )
)  # fmt: skip
_RESTARTS = frozenset(
    tuple(text.split())
    for text in (
        "start over", "start again", "restart", "start from the beginning", "start from scratch",
        "start over again", "start again from the beginning", "start over from the beginning",
        "begin again", "begin from the beginning", "from the top", "restart the plan",
        "start the plan over", "start the plan again", "start the whole thing over", "redo everything",
        "back to the start", "start all over", "start all over again", "let us start over",
        "start again from scratch", "start from the top", "restart everything", "redo the plan",
        "restart the mission", "go back to the start", "go back to the start of the list",
        "back to square one", "go back to the beginning", "back to the beginning",
        "go back to the start of the plan", "do it all again", "do everything again",
        "do the whole thing again", "begin anew", "start afresh", "start anew",
        "again from the beginning", "once more from the beginning", "again from the top",
        "from the beginning", "from the beginning again", "do the whole round again",
        "start the round again",
    )
)  # fmt: skip


def kept_part(words: Phrase, scene: Scene) -> Edit | None:
    """What is taken out of the plan when only a part is to be kept; None if nothing of the kind is said."""
    if not scene.situation.queue:
        return None
    words = tuple(word for word in strip_openers(words, requests=True) if word.is_word or word.key == ",")
    named = _named(words)
    if named is None:
        return None
    listed = visits(scene)
    kept = (
        {0}
        if not named
        else {index for index in (visit_of(p, scene) for p in coordinated(named)) if index is not None}
    )
    if not kept or (named and len(kept) < len(coordinated(named))):
        return None
    gone = [
        visit.start + i for n, visit in enumerate(listed) if n not in kept for i in range(len(visit.steps))
    ]
    pops = tuple(
        SystemCommand(command="pop", arguments={"parameters": i}) for i in sorted(gone, reverse=True)
    )
    names = [
        the(listed[index].names[0]) if listed[index].names else "the current step" for index in sorted(kept)
    ]
    return Edit(pops, f"I keep only {listing(names)}.")


def _named(words: Phrase) -> Phrase | None:
    """The words for what is kept; empty for the current step; None if nothing is said about keeping."""
    flat = keys(words)
    size = drop_verb(words)
    if size and flat[size:] in _REST:
        return ()
    for but in _BUT if size else ():
        at = next((i for i in range(size + 1, len(flat) - 1) if flat[i : i + len(but)] == but), 0)
        if at and flat[size:at] in _ALL:
            return bare(words[at + len(but) :])
    only = next((lead for lead in _ONLY if flat[: len(lead)] == lead and len(flat) > len(lead)), None)
    if only is not None:
        return bare(words[len(only) :])
    if flat[:1] == ("keep",) and "," in flat:
        cut = flat.index(",")
        rest = words[cut + 1 :]
        dropped = drop_verb(rest)
        return bare(words[1:cut]) if dropped and keys(rest[dropped:]) in _REST else None
    return None


def restarts(words: Phrase) -> bool:
    """Whether the plan is to be begun once more from its start."""
    return (
        keys(word for word in strip_openers(words) if word.is_word) in _RESTARTS or plain(words) == "restart"
    )
