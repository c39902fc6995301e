"""Why a node failed, as the log line that planners and people read (12.6)."""

from __future__ import annotations

import asyncio

from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport
from parley.umrf.text import clean_text

__all__ = ["failure_text", "is_report"]


def failure_text(action: str, error: BaseException) -> str:
    """The runtime message for what the action of that name raised."""
    if isinstance(error, ActionFailure):
        try:
            return FailureReport.of(error).to_text()
        except ValueError:  # its details are not what JSON can hold; the code and the sentence still count
            return FailureReport(message=clean_text(str(error.message)), code=error.code).to_text()
    if isinstance(error, asyncio.CancelledError):
        return FailureReport(message=f"{action} was cancelled from inside.").to_text()
    text = f"{action} failed: {type(error).__name__}: {error}".rstrip(": ")
    return FailureReport(message=clean_text(text), code=FailureCode.INTERNAL).to_text()


def is_report(text: str) -> bool:
    """Whether a log line is a failure report in the thesis's form, left by the action itself."""
    return text.lstrip().startswith("{") and FailureReport.parse(text).message != text
