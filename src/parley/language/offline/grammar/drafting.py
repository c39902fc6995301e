"""The plan that grows order by order: one plain order for each thing, in its place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from parley.language.offline.grammar.orders import Node, Order, Part
from parley.language.offline.grammar.phrases import (
    moved,
    same_place,
)
from parley.language.offline.grammar.small import base, small
from parley.language.offline.words.text import Phrase, keys

__all__ = ["Draft", "Hang", "Plan", "Step", "hung"]

_MINDING = frozenset(
    (verb,)
    for verb in (
        "remember",
        "forget",
        "memorise",
        "memorize",
        "note",
        "learn",
        "save",
        "know",
        "keep",
        "wait",
        "stop",
    )
)


_VAGUE = frozenset(
    {
        ("do", "that"),
        ("do", "it"),
        ("do", "so"),
        ("go", "on"),
        ("carry", "on"),
        ("get", "ready"),
        ("get", "on"),
        ("tell", "me"),
    }
)


_REPORTING = frozenset(
    {("tell", "me"), ("report", "back"), ("let", "me", "know"), ("report",), ("tell", "us")}
)


_TELLING = frozenset({("tell",), ("report",), ("describe",), ("say",), ("take",)})


@dataclass(frozen=True, slots=True)
class Step:
    """One plain order."""

    kind: str
    place: Phrase = ()
    what: Phrase = ()
    words: Phrase = ()
    condition: Phrase = ()
    hangs: bool = False
    otherwise: bool = False
    named: bool = False
    """Whether the place was only named, and nothing said of it."""


@dataclass
class Plan:
    """What the parts come to."""

    steps: list[Step] = field(default_factory=list)
    against: list[str] = field(default_factory=list)
    """Why it may be wrong."""
    certain: bool = False
    """Whether it says in which order, or for what, in a way that is read best here ("the last stop is A")."""


@dataclass(frozen=True, slots=True)
class Hang:
    """On what steps depend."""

    condition: Phrase = ()
    hangs: bool = False
    otherwise: bool = False


def replace_order(order: Order, things: Sequence[Phrase]) -> Order:
    """The order for other things."""
    return Order(order.kind, list(things), order.what, order.words)


def hung(step: Step, hang: Hang) -> Step:
    """The step, depending on that."""
    return replace(step, condition=hang.condition, hangs=hang.hangs, otherwise=hang.otherwise)


class Draft:
    """What the orders of a message come to so far."""

    def __init__(self, parts: list[Part], is_person: Callable[[Phrase], bool]) -> None:
        self.is_person = is_person
        self.parts = parts
        self.plan = Plan()
        self.at_end: list[Phrase] = []
        self.hang_current: list[Phrase] = []
        """What was spoken of when a condition began."""
        self.own = False
        """Whether the order that is read names its places itself."""
        self.current: list[Phrase] = []
        """The places that "it" and "there" mean."""
        self.told: list[Phrase] = []
        self.left_out: list[Phrase] = []
        """What is to be left out of all that follows."""
        self.fresh: list[Phrase] = []
        """What was told of since the last order."""
        self.told_group: list[Phrase] = []
        """What a story named last, all of it."""
        self.about: list[str] = []
        """What stories say that orders may depend on."""
        self.noun: Phrase = ()
        """What a story was about last, that no map knows."""
        self.last: Order | None = None
        self.last_start = 0
        """Where the steps of the last order begin."""
        self.hang = self.last_hang = Hang()
        self.later: list[Order] = []
        """What comes when the sentence is over ("before A, B")."""
        self.sentence_start = 0
        self.put_first = False
        self.correcting = False
        self.at = 0
        self.asked: tuple[Phrase, list[Phrase]] = ((), [])
        """The last question, and what it names."""

    def _order(self, order: Order) -> None:
        if order.negated or order.kind == "leave_out":
            self._leave_out(order)
            return
        if self.correcting:
            self._correct(order)
        if self.put_first:
            self.put_first, order.where = False, "before"
        self.plan.certain = self.plan.certain or order.ranked
        if order.where:
            self._place(order)
        elif not self._moves(order):
            start = len(self.plan.steps)
            self._add(order)
            if len(self.plan.steps) > start:
                self.last_start = start
        if order.unread:
            self.plan.against += ["unread"] * order.unread

    def _moves(self, order: Order) -> bool:
        """For "A, B and C, start with B", "..., but finish at A": what is planned already moves."""
        first = order.words[0].key if order.words else ""
        planned = self._planned(order)
        if (
            order.kind != "go"
            or not planned
            or first not in small().sets["first"] | small().sets["last"]
            or self.hang.hangs
        ):
            return False
        order.where = "first" if first in small().sets["first"] else "last"
        self._place(order)
        return True

    def _planned(self, order: Order) -> list[Step]:
        """The steps that are planned for what an order names, "the gate" where there is one gate so far."""
        found = [s for s in self.plan.steps if any(same_place(s.place, t) for t in order.things)]
        if found or len(order.things) != 1:
            return found
        short = keys(order.things[0])
        short = short[short[:1] == ("the",) :]
        alike = [s for s in self.plan.steps if short and keys(s.place)[-len(short) :] == short]
        return alike if len({keys(step.place) for step in alike}) == 1 else []

    def _place(self, order: Order) -> None:
        """Put it where it belongs; what is planned already is moved."""
        anchor = self.plan.steps[self.last_start] if self.last_start < len(self.plan.steps) else None
        moved_steps = self._planned(order)
        rest = [s for s in self.plan.steps if s not in moved_steps]
        current = list(self.current)
        if not moved_steps:
            self.plan.steps = []
            if order.kind == "named" and self.last is not None and self.last.kind in small().sets["looks"]:
                self._again(order)
            else:
                self._add(order)
            moved_steps = self.plan.steps
        self.at_end += order.things if order.where == "last" else []
        at = {"first": 0, "last": len(rest)}.get(
            order.where, rest.index(anchor) if anchor in rest else len(rest)
        )
        self.plan.steps = [*rest[:at], *moved_steps, *rest[at:]]
        self.last_start = at
        self.current = current if order.where != "last" else list(order.things)

    def _correct(self, order: Order) -> None:
        """What was asked for last is taken back."""
        self.correcting = False
        last = self.last
        self.plan.against = [why for why in self.plan.against if why != "a look at nothing"]
        if last is None:
            return
        if order.kind == "named" and len(last.things) > 1 and last.kind in {"go", "named"}:
            # "A, then B, no, C": only the last of them is taken back.
            wrong = last.things[-1]
            at = next((i for i, s in enumerate(self.plan.steps) if same_place(s.place, wrong)), 0)
            del self.plan.steps[at or self.last_start :]
            order.things[:0] = last.things[:-1] if not at else []
        else:
            del self.plan.steps[self.last_start :]
        if order.kind == "named" and last.kind != "named":
            order.kind, order.what = last.kind, last.what

    def _add(self, order: Order) -> None:
        match order.kind:
            case "go":
                self._go(order)
            case "named":
                self._named(order)
            case "again":
                self._again(order)
            case "other" | "search" if order.kind == "other" or self._whole(order):
                if keys(order.words) in _REPORTING and self.plan.steps:
                    return
                if keys(order.words[:1]) in _MINDING or keys(order.words[:2]) in _VAGUE:
                    self.plan.against.append("nothing to do in the world")
                if self.about:
                    self.plan.against.append("it may depend on what is told")
                self._put(Step("other", words=order.words))
                self.current = order.things or self.current
                self.last = order
            case _:
                self._look(order)

    def _whole(self, order: Order) -> bool:
        """Whether somebody is looked for: the reader knows best where and how."""
        return not order.things and not self.current and self.is_person(order.what)

    def _put(self, step: Step) -> None:
        if step.kind == "other" and not step.words:
            return
        self.plan.steps.append(hung(step, self.hang))

    def _go(self, order: Order) -> None:
        things = order.things
        if not things and order.refers:
            things = self._there(order)
        if not things and not order.refers and len(order.words) == 1 and not self.plan.steps:
            # "She is waiting for you, off you go".
            things = self.told[-1:]
        deed = bool(order.words) and order.words[0].key in small().deeds and not things
        if not things and not order.refers and not deed and not (self.plan.steps and len(order.words) == 1):
            self._put(Step("other", words=order.words))
        if (
            things
            and order.words
            and base(order.words[0].key) in small().sets["last"]
            and not self.plan.steps
        ):
            self.at_end += things
            self.plan.certain = len(self.parts) > 2
        for thing in things:
            self._put(Step("go", thing))
        if things:
            self.current, self.last = list(things), replace_order(order, things)

    def _there(self, order: Order) -> list[Phrase]:
        """Where "there" is, if the robot does not come there anyway."""
        meant = self.current[-1:] or self.told_group or self.told[-1:]
        if order.somebody and not self.current:
            self.plan.against.append("who is that")
        if not meant:
            self._put(Step("other", words=order.words))
        return [] if any(same_place(step.place, m) for step in self.plan.steps for m in meant) else meant

    def _named(self, order: Order) -> None:
        last = self.last
        if order.things and [keys(t) for t in order.things] == [keys(c) for c in self.current]:
            # "The zones backwards, that is zones 3, 2, 1": said twice.
            return
        if self._is_list(order):
            self.told += order.things
            self.told_group = list(order.things)
            return
        planned = self._planned(order)
        if planned and len(order.things) == 1:
            # "..., and A after B": A is planned already.
            self.last_start, self.current = self.plan.steps.index(planned[0]), list(order.things)
            return
        if last is not None and last.kind in small().sets["looks"] and not self._is_topic():
            self._again(order)
            return
        for thing in order.things:
            self._put(Step("go", thing, named=True))
        self.current = list(order.things)
        self.last = last if last is not None and last.kind in small().sets["looks"] else order

    def _is_topic(self) -> bool:
        """For "and the gate, check that it is shut": an order about what is named follows."""
        comma, order = self.parts[self.at + 1 : self.at + 2], self.parts[self.at + 2 : self.at + 3]
        marked = bool(comma) and isinstance(comma[0], Node) and comma[0].mark == "comma"
        follows = order[0] if order else None
        return (
            marked
            and isinstance(follows, Order)
            and follows.kind in small().sets["looks"]
            and not follows.things
        )

    def _is_list(self, order: Order) -> bool:
        """For "we have three places here, A, B and C": they are told of."""
        comma, before = (self.parts[self.at - 1 : self.at], self.parts[max(0, self.at - 2) : self.at - 1])
        marks = [part.mark for part in (*before, *comma) if isinstance(part, Node)]
        return marks == ["told", "comma"] and not self.plan.steps and not order.also and order.group

    def _again(self, order: Order) -> None:
        last = self.last
        if last is None or last.kind not in small().sets["looks"] | {"go"}:
            self.plan.against.append("the same as nothing")
            return
        again = Order(last.kind, list(order.things) or list(self.current), last.what)
        if last.kind == "whether":
            again.what = moved(last.what, last.things, order.things)
        self._add(again)

    def _look(self, order: Order) -> None:
        self._as_before(order)
        what = order.what
        if not what and not order.things and self.asked[0] and order.kind in {"whether", "look", "search"}:
            order.kind, what, order.things = "whether", self.asked[0], self.asked[1]
        self.asked = (), []
        self.own = bool(order.things)
        if order.kind in {"search", "count"} and not what:
            what = self.noun
            if not what:
                order.kind = "look"
        places = order.things or self._meant(order)
        if keys(order.words[:1]) in _TELLING and order.kind == "look" and not order.things:
            self._put(Step("other", words=order.words))
            return
        if order.refers and not self.current and self.about and not order.plural:
            self.plan.against.append("it may be what is told of")
        if order.kind == "whether" and len(order.things) > 1:
            places = order.things[:1] if not self.current else self.current[-1:]
        if not places and order.refers and not order.things:
            self._put(Step("other", words=order.words))
        elif order.kind in {"search", "count"} and not places:
            self._put(Step(order.kind, (), what, order.words))
        elif not places:
            self.plan.against.append("a look at nothing")
        for place in places:
            self._look_at(order.kind, place, what)
        if places:
            self.current = list(places)
        self.last = Order(order.kind, list(places), what, order.words)
        self.noun = what if order.kind == "search" else self.noun

    def _as_before(self, order: Order) -> None:
        """For "B for the same", "look in B" behind a search: what was looked for before."""
        inside = order.kind == "look" and order.things and keys(order.words[1:2]) in _INSIDE
        sought = self.last is not None and keys(self.last.words[:2]) == ("look", "for")
        if inside and not order.what and self.last is not None and sought:
            order.kind, order.what, self.plan.certain = "search", self.last.what, True
            return
        same = order.what and set(keys(order.what)) <= {"the", "same", "thing", "things", "too"}
        if not same or self.last is None:
            return
        order.what, order.kind = self.last.what, self.last.kind
        if order.kind == "whether":
            order.what = moved(self.last.what, self.last.things, order.things)

    def _meant(self, order: Order) -> list[Phrase]:
        if len(self.fresh) == 1 and self.current and not order.plural and not self.is_person(self.fresh[0]):
            # "The skip should be away, see if it is".
            return list(self.fresh)
        if self.current:
            return self._all_meant() if order.plural else list(self.current)
        if order.plural and len(self.told_group) != 1:
            return self.told_group
        places = self._told_places()
        return places if order.plural else places[-1:]

    def _all_meant(self) -> list[Phrase]:
        """What "any of them" means: every place gone to since something was looked at."""
        steps = self.plan.steps
        first = next((i + 1 for i in range(len(steps) - 1, -1, -1) if steps[i].kind != "go"), 0)
        places = list({keys(step.place): step.place for step in steps[first:]}.values())
        return places if len(places) > len(self.current) else list(self.current)

    def _told_places(self) -> list[Phrase]:
        """What stories name, once each; people only if they name nothing else."""
        once = {keys(phrase): phrase for phrase in self.told}
        places = [phrase for phrase in once.values() if not self.is_person(phrase)]
        return places or list(once.values())

    def _look_at(self, kind: str, place: Phrase, what: Phrase) -> None:
        """Behind the step that goes there, if that was the last thing done there."""
        kind = "search" if kind == "look" and what else kind
        step = hung(Step(kind, place, what), self.hang)
        steps = self.plan.steps
        at = next((i for i in range(len(steps) - 1, -1, -1) if same_place(steps[i].place, place)), -1)
        same_hang = (
            at >= 0
            and steps[at].hangs == step.hangs
            and steps[at].condition == step.condition
            and steps[at].otherwise == step.otherwise
        )
        if (
            kind == "look"
            and at >= 0
            and at == len(steps) - 1
            and steps[at].kind in small().sets["looks"]
            and not what
        ):
            return
        again = not self.own and steps[at].kind == "look" if at >= 0 else False
        if (
            at >= 0
            and (again or at == len(steps) - 1)
            and steps[at].kind == "look"
            and kind != "look"
            and same_hang
        ):
            steps[at] = replace(steps[at], kind="go")
        if at >= 0 and steps[at].kind == "go" and same_hang:
            if all(other.kind == "go" for other in steps[at:]) or steps[at + 1].kind != "go":
                steps[at] = step if kind != "whether" else steps[at]
                if kind == "whether":
                    steps.insert(at + 1, step)
                return
            steps[at] = step
            return
        self.plan.steps.append(step)

    def _leave_out(self, order: Order) -> None:
        """What is not to be done: it is taken out of what was asked for."""
        if order.kind == "leave_out" and order.refers and not order.things:
            order.things = self.fresh[-1:] or self.current[-1:]
        self.current = self.current or list(order.things)
        if order.kind == "leave_out" and not order.things:
            self.plan.against.append("nothing to leave out")
        if self.last is None and order.kind in small().sets["looks"]:
            self.last = Order(order.kind)
        if order.kind in {"go", "leave_out", "named"}:
            before = len(self.plan.steps)
            self.plan.steps = [
                s for s in self.plan.steps if not any(same_place(s.place, thing) for thing in order.things)
            ]
            self.current = [c for c in self.current if not any(same_place(c, t) for t in order.things)]
            if before == len(self.plan.steps) and order.kind == "leave_out" and not self.plan.steps:
                self.left_out += order.things
        elif order.kind == "other":
            self.plan.against += ["unread"] * order.unread


_INSIDE = frozenset({("in",), ("inside",), ("into",), ("under",), ("behind",)})
