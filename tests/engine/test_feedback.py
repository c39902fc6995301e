"""The feedback topic: at once after a quiet time, then coalesced, the last state always."""

from __future__ import annotations

import asyncio
import json
import weakref

import pytest

from parley.clock import WallClock
from parley.engine import feedback as feedback_room
from parley.engine.feedback import Feedback
from parley.messages.ros import UmrfGraphFeedback
from parley.umrf.io import write_graph
from tests.umrf.spec_actions import chain, node
from tests.umrf.watched import Watched, until


async def settle() -> None:
    for _ in range(5):
        await asyncio.sleep(0)


@pytest.mark.spec("12.2-better", "D16", "D18", "17")
async def test_changes_within_the_interval_are_sent_as_one_and_the_last_at_the_close() -> None:
    sent: list[UmrfGraphFeedback] = []
    feedback = Feedback("A", WallClock(), sent.append, interval_s=3600)
    watched = Watched(chain("g", [node("WaitFor", 0, seconds=60)]))
    feedback.changed(watched.run)
    feedback.changed(watched.run)
    await settle()
    assert [json.loads(item.history[0])["graph_state"] for item in sent] == ["INITIALIZED"]
    watched.run.start()
    feedback.changed(watched.run)
    watched.run.pause()
    feedback.changed(watched.run)
    await settle()
    assert len(sent) == 1, "the interval is not over"
    feedback.close()
    assert [json.loads(item.history[0])["graph_state"] for item in sent] == ["INITIALIZED", "PAUSED"]
    feedback.close()
    assert len(sent) == 2
    await watched.run.close()


@pytest.mark.spec("W4", "12.5")
async def test_graphs_do_not_wait_for_each_other() -> None:
    sent: list[UmrfGraphFeedback] = []
    feedback = Feedback("A", WallClock(), sent.append, interval_s=3600)
    for name in ("g", "h"):
        feedback.changed(Watched(chain(name, [node("NoOp")])).run)
    await until(lambda: len(sent) == 2)
    assert [json.loads(item.history[0])["graph_name"] for item in sent] == ["g", "h"]
    feedback.close()


@pytest.mark.spec("D18")
async def test_a_large_graph_is_written_in_slices_between_which_the_loop_is_free() -> None:
    sent: list[UmrfGraphFeedback] = []
    feedback = Feedback("A", WallClock(), sent.append, interval_s=3600)
    watched = Watched(chain("g", [node("NoOp", index) for index in range(500)]))
    feedback.changed(watched.run)
    turns = 0
    while not sent:
        await asyncio.sleep(0)
        turns += 1
    assert turns >= 5
    assert sent[0].history == (write_graph(watched.run.snapshot()),)
    feedback.close()


class SlowClock(WallClock):
    """Everything takes seconds, as it seems."""

    def __init__(self) -> None:
        self.asked = 0

    def wall_s(self) -> float:
        self.asked += 1
        return super().wall_s() + 5 * self.asked


async def test_a_long_queue_is_worked_off_without_rests(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(feedback_room, "_MANY", 20)
    sent: list[UmrfGraphFeedback] = []
    feedback = Feedback("A", SlowClock(), sent.append)
    for index in range(50):
        feedback.changed(Watched(chain(f"g{index}", [node("NoOp")])).run)
    await until(lambda: len(sent) >= 30)
    feedback.close()
    assert len(sent) == 50


async def test_a_crowd_is_not_written_one_by_one_while_others_keep_the_loop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(feedback_room, "_MANY", 20)
    sent: list[UmrfGraphFeedback] = []
    feedback = Feedback("A", WallClock(), sent.append)
    for index in range(120):
        feedback.changed(Watched(chain(f"g{index}", [node("NoOp")])).run)
    turns = 0
    while len(sent) < 100:
        await asyncio.sleep(0)
        turns += 1
    assert turns < 90
    feedback.close()


async def test_a_graph_that_is_over_is_let_go_of_once_it_was_told() -> None:
    sent: list[UmrfGraphFeedback] = []
    feedback = Feedback("A", WallClock(), sent.append)
    watched = Watched(chain("g", [node("NoOp")]))
    watched.run.start()
    await watched.run.wait()
    feedback.changed(watched.run)
    await until(lambda: sent)
    left = weakref.ref(watched.run)
    del watched
    assert left() is None
    feedback.close()
