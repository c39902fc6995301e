"""Settings of one running system: typed, checked once, unknown keys refused."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["SystemConfig"]


class SystemConfig(BaseModel):
    """What may be chosen about a system; the defaults are the thesis's and the design's."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    data_dir: Path | None = None
    """Where the memory file lives; None keeps memories only while the system runs."""
    actions_dir: Path | None = None
    """Folder with more actions, watched while the system runs."""
    language: Literal["offline"] = "offline"
    """Which language engine understands people."""
    approval: Literal["run_at_once", "ask_first"] = "run_at_once"
    """Whether plans wait for a person's yes."""
    speed: float | None = Field(default=1.0, gt=0)
    """Simulated time per wall time; None: as fast as the machine can."""
    seed: int = 0
    """For everything random in the simulation."""
    history_exchanges: int = Field(default=10, ge=0, le=1000)
    """Exchanges of a conversation that are context for the next message."""
    max_attempts: int = Field(default=3, ge=1, le=20)
    """Questions to the operator about one failed step before the robot is held."""
    language_timeout_s: float = Field(default=30.0, gt=0)
    """Wall time the language engine may take for an answer."""
    camera_hz: float = Field(default=5.0, gt=0, le=30)
    """Pictures per second of a camera feed that somebody watches."""
    display_quality: int = Field(default=85, ge=1, le=95)
    """JPEG quality of display feeds."""
    display_interval_s: float = Field(default=0.1, ge=0)
    """Shortest time between two pictures of one feed."""

    @property
    def memory_file(self) -> Path | None:
        """The memory's database file, None for a memory that is not kept."""
        return self.data_dir / "memory.db" if self.data_dir is not None else None

    @property
    def journal_file(self) -> Path | None:
        """The journal of what ran, None if it is not kept."""
        return self.data_dir / "journal.db" if self.data_dir is not None else None
