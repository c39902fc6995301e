"""What is known of words: frames, verbs and closed word classes, as data with sentences that test them.

Files are read as plain text values: in them ``no`` and ``on`` are words, not truth values.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

import yaml

__all__ = ["load_data"]

# The base loader builds nothing but text, lists and mappings; the first message waits for this, so be quick.
_LOADER = getattr(yaml, "CBaseLoader", yaml.BaseLoader)


@cache
def load_data(name: str) -> Any:
    """The content of one data file, every scalar as text; read once, so nobody may change it."""
    path = resources.files(__name__) / f"{name}.yaml"
    return yaml.load(path.read_text(encoding="utf-8"), Loader=_LOADER)
