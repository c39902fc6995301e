"""Work that all of a team share: "check all doors, split between you", "then meet at the gate"."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Final

from parley.language.builtin.lexicon import lexicon
from parley.team.parted import part_of, parts_in
from parley.team.wish import Part, TeamWish
from parley.team.wording import Wording, acts, goes, in_base_form

__all__ = ["share_in", "shared"]

_THEM: Final = r"(?:them|those|each(?: of them)?|it)"
_CUTS: Final = 4
"""So many of the last pieces of a sentence may say where all are behind their work."""


def share_in(team: Wording, text: str) -> TeamWish | None:
    """Work that all do together, each a part."""
    return _ended(team, text) or _divided(team, text)


def _ended(team: Wording, text: str) -> TeamWish | None:
    """Such work, and where all of them are behind it: "... between you, then meet at the gate"."""
    text = re.sub(rf",? {team.of('through_all')}$", "", text, flags=re.IGNORECASE)
    others = rf"(?:{team.of('rest')}|the (?:second|third|fourth|last)(?: one| robot)?)"
    stays = team.match(rf"(?P<work>.+?)(?:[,;.]| and)+ {others} {team.of('staying')}", text)
    if stays and (head := _divided(team, stays["work"])) and head.one_each and not head.bare:
        return replace(head, parts=(*head.parts, Part("rest", "", stays=True)))
    lead = rf"(?:{team.of('then')},? )?(?:{team.of('through_all')},? )?"
    them = rf"(?:(?:{team.of('all')}|{team.of('each')}|you),? (?:{team.of('modal')} )*)?"
    gaps = rf"(?:[,;.:!]+(?: and)?|(?<=\w) and) {lead}{them}"
    for gap in [*re.finditer(gaps, text, re.IGNORECASE)][-_CUTS:]:
        head = _divided(team, text[: gap.start()])
        last = part_of(team, "each", "", text[gap.end() :], after=True, known=()) if head else None
        if head and last and not head.bare and (last.home or goes(last.order)):
            return replace(head, parts=(*head.parts, replace(last, without=head.parts[0].without)))
    return None


def _divided(team: Wording, text: str) -> TeamWish | None:
    between, split, that = team.of("between"), team.of("split"), team.of("that")
    if team.match(rf"{split} {that}(?: up)?(?: {between})?", text):
        return shared("")
    and_then = r"(?:(?:,? and|,) (?P<order>.+))?"
    if found := team.match(rf"{split} (?P<what>.+?)(?: up| out)? {between}{and_then}", text):
        what, order = found["what"], found["order"]
        if order is None:
            return TeamWish("share", (Part("all", what),), bare=True)
        return shared(re.sub(rf"\b{_THEM}\b", what, order))
    if found := team.match(
        rf"(?P<order>.+?),?(?: and)?(?: (?:{split}|sharing|splitting|dividing))?(?: {that})?(?: up| out)?"
        rf" {between}",
        text,
    ):
        return shared(found["order"])
    if found := team.match(rf"{split} (?:and|{that}(?: up)?(?: {between})?:) ?(?P<order>.+)", text):
        return shared(found["order"])
    if found := team.match(rf"{split} (?P<what>(?:the|these|those|all) \w+(?: \w+)?)", text):
        return TeamWish("share", (Part("all", found["what"]),), bare=True)
    if found := team.match(rf"(?P<order>.+?),? {team.of('anybody')}", text):
        one = re.match(rf"{team.of('one')}\b", found["order"], re.IGNORECASE)
        return parts_in(team, found["order"], asks=False, alone=False) if one else shared(found["order"])
    some = rf"(?P<some>{team.names}(?:(?:,? and|,) {team.names})+),?(?: {team.of('modal')})?"
    if found := team.match(rf"{some} (?P<order>.+?),? (?:between|among) (?:them|themselves)", text):
        return shared(found["order"], tuple({*team.robots.values()} - {*team.called(found["some"])}))
    some = some.removesuffix(f"(?: {team.of('modal')})?")
    if found := team.match(rf"{some} {split} (?P<what>(?!the work)\w+ .+|\w+)", text):
        out = tuple({*team.robots.values()} - {*team.called(found["some"])})
        return TeamWish("share", (Part("all", found["what"], without=out),), bare=True)
    if found := team.match(r"(?:all )?work together,?(?: and| to|:)? (?P<order>.+)", text):
        return shared(found["order"])
    if (found := team.match(rf"{team.of('apart')},?(?: and| to|:)? (?P<order>.+)", text)) and acts(
        found["order"]
    ):
        return shared(found["order"])
    return _at_last(team, text) or _one_per(team, text) or _one_each(team, text)


def _at_last(team: Wording, text: str) -> TeamWish | None:
    """Work of which it is said behind it, or behind a part of it, that it is to be shared."""
    between, split, that = team.of("between"), team.of("split"), team.of("that")
    them = rf"(?P<verb>\w+) {_THEM}(?P<more> for .+)?"
    if found := team.match(rf"{split} (?P<what>.+?)(?: up| out)?,?(?: and)? {them}", text):
        order = f"{found['verb']} {found['what']}{found['more'] or ''}"
        return shared(order) if acts(order) else None
    found = team.match(rf"(?P<order>.+?)(?:,? and|[,;.:]) {split} {that}(?: up| out)?", text)
    found = found or team.match(rf"(?P<order>.+?) {between}(?P<more>,? and .+)", text)
    if found is None or not acts(found["order"]):
        return None
    return shared(found["order"] + (found.groupdict().get("more") or ""))


def _one_per(team: Wording, text: str) -> TeamWish | None:
    """A robot for each of some things: "one robot per area", "a robot at each door"."""
    per = team.of("oneper")
    found = team.match(per, text) or team.match(rf"{team.of('posting')} {per}", text)
    if found:
        what = found["what"] or found["what2"] or found["what3"]
        if team.match(per, text) and not team.match(r".+ (?:in|at|to|by) (?:each|every) .+", text):
            return TeamWish("share", (Part("all", f"each {what}"),), bare=True)
        return TeamWish("share", (Part("all", f"go to every {what}"),), one_each=True)
    if found := team.match(rf"(?P<order>.+?),?(?: and| with)? {per}", text):
        return TeamWish("share", (Part("all", found["order"]),), one_each=True) if acts(text) else None
    each = rf"(?:send )?(?:{team.of('each')}|{team.of('all')}),?(?: goes| go)? to"
    if found := team.match(rf"{each} (?:a (?:different|separate)|an(?:other)?(?: own)?) (?P<what>\w+)", text):
        return TeamWish("share", (Part("all", f"go to every {found['what']}"),), one_each=True)
    takes = r"(?:takes?|gets?|picks?) (?:an?|one) (?P<what>\w+)(?: each)?"
    found = team.match(rf"(?:{team.of('each')}|{team.of('all')}),? {takes}", text)
    return TeamWish("share", (Part("all", f"each {found['what']}"),), bare=True) if found else None


def _one_each(team: Wording, text: str) -> TeamWish | None:
    """Work of which nobody takes more than one."""
    takes = rf"{team.of('each')},? (?:takes?|gets?|does|do) one(?: of them)?"
    each = rf"(?:one(?: robot)? each|one apiece|one(?: robot)? for each(?: of (?:you|them))?|{takes})"
    if found := team.match(rf"(?P<order>.+?),?(?: and)? {each}", text):
        return TeamWish("share", (Part("all", found["order"]),), one_each=True)
    takes = r"(?:takes?|picks?|chooses?|gets?) (?:one|an?|a different) (?P<what>\w+)(?: each)?"
    tells = r"(?:tells?|shows?) (?:me|us) what(?:'s| is| you| it| they| there).*"
    sees = r"(?:sees?|checks?|looks?|finds? out) (?:if|whether|what|for) .+"
    then = rf"(?:(?P<verb>\w+) it|{tells}|{sees}|(?:has|have) a look)"
    takes = rf"{team.of('each')},? {takes},? and {then}"
    if found := team.match(takes, text):
        order = f"{in_base_form(found['verb'] or 'check')} every {found['what']}"
        return TeamWish("share", (Part("all", order),), one_each=True)
    one = r"(?P<verb>\w+(?: \w+)?) {} (?P<what>\w+(?: \w+){{0,2}}){}"
    each = rf"(?:{team.of('each')}|{team.of('all')}),? {one.format('a (?:different|separate)', '')}"
    found = team.match(one.format("one(?: of the)?", " each"), text) or team.match(each, text)
    if found and (found["verb"].split()[0].lower(),) in lexicon().verbs:
        return TeamWish("share", (Part("all", f"{found['verb']} every {found['what']}"),), one_each=True)
    return None


def shared(order: str, without: tuple[str, ...] = ()) -> TeamWish:
    """Work of all but those that are left out of it."""
    return TeamWish("share", (Part("all", order, without=without),))
