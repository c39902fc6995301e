"""What is logged, and where to: the error stream, and no more than somebody asked for."""

from __future__ import annotations

import logging
import sys
import traceback
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TextIO

import structlog

__all__ = ["quiet_logs"]


class _Forgiving(structlog.PrintLogger):
    """Loses what cannot be written: a full disk must not end what only wanted to tell of it."""

    def msg(self, message: str) -> None:
        with suppress(OSError):
            super().msg(message)

    log = debug = info = warn = warning = fatal = failure = err = error = critical = exception = msg


def quiet_logs(verbose: bool = False, *, traces: bool = False) -> None:
    """Send logs to the error stream: warnings for engineers who ask for them, else errors only.

    Where code failed is one line for operators, who read the same terminal, else a trace: without the values
    that code had in hand, which may be secret, and keep the loop for a tenth of a second to be laid out.

    Args:
        verbose: An engineer asks for all.
        traces: A program's author reads the errors.
    """
    level = logging.INFO if verbose else logging.ERROR
    *before, _ = structlog.get_config()["processors"]
    formatter = structlog.dev.plain_traceback if verbose or traces else _in_a_line
    shown = structlog.dev.ConsoleRenderer(colors=sys.stderr.isatty(), exception_formatter=formatter)
    structlog.configure(
        processors=[*before, shown],
        wrapper_class=structlog.make_filtering_bound_logger(level),
        # The stream as it is when something is logged: whoever runs commands in one process may exchange it.
        logger_factory=lambda *_: _Forgiving(sys.stderr),
    )


def _in_a_line(out: TextIO, failed: tuple[type[BaseException], BaseException, TracebackType | None]) -> None:
    kind, error, trace = failed
    text = " ".join("".join(traceback.format_exception_only(kind, error)).split())
    at = traceback.extract_tb(trace)[-1:]
    out.write(f"  {text}" + "".join(f" ({Path(place.filename).name}, line {place.lineno})" for place in at))
