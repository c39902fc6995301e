"""`parley audit`: who did what, whether the log is whole, and the log for others to read."""

from __future__ import annotations

import csv
import sys
from datetime import datetime
from pathlib import Path
from typing import Annotated, Final, Literal

import typer

from parley.cli.output import emit_json
from parley.errors import ConfigError, InvalidMessageError
from parley.gate.audit import Head, canonical
from parley.gate.audit_store import check_file, read_file
from parley.gate.audit_text import told, who_of
from parley.messages.audit import AuditEntry, GetAudit

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)

_PAGE: Final = 1000
_COLUMNS: Final = (
    "number", "time", "effect", "outcome", "kind", "name", "device", "role", "robot", "words", "reason",
    "digest", "detail", "hash",
)  # fmt: skip

Data = Annotated[Path, typer.Option(help="The data folder of a system (it holds audit.db).")]


@app.command()
def show(
    data: Data,
    robot: Annotated[str, typer.Option(help="Only about this robot.")] = "",
    by: Annotated[str, typer.Option(help="Only by this person, device or kind (person, engine, ...).")] = "",
    effect: Annotated[str, typer.Option(help="Only this, e.g. stop, approve, start.")] = "",
    since: Annotated[str, typer.Option(help="From this time on, e.g. 2026-03-01 or 2026-03-01T10:00.")] = "",
    until: Annotated[str, typer.Option(help="Before this time.")] = "",
    text: Annotated[str, typer.Option(help="Only with this in the words or facts.")] = "",
    limit: Annotated[int, typer.Option(help="How many, newest first.", min=1, max=1000)] = 50,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per entry.")] = False,
) -> None:
    """List what happened, newest first, one sentence each."""
    wanted = GetAudit(
        robot=robot, by=by, effect=effect, text=text, limit=limit,
        since_unix_ms=_moment(since, "--since"), until_unix_ms=_moment(until, "--until"),
    )  # fmt: skip
    found = read_file(data / "audit.db", wanted)
    if not found and not json:
        typer.echo("Nothing of that kind is written.", err=True)
    for entry in found:
        if json:
            emit_json(entry.model_dump(mode="json"))
        else:
            typer.echo(f"{entry.number:>6}  {_time(entry)}  {told(entry)}")


@app.command()
def verify(
    data: Data,
    mark: Annotated[
        list[str] | None,
        typer.Option(help="NUMBER:HASH that an earlier check printed; it must still be so."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="As one JSON object.")] = False,
) -> None:
    """Check that nothing was changed, removed or slipped in; exit code 1 if something was."""
    try:
        marks = tuple(Head.read(each) for each in mark or ())
    except InvalidMessageError as error:
        raise ConfigError(f"--mark: {error}") from error
    found = check_file(data / "audit.db", marks)
    if json:
        emit_json(found.model_dump(mode="json"))
    elif found.problem:
        typer.echo(f"The log is not whole. Entry {found.first_broken}: {found.problem}.")
    elif not found.entries:
        typer.echo("Nothing is written yet.")
    else:
        since = datetime.fromtimestamp(found.since_unix_ms / 1000)
        typer.echo(f"{found.entries} entries, unbroken since {since:%Y-%m-%d %H:%M}.")
        typer.echo(f"Keep this elsewhere to compare later: {found.last}")
    if found.problem:
        raise typer.Exit(1)


@app.command()
def export(
    data: Data,
    form: Annotated[
        Literal["csv", "json"], typer.Option("--form", help="csv, or json: one object per line.")
    ] = "csv",
    since: Annotated[str, typer.Option(help="From this time on.")] = "",
    until: Annotated[str, typer.Option(help="Before this time.")] = "",
) -> None:
    """Write everything to the standard output, newest first."""
    wanted = GetAudit(
        since_unix_ms=_moment(since, "--since"), until_unix_ms=_moment(until, "--until"), limit=_PAGE
    )
    table = csv.writer(sys.stdout)
    if form == "csv":
        table.writerow(_COLUMNS)
    while page := read_file(data / "audit.db", wanted):
        for entry in page:
            if form == "csv":
                table.writerow([_harmless(value) for value in _row(entry)])
            else:
                emit_json(entry.model_dump(mode="json"))
        wanted = wanted.model_copy(update={"before": page[-1].number})
        if wanted.before <= 1:
            break


def _row(entry: AuditEntry) -> list[str]:
    by = entry.by
    person = (by.kind, by.name, by.device, by.role) if by else (who_of(None), "", "", "")
    return [
        str(entry.number), _time(entry), entry.effect, entry.outcome, *person, entry.robot, entry.words,
        entry.reason, entry.digest, canonical(entry.detail), entry.hash,
    ]  # fmt: skip


def _harmless(value: str) -> str:
    """A cell that no spreadsheet takes for a formula."""
    return f"'{value}" if value[:1] in ("=", "+", "-", "@", "\t", "\r") else value


def _time(entry: AuditEntry) -> str:
    return datetime.fromtimestamp(entry.unix_ms / 1000).strftime("%Y-%m-%d %H:%M:%S")


def _moment(text: str, option: str) -> int:
    if not text:
        return 0
    try:
        return int(datetime.fromisoformat(text).timestamp() * 1000)
    except ValueError as error:
        raise ConfigError(f"{option}: “{text}” is no time; write 2026-03-01 or 2026-03-01T10:00") from error
