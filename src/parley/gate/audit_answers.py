"""Questions about who wanted what, answered from the audit log by code. Pure.

"Who sent you there?", "who stopped you?", "who said yes to that?", "what did you do since ten?", in English
and Estonian; the answer is in the language of the question.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime, timedelta, tzinfo
from typing import Final, Literal, NamedTuple

from parley.gate.audit_text import moment, told, what_of, who_of
from parley.messages.audit import AuditEntry
from parley.messages.principal import Principal
from parley.sentences import Sentence, SpokenLanguage, in_language, sentence, together

__all__ = ["EFFECTS", "Question", "answer_from_log", "question_of"]

About = Literal["sent", "stopped", "released", "approved", "did"]

EFFECTS: Final[dict[About, tuple[str, ...]]] = {
    "sent": ("start",),
    "stopped": ("stop", "pause"),
    "released": ("reset", "resume"),
    "approved": ("approve",),
    "did": ("start", "end"),
}
"""Which entries matter for which question."""
_SHOWN: Final = 4
"""Deeds that are named one by one."""


class Question(NamedTuple):
    """What is asked."""

    about: About
    language: SpokenLanguage
    since: str = ""
    """For `did`: ``today``, ``yesterday``, ``hour`` or a time of day as ``HH:MM``."""


_THERE: Final = r"(?: (?:t?here|over there|(?:in)?to \w[\w ]*))?"
_DO: Final = r"(?: to)?(?: (?:do|go|drive|come|move|begin|start)\b[\w ]*)?"
_HAS: Final = r"who(?: has|'s)?"
_ASKED: Final[tuple[tuple[About, SpokenLanguage, str], ...]] = (
    ("sent", "en", rf"{_HAS} sent you{_THERE}"),
    ("sent", "en", rf"{_HAS} (?:told|asked|ordered|instructed) you{_DO}"),
    ("sent", "en", r"(?:on )?whose orders?(?: (?:was|is) (?:that|this)| are you .*)?"),
    ("sent", "en", r"why are you (?:t?here|over there)"),
    ("stopped", "en", rf"{_HAS} (?:stopped|halted|paused) (?:you|it)"),
    ("stopped", "en", rf"{_HAS} (?:pressed|hit|pushed) (?:the )?(?:stop|stop button|emergency stop)"),
    ("released", "en", rf"{_HAS} (?:released|reset|freed) (?:you|it|the stop)"),
    ("released", "en", r"who let you (?:go on|move again|carry on)"),
    ("approved", "en", rf"{_HAS} (?:said yes|agreed)(?: to (?:that|this|it))?"),
    ("approved", "en", rf"{_HAS} (?:approved|allowed|confirmed) (?:that|this|it)"),
    ("sent", "et", r"kes (?:su|sind|sinu) (?:\w+ )?saatis(?: \w+)?"),
    ("sent", "et", r"kes sul(?:le)? (?:\w+ ){0,2}(?:käskis|ütles|palus)(?: \w+){0,2}"),
    ("sent", "et", r"kes (?:käskis|palus) sul(?: \w+){0,3}"),
    ("sent", "et", r"miks sa (?:siin|seal) oled|miks sa oled (?:siin|seal)"),
    ("stopped", "et", r"kes (?:su|sind) (?:peatas|seisma pani)"),
    ("stopped", "et", r"kes vajutas (?:stoppi|hädastoppi|stoppnuppu)"),
    ("released", "et", r"kes (?:su|sind|stopi|hädastopi) vabastas"),
    ("approved", "et", r"kes (?:sellele )?ütles (?:sellele )?jah(?: sellele)?"),
    ("approved", "et", r"kes (?:seda |selle |sellega )?(?:lubas|kinnitas|nõustus|heaks kiitis)(?: se\w+)?"),
)
_DID: Final[tuple[tuple[SpokenLanguage, str], ...]] = (
    ("en", r"what (?:did you do|have you (?:done|been doing|been up to)) (?P<when>.+)"),
    ("et", r"mi(?:da|s) sa (?P<when>.+) (?:tegid|teinud oled|oled teinud)"),
    ("et", r"mi(?:da|s) sa (?:tegid|oled teinud|teinud oled) (?P<when>.+)"),
)
_DAYS: Final = {
    "today": "today", "this morning": "today", "täna": "today", "yesterday": "yesterday", "eile": "yesterday",
    "in the last hour": "hour", "viimase tunni jooksul": "hour",
}  # fmt: skip
_SINCE: Final = (
    r"(?:since|after|alates kella(?:st)?) (?P<a>.+)|kella(?:st)? (?P<b>.+) (?:alates|saadik|peale)"
)
_HOURS: Final[dict[str, int]] = {
    word: hour
    for hour, words in enumerate((
        "midnight", "one ühest", "two kahest", "three kolmest", "four neljast", "five viiest", "six kuuest",
        "seven seitsmest", "eight kaheksast", "nine üheksast", "ten kümnest", "eleven üheteistkümnest",
        "twelve noon kaheteistkümnest",
    ))
    for word in words.split()
}  # fmt: skip


def question_of(text: str) -> Question | None:
    """What is asked, if it is such a question and nothing else."""
    plain = " ".join(re.sub(r"[?!,]+|\.(?!\d)", " ", text.casefold().replace("’", "'")).split())
    for about, language, pattern in _ASKED:
        if re.fullmatch(pattern, plain):
            return Question(about, language)
    for language, pattern in _DID:
        if (found := re.fullmatch(pattern, plain)) and (since := _since(found["when"])):
            return Question("did", language, since)
    return None


def _since(when: str) -> str:
    if when in _DAYS:
        return _DAYS[when]
    found = re.fullmatch(_SINCE, when)
    return _clock(found["a"] or found["b"]) if found else ""


def answer_from_log(
    text: str,
    robot: str,
    entries: Sequence[AuditEntry],
    *,
    now_unix_ms: int,
    asker: str = "",
    zone: tzinfo | None = None,
) -> str | None:
    """The answer to a question about who wanted what; None if it is no such question.

    Args:
        text: What was said.
        robot: Who is asked.
        entries: The log, newest first, as far back as it may matter.
        now_unix_ms: Now.
        asker: The name of who asks; empty if not known.
        zone: The operator's time zone; this machine's if left out.
    """
    asked = question_of(text)
    if asked is None:
        return None
    own = [
        entry
        for entry in entries
        if entry.robot.casefold() in ("", robot.casefold())
        and entry.effect in EFFECTS[asked.about]
        and entry.outcome in ("done", "failed", "asked")
        and not (entry.by is not None and entry.by.kind == "robot")
    ]
    if asked.about == "did":
        answer = _deeds(asked, own, now_unix_ms, zone)
    elif not own:
        answer = sentence("I do not know: nothing about it is written down.")
    elif asked.about == "sent":
        answer = _sent(own[0], now_unix_ms, asker, zone)
    else:
        answer = _who(asked.about, own[0], now_unix_ms, asker, zone)
    return in_language(answer, asked.language)


def _sent(entry: AuditEntry, now: int, asker: str, zone: tzinfo | None) -> Sentence:
    when = moment(entry.unix_ms, now, zone)
    what = what_of(entry.detail)
    begun = sentence("I began with this {when}: {what}.", when=when, what=what)
    asked, raw = entry.detail.get("asked"), entry.detail.get("asked_by")
    approved = entry.detail.get("approved_by")
    if isinstance(asked, str) and isinstance(raw, dict):
        by, words = Principal.model_validate(raw), asked.rstrip(" .")
        parts = [
            sentence("You told me {when}: “{words}”.", when=when, words=words)
            if _is(by, asker)
            else sentence("{who} told me {when}: “{words}”.", who=who_of(by), when=when, words=words)
        ]
    elif entry.by is not None and entry.by.kind != "program":
        parts = [sentence("{who} wanted it.", who=who_of(entry.by)), begun]
    else:
        parts = [begun, sentence("I do not know who wanted it: nobody's name is written down for it.")]
    if isinstance(approved, dict):
        yes = Principal.model_validate(approved)
        parts.append(
            sentence("You said yes to it.")
            if _is(yes, asker)
            else sentence("{who} said yes to it.", who=who_of(yes))
        )
    return together(*parts)


_BY_YOU: Final[dict[About, str]] = {
    "stopped": "You stopped me {when}.", "released": "You let me go on {when}.",
    "approved": "You said yes {when}: {what}.",
}  # fmt: skip
_BY_OTHERS: Final[dict[About, str]] = {
    "stopped": "{who} stopped me {when}.", "released": "{who} let me go on {when}.",
    "approved": "{who} said yes {when}: {what}.",
}  # fmt: skip


def _who(about: About, entry: AuditEntry, now: int, asker: str, zone: tzinfo | None) -> Sentence:
    by = entry.by
    if by is None and isinstance(asked := entry.detail.get("asked_by"), dict):
        by = Principal.model_validate(asked)
    values: dict[str, object] = {"when": moment(entry.unix_ms, now, zone)}
    if about == "approved":
        values["what"] = what_of(entry.detail)
    if by is not None and _is(by, asker):
        return sentence(_BY_YOU[about], **values)
    return sentence(_BY_OTHERS[about], who=who_of(by), **values)


def _deeds(asked: Question, own: Sequence[AuditEntry], now: int, zone: tzinfo | None) -> Sentence:
    begin, end = _span(asked.since, now, zone)
    ended = {str(entry.detail.get("graph")): entry for entry in own if entry.effect == "end"}
    begun = [entry for entry in own if entry.effect == "start" and begin <= entry.unix_ms < end]
    if not begun:
        return sentence("Nothing about that time is written down for me.")
    parts: list[Sentence] = []
    for entry in reversed(begun[:_SHOWN]):
        last = ended.get(str(entry.detail.get("graph")), entry)
        at = datetime.fromtimestamp(entry.unix_ms / 1000, zone).astimezone(zone)
        parts.append(sentence("{time}: {what}", time=f"{at:%H:%M}", what=told(last)))
    if (more := len(begun) - _SHOWN) > 0:
        parts.insert(0, sentence("{count} more things before that.", count=more))
    return together(*parts)


def _span(since: str, now_unix_ms: int, zone: tzinfo | None) -> tuple[int, int]:
    now = datetime.fromtimestamp(now_unix_ms / 1000, zone).astimezone(zone)
    midnight = now.replace(hour=0, minute=0, second=0, microsecond=0)
    begin, end = midnight, now + timedelta(seconds=1)
    if since == "yesterday":
        begin, end = midnight - timedelta(days=1), midnight
    elif since == "hour":
        begin = now - timedelta(hours=1)
    elif ":" in since:
        hour, minute = (int(part) for part in since.split(":"))
        begin = midnight.replace(hour=hour, minute=minute)
        if begin > now:
            begin -= timedelta(days=1)
    return int(begin.timestamp() * 1000), int(end.timestamp() * 1000)


def _clock(text: str) -> str:
    """``10``, ``10:30``, ``ten``, ``2 pm`` as ``HH:MM``; empty if it is no time of day."""
    found = re.fullmatch(
        r"(?:(\d{1,2})(?:[:.](\d\d))?|([^\W\d]+))(?: ?(am|pm|o'clock))?(?:st)?", text.strip()
    )
    if found is None:
        return ""
    if found[3] and found[3] not in _HOURS:
        return ""
    hour, minute = int(found[1]) if found[1] else _HOURS[found[3]], int(found[2] or 0)
    if found[4] == "pm" and hour < 12:
        hour += 12
    return f"{hour:02}:{minute:02}" if hour < 24 and minute < 60 else ""


def _is(by: Principal, asker: str) -> bool:
    """Whether it is the one who asks; two without a name may be two."""
    return by.is_person and asker != "" and by.name.casefold() == asker.casefold()
