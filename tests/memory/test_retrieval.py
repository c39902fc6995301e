"""What is looked for, and in which order finds come. No database needed."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.memory.retrieval import (
    MAX_COMMON_TERMS,
    MAX_TERMS,
    Hits,
    common_terms,
    final_order,
    fts_phrase,
    name_key,
    query_terms,
    scores,
    telling,
    words,
)
from parley.messages.memory import MemoryEntry


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("The box, by the door!", ["the", "box", "by", "the", "door"]),
        ("box_location", ["box", "location"]),
        ("boxLocation", ["box", "location"]),
        ("gate3b", ["gate3b"]),
        ("Öökülm KÖÖK", ["öökülm", "köök"]),
        ("ｂｏｘ", ["box"]),
        ("?!", []),
        ("", []),
    ],
)
def test_words_are_found_in_texts_and_in_names(text: str, expected: list[str]) -> None:
    assert words(text) == expected


def test_spellings_of_one_name_have_the_same_key() -> None:
    assert (
        len({name_key(name) for name in ("box_location", "boxLocation", "Box location", "box-location")}) == 1
    )
    assert name_key("?!") == "?!"


@pytest.mark.parametrize(
    ("query", "terms"),
    [
        ("Where is the box?", [("box",)]),
        ("box box BOX", [("box",)]),
        ("go to area B", [("area",), ("area", "b")]),
        ("Area A and gate 12", [("area",), ("area", "a"), ("gate",), ("gate", "12")]),
        ("room 3b", [("room",), ("room", "3b")]),
        ("12", [("12",)]),
        ("what is there for him?", []),
        ("", []),
    ],
)
def test_only_telling_words_are_looked_for_and_labels_with_what_they_label(
    query: str, terms: list[tuple[str, ...]]
) -> None:
    assert query_terms(query) == terms


def test_a_very_long_request_is_searched_by_its_first_words() -> None:
    assert len(query_terms(" ".join(f"word{number}" for number in range(50_000)))) == MAX_TERMS
    assert query_terms("x" * 1_000_000)


@given(st.text())
def test_a_phrase_is_one_quoted_string_whatever_it_holds(text: str) -> None:
    phrase = fts_phrase([text])
    assert phrase[0] == phrase[-1] == '"'
    assert '"' not in phrase[1:-1].replace('""', "")


def test_a_rare_word_tells_more_than_a_common_one() -> None:
    rare = Hits((7, 3), complete=True)
    common = Hits(tuple(range(1000, 700, -1)), complete=False)
    assert rare.weight(newest_id=1000) > 3 * common.weight(newest_id=1000) >= 0


def test_how_common_a_word_is_shows_in_how_densely_its_newest_memories_stand() -> None:
    dense = Hits(tuple(range(100_000, 99_700, -1)), complete=False)
    sparse = Hits(tuple(range(100_000, 70_000, -100)), complete=False)
    assert sparse.weight(100_000) > dense.weight(100_000)
    assert dense.weight(100_000) == pytest.approx(0.0, abs=0.01)


def test_only_few_common_words_are_followed_further_the_most_telling_first() -> None:
    hits: dict[tuple[str, ...], Hits] = {(f"w{number}",): Hits((1,), complete=False) for number in range(10)}
    hits[("rare",)] = Hits((1,), complete=True)
    weights = {term: 1.0 + number / 10 for number, term in enumerate(hits)}
    chosen = common_terms(hits, weights)
    assert chosen == [("w9",), ("w8",), ("w7",), ("w6",)]
    assert len(chosen) == MAX_COMMON_TERMS


def test_words_that_nearly_every_memory_holds_tell_nothing() -> None:
    assert telling([("a",), ("b",)], {("a",): 3.0, ("b",): 0.5, ("c",): 1.0}) == [("a",)]
    assert telling([], {}) == []


def test_scores_add_up_what_a_memory_shares_with_the_request() -> None:
    found: dict[tuple[str, ...], list[int]] = {("a",): [1, 2], ("b",): [2, 2]}
    assert scores(found, {("a",): 1.0, ("b",): 0.5}) == {1: 1.0, 2: 1.5}


def entry(name: str, data: str = "short", kind: str = "text") -> MemoryEntry:
    return MemoryEntry.model_validate({"name": name, "data": data, "type": kind})


def ordered(*candidates: tuple[int, float, MemoryEntry]) -> list[str]:
    return [found.name for found in final_order(candidates, {("box",): 1.0})]


def test_better_scores_come_first_and_of_equals_the_newest() -> None:
    assert ordered((1, 1.0, entry("a")), (2, 1.0, entry("b")), (3, 2.0, entry("c"))) == ["c", "b", "a"]


def test_a_word_in_the_name_counts_more_whatever_its_ending() -> None:
    assert ordered((1, 1.0, entry("boxes_place")), (2, 1.0, entry("a"))) == ["boxes_place", "a"]
    assert ordered((1, 1.0, entry("boxing_match")), (2, 1.0, entry("a"))) == ["a", "boxing_match"]


def test_long_texts_count_less_and_the_size_of_a_picture_does_not() -> None:
    assert ordered((2, 1.0, entry("long", "word " * 5000)), (1, 1.0, entry("a"))) == ["a", "long"]
    assert ordered((2, 1.0, entry("big", "A" * 50_000, "image")), (1, 1.0, entry("a"))) == ["big", "a"]
