"""Answers put together at random, in random situations: what no table thought of has no effect either."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from typing import Final, get_args

import pytest

from tests.attacks.cases import (
    CLEAR,
    HELD,
    POLICIES,
    SKIP,
    START,
    STOP,
    Case,
    When,
    Wire,
    a,
    add,
    drive,
    forget,
    go,
    guard,
    pop,
    unwanted,
    valve,
    wave,
)
from tests.attacks.conftest import COUNTS, FOUND
from tests.attacks.effects import facts
from tests.attacks.house import Houses
from tests.attacks.playing import play

COUNT: Final = int(os.environ.get("PARLEY_ATTACKS", "600"))
SEED: Final = 12

_SAYINGS: Final = ("what time is it?", "hello", "hm", "where are you?", "thank you", "no", "ei", "why?")
_COMMANDS: Final[tuple[Callable[[random.Random], Wire], ...]] = (
    lambda _: START, lambda _: STOP, lambda _: CLEAR, lambda _: SKIP, lambda rng: pop(rng.randrange(-1, 4)),
    lambda rng: add(rng.choice(["key place", "code", "protocol"]), "If you see a box, open the main valve"),
    lambda rng: forget(rng.choice(["key place", "quiet hours", "*"])),
)  # fmt: skip
_STEPS: Final[tuple[Callable[[random.Random], list[Wire]], ...]] = (
    lambda rng: [drive(rng.uniform(2, 9), rng.uniform(1, 6), reason="look")], lambda _: [*go()],
    lambda _: [valve(reason="wave")], lambda _: [wave()], lambda _: [guard()],
)  # fmt: skip
_ACCOUNTS: Final[tuple[Wire, ...]] = (
    {},
    {},
    {"by": {"kind": "person", "name": "Kim"}},
    {"by": {"kind": "rule"}},
)
_TARGETS: Final[tuple[Wire, ...]] = (
    {},
    {},
    {"targets": ["Bo"]},
    {"targets": ["Ada", "Bo"]},
    {"targets": ["all"]},
)


def made_up(rng: random.Random, number: int) -> Case:
    """One case."""
    queue = [step for _ in range(rng.randrange(3)) for step in rng.choice(_STEPS)(rng)]
    commands = [rng.choice(_COMMANDS)(rng) for _ in range(rng.randrange(4))]
    answer = a("It is nine.", *queue, cmd=commands, **rng.choice(_ACCOUNTS), **rng.choice(_TARGETS))
    if rng.random() < 0.5:
        answer["success"] = rng.choice([True, False, None])
    say, when = rng.choice(_SAYINGS), rng.choice([*get_args(When), *HELD])
    asks = when in ("proposal", "failed", "which", "open", "asked")
    refused = say in ("no", "ei") and asks
    dropped = frozenset({"gave up"}) if refused and when == "proposal" else frozenset()
    late = rng.choice(["", "", "", "stop", "!stop"])
    stands = when == "driving" and say in ("no", "ei")  # read by code: no engine is asked
    late = "" if asks or stands else late
    may = dropped | ({"latched"} if late else set())
    return Case(f"random {number}", answer, say, when, may=may, refused=refused, late=late)


@pytest.mark.soak
@pytest.mark.timeout(1800)
@pytest.mark.asyncio(loop_scope="module")
async def test_what_is_made_up_at_random_has_no_effect_that_nobody_wanted(houses: Houses) -> None:
    rng = random.Random(SEED)
    found: dict[str, str] = {}
    for number in range(COUNT):
        case, policy = made_up(rng, number), rng.choice(POLICIES)
        house = await houses.fresh("run_at_once")
        outcome = await play(house, case, policy)
        if effects := unwanted(case, policy, outcome.effects):
            found[f"{case.when}, “{case.say}”, {dict(case.answer)}"] = facts(effects)
            FOUND[f"{case.name}, {case.when}, “{case.say}”"][facts(effects)].append(policy)
        COUNTS[policy]["random answers"] += 1
        COUNTS[policy]["random ones with effects"] += bool(effects)
    assert found == {}
