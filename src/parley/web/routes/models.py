"""Language models that are on this machine, or whose key is: offered, never used unasked."""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import Mapping
from typing import Any, Final
from urllib.error import URLError
from urllib.request import ProxyHandler, build_opener

from fastapi import APIRouter

from parley.errors import ConfigError
from parley.gate.table import Effect
from parley.web.bodies import Done, LanguagePut
from parley.web.config import LOCAL_MODELS
from parley.web.models import ModelOffer
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may

__all__ = ["KEYS", "router"]

router = APIRouter(prefix="/models", tags=["models"], dependencies=[may(Effect.SETTING)])

KEYS: Final = {
    "ANTHROPIC_API_KEY": "anthropic",
    "OPENAI_API_KEY": "openai",
    "GOOGLE_API_KEY": "google",
    "MISTRAL_API_KEY": "mistral",
    "GROQ_API_KEY": "groq",
}
"""Variables in which keys of providers stand; only whether there is one is looked at."""
_WITHIN_S: Final = 1.0
_MOST: Final = 5


@router.get("")
async def get_models(web: Web) -> list[ModelOffer]:
    """What could be used instead of the built-in engine; nothing while a model is used."""
    if not web.info.offline_language:
        return []
    local = await asyncio.to_thread(_local, web.config.local_models)
    return [*local, *_keys(os.environ)]


@router.put("")
async def put_model(put: LanguagePut, web: Web, who: Who) -> Done:
    """Let one of those understand people until the system is started anew; empty: what was there first."""
    if web.language is None:
        raise WebProblem(409, "What understands people runs elsewhere.", "Start it with another --language.")
    if put.language and not any(_is_of(put.language, offer) for offer in await get_models(web)):
        raise WebProblem(409, "That language model is not offered here any more.", path="language")
    try:
        await web.language.use(put.language)
    except ConfigError as error:
        raise WebProblem(409, f"That language model cannot be used: {error}", path="language") from error
    web.state.on_info(web.info)
    if web.info.offline_language:
        who.note(Effect.SETTING, "people are understood without a model again")
    else:
        who.note(Effect.SETTING, f"people are understood by {web.info.language}")
    return Done()


def _is_of(language: str, offer: ModelOffer) -> bool:
    """Whether a name is what was offered, or with a name of a model behind an offer that leaves that open."""
    if not offer.language.endswith(":"):
        return language == offer.language
    name = language.removeprefix(offer.language)
    return name not in ("", language) and "@" not in name


def _keys(environment: Mapping[str, str]) -> list[ModelOffer]:
    found = ((name, provider) for name, provider in KEYS.items() if environment.get(name))
    return [ModelOffer(language=f"auto:{provider}:", found=name) for name, provider in found]


def _local(address: str) -> list[ModelOffer]:
    """The models of a server on this machine; most have none."""
    try:
        with build_opener(ProxyHandler({})).open(f"{address}/api/tags", timeout=_WITHIN_S) as answer:
            told: Any = json.loads(answer.read(1_000_000))
    except (URLError, OSError, ValueError):
        return []
    listed = told.get("models") if isinstance(told, dict) else None
    names = [one.get("name") for one in listed if isinstance(one, dict)] if isinstance(listed, list) else []
    known = [name for name in names if isinstance(name, str) and name][:_MOST]
    where = "" if address == LOCAL_MODELS else f"@{address}/v1"
    return [ModelOffer(language=f"auto:ollama:{name}{where}", found="Ollama") for name in known]
