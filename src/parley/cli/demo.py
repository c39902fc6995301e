"""`parley demo`: everything in one process; on a page, in the terminal, or playing a script."""

from __future__ import annotations

import os
import signal
import tempfile
from pathlib import Path
from typing import Annotated, Any

import typer

from parley.cli.choosing import (
    ConfigOption,
    EmbeddingsKeyOption,
    EmbeddingsOption,
    KeyFileOption,
    LangOption,
    LanguageOption,
    embedding_settings,
    language_settings,
)
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, fail, quiet_logs
from parley.cli.web import (
    LanOption,
    NoOpenOption,
    PasswordFileOption,
    PortOption,
    page_settings,
    serve_until_interrupted,
)
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, Demo, load_demo
from parley.demos.runner import StoryResult, play
from parley.demos.story import Story, Variant
from parley.errors import ConfigError
from parley.extras import needs
from parley.system import System
from parley.terminal import TerminalClient

__all__ = ["command", "data_folder"]


def command(
    name: Annotated[
        str, typer.Argument(help=f"One of: {', '.join(DEMOS)}; or a folder with your own world.")
    ] = "nursing-home",
    script: Annotated[
        bool, typer.Option("--script", help="Play the demonstration's story (or STORY) instead of chatting.")
    ] = False,
    story: Annotated[
        Path | None, typer.Argument(help="A story file for --script; default: the demonstration's own.")
    ] = None,
    variant: Annotated[str, typer.Option(help="Play this variant of the story.")] = "",
    json: Annotated[bool, typer.Option("--json", help="One JSON object per event.")] = False,
    terminal: Annotated[bool, typer.Option("--terminal", help="Chat in the terminal instead.")] = False,
    no_open: NoOpenOption = False,
    port: PortOption = None,
    lan: LanOption = False,
    password_file: PasswordFileOption = None,
    pair_as: Annotated[
        str, typer.Option(help="What a code lets a device be: viewer, operator or supervisor.")
    ] = "operator",
    cert: Annotated[
        Path | None, typer.Option(help="Certificate for HTTPS (PEM), instead of a made one.")
    ] = None,
    key: Annotated[Path | None, typer.Option(help="Its private key (PEM).")] = None,
    origin: Annotated[
        list[str] | None, typer.Option(help="Another origin whose pages may use this server; repeatable.")
    ] = None,
    without: Annotated[str, typer.Option(help="Parts of the page to leave out, e.g. memory,map.")] = "",
    speed: Annotated[
        float | None,
        typer.Option(help="Simulated seconds per second; default: 1 when chatting, full speed for scripts."),
    ] = None,
    robots: Annotated[
        str,
        typer.Option(
            help="Which of the world's robots there are, with commas; default: on the page all of them."
        ),
    ] = "",
    seed: Annotated[
        int | None, typer.Option(help="Another run: other start poses, noise and times of events.")
    ] = None,
    config: ConfigOption = None,
    data: Annotated[
        Path | None, typer.Option(help="Folder for memories; default: kept for chatting, fresh for scripts.")
    ] = None,
    actions: Annotated[
        Path | None, typer.Option(help="Folder with more actions: Python files; watched while it runs.")
    ] = None,
    ask_first: Annotated[
        bool, typer.Option("--ask-first", help="Show each plan and wait for your yes.")
    ] = False,
    language: LanguageOption = "",
    key_file: KeyFileOption = None,
    embeddings: EmbeddingsOption = "",
    embeddings_key_file: EmbeddingsKeyOption = None,
    lang: LangOption = None,
    verbose: Annotated[bool, typer.Option("--verbose", help="Show the log.")] = False,
) -> None:
    """Run a demonstration, or your own world: no ROS, no key, no GPU, no network."""
    quiet_logs(verbose)
    loaded = load_demo(name)
    if speed is not None and speed <= 0:
        raise ConfigError("--speed must be a positive number")
    wished = {"seed": seed, "approval": "ask_first" if ask_first else None, "actions_dir": actions}
    settings: dict[str, Any] = {name: value for name, value in wished.items() if value is not None}
    settings |= language_settings(language, key_file)
    settings |= embedding_settings(embeddings, embeddings_key_file)
    given = SystemConfig() if config is None else SystemConfig.load(config)
    chosen = given.changed(settings)
    named = [robot.strip() for robot in robots.split(",") if robot.strip()]
    if script and named:
        raise ConfigError("--robots does not go with --script: a story has the robots that it tells of")
    if script:
        played = _script(loaded, story, variant, chosen.changed({"speed": speed}), data, json)
        raise typer.Exit(on_loop(played))
    if story is not None or variant:
        raise ConfigError("a story file and --variant go with --script")
    chosen = loaded.settled(chosen)
    folder = data or chosen.data_dir or data_folder(loaded.folder_name)
    chosen = chosen.changed({"data_dir": folder} | ({} if speed is None else {"speed": speed}))
    if named or not terminal:
        loaded = loaded.with_robots(named or loaded.everybody)
    if terminal:
        on_loop(_chat(loaded, chosen, lang))
        return
    page = page_settings(
        port=port,
        lan=lan,
        password_file=password_file,
        pair_as=pair_as,
        certificate=cert,
        key=key,
        origins=origin or (),
        without=without,
    )
    page |= {"examples": loaded.examples, "tour": loaded.tour, "data_dir": folder, "fresh_robots": True}
    on_loop(_serve(loaded, chosen, page, port_is_wish=port is None, opens=not no_open))


async def _script(
    demo: Demo, file: Path | None, variant: str, settings: SystemConfig, data: Path | None, as_json: bool
) -> int:
    story = Story.load(file) if file is not None else demo.story
    with tempfile.TemporaryDirectory(prefix="parley-") as fresh:
        # A story begins with nothing that an earlier run left, whatever the settings say.
        config = settings.changed({"data_dir": data or Path(fresh), "memory": None})

        def make_system(different: Variant) -> System:
            return demo.system_for(story, config, different)

        emit = emit_json if as_json else _tell
        result = await play(story, make_system, variant=variant, emit=emit)
    if not result.held:
        return fail(_verdict(result), code=1)
    if not as_json:
        typer.echo(_verdict(result))
    return 0


def _verdict(result: StoryResult) -> str:
    factor = result.robot_s / result.wall_s if result.wall_s else 0.0
    times = f"{result.robot_s:.0f} s of robot time in {result.wall_s:.1f} s, {factor:.0f} times real time"
    return f"{result.text} ({times})" if result.held else f"{result.reason}: {result.text} ({times})"


def _tell(event: dict[str, Any]) -> None:
    """A story as a transcript for people."""
    match event["event"]:
        case "operator":
            typer.echo(f"You: {event['text']}")
        case "said":
            typer.echo(f"{event['robot']}: {event['text']}")
        case "plan" if event["steps"]:
            typer.echo("  " + " → ".join(f"{step['action']} ({step['state']})" for step in event["steps"]))
        case "restart":
            typer.echo("— everything is shut down and started again —")


def data_folder(name: str) -> Path:
    """Where a demonstration keeps what is remembered (XDG base directories)."""
    base = os.environ.get("XDG_DATA_HOME")
    return (Path(base) if base else Path.home() / ".local" / "share") / "parley" / name


async def _chat(demo: Demo, config: SystemConfig, lang: str | None) -> None:
    async with demo.system(config) as system:
        client = TerminalClient(system.transport, lang=lang)
        broken_off = await client.run(greeting=list(demo.examples), engine=system.language.label)
    if broken_off:
        raise typer.Exit(128 + signal.SIGINT)


async def _serve(
    demo: Demo, config: SystemConfig, page: dict[str, Any], *, port_is_wish: bool, opens: bool
) -> None:
    with needs("web"):
        from parley.web.config import WebConfig
        from parley.web.server import WebServer

    settings = WebConfig.of(config, **page)
    async with (
        demo.system(config) as system,
        WebServer(
            system.transport,
            settings,
            port_is_wish=port_is_wish,
            stop_line=system.stop_line,
            at_rest=system.at_rest,
            language=system.language,
        ) as server,
    ):
        if system.store is not None and system.store.notice:
            typer.echo(system.store.notice)
        if system.simulator is not None:  # the robots are not told
            system.simulator.on_event = lambda event: typer.echo(f"Meanwhile: {event.name}.")
        await serve_until_interrupted(server, opens=opens)
