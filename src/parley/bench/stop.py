"""How soon a driving robot stands: from the press, the topic or the word to its drive, and to rest.

A simulated robot patrols in real time. What is measured lies in this process; the way from a finger to the
web server is not in it. The worlds in which it is measured are made worse in turn, see `CONDITIONS`.
"""

from __future__ import annotations

import asyncio
import resource
import sqlite3
import tempfile
import threading
import time
import uuid
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from contextlib import AbstractContextManager, asynccontextmanager, closing, contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

from parley.actions.context import ActionContext
from parley.config import SystemConfig
from parley.demos.observer import Observer
from parley.engine.presence import REST_LINEAR_MPS
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, ChatInput
from parley.messages.principal import person
from parley.messages.status import StopCommand
from parley.robots.base import NavigationControl
from parley.robots.simulated import SimulatedRobot
from parley.sim.world_file import WorldFile
from parley.system import System
from parley.umrf.action import action
from parley.world.geometry import Pose2D, Velocity

__all__ = ["CONDITIONS", "WAYS", "StopFigures", "measure_stop"]

Condition = Literal["calm", "model_hung", "loop_blocked", "disk_full", "database_locked"]
Way = Literal["press", "topic", "word"]

CONDITIONS: Final[tuple[Condition, ...]] = (
    "calm",
    "model_hung",
    "loop_blocked",
    "disk_full",
    "database_locked",
)
WAYS: Final[tuple[Way, ...]] = ("press", "topic", "word")
"""`press`: the stop line, in a thread; `topic`: `/parley/stop`; `word`: "stop" as it is said."""

BLOCKED_S: Final = 1.5
PATIENCE_S: Final = 10.0
_LOOK_S: Final = 0.0005
"""How often is looked whether it stands; part of what is measured."""
_ROBOT: Final = "Ada"
_BY: Final = person("bench")
_WORLD: Final = """
name: a room
walls:
  - {from: [0, 0], to: [8, 0]}
  - {from: [8, 0], to: [8, 3]}
  - {from: [8, 3], to: [0, 3]}
  - {from: [0, 3], to: [0, 0]}
robots:
  - {name: Ada, model: turtlebot3_waffle, pose: [1.0, 1.5, 0.0]}
"""


@action(effects=("moves",))
async def patrol(ctx: ActionContext) -> None:
    """Drive to and fro for ever."""
    control = NavigationControl(lambda _: None, lambda: ctx.run.paused)
    while True:
        for x_m in (7.0, 1.0):
            await ctx.robot.navigate(Pose2D(x_m, 1.5, 0.0), control, timeout_s=600)


@dataclass(slots=True)
class StopFigures:
    """Of one way under one condition, in wall time."""

    condition: Condition
    way: Way
    drive_ms: list[float] = field(default_factory=list)
    """Until the drive was commanded to rest."""
    rest_ms: list[float] = field(default_factory=list)
    """Until the measured velocity was zero."""


async def measure_stop(
    times: int, conditions: Sequence[Condition] = CONDITIONS
) -> AsyncIterator[StopFigures]:
    """Stop a driving robot so many times in each way, under each of the conditions."""
    for condition in conditions:
        with tempfile.TemporaryDirectory(prefix="parley-") as folder:
            async with _Scene.of(Path(folder)) as scene:
                for way in WAYS:
                    if condition == "loop_blocked" and way == "word":
                        continue  # it is read on the loop: the robot stands because its commands expire
                    figures = StopFigures(condition, way)
                    for _ in range(times):
                        drive_s, rest_s = await scene.stopped(condition, way)
                        figures.drive_ms.append(1000 * drive_s)
                        figures.rest_ms.append(1000 * rest_s)
                    yield figures


class _Scene:
    """A system with one robot on patrol."""

    def __init__(self, system: System, observer: Observer, language: ScriptedLanguage, folder: Path) -> None:
        self.system, self.observer, self.language, self.folder = system, observer, language, folder
        robot = system.robots[_ROBOT]
        assert isinstance(robot, SimulatedRobot)
        self.robot = robot

    @classmethod
    @asynccontextmanager
    async def of(cls, folder: Path) -> AsyncIterator[_Scene]:
        """Opened, and the robot on its way."""
        language = ScriptedLanguage()
        config = SystemConfig(speed=1.0, data_dir=folder)
        world = WorldFile.parse(_WORLD)
        async with (
            System(world, config, language=language, actions=(patrol.spec,)) as system,
            Observer(system.transport, system.clock) as observer,
        ):
            scene = cls(system, observer, language, folder)
            await observer.until(lambda: _ROBOT in observer.robots)
            order = ChatAction(queue=(ActionCall(name="Patrol"),), targets=(_ROBOT,), by=_BY)
            observer.publish(topics.CHAT_ACTION, order)
            yield scene

    async def stopped(self, condition: Condition, way: Way) -> tuple[float, float]:
        """Wait until it drives, stop it, and let it go on; seconds to the drive, and to rest."""
        async with asyncio.timeout(PATIENCE_S):
            while not self._drives():  # noqa: ASYNC110 - a velocity cannot be awaited
                await asyncio.sleep(0.02)
        if condition == "model_hung":
            self.language.will("interpret", asyncio.Event())
            self._say("please find the box")
            await asyncio.sleep(0.05)
        blocks = condition == "loop_blocked"
        with self._worse(condition):
            measured = asyncio.ensure_future(asyncio.to_thread(self._measure, self._stop_by(way), blocks))
            if blocks:
                await asyncio.sleep(0.02)
                time.sleep(BLOCKED_S)  # noqa: ASYNC251 - that is what is looked at
            taken = await measured
        await self._go_on(way)
        return taken

    def _drives(self) -> bool:
        return abs(self.robot.velocity().linear_mps) > 0.1

    def _stop_by(self, way: Way) -> Callable[[], None]:
        loop, line = asyncio.get_running_loop(), self.system.stop_line

        def pull() -> None:
            line.pull([_ROBOT], by=_BY, id=uuid.uuid4().hex, wait_s=0.0)

        def publish() -> None:
            if way == "word":
                self._say("stop")
            else:
                command = StopCommand(targets=(_ROBOT,), id=uuid.uuid4().hex, by=_BY)
                self.observer.publish(topics.STOP, command)

        def publish_on_loop() -> None:
            loop.call_soon_threadsafe(publish)

        return pull if way == "press" else publish_on_loop

    def _say(self, text: str) -> None:
        said = ChatInput(message=text, targets=(_ROBOT,), by=_BY, id=uuid.uuid4().hex)
        self.observer.publish(topics.CHAT_INPUT, said)

    def _measure(self, stop: Callable[[], None], blocks: bool) -> tuple[float, float]:
        """In a thread of its own, as a loop that is blocked cannot look."""
        simulator, wait = self.system.simulator, threading.Event().wait
        if blocks:
            wait(0.1)
        began_s = time.perf_counter()
        stop()
        while simulator.commanded(_ROBOT) != Velocity() and time.perf_counter() - began_s < PATIENCE_S:
            wait(_LOOK_S)
        drive_s = time.perf_counter() - began_s
        while abs(self.robot.velocity().linear_mps) > REST_LINEAR_MPS:
            wait(_LOOK_S)
            if time.perf_counter() - began_s > PATIENCE_S:
                break
        return drive_s, time.perf_counter() - began_s

    async def _go_on(self, way: Way) -> None:
        """Release the robot, and say "carry on" once its plan stands still."""
        await self.observer.until(lambda: self.observer.state(_ROBOT) == "paused")
        if way != "word":
            self.system.stop_line.reset([_ROBOT], by=_BY)
        while self.observer.state(_ROBOT) != "running":  # the release may not have been heard of everywhere
            self._say("carry on")
            await asyncio.sleep(0.2)

    def _worse(self, condition: Condition) -> AbstractContextManager[None]:
        match condition:
            case "disk_full":
                return _no_room()
            case "database_locked":
                return _locked([*self.folder.glob("*.db")])
        return nullcontext()


@contextmanager
def _no_room() -> Iterator[None]:
    """Every write to any file of this process fails, as on a disk that is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@contextmanager
def _locked(files: list[Path]) -> Iterator[None]:
    """Somebody else holds every database."""
    connections = [sqlite3.connect(file, timeout=5.0, isolation_level=None) for file in files]
    try:
        for connection in connections:
            connection.execute("BEGIN IMMEDIATE")
        yield
    finally:
        for connection in connections:
            with closing(connection):
                if connection.in_transaction:
                    connection.execute("ROLLBACK")
