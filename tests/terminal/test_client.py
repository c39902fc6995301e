"""The client over a real transport, with lines as they come from a pipe; the test plays the other nodes."""

from __future__ import annotations

import asyncio
import io
import os
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import TextIO

import pytest
from rich.console import Console as RichConsole

from parley.messages import topics
from parley.messages.chat import ChatInput, ChatRead
from parley.messages.memory import MemoryReply, StoredMemory
from parley.messages.principal import person
from parley.messages.ros import ChatRequest, ChatResponse, String
from parley.messages.status import PlanProposal, Pulse, StopReport
from parley.messages.wire import decode, encode
from parley.terminal import TerminalClient
from parley.terminal.console import ConsoleEvents, PlainConsole
from parley.transport.local import LocalTransport
from tests.terminal.robots import PlayedRobots, call, plan, step, until


class Typewriter(io.TextIOWrapper):
    """The reading end of a pipe that counts as a keyboard or not."""

    def __init__(self, fd: int, *, is_keyboard: bool) -> None:
        super().__init__(os.fdopen(fd, "rb"), encoding="utf-8")
        self._is_keyboard = is_keyboard

    def isatty(self) -> bool:
        return self._is_keyboard


@dataclass
class Session:
    """A running client and everything around it."""

    robots: PlayedRobots
    client: TerminalClient
    task: asyncio.Task[bool]
    screen: io.StringIO
    keyboard: TextIO
    transport: LocalTransport

    @property
    def shown(self) -> str:
        return self.screen.getvalue()

    def type(self, *lines: str) -> None:
        for line in lines:
            self.keyboard.write(f"{line}\n")
        self.keyboard.flush()

    async def shows(self, text: str) -> None:
        await until(lambda: text in self.shown)

    async def ends(self) -> None:
        async with asyncio.timeout(10):
            await self.task


@asynccontextmanager
async def opened(*, is_keyboard: bool = True, lang: str = "en") -> AsyncIterator[Session]:
    readable, writable = os.pipe()
    screen = io.StringIO()
    with Typewriter(readable, is_keyboard=is_keyboard) as source, os.fdopen(writable, "w") as keyboard:

        def console(events: ConsoleEvents) -> PlainConsole:
            return PlainConsole(events, source=source, out=RichConsole(file=screen, width=200))

        async with LocalTransport() as transport:
            robots = PlayedRobots(transport)
            await robots.listen()
            client = TerminalClient(transport, lang=lang, console=console)
            task = asyncio.create_task(client.run(greeting=("go to the box",), engine="clockwork"))
            session = Session(robots, client, task, screen, keyboard, transport)
            await session.shows("Ctrl-D")
            robots.appear("Ada")
            await session.shows("Ada")
            yield session
            keyboard.close()
            await session.ends()
            assert transport.handler_failures == 0


async def test_the_operator_is_greeted_with_examples_and_told_what_understands_them() -> None:
    async with opened() as session:
        assert "What understands you: clockwork." in session.shown
        assert "“go to the box”" in session.shown


async def test_words_reach_the_selected_robot_and_its_answer_is_shown() -> None:
    async with opened() as session:
        session.robots.answer = lambda message: session.robots.say("I will go to the box.")
        session.type("go to the box")
        await session.shows("Ada: I will go to the box.")
        (message,) = session.robots.inputs
        assert (message.message, message.targets, message.type) == ("go to the box", ("Ada",), "request")
        assert message.id


async def test_words_that_nobody_reads_are_told_and_those_that_are_read_are_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("parley.terminal.client.READ_WITHIN_S", 0.3)
    async with opened() as session:
        read = session.transport.publisher(topics.CHAT_READ)
        session.robots.answer = lambda message: read.publish(String(encode(ChatRead(id=message.id))))
        session.type("go to the box")
        await until(lambda: session.robots.inputs)
        await asyncio.sleep(0.6)
        assert "Nobody has read" not in session.shown
        session.robots.answer = lambda message: None
        session.type("go to the shelf")
        await session.shows("Nobody has read that:")


async def test_a_question_is_answered_by_number() -> None:
    async with opened() as session:
        session.robots.ask("Which box?", "red box", "blue box", question_id="q7")
        await session.shows("Ada: ? Which box?\n    1. red box\n    2. blue box")
        session.type("2")
        await until(lambda: session.robots.inputs)
        (message,) = session.robots.inputs
        assert (message.message, message.type, message.reply_to) == ("blue box", "response", "q7")


async def test_the_question_that_is_still_open_is_shown_again_after_an_answer() -> None:
    async with opened() as session:
        session.robots.ask("Is the door open?", question_id="q1")
        session.robots.ask("Which box?", "red", "blue", question_id="q2")
        await session.shows("2. blue")
        session.type("2", "yes")
        await until(lambda: len(session.robots.inputs) == 2)
        assert [message.reply_to for message in session.robots.inputs] == ["q2", "q1"]
        assert session.shown.count("Ada: ? Is the door open?") == 2


async def test_words_before_any_robot_is_there_are_not_lost_in_silence() -> None:
    async with opened() as session:
        session.robots.appear("Ada", state="leaving")
        await session.shows("Ada has left.")
        session.type("go to the box")
        await session.shows("nobody was told")
        assert session.robots.inputs == []


async def test_a_proposed_plan_is_approved() -> None:
    async with opened() as session:
        steps = (call("Go", "go there"), call("Look", "look there"))
        labels = ("drive to the box", "look there")
        proposal = PlanProposal(id="p1", target="Ada", steps=steps, labels=labels, digest="d1")
        session.robots.tell(topics.PLAN, proposal)
        await session.shows("1. drive to the box\n")
        await session.shows("2. look there\n")
        await session.shows("Answer yes or no.")
        session.type("yes")
        await until(lambda: session.robots.decisions)
        (decision,) = session.robots.decisions
        assert (decision.id, decision.decision, decision.digest) == ("p1", "approve", "d1")
        assert decision.by == person(device="terminal")
        assert session.robots.inputs == []


@pytest.mark.parametrize(("argument", "policy"), [("on", "ask_first"), ("off", "run_at_once")])
async def test_approval_is_switched(argument: str, policy: str) -> None:
    async with opened() as session:
        session.type(f"/approve {argument}")
        await until(lambda: session.robots.decisions)
        decision = session.robots.decisions[0]
        assert (decision.target, decision.decision, decision.policy) == ("Ada", "policy", policy)


async def test_approval_without_on_or_off_explains_itself() -> None:
    async with opened() as session:
        session.type("/approve maybe")
        await session.shows("/approve off: plans begin at once")
        assert session.robots.decisions == []


async def test_stop_and_reset_go_to_the_selected_robot_or_to_all() -> None:
    async with opened() as session:
        session.type("/stop", "/reset", "/stop all", "/reset all")
        await until(lambda: len(session.robots.stops) == 4)
        sent = [(stop.command, stop.targets) for stop in session.robots.stops]
        assert sent == [("stop", ("Ada",)), ("reset", ("Ada",)), ("stop", ()), ("reset", ())]
        assert len({stop.id for stop in session.robots.stops}) == 4
        await session.shows("To let it move again: /reset")


async def test_another_robot_is_selected() -> None:
    async with opened() as session:
        session.robots.appear("Bo")
        await session.shows("Bo is here.")
        session.type("/robot bo", "/robots", "go to the door")
        await until(lambda: session.robots.inputs)
        assert session.robots.inputs[0].targets == ("Bo",)
        assert "▶ Bo: ready" in session.shown


async def test_an_unknown_robot_or_command_is_said_to_be_unknown() -> None:
    async with opened() as session:
        session.type("/robot Zed", "/pln", "/xyzzy")
        await session.shows("There is no robot called Zed. Here now: Ada.")
        await session.shows("There is no command /pln. Did you mean /plan?")
        await session.shows("There is no command /xyzzy.")
        assert session.robots.inputs == []


async def test_help_and_plan_are_shown() -> None:
    async with opened() as session:
        session.robots.tell(topics.PLAN, plan(step("find the box", "finished"), step("go there", "running")))
        await session.shows("Ada's plan:")
        session.type("/plan", "/help")
        await session.shows("/memory")
        await session.shows("✓ find the box (done)\n  ▶ 1. go there (now)")


async def test_memory_is_shown() -> None:
    async def remember(request: ChatRequest) -> ChatResponse:
        assert "return all memories" in request.message
        bodies = {
            "box place": StoredMemory(data="The box is by the door."),
            "photo": StoredMemory(type="image", data="AAAA", info="the door"),
        }
        return ChatResponse(encode(MemoryReply(bodies)))

    async with opened() as session:
        await session.transport.serve(topics.GET_MEMORY, remember)
        session.type("/memory")
        await session.shows("• The box is by the door.")
        await session.shows("• a picture: the door")


async def test_a_memory_that_does_not_answer_is_told_plainly() -> None:
    async with opened() as session:
        session.type("/memory")
        await session.shows("The memory does not answer at the moment.")


async def test_unreadable_messages_are_skipped() -> None:
    async with opened() as session:
        for topic in (topics.CHAT_FEEDBACK, topics.PLAN, topics.GRAPH_EVENTS, topics.ACTOR_STATUS):
            publisher = session.transport.publisher(topic)
            publisher.publish(topic.type("{nonsense"))
            publisher.publish(topic.type("[]"))
            publisher.close()
        session.robots.say("Still here.")
        await session.shows("Ada: Still here.")


async def test_markup_and_control_characters_in_words_are_shown_as_text() -> None:
    async with opened() as session:
        session.robots.say("[red]not red[/red] \x1b[2J[/]")
        await session.shows("[red]not red[/red]")
        await asyncio.sleep(0)
        assert "\x1b[2J" not in session.shown


async def test_quit_leaves() -> None:
    async with opened() as session:
        session.type("/quit")
        await session.ends()
        assert session.shown.endswith("Goodbye.\n")


async def test_estonian_is_spoken_and_what_is_sent_back_stays_as_it_was() -> None:
    async with opened(lang="et") as session:
        assert "Ada on kohal." in session.shown
        session.robots.tell(topics.PLAN, plan(step("go to the box", "running")))
        await session.shows("mine kohta box (praegu)")
        session.robots.ask("Which one do you mean: the box or the gate?", "go to the box")
        await session.shows("Millist sa mõtled: box või gate?")
        await session.shows("1. mine kohta box")
        session.type("1")
        await until(lambda: bool(session.robots.inputs))
        assert session.robots.inputs[-1].message == "go to the box"


async def test_prepared_lines_wait_for_each_other_and_for_the_robot() -> None:
    async with opened(is_keyboard=False) as session:
        robots = session.robots

        def answer(message: ChatInput) -> None:
            if message.message == "go to the box":
                robots.say("I will.")
                robots.tell(topics.PLAN, plan(step("go there", "running")))

        robots.answer = answer
        session.type("go to the box", "thank you")
        session.keyboard.close()
        await session.shows("Ada's plan:")
        await asyncio.sleep(0.7)
        assert len(robots.inputs) == 1, "the second line must wait until the robot is done"
        robots.ask("Which box?", "red", "blue")
        await until(lambda: len(robots.inputs) == 2)
        assert robots.inputs[1].type == "response"
        robots.say("Understood.")
        await asyncio.sleep(0.7)
        assert not session.task.done(), "the end of the lines must wait until the robot is done"
        robots.tell(topics.PLAN, plan(step("go there", "finished"), state="idle"))
        await session.ends()
        assert "✓ go there (done)" in session.shown


async def test_ctrl_c_stops_a_robot_that_works_and_leaves_when_pressed_again() -> None:
    async with opened() as session:
        session.robots.tell(topics.PLAN, plan(step("go there", "running")))
        await session.shows("Ada's plan:")
        os.kill(os.getpid(), signal.SIGINT)
        await until(lambda: session.robots.stops)
        assert session.robots.stops[0].targets == ("Ada",)
        await session.shows("Press Ctrl-C again to leave.")
        os.kill(os.getpid(), signal.SIGINT)
        await session.ends()


async def test_ctrl_c_leaves_when_no_robot_works() -> None:
    async with opened() as session:
        os.kill(os.getpid(), signal.SIGINT)
        await session.ends()
        assert session.robots.stops == []


async def test_nothing_is_left_open() -> None:
    async with LocalTransport() as transport:
        before = transport.endpoints()
        client = TerminalClient(
            transport,
            console=lambda events: PlainConsole(
                events, source=io.StringIO("/quit\n"), out=RichConsole(file=io.StringIO())
            ),
        )
        robots = PlayedRobots(transport)
        async with asyncio.timeout(10):
            running = asyncio.create_task(client.run())
            await until(lambda: len(transport.endpoints()) > len(before))
            robots.appear()
            await running
        assert transport.endpoints() == before


async def test_a_stop_that_no_robot_confirmed_goes_with_each_sign_of_life_of_the_terminal() -> None:
    pulses: list[Pulse] = []
    async with opened() as session:
        await session.transport.subscribe(topics.PULSE, lambda told: pulses.append(decode(Pulse, told.data)))
        session.robots.appear()
        await session.shows("Ada")
        session.type("/stop")
        await until(lambda: pulses and [stop.targets for stop in pulses[-1].stops] == [("Ada",)])
        session.robots.tell(topics.STOP_REPORT, StopReport(actor="Ada", id="s1", state="received"))
        await until(lambda: not pulses[-1].stops)
