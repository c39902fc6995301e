"""What is to be left alone, however it is said: "stay out of A", "A is not to be disturbed", "leave A be".

The names in a part of a message are seen as one sign each (`#`); what is said around them is compared with
patterns of general English (`data/sparing.yaml`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache

from parley.language.offline.words.inflecting import forms
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = ["explains", "leads", "name_spans", "names_in", "spares", "spares_it"]

IsStop = Callable[[Phrase], bool]

_DATA = load_data("sparing")
_LONGEST_NAME = 7
_MOST_WORDS = 24
_SIGN = re.compile(r"\[([^\]]*)\]|\(([^)]*)\)|(\S+)")
_NO_SUBJECT = (
    "if|whether|unless|when|while|check|see|look|sure|make|verify|tell|ask|is|are|do|does|did|what|which|how|why"
    "|where|until|before|after|not|that|go|drive|and|but|in case|should|has|have|,"
)
_NO_START = "if|whether|unless|when|check|see|look|make|verify|ask|is|are|does|did|what|which|who"
_NO_START += "|how|why|where|has|have"
_SUBJECT = (
    rf"(?:(?:(?!(?:{_NO_SUBJECT}) )[^# ]+ ){{1,4}}(?:in|at|on|of|from|inside|by|near|behind|with) )?"
    r"(?:the |all |of |both )*# (?:(?:itself|themselves|there|here|too|also|however|though|in particular) )?"
)
_OVERLOOKED = "missed|skipped|ignored|omitted|neglected|overlooked|delayed|excluded|avoided"
_LISTED = re.compile(
    r"# (?:, (?:# |\d+ ))*(?:(?:, )?(?:and|or|nor|plus) (?:# |\d+ ))+|\b(?:both|either|all) (?=# )"
)


def _either(options: Iterable[str]) -> str:
    return "(?:" + "|".join(_pattern(option) for option in options) + ")"


def _pattern(template: str) -> str:
    """A pattern for words that each end with a blank."""
    parts: list[str] = []
    for may_be, one_of, word in _SIGN.findall(template):
        if may_be:
            parts.append(_either(may_be.split("|")) + "?")
        elif one_of:
            parts.append(_either(one_of.split("|")))
        elif word in {"@", "THING"}:
            parts.append(_SUBJECT if word == "@" else "# ")
        elif word == "*":
            parts.append(r"(?:[^# ]+ ){0,4}?")
        elif word == "ED":
            parts.append(rf"(?!(?:{_OVERLOOKED}) )[^# ]+ed ")
        elif word in {"DONE", "DOING"}:
            parts.append(_touched()[word])
        else:
            parts.append(re.escape(word) + " ")
    return "".join(parts)


@cache
def _touched() -> dict[str, str]:
    """The forms of verbs by which a thing is touched."""
    done: list[str] = []
    doing: list[str] = []
    for verb in _DATA["touching"]:
        first, _, rest = verb.partition(" ")
        tail = f"{rest} " if rest else ""
        own = forms([first])
        done += [
            f"{form} {tail}" for form in (*_IRREGULAR.get(first, ()), *own) if not form.endswith(("ing", "s"))
        ]
        doing += [f"{form} {tail}" for form in own if form.endswith("ing")]
    longest = {
        name: sorted(set(found), key=len, reverse=True) for name, found in (("DONE", done), ("DOING", doing))
    }
    return {name: "(?:" + "|".join(map(re.escape, found)) + ")" for name, found in longest.items()}


_IRREGULAR = {
    "see": ("seen",), "wake": ("woken",), "go": ("gone",), "drive": ("driven",), "do": ("done",),
    "sweep": ("swept",), "swept": ("swept",), "feed": ("fed",),
}  # fmt: skip


@cache
def _sparing() -> re.Pattern[str]:
    """All ways to say that # is to be left alone."""
    stops = "|".join(re.escape(word) for word in _DATA["not_forbidding"])
    between = rf"(?:(?!(?:{stops}) )[^# ,]+ ){{0,6}}?"
    forbidden = f"{_either(_DATA['forbidding'])}{between}# "
    said = "|".join([*(_pattern(text) for text in (*_DATA["orders"], *_DATA["statements"])), forbidden])
    return re.compile(f"{_leads()}(?!(?:{_NO_START}) )(?:{said}){_tails()}")


@cache
def _pointing() -> re.Pattern[str]:
    said = "|".join(_pattern(text) for text in _DATA["pointing"])
    return re.compile(f"{_leads()}(?:{said}){_tails()}")


def _leads() -> str:
    return f"(?:{_either(_DATA['leads'])}|, )*"


def _tails() -> str:
    links = "because|since|as|until|till|while|when|for|so that|due to|owing to"
    why = rf"(?:{links}) (?!last |the end |the last |end )(?:[^# ]+ )*"
    return f"(?:{_either(_DATA['tails'])}|{why}|, )*"


def name_spans(words: Phrase, is_stop: IsStop) -> list[tuple[int, int]]:
    """Where words name something, longest names first; a name with more behind it is none."""
    found: list[tuple[int, int]] = []
    at = 0
    while at < len(words):
        sizes = range(min(_LONGEST_NAME, len(words) - at), 0, -1)
        size = next((n for n in sizes if words[at].is_word and _is_name(words[at : at + n], is_stop)), 0)
        if size:
            found.append((at, at + size))
        at += size or 1
    return found


def _is_name(words: Phrase, is_stop: IsStop) -> bool:
    return words[-1].key not in _NO_END and bare(words)[-1:] == words[-1:] and is_stop(words)


_NO_END = frozenset(
    {"but", "and", "or", "nor", "not", "to", "so", "then", "is", "are", "at", "in", "on", "the"}
)


def _seen(words: Phrase, is_stop: IsStop) -> tuple[str, tuple[Phrase, ...]]:
    """The words with one sign for each name or list of names, and the names."""
    spans = name_spans(words, is_stop)
    inside = {i for start, end in spans for i in range(start + 1, end)}
    begun = {start for start, _ in spans}
    text = " ".join("#" if i in begun else word.key for i, word in enumerate(words) if i not in inside) + " "
    names = tuple(words[start:end] for start, end in spans)
    return _LISTED.sub(lambda found: "# " if "#" in found.group() else "", text), names


def names_in(words: Phrase, is_stop: IsStop) -> tuple[Phrase, ...]:
    """What words name, in their order."""
    return tuple(words[start:end] for start, end in name_spans(words, is_stop))


def spares(words: Phrase, is_stop: IsStop) -> tuple[Phrase, ...]:
    """What a part of a message says is to be left alone; nothing if it says more, or nothing of the kind.

    Args:
        words: One part, without the mark behind it.
        is_stop: Whether words name something on the map.
    """
    if not words or len(words) > _MOST_WORDS:
        return ()
    text, names = _seen(words, is_stop)
    return names if names and _sparing().fullmatch(text) is not None else ()


def spares_it(words: Phrase) -> bool:
    """Whether a part says that what was spoken of is to be left alone ("leave it", "no need to go there")."""
    return 0 < len(words) <= _MOST_WORDS and _pointing().fullmatch(" ".join(keys(words)) + " ") is not None


def leads(words: Phrase) -> bool:
    """Whether a part says nothing but that something important follows ("whatever you do")."""
    return bool(words) and re.fullmatch(_leads(), " ".join(keys(words)) + " ") is not None


def explains(words: Phrase) -> bool:
    """Whether a part may say why something is to be left alone ("she is asleep")."""
    return bool(words) and words[0].key in _EXPLAINING


_EXPLAINING = frozenset(_DATA["explaining"])
