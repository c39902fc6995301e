"""The console for people at a real terminal: history, line editing, and the plan as a live view below."""

from __future__ import annotations

import asyncio
import contextlib
import contextvars
from collections.abc import Sequence
from typing import Self

from prompt_toolkit import PromptSession
from prompt_toolkit.application import create_app_session, run_in_terminal
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.input import Input
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.output import Output
from prompt_toolkit.patch_stdout import patch_stdout
from prompt_toolkit.styles import Style

from parley.terminal.console import ConsoleEvents, rendered
from parley.terminal.lines import Line

__all__ = ["PromptConsole"]

_REFRESH_S = 0.5

_STYLE = Style.from_dict(
    {
        "bottom-toolbar": "noreverse",
        "prompt": "bold",
        "robot": "bold ansicyan",
        "now": "ansiyellow",
        "done": "ansigreen",
        "bad": "ansired",
        "ask": "ansiyellow bold",
        "dim": "ansibrightblack",
    }
)


class PromptConsole:
    """A prompt that stays at the bottom while robots talk above it."""

    paced = False

    def __init__(
        self, events: ConsoleEvents, *, keyboard: Input | None = None, screen: Output | None = None
    ) -> None:
        self._events = events
        self._keyboard, self._screen = keyboard, screen
        self._stack = contextlib.ExitStack()
        self._session: PromptSession[str] | None = None
        self._context = contextvars.copy_context()
        self._writing: set[asyncio.Future[None]] = set()

    async def __aenter__(self) -> Self:
        """Take over the terminal."""
        if self._keyboard is not None or self._screen is not None:
            self._stack.enter_context(create_app_session(self._keyboard, self._screen))
        self._stack.enter_context(patch_stdout(raw=True))  # for whatever else may print meanwhile
        # prompt_toolkit finds its application through a context variable; lines come from many tasks.
        self._context = contextvars.copy_context()
        self._session = PromptSession(
            message=lambda: [("class:prompt", self._events.prompt())],
            bottom_toolbar=self._toolbar,
            key_bindings=self._keys(),
            style=_STYLE,
            refresh_interval=_REFRESH_S,
        )
        # Lines are written above the prompt with the terminal as it is: given back to its line editing, as
        # prompt_toolkit does for programs that read for themselves, it would echo what is typed meanwhile.
        self._session.app.input.cooked_mode = contextlib.nullcontext  # type: ignore[method-assign]
        return self

    async def __aexit__(self, *exc: object) -> None:
        """Give the terminal back, after the last line was written."""
        await asyncio.gather(*self._writing, return_exceptions=True)
        self._stack.close()

    async def read(self) -> str | None:
        """See `parley.terminal.console.Console.read`."""
        assert self._session is not None, "use `async with`"
        try:
            return await self._session.prompt_async()
        except (EOFError, OSError):  # the terminal itself may be gone: its window closed, its connection lost
            return None

    def show(self, lines: Sequence[Line]) -> None:
        """See `parley.terminal.console.Console.show`."""
        future = self._context.run(lambda: asyncio.ensure_future(run_in_terminal(lambda: self._write(lines))))
        self._writing.add(future)
        future.add_done_callback(self._writing.discard)

    def refresh(self) -> None:
        """See `parley.terminal.console.Console.refresh`."""
        if self._session is not None:
            self._session.app.invalidate()

    def _write(self, lines: Sequence[Line]) -> None:
        assert self._session is not None
        screen = self._session.output
        with contextlib.suppress(OSError):  # the terminal is gone, and nobody is there to be told
            screen.write_raw(rendered(lines, screen.get_size().columns))
            screen.flush()

    def _toolbar(self) -> StyleAndTextTuples:
        fragments: StyleAndTextTuples = []
        for index, row in enumerate(self._events.toolbar()):
            if index:
                fragments.append(("", "\n"))
            fragments.extend(row)
        return fragments

    def _keys(self) -> KeyBindings:
        keys = KeyBindings()

        @keys.add("c-c")
        @keys.add("<sigint>")
        def _(event: KeyPressEvent) -> None:
            if self._events.interrupt(is_empty=not event.app.current_buffer.text):
                event.app.exit(exception=EOFError)
            else:
                event.app.current_buffer.reset()

        @keys.add("escape", "escape")
        def _(event: KeyPressEvent) -> None:
            self._events.emergency_stop()

        return keys
