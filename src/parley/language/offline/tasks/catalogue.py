"""What a robot can do, read from its own catalogue: roles of actions, values for their parameters, chains.

Nothing here knows an action by name. What an action is good for follows from its declared effects, else from
the words of its name, phrases and description; an input that nobody says in words is fetched from the action
whose outputs carry exactly that name and type.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import role_by_any_word
from parley.language.offline.words.text import lemma, singular, split_name
from parley.language.word_lists import load_data
from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo

__all__ = ["Catalogue", "call", "parameter_role", "roles_of", "templates", "text_inputs"]

_PARAMETER_ROLES = {
    "place": [
        "target",
        "location",
        "place",
        "destination",
        "goal",
        "position",
        "where",
        "room",
        "area",
        "waypoint",
        "spot",
        "point",
        "loc",
        "dest",
        "surface",
        "zone",
        "hall",
        "station",
        "receptacle",
        "site",
    ],
    "person": [
        "person",
        "who",
        "name",
        "recipient",
        "human",
        "people",
        "user",
        "patient",
        "to",
        "receiver",
        "whom",
    ],
    "text": [
        "text",
        "message",
        "utterance",
        "sentence",
        "speech",
        "question",
        "answer",
        "words",
        "content",
        "say",
        "what",
        "query",
        "prompt",
        "topic",
    ],
    "object": ["object", "obj", "item", "thing", "things", "theme", "target", "inspect", "product", "entity"],
}


def parameter_role(name: str) -> str:
    """What kind of words an input takes, by its name: place, person, text, object or empty."""
    words = split_name(name.replace("::", "_"))
    telling = [word for word in words if word not in _VAGUE_NAMES] or words
    for role, known in _PARAMETER_ROLES.items():
        if any(word in known for word in telling):
            return role
    return "person" if any(singular(word) in lexicon().person_words for word in telling) else ""


_VAGUE_NAMES = frozenset({"name", "id", "to", "what", "description", "text", "string"})
"""Words of a parameter's name that say little beside another: "item_name" is an item."""


def text_inputs(info: ActionInfo) -> list[str]:
    """The inputs that take words."""
    return [name for name, kind in info.inputs.items() if kind == "string"]


def roles_of(info: ActionInfo) -> frozenset[str]:
    """What an action is good for."""
    lex = lexicon()
    declared = frozenset(lex.effects[effect] for effect in info.effects if effect in lex.effects)
    if declared:
        return declared
    words = split_name(info.name)
    if not words:
        return frozenset()
    if not info.inputs and set(words) & _HOMING and not set(words) & _NOT_HOMING:
        return frozenset({"dock"})
    numeric = [kind for kind in info.outputs.values() if kind in {"number", "numbers"}]
    if text_inputs(info) and len(numeric) >= 2:
        return frozenset({"locate"})
    if words[0] == "ask" or (text_inputs(info) == ["question"] and not _ANSWERING & set(words)):
        return frozenset({"ask_operator"})
    by_name = _by_name(info, words)
    return _by_phrases(info, words) if by_name is None else by_name


def _by_name(info: ActionInfo, words: tuple[str, ...]) -> frozenset[str] | None:
    """What an action is good for by its name; None if that tells nothing."""
    roles = _by_words(words) - (frozenset() if text_inputs(info) else _PHYSICAL)
    typed = {word for name in info.inputs for word in split_name(name.replace("::", "_"))}
    by_any = role_by_any_word(info.name, {parameter_role(name) for name in text_inputs(info)})
    if roles == {"locate"} and text_inputs(info) and not info.outputs:
        return frozenset({"search"})
    if by_any == {"follow"} and roles and roles <= {"motion", "wait", "guide"}:
        return by_any
    if roles & {"look", "search"} and not set(words[1:]) <= _ANY_SIGHT | typed:
        # "CheckBattery" looks at one thing only: it is its own kind.
        return by_any & {"search"} if _SOMEBODY & set(words) else frozenset()
    if roles:
        return roles
    first = lexicon().verbs.match((lemma(words[0]), *words[1:]))
    own_kind = first is not None and first[1].startswith("other:")
    return None if own_kind else by_any or None


def _by_phrases(info: ActionInfo, words: tuple[str, ...]) -> frozenset[str]:
    """What an action is good for by its phrases and description, where its name tells nothing."""
    named = lexicon().verbs.match((lemma(words[0]), *words[1:]))
    if named is not None and named[1].startswith("other:"):
        # Its own name says what it does; a phrase such as "put on {song}" must not make it another thing.
        return frozenset()
    phrase_words = [re.split(r"[^a-z]+", phrase.lower()) for phrase in info.phrases]
    described = re.findall(r"[a-z]+", info.description.lower())[:3]
    for candidate in (*phrase_words, described):
        roles = _by_words(tuple(word for word in candidate if word))
        roles -= frozenset() if text_inputs(info) else _PHYSICAL
        if roles:
            return roles
    return frozenset()


_ANSWERING = frozenset({"answer", "reply", "respond", "qa", "take", "handle"})
_SOMEBODY = frozenset({"someone", "somebody", "person", "people", "human", "humans"})
_HOMING = frozenset({"dock", "charger", "charge", "recharge", "charging", "home", "base"})
_NOT_HOMING = frozenset(
    {"undock", "leave", "battery", "status", "get", "check", "is", "set", "light", "lights"}
)
_FETCHING = frozenset(
    {"bring", "fetch", "get", "carry", "deliver", "transport", "supply", "retrieve", "ship"}
)
_PHYSICAL = frozenset({"place", "fetch"})
"""Roles that need something named: without an input for it, "set" or "release" mean something else."""


_ANY_SIGHT = frozenset(load_data("names")["any_sight"])
_TAKING = frozenset({"take", "capture", "snap", "get", "make", "shoot", "grab", "send"})
_PICTURES = frozenset({"photo", "picture", "image", "photograph", "snapshot", "pic"})


def _by_words(words: tuple[str, ...]) -> frozenset[str]:
    lex = lexicon()
    if not words:
        return frozenset()
    base = (lemma(words[0]), *words[1:])
    if base[0] in _TAKING and set(base[1:]) & _PICTURES:
        return frozenset({"look"})
    found = lex.verbs.match(base)
    kind = "" if found is None or found[1].startswith("other:") else found[1].partition(":")[0]
    if found is not None and kind and found[0] > 1:
        return frozenset({_transferring(base[0]) if kind == "transfer" else kind})
    if base[0] in lex.action_words:
        return frozenset({lex.action_words[base[0]]})
    if kind:
        return frozenset({_transferring(base[0]) if kind == "transfer" else kind})
    return frozenset()


def _transferring(verb: str) -> str:
    """Getting something on board, bringing it from elsewhere, or handing it over."""
    return "grasp" if verb in {"take", "grab"} else "fetch" if verb in _FETCHING else "handover"


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


def call(info: ActionInfo, values: Mapping[str, Any], reason: str = "") -> ActionCall:
    """One step: given values written in, everything that is handed over left without value."""
    return ActionCall(
        name=info.name,
        input_parameters={name: Parameter(kind, values.get(name)) for name, kind in info.inputs.items()},
        output_parameters={name: Parameter(kind) for name, kind in info.outputs.items()},
        reason=reason,
    )


class Catalogue:
    """The actions of one robot."""

    def __init__(self, infos: Sequence[ActionInfo]) -> None:
        self.infos = tuple(infos)
        self._roles = {info.name: roles_of(info) for info in infos}
        self._table = self._verb_table()
        self.verbs = tuple(sorted(self._table, key=len, reverse=True))
        """First words by which actions of no common role can be asked for."""

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

    def by_topic(self, words: Sequence[str]) -> ActionInfo | None:
        """The one action of no common kind whose name is about what is said ("turn the volume up")."""
        said = {singular(lemma(word)) for word in words} | {singular(word) for word in words}
        fitting = [
            info
            for info in self.infos
            if not self._roles[info.name]
            and len(split_name(info.name)) > 1
            and {singular(word) for word in split_name(info.name)[1:]} <= said
        ]
        return fitting[0] if len(fitting) == 1 else None

    def reading(self, words: Sequence[str]) -> ActionInfo | None:
        """The one action without inputs that tells what is asked about ("get_battery_level": the battery)."""
        said = {singular(word) for word in words}
        fitting = [
            info
            for info in self.infos
            if not info.inputs
            and split_name(info.name)[:1]
            and split_name(info.name)[0] in _TELLING
            and (about := {singular(word) for word in split_name(info.name)[1:]} - _OF_READING)
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
            if not self._roles[info.name] & _HELPERS and _says(phrase, text)
        }
        return next(iter(fitting.values())) if len(fitting) == 1 else None

    def by_description(self, words: Sequence[str]) -> ActionInfo | None:
        """The one action whose description shares most with what is said: its verb, or at least two words."""
        if not words:
            return None
        said = {singular(lemma(word)) for word in words} | {singular(word) for word in words}
        verb = lemma(words[0])
        scored: list[tuple[int, ActionInfo]] = []
        for info in self.infos:
            text = [
                *split_name(info.name),
                *re.findall(r"[a-z]+", f"{info.description} {' '.join(info.examples)}".lower()),
            ]
            about = {singular(lemma(word)) for word in text} - _EMPTY
            verbs = {other for word in (verb,) for other in (word, *lexicon().synonyms.get(word, ()))}
            shared = len(about & said - _EMPTY - {verb})
            same_verb = bool(verbs & about)
            if (same_verb and shared) or shared > 1:
                scored.append((shared + 2 * same_verb, info))
        best = max((score for score, _ in scored), default=0)
        fitting = [info for score, info in scored if score == best]
        return fitting[0] if len(fitting) == 1 and not self._roles[fitting[0].name] & _HELPERS else None

    @property
    def mover(self) -> ActionInfo | None:
        """The action that brings the robot to a place."""
        for info in self.all_with_role("motion"):
            if text_inputs(info) or self.chain(info, {}, "?") is not None:
                return info
        return None

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
            for verb in _verbs_of(info):
                found = lexicon().verbs.match(verb)
                kind = found[1].partition(":")[0] if found is not None else ""
                if not roles & _COVERED.get(kind, frozenset({kind})):
                    table.setdefault(verb, info)
        return table


_TELLING = frozenset({"get", "check", "read", "report", "measure", "query", "show", "request", "test"})
_OF_READING = frozenset({"level", "status", "state", "value", "reading", "info", "current", "data", "report"})
_EMPTY = frozenset(load_data("names")["empty"])


def _says(phrase: str, text: str) -> bool:
    """Whether the whole text follows a phrase; a value between fixed words must be there."""
    parts = re.split(r"\{\w+\}", phrase.lower())
    if len(parts) < 2 or not parts[0].strip():
        return False
    # Phrases that end with their value are found by their verb.
    if not parts[-1].strip():
        return False
    return re.fullmatch("(.+)".join(re.escape(part) for part in parts), text) is not None


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


def _verbs_of(info: ActionInfo) -> list[tuple[str, ...]]:
    """The words with which an order for an action may begin."""
    verbs: list[tuple[str, ...]] = []
    words = split_name(info.name)
    if words:
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
