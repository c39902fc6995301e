"""How answers are meant."""

from __future__ import annotations

import pytest

from parley.language.offline import OfflineLanguage

SOFAS = ("small sofa", "large sofa")


@pytest.mark.parametrize(
    ("reply", "kind"),
    [
        ("yes", "yes"),
        ("done", "yes"),
        ("It's done.", "yes"),
        ("I handed it over", "yes"),
        ("here you go", "yes"),
        ("I put it there", "yes"),
        ("ok go ahead", "yes"),
        ("carry on", "yes"),
        ("I have just put the cup on you", "yes"),
        ("The robot has completed the retrieval", "yes"),
        ("yep, you have it now", "yes"),
        ("dnoe", "yes"),
        ("no", "no"),
        ("I can't", "no"),
        ("not yet", "no"),
        ("nope, there is no cup here", "no"),
        ("I couldn't find it", "no"),
        ("stop", "control"),
        ("skip it", "control"),
        ("cancel everything", "control"),
        ("try again", "control"),
        ("banana", "unclear"),
        ("what?", "unclear"),
        ("", "unclear"),
        ("the sky is blue", "unclear"),
    ],
)
async def test_answers_without_choices(reply: str, kind: str) -> None:
    assert (await OfflineLanguage().read_reply("Is it done?", reply)).kind == kind


@pytest.mark.parametrize(
    ("reply", "choice"),
    [
        ("small sofa", "small sofa"),
        ("the small one", "small sofa"),
        ("the little one", "small sofa"),
        ("first", "small sofa"),
        ("the second one", "large sofa"),
        ("2", "large sofa"),
        ("b", "large sofa"),
        ("last", "large sofa"),
        ("smal", "small sofa"),
        ("I mean the big one, please", "large sofa"),
        ("not the large one", "small sofa"),
        ("number one", "small sofa"),
        ("the small sofa of course", "small sofa"),
        ("he is on the large one", "large sofa"),
    ],
)
async def test_one_of_the_choices(reply: str, choice: str) -> None:
    reading = await OfflineLanguage().read_reply("Which one?", reply, SOFAS)
    assert (reading.kind, reading.choice) == ("choice", choice)


@pytest.mark.parametrize("reply", ["the sofa", "the blue one", "bananas", "the third"])
async def test_what_names_no_choice_is_unclear(reply: str) -> None:
    assert (await OfflineLanguage().read_reply("Which one?", reply, SOFAS)).kind == "unclear"


async def test_a_choice_that_sounds_like_an_order_is_the_choice() -> None:
    reading = await OfflineLanguage().read_reply("What now?", "try again", ("try again", "stop"))
    assert (reading.kind, reading.choice) == ("choice", "try again")
