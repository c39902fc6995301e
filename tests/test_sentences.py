"""What robots say of their own accord: one catalogue, every sentence in every language."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from string import Formatter

import pytest
import yaml

import parley
from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.sentences import in_language, listed, sentence, together
from parley.web.showing import shown_in
from tests.demos.house import running

SOURCE = Path(parley.__file__).parent
ESTONIAN: dict[str, str] = {
    pair["en"]: pair["et"]
    for pair in yaml.safe_load((SOURCE / "sentences" / "et.yaml").read_text(encoding="utf-8"))
}
WITHOUT = {
    "recollections.py", "memory.py", "incident_log.py",  # in English only, see docs/language.md
}  # fmt: skip
FOR_PROGRAMS = {
    "The step before gave no result that I could go on with.",  # the report of a failure
    "It failed without saying why.",
    "Another step failed in the meantime.",  # a note in a record
}


def names(template: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(template) if name}


def said() -> Iterator[tuple[str, str]]:
    """Every whole sentence that stands in a node, and where: a text of its own or a template."""
    for file in sorted((SOURCE / "agents").rglob("*.py")):
        if file.name in WITHOUT:
            continue
        tree = ast.parse(file.read_text(encoding="utf-8"))
        passed_over = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if isinstance(node, ast.JoinedStr):
                passed_over |= {id(part) for part in node.values}
        for node in ast.walk(tree):
            text = node.value if isinstance(node, ast.Constant) and id(node) not in passed_over else None
            if isinstance(text, str) and re.fullmatch(r"[A-Z“{].* .*[.?!”]", text.strip(), re.DOTALL):
                yield file.name, text


def test_every_sentence_of_the_nodes_is_there_in_estonian() -> None:
    missing = [(file, text) for file, text in said() if text not in ESTONIAN and text not in FOR_PROGRAMS]
    assert missing == []


def test_no_sentence_is_put_together_where_nobody_can_translate_it() -> None:
    found: list[tuple[str, int]] = []
    for file in sorted((SOURCE / "agents").rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.JoinedStr) or file.name in WITHOUT:
                continue
            text = "".join(
                part.value if isinstance(part, ast.Constant) and isinstance(part.value, str) else "…"
                for part in node.values
            )
            if re.search(r"[a-z] [a-z].*[.?!]$", text.strip()):
                found.append((file.name, node.lineno))
    allowed = {"reports.py", "advice.py"}  # the reports of failures, which language engines read
    assert [place for place in found if place[0] not in allowed] == []


def test_both_fill_in_the_same() -> None:
    pairs = ESTONIAN.items()
    assert [english for english, other in pairs if names(english) != names(other) or not other.strip()] == []


def test_a_sentence_is_english_text_and_can_be_said_otherwise() -> None:
    text = sentence("{robot} does not answer. The plan is kept; say “carry on” to try again.", robot="Ada")
    assert text == "Ada does not answer. The plan is kept; say “carry on” to try again."
    assert in_language(text, "et").startswith("Ada ei vasta.")
    assert in_language(text, "en") == text


def test_parts_are_said_one_by_one_and_foreign_words_stay() -> None:
    text = together("I would sing.", "", sentence("Shall I?"))
    assert text == "I would sing. Shall I?"
    assert in_language(text, "et") == "I would sing. Kas teen nii?"
    quoted = sentence("I have finished: {what}.", what=listed(["One step is left.", "{b}"]))
    assert in_language(quoted, "et") == "Tehtud: Alles on üks samm., {b}."


@pytest.mark.parametrize(
    ("english", "estonian"),
    [
        ("All right. I will go to the box.", "Hea küll. Teen nii: mine kohta box."),
        (
            "I will go to the box and then wait for 5 seconds.",
            "Teen nii: mine kohta box ja siis oota 5 sekundit.",
        ),
        ("Which one do you mean: the box or the gate?", "Millist sa mõtled: box või gate?"),
        (
            "I was to follow Ada, and that did not work: I do not see Ada, so I cannot follow. I go on.",
            "Pidin tegema nii: järgne: Ada, ja see ei õnnestunud: Ma ei näe: Ada, nii et ma ei saa järgneda. "
            "Jätkan.",
        ),
        (
            "I am still thinking about “sing”. If I should leave it, say “never mind”.",
            "Mõtlen veel selle üle: „sing“. Kui peaksin selle jätma, ütle „jäta see“.",
        ),
        ("never mind", "jäta see"),
        ("I can see a red box and an oak gate.", "Näen red box ja oak gate."),
        ("Several places fit “it”: red box and gate.", "Mitu kohta sobib, „it“: red box ja gate."),
        (
            "I know that because you told me yesterday at 9:05.",
            "Tean seda, sest sa ütlesid mulle seda eile kell 9:05.",
        ),
        ("I will remember that I will go to the box.", "Jätan meelde: I will go to the box."),
        ("You told me: “I go on. Shall I?”.", "Sa ütlesid mulle: „I go on. Shall I?“."),
        ("You asked me: “Which one?”", "You asked me: „Which one?“"),
        ("Stays out of “den”: Ada.", "Alale „den“ ei sõida: Ada."),
        (
            "Not faster than 0.1 m/s in “den” between 22:00 and 06:00: every robot.",
            "Alal „den“ mitte kiiremini kui 0.1 m/s kell 22:00 kuni 06:00: kõik robotid.",
        ),
        ("Nobody knows this sentence. I go on.", "Nobody knows this sentence. Jätkan."),
    ],
)
def test_plain_text_is_found_by_its_form_and_what_people_said_stays(english: str, estonian: str) -> None:
    assert in_language(english, "et") == estonian


async def test_a_robot_speaks_the_language_that_is_set() -> None:
    config = SystemConfig(speed=None, speaks="et")
    async with running(load_demo("nursing-home").system(config)) as home:
        assert (await home.say("jätka")).message == "Pole midagi, millega jätkata."
        await home.say("go to the dining table")
        await home.observer.until(
            lambda: any(said.message.startswith("Tehtud:") for said in home.observer.said)
        )
        assert (await home.say("peatu")).message == "Seisan paigal."


@pytest.mark.parametrize(
    ("said", "shown"),
    [
        (
            sentence("This is what I would do: {steps}.", steps="Ask you: “Is it done.”"),
            "Ask you: “Is it done”.",
        ),
        (sentence("This is what I would do: {steps}.", steps="go."), "I would do: go."),
        (sentence("This is what I would do: {steps}.", steps="Say: “Is it?”"), "Say: “Is it?”."),
    ],
)
def test_a_sentence_ends_once_whatever_is_filled_in_before_its_end(said: str, shown: str) -> None:
    assert said.endswith(shown)
    for text in (said, str(said)):
        assert not re.search(r"(?<!\.)\.[”“]?\.(?!\.)", in_language(text, "et"))


@pytest.mark.parametrize("step", ["Look with the camera: “Area A”", "Go to “Area A”", "Wait for 3 s"])
def test_each_step_of_a_numbered_list_is_said_in_the_language(step: str) -> None:
    told = in_language(f"This is what I would do: 1. {step}, 2. {step}, 3. {step}. Shall I?", "et")
    said = in_language(step, "et")
    assert said != step
    assert told == f"Ma teeksin nii: 1. {said}, 2. {said}, 3. {said}. Kas teen nii?"


def test_a_step_that_is_named_in_a_sentence_or_a_record_is_named_in_its_language() -> None:
    template = "I was interrupted while I was at “{step}”. Please give the order again if it still holds."
    text = sentence(template, step="go to the bed")
    for told in (text, str(text)):
        assert "„mine kohta bed“" in in_language(told, "et")
    failed = {
        "step": {"Inspect": {"input_parameters": {"it": {"pvf_value": "box"}}, "reason": "look for the box"}}
    }
    assert shown_in("et", failed)["step"]["Inspect"] == {**failed["step"]["Inspect"], "reason": "otsi box"}


def test_how_an_order_is_shared_is_told_in_one_language() -> None:
    told = (
        "This is how we do it. Ada: 1. Go to “A”, 2. Look with the camera: “A” (Ada is nearest to “A”). "
        "Ben: 1. Go to “B” (that way all of it is done soonest)."
    )
    assert in_language(told, "et") == (
        "Me teeme nii. Ada: 1. Mine kohta „A“, 2. Vaata kaameraga: „A“ (kohale „A“ on kõige lähemal Ada). "
        "Ben: 1. Mine kohta „B“ (nii on kõik kõige varem tehtud)."
    )


def test_the_label_of_a_step_that_asks_holds_the_question_in_the_same_language() -> None:
    asked = "I cannot pick things up. Please put the red box on me and tell me when it is done."
    assert in_language(f"Ask you: “{asked}”", "et") == f"Küsi sinult: „{in_language(asked, 'et')}“"
    assert in_language("Ask you: “How is it?”", "et") == "Küsi sinult: „How is it?“"


def test_what_is_quoted_in_a_part_of_a_sentence_may_be_several_sentences() -> None:
    asks = "Ask you: “I cannot pick things up. Please put the box on me and tell me when it is done.”"
    told = in_language(str(sentence("I have finished. I left out: {what}.", what=asks)), "et")
    assert told.startswith("Valmis. Jätsin vahele: Küsi sinult: „Ma ei saa asju üles võtta. ")
