"""Breaker and budget, alone and in front of a model."""

from __future__ import annotations

import pytest

from parley.agents.planner.check import plan_problems
from parley.config import ModelSettings
from parley.errors import LanguageError
from parley.language.llm import build_language
from parley.language.llm.chain import ChainLanguage
from parley.language.llm.engine import LlmLanguage
from parley.language.llm.guard import Breaker, Budget
from parley.language.llm.scripted_server import Say
from tests.language.llm.rig import LOOKS, HandClock, model, situation

BROKEN = Say(body="oops", status=500)


def test_breaker_opens_after_failures_in_a_row_and_lets_one_probe_through() -> None:
    clock = HandClock()
    breaker = Breaker(clock, failures=2, open_s=30.0)
    for _ in range(2):
        breaker.admit()
        breaker.failed()
    with pytest.raises(LanguageError):
        breaker.admit()
    clock.advance(30.0)
    breaker.admit()
    with pytest.raises(LanguageError):
        breaker.admit()  # the probe is under way
    breaker.failed()
    assert breaker.state == "open"
    clock.advance(30.0)
    breaker.admit()
    breaker.succeeded()
    assert breaker.state == "closed"


def test_success_in_between_keeps_the_breaker_closed() -> None:
    breaker = Breaker(HandClock(), failures=2, open_s=30.0)
    for _ in range(5):
        breaker.failed()
        breaker.succeeded()
    assert breaker.state == "closed"


def test_probe_that_was_called_off_leaves_room_for_the_next() -> None:
    clock = HandClock()
    breaker = Breaker(clock, failures=1, open_s=1.0)
    breaker.failed()
    clock.advance(1.0)
    breaker.admit()
    breaker.left()
    breaker.admit()


def test_budget_counts_the_last_hour_only() -> None:
    clock = HandClock()
    budget = Budget(clock, max_tokens=100)
    budget.spend(100, 0.0)
    with pytest.raises(LanguageError, match="100 tokens"):
        budget.admit()
    clock.advance(3600.0)
    budget.admit()


def test_budget_of_money_counts_money() -> None:
    budget = Budget(HandClock(), max_usd=0.5)
    budget.spend(10**6, 0.4)
    budget.admit()
    budget.spend(1, 0.1)
    with pytest.raises(LanguageError) as caught:
        budget.admit()
    assert "cost" in caught.value.plain


async def test_model_that_keeps_failing_is_left_alone_then_tried_again() -> None:
    async with model(retries=0, breaker_failures=2, breaker_open_s=30.0) as asked:
        asked.will(BROKEN, BROKEN, LOOKS)
        for _ in range(4):
            with pytest.raises(LanguageError):
                await asked.language.interpret(situation())
        assert len(asked.server.requests) == 2
        asked.clock.advance(30.0)
        assert (await asked.language.interpret(situation())).queue


async def test_answers_that_cannot_be_used_do_not_open_the_breaker() -> None:
    async with model(corrections=0, breaker_failures=1) as asked:
        asked.will(Say(text="hm"), LOOKS)
        with pytest.raises(LanguageError):
            await asked.language.interpret(situation())
        assert (await asked.language.interpret(situation())).queue


async def test_waits_between_tries_double_and_heed_the_provider() -> None:
    async with model(backoff_s=0.5, retries=3) as asked:
        asked.will(BROKEN, BROKEN, Say(body="{}", status=429, headers={"Retry-After": "7"}), LOOKS)
        await asked.language.interpret(situation())
        assert asked.clock.waits == [0.5, 1.0, 7.0]


async def test_provider_that_asks_for_a_long_pause_is_not_waited_for() -> None:
    async with model() as asked:
        asked.will(Say(body="{}", status=429, headers={"Retry-After": "600"}))
        with pytest.raises(LanguageError):
            await asked.language.interpret(situation())
        assert asked.clock.waits == []


async def test_tokens_and_cost_are_counted_and_capped() -> None:
    prices = {"local:m": {"input": 2.0, "output": 10.0}}
    async with model(prices=prices, max_tokens_per_hour=150) as asked:
        asked.server.always(LOOKS)
        await asked.language.interpret(situation())
        await asked.language.interpret(situation())
        with pytest.raises(LanguageError, match="limit"):
            await asked.language.interpret(situation())
        exchange = asked.usage.exchanges[0]
        assert (exchange.kind, exchange.model, exchange.outcome) == ("interpret", "local:m", "answered")
        assert (exchange.input_tokens, exchange.output_tokens) == (100, 20)
        assert exchange.cost_usd == pytest.approx(100 * 2e-6 + 20 * 10e-6)
        assert exchange.prompt_version.startswith("interpret-")
        assert asked.usage.totals()["cost_usd"] == pytest.approx(2 * 0.0004)


async def test_unknown_price_is_not_made_up() -> None:
    async with model() as asked:
        asked.will(LOOKS)
        await asked.language.interpret(situation())
        assert asked.usage.exchanges[0].cost_usd is None


def test_models_of_a_chain_share_the_time_there_is() -> None:
    names = ["local:a@http://127.0.0.1:9/v1", "local:b@http://127.0.0.1:9/v1", "builtin"]
    chain = build_language(names, ModelSettings(timeout_s=20.0), check=plan_problems, within_s=27.0)
    assert isinstance(chain, ChainLanguage)
    limits = [engine.timeout_s for engine in chain.engines if isinstance(engine, LlmLanguage)]
    assert limits == [13.5, 13.5]
