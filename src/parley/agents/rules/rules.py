"""Answers `/parley/rules`: which rules there are, changes them for people, tries plans without driving."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

from parley.agents.base import Node
from parley.agents.presence import Presence
from parley.clock import Clock
from parley.errors import ConfigError, InvalidMessageError
from parley.gate.book import RuleBook
from parley.gate.hours import holds_at
from parley.gate.judge import Finding, Place, PlannedStep
from parley.gate.places import Ground, Resolver
from parley.gate.rules import RuleKeeper
from parley.gate.table import Effect, verdict
from parley.gate.ways import judge_with_ways
from parley.gate.wording import rule_text
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.chat import ActionCall
from parley.messages.principal import Principal
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.rule_requests import RuleFinding, RuleRequest, RulesAnswer, RuleVerdict, RuleView
from parley.messages.rules import Point, Rule
from parley.messages.status import ActionInfo, ActorStatus
from parley.messages.wire import decode, encode
from parley.sentences import SpokenLanguage, in_language
from parley.transport.base import Transport
from parley.world.geometry import Pose2D
from parley.world.telling import Surroundings

__all__ = ["RuleNode"]

_DRIVE = ActionInfo(name="drive", effects=("moves",))


class RuleNode(Node):
    """Keeps the rules of a system.

    Args:
        transport: Where it answers.
        keeper: Where the rules are kept.
        book: Where they hold.
        clock: Held while a plan is tried.
        ground: How words are matched with things on the map.
        maps: Robot -> what it drives by.
    """

    name: ClassVar[str] = "rules"

    def __init__(
        self,
        transport: Transport,
        keeper: RuleKeeper,
        book: RuleBook,
        clock: Clock,
        *,
        ground: Ground,
        maps: Mapping[str, Surroundings],
    ) -> None:
        super().__init__(transport)
        self._keeper, self._book, self._clock = keeper, book, clock
        self._ground, self._maps = ground, maps
        self._presence = Presence(clock)

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._presence.on_status)
        self._keeper.on_change(self._on_change)
        self._book.on_change(self._tell_rules)
        self._tell_rules()
        server = await self.transport.serve(topics.RULES, self._on_request)
        self.opened.push_async_callback(server.close)

    async def _on_request(self, asked: ChatRequest) -> ChatResponse:
        try:
            request = decode(RuleRequest, asked.message or "{}")
        except InvalidMessageError as error:
            self.refuse(topics.RULES.name, error)
            return ChatResponse(encode(self._answer("en", problem=f"{error.path}: {error.problem}")))
        try:
            answer = await self._done(request)
        except ConfigError as error:
            answer = self._answer(request.language, problem=str(error))
        return ChatResponse(encode(answer))

    async def _done(self, request: RuleRequest) -> RulesAnswer:
        if request.what == "try":
            judged = await self._try(request)
            return self._answer(request.language).model_copy(update={"verdict": judged})
        if request.what == "word" and request.rule is not None:
            return RulesAnswer(rules=(self._view(request.rule, request.language),))
        if request.what != "list" and verdict(request.by, Effect.RULE) != "allow":
            return self._answer(request.language, problem="You may not change rules.")
        if request.what == "put" and request.rule is not None:
            name = request.by.name if request.by is not None else ""
            rule = request.rule.model_copy(update={"by": request.rule.by or name})
            await self._keeper.put(rule, request.by)
        elif request.what == "drop" and await self._keeper.drop(request.id, request.by) is None:
            return self._answer(request.language, problem="There is no such rule any more.")
        return self._answer(request.language)

    def _answer(self, language: SpokenLanguage, problem: str = "") -> RulesAnswer:
        path = self._keeper.path
        return RulesAnswer(
            rules=tuple(self._view(rule, language) for rule in self._book.rules.rules),
            problem=in_language(problem, language),
            file=path.name if path is not None else "",
        )

    def _view(self, rule: Rule, language: SpokenLanguage) -> RuleView:
        text = in_language(rule_text(rule), language)
        return RuleView(rule=rule, text=text, holds_now=holds_at(rule.when, self._book.now()))

    def _on_change(self, rule: Rule, dropped: bool, by: Principal | None) -> None:
        said = rule.model_dump(mode="json", by_alias=True, exclude_defaults=True)
        detail = {"rule": said, "dropped": dropped}
        self.publish(topics.AUDIT, AuditEvent(effect=Effect.RULE, by=by, words=rule.words, detail=detail))

    def _tell_rules(self) -> None:
        self.publish(topics.RULES_IN_FORCE, self._book.told)

    # -- trying -------------------------------------------------------------------------------------------

    async def _try(self, request: RuleRequest) -> RuleVerdict:
        """What the rules say about a plan, without driving."""
        found, status = self._maps.get(request.robot), self._presence.get(request.robot)
        if found is None:
            raise ConfigError(f"there is no robot {request.robot!r} here")
        told = status.pose if status is not None else None
        pose = Pose2D(told.x, told.y, told.yaw) if told is not None else None
        catalogue = status.catalogue if status is not None else ()
        radius_m = self._book.facts(request.robot).radius_m
        resolver = Resolver(
            self._ground, found.objects.places, found.occupancy, radius_m=radius_m, clock=self._clock
        )
        # A plan begins where the one before it ends.
        before = await resolver.resolve(request.after, catalogue, pose)
        pose = next((end for step in reversed(before) if (end := _end(step)) is not None), pose)
        steps = list(await resolver.resolve(request.steps, catalogue, pose))
        if request.goal is not None:
            steps.append(PlannedStep(ActionCall(name="drive"), _DRIVE, Place(*request.goal)))
        places = {words: await resolver.find(words, pose) for words in request.words}
        steps += [PlannedStep(ActionCall(name="drive"), _DRIVE, place) for place in places.values() if place]
        judged = await judge_with_ways(
            self._book, request.robot, steps, found.occupancy, by=request.by, pose=pose
        )
        return RuleVerdict(
            forbidden=_findings(judged.forbidden, request.language),
            ask=_findings(judged.ask, request.language),
            risky=_findings(judged.risky, request.language),
            length_m=round(judged.length_m, 2),
            expected_s=round(judged.expected_s, 1),
            way=tuple(_rounded(point) for way in judged.ways for point in way),
            goals=tuple(_rounded(way[-1]) for way in judged.ways if way),
            unknown=tuple(words for words, place in places.items() if place is None),
        )


def _end(step: PlannedStep) -> Pose2D | None:
    """Where a robot stands after a step; None: where it stood before."""
    moves = step.info is not None and "moves" in step.info.effects
    return Pose2D(step.place.x, step.place.y) if moves and step.place is not None else None


def _rounded(point: Point) -> Point:
    return (round(point[0], 2), round(point[1], 2))


def _findings(findings: Sequence[Finding], language: SpokenLanguage) -> tuple[RuleFinding, ...]:
    return tuple(
        RuleFinding(step=item.step, rule=item.rule, code=item.code, text=in_language(item.sentence, language))
        for item in findings
    )
