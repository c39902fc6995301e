"""What goes along with a question: what a provider refuses is left out from then on, and nothing else."""

from __future__ import annotations

import pytest

from parley.config import ModelSettings
from parley.language.llm.options import Options
from parley.language.llm.scripted_server import Say, ScriptedServer
from tests.language.llm.rig import BOX, LOOKS, model, situation


def refusal(text: str) -> Say:
    return Say(status=400, body='{"error": {"message": "' + text + '"}}')


async def test_of_temperature_and_top_p_one_goes_where_both_are_refused() -> None:
    async with model(retries=0) as asked:
        asked.will(refusal("`temperature` and `top_p` cannot both be specified"), LOOKS, LOOKS)
        for _ in range(2):
            assert (await asked.language.interpret(situation())).queue[0].name == "Look"
        sent = [("temperature" in r.body, "top_p" in r.body) for r in asked.server.requests]
    assert sent == [(True, True), (True, False), (True, False)]


async def test_server_that_holds_no_model_to_a_form_is_asked_without() -> None:
    async with model(retries=0) as asked:
        asked.will(refusal("tool_choice is not supported"), refusal("strict is not supported"), LOOKS)
        assert (await asked.language.interpret(situation())).queue[0].name == "Look"
        body = asked.server.requests[-1].body
    assert body["tool_choice"] == "auto"
    assert not body["tools"][0]["function"].get("strict")


def test_refusal_for_another_reason_leaves_everything_as_it_is() -> None:
    options = Options(ModelSettings())
    assert options.refused("the picture is broken") is None
    assert options.refused("top_p?") == "top_p"
    assert options.refused("top_p?") is None


async def test_how_much_a_model_thinks_is_a_setting() -> None:
    async with ScriptedServer() as server:
        server.always(LOOKS)
        for effort in (None, "low"):
            settings = ModelSettings(reasoning=effort)
            assert Options(settings).of("interpret").get("thinking") == effort
            assert Options(settings).of("interpret")["cache"] is True


@pytest.mark.parametrize("small_is_there", [True, False])
async def test_short_answers_come_from_the_smaller_model_while_it_is_there(small_is_there: bool) -> None:
    async with ScriptedServer() as small:
        small.always(Say(answer={"outcome": "match", "ids": ["box_1"]}) if small_is_there else refusal("no"))
        async with model(small=f"local:s@{small.url}") as asked:
            asked.will(LOOKS, Say(answer={"outcome": "match", "ids": ["box_1"]}))
            await asked.language.interpret(situation())
            found = await asked.language.ground("where parcels go", [BOX])
            assert found.candidates == (BOX,)
            assert (len(asked.server.requests), len(small.requests)) == (1 if small_is_there else 2, 1)
