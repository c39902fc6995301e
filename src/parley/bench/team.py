"""Tasks for a team, each carried out in simulation and judged by the state at its end."""

from __future__ import annotations

import asyncio
import tempfile
from collections.abc import AsyncIterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Final, Literal

import yaml
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from parley.config import SystemConfig
from parley.demos.catalogue import Demo, load_demo
from parley.demos.observer import Observer
from parley.messages import topics
from parley.messages.ros import String
from parley.messages.status import PlanStep, PlanUpdate
from parley.messages.team import WAITS_FOR
from parley.messages.wire import decode_plan
from parley.system import System

__all__ = ["Kind", "TeamTask", "Verdict", "load_tasks", "measure_team", "try_task"]

Kind = Literal["elemental", "simple", "compound", "complex"]
Verdict = Literal["right", "asks", "declines", "wrong", "unfinished"]
"""`asks`: a question was put, and nobody set out; `declines`: nobody set out, and nothing was asked;
`unfinished`: it had not ended when the time for it was over, which a slow machine does, too."""

_NEAR_M: Final = 1.7
_REPLY_S: Final = 60.0
_END_S: Final = 180.0
_OPEN: Final = ("queued", "running", "failed", "paused", "waiting")


class _Model(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Line(_Model):
    """Something that is said."""

    say: str
    to: tuple[str, ...] = ()
    """Whom it is said to; none: the first robot."""
    when: Literal["idle", "moving"] = "idle"
    """Whether all that was said before has to be over."""


class TeamTask(_Model):
    """What is said, and what has to be so at the end."""

    kind: Kind
    lines: Annotated[tuple[Line, ...], Field(min_length=1)]
    at: Mapping[str, int | tuple[str, ...]] = {}
    looked: Mapping[str, int] = {}
    before: tuple[tuple[str, str], ...] = ()
    still: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Its words."""
        return " / ".join(line.say for line in self.lines)


def load_tasks(demo: str) -> list[TeamTask]:
    """The tasks of a demonstration, by kind.

    Raises:
        pydantic.ValidationError: One cannot be read.
    """
    raw = yaml.safe_load((files("parley.demos") / demo / "tasks.yaml").read_text(encoding="utf-8"))
    by_kind = TypeAdapter(dict[Kind, list[dict[str, object]]]).validate_python(raw)
    found = []
    for kind, tasks in by_kind.items():
        for task in tasks:
            line = {name: task.pop(name) for name in ("say", "to", "when") if name in task}
            found.append(
                TeamTask.model_validate({"kind": kind, **({"lines": [line]} if line else {}), **task})
            )
    return found


async def try_task(demo: Demo, task: TeamTask, *, seed: int = 0) -> tuple[Verdict, str]:
    """Carry one out in a place of its own; how it went, and what was amiss."""
    with tempfile.TemporaryDirectory(prefix="parley-") as folder:
        config = SystemConfig(speed=None, data_dir=Path(folder), seed=seed)
        async with demo.system(config) as system, Observer(system.transport, system.clock) as observer:
            await observer.until(lambda: set(system.robot_names) <= observer.robots, timeout_s=_REPLY_S)
            watch = _Watch()
            subscription = await system.transport.subscribe(topics.PLAN, watch.on_message)
            try:
                replies = [await _say(observer, watch, system, line) for line in task.lines]
                await observer.until(watch.is_over, timeout_s=_END_S)
            except TimeoutError:
                return "unfinished", "it did not end"
            finally:
                await subscription.close()
            return _judged(system, watch, task, replies)


class _Watch:
    """What robots did, in order."""

    def __init__(self) -> None:
        self.plans: dict[str, PlanUpdate] = {}
        self.began: list[str] = []
        """Robots, when they set out first."""
        self.done: dict[tuple[str, str], PlanStep] = {}
        """Finished steps in order, by robot and id, with how many robots had set out."""
        self.out: dict[tuple[str, str], int] = {}

    def on_message(self, message: String) -> None:
        """The planner speaks."""
        told = decode_plan(message.data)
        if not isinstance(told, PlanUpdate):
            return
        self.plans[told.target] = told
        for step in told.steps:
            key = (told.target, step.id)
            sets_out = step.state not in ("queued", "skipped", "stopped") and step.action.name != WAITS_FOR
            if sets_out and told.target not in self.began:
                self.began.append(told.target)
            if step.state == "finished" and key not in self.done:
                self.done[key], self.out[key] = step, len(self.began)

    def is_over(self) -> bool:
        """Whether nobody is at anything by itself any more, nor waits for others."""
        return not any(plan.state == "running" for plan in self.plans.values())

    def count(self, what: str) -> int:
        """How often it was looked at."""
        values = [
            value.value
            for step in self.done.values()
            for name, value in step.action.input_parameters.items()
            if name == "inspect"
        ]
        return values.count(what)


async def _say(observer: Observer, watch: _Watch, system: System, line: Line) -> str:
    if line.when == "idle":
        await observer.until(watch.is_over, timeout_s=_END_S)
    robots = line.to or system.robot_names[:1]
    heard = len(observer.said)
    message = observer.say(line.say, robots[0], also=robots[1:])

    def replies() -> list[str]:
        new = observer.said[heard:]
        return [said.message for said in new if said.type != "info" and said.reply_to in ("", message)]

    await observer.until(lambda: bool(replies()), timeout_s=_REPLY_S)
    return replies()[0]


def _judged(system: System, watch: _Watch, task: TeamTask, replies: Sequence[str]) -> tuple[Verdict, str]:
    amiss = [*_places(system, task), *_deeds(watch, task)]
    if not amiss:
        return "right", ""
    text = f"{'; '.join(amiss)}. {replies[-1]}"
    if watch.began and len(task.lines) == 1:
        return "wrong", text
    return ("asks" if "?" in replies[-1] else "declines" if not watch.began else "wrong"), text


def _places(system: System, task: TeamTask) -> list[str]:
    amiss = []
    for thing, wanted in task.at.items():
        there = tuple(name for name in system.robot_names if _distance_m(system, name, thing) <= _NEAR_M)
        if len(there) != wanted if isinstance(wanted, int) else set(there) != set(wanted):
            amiss.append(f"at {thing}: {', '.join(there) or 'nobody'}")
    return amiss


def _deeds(watch: _Watch, task: TeamTask) -> list[str]:
    amiss = [
        f"{what} was looked at {watch.count(what)} times"
        for what, times in task.looked.items()
        if watch.count(what) != times
    ]
    amiss += [f"{robot} did something" for robot in task.still if robot in watch.began]
    if task.before:
        (first, _), (second, _) = task.before
        ends = [count for (robot, _), count in watch.out.items() if robot == first]
        order = [robot for robot in watch.began if robot in (first, second)]
        if order != [first, second] or not ends or ends[-1] > watch.began.index(second):
            amiss.append(f"{second} did not wait for {first}")
    return amiss


def _distance_m(system: System, robot: str, thing: str) -> float:
    pose, found = system.robots[robot].pose(), system.known.get(thing)
    if found is None:
        return float("inf")
    dx = max(abs(pose.x_m - found.x_m) - found.width_m / 2, 0.0)
    dy = max(abs(pose.y_m - found.y_m) - found.height_m / 2, 0.0)
    return float((dx * dx + dy * dy) ** 0.5)


async def measure_team(name: str, kind: Kind | None = None) -> AsyncIterator[tuple[TeamTask, Verdict, str]]:
    """Carry out the tasks of a demonstration, or those of a kind; how each went, and what was amiss."""
    demo = await asyncio.to_thread(load_demo, name)
    for task in await asyncio.to_thread(load_tasks, name):
        if kind in (None, task.kind):
            yield task, *await try_task(demo, task)
