"""What is said to several robots as a team: who of them is to do what, or which of them is asked about.

Only the way in which the work is spread is read here. The work itself ("check the boxes") is left in the
person's words, to be understood as if it were said to one robot. Words stand in `wishes.yaml`.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Final, Literal

from parley.files import words_in
from parley.gate.control import behind_stop, control_of, stops_all
from parley.gate.stop_words import calls_to_stop, has_stop_word, only_waits
from parley.language.builtin.answers import sought
from parley.language.builtin.lexicon import lemmas, lexicon
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import asks, plain, question_of

__all__ = [
    "Part",
    "TeamWish",
    "asked_by_name",
    "gathered",
    "is_in_turn",
    "is_of_several",
    "is_unread",
    "team_wish",
    "turned_wish",
]


Who = Literal["one", "some", "rest", "all", "each", "named"]
_WHO: Final[tuple[Who, ...]] = ("one", "some", "rest", "each", "all", "named")


@dataclass(frozen=True, slots=True)
class Part:
    """What some robots are to do."""

    who: Who
    order: str
    """In words that one robot understands; empty: what was said last, or (with `home`) going back."""
    robot: str = ""
    """For `named`."""
    after: bool = False
    """Whether it waits until the part before it is done."""
    of: str = ""
    """Whose work it is that is taken over."""
    count: int = 1
    """For `some`: how many."""
    nearest: bool = False
    """For `one`: whoever has the shortest way, and nobody else."""
    without: tuple[str, ...] = ()
    """Robots that are left out of it by name."""
    home: bool = False
    """Whether it is to go back, and it is not said where to."""
    fullest: bool = False
    """For `one`: whoever has most left in its battery."""
    idle: bool = False
    """For `one`: somebody who has nothing to do, if there is one."""
    stays: bool = False
    """Whether it is to do nothing."""
    awaits: str = ""
    """The robot that has to be done with what it is at before."""
    instead: bool = False
    """Whether it does what the hearer, or `of`, has to do."""
    alike: str = ""
    """What the words may mean if nobody understands them: the same as others do."""

    @property
    def of_before(self) -> bool:
        """Whether it is what was said before, or is at work already."""
        return not (self.order or self.alike or self.home or self.of or self.stays)


@dataclass(frozen=True, slots=True)
class TeamWish:
    """How a message spreads work over robots, or what it asks about them."""

    kind: Literal[
        "share",
        "parts",
        "nearest",
        "about",
        "why",
        "swap",
        "progress",
        "drop",
        "bar",
        "judged",
        "help",
        "alone",
        "stranger",
    ]
    parts: tuple[Part, ...] = ()
    """For `share` one, of all, and perhaps where each goes behind it; for `swap` those that are named; for
    `bar` where each of them shall not go; of several robots, for `about`, what each is asked."""
    about: str = ""
    """For `nearest` the place, for `about` the question as that robot would be asked, for `progress` what was
    asked of, if not all of it, for `judged` words that judge nothing, for `stranger` who is no robot here."""
    robot: str = ""
    """For `about`, empty: each of them is asked. For `why` who was chosen or was not, if one is named. For
    `drop` whose part is given up, for `help` whose work it is."""
    one_each: bool = False
    """For `share`: nobody takes more than one."""
    count: int = 0
    """How many robots are spoken of ("you two"); 0: that is not said."""
    bare: bool = False
    """Only things are named, not what is to be done there."""
    anew: bool = False
    """Whether what was wanted before is wanted no more."""
    otherwise: TeamWish | None = None
    """For `progress`: what it asks if no such work is known."""
    turns: Literal["", "done", "asked"] = ""
    """Behind words of stopping, it comes in place of what its doers are at: at once, or after a yes."""


_SEVERAL: Final = re.compile(r"\b(?:all|every|each|both|any|two|three|four|five|six|[2-9])\b", re.IGNORECASE)
_IN_TURN: Final = re.compile(
    r"\b(?:then|first|after|afterwards|before|finally|next|second|until|when|once|if)\b", re.IGNORECASE
)


def is_of_several(order: str) -> bool:
    """Whether words speak of several things as a set, which may be shared without another word."""
    return _SEVERAL.search(order) is not None


def is_in_turn(order: str) -> bool:
    """Whether words say in which order things are to be done, so that they are not shared."""
    return _IN_TURN.search(order) is not None


def team_wish(message: str, robots: Sequence[str], hearer: str = "") -> TeamWish | None:
    """How a message is meant for a team; None if it says nothing of one.

    Args:
        message: What was said.
        robots: Who is there; a team has at least two.
        hearer: Whom "you" means, where one robot hears it.
    """
    if len(robots) < 2:
        return None
    words = _Words(tuple(robots), hearer)
    wish = words.wish(message)
    if wish is None or any(calls_to_stop(part.order) or control_of(part.order) for part in wish.parts):
        return None  # stopping has its own way
    if not any(part.stays for part in wish.parts) and calls_to_stop(message):
        return None
    return words.counted(wish, message)


def turned_wish(message: str, robots: Sequence[str], hearers: Sequence[str]) -> TeamWish | None:
    """The order behind words of stopping: "stop, Ada go to the gate", "no wait, all of you back".

    None if there is none, or if whoever hears it reads it for itself: "wait, not that one".
    """
    words = _Words(tuple(robots), hearers[0] if len(hearers) == 1 else "")
    for head, rest in behind_stop(message, tuple(robots)) if has_stop_word(message) else ():
        turns: Literal["done", "asked"] = "done" if only_waits(head) else "asked"
        waits = turns == "done" and "then" in message[len(head) : -len(rest)]  # "wait a minute, then ..."
        called = re.match(rf"{words.of('all')}\s*[,.;:!–-]", rest, re.IGNORECASE)  # "stop everyone! ..."
        if waits or called or calls_to_stop(rest) or control_of(rest, tuple(robots)):
            continue
        wish = words.wish(rest, alone=True) if len(robots) > 1 else None
        if wish is not None and wish.kind in ("parts", "share", "swap"):
            return replace(words.counted(wish, rest), turns=turns)
        order = words.begun(_plain(rest))
        if turns == "asked" and hearers and _acts(order):
            out = tuple(name for name in robots if name not in hearers)
            part = Part("named", order, hearers[0]) if len(hearers) == 1 else Part("all", order, without=out)
            part = Part("all", order) if stops_all(head) and len(robots) > 1 else part
            return TeamWish("parts", (part,), turns=turns)
    return None


def is_unread(message: str, robots: Sequence[str]) -> str | None:
    """What of words to a team that `team_wish` does not read it reads; None: they are not to a team."""
    if len(robots) < 2:
        return None
    words = _Words(tuple(robots))
    tails = (message[cut.end() :] for cut in re.finditer(r"[,;:.!–—-]\s+", message))
    read = next(
        (tail for tail in tails if (wish := words.wish(tail)) and any(part.order for part in wish.parts)), ""
    )
    return read if read or re.search(rf"\b{words.of('group')}\b", message, re.IGNORECASE) else None


def asked_by_name(message: str, robots: Sequence[str], hearer: str) -> TeamWish | None:
    """A question that calls one robot, heard by another one: that cannot answer for it."""
    words = _Words(tuple(robots))
    text = words.begun(_plain(message))
    found = words.calling(text)
    if found is None or found[0] == hearer:
        return None
    bare = plain(tokenize(found[1]))
    if question_of(bare) is None or not asks(message, bare):
        return None
    return TeamWish("about", about=f"{found[1]}?", robot=found[0])


@cache
def _data() -> dict[str, list[str]]:
    return {
        name: text.splitlines()
        for name, text in words_in("parley.team", "wishes").items()
        if isinstance(text, str)
    }


class _Words:
    """The patterns, for robots of these names."""

    def __init__(self, robots: tuple[str, ...], hearer: str = "") -> None:
        self._robots = {name.lower(): name for name in robots}
        self._hearer = hearer

    def wish(self, message: str, *, alone: bool = False) -> TeamWish | None:
        """How a message is meant for a team; `alone`: or for one that is named."""
        asks = message.rstrip().endswith("?")
        text = _plain(message)
        bare = self._respective(self._awaiting(self._called_as_team(self.begun(text))))
        opened = self._match(
            rf"(?:{self.of('lead')} )?{self.of('afresh')}(?:[,;:.!]+(?: and| but)?| and) (?P<rest>.+)", bare
        )
        wish = self._progress(self.begun(text), asks=asks) or self._told_of_one(text) or self.about(text)
        wish = wish or self._read(bare, asks=asks, alone=alone)
        sparing = self._sparing(bare)
        if sparing is not None and (wish is None or self._called(sparing.parts[0].order) == ()):
            return sparing
        after = self.wish(opened["rest"], alone=True) if opened else None
        if after is not None and after.kind not in ("about", "nearest", "why"):
            return replace(after, anew=after.kind != "swap" and not any(part.instead for part in after.parts))
        return wish

    def _read(self, text: str, *, asks: bool, alone: bool) -> TeamWish | None:
        """How work is spread, or spread otherwise than before."""
        if self._match(self.of("swapping"), text):
            named = self._called(text)
            two = len(named) in (0, 2)
            return TeamWish("swap", tuple(Part("named", "", name) for name in named)) if two else None
        return (
            self._alone(text)
            or self._helping(text)
            or self._judged(text)
            or self._other(text)
            or self._taken_over(text)
            or self.share(text)
            or self._bare(text, asks=asks)
            or self.parts(text, asks=asks, alone=alone)
        )

    def _progress(self, text: str, *, asks: bool) -> TeamWish | None:
        """How far the work is, or whether something of it is done."""
        if self._match(self.of("progress"), text):
            return TeamWish("progress", otherwise=TeamWish("about", about="what is left to do?"))
        found = self._match(self.of("checked"), text) if asks else None
        what = next(filter(None, found.groups()), "") if found else ""
        if not what or self._called(what):
            return None
        return TeamWish("progress", about=what.strip(), otherwise=self.about(text))

    def _told_of_one(self, text: str) -> TeamWish | None:
        """What one of the team is to do no more, or nowhere near something."""
        text = self.begun(re.sub(rf"^{self.of('afresh')},? ", "", text, flags=re.IGNORECASE))
        if found := self._match(self.of("dropping"), text):
            return TeamWish("drop", robot=next(iter(self._called(text))))
        found = self._match(self.of("barring"), text)
        named = {key[:5]: value for key, value in found.groupdict().items() if value} if found else {}
        if found is None or not (robots := self._called(named["robot"])):
            return None
        how = "drive near" if re.search(r"\b(?:near|close)\b", text, re.IGNORECASE) else "go into"
        parts = (Part("named", f"you must not {how} {named['place']}", name) for name in robots)
        return TeamWish("bar", tuple(parts))

    def _alone(self, text: str) -> TeamWish | None:
        """One of the team and nobody else, where nothing is said of what it is to do."""
        found = self._match(self.of("alone"), text)
        return TeamWish("alone", robot=next(iter(self._called(text)))) if found else None

    def _helping(self, text: str) -> TeamWish | None:
        """One that is to help another one."""
        if (found := self._match(self.of("helping"), text)) is None:
            return None
        who = self._robots.get((found["who"] or found["who2"] or "").lower(), self._hearer)
        of = self._robots[(found["of"] or found["of2"]).lower()]
        return TeamWish("help", (Part("named", "", who),), robot=of) if who and who != of else None

    def _judged(self, text: str) -> TeamWish | None:
        """A part that depends on what another one finds, which nobody waits for."""
        who = rf"(?:{self._names}|{self.of('rest')}|{self.of('all')})"
        judging = rf"{self.of('judging')},?(?: then)? (?={who}\b)"
        first = re.match(judging, text, re.IGNORECASE)
        if first is not None and self._pieces(told := text[first.end() :]):
            return TeamWish("judged", about=told, bare=True)
        found = re.search(rf"(?<=[,;. ]){judging}", text, re.IGNORECASE)
        if found is None or not self._pieces(told := f"{text[: found.start()]}then {text[found.end() :]}"):
            return None
        return TeamWish("judged", about=told)

    def _awaiting(self, text: str) -> str:
        """What somebody does after waiting for another one, or as it is through, as it is said of a part."""
        if (found := self._match(self.of("free"), text)) is not None:
            return f"let {found['robot']} {found['order']}"
        itself = rf"(?P<when>{self.of('when')}),? (?:it|he|she) (?P<order>.+)"
        if (found := self._match(itself, text)) and len(named := self._called(found["when"])) == 1:
            return f"let {named[0]} {found['order']}"
        who = self._names + ("|you" if self._hearer else "")
        waits = rf"(?:(?P<who>{who}),? )?{self.of('awaiting')}"
        found = self._match(waits, text)
        if found and (doer := found["who"] or self._hearer):
            return f"when {found['of']} is done, {doer} {found['order']}"
        found = self._match(rf"(?P<who>{who}),? (?P<when>{self.of('when')}),? (?P<order>.+)", text)
        if found and self._called(found["when"]):
            return f"{found['when']}, {found['who']} {found['order']}"
        return text

    def _respective(self, text: str) -> str:
        """Who does which of several things, told as one part after the other."""
        some = rf"(?P<some>{self._names}(?:(?:,? and|,) {self._names})+),?(?: {self.of('modal')})?"
        found = self._match(rf"{some} (?P<order>.+?),? (?:respectively|in (?:that|this) order)", text)
        if found is None:
            return text
        names, orders = self._called(found["some"]), re.split(r",? and |, ", found["order"])
        orders[1:] = [one if _acts(one) else f"{_opened(orders[0])} {one}" for one in orders[1:]]
        if len(names) != len(orders):
            return text
        return ", ".join(f"{name} {order}" for name, order in zip(names, orders, strict=True))

    def _sparing(self, text: str) -> TeamWish | None:
        """Work for all but those who are to have no part in it."""
        found = self._match(rf"{self.of('sparing')}(?:[,;:.] ?(?:and |but )?| and )(?P<rest>.+)", text)
        found = found or self._match(rf"(?P<rest>.+?){self.of('spared')}", text)
        if found is None:
            return None
        said = " ".join(value for name, value in found.groupdict().items() if value and name[:3] == "out")
        out, rest = self._called(said), found["rest"]
        wish = self.wish(rest, alone=True)
        if wish is None and is_of_several(rest) and (rest.split(" ")[0].lower(),) in lexicon().verbs:
            wish = _shared(rest)
        if wish is None or any(part.robot for part in wish.parts):
            return None
        parts = (replace(part, without=(*part.without, *out)) for part in wish.parts)
        return replace(wish, parts=tuple(parts))

    def _other(self, text: str) -> TeamWish | None:
        """Another robot than the one that has it now."""
        found = self._match(self.of("instead"), text)
        if found is None:
            return None
        robot, of = (
            next((self._robots[value.lower()] for name, value in found.groupdict().items()
                  if value and re.fullmatch(rf"{key}\d*", name)), "")
            for key in ("robot", "of")
        )  # fmt: skip
        return TeamWish("parts", (Part("named", "", robot, of=of, instead=True),)) if robot != of else None

    def _called_as_team(self, text: str) -> str:
        """Without what only calls: "Ada and Kim, you two go", "Ada, tell Kim to go"."""
        some = rf"{self._names}(?:(?:,? and|,) {self._names})+"
        text = re.sub(
            rf"^({some}),? you(?: two| three| both| all)?,? (?=\w)", r"\1 ", text, flags=re.IGNORECASE
        )
        text = re.sub(
            rf"\b({self._names}),? you (?!two|three|both|all)(?=\w)", r"\1 ", text, flags=re.IGNORECASE
        )
        text = _WANTED.sub(r"check \g<what>", text)
        if self._hearer and (met := self._match(self.of("joining"), text)):
            text = f"{self._hearer} and {met['some']} meet {met['where']}"
        told = rf"^{self._names},? (?:please )?(?=(?:tell|ask|let|have|get) {self._names}\b)"
        return re.sub(told, "", text, flags=re.IGNORECASE)

    def counted(self, wish: TeamWish, message: str) -> TeamWish:
        """With how many robots are spoken of: "you two" are those that have no part of their own."""
        count, named = self.count(_plain(message)), {part.robot for part in wish.parts if part.robot}
        if not named or count != len(self._robots) - len(named):
            return replace(wish, count=0 if named == {*self._robots.values()} else count)
        parts = (replace(part, without=(*named,)) if part.who == "all" else part for part in wish.parts)
        return replace(wish, parts=tuple(parts))

    def of(self, name: str) -> str:
        """A list as one pattern."""
        filled = "|".join(sorted(_data()[name], key=len, reverse=True))
        filled = re.sub(r"(?<!\?P)<(\w+)>", lambda found: self.of(found[1]), filled)
        some = f"{self._names}(?:(?:,? and|,? or|,) {self._names})*"
        return f"(?:{filled.replace('{robots}', some).replace('{robot}', self._names)})"

    @property
    def _names(self) -> str:
        return f"(?:{'|'.join(re.escape(name) for name in self._robots)})"

    def _match(self, pattern: str, text: str) -> re.Match[str] | None:
        return re.fullmatch(pattern, text, re.IGNORECASE)

    def begun(self, text: str) -> str:
        """Without what only opens a sentence."""
        while found := re.match(rf"{self.of('lead')}(?:\s+|(?<=[ ,]))", text, re.IGNORECASE):
            text = text[found.end() :]
        return text

    def count(self, text: str) -> int:
        """How many robots a message speaks of."""
        told = "|".join(self.of(name) for name in ("all", "each", "one", "between"))
        said = " ".join(found[0] for found in re.finditer(rf"\b(?:{told})\b", text, re.IGNORECASE)).lower()
        return next((number for word, number in _NUMBERS.items() if word in said.split()), 0)

    def calling(self, text: str) -> tuple[str, str] | None:
        """The one robot that is called, first or behind a comma at the end, and what else is said."""
        names = re.findall(rf"\b{self._names}\b", text, re.IGNORECASE)
        found = self._match(rf"(?P<robot>{self._names})\W+(?P<said>.+)", text) or self._match(
            rf"(?P<said>.+?), ?(?P<robot>{self._names})", text
        )
        return (self._robots[found["robot"].lower()], found["said"]) if found and len(names) == 1 else None

    # -- questions -------------------------------------------------------------------------------------

    def about(self, text: str) -> TeamWish | None:
        """A question about robots: who is nearest, what another one is doing."""
        bare = self.begun(text)
        for pattern in _data()["nearest"]:
            if found := self._match(pattern.replace("{robot}", self._names), bare):
                return TeamWish("nearest", about=found["place"])
        if found := self._match(self.of("chosen"), bare):
            return TeamWish("why", robot=self._robots.get((found["robot"] or "").lower(), ""))
        for name, asked in _OF_ONE.items():
            if self._match(self.of(name), bare):
                return TeamWish("about", about=asked, robot=self._called(bare)[0])
        for name, asked in _OF_ALL.items():
            if self._match(self.of(name), bare):
                return TeamWish("about", about=asked)
        if (places := self._whereabouts(bare)) is not None:
            return places
        together = self._all_together(bare)
        called = rf"{self._names}\b.*|.*(?<!\bis)(?<!\bwas)(?<!'s)\W{self._names}"
        named = re.findall(rf"\b{self._names}\b", bare, re.IGNORECASE)
        if not together and (len(named) > 1 or (named and self._match(called, bare))):
            return None
        which = re.sub(rf"^{self.of('which')} (\w+)", r"\1 you", bare, flags=re.IGNORECASE)
        whom = re.escape(together or named[0]) if named else self.of("asked")
        asked = which if which != bare else re.sub(rf"\b{whom}\b", "you", bare, flags=re.IGNORECASE)
        for third, second in _SECOND.items():
            asked = re.sub(
                rf"(?:\b{third}|(?<=\w){third}) you\b", f"{second} you", asked, flags=re.IGNORECASE
            )
        has = re.sub(r"\bare you\b", "have you", asked)  # "what's Ada found?"
        asked = next((one for one in (asked, has) if question_of(plain(tokenize(one)))), "")
        if not asked or asked == bare:
            return None
        parts = (Part("named", f"{asked}?", robot) for robot in self._called(together))
        one = self._robots[named[0].lower()] if named and not together else ""
        return TeamWish("about", tuple(parts), about=f"{asked}?", robot=one)

    def _whereabouts(self, text: str) -> TeamWish | None:
        """Where robots are, and things beside them: "where are Ada and the box?"."""
        each = sought(text)
        robots = [self._robots[one.lower()] for one in each if one.lower() in self._robots]
        things = [one for one in each if one.lower() not in self._robots]
        if not robots or not self._hearer or (things and self._hearer in robots):
            return None
        parts = [Part("named", "where are you?", robot) for robot in robots]
        if things:
            parts.append(Part("named", f"where are {' and '.join(things)}?", self._hearer))
        return TeamWish("about", tuple(parts))

    def _all_together(self, text: str) -> str:
        """Several robots of which one thing is asked, as they are named: "what are Ada and Kim doing"."""
        found = re.search(rf"(?<=\w ){self._names}(?:(?:,? and|,) {self._names})+\b", text, re.IGNORECASE)
        return found[0] if found and self._called(found[0]) == self._called(text) else ""

    # -- sharing ---------------------------------------------------------------------------------------

    def share(self, text: str) -> TeamWish | None:
        """Work that all do together, each a part."""
        return self._ended(text) or self._divided(text)

    def _ended(self, text: str) -> TeamWish | None:
        """Such work, and where all of them are behind it: "... between you, then meet at the gate"."""
        text = re.sub(rf",? {self.of('through_all')}$", "", text, flags=re.IGNORECASE)
        others = rf"(?:{self.of('rest')}|the (?:second|third|fourth|last)(?: one| robot)?)"
        stays = self._match(rf"(?P<work>.+?)(?:[,;.]| and)+ {others} {self.of('staying')}", text)
        if stays and (head := self._divided(stays["work"])) and head.one_each and not head.bare:
            return replace(head, parts=(*head.parts, Part("rest", "", stays=True)))
        lead = rf"(?:{self.of('then')},? )?(?:{self.of('through_all')},? )?"
        them = rf"(?:(?:{self.of('all')}|{self.of('each')}|you),? (?:{self.of('modal')} )*)?"
        gaps = rf"(?:[,;.:!]+(?: and)?|(?<=\w) and) {lead}{them}"
        for gap in [*re.finditer(gaps, text, re.IGNORECASE)][-_CUTS:]:
            head = self._divided(text[: gap.start()])
            last = self._part("each", "", text[gap.end() :], after=True, known=()) if head else None
            if head and last and not head.bare and (last.home or _goes(last.order)):
                return replace(head, parts=(*head.parts, replace(last, without=head.parts[0].without)))
        return None

    def _divided(self, text: str) -> TeamWish | None:
        between, split, that = self.of("between"), self.of("split"), self.of("that")
        if self._match(rf"{split} {that}(?: up)?(?: {between})?", text):
            return _shared("")
        and_then = r"(?:(?:,? and|,) (?P<order>.+))?"
        if found := self._match(rf"{split} (?P<what>.+?)(?: up| out)? {between}{and_then}", text):
            what, order = found["what"], found["order"]
            if order is None:
                return TeamWish("share", (Part("all", what),), bare=True)
            return _shared(re.sub(rf"\b{_THEM}\b", what, order))
        if found := self._match(
            rf"(?P<order>.+?),?(?: and)?(?: (?:{split}|sharing|splitting|dividing))?(?: {that})?(?: up| out)?"
            rf" {between}",
            text,
        ):
            return _shared(found["order"])
        if found := self._match(rf"{split} (?:and|{that}(?: up)?(?: {between})?:) ?(?P<order>.+)", text):
            return _shared(found["order"])
        if found := self._match(rf"{split} (?P<what>(?:the|these|those|all) \w+(?: \w+)?)", text):
            return TeamWish("share", (Part("all", found["what"]),), bare=True)
        if found := self._match(rf"(?P<order>.+?),? {self.of('anybody')}", text):
            one = re.match(rf"{self.of('one')}\b", found["order"], re.IGNORECASE)
            return self.parts(found["order"], asks=False, alone=False) if one else _shared(found["order"])
        some = rf"(?P<some>{self._names}(?:(?:,? and|,) {self._names})+),?(?: {self.of('modal')})?"
        if found := self._match(rf"{some} (?P<order>.+?),? (?:between|among) (?:them|themselves)", text):
            return _shared(found["order"], tuple({*self._robots.values()} - {*self._called(found["some"])}))
        some = some.removesuffix(f"(?: {self.of('modal')})?")
        if found := self._match(rf"{some} {split} (?P<what>(?!the work)\w+ .+|\w+)", text):
            out = tuple({*self._robots.values()} - {*self._called(found["some"])})
            return TeamWish("share", (Part("all", found["what"], without=out),), bare=True)
        if found := self._match(r"(?:all )?work together,?(?: and| to|:)? (?P<order>.+)", text):
            return _shared(found["order"])
        if (found := self._match(rf"{self.of('apart')},?(?: and| to|:)? (?P<order>.+)", text)) and _acts(
            found["order"]
        ):
            return _shared(found["order"])
        return self._at_last(text) or self._one_per(text) or self._one_each(text)

    def _at_last(self, text: str) -> TeamWish | None:
        """Work of which it is said behind it, or behind a part of it, that it is to be shared."""
        between, split, that = self.of("between"), self.of("split"), self.of("that")
        them = rf"(?P<verb>\w+) {_THEM}(?P<more> for .+)?"
        if found := self._match(rf"{split} (?P<what>.+?)(?: up| out)?,?(?: and)? {them}", text):
            order = f"{found['verb']} {found['what']}{found['more'] or ''}"
            return _shared(order) if _acts(order) else None
        found = self._match(rf"(?P<order>.+?)(?:,? and|[,;.:]) {split} {that}(?: up| out)?", text)
        found = found or self._match(rf"(?P<order>.+?) {between}(?P<more>,? and .+)", text)
        if found is None or not _acts(found["order"]):
            return None
        return _shared(found["order"] + (found.groupdict().get("more") or ""))

    def _one_per(self, text: str) -> TeamWish | None:
        """A robot for each of some things: "one robot per area", "a robot at each door"."""
        per = self.of("oneper")
        found = self._match(per, text) or self._match(rf"{self.of('posting')} {per}", text)
        if found:
            what = found["what"] or found["what2"] or found["what3"]
            if self._match(per, text) and not self._match(r".+ (?:in|at|to|by) (?:each|every) .+", text):
                return TeamWish("share", (Part("all", f"each {what}"),), bare=True)
            return TeamWish("share", (Part("all", f"go to every {what}"),), one_each=True)
        if found := self._match(rf"(?P<order>.+?),?(?: and| with)? {per}", text):
            return TeamWish("share", (Part("all", found["order"]),), one_each=True) if _acts(text) else None
        each = rf"(?:send )?(?:{self.of('each')}|{self.of('all')}),?(?: goes| go)? to"
        if found := self._match(
            rf"{each} (?:a (?:different|separate)|an(?:other)?(?: own)?) (?P<what>\w+)", text
        ):
            return TeamWish("share", (Part("all", f"go to every {found['what']}"),), one_each=True)
        takes = r"(?:takes?|gets?|picks?) (?:an?|one) (?P<what>\w+)(?: each)?"
        found = self._match(rf"(?:{self.of('each')}|{self.of('all')}),? {takes}", text)
        return TeamWish("share", (Part("all", f"each {found['what']}"),), bare=True) if found else None

    def _one_each(self, text: str) -> TeamWish | None:
        """Work of which nobody takes more than one."""
        takes = rf"{self.of('each')},? (?:takes?|gets?|does|do) one(?: of them)?"
        each = rf"(?:one(?: robot)? each|one apiece|one(?: robot)? for each(?: of (?:you|them))?|{takes})"
        if found := self._match(rf"(?P<order>.+?),?(?: and)? {each}", text):
            return TeamWish("share", (Part("all", found["order"]),), one_each=True)
        takes = r"(?:takes?|picks?|chooses?|gets?) (?:one|an?|a different) (?P<what>\w+)(?: each)?"
        tells = r"(?:tells?|shows?) (?:me|us) what(?:'s| is| you| it| they| there).*"
        sees = r"(?:sees?|checks?|looks?|finds? out) (?:if|whether|what|for) .+"
        then = rf"(?:(?P<verb>\w+) it|{tells}|{sees}|(?:has|have) a look)"
        takes = rf"{self.of('each')},? {takes},? and {then}"
        if found := self._match(takes, text):
            order = f"{_in_base_form(found['verb'] or 'check')} every {found['what']}"
            return TeamWish("share", (Part("all", order),), one_each=True)
        one = r"(?P<verb>\w+(?: \w+)?) {} (?P<what>\w+(?: \w+){{0,2}}){}"
        each = rf"(?:{self.of('each')}|{self.of('all')}),? {one.format('a (?:different|separate)', '')}"
        found = self._match(one.format("one(?: of the)?", " each"), text) or self._match(each, text)
        if found and (found["verb"].split()[0].lower(),) in lexicon().verbs:
            return TeamWish("share", (Part("all", f"{found['verb']} every {found['what']}"),), one_each=True)
        return None

    # -- parts -----------------------------------------------------------------------------------------

    def parts(self, text: str, *, asks: bool, alone: bool) -> TeamWish | None:
        """Who is to do what, one part after the other as it was said."""
        anyone = "|".join(self.of(who) for who in ("one", "some", "all", "each"))
        text = self._recalled(text)
        if found := self._match(rf"{self.of('handing')} (?P<rest>(?:{anyone}) .+)", text):
            text = found["rest"]
        if self._hearer and (
            found := self._match(rf"{self.of('handing')} {self.of('rest')} (?P<order>.+)", text)
        ):
            rest = self._part("rest", "", found["order"], after=False, known=())
            spoken_to = (self._hearer,)  # "tell the others to come": all but the one that hears it
            return TeamWish("parts", (replace(rest, without=spoken_to),)) if rest is not None else None
        if found := self._match(rf"(?P<order>.+?),? with (?P<some>{self.of('some')})", text):
            text = f"{found['some']} {found['order']}"
        others = rf"(?:{anyone}|{self.of('rest')}|{self._names})"
        text = re.sub(rf"((?:[,;:.]|\band|\bbut) ){self.of('handing')} (?={others}\b)", r"\1", text)
        handing = (
            rf"(?:{self.of('handing')} (?P<robot>{self._names})|(?P<own>{self._names}) {self.of('duty')})"
        )
        found = self._match(rf"{handing} (?P<order>.+)", text)
        if found and not (asks and found["own"]):
            robot = found["robot"] or found["own"]
            if len(self._pieces(f"{robot} {found['order']}")) > 1:
                text = f"{robot} {found['order']}"  # the next one has a part of its own
                at = rf"({self._names}) (?:at|by|near)(?= )"  # "I want Ada and Kim at the gate"
                text = re.sub(at, r"\1 go to", text, flags=re.IGNORECASE) if found["robot"] else text
            elif not self._match(self.of("last"), found["order"]) or found["robot"]:
                return self._handed(robot, found["order"])
        if found := self._match(rf"(?P<robot>{self._names}) {self.of('modal')} {self.of('last')}", text):
            return TeamWish("parts", (Part("named", "", self._robots[found["robot"].lower()]),))
        whole = rf"(?:{self.of('all')}|{self.of('each')})(?: {self.of('but')})?"
        if found := self._match(rf"(?P<order>.+?),? (?P<all>{whole})", text):
            if found["order"].lower().endswith((*_INSIDE, " for", " than", " as", " by")):
                return None  # "say hello to everybody"
            text = f"{found['all']} {found['order']}"
        made = self._made(self._pieces(text))
        only = {part.who for part in made}
        single = len(made) == 1 and not made[0].awaits and not alone
        if not made or (single and only & {"named", "rest"}) or (asks and "named" in only):
            return None
        if (stranger := next(filter(None, (self._stranger(part.order) for part in made)), "")) != "":
            return TeamWish("stranger", about=stranger)
        return (
            TeamWish("parts", tuple(self._together(made))) if not all(part.stays for part in made) else None
        )

    def _stranger(self, order: str) -> str:
        """Somebody who is no robot here, and has a part behind the words of one: "..., Rex waits there"."""
        for found in re.finditer(_BESIDE, order):
            verb = _in_base_form(found["verb"])
            does = verb != found["verb"] and (verb,) in lexicon().verbs
            if found["who"].lower() not in self._robots and (does or self._match(self.of("modal"), verb)):
                return found["who"]
        return ""

    def _bare(self, text: str, *, asks: bool) -> TeamWish | None:
        """Robots and places, but not what is to be done there: "Ada the gate, Kim the desk"."""
        pieces = self._pieces(text)
        if len(pieces) < 2 or asks or any(piece[0] != "named" or piece[3] for piece in pieces):
            return None
        takes = rf"(?:{self.of('taking')} )?(?P<what>.+)"
        what = [found["what"] if (found := self._match(takes, piece[2])) else "" for piece in pieces]
        small, being = lexicon().classes["prepositions"], lexicon().classes["being"]
        firsts = {(words.split(" ")[0].lower()) for words in what}
        named = firsts.isdisjoint({*small, *being, ""} - lexicon().classes["determiners"])
        verbs = {
            first for first in firsts if any((form,) in lexicon().verbs for form in (first, *lemmas(first)))
        }
        deeds = firsts <= verbs or any(
            words.split(" ")[0].lower() in verbs and " " in words for words in what
        )
        if not named or deeds or len({*what}) < len(what):
            return None
        if any(len(words.split(" ")) > _NAME_WORDS or question_of(plain(tokenize(words))) for words in what):
            return None
        parts = (
            Part("named", words, self._robot(piece[1])) for piece, words in zip(pieces, what, strict=True)
        )
        return TeamWish("parts", tuple(parts), bare=True)

    def _together(self, made: Sequence[Part]) -> list[Part]:
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
                others = tuple(name for name in self._robots.values() if name not in named)
                parts = [replace(parts[0], who="all", robot="", without=others)]
            found += parts
        return found

    def _robot(self, subject: str) -> str:
        return self._robots.get(subject.lower(), self._hearer if subject.lower() == "you" else "")

    def _made(self, pieces: Sequence[_Piece]) -> list[Part]:
        """The parts of pieces, those that wait behind those that they wait for; none if one is no order."""
        made: list[Part] = []
        for who, subject, order, after, awaits in pieces:
            told = re.match(r"\w+s\b", order) and not self._match(rf"{self.of('modal')} .+", order)
            if len(pieces) == 1 and told and re.match(self.of("indefinite"), f"{subject} {order}"):
                return []  # "somebody comes to the gate"
            own = self._part(who, subject, order, after=after, known=made)
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

    def _called(self, text: str) -> tuple[str, ...]:
        """The robots that are named."""
        return tuple(
            self._robots[name.lower()] for name in re.findall(rf"\b{self._names}\b", text, re.IGNORECASE)
        )

    def _handed(self, robot: str, order: str) -> TeamWish | None:
        """What one robot is to do, whoever hears it."""
        order = "do that" if order.lower() == "go" else order
        own = self._part("named", robot, order, after=False, known=())
        return TeamWish("parts", (own,)) if own is not None else None

    def _recalled(self, text: str) -> str:
        """Robots that are called back, as if it were said to them: "bring everyone home"."""
        whom = rf"(?P<whom>{self.of('all')}|{self.of('each')}|{self.of('rest')}|{self._names})"
        found = self._match(rf"{self.of('recalling')} {whom} (?P<way>(?:back|home)\b.*)", text)
        found = found or self._match(rf"recall {whom}(?P<way>(?: to .+)?)", text)
        if found is None:
            return text
        way = found["way"] if not found["way"].startswith(" ") and found["way"] else f"back{found['way']}"
        lead = "let " if found["whom"].lower() in self._robots else ""
        return f"{lead}{found['whom']} {way}"

    def _taken_over(self, text: str) -> TeamWish | None:
        """That one robot does what is left of another one's work."""
        anyone = rf"(?:(?P<robot>{self._names})|{self.of('one')})"
        who = rf"(?:{self.of('handing')} )?{anyone},?(?: {self.of('modal')})?"
        small = r"(?:(?:so|and|then|please|can|could),? )*"
        if self._hearer and re.search(r"\w+s over\b|\btake over\b|\w+s (?:in )?for\b|^(?:let|have) ", text):
            text = re.sub(r"\b(from|for) you\b", rf"\1 {self._hearer}", text, flags=re.IGNORECASE)
            own = r"\byour (?=(?:part|share|work|job|rest|round|plan|tasks?|place)\b)"
            text = re.sub(own, f"{self._hearer}'s ", text, flags=re.IGNORECASE)
        if self._hearer:  # "can you do Ada's part?"
            text = re.sub(r"^(?:can|could|would|will) you ", f"{self._hearer} ", text, flags=re.IGNORECASE)
        ails = rf"(?P<of>{self._names}) ?{self.of('trouble')} ?[,.;:–-]+ ?{small}"
        found = (
            self._match(rf"{who} {self.of('takeover')}", text)
            or self._match(self.of("givenaway"), text)
            or self._match(rf"{ails}{who} {self.of('stepsin')}", text)
        )
        if found is None:
            return None
        said = found.groupdict()
        robot = self._robots.get((said["robot"] or "").lower(), "")
        of = self._robots[(said["of"] or said["of2"]).lower()]
        if robot == of:
            return None
        return TeamWish("parts", (Part("named" if robot else "one", "", robot, of=of),))

    def _pieces(self, text: str) -> list[_Piece]:
        """The parts as said."""
        when = self.of("when")
        you = "|you" if self._hearer else ""
        further = rf"(?<=[\w,;.] ){self.of('further')}"
        subjects = "|".join(
            f"(?P<{who}>{self.of(who)}(?: {self.of('but')})?)"
            for who in ("one", "some", "rest", "each", "all")
        )
        subjects = subjects.replace("(?P<one>", f"(?P<one>{further}|", 1)
        opening = (
            rf"(?P<gap>^|[,;.]? (?:{self.of('meanwhile')} )?|[,;.] ?)"
            rf"(?P<then>{self.of('then')},? )?(?P<when>{when},? )?"
            rf"(?:{subjects}|(?P<named>{self._names}{you}))(?=[,:]? \w)"
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
        pieces: list[_Piece] = []
        for one, end in zip(found, ends, strict=True):
            who = next(name for name in _WHO if one[name])
            order = text[one.end() : end].strip(" ,;:.")
            waits = re.search(rf"[,;]? {when}$", f" {order}", re.IGNORECASE)
            order = order[: waits.start() - 1].strip() if waits else order
            awaited = self._called((one["when"] or "") + (waits[0] if waits else ""))
            after = bool(one["then"] or one["when"] or waits)
            pieces.append((who, one[who], order, after, next(iter(awaited), "")))
        for at in range(len(pieces) - 2, -1, -1):
            if not pieces[at][2] and not pieces[at + 1][3]:  # "Ada and Kim go to the gate": both do
                pieces[at] = (*pieces[at][:2], pieces[at + 1][2], *pieces[at][3:])
        return pieces

    def _part(
        self,
        who: Who,
        subject: str,
        said: str,
        *,
        after: bool,
        known: Sequence[Part],
    ) -> Part | None:
        of_whom, *left_out = re.split(rf" (?={self.of('but')}$)", subject.lower())
        part = Part(
            who,
            "",
            self._robot(subject),
            after,
            count=next((number for word, number in _NUMBERS.items() if word in of_whom.split()), 1),
            nearest="nearest" in of_whom or "closest" in of_whom,
            without=self._called(" ".join(left_out)),
            fullest=self._match(self.of("strongest"), of_whom) is not None,
            idle=self._match(self.of("idle"), of_whom) is not None,
        )
        order = re.sub(r",? first$", "", said.strip(" ,"), flags=re.IGNORECASE)
        way = re.match(r"to (\w+)", order, re.IGNORECASE)
        if way and (way[1].lower(),) not in lexicon().verbs:
            order = f"go {order}"
        if who == "all":
            order = re.sub(r",? together$", "", order, flags=re.IGNORECASE)
        if who != "named":  # "the others at the dock"
            order = re.sub(r"^(?:at|by|near) (?=\w)", "go to ", order, flags=re.IGNORECASE)
        while found := re.match(rf"{self.of('modal')} ", order, re.IGNORECASE):
            order = order[found.end() :]
        if self._match(self.of("staying"), order):
            return replace(part, stays=True)
        if self._match(self.of("last"), order):
            return part
        taken = self._match(rf"{self.of('taking')} (?P<what>.+)", order)
        order = _in_base_form(order)
        if self._match(self.of("home"), order):
            return replace(part, home=True)
        if order and re.match(rf"{self.of('homeward')}\b", order, re.IGNORECASE) and " " in order:
            order = f"go {order}"
        if self._match(self.of("following"), order):
            order = known[-1].order if known else ""
            return replace(part, order=order) if order else None
        return self._deed(part, order, known, taken)

    def gone(self, order: str) -> str:
        """Who opens the way to a place, or comes together there, goes there."""
        for name in ("opening", "meeting"):
            if found := re.match(self.of(name), order, re.IGNORECASE):
                order = f"go to{order[found.end() :]}"
        return order

    def _deed(
        self, part: Part, order: str, known: Sequence[Part], taken: re.Match[str] | None
    ) -> Part | None:
        """A part with what it is to do, in words for one robot; None if that is no order."""
        order = self.gone(order)
        first = order.split(" ")[0].lower()
        verbs, being = lexicon().verbs, lexicon().classes["being"]
        nameless = (first,) not in verbs and first not in being and not _DOES.match(order)
        if known and part.who in ("named", "one") and nameless:
            order = f"{_opened(known[-1].order)} {order}"  # "Ada checks the gate, Kim the desk"
            first = order.split(" ")[0].lower()
        acts = (first,) in verbs and first not in being
        named = taken and not (taken["verb"][:3] in ("tak", "get") and taken["what"].split(" ")[0] in _THE)
        if taken and named:
            return replace(part, order=order if acts else "", alike=taken["what"])
        return replace(part, order=order) if acts and (" " in order or first in _ALONE) else None


def gathered(message: str) -> str:
    """Where all that hear a message shall come together, as it is said to one of them: "go to the gate"."""
    words = _Words(("you",))
    begun = re.sub(r",? together$", "", words.begun(_plain(message)), flags=re.IGNORECASE)
    gone = words.gone(begun)
    return gone if gone != words.begun(_plain(message)) else message


_OF_ONE: Final = {
    "owned": "what are you doing?", "under_way": "what are you doing?", "through": "are you done?",
    "fate": "what is wrong?",
}  # fmt: skip
_OF_ALL: Final = {
    "finders": "did you find anything?", "full": "how much battery is left?",
    "doing": "what are you doing?",
}  # fmt: skip
_Piece = tuple[Who, str, str, bool, str]
"""A part as said: who, in which words, what to do, whether it comes after another one, and after whose."""
_WANTED: Final = re.compile(
    r"^(?:i|we)(?:'d| would)? (?:like|want|need) (?P<what>.+?) (?:to be )?"
    r"(?:looked at|checked|inspected|searched|seen to)\b",
    re.IGNORECASE,
)
_BESIDE: Final = r"[,;.] (?:and |but |while )?(?P<who>[A-Z][a-z]+),? (?P<verb>[a-z]+)\b"
_NAME_WORDS: Final = 3
_THEM: Final = r"(?:them|those|each(?: of them)?|it)"
_CUTS: Final = 4
"""So many of the last pieces of a sentence may say where all are behind their work."""
_DOES: Final = re.compile(
    r"\w{3,}s (?:the|an?|my|our|your|this|that|over|on|at|up|for|to|with)\b", re.IGNORECASE
)
"""What somebody does, though it is no verb that we know: "minds the gate" is no thing that is taken."""
_ALONE: Final = ("charge", "recharge")
"""Whole orders: nothing has to be said of where."""
_THE: Final = ("the", "a", "an", "this", "that", "some")
_NUMBERS: Final = {"both": 2, "two": 2, "three": 3, "four": 4, "five": 5}
_SECOND: Final = {"is": "are", "'s": " are", "has": "have", "does": "do", "was": "were"}
_INSIDE: Final = (
    " the", " of", " to", " at", " with", " by", " near", " for", " from", " in", " on",
    " when", " once", " after", " as soon as",
)  # fmt: skip
"""Behind these a name is no subject: "go to, hm, Kim"."""


def _plain(message: str) -> str:
    text = re.sub(r"\s+", " ", message.replace("’", "'")).strip(" .!?")
    return re.sub(
        r",? (?:quick|quickly|asap|hurry(?: up)?|at once|right away|will you|then)$",
        "",
        text,
        flags=re.IGNORECASE,
    )


def _as_others(made: Sequence[Part]) -> list[Part]:
    """What is only "taken" is done as the others do: "Ada takes area A, Kim looks at area B"."""
    verb = next((_opened(part.order) for part in made if part.order and not part.alike), "")
    if not verb and any(part.alike and not part.order for part in made):
        return []
    return [
        replace(part, alike=f"{verb} {part.alike}" if verb else "") if part.alike else part for part in made
    ]


def _shared(order: str, without: tuple[str, ...] = ()) -> TeamWish:
    return TeamWish("share", (Part("all", order, without=without),))


def _acts(order: str) -> bool:
    """Whether words begin with what one can do."""
    first = order.split(" ")[0].lower()
    return (first,) in lexicon().verbs and first not in lexicon().classes["being"]


def _goes(order: str) -> bool:
    """Whether words only say where one is to be."""
    frames = lexicon().verbs.get((order.split(" ")[0].lower(),), frozenset())
    return not frames.isdisjoint({"GO", "WAIT"}) and " and " not in order


def _opened(order: str) -> str:
    """The verb of an order, with what leads to its place: "go to"."""
    first, *rest = order.split(" ")
    small = lexicon().classes["prepositions"] - lexicon().classes["determiners"]
    return " ".join([first, *itertools.takewhile(lambda word: word.lower() in small, rest)])


def _in_base_form(order: str) -> str:
    """What somebody else does, as one says it to them: "goes to the gate" is "go to the gate"."""
    first, _, rest = order.partition(" ")
    verbs = lexicon().verbs
    now = first.lower().endswith("s")  # "went to the gate" tells what was, and is no order
    base = next((form for form in lemmas(first) if now and (form,) in verbs), first)
    return f"{base} {rest}".strip() if (first.lower(),) not in verbs else order
