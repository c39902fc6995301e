"""Rules in words for operators."""

from __future__ import annotations

import re
from typing import Final

from parley.messages.rules import DAYS, Day, Hours, RiskClass, Rule
from parley.sentences import Sentence, listed, sentence

__all__ = ["action_text", "class_text", "hours_text", "rule_text", "zone_text"]

_CLASSES: Final[dict[RiskClass, str]] = {
    RiskClass.LOOKS: "looks and speaks",
    RiskClass.MOVES: "moves",
    RiskClass.HANDLES: "handles things",
    RiskClass.FINAL: "cannot be undone",
    RiskClass.UNKNOWN: "not known what it does",
}

_DAYS: Final[dict[Day, str]] = {
    "mon": "Monday", "tue": "Tuesday", "wed": "Wednesday", "thu": "Thursday", "fri": "Friday",
    "sat": "Saturday", "sun": "Sunday",
}  # fmt: skip


def class_text(risk: RiskClass) -> Sentence:
    """A class of risk in words."""
    return sentence(_CLASSES[risk])


def action_text(name: str) -> str:
    """An action's name as words, e.g. ``open door`` for ``OpenDoor``."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name).replace("_", " ").lower()


def zone_text(rule: Rule) -> Sentence:
    """What a zone is called."""
    return sentence("“{zone}”", zone=rule.name or rule.id)


def hours_text(hours: Hours | None) -> Sentence:
    """When, with a space before it, to be put behind a sentence; empty for always."""
    if hours is None:
        return sentence("")
    days = sentence(" on {days}", days=_days_text(hours.days)) if hours.days else sentence("")
    if hours.start is None:
        return days
    return sentence("{days} between {start} and {end}", days=days, start=hours.start, end=hours.end)


def _days_text(days: tuple[Day, ...]) -> Sentence:
    return listed([sentence(_DAYS[day]) for day in DAYS if day in days])


def rule_text(rule: Rule) -> Sentence:
    """A rule in one sentence."""
    words = {
        "who": listed(rule.robots) if rule.robots else sentence("every robot"),
        "zone": zone_text(rule),
        "hours": hours_text(rule.when),
        "speed": f"{rule.max_speed_mps:g}" if rule.max_speed_mps is not None else "",
        "what": _what_text(rule),
        "limits": _limits_text(rule),
        "except": _exempt_text(rule),
    }
    return sentence(_FORMS[rule.kind, rule.verdict if rule.kind in ("action", "plan") else ""], **words)


_FORMS: Final[dict[tuple[str, str], str]] = {
    ("keep_out", ""): "Stays out of {zone}{hours}: {who}{except}.",
    ("slow", ""): "Not faster than {speed} m/s in {zone}{hours}: {who}{except}.",
    ("ask_zone", ""): "Asks before it goes through {zone}{hours}: {who}{except}.",
    ("speed", ""): "Not faster than {speed} m/s{hours}: {who}{except}.",
    ("action", "forbid"): "Must not do this{hours}: {what}. Holds for: {who}{except}.",
    ("action", "ask"): "Asks before it does this{hours}: {what}. Holds for: {who}{except}.",
    ("plan", "forbid"): "No plan with more than {limits}{hours}. Holds for: {who}{except}.",
    ("plan", "ask"): "Asks about plans with more than {limits}{hours}. Holds for: {who}{except}.",
}


def _what_text(rule: Rule) -> Sentence:
    if not rule.actions and not rule.classes:
        return sentence("anything")
    named = [f"“{action_text(name)}”" for name in rule.actions]
    return listed([*named, *(sentence("all that {kind}", kind=class_text(c)) for c in rule.classes)])


def _limits_text(rule: Rule) -> Sentence:
    limits = []
    if rule.max_distance_m is not None:
        limits.append(sentence("{number} m of way", number=f"{rule.max_distance_m:g}"))
    if rule.max_steps is not None:
        limits.append(sentence("{number} steps", number=rule.max_steps))
    if rule.max_expected_s is not None:
        limits.append(sentence("{number} s", number=f"{rule.max_expected_s:g}"))
    return listed(limits)


def _exempt_text(rule: Rule) -> Sentence:
    if not rule.exempt:
        return sentence("")
    return sentence(", but not on the order of: {roles}", roles=listed([sentence(r) for r in rule.exempt]))
