"""The backends that the contract suite runs against. A new backend joins by adding its factory here."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import dataclass

from parley.transport.base import Transport
from parley.transport.local import LocalTransport


@dataclass(frozen=True)
class Network:
    """Two parties on one network; in one process they may be the same object."""

    here: Transport
    there: Transport


@asynccontextmanager
async def local() -> AsyncIterator[Network]:
    async with LocalTransport() as transport:
        yield Network(transport, transport)


BACKENDS: dict[str, Callable[[], AbstractAsyncContextManager[Network]]] = {"local": local}


async def until(condition: Callable[[], object], *, within_s: float = 10.0) -> None:
    """Wait until `condition` holds; fails the test if it never does."""
    async with asyncio.timeout(within_s):
        while not condition():  # noqa: ASYNC110 - any condition, of any backend
            await asyncio.sleep(0.001)
