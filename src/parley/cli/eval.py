"""`parley eval`: how well language engines understand, side by side."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from parley.agents.planner.check import plan_problems
from parley.cli.choosing import ConfigOption, KeyFileOption, chosen_settings
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, quiet_logs
from parley.clock import WallClock
from parley.config import SystemConfig
from parley.errors import ConfigError
from parley.evaluation.cases import Case
from parley.evaluation.gpsr import GPSR_SEED
from parley.evaluation.report import json_report, markdown_report
from parley.evaluation.running import Outcome, evaluate
from parley.evaluation.scores import BackendScore, score
from parley.evaluation.sets import SET_NAMES, load_set
from parley.language.llm import build_language
from parley.language.llm.usage import Usage

__all__ = ["command"]

Run = tuple[BackendScore, list[Outcome]]


def command(
    language: Annotated[
        list[str] | None,
        typer.Option(help="builtin, provider:model, auto:provider:model; repeatable."),
    ] = None,
    set_name: Annotated[
        str,
        typer.Option("--set", help=f"{', '.join(SET_NAMES)}, or a file."),
    ] = "development",
    out: Annotated[
        Path | None, typer.Option(help="Folder for report.md and report.json; made if it is not there.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One line of JSON instead of the report.")] = False,
    reveal: Annotated[
        bool, typer.Option(help="Also show what fails of sets of which only the score is to be looked at.")
    ] = False,
    seed: Annotated[int, typer.Option(help="Of the commands that are made by a grammar.")] = GPSR_SEED,
    at_once: Annotated[int, typer.Option(min=1, help="Questions that may be open at a time.")] = 1,
    key_file: KeyFileOption = None,
    config: ConfigOption = None,
) -> None:
    """Say how much of a set each engine understands, what its plans are worth, and what it takes."""
    quiet_logs()
    engines = [chosen_settings(config, name, key_file) for name in language or [""]]
    cases = load_set(set_name, seed)
    if not cases:
        raise ConfigError(f"the set {set_name!r} is empty")
    runs = on_loop(_run_all(engines, cases, at_once))
    scores, outcomes = [run[0] for run in runs], [run[1] for run in runs]
    report = json_report(set_name, scores, outcomes, reveal=reveal)
    text = markdown_report(set_name, scores, outcomes, reveal=reveal)
    if out is not None:
        _write(out, report, text)
    if as_json:
        emit_json(report)
    else:
        typer.echo(text, nl=False)


async def _run_all(engines: Sequence[SystemConfig], cases: Sequence[Case], at_once: int) -> list[Run]:
    return [await _run(engine, cases, at_once) for engine in engines]


async def _run(chosen: SystemConfig, cases: Sequence[Case], at_once: int) -> Run:
    usage, name = Usage(), chosen.language
    engine = build_language([name], chosen.model, check=plan_problems, usage=usage)
    async with contextlib.AsyncExitStack() as stack:
        if isinstance(engine, contextlib.AbstractAsyncContextManager):
            await stack.enter_async_context(engine)
        outcomes = await evaluate(cases, engine, WallClock(), at_once=at_once)
    return score(name, outcomes, usage.totals() if usage.asked else None), outcomes


def _write(folder: Path, report: dict[str, Any], text: str) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "report.json").write_text(
            json.dumps(report, ensure_ascii=False, indent=1), encoding="utf-8"
        )
        (folder / "report.md").write_text(text, encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{folder.name} cannot be written: {error.strerror}") from error
