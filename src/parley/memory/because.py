"""Why something is said: where a memory comes from, in words. Such sentences are made here and only here."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from datetime import datetime, tzinfo

from parley.messages.memory import MemoryEntry

__all__ = ["OPERATOR", "because", "origin", "reasons", "when"]

OPERATOR = "operator"
"""The source of what a person said whose name is not known."""


def because(
    entries: Sequence[MemoryEntry],
    *,
    now_unix_ms: int,
    asker: str = "",
    robots: Collection[str] = (),
    robot: str = "",
    zone: tzinfo | None = None,
) -> str:
    """One short sentence, to stand behind a reply: "I know that because you told me at 10:04.".

    Args:
        entries: The memories the reply is founded on.
        now_unix_ms: Now.
        asker: Who is spoken to; empty if not known.
        robots: All robots, to tell their finds from what people said.
        robot: The robot that replies.
        zone: The operator's time zone; this machine's if left out.

    Returns:
        The sentence; empty if there is nothing to name.
    """
    ways: dict[str, None] = {}
    for entry in entries:
        ways[f"{origin(entry, asker, robots, robot)} {when(entry, now_unix_ms, zone)}".strip()] = None
    told = list(ways)
    if not told:
        return ""
    listed = told[0] if len(told) == 1 else f"{', '.join(told[:-1])} and {told[-1]}"
    return f"I know that because {listed}."


def reasons(
    entries: Sequence[MemoryEntry],
    *,
    now_unix_ms: int,
    asker: str = "",
    robots: Collection[str] = (),
    robot: str = "",
    zone: tzinfo | None = None,
) -> str:
    """The long answer to "how do you know?": who, when, and the words, one sentence per memory."""
    said: list[str] = []
    for entry in entries:
        way = f"{origin(entry, asker, robots, robot)} {when(entry, now_unix_ms, zone)}".strip()
        words = f"a picture of {entry.info or entry.name}" if entry.type == "image" else f"“{entry.data}”"
        said.append(f"Because {way}: {words}")
    return " ".join(said)


def origin(entry: MemoryEntry, asker: str, robots: Collection[str], robot: str) -> str:
    """Who said or saw it: "you told me", "Kim told me", "I saw it", "I concluded it"."""
    who = entry.source.partition("/")[0]
    if entry.way == "concluded":
        return "I concluded it myself" if who in ("", robot) else f"{who} concluded it"
    if who in robots or (robot and who == robot):
        return "I saw it" if who == robot else f"{who} saw it"
    showed = "showed me" if entry.type == "image" else "told me"
    if not who or who == OPERATOR or who.casefold() == asker.casefold():
        return f"you {showed}"
    return f"{who} {showed}"


def when(entry: MemoryEntry, now_unix_ms: int, zone: tzinfo | None = None) -> str:
    """By clock and day: "at 10:04", "yesterday at 10:04", "on 3 March", "on 3 March 2024"."""
    if entry.updated_unix_ms <= 0:
        return ""
    then, now = _local(entry.updated_unix_ms, zone), _local(now_unix_ms, zone)
    days = (now.date() - then.date()).days
    if days <= 0:
        return f"at {then:%H:%M}"
    if days == 1:
        return f"yesterday at {then:%H:%M}"
    year = "" if then.year == now.year else f" {then.year}"
    return f"on {then.day} {_MONTHS[then.month - 1]}{year}"


_MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October",
    "November", "December",
)  # fmt: skip


def _local(unix_ms: int, zone: tzinfo | None) -> datetime:
    return datetime.fromtimestamp(unix_ms / 1000, zone).astimezone(zone)
