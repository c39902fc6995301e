"""The door is light, and says the same of itself in each place."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import parley.api
from parley.api import _WHERE, MissingExtraError, Parley


def test_every_name_can_be_loaded_and_is_known_to_type_checkers() -> None:
    source = ast.parse(Path(parley.api.__file__).read_text(encoding="utf-8"))
    (typed,) = [node for node in source.body if isinstance(node, ast.If)]
    seen = {alias.name for node in typed.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    loaded = {name for names in _WHERE.values() for name in names}
    assert seen == loaded == set(parley.api.__all__)
    for name in parley.api.__all__:
        assert getattr(parley.api, name) is not None


def test_importing_it_loads_no_simulator_no_server_and_no_model() -> None:
    code = (
        "import sys, parley.api\n"
        "from parley.api import Parley, RobotBase, action, person\n"
        "heavy = 'mujoco fastapi onnxruntime pydantic_ai numpy scipy PIL structlog rich'.split()\n"
        "print(*(n for n in heavy"
        " if n in sys.modules))"
    )
    told = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60
    )
    assert told.stdout.split() == []


async def test_whoever_lacks_the_simulator_is_told_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("parley.robots.simulated", "parley.sim.simulator"):
        monkeypatch.delitem(sys.modules, module, raising=False)
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'parley-hri\[sim\]'"):
        async with Parley("nursing-home"):
            pass
