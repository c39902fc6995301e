"""Names of the map that are ordinary words too ("loading bay", "lost and found"), kept apart from these.

Before a message is read, the words of such a name get a mark wherever the name is meant, there and in all
that is known; whatever is read afterwards takes them for a name and nothing else. Answers have no marks.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import Any

from pydantic import BaseModel

from parley.language.base import ErrorSituation, Situation, Turn
from parley.language.offline.grammar.small import small, verb_class
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.text import singular
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.world.object_map import MapObject

__all__ = ["Proper", "unmarked"]

_MARK = "\ua78f"
"""A letter that no language writes in words like these: nothing takes a word with it for another one."""
_WORD = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*")
_ENDINGS = ("'s", "’s", "s'")


@dataclass(frozen=True, slots=True)
class _Piece:
    """A word of a text, and where it stands."""

    start: int
    end: int
    text: str
    stem: str
    """Singular, lower case, without a possessive ending."""

    @property
    def is_label(self) -> bool:
        return self.text.isdigit() or (len(self.text) == 1 and (self.text.isupper() or self.text != "a"))


@dataclass(frozen=True, slots=True)
class _Name:
    """What a thing of the map is called."""

    words: tuple[str, ...]
    head: int
    joined: bool
    """Whether a word in it puts words or sentences together, or goes with a verb ("and", "can")."""


@dataclass(frozen=True, eq=False)
class Proper:
    """The names of a map that have words with another meaning, and those words."""

    names: Mapping[str, tuple[tuple[_Name, int], ...]]
    """Word -> the names it stands in, and where."""
    several: frozenset[str]
    """Heads of more than one name."""
    whole: frozenset[tuple[str, ...]]
    """All names."""
    lettered: frozenset[str]
    """What stands before the letter A in names."""
    short: Mapping[tuple[str, str], str]
    """Verb and label with which one name ends -> the words before them."""

    @classmethod
    def of(cls, situation: Situation | ErrorSituation) -> Proper | None:
        """The names of a map; None if they are nothing but names."""
        robots = situation.robots if isinstance(situation, Situation) else (situation.robot,)
        said = (
            text
            for info in situation.catalogue
            for text in (info.name, info.description, *info.phrases, *info.examples)
        )
        found = _names(tuple(situation.objects), (*said, *robots))
        return found if found.names or found.lettered or found.short else None

    def situation(self, known: Situation) -> Situation:
        """What is known, with marks."""
        failure = self.failure(known.failure) if known.failure is not None else None
        return replace(
            known,
            message=self._with_article(self.text(self._in_full(known.message))),
            memory=tuple(entry.model_copy(update={"data": self._told(entry)}) for entry in known.memory),
            history=self._turns(known.history),
            queue=self._calls(known.queue),
            objects=_marked(known.objects, self),
            failure=failure,
            question=self.text(known.question),
        )

    def _in_full(self, message: str) -> str:
        """With the whole name for "press 2" where only that could be pressed: the stamping press 2."""
        pieces = _pieces(message)
        result, at = "", 0
        for i, piece in enumerate(pieces[:-1]):
            rest = self.short.get((piece.text.lower(), pieces[i + 1].text.lower()), "")
            named = rest and _joined(pieces, i, message) and self._is_labelled(pieces, i, message)
            before = pieces[i - 1].stem if _joined(pieces, i - 1, message) else ""
            if named and before != rest.split()[-1].lower():
                result += f"{message[at : piece.start]}{rest} "
                at = piece.start
        return result + message[at:]

    def _with_article(self, message: str) -> str:
        """For "lift B", where that is all that is said: the thing, and no order."""
        pieces = tuple(_cut(message))
        named = pieces in self.whole and len(pieces) > 1 and bool(verb_class(pieces[0]))
        return f"the {message.strip()}" if named and _MARK not in message.split()[0] else message

    def failure(self, known: ErrorSituation) -> ErrorSituation:
        """As `situation`, for a step that failed."""
        return replace(
            known,
            error_message=self.text(known.error_message),
            failed_action=self._calls([known.failed_action])[0],
            details={key: self._value(value) for key, value in known.details.items()},
            completed=self._calls(known.completed),
            pending=self._calls(known.pending),
            memory=tuple(entry.model_copy(update={"data": self._told(entry)}) for entry in known.memory),
            objects=_marked(known.objects, self),
            dialogue=self._turns(known.dialogue),
            reply=None if known.reply is None else self.text(known.reply),
            tried=tuple(self._calls(calls) for calls in known.tried),
        )

    def _told(self, entry: Any) -> str:
        return self.text(entry.data) if entry.type == "text" else str(entry.data)

    def _turns(self, turns: Sequence[Turn]) -> tuple[Turn, ...]:
        return tuple(replace(turn, content=self.text(turn.content)) for turn in turns)

    def _calls(self, calls: Sequence[ActionCall]) -> tuple[ActionCall, ...]:
        return tuple(
            call.model_copy(
                update={
                    "input_parameters": self._value(call.input_parameters),
                    "reason": self.text(call.reason),
                }
            )
            for call in calls
        )

    def _value(self, value: Any) -> Any:
        if isinstance(value, str):
            return self.text(value)
        if isinstance(value, Parameter):
            return value.with_value(self._value(value.value)) if value.has_data else value
        if isinstance(value, dict):
            return {key: self._value(part) for key, part in value.items()}
        return [self._value(part) for part in value] if isinstance(value, list) else value

    def text(self, text: str) -> str:
        """A text in which the words of names have marks."""
        pieces = _pieces(text)
        whole = tuple(piece.stem for piece in pieces) in self.whole
        result, at = "", 0
        for i, piece in enumerate(pieces):
            if piece.text == "a" and self._is_letter(pieces, i, text):
                result += text[at : piece.start] + "A"
                at = piece.end
            if piece.stem in self.names and (whole or self._is_name(pieces, i, text)):
                result += text[at : piece.start] + _with_mark(piece)
                at = piece.end
        return result + text[at:]

    def _is_letter(self, pieces: Sequence[_Piece], i: int, text: str) -> bool:
        """For "lift a" where the map has a lift A, as against "lift a box"."""
        lettered = _joined(pieces, i - 1, text) and pieces[i - 1].stem in self.lettered
        return lettered and (not _joined(pieces, i, text) or pieces[i + 1].stem in _small_words())

    def _is_name(self, pieces: Sequence[_Piece], i: int, text: str) -> bool:
        return any(
            self._stands_in(name, at, pieces, i, text) for name, at in self.names[pieces[i].stem]
        ) or self._stands_alone(pieces, i, text)

    def _stands_in(self, name: _Name, at: int, pieces: Sequence[_Piece], i: int, text: str) -> bool:
        """Whether a word has the words beside it that it has in a name."""
        before = at > 0 and _joined(pieces, i - 1, text) and pieces[i - 1].stem == name.words[at - 1]
        behind = (
            at + 1 < len(name.words) and _joined(pieces, i, text) and pieces[i + 1].stem == name.words[at + 1]
        )
        if _is_plural(pieces[i]) and at == name.head and pieces[i].stem not in self.several:
            # "The bus stops", where there is one bus stop.
            return False
        if name.joined:
            # "Lost and found": all of it or nothing.
            run = pieces[max(0, i - at) : i - at + len(name.words)]
            return tuple(piece.stem for piece in run) == name.words and not _is_somebody(pieces, i - at)
        if before or not behind:
            return before
        return not pieces[i + 1].is_label or at != name.head or self._is_labelled(pieces, i, text)

    def _is_labelled(self, pieces: Sequence[_Piece], i: int, text: str) -> bool:
        """For "lift A" and "dock 3", as against "lift 3 boxes"."""
        before = pieces[i - 1].stem if i and _joined(pieces, i - 1, text) else ""
        if _is_plural(pieces[i]) or before in _LEADING:
            return True
        return not _joined(pieces, i + 1, text) or pieces[i + 2].stem in _small_words()

    def _stands_alone(self, pieces: Sequence[_Piece], i: int, text: str) -> bool:
        """For "the lift", as against "lift the box" and "the last stop"."""
        piece = pieces[i]
        heads = any(at == name.head and not name.joined for name, at in self.names[piece.stem])
        if not heads or not _joined(pieces, i - 1, text):
            return False
        if _joined(pieces, i, text) and pieces[i + 1].stem not in _small_words():
            return False
        before = pieces[i - 1].stem
        if piece.stem in small().sets["stops"] and before in _RANKS:
            return False
        if before in lexicon().determiners | lexicon().quantifiers | _RANKS | set(lexicon().numbers):
            return True
        described = _joined(pieces, i - 2, text) and pieces[i - 2].stem in lexicon().determiners
        return described and not _is_plural(piece) and before not in _small_words() | small().verbs.keys()


def unmarked(value: Any) -> Any:
    """An answer without marks: text, or anything that holds some."""
    if isinstance(value, str):
        return value.replace(_MARK, "")
    if isinstance(value, BaseModel):
        return value.model_copy(
            update={name: unmarked(getattr(value, name)) for name in type(value).model_fields}
        )
    if isinstance(value, Parameter):
        return value.with_value(unmarked(value.value)) if value.has_data else value
    if isinstance(value, dict):
        return {key: unmarked(part) for key, part in value.items()}
    return type(value)(unmarked(part) for part in value) if isinstance(value, list | tuple) else value


_JOINING = lexicon().auxiliaries | {"and", "or", "but", "can", "will", "must", "may"}
_RANKS = frozenset(
    {"last", "next", "other", "remaining", "final", "first", "second", "third", "fourth", "fifth"}
)
_LEADING = frozenset({"the", "at", "by", "in", "near", "from", "via", "past", "behind", "beside"})


@lru_cache(maxsize=64)
def _names(objects: tuple[MapObject, ...], texts: tuple[str, ...]) -> Proper:
    others = frozenset().union(*(_words_of(text) for text in texts))
    table: dict[str, dict[tuple[_Name, int], None]] = {}
    heads: list[str] = []
    whole: set[tuple[str, ...]] = set()
    for item in objects:
        for text in (item.description, *item.aliases):
            words = tuple(_cut(text))
            name = _Name(words, _head(words), bool(_JOINING & set(words)))
            heads += words[name.head : name.head + 1]
            whole.add(words)
            for at, word in enumerate(words):
                modifies = at < name.head and word not in others and _has_another_meaning(word)
                if modifies or (name.joined and len(word) > 1):
                    table.setdefault(word, {})[name, at] = None
    return Proper(
        {word: tuple(places) for word, places in table.items()},
        frozenset(head for head in heads if heads.count(head) > 1),
        frozenset(whole),
        frozenset(words[-2] for words in whole if words[-1:] == ("a",) and len(words) > 1),
        {name: rest for name, rest in _shortened(objects).items() if name[0] not in others},
    )


def _shortened(objects: Sequence[MapObject]) -> dict[tuple[str, str], str]:
    """What is left out of names where only the last two words are said, and the first of them is a verb."""
    found: dict[tuple[str, str], list[str]] = {}
    for item in objects:
        words = item.description.split()
        if len(words) > 1 and (words[-1].isdigit() or len(words[-1]) == 1) and verb_class(words[-2].lower()):
            found.setdefault((words[-2].lower(), words[-1].lower()), []).append(" ".join(words[:-2]))
    return {name: rest[0] for name, rest in found.items() if len(rest) == 1 and rest[0]}


@lru_cache(maxsize=1024)
def _words_of(text: str) -> frozenset[str]:
    """The words of a name or a text of the catalogue."""
    return (
        frozenset((*name_words(text), *_cut(text)))
        if "_" in text or " " not in text
        else frozenset(_cut(text))
    )


def _pieces(text: str) -> list[_Piece]:
    return [
        _Piece(m.start(), m.end(), m.group(), singular(_bare(m.group().lower())))
        for m in _WORD.finditer(text)
    ]


def _cut(text: str) -> Iterator[str]:
    for match in _WORD.finditer(text):
        yield singular(_bare(match.group().lower()))


def _bare(word: str) -> str:
    return next(
        (word[: -len(end)] + ("s" if end == "s'" else "") for end in _ENDINGS if word.endswith(end)), word
    )


def _head(words: tuple[str, ...]) -> int:
    """Where the noun of a name stands: its last word that is no label, before "of", "by" and the like."""
    end = next((i for i in range(1, len(words)) if words[i] in small().prepositions), len(words))
    end = end if end > 0 else len(words)
    return next((i for i in range(end - 1, -1, -1) if len(words[i]) > 1 and not words[i].isdigit()), 0)


def _has_another_meaning(word: str) -> bool:
    if len(word) < 2 or word.isdigit():
        return False
    alike = lexicon().synonyms.get(word, ())
    known = word in lexicon().nouns or word in lexicon().needs or not all(map(verb_class, alike))
    return bool(verb_class(word)) and not _is_small(word) and not known


@lru_cache(maxsize=8192)
def _is_small(word: str) -> bool:
    return word in _small_words()


@cache
def _small_words() -> frozenset[str]:
    listed = (
        small().prepositions, small().adverbs, small().determiners, small().conjunctions, small().needs,
        lexicon().be, lexicon().auxiliaries, lexicon().question_starts,
    )  # fmt: skip
    return frozenset().union(*listed)


def _is_somebody(pieces: Sequence[_Piece], i: int) -> bool:
    return i > 0 and pieces[i - 1].stem in small().subjects | {"you", "we"}


def _joined(pieces: Sequence[_Piece], i: int, text: str) -> bool:
    """Whether a word and the next one stand beside each other with nothing between them."""
    return 0 <= i < len(pieces) - 1 and not text[pieces[i].end : pieces[i + 1].start].strip()


def _is_plural(piece: _Piece) -> bool:
    return _bare(piece.text.lower()) != piece.stem


def _with_mark(piece: _Piece) -> str:
    """The word with its mark, where its endings are added to it."""
    low = piece.text.lower()
    stem = piece.stem if low.startswith(piece.stem) else low
    return piece.text[: len(stem)] + _MARK + piece.text[len(stem) :]


@lru_cache(maxsize=64)
def _marked(objects: tuple[MapObject, ...], proper: Proper) -> tuple[MapObject, ...]:
    result: list[MapObject] = []
    for item in objects:
        text = proper.text(item.description)
        others = tuple(proper.text(alias) for alias in item.aliases)
        if text == item.description and others == item.aliases:
            result.append(item)
        else:
            result.append(replace(item, description=text, aliases=(*others, item.description, *item.aliases)))
    return tuple(result)
