"""From the logic of a message to deeds: in order, under conditions, so many times, after a while."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from parley.language.builtin.amounts import amount_of
from parley.language.builtin.checks import Look
from parley.language.builtin.decision import Ask, Deed, Note
from parley.language.builtin.deeds import Builder
from parley.language.builtin.lexicon import Lexicon, lemmas
from parley.language.builtin.reading import Reading
from parley.language.builtin.spans import Filler
from parley.language.builtin.structure import If, Node, Orders, Part
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.map_words import named

__all__ = ["NO_DEED", "Planner", "contradicted", "doubt", "orders_of"]

NO_DEED = frozenset({"BELOC", "BECAT", "REMEMBER", "FORGET"})
_NO_ORDER = frozenset({"told", "social", "need"})
_WHO_SAYS = frozenset({"i", "we", "he", "she", "they", "somebody", "someone"})
_IN_PLACE = frozenset({"SAY", "PHOTO", "DO", "WAIT", "TURN"})
"""What is done so often by itself, wherever that is."""
_SPOKEN_OF = frozenset({"it", "them", "there", "they", "each", "one", "these", "those"})
_STAYING = frozenset({"wait", "stay", "stand", "remain", "park"})
_VIA = frozenset({"via", "past", "through"})
"""What leads to a place on the way to another."""


def orders_of(reading: Reading) -> tuple[Wish, ...]:
    """The wishes of a reading that are to be carried out, and those that are forbidden."""
    return tuple(
        wish
        for wish in reading.wishes
        if wish.act in ("order", "edit", "answer") and wish.frame not in NO_DEED
    )


@dataclass(slots=True)
class Planner:
    """Makes the deeds of all that a message wants."""

    builder: Builder
    first: Node | None = None
    """What stands before all the rest, if there is more."""
    last: Wish | None = None
    """What was wanted last of something that was named."""

    def planned(self, nodes: Sequence[Node]) -> list[Deed] | Ask:
        """The deeds of nodes, in order."""
        deeds: list[Deed] = []
        self.first = next(iter(nodes), None) if len(nodes) > 1 and self.first is None else self.first
        for node in nodes:
            made = self._if(node) if isinstance(node, If) else self._orders(node)
            if isinstance(made, Ask):
                return made
            deeds = _joined(deeds, made)
        return deeds

    # -- conditions --

    def _if(self, node: If) -> list[Deed] | Ask:
        condition = node.condition
        looked = Look([]) if condition.again else self.builder.check(condition.part)
        if isinstance(looked, Ask):
            return looked
        wanted = condition.holds == looked.holds
        check = self.builder.last_check
        if check is None:
            return Ask(f"What does “{condition.part.text}” depend on? Please tell me what I should look at.")
        place, deeds = self.builder.at, [*looked.deeds]
        places = [place]
        for branch, holds in ((node.then, wanted), (node.otherwise, not wanted)):
            self.builder.at = place
            made = self.planned(branch)
            if isinstance(made, Ask):
                return made
            made = _from(place, made)
            if any(deed.check is not None for deed in made):
                return Ask("Several conditions depend on each other here. Can you say one after the other?")
            deeds += [replace(deed, check=check, holds=holds) for deed in made]
            places.append(self.builder.at)
        self.builder.at = place if len(set(places)) == 1 else ""
        self.builder.last_check = check
        return deeds

    # -- orders --

    def _orders(self, node: Orders) -> list[Deed] | Ask:
        reading = node.part.reading
        if self._only_says_why(node):
            self.builder.notes.append(Note(f"I take “{node.part.text}” for the reason."))
            return []
        if node.is_order:
            reading = self._as_ordered(node.part)
        elif not orders_of(reading) and (node.branch or self.last) and not reading.acts & _NO_ORDER:
            elided = self._elided(node.part)
            if isinstance(elided, Ask):
                return elided
            reading = elided
        wishes = tuple(self.builder.joined(wish) for wish in orders_of(reading))
        known = self.builder.situation
        idle = not known.queue and known.dialogue.proposal is None
        unsure = doubt(reading, wishes, self.builder.knows, idle=idle)
        if unsure is not None:
            if not may_be_offered(reading, wishes, self.builder.lexicon):
                return unsure
            self.builder.doubts = (unsure, " ".join(reading.left_over) or "…")
        limited = self._limited(node, wishes)
        if isinstance(limited, Ask):
            return limited
        wishes, times, before = limited
        unused = self._heard(reading, wishes)
        if unused is not None:
            return unused
        deeds: list[Deed] = []
        for _ in range(times):
            made = self._done(wishes)
            if isinstance(made, Ask):
                return made
            deeds += made
        return [*before, *deeds]

    def _only_says_why(self, node: Orders) -> bool:
        """Whether a clause before the orders tells of a need and names nothing: "we expect guests"."""
        reading, builder = node.part.reading, self.builder
        needs = [wish for wish in reading.wishes if wish.act == "need" and not wish.fillers]
        things = named(node.part.parse.tokens, builder.situation.objects, builder.lexicon)
        vague = needs and len(needs) == len(reading.wishes) and not things
        return bool(vague and not node.limits and self.first is node)

    def _elided(self, part: Part) -> Reading | Ask:
        """What is wanted of a thing without a word for it: what was wanted of the last one."""
        words = tuple(
            w for w in part.low if w[0].isalnum() and w not in self.builder.lexicon.classes["small"]
        )
        named = Filler("T", 0, len(words), len(words) - 1, words, 1.0, " ".join(words))
        last = self.last
        if words and last is not None and self.builder.is_called(named):
            role = "G" if last.frame == "GO" else "T"
            kept = tuple(filler for filler in last.fillers if filler.role not in "TGLA")
            wish = replace(last, start=0, fillers=(*kept, replace(named, role=role)), negated=False)
            return Reading(frozenset({"order"}), (wish,), (), ())
        return Ask(f"What shall I do with “{part.text.strip(' ,.')}”? Please say it in other words.")

    def _heard(self, reading: Reading, wishes: Sequence[Wish]) -> Ask | None:
        """Take up what is spoken of besides the orders; a question if it is neither used nor said."""
        self.builder.told_about(reading.about)
        if reading.manner:
            self.builder.unheeded(" ".join(reading.manner))
        for filler in reading.loose:
            if filler.role == "T" and not self._is_referred_to(filler, wishes):
                return Ask(f"What shall I do with “{filler.text}”? Please say it in other words.")
            self.builder.loose(filler)
        for wish in reading.wishes:
            if wish.frame == "BELOC":
                for filler in wish.fillers:
                    self.builder.loose(filler)
        return None

    @staticmethod
    def _is_referred_to(filler: Filler, wishes: Sequence[Wish]) -> bool:
        """Whether one of these wishes is about what was spoken of before: "it", "there", or nothing named."""
        behind = [f for wish in wishes for f in wish.fillers if f.start > filler.start]
        about = [{*f.words} for f in behind if f.role in "TGLSRK"]
        return not wishes or any(words & _SPOKEN_OF for words in about) or len(about) < len(wishes)

    def _as_ordered(self, part: Part) -> Reading:
        """What is said of an order of time, as what is wanted: "after visiting the yard"."""
        reading = part.reading
        wishes = tuple(replace(wish, act="order") for wish in reading.wishes if wish.frame not in NO_DEED)
        if not wishes:
            words = part.low
            if words[:1] and words[0] in _WHO_SAYS:  # "before I tell you" names no place
                return replace(reading, left_over=words)
            size = next((at + 1 for at in reversed(range(len(words))) if words[at].isalnum()), 0)
            place = Filler("G", 0, size, max(size - 1, 0), words[:size])
            wishes = (Wish("GO", 0, "", (place,), 1.0, "agrees"),) if size else ()
            return Reading(frozenset({"order"}), wishes, (), ())
        end = max((f.end for wish in wishes for f in wish.fillers), default=len(part.low))
        small = self.builder.lexicon.classes["small"]
        behind = part.parse.tokens[end:]  # "... the incubator for mould"
        rest = tuple(token.text for token in behind if token.is_word and token.low not in small)
        return replace(reading, acts=frozenset({"order"}), wishes=wishes, left_over=rest)

    def _done(self, wishes: Sequence[Wish]) -> list[Deed] | Ask:
        deeds: list[Deed] = []
        rest = list(wishes)
        while rest:
            *between, wish = self._by_way_of(rest.pop(0))
            if between:
                rest = [*between, wish, *rest]
                wish = rest.pop(0)
            self.last = wish if wish.frame in ("GO", "LOOK") and wish.has("TG") else None
            if wish.negated:
                self.builder.forbidden(wish)
                continue
            row = [wish, *itertools.takewhile(_is_listed, rest)] if wish.frame == "GO" else [wish]
            there = self._also(rest[len(row) - 1 :]) if len(row) > 1 else []
            if there and all(
                one.frame == "LOOK" for one in there
            ):  # "to the desk and the gate, and see if ..."
                del rest[: len(row) - 1 + len(there)]
                rest = [*(one for place in row for one in (place, *there)), *rest]
                wish = rest.pop(0)
            self.builder.behind = next((one for one in rest if not one.negated), None)
            made = self.builder.deeds(wish)
            if isinstance(made, Ask):
                return made
            also = self._also(rest) if self.builder.each else []
            if also:
                del rest[: len(also)]
                together = self._for_each([wish, *also])
                if isinstance(together, Ask):
                    return together
                made = together
            deeds = _joined(deeds, _without_way(deeds, made))
        return deeds

    def _by_way_of(self, wish: Wish) -> tuple[Wish, ...]:
        """A way with what it leads by, if the map knows that, as ways of their own: "via the yard"."""
        small, between = self.builder.lexicon.classes["determiners"], list[Filler]()
        for filler in wish.all("M") + wish.all("P") if wish.frame == "GO" and wish.has("G") else ():
            words = tuple(itertools.dropwhile(small.__contains__, filler.words[1:]))
            named = Filler("G", filler.start, filler.end, len(words) - 1, words)
            if filler.words[0] in _VIA and words and self.builder.is_called(named):
                between.append(named)
        met = {filler.start for filler in between}
        last = replace(wish, fillers=tuple(filler for filler in wish.fillers if filler.start not in met))
        return (*(replace(wish, fillers=(place,)) for place in between), last)

    def _also(self, rest: Sequence[Wish]) -> list[Wish]:
        """The wishes behind one about a set that are about each of it: "... and take a picture there"."""
        found = []
        for wish in rest:
            words = {word for filler in wish.fillers for word in filler.words if filler.role not in "XE"}
            here = wish.frame in ("PHOTO", "LOOK") and not self.builder.names_place(wish)
            if wish.negated or not (words & _SPOKEN_OF or here):
                break
            found.append(wish)
        return found

    def _for_each(self, wishes: Sequence[Wish]) -> list[Deed] | Ask:
        deeds: list[Deed] = []
        for one in self.builder.each:
            self.builder.bound = one
            for wish in wishes:
                made = self.builder.deeds(wish)
                if isinstance(made, Ask):
                    return made
                deeds = _joined(deeds, _without_way(deeds, made))
        self.builder.bound = None
        return deeds

    def _limited(
        self, node: Orders, wishes: tuple[Wish, ...]
    ) -> tuple[tuple[Wish, ...], int, list[Deed]] | Ask:
        """What the limits of a clause make of its wishes: how often they are done, and what comes before."""
        times, before = 1, list[Deed]()
        for limit in node.limits:
            words = tuple(word for word in limit.low if word.isalnum() or "-" in word)
            match limit.clause.link:
                case "times":
                    often = self._so_often(limit.text, words, wishes)
                    if isinstance(often, Ask):
                        return often
                    wishes, times = often
                case "delay" if any(wish.frame == "SAY" for wish in wishes):
                    return Ask(f"Shall I say it {limit.text}, or is that part of what I say?")
                case "delay":
                    waited = self.builder.waiting(f"for {' '.join(words[1:])}", words[1:])
                    if isinstance(waited, Ask):
                        return waited
                    before.append(waited)
                case "except":
                    words = tuple(word for word in words if word not in ("please", "out"))
                    kept = tuple(wish for wish in wishes if not self.builder.names_same(words, [wish]))
                    fillers = [filler for wish in wishes for filler in wish.all("T") + wish.all("G")]
                    single = fillers and kept == wishes and all(map(self.builder.is_one, fillers))
                    small = self.builder.lexicon.classes["determiners"]
                    called = tuple(word for word in words if word not in small)
                    if single and self.builder.is_one(Filler("T", 0, len(called), len(called) - 1, called)):
                        self.builder.left_undone(f"not {limit.text}")
                        continue
                    self.builder.left_out = () if 0 < len(kept) < len(wishes) else words
                    wishes = kept or wishes
                case "not":
                    if not self._excluded(limit, wishes):
                        return Ask(
                            f"I do not see what “not {limit.text}” means. Please say what I should do."
                        )
                case "until" if words and wishes and (lasting := _until(wishes, words, limit.text)):
                    wishes = lasting
                case _:
                    return Ask(f"I cannot tell by myself when “{limit.text}” is. What shall I do now?")
        return wishes, times, before

    @staticmethod
    def _so_often(
        text: str, words: tuple[str, ...], wishes: tuple[Wish, ...]
    ) -> tuple[tuple[Wish, ...], int] | Ask:
        """Wishes that are done so often: all of them, or the last alone where that needs no way."""
        amount = amount_of(words[:1])
        times = int(amount.value) if amount else 0
        if not 1 <= times <= 10:
            return Ask(f"I cannot do that {text} on end. How many times shall I do it?")
        if len({wish.frame for wish in wishes}) > 1 and wishes[-1].frame in _IN_PLACE:
            often = Filler("O", 0, len(words), 0, words)  # "go there and honk twice"
            return (*wishes[:-1], replace(wishes[-1], fillers=(*wishes[-1].fillers, often))), 1
        return wishes, times

    def _excluded(self, limit: Part, wishes: Sequence[Wish]) -> bool:
        """Take up what is not wanted: a part of a set, another thing, another deed."""
        reading = limit.reading
        words = tuple(word for word in limit.low if word.isalnum() or "-" in word)
        if not words:
            return False
        fillers = [filler for wish in wishes for filler in wish.all("T") + wish.all("G")]
        verbal = any(wish.frame not in NO_DEED and wish.verb for wish in reading.wishes)
        if any(self.builder.names_set(f, words) if verbal else self.builder.names_set(f) for f in fillers):
            self.builder.left_out = words
            return True
        if verbal:
            self.builder.left_undone(f"not {limit.text}")
            return True
        self.builder.left_undone(f"not {limit.text}")
        return not self.builder.names_same(words, wishes)


def contradicted(deeds: Sequence[Deed], refused: Sequence[tuple[str, str]]) -> Ask | None:
    """A question where the same message says to do something and not to: not yet, not first, not at all?

    Args:
        deeds: Of the whole message.
        refused: Frame and thing of what is not to be done.
    """
    for deed in deeds:
        said = {str(words).removeprefix("the ") for words in (*deed.arguments.values(), *deed.said.values())}
        thing = next((name for frame, name in refused if deed.frame == frame and name in said), "")
        if thing:
            return Ask(f"Of the {thing} you say that I should, and that I should not. What shall I do?")
    return None


def _without_way(deeds: Sequence[Deed], more: list[Deed]) -> list[Deed]:
    """Without the way to where the last deeds have led already."""
    ways = [deed for deed in deeds if deed.frame == "GO"]
    size = len([deed for deed in more if deed.frame == "GO"])
    there = size and deeds and deeds[-1].frame == "GO" and ways[-size:] == more[:size]
    return more[size:] if there else more


def _from(place: str, made: list[Deed]) -> list[Deed]:
    """Deeds without the way to where the robot is already."""
    there = place and made and made[0].frame == "GO" and place in made[0].arguments.values()
    return made[2 if made[0].hidden else 1 :] if there else made


def _until(wishes: tuple[Wish, ...], words: tuple[str, ...], text: str) -> tuple[Wish, ...]:
    """Wishes of which the last one lasts until something; nothing if it does not last."""
    *others, last = wishes
    until = Filler("U", 0, len(words), 0, words, 1.0, text)
    stays = {lemma for word in last.verb.split() for lemma in lemmas(word)} & _STAYING
    if last.frame == "GO" and stays:  # "wait at the desk"
        return (*wishes, replace(last, frame="WAIT", fillers=(until,)))
    if last.frame in ("WAIT", "FOLLOW"):
        return (*others, replace(last, fillers=(*last.fillers, until)))
    return ()


def _is_listed(wish: Wish) -> bool:
    """Whether a wish is one more place for the verb before it."""
    return (
        wish.frame == "GO"
        and wish.verb != ""
        and not wish.negated
        and any(wish.start == one.start for one in wish.all("G"))
    )


def _joined(deeds: list[Deed], more: list[Deed]) -> list[Deed]:
    """Deeds with more, without a plain look at what is looked at again right there for something."""
    last, first = deeds[-1] if deeds else None, more[0] if more else None
    looks = ("LOOK", "FIND")
    if last is None or first is None or last.frame not in looks or first.frame not in looks:
        return [*deeds, *more]
    if {*last.said} != {"T"} or last.check is not first.check or last.skill != first.skill:
        return [*deeds, *more]
    words = {*" ".join(map(str, first.arguments.values())).lower().split()}
    same = {*" ".join(map(str, last.arguments.values())).lower().split()} <= words
    if first.said == last.said or not (same or "K" in first.said or "there" in words):
        return [*deeds, *more]
    if last.frame == "FIND" and not same:
        return [*deeds, *more]
    if same or "there" in words or "K" not in first.said:
        return [*deeds[:-1], *more]
    what = f"{first.said['K']} at {last.said['T']}"
    told = {slot: f"{text} at {last.said['T']}" for slot, text in first.arguments.items()}
    whole = replace(first, arguments=told, said={**first.said, "K": what})
    return [*deeds[:-1], whole, *(replace(d, check=whole) if d.check is first else d for d in more[1:])]


# -- why an order is not certain enough to be carried out --


_AGREED = 0.1
"""So much the tagger must believe in the least certain part of a wish that the lexicon agrees with."""
_ALONE = 0.6
"""So much where the lexicon does not know the verb."""

_NAMED = 0.03
"""So much in a role whose words name something of the map."""
_OFFERED = 0.1
"""So much in what is shown for a yes."""
_FEW = 2
"""So many words at most may be left over of what is shown for a yes."""


def doubt(
    reading: Reading, orders: tuple[Wish, ...], knows: Callable[[Filler], bool], *, idle: bool = False
) -> Ask | None:
    """What is to be asked before these orders of a reading are carried out; None if they are certain.

    Args:
        reading: Of the clause.
        orders: The wishes among it that are to be carried out.
        knows: Whether all words of a role name something of the map: another witness that it is one.
        idle: Whether there is no plan that a message could change: what sounds like a change is an order.
    """
    if reading.left_over:
        return Ask(
            f"I do not understand “{' '.join(reading.left_over)}” in this. Can you say it in other words?"
        )
    seen = orders and all(wish.frame in ("LOOK", "COUNT") and wish.has("TK") for wish in orders)
    unclear = {"alarm", "control"} | (set() if seen else {"question"}) | (set() if idle else {"edit"})
    if reading.acts & unclear:
        return Ask("I am not sure what you want me to do. Can you say one thing at a time?")
    if reading.unsteady:
        what = " ".join(dict.fromkeys(" ".join(reading.unsteady).split()))
        return Ask(f"I am not sure what you mean by “{what}”. Can you say it in other words?")
    for wish in orders:
        row = bool(orders[0].verb) or not any("there" in f.words for one in orders for f in one.fillers)
        listed = row and wish != orders[0] and not wish.verb and wish.frame == orders[0].frame
        named = listed and all(knows(filler) for filler in wish.fillers)
        least = _AGREED if wish.witness == "agrees" or named else _ALONE  # "go to bay 1 and bay 2"
        shares = [
            f.share for f in wish.fillers if wish.witness != "agrees" or not knows(f) or f.share < _NAMED
        ]
        weak = min([wish.share, *shares]) < least
        if weak or wish.witness == "differs":
            what = f"“{wish.verb}”" if wish.verb else f"“{wish.fillers[0].text}”"
            return Ask(f"I am not sure what you mean by {what}. Can you say it in other words?")
    for filler in reading.loose:
        second = filler.role == "L" and any(w.start < filler.start and w.has("L") for w in reading.wishes)
        if second or filler.role not in ("A", "T", "L", "M"):
            return Ask(f"I do not understand what “{filler.text}” belongs to. Can you say it in other words?")
    return None


def may_be_offered(reading: Reading, orders: Sequence[Wish], lexicon: Lexicon) -> bool:
    """Whether orders that are not certain are sensible enough to be shown, for a person to say yes to."""
    if reading.acts & {"alarm", "question", "control", "edit"} or len(reading.left_over) > _FEW:
        return False
    named = any(len(word) == 1 or word.isdigit() for word in reading.left_over)  # "areas A, B and C"
    if named or {word.lower() for word in reading.left_over} & lexicon.classes["logic"]:
        return False
    if any(filler.role not in ("A", "T", "L", "M") for filler in reading.loose):
        return False
    return all(wish.witness != "differs" and wish.share >= _OFFERED for wish in orders)
