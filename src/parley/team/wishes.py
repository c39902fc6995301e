"""What is said to several robots as a team: who of them is to do what, or which of them is asked about.

Only the way in which the work is spread is read here. The work itself ("check the boxes") is left in the
person's words, to be understood as if it were said to one robot. Words stand in `wishes.yaml`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, Literal

from parley.gate.control import behind_stop, control_of, stops_all
from parley.gate.stop_words import calls_to_stop, has_stop_word, only_waits
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import asks, plain, question_of
from parley.team.asked import asked_about, asked_progress, judged_in, told_of_one
from parley.team.parted import bare_things, parts_in, taken_over
from parley.team.spread import share_in, shared
from parley.team.wish import Part, TeamWish, is_of_several
from parley.team.wording import Wording, acts, opened_by, plain_words

__all__ = ["asked_by_name", "gathered", "is_unread", "team_wish", "turned_wish"]

_WANTED: Final = re.compile(
    r"^(?:i|we)(?:'d| would)? (?:like|want|need) (?P<what>.+?) (?:to be )?"
    r"(?:looked at|checked|inspected|searched|seen to)\b",
    re.IGNORECASE,
)


def team_wish(message: str, robots: Sequence[str], hearer: str = "") -> TeamWish | None:
    """How a message is meant for a team; None if it says nothing of one.

    Args:
        message: What was said.
        robots: Who is there; a team has at least two.
        hearer: Whom "you" means, where one robot hears it.
    """
    if len(robots) < 2:
        return None
    team = Wording(tuple(robots), hearer)
    wish = wish_in(team, message)
    if wish is None or any(calls_to_stop(part.order) or control_of(part.order) for part in wish.parts):
        return None  # stopping has its own way
    if not any(part.stays for part in wish.parts) and calls_to_stop(message):
        return None
    return counted(team, wish, message)


def turned_wish(message: str, robots: Sequence[str], hearers: Sequence[str]) -> TeamWish | None:
    """The order behind words of stopping: "stop, Ada go to the gate", "no wait, all of you back".

    None if there is none, or if whoever hears it reads it for itself: "wait, not that one".
    """
    team = Wording(tuple(robots), hearers[0] if len(hearers) == 1 else "")
    for head, rest in behind_stop(message, tuple(robots)) if has_stop_word(message) else ():
        turns: Literal["done", "asked"] = "done" if only_waits(head) else "asked"
        waits = turns == "done" and "then" in message[len(head) : -len(rest)]  # "wait a minute, then ..."
        called = re.match(rf"{team.of('all')}\s*[,.;:!–-]", rest, re.IGNORECASE)  # "stop everyone! ..."
        if waits or called or calls_to_stop(rest) or control_of(rest, tuple(robots)):
            continue
        wish = wish_in(team, rest, alone=True) if len(robots) > 1 else None
        if wish is not None and wish.kind in ("parts", "share", "swap"):
            return replace(counted(team, wish, rest), turns=turns)
        order = team.begun(plain_words(rest))
        if turns == "asked" and hearers and acts(order):
            out = tuple(name for name in robots if name not in hearers)
            part = Part("named", order, hearers[0]) if len(hearers) == 1 else Part("all", order, without=out)
            part = Part("all", order) if stops_all(head) and len(robots) > 1 else part
            return TeamWish("parts", (part,), turns=turns)
    return None


def is_unread(message: str, robots: Sequence[str]) -> str | None:
    """What of words to a team that `team_wish` does not read it reads; None: they are not to a team."""
    if len(robots) < 2:
        return None
    team = Wording(tuple(robots))
    tails = (message[cut.end() :] for cut in re.finditer(r"[,;:.!–—-]\s+", message))
    read = next(
        (tail for tail in tails if (wish := wish_in(team, tail)) and any(part.order for part in wish.parts)),
        "",
    )
    return read if read or re.search(rf"\b{team.of('group')}\b", message, re.IGNORECASE) else None


def asked_by_name(message: str, robots: Sequence[str], hearer: str) -> TeamWish | None:
    """A question that calls one robot, heard by another one: that cannot answer for it."""
    team = Wording(tuple(robots))
    text = team.begun(plain_words(message))
    found = team.calling(text)
    if found is None or found[0] == hearer:
        return None
    bare = plain(tokenize(found[1]))
    if question_of(bare) is None or not asks(message, bare):
        return None
    return TeamWish("about", about=f"{found[1]}?", robot=found[0])


def gathered(message: str) -> str:
    """Where all that hear a message shall come together, as it is said to one of them: "go to the gate"."""
    team = Wording(("you",))
    begun = re.sub(r",? together$", "", team.begun(plain_words(message)), flags=re.IGNORECASE)
    gone = team.gone(begun)
    return gone if gone != team.begun(plain_words(message)) else message


def wish_in(team: Wording, message: str, *, alone: bool = False) -> TeamWish | None:
    """How a message is meant for a team; `alone`: or for one that is named."""
    asks = message.rstrip().endswith("?")
    text = plain_words(message)
    bare = _respective(team, _awaiting(team, _called_as_team(team, team.begun(text))))
    opened = team.match(
        rf"(?:{team.of('lead')} )?{team.of('afresh')}(?:[,;:.!]+(?: and| but)?| and) (?P<rest>.+)", bare
    )
    wish = (
        asked_progress(team, team.begun(text), asks=asks)
        or told_of_one(team, text)
        or asked_about(team, text)
    )
    wish = wish or _read(team, bare, asks=asks, alone=alone)
    sparing = _sparing(team, bare)
    if sparing is not None and (wish is None or team.called(sparing.parts[0].order) == ()):
        return sparing
    after = wish_in(team, opened["rest"], alone=True) if opened else None
    if after is not None and after.kind not in ("about", "nearest", "why"):
        return replace(after, anew=after.kind != "swap" and not any(part.instead for part in after.parts))
    return wish


def _read(team: Wording, text: str, *, asks: bool, alone: bool) -> TeamWish | None:
    """How work is spread, or spread otherwise than before."""
    if team.match(team.of("swapping"), text):
        named = team.called(text)
        two = len(named) in (0, 2)
        return TeamWish("swap", tuple(Part("named", "", name) for name in named)) if two else None
    return (
        _alone(team, text)
        or _helping(team, text)
        or judged_in(team, text)
        or _other(team, text)
        or taken_over(team, text)
        or share_in(team, text)
        or bare_things(team, text, asks=asks)
        or parts_in(team, text, asks=asks, alone=alone)
    )


def _alone(team: Wording, text: str) -> TeamWish | None:
    """One of the team and nobody else, where nothing is said of what it is to do."""
    found = team.match(team.of("alone"), text)
    return TeamWish("alone", robot=next(iter(team.called(text)))) if found else None


def _helping(team: Wording, text: str) -> TeamWish | None:
    """One that is to help another one."""
    if (found := team.match(team.of("helping"), text)) is None:
        return None
    who = team.robots.get((found["who"] or found["who2"] or "").lower(), team.hearer)
    of = team.robots[(found["of"] or found["of2"]).lower()]
    return TeamWish("help", (Part("named", "", who),), robot=of) if who and who != of else None


def _awaiting(team: Wording, text: str) -> str:
    """What somebody does after waiting for another one, or as it is through, as it is said of a part."""
    if (found := team.match(team.of("free"), text)) is not None:
        return f"let {found['robot']} {found['order']}"
    itself = rf"(?P<when>{team.of('when')}),? (?:it|he|she) (?P<order>.+)"
    if (found := team.match(itself, text)) and len(named := team.called(found["when"])) == 1:
        return f"let {named[0]} {found['order']}"
    who = team.names + ("|you" if team.hearer else "")
    waits = rf"(?:(?P<who>{who}),? )?{team.of('awaiting')}"
    found = team.match(waits, text)
    if found and (doer := found["who"] or team.hearer):
        return f"when {found['of']} is done, {doer} {found['order']}"
    found = team.match(rf"(?P<who>{who}),? (?P<when>{team.of('when')}),? (?P<order>.+)", text)
    if found and team.called(found["when"]):
        return f"{found['when']}, {found['who']} {found['order']}"
    return text


def _respective(team: Wording, text: str) -> str:
    """Who does which of several things, told as one part after the other."""
    some = rf"(?P<some>{team.names}(?:(?:,? and|,) {team.names})+),?(?: {team.of('modal')})?"
    found = team.match(rf"{some} (?P<order>.+?),? (?:respectively|in (?:that|this) order)", text)
    if found is None:
        return text
    names, orders = team.called(found["some"]), re.split(r",? and |, ", found["order"])
    orders[1:] = [one if acts(one) else f"{opened_by(orders[0])} {one}" for one in orders[1:]]
    if len(names) != len(orders):
        return text
    return ", ".join(f"{name} {order}" for name, order in zip(names, orders, strict=True))


def _sparing(team: Wording, text: str) -> TeamWish | None:
    """Work for all but those who are to have no part in it."""
    found = team.match(rf"{team.of('sparing')}(?:[,;:.] ?(?:and |but )?| and )(?P<rest>.+)", text)
    found = found or team.match(rf"(?P<rest>.+?){team.of('spared')}", text)
    if found is None:
        return None
    said = " ".join(value for name, value in found.groupdict().items() if value and name[:3] == "out")
    out, rest = team.called(said), found["rest"]
    wish = wish_in(team, rest, alone=True)
    if wish is None and is_of_several(rest) and (rest.split(" ")[0].lower(),) in lexicon().verbs:
        wish = shared(rest)
    if wish is None or any(part.robot for part in wish.parts):
        return None
    parts = (replace(part, without=(*part.without, *out)) for part in wish.parts)
    return replace(wish, parts=tuple(parts))


def _other(team: Wording, text: str) -> TeamWish | None:
    """Another robot than the one that has it now."""
    found = team.match(team.of("instead"), text)
    if found is None:
        return None
    robot, of = (
        next((team.robots[value.lower()] for name, value in found.groupdict().items()
              if value and re.fullmatch(rf"{key}\d*", name)), "")
        for key in ("robot", "of")
    )  # fmt: skip
    return TeamWish("parts", (Part("named", "", robot, of=of, instead=True),)) if robot != of else None


def _called_as_team(team: Wording, text: str) -> str:
    """Without what only calls: "Ada and Kim, you two go", "Ada, tell Kim to go"."""
    some = rf"{team.names}(?:(?:,? and|,) {team.names})+"
    text = re.sub(rf"^({some}),? you(?: two| three| both| all)?,? (?=\w)", r"\1 ", text, flags=re.IGNORECASE)
    text = re.sub(rf"\b({team.names}),? you (?!two|three|both|all)(?=\w)", r"\1 ", text, flags=re.IGNORECASE)
    text = _WANTED.sub(r"check \g<what>", text)
    if team.hearer and (met := team.match(team.of("joining"), text)):
        text = f"{team.hearer} and {met['some']} meet {met['where']}"
    told = rf"^{team.names},? (?:please )?(?=(?:tell|ask|let|have|get) {team.names}\b)"
    return re.sub(told, "", text, flags=re.IGNORECASE)


def counted(team: Wording, wish: TeamWish, message: str) -> TeamWish:
    """With how many robots are spoken of: "you two" are those that have no part of their own."""
    count, named = team.count(plain_words(message)), {part.robot for part in wish.parts if part.robot}
    if not named or count != len(team.robots) - len(named):
        return replace(wish, count=0 if named == {*team.robots.values()} else count)
    parts = (replace(part, without=(*named,)) if part.who == "all" else part for part in wish.parts)
    return replace(wish, parts=tuple(parts))
