"""What every route gets handed in."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Request
from fastapi.params import Depends as Dependency

from parley.gate.table import Effect, verdict
from parley.messages.principal import person
from parley.web.backend import Backend
from parley.web.config import Module
from parley.web.problems import WebProblem
from parley.web.sessions import Session

__all__ = ["Author", "Web", "may", "module"]


def _backend(request: Request) -> Backend:
    backend = request.app.state.backend
    assert isinstance(backend, Backend)
    return backend


def _author(request: Request) -> str:
    """How the person behind the request wants to be called; empty if that is not known."""
    session = request.scope.get("state", {}).get("session")
    return session.name if isinstance(session, Session) else ""


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
