"""`parley language`: words and sentences of one's own trade."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from pydantic import BaseModel, ConfigDict, Field, model_validator

from parley.agents.planner.check import plan_problems
from parley.cli.actions import FolderOption, catalogue_with
from parley.cli.memory import DataOption, JsonOption
from parley.cli.on_loop import on_loop
from parley.cli.output import emit_json, fail, quiet_logs
from parley.clock import WallClock
from parley.config import ModelSettings
from parley.demos.catalogue import DEMOS, demo_folder
from parley.errors import ConfigError, FileFormatError
from parley.files import read_text, validated_yaml
from parley.language.base import Language, Situation
from parley.language.dialogue.teaching import Learned, Taught, entry_of, key, taught_in, weighed
from parley.language.llm import build_language
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry, taught_name
from parley.messages.status import ActionInfo
from parley.site import Site
from parley.world.object_map import MapObject

__all__ = ["app"]

app = typer.Typer(no_args_is_help=True)


class Lesson(BaseModel):
    """One entry of a file."""

    model_config = ConfigDict(extra="forbid", strict=True)
    say: str = Field(min_length=1)
    means: str = ""
    action: str = ""
    arguments: dict[str, str | int | float | bool] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _one_meaning(self) -> Lesson:
        if bool(self.means) == bool(self.action):
            raise ValueError("say what it means by either means or action")
        if self.arguments and not self.action:
            raise ValueError("arguments go with an action")
        return self

    @property
    def taught(self) -> Taught:
        """What is to be learned."""
        return Taught(key(self.say), self.means, self.action, self.arguments)


class LessonFile(BaseModel):
    """Such a file."""

    model_config = ConfigDict(extra="forbid", strict=True)
    teach: list[Lesson] = Field(min_length=1)


@app.command()
def teach(
    file: Annotated[Path | None, typer.Argument(help="Sentences and what they mean (YAML).")] = None,
    data: DataOption = None,
    world: Annotated[
        str, typer.Option(help="Demonstration, or folder with your world: names on its map may be used.")
    ] = "",
    actions: FolderOption = None,
    show: Annotated[bool, typer.Option("--list", help="List what was taught.")] = False,
    forget: Annotated[str, typer.Option(help="Forget what these words mean.")] = "",
    check_only: Annotated[bool, typer.Option("--check", help="Check the file and keep nothing.")] = False,
    json: JsonOption = False,
) -> None:
    """Teach words of your own. All of a file is kept, or nothing; a system that runs uses it at once."""
    if sum((file is not None, show, bool(forget))) != 1:
        raise ConfigError("give a file with what to teach, or --list, or --forget WORDS")
    quiet_logs()
    if data is None:
        raise ConfigError("say where it is kept: --data FOLDER, the data folder of the system")
    path = data / "memory.db"
    if show or forget:
        if not path.parent.is_dir():
            raise ConfigError(f"there is no data folder {path.parent}")
        on_loop(_listed(path, json) if show else _forgotten(path, forget))
        return
    catalogue, problems = catalogue_with(actions)
    if problems:
        raise ConfigError(problems[0])
    lessons = validated_yaml(LessonFile, read_text(file or Path()), (file or Path()).name).teach
    folder = demo_folder(world) if world in DEMOS else Path(world)
    objects = Site.load(folder).objects.objects if world else ()
    on_loop(_taught(path, file or Path(), lessons, objects, catalogue.infos(), check_only))


async def _taught(
    path: Path, file: Path, lessons: Sequence[Lesson], objects: Sequence[MapObject],
    catalogue: Sequence[ActionInfo], check_only: bool,
) -> None:  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    async with contextlib.AsyncExitStack() as stack:
        store = await stack.enter_async_context(await MemoryStore.open(path, WallClock()))
        engine = build_language(["builtin"], ModelSettings(), check=plan_problems)
        if isinstance(engine, contextlib.AbstractAsyncContextManager):
            await stack.enter_async_context(engine)
        known = await store.taught()
        situation = Situation(
            "", memory=tuple(known), objects=tuple(objects), catalogue=tuple(catalogue), robot="robot"
        )
        entries = await _weighed(file, lessons, situation, engine)
        if not check_only:
            await store.merge(entries)
    done = "can be taught" if check_only else "are taught"
    typer.echo(f"{len(entries)} of {len(lessons)} {done}")


async def _weighed(
    file: Path, lessons: Sequence[Lesson], situation: Situation, engine: Language
) -> list[MemoryEntry]:
    """What is to be kept; each is tried with all the others.

    Raises:
        FileFormatError: Names the entry that cannot be taught.
    """
    others = [one.words for one in taught_in(situation.memory)]
    entries: dict[str, MemoryEntry] = {}
    for number, lesson in enumerate(lessons):
        where, taught = f"teach[{number}]", lesson.taught
        if taught.words in entries:
            raise FileFormatError(file.name, where, f"“{lesson.say}” stands there twice: leave one out")
        known = replace(situation, memory=(*situation.memory, *entries.values()))
        alike = [words for words in (*others, *entries) if words != taught.words]
        found = await weighed(taught, known, engine, alike=alike)
        if not isinstance(found, Learned):
            raise FileFormatError(file.name, where, str(found))
        if found.steps and (problems := plan_problems(found.steps, situation.catalogue)):
            raise FileFormatError(file.name, where, f"“{lesson.say}”: {problems[0]}")
        entries[taught.words] = entry_of(found.taught, source="operator", words=lesson.say)
    return list(entries.values())


async def _listed(path: Path, as_json: bool) -> None:
    async with await MemoryStore.open(path, WallClock()) as store:
        found = taught_in(await store.taught())
    for one in found:
        if as_json:
            emit_json(
                {"say": one.words, "means": one.means, "action": one.action, "arguments": {**one.arguments}}
            )
        else:
            typer.echo(f"“{one.words}” means: {one.meaning}")


async def _forgotten(path: Path, words: str) -> None:
    async with await MemoryStore.open(path, WallClock()) as store:
        gone = await store.remove(taught_name(key(words)), None)
    if not gone:
        raise typer.Exit(fail(f"nobody taught what “{words}” means", code=1))
