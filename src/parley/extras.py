"""Parts that are installed on their own: what each is for, and a clear word where one is missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from parley.errors import MissingExtraError

__all__ = ["EXTRAS", "MODEL_EXTRAS", "model_extra", "needs"]

MODEL_EXTRAS: Final = ("openai", "anthropic", "google", "mistral", "groq")
"""Those of language models are called as their providers."""

EXTRAS: Final = {
    "maps": "driving by a map",
    "sim": "the simulator",
    "web": "the page for operators",
    "zenoh": "the network of several machines",
    "rosbridge": "the way to robots through rosbridge",
    **dict.fromkeys(MODEL_EXTRAS, "what language models need"),
}
"""Extra -> what it brings."""


def model_extra(language: str) -> str:
    """Which extra a model needs, by its name in the settings; servers of one's own speak as OpenAI's do."""
    provider = language.removeprefix("auto:").partition(":")[0]
    return provider if provider in MODEL_EXTRAS else "openai"


@contextmanager
def needs(extra: str) -> Iterator[None]:
    """Say clearly that an extra is missing where the imports inside this need it.

    Args:
        extra: One of `EXTRAS`; empty: none is needed.

    Raises:
        MissingExtraError: A library of it is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        if not extra or (error.name or "parley").partition(".")[0] == "parley":
            raise  # one of ours is missing: a defect
        raise MissingExtraError(extra, EXTRAS[extra]) from error
