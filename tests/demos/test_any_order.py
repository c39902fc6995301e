"""Operators who say anything at any moment: nothing hangs, a stop holds, and all can be set right.

Each operator is a seed: the same seed says the same things, only the moments differ from run to run.
"""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest

from parley.demos.catalogue import load_demo
from parley.messages import topics
from parley.messages.chat import ChatFeedback
from parley.messages.principal import person
from parley.messages.status import StopCommand
from tests.demos.house import FULL_SPEED, House, running

VARIANTS = ("", "no_bottle", "hidden_bottle", "blocked_door", "dead_camera")
PATIENCE_S = 20.0

ORDERS = (
    "go to the fridge", "go to the dining table and then to the bookshelf", "look at the TV",
    "go to the small sofa, then come back", "check the plant near the TV", "go to the sofa",
    "John is on the sofa", "There is a water bottle in the fridge", "John is thirsty, get him water.",
)  # fmt: skip
REMARKS = (
    "what are you doing?",
    "what can you do?",
    "where is John?",
    "purple umbrellas",
    "hm",
    "¿qué?",
    "?!",
)
ANSWERS = ("done", "the small one", "no", "yes", "purple umbrellas", "I have put it on you.", "2")
ONWARD = ("carry on", "try again", "skip it", "drop the second step", "cancel everything", "drop step 9")
STOPS = ("stop", "wait", "hold on please")
STOPPED = ("I have stopped", "I am standing still")


class Operator:
    """Says things at random moments and sees to it that each has its effect.

    Args:
        home: Where the robot is.
        seed: What is said.
    """

    def __init__(self, home: House, seed: int) -> None:
        self.home, self.random = home, random.Random(seed)
        self.latched = False

    async def work(self, moves: int) -> None:
        """Say this many things, then set everything right and see that an order works."""
        kinds: list[Callable[[], object]] = [
            self.order, self.order, self.order, self.order, self.remark, self.onward,
            self.answer, self.answer, self.stop, self.stop, self.emergency,
        ]  # fmt: skip
        for _ in range(moves):
            await self.random.choice(kinds)()  # type: ignore[misc]
            await self.home.system.clock.sleep(self.random.choice((0.0, 0.3, 2.0, 4.0, 8.0, 20.0)))
        await self.set_right()

    async def order(self) -> None:
        text = self.random.choice(ORDERS)
        if self.random.random() < 0.3:
            self.home.observer.say(text, "David")  # and goes on before it is understood
        else:
            await self.say(text)

    async def remark(self) -> None:
        await self.say(self.random.choice(REMARKS))

    async def onward(self) -> None:
        await self.say(self.random.choice(ONWARD))

    async def answer(self) -> None:
        question = self.home.observer.questions.newest("David")
        choices = (*ANSWERS, *(question.choices if question else ()))
        await self.say(self.random.choice(choices), answer=question is not None)

    async def stop(self) -> None:
        answer = self.home.observer.questions.newest("David") is not None and self.random.random() < 0.5
        said = self.home.observer.said
        before = len(said)
        self.home.observer.say(self.random.choice(STOPS), "David", answer=answer)
        await self.home.observer.until(
            lambda: any(feedback.message.startswith(STOPPED) for feedback in said[before:]),
            timeout_s=PATIENCE_S,
        )
        await self.stands_still()

    async def emergency(self) -> None:
        if self.latched:
            await self.say("what can you do?")  # answered after whatever was said before
            await self.release()
            await self.stands_still()
            return
        if self.random.random() < 0.5:
            await self.say("emergency stop")
        else:
            self.home.observer.publish(topics.STOP, StopCommand(targets=("David",)))
            await self.reported("at_rest")
        self.latched = True
        await self.stands_still()

    async def release(self) -> None:
        self.home.observer.publish(topics.STOP, StopCommand(command="reset", by=person("Kim")))
        await self.reported("reset")
        self.latched = False

    async def reported(self, state: str) -> None:
        reports = self.home.observer.stop_reports
        before = len(reports)
        await self.home.observer.until(
            lambda: any(report.state == state for report in reports[before:]), timeout_s=PATIENCE_S
        )

    async def say(self, text: str, *, answer: bool = False) -> None:
        """Say something and wait until the robot, or its plan, has reacted to it."""
        said, plan = self.home.observer.said, self.home.observer.plans.get("David")
        before = len(said)
        self.home.observer.say(text, "David", answer=answer)

        def reacted() -> bool:
            new = said[before:]
            replied = any(self.is_reply(feedback, answer=answer) for feedback in new)
            return replied or (answer and self.home.observer.plans.get("David") is not plan)

        await self.home.observer.until(reacted, timeout_s=PATIENCE_S)

    def is_reply(self, feedback: ChatFeedback, *, answer: bool) -> bool:
        return answer or feedback.type in ("response", "error")

    async def stands_still(self) -> None:
        """Having come to rest, it stays where it is, whatever is remarked meanwhile."""
        robot, clock = self.home.system.robots["David"], self.home.system.clock
        await clock.sleep(1.0)
        rests_at = robot.pose()
        if self.random.random() < 0.3:
            await self.remark()
        await clock.sleep(3.0)
        assert robot.pose().distance_to(rests_at) < 0.02
        assert abs(robot.velocity().linear_mps) < 0.02

    async def set_right(self) -> None:
        await self.release()
        await self.say("cancel everything")
        await self.home.observer.until(
            lambda: self.home.observer.state("David") == "idle", timeout_s=PATIENCE_S
        )
        await self.say("go to the TV")
        plans = self.home.observer.plans
        await self.home.observer.until(
            lambda: [step.state for step in plans["David"].steps] == ["finished"] * 2, timeout_s=PATIENCE_S
        )
        assert self.home.distance_m("tv_1") < 1.0


async def play(seed: int, moves: int) -> None:
    demo = load_demo("nursing-home")
    variant = VARIANTS[seed % len(VARIANTS)]
    system = demo.system(FULL_SPEED, demo.story.variant(variant) if variant else None)
    async with running(system) as home:
        await Operator(home, seed).work(moves)


@pytest.mark.parametrize("seed", range(10))
async def test_any_order_of_words_can_be_set_right(seed: int) -> None:
    await play(seed, moves=15)


@pytest.mark.soak
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("seed", range(1000, 1040))
async def test_any_long_order_of_words_can_be_set_right(seed: int) -> None:
    await play(seed, moves=60)
