"""Deeds that are told in their order, or only named, as the orders that they mean.

"Before A is V-ed, W B", "V A after B has been W-ed", "first A is V-ed, then it goes to B", "V-ing A comes
after W-ing B", "a V-ing of A, please", "A: V, then W". What others do is only told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from parley.language.offline.sentences.joined import ordered
from parley.language.offline.sentences.passive import Passives
from parley.language.offline.sentences.subjects import after_openers
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["Recipes"]

_DATA = load_data("forms")
_ADVERBS = frozenset(_DATA["adverbs"])
_BEFORE_NOUNS = frozenset(_DATA["before_nouns"])
_FIRST = PhraseTable.of(("first", "firstly", "first of all", "to begin with", "to start with"))
_NEXT = PhraseTable.of((
    "then", "next", "after that", "afterwards", "finally", "last", "lastly", "and then", "and finally",
    "after which", "and after that", "last of all", "and last of all", "and", "and last", "and lastly",
))  # fmt: skip
_BEFORE, _AFTER = frozenset({"before"}), frozenset({"after", "once"})
_BEING = PhraseTable.of((
    "is", "are", "was", "were", "has been", "have been", "gets", "get", "has", "have", "had been", "is being",
    "are being",
))  # fmt: skip
_GOES = PhraseTable.of((
    "it goes to", "they go to", "it goes into", "it goes in", "it goes on", "they go into", "it goes back to",
))  # fmt: skip
_MODAL = PhraseTable.of(_DATA["modals"])
_WHO = lexicon().person_pronouns | {
    "robot", "robots", "everyone", "everybody", "one", "other", "others", "all", "nobody", "someone",
    "somebody", "visitors", "people", "guests", "team",
}  # fmt: skip
_PLEASE = frozenset({"please", "now", "next", "too", "then", "first", ",", "!"})
_TIED = frozenset({
    "comes", "come", "is", "goes", "should", "follows", "happens", "must", "has", "to", "be", "right", "only",
    "directly",
})  # fmt: skip
_THEN = (Word(",", ","), Word("then", "then"))


def _w(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())


@dataclass
class Recipes:
    """Puts deeds that are told in their order, or only named, as orders.

    Args:
        passives: Reads things and verbs.
        opens: Whether an order begins words.
        is_person: Whether words name somebody.
    """

    passives: Passives
    opens: Callable[[Phrase], bool]
    is_person: Callable[[Phrase], bool]
    going: bool = False
    """Whether what was said before is a recipe."""

    def put(self, sentence: Phrase) -> Phrase:
        """A sentence with orders for what it tells or names; itself if there is nothing of the kind."""
        body = sentence
        while body and not body[0].is_word:
            body = body[1:]
        if len(body) < 3:
            return sentence
        found = self._recipe(body)
        self.going = found is not None
        return (
            found
            or self._tied(body)
            or self._by_colon(body)
            or self._named(body)
            or self._asked_able(body)
            or self._going_into(body)
            or self._ordered(body)
            or sentence
        )

    def _deed(self, words: Phrase, like: Phrase = ()) -> Phrase | None:
        """For "A is V-ed", "A has been V-ed", and "A is" after an order: the order."""
        flat = keys(words)
        for at in range(1, len(flat)):
            being = _BEING.match(flat, at)
            if being is None or not self.passives.subjects.is_thing(words[:at]):
                continue
            end = at + being[0]
            while end < len(flat) and flat[end] in _ADVERBS - {"not", "never"}:
                end += 1
            if end == len(flat):
                size = self._verb_size(like)
                return (*like[:size], *words[:at]) if size else None
            verb = self.passives.deeds.done(flat[end])
            rest, agent = self.passives.without_agent(words[end + 1 :])
            if not self.passives.deeds.can(verb) or agent is None:
                return None
            order, tail = ordered(verb, words[:at], rest)
            return (*order, *tail)
        return None

    def _verb_size(self, order: Phrase) -> int:
        flat = keys(order)
        found = lexicon().verbs.match(flat)
        return found[0] if found is not None else int(bool(flat) and flat[0] in self.passives.deeds.own)

    def _ordered(self, words: Phrase) -> Phrase | None:
        """For "before A is V-ed, W B", "W B after A has been V-ed"."""
        flat = keys(words)
        start = after_openers(flat)
        if flat[start] in _BEFORE | _AFTER or flat[start : start + 3] == ("as", "soon", "as"):
            begin = start + (3 if flat[start] == "as" else 1)
            for comma in (i for i in range(begin + 2, len(flat) - 1) if flat[i] == ","):
                main = words[comma + 1 :]
                order = self._deed(words[begin:comma], main) if self.opens(main) else None
                if order is not None:
                    main = (
                        self._with_name(main, words[begin:comma], order) if flat[start] in _BEFORE else main
                    )
                    return (*words[:start], *self._in_order(flat[start], main, order))
            return None
        if not self.opens(words):
            return None
        for at in range(2, len(flat) - 2):
            long = flat[at : at + 3] == ("as", "soon", "as")
            if flat[at] not in _BEFORE | _AFTER and not long:
                continue
            begin = at + (3 if long else 1)
            end = next(
                (i for i in range(begin, len(flat)) if flat[i] in {",", "and", "but"} and i > begin + 1),
                len(flat),
            )
            order = self._deed(words[begin:end], words)
            if order is not None:
                more = () if keys(words[end:])[:3] == (",", "not", "before") else words[end:]
                front = at
                while front > 2 and flat[front - 1] in {",", "only", "not", "but"}:
                    front -= 1
                link = "after" if flat[at - 1] == "not" else flat[at]
                return (*self._in_order(link, words[:front], order), *more)
        return None

    def _with_name(self, main: Phrase, told: Phrase, order: Phrase) -> Phrase:
        """What is done first names the thing that is only called "it" there."""
        known = set(keys(order))
        end = next((i for i, word in enumerate(told) if word.key not in known), 0)
        return tuple(one for word in main for one in (told[:end] if word.key in {"it", "them"} else (word,)))

    def _in_order(self, link: str, main: Phrase, hung: Phrase) -> Phrase:
        one, other = (main, hung) if link in _BEFORE else (hung, main)
        return (*one, *_THEN, *other)

    def _recipe(self, words: Phrase) -> Phrase | None:
        """For "first A is V-ed, after that it goes to B"."""
        flat = keys(words)
        if not (_FIRST.match(flat) or (self.going and _NEXT.match(flat))):
            return None
        parts: list[Phrase] = []
        begin = 0
        for end in range(len(words) + 1):
            cut = (
                end == len(words)
                or flat[end] == ","
                or (flat[end] == "and" and end and _NEXT.match(flat, end))
            )
            if not cut or end < begin:
                continue
            part = words[begin:end]
            begin = end + (end < len(words) and flat[end] == ",")
            order = self._step(part, parts[-1] if parts else ()) if part else None
            if part and order is None:
                return None
            parts += [order] if order is not None else []
        return (
            tuple(word for i, part in enumerate(parts) for word in (*(_THEN if i else ()), *part))
            if parts
            else None
        )

    def _step(self, words: Phrase, before: Phrase) -> Phrase | None:
        flat = keys(words)
        lead = _FIRST.match(flat) or _NEXT.match(flat)
        body = words[lead[0] :] if lead is not None else words
        goes = _GOES.match(keys(body))
        if goes is not None and goes[0] < len(body):
            place = body[goes[0] :]
            verb = "bring it to" if self.is_person(place) else "take it to"
            return (*_w(verb), *place)
        size = self._verb_size(before)
        if size and lead is not None and self.passives.subjects.is_thing(body):
            return (*before[:size], *body)
        return self._deed(body)

    def _tied(self, words: Phrase) -> Phrase | None:
        """For "V-ing A comes after W-ing B"."""
        flat = keys(words)
        deeds = self.passives.deeds
        first = deeds.doing(flat[0])
        at = next(
            (i for i in range(2, len(flat) - 2) if flat[i] in {"after", "before"} and flat[i - 1] in _TIED), 0
        )
        second = deeds.doing(flat[at + 1]) if at else ""
        if not (deeds.can(first) and deeds.can(second)):
            return None
        end = next(i for i in range(1, at) if flat[i] in _TIED)
        one, other = (*_w(first), *words[1:end]), (*_w(second), *words[at + 2 :])
        return self._in_order(flat[at], one, other)

    def _by_colon(self, words: Phrase) -> Phrase | None:
        """For "A: V, then W"."""
        flat = keys(words)
        at = flat.index(":") if ":" in flat else 0
        if not at or not self.passives.names.is_stop(words[:at]):
            return None
        orders: list[Word] = []
        for word in words[at + 1 :]:
            if word.key in {",", "then", "and", "please", "finally", "after", "that"}:
                continue
            if not self.passives.deeds.can(word.key):
                return None
            orders += [*(_THEN if orders else ()), word, *words[:at]]
        return tuple(orders) or None

    def _named(self, words: Phrase) -> Phrase | None:
        """For "an inspection of A, please", "a V-ing for B"."""
        flat = keys(words)
        start = after_openers(flat)
        at = start
        while at < len(flat) and flat[at] in _BEFORE_NOUNS:
            at += 1
        verb = self.passives.deeds.noun(flat[at]) if start < at < len(flat) - 2 else ""
        if (
            not verb
            or flat[at + 1] not in {"of", "for", "at"}
            or (lexicon().be | lexicon().auxiliaries) & set(flat)
        ):
            return None
        end = len(flat)
        while flat[end - 1] in _PLEASE:
            end -= 1
        thing = words[at + 2 : end]
        known = self.passives.names.is_stop(thing) and (self.passives.deeds.can(verb) or " " in verb)
        return (*words[:start], *_w(verb), *thing) if known else None

    def _asked_able(self, words: Phrase) -> Phrase | None:
        """For "is V-ing A something you can do": "can you V A"."""
        flat = keys(words)
        verb = self.passives.deeds.doing(flat[1]) if flat[0] in {"is", "would"} else ""
        at = next((i for i in range(2, len(flat)) if flat[i] in {"something", "anything"}), 0)
        able = {"can", "could", "able", "do"} & set(flat[at:])
        return (
            (*_w(f"are you able to {verb}"), *words[2:at])
            if verb and at and "you" in flat[at:] and able
            else None
        )

    def _going_into(self, words: Phrase) -> Phrase | None:
        """For "A has to go into B": it has to be brought there."""
        flat = keys(words)
        for at in range(1, len(flat) - 3):
            size = _MODAL.match(flat, at)
            end = at + size[0] if size is not None else 0
            if (
                not end
                or flat[end : end + 1] not in {("go",), ("come",)}
                or not self.passives.subjects.is_thing(words[:at])
            ):
                continue
            if flat[end + 1 : end + 2] not in {("to",), ("into",), ("in",), ("onto",), ("on",), ("back",)}:
                return None
            who = {*self.passives.robots, *_WHO} & set(flat[:at]) or self.is_person(words[:at])
            return (
                None
                if who
                else (*_w("bring"), *words[:at], *_w("to"), *words[end + 2 + (flat[end + 1] == "back") :])
            )
        return None
