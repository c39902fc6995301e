"""Serves the page: a socket, HTTPS where others may come in, and an end in good order."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import socket
import tempfile
from collections.abc import Callable, Iterator
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Final, Self

import uvicorn
from starlette.types import ASGIApp

from parley.clock import Clock, WallClock
from parley.errors import ConfigError
from parley.transport.base import Transport
from parley.web.addresses import LOCAL_NAMES, lan_addresses
from parley.web.app import create_app
from parley.web.backend import Backend
from parley.web.config import WebConfig
from parley.web.live import MAX_MESSAGE_BYTES, Live
from parley.web.patience import PatientConfig
from parley.web.tls import fingerprint, made_certificate

__all__ = ["WebServer"]

END_WITHIN_S: Final = 1
"""Wall time that open connections are given when the server ends."""


class WebServer:
    """One server in the loop it is opened in. Use as ``async with``.

    Args:
        transport: Opened by the caller.
        config: The settings.
        clock: Wall time.
        port_is_wish: Whether another port will do where the one of `config` is taken.
        around: Put around everything that is served, e.g. to measure it.
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
    ) -> None:
        self._config, self._clock, self._around = config, clock or WallClock(), around
        self._port_is_wish = port_is_wish
        self.is_open_to_others = config.lan or config.host not in (*LOCAL_NAMES, "")
        self.backend = Backend(transport, config, pairs=self.is_open_to_others, clock=self._clock)
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
        others = lan_addresses() if self.is_open_to_others else ()
        names = list(dict.fromkeys([*LOCAL_NAMES, *others, *_host_names(config)]))
        files = await self._certificate(names) if self.is_open_to_others or config.certificate else None
        scheme = "https" if files else "http"
        shown = config.host if config.host not in ("0.0.0.0", "::") and not config.lan else "127.0.0.1"
        self.url = f"{scheme}://{f'[{shown}]' if ':' in shown else shown}:{port}/"
        self.backend.addresses = tuple(f"{scheme}://{name}:{port}/" for name in others)
        await self._stack.enter_async_context(self.backend)
        self.live = live = await self._stack.enter_async_context(Live(self.backend))
        app = create_app(self.backend, live, hosts=names, origins=config.origins, https=files is not None)
        server = _Server(
            PatientConfig(
                self._around(app),
                log_config=None,
                access_log=False,
                server_header=False,
                proxy_headers=False,
                lifespan="off",
                ws="websockets-sansio",
                ws_max_size=MAX_MESSAGE_BYTES,
                ws_per_message_deflate=False,  # it cost more than all the rest; pictures are packed already
                limit_concurrency=1000,
                timeout_keep_alive=15,
                head_within_s=config.head_within_s,
                body_idle_s=config.body_idle_s,
                timeout_graceful_shutdown=END_WITHIN_S,
                ssl_certfile=files[0] if files else None,
                ssl_keyfile=files[1] if files else None,
            )
        )
        task = asyncio.create_task(server.serve(sockets=[listening]), name="web server")
        self._stack.push_async_callback(_end, server, task, live)
        ready = asyncio.create_task(server.ready.wait())
        await asyncio.wait([ready, task], return_when=asyncio.FIRST_COMPLETED)
        if not server.started:
            ready.cancel()
            await task
            raise ConfigError(f"the page cannot be served at {self.url}")

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


class _Server(uvicorn.Server):
    """Leaves the signals to whoever runs the loop, and says when it serves."""

    def __init__(self, config: uvicorn.Config) -> None:
        super().__init__(config)
        self.ready = asyncio.Event()

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        self.ready.set()

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


async def _end(server: _Server, task: asyncio.Task[None], live: Live) -> None:
    """Say goodbye to clients, then close; what hangs is cut off."""
    await live.close()
    server.should_exit = True
    _, late = await asyncio.wait([task], timeout=END_WITHIN_S + 0.5)
    if late:
        server.force_exit = True
        task.cancel()
    await asyncio.gather(task, return_exceptions=True)


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
