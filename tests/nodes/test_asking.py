"""Words while a plan waits for a yes: what would be done, what is a yes, and what is asked again later."""

from __future__ import annotations

import pytest

from parley.messages.chat import ActionCall
from parley.messages.status import PlanDecision, PlanProposal, PlanUpdate, PoseInfo
from parley.nodes.asking import Offered, as_wish, assent_of, offered_again

GO = ActionCall(name="Go", reason="go to the box")


@pytest.mark.parametrize(
    ("said", "wish"),
    [
        ("I will go to the box.", "I would go to the box."),
        ("All right. I'll look for it, and then I will come back.",
         "All right. I would look for it, and then I would come back."),
        ("I will remember that. I will go to the box.", "I will remember that. I would go to the box."),
        ("I will not touch it. I will go there.", "I will not touch it. I would go there."),
        ("On my way!", "This is what I would do: go to the box."),
        ("Ma lähen kasti juurde.", "This is what I would do: go to the box."),
    ],
)  # fmt: skip
def test_what_will_be_done_becomes_what_would_be_done(said: str, wish: str) -> None:
    assert as_wish(said, [GO]) == wish


@pytest.mark.parametrize("said", ["yes", "Yes, please!", "OK", "do it", "yes, Ada", "Jah", "please do"])
def test_a_yes_is_a_yes(said: str) -> None:
    assert assent_of(said, ["Ada"]) is True


@pytest.mark.parametrize("said", ["no", "No, thanks.", "don't", "please don't do it", "Ei"])
def test_a_no_is_a_no(said: str) -> None:
    assert assent_of(said, ["Ada"]) is False


@pytest.mark.parametrize("said", ["yes?", "yes, but go to the chair first", "no, the other one", "", "Ada"])
def test_everything_else_is_neither(said: str) -> None:
    assert assent_of(said, ["Ada"]) is None


def offered(*ids: str) -> Offered:
    waiting = Offered()
    for identity in ids:
        waiting.on_proposal(PlanProposal(id=identity, target="Ada"))
    return waiting


def test_a_yes_goes_to_what_was_proposed_last() -> None:
    waiting = offered("p1", "p2")
    decision = waiting.decided("Ada", "yes", ["Ada"])
    assert decision is not None
    assert (decision.id, decision.target, decision.decision) == ("p2", "Ada", "approve")
    waiting.on_decision(decision)
    last = waiting.decided("Ada", "no", ["Ada"])
    assert last is not None
    assert (last.id, last.decision) == ("p1", "reject")


def test_a_yes_means_nothing_where_nothing_waits() -> None:
    waiting = offered("p1")
    assert waiting.decided("Bob", "yes", ["Ada", "Bob"]) is None
    waiting.on_decision(PlanDecision(id="p1", target="Ada", decision="reject"))
    assert waiting.decided("Ada", "yes", ["Ada"]) is None
    waiting = offered("p1")
    waiting.on_update(PlanUpdate(target="Ada", state="awaiting_approval"))
    waiting.on_update(PlanUpdate(target="Ada", state="running"))
    assert waiting.decided("Ada", "yes", ["Ada"]) is None


def test_a_robot_that_is_somewhere_else_says_so_when_it_asks_again() -> None:
    here, there = PoseInfo(x=1.0, y=1.0), PoseInfo(x=3.0, y=1.0)
    assert "I am not where I was then." in offered_again("I would go.", here, there, repairs=False)
    assert "where I was" not in offered_again("I would go.", here, here, repairs=False)
    assert "where I was" not in offered_again("I would go.", None, there, repairs=False)
