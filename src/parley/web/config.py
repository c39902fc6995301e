"""Settings of the page's server: typed, checked once."""

from __future__ import annotations

from os import environ
from pathlib import Path
from typing import Any, Final, Literal, Self

from pydantic import BaseModel, ConfigDict, Field

from parley.config import SystemConfig
from parley.messages.attendance import Unattended
from parley.messages.principal import Role

__all__ = ["LOCAL_MODELS", "MODULES", "Module", "WebConfig", "engine_in_words"]

Module = Literal["chat", "plan", "display", "map", "memory", "robots", "rules", "incidents", "log"]

MODULES: tuple[Module, ...] = (
    "chat", "plan", "display", "map", "memory", "robots", "rules", "incidents", "log",
)  # fmt: skip
"""What can be switched off."""

LOCAL_MODELS: Final = "http://127.0.0.1:11434"
"""Where Ollama usually listens."""


def engine_in_words(language: str) -> tuple[str, bool]:
    """What people are told of a language engine, by its name, and whether it needs no model."""
    if ":" not in language:
        return "built in, works without a model", True
    provider, _, model = language.removeprefix("auto:").partition("@")[0].partition(":")
    return f"{model} ({provider})", False


def _local_models() -> str:
    host = environ.get("OLLAMA_HOST", "")
    return LOCAL_MODELS if not host else host if "://" in host else f"http://{host}"


class WebConfig(BaseModel):
    """How the page is served."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    """Address to listen on."""
    port: int = Field(default=8400, ge=0, le=65535)
    """0 takes any that is free."""
    lan: bool = False
    """Open to other devices: with HTTPS, and only for those who sign in."""
    password: str = Field(default="", repr=False)
    """What all sign in with while there are no accounts; empty, where that is needed: a code is made."""
    pair_as: Role = "operator"
    """What the pairing code that is shown makes of a device."""
    certificate: Path | None = None
    """PEM file; None, where HTTPS is needed: one is made."""
    key: Path | None = None
    """PEM file with the certificate's private key."""
    origins: tuple[str, ...] = ()
    """Other origins (``https://host:port``) whose pages may talk to this server."""
    without: frozenset[Module] = frozenset()
    """Modules that are switched off."""
    examples: tuple[str, ...] = ()
    """Sentences to begin with."""
    tour: tuple[str, ...] = ()
    """What is said in a story that can be played on the page, one after the other."""
    local_models: str = Field(default_factory=_local_models)
    """Where a server for language models listens (Ollama, and where Ollama's own variable says so)."""
    language: str = engine_in_words("")[0]
    """The language engine in words for people."""
    offline_language: bool = True
    unattended: Unattended = "go_on"
    """What the robots do when nobody is connected; see `parley.config.SystemConfig`."""
    unattended_after_s: float = 30.0
    push_services: tuple[str, ...] = (
        "https://fcm.googleapis.com",
        "https://*.push.services.mozilla.com",
        "https://*.push.apple.com",
        "https://*.notify.windows.com",
    )
    """Where devices may be called whose page is closed: the services of browsers' makers."""
    data_dir: Path | None = None
    """Where the conversation and a made certificate are kept; None: only while the server runs."""
    static_dir: Path | None = None
    """The built page; None: the one that comes with the package."""
    head_within_s: float = Field(default=10.0, gt=0)
    """Wall time in which the head of a request must have come; then the connection is closed."""
    body_idle_s: float = Field(default=30.0, gt=0)
    """Wall time without any byte of a body that is still to come; then the connection is closed."""
    fresh_robots: bool = False
    """The robots start together with this server: what they asked before is void."""

    @classmethod
    def of(cls, system: SystemConfig, **given: Any) -> Self:
        """Settings for the page of a system; what is not given follows from the system's own settings.

        Raises:
            pydantic.ValidationError: One of them cannot be.
        """
        words, built_in = engine_in_words(system.language)
        known = {
            "language": words,
            "offline_language": built_in,
            "unattended": system.unattended,
            "unattended_after_s": system.unattended_after_s,
            "data_dir": system.data_dir,
        }
        return cls.model_validate(known | given)

    @property
    def modules(self) -> dict[str, bool]:
        """What is switched on."""
        return {name: name not in self.without for name in MODULES}
