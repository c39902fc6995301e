"""JSON in, typed payloads out, and back: every payload, and every way of being wrong."""

from __future__ import annotations

import inspect
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel

from parley.errors import InvalidMessageError
from parley.messages import (
    attendance,
    audit,
    base,
    chat,
    display,
    failure,
    incident,
    map,
    memory,
    passages,
    principal,
    status,
)
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput
from parley.messages.display import DisplayFeed
from parley.messages.memory import AddToMemory, MemoryEntry, RemoveMemory
from parley.messages.status import PlanUpdate, Rejection
from parley.messages.wire import (
    MAX_MESSAGE_CHARS,
    MAX_NESTING,
    decode,
    decode_plan,
    encode,
    load_json,
    to_string,
)
from tests.messages.samples import MEMORY, MOVE, SAMPLES

every_payload = pytest.mark.parametrize("kind", SAMPLES, ids=lambda kind: str(kind.__name__))


def payload_types() -> set[type[BaseModel]]:
    modules = (attendance, audit, chat, display, failure, incident, map, memory, passages, principal, status)
    exported = [getattr(module, name) for module in modules for name in module.__all__]
    return {item for item in exported if inspect.isclass(item) and issubclass(item, BaseModel)}


def required_fields() -> list[tuple[type[BaseModel], str]]:
    """(payload, key) of everything that must not be missing, where keys are fields."""
    named_by_content = {chat.ActionCall, memory.AddToMemory, memory.RemoveMemory, memory.MemoryReply}
    return [
        (kind, field.alias or name)
        for kind in SAMPLES
        if kind not in named_by_content and kind is not chat.SystemCommand
        for name, field in kind.model_fields.items()
        if field.is_required()
    ]


def test_every_payload_has_a_sample() -> None:
    assert payload_types() == set(SAMPLES)


@every_payload
def test_a_full_payload_survives_the_round_trip_unchanged(kind: type[BaseModel]) -> None:
    payload = decode(kind, json.dumps(SAMPLES[kind]))
    assert json.loads(encode(payload)) == SAMPLES[kind]
    assert decode(kind, encode(payload)) == payload


@every_payload
def test_payloads_are_frozen(kind: type[BaseModel]) -> None:
    payload = decode(kind, json.dumps(SAMPLES[kind]))
    if issubclass(kind, base.Payload):
        with pytest.raises(Exception, match="frozen"):
            setattr(payload, next(iter(kind.model_fields)), "other")


@every_payload
@pytest.mark.parametrize(
    "text", ["", "   ", "go to the door", "{", '{"a": NaN}', "null", "3", '"text"', "\udc80"]
)
def test_what_is_not_an_object_is_refused_with_the_kind_of_message_named(
    kind: type[BaseModel], text: str
) -> None:
    if kind is chat.SystemCommand and text == '"text"':
        return
    with pytest.raises(InvalidMessageError) as refused:
        decode(kind, text)
    assert refused.value.what == kind.__name__
    assert refused.value.problem


@pytest.mark.parametrize(
    ("kind", "key"), required_fields(), ids=lambda value: getattr(value, "__name__", value)
)
def test_a_missing_field_is_named(kind: type[BaseModel], key: str) -> None:
    sample = {name: value for name, value in SAMPLES[kind].items() if name != key}
    with pytest.raises(InvalidMessageError) as refused:
        decode(kind, json.dumps(sample))
    assert refused.value.path == key
    assert key in str(refused.value)


@pytest.mark.parametrize(
    ("kind", "key"), required_fields(), ids=lambda value: getattr(value, "__name__", value)
)
@pytest.mark.parametrize("wrong", [None, {"un": "fit"}], ids=["null", "object"])
def test_a_field_of_the_wrong_type_is_named(kind: type[BaseModel], key: str, wrong: Any) -> None:
    with pytest.raises(InvalidMessageError) as refused:
        decode(kind, json.dumps({**SAMPLES[kind], key: wrong}))
    assert refused.value.path.split(".")[0] == key


@every_payload
def test_keys_of_other_programs_are_ignored(kind: type[BaseModel]) -> None:
    names_are_content = {chat.ActionCall, chat.SystemCommand, memory.AddToMemory, memory.RemoveMemory}
    if kind in names_are_content or kind is memory.MemoryReply:
        return
    sample = SAMPLES[kind]
    assert decode(kind, json.dumps({**sample, "x_other": {"deep": [1]}})) == decode(kind, json.dumps(sample))


@pytest.mark.parametrize(
    ("kind", "text", "path"),
    [
        (ChatInput, '{"message": "x", "type": "shout"}', "type"),
        (ChatInput, '{"message": "x", "targets": "A"}', "targets"),
        (ChatInput, '{"message": "x", "targets": ["A", 3]}', "targets.1"),
        (ChatAction, '{"queue": {"Move": {}}}', "queue"),
        (ChatAction, '{"queue": [{"Move": 3}]}', "queue.0"),
        (ChatAction, '{"queue": [{}]}', "queue.0"),
        (ChatAction, '{"queue": [{"": {}}]}', "queue.0.name"),
        (ChatAction, '{"queue": [{"Move": {"input_parameters": {"x": 3}}}]}', "queue.0.input_parameters"),
        (ChatAction, '{"queue": [{"Move": {"flow": {"repeat": 0}}}]}', "queue.0.flow.repeat"),
        (ChatAction, '{"queue": [{"Move": {"flow": {"if": {}}}}]}', "queue.0.flow.if.step"),
        (ChatAction, '{"system_cmd": [{"explode": {}}]}', "system_cmd.0"),
        (AddToMemory, '{"box": "by the door"}', "box"),
        (AddToMemory, '{"box": {"info": "i"}}', "box.data"),
        (AddToMemory, '{"box": {"data": "d", "type": "smell"}}', "box.type"),
        (DisplayFeed, '{"target": "", "name": "n", "image": ""}', "target"),
        (DisplayFeed, '{"target": "A", "name": "n", "image": {"data": ""}}', "image.RawImage.height"),
        (PlanUpdate, '{"target": "A", "steps": [{"action": {}}]}', "steps.0.action"),
    ],
)
def test_the_path_leads_to_the_offending_field(kind: type[BaseModel], text: str, path: str) -> None:
    with pytest.raises(InvalidMessageError) as refused:
        decode(kind, text)
    assert refused.value.path == path


def test_what_is_wrong_inside_parameters_is_said_with_the_way_to_it() -> None:
    parameters = {"pose": {"x": {"pvf_type": "number", "pvf_value": "1"}}}
    text = json.dumps({"queue": [{"Move": {"input_parameters": parameters}}]})
    with pytest.raises(InvalidMessageError, match=r"pose\.x\.pvf_value: expected a value of type number"):
        decode(ChatAction, text)


@pytest.mark.parametrize("name", ["", "n" * 201])
def test_a_memory_needs_a_name_of_a_sensible_length(name: str) -> None:
    with pytest.raises(InvalidMessageError):
        decode(AddToMemory, json.dumps({name: MEMORY}))


# Texts that only look like JSON


@pytest.mark.parametrize("text", ["NaN", "Infinity", "-Infinity", "[1, NaN]", "1e999", "-1e400", "1" * 5000])
def test_numbers_that_json_does_not_know_are_refused(text: str) -> None:
    with pytest.raises(InvalidMessageError, match="not valid JSON"):
        load_json("anything", text)


@pytest.mark.parametrize("text", ['"\\ud83d"', '{"\\udc00": 1}', '"caf\udce9"'])
def test_half_characters_are_refused(text: str) -> None:
    with pytest.raises(InvalidMessageError, match="half a character"):
        load_json("anything", text)


def test_whole_characters_in_two_halves_are_read() -> None:
    assert load_json("anything", '"\\ud83e\\udd16 ä"') == "🤖 ä"


def test_deep_nesting_is_refused_and_reasonable_nesting_is_not() -> None:
    assert load_json("anything", "[" * MAX_NESTING + "]" * MAX_NESTING)
    for depth in (MAX_NESTING + 1, 900, 200_000):
        with pytest.raises(InvalidMessageError, match="nested too deeply"):
            load_json("anything", "[" * depth + "]" * depth)
        with pytest.raises(InvalidMessageError, match="nested too deeply"):
            load_json("anything", '{"a":' * depth + "1" + "}" * depth)


def test_many_brackets_side_by_side_or_inside_a_text_are_not_deep() -> None:
    assert load_json("anything", json.dumps([[[]]] * 1000)) == [[[]]] * 1000
    assert load_json("anything", json.dumps("[{" * 1000)) == "[{" * 1000


def test_what_can_be_read_can_be_written_again_however_deep() -> None:
    detail = json.loads('{"a":' * (MAX_NESTING - 1) + "1" + "}" * (MAX_NESTING - 1))
    text = json.dumps({"source": "A", "what": "w", "detail": detail})
    assert json.loads(encode(decode(Rejection, text)))["detail"] == detail


def test_long_messages_are_read_and_endless_ones_refused_unread() -> None:
    long = "please " * 15_000
    assert decode(ChatInput, json.dumps({"message": long})).message == long
    with pytest.raises(InvalidMessageError, match="more than"):
        load_json("anything", " " * (MAX_MESSAGE_CHARS + 1))


def test_an_empty_message_is_a_message() -> None:
    assert decode(ChatInput, '{"message": ""}') == ChatInput(message="")


# Properties

texts = st.text(st.characters(exclude_categories=["Cs"]))
json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**53), 2**53)
    | st.floats(allow_nan=False, allow_infinity=False)
    | texts,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(texts, inner, max_size=3),
    max_leaves=10,
)


@given(st.builds(ChatFeedback, message=texts, targets=st.tuples(texts), choices=st.tuples(texts, texts)))
def test_any_text_survives_the_wire(feedback: ChatFeedback) -> None:
    assert decode(ChatFeedback, to_string(feedback).data) == feedback


@given(st.dictionaries(st.text(min_size=1, max_size=10), json_values, max_size=4), texts)
def test_any_detail_survives_the_wire(detail: dict[str, Any], what: str) -> None:
    rejection = Rejection(source="A", what=what, detail=detail)
    if any("\ud800" <= char <= "\udfff" for key in detail for char in key):
        return
    assert decode(Rejection, encode(rejection)) == rejection


@given(st.text(max_size=40) | json_values.map(json.dumps))
def test_any_text_at_all_is_either_read_or_refused(text: str) -> None:
    for kind in SAMPLES:
        try:
            payload = decode(kind, text)
        except InvalidMessageError as refusal:
            assert refusal.what == kind.__name__
        else:
            assert decode(kind, encode(payload)) == payload


# Memory payloads


def test_memories_carry_their_names_inside_python_and_as_keys_on_the_wire() -> None:
    added = decode(AddToMemory, json.dumps({"box": MEMORY, "chair": {"data": "broken"}}))
    assert added.entries() == [MemoryEntry(name="box", **MEMORY), MemoryEntry(name="chair", data="broken")]


def test_the_body_of_a_memory_has_the_keys_of_the_thesis_and_ours_only_where_they_say_something() -> None:
    assert MemoryEntry(name="box", data="d").body() == {"type": "text", "data": "d", "info": ""}
    assert MemoryEntry(name="box", data="d", scope="A").body()["scope"] == "A"


@pytest.mark.parametrize("behind", [None, True, "", {}, []])
def test_what_stands_behind_a_name_to_forget_does_not_matter(behind: Any) -> None:
    assert set(decode(RemoveMemory, json.dumps({"box": behind})).root) == {"box"}


def test_an_action_keeps_its_own_name_whatever_its_body_says() -> None:
    (call,) = decode(ChatAction, json.dumps({"queue": [{"Move": {**MOVE["Move"], "name": "Other"}}]})).queue
    assert call.name == "Move"


def test_what_several_read_in_one_process_is_made_once() -> None:
    text = encode(PlanUpdate(target="Ada"))
    assert decode_plan(text) is decode_plan(text) and decode_plan(text) == decode(PlanUpdate, text)
