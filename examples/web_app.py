"""A FastAPI app with robots in it: `uvicorn web_app:app`. Needs `pip install 'parley-hri[sim,web]'`."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import FastAPI, Header, HTTPException, Request

from parley.api import ConfigError, Parley, Principal, person, program

GUARDS = {"secret of Ada": person("Ada")}  # your own way to sign in goes here


@asynccontextmanager
async def robots(app: FastAPI) -> AsyncIterator[None]:
    async with Parley("nursing-home", config={"speed": None}) as app.state.parley:
        yield


app = FastAPI(lifespan=robots)


def who(authorization: str) -> Principal:
    """Only whom you know is a person; everybody else proposes, and a person says yes."""
    return GUARDS.get(authorization, program("my web app"))


@app.get("/robots")
async def names(request: Request) -> list[str]:
    return list(request.app.state.parley.robots)


@app.post("/robots/{robot}/say")
async def say(robot: str, text: str, request: Request, authorization: str = Header("")) -> dict[str, str]:
    parley: Parley = request.app.state.parley
    try:
        reply = await parley.say(robot, text, by=who(authorization))
    except ConfigError as error:
        raise HTTPException(404, str(error)) from error
    return {"reply": reply.message, "state": parley.plan(robot).state}


@app.post("/stop")
async def stop(request: Request, authorization: str = Header("")) -> dict[str, bool]:
    request.app.state.parley.stop(by=who(authorization))
    return {"stopped": True}
