"""Log entries on the way of a stop: they never keep it from going on."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import structlog

__all__ = ["note"]

log = structlog.get_logger("parley.gate")


def note(event: str, **facts: Any) -> None:
    """Log an error, unless the log itself cannot be written, as on the disk whose being full it tells of."""
    with suppress(OSError, ValueError):
        log.error(event, **facts)
