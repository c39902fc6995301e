"""`parley incidents`: what went wrong, what was tried, and how it ended."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json
from parley.clock import WallClock
from parley.errors import ConfigError
from parley.memory.incidents import IncidentStore
from parley.messages.incident import Incident

__all__ = ["command"]

_ENDINGS = {
    "open": "still open",
    "solved": "solved",
    "skipped": "left out",
    "cancelled": "cancelled",
    "replaced": "something else was ordered",
    "held": "not solved; the robot waited",
}


def command(
    data: Annotated[Path, typer.Option(help="The data folder of a system (it holds incidents.db).")],
    robot: Annotated[str, typer.Option(help="Only those of this robot.")] = "",
    limit: Annotated[int, typer.Option(help="How many, newest first.", min=1, max=1000)] = 100,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per incident.")] = False,
) -> None:
    """List what went wrong, newest first: what was tried, what was said, how it ended."""
    found = on_loop(_newest(data, robot, limit))
    if not found and not json:
        typer.echo("Nothing went wrong.", err=True)
    for incident in found:
        if json:
            emit_json(incident.model_dump(mode="json"))
        else:
            typer.echo("\n".join(_told(incident)))


def _told(incident: Incident) -> list[str]:
    when = datetime.fromtimestamp(incident.opened_unix_ms / 1000, UTC).strftime("%Y-%m-%d %H:%M:%S")
    lines = [f"{when} UTC  {incident.robot}: {incident.message}"]
    for attempt in incident.attempts:
        if attempt.asked:
            lines.append(f"    asked: {attempt.asked}")
        if attempt.answered:
            lines.append(f"    you said: {attempt.answered}")
        if attempt.tried:
            lines.append(f"    then: {attempt.tried}")
    lines.append(f"    {_ENDINGS[incident.ending]}{f'. {incident.note}' if incident.note else ''}")
    return lines


async def _newest(data: Path, robot: str, limit: int) -> tuple[Incident, ...]:
    file = data / "incidents.db"
    if not file.exists():
        raise ConfigError(f"there is no incidents.db in {data}")
    async with await IncidentStore.open(file, WallClock()) as store:
        return await store.newest(robot, limit)
