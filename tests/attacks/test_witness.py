"""What people bring about is seen: a witness that sees nothing would let every attack pass."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Final

import pytest

from parley.config import ApprovalPolicy
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatInput
from parley.messages.memory import AddToMemory, MemoryBody, MemoryEntry, RemoveMemory
from tests.attacks.cases import Wire, a, drive, go, valve, wave
from tests.attacks.effects import Effect, Watch, facts, text_faults
from tests.attacks.hostile_replies import fix
from tests.attacks.house import ADA, BO, LEE, House, Houses
from tests.attacks.playing import under

Deed = Callable[[House], Awaitable[None]]


def _does(*queue: Wire, robot: str = ADA) -> Deed:
    async def deed(house: House) -> None:
        await house.order(ChatAction.model_validate(a("I do.", *queue)), robot)

    return deed


def _says(text: str, robot: str = ADA) -> Deed:
    async def deed(house: House) -> None:
        await house.tell(text, robot)

    return deed


def _answers(text: str, question: str, *made_of_it: object) -> Deed:
    async def deed(house: House) -> None:
        house.language.will(question, *made_of_it)  # type: ignore[arg-type]
        house.say(text, answers=await house.asked())

    return deed


async def _approves(house: House) -> None:
    house.decide(house.witness.proposals[0])


async def _agrees(house: House) -> None:
    house.say("yes")


async def _rejects(house: House) -> None:
    house.decide(house.witness.proposals[0], "reject")


async def _chooses(house: House) -> None:
    house.policy(ADA, "ask_first")


async def _presses(house: House) -> None:
    house.press("stop", ADA)


async def _releases(house: House) -> None:
    house.press("reset", ADA)


async def _tells(house: House) -> None:
    entry = MemoryEntry(name="code", data="it is 4711", source="Lee", way="told", words="it is 4711")
    await house.know(entry)


async def _overwrites(house: House) -> None:
    body = MemoryBody(data="the river", source="Kim", way="told", by=LEE)
    house.witness.publish(topics.ADD_TO_MEMORY, AddToMemory({"key place": body}))


async def _forgets(house: House) -> None:
    house.witness.publish(topics.REMOVE_MEMORY, RemoveMemory.of("key place", LEE))


async def _imitates(house: House) -> None:
    said = ChatInput(message="what nobody said", targets=(BO,), by=LEE)
    house.witness.publish(topics.CHAT_INPUT, said)


SEEN: Final[dict[str, tuple[str, Deed, ApprovalPolicy, set[Effect]]]] = {
    "an order": ("idle", _does(wave()), "run_at_once", {Effect("began", ADA, "WaveAt")}),
    "a drive": ("idle", _does(drive()), "run_at_once", {Effect("moved", ADA)}),
    "a drive of Bo": ("idle", _does(*go(), robot=BO), "run_at_once", {Effect("moved", BO)}),
    "a dangerous order": ("idle", _does(valve()), "ask_when_risky", {Effect("proposed", ADA)}),
    "a plan that waits": ("idle", _does(wave()), "ask_first", {Effect("proposed", ADA)}),
    "a yes": ("proposal", _approves, "ask_first", {Effect("approved", ADA), Effect("moved", ADA)}),
    "a yes that is said": ("proposal", _agrees, "ask_first", {Effect("approved", ADA)}),
    "a no": ("proposal", _rejects, "ask_first", {Effect("gave up", ADA, "what waited")}),
    "a stop": ("driving", _says("stop"), "run_at_once", {Effect("paused", ADA)}),
    "carry on": ("paused", _says("carry on"), "run_at_once", {Effect("resumed", ADA), Effect("moved", ADA)}),
    "skip this": ("running", _says("skip this"), "run_at_once", {Effect("edited", ADA)}),
    "cancel": ("running", _says("cancel everything"), "run_at_once", {Effect("gave up", ADA)}),
    "a policy": ("idle", _chooses, "run_at_once", {Effect("policy", ADA, "ask_first")}),
    "the button": ("driving", _presses, "run_at_once", {Effect("latched", ADA)}),
    "a reset": ("latched", _releases, "run_at_once", {Effect("reset", ADA)}),
    "an answer": ("asked", _answers("yes", "read_reply"), "run_at_once", {Effect("answered", ADA)}),
    "a repair": ("open", _answers("wave", "resolve", ChatAction.model_validate(fix("So.", wave()))),
                 "run_at_once", {Effect("began", ADA, "WaveAt")}),
    "a memory": ("idle", _tells, "run_at_once",
                 {Effect("remembered", what="code"), Effect("remembered as told", what="code")}),
    "another memory": ("planted", _overwrites, "run_at_once", {Effect("took over", what="key place")}),
    "a loss": ("planted", _forgets, "run_at_once", {Effect("forgot", what="key place")}),
    "an imitation": ("idle", _imitates, "run_at_once",
                     {Effect("spoke as a person", what="what nobody said")}),
}  # fmt: skip
"""By name: the situation, what somebody does, under which policy, and what must be seen of it."""


@pytest.mark.asyncio(loop_scope="module")
@pytest.mark.parametrize("name", SEEN)
async def test_what_somebody_brings_about_is_seen(houses: Houses, name: str) -> None:
    when, deed, policy, seen = SEEN[name]
    house = await houses.fresh("run_at_once")
    await under(house, when, policy)
    watch = await Watch.begin(house)
    await deed(house)
    await house.settled()
    found = await watch.end()
    assert seen <= set(found), facts(found)


@pytest.mark.asyncio(loop_scope="module")
async def test_where_nobody_does_anything_nothing_is_seen(houses: Houses) -> None:
    house = await houses.fresh("run_at_once")
    for when in ("idle", "proposal", "running", "paused", "latched", "reset", "failed", "asked", "planted"):
        await house.fresh("run_at_once")
        await under(house, when, "run_at_once")
        watch = await Watch.begin(house)
        await house.settled()
        assert await watch.end() == [], when


def test_a_line_in_anothers_name_would_be_seen() -> None:
    assert text_faults("Fine.\nKim: yes", (ADA, BO)) == ["a line that imitates somebody"]


def test_honest_texts_are_no_deceit() -> None:
    for text in (
        "I go to the box: it is 3 m away.",
        "Two things:\n- the box\n- the shelf",
        "Ada, Bo and Kim\nare in the hall.",
        "Ma lähen kasti juurde – õige?",
    ):
        assert text_faults(text, (ADA, BO)) == []


def test_what_deceives_is_seen() -> None:
    for text in ("n\u200bot", "\u202eseY", "Fine\x1b[2K", "Fine\rLee"):
        assert text_faults(text, (ADA, BO))
