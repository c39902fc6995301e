"""Which sets there are, by name."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

from parley.errors import ConfigError
from parley.evaluation.cases import Case, CaseSet
from parley.evaluation.gpsr import GPSR_SEED, gpsr_cases

__all__ = ["SET_NAMES", "load_set", "own_set"]

_DATA: Final = Path(__file__).parents[3] / "eval"
_READ: Final = ("commands", "logic", "calls", "words", "trades")
_UNREAD: Final = "unread"

SET_NAMES: Final = ("development", *_READ, _UNREAD, "gpsr", "all")
"""`development`: all that may be read; `all`: everything."""


@cache
def own_set(name: str) -> CaseSet:
    """One of the files in `eval/` of Parley's sources, by its name without ending.

    They are no part of what is installed: unread cases do not belong where people work on an engine.

    Raises:
        ConfigError: Parley was installed without its sources.
        FileFormatError: It is broken.
    """
    path = _DATA / f"{name}.yaml"
    if not path.is_file():
        raise ConfigError(
            f"the set {name!r} is in Parley's sources only (eval/): run it there, or name a file with --set"
        )
    return CaseSet.load(path)


def load_set(name: str, seed: int = GPSR_SEED) -> list[Case]:
    """The cases of a set.

    Args:
        name: One of `SET_NAMES`, or a file.
        seed: Of the commands that are made by a grammar.

    Raises:
        ConfigError: There is no such set.
        FileFormatError: A file is broken.
    """
    parts = {"development": _READ, "all": (*_READ, _UNREAD)}.get(name, (name,))
    if name in SET_NAMES:
        made = gpsr_cases(seed) if name in ("gpsr", "all") else []
        return [*(case for part in parts if part != "gpsr" for case in own_set(part).cases), *made]
    if not Path(name).is_file():
        raise ConfigError(f"there is no set {name!r}; use {', '.join(SET_NAMES)} or a file")
    return list(CaseSet.load(Path(name)).cases)
