"""Words while a plan waits for a yes: what would be done, what is a yes, and what is asked again later."""

from __future__ import annotations

from parley.agents.planner.asking import Offered, begun, offered_again, wish_of
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.principal import person
from parley.messages.status import PlanDecision, PlanProposal, PlanUpdate, PoseInfo


def test_what_would_be_done_is_said_step_by_step() -> None:
    assert wish_of(["Go to the box"]) == "This is what I would do: Go to the box."
    told = wish_of(["Go to the box.", "Look"], "it is far")
    assert told == "I ask first: it is far. This is what I would do: 1. Go to the box, 2. Look."
    assert begun(["Go to the box", "Look"]) == "All right: 1. Go to the box, 2. Look."
    assert begun(["A", "B", "C", "D"]) == "All right: 1. A, 2. B, 3. C, 4. D."
    assert begun(["A", "B", "C", "D", "E"]) == "All right: 1. A, 2. B, 3. C and 2 more."


def said(text: str) -> ChatInput:
    return ChatInput(message=text, targets=("Ada",), author="Kim")


def offered(*ids: str) -> Offered:
    waiting = Offered()
    for identity in ids:
        waiting.on_proposal(PlanProposal(id=identity, target="Ada", digest=f"digest {identity}"))
    return waiting


def test_a_yes_goes_to_what_was_proposed_last() -> None:
    waiting = offered("p1", "p2")
    decision = waiting.decided("Ada", said("yes"), ["Ada"])
    assert decision is not None
    assert (decision.id, decision.target, decision.decision) == ("p2", "Ada", "approve")
    assert decision.digest == "digest p2"
    assert decision.by == person("Kim")
    waiting.on_decision(decision)
    last = waiting.decided("Ada", said("no"), ["Ada"])
    assert last is not None
    assert (last.id, last.decision) == ("p1", "reject")


def test_go_and_see_is_a_yes_to_what_was_only_offered() -> None:
    waiting = offered("p1")
    assert waiting.decided("Ada", said("go and see"), ["Ada"]) is None
    waiting.on_proposal(PlanProposal(id="p2", target="Ada", why="I cannot tell that from here"))
    decision = waiting.decided("Ada", said("go and see"), ["Ada"])
    assert decision is not None and decision.decision == "approve"


def test_a_yes_means_nothing_where_nothing_waits() -> None:
    waiting = offered("p1")
    assert waiting.decided("Bob", said("yes"), ["Ada", "Bob"]) is None
    waiting.on_decision(PlanDecision(id="p1", target="Ada", decision="reject"))
    assert waiting.decided("Ada", said("yes"), ["Ada"]) is None
    waiting = offered("p1")
    waiting.on_update(PlanUpdate(target="Ada", state="awaiting_approval"))
    waiting.on_update(PlanUpdate(target="Ada", state="idle"))
    assert waiting.decided("Ada", said("yes"), ["Ada"]) is None


def test_a_yes_in_words_counts_once_the_robot_has_asked_about_just_that() -> None:
    waiting = offered("p1")
    assert not waiting.is_asked("Ada")
    waiting.on_said(ChatFeedback(message="Go to the box?", targets=("Ada",), asks_yes=True))
    waiting.on_proposal(PlanProposal(id="p1", target="Ada"))  # told once more to who listens newly
    assert waiting.is_asked("Ada")
    waiting.on_proposal(PlanProposal(id="p2", target="Ada"))
    assert not waiting.is_asked("Ada")


def test_a_question_may_be_heard_before_what_it_is_about() -> None:
    waiting = offered()
    waiting.on_said(ChatFeedback(message="Go to the box?", targets=("Ada",), asks_yes=True))
    waiting.on_proposal(PlanProposal(id="p1", target="Ada"))
    assert waiting.is_asked("Ada")
    waiting.on_proposal(PlanProposal(id="p2", target="Ada"))
    assert not waiting.is_asked("Ada")


def test_a_yes_does_not_go_to_what_was_replaced() -> None:
    waiting = offered("p1", "p2")
    waiting.on_update(PlanUpdate(target="Ada", state="awaiting_approval", waits=("p1",)))
    decision = waiting.decided("Ada", said("yes"), ["Ada"])
    assert decision is not None and decision.id == "p1"


def test_a_robot_that_is_somewhere_else_says_so_when_it_asks_again() -> None:
    here, there = PoseInfo(x=1.0, y=1.0), PoseInfo(x=3.0, y=1.0)
    assert "I am not where I was then." in offered_again("I would go.", here, there, repairs=False)
    assert "where I was" not in offered_again("I would go.", here, here, repairs=False)
    assert "where I was" not in offered_again("I would go.", None, there, repairs=False)
