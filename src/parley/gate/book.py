"""The rules that are in force, and what they say: one object that the planner, the engines and drives ask."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from typing import Any, Final

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode
from parley.gate.hours import holds_at, wall_clock, zone_of
from parley.gate.judge import (
    Judgement,
    PlannedStep,
    RobotFacts,
    WayPlanner,
    holds_for,
    judge_plan,
    judge_step,
)
from parley.gate.places import place_in
from parley.gate.risk import risk_of
from parley.gate.shapes import Shape
from parley.messages.chat import ActionCall
from parley.messages.principal import Principal
from parley.messages.robot import RulesInForce
from parley.messages.rules import ZONE_KINDS, Point, RiskClass, Rule, RuleSet
from parley.messages.status import ActionInfo
from parley.sentences import sentence
from parley.world.geometry import Pose2D

__all__ = ["RuleBook"]

NOT_READ: Final = sentence("I have not heard yet what the rules are, so I do not begin.")


class RuleBook:
    """The rules in force.

    Args:
        clock: For the clocks on the wall.
        rules: To begin with.

    Raises:
        ConfigError: The rules name a time zone that is not known.
    """

    def __init__(self, clock: Clock, rules: RuleSet | None = None) -> None:
        self._clock = clock
        self.in_force = True
        """Whether it is known what the rules are; until then nothing that moves is let begin."""
        self._facts: dict[str, RobotFacts] = {}
        self._accounts: dict[str, Principal | None] = {}
        self._watchers: list[Callable[[], None]] = []
        self.revision = 0
        """Counts the changes."""
        self.replace(rules or RuleSet())

    @classmethod
    def unread(cls, clock: Clock) -> RuleBook:
        """A book whose rules are still to be heard."""
        book = cls(clock)
        book.in_force = False
        return book

    @property
    def rules(self) -> RuleSet:
        """All rules."""
        return self._rules

    def replace(self, rules: RuleSet) -> None:
        """Let other rules hold from now on.

        Raises:
            ConfigError: They name a time zone that is not known; the former ones go on holding.
        """
        self._zone = zone_of(rules.timezone)
        self._rules = rules
        self._shapes = {rule.id: Shape(rule.corners) for rule in rules.rules if rule.kind in ZONE_KINDS}
        self.in_force = True
        self.revision += 1
        self._changed()

    def _changed(self) -> None:
        for told in self._watchers:
            told()

    def on_change(self, told: Callable[[], None]) -> None:
        """Have `told` called after each change of rules or accounts."""
        self._watchers.append(told)

    def know(self, robot: str, facts: RobotFacts) -> None:
        """Say what a robot is like."""
        self._facts[robot] = facts

    def facts(self, robot: str) -> RobotFacts:
        """What a robot is like."""
        return self._facts.get(robot, RobotFacts())

    def act_for(self, robot: str, by: Principal | None) -> None:
        """On whose account a robot acts from now on: engines and drives ask who is exempt."""
        self._accounts[robot] = by
        self._changed()

    @property
    def told(self) -> RulesInForce:
        """What engines in other processes need to know of it."""
        return RulesInForce(rules=self._rules, accounts=dict(self._accounts))

    def hear(self, told: RulesInForce) -> None:
        """Take over what another book holds; robots that it has no account of go on as they did.

        Raises:
            ConfigError: As `replace`.
        """
        self._accounts |= told.accounts
        if not self.in_force or told.rules != self._rules:
            self.replace(told.rules)

    def account(self, robot: str) -> Principal | None:
        """On whose account a robot acts."""
        return self._accounts.get(robot)

    def now(self) -> datetime:
        """What the clocks on the wall show."""
        return wall_clock(self._clock.unix_ms(), self._zone)

    # -- what the rules say -----------------------------------------------------------------------------

    def judge_plan(
        self,
        *,
        robot: str,
        steps: Sequence[PlannedStep],
        by: Principal | None,
        pose: Pose2D | None = None,
        now: datetime | None = None,
        path: WayPlanner | None = None,
        people: Sequence[Point] = (),
    ) -> Judgement:
        """What the rules say about a plan before it begins, its way included.

        Args:
            robot: Whose plan.
            steps: In their order, with what their arguments mean on the map (`parley.gate.places`).
            by: On whose account.
            pose: Where the robot is.
            now: None: now.
            path: How the robot would drive (`parley.gate.ways`); None: straight.
            people: Where people were seen.
        """
        return judge_plan(
            self._rules, steps, robot=robot, facts=self.facts(robot), by=by,
            here=(pose.x_m, pose.y_m) if pose is not None else None, now=now or self.now(), path=path,
            people=people,
        )  # fmt: skip

    def judge_action(
        self,
        robot: str,
        action: ActionInfo,
        resolved_inputs: Mapping[str, Any],
        by: Principal | None = None,
        now: datetime | None = None,
    ) -> Judgement:
        """What the rules say about an action that is about to begin.

        Args:
            robot: Who would do it.
            action: Of its catalogue.
            resolved_inputs: Its arguments by flat name, handed-over ones too.
            by: On whose account; None: on that of `act_for`.
            now: None: now.
        """
        step = PlannedStep(ActionCall(name=action.name), action, place_in(resolved_inputs))
        return judge_step(
            self._rules, step, robot=robot, facts=self.facts(robot), by=by or self.account(robot), here=None,
            now=now or self.now(),
        )  # fmt: skip

    def admit(self, robot: str, action: ActionInfo, inputs: Mapping[str, Any]) -> None:
        """Let an action begin; what engines ask.

        Raises:
            ActionFailure: `forbidden`, with the rule in its details.
        """
        if not self.in_force and risk_of(action) is not RiskClass.LOOKS:
            raise ActionFailure(FailureCode.FORBIDDEN, NOT_READ)
        for finding in self.judge_action(robot, action, inputs).forbidden:
            raise ActionFailure(FailureCode.FORBIDDEN, finding.sentence, {"rule": finding.rule})

    @property
    def has_rules(self) -> bool:
        """Whether there is any rule at all."""
        return bool(self._rules.rules)

    def active(self, robot: str, now: datetime | None = None) -> tuple[Rule, ...]:
        """The rules that hold for a robot now, on the account on which it acts."""
        now, facts, by = now or self.now(), self.facts(robot), self.account(robot)
        return tuple(
            rule
            for rule in self._rules.rules
            if holds_for(rule, robot, facts, by) and holds_at(rule.when, now)
        )

    def closed_to(self, robot: str, by: Principal | None, now: datetime | None = None) -> tuple[Rule, ...]:
        """The zones that a robot must keep out of now on somebody's account."""
        now, facts = now or self.now(), self.facts(robot)
        return tuple(
            rule
            for rule in self._rules.rules
            if rule.kind == "keep_out" and holds_for(rule, robot, facts, by) and holds_at(rule.when, now)
        )

    def shape(self, rule: Rule) -> Shape:
        """The shape of one of its zones."""
        return self._shapes[rule.id]
