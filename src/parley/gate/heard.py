"""What crosses the topics, as events for the audit log. Pure; one object per log.

Whoever refuses something, lets somebody in or changes a setting tells of it on `/parley/audit`; all that is
on another topic anyway is read off there, so that no node can forget to write it down.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any, Final

from parley.gate.cards import labels_of, lines_of
from parley.gate.ruling import EFFECT_OF
from parley.gate.table import Effect, verdict
from parley.gate.work_time import WorkTime
from parley.latest import KEPT, Latest
from parley.messages.audit import AuditEvent
from parley.messages.chat import ActionCall, ChatAction, ChatInput, Press
from parley.messages.failure import FailureReport
from parley.messages.memory import AddToMemory, MemoryEvent
from parley.messages.principal import Principal
from parley.messages.status import (
    ActionInfo,
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanStep,
    PlanUpdate,
    Rejection,
    StopCommand,
    StopReport,
)

__all__ = ["Heard", "left_out"]

_OVER: Final = ("finished", "failed", "stopped", "skipped")

_REFUSED: Final = {
    "chat_interface_input": Effect.SPEAK, "chat_action": Effect.BEGIN, "umrf_correction": Effect.REPAIR,
    "umrf_graph_start": Effect.BEGIN, "umrf_graph_modify": Effect.EDIT, "umrf_graph_pause": Effect.PAUSE,
    "umrf_graph_resume": Effect.RESUME, "umrf_graph_stop": Effect.CLEAR,
    "/parley/plan_decision": Effect.APPROVE,
    "/parley/stop": Effect.STOP, "add_to_memory": Effect.REMEMBER, "remove_memory": Effect.FORGET,
}  # fmt: skip
SILENT_MS: Final = 5000
"""A robot tells how it fares every second; after so long without a word something may have been missed."""
_ENDS: Final = {"FINISHED": "done", "STOPPED": "done", "ERROR": "failed"}


class Heard:
    """Makes events of messages, and remembers as much as is needed to say on whose account they come."""

    def __init__(self) -> None:
        self.robots: set[str] = set()
        """Robots that were heard of."""
        self._said: Latest[str, ChatInput] = Latest()
        self._proposals: Latest[str, PlanProposal] = Latest()
        self._orders: Latest[str, dict[str, Any]] = Latest()
        """What made each robot's newest plan, as facts of an event."""
        self._plans: Latest[str, PlanUpdate] = Latest()
        self._running: Latest[str, dict[str, Any]] = Latest()
        self._begun: Latest[str, dict[str, Any]] = Latest()
        """The same of what is over, too."""
        self._graphs: Latest[str, str] = Latest(10 * KEPT)
        """Robot and id of a step -> the graph in which it was to be done first."""
        self._works: Latest[str, WorkTime] = Latest()
        self._memories: Latest[str, tuple[Principal | None, str]] = Latest()
        self._stops: Latest[str, StopCommand] = Latest()
        self._presses: Latest[str, None] = Latest()
        self._beats: Latest[str, int] = Latest()
        self._catalogues: Latest[str, Sequence[ActionInfo]] = Latest()
        self._wishes: Latest[str, str] = Latest()

    def recall(self, entries: Iterable[AuditEvent]) -> None:
        """Take in what an earlier process wrote down of who wanted what, oldest first."""
        for entry in entries:
            key = f"{entry.robot}\n{entry.detail.get('graph', '')}"
            facts: dict[str, Any] = {"by": entry.by, "detail": entry.detail, "digest": entry.digest}
            if entry.effect == "begin" and "labels" in entry.detail:
                asked = {name: entry.detail[name] for name in ("asked_by", "asked") if name in entry.detail}
                self._orders[entry.robot] = {**facts, "detail": asked, "labels": entry.detail["labels"]}
            elif entry.effect == "start":
                self._running[key] = self._begun[key] = {**facts, "orders": ()}
            elif entry.effect == "end":
                self._running.pop(key, None)

    def _is_repeat(self, press: Press | None) -> bool:
        """Whether a button's press was heard before: it is sent until somebody takes it."""
        if press is None:
            return False
        known = press.id in self._presses
        self._presses[press.id] = None
        return known

    def on_input(self, said: ChatInput) -> list[AuditEvent]:
        """Words of a person; what is passed on by those who asked is no new message."""
        identity = said.id.removesuffix("~aside")
        if identity and self._said.get(identity) is not None:
            return []
        self._said[identity] = said
        detail: dict[str, Any] = {"id": said.id} if said.id else {}
        if said.images:
            detail["pictures"] = len(said.images)
        effect = Effect.ANSWER if said.type == "response" else Effect.SPEAK
        targets = said.targets or (tuple(self.robots) if len(self.robots) == 1 else ("",))
        return [
            AuditEvent(effect=effect, by=said.who, robot=robot, words=said.message, detail=detail)
            for robot in dict.fromkeys(targets)
        ]

    def on_action(self, order: ChatAction, effect: Effect = Effect.BEGIN) -> list[AuditEvent]:
        """What was understood, or was ordered by a press."""
        if self._is_repeat(order.press):
            return []
        said = self._said.get(order.reply_to) if order.reply_to else None
        asked: dict[str, Any] = {}
        if said is not None:
            # Behind an answer to "which one?" stands the order; what nobody said is told of nobody.
            was_said = any(one.message == order.words for one in self._said.values())
            words = order.words if was_said else said.message
            asked = {"asked_by": said.who.model_dump(), "asked": words}
            self._wishes[order.id] = words
        events = [
            AuditEvent(effect=EFFECT_OF[command.command], by=order.by, robot=robot, outcome="asked",
                       detail={"command": command.command, **_named(command.arguments), **asked})
            for robot in order.targets or ("",)
            for command in order.system_cmd
        ]  # fmt: skip
        for robot in order.targets if order.queue else ():
            detail = {"labels": self._wished(robot, order.queue), **asked}
            self._orders[robot] = {"by": order.by, "detail": asked, "labels": detail["labels"]}
            events.append(AuditEvent(effect=effect, by=order.by, robot=robot, outcome="asked", detail=detail))
        return events

    def _wished(self, robot: str, steps: Sequence[ActionCall]) -> list[str]:
        """What steps would do, in the words that people read of this robot's plans."""
        known = self._catalogues.get(robot)
        return list(lines_of(steps, labels_of(steps, known), known)) if known else labels(steps)

    def on_plan(self, told: PlanUpdate | PlanProposal) -> list[AuditEvent]:
        """A plan that waits for a yes, or one that is over: its graph only halts, so that it could go on."""
        if isinstance(told, PlanUpdate):
            self.robots.add(told.target)
            before = self._plans.get(told.target) or told
            self._plans[told.target] = told
            for key in (f"{told.target}\n{step.id}" for step in told.steps if told.graph_name and step.id):
                if key not in self._graphs:
                    self._graphs[key] = told.graph_name
            if work := self._works.get(f"{told.target}\n{told.graph_name}"):
                work.on_steps(told.steps)
            last = told if told.graph_name == before.graph_name else before
            if last is told and told.state != "idle":
                return []
            key = f"{last.target}\n{last.graph_name or last.continues}"
            facts, worked = self._running.pop(key, None), self._worked(key)
            if not facts:
                return []
            state = _state_of(last)
            return [_over(last, state, facts, {**worked, **self._done(last.steps, facts, state)})]
        if self._proposals.get(told.id) is not None:
            return []
        self._proposals[told.id] = told
        return [
            AuditEvent(
                effect=Effect.BEGIN, by=told.by, robot=told.target, outcome="asked", digest=told.digest,
                reason=told.why,
                detail={"proposal": told.id, "labels": _labels_of(told), **self._asked(told.target)},
            )
        ]  # fmt: skip

    def on_decision(self, decision: PlanDecision) -> list[AuditEvent]:
        """A yes, a no, another plan, another policy."""
        if self._is_repeat(decision.press):
            return []
        effect = Effect(decision.decision)
        proposal = self._proposals.get(decision.id) if decision.id else None
        detail: dict[str, Any] = {"proposal": decision.id} if decision.id else {}
        if decision.policy:
            detail["policy"] = decision.policy
        asked = _labels_of(proposal) if proposal else []
        shown = self._wished(decision.target, decision.steps) if decision.steps else asked
        if shown:
            detail["labels"] = shown
        allowed = verdict(decision.by, effect) == "allow"
        if allowed and effect in (Effect.APPROVE, Effect.EDIT):
            graphs = (self._graphs.get(f"{decision.target}\n{step}", "") for step in decision.undoes)
            put_back = next(filter(None, graphs), "")
            told = self._orders.get(decision.target) if self._carries_out(decision) else None
            order = told or {"by": decision.by, "detail": {}}
            order = {**order, "continues": put_back}
            approved = {"approved_by": decision.by.model_dump()} if decision.by else {}
            facts = {**order["detail"], **approved}
            self._orders[decision.target] = {
                **order,
                "detail": facts,
                "labels": shown,
                "digest": decision.digest,
            }
        return [
            AuditEvent(
                effect=effect, by=decision.by, robot=decision.target, digest=decision.digest, detail=detail,
                outcome="done" if allowed else "asked",
            )
        ]  # fmt: skip

    def _carries_out(self, decision: PlanDecision) -> bool:
        """Whether it is about what was ordered last, and puts no steps where nothing is left to be done."""
        plan = self._plans.get(decision.target)
        left = [step for step in plan.steps if step.state not in _OVER] if plan else []
        return decision.decision != "edit" or bool(decision.id or left)

    def on_status(self, status: ActorStatus, unix_ms: int) -> list[AuditEvent]:
        """A robot is heard of: if that is after a silence, what it did meanwhile is not known."""
        if status.catalogue:
            self._catalogues[status.actor] = status.catalogue
        before = self._beats.pop(status.actor, unix_ms)
        if status.state != "leaving":
            self._beats[status.actor] = unix_ms
        if unix_ms - before <= SILENT_MS:
            return []
        silence = {"since_unix_ms": before, "until_unix_ms": unix_ms}
        return [AuditEvent(effect="gap", robot=status.actor, outcome="failed", detail=silence)]

    def on_graph(self, event: GraphEvent) -> list[AuditEvent]:
        """A robot begins and ends what it was told to do."""
        self.robots.add(event.actor)
        key = f"{event.actor}\n{event.graph_name}"
        if event.kind == "node":
            if work := self._works.get(key):
                work.on_node(event)
            if event.result == "on_error" and event.message and (facts := self._running.get(key)):
                facts["reason"] = FailureReport.parse(event.message).message
            return []
        if event.kind == "graph" and event.state == "RUNNING" and self._running.get(key) is None:
            return [self._began(event, key)]
        if event.kind == "graph" and event.state in _ENDS and (facts := self._running.pop(key, None)):
            return [self._ended(event, facts, self._worked(key, event.unix_ms))]
        return []

    def _began(self, event: GraphEvent, key: str) -> AuditEvent:
        order = self._orders.get(event.actor) or {"by": None, "detail": {}}
        plan = self._plans.get(event.actor)
        told = labels(plan.steps) if plan and plan.graph_name == event.graph_name else order.get("labels", [])
        # What was put back goes on with what it was taken out of, on the account of who wanted that.
        continues = event.graph_name if key in self._begun else order.get("continues", "")
        if plan and plan.state != "idle" and plan.graph_name in ("", event.graph_name):
            continues = continues or plan.continues  # a restart came between
        self._running.pop(f"{event.actor}\n{continues}", None)
        before = self._begun.get(f"{event.actor}\n{continues}") or order
        detail = {**order["detail"], **before["detail"], "graph": event.graph_name, "labels": told}
        if continues:
            detail["continues"] = continues
        facts = {"digest": "", "orders": (), **before, "detail": detail}
        self._running[key] = self._begun[key] = order = facts
        self._works[key] = WorkTime()
        return AuditEvent(
            effect="start", by=order["by"], robot=event.actor, detail=detail, digest=order.get("digest", ""),
            unix_ms=event.unix_ms,
        )  # fmt: skip

    def _worked(self, key: str, until_ms: int = 0) -> dict[str, Any]:
        """For how long, as a fact of an event; asked once, at the end."""
        work = self._works.pop(key, None)
        return {} if work is None else {"worked_ms": work.worked_ms(until_ms)}

    def _ended(self, event: GraphEvent, facts: dict[str, Any], worked: dict[str, Any]) -> AuditEvent:
        plan = self._plans.get(event.actor)
        detail = {**facts["detail"], "state": event.state, **worked}
        if plan and plan.graph_name == event.graph_name and plan.steps:
            detail |= self._done(plan.steps, facts, event.state)
        failed = event.state == "ERROR" or event.result == "on_error"
        return AuditEvent.model_validate(
            {"effect": "end", "by": facts["by"], "robot": event.actor, "detail": detail,
             "digest": facts["digest"], "outcome": "failed" if failed else "done", "unix_ms": event.unix_ms,
             "reason": facts.get("reason", "") if failed else ""}
        )  # fmt: skip

    def on_stop(self, command: StopCommand) -> list[AuditEvent]:
        """An emergency stop, or its release; that a robot stands while words are read is neither."""
        if command.command not in ("stop", "reset"):
            return []
        if command.id and self._stops.get(command.id) == command:
            return []  # a press that came by two ways
        self._stops[command.id] = command
        effect = Effect.STOP if command.command == "stop" else Effect.RESET
        outcome = "done" if verdict(command.by, effect) == "allow" else "asked"
        return [
            AuditEvent.model_validate(
                {"effect": effect, "by": command.by, "robot": robot, "outcome": outcome,
                 "detail": {"id": command.id}}
            )
            for robot in command.targets or ("",)
        ]  # fmt: skip

    def on_report(self, report: StopReport) -> list[AuditEvent]:
        """What became of a stop."""
        self.robots.add(report.actor)
        effect = Effect.RESET if report.state == "reset" else Effect.STOP
        by = Principal(kind="robot", name=report.actor)
        detail = {"id": report.id, "state": report.state}
        return [AuditEvent(effect=effect, by=by, robot=report.actor, detail=detail)]

    def on_add(self, added: AddToMemory) -> list[AuditEvent]:
        """Nothing yet: it counts when it is durable, and is then put down to whoever it came from."""
        for entry in added.entries():
            kind = {"told": "person", "seen": "robot", "concluded": "engine"}.get(entry.way)
            by = Principal.model_validate({"kind": kind, "name": entry.source}) if kind else None
            text = entry.words or (entry.data if entry.type == "text" else entry.info)
            self._memories[f"{entry.scope}\n{entry.name}"] = (by, text)
        return []

    def on_memory(self, event: MemoryEvent) -> list[AuditEvent]:
        """What is remembered or forgotten for good."""
        told_by, text = self._memories.get(f"{event.scope}\n{event.name}") or (None, "")
        forgets = event.kind == "removed" or event.by is not None
        return [
            AuditEvent(
                effect=Effect.FORGET if forgets else Effect.REMEMBER,
                by=event.by if forgets else told_by,
                robot=event.scope,
                outcome="failed" if event.kind == "failed" else "done",
                words=text,
                reason=event.message,
                detail={"name": event.name},
            )
        ]

    def on_rejection(self, told: Rejection) -> list[AuditEvent]:
        """What was refused, and why."""
        effect: str = _REFUSED.get(told.what, told.what[:50])
        detail: dict[str, Any] = {
            "what": told.what, "codes": [problem.code for problem in told.problems], "from": told.source,
        }  # fmt: skip
        if told.graph_name:
            detail["graph"] = told.graph_name
        reason = " ".join(problem.message for problem in told.problems)
        return [AuditEvent(effect=effect, robot=told.target, outcome="refused", reason=reason, detail=detail)]

    def _done(self, steps: Sequence[PlanStep], facts: dict[str, Any], state: str) -> dict[str, Any]:
        """What the steps were, which were left out, and all that was wished, not only what was at first."""
        left = labels(left_out(steps, ended_early=state == "STOPPED"))
        facts["orders"] = orders = dict.fromkeys(
            (*facts["orders"], *(step.order for step in steps if step.order))
        )
        wishes = _in_a_row([*dict.fromkeys(words for one in orders if (words := self._wishes.get(one)))])
        more = {"asked": wishes} if wishes else {}
        return {"labels": labels(steps), **({"left": left} if left else {}), **more}

    def _asked(self, robot: str) -> dict[str, Any]:
        order = self._orders.get(robot)
        return dict(order["detail"]) if order else {}


def labels(steps: Sequence[ActionCall] | Sequence[PlanStep]) -> list[str]:
    """What each step does, in words; a search for the next one belongs to that one."""
    return [_label(step) for step in steps if not _is_hidden(step)]


def left_out(steps: Sequence[PlanStep], *, ended_early: bool = False) -> list[PlanStep]:
    """What was left out, but for what a condition excluded, and for what was only put off and done later.

    Args:
        steps: The plan at its end.
        ended_early: Whether somebody ended it, so that what was not over is left out as well.
    """
    left = []
    for at, step in enumerate(steps):
        later = {_label(other) for other in steps[at + 1 :] if other.state == "finished"}
        excluded = step.action.flow is not None and step.action.flow.if_ is not None
        out = step.state == "skipped" or (ended_early and step.state not in ("finished", "failed"))
        if out and not excluded and _label(step) not in later:
            left.append(step)
    return left


def _in_a_row(wishes: Sequence[str]) -> str:
    """Several, each as a sentence of its own; one as it is."""
    ended = [words if words.endswith((".", "?", "!")) else f"{words}." for words in wishes[:-1]]
    begun = [words[:1].upper() + words[1:] for words in (*ended, *wishes[-1:])[1:]]
    return " ".join((*(ended or wishes)[:1], *begun))


def _is_hidden(step: ActionCall | PlanStep) -> bool:
    return isinstance(step, PlanStep) and step.for_next


def _label(step: ActionCall | PlanStep) -> str:
    if isinstance(step, PlanStep):
        return step.label or _label(step.action)
    values = ", ".join(
        str(parameter.value)
        for parameter in step.input_parameters.values()
        if isinstance(parameter.value, str)
    )
    name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])|_+", " ", step.name).capitalize()
    return f"{name} ({values})" if values else name


def _labels_of(proposal: PlanProposal) -> list[str]:
    return list(proposal.lines) or labels(proposal.steps)


def _state_of(plan: PlanUpdate) -> str:
    """How a plan ended, by what became of its steps."""
    states = {step.state for step in plan.steps}
    ended = "FINISHED" if states <= {"finished", "skipped"} else "STOPPED"
    return "ERROR" if "failed" in states else ended


def _over(plan: PlanUpdate, state: str, facts: dict[str, Any], done: dict[str, Any]) -> AuditEvent:
    """The end of a plan."""
    failed = state == "ERROR"
    detail = {**facts["detail"], "state": state, **done}
    return AuditEvent(
        effect="end", by=facts["by"], robot=plan.target, detail=detail, digest=facts["digest"],
        outcome="failed" if failed else "done", reason=facts.get("reason", "") if failed else "",
    )  # fmt: skip


def _named(arguments: dict[str, Any]) -> dict[str, Any]:
    kept: Iterable[str] = ("name", "data", "parameters", "index")
    return {key: arguments[key] for key in kept if isinstance(arguments.get(key), str | int | float)}
