"""Puts on the topics what a plan says is to be sent, and looks again when an engine stays silent."""

from __future__ import annotations

import asyncio
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from parley.agents.base import Node
from parley.agents.planner.effects import (
    AwaitResult,
    Effect,
    EndStep,
    ModifyGraph,
    PauseGraph,
    ReportFailure,
    ResumeGraph,
    Say,
    StartGraph,
    StopGraph,
)
from parley.agents.planner.plan import TargetPlan
from parley.errors import Problem
from parley.messages import ros, topics
from parley.messages.chat import ChatFeedback
from parley.messages.status import Rejection, RejectionProblem, StepCommand
from parley.messages.wire import to_string
from parley.transport.base import Transport
from parley.umrf.io import write_graph

__all__ = ["Patience", "PlanSender"]


@dataclass(frozen=True, slots=True)
class Patience:
    """Wall time that an engine is given."""

    answer_s: float = 5.0
    """To report something about a graph that was started."""
    progress_s: float = 3.0
    """To go on with a dry graph after it was told to."""
    end_s: float = 7.0
    """To end a stopped graph; an engine gives its actions 5 s."""
    result_s: float = 2.0
    """To say how a step ended on which others depend."""


class PlanSender(Node):
    """The half of the planner that speaks.

    Args:
        transport: Where the topics are.
        patience: How long an engine is waited for.
    """

    def __init__(self, transport: Transport, patience: Patience) -> None:
        super().__init__(transport)
        self._patience = patience

    @abstractmethod
    def _speaks_parley(self, target: str) -> bool:
        """Whether the robot's engine is one of ours; override."""

    def _send(self, plan: TargetPlan, effects: Sequence[Effect]) -> None:
        """Send all of it, then the plan as it is now; override for the latter."""
        for effect in effects:
            self._send_one(plan, effect)

    def _send_one(self, plan: TargetPlan, effect: Effect) -> None:
        targets = (plan.target,)
        match effect:
            case StartGraph(graph):
                text = write_graph(graph, faithful=True)
                self.send(topics.GRAPH_START, ros.UmrfGraphStart(umrf_graph_json=text, targets=targets))
                self._later(self._patience.answer_s, plan, lambda: plan.on_no_answer(graph.name))
            case ModifyGraph(graph, continue_from):
                text = write_graph(graph, faithful=True)
                message = ros.UmrfGraphModify(graph.name, targets, text, continue_from)
                self.send(topics.GRAPH_MODIFY, message)
                if continue_from:
                    self._later(
                        self._patience.progress_s,
                        plan,
                        lambda: plan.on_no_progress(graph.name, continue_from),
                    )
            case PauseGraph(name):
                self.send(topics.GRAPH_PAUSE, ros.UmrfGraphPause(name, targets))
                if not self._speaks_parley(plan.target):  # the reference listens to its own misspelling
                    self.send(topics.GRAPH_PAUSE_TEMOTO, ros.UmrfGraphPause(name, targets))
            case ResumeGraph(name):
                self.send(topics.GRAPH_RESUME, ros.UmrfGraphResume(name, targets))
            case StopGraph(name):
                self.send(topics.GRAPH_STOP, ros.UmrfGraphStop(name, targets))
                self._later(self._patience.end_s, plan, lambda: plan.on_no_end(name))
            case EndStep(name, node):
                self.publish(topics.STEP, StepCommand(target=plan.target, graph_name=name, node=node))
            case AwaitResult(name):
                self._later(self._patience.result_s, plan, lambda: plan.on_no_result(name))
            case ReportFailure(message):
                self.publish(topics.ERROR_HANDLING, message)
            case Say(text, kind):
                self._say(plan.target, text, kind)

    def _later(self, seconds: float, plan: TargetPlan, look: Callable[[], list[Effect]]) -> None:
        """Look again after some wall time; `look` decides whether anything is still amiss."""

        async def wait() -> None:
            await asyncio.sleep(seconds)
            self._send(plan, look())

        self.spawn(wait(), name=f"deadline {plan.target}")

    def _say(self, target: str, text: str, kind: Literal["response", "info", "error"]) -> None:
        said = ChatFeedback(message=self.spoken(text), targets=(target,), type=kind)
        self.publish(topics.CHAT_FEEDBACK, said)

    def _refuse(self, what: str, target: str, problems: Sequence[Problem]) -> None:
        self.log.warning("refused", what=what, target=target, problems=[str(p) for p in problems])
        listed = tuple(
            RejectionProblem(path=p.path, message=p.message, remedy=p.remedy, code=p.code) for p in problems
        )
        rejection = Rejection(source=self.name, target=target, what=what, problems=listed)
        self.send(topics.REJECTION, to_string(rejection))
