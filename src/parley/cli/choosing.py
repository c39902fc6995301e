"""The options by which commands choose a language engine."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from parley.config import SystemConfig, language_name
from parley.errors import ConfigError
from parley.memory.embedder import KEY_VARIABLE
from parley.sentences import LANGUAGES, SpokenLanguage

__all__ = [
    "ConfigOption",
    "EmbeddingsKeyOption",
    "EmbeddingsOption",
    "KeyFileOption",
    "LangOption",
    "LanguageOption",
    "chosen_settings",
    "embedding_settings",
    "language_settings",
    "spoken",
]


def spoken(text: str) -> SpokenLanguage:
    """A language in which robots speak.

    Raises:
        ConfigError: There is none of that name.
    """
    if text not in LANGUAGES:
        raise ConfigError(f"there is no language {text!r}; there are: {', '.join(LANGUAGES)}")
    return text


ConfigOption = Annotated[
    Path | None,
    typer.Option(help="File with settings (YAML): language model, memory, pictures, whether to ask first."),
]
LanguageOption = Annotated[
    str, typer.Option(help="builtin, provider:model[@address], auto:provider:model (both).")
]
KeyFileOption = Annotated[
    Path | None, typer.Option(help="File with the model's key; default: the provider's environment variable.")
]
LangOption = Annotated[
    str | None,
    typer.Option(
        help=f"What an operator at the terminal reads ({', '.join(LANGUAGES)}); default: see LANG.",
        parser=spoken,
    ),
]
EmbeddingsOption = Annotated[
    str, typer.Option(help="Find memories by what they mean, too: model@address of a server for embeddings.")
]
EmbeddingsKeyOption = Annotated[
    Path | None, typer.Option(help=f"File with that server's key; default: {KEY_VARIABLE}, or none.")
]


def embedding_settings(embeddings: str, key_file: Path | None) -> dict[str, Any]:
    """The settings of `parley.config.SystemConfig` that the options stand for; none if there are none.

    Raises:
        ConfigError: The address cannot be used.
    """
    if not embeddings:
        return {}
    model, _, url = embeddings.partition("@")
    if not model or not url.startswith(("http://", "https://")):
        raise ConfigError(f"--embeddings: {embeddings!r} is no model@address, such as name@http://host/v1")
    return {"embeddings": {"url": url, "model": model, "key_file": key_file}}


def chosen_settings(config: Path | None, language: str, key_file: Path | None) -> SystemConfig:
    """The settings of a file, with what the options say on top.

    Args:
        config: The file; None: the usual settings.
        language: See `language_settings`.
        key_file: See `language_settings`.

    Raises:
        ConfigError: No engine has a name like that, or the file cannot be read.
    """
    given = SystemConfig() if config is None else SystemConfig.load(config)
    return given.changed(language_settings(language, key_file))


def language_settings(language: str, key_file: Path | None) -> dict[str, Any]:
    """The settings of `parley.config.SystemConfig` that the options stand for.

    Args:
        language: Empty: whatever is set elsewhere.
        key_file: With the key of that model.

    Raises:
        ConfigError: No engine has a name like that.
    """
    if not language:
        return {} if key_file is None else {"model": {"key_file": key_file}}
    try:
        return {"language": language_name(language), "model": {"key_file": key_file}}
    except ValueError as error:
        raise ConfigError(str(error)) from error
