"""What is to be left alone, however it is said."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.scoping import scoped
from parley.language.offline.sentences.sparing import spares, spares_it
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain, tokens

STOPS = {("lab",), ("hall",), ("yard",), ("aisle", "2")}


def is_stop(words: Phrase) -> bool:
    return keys(bare(words)) in STOPS and all(word.is_word for word in words)


def ids_of(words: Phrase) -> tuple[str, ...]:
    return (" ".join(keys(bare(words))),)


@pytest.mark.parametrize(
    "text",
    [
        "the lab isn't to be disturbed",
        "please leave the lab alone",
        "nobody needs you at the lab",
        "the guest in the lab wants to be left in peace",
        "though the lab mustn't be entered",
        "you've no business in the lab",
        "don't let me catch you at the lab again",
        "the lab is off limits until they have drained it",
        "don't go near the lab because they're hosing it down",
        "Tom has already checked the lab",
        "no one is supposed to go into the lab",
        "aisle 2 can wait",
        "give the lab a miss",
    ],
)
def test_a_part_that_spares_a_thing_is_known_in_any_words(text: str) -> None:
    assert [plain(bare(name)) for name in spares(tokens(text), is_stop)] in (["lab"], ["aisle 2"])


@pytest.mark.parametrize(
    "text",
    [
        "do not forget the lab",
        "leave the lab for last",
        "the lab is not open",
        "nobody is at the lab",
        "make sure nobody is in the lab",
        "check if the lab is not needed",
        "don't leave without checking the lab",
        "there is no light in the lab",
        "the lab has not been checked",
    ],
)
def test_what_only_sounds_like_it_spares_nothing(text: str) -> None:
    assert spares(tokens(text), is_stop) == ()


@pytest.mark.parametrize(
    "text", ["leave it", "let her sleep", "no need to look at that one", "stay out of there"]
)
def test_what_was_spoken_of_can_be_spared(text: str) -> None:
    assert spares_it(tokens(text))
    assert not spares_it(tokens("check it"))


@pytest.mark.parametrize(
    ("text", "meant", "spared"),
    [
        ("the lab isn't to be disturbed, so check the hall", "check the hall", {"lab"}),
        ("the lab was swept, leave it, and check the hall", "check the hall", {"lab"}),
        ("check the hall, but stay out of the lab, they are hosing it down", "check the hall", {"lab"}),
        ("check the hall leave out aisle 2", "check the hall", {"aisle 2"}),
        ("you are not needed at the lab, the yard is where you are needed", "go to the yard", {"lab"}),
        ("do not inspect the lab, just go there", "do not inspect the lab, just go there", set()),
    ],
)
def test_the_rest_of_the_message_is_what_is_wanted(text: str, meant: str, spared: set[str]) -> None:
    found = scoped(tokens(text), is_stop, lambda part: False, ids_of)
    assert plain(found.words).rstrip(" ,.").lower().removeprefix("so ").removeprefix(
        "and "
    ) == meant or meant in plain(found.words)
    assert found.spared == spared
