"""What is known of each robot that plans are made for: whether it is there, its plan, what waits for a yes.

The planner node decides what becomes of these; what there is to tell of them is told here.
"""

from __future__ import annotations

import uuid
from collections.abc import Awaitable, Callable, Mapping, Sequence
from types import MappingProxyType

from parley.agents.base import Mailboxes
from parley.agents.planner import orders as orders
from parley.agents.planner.approval import PlanBoard, Policy
from parley.agents.planner.effects import Effect
from parley.agents.planner.left_graphs import LeftGraphs
from parley.agents.planner.offers import Offers
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.proposal_log import ProposalLog
from parley.agents.planner.sending import Patience, PlanSender
from parley.agents.planner.steps import Step
from parley.agents.presence import Presence, linked_to
from parley.agents.questions import OpenQuestions
from parley.clock import Clock
from parley.errors import Problem
from parley.gate.judge import Judgement
from parley.memory.proposals import ProposalStore
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.principal import Principal
from parley.messages.status import ActionInfo, ActorStatus
from parley.sentences import sentence
from parley.transport.base import Transport
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["Judge", "RobotPlans"]

Judge = Callable[
    [str, Sequence[ActionCall], Sequence[ActionInfo], Pose2D | None, Principal | None, bool],
    Awaitable[Judgement | None],
]
"""What the rules say: robot, steps, its actions, where it is, on whose account, whether risks count."""


class RobotPlans(PlanSender):
    """One plan per robot, kept while it is away, told to everybody at each change.

    Args:
        transport: Where the topics are.
        clock: Its wall time says who is gone.
        known_robots: Robots that send no heartbeat of ours (a TeMoto engine).
        approval: Whether new steps wait for a person's yes.
        policies: Robots for which that is otherwise.
        patience: How long an engine is waited for.
        proposals: Keeps what waits for a yes over restarts; None keeps it only while this process lives.
        tell: Gets a robot and what it has to say by itself; None says it at once, to whoever listens.
        objects: The things a robot's map knows, by the robot's name.
        judge: What the rules say about steps; None: there are none.
        begin_for: Told on whose account a robot acts from now on.
    """

    def __init__(
        self,
        transport: Transport,
        clock: Clock,
        *,
        known_robots: Sequence[str] = (),
        approval: Policy = "run_at_once",
        policies: Mapping[str, Policy] = MappingProxyType({}),
        patience: Patience | None = None,
        proposals: ProposalStore | None = None,
        tell: Callable[[str, str], None] | None = None,
        objects: Callable[[str], Sequence[MapObject]] = lambda _: (),
        judge: Judge | None = None,
        begin_for: Callable[[str, Principal | None], None] = lambda *_: None,
    ) -> None:
        super().__init__(transport, patience or Patience())
        self._presence = Presence(clock, tuple(known_robots), self._on_presence, linked=linked_to(transport))
        self._plans: dict[str, TargetPlan] = {}
        self._proposals, self._offers_again = ProposalLog(proposals), False
        self._tell = tell or (lambda robot, text: self._say(robot, text, "info"))
        self._objects, self._judge, self._begin_for = objects, judge, begin_for
        self._mailboxes: Mailboxes[str] = Mailboxes(self._on_defect)
        self._weighing: dict[str, int] = {}
        """How often each robot was told to stand still: what is being weighed then is not done."""
        self._approvals = Offers(self._proposals, clock, approval, policies)
        self._board = PlanBoard(self._catalogue, objects)
        self._held_by: dict[str, Principal] = {}
        """Who told each robot to stand still, until it goes on."""
        self._listeners = 0
        """How many listen to the plans."""
        self._questions, self._left = OpenQuestions(), LeftGraphs()

    async def open(self) -> None:
        """See `Node.open`."""
        await self.opened.enter_async_context(self._proposals)
        await self.opened.enter_async_context(self._mailboxes)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._presence.on_status)
        self.opened.callback(self.transport.on_endpoints_changed(self._on_ends))
        self.spawn(self._presence.watch(), name="presence")

    def _on_defect(self, target: str, error: Exception) -> None:
        self._say(target, orders.NOTHING_DONE, "error")

    # -- what an earlier process left ------------------------------------------------------------------

    def restore(self, target: str, steps: Sequence[Step]) -> None:
        """Hold `steps`, which an earlier process left, until the operator says to go on or to drop them."""
        plan = self._plan(target)
        plan.restore(steps)
        self._send(plan, [])

    def adopt(self, target: str, name: str, steps: Sequence[Step], *, dry: bool) -> None:
        """Hold the plan behind a graph that an earlier process left and the engine of `target` took up."""
        plan = self._plan(target)
        plan.adopt(name, steps, dry=dry)
        self._send(plan, [])

    def hold_graph(self, target: str, name: str) -> None:
        """The engine of `target` holds a graph that an earlier process left; the same words go for it."""
        self._left.hold(self._plan(target).target, name)

    def offer_again(self) -> None:
        """Propose what an earlier process left waiting for a yes, now and to robots that come later.

        Called when the plans it left are restored: a repair goes in the place of a step of theirs.
        """
        self._offers_again = True
        for robot in self._presence.names():
            self._offer_left(robot)

    def _offer_left(self, robot: str) -> None:
        status = self._presence.get(robot) if self._offers_again else None
        for proposal, text in self._approvals.take_left(self._plan(robot), status) if status else ():
            if proposal is not None:
                self.publish(topics.PLAN, proposal)
            self._send(self._plan(robot), [])
            self._tell(robot, text)

    # -- who is there ----------------------------------------------------------------------------------

    def _targets(self, order: ChatAction, what: str) -> list[str]:
        """The robots an order is for; no addressee or an unknown one means no motion."""
        found: list[str] = []
        for name in order.targets:
            known = self._presence.resolve(name)
            if known is None:
                problem = Problem(
                    "targets", f"no robot is called {name!r}", self._presence.known_text(), "unknown_robot"
                )
                self._refuse(what, name, [problem])
                self._say(name, orders.no_robot(name, self._presence.known_text()), "error")
            elif known not in found:
                found.append(known)
        if not order.targets:
            self._refuse(
                what,
                "",
                [Problem("targets", "no robot is named", self._presence.known_text(), "no_robot")],
            )
        return found

    def _catalogue(self, target: str) -> Sequence[ActionInfo]:
        status = self._presence.get(target)
        return status.catalogue if status is not None else ()

    def _on_presence(self, robot: str, joined: bool) -> None:
        if joined and self._approvals.policy(robot) != "run_at_once":
            self._send(self._plan(robot), [])
        if joined:
            self._offer_left(robot)
        plan = self._plans.get(robot)
        if plan is None:
            return
        if not joined:
            text = sentence("I have lost contact with {robot}. Its plan is kept.", robot=robot)
            if plan.pending:
                self._say(robot, text, "error")
        elif (status := self._presence.get(robot)) is not None:
            self._send(plan, plan.on_return(status.graphs))

    def _speaks_parley(self, target: str) -> bool:
        return self._presence.get(target) is not None

    # -- their plans -----------------------------------------------------------------------------------

    def _on_ends(self) -> None:
        """Tell all plans again when somebody new listens; saying the same twice does no harm."""
        name = topics.PLAN.name
        ends = self.transport.endpoints()
        before, self._listeners = (
            self._listeners,
            sum(e.role == "subscription" and e.name == name for e in ends),
        )
        if self._listeners > before:
            for told in (*self._board.shown, *self._approvals.waiting):
                self.publish(topics.PLAN, told)

    def _plan(self, target: str) -> TargetPlan:
        plan = self._plans.get(target)
        if plan is None:
            plan = self._plans[target] = TargetPlan(
                target,
                new_graph_name=lambda: f"{target}_{uuid.uuid4().hex[:12]}",
                waits_for_operator=lambda action: self._has_effect(target, action, "asks_operator"),
                can_end_step=lambda: self._speaks_parley(target),
            )
        return plan

    def _has_effect(self, target: str, action: str, effect: str) -> bool:
        status = self._presence.get(target)
        return status is not None and any(i.name == action and effect in i.effects for i in status.catalogue)

    def _send(self, plan: TargetPlan, effects: Sequence[Effect]) -> None:
        super()._send(plan, effects)
        self._approvals.drop_settled(plan)
        update = self._board.show(plan, self._approvals, self._held_by.get(plan.target))
        if update is not None:
            self.publish(topics.PLAN, update)
