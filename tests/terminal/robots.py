"""The other end of the conversation, played by the test over a real transport."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TypeVar

from pydantic import BaseModel

from parley.messages import topics
from parley.messages.chat import ActionCall, ChatFeedback, ChatInput
from parley.messages.pvf import Parameter
from parley.messages.ros import String
from parley.messages.status import ActorStatus, PlanDecision, PlanStep, PlanUpdate, StopCommand
from parley.messages.topics import Topic
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport

P = TypeVar("P", bound=BaseModel)


def call(name: str, reason: str = "", **inputs: str) -> ActionCall:
    """An action with string inputs."""
    parameters = {key: Parameter("string", value) for key, value in inputs.items()}
    return ActionCall(name=name, input_parameters=parameters, reason=reason)


def step(text: str, state: str = "queued", node: str = "") -> PlanStep:
    """A step that reads `text`."""
    return PlanStep.model_validate({"action": call("DoIt"), "label": text, "state": state, "node": node})


def plan(*steps: PlanStep, state: str = "running", target: str = "Ada", graph: str = "g1") -> PlanUpdate:
    """A plan of one robot."""
    return PlanUpdate.model_validate(
        {"target": target, "graph_name": graph, "state": state, "steps": [s.model_dump() for s in steps]}
    )


class PlayedRobots:
    """Publishes as the nodes would and keeps what the operator's client sent."""

    def __init__(self, transport: LocalTransport) -> None:
        self.transport = transport
        self.inputs: list[ChatInput] = []
        self.decisions: list[PlanDecision] = []
        self.stops: list[StopCommand] = []
        self.answer: Callable[[ChatInput], None] = lambda message: None
        """Called for everything the operator says."""

    async def listen(self) -> None:
        """Hear what the operator's client sends."""
        await self.transport.subscribe(topics.CHAT_INPUT, self._heard)
        await self.transport.subscribe(
            topics.PLAN_DECISION, lambda m: self.decisions.append(decode(PlanDecision, m.data))
        )
        await self.transport.subscribe(topics.STOP, lambda m: self.stops.append(decode(StopCommand, m.data)))

    def tell(self, topic: Topic[String], payload: BaseModel) -> None:
        """Publish once."""
        publisher = self.transport.publisher(topic)
        publisher.publish(to_string(payload))
        publisher.close()

    def appear(self, name: str = "Ada", state: str = "idle") -> None:
        """Send one heartbeat."""
        self.tell(topics.ACTOR_STATUS, ActorStatus.model_validate({"actor": name, "state": state}))

    def say(self, text: str, *, name: str = "Ada") -> None:
        """Answer."""
        self.tell(topics.CHAT_FEEDBACK, ChatFeedback(message=text, targets=(name,)))

    def ask(self, text: str, *choices: str, name: str = "Ada", question_id: str = "q1") -> None:
        """Ask and await an answer."""
        feedback = ChatFeedback(
            message=text, targets=(name,), type="request", choices=choices, id=question_id
        )
        self.tell(topics.CHAT_FEEDBACK, feedback)

    def _heard(self, message: String) -> None:
        payload = decode(ChatInput, message.data)
        self.inputs.append(payload)
        self.answer(payload)


async def until(condition: Callable[[], object]) -> None:
    """Wait until something holds; the test's own time limit ends it otherwise."""
    async with asyncio.timeout(10):
        # Asked again and again, because conditions may be about a screen, which tells nobody of changes.
        while True:
            if condition():
                return
            await asyncio.sleep(0.005)
