"""Other words in the place of some."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.words.rewriting import rewritten
from parley.language.offline.words.text import Phrase, Word, plain, tokens


def test_what_is_found_is_replaced_and_read_only_once() -> None:
    words = tokens("a b a b c")

    def twice(at: int, before: Sequence[Word]) -> tuple[int, Phrase] | None:
        del before
        return (2, tokens("a b a")) if plain(words[at : at + 2]) == "a b" else None

    assert plain(rewritten(words, twice)) == "a b a a b a c"


def test_what_was_written_before_a_place_is_known_there() -> None:
    words = tokens("x, x x")

    def behind_word(at: int, before: Sequence[Word]) -> tuple[int, Phrase] | None:
        del at
        return (1, ()) if before and before[-1].is_word else None

    assert plain(rewritten(words, behind_word)) == "x"
    assert rewritten((), behind_word) == ()
