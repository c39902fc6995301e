"""The conversation over REST and the live stream."""

from __future__ import annotations

import asyncio
import base64
from typing import Any

import pytest

from parley.messages import topics
from parley.messages.chat import ChatInput, ChatRead, ReplyDraft
from parley.messages.principal import person
from parley.web import outbox
from parley.web.bodies import ChatPost
from tests.transport.backends import until
from tests.web.rig import JPEG, Page, served


def message(key: str, text: str, *targets: str, **more: Any) -> dict[str, Any]:
    return {"id": key, "text": text, "targets": list(targets), **more}


async def until_it_heard(page: Page, entries: int) -> None:
    await page.until(lambda: len(page.of("chat")) == entries)


async def test_a_message_reaches_the_robot_and_every_page_once() -> None:
    async with served("Ada") as rig:
        one, two = await rig.page(), await rig.page()
        answers = [await rig.http.post("/api/chat", json=message("m1", "go home", "Ada")) for _ in range(3)]
        assert [answer.status_code for answer in answers] == [200, 200, 200]
        assert answers[0].json() == answers[2].json()
        rig.robots.say("I am going.", reply_to="m1")
        for page in (one, two):
            await until_it_heard(page, 2)
            assert [change["entry"]["message"] for change in page.of("chat")] == ["go home", "I am going."]
        assert [said.message for said in rig.robots.inputs] == ["go home"]
        assert rig.robots.inputs[0].id == "m1"


async def test_an_answer_is_split_from_an_order_where_only_some_robots_asked() -> None:
    async with served("Ada", "Bob") as rig:
        page = await rig.page()
        rig.robots.ask("Which box?", "red", "blue", name="Ada")
        await page.until(lambda: page.of("chat"))
        assert page.of("chat")[0]["entry"]["question"] == "open"
        await rig.http.post("/api/chat", json=message("m1", "the red one", "Ada", "Bob"))
        await page.until(lambda: len(page.of("chat")) == 3)
        await rig.heard()
        assert {(s.type, s.targets, s.reply_to) for s in rig.robots.inputs} == {
            ("request", ("Bob",), ""),
            ("response", ("Ada",), "q1"),
        }
        chat = (await rig.http.get("/api/chat")).json()["entries"]
        assert [(entry["message"], entry["question"]) for entry in chat] == [
            ("Which box?", "answered"),
            ("the red one", ""),
        ]
        assert chat[0]["answer_id"] == "m1"


@pytest.mark.parametrize("asks", [True, False])
async def test_of_two_answers_at_once_one_counts_and_so_it_is_with_what_is_offered(asks: bool) -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        if asks:
            rig.robots.ask("Which box?", name="Ada")
        else:
            rig.robots.say("Which box do you mean?", choices=("red", "blue"))
        await page.until(lambda: page.of("chat"))
        key = page.of("chat")[0]["entry"]["id"]
        answers = [message("m1", "red", "Ada", reply_to=key), message("m2", "blue", "Ada", reply_to=key)]
        both = await asyncio.gather(*(rig.http.post("/api/chat", json=answer) for answer in answers))
        late = await rig.http.post("/api/chat", json=message("m3", "green", "Ada", reply_to=key))
        assert sorted(answer.status_code for answer in both) == [200, 409]
        assert (late.status_code, late.json()["path"]) == (409, "reply_to")
        again = [answer for answer, got in zip(answers, both, strict=True) if got.status_code == 200]
        assert (await rig.http.post("/api/chat", json=again[0])).status_code == 200, "the same, sent twice"
        await rig.heard()
        assert [heard.message for heard in rig.robots.inputs] == [again[0]["text"]]


async def test_what_is_said_while_an_answer_is_kept_is_no_second_answer() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.ask("Which box?", name="Ada")
        await page.until(lambda: page.of("chat"))
        key = page.of("chat")[0]["entry"]["id"]
        said = [message("m1", "red", "Ada", reply_to=key), message("m2", "then go home", "Ada")]
        say = rig.server.backend.say  # at once: the second is composed while the first is written to the disk
        await asyncio.gather(*(say(ChatPost.model_validate(one), person("Kim")) for one in said))
        await rig.heard()
        assert {(heard.message, heard.type) for heard in rig.robots.inputs} == {
            ("red", "response"),
            ("then go home", "request"),
        }


@pytest.mark.parametrize("more", [{"asks": True}, {"choices": ("red", "blue")}])
async def test_a_reply_that_asks_back_is_open_until_the_robot_is_told_more_and_what_is_told_is_an_order(
    more: dict[str, Any],
) -> None:
    async with served("Ada", "Bob") as rig:
        page = await rig.page()
        await rig.http.post("/api/chat", json=message("m1", "bring it", "Ada"))
        await rig.http.post("/api/chat", json=message("m2", "where are you?", "Ada"))
        rig.robots.say("Where shall I bring it?", reply_to="m1", **more)
        rig.robots.say("In the hall.", reply_to="m2")  # it was asked before that was said
        await until_it_heard(page, 4)
        asked = page.of("chat")[2]["entry"]
        assert asked["question"] == "open"
        await rig.http.post("/api/chat", json=message("m3", "go home", "Bob"))
        await rig.http.post("/api/chat", json=message("m4", "to the red box", "Ada", reply_to=asked["id"]))
        await rig.heard()
        assert [(s.message, s.type, s.reply_to) for s in rig.robots.inputs[2:]] == [
            ("go home", "request", ""),
            ("to the red box", "request", ""),
        ]
        (entry,) = [
            one for one in (await rig.http.get("/api/chat")).json()["entries"] if one["id"] == asked["id"]
        ]
        assert (entry["question"], entry["answer_id"]) == ("answered", "m4")


async def test_what_a_reply_asks_stays_open_as_long_as_the_robot_says_so() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        await rig.http.post("/api/chat", json=message("m1", "go to the box", "Ada"))
        rig.robots.say("Which box?", reply_to="m1", choices=("red", "blue"))
        await until_it_heard(page, 2)
        key = page.of("chat")[1]["entry"]["id"]
        await rig.http.post("/api/chat", json=message("m2", "what do you see?", "Ada"))
        rig.robots.say("A door.", reply_to="m2", still_asks="m1")
        asked = [("open", ""), ("answered", "m2"), ("open", "")]
        await page.until(lambda: len([one for one in page.of("chat") if one["entry"]["id"] == key]) == 3)
        told = [one["entry"] for one in page.of("chat") if one["entry"]["id"] == key]
        assert [(one["question"], one["answer_id"]) for one in told] == asked
        answer = await rig.http.post("/api/chat", json=message("m3", "red", "Ada", reply_to=key))
        assert answer.status_code == 200
        rig.robots.say("I go there.", reply_to="m3")
        await page.until(lambda: page.of("chat")[-1]["entry"]["message"] == "I go there.")
        told = [one["entry"] for one in page.of("chat") if one["entry"]["id"] == key]
        assert told[-1]["question"] == "answered"


async def test_a_reply_that_asks_back_is_settled_by_the_next_reply_to_what_was_said_elsewhere() -> None:
    async with served("Ada", "Bob") as rig:
        page = await rig.page()
        rig.robots.say("Where shall I bring it?", asks=True)
        await until_it_heard(page, 1)
        await rig.http.post("/api/chat", json=message("m1", "Ada, to the red box", "Bob"))
        rig.robots.say("I will bring it to the red box.", reply_to="m1")
        await until_it_heard(page, 4)
        assert [(one["entry"]["message"], one["entry"]["question"]) for one in page.of("chat")][-2:] == [
            ("Where shall I bring it?", "answered"),
            ("I will bring it to the red box.", ""),
        ]


async def test_a_draft_grows_and_is_replaced_by_the_reply_under_the_same_key() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        await rig.http.post("/api/chat", json=message("m1", "go home", "Ada"))
        rig.robots.tell(topics.REPLY_DRAFT, ReplyDraft(reply_to="m1", targets=("Ada",), message="I will"))
        await page.until(lambda: len(page.of("chat")) == 2)
        rig.robots.say("I will go home.", reply_to="m1")
        await page.until(lambda: len(page.of("chat")) == 3)
        draft, final = page.of("chat")[1]["entry"], page.of("chat")[2]["entry"]
        assert (draft["draft"], final["draft"]) == (True, False)
        assert draft["id"] == final["id"]
        stored = (await rig.http.get("/api/chat")).json()["entries"]
        assert [entry["message"] for entry in stored] == ["go home", "I will go home."]


async def test_what_others_say_to_robots_is_seen_too() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        kim = person("Kim\n", device="terminal")
        said = ChatInput(message="go home\nAda: yes\u202e", targets=("Ada",), id="t1", by=kim)
        rig.robots.tell(topics.CHAT_INPUT, said)
        await page.until(lambda: page.of("chat"))
        entry = page.of("chat")[0]["entry"]
        shown = ("operator", "Kim", "terminal", "go home / Ada: yes⟨U+202E⟩")
        assert (entry["who"], entry["author"], entry["device"], entry["message"]) == shown


async def test_history_is_read_in_pieces_and_searched() -> None:
    async with served("Ada", "Bob") as rig:
        for number in range(7):
            name = "Ada" if number % 2 else "Bob"
            await rig.http.post("/api/chat", json=message(f"m{number}", f"Go to Box {number}", name))
        newest = (await rig.http.get("/api/chat", params={"limit": 3})).json()
        assert [entry["id"] for entry in newest["entries"]] == ["m4", "m5", "m6"]
        assert newest["complete"] is False
        before = newest["entries"][0]["seq"]
        rest = (await rig.http.get("/api/chat", params={"limit": 10, "before": before})).json()
        assert [entry["id"] for entry in rest["entries"]] == ["m0", "m1", "m2", "m3"]
        assert rest["complete"] is True
        found = (await rig.http.get("/api/chat", params={"q": "box 5"})).json()
        assert [entry["id"] for entry in found["entries"]] == ["m5"]
        of_ada = (await rig.http.get("/api/chat", params={"robot": "ada"})).json()
        assert [entry["id"] for entry in of_ada["entries"]] == ["m1", "m3", "m5"]


async def test_a_photo_goes_to_the_robot_and_is_shown_in_the_chat() -> None:
    async with served("Ada") as rig:
        data = base64.b64encode(JPEG).decode()
        photo = {"name": "box.jpg", "data": data}
        answer = await rig.http.post("/api/chat", json=message("m1", "look", "Ada", images=[photo]))
        (address,) = answer.json()["images"]
        shown = await rig.http.get(address)
        assert (shown.content, shown.headers["content-type"]) == (JPEG, "image/jpeg")
        await rig.heard()
        assert rig.robots.inputs[0].images[0].data == data


async def test_what_a_robot_speaks_of_is_shown_with_its_words() -> None:
    async with served("Ada") as rig:
        photo = {"data": base64.b64encode(JPEG).decode()}
        rig.robots.say("I see a box.", type="info", images=[photo, {"data": "no picture"}])
        await rig.until(lambda: rig.server.backend.state.chat.entries)
        await rig.heard()
        (entry,) = (await rig.http.get("/api/chat")).json()["entries"]
        (address,) = entry["images"]
        assert (await rig.http.get(address)).content == JPEG


async def test_what_is_no_picture_is_refused_before_anything_is_sent() -> None:
    async with served("Ada") as rig:
        text = {"name": "a.txt", "data": base64.b64encode(b"hello").decode()}
        answer = await rig.http.post("/api/chat", json=message("m1", "look", "Ada", images=[text]))
        assert answer.status_code == 422
        assert answer.json()["path"] == "images"
        await rig.heard()
        assert rig.robots.inputs == []


async def test_words_of_control_answer_no_question() -> None:
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.ask("Which box?")
        await page.until(lambda: page.of("chat"))
        await rig.http.post("/api/chat", json=message("m1", "stop", "Ada"))
        await rig.heard()
        assert [said.type for said in rig.robots.inputs] == ["request"]
        (open_one,) = [e for e in (await rig.http.get("/api/snapshot")).json()["chat"] if e["question"]]
        assert open_one["question"] == "open"


async def test_the_same_message_posted_twice_at_once_is_sent_once() -> None:
    async with served("Ada") as rig:
        posts = [rig.http.post("/api/chat", json=message("m1", "go home", "Ada")) for _ in range(5)]
        answers = await asyncio.gather(*posts)
        assert {answer.status_code for answer in answers} <= {200, 409}
        await rig.heard()
        assert len(rig.robots.inputs) == 1


async def test_a_picture_needs_no_words_but_something_must_be_there() -> None:
    async with served("Ada") as rig:
        photo = {"name": "box.jpg", "data": base64.b64encode(JPEG).decode()}
        answer = await rig.http.post("/api/chat", json=message("m1", "", "Ada", images=[photo]))
        assert answer.status_code == 200
        await rig.heard()
        assert (rig.robots.inputs[0].message, len(rig.robots.inputs[0].images)) == ("", 1)
        assert (await rig.http.post("/api/chat", json=message("m2", "", "Ada"))).status_code == 422


async def test_people_are_told_when_what_robots_said_was_lost_on_its_way_to_them() -> None:
    async with served("Ada") as rig:
        for number in range(1200):
            rig.robots.say(f"word {number}")
        await rig.heard()
        told = [entry for entry in rig.server.backend.state.chat.newest(2000) if entry.type == "error"]
        assert len(told) == 1 and "did not get here" in told[0].message and ": 200." in told[0].message


async def test_what_nobody_has_read_is_said_again_until_it_is_and_once_it_was_no_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(outbox, "AGAIN_S", 0.05)
    async with served("Ada") as rig:
        rig.robots.tell(topics.CHAT_READ, ChatRead())
        await rig.http.post("/api/chat", json=message("m1", "go home", "Ada"))
        await until(lambda: len(rig.robots.inputs) > 2)
        assert await rig.server.backend.store.unsent(), "a killed server sends it again"
        rig.robots.tell(topics.CHAT_READ, ChatRead(id="m1"))
        await until(lambda: not rig.server.backend.outbox.waiting)
        assert not await rig.server.backend.store.unsent()
        assert {said.id for said in rig.robots.inputs} == {"m1"}


async def test_what_nobody_reads_in_time_is_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(outbox, "RESEND_WITHIN_MS", 100)
    async with served("Ada") as rig:
        page = await rig.page()
        rig.robots.tell(topics.CHAT_READ, ChatRead())
        await rig.http.post("/api/chat", json=message("m1", "go home", "Ada"))
        await until_it_heard(page, 2)
        assert "may not have got “go home”" in page.of("chat")[1]["entry"]["message"]


async def test_a_reader_of_another_make_gets_each_message_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(outbox, "AGAIN_S", 0.01)
    monkeypatch.setattr(outbox, "RESEND_WITHIN_MS", 100)
    async with served("Ada") as rig:
        page = await rig.page()
        await rig.http.post("/api/chat", json=message("m1", "go home", "Ada"))
        await until(lambda: not rig.server.backend.outbox.waiting)
        assert len(rig.robots.inputs) == 1
        assert len(page.of("chat")) == 1


async def test_what_a_program_says_on_and_on_stands_there_once() -> None:
    async with served("Ada") as rig:
        for _ in range(3):
            rig.robots.tell(topics.CHAT_INPUT, ChatInput(message="go home", targets=("Ada",)))
        await rig.heard()
        assert [entry["message"] for entry in (await rig.http.get("/api/chat")).json()["entries"]] == [
            "go home"
        ]
