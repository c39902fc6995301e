"""How a plan looks."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.messages.chat import ActionCall
from parley.messages.status import PlanStep, PlanUpdate
from parley.terminal.plan import Progress, bar, call_in_words, compare, lines_of, plan_rows, step_row
from tests.terminal.robots import call, plan, step


def flat(rows: list[list[tuple[str, str]]]) -> list[str]:
    return ["".join(text for _, text in row) for row in rows]


@pytest.mark.parametrize(
    ("action", "words"),
    [
        (call("NavigateTo", "what a model says of it"), "navigate to"),
        (call("GetCoordinates", target="box"), "get coordinates: box"),
        (call("pick_up"), "pick up"),
        (call("Inspect", inspect="door"), "inspect: door"),
    ],
)
def test_what_nothing_was_written_of_reads_as_the_words_of_its_action(action: ActionCall, words: str) -> None:
    assert call_in_words(action) == words


def test_a_step_reads_as_code_wrote_it_whatever_a_model_says_of_it() -> None:
    told = PlanStep(action=call("NavigateTo", "bring the tea"), label="Go to “box”")
    assert step_row(told, "en") == "○ Go to “box”"


def test_a_step_shows_its_number_icon_and_state_in_words() -> None:
    assert step_row(step("ask", "waiting"), "en", number=1) == "? 1. ask (waiting for you)"
    assert step_row(step("open the box", "finished"), "en", number=2) == "✓ open the box (done)"


def test_a_running_step_shows_how_far_it_is() -> None:
    running = step("drive", "running", node="n_0")
    shown = flat(plan_rows([running], "en", Progress("n_0", 0.5, "1.2 m")))
    assert shown == [" ▶ drive  ████████░░░░░░░░ 50 %  1.2 m"]


def test_progress_of_another_step_is_not_shown() -> None:
    running = step("drive", "running", node="n_0")
    assert flat(plan_rows([running], "en", Progress("n_1", 0.5, "1.2 m"))) == [" ▶ drive  now"]


@given(st.floats(-1, 2), st.integers(1, 40))
def test_a_bar_always_has_its_width(fraction: float, width: int) -> None:
    drawn, _, percent = bar(fraction, width).partition(" ")
    assert len(drawn) == width
    assert 0 <= int(percent.split()[0]) <= 100


@given(st.integers(0, 30), st.integers(0, 30))
def test_the_step_that_runs_is_always_among_the_shown_rows(total: int, over: int) -> None:
    over = min(over, total)
    steps = [step(f"s{i}", "finished" if i < over else "queued") for i in range(total)]
    rows = flat(plan_rows(steps, "en", max_rows=6))
    assert len(rows) <= 7
    if over < total:
        assert any(f" s{over} " in row for row in rows)


def test_rows_that_do_not_fit_are_counted() -> None:
    rows = flat(plan_rows([step(f"s{i}") for i in range(9)], "en", max_rows=6))
    assert rows[-1].strip() == "and 3 more"


def test_a_plan_that_only_became_shorter_is_not_new() -> None:
    before = plan(step("a", "finished"), step("b"), step("c"))
    assert compare(before, plan(step("b"), step("c"))) == (False, [])


@pytest.mark.parametrize(
    "after", [plan(step("a"), step("x")), plan(step("a"), step("b"), step("c")), plan(step("a"), graph="g2")]
)
def test_other_steps_or_another_run_are_a_new_plan(after: PlanUpdate) -> None:
    is_new, _ = compare(plan(step("a"), step("b")), after)
    assert is_new


def test_steps_that_ended_meanwhile_are_reported_once() -> None:
    first = plan(step("a", "running", "a_0"), step("b", "queued", "b_0"))
    second = plan(step("a", "finished", "a_0"), step("b", "running", "b_0"))
    _, ended = compare(first, second)
    assert [step.label for step in ended] == ["a"]
    assert compare(second, second) == (False, [])


def test_a_step_that_was_known_before_its_node_existed_is_recognised() -> None:
    _, ended = compare(plan(step("a", "running")), plan(step("a", "finished", "a_0")))
    assert [step.node for step in ended] == ["a_0"]


def test_of_what_is_cancelled_only_the_step_that_had_begun_is_reported() -> None:
    before = plan(step("a", "running", "a_0"), step("b", "queued", "b_0"))
    _, ended = compare(before, plan(step("a", "stopped", "a_0"), step("b", "stopped", "b_0"), state="idle"))
    assert [step.label for step in ended] == ["a"]


def test_a_search_for_the_next_step_is_shown_as_that_step_and_tells_how_it_fares() -> None:
    def shown(*states: str) -> list[str]:
        one, two = (step("find", state).model_copy(update={"for_next": True}) for state in states)
        return [f"{line.label} {line.state}" for line in lines_of([one, step("go"), two, step("look")])]

    assert shown("running", "queued") == ["go running", "look queued"]
    assert shown("finished", "failed") == ["go queued", "look failed"]


def test_what_could_not_be_found_is_reported_as_the_step_that_needs_it() -> None:
    def found(state: str) -> PlanUpdate:
        return plan(step("find", state).model_copy(update={"for_next": True}), step("go"))

    assert [row.label for row in compare(found("running"), found("failed"))[1]] == ["go"]
    assert compare(found("queued"), found("finished")) == (False, [])
