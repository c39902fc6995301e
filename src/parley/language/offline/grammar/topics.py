"""Orders that begin with what they are about, and where an order begins in what is told."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.grammar.arguments import Arguments, words_of
from parley.language.offline.grammar.orders import Order, Part
from parley.language.offline.grammar.small import base, is_past, small
from parley.language.offline.grammar.things import Item
from parley.language.offline.grammar.verbs import Heads
from parley.language.offline.scene.scene import Scene

__all__ = ["Topics"]


class Topics:
    """A message read from left to right: what is to be done with something that is named first."""

    def __init__(self, items: Sequence[Item], scene: Scene) -> None:
        self.items = items
        self.heads = Heads(items, scene.catalogue)
        self.args = Arguments(items, self.heads, lambda words: scene.ground(words).outcome == "match")
        self.at = 0
        self.parts: list[Part] = []

    def key(self, at: int | None = None) -> str:
        """The word at a position, or where the parser stands; "." behind the end."""
        return self.heads.key(self.at if at is None else at)

    def _give(self) -> bool:
        """For "give each of them the once-over", "pay the desk a visit"."""
        at = self.at
        while self.key(at) in {
            "please",
            "and",
            "then",
            "you",
            "can",
            "could",
            "just",
            "quickly",
            "also",
            "to",
        }:
            at += 1
        if self.key(at) not in {"give", "pay", "do"}:
            return False
        order = Order("look")
        back = small().back_reference.match(self.heads.flat(at + 1))
        if back is not None:
            self.args.refer(order, back[1])
            end = at + 1 + back[0]
        else:
            end = self.args.take(order, at + 1) if at + 1 < len(self.items) else at + 1
        deed = end
        while self.key(deed) in small().determiners | {
            "quick",
            "brief",
            "good",
            "thorough",
            "proper",
            "short",
            "close",
            "little",
            "closer",
            "full",
        }:
            deed += 1
        kind = small().deeds.get(self.key(deed), "") if deed > end > at + 1 else ""
        if kind not in {"look", "go", "search"}:
            return False
        order.kind = "go" if kind == "go" else "look"
        self.at = self.args.looked(order, deed + 1) if kind == "look" else deed + 1
        self.parts.append(order)
        return True

    def _topic(self) -> bool:
        """For "The gate needs a check for ice", "I want the gate looked at", "a check of the gate"."""
        at = self.at
        lead = self.heads.flat(at)
        wants = at
        if lead[:2] in {("i", "have"), ("we", "have"), ("you", "have"), ("i", "like"), ("we", "like")}:
            return False
        while self.key(wants) in small().frame and self.items[wants].thing is None and wants - at < 8:
            wants += 1
        thing = self.items[wants].thing if wants < len(self.items) else None
        if thing is None:
            return False
        framed = self._wants(lead[: wants - at])
        if wants > at and not framed:
            return False
        order = Order("go")
        behind = self.args.take(order, wants)
        if self._wants_there(lead[: wants - at]):
            self.parts.append(order)
            self.at = behind
            return True
        part = self.args.part(order, behind) if self.key(behind) == "'s" else behind
        while part > behind and self.key(part - 1) in small().needs:
            part -= 1
        behind = part
        needs = behind
        while self.key(needs) in small().needs | small().sets["needs_to_be"] and needs - behind < 9:
            needs += 1
        if needs == behind and not framed:
            return False
        return self._needed(order, behind, needs)

    def _wants_there(self, lead: tuple[str, ...]) -> bool:
        """Whether the words before a thing only want the robot there ("I need you over at ...")."""
        if lead[-1:] not in {("at",), ("in",), ("by",), ("near",), ("on",), ("over",)}:
            return False
        return lead[-2:-1] == ("you",) or lead[-3:-1] in {("you", "over"), ("you", "back"), ("you", "up")}

    def _wants(self, lead: tuple[str, ...]) -> bool:
        """Whether the words before a thing ask for something to be done with it."""
        if lead[-2:] == ("it", "is") or (len(lead) > 1 and lead[-1] in {"have", "get"}):
            return True
        return bool(set(lead) & (small().wishes | {"get", "have"})) and "to" not in lead

    def _needed(self, order: Order, behind: int, needs: int) -> bool:
        """What a thing needs: "looking at", "checked", "a visit"."""
        if self.heads.flat(behind + 1, 2) == ("you", "to") or self.key(behind) == "had":
            # "Somebody wants you to V": who wants it.
            return False
        if needs > behind and self._part_needed(order, needs):
            return True
        key = self.key(needs)
        between = set(self.heads.flat(behind, needs - behind))
        deed = small().deeds.get(key, "") if between & {"a", "an", "another", "the"} else ""
        form = base(key)
        passive = not between or bool(
            between & {"be", "to", "want", "wants", "need", "needs", "require", "requires", "could"}
        )
        passive = passive or bool(between & {"deserves", "deserve", "got", "were", "was", "gets"})
        verb = small().verbs.get(form, "") if passive and (form != key or "to" in between) else ""
        kind = deed or (verb if verb != "go" or form == "visit" or "to" in between else "")
        if kind not in {"look", "go", "search", "count"} or form in {"start", "begin", "finish", "end"}:
            return False
        order.kind = "look" if kind != "go" else "go"
        order.negated = "not" in self.heads.flat(behind, needs - behind)
        at = needs + 1
        if kind == "look":
            at = self.args.looked(order, at)
        elif self.key(at) == "for":
            order.kind = "search"
            at = self.args.sought(order, at + 1)
        self.parts.append(order)
        self.at = at
        return True

    def _part_needed(self, order: Order, at: int) -> bool:
        """For "the boat needs its lamp checked", "... wants the oil looking at": what of it is looked at."""
        start = at + 1 if self.key(at) in {"its", "their", "his", "her", "the", "a"} else at
        if self.key(at - 1) in {"a", "the"}:
            start = at
        end = start
        while end < len(self.items) and end - start < 4 and not self._looked_at(end):
            if not self.items[end].key.isalpha() or self.args.ends(end):
                return False
            end += 1
        if end == start or end >= len(self.items) or start == at == end or not self._looked_at(end):
            return False
        if self.key(start - 1) not in {"its", "their", "his", "her", "the", "a"}:
            return False
        order.kind, order.what = "search", words_of(self.items[start:end])
        order.negated = "not" in self.heads.flat(at - 2, 2)
        self.parts.append(order)
        self.at = self.args.looked(Order("look"), end + 1)
        return True

    def _looked_at(self, at: int) -> bool:
        """Whether "checked", "looking at" or the like stands here."""
        key = self.key(at)
        form = base(key)
        return (
            form != key
            and small().verbs.get(form, "") in {"look", "whether"}
            and key not in {"read", "watches"}
        )

    def _order(self) -> bool:
        start, refers = self.at, False
        there = small().back_reference.match(self.heads.flat(start + 1))
        if self.key() in {"at", "in", "on", "with", "for"} and there is not None:
            start, refers = start + 1 + there[0], True
        head = self.heads.head(start)
        if head is None:
            return False
        self.heads.past = self.heads.past or is_past(self.key(head.at))
        order, end = self.args.read(head)
        order.refers = order.refers or refers
        self.parts.append(order)
        self.at = max(end, head.at + 1)
        return True

    def _is_topic(self, at: int) -> bool:
        """Whether what is to be done with something begins here; nothing is taken."""
        here, parts = self.at, list(self.parts)
        self.at = at
        found = self._topic()
        self.at, self.parts = here, parts
        return found

    def _told_end(self, at: int) -> int:
        start, intends = max(at - 1, 0), {"will", "would", "shall", "going", "must"}
        while at < len(self.items) and self.key(at) not in {",", ".", "!", "?", ";", ":", "\n"}:
            goes_on = self.key(at) == "and" and bool(intends & {self.key(i) for i in range(start, at)})
            if self.key(at) in {"so", "and", "but"} and not goes_on and self.args.starts(at + 1):
                break
            if self._breaks_in(at) and (self.args.starts(at) or self._is_topic(at)):
                break
            at += 1
        return at

    def _breaks_in(self, at: int) -> bool:
        """Whether an order may begin here in the middle of what is told."""
        key = self.key(at)
        if key not in small().sets["openers"] or self.key(at - 1) in small().sets["speakers"]:
            return False
        return key not in {"can", "could", "would", "will"} or self.key(at + 1) in {
            "you",
            "someone",
            "somebody",
        }
