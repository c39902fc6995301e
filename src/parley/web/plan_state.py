"""Plans, proposals and other graphs of all robots, as people see them. No loop, no clock."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final, Literal

from parley.latest import Latest
from parley.messages.chat import ActionCall
from parley.messages.plain import in_words
from parley.messages.rules import RiskClass
from parley.messages.status import GraphEvent, PlanDecision, PlanProposal, PlanUpdate, Rejection
from parley.umrf.model import Graph
from parley.web.models import (
    AbilityView,
    Change,
    PlanChange,
    PlanGone,
    PlanView,
    ProposalChange,
    ProposalGone,
    ProposalView,
    StepView,
)
from parley.web.node_state import OVER, GraphShown, GraphTold, NodeTold, StepState, parameter_views

__all__ = ["PlanBook"]

PAST_KEPT: Final = 500
OVER_KEPT: Final = 3
"""How many other graphs of a robot stay listed after they ended."""
_DONE: Final = OVER - {"failed"}


class PlanBook:
    """Everything that robots do or are about to do.

    Args:
        emit: Gets each change.
        ability_of: What a robot's catalogue says of an action, by robot and action; None: nothing.
    """

    def __init__(
        self, emit: Callable[[Change], None], ability_of: Callable[[str, str], AbilityView | None]
    ) -> None:
        self._emit, self._ability_of = emit, ability_of
        self.views: dict[tuple[str, str], PlanView] = {}
        self.proposals: dict[str, ProposalView] = {}
        self._updates: dict[str, PlanUpdate] = {}
        self._free_since: dict[str, int] = {}
        self._graphs: dict[tuple[str, str], GraphTold] = {}
        self._since: dict[str, GraphShown] = {}
        """What its engine told of each robot's plan since the planner last told another state of it."""
        self._news: dict[str, set[str]] = {}
        """The same of its steps: those of which it told a transition."""
        self._past: Latest[tuple[str, str], None] = Latest(PAST_KEPT)
        """Graphs of plans that were replaced: what comes late about them is dropped."""
        self.decided: set[str] = set()
        """Proposals that were decided about, but go on waiting if that is refused or not heard."""

    # -- plans -----------------------------------------------------------------------------------------

    def on_update(self, update: PlanUpdate) -> None:
        """The planner tells a robot's plan."""
        robot, before = update.target, self._updates.get(update.target)
        self._updates[robot] = update
        if before is None or _not_begun(before) != _not_begun(update):
            self._free_since[robot] = update.revision
        if before is not None and before.graph_name != update.graph_name:
            self._drop(robot, before.graph_name)
        if before is None or (before.graph_name, before.state) != (update.graph_name, update.state):
            self._since.pop(robot, None)
        told = {(step.node, step.state) for step in before.steps} if before is not None else set()
        self._news.get(robot, set()).difference_update(
            step.node for step in update.steps if (step.node, step.state) not in told
        )
        for proposal in [p for p in self.proposals.values() if p.robot == robot]:
            waits = update.waits is None or proposal.id in update.waits
            if update.state == "idle" or not waits or proposal.id in self.decided:
                self._end_proposal(proposal.id)
        self._show_plan(update, before)

    @property
    def left_over(self) -> set[tuple[str, str]]:
        """Graphs of which an earlier process has left something that is still to be done."""
        told = self._updates.values()
        return {(one.target, one.continues) for one in told if one.continues and one.state != "idle"}

    def is_past(self, robot: str, revision: int) -> bool:
        """Whether the steps of a robot's plan that have not begun are others than at `revision`."""
        return revision < self._free_since.get(robot, 0)

    def planned(self, robot: str, index: int) -> str:
        """The id of a step that is not over, by its place among those; empty if it is not known."""
        update = self._updates.get(robot)
        left = [step.id for step in update.steps if step.state not in _DONE] if update is not None else []
        return left[index] if index < len(left) else ""

    def on_proposal(self, proposal: PlanProposal) -> None:
        """Steps wait for a yes, in the place of what was decided but is not what waits."""
        for other in [p for p in self.proposals.values() if p.robot == proposal.target]:
            if other.id != proposal.id and other.id in self.decided:
                self._end_proposal(other.id)
        changes = len(proposal.commands)
        labels = proposal.labels[changes:]
        steps = tuple(
            self._step(
                proposal.target,
                f"step-{number}",
                call,
                "queued",
                NodeTold(),
                "".join(labels[number : number + 1]),
            )
            for number, call in enumerate(proposal.steps)
        )
        view = ProposalView(
            id=proposal.id,
            robot=proposal.target,
            message=proposal.message,
            changes=proposal.labels[:changes],
            steps=steps,
            digest=proposal.digest,
            by=proposal.by,
            why=proposal.why,
        )
        if self.proposals.get(proposal.id) == view:
            return
        self.proposals[proposal.id] = view
        self._emit(ProposalChange(seq=0, proposal=view))

    def on_decision(self, decision: PlanDecision) -> None:
        """Somebody decided; what waited is gone when the planner tells so."""
        if decision.id in self.proposals:
            self.decided.add(decision.id)

    def on_unheard(self, decision: PlanDecision) -> None:
        """Nobody heard it."""
        self.decided.discard(decision.id)

    def on_rejection(self, rejection: Rejection) -> None:
        """The steps of a proposal were refused."""
        self.decided -= {p.id for p in self.proposals.values() if p.robot == rejection.target}

    def on_catalogue(self, robot: str) -> None:
        """It has become known, or another, what a robot's actions are: how much care they need with it."""
        for view in [view for (owner, _), view in self.views.items() if owner == robot]:
            self._put(view.model_copy(update={"steps": self._weighed(robot, view.steps)}))
        for proposal in [p for p in self.proposals.values() if p.robot == robot]:
            steps = self._weighed(robot, proposal.steps)
            if steps != proposal.steps:
                changed = self.proposals[proposal.id] = proposal.model_copy(update={"steps": steps})
                self._emit(ProposalChange(seq=0, proposal=changed))

    def _weighed(self, robot: str, steps: Sequence[StepView]) -> tuple[StepView, ...]:
        return tuple(step.model_copy(update=self._nature(robot, step.action)) for step in steps)

    def _nature(self, robot: str, action: str) -> dict[str, Any]:
        """What kind of step an action makes."""
        ability = self._ability_of(robot, action)
        if ability is None:
            return {"risk": RiskClass.UNKNOWN, "only_finds": False}
        return {"risk": ability.kind, "only_finds": ability.only_finds}

    def forget(self, robot: str) -> None:
        """A robot was taken off the list."""
        for key in [key for key in self.views if key[0] == robot]:
            self._drop(*key)
        for proposal in [p for p in self.proposals.values() if p.robot == robot]:
            self._end_proposal(proposal.id)
        self._updates.pop(robot, None)
        self._free_since.pop(robot, None)
        self._since.pop(robot, None)
        self._news.pop(robot, None)

    # -- what engines tell -----------------------------------------------------------------------------

    def on_event(self, event: GraphEvent) -> None:
        """A transition or progress of a graph."""
        key = (event.actor, event.graph_name)
        if key in self._past:
            return
        graph = self._graphs.setdefault(key, GraphTold())
        graph.on_event(event)
        update = self._updates.get(event.actor)
        if update is not None and update.graph_name == event.graph_name:
            if event.kind == "graph":
                self._since[event.actor] = graph.state
                self._show_plan(update, update)
            elif event.kind == "node":
                self._news.setdefault(event.actor, set()).add(event.node)
            self._show_step(update, event.node)
        else:
            self._show_graph(*key, graph)

    def shows_plan(self, robot: str, graph_name: str) -> bool:
        """Whether a graph belongs to a plan, the one in progress or one that is past."""
        update = self._updates.get(robot)
        is_present = update is not None and update.graph_name == graph_name
        return is_present or (robot, graph_name) in self._past

    def on_graph(self, robot: str, whole: Graph) -> None:
        """An engine tells a whole graph; those that belong to plans are known better from the planner."""
        if self.shows_plan(robot, whole.name):
            return
        key = (robot, whole.name)
        graph = self._graphs.get(key) or GraphTold()
        graph.on_graph(whole)
        if key not in self._graphs and graph.state == "ended":
            return  # over before anybody here heard of it, perhaps a plan's
        self._graphs[key] = graph
        self._show_graph(robot, whole.name, graph)

    # -- showing ---------------------------------------------------------------------------------------

    def _show_plan(self, update: PlanUpdate, before: PlanUpdate | None) -> None:
        key = (update.target, update.graph_name)
        nodes = self._graphs[key].nodes if key in self._graphs else {}
        steps = tuple(
            self._planned(update, number, nodes.get(step.node)) for number, step in enumerate(update.steps)
        )
        state: Literal["idle", "awaiting_approval", "running", "paused", "held", "ended"] = update.state
        since = self._since.get(update.target)
        if (state == "running" and since) or (state == "paused" and since in ("running", "paused")):
            state = since  # who plans may hang while people let the robot stand and go on, or a step fails
        shown = self.views.get(key)
        self._put(
            PlanView(
                robot=update.target,
                graph_name=update.graph_name,
                state="ended" if state == "idle" and steps else state,
                revision=update.revision,
                steps=steps,
                changed=_changed(shown, steps) if before is not None and shown is not None else (),
                held_by=update.held_by,
            )
        )

    def _show_step(self, update: PlanUpdate, node: str) -> None:
        """The same plan, of which only one step has news."""
        key = (update.target, update.graph_name)
        shown, told = self.views.get(key), self._graphs[key].nodes.get(node)
        if shown is None:
            self._show_plan(update, None)
        elif told is not None:
            steps = tuple(
                self._planned(update, number, told) if step.id == node else step
                for number, step in enumerate(shown.steps)
            )
            self._put(shown.model_copy(update={"steps": steps}))

    def _planned(self, update: PlanUpdate, number: int, told: NodeTold | None) -> StepView:
        step = update.steps[number]
        key = step.node or f"step-{number}"
        is_newer = step.node in self._news.get(update.target, ())
        state = _state(step.state, told, is_newer=is_newer)
        view = self._step(update.target, key, step.action, state, told or NodeTold(), step.label)
        return view.model_copy(update={"planned": step.id})

    def _show_graph(self, robot: str, name: str, graph: GraphTold) -> None:
        steps = tuple(
            self._step(robot, node, told.call or ActionCall(name=_action_of(node)), told.state, told)
            for node, told in graph.nodes.items()
        )
        self._put(PlanView(robot=robot, graph_name=name, kind="graph", state=graph.state, steps=steps))
        if graph.state == "ended":
            over = [
                key
                for key, view in self.views.items()
                if key[0] == robot and view.kind == "graph" and view.state == "ended"
            ]
            for key in over[:-OVER_KEPT]:
                self._drop(*key)

    def _step(
        self, robot: str, key: str, call: ActionCall, state: StepState, node: NodeTold, label: str = ""
    ) -> StepView:
        is_over = state in OVER
        return StepView(
            id=key,
            action=call.name,
            label=label or _label(call),
            reason=call.reason,
            state=state,
            inputs=parameter_views(call.input_parameters),
            outputs=node.outputs or parameter_views(call.output_parameters),
            progress=None if is_over else node.progress,
            progress_text="" if is_over else node.progress_text,
            message=node.message if state == "failed" else "",
            call=call.model_dump(),
            started_unix_ms=node.started_unix_ms,
            ended_unix_ms=node.ended_unix_ms if is_over else 0,
            worked_ms=node.work.ms,
            working_since_unix_ms=node.work.since_unix_ms,
            ends_unix_ms=node.work.ends_unix_ms,
            **self._nature(robot, call.name),
        )

    def _put(self, view: PlanView) -> None:
        key = (view.robot, view.graph_name)
        if self.views.get(key) != view:
            self.views[key] = view
            self._emit(PlanChange(seq=0, plan=view))

    def _drop(self, robot: str, graph_name: str) -> None:
        if graph_name:
            self._past[robot, graph_name] = None
        self._graphs.pop((robot, graph_name), None)
        if self.views.pop((robot, graph_name), None) is not None:
            self._emit(PlanGone(seq=0, robot=robot, graph_name=graph_name))

    def _end_proposal(self, proposal_id: str) -> None:
        self.decided.discard(proposal_id)
        del self.proposals[proposal_id]
        self._emit(ProposalGone(seq=0, id=proposal_id))


def _state(planned: StepState, node: NodeTold | None, *, is_newer: bool) -> StepState:
    """The planner's word counts, but for what its engine told since, or alone knows: it is being stopped."""
    if node is None or planned in OVER:
        return planned
    went_on = is_newer and (node.state in OVER or (planned == "queued" and node.state == "running"))
    return node.state if went_on or node.state == "stopping" else planned


def _not_begun(update: PlanUpdate) -> list[tuple[str, ActionCall]]:
    return [(step.node, step.action) for step in update.steps if step.state == "queued"]


def _changed(before: PlanView, steps: Sequence[StepView]) -> tuple[str, ...]:
    """Ids of steps that are new or have other parameters; kept until the plan is altered again."""
    old = {step.planned or step.id: step.call for step in before.steps}
    new = [step.id for step in steps if old.get(step.planned or step.id) != step.call]
    is_same = not new and len(steps) == len(before.steps)
    return before.changed if is_same else tuple(new)


def _label(call: ActionCall) -> str:
    """A step that nobody gave a label: what the action is called and given; never a model's words."""
    given = [str(p.value) for p in call.input_parameters.values() if p.type == "string" and p.has_data]
    return f"{in_words(call.name)}: {', '.join(given)}" if given else in_words(call.name)


def _action_of(node: str) -> str:
    """The action's name in a node's full name."""
    name, _, number = node.rpartition("_")
    return name if name and number.isdecimal() else node
