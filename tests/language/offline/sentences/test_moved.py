"""Where a thing was put is told of the thing."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.moved import where_it_was_put
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
