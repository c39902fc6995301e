"""Plays a story on a real system and says whether it held, and if not, why."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Protocol, Self

from parley.clock import Clock
from parley.demos.observer import Emit, Observer
from parley.demos.story import Finished, Looked, Story, StoryStep, Variant
from parley.memory.client import recall
from parley.messages.chat import ChatFeedback
from parley.messages.memory import RETURN_ALL
from parley.transport.base import Transport
from parley.world.object_map import MapObject, ObjectMap

if TYPE_CHECKING:
    from parley.sim.simulator import Simulator

__all__ = ["Played", "StoryBroken", "StoryResult", "play"]

BEATS_S: Final = 3.0
"""Wall time within which a robot surely says where it is."""
STILL_S: Final = 15.0
"""Wall time after which a robot says nothing any more while none is at anything."""
PATIENCE_S: Final = 120.0
"""Wall time to wait for one thing to happen; a drive through a building takes seconds at full speed."""


class StoryBroken(Exception):  # noqa: N818 - an outcome, not an error of the program
    """The story went another way.

    Attributes:
        reason: One word: the code of the failure behind it, or `timed_out`, `not_asked`, `other_question`,
            `other_reply`, `other_plan`, `other_state`, `not_told`, `not_looked`,
            `not_remembered`, `elsewhere`, `not_shown`, `not_put`, `not_finished`.
        text: What was expected and what happened.
    """

    def __init__(self, reason: str, text: str) -> None:
        self.reason, self.text = reason, text
        super().__init__(f"{reason}: {text}")


@dataclass(frozen=True, slots=True)
class StoryResult:
    """How it ended."""

    held: bool
    """Whether everything happened as written."""
    as_expected: bool
    """Whether it ended as the variant says: held, or broken for its reason."""
    reason: str
    text: str
    wall_s: float
    robot_s: float
    """Robot time that passed, over all restarts."""
    latencies_s: tuple[float, ...] = field(default=())
    """Wall time from each message to the reply."""


class Played(Protocol):
    """What a story is played on: a system, in this process or not. Used as ``async with``."""

    async def __aenter__(self) -> Self: ...

    async def __aexit__(self, *exc: Any) -> None: ...

    @property
    def transport(self) -> Transport:
        """Where its topics are."""
        ...

    @property
    def clock(self) -> Clock:
        """Robot time, or what comes nearest to it."""
        ...

    @property
    def robot_names(self) -> tuple[str, ...]:
        """Who is in it."""
        ...

    @property
    def known(self) -> ObjectMap:
        """What people may name."""
        ...

    @property
    def simulator(self) -> Simulator | None:
        """Its world, if it can be changed from here."""
        ...


MakeSystem = Callable[[Variant], Played]


async def play(
    story: Story, make_system: MakeSystem, *, variant: str = "", emit: Emit = lambda _: None
) -> StoryResult:
    """Play `story`.

    Args:
        story: What is said and expected.
        make_system: Builds a system for the variant; called again for every restart in the story.
        variant: Name of the variant, empty for the story as written.
        emit: Gets every event.

    Raises:
        FileFormatError: There is no such variant.
    """
    different = story.variant(variant)
    player = _Player(story, different, make_system, emit)
    started_s = time.perf_counter()
    reason, text = "", "The story held."
    async with player:
        try:
            await player.play()
        except StoryBroken as broken:
            reason, text = broken.reason, broken.text
    result = StoryResult(
        held=not reason,
        as_expected=reason == different.fails,
        reason=reason,
        text=text,
        wall_s=time.perf_counter() - started_s,
        robot_s=player.robot_s,
        latencies_s=tuple(player.latencies_s),
    )
    emit(
        {
            "event": "story",
            "variant": variant,
            "held": result.held,
            "as_expected": result.as_expected,
            "reason": result.reason,
            "text": result.text,
            "wall_s": round(result.wall_s, 2),
            "robot_s": round(result.robot_s, 2),
        }
    )
    return result


class _Player:
    def __init__(self, story: Story, variant: Variant, make_system: MakeSystem, emit: Emit) -> None:
        self._story, self._variant, self._make_system, self._emit = story, variant, make_system, emit
        self._stack = AsyncExitStack()
        self._system: Played
        self._observer: Observer
        self._earlier_s = 0.0
        self._heard: dict[str, int] = {}
        self._looked = 0
        """So many pictures were taken when something was said last."""
        self._agreed: set[str] = set()
        """Ids of plans to which the operator said yes."""
        self._awaits_reply = False
        self._speaker = story.robot
        self.latencies_s: list[float] = []

    async def __aenter__(self) -> _Player:
        await self._open()
        return self

    async def __aexit__(self, *exc: object) -> None:
        await self._close()

    async def _open(self) -> None:
        system = self._make_system(self._variant)
        try:
            self._system = await self._stack.enter_async_context(system)
            self._observer = await self._stack.enter_async_context(
                Observer(system.transport, system.clock, self._emit)
            )
            all_there = {*self._system.robot_names}
            await self._observer.until(lambda: all_there <= self._observer.robots, timeout_s=PATIENCE_S)
        except BaseException:
            await self._stack.aclose()
            raise
        if (world := self._system.simulator) is not None:
            world.on_event = lambda event: self._emit({"event": "world", "text": event.name})
        self._heard.clear()
        self._looked = 0

    async def _close(self) -> None:
        self._earlier_s += self._system.clock.now_s()
        await self._stack.aclose()

    @property
    def robot_s(self) -> float:
        """Robot time that passed, valid after closing."""
        return self._earlier_s

    @property
    def _robot(self) -> str:
        """The robot that the present step is about."""
        return self._speaker

    async def play(self) -> None:
        for step in self._story.steps:
            self._speaker = step.robot or self._story.robot
            if step.id and step.id in self._variant.leave_out:
                continue
            if step.say is not None:
                await self._say(step, self._variant.words.get(step.id, step.say))
            elif step.asked is not None:
                await self._answer(step, step.asked)
            elif step.finished is not None:
                await self._finish(step.finished)
            elif not step.restart:
                await self._see(step)
            else:
                self._emit({"event": "restart"})
                await self._close()
                await self._open()
            if step.proposed:
                await self._expect_plan(step.proposed, self._proposed)

    # -- the kinds of steps ----------------------------------------------------------------------------

    async def _say(self, step: StoryStep, text: str) -> None:
        before_s = time.perf_counter()
        self._looked = len(self._observer.looks)
        self._heard[self._robot] = len(self._observer.said)  # nothing older answers it
        ours = self._observer.say(text, self._robot, also=step.also)
        self._awaits_reply = True
        reply = await self._next_said(
            lambda said: said.type in ("response", "error") and said.reply_to in ("", ours)
        )
        self._awaits_reply = False
        assert reply is not None
        self.latencies_s.append(time.perf_counter() - before_s)
        missing = [part for part in step.reply if not _is_in(part, reply.message)]
        if missing:
            raise StoryBroken("other_reply", f"“{text}” was answered “{reply.message}”; expected {missing}")
        if step.plan:
            await self._expect_plan(step.plan, self._planned)
        if step.remembered:
            await self._expect_memory(step.remembered)

    def _planned(self) -> tuple[str, ...]:
        plan = self._observer.plans.get(self._robot)
        return tuple(item.action.name for item in plan.steps) if plan is not None else ()

    def _proposed(self) -> tuple[str, ...]:
        proposal = self._observer.proposed.get(self._robot)
        return tuple(step.name for step in proposal.steps) if proposal is not None else ()

    async def _expect_plan(self, wanted: tuple[str, ...], planned: Callable[[], tuple[str, ...]]) -> None:
        def is_so() -> bool:
            return wanted in (planned(), self._proposed() if self._story.agrees else ())

        try:
            await self._observer.until(is_so, timeout_s=5.0)
        except TimeoutError as error:
            raise StoryBroken("other_plan", f"planned {list(planned())}, expected {list(wanted)}") from error

    async def _expect_memory(self, parts: tuple[str, ...]) -> None:
        entries = await recall(self._system.transport, RETURN_ALL)
        if not any(all(_is_in(part, entry.data) for part in parts) for entry in entries):
            raise StoryBroken("not_remembered", f"no memory contains {list(parts)}")

    async def _answer(self, step: StoryStep, expected: tuple[str, ...]) -> None:
        question = await self._question()
        if self._variant.answers is not None:
            await self._answer_stubbornly(self._variant.answers)
        if any(not _is_in(part, question.message) for part in expected):
            reason = self._last_failure() or "other_question"
            raise StoryBroken(reason, f"asked “{question.message}”; expected {list(expected)}")
        if not all(any(_is_in(choice, offered) for offered in question.choices) for choice in step.choices):
            raise StoryBroken("other_question", f"offered {list(question.choices)}, not {list(step.choices)}")
        if step.answer:
            words = self._variant.words.get(step.id, step.answer)
            self._observer.say(words, self._robot, answer=True)

    async def _question(self) -> ChatFeedback:
        """The robot's next open question; it is a break of the story if the plan ends without one."""
        observer = self._observer

        def over() -> bool:
            return observer.questions.newest(self._robot) is not None or self._idle()

        await self._wait(over, "a question")
        question = observer.questions.newest(self._robot)
        if question is None:
            raise StoryBroken(self._last_failure() or "not_asked", "the plan ended and nothing was asked")
        return question

    async def _answer_stubbornly(self, answer: str) -> None:
        """Give the same answer to everything until the robot asks no more."""
        for _ in range(20):
            question = self._observer.questions.newest(self._robot)
            if question is None:
                break
            self._observer.say(answer, self._robot, answer=True)
            heard = len(self._observer.said)
            await self._wait(lambda heard=heard: len(self._observer.said) > heard, "a reaction")  # type: ignore[misc]
        raise StoryBroken(self._last_failure() or "other_question", f"the operator only ever says “{answer}”")

    async def _finish(self, expected: Finished) -> None:
        observer = self._observer
        await self._wait(
            lambda: self._idle() or observer.questions.newest(self._robot) is not None, "the end"
        )
        question = observer.questions.newest(self._robot)
        if question is not None:
            raise StoryBroken(self._last_failure() or "other_question", f"asked “{question.message}”")
        states = [step.state for step in observer.plans[self._robot].steps]
        if any(state != "finished" for state in states):
            raise StoryBroken(self._last_failure() or "not_finished", f"the steps ended as {states}")
        for feed in expected.shown:
            if (self._robot, feed) not in observer.feeds:
                raise StoryBroken("not_shown", f"nothing was shown on {feed}")
        if expected.near:
            await self._expect_near(expected)
        for name, on in expected.put.items():
            self._expect_put(name, on)

    async def _expect_near(self, expected: Finished) -> None:
        thing = self._system.known.get(expected.near)
        if thing is None:
            raise StoryBroken("elsewhere", f"there is no object {expected.near}")
        try:
            await self._observer.until(lambda: self._gap_m(thing) <= expected.within_m, timeout_s=BEATS_S)
        except TimeoutError:
            text = f"the robot is {self._gap_m(thing):.2f} m away from {expected.near}"
            raise StoryBroken("elsewhere", text) from None

    def _gap_m(self, thing: MapObject) -> float:
        """From the robot's middle, where it said last that it is, to the object's bounding box."""
        pose = self._observer.poses.get(self._robot)
        return math.inf if pose is None else thing.gap_m(pose.x, pose.y)

    def _expect_put(self, name: str, on: str) -> None:
        assert self._system.simulator is not None, "who looks at the world plays where it is"
        world, under = self._system.simulator.world, self._system.known.get(on)
        lying = [world.base_of(thing) for thing in world.standing() if thing.name == name]
        if under is None or not lying or under.gap_m(lying[0].x_m, lying[0].y_m) > 0:
            raise StoryBroken("not_put", f"{name} does not lie on {on}")

    async def _see(self, step: StoryStep) -> None:
        if step.change is not None:
            assert self._system.simulator is not None, "who changes the world plays where it is"
            self._system.simulator.change(step.change)
            self._emit({"event": "change", "text": step.note})
        elif step.told is not None:
            await self._hear(step.told)
        elif step.looked is not None:
            await self._expect_looks(step.looked)
        elif step.state:
            await self._expect_state(step.state)
        else:
            await self._wait(lambda: self._newest_ending() == step.incident, f"a failure {step.incident}")

    async def _hear(self, parts: tuple[str, ...]) -> None:
        """Something that is told; it breaks the story if the plan ends, or is asked about, without it."""
        runs = not self._idle()
        still_since_s: float | None = None

        def over() -> bool:
            nonlocal still_since_s
            if runs and (self._idle() or self._observer.questions.newest(self._robot) is not None):
                return True
            now_s = time.monotonic()
            if any(self._observer.state(name) == "running" for name in self._system.robot_names):
                still_since_s = None
            elif still_since_s is None:
                still_since_s = now_s
            return still_since_s is not None and now_s - still_since_s > STILL_S

        found = await self._next_said(lambda said: all(_is_in(part, said.message) for part in parts), over)
        if found is None:
            raise StoryBroken(self._last_failure() or "not_told", f"nothing was told of {list(parts)}")

    async def _expect_state(self, wanted: str) -> None:
        """It breaks the story if the plan has ended where it was to be stopped on the way."""

        def is_so() -> bool:
            return self._observer.state(self._robot) == wanted

        on_the_way = wanted in ("held", "paused")
        await self._wait(lambda: is_so() or (on_the_way and self._idle()), f"the state {wanted}")
        if not is_so():
            raise StoryBroken(
                self._last_failure() or "other_state", f"the plan has ended and is not {wanted}"
            )

    async def _expect_looks(self, expected: Looked) -> None:
        """It breaks the story if all plans end, or something is asked, before a robot looked everywhere."""

        def left() -> list[str]:
            return [name for name in expected.at if not self._was_looked_at(name, expected.within_m)]

        def over() -> bool:
            robots = self._system.robot_names
            asks = any(self._observer.questions.newest(robot) is not None for robot in robots)
            return asks or all(self._observer.state(robot) == "idle" for robot in robots)

        await self._wait(lambda: not left() or over(), f"a look at {list(expected.at)}")
        try:  # a picture may be heard of after what was said of it
            await self._observer.until(lambda: not left(), timeout_s=BEATS_S)
        except TimeoutError:
            raise StoryBroken(self._last_failure() or "not_looked", f"nobody looked at {left()}") from None

    def _was_looked_at(self, name: str, within_m: float) -> bool:
        thing = self._system.known.get(name)
        looks = self._observer.looks[self._looked :]
        return thing is not None and any(thing.gap_m(x_m, y_m) <= within_m for _, _, x_m, y_m in looks)

    def _newest_ending(self) -> str:
        mine = [incident for incident in self._observer.incidents.values() if incident.robot == self._robot]
        return mine[-1].ending if mine else ""

    # -- helpers ---------------------------------------------------------------------------------------

    def _idle(self) -> bool:
        plan = self._observer.plans.get(self._robot)
        return plan is not None and plan.state == "idle"

    def _last_failure(self) -> str:
        return self._observer.failures[-1].code.value if self._observer.failures else ""

    async def _next_said(
        self, wanted: Callable[[ChatFeedback], bool], over: Callable[[], bool] = lambda: False
    ) -> ChatFeedback | None:
        """The next thing of this kind that the robot says, after what was heard of it before.

        None if it is `over` and was not said.
        """
        found: list[ChatFeedback] = []

        def look() -> bool:
            said = self._observer.said
            heard = self._heard.get(self._robot, 0)
            while heard < len(said) and not found:
                if self._robot in said[heard].targets and wanted(said[heard]):
                    found.append(said[heard])
                heard += 1
            self._heard[self._robot] = heard
            return bool(found)

        await self._wait(lambda: look() or over(), "something that the robot says")
        return found[0] if found else None

    async def _wait(self, condition: Callable[[], bool], what: str) -> None:
        def is_over() -> bool:
            self._agree()
            return condition()

        ends_s = time.monotonic() + PATIENCE_S
        while True:
            try:
                return await self._observer.until(is_over, timeout_s=BEATS_S)  # some look at the time
            except TimeoutError as error:
                if time.monotonic() > ends_s:
                    text = f"waited in vain for {what}"
                    raise StoryBroken(self._last_failure() or "timed_out", text) from error

    def _agree(self) -> None:
        """Say yes to what waits for it, once for all that one order makes of it."""
        observer = self._observer
        waiting = {name for name, plan in observer.plans.items() if plan.state == "awaiting_approval"}
        new = {
            proposal.id
            for name, proposal in observer.proposed.items()
            if name in waiting and proposal.id not in self._agreed
        }
        if self._story.agrees and self._robot in waiting and new and not self._awaits_reply:
            self._agreed |= new
            observer.say(self._story.agrees, self._robot)


def _is_in(part: str, text: str) -> bool:
    """Whether one of the wordings of `part` stands in what was said."""
    return any(words.strip().lower() in text.lower() for words in part.split("|"))
