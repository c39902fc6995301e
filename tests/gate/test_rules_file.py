"""`rules.yaml`: what is wrong with it, and what is left of people's text when it is written back."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.clock import SimClock
from parley.errors import ConfigError, FileFormatError
from parley.gate.book import RuleBook
from parley.gate.rules import RuleKeeper, read_rules, rule_yaml, with_rules
from parley.messages.rules import Hours, Rule, RuleSet

WRITTEN = """\
# Agreed on with the ward, ask Kim.
schema: 1
timezone: Europe/Tallinn
rules:
  # The storeroom holds medicine.
  - id: store
    kind: keep_out
    name: storeroom   # the small one
    rectangle: [4, -1, 6, 1]
    when: {from: 14:00, to: 2:30}
  # Nights are quiet.
  - {id: night, kind: action, classes: [moves], verdict: ask, when: {from: "22:00", to: "06:00"}}
"""
STORE = "rules:\n- id: store\n  kind: keep_out\n"


def test_a_file_is_read() -> None:
    store, night = read_rules(WRITTEN).rules
    assert store.when == Hours(start="14:00", end="02:30")
    assert store.corners == ((4, -1), (6, -1), (6, 1), (4, 1))
    assert (night.classes, night.verdict) == (("moves",), "ask")
    assert read_rules("") == RuleSet()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("schema: 2", "rules.yaml, line 1: schema"),
        ("schema: 1\nrule: []", "rules.yaml, line 2: rule: there is no such setting"),
        (STORE + "  rectangel: [0, 0, 1, 1]", "line 4: rules[0].rectangel: there is no such setting"),
        (STORE, "line 2: rules[0]: keep_out needs either rectangle or polygon"),
        (STORE + "  rectangle: [0, 0, 0, 1]", "line 4: rules[0].rectangle: has no size"),
        (STORE + "  rectangle: [0, 0, .nan, 1]", "line 4: rules[0].rectangle[2]"),
        (STORE + "  rectangle: [0, 0, 1e9, 1]", "lies too far away"),
        (STORE + "  polygon: [[0, 0], [1, 1]]", "must have 3 to 200 corners"),
        (STORE + "  polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]", "crosses itself"),
        (STORE + "  polygon: [[0, 0], [1, 1], [2, 2]]", "has no size"),
        (STORE + "  rectangle: [0, 0, 1, 1]\n  max_steps: 3", "max_steps: means nothing for keep_out"),
        (STORE + "  rectangle: [0, 0, 1, 1]\n  when: {from: 14:00}", "says only one of from and to"),
        (STORE + "  rectangle: [0, 0, 1, 1]\n  when: {from: 25:00, to: 3:00}", "line 5: rules[0].when.from"),
        (STORE + "  rectangle: [0, 0, 1, 1]\n  robots: Ada", "line 5: rules[0].robots"),
        (STORE + "  rectangle: [0, 0, 1, 1]\n  exempt: [boss]", "line 5: rules[0].exempt[0]"),
        ("rules:\n- {id: a b, kind: action}", "line 2: rules[0].id"),
        ("rules:\n- {id: a, kind: action}\n- {id: a, kind: action}", "two rules have the id 'a'"),
        ("rules:\n- {id: a, kind: slow, rectangle: [0, 0, 1, 1]}", "slow needs max_speed_mps"),
        ("rules:\n- {id: a, kind: plan}", "plan needs one of"),
        ("rules: {a: 1", "not valid YAML"),
        ("[1, 2]", "rules.yaml, line 1"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_file_line_and_field(text: str, said: str) -> None:
    with pytest.raises(FileFormatError) as info:
        read_rules(text)
    assert said in str(info.value)


def test_a_time_zone_that_nobody_knows_is_refused() -> None:
    with pytest.raises(ConfigError, match="Atlantis"):
        RuleBook(SimClock(), RuleSet(timezone="Atlantis/Center"))


def test_writing_back_keeps_what_people_wrote() -> None:
    before = read_rules(WRITTEN)
    limit = Rule(id="far", kind="plan", max_distance_m=50)
    text = with_rules(WRITTEN, before, before.model_copy(update={"rules": (*before.rules, limit)}))
    assert read_rules(text).rules == (*before.rules, limit)
    for kept in (
        "# Agreed on",
        "timezone: Europe/Tallinn",
        "# The storeroom",
        "# the small one",
        "# Nights",
    ):
        assert kept in text
    without = with_rules(WRITTEN, before, before.model_copy(update={"rules": before.rules[1:]}))
    assert "storeroom" not in without
    assert "# Nights are quiet." in without
    assert read_rules(without).rules == before.rules[1:]
    assert (
        read_rules(with_rules(WRITTEN, before, RuleSet(timezone="Europe/Tallinn"))).timezone
        == "Europe/Tallinn"
    )


_rules = st.builds(
    Rule,
    id=st.from_regex(r"\A[a-z][a-z0-9_-]{0,8}\Z"),
    kind=st.just("keep_out"),
    name=st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), max_size=20),
    rectangle=st.tuples(*[st.floats(-1e4, 1e4) for _ in range(2)]).map(lambda p: (*p, p[0] + 1, p[1] + 1)),
    words=st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), max_size=30),
    when=st.none() | st.just(Hours(start="22:00", end="06:00", days=("mon", "fri"))),
)


@settings(max_examples=60, deadline=None)
@given(sets=st.lists(st.lists(_rules, max_size=4, unique_by=lambda rule: rule.id), min_size=1, max_size=4))
def test_whatever_is_written_is_read_again(sets: list[list[Rule]]) -> None:
    text, before = "", RuleSet()
    for rules in sets:
        after = RuleSet(rules=tuple(rules))
        text, before = with_rules(text, before, after), after
        assert read_rules(text).rules == after.rules


def test_a_rule_reads_well_in_the_file() -> None:
    rule = Rule(
        id="ward",
        kind="keep_out",
        name="ward",
        rectangle=(0, 0, 2, 3),
        when=Hours(start="14:00", end="15:00"),
    )
    assert rule_yaml(rule) == (
        "- id: ward\n  kind: keep_out\n  name: ward\n  rectangle: [0.0, 0.0, 2.0, 3.0]\n"
        "  when: {from: '14:00', to: '15:00'}\n"
    )


async def test_rules_are_kept_and_a_file_that_others_changed_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "data" / "rules.yaml"
    book = RuleBook(SimClock())
    keeper = RuleKeeper(book, path)
    store = Rule(id="store", kind="keep_out", rectangle=(0, 0, 1, 1))
    await keeper.put(store, None)
    await keeper.put(store.model_copy(update={"name": "storeroom"}), None)
    again = RuleBook(SimClock())
    RuleKeeper(again, path)
    assert [rule.name for rule in again.rules.rules] == ["storeroom"]
    path.write_text(WRITTEN, encoding="utf-8")
    with pytest.raises(ConfigError, match="changed by somebody else"):
        await keeper.drop("store", None)
    assert path.read_text(encoding="utf-8") == WRITTEN
    assert book.rules.get("store") is not None
    assert sorted(item.name for item in path.parent.iterdir()) == ["rules.yaml"]


async def test_without_a_file_rules_hold_while_the_process_runs() -> None:
    book = RuleBook(SimClock())
    keeper = RuleKeeper(book)
    await keeper.put(Rule(id="a", kind="action"), None)
    assert await keeper.drop("a", None) == Rule(id="a", kind="action")
    assert await keeper.drop("a", None) is None
