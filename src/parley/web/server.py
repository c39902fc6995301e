"""Serves the page: a socket, HTTPS where others may come in, and an end in good order."""

from __future__ import annotations

import asyncio
import errno
import socket
import tempfile
from collections.abc import Callable
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Self

from starlette.types import ASGIApp

from parley.clock import Clock, WallClock
from parley.errors import ConfigError
from parley.gate.stop_line import StopLine
from parley.language.llm.in_use import EngineInUse
from parley.transport.base import Transport
from parley.web.addresses import LOCAL_NAMES, lan_addresses
from parley.web.app import create_app
from parley.web.backend import Backend
from parley.web.bridge import Bridge
from parley.web.config import WebConfig
from parley.web.front import Front
from parley.web.guard import Guard
from parley.web.live import Live
from parley.web.routes.access import principal_of
from parley.web.stop_desk import StopDesk
from parley.web.tls import fingerprint, made_certificate

__all__ = ["WebServer"]


class WebServer:
    """One server: its front in a thread, the rest in the loop it is opened in. Use as ``async with``.

    Args:
        transport: Opened by the caller.
        config: The settings.
        clock: Wall time.
        port_is_wish: Whether another port will do where the one of `config` is taken.
        around: Put around everything that is served in this loop, e.g. to measure it.
        stop_line: Of the engines, where they run in this process; stops go this way then.
        at_rest: Whether a robot of this process stands, measured now; may be called from any thread.
        language: What understands people, where that runs in this process: it can be changed then.
    """

    live: Live
    """The live stream, while the server is open."""

    def __init__(
        self,
        transport: Transport,
        config: WebConfig,
        *,
        clock: Clock | None = None,
        port_is_wish: bool = False,
        around: Callable[[ASGIApp], ASGIApp] = lambda app: app,
        stop_line: StopLine | None = None,
        at_rest: Callable[[str], bool | None] = lambda _: None,
        language: EngineInUse | None = None,
    ) -> None:
        self._config, self._clock, self._around = config, clock or WallClock(), around
        self._port_is_wish = port_is_wish
        self.is_open_to_others = config.lan or config.host not in (*LOCAL_NAMES, "")
        self.backend = Backend(
            transport,
            config,
            pairs=self.is_open_to_others,
            clock=self._clock,
            stop_line=stop_line,
            at_rest=at_rest,
            language=language,
        )
        self.instead_of = 0
        """The port that was wished for, where another program has it; else 0."""
        self.url = ""
        """Where the page is on this machine."""
        self.fingerprint = ""
        """Of the certificate, where it was made here."""
        self._stack = AsyncExitStack()

    @property
    def pairing_code(self) -> str:
        """What the next device signs in with, where no password was given and one has to sign in."""
        return self.backend.sessions.code

    async def __aenter__(self) -> Self:
        try:
            await self._open()
        except BaseException:
            await self._stack.aclose()
            raise
        return self

    async def __aexit__(self, *exc: object) -> None:
        await self._stack.aclose()

    async def _open(self) -> None:
        config = self._config
        host = "0.0.0.0" if config.lan and config.host == "127.0.0.1" else config.host
        listening = _listen(host, config.port, other_port_will_do=self._port_is_wish)
        self._stack.callback(listening.close)
        port = listening.getsockname()[1]
        self.instead_of = config.port if config.port not in (0, port) else 0
        others = lan_addresses() if self.is_open_to_others else ()
        names = list(dict.fromkeys([*LOCAL_NAMES, *others, *_host_names(config)]))
        files = await self._certificate(names) if self.is_open_to_others or config.certificate else None
        scheme = "https" if files else "http"
        shown = config.host if config.host not in ("0.0.0.0", "::") and not config.lan else "127.0.0.1"
        self.url = f"{scheme}://{f'[{shown}]' if ':' in shown else shown}:{port}/"
        self.backend.addresses = tuple(f"{scheme}://{name}:{port}/" for name in others)
        await self._stack.enter_async_context(self.backend)
        self.live = live = await self._stack.enter_async_context(Live(self.backend))
        app = self._around(create_app(self.backend, live))
        guard = Guard(
            StopDesk(
                Bridge(app, asyncio.get_running_loop()),
                self.backend.stopper,
                lambda scope: principal_of(self.backend.sessions, scope),
            ),
            self.backend.sessions,
            self._clock,
            hosts=names,
            origins=config.origins,
            https=files is not None,
        )
        front = Front(guard, listening, config, files)
        self._stack.push_async_callback(front.close)
        await front.open()
        self._stack.push_async_callback(live.close)

    async def _certificate(self, names: list[str]) -> tuple[Path, Path]:
        config = self._config
        if config.certificate is not None:
            if config.key is None:
                raise ConfigError("--cert needs --key, the file with the certificate's private key")
            for file in (config.certificate, config.key):
                if not file.is_file():
                    raise ConfigError(f"there is no file {file}")
            return config.certificate, config.key
        folder = config.data_dir
        if folder is None:
            folder = Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="parley-")))
        files = await asyncio.to_thread(made_certificate, folder, names, self._clock.unix_ms())
        self.fingerprint = fingerprint(files[0])
        return files


def _listen(host: str, port: int, *, other_port_will_do: bool) -> socket.socket:
    """A bound socket.

    Raises:
        ConfigError: The address or port cannot be had.
    """
    try:
        return _bind(host, port)
    except OSError as error:
        if error.errno == errno.EADDRINUSE and other_port_will_do and port:
            return _bind(host, 0)
        hint = "; choose another with --port" if error.errno == errno.EADDRINUSE else ""
        raise ConfigError(f"cannot listen on {host} port {port}: {error.strerror or error}{hint}") from error


def _bind(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((host, port))
    except OSError:
        listening.close()
        raise
    return listening


def _host_names(config: WebConfig) -> list[str]:
    """Names under which this machine is reached, besides its addresses."""
    if not config.lan and config.host in LOCAL_NAMES:
        return []
    name = socket.gethostname()
    own = [config.host] if config.host not in ("0.0.0.0", "::") else []
    return [*own, name, f"{name}.local"]
