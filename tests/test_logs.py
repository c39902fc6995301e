"""What is read on the error stream when code fails."""

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


@pytest.mark.parametrize(("verbose", "traces"), [(False, False), (True, False), (False, True)])
def test_an_error_is_logged_without_values_that_code_had_in_hand_and_for_operators_in_a_line(
    capsys: pytest.CaptureFixture[str], verbose: bool, traces: bool
) -> None:
    quiet_logs(verbose, traces=traces)
    key = "sesame-" + "open"
    try:
        raise ValueError(f"no answer to {len(key)} characters")
    except ValueError as error:
        structlog.get_logger().error("action raised", node="Look_1", exc_info=error)
    told = capsys.readouterr().err
    assert "node=Look_1" in told
    assert "ValueError: no answer to 11 characters" in told
    assert "test_logs.py" in told
    assert "sesame-open" not in told
    assert ("Traceback" in told) is (verbose or traces)
    assert verbose or traces or len(told.splitlines()) == 1
