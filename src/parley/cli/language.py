"""The options by which commands choose a language engine."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from parley.errors import ConfigError

__all__ = ["KeyFileOption", "LanguageOption", "language_settings"]

LanguageOption = Annotated[
    str, typer.Option(help="What understands you: offline, provider:model, or provider:model@address.")
]
KeyFileOption = Annotated[
    Path | None, typer.Option(help="File with the model's key; default: the provider's environment variable.")
]


def language_settings(language: str, key_file: Path | None) -> dict[str, Any]:
    """The settings of `parley.config.SystemConfig` that the options stand for.

    Raises:
        ConfigError: No engine has a name like that.
    """
    if language != "offline" and ":" not in language:
        raise ConfigError(f"there is no language engine {language!r}; use offline or provider:model")
    return {"language": language, "model": {"key_file": key_file}}
