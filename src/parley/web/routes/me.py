"""One's own account: devices, password, passkeys."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Request

from parley.gate.table import Effect
from parley.web.backend import Backend
from parley.web.bodies import DeviceInfo, Done, MyAccount, MyPasskey, MyPassword, PasskeyPost, PasskeyQuestion
from parley.web.people.passkeys import PasskeyRefusedError
from parley.web.people.passwords import password_problem
from parley.web.people.records import Device, Passkey, Person
from parley.web.problems import WebProblem
from parley.web.routes.access import ThisDevice, ThisVisitor, Web, Who, may
from parley.web.routes.session import origin_of
from parley.web.sessions import Sessions

__all__ = ["device_info", "router"]

router = APIRouter(prefix="/me", tags=["me"], dependencies=[may(Effect.SEE)])

Key = Annotated[str, Path(max_length=400)]


@router.get("")
async def get_me(web: Web, device: ThisDevice) -> MyAccount:
    """Where I am signed in, and my passkeys."""
    doors = web.sessions
    mine = doors.devices_of(device) if device is not None else []
    keys = [key for key in doors.roll.passkeys.values() if device is not None and key.person == device.person]
    return MyAccount(
        account=device is not None and device.way == "account",
        devices=tuple(device_info(doors, each, device) for each in mine),
        passkeys=tuple(
            MyPasskey(
                id=key.id, name=key.name, created_unix_ms=key.created_unix_ms, seen_unix_ms=key.seen_unix_ms
            )
            for key in keys
        ),
    )


@router.put("/password")
async def put_password(put: MyPassword, web: Web, device: ThisDevice, visitor: ThisVisitor, who: Who) -> Done:
    """Change my password; my other devices are signed out."""
    here, owner = _account(web, device)
    if problem := password_problem(put.new):
        raise WebProblem(422, problem, "Choose a longer one.", path="new")
    await web.sessions.confirm(owner, put.old, visitor)
    hashed = await web.sessions.passwords.hash(put.new)
    await web.sessions.store.set_password(owner.name, hashed, who.by, keep=here.digest)
    await web.sessions.refresh()
    return Done()


@router.delete("/devices")
async def delete_my_devices(web: Web, device: ThisDevice, who: Who) -> Done:
    """Sign me out everywhere, here too."""
    if device is not None:
        await web.sessions.sign_out(web.sessions.devices_of(device), who.by)
    return Done()


@router.delete("/devices/{key}")
async def delete_my_device(key: Key, web: Web, device: ThisDevice, who: Who) -> Done:
    """Sign me out on one of my devices."""
    mine = web.sessions.devices_of(device) if device is not None else []
    found = [each for each in mine if each.id == key]
    if not found:
        raise WebProblem(404, "This device is not signed in any more.")
    await web.sessions.sign_out(found, who.by)
    return Done()


@router.post("/passkeys/options")
async def ask_for_new_passkey(request: Request, web: Web, device: ThisDevice) -> PasskeyQuestion:
    """What to ask the browser for, to make a passkey."""
    _, owner = _account(web, device)
    known = [key for key in web.sessions.roll.passkeys.values() if key.person == owner.key]
    id_, options = web.sessions.ceremonies.ask_new(
        origin_of(request), owner.key, owner.name, known, web.clock.wall_s()
    )
    return PasskeyQuestion(id=id_, options=options)


@router.post("/passkeys")
async def post_my_passkey(
    post: PasskeyPost, request: Request, web: Web, device: ThisDevice, who: Who
) -> Done:
    """Keep the passkey that the browser made."""
    _, owner = _account(web, device)
    try:
        key, public, count = web.sessions.ceremonies.take_new(
            post.id, post.credential, origin_of(request), owner.key, web.clock.wall_s()
        )
    except PasskeyRefusedError as error:
        raise WebProblem(409, "This passkey could not be taken.", "Try again.") from error
    made = Passkey(key, owner.key, post.name, public, count, web.clock.unix_ms())
    await web.sessions.store.add_passkey(made, who.by)
    await web.sessions.refresh()
    return Done()


@router.delete("/passkeys/{key}")
async def delete_my_passkey(key: Key, web: Web, device: ThisDevice, who: Who) -> Done:
    """Forget one of my passkeys."""
    _, owner = _account(web, device)
    kept = web.sessions.roll.passkeys.get(key)
    if kept is None or kept.person != owner.key:
        raise WebProblem(404, "There is no such passkey.")
    await web.sessions.store.remove_passkey(key, who.by)
    await web.sessions.refresh()
    return Done()


def device_info(doors: Sessions, device: Device, here: Device | None) -> DeviceInfo:
    """A device as people see it."""
    return DeviceInfo(
        id=device.id,
        name=device.name,
        role=doors.role_of(device) or device.role,
        paired=device.way == "code",
        kind=device.gadget.kind,
        browser=device.gadget.browser,
        address=device.gadget.address,
        here=here is not None and device.digest == here.digest,
        created_unix_ms=device.created_unix_ms,
        seen_unix_ms=doors.seen(device),
    )


def _account(web: Backend, device: Device | None) -> tuple[Device, Person]:
    """Who is signed in with an account.

    Raises:
        WebProblem: They have none.
    """
    owner = web.sessions.roll.people.get(device.person) if device is not None else None
    if device is None or owner is None:
        raise WebProblem(409, "You have no account here.", "A supervisor can make one for you.")
    return device, owner
