"""Which verb a form in a message is of, and whether it is one that a robot can be asked for."""

from __future__ import annotations

from functools import lru_cache

from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.concepts import LIGHT_VERBS, concepts, likeness
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import told_deed
from parley.language.offline.words.text import lemma, singular
from parley.language.word_lists import load_data

__all__ = ["COMMON", "Deeds"]

_DATA = load_data("forms")
_STATES = frozenset(_DATA["states"])
_IRREGULAR: dict[str, str] = dict(_DATA["irregular"])
_RESULTING = frozenset(_DATA["resulting"])
_NOUNS: dict[str, str] = dict(_DATA["nouns"])
COMMON = frozenset({
    "motion", "look", "whether", "search", "transfer", "grasp", "speak", "follow", "meet", "count",
    "guide", "place", "back", "drop_step", "fetch", "handover",
})  # fmt: skip
"""Kinds of orders that people ask for anywhere."""
_EDITS = frozenset(
    {"skip", "drop", "cancel", "forget", "omit", "delete", "remove", "swap", "postpone", "repeat"}
)
_SAME = frozenset({"cut", "put", "shut", "set", "read", "hit", "reset", "split", "spread", "run"})
_VOWELS = frozenset("aeiouy")
_LIKE = 0.8
_SHORTEST = 3


class Deeds:
    """The verbs that the catalogue, its descriptions and the word lists know, in all their forms.

    Args:
        own: The first words of what may be asked of this robot.
    """

    def __init__(self, own: frozenset[str]) -> None:
        self.own = own
        self.known = own | _listed()
        self._asked: dict[str, bool] = {}

    @classmethod
    def of(cls, scene: Scene) -> Deeds:
        """What can be asked for in a situation."""
        told = (told_deed(info.description)[:1] for info in scene.catalogue.infos)
        said = (verb for line in told for word in line for verb in (lemma(word), singular(word)))
        return _deeds(frozenset((*(verb[0] for verb in scene.catalogue.verbs), *said)))

    def done(self, word: str) -> str:
        """The verb of a past participle; "" if a word is none."""
        if word in _SAME:
            return word
        if word.endswith(("ing", "s")) or word in lexicon().be | lexicon().auxiliaries:
            return ""
        return self._base(word, "ed")

    def doing(self, word: str) -> str:
        """The verb of a form in -ing; "" if a word is none."""
        return self._base(word, "ing") if word.endswith("ing") else ""

    def noun(self, word: str) -> str:
        """The deed that a noun names ("inspection", "calibration", "a rinse"), as an order begins."""
        if word in _NOUNS:
            return _NOUNS[word]
        for ending in ("ation", "ion", "ment", "al"):
            stem = word.removesuffix(ending)
            found = next((stem + end for end in ("", "e", "ate") if stem + end in self.own), "")
            if stem != word and found:
                return found
        return self.doing(word) or (word if word in self.own and word not in LIGHT_VERBS else "")

    def can(self, verb: str) -> bool:
        """Whether a robot may be asked for a deed: one of its own, one like it, or a common one."""
        if not verb or verb in _STATES:
            return False
        if verb not in self._asked:
            self._asked[verb] = self._can(verb)
        return self._asked[verb]

    def may(self, verb: str) -> bool:
        """Whether a verb is a deed at all: one that can be done, or no state of things."""
        return bool(verb) and verb not in _STATES and (verb not in _RESULTING or self.can(verb))

    @staticmethod
    def is_state(verb: str) -> bool:
        """Whether a form of a verb tells how something is, not what is done to it."""
        return not verb or verb in _STATES

    def _can(self, verb: str) -> bool:
        found = lexicon().verbs.match((verb,))
        common = found is not None and found[1].partition(":")[0] in COMMON
        if verb in self.own or common or verb in _EDITS:
            return True
        if verb in LIGHT_VERBS:
            return False
        mine = [one for word in self.own for one in concepts((word,), spoken=False)]
        return any(likeness(one, said) >= _LIKE for one in mine for said in concepts((verb,)))

    def _base(self, word: str, ending: str) -> str:
        irregular = _IRREGULAR.get(word) or lexicon().irregular.get(word, "")
        if irregular:
            return irregular
        if not word.endswith(ending) or len(word) < len(ending) + 2:
            return ""
        stem = word[: -len(ending)]
        doubled = len(stem) > _SHORTEST and stem[-1] == stem[-2]
        ends = [stem, f"{stem}e", *([stem[:-1]] if doubled else [])]
        if ending == "ed" and stem.endswith("i"):
            ends.append(f"{stem[:-1]}y")
        for listed in (self.own, self.known):
            found = next((base for base in ends if base in listed), "")
            if found:
                return found
        if len(stem) < _SHORTEST or not _VOWELS & set(stem):
            return ""
        if doubled and stem[-1] not in "sl":
            return stem[:-1]
        if stem.endswith("i"):
            return f"{stem[:-1]}y"
        short = stem[-1] not in _VOWELS | {"x", "w"} and stem[-2] in _VOWELS and stem[-3:-2] not in _VOWELS
        return f"{stem}e" if short or stem[-1] in "uvc" else stem


@lru_cache(maxsize=32)
def _deeds(own: frozenset[str]) -> Deeds:
    return Deeds(own)


@lru_cache(maxsize=1)
def _listed() -> frozenset[str]:
    deeds = load_data("deeds")
    told = (verb for line in (*deeds["verbs"], *deeds["near"]) for verb in line)
    classes = (verb for listed in lexicon().verb_classes.values() for verb in listed)
    return frozenset(verb.split()[0] for verb in (*told, *classes))
