"""What is logged, and where to: the error stream, and no more than somebody asked for."""

from __future__ import annotations

import logging
import sys
from contextlib import suppress

import structlog

__all__ = ["quiet_logs"]


class _Forgiving(structlog.PrintLogger):
    """Loses what cannot be written: a full disk must not end what only wanted to tell of it."""

    def msg(self, message: str) -> None:
        with suppress(OSError):
            super().msg(message)

    log = debug = info = warn = warning = fatal = failure = err = error = critical = exception = msg


def quiet_logs(verbose: bool = False) -> None:
    """Send logs to the error stream: warnings for engineers who ask for them, else errors only.

    Where code failed is written without the values that it had in hand: they may be secret, and laying them
    out keeps the loop for a tenth of a second and more.
    """
    level = logging.INFO if verbose else logging.ERROR
    *before, _ = structlog.get_config()["processors"]
    shown = structlog.dev.ConsoleRenderer(
        colors=sys.stderr.isatty(), exception_formatter=structlog.dev.plain_traceback
    )
    structlog.configure(
        processors=[*before, shown],
        wrapper_class=structlog.make_filtering_bound_logger(level),
        # The stream as it is when something is logged: whoever runs commands in one process may exchange it.
        logger_factory=lambda *_: _Forgiving(sys.stderr),
    )
