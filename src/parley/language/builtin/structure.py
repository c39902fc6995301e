"""The logic of a message: its clauses in the order in which they are done, with what each depends on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from parley.gate.control_grammar import composed
from parley.language.builtin.clauses import Clause
from parley.language.builtin.lexicon import Lexicon, lemmas
from parley.language.builtin.reading import Reading
from parley.language.builtin.spans import Parse

__all__ = ["Condition", "If", "Node", "Orders", "Part", "Unclear", "arranged", "order_wishes"]


@dataclass(frozen=True, slots=True)
class Part:
    """A clause, read by itself."""

    clause: Clause
    parse: Parse
    reading: Reading
    text: str
    """As it was said."""

    @property
    def low(self) -> tuple[str, ...]:
        """Its words and marks in small letters."""
        return tuple(token.low for token in self.parse.tokens)


@dataclass(slots=True)
class Orders:
    """What one clause wants, and what limits it: exceptions, times, delays, "until"."""

    part: Part
    limits: list[Part] = field(default_factory=list)
    branch: bool = False
    """Whether it depends on something."""
    is_order: bool = False
    """Whether it is wanted although it is put as something that happens ("before you go to the yard")."""


@dataclass(frozen=True, slots=True)
class Condition:
    """What must hold, or must not."""

    part: Part
    holds: bool
    again: bool = False
    """Whether it is what was to be looked at before ("if not", "if it is")."""


@dataclass(slots=True)
class If:
    """What is done if something holds, and what if not."""

    condition: Condition
    then: list[Node] = field(default_factory=list)
    otherwise: list[Node] = field(default_factory=list)


Node = Orders | If


@dataclass(frozen=True, slots=True)
class Unclear:
    """Why the clauses of a message make no certain plan."""

    question: str


def order_wishes(reading: Reading) -> int:
    """How many orders a clause holds."""
    return sum(wish.act in ("order", "edit", "answer") for wish in reading.wishes)


@dataclass(slots=True)
class _Arranger:
    lexicon: Lexicon
    nodes: list[Node] = field(default_factory=list)
    target: list[Node] = field(default_factory=list)
    last: If | None = None
    sentence: int = 0
    waiting: list[Part] = field(default_factory=list)
    """Limits that govern what follows."""
    late: list[Node] = field(default_factory=list)
    """What comes behind the rest of its sentence."""
    early: bool = False
    """Whether the next orders come before those that were said last."""
    put: Node | None = None
    """What was put there last."""
    branch: bool = False
    """Whether a condition waits for what depends on it."""

    def __post_init__(self) -> None:
        self.target = self.nodes

    def take(self, part: Part) -> Unclear | None:
        if part.clause.sentence != self.sentence:
            self._closed()
            self.sentence = part.clause.sentence
        match part.clause.link:
            case "main":
                if self.target is self.nodes and any(
                    w.frame in ("LOOK", "FIND") for w in part.reading.wishes
                ):
                    self.last = None
                self._put(
                    Orders(part, [*self.waiting], self.target is not self.nodes or self.early or self.branch)
                )
                self.waiting.clear()
            case "if" | "unless":
                return self._if(part)
            case "else" | "so":
                return self._branch(part, part.clause.link == "so")
            case "before" | "after" | "when":
                return self._order_of_time(part)
            case "first":
                self.early = True
            case "next":
                pass
            case _:
                return self._limit(part)
        return None

    def _closed(self) -> None:
        """A sentence has ended."""
        self.nodes += self.late
        self.late = []
        self.target = self.nodes

    def _put(self, node: Node) -> None:
        self.branch = False
        before = self.target.index(self.put) if self.put in self.target else len(self.target) - 1
        self.target.insert(max(before, 0) if self.early else len(self.target), node)
        self.early, self.put = False, node

    def _if(self, part: Part) -> Unclear | None:
        words = [word for word in part.low if word.isalnum() or "'" in word]
        if " ".join(words) in self.lexicon.classes["courtesy"]:
            return None
        negative = any(word in self.lexicon.classes["negations"] for word in words)
        holds = part.clause.link == "if"
        again = all(word in self.lexicon.classes["ellipsis"] for word in words)
        if not part.clause.fronted:
            return self._trailing(Condition(part, holds != (again and negative), again))
        if again:
            return self._branch(part, holds != negative)
        if self.target is not self.nodes and not self._apart(part):
            return Unclear(
                f"Does “{part.text}” matter only if the other thing holds? Can you say one after the other?"
            )
        self.target = self.nodes
        self._open(Condition(part, holds))
        return None

    def _apart(self, part: Part) -> bool:
        """Whether a condition begins anew behind another one's orders."""
        return bool(self.last and self.last.then) and not part.clause.joined

    def _open(self, condition: Condition) -> None:
        made = If(condition)
        self.nodes.append(made)
        self.last, self.target, self.branch = made, made.then, True

    def _trailing(self, condition: Condition) -> Unclear | None:
        what = self.target[-1] if self.target else None
        if not isinstance(what, Orders) or what.part.clause.sentence != condition.part.clause.sentence:
            return Unclear(f"What shall I do if “{condition.part.text}”?")
        if order_wishes(what.part.reading) > 1:
            return Unclear(
                f"What of it depends on “{condition.part.text}”? Please say it in several sentences."
            )
        made = If(condition, [what])
        self.target[-1] = made
        self.last = made
        return None

    def _branch(self, part: Part, positive: bool) -> Unclear | None:
        """To what is done if the last condition holds, or if it does not."""
        self.branch = True
        if self.last is None:
            self._open(Condition(part, positive, again=True))
            return None
        same = positive if part.clause.link == "else" else positive == self.last.condition.holds
        if part.clause.link == "else":
            same = False
        self.target = self.last.then if same else self.last.otherwise
        return None

    def _order_of_time(self, part: Part) -> Unclear | None:
        words = {word for word in part.low if word.isalpha()}
        passed = (
            self.lexicon.classes["done"]
            | self.lexicon.classes["ellipsis"]
            | {"are", "have", "has", "all", "with", "been", "be"}
        )
        if words <= passed and part.clause.link != "before":
            return None
        if part.clause.link == "before" and _goes_on(part):
            return None
        node = Orders(part, is_order=True)
        sought = bool(words & _FINDING and self.target)  # "go to the desk, and when you find Kim, ..."
        if part.clause.link == "when" and not (sought or words & self.lexicon.classes["arriving"]):
            return Unclear(
                f"Shall I see now whether “{part.text}”, or keep it in mind? I cannot wait for it by myself."
            )
        if part.clause.link == "before":
            if part.clause.fronted:
                self.late.append(node)
                self.branch = True
            else:
                self.target.append(node)
        elif part.clause.fronted or not self.target:
            self._put(node)
        else:
            self.target.insert(len(self.target) - 1, node)
        return None

    def _limit(self, part: Part) -> Unclear | None:
        what = self.target[-1] if self.target else None
        if part.clause.fronted:
            self.waiting.append(part)
            return None
        if not isinstance(what, Orders):
            return Unclear(f"What does “{part.text}” belong to?")
        what.limits.append(part)
        return None


_FINDING = frozenset({"find", "found", "locate", "located", "meet", "met"})


def _goes_on(part: Part) -> bool:
    """Whether a clause only speaks of what the robot does anyway: "before you go on", "before leaving"."""
    words = [word for word in part.low if word.isalpha() and word not in ("you", "we", "do")]
    first = lemmas(words[0]) if words else ()
    return {*words} <= _ANYTHING or any(composed((lemma, *words[1:])) == "start" for lemma in first)


_ANYTHING = frozenset({"leave", "leaving", "anything", "everything", "else", "all", "set", "off", "out"})


def arranged(parts: Sequence[Part], lexicon: Lexicon) -> list[Node] | Unclear:
    """The plan that clauses make; or why they make none that is certain."""
    arranger = _Arranger(lexicon)
    for part in parts:
        unclear = arranger.take(part)
        if unclear is not None:
            return unclear
    arranger._closed()
    if arranger.branch or arranger.waiting or arranger.early:
        return Unclear("I do not see what depends on that. Please say what I should do, and when.")
    return arranger.nodes
