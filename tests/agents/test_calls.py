"""Who is called when a robot waits: with a real web server and a real mail server to receive it."""

from __future__ import annotations

import asyncio
import json
import socketserver
import threading
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import asynccontextmanager, contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from queue import Queue
from typing import Any

import pytest

from parley.agents.calls.calls import Calls
from parley.config import CallSettings, EmailSettings, SystemConfig
from parley.errors import ConfigError
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.status import PlanProposal, PlanUpdate
from parley.transport.local import LocalTransport
from tests.web.rig import HandClock, Robots

WAIT_S = 5.0


@contextmanager
def serving(server: socketserver.BaseServer) -> Iterator[None]:
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        yield
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


@contextmanager
def web_hook(got: Queue[dict[str, Any]], answers: Sequence[int] = ()) -> Iterator[str]:
    """A web server that is called; `answers` are its first statuses."""
    left = list(answers)

    class Hook(BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            got.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(left.pop(0) if left else 200)
            self.send_header("Content-Length", "0")
            self.end_headers()

        def log_message(self, format: str, *args: Any) -> None:
            """Nothing."""

    server = HTTPServer(("127.0.0.1", 0), Hook)
    with serving(server):
        yield f"http://127.0.0.1:{server.server_port}/hook"


@contextmanager
def mail_server(got: Queue[str]) -> Iterator[int]:
    """Speaks as much SMTP as one mail needs."""

    class Talk(socketserver.StreamRequestHandler):
        def handle(self) -> None:
            self.wfile.write(b"220 here\r\n")
            while line := self.rfile.readline():
                if line.lower().startswith(b"data"):
                    self.wfile.write(b"354 go on\r\n")
                    got.put(b"".join(iter(self.rfile.readline, b".\r\n")).decode())
                self.wfile.write(b"221 bye\r\n" if line.lower().startswith(b"quit") else b"250 ok\r\n")

    server = socketserver.TCPServer(("127.0.0.1", 0), Talk)
    with serving(server):
        yield server.server_address[1]


class Ward:
    def __init__(self, transport: LocalTransport, calls: Sequence[CallSettings]) -> None:
        self.clock, self.robots, self.told = HandClock(), Robots(transport), list[str]()
        self.heard = asyncio.Event()
        self.node = Calls(transport, self.clock, calls, tell=self._tell, again_s=0.0)

    def _tell(self, text: str) -> None:
        self.told.append(text)
        self.heard.set()

    async def after(self, seconds: float) -> None:
        for _ in range(20):
            await asyncio.sleep(0)
        self.node.look()
        self.clock.ahead_s += seconds
        self.node.look()


@asynccontextmanager
async def ward(*calls: CallSettings) -> AsyncIterator[Ward]:
    async with LocalTransport() as transport:
        here = Ward(transport, calls)
        async with here.node:
            yield here
        assert transport.handler_failures == 0


async def come(queue: Queue[Any]) -> Any:
    return await asyncio.to_thread(queue.get, timeout=WAIT_S)


async def test_who_waits_long_calls_somebody_and_then_somebody_else_until_it_is_answered() -> None:
    first, second = Queue[dict[str, Any]](), Queue[dict[str, Any]]()
    with web_hook(first) as near, web_hook(second) as far:
        calls = (CallSettings(after_s=60, webhook=near), CallSettings(after_s=300, webhook=far))
        async with ward(*calls) as here:
            here.robots.ask("Which box?", question_id="q1")
            await here.after(59)
            here.robots.ask("Shall I wait?", name="Bob", question_id="q2")
            await here.after(1)
            assert await come(first) == {
                "text": "Ada asks: Which box? Waiting for 1 min.",
                "robot": "Ada",
                "waited_s": 60,
                "link": "",
            }
            answer = ChatInput(message="red", type="response", reply_to="q1", targets=("Ada",))
            here.robots.tell(topics.CHAT_INPUT, answer)
            await here.after(300)
            assert [(await come(queue))["robot"] for queue in (first, second)] == ["Bob", "Bob"]
            assert first.empty() and second.empty()


@pytest.mark.parametrize("more", [{"choices": ("red", "blue")}, {"asks": True}])
async def test_who_asks_for_what_an_order_lacks_waits_too(more: dict[str, Any]) -> None:
    got = Queue[dict[str, Any]]()
    which = ChatFeedback(message="Which box?", targets=("Ada",), reply_to="m1", **more)
    with web_hook(got) as address:
        async with ward(CallSettings(after_s=60, webhook=address)) as here:
            here.robots.tell(topics.CHAT_FEEDBACK, which)
            await here.after(60)
            assert (await come(got))["text"] == "Ada asks: Which box? Waiting for 1 min."
            here.robots.tell(topics.CHAT_FEEDBACK, which.model_copy(update={"reply_to": "m2"}))
            here.robots.tell(topics.CHAT_INPUT, ChatInput(message="the red one", targets=("Ada",)))
            await here.after(60)
            here.robots.tell(topics.CHAT_FEEDBACK, which.model_copy(update={"reply_to": "m3"}))
            aside = ChatFeedback(message="A door.", targets=("Ada",), reply_to="m4", still_asks="m3")
            here.robots.tell(topics.CHAT_INPUT, ChatInput(message="what do you see?", targets=("Ada",)))
            await here.after(0)
            here.robots.tell(topics.CHAT_FEEDBACK, aside)
            await here.after(60)
            assert (await come(got))["text"] == "Ada asks: Which box? Waiting for 1 min."
            here.robots.tell(topics.CHAT_FEEDBACK, ChatFeedback(message="I will look.", targets=("Ada",)))
            await here.after(60)
            assert got.empty()


async def test_a_plan_that_waits_for_a_yes_is_mailed_once() -> None:
    mails: Queue[str] = Queue()
    with mail_server(mails) as port:
        email = EmailSettings(
            to=("kim@example.org",), sender="robots@example.org", host="127.0.0.1", port=port, tls="none"
        )
        link = "https://ward.example.org/"
        async with ward(CallSettings(after_s=0, email=email, link=link)) as here:
            tell = here.robots.tell
            tell(topics.PLAN, PlanProposal(id="p1", target="Ada", lines=("Go to the box", "Look at the box")))
            await here.after(0)
            mail = await come(mails)
            assert "Subject: Ada waits for a yes: Go to the box, Look at the box" in mail
            assert "To: kim@example.org" in mail
            assert mail.endswith(f"Ada waits for a yes: Go to the box, Look at the box\r\n\r\n{link}\r\n")
            tell(topics.PLAN, PlanProposal(id="p2", target="Ada", lines=("Go to the door",)))
            tell(topics.PLAN, PlanUpdate(target="Ada", state="running", waits=()))
            await here.after(9)
            assert mails.empty()


@pytest.mark.parametrize(("answers", "is_told"), [((500, 500), False), ((500, 500, 500), True)])
async def test_what_does_not_get_through_is_tried_again_and_then_said(
    answers: tuple[int, ...], is_told: bool
) -> None:
    got: Queue[dict[str, Any]] = Queue()
    with web_hook(got, answers) as hook:
        async with ward(CallSettings(after_s=0, webhook=hook)) as here:
            here.robots.ask("Which box?")
            await here.after(0)
            for _ in range(3):
                await come(got)
            if is_told:
                await asyncio.wait_for(here.heard.wait(), WAIT_S)
            said = "I wait, and cannot call anybody: the webhook answers with status 500."
            assert here.told == ([said] if is_told else [])


@pytest.mark.parametrize(
    "wrong",
    [
        "{after_s: 5}",
        "{webhook: 'ftp://example.org'}",
        "{webhook: 'https://example.org', webhook_file: a}",
        "{webhook: 'https://example.org', sms: 1}",
        "{email: {to: [kim], sender: a@b, host: c}}",
    ],
)
def test_settings_that_cannot_be_are_refused(wrong: str) -> None:
    with pytest.raises(ConfigError, match="calls"):
        SystemConfig.parse(f"calls:\n- {wrong}\n")


def test_an_address_that_is_a_secret_stands_in_a_file(tmp_path: Path) -> None:
    settings = CallSettings(webhook_file=tmp_path / "none")
    with pytest.raises(ConfigError, match="webhook_file"):
        Calls(LocalTransport(), HandClock(), (settings,), tell=print)
