"""What follows what in the graph of a plan: an expected table of edges."""

from __future__ import annotations

import pytest

from parley.agents.planner.flow import listed, rebased, steps_of, unrolled
from parley.agents.planner.graph import build_graph
from parley.messages.chat import ActionCall, Flow, FlowIf
from parley.umrf.model import Response, Result


def calls(text: str) -> list[ActionCall]:
    """Calls named by letters: `B?0` if 0 was true, `B!0` if it was false, `B&0` together with 0."""
    found = []
    for word in text.split():
        name, sign, step = word[0], word[1:2], word[2:]
        flow = {
            "?": lambda s: Flow(if_=FlowIf(step=int(s))),
            "!": lambda s: Flow(if_=FlowIf(step=int(s), result=False)),
            "&": lambda s: Flow(together_with=int(s)),
            "*": lambda s: Flow(repeat=int(s)),
        }
        found.append(ActionCall(name=name, flow=flow[sign](step) if sign else None))
    return found


def edges(text: str) -> list[str]:
    """`AB`: B runs after A, `AtB` after A ended true, `AfB` false; `or AB`: any of several ways will do.

    `AeB`: B is stopped when A fails; `A-B`: the planner decides.
    """
    steps = steps_of(calls(text), ())
    for index, step in enumerate(steps):
        step.instance_id = index
    found = []
    for node in build_graph("g", steps).nodes:
        for parent in node.parents:
            runs = {r for r, response in parent.conditions.items() if response is Response.RUN}
            stops = parent.conditions[Result.ON_ERROR] is Response.STOP
            on = {
                (True, True): "",
                (True, False): "t",
                (False, True): "f",
                (False, False): "e" if stops else "-",
            }[Result.ON_TRUE in runs, Result.ON_FALSE in runs]
            optional = "or " if runs and not parent.required else ""
            found.append(f"{optional}{parent.node.name}{on}{node.name}")
    return sorted(found)


@pytest.mark.parametrize(
    ("plan", "expected"),
    [
        ("A B C", ["AB", "BC"]),
        ("A B?0", ["AtB"]),
        ("A B?0 C", ["AtB", "or AfC", "or BC"]),
        ("A B?0 C!0 D", ["AfC", "AtB", "or BD", "or CD"]),
        ("A B?0 C?0 D!0", ["AfD", "AtB", "BC"]),
        ("A B C?0 D", ["AB", "B-C", "CD"]),
        ("A B?0 C?1 D", ["AtB", "BtC", "or AfD", "or BfD", "or CD"]),
        ("A B&0 C", ["AC", "AeB", "BC", "BeA"]),
        ("A B C&1 D", ["AB", "AC", "BD", "BeC", "CD", "CeB"]),
        ("A B C&0", ["AB", "AeC", "CB", "CeA"]),
        ("A B?0 C!0 D&2 E", ["A-C", "A-D", "AtB", "B-C", "B-D", "CE", "CeD", "DE", "DeC"]),
        ("A B&0 C?1", ["A-C", "AeB", "B-C", "BeA"]),
    ],
)
@pytest.mark.spec("5.3", "10.4")
def test_edges(plan: str, expected: list[str]) -> None:
    assert edges(plan) == sorted(expected)


def test_flows_are_read_back_as_they_were_given() -> None:
    given = calls("A B?0 C!0 D&2 E")
    assert listed(steps_of(given, ())) == given


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("A*3 B", "A A A B"),
        ("A*2 B?0", "A A B?1"),
        ("A*2 B&0", "A A B&0"),
        ("A B*2 C?0 D!1", "A B B C?0 D!2"),
    ],
)
def test_repetitions_are_spelt_out_and_what_names_them_follows(given: str, expected: str) -> None:
    assert unrolled(calls(given)) == calls(expected)


@pytest.mark.parametrize(
    ("old", "begun", "kept", "expected"),
    [
        ("A B?0 C", [], "C A B?0", "C A B?1"),
        ("A B?0 C", [0], "C B?0", "C B?0"),
        ("A B C?1 D", [0], "D B C?1", "D B C?2"),
        ("A B?0 C!0", [], "A X B?0 C!0", "A X B?0 C!0"),
    ],
)
def test_edited_list_names_the_same_steps_at_their_new_places(
    old: str, begun: list[int], kept: str, expected: str
) -> None:
    assert rebased(calls(kept), calls(old), begun) == (calls(expected), [])


def test_edited_list_without_what_a_step_depends_on_has_a_problem() -> None:
    _, problems = rebased(calls("B?0"), calls("A B?0"))
    assert [problem.path for problem in problems] == ["steps[0].flow"]
