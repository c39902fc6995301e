"""What travels about a failure: from the action's log into the error handler (thesis 4.3.7, spec 12.6)."""

from __future__ import annotations

import json
from typing import Any

from pydantic import Field, ValidationError

from parley.errors import ActionFailure, FailureCode
from parley.messages.base import Payload
from parley.messages.chat import ActionCall

__all__ = ["ErrorHandlingMessage", "FailureReport"]


class FailureReport(Payload):
    """The JSON text that a failing action leaves as its last runtime message."""

    message: str
    process_instructions: str = Field(default="", alias="process_instrutions")
    """The thesis's (misspelt) key is what other programs read."""
    process_data_text: str = ""
    process_data_images: tuple[str, ...] = ()
    code: FailureCode = FailureCode.INTERNAL
    """Ours."""
    details: dict[str, Any] = Field(default_factory=dict)
    """Ours: facts for recovery, e.g. candidates."""

    @classmethod
    def of(cls, failure: ActionFailure) -> FailureReport:
        """The report of a failure that an action raised."""
        return cls(message=failure.message, code=failure.code, details=failure.details)

    @classmethod
    def parse(cls, text: str) -> FailureReport:
        """Read a runtime message: our JSON, the thesis's JSON, or any text at all.

        Of a report with a message, fields that do not fit (a code that we do not have) are passed over.
        """
        try:
            value = json.loads(text)
        except (ValueError, RecursionError):
            return cls(message=text)
        if not isinstance(value, dict) or not isinstance(value.get("message"), str):
            return cls(message=text)
        try:
            return cls.model_validate(value)
        except ValidationError as error:
            wrong = {item["loc"][0] for item in error.errors(include_url=False, include_input=False)}
            return cls.model_validate({key: item for key, item in value.items() if key not in wrong})

    def to_text(self) -> str:
        """The runtime message."""
        return self.model_dump_json(by_alias=True)


class ErrorHandlingMessage(Payload):
    """`error_handling_message`: planner -> error handler."""

    error_message: str
    action_called: ActionCall
    umrf_queue: tuple[ActionCall, ...] = ()
    """Pending actions behind the failed one."""
    target: str
    process_instructions: str = Field(default="", alias="process_instrutions")
    process_data_text: str = ""
    process_data_images: tuple[str, ...] = ()
    code: FailureCode = FailureCode.INTERNAL
    """Ours."""
    details: dict[str, Any] = Field(default_factory=dict)
    """Ours."""
    completed: tuple[ActionCall, ...] = ()
    """Ours: what was done before."""
    results: tuple[dict[str, Any], ...] = ()
    """Ours: what each of those gave, by name."""
    steps: tuple[str, ...] = ()
    """Ours: the ids, in the plan, of those pending."""
    order: str = ""
    """Ours: what a person said that they want with the step."""
    failure_id: str = ""
    """Ours: graph and node that failed; the same failure is never handled twice."""
