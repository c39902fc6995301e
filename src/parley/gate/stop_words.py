"""Whether somebody calls a robot to stand still, whatever else they say. Read by code, before anything else.

A word of stopping holds the robot at once (`has_stop_word`); then the whole is read while it stands
(`calls_to_stop`): "stop right now, you will hit him" is a call, "stop at the box" and "the bus stop" are not.
In doubt it is one: a robot that stands asks for a word more, a robot that drives on may hurt somebody.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from typing import Final

from parley.gate.control import stops_all
from parley.messages.plain import named_in

__all__ = [
    "STOP_WORDS",
    "asked_behind",
    "called",
    "calls_to_stop",
    "has_stop_word",
    "is_no",
    "only_takes_back",
    "only_waits",
    "opens_with_no",
]

_WORDS: Final = (
    r"s+t+o+p+p*|stp+|sto|sotp|stpo|tsop|stpp|stopp?it|h+a+l+t+|w+a+i+t+|f+r+e+e+z+e+|w+h?o+a+h?|brake|"
    r"careful|emergency|enough|o+u+c+h+|o+w+|a+r+g+h+|autsch|"
    r"s+e+i+s+|seisa|seiske|p+e+a+t+u+|peatuge|peata|oota|oodake|stopp+i*|pidurda|ettevaatust|hädaolukord|"
    r"aitab|"
    r"anhalten|warte|warten|vorsicht|achtung|arr[eê]tez?|attendez|attention|alto|par[ae]|cuidado|espera|"
    r"fermati|ferma|aspetta|attento|stanna|vänta|pysähdy|seis|odota|varo|стой|стоп|стойте|осторожно|подожди"
)
_PHRASES: Final = (
    r"hold\s+(?:it|on|still|your)|hang\s+on|stand\s+still|stay\s+(?:there|where|put|still)|watch\s+(?:out|"
    r"it)|look\s+out|heads\s+up|back\s+off|knock\s+it\s+off|(?:don['’]?t|do\s+not)\s+(?:(?:you|any(?:body|one))\s+)?"
    r"(?:dare\s+)?(?:move|drive|go\s+any|come\s+any)|no(?:body|\s?-?one)\s+moves?|no\s+further|"
    r"(?:the\s+)?wrong\s+(?:way|one|place|room|door|side|direction)|you(?:['’]?re|\s+are)\s+(?:\w+\s+)?too\s+close|"
    r"not\s+what\s+i\s+(?:meant|said|wanted|asked)|^\W*mind\s+(?:the|my|your)|not\s+(?:another|one)\s+(?:step|inch|centimet\w+)|"
    r"pea\s+kinni|jää\s+(?:seisma|paigale)|ära\s+(?:liigu|sõida)|paigal|kohe\s+seisma"
)
STOP_WORDS: Final = f"{_WORDS}|{_PHRASES}"
"""Words of stopping, as an expression that browsers read too; what stands around them is up to readers."""
_STOP: Final = re.compile(rf"(?<![\w-])(?:{STOP_WORDS})(?![\w])", re.IGNORECASE)

_EVERYBODY: Final = re.compile(
    r"\b(?:(?:every|any|no)\s?-?(?:body|one)|all\s+of\s+(?:you|them)|both|you\s+(?:all|two|lot)|guys|robots|kõik|kõigil?|"
    r"mõlemad|robotid)\b|^\W*all\b|\ball\W*$",
    re.IGNORECASE,
)

_NO: Final = re.compile(
    r"\W*(?:(?:no+|nope|nah|not\s+(?:there|that(?:\s+way)?)|ei|mitte\s+sinna)\W*)+", re.IGNORECASE
)

_THING: Final = (
    r"(?:bus|tram|train|taxi|coach|pit|rest|full|door|lift|end|next|last|first|second|third|final|every|each|"
    r"this|that|which|one|a|an|the|any|another|tour|truck|fuel|your|my|our|his|her|their|two|three|four)"
)
_AUXILIARY: Final = (
    r"(?:did|does|do|has|have|had|will|would|why|when|where|who|what|which|how|if|once|until|till|before|"
    r"after|unless|whether|cannot|can['’]?t|could\s+not|couldn['’]?t|going\s+to|it|he|she|they)"
)
_NONE: Final = tuple(
    re.compile(text, re.IGNORECASE)
    for text in (
        # no stopping at all, or only of something else
        r"\b(?:don['’]?t|do\s+not|never|not|without|no\s+need\s+to|needn['’]?t|non|won['’]?t|"
        r"shouldn['’]?t|must\s+not|mustn['’]?t|isn['’]?t|ära|mitte)\s+(?:\w+\s+)?(?:stop(?:ping)?|halt|"
        r"wait|peatu|oota|seisa)\b(?!\s*[!.,;]*\s*(?:stop|halt|wait)\b)",
        r"\bnon-?stop\b",
        r"\b(?:bussi|rongi|trammi)?peatus\w*\b",
        # a thing that is called so
        rf"\b{_THING}\s+(?:\w+\s+)?(?:stops?|halt|wait|emergency|brake)\b",
        r"\b(?:stop|emergency|wait|brake|freeze)\s+(?:button|sign|switch|exit|door|light|room|list|time|"
        r"lever|pedal|frame|kit|number|plan)\b",
        # told, asked, or for later
        r"\b(?:tell|told|ask|asked|remind)\s+\w+\s+to\s+(?:stop|halt|wait)\b",
        rf"\b{_AUXILIARY}\s+(?:\w+\s+)?(?:stop|halt|wait|freeze|brake)\b(?!\s*[!])",
        r"\b(?:until|till|unless|before)\s+\w+\s+(?:says?|calls?|shouts?|tells?\s+you\s+to)\s+(?:stop|halt|wait)\b(?!\s*[!])",
        r"\b(?:stop|wait|halt)\s+(?:smiling|smoking|talking|asking|laughing|crying|worrying|raining|"
        r"joking)\b",
        # an order of where to go and then to stand
        r"\b(?:stop|halt|wait|peatu|oota|seisa)\s+(?:at|by|in\s+(?:the|front)|near|next\s+to|beside|behind|"
        r"opposite|under|outside|inside|between|on\s+the|off\s+at|over\s+at|there\s+(?:for|until|till)|"
        r"until|till|for\s+(?:him|her|them|us|me\s+(?:at|by|in|near|there))|when|once|after)\b(?!\s+once\b)",
        r"\b(?:and|then|,)\s+(?:stop|halt|wait)\s+(?:and|there|then|for)\b",
        r"\b(?:peatu|oota|seisa)\s+(?:\w+\s+)?\w*(?:s|l|juures|ees|taga|kõrval|juurde|ääres|"
        r"äärde)\b(?=[^!]*$)",
        r"\b(?:careful|enough|freeze|wait)\s+(?:with|of|for|about|the|to)\b",
        r"\b(?:be|more|very|was|is|are|good|well|fast|big|old|warm|long|far)\s+(?:careful|enough)\b(?!\s*!)",
        r"\benough\s+\w+\b",
    )
)  # fmt: skip


def has_stop_word(text: str) -> bool:
    """Whether a message has a word of stopping in it; every robot it is for then stands while it is read."""
    return _STOP.search(_plain(text)) is not None


def called(text: str, names: Sequence[str]) -> tuple[str, ...]:
    """Which of some robots a call to stop is for by its words alone, whoever it is said to.

    Who is waited for is not called: "wait for Kim" is for whoever hears it.
    """
    if _EVERYBODY.search(_plain(text)) or stops_all(text):
        return tuple(names)
    known = "|".join(map(re.escape, names))
    awaited = rf"\bfor\s+(?:{known})(?:\s+and\s+(?:{known}))*\b"
    return named_in(re.sub(awaited, " ", text, flags=re.IGNORECASE) if names else text, names)


def calls_to_stop(text: str) -> bool:
    """Whether a message with such a word calls to stand still; in doubt it does."""
    plain = _plain(text)
    taken = [found.span() for pattern in _NONE for found in pattern.finditer(plain)]
    return any(
        not any(start <= found.start() and found.end() <= end for start, end in taken)
        for found in _STOP.finditer(plain)
    )


def only_takes_back(text: str, *, moves: bool = True) -> bool:
    """Whether the words of stopping in a message only open a correction: "wait, not that one, the other".

    Such a message is read to its end while the robot stands; if nothing comes of it, it goes on standing.

    Args:
        text: The message.
        moves: Whether the robot is under way; of one that stands any word more is read.
    """
    plain = _plain(text)
    rest = _STOP.sub(" ", plain)
    more = _BEHIND.search(rest) if moves else len(re.findall(r"\w+", rest)) > _FEW
    return _STOP.search(plain) is not None and only_waits(text) and bool(more)


def asked_behind(text: str) -> str:
    """The question that follows words of stopping ("wait, is it open?"); empty if something else does.

    What may be an order in the form of a question ("wait, could you ...") is none.
    """
    found = _ASKED.fullmatch(_plain(text))
    return found["rest"] if found is not None else ""


_ASKED: Final = re.compile(
    rf"\W*(?:(?:no|oh|please|{STOP_WORDS})\W+)*(?:{STOP_WORDS})(?:\W+(?:a|one|moment|second|sec|minute|please))*"
    r"(?:\s*[,.!;:–-]+\s*|\s+)(?P<rest>(?:(?:is|are|was|were|did|do|does|have|has|where|who|when|why|how|"
    r"which|what)(?!\s+(?:about|if|don't|not)\b|\s+you\s+mind\b)|what's|where's|who's)\s.+\?)\W*",
    re.IGNORECASE | re.DOTALL,
)


def only_waits(text: str) -> bool:
    """Whether all words of stopping in a message are those that mostly open a correction: "no wait"."""
    return all(_WEAK.fullmatch(found[0]) is not None for found in _STOP.finditer(_plain(text)))


_FEW: Final = 3
_WEAK: Final = re.compile(r"w+a+i+t+|hang\s+on|hold\s+on|oota", re.IGNORECASE)
_BEHIND: Final = re.compile(
    r"\b(?:not|instead|rather|i\s+mean|i\s+meant|actually|sorry|first|forget|skip|leave\s+out|change|"
    r"go\s+to|drive\s+to|wrong|asemel|hoopis|mitte)\b",
    re.IGNORECASE,
)


def is_no(text: str) -> bool:
    """Whether a message says no and nothing else; a robot that drives and asked nothing then stands."""
    return _NO.fullmatch(_plain(text)) is not None


def opens_with_no(text: str) -> bool:
    """Whether a message is a no or a wait with more behind it ("wait, first the desk"); "no sugar" is not."""
    return _OPENS.match(_plain(text)) is not None


_OPENS: Final = re.compile(
    r"\W*(?:(?:no+|nope|nah|ei)\b(?:\s*[,.!;:–-]+\s*\w|\s+(?:i|you|not|that|this|it|the|wait|do|don't)\b)|"
    r"(?:wait|hold on|hang on|oota)\b\s*[,.!;:–-]+\s*\w)",
    re.IGNORECASE,
)


def _plain(text: str) -> str:
    return unicodedata.normalize("NFKC", text).replace("’", "'")
