"""Connections that have a seat each; whoever sends a request too slowly is hung up on."""

from __future__ import annotations

import asyncio
from typing import Any

import h11
import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from uvicorn.server import ServerState

from parley.web.crowd import Seat

__all__ = ["SEAT", "PatientConfig", "seat_of"]

SEAT = "seat"
"""Under this name the state of each request has the `Seat` of its connection."""


def seat_of(scope: Any) -> Seat:
    """The seat of the connection of a request."""
    seat = scope["state"][SEAT]
    assert isinstance(seat, Seat)
    return seat


class PatientConfig(uvicorn.Config):
    """Settings of a server that waits only so long; see `uvicorn.Config` for the rest.

    Args:
        head_within_s: Wall time from the connection, or the first byte behind the request before, until the
            head of a request has come.
        body_idle_s: Wall time without any byte of a body that is still to come.
    """

    def __init__(self, *settings: Any, head_within_s: float, body_idle_s: float, **more: Any) -> None:
        super().__init__(*settings, **more)
        self.http, self.ws = _PatientProtocol, _SeatedSocket
        self.head_within_s, self.body_idle_s = head_within_s, body_idle_s

    def connection(self, state: ServerState, seat: Seat) -> asyncio.Protocol:
        """The protocol of a new connection."""
        return _PatientProtocol(self, state, {SEAT: seat})


class _PatientProtocol(H11Protocol):
    """One connection with a deadline for what the client has to send next."""

    config: PatientConfig
    _deadline: asyncio.TimerHandle | None = None
    _is_ours = True
    """Until the connection becomes a WebSocket, which has its own rules."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self.app_state[SEAT].leave = transport.abort
        self._expect()

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._expect()

    def connection_lost(self, exc: Exception | None) -> None:
        self._expect_nothing()
        self.app_state[SEAT].free()
        super().connection_lost(exc)

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        self._is_ours = False
        super().handle_websocket_upgrade(event)

    def _expect(self) -> None:
        """Set the deadline that what came so far calls for; one for a head that has begun stays."""
        if not self._is_ours:
            self._expect_nothing()
        elif self.conn.their_state is h11.SEND_BODY:
            self._expect_nothing()
            self._set(self.config.body_idle_s)
        elif self.conn.their_state is not h11.IDLE:
            self._expect_nothing()
        elif self._deadline is None:
            self._set(self.config.head_within_s)

    def _set(self, within_s: float) -> None:
        self._deadline = self.loop.call_later(within_s, self._give_up)

    def _give_up(self) -> None:
        self._deadline = None
        if self.flow.read_paused:  # it is us who take nothing at the moment
            self._set(self.config.body_idle_s)
        else:
            self.transport.close()

    def _expect_nothing(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None


class _SeatedSocket(WebSocketsSansIOProtocol):
    """A WebSocket on the seat of the connection that it was."""

    def connection_lost(self, exc: Exception | None) -> None:
        self.app_state[SEAT].free()
        super().connection_lost(exc)
