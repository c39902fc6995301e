"""The files of words: read once for everybody, so nobody can change them for the others."""

from __future__ import annotations

import pytest

from parley.language.lexicon import load_data


def test_nobody_can_change_what_is_read_once_for_all() -> None:
    read = load_data("rearranging")
    with pytest.raises(AttributeError):
        read.pop("parts")
    with pytest.raises(TypeError):
        read["parts"]["do"] = ""
    with pytest.raises(AttributeError):
        read["swap"].append("turn it round")
