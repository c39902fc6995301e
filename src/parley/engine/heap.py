"""The garbage collector looks at everything now and then, and nothing else goes on meanwhile."""

from __future__ import annotations

import gc

__all__ = ["settle_heap"]


def settle_heap() -> None:
    """Leave what was loaded so far out of all later looks; does something once per process only."""
    if gc.get_freeze_count() > 0:
        return
    gc.collect()
    gc.freeze()
