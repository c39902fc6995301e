"""What becomes of an order: done, waiting for a yes, or refused. The gate rules; here it is carried out."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from typing import Final, Literal

from parley.agents.base import Mailboxes, Node
from parley.agents.planner import orders
from parley.agents.planner.asking import SHALL_I, wish_of
from parley.agents.planner.check import complete_calls
from parley.agents.planner.commands import Commands
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.presses import Presses
from parley.agents.planner.proposing import Proposals
from parley.agents.planner.robot_plans import RobotPlans
from parley.errors import LanguageError
from parley.gate.control import control_of
from parley.gate.judge import Finding, Judgement
from parley.gate.risk import always_asks
from parley.gate.ruling import EFFECT_OF, Ruling, rule
from parley.gate.table import Effect, verdict
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.principal import Principal
from parley.messages.status import ActionInfo, PlanRuling
from parley.sentences import sentence, together
from parley.world.geometry import Pose2D

__all__ = ["BeginFor", "Judge", "Ordering"]

Judge = Callable[
    [str, Sequence[ActionCall], Sequence[ActionInfo], Pose2D | None, Principal | None, bool],
    Awaitable[Judgement | None],
]
"""What the rules say: robot, steps, its actions, where it is, on whose account, whether risks count."""
BeginFor = Callable[[str, Principal | None], None]
"""Told on whose account a robot acts from now on."""
WEIGHED_WITHIN_S: Final = 5.0
"""Wall time in which it is known what the rules say about steps; then a person is asked."""
NOT_WEIGHED: Final = sentence("I could not find out in time where that leads")
SKIPPED: Final = ActionCall(name="(left out)")
"""Stands for leaving a failed step out and going on, which is a change of the plan like any other."""


class Ordering:
    """Orders and repairs, each robot's in their order.

    Args:
        node: Whose topics.
        plans: What is known of each robot.
        proposals: Where what waits for a yes is put.
        commands: Does what a command says.
        judge: What the rules say about steps; None: there are none.
        presses: Of buttons.
    """

    def __init__(
        self,
        node: Node,
        plans: RobotPlans,
        proposals: Proposals,
        commands: Commands,
        judge: Judge | None,
        presses: Presses,
    ) -> None:
        self._node, self._plans, self._proposals, self._commands = node, plans, proposals, commands
        self._judge, self._presses = judge, presses
        self._mailboxes: Mailboxes[str] = Mailboxes(self._on_defect)
        self._weighing: dict[str, int] = {}
        """How often each robot was told to stand still: what is being weighed then is not done."""

    async def open(self) -> None:
        """Take orders; closed with the node."""
        await self._node.opened.enter_async_context(self._mailboxes)
        await self._node.subscribe(topics.CHAT_ACTION, ChatAction, self._on_chat_action, in_charge=True)
        await self._node.subscribe(topics.UMRF_CORRECTION, ChatAction, self._on_correction, in_charge=True)

    def _on_defect(self, target: str, error: Exception) -> None:
        self._plans.say(target, orders.NOTHING_DONE, "error")

    def _on_chat_action(self, order: ChatAction) -> None:
        commands = orders.of_plans(order)
        halting = [item for item in commands if EFFECT_OF[item.command] is Effect.PAUSE]
        if not self._presses.counts(order.press, ",".join(order.targets), harmless=bool(halting)):
            return
        targets = self._plans.targets(order, "chat_action")
        self._commands.remember(order, targets)
        for target in targets:
            if halting:  # waits for nothing, not even for what is being weighed
                self._weighing[target] = self._weighing.get(target, 0) + 1
            self._in_turn(target, order, self._carry_out)

    def _on_correction(self, order: ChatAction) -> None:
        targets = self._plans.targets(order, "umrf_correction")
        self._commands.remember(order, targets)
        for target in targets:
            if order.success is False:
                plan = self._plans.plan(target)
                self._plans.send(plan, plan.give_up())
            else:
                self._in_turn(target, order, self._repair)

    def _in_turn(
        self, target: str, order: ChatAction, do: Callable[[TargetPlan, ChatAction, Judgement | None], None]
    ) -> None:
        """Do what an order says once its steps are weighed; orders to one robot keep their order."""
        plan = self._plans.plan(target)
        halts = any(EFFECT_OF[item.command] is Effect.PAUSE for item in orders.of_plans(order))
        if halts and not self._plans.is_asked(target):
            do(plan, order, None)
            return

        def halted() -> None:
            self._tell_ruling(plan, order, Ruling(begins="refuse"), asked=False, refused=True)

        self.weighed(
            target, order.queue, order.behalf or order.by, lambda found: do(plan, order, found), halted
        )

    def weighed(
        self,
        target: str,
        calls: Sequence[ActionCall],
        by: Principal | None,
        do: Callable[[Judgement | None], None],
        halted: Callable[[], None],
    ) -> None:
        """Go on once steps are weighed and it is known what the robot does; orders to one keep their order.

        Args:
            target: The robot.
            calls: The steps.
            by: On whose account.
            do: Gets what the rules say; None: nothing.
            halted: Called instead if somebody told the robot to stand still meanwhile.
        """
        weighs = self._judge is not None and bool(calls)
        waits = weighs or self._plans.is_asked(target)
        halts = self._weighing.get(target, 0)
        if not waits and target not in self._mailboxes.busy:
            do(None)
            return

        async def work() -> None:
            await self._plans.settled(target)
            judgement = await self._weigh(target, calls, by) if weighs else None
            if halts == self._weighing.get(target, 0):
                do(judgement)
            else:
                halted()

        self._mailboxes.post(target, work)

    async def _weigh(
        self, target: str, steps: Sequence[ActionCall], by: Principal | None
    ) -> Judgement | None:
        assert self._judge is not None
        catalogue, status = self._plans.catalogue(target), self._plans.presence.get(target)
        pose = status.pose if status is not None else None
        here = Pose2D(pose.x, pose.y, pose.yaw) if pose is not None else None
        calls = complete_calls(steps, catalogue)
        asks = self._plans.approvals.policy(target) == "ask_when_risky"
        try:
            async with asyncio.timeout(WEIGHED_WITHIN_S):
                return await self._judge(target, calls, catalogue, here, by, asks)
        except (LanguageError, TimeoutError) as error:
            self._node.log.warning("not weighed", target=target, error=repr(error))
            return Judgement(ask=(Finding(-1, "", "way_unknown", NOT_WEIGHED),))

    def _carry_out(self, plan: TargetPlan, order: ChatAction, judgement: Judgement | None) -> None:
        calls = self._plans.accept(plan, order.queue)
        if calls and judgement is not None and judgement.forbidden:
            self._forbid(plan, order, judgement)
            calls = None
        commands = orders.in_order(orders.of_plans(order))
        replaced = self._plans.approvals.get(order.replaces) if order.replaces and calls is not None else None
        if replaced is not None and replaced.target == plan.target:
            self._plans.approvals.drop(replaced.id)
            self._plans.send(plan, [])
            offered, wanted = _deeds(replaced.steps), _deeds(order.queue)
            if replaced.why and offered & wanted and offered != wanted:  # more or less is no yes to a doubt
                order = order.model_copy(update={"needs_yes": replaced.why})
        if calls is None:  # nothing of such an order is done, but stopping is never refused
            commands = [item for item in commands if EFFECT_OF[item.command] is Effect.PAUSE]
        ruling = self._rule(plan, order, calls or (), commands, judgement=judgement)
        for command in ruling.do:
            self._plans.send(plan, self._commands.effects_of(plan, command, order.by))
        asks = bool(ruling.ask) or ruling.begins == "ask"
        crowded = asks and len(self._plans.approvals.of(plan.target)) >= orders.MOST_WAITING
        if crowded:
            self._plans.say(plan.target, orders.TOO_MANY_WAIT, "error")
        elif asks:
            self._proposals.propose(
                plan, order, calls or (), ruling.ask, why=self._why(plan, order, judgement)
            )
        elif calls and ruling.begins == "now":
            own = order.by is not None and self._plans.held_by.get(plan.target) == order.by
            goes_on = own and verdict(order.by, Effect.RESUME) in ("allow", "own")
            self._commands.append(plan, calls, order, order.behalf or order.by, goes_on=goes_on)
        self._tell_ruling(plan, order, ruling, asked=asks and not crowded, refused=calls is None or crowded)

    def _forbid(self, plan: TargetPlan, order: ChatAction, judgement: Judgement) -> None:
        """Say which rules a plan would break."""
        self._plans.forbid(plan.target, judgement)
        self._plans.audit(Effect.BEGIN, order, plan.target, "refused")

    def _why(self, plan: TargetPlan, order: ChatAction, judgement: Judgement | None) -> str:
        """Why a yes is needed, where the policy alone would not ask."""
        if order.needs_yes or judgement is None or self._plans.approvals.policy(plan.target) == "ask_first":
            return order.needs_yes
        return "; ".join(text.rstrip(".") for text in orders.reasons((*judgement.ask, *judgement.risky)))

    def _repair(self, plan: TargetPlan, order: ChatAction, judgement: Judgement | None) -> None:
        control = orders.in_order(orders.of_plans(order))
        clears = any(command.command == "clear" for command in control)
        calls = self._plans.accept(plan, order.queue, correcting=not clears)
        if calls and judgement is not None and judgement.forbidden:
            self._forbid(plan, order, judgement)
            self._plans.say(plan.target, orders.WAITING, "info")
            calls = None
        if calls is None:
            self._plans.send(plan, plan.give_up())
        elif plan.failed is not None or clears:
            self._correct(plan, order, calls, control, judgement)
        else:  # what failed went on meanwhile, and "I go on" may have been said too early
            self._let_go_on(plan, order)

    def _correct(
        self,
        plan: TargetPlan,
        order: ChatAction,
        calls: list[ActionCall],
        control: Sequence[SystemCommand],
        judgement: Judgement | None,
    ) -> None:
        """Repair, unless what nobody said yes to waits for it first; the robot is held till then."""
        failed, clears = plan.failed, any(command.command == "clear" for command in control)
        same = failed is not None and [*map(orders.bare, calls)] == [orders.bare(failed.call)]
        retries = any(command.command == "start" for command in control) and not calls
        halting = [c for c in control if EFFECT_OF[c.command] is Effect.PAUSE]
        if halting:
            self._plans.send(plan, plan.give_up())
            return
        changes = [command for command in control if command.command != "start"]
        known = (same or retries) and not changes and not order.needs_yes  # agreed to before it failed
        ruling = self._rule(
            plan, order, calls or (SKIPPED,), changes, begin=Effect.REPAIR, known=known, judgement=judgement
        )
        if known or (ruling.begins == "now" and not ruling.refused):
            for command in changes:
                self._plans.send(plan, self._commands.effects_of(plan, command, order.by))
            if clears and calls:
                self._plans.send(plan, plan.append(calls, order.words))
            elif not clears:
                self._plans.send(
                    plan, plan.correct([failed.call] if retries and failed is not None else calls)
                )
                self._let_go_on(plan, order)
        elif ruling.begins == "ask":
            asked = changes
            if retries and failed is not None:
                calls = [failed.call]
            if not calls and not clears and failed is not None:
                asked = [SystemCommand(command="skip")]
            proposal = self._proposals.propose(
                plan, order, calls, asked, repairs=None if clears or not calls else failed
            )
            text = together(wish_of(proposal.lines, proposal.why), SHALL_I)
            self._plans.say(plan.target, text, "info", asks_yes=True)
        else:
            self._plans.send(plan, plan.give_up())

    def _let_go_on(self, plan: TargetPlan, order: ChatAction) -> None:
        """Who stood already when a step failed goes on by a person's own words, or says that it stands."""
        if plan.update().state != "paused":
            return
        by = order.behalf or order.by
        told = control_of(order.words, self._plans.presence.names()) == "start"
        if told and by is not None and by.is_person and verdict(by, Effect.RESUME) == "allow":
            self._plans.send(plan, self._commands.effects_of(plan, SystemCommand(command="start"), by))
        else:
            self._plans.say(plan.target, self._commands.still(plan.target), "info")

    def _rule(
        self,
        plan: TargetPlan,
        order: ChatAction,
        calls: Sequence[ActionCall],
        commands: Sequence[SystemCommand],
        *,
        begin: Effect = Effect.BEGIN,
        known: bool = False,
        judgement: Judgement | None = None,
    ) -> Ruling:
        target = plan.target
        catalogue = self._plans.catalogue(target)
        infos = {info.name: info for info in catalogue}
        risky = any(call is not SKIPPED and always_asks(infos.get(call.name)) for call in calls)
        # Speaking to an engine gives nobody more than ordering would.
        unknown = order.behalf is not None and verdict(order.behalf, begin) == "yes"
        held_by = self._plans.held_by.get(target)
        # New steps would take the place of the failed one at once, behind a plan that waits they wait.
        goes_on = plan.given_up and held_by is not None and held_by.is_person
        asks = unknown or goes_on or bool(order.needs_yes)
        return rule(
            order.by,
            self._plans.approvals.policy(target),
            () if known else calls,
            commands,
            needs_yes=asks or (judgement is not None and bool(judgement.ask)),
            risky=risky or (judgement is not None and bool(judgement.risky)),
            held_by=held_by,
            harmless=[command for command in commands if plan.keeps_still(command)],
            begin=begin,
        )

    def _tell_ruling(
        self, plan: TargetPlan, order: ChatAction, ruling: Ruling, *, asked: bool, refused: bool
    ) -> None:
        """Say what became of an order, to whoever sent it and to the log."""
        outcome: Literal["done", "asked", "refused"] = "done"
        if asked:
            outcome = "asked"
        elif refused or ruling.refused or ruling.begins == "refuse":
            outcome = "refused"
        waiting = self._plans.approvals.of(plan.target)
        lines = waiting[-1].lines if outcome == "asked" and waiting else ()
        why = waiting[-1].why if outcome == "asked" and waiting else ""
        if order.id:
            self._node.publish(
                topics.RULING,
                PlanRuling(order=order.id, target=plan.target, outcome=outcome, lines=lines, why=why),
            )
        for command in ruling.refused:
            self._plans.audit(EFFECT_OF[command.command], order, plan.target, "refused")
        if order.queue and ruling.begins != "now":
            self._plans.audit(Effect.BEGIN, order, plan.target, "asked" if outcome == "asked" else "refused")


def _deeds(calls: Sequence[ActionCall]) -> set[str]:
    """What steps do; one that is told nothing itself goes by those before it."""
    found: list[str] = []
    for call in calls:
        given = sorted((name, value.value) for name, value in call.input_parameters.items() if value.has_data)
        led = found[-1] if found and not given else ""
        found.append(f"{led} {call.name} {given}")
    return {*found}
