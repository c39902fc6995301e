"""Dialogues in the words in which they really happened, as a page: stories played, and written down."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict

from parley.config import SystemConfig
from parley.demos.catalogue import Demo
from parley.demos.runner import StoryResult, play
from parley.demos.story import Story
from parley.files import parse_yaml, read_text, validated

__all__ = ["Dialogues", "Transcript", "page", "played"]

_TIME = re.compile(r"\b\d\d:\d\d\b")
"""Times of day, which differ from run to run."""


class Dialogues(BaseModel):
    """A file of stories that belong together."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    title: str
    introduction: str
    dialogues: dict[str, Story]

    @classmethod
    def load(cls, path: Path) -> Dialogues:
        """Read a file of dialogues.

        Raises:
            FileFormatError: Names the file and the field.
        """
        return validated(cls, parse_yaml(read_text(path), path.name), path.name)


@dataclass(slots=True)
class Transcript:
    """What was said; order within one stage (until the operator speaks again) is by robot."""

    story: Story
    lines: list[str] = field(default_factory=list)
    endings: dict[str, str] = field(default_factory=dict)
    """Each robot with the code of its newest failure and how that ended."""
    _stage: list[tuple[str, str]] = field(default_factory=list)

    def take(self, event: Mapping[str, Any]) -> None:
        """Take over one event of a run."""
        match event["event"]:
            case "operator":
                self.close()
                several = f" (to {event['robot']})" if self.story.robots and event["robot"] else ""
                self.lines.append(f"**You**{several}: {event['text']}")
            case "said":
                choices = f" [{' | '.join(event['choices'])}]" if event.get("choices") else ""
                self._stage.append((event["robot"], f"**{event['robot']}**: {event['text']}{choices}"))
            case "change":
                self.close()
                self.lines.append(f"*{event['text']}*")
            case "incident":
                self.endings[event["robot"]] = f"{event['code']}: {event['ending']}"

    def close(self) -> None:
        """End a stage."""
        self.lines += [line for _, line in sorted(self._stage, key=lambda said: said[0])]
        self._stage.clear()

    def markdown(self) -> str:
        """The section of a page."""
        self.close()
        ends = ", ".join(self.endings[robot] for robot in sorted(self.endings))
        spoken = "\n".join(f"> {_TIME.sub('hh:mm', line)}  " for line in self.lines)
        return f"## {self.story.title}\n\n{spoken}\n\nRecorded as: {ends or 'nothing'}.\n"


async def played(demo: Demo, story: Story) -> tuple[StoryResult, Transcript]:
    """Play one dialogue as fast as the machine can."""
    transcript = Transcript(story)
    config = SystemConfig(speed=None)
    result = await play(story, lambda variant: demo.system_for(story, config, variant), emit=transcript.take)
    return result, transcript


def page(dialogues: Dialogues, transcripts: Sequence[Transcript]) -> str:
    """The whole page."""
    head = f"# {dialogues.title}\n\n{dialogues.introduction.strip()}\n"
    return "\n".join([head, *(transcript.markdown() for transcript in transcripts)])
