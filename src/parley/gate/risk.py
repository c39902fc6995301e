"""Which class of risk an action is of, from what it declares. Pure.

Nothing is harmless by default: an action that declares no effects, or one that nobody here knows, is unknown.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Final

from parley.messages.rules import RiskClass
from parley.messages.status import ActionInfo

__all__ = ["EFFECTS", "always_asks", "risk_class", "risk_of"]

EFFECTS: Final[Mapping[str, RiskClass]] = MappingProxyType(
    dict.fromkeys(
        (
            "looks", "speaks", "locates", "asks_operator", "remembers", "waits", "shows", "listens",
            "measures", "reads", "plays_sound",
        ),
        RiskClass.LOOKS,
    )
    | dict.fromkeys(("moves", "turns", "docks", "follows", "leads", "gestures"), RiskClass.MOVES)
    | dict.fromkeys(
        (
            "handles_things", "grasps", "places", "lifts", "carries", "hands_over", "opens", "closes",
            "presses", "pushes", "pulls", "switches", "tows", "loads", "unloads",
        ),
        RiskClass.HANDLES,
    )
    | dict.fromkeys(
        (
            "cannot_be_undone", "deletes", "throws_away", "pours", "dispenses", "breaks", "cuts",
            "sends_message",
        ),
        RiskClass.FINAL,
    )
)  # fmt: skip
"""What the known effects do to the world; any other word makes an action `unknown`."""

_ORDER: Final = (RiskClass.LOOKS, RiskClass.MOVES, RiskClass.HANDLES, RiskClass.UNKNOWN, RiskClass.FINAL)


def risk_class(effects: Iterable[str], risk: str = "") -> RiskClass:
    """The class of what does all these things.

    Args:
        effects: What is declared.
        risk: The older declaration: `high` is the strictest class, `none` counts where no effects are told.
    """
    if risk == "high":
        return RiskClass.FINAL
    found = [EFFECTS.get(effect, RiskClass.UNKNOWN) for effect in effects]
    if not found:
        return RiskClass.LOOKS if risk == "none" else RiskClass.UNKNOWN
    return max(found, key=_ORDER.index)


def risk_of(info: ActionInfo | None) -> RiskClass:
    """The class of an action; one that is not in the catalogue is unknown."""
    return risk_class(info.effects, info.risk) if info is not None else RiskClass.UNKNOWN


def always_asks(info: ActionInfo | None) -> bool:
    """Whether `ask_when_risky` asks about it wherever and however far it goes."""
    return risk_of(info) not in (RiskClass.LOOKS, RiskClass.MOVES)
