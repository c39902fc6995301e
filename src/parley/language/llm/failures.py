"""What can go wrong when a model is asked, sorted: who is told what, and whether trying again may help."""

from __future__ import annotations

from typing import Final

from pydantic_ai.exceptions import (
    AgentRunError,
    ContentFilterError,
    ModelAPIError,
    ModelAuthenticationError,
    ModelHTTPError,
    ModelQuotaExceededError,
    ModelRateLimitError,
    ModelRequestRejectedError,
    OutputTokenLimitExceeded,
    UnexpectedModelBehavior,
)

from parley.errors import LanguageError
from parley.language.llm.bounded import AnswerTooLongError

__all__ = ["DeclinedError", "ModelFailedError", "UnusableError", "sorted_failure"]

LONGEST_WAIT_S: Final = 10.0
"""A provider that asks for a longer pause is not asked again for this answer."""


class ModelFailedError(LanguageError):
    """The model could not be reached, or gave an error instead of an answer.

    Attributes:
        may_help: Whether trying again may help.
        wait_s: How long the provider asks to wait first, if it says.
        rejected: Whether the question itself was refused, e.g. for what it holds.
    """

    def __init__(
        self,
        message: str,
        *,
        plain: str,
        may_help: bool = True,
        wait_s: float | None = None,
        rejected: bool = False,
    ) -> None:
        self.may_help, self.wait_s, self.rejected = may_help, wait_s, rejected
        super().__init__(message, plain=plain)


class UnusableError(LanguageError):
    """The model answered, but not in a way that can be used."""


class DeclinedError(LanguageError):
    """The model declined to answer; no other engine is asked instead."""


def sorted_failure(error: Exception, text: str) -> LanguageError:
    """The failure behind what the library raised.

    Args:
        error: What was raised.
        text: Its text, without secrets.
    """
    if (too_long := _too_long(error)) is not None:
        told = text if str(too_long) in text else f"{text}: {too_long}"
        return UnusableError(told, plain="My language service gave an answer that is too long.")
    if isinstance(error, ContentFilterError):
        return DeclinedError(text, plain="My language service declined to answer that.")
    if isinstance(error, OutputTokenLimitExceeded):
        return UnusableError(text, plain="My language service gave an answer that was cut off.")
    if isinstance(error, ModelAPIError):
        return _failed(error, text)
    if isinstance(error, UnexpectedModelBehavior | AgentRunError):
        return UnusableError(text, plain="My language service gave no answer that I can use.")
    return ModelFailedError(text, plain="My language service gave no answer that I can read.")


def _too_long(error: BaseException | None) -> AnswerTooLongError | None:
    """What lies behind the errors of the libraries, if it is that."""
    while error is not None and not isinstance(error, AnswerTooLongError):
        error = error.__cause__ or error.__context__
    return error


def _failed(error: ModelAPIError, text: str) -> ModelFailedError:
    status = error.status_code if isinstance(error, ModelHTTPError) else None
    if isinstance(error, ModelAuthenticationError) or status in (401, 403):
        plain = "My language service does not accept its key; whoever set me up has to look into that."
        return ModelFailedError(text, plain=plain, may_help=False)
    if isinstance(error, ModelQuotaExceededError):
        plain = "My language service has no credit left; whoever set me up has to look into that."
        return ModelFailedError(text, plain=plain, may_help=False)
    if isinstance(error, ModelRateLimitError) or status == 429:
        wait_s = error.retry_after
        patient = wait_s is None or wait_s <= LONGEST_WAIT_S
        plain = "My language service is too busy at the moment."
        return ModelFailedError(text, plain=plain, may_help=patient, wait_s=wait_s)
    rejected = isinstance(error, ModelRequestRejectedError)
    plain = "My language service does not answer at the moment."
    return ModelFailedError(
        text, plain=plain, may_help=not rejected, wait_s=error.retry_after, rejected=rejected
    )
