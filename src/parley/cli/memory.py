"""`parley memory`: look into a memory file and change it, also while a system runs on it."""

from __future__ import annotations

import base64
import os
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from parley.cli.confirm import confirm
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, fail, quiet_logs
from parley.clock import WallClock
from parley.errors import ConfigError
from parley.memory.pictures import MAX_BYTES, PictureError, modest_jpeg
from parley.memory.store import MemoryStore
from parley.memory.transfer import ExportFile, read_export
from parley.messages.memory import MemoryEntry

__all__ = ["app"]

T = TypeVar("T")

app = typer.Typer(no_args_is_help=True)

DataOption = Annotated[
    Path | None,
    typer.Option("--data", "--data-dir", help="The data folder of a system (it holds memory.db)."),
]
FileOption = Annotated[Path | None, typer.Option("--file", help="The memory file itself.")]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object per line.")]
ScopeOption = Annotated[
    str | None, typer.Option(help="A robot's name: its own memories and everybody's; '' for everybody's.")
]
YesOption = Annotated[bool, typer.Option("--yes", "-y", help="Do not ask.")]
NameArgument = Annotated[str, typer.Argument(help="The memory's name.")]


@app.command("list")
def list_memories(
    data: DataOption = None,
    file: FileOption = None,
    scope: ScopeOption = None,
    history: Annotated[
        bool, typer.Option("--history", help="What was replaced or forgotten instead.")
    ] = False,
    name: Annotated[str, typer.Option(help="Only this memory.")] = "",
    json: JsonOption = False,
) -> None:
    """List everything that is remembered, oldest first."""

    async def work(store: MemoryStore) -> list[MemoryEntry]:
        if not history:
            return [entry for entry in await store.all(scope) if name in ("", entry.name)]
        return [e for e in await store.history(name) if scope is None or e.scope in ("", scope)]

    found = _with_store(data, file, work)
    for entry in found:
        _show(entry, json)
    if not found and not json:
        typer.echo("Nothing is remembered.", err=True)


@app.command("search")
def search(
    words: Annotated[str, typer.Argument(help="What the memories should be about.")],
    data: DataOption = None,
    file: FileOption = None,
    scope: ScopeOption = None,
    limit: Annotated[int, typer.Option(min=1, max=1000)] = 20,
    json: JsonOption = False,
) -> None:
    """Find memories by their words, best first. Exit code 1 if nothing is found."""
    found = _with_store(data, file, lambda store: store.search(words, limit, scope))
    for entry in found:
        _show(entry, json)
    if not found:
        raise typer.Exit(fail("nothing is remembered about that", code=1))


@app.command("add")
def add(
    name: NameArgument,
    text: Annotated[str, typer.Argument(help="What is to be remembered.")] = "",
    image: Annotated[Path | None, typer.Option(help="A JPEG or PNG instead of a text.")] = None,
    info: Annotated[str, typer.Option(help="One line saying what it is about.")] = "",
    scope: Annotated[str, typer.Option(help="The robot it is for; everybody if left out.")] = "",
    source: Annotated[str, typer.Option(help="Who says so.")] = "operator",
    data: DataOption = None,
    file: FileOption = None,
    json: JsonOption = False,
) -> None:
    """Remember something; a memory of the same name is replaced and kept in the history."""
    if bool(text) == (image is not None):
        raise ConfigError("give either a text or --image")
    if not 0 < len(name) <= 200:
        raise ConfigError("a name has 1 to 200 characters")
    content = _read_image(image) if image is not None else text
    entry = MemoryEntry(
        name=name,
        type="text" if image is None else "image",
        data=content,
        info=info or text or name,
        scope=scope,
        source=source,
    )
    _show(_with_store(data, file, lambda store: store.add(entry), create=True), json)


@app.command("forget")
def forget(
    name: NameArgument,
    data: DataOption = None,
    file: FileOption = None,
    scope: Annotated[str | None, typer.Option(help="Only in this scope; all if left out.")] = None,
    yes: YesOption = False,
) -> None:
    """Forget a memory; the history keeps it. Exit code 1 if there is none."""
    confirm(f"Forget {name!r}?", yes=yes)
    if not _with_store(data, file, lambda store: store.remove(name, scope)):
        raise typer.Exit(fail(f"nothing is remembered under the name {name!r}", code=1))


@app.command("restore")
def restore(
    name: NameArgument,
    data: DataOption = None,
    file: FileOption = None,
    scope: Annotated[str, typer.Option(help="The robot it was for.")] = "",
    json: JsonOption = False,
) -> None:
    """Remember again what was forgotten. Exit code 1 if there is nothing to restore."""
    entry = _with_store(data, file, lambda store: store.restore(name, scope))
    if entry is None:
        raise typer.Exit(fail(f"{name!r} is still remembered, or never was", code=1))
    _show(entry, json)


@app.command("export")
def export(
    target: Annotated[Path, typer.Argument(help="The JSON file to write; - for the output.")],
    data: DataOption = None,
    file: FileOption = None,
    history: Annotated[bool, typer.Option("--history", help="With what was replaced or forgotten.")] = False,
    yes: YesOption = False,
) -> None:
    """Write everything that is remembered, pictures included, as JSON."""

    async def work(store: MemoryStore) -> ExportFile:
        older = await store.history() if history else []
        now = WallClock().unix_ms()
        return ExportFile(exported_unix_ms=now, memories=tuple(await store.all()), history=tuple(older))

    text = _with_store(data, file, work).model_dump_json(indent=1) + "\n"
    if str(target) == "-":
        typer.echo(text, nl=False)
        return
    if target.exists():
        confirm(f"Replace {target}?", yes=yes)
    _write(target, text)


@app.command("import")
def import_memories(
    source: Annotated[Path, typer.Argument(help="A file that `export` wrote.")],
    data: DataOption = None,
    file: FileOption = None,
    yes: YesOption = False,
    json: JsonOption = False,
) -> None:
    """Take over exported memories: of one name the later fact wins, the other goes to the history."""
    exported = read_export(source)
    confirm(f"Take over {len(exported.memories)} memories?", yes=yes)
    counts = _with_store(
        data, file, lambda store: store.merge(exported.memories, exported.history), create=True
    )
    facts = {name: getattr(counts, name) for name in ("added", "replaced", "kept", "unchanged")}
    if json:
        emit_json(facts)
    else:
        typer.echo(", ".join(f"{count} {name}" for name, count in facts.items()))


def _with_store(
    data: Path | None,
    file: Path | None,
    work: Callable[[MemoryStore], Awaitable[T]],
    *,
    create: bool = False,
) -> T:
    if (data is None) == (file is None):
        raise ConfigError("say where the memories are: --data FOLDER or --file FILE")
    path = file if file is not None else (data or Path()) / "memory.db"
    if not create and not path.exists():
        raise ConfigError(f"there is no {path.name} in {path.parent}")

    quiet_logs()

    async def run() -> T:
        async with await MemoryStore.open(path, WallClock()) as store:
            if store.notice:
                raise ConfigError(store.notice)
            return await work(store)

    return on_loop(run())


def _show(entry: MemoryEntry, as_json: bool) -> None:
    if as_json:
        emit_json(entry.model_dump())
        return
    scope = f" [{entry.scope}]" if entry.scope else ""
    content = entry.data if entry.type == "text" else f"(a picture) {entry.info}"
    typer.echo(f"{entry.name}{scope}: {content}")


def _read_image(path: Path) -> str:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ConfigError(f"{path}: the picture is too large (more than {MAX_BYTES // 1024 // 1024} MB)")
        return modest_jpeg(base64.b64encode(path.read_bytes()).decode("ascii"))
    except OSError as error:
        raise ConfigError(f"{path} cannot be read: {error.strerror}") from error
    except PictureError as error:
        raise ConfigError(f"{path}: {error}") from error


def _write(target: Path, text: str) -> None:
    """Whole or not at all: what was there stays until the new text is on the disk."""
    beside = target.with_name(f".{target.name}.{os.getpid()}")
    try:
        with beside.open("w", encoding="utf-8") as opened:
            opened.write(text)
            opened.flush()
            os.fsync(opened.fileno())
        beside.replace(target)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise ConfigError(f"{target} cannot be written: {error.strerror}") from error
