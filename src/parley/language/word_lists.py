"""Reads the word lists: YAML files of general English (and of stop words in many languages).

Files are read as plain text values: in them ``no`` and ``on`` are words, not truth values.
"""

from __future__ import annotations

import re
from functools import cache
from importlib import resources
from typing import Any

import yaml

__all__ = ["load_data", "written_out"]

_CHOICE = re.compile(r"\(([^()]*)\)")

# The base loader builds nothing but text, lists and mappings; the first message waits for this, so be quick.
_LOADER = getattr(yaml, "CBaseLoader", yaml.BaseLoader)


@cache
def load_data(name: str) -> Any:
    """The content of one data file, every scalar as text; read once, so nobody may change it."""
    path = resources.files("parley.language") / "offline" / "data" / f"{name}.yaml"
    return yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)


def written_out(text: str) -> list[str]:
    """What "(a|b|) c" stands for: "a c", "b c" and "c"; other phrases stand for themselves."""
    found = _CHOICE.search(text)
    if found is None:
        return [" ".join(text.split())]
    before, after = text[: found.start()], text[found.end() :]
    return [one for choice in found[1].split("|") for one in written_out(f"{before}{choice}{after}")]
