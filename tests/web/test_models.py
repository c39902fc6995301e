"""A language model that is offered, put in use while robots work, and taken out of use again."""

from __future__ import annotations

import json
from pathlib import Path

import httpx
import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.language.llm.scripted_server import Say, ScriptedServer
from parley.messages import topics
from parley.messages.audit import AuditList, GetAudit
from parley.messages.ros import ChatRequest
from parley.messages.wire import decode, encode
from parley.web.config import WebConfig
from parley.web.routes.models import KEYS
from parley.web.server import WebServer
from tests.demos.house import running
from tests.web.rig import served

TAGS = Say(body=json.dumps({"models": [{"name": "qwen3:8b"}]}))
UNSURE = "Could you brighten my day a little?"


async def test_a_model_that_is_found_is_used_from_a_tap_on_and_no_more_from_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for key in KEYS:
        monkeypatch.delenv(key, raising=False)
    config = SystemConfig(speed=None, data_dir=tmp_path)
    async with ScriptedServer() as ollama, running(load_demo("nursing-home").system(config)) as home:
        system = home.system
        page = WebConfig.of(config, port=0, local_models=ollama.url.removesuffix("/v1"))
        async with (
            WebServer(system.transport, page, language=system.language) as server,
            httpx.AsyncClient(base_url=server.url) as http,
        ):

            async def info() -> tuple[str, bool, bool]:
                told = (await http.get("/api/snapshot")).json()["info"]
                return told["language"], told["offline_language"], told["is_language_chosen"]

            first = (page.language, True, False)
            before = (await home.say(UNSURE)).message
            assert (await info(), ollama.requests) == (first, [])

            ollama.will(TAGS, TAGS)
            (offer,) = (await http.get("/api/models")).json()
            elsewhere = {"language": "auto:ollama:qwen3:8b@http://192.0.2.1:1/v1"}
            assert (await http.put("/api/models", json=elsewhere)).status_code == 409
            assert await info() == first
            ollama.will(TAGS)
            assert (await http.put("/api/models", json={"language": offer["language"]})).status_code == 200
            assert await info() == ("qwen3:8b (ollama)", False, True)

            ollama.always(Say(answer={"message_response": "The sun is out."}))
            assert "The sun is out." in (await home.say(UNSURE)).message
            assert ollama.requests[-1].body["model"] == "qwen3:8b"

            assert (await http.put("/api/models", json={"language": ""})).status_code == 200
            asked = len(ollama.requests)
            assert (await home.say(UNSURE)).message == before
            assert (await info(), len(ollama.requests)) == (first, asked)
            answer = await system.transport.call(
                topics.GET_AUDIT, ChatRequest(encode(GetAudit(effect="setting"))), timeout_s=20
            )
        words = [entry.words for entry in decode(AuditList, answer.response).entries]
        assert sorted(words) == [
            "people are understood by qwen3:8b (ollama)",
            "people are understood without a model again",
        ]


async def test_where_what_understands_runs_elsewhere_it_is_not_changed() -> None:

    async with served("Ada") as rig:
        answer = await rig.http.put("/api/models", json={"language": ""})
        assert answer.status_code == 409
        assert "elsewhere" in answer.json()["detail"]
