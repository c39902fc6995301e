"""Entries of the audit log as sentences that people read."""

from __future__ import annotations

import re
from datetime import datetime, tzinfo
from typing import Any, Final

from parley.gate.wording import rule_text
from parley.memory.because import OPERATOR
from parley.messages.audit import AuditEvent
from parley.messages.plain import one_line
from parley.messages.principal import Principal
from parley.messages.rules import Rule
from parley.sentences import Sentence, listed, sentence, together

__all__ = ["moment", "told", "what_of", "who_of"]

_NOTHING: Final = "–"
_DEVICES: Final = ("page on a computer", "page on a phone", "page on a tablet", "a program", "terminal")
"""Our own words for what people speak through; other names are theirs."""
_OURS: Final = {
    "skip": "a step is left out",
    "pop": "a step is left out",
    "run_at_once": "never",
    "ask_when_risky": "where care is needed",
    "ask_first": "always",
}
"""Commands and policies as people read them."""


def who_of(by: Principal | None) -> Sentence:
    """Who it was."""
    if by is None or (by.kind == "program" and not by.key):
        return sentence("A program that nobody vouches for")
    if by.kind == "person":
        known = by.name not in ("", OPERATOR)
        named = sentence("{name}", name=by.name) if known else sentence("Somebody")
        device = sentence(by.device) if by.device in _DEVICES else by.device
        return sentence("{who} ({device})", who=named, device=device) if by.device else named
    if by.kind == "robot":
        return sentence("{name}", name=by.name.partition("/")[0])  # behind it stands the action
    if by.kind == "engine":
        return _engine(by.name)
    if by.kind == "rule":
        return sentence("A rule of {name}", name=by.name) if by.name else sentence("A rule")
    if by.kind == "schedule":
        return sentence("A schedule")
    return sentence("The program {name}", name=by.key or by.name)


def _engine(label: str) -> Sentence:
    """Engines call themselves what they are, and say more behind it."""
    short = re.split(r" \(|;", label, maxsplit=1)[0]
    if short == "built-in language engine":
        return sentence("The built-in language engine")
    if short.startswith("language model "):
        return sentence("The language model {name}", name=short.removeprefix("language model "))
    return sentence("The language engine {name}", name=short)


def what_of(detail: dict[str, Any]) -> Sentence:
    """What it was about: the steps, a memory, a policy."""
    steps = detail.get("labels")
    if isinstance(steps, list) and steps:
        return listed([str(step) for step in steps])
    for key in ("name", "policy", "command", "graph"):
        if isinstance(told := detail.get(key), str):
            ours = _OURS.get(told, "") if key in ("policy", "command") else ""
            return sentence(ours) if ours else sentence("{name}", name=told.replace("_", " "))
    return sentence("{name}", name=_NOTHING)


def told(event: AuditEvent) -> Sentence:
    """What happened, in one sentence on one line: no words in it look like another entry."""
    event = AuditEvent.model_validate(_on_one_line(event.model_dump(include=set(AuditEvent.model_fields))))
    if event.outcome == "refused" and event.effect == "sign_in":
        as_whom = event.detail.get("name")
        kept_out = sentence("Somebody was not let in.")
        return sentence("Somebody was not let in as “{name}”.", name=as_whom) if as_whom else kept_out
    if event.outcome == "refused" and event.by is None:  # whose it was is not known
        about = event.robot or sentence("all robots")
        return sentence("Refused ({robot}): {reason}", robot=about, reason=event.reason or _plain(event))
    if event.outcome == "refused":
        refused = sentence("Refused: {what}.", what=_plain(event))
        return together(refused, event.reason)
    if event.outcome == "failed" and event.effect not in ("end", "gap"):
        return together(sentence("Did not work: {what}.", what=_plain(event)), event.reason)
    if event.effect == "rule" and "rule" in event.detail:
        return _ruled(event)
    return together(sentence("{what}.", what=_plain(event)), _more(event))


def _on_one_line(value: Any) -> Any:
    """All texts of a value as `one_line` shows them."""
    match value:
        case str():
            return one_line(value)
        case dict():
            return {key: _on_one_line(item) for key, item in value.items()}
        case list() | tuple():
            return [_on_one_line(item) for item in value]
    return value


def _ruled(event: AuditEvent) -> Sentence:
    rule = rule_text(Rule.model_validate(event.detail["rule"]))
    who = who_of(event.by)
    if event.detail.get("dropped"):
        return sentence("{who} dropped this rule: {rule}", who=who, rule=rule)
    return sentence("{who} let this rule hold: {rule}", who=who, rule=rule)


def moment(unix_ms: int, now_unix_ms: int, zone: tzinfo | None = None) -> Sentence:
    """By clock and day."""
    then, now = _local(unix_ms, zone), _local(now_unix_ms, zone)
    time = f"{then:%H:%M}"
    days = (now.date() - then.date()).days
    if days <= 0:
        return sentence("at {time}", time=time)
    if days == 1:
        return sentence("yesterday at {time}", time=time)
    return sentence("on {date} at {time}", date=f"{then:%Y-%m-%d}", time=time)


def _about(event: AuditEvent) -> str:
    """The facts, or where there are none the words."""
    known = what_of(event.detail)
    return event.words if known == _NOTHING and event.words else known


def _more(event: AuditEvent) -> str:
    approved = event.detail.get("approved_by")
    if event.effect == "start" and isinstance(approved, dict):
        return sentence("{who} said yes to it.", who=who_of(Principal.model_validate(approved)))
    return event.reason


def _plain(event: AuditEvent) -> Sentence:
    """Without its end, and whatever became of it."""
    special = _special(event)
    if special is not None:
        return special
    template = _TEMPLATES.get(event.effect)
    robot = event.robot or sentence("all robots")
    values: dict[str, object] = {
        "who": who_of(event.by),
        "robot": robot,
        "words": event.words,
        "what": _about(event),
    }
    if template is None:
        return sentence("{who}: {effect}", who=values["who"], effect=event.effect)
    needed = {name: value for name, value in values.items() if f"{{{name}}}" in template}
    return Sentence.of(template, needed)


def _special(event: AuditEvent) -> Sentence | None:
    """What is said another way than its effect alone would say."""
    detail, robot = event.detail, event.robot
    if event.by is not None and event.by.kind == "robot" and "state" in detail:
        match detail["state"]:
            case "received":
                return sentence("{robot} knows of the stop", robot=robot)
            case "at_rest":
                return sentence("{robot} stands still", robot=robot)
            case "reset":
                return sentence("{robot} may move again", robot=robot)
    if event.effect == "begin" and "proposal" in detail:
        return sentence("{robot} waits for a yes: {what}", robot=robot, what=what_of(detail))
    if event.effect == "map":
        return _mapped(event)
    if event.effect == "end":
        return _ended(event)
    if event.effect == "gap" and "dropped" in detail:
        return sentence("{count} entries could not be written", count=detail["dropped"])
    if event.effect == "gap" and "until_unix_ms" in detail:
        silent_s = round((detail["until_unix_ms"] - detail["since_unix_ms"]) / 1000)
        return sentence("Nothing had been heard of {robot} for {seconds} s", robot=robot, seconds=silent_s)
    if event.effect in ("remember", "forget") and event.by is None and "command" not in detail:
        remembered = sentence("Remembered: {what}", what=what_of(detail))
        return (
            remembered if event.effect == "remember" else sentence("Forgotten: {what}", what=what_of(detail))
        )
    return None


def _mapped(event: AuditEvent) -> Sentence:
    """What was done to rooms and things."""
    who, was, put = who_of(event.by), event.detail.get("was"), event.detail.get("put")
    before, after = (place.get("name", "") if isinstance(place, dict) else "" for place in (was, put))
    if before and after and before != after:
        return sentence(
            "{who} changed “{before}” to “{words}” on the map", who=who, before=before, words=after
        )
    if before and after:
        return sentence("{who} changed “{words}” on the map", who=who, words=after)
    if before:
        return sentence("{who} took “{words}” off the map", who=who, words=before)
    if after:
        return sentence("{who} put “{words}” on the map", who=who, words=after)
    return sentence("{who} changed the map of {robot}", who=who, robot=event.robot)


def _ended(event: AuditEvent) -> Sentence:
    what = what_of(event.detail)
    if event.outcome == "failed":
        return sentence("{robot} did not get it done: {what}", robot=event.robot, what=what)
    if event.detail.get("state") == "STOPPED":
        return sentence("{robot} was ended before it was done: {what}", robot=event.robot, what=what)
    return sentence("{robot} has finished: {what}", robot=event.robot, what=what)


def _local(unix_ms: int, zone: tzinfo | None) -> datetime:
    return datetime.fromtimestamp(unix_ms / 1000, zone).astimezone(zone)


_TEMPLATES: Final = {
    "speak": "{who} said “{words}” to {robot}",
    "answer": "{who} answered “{words}” to {robot}",
    "stop": "{who} stopped {robot}",
    "reset": "{who} released the stop of {robot}",
    "pause": "{who} held {robot}",
    "resume": "{who} let {robot} go on",
    "begin": "{who} wants this from {robot}: {what}",
    "approve": "{who} said yes to {robot}: {what}",
    "reject": "{who} said no to {robot}: {what}",
    "edit": "{who} changed the plan of {robot}: {what}",
    "clear": "{who} gave up the plan of {robot}",
    "repair": "{who} found another way for {robot}: {what}",
    "remember": "{who} wants this remembered: {what}",
    "forget": "{who} wants this forgotten: {what}",
    "policy": "{who} chose when {robot} asks first: {what}",
    "setting": "{who} changed a setting: {what}",
    "people": "{who} changed who may do what: {what}",
    "audit": "{who} looked at this log",
    "sign_in": "{who} signed in",
    "sign_out": "{who} signed out",
    "start": "{robot} began: {what}",
    "open": "Parley was started, the log goes on",
    "close": "Parley was ended",
    "gap": "Some entries are not there",
    "prune": "Old entries were removed",
}
