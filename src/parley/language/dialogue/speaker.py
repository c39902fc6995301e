"""Where the person is who speaks: told by the way, or in answer to the robot's question about it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final, Protocol

from parley.language.base import Situation
from parley.language.builtin.decision import Ask, Decision, Do, Remember, Told
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.saying import which_one, with_article
from parley.language.builtin.tokens import Token, tokenize
from parley.language.dialogue.map_words import named, rooms
from parley.language.dialogue.replies import chosen
from parley.language.lexicon import word_set
from parley.messages.memory import MemoryEntry

__all__ = ["answered_place", "name_of", "told_place"]

_AT: Final = (
    r"(?:right |over |down |up |out |back |in here |here |there )*"
    r"(?P<side>at|in|on|near|by|beside|next to|close to|in front of|behind|around|inside) "
)
_HERE: Final = re.compile(
    r"(?:(?:good (?:morning|day|afternoon|evening)(?: \w+)?|hello|hi|hey)\W+)?"
    r"(?:(?:my name is|this is|it's|i'm|i am) \w+(?: and)?\W+)?"
    r"(?:(?:ok|okay|well|oh|yes|hello|hi|hey|sorry|and|so|please)\W+)*(?:i'm|i am|we're|we are) "
    r"(?:(?:still|now|just|currently) )*(?:(?:sitting|standing|lying|waiting|working|resting|staying) )?"
    rf"{_AT}(?P<where>.+)",
    re.IGNORECASE,
)
_ANSWER: Final = re.compile(
    r"(?:(?:ok|okay|well|oh|yes|sorry|so|please|it is|it's|that is|that's|i'm|i am|we're|we are|probably|"
    r"(?:he|she|they|it)(?:'s|'re| is| are| (?:should|must|might|may|will) be)|i think|maybe|try|look|"
    r"sitting|standing)\W+)*"
    rf"(?:{_AT})?(?P<where>.+)",
    re.IGNORECASE,
)
_HEDGE: Final = re.compile(r",? (?:i (?:think|guess|suppose|believe)|probably|maybe|perhaps|or so)$", re.I)
_TOLD: Final = re.compile(r"(?:he|she|it|they)\b", re.I)
_DETERMINERS: Final = word_set("the a an my our your his her their this that please now")


class Again(Protocol):
    """Decides about other words in the same situation."""

    def __call__(self, text: str, without: Sequence[str] = (), told: Sequence[MemoryEntry] = ()) -> Decision:
        """What comes of `text`, with `told` remembered."""
        ...


def name_of(situation: Situation) -> str:
    """What the person who speaks is called in memories."""
    return situation.speaker or "operator"


def told_place(situation: Situation, lexicon: Lexicon) -> Decision | None:
    """What comes of "I am at the desk": it is remembered."""
    found = _HERE.fullmatch(_plain(situation.message))
    where = _place(found["where"], situation, lexicon) if found is not None else None
    if found is None or where is None:
        return None
    return where if isinstance(where, Ask) else Remember((_told(_who(situation), found["side"], where),))


def answered_place(situation: Situation, lexicon: Lexicon, again: Again) -> Decision | None:
    """What comes of the order that was asked about, where the message says which place it is near."""
    asked = situation.dialogue.asked
    whole = _HEDGE.sub("", _plain(situation.message))
    last = next((turn.content for turn in reversed(situation.history) if turn.role == "operator"), "")
    if "," in whole and not _place(whole, situation, lexicon):  # "in the yard, by the gate"
        whole = whole.rpartition(",")[2].strip()
    said = _ANSWER.fullmatch(whole)
    if asked is None or not asked.where or said is None or situation.message.rstrip().endswith("?"):
        return None
    where: str | Ask | None = chosen(said["where"].lower().split(), asked.choices) or _place(
        said["where"], situation, lexicon
    )
    if isinstance(where, Ask):
        return replace(where, where=asked.where, about=asked.words)
    if where is None:
        return None
    told = _told(_who(situation) if asked.where == "you" else asked.where, said["side"] or "near", where)
    if last and asked.words not in last and _TOLD.match(whole):  # "where is Kim?", "she is at the desk"
        return Remember((told,))
    made = again(asked.words, told=(MemoryEntry(name=told.name, data=told.text),))
    if not isinstance(made, Do | Ask) or made == again(asked.words):  # nothing came of it
        return None
    if isinstance(made, Do):  # it was told just now
        made = replace(made, notes=tuple(note for note in made.notes if note.source != told.name))
    sure = isinstance(made, Ask) or all(deed.frame != "FIND" for deed in made.deeds)  # else it shows
    return replace(made, told=(*([told] if sure else []), *made.told), about=asked.words)


def _plain(message: str) -> str:
    return re.sub(r"\s+", " ", message.replace("’", "'")).strip(" .!,")


def _who(situation: Situation) -> str:
    return situation.speaker or "the operator"


def _told(who: str, side: str, where: str) -> Told:
    key = "_".join(re.findall(r"\w+", who.lower().removeprefix("the ")))[:140]
    be = "are" if who.startswith("the ") and who.endswith("s") and not who.endswith("ss") else "is"
    return Told(f"{key}_location", f"{who} {be} {side.lower()} {with_article(where)}", f"Where {who} {be}")


def _place(words: str, situation: Situation, lexicon: Lexicon) -> str | Ask | None:
    """The one place that words name and nothing else; a question where they name several."""
    tokens: Sequence[Token] = tokenize(words)
    room = " ".join(token.low for token in tokens if token.low not in _DETERMINERS)
    if room in rooms(situation.objects):
        return room
    found = named(tokens, situation.objects, lexicon)
    rest = {token.low for at, token in enumerate(tokens) if not any(n.start <= at < n.end for n in found)}
    if len(found) != 1 or rest - _DETERMINERS:
        return None
    things = found[0].things
    if len(things) == 1:
        return things[0].description
    names = tuple(thing.description for thing in things)
    return Ask(which_one(names), names)
