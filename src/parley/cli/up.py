"""`parley up`: what a file says that runs on this machine, as processes that are looked after."""

from __future__ import annotations

import asyncio
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Final

import typer

from parley.agents.notices import Notifier
from parley.cli.on_loop import BEAT_S, PULSE, on_loop
from parley.cli.output import quiet_logs
from parley.clock import Clock, WallClock
from parley.demos.catalogue import DEMOS
from parley.deployment import Deployment, PartToRun
from parley.errors import ConfigError, FileFormatError
from parley.network import transport_of
from parley.sentences import sentence

__all__ = ["command"]

AGAIN_S: Final = 1.0
"""Wall time before a part that ended is started again; doubles each time it ends soon."""
LATEST_S: Final = 30.0
ENDS_WITHIN_S: Final = 10.0
"""Wall time that a part has to close in order."""
BEGINS_WITHIN_S: Final = 60.0
"""Wall time a part may take until it gives its first sign of life, and"""
HANGS_AFTER_S: Final = 15.0
"""between two of them. A robot whose part hangs stands long before."""
_WRONG: Final = 2
"""Exit code of a part whose settings are wrong: starting it again would not help."""


def command(
    file: Annotated[Path, typer.Argument(help="Which part runs on which machine.")],
    machine: Annotated[str, typer.Option(help="Which of its machines this is; default: by its name.")] = "",
    check: Annotated[bool, typer.Option("--check", help="Say what would run here, and leave.")] = False,
    verbose: Annotated[bool, typer.Option("--verbose", help="Show the log.")] = False,
) -> None:
    """Run what belongs on this machine, and start again what ends."""
    quiet_logs(verbose)
    deployment = Deployment.load(file)
    here = deployment.machine(machine)
    parts = deployment.parts(here)
    if not parts:
        raise ConfigError(f"{file.name}: nothing runs on {here}")
    if check:
        for part in parts:
            typer.echo(f"{part.name}: parley {' '.join(part.arguments)}")
    if lacking := [str(FileFormatError(file.name, *one)) for one in _lacking(deployment, here)]:
        raise ConfigError("\n".join(lacking))
    if check:
        return
    on_loop(_run(deployment, here, parts, verbose))


def _lacking(deployment: Deployment, machine: str) -> Iterator[tuple[str, str]]:
    """Fields that name what is not on this machine, and why: all of them, before anything is started."""
    page = deployment.web
    secret = page.password_file if page is not None and page.machine == machine else None
    if secret is not None and not secret.is_file():
        yield "web.password_file", f"there is no file {secret}"
    for index, robot in enumerate(deployment.robots):
        if robot.machine != machine:
            continue
        if robot.world and robot.world not in DEMOS and not Path(robot.world).exists():
            known = ", ".join(DEMOS)
            yield f"robots[{index}].world", f"there is no folder {robot.world}, and no demonstration: {known}"
        file = robot.kind.rpartition(":")[0] if ":" in robot.kind else robot.kind
        if Path(file).suffix in (".py", ".yaml", ".yml") and not Path(file).is_file():
            yield f"robots[{index}].class", f"there is no file {file}"


async def _run(deployment: Deployment, machine: str, parts: Sequence[PartToRun], verbose: bool) -> None:
    with tempfile.TemporaryDirectory(prefix="parley-") as folder:
        files = [Path(folder) / name for name in ("first.yaml", "parley.yaml")]
        for file in files:
            text = deployment.settings_text(machine, first=file is files[0])
            file.write_text(text, encoding="utf-8")
        config = deployment.settings_of(machine, first=False)
        transport = transport_of(config, node="parley_up")
        notifier = Notifier(transport)
        notifier.speaks = config.speaks
        shared = ["--verbose"] if verbose else []
        try:
            async with transport, notifier, asyncio.TaskGroup() as group:
                for part in parts:
                    data, file = deployment.data / part.name.replace(" ", "-"), files[part is not parts[0]]
                    words = [*part.arguments, *shared, "--config", str(file), "--data", str(data)]
                    group.create_task(_look_after(part.name, words, notifier, WallClock()), name=part.name)
        except* ConfigError as wrong:
            raise wrong.exceptions[0] from None


async def _look_after(name: str, words: Sequence[str], notifier: Notifier, clock: Clock) -> None:
    """Keep one part running until this is cancelled.

    Raises:
        ConfigError: It cannot run, as something in the settings is wrong.
    """
    wait_s = AGAIN_S
    while True:
        began_s = clock.wall_s()
        code = await _until_it_ends(words)
        if code == _WRONG:
            raise ConfigError(f"{name} cannot run, see above")
        wait_s = AGAIN_S if clock.wall_s() - began_s > LATEST_S else min(2 * wait_s, LATEST_S)
        how = "hung" if code is None else f"has ended ({code})"
        typer.echo(f"parley: {name} {how} and is started again", err=True)
        await asyncio.sleep(wait_s)
        text = sentence("A part of me had ended by itself ({part}), and is started again.", part=name)
        if code is None:
            text = sentence("A part of me hung ({part}), and is started again.", part=name)
        notifier.tell(text, ())


async def _until_it_ends(words: Sequence[str]) -> int | None:
    """Run it in a session of its own, so that Ctrl-C reaches it only through us; its exit code.

    None: it hung, and was killed.
    """
    ours, its = os.pipe()
    loop, life = asyncio.get_running_loop(), asyncio.Event()
    try:
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "parley", *words, start_new_session=True, pass_fds=(its,),
            env=os.environ | {PULSE: str(its)},
        )  # fmt: skip
    finally:
        os.close(its)

    def heard() -> None:
        if os.read(ours, 1000):
            life.set()
        else:  # it has ended
            loop.remove_reader(ours)

    loop.add_reader(ours, heard)
    ending = asyncio.ensure_future(process.wait())
    within_s, silent_s = BEGINS_WITHIN_S, 0.0
    try:
        while silent_s < within_s:  # as looks taken: a time in which we hung ourselves says nothing of it
            look_s = min(BEAT_S, within_s)
            beating = asyncio.ensure_future(life.wait())
            await asyncio.wait((ending, beating), timeout=look_s, return_when=asyncio.FIRST_COMPLETED)
            beating.cancel()
            if ending.done():
                return ending.result()
            silent_s += look_s
            if life.is_set():
                life.clear()
                within_s, silent_s = HANGS_AFTER_S, 0.0
        process.kill()
        await ending
        return None
    finally:
        loop.remove_reader(ours)
        os.close(ours)
        if process.returncode is None:
            process.terminate()
            try:
                async with asyncio.timeout(ENDS_WITHIN_S):
                    await process.wait()
            except TimeoutError:
                process.kill()
                await process.wait()
