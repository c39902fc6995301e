"""`parley bench`: measure on this machine."""

from __future__ import annotations

import asyncio
import os
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import typer

from parley.bench.control import measure_control, measure_crowd
from parley.bench.display import measure_display
from parley.bench.engine import Figures, chain, fan_out, run_chain, run_graphs, run_journaled, share
from parley.bench.language import measure_language
from parley.bench.memory import VECTOR_LENGTH, measure_memory
from parley.bench.simulator import measure_simulator
from parley.bench.story import measure_demo
from parley.bench.team import Kind, measure_team
from parley.bench.transport import measure_transport
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, quiet_logs
from parley.demos.catalogue import load_demo
from parley.extras import needs
from parley.umrf.model import Graph

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)

JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object per figure.")]
LENGTHS = (10, 100, 1000)
AT_ONCE = 100
CONTROL_TIMES = 100
CROWD_TIMES = 30


@app.command("engine")
def engine(json: JsonOption = False) -> None:
    """Chains, a fan-out, a hundred graphs at once, latencies; async and threaded, every event checked."""
    quiet_logs()
    for threaded in (False, True):
        on_loop(run_chain(LENGTHS[0], threaded=threaded))  # so that first-time imports are not measured
        for length in LENGTHS:
            _show_run("chain", on_loop(run_chain(length, threaded=threaded)), json)
        journaled = on_loop(run_journaled(LENGTHS[-1], threaded=threaded))
        _show_run("chain_with_journal", journaled, json)
        _show_run("fan_out", on_loop(run_graphs([fan_out("fan", AT_ONCE)], threaded=threaded)), json)
        many = [chain(f"g{index}", 10) for index in range(AT_ONCE)]
        _show_run("graphs_at_once", on_loop(run_graphs(many, threaded=threaded)), json)
        paced = run_graphs(many, threaded=threaded, seconds=0.02)
        _show_run("graphs_at_once_of_20_ms_actions", on_loop(paced), json)
        slow = run_graphs([chain("slow", 100)], threaded=threaded, seconds=0.01, feedback=True)
        _show_run("actions_of_10_ms", on_loop(slow), json)
        control = on_loop(measure_control(CONTROL_TIMES, threaded=threaded))
        for command, taken_ms in control.items():
            kind = "threaded" if threaded else "async"
            _show({"case": f"{command}_to_action", "kind": kind, **_latency("", taken_ms)}, json)
    crowds: dict[str, Callable[[int], list[Graph]]] = {
        "a_thousand_actions": lambda index: [chain(f"c{index}", LENGTHS[-1])],
        "a_hundred_graphs": lambda index: [chain(f"g{index}_{number}", 10) for number in range(AT_ONCE)],
    }
    for what, others in crowds.items():
        crowd = on_loop(measure_crowd(others, CROWD_TIMES))
        facts = _latency("pause_", crowd.pause_ms) | _latency("stop_", crowd.stop_ms)
        facts |= _latency("longest_step_", crowd.longest_step_ms)
        facts |= _latency("longest_collection_", crowd.longest_collection_ms)
        _show({"case": f"beside_{what}", **facts}, json)


def _show_run(case: str, figures: Figures, as_json: bool) -> None:
    facts: dict[str, Any] = {
        "case": case,
        "kind": figures.kind,
        "actions": figures.actions,
        "wall_ms": round(1000 * figures.wall_s, 1),
        "actions_per_s": round(figures.actions_per_s),
        "cpu_us_per_action": round(figures.cpu_us_per_action),
        "events": figures.events,
        "gaps": figures.gaps,
        "peak_rss_mb": round(figures.rss_mb, 1),
    }
    facts |= _latency("event_", figures.event_ms) | _latency("feedback_", figures.feedback_ms)
    _show(facts, as_json)


def _latency(what: str, values_ms: Sequence[float]) -> dict[str, float]:
    if not values_ms:
        return {}
    return {
        f"{what}p50_ms": round(share(values_ms, 0.5), 2),
        f"{what}p99_ms": round(share(values_ms, 0.99), 2),
    }


def _show(facts: dict[str, Any], as_json: bool) -> None:
    if as_json:
        emit_json(facts)
    else:
        typer.echo("  ".join(f"{name} {value}" for name, value in facts.items()))


def _show_machine(as_json: bool) -> None:
    """How busy the machine was: times of a busy one say little."""
    _show({"case": "machine", "cores": os.cpu_count(), "load": round(os.getloadavg()[0], 1)}, as_json)


@app.command("memory")
def memory(
    memories: Annotated[int, typer.Option(min=100, help="How many there are.")] = 100_000,
    json: JsonOption = False,
) -> None:
    """Searches among many memories, rare and common words, before any model is asked."""
    quiet_logs()
    figures = on_loop(measure_memory(memories))
    _show(
        {
            "case": "file",
            "memories": figures.memories,
            "fill_ms": round(figures.fill_ms),
            "open_ms": round(figures.open_ms),
            "file_mb": round(figures.file_mb, 1),
        },
        json,
    )
    vectors = {
        "case": "vectors",
        "length": VECTOR_LENGTH,
        "fill_ms": round(figures.meaning_fill_ms),
        "open_ms": round(figures.meaning_open_ms),
    }
    _show(vectors, json)
    searches = {
        **figures.search_ms,
        "through_the_node": figures.service_ms,
        "by_meaning": figures.meaning_ms,
        "by_words_and_meaning_through_the_node": figures.both_ms,
    }
    for case, taken_ms in searches.items():
        _show({"case": f"search_{case}", "searches": len(taken_ms), **_latency("", taken_ms)}, json)
    _show({"case": "add", "times": len(figures.add_ms), **_latency("", figures.add_ms)}, json)
    _show_machine(json)


@app.command("display")
def display(
    frames: Annotated[int, typer.Option(min=1, help="How many of each kind.")] = 300, json: JsonOption = False
) -> None:
    """Pictures of 640 x 480 through the display interface: passed on untouched, and encoded anew."""
    quiet_logs()
    for figures in on_loop(measure_display(frames)):
        facts = {
            "case": figures.kind,
            "frames": figures.frames,
            "frames_per_s": round(figures.frames_per_s),
            "frames_per_core_s": round(figures.frames_per_core_s),
        }
        _show(facts | _latency("", figures.latency_ms), json)


@app.command("transport")
def transport(
    times: Annotated[int, typer.Option(min=1, help="How many messages of each size.")] = 1000,
    json: JsonOption = False,
) -> None:
    """Messages within this process, and to another and back: over Zenoh and, where it is sourced, ROS 2."""
    quiet_logs()
    report = on_loop(measure_transport(times))
    for figures in report.figures:
        facts: dict[str, Any] = {
            "case": figures.backend,
            "size": figures.size,
            "messages_per_s": round(figures.messages_per_s),
            "lost": figures.lost,
        }
        facts |= _latency("one_way_", figures.latency_ms)
        if compared := report.to_rclpy(figures):
            facts["latency_to_rclpy"] = round(compared.latency, 2)
            facts["throughput_to_rclpy"] = round(compared.throughput, 2)
        _show(facts, json)
    ros = {"rmw": report.rmw} if report.rmw else {"not_measured": report.without_ros}
    _show({"case": "ros", **ros}, json)
    _show_machine(json)


@app.command("language")
def language(
    times: Annotated[int, typer.Option(min=1, help="How many messages of each kind.")] = 200,
    json: JsonOption = False,
) -> None:
    """From message to plan: the built-in engine, and what is added to a language model's own time."""
    quiet_logs()
    for figures in on_loop(measure_language(times)):
        facts = {"case": figures.case, "messages": times, "cpu_ms": round(figures.cpu_ms, 2)}
        _show(facts | _latency("", figures.latency_ms), json)
    _show_machine(json)


@app.command("stop")
def stop(
    times: Annotated[int, typer.Option(min=1, help="How often it is stopped in each way.")] = 30,
    json: JsonOption = False,
) -> None:
    """From press, topic or word to the drive and to rest, also with a hung model or a full disk."""
    from parley.bench.stop import measure_stop

    quiet_logs()

    async def measure() -> None:
        async for figures in measure_stop(times):
            facts: dict[str, Any] = {"case": figures.condition, "way": figures.way, "times": times}
            facts |= _latency("drive_", figures.drive_ms) | _latency("rest_", figures.rest_ms)
            _show(facts, json)

    on_loop(measure())
    _show_machine(json)


@app.command("demo")
def demo(
    name: Annotated[str, typer.Argument(help="Which demonstration.")] = "nursing-home",
    json: JsonOption = False,
) -> None:
    """Start-up, latency of replies, speed of the simulation and memory of a demonstration."""
    quiet_logs()
    figures = on_loop(measure_demo(name))
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


@app.command("simulator")
def simulator(
    name: Annotated[str, typer.Argument(help="Whose world and robots.")] = "fleet",
    seconds: Annotated[float, typer.Option(min=0.1, help="Robot time of each run.")] = 20.0,
    json: JsonOption = False,
) -> None:
    """All robots of a world driving, without their cameras and with pictures at 5 Hz; robot time a core."""
    quiet_logs()

    async def measure() -> None:
        world = (await asyncio.to_thread(load_demo, name)).world
        async for figures in measure_simulator(world, seconds):
            facts = {
                "case": "with_cameras" if figures.pictures else "without_cameras",
                "robots": figures.robots,
                "pictures": figures.pictures,
                "robot_s": round(figures.robot_s, 1),
                "wall_s": round(figures.wall_s, 2),
                "robot_s_per_core_s": round(figures.per_core, 1),
            }
            _show(facts, json)

    on_loop(measure())
    _show_machine(json)


@app.command("team")
def team(
    kind: Annotated[Kind | None, typer.Option(help="Only tasks of this kind.")] = None,
    name: Annotated[str, typer.Option(help="Which demonstration.")] = "fleet",
    json: JsonOption = False,
) -> None:
    """Tasks for several robots, carried out in simulation and judged by the state at the end."""
    quiet_logs()
    counted: dict[str, Counter[str]] = {}

    async def measure() -> None:
        async for task, verdict, amiss in measure_team(name, kind):
            counted.setdefault(task.kind, Counter())[verdict] += 1
            _show({"kind": task.kind, "task": task.name, "verdict": verdict, "amiss": amiss}, json)

    on_loop(measure())
    for case, verdicts in counted.items():
        _show({"case": case, "tasks": verdicts.total(), **verdicts}, json)


@app.command("web")
def web(
    json: JsonOption = False,
    robots: Annotated[int, typer.Option(min=1, max=1000, help="How many robots give feedback.")] = 50,
    feeds: Annotated[int, typer.Option(min=0, max=64, help="How many picture feeds.")] = 8,
    seconds: Annotated[float, typer.Option(min=1, help="How long.")] = 10.0,
    browser: Annotated[
        bool, typer.Option(help="Once more with a real browser, if there is one to drive.")
    ] = True,
) -> None:
    """The page's server: feedback at 10 Hz of many robots and pictures at 10 a second, over real sockets."""
    with needs("web"):
        from parley.bench.web import measure_web
        from parley.bench.web_report import report

    quiet_logs()
    figures = on_loop(measure_web(robots=robots, feeds=feeds, seconds=seconds, browser=browser))
    for facts in report(figures):
        _show(facts, json)
