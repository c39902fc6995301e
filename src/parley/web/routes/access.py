"""What every route gets handed in, and the one place that lets people do things or not."""

from __future__ import annotations

from typing import Annotated, Any, Final

from fastapi import Depends, Request
from fastapi.params import Depends as Dependency
from starlette.types import Scope

from parley.gate.table import Effect, verdict
from parley.messages.audit import AuditEvent
from parley.messages.principal import Principal
from parley.web.backend import Backend
from parley.web.config import Module
from parley.web.people.records import Device, gadget_of
from parley.web.problems import WebProblem
from parley.web.sessions import Sessions, Visitor, cookie_name

__all__ = [
    "Caller",
    "ThisDevice",
    "ThisVisitor",
    "Web",
    "Who",
    "anybody",
    "effects_of",
    "may",
    "module",
    "principal_of",
]

_WORDS: Final[dict[Effect, str]] = {
    Effect.SPEAK: "speak to robots",
    Effect.RESET: "release a stop",
    Effect.RESUME: "let robots go on",
    Effect.APPROVE: "say yes to plans",
    Effect.REJECT: "say no to plans",
    Effect.EDIT: "change plans",
    Effect.CLEAR: "give up plans",
    Effect.REMEMBER: "change memories",
    Effect.FORGET: "remove memories",
    Effect.POLICY: "choose when robots ask",
    Effect.SETTING: "change settings",
    Effect.PEOPLE: "manage people",
    Effect.AUDIT: "read who did what",
    Effect.RULE: "change rules",
    Effect.MAP: "put names on the map",
}


def _backend(request: Request) -> Backend:
    backend = request.app.state.backend
    assert isinstance(backend, Backend)
    return backend


def _device(request: Request) -> Device | None:
    session = request.scope.get("state", {}).get("session")
    return session if isinstance(session, Device) else None


def _visitor(request: Request) -> Visitor:
    address = request.client.host if request.client else ""
    before = request.cookies.get(cookie_name(https=request.url.scheme == "https"), "")
    return Visitor(gadget_of(request.headers.get("user-agent", ""), address), before)


Web = Annotated[Backend, Depends(_backend)]
ThisDevice = Annotated[Device | None, Depends(_device)]
ThisVisitor = Annotated[Visitor, Depends(_visitor)]


def principal_of(sessions: Sessions, scope: Scope) -> Principal | None:
    """On whose account a request or socket is; None: somebody who is not signed in where one has to be."""
    device = scope.get("state", {}).get("session")
    agent = next((value for name, value in scope["headers"] if name == b"user-agent"), b"").decode("latin-1")
    gadget = gadget_of(agent, str((scope.get("client") or ("",))[0]))
    return sessions.principal(device if isinstance(device, Device) else None, gadget)


class Caller:
    """Whoever is behind a request.

    Args:
        web: The server.
        by: On whose account; None: somebody who is not signed in where one has to.
    """

    def __init__(self, web: Backend, by: Principal | None) -> None:
        self._web, self._by = web, by

    @property
    def by(self) -> Principal:
        """On whose account it happens.

        Raises:
            WebProblem: They are not signed in.
        """
        if self._by is None:
            raise WebProblem(401, "You are not signed in.", "Sign in first.")
        return self._by

    def may(self, effect: Effect) -> bool:
        """Whether they may do something."""
        return self._by is not None and verdict(self._by, effect) == "allow"

    def note(self, effect: Effect, words: str) -> None:
        """Have it remembered that they did something that no other message tells of."""
        now_ms = self._web.clock.unix_ms()
        self._web.sessions.tell(AuditEvent(effect=effect, by=self.by, words=words, unix_ms=now_ms))

    def need(self, effect: Effect) -> None:
        """Refuse what they may not do.

        Raises:
            WebProblem: They may not.
        """
        if self.may(effect):
            return
        role, words = self.by.role, _WORDS.get(effect, effect.value)
        detail = f"As {'an' if role == 'operator' else 'a'} {role} you may not {words}."
        self._web.sessions.tell(
            AuditEvent(
                effect=effect, by=self.by, outcome="refused", reason=detail, unix_ms=self._web.clock.unix_ms()
            )
        )
        raise WebProblem(403, detail, "Ask a supervisor.")


def _caller(web: Web, device: ThisDevice, visitor: ThisVisitor) -> Caller:
    return Caller(web, web.sessions.principal(device, visitor.gadget))


Who = Annotated[Caller, Depends(_caller)]


class _May:
    """Lets a request in whose person may do one of these; what exactly is wanted the route says itself."""

    def __init__(self, effects: tuple[Effect, ...]) -> None:
        self.effects = effects

    def __call__(self, who: Who) -> None:
        if self.effects and not any(who.may(effect) for effect in self.effects):
            who.need(self.effects[0])


def may(*effects: Effect) -> Dependency:
    """What a route does. With several it says by `Caller.need` which one a request is about."""
    return Dependency(_May(effects))


anybody: Final = Dependency(_May(()))
"""For what one does before signing in."""


def effects_of(route: Any) -> tuple[Effect, ...] | None:
    """What a route says that it does; empty: it is for everybody; None: it does not say."""
    found = [each.call for each in route.dependant.dependencies if isinstance(each.call, _May)]
    return found[0].effects if found else None


def module(name: Module) -> Dependency:
    """A dependency that refuses everything of a module that is switched off."""

    def check(web: Web) -> None:
        web.need(name)

    return Dependency(check)
