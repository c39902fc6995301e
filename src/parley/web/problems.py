"""Errors as people read them: every refusal is `application/problem+json` with what to do."""

from __future__ import annotations

import json
from http import HTTPStatus
from typing import Any, Final

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from parley.errors import (
    InvalidMessageError,
    ParleyError,
    StoreError,
    TransportError,
    TransportTimeoutError,
    UnavailableError,
)
from parley.sentences import SpokenLanguage
from parley.web.bodies import ProblemDetail
from parley.web.people.store import PeopleError
from parley.web.showing import language_of, shown_in

__all__ = ["RESPONSES", "WebProblem", "install", "problem_response"]

log = structlog.get_logger(__name__)

MEDIA_TYPE: Final = "application/problem+json"

RESPONSES: Final[dict[int | str, dict[str, Any]]] = {
    "default": {
        "model": ProblemDetail,
        "description": "It was not done, and why.",
        "content": {MEDIA_TYPE: {}},
    }
}

_TITLES: Final[dict[int, str]] = {
    400: "That could not be read",
    401: "Please sign in",
    403: "That is not allowed",
    404: "There is no such thing",
    405: "That cannot be done here",
    409: "That does not fit any more",
    413: "That is too large",
    422: "Something is missing or wrong",
    429: "Too much at once",
    500: "Something went wrong here",
    502: "The answer could not be read",
    503: "Not available at the moment",
    504: "No answer in time",
    507: "It could not be stored",
}


class WebProblem(ParleyError):  # noqa: N818 - an answer, not a defect of the program
    """A request is refused.

    Attributes:
        status: HTTP status.
        detail: What is wrong, in plain words.
        remedy: What to do about it.
        path: The field of the request, if it is one.
        headers: Headers that go with the answer.
    """

    def __init__(
        self,
        status: int,
        detail: str,
        remedy: str = "",
        *,
        path: str = "",
        headers: dict[str, str] | None = None,
    ) -> None:
        self.status, self.detail, self.remedy, self.path = status, detail, remedy, path
        self.headers = headers or {}
        super().__init__(detail)


def problem_response(problem: WebProblem, language: SpokenLanguage = "en") -> Response:
    """The answer that tells of a problem."""
    body = ProblemDetail(
        title=_TITLES.get(problem.status) or HTTPStatus(problem.status).phrase,
        status=problem.status,
        detail=problem.detail,
        remedy=problem.remedy,
        path=problem.path,
    )
    return Response(
        json.dumps(shown_in(language, body)),
        status_code=problem.status,
        media_type=MEDIA_TYPE,
        headers=problem.headers,
    )


def translate(error: ParleyError) -> WebProblem:
    """What a person is told about an error of ours, the most telling first."""
    match error:
        case WebProblem():
            return error
        case PeopleError():
            return WebProblem(409, str(error))
        case UnavailableError():
            return WebProblem(
                503, "The part of the system that knows this is not running.", "Try again later."
            )
        case TransportTimeoutError():
            return WebProblem(504, "The part of the system that knows this does not answer.", "Try again.")
        case InvalidMessageError():
            return WebProblem(502, "The answer could not be read.", "Look whether all parts are up to date.")
        case StoreError():
            return WebProblem(507, "It could not be stored.", "Look whether the disk is full.")
        case TransportError():
            return WebProblem(503, "The part of the system that knows this failed.", "Try again.")
    return WebProblem(500, "Something went wrong here.", "Try again.")


def _reader(request: Request) -> SpokenLanguage:
    return language_of(request.headers.get("accept-language", ""))


def install(app: FastAPI) -> None:
    """Answer everything that is refused in this form."""

    async def ours(request: Request, error: Exception) -> Response:
        problem = translate(error if isinstance(error, ParleyError) else ParleyError(str(error)))
        if problem.status >= 500:
            log.warning("request failed", status=problem.status, error=str(error))
        return problem_response(problem, _reader(request))

    async def invalid(request: Request, error: Exception) -> Response:
        assert isinstance(error, RequestValidationError)
        first = error.errors()[0]
        where = [str(part) for part in first["loc"]]
        path = ".".join(where[1:] if where[:1] in (["body"], ["query"], ["path"]) else where)
        if first["type"] == "json_invalid":
            return problem_response(WebProblem(400, "The request is not valid JSON."), _reader(request))
        text = f"{path or 'The request'}: {first['msg']}."
        problem = WebProblem(422, text, "Correct it and send it again.", path=path)
        return problem_response(problem, _reader(request))

    async def plain(request: Request, error: Exception) -> Response:
        assert isinstance(error, HTTPException)
        detail = {404: "There is nothing under this address.", 405: "This address does not take that."}
        text = detail.get(error.status_code, "That cannot be done.")
        headers = dict(error.headers or {})
        return problem_response(WebProblem(error.status_code, text, headers=headers), _reader(request))

    async def defect(request: Request, error: Exception) -> Response:
        log.error("request broke", path=request.url.path, exc_info=error)
        problem = WebProblem(500, "Something went wrong here.", "Try again.")
        return problem_response(problem, _reader(request))

    app.add_exception_handler(ParleyError, ours)
    app.add_exception_handler(RequestValidationError, invalid)
    app.add_exception_handler(HTTPException, plain)
    app.add_exception_handler(Exception, defect)
