"""A team whose words a model understands: it splits the work or names who does it; the rest is ours."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.language.llm.scripted_server import Say, ScriptedServer
from tests.demos.house import PATIENCE_S, House, running

TEAM = {"Spot", "TIAGo", "Leo"}


def step(action: str, robot: str | None = None, **parameters: Any) -> dict[str, Any]:
    return {
        "action": action, "parameters": parameters, "reason": "to see to it", "only_if": None,
        "together_with": None, "repeat": None, "robot": robot,
    }  # fmt: skip


def visit(place: str, robot: str | None = None) -> list[dict[str, Any]]:
    return [step("GetCoordinates", robot, target=place), step("NavigateTo", robot, pose=None)]


def plan(says: str, *steps: dict[str, Any]) -> Say:
    return Say({"message_response": says, "queue": [*steps], "system_cmd": [], "choices": [], "sources": []})


SEEN = Say(
    {"text": "Nothing stands there.", "found": None, "wanted": "", "unwanted": False, "attention": False,
     "things": [], "rules": []}
)  # fmt: skip


def looked(home: House) -> list[str]:
    """What was looked at, by which robot."""
    return sorted(
        str(step.action.input_parameters["inspect"].value)
        for update in home.observer.plans.values()
        for step in update.steps
        if step.action.name == "Inspect" and step.state == "finished"
    )


async def idle(home: House) -> None:
    await home.observer.until(
        lambda: {home.observer.state(robot) for robot in TEAM} == {"idle"}, timeout_s=PATIENCE_S
    )


@pytest.mark.timeout(300)
async def test_what_a_model_understands_is_split_allotted_and_done_by_the_team(tmp_path: Path) -> None:
    demo = load_demo("fleet")
    async with ScriptedServer() as server:
        told = {"speed": None, "data_dir": tmp_path, "language": f"local:m@{server.url}"}
        config = SystemConfig.model_validate(told | {"language_fallback": ()})
        areas = [
            one
            for name in "abc"
            for one in (*visit(f"area_{name}"), step("Inspect", inspect=f"Area {name.upper()}"))
        ]
        server.will(*[plan("I will check all three areas.", *areas)] * 3)
        server.always(SEEN)
        async with running(demo.system(config)) as home:
            await home.observer.until(lambda: home.observer.robots == TEAM, timeout_s=PATIENCE_S)
            reply = await home.say("Check all three areas, split between you.", "Spot")
            assert "Leo is nearest to “Area C”" in reply.message
            await home.observer.until(
                lambda: looked(home) == ["Area A", "Area B", "Area C"], timeout_s=PATIENCE_S
            )
            await idle(home)
            assert {len(home.observer.plans[robot].steps) for robot in TEAM} == {3}

            server.will(
                plan("I take the pump, TIAGo takes the gate.", *visit("pump_1"), *visit("gate_1", "TIAGo"))
            )
            home.observer.say("I want eyes at the pump and where the trucks come in", "Spot")
            # A model's word alone moves no robot to which nobody spoke.
            asks = "I ask first: you spoke to another robot."
            await home.observer.until(
                lambda: any(asks in said.message for said in home.observer.said), timeout_s=PATIENCE_S
            )
            home.observer.say("yes", "TIAGo")
            await home.state("running", "TIAGo")
            await idle(home)
            for robot, thing in (("Spot", "pump_1"), ("TIAGo", "gate_1")):
                pose, goal = home.system.robots[robot].pose(), home.system.known.get(thing)
                assert goal is not None
                assert abs(pose.x_m - goal.x_m) + abs(pose.y_m - goal.y_m) < 3.0, robot

            server.will(plan("I look, TIAGo minds the pump.", *areas[-3:-1], *visit("pump_1", "TIAGo")))
            asked = len(server.requests)
            home.observer.say("Spot have a look at area C while TIAGo minds the pump", "Spot")
            await home.state("running", "TIAGo")  # it was called: nobody need be asked
            await idle(home)
            assert len(server.requests) == asked + 1
            assert home.distance_m("pump_1", "TIAGo") < 1.6
