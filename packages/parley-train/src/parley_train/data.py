"""What lies here to learn from, and its hash."""

from __future__ import annotations

import hashlib
import random
from importlib import resources
from importlib.resources.abc import Traversable

import yaml

from parley.language.builtin.labels import DESCRIBED
from parley_train.markup import Annotated, read_text
from parley_train.varying import filled

__all__ = ["data_hash", "descriptions", "from_templates", "held_back", "written"]

_HERE = resources.files("parley_train")


def _files(kind: str) -> list[Traversable]:
    return sorted(
        (file for file in (_HERE / kind).iterdir() if file.name.endswith(".txt")), key=lambda f: f.name
    )


def written() -> list[Annotated]:
    """The sentences that are learnt from."""
    return _read("sentences")


def held_back() -> list[Annotated]:
    """Those of writers of whom nothing is learnt: on them is measured, and thresholds are set."""
    return _read("held_back")


def _read(kind: str) -> list[Annotated]:
    return [sentence for file in _files(kind) for sentence in read_text(file.read_text("utf-8"), file.name)]


def from_templates(chance: random.Random, times: int) -> list[Annotated]:
    """Sentences out of templates, each filled so many times."""
    words = yaml.load((_HERE / "words.yaml").read_text("utf-8"), yaml.BaseLoader)
    lines = [
        line for file in _files("templates") for line in file.read_text("utf-8").splitlines()
        if line.strip() and not line.startswith("#")
    ]  # fmt: skip
    return filled(lines, words, chance, times)


def descriptions() -> list[tuple[str, str]]:
    """What makers say of their actions, with the frame it is."""
    lines = [line.split("\t") for line in (_HERE / "descriptions.txt").read_text("utf-8").splitlines()]
    pairs = [(frame, text) for frame, text in (line for line in lines if len(line) == 2)]
    unknown = {frame for frame, _ in pairs} - set(DESCRIBED)
    if unknown:
        raise ValueError(f"descriptions.txt names frames that do not exist: {sorted(unknown)}")
    return pairs


def data_hash() -> str:
    """Of everything that the weights are made of but the base model: it stands in the model card."""
    digest = hashlib.sha256()
    for file in [
        *_files("sentences"),
        *_files("templates"),
        _HERE / "words.yaml",
        _HERE / "descriptions.txt",
    ]:
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()
