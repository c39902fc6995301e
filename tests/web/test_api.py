"""All routes against made-up requests: whatever comes, no answer is a defect, and each is as described."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, settings
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import response_schema_conformance, status_code_conformance

from parley.agents.memory import MemoryNode
from parley.language.builtin.engine import BuiltinLanguage
from parley.memory.store import MemoryStore
from parley.web.app import create_api
from tests.web.rig import served


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    """A server in a loop of its own, for a client that blocks."""
    found: list[str] = []
    ready = threading.Event()
    loop = asyncio.new_event_loop()
    done = asyncio.Event()

    async def serve() -> None:
        async with (
            served("Ada", "Bob") as rig,
            await MemoryStore.open(":memory:") as store,
            MemoryNode(rig.robots.transport, store, BuiltinLanguage()),
        ):
            found.append(rig.url)
            ready.set()
            await done.wait()

    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()), name="served")
    thread.start()
    assert ready.wait(20)
    yield found[0]
    loop.call_soon_threadsafe(done.set)
    thread.join()
    loop.close()


schema = schemathesis.openapi.from_dict(create_api().openapi()).exclude(
    # The first account would end this visit for all that follows; tests/web/test_people.py makes accounts.
    path="/api/people",
    method="POST",
)


@schema.parametrize()
@settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck))
def test_no_request_breaks_the_server(case: schemathesis.Case[Any], url: str) -> None:
    response = case.call(base_url=url)
    if response.status_code in (429, 503, 504):
        return
    case.validate_response(
        response, checks=[not_a_server_error, response_schema_conformance, status_code_conformance]
    )
