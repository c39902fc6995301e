"""What is asked about a team: who is nearest, what another one is doing, how far the work is."""

from __future__ import annotations

import re
from typing import Final

from parley.language.builtin.answers import sought
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import plain, question_of
from parley.team.parted import pieces_in
from parley.team.wish import Part, TeamWish
from parley.team.wording import Wording, lists

__all__ = ["asked_about", "asked_progress", "judged_in", "told_of_one"]

_OF_ONE: Final = {
    "owned": "what are you doing?", "under_way": "what are you doing?", "through": "are you done?",
    "fate": "what is wrong?",
}  # fmt: skip
_OF_ALL: Final = {
    "finders": "did you find anything?", "full": "how much battery is left?",
    "doing": "what are you doing?",
}  # fmt: skip
_SECOND: Final = {"is": "are", "'s": " are", "has": "have", "does": "do", "was": "were"}


def asked_about(team: Wording, text: str) -> TeamWish | None:
    """A question about robots: who is nearest, what another one is doing."""
    bare = team.begun(text)
    for pattern in lists()["nearest"]:
        if found := team.match(pattern.replace("{robot}", team.names), bare):
            return TeamWish("nearest", about=found["place"])
    if found := team.match(team.of("chosen"), bare):
        return TeamWish("why", robot=team.robots.get((found["robot"] or "").lower(), ""))
    for name, asked in _OF_ONE.items():
        if team.match(team.of(name), bare):
            return TeamWish("about", about=asked, robot=team.called(bare)[0])
    for name, asked in _OF_ALL.items():
        if team.match(team.of(name), bare):
            return TeamWish("about", about=asked)
    if (places := _whereabouts(team, bare)) is not None:
        return places
    together = _all_together(team, bare)
    called = rf"{team.names}\b.*|.*(?<!\bis)(?<!\bwas)(?<!'s)\W{team.names}"
    named = re.findall(rf"\b{team.names}\b", bare, re.IGNORECASE)
    if not together and (len(named) > 1 or (named and team.match(called, bare))):
        return None
    which = re.sub(rf"^{team.of('which')} (\w+)", r"\1 you", bare, flags=re.IGNORECASE)
    whom = re.escape(together or named[0]) if named else team.of("asked")
    asked = which if which != bare else re.sub(rf"\b{whom}\b", "you", bare, flags=re.IGNORECASE)
    for third, second in _SECOND.items():
        asked = re.sub(rf"(?:\b{third}|(?<=\w){third}) you\b", f"{second} you", asked, flags=re.IGNORECASE)
    has = re.sub(r"\bare you\b", "have you", asked)  # "what's Ada found?"
    asked = next((one for one in (asked, has) if question_of(plain(tokenize(one)))), "")
    if not asked or asked == bare:
        return None
    parts = (Part("named", f"{asked}?", robot) for robot in team.called(together))
    one = team.robots[named[0].lower()] if named and not together else ""
    return TeamWish("about", tuple(parts), about=f"{asked}?", robot=one)


def _whereabouts(team: Wording, text: str) -> TeamWish | None:
    """Where robots are, and things beside them: "where are Ada and the box?"."""
    each = sought(text)
    robots = [team.robots[one.lower()] for one in each if one.lower() in team.robots]
    things = [one for one in each if one.lower() not in team.robots]
    if not robots or not team.hearer or (things and team.hearer in robots):
        return None
    parts = [Part("named", "where are you?", robot) for robot in robots]
    if things:
        parts.append(Part("named", f"where are {' and '.join(things)}?", team.hearer))
    return TeamWish("about", tuple(parts))


def _all_together(team: Wording, text: str) -> str:
    """Several robots of which one thing is asked, as they are named: "what are Ada and Kim doing"."""
    found = re.search(rf"(?<=\w ){team.names}(?:(?:,? and|,) {team.names})+\b", text, re.IGNORECASE)
    return found[0] if found and team.called(found[0]) == team.called(text) else ""


def asked_progress(team: Wording, text: str, *, asks: bool) -> TeamWish | None:
    """How far the work is, or whether something of it is done."""
    if team.match(team.of("progress"), text):
        return TeamWish("progress", otherwise=TeamWish("about", about="what is left to do?"))
    found = team.match(team.of("checked"), text) if asks else None
    what = next(filter(None, found.groups()), "") if found else ""
    if not what or team.called(what):
        return None
    return TeamWish("progress", about=what.strip(), otherwise=asked_about(team, text))


def told_of_one(team: Wording, text: str) -> TeamWish | None:
    """What one of the team is to do no more, or nowhere near something."""
    text = team.begun(re.sub(rf"^{team.of('afresh')},? ", "", text, flags=re.IGNORECASE))
    if found := team.match(team.of("dropping"), text):
        return TeamWish("drop", robot=next(iter(team.called(text))))
    found = team.match(team.of("barring"), text)
    named = {key[:5]: value for key, value in found.groupdict().items() if value} if found else {}
    if found is None or not (robots := team.called(named["robot"])):
        return None
    how = "drive near" if re.search(r"\b(?:near|close)\b", text, re.IGNORECASE) else "go into"
    parts = (Part("named", f"you must not {how} {named['place']}", name) for name in robots)
    return TeamWish("bar", tuple(parts))


def judged_in(team: Wording, text: str) -> TeamWish | None:
    """A part that depends on what another one finds, which nobody waits for."""
    who = rf"(?:{team.names}|{team.of('rest')}|{team.of('all')})"
    judging = rf"{team.of('judging')},?(?: then)? (?={who}\b)"
    first = re.match(judging, text, re.IGNORECASE)
    if first is not None and pieces_in(team, told := text[first.end() :]):
        return TeamWish("judged", about=told, bare=True)
    found = re.search(rf"(?<=[,;. ]){judging}", text, re.IGNORECASE)
    if found is None or not pieces_in(team, told := f"{text[: found.start()]}then {text[found.end() :]}"):
        return None
    return TeamWish("judged", about=told)
