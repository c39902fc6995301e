"""What a robot can do, read from its own catalogue: roles of actions, values for their parameters, chains.

Nothing here knows an action by name. What an action is good for follows from its declared effects, else from
the words of its name, phrases and description; an input that nobody says in words is fetched from the action
whose outputs carry exactly that name and type.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

from parley.language.offline.tasks.choices import is_listed
from parley.language.offline.tasks.roles import (
    number_inputs,
    parameter_role,
    pose_inputs,
    roles_of,
    text_inputs,
)
from parley.language.offline.words.concepts import other_verbs
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import kind_of, name_words, told_deed
from parley.language.offline.words.quantities import taken_by
from parley.language.offline.words.text import lemma, singular, split_name
from parley.language.word_lists import load_data
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo

__all__ = [
    "BY_INSTRUMENT",
    "Catalogue",
    "call",
    "goes_itself",
    "parameter_role",
    "roles_of",
    "templates",
    "text_inputs",
]


def _shared_prefix(infos: Sequence[ActionInfo]) -> str:
    """What the names of nearly all actions begin with, though it says nothing of any of them."""
    first = [split_name(info.name)[:1] for info in infos if len(split_name(info.name)) > 1]
    if len(infos) < _FEWEST or not first:
        return ""
    (word,) = max(first, key=first.count)
    often = first.count((word,)) >= len(infos) - 1
    return word if often and lexicon().verbs.match((word,)) is None else ""


_FEWEST = 3


def templates(info: ActionInfo) -> tuple[str, ...]:
    """The examples of an action as phrases: what is named in them stands for the action's inputs.

    "Check in Anna" of an action with one input in words becomes "check in {member}".
    """
    texts, found = text_inputs(info), []
    for example in info.examples:
        words = [word for word in example.strip().rstrip(".!?").split() if word]
        start = next((i for i, w in enumerate(words) if i and _names_something(w)), 0)
        if not start:
            found.append(example.strip().rstrip(".!?").lower())
            continue
        end = start + 1
        if words[start].lower() in lexicon().determiners:
            while end < len(words) and words[end].lower() not in lexicon().goals_and_places:
                end += 1
        else:
            while end < len(words) and words[end][:1].isupper():
                end += 1
        if len(texts) != 1:
            found.append(" ".join(words[:start]).lower())
            continue
        slot = "{" + texts[0] + "}"
        found.append(" ".join((" ".join(words[:start]).lower(), slot, " ".join(words[end:]).lower())).strip())
    return tuple(dict.fromkeys(found))


def _names_something(word: str) -> bool:
    return word[:1].isupper() or word.lower() in lexicon().determiners


def goes_itself(info: ActionInfo) -> bool:
    """Whether an action goes to what it is for, as its description says ("drives to a gate and opens it")."""
    told = re.findall(r"[a-z]+", info.description.lower())
    found = lexicon().verbs.match((lemma(told[0]), *told[1:])) if told else None
    return found is not None and found[1].startswith("motion:") and "and" in told


def call(info: ActionInfo, values: Mapping[str, Any], reason: str = "") -> ActionCall:
    """One step: given values written in, everything that is handed over left without value."""
    return ActionCall(
        name=info.name,
        input_parameters={name: Parameter(kind, values.get(name)) for name, kind in info.inputs.items()},
        output_parameters={name: Parameter(kind) for name, kind in info.outputs.items()},
        reason=reason,
    )


_RECENT: deque[Catalogue] = deque(maxlen=16)


class Catalogue:
    """The actions of one robot."""

    def __init__(self, infos: Sequence[ActionInfo]) -> None:
        self.infos = tuple(infos)
        self._prefix = _shared_prefix(self.infos)
        self._roles = {info.name: roles_of(self.plainly_named(info)) for info in infos}
        self._let_fetch_grasp()
        self._table = self._verb_table()
        self.of_own_kind = tuple(info for info in self.infos if self._is_own_kind(info))
        """The actions that no task of a common kind is put together from, or not by them alone."""
        also = {words for info in self.of_own_kind for words in _other_words(self.plainly_named(info))}
        self.verbs = tuple(sorted({*self._table, *also}, key=len, reverse=True))
        """First words by which actions of no common role can be asked for."""

    @classmethod
    def of(cls, infos: tuple[ActionInfo, ...]) -> Catalogue:
        """The actions of one robot; what was worked out about them last is kept, as it does not change."""
        known = next((one for one in _RECENT if one.infos is infos), None)
        if known is None:
            known = cls(infos)
            _RECENT.appendleft(known)
        return known

    @property
    def times_itself(self) -> bool:
        """Whether an action of its own kind takes how long it lasts."""
        return any(
            "time" in taken_by(name, info.description).dimensions
            for info in self.of_own_kind
            for name in number_inputs(info)
        )

    def _let_fetch_grasp(self) -> None:
        """Where things are handed over by another action, one that only gets an item is how it is taken."""
        roles = self._roles
        if any("grasp" in role for role in roles.values()) or self.with_role("handover", "place") is None:
            return
        for info in self.infos:
            if roles[info.name] == {"fetch"} and len(info.inputs) == 1 and self.mover is not None:
                roles[info.name] = frozenset({"grasp"})

    def _is_own_kind(self, info: ActionInfo) -> bool:
        roles = self._roles[info.name]
        if "motion" in roles:
            return info is not self.mover
        if roles == {"count"} and text_inputs(info):
            takes = {parameter_role(name) for name in text_inputs(info)}
            topic = set(name_words(info.name)) - _COUNTED_AT_LARGE
            return takes == {"place"} or (takes <= {"place", ""} and bool(topic))
        if roles & _IN_WORDS and self._takes_more(info):
            return True
        if roles == {"look"} and name_words(info.name)[0] in BY_INSTRUMENT:
            # "scan (sample)".
            return [parameter_role(name) for name in text_inputs(info)] == [""]
        texts = [name for name in text_inputs(info) if name not in info.optional]
        if roles == {"speak"} and {parameter_role(name) for name in texts} >= {"text", "place"}:
            # "announce (message, area)".
            return True
        if roles == {"handover"} and not any(parameter_role(n) == "person" for n in text_inputs(info)):
            # "offer_drink" of a robot that takes nothing itself.
            return self.with_role("grasp", "fetch") is None
        return not roles or (not info.inputs and not roles & {"look", "answer", "ask_operator"})

    def plainly_named(self, info: ActionInfo) -> ActionInfo:
        """An action without what the names of all begin with ("wh_scan" among "wh_go", "wh_stack")."""
        if not self._prefix or not info.name.lower().startswith(self._prefix):
            return info
        return info.model_copy(update={"name": info.name[len(self._prefix) :].lstrip("_-. ")})

    @staticmethod
    def _takes_more(info: ActionInfo) -> bool:
        """Whether it needs what no common task gives: a number, one of a few values, a yes or no."""
        needed = [name for name in info.inputs if name not in info.optional and "::" not in name]
        kinds = {kind_of(info.inputs[name]) for name in needed} - {"string"}
        listed = any(is_listed(name, info) for name in needed if kind_of(info.inputs[name]) == "string")
        return bool(kinds & {"number", "bool"} or listed) and not pose_inputs(info)

    def roles(self, info: ActionInfo) -> frozenset[str]:
        """What one of the actions is good for."""
        return self._roles[info.name]

    def with_role(self, *roles: str) -> ActionInfo | None:
        """The first action that is good for any of `roles`, in the order of the roles."""
        for role in roles:
            for info in self.infos:
                if role in self._roles[info.name]:
                    return info
        return None

    def all_with_role(self, role: str) -> list[ActionInfo]:
        """Every action that is good for `role`."""
        return [info for info in self.infos if role in self._roles[info.name]]

    def get(self, name: str) -> ActionInfo | None:
        """The action of that name."""
        return next((info for info in self.infos if info.name == name), None)

    def for_verb(self, verb: str) -> ActionInfo | None:
        """The action whose name or phrase begins with a verb."""
        return self._table.get(tuple(verb.split()))

    def reading(self, words: Sequence[str]) -> ActionInfo | None:
        """The one action without inputs that tells what is asked about ("get_battery_level": the battery)."""
        said = {singular(word) for word in words}
        fitting = [
            info
            for info in self.infos
            if not info.inputs
            and name_words(info.name)[:1]
            and name_words(info.name)[0] in _TELLING
            and (about := {singular(word) for word in name_words(info.name)[1:]} - _OF_READING)
            and about <= said
        ]
        return fitting[0] if len(fitting) == 1 else None

    def by_phrase(self, words: Sequence[str]) -> ActionInfo | None:
        """The one action of which a whole phrase or example is said, fixed words behind a value included."""
        text = " ".join((lemma(words[0]), *words[1:])) if words else ""
        fitting = {
            info.name: info
            for info in self.infos
            for phrase in (*info.phrases, *templates(info))
            if not self._roles[info.name] & _HELPERS and _says(phrase, text, self._only_way(info, words))
        }
        return next(iter(fitting.values())) if len(fitting) == 1 else None

    def _only_way(self, info: ActionInfo, words: Sequence[str]) -> bool:
        """Whether no common task does what an action does: none of its kind, or nothing can be taken."""
        if info in self.of_own_kind:
            return True
        hands = bool(self._roles[info.name] & {"handover", "fetch"}) and self.with_role("grasp") is None
        return hands and not lexicon().operator_pronouns & set(words[1:2])

    @property
    def mover(self) -> ActionInfo | None:
        """The action that brings the robot to a place."""
        movers = self.all_with_role("motion")
        plain_first = sorted(movers, key=lambda info: not _PLAIN_WAYS & set(name_words(info.name)))
        for info in plain_first:
            if text_inputs(info) or pose_inputs(info):
                return info
        return None

    def handed_over(self, info: ActionInfo, name: str) -> ActionInfo | None:
        """The action that provides an input which nobody says in words ("object_id"); None for others."""
        if info.inputs.get(name) is None or not set(name_words(name)[-1:]) & _HANDLES:
            return None
        kind = info.inputs[name]
        return next((i for i in self.infos if i.name != info.name and i.outputs.get(name) == kind), None)

    def chain(
        self, info: ActionInfo, values: Mapping[str, Any], words: str, reason: str = ""
    ) -> list[ActionCall] | None:
        """The step with everything before it that provides what no words give; None if nothing does.

        Args:
            info: The action wanted.
            values: Its inputs that are known.
            words: What the operator calls the thing, for the action that turns words into data.
            reason: Why, for the operator.
        """
        return self._chain(info, values, words, reason, frozenset())

    def _chain(
        self, info: ActionInfo, values: Mapping[str, Any], words: str, reason: str, seen: frozenset[str]
    ) -> list[ActionCall] | None:
        known = dict(values)
        missing = {name: kind for name, kind in info.inputs.items() if name not in known}
        before: list[ActionCall] = []
        while True:
            handed_over = {n: k for n, k in missing.items() if k != "string" or seen}
            if not handed_over or not words:
                break
            provider = self._provider(handed_over, seen | {info.name})
            if provider is None:
                break
            steps = self._chain(provider, {}, words, "", seen | {info.name})
            if steps is None:
                return None
            before += steps
            missing = {n: k for n, k in missing.items() if provider.outputs.get(n) != k}
        texts = [name for name, kind in missing.items() if kind == "string"]
        if (
            texts
            and words
            and not any(kind == "string" for name, kind in info.inputs.items() if name in known)
        ):
            known[texts[0]] = words
            missing.pop(texts[0])
        if any(kind != "string" and name not in info.optional for name, kind in missing.items()):
            return None
        return [*before, call(info, known, reason)]

    def _provider(self, missing: Mapping[str, str], seen: frozenset[str]) -> ActionInfo | None:
        """The action that provides most of what is missing."""

        def provided(info: ActionInfo) -> int:
            return sum(info.outputs.get(name) == kind for name, kind in missing.items())

        usable = [
            info for info in self.infos if info.name not in seen and provided(info) and text_inputs(info)
        ]
        return max(usable, key=provided, default=None)

    def _verb_table(self) -> dict[tuple[str, ...], ActionInfo]:
        """Verbs of actions that the general kinds of tasks do not cover anyway."""
        table: dict[tuple[str, ...], ActionInfo] = {}
        for info in self.infos:
            roles = self._roles[info.name]
            if roles & _HELPERS:
                continue
            for verb in _verbs_of(self.plainly_named(info)):
                found = lexicon().verbs.match(verb)
                kind = found[1].partition(":")[0] if found is not None else ""
                if kind == "motion" and not text_inputs(info):
                    # "go_to_aisle (aisle: number)" goes nowhere else.
                    continue
                if not roles & _COVERED.get(kind, frozenset({kind})):
                    table.setdefault(verb, info)
        return table


_COUNTED_AT_LARGE = frozenset({
    "count", "number", "of", "get", "object", "objects", "thing", "things", "item", "items", "stuff",
})  # fmt: skip
BY_INSTRUMENT = frozenset({"scan", "probe"})
"""What is seen by an instrument, and by nothing else."""
_IN_WORDS = frozenset({"speak", "look", "search", "grasp", "place", "handover", "fetch", "guide", "follow"})
"""What such tasks give to an action is words alone."""
_HANDLES = frozenset(
    {
        "id",
        "ids",
        "handle",
        "ref",
        "pose",
        "uuid",
        "index",
        "token",
        "code",
        "barcode",
        "grasp",
        "ticket",
        "track",
    }
)
"""Last words of names of what only programs know."""
_PLAIN_WAYS = frozenset(
    {"go", "drive", "navigate", "move", "travel", "fly", "walk", "head", "transit", "reach", "ride"}
)
_TELLING = frozenset({"get", "check", "read", "report", "measure", "query", "show", "request", "test"})
_OF_READING = frozenset({"level", "status", "state", "value", "reading", "info", "current", "data", "report"})
_EMPTY = frozenset(load_data("names")["empty"])


def _says(phrase: str, text: str, own: bool) -> bool:
    """Whether the whole text follows a phrase; a value between fixed words must be there.

    Args:
        phrase: Of an action.
        text: What is said.
        own: Whether the action is of a kind of its own, so that words between two values say enough.
    """
    parts = re.split(r"\{\w+\}", phrase.lower())
    if len(parts) < 2 or not parts[0].strip():
        return False
    # Phrases that end with their value are found by their verb.
    if not parts[-1].strip() and not (
        own and all(part.strip() for part in parts[1:-1]) and len(parts) > _TWO
    ):
        return False
    return re.fullmatch("(.+)".join(re.escape(part) for part in parts), text) is not None


_TWO = 2
_HELPERS = frozenset({"locate", "ask_operator"})
"""What only serves other steps is not asked for by verb."""
_COVERED = {
    "transfer": frozenset({"handover", "fetch", "grasp", "transfer"}),
    "look": frozenset({"look", "search"}),
    "whether": frozenset({"look"}),
    "search": frozenset({"look", "search"}),
    "back": frozenset({"motion"}),
    "place": frozenset({"place"}),
    "motion": frozenset({"motion"}),
    "dock": frozenset({"dock"}),
}


def _other_words(info: ActionInfo) -> set[tuple[str, ...]]:
    """Verbs that no list has, for an action of its own kind: of its name's kind, or of its description."""
    found = set(other_verbs(name_words(info.name)))
    told = told_deed(info.description)[:1]
    verb = lemma(told[0]) if told else ""
    verb = singular(verb) if verb == (told or ("",))[0] else verb
    known = lexicon().verbs.match((verb,)) if verb else None
    if verb and known is None and verb not in lexicon().determiners | lexicon().vocabulary | _EMPTY:
        found |= {(verb,), *other_verbs((verb,))}
    return found


def _verbs_of(info: ActionInfo) -> list[tuple[str, ...]]:
    """The words with which an order for an action may begin."""
    verbs: list[tuple[str, ...]] = []
    words = name_words(info.name)
    if words and words[0] not in lexicon().be | lexicon().auxiliaries:
        base = (lemma(words[0]), *words[1:])
        verbs += [
            base[:end]
            for end in range(len(base), 0, -1)
            if end in {1, len(base)} or base[end - 1] in {"for", "to", "at", "up"}
        ]
    for phrase in (*info.phrases, *templates(info)):
        start = tuple(re.findall(r"[a-z']+", phrase.lower().partition("{")[0]))
        if start and start[0] not in lexicon().determiners:
            verbs.append((lemma(start[0]), *start[1:]))
    return verbs
