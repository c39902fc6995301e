"""A network of each backend."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest

from tests.transport.backends import BACKENDS, Network, each


@pytest.fixture(params=each())
async def network(request: pytest.FixtureRequest) -> AsyncIterator[Network]:
    async with BACKENDS[request.param]() as parties:
        yield parties
