"""`parley doctor`: what is installed, reachable and missing, and how to get it."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

import parley.web
from parley.cli.demo import data_folder
from parley.cli.language import KeyFileOption, LanguageOption, language_settings
from parley.cli.output import emit_json, quiet_logs
from parley.cli.web import PORT
from parley.doctor import Finding, Subject, examine

__all__ = ["register"]

_MARKS = {"ok": "✓", "missing": "✗", "wrong": "✗", "unused": "○"}
_WORDS = {"ok": "ok", "missing": "missing", "wrong": "wrong", "unused": "not used"}


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("doctor")(doctor)


def doctor(
    data: Annotated[
        Path | None, typer.Option(help="Folder for memories; default: the demonstration's.")
    ] = None,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port of the page.")] = PORT,
    language: LanguageOption = "offline",
    key_file: KeyFileOption = None,
    json: Annotated[bool, typer.Option("--json", help="One JSON object per line.")] = False,
) -> None:
    """Check this machine. Exit code 1: something is missing without which Parley does not work."""
    quiet_logs()
    language_settings(language, key_file)
    subject = Subject(
        data_dir=data or data_folder("nursing-home"),
        static_dir=Path(parley.web.__file__).parent / "static",
        port=port,
        language=language,
        key_file=key_file,
    )
    hindered = False
    for finding in examine(subject):
        hindered |= finding.hinders
        if json:
            emit_json(asdict(finding))
        else:
            _tell(finding)
    raise typer.Exit(1 if hindered else 0)


def _tell(finding: Finding) -> None:
    mark, word = _MARKS[finding.state], _WORDS[finding.state]
    typer.echo(f"{mark} {finding.subject:<12} {word:<9} {finding.text}")
    if finding.remedy:
        typer.echo(f"  {'':<22} → {finding.remedy}")
