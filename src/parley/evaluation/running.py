"""Putting the cases of a set to a language engine."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass

from parley.agents.planner.check import plan_problems
from parley.clock import Clock
from parley.errors import LanguageError
from parley.evaluation.cases import Case
from parley.evaluation.judge import wrong
from parley.language.base import ErrorSituation, Language, Situation
from parley.messages.chat import ActionCall, ChatAction

__all__ = ["Outcome", "evaluate"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one case."""

    case: Case
    problems: tuple[str, ...]
    """Why the answer is wrong; empty if it is right."""
    latency_s: float
    """Wall time until the answer."""
    executable: bool | None
    """Whether a robot could carry the plan out as it is; None where nothing is planned."""
    acts: bool = False
    """Whether something would be done or changed."""
    engine: str = ""
    """Who answered, where there are several."""

    @property
    def is_wrong_deed(self) -> bool:
        """Whether something wrong would be done."""
        return self.acts and not self.right

    @property
    def right(self) -> bool:
        """Whether the answer is right."""
        return not self.problems


async def evaluate(
    cases: Sequence[Case], language: Language, clock: Clock, *, at_once: int = 1
) -> list[Outcome]:
    """Put every case to an engine; an engine that fails to answer is wrong.

    Args:
        cases: In the order of the outcomes.
        language: The engine.
        clock: For the wall time.
        at_once: How many questions may be open at a time.
    """
    places = asyncio.Semaphore(at_once)

    async def one(case: Case) -> Outcome:
        async with places:
            await asyncio.sleep(0)  # an engine that never waits would hear of no Ctrl-C before the last case
            return await _evaluate(case, language, clock)

    async with asyncio.TaskGroup() as group:
        tasks = [group.create_task(one(case)) for case in cases]
    return [task.result() for task in tasks]


async def _evaluate(case: Case, language: Language, clock: Clock) -> Outcome:
    situation = case.situation
    start_s = clock.wall_s()
    try:
        if isinstance(situation, ErrorSituation):
            action = await language.resolve(situation)
        else:
            action = await language.interpret(situation)
    except LanguageError as error:
        return Outcome(case, (f"no answer: {error}",), clock.wall_s() - start_s, None)
    latency_s = clock.wall_s() - start_s
    problems, acts = tuple(wrong(case, situation, action)), bool(action.queue or action.system_cmd)
    plain = executable(situation, action)
    return Outcome(case, problems, latency_s, plain, acts, action.engine)


def executable(situation: Situation | ErrorSituation, action: ChatAction) -> bool | None:
    """Whether the graph of a plan would be accepted; None where nothing is planned.

    Args:
        situation: What was answered.
        action: The answer.
    """
    if not action.queue:
        return None
    calls, before = list(action.queue), list[ActionCall]()
    if isinstance(situation, ErrorSituation):
        before, failed = list(situation.completed), situation.failed_action
        if calls[0].name == failed.name and calls[0].input_parameters == failed.input_parameters:
            # Tried again as it was: what fed it in its graph still does, and steps behind it follow it.
            before.append(failed)
            del calls[0]
    return not calls or not plan_problems(calls, situation.catalogue, before)
