"""Python files imported under private names, so that folders of actions cannot get in each other's way."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from pathlib import Path
from types import ModuleType
from typing import Final

__all__ = ["PRIVATE", "import_file", "private_name"]

PRIVATE: Final = "parley_action_file_"
"""What the names of such modules begin with."""

_numbers = itertools.count()


def private_name(file: Path) -> str:
    """A module name for `file` that was never used before, so that a changed file is another module."""
    stem = "".join(letter if letter.isalnum() else "_" for letter in file.stem)
    return f"{PRIVATE}{next(_numbers)}_{stem}"


def import_file(file: Path, name: str) -> ModuleType:
    """Import `file` as module `name`; whatever its code raises comes through.

    The module stays known for as long as the process lives: actions of it that still run look up types there.
    """
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise ImportError(f"{file.name} is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        # Compiled here and not by the loader, whose cache cannot tell two changes within a second apart.
        exec(compile(file.read_bytes(), str(file), "exec"), module.__dict__)
    except BaseException:
        del sys.modules[name]
        raise
    return module
