"""The form of an answer, made from what there is: actions with their parameters, things, robots, labels.

It is what a model is held to, by itself or by its server; whatever comes back is read and checked all the
same (`answers`, `reading`). Everything in it can be asked for strictly: all fields are named, none may be
added. It changes only with catalogue, map and crew, so that providers can keep it from one question to the
next.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, get_args

from parley.language.llm.answers import ReplyAnswer
from parley.language.prompts import Kind
from parley.language.prompts.labels import MEMORIES, STEPS
from parley.messages.status import ActionInfo
from parley.umrf.kinds import parameters_of

__all__ = ["Form", "Known", "form_of"]

Form = dict[str, Any]
"""A JSON schema."""

_MOST_THINGS: Final = 60
"""Of more, ids are not listed in the form: providers allow some 1000 choices in all."""
_NAME: Final = re.compile(r"[\w .,:'()/-]{1,60}")
_MOST_WORDS: Final = 6
_KEY: Final = re.compile(r"[A-Za-z0-9_.-]{1,64}")
_TEXT: Final[Form] = {"type": "string"}
_TYPES: Final[Mapping[str, Form]] = {
    "string": _TEXT,
    "number": {"type": "number"},
    "bool": {"type": "boolean"},
    "strings": {"type": "array", "items": {"type": "string"}},
    "numbers": {"type": "array", "items": {"type": "number"}},
    "bools": {"type": "array", "items": {"type": "boolean"}},
}


@dataclass(frozen=True, slots=True)
class Known:
    """What answers to one question can be about."""

    kind: Kind
    catalogue: tuple[ActionInfo, ...] = ()
    robot: str = ""
    robots: tuple[str, ...] = ()
    things: tuple[str, ...] = ()
    """Ids."""
    choices: tuple[str, ...] = ()
    """What was offered."""
    rules: int = 0
    """How many rules a picture is looked at with."""

    def __hash__(self) -> int:
        names = tuple(info.name for info in self.catalogue)
        return hash((self.kind, names, self.robot, self.robots, self.things, self.choices, self.rules))


def form_of(known: Known) -> Form:
    """The form of the answer to a question."""
    match known.kind:
        case "interpret":
            return _object(_plan(known))
        case "resolve":
            return _object(_resolution(known))
        case "select_memories":
            return _object({"names": _list(_one_of(MEMORIES))})
        case "ground":
            outcome = _one_of(("match", "ambiguous", "none"))
            return _object({"outcome": outcome, "ids": _list(_ids(known))})
        case "inspect":
            return _object(_report(known))
        case "read_reply":
            kinds = get_args(ReplyAnswer.model_fields["kind"].annotation)
            fields: dict[str, Form] = {"kind": _one_of(kinds)}
            closed = known.choices == _short(known.choices)
            choice = _one_of(known.choices) if closed else _TEXT
            return _object(fields | ({"choice": _or_none(choice)} if known.choices else {}))


def _plan(known: Known) -> dict[str, Form]:
    fields: dict[str, Form] = {"message_response": _TEXT | {"description": "The reply, in plain words."}}
    if known.catalogue:
        fields["queue"] = _list(_step(known))
    fields["system_cmd"] = _list(_command())
    if len(robots := _short(known.robots)) > 1:
        fields["targets"] = _list(_one_of(robots)) | {"description": "Only if another robot is meant."}
    fields["choices"] = _list(_TEXT) | {"description": "Answers to offer, for a question."}
    fields["sources"] = _list(_one_of(MEMORIES)) | {"description": "Memories relied on."}
    return fields


def _resolution(known: Known) -> dict[str, Form]:
    fields = _plan(known)
    fields.pop("targets", None)
    more: dict[str, Form] = {
        "success": {"anyOf": [{"type": "boolean"}, {"type": "null"}],
                    "description": "true: it goes on with this; false: the message asks; null: said aside."},
        "delay_s": {"type": "number", "description": "Seconds to wait before it goes on; 0: none."},
    }  # fmt: skip
    if known.catalogue:
        more["afterwards"] = _list(_step(known)) | {"description": "Ordered besides, for behind the rest."}
    return {"message_response": fields.pop("message_response"), **more, **fields}


def _report(known: Known) -> dict[str, Form]:
    fields: dict[str, Form] = {
        "text": _TEXT,
        "found": _or_none({"type": "boolean"}),
        "wanted": _TEXT,
        "unwanted": {"type": "boolean", "description": "It is looked for, and should not be there."},
        "attention": {"type": "boolean"},
        "things": _list(_TEXT) | {"description": "What of it is there, as the detector calls it."},
    }
    rules = tuple(f"r{number}" for number in range(1, known.rules + 1))
    return fields | (
        {"rules": _list(_one_of(rules)) | {"description": "Those that apply now."}} if rules else {}
    )


# -- steps and commands ------------------------------------------------------------------------------


def _step(known: Known) -> Form:
    return {"anyOf": [_action(info, known) for info in known.catalogue]}


def _action(info: ActionInfo, known: Known) -> Form:
    given = {
        name for other in known.catalogue if other.name != info.name
        for name, kind in other.outputs.items() if info.inputs.get(name) == kind
    }  # fmt: skip
    free = given | set(info.optional)
    fields: dict[str, Form] = {
        "action": _one_of((info.name,)),
        "parameters": _tree(_said(info), free, _values(info, known)),
        "reason": _TEXT | {"description": "Why, in a few plain words for the operator."},
        "only_if": _or_none(_object({"step": {"type": "integer"}, "result": {"type": "boolean"}})),
        "together_with": _or_none({"type": "integer"}),
        "repeat": _or_none({"type": "integer"}),
    }
    if others := tuple(name for name in _short(known.robots) if name != known.robot):
        fields["robot"] = _or_none(_one_of(others))
    return _object(fields)


def _said(info: ActionInfo) -> dict[str, str]:
    """The inputs that anybody could give; what programs know something by is none."""
    told = parameters_of(info)
    return {name: kind for name, kind in info.inputs.items() if told[name].kind != "id"}


def _values(info: ActionInfo, known: Known) -> dict[str, Form]:
    """What each parameter takes: a choice of a closed list, a thing by its id, or what its type says."""
    forms: dict[str, Form] = {}
    for name, about in parameters_of(info).items():
        form = _TYPES.get(info.inputs[name], {"type": "null"})
        closed = info.parameters[name].choices if name in info.parameters else ()
        if form is _TEXT and closed and all(map(_is_short, closed)):
            form = _one_of(closed)
        elif form is _TEXT and about.kind in ("place", "thing") and (ids := _ids(known)) is not _TEXT:
            one = ids | {"description": "Just this thing of the map, by its id."}
            form = {"anyOf": [one, _TEXT | {"description": "Or words."}]}
        unit = about.unit if _is_short(about.unit) else ""
        forms[name] = form | ({"description": f"In {unit}."} if unit and "anyOf" not in form else {})
    return forms


def _tree(inputs: Mapping[str, str], free: set[str], forms: Mapping[str, Form]) -> Form:
    """Parameters by the levels of their names: keys with colons are refused by some providers."""
    levels: dict[str, dict[str, str]] = {}
    fields: dict[str, Form] = {}
    for name, kind in inputs.items():
        head, colons, rest = name.partition("::")
        if not _KEY.fullmatch(head):
            return {"type": "object"}
        if colons:
            levels.setdefault(head, {})[rest] = kind
        else:
            form = forms[name]
            fields[name] = _or_none(form) if name in free and kind in _TYPES else form
    for head, inside in levels.items():
        below = {name.partition("::")[2] for name in free if name.partition("::")[0] == head}
        deeper = {name: forms[f"{head}::{name}"] for name in inside}
        whole = set(inside) <= below
        fields[head] = _or_none(_tree(inside, set(), deeper)) if whole else _tree(inside, below, deeper)
    return _object(fields)


def _command() -> Form:
    def of(names: Sequence[str], **fields: Form) -> Form:
        return _object({"command": _one_of(names), **fields})

    return {
        "anyOf": [
            of(("stop", "start", "skip", "clear")),
            of(("pop",), step=_one_of(STEPS)),
            of(("add_memory",), name=_TEXT, data=_TEXT, info=_TEXT),
            of(("remove_memory",), name=_one_of(MEMORIES)),
        ]
    }


# -- parts ---------------------------------------------------------------------------------------------


def _object(fields: Mapping[str, Form]) -> Form:
    return {
        "type": "object", "properties": dict(fields), "required": list(fields), "additionalProperties": False,
    }  # fmt: skip


def _list(items: Form) -> Form:
    return {"type": "array", "items": items}


def _one_of(names: Sequence[str]) -> Form:
    return {"type": "string", "enum": list(names)}


def _or_none(form: Form) -> Form:
    return {"anyOf": [form, {"type": "null"}]}


def _ids(known: Known) -> Form:
    fits = 0 < len(known.things) <= _MOST_THINGS and known.things == _short(known.things)
    return _one_of(known.things) if fits else _TEXT


def _short(names: Sequence[str]) -> tuple[str, ...]:
    return tuple(name for name in names if _is_short(name))


def _is_short(name: str) -> bool:
    """Whether a name that anybody gave is only a name: no sentence gets in where orders are believed."""
    return bool(_NAME.fullmatch(name)) and len(name.split()) <= _MOST_WORDS
