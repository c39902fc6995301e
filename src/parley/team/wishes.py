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
from parley.gate.control import control_of
from parley.gate.stop_words import calls_to_stop
from parley.language.builtin.lexicon import lemmas, lexicon
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import asks, plain, question_of

__all__ = ["Part", "TeamWish", "asked_by_name", "is_in_turn", "is_of_several", "team_wish"]


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


@dataclass(frozen=True, slots=True)
class TeamWish:
    """How a message spreads work over robots, or what it asks about them."""

    kind: Literal["share", "parts", "nearest", "about", "why"]
    parts: tuple[Part, ...] = ()
    """For `share` one, of all."""
    about: str = ""
    """For `nearest` the place, for `about` the question as that robot would be asked."""
    robot: str = ""
    """For `about`, empty: each of them is asked. For `why` who was chosen or was not, if one is named."""
    one_each: bool = False
    """For `share`: nobody takes more than one."""
    count: int = 0
    """How many robots are spoken of ("you two"); 0: that is not said."""
    bare: bool = False
    """For `share`: only things are named, not what is to be done there."""


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


def team_wish(message: str, robots: Sequence[str]) -> TeamWish | None:
    """How a message is meant for a team; None if it says nothing of one.

    Args:
        message: What was said.
        robots: Who is there; a team has at least two.
    """
    if len(robots) < 2:
        return None
    words = _Words(tuple(robots))
    asks = message.rstrip().endswith("?")
    text = re.sub(r"\s+", " ", message.replace("’", "'")).strip(" .!?")
    bare = words.begun(text)
    wish = words.about(text) or words.share(bare) or words.parts(bare, asks=asks)
    if wish is None or any(calls_to_stop(part.order) or control_of(part.order) for part in wish.parts):
        return None  # stopping has its own way
    return replace(wish, count=words.count(text))


def asked_by_name(message: str, robots: Sequence[str], hearer: str) -> TeamWish | None:
    """A question that calls one robot, heard by another one: that cannot answer for it."""
    words = _Words(tuple(robots))
    text = words.begun(re.sub(r"\s+", " ", message.replace("’", "'")).strip(" .!?"))
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

    def __init__(self, robots: tuple[str, ...]) -> None:
        self._robots = {name.lower(): name for name in robots}

    def of(self, name: str) -> str:
        """A list as one pattern."""
        filled = "|".join(sorted(_data()[name], key=len, reverse=True))
        filled = re.sub(r"(?<!\?P)<(\w+)>", lambda found: self.of(found[1]), filled)
        return f"(?:{filled.replace('{robot}', self._names)})"

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
        if self._match(self.of("doing"), bare):
            return TeamWish("about", about="what are you doing?")
        named = re.findall(rf"\b{self._names}\b", bare, re.IGNORECASE)
        called = rf"{self._names}\b.*|.*(?<!\bis)(?<!\bwas)(?<!'s)\W{self._names}"
        if len(named) > 1 or (named and self._match(called, bare)):
            return None
        which = re.sub(rf"^{self.of('which')} (\w+)", r"\1 you", bare, flags=re.IGNORECASE)
        whom = re.escape(named[0]) if named else self.of("asked")
        asked = which if which != bare else re.sub(rf"\b{whom}\b", "you", bare, flags=re.IGNORECASE)
        for third, second in _SECOND.items():
            asked = re.sub(
                rf"(?:\b{third}|(?<=\w){third}) you\b", f"{second} you", asked, flags=re.IGNORECASE
            )
        if asked == bare or question_of(plain(tokenize(asked))) is None:
            return None
        return TeamWish("about", about=f"{asked}?", robot=self._robots[named[0].lower()] if named else "")

    # -- sharing ---------------------------------------------------------------------------------------

    def share(self, text: str) -> TeamWish | None:
        """Work that all do together, each a part."""
        between, split, that = self.of("between"), self.of("split"), self.of("that")
        if self._match(rf"{split} {that}(?: up)?(?: {between})?", text):
            return _shared("")
        if found := self._match(rf"{split} (?P<what>.+?)(?: up)? {between}(?:,? and (?P<order>.+))?", text):
            what, order = found["what"], found["order"]
            if order is None:
                return TeamWish("share", (Part("all", what),), bare=True)
            return _shared(re.sub(r"\b(?:them|those|each(?: of them)?|it)\b", what, order))
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
        if found := self._match(r"(?P<order>.+?),? (?:one each|one apiece|one for each of you)", text):
            return TeamWish("share", (Part("all", found["order"]),), one_each=True)
        some = rf"(?P<some>{self._names}(?:(?:,? and|,) {self._names})+),?(?: {self.of('modal')})?"
        if found := self._match(rf"{some} (?P<order>.+?),? (?:between|among) (?:them|themselves)", text):
            return _shared(found["order"], tuple({*self._robots.values()} - {*self._called(found["some"])}))
        if found := self._match(r"(?:all )?work together,?(?: and| to|:)? (?P<order>.+)", text):
            return _shared(found["order"])
        takes = r"takes? (?:one|an?|a different) (?P<what>\w+)(?: each)?,? and (?P<verb>\w+) it"
        takes = rf"{self.of('each')},? {takes}"
        if found := self._match(takes, text):
            order = f"{_in_base_form(found['verb'])} every {found['what']}"
            return TeamWish("share", (Part("all", order),), one_each=True)
        one = r"(?P<verb>\w+(?: \w+)?) {} (?P<what>\w+(?: \w+){{0,2}}){}"
        each = rf"(?:{self.of('each')}|{self.of('all')}),? {one.format('a (?:different|separate)', '')}"
        found = self._match(one.format("one(?: of the)?", " each"), text) or self._match(each, text)
        if found and (found["verb"].split()[0].lower(),) in lexicon().verbs:
            return TeamWish("share", (Part("all", f"{found['verb']} every {found['what']}"),), one_each=True)
        return None

    # -- parts -----------------------------------------------------------------------------------------

    def parts(self, text: str, *, asks: bool) -> TeamWish | None:
        """Who is to do what, one part after the other as it was said."""
        if (taken := self._taken_over(text)) is not None:
            return taken
        if found := self._match(
            rf"{self.of('handing')} (?P<rest>(?:{self.of('one')}|{self.of('some')}) .+)", text
        ):
            text = found["rest"]
        handing = (
            rf"(?:{self.of('handing')} (?P<robot>{self._names})|(?P<own>{self._names}) {self.of('duty')})"
        )
        found = self._match(rf"{handing} (?P<order>.+)", text)
        if found and not (asks and found["own"]):
            robot = found["robot"] or found["own"]
            if re.search(rf"\b{self._names}\b", found["order"], re.IGNORECASE):
                text = f"{robot} {found['order']}"  # the next one has a part of its own
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
        only, alone = {part.who for part in made}, len(made) == 1
        if not made or (alone and only & {"named", "rest"}) or (asks and "named" in only):
            return None
        return TeamWish("parts", tuple(made))

    def _made(self, pieces: Sequence[tuple[Who, str, str, bool]]) -> list[Part]:
        """The parts of pieces, those that wait behind those that they wait for; none if one is no order."""
        made: list[Part] = []
        for who, subject, order, after in pieces:
            told = re.match(r"\w+s\b", order) and not self._match(rf"{self.of('modal')} .+", order)
            if len(pieces) == 1 and told and re.match(self.of("indefinite"), f"{subject} {order}"):
                return []  # "somebody comes to the gate"
            own = self._part(who, subject, order, after=after, known=made)
            if own is None:
                return []
            made.append(own)
        if [part.after for part in made] == [True, False]:  # "Kim goes when Ada is there. Ada goes."
            made.reverse()
        return [] if len(made) > 1 and made[0].after else made

    def _called(self, text: str) -> tuple[str, ...]:
        """The robots that are named."""
        return tuple(
            self._robots[name.lower()] for name in re.findall(rf"\b{self._names}\b", text, re.IGNORECASE)
        )

    def _handed(self, robot: str, order: str) -> TeamWish | None:
        """What one robot is to do, whoever hears it."""
        own = self._part("named", robot, order, after=False, known=())
        return TeamWish("parts", (own,)) if own is not None else None

    def _taken_over(self, text: str) -> TeamWish | None:
        """That one robot does what is left of another one's work."""
        who = rf"(?:{self.of('handing')} )?(?P<robot>{self._names}),?(?: {self.of('modal')})?"
        found = self._match(rf"{who} {self.of('takeover')}", text) or self._match(self.of("givenaway"), text)
        if found is None or found["robot"].lower() == found["of"].lower():
            return None
        robot, of = self._robots[found["robot"].lower()], self._robots[found["of"].lower()]
        return TeamWish("parts", (Part("named", "", robot, of=of),))

    def _pieces(self, text: str) -> list[tuple[Who, str, str, bool]]:
        """The parts as said: who, in which words, what to do, whether it comes after the one before."""
        when = self.of("when")
        subjects = "|".join(
            f"(?P<{who}>{self.of(who)}(?: {self.of('but')})?)"
            for who in ("one", "some", "rest", "each", "all")
        )
        opening = (
            rf"(?P<gap>^|[,;.]? (?:{self.of('meanwhile')} )?|[,;.] ?)"
            rf"(?P<then>{self.of('then')},? )?(?P<when>{when},? )?"
            rf"(?:{subjects}|(?P<named>{self._names}))(?=[,:]? \w)"
        )
        found = [
            one
            for one in re.finditer(opening, text, re.IGNORECASE)
            if not text[: one.start()].lower().endswith(_INSIDE)
        ]
        if not found or found[0].start() != 0:
            return []
        ends = [one.start() for one in found[1:]] + [len(text)]
        pieces: list[tuple[Who, str, str, bool]] = []
        for one, end in zip(found, ends, strict=True):
            who = next(name for name in _WHO if one[name])
            order = text[one.end() : end].strip(" ,;:.")
            waits = re.search(rf"[,;]? {when}$", f" {order}", re.IGNORECASE)
            order = order[: waits.start() - 1].strip() if waits else order
            pieces.append((who, one[who], order, bool(one["then"] or one["when"] or waits)))
        for at in range(len(pieces) - 2, -1, -1):
            if not pieces[at][2] and not pieces[at + 1][3]:  # "Ada and Kim go to the gate": both do
                pieces[at] = (*pieces[at][:2], pieces[at + 1][2], pieces[at][3])
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
            self._robots.get(subject.lower(), ""),
            after,
            count=next((number for word, number in _NUMBERS.items() if word in of_whom.split()), 1),
            nearest="nearest" in of_whom or "closest" in of_whom,
            without=self._called(" ".join(left_out)),
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
        if self._match(self.of("last"), order):
            return part
        order = _in_base_form(order)
        if self._match(self.of("home"), order):
            return replace(part, home=True)
        if order and re.match(rf"{self.of('homeward')}\b", order, re.IGNORECASE) and " " in order:
            order = f"go {order}"
        if self._match(self.of("following"), order):
            order = known[-1].order if known else ""
            return replace(part, order=order) if order else None
        if opens := re.match(self.of("opening"), order, re.IGNORECASE):
            order = f"go to{order[opens.end() :]}"
        if meets := re.match(self.of("meeting"), order, re.IGNORECASE):
            order = f"go to{order[meets.end() :]}"
        first = order.split(" ")[0].lower()
        verbs, being = lexicon().verbs, lexicon().classes["being"]
        if known and who in ("named", "one") and (first,) not in verbs and first not in being:
            order = f"{_opened(known[-1].order)} {order}"  # "Ada checks the gate, Kim the desk"
            first = order.split(" ")[0].lower()
        acts = (first,) in verbs and first not in being
        return replace(part, order=order) if acts and " " in order else None


_NUMBERS: Final = {"both": 2, "two": 2, "three": 3, "four": 4, "five": 5}
_SECOND: Final = {"is": "are", "'s": " are", "has": "have", "does": "do", "was": "were"}
_INSIDE: Final = (
    " the", " of", " to", " at", " with", " by", " near", " for", " from", " in", " on",
    " when", " once", " after", " as soon as",
)  # fmt: skip
"""Behind these a name is no subject: "go to, hm, Kim"."""


def _shared(order: str, without: tuple[str, ...] = ()) -> TeamWish:
    return TeamWish("share", (Part("all", order, without=without),))


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
