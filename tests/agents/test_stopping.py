"""The table "Stopping and going on" of the design, row by row, in words, over nodes and a real engine.

Each row: the operator's words, what crosses the wire, what robot and graph do, what of the plan is kept, and
how it goes on.
"""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

import pytest

from parley.messages import ros, topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.principal import person
from parley.messages.status import ActorStatus, StopCommand
from parley.messages.wire import decode
from tests.agents.crew import Crew, ask, crew, decide, drive, look, proposals
from tests.engine.rig import DummyRobot

ASK = ChatAction(success=False, message_response="What should I do?", choices=("try again", "stop"))


@pytest.fixture
async def party() -> AsyncIterator[Crew]:
    """Robot A drives far, and would then look at the door."""
    async with crew("A", talking=True) as party:
        party.body.far.add(1)
        await told(party, "go there and look", drive(1), look("door"))
        await party.doing("drive 1")
        party.wire.seen.clear()
        yield party


@pytest.fixture
async def failed() -> AsyncIterator[Crew]:
    """Robot A could not look at the box, and would then look at the door; its question is open."""
    async with crew("A", talking=True) as party:
        party.body.failures["look box"] = 1
        party.language.will("resolve", ASK, ASK, ASK, ASK)
        await told(party, "look", look("box"), look("door"))
        await party.state("held")
        await party.hears("What should I do?")
        party.wire.seen.clear()
        yield party


async def told(party: Crew, text: str, *calls: object, to: str = "A") -> None:
    """The operator gives an order that is understood as `calls`."""
    party.language.will("interpret", ChatAction.model_validate({"message_response": "Yes.", "queue": calls}))
    party.observer.say(text, to)


def graph_state(party: Crew) -> str:
    """The last state of the newest graph."""
    return [event.state for event in party.observer.events if event.kind == "graph"][-1]


def dropped(party: Crew) -> list[str]:
    """What the operator was told the robot will not do."""
    return [step.state for step in party.observer.plans["A"].steps if step.state in ("stopped", "skipped")]


@pytest.mark.parametrize("words", ["stop", "Wait!", "hold on", "no, no!", "A, pause please"])
@pytest.mark.spec("P1")
async def test_stop_pauses_stands_still_keeps_the_plan_and_carry_on_resumes(party: Crew, words: str) -> None:
    party.observer.say(words, "A")
    await party.hears("I have stopped")
    await party.state("paused")
    assert party.wire.commands() == ["pause"]
    await party.until(lambda: graph_state(party) == "PAUSED")
    assert await party.body.stands_still()
    assert dropped(party) == []
    party.observer.say("carry on", "A")
    await party.hears("I am going on.")
    await party.state("running")
    assert party.wire.commands() == ["pause", "resume"]
    await party.until(lambda: graph_state(party) == "RUNNING")
    party.body.far.clear()
    await party.state("idle")
    assert party.body.did == ["drive 1", "look door"]


@pytest.mark.parametrize(
    "words",
    ["Everybody stop!", "stop, both of you!", "all robots halt, there is smoke here", "B, careful, you two!"],
)
async def test_a_call_to_stop_that_means_several_stops_them_all_whoever_it_is_said_to(words: str) -> None:
    async with crew("A", "B", "C", talking=True) as party:
        for name in ("A", "B"):
            party.bodies[name].far.add(1)
            await told(party, "go there and look", drive(1), look("door"), to=name)
            await party.doing("drive 1", name)
        party.observer.say(words, "C")
        for name in ("A", "B"):
            await party.state("paused", name)
        party.observer.say("carry on", "A")  # what is not said to all is meant for one
        await party.state("running", "A")
        assert party.observer.plans["B"].state == "paused"
        party.observer.say(
            "Everybody carry on.", "A"
        )  # and with all those go on whom nobody else has stopped
        await party.state("running", "B")


@pytest.mark.parametrize("turns", [0, 3, 10])
async def test_a_no_right_behind_somebody_elses_yes_stops_what_the_yes_begins(turns: int) -> None:
    async with crew("A", talking=True, ask_first=["A"]) as party:
        party.body.gate("box")
        party.language.will("interpret", ChatAction(message_response="Yes.", queue=(look("box"),)))
        party.observer.say("look at the box", "A")
        await party.hears("Shall I?")
        party.observer.say("yes", "A")
        for _ in range(turns):  # of the loop: the yes is read, decided on, begun with
            await asyncio.sleep(0)
        party.observer.say("no", "A")
        words = "I have stopped", "I am standing still"  # or so, where it stood before the no was read
        await party.until(lambda: any(word in said for said in party.texts() for word in words))
        await party.state("paused")


async def test_a_no_on_a_card_stops_only_what_a_yes_on_it_has_begun() -> None:
    async with crew("A", ask_first=["A"]) as party:
        party.body.gate("box")
        for thing in ("box", "door", "lid"):
            party.order(look(thing))
        await party.until(lambda: len(proposals(party)) == 3)
        box, door, _ = (item["id"] for item in proposals(party))
        decide(party, id=box, decision="approve")
        await party.doing("look box")
        decide(party, id=door, decision="reject")
        decide(party, id=door, decision="reject")
        await party.hears("That plan is no longer waiting for an answer.")
        assert party.observer.state("A") == "running"
        decide(party, id=box, decision="reject")
        await party.hears("Somebody had said yes already, so I have stopped.")
        await party.state("paused")


async def test_a_correction_that_opens_with_wait_is_carried_out_and_stops_nothing(party: Crew) -> None:
    pops = [{"pop": {"parameters": index}} for index in (0, 1)]
    change = {"message_response": "Then the box.", "queue": [look("box")], "system_cmd": pops}
    party.language.will("interpret", ChatAction.model_validate(change))
    party.observer.say("no wait, not the door, the box", "A")
    await party.hears("Then the box.")
    await party.state("idle")
    assert party.body.did == ["drive 1", "look box"]
    assert "pause" not in party.wire.commands()


@pytest.mark.parametrize("words", ["no wait, not that one", "no! I said the other one"])
async def test_a_correction_of_which_nothing_comes_leaves_the_robot_standing(party: Crew, words: str) -> None:
    party.language.will("interpret", ChatAction(message_response="Which one do you mean?"))
    party.observer.say(words, "A")
    await party.hears("Which one do you mean?")
    await party.hears("I have stopped")
    await party.state("paused")
    assert dropped(party) == []


async def test_a_question_behind_a_call_to_stop_is_answered_while_the_robot_stands(party: Crew) -> None:
    party.language.will("interpret", ChatAction(message_response="It is shut."))
    party.observer.say("wait, is the door open?", "A")
    await party.hears("It is shut.")
    await party.state("paused")
    assert party.language.asked[-1][1].message == "is the door open?"
    assert sum("stopped" in said or "still" in said for said in party.texts()) == 1


@pytest.mark.parametrize("change", [{"clear": {}}, {"pop": {"parameters": 0}}, {"skip": {}}], ids=str)
async def test_what_a_person_stopped_an_engine_neither_lets_go_on_nor_gives_up(
    party: Crew, change: dict[str, object]
) -> None:
    party.observer.say("stop", "A")
    await party.state("paused")
    party.order(commands=[SystemCommand.model_validate(change)])
    await party.until(lambda: proposals(party))
    await party.settled()
    assert dropped(party) == []
    assert await party.body.stands_still()
    assert party.observer.state("A") == "paused"


@pytest.mark.parametrize("words", ["stop! there is a child", "wait, go to the box instead"])
async def test_who_may_only_look_stops_robots_by_words_too_and_orders_nothing(
    party: Crew, words: str
) -> None:
    party.language.will("interpret", ChatAction(message_response="Yes.", queue=(look("box"),)))
    viewer = person("Lee", role="viewer")
    party.observer.publish(topics.CHAT_INPUT, ChatInput(message=words, targets=("A",), id="v", by=viewer))
    await party.hears("I have stopped")
    await party.state("paused")
    assert len(party.steps()) == 2 and proposals(party) == []


async def test_a_step_that_has_not_begun_is_left_out_while_the_robot_stands(party: Crew) -> None:
    party.observer.say("stop", "A")
    await party.state("paused")
    party.order(commands=[SystemCommand.model_validate({"pop": {"parameters": 1}})])
    await party.until(lambda: len(party.steps()) == 1)
    assert proposals(party) == []
    assert party.observer.state("A") == "paused"


async def test_an_engine_does_not_go_on_from_its_own_stop(party: Crew) -> None:
    party.order(commands=[SystemCommand(command="stop")])
    await party.state("paused")
    party.order(look("box"))
    await party.hears("I am still standing still")
    assert party.observer.state("A") == "paused"


async def test_what_is_told_a_robot_that_was_stopped_for_safety_waits_for_the_release_first(
    party: Crew,
) -> None:
    beats: list[str] = []
    await party.transport.subscribe(
        topics.ACTOR_STATUS, lambda said: beats.append(decode(ActorStatus, said.data).state)
    )
    party.observer.publish(topics.STOP, StopCommand(by=person("Kim")))
    await party.state("paused")
    await party.until(lambda: "stopped" in beats)
    await party.settled()
    party.order(look("box"))
    await party.hears("Release the stop first")
    assert not any("still standing still" in text for text in party.texts())


async def test_after_a_stop_instead_of_an_answer_new_steps_wait_for_a_yes(failed: Crew) -> None:
    failed.observer.say("stop", "A")
    await failed.hears("I have stopped")
    failed.order(drive(2))
    await failed.until(lambda: proposals(failed))
    await failed.settled()
    assert "drive 2" not in failed.body.did


async def test_what_is_only_offered_waits_for_a_yes_whatever_else_is_said_of_it(party: Crew) -> None:
    party.observer.say("cancel everything", "A")
    await party.state("idle")
    offer = ChatAction.model_validate({"message_response": "Shall I look?", "offer": [look("lid")]})
    party.language.will("interpret", offer)
    party.observer.say("go and see", "A")
    await party.hears("Shall I?")
    assert "look lid" not in party.body.did
    party.observer.say("yes", "A")
    await party.state("idle")
    assert party.body.did[-1] == "look lid"


async def test_page_button_pause_is_the_same_as_stop(party: Crew) -> None:
    party.command("pause")
    await party.state("paused")
    assert party.wire.commands() == ["pause"]
    assert await party.body.stands_still()


async def test_stop_during_a_step_that_cannot_pause_holds_back_the_next(party: Crew) -> None:
    party.observer.say("cancel everything", "A")
    await party.state("idle")
    party.body.gate("box")
    party.body.did.clear()
    await told(party, "look at both", look("box"), look("lid"))
    await party.doing("look box")
    party.observer.say("stop", "A")
    await party.state("paused")
    party.body.gate("box").set()
    await party.until(lambda: graph_state(party) == "PAUSED")
    await party.settled()
    assert party.body.did == ["look box"]
    party.observer.say("carry on", "A")
    await party.state("idle")
    assert party.body.did == ["look box", "look lid"]


async def test_what_was_stopped_while_away_and_had_ended_is_no_reason_to_ask_later(party: Crew) -> None:
    cable, _ = party._engines["A"]
    party.observer.say("cancel everything", "A")
    await party.state("idle")
    party.body.gate("box")
    await told(party, "look", look("box"))
    await party.doing("look box")
    cable.cut = True
    party.observer.publish(topics.STOP, StopCommand(by=person()))
    await party.settled()
    cable.cut = False
    party.body.gate("box").set()
    await party.state("idle")
    await told(party, "go there", drive(1))
    await party.state("running")
    party.order(commands=[SystemCommand.model_validate({"clear": {}})])
    await party.state("idle")
    assert not proposals(party)


async def test_try_again_after_a_failure_continues_from_the_failed_step(failed: Crew) -> None:
    failed.observer.say("try again", "A")
    await failed.hears("I am going on.")
    await failed.state("idle")
    assert failed.wire.commands() == ["modify"]
    modify: ros.UmrfGraphModify = failed.wire.of(topics.GRAPH_MODIFY)[0]
    assert modify.continue_from.startswith("Look_")
    assert failed.body.did == ["look box", "look box", "look door"]
    assert failed.observer.questions.newest("A") is None


async def test_skip_this_ends_the_running_step_and_continues_with_the_next(party: Crew) -> None:
    party.observer.say("skip this", "A")
    await party.hears("leave that step out")
    await party.state("idle")
    assert [name for name, _ in party.wire.seen if name in (topics.STEP.name, topics.GRAPH_MODIFY.name)] == [
        topics.STEP.name, topics.GRAPH_MODIFY.name,
    ]  # fmt: skip
    assert party.wire.continued_from() == "Look_1"
    assert party.steps() == ["skipped", "finished"]
    assert await party.body.stands_still()


async def test_skip_this_after_a_failure_leaves_the_failed_step_out(failed: Crew) -> None:
    failed.observer.say("skip it", "A", answer=True)
    await failed.hears("leave that step out")
    await failed.state("idle")
    assert failed.wire.continued_from() == "Look_1"
    assert failed.body.did == ["look box", "look door"]
    assert failed.observer.questions.newest("A") is None


async def test_drop_the_second_one_changes_the_graph_and_leaves_it_running(party: Crew) -> None:
    order = ChatAction.model_validate(
        {"message_response": "Dropped.", "system_cmd": [{"pop": {"parameters": "1"}}]}
    )
    party.language.will("interpret", order)
    party.observer.say("drop the second one", "A")
    await party.until(lambda: party.steps() == ["running"])
    assert party.wire.commands() == ["modify"]
    assert party.wire.continued_from() == ""
    assert not await party.body.stands_still()
    party.body.far.clear()
    await party.state("idle")
    assert party.body.did == ["drive 1"]


@pytest.mark.spec("P5")
async def test_cancel_everything_stops_the_graph_empties_the_plan_and_a_new_order_runs(party: Crew) -> None:
    party.observer.say("cancel everything", "A")
    await party.hears("I have dropped everything.")
    await party.until(lambda: graph_state(party) == "STOPPED")
    assert party.wire.commands() == ["stop"]
    await party.state("idle")
    told_of = [item["steps"] for item in party.wire.objects(topics.PLAN) if item["kind"] == "update"]
    assert ["stopped", "stopped"] in [[step["state"] for step in steps] for steps in told_of]
    assert await party.body.stands_still()
    party.observer.say("carry on", "A")
    await party.hears("There is nothing left to go on with.")
    await told(party, "look at the lid", look("lid"))
    await party.until(lambda: party.body.did == ["drive 1", "look lid"])
    await party.state("idle")


async def test_cancel_everything_during_a_repair_withdraws_the_question(failed: Crew) -> None:
    failed.observer.say("cancel everything", "A")
    await failed.state("idle")
    await failed.until(lambda: failed.observer.questions.newest("A") is None)
    await told(failed, "look at the lid", look("lid"))
    await failed.until(lambda: failed.body.did == ["look box", "look lid"])


@pytest.mark.parametrize("how", ["in words", "by the button"])
async def test_emergency_stop_goes_past_the_nodes_latches_and_a_person_must_reset_it(how: str) -> None:
    robot = DummyRobot()
    async with crew(talking=True) as party:
        await party.engine("A", robot)
        party.body.far.add(1)
        await told(party, "go there and look", drive(1), look("door"))
        await party.doing("drive 1")
        party.wire.seen.clear()
        if how == "in words":
            party.observer.say("emergency stop", "A")
            await party.hears("Emergency stop!")
        else:
            party.observer.publish(topics.STOP, StopCommand())
        await party.until(lambda: [r.state for r in party.observer.stop_reports] == ["received", "at_rest"])
        await party.state("paused")
        assert party.wire.commands() == []
        assert set(robot.told) == {"halt"}
        assert await party.body.stands_still()
        assert dropped(party) == []
        party.observer.say("carry on", "A")
        await party.hears("Release the stop first")
        assert await party.body.stands_still()
        party.observer.publish(topics.STOP, StopCommand(command="reset", by=person("Kim")))
        await party.until(lambda: party.observer.stop_reports[-1].state == "reset")
        assert await party.body.stands_still()
        party.body.far.clear()
        party.observer.say("carry on", "A")
        await party.state("idle")
        assert party.body.did == ["drive 1", "look door"]


async def test_order_that_is_being_understood_when_the_stop_button_is_pressed_moves_nobody() -> None:
    async with crew("A", talking=True) as party:
        thinking = asyncio.Event()
        party.language.will("interpret", thinking)
        await told(party, "look at the box", look("box"))
        await party.until(lambda: party.language.asked)
        party.observer.publish(topics.STOP, StopCommand(targets=("A",)))
        await party.until(lambda: party.wire.of(topics.STOP))
        await party.settled()
        thinking.set()
        await party.hears("You told me to stop")
        assert party.wire.commands() == []


@pytest.mark.spec("P1")
async def test_last_attempt_of_error_handling_pauses_holds_and_tells_what_remains(failed: Crew) -> None:
    for _ in range(3):
        await failed.until(lambda: failed.observer.questions.newest("A") is not None)
        failed.observer.say("purple", "A", answer=True)
    await failed.hears("I could not solve this")
    await failed.until(lambda: failed.wire.commands() == ["pause"])
    last = failed.texts()[-1]
    assert "I cannot look box. Left to do: look at the box; look at the door." in last
    assert failed.observer.state("A") == "held"
    assert failed.body.did == ["look box"]


@pytest.mark.parametrize(
    ("words", "did"),
    [
        ("try again", ["look box", "look box", "look door"]),
        ("skip it", ["look box", "look door"]),
        ("cancel everything", ["look box"]),
    ],
)
async def test_after_the_last_attempt_any_order_goes_on(failed: Crew, words: str, did: list[str]) -> None:
    for _ in range(3):
        await failed.until(lambda: failed.observer.questions.newest("A") is not None)
        failed.observer.say("purple", "A", answer=True)
    await failed.hears("I could not solve this")
    assert words in failed.observer.said[-1].choices  # it is a tap away, too
    failed.observer.say(words, "A")
    await failed.state("idle")
    await failed.settled()
    assert failed.body.did == did


async def test_after_the_last_attempt_a_new_order_takes_the_failed_steps_place(failed: Crew) -> None:
    for _ in range(3):
        await failed.until(lambda: failed.observer.questions.newest("A") is not None)
        failed.observer.say("purple", "A", answer=True)
    await failed.hears("I could not solve this")
    await told(failed, "look at the lid", look("lid"))
    await failed.state("idle")
    assert failed.body.did == ["look box", "look lid", "look door"]


async def test_stop_during_a_repair_closes_the_question_and_keeps_the_plan(failed: Crew) -> None:
    failed.observer.say("stop", "A", answer=True)
    await failed.hears("I have stopped")
    assert failed.observer.state("A") == "held"
    assert failed.texts()[-1].startswith("I have stopped")
    failed.observer.say("carry on", "A")
    await failed.state("idle")
    assert failed.body.did == ["look box", "look box", "look door"]


async def test_stopping_another_robot_leaves_the_question_of_this_one_open() -> None:
    async with crew("A", "B", talking=True) as party:
        party.body.failures["look box"] = 1
        party.language.will("resolve", ASK)
        await told(party, "look", look("box"))
        await party.hears("What should I do?")
        party.observer.say("B, stop!", "A")
        await party.hears("I am standing still.")
        await party.settled()
        party.language.will("resolve", ChatAction(success=True, queue=(look("lid"),)))
        party.observer.say("the lid", "A", answer=True)
        await party.until(lambda: party.body.did == ["look box", "look lid"])


async def test_carry_on_with_nothing_to_do_says_so_once() -> None:
    async with crew("A", talking=True) as party:
        for words in ("carry on", "skip it", "cancel everything", "stop", "forget everything"):
            party.observer.say(words, "A")
        await party.until(lambda: len(party.texts()) == 5)
        await party.settled()
        *told, forgetting = party.texts()
        assert told == [
            "There is nothing left to go on with.", "There is no step to skip.", "There was nothing to drop.",
            "I am standing still.",
        ]  # fmt: skip
        assert forgetting.startswith("There was nothing to drop. What you told me I still know;")


async def test_robot_that_is_away_is_named_as_away_but_stopped_even_so(party: Crew) -> None:
    await party.lose("A")
    await party.hears("I have lost contact with A")
    party.observer.say("look at the lid", "A")
    await party.hears("A is not there at the moment")
    party.observer.say("stop", "A")
    await party.until(lambda: "pause" in party.wire.commands())


async def test_carry_on_while_a_question_is_open_resumes_a_paused_plan_and_leaves_the_question_open() -> None:
    async with crew("A", talking=True) as party:
        question = ChatFeedback(message="Ready?", targets=("A",), type="request", id="1")
        await told(party, "ask me", ask("ready"))
        await party.doing("ask ready")
        party.observer.publish(topics.CHAT_FEEDBACK, question)
        await party.hears("Ready?")
        party.observer.say("stop", "A")
        await party.state("paused")
        party.observer.say("carry on", "A", answer=True)
        await party.hears("I am going on.")
        await party.state("running")
