"""What a check of this machine found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Finding", "State"]

State = Literal["ok", "missing", "wrong", "unused"]


@dataclass(frozen=True, slots=True)
class Finding:
    """What one check found."""

    subject: str
    state: State
    """`missing` and `wrong` need a person; `unused` is absent, and only some uses need it."""
    text: str
    remedy: str = ""
    needed: bool = False
    """Whether Parley does not work without it."""

    @property
    def hinders(self) -> bool:
        """Whether something has to be done before Parley works."""
        return self.needed and self.state in ("missing", "wrong")
