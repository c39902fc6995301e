"""Exchanges with models as JSON lines: kept for bug reports, played again; keys never appear."""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from pydantic_ai.exceptions import ModelRequestRejectedError
from pydantic_ai.messages import (
    ModelMessage,
    ModelMessagesTypeAdapter,
    ModelRequest,
    ModelResponse,
    UserPromptPart,
)
from pydantic_ai.models import Model
from pydantic_ai.models.function import AgentInfo, FunctionModel

from parley.errors import ConfigError, FileFormatError
from parley.files import parse_json, read_text
from parley.language.llm.usage import Exchange
from parley.language.prompts import Prompt

__all__ = ["Recorder", "Redactor", "replay_model"]

_SHORTEST_KEY: Final = 6


class Redactor:
    """Blacks out keys: those given, and every one in the environment.

    Args:
        keys: Known keys.
    """

    def __init__(self, keys: Iterable[str] = ()) -> None:
        named = [value for name, value in os.environ.items() if name.upper().endswith(("_API_KEY", "_TOKEN"))]
        secrets = {key for key in [*keys, *named] if len(key) >= _SHORTEST_KEY}
        self._secrets = sorted(secrets, key=len, reverse=True)

    def clean(self, text: str) -> str:
        """`text` without keys."""
        for secret in self._secrets:
            text = text.replace(secret, "[key]")
        return text


class Recorder:
    """Adds exchanges to a file.

    Args:
        file: JSON lines; made if it is not there.
        redactor: What must not be written.
    """

    def __init__(self, file: Path, redactor: Redactor) -> None:
        self._file, self._redactor = file, redactor

    async def keep(self, prompt: Prompt, exchange: Exchange, messages: Sequence[ModelMessage]) -> None:
        """Write one exchange down; pictures are left out."""
        responses: list[ModelMessage] = [item for item in messages if isinstance(item, ModelResponse)]
        line = {
            **asdict(exchange),
            "instructions": prompt.instructions,
            "content": prompt.content,
            "responses": ModelMessagesTypeAdapter.dump_python(responses, mode="json"),
        }
        await asyncio.to_thread(self._write, self._redactor.clean(json.dumps(line, ensure_ascii=False)))

    def _write(self, line: str) -> None:
        with self._file.open("a", encoding="utf-8") as file:
            file.write(f"{line}\n")


def replay_model(file: Path) -> Model[Any]:
    """A model that gives the answers of a recording again, for the same questions.

    Raises:
        FileFormatError: The file is no recording.
        ConfigError: It holds no answer.
    """
    answers: dict[str, list[ModelResponse]] = {}
    for number, line in enumerate(read_text(file).splitlines(), 1):
        if line.strip():
            content, responses = _read(line, f"{file.name}, line {number}")
            if responses:
                answers.setdefault(content, responses)
    if not answers:
        raise ConfigError(f"{file.name} holds no answers")

    async def play(messages: list[ModelMessage], _info: AgentInfo) -> ModelResponse:
        recorded = answers.get(_question(messages), [])
        given = sum(isinstance(message, ModelResponse) for message in messages)
        if given >= len(recorded):
            raise ModelRequestRejectedError(file.name, "the recording has no answer to this")
        return recorded[given]

    return FunctionModel(play, model_name=file.stem)


def _read(line: str, where: str) -> tuple[str, list[ModelResponse]]:
    value = parse_json(line, where)
    if not isinstance(value, dict) or not isinstance(value.get("content"), str):
        raise FileFormatError(where, "content", "expected the question that was asked")
    try:
        messages = ModelMessagesTypeAdapter.validate_python(value.get("responses", []))
    except ValueError as error:
        raise FileFormatError(where, "responses", "expected answers of a model") from error
    return value["content"], [message for message in messages if isinstance(message, ModelResponse)]


def _question(messages: Sequence[ModelMessage]) -> str:
    for message in messages:
        for part in message.parts if isinstance(message, ModelRequest) else ():
            if isinstance(part, UserPromptPart):
                content = part.content
                return content if isinstance(content, str) else next(c for c in content if isinstance(c, str))
    return ""
