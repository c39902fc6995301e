"""What is done about people: words that are said to them, and who is followed."""

from __future__ import annotations

import re
from collections.abc import MutableMapping
from dataclasses import replace
from typing import Final

from parley.gate.stop_words import has_stop_word
from parley.language.builtin.decision import Ask
from parley.language.builtin.grounding import Grounder, Value, is_somebody
from parley.language.builtin.lexicon import stem
from parley.language.builtin.skills import Skill
from parley.language.builtin.wishes import Wish
from parley.language.lexicon import word_set
from parley.umrf.kinds import words_of_name

__all__ = ["followed", "spoken"]

_LITERAL: Final = word_set("say tell announce let inform whisper shout speak wish remind")
"""Verbs behind which the words stand as they are to be said; "read the sign" is no such."""
_GREETING: Final = frozenset({"greet", "welcome"})
_ELSEWHERE: Final = word_set("in on at by near behind under beside outside inside")
"""Prepositions that say where somebody is, and not who."""
_SENTENCE: Final = 3
"""So many words a sentence has that begins with "the"."""
_ALOUD: Final = re.compile(r"^(?:aloud|loudly|loud|this|the following)\s*:\s*", re.IGNORECASE)
_REPORTED: Final = re.compile(
    r"(?:about|of|how|what|whether|if|who|whom|whose|which|where|when|why|until|once|as|something|it|this|"
    r"them|so|in|something about)\b|that$",
    re.IGNORECASE,
)
"""How words begin that only tell what is to be said."""
_SPEAKER: Final = re.compile(
    r"\b(?:i|i'm|i've|i'll|i'd|me|my|mine|myself|we|we're|us|our|you|you're|your|he|she|his|her|him|they|their)\b",
    re.IGNORECASE,
)
_QUOTED: Final = re.compile(r"[\"“”„«]([^\"“”„»]+)[\"“”»]")


def spoken(wish: Wish, values: MutableMapping[str, Value], grounder: Grounder) -> Ask | None:
    """Put the words to be said as they are said; a question where they are not told word for word."""
    verb = wish.verb.split()[0]
    person = values.get("R")
    whom = f" to {person.said}" if person is not None else ""
    if person is not None and (asked := _to_whom(wish, person, grounder)) is not None:
        return asked
    if verb in _GREETING and not re.search(r"\w", values["X"].argument if "X" in values else ""):
        values["X"] = Value("hello", "hello")
    told = values.get("X")
    if told is None:
        return Ask(f"What shall I say{whom}?")
    quoted = _QUOTED.search(grounder.situation.message)
    text = quoted[1] if quoted is not None else _ALOUD.sub("", told.argument.strip("\"'“”‘’ .,!"))
    if quoted is None and verb not in _LITERAL | _GREETING:
        text = ""
    elif quoted is None and verb == "say":
        text = "" if _is_reported(text, grounder) else re.sub(r"^that\s+", "", text, flags=re.IGNORECASE)
    elif quoted is None:
        told_of = _is_reported(text, grounder) or _SPEAKER.search(text) is not None
        text = "" if told_of else re.sub(r"^(?:that|to)\s+", "", text, flags=re.IGNORECASE)
    if not text and _informs(grounder.skills.get("SAY")) and not _SPEAKER.search(told.argument):
        values["X"] = replace(told, argument=told.said, said=told.said)
        return None
    if not text:
        return Ask(f"What exactly shall I say{whom}? Please tell me word for word: say “…”.")
    values["X"] = replace(told, argument=text, said=text)
    return None


def _to_whom(wish: Wish, person: Value, grounder: Grounder) -> Ask | None:
    """A question where words cannot be said to somebody just now."""
    words = wish.all("R")[0].words
    if not _is_somebody(wish, "R", person, grounder) or words[0] in _ELSEWHERE:
        return Ask(f"Is {person.said} somebody I can speak to? Please tell me whom you mean.")
    if _ELSEWHERE & {*words[1:]}:
        return Ask(
            f"I say it where I stand. Where shall I go first, and what shall I say to {person.said} there?"
        )
    if wish.verb.split()[0] == "remind" and person.argument == "operator":
        return Ask("I cannot remind you later: I only speak at once. What shall I say now?")
    return None


_INFORMING: Final = frozenset({"information", "news", "tell", "tells", "inform", "informs"})


def _informs(skill: Skill | None) -> bool:
    """Whether an action tells of what it is given, by its maker's words, and does not only read it out."""
    return skill is not None and bool(_INFORMING & {*words_of_name(skill.action.description)})


def _is_reported(text: str, grounder: Grounder) -> bool:
    """Whether words only tell what is to be said: "where the box is", "the time", "the day of the week"."""
    words = text.lower().split()
    short = len(words) < _SENTENCE or words[2] == "of"
    named = bool(words) and words[0] in grounder.lexicon.classes["determiners"] - {"no", "that", "all"}
    return (named and short) or ":" in text or _REPORTED.match(text) is not None


def followed(wish: Wish, values: MutableMapping[str, Value], grounder: Grounder) -> Ask | None:
    """Who is followed, and how long; a question where it is nobody, or nobody can tell how long."""
    who = values.get("T")
    if who is None:
        return Ask("Whom shall I follow?")
    if not _is_somebody(wish, "T", who, grounder):
        return Ask(f"I only follow people. Whom do you mean by “{who.said}”?")
    if "U" in values and not has_stop_word(values.pop("U").argument):
        return Ask("I follow until you tell me to stop, or for so many minutes. How shall I do it?")
    return None


def _is_somebody(wish: Wish, role: str, value: Value, grounder: Grounder) -> bool:
    """Whether a person is meant, as far as words and map tell; a name that no map holds is somebody's."""
    fillers = wish.all(role)
    head = stem(fillers[0].words[fillers[0].head]) if fillers else ""
    if is_somebody(head) or grounder.is_person(fillers, value):
        return True
    if value.things:
        return all(thing.description[:1].isupper() for thing in value.things)
    words = fillers[0].words if fillers else ()
    classes = grounder.lexicon.classes
    if value is grounder.last_person and {*words} <= classes["pronouns"] | classes["persons"]:
        return True  # who was spoken of
    return len(words) == 1 and head not in grounder.lexicon.classes["pronouns"]
