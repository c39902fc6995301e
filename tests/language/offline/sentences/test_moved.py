"""Where a thing was put is told of the thing."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.moved import out_of_the_way, where_it_was_put
from parley.language.offline.words.text import plain, tokens


@pytest.mark.parametrize(
    ("said", "plainly"),
    [
        (
            "The keys are not in the hall any more, I put them in the box.",
            "The keys are not in the hall any more. The keys are in the box.",
        ),
        ("The lamp was broken. She moved it to the shop", "The lamp was broken. The lamp is in the shop"),
        ("The lamp was here but she moved it to the shop", "The lamp was here. The lamp is in the shop"),
        ("The lamp was here, Ben put it in the shop", "The lamp was here. The lamp is in the shop"),
        ("It is gone, I put it in the box", "It is gone, I put it in the box"),
    ],
)
def test_what_was_put_somewhere_is_said_to_be_there(said: str, plainly: str) -> None:
    assert plain(where_it_was_put(tokens(said))) == plain(tokens(plainly))


@pytest.mark.parametrize(("said", "meant"), [
    ("move the van out of the way", "shift the van out of the way"),
    ("please drive the van away, then go to the gate", "please shift the van away, then go to the gate"),
    ("move away from the van", "go"),
    ("Get out of my way!", "go!"),
    ("move to the van", "move to the van"),
    ("move the van to the gate", "move the van to the gate"),
    ("go and see how far away the van is", "go and see how far away the van is"),
])  # fmt: skip
def test_nobody_is_sent_to_what_is_to_be_moved_or_left(said: str, meant: str) -> None:
    assert plain(out_of_the_way(tokens(said), frozenset())) == meant


def test_a_robot_that_moves_things_is_asked_to() -> None:
    said = tokens("move the crate out of the way")
    assert out_of_the_way(said, frozenset({"move"})) == said
