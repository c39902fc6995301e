"""A server that speaks the OpenAI chat protocol and says what it is told to, for tests and measuring.

Real HTTP on a real port, streaming included. Prepared answers are given in order; without one it answers 500.
"""

from __future__ import annotations

import asyncio
import contextlib
import gzip
import json
from collections import deque
from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Final, Self

__all__ = ["Request", "Say", "ScriptedServer"]

_LONGEST_REQUEST: Final = 64_000_000


@dataclass(frozen=True, slots=True)
class Say:
    """One prepared answer.

    Either `answer` (arguments of the answer tool, or the JSON text where no tool is offered), or `text` as it
    is, or a whole `body` with its `status`.
    """

    answer: Mapping[str, Any] | None = None
    text: str | None = None
    refusal: str | None = None
    body: str | bytes | None = None
    """Bytes are sent as they are, e.g. packed ones."""
    status: int = 200
    headers: Mapping[str, str] = field(default_factory=dict)
    content_type: str = "application/json"
    finish: str = ""
    """`finish_reason`; empty: what fits the answer."""
    cut: int | None = None
    """Only so many characters of the answer are sent."""
    drop_after: int | None = None
    """The connection is dropped after so many pieces of a stream (0: before any answer)."""
    gate: asyncio.Event | None = None
    """Waited for before anything is sent."""
    piece_gate: asyncio.Event | None = None
    """Waited for before the second half of a stream."""
    pieces: int = 8
    """Of a stream."""
    tokens: tuple[int, int] = (100, 20)
    """Input and output tokens it claims."""


@dataclass(frozen=True, slots=True)
class Request:
    """What was asked."""

    path: str
    headers: Mapping[str, str]
    body: Mapping[str, Any]

    @property
    def texts(self) -> list[str]:
        """Every text in the messages, in order."""
        found: list[str] = []
        for message in self.body.get("messages", []):
            content = message.get("content") or ""
            parts = [{"type": "text", "text": content}] if isinstance(content, str) else content
            found += [part["text"] for part in parts if part.get("type") == "text"]
        return found


class ScriptedServer:
    """Listens on 127.0.0.1 while open. Use as ``async with``."""

    def __init__(self) -> None:
        self.requests: list[Request] = []
        """All that were made, in order."""
        self.packs = False
        """Whether answers in one piece are sent gzipped."""
        self._script: deque[Say] = deque()
        self._default: Say | None = None
        self._server: asyncio.Server | None = None
        self._tasks: set[asyncio.Task[None]] = set()
        self._asked = asyncio.Event()

    @property
    def url(self) -> str:
        """The address to give to a client."""
        if self._server is None:
            raise RuntimeError("the server is not open")
        return f"http://127.0.0.1:{self._server.sockets[0].getsockname()[1]}/v1"

    def will(self, *answers: Say) -> None:
        """Prepare answers, to be given in order."""
        self._script.extend(answers)

    def always(self, answer: Say) -> None:
        """Prepare the answer for whenever no other is left."""
        self._default = answer

    async def asked(self, times: int = 1) -> None:
        """Wait until so many requests were made."""
        while len(self.requests) < times:
            self._asked.clear()
            await self._asked.wait()

    async def __aenter__(self) -> Self:
        self._server = await asyncio.start_server(self._connected, "127.0.0.1", 0)
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._server is not None:
            self._server.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._server = None

    # -- HTTP ------------------------------------------------------------------------------------------

    def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.create_task(self._serve(reader, writer))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            while (request := await _read(reader)) is not None:
                self.requests.append(request)
                self._asked.set()
                if not await self._respond(request, writer):
                    return
        except (ConnectionError, asyncio.IncompleteReadError):
            return
        finally:
            writer.close()
            with contextlib.suppress(ConnectionError):
                await writer.wait_closed()

    async def _respond(self, request: Request, writer: asyncio.StreamWriter) -> bool:
        """Give the next answer; whether the connection stays open."""
        say = self._script.popleft() if self._script else self._default
        if say is None:
            say = Say(body='{"error": {"message": "the script has no answer"}}', status=500)
        if say.gate is not None:
            await say.gate.wait()
        if say.drop_after == 0:
            writer.transport.abort()
            return False
        if say.body is not None:
            body = say.body.encode() if isinstance(say.body, str) else say.body
            await _send(writer, say.status, say.content_type, say.headers, body)
            return True
        if request.body.get("stream"):
            return await _send_stream(writer, _events(say, request), say)
        raw, headers = json.dumps(_completion(say, request)).encode(), dict(say.headers)
        if self.packs:
            raw, headers["Content-Encoding"] = gzip.compress(raw), "gzip"
        await _send(writer, say.status, say.content_type, headers, raw)
        return True


async def _read(reader: asyncio.StreamReader) -> Request | None:
    try:
        head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1")
    except asyncio.IncompleteReadError:
        return None
    first, *lines = head.split("\r\n")
    headers = {
        name.strip().lower(): value.strip()
        for name, colon, value in (line.partition(":") for line in lines)
        if colon
    }
    length = min(int(headers.get("content-length", "0")), _LONGEST_REQUEST)
    raw = await reader.readexactly(length) if length else b"{}"
    return Request(first.split(" ")[1], headers, json.loads(raw))


async def _send(
    writer: asyncio.StreamWriter, status: int, content_type: str, headers: Mapping[str, str], body: bytes
) -> None:
    lines = [f"HTTP/1.1 {status} -", f"Content-Type: {content_type}", f"Content-Length: {len(body)}"]
    lines += [f"{name}: {value}" for name, value in headers.items()]
    writer.write(("\r\n".join(lines) + "\r\n\r\n").encode() + body)
    await writer.drain()


async def _send_stream(writer: asyncio.StreamWriter, events: AsyncIterator[str], say: Say) -> bool:
    writer.write(b"HTTP/1.1 200 -\r\nContent-Type: text/event-stream\r\nTransfer-Encoding: chunked\r\n\r\n")
    sent = 0
    async for event in events:
        data = f"data: {event}\n\n".encode()
        writer.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")
        await writer.drain()
        sent += 1
        if say.drop_after is not None and sent >= say.drop_after:
            writer.transport.abort()
            return False
    writer.write(b"0\r\n\r\n")
    await writer.drain()
    return True


# -- the protocol --------------------------------------------------------------------------------------


def _tool_of(request: Request) -> str | None:
    tools = request.body.get("tools") or []
    return tools[0]["function"]["name"] if tools else None


def _written(say: Say, request: Request) -> tuple[str | None, str]:
    """The tool that is called, if any, and the text or arguments."""
    if say.answer is None:
        return None, (say.text or "")[: say.cut]
    return _tool_of(request), json.dumps(say.answer, ensure_ascii=False)[: say.cut]


def _usage(say: Say) -> dict[str, int]:
    given, made = say.tokens
    return {"prompt_tokens": given, "completion_tokens": made, "total_tokens": given + made}


def _frame(request: Request, kind: str) -> dict[str, Any]:
    model = request.body.get("model", "scripted")
    return {"id": "scripted-1", "object": kind, "created": 1_790_000_000, "model": model}


def _completion(say: Say, request: Request) -> dict[str, Any]:
    tool, text = _written(say, request)
    message: dict[str, Any] = {"role": "assistant", "content": None if tool or say.refusal else text}
    if tool:
        function = {"name": tool, "arguments": text}
        message["tool_calls"] = [{"id": "call-1", "type": "function", "function": function}]
    if say.refusal is not None:
        message["refusal"] = say.refusal
    finish = say.finish or ("tool_calls" if tool else "stop")
    choice = {"index": 0, "message": message, "finish_reason": finish}
    return _frame(request, "chat.completion") | {"choices": [choice], "usage": _usage(say)}


async def _events(say: Say, request: Request) -> AsyncIterator[str]:
    tool, text = _written(say, request)
    frame = _frame(request, "chat.completion.chunk")

    def event(delta: dict[str, Any], finish: str | None = None) -> str:
        return json.dumps(frame | {"choices": [{"index": 0, "delta": delta, "finish_reason": finish}]})

    yield event({"role": "assistant", "content": None if tool else ""})
    if say.refusal is not None:
        yield event({"refusal": say.refusal})
    size = max(1, -(-len(text) // say.pieces))
    for number, start in enumerate(range(0, len(text), size)):
        if say.piece_gate is not None and number == say.pieces // 2:
            await say.piece_gate.wait()
        yield event(_delta(tool, text[start : start + size], first=not number))
    yield event({}, say.finish or ("tool_calls" if tool else "stop"))
    yield json.dumps(frame | {"choices": [], "usage": _usage(say)})
    yield "[DONE]"


def _delta(tool: str | None, piece: str, *, first: bool) -> dict[str, Any]:
    if tool is None:
        return {"content": piece}
    call: dict[str, Any] = {"index": 0, "function": {"arguments": piece}}
    if first:
        call |= {"id": "call-1", "type": "function"}
        call["function"]["name"] = tool
    return {"tool_calls": [call]}
