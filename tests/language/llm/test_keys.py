"""Keys: found where people put them, sent to nobody else, and never written anywhere."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from parley.agents.planner.check import plan_problems
from parley.config import ModelSettings
from parley.errors import ConfigError, LanguageError
from parley.language.llm import build_language
from parley.language.llm.models import ModelSpec, make_model
from parley.language.llm.recording import Redactor
from parley.language.llm.scripted_server import Say, ScriptedServer
from tests.language.llm.rig import LOOKS, situation

KEY = "sk-very-secret-0123456789"


async def asked(server: ScriptedServer, provider: str, **settings: object) -> str:
    """Ask once; the key that the server was shown, and what went wrong."""
    language = build_language(
        [f"{provider}:m@{server.url}"], ModelSettings.model_validate(settings), check=plan_problems
    )
    async with language:  # type: ignore[attr-defined]
        try:
            await language.interpret(situation())
        except LanguageError as error:
            return f"{error} {error.plain} {error!r} {error.__cause__!r}"
    return server.requests[-1].headers["authorization"]


async def test_key_from_a_file_is_shown_to_the_server(tmp_path: Path) -> None:
    file = tmp_path / "key"
    file.write_text(f"{KEY}\n", encoding="utf-8")
    async with ScriptedServer() as server:
        server.will(LOOKS)
        assert await asked(server, "local", key_file=file) == f"Bearer {KEY}"


async def test_key_of_one_provider_goes_to_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    async with ScriptedServer() as server:
        server.will(LOOKS, LOOKS)
        assert KEY not in await asked(server, "ollama")
        assert KEY in await asked(server, "openai")


async def test_key_is_in_no_log_no_error_and_no_recording(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    file, record = tmp_path / "key", tmp_path / "exchanges.jsonl"
    file.write_text(KEY, encoding="utf-8")
    body = json.dumps({"error": {"message": f"Incorrect API key provided: {KEY}"}})
    async with ScriptedServer() as server:
        server.will(Say(body=body, status=401), Say(text=f"your key is {KEY}"), Say(text=KEY), Say(text=KEY))
        caplog.set_level("DEBUG")
        for _ in range(2):
            said = await asked(server, "local", key_file=file, record_file=record)
            assert KEY not in said
    out, err = capfd.readouterr()
    written = record.read_text(encoding="utf-8")
    assert "[key]" in written
    assert KEY not in written + out + err + caplog.text


def test_keys_of_the_environment_are_blacked_out_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MISTRAL_API_KEY", "abcdef-secret")
    assert Redactor().clean("Bearer abcdef-secret!") == "Bearer [key]!"


def test_key_file_that_is_missing_or_empty_is_named(tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.write_text("\n", encoding="utf-8")
    for file in (empty, tmp_path / "nowhere"):
        with pytest.raises(ConfigError, match=file.name):
            build_language(["local:m@http://x/v1"], ModelSettings(key_file=file), check=plan_problems)


def test_missing_key_is_said_before_anything_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    with pytest.raises(ConfigError, match="OPENAI_API_KEY"):
        build_language(["openai:gpt-4.1"], ModelSettings(), check=plan_problems)


def test_names_of_models_are_read_with_and_without_address() -> None:
    assert ModelSpec.parse("openai:gpt-4.1") == ModelSpec("openai", "gpt-4.1")
    at = ModelSpec.parse("local:org/model:7b@http://host:8000/v1")
    assert (at.model, at.base_url) == ("org/model:7b", "http://host:8000/v1")
    assert ModelSpec.parse("ollama:llama3.2:3b").base_url == "http://localhost:11434/v1"
    assert ModelSpec.parse("openai:x", "http://here/v1").base_url == "http://here/v1"


@pytest.mark.parametrize("name", ["gpt-4.1", "openai:", ":x", "local:x", "nobody:x"])
def test_name_that_means_no_model_is_refused(name: str) -> None:
    with pytest.raises(ConfigError):
        build_language([name], ModelSettings(), check=plan_problems)


@pytest.mark.parametrize(
    ("name", "gone", "library"),
    [
        ("anthropic:x", "anthropic", "parley-hri[anthropic]"),
        ("google:x", "google", "parley-hri[google]"),
        ("mistral:x", "mistral", "parley-hri[mistral]"),
        ("groq:x", "groq", "parley-hri[groq]"),
        ("cohere:x", "cohere", "pydantic-ai-slim[cohere]"),
        ("ollama:x", "openai", "parley-hri[openai]"),
        ("local:x@http://127.0.0.1:9/v1", "openai", "parley-hri[openai]"),
    ],
)
def test_library_that_a_provider_lacks_is_named(
    monkeypatch: pytest.MonkeyPatch, name: str, gone: str, library: str
) -> None:
    monkeypatch.setitem(sys.modules, f"pydantic_ai.models.{gone}", None)
    monkeypatch.setitem(sys.modules, f"pydantic_ai.providers.{gone}", None)
    with pytest.raises(ConfigError) as caught:
        make_model(ModelSpec.parse(name), "some-key")
    assert f"pip install '{library}'" in str(caught.value)
