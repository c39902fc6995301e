"""An engine on a local transport with everything it publishes collected, for tests."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from typing import Any

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.errors import ActionFailure, FailureCode
from parley.messages import ros, topics
from parley.messages.principal import Principal, person
from parley.messages.status import ActorStatus, GraphEvent, Rejection, StopCommand, StopReport, Trouble
from parley.messages.wire import decode, to_string
from parley.robots.base import CameraImage, LaserScan, NavigationControl, SeenPerson, Velocity
from parley.transport.local import LocalTransport
from parley.world.geometry import Pose2D
from tests.umrf.spec_actions import CATALOGUE

KIM = person("Kim")


class DummyRobot:
    """A robot that only has a velocity and remembers what its drive was told."""

    name = "A"
    capabilities: frozenset[str] = frozenset()
    radius_m = 0.2

    def __init__(self) -> None:
        self.moving = False
        self.told: list[str] = []
        self.broken = False
        self.rolls_on = self.silent = False

    def pose(self) -> Pose2D:
        return Pose2D(1.0, 2.0, 0.5)

    def velocity(self) -> Velocity:
        if self.silent:
            raise ActionFailure(FailureCode.HARDWARE, "no wheels are measured")
        return Velocity(0.3 if self.moving else 0.0, 0.0)

    def scan(self) -> LaserScan:
        raise ActionFailure(FailureCode.NOT_CAPABLE, "no lidar")

    def planned_path(self) -> tuple[tuple[float, float], ...]:
        return ()

    def trouble(self) -> Trouble:
        """Nothing."""
        return ""

    def battery(self) -> float | None:
        return None

    def people(self) -> tuple[SeenPerson, ...]:
        return ()

    @property
    def arm(self) -> None:
        return None

    async def speak(self, text: str) -> None:
        self.told.append(f"speak {text}")

    @property
    def sight(self) -> None:
        return None

    async def look(self, aside_rad: float) -> CameraImage:
        return await self.image()

    async def image(self) -> CameraImage:
        raise ActionFailure(FailureCode.NOT_CAPABLE, "no camera")

    async def navigate(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        raise ActionFailure(FailureCode.NOT_CAPABLE, "no wheels")

    def drive(self, velocity: Velocity) -> None:
        self.told.append(f"drive {velocity.linear_mps:g}")

    def halt(self) -> None:
        self.told.append("halt")
        if self.broken:
            raise ActionFailure(FailureCode.HARDWARE, "no power")
        if not self.rolls_on:
            self.moving = False

    def release(self) -> None:
        self.told.append("release")


class Nobody:
    """Where no person is told or asked anything."""

    def tell(self, text: str) -> None:
        raise AssertionError(text)

    async def ask(self, question: str, choices: Sequence[str] = ()) -> str:
        raise AssertionError(question)


class Rig:
    """What tests send and see."""

    def __init__(self, transport: LocalTransport, robot: DummyRobot | None) -> None:
        self.transport, self.robot = transport, robot
        self.events: list[GraphEvent] = []
        self.rejections: list[Rejection] = []
        self.feedback: list[ros.UmrfGraphFeedback] = []
        self.statuses: list[ActorStatus] = []
        self.reports: list[StopReport] = []
        self._changed = asyncio.Event()
        self._start = transport.publisher(topics.GRAPH_START)
        self._modify = transport.publisher(topics.GRAPH_MODIFY)
        self._pause = transport.publisher(topics.GRAPH_PAUSE)
        self._resume = transport.publisher(topics.GRAPH_RESUME)
        self._stop = transport.publisher(topics.GRAPH_STOP)
        self._emergency = transport.publisher(topics.STOP)

    async def listen(self) -> None:
        def into(kept: list[Any], kind: Any) -> Callable[[ros.String], None]:
            def keep(message: ros.String) -> None:
                kept.append(decode(kind, message.data))
                self._changed.set()

            return keep

        def feedback(message: ros.UmrfGraphFeedback) -> None:
            self.feedback.append(message)
            self._changed.set()

        await self.transport.subscribe(topics.GRAPH_EVENTS, into(self.events, GraphEvent))
        await self.transport.subscribe(topics.REJECTION, into(self.rejections, Rejection))
        await self.transport.subscribe(topics.ACTOR_STATUS, into(self.statuses, ActorStatus))
        await self.transport.subscribe(topics.STOP_REPORT, into(self.reports, StopReport))
        await self.transport.subscribe(topics.GRAPH_FEEDBACK, feedback)

    async def until(self, condition: Callable[[], Any]) -> None:
        """Wait until what was seen fulfils `condition`; the test's time-out is the limit."""
        async with asyncio.timeout(10):
            while not condition():
                self._changed.clear()
                await self._changed.wait()

    async def until_graph(self, name: str, state: str, actor: str = "") -> None:
        await self.until(lambda: self.graph_states(name, actor)[-1:] == [state])

    async def until_node(self, name: str, node: str, states: list[str], actor: str = "") -> None:
        await self.until(lambda: self.node_states(name, node, actor) == states)

    def graph_states(self, name: str, actor: str = "") -> list[str]:
        found = self._events("graph", name, actor)
        return [item.state for item in found]

    def node_states(self, name: str, node: str, actor: str = "") -> list[str]:
        found = self._events("node", name, actor)
        return [item.state for item in found if item.node == node and item.cause != "bypass"]

    def _events(self, kind: str, name: str, actor: str) -> list[GraphEvent]:
        found = [item for item in self.events if item.kind == kind and item.graph_name == name]
        return [item for item in found if actor in ("", item.actor)]

    def last_feedback(self, name: str) -> dict[str, Any]:
        graphs = [json.loads(text) for message in self.feedback for text in message.history]
        told = [graph for graph in graphs if graph["graph_name"] == name]
        found: dict[str, Any] = told[-1] if told else {"graph_state": "not told yet"}
        return found

    def start(self, graph: dict[str, Any] | str, targets: Sequence[str] = ("A",)) -> None:
        text = graph if isinstance(graph, str) else json.dumps(graph)
        self._start.publish(ros.UmrfGraphStart(umrf_graph_json=text, targets=tuple(targets)))

    def start_indexed(self, name: str, targets: Sequence[str] = ("A",)) -> None:
        self._start.publish(ros.UmrfGraphStart(umrf_graph_name=name, targets=tuple(targets)))

    def modify(self, graph: dict[str, Any], continue_from: str = "") -> None:
        self._modify.publish(
            ros.UmrfGraphModify(modified_graph=json.dumps(graph), continue_from=continue_from, targets=("A",))
        )

    def pause(self, name: str) -> None:
        self._pause.publish(ros.UmrfGraphPause(name, ("A",)))

    def resume(self, name: str) -> None:
        self._resume.publish(ros.UmrfGraphResume(name, ("A",)))

    def stop(self, name: str) -> None:
        self._stop.publish(ros.UmrfGraphStop(name, ("A",)))

    def emergency(
        self,
        command: str,
        targets: Sequence[str] = (),
        id: str = "1",
        by: Principal | None = KIM,
    ) -> None:
        payload = StopCommand.model_validate(
            {"command": command, "targets": list(targets), "id": id, "by": by}
        )
        self._emergency.publish(to_string(payload))


def engine_of(actor: str, rig: Rig, **options: Any) -> ActionEngine:
    """An engine on the rig's transport; open it with ``async with``."""
    defaults: dict[str, Any] = {
        "transport": rig.transport,
        "catalogue": CATALOGUE,
        "clock": WallClock(),
        "make_context": lambda handle: handle,
        "heartbeat_s": 60.0,
    }
    return ActionEngine(actor, **(defaults | options))


@asynccontextmanager
async def rigged(robot: DummyRobot | None = None, **options: Any) -> AsyncIterator[Rig]:
    """An engine for actor A, and what is needed to talk to it; checks that nothing is left behind."""
    before = asyncio.all_tasks()
    async with LocalTransport() as transport:
        rig = Rig(transport, robot)
        await rig.listen()
        async with engine_of("A", rig, robot=robot, **options):
            yield rig
        await rig.until(lambda: rig.statuses and rig.statuses[-1].state == "leaving")
        assert transport.handler_failures == 0
    assert asyncio.all_tasks() == before
