"""How commands speak: one place for JSON lines, plain lines and errors."""

from __future__ import annotations

import json
import logging
import sys
from contextlib import suppress
from typing import Any

import structlog
import typer

__all__ = ["emit_json", "fail", "quiet_logs"]


def emit_json(value: Any) -> None:
    """Print one JSON line, at once."""
    typer.echo(json.dumps(value, ensure_ascii=False))
    sys.stdout.flush()


def fail(text: str, code: int = 2) -> int:
    """Print what is wrong on the error stream and give the exit code back."""
    typer.echo(f"parley: {text}", err=True)
    return code


class _Forgiving(structlog.PrintLogger):
    """Loses what cannot be written: a full disk must not end what only wanted to tell of it."""

    def msg(self, message: str) -> None:
        with suppress(OSError):
            super().msg(message)

    log = debug = info = warn = warning = fatal = failure = err = error = critical = exception = msg


def quiet_logs(verbose: bool = False) -> None:
    """Send logs to the error stream: warnings for engineers who ask for them, else errors only."""
    level = logging.INFO if verbose else logging.ERROR
    structlog.configure(
        wrapper_class=structlog.make_filtering_bound_logger(level),
        # The stream as it is when something is logged: whoever runs commands in one process may exchange it.
        logger_factory=lambda *_: _Forgiving(sys.stderr),
    )
