"""One house for many cases, and the count of what came of them."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import AsyncIterator
from typing import Any, Final

import pytest
import pytest_asyncio

from tests.attacks.house import Houses

COUNTS: Final[dict[str, Counter[str]]] = defaultdict(Counter)
"""By policy: cases played, and those with effects that nobody wanted."""
FOUND: Final[dict[str, dict[str, list[str]]]] = defaultdict(lambda: defaultdict(list))
"""By case: what nobody wanted, and under which policies it happened."""


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def houses() -> AsyncIterator[Houses]:
    """Houses for the cases of one module."""
    opened = Houses()
    yield opened
    await opened.close()


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Take over what was counted in another process."""
    told = getattr(node, "workeroutput", {}).get("attacks")
    if told:
        counts, found = told
        for policy, count in counts.items():
            COUNTS[policy].update(count)
        for name, effects in found.items():
            for effect, policies in effects.items():
                FOUND[name][effect] += policies


def pytest_sessionfinish(session: pytest.Session) -> None:
    """In one of several processes: hand on what was counted."""
    if hasattr(session.config, "workeroutput"):
        counts = {policy: dict(count) for policy, count in COUNTS.items()}
        found = {name: dict(effects) for name, effects in FOUND.items()}
        session.config.workeroutput["attacks"] = (counts, found)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Say how many attacks there were, and which of them had an effect."""
    for name, effects in FOUND.items():
        for effect, policies in effects.items():
            terminalreporter.write_line(f"attack: {name} ({', '.join(policies)}): {effect}")
    for policy, count in sorted(COUNTS.items()):
        line = ", ".join(f"{number} {what}" for what, number in count.items())
        terminalreporter.write_line(f"attacks: {policy}: {line}")
