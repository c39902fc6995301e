"""Parts that are installed on their own: what each is for, and a clear word where one is missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from parley.errors import MissingExtraError

__all__ = ["EXTRAS", "needs"]

EXTRAS: Final = {
    "maps": "driving by a map",
    "sim": "the simulator",
    "web": "the page for operators",
    "zenoh": "the network of several machines",
}
"""Extra -> what it brings. Those of language models: `parley.language.llm`."""


@contextmanager
def needs(extra: str) -> Iterator[None]:
    """Say clearly that an extra is missing where the imports inside this need it.

    Args:
        extra: One of `EXTRAS`; empty: none is needed.

    Raises:
        MissingExtraError: A library of it is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        if not extra or (error.name or "parley").partition(".")[0] == "parley":
            raise  # one of ours is missing: a defect
        raise MissingExtraError(extra, EXTRAS[extra]) from error
