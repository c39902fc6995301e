"""Whatever reaches an operator from the chat of a demonstration has a form in every language."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import parley
from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.engine.runs import stop_latched
from parley.gate.audit_text import told as told_of
from parley.messages.audit import AuditEvent
from parley.sentences import LANGUAGES, in_language
from tests.demos.house import running

SOURCE = Path(parley.__file__).parent
ROOMS = (
    "language/builtin",
    "language/dialogue",
    "actions",
    "agents/chat/recollections.py",
    "web",
    "robots/navigator.py",
)
HOLE = "◯"
FILLINGS = ("Qqq", "7", " to Qqq", "", "Qqq.", "you told", "an", ", so I cannot go there")
SAYINGS = (
    "hello", "where are you", "what can you do?", "go to the gate", "go to a chair", "never mind",
    "wait 2 seconds", "turn left", "turn left by 90 degrees", "check whether the TV is on",
    "is the door closed?", "who sent you there?", "if the TV is on, go to the bed", "what is left to do",
    "pause", "what are you doing", "cancel everything", "what did you do", "bring me the ladder",
    "follow Ada", "remember that the gate is open", "forget the gate", "why", "what time is it",
    "go to the table and then come back", "what did you see", "say hello", "what do you know",
)  # fmt: skip
FACTS = ("the gate is open", "the TV is on", "the door is closed")
ENGLISH = re.compile(
    r"\b(?:the|and|is|are|of|I|you|not|with|for|my|your|do|can|cannot|which|what|where|shall)\b"
)
PARTS = re.compile(r"\b(?:know|where|what|which|shall|are)\b")
"""What stays where a sentence is taken for a shorter one that has a hole for anything."""
SAID_IN = re.compile(r"[A-Z“◯].* .*[.?!]", re.DOTALL)
WITHOUT = {
    "builtin/lexicon.py",  # mistakes in our own data
    "web/app.py",  # of the description for programs
}


def texts(file: Path) -> Iterator[str]:
    """Every whole sentence that stands in a file, with words that no language knows in its holes."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    passed_over = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            passed_over |= {id(part) for part in node.values}
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in (
            "compile",
            "warning",
            "info",
            "debug",
        ):
            passed_over |= {id(part) for part in ast.walk(node)}
        if isinstance(node, ast.Raise):
            called = ast.unparse(node)
            if not any(error in called for error in ("ActionFailure", "WebProblem", "PeopleError")):
                passed_over |= {id(part) for part in ast.walk(node)}
    for node in ast.walk(tree):
        if id(node) in passed_over:
            continue
        if isinstance(node, ast.JoinedStr):
            text = "".join(
                str(part.value) if isinstance(part, ast.Constant) else HOLE for part in node.values
            )
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            text = re.sub(r"\{\w+\}", HOLE, node.value)
        else:
            continue
        if SAID_IN.fullmatch(text.strip()):
            yield " ".join(text.split())


def all_texts() -> Iterator[tuple[str, str]]:
    """The same of every file of the rooms in which something is worded."""
    for room in ROOMS:
        place = SOURCE / room
        for file in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            if not any(part in str(file) for part in WITHOUT):
                for text in texts(file):
                    yield file.name, text


def unknown(text: str, language: str) -> list[str]:
    """The sentences of a text that are said in English in another language."""
    said = in_language(text, language)
    return [one for one in re.split(r"(?<=[.?!])\s+", text) if one in said and re.search(r"[a-z] [a-z]", one)]


def is_known(text: str, language: str) -> bool:
    """Whether a text has a form, with something or other in its holes."""
    fillings = (re.sub(rf"(?:{HOLE})+", filling, text) for filling in FILLINGS)
    plain = [" ".join(filled.split()) for filled in fillings]
    return any(not unknown(one, language) and not PARTS.search(in_language(one, language)) for one in plain)


def test_every_sentence_of_the_built_in_engine_has_a_form_in_every_language() -> None:
    others = [language for language in LANGUAGES if language != "en"]
    assert others
    found = [(file, text) for file, text in all_texts() for other in others if not is_known(text, other)]
    assert found == []


def test_what_is_noted_of_settings_has_a_form_in_every_language() -> None:
    noted = [
        "".join(str(part.value) if isinstance(part, ast.Constant) else "Qqq" for part in parts)
        for file in (SOURCE / "web" / "routes").glob("*.py")
        for call in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call) and getattr(call.func, "attr", "") == "note"
        for parts in [getattr(call.args[1], "values", [call.args[1]])]
    ]
    others = [language for language in LANGUAGES if language != "en"]
    told = [told_of(AuditEvent(effect="setting", words=words)) for words in noted]
    assert told
    assert [
        (text, other) for text in told for other in others if ENGLISH.search(in_language(text, other))
    ] == []
    assert [(words, other) for words in noted for other in others if in_language(words, other) == words] == []


def test_what_is_refused_while_a_stop_is_in_force_stands_in_the_log_in_every_language() -> None:
    (problem,) = stop_latched("one", "Qqq").problems
    told = told_of(AuditEvent(effect="begin", outcome="refused", robot="Qqq", reason=str(problem.message)))
    assert [one for one in LANGUAGES if one != "en" and ENGLISH.search(in_language(told, one))] == []
    assert in_language(told, "et") == "Keelduti (Qqq): Qqq on hädastopiga peatatud"


def test_what_actions_say_of_themselves_has_a_form_in_every_language() -> None:
    told = [text for one in BUILTIN_ACTIONS for text in (one.description, *one.help.values())]
    others = [language for language in LANGUAGES if language != "en"]
    assert [
        (text, other) for text in told for other in others if ENGLISH.search(in_language(text, other))
    ] == []
    assert [(text, other) for text in told for other in others if in_language(text, other) == text] == []


def words(text: str) -> list[str]:
    return re.findall(r"[a-z]+", text.lower())


@pytest.mark.parametrize("demo", ["nursing-home", "parking", "warehouse", "fleet"])
def test_what_a_demonstration_offers_to_say_is_shown_in_every_language(demo: str) -> None:
    loaded, others = load_demo(demo), [one for one in LANGUAGES if one != "en"]
    named = {
        name for one in loaded.objects.objects for name in (one.description, one.class_name, *one.aliases)
    }
    names = sorted(named | {area.name for area in loaded.objects.areas}, key=len, reverse=True)
    own = re.compile("|".join(map(re.escape, names)), re.IGNORECASE)
    left = [
        (text, shown)
        for text in loaded.story.examples
        for other in others
        if set(words(text)) & set(words(own.sub("", shown := in_language(text, other))))
    ]
    assert loaded.story.examples
    assert left == []


async def test_what_robots_say_in_a_demonstration_has_no_english_left_in_it_but_what_people_said() -> None:
    demo = load_demo("nursing-home")
    names = [item.description for item in demo.objects.objects]
    async with running(demo.system(SystemConfig(speed=None))) as home:
        for saying in SAYINGS:
            await home.say(saying)
        said = [feedback.message for feedback in home.observer.said]
        steps = [step.label for plan in home.observer.plans.values() for step in plan.steps]
    left: list[str] = []
    for text in {*said, *steps}:
        shown = in_language(text, "et")
        own = re.sub(r"„[^“]*“", "", shown)
        for known in sorted([*names, *FACTS], key=len, reverse=True):
            own = own.replace(known, "")
        if ENGLISH.search(own):
            left.append(f"{text} -> {shown}")
    assert len(said) >= len(SAYINGS)
    assert left == []
