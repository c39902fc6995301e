"""Presses of buttons come again until they are confirmed: each counts once, and none too late."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest

from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, CommandName, Press, PressTaken, SystemCommand
from parley.messages.wire import decode
from tests.agents.crew import KIM, Crew, crew, decide, drive, look, proposals
from tests.transport.backends import until

TOO_LATE = "came too late"


class Buttons:
    """A page's server."""

    def __init__(self, party: Crew) -> None:
        self.party, self.taken = party, list[PressTaken]()

    async def open(self) -> None:
        await self.party.transport.subscribe(
            topics.PRESS_TAKEN, lambda m: self.taken.append(decode(PressTaken, m.data))
        )
        await until(lambda: self.taken)

    def number(self, number: int, to: str = "") -> Press:
        return Press(page="p", number=number, to=to or self.taken[0].run)

    def press(self, command: CommandName, number: int, to: str = "", robot: str = "A") -> None:
        action = ChatAction(
            system_cmd=(SystemCommand(command=command),),
            targets=(robot,),
            by=KIM,
            press=self.number(number, to),
        )
        self.party.observer.publish(topics.CHAT_ACTION, action)


@pytest.fixture
async def buttons() -> AsyncIterator[Buttons]:
    async with crew("A") as party:
        made = Buttons(party)
        await made.open()
        yield made


async def test_a_press_that_comes_again_is_confirmed_again_and_done_once(buttons: Buttons) -> None:
    party = buttons.party
    party.body.gate("box"), party.body.gate("door")
    party.order(look("box"), look("door"))
    await party.doing("look box")
    for _ in range(3):
        buttons.press("skip", 1)
    await party.doing("look door")
    await until(lambda: [taken.id for taken in buttons.taken] == ["", "p.1", "p.1", "p.1"])
    await party.settled()
    assert party.steps()[1] == "running"


async def test_a_press_for_a_robot_of_which_nothing_is_known_yet_is_not_confirmed(buttons: Buttons) -> None:
    buttons.press("stop", 1, robot="B")
    buttons.press("stop", 2)
    await until(lambda: buttons.taken[-1].id == "p.2")
    assert [taken.id for taken in buttons.taken] == ["", "p.2"]


async def test_what_comes_behind_something_that_was_pressed_later_is_not_done(buttons: Buttons) -> None:
    party = buttons.party
    party.body.far.add(9)
    party.order(drive(9))
    await party.doing("drive 9")
    buttons.press("stop", 2)
    await party.state("paused")
    buttons.press("start", 1)
    await party.hears(TOO_LATE)
    assert party.observer.state("A") == "paused"
    buttons.press("start", 3)
    await party.state("running")


async def test_what_an_earlier_process_showed_may_be_refused_and_halted_but_not_begun(
    buttons: Buttons,
) -> None:
    party = buttons.party
    decide(party, decision="policy", policy="ask_first", press=buttons.number(1, "earlier"))
    await until(lambda: len(buttons.taken) == 2)
    party.order(look("box"))
    await until(lambda: proposals(party))
    (shown,) = proposals(party)
    decide(party, id=shown["id"], decision="approve", press=buttons.number(2, "earlier"))
    await party.hears(TOO_LATE)
    assert party.body.did == []
    decide(party, id=shown["id"], decision="reject", press=buttons.number(3, "earlier"))
    await party.hears("I will not do it")

    decide(party, decision="policy", policy="run_at_once", press=buttons.number(4))
    party.body.far.add(9)
    party.order(drive(9))
    await party.doing("drive 9")
    buttons.press("stop", 5, "earlier")
    await party.state("paused")


async def test_a_press_for_other_steps_hears_what_came_of_it(buttons: Buttons) -> None:
    party = buttons.party
    party.body.gate("box")
    party.order(look("box"), look("door"))
    await party.doing("look box")

    async def outcome(number: int, *steps: ActionCall, revision: int | None = None) -> tuple[str, str]:
        calls = [step.model_dump() for step in steps]
        press = buttons.number(number)
        decide(party, decision="edit", steps=calls, press=press.model_dump(), revision=revision)
        await until(lambda: any(taken.id == press.id and taken.outcome for taken in buttons.taken))
        return next((one.outcome, one.why) for one in buttons.taken if one.id == press.id and one.outcome)

    impossible = await outcome(1, look("lid"), ActionCall(name="Fly"))
    assert impossible[0] == "refused"
    assert impossible[1].startswith("I cannot do step 3, “Fly”: I cannot do such a thing.")
    shown = party.observer.plans["A"].revision
    assert await outcome(3, look("lid")) == ("done", "")
    assert (await outcome(2, look("floor")))[0] == "refused"
    assert (await outcome(4, look("floor"), revision=shown))[0] == "past"
