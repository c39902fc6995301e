"""Why a node failed, as the log line that planners and people read (12.6)."""

from __future__ import annotations

import asyncio

import structlog

from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport
from parley.messages.plain import in_words
from parley.umrf.model import Node
from parley.umrf.text import clean_text

__all__ = [
    "failure_lines",
    "failure_text",
    "harmless",
    "is_report",
    "overdue_text",
    "raised_text",
    "stop_timed_out_text",
    "text_of",
]

log = structlog.get_logger(__name__)


def failure_lines(graph_name: str, node: Node, error: BaseException, last_log: str) -> list[str]:
    """What is to be the newest log line of a node that failed, where planners look for it (12.6).

    None if it is there already: an action in the reference's style logs its report itself and raises
    anything; then that one counts.
    """
    if not isinstance(error, ActionFailure | asyncio.CancelledError):
        log.error("action raised", graph=graph_name, node=node.full_name, exc_info=error)
        if is_report(last_log):
            return []
    return [failure_text(node.name, error)]


def failure_text(action: str, error: BaseException) -> str:
    """The runtime message for what the action of that name raised."""
    if isinstance(error, ActionFailure):
        try:
            return FailureReport.of(error).to_text()
        except ValueError:  # its details are not what JSON can hold; the code and the sentence still count
            return FailureReport(message=text_of(error.message), code=error.code).to_text()
    if isinstance(error, asyncio.CancelledError):
        return FailureReport(message=f"{in_words(action).capitalize()} was cancelled from inside.").to_text()
    return FailureReport(message=raised_text(action, error), code=FailureCode.INTERNAL).to_text()


def raised_text(action: str, error: BaseException) -> str:
    """What people read of a defect: a question may follow."""
    what = in_words(action).capitalize()
    return f"{what} failed: {type(error).__name__}: {text_of(error)}".rstrip(": .") + "."


def harmless(error: BaseException) -> BaseException:
    """What an action raised, as what does not end the process; a person's Ctrl-C never reaches an action."""
    if isinstance(error, SystemExit):
        return RuntimeError(f"it called exit({error.code})")
    return RuntimeError("it raised KeyboardInterrupt") if isinstance(error, KeyboardInterrupt) else error


def text_of(told: object) -> str:
    """What an action raised, in its own words; it may fail at saying so, too."""
    try:
        return clean_text(str(told))
    except Exception as error:
        log.exception("an error cannot say why", kind=type(told).__name__)
        return f"({type(error).__name__} while saying why)"


def stop_timed_out_text(action: str, timeout_s: float) -> str:
    """The runtime message for an action that did not stop."""
    message = f"{in_words(action).capitalize()} did not stop within {timeout_s:g} s."
    return FailureReport(message=message, code=FailureCode.TIMED_OUT).to_text()


def overdue_text(action: str) -> str:
    """The runtime message for an action that goes on after its time-out."""
    message = f"{in_words(action).capitalize()} did not end when its time was over."
    return FailureReport(message=message, code=FailureCode.TIMED_OUT).to_text()


def is_report(text: str) -> bool:
    """Whether a log line is a failure report in the thesis's form, left by the action itself."""
    return text.lstrip().startswith("{") and FailureReport.parse(text).message != text
