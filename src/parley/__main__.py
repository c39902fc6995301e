"""Where the process starts, for ``parley`` and ``python -m parley``.

It imports nothing heavy before Ctrl-C is taken care of.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["main"]

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


@contextmanager
def ended_by_ctrl_c() -> Iterator[None]:
    """Let Ctrl-C end the process at once, without an exception.

    For the imports: an exception raised inside one may come out as something else (``dataclasses``
    and extension modules wrap it) or not at all. Nothing has been opened yet that could be lost.
    A process that was told to ignore Ctrl-C goes on ignoring it.
    """
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def main() -> None:
    """Run the command line and leave with its exit code."""
    try:
        with ended_by_ctrl_c():
            from parley.cli import command_line, run

            app = command_line(next(iter(sys.argv[1:]), None))
        code = run(app)
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


if __name__ == "__main__":
    main()
