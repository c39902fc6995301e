"""Courtesy around an order changes nothing; what only looks like it is kept."""

from __future__ import annotations

import pytest

from parley.language.offline.words.courtesy import called_plainly, plainly
from parley.language.offline.words.text import keys, tokens


@pytest.mark.parametrize(
    "said",
    [
        "I was wondering whether you might possibly be able to check the box",
        "if it isn't too much bother I'd be ever so grateful if you would check the box",
        "would it be too much trouble to ask you to check the box",
        "is there any chance you could perhaps check the box",
        "have you got time to check the box",
        "check the box, thank you so much, you are a star",
        "sorry if I am disturbing you but could you check the box",
        "sorry to be a nuisance, but do you think you might manage to check the box",
        "I hate to ask, but could you check the box? Only when it suits you, of course.",
        "if it isn't too much trouble, dear, might you check the box",
        "it would be very much appreciated if you were to check the box, thank you in advance",
    ],
)
def test_courtesy_is_taken_off(said: str) -> None:
    read = [key for key in keys(plainly(tokens(said))) if key.isalpha()]
    assert read[-3:] == ["check", "the", "box"]
    assert len(read) <= 5


@pytest.mark.parametrize(
    "said",
    [
        "do you know where the box is",
        "have you checked the box",
        "go to the box and say thank you",
        "is the box open",
        "I would like some tea",
        "do not go there",
    ],
)
def test_what_is_no_courtesy_stays(said: str) -> None:
    assert plainly(tokens(said)) == tokens(said)


def test_a_request_in_the_middle_of_dictated_words_is_a_sentence_of_its_own() -> None:
    said = tokens("the weather is awful again today by the way could you go to the box and open it")
    assert " . could you go" in " ".join(keys(plainly(said))) or ". by the way" in " ".join(
        keys(plainly(said))
    )


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("go to the shed, my dear Fern", "go to the shed, fern"),
        ("Fern old friend, go to the shed", "fern, go to the shed"),
        ("check the box, sweetheart", "check the box"),
        ("look for my dear Lucy", "look for my dear lucy"),
        ("look for a friend, Fern", "look for a friend, fern"),
        ("tell Ann I miss her, my love", "tell ann i miss her, my love"),
    ],
)
def test_pet_names_go_from_an_address(said: str, read: str) -> None:
    assert keys(called_plainly(tokens(said), frozenset({"fern"}))) == keys(tokens(read))
