"""Carries requests from the thread of the front to the loop of the product, and answers back."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

from starlette.types import ASGIApp, Receive, Scope, Send

__all__ = ["Bridge"]


class Bridge:
    """ASGI app of one loop that is answered by an app of another one.

    Every `receive` and `send` crosses and is waited for, so that a slow client slows down whoever sends to it
    and nobody else; errors cross as well, and whoever gives up on one side gives up on the other.

    Args:
        app: Answers, in `loop`.
        loop: Runs in another thread than whoever calls.
    """

    def __init__(self, app: ASGIApp, loop: asyncio.AbstractEventLoop) -> None:
        self._app, self._loop = app, loop

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Have one request or socket answered."""
        here = asyncio.get_running_loop()
        answer = _in_loop(self._loop, self._app)
        await answer(scope, _in_loop(here, receive), _in_loop(here, send))


def _in_loop(
    loop: asyncio.AbstractEventLoop, function: Callable[..., Awaitable[Any]]
) -> Callable[..., Awaitable[Any]]:
    """`function`, to be called from other loops."""

    async def run(*arguments: Any) -> Any:
        return await function(*arguments)

    async def call(*arguments: Any) -> Any:
        if loop.is_closed():
            raise ConnectionAbortedError("the server ends")
        return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(run(*arguments), loop))

    return call
