"""Replies while they are being written, over the real chat interface."""

from __future__ import annotations

import asyncio
import json
from itertools import pairwise

from parley.language.llm.drafts import DraftReader
from parley.language.llm.scripted_server import Say
from tests.language.llm.rig import LOOK_PLAN, model, room, situation


async def test_reply_is_published_while_the_plan_is_still_being_written() -> None:
    gate = asyncio.Event()
    async with room() as here:
        here.model.will(Say(answer=LOOK_PLAN, pieces=16, piece_gate=gate))
        answer = asyncio.create_task(here.say("look at the box"))
        await here.crew.until(lambda: here.drafts)
        assert here.crew.wire.commands() == []
        gate.set()
        told = await answer
        draft = here.drafts[0]
        assert told.reply_to == draft.reply_to
        assert draft.targets == ("A",)
        assert told.message.startswith(draft.message)


async def test_drafts_grow_to_the_whole_reply_in_every_form_of_answer() -> None:
    for form in ("tool", "native", "prompted"):
        async with model(output=form) as asked:
            asked.will(Say(answer=LOOK_PLAN, pieces=40))
            drafts: list[str] = []
            done = await asked.language.interpret(situation(), on_draft=drafts.append)
            assert drafts[-1] == done.message_response
            assert len(drafts) > 3
            assert all(later.startswith(draft) for draft, later in pairwise(drafts))


async def test_text_between_fences_is_streamed_too() -> None:
    async with model() as asked:
        asked.will(Say(text=f"```json\n{json.dumps(LOOK_PLAN)}\n```", pieces=40))
        drafts: list[str] = []
        await asked.language.interpret(situation(), on_draft=drafts.append)
        assert drafts[-1] == LOOK_PLAN["message_response"]


def test_draft_is_read_out_of_half_an_answer() -> None:
    reader = DraftReader()
    assert reader.feed('{"message_resp') is None
    assert reader.feed('onse": "I will') == "I will"
    assert reader.feed(' go \\"there') == 'I will go "there'
    assert reader.feed('.", "queue": [{"act') == 'I will go "there.'
    assert reader.feed('ion": "Look"}]}') is None


def test_text_that_is_no_answer_gives_no_draft() -> None:
    reader = DraftReader()
    assert reader.feed("Let me think: [1, 2] ") is None
    assert reader.feed('{"thought": "hm"}') is None
