"""Whether a rule's hours are now: by the clock on the wall, over midnight and over changes of summer time."""

from __future__ import annotations

from datetime import datetime, tzinfo
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from parley.errors import ConfigError
from parley.messages.rules import DAYS, Hours

__all__ = ["holds_at", "wall_clock", "zone_of"]


def zone_of(name: str) -> tzinfo | None:
    """The time zone of that name; None for the machine's own.

    Raises:
        ConfigError: There is no such zone, or this machine does not know any.
    """
    if not name:
        return None
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError) as error:
        raise ConfigError(
            f"timezone {name!r} is not known; say e.g. Europe/Tallinn, or leave it out"
        ) from error


def wall_clock(unix_ms: int, zone: tzinfo | None) -> datetime:
    """What the clocks on the wall show."""
    return datetime.fromtimestamp(unix_ms / 1000, tz=zone).astimezone(zone)


def holds_at(hours: Hours | None, now: datetime) -> bool:
    """Whether hours hold at a wall clock's time; None is always.

    Where clocks are put back, hours that come twice count both times; hours that are left out do not come.
    """
    if hours is None:
        return True
    today, before = DAYS[now.weekday()], DAYS[(now.weekday() - 1) % 7]
    days = hours.days or DAYS
    if hours.start is None or hours.end is None:
        return today in days
    minute, start, end = now.hour * 60 + now.minute, _minute(hours.start), _minute(hours.end)
    if start < end:
        return today in days and start <= minute < end
    return (today in days and minute >= start) or (before in days and minute < end)


def _minute(text: str) -> int:
    hour, minute = text.split(":")
    return int(hour) * 60 + int(minute)
