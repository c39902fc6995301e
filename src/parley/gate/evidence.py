"""What a person's own words bear out of what a language engine made of them. Pure, and without any engine.

A language engine may misunderstand or be misled. What takes something away (steps, a plan, memories) or
speaks in a person's name is done at once only where the person's words, read by code, speak of such a thing;
else the person is asked.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from typing import Final

__all__ = [
    "is_about",
    "is_said",
    "speaks_of_all",
    "speaks_of_change",
    "speaks_of_forgetting",
    "speaks_of_searching",
]

_CHANGE: Final = re.compile(
    r"\b(?:cancel|abort|scrap|drop|skip|leave|omit|remove|delete|forget|discard|abandon|ditch|undo|"
    r"scratch|strike|better|on\s+the\s+way|end|stop|"
    r"without|not|no|never|nope|don['’]?t|won['’]?t|needn['’]?t|isn['’]?t|doesn['’]?t|instead|rather|except|"
    r"actually|change|changed|replace|swap|other|another|different|anymore|unnecessary|enough|wrong|only|"
    r"just|"
    r"(?:start|begin|finish)\s+(?:\w+\s+)?(?:with|at)|last|after|reverse|opposite|backwards|exchange|cut|"
    r"switch(?!\s+o(?:n|ff)\b)|(?:take|throw|cross|put|move)\b.{1,60}?\b(?:out|off|end|front)|take\s+out|"
    r"the\s+other\s+way|(?:can|may)\s+(?:go|be)|is\s+off|are\s+off|urgent|important|straight|jump|front|"
    r"beginning|the\s+start|ahead\s+of|turn\s+round|nothing|cancelled|aren['’]?t|"
    r"first|before|next|but|wait|call\s+off|get\s+rid|mind|mean|meant|correction|sorry|unless|until|done|"
    r"jäta|tühista|loobu|ära|mitte|ei|pole|asemel|hoopis|unusta|kustuta|muuda|teine|lõpeta|välja|ainult|"
    r"vahele|vale)\b",
    re.IGNORECASE,
)
_SEARCHING: Final = re.compile(
    r"\b(?:look(?:s|ing)?\s+(?:\w+\s+)?for|finds?|finding|search\w*|seeks?|hunts?|locates?|"
    r"otsi\w*|leia\w*)\b",
    re.IGNORECASE,
)
_FORGETTING: Final = re.compile(
    r"\b(?:forget|unlearn|erase|delete|remove|discard|drop|clear|wipe|scrap|take\s+back|no\s+longer|"
    r"any\s?more|"
    r"isn['’]?t|aren['’]?t|is\s+not|are\s+not|was\s+wrong|not\s+true|wrong|gone|lift|undo|"
    r"don['’]?t\s+(?:remember|keep)|do\s+not\s+(?:remember|keep)|need\s+not\s+(?:remember|keep)|"
    r"unusta|kustuta|eemalda|tühista|enam|ei\s+ole|pole|vale)\b",
    re.IGNORECASE,
)
_KEEPING: Final = re.compile(
    r"\b(?:don['’]?t|do\s+not|never|not\s+to|ära)\s+(?:\w+\s+)?"
    r"(?:forget|erase|delete|remove|discard|drop|clear|wipe|unusta|kustuta|eemalda)\b",
    re.IGNORECASE,
)
_ALL: Final = re.compile(
    r"\b(?:everything|all|whole|entire|any|anything|kõik|kogu|midagi)\b", re.IGNORECASE
)  # fmt: skip
_EMPTY: Final = frozenset({
    "a", "an", "the", "is", "are", "was", "were", "be", "been", "am", "of", "to", "in", "on", "at", "by",
    "for", "with", "and", "or", "that", "this", "these", "those", "there", "here", "it", "its", "i",
    "you", "he", "she", "they", "we", "him", "her", "them", "my", "your", "his", "their", "our", "me",
    "us", "has", "have", "had", "do", "does", "did", "will", "would", "can", "please", "location",
    "located", "currently", "now", "remember", "operator", "person", "user", "said", "told", "says",
    "from", "as", "so", "one", "what", "where", "who", "information", "about", "note", "fact", "place",
    "position", "ja", "see", "ta", "seal", "siin",
})  # fmt: skip
_SAID_SHARE: Final = 0.6
"""Share of a memory's words of content that must be a person's own."""


def speaks_of_change(words: str) -> bool:
    """Whether somebody speaks of leaving out, giving up or exchanging something."""
    return _CHANGE.search(words) is not None


def speaks_of_searching(words: str) -> bool:
    """Whether somebody wants something found, which is over once it is."""
    return _SEARCHING.search(words) is not None


def speaks_of_forgetting(words: str) -> bool:
    """Whether somebody speaks of forgetting, or of something that holds no longer."""
    return _FORGETTING.search(words) is not None and _KEEPING.search(words) is None


def speaks_of_all(words: str) -> bool:
    """Whether somebody means everything at once."""
    return _ALL.search(words) is not None


def is_said(text: str, words: str, earlier: Iterable[str] = ()) -> bool:
    """Whether `text` is by and large what a person said.

    Args:
        text: What is to be kept in their name.
        words: What they said.
        earlier: What was said right before, to which "it" and "there" may refer.
    """
    wanted = _content(text)
    if not wanted:
        return bool(_plain(text)) and set(_plain(text)) <= set(_plain(words))
    own = _content(words)
    background = set().union(*(_content(turn) for turn in earlier)) if own else set()
    borne = sum(_among(word, own) for word in wanted)
    referred = sum(not _among(word, own) and _among(word, background) for word in wanted)
    return borne >= 1 and (borne + referred) / len(wanted) >= _SAID_SHARE


def is_about(texts: Iterable[str], words: str) -> bool:
    """Whether somebody speaks of what `texts` (a memory's name and content) are about."""
    own = _content(words)
    return any(_among(word, own) for text in texts for word in _content(text))


def _content(text: str) -> set[str]:
    return {word for word in _plain(text) if word not in _EMPTY}


def _plain(text: str) -> list[str]:
    low = unicodedata.normalize("NFC", text).casefold().replace("_", " ")
    return [word for word in re.split(r"\W+", re.sub(r"['’]s\b", "", low)) if word]


def _among(word: str, others: set[str]) -> bool:
    """Whether a word is there, in whatever form of five letters' stem."""
    if word in others:
        return True
    stem = word[:5]
    return len(stem) == 5 and any(other.startswith(stem) for other in others)
