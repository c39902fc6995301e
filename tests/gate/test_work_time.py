"""How long a robot worked: what stands or waits for people does not count, what runs at once counts once."""

from __future__ import annotations

from parley.gate.work_time import WorkTime
from parley.messages.chat import ActionCall
from parley.messages.status import GraphEvent, PlanStep


def worked_ms(*events: tuple[int, str, str], asks: str = "", told_behind: int = 0, until_ms: int = 0) -> int:
    """Of transitions at moments; after `told_behind` of them the planner says that `asks` waits."""
    work = WorkTime()
    for number, (at_ms, node, state) in enumerate(events, 1):
        work.on_node(
            GraphEvent(actor="Ada", graph_name="g", sequence=number, kind="node", node=node, state=state,
                       unix_ms=at_ms)
        )  # fmt: skip
        if asks and number == told_behind:
            work.on_steps((PlanStep(action=ActionCall(name="AskOperator"), node=asks, state="waiting"),))
    return work.worked_ms(until_ms)


def test_steps_one_after_the_other_add_up_without_what_lies_between_them() -> None:
    events = ((100, "a", "RUNNING"), (200, "a", "FINISHED"), (900, "b", "RUNNING"), (950, "b", "ERROR"))
    assert worked_ms(*events, until_ms=2000) == 150


def test_steps_at_once_count_once() -> None:
    events = ((0, "a", "RUNNING"), (20, "b", "RUNNING"), (50, "b", "FINISHED"), (100, "a", "FINISHED"))
    assert worked_ms(*events) == 100


def test_standing_still_does_not_count_and_being_about_to_does() -> None:
    events = (
        (0, "a", "RUNNING"),
        (10, "a", "PAUSE_REQUESTED"),
        (15, "a", "PAUSED"),
        (100, "a", "RUNNING"),
        (110, "a", "STOPPING"),
        (120, "a", "FINISHED"),
    )
    assert worked_ms(*events) == 35


def test_what_still_works_counts_up_to_the_end() -> None:
    assert worked_ms((100, "a", "RUNNING"), until_ms=180) == 80


def test_waiting_for_an_answer_does_not_count_whenever_the_planner_says_so() -> None:
    asks = ((60, "ask", "RUNNING"), (900, "ask", "FINISHED"))
    assert worked_ms((0, "a", "RUNNING"), (60, "a", "FINISHED"), *asks, asks="ask", told_behind=3) == 60
    assert worked_ms((0, "a", "RUNNING"), (60, "a", "FINISHED"), *asks, asks="ask", told_behind=1) == 60
    beside = ((0, "a", "RUNNING"), *asks[:1], (80, "a", "FINISHED"), *asks[1:])
    assert worked_ms(*beside, asks="ask", told_behind=2) == 80


def test_a_step_that_asks_again_counts_no_more_the_second_time() -> None:
    events = ((0, "ask", "RUNNING"), (50, "ask", "FINISHED"), (60, "ask", "RUNNING"), (90, "ask", "FINISHED"))
    assert worked_ms(*events, asks="ask", told_behind=1, until_ms=100) == 0
