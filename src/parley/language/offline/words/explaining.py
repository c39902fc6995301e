"""What the engine decided while it read a message, in the order of deciding, for people and programs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

__all__ = ["Decision", "Trace"]


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision."""

    about: str
    """What was decided: `words`, `part` (what a part of a message is), `control`, `target`, `clause`,
    `recast`, `frame`, `action`, `argument`, `answer`, `memory`, `edit`, `question`, `reading` (how a
    way to read the message was judged)."""
    text: str
    """The decision as a readable line."""

    def to_json(self) -> dict[str, Any]:
        """For a line of JSON."""
        return {"about": self.about, "text": self.text}


@dataclass
class Trace:
    """Collects decisions; telling the same twice in a row counts once."""

    decisions: list[Decision] = field(default_factory=list)

    def note(self, about: str, text: str) -> None:
        """Note one decision."""
        decision = Decision(about, text)
        if decision not in self.decisions[-3:]:
            self.decisions.append(decision)
