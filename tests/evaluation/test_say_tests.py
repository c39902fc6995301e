"""Sentences that a descriptor promises are tried, and what is not as promised is said."""

from __future__ import annotations

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.evaluation.say_tests import run_say_tests
from parley.language.builtin.engine import BuiltinLanguage
from parley.umrf.action import ActionSpec, action
from parley.umrf.catalogue import Catalogue

LANGUAGE = BuiltinLanguage()


@action(
    examples=("sound the horn",),
    tests={
        "sound the horn three times": {"times": 3},
        "don't sound the horn now": None,
        "please sound the horn 2 times": {"times": 3},
        "don't sound the horn": {},
        "frobnicate": {},
    },
)
async def toot(ctx: object, times: float = 1) -> None:
    """Sound the horn."""


async def problems_of(spec: ActionSpec) -> dict[str, str]:
    results = await run_say_tests([spec], Catalogue([*BUILTIN_ACTIONS, spec]).infos(), LANGUAGE)
    return {result.say: result.problem for result in results}


async def test_a_sentence_has_to_lead_to_its_action_with_its_inputs() -> None:
    problems = await problems_of(toot.spec)
    assert [say for say, problem in problems.items() if not problem] == [
        "sound the horn three times", "don't sound the horn now", "sound the horn",
    ]  # fmt: skip
    assert problems["please sound the horn 2 times"] == "times is 2.0, not 3"
    assert problems["frobnicate"].startswith("not understood so: ")


async def test_every_built_in_action_is_understood_as_it_promises() -> None:
    infos = Catalogue(BUILTIN_ACTIONS).infos()
    results = await run_say_tests(BUILTIN_ACTIONS, infos, LANGUAGE)
    assert [result for result in results if result.problem] == []
    assert {result.action for result in results} >= {"GetCoordinates", "Inspect"}
