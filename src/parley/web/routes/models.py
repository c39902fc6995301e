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

from parley.gate.table import Effect
from parley.web.models import ModelOffer
from parley.web.routes.access import Web, may

__all__ = ["KEYS", "router"]

router = APIRouter(prefix="/models", tags=["models"], dependencies=[may(Effect.SETTING)])

KEYS: Final = (
    "ANTHROPIC_API_KEY", "OPENAI_API_KEY", "GOOGLE_API_KEY", "MISTRAL_API_KEY", "GROQ_API_KEY",
)  # fmt: skip
"""Variables in which keys of providers stand; only whether there is one is looked at."""
_WITHIN_S: Final = 1.0
_MOST: Final = 5


@router.get("")
async def get_models(web: Web) -> list[ModelOffer]:
    """What could be used instead of the built-in engine; nothing while a model is used."""
    if not web.config.offline_language:
        return []
    local = await asyncio.to_thread(_local, web.config.local_models)
    return [*local, *_keys(os.environ)]


def _keys(environment: Mapping[str, str]) -> list[ModelOffer]:
    return [ModelOffer(language="", found=name) for name in KEYS if environment.get(name)]


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
    return [ModelOffer(language=f"auto:ollama:{name}", found="Ollama") for name in known]
