"""What belongs to the verb of an order: things, what is looked for, what may be so."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.language.offline.grammar.orders import Order
from parley.language.offline.grammar.small import is_past, small, verb_class
from parley.language.offline.grammar.things import Item
from parley.language.offline.grammar.verbs import Head, Heads
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word

__all__ = ["Arguments", "words_of"]

_HARD = frozenset({".", "!", "?", ";", "\n", ":"})
_AT = frozenset({"in", "on", "at", "to", "along", "into", "inside", "through"})
_LISTS = frozenset({",", "nor", "and", "plus", "&", "then", "or"})

_NO_CLAUSES = frozenset({"that", "who", "which", "where", "as", "following", "upon"})
_RANKS = frozenset({"there", "last", "first", "next", "second"})


def words_of(items: Sequence[Item]) -> Phrase:
    """The words of several items, as they were said."""
    return tuple(word for item in items for word in item.words)


class Arguments:
    """Reads what follows a verb."""

    def __init__(self, items: Sequence[Item], heads: Heads, is_one: Callable[[Phrase], bool]) -> None:
        self.is_one = is_one
        self.items, self.heads = items, heads
        self.joins = _LISTS
        """What may stand between things that are listed."""

    def key(self, at: int) -> str:
        """The word at a position; "." behind the end."""
        return self.heads.key(at)

    def read(self, head: Head) -> tuple[Order, int]:
        """The order that a verb makes with what follows it, and where that ends."""
        order = Order("go", negated=head.negated)
        match head.kind:
            case "other" | "go" | "leave_out" if self._leaves_alone(head):
                order.kind = "leave_out"
                back = small().back_reference.match(self.heads.flat(head.end))
                if back is not None:
                    self.refer(order, back[1])
                end = (head.end + back[0] if back is not None else self.take(order, head.end)) + 1
            case "other" if self._picks(head):
                order.kind = "named"
                end = self.take(order, head.end)
            case "go" if self.key(head.end).endswith("ing") and verb_class(self.key(head.end)) == "other":
                # "Go charging".
                order.kind = "other"
                end = self.clause_end(head.end)
            case "go":
                order.kind = "go"
                end = self._places(order, head.end)
                if self.key(head.at) in {"leave", "let"} and {"alone", "out", "be"} & {
                    self.key(end),
                    self.key(end - 1),
                }:
                    order.kind = "leave_out"
            case "look":
                order.kind = "look"
                end = self.looked(order, head.end)
            case "search" | "count":
                order.kind = "search" if head.kind == "search" else "count"
                start = head.end + 1 if self.key(head.end) == "for" else head.end
                end = self.sought(order, start)
            case "whether":
                order.kind = "whether"
                end = self.state(order, head.end)
            case "leave_out":
                order.kind = "leave_out"
                end = self._places(order, head.end)
            case _:
                order.kind = "other"
                end = self.clause_end(head.end)
        order.words = words_of(self.items[head.at : end])
        return order, end

    def _leaves_alone(self, head: Head) -> bool:
        """For "leave the door alone", "let the others be"."""
        following = self.items[head.end] if head.end < len(self.items) else None
        if self.key(head.at) not in {"leave", "let", "give"} or following is None:
            return False
        back = small().back_reference.match(self.heads.flat(head.end))
        if back is not None:
            return self.key(head.end + back[0]) in {"alone", "be", "out"}
        return following.thing is not None and self.key(self.take(Order("leave_out"), head.end)) in {
            "alone",
            "be",
            "out",
        }

    def _picks(self, head: Head) -> bool:
        """For "choose any of the doors (and go there)": it is only named."""
        thing = self.items[head.end].thing if head.end < len(self.items) else None
        return thing is not None and self.key(head.at) in {"pick", "choose", "select"}

    # Where things end.

    def ends(self, at: int, *, asking: bool = False) -> bool:
        """Whether what belongs to an order ends here; `asking` if "if" goes on with it."""
        if asking and self.key(at) in {"if", "whether"}:
            return False
        if at >= len(self.items) or self.key(at) in _HARD or self.key(at).startswith(".."):
            return True
        if self.key(at) == ",":
            return True
        return self._joins_other(at)

    def _joins_other(self, at: int) -> bool:
        """Whether another part of the message begins here, without a comma."""
        flat = self.heads.flat(at)
        if not flat:
            return False
        if flat[0] in {"and", "but", "then", "plus"}:
            behind = at + 1
            while self.key(behind) in {"and", "then", "but"}:
                behind += 1
            hangs = small().subordinators.match(self.heads.flat(behind))
            if hangs is not None and hangs[1] not in _NO_CLAUSES:
                return True
            then = "then" in {self.key(i) for i in range(at, behind)}
            if then and behind < len(self.items) and self.items[behind].thing is not None:
                return True
            return flat[0] == "but" or self.starts(behind) or self._subject(behind)
        if small().sequence.match(flat) is not None and flat[0] not in _RANKS:
            return True
        if small().before_that.match(flat) is not None:
            return True
        found = small().subordinators.match(flat)
        if flat[0] == "only":
            return small().subordinators.match(flat[1:]) is not None
        return found is not None and (
            found[0] > 1 or flat[0] not in {"where", "that", "which", "who", "as", "upon"}
        )

    def starts(self, at: int) -> bool:
        """Whether an order, or a word of order, begins here."""
        flat = self.heads.flat(at)
        if flat and (small().sequence.match(flat) or small().before_that.match(flat)):
            return True
        return self.heads.head(at) is not None

    def _subject(self, at: int) -> bool:
        """Whether a statement begins here."""
        flat = self.heads.flat(at, 3)
        return (
            bool(flat)
            and flat[0] in small().subjects | {"we", "you", "the", "there", "my", "that", "this"}
            and any(word in small().sets["links"] or is_past(word) for word in flat[1:])
        )

    def clause_end(self, at: int) -> int:
        """Where a clause ends that may have things and verbs of its own."""
        while at < len(self.items) and not self.ends(at):
            at += 1
        return at

    # Things.

    def take(self, order: Order, at: int) -> int:
        """A thing, and those listed with it."""
        while True:
            thing = self.items[at].thing
            if thing is None:
                return at
            members, reversed_to = thing.members, self._backwards(at + 1)
            if "or" in {self.key(at - 1), self.key(at - 2)} and order.things:
                order.unread += 3
            if order.things and self.key(at - 1) in small().sets["via"]:
                order.things[:0] = members
            else:
                order.things += reversed(members) if reversed_to else members
            if reversed_to:
                order.group = True
                return reversed_to
            order.group = order.group or thing.group or len(order.things) > 1
            behind = at + 1
            step = behind
            while self.key(step) in self.joins and step - behind < 2:
                step += 1
            step += step > behind and self.key(step) in _AT
            following = self.items[step] if step < len(self.items) else None
            subject = self.joins is _LISTS and self._is_subject(step)
            if step == behind or following is None or following.thing is None or subject:
                return behind
            at = step

    def refer(self, order: Order, word: str) -> None:
        """Note what a pronoun says of what it stands for."""
        first = word.split()[0]
        order.refers = True
        order.plural = order.plural or first in {
            "them",
            "these",
            "those",
            "they",
            "ones",
            "each",
            "both",
            "all",
            "every",
            "any",
        }
        order.somebody = order.somebody or first in {"him", "her"}
        order.negated = order.negated or first in {"neither", "none"}

    def _backwards(self, at: int) -> int:
        """Where "in reverse order" ends; 0 if it does not stand here."""
        at += self.key(at) == ","
        return at + found[0] if (found := small().backwards.match(self.heads.flat(at))) else 0

    def _is_subject(self, at: int) -> bool:
        """Whether a thing is what the next clause is about ("..., and the door needs checking")."""
        behind = self.heads.flat(at + 1, 2)
        return bool(behind) and behind[0] in small().needs | small().sets["links"] | {"first", "'s"}

    def _places(self, order: Order, at: int) -> int:
        """Behind "go": where to."""
        while not self.ends(at):
            key = self.key(at)
            if self.items[at].thing is not None:
                if order.things and self.key(at - 1) not in small().prepositions | {"and", "then"}:
                    return at
                at = at + 1 if order.things and self._is_beside(at) else self.take(order, at)
                continue
            if self._leads_to_order(at, order):
                return at
            if order.things and key.endswith("ing") and verb_class(key) in small().sets["looks"]:
                # "Go along A looking for B".
                size, kind = self.heads.kind(at)
                inner, end = self.read(Head(at, size, kind, False, True))
                order.kind, order.what = inner.kind, inner.what
                return end
            manner = lexicon().adverbs.match(self.heads.flat(at))
            if manner is not None and manner[0] > 1:
                at += manner[0]
                continue
            back = small().back_reference.match(self.heads.flat(at))
            if back is not None:
                self.refer(order, back[1])
                at += back[0]
                continue
            if (
                key
                not in small().prepositions
                | small().adverbs
                | small().determiners
                | {"your", "way", "'s", "and"}
                or key == "between"
            ):
                order.unread += 1
            at += 1
        return at

    def _is_beside(self, at: int) -> bool:
        """Whether a thing only says where the one before it is ("the desk near the door")."""
        flat = [self.key(i) for i in range(max(0, at - 3), at)]
        before = [self.items[i].thing is not None for i in range(max(0, at - 3), at)]
        return (
            any(before)
            and flat[-1] in small().sets["beside"] | {"to"}
            and (flat[-1] != "to" or flat[-2] in small().sets["beside"])
        )

    def _leads_to_order(self, at: int, order: Order) -> bool:
        """Whether the purpose of going begins here ("to check ..."), or another order without any mark."""
        key = self.key(at)
        if key in {"to", "and"} and self.heads.head(at + 1) is not None:
            return True
        if key in small().sets["whether"] and key not in {"that", "what"} and bool(order.things):
            return True
        done = bool(order.things or order.refers) or key not in small().adverbs
        goes = verb_class(key) and self.key(at + 1) in {"to", "over", "back"}
        return bool(
            done and (key in small().always | {"check", "look"} or goes) and self.heads.head(at) is not None
        )

    # What is looked for.

    def looked(self, order: Order, at: int) -> int:
        """Behind "look": at what, for what, whether what."""
        where = small().back_reference.match(self.heads.flat(at + 1))
        if self.key(at) in small().sets["hiding"] and where is not None:
            order.kind, order.what = "search", (Word("anything", "anything"), *self.items[at].words)
            self.refer(order, where[1])
            return at + 1 + where[0]
        while not self.ends(at, asking=True):
            passed = self._past_small(order, at)
            if passed:
                at = passed
                continue
            if self.items[at].thing is not None:
                if order.things and self.key(at - 1) not in small().prepositions:
                    return at
                state = self._finite_behind(at)
                if state:
                    order.kind, order.what = "whether", words_of(self.items[at:state])
                    order.things += self._things(at, state)
                    return state
                at = self.take(order, at)
                at = self.part(order, at)
                continue
            if self.key(at) == "for" and self.key(at + 1) not in {"me", "us"}:
                order.kind = "search"
                return self.sought(order, at + 1)
            if self._asks(at):
                order.kind = "whether"
                return self.state(order, at)
            return at if self._leads_to_order(at, order) else self._seen(order, at)
        return at

    def _past_small(self, order: Order, at: int) -> int:
        """Where small words behind "look" end; 0 if none stand here."""
        key, flat = self.key(at), self.heads.flat(at)
        manner = lexicon().adverbs.match(flat)
        if manner is not None and manner[0] > 1:
            return at + manner[0]
        if self.items[at].thing is not None or self._asks(at) or self._leads_to_order(at, order):
            return 0
        back = small().back_reference.match(flat)
        if back is not None and self.key(at + back[0]) not in small().sets["links"]:
            self.refer(order, back[1])
            at += back[0]
            return at + 3 if self.heads.flat(at, 2) in {("that", "you"), ("which", "you")} else at
        someone = key in {"somebody", "someone"} and self.key(at - 1) == "by"
        passed = (
            key in small().sets["among"] or someone or key in small().prepositions | small().adverbs | {"'s"}
        )
        return at + 1 if passed and not (key == "for" and self.key(at + 1) not in {"me", "us"}) else 0

    def _asks(self, at: int) -> bool:
        """Whether what may be so begins here ("if ...", "there is ...", "to see ...")."""
        key, following = self.key(at), self.key(at + 1)
        if key == "that":
            return self.key(at - 1) not in small().prepositions
        there = key == "there" and following in lexicon().be
        return there or key in small().sets["whether"] or (key == "to" and following in {"see", "check"})

    def part(self, order: Order, at: int) -> int:
        """For "the incubator display", "tank 1's gauge": what of the thing is meant."""
        start = at + 1 if self.key(at) == "'s" else at
        end = start
        while end < len(self.items) and self._is_noun(end):
            end += 1
        if end > start:
            order.what = words_of(self.items[start:end])
        return max(end, start)

    def _is_noun(self, at: int) -> bool:
        key = self.key(at)
        if self.items[at].thing is not None or not key[:1].isalpha() or self.ends(at):
            return False
        closed = (
            small().sets["finite"]
            | small().prepositions
            | small().adverbs
            | small().determiners
            | small().frame
            | small().sets["whether"]
        )
        if verb_class(key) and self.key(at + 1) in {"to", "at", "into", "over", "back"}:
            return False
        closed |= small().always | small().sets["no_parts"]
        return key not in closed and key not in lexicon().be and not self.heads.flat(at)[0].endswith("ly")

    def _seen(self, order: Order, at: int) -> int:
        """For "check the drip trays under tank 3", "check there are no boxes": what no map knows."""
        end = self.clause_end(at)
        order.unread += self.key(at) in {"whatever", "whoever", "wherever"}
        whole = words_of(self.items[at:end])
        if not order.things and self.is_one(whole):
            order.things.append(whole)
            return end
        flat = [self.key(i) for i in range(at, end)]
        if (
            any(key in lexicon().be | {"has", "have", "works", "can"} for key in flat[1:])
            and "that" not in flat
        ):
            order.kind = "whether"
            return self.state(order, at)
        order.kind = "search"
        return self.sought(order, at)

    def sought(self, order: Order, at: int) -> int:
        """Behind "look for": what, and where."""
        start = at
        back = small().back_reference.match(self.heads.flat(at))
        if (
            back is not None
            and self.key(at + back[0]) in small().prepositions | {",", ".", "!", "?"} | small().adverbs
        ):
            self.refer(order, back[1])
            at += back[0]
            start = at
        end = at
        while not self.ends(end) or self._more_what(end):
            key = self.key(end)
            where = self.key(end - 1) in small().prepositions and self.key(end - 1) != "of"
            if self.items[end].thing is not None and (end > start or order.refers) and where:
                break
            if key in small().prepositions and small().back_reference.match(self.heads.flat(end + 1)):
                break
            if key in small().stop_what or (key in {"to", "in"} and self.heads.head(end + 1) is not None):
                break
            if end > start and key in small().always and self.heads.head(end) is not None:
                break
            end += 1
        stop = end
        while stop > start and self.key(stop - 1) in small().prepositions | small().adverbs | {","}:
            if self.key(stop - 1) == "way" and self.key(stop - 2) in small().determiners:
                break
            stop -= 1
        order.what = _plain_what(words_of(self.items[start:stop])) or order.what
        if end < len(self.items) and self.items[end].thing is not None:
            end = self.take(order, end)
        return self._sought_where(order, end)

    def _sought_where(self, order: Order, end: int) -> int:
        """Past small words and "at each of them" behind what is looked for."""
        while not self.ends(end):
            back = small().back_reference.match(self.heads.flat(end))
            small_word = self.key(end) in small().adverbs | small().prepositions | {"both", "all"}
            if not small_word and (back is None or self.key(end - 1) not in small().prepositions):
                break
            if back is not None:
                self.refer(order, back[1])
            end += back[0] if back is not None else 1
        return end

    def _more_what(self, at: int) -> bool:
        """For "cracks and leaks", "cups, plates and spoons": what is looked for goes on."""
        if at >= len(self.items) or self.key(at) not in {",", "and", "or"}:
            return False
        behind = at + 1
        while self.key(behind) in {"and", "or"}:
            behind += 1
        if behind >= len(self.items) or self.items[behind].thing is not None or self.starts(behind):
            return False
        after = self.key(behind + 1)
        if not self._is_noun(behind) or self._subject(behind):
            return False
        return after in {",", ".", "!", "?", "and", "or", "in", "at", "on"} or self._is_noun(behind + 1)

    # What may be so.

    def _finite_behind(self, at: int) -> int:
        """For "check the door is shut": where a statement that begins at a thing ends; 0 if none does."""
        key = self.key(at + 1)
        if key in lexicon().be | {"has", "works", "needs", "looks", "have", "can"} or (
            key.endswith("s")
            and verb_class(key)
            and self.key(at + 2) in small().determiners | small().adverbs
        ):
            return self.clause_end(at + 1)
        return 0

    def state(self, order: Order, at: int) -> int:
        """Behind "see": if what is so."""
        end = self.clause_end(at + 1) if at < len(self.items) and self.key(at) not in _HARD else at
        while self.key(end) == "," and self.key(end + 1) in small().sets["whether"] - {"that", "if"}:
            end = self.clause_end(end + 2)
        start = at
        while start < end and self.key(start) in {"if", "whether", "that", "to", "see", "out", "for"}:
            start += 1
        # "Check how full it is": the question is kept.
        order.what = words_of(self.items[start - (start == at and self.key(start - 1) == "how") : end])
        order.things += self._things(start, end) if not order.refers else []
        for i in range(start, end):
            back = small().back_reference.match(self.heads.flat(i))
            if back is not None and back[0] > 1 and i + back[0] == end:
                self.refer(order, back[1])
        if order.what and all(
            item.thing is not None or item.key in small().sets["at_large"] for item in self.items[start:end]
        ):
            # "How it looks", "what is there": nothing in particular.
            order.kind, order.what, order.refers = "look", (), True
        return end

    def _things(self, start: int, end: int) -> list[Phrase]:
        found: list[Phrase] = []
        for item in self.items[start:end]:
            if item.thing is not None:
                found += item.thing.members
        return found


def _plain_what(words: Phrase) -> Phrase:
    """Without what only leads to what is looked for ("any", "some", "signs of")."""
    leads = {"me", "us", "any", "some", "a", "an", "the", "possible", "signs", "of", "sort", "kind", "more"}
    while len(words) > 1 and words[0].key in leads:
        words = words[1:]
    return words
