"""However an action ends, its node ends with it and everybody is told."""

from __future__ import annotations

from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.model import Result

from .spec_actions import chain
from .watched import Watched


class Speechless(Exception):  # noqa: N818 - what an action may raise
    def __str__(self) -> str:
        raise RuntimeError("no words")


@action
async def fail_without_words(ctx: RunHandle) -> None:
    """Raise what cannot say why."""
    raise Speechless


def lone(name: str) -> dict[str, object]:
    return {"name": name, "instance_id": 0, "type": "sync"}


async def test_an_error_that_cannot_say_why_ends_its_node_all_the_same() -> None:
    watched = Watched(chain("g", [lone("FailWithoutWords")]), catalogue=Catalogue([fail_without_words.spec]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert "Speechless" in watched.log("FailWithoutWords_0")[-1]
