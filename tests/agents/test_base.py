"""What every node shares: refusing what does not fit, ordered mailboxes, leaving nothing behind."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from typing import ClassVar

import pytest

from parley.agents.base import Mailboxes, Node
from parley.errors import TypeMismatchError
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.ros import String
from parley.messages.status import Rejection
from parley.messages.topics import Topic
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport


class Echo(Node):
    name: ClassVar[str] = "echo"

    async def open(self) -> None:
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)

    async def _on_input(self, said: ChatInput) -> None:
        self.publish(topics.CHAT_FEEDBACK, ChatFeedback(message=said.message))


async def settle() -> None:
    for _ in range(20):
        await asyncio.sleep(0)


async def listen(transport: LocalTransport, topic: Topic[String]) -> list[str]:
    heard: list[str] = []
    await transport.subscribe(topic, lambda message: heard.append(message.data))
    return heard


async def test_a_payload_reaches_its_handler_typed_and_the_answer_goes_out() -> None:
    async with LocalTransport() as transport, Echo(transport):
        heard = await listen(transport, topics.CHAT_FEEDBACK)
        transport.publisher(topics.CHAT_INPUT).publish(to_string(ChatInput(message="hello")))
        await settle()
    assert [decode(ChatFeedback, text).message for text in heard] == ["hello"]


@pytest.mark.parametrize(
    ("text", "path"),
    [("not json", ""), ("[]", ""), ("{}", "message"), ('{"message": 3}', "message"), ("", "")],
)
async def test_a_message_that_does_not_fit_is_refused_by_name_and_path_and_the_next_is_served(
    text: str, path: str
) -> None:
    async with LocalTransport() as transport, Echo(transport):
        refused = await listen(transport, topics.REJECTION)
        answered = await listen(transport, topics.CHAT_FEEDBACK)
        sender = transport.publisher(topics.CHAT_INPUT)
        sender.publish(String(text))
        sender.publish(to_string(ChatInput(message="still there?")))
        await settle()
        assert transport.handler_failures == 0
    (rejection,) = [decode(Rejection, item) for item in refused]
    assert (rejection.source, rejection.what) == ("echo", "chat_interface_input")
    assert [problem.path for problem in rejection.problems] == [path]
    assert rejection.problems[0].message
    assert len(answered) == 1


async def test_a_refused_rejection_does_not_cause_an_endless_exchange() -> None:
    class Curious(Node):
        name: ClassVar[str] = "curious"

        async def open(self) -> None:
            await self.subscribe(topics.REJECTION, Rejection, lambda _: None)

    async with LocalTransport() as transport, Curious(transport):
        refused = await listen(transport, topics.REJECTION)
        transport.publisher(topics.REJECTION).publish(String("nonsense"))
        await settle()
    assert len(refused) == 2


async def test_closing_takes_away_everything_a_node_opened() -> None:
    async with LocalTransport() as transport:
        before = asyncio.all_tasks()
        async with Echo(transport) as node:
            node.publish(topics.CHAT_FEEDBACK, ChatFeedback(message="x"))
            node.spawn(asyncio.sleep(3600), name="endless")
            assert transport.endpoints()
        assert transport.endpoints() == ()
        assert asyncio.all_tasks() == before


async def test_what_is_sent_after_closing_opens_nothing_anew() -> None:
    async with LocalTransport() as transport:
        async with Echo(transport) as node:
            pass
        node.publish(topics.CHAT_FEEDBACK, ChatFeedback(message="x"))
        assert transport.endpoints() == ()


async def test_a_closed_node_can_be_opened_again() -> None:
    async with LocalTransport() as transport:
        node = Echo(transport)
        heard = await listen(transport, topics.CHAT_FEEDBACK)
        for _ in range(2):
            async with node:
                transport.publisher(topics.CHAT_INPUT).publish(to_string(ChatInput(message="x")))
                await settle()
    assert len(heard) == 2


async def test_a_node_that_fails_to_open_leaves_nothing_behind() -> None:
    class Broken(Node):
        async def open(self) -> None:
            await self.subscribe(topics.CHAT_INPUT, ChatInput, lambda _: None)
            wrong = Topic(topics.CHAT_INPUT.name, String, "std_msgs/msg/Other")
            await self.subscribe(wrong, ChatInput, lambda _: None)

    async with LocalTransport() as transport:
        with pytest.raises(TypeMismatchError):
            await Broken(transport).__aenter__()
        assert transport.endpoints() == ()


async def test_background_work_that_fails_is_gone_and_disturbs_nothing() -> None:
    async def fail() -> None:
        raise ValueError("broken")

    async with LocalTransport() as transport, Echo(transport) as node:
        task = node.spawn(fail(), name="fails")
        await settle()
        assert task.done()
        heard = await listen(transport, topics.CHAT_FEEDBACK)
        transport.publisher(topics.CHAT_INPUT).publish(to_string(ChatInput(message="hello")))
        await settle()
    assert len(heard) == 1


async def test_a_mailbox_does_one_thing_after_the_other() -> None:
    done: list[str] = []

    async def work(label: str) -> None:
        done.append(f"{label} starts")
        await asyncio.sleep(0)
        done.append(f"{label} ends")

    async with Mailboxes[str]() as mailboxes:
        for label in "abc":
            mailboxes.post("A", partial(work, label))
        await settle()
    assert done == [f"{label} {what}" for label in "abc" for what in ("starts", "ends")]


async def test_a_hung_key_delays_no_other() -> None:
    done = asyncio.Event()

    async def hang() -> None:
        await asyncio.Event().wait()

    async def work() -> None:
        done.set()

    async with Mailboxes[str]() as mailboxes:
        mailboxes.post("A", hang)
        mailboxes.post("A", work)
        await settle()
        assert not done.is_set()
        mailboxes.post("B", work)
        await settle()
        assert done.is_set()
        assert mailboxes.busy == {"A"}


async def test_a_failing_item_is_reported_and_the_mailbox_goes_on() -> None:
    failures: list[tuple[str, str]] = []
    done: list[str] = []

    async def fail() -> None:
        raise ValueError("broken")

    async def wait_for_something_cancelled() -> None:
        lost = asyncio.get_running_loop().create_future()
        lost.cancel()
        await lost

    async def work() -> None:
        done.append("worked")

    async with Mailboxes[str](lambda key, error: failures.append((key, str(error)))) as mailboxes:
        for item in (fail, wait_for_something_cancelled, work):
            mailboxes.post("A", item)
        await settle()
        assert mailboxes.busy == frozenset()
    assert failures == [("A", "broken")]
    assert done == ["worked"]


async def test_closing_cancels_what_runs_and_forgets_what_waits() -> None:
    before = asyncio.all_tasks()
    seen: list[str] = []

    async def hang() -> None:
        try:
            await asyncio.Event().wait()
        finally:
            seen.append("cancelled")

    async def never() -> None:
        seen.append("ran")

    mailboxes = Mailboxes[str]()
    mailboxes.post("A", hang)
    mailboxes.post("A", never)
    await settle()
    await mailboxes.close()
    await mailboxes.close()
    mailboxes.post("A", never)
    await settle()
    assert seen == ["cancelled"]
    assert asyncio.all_tasks() == before


async def test_closed_mailboxes_can_be_opened_again() -> None:
    done: list[str] = []

    async def work() -> None:
        done.append("worked")

    mailboxes = Mailboxes[str]()
    for _ in range(2):
        async with mailboxes:
            mailboxes.post("A", work)
            await settle()
    assert done == ["worked", "worked"]


async def test_an_item_may_close_its_own_mailboxes() -> None:
    before = asyncio.all_tasks()
    seen: list[str] = []
    mailboxes = Mailboxes[str]()

    async def close() -> None:
        await mailboxes.close()
        seen.append("closed")

    async def never() -> None:
        seen.append("ran")

    mailboxes.post("A", close)
    mailboxes.post("A", never)
    await settle()
    assert seen == ["closed"]
    assert asyncio.all_tasks() == before


async def test_whoever_is_in_charge_of_a_topic_says_when_messages_were_lost_but_not_for_each() -> None:
    class Slow(Echo):
        async def open(self) -> None:
            await self.subscribe(topics.CHAT_INPUT, ChatInput, lambda _: None, depth=10, in_charge=True)

    async with LocalTransport() as transport, Slow(transport):
        said = await listen(transport, topics.CHAT_FEEDBACK)
        sender = transport.publisher(topics.CHAT_INPUT)
        for _ in range(30):
            sender.publish(to_string(ChatInput(message="hello")))
        await settle()
        sender.publish(to_string(ChatInput(message="hello")))
        await settle()
    (told,) = [decode(ChatFeedback, text) for text in said]
    assert told.type == "error" and ": 20." in told.message


async def test_much_work_for_one_lets_others_in() -> None:
    done: list[int] = []

    def busy() -> None:
        time.sleep(0.002)

    async def work(number: int) -> None:
        busy()
        done.append(number)

    async with Mailboxes[str]() as mailboxes:
        for number in range(100):
            mailboxes.post("A", partial(work, number))
        turns = 0
        while len(done) < 100:
            await asyncio.sleep(0)
            turns += 1
    assert turns > 10 and done == [*range(100)]
