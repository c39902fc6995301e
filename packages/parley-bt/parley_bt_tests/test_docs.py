"""The package's page lists what the code refuses, in the code's words."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from parley_bt import EXPORT_REASONS, IMPORT_REASONS

PAGE = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("title", "reasons"),
    [("What cannot be exported", EXPORT_REASONS), ("What cannot be imported", IMPORT_REASONS)],
)
def test_the_page_lists_every_reason(title: str, reasons: Mapping[str, str]) -> None:
    section = PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]
    assert dict(re.findall(r"^\| `([a-z_]+)` \| (.+) \|$", section, re.MULTILINE)) == reasons
