"""Changes of what is pending, read by patterns: what is left of the plan, and in which order."""

from __future__ import annotations

import pytest

from parley.evaluation.steps import pending, read_steps
from parley.language.offline import OfflineLanguage, interpreter, reader
from parley.language.offline.plan_changes import rereading
from parley.language.offline.plan_changes.once_more import changed_again
from parley.language.offline.plan_changes.patterns import matches, parsed
from parley.language.offline.plan_changes.rearranging import rearranged
from parley.language.offline.plan_changes.replanning import Change
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import Phrase, plain, tokens
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from tests.language.dev_set import situation


def visit(place: str) -> tuple[ActionCall, ...]:
    target = {"target": Parameter("string", place)}
    return (ActionCall(name="GetCoordinates", input_parameters=target), ActionCall(name="NavigateTo"))


QUEUE = (*visit("area A"), *visit("area B"), *visit("area C"))


async def places(message: str, status: str = "running") -> str:
    asked = situation("warehouse", message, queue=QUEUE, status=status)
    action = await OfflineLanguage().interpret(asked)
    left = read_steps(pending(asked.queue, action), asked.catalogue)
    return " ".join(step.arguments[0].removeprefix("area ") for step in left if step.arguments)


@pytest.mark.parametrize(
    ("message", "left"),
    [
        ("the last two can go", "A"),
        ("take area B off your list", "A C"),
        ("and the loading area as well, at the end", "A B C loading area"),
        ("something more urgent: go to the loading area before you do the rest", "loading area A B C"),
        ("the next one isn't necessary", "A C"),
        ("keep only area B and forget the others", "B"),
        ("drop everything except area C", "C"),
        ("only do area C", "C"),
        ("just finish area A, nothing else", "A"),
        ("stop after area B", "A B"),
        ("skip ahead to area C", "C"),
        ("swap the last two", "A C B"),
        ("areas B and C the other way round", "A C B"),
        ("area C is more urgent than area B", "A C B"),
        ("hold area A back till the end", "B C A"),
        ("area B can wait", "A C B"),
        ("bring area C forward", "A C B"),
        ("repeat area A at the end", "A B C A"),
        ("go to the loading area between area A and area B", "A loading area B C"),
        ("replace the second stop with the loading area", "A loading area C"),
        ("cross out area B and add the loading area instead", "A loading area C"),
        ("area A can wait, forget area C", "B A"),
        ("before you return to area C, go by the loading area", "A B loading area C"),
        ("on the way back to area C stop at the loading area", "A B loading area C"),
        ("put area C at the front", "A C B"),
        ("make area C your next stop", "A C B"),
        ("leave area B for tomorrow", "A C"),
        ("postpone area A until the others are done", "B C A"),
        ("cut area B and go straight on to area C", "A C"),
        ("the last stop should be the loading area and not area C", "A B loading area"),
        ("add the loading area to your round", "A B C loading area"),
        ("first go to the loading area, though", "loading area A B C"),
        ("I would sooner you had area C done before area B", "A C B"),
    ],
)
async def test_a_change_leaves_what_was_asked_for(message: str, left: str) -> None:
    assert await places(message) == left


@pytest.mark.parametrize("message", ["what is next?", "go to the loading area", "area D first"])
async def test_what_is_no_change_leaves_the_plan_as_it_is(message: str) -> None:
    assert (await places(message)).startswith("A B C")


def test_a_pattern_covers_all_words_or_does_not_match() -> None:
    parts = parsed("drop|leave_out {a} ?please")
    assert [plain(found["a"]) for found in matches(parts, tokens("leave out the desk please"))][
        -1
    ] == "the desk"
    assert not list(matches(parts, tokens("please drop the desk")))


@pytest.mark.parametrize(
    ("message", "different"),
    [
        ("do it again but skip area B", "skip area B"),
        ("the other way round this time", "the other way round"),
        ("repeat that without area A", "without area A"),
        ("go to area B", ""),
    ],
)
def test_what_is_to_be_different_the_next_time_is_found(message: str, different: str) -> None:
    assert plain(changed_again(tokens(message))) == different


async def test_a_change_is_worked_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def counted(words: Phrase, scene: Scene) -> Change | None:
        asked.append(plain(words))
        return rearranged(words, scene)

    for module in (interpreter, rereading, reader):
        monkeypatch.setattr(module, "rearranged", counted)
    assert await places("swap area B and area C") == "A C B"
    assert asked == ["swap area B and area C"]
