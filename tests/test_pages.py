"""The pages for users are followed word by word: files are saved as they say, commands run in their order.

What would serve until Ctrl-C is talked to in the terminal instead, with nothing to say, which ends it.
"""

from __future__ import annotations

import re
import shlex
import tomllib
from pathlib import Path
from typing import Any

import pytest
import structlog
import typer
from typer.core import TyperGroup
from typer.testing import CliRunner

import parley.api
from parley.cli import command as loaded
from parley.cli import command_line

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = (
    "install",
    "first-hour",
    "own-world",
    "own-action",
    "own-robot",
    "own-model",
    "own-words",
    "operations",
)
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
SAVED = re.compile(r"[Ss]ave [^`]{1,60}`([^`]+)`[^`]*?:\n\n```\w+\n(.*?)```", re.DOTALL)


def page(name: str) -> str:
    return (DOCS / f"{name}.md").read_text(encoding="utf-8")


def commands(text: str) -> list[str]:
    """The commands that stand on a page by themselves, without what is said behind them."""
    outside = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return [re.split(r" {2,}", line)[0] for line in re.findall(r"^    (parley .*)$", outside, re.MULTILINE)]


@pytest.mark.parametrize("name", PAGES)
def test_a_page_can_be_followed_word_by_word(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "home"))
    monkeypatch.setenv("OPENAI_API_KEY", "none")
    text = page(name)
    for file, content in SAVED.findall(text):
        (tmp_path / file).parent.mkdir(exist_ok=True)
        (tmp_path / file).write_text(content, encoding="utf-8")
    assert commands(text)
    for command in commands(text):
        words = shlex.split(command)[1:]
        if words[0] == "demo" and not {"--script", "--terminal"} & set(words):
            words.append("--terminal")
        done = CliRunner().invoke(command_line(), words, input="")
        refused = words[0] == "doctor" and done.exit_code == 1  # what a test's machine lacks
        assert done.exit_code == 0 or refused, f"{command}: {done.output} {done.exception!r}"
    structlog.reset_defaults()


def test_what_pip_is_told_exists() -> None:
    told = re.findall(r"(?:parley-hri|\.)\[([a-z,]+)\]", "".join(map(page, PAGES)) + page("own-program"))
    assert {extra for extras in told for extra in extras.split(",")} <= EXTRAS.keys()
    assert {"sim", "web"} <= EXTRAS.keys()


def test_the_code_of_the_pages_is_that_of_the_examples() -> None:
    for name in ("own_robot.py", "script.py"):
        assert (ROOT / "examples" / name).read_text(encoding="utf-8") in page("own-robot")
    assert (ROOT / "examples" / "nav2_robot.py").read_text(encoding="utf-8") in page("ros-robot")


def test_the_page_for_programs_names_what_the_door_has() -> None:
    text = page("own-program")
    imported = re.findall(r"from parley\.api import (.*)", text)
    names = {name.strip() for line in imported for name in line.split(",")}
    methods = set(re.findall(r"parley\.([a-z]+)\(", text)) - {"api"}
    assert names <= set(parley.api.__all__)
    assert methods <= set(dir(parley.api.Parley))
    for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        compile(code, "own-program", "exec", flags=0x2000)  # await stands at the top


def test_the_reference_leads_to_every_page() -> None:
    linked = set(re.findall(r"\]\(([a-z-]+)\.md", page("reference") + page("first-hour") + page("install")))
    assert {path.stem for path in DOCS.glob("*.md")} - linked - {"install", "reference"} == set()


SHOWN = [
    (path.name, words)
    for path in (
        *DOCS.glob("*.md"),
        ROOT / "README.md",
        ROOT / "SECURITY.md",
        ROOT / "examples" / "README.md",
    )
    for words in re.findall(
        r"(?:^    |`)(?:\.venv/bin/)?parley ((?!-)[a-z][^`\n]*)", path.read_text("utf-8"), re.MULTILINE
    )
]


def test_every_command_that_any_page_shows_exists_with_its_options() -> None:
    names = typer.main.get_group(command_line()).commands
    whole = TyperGroup(commands={name: loaded(name) for name in names})
    wrong = []
    for where, shown in SHOWN:
        command: Any = whole
        words = re.split(r" {2,}| #", shown)[0].split()
        while isinstance(command, TyperGroup) and words and words[0] in command.commands:
            command = command.commands[words.pop(0)]
        known = {name for option in command.params for name in (*option.opts, *option.secondary_opts)}
        asked = {word.split("=")[0] for word in words if word.startswith("--")} - {"--help"}
        if command is whole or not asked <= known:
            wrong.append(f"{where}: parley {shown}")
    assert wrong == []
