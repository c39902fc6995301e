"""`parley rules`: what a rules file says, what is wrong with it, and what it says about a drive."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from parley.cli.choosing import spoken
from parley.cli.output import emit_json
from parley.clock import WallClock
from parley.errors import ConfigError
from parley.files import read_text
from parley.gate.book import RuleBook
from parley.gate.judge import Finding, Judgement, Place, PlannedStep, RobotFacts
from parley.gate.rules import FILE_NAME, read_rules
from parley.gate.ways import way_planner
from parley.gate.wording import rule_text
from parley.messages.chat import ActionCall
from parley.messages.principal import ROLES, Role, person
from parley.messages.rules import Point, RuleSet
from parley.messages.status import ActionInfo
from parley.sentences import SpokenLanguage, in_language
from parley.world.geometry import Pose2D
from parley.world.occupancy import OccupancyMap

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)

RulesPath = Annotated[
    Path, typer.Argument(help="A rules.yaml, or the data folder of a system that holds it.")
]
Json = Annotated[bool, typer.Option("--json", help="One JSON object per line.")]
Spoken = Annotated[str, typer.Option("--language", help="`en` or `et`.", parser=spoken)]

_DRIVE = ActionInfo(name="drive", effects=("moves",))


def _file(path: Path) -> Path:
    return path / FILE_NAME if path.is_dir() else path


def _rules(path: Path) -> RuleSet:
    """The rules of a file.

    Raises:
        ConfigError: It cannot be read; names the line and the field.
    """
    file = _file(path)
    rules = read_rules(read_text(file), file.name)
    RuleBook(WallClock(), rules)
    return rules


@app.command()
def show(path: RulesPath, language: Spoken = "en", json: Json = False) -> None:
    """List all rules in words."""
    for rule in _rules(path).rules:
        text = in_language(rule_text(rule), language)
        if json:
            emit_json({"text": text} | rule.model_dump(mode="json", by_alias=True, exclude_defaults=True))
        else:
            typer.echo(f"{rule.id}: {text}")


@app.command()
def check(path: RulesPath) -> None:
    """Say what is wrong with a file: its line and field."""
    count = len(_rules(path).rules)
    typer.echo(f"{_file(path).name}: {count} rule{'' if count == 1 else 's'}, nothing wrong")


@app.command("try")
def try_drive(
    path: RulesPath,
    start: Annotated[str, typer.Option("--from", help="Where the robot is: x,y in metres.")],
    goals: Annotated[
        list[str], typer.Option("--to", help="Where it shall go: x,y in metres; may be repeated.")
    ],
    map_file: Annotated[
        Path | None, typer.Option("--map", help="The map's YAML; without it ways are straight.")
    ] = None,
    robot: Annotated[str, typer.Option(help="Its name.")] = "robot",
    radius: Annotated[float, typer.Option(help="Of the robot, metres.", min=0.01)] = 0.2,
    speed: Annotated[float, typer.Option(help="Of the robot, m/s.", min=0.01)] = 0.5,
    role: Annotated[
        str, typer.Option(help="Of the person who orders it: viewer, operator, supervisor.")
    ] = "operator",
    language: Spoken = "en",
    json: Json = False,
) -> None:
    """Say what the rules make of a drive now; nothing moves. Exit code 1 if it is forbidden."""
    book = RuleBook(WallClock(), _rules(path))
    floor = OccupancyMap.load(map_file) if map_file is not None else None
    book.know(robot, RobotFacts(floor.name if floor else "", radius, speed))
    by = person(role=_role(role))
    steps = [PlannedStep(ActionCall(name="drive"), _DRIVE, Place(*_point(goal))) for goal in goals]
    zones = [book.shape(rule) for rule in book.closed_to(robot, by)]
    ways = way_planner(floor, zones, radius_m=radius) if floor is not None else None
    judged = book.judge_plan(robot=robot, steps=steps, by=by, pose=Pose2D(*_point(start)), path=ways)
    _tell(judged, language, json=json)
    if judged.forbidden:
        raise typer.Exit(1)


def _tell(judged: Judgement, language: SpokenLanguage, *, json: bool) -> None:
    def told(findings: tuple[Finding, ...]) -> list[str]:
        return [in_language(finding.sentence, language) for finding in findings]

    kinds = {"forbidden": judged.forbidden, "ask": judged.ask, "risky": judged.risky}
    if json:
        numbers = {"length_m": round(judged.length_m, 2), "expected_s": round(judged.expected_s, 1)}
        emit_json({name: told(findings) for name, findings in kinds.items()} | numbers)
        return
    for name, findings in kinds.items():
        for text in told(findings):
            typer.echo(f"{name}: {text}")
    typer.echo(f"about {judged.length_m:.1f} m, {judged.expected_s:.0f} s")


def _point(text: str) -> Point:
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError as error:
        raise ConfigError(f"{text!r} is no place: say x,y in metres, e.g. 1.5,2") from error
    return x, y


def _role(text: str) -> Role:
    for role in ROLES:
        if role == text:
            return role
    raise ConfigError(f"there is no role {text!r}: say one of {', '.join(ROLES)}")
