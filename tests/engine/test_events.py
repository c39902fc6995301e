"""Events are written without a payload in between, so what is written has to be that payload."""

from __future__ import annotations

import json

from hypothesis import given
from hypothesis import strategies as st

from parley.engine.events import event_fields
from parley.messages.pvf import Parameter
from parley.messages.status import GraphEvent
from parley.messages.wire import decode, encode, to_string_unchecked
from parley.umrf.model import Result
from parley.umrf.transition import Transition

TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
OUTPUTS = st.dictionaries(
    st.from_regex(r"[a-z]{1,3}(::[A-Z]{1,3})?", fullmatch=True),
    st.builds(Parameter, st.just("string"), TEXTS) | st.builds(Parameter, st.just("number"), NUMBERS),
    max_size=3,
).filter(lambda found: not any("::" in name and name.partition("::")[0] in found for name in found))
TRANSITIONS = st.builds(
    Transition,
    sequence=st.integers(0, 10**9),
    kind=st.sampled_from(["graph", "node", "progress"]),
    state=TEXTS,
    node=TEXTS,
    instance_id=st.integers(-1, 10**6),
    cause=TEXTS,
    result=st.none() | st.sampled_from(Result),
    outputs=OUTPUTS,
    message=TEXTS,
    progress=st.none() | NUMBERS,
    progress_text=TEXTS,
    robot_time_s=NUMBERS,
    unix_ms=st.integers(0, 2**53),
)


@given(transition=TRANSITIONS)
def test_what_is_written_is_what_the_payload_holds(transition: Transition) -> None:
    result = transition.result.value if transition.result is not None else ""
    payload = GraphEvent(
        actor="A",
        graph_name="g",
        result=result,
        outputs=dict(transition.outputs),
        **{
            name: getattr(transition, name)
            for name in GraphEvent.model_fields
            if name not in {"actor", "graph_name", "result", "outputs"}
        },
    )
    written = to_string_unchecked(event_fields("A", "g", transition)).data
    assert json.loads(written) == json.loads(encode(payload))
    assert decode(GraphEvent, written) == payload


def test_no_field_is_forgotten() -> None:
    assert event_fields("A", "g", Transition(0, "graph")).keys() == GraphEvent.model_fields.keys()
