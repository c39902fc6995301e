"""What is known of each robot that plans are made for: whether it is there, its plan, what waits for a yes.

The planner node decides what becomes of these; what there is to tell of them is told here.
"""

from __future__ import annotations

import uuid
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Final, Literal

from parley.agents.base import Node
from parley.agents.planner import orders as orders
from parley.agents.planner.approval import PlanBoard
from parley.agents.planner.check import check_calls, complete_calls
from parley.agents.planner.effects import Effect, PauseGraph
from parley.agents.planner.left_graphs import LeftGraphs
from parley.agents.planner.offers import Offers
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.restore import adopted_steps, interruption_text, met_text, restored_steps
from parley.agents.planner.sending import Patience, PlanSender
from parley.agents.planner.steps import Step
from parley.agents.planner.welcome import Welcome
from parley.agents.presence import Presence, linked_to
from parley.agents.questions import OpenQuestions
from parley.clock import Clock
from parley.engine.interrupted import Interrupted
from parley.errors import Problem
from parley.gate.judge import Judgement
from parley.gate.table import Effect as GateEffect
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.principal import Principal
from parley.messages.robot import UnfinishedRun
from parley.messages.status import ActionInfo, ActorStatus, PlanRuling
from parley.sentences import sentence, together
from parley.umrf.model import GraphState, NodeState
from parley.world.object_map import MapObject

__all__ = ["RobotPlans"]

_KNOWN_GRAPHS: Final = 1000


class RobotPlans:
    """One plan per robot, kept while it is away, told to everybody at each change.

    Args:
        node: Whose topics.
        clock: Its wall time says who is gone.
        known_robots: Robots that send no heartbeat of ours (a TeMoto engine).
        approvals: What waits for a yes.
        patience: How long an engine is waited for.
        tell: Gets a robot, what it has to say by itself and whether that asks for a yes; None says it at
            once, to whoever listens.
        objects: The things a robot's map knows, by the robot's name.
        met: Gets a robot whose engine said what is unfinished, and whether there was anything to say of it.
    """

    def __init__(
        self,
        node: Node,
        clock: Clock,
        *,
        known_robots: Sequence[str],
        approvals: Offers,
        patience: Patience,
        tell: Callable[[str, str, bool], None] | None,
        objects: Callable[[str], Sequence[MapObject]],
        met: Callable[[str, bool], None],
    ) -> None:
        self._node = node
        self._sender = PlanSender(node, patience, self._speaks_parley, self.send)
        self.say, self.refuse = self._sender.say, self._sender.refuse
        self.presence = Presence(
            clock, tuple(known_robots), self._on_presence, linked=linked_to(node.transport)
        )
        self.by_robot: dict[str, TargetPlan] = {}
        """By robot: those that were ever needed."""
        self.approvals, self.objects = approvals, objects
        self.settle = approvals.drop_settled
        """Forgets what waits for a yes and is over; looked at whenever a plan changes."""
        self.board = PlanBoard(self.catalogue, objects, clock.unix_ms())
        self.held_by: dict[str, Principal] = {}
        """Who told each robot to stand still, until it goes on."""
        self.questions, self.left = OpenQuestions(), LeftGraphs()
        self._tell = tell or (lambda robot, text, asks_yes: self.say(robot, text, "info", asks_yes=asks_yes))
        self._welcome = Welcome(
            node, self.presence.on_status, self._take_up, self._tell, self._on_arrival, met
        )
        self.met, self.settled, self.is_asked = (
            self._welcome.met,
            self._welcome.settled,
            self._welcome.is_asked,
        )
        self._graphs: deque[str] = deque(maxlen=_KNOWN_GRAPHS)
        """The graphs that were planned or taken up here."""
        self._offers_again = False
        self._listeners = 0
        """How many listen to the plans."""

    async def open(self) -> None:
        """Hear which robots are there; closed with the node."""
        await self._node.subscribe(topics.ACTOR_STATUS, ActorStatus, self._welcome.on_status)
        self._node.opened.callback(self._node.transport.on_endpoints_changed(self._on_ends))
        self._node.spawn(self.presence.watch(), name="presence")

    # -- what an earlier process left ------------------------------------------------------------------

    def restore(self, target: str, steps: Sequence[Step], continues: str = "") -> None:
        """Hold `steps`, which an earlier process left, until the operator says to go on or to drop them."""
        plan = self.plan(target)
        plan.restore(steps, continues)
        self.send(plan, [])

    def adopt(self, target: str, name: str, steps: Sequence[Step], *, dry: bool) -> None:
        """Hold the plan behind a graph that an earlier process left and the engine of `target` took up."""
        plan = self.plan(target)
        plan.adopt(name, steps, dry=dry)
        self.send(plan, [])

    def hold_graph(self, target: str, name: str) -> None:
        """The engine of `target` holds a graph that an earlier process left; the same words go for it."""
        self.left.hold(self.plan(target).target, name)

    def _take_up(self, robot: str, run: UnfinishedRun, was: Interrupted) -> str:
        """Take up what the engine of a robot has not brought to an end; what is to be said of it."""
        plan, name, held = self.plan(robot), was.graph.name, run.goes_on == "engine"
        if name in self._graphs:
            return interruption_text(was, True) if run.left and held and plan.pending else ""
        self._graphs.append(name)
        steps: Sequence[Step] = ()
        if not plan.pending and (was.has_flow or not (run.left and held)):
            finding = {info.name for info in self.catalogue(robot) if info.only_finds}
            anew = run.goes_on == "anew"
            steps = adopted_steps(was) if held else restored_steps(was, finding) if anew else ()
        if steps and held:
            self._adopt_run(plan, run, was, steps)
        elif steps:
            self.restore(robot, steps, name)
        elif held:
            self.hold_graph(robot, name)
        return interruption_text(was, held or steps) if run.left else met_text(was)

    def _adopt_run(
        self, plan: TargetPlan, run: UnfinishedRun, was: Interrupted, steps: Sequence[Step]
    ) -> None:
        state, name = was.graph.state, was.graph.name
        failed = any(node.state is NodeState.ERROR for node in was.graph.nodes)
        meets = not run.left and not failed
        going = meets and state is GraphState.RUNNING
        plan.adopt(name, steps, dry=state is GraphState.HALTED, going=going)
        holds = [PauseGraph(name)] if state is GraphState.RUNNING and failed and not run.left else []
        self.send(plan, plan.reports.on_graph(was.graph) if meets else holds)

    def offer_again(self) -> None:
        """Propose what an earlier process left waiting for a yes, now and to robots that come later.

        Called when the plans it left are restored: a repair goes in the place of a step of theirs.
        """
        self._offers_again = True
        for robot in self.presence.names():
            self._offer_left(robot)

    def _offer_left(self, robot: str) -> None:
        status = self.presence.get(robot) if self._offers_again else None
        for proposal, text in self.approvals.take_left(self.plan(robot), status) if status else ():
            if proposal is not None:
                self._node.publish(topics.PLAN, proposal)
            self.send(self.plan(robot), [])
            self._tell(robot, text, proposal is not None)

    # -- who is there ----------------------------------------------------------------------------------

    def targets(self, order: ChatAction, what: str) -> list[str]:
        """The robots an order is for; no addressee or an unknown one means no motion."""
        found: list[str] = []
        for name in order.targets:
            known = self.presence.resolve(name)
            if known is None:
                problem = Problem(
                    "targets", f"no robot is called {name!r}", self.presence.known_text(), "unknown_robot"
                )
                self.refuse(what, name, [problem])
                self.say(name, orders.no_robot(name, self.presence.known_text()), "error")
            elif known not in found:
                found.append(known)
        if not order.targets:
            self.refuse(
                what,
                "",
                [Problem("targets", "no robot is named", self.presence.known_text(), "no_robot")],
            )
        return found

    def catalogue(self, target: str) -> Sequence[ActionInfo]:
        """What a robot can do; nothing while it is not there."""
        status = self.presence.get(target)
        return status.catalogue if status is not None else ()

    def _on_presence(self, robot: str, joined: bool) -> None:
        plan = self.by_robot.get(robot)
        if not joined and plan is not None and plan.pending:
            text = sentence("I have lost contact with {robot}. Its plan is kept.", robot=robot)
            self.say(robot, text, "error")
        if joined and not self.is_asked(robot):
            self._on_arrival(robot, None)

    def _on_arrival(self, robot: str, graphs: Mapping[str, str] | None) -> None:
        """A robot is there, or its engine was started anew; with these graphs, if it has told."""
        if self.approvals.policy(robot) != "run_at_once":
            self.send(self.plan(robot), [])
        self._offer_left(robot)
        plan, status = self.by_robot.get(robot), self.presence.get(robot)
        if plan is not None and status is not None:
            self.send(plan, plan.reports.on_return(status.graphs if graphs is None else graphs))

    def _speaks_parley(self, target: str) -> bool:
        status = self.presence.get(target)
        return status is not None and status.engine == "parley"

    # -- their plans -----------------------------------------------------------------------------------

    def _on_ends(self) -> None:
        """Tell all plans again when somebody new listens; saying the same twice does no harm."""
        name = topics.PLAN.name
        ends = self._node.transport.endpoints()
        before, self._listeners = (
            self._listeners,
            sum(e.role == "subscription" and e.name == name for e in ends),
        )
        if self._listeners > before:
            for told in (*self.board.shown, *self.approvals.waiting):
                self._node.publish(topics.PLAN, told)

    def plan(self, target: str) -> TargetPlan:
        """The plan of a robot, empty at first."""
        plan = self.by_robot.get(target)
        if plan is None:
            plan = self.by_robot[target] = TargetPlan(
                target,
                new_graph_name=lambda: self._new_name(target),
                waits_for_operator=lambda action: self._has_effect(target, action, "asks_operator"),
                can_end_step=lambda: self._speaks_parley(target),
            )
        return plan

    def _new_name(self, target: str) -> str:
        name = f"{target}_{uuid.uuid4().hex[:12]}"
        self._graphs.append(name)
        return name

    def _has_effect(self, target: str, action: str, effect: str) -> bool:
        status = self.presence.get(target)
        return status is not None and any(i.name == action and effect in i.effects for i in status.catalogue)

    def send(self, plan: TargetPlan, effects: Sequence[Effect]) -> None:
        """Send all of it, then the plan as it is now."""
        for effect in effects:
            self._sender.send(plan, effect)
        self.settle(plan)
        update = self.board.show(plan, self.approvals, self.held_by.get(plan.target))
        if update is not None:
            self._node.publish(topics.PLAN, update)

    def accept(
        self,
        plan: TargetPlan,
        queue: Sequence[ActionCall],
        *,
        correcting: bool = False,
        refuse: Callable[[Sequence[ActionCall], Sequence[Problem]], None] | None = None,
    ) -> list[ActionCall] | None:
        """The completed actions, or None (and everybody told) if the robot cannot carry them out.

        Args:
            plan: Of the robot.
            queue: The actions.
            correcting: Whether they take the failed step's place.
            refuse: Tells so where a person put them together.
        """
        if queue and len(plan.pending) >= orders.MOST_STEPS and not (correcting or refuse):
            self.say(plan.target, orders.MUCH_TO_DO, "error")
            return None
        catalogue = self.catalogue(plan.target)
        calls = complete_calls(queue, catalogue)
        put = plan.correction(calls) if correcting else calls
        problems = check_calls(put, catalogue, path="steps" if refuse else "queue")
        if not problems:
            return calls
        if refuse:
            refuse(put, problems)
        else:
            self.refuse(topics.CHAT_ACTION.name, plan.target, problems)
            self.say(plan.target, orders.WAITING_HELPLESS if correcting else orders.NOTHING_DONE, "error")
        return None

    def forbid(self, target: str, judgement: Judgement, before: int = 0) -> list[str]:
        """Tell everybody what the rules forbid, in words; `before`: how many steps stand before those."""
        texts = orders.reasons(judgement.forbidden, before)
        self.say(target, together(*texts), "error")
        rules = tuple(dict.fromkeys(finding.rule for finding in judgement.forbidden))
        self._node.publish(topics.RULING, PlanRuling(order="", target=target, outcome="refused", rules=rules))
        return texts

    def audit(
        self, effect: GateEffect, order: ChatAction, target: str, outcome: Literal["asked", "refused"]
    ) -> None:
        """Put on record what did not begin at once."""
        self._node.publish(
            topics.AUDIT,
            AuditEvent(effect=effect, by=order.by, robot=target, outcome=outcome, words=order.words),
        )
