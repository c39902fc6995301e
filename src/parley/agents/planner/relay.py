"""Steps of one robot that come after those of others: they begin with waiting, which its engine keeps.

Each robot's plan stays a graph of its own, so that one that fails or leaves holds up nobody else's.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.agents.planner.asking import SHALL_I, wish_of
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.proposing import Proposals
from parley.agents.planner.robot_plans import RobotPlans
from parley.latest import Latest
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.principal import Principal
from parley.messages.pvf import Parameter
from parley.messages.team import WAITS_FOR
from parley.sentences import sentence, together

__all__ = ["Relay"]


class Relay:
    """Knows who does which order.

    Args:
        plans: What is known of each robot.
        proposals: Where what has to be asked about is put.
    """

    def __init__(self, plans: RobotPlans, proposals: Proposals) -> None:
        self._plans, self._proposals = plans, proposals
        self._robots: Latest[str, str] = Latest()

    def note(self, order: str, plan: TargetPlan) -> None:
        """Steps of an order have just been put into a plan."""
        if order:
            self._robots[order] = plan.target

    def waits(
        self, plan: TargetPlan, order: ChatAction, calls: Sequence[ActionCall], by: Principal | None
    ) -> Sequence[ActionCall] | None:
        """The steps that wait for what comes before an order; None: it cannot, so a person is asked."""
        robots = [self._robot(before) for before in order.after]
        able = any(info.name == WAITS_FOR for info in self._plans.catalogue(plan.target))
        if not robots or (able and all(robots)):
            return [_wait(robot, before) for robot, before in zip(robots, order.after, strict=True)]
        why = sentence("I cannot tell when what comes before it is done")
        bare = order.model_copy(update={"after": (), "by": by})
        proposal = self._proposals.propose(plan, bare, calls, why=why)
        text = together(wish_of(proposal.lines, proposal.why), SHALL_I)
        self._plans.say(plan.target, text, "info", asks_yes=True)
        return None

    def _robot(self, order: str) -> str:
        """Who does an order; empty: that is not known."""
        if known := self._robots.get(order):
            return known
        asked = (one.target for one in self._plans.approvals.waiting if one.order == order)
        plans = self._plans.by_robot.values()
        begun = (plan.target for plan in plans if any(step.order == order for step in plan.steps))
        return next(iter((*asked, *begun)), "")


def _wait(robot: str, order: str) -> ActionCall:
    given = {"robot": Parameter("string", robot), "order": Parameter("string", order)}
    reason = sentence("Wait until {robot} has done its part", robot=robot)
    return ActionCall(name=WAITS_FOR, input_parameters=given, reason=reason)
