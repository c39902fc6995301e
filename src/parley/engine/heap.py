"""The garbage collector looks at everything now and then, and nothing else goes on meanwhile.

What a program has loaded is most of everything and never garbage. Runs are freed without the collector, so
that it finds next to nothing; its thresholds stay as they are for the sake of others' circles. Measured:
`docs/engine.md`.
"""

from __future__ import annotations

import gc

__all__ = ["settle_heap"]


def settle_heap() -> None:
    """Leave what was loaded so far out of all later looks; does something once per process only."""
    if gc.get_freeze_count() > 0:
        return
    gc.collect()
    gc.freeze()
