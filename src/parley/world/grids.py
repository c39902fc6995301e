"""What maps are searched with: large libraries, which a robot that has no map does without."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from parley.extras import needs

try:
    from scipy.ndimage import binary_dilation, distance_transform_edt
    from skimage.graph import MCP_Geometric, route_through_array
except ModuleNotFoundError as error:
    _missing: ModuleNotFoundError | None = error
else:
    _missing = None

__all__ = [
    "MCP_Geometric", "binary_dilation", "distance_transform_edt", "linear_sum_assignment", "require",
    "route_through_array",
]  # fmt: skip


def linear_sum_assignment(costs: Sequence[Sequence[float]]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of the cheapest assignment; its library takes as long to load as all others here."""
    from scipy.optimize import linear_sum_assignment as assigned

    return assigned(costs)


def require() -> None:
    """To be called where a map is taken up, so that what is missing is said before anything drives.

    Raises:
        MissingExtraError: `maps`.
    """
    with needs("maps"):
        if _missing is not None:
            raise _missing
