"""One answer of a model, orders for two robots: whoever was named acts, whoever was not asks first."""

from __future__ import annotations

from parley.language.llm.scripted_server import Say
from tests.agents.crew import proposals
from tests.language.llm.rig import LOOK_PLAN, room

STEP = {"action": "Look", "parameters": {"what": "box"}, "reason": "see it"}
BOTH = Say(answer=LOOK_PLAN | {"queue": [STEP, STEP | {"robot": "B"}]})


async def test_robot_that_was_named_does_its_share() -> None:
    async with room() as here:
        await here.crew.engine("B")
        here.model.will(BOTH)
        await here.say("look at the box, and B too")
        for name in ("A", "B"):
            await here.crew.until(lambda name=name: here.crew.steps(name) == ["finished"])  # type: ignore[misc]
        assert proposals(here.crew) == []


async def test_robot_that_was_not_named_asks_first() -> None:
    async with room() as here:
        await here.crew.engine("B")
        here.model.will(BOTH)
        await here.say("look at the box")
        await here.crew.until(lambda: proposals(here.crew))
        (waits,) = proposals(here.crew)
        assert (waits["target"], bool(waits["why"]), waits["words"]) == ("B", True, "look at the box")
        await here.crew.until(lambda: here.crew.steps("A") == ["finished"])
        assert here.crew.steps("B") == []
        await here.crew.hears("you spoke to another robot")
