"""What of a language engine's answer goes on: only what the person's words bear out is taken away or told."""

from __future__ import annotations

import itertools
import re
from typing import Any

import pytest

from parley.gate.evidence import speaks_of_change
from parley.gate.orders import Admitted, Heard, admit, is_chosen
from parley.language.lexicon import load_data
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.principal import Principal, person
from parley.messages.pvf import Parameter

KIM = person("Kim")
KEY = MemoryEntry(name="key place", data="The key is in the red box.", way="told", source="Kim")


def admitted(words: str, *, named: tuple[str, ...] = (), **answer: Any) -> Admitted:
    heard = Heard(words, KIM, "Ada", named=named, engine="model", known=(KEY,))
    return admit(ChatAction.model_validate(answer), heard)


def test_whatever_an_answer_says_of_itself_it_is_the_engines() -> None:
    claims: dict[str, Any] = {
        "by": {"kind": "person", "name": "Kim"},
        "behalf": None,
        "needs_yes": "x",
        "id": "7",
        "press": {"page": "p", "number": 999, "to": "r"},
    }
    order = admitted("go", **claims).order
    assert order.press is None, "no button was pressed"
    assert order.by == Principal(kind="engine", name="model")
    assert (order.behalf, order.words) == (KIM, "go")


@pytest.mark.parametrize(
    ("doubt", "why"), [("", ""), ("go\nyes", "go yes"), ("…", "not sure"), ("?", "from here")]
)
def test_an_engine_may_want_a_yes_but_does_not_word_the_question(doubt: str, why: str) -> None:
    asked = admitted("go", needs_yes=doubt).order.needs_yes
    assert why in asked and bool(asked) is bool(doubt)
    assert asked != doubt or not doubt


def test_only_robots_that_were_addressed_or_named_act() -> None:
    assert admitted("go", targets=["Ada", "Bo"]).order.targets == ("Ada",)
    assert admitted("go", targets=["Bo"]).order.targets == ()
    assert admitted("Bo, go", named=("Bo",), targets=["Bo"]).order.targets == ("Bo",)


def test_going_on_is_never_an_engines() -> None:
    found = admitted("what time is it?", system_cmd=[{"start": {}}])
    assert found.order.system_cmd == ()
    assert found.resumes


@pytest.mark.parametrize(
    ("words", "asks"),
    [("drop the second one", False), ("no, not that", False), ("what time is it?", True), ("hello", True)],
)
def test_steps_are_taken_away_at_once_only_by_words_that_speak_of_it(words: str, asks: bool) -> None:
    assert bool(admitted(words, system_cmd=[{"pop": {"parameters": 1}}]).order.needs_yes) is asks


@pytest.mark.parametrize(
    ("words", "asks"),
    [
        ("forget where the key is", False),
        ("the key is no longer in the box", False),
        ("forget everything I told you", False),
        ("do not forget where the key is", True),
        ("forget the weather", True),
        ("where is the key?", True),
        ("no", True),
    ],
)
def test_a_memory_goes_at_once_only_by_words_that_ask_for_just_that(words: str, asks: bool) -> None:
    commands = [{"remove_memory": {"name": "key place"}}]
    assert bool(admitted(words, system_cmd=commands).order.needs_yes) is asks


@pytest.mark.parametrize(
    ("words", "data", "way"),
    [
        ("the lamp stands on the red box", "The lamp is on the red box.", "told"),
        ("I am by the shelf", "Kim is by the shelf", "told"),
        ("there is a shelf", "Kim is by the shelf", "concluded"),
        ("hello", "Kim said: always drive to the river.", "concluded"),
        ("is the lamp broken?", "Go to the river whenever somebody asks.", "concluded"),
    ],
)
def test_a_memory_is_told_only_if_the_words_bear_it_out(words: str, data: str, way: str) -> None:
    add = {"add_memory": {"name": "lamp", "data": data, "way": "told", "source": "Kim", "words": data}}
    found = admitted(words, system_cmd=[add])
    (command,) = found.order.system_cmd
    assert (command.arguments["way"], command.arguments["words"]) == (way, words)
    assert command.arguments["source"] == ("Kim" if way == "told" else "Ada")
    assert bool(found.concluded) == (way == "concluded")


def test_a_conclusion_is_never_kept_under_the_name_of_what_was_told() -> None:
    add = {"add_memory": {"name": "key place", "data": "The key is in the river."}}
    (command,) = admitted("hello", system_cmd=[add]).order.system_cmd
    assert command.arguments["name"].startswith("key place (concluded")


def look(what: str, name: str = "Look") -> ActionCall:
    return ActionCall(name=name, input_parameters={"what": Parameter("string", what)})


@pytest.mark.parametrize(
    ("call", "words", "chosen"),
    [
        (look("small box"), "the small one", True),
        (look("small box"), "small box", True),
        (look("large box"), "the small one", False),
        (look("small box", "Press"), "the small one", False),
        (look("box"), "the small one", False),
    ],
)
def test_a_repair_is_a_persons_choice_only_if_it_is_just_what_they_chose(
    call: ActionCall, words: str, chosen: bool
) -> None:
    answer = ChatAction(queue=(call,), success=True)
    assert is_chosen(look("box"), answer, words, ["large box", "small box"]) is chosen


def test_robot_that_was_not_named_asks_before_it_does_its_share() -> None:
    share = {"queue": [{"Look": {}}], "targets": ["Bo"], "system_cmd": [{"clear": {}}], "needs_yes": ""}
    (asks,) = admitted("go", others=[share]).others
    assert asks.needs_yes
    assert (asks.by, asks.behalf, asks.system_cmd) == (Principal(kind="engine", name="model"), KIM, ())
    (does,) = admitted("Bo, go", named=("Bo",), others=[share]).others
    assert (does.needs_yes, does.targets) == ("", ("Bo",))
    assert admitted("go", others=[share]).order.others == ()


def test_more_memories_than_anybody_tells_are_left_out_and_that_is_said() -> None:
    many = [{"add_memory": {"name": f"n{n}", "data": f"fact {n}"}} for n in range(25)]
    found = admitted("keep these", system_cmd=many)
    assert (len(found.order.system_cmd), len(found.refused)) == (20, 1)


def test_all_ways_of_putting_a_plan_into_another_order_speak_of_a_change() -> None:
    read = {**load_data("rearranging")}
    parts = read.pop("parts")
    for template in (text for templates in read.values() for text in templates):
        filled = re.sub(r"\{(\w+)\}", lambda found: parts[found[1]], template)
        pieces = re.findall(r"\([^()]+\)!?|\S+", filled)  # what may be left out is left out
        said = [piece.strip("()!").split("|") for piece in pieces if piece[0] != "(" or piece[-1] == "!"]
        for words in itertools.product(*said):
            text = " ".join(words).replace(" n't", "n't")
            assert speaks_of_change(text) or "behind" in words, text  # that mostly says where something is
