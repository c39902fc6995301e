"""From the parts of a message to plain orders, one thing each, in the order in which they are to be done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from parley.language.offline.grammar.arguments import words_of
from parley.language.offline.grammar.drafting import Draft, Hang, Plan, Step, hung
from parley.language.offline.grammar.orders import Node, Order, Part
from parley.language.offline.grammar.phrases import (
    about_find,
    is_what,
    noun_of,
    same_place,
    says_where,
    things_in,
)
from parley.language.offline.grammar.small import small
from parley.language.offline.grammar.things import Item
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, singular, tokens

__all__ = ["compose"]


def compose(parts: Sequence[Part], is_person: Callable[[Phrase], bool]) -> Plan:
    """The plain orders of a message.

    Args:
        parts: What it was parsed into.
        is_person: Whether words name somebody rather than something.
    """
    return _Composer(list(parts), is_person).compose()


class _Composer(Draft):
    """Goes through the parts of a message."""

    def compose(self) -> Plan:
        for at, part in enumerate(self.parts):
            self.at = at
            if isinstance(part, Order):
                self._order(part)
                self.fresh = []
            else:
                self._node(part)
        self._end_sentence(asked=False)
        self.plan.steps = [
            s for s in self.plan.steps if not any(same_place(s.place, t) for t in self.left_out)
        ]
        ending = [s for s in self.plan.steps if any(same_place(s.place, t) for t in self.at_end)]
        self.plan.steps = [s for s in self.plan.steps if s not in ending] + ending
        self._check()
        return self.plan

    # Marks between orders.

    def _node(self, node: Node) -> None:
        match node.mark:
            case "stop" | "ask":
                self._end_sentence(asked=node.mark == "ask")
            case "told":
                self._story(node)
            case "before" | "after":
                self._temporal(node)
            case "first":
                self.put_first = True
            case "wait":
                self._wait(node)
            case "correct":
                self.correcting = True
            case "if" | "unless" | "otherwise":
                self._condition(node)

    def _end_sentence(self, *, asked: bool) -> None:
        later, self.later = self.later, []
        self.hang = Hang()
        for order in later:
            self._order(order)
        if asked:
            self._question()
        self.sentence_start = len(self.plan.steps)
        self.hang = Hang()

    def _question(self) -> None:
        """For "Is anything stuck?", said where something is to be looked at."""
        before = self.parts[self.at - 1] if self.at else None
        if isinstance(before, Order) and before.kind == "other" and self._asks_for(before):
            return
        asked = isinstance(before, Order) and (before.kind in {"named", "again"} or _is_short(before))
        if asked and self.at > 1 and not self._ordered_in_sentence():
            self.plan.against.append("a question")
        if not isinstance(before, Node) or before.mark != "told":
            return
        words = words_of(before.items)
        things = things_in(before.items)
        if (
            keys(words[:1])[:1]
            and words[0].key in lexicon().be | {"has", "have", "does", "do", "can"}
            and len(words) > 2
        ):
            self.asked = (words, things)
            if self.plan.steps and self.plan.steps[-1].kind == "go" and self.plan.steps[-1].named:
                self.plan.steps[-1] = replace(self.plan.steps[-1], named=False)
            if self.plan.steps and not things and self.current:
                self._order(Order("whether", what=words))
            elif not things:
                self.plan.against.append("a question")
        elif not things and self.current and (sought := _sought(words)) is not None:
            self._order(sought)
        elif words[0].key == "how" and things:
            self.asked = (words, things)
        elif words[0].key not in lexicon().question_starts | small().subjects | {"we", "you"}:
            self.plan.against.append("a question")

    def _ordered_in_sentence(self) -> bool:
        """Whether the last part belongs to an order of its sentence ("look at A, and B?")."""
        for part in reversed(self.parts[: self.at - 1]):
            if isinstance(part, Order):
                return True
            if part.mark in {"stop", "ask"}:
                return False
        return False

    def _asks_for(self, order: Order) -> bool:
        """For "The hall. Open windows?": what is looked for, though it begins like an order."""
        steps = self.plan.steps
        if len(order.words) > 3 or len(steps) < 2 or steps[-1].words != order.words or not steps[-2].named:
            return False
        steps.pop()
        self.own = False
        self._order(Order("search", what=order.words, refers=True))
        return True

    def _story(self, node: Node) -> None:
        things = things_in(node.items)
        words = words_of(node.items)
        previous = next(
            (p for p in reversed(self.parts[: self.at]) if not (isinstance(p, Node) and p.mark == "comma")),
            None,
        )
        mainly = tuple(word for word in words if word.key not in small().sets["mainly"])
        plain_look = isinstance(previous, Order) and previous.kind == "look" and len(mainly) < len(words)
        named = isinstance(previous, Order) and previous.kind in {"named", "go"}
        if (named or plain_look) and not things and is_what(mainly):
            self.plan.certain = self.plan.certain or words[-1].key == "please"
            self.own = False
            self._order(Order("search", what=mainly, refers=True))
            return
        self.told += things
        about = next((item.thing for item in node.items[:3] if item.thing is not None), None)
        self.fresh = list(about.members) if about is not None else self.fresh
        self.told_group = _listed_last(node.items) or self.told_group
        if node.unread:
            self.plan.against.append("a verb")
        if things and says_where(node.items):
            self.about.append("someone is there")
        self.noun = noun_of(node.items) or self.noun

    def _temporal(self, node: Node) -> None:
        behind_comma = self.at > 0 and isinstance(self.parts[self.at - 1], Node)
        afterwards = (
            node.mark == "after"
            and behind_comma
            and not node.only
            and all(o.kind != "named" for o in node.orders)
        )
        leading = len(self.plan.steps) == self.sentence_start or afterwards
        for order in node.orders:
            if not order.things and not order.refers:
                continue
            if order.kind == "named" and leading:
                order.kind = "go"
            if node.mark == "after" and leading:
                self._unless_planned(order)
            elif node.mark == "before" and leading:
                self.plan.certain = True
                self.later.append(order)
            elif node.mark == "after":
                self._insert(order, self.last_start)
            else:
                self._unless_planned(order)

    def _unless_planned(self, order: Order) -> None:
        if any(same_place(step.place, thing) for step in self.plan.steps for thing in order.things):
            self.current = list(order.things)
            return
        self._order(order)

    def _insert(self, order: Order, at: int) -> None:
        if order.kind == "named":
            order.kind = "look" if self.last is not None and self.last.kind == "look" else "go"
        planned = [s.place for s in self.plan.steps[:at]]
        if any(same_place(place, thing) for place in planned for thing in order.things):
            return
        gone = [s for s in self.plan.steps[at:] if any(same_place(s.place, t) for t in order.things)]
        behind = [s for s in self.plan.steps[at:] if s not in gone]
        self.plan.steps = self.plan.steps[:at]
        current = self.current
        if gone:
            self.plan.steps += gone
        else:
            self._order(order)
        self.plan.steps += behind
        self.current, self.last_start = current, at

    def _condition(self, node: Node) -> None:
        self._begin_condition(node)
        if node.mark != "otherwise":
            self.hang_current = list(self.current)

    def _begin_condition(self, node: Node) -> None:
        things = things_in(node.items)
        self.current = self.current or things[:1]
        if node.mark == "otherwise":
            self.hang = replace(self.hang, hangs=True, otherwise=not self.hang.otherwise)
            self.current = self.hang_current or self.current
            return
        if not node.items:
            self._answered()
            self.hang = self.last_hang = Hang(hangs=True)
            return
        if node.reason and self._trails():
            return
        hang = self._hang(node)
        if len(self.plan.steps) > self.sentence_start and self._trails():
            if node.only:
                self.plan.against.append("a condition of nothing")
            for i in range(self.last_start, len(self.plan.steps)):
                self.plan.steps[i] = hung(self.plan.steps[i], hang)
            return
        self.hang = self.last_hang = hang

    def _trails(self) -> bool:
        """Whether a condition stands behind its order: nothing but the end of the sentence follows."""
        following = [part for part in self.parts[self.at + 1 : self.at + 3] if not _is_light(part)]
        return not following or not isinstance(following[0], Order)

    def _answered(self) -> bool:
        """Look first at what was asked ("Is the door shut? If so, ..."); whether anything was asked."""
        if not self.asked[0] or not self.asked[1]:
            return False
        self.hang = Hang()
        words, things = self.asked
        self._order(Order("whether", list(things), words))
        return True

    def _hang(self, node: Node) -> Hang:
        words = words_of(node.items)
        otherwise = node.mark == "unless"
        things = things_in(node.items)
        if not things and not self.current and keys(words[:1]) == ("you",):
            self.plan.against.append("a rule")
        looked = next((s for s in reversed(self.plan.steps) if s.kind in small().sets["looks"]), None)
        if not things and looked is not None and looked.kind != "look" and about_find(words):
            flat, gone = set(keys(words)), small().sets["gone"] - set(keys(looked.what))
            return Hang((), True, otherwise != (bool(flat & small().existence) != bool(flat & gone)))
        if set(keys(words)) <= small().sets["same_again"]:
            if not self._answered() and looked is None and not self.last_hang.hangs:
                self.plan.against.append("it depends on nothing")
            return Hang((), True, otherwise != ("not" in keys(words)))
        if self.last_hang.condition and not things and words[0].key in small().sets["pronouns"]:
            self.plan.against.append("another condition on the same")
        if not things and self.current and (keys(words[:1])[0] in small().sets["pronouns"] | lexicon().be):
            rest = words[1:] if words[0].key in small().sets["pronouns"] else words
            words = (*self.current[-1], *rest)
        return Hang(words, True, otherwise)

    # Orders.

    def _wait(self, node: Node) -> None:
        """For "Once A has left, ...": it is waited for."""
        step = Step("other", words=(*tokens("wait until"), *words_of(node.items)))
        if len(self.plan.steps) > self.sentence_start and self._trails():
            self.plan.steps.insert(self.last_start, step)
        else:
            self._put(step)

    def _check(self) -> None:
        steps = self.plan.steps
        if any({"twice", "thrice", "times"} & set(keys(p.words)) for p in self.parts if isinstance(p, Order)):
            self.plan.against.append("several times")
        if not steps:
            self.plan.against.append("no order")
        if steps and all(step.named for step in steps) and len(steps) == 1:
            self.plan.against.append("only a name")
        if self.later:
            self.plan.against.append("left over")


def _listed_last(items: Sequence[Item]) -> list[Phrase]:
    """The things that are named last, all of them if they are listed ("A, B and C are left")."""
    ends = [i for i, item in enumerate(items) if item.thing is not None]
    start = ends[-1] if ends else 0
    for at in reversed(ends[:-1]):
        if any(item.key not in {"and", ",", "both", "the"} for item in items[at + 1 : start]):
            break
        start = at
    return [
        member for i in ends if i >= start for thing in [items[i].thing] if thing for member in thing.members
    ]


def _sought(words: Phrase) -> Order | None:
    """For "Any leaks?", "Open windows?", "Open or shut?", said of a place: what is looked for there."""
    if len(words) <= 3 and singular(words[-1].key) != words[-1].key and is_what(words):
        return Order("search", what=words, refers=True)
    if "or" in keys(words) and len(words) < 7:
        return Order("whether", what=words, refers=True)
    if words[0].key == "any" and len(words) > 1:
        return Order("search", what=words[1:], refers=True)
    return None


def _is_short(order: Order) -> bool:
    """Whether it may ask for what was found rather than for a search ("Any keys there?")."""
    return order.kind == "search" and len(order.words) < 4


def _is_light(part: Part) -> bool:
    """Whether it is a comma or "then"."""
    return isinstance(part, Node) and part.mark in {"comma", "then"}
