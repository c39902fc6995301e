"""What operators said and pressed, on disk until it is read: sent again, or told of, also after a kill."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Coroutine, Sequence
from typing import Any, Final

import structlog

from parley.clock import Clock
from parley.errors import StoreError
from parley.gate.stop_words import has_stop_word
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.status import PlanDecision
from parley.sentences import Sentence, sentence
from parley.web.link import Link, Pressed, halts, robots_of
from parley.web.models import ChatEntry
from parley.web.pausing import Pauser
from parley.web.problems import WebProblem
from parley.web.state import WebState
from parley.web.stopping import Stopper
from parley.web.store import WebStore

__all__ = ["Outbox"]

log = structlog.get_logger(__name__)

RESEND_WITHIN_MS: Final = 30_000
"""A message that a killed server may not have sent is sent by the next one unless it is older than this;
and for so long is one said again that nobody has read."""
PRESSED_WITHIN_S: Final = 5.0
"""Wall time for which a button's press that nobody has taken is sent again: it acts soon, or not at all."""
HALTED_WITHIN_S: Final = 1.0
"""Wall time after which people are told that a button may not have halted what it is for."""
STOOD_WITHIN_S: Final = 1.0
"""Wall time from when a halt was taken within which an engine says that nothing goes on."""
_STANDS: Final = sentence(
    "Planning does not answer, so the robot was told itself, and stands still. It can be told to go on; "
    "all else has to wait."
)
_RESTS: Final = sentence("Planning does not answer. The robot stands still; all else has to wait.")
_GOES_ON: Final = sentence(
    "Planning does not answer, so the robot was told itself to go on with what it was doing; all else has to "
    "wait."
)
_NOT_HALTED: Final = sentence(
    "A button was pressed, but planning does not answer, so what goes on may not have been halted by it. "
    "Press Stop if it must not go on."
)
_NOT_TAKEN: Final = sentence(
    "A button was pressed, but planning does not answer, so nothing may have been done for it. Look how "
    "things stand, and press again if it still holds."
)
_NO_OUTCOME: Final = sentence("Nobody has said yet what came of that. Look how the plan is before you go on.")
_CUT_OFF: Final = sentence(
    "A button was pressed just before the page was interrupted, so nothing may have been done for it. Look "
    "how things stand, and press again if it still holds."
)
AGAIN_S: Final = 1.0
"""Wall time between two tries."""


class Outbox:
    """See the module.

    Args:
        link: Where it goes out.
        store: Where it is kept.
        state: Shows what is told.
        clock: Wall time.
        stopper: Holds robots for words of stopping.
        fresh_robots: Whether robots start anew with this process, and know nothing of an earlier one.
    """

    def __init__(
        self,
        link: Link,
        store: WebStore,
        state: WebState,
        clock: Clock,
        stopper: Stopper,
        *,
        fresh_robots: bool,
    ) -> None:
        self._link, self._store, self._state, self._clock = link, store, state, clock
        self._stopper, self._fresh = stopper, fresh_robots
        self._pauser = Pauser(link, state, stopper)
        self.waiting: dict[str, asyncio.Task[None]] = {}
        """What waits for messages to be read, by entry, and for presses."""

    async def say(self, entry: ChatEntry, messages: Sequence[ChatInput]) -> None:
        """Hand a message to robots. After a kill in between it goes again, under ids that they know."""
        for message in messages:
            await self._link.say(message)
        await self.said(entry, messages)

    async def said(self, entry: ChatEntry, messages: Sequence[ChatInput]) -> None:
        """Words went out; see that they are read."""
        if not self._link.says_what_it_read:
            await self._forget(self._store.mark_sent(entry.id))
        self.waiting[entry.id] = asyncio.create_task(self._until_read(entry, messages), name="web unread")

    async def _until_read(self, entry: ChatEntry, messages: Sequence[ChatInput]) -> None:
        """Whoever reads what people say may be cut off, or about to be started anew."""
        try:
            async with asyncio.timeout(RESEND_WITHIN_MS / 1000):
                await self._link.until_read([said.id for said in messages], again_s=AGAIN_S)
        except TimeoutError:
            if self._link.says_what_it_read:
                await self._give_up(entry, messages)
        await self._forget(self._store.mark_sent(entry.id))
        del self.waiting[entry.id]

    async def _give_up(self, entry: ChatEntry, messages: Sequence[ChatInput]) -> None:
        """Tell that words were not read. Where they hold robots, plans are paused before these may go on.

        Done once somebody plans, if it is tomorrow: else they would stand for good, and nobody could say why.
        """
        self._tell_unread(entry)
        if not messages or not has_stop_word(entry.message) or self._fresh:
            return
        pause = ChatAction(
            system_cmd=(SystemCommand(command="stop"),), targets=messages[0].targets, by=messages[0].who
        )
        await self._link.until_taken(pause, again_s=AGAIN_S)
        self._stopper.go_on(entry.id)

    async def _forget(self, work: Coroutine[Any, Any, None]) -> None:
        """Keep something no longer; a disk that fails holds up nothing but that."""
        try:
            await work
        except StoreError as error:
            log.error("not forgotten", problem=str(error))

    async def press_through(self, message: Pressed) -> None:
        """Do as `press`, and wait for what comes of it.

        Raises:
            WebProblem: It was refused, or nobody says in time what came of it.
        """
        pressed = await self.press(message)
        if pressed.press is None:
            return  # its planner does not say
        try:
            taken = await self._link.outcome(pressed.press.id, PRESSED_WITHIN_S)
        except TimeoutError:
            raise WebProblem(504, _NO_OUTCOME) from None
        if taken.outcome != "done":
            raise WebProblem(409 if taken.outcome == "past" else 422, taken.why, path="steps")

    async def press(self, message: Pressed) -> Pressed:
        """Keep what a button does and send it until whoever plans has taken it, or tell that it may not have.

        Raises:
            StoreError: It cannot be kept; then it is not sent either, unless it halts.
        """
        message = self._link.number(message)
        if first := halts(message):  # no disk is waited for
            self._send_press(message, PRESSED_WITHIN_S)
        if message.press is not None:
            try:
                await self._store.keep_press(message, self._clock.unix_ms())
            except StoreError as error:
                if not first:
                    raise
                log.error("press not stored", id=message.press.id, problem=str(error))
        if not first:
            self._send_press(message, PRESSED_WITHIN_S)
        return message

    def _send_press(self, message: Pressed, within_s: float) -> None:
        hold = self._pauser.pause(message)
        self._link.press(message)
        if hold:
            self.waiting[hold] = asyncio.create_task(self._until_halted(hold, message), name="web halt")
        elif message.press is not None:
            work = self._until_taken(message.press.id, message, within_s)
            self.waiting[message.press.id] = asyncio.create_task(work, name="web press")

    async def _until_halted(self, hold: str, message: Pressed) -> None:
        """Send a halt until it is taken or something newer came; what is planned till then moves nothing."""
        robots, press = robots_of(message), message.press
        taking = asyncio.create_task(
            self._link.until_read([press.id], again_s=AGAIN_S)
            if press is not None
            else self._pauser.until_stand(robots)  # nobody says that it was taken
        )
        try:
            told = False
            while not (await asyncio.wait({taking}, timeout=HALTED_WITHIN_S))[0]:
                self._pauser.hold(message, hold)
                if not told:
                    self._tell_untaken(message, self._how_it_stands(robots))
                told = True
            await taking
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(STOOD_WITHIN_S):
                    await self._pauser.until_stand(robots)
        finally:
            taking.cancel()
            self._pauser.release(message, hold)
        if press is not None:
            await self._forget(self._store.drop_press(message))
        del self.waiting[hold]

    def _how_it_stands(self, robots: tuple[str, ...]) -> Sentence:
        if not self._pauser.stand(robots):
            return _NOT_HALTED
        return _STANDS if self._pauser.paused(robots) else _RESTS  # what failed meanwhile cannot go on

    async def _until_taken(self, press: str, message: Pressed, within_s: float) -> None:
        told = False
        try:
            async with asyncio.timeout(within_s):
                taking = asyncio.create_task(self._link.until_read([press], again_s=AGAIN_S))
                try:
                    if not (await asyncio.wait({taking}, timeout=HALTED_WITHIN_S))[0]:
                        told = self._act_unplanned(message)
                    await taking
                finally:
                    taking.cancel()
        except TimeoutError:
            if not told:
                self._tell_untaken(message, _NOT_TAKEN)
        await self._forget(self._store.drop_press(message))
        del self.waiting[press]

    def _act_unplanned(self, message: Pressed) -> bool:
        """Do or say what cannot wait for planning; whether people were told."""
        assert message.press is not None
        if halts(message):
            self._tell_untaken(message, _NOT_HALTED)
            return True
        if self._link.overtaken(message.press.id) or not self._pauser.go_on(message):
            return False
        self._tell_untaken(message, _GOES_ON)
        return True

    def _tell_untaken(self, message: Pressed, text: str) -> None:
        told = ChatFeedback(message=text, targets=robots_of(message), type="error")
        self._state.chat.on_feedback(told, unix_ms=self._clock.unix_ms())
        if isinstance(message, PlanDecision):
            self._state.plans.on_unheard(message)

    async def close(self) -> None:
        """Wait no longer; what waits is on disk."""
        for task in tuple(self.waiting.values()):
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def settle(self) -> None:
        """What an earlier run left: sent now if it was said just now to robots that run on, else told of."""
        now_ms = self._clock.unix_ms()
        for entry, messages in await self._store.unsent():
            if not self._fresh and now_ms - entry.unix_ms <= RESEND_WITHIN_MS:
                await self.say(entry, messages)
                continue
            self.waiting[entry.id] = asyncio.create_task(self._settle(entry, messages), name="web unread")
        for pressed_ms, message in await self._store.presses():
            left_s = PRESSED_WITHIN_S - (now_ms - pressed_ms) / 1000
            if not self._fresh and 0 < left_s <= PRESSED_WITHIN_S:
                self._send_press(message, left_s)
                continue
            if message.press is not None:
                self._pauser.release(message, message.press.id)
            self._tell_untaken(message, _CUT_OFF)
            await self._store.drop_press(message)

    async def _settle(self, entry: ChatEntry, messages: Sequence[ChatInput]) -> None:
        await self._give_up(entry, messages)
        await self._forget(self._store.mark_sent(entry.id))
        del self.waiting[entry.id]

    def _tell_unread(self, entry: ChatEntry) -> None:
        said = f"“{entry.message}”" if entry.message else "your picture"
        halts = has_stop_word(entry.message) and not self._fresh
        rest = "I stand still until I hear you again." if halts else "Say it again if it still holds."
        text = f"I was interrupted and may not have got {said}. {rest}"
        told = ChatFeedback(message=text, targets=entry.targets, type="error", reply_to=entry.id)
        self._state.chat.on_feedback(told, unix_ms=self._clock.unix_ms())
