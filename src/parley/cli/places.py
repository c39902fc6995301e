"""`parley places`: what people put on a map, as an object map for a robot's folder."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from parley.agents.places import read_places
from parley.config import SystemConfig
from parley.errors import ConfigError
from parley.files import replace_text
from parley.site import Site

__all__ = ["command"]


def command(
    data: Annotated[Path, typer.Argument(help="The data folder of a system.")],
    out: Annotated[Path, typer.Argument(help="The object map (JSON), for a robot's folder.")],
    site: Annotated[
        Path | None, typer.Option(help="Folder whose object map it was put on; default: nothing was there.")
    ] = None,
    map_name: Annotated[str, typer.Option("--map", help="Which map, if people changed several.")] = "",
) -> None:
    """Take what people put on a map as an object map."""
    file = SystemConfig(data_dir=data).places_file
    kept = read_places(file) if file is not None and file.exists() else {}
    if not kept:
        raise ConfigError(f"nobody put anything on a map: {data} holds no places")
    name = map_name or (next(iter(kept)) if len(kept) == 1 else "")
    if name not in kept:
        raise ConfigError(f"say --map with one of: {', '.join(sorted(kept))}")
    known = (Site.load(site) if site is not None else Site()).objects
    whole = kept[name].applied(known)
    try:
        replace_text(out, json.dumps(whole.to_json(), ensure_ascii=False, indent=1) + "\n")
    except OSError as error:
        raise ConfigError(f"{out} cannot be written: {error.strerror}") from error
    typer.echo(f"{name}: {len(whole.objects)} things, {len(whole.areas)} rooms")
