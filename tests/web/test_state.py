"""The books behind the page: messages in, views and changes out; no loop, no clock."""

from __future__ import annotations

from typing import Any

import pytest

from parley.messages.chat import ActionCall, ChatFeedback, ChatInput, ReplyDraft, SystemCommand
from parley.messages.principal import person
from parley.messages.pvf import Parameter
from parley.messages.rules import RiskClass
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanUpdate,
    StopCommand,
    StopReport,
)
from parley.umrf.model import Graph, GraphState, Node, NodeState
from parley.web.changes import ChangeLog
from parley.web.chat_state import KEPT_ENTRIES, ChatBook
from parley.web.limits import Attempts, Rate
from parley.web.models import (
    AbilityView,
    Change,
    ChatEntry,
    PlanView,
    ProposalGone,
    RobotChange,
    RobotGone,
    RobotView,
)
from parley.web.plan_state import PlanBook
from parley.web.robot_state import LOST_AFTER_S, RELEASE_HOLDS_S, STOP_DEADLINE_S, RobotBook


class Ids:
    def __init__(self) -> None:
        self._next = 0

    def __call__(self) -> str:
        self._next += 1
        return f"id{self._next}"


# -- changes -------------------------------------------------------------------------------------------


KIM = person("Kim")


def robot_change(name: str) -> RobotChange:
    return RobotChange(seq=0, robot=RobotView(name=name))


def test_the_log_tells_each_thing_once_and_in_order() -> None:
    log = ChangeLog("r")
    for name in ("a", "b", "a", "c"):
        log.add(robot_change(name))
    log.add(RobotGone(seq=0, name="b"))
    assert [(change.kind, change.seq) for change in log.since(0) or ()] == [
        ("robot", 3),
        ("robot", 4),
        ("robot_gone", 5),
    ]
    assert log.since(5) == []
    assert log.since(6) is None


def test_what_is_too_old_is_not_known_any_more() -> None:
    log = ChangeLog("r", limit=3)
    for number in range(5):
        log.add(robot_change(str(number)))
    assert log.since(1) is None
    assert [change.seq for change in log.since(2) or ()] == [3, 4, 5]


# -- robots --------------------------------------------------------------------------------------------


def robots() -> tuple[RobotBook, list[Change]]:
    changes: list[Change] = []
    return RobotBook(changes.append), changes


def beat(book: RobotBook, now_s: float = 0.0, **status: Any) -> bool:
    heartbeat = ActorStatus.model_validate({"actor": "Ada", "sequence": 1, **status})
    return book.on_status(heartbeat, now_s=now_s, unix_ms=int(1000 * now_s))


def connection(book: RobotBook) -> str:
    return book.views["Ada"].connection


def stop_state(book: RobotBook) -> str:
    return book.views["Ada"].stop.state


def test_the_policy_that_was_told_before_the_robot_came_holds() -> None:
    book, _ = robots()
    book.on_plan(PlanUpdate(target="Ada", policy="ask_first"))
    book.on_status(ActorStatus(actor="Ada"), now_s=0.0, unix_ms=0)
    assert book.views["Ada"].policy == "ask_first"
    book.remove("Ada")
    assert book.add("Ada").policy == "ask_first"


def test_a_silent_robot_is_lost_and_comes_back() -> None:
    book, changes = robots()
    beat(book)
    book.tick(now_s=LOST_AFTER_S)
    assert connection(book) == "here"
    book.tick(now_s=LOST_AFTER_S + 0.1)
    assert connection(book) == "lost"
    beat(book, 6.0, sequence=2)
    assert connection(book) == "here"
    assert len(changes) == 3


def test_no_robot_is_lost_for_the_time_in_which_the_server_heard_nothing_but_its_stop_is_late() -> None:
    book, _ = robots()
    beat(book)
    stop(book)
    late_s = max(LOST_AFTER_S, STOP_DEADLINE_S) + 1.0
    book.tick(now_s=late_s + 0.25, late_s=late_s)
    assert (connection(book), stop_state(book)) == ("here", "silent")
    book.tick(now_s=late_s + LOST_AFTER_S + 0.1)
    assert connection(book) == "lost"


def test_heartbeats_alone_are_no_news() -> None:
    book, changes = robots()
    for number in range(10):
        beat(book, float(number), sequence=number)
    assert len(changes) == 1
    assert book.views["Ada"].last_seen_unix_ms == 9000


@pytest.mark.parametrize(("before", "after"), [(5, 0), (5, 4)])
def test_a_robot_whose_heartbeats_count_anew_was_restarted(before: int, after: int) -> None:
    book, _ = robots()
    assert beat(book, sequence=before) is False
    assert beat(book, sequence=after) is True


def test_a_robot_that_left_is_here_again_with_its_next_heartbeat() -> None:
    book, _ = robots()
    beat(book)
    beat(book, state="leaving")
    assert connection(book) == "left"
    assert beat(book, sequence=2) is True
    assert connection(book) == "here"


def stop(book: RobotBook, command: str = "stop", now_s: float = 0.0) -> None:
    pressed = StopCommand.model_validate({"command": command, "targets": ["Ada"], "id": "s"})
    book.on_stop(pressed, now_s=now_s, unix_ms=1)


def test_a_robot_that_knows_of_the_stop_counts_as_moving_until_it_stands() -> None:
    book, _ = robots()
    beat(book)
    stop(book)
    book.on_stop_report(StopReport(actor="Ada", id="s", state="received"), unix_ms=2)
    book.tick(now_s=STOP_DEADLINE_S)
    assert stop_state(book) == "received"
    book.tick(now_s=STOP_DEADLINE_S + 0.1)
    assert stop_state(book) == "moves"
    book.on_stop_report(StopReport(actor="Ada", id="s", state="at_rest"), unix_ms=9)
    assert (stop_state(book), book.views["Ada"].stop.at_rest_unix_ms) == ("at_rest", 9)


def test_who_comes_later_learns_of_a_stop_by_the_heartbeat() -> None:
    book, _ = robots()
    beat(book, state="stopped", at_rest=True)
    assert stop_state(book) == "at_rest"


def test_a_heartbeat_from_before_the_stop_does_not_lift_it() -> None:
    book, _ = robots()
    beat(book)
    stop(book)
    book.on_stop_report(StopReport(actor="Ada", id="s", state="received"), unix_ms=2)
    beat(book, state="running", sequence=2)
    assert stop_state(book) == "received"


@pytest.mark.parametrize("sequence", [9, 0])
def test_a_stop_that_a_robot_did_not_hear_is_told_to_it_when_it_is_heard_again(sequence: int) -> None:
    book = RobotBook(lambda change: None)
    book.on_status(ActorStatus(actor="A", sequence=5), now_s=0, unix_ms=0)
    assert book.not_taken("A") is None
    book.on_stop(StopCommand(id="s", by=KIM), now_s=1, unix_ms=1)
    book.tick(now_s=1 + STOP_DEADLINE_S + 0.1)
    book.on_status(ActorStatus(actor="A", sequence=sequence), now_s=9, unix_ms=9)
    assert book.not_taken("A") == StopCommand(targets=("A",), id="s", by=KIM)
    book.on_stop_report(StopReport(actor="A", id="s", state="silent"), unix_ms=9)
    assert (book.views["A"].stop.state, book.not_taken("A")) == ("silent", None)


def out_of_reach() -> RobotBook:
    """Of a robot that was stopped, and released when it could not hear it."""
    book = RobotBook(lambda change: None)
    book.on_status(ActorStatus(actor="A", sequence=5), now_s=0, unix_ms=0)
    book.on_stop(StopCommand(id="s", by=KIM), now_s=1, unix_ms=1)
    book.on_stop_report(StopReport(actor="A", id="s", state="at_rest"), unix_ms=2)
    book.on_stop(StopCommand(command="reset", id="r", by=KIM), now_s=3, unix_ms=3)
    assert (book.views["A"].stop.state, book.views["A"].stop.release) == ("at_rest", "sent")
    return book


def stopped_by(book: RobotBook, stop: str, *, now_s: float, sequence: int = 9) -> None:
    status = ActorStatus(actor="A", sequence=sequence, state="stopped", at_rest=True, stop=stop)
    book.on_status(status, now_s=now_s, unix_ms=int(now_s * 1000))


def test_a_release_that_a_robot_did_not_hear_is_told_to_it_when_it_is_heard_again() -> None:
    book = out_of_reach()
    stopped_by(book, "s", now_s=9)
    release = StopCommand(command="reset", targets=("A",), id="r", by=KIM, stops=("s",))
    assert book.not_released("A", now_s=9) == release
    book.on_stop(release, now_s=9, unix_ms=9)  # it is heard here, too, and waits no longer by that
    assert book.not_released("A", now_s=9.5) is None
    stopped_by(book, "s", now_s=11)
    assert book.not_released("A", now_s=11) == release
    book.on_stop_report(StopReport(actor="A", id="r", state="reset"), unix_ms=12)
    assert (book.views["A"].stop.state, book.not_released("A", now_s=20)) == ("none", None)


@pytest.mark.parametrize("why", ["too late", "stopped since", "started anew"])
def test_a_release_that_does_not_count_any_more_is_not_told_and_that_is_said(why: str) -> None:
    book = out_of_reach()
    late_s = 3 + RELEASE_HOLDS_S + 0.1 if why == "too late" else 9
    book.tick(now_s=late_s)
    stopped_by(
        book, "t" if why == "stopped since" else "s", now_s=late_s, sequence=0 if why == "started anew" else 9
    )
    assert book.not_released("A", now_s=late_s) is None
    assert (book.views["A"].stop.state, book.views["A"].stop.release) == ("at_rest", "lost")
    book.on_stop(StopCommand(command="reset", id="r2", by=KIM), now_s=late_s + 1, unix_ms=1)
    assert book.views["A"].stop.release == "sent"


def test_a_release_ends_where_a_new_stop_begins() -> None:
    book = out_of_reach()
    book.on_stop(StopCommand(id="t", by=KIM), now_s=4, unix_ms=4)
    stopped_by(book, "t", now_s=9)
    assert (book.not_released("A", now_s=9), book.views["A"].stop.release) == (None, "none")
    assert book.known_stops(()) == ("s", "t")


def test_a_stop_that_reached_nobody_is_taken_back_by_a_reset_but_a_confirmed_one_is_not() -> None:
    book, _ = robots()
    beat(book)
    stop(book)
    stop(book, "reset")
    assert stop_state(book) == "none"
    stop(book)
    book.on_stop_report(StopReport(actor="Ada", id="s", state="received"), unix_ms=2)
    stop(book, "reset")
    assert stop_state(book) == "received"
    book.on_stop_report(StopReport(actor="Ada", state="reset"), unix_ms=3)
    assert stop_state(book) == "none"


# -- chat ----------------------------------------------------------------------------------------------


def chat() -> tuple[ChatBook, list[ChatEntry]]:
    entries: list[ChatEntry] = []
    return ChatBook(entries.append, Ids()), entries


def said(text: str, **more: Any) -> ChatFeedback:
    return ChatFeedback.model_validate({"message": text, "targets": ["Ada"], **more})


def test_a_question_is_closed_by_the_robot_or_answered_by_an_operator() -> None:
    book, _ = chat()
    for key in ("q1", "q2"):
        book.on_feedback(said(key, type="request", id=key), unix_ms=1)
    book.on_feedback(said("never mind", type="info", closes="q1"), unix_ms=2)
    book.said(book.compose("m", "yes", ["ada"], by=KIM, unix_ms=3))
    assert [book.entries[key].question for key in ("q1", "q2")] == ["closed", "answered"]
    assert book.entries["q2"].answer_id == "m"


def test_a_yes_is_asked_for_until_nothing_waits_for_one_whatever_the_words() -> None:
    book, _ = chat()
    book.on_feedback(said("Soll ich dorthin fahren?", reply_to="m", asks_yes=True), unix_ms=1)
    book.on_feedback(said("He asked: “Shall I?”, and I said: Shall I?"), unix_ms=2)
    keys = list(book.entries)
    assert [book.entries[key].asks_yes for key in keys] == [True, False]
    book.on_decided("Bob")
    assert book.entries[keys[0]].asks_yes
    book.on_decided("Ada")
    assert not book.entries[keys[0]].asks_yes


def test_a_question_without_a_name_lasts_until_the_robots_next_words() -> None:
    book, entries = chat()
    book.on_feedback(said("Which?", type="request"), unix_ms=1)
    book.on_feedback(said("by the way", type="info"), unix_ms=2)
    assert entries[0].id in book.entries
    assert book.entries[entries[0].id].question == "open"
    book.on_feedback(said("Done."), unix_ms=3)
    assert book.entries[entries[0].id].question == "closed"


def test_a_question_asked_again_word_for_word_is_one() -> None:
    book, entries = chat()
    for _ in range(3):
        book.on_feedback(said("Which?", type="request", id="q1"), unix_ms=1)
    assert len(entries) == 1


def test_of_several_questions_the_one_that_is_named_is_answered() -> None:
    book, _ = chat()
    for key in ("q1", "q2"):
        book.on_feedback(said(key, type="request", id=key), unix_ms=1)
    composed = book.compose("m", "yes", ["Ada"], reply_to="q2", by=KIM, unix_ms=2)
    assert [message.reply_to for message in composed.messages] == ["q2"]


def test_the_echo_of_an_own_message_and_of_its_parts_is_no_news() -> None:
    book, entries = chat()
    book.on_feedback(said("Which?", type="request", id="q1"), unix_ms=1)
    composed = book.compose("m", "red", ["Ada", "Bob"], by=KIM, unix_ms=2)
    book.said(composed)
    count = len(entries)
    for message in composed.messages:
        book.on_input(message, unix_ms=3)
    assert len(entries) == count
    assert {message.id for message in composed.messages} == {"m", "m~1"}


def test_a_reply_to_a_part_is_a_reply_to_the_whole_message() -> None:
    book, entries = chat()
    book.on_feedback(said("Which?", type="request", id="q1"), unix_ms=1)
    book.said(book.compose("m", "red", ["Ada", "Bob"], by=KIM, unix_ms=2))
    book.on_feedback(said("Red it is.", reply_to="m~1"), unix_ms=3)
    assert entries[-1].reply_to == "m"


def test_an_answer_given_elsewhere_settles_the_question() -> None:
    book, _ = chat()
    book.on_feedback(said("Which?", type="request", id="q1"), unix_ms=1)
    answer = ChatInput(message="red", targets=("Ada",), type="response", reply_to="q1", id="t")
    book.on_input(answer, unix_ms=2)
    assert book.entries["q1"].answer_id == "t"


def test_a_late_draft_does_not_replace_the_reply() -> None:
    book, entries = chat()
    draft = ReplyDraft(reply_to="m", targets=("Ada",), message="I w")
    book.on_draft(draft, unix_ms=1)
    book.on_feedback(said("I will.", reply_to="m"), unix_ms=2)
    book.on_draft(draft, unix_ms=3)
    assert [entry.message for entry in entries] == ["I w", "I will."]
    assert len(book.entries) == 1


def test_two_replies_to_one_message_are_two_entries() -> None:
    book, _ = chat()
    book.on_feedback(said("I will.", reply_to="m"), unix_ms=1)
    book.on_feedback(said("I have.", reply_to="m"), unix_ms=2)
    assert [entry.message for entry in book.newest()] == ["I will.", "I have."]


def test_a_restarted_robot_awaits_nothing() -> None:
    book, _ = chat()
    book.on_feedback(said("Which?", type="request", id="q1"), unix_ms=1)
    book.on_restart("Ada")
    assert book.entries["q1"].question == "closed"
    assert book.compose("m", "red", ["Ada"], by=KIM, unix_ms=2).messages[0].type == "request"


def test_a_long_conversation_is_cut_but_open_questions_stay() -> None:
    book, _ = chat()
    book.on_feedback(said("Which?", type="request", id="q1"), unix_ms=1)
    for number in range(3 * KEPT_ENTRIES):
        book.on_feedback(said(str(number), type="info"), unix_ms=number)
    assert len(book.entries) <= 2 * KEPT_ENTRIES
    assert book.newest(10)[0].id == "q1"
    assert len(book.newest(10)) == 11


# -- plans ---------------------------------------------------------------------------------------------


def plans() -> tuple[PlanBook, list[Change]]:
    changes: list[Change] = []
    return PlanBook(
        changes.append, lambda _robot, name: AbilityView(name=name, kind=RiskClass.HANDLES)
    ), changes


def step(name: str, state: str = "queued", node: str = "", **inputs: str) -> dict[str, Any]:
    call = ActionCall(
        name=name, input_parameters={key: Parameter("string", value) for key, value in inputs.items()}
    )
    return {"action": call.model_dump(), "state": state, "node": node}


def update(*steps: dict[str, Any], state: str = "running", graph: str = "g1", **more: Any) -> PlanUpdate:
    body = {"target": "Ada", "graph_name": graph, "state": state, "steps": steps, **more}
    return PlanUpdate.model_validate(body)


def event(node: str, state: str = "", graph: str = "g1", **more: Any) -> GraphEvent:
    kind = "graph" if not node else "progress" if "progress" in more else "node"
    body = {"actor": "Ada", "graph_name": graph, "sequence": 0, "kind": kind, "state": state, "node": node}
    return GraphEvent.model_validate({**body, **more})


def plan_of(book: PlanBook, graph: str = "g1") -> PlanView:
    return book.views["Ada", graph]


def test_a_step_shows_what_the_planner_and_the_engine_know_of_it() -> None:
    book, _ = plans()
    book.on_update(update(step("MoveTo", "running", "MoveTo_0", place="the door")))
    book.on_event(event("MoveTo_0", "RUNNING", unix_ms=5))
    book.on_event(event("MoveTo_0", progress=0.5, progress_text="2 m left"))
    (shown,) = plan_of(book).steps
    assert (shown.label, shown.risk, shown.started_unix_ms) == ("move to: the door", "handles_things", 5)
    assert (shown.progress, shown.progress_text) == (0.5, "2 m left")
    book.on_event(event("MoveTo_0", "ERROR", unix_ms=9, message='{"message": "The way is blocked."}'))
    book.on_update(update(step("MoveTo", "failed", "MoveTo_0", place="the door"), state="held"))
    (shown,) = plan_of(book).steps
    assert (shown.state, shown.message, shown.progress) == ("failed", "The way is blocked.", None)
    assert shown.ended_unix_ms == 9


def test_altered_steps_of_a_running_plan_are_marked_until_the_next_change() -> None:
    book, _ = plans()
    first = step("MoveTo", "running", "MoveTo_0")
    book.on_update(update(first))
    assert plan_of(book).changed == ()
    book.on_update(update(first, step("Look", node="Look_1")))
    assert plan_of(book).changed == ("Look_1",)
    book.on_event(event("MoveTo_0", progress=0.1))
    assert plan_of(book).changed == ("Look_1",)
    book.on_update(update(first, step("Look", node="Look_1"), step("Wave", node="Wave_2")))
    assert plan_of(book).changed == ("Wave_2",)


def test_a_robot_has_one_plan_and_late_news_of_the_old_one_are_dropped() -> None:
    book, changes = plans()
    book.on_update(update(step("MoveTo", node="MoveTo_0")))
    book.on_update(update(step("Look", node="Look_0"), graph="g2"))
    book.on_event(event("MoveTo_0", "FINISHED"))
    assert list(book.views) == [("Ada", "g2")]
    assert [change.kind for change in changes] == ["plan", "plan_gone", "plan"]


def test_a_plan_that_is_over_says_so() -> None:
    book, _ = plans()
    book.on_update(update(step("MoveTo", "finished", "MoveTo_0"), state="idle"))
    assert plan_of(book).state == "ended"
    book.on_update(update(state="idle", graph=""))
    assert plan_of(book, "").state == "idle"


def test_whether_a_plan_stands_is_told_by_its_engine_while_who_plans_hangs() -> None:
    book, _ = plans()
    book.on_update(update(step("MoveTo", "running", "MoveTo_0")))
    for state, shown in (("PAUSED", "paused"), ("RUNNING", "running"), ("PAUSED", "paused")):
        book.on_event(event("", state))
        book.on_event(event("MoveTo_0", progress=0.5))
        assert plan_of(book).state == shown
    book.on_update(update(step("MoveTo", "paused", "MoveTo_0"), state="paused"))
    book.on_update(update(step("MoveTo", "running", "MoveTo_0")))
    assert plan_of(book).state == "running", "who plans says so later"


def test_how_far_a_plan_is_is_told_by_its_engine_while_who_plans_hangs() -> None:
    def states() -> tuple[str, ...]:
        return (plan_of(book).state, *(one.state for one in plan_of(book).steps))

    book, _ = plans()
    rest = step("Look", node="Look_1")
    book.on_update(update(step("MoveTo", "running", "MoveTo_0"), rest))
    book.on_event(event("MoveTo_0", "FINISHED"))
    book.on_event(event("Look_1", "RUNNING"))
    assert states() == ("running", "finished", "running")
    book.on_event(event("Look_1", "ERROR", message='{"message": "It is dark."}'))
    book.on_event(event("", "HALTED"))
    assert states() == ("held", "finished", "failed")
    assert plan_of(book).steps[1].message == "It is dark."
    book.on_update(update(step("MoveTo", "finished", "MoveTo_0"), step("Look", "waiting", "Look_1")))
    assert states()[1:] == ("finished", "waiting"), "who plans says so later"


def test_graphs_that_others_started_are_watched() -> None:
    book, _ = plans()
    for number in range(6):
        name = f"other{number}"
        book.on_event(event("Look_0", "RUNNING", graph=name))
        assert (plan_of(book, name).kind, plan_of(book, name).state) == ("graph", "running")
        assert [(shown.action, shown.state) for shown in plan_of(book, name).steps] == [("Look", "running")]
        book.on_event(event("", "FINISHED", graph=name))
    assert [name for _, name in book.views] == ["other3", "other4", "other5"]


# -- limits --------------------------------------------------------------------------------------------


def test_a_graph_of_others_is_shown_whole_before_anything_of_it_ran() -> None:
    book, _ = plans()
    whole = Graph("g9", (Node("Look", description="see"), Node("Move", 1)), state=GraphState.RUNNING)
    book.on_graph("Ada", whole)
    shown = plan_of(book, "g9")
    assert (shown.kind, shown.state) == ("graph", "running")
    assert [(s.id, s.action, s.label, s.reason, s.state) for s in shown.steps] == [
        ("Look_0", "Look", "look", "see", "queued"),
        ("Move_1", "Move", "move", "", "queued"),
    ]
    book.on_event(event("Move_1", "RUNNING", graph="g9"))
    book.on_graph("Ada", whole)  # tells later what the event told already
    assert [s.state for s in plan_of(book, "g9").steps] == ["queued", "running"]


def test_of_an_engine_without_events_whole_graphs_tell_how_far_it_is() -> None:
    book, _ = plans()
    node = Node("Look", state=NodeState.FINISHED)
    over = Graph("g9", (node,), state=GraphState.FINISHED)
    book.on_graph("Ada", over)
    assert book.views == {}, "what was over before is no news"
    book.on_graph("Ada", Graph("g9", (Node("Look", state=NodeState.RUNNING),), state=GraphState.RUNNING))
    assert plan_of(book, "g9").steps[0].state == "running"
    book.on_graph("Ada", over)
    shown = plan_of(book, "g9")
    assert (shown.state, shown.steps[0].state) == ("ended", "finished")


def test_whole_graphs_of_plans_change_nothing() -> None:
    book, changes = plans()
    book.on_update(update(step("Look", "running", "Look_0")))
    before = list(changes)
    book.on_graph("Ada", Graph("g1", (Node("Move"),)))
    assert changes == before


def test_cards_show_what_code_says_of_changes_and_steps_and_never_what_a_model_wrote() -> None:
    book, _ = plans()
    calls = (ActionCall(name="GoTo", reason="Approved by Kim"), ActionCall(name="LookAround", reason="Done"))
    forget = SystemCommand(command="remove_memory", arguments={"name": "box"})
    labels = ("Forget “box”", "Go to “door”")
    book.on_proposal(PlanProposal(id="1", target="Ada", steps=calls, commands=(forget,), labels=labels))
    shown = book.proposals["1"]
    assert shown.changes == ("Forget “box”",)
    assert [step.label for step in shown.steps] == ["Go to “door”", "look around"]


def test_a_yes_to_what_waits_no_more_leaves_the_newest_alone() -> None:
    book, _ = plans()
    for identity in ("old", "new"):
        book.on_proposal(PlanProposal(id=identity, target="Ada", steps=(ActionCall(name="GoTo"),)))
        book.on_decision(PlanDecision(id="old", target="Ada", decision="approve"))
    assert list(book.proposals) == ["new"]


def test_progress_of_one_step_leaves_the_others_as_they_are() -> None:
    book, changes = plans()
    book.on_update(update(step("Look", "running", "Look_0"), step("Move", node="Move_0")))
    before = plan_of(book).steps
    book.on_event(event("Look_0", kind="progress", progress=0.5))
    after = plan_of(book).steps
    assert after[0].progress == 0.5
    assert after[1] is before[1]
    count = len(changes)
    book.on_event(event("Look_0", kind="progress", progress=0.5))
    assert len(changes) == count, "the same again is no news"


def test_a_proposal_told_again_is_no_news() -> None:
    book, changes = plans()
    proposal = PlanProposal(id="p1", target="Ada", steps=(ActionCall(name="Look"),))
    book.on_proposal(proposal)
    count = len(changes)
    book.on_proposal(proposal)
    assert len(changes) == count


def test_the_time_while_a_step_stood_still_is_not_work() -> None:
    book, _ = plans()
    book.on_update(update(step("MoveTo", "running", "MoveTo_0")))
    for state, at_ms in [("RUNNING", 100), ("PAUSED", 400), ("RUNNING", 9_000), ("FINISHED", 9_100)]:
        book.on_event(event("MoveTo_0", state, unix_ms=at_ms))
        if at_ms == 9_000:
            now = plan_of(book).steps[0]
            assert (now.worked_ms, now.working_since_unix_ms) == (300, 9_000)
    book.on_update(update(step("MoveTo", "finished", "MoveTo_0")))
    assert plan_of(book).steps[0].worked_ms == 400


def test_a_proposal_that_was_replaced_is_gone_while_others_wait() -> None:
    book, changes = plans()
    for identity in ("p1", "p2", "p3"):
        book.on_proposal(PlanProposal(id=identity, target="Ada", steps=(ActionCall(name="Press"),)))
    book.on_update(update(state="awaiting_approval", waits=("p1", "p3")))
    assert list(book.proposals) == ["p1", "p3"]
    assert [change.id for change in changes if isinstance(change, ProposalGone)] == ["p2"]


def test_how_much_care_a_step_needs_is_said_when_it_becomes_known() -> None:
    changes: list[Any] = []
    risks: dict[str, RiskClass] = {}
    book = PlanBook(
        changes.append, lambda _robot, name: AbilityView(name=name, kind=risks.get(name, RiskClass.MOVES))
    )
    book.on_proposal(PlanProposal(id="p1", target="Ada", steps=(ActionCall(name="Press"),)))
    book.on_update(update(step("Press", "running", "Press_0")))
    risks["Press"] = RiskClass.HANDLES
    book.on_catalogue("Bob")
    assert [item.risk for item in (*book.proposals["p1"].steps, *plan_of(book).steps)] == ["moves", "moves"]
    count = len(changes)
    book.on_catalogue("Ada")
    assert [item.risk for item in (*book.proposals["p1"].steps, *plan_of(book).steps)] == [
        "handles_things", "handles_things",
    ]  # fmt: skip
    assert [change.kind for change in changes[count:]] == ["plan", "proposal"]
    book.on_catalogue("Ada")
    assert len(changes) == count + 2, "the same again is no news"


def test_a_rate_grants_a_burst_and_then_an_average() -> None:
    rate = Rate(per_s=2, burst=3)
    assert [rate.take("a", 0.0) for _ in range(4)] == [0, 0, 0, 0.5]
    assert rate.take("b", 0.0) == 0
    assert rate.take("a", 0.5) == 0
    assert rate.take("a", 0.5) > 0


def test_each_failed_attempt_doubles_the_wait_and_a_success_forgives() -> None:
    attempts = Attempts(free=2, longest_s=60)
    waits = []
    for _ in range(8):
        attempts.failed("a", "kim", 0.0)
        waits.append(attempts.wait_s("a", "kim", 0.0))
    assert waits == [0, 2, 4, 8, 16, 32, 60, 60]
    assert attempts.wait_s("b", "kim", 0.0) == 0
    attempts.succeeded("a", "kim")
    assert attempts.wait_s("a", "kim", 0.0) == 0


def test_who_tries_one_account_after_the_other_waits_too() -> None:
    attempts = Attempts(free=2)
    for number in range(8):
        attempts.failed("a", f"account {number}", 0.0)
    assert attempts.wait_s("a", "kim", 0.0) > 0
    assert attempts.wait_s("b", "kim", 0.0) == 0
