"""Which sets there are, by name."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Final

from parley.errors import ConfigError
from parley.evaluation.cases import Case, CaseSet
from parley.evaluation.gpsr import GPSR_SEED, gpsr_cases

__all__ = ["SET_NAMES", "load_set", "own_set"]

_DATA: Final = Path(__file__).parents[3] / "eval"
_DEVELOPED: Final = (
    "development",
    "second_set",
    "third_set",
    "fourth_set",
    "fifth_set",
    "scenes",
    "trades_campus",
    "trades_care",
    "trades_catalogues",
    "trades_demos",
    "trades_goods",
    "trades_guards",
    "trades_guests",
    "trades_public",
    "fresh_calls",
    "fresh_days",
    "fresh_nights",
    "fresh_scenes",
    "fresh_tasks",
    "list",
    "logic",
    "long_calls",
    "needs",
    "people",
    "readings",
    "round_eight",
    "round_five",
    "round_four",
    "round_nine",
    "round_seven",
    "round_six",
    "round_three",
    "round_two",
    "unseen_actions",
    "voices",
    "wordings",
)
_BLIND: Final = (
    "blind_round",
    "blind_examiner",
    "blind_trades_one",
    "blind_trades_two",
    "blind_trades_three",
)

SET_NAMES: Final = ("development", "held-out", "blind", "gpsr", "all")
"""`held-out`: the halves of sets that nobody developed on; `blind` holds `gpsr`."""


@cache
def own_set(name: str) -> CaseSet:
    """One of the files in `eval/` of Parley's sources, by its name without ending.

    They are no part of what is installed: blind cases do not belong where people work on an engine.

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
    if name == "gpsr":
        return gpsr_cases(seed)
    if name in SET_NAMES:
        files = {"blind": _BLIND, "all": (*_DEVELOPED, *_BLIND)}.get(name, _DEVELOPED)
        cases = _of(files)
        if name in {"development", "held-out"}:
            return [case for case in cases if case.blind is (name == "held-out")]
        return [*cases, *gpsr_cases(seed)]
    if not Path(name).is_file():
        raise ConfigError(f"there is no set {name!r}; use {', '.join(SET_NAMES)} or a file")
    return list(CaseSet.load(Path(name)).cases)


def _of(files: Sequence[str]) -> list[Case]:
    return [case for name in files for case in own_set(name).cases]
