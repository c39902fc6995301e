"""What a server may answer at most, counted after decompression: 1.5 MB can unpack to gigabytes."""

from __future__ import annotations

import inspect
from collections.abc import AsyncIterator, Callable
from types import TracebackType
from typing import Any, Final, Self

import httpx2
from pydantic_ai.models import Model
from pydantic_ai.models.wrapper import WrapperModel

__all__ = ["AnswerTooLongError", "BoundedModel", "bounded_client"]

_MAX_BYTES: Final = 4_000_000
"""Of an answer in one piece, and of what is said about an error."""
_MAX_STREAM_BYTES: Final = 16_000_000
"""Of a streamed one: every word comes in a frame of its own."""
_MAX_EVENT_BYTES: Final = 1_000_000
"""Of one frame: the libraries gather it piece by piece."""
_FRAME_ENDS: Final = (b"\n\n", b"\r\n\r\n", b"\r\r")
_CONNECT_S: Final = 5.0
_TIMEOUT_S: Final = 600.0
"""Between two pieces; each question has its own, shorter one."""


class AnswerTooLongError(RuntimeError):
    """A server sends more than any answer needs."""


class BoundedModel(WrapperModel):
    """A model together with the client it is asked through, closed with it."""

    def __init__(self, model: Model[Any], client: Any) -> None:
        super().__init__(model)
        self._client = client

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool | None:
        try:
            return await super().__aexit__(kind, error, trace)
        finally:
            await self._client.aclose()

    async def __aenter__(self) -> Self:
        await super().__aenter__()
        return self


def bounded_client(provider: Callable[..., Any]) -> Any:
    """A client for `provider` that reads no endless answers, and follows nobody to another address.

    Args:
        provider: A class of Pydantic AI; None is returned if it takes no client.
    """
    taken = inspect.signature(provider).parameters.get("http_client")
    if taken is None:
        return None
    library: Any = httpx2
    if str(taken.annotation).startswith("httpx.AsyncClient"):  # a library that has not moved on yet
        import httpx

        library = httpx
    return library.AsyncClient(
        transport=_transport(library),
        timeout=library.Timeout(_TIMEOUT_S, connect=_CONNECT_S),
        follow_redirects=False,  # what was said is for nobody else
    )


def _transport(library: Any) -> Any:
    """A transport of `library` (httpx2 or httpx, which have the same names) whose answers end."""

    class Stream(library.AsyncByteStream):  # type: ignore[misc]
        def __init__(self, response: Any) -> None:
            self._response = response

        async def __aiter__(self) -> AsyncIterator[bytes]:
            streamed = self._response.headers.get("content-type", "").startswith("text/event-stream")
            limit = _MAX_STREAM_BYTES if streamed else _MAX_BYTES
            size = frame = 0
            async for piece in self._response.aiter_bytes():
                size += len(piece)
                end = max(piece.rfind(mark) for mark in _FRAME_ENDS)
                frame = len(piece) - end if end >= 0 else frame + len(piece)
                if size > limit or (streamed and frame > _MAX_EVENT_BYTES):
                    raise AnswerTooLongError(
                        f"the answer is too long (limit {limit // 1_000_000} MB, unpacked)"
                    )
                yield piece

        async def aclose(self) -> None:
            await self._response.aclose()

    class Transport(library.AsyncHTTPTransport):  # type: ignore[misc]
        async def handle_async_request(self, request: Any) -> Any:
            response = await super().handle_async_request(request)
            response.request = request
            said = [
                (name, value)
                for name, value in response.headers.multi_items()
                if name not in ("content-encoding", "content-length")
            ]
            if len(response.headers.get_list("content-encoding", split_commas=True)) > 1:
                await response.aclose()
                raise AnswerTooLongError("the answer is packed more than once")
            return library.Response(
                response.status_code, headers=said, stream=Stream(response), extensions=response.extensions
            )

    return Transport(limits=library.Limits(max_connections=100, max_keepalive_connections=20), trust_env=True)
