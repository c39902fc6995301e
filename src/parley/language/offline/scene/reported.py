"""Clauses that ask for something by telling of it: what somebody needs, and what has happened."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.scene.awaited import awaited
from parley.language.offline.scene.incidents import happened
from parley.language.offline.scene.needs import granted, needed
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import Clause, opens_command
from parley.language.offline.sentences.look_only import is_look
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys

__all__ = ["asked_by_need", "asked_by_report"]


def asked_by_need(clause: Clause, others: Sequence[Clause], scene: Scene) -> tuple[Phrase, str] | None:
    """The order that telling of somebody's need means, and what kind of telling it is; None if it only tells.

    Args:
        clause: What is told.
        others: The other clauses of the message: beside an order of its own a telling only explains.
        scene: What is known.
    """
    due = granted(clause.words, scene)
    if due is not None:
        return _once(due, scene)
    calls = None if clause.is_question or _ordered(others, scene) else awaited(clause.words, scene)
    if calls is not None:
        return calls, "somebody wants the robot with them"
    need = needed(clause.words, scene) if _only_tells(clause, others, scene) else None
    if need is not None and any(_names_more(other, need, scene) for other in others):
        return (), "somebody needs something, as is said more exactly"
    return None if need is None else _once(need, scene)


def _names_more(other: Clause, need: Phrase, scene: Scene) -> bool:
    """Whether another clause says more exactly what is needed ("A is cold, she would like her coat")."""
    if keys(other.words) == keys(need) or " ".join(_thing(need)) not in _GENERAL or other.is_question:
        return False
    more = needed(other.words, scene)
    return more is not None and " ".join(_thing(more)) not in _GENERAL


_GENERAL = frozenset(lexicon().need_words.values()) | frozenset(lexicon().need_phrases)


def _thing(order: Phrase) -> tuple[str, ...]:
    return keys(order)[1 : len(order) - 1 - keys(order)[::-1].index("to")]


def asked_by_report(clause: Clause, others: Sequence[Clause], scene: Scene) -> tuple[Phrase, str] | None:
    """The order that telling what has happened means; arguments as for `asked_by_need`."""
    if not _only_tells(clause, others, scene):
        return None
    report = happened(clause.words, scene, alone=not others)
    return None if report is None else (report, "something has happened")


def _only_tells(clause: Clause, others: Sequence[Clause], scene: Scene) -> bool:
    if clause.is_question or opens_command(clause.words, scene.catalogue.verbs):
        return False
    return not _ordered(others, scene)


def _ordered(others: Sequence[Clause], scene: Scene) -> bool:
    """Whether anything but a look is ordered in other clauses."""
    verbs = scene.catalogue.verbs
    return any(opens_command(other.words, verbs) and not is_look(other.words) for other in others)


def _once(order: Phrase, scene: Scene) -> tuple[Phrase, str]:
    """Said twice ("A is cold, she needs something warm"), done once."""
    who = keys(scene.referent(order[len(order) - keys(order)[::-1].index("to") :]))
    if who in scene.served:
        return (), "somebody needs something, as said before"
    scene.served.add(who)
    return order, "somebody needs something"
