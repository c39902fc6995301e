"""Where the process starts, for ``parley`` and ``python -m parley``.

It imports nothing that takes time before Ctrl-C is taken care of.
"""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # what signal is made of: that one takes a tenth of the start
import os
import sys

__all__ = ["main"]


def main() -> None:
    """Run the command line and leave with its exit code.

    Ctrl-C and SIGTERM end the process at once, without an exception: raised inside an import it may come out
    as something else, or not at all, and nothing has been opened yet that could be lost. Where something is
    open, `parley.cli.on_loop` closes it first. Who was told to ignore them goes on ignoring them.
    """
    for number in (_signal.SIGINT, _signal.SIGTERM):
        if _signal.getsignal(number) != _signal.SIG_IGN:
            _signal.signal(number, _end_at_once)
    from parley.cli import command_line, run

    sys.exit(run(command_line()))


def _end_at_once(number: int, _: object) -> None:
    os._exit(128 + number)  # as shells have it


if __name__ == "__main__":
    main()
