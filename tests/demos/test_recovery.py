"""Dialogues about things that go wrong, as they happen in the simulated home; the page shows them."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

import pytest

from parley.demos.catalogue import Demo, load_demo
from parley.demos.story import Story
from parley.demos.transcripts import Dialogues, Transcript, page, played

PAGE = Path(__file__).parents[2] / "docs" / "recovery-transcripts.md"
DIALOGUES = Dialogues.load(Path(str(resources.files("parley.demos") / "nursing_home" / "recovery.yaml")))


@pytest.fixture(scope="module")
def demo() -> Demo:
    return load_demo("nursing-home")


@pytest.mark.parametrize("name", DIALOGUES.dialogues)
async def test_dialogue_goes_as_written_and_as_the_page_shows(demo: Demo, name: str) -> None:
    result, transcript = await played(demo, DIALOGUES.dialogues[name])
    assert (result.reason, result.text) == ("", "The story held.")
    assert transcript.markdown() in PAGE.read_text(encoding="utf-8")


def test_page_has_the_dialogues_of_the_file_and_no_others() -> None:
    text = PAGE.read_text(encoding="utf-8")
    titles = [line.removeprefix("## ") for line in text.splitlines() if line.startswith("## ")]
    assert titles == [story.title for story in DIALOGUES.dialogues.values()]
    assert text.startswith(page(DIALOGUES, []))


def test_transcript_puts_what_several_robots_say_at_once_in_one_order() -> None:
    story = Story.model_validate({"robot": "A", "robots": {"B": [0, 0, 0]}, "steps": [{"restart": True}]})
    first, second = Transcript(story), Transcript(story)
    said = [{"event": "said", "robot": robot, "text": "Hello."} for robot in ("A", "B")]
    for transcript, events in ((first, said), (second, said[::-1])):
        for event in events:
            transcript.take(event)
    assert first.markdown() == second.markdown()
