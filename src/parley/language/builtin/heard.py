"""A message as it was heard: its words, its clauses, and all that is needed to decide about it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from parley.language.base import Situation
from parley.language.builtin.decision import Told
from parley.language.builtin.facts import told_of
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading
from parley.language.builtin.skills import Skills
from parley.language.builtin.structure import Part
from parley.language.builtin.tokens import Token, spoken, tokenize
from parley.language.dialogue.questions import plain
from parley.language.dialogue.speaker import Again

__all__ = ["Heard"]


@dataclass(frozen=True, slots=True)
class Heard:
    """One message in its situation."""

    situation: Situation
    tokens: Sequence[Token]
    parts: tuple[Part, ...]
    """Its clauses, each read."""
    reading: Reading
    """Of the whole."""
    skills: Skills
    """What the robot can do."""
    lexicon: Lexicon
    reader: Callable[[str], Reading]
    """Reads another text."""
    again: Again

    @property
    def bare(self) -> str:
        """The words without what only opens and closes them."""
        return plain(self.tokens, (self.situation.robot,))

    def told_in(self, text: str) -> tuple[Told, ...]:
        """The facts of a text."""
        starts = [token.start for token in spoken(tokenize(text)) or tokenize(text)]
        return told_of(self.reader(text), text, starts, self.lexicon)
