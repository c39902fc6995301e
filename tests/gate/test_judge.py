"""What the rules say about plans, actions and places."""

from __future__ import annotations

from datetime import datetime
from typing import Any

import pytest

from parley.clock import SimClock
from parley.gate.book import RuleBook
from parley.gate.judge import Judgement, Place, PlannedStep, RobotFacts
from parley.messages.chat import ActionCall
from parley.messages.principal import Principal, person
from parley.messages.pvf import Parameter
from parley.messages.rules import Rule, RuleSet
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D

GO = ActionInfo(name="NavigateTo", effects=("moves",))
LOOK = ActionInfo(name="Inspect", effects=("looks",))
OPEN = ActionInfo(name="OpenDoor", effects=("opens",))
ODD = ActionInfo(name="Odd")
NOON = datetime(2026, 3, 10, 12, 0)  # a Tuesday
STORE = {"id": "store", "name": "storeroom", "kind": "keep_out", "rectangle": (4, -1, 6, 1)}


def book(*rules: dict[str, Any], **settings: Any) -> RuleBook:
    made = RuleBook(SimClock(), RuleSet(rules=tuple(Rule(**rule) for rule in rules), **settings))
    made.know("Ada", RobotFacts("hall", radius_m=0.2, speed_mps=0.5))
    return made


def go(x: float, y: float) -> PlannedStep:
    return PlannedStep(ActionCall(name="NavigateTo"), GO, Place(x, y))


def do(info: ActionInfo) -> PlannedStep:
    return PlannedStep(ActionCall(name=info.name), info)


def judged(
    rules: RuleBook,
    *steps: PlannedStep,
    by: Principal | None = None,
    now: datetime = NOON,
    robot: str = "Ada",
) -> Judgement:
    return rules.judge_plan(robot=robot, steps=steps, by=by, pose=Pose2D(0, 0), now=now)


def test_a_plan_into_a_zone_is_forbidden_and_the_step_is_named() -> None:
    found = judged(book(STORE), do(LOOK), go(5, 0)).forbidden
    assert [(item.step, item.rule, item.code) for item in found] == [(1, "store", "zone_entered")]
    assert found[0].sentence == "Step 2 leads into “storeroom”, where Ada must not go."


def test_steps_are_counted_as_people_see_them() -> None:
    where = {"pose": Parameter("number")}
    finds = ActionInfo(name="Find", outputs={"pose": "number"}, effects=("locates",))
    search = PlannedStep(ActionCall(name="Find", output_parameters=where), finds)
    way = PlannedStep(ActionCall(name="NavigateTo", input_parameters=where), GO, Place(5, 0))
    assert judged(book(STORE), search, way).forbidden[0].sentence.startswith("Step 1 leads into")
    two = {"id": "few", "kind": "plan", "max_steps": 2}
    assert judged(book(two), do(LOOK), search, way).forbidden == ()
    assert judged(book(two), do(LOOK), search, way, do(LOOK)).forbidden


def test_a_way_that_leads_only_through_a_zone_is_forbidden_too() -> None:
    assert [item.code for item in judged(book(STORE), go(9, 0)).forbidden] == ["zone_on_way"]
    assert judged(book(STORE), go(0, 5)).forbidden == ()


def test_the_edge_of_the_robot_counts() -> None:
    assert judged(book(STORE), go(3.85, 0)).forbidden
    assert not judged(book(STORE), go(3.75, 0)).forbidden


def test_going_to_an_area_is_entering_it_but_one_may_stand_before_a_thing() -> None:
    def to(*outline_m: float) -> PlannedStep:
        return PlannedStep(ActionCall(name="NavigateTo"), GO, Place(3.5, 0, "it", (*outline_m,)))  # type: ignore[arg-type]

    assert [item.code for item in judged(book(STORE), to(4.1, -1, 5.9, 1)).forbidden] == ["zone_entered"]
    assert [item.code for item in judged(book(STORE | {"kind": "ask_zone"}), to(4.1, -1, 5.9, 1)).ask]
    assert judged(book(STORE), to(4.0, -0.2, 4.4, 0.2)).forbidden == ()
    slow = STORE | {"kind": "slow", "max_speed_mps": 0.2}
    assert judged(book(slow), to(4.1, -1, 5.9, 1)).risky == ()


def test_a_look_into_an_area_from_its_edge_is_no_entering() -> None:
    look = ActionInfo(name="Look", effects=("looks",))
    edge = PlannedStep(ActionCall(name="NavigateTo"), GO, Place(3.5, 0, "it", (4.1, -1, 5.9, 1)))
    within = PlannedStep(ActionCall(name="NavigateTo"), GO, Place(5, 0, "it", (4.1, -1, 5.9, 1)))
    seen = PlannedStep(ActionCall(name="Look"), look)
    assert judged(book(STORE), edge, seen).forbidden == ()
    assert judged(book(STORE), edge, go(0, 0), seen).forbidden
    assert judged(book(STORE), within, seen).forbidden


def test_who_stands_in_a_zone_may_leave_it_but_not_come_back() -> None:
    inside = book(STORE | {"rectangle": (-1, -1, 1, 1)})
    assert judged(inside, go(3, 0)).forbidden == ()
    assert [item.step for item in judged(inside, go(3, 0), go(0, 0)).forbidden] == [1]


@pytest.mark.parametrize(
    ("change", "held"),
    [
        ({"map": "hall"}, True),
        ({"map": "cellar"}, False),
        ({"robots": ("Ada",)}, True),
        ({"robots": ("Bob",)}, False),
        ({"when": {"from": "11:00", "to": "13:00"}}, True),
        ({"when": {"from": "13:00", "to": "11:00"}}, False),
        ({"when": {"days": ("tue",)}}, True),
        ({"when": {"days": ("wed",)}}, False),
    ],
)
def test_a_zone_holds_on_its_map_for_its_robots_at_its_hours(change: dict[str, Any], held: bool) -> None:
    assert bool(judged(book(STORE | change), go(5, 0)).forbidden) is held


def test_a_zone_that_closes_on_the_way_counts() -> None:
    closes = STORE | {"when": {"from": "12:01", "to": "13:00"}}
    assert judged(book(closes | {"rectangle": (49, -1, 51, 1)}), go(50, 0)).forbidden
    assert not judged(book(closes | {"rectangle": (4, -1, 6, 1)}), go(5, 0)).forbidden


def test_only_people_of_an_exempt_role_are_exempt() -> None:
    rules = book(STORE | {"exempt": ("supervisor",)})
    assert not judged(rules, go(5, 0), by=person("Kim", role="supervisor")).forbidden
    for by in (None, person("Kim"), Principal(kind="engine", name="m"), Principal(role="supervisor")):
        assert judged(rules, go(5, 0), by=by).forbidden


def test_actions_are_forbidden_or_asked_about_by_name_by_class_or_all() -> None:
    by_name = book({"id": "a", "kind": "action", "actions": ("OpenDoor",)})
    assert [item.code for item in judged(by_name, do(LOOK), do(OPEN)).forbidden] == ["action_forbidden"]
    by_class = book({"id": "a", "kind": "action", "classes": ("handles_things",), "verdict": "ask"})
    assert [item.step for item in judged(by_class, do(LOOK), do(OPEN)).ask] == [1]
    everything = book({"id": "a", "kind": "action", "robots": ("Ada",)})
    assert len(judged(everything, do(LOOK), do(OPEN)).forbidden) == 2
    assert not judged(everything, do(LOOK), robot="Bob").forbidden


@pytest.mark.parametrize(
    ("limit", "code"),
    [
        ({"max_steps": 1}, "too_many_steps"),
        ({"max_distance_m": 9}, "too_far"),
        ({"max_expected_s": 19}, "too_long"),
    ],
)
def test_plans_are_limited(limit: dict[str, Any], code: str) -> None:
    rule = {"id": "p", "kind": "plan"} | limit
    assert [item.code for item in judged(book(rule), go(5, 0), go(0, 0)).forbidden] == [code]
    assert [item.code for item in judged(book(rule | {"verdict": "ask"}), go(5, 0), go(0, 0)).ask] == [code]
    assert not judged(book(rule), go(4, 0)).forbidden


def test_slow_zones_and_speed_limits_take_time() -> None:
    slow = {"id": "s", "kind": "slow", "rectangle": (0, -1, 5, 1), "max_speed_mps": 0.25}
    assert judged(book(), go(10, 0)).expected_s == pytest.approx(20, abs=0.1)
    assert judged(book(slow), go(10, 0)).expected_s == pytest.approx(30, abs=0.3)
    assert judged(book({"id": "v", "kind": "speed", "max_speed_mps": 0.1}), go(10, 0)).expected_s == (
        pytest.approx(100, abs=0.5)
    )


def test_what_is_risky_is_told_with_its_reason() -> None:
    assert judged(book(), do(LOOK), go(5, 0)).risky == ()
    assert [item.code for item in judged(book(), do(OPEN), do(ODD)).risky] == ["risk", "risk"]
    assert [item.code for item in judged(book(unusual_distance_m=4), go(5, 0)).risky] == ["unusual_length"]
    slow = {"id": "s", "kind": "slow", "rectangle": (2, -1, 3, 1), "max_speed_mps": 0.25}
    assert [item.code for item in judged(book(slow), go(5, 0)).risky] == ["near_zone"]
    near = book().judge_plan(robot="Ada", steps=[go(5, 0)], by=None, pose=Pose2D(0, 0), people=[(3, 0.5)])
    assert [item.code for item in near.risky] == ["person_near"]
    sent_to = book().judge_plan(robot="Ada", steps=[go(5, 0)], by=None, pose=Pose2D(0, 0), people=[(5, 0.5)])
    assert sent_to.risky == ()


def test_an_action_that_begins_is_judged_with_its_arguments() -> None:
    rules = book(STORE, {"id": "a", "kind": "action", "actions": ("OpenDoor",)})
    inputs = {"pose::position::x": 5.0, "pose::position::y": 0.0}
    assert [item.code for item in rules.judge_action("Ada", GO, inputs, now=NOON).forbidden] == [
        "zone_entered"
    ]
    assert not rules.judge_action("Ada", GO, inputs | {"pose::position::x": 9.0}, now=NOON).forbidden
    assert rules.judge_action("Ada", OPEN, {}, now=NOON).forbidden


def test_on_whose_account_a_robot_acts_is_known_to_engine_and_drive() -> None:
    rules = book(STORE | {"exempt": ("supervisor",)})
    assert [rule.kind for rule in rules.active("Ada", NOON)] == ["keep_out"]
    rules.act_for("Ada", person("Kim", role="supervisor"))
    assert rules.active("Ada", NOON) == ()
    rules.act_for("Ada", None)
    assert rules.active("Ada", NOON)
