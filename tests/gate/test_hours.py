"""Hours by the clock on the wall: over midnight, and when clocks are put forward and back."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.gate.hours import holds_at, wall_clock
from parley.messages.rules import DAYS, Hours

TALLINN = ZoneInfo("Europe/Tallinn")


def at(text: str) -> datetime:
    return datetime.fromisoformat(text)


@pytest.mark.parametrize(
    ("hours", "moment", "held"),
    [
        ({"from": "14:00", "to": "15:00"}, "2026-03-10T14:00", True),
        ({"from": "14:00", "to": "15:00"}, "2026-03-10T15:00", False),
        ({"from": "22:00", "to": "06:00"}, "2026-03-10T23:59", True),
        ({"from": "22:00", "to": "06:00"}, "2026-03-10T05:59", True),
        ({"from": "22:00", "to": "06:00"}, "2026-03-10T06:00", False),
        ({"from": "22:00", "to": "06:00", "days": ("tue",)}, "2026-03-11T05:00", True),
        ({"from": "22:00", "to": "06:00", "days": ("tue",)}, "2026-03-10T05:00", False),
        ({"from": "00:00", "to": "24:00", "days": ("tue",)}, "2026-03-10T23:59", True),
        ({"days": ("tue",)}, "2026-03-11T00:00", False),
        ({"from": "08:00", "to": "08:00"}, "2026-03-11T03:00", True),
    ],
)
def test_hours(hours: dict[str, object], moment: str, held: bool) -> None:
    assert holds_at(Hours.model_validate(hours), at(moment)) is held


def test_an_hour_that_comes_twice_counts_twice_and_one_that_is_left_out_does_not_come() -> None:
    hours = Hours(start="03:00", end="04:00")

    def minutes(day: datetime) -> int:
        moments = (day + timedelta(minutes=n) for n in range(24 * 60))
        return sum(holds_at(hours, wall_clock(int(m.timestamp() * 1000), TALLINN)) for m in moments)

    assert minutes(datetime(2026, 10, 24, 21, tzinfo=UTC)) == 120
    assert minutes(datetime(2026, 3, 28, 22, tzinfo=UTC)) == 0
    assert minutes(datetime(2026, 6, 1, 21, tzinfo=UTC)) == 60


@given(
    start=st.integers(0, 1439),
    length=st.integers(1, 1439),
    now=st.datetimes(datetime(2026, 1, 1), datetime(2027, 1, 1)),
)
def test_hours_and_the_rest_of_the_day_never_hold_together(start: int, length: int, now: datetime) -> None:
    end = (start + length) % 1440
    inside = Hours(start=f"{start // 60}:{start % 60:02d}", end=f"{end // 60}:{end % 60:02d}")
    outside = Hours(start=inside.end, end=inside.start)
    assert holds_at(inside, now) is not holds_at(outside, now)
    assert holds_at(Hours(days=DAYS), now)
