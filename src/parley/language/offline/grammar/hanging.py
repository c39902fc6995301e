"""Clauses that hang on others: conditions, what comes before or after what, what is waited for."""

from __future__ import annotations

from parley.language.offline.grammar.orders import Node, Order
from parley.language.offline.grammar.small import base, is_past, small, verb_class
from parley.language.offline.grammar.things import Item
from parley.language.offline.grammar.topics import Topics
from parley.language.offline.grammar.verbs import Head
from parley.language.offline.sentences.echoes import leads
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Word

__all__ = ["Hanging"]


_OTHER = {"otherwise": "otherwise", "else": "otherwise", "or else": "otherwise", "if not": "otherwise",
          "if so": "then", "even if": "if", "should": "if"}  # fmt: skip


def _mark(subordinator: str) -> str:
    """What leads a condition in is one of "if", "unless", "otherwise" and "then"; empty for other words."""
    words = tuple(subordinator.split())
    lead = leads().match(words)
    return _OTHER.get(subordinator) or (lead[1] if lead is not None and lead[0] == len(words) else "")


_POINTING = frozenset({"it", "them", "there", "him", "her"})
_BEFORE = frozenset({"before", "prior to"})


_AFTER = frozenset({"after", "once", "when", "as soon as", "having", "following", "upon"})


class Hanging(Topics):
    """Reads the clauses that hang on orders."""

    def _subordinate(self) -> bool:
        flat = self.heads.flat(self.at)
        if flat[:1] == ("only",) and small().subordinators.match(flat[1:]) is not None and flat[1] != "if":
            self.at += 1
            flat = flat[1:]
        if flat[:2] in {
            ("not", "before"),
            ("not", "until"),
            ("only", "after"),
            ("only", "once"),
            ("only", "when"),
        }:
            return self._temporal("after", self.at + 2)
        if flat[:1] in {("until",), ("till",), ("before",)} and self._not_before(self.at + 1):
            return True
        found = small().subordinators.match(flat) if flat else None
        opens = not self.parts or (
            isinstance(self.parts[-1], Node) and self.parts[-1].mark in {"stop", "ask"}
        )
        if opens and flat[:1] in {("who",), ("which",), ("where",)}:
            return False
        if flat[:2] in {("that", "is"), ("that", "means")}:
            self.at += 2
            return True
        if found is None or (found[1] == "should" and self.key(self.at + 1) == "you"):
            return False
        words = tuple(found[1].split())
        if _mark(found[1]):
            return self._condition(words, self.at + found[0])
        if found[1] in _BEFORE | _AFTER:
            return self._temporal("before" if found[1] in _BEFORE else "after", self.at + found[0])
        if found[1] in {"that", "which", "who"} and self.heads.head(self.at) is not None:
            return False
        end = self._told_end(self.at + found[0])
        self.parts.append(Node("told", list(self.items[self.at : end])))
        self.at = end
        return True

    def _not_before(self, start: int) -> bool:
        """For "do not go to A until you have been to B", "A can wait until B is checked": B, then A."""
        last = self.parts[-1] if self.parts else None
        if self.key(start) not in {"you"} and self.items[start : start + 1] == []:
            return False
        if isinstance(last, Order) and last.negated and last.things and not last.refers:
            order: Order | None = last
        elif isinstance(last, Node) and last.mark == "told":
            order = self._waiting(last)
        else:
            order = None
        if order is None:
            return False
        orders, end = self._events(start, mark_is_after=True)
        if not orders or not any(one.things for one in orders):
            return False
        order.negated = False
        self.parts[-1] = order
        self.parts.append(Node("after", orders=orders, only=True))
        self.at = end
        return True

    def _waiting(self, node: Node) -> Order | None:
        """For "A can wait (until ...)": going to A."""
        thing = node.items[0].thing if node.items else None
        words = [item.key for item in node.items[1:]]
        waits = words[-1:] in (["wait"], ["waits"]) and len(words) < 4 and "not" not in words
        return Order("go", things=list(thing.members)) if thing is not None and waits else None

    def _condition(self, words: tuple[str, ...], start: int) -> bool:
        polite = lexicon().adverbs.match(self.heads.flat(self.at)) or lexicon().polite.match(
            self.heads.flat(self.at)
        )
        if polite is not None and polite[0] > 1:
            self.at += polite[0]
            return True
        if words == ("if",) and self._would_be_good(start):
            return True
        mark = _mark(" ".join(words))
        if mark in {"otherwise", "then"}:
            self.parts.append(Node("otherwise" if mark == "otherwise" else "if"))
            self.at = start
            return True
        end = self._order_within(start, self._clause_of_condition(start))
        items = list(self.items[start:end])
        if words == ("should",):
            items = [Item("is", (Word("is", "is"),)) if item.key == "be" else item for item in items]
        also = self.key(self.at - 1) == "and"
        node = Node("unless" if mark == "unless" else "if", items, reason=words[0] == "in", only=also)
        self.parts.append(node)
        self.at = end
        return True

    def _would_be_good(self, start: int) -> bool:
        """For "it would be good if the door got checked", "... if somebody checked the door": an order."""
        last = self.parts[-1] if self.parts else None
        if (
            not isinstance(last, Node)
            or last.mark != "told"
            or not small().sets["good"] & {item.key for item in last.items}
        ):
            return False
        here, self.at = self.at, start
        if self._topic():
            return True
        self.heads.past, past = True, self.heads.past
        self.at = start + 1 if self.key(start) in {"you", "someone", "somebody", "anyone", "we"} else start
        if self.at > start and self._order():
            return True
        self.at, self.heads.past = here, past
        return False

    def _clause_of_condition(self, start: int) -> int:
        """Where a condition ends: at a comma or "then", or where an order begins behind its verb."""
        end, seen = start, False
        while end < len(self.items) and self.key(end) not in {",", ".", "!", "?", ";", ":", "then", "\n"}:
            denied = self.key(end) == "not" and self.key(end - 1) in lexicon().be | lexicon().auxiliaries
            if seen and end > start + 1 and not denied and self._opens(end):
                break
            follows = self.items[end + 1] if end + 1 < len(self.items) else None
            if seen and self.key(end) == "to" and follows is not None and follows.thing is not None:
                break
            seen = (
                seen
                or self.key(end) in lexicon().be | {"has", "have", "does", "you", "contains", "see"}
                or (end > start and bool(verb_class(self.key(end))))
            )
            end += 1
        return end

    def _order_within(self, start: int, end: int) -> int:
        """Where an order begins in a condition that "otherwise" follows ("if S V it, otherwise W")."""
        behind = self.heads.flat(end + (self.key(end) == ","))
        other = small().subordinators.match(behind) if behind else None
        if other is None or _mark(other[1]) != "otherwise":
            return end
        for at in range(end - 2, start + 1, -1):
            word, following = self.key(at), self.items[at + 1]
            verb = base(word) == word and (bool(verb_class(word)) or self.heads.is_own(at))
            acts = following.thing is not None or following.key in lexicon().determiners | _POINTING
            no_verb = self.key(at - 1) in lexicon().determiners | lexicon().be | {"to", "not"}
            if verb and acts and not no_verb:
                return at
        return end

    def _opens(self, at: int) -> bool:
        head = self.heads.head(at)
        if head is None:
            return False
        framed = self.key(at) in {"you", "please", "go", "do", "can", "could", "just"}
        gives = head.gives and base(self.key(at)) in small().light
        return framed or gives or self.key(head.at) in small().always or self._directed(at, head)

    def _directed(self, at: int, head: Head) -> bool:
        """Whether a verb without any mark before it has to be an order: "pop over", "check the door"."""
        if head.at != at or base(self.key(at)) != self.key(at) or self.key(at - 1) in lexicon().determiners:
            return False
        following = self.items[head.end] if head.end < len(self.items) else None
        if following is None:
            return False
        if head.kind == "go":
            return following.thing is not None or self.key(at + 1) in small().sets["directions"]
        named = following.thing is not None or following.key in lexicon().determiners
        return head.kind in small().sets["looks"] and named

    def _temporal(self, mark: str, start: int) -> bool:
        """For "Before A", "after visiting B", "once you have been to C"; what people do then is only told."""
        if self.key(start) in small().sets["inverted"] and self.key(self.at) == "when":
            return False
        joins, self.args.joins = self.args.joins, frozenset({"and"})
        orders, end = self._events(start, mark_is_after=mark == "after")
        self.args.joins = joins
        if not orders and end > start:
            self.at = end
        elif not orders and mark == "after" and (waits := self._happening(start)):
            self.parts.append(waits)
            end = start + len(waits.items)
        elif not orders:
            end = self._told_end(start)
            self.parts.append(Node("told", list(self.items[self.at : end])))
        else:
            only = self.key() in {"only", "not", "having"} or self.key(self.at - 1) == "only"
            self.parts.append(Node("before" if mark == "before" else "after", orders=orders, only=only))
        self.at = end
        return True

    def _happening(self, start: int) -> Node | None:
        """What is waited for ("once A has left"), or has to be so ("when the door is shut")."""
        end = self._clause_of_condition(start)
        items = list(self.items[start:end])
        words = [item.key for item in items]
        if set(words) <= small().sets["done"]:
            return Node("then", items)
        past = any(is_past(word) for word in words[1:]) and not {"has", "have", "is", "are"} & set(words)
        if len(words) < 2 or words[0] in {"you", "we", "i"} or past or {"was", "were", "had"} & set(words):
            return None
        thing = items[0].thing
        if thing is not None and not thing.known and {"is", "are"} & set(words):
            return Node("if", items)
        finite = {"is", "are", "has", "have"} & set(words) or any(
            w.endswith("s") and verb_class(w) for w in words[1:]
        )
        return Node("wait", items) if finite else None

    def _done_there(self, order: Order, done: int) -> tuple[list[Order], int]:
        """For "A is done and B is done": both are gone to."""
        order.kind = "go"
        behind = done + 1 if self.key(done) == "and" else done
        more, stop = self._events(behind, mark_is_after=True) if behind > done else ([], done)
        return [order, *more], (stop if more else done)

    def _only_named(self, order: Order, end: int, start: int) -> tuple[list[Order], int]:
        """What is only named; nothing if something is said of it."""
        says = verb_class(self.key(end)) and self.key(end).endswith("s")
        if says or self.key(end) in lexicon().be | small().needs - {"please"}:
            return [], start
        return [order], end

    def _deed_done(self, at: int) -> tuple[list[Order], int]:
        """For "once you have had a look (at A)": what was done, and where that ends."""
        order, end = Order("go" if small().deeds[self.key(at)] == "go" else "look"), at + 1
        behind = self.items[end + 1] if end + 1 < len(self.items) else None
        if self.key(end) in small().prepositions and behind is not None and behind.thing is not None:
            return [order], self.args.take(order, end + 1)
        return [], end

    def _was_done(self, order: Order, at: int) -> int:
        """For "(once A) has been inspected": where that ends; 0 if nothing like it is said."""
        end = at
        while self.key(end) in lexicon().be | {"'s", "has", "have", "been", "all", "both", "being"}:
            end += 1
        form = base(self.key(end))
        if end == at or form == self.key(end) or small().verbs.get(form) != "look":
            return 0
        order.kind = "look"
        return self.args.looked(order, end + 1)

    def _dealt_with(self, at: int) -> int:
        """For "is done", "has been seen to" behind a name: where that ends; 0 if it does not stand here."""
        end = at
        while self.key(end) in lexicon().be | {"'s", "has", "have", "been", "all"}:
            end += 1
        if end == at or self.key(end) not in small().sets["dealt_with"]:
            return 0
        end += 1
        return end + 1 if self.key(end) in {"to", "with"} and self.items[end + 1 : end + 2] else end

    def _events(self, start: int, *, mark_is_after: bool) -> tuple[list[Order], int]:
        at = start
        while self.key(at) in small().sets["having_been"]:
            at += 1
        if self.key(at - 1) == "both" and mark_is_after and self.parts:
            # "Only after both, the door".
            return [], at
        if at > start and self.key(at) in {"a", "another"} and small().deeds.get(self.key(at + 1)):
            return self._deed_done(at + 1)
        if at < len(self.items) and self.items[at].thing is not None:
            order = Order("named" if at == start else "go")
            end = self.args.take(order, at)
            if self.key(end) in {"comes", "follows"}:
                return [order], end + 1
            passive = self._was_done(order, end) if mark_is_after else 0
            if passive:
                return [order], passive
            done = self._dealt_with(end) if mark_is_after else 0
            return self._done_there(order, done) if done else self._only_named(order, end, start)
        refers = small().back_reference.match(self.heads.flat(at))
        if refers and at == start and mark_is_after:
            return [], at + refers[0]
        if refers and at == start and self.items[at + refers[0] : at + refers[0] + 1]:
            self.parts.append(Node("first"))
            return [], at + refers[0]
        if self.key(at - 1) in {"both", "of"} or (refers and at == start):
            return [], start
        head = self.heads.head(at) if verb_class(self.key(at)) == "" else None
        if head is None and verb_class(self.key(at)):
            size, kind = self.heads.kind(at)
            head = Head(at, size, kind, False, True)
        if head is None:
            return [], start
        order, end = self.args.read(head)
        return ([order], end) if order.kind != "other" or order.things else ([], start)
