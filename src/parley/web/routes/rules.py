"""Rules: which there are, changing them, and trying a plan against them without driving."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from parley.errors import UnavailableError
from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.rule_requests import RuleRequest, RulesAnswer, RuleVerdict, RuleView
from parley.messages.rules import Rule
from parley.sentences import SpokenLanguage
from parley.web.backend import Backend
from parley.web.bodies import RuleTryPost
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module

__all__ = ["router"]

router = APIRouter(prefix="/rules", tags=["rules"], dependencies=[module("rules")])

RuleId = Annotated[str, Path(max_length=64)]


async def _ask(web: Backend, request: RuleRequest) -> RulesAnswer:
    """Ask whoever keeps the rules.

    Raises:
        WebProblem: They refuse, or are not there.
    """
    try:
        answer = await web.link.ask(topics.RULES, request, RulesAnswer)
    except UnavailableError as error:
        raise WebProblem(503, "Nobody keeps rules here.", "Start a system that does.") from error
    if answer.problem:
        raise WebProblem(409, answer.problem)
    return answer


@router.get("", dependencies=[may(Effect.SEE)])
async def get_rules(web: Web, language: SpokenLanguage = "en") -> RulesAnswer:
    """All rules, each in words."""
    return await _ask(web, RuleRequest(language=language))


@router.post("/words", dependencies=[may(Effect.RULE)])
async def word_rule(rule: Rule, web: Web, language: SpokenLanguage = "en") -> RuleView:
    """What a rule would say, in words; it does not hold yet."""
    return (await _ask(web, RuleRequest(what="word", rule=rule, language=language))).rules[0]


@router.put("/{rule_id}", dependencies=[may(Effect.RULE)])
async def put_rule(
    rule_id: RuleId, rule: Rule, web: Web, who: Who, language: SpokenLanguage = "en"
) -> RulesAnswer:
    """Add a rule or replace the one of that id."""
    if rule.id != rule_id:
        raise WebProblem(422, "The rule has another id than the address says.", path="id")
    return await _ask(web, RuleRequest(what="put", rule=rule, by=who.by, language=language))


@router.delete("/{rule_id}", dependencies=[may(Effect.RULE)])
async def delete_rule(rule_id: RuleId, web: Web, who: Who, language: SpokenLanguage = "en") -> RulesAnswer:
    """Drop a rule."""
    return await _ask(web, RuleRequest(what="drop", id=rule_id, by=who.by, language=language))


@router.post("/try", dependencies=[may(Effect.SEE)])
async def try_rules(post: RuleTryPost, web: Web, who: Who) -> RuleVerdict:
    """What the rules say about a plan on this person's account; nothing moves."""
    name = web.robot(post.robot).name
    request = RuleRequest(
        what="try",
        robot=name,
        steps=post.steps,
        after=post.after,
        goal=post.goal,
        words=post.words,
        language=post.language,
        by=who.by,
    )
    answer = await _ask(web, request)
    assert answer.verdict is not None
    return answer.verdict
