"""Where the process starts, for ``parley`` and ``python -m parley``.

It imports nothing heavy before Ctrl-C is taken care of.
"""

from __future__ import annotations

import sys

__all__ = ["main"]

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


def main() -> None:
    """Run the command line and leave with its exit code."""
    try:
        from parley.cli import run

        code = run()
    except KeyboardInterrupt:
        code = INTERRUPTED
    sys.exit(code)


if __name__ == "__main__":
    main()
