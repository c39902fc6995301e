"""What messages make an operator see."""

from __future__ import annotations

import pytest

from parley.messages.chat import ChatFeedback, ReplyDraft
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanProposal,
    Rejection,
    RejectionProblem,
    StopReport,
)
from parley.terminal.view import LOST_AFTER_S, OperatorView
from tests.terminal.robots import call, plan, step


@pytest.fixture
def view() -> OperatorView:
    made = OperatorView()
    made.on_status(ActorStatus(actor="Ada"), 100.0)
    return made


def toolbar(view: OperatorView) -> list[str]:
    return ["".join(text for _, text in row) for row in view.toolbar()]


def test_the_first_robot_that_appears_is_the_one_spoken_to() -> None:
    view = OperatorView()
    assert view.current is None
    lines = view.on_status(ActorStatus(actor="Ada"), 0.0)
    assert [line.text for line in lines] == ["Ada is here."]
    view.on_status(ActorStatus(actor="Bo"), 0.0)
    assert view.selected == "Ada"
    view.on_status(ActorStatus(actor="Cy", state="running"), 0.0)
    assert toolbar(view) == [" Ada: ready", " Bo: ready · Cy: working"]


def test_a_heartbeat_of_a_known_robot_says_nothing(view: OperatorView) -> None:
    assert view.on_status(ActorStatus(actor="Ada", sequence=2), 101.0) == []


def test_a_robot_that_leaves_hands_the_conversation_to_another(view: OperatorView) -> None:
    view.on_status(ActorStatus(actor="Bo"), 100.0)
    lines = view.on_status(ActorStatus(actor="Ada", state="leaving"), 101.0)
    assert [line.text for line in lines] == ["Ada has left.", "You are now talking to Bo."]
    assert view.selected == "Bo"


def test_a_robot_that_falls_silent_is_reported_once_and_welcomed_back(view: OperatorView) -> None:
    assert view.tick(100.0 + LOST_AFTER_S) == []
    assert [line.text for line in view.tick(100.1 + LOST_AFTER_S)] == ["No contact with Ada."]
    assert view.tick(110.0) == []
    assert toolbar(view) == [" Ada: no contact"]
    assert [line.text for line in view.on_status(ActorStatus(actor="Ada"), 111.0)] == [
        "Ada is in contact again."
    ]


def test_nobody_is_out_of_contact_for_the_time_in_which_the_terminal_itself_hung(view: OperatorView) -> None:
    assert view.tick(100.2 + LOST_AFTER_S, late_s=LOST_AFTER_S) == []
    assert len(view.tick(100.5 + 2 * LOST_AFTER_S)) == 1


def test_a_robot_of_which_others_say_that_it_does_not_answer_is_told_of_once(view: OperatorView) -> None:
    silent = ActorStatus(actor="Ada", trouble="silent")
    told = view.on_status(silent, 101.0) + view.on_status(silent, 102.0)
    assert [line.text for line in told] == ["Ada does not answer. Look whether it stands."]


def test_a_robot_that_is_only_spoken_of_cannot_be_selected(view: OperatorView) -> None:
    view.on_feedback(ChatFeedback(message="I know no Bo.", targets=("Bo",)))
    assert view.select("Bo") is None
    assert toolbar(view) == [" Ada: ready"]


def test_robots_are_selected_without_regard_to_case(view: OperatorView) -> None:
    view.on_status(ActorStatus(actor="Bo"), 100.0)
    assert view.select("bO") is view.robots["Bo"]
    assert view.selected == "Bo"


def test_words_of_a_robot_keep_choices_and_name_what_was_remembered(view: OperatorView) -> None:
    feedback = ChatFeedback(
        message="Which box?",
        targets=("Ada",),
        type="request",
        choices=("red", "blue"),
        sources=("box_place",),
    )
    (line,) = view.on_feedback(feedback)
    assert (line.kind, line.speaker, line.choices) == ("asked", "Ada", ("red", "blue"))
    assert line.footnote == "remembered: box place"


def test_words_of_nobody_in_particular_come_from_parley(view: OperatorView) -> None:
    (line,) = view.on_feedback(ChatFeedback(message="Oh dear.", type="error"))
    assert (line.kind, line.speaker) == ("problem", "Parley")


def test_a_question_without_an_id_lasts_during_information_and_ends_with_an_answer_of_the_robot(
    view: OperatorView,
) -> None:
    robot = view.robots["Ada"]
    view.on_feedback(ChatFeedback(message="Which?", targets=("Ada",), type="request"))
    view.on_feedback(ChatFeedback(message="I see a box.", targets=("Ada",), type="info"))
    assert robot.question is not None
    assert toolbar(view)[0] == " Ada: waiting for your answer"
    view.on_feedback(ChatFeedback(message="Never mind.", targets=("Ada",)))
    assert robot.question is None


def test_a_question_ends_when_it_is_taken_back_and_not_with_other_words(view: OperatorView) -> None:
    robot = view.robots["Ada"]
    view.on_feedback(ChatFeedback(message="Which?", targets=("Ada",), type="request", id="q1"))
    view.on_feedback(ChatFeedback(message="Is it there?", targets=("Ada",), type="request", id="q2"))
    view.on_feedback(ChatFeedback(message="I have stopped.", targets=("Ada",)))
    assert robot.question is not None
    assert robot.question.id == "q2"
    view.on_feedback(ChatFeedback(message="Never mind.", targets=("Ada",), type="info", closes="q2"))
    assert robot.question.id == "q1"


def test_a_reply_that_asks_for_words_is_shown_as_a_question(view: OperatorView) -> None:
    (line,) = view.on_feedback(ChatFeedback(message="Where to?", targets=("Ada",), asks=True))
    assert line.kind == "asked"


def test_an_answer_that_offers_choices_is_shown_as_a_question_but_awaits_no_answer(
    view: OperatorView,
) -> None:
    (line,) = view.on_feedback(ChatFeedback(message="Which box?", targets=("Ada",), choices=("red", "blue")))
    assert (line.kind, line.choices) == ("asked", ("red", "blue"))
    assert view.robots["Ada"].question is None
    assert view.robots["Ada"].offered == ("red", "blue")


def test_refusals_that_a_node_speaks_of_are_not_told_twice(view: OperatorView) -> None:
    problem = RejectionProblem(path="targets", message="unknown robot", code="unknown_robot")
    refused = Rejection(
        source="chat_interface", target="Zed", what="chat_interface_input", problems=(problem,)
    )
    assert view.on_rejection(refused) == []
    view.on_plan(plan(step("go"), graph="g1"))
    of_its_plan = Rejection(source="Ada", target="Ada", what="umrf_graph_start", graph_name="g1")
    assert view.on_rejection(of_its_plan) == []


def test_steps_that_are_over_are_not_shown_again_with_a_longer_plan(view: OperatorView) -> None:
    view.on_plan(plan(step("find the box", "finished", "a_0")))
    lines = view.on_plan(plan(step("find the box", "finished", "a_0"), step("go there", "running", "b_1")))
    assert [line.text for line in lines] == ["Ada's plan:", "▶ 1. go there (now)"]
    assert [line.text for line in view.plan_lines(view.robots["Ada"])] == [
        "Ada's plan:",
        "✓ find the box (done)",
        "▶ 1. go there (now)",
    ]


def test_a_proposal_beside_a_running_plan_stays_until_it_is_decided(view: OperatorView) -> None:
    view.on_plan(plan(step("go there", "running")))
    view.on_plan(PlanProposal(id="p", target="Ada", steps=(call("Go", "come back"),)))
    view.on_plan(plan(step("go there", "running", "b_0")))
    assert len(view.robots["Ada"].pending) == 1


def test_a_question_ends_with_its_plan(view: OperatorView) -> None:
    view.on_plan(plan(step("ask", "waiting")))
    view.on_feedback(ChatFeedback(message="Done?", targets=("Ada",), type="request", id="q"))
    view.on_plan(plan(state="idle"))
    assert view.robots["Ada"].question is None


def test_a_new_plan_is_shown_whole_and_then_only_what_is_done(view: OperatorView) -> None:
    lines = view.on_plan(plan(step("find the box", "running", "a_0"), step("go there", "queued", "b_0")))
    assert [line.text for line in lines] == [
        "Ada's plan:",
        "▶ 1. find the box (now)",
        "○ 2. go there",
    ]
    lines = view.on_plan(plan(step("find the box", "finished", "a_0"), step("go there", "running", "b_0")))
    assert [line.text for line in lines] == ["✓ find the box (done)"]


def test_the_end_of_a_plan_is_left_to_the_robot_to_say(view: OperatorView) -> None:
    view.on_plan(plan(step("go there", "running")))
    lines = view.on_plan(plan(step("go there", "finished"), state="idle"))
    assert [line.text for line in lines] == ["✓ go there (done)"]


def test_a_plan_that_failed_is_not_called_done(view: OperatorView) -> None:
    view.on_plan(plan(step("go there", "running")))
    lines = view.on_plan(plan(step("go there", "failed"), state="held"))
    assert [line.text for line in lines] == ["✗ go there (did not work)"]
    assert toolbar(view)[0] == " Ada: waiting for you"


def test_progress_is_live_and_ends_with_its_step(view: OperatorView) -> None:
    view.on_plan(plan(step("go there", "running", "b_0")))
    event = GraphEvent(actor="Ada", graph_name="g1", sequence=1, kind="progress", node="b_0", progress=0.25)
    assert view.on_event(event) == []
    assert "25 %" in toolbar(view)[1]
    view.on_event(GraphEvent(actor="Ada", graph_name="g1", sequence=2, kind="node", node="b_0"))
    assert "25 %" not in toolbar(view)[1]


def test_a_proposed_plan_asks_for_a_yes_and_goes_with_the_decision(view: OperatorView) -> None:
    proposal = PlanProposal(
        id="p", target="Ada", message="I would go.", steps=(call("Go", "tea!"),), lines=("go to the box",)
    )
    lines = view.on_plan(proposal)
    assert [line.text for line in lines] == [
        "Ada would do this:",
        "1. go to the box",
        "Answer yes or no.",
    ]
    assert lines[-1].kind == "asked"
    assert view.on_plan(plan(step("go to the box"), state="awaiting_approval")) == []
    assert toolbar(view)[0] == " Ada: waiting for your yes"
    assert view.robots["Ada"].pending == [proposal]
    view.on_plan(plan(step("go to the box", "running")))
    assert view.robots["Ada"].pending == []


def test_a_proposal_that_was_replaced_is_not_asked_about_any_more(view: OperatorView) -> None:
    for identity in ("p", "q"):
        view.on_plan(PlanProposal(id=identity, target="Ada", steps=(call("Go", "go to the box"),)))
    view.on_plan(plan(state="awaiting_approval").model_copy(update={"waits": ("p",)}))
    assert [item.id for item in view.robots["Ada"].pending] == ["p"]


def test_an_emergency_stop_of_somebody_else_is_told_and_shown(view: OperatorView) -> None:
    lines = view.on_stop_report(StopReport(actor="Ada", state="received"))
    assert [line.text for line in lines] == [
        "Ada is stopping. To let it move again: /reset, then “carry on”."
    ]
    assert toolbar(view) == [" Ada: stopped, /reset lets it move again"]
    assert [line.text for line in view.on_stop_report(StopReport(actor="Ada", state="at_rest"))] == [
        "Ada stands still."
    ]
    view.on_stop_report(StopReport(actor="Ada", state="reset"))
    assert "stopped" not in toolbar(view)[0]


def test_the_operators_own_stop_is_not_told_twice(view: OperatorView) -> None:
    view.note_own_stop("s1")
    assert view.on_stop_report(StopReport(actor="Ada", id="s1", state="received")) == []


def test_a_release_that_a_robot_did_not_hear_is_said(view: OperatorView) -> None:
    for name in ("Ada", "Bob"):
        view.on_status(ActorStatus(actor=name, state="stopped", stop=f"of {name}"), now_s=10.0)
    view.note_own_release()
    assert view.known_stops() == ("of Ada", "of Bob")
    view.on_stop_report(StopReport(actor="Ada", state="reset"))
    told = [line.text for now_s in (10.0, 11.9, 12.1, 13.0) for line in view.tick(now_s)]
    told = [text for text in told if "No contact" not in text]
    assert told == ["Bob has not heard that it is released and stays stopped. Write /reset again."]


def test_who_does_not_answer_a_stop_in_time_is_named_once(view: OperatorView) -> None:
    view.note_own_stop("s1", ["Ada", "Bob"])
    view.on_stop_report(StopReport(actor="Ada", id="s1", state="received"))
    assert [line.text for now_s in (100.0, 101.9) for line in view.tick(now_s)] == []
    view.on_status(ActorStatus(actor="Ada", state="stopped"), 102.0)
    assert [line.text for now_s in (102.1, 103.0) for line in view.tick(now_s)] == [
        "Bob does not answer. Look whether it stands."
    ]


@pytest.mark.parametrize(
    ("what", "code", "message", "shown"),
    [
        (
            "umrf_graph_start",
            "stop_latched",
            "latched",
            "was stopped by the emergency stop. Write /reset first.",
        ),
        ("umrf_graph_start", "unknown_action", "actions[0].name: unknown", "could not accept that"),
        ("chat_interface_input", "invalid", "longer than 10000 characters", "longer than 10000 characters"),
    ],
)
def test_refusals_are_told_in_plain_words(
    view: OperatorView, what: str, code: str, message: str, shown: str
) -> None:
    problem = RejectionProblem(path="actions[0].name", message=message, code=code)
    (line,) = view.on_rejection(Rejection(source="Ada", target="Ada", what=what, problems=(problem,)))
    assert line.kind == "problem"
    assert shown in line.text
    assert "actions[0]" not in line.text


@pytest.mark.parametrize(
    ("state", "plan_state", "may_move"),
    [
        ("idle", "idle", False),
        ("running", "idle", True),
        ("idle", "running", True),
        ("paused", "paused", True),
        ("stopped", "paused", False),
    ],
)
def test_a_stop_makes_sense_only_for_a_robot_that_may_move(
    view: OperatorView, state: str, plan_state: str, may_move: bool
) -> None:
    view.on_status(ActorStatus.model_validate({"actor": "Ada", "state": state}), 101.0)
    view.on_plan(plan(step("go"), state=plan_state))
    assert view.robots["Ada"].may_move is may_move


def test_reply_that_is_being_written_stands_in_the_live_view_until_it_is_whole(view: OperatorView) -> None:
    assert view.on_draft(ReplyDraft(reply_to="m1", targets=("Ada",), message="I will\ngo")) == []
    assert toolbar(view) == [" Ada: ready", " … I will go"]
    view.on_draft(ReplyDraft(reply_to="m1", targets=("Ada",), message=f"begin{'x' * 200} end"))
    assert toolbar(view)[1].endswith("xxx end")
    assert "begin" not in toolbar(view)[1]
    view.on_feedback(ChatFeedback(message="Still thinking.", targets=("Ada",), type="info"))
    assert len(toolbar(view)) == 2
    view.on_feedback(ChatFeedback(message="I will go.", targets=("Ada",), reply_to="m1"))
    assert toolbar(view) == [" Ada: ready"]


def test_a_notice_may_offer_something_until_the_next_reply(view: OperatorView) -> None:
    notice = ChatFeedback(message="Still thinking.", targets=("Ada",), type="info", choices=("never mind",))
    view.on_feedback(notice)
    view.on_feedback(ChatFeedback(message="By the way.", targets=("Ada",), type="info"))
    assert view.robots["Ada"].offered == ("never mind",)
    view.on_feedback(ChatFeedback(message="Done.", targets=("Ada",)))
    assert not view.robots["Ada"].offered
