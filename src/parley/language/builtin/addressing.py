"""Which robots a message is for: those that it calls by name, else the one that hears it."""

from __future__ import annotations

from collections.abc import Sequence

from rapidfuzz.distance import OSA

from parley.language.base import Situation
from parley.language.builtin.decision import Ask
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.tokens import Token

__all__ = ["addressed"]

_BETWEEN = frozenset({"and", ",", "&", ":", "!", "-"})
_BEFORE = frozenset({
    "hey", "hello", "hi", "ok", "okay", "please", "so", "now", "well", "yes", "no", "and", "right", "oh",
    "both",
})  # fmt: skip
_ALL = (
    "all of you", "both of you", "you all", "you both", "the two of you", "everyone", "everybody",
    "all robots",
    "both robots", "you two", "all three of you",
)  # fmt: skip


def addressed(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon) -> tuple[str, ...] | Ask:
    """The robots that are called; a question where another one is named but not called.

    Args:
        situation: Says which robots there are, and which one hears.
        tokens: Of the message.
        lexicon: Closed classes.
    """
    here = (situation.robot,) if situation.robot else ()
    if len(situation.robots) < 2:
        return here
    low = [token.low for token in tokens]
    names = {name.lower(): name for name in situation.robots}
    named = [at for at, word in enumerate(low) if word in names]
    start = next((at for at, word in enumerate(low) if word not in _BEFORE and word != ","), 0)
    first = _run(low, start, names)
    last = _last_run(low, names)
    together = " ".join(word for word in low if word.isalpha())
    if any(together.startswith(text + " ") or together.endswith(" " + text) for text in _ALL):
        both = "both" in low or "two" in low
        exact = not named and (not both or len(situation.robots) == 2) and "except" not in low
        return situation.robots if exact else Ask("Which of us do you mean? Please call them by their names.")
    if not named:
        return _stranger(low, tokens, start, names, lexicon) or here
    if set(named) <= set(first) | set(last):
        return tuple(dict.fromkeys(names[low[at]] for at in named))
    others = [names[low[at]] for at in named if names[low[at]] != situation.robot]
    if len({low[at] for at in named}) > 1:
        return Ask("Please say it to one of us after the other, each by name first.")
    return Ask(f"Is that for {others[0]}? Please call {others[0]} by name first.") if others else here


def _run(low: Sequence[str], start: int, names: dict[str, str]) -> list[int]:
    """The places of names that stand together from a place on."""
    found: list[int] = []
    for at in range(start, len(low)):
        if low[at] in names:
            found.append(at)
        elif low[at] not in _BETWEEN or not found:
            break
    return found


def _last_run(low: Sequence[str], names: dict[str, str]) -> list[int]:
    """The places of names at the end, behind a comma."""
    found: list[int] = []
    for at in range(len(low) - 1, -1, -1):
        if low[at] in names:
            found.append(at)
        elif low[at] == "," and found:
            return found
        elif low[at] not in (*_BETWEEN, ".", "?", "please"):
            break
    return []


def _stranger(
    low: Sequence[str], tokens: Sequence[Token], start: int, names: dict[str, str], lexicon: Lexicon
) -> Ask | None:
    """The question who is called, if it is nobody that is known."""
    if start + 1 >= len(low) or low[start + 1] not in (",", "!", ":"):
        return None
    word = low[start]
    near = next(
        (name for small, name in names.items() if len(word) > 2 and OSA.distance(word, small) <= 2), None
    )
    if near is not None and abs(len(near) - len(word)) < 2:
        return Ask(f"Do you mean {near}?", (near,))
    known = (word,) in lexicon.verbs or any(word in words for words in lexicon.classes.values())
    called = tokens[start].text[:1].isupper() and word.isalpha() and not known
    return Ask(f"I know nobody called {tokens[start].text}. Is that for me?") if called else None
