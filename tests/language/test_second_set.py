"""The second set: its developed half is understood; run as a program it prints figures of both halves."""

from __future__ import annotations

import asyncio
import math
import statistics
import sys
import time
from collections import Counter

from parley.language.base import ErrorSituation
from parley.language.offline import OfflineLanguage
from parley.messages.chat import ChatAction
from tests.language.second_set import Case, cases, wrong

RIGHT = 0.97
"""The share of the developed half that must be right."""


async def answer(case: Case) -> ChatAction:
    """What the engine makes of a case."""
    situation, engine = case.situation, OfflineLanguage()
    if isinstance(situation, ErrorSituation):
        return await engine.resolve(situation)
    return await engine.interpret(situation)


async def test_the_second_set_is_understood_but_for_a_few_sentences() -> None:
    developed = [case for case in cases() if not case.held_out]
    failed = [case.id for case in developed if wrong(case, case.situation, await answer(case))]
    assert len(failed) <= len(developed) * (1 - RIGHT), failed


def interval(right: int, count: int) -> tuple[float, float]:
    """The 95 % Wilson interval of a proportion."""
    z, share = 1.96, right / count
    middle = share + z * z / (2 * count)
    spread = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    scale = 1 + z * z / count
    return (middle - spread) / scale, (middle + spread) / scale


def report() -> str:
    """What went wrong in the development half, and the figures of both halves."""
    right: Counter[tuple[bool, str]] = Counter()
    count: Counter[tuple[bool, str]] = Counter()
    lines: list[str] = []
    took_s: list[float] = []
    for case in cases():
        situation, start_s = case.situation, time.perf_counter()
        action = asyncio.run(answer(case))
        took_s.append(time.perf_counter() - start_s)
        problems = wrong(case, situation, action)
        key = (case.held_out, case.phenomenon)
        count[key] += 1
        right[key] += not problems
        if problems and not case.held_out:
            lines += [case.id, *(f"    {problem}" for problem in problems)]
    for half, name in ((False, "development"), (True, "held out")):
        lines += [f"{right[k]:3d} of {count[k]:3d}  {name}: {k[1]}" for k in count if k[0] is half]
        good, all_ = (sum(v for k, v in c.items() if k[0] is half) for c in (right, count))
        low, high = interval(good, all_)
        lines.append(f"{good:3d} of {all_:3d}  {name}: {good / all_:.3f} [{low:.3f}, {high:.3f}]")
    lines.append(f"p50 {1000 * statistics.median(took_s):.1f} ms, slowest {1000 * max(took_s):.1f} ms")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.stdout.write(report() + "\n")
