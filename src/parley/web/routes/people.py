"""Accounts and devices of everybody, for supervisors."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from parley.gate.table import Effect
from parley.web.bodies import CodeInfo, CodePost, Done, PeopleInfo, PersonInfo, PersonPost, PersonPut
from parley.web.people.passwords import password_problem
from parley.web.people.records import key_of
from parley.web.problems import WebProblem
from parley.web.routes.access import ThisDevice, ThisVisitor, Web, Who, may
from parley.web.routes.me import device_info
from parley.web.routes.session import set_cookie

__all__ = ["router"]

router = APIRouter(prefix="/people", tags=["people"], dependencies=[may(Effect.PEOPLE)])

Name = Annotated[str, Path(min_length=1, max_length=60)]
Key = Annotated[str, Path(max_length=100)]


@router.get("")
async def get_people(web: Web, device: ThisDevice) -> PeopleInfo:
    """All accounts, and all devices that are signed in."""
    roll, doors = web.sessions.roll, web.sessions
    return PeopleInfo(
        people=tuple(
            PersonInfo(
                name=each.name,
                role=each.role,
                disabled=each.disabled,
                created_unix_ms=each.created_unix_ms,
                seen_unix_ms=each.seen_unix_ms,
                passkeys=sum(passkey.person == each.key for passkey in roll.passkeys.values()),
            )
            for each in roll.people.values()
        ),
        devices=tuple(
            device_info(doors, each, device)
            for each in roll.devices.values()
            if each.way != "open" and doors.role_of(each) is not None
        ),
    )


@router.post("")
async def post_person(
    post: PersonPost, request: Request, response: Response, web: Web, who: Who, visitor: ThisVisitor
) -> PersonInfo:
    """Make an account. Who makes the first one, which is a supervisor's, is signed in with it."""
    _check(post.password)
    is_first = not web.sessions.roll.people
    hashed = await web.sessions.passwords.hash(post.password)
    role = await web.sessions.store.add(post.name, post.role, hashed, who.by)
    await web.sessions.refresh()
    owner = web.sessions.roll.people[key_of(post.name)]
    if is_first:
        set_cookie(request, response, await web.sessions.open_for(owner, visitor))
    return PersonInfo(
        name=owner.name, role=role, disabled=False, created_unix_ms=owner.created_unix_ms, seen_unix_ms=0
    )


@router.put("/{name}")
async def put_person(name: Name, put: PersonPut, web: Web, who: Who) -> Done:
    """Change the role, reset the password, or disable or enable."""
    store = web.sessions.store
    if put.password is not None:
        _check(put.password)
        await store.set_password(name, await web.sessions.passwords.hash(put.password), who.by)
    if put.role is not None:
        await store.set_role(name, put.role, who.by)
    if put.disabled is not None:
        await store.set_disabled(name, put.disabled, who.by)
    await web.sessions.refresh()
    return Done()


@router.delete("/{name}")
async def delete_person(name: Name, web: Web, who: Who) -> Done:
    """Remove an account."""
    await web.sessions.store.remove(name, who.by)
    await web.sessions.refresh()
    return Done()


@router.delete("/devices/{key}")
async def delete_device(key: Key, web: Web, who: Who) -> Done:
    """Sign a device out; its page goes to the sign-in at once."""
    found = [device for device in web.sessions.roll.devices.values() if device.id == key]
    if not found:
        raise WebProblem(404, "This device is not signed in any more.")
    await web.sessions.sign_out(found, who.by)
    return Done()


@router.post("/code")
async def post_code(post: CodePost, web: Web) -> CodeInfo:
    """Make a code that lets one device in, without an account."""
    if web.sessions.way not in ("code", "account"):
        raise WebProblem(409, "Devices are not paired here.", "Start it with --lan, or make accounts.")
    return CodeInfo(code=web.sessions.codes.make(post.role, web.clock.wall_s()), role=post.role)


def _check(password: str) -> None:
    if problem := password_problem(password):
        raise WebProblem(422, problem, "Choose a longer one.", path="password")
