"""The websocket to a bridge: opened again whenever it is lost, and never waited for by whoever sends."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import ssl
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Final

import structlog
from websockets.asyncio.client import ClientConnection, connect
from websockets.asyncio.server import broadcast
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI

from parley.errors import InvalidMessageError, UnavailableError
from parley.transport.rosbridge.frames import MAX_BYTES, Assembly, Frame, read_frame, text_of, write_frame

__all__ = ["Line", "Outbox"]

OPENING_S: Final = 5.0
CLOSING_S: Final = 1.0
_AHEAD: Final = 64 * 1024
"""So many bytes the network may be behind; what comes then waits its turn."""
_PAUSES_S: Final = (0.1, 0.5, 1.0)
"""Between two attempts to get the connection back; the last again and again."""

log = structlog.get_logger(__name__)


class Outbox:
    """What of one sender waits for the network.

    Args:
        name: Of what is sent, for complaints.
        depth: How many frames may wait; of more the oldest go. None: all wait, for a connection too.
        urgent: Whether they go before all others.
    """

    def __init__(self, name: str, depth: int | None = None, *, urgent: bool = False) -> None:
        self.name, self.depth, self.urgent = name, depth, urgent
        self.waiting: deque[str] = deque()
        self.dropped = 0

    def lose(self) -> None:
        """One frame was not sent."""
        self.dropped += 1
        if self.dropped.bit_count() == 1:  # 1, 2, 4, 8, ...: a flood does not flood the log
            log.warning(
                "messages dropped: the bridge takes less than is sent", topic=self.name, dropped=self.dropped
            )


class Line:
    """One connection, used on the loop.

    Args:
        address: `ws://host:9090` or `wss://...`.
        silence_s: A bridge that gives no sign of life for so long is taken for gone.
        authority: Whose certificates are trusted with `wss`, a file; None: those the machine trusts.
        on_frame: Gets what comes.
        on_up: The connection is there, again: what was told the bridge is to be told once more.
        on_down: The connection is lost.
    """

    def __init__(
        self,
        address: str,
        *,
        silence_s: float,
        authority: Path | None,
        on_frame: Callable[[Frame], None],
        on_up: Callable[[], None],
        on_down: Callable[[], None],
    ) -> None:
        self.address = address
        self._silence_s, self._authority = silence_s, authority
        self._on_frame, self._on_up, self._on_down = on_frame, on_up, on_down
        self._connection: ClientConnection | None = None
        self._turns: tuple[deque[Outbox], deque[Outbox]] = (deque(), deque())
        """Outboxes whose frames wait: the urgent ones, the others."""
        self._to_write = asyncio.Event()
        self._all_sent = asyncio.Event()
        self._all_sent.set()
        self._control = Outbox("requests")
        self.bad_frames = 0
        """How many frames came that could not be read."""

    @property
    def up(self) -> bool:
        """Whether there is a connection."""
        return self._connection is not None

    async def open(self) -> None:
        """Connect, and stay connected from now on.

        Raises:
            UnavailableError: Nobody answers there.
        """
        try:
            self._begin(await self._connect())
        except (OSError, TimeoutError, InvalidHandshake, InvalidURI) as error:
            raise UnavailableError(
                f"no rosbridge answers at {self.address}: {error}; is rosbridge_server running there?"
            ) from error
        self._task = asyncio.create_task(self._stay(), name=f"rosbridge {self.address}")
        self._writer = asyncio.create_task(self._write(), name=f"rosbridge {self.address} out")

    async def close(self) -> None:
        """Send what waits, as far as the bridge takes it soon, and end."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(CLOSING_S if self.up else 0):
                await self._all_sent.wait()
        for task in (self._task, self._writer):
            task.cancel()
        await asyncio.gather(self._task, self._writer, return_exceptions=True)
        connection, self._connection = self._connection, None
        if connection is not None:
            await connection.close()

    def send(self, frame: Frame, outbox: Outbox | None = None) -> None:
        """Send as soon as the network takes it; returns at once."""
        outbox = outbox or self._control
        connection = self._connection
        if connection is None and outbox.depth is not None:
            outbox.lose()
            return
        if connection is None and outbox is self._control:
            return  # said again when the connection is back
        text = write_frame(frame)
        if connection is not None and not self._waits(outbox) and self._is_free(connection):
            broadcast((connection,), text)
            return
        outbox.waiting.append(text)
        turns = self._turns[0 if outbox.urgent else 1]
        if outbox.depth is not None and len(outbox.waiting) > outbox.depth:
            outbox.waiting.popleft()
            outbox.lose()
        else:
            turns.append(outbox)
        self._all_sent.clear()
        self._to_write.set()

    def _waits(self, outbox: Outbox) -> bool:
        """Whether somebody is before this one."""
        return bool(self._turns[0]) or (not outbox.urgent and bool(self._turns[1]))

    @staticmethod
    def _is_free(connection: ClientConnection) -> bool:
        return connection.transport.get_write_buffer_size() < _AHEAD

    async def _connect(self) -> ClientConnection:
        secure = self.address.startswith("wss:")
        trust = ssl.create_default_context(cafile=self._authority) if secure else None
        return await connect(
            self.address,
            ssl=trust,
            proxy=None,
            compression=None,
            open_timeout=OPENING_S,
            close_timeout=CLOSING_S,
            ping_interval=self._silence_s / 2,
            ping_timeout=self._silence_s / 2,
            max_size=MAX_BYTES,
        )

    def _begin(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._on_up()
        self._to_write.set()

    async def _stay(self) -> None:
        """Read until the connection is lost, then get another one, for as long as this is open."""
        while True:
            connection = self._connection
            if connection is not None:
                await self._read(connection)
                self._connection = None
                self._forget_requests()
                log.warning("the connection to the bridge is lost", address=self.address)
                self._on_down()
            await self._again()

    async def _again(self) -> None:
        for attempt in itertools.count():
            await asyncio.sleep(_PAUSES_S[min(attempt, len(_PAUSES_S) - 1)])
            try:
                connection = await self._connect()
            except (OSError, TimeoutError, InvalidHandshake) as error:
                if attempt.bit_count() == 1:
                    log.info("the bridge does not answer yet", address=self.address, why=str(error))
                continue
            log.warning("the connection to the bridge is back", address=self.address)
            self._begin(connection)
            return

    async def _read(self, connection: ClientConnection) -> None:
        pieces = Assembly()
        try:
            async for text in connection:
                self._take(text, pieces)
        except ConnectionClosed as closed:
            log.info("the bridge closed the connection", address=self.address, why=str(closed))

    def _take(self, text: str | bytes, pieces: Assembly) -> None:
        try:
            frame = read_frame(text)
            if text_of(frame, "op") == "fragment":
                whole = pieces.add(frame)
                if whole is None:
                    return
                frame = read_frame(whole)
            self._on_frame(frame)
        except InvalidMessageError as error:
            self.bad_frames += 1
            log.warning("what the bridge sent cannot be read", address=self.address, why=str(error))

    async def _write(self) -> None:
        while True:
            await self._to_write.wait()
            connection = self._connection
            turns = self._turns[0] or self._turns[1]
            if connection is None or not turns:
                self._to_write.clear()
                if not turns:
                    self._all_sent.set()
                continue
            outbox = turns.popleft()
            text = outbox.waiting.popleft()
            try:
                await connection.send(text)
            except ConnectionClosed:
                self._to_write.clear()
                if outbox.depth is None and outbox is not self._control:
                    outbox.waiting.appendleft(text)
                    turns.appendleft(outbox)

    def _forget_requests(self) -> None:
        """What waited for the lost connection is not sent with the next, but for what must not be lost."""
        for turns in self._turns:
            kept = [box for box in turns if box.depth is None and box is not self._control]
            for box in turns:
                if box not in kept:
                    box.waiting.clear()
            turns.clear()
            turns.extend(kept)
