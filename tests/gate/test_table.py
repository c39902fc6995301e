from __future__ import annotations

from pathlib import Path

import pytest

from parley.gate.table import COLUMNS, TABLE, Column, Effect, column_of, verdict
from parley.messages.principal import Principal, person

DECIDES = (Effect.RESET, Effect.APPROVE, Effect.REJECT, Effect.ANSWER, Effect.POLICY)
OTHERS = [c for c in COLUMNS if c not in ("operator", "supervisor")]


def test_every_effect_has_a_verdict_for_everybody() -> None:
    assert set(TABLE) == {(effect, column) for effect in Effect for column in COLUMNS}


@pytest.mark.parametrize("effect", DECIDES)
@pytest.mark.parametrize("column", OTHERS)
def test_only_people_who_operate_release_decide_and_answer(effect: Effect, column: Column) -> None:
    assert TABLE[effect, column] == "refuse"


def test_what_a_person_held_only_a_person_lets_go_on() -> None:
    assert {TABLE[Effect.RESUME, column] for column in OTHERS} == {"own", "refuse"}
    assert TABLE[Effect.RESUME, "engine"] == "refuse"


@pytest.mark.parametrize("column", COLUMNS)
def test_everybody_may_stop(column: Column) -> None:
    assert TABLE[Effect.STOP, column] == TABLE[Effect.PAUSE, column] == "allow"


@pytest.mark.parametrize("effect", [e for e in Effect if e not in (Effect.SEE, Effect.STOP, Effect.PAUSE)])
def test_a_viewer_looks_and_stops_and_no_more(effect: Effect) -> None:
    assert TABLE[effect, "viewer"] == "refuse"


def test_nobody_but_a_person_begins_anything_past_the_policy() -> None:
    assert {TABLE[Effect.BEGIN, column] for column in OTHERS} == {"policy", "yes", "refuse"}


@pytest.mark.parametrize(
    ("who", "column"),
    [
        (None, "program"),
        (Principal(), "program"),
        (Principal(kind="program", key="dock"), "keyed program"),
        (person("Kim"), "operator"),
        (Principal(kind="person"), "operator"),
        (person("Kim", role="viewer"), "viewer"),
        (Principal(kind="engine", name="llm"), "engine"),
    ],
)
def test_whose_column_counts(who: Principal | None, column: Column) -> None:
    assert column_of(who) == column
    assert verdict(who, Effect.APPROVE) == TABLE[Effect.APPROVE, column]


def test_the_page_on_safety_prints_the_table_as_it_is() -> None:
    page = (Path(__file__).parents[2] / "docs" / "safety.md").read_text(encoding="utf-8")
    lines = ["| effect | " + " | ".join(COLUMNS) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for effect in Effect:
        cells = " | ".join(TABLE[effect, column] for column in COLUMNS)
        lines.append(f"| {effect.value} | {cells} |")
    assert "\n".join(lines) in page
