"""The agents: one per question, each with its typed answer."""

from __future__ import annotations

import json
from collections.abc import AsyncIterable, Awaitable, Callable
from typing import Any, Final, Literal, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_ai import Agent, ModelRetry, NativeOutput, PromptedOutput, RunContext, TextOutput, ToolOutput
from pydantic_ai.exceptions import UnexpectedModelBehavior
from pydantic_ai.messages import (
    PartDeltaEvent,
    PartStartEvent,
    TextPart,
    TextPartDelta,
    ToolCallPart,
    ToolCallPartDelta,
)

from parley.language.base import DraftHandler
from parley.language.llm.answers import ANSWERS, TOOL
from parley.language.llm.drafts import DraftReader
from parley.language.llm.forms import Form
from parley.language.llm.reading import AnswerRefusedError
from parley.language.prompts import Kind

__all__ = ["OutputMode", "draft_handler", "make_agent"]

A = TypeVar("A", bound=BaseModel)

OutputMode = Literal["tool", "native", "prompted"]

_LONGEST_ANSWER: Final = 200_000
"""Characters; nothing that a person could follow is longer."""
_MAX_PROBLEMS: Final = 10
_LONGEST_PROBLEM: Final = 500


def make_agent(
    kind: Kind, form: Form, mode: OutputMode, corrections: int, *, strict: bool
) -> Agent[Callable[[Any], object], Any]:
    """The agent for a question; its dependency reads an answer, and raises if that cannot be used.

    Args:
        kind: The question.
        form: What the model is told of the answer's form.
        mode: How the answer gets its form.
        corrections: How often an answer goes back to the model.
        strict: Whether the provider is asked to hold the model to the form.
    """
    answer = _told_as(ANSWERS[kind], form)
    agent: Agent[Callable[[Any], object], Any] = Agent(
        output_type=_output(answer, mode, strict), retries={"output": corrections}, name=kind
    )

    # Not plain functions, here and below: those would be sent to a thread, and wait for it on a busy machine.
    @agent.output_validator
    async def check(context: RunContext[Callable[[Any], object]], given: Any) -> Any:
        try:
            context.deps(given)
        except AnswerRefusedError as refused:
            problems = [problem[:_LONGEST_PROBLEM] for problem in refused.problems[:_MAX_PROBLEMS]]
            text = "That cannot be used:\n" + "\n".join(f"- {problem}" for problem in problems)
            raise ModelRetry(f"{text}\nAnswer again, as a whole.") from refused
        return given

    return agent


def _told_as(answer: type[A], form: Form) -> type[A]:
    """`answer` as it is read, however it is spelt; the model is told of it as `form` says."""

    def told(_cls: type[A], _core: object, _handler: object) -> Form:
        return form

    return type(answer.__name__, (answer,), {
        "__get_pydantic_json_schema__": classmethod(told), "__module__": __name__, "__doc__": answer.__doc__,
    })  # fmt: skip


def _output(answer: type[BaseModel], mode: OutputMode, strict: bool) -> Any:
    if mode == "native":
        return NativeOutput(answer, strict=strict)
    if mode == "prompted":
        return PromptedOutput(answer)
    return [ToolOutput(answer, name=TOOL, strict=strict), TextOutput(_text_reader(answer))]


def _text_reader(answer: type[A]) -> Callable[[str], Awaitable[A]]:
    """Reads an answer from text: models that do not call tools write the JSON down, often between fences."""

    async def read(text: str) -> A:
        start, end = text.find("{"), text.rfind("}")
        if start < 0 or end < start:
            raise ModelRetry(f"Answer by calling the tool {TOOL}, or with its arguments as one JSON object.")
        try:
            return answer.model_validate(json.loads(text[start : end + 1]))
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False, include_context=False)[
                :_MAX_PROBLEMS
            ]
            wrong = "; ".join(f"{'.'.join(map(str, item['loc']))}: {item['msg']}" for item in first)
            raise ModelRetry(f"That JSON cannot be used: {wrong}") from error
        except (ValueError, RecursionError) as error:
            raise ModelRetry("That is not valid JSON. Answer with one JSON object.") from error

    return read


def draft_handler(on_draft: DraftHandler) -> Any:
    """A handler of an agent's events that hands on the reply while it is written."""

    async def handle(_context: RunContext[Any], events: AsyncIterable[Any]) -> None:
        reader, chars = DraftReader(), 0
        async for event in events:
            piece = _piece(event, reader)
            chars += len(piece)
            if chars > _LONGEST_ANSWER:
                raise UnexpectedModelBehavior(f"the answer is longer than {_LONGEST_ANSWER} characters")
            reply = reader.feed(piece) if piece else None
            if reply is not None:
                on_draft(reply)

    return handle


def _piece(event: Any, reader: DraftReader) -> str:
    match event:
        case PartStartEvent(part=TextPart(content=str(text))):
            reader.restart()
            return text
        case PartStartEvent(part=ToolCallPart(args=args)):
            reader.restart()
            return args if isinstance(args, str) else ""
        case PartDeltaEvent(delta=TextPartDelta(content_delta=text)):
            return text
        case PartDeltaEvent(delta=ToolCallPartDelta(args_delta=str(text))):
            return text
    return ""
