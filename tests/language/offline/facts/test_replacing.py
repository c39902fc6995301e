"""Facts told by what they take the place of."""

from __future__ import annotations

import pytest

from parley.language.offline.facts.replacing import put_plainly
from parley.language.offline.words.text import plain, tokens


@pytest.mark.parametrize(
    ("said", "plainly"),
    [
        ("it is not the lamp that flickers at night, it is the screen", "the screen flickers at night"),
        ("it is the screen that flickers, not the lamp", "the screen flickers"),
        ("we changed the password to raspberry", "the password is now raspberry"),
        ("we have renamed the stores to depots", "the stores are now depots"),
        ("the nurse is not Ana any more, it is Tom", "the nurse is Tom"),
        ("I was wrong about the keys, they are in the hall", "the keys are in the hall"),
        ("what I said about the keys was wrong, they are in the hall", "the keys are in the hall"),
        ("I told you wrong about Ida, dear, she is in the hall", "Ida is in the hall"),
        ("actually, scratch that, Ida is in the hall", "Ida is in the hall"),
        ("Ida has moved, she is in the hall now", "Ida is in the hall now"),
        ("Ida has moved, she works in the hall now", "Ida works in the hall now"),
        ("the drill has been moved. It is in the shed", "the drill is in the shed"),
        ("Ida has changed her mind, she is in the hall", "Ida has changed her mind, she is in the hall"),
        ("Noah put it in the hall", "Noah has put it in the hall"),
        ("put it in the hall", "put it in the hall"),
        ("we changed the filter", "we changed the filter"),
        (
            "it is not the lamp that worries me, it is the screen",
            "it is not the lamp that worries me, it is the screen",
        ),
    ],
)
def test_corrections_are_put_as_plain_statements(said: str, plainly: str) -> None:
    assert plain(put_plainly(tokens(said))) == plainly
