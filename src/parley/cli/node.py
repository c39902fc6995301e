"""`parley node`: one part of a system in a process of its own, on the network that the settings name."""

from __future__ import annotations

import asyncio
import signal
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from parley.cli.choosing import LangOption
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, quiet_logs
from parley.cli.web import (
    LanOption,
    NoOpenOption,
    PasswordFileOption,
    PortOption,
    page_settings,
    serve_until_interrupted,
)
from parley.config import NetworkSettings, SystemConfig
from parley.errors import ConfigError
from parley.extras import needs
from parley.network import transport_of
from parley.network_check import closed_doors
from parley.terminal import TerminalClient

if TYPE_CHECKING:
    from parley.system import System

__all__ = ["NetworkOption", "app", "networked", "run_system"]

app = typer.Typer(no_args_is_help=True)

NetworkOption = Annotated[
    Path, typer.Option("--config", help="File with the settings; network is among them.")
]


@app.command("terminal")
def terminal(
    config: NetworkOption,
    lang: LangOption = None,
) -> None:
    """Chat with the robots of another process or machine."""
    quiet_logs()
    on_loop(_chat(networked(config), lang))


@app.command("web")
def web(
    config: NetworkOption,
    data: Annotated[Path | None, typer.Option(help="Folder for accounts and conversations.")] = None,
    no_open: NoOpenOption = False,
    port: PortOption = None,
    lan: LanOption = False,
    password_file: PasswordFileOption = None,
    verbose: Annotated[bool, typer.Option("--verbose", help="Show the log.")] = False,
) -> None:
    """Serve the page for the robots of another process or machine."""
    quiet_logs(verbose)
    settings = networked(config)
    page = page_settings(
        port=port, lan=lan, password_file=password_file, pair_as="operator",
        certificate=None, key=None, origins=(), without="",
    )  # fmt: skip
    page |= {"data_dir": data}
    on_loop(_serve(settings, page, port_is_wish=port is None, opens=not no_open))


@app.command("agents")
def agents(
    config: NetworkOption,
    data: Annotated[Path | None, typer.Option(help="Folder for memories, rules and records.")] = None,
    verbose: Annotated[bool, typer.Option("--verbose", help="Show the log.")] = False,
) -> None:
    """Understand people, and plan and remember, for the robots of other processes."""
    from parley.system import System

    quiet_logs(verbose)
    settings = networked(config).changed({} if data is None else {"data_dir": data})
    on_loop(run_system(System(None, settings, part="agents")))


@app.command("router")
def router(
    config: NetworkOption,
    access: Annotated[
        Path | None, typer.Option(help="File with who may say, hear, ask and answer what.")
    ] = None,
    show: Annotated[
        bool,
        typer.Option("--show", help="Only print the rules made of that, for Zenoh's own routers."),
    ] = False,
) -> None:
    """Let the parts of a system find each other, and those reach each other that are clients."""
    quiet_logs()
    settings = networked(config)
    assert settings.network is not None
    network = settings.network.as_router
    if settings.network.rosbridge is not None or not network.listen:
        raise ConfigError(f"{config}: a router needs an address under `connect`, where the others find it")
    if access is not None:
        network = network.model_copy(update={"access": access})
    if show:
        emit_json({"access_control": _rules_of(network)})
    else:
        on_loop(_route(settings.model_copy(update={"network": network})))


def _rules_of(network: NetworkSettings) -> dict[str, Any]:
    if network.access is None:
        raise ConfigError("no file says who may what; name it with --access")
    with needs("zenoh"):
        from parley.transport.zenoh.access import AccessFile, access_control
    return access_control(network, AccessFile.load(network.access))


def networked(file: Path) -> SystemConfig:
    """Settings with a network among them.

    Raises:
        ConfigError: There is none, or the file is wrong.
    """
    settings = SystemConfig.load(file)
    if settings.network is None:
        raise ConfigError(f"{file} names no network; write there what all parts share, e.g. network: {{}}")
    return settings


async def run_system(system: System) -> None:
    """Open it, say so, and stay until somebody ends it."""
    async with system:
        who = ", ".join(system.robot_names)
        ready = f"{who} can be planned for" if who else "Robots can be talked to"
        typer.echo(f"{ready}{' by others who are let in' if await _is_shut_out(system.config) else ''}.")
        typer.echo("Ctrl-C ends it.")
        await asyncio.Event().wait()


async def _is_shut_out(settings: SystemConfig) -> bool:
    """Whether somebody this is to connect to does not let it in: a peer goes on, and tries for ever."""
    if settings.network is None:
        return False
    with needs("zenoh"):
        closed = await asyncio.to_thread(closed_doors, settings.network)
    for door in closed:
        typer.echo(f"{door.text}. It is tried on. {door.remedy}", err=True)
    return bool(closed)


async def _route(settings: SystemConfig) -> None:
    network = settings.network
    assert network is not None
    transport = transport_of(settings, node="parley_router")
    with ExitStack() as stack:
        if network.access is not None:
            from parley.transport.zenoh.denials import Denials

            stack.enter_context(Denials())
        async with transport:
            ruled = f" What {network.access.name} does not allow is denied." if network.access else ""
            typer.echo(f"Others find each other at {', '.join(network.listens)}.{ruled}")
            await asyncio.Event().wait()


async def _chat(settings: SystemConfig, lang: str | None) -> None:
    async with transport_of(settings, node="parley_terminal") as transport:
        await _is_shut_out(settings)
        broken_off = await TerminalClient(transport, lang=lang).run()
    if broken_off:
        raise typer.Exit(128 + signal.SIGINT)


async def _serve(settings: SystemConfig, page: dict[str, object], *, port_is_wish: bool, opens: bool) -> None:
    with needs("web"):
        from parley.web.config import WebConfig
        from parley.web.server import WebServer

    async with (
        transport_of(settings, node="parley_web") as transport,
        WebServer(transport, WebConfig.of(settings, **page), port_is_wish=port_is_wish) as server,
    ):
        await _is_shut_out(settings)
        await serve_until_interrupted(server, opens=opens)
