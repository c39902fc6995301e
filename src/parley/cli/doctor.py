"""`parley doctor`: what is installed, reachable and missing, and how to get it."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

import parley.web
from parley.cli.choosing import ConfigOption, KeyFileOption, LanguageOption, language_settings
from parley.cli.demo import data_folder
from parley.cli.output import emit_json, quiet_logs
from parley.cli.web import PORT
from parley.config import SystemConfig
from parley.doctor import Finding, Subject, examine
from parley.errors import ConfigError
from parley.robots.ros_file import RosRobotFile

__all__ = ["command"]

_MARKS = {"ok": "✓", "missing": "✗", "wrong": "✗", "unused": "○"}
_WORDS = {"ok": "ok", "missing": "missing", "wrong": "wrong", "unused": "not used"}


def command(
    data: Annotated[
        Path | None, typer.Option(help="Folder for memories; default: the demonstration's.")
    ] = None,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port of the page.")] = PORT,
    config: ConfigOption = None,
    language: LanguageOption = "",
    key_file: KeyFileOption = None,
    robot: Annotated[
        Path | None, typer.Option(help="File of a robot with ROS (YAML), to listen to what it tells.")
    ] = None,
    name: Annotated[str, typer.Option(help="That robot's name.")] = "robot",
    json: Annotated[bool, typer.Option("--json", help="One JSON object per line.")] = False,
) -> None:
    """Check this machine, and a robot. Exit code 1: Parley or the robot does not work so."""
    quiet_logs()
    chosen, broken = _settings(config)
    chosen = chosen.changed(language_settings(language, key_file))
    subject = Subject(
        data_dir=data or chosen.data_dir or data_folder("nursing-home"),
        static_dir=Path(parley.web.__file__).parent / "static",
        port=port,
        language=chosen.language,
        key_file=chosen.model.key_file,
        base_url=chosen.model.base_url,
        memory=chosen.memory_file,
        embeddings=chosen.embeddings,
        network=chosen.network,
        robot=None if robot is None else RosRobotFile.load(robot),
        robot_name=name,
    )
    hindered = False
    for finding in (*broken, *examine(subject)):
        hindered |= finding.hinders
        if json:
            emit_json(asdict(finding))
        else:
            _tell(finding)
    raise typer.Exit(1 if hindered else 0)


def _settings(file: Path | None) -> tuple[SystemConfig, list[Finding]]:
    """The settings in a file, and what there is to say about it."""
    if file is None:
        return SystemConfig(), []
    try:
        return SystemConfig.load(file), [Finding("settings", "ok", str(file), needed=True)]
    except ConfigError as error:
        remedy = "Mend it; what follows is about the settings without it."
        return SystemConfig(), [Finding("settings", "wrong", str(error), remedy, needed=True)]


def _tell(finding: Finding) -> None:
    mark, word = _MARKS[finding.state], _WORDS[finding.state]
    typer.echo(f"{mark} {finding.subject:<12} {word:<9} {finding.text}")
    if finding.remedy:
        typer.echo(f"  {'':<22} → {finding.remedy}")
