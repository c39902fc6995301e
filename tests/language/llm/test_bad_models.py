"""Whatever a model does: a plan that holds or a plain sentence, and the engine gets nothing else."""

from __future__ import annotations

import asyncio
import json
import re

import pytest

from parley.language.llm.scripted_server import Say
from parley.messages import topics
from tests.language.llm.rig import LOOK_PLAN, LOOKS, model, room, situation

THREE = 3
JARGON = re.compile(
    r"http|json|status|token|tool|model|exception|error|queue|action|timeout|api|\{|\[|_", re.IGNORECASE
)


def planned(**changes: object) -> Say:
    return Say(answer=LOOK_PLAN | changes)


def step(**changes: object) -> Say:
    return planned(queue=[{"action": "Look", "parameters": {"what": "box"}} | changes])


HOPELESS: dict[str, list[Say]] = {
    "drops every connection": [Say(drop_after=0)] * THREE,
    "drops in mid-stream": [Say(answer=LOOK_PLAN, drop_after=4)] * THREE,
    "talks nonsense": [Say(text="Colourless green ideas sleep furiously.")] * THREE,
    "says nothing": [Say(text="")] * THREE,
    "is cut off": [Say(answer=LOOK_PLAN, cut=60, finish="length")] * THREE,
    "is cut off in text": [Say(text=json.dumps(LOOK_PLAN)[:60], finish="length")] * THREE,
    "plans an unknown action": [step(action="Fly")] * THREE,
    "calls an unknown command": [planned(system_cmd=[{"command": "reboot"}])] * THREE,
    "gives a wrong type": [step(action="Drive", parameters={"x": "far"})] * THREE,
    "gives an object for a word": [step(parameters={"what": {"a": {"b": 1}}})] * THREE,
    "leaves out what is needed": [step(parameters={})] * THREE,
    "gives a parameter too many": [step(parameters={"what": "box", "speed": 9})] * THREE,
    "leaves out the reply": [Say(answer={"queue": LOOK_PLAN["queue"]})] * THREE,
    "plans a thousand steps": [planned(queue=LOOK_PLAN["queue"] * 1000)] * THREE,
    "writes a novel": [planned(message_response="word " * 5000)] * THREE,
    "means a robot that is not there": [planned(targets=["Nobody"])] * THREE,
    "takes a step out that is not there": [planned(system_cmd=[{"command": "pop", "index": 3}])] * THREE,
    "forgets what nobody remembers": [planned(system_cmd=[{"command": "remove_memory", "name": "x"}])]
    * THREE,
    "refuses": [Say(refusal="I cannot help with that.")],
    "filters": [Say(text="", finish="content_filter")],
    "does not take the key": [Say(body='{"error": {"message": "bad key"}}', status=401)],
    "is too busy": [Say(body="{}", status=429)] * THREE,
    "is broken": [Say(body="oops", status=500, content_type="text/plain")] * THREE,
    "answers with a web page": [Say(body="<html>Hello</html>", content_type="text/html")] * THREE,
    "answers with other JSON": [Say(body="[1, 2]")] * THREE,
    "answers with broken JSON": [Say(body='{"choices": [')] * THREE,
    "answers endlessly": [Say(text="x" * 300_000)] * THREE,
}


@pytest.mark.parametrize("why", HOPELESS)
async def test_hopeless_model_ends_in_a_plain_sentence_and_nothing_is_done(why: str) -> None:
    async with room() as here:
        here.model.will(*HOPELESS[why])
        told = await here.say("look at the box")
        assert told.type == "error"
        assert "Nothing was started" in told.message
        assert not JARGON.search(told.message), told.message
        assert await here.untouched()


MENDING: dict[str, list[Say]] = {
    "writes between fences": [Say(text=f"Sure!\n```json\n{json.dumps(LOOK_PLAN)}\n```\nAnything else?")],
    "writes bare JSON": [Say(text=json.dumps(LOOK_PLAN))],
    "writes a Chat Action": [
        planned(queue=[{"Look": {"input_parameters": {"what": {"pvf_type": "string", "pvf_value": "box"}}}}])
    ],
    "adds fields of its own": [planned(mood="cheerful", confidence=0.9)],
    "talks nonsense first": [Say(text="Hm."), LOOKS],
    "plans an unknown action first": [step(action="Fly"), LOOKS],
    "is cut off first": [Say(answer=LOOK_PLAN, cut=60, finish="length"), LOOKS],
    "drops the connection first": [Say(drop_after=0), LOOKS],
    "drops in mid-stream first": [Say(answer=LOOK_PLAN, drop_after=4), LOOKS],
    "is busy first": [Say(body="{}", status=429, headers={"Retry-After": "3"}), LOOKS],
    "is broken twice": [Say(body="oops", status=503)] * 2 + [LOOKS],
}


@pytest.mark.parametrize("how", MENDING)
async def test_model_that_comes_round_gets_just_its_plan_carried_out(how: str) -> None:
    async with room() as here:
        here.model.will(*MENDING[how])
        told = await here.say("look at the box")
        assert (told.type, told.message) == ("response", "I will look at the box.")
        await here.crew.state("idle")
        assert here.crew.body.did == ["look box"]
        assert here.crew.wire.commands() == ["start"]


async def test_what_was_wrong_goes_back_to_the_model() -> None:
    async with model() as asked:
        asked.will(step(action="Fly"), LOOKS)
        await asked.language.interpret(situation())
        assert "there is no action 'Fly'; there are: Look, Find, Drive" in asked.server.requests[1].texts[-1]


@pytest.mark.parametrize("hangs", ["gate", "piece_gate"], ids=["at once", "in the middle of its answer"])
async def test_hung_model_is_given_up_in_time_and_nothing_is_done(hangs: str) -> None:
    async with room() as here:
        gate = asyncio.Event()
        late = Say(answer=LOOK_PLAN, gate=gate) if hangs == "gate" else Say(answer=LOOK_PLAN, piece_gate=gate)
        here.model.will(late)
        answer = asyncio.create_task(here.say("look at the box"))
        await here.model.server.asked()
        here.model.clock.advance(20.0)
        told = await answer
        assert told.message == "My language service takes too long. Nothing was started; please try again."
        gate.set()
        assert await here.untouched(), "what comes after that is not done either"


async def test_slow_model_is_waited_for() -> None:
    gate = asyncio.Event()
    async with room() as here:
        here.model.will(Say(answer=LOOK_PLAN, gate=gate))
        answer = asyncio.create_task(here.say("look at the box"))
        await here.model.server.asked()
        here.model.clock.advance(19.0)
        assert here.crew.wire.commands() == []
        gate.set()
        assert (await answer).message == "I will look at the box."
        await here.crew.state("idle")
        assert here.crew.body.did == ["look box"]
        assert here.crew.wire.commands() == ["start"]


async def test_model_that_is_gone_ends_in_a_plain_sentence() -> None:
    async with room() as here:
        await here.model.server.__aexit__(None, None, None)
        told = await here.say("look at the box")
        assert told.message.startswith("My language service does not answer at the moment.")
        assert await here.untouched()


async def test_stop_acts_while_the_model_hangs() -> None:
    gate = asyncio.Event()
    async with room() as here:
        here.model.will(LOOKS)
        here.crew.body.gate("box")
        await here.say("look at the box")
        await here.crew.doing("look box")
        here.model.will(Say(answer=LOOK_PLAN, gate=gate))
        waiting = asyncio.create_task(here.say("look at the box again"))
        await here.model.server.asked(2)
        assert (await here.say("stop")).message.startswith("I have stopped.")
        gate.set()
        assert "You told me to stop" in (await waiting).message
        assert here.crew.wire.commands()[0] == "start"
        assert "modify" not in here.crew.wire.commands()
        here.crew.body.gate("box").set()


async def test_builtin_engine_steps_in_and_says_so_once() -> None:
    async with room("builtin") as here:
        here.model.server.always(Say(body="oops", status=500))
        first = await here.say("look at the box")
        assert first.message.startswith("(My usual language service gives no answer;")
        await here.crew.until(lambda: here.crew.body.did)
        second = await here.say("look at the box")
        assert not second.message.startswith("(")


async def test_refusal_is_final_whatever_engine_stands_behind() -> None:
    async with room("builtin") as here:
        here.model.will(Say(refusal="No."))
        told = await here.say("look at the box")
        assert told.message.startswith("My language service declined to answer that.")
        assert await here.untouched()


async def test_recovery_asks_the_operator_when_the_model_is_gone() -> None:
    async with room() as here:
        here.crew.body.failures["look box"] = 1
        here.model.will(LOOKS, *[Say(body="oops", status=500)] * 3)
        await here.say("look at the box")
        await here.crew.hears("I cannot look box. What should I do?")
        assert here.crew.wire.commands() == ["start"]


def repair(**changes: object) -> Say:
    return Say(answer={"message_response": "I try.", "success": True} | changes)


FLY = [{"action": "Fly", "parameters": {}}]
HELPLESS: dict[str, list[Say]] = {
    "nonsense": [Say(text="Colourless green ideas sleep furiously.")] * THREE,
    "unknown action": [repair(queue=FLY)] * THREE,
    "unknown action for later": [repair(queue=LOOK_PLAN["queue"], afterwards=FLY)] * THREE,
    "wrong type": [repair(queue=[{"action": "Drive", "parameters": {"x": "far"}}])] * THREE,
    "a thousand steps": [repair(queue=LOOK_PLAN["queue"] * 1000)] * THREE,
    "unknown command": [repair(system_cmd=[{"command": "reboot"}])] * THREE,
    "steps that nobody agreed to": [repair(success=False, queue=LOOK_PLAN["queue"])] * THREE,
    "cut off": [Say(answer={"message_response": "I try.", "success": True}, cut=20, finish="length")] * THREE,
}


@pytest.mark.parametrize("why", HELPLESS)
async def test_hopeless_model_repairs_nothing_and_the_operator_is_asked(why: str) -> None:
    async with room() as here:
        here.crew.body.failures["look box"] = 1
        here.model.will(LOOKS, *HELPLESS[why])
        await here.say("look at the box")
        await here.crew.hears("I cannot look box. What should I do?")
        assert here.crew.body.did == ["look box"]
        assert here.crew.wire.commands() == ["start"]


async def test_recovery_of_the_model_repairs_the_plan() -> None:
    async with room() as here:
        here.crew.body.failures["look box"] = 1
        here.model.will(LOOKS, repair(queue=[{"action": "Look", "parameters": {"what": "crate"}}]))
        await here.say("look at the box")
        await here.crew.until(lambda: "look crate" in here.crew.body.did)
        assert "modify" in here.crew.wire.commands()


async def test_memory_commands_of_a_model_are_carried_out_and_confirmed() -> None:
    async with room() as here:
        command = {"command": "add_memory", "name": "key", "data": "The key is red.", "info": "about the key"}
        here.model.will(Say(answer={"message_response": "Noted.", "system_cmd": [command]}))
        assert (await here.say("the key is red")).message == "Noted."
        assert list(here.crew.wire.objects(topics.ADD_TO_MEMORY)[0]) == ["key"]
        assert here.crew.wire.commands() == []
