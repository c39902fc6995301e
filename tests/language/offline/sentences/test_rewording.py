"""Other ways to say the same become the order of words that the rest reads."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.rewording import reworded
from parley.language.offline.words.text import Phrase, keys, tokens

KNOWN = {"left door", "right door", "box", "boxes", "window", "gate", "doors", "red box"}


def _known(words: Phrase) -> bool:
    return " ".join(key for key in keys(words) if key not in {"the", "a"}) in KNOWN


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("go to whichever door is closer", "go to the nearest door"),
        ("go to whatever is closest to the gate", "go to the thing closest to the gate"),
        ("take the box that is farther away", "take the farthest box"),
        ("inspect whatever is next to the gate", "inspect the thing next to the gate"),
        ("pick any box and go there", "go to any box"),
        ("choose one of the boxes and inspect it", "inspect one of the boxes"),
        ("the box first, the gate second", "visit the box, then visit the gate"),
        ("check the gate second, the box first", "check the box, then check the gate"),
        ("go to the box and the gate, gate first", "go to the gate, then go to the box"),
        ("visit the box, the gate and the window, ending at the box",
         "visit the gate, then visit the window, then visit the box"),
        ("go to the box, starting with the gate", "go to the gate, then go to the box"),
        ("wait at the gate until it opens", "wait at the gate, then wait until it opens"),
        ("wait for ten seconds at the gate", "wait at the gate, then wait for ten seconds"),
        ("stay at the gate for a minute", "stay at the gate, then wait for 1 minute"),
        ("go to the left door or, if it is shut, the right door",
         "go to the left door. if it is shut, the right door"),
        ("go to the left door, or the right door if it is shut",
         "go to the left door. if it is shut, the right door"),
        ("go there, and if it does not work the right door",
         "go there, and if it does not work, the right door"),
        ("leave the box out", "leave out the box"),
        ("tell me which box is open", "check whether all boxes are open"),
        ("please you go to the gate, you look at the box", "please go to the gate, look at the box"),
        ("I want you go to the gate", "I want you to go to the gate"),
        ("use the left door", "go to the left door"),
        ("Anyone there?", "check whether anyone is there?"),
        ("Window shut?", "check whether the window is shut?"),
        ("window check", "inspect window"),
    ],
)  # fmt: skip
def test_a_wording_becomes_plain(said: str, read: str) -> None:
    assert keys(reworded(tokens(said), _known)) == keys(tokens(read))


@pytest.mark.parametrize(
    "said",
    [
        "go to the box and the gate",
        "go to the gate",
        "is the window shut?",
        "what you can do first is check the box",
        "wait for ten seconds",
        "take the red box to the gate or the window",
        "tell me what is in the box",
    ],
)
def test_what_is_plain_is_left_alone(said: str) -> None:
    assert reworded(tokens(said), _known) == tokens(said)
