"""A file of settings: read as it is written, paths from its folder, what is wrong said with its line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pydantic import BaseModel

from parley.config import SystemConfig
from parley.errors import FileFormatError

DOCS = Path(__file__).parent.parent / "docs"

WHOLE = """
language: local:any@http://localhost:9/v1
language_fallback: []
model:
  key_file: model.key
  max_usd_per_hour: 2.5
  prices: {"local:any": {input: 1, output: 2}}
embeddings: {url: "http://localhost:9/v1", model: some, key_file: /keys/other}
data_dir: data
memory: ~/known.db
approval: ask_when_risky
approval_of: {B: run_at_once}
display_feeds:
  camera: {quality: 40}
"""


def test_settings_are_read_and_paths_count_from_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    (tmp_path / "parley.yaml").write_text(WHOLE, encoding="utf-8")
    config = SystemConfig.load(tmp_path / "parley.yaml")
    assert config.language == "local:any@http://localhost:9/v1"
    assert (config.language_fallback, config.model.max_usd_per_hour) == ((), 2.5)
    assert config.model.prices["local:any"].output == 2
    assert config.model.key_file == tmp_path / "model.key"
    assert config.embeddings is not None and config.embeddings.key_file == Path("/keys/other")
    assert config.data_dir == tmp_path / "data"
    assert config.memory_file == tmp_path / "home" / "known.db"
    assert config.incidents_file == tmp_path / "data" / "incidents.db"
    assert config.approval_of == {"B": "run_at_once"}
    assert config.display_feeds["camera"].quality == 40


def test_empty_file_leaves_everything_as_usual() -> None:
    assert SystemConfig.parse("# nothing\n") == SystemConfig()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("speed: 1\nspede: 2\n", "settings, line 2: spede: there is no such setting"),
        ("speed: 1\nmodel:\n  timeout_s: 5\n  tries: 2\n", "line 4: model.tries: there is no such setting"),
        ("model:\n  timeout_s: -5\n", "line 2: model.timeout_s: Input should be greater than 0"),
        ("speed: 1\n\nembeddings:\n  model: x\n", "line 3: embeddings.url: Field required"),
        ("approval: perhaps\n", "line 1: approval: Input should be 'run_at_once'"),
        ("seed: 1\nspeed: 1\nseed: 2\n", "line 3: seed: is said twice"),
        ("model: {retries: 1,\n  retries: 2}\n", "line 2: retries: is said twice"),
        ("language_fallback:\n  - builtin\n  - 5\n", "line 3: language_fallback[1]: Input should be"),
        ("- speed\n", "line 1: Input should be a valid dictionary"),
        ("speed: [1\n", "not valid YAML"),
        (
            "language: nonsense\n",
            "line 1: language: there is no language engine 'nonsense'; use",
        ),
        (
            "speed: 1\nlanguage: offline\n",
            "line 2: language: the language engine 'offline' is gone; use",
        ),
        (
            "language_fallback: [old]\n",
            "[0]: the language engine 'old' is gone; use builtin",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_line(text: str, told: str) -> None:
    with pytest.raises(FileFormatError) as caught:
        SystemConfig.parse(text)
    assert told in str(caught.value)


def test_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"gone\.yaml.*cannot be read"):
        SystemConfig.load(tmp_path / "gone.yaml")


def test_options_count_more_than_the_file_section_by_section() -> None:
    config = SystemConfig.parse("speed: 3\nseed: 7\nmodel: {retries: 1, timeout_s: 9}\n")
    changed = config.changed({"seed": 8, "model": {"timeout_s": 4}})
    assert (changed.speed, changed.seed, changed.model.retries, changed.model.timeout_s) == (3, 8, 1, 4)
    assert changed.changed({}) == changed


def test_another_model_gets_neither_address_nor_key_of_the_one_in_the_file() -> None:
    text = "language: openai:a\nmodel: {base_url: 'http://here/v1', key_file: k, retries: 1}\n"
    config = SystemConfig.parse(text)
    same = config.changed({"language": "openai:a"})
    assert (same.model.base_url, same.model.key_file) == ("http://here/v1", Path("k"))
    other = config.changed({"language": "groq:b"})
    assert (other.model.base_url, other.model.key_file, other.model.retries) == ("", None, 1)
    own_key = config.changed({"language": "groq:b", "model": {"key_file": Path("mine")}})
    assert own_key.model.key_file == Path("mine")


def test_every_setting_stands_on_the_page_and_no_other() -> None:
    page = (DOCS / "configuration.md").read_text(encoding="utf-8")
    first = {cell for row in re.findall(r"^\| (`[^|]*) \|", page, re.MULTILINE) for cell in row.split(", ")}
    named = {cell.strip("` ") for cell in first}
    model: type[BaseModel] = SystemConfig
    assert named == set(model.model_fields)
