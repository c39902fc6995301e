"""Questions that only a look answers, such as how many there are or which is the largest: as a wish."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.amounts import amount_of
from parley.language.builtin.lexicon import Lexicon, is_somebody, stem
from parley.language.builtin.retyping import retyped
from parley.language.builtin.spans import Filler
from parley.language.builtin.tokens import Token, tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.map_words import Named
from parley.language.lexicon import word_set

__all__ = ["sight_asked_for"]

_ASKING: Final = frozenset({"what", "which", "who", "how", "whats"})
_THINGS: Final = frozenset({"object", "item", "thing", "article", "colour", "color", "pose", "gender"})
_FEATURES: Final = frozenset({"number", "amount", "name", "pose", "gender", "colour", "color"})
_OF: Final = frozenset({"of", "on", "in", "from"})
"""How a question begins that says first where: "of the boxes on the desk, which is the largest?"."""
_ENDS: Final = frozenset({".", "?", "!", ";"})
_FEWEST: Final = 4
_COURTESY: Final = frozenset({"please", "thanks", "robot"})
_THEN: Final = frozenset(
    {"was", "were", "did", "had", "will", "would", "should", "does", "do", "can", "could"}
    | {"live", "lives", "work", "works", "own", "owns", "belong", "belongs", "fit", "fits"}
)
"""Words of a question about other times, or about what may be."""
_IS: Final = frozenset({"is", "are"})
_WHETHER: Final = _IS | {"if", "whether"}
"""How a question begins that says itself which answers there are."""
_MORE: Final = frozenset({"and", "then", "but", "or", "if"})
"""What leads to something else that is wanted."""


def sight_asked_for(
    situation: Situation,
    tokens: Sequence[Token],
    names: Sequence[Named],
    lexicon: Lexicon,
    *,
    counting: bool = True,
) -> Wish | None:
    """The look or the count that a question, or an order to tell, asks for; None if none is needed.

    It names one place of the map, and asks how many there are, which one of the things there it is, or who.
    Where the robot is not `counting`, it looks how many there are.
    """
    spoken = [token for token in tokens if token.is_word]
    while spoken and spoken[-1].low in _COURTESY:
        spoken.pop()
    words = tuple(token.low for token in spoken)
    if len(names) != 1 or len(names[0].things) != 1 or _is_told(names[0], situation):
        return None
    start, place = _asked_from(words, lexicon), names[0].words
    called = {word for robot in situation.robots for word in robot.lower().split()}
    if start is None or not _only_leads(words[:start], {*place} | called, lexicon) or len(words) < _FEWEST:
        return None
    if any(token.low in _ENDS for token in tokens if spoken[start].start < token.start < spoken[-1].start):
        return None  # more is said behind it
    said, counts = words[start:], words[start : start + 2] == ("how", "many")
    counts = counts or {*said[:5]} >= {"number", "of"}
    text = situation.message[spoken[start].start : spoken[-1].end]
    if not _holds(said, place):  # "from the yard, tell me how many people are sitting"
        what = words[1:start] if counts and words[0] == "of" else ()
        what = what[: next((n for n, word in enumerate(what) if word in lexicon.classes["prepositions"]), 0)]
        said = (*said[:2], *what, *said[2:], *_led_to(words, place, lexicon))
        text = " ".join(said)
    if not _is_seen(said, place, lexicon) or (said[0] == "how" and not counts):
        return None
    said_as = text[:1].lower() + text[1:]
    asked = Filler("K", start, len(words), len(said) - 1, said, 1.0, said_as)
    look = Wish("LOOK", start, "tell", (asked,), 1.0, "agrees")
    wish = retyped(look, lexicon) if counting else look
    return wish if wish.frame != "COUNT" else _counted(wish, place, len(words), lexicon)


def _asked_from(words: Sequence[str], lexicon: Lexicon) -> int | None:
    """Where what is asked begins: at its first question word, or at what is to be told of."""
    start = next((at for at, word in enumerate(words) if word in _ASKING), None)
    if start is None and "or" in words:  # "is the man in the hall sitting or standing?"
        start = next((at + (word not in _IS) for at, word in enumerate(words) if word in _WHETHER), None)
    if start is not None or not {*words} & lexicon.classes["telling"]:
        return start
    for at, word in enumerate(words):
        if _is_extreme(word) or (word in _FEATURES and words[at + 1 : at + 2] == ("of",)):
            while at and (words[at - 1] in lexicon.classes["determiners"] or amount_of(words[at - 1 : at])):
                at -= 1
            return at
    return None


def _is_extreme(word: str) -> bool:
    """Whether a word says that something has most of what only a look tells: not the nearest one."""
    return len(word) > 5 and word.endswith("est") and word not in _NOT_EXTREME


_NOT_EXTREME: Final = word_set("""nearest closest furthest farthest latest forest request interest harvest
contest honest modest priest arrest digest invest protest suggest earliest""")


def _only_leads(words: Sequence[str], others: Set[str], lexicon: Lexicon) -> bool:
    """Whether words only lead to what is asked: who is to tell it, where that is, and the `others`."""
    classes = lexicon.classes
    known = classes["telling"] | classes["looking_out"] | classes["small"] | classes["prepositions"]
    known = known | classes["determiners"] | classes["me"] | others | _WHETHER
    return all(word in known or stem(word) in _THINGS or is_somebody(word) for word in words)


def _holds(said: Sequence[str], place: Sequence[str]) -> bool:
    return any(tuple(said[at : at + len(place)]) == tuple(place) for at in range(len(said)))


def _led_to(words: Sequence[str], place: Sequence[str], lexicon: Lexicon) -> tuple[str, ...]:
    """A place with the preposition that it was named with."""
    at = next(at for at in range(len(words)) if _holds(words[at : at + len(place)], place))
    at -= at > 0 and words[at - 1] in lexicon.classes["determiners"]
    led = words[at - 1] if at and words[at - 1] in _LEADS else "at"
    return (led, "the", *place)


_LEADS: Final = frozenset({"in", "on", "at", "inside", "under", "behind", "near"})


def _is_seen(said: Sequence[str], place: Sequence[str], lexicon: Lexicon) -> bool:
    """Whether it is to be seen now: things and people of which something is asked, at no other time."""
    about = {stem(word) for word in said} - {stem(word) for word in place}
    counts = tuple(said[:2]) == ("how", "many") or {*said[:5]} >= {"number", "of"}
    if said[0] == "who":
        seen = said[1] in ("is", "'s", "’s") and said[2] in lexicon.classes["prepositions"]
    else:
        seen = counts or any(word in _THINGS or is_somebody(word) or _is_extreme(word) for word in about)
    if "or" in said and not {*said} & _ASKING:  # which of the two it is
        said = tuple(word for word in said if word != "or")
    elsewhen = _THEN | _MORE | lexicon.classes["clock"] | lexicon.classes["mental"] | lexicon.classes["me"]
    return seen and not {*said} & elsewhen


_POSTURES: Final = frozenset({"sitting", "standing", "lying"})


def _counted(wish: Wish, place: Sequence[str], end_of_all: int, lexicon: Lexicon) -> Wish | None:
    """A count with the place as a role of its own: "people sitting", "at the yard"."""
    counted, where = wish.fillers[0], ("at", *place)
    end = next((at for at, word in enumerate(counted.words) if word in place), len(counted.words))
    behind = end + len(place)  # "people in the hall wearing hats"
    small = (lexicon.classes["prepositions"] | lexicon.classes["determiners"]) - _POSTURES
    led = end < len(counted.words)  # by "on the": what is counted ends before that
    while led and end and counted.words[end - 1] in small:
        end -= 1
    bare = counted.words[:end]
    if not bare:
        return None
    bare += tuple(word for word in counted.words[behind:] if word not in _IS)
    what = Filler("T", counted.start, counted.end, min(counted.head, end - 1), bare, 1.0, " ".join(bare))
    return replace(wish, fillers=(what, Filler("L", end_of_all, end_of_all + 1, len(where) - 1, where)))


def _is_told(place: Named, situation: Situation) -> bool:
    """Whether something was told about a place: then that is asked for."""
    wanted = {stem(word) for word in place.words}
    told = (tokenize(f"{entry.name.replace('_', ' ')} {entry.data}") for entry in situation.memory)
    return any(wanted <= {stem(token.low) for token in tokens} for tokens in told)
