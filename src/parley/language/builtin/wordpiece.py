"""Words to the numbers of word pieces that the encoder knows."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field

__all__ = ["Pieces", "WordPiece"]

_LONGEST = 60
_MOST_PIECES = 254


@dataclass(frozen=True, slots=True)
class Pieces:
    """The pieces of a sentence, with [CLS] and [SEP] around."""

    ids: tuple[int, ...]
    first: tuple[int, ...]
    """For each word, where its first piece stands; words behind what fits have none."""


@dataclass(frozen=True, slots=True)
class WordPiece:
    """Greedy longest match, as BERT does it on words in small letters without accents."""

    vocabulary: dict[str, int]
    _known: dict[str, tuple[int, ...]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, text: str) -> WordPiece:
        """From a vocabulary, one piece a line."""
        return cls({piece: number for number, piece in enumerate(text.split("\n"))})

    def split(self, words: Sequence[str]) -> Pieces:
        """The pieces of words."""
        ids, first = [self.vocabulary["[CLS]"]], []
        for word in words:
            pieces = self._word(word)
            if len(ids) + len(pieces) > _MOST_PIECES:
                break
            first.append(len(ids))
            ids += pieces
        return Pieces((*ids, self.vocabulary["[SEP]"]), tuple(first))

    def _word(self, word: str) -> tuple[int, ...]:
        found = self._known.get(word)
        if found is None:
            found = self._pieces(word)
            if len(self._known) < 20_000:
                self._known[word] = found
        return found

    def _pieces(self, word: str) -> tuple[int, ...]:
        plain = unicodedata.normalize("NFD", word.lower().replace("’", "'"))
        plain = "".join(letter for letter in plain if not unicodedata.combining(letter))[:_LONGEST]
        ids: list[int] = []
        for part in _parts(plain):
            ids += self._part(part)
        return tuple(ids) or (self.vocabulary["[UNK]"],)

    def _part(self, part: str) -> list[int]:
        ids: list[int] = []
        at = 0
        while at < len(part):
            lead = "##" if at else ""
            end = next((end for end in range(len(part), at, -1) if lead + part[at:end] in self.vocabulary), 0)
            if not end:
                return [self.vocabulary["[UNK]"]]
            ids.append(self.vocabulary[lead + part[at:end]])
            at = end
        return ids


def _parts(word: str) -> list[str]:
    """Marks inside a word stand alone, as in t-shirt or don't."""
    parts = [""]
    for letter in word:
        if letter.isalnum():
            parts[-1] += letter
        else:
            parts += [letter, ""]
    return [part for part in parts if part]
