"""Being called while the page is closed."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from parley.gate.table import Effect
from parley.web.bodies import Done, PushKey, PushPut
from parley.web.problems import WebProblem
from parley.web.push import Subscription
from parley.web.routes.access import ThisDevice, Web, may
from parley.web.showing import Reader

__all__ = ["router"]

router = APIRouter(prefix="/push", tags=["session"], dependencies=[may(Effect.SEE)])


@router.get("")
async def get_push(web: Web) -> PushKey:
    """With what a browser subscribes."""
    return PushKey(key=await web.pusher.public_key())


@router.put("")
async def put_push(put: PushPut, web: Web, reader: Reader, device: ThisDevice) -> Done:
    """Call this browser when a robot waits for a person."""
    if not web.pusher.may_send_to(put.endpoint):
        raise WebProblem(422, "That is no service that calls browsers.", path="endpoint")
    digest = device.digest if device is not None else ""
    wanted = Subscription(**put.model_dump(), language=reader, device=digest)
    if not web.pusher.is_readable(wanted):
        raise WebProblem(422, "No message can be written with these keys.", path="p256dh")
    await web.pusher.subscribe(wanted)
    return Done()


@router.delete("")
async def delete_push(web: Web, endpoint: Annotated[str, Query(max_length=1000)]) -> Done:
    """Call it no more."""
    await web.pusher.unsubscribe(endpoint)
    return Done()
