"""One robot's plan: what is to be done, what is being done, what went wrong. Pure; the planner node wires it.

Every method says what to send (a list of `Effect`s) and changes nothing else. The plan never assumes that a
message arrives: what the engine reports decides, and what differs from the plan is sent again.

Step identity: each node gets an ``instance_id`` from a counter that never goes back within a graph, kept in
plan order. A repeated or moved step gets a new one: late reports about an old one cannot be mistaken for it.

Here are the orders; what a plan is made of is in `state`, how the engine is told in `sync`, what comes of
its reports in `reports`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Final

from parley.agents.planner.effects import Effect, PauseGraph, ResumeGraph, Say, StopGraph
from parley.agents.planner.flow import shifted, steps_of
from parley.agents.planner.reports import Reports
from parley.agents.planner.state import GOING, PlanState
from parley.agents.planner.steps import (
    ACTIVE_STATES,
    OPEN_STATES,
    Step,
    When,
    new_id,
    with_givers,
    without_orphans,
)
from parley.agents.planner.sync import KEEP_DONE, Sync
from parley.messages.chat import ActionCall, SystemCommand
from parley.sentences import sentence

__all__ = ["KEEP_DONE", "TargetPlan"]

_ALL_AT_ONCE: Final = (
    "I can only stop all that I am doing at the same time, not one of it. "
    "Wait until the rest is done, or say “cancel everything”."
)


class TargetPlan(PlanState):
    """The plan of one robot.

    Args:
        target: The robot.
        new_graph_name: Gives a name never used before.
        waits_for_operator: Whether an action (by name) waits for a person while it runs.
        can_end_step: Whether the engine understands `/parley/step`, and tells how each step ended; if not,
            skipping restarts the rest.
    """

    def __init__(
        self,
        target: str,
        *,
        new_graph_name: Callable[[], str],
        waits_for_operator: Callable[[str], bool] = lambda _: False,
        can_end_step: Callable[[], bool] = lambda: True,
    ) -> None:
        super().__init__(
            target,
            new_graph_name=new_graph_name,
            waits_for_operator=waits_for_operator,
            can_end_step=can_end_step,
        )
        self._sync = Sync(self)
        self.reports = Reports(self, self._sync)
        """Takes what the engine reports."""

    def append(self, calls: Sequence[ActionCall], words: str = "", order: str = "") -> list[Effect]:
        """Add actions behind the plan; during a repair they wait, after one that failed they go first.

        Args:
            calls: The actions.
            words: By which words of a person.
            order: By which order.
        """
        if not calls:
            return []
        if self.given_up:
            return self._replace_failed(calls)
        over = self._over
        self.continues = "" if over else self.continues
        self.add(calls, words, order)
        if self.held:
            return []
        return self._sync.start() if over else self._sync.push()

    def edit(self, calls: Sequence[ActionCall], undoes: Collection[str] = ()) -> list[Effect]:
        """Put `calls` in the place of all steps that have not begun.

        Args:
            calls: Their flows count the steps that stay, in order, and then `calls`.
            undoes: Ids of steps that are among `calls` anew; what is being done of them makes way.
        """
        over, stays = self._over and not (undoes and self.run == "halted"), self.staying(undoes)
        self.continues = "" if over and not undoes else self.continues
        others = [step for step in self.steps if step not in stays]
        left = [*others, *(step for step in self.dropped if step.id in undoes and step not in others)]
        new, orders = steps_of(calls, stays, stays), {step.order for step in left}
        for step in new:
            if len(orders) == 1:
                (step.order,) = orders
            if (same := next((old for old in left if old.call == step.call), None)) is not None:
                left.remove(same)
                step.id, step.words, step.order = same.id, same.words, same.order
        past = [step for step in others if step.state != "queued"]
        for step in past:
            step.taken_back, step.id = True, new_id()
        self.steps = [*stays, *past, *new]
        makes_way = [step for step in past if step.state in ACTIVE_STATES]
        for step in makes_way:
            step.ending = True
        self.forget_taken_back()
        effects = self._sync.start() if over and calls else self._sync.push()
        return [*effects, *(effect for step in makes_way for effect in self._sync.end(step))]

    def staying(self, undoes: Collection[str] = ()) -> list[Step]:
        """The steps that an edit leaves as they are."""
        free = {id(step) for step in self.not_begun}
        return [step for step in self.steps if id(step) not in free and step.id not in undoes]

    @property
    def _over(self) -> bool:
        """Whether nothing is left, so that what comes next begins a graph of its own."""
        return self.run in ("none", "halted") and not self.held and not self.pending

    def restore(self, steps: Sequence[Step], continues: str = "") -> None:
        """Take over what an earlier process left, in a graph; it waits until the operator says to go on."""
        self.steps, self.pause_wanted, self.continues = [*steps], bool(steps), continues

    def adopt(self, graph_name: str, steps: Sequence[Step], *, dry: bool, going: bool = False) -> None:
        """Take over a graph that an engine holds since an earlier process; as `restore`.

        Args:
            graph_name: The graph.
            steps: What it consists of, with the ids of its nodes.
            dry: Whether it ran dry; otherwise it stands still.
            going: Whether it goes on instead.
        """
        self.restore(steps)
        self.pause_wanted = self.pause_wanted and not going
        self.graph_name, self.run = graph_name, "running" if going else "halted" if dry else "paused"
        self.next_id = 1 + max((step.instance_id for step in steps), default=-1)

    def fail_again(self, action: str) -> Step | None:
        """Of what an earlier process left, the step whose repair was under way; the plan is held for it."""
        step = next((s for s in self.steps if s.call.name == action and s.state == "queued"), None)
        if step is not None:
            step.state, self.held, self.pause_wanted = "failed", True, False
        return step

    def pause(self) -> list[Effect]:
        """Stand still, keep the plan."""
        self.resumed = False
        if self.held:
            self.given_up = True
            return self._still()
        self.pause_wanted = bool(self.pending)
        return [PauseGraph(self.graph_name)] if self.pause_wanted and self.run in GOING else []

    def start(self) -> list[Effect]:
        """Go on after a pause, or try a failed step again."""
        changes: list[Effect] = []
        if self.held and self.failed is not None:
            changes = self._replace_failed([self.failed.call])
            if self.run != "paused":  # else it stood still already when the step failed
                return changes
        if not self.pending:
            return [Say("There is nothing left to go on with.")]
        self.pause_wanted = False
        if self.run in ("none", "halted"):
            return self._sync.push()
        if self.run not in GOING:
            return []
        # A pause that somebody else caused may not have been reported yet; resuming what runs does nothing.
        changes += self._sync.modify() if self.dirty else []
        self.resumed = True
        return [*changes, ResumeGraph(self.graph_name)]

    def clear(self) -> list[Effect]:
        """Drop everything and stop the robot's graph."""
        self.dropped = self.pending
        for step in self.steps:
            if step.state in OPEN_STATES or step.state == "failed":
                step.state = "stopped"
        self.held = self.given_up = self.pause_wanted = self.dirty = self.awaiting = self.resumed = False
        if not self.graph_name:
            return []
        self.stopping, self.graph_name, self.run = self.graph_name, "", "stopping"
        return [StopGraph(self.stopping)]

    def clear_order(self, order: str) -> list[Effect]:
        """Drop what is left of one order; what else the robot is to do stays."""
        mine = [step for step in self.pending if step.order == order]
        if len(mine) == len(self.pending):
            return self.clear() if mine else []
        # From behind, so that the step in progress is ended when nothing of the order could follow it.
        return [effect for step in reversed(mine) if step in self.pending for effect in self.drop(step)]

    def pop(self, index: int | None) -> list[Effect]:
        """Drop the pending step `index` (0 is the one being executed).

        A missing or impossible index changes nothing and is said (P15).
        """
        pending = self.pending
        if index is None or not 0 <= index < len(pending):
            left = len(pending)
            return [Say(_no_step(index, left), "error")]
        return self.drop(pending[index])

    def meant(self, command: SystemCommand) -> Step | None:
        """The waiting step that a `pop` or `skip` is about; one that names a step means just that one."""
        if named := command.arguments.get("step"):
            return next((step for step in self.pending if step.id == named), None)
        index = command.pop_index if command.command == "pop" else None
        if command.command == "skip":
            return self.current
        return self.pending[index] if index is not None and 0 <= index < len(self.pending) else None

    def keeps_still(self, command: SystemCommand) -> bool:
        """Whether a plan that stands goes on standing after a command: only what has not begun is dropped."""
        step = self.meant(command) if command.command == "pop" else None
        return step is not None and step is not self.current and step.state == "queued"

    def drop(self, step: Step) -> list[Effect]:
        """Drop a pending step."""
        if step is self.current:
            return self.skip()
        if step.state in ACTIVE_STATES:
            if self._ends_others(step):
                return [Say(_ALL_AT_ONCE, "error")]
            step.ending = True
            return self._sync.end(step)
        self.steps.remove(step)
        self.tidy()
        return self._sync.push()

    def skip(self) -> list[Effect]:
        """Leave out the step being executed, or the failed one, and go on with the next.

        Who stands because somebody said so goes on standing: leaving out a step is no word to move.
        """
        current = self.current
        if current is None:
            return [Say("There is no step to skip.")]
        if current.state == "failed":
            return self._replace_failed([])
        if current.state == "queued" and self.run not in ("starting", "continuing", "running"):
            current.state = "skipped"
            self.tidy()
            return self._sync.push()
        if self._ends_others(current):
            return [Say(_ALL_AT_ONCE, "error")]
        current.ending = True
        return self._sync.end(current) if current.state != "queued" else []

    def _ends_others(self, step: Step) -> bool:
        """Whether the engine could end `step` only together with what runs beside it."""
        beside = (s for s in self.steps if s is not step and s.together is step.together)
        return not self.can_end_step() and any(other.state in OPEN_STATES for other in beside)

    def correction(self, calls: Sequence[ActionCall]) -> list[ActionCall]:
        """What will really be put in the failed step's place: `calls` with the values they can be given."""
        failed = self.failed
        if failed is None or not calls:
            return list(calls)
        corrected = with_givers(calls, self.steps[: self.steps.index(failed)])
        return corrected if len(corrected) == len(calls) else [corrected[0], *shifted(calls, 1)]

    def correct(self, calls: Sequence[ActionCall]) -> list[Effect]:
        """Put `calls` in the place of the failed step (none: leave it out) and go on.

        A correction for which nothing failed, or that comes after the repair was ended, is late and dropped.
        """
        return self._replace_failed(calls) if self.failed is not None and not self.given_up else []

    def give_up(self) -> list[Effect]:
        """Repair ended without success: stay held, keep the plan, take the next order."""
        self.given_up, self.resumed = self.held, False
        return [PauseGraph(self.graph_name)] if self.held and self.graph_name else []

    def _still(self) -> list[Effect]:
        """Beside a step that failed another may still be coming to its end."""
        active = any(step.state in ACTIVE_STATES for step in self.steps)
        return [PauseGraph(self.graph_name)] if active and self.graph_name else []

    def _replace_failed(self, calls: Sequence[ActionCall]) -> list[Effect]:
        failed = self.failed
        self.held = self.given_up = False
        if failed is None:
            self.add(calls)
            return self._sync.push()
        if failed.alerted and not calls and not self._lives_on(failed):
            failed.state = "finished"
        else:
            self._put_for(failed, self.correction(calls))
        self.tidy()
        return self._sync.push()

    def _lives_on(self, step: Step) -> bool:
        """Whether another step needs what a step gives, or to know how it ended."""
        given = {*step.call.output_parameters}
        return any((s.when is not None and s.when.step is step) or s.fed & given for s in self.pending)

    def _put_for(self, failed: Step, calls: Sequence[ActionCall]) -> None:
        """Put `calls` in the failed step's place; what ran beside it is done again beside the last."""
        beside = [s for s in self.steps if s.together is failed.together and s.state in OPEN_STATES]
        at = min(self.steps.index(step) for step in [failed, *beside])
        steps = steps_of(calls, self.steps[:at])
        for step in steps:
            step.words, step.order = failed.words, failed.order
        if not steps:
            failed.state = "skipped"  # so that it is told as left out, with what could only follow it
            kept = {id(step) for step in without_orphans(self.steps)}
            for step in self.steps:
                step.state = step.state if id(step) in kept else "skipped"
            return
        place = self.steps.index(failed)
        self.steps[place : place + 1] = steps[-1:]
        self.steps[at:at] = steps[:-1]
        steps[-1].together = failed.together
        heir = next((step for step in reversed(steps) if step.call.name == failed.call.name), steps[-1])
        for step in self.steps:
            if step.when is not None and step.when.step is failed:
                step.when = When(heir, step.when.result)


def _no_step(index: int | None, left: int) -> str:
    """That a step cannot be meant, and how many there are."""
    if index is None:
        several = sentence("There is no such step; {left} steps are left.", left=left)
        return sentence("There is no such step; one step is left.") if left == 1 else several
    number = index + 1
    if left == 1:
        return sentence("There is no step number {number}; one step is left.", number=number)
    return sentence("There is no step number {number}; {left} steps are left.", number=number, left=left)
