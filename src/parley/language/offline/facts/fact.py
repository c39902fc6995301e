"""What is said to be so."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.words.text import Phrase

__all__ = ["Fact"]


@dataclass(frozen=True, slots=True)
class Fact:
    """Something that is said to be so."""

    subject: Phrase
    """What it is about, without determiner."""
    place: Phrase = ()
    """Where the subject is, without determiner; empty if it is not about a place."""
    relation: str = ""
    """Preposition of the place, or the word that links subject and state."""
    state: Phrase = ()
    """What else is said of the subject."""
    negated: bool = False
    sentence: str = ""
    """The whole, as a sentence."""
    another: bool = False
    """Said of one more thing of that kind, beside those already known."""

    @property
    def is_location(self) -> bool:
        """Whether it says where something is."""
        return bool(self.place)
