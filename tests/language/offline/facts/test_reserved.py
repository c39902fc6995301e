"""What is forbidden but for a condition is a rule to keep, and nothing to do now."""

from __future__ import annotations

import asyncio

import pytest

from parley.language.offline import OfflineLanguage
from tests.language.dev_set import situation


@pytest.mark.parametrize("message", [
    "Never go to the fridge without asking me.",
    "Never ever drive to the fridge without my permission.",
    "Do not inspect the TV unless I tell you to.",
    "Don't go to the TV unless I am there.",
    "Only inspect the TV if Mary asks you to.",
    "Always ask me before you go to the fridge.",
])  # fmt: skip
def test_what_is_reserved_is_kept_and_not_done(message: str) -> None:
    action = asyncio.run(OfflineLanguage().interpret(situation("home", message)))
    assert [command.command for command in action.system_cmd] == ["add_memory"]
    assert not action.queue
    assert "I will remember that: " in action.message_response


@pytest.mark.parametrize("message", [
    "Do not go to the TV, go to the fridge.",
    "Inspect the TV only if it is on.",
    "Go to the fridge without stopping.",
])  # fmt: skip
def test_an_order_with_a_condition_that_can_be_looked_at_is_no_rule(message: str) -> None:
    action = asyncio.run(OfflineLanguage().interpret(situation("home", message)))
    assert not action.system_cmd
