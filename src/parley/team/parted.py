"""Each robot's part in what a team is told: "Ada checks the gate, Kim waits at the dock"."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from parley.language.builtin.lexicon import lemmas, lexicon
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import plain, question_of
from parley.team.wish import WHO, Part, TeamWish, Who
from parley.team.wording import NUMBERS, Wording, in_base_form, opened_by

__all__ = ["bare_things", "part_of", "parts_in", "pieces_in", "taken_over"]

Piece = tuple[Who, str, str, bool, str]
"""A part as said: who, in which words, what to do, whether it comes after another one, and after whose."""
_BESIDE: Final = r"[,;.] (?:and |but |while )?(?P<who>[A-Z][a-z]+),? (?P<verb>[a-z]+)\b"
_NAME_WORDS: Final = 3
_DOES: Final = re.compile(
    r"\w{3,}s (?:the|an?|my|our|your|this|that|over|on|at|up|for|to|with)\b", re.IGNORECASE
)
"""What somebody does, though it is no verb that we know: "minds the gate" is no thing that is taken."""
_ALONE: Final = ("charge", "recharge")
"""Whole orders: nothing has to be said of where."""
_THE: Final = ("the", "a", "an", "this", "that", "some")
_INSIDE: Final = (
    " the", " of", " to", " at", " with", " by", " near", " for", " from", " in", " on",
    " when", " once", " after", " as soon as",
)  # fmt: skip
"""Behind these a name is no subject: "go to, hm, Kim"."""


def parts_in(team: Wording, text: str, *, asks: bool, alone: bool) -> TeamWish | None:
    """Who is to do what, one part after the other as it was said."""
    anyone = "|".join(team.of(who) for who in ("one", "some", "all", "each"))
    text = _recalled(team, text)
    if found := team.match(rf"{team.of('handing')} (?P<rest>(?:{anyone}) .+)", text):
        text = found["rest"]
    if team.hearer and (found := team.match(rf"{team.of('handing')} {team.of('rest')} (?P<order>.+)", text)):
        rest = part_of(team, "rest", "", found["order"], after=False, known=())
        spoken_to = (team.hearer,)  # "tell the others to come": all but the one that hears it
        return TeamWish("parts", (replace(rest, without=spoken_to),)) if rest is not None else None
    if found := team.match(rf"(?P<order>.+?),? with (?P<some>{team.of('some')})", text):
        text = f"{found['some']} {found['order']}"
    others = rf"(?:{anyone}|{team.of('rest')}|{team.names})"
    text = re.sub(rf"((?:[,;:.]|\band|\bbut) ){team.of('handing')} (?={others}\b)", r"\1", text)
    handing = rf"(?:{team.of('handing')} (?P<robot>{team.names})|(?P<own>{team.names}) {team.of('duty')})"
    found = team.match(rf"{handing} (?P<order>.+)", text)
    if found and not (asks and found["own"]):
        robot = found["robot"] or found["own"]
        if len(pieces_in(team, f"{robot} {found['order']}")) > 1:
            text = f"{robot} {found['order']}"  # the next one has a part of its own
            at = rf"({team.names}) (?:at|by|near)(?= )"  # "I want Ada and Kim at the gate"
            text = re.sub(at, r"\1 go to", text, flags=re.IGNORECASE) if found["robot"] else text
        elif not team.match(team.of("last"), found["order"]) or found["robot"]:
            return _handed(team, robot, found["order"])
    if found := team.match(rf"(?P<robot>{team.names}) {team.of('modal')} {team.of('last')}", text):
        return TeamWish("parts", (Part("named", "", team.robots[found["robot"].lower()]),))
    whole = rf"(?:{team.of('all')}|{team.of('each')})(?: {team.of('but')})?"
    if found := team.match(rf"(?P<order>.+?),? (?P<all>{whole})", text):
        if found["order"].lower().endswith((*_INSIDE, " for", " than", " as", " by")):
            return None  # "say hello to everybody"
        text = f"{found['all']} {found['order']}"
    made = _made(team, pieces_in(team, text))
    only = {part.who for part in made}
    single = len(made) == 1 and not made[0].awaits and not alone
    if not made or (single and only & {"named", "rest"}) or (asks and "named" in only):
        return None
    if (stranger := next(filter(None, (_stranger(team, part.order) for part in made)), "")) != "":
        return TeamWish("stranger", about=stranger)
    return TeamWish("parts", tuple(_together(team, made))) if not all(part.stays for part in made) else None


def bare_things(team: Wording, text: str, *, asks: bool) -> TeamWish | None:
    """Robots and places, but not what is to be done there: "Ada the gate, Kim the desk"."""
    pieces = pieces_in(team, text)
    if len(pieces) < 2 or asks or any(piece[0] != "named" or piece[3] for piece in pieces):
        return None
    takes = rf"(?:{team.of('taking')} )?(?P<what>.+)"
    what = [found["what"] if (found := team.match(takes, piece[2])) else "" for piece in pieces]
    small, being = lexicon().classes["prepositions"], lexicon().classes["being"]
    firsts = {(words.split(" ")[0].lower()) for words in what}
    named = firsts.isdisjoint({*small, *being, ""} - lexicon().classes["determiners"])
    verbs = {first for first in firsts if any((form,) in lexicon().verbs for form in (first, *lemmas(first)))}
    deeds = firsts <= verbs or any(words.split(" ")[0].lower() in verbs and " " in words for words in what)
    if not named or deeds or len({*what}) < len(what):
        return None
    if any(len(words.split(" ")) > _NAME_WORDS or question_of(plain(tokenize(words))) for words in what):
        return None
    parts = (Part("named", words, team.robot(piece[1])) for piece, words in zip(pieces, what, strict=True))
    return TeamWish("parts", tuple(parts), bare=True)


def _stranger(team: Wording, order: str) -> str:
    """Somebody who is no robot here, and has a part behind the words of one: "..., Rex waits there"."""
    for found in re.finditer(_BESIDE, order):
        verb = in_base_form(found["verb"])
        does = verb != found["verb"] and (verb,) in lexicon().verbs
        if found["who"].lower() not in team.robots and (does or team.match(team.of("modal"), verb)):
            return found["who"]
    return ""


def _together(team: Wording, made: Sequence[Part]) -> list[Part]:
    """Robots that are told the same several things, as one part: they may share it."""
    found: list[Part] = []
    for order, group in itertools.groupby(made, key=lambda part: (part.order, part.who, part.after)):
        parts = [*group]
        same = len(parts) > 1 and order[1] == "named" and not order[2] and parts[0].order
        if (
            same
            and re.search(r"\band\b|,", parts[0].order)
            and all(part == replace(parts[0], robot=part.robot) for part in parts)
        ):
            named = {part.robot for part in parts}
            others = tuple(name for name in team.robots.values() if name not in named)
            parts = [replace(parts[0], who="all", robot="", without=others)]
        found += parts
    return found


def _made(team: Wording, pieces: Sequence[Piece]) -> list[Part]:
    """The parts of pieces, those that wait behind those that they wait for; none if one is no order."""
    made: list[Part] = []
    for who, subject, order, after, awaits in pieces:
        told = re.match(r"\w+s\b", order) and not team.match(rf"{team.of('modal')} .+", order)
        if len(pieces) == 1 and told and re.match(team.of("indefinite"), f"{subject} {order}"):
            return []  # "somebody comes to the gate"
        own = part_of(team, who, subject, order, after=after, known=made)
        if own is None:
            return []
        made.append(replace(own, awaits=awaits if awaits != own.robot else ""))
    named = tuple(part.robot for part in made if part.robot)
    made = [
        replace(part, without=(*part.without, *named)) if part.who == "rest" else part
        for part in _as_others(made)
    ]
    doers = {part.robot for part in made}
    made = [replace(part, awaits="") if part.awaits in doers else part for part in made]
    if [part.after for part in made] == [True, False]:  # "Kim goes when Ada is there. Ada goes."
        made.reverse()
    return [] if len(made) > 1 and made[0].after and not made[0].awaits else made


def _handed(team: Wording, robot: str, order: str) -> TeamWish | None:
    """What one robot is to do, whoever hears it."""
    order = "do that" if order.lower() == "go" else order
    own = part_of(team, "named", robot, order, after=False, known=())
    return TeamWish("parts", (own,)) if own is not None else None


def _recalled(team: Wording, text: str) -> str:
    """Robots that are called back, as if it were said to them: "bring everyone home"."""
    whom = rf"(?P<whom>{team.of('all')}|{team.of('each')}|{team.of('rest')}|{team.names})"
    found = team.match(rf"{team.of('recalling')} {whom} (?P<way>(?:back|home)\b.*)", text)
    found = found or team.match(rf"recall {whom}(?P<way>(?: to .+)?)", text)
    if found is None:
        return text
    way = found["way"] if not found["way"].startswith(" ") and found["way"] else f"back{found['way']}"
    lead = "let " if found["whom"].lower() in team.robots else ""
    return f"{lead}{found['whom']} {way}"


def taken_over(team: Wording, text: str) -> TeamWish | None:
    """That one robot does what is left of another one's work."""
    anyone = rf"(?:(?P<robot>{team.names})|{team.of('one')})"
    who = rf"(?:{team.of('handing')} )?{anyone},?(?: {team.of('modal')})?"
    small = r"(?:(?:so|and|then|please|can|could),? )*"
    if team.hearer and re.search(r"\w+s over\b|\btake over\b|\w+s (?:in )?for\b|^(?:let|have) ", text):
        text = re.sub(r"\b(from|for) you\b", rf"\1 {team.hearer}", text, flags=re.IGNORECASE)
        own = r"\byour (?=(?:part|share|work|job|rest|round|plan|tasks?|place)\b)"
        text = re.sub(own, f"{team.hearer}'s ", text, flags=re.IGNORECASE)
    if team.hearer:  # "can you do Ada's part?"
        text = re.sub(r"^(?:can|could|would|will) you ", f"{team.hearer} ", text, flags=re.IGNORECASE)
    ails = rf"(?P<of>{team.names}) ?{team.of('trouble')} ?[,.;:–-]+ ?{small}"
    found = (
        team.match(rf"{who} {team.of('takeover')}", text)
        or team.match(team.of("givenaway"), text)
        or team.match(rf"{ails}{who} {team.of('stepsin')}", text)
    )
    if found is None:
        return None
    said = found.groupdict()
    robot = team.robots.get((said["robot"] or "").lower(), "")
    of = team.robots[(said["of"] or said["of2"]).lower()]
    if robot == of:
        return None
    return TeamWish("parts", (Part("named" if robot else "one", "", robot, of=of),))


def pieces_in(team: Wording, text: str) -> list[Piece]:
    """The parts as said."""
    when = team.of("when")
    you = "|you" if team.hearer else ""
    further = rf"(?<=[\w,;.] ){team.of('further')}"
    subjects = "|".join(
        f"(?P<{who}>{team.of(who)}(?: {team.of('but')})?)" for who in ("one", "some", "rest", "each", "all")
    )
    subjects = subjects.replace("(?P<one>", f"(?P<one>{further}|", 1)
    opening = (
        rf"(?P<gap>^|[,;.]? (?:{team.of('meanwhile')} )?|[,;.] ?)"
        rf"(?P<then>{team.of('then')},? )?(?P<when>{when},? )?"
        rf"(?:{subjects}|(?P<named>{team.names}{you}))(?=[,:]? \w)"
    )
    found = [
        one
        for one in re.finditer(opening, text, re.IGNORECASE)
        if not text[: one.start()].lower().endswith(_INSIDE)
        and not ((one["named"] or "").lower() == "you" and one["gap"] == " ")
    ]
    if not found or found[0].start() != 0:
        return []
    ends = [one.start() for one in found[1:]] + [len(text)]
    pieces: list[Piece] = []
    for one, end in zip(found, ends, strict=True):
        who = next(name for name in WHO if one[name])
        order = text[one.end() : end].strip(" ,;:.")
        waits = re.search(rf"[,;]? {when}$", f" {order}", re.IGNORECASE)
        order = order[: waits.start() - 1].strip() if waits else order
        awaited = team.called((one["when"] or "") + (waits[0] if waits else ""))
        after = bool(one["then"] or one["when"] or waits)
        pieces.append((who, one[who], order, after, next(iter(awaited), "")))
    for at in range(len(pieces) - 2, -1, -1):
        if not pieces[at][2] and not pieces[at + 1][3]:  # "Ada and Kim go to the gate": both do
            pieces[at] = (*pieces[at][:2], pieces[at + 1][2], *pieces[at][3:])
    return pieces


def part_of(
    team: Wording,
    who: Who,
    subject: str,
    said: str,
    *,
    after: bool,
    known: Sequence[Part],
) -> Part | None:
    """A part from who is meant, as they are called, and what is said of them; None if that is no order.

    Args:
        team: The words.
        who: Whether one robot is named, or some, or all.
        subject: By which words.
        said: What they are to do.
        after: Whether it comes after another part.
        known: The parts before it.
    """
    of_whom, *left_out = re.split(rf" (?={team.of('but')}$)", subject.lower())
    part = Part(
        who,
        "",
        team.robot(subject),
        after,
        count=next((number for word, number in NUMBERS.items() if word in of_whom.split()), 1),
        nearest="nearest" in of_whom or "closest" in of_whom,
        without=team.called(" ".join(left_out)),
        fullest=team.match(team.of("strongest"), of_whom) is not None,
        idle=team.match(team.of("idle"), of_whom) is not None,
    )
    order = re.sub(r",? first$", "", said.strip(" ,"), flags=re.IGNORECASE)
    way = re.match(r"to (\w+)", order, re.IGNORECASE)
    if way and (way[1].lower(),) not in lexicon().verbs:
        order = f"go {order}"
    if who == "all":
        order = re.sub(r",? together$", "", order, flags=re.IGNORECASE)
    if who != "named":  # "the others at the dock"
        order = re.sub(r"^(?:at|by|near) (?=\w)", "go to ", order, flags=re.IGNORECASE)
    while found := re.match(rf"{team.of('modal')} ", order, re.IGNORECASE):
        order = order[found.end() :]
    if team.match(team.of("staying"), order):
        return replace(part, stays=True)
    if team.match(team.of("last"), order):
        return part
    taken = team.match(rf"{team.of('taking')} (?P<what>.+)", order)
    order = in_base_form(order)
    if team.match(team.of("home"), order):
        return replace(part, home=True)
    if order and re.match(rf"{team.of('homeward')}\b", order, re.IGNORECASE) and " " in order:
        order = f"go {order}"
    if team.match(team.of("following"), order):
        order = known[-1].order if known else ""
        return replace(part, order=order) if order else None
    return _deed(team, part, order, known, taken)


def _deed(
    team: Wording, part: Part, order: str, known: Sequence[Part], taken: re.Match[str] | None
) -> Part | None:
    """A part with what it is to do, in words for one robot; None if that is no order."""
    order = team.gone(order)
    first = order.split(" ")[0].lower()
    verbs, being = lexicon().verbs, lexicon().classes["being"]
    nameless = (first,) not in verbs and first not in being and not _DOES.match(order)
    if known and part.who in ("named", "one") and nameless:
        order = f"{opened_by(known[-1].order)} {order}"  # "Ada checks the gate, Kim the desk"
        first = order.split(" ")[0].lower()
    can = (first,) in verbs and first not in being
    named = taken and not (taken["verb"][:3] in ("tak", "get") and taken["what"].split(" ")[0] in _THE)
    if taken and named:
        return replace(part, order=order if can else "", alike=taken["what"])
    return replace(part, order=order) if can and (" " in order or first in _ALONE) else None


def _as_others(made: Sequence[Part]) -> list[Part]:
    """What is only "taken" is done as the others do: "Ada takes area A, Kim looks at area B"."""
    verb = next((opened_by(part.order) for part in made if part.order and not part.alike), "")
    if not verb and any(part.alike and not part.order for part in made):
        return []
    return [
        replace(part, alike=f"{verb} {part.alike}" if verb else "") if part.alike else part for part in made
    ]
