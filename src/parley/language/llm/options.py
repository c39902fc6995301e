"""What goes along with a question to a model besides the question; what a provider refuses is left out."""

from __future__ import annotations

import re
from typing import Final, Literal, get_args

from pydantic_ai.settings import ModelSettings as RequestSettings

from parley.config import ModelSettings
from parley.language.llm.answers import TOOL
from parley.language.prompts import Kind

__all__ = ["SMALL_KINDS", "Option", "Options"]

SMALL_KINDS: Final[frozenset[Kind]] = frozenset({"select_memories", "ground", "read_reply"})
"""Questions with short answers."""

Option = Literal["top_p", "temperature", "penalties", "forced", "strict", "reasoning", "cache"]

_NAMED: Final[dict[Option, re.Pattern[str]]] = {
    "top_p": re.compile(r"top_p"),
    "temperature": re.compile(r"temperature"),
    "penalties": re.compile(r"penalty"),
    "forced": re.compile(r"tool_choice"),
    "reasoning": re.compile(r"reasoning|thinking|effort", re.IGNORECASE),
    "cache": re.compile(r"cache", re.IGNORECASE),
    "strict": re.compile(r"strict|schema", re.IGNORECASE),
}
"""How a refusal names an option. Of several that it names the first is left out: of `temperature` and `top_p`
a model keeps the former if it takes only one of them."""


class Options:
    """The options of one model, less those that it refused once.

    Args:
        settings: What is wished.
    """

    def __init__(self, settings: ModelSettings) -> None:
        self._settings = settings
        self._left = set(get_args(Option)) - self._unwished()

    def _unwished(self) -> set[Option]:
        own = self._settings
        absent: dict[Option, bool] = {
            "top_p": own.top_p is None,
            "temperature": own.temperature is None,
            "penalties": not (own.frequency_penalty or own.presence_penalty),
            "reasoning": own.reasoning is None,
            "forced": own.output != "tool",
            "strict": own.output == "prompted",
        }
        return {name for name, is_so in absent.items() if is_so}

    @property
    def strict(self) -> bool:
        """Whether the form of an answer is binding."""
        return "strict" in self._left

    def refused(self, said: str) -> Option | None:
        """Leave out, from now on, what a refusal is about; None if it is about nothing that is sent.

        Args:
            said: The refusal, in the provider's words.
        """
        found = next(
            (name for name, form in _NAMED.items() if name in self._left and form.search(said)), None
        )
        if found is not None:
            self._left.discard(found)
        return found

    def of(self, kind: Kind) -> RequestSettings:
        """What goes along with a question of this kind."""
        own, left = self._settings, self._left
        settings = RequestSettings(
            max_tokens=own.max_memory_tokens if kind in SMALL_KINDS else own.max_plan_tokens,
            timeout=own.timeout_s,
            max_retries=0,
        )
        if "temperature" in left and own.temperature is not None:
            settings["temperature"] = own.temperature
        if "top_p" in left and own.top_p is not None:
            settings["top_p"] = own.top_p
        if "penalties" in left and own.frequency_penalty:
            settings["frequency_penalty"] = own.frequency_penalty
        if "penalties" in left and own.presence_penalty:
            settings["presence_penalty"] = own.presence_penalty
        if "reasoning" in left and own.reasoning is not None:
            settings["thinking"] = False if own.reasoning == "off" else own.reasoning
        if "forced" in left:
            settings["tool_choice"] = [TOOL]
        if "cache" in left:
            settings["cache"] = True
        return settings
