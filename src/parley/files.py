"""Reading files that people write: what is wrong with one is said with its name and the field."""

from __future__ import annotations

import json
from abc import abstractmethod
from pathlib import Path
from typing import Any, Self, TypeVar

import yaml
from pydantic import BaseModel, ValidationError

from parley.errors import FileFormatError

__all__ = ["TextFile", "field_path", "parse_json", "parse_yaml", "read_text", "validated"]

M = TypeVar("M", bound=BaseModel)


class TextFile:
    """Base of what is read from one text file that people write; a subclass says how by `parse`."""

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a file of this kind.

        Raises:
            FileFormatError: Names the file and the field.
        """
        return cls.parse(read_text(path), file=path.name)

    @classmethod
    @abstractmethod
    def parse(cls, text: str, file: str) -> Self:
        """Read the text of such a file; `file` is only for messages.

        Raises:
            FileFormatError: Names the file and the field.
        """


def read_text(path: Path) -> str:
    """The text of a file.

    Raises:
        FileFormatError: It cannot be read, or is not UTF-8.
    """
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileFormatError(path.name or str(path), "", f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise FileFormatError(path.name, "", f"is not UTF-8 text: {error.reason}") from error


def parse_json(text: str, file: str) -> Any:
    """The value of a JSON text; `file` is only for messages.

    Raises:
        FileFormatError: It is not JSON.
    """
    try:
        return json.loads(text)
    except ValueError as error:
        raise FileFormatError(file, "", f"not valid JSON: {error}") from error


def parse_yaml(text: str, file: str) -> Any:
    """The value of a YAML text; `file` is only for messages.

    Raises:
        FileFormatError: It is not YAML.
    """
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise FileFormatError(file, "", f"not valid YAML: {error}") from error


def validated(model: type[M], raw: Any, file: str) -> M:
    """`raw` as a `model`.

    Raises:
        FileFormatError: Names the first field that is missing, wrong or unknown.
    """
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        raise FileFormatError(file, field_path(first["loc"]), first["msg"]) from error


def field_path(location: tuple[int | str, ...]) -> str:
    """``("items", 2, "x")`` as ``items[2].x``."""
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in location).lstrip(".")
