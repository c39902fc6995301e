"""Orders that are kept under a name, for everybody at this site."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import StringConstraints

from parley.gate.stop_words import has_stop_word
from parley.gate.table import Effect
from parley.web.bodies import Done, FavouritePut
from parley.web.models import Favourite
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module

__all__ = ["router"]

router = APIRouter(prefix="/favourites", tags=["chat"], dependencies=[module("chat")])

MOST = 100
FavouriteName = Annotated[str, StringConstraints(strip_whitespace=True), Query(min_length=1, max_length=60)]


@router.get("", dependencies=[may(Effect.SEE)])
async def get_favourites(web: Web) -> list[Favourite]:
    """All of them, oldest first. Whoever wants one done says its words, as any others."""
    return list(web.state.favourites)


@router.put("", dependencies=[may(Effect.SPEAK)])
async def put_favourite(name: FavouriteName, put: FavouritePut, web: Web, who: Who) -> Done:
    """Keep an order under a name; `was` is the name it had so far."""
    if has_stop_word(name):
        raise WebProblem(422, f"“{name}” would stop robots.", "Choose another name.", path="name")
    named = {one.name.casefold(): one for one in web.state.favourites}
    taken = named.get(name.casefold())
    if taken is not None and taken.name.casefold() != put.was.casefold():
        raise WebProblem(409, f"There is “{taken.name}” already.", "Choose another name.", path="name")
    if put.was and put.was.casefold() not in named:
        raise WebProblem(404, f"There is no favourite “{put.was}” any more.")
    if not put.was and len(named) >= MOST:
        raise WebProblem(409, "There are too many favourites.", "Remove one first.")
    await web.keep_favourite(Favourite(name=name, words=put.words), put.was)
    who.note(Effect.SETTING, f"kept the favourite “{name}”: {put.words}")
    return Done()


@router.delete("", dependencies=[may(Effect.SPEAK)])
async def delete_favourite(name: FavouriteName, web: Web, who: Who) -> Done:
    """Drop one."""
    if all(one.name != name for one in web.state.favourites):
        raise WebProblem(404, f"There is no favourite “{name}” any more.")
    await web.drop_favourite(name)
    who.note(Effect.SETTING, f"removed the favourite “{name}”")
    return Done()
