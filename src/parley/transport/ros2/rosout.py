"""What is logged, as ROS shows it: on `/rosout`, and where ROS writes."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any, Final, NoReturn

import structlog

__all__ = ["log_to_ros"]

_SILENT: Final = {"event", "level", "timestamp", "exc_info", "stack_info"}


def log_to_ros(node: Any) -> Callable[[], None]:
    """Let ROS decide what of the log is shown, and where; returns how to stop that."""
    before = structlog.get_config()
    *processors, _ = before["processors"]
    structlog.configure(
        processors=[*processors, _Rosout(node.get_logger())],
        wrapper_class=structlog.make_filtering_bound_logger("debug"),
    )
    return lambda: structlog.configure(**before)


class _Rosout:
    def __init__(self, logger: Any) -> None:
        self._logger = logger

    def __call__(self, _: Any, method: str, told: structlog.typing.EventDict) -> NoReturn:
        facts = (f"{name}={value!r}" for name, value in told.items() if name not in _SILENT)
        text = " ".join([str(told.get("event", "")), *facts])
        match told.get("exc_info"):
            case BaseException() as error:
                text += "\n" + "".join(traceback.format_exception(error)).rstrip()
            case True:
                text += "\n" + traceback.format_exc().rstrip()
            case (_, BaseException() as error, _):
                text += "\n" + "".join(traceback.format_exception(error)).rstrip()
        # ROS wants one severity for each place in code.
        match method:
            case "debug":
                self._logger.debug(text)
            case "info":
                self._logger.info(text)
            case "warning" | "warn":
                self._logger.warning(text)
            case "critical" | "fatal":
                self._logger.fatal(text)
            case _:
                self._logger.error(text)
        raise structlog.DropEvent
