"""The prompt on a real pseudo terminal: keys go in at one end, what the operator would see comes out."""

from __future__ import annotations

import asyncio
import codecs
import contextlib
import fcntl
import os
import pty
import signal
import struct
import termios
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any, TextIO

import pytest
from prompt_toolkit.data_structures import Size
from prompt_toolkit.input.vt100 import Vt100Input
from prompt_toolkit.output.vt100 import Vt100_Output

from parley.messages import topics
from parley.messages.status import GraphEvent
from parley.terminal import TerminalClient
from parley.terminal.prompt import PromptConsole
from parley.transport.local import LocalTransport
from tests.terminal.robots import PlayedRobots, plan, step, until
from tests.terminal.screen import Screen

CTRL_C, CTRL_D, ESCAPE, UP = "\x03", "\x04", "\x1b", "\x1b[A"
SIZE = Size(rows=40, columns=120)


class WatchedOutput(Vt100_Output):
    """Writes to the terminal, and notes whether it would echo a key typed at that moment."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.echoing: dict[str, bool] = {}

    def write_raw(self, data: str) -> None:
        with contextlib.suppress(termios.error):  # the terminal is gone
            local_modes = termios.tcgetattr(self.fileno())[3]
            self.echoing[data] = bool(local_modes & termios.ECHO)
        super().write_raw(data)


@dataclass
class Terminal:
    """The far end of a pseudo terminal, and who plays the robots."""

    robots: PlayedRobots
    task: asyncio.Task[bool]
    fd: int
    output: WatchedOutput
    screen: Screen = field(default_factory=lambda: Screen(SIZE.columns))

    def __post_init__(self) -> None:
        self._decoder = codecs.getincrementaldecoder("utf-8")()

    def hang_up(self) -> None:
        asyncio.get_running_loop().remove_reader(self.fd)
        os.close(self.fd)
        self.fd = -1

    def press(self, keys: str) -> None:
        os.write(self.fd, keys.encode())

    def receive(self) -> None:
        for answer in self.screen.feed(self._decoder.decode(os.read(self.fd, 65536))):
            self.press(answer)

    async def shows(self, text: str) -> None:
        try:
            await until(lambda: text in self.screen.text)
        except TimeoutError:
            pytest.fail(f"never showed {text!r}, but:\n{self.screen.text}")

    async def ends(self) -> None:
        async with asyncio.timeout(10):
            await self.task


@asynccontextmanager
async def opened() -> AsyncIterator[Terminal]:
    loop = asyncio.get_running_loop()
    far, near = pty.openpty()
    fcntl.ioctl(near, termios.TIOCSWINSZ, struct.pack("HHHH", *SIZE, 0, 0))
    sink = os.fdopen(near, "w")
    with os.fdopen(near, "r", closefd=False) as source, contextlib.ExitStack() as stack:
        stack.callback(close, sink)
        keyboard, screen = Vt100Input(source), WatchedOutput(sink, lambda: SIZE, term="xterm-256color")
        async with LocalTransport() as transport:
            robots = PlayedRobots(transport)
            await robots.listen()
            client = TerminalClient(
                transport,
                lang="en",
                console=lambda events: PromptConsole(events, keyboard=keyboard, screen=screen),
            )
            terminal = Terminal(robots, asyncio.create_task(client.run()), far, screen)
            loop.add_reader(far, terminal.receive)
            try:
                await terminal.shows("Ctrl-D")
                robots.appear("Ada")
                await terminal.shows("You → Ada:")
                yield terminal
                await terminal.ends()
            finally:
                terminal.task.cancel()
                await asyncio.gather(terminal.task, return_exceptions=True)
                if terminal.fd >= 0:
                    terminal.hang_up()
            assert transport.handler_failures == 0


def close(sink: TextIO) -> None:
    with contextlib.suppress(OSError):  # what was not written when the terminal went away
        sink.close()


async def test_words_are_sent_and_answers_appear_above_the_prompt() -> None:
    async with opened() as terminal:
        terminal.robots.answer = lambda message: terminal.robots.say(f"I heard: {message.message}")
        terminal.press("go to the box\r")
        await terminal.shows("Ada: I heard: go to the box")
        terminal.press(CTRL_D)
        await terminal.shows("Goodbye.")


async def test_earlier_words_come_back_from_the_history() -> None:
    async with opened() as terminal:
        terminal.press("go to the box\r")
        await until(lambda: len(terminal.robots.inputs) == 1)
        terminal.press(f"{UP}\r")
        await until(lambda: len(terminal.robots.inputs) == 2)
        assert terminal.robots.inputs[0].message == terminal.robots.inputs[1].message == "go to the box"
        terminal.press(CTRL_D)


async def test_the_live_plan_shows_how_far_the_step_is() -> None:
    async with opened() as terminal:
        terminal.robots.tell(topics.PLAN, plan(step("go to the box", "running", "b_0")))
        await terminal.shows("Ada: working")
        terminal.robots.tell(
            topics.GRAPH_EVENTS,
            GraphEvent(
                actor="Ada", graph_name="g1", sequence=3, kind="progress", node="b_0",
                progress=0.5, progress_text="1.2 m",
            ),
        )  # fmt: skip
        await terminal.shows("████████░░░░░░░░ 50 %  1.2 m")
        terminal.press(CTRL_D)


async def test_ctrl_c_is_an_emergency_stop_while_the_robot_works() -> None:
    async with opened() as terminal:
        terminal.robots.tell(topics.PLAN, plan(step("go to the box", "running", "b_0")))
        await terminal.shows("Ada: working")
        terminal.press(CTRL_C)
        await until(lambda: terminal.robots.stops)
        assert terminal.robots.stops[0].targets == ("Ada",)
        await terminal.shows("/reset")
        terminal.press(CTRL_C)
        await terminal.shows("Goodbye.")


async def test_an_interrupt_from_outside_is_the_same_as_ctrl_c() -> None:
    async with opened() as terminal:
        terminal.robots.tell(topics.PLAN, plan(step("go to the box", "running", "b_0")))
        await terminal.shows("Ada: working")
        os.kill(os.getpid(), signal.SIGINT)
        await until(lambda: terminal.robots.stops)
        os.kill(os.getpid(), signal.SIGINT)
        await terminal.ends()


async def test_a_terminal_that_goes_away_ends_the_conversation() -> None:
    async with opened() as terminal:
        terminal.hang_up()
        await terminal.ends()


async def test_ctrl_c_at_an_empty_prompt_leaves_while_nothing_moves() -> None:
    async with opened() as terminal:
        terminal.press(CTRL_C)
        await terminal.ends()
        assert terminal.robots.stops == []


async def test_ctrl_c_with_words_at_the_prompt_stops_and_takes_the_words_away() -> None:
    async with opened() as terminal:
        terminal.press("go to the")
        await terminal.shows("go to the")
        terminal.press(CTRL_C)
        await until(lambda: terminal.robots.stops)
        terminal.press("door\r")
        await until(lambda: terminal.robots.inputs)
        assert terminal.robots.inputs[0].message == "door"
        terminal.press(CTRL_D)


async def test_escape_twice_is_an_emergency_stop() -> None:
    async with opened() as terminal:
        terminal.press(ESCAPE + ESCAPE)
        await until(lambda: terminal.robots.stops)
        terminal.press(CTRL_D)


async def test_what_robots_say_stands_above_the_prompt_and_the_live_plan_below() -> None:
    async with opened() as terminal:
        terminal.robots.appear("Bo")
        terminal.press("go to")
        await terminal.shows("You → Ada: go to")
        terminal.robots.ask("Which box?", "red", "blue")
        terminal.robots.tell(topics.PLAN, plan(step("ask", "waiting"), step("go there")))
        await terminal.shows("go there  to do")
        rows = [row for row in terminal.screen.text.splitlines() if row]
        assert rows == [
            "You are talking to Parley. /help shows the commands, Ctrl-D leaves.",
            "Ada is here.",
            "Bo is here.",
            "Ada: ? Which box?",
            "    1. red",
            "    2. blue",
            "Ada's plan:",
            "  ? 1. ask (waiting for you)",
            "  ○ 2. go there",
            "You → Ada: go to",
            " Ada: waiting for your answer",
            " Bo: ready",
            " ? ask       waiting for you",
            " ○ go there  to do",
        ]
        terminal.press(CTRL_C + CTRL_C)


async def test_keys_typed_while_a_robot_talks_are_not_echoed_into_its_words() -> None:
    async with opened() as terminal:
        terminal.press("go to")
        await terminal.shows("You → Ada: go to")
        terminal.robots.say("The box is blue.")
        await terminal.shows("Ada: The box is blue.")
        echoing = [on for written, on in terminal.output.echoing.items() if "The box is blue." in written]
        assert echoing == [False]
        terminal.press(CTRL_C + CTRL_C)


async def test_long_words_of_a_robot_are_wrapped_between_words() -> None:
    async with opened() as terminal:
        terminal.robots.say("box " * 40)
        await terminal.shows("Ada: box")
        said = [row for row in terminal.screen.text.splitlines() if "box" in row]
        assert len(said) == 2
        assert all(row.endswith("box") for row in said)
        terminal.press(CTRL_D)
