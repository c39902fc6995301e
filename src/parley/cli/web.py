"""Serving the page: its settings on the command line, what is printed, and how it ends; `parley web`."""

from __future__ import annotations

import asyncio
import gc
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

import typer

from parley.errors import ConfigError
from parley.extras import needs
from parley.messages.principal import ROLES, Role

if TYPE_CHECKING:
    from parley.web.server import WebServer

__all__ = [
    "PORT", "LanOption", "NoOpenOption", "PasswordFileOption", "PortOption", "app", "page_settings",
    "serve_until_interrupted",
]  # fmt: skip

PORT: Final = 8400

NoOpenOption = Annotated[bool, typer.Option("--no-open", help="Do not open the page in a browser.")]
PortOption = Annotated[
    int | None, typer.Option(min=0, max=65535, help=f"Port of the page; default: {PORT}, or a free one.")
]
LanOption = Annotated[
    bool, typer.Option("--lan", help="Let phones in this network in: HTTPS, with a code to sign in.")
]
PasswordFileOption = Annotated[
    Path | None, typer.Option(help="File with a password to sign in with, here too.")
]

app = typer.Typer(no_args_is_help=True)


@app.command("openapi")
def openapi() -> None:
    """Print the description of the page's interface (OpenAPI)."""
    with needs("web"):
        from parley.web.app import openapi_text

    typer.echo(openapi_text(), nl=False)


def page_settings(
    *,
    port: int | None,
    lan: bool,
    password_file: Path | None,
    pair_as: str,
    certificate: Path | None,
    key: Path | None,
    origins: Sequence[str],
    without: str,
) -> dict[str, Any]:
    """The settings of the page as they were given on the command line.

    Raises:
        ConfigError: One of them is wrong.
    """
    from parley.web.config import MODULES

    left_out = {part.strip() for part in without.split(",") if part.strip()}
    if unknown := sorted(left_out - set(MODULES)):
        raise ConfigError(f"--without: there is no part {unknown[0]!r}; there are: {', '.join(MODULES)}")
    if (certificate is None) != (key is None):
        raise ConfigError("--cert and --key go together")
    return {
        "port": PORT if port is None else port,
        "lan": lan,
        "password": _password(password_file),
        "pair_as": _role(pair_as),
        "certificate": certificate,
        "key": key,
        "origins": tuple(origins),
        "without": frozenset(left_out),
    }


def _password(file: Path | None) -> str:
    if file is None:
        return ""
    try:
        password = file.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"--password-file: {file} cannot be read: {error}") from error
    if len(password) < 8:
        raise ConfigError(f"--password-file: the password in {file} is shorter than 8 characters")
    return password


def _role(text: str) -> Role:
    found = next((role for role in ROLES if role == text), None)
    if found is None:
        raise ConfigError(f"--pair-as: there is no role {text!r}; there are: {', '.join(ROLES)}")
    return found


async def serve_until_interrupted(server: WebServer, *, opens: bool) -> None:
    """Say where the page is, open it, and wait until somebody ends it.

    Args:
        server: Open.
        opens: Whether to open the page in a browser.
    """
    if server.instead_of:
        typer.echo(
            f"Port {server.instead_of} is taken (perhaps Parley runs already), so another one is used."
        )
    typer.echo(f"The page is at {server.url}")
    code = server.pairing_code
    for address in server.backend.addresses:
        typer.echo(f"From other devices: {address}")
    if server.fingerprint:
        typer.echo(f"Browsers warn once, because this machine made its own certificate: {server.fingerprint}")
    way = server.backend.sessions.way
    if way == "account":
        typer.echo("People sign in with their accounts.")
    elif way == "password":
        typer.echo("Everybody signs in with the password of --password-file, and may do everything then.")
    elif way == "open":
        folder = server.backend.config.data_dir
        how = f"parley people add NAME --data {shlex.quote(str(folder))}" if folder else "its page “People”"
        typer.echo(f"Everybody at this computer may do everything. To make accounts: {how}")
    if code:
        _show_code(server, code)
        server.backend.sessions.codes.on_new = lambda new: _show_code(server, new)
    elif server.backend.addresses:
        _show_qr(server.backend.addresses[0])
    elif not server.backend.config.lan:
        typer.echo("For a phone or tablet in the same network, start it with --lan.")
    typer.echo("Ctrl-C ends it.")
    sys.stdout.flush()
    if opens:
        await asyncio.to_thread(_open_page, server.url)
    # What was loaded stays to the end; looking through it for garbage again and again held everything up.
    gc.freeze()
    await asyncio.Event().wait()


def _show_code(server: WebServer, code: str) -> None:
    from parley.web.addresses import paired

    typer.echo(f"Code to sign in, for one device: {code}")
    if server.backend.addresses:
        _show_qr(paired(server.backend.addresses[0], code))
    sys.stdout.flush()


def _show_qr(text: str) -> None:
    from parley.web.addresses import qr_text

    if sys.stdout.isatty():
        typer.echo(qr_text(text))


def _open_page(url: str) -> None:
    import webbrowser

    webbrowser.open(url)
