"""The executor does what the contract says: compared with an executable model of it, over random graphs.

`random_runs.jsonl` holds cases and what the model told of them. `python -m tests.umrf.test_random_runs`
records it anew, which is right only after the contract, and with it the model, has changed.
"""

from __future__ import annotations

import itertools
import json
import logging
import os
import random
import time
from pathlib import Path
from typing import Any

import pytest
import structlog

from .contract_model import Script, Told
from .random_cases import Case, played, random_case

RECORDED = Path(__file__).with_name("random_runs.jsonl")
SOAK_S = float(os.environ.get("PARLEY_SOAK_S", "600")) / 10


@pytest.fixture(autouse=True)
def _no_log() -> None:
    """Hundreds of actions fail, and telling why takes longer than all the rest."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))


def recorded() -> list[tuple[Case, list[tuple[str, Told]]]]:
    lines = RECORDED.read_text(encoding="utf-8").splitlines()
    return [(Case(*case), [(name, told) for name, told in runs]) for *case, runs in map(json.loads, lines)]


@pytest.mark.spec("D2", "D14", "D25", "D26", "D28", "10.4", "10.5-better", "12.2-better", "17")
def test_the_executor_does_what_was_recorded() -> None:
    wrong = {}
    for line, (case, told) in enumerate(recorded(), 1):
        if (found := played(case)) != told:
            wrong[line] = {"found": found, "recorded": told}
    assert not wrong


def test_the_contract_says_what_was_recorded() -> None:
    cases = recorded()
    assert len(cases) >= 200
    assert [line for line, (case, told) in enumerate(cases, 1) if case.told != told] == []


@pytest.mark.soak
def test_the_executor_does_what_the_contract_says_of_new_graphs() -> None:
    end_s, count = time.monotonic() + SOAK_S, 0
    while time.monotonic() < end_s:
        seed = random.SystemRandom().getrandbits(48)
        case = random_case(seed)
        assert played(case) == case.told, f"random_case({seed})"
        count += 1
    print(f"{count} random graphs ended as the contract says")  # noqa: T201 - for whoever runs the soak


def monitor(said: str) -> Case:
    """What it set off takes a while to stop; meanwhile another action tells it something."""
    graph = {
        "nodes": ["Do*", "Do", "Do"],
        "edges": [[0, 1, 0, "r--i"], [2, 0, 0, said]],
        "entry": [0, 1, 2],
        "exit": [],
    }
    scripts: dict[str, Script] = {
        "g/Do_0": [(100, "t", 50), (300, "n", 50)],
        "g/Do_1": [(5000, "t", 400), (5000, "t", 50)],
        "g/Do_2": [(200, "t", 50)],
    }
    return Case({"g": graph}, scripts, [[2000, "resume"], [9000, "stop"]])


def left_behind(orders: list[list[Any]], ticks: int) -> Case:
    """A graph inside ends, but one of its actions goes on."""
    outer = {"nodes": ["Inner"], "edges": [], "entry": [0], "exit": []}
    inner = {"nodes": ["Do", "Do"], "edges": [], "entry": [0, 1], "exit": [[0, 1, "----"]]}
    scripts: dict[str, Script] = {
        "g__Inner__0/Do_0": [(100, "t", 50)],
        "g__Inner__0/Do_1": [(ticks, "t", 200), (400, "t", 50)],
    }
    return Case({"g": outer, "Inner": inner}, scripts, orders)


JOIN = {
    "nodes": ["Do", "Do", "Do"],
    "edges": [[0, 2, 1, "----"], [1, 2, 1, "----"]],
    "entry": [0, 1],
    "exit": [[2, 1, "----"]],
}
NAMED: dict[str, tuple[Case, list[tuple[str, Told]]]] = {
    "a restart that a pause comes upon is made after it": (
        Case(
            {"g": {"nodes": ["Do", "Do"], "edges": [[0, 1, 0, "R---"]], "entry": [0, 1], "exit": []}},
            {"g/Do_0": [(100, "t", 50)], "g/Do_1": [(1000, "t", 200)]},
            [[150, "pause"], [400, "resume"], [9000, "stop"]],
        ),
        [("g", {"": "RPRHhSTs", "Do_0": "RFt", "Do_1": "RSFsRFt"})],
    ),
    "what a stopped action leads to comes before the round that stopped it goes on": (
        Case(
            {
                "g": {
                    "nodes": ["Do*", "Do"],
                    "edges": [[0, 1, 0, "r---"]],
                    "entry": [0, 1],
                    "exit": [[1, 1, "--r-"]],
                }
            },
            {"g/Do_0": [(100, "t", 50)], "g/Do_1": [(1000, "t", 200)]},
            [[9000, "stop"]],
        ),
        [("g", {"": "RFs", "Do_0": "RFt", "Do_1": "RSFs"})],
    ),
    "a monitor obeys a stop between two rounds": (
        monitor("s---"),
        [("g", {"": "RHhSTs", "Do_0": "RFt", "Do_1": "RSFs", "Do_2": "RFt"})],
    ),
    "a monitor obeys a pause between two rounds": (
        monitor("p---"),
        [("g", {"": "RPRHhSTs", "Do_0": "RFtREe", "Do_1": "RSFsRSFs", "Do_2": "RFt"})],
    ),
    "a pause while the reaction still stops holds the next round": (
        Case(
            {"g": {"nodes": ["Do*", "Do"], "edges": [[0, 1, 0, "r--i"]], "entry": [0, 1], "exit": []}},
            {"g/Do_0": [(100, "t", 50), (300, "n", 50)], "g/Do_1": [(5000, "t", 400), (5000, "t", 60)]},
            [[200, "pause"], [2000, "resume"], [2100, "stop"]],
        ),
        [("g", {"": "RPRSTs", "Do_0": "RFtRSFs", "Do_1": "RSFsRSFs"})],
    ),
    "what an edge pauses holds back what follows it": (
        Case(
            {
                "g": {
                    "nodes": ["Do", "Insist", "Do"],
                    "edges": [[0, 1, 0, "p---"], [1, 2, 1, "----"]],
                    "entry": [0, 1],
                    "exit": [[2, 1, "----"]],
                }
            },
            {"g/Do_0": [(100, "t", 50)], "g/Insist_1": [(1000, "t", 50)], "g/Do_2": [(300, "t", 50)]},
            [[2000, "resume"], [9000, "stop"]],
        ),
        [("g", {"": "RPRFt", "Do_0": "RFt", "Insist_1": "RQFt", "Do_2": "RFt"})],
    ),
    "a modify keeps the edges that were seen": (
        Case(
            {"g": JOIN, "g1": JOIN},
            {"g/Do_0": [(100, "t", 50)], "g/Do_1": [(1000, "t", 50)], "g/Do_2": [(300, "t", 50)]},
            [[500, "modify", "g1"], [9000, "stop"]],
        ),
        [("g", {"": "RRFt", "Do_0": "RFt", "Do_1": "RFt", "Do_2": "RFt"})],
    ),
    "a resume reaches what an edge inside paused": (
        Case(
            {
                "g": {"nodes": ["Inner"], "edges": [], "entry": [0], "exit": [[0, 1, "----"]]},
                "Inner": {
                    "nodes": ["Do", "Do"],
                    "edges": [[0, 1, 0, "p---"]],
                    "entry": [0, 1],
                    "exit": [[1, 1, "----"]],
                },
            },
            {"g__Inner__0/Do_0": [(100, "t", 50)], "g__Inner__0/Do_1": [(1000, "t", 200)]},
            [[500, "resume"], [9000, "stop"]],
        ),
        [("g", {"": "RFt", "Inner_0": "RFt"}), ("g__Inner__0", {"": "RFt", "Do_0": "RFt", "Do_1": "RPRFt"})],
    ),
    "a resume reaches what a graph inside left behind": (
        left_behind([[300, "pause"], [600, "resume"], [9000, "stop"]], 900),
        [
            ("g", {"": "RHhSTs", "Inner_0": "RFt"}),
            ("g__Inner__0", {"": "RFt", "Do_0": "RFt", "Do_1": "RPRFt"}),
        ],
    ),
    "what a graph inside left behind is stopped when that graph runs again": (
        left_behind([[2000, "resume", "Inner_0"], [9000, "stop"]], 900_000),
        [
            ("g", {"": "RHhRHhSTs", "Inner_0": "RFtRFt"}),
            ("g__Inner__0", {"": "RFt", "Do_0": "RFt", "Do_1": "R"}),
            ("g__Inner__0", {"": "RFt", "Do_0": "RFt", "Do_1": "RFt"}),
        ],
    ),
}


@pytest.mark.parametrize("name", NAMED)
def test_named(name: str) -> None:
    case, told = NAMED[name]
    assert case.told == told, "the contract"
    assert played(case) == told


if __name__ == "__main__":
    lines: list[str] = []
    for seed in itertools.count():
        case = random_case(seed)
        line = json.dumps([case.graphs, case.scripts, case.orders, case.told], separators=(",", ":"))
        if (
            sum(map(len, case.told[0][1].values())) >= 12 and len(line) <= 1000
        ):  # enough happens, and not too much
            lines.append(line)
        if len(lines) == 250:
            break
    RECORDED.write_text("\n".join(lines) + "\n", encoding="utf-8")
