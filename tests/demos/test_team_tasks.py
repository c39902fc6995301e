"""Tasks for a team, judged by the state of the hall at the end: a few of them, and all in the long tests."""

from __future__ import annotations

from collections import Counter

import pytest

from parley.bench.team import TeamTask, load_tasks, try_task
from parley.demos.catalogue import load_demo

TASKS = load_tasks("fleet")
SHORT = ("Have Leo look at Area B.", "Spot opens the way to the pump, the others follow when it is there.")


def test_there_are_tasks_of_each_kind() -> None:
    assert Counter(task.kind for task in TASKS) == dict.fromkeys(
        ("elemental", "simple", "compound", "complex"), 9
    )


@pytest.mark.parametrize("task", [task for task in TASKS if task.name in SHORT], ids=lambda task: task.kind)
async def test_a_task_is_done(task: TeamTask) -> None:
    assert await try_task(load_demo("fleet"), task) == ("right", "")


async def test_what_has_not_ended_in_time_is_not_called_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("parley.bench.team._END_S", 0.01)
    task = next(task for task in TASKS if task.name == SHORT[0])
    assert (await try_task(load_demo("fleet"), task))[0] == "unfinished"


@pytest.mark.soak
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("seed", [1, 2])
async def test_hardly_a_task_is_not_done_and_none_is_done_wrongly(seed: int) -> None:
    found = {task.name: await try_task(load_demo("fleet"), task, seed=seed) for task in TASKS}
    verdicts = Counter(verdict for verdict, _ in found.values())
    assert [name for name, (verdict, _) in found.items() if verdict in ("wrong", "unfinished")] == []
    assert verdicts["right"] >= 34, found
