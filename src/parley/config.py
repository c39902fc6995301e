"""Settings of one running system: typed, checked once, unknown keys refused."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["EmbeddingSettings", "FeedSettings", "ModelPrice", "ModelSettings", "SystemConfig"]


class ModelPrice(BaseModel):
    """What a model costs, in US dollars per million tokens."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    input: float = Field(ge=0)
    output: float = Field(ge=0)


class ModelSettings(BaseModel):
    """How language models are asked; the parameters are the thesis's (4.3.3)."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    base_url: str = ""
    """Address of an OpenAI-compatible server, for the first model."""
    key_file: Path | None = None
    """File with the first model's key; None: from the environment, as the provider names it."""
    temperature: float | None = Field(default=0.1, ge=0, le=2)
    """None leaves it to the model, as for `top_p`; some models take only one of them."""
    top_p: float | None = Field(default=0.6, gt=0, le=1)
    frequency_penalty: float = 0.0
    presence_penalty: float = 0.0
    max_plan_tokens: int = Field(default=2048, ge=64)
    max_memory_tokens: int = Field(default=1024, ge=64)
    output: Literal["tool", "native", "prompted"] = "tool"
    """How answers get their form: a tool call (plain JSON is accepted too), a JSON schema, or by asking."""
    pictures: bool = True
    """Whether the model is shown pictures that operators send or that are remembered."""
    timeout_s: float = Field(default=20.0, gt=0)
    """Time for one answer of one model, with all tries."""
    memory_timeout_s: float = Field(default=4.0, gt=0)
    """The same for picking memories, which comes before every answer."""
    retries: int = Field(default=2, ge=0, le=10)
    """Further tries when a model cannot be reached."""
    backoff_s: float = Field(default=0.5, gt=0)
    """Wait before the second try; doubles with each."""
    corrections: int = Field(default=2, ge=0, le=10)
    """How often an answer that cannot be used goes back to the model, with what is wrong."""
    breaker_failures: int = Field(default=3, ge=1)
    """Failed questions in a row after which a model is left alone."""
    breaker_open_s: float = Field(default=30.0, gt=0)
    """For how long."""
    max_tokens_per_hour: int | None = Field(default=None, ge=1)
    max_usd_per_hour: float | None = Field(default=None, gt=0)
    prices: dict[str, ModelPrice] = Field(default_factory=dict)
    """By model; wins over the price list that comes with the libraries."""
    record_file: Path | None = None
    """Every exchange is added to this file (JSON lines), for bug reports and replays."""


class EmbeddingSettings(BaseModel):
    """Where memories get vectors from, so that they are found by what they mean."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    url: str
    """Address of any server with OpenAI's ``POST /embeddings``, up to and without that."""
    model: str
    key_file: Path | None = None
    """File with the key; None: from the environment (``PARLEY_EMBEDDINGS_KEY``), or no key."""
    timeout_s: float = Field(default=2.0, gt=0)
    """Wall time an answer may take; then words alone decide."""
    min_alike: float = Field(default=0.3, ge=-1, le=1)
    """Least cosine of what counts as alike; models differ."""


class FeedSettings(BaseModel):
    """What is special about one display feed; what is left out is as for all."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    quality: int | None = Field(default=None, ge=1, le=95)
    """JPEG quality."""
    interval_s: float | None = Field(default=None, ge=0)
    """Shortest time between two pictures."""
    max_width_px: int | None = Field(default=None, ge=16, le=8192)
    """Wider pictures are made smaller."""


class SystemConfig(BaseModel):
    """What may be chosen about a system; the defaults are the thesis's and the design's."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    data_dir: Path | None = None
    """Where the memory file lives; None keeps memories only while the system runs."""
    embeddings: EmbeddingSettings | None = None
    """How memories are found by what they mean; None: by their words alone."""
    actions_dir: Path | None = None
    """Folder with more actions, watched while the system runs."""
    language: str = Field(default="offline", pattern=r"^(offline|[A-Za-z0-9_.-]+:.+)$")
    """Which language engine understands people: `offline`, `provider:model`, `provider:model@address`."""
    language_fallback: tuple[str, ...] = ("offline",)
    """Asked in this order when a model gives no answer."""
    model: ModelSettings = Field(default_factory=ModelSettings)
    """How language models are asked."""
    approval: Literal["run_at_once", "ask_when_risky", "ask_first"] = "run_at_once"
    """Whether plans wait for a person's yes: none, those with a step of high risk, all."""
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
    display_feeds: dict[str, FeedSettings] = Field(default_factory=dict)
    """What differs for single feeds: by `robot/feed`, or by `feed` for that of every robot."""

    @property
    def memory_file(self) -> Path | None:
        """The memory's database file, None for a memory that is not kept."""
        return self.data_dir / "memory.db" if self.data_dir is not None else None

    @property
    def incidents_file(self) -> Path | None:
        """The records of failures, None if they are not kept."""
        return self.data_dir / "incidents.db" if self.data_dir is not None else None

    @property
    def proposals_file(self) -> Path | None:
        """The plans that wait for a person's yes, None if they are not kept."""
        return self.data_dir / "proposals.db" if self.data_dir is not None else None

    @property
    def journal_file(self) -> Path | None:
        """The journal of what ran, None if it is not kept."""
        return self.data_dir / "journal.db" if self.data_dir is not None else None
