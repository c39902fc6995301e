"""What is made of annotated sentences for the training: the marks must still stand on their words."""

from __future__ import annotations

import random

from parley_train.data import written
from parley_train.markup import Annotated, read_line
from parley_train.varying import exchanged, joined, vary

TWO = read_line("order\t{take:TAKE} (T the old *box) and {leave:!TAKE} (T the other *half) (G in the *hall)")
OTHER = read_line("told\t(T the small grey and dusty *cat) {is:BELOC} (L in the *garden)")


def test_each_of_two_things_is_exchanged_where_it_stands() -> None:
    for seed in range(40):
        for sentence in vary([TWO, OTHER], random.Random(seed), 1.0):
            whole(sentence)
            begun = "".join(sentence.words[trigger.start][0] for trigger in sentence.triggers)
            assert begun in ("tl", "i")  # the rest may be mistyped


def test_roles_are_exchanged_for_the_same_with_the_same_first_word() -> None:
    third = read_line("order\t{look:LOOK} (L in the *yard)")
    for seed in range(20):
        first, _, last = exchanged([TWO, OTHER, third], random.Random(seed), 1.0)
        assert first == TWO  # no other role G
        whole(last)
        assert " ".join(last.words) in ("look in the yard", "look in the garden")


def test_two_sentences_become_one_message() -> None:
    found = joined([TWO, OTHER], random.Random(1), 1.0)
    for sentence in found:
        whole(sentence)
        assert len(sentence.triggers) in (2, 3, 4)
    both = next(one for one in found if len(one.triggers) == 3)
    assert {both.triggers[span.owner].frame for span in both.roles if span.owner is not None} == {
        "TAKE",
        "BELOC",
    }
    assert set(both.acts) == {"order", "told"}


def test_marks_stand_on_words_whatever_is_done_to_the_sentences() -> None:
    chance = random.Random(3)
    for sentence in joined(vary(exchanged(written(), chance, 0.5), chance, 0.5), chance, 0.5):
        whole(sentence)


def whole(sentence: Annotated) -> None:
    """Every mark stands on words that are there."""
    size = len(sentence.words)
    assert len(sentence.acts) == len(sentence.moves) == size
    assert all(0 <= trigger.start < trigger.end <= size for trigger in sentence.triggers)
    assert all(place < size for trigger in sentence.triggers for place in trigger.particles)
    assert all(0 <= span.start <= span.head < span.end <= size for span in sentence.roles)
