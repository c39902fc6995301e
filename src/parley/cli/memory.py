"""`parley memory`: look into a memory file."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Annotated

import typer

from parley.cli.output import emit_json
from parley.clock import WallClock
from parley.errors import ConfigError
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry

__all__ = ["app"]

app = typer.Typer(help="Look into a memory file.", no_args_is_help=True)

DataOption = Annotated[Path, typer.Option(help="The data folder of a system (it holds memory.db).")]


@app.command("list")
def list_memories(
    data: DataOption,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per memory.")] = False,
) -> None:
    """List everything that is remembered, oldest first."""
    for entry in asyncio.run(_all(data)):
        if json:
            emit_json(entry.model_dump())
        else:
            typer.echo(f"{entry.name}: {entry.data if entry.type == 'text' else entry.info}")


async def _all(data: Path) -> list[MemoryEntry]:
    file = data / "memory.db"
    if not file.exists():
        raise ConfigError(f"there is no memory.db in {data}")
    async with await MemoryStore.open(file, WallClock()) as store:
        return await store.all()
