"""Plans that wait for a yes, and what an earlier process left of them."""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from parley.clock import Clock
from parley.memory.proposals import KeptProposal
from parley.messages.chat import ActionCall
from parley.messages.status import ActorStatus, PlanProposal
from parley.nodes.asking import as_wish, offered_again, past_offer
from parley.nodes.plan import TargetPlan
from parley.nodes.plan_approval import Approvals, Policy
from parley.nodes.plan_check import check_calls
from parley.nodes.plan_steps import Step
from parley.nodes.proposal_log import ProposalLog

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

    def propose(
        self,
        target: str,
        message: str,
        calls: Sequence[ActionCall],
        status: ActorStatus | None,
        *,
        repairs: Step | None = None,
        announced: bool = False,
    ) -> PlanProposal:
        """Let steps wait for a yes.

        Args:
            target: The robot.
            message: What it will do, in its words.
            calls: The steps.
            status: Its last heartbeat.
            repairs: The failed step in whose place they would be done.
            announced: Whether it has said `message`; otherwise it does when it begins.
        """
        wish = as_wish(message, calls)
        proposal = PlanProposal(id=uuid.uuid4().hex, target=target, message=wish, steps=tuple(calls))
        kept = KeptProposal(
            proposal=proposal,
            agreed="" if announced else message,
            repairs=repairs.call.name if repairs is not None else "",
            unix_ms=self._clock.unix_ms(),
            place=status.pose if status is not None else None,
        )
        self.put(proposal, kept.agreed, repairs)
        self._log.keep(kept)
        return proposal

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
            if check_calls(steps, status.catalogue) or (left.repairs and failed is None):
                self._log.drop(proposal.id)
                found.append((None, past_offer(proposal.message)))
                continue
            self.put(proposal, left.agreed, failed)
            text = offered_again(proposal.message, left.place, status.pose, repairs=failed is not None)
            found.append((proposal, text))
        return found
