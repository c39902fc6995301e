"""The page itself, as it is served."""

from __future__ import annotations

from pathlib import Path

import pytest
from starlette.requests import Request

from parley.errors import ConfigError
from parley.web.pages import Pages


async def test_words_in_further_languages_come_with_the_page_as_data(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("<head></head>")
    (tmp_path / "et.json").write_text('{"common": {"yes": "</script><b>jah"}}')
    (tmp_path / "xx.json").write_text("{}")  # a language that robots do not speak is not offered
    answer = await Pages(tmp_path, tmp_path).answer(Request({"type": "http", "path_params": {}}))
    assert bytes(answer.body) == (
        rb'<head><script type="application/json" id="languages">'
        rb'{"et": {"common": {"yes": "\u003c/script>\u003cb>jah"}}}</script></head>'
    )


@pytest.mark.parametrize("name", ["none", "broken"])
def test_a_folder_of_languages_that_cannot_be_read_is_said_at_once(tmp_path: Path, name: str) -> None:
    broken = tmp_path / "broken"
    broken.mkdir()
    (broken / "et.json").write_text("{")
    with pytest.raises(ConfigError, match=name):
        Pages(tmp_path, tmp_path / name)
