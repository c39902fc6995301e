"""From ``provider:model@address`` to a model that can be asked. Loads the libraries for models."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import structlog
from pydantic_ai.exceptions import UserError
from pydantic_ai.models import Model, infer_model
from pydantic_ai.providers import Provider, infer_provider_class

from parley.errors import ConfigError
from parley.extras import MODEL_EXTRAS
from parley.files import read_text
from parley.language.llm.bounded import BoundedModel, bounded_client

__all__ = ["ModelSpec", "make_model", "read_key"]

log = structlog.get_logger(__name__)

LOCAL_SERVERS: Final = {
    "ollama": "http://localhost:11434/v1",
    "llamacpp": "http://localhost:8080/v1",
    "vllm": "http://localhost:8000/v1",
    "lmstudio": "http://localhost:1234/v1",
}
"""Servers of one's own that speak the OpenAI protocol, where they usually listen."""
_COMPATIBLE: Final = {"openai", "local", *LOCAL_SERVERS}
_NO_KEY: Final = "none"


@dataclass(frozen=True, slots=True)
class ModelSpec:
    """Which model, of whom, where."""

    provider: str
    model: str
    base_url: str = ""

    @classmethod
    def parse(cls, text: str, base_url: str = "") -> ModelSpec:
        """Read ``provider:model`` or ``provider:model@http://host:port/v1``.

        Raises:
            ConfigError: It has another form.
        """
        name, at, address = text.rpartition("@http")
        if not at:
            name, address = text, ""
        provider, colon, model = name.partition(":")
        if not colon or not provider or not model:
            raise ConfigError(f"{text!r} names no model: write provider:model, or builtin for none")
        url = f"http{address}" if at else base_url or LOCAL_SERVERS.get(provider, "")
        if provider == "local" and not url:
            raise ConfigError("local:model needs an address: local:model@http://host:port/v1")
        return cls(provider, model, url)

    @property
    def is_compatible(self) -> bool:
        """Whether it is asked over the protocol that servers of all kinds imitate, some of them poorly."""
        return bool(self.base_url) and self.provider in _COMPATIBLE

    @property
    def name(self) -> str:
        """For people and reports: without the address, which may hold a secret."""
        return f"{self.provider}:{self.model}"


def read_key(file: Path | None) -> str:
    """The key in a file; empty without one.

    Raises:
        ConfigError: The file cannot be read, or is empty.
    """
    if file is None:
        return ""
    key = read_text(file).strip()
    if not key:
        raise ConfigError(f"{file.name} holds no key")
    return key


def make_model(spec: ModelSpec, key: str) -> Model[Any]:
    """The model that `spec` names.

    Args:
        spec: Which.
        key: Its key; empty: from the environment, as the provider's library does.

    Raises:
        ConfigError: The provider is unknown or not installed, or the key is missing.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of libraries, while they are loaded
            if spec.is_compatible:
                # A key from the environment goes to nobody but the provider it is named after.
                named = os.environ.get("OPENAI_API_KEY", "") if spec.provider == "openai" else ""
                return _compatible(spec, key or named or _NO_KEY)
            given: list[Any] = []
            model = infer_model(spec.name, lambda name: _provider(name, spec, key, given))
            return BoundedModel(model, given[0]) if given else model
    except ImportError as error:
        raise ConfigError(
            f"{spec.provider} models need a library: pip install '{_library(spec.provider)}'"
        ) from error
    except (UserError, ValueError, TypeError) as error:
        raise ConfigError(f"{spec.name} cannot be used: {error}") from error


def _library(provider: str) -> str:
    """What to install for a provider."""
    if provider in _COMPATIBLE:
        return "parley-hri[openai]"
    return f"parley-hri[{provider}]" if provider in MODEL_EXTRAS else f"pydantic-ai-slim[{provider}]"


def _provider(name: str, spec: ModelSpec, key: str, clients: list[Any]) -> Provider[Any]:
    """The provider of that name; the client that it was given is added to `clients`."""
    kind: Callable[..., Provider[Any]] = infer_provider_class(name)
    given: dict[str, Any] = {}
    if key:
        given["api_key"] = key
    if spec.base_url:
        given["base_url"] = spec.base_url
    client = bounded_client(kind)
    if client is None:
        log.warning("answers of this provider are not limited in length", provider=name)
        return kind(**given)
    clients.append(client)
    return kind(**given, http_client=client)


def _compatible(spec: ModelSpec, key: str) -> Model[Any]:
    from pydantic_ai.models.openai import OpenAIChatModel
    from pydantic_ai.providers.openai_compatible import OpenAICompatibleProvider

    client = bounded_client(OpenAICompatibleProvider)
    provider = OpenAICompatibleProvider(
        spec.provider, base_url=spec.base_url, api_key=key, http_client=client
    )
    return BoundedModel(OpenAIChatModel(spec.model, provider=provider), client)
