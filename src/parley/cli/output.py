"""How commands speak: one place for JSON lines, plain lines and errors."""

from __future__ import annotations

import json
import sys
from typing import Any

import typer

__all__ = ["emit_json", "fail", "quiet_logs"]


def emit_json(value: Any) -> None:
    """Print one JSON line, at once."""
    typer.echo(json.dumps(value, ensure_ascii=False))
    sys.stdout.flush()


def quiet_logs(verbose: bool = False) -> None:
    """See `parley.logs.quiet_logs`, which takes a while to load."""
    from parley.logs import quiet_logs as quiet

    quiet(verbose)


def fail(text: str, code: int = 2) -> int:
    """Print what is wrong on the error stream and give the exit code back."""
    typer.echo(f"parley: {text}", err=True)
    return code
