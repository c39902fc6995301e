"""What Nav2 says when it did not arrive, as one of our failures.

The numbers are those of nav2_msgs since Jazzy: each server has a hundred, of which the lowest that failed is
told. Humble tells none; then what is known is whether the robot got away from where it was.
"""

from __future__ import annotations

from typing import Final

from parley.errors import ActionFailure, FailureCode
from parley.sentences import sentence

__all__ = ["code_of", "failure_of"]

_TABLE: Final = {
    FailureCode.UNREACHABLE: (103, 204, 206, 208, 304, 306, 308),
    FailureCode.BLOCKED: (104, 105, 106, 205, 305, 703, 714, 723),
    FailureCode.TIMED_OUT: (108, 207, 307, 9003),
}
_CODES: Final = {number: code for code, numbers in _TABLE.items() for number in numbers}
_NUMBERS: Final = {FailureCode.UNREACHABLE: 208, FailureCode.BLOCKED: 105, FailureCode.TIMED_OUT: 9003}
_SENTENCES: Final = {
    FailureCode.UNREACHABLE: sentence("I know no way to there."),
    FailureCode.BLOCKED: sentence("Something stands in the way, and I found no way around it."),
    FailureCode.TIMED_OUT: sentence("I did not get there in time."),
    FailureCode.HARDWARE: sentence("I cannot drive: my drive reports a fault."),
}


def failure_of(error_code: int, error_msg: str, *, moved: bool) -> ActionFailure:
    """Why a drive ended.

    Args:
        error_code: Nav2's; 0: it says none.
        error_msg: Nav2's words, for engineers.
        moved: Whether the robot came away from where it began.
    """
    if error_code:
        code = _CODES.get(error_code, FailureCode.HARDWARE)
    else:
        code = FailureCode.BLOCKED if moved else FailureCode.UNREACHABLE
    return ActionFailure(code, _SENTENCES[code], {"nav2_code": error_code, "nav2_says": error_msg})


def code_of(failure: ActionFailure) -> int:
    """The number under which Nav2 would tell of one of our failures."""
    return _NUMBERS.get(failure.code, 9000)
