"""Takes connections in, one by one, each on a seat of its own; when it gets crowded, strangers give way."""

from __future__ import annotations

import asyncio
import errno
import socket
import ssl
from collections.abc import Callable
from typing import Any, Final

import structlog

from parley.web.crowd import Crowd, Seat

__all__ = ["Door", "raise_open_files"]

log = structlog.get_logger(__name__)

WAITING: Final = 2048
"""Connections that the operating system holds until they are taken in."""
HANDSHAKE_WITHIN_S: Final = 10.0
"""Wall time that a client is given to agree on encryption."""
FULL_PAUSE_S: Final = 0.05
"""Wall time until it is tried again, when the process may not open any more files."""
_FULL: Final = (errno.EMFILE, errno.ENFILE, errno.ENOBUFS, errno.ENOMEM)


def raise_open_files() -> int:
    """Let this process have as many files and connections open as it may; how many that are."""
    try:
        import resource
    except ImportError:  # Windows has no such limit
        return 8192
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = hard if hard != resource.RLIM_INFINITY else max(soft, 65_536)
    try:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
    except (OSError, ValueError) as error:  # some systems say there is no limit and have one all the same
        log.warning("the limit of open files stays", at=soft, reason=str(error))
        return soft
    return wanted


class Door:
    """Accepts connections on a bound socket, in the loop that it is opened in.

    Args:
        listening: Bound; closed by its owner.
        crowd: Says who has to go.
        make: Makes the protocol of a connection, which frees its seat when the connection is lost.
        ssl: How connections are encrypted, if they are.
    """

    def __init__(
        self,
        listening: socket.socket,
        crowd: Crowd,
        make: Callable[[Seat], asyncio.Protocol],
        *,
        ssl: ssl.SSLContext | None,
    ) -> None:
        self._listening, self._crowd, self._make, self._ssl = listening, crowd, make, ssl
        self._greeting: set[asyncio.Task[None]] = set()
        self._task: asyncio.Task[None] | None = None

    def open(self) -> None:
        """Begin to take in."""
        self._listening.setblocking(False)
        self._listening.listen(WAITING)
        self._task = asyncio.create_task(self._accept(), name="web door")

    def close(self) -> None:
        """Take in nobody any more; who is inside stays."""
        for task in (self._task, *self._greeting):
            if task is not None:
                task.cancel()

    async def wait_closed(self) -> None:
        """Wait until nothing is on the way in."""
        tasks = [task for task in (self._task, *self._greeting) if task is not None]
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _accept(self) -> None:
        loop = asyncio.get_running_loop()
        while True:
            try:
                connection, address = await loop.sock_accept(self._listening)
            except OSError as error:
                if error.errno in _FULL:
                    log.warning("no room for another connection", reason=error.strerror)
                    self._crowd.shed()
                    await asyncio.sleep(FULL_PAUSE_S)
                continue  # whoever knocked went away again
            connection.setblocking(False)
            task = asyncio.create_task(self._greet(connection, str(address[0])), name="web greeting")
            self._greeting.add(task)
            task.add_done_callback(self._greeting.discard)
            await asyncio.sleep(0)  # those who are inside come first, however many knock

    async def _greet(self, connection: socket.socket, address: str) -> None:
        task = asyncio.current_task()
        assert task is not None
        seat = self._crowd.sit(address, task.cancel)
        encrypted: dict[str, Any] = (
            {"ssl": self._ssl, "ssl_handshake_timeout": HANDSHAKE_WITHIN_S} if self._ssl else {}
        )
        loop = asyncio.get_running_loop()
        try:
            await loop.connect_accepted_socket(lambda: self._make(seat), connection, **encrypted)
        except (OSError, asyncio.CancelledError) as error:
            seat.free()
            connection.close()
            if isinstance(error, asyncio.CancelledError):
                raise
