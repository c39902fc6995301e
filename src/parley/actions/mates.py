"""What an action can know of other robots' parts of the work."""

from __future__ import annotations

from typing import Literal, Protocol

__all__ = ["ALONE", "Mates", "PartOutlook"]

PartOutlook = Literal["done", "open", "failed", "lost"]
"""Of another robot's part: `failed`: a step of it failed, and somebody may mend that; `lost`: it will not be
done by itself any more."""


class Mates(Protocol):
    """Other robots, as far as they are waited for."""

    def outlook(self, robot: str, order: str) -> PartOutlook:
        """How far another robot is.

        Args:
            robot: Its name.
            order: `id` of the order; empty: all that it has to do.
        """
        ...

    async def changed(self) -> None:
        """Wait until something about others may be different, a second of wall time at most."""
        ...


class _Alone:
    """Where there is nobody to wait for."""

    def outlook(self, robot: str, order: str) -> PartOutlook:
        return "lost"

    async def changed(self) -> None:
        return None


ALONE: Mates = _Alone()
