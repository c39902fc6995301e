"""Whatever JSON a model makes up, it is an order that holds, or is refused; never anything else."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from parley.agents.planner.check import plan_problems
from parley.language.llm.answers import ANSWERS, PlanAnswer
from parley.language.llm.drafts import DraftReader
from parley.language.llm.reading import AnswerRefusedError, read_plan
from parley.messages.chat import ChatAction
from parley.messages.wire import decode, encode
from tests.agents.crew import look
from tests.language.llm.rig import situation

WORDS = st.sampled_from(
    [
        "Look",
        "Find",
        "Drive",
        "Fly",
        "what",
        "target",
        "x",
        "box",
        "",
        "pop",
        "clear",
        "add_memory",
        "A",
        "B",
        "Z",
    ]
)
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-3, 3) | st.floats() | WORDS | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(WORDS, inner, max_size=3),
    max_leaves=8,
)
STEPS = st.fixed_dictionaries(
    {"action": WORDS},
    optional={
        "parameters": st.dictionaries(WORDS, VALUES, max_size=3),
        "reason": st.text(max_size=10),
        "repeat": st.integers(0, 5) | VALUES,
        "only_if": st.fixed_dictionaries({"step": st.integers(-1, 4), "result": st.booleans()}) | VALUES,
        "together_with": st.integers(-1, 4),
    },
)
LIKELY = st.one_of(
    st.fixed_dictionaries({"action": st.just("Look"), "parameters": st.fixed_dictionaries({"what": WORDS})}),
    st.fixed_dictionaries(
        {"action": st.just("Find"), "parameters": st.fixed_dictionaries({"target": WORDS})}
    ),
    st.fixed_dictionaries({"action": st.just("Drive")}, optional={"parameters": st.just({"x": 1})}),
)
"""Steps that may well hold."""
FLOWS = st.fixed_dictionaries(
    {},
    optional={
        "only_if": st.fixed_dictionaries({"step": st.integers(0, 2), "result": st.booleans()}),
        "together_with": st.integers(0, 2),
        "repeat": st.integers(1, 3),
    },
)
GOOD_STEPS = st.one_of(LIKELY, st.builds(lambda step, flow: step | flow, LIKELY, FLOWS))
COMMANDS = st.fixed_dictionaries(
    {"command": WORDS}, optional={"index": st.integers(-1, 3), "name": WORDS, "data": st.text(max_size=5)}
)
ANSWERS_MADE_UP = st.fixed_dictionaries(
    {"message_response": st.text(min_size=1, max_size=20)},
    optional={
        "queue": st.lists(GOOD_STEPS, max_size=4) | st.lists(GOOD_STEPS | STEPS | VALUES, max_size=4),
        "system_cmd": st.lists(COMMANDS | VALUES, max_size=3),
        "targets": st.lists(WORDS, max_size=2) | VALUES,
        "choices": st.lists(WORDS, max_size=3),
        "sources": st.lists(WORDS, max_size=3),
    },
)


@given(ANSWERS_MADE_UP)
def test_made_up_plan_holds_or_is_refused(made_up: dict[str, Any]) -> None:
    known = situation(queue=(look("crate"),))
    try:
        order = read_plan(PlanAnswer.model_validate(made_up), known, plan_problems)
    except (ValidationError, AnswerRefusedError):
        return
    assert {call.name for call in order.queue} <= {"Look", "Find", "Drive"}
    assert set(order.targets) <= {"A", "B"}
    assert plan_problems(order.queue, known.catalogue) == []
    assert decode(ChatAction, encode(order)).queue == order.queue


@given(st.sampled_from(list(ANSWERS.values())), VALUES)
def test_any_json_is_an_answer_or_none(answer: Any, value: Any) -> None:
    try:
        answer.model_validate(value)
    except ValidationError:
        return


@given(st.text(max_size=60), st.integers(1, 9), st.booleans())
def test_drafts_grow_to_the_whole_reply(reply: str, size: int, escaped: bool) -> None:
    answer = {"message_response": reply, "queue": [{"action": "Look"}]}
    text = json.dumps(answer, ensure_ascii=escaped)
    reader, drafts = DraftReader(), [""]
    for start in range(0, len(text), size):
        draft = reader.feed(text[start : start + size])
        if draft is not None:
            drafts.append(draft)
    assert drafts[-1] == reply
    lengths = [len(draft) for draft in drafts]
    assert lengths == sorted(lengths)
