"""Files that people write or read: what is wrong with one is said with its name and the field."""

from __future__ import annotations

import json
import os
import tempfile
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from functools import lru_cache
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, LiteralString, Self, TypeVar

import yaml
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails, InitErrorDetails, PydanticCustomError

from parley.errors import FileFormatError

__all__ = [
    "TextFile", "again", "field_path", "parse_json", "parse_yaml", "read_text", "replace_text", "validated",
    "validated_yaml", "words_in", "wrong_at",
]  # fmt: skip

M = TypeVar("M", bound=BaseModel)

_TOLD_AT_ONCE: Final = 20
"""Of one file; of more it is said how many there are."""
_MAX_BYTES: Final = 50_000_000
_MAX_YAML_CHARS: Final = 2_000_000
"""YAML is read slowly: this takes some 20 s."""


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
        FileFormatError: It cannot be read, is too long, or is not UTF-8.
    """
    try:
        with path.open("rb") as opened:
            content = opened.read(_MAX_BYTES + 1)
        if len(content) > _MAX_BYTES:
            raise FileFormatError(path.name, "", f"is longer than {_MAX_BYTES // 1_000_000} MB")
        return content.decode("utf-8")
    except OSError as error:
        raise FileFormatError(path.name or str(path), "", f"cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise FileFormatError(path.name, "", f"is not UTF-8 text: {error.reason}") from error


def replace_text(path: Path, text: str) -> None:
    """Make this the text of a file, as a whole or not at all; it is on the disk when this returns.

    Raises:
        OSError: It cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(
        "w", encoding="utf-8", newline="", dir=path.parent, prefix=path.name, delete=False
    ) as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(file.name, path)  # noqa: PTH105 - the temporary file has only a name


def parse_json(text: str, file: str) -> Any:
    """The value of a JSON text; `file` is only for messages.

    Raises:
        FileFormatError: It is not JSON.
    """
    try:
        return json.loads(text)
    except ValueError as error:
        raise FileFormatError(file, "", f"not valid JSON: {error}") from error
    except RecursionError:
        raise FileFormatError(file, "", "not valid JSON: it is nested too deeply") from None


def parse_yaml(text: str, file: str) -> Any:
    """The value of a YAML text; `file` is only for messages.

    Raises:
        FileFormatError: It is not YAML.
    """
    if len(text) > _MAX_YAML_CHARS:
        raise FileFormatError(file, "", f"is longer than {_MAX_YAML_CHARS // 1_000_000} million letters")
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError) as error:
        # The last ones: the library lets out what a date, a number or a tag that cannot be does to it.
        raise FileFormatError(file, "", f"not valid YAML: {error}") from error
    except RecursionError:
        raise FileFormatError(file, "", "not valid YAML: it is nested too deeply") from None


def validated(model: type[M], raw: Any, file: str) -> M:
    """`raw` as a `model`.

    Raises:
        FileFormatError: Names every field that is missing, wrong or unknown.
    """
    try:
        return model.model_validate(raw)
    except ValidationError as error:
        raise _refusal([(file, *_told(one)) for one in _all(error)]) from error


def validated_yaml(model: type[M], text: str, file: str, context: dict[str, Any] | None = None) -> M:
    """A YAML text as a `model`; an empty one has no fields. What is wrong is said with its line.

    Args:
        model: What it should be.
        text: YAML.
        file: Its name, for messages.
        context: For the model's validators.

    Raises:
        FileFormatError: Names the file, and the line of every field that is wrong, unknown or said twice.
    """
    raw = parse_yaml(text, file)
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    wrong = [] if root is None else [*_said_twice(root)]
    try:
        made = model.model_validate({} if raw is None else raw, context=context)
    except ValidationError as error:
        wrong += [(_line(root, one["loc"]), *_told(one)) for one in _all(error)]
    if wrong:
        raise _refusal([(f"{file}, line {line}", field, told) for line, field, told in sorted(wrong)])
    return made


def _all(error: ValidationError) -> list[ErrorDetails]:
    return error.errors(include_url=False, include_input=False)


def _told(problem: ErrorDetails) -> tuple[str, str]:
    """The field, and what is wrong, without what pydantic puts before a validator's own words."""
    if problem["type"] == "extra_forbidden":
        return field_path(problem["loc"]), "there is no such setting"
    if problem["type"] == "tuple_type":
        return field_path(problem["loc"]), "Input should be a list: [one, another]"
    return field_path(problem["loc"]), problem["msg"].removeprefix("Value error, ")


def _refusal(wrong: Sequence[tuple[str, str, str]]) -> FileFormatError:
    """Of what is wrong, each with where it stands and its field."""
    others = [str(FileFormatError(*one)) for one in dict.fromkeys(wrong[1:])]
    more = len(others) - _TOLD_AT_ONCE
    return FileFormatError(
        *wrong[0], [*others[:_TOLD_AT_ONCE], *([f"... and {more} more"] if more > 0 else [])]
    )


def _said_twice(root: yaml.Node) -> Iterator[tuple[int, str, str]]:
    """What stands in a file twice has no meaning; YAML takes the last without a word."""
    waiting, looked_at = [root], {id(root)}  # a node may stand in itself
    while waiting:
        node = waiting.pop()
        within = list(node.value) if isinstance(node, yaml.SequenceNode) else []
        names: set[str] = set()
        for key, value in node.value if isinstance(node, yaml.MappingNode) else ():
            if key.value in names:
                yield key.start_mark.line + 1, str(key.value), "is said twice"
            names.add(str(key.value))
            within.append(value)
        waiting += [one for one in within if id(one) not in looked_at]
        looked_at.update(map(id, within))


def _line(node: yaml.Node | None, location: tuple[int | str, ...]) -> int:
    """The line of a field, or of the nearest thing around it that is there; the first is 1."""
    line = node.start_mark.line + 1 if node is not None else 1
    for part in location:
        if isinstance(node, yaml.SequenceNode) and isinstance(part, int):
            node = node.value[part]
            line = node.start_mark.line + 1
            continue
        pairs = node.value if isinstance(node, yaml.MappingNode) else ()
        found = next(((key, value) for key, value in pairs if key.value == str(part)), None)
        if found is None:
            return int(line)
        line, node = found[0].start_mark.line + 1, found[1]
    return int(line)


def wrong_at(
    location: tuple[int | str, ...], problem: str, kind: LiteralString = "unfit"
) -> InitErrorDetails:
    """What is wrong with a field, for a validator that looks at several of them."""
    told = PydanticCustomError(kind, "{problem}", {"problem": problem})
    return InitErrorDetails(type=told, loc=location, input=None)


def again(error: ValidationError) -> list[InitErrorDetails]:
    """What an error tells, to be told with more."""
    return [wrong_at(one["loc"], one["msg"], one["type"]) for one in _all(error)]


def field_path(location: tuple[int | str, ...]) -> str:
    """``("items", 2, "x")`` as ``items[2].x``."""
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in location).lstrip(".")


# The base loader builds nothing but text, lists and mappings; the first message waits for this, so be quick.
_WORDS_LOADER: Final = getattr(yaml, "CBaseLoader", yaml.BaseLoader)


@lru_cache(maxsize=64)
def words_in(package: str, name: str) -> Any:
    """The content of a YAML file of words that lies in a package; read once for all, so nobody can change it.

    Every scalar is text: in such a file ``no`` and ``on`` are words, not truth values.
    """
    text = (resources.files(package) / f"{name}.yaml").read_text(encoding="utf-8")
    return _unchangeable(yaml.load(text, Loader=_WORDS_LOADER))


def _unchangeable(content: Any) -> Any:
    """Mappings that can only be read, and tuples."""
    if isinstance(content, dict):
        return MappingProxyType({key: _unchangeable(value) for key, value in content.items()})
    return tuple(map(_unchangeable, content)) if isinstance(content, list) else content
