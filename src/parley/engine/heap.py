"""The garbage collector looks at everything now and then, and nothing else goes on meanwhile.

What a program has loaded is most of everything and never garbage. Runs are freed without the collector, so it
finds next to nothing, and may look more seldom; others' circles are still found. Measured: `docs/engine.md`.
"""

from __future__ import annotations

import functools
import gc
from typing import Final

__all__ = ["settle_heap"]

THRESHOLDS: Final = (5000, 3, 50)
"""Starting 100 graphs makes some 60,000 objects. New ones are looked at once per 5,000, and again with those
of three such looks: a few milliseconds each. Everything is looked at once per million, and not per 85,000."""


@functools.cache
def settle_heap() -> None:
    """Leave what was loaded so far out of all later looks; does something once per process only."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(*THRESHOLDS)
