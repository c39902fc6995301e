"""Questions that only a look answers, such as how many there are or which is the largest: as a wish."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.fillers import Filler
from parley.language.builtin.grounding import is_somebody
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.retyping import retyped
from parley.language.builtin.tokens import Token, tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.mentions import Named

__all__ = ["sight_asked_for"]

_ASKING: Final = frozenset({"what", "which", "who", "how", "whats"})
_THINGS: Final = frozenset({"object", "item", "thing", "article", "colour", "color", "pose", "gender"})
_OF: Final = frozenset({"of", "on", "in", "from"})
"""How a question begins that says first where: "of the boxes on the desk, which is the largest?"."""
_FEWEST: Final = 4
_COURTESY: Final = frozenset({"please", "thanks", "robot"})
_THEN: Final = frozenset(
    {"was", "were", "did", "had", "will", "would", "should", "does", "do", "can", "could"}
    | {"live", "lives", "work", "works", "own", "owns", "belong", "belongs", "fit", "fits"}
)
"""Words of a question about other times, or about what may be."""


def sight_asked_for(
    situation: Situation,
    tokens: Sequence[Token],
    names: Sequence[Named],
    lexicon: Lexicon,
    *,
    counting: bool = True,
) -> Wish | None:
    """The look or the count that a question asks for; None for any that can be answered without.

    It names one place of the map, and asks how many there are, which one of the things there it is, or who.

    Args:
        situation: What is known.
        tokens: Of the message.
        names: What it names on the map.
        lexicon: Words.
        counting: Whether the robot can count; else it looks how many there are.
    """
    spoken = [token for token in tokens if token.is_word]
    while spoken and spoken[-1].low in _COURTESY:
        spoken.pop()
    words = tuple(token.low for token in spoken)
    start = next((at for at, word in enumerate(words) if word in _ASKING), None)
    if start is None or len(names) != 1 or len(names[0].things) != 1:
        return None
    said = words if words[0] in _OF else words[start:]
    if words[start : start + 2] == ("how", "many"):  # "of the people in the hall, how many are sitting"
        at = next((n for n in range(1, start) if words[n] in lexicon.classes["prepositions"]), start)
        said = (*words[start : start + 2], *(words[1:at] if words[0] == "of" else ()), *words[start + 2 :])
    start = 0 if words[0] in _OF else start
    if len(said) < _FEWEST or _is_told(names[0], situation):
        return None
    about = {stem(word) for word in said} - {stem(word) for word in names[0].words}
    counts = said[:2] == ("how", "many") or {*said[:5]} >= {"number", "of"}
    who = said[0] == "who" and said[1] in ("is", "'s", "’s") and said[2] in lexicon.classes["prepositions"]
    seen = who or (said[0] != "who" and (counts or about & _THINGS or any(map(is_somebody, about))))
    elsewhen = {*said} & (
        _THEN | lexicon.classes["clock"] | lexicon.classes["mental"] | lexicon.classes["me"]
    )
    if not seen or elsewhen or (said[0] == "how" and not counts):
        return None
    said_as = situation.message[spoken[start].start : spoken[-1].end]
    said_as = said_as[:1].lower() + said_as[1:]
    asked = Filler("K", start, len(words), len(said) - 1, said, 1.0, said_as)
    look = Wish("LOOK", start, "tell", (asked,), 1.0, "agrees")
    wish = retyped(look, lexicon) if counting else look
    if wish.frame != "COUNT":
        return wish
    place = ("at", *names[0].words)
    counted, where = wish.fillers[0], Filler("L", len(words), len(words) + 1, len(place) - 1, place)
    end = next((at for at, word in enumerate(counted.words) if word in names[0].words), len(counted.words))
    led = end < len(counted.words)  # by "on the": what is counted ends before that
    while (
        led
        and end
        and counted.words[end - 1] in lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    ):
        end -= 1
    bare = counted.words[:end]
    if not bare:
        return None
    what = Filler("T", counted.start, counted.end, min(counted.head, end - 1), bare, 1.0, " ".join(bare))
    return replace(wish, fillers=(what, where))


def _is_told(place: Named, situation: Situation) -> bool:
    """Whether something was told about a place: then that is asked for."""
    wanted = {stem(word) for word in place.words}
    told = (tokenize(f"{entry.name.replace('_', ' ')} {entry.data}") for entry in situation.memory)
    return any(wanted <= {stem(token.low) for token in tokens} for tokens in told)
