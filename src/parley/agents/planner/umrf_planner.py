"""The UMRF planner node: from Chat Actions to graphs, and from feedback to what happens next (thesis 4.3.6).

It only wires: what a robot's plan becomes is decided in `parley.agents.planner.plan`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import ClassVar, Final, Literal

from parley.agents.planner import orders as orders
from parley.agents.planner.approval import Bound
from parley.agents.planner.asking import CHANGED, REFUSED, SHALL_I, begun, wish_of
from parley.agents.planner.check import check_calls, complete_calls
from parley.agents.planner.effects import Effect as PlanEffect
from parley.agents.planner.effects import Say
from parley.agents.planner.flow import listed, rebased
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.remembering import memory_change
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.planner.steps import Step
from parley.errors import GraphRefusedError, LanguageError, Problem
from parley.gate.cards import Labels, command_label, digest_of, labels_of
from parley.gate.judge import Finding, Judgement
from parley.gate.risk import always_asks
from parley.gate.ruling import EFFECT_OF, Policy, Ruling, rule
from parley.gate.table import Effect, verdict
from parley.messages import ros, topics
from parley.messages.audit import AuditEvent
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.memory import AddToMemory, RemoveMemory
from parley.messages.principal import Principal, person
from parley.messages.status import (
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanRuling,
    Rejection,
    StopCommand,
)
from parley.sentences import sentence, together
from parley.umrf.io import read_graph
from parley.world.geometry import Pose2D

__all__ = ["UmrfPlanner"]

DECIDES: Final = {
    "approve": Effect.APPROVE, "reject": Effect.REJECT, "edit": Effect.EDIT, "policy": Effect.POLICY,
}  # fmt: skip
WEIGHED_WITHIN_S: Final = 5.0
"""Wall time in which it is known what the rules say about steps; then a person is asked."""
NOT_WEIGHED: Final = sentence("I could not find out in time where that leads")
SKIPPED: Final = ActionCall(name="(left out)")
"""Stands for leaving a failed step out and going on, which is a change of the plan like any other."""


class UmrfPlanner(RobotPlans):
    """Sends graphs, reads feedback, holds a robot whose step failed; see `RobotPlans` for the arguments."""

    name: ClassVar[str] = "umrf_planner"

    async def open(self) -> None:
        """See `Node.open`."""
        await super().open()
        self.announce(topics.RULING)
        await self.subscribe(topics.CHAT_ACTION, ChatAction, self._on_chat_action)
        await self.subscribe(topics.UMRF_CORRECTION, ChatAction, self._on_correction)
        await self.subscribe(topics.PLAN_DECISION, PlanDecision, self._on_decision)
        await self.subscribe(topics.STOP, StopCommand, self._on_emergency)
        await self.subscribe(topics.REJECTION, Rejection, self._on_rejection)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._on_event)
        await self.subscribe_raw(topics.GRAPH_FEEDBACK, self._on_feedback, depth=100)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)

    # -- orders ----------------------------------------------------------------------------------------

    def _on_chat_action(self, order: ChatAction) -> None:
        targets = self._targets(order, "chat_action")
        self._remember(order, targets)
        commands = orders.of_plans(order)
        halting = [item for item in commands if EFFECT_OF[item.command] is Effect.PAUSE]
        for target in targets:
            if halting:  # waits for nothing, not even for what is being weighed
                self._weighing[target] = self._weighing.get(target, 0) + 1
            self._in_turn(target, order, self._carry_out)

    def _on_correction(self, order: ChatAction) -> None:
        targets = self._targets(order, "umrf_correction")
        self._remember(order, targets)
        for target in targets:
            if order.success is False:
                plan = self._plan(target)
                self._send(plan, plan.give_up())
            else:
                self._in_turn(target, order, self._repair)

    def _in_turn(
        self, target: str, order: ChatAction, do: Callable[[TargetPlan, ChatAction, Judgement | None], None]
    ) -> None:
        """Do what an order says once its steps are weighed; orders to one robot keep their order."""
        plan = self._plan(target)
        weighs = self._judge is not None and bool(order.queue)
        halts = self._weighing.get(target, 0)
        stops = any(EFFECT_OF[item.command] is Effect.PAUSE for item in orders.of_plans(order))
        if stops or (not weighs and target not in self._mailboxes.busy):
            do(plan, order, None)
            return

        async def work() -> None:
            judgement = await self._weigh(target, order) if weighs else None
            if halts == self._weighing.get(target, 0):
                do(plan, order, judgement)
            else:  # somebody told the robot to stand still meanwhile
                self._tell_ruling(plan, order, Ruling(begins="refuse"), refused=True)

        self._mailboxes.post(target, work)

    async def _weigh(self, target: str, order: ChatAction) -> Judgement | None:
        assert self._judge is not None
        catalogue, status = self._catalogue(target), self._presence.get(target)
        pose = status.pose if status is not None else None
        here = Pose2D(pose.x, pose.y, pose.yaw) if pose is not None else None
        calls = complete_calls(order.queue, catalogue)
        asks = self._approvals.policy(target) == "ask_when_risky"
        try:
            async with asyncio.timeout(WEIGHED_WITHIN_S):
                return await self._judge(target, calls, catalogue, here, order.behalf or order.by, asks)
        except (LanguageError, TimeoutError) as error:
            self.log.warning("not weighed", target=target, error=repr(error))
            return Judgement(ask=(Finding(-1, "", "way_unknown", NOT_WEIGHED),))

    def _carry_out(self, plan: TargetPlan, order: ChatAction, judgement: Judgement | None) -> None:
        calls = self._accept(plan, order.queue)
        if calls and judgement is not None and judgement.forbidden:
            self._forbid(plan, order, judgement)
            calls = None
        commands = orders.in_order(orders.of_plans(order))
        if calls is None:  # nothing of such an order is done, but stopping is never refused
            commands = [item for item in commands if EFFECT_OF[item.command] is Effect.PAUSE]
        ruling = self._rule(plan, order, calls or (), commands, judgement=judgement)
        for command in ruling.do:
            self._send(plan, self._command(plan, command, order.by))
        if ruling.ask or ruling.begins == "ask":
            self._propose(plan, order, calls or (), ruling.ask, why=self._why(plan, order, judgement))
        elif calls and ruling.begins == "now":
            self._begin_for(plan.target, order.behalf or order.by)
            self._append(plan, calls)
        self._tell_ruling(plan, order, ruling, refused=calls is None)

    def _forbid(self, plan: TargetPlan, order: ChatAction, judgement: Judgement) -> None:
        """Say which rules a plan would break."""
        texts = list(dict.fromkeys(finding.sentence for finding in judgement.forbidden))
        self._say(plan.target, together(*texts), "error")
        self._audit(Effect.BEGIN, order, plan.target, "refused")

    def _why(self, plan: TargetPlan, order: ChatAction, judgement: Judgement | None) -> str:
        """Why a yes is needed, where the policy alone would not ask."""
        if order.needs_yes or judgement is None or self._approvals.policy(plan.target) == "ask_first":
            return order.needs_yes
        found = [finding.sentence.rstrip(".") for finding in (*judgement.ask, *judgement.risky)]
        return "; ".join(dict.fromkeys(found))

    def _repair(self, plan: TargetPlan, order: ChatAction, judgement: Judgement | None) -> None:
        control = orders.in_order(orders.of_plans(order))
        clears = any(command.command == "clear" for command in control)
        calls = self._accept(plan, order.queue, correcting=not clears)
        if calls and judgement is not None and judgement.forbidden:
            self._forbid(plan, order, judgement)
            calls = None
        if calls is None:
            self._send(plan, plan.give_up())
        elif plan.failed is not None or clears:
            self._correct(plan, order, calls, control, judgement)

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
            self._send(plan, plan.give_up())
            return
        changes = [command for command in control if command.command != "start"]
        known = (same or retries) and not changes and not order.needs_yes  # agreed to before it failed
        ruling = self._rule(
            plan, order, calls or (SKIPPED,), changes, begin=Effect.REPAIR, known=known, judgement=judgement
        )
        if known or (ruling.begins == "now" and not ruling.refused):
            for command in changes:
                self._send(plan, self._command(plan, command, order.by))
            if clears and calls:
                self._send(plan, plan.append(calls))
            elif not clears:
                self._send(plan, plan.correct([failed.call] if retries and failed is not None else calls))
        elif ruling.begins == "ask":
            asked = changes
            if retries and failed is not None:
                calls = [failed.call]
            if not calls and not clears and failed is not None:
                asked = [SystemCommand(command="skip")]
            proposal = self._propose(
                plan, order, calls, asked, repairs=None if clears or not calls else failed
            )
            self._say(plan.target, together(wish_of(proposal.labels, proposal.why), SHALL_I), "info")
        else:
            self._send(plan, plan.give_up())

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
        catalogue = self._catalogue(target)
        infos = {info.name: info for info in catalogue}
        risky = any(call is not SKIPPED and always_asks(infos.get(call.name)) for call in calls)
        return rule(
            order.by,
            self._approvals.policy(target),
            () if known else calls,
            commands,
            needs_yes=bool(order.needs_yes) or (judgement is not None and bool(judgement.ask)),
            risky=risky or (judgement is not None and bool(judgement.risky)),
            held_by=self._held_by.get(target),
            begin=begin,
        )

    def _tell_ruling(self, plan: TargetPlan, order: ChatAction, ruling: Ruling, *, refused: bool) -> None:
        """Say what became of an order, to whoever sent it and to the log."""
        outcome: Literal["done", "asked", "refused"] = "done"
        if ruling.ask or ruling.begins == "ask":
            outcome = "asked"
        elif refused or ruling.refused or ruling.begins == "refuse":
            outcome = "refused"
        waiting = self._approvals.of(plan.target)
        labels = waiting[-1].labels if outcome == "asked" and waiting else ()
        why = waiting[-1].why if outcome == "asked" and waiting else ""
        if order.id:
            self.publish(
                topics.RULING,
                PlanRuling(order=order.id, target=plan.target, outcome=outcome, labels=labels, why=why),
            )
        for command in ruling.refused:
            self._audit(EFFECT_OF[command.command], order, plan.target, "refused")
        if order.queue and ruling.begins != "now":
            self._audit(Effect.BEGIN, order, plan.target, "asked" if outcome == "asked" else "refused")

    def _audit(
        self, effect: Effect, order: ChatAction, target: str, outcome: Literal["asked", "refused"]
    ) -> None:
        self.publish(
            topics.AUDIT,
            AuditEvent(effect=effect, by=order.by, robot=target, outcome=outcome, words=order.words),
        )

    # -- decisions -------------------------------------------------------------------------------------

    def _on_decision(self, decision: PlanDecision) -> None:
        target = self._presence.resolve(decision.target) or decision.target
        if verdict(decision.by, DECIDES[decision.decision]) != "allow":
            problem = Problem("by", "only a person decides that", "let a person say it", "not_a_person")
            self._refuse(topics.PLAN_DECISION.name, target, [problem])
            self.publish(
                topics.AUDIT,
                AuditEvent(
                    effect=DECIDES[decision.decision], by=decision.by, robot=target, outcome="refused"
                ),
            )
        elif decision.decision == "policy":
            self._set_policy(target, decision.policy)
        elif decision.decision == "edit" and not decision.id:
            self._edit(target, decision)
        else:
            self._decide(target, decision)

    def _decide(self, target: str, decision: PlanDecision) -> None:
        proposal = self._approvals.get(decision.id)
        if proposal is None or proposal.target != target:
            self._say(decision.target, "That plan is no longer waiting for an answer.", "error")
            return
        plan, repairs = self._plan(proposal.target), self._approvals.repairs(decision.id)
        if decision.decision == "reject":
            self._approvals.drop(decision.id)
            self._send(plan, plan.give_up() if repairs else [])
            self._say(plan.target, orders.WAITING if plan.held else REFUSED, "response")
            return
        shown = decision.digest or (proposal.digest if decision.decision == "edit" else "")
        if shown != proposal.digest or self._digest(proposal) != proposal.digest:
            self._show_again(plan, proposal)
            return
        edited = decision.decision == "edit"
        calls: list[ActionCall] | None = list(proposal.steps)
        if edited:
            calls, problems = rebased(decision.steps, proposal.steps)
            if problems:
                self._refuse_plan(plan, problems, decided=True)
                return
        calls = self._accept(plan, calls or (), correcting=repairs, decided=edited)
        if calls is None:
            return  # it goes on waiting, for a better edit
        bound = self._approvals.bound(decision.id)
        self._approvals.drop(decision.id)
        self._say(plan.target, CHANGED if edited else begun(proposal.labels), "response")
        if calls:  # whoever says yes to steps wants them done
            self._held_by.pop(plan.target, None)
            self._begin_for(plan.target, decision.by)
        for command, step in bound:
            self._change(plan, command, step, decision)
        if repairs:
            self._send(plan, orders.take_repair(plan, calls))
        elif calls:
            self._append(plan, calls)
            if plan.update().state == "paused":
                self._send(plan, plan.start())
        else:
            self._send(plan, [])

    def _digest(self, proposal: PlanProposal) -> str:
        return digest_of(proposal.target, proposal.steps, proposal.commands, self._objects(proposal.target))

    def _show_again(self, plan: TargetPlan, proposal: PlanProposal) -> None:
        """Something else was agreed to than what waits, or it would mean something else by now."""
        self._approvals.drop(proposal.id)
        labels = tuple(map(self.spoken, self._labels(plan, proposal.steps)))
        renewed = proposal.model_copy(update={"digest": self._digest(proposal), "labels": labels})
        if proposal.commands:
            self._say(plan.target, orders.PLAN_CHANGED, "error")
            self._send(plan, [])
            return
        shown = self._approvals.propose(renewed, self._presence.get(plan.target))
        self.publish(topics.PLAN, shown)
        self._send(plan, [])
        self._say(plan.target, together(orders.NOT_AS_SHOWN, wish_of(shown.labels), SHALL_I), "info")

    def _change(
        self, plan: TargetPlan, command: SystemCommand, step: Step | None, decision: PlanDecision
    ) -> None:
        """Do what a person said yes to, to the step that was meant."""
        if change := memory_change(command):
            self._remember(ChatAction(system_cmd=(command,), by=decision.by), [plan.target])
            assert not isinstance(change, Problem)
        elif command.command in ("pop", "skip"):
            if step in plan.pending:
                self._send(plan, plan.pop(plan.pending.index(step)))
            else:
                self._say(plan.target, orders.STEP_OVER, "info")
        else:
            self._send(plan, self._command(plan, command, decision.by))

    def _edit(self, target: str, decision: PlanDecision) -> None:
        """Put other steps in the place of all that have not begun; whoever edits has said yes to them."""
        plan = self._plan(target)
        if self._board.is_past(target, decision.revision):
            problem = Problem(
                "revision", "the plan is another by now", "edit it as it is now", "past_revision"
            )
            self._refuse(topics.PLAN_DECISION.name, target, [problem])
            self._say(target, orders.PLAN_CHANGED, "error")
            return
        free = {id(step) for step in plan.not_begun}
        begun = [index for index, step in enumerate(plan.steps) if id(step) not in free]
        known, catalogue = [plan.steps[index] for index in begun], self._catalogue(target)
        calls, problems = rebased(decision.steps, listed(plan.steps), begun)
        if not problems:
            calls = complete_calls(calls, catalogue, known=len(known))
            problems = check_calls(calls, catalogue, before=known, known=known, path="steps")
        if problems:
            self._refuse_plan(plan, problems, decided=True)
        else:
            self._send(plan, plan.edit(calls))

    def _set_policy(self, target: str, policy: Policy | Literal[""]) -> None:
        if policy:
            self._approvals.choose(target, policy)
            self._send(self._plan(target), [])

    def _propose(
        self,
        plan: TargetPlan,
        order: ChatAction,
        calls: Sequence[ActionCall],
        commands: Sequence[SystemCommand] = (),
        *,
        repairs: Step | None = None,
        why: str = "",
    ) -> PlanProposal:
        """Let steps and changes wait for a yes to what they really are."""
        target, pending = plan.target, plan.pending
        commands = [*orders.forgetting(order), *commands]
        bound: list[Bound] = []
        for command in commands:
            index = command.pop_index if command.command == "pop" else None
            known = index is not None and 0 <= index < len(pending)
            step = pending[index] if known and index is not None else None
            bound.append((command, plan.current if command.command == "skip" else step))
        shown = zip(plan.steps, self._labels(plan, [step.call for step in plan.steps]), strict=True)
        texts = {id(step): label for step, label in shown}
        changes = [command_label(command, texts.get(id(step), "")) for command, step in bound]
        proposal = PlanProposal(
            id="new",
            target=target,
            message=order.message_response,
            steps=tuple(calls),
            commands=tuple(commands),
            labels=tuple(map(self.spoken, (*changes, *self._labels(plan, calls)))),
            digest=digest_of(target, calls, commands, self._objects(target)),
            by=order.by,
            why=self.spoken(why),
        )
        proposal = self._approvals.propose(proposal, self._presence.get(target), repairs=repairs, bound=bound)
        self.publish(topics.PLAN, proposal)
        self._send(plan, [])
        return proposal

    def _labels(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> Labels:
        return labels_of(calls, self._catalogue(plan.target), self._objects(plan.target))

    def _append(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> None:
        still = plan.update().state == "paused"
        self._send(plan, plan.append(calls))
        if calls and still and plan.update().state == "paused":
            self._say(plan.target, "I am still standing still. Say “carry on” when I should go on.", "info")

    def _command(self, plan: TargetPlan, command: SystemCommand, by: Principal | None) -> list[PlanEffect]:
        match command.command:
            case "stop" | "pause":
                left = self._left.pause(plan.target)
                if plan.pending or left:
                    self._hold_for(plan, by)
                return [*left, *plan.pause()]
            case "start":
                left = [] if plan.pending else self._left.go_on(plan.target)
                waiting = self._approvals.of(plan.target)
                repairs = any(self._approvals.repairs(proposal.id) for proposal in waiting)
                if waiting and (
                    repairs or not plan.pending
                ):  # a yes is bound to what was shown, going on is not
                    return [Say(together(wish_of(waiting[-1].labels), SHALL_I))]
                self._held_by.pop(plan.target, None)
                return left or plan.start()
            case "clear":
                for proposal in self._approvals.of(plan.target):
                    self._approvals.drop(proposal.id)
                self._held_by.pop(plan.target, None)
                return [*self._left.stop(plan.target), *plan.clear()]
            case "skip":
                return plan.skip()
            case "pop":
                return plan.pop(command.pop_index)
        return []  # memories are everybody's, see _remember

    def _hold_for(self, plan: TargetPlan, by: Principal | None) -> None:
        """Remember who told a robot to stand still; a person's word counts before anybody else's."""
        before = self._held_by.get(plan.target)
        if before is None or not before.is_person:
            self._held_by[plan.target] = by or Principal()

    def _remember(self, order: ChatAction, targets: Sequence[str]) -> None:
        for command in orders.of_memory(order):
            effect = EFFECT_OF[command.command]
            found = verdict(order.by, effect)
            if found == "yes" and order.behalf is not None and not order.needs_yes:
                found = "allow"  # the person's own words ask for it
            if found != "allow":
                if not order.needs_yes:
                    self._audit(effect, order, ",".join(targets), "refused")
                continue
            if order.by is None or order.by.kind == "program":  # whose word it is cannot be known
                known = {name: x for name, x in command.arguments.items() if name not in ("way", "words")}
                command = command.model_copy(
                    update={"arguments": known | {"source": str(order.by or "program")}}
                )
            match memory_change(command):
                case AddToMemory() as added:
                    self.publish(topics.ADD_TO_MEMORY, added)
                case RemoveMemory() as removed:
                    self.publish(topics.REMOVE_MEMORY, removed)
                case Problem() as problem:
                    self._refuse("chat_action", ",".join(targets), [problem])

    def _accept(
        self,
        plan: TargetPlan,
        queue: Sequence[ActionCall],
        *,
        correcting: bool = False,
        decided: bool = False,
    ) -> list[ActionCall] | None:
        """The completed actions, or None (and everybody told) if the robot cannot carry them out.

        Args:
            plan: Of the robot.
            queue: The actions.
            correcting: Whether they take the failed step's place.
            decided: Whether a person put them together.
        """
        catalogue = self._catalogue(plan.target)
        calls = complete_calls(queue, catalogue)
        put = plan.correction(calls) if correcting else calls
        problems = check_calls(put, catalogue, path="steps" if decided else "queue")
        if not problems:
            return calls
        text = orders.WAITING_HELPLESS if correcting and not decided else ""
        self._refuse_plan(plan, problems, decided=decided, text=text)
        return None

    def _refuse_plan(
        self, plan: TargetPlan, problems: Sequence[Problem], *, decided: bool, text: str = ""
    ) -> None:
        topic = topics.PLAN_DECISION if decided else topics.CHAT_ACTION
        self._refuse(topic.name, plan.target, problems)
        self._say(plan.target, text or (orders.LEFT if decided else orders.NOTHING_DONE), "error")

    # -- reports ---------------------------------------------------------------------------------------

    def _on_emergency(self, command: StopCommand) -> None:
        """Whoever stops a robot holds its plan: only a person lets it go on after the reset."""
        for name in command.targets or tuple(self._plans) if command.command == "stop" else ():
            plan = self._plan(self._presence.resolve(name) or name)
            if plan.pending:
                self._hold_for(plan, command.by or person())
                self._send(plan, [])

    def _on_feedback(self, feedback: ros.UmrfGraphFeedback) -> None:
        plan = self._plans.get(feedback.actor)
        if plan is None:
            return
        for text in reversed(feedback.history):
            try:
                graph = read_graph(text)
            except GraphRefusedError as error:
                self._refuse("umrf_graph_feedback", feedback.actor, error.problems)
                continue
            self._send(plan, plan.on_graph(graph))

    def _on_event(self, event: GraphEvent) -> None:
        self._left.told(event)
        plan = self._plans.get(event.actor)
        if plan is None or event.kind != "node":
            return
        if event.outputs:
            values = {name: item.value for name, item in event.outputs.items() if item.has_data}
            plan.on_outputs(event.graph_name, event.node, values)
        if event.result and event.cause != "bypass":
            self._send(plan, plan.on_result(event.graph_name, event.node, event.result))

    def _on_said(self, feedback: ChatFeedback) -> None:
        self._questions.on_feedback(feedback)
        for target in feedback.targets:
            self._note_question(target)

    def _on_input(self, said: ChatInput) -> None:
        answered = [target for target, _ in self._questions.answered(said)]
        self._questions.on_input(said)
        for target in answered:
            self._note_question(target)

    def _note_question(self, target: str) -> None:
        plan = self._plans.get(target)
        asked = self._questions.first(target) is not None
        if plan is not None and plan.asked != asked:
            plan.asked = asked
            self._send(plan, [])

    def _on_rejection(self, rejection: Rejection) -> None:
        plan = self._plans.get(rejection.target or rejection.source)
        if plan is None or not rejection.what.startswith("umrf_graph_"):
            return
        if rejection.source == self.name or rejection.graph_name != plan.graph_name:
            return
        codes = {problem.code for problem in rejection.problems}
        self._send(plan, plan.on_refused(rejection.graph_name, rejection.what, codes))
