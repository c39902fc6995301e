"""What is written to the topics by somebody who may not has no effect, under any policy."""

from __future__ import annotations

from typing import Final

import pytest

from parley.config import ApprovalPolicy
from tests.attacks.cases import POLICIES
from tests.attacks.conftest import COUNTS, FOUND
from tests.attacks.effects import Watch, facts
from tests.attacks.hostile_programs import CASES, Intrusion
from tests.attacks.house import ADA, Houses
from tests.attacks.playing import under

PLAYED: Final = [
    pytest.param(
        case, policy, id=f"{case.name}-{policy}", marks=[] if number % 3 == turn else [pytest.mark.soak]
    )
    for number, case in enumerate(CASES)
    for turn, policy in enumerate(POLICIES)
]
"""In the gate each under one policy in turn: who may not, may not under any."""


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize(("case", "policy"), PLAYED)
async def test_who_may_not_brings_nothing_about(
    houses: Houses, case: Intrusion, policy: ApprovalPolicy
) -> None:
    house = await houses.fresh("run_at_once")
    await under(house, case.when, policy)
    shown = next((p for p in house.witness.proposals if p.target == ADA), None)
    watch = await Watch.begin(house)
    case.send(house, shown)
    await house.settled()
    wanted = {"proposed", "paused", *(case.by_policy if policy != "ask_first" else ())}
    found = [effect for effect in await watch.end() if effect.kind not in wanted]
    COUNTS[policy]["intrusions"] += 1
    COUNTS[policy]["of them with effects"] += bool(found)
    if found:
        FOUND[case.name][facts(found)].append(policy)
    assert not found, facts(found)
