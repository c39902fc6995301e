"""The measurements measure what they say; how fast it is, is no test."""

from __future__ import annotations

import pytest

from parley.bench.control import COMMANDS, measure_control, measure_crowd
from parley.bench.engine import chain, fan_out, run_graphs, run_journaled, share


@pytest.mark.parametrize("threaded", [False, True])
async def test_every_event_of_every_graph_is_seen_once(threaded: bool) -> None:
    figures = await run_graphs([chain("a", 5), fan_out("b", 4)], threaded=threaded)
    assert (figures.actions, figures.gaps) == (11, 0)
    assert figures.cpu_us_per_action > 0
    assert figures.events == 2 * 11 + 2 * 2  # each node runs and finishes, each graph too


@pytest.mark.parametrize("threaded", [False, True])
async def test_every_end_of_an_action_is_timed_on_both_topics(threaded: bool) -> None:
    figures = await run_graphs([chain("a", 6)], threaded=threaded, seconds=0.005, feedback=True)
    assert len(figures.event_ms) == len(figures.feedback_ms) == 6
    assert all(taken_ms >= 0 for taken_ms in (*figures.event_ms, *figures.feedback_ms))


@pytest.mark.parametrize("threaded", [False, True])
async def test_every_command_is_timed(threaded: bool) -> None:
    found = await measure_control(3, threaded=threaded)
    assert {command: len(taken_ms) for command, taken_ms in found.items()} == dict.fromkeys(COMMANDS, 3)
    assert all(ms > 0 for taken_ms in found.values() for ms in taken_ms)


async def test_commands_beside_other_graphs_are_timed() -> None:
    crowd = await measure_crowd(lambda index: [chain(f"g{index}", 20)], 2)
    for taken_ms in (crowd.pause_ms, crowd.stop_ms, crowd.longest_step_ms):
        assert len(taken_ms) == 2
        assert all(ms > 0 for ms in taken_ms)
    for step_ms, collection_ms in zip(crowd.longest_step_ms, crowd.longest_collection_ms, strict=True):
        assert 0 <= collection_ms <= step_ms


async def test_a_journal_makes_no_event_go_missing() -> None:
    figures = await run_journaled(10, threaded=False)
    assert (figures.events, figures.gaps) == (2 * 10 + 2, 0)


def test_a_share_of_values() -> None:
    assert share([5, 1, 3, 2, 4], 0.5) == 3
    assert share([1, 2], 0.99) == 2
