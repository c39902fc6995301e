"""Where lines come from and go to: the interface, how lines are coloured, and the plain line reader."""

from __future__ import annotations

import asyncio
import contextlib
import io
import signal
import sys
import threading
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, Self, TextIO

from rich.console import Console as RichConsole
from rich.text import Text

from parley.terminal.lines import Fragments, Line

__all__ = ["Console", "ConsoleEvents", "PlainConsole", "coloured", "on_sigint", "rendered"]

_STYLES = {"problem": "red", "note": "dim", "heading": "bold"}


class Console(Protocol):
    """The operator's end. Use as ``async with``."""

    @property
    def paced(self) -> bool:
        """Whether lines come prepared, so that each should wait for the answer to the one before."""
        ...

    async def __aenter__(self) -> Self: ...

    async def __aexit__(self, *exc: object) -> None: ...

    async def read(self) -> str | None:
        """The next line that the operator wrote; None when there will be no more."""
        ...

    def show(self, lines: Sequence[Line]) -> None:
        """Add lines to the conversation."""
        ...

    def refresh(self) -> None:
        """Draw the live view again, if there is one."""
        ...


class ConsoleEvents(Protocol):
    """What a console asks of its owner."""

    def prompt(self) -> str:
        """What stands before the operator's words."""
        ...

    def toolbar(self) -> list[Fragments]:
        """The rows of the live view."""
        ...

    def interrupt(self, *, is_empty: bool) -> bool:
        """Ctrl-C was pressed, with or without words at the prompt; True means to leave."""
        ...

    def emergency_stop(self) -> None:
        """The keys for an emergency stop were pressed."""
        ...


def coloured(line: Line) -> Text:
    """A line as rich draws it; nothing in it is read as markup or obeyed by the terminal."""
    line = Line(
        line.kind,
        _printable(line.text),
        speaker=_printable(line.speaker),
        choices=tuple(_printable(choice) for choice in line.choices),
        footnote=_printable(line.footnote),
    )
    text = Text()
    if line.speaker:
        text.append(f"{line.speaker}: ", style="bold red" if line.kind == "problem" else "bold cyan")
    if line.kind == "asked":
        text.append("? ", style="bold yellow")
    text.append(f"  {line.text}" if line.kind == "step" else line.text, style=_STYLES.get(line.kind, ""))
    for number, choice in enumerate(line.choices, 1):
        text.append(f"\n    {number}. ", style="bold yellow")
        text.append(choice)
    if line.footnote:
        text.append(f"\n    ({line.footnote})", style="dim")
    return text


def _printable(text: str) -> str:
    """Without the control characters that would move the cursor or worse: words come from other programs."""
    return "".join(char if char == "\n" or unicodedata.category(char) != "Cc" else " " for char in text)


def rendered(lines: Sequence[Line], columns: int) -> str:
    """Lines as text with the escape sequences of their colours, wrapped between words for a terminal."""
    sheet = io.StringIO()
    console = RichConsole(file=sheet, force_terminal=True, highlight=False, width=columns)
    for line in lines:
        console.print(coloured(line))
    return sheet.getvalue()


class PlainConsole:
    """Lines in, lines out: for pipes, and for terminals that can do no more."""

    def __init__(
        self, events: ConsoleEvents, *, source: TextIO | None = None, out: RichConsole | None = None
    ) -> None:
        self._events = events
        self._source = source if source is not None else _standard_input()
        self._out = out if out is not None else RichConsole(file=_standard_output(), highlight=False)
        self._lines: asyncio.Queue[str | None] = asyncio.Queue()
        self._stack = contextlib.ExitStack()

    @property
    def paced(self) -> bool:
        """See `Console.paced`."""
        return not self._source.isatty()

    async def __aenter__(self) -> Self:
        """Start to listen."""
        loop = asyncio.get_running_loop()
        self._stack.enter_context(on_sigint(loop, self._interrupted))
        # A thread that waits for input cannot be told to stop, so it must not keep the process alive: daemon.
        threading.Thread(target=self._listen, args=(loop,), name="terminal-input", daemon=True).start()
        return self

    async def __aexit__(self, *exc: object) -> None:
        """Stop to listen."""
        self._stack.close()

    async def read(self) -> str | None:
        """See `Console.read`."""
        line = await self._lines.get()
        if line is not None and self.paced:
            self._out.print(Text(f"{self._events.prompt()}{line}"), soft_wrap=True)
        return line

    def show(self, lines: Sequence[Line]) -> None:
        """See `Console.show`."""
        for line in lines:
            self._out.print(coloured(line), soft_wrap=True)  # who reads from a pipe wants lines whole

    def refresh(self) -> None:
        """See `Console.refresh`; there is no live view here."""

    def _interrupted(self) -> None:
        if self._events.interrupt(is_empty=True):
            self._lines.put_nowait(None)

    def _listen(self, loop: asyncio.AbstractEventLoop) -> None:
        # While we wait the loop may be closed (nobody listens any more), or the input (that is its end).
        with contextlib.suppress(RuntimeError):
            with contextlib.suppress(OSError, ValueError):
                for line in self._source:
                    loop.call_soon_threadsafe(self._lines.put_nowait, line.rstrip("\r\n"))
            loop.call_soon_threadsafe(self._lines.put_nowait, None)


def _standard_input() -> TextIO:
    """Standard input; what is no text in the expected encoding is replaced, not fatal."""
    if isinstance(sys.stdin, io.TextIOWrapper):
        sys.stdin.reconfigure(errors="replace")
    return sys.stdin


def _standard_output() -> TextIO:
    """Standard output; characters that its encoding lacks are replaced, not fatal."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    return sys.stdout


@contextlib.contextmanager
def on_sigint(loop: asyncio.AbstractEventLoop, handler: Callable[[], None]) -> Iterator[None]:
    """Ctrl-C calls `handler` meanwhile, where this is the main thread; elsewhere signals are not ours.

    Not by `add_signal_handler`: it gives Ctrl-C back to Python first, which raises it anywhere.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, lambda *_: loop.call_soon_threadsafe(handler))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
