"""Repairs that waited for a yes when the process ended, and yes and no in the conversation."""

from __future__ import annotations

from pathlib import Path

from parley.agents.planner.steps import Step
from parley.clock import WallClock
from parley.memory.proposals import ProposalStore
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatInput
from parley.messages.status import StopCommand
from tests.agents.crew import KIM, Crew, crew, decide, drive, find, look, proposals


async def left_repair(file: Path) -> str:
    """A repair waits for a yes when everything ends; its id."""
    async with (
        await ProposalStore.open(file, WallClock()) as store,
        crew("A", ask_first=["A"], proposals=store) as party,
    ):
        party.body.failures["look box"] = 1
        party.order(look("box"), look("door"))
        await party.until(lambda: proposals(party))
        decide(party, id=proposals(party)[0]["id"], decision="approve")
        await party.state("held")
        party.correct(look("lid"))
        await party.until(lambda: len(proposals(party)) == 2)
        return str(proposals(party)[1]["id"])


async def test_a_repair_waits_again_in_the_place_of_the_step_that_failed(tmp_path: Path) -> None:
    identity = await left_repair(tmp_path / "proposals.db")
    async with await ProposalStore.open(tmp_path / "proposals.db", WallClock()) as store:
        async with crew("A", ask_first=["A"], proposals=store) as party:
            party.planner.restore("A", [Step(look("box")), Step(look("door"))])
            party.planner.offer_again()
            await party.hears("a way out of what failed waited for your yes")
            await party.state("held")
            assert [item["id"] for item in proposals(party)] == [identity]
            decide(party, id=identity, decision="approve")
            await party.state("idle")
            assert party.body.did == ["look lid", "look door"]
        assert await store.waiting() == ()


async def test_a_repair_of_a_plan_that_is_gone_is_dropped_and_said(tmp_path: Path) -> None:
    await left_repair(tmp_path / "proposals.db")
    async with await ProposalStore.open(tmp_path / "proposals.db", WallClock()) as store:
        async with crew("A", ask_first=["A"], proposals=store) as party:
            party.planner.offer_again()
            await party.hears("not possible any more")
            assert proposals(party) == []
            party.order(look("chair"))
            await party.until(lambda: proposals(party))
        assert [kept.proposal.id for kept in await store.waiting()] == [proposals(party)[0]["id"]]


async def test_what_was_ordered_during_an_emergency_stop_waits_for_a_yes_after_a_restart(
    tmp_path: Path,
) -> None:
    async with await ProposalStore.open(tmp_path / "proposals.db", WallClock()) as store:
        async with crew("A", proposals=store) as party:
            await stopped(party)
            party.order(look("box"))
            party.order(look("lid"))
            await party.until(lambda: len(party.steps()) == 2)
            await party.state("paused")
            await party.settled()
        async with crew("A", proposals=store) as party:
            party.planner.offer_again()
            await party.until(lambda: proposals(party))
            (left,) = proposals(party)
            assert left["lines"] == ["Look: what “box”", "Look: what “lid”"]
            assert party.body.did == []
            decide(party, id=left["id"], decision="approve")
            await party.until(lambda: party.body.did == ["look box", "look lid"])


async def test_what_began_after_an_emergency_stop_is_not_offered_again(tmp_path: Path) -> None:
    async with await ProposalStore.open(tmp_path / "proposals.db", WallClock()) as store:
        async with crew("A", proposals=store) as party:
            await stopped(party)
            party.order(look("box"))
            await party.state("paused")
            party.observer.publish(topics.STOP, StopCommand(command="reset", by=KIM))
            await party.until(lambda: "reset" in [r.state for r in party.observer.stop_reports])
            party.command("start")
            await party.state("idle")
        assert await store.waiting() == ()


async def stopped(party: Crew) -> None:
    """Somebody has pressed the button, and it holds."""
    party.observer.publish(topics.STOP, StopCommand(by=KIM))
    await party.until(lambda: "received" in [report.state for report in party.observer.stop_reports])


async def test_a_robot_that_comes_later_is_offered_it_then(tmp_path: Path) -> None:
    async with await ProposalStore.open(tmp_path / "proposals.db", WallClock()) as store:
        async with crew("A", ask_first=["A"], proposals=store) as party:
            party.order(look("box"))
            await party.until(lambda: proposals(party))
        async with crew(ask_first=["A"], proposals=store) as party:
            party.planner.offer_again()
            await party.settled()
            assert proposals(party) == []
            await party.engine("A")
            await party.until(lambda: proposals(party))
            decide(party, id=proposals(party)[0]["id"], decision="approve")
            await party.until(lambda: party.body.did == ["look box"])


async def test_a_robot_asks_before_and_announces_after_the_yes() -> None:
    async with crew("A", ask_first=["A"], talking=True) as party:
        await party.until(lambda: "A" in party.observer.plans)
        order = ChatAction(message_response="I will look at the box.", queue=(look("box"),))
        party.language.will("interpret", order)
        party.observer.publish(
            topics.CHAT_INPUT, ChatInput(message="look at the box", targets=("A",), id="1")
        )
        await party.until(lambda: proposals(party))
        await party.hears("This is what I would do: Look: what “box”. Shall I?")
        assert "I will look at the box." not in party.texts()
        assert party.body.did == []
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="yes", targets=("A",), id="2"))
        await party.until(lambda: party.body.did == ["look box"])
        await party.hears("All right: Look: what “box”.")
        assert "I will look at the box." not in party.texts()


async def test_a_no_in_words_leaves_it() -> None:
    async with crew("A", ask_first=["A"], talking=True) as party:
        await party.until(lambda: "A" in party.observer.plans)
        party.language.will("interpret", ChatAction(message_response="I will look.", queue=(look("box"),)))
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",), id="1"))
        await party.state("awaiting_approval")
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="no, thanks", targets=("A",), id="2"))
        await party.hears("I will not do it.")
        await party.state("idle")
        assert party.body.did == []


async def test_the_end_of_what_was_asked_is_said_once() -> None:
    async with crew("A", talking=True) as party:
        order = ChatAction(message_response="I will go.", queue=(find("box"), drive()))
        party.language.will("interpret", order)
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="go to the box", targets=("A",), id="1"))
        await party.hears("I have finished")
        await party.settled()
        (told,) = [said for said in party.observer.said if "finished" in said.message]
        assert (told.type, told.targets) == ("info", ("A",))


async def test_a_cancelled_order_is_not_called_finished() -> None:
    async with crew("A", talking=True) as party:
        party.body.far.add(3.0)
        order = ChatAction(message_response="I will go.", queue=(find("box"), drive()))
        party.language.will("interpret", order)
        party.observer.publish(topics.CHAT_INPUT, ChatInput(message="go to the box", targets=("A",), id="1"))
        await party.doing("drive 3")
        party.command("clear")
        await party.state("idle")
        await party.settled()
        assert not any("finished" in text for text in party.texts())


async def test_where_only_risky_things_are_asked_about_the_rest_is_announced() -> None:
    async with crew("A", talking=True) as party:
        decide(party, decision="policy", policy="ask_when_risky")
        await party.until(
            lambda: "A" in party.observer.plans and party.observer.plans["A"].policy == "ask_when_risky"
        )
        press = look("bell").model_copy(update={"name": "Press"})
        for number, (text, call) in enumerate([("I will look.", look("box")), ("I will press it.", press)]):
            party.language.will("interpret", ChatAction(message_response=text, queue=(call,)))
            said = ChatInput(message=f"do it, part {number}", targets=("A",), id=str(number))
            party.observer.publish(topics.CHAT_INPUT, said)
        await party.hears("This is what I would do: Press: what “bell”. Shall I?")
        assert "I will look." in party.texts()
        assert "I will press it." not in party.texts()
        await party.until(lambda: party.body.did == ["look box"])
