"""What a run leaves behind: nothing, once its engine has forgotten it."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator
from pathlib import Path

import pytest

from parley.clock import WallClock
from parley.engine import runs
from parley.engine.journal import Journal
from parley.transport.local import LocalTransport
from parley.umrf.executor import GraphRun
from tests.umrf.spec_actions import CATALOGUE, chain, node

from .rig import Rig, engine_of


@pytest.fixture
def without_collector() -> Iterator[None]:
    """Circles would be found by looking at everything now and then, while the robot waits."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("without_collector")
@pytest.mark.parametrize(
    "step",
    [
        node("NoOp", 0),
        node("InThread", 0, text="a"),
        node("Fail", 0, reason="door"),
        node("Crash", 0),
        node("Leave", 0),
        node("RaiseError", 0, text="a"),
    ],
    ids=lambda step: str(step["name"]),
)
async def test_a_run_is_gone_as_soon_as_it_is_forgotten(step: dict[str, object], tmp_path: Path) -> None:
    async with (
        await Journal.open(tmp_path / "journal.db", WallClock()) as journal,
        LocalTransport() as transport,
    ):
        rig = Rig(transport, None)
        await rig.listen()
        async with engine_of("A", rig, catalogue=CATALOGUE, journal=journal) as engine:
            rig.start(chain("g", [step, node("NoOp", 1)]))
            await rig.until(lambda: rig.last_feedback("g")["graph_state"] in ("FINISHED", "HALTED"))
            await journal.flush()
            (run,) = engine.runs.all
            left: weakref.ref[GraphRun] = weakref.ref(run)
            del run
            engine.runs.clear()
            assert left() is None


async def test_fewer_ended_graphs_are_kept_if_they_are_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "KEPT_NODES", 10)
    async with LocalTransport() as transport:
        rig = Rig(transport, None)
        await rig.listen()
        async with engine_of("A", rig, catalogue=CATALOGUE) as engine:
            for index, length in enumerate((1, 1, 4, 4, 20, 1)):
                rig.start(chain(f"g{index}", [node("NoOp", number) for number in range(length)]))
                await rig.until_graph(f"g{index}", "FINISHED")
                if index == 3:
                    assert [run.name for run in engine.runs.all] == ["g0", "g1", "g2", "g3"]
            assert [run.name for run in engine.runs.all] == ["g4", "g5"], "the newest is always kept"
