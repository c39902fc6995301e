"""kill -9 at random moments of the story: every acknowledged memory is there afterwards."""

from __future__ import annotations

import itertools
import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from parley.clock import WallClock
from parley.memory.store import MemoryStore

STORY = """
robot: David
steps:
  - {say: John is on the sofa., reply: [remember]}
  - {say: There is a water bottle in the fridge., reply: [remember]}
  - {say: Mary is in the bedroom., reply: [remember]}
  - {say: go to the dining table}
  - {say: The keys are on the bookshelf., reply: [remember]}
  - {say: Peter is at the dining table., reply: [remember]}
  - {finished: {}}
"""


def _until_killed(story: Path, data: Path, moment: float) -> list[dict[str, Any]]:
    """Run the script, kill it after a share of what it has to say, and return what it said until then."""
    command = [
        sys.executable, "-m", "parley", "demo", "nursing-home", "--script", str(story), "--json",
        "--data", str(data),
    ]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    events: list[dict[str, Any]] = []
    heard = 0
    for line in process.stdout:
        events.append(json.loads(line))
        heard += events[-1]["event"] == "said"
        if heard > moment:
            time.sleep(moment % 1 / 20)
            process.send_signal(signal.SIGKILL)
            break
    rest = process.stdout.read()
    process.stdout.close()
    process.wait(timeout=30)
    complete = [line for line in rest.splitlines(keepends=True) if line.endswith("\n")]
    return events + [json.loads(line) for line in complete]


@pytest.mark.timeout(300)
@pytest.mark.parametrize("kills", [3, pytest.param(20, marks=pytest.mark.soak)])
async def test_acknowledged_memories_survive_kill_9(tmp_path: Path, kills: int) -> None:
    story = tmp_path / "story.yaml"
    story.write_text(STORY, encoding="utf-8")
    rng = random.Random(20250101)
    promised_at_all = 0
    for attempt in range(kills):
        data = tmp_path / f"data-{attempt}"
        events = _until_killed(story, data, rng.uniform(0, 5) if kills > 5 else attempt + rng.uniform(1, 3))
        said = [event for event in events if event["event"] in ("operator", "said")]
        promised = [
            before["text"].rstrip(".").casefold()
            for before, after in itertools.pairwise(said)
            if before["event"] == "operator" and after["event"] == "said" and "remember" in after["text"]
        ]
        promised_at_all += len(promised)
        async with await MemoryStore.open(data / "memory.db", WallClock()) as store:
            kept = [entry.data.rstrip(".").casefold() for entry in await store.all()]
        assert [text for text in promised if text not in kept] == []
    assert promised_at_all > 0
