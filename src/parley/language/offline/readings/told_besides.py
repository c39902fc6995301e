"""Where things are told to be beside an order: kept also where a message is read by its orders alone."""

from __future__ import annotations

import re
from collections.abc import Sequence

from parley.language.offline.sentences.units import Unit
from parley.language.offline.words.text import keys, tokens
from parley.messages.chat import ChatAction, SystemCommand

__all__ = ["with_what_is_told"]


def with_what_is_told(action: ChatAction, first: ChatAction, parts: Sequence[Unit]) -> ChatAction:
    """A plan with the places of things that another reading of the same message remembered.

    Args:
        action: What is to be done.
        first: What comes of the message as it is said.
        parts: The parts of the message.
    """
    if action is first or not action.queue or action.system_cmd:
        return action
    places = [" ".join(keys(name)) for unit in parts if unit.kind == "told" for name in unit.names]
    kept = tuple(command for command in first.system_cmd if _says_where(command, places))
    if not kept:
        return action
    said = re.findall(_REMEMBERED, first.message_response)
    text = " ".join([*(one for one in said if _names(one, places)), action.message_response])
    return action.model_copy(update={"system_cmd": kept, "message_response": text})


_REMEMBERED = r"I will remember that [^.]*\."


def _says_where(command: SystemCommand, places: Sequence[str]) -> bool:
    """Whether it keeps where something is, in a place that is told."""
    name, text = (str(command.arguments.get(part, "")) for part in ("name", "data"))
    return command.command == "add_memory" and name.endswith("_location") and _names(text, places)


def _names(text: str, places: Sequence[str]) -> bool:
    said = " ".join(key for key in keys(tokens(text.lower())) if key.isalnum())
    return any(said.endswith(place) for place in places)
