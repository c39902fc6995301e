"""One robot's hung language call or action never delays another robot."""

from __future__ import annotations

import asyncio
import time

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.actions.context import ActionContext
from parley.demos.catalogue import load_demo
from parley.language.base import DraftHandler, Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages.chat import ActionCall, ChatAction
from parley.sim.world_file import RobotEntry, WorldFile
from parley.system import System
from parley.umrf.action import action
from tests.demos.house import FULL_SPEED, running


def two_robots() -> WorldFile:
    """The home with a second robot."""
    world = load_demo("nursing-home").world
    first = world.robots[0]
    second = RobotEntry(name="Ruth", model=first.model, pose=(7.5, 5.0, 0.0))
    return world.model_copy(update={"robots": (first, second)})


class HangsForOne(ScriptedLanguage):
    """Never answers messages to David; understands everything else."""

    def __init__(self) -> None:
        super().__init__(BuiltinLanguage())

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        if situation.robot == "David":
            await asyncio.Event().wait()
        return await super().interpret(situation, on_draft=on_draft)


async def test_hung_language_call_of_one_robot_does_not_delay_the_other() -> None:
    async with running(System(two_robots(), FULL_SPEED, language=HangsForOne())) as home:
        home.observer.say("go to the fridge", "David")
        await home.say("go to the dining table", "Ruth")
        assert set(await home.done("Ruth")) == {"finished"}
        assert home.distance_m("dining_table_1", "Ruth") < 1.0
        assert home.observer.state("David") == "idle"


@action(effects=("hangs",), pausable=False)
def hang_in_a_thread(ctx: ActionContext) -> None:
    """Block a thread and ignore everything until it is told to stop."""
    while not ctx.run.stop_requested:
        time.sleep(0.01)


async def test_hung_action_of_one_robot_does_not_delay_the_other() -> None:
    language = ScriptedLanguage(BuiltinLanguage())
    language.will("interpret", ChatAction(message_response="ok", queue=(ActionCall(name="HangInAThread"),)))
    actions = (*BUILTIN_ACTIONS, hang_in_a_thread.spec)
    async with running(System(two_robots(), FULL_SPEED, language=language, actions=actions)) as home:
        await home.say("hang", "David")
        await home.state("running", "David")
        await home.say("go to the dining table", "Ruth")
        assert set(await home.done("Ruth")) == {"finished"}
        assert home.observer.state("David") == "running"
        await home.say("what can you do?", "David")
        await home.say("cancel everything", "David")
        await home.done("David")


async def test_robot_named_in_the_text_wins_over_the_selected_one() -> None:
    async with running(System(two_robots(), FULL_SPEED)) as home:
        await home.say("Ruth, go to the dining table", "David")
        assert set(await home.done("Ruth")) == {"finished"}
        assert home.distance_m("dining_table_1", "Ruth") < 1.0
        assert home.actions("David") == []
