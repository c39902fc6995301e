"""Puts on the topics what a plan says is to be sent, and looks again when an engine stays silent."""

from __future__ import annotations

import asyncio
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


class PlanSender:
    """What a plan says, put on the topics.

    Args:
        node: Whose topics.
        patience: How long an engine is waited for.
        speaks_parley: Whether a robot's engine is one of ours.
        again: Gets what is to be sent when an engine stayed silent.
    """

    def __init__(
        self,
        node: Node,
        patience: Patience,
        speaks_parley: Callable[[str], bool],
        again: Callable[[TargetPlan, Sequence[Effect]], None],
    ) -> None:
        self._node, self._patience = node, patience
        self._speaks_parley, self._again = speaks_parley, again

    def send(self, plan: TargetPlan, effect: Effect) -> None:
        """Send what one effect says."""
        targets = (plan.target,)
        match effect:
            case StartGraph(graph):
                text = write_graph(graph, faithful=True)
                self._node.send(topics.GRAPH_START, ros.UmrfGraphStart(umrf_graph_json=text, targets=targets))
                self._later(self._patience.answer_s, plan, lambda: plan.reports.on_no_answer(graph.name))
            case ModifyGraph(graph, continue_from):
                text = write_graph(graph, faithful=True)
                message = ros.UmrfGraphModify(graph.name, targets, text, continue_from)
                self._node.send(topics.GRAPH_MODIFY, message)
                if continue_from:
                    self._later(
                        self._patience.progress_s,
                        plan,
                        lambda: plan.reports.on_no_progress(graph.name, continue_from),
                    )
            case PauseGraph(name):
                self._node.send(topics.GRAPH_PAUSE, ros.UmrfGraphPause(name, targets))
                if not self._speaks_parley(plan.target):  # the reference listens to its own misspelling
                    self._node.send(topics.GRAPH_PAUSE_TEMOTO, ros.UmrfGraphPause(name, targets))
            case ResumeGraph(name):
                self._node.send(topics.GRAPH_RESUME, ros.UmrfGraphResume(name, targets))
                self._later(self._patience.progress_s, plan, lambda: plan.reports.on_no_resume(name))
            case StopGraph(name):
                self._node.send(topics.GRAPH_STOP, ros.UmrfGraphStop(name, targets))
                self._later(self._patience.end_s, plan, lambda: plan.reports.on_no_end(name))
            case EndStep(name, node):
                self._node.publish(topics.STEP, StepCommand(target=plan.target, graph_name=name, node=node))
            case AwaitResult(name):
                self._later(self._patience.result_s, plan, lambda: plan.reports.on_no_result(name))
            case ReportFailure(message):
                self._node.publish(topics.ERROR_HANDLING, message)
            case Say(text, kind, asks_yes):
                self.say(plan.target, text, kind, asks_yes=asks_yes)

    def _later(self, seconds: float, plan: TargetPlan, look: Callable[[], list[Effect]]) -> None:
        """Look again after some wall time; `look` decides whether anything is still amiss."""

        async def wait() -> None:
            await asyncio.sleep(seconds)
            self._again(plan, look())

        self._node.spawn(wait(), name=f"deadline {plan.target}")

    def say(
        self, target: str, text: str, kind: Literal["response", "info", "error"], *, asks_yes: bool = False
    ) -> None:
        """Say one of our own sentences for a robot."""
        said = ChatFeedback(message=self._node.spoken(text), targets=(target,), type=kind, asks_yes=asks_yes)
        self._node.publish(topics.CHAT_FEEDBACK, said)

    def refuse(self, what: str, target: str, problems: Sequence[Problem]) -> None:
        """Tell programs and the log why something was not taken."""
        self._node.log.warning("refused", what=what, target=target, problems=[str(p) for p in problems])
        listed = tuple(
            RejectionProblem(path=p.path, message=p.message, remedy=p.remedy, code=p.code) for p in problems
        )
        rejection = Rejection(source=self._node.name, target=target, what=what, problems=listed)
        self._node.send(topics.REJECTION, to_string(rejection))
