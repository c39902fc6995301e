"""`parley bench`: measure on this machine."""

from __future__ import annotations

import asyncio
from typing import Annotated

import typer

from parley.bench.engine import run_chain
from parley.bench.story import measure_demo
from parley.cli.output import emit_json, quiet_logs

__all__ = ["app"]

app = typer.Typer(help="Measure on this machine.", no_args_is_help=True)

JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object per figure.")]
LENGTHS = (10, 100, 1000)


@app.command("engine")
def engine(json: JsonOption = False) -> None:
    """Chains of actions that do nothing, async and threaded, every event checked."""
    quiet_logs()
    for threaded in (False, True):
        asyncio.run(run_chain(LENGTHS[0], threaded=threaded))  # so that first-time imports are not measured
        for length in LENGTHS:
            result = asyncio.run(run_chain(length, threaded=threaded))
            facts = {
                "kind": result.kind,
                "actions": result.actions,
                "wall_ms": round(1000 * result.wall_s, 1),
                "actions_per_s": round(result.actions_per_s),
                "events": result.events,
                "gaps": result.gaps,
            }
            if json:
                emit_json(facts)
            else:
                typer.echo("  ".join(f"{name} {value}" for name, value in facts.items()))


@app.command("demo")
def demo(
    name: Annotated[str, typer.Argument(help="Which demonstration.")] = "nursing-home",
    json: JsonOption = False,
) -> None:
    """Start-up, latency of replies, speed of the simulation and memory of a demonstration."""
    quiet_logs()
    figures = asyncio.run(measure_demo(name))
    facts = {
        "ready_s": round(figures.ready_s, 2),
        "reply_p50_ms": round(figures.reply_p50_ms, 1),
        "reply_max_ms": round(max(figures.reply_ms), 1),
        "story_wall_s": round(figures.story_wall_s, 2),
        "story_robot_s": round(figures.story_robot_s, 1),
        "real_time_factor": round(figures.real_time_factor, 1),
        "peak_rss_mb": round(figures.peak_rss_mb),
    }
    if json:
        emit_json(facts)
    else:
        for fact, value in facts.items():
            typer.echo(f"{fact}: {value}")
