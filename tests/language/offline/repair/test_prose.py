"""Failures without a code, and other things in the place of what failed."""

from __future__ import annotations

import pytest

from parley.errors import FailureCode
from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps
from parley.language.base import ErrorSituation, Situation, Turn
from parley.language.offline import OfflineLanguage
from parley.language.offline.repair.prose import with_code
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=name, description=said, x_m=x_m, y_m=0.0, class_name=kind)
    for name, said, kind, x_m in (
        ("bench_s", "small bench", "bench", 5.0),
        ("bench_l", "large bench", "bench", 9.0),
        ("pump", "pump", "pump", 14.0),
    )
)


async def failed(order: str, step: int, error: str, *told: str, reply: str | None = None) -> ErrorSituation:
    catalogue = CATALOGUES["thesis"]
    plan = (await OfflineLanguage().interpret(Situation(order, objects=MAP, catalogue=catalogue))).queue
    return ErrorSituation(
        error,
        plan[step],
        completed=plan[:step],
        pending=plan[step + 1 :],
        memory=tuple(MemoryEntry(name=f"m{index}", data=text) for index, text in enumerate(told)),
        objects=MAP,
        catalogue=catalogue,
        reply=reply,
        dialogue=() if reply is None else (Turn("assistant", "What should I do?"),),
    )


def steps(action: ChatAction) -> list[str]:
    return [
        f"{s.verb} {s.arguments[0]}" for s in read_steps(action.queue, CATALOGUES["thesis"]) if s.arguments
    ]


async def resolved(order: str, step: int, error: str, *told: str, reply: str | None = None) -> ChatAction:
    return await OfflineLanguage().resolve(await failed(order, step, error, *told, reply=reply))


@pytest.mark.parametrize(
    ("order", "step", "error", "code"),
    [
        ("inspect the pump", 2, "Inspection found a water leak", FailureCode.ATTENTION),
        ("inspect the pump", 2, "I see an oil puddle", FailureCode.ATTENTION),
        ("inspect the pump", 2, "There is smoke at the pump", FailureCode.ATTENTION),
        ("inspect the pump", 2, "The pump was not found", FailureCode.NO_MATCH),
        ("inspect the pump", 2, "I see no pump, nothing detected", FailureCode.NO_MATCH),
        (
            "inspect the pump",
            2,
            "Pump inspection failed: the robot is not near the pump",
            FailureCode.NO_MATCH,
        ),
        ("go to the pump", 1, "Path to the pump blocked by closed gate", FailureCode.BLOCKED),
    ],
)
async def test_prose_tells_the_code(order: str, step: int, error: str, code: FailureCode) -> None:
    assert with_code(await failed(order, step, error)).code is code


async def test_what_was_taught_about_a_sight_is_done_when_the_prose_tells_of_it() -> None:
    taught = "If you see a leak, stop and tell me"
    action = await resolved("inspect the pump", 2, "Inspection found a water leak", taught)
    assert (action.success, [c.command for c in action.system_cmd]) == (True, ["stop"])


async def test_too_far_away_it_goes_there_first() -> None:
    action = await resolved("inspect the pump", 2, "Inspection failed: the robot is not near the pump")
    assert steps(action) == ["go pump", "look pump"]


async def test_a_remembered_rule_about_a_closed_thing_holds_for_a_way_barred_by_it() -> None:
    rule = "If a gate is closed, go to the small bench instead"
    assert steps(await resolved("go to the pump", 1, "Path blocked by closed gate", rule)) == [
        "go small bench"
    ]
    assert not (await resolved("go to the pump", 1, "Path blocked by a crate", rule)).success
    used = "If a gate is locked, use the small bench"
    barred = "Cannot pass: the gate is locked"
    assert steps(await resolved("go to the pump", 1, barred, used)) == ["go small bench"]


async def test_a_way_barred_to_what_is_known_to_be_closed_leads_to_what_replaces_it() -> None:
    told = "The large bench is closed off, use the small bench instead"
    assert steps(await resolved("go to the large bench", 1, "No path to goal", told)) == ["go small bench"]


@pytest.mark.parametrize(
    ("reply", "expected"),
    [
        ("the other one", ["go small bench"]),
        ("use the pump instead", ["go pump"]),
        ("the pump then", ["go pump"]),
    ],
)
async def test_another_thing_is_taken(reply: str, expected: list[str]) -> None:
    action = await resolved("go to the large bench", 1, "No path to the large bench", reply=reply)
    assert (action.success, steps(action), action.system_cmd) == (True, expected, ())


@pytest.mark.parametrize(
    "reply", ["I did it myself", "we did that ourselves", "let me do it", "I checked it myself"]
)
async def test_done_by_the_operator_the_step_is_left_out(reply: str) -> None:
    action = await resolved("go to the pump", 1, "The way is blocked", reply=reply)
    assert (action.success, action.queue) == (True, ())


@pytest.mark.parametrize("reply", ["I moved it myself", "I've opened it", "I pushed it aside"])
async def test_the_way_cleared_by_the_operator_the_step_is_tried_again(reply: str) -> None:
    action = await resolved("go to the pump", 1, "The way is blocked", reply=reply)
    assert (action.success, len(action.queue)) == (True, 1)
