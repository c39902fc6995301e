"""What all tests share: the table of the specification's statements and the tests that hold them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
import structlog
from hypothesis import settings

from tests.conformance_ids import IDS

HERE = Path(__file__).parent
settings.register_profile("gate", derandomize=True)  # what it finds, it finds again; soak looks farther
settings.load_profile("gate")


@pytest.fixture(autouse=True)
def _no_test_leaves_logging_changed() -> Iterator[None]:
    """Commands that run inside a test configure logging for the whole process."""
    yield
    structlog.reset_defaults()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--conformance",
        action="store_true",
        help="show which test holds which statement of the specification",
    )


_LONG = (
    "test_parts",
    "test_harmless",
    "test_stop_under_faults",
    "test_passages",
    "test_kills",
    "test_hostile",
)
"""Files of which one takes more than half a minute: begun first, so that nobody waits for them at the end."""


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: not item.path.stem.startswith(_LONG))


def holders() -> dict[str, list[str]]:
    """Statement -> the tests marked with it, in all test files, whatever part of them is run now."""
    found: dict[str, list[str]] = {}
    for file in sorted(HERE.rglob("test_*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        whole = [name for item in tree.body if isinstance(item, ast.Assign) for name in _marks(item.value)]
        for test in _tests(tree):
            marked = [name for decorator in test.decorator_list for name in _marks(decorator)]
            for name in dict.fromkeys(whole + marked):
                found.setdefault(name, []).append(f"{file.relative_to(HERE).as_posix()}::{test.name}")
    return found


def _tests(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for item in ast.walk(tree):
        if isinstance(item, ast.FunctionDef | ast.AsyncFunctionDef) and item.name.startswith("test_"):
            yield item


def _marks(expression: ast.expr) -> Iterator[str]:
    """The arguments of every ``pytest.mark.spec(...)`` in an expression."""
    for item in ast.walk(expression):
        if (
            isinstance(item, ast.Call)
            and isinstance(item.func, ast.Attribute)
            and item.func.attr == "spec"
            and isinstance(item.func.value, ast.Attribute)
            and item.func.value.attr == "mark"
        ):
            yield from (str(a.value) for a in item.args if isinstance(a, ast.Constant))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    found = holders()
    held = sum(name in found for name in IDS)
    terminalreporter.write_line(
        f"specification: {held} of {len(IDS)} statements are held by tests"
        + ("" if config.getoption("--conformance") else " (--conformance shows which by which)")
    )
    if config.getoption("--conformance"):
        for name, words in IDS.items():
            terminalreporter.write_line(f"{name:12} {words}")
            for test in found.get(name, ["NO TEST"]):
                terminalreporter.write_line(f"{'':12}   {test}")
