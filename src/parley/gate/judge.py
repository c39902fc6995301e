"""What the rules say about a plan, an action, a place: pure decisions; the state is in `parley.gate.book`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from parley.gate.cards import for_next
from parley.gate.hours import holds_at
from parley.gate.risk import always_asks, risk_of
from parley.gate.shapes import Shape, dense
from parley.gate.wording import action_text, class_text, hours_text, zone_text
from parley.messages.chat import ActionCall
from parley.messages.principal import Principal
from parley.messages.rules import ZONE_KINDS, Point, RiskClass, Rule, RuleSet
from parley.messages.status import ActionInfo
from parley.sentences import sentence

__all__ = [
    "Finding", "Judgement", "Place", "PlannedStep", "RobotFacts", "WayPlanner", "exempts",
    "holds_for", "judge_plan", "judge_step",
]  # fmt: skip

WayPlanner = Callable[[Point, Point], Sequence[Point] | None]
"""From start to goal: the points of the way a robot would take, around what it must keep out of where it can;
None if the map has no way."""

_PERSON_NEAR_M: Final = 1.0
_MINUTE: Final = timedelta(minutes=1)
_MAX_MINUTES: Final = 24 * 60


class Place(NamedTuple):
    """What an argument means on the map."""

    x: float
    y: float
    id: str = ""
    """Of the object, if it is one."""
    outline: tuple[float, float, float, float] | None = None
    """x_min, y_min, x_max, y_max of the object."""

    def is_zone(self, shape: Shape) -> bool:
        """Whether the object and a zone are the same place: each holds the other's middle."""
        if self.outline is None:
            return False
        x1, y1, x2, y2 = self.outline
        left, low, right, high = shape.box_m
        middle_x, middle_y = (left + right) / 2, (low + high) / 2
        holds = x1 <= middle_x <= x2 and y1 <= middle_y <= y2
        return holds and shape.distance_to((x1 + x2) / 2, (y1 + y2) / 2) < 0


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """One step of a plan with all that is known about it."""

    call: ActionCall
    info: ActionInfo | None = None
    """Of the robot's catalogue; None: an action that nobody knows."""
    place: Place | None = None
    """Where it leads, resolved; None if that cannot be known before."""


@dataclass(frozen=True, slots=True)
class RobotFacts:
    """What rules need to know about a robot."""

    map_name: str = ""
    radius_m: float = 0.2
    speed_mps: float = 0.5
    """How fast it drives when nothing limits it."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What one rule says about one step."""

    step: int
    """Its index; -1: of the plan as a whole."""
    rule: str
    """Its id; empty for what `ask_when_risky` says by itself."""
    code: str
    """`zone_entered`, `zone_on_way`, `zone_asks`, `action_forbidden`, `action_asks`, `too_far`, `too_long`,
    `too_many_steps`; of risk: `risk`, `near_zone`, `person_near`, `unusual_length`, `way_unknown`."""
    sentence: str
    """For operators."""


@dataclass(frozen=True, slots=True)
class Judgement:
    """What all rules say."""

    forbidden: tuple[Finding, ...] = ()
    """Not to be done, whoever says yes."""
    ask: tuple[Finding, ...] = ()
    """To be done only after a yes, whatever the policy."""
    risky: tuple[Finding, ...] = ()
    """Why `ask_when_risky` asks."""
    length_m: float = 0.0
    expected_s: float = 0.0
    ways: tuple[tuple[Point, ...], ...] = ()
    """The way of each step; empty for steps that do not drive or whose way is not known."""


def exempts(rule: Rule, by: Principal | None) -> bool:
    """Whether a rule leaves alone what happens on somebody's account."""
    return by is not None and by.is_person and (by.role or "operator") in rule.exempt


def holds_for(rule: Rule, robot: str, facts: RobotFacts, by: Principal | None) -> bool:
    """Whether a rule concerns a robot on somebody's account, at its hours."""
    if rule.robots and robot not in rule.robots:
        return False
    if rule.map and rule.map != facts.map_name:
        return False
    return not exempts(rule, by)


@dataclass(slots=True)
class _Walk:
    """A plan being judged, step by step."""

    rules: tuple[Rule, ...]
    robot: str
    facts: RobotFacts
    now: datetime
    people: Sequence[Point]
    here: Point | None
    path: WayPlanner | None
    at: datetime = field(init=False)
    to_look: bool = False
    """Whether the step that is judged only leads to where the next one looks from."""
    number: int = 1
    """Of the step, as people count: finding out where something is belongs to the step that goes there."""
    length_m: float = 0.0
    forbidden: list[Finding] = field(default_factory=list)
    ask: list[Finding] = field(default_factory=list)
    risky: list[Finding] = field(default_factory=list)
    ways: list[tuple[Point, ...]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.at = self.now

    def step(self, index: int, step: PlannedStep) -> None:
        """Judge the next step."""
        began = self.at
        self._risk(index, step)
        way: tuple[Point, ...] = ()
        if step.place is not None and risk_of(step.info) is not RiskClass.LOOKS:
            way = self._drive(index, step.place, began)
        elif step.info is not None and "moves" in step.info.effects and self._zones("keep_out"):
            text = sentence("I cannot say beforehand where step {number} leads.", number=self.number)
            self.risky.append(Finding(index, "", "way_unknown", text))
        self.ways.append(way)
        if step.info is not None and step.info.duration_s is not None and not way:
            self.at += timedelta(seconds=step.info.duration_s)
        self._action(index, step, began)

    def _zones(self, *kinds: str) -> list[Rule]:
        return [rule for rule in self.rules if rule.kind in kinds]

    def _risk(self, index: int, step: PlannedStep) -> None:
        if not always_asks(step.info):
            return
        known = class_text(risk_of(step.info))
        text = sentence(
            "Step {number} is of a kind that waits for a yes: {kind}.", number=self.number, kind=known
        )
        self.risky.append(Finding(index, "", "risk", text))

    def _action(self, index: int, step: PlannedStep, began: datetime) -> None:
        for rule in self._zones("action"):
            if _concerns(rule, step.call.name, step.info) and _holds_during(rule, began, self.at):
                self._put(
                    index, rule, "action", _action_sentence(rule, self.number, step.call.name, self.robot)
                )

    def _drive(self, index: int, place: Place, began: datetime) -> tuple[Point, ...]:
        goal = (place.x, place.y)
        here = self.here or goal
        found = self.path(here, goal) if self.path is not None else (here, goal)
        self.here = goal
        way = dense(found) if found else np.array([goal])
        length_m = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
        self.length_m += length_m
        self.at += timedelta(seconds=_expected_s(way, self._zones("slow", "speed"), self.facts, began))
        for rule in self._zones("keep_out", "ask_zone", "slow"):
            if _holds_during(rule, began, self.at):
                self._zone(index, rule, way, place)
        passed = [person for person in self.people if math.dist(goal, person) >= _PERSON_NEAR_M]
        if any(_nearest(way, person) < _PERSON_NEAR_M for person in passed):  # it may be sent to somebody
            text = sentence("Somebody stands in the way of step {number}.", number=self.number)
            self.risky.append(Finding(index, "", "person_near", text))
        return tuple((float(x), float(y)) for x, y in way)

    def _zone(self, index: int, rule: Rule, way: NDArray[np.float64], place: Place) -> None:
        shape = Shape(rule.corners)
        inside = shape.distance_m(way) < self.facts.radius_m
        # Who stands in there already may leave.
        inside[: int(np.argmin(inside)) if not inside.all() else 0] = False
        # One may stand before a thing and be there; of an area that is entering it, but for a look into it.
        entered = inside[-1] or (rule.kind != "slow" and place.is_zone(shape) and not self.to_look)
        if not (entered or inside.any()):
            return
        words = {
            "number": self.number, "zone": zone_text(rule), "robot": self.robot,
            "hours": hours_text(rule.when),
        }  # fmt: skip
        if rule.kind == "slow":
            text = sentence("Step {number} leads through {zone}, where {robot} goes slowly{hours}.", **words)
            self.risky.append(Finding(index, rule.id, "near_zone", text))
        elif rule.kind == "ask_zone":
            text = sentence("Step {number} leads through {zone}, which needs a yes{hours}.", **words)
            self.ask.append(Finding(index, rule.id, "zone_asks", text))
        elif entered:
            text = sentence("Step {number} leads into {zone}, where {robot} must not go{hours}.", **words)
            self.forbidden.append(Finding(index, rule.id, "zone_entered", text))
        else:
            text = sentence(
                "The only way of step {number} leads through {zone}, where {robot} must not go{hours}.",
                **words,
            )
            self.forbidden.append(Finding(index, rule.id, "zone_on_way", text))

    def _put(self, index: int, rule: Rule, code: str, text: str) -> None:
        if rule.verdict == "ask":
            self.ask.append(Finding(index, rule.id, f"{code}_asks", text))
        else:
            self.forbidden.append(Finding(index, rule.id, f"{code}_forbidden", text))

    def limits(self, steps: int, unusual_m: float) -> None:
        """Judge the plan as a whole."""
        expected_s = (self.at - self.now).total_seconds()
        for rule in self._zones("plan"):
            if not _holds_during(rule, self.now, self.at):
                continue
            for code, text in _over(rule, steps, self.length_m, expected_s):
                (self.ask if rule.verdict == "ask" else self.forbidden).append(
                    Finding(-1, rule.id, code, text)
                )
        if self.length_m > unusual_m:
            text = sentence("The way is unusually long: about {metres} m.", metres=round(self.length_m))
            self.risky.append(Finding(-1, "", "unusual_length", text))


def judge_plan(
    rules: RuleSet,
    steps: Sequence[PlannedStep],
    *,
    robot: str,
    facts: RobotFacts,
    by: Principal | None,
    here: Point | None,
    now: datetime,
    path: WayPlanner | None = None,
    people: Sequence[Point] = (),
) -> Judgement:
    """What the rules say about a plan.

    Args:
        rules: All there are.
        steps: In their order.
        robot: Whose plan it is.
        facts: About that robot.
        by: On whose account; nobody and programs are exempt from nothing.
        here: Where the robot is, if that is known.
        now: What the clocks on the wall show.
        path: How the robot would drive; None: straight.
        people: Where people were seen.
    """
    mine = tuple(rule for rule in rules.rules if holds_for(rule, robot, facts, by))
    walk = _Walk(mine, robot, facts, now, people, here, path)
    infos = [step.info for step in steps if step.info is not None]
    searches = for_next([step.call for step in steps], infos)
    for index, (step, search) in enumerate(zip(steps, searches, strict=True)):
        behind = steps[index + 1].info if index + 1 < len(steps) else None
        walk.to_look = behind is not None and "looks" in behind.effects
        walk.step(index, step)
        walk.number += not search
    walk.limits(walk.number - 1, rules.unusual_distance_m)
    return Judgement(
        tuple(walk.forbidden),
        tuple(walk.ask),
        tuple(walk.risky),
        walk.length_m,
        (walk.at - now).total_seconds(),
        tuple(walk.ways),
    )


def judge_step(
    rules: RuleSet,
    step: PlannedStep,
    *,
    robot: str,
    facts: RobotFacts,
    by: Principal | None,
    here: Point | None,
    now: datetime,
) -> Judgement:
    """What the rules say about one action that is about to begin; its way is the drive's matter."""
    judged = judge_plan(
        rules, [step], robot=robot, facts=facts, by=by, here=here, now=now, path=lambda _, goal: (goal,)
    )
    of_actions = ("zone_entered", "action_forbidden")
    return Judgement(
        tuple(_brief(rules, item, step, robot) for item in judged.forbidden if item.code in of_actions),
        tuple(item for item in judged.ask if item.step >= 0),
        judged.risky,
    )


def _brief(rules: RuleSet, finding: Finding, step: PlannedStep, robot: str) -> Finding:
    """The same without the number of a step: it is about the one that is about to begin."""
    rule = rules.get(finding.rule)
    if rule is None:
        return finding
    hours = hours_text(rule.when)
    if finding.code == "zone_entered":
        text = sentence(
            "{robot} must not go into {zone}{hours}.", robot=robot, zone=zone_text(rule), hours=hours
        )
    else:
        action = action_text(step.call.name)
        text = sentence("{robot} must not do “{action}”{hours}.", robot=robot, action=action, hours=hours)
    return replace(finding, sentence=text)


def _concerns(rule: Rule, action: str, info: ActionInfo | None) -> bool:
    if not rule.actions and not rule.classes:
        return True
    return action in rule.actions or risk_of(info) in rule.classes


def _holds_during(rule: Rule, start: datetime, end: datetime) -> bool:
    """Whether a rule's hours touch a stretch of time."""
    return any(holds_at(rule.when, moment) for moment in _moments(start, end))


def _moments(start: datetime, end: datetime) -> Iterator[datetime]:
    yield start
    for _ in range(_MAX_MINUTES):
        start += _MINUTE
        if start >= end:
            break
        yield start
    yield end


def _nearest(way: NDArray[np.float64], person: Point) -> float:
    return float(np.hypot(way[:, 0] - person[0], way[:, 1] - person[1]).min())


def _expected_s(way: NDArray[np.float64], slow: Iterable[Rule], facts: RobotFacts, now: datetime) -> float:
    if len(way) < 2:
        return 0.0
    middles = (way[:-1] + way[1:]) / 2
    speed = np.full(len(middles), facts.speed_mps)
    for rule in slow:
        if rule.max_speed_mps is None or not holds_at(rule.when, now):
            continue
        there = Shape(rule.corners).distance_m(middles) < 0 if rule.kind in ZONE_KINDS else True
        speed = np.where(there, np.minimum(speed, rule.max_speed_mps), speed)
    return float(sum(np.hypot(*(b - a)) / v for (a, b), v in zip(pairwise(way), speed, strict=True)))


def _over(rule: Rule, steps: int, length_m: float, expected_s: float) -> Iterator[tuple[str, str]]:
    """Which limits of a rule a plan is over, each with its code and in words."""
    if rule.max_steps is not None and steps > rule.max_steps:
        yield (
            "too_many_steps",
            sentence("The plan has {count} steps; {most} are allowed.", count=steps, most=rule.max_steps),
        )
    if rule.max_distance_m is not None and length_m > rule.max_distance_m:
        yield (
            "too_far",
            sentence(
                "The way is about {metres} m long; {most} m are allowed.",
                metres=round(length_m, 1),
                most=f"{rule.max_distance_m:g}",
            ),
        )
    if rule.max_expected_s is not None and expected_s > rule.max_expected_s:
        yield (
            "too_long",
            sentence(
                "It would take about {seconds} s; {most} s are allowed.",
                seconds=round(expected_s),
                most=f"{rule.max_expected_s:g}",
            ),
        )


def _action_sentence(rule: Rule, number: int, action: str, robot: str) -> str:
    words = {
        "number": number, "robot": robot, "hours": hours_text(rule.when), "action": action_text(action),
    }  # fmt: skip
    if rule.verdict == "ask":
        return sentence("Step {number}, “{action}”, always needs a yes{hours}.", **words)
    return sentence("Step {number}: {robot} must not do “{action}”{hours}.", **words)
