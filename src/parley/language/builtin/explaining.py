"""How an answer came about, step by step: clauses, what they want, what is left over, and the decision."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from parley.language.builtin.decision import Ask, Decision, Deed, Do
from parley.language.builtin.structure import Part
from parley.language.builtin.wishes import Wish

__all__ = ["explained"]


def explained(parts: Sequence[Part], decision: Decision) -> list[dict[str, str]]:
    """What was found in each clause of a message, and what was decided."""
    told = [*(pair for part in parts for pair in _of_part(part)), _of_decision(decision)]
    return [{"about": about, "text": text} for about, text in told]


def _of_part(part: Part) -> Iterator[tuple[str, str]]:
    yield "clause", f"“{part.text}” ({part.clause.link})"
    for wish in part.reading.wishes:
        yield "frame", _of_wish(wish)
    if part.reading.left_over:
        yield "left over", ", ".join(part.reading.left_over)
    if part.reading.unsteady:
        yield "doubtful", ", ".join(part.reading.unsteady)


def _of_wish(wish: Wish) -> str:
    roles = ", ".join(f"{filler.role} “{filler.text}”" for filler in wish.fillers)
    verb, no = (f"“{wish.verb}” is " if wish.verb else ""), ("not " if wish.negated else "")
    witness = {"agrees": "the lexicon agrees", "differs": "the lexicon differs"}.get(wish.witness, "")
    sure = f"{wish.act}, {wish.share:.2f} sure{f', {witness}' if witness else ''}"
    return f"{verb}{no}{wish.frame}{f' with {roles}' if roles else ''} ({sure})"


def _of_decision(decision: Decision) -> tuple[str, str]:
    kind = type(decision).__name__.lower()
    match decision:
        case Do(deeds):
            return kind, ", ".join(map(_of_deed, deeds))
        case Ask(question):
            offer = ", ".join(map(_of_deed, decision.offer))
            return kind, f"{question}{f' (offered: {offer})' if offer else ''}"
    return kind, ""


def _of_deed(deed: Deed) -> str:
    given = ", ".join(f"{name}: {value}" for name, value in deed.arguments.items())
    return f"{deed.skill.action.name}({given})"
