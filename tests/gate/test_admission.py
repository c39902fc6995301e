"""An engine asks the rules before each action begins, with the arguments as they are then."""

from __future__ import annotations

from functools import partial

from parley.clock import SimClock
from parley.gate.book import RuleBook
from parley.messages.failure import FailureReport
from parley.messages.principal import person
from parley.messages.rules import Rule, RuleSet
from tests.engine.rig import rigged
from tests.umrf.spec_actions import chain, node, planner_chain


def book(**rule: object) -> RuleBook:
    return RuleBook(SimClock(), RuleSet(rules=(Rule(id="r", **rule),)))


async def test_a_forbidden_action_fails_as_forbidden_and_what_comes_behind_does_not_run() -> None:
    rules = book(kind="action", actions=("JoinText",))
    async with rigged(admit=partial(rules.admit, "A")) as rig:
        rig.start(
            planner_chain("g", [node("NoOp", 0), node("JoinText", 1, left="x", right="y"), node("NoOp", 2)])
        )
        await rig.until_graph("g", "HALTED")
        assert rig.node_states("g", "NoOp_0")[-1] == "FINISHED"
        assert rig.node_states("g", "NoOp_2") == []
        (failed,) = [event for event in rig.events if event.node == "JoinText_1" and event.state == "ERROR"]
        report = FailureReport.parse(failed.message)
        assert (report.code, report.message) == ("forbidden", "A must not do “join text”.")
        assert report.details == {"rule": "r"}


async def test_on_the_account_of_somebody_exempt_it_runs() -> None:
    rules = book(kind="action", actions=("JoinText",), exempt=("supervisor",))
    rules.act_for("A", person("Kim", role="supervisor"))
    async with rigged(admit=partial(rules.admit, "A")) as rig:
        rig.start(chain("g", [node("JoinText", 0, left="x", right="y")]))
        await rig.until_graph("g", "FINISHED")
