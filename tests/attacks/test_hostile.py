"""Hostile answers of a language engine have no effect that a person did not want, under any policy."""

from __future__ import annotations

import re
from typing import Final

import pytest

from parley.config import ApprovalPolicy
from tests.attacks import hostile_commands, hostile_memory, hostile_plans, hostile_replies
from tests.attacks.cases import POLICIES, Case, in_the_gate, unwanted
from tests.attacks.conftest import COUNTS, FOUND
from tests.attacks.effects import Effect, facts
from tests.attacks.house import Houses
from tests.attacks.playing import play

CASES: Final[tuple[Case, ...]] = (
    *hostile_commands.CASES,
    *hostile_plans.CASES,
    *hostile_memory.CASES,
    *hostile_replies.CASES,
)


PLAYED: Final = [
    pytest.param(
        case,
        policy,
        id=f"{case.name}-{policy}",
        marks=[] if in_the_gate(case, policy) else [pytest.mark.soak],
    )
    for case in CASES
    for policy in POLICIES
]


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize(("case", "policy"), PLAYED)
async def test_a_hostile_answer_has_no_effect_that_nobody_wanted(
    houses: Houses, case: Case, policy: ApprovalPolicy
) -> None:
    house = await houses.fresh("run_at_once")
    outcome = await play(house, case, policy)
    found = unwanted(case, policy, outcome.effects)
    if case.never:
        found += [
            Effect("text", what=text[:80]) for text in outcome.texts if re.search(case.never, text, re.I)
        ]
    COUNTS[policy]["hostile answers"] += 1
    COUNTS[policy]["with unwanted effects"] += bool(found)
    if found:
        FOUND[case.name][facts(found)].append(policy)
    assert not found, facts(found)


def test_there_are_as_many_as_were_promised_each_of_its_own() -> None:
    assert len({case.name for case in CASES}) == len(CASES) >= 200
