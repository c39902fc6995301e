"""Figures and reports: shares, intervals, and what of blind sets is shown."""

from __future__ import annotations

import asyncio
import json
from dataclasses import replace

import pytest
from scipy.stats import binomtest

from parley.clock import WallClock
from parley.errors import LanguageError
from parley.evaluation.cases import Case
from parley.evaluation.report import json_report, markdown_report
from parley.evaluation.running import Outcome, evaluate, executable
from parley.evaluation.scores import score, share, wilson
from parley.language.base import DraftHandler, ErrorSituation, Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.chat import ChatAction
from tests.evaluation.rig import answer, call, go, one_case

GO = "{in: depot, say: go to the red box, do: [go box_1]}"


def outcome(right: bool, *, blind: bool = False, latency_s: float = 0.01, phenomenon: str = "a") -> Outcome:
    case = Case(phenomenon, one_case(GO).body, one_case(GO).world, "part", blind)
    return Outcome(case, () if right else ("do: wrong",), latency_s, right)


@pytest.mark.parametrize(("right", "count"), [(0, 5), (5, 5), (1, 9), (221, 402)])
def test_intervals_are_those_of_wilson(right: int, count: int) -> None:
    known = binomtest(right, count).proportion_ci(method="wilson")
    assert wilson(right, count) == pytest.approx((known.low, known.high), abs=1e-6)


def test_nothing_counted_says_nothing() -> None:
    nothing = share([])
    assert (nothing.value, nothing.low, nothing.high) == (None, 0.0, 1.0)


def test_a_score_counts_by_part_and_phenomenon_and_only_plans_as_executable() -> None:
    outcomes = [
        outcome(True),
        outcome(False),
        outcome(True, phenomenon="b"),
        replace(outcome(False, phenomenon="b"), executable=None),
    ]
    figures = score("x", outcomes)
    assert (figures.accuracy.right, figures.accuracy.count) == (2, 4)
    assert {name: s.right for name, s in figures.phenomena.items()} == {"part: a": 1, "part: b": 1}
    assert (figures.executable.right, figures.executable.count) == (2, 3)
    assert figures.p50_ms == pytest.approx(10.0)


def test_blind_cases_that_fail_are_shown_only_if_that_is_asked_for() -> None:
    outcomes = [outcome(False, blind=True), outcome(False)]
    scores = [score("x", outcomes)]
    hidden = json_report("s", scores, [outcomes], reveal=False)["backends"][0]
    shown = json_report("s", scores, [outcomes], reveal=True)["backends"][0]
    assert (len(hidden["failing"]), len(shown["failing"])) == (1, 2)
    assert hidden["accuracy"] == shown["accuracy"]
    text = markdown_report("s", scores, [outcomes[:1]], reveal=False)
    assert "red box" not in text
    assert "red box" in markdown_report("s", scores, [outcomes[:1]], reveal=True)


def test_a_report_shows_engines_side_by_side_and_can_be_written_as_json() -> None:
    mine, other = [outcome(True)], [outcome(False)]
    usage = {"input_tokens": 12, "output_tokens": 3, "cost_usd": 0.25}
    scores = [score("one", mine), score("two", other, usage)]
    text = markdown_report("s", scores, [mine, other], reveal=False)
    assert "| `one` | `two` |" in text
    assert "12 / 3" in text
    assert "0.2500 USD" in text
    assert json.loads(json.dumps(json_report("s", scores, [mine, other], reveal=False)))["set"] == "s"


async def test_an_engine_is_asked_each_case_and_judged_in_order() -> None:
    cases = [one_case(GO), one_case("{in: depot, say: go to the blue box, do: [go box_1]}")]
    first, second = await evaluate(cases, BuiltinLanguage(), WallClock(), at_once=2)
    assert (first.right, first.executable) == (True, True)
    assert not second.right
    assert "box_1" in second.problems[0]


class Failing(BuiltinLanguage):
    """Gives up."""

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        raise LanguageError("the model is away")


async def test_an_engine_that_does_not_answer_is_wrong_and_stops_nothing() -> None:
    outcomes = await evaluate([one_case(GO), one_case(GO)], Failing(), WallClock())
    assert [o.problems for o in outcomes] == [("no answer: the model is away",)] * 2
    assert [o.executable for o in outcomes] == [None, None]


class Counting(BuiltinLanguage):
    """Knows how many questions are open at a time."""

    open = most = 0

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        self.open += 1
        self.most = max(self.most, self.open)
        await asyncio.sleep(0)
        self.open -= 1
        return await super().interpret(situation)


async def test_no_more_questions_are_open_than_allowed() -> None:
    language = Counting()
    await evaluate([one_case(GO)] * 6, language, WallClock(), at_once=2)
    assert language.most == 2


def test_a_plan_counts_as_executable_if_its_graph_would_be_accepted() -> None:
    situation = one_case(GO).situation
    assert executable(situation, answer(*go("red box"))) is True
    assert executable(situation, answer(call("NavigateTo"))) is False
    assert executable(situation, answer(call("Fly"))) is False
    assert executable(situation, answer(says="No.")) is None


def test_trying_a_failed_step_again_as_it_was_is_executable() -> None:
    situation = one_case(
        "{in: depot, failed: [driving], code: blocked, error: the way is blocked, reply: try again}"
    ).situation
    assert isinstance(situation, ErrorSituation)
    assert executable(situation, answer(situation.failed_action, success=True)) is True
    assert executable(situation, answer(call("GetCoordinates"), success=True)) is False


async def test_an_evaluation_ends_between_two_cases_of_an_engine_that_never_waits() -> None:
    asked: list[str] = []

    class Busy(BuiltinLanguage):
        async def interpret(
            self, situation: Situation, *, on_draft: DraftHandler | None = None
        ) -> ChatAction:
            asked.append(situation.message)
            running.cancel()  # as Ctrl-C does
            return answer()

    running = asyncio.create_task(evaluate([one_case(GO)] * 50, Busy(), WallClock()))
    with pytest.raises(asyncio.CancelledError):
        await running
    assert len(asked) == 1
