"""Parses a message from left to right into orders and what stands between them."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.grammar.groups import Groups
from parley.language.offline.grammar.hanging import Hanging
from parley.language.offline.grammar.orders import Node, Order, Part
from parley.language.offline.grammar.small import base, small, verb_class
from parley.language.offline.grammar.things import Item, items_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.order import phrases_due
from parley.language.offline.words.text import Phrase, keys

__all__ = ["parse"]


_SUBJECTS = frozenset(
    {
        "i",
        "we",
        "they",
        "he",
        "she",
        "it",
        "who",
        "to",
        "will",
        "would",
        "you",
        "is",
        "are",
        "was",
        "were",
        "has",
        "had",
    }
)


def _due(*kinds: str) -> tuple[tuple[str, ...], ...]:
    """What says that something is due then, longest first, without "and" and "but" before it."""
    listed = [tuple(text.split()) for text in phrases_due(*kinds)]
    return tuple(sorted((p for p in listed if p[0] not in {"and", "but"}), key=len, reverse=True))


_FRONT = _due("opening", "early")
_BACK = _due("late", "closing", "kept")


def parse(words: Phrase, scene: Scene) -> list[Part]:
    """The parts of a message in the order in which they were said."""
    return _Parser(items_of(words, scene), scene).parse()


class _Parser(Hanging):
    """Reads one part after the other."""

    def __init__(self, items: Sequence[Item], scene: Scene) -> None:
        super().__init__(items, scene)
        self.scene = scene

    def parse(self) -> list[Part]:
        while self.at < len(self.items):
            before = self.at
            self._step()
            if self.at <= before:
                self.at = before + 1
        return self.parts

    def _step(self) -> None:
        steps = (
            self._manner,
            self._but_first,
            self._mark,
            self._asked_of,
            self._ranked_stop,
            self._made_stop,
            self._sequence,
            self._correction,
            self._subordinate,
            self._give,
            self._topic,
            self._same,
            self._order,
            self._named,
        )
        for step in steps:
            if step():
                return
        self._told()

    def _mark(self) -> bool:
        key = self.key()
        if key in {".", "!", ";", "\n", "?", ":"} or key.startswith(".."):
            self.parts.append(Node("ask" if key == "?" else "stop"))
        elif key == ",":
            self.parts.append(Node("comma"))
        elif (
            key in {"and", "but", "so", "plus", "&", "or", "well", "oh", "right"}
            and self.key(self.at + 1) != "that"
        ):
            pass
        else:
            return False
        self.at += 1
        return True

    def _manner(self) -> bool:
        """What only says how or when, at the start of a clause ("at some point", "if you would")."""
        flat = self.heads.flat(self.at)
        found = lexicon().adverbs.match(flat) if flat else None
        if found is None or found[0] < 2 or small().sequence.match(flat) or small().before_that.match(flat):
            return False
        self.at += found[0]
        return True

    def _but_first(self) -> bool:
        flat = self.heads.flat(self.at)
        before = small().before_that.match(flat) if flat else None
        longer = small().sequence.match(flat) if flat else None
        if before is None or (longer is not None and longer[0] > before[0]):
            return False
        self.parts.append(Node("first"))
        self.at += before[0]
        return True

    def _ranked_stop(self) -> bool:
        """For "the last stop is A", "first port of call: A"."""
        at = self.at
        while self.key(at) in {"the", "your", "and", "then"}:
            at += 1
        rank = self.key(at)
        if rank not in small().sets["stop_ranks"]:
            return False
        end = at + 1
        while self.key(end) in small().sets["stops"] or self.heads.flat(end, 3) == ("on", "the", "list"):
            end += 3 if self.key(end) == "on" else 1
        linked = end
        while (
            self.key(linked) in {"is", "will", "be", "should", "would", "to", ":", ","} and linked - end < 3
        ):
            linked += 1
        another = any(isinstance(part, Order) and part.ranked for part in self.parts)
        short = (end == at + 1 or linked == end) and not another
        if short or linked >= len(self.items) or self.items[linked].thing is None:
            return False
        order = Order("go", words=self.items[at].words)
        self.at = self.args.take(order, linked)
        if rank in {"first", "last", "final"}:
            order.where = "first" if rank == "first" else "last"
        order.ranked = True
        self.parts.append(order)
        return True

    def _made_stop(self) -> bool:
        """For "make A your last stop", "I would like A to be the first stop"."""
        at = self.at
        while self.key(at) in small().sets["stop_frame"]:
            at += 1
        if at >= len(self.items) or self.items[at].thing is None:
            return False
        order = Order("go", words=self.items[at].words)
        behind = end = self.args.take(order, at)
        while self.key(end) in {"to", "be", "is", "should", "will", "must", "as", "your", "the", "our"}:
            end += 1
        rank = self.key(end)
        if end == behind or rank not in {"first", "last", "final"}:
            return False
        if self.key(end + 1) not in small().sets["stops"] or not self.args.ends(end + 2):
            return False
        order.where, order.ranked = "first" if rank == "first" else "last", True
        self.at = end + 2
        self.parts.append(order)
        return True

    def _sequence(self) -> bool:
        flat = self.heads.flat(self.at)
        found = small().sequence.match(flat) if flat else None
        if found is None or (found[1] == "there" and self.key(self.at + 1) in lexicon().be):
            return False
        if flat[0] == "then":
            self.parts.append(Node("then"))
        self.at += found[0]
        return True

    def _correction(self) -> bool:
        flat = self.heads.flat(self.at)
        found = small().corrections.match(flat) if flat else None
        if found is None or found[1] == "wait":
            return False
        if found[1] == "no" and self.key(self.at + 1) != ",":
            return False
        behind = self.at + found[0]
        strong = found[1] not in {"actually", "no", "rather", "better", "sorry", "hold on"}
        if not strong and self.key(behind) == ",":
            behind += 1
        last = next((part for part in reversed(self.parts) if isinstance(part, Order)), None)
        if last is None or not (strong or self.args.starts(behind) or self.items[behind : behind + 1]):
            return False
        self.parts.append(Node("correct"))
        self.at = behind
        return True

    # Clauses that hang on others.

    # What is to be done with something named first.

    def _asked_of(self) -> bool:
        """For "and how many there are", "..., whether it is shut": more of the look before."""
        flat = self.heads.flat(self.at, 2)
        before = next((part for part in reversed(self.parts) if isinstance(part, Order)), None)
        if (
            (flat[:1] != ("whether",) and flat != ("how", "many"))
            or before is None
            or before.kind not in {"look", "go", "named"}
        ):
            return False
        if not (isinstance(self.parts[-1], Node) and self.parts[-1].mark == "comma"):
            return False
        order = Order("whether", refers=True)
        self.at = self.args.state(order, self.at)
        self.parts.append(order)
        return True

    def _same(self) -> bool:
        """For "The same for B", "B as well", "do that at B"."""
        flat = self.heads.flat(self.at)
        found = small().same.match(flat) if flat else None
        if found is None or found[1] in {"too", "also", "as well", "do that", "do it"}:
            return False
        at = self.at + found[0]
        while self.key(at) in small().prepositions | small().adverbs | {"goes", "again", "thing", "please"}:
            at += 1
        order = Order("again")
        named = self.parts and isinstance(self.parts[-1], Node) and self.parts[-1].mark == "comma"
        if named and self.args.ends(at):
            self.at, order.refers = at, True
            self.parts.append(order)
            return True
        if at >= len(self.items) or self.items[at].thing is None:
            return False
        self.at = self.args.take(order, at)
        self.parts.append(order)
        return True

    # Orders, and what is only named or told.

    def _order(self) -> bool:
        start = self.at
        if not super()._order():
            return False
        order = self.parts[-1]
        if self._is_call(start, order):
            self.parts[-1] = Node("told", list(self.items[start : self.at]))
            return True
        if isinstance(order, Order):
            self._stretched(order)
        only = bool({"only", "but"} & {self.key(start), self.key(start - 1)})
        if isinstance(order, Order) and only and order.things and not order.where:
            ends = keys(order.words)
            order.where = "first" if any(ends[-len(p) :] == p for p in _FRONT) else ""
        return True

    def _is_call(self, start: int, order: Part) -> bool:
        """Whether words at the start of a sentence only call somebody: "Look, ...", "dock office here"."""
        last = self.parts[-2] if len(self.parts) > 1 else None
        opens = last is None or (isinstance(last, Node) and last.mark in {"stop", "ask", "told", "comma"})
        if not opens or not isinstance(order, Order) or order.things or not self.args.ends(self.at):
            return False
        flat = keys(order.words)
        called = self.key(self.at) == "," and flat in {("look",), ("see",), ("listen",), ("come", "on")}
        return called or (order.kind == "other" and flat[-1:] == ("here",) and len(flat) <= 4 and start <= 6)

    def _stretched(self, order: Order) -> None:
        """For "start at the first, work your way to the last": all of them, in this order."""
        before = next((p for p in reversed(self.parts[:-1]) if isinstance(p, Order)), None)
        if before is None or len(before.things) != 1 or len(order.things) != 1 or order.kind != "go":
            return
        begins = base(before.words[0].key) if before.words else ""
        way = {"way", "down", "up", "along", "through", "until"} & set(keys(order.words))
        if not way or begins not in small().sets["first"]:
            return
        whole = Groups((), self.scene).between(before.things[0], order.things[0])
        order.things = whole[1:] or order.things
        order.group = bool(whole)

    def _named(self) -> bool:
        """Things and nothing said of them, "not" and the like before them."""
        at, negated = self.at, False
        while self.key(at) in small().sets["before_names"]:
            negated = negated or self.key(at) in {"not", "never"}
            at += 1
        owner = self.items[at + 1] if at + 1 < len(self.items) else None
        if (
            at > self.at
            and self.key(at) in {"your", "my", "our"}
            and owner is not None
            and owner.thing is not None
        ):
            at += 1
        if at >= len(self.items) or self.items[at].thing is None:
            return False
        towards = bool(small().sets["towards"] & set(self.heads.flat(self.at, at - self.at)))
        order = Order("go" if towards and not negated else "named", negated=negated)
        end = self.args.take(order, at)
        if self.key(end) == "and" and self.items[end + 1 : end + 2] and self._is_said_of(end + 1):
            # "A and B were open": told of both.
            return False
        end += self.key(end) == "one" and self.key(end + 1) == "for"
        if self.key(end) == "for" and self.key(end + 1) not in {"me", "us", "now"} and not negated:
            order.kind = "search"
            end = self.args.sought(order, end + 1)
        same = small().same.match(self.heads.flat(end))
        if same is not None and same[0] > 1 and same[1] != "as well":
            order.kind, order.also = "again", True
            end += same[0]
        order.also = order.also or "also" in self.heads.flat(self.at, at - self.at)
        end = self._position(order, end)
        leaves = "from" in self.heads.flat(self.at, at - self.at) and self.heads.head(end) is not None
        if self.heads.flat(end, 2) == ("with", "you") and self.args.ends(end + 2):
            # "Back to the desk with you".
            order.kind, end = "go", end + 2
        calls = (
            self.key(end) == "here"
            and self.args.ends(end + 1)
            and all(isinstance(p, Node) for p in self.parts)
        )
        if calls or (self._says_of_it(end) and not leaves):
            return False
        while self.key(end) in small().adverbs | {
            "'s",
            "you",
            "go",
            "must",
            "should",
            "shall",
            "can",
            "will",
        }:
            order.also = order.also or self.key(end) in {"too", "also", "well"}
            end += 1
        self.parts.append(order)
        self.at = end
        return True

    def _is_said_of(self, at: int) -> bool:
        """Whether a thing stands here of which something is told."""
        thing = self.items[at].thing
        return thing is not None and self.key(at + 1) in {"is", "are", "was", "were", "has", "had", "have"}

    def _counted(self, order: Order, at: int) -> int:
        """For "to start with", "... at the end": where that ends; 0 if it does not stand here."""
        flat = self.heads.flat(at)
        for phrases, where in ((_FRONT, "first"), (_BACK, "last")):
            size = next((len(p) for p in phrases if flat[: len(p)] == p and len(p) > 1), 0)
            if size:
                order.where = "first" if where == "first" else "last"
                return at + size
        return 0

    def _position(self, order: Order, at: int) -> int:
        """For "first", "comes last", "before that" behind a name: where in the plan it belongs."""
        start = at
        ordered = self._counted(order, at)
        if ordered:
            return ordered
        while self.key(at) in {"comes", "goes", "is", "should", "to", "come", "be", ","} and at - start < 3:
            at += 1
        for phrases, where in ((_FRONT, "first"), (_BACK, "last")):
            if at > start and self.key(at) in {"next", "then"}:
                order.also = True
                return at + 1
            size = next((len(p) for p in phrases if self.heads.flat(at)[: len(p)] == p), 0)
            but = self.parts and self.key(self.at - 1) == "but"
            if size and (where == "last" or but or size > 1 or at > start):
                order.where = "first" if where == "first" else "last"
                return at + size
        before = small().before_that.match(self.heads.flat(start))
        if before is not None:
            order.where = "before"
            return start + before[0]
        return start

    def _says_of_it(self, at: int) -> bool:
        """Whether something is said of what was named."""
        key = self.key(at)
        if key == "'s" and not self.args.ends(at + 1):
            return self.key(at + 1) not in {"first", "last", "next", "turn", "as", "too", "also"}
        if key in small().sets["modals"] and self.key(at + 1) in {"have", "be", "not", "already", "still"}:
            return True
        behind = small().sets["behind_names"] | small().adverbs | set(lexicon().ordinals) | {"and"}
        return not self.args.ends(at) and key not in behind

    def _told(self) -> None:
        end = self._told_end(self.at + 1)
        if self.key() in small().questions | {
            "what",
            "why",
            "how",
            "did",
            "do",
            "does",
            "have",
            "has",
            "are",
            "were",
            "was",
            "is",
        }:
            end = next(
                (i for i in range(self.at, len(self.items)) if self.key(i) in {".", "!", "?", ";"}), end
            )
        verb = (
            self.key() != "be"
            and verb_class(self.key())
            and base(self.key()) == self.key()
            and not self.heads.is_talk(self.at)
        )
        opens = not self.parts or not (isinstance(self.parts[-1], Node) and self.parts[-1].mark == "told")
        told = {item.key for item in self.items[self.at : end]}
        ordered = bool(told & small().always) and "<thing>" in told and not told & _SUBJECTS
        self.parts.append(
            Node("told", list(self.items[self.at : end]), unread=bool(verb and opens) or ordered)
        )
        self.at = end
