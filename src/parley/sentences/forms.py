"""Finding the sentence of a catalogue that a text is, where nobody says which one it was made of.

What robots say comes over topics and out of stores as plain text. A text is taken apart into its sentences,
and each is looked for among the catalogue's forms; what is filled into a form is looked for in turn. What
stands between quotation marks, or is filled in for `words`, is somebody's own and stays. What is not found
stays as it is.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Final

__all__ = ["Catalogue", "ended_once", "is_own"]

_HOLE: Final = re.compile(r"\{(\w+)\}")
_END: Final = re.compile(r"(?<=[.?!])(?:[”)])?\s+(?=[^\s])|(?<=[.?!][”)])\s+")
_ENDED_TWICE: Final = re.compile(r"(?<!\.)\.([”“’‘]?)\.(?!\.)")
_KEPT: Final = 4096
"""Texts whose words in the other language are held ready."""
_MOST_CHARS: Final = 4000
"""Longer texts are not looked through."""
_TELLING: Final = 12
"""So many letters of its own make a form certain; with fewer it may only join two parts."""
_SHORT: Final = 4
"""With fewer it is none at all by itself."""
_ARTICLES: Final = ("a {thing}", "an {thing}")
"""Short as they are, what stands behind them is a name."""


def is_own(template: str, name: str) -> bool:
    """Whether what is filled in for `name` is somebody's own words, which are said in no other language.

    A `question`, a `step` and what lets go of a message are ours, also between quotation marks.
    """
    return name not in ("question", "step", "never_mind") and (
        name.startswith("words") or f"“{{{name}}}”" in template
    )


@dataclass(frozen=True)
class _Form:
    text: str
    """Of its pattern."""
    key: str
    """The longest of its words in a row: what lacks them is not tried."""
    own: frozenset[str]
    other: str
    weight: int
    joins: bool
    """It only joins two parts: it counts where one of them is found."""

    @cached_property
    def pattern(self) -> re.Pattern[str]:
        """Compiled when it is tried first: all of them at once would hold up the loop for half a second."""
        return re.compile(self.text, re.DOTALL)

    @classmethod
    def of(cls, template: str, other: str) -> _Form:
        pieces = _HOLE.split(template)
        own = frozenset(name for name in pieces[1::2] if is_own(template, name))
        literal = [piece for piece in pieces[::2] if piece]
        weight = sum(map(len, literal))
        seen: set[str] = set()
        text = re.escape(pieces[0])
        for at, name in enumerate(pieces[1::2]):
            before, behind = pieces[2 * at], pieces[2 * at + 2]
            if (at and not before) or before[-1:].isalpha():
                one = ".*?"  # what stands so close to what is before it may be missing
            elif not behind and 2 * at + 3 < len(pieces):
                one = "“[^”]+”|.+"
            else:
                one = _filling(template, name, behind)
            text += rf"(?P={name})" if name in seen else rf"(?P<{name}>{one})"
            text += re.escape(behind)
            seen.add(name)
        return cls(
            text=text,
            key=max(literal, key=len, default=""),
            own=own,
            other=other,
            weight=weight,
            joins=(weight < _SHORT and not own and template not in _ARTICLES)
            or (weight < _TELLING and not pieces[0] and not pieces[-1].strip(".?!:")),
        )


def _filling(template: str, name: str, behind: str) -> str:
    """What may be filled in: numbers, what is quoted, whole sentences, or less than one."""
    if name in ("number", "count"):
        return r"\d[\d.,]*"
    if f"“{{{name}}}”" in template:
        return "[^”]+?"
    if template[-1:] not in ".?!:”" and name not in ("first", "last", "list", "steps"):
        return r"(?:(?!, |; | and then ).)+?"  # one of several
    whole = not name.startswith("words") and (not behind or re.match(r" (?:[A-Z“]|$)", behind))
    if name == "steps" and not whole:  # they are numbered: "1. Go"
        return r"(?:(?!(?<!\d)[.?!]\s+[A-Z“]).)+?"
    # Less than one may hold whole ones in quotation marks.
    return ".+?" if whole else r"(?:“[^”]*”|(?![.?!]\s+[A-Z“])[^“])+?"


_JOINED: Final = "{first} and {last}"


class Catalogue:
    """The sentences of one language.

    Args:
        pairs: English -> the other language.
    """

    def __init__(self, pairs: Mapping[str, str]) -> None:
        self.pairs = pairs
        forms = [_Form.of(english, other) for english, other in pairs.items() if _HOLE.search(english)]
        self._forms = sorted(
            (form for form in forms if form.key.strip()),
            key=lambda form: (form.joins, form.key != "; ", -form.weight),
        )
        self._said = lru_cache(_KEPT)(self._find)

    def said(self, text: str) -> str:
        """`text` in this language, as far as its sentences are known."""
        return self._said(text) if len(text) <= _MOST_CHARS else text

    def filled(self, template: str, values: Mapping[str, object]) -> str:
        """A sentence of which is known what it was made of."""
        return ended_once(self.pairs.get(template, template).format(**values))

    def _find(self, text: str) -> str:
        whole = self._whole(text)
        if whole is not None:
            return whole
        parts = list(_sentences(text))
        if len(parts) < 2:
            return text
        found: list[str] = []
        while parts:
            counts = range(len(parts) if found else len(parts) - 1, 0, -1)
            tried = ((count, self._whole(" ".join(parts[:count]))) for count in counts)
            count, known = next(((count, text) for count, text in tried if text is not None), (1, parts[0]))
            found.append(known)
            del parts[:count]
        return " ".join(found)

    def _whole(self, text: str) -> str | None:
        """The one sentence or part that a text is; None if it is none."""
        if text in self.pairs:
            return self.pairs[text]
        found = self._by_form(text)
        first = text[:1]
        if found is None and first != first.swapcase():
            other = first.swapcase() + text[1:]
            found = self.pairs.get(other) or self._by_form(other)
            found = found and (found[:1].upper() if first.isupper() else found[:1].lower()) + found[1:]
        if found is None and text[-1:] in (".", "?", "!") and (bare := self._whole(text[:-1])) is not None:
            found = bare + text[-1]
        return found

    def _by_form(self, text: str) -> str | None:
        quoted: str | None = None
        for form in self._forms:
            if form.key not in text or (match := form.pattern.fullmatch(text)) is None:
                continue
            held = match.groupdict()
            if not all(_is_balanced(value) for value in held.values()):
                continue
            values = {name: self._held(name, value, form) for name, value in held.items()}
            if not form.joins or (values != held and len(list(_sentences(text))) == 1):
                found = ended_once(form.other.format(**values))
                if not form.joins or any(_letters(values[name]) != _letters(held[name]) for name in held):
                    return found
                quoted = quoted or found  # another way to part it may find more than quotation marks
        return quoted

    def _held(self, name: str, value: str, form: _Form) -> str:
        """What is filled in; between names, which stay, stands a word of this language."""
        if name in form.own:
            return value
        said = self._said(value)
        first, joined, last = value.rpartition(" and ")
        if said != value or name != "list" or not joined:
            return said
        return self.pairs.get(_JOINED, _JOINED).format(first=self._said(first), last=self._said(last))


def ended_once(text: str) -> str:
    """Without the full stop of what is filled in where the sentence has its own right behind it."""
    return _ENDED_TWICE.sub(r"\1.", text)


def _letters(text: str) -> str:
    return "".join(filter(str.isalnum, text))


def _is_balanced(text: str) -> bool:
    return text.count("“") == text.count("”") and text.find("”") >= text.find("“")


def _sentences(text: str) -> Iterator[str]:
    """The sentences of a text, those between quotation marks with what stands around them."""
    begin = 0
    for match in _END.finditer(text):
        if _is_balanced(text[begin : match.start()]):
            yield text[begin : match.start()]
            begin = match.end()
    yield text[begin:]
