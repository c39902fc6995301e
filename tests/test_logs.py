"""What engineers read on the error stream."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import structlog

from parley.logs import quiet_logs


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    before = structlog.get_config()
    yield
    structlog.configure(**before)


def test_an_error_is_logged_without_the_values_that_code_had_in_hand(
    capsys: pytest.CaptureFixture[str],
) -> None:
    quiet_logs()
    key = "sesame-" + "open"
    try:
        raise ValueError(f"no answer to {len(key)} characters")
    except ValueError as error:
        structlog.get_logger().error("action raised", node="Look_1", exc_info=error)
    told = capsys.readouterr().err
    assert "node=Look_1" in told
    assert "ValueError: no answer to 11 characters" in told
    assert "sesame-open" not in told
