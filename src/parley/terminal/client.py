"""The terminal client: wires the operator's view and console to the topics of the conversation."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
import uuid
from collections.abc import Callable, Mapping, Sequence

import structlog

from parley.clock import Clock, WallClock
from parley.errors import InvalidMessageError, TransportError
from parley.messages.chat import ChatInput
from parley.messages.memory import MemoryEntry
from parley.messages.principal import person
from parley.messages.status import PlanDecision, StopCommand
from parley.sentences import LANGUAGES, SpokenLanguage, in_language
from parley.terminal.commands import Command, compose, help_rows, parse, suggest
from parley.terminal.console import Console, ConsoleEvents, PlainConsole
from parley.terminal.lines import Fragments, Line
from parley.terminal.link import Link
from parley.terminal.view import MOODS, OperatorView, RobotView
from parley.transport.base import Transport

__all__ = ["TerminalClient", "console_for", "language_of"]

log = structlog.get_logger(__name__)

_TICK_S = 0.25
_SECOND_INTERRUPT_S = 2.0
_FIRST_ROBOT_TIMEOUT_S = 10.0
_REPLY_TIMEOUT_S = 30.0
_QUIET_S = 0.5
READ_WITHIN_S = 5.0
_EVERYBODY = "all"
_STOPPED = "Emergency stop for {robot}. To let it move again: /reset, then “carry on”."
_UNREAD = "Nobody has read that: who plans may be away. Say it again later. /stop works all the same."
_STOPPED_ALL = "Emergency stop for all robots. To let them move again: /reset all, then “carry on”."


def language_of(environ: Mapping[str, str]) -> SpokenLanguage:
    """The language of the environment, as far as it is known here, else English."""
    named = environ.get("LC_ALL") or environ.get("LC_MESSAGES") or environ.get("LANG") or ""
    code = named.split("_")[0].split(".")[0].lower()
    return code if code in LANGUAGES else "en"


def console_for(events: ConsoleEvents) -> Console:
    """The console that fits standard input and output: a prompt for people, plain lines for pipes."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        return PlainConsole(events)
    from parley.terminal.prompt import PromptConsole  # a large library, which only people at a terminal need

    return PromptConsole(events)


class TerminalClient:
    """An operator at a terminal, as one more client of the conversation.

    Args:
        transport: Opened by the caller; only what is opened here is closed here.
        lang: What the operator reads; None takes the language of the environment.
        console: Makes the console; the default looks at standard input and output.
        clock: For everything that waits; all of it is wall time.
    """

    def __init__(
        self,
        transport: Transport,
        *,
        lang: SpokenLanguage | None = None,
        console: Callable[[ConsoleEvents], Console] = console_for,
        clock: Clock | None = None,
    ) -> None:
        self._clock = clock if clock is not None else WallClock()
        self._view = OperatorView(lang or language_of(os.environ))
        self._link = Link(transport, self._view, self._show, self._clock)
        self._console = console(self)
        self._changed = asyncio.Event()
        self._unread: set[asyncio.Task[None]] = set()
        self._interrupted_s = float("-inf")
        self._broken_off = False
        self._commands: dict[str, Callable[[str], None]] = {
            "help": self._help,
            "plan": self._plan,
            "approve": self._approve,
            "stop": self._stop,
            "reset": self._reset,
            "robots": self._robots,
            "robot": self._robot,
        }

    async def run(self, greeting: Sequence[str] = (), engine: str = "") -> bool:
        """Talk until the operator leaves; whether that was by Ctrl-C.

        Args:
            greeting: Sentences the operator may want to try.
            engine: What understands them (`Language.label`); empty: not known here.
        """
        async with contextlib.AsyncExitStack() as stack:
            await stack.enter_async_context(self._console)
            self._greet(greeting, engine)
            await stack.enter_async_context(self._link)
            ticker = asyncio.create_task(self._tick(), name="terminal-tick")
            stack.push_async_callback(_cancel, ticker)
            stack.callback(lambda: [task.cancel() for task in self._unread])
            await self._converse()
            self._note("Goodbye.")
        return self._broken_off

    # What the console asks (see `ConsoleEvents`).

    def prompt(self) -> str:
        """What stands before the operator's words."""
        return f"{self._view.say('You')} → {self._view.selected}: " if self._view.selected else "> "

    def toolbar(self) -> list[Fragments]:
        """The rows of the live view."""
        return self._view.toolbar()

    def interrupt(self, *, is_empty: bool) -> bool:
        """Ctrl-C: an emergency stop, unless there is nothing to stop or it comes twice; True means to leave.

        Args:
            is_empty: Whether nothing was typed.
        """
        now_s = self._clock.wall_s()
        is_second = now_s - self._interrupted_s <= _SECOND_INTERRUPT_S
        self._interrupted_s = now_s
        robot = self._view.current
        self._broken_off = is_second or (is_empty and (robot is None or not robot.may_move))
        if self._broken_off:
            return True
        self.emergency_stop()
        self._note("Press Ctrl-C again to leave.")
        return False

    def emergency_stop(self) -> None:
        """Stop the robot that is spoken to, at once."""
        self._stop("")

    # The conversation.

    async def _converse(self) -> None:
        if self._console.paced:
            await self._wait(lambda: bool(self._view.selected), _FIRST_ROBOT_TIMEOUT_S)
        while (line := await self._console.read()) is not None:
            text = line.strip()
            command = parse(text)
            if command is not None:
                if command.name == "quit":
                    return
                await self._obey(command)
            elif text:
                await self._say(text)

    async def _say(self, text: str) -> None:
        robot = self._view.current
        if robot is None:
            self._note("No robot has answered yet, so nobody was told.")
            return
        replies = self._view.replies
        message = compose(robot, text, uuid.uuid4().hex)
        self._echo(message, text)
        self._link.send(message)
        self._remind(robot, message)
        if isinstance(message, ChatInput):
            looking = asyncio.create_task(self._look_after(message.id, replies), name="terminal-unread")
            self._unread.add(looking)
            looking.add_done_callback(self._unread.discard)
        self._console.refresh()
        if self._console.paced:
            await self._settle(robot, replies)

    def _echo(self, message: ChatInput | PlanDecision, text: str) -> None:
        """Say what became of the operator's words where that is not what they typed."""
        if isinstance(message, ChatInput) and message.message != text:
            self._console.show([Line("said", message.message, speaker=self._view.say("You"))])

    def _remind(self, robot: RobotView, message: ChatInput | PlanDecision) -> None:
        """After an answer, show what else the robot still waits for."""
        open_question = robot.question
        if isinstance(message, ChatInput) and message.type == "response" and open_question is not None:
            self._console.show(
                [
                    Line(
                        "asked",
                        in_language(open_question.text, self._view.language),
                        speaker=robot.name,
                        choices=self._view.choices(open_question.choices),
                    )
                ]
            )

    async def _look_after(self, identity: str, replies: int) -> None:
        """Say it if nobody reads what was said: a robot would seem to think."""

        def is_read() -> bool:
            return identity in self._link.read or self._view.replies > replies

        if not await self._wait(is_read, READ_WITHIN_S):
            self._note(_UNREAD)

    async def _settle(self, robot: RobotView, replies: int) -> None:
        """Wait until the robot has answered and either has nothing to do or needs the operator."""
        await self._wait(lambda: self._view.replies > replies, _REPLY_TIMEOUT_S)
        is_quiet = False
        while not is_quiet:
            await self._wait(lambda: not robot.is_busy, None)
            is_quiet = not await self._wait(lambda: robot.is_busy, _QUIET_S)

    async def _wait(self, condition: Callable[[], bool], timeout_s: float | None) -> bool:
        """Wait until a message makes `condition` true; False if none does within `timeout_s` of wall time."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(timeout_s):
                while not condition():
                    self._changed.clear()
                    await self._changed.wait()
        return condition()

    # Slash commands.

    async def _obey(self, command: Command) -> None:
        if command.name == "memory":
            await self._memory()
        elif command.name in self._commands:
            self._commands[command.name](command.argument)
        elif suggestion := suggest(command.name):
            self._note(
                "There is no command {command}. Did you mean {suggestion}?",
                command=f"/{command.name}",
                suggestion=f"/{suggestion}",
            )
        else:
            self._note(
                "There is no command {command}. /help shows what there is.", command=f"/{command.name}"
            )

    def _help(self, _: str) -> None:
        rows = [Line("step", row) for row in help_rows(self._view.language)]
        self._note("Write what you want in your own words. Numbers answer questions with numbered choices.")
        self._console.show(rows)
        self._note("Ctrl-C or Esc Esc is the emergency stop too; Ctrl-C twice leaves.")

    def _plan(self, _: str) -> None:
        robot = self._current()
        if robot is not None:
            self._console.show(self._view.plan_lines(robot))

    def _approve(self, argument: str) -> None:
        robot = self._current()
        if robot is None:
            return
        if argument == "on":
            self._note("{robot} will ask before it begins a new plan.", robot=robot.name)
            decision = PlanDecision(target=robot.name, decision="policy", policy="ask_first")
        elif argument == "off":
            self._note("{robot} will begin new plans at once.", robot=robot.name)
            decision = PlanDecision(target=robot.name, decision="policy", policy="run_at_once")
        else:
            self._note("/approve on: be asked before a plan begins; /approve off: plans begin at once.")
            return
        self._link.send(decision)

    def _stop(self, argument: str) -> None:
        self._command_stop("stop", argument)

    def _reset(self, argument: str) -> None:
        self._command_stop("reset", argument)

    def _command_stop(self, command: str, argument: str) -> None:
        """Send a stop or its reset; an emergency stop without a known robot goes to all of them."""
        robot = self._view.current
        is_for_all = argument.lower() == _EVERYBODY or (robot is None and command == "stop")
        if robot is None and not is_for_all:
            self._note("No robot has answered yet, so nobody was told.")
            return
        message = StopCommand(
            command="stop" if command == "stop" else "reset",
            targets=() if is_for_all or robot is None else (robot.name,),
            id=uuid.uuid4().hex,
            by=person(device="terminal"),
            words=f"/{command}",
            stops=self._view.known_stops() if command == "reset" else (),
        )
        self._link.send(message)
        if command == "reset":
            self._view.note_own_release(message.targets)
        if command == "stop":
            self._view.note_own_stop(message.id, message.targets)
            self._note(_STOPPED_ALL if is_for_all else _STOPPED, robot=self._view.selected)

    def _robots(self, _: str) -> None:
        rows = [
            Line("step", f"{'▶' if robot.name == self._view.selected else ' '} {robot.name}: {state}")
            for robot in self._view.here
            for state in [self._view.say(MOODS[robot.mood])]
        ]
        self._console.show(
            rows or [Line("note", self._view.say("No robot has answered yet, so nobody was told."))]
        )

    def _robot(self, name: str) -> None:
        if name and self._view.select(name) is not None:
            self._note("You are now talking to {robot}.", robot=self._view.selected)
            return
        here = ", ".join(robot.name for robot in self._view.here) or "–"
        self._note("There is no robot called {name}. Here now: {robots}.", name=name or "?", robots=here)

    async def _memory(self) -> None:
        try:
            entries = await self._link.memories()
        except (TransportError, InvalidMessageError) as error:
            log.warning("memory not available", error=str(error))
            self._note("The memory does not answer at the moment.")
            return
        if not entries:
            self._note("Nothing is remembered yet.")
            return
        rows = [Line("step", f"• {self._remembered(entry)}") for entry in entries]
        self._console.show([Line("heading", self._view.say("Remembered:")), *rows])

    def _remembered(self, entry: MemoryEntry) -> str:
        if entry.type == "image":
            return self._view.say("a picture: {info}", info=entry.info or entry.name)
        return entry.data

    def _current(self) -> RobotView | None:
        robot = self._view.current
        if robot is None:
            self._note("No robot has answered yet, so nobody was told.")
        return robot

    async def _tick(self) -> None:
        while True:
            due_s = self._clock.wall_s() + _TICK_S
            await asyncio.sleep(_TICK_S)
            now_s = self._clock.wall_s()
            if lines := self._view.tick(now_s, late_s=now_s - due_s):
                self._show(lines)

    # Showing.

    def _show(self, lines: Sequence[Line]) -> None:
        self._console.show(lines)
        self._changed.set()
        self._console.refresh()

    def _note(self, template: str, **values: object) -> None:
        self._console.show([Line("note", self._view.say(template, **values))])

    def _greet(self, examples: Sequence[str], engine: str) -> None:
        self._note("You are talking to Parley. /help shows the commands, Ctrl-D leaves.")
        if engine:
            self._note("What understands you: {name}.", name=engine)
        if examples:
            self._note("For example:")
            self._console.show([Line("step", f"“{example}”") for example in examples])


async def _cancel(task: asyncio.Task[None]) -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
