"""Each request and each event of the live stream against everybody who might send it.

The requests are taken from the app's own routes: one that is new fails here until it is said what it does.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import httpx
import pytest
import socketio
from fastapi.routing import RouteContext, iter_route_contexts

from parley.gate.table import Effect, verdict
from parley.messages.principal import ROLES, person
from parley.web.app import create_api
from parley.web.routes.access import effects_of
from tests.web.rig import Page, Rig, served

PASSWORD = "correct horse battery"
WHO = ("nobody", *ROLES)

BODIES: dict[tuple[str, str], list[tuple[Any, Effect]]] = {
    ("POST", "/api/chat"): [
        ({"id": "m1", "text": "hello", "targets": ["Ada"]}, Effect.SPEAK),
        ({"id": "m2", "text": "stop! there is a child", "targets": ["Ada"]}, Effect.STOP),
    ],
    ("POST", "/api/stop"): [({"command": "stop"}, Effect.STOP), ({"command": "reset"}, Effect.RESET)],
    ("POST", "/api/plans/{robot}/command"): [
        ({"command": "pause"}, Effect.PAUSE),
        ({"command": "resume"}, Effect.RESUME),
        ({"command": "skip"}, Effect.EDIT),
        ({"command": "clear"}, Effect.CLEAR),
        ({"command": "pop", "index": 0}, Effect.EDIT),
    ],
    ("POST", "/api/plans/{robot}/decision"): [
        ({"id": "p1", "decision": "approve"}, Effect.APPROVE),
        ({"id": "p1", "decision": "reject"}, Effect.REJECT),
        ({"id": "p1", "decision": "edit", "steps": []}, Effect.APPROVE),
    ],
    ("POST", "/api/missions/{identity}/command"): [
        ({"command": "pause"}, Effect.PAUSE),
        ({"command": "resume"}, Effect.RESUME),
        ({"command": "clear"}, Effect.CLEAR),
        ({"command": "approve"}, Effect.APPROVE),
        ({"command": "reject"}, Effect.REJECT),
    ],
    ("PUT", "/api/plans/{robot}/policy"): [({"policy": "ask_first"}, Effect.POLICY)],
    ("PUT", "/api/plans/{robot}/steps"): [({"steps": [], "revision": 0}, Effect.EDIT)],
    ("POST", "/api/robots"): [({"name": "Kim's cart"}, Effect.SETTING)],
    ("PUT", "/api/memory"): [({"data": "the box is red"}, Effect.REMEMBER)],
    ("PUT", "/api/models"): [({"language": "auto:ollama:none"}, Effect.SETTING)],
    ("PUT", "/api/favourites"): [({"words": "go to the box"}, Effect.SPEAK)],
    ("PUT", "/api/push"): [({"endpoint": "https://localhost/", "p256dh": "x", "auth": "x"}, Effect.SEE)],
    ("PUT", "/api/rules/{rule_id}"): [
        ({"id": "r1", "name": "hall", "kind": "keep_out", "rectangle": [0, 0, 1, 1]}, Effect.RULE)
    ],
    ("POST", "/api/rules/words"): [
        ({"id": "r1", "name": "hall", "kind": "keep_out", "rectangle": [0, 0, 1, 1]}, Effect.RULE)
    ],
    ("POST", "/api/rules/try"): [({"robot": "Ada", "goal": [1.0, 1.0]}, Effect.SEE)],
    ("POST", "/api/map/{robot}/places"): [
        ({"put": {"name": "hall", "corners": [[0, 0], [1, 0], [1, 1]]}}, Effect.MAP)
    ],
    ("PUT", "/api/map/{robot}/file"): [({"classes": [], "items": {}}, Effect.MAP)],
    ("PUT", "/api/me/password"): [({"old": "wrong", "new": PASSWORD}, Effect.SEE)],
    ("POST", "/api/me/passkeys"): [({"id": "x", "name": "key", "credential": {}}, Effect.SEE)],
    ("POST", "/api/people"): [({"name": "new", "password": "short"}, Effect.PEOPLE)],
    ("PUT", "/api/people/{name}"): [({"disabled": False}, Effect.PEOPLE)],
    ("POST", "/api/people/code"): [({"role": "viewer"}, Effect.PEOPLE)],
}
"""Bodies of requests that have one, and what each of them does."""

ROUTES = [route for route in iter_route_contexts(create_api().routes) if route.path != "/api/openapi.json"]
LAST = ("/api/me/devices",)
"""Ends the visit of whoever is allowed to send it, so it is sent in the end."""


def in_the_end(route: RouteContext) -> bool:
    return route.path in LAST


def requests() -> list[tuple[str, str, Any, Effect]]:
    """Everything that one can send after signing in: method, path, body, effect."""
    found: list[tuple[str, str, Any, Effect]] = []
    for route in sorted(ROUTES, key=in_the_end):
        effects, path = effects_of(route), str(route.path)
        if not effects:
            continue
        for method in route.methods or ():
            if route.body_field is None:
                (effect,) = effects
                found.append((method, path, None, effect))
                continue
            variants = BODIES[method, path]
            assert {effect for _, effect in variants} == set(effects), f"{method} {path}"
            found += [(method, path, body, effect) for body, effect in variants]
    return found


def test_every_route_says_what_it_does() -> None:
    assert [route.path for route in ROUTES if effects_of(route) is None] == []


def test_only_signing_in_and_health_are_for_everybody() -> None:
    assert {route.path for route in ROUTES if effects_of(route) == ()} == {
        "/api/health",
        "/api/session",
        "/api/session/passkey",
        "/api/session/passkey/options",
    }


async def accounts(rig: Rig) -> dict[str, dict[str, str]]:
    """One account of each role; the cookie header of each."""
    who: dict[str, dict[str, str]] = {"nobody": {}}
    for role in ("supervisor", "operator", "viewer"):
        post = {"name": role, "role": role, "password": PASSWORD}
        made = await rig.http.post("/api/people", json=post, headers=who.get("supervisor", {}))
        assert made.status_code == 200, made.text
        rig.http.cookies.clear()
        answer = await rig.http.post("/api/session", json={"secret": PASSWORD, "name": role})
        (token,) = dict(answer.cookies).items()
        who[role] = {"Cookie": "=".join(token)}
        rig.http.cookies.clear()
    return who


async def send(rig: Rig, method: str, path: str, body: Any, headers: dict[str, str]) -> httpx.Response:
    filled = path.replace("{robot}", "Ada").replace("{name}", "nothing").replace("{key}", "nothing")
    return await rig.http.request(method, filled, json=body, headers=headers)


@pytest.mark.parametrize("who", WHO)
async def test_each_request_is_answered_as_the_table_says(who: str) -> None:
    async with served("Ada") as rig:
        headers = (await accounts(rig))[who]
        for method, path, body, effect in requests():
            answer = await send(rig, method, path, body, headers)
            told = f"{method} {path} {body}: {answer.status_code} {answer.text[:200]}"
            if who == "nobody":
                assert answer.status_code == 401, told
            elif verdict(person(role=who), effect) == "allow":  # type: ignore[arg-type]
                assert answer.status_code not in (401, 403), told
            else:
                assert answer.status_code == 403, told
                assert answer.json()["detail"].startswith(f"As {'an' if who[0] == 'o' else 'a'} {who}"), told
        await rig.heard()
        robots = rig.robots
        sent = [each.by for each in robots.inputs] + [each.by for each in robots.orders]
        sent += [each.by for each in robots.decisions] + [each.by for each in robots.stops]
        assert {(by.name, by.role) if by else None for by in sent} == (
            set() if who == "nobody" else {(who, who)}
        ), "everything that goes out says on whose account"


async def test_each_event_of_the_live_stream_is_heard_as_the_table_says() -> None:
    async with served("Ada") as rig:
        live, headers = rig.server.live, await accounts(rig)
        known = set(live.server.handlers["/"]) - {"connect", "disconnect"}
        assert known == set(live.effects), "each event says what it does"
        rig.robots.show("Ada", "camera")
        for who in WHO:
            page = Page()
            rig.pages.append(page)
            if who == "nobody":
                with pytest.raises(socketio.exceptions.ConnectionError):
                    await page.open(rig.url)
                continue
            await page.open(rig.url, headers=headers[who])
            await page.until(partial(len, page.snapshots))
            for effect in live.effects.values():
                assert verdict(person(role=who), effect) == "allow"  # type: ignore[arg-type]
            await page.io.emit("watch", [{"robot": "Ada", "name": "camera"}])
            rig.robots.show("Ada", "camera")
            await page.until(partial(len, page.frames))
