"""What is done by the action made for it: what its inputs hold, where it is done, what is said to people."""

from __future__ import annotations

import re
from collections.abc import MutableMapping
from dataclasses import dataclass, replace
from typing import Final

from parley.gate.stop_words import has_stop_word
from parley.language.builtin.checks import seen_at
from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.grounding import Grounder, Value
from parley.language.builtin.handling import Handling
from parley.language.builtin.lexicon import is_somebody, stem
from parley.language.builtin.skills import Skill
from parley.language.builtin.spans import Filler
from parley.language.builtin.ways import typed
from parley.language.builtin.wishes import Wish
from parley.language.lexicon import word_set
from parley.umrf.kinds import parameters_of, words_of_name

__all__ = ["Doing", "followed", "slot_of", "spoken"]


@dataclass(slots=True)
class Doing(Handling):
    """Makes the deeds of one action, with the way to where it is done."""

    def direct(self, wish: Wish, skill: Skill, values: dict[str, Value]) -> list[Deed] | Ask:
        """By the action that is made for it."""
        arguments: dict[str, str | float] = {}
        said: dict[str, str] = {}
        before = self._to_people(wish, values)
        gloss = self.lexicon.frames[wish.frame].gloss
        for role, value in values.items():
            slot = slot_of(skill, role, values)
            if slot is not None and role == "T" and "L" in values and self._takes_place(skill, slot, value):
                slot = None  # "how many boxes are on the shelf": the shelf is what is counted through
            if slot is not None and slot not in arguments:
                given = typed(value, skill.action, slot)
                if given is None:
                    return Ask(f"I cannot {gloss} with “{value.said}”. Can you say it otherwise?")
                arguments[slot], said[role] = given, value.said
                continue
            led = self._without_slot(wish, role, value, skill)
            if isinstance(led, Ask):
                return led
            before += led
        if set(skill.action.inputs) - set(arguments) - set(skill.action.optional):
            return Ask(f"I can {gloss}, but I need to know more: what, or where?")
        way = self._to_be_there(wish, skill, values)
        if isinstance(way, Ask):
            return way
        if wish.frame in ("TAKE", "FIND") and "T" in values:
            self.held += [values["T"].argument] if wish.frame == "TAKE" else []
            self.in_hand = values["T"] if wish.frame == "TAKE" else self.in_hand
            self.sought = (self.at, values["T"].argument)
        deed = Deed(wish.frame, skill, arguments, said)
        if "looks" in skill.action.effects or wish.frame in ("LOOK", "FIND"):
            self.last_check = deed
        return [*before, *way, deed]

    @staticmethod
    def _takes_place(skill: Skill, slot: str, value: Value) -> bool:
        """Whether an input takes a place, and a value is none."""
        return parameters_of(skill.action)[slot].kind == "place" and not (value.things or value.place)

    def _to_people(self, wish: Wish, values: dict[str, Value]) -> list[Deed]:
        """The way to whom something is done with, if it was told where they are."""
        who = "R" if wish.frame in ("SAY", "GIVE", "ANSWER") else "T"
        person = values.get(who)
        if wish.frame not in _TO_PEOPLE or person is None or "GO" not in self.skills:
            return []
        if (where := values.get("L") or (values.get("S") if wish.frame == "FOLLOW" else None)) is not None:
            way = self.nearing(where)
        else:
            now = person.place is not None and person.place.memory not in self.situation.memory
            told = person.place is not None if wish.frame == "SAY" else wish.frame == "GIVE"
            way = self.way_to_thing(person if told or now else None)  # who is led may be called
        return [] if isinstance(way, Ask) or not way else [*way, *self.met(person, wish.one(who))]

    def _without_slot(self, wish: Wish, role: str, value: Value, skill: Skill) -> list[Deed] | Ask:
        """What comes of a role that no input of an action takes: a way, or nothing at all."""
        meant = role == "T" and self._is_meant_anyway(wish, skill)
        if meant or (wish.frame in ("SAY", "ANSWER") and role == "R" and self.at):
            return []
        there = role in "SL" or wish.frame in ("CHARGE", "PUT")
        way = self.nearing(value) if there and "GO" in self.skills else None
        if isinstance(way, list):
            return way
        if wish.frame in _LOOSE:
            self.unheeded(value.said)
        elif value.argument != "operator" or wish.frame in _TOLD:
            gloss = self.lexicon.frames[wish.frame].gloss
            return way or Ask(f"I can {gloss}, but I do not know what to do about {value.said}.")
        return []

    def _to_be_there(self, wish: Wish, skill: Skill, values: dict[str, Value]) -> list[Deed] | Ask:
        """The way to what is looked at, or handled by an action of which only the name is known."""
        goes = skill.is_only_named and wish.frame in _ON_THE_SPOT
        if wish.frame == "FIND" and ("L" in values or self.at):
            return []
        if not ("looks" in skill.action.effects or goes) or "GO" not in self.skills:
            return []
        seen = (values.get("G") if goes else None) or values.get("T") or self._seen_in(wish.one("K"))
        return seen if isinstance(seen, Ask) else self.way_to_thing(seen)

    def _is_meant_anyway(self, wish: Wish, skill: Skill) -> bool:
        """Whether a thing is what an action is about by its name: "the boxes" where it counts boxes."""
        about = {stem(word) for word in words_of_name(f"{skill.action.name} {skill.action.description}")}
        small = self.lexicon.classes["determiners"]
        return all(stem(word) in about for f in wish.all("T") for word in f.words if word not in small)

    def _seen_in(self, filler: Filler | None) -> Value | Ask | None:
        """Where "how it is" is seen: what that names, else what was spoken of, else where it is."""
        place = seen_at(self, filler.words) if filler is not None else None
        if filler is None or place is not None or self.at or {*filler.words} & _ABOUT_HERE:
            return place
        return Ask(f"Where shall I look {filler.text}?")


def slot_of(skill: Skill, role: str, values: dict[str, Value]) -> str | None:
    """The parameter for a role: its own, else that of a like role that nothing else fills."""
    if role in skill.roles:
        return skill.roles[role]
    if role == "S" and "G" not in values:
        return None  # "from the ramp" is no goal
    like = (other for other in _ALIKE.get(role, "") if other in skill.roles and other not in values)
    return next((skill.roles[other] for other in like), None)


_ALIKE = {"G": "RL", "R": "G", "K": "T", "T": "KX", "S": "G", "L": "S", "H": "T"}
"""Which other role's parameter takes what a role holds, if it is free."""
_ABOUT_HERE = frozenset({"you", "here", "there", "i"})
_TO_PEOPLE = frozenset({"SAY", "GIVE", "FOLLOW", "GUIDE", "ANSWER"})
"""What is done with somebody: where they are."""
_ON_THE_SPOT = frozenset({"LOOK", "PHOTO", "TAKE", "PUT", "FIND"})
"""What is done where the thing is: an action of which only the name is known may not drive there itself."""
_LOOSE = frozenset({"FOLLOW", "PHOTO"})
"""What is done all the same if a part of it has no place in the action; that is said."""
_TOLD = frozenset({"SAY", "ANSWER", "GIVE", "BRING"})
"""What is done for somebody in particular."""


# -- about people: words that are said to them, and who is followed --


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
