"""Plans that wait for a yes, and what an earlier process left of them."""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from parley.agents.planner.approval import Approvals, Bound, Policy
from parley.agents.planner.asking import offered_again, past_offer, wish_of
from parley.agents.planner.check import check_calls
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.proposal_log import ProposalLog
from parley.agents.planner.steps import Step
from parley.clock import Clock
from parley.memory.proposals import KeptProposal
from parley.messages.status import ActorStatus, PlanProposal

__all__ = ["Offers"]


class Offers(Approvals):
    """Approvals that are written down.

    Args:
        log: Where.
        clock: For the time of each.
        default: The policy of robots for which none was chosen.
        policies: What was chosen for some.
    """

    def __init__(
        self,
        log: ProposalLog,
        clock: Clock,
        default: Policy = "run_at_once",
        policies: Mapping[str, Policy] = MappingProxyType({}),
    ) -> None:
        super().__init__(default, policies, log.drop)
        self._log, self._clock = log, clock
        self._unbegun: dict[str, PlanProposal] = {}

    def propose(
        self,
        proposal: PlanProposal,
        status: ActorStatus | None,
        *,
        repairs: Step | None = None,
        bound: Sequence[Bound] = (),
    ) -> PlanProposal:
        """Let steps and changes wait for a yes.

        Args:
            proposal: Without an id.
            status: The robot's last heartbeat.
            repairs: The failed step in whose place they would be done.
            bound: The changes, each with the step it is about.
        """
        proposal = proposal.model_copy(update={"id": uuid.uuid4().hex})
        self.put(proposal, repairs, bound)
        self._write(proposal, status, repairs)
        return proposal

    def keep_unbegun(self, target: str, made: PlanProposal | None, status: ActorStatus | None) -> None:
        """Write down what a robot keeps that no engine knows of yet, in the place of what was written so.

        Args:
            target: The robot.
            made: It as a proposal, without an id; None: there is nothing like that any more.
            status: The robot's last heartbeat.
        """
        before = self._unbegun.get(target)
        if before is not None and made is not None and before.digest == made.digest:
            return
        if before is not None:
            self._log.drop(self._unbegun.pop(target).id)
        if made is not None:
            self._unbegun[target] = made.model_copy(update={"id": uuid.uuid4().hex})
            self._write(self._unbegun[target], status)

    def _write(self, proposal: PlanProposal, status: ActorStatus | None, repairs: Step | None = None) -> None:
        self._log.keep(
            KeptProposal(
                proposal=proposal,
                repairs=repairs.call.name if repairs is not None else "",
                unix_ms=self._clock.unix_ms(),
                place=status.pose if status is not None else None,
            )
        )

    def take_left(self, plan: TargetPlan, status: ActorStatus) -> list[tuple[PlanProposal | None, str]]:
        """What an earlier process left waiting of a robot, given once.

        Args:
            plan: The robot's, with what was left of it: a repair goes in the place of one of its steps.
            status: Its heartbeat: what its catalogue does not allow any more is dropped.

        Returns:
            Proposals that wait again, or None for one that was dropped, and what to tell people of each.
        """
        found: list[tuple[PlanProposal | None, str]] = []
        for left in self._log.take_left(plan.target):
            proposal = left.proposal
            failed = plan.fail_again(left.repairs) if left.repairs else None
            steps = plan.correction(proposal.steps) if failed is not None else proposal.steps
            wish = wish_of(proposal.lines)
            stale = bool(proposal.commands)  # what they change is not known any more
            if stale or check_calls(steps, status.catalogue) or (left.repairs and failed is None):
                self._log.drop(proposal.id)
                found.append((None, past_offer(wish)))
                continue
            self.put(proposal, failed)
            text = offered_again(wish, left.place, status.pose, repairs=failed is not None)
            found.append((proposal, text))
        return found
