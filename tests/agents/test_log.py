"""What a robot's log says of the step at work: how far it is, and nothing of one that is over or gone."""

from __future__ import annotations

from parley.agents.chat.log import Log
from parley.messages.chat import ActionCall
from parley.messages.status import GraphEvent, PlanStep, PlanUpdate


def told(log: Log, node: str, state: str = "", **more: object) -> None:
    kind = "node" if state else "progress"
    event = {"actor": "A", "graph_name": "g", "sequence": 0, "kind": kind, "node": node, "state": state}
    log.on_event(GraphEvent.model_validate({**event, **more}))


def planned(log: Log, *states: tuple[str, str]) -> None:
    steps = tuple(
        PlanStep.model_validate(
            {"action": ActionCall(name="NavigateTo"), "id": node, "node": node, "state": state}
        )
        for node, state in states
    )
    log.on_plan(PlanUpdate(target="A", graph_name="g", state="running", steps=steps), 0, ())


def left(log: Log) -> str:
    return log.state(None, None, 0).left_text


def test_how_far_a_step_is_is_told_while_it_works_and_no_longer() -> None:
    log = Log()
    told(log, "drive", "RUNNING")
    told(log, "drive", progress=0.5, progress_text="3 m left")
    planned(log, ("drive", "running"), ("look", "queued"))
    assert left(log) == "3 m left"
    planned(log, ("drive", "skipped"), ("look", "running"))  # its robot was gone: nothing told how it ended
    assert left(log) == ""


def test_of_steps_that_work_together_the_one_that_goes_on_is_told_of() -> None:
    log = Log()
    told(log, "drive", "RUNNING")
    told(log, "drive", progress=0.5, progress_text="3 m left")
    told(log, "say", "RUNNING")
    told(log, "say", "FINISHED", result="on_true")
    planned(log, ("drive", "running"), ("say", "finished"))
    assert left(log) == "3 m left"


def test_a_step_that_is_done_once_more_begins_anew() -> None:
    log = Log()
    told(log, "drive", "RUNNING")
    told(log, "drive", progress=0.9, progress_text="1 m left")
    told(log, "drive", "ERROR", result="on_error")
    told(log, "drive", "RUNNING")
    planned(log, ("drive", "running"))
    assert left(log) == ""
    told(log, "drive", progress=0.1, progress_text="9 m left")
    assert left(log) == "9 m left"


def test_what_is_dropped_while_it_works_is_one_deed_that_was_given_up() -> None:
    log = Log()
    planned(log, ("drive", "running"))
    stopped = PlanStep(action=ActionCall(name="NavigateTo"), id="drive", node="drive", state="stopped")
    log.on_plan(PlanUpdate(target="A", state="idle", steps=(stopped,)), 1, ())  # of no graph any more
    assert [deed.ending for deed in log.state(None, None, 2).deeds] == ["stopped"]
