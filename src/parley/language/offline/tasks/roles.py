"""What an action is good for: from its declared effects, else its name, inputs, phrases and description."""

from __future__ import annotations

import re

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import kind_of, name_words, role_by_any_word
from parley.language.offline.words.text import lemma, singular
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["is_narrow_look", "number_inputs", "parameter_role", "pose_inputs", "roles_of", "text_inputs"]

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
        "reason",
        "issue",
        "problem",
        "complaint",
        "details",
        "comment",
    ],
    "object": ["object", "obj", "item", "thing", "things", "theme", "target", "inspect", "product", "entity"],
}


def parameter_role(name: str) -> str:
    """What kind of words an input takes, by its name: place, person, text, object or empty."""
    words = name_words(name.replace("::", "_"))
    telling = [word for word in words if word not in _VAGUE_NAMES] or words
    for role, known in _PARAMETER_ROLES.items():
        if any(word in known for word in telling):
            return role
    people = lexicon().person_words - _MEANS
    return "person" if any(singular(word) in people for word in telling) else ""


_MEANS = frozenset(load_data("names")["means"])
"""What something is done with: a cleaning agent is nobody."""
_VAGUE_NAMES = frozenset({"name", "id", "to", "what", "description", "text", "string"})
"""Words of a parameter's name that say little beside another: "item_name" is an item."""


def text_inputs(info: ActionInfo) -> list[str]:
    """The inputs that take words."""
    return [name for name, kind in info.inputs.items() if kind_of(kind) == "string"]


def number_inputs(info: ActionInfo) -> list[str]:
    """The inputs that take a number."""
    return [name for name, kind in info.inputs.items() if kind_of(kind) == "number"]


def pose_inputs(info: ActionInfo) -> dict[str, str]:
    """The numeric inputs that together are a place: input -> "x", "y", "z", "yaw"; empty if they are none."""
    found: dict[str, str] = {}
    for name in number_inputs(info):
        leaf = name_words(name.split("::")[-1])
        turned = "orient" in name.lower()
        axis = next((_AXES[word] for word in leaf if word in _AXES), "")
        if turned:
            axis = "yaw" if axis in {"y", "yaw"} else "turn" if axis or leaf else ""
        if axis:
            found[name] = axis
    return found if {"x", "y"} <= set(found.values()) else {}


_AXES = {
    "x": "x", "y": "y", "z": "z", "yaw": "yaw", "theta": "yaw", "heading": "yaw", "th": "yaw", "phi": "yaw",
    "east": "x", "north": "y", "roll": "turn", "pitch": "turn",
}  # fmt: skip


def roles_of(info: ActionInfo) -> frozenset[str]:
    """What an action is good for."""
    lex = lexicon()
    declared = frozenset(lex.effects[effect] for effect in info.effects if effect in lex.effects)
    if declared:
        return declared
    words = name_words(info.name)
    if not words:
        return frozenset()
    if not info.inputs and set(words) & _HOMING and not set(words) & _NOT_HOMING:
        return frozenset({"dock"}) if set(words) <= _GENERIC["dock"] else frozenset()
    numeric = [kind for kind in info.outputs.values() if kind in {"number", "numbers"}]
    if text_inputs(info) and len(numeric) >= 2:
        return frozenset({"locate"})
    others = [word for word in words[1:] if singular(word) in lexicon().person_words and word not in _ASKED]
    asks = bool(text_inputs(info)) or not words[1:] or bool(set(words) & _ASKED)
    if (words[0] == "ask" and asks and not others) or (
        text_inputs(info) == ["question"] and not (_ANSWERING & set(words) or others)
    ):
        return frozenset({"ask_operator"})
    if words[0] == "ask" and others:
        # "ask_visitor" asks nobody else.
        return frozenset()
    if " ".join(words[:2]) in _OWN_PHRASES:
        return frozenset()
    by_name = _by_name(info, words)
    if by_name == frozenset({"ask"}) and not any(
        parameter_role(name) in {"text", "person"} for name in text_inputs(info)
    ):
        # "request_lift" asks nobody anything.
        return frozenset()
    if by_name is not None:
        return _fitting(info, words, by_name)
    told = _by_phrases(info, words)
    if told == {"speak"} and info.outputs:
        # "Tells how many packs are left".
        return frozenset()
    taken = {parameter_role(name) for name in text_inputs(info)}
    if told & _HELD and taken and ("text" in taken or not taken & {"object", ""} or _takes_what_of(info)):
        # "Take the moisture out of the air of a room", "put a label with a text on a box".
        return frozenset()
    return frozenset() if told == {"motion"} and not (text_inputs(info) or pose_inputs(info)) else told


def _takes_what_of(info: ActionInfo) -> bool:
    """Whether a description says that always the same is taken, of what is named ("take a sample of A")."""
    told = [singular(word) for word in re.findall(r"[a-z]+", info.description.lower())]
    typed = {singular(word) for name in info.inputs for word in name_words(name.replace("::", "_"))}
    at = next((i for i, word in enumerate(told) if word in {"of", "from", "off"}), 0)
    return at > _TWO and not typed & set(told[:at]) and bool(typed & set(told[at:]))


_TWO = 2
_OWN_PHRASES = frozenset(load_data("names")["own_phrases"])
_GENERIC: dict[str, frozenset[str]] = {
    role: frozenset(listed) for role, listed in load_data("names")["generic"].items()
}


def _fitting(info: ActionInfo, words: tuple[str, ...], roles: frozenset[str]) -> frozenset[str]:
    """Roles that the whole name and the inputs agree with; "take_order" is a kind of its own."""
    if len(roles) != 1:
        return roles
    role = next(iter(roles))
    inputs = {parameter_role(name) for name in text_inputs(info)}
    if role in {"back", "dock"} and inputs - {"place"}:
        # "return_book (book)"; "dock_trolley (trolley)" is no way to the charger.
        return frozenset()
    if role == "place" and "person" in inputs and "place" not in inputs:
        role = "handover"
    needed = [name for name in text_inputs(info) if name not in info.optional]
    if role == "grasp" and words[0] == "hold" and inputs == {""}:
        # "hold_door (door)" takes nothing away.
        return frozenset()
    if role == "grasp" and len(needed) > 1 and not {w for n in needed for w in name_words(n)} & _SOURCES:
        # "load_oven (oven, item)" ends with the item elsewhere.
        return frozenset()
    if role == "handover" and len(text_inputs(info)) > 1 and "person" not in inputs:
        role = "fetch"
    typed = {word for name in info.inputs for word in name_words(name.replace("::", "_"))}
    if role == "speak" and not _speaks_there(info, words, inputs):
        return frozenset()
    generic = _GENERIC.get(role)
    if generic is None or (role == "motion" and not (inputs or pose_inputs(info))):
        return frozenset({role} if generic is None else ())
    telling = set(words[:1]) if _by_words(words[:1]) else {w for w in words if role_by_any_word(w, inputs)}
    known = generic | typed | telling
    if any(not {word, singular(word)} & known for word in words):
        other = role_by_any_word(info.name, inputs)
        if role in _HANDED and other & _HANDED and not inputs & {"object", ""}:
            # "deliver_mail (recipient)": of all that can be handed over it takes one kind of thing.
            return frozenset()
        return other if other != roles else frozenset()
    if role == "place" and words[0] in _SETTING and not set(words) & _DOWN and "object" not in inputs:
        return frozenset()
    return frozenset({role})


def _speaks_there(info: ActionInfo, words: tuple[str, ...], inputs: set[str]) -> bool:
    """Whether an action says something to those who are there, and does not tell, notify or measure."""
    if (info.outputs and not inputs & {"text", "person"}) or (info.inputs and not inputs):
        # "warning_lights (on)" says nothing.
        return False
    if words[0] not in _FROM_AFAR:
        return True
    named = {singular(word) for word in words[1:]} & (lexicon().person_words | _CREWS)
    if "person" in inputs:
        return len(text_inputs(info)) == 1
    return not named


_COUPLING = frozenset(load_data("names")["coupling"] + load_data("names")["uncoupling"])
_SOURCES = frozenset(
    {"source", "from", "origin", "place", "location", "surface", "arm", "gripper", "hand", "side"}
)
_CREWS = frozenset(load_data("names")["crews"])
_FROM_AFAR = frozenset(
    {"notify", "alert", "warn", "page", "message", "inform", "remind", "text", "email", "send"}
)
"""Speaking to somebody without being there."""
_SETTING = frozenset({"set", "drop", "leave", "store", "release"})
_DOWN = frozenset({"down", "on", "onto", "in", "at", "object", "item"})


def is_narrow_look(info: ActionInfo) -> bool:
    """Whether an action of its own kind looks at one kind of thing ("check_trap (trap)")."""
    found = lexicon().verbs.match(name_words(info.name)[:1])
    return found is not None and found[1].startswith("look:") and len(text_inputs(info)) == 1


def _by_name(info: ActionInfo, words: tuple[str, ...]) -> frozenset[str] | None:
    """What an action is good for by its name; None if that tells nothing."""
    roles = _by_words(words) - (frozenset() if text_inputs(info) else _PHYSICAL)
    by_any = role_by_any_word(info.name, {parameter_role(name) for name in text_inputs(info)})
    if roles == {"locate"} and text_inputs(info) and not info.outputs:
        return frozenset({"search"})
    if by_any == {"follow"} and roles and roles <= {"motion", "wait", "guide"}:
        return by_any
    inputs = (name for name in text_inputs(info) if parameter_role(name) and not name.lower().endswith("id"))
    general = {word for name in inputs for word in name_words(name.replace("::", "_"))}
    if roles & {"look", "search"} and not set(words[1:]) <= _ANY_SIGHT | general:
        # "CheckBattery" looks at one thing only: it is its own kind.
        return by_any & {"search"} if _SOMEBODY & set(words) else frozenset()
    if roles:
        return roles
    first = lexicon().verbs.match((lemma(words[0]), *words[1:]))
    own_kind = first is not None and first[1].startswith("other:")
    return None if own_kind else by_any or None


def _by_phrases(info: ActionInfo, words: tuple[str, ...]) -> frozenset[str]:
    """What an action is good for by its phrases and description, where its name tells nothing."""
    if words[0] in _COUPLING and {parameter_role(name) for name in text_inputs(info)} <= {""}:
        # "detach_cart (cart)" puts nothing else down.
        return frozenset()
    named = lexicon().verbs.match((lemma(words[0]), *words[1:]))
    speaks = _by_words(tuple(re.findall(r"[a-z]+", info.description.lower())[:1])) == {"speak"}
    if speaks and "text" in {parameter_role(name) for name in text_inputs(info)}:
        return frozenset({"speak"})
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


_ASKED = frozenset({"operator", "human", "user", "person", "somebody", "someone", "question", "help"})
_ANSWERING = frozenset({"answer", "reply", "respond", "qa", "take", "handle"})
_SOMEBODY = frozenset({"someone", "somebody", "person", "people", "human", "humans"})
_HOMING = frozenset({"dock", "charger", "charge", "recharge", "charging", "home", "base"})
_NOT_HOMING = frozenset(
    {"undock", "leave", "battery", "status", "get", "check", "is", "set", "light", "lights"}
)
_FETCHING = frozenset(
    {"bring", "fetch", "get", "carry", "deliver", "transport", "supply", "retrieve", "ship"}
)
_HELD = frozenset({"grasp", "place", "fetch"})
"""Roles that need a thing named."""
_HANDED = _HELD | {"handover"}
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
