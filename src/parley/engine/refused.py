"""What was refused, told to a planner that reads nothing but feedback (`spec/umrf.md` 12.6)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from parley.errors import Problem
from parley.umrf.model import Graph, GraphState, LogMessage, NodeState

__all__ = ["as_feedback"]

_AT: Final = re.compile(r"actions\[(\d+)\]")


def as_feedback(sent: Graph, held: Graph | None, problems: Sequence[Problem], unix_ms: int) -> Graph | None:
    """The graph as such a planner understands that it was refused: the step at fault failed, and says why.

    Args:
        sent: What was refused.
        held: The graph of that name that goes on as it did: it is told as it stands, with that step besides.
        problems: Why.
        unix_ms: Now.

    Returns:
        None: no step but those that go on was sent.
    """
    known = {node.full_name for node in held.nodes} if held else set()
    news = [index for index, node in enumerate(sent.nodes) if node.full_name not in known]
    if not news or not problems:
        return None
    named = ((problem, _AT.match(problem.path)) for problem in problems)
    at_fault = ((problem, int(at[1])) for problem, at in named if at and int(at[1]) in news)
    problem, index = next(at_fault, (problems[0], news[0]))
    why = LogMessage(unix_ms, "; ".join(filter(None, (problem.message, problem.remedy))))
    failed = sent.nodes[index]._replace(state=NodeState.ERROR, messages=(why,))
    if held is not None:
        return replace(held, nodes=(*held.nodes, failed))
    nodes = (*sent.nodes[:index], failed, *sent.nodes[index + 1 :])
    return replace(sent, nodes=nodes, state=GraphState.ERROR)
