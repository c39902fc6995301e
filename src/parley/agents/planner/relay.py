"""Steps that wait until other robots have done theirs; where that comes to nothing, a person is asked.

Each robot's plan stays a graph of its own, so that one that fails or leaves holds up nobody else's.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from parley.agents.planner.asking import SHALL_I, wish_of
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.proposing import Proposals
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.planner.steps import Step
from parley.latest import Latest
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.principal import Principal
from parley.sentences import Sentence, sentence, together

__all__ = ["Relay"]


@dataclass(slots=True, eq=False)
class _Waiting:
    plan: TargetPlan
    order: ChatAction
    calls: Sequence[ActionCall]
    by: Principal | None
    """On whose account they begin."""
    kept: str
    """Under which id it is written down."""
    warned: bool = False


class Relay:
    """Knows which order's steps are done.

    Args:
        plans: What is known of each robot.
        proposals: Where what has to be asked about is put.
    """

    def __init__(self, plans: RobotPlans, proposals: Proposals) -> None:
        self._plans, self._proposals = plans, proposals
        self._last: Latest[str, tuple[str, Step]] = Latest()
        """By order: who does it, and its last step."""
        self._waiting: list[_Waiting] = []
        self.begin: Callable[[TargetPlan, ChatAction, Sequence[ActionCall], Principal | None], None]
        """Puts steps behind a plan."""
        plans.changed = self.look
        plans.later = lambda plan: tuple(one.order.id for one in self._waiting if one.plan is plan)

    def note(self, order: str, plan: TargetPlan, before: Sequence[Step]) -> None:
        """Steps of an order have just been put into a plan, which had those of `before`."""
        known = {id(step) for step in before}
        new = [step for step in plan.steps if id(step) not in known]
        if order and new:
            self._last[order] = (plan.target, new[-1])

    def keeps(
        self, plan: TargetPlan, order: ChatAction, calls: Sequence[ActionCall], by: Principal | None
    ) -> bool:
        """Whether steps have to wait; they begin by themselves then."""
        if not calls or all(self._state(other) == "done" for other in order.after):
            return False
        kept = self._proposals.keep(plan, order.model_copy(update={"after": (), "by": by}), calls)
        self._waiting.append(_Waiting(plan, order, calls, by, kept))
        self._plans.send(plan, [])
        return True

    def look(self) -> None:
        """Begin what can begin by now, and ask about what will not come to it."""
        for one in tuple(self._waiting):
            if one not in self._waiting:
                continue  # what began before it in this turn has changed a plan, so it was looked at already
            states = {other: self._state(other) for other in one.order.after}
            who = ", ".join(dict.fromkeys(self._robot(other) for other in states))
            if "lost" in states.values():
                gone = ", ".join(self._robot(other) for other, state in states.items() if state == "lost")
                self._ask(one, sentence("{robot} has not done its part", robot=gone))
            elif all(state == "done" for state in states.values()):
                self._over(one)
                self._plans.say(
                    one.plan.target, sentence("{robot} has done its part, so I begin.", robot=who), "info"
                )
                self.begin(one.plan, one.order, one.calls, one.by)
            elif "failed" in states.values() and not one.warned:
                one.warned = True
                text = sentence("{robot} is in trouble with its part. I go on waiting for it.", robot=who)
                self._plans.say(one.plan.target, text, "info")

    def interrupt(self, plan: TargetPlan) -> None:
        """A robot was told to stand still: nothing of it begins by itself any more."""
        for one in [one for one in self._waiting if one.plan is plan]:
            self._ask(one, sentence("I was told to stop before I began"))

    def drop(self, plan: TargetPlan, order: str = "") -> None:
        """A robot's plan is given up, with what waits; with an order only that."""
        for one in [one for one in self._waiting if one.plan is plan and order in ("", one.order.id)]:
            self._over(one)

    def _over(self, one: _Waiting) -> None:
        self._waiting.remove(one)
        self._plans.approvals.forget(one.kept)

    def _ask(self, one: _Waiting, why: Sentence) -> None:
        self._over(one)
        order = one.order.model_copy(update={"after": (), "by": one.by})
        proposal = self._proposals.propose(one.plan, order, one.calls, why=why)
        self._plans.say(one.plan.target, together(wish_of(proposal.lines, proposal.why), SHALL_I), "info")

    def _robot(self, order: str) -> str:
        if (known := self._last.get(order)) is not None:
            return known[0]
        waits = [proposal.target for proposal in self._plans.approvals.waiting if proposal.order == order]
        return waits[0] if waits else next((w.plan.target for w in self._waiting if w.order.id == order), "…")

    def _state(self, order: str) -> Literal["done", "open", "failed", "lost"]:
        """How far an order is, by its last step."""
        known = self._last.get(order)
        if known is None:
            proposed = any(proposal.order == order for proposal in self._plans.approvals.waiting)
            return "open" if proposed or any(one.order.id == order for one in self._waiting) else "lost"
        robot, step = known
        if step.state == "finished" and not step.stopped:
            return "done"
        there = any(step is other for other in self._plans.plan(robot).steps)
        if (
            not there
            or step.state in ("finished", "skipped", "stopped")
            or not self._plans.presence.is_there(robot)
        ):
            return "lost"
        return "failed" if self._plans.plan(robot).held else "open"
