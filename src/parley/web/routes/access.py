"""What every route gets handed in."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request
from fastapi.params import Depends as Dependency
from starlette.types import Scope

from parley.gate.table import Effect, verdict
from parley.messages.principal import Principal, person
from parley.web.backend import Backend
from parley.web.config import Module
from parley.web.problems import WebProblem
from parley.web.sessions import Session

__all__ = ["Author", "By", "Web", "may", "module", "principal_of"]


def _backend(request: Request) -> Backend:
    backend = request.app.state.backend
    assert isinstance(backend, Backend)
    return backend


def _author(request: Request) -> str:
    """How the person behind the request wants to be called; empty if that is not known."""
    session = request.scope.get("state", {}).get("session")
    return session.name if isinstance(session, Session) else ""


def principal_of(scope: Scope) -> Principal:
    """On whose account a request is made: a person at a page."""
    session = scope.get("state", {}).get("session")
    return person(session.name if isinstance(session, Session) else "", device="page")


def _by(request: Request) -> Principal:
    return principal_of(request.scope)


By = Annotated[Principal, Depends(_by)]
"""On whose account."""
Web = Annotated[Backend, Depends(_backend)]
Author = Annotated[str, Depends(_author)]


def may(effect: Effect) -> Dependency:
    """A dependency that refuses whoever may not do this; without roles everybody who is let in may."""

    def check(author: Author) -> None:
        if verdict(person(author, role="supervisor"), effect) != "allow":
            raise WebProblem(403, "You may not do that.", "Ask a supervisor.")

    return Dependency(check)


def module(name: Module) -> Dependency:
    """A dependency that refuses everything of a module that is switched off."""

    def check(web: Web) -> None:
        web.need(name)

    return Dependency(check)
