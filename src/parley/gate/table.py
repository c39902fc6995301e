"""The table of who may do what. Pure; printed in docs/safety.md, tested cell by cell."""

from __future__ import annotations

from enum import StrEnum
from typing import Final, Literal

from parley.messages.principal import Principal

__all__ = ["COLUMNS", "TABLE", "Column", "Effect", "Verdict", "column_of", "verdict"]


class Effect(StrEnum):
    """Everything that passes the gate."""

    SEE = "see"
    """Look at robots, plans, maps, the conversation, memories."""
    SPEAK = "speak"
    """Say something to a robot."""
    STOP = "stop"
    """Emergency stop."""
    PAUSE = "pause"
    """Hold a robot; its plan is kept."""
    RESET = "reset"
    """Release an emergency stop; moves nothing."""
    RESUME = "resume"
    """Let a held robot go on, or try again what failed."""
    BEGIN = "begin"
    """Let a robot begin with new steps."""
    APPROVE = "approve"
    """Say yes to what was proposed."""
    REJECT = "reject"
    """Say no to what was proposed."""
    ANSWER = "answer"
    """Answer a question that a robot asked a person."""
    EDIT = "edit"
    """Change, drop or skip steps of a plan."""
    CLEAR = "clear"
    """Give up a plan."""
    REPAIR = "repair"
    """Put other steps in the place of one that failed."""
    REMEMBER = "remember"
    """Add or replace a memory."""
    FORGET = "forget"
    """Remove a memory."""
    RULE = "rule"
    """Make, change or lift a rule."""
    MAP = "map"
    """Put rooms and things on the map, change them, take them off."""
    POLICY = "policy"
    """Choose which plans wait for a yes."""
    SETTING = "setting"
    """Change which robots are listed, feeds, what the system is made of."""
    PEOPLE = "people"
    """Accounts, roles, devices of others."""
    AUDIT = "audit"
    """Read who did what."""


Verdict = Literal["allow", "policy", "yes", "own", "refuse"]
"""`policy`: as the robot's policy and the rules say; `yes`: after a person's yes, whatever the policy; `own`:
only what it held itself, unless a person has held it since."""

Column = Literal[
    "viewer", "operator", "supervisor", "engine", "rule", "schedule", "keyed program", "program", "robot"
]
COLUMNS: Final[tuple[Column, ...]] = (
    "viewer", "operator", "supervisor", "engine", "rule", "schedule", "keyed program", "program", "robot",
)  # fmt: skip
"""People by role, then everybody else; a program with a key is known, one without is not."""

_A: Final[Verdict] = "allow"
_P: Final[Verdict] = "policy"
_Y: Final[Verdict] = "yes"
_O: Final[Verdict] = "own"
_R: Final[Verdict] = "refuse"

_ROWS: Final[dict[Effect, tuple[Verdict, ...]]] = {
    #                 viewer op  sup  eng  rule sched keyed prog robot
    Effect.SEE:      (_A,   _A,  _A,  _A,  _A,  _A,  _A,   _A,  _A),
    Effect.SPEAK:    (_R,   _A,  _A,  _R,  _A,  _A,  _A,   _A,  _R),
    Effect.STOP:     (_A,   _A,  _A,  _A,  _A,  _A,  _A,   _A,  _A),
    Effect.PAUSE:    (_A,   _A,  _A,  _A,  _A,  _A,  _A,   _A,  _A),
    Effect.RESET:    (_R,   _A,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.RESUME:   (_R,   _A,  _A,  _R,  _O,  _O,  _O,   _R,  _R),
    Effect.BEGIN:    (_R,   _A,  _A,  _P,  _P,  _P,  _P,   _Y,  _R),
    Effect.APPROVE:  (_R,   _A,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.REJECT:   (_R,   _A,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.ANSWER:   (_R,   _A,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.EDIT:     (_R,   _A,  _A,  _P,  _R,  _R,  _P,   _Y,  _R),
    Effect.CLEAR:    (_R,   _A,  _A,  _P,  _P,  _R,  _P,   _Y,  _R),
    Effect.REPAIR:   (_R,   _A,  _A,  _P,  _P,  _R,  _P,   _Y,  _R),
    Effect.REMEMBER: (_R,   _A,  _A,  _A,  _R,  _R,  _A,   _A,  _A),
    Effect.FORGET:   (_R,   _A,  _A,  _Y,  _R,  _R,  _A,   _R,  _R),
    Effect.RULE:     (_R,   _A,  _A,  _Y,  _R,  _R,  _R,   _R,  _R),
    Effect.MAP:      (_R,   _R,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.POLICY:   (_R,   _A,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.SETTING:  (_R,   _R,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.PEOPLE:   (_R,   _R,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
    Effect.AUDIT:    (_R,   _R,  _A,  _R,  _R,  _R,  _R,   _R,  _R),
}  # fmt: skip

TABLE: Final[dict[tuple[Effect, Column], Verdict]] = {
    (effect, column): cell for effect, row in _ROWS.items() for column, cell in zip(COLUMNS, row, strict=True)
}


def column_of(principal: Principal | None) -> Column:
    """Whose column counts; nobody named is a program that nobody vouches for."""
    if principal is None:
        return "program"
    if principal.kind == "person":
        return principal.role or "operator"
    if principal.kind == "program":
        return "keyed program" if principal.key else "program"
    return principal.kind


def verdict(principal: Principal | None, effect: Effect) -> Verdict:
    """What becomes of an effect that somebody wants."""
    return TABLE[effect, column_of(principal)]
