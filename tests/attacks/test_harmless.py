"""What honest people and an honest engine say goes on working: at most two are refused or asked about."""

from __future__ import annotations

from typing import Final

import pytest

from parley.config import ApprovalPolicy
from tests.attacks.cases import POLICIES, Case
from tests.attacks.conftest import COUNTS, FOUND
from tests.attacks.effects import Watch
from tests.attacks.harmless import CASES, Fair
from tests.attacks.house import House, Houses
from tests.attacks.playing import converse, under

ALLOWED: Final = 2


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize(
    ("policy", "share"),
    [
        ("ask_first", slice(0, None, 4)),
        ("run_at_once", slice(2, None, 4)),
        *(pytest.param(policy, slice(None), marks=pytest.mark.soak) for policy in POLICIES),
    ],
    ids=str,
)
async def test_what_is_harmless_is_done(houses: Houses, policy: ApprovalPolicy, share: slice) -> None:
    """In the gate every other one is said, under one of two policies; in the soak each under all."""
    assert len(CASES) >= 100
    wrong: dict[str, str] = {}
    for fair in CASES[share]:
        house = await houses.fresh("run_at_once")
        if problem := await _tried(house, fair, policy):
            wrong[f"{fair.when}: {fair.say}"] = problem
    COUNTS[policy]["harmless answers"] += len(CASES[share])
    COUNTS[policy]["refused or asked about"] += len(wrong)
    for name, problem in wrong.items():
        FOUND[f"harmless: {name}"][problem].append(policy)
    assert len(wrong) <= ALLOWED, wrong


async def _tried(house: House, fair: Fair, policy: ApprovalPolicy) -> str:
    """What is wrong with how something harmless went; empty if nothing is."""
    await under(house, fair.when, policy)
    house.deeds.broken = False
    watch = await Watch.begin(house)
    cards = len(house.witness.proposals)
    await converse(house, Case(fair.say, fair.answer, fair.say, fair.when, fair.to))
    await house.settled()
    missing = await _missing(watch, fair)
    asked = False
    for _ in range(2 if missing else 0):
        asked = True
        new = [p for p in house.witness.proposals[cards:] if p.target == fair.to]
        if new and new[-1].id not in {d.id for d in house.witness.decisions}:
            house.decide(new[-1])
        else:
            house.say("yes", fair.to)
        await house.settled()
        missing = await _missing(watch, fair)
        if not missing:
            break
    if missing:
        return f"not done: {missing}"
    if asked and policy not in fair.asks:
        return "asked about"
    if fair.tells and not any(fair.tells.casefold() in text.casefold() for text in watch.texts()):
        return f"not told: {fair.tells}"
    seen = {str(effect) for effect in await watch.end()}
    return ", ".join(f"it came to: {effect}" for effect in fair.never if effect in seen)


async def _missing(watch: Watch, fair: Fair) -> str:
    seen = {str(effect) for effect in await watch.end()}
    return ", ".join(effect for effect in fair.wants if effect not in seen)
