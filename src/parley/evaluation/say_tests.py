"""Whether people get an action by the sentences that its descriptor promises."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from parley.language.base import Language, Situation
from parley.messages.chat import ChatAction
from parley.messages.status import ActionInfo
from parley.umrf.action import ActionSpec, SayTest
from parley.umrf.kinds import parameters_of
from parley.world.object_map import MapObject

__all__ = ["SayResult", "run_say_tests"]


_NAME_WORDS = 3


@dataclass(frozen=True, slots=True)
class SayResult:
    """What came of one sentence."""

    action: str
    say: str
    problem: str = ""
    """Why it is not as promised; empty if it is."""


async def run_say_tests(
    specs: Sequence[ActionSpec], catalogue: Sequence[ActionInfo], language: Language
) -> list[SayResult]:
    """Say the test sentences, examples and plain phrases of actions to a robot that can do a whole catalogue.

    The places, things and people that a test names are on its map; nothing else is.
    """
    infos = {info.name: info for info in catalogue}
    results = []
    for spec in specs:
        told = {test.say for test in spec.tests}
        promised = [say for say in (*spec.examples, *spec.phrases) if "{" not in say and say not in told]
        for test in [*spec.tests, *(SayTest(say, {}) for say in promised)]:
            objects = _objects(infos[spec.name], test)
            situation = Situation(test.say, objects=objects, catalogue=tuple(catalogue), robot="robot")
            answer = await language.interpret(situation)
            results.append(SayResult(spec.name, test.say, _problem(spec.name, test, answer)))
    return results


def _objects(info: ActionInfo, test: SayTest) -> tuple[MapObject, ...]:
    told = parameters_of(info)
    taken = ("place", "thing", "text")
    given = [str(value) for name, value in (test.inputs or {}).items() if told[name].kind in taken]
    named = [text for text in given if len(text.split()) <= _NAME_WORDS]
    return tuple(MapObject(f"thing_{at}", name, float(at), 1.0) for at, name in enumerate(named, 1))


def _problem(action: str, test: SayTest, answer: ChatAction) -> str:
    calls = [call for call in answer.queue if call.name == action]
    if test.inputs is None:
        return "it must not lead to this action" if calls else ""
    if not calls:
        others = ", ".join(call.name for call in answer.queue)
        return f"leads to {others}" if others else f"not understood so: {answer.message_response}"
    if len(calls) > 1:
        return f"leads to it {len(calls)} times"
    got = {name: item.value for name, item in calls[0].input_parameters.items() if item.has_data}
    return _difference(test.inputs, got)


def _difference(wanted: Mapping[str, Any], got: Mapping[str, Any]) -> str:
    wrong = [name for name, value in wanted.items() if not _same(value, got.get(name))]
    return ", ".join(f"{name} is {got.get(name, 'not given')!r}, not {wanted[name]!r}" for name in wrong)


def _same(wanted: Any, got: Any) -> bool:
    if isinstance(wanted, int | float) and isinstance(got, int | float):
        return math.isclose(wanted, got, rel_tol=1e-3)
    return str(wanted).casefold() == str(got).casefold()
