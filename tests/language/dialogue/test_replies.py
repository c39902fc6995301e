"""Only what fits a question closes it."""

from __future__ import annotations

import pytest

from parley.language.builtin.engine import BuiltinLanguage

ENGINE = BuiltinLanguage()
PUT = "Please put the box on me and tell me when it is done."


@pytest.mark.parametrize(
    ("reply", "kind"),
    [
        ("done", "yes"), ("finished", "yes"), ("done?", "aside"),
        ("there you go", "yes"), ("ok, loaded", "yes"), ("I have put it on you", "yes"), ("all done", "yes"),
        ("it's on your tray", "yes"), ("you can go on", "yes"), ("here it is", "yes"),
        ("I have not put it on you", "no"), ("I can't find it", "no"),
        ("one moment, my hands are full", "aside"), ("hm let me think", "aside"), ("which box?", "aside"),
        ("go to the gate first", "aside"), ("Kim is in the office by the way", "aside"),
        ("somebody fell!", "aside"), ("purple umbrellas", "unclear"),
        ("the box is on your tray", "yes"), ("Kim put it on you", "yes"), ("right, it's in", "yes"),
        ("secured", "yes"), ("already done", "yes"),
        ("thats done", "yes"), ("its on there", "yes"), ("here you go it is on your tray", "yes"),
        ("you have it now", "yes"), ("box loaded", "yes"), ("I strapped it on", "yes"),
        ("there is none left", "no"), ("it's gone", "no"), ("somebody took it", "no"),
        ("it is too heavy", "no"),
        ("we are out of boxes", "no"), ("no box here", "no"), ("are you ready?", "aside"), ("later", "aside"),
        ("not yet", "aside"), ("it's not on yet", "aside"), ("I will put it on you in a minute", "aside"),
        ("are you ready", "aside"), ("the box is in the yard", "aside"), ("put it where?", "aside"),
        ("put the lamp on", "aside"),
    ],
)  # fmt: skip
async def test_a_request_is_closed_by_a_yes_or_a_no_alone(reply: str, kind: str) -> None:
    assert (await ENGINE.read_reply(PUT, reply)).kind == kind


@pytest.mark.parametrize(
    ("reply", "choice"),
    [("the big one", "big box"), ("not the big one", "small box"), ("the second", "small box"),
     ("the box", ""),     ("neither", ""), ("a green one", "")],
)  # fmt: skip
async def test_a_choice_is_what_words_tell_from_the_others(reply: str, choice: str) -> None:
    assert (await ENGINE.read_reply("Which one?", reply, ("big box", "small box"))).choice == choice


async def test_an_open_question_takes_an_answer() -> None:
    assert (await ENGINE.read_reply("What shall I say to Kim?", "lunch on the terrace")).kind == "answer"
