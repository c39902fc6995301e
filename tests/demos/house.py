"""A running demonstration for tests: say something, hear the reply, wait for what comes of it."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from parley.config import SystemConfig
from parley.demos.catalogue import Demo
from parley.demos.observer import Observer
from parley.demos.runner import play
from parley.demos.story import Variant
from parley.messages.chat import ChatFeedback
from parley.system import System
from parley.transport.local import LocalTransport

PATIENCE_S = 60.0


@dataclass
class House:
    """A system and the operator in it."""

    system: System
    observer: Observer
    robot: str

    async def say(self, text: str, robot: str = "", *, answer: bool = False) -> ChatFeedback:
        """Say something and return what the robot replies to it."""
        name = robot or self.robot
        heard = len(self.observer.said)
        self.observer.say(text, name, answer=answer)

        def replies() -> list[ChatFeedback]:
            new = self.observer.said[heard:]
            return [said for said in new if said.type in ("response", "error") and name in said.targets]

        await self.observer.until(lambda: bool(replies()), timeout_s=PATIENCE_S)
        return replies()[0]

    async def question(self, robot: str = "") -> ChatFeedback:
        """The robot's open question, once there is one."""
        name = robot or self.robot
        await self.observer.until(
            lambda: self.observer.questions.newest(name) is not None, timeout_s=PATIENCE_S
        )
        question = self.observer.questions.newest(name)
        assert question is not None
        return question

    async def done(self, robot: str = "") -> list[str]:
        """Wait until the plan has ended; the states of its steps."""
        name = robot or self.robot
        await self.observer.until(
            lambda: name in self.observer.plans and self.observer.state(name) == "idle", timeout_s=PATIENCE_S
        )
        return [step.state for step in self.observer.plans[name].steps]

    async def state(self, wanted: str, robot: str = "") -> None:
        """Wait until the plan is in this state."""
        name = robot or self.robot
        await self.observer.until(lambda: self.observer.state(name) == wanted, timeout_s=PATIENCE_S)

    def actions(self, robot: str = "") -> list[str]:
        """The actions of the robot's plan."""
        plan = self.observer.plans.get(robot or self.robot)
        return [step.action.name for step in plan.steps] if plan else []

    def distance_m(self, object_id: str, robot: str = "") -> float:
        """From the robot's middle to an object's bounding box."""
        pose = self.system.robots[robot or self.robot].pose()
        thing = self.system.known.get(object_id)
        assert thing is not None
        dx = max(abs(pose.x_m - thing.x_m) - thing.width_m / 2, 0.0)
        dy = max(abs(pose.y_m - thing.y_m) - thing.height_m / 2, 0.0)
        return float((dx * dx + dy * dy) ** 0.5)


@asynccontextmanager
async def running(system: System) -> AsyncIterator[House]:
    """Open a system; at the end no handler may have failed."""
    async with system, Observer(system.transport, system.clock) as observer:
        await observer.until(lambda: set(system.robot_names) <= observer.robots, timeout_s=PATIENCE_S)
        yield House(system, observer, system.robot_names[0])
    assert isinstance(system.transport, LocalTransport)
    assert system.transport.handler_failures == 0


FULL_SPEED = SystemConfig(speed=None)


async def played(
    demo: Demo, folder: Path, variant: str = "", seed: int = 0
) -> tuple[str, list[dict[str, Any]], System]:
    """How it ended, what happened, and the system that it happened in."""
    events: list[dict[str, Any]] = []
    systems: list[System] = []
    config = SystemConfig(speed=None, data_dir=folder, seed=seed)

    def make(different: Variant) -> System:
        systems.append(demo.system_for(demo.story, config, different))
        return systems[-1]

    result = await play(demo.story, make, variant=variant, emit=events.append)
    return result.reason and f"{result.reason}: {result.text}", events, systems[-1]
