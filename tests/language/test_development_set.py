"""Every sentence of the development set is understood; run as a program it prints figures."""

from __future__ import annotations

import asyncio
from collections import Counter

import pytest

from parley.language.offline import OfflineLanguage
from tests.language.dev_set import Case, cases, situation, wrong


@pytest.mark.parametrize("case", cases(), ids=lambda case: case.id)
async def test_a_sentence_of_the_development_set_is_understood(case: Case) -> None:
    action = await OfflineLanguage().interpret(situation(case.body["in"], case.body["say"]))
    assert wrong(case, action) == []


def report() -> str:
    """Right and all sentences per phenomenon, and what went wrong."""
    right: Counter[str] = Counter()
    count: Counter[str] = Counter()
    lines: list[str] = []
    for case in cases():
        action = asyncio.run(OfflineLanguage().interpret(situation(case.body["in"], case.body["say"])))
        problems = wrong(case, action)
        count[case.phenomenon] += 1
        right[case.phenomenon] += not problems
        lines += [f"{case.id}", *(f"    {problem}" for problem in problems)] if problems else []
    lines += [f"{right[name]:3d} of {count[name]:3d}  {name}" for name in count]
    return "\n".join([*lines, f"{right.total():3d} of {count.total():3d}  all"])


if __name__ == "__main__":
    import sys

    sys.stdout.write(report() + "\n")
