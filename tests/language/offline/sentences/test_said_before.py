"""What "it" and "there" are where the sentence before tells it."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.said_before import named_before
from parley.language.offline.words.text import plain, tokens


@pytest.mark.parametrize(("said", "meant"), [
    ("I can not see the pump from here, does it leak?", "does the pump leak?"),
    ("We cannot see pier 2, is the ferry there?", "is the ferry at pier 2?"),
    ("I can not see the yard from here, is there a van?", "is there a van at the yard?"),
    ("I was in the barn and I think I left the lamp on. Check that.",
     "I think I left the lamp on in the barn. Check that."),
    ("I was in the barn earlier and I may have left my hat there. Check.",
     "I may have left my hat in the barn. Check."),
    ("do not take the rope on deck, only look for it",
     "do not take the rope on deck, only look for the rope on deck"),
    ("A sailor forgot his cap in the hall. Go there and get it. Bring it to Ann.",
     "A sailor forgot his cap in the hall. Go there and get the cap. Bring it to Ann."),
])  # fmt: skip
def test_it_is_what_was_named_before(said: str, meant: str) -> None:
    assert plain(named_before(tokens(said))) == plain(tokens(meant))


@pytest.mark.parametrize("said", [
    "I can not see it from here, is it open?",
    "I can see the pump from here, does it leak?",
    "I was in the barn and I saw a mouse",
    "do not touch it, only look at it",
    "A sailor forgot his cap. Go to the hall and get it.",
])  # fmt: skip
def test_what_names_nothing_stays(said: str) -> None:
    assert plain(named_before(tokens(said))) == plain(tokens(said))
