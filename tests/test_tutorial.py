"""The tutorial's action is taken from its page, found, asked for in the chat, and carried out."""

from __future__ import annotations

import re
from pathlib import Path

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.umrf.discovery import ActionFolder
from tests.demos.house import running

EXAMPLES = Path(__file__).parent.parent / "examples"
PAGE = (Path(__file__).parent.parent / "docs" / "own-action.md").read_text(encoding="utf-8")


def written(folder: Path) -> Path:
    """The file of the tutorial, where it says."""
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (name,) = re.findall(r"Save this as `my_actions/([a-z_]+\.py)`", PAGE)
    (folder / name).write_text(code, encoding="utf-8")
    return folder


def test_the_page_shows_the_example_as_it_is() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert code == (EXAMPLES / "actions" / "report_battery.py").read_text(encoding="utf-8")


def test_the_action_is_ten_lines_and_is_found(tmp_path: Path) -> None:
    index = ActionFolder(written(tmp_path))
    index.scan()
    assert index.found.problems == ()
    assert [spec.name for spec in index.found.specs] == ["ReportBattery"]
    lines = next(tmp_path.glob("*.py")).read_text(encoding="utf-8").splitlines()
    assert len([line for line in lines if line.strip()]) <= 10


async def test_the_conversation_of_the_page_takes_place(tmp_path: Path) -> None:
    order, answer = re.findall(r"^    (?:You|David): (.*)$", PAGE, re.MULTILINE)
    config = SystemConfig(speed=None, actions_dir=written(tmp_path))
    async with running(load_demo("nursing-home").system(config)) as home:
        await home.say(order)
        assert await home.done() == ["finished"]
        assert home.actions() == ["ReportBattery"]
        assert answer in [said.message for said in home.observer.said]
