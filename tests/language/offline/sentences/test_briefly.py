"""Small things around what is meant, put briefly."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.briefly import briefly
from parley.language.offline.words.text import keys, tokens


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("do the very same at the shed", "do the same at the shed"),
        ("do exactly the same thing at the shed", "do the same at the shed"),
        ("rust? check the shed", "check the shed for rust"),
        ("ready? check the shed", "ready? check the shed"),
        ("check the shed: is it open?", "check the shed. is it open?"),
        ("take the crates that are lying there, please", "take the crates, please"),
        ("bring it to Ann, who is in the shed right now.", "bring it to Ann in the shed."),
        (
            "bring her the crate. When you have handed it over, go home.",
            "bring her the crate. then go home.",
        ),
        ("see if the shed is shut, and the barn as well", "see if the shed is shut. and the barn as well"),
        ("see if you can tell what it is", "see what it is"),
        ("check whether you can find the cat there", "look for the cat there"),
        ("then go and find me in the shed.", "then come to the shed."),
        ("of the two crates, check the one near the shed", "check the crate near the shed"),
        ("of the two sheds, pick the one near the road and go there", "go to the shed near the road"),
    ],
)
def test_the_same_is_said_in_fewer_words(said: str, read: str) -> None:
    assert keys(briefly(tokens(said))) == keys(tokens(read))


@pytest.mark.parametrize(
    "said",
    [
        "When you have handed it over, go home.",
        "check that the crate that is there is shut",
        "take the one near the shed and bring it to me",
        "the shed: is it open?",
    ],
)
def test_what_says_something_of_its_own_is_left(said: str) -> None:
    assert keys(briefly(tokens(said))) == keys(tokens(said))
