"""Parsing UMRF JSON: goes on after a problem, so that whoever wrote the graph hears of all at once."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

from parley.errors import GraphRefusedError, InvalidMessageError, Problem
from parley.messages.pvf import SEPARATOR, Parameter, read_parameters
from parley.messages.wire import load_json
from parley.umrf.extras import EXTRAS, KNOWN_KEYS
from parley.umrf.model import (
    DEFAULT_CONDITIONS,
    MAX_MESSAGES,
    ChildRelation,
    Graph,
    GraphState,
    LogMessage,
    Node,
    NodeRef,
    NodeState,
    ParentRelation,
    Response,
    Result,
)

__all__ = ["MAX_ACTIONS", "MAX_INSTANCE_ID", "Reader", "load_object"]

MAX_ACTIONS: Final = 1000
"""How many actions a graph may have: reading and checking so many keeps the loop for some 30 ms."""
MAX_INSTANCE_ID: Final = 65535
MAX_RETRIES: Final = 100

T = TypeVar("T")
S = TypeVar("S", NodeState, GraphState)

_RESULTS: Final = {result.value: result for result in DEFAULT_CONDITIONS}
_RESPONSES: Final = {response.value: response for response in Response}


def load_object(source: str | Mapping[str, Any], what: str) -> Mapping[str, Any]:
    """The JSON object in `source`; an object in memory must be as good as its text.

    Raises:
        GraphRefusedError: It is not JSON, no object, or could not be written back.
    """
    try:
        value = load_json(what, source if isinstance(source, str) else json.dumps(source))
    except InvalidMessageError as error:
        raise _refused(error.problem, f"write the {what} as one JSON object") from error
    except (TypeError, ValueError, RecursionError) as error:
        raise _refused(f"cannot be written as JSON: {error}") from error
    if not isinstance(value, dict):
        raise _refused(f"expected a JSON object, got {_kind(value)}", f"put the {what} into {{...}}")
    return value


def _refused(message: str, remedy: str = "") -> GraphRefusedError:
    return GraphRefusedError("", [Problem("", message, remedy, "malformed")])


class Reader:
    """Collects `problems` while it reads; whatever a problem hides is read as its default."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def graph(self, raw: Mapping[str, Any]) -> Graph | None:
        """A graph (2), short form included; None or wrong in parts if there are problems."""
        name = self._text(raw, "graph_name", "", needed=True)
        actions = self._list(raw, "actions", "", needed=True)
        if len(actions) > MAX_ACTIONS:
            self._problem(
                "actions",
                f"a graph may have {MAX_ACTIONS} actions, not {len(actions)}",
                "make several graphs of it",
                "too_large",
            )
            return None
        nodes: list[Node | None] = []
        for index, item in enumerate(actions):
            node = self.node(item, f"actions[{index}]")
            if node is not None and EXTRAS in item:
                node = self._limited(node, item[EXTRAS], f"actions[{index}].{EXTRAS}")
            nodes.append(node)
        complete = tuple(node for node in nodes if node is not None)
        if len(actions) == 1 and complete and "graph_entry" not in raw and "graph_exit" not in raw:
            entry: tuple[ChildRelation, ...] = (ChildRelation(complete[0].ref),)
            exits: tuple[ParentRelation, ...] = (ParentRelation(complete[0].ref),)
        else:
            entry = self._each(raw, "graph_entry", "", self._child, needed=True)
            exits = self._each(raw, "graph_exit", "", self._parent, needed=True)
        known = {node.ref for node in complete}
        if len(complete) == len(actions):  # otherwise the culprit is named already
            self._check_known(known, [relation.node for relation in entry], "graph_entry")
            self._check_known(known, [relation.node for relation in exits], "graph_exit")
        state = self._state(raw, "graph_state", "", GraphState.UNINITIALIZED)
        description = self._text(raw, "graph_description", "")
        return Graph(name, complete, entry, exits, description, state) if name else None

    def node(self, raw: Any, path: str) -> Node | None:
        """An action node or descriptor (3)."""
        if not isinstance(raw, dict):
            self._problem(path, f"expected an action object, got {_kind(raw)}")
            return None
        name = self._text(raw, "name", path, needed=True)
        kind = self._text(raw, "type", path, needed=True)
        node = Node(
            name=name,
            instance_id=self._instance_id(raw, path),
            type=kind,
            actor=self._text(raw, "actor", path),
            description=self._text(raw, "description", path),
            state=self._state(raw, "state", path, NodeState.UNINITIALIZED),
            input_parameters=self._parameters(raw, "input_parameters", path),
            output_parameters=self._parameters(raw, "output_parameters", path),
            parents=self._each(raw, "parents", path, self._parent),
            children=self._each(raw, "children", path, self._child),
            gui_attributes=raw.get("gui_attributes"),
            messages=self._messages(raw, path),
        )
        return node if name and kind else None

    def _limited(self, node: Node, raw: Any, path: str) -> Node:
        """The node with what we know besides UMRF; what descriptors say at that place is theirs."""
        if not isinstance(raw, Mapping):
            self._problem(path, f"expected an object, got {_kind(raw)}")
            return node
        for key in raw.keys() - KNOWN_KEYS:
            self._problem(f"{path}.{key}", "unknown key", _one_of(KNOWN_KEYS), "unknown_key")
        retries, timeout_s = raw.get("retries", 0), raw.get("timeout_s")
        if type(retries) is not int or not 0 <= retries <= MAX_RETRIES:
            self._problem(
                f"{path}.retries", f"expected a whole number from 0 to {MAX_RETRIES}, got {retries!r}"
            )
            retries = 0
        if timeout_s is not None and (type(timeout_s) not in (int, float) or not 0 < timeout_s < math.inf):
            self._problem(f"{path}.timeout_s", f"expected seconds above 0, got {timeout_s!r}")
            timeout_s = None
        return node._replace(retries=retries, timeout_s=timeout_s)

    def _child(self, raw: Any, path: str) -> ChildRelation | None:
        ref = self._ref(raw, path)
        if ref is None or "remap" not in raw:
            return ChildRelation(ref) if ref is not None else None
        remap: dict[str, str] = {}
        for index, item in enumerate(self._list(raw, "remap", path)):
            where = f"{path}.remap[{index}]"
            if not isinstance(item, dict):
                self._problem(where, f'expected {{"from": .., "to": ..}}, got {_kind(item)}')
                continue
            source, target = (self._text(item, key, where, needed=True) for key in ("from", "to"))
            if source in remap:
                self._problem(f"{where}.from", f"{source!r} is renamed twice", "keep one of the two")
            remap[source] = target
        return ChildRelation(ref, tuple(remap.items()))

    def _parent(self, raw: Any, path: str) -> ParentRelation | None:
        ref = self._ref(raw, path)
        if ref is None:
            return None
        required = raw.get("required", True)
        if not isinstance(required, bool):
            self._problem(_join(path, "required"), f"expected true or false, got {_kind(required)}")
            required = True
        if "conditions" not in raw:
            return ParentRelation(ref, required)
        conditions: dict[Result, Response] = {}
        for index, item in enumerate(self._list(raw, "conditions", path)):
            conditions |= self._condition(item, f"{path}.conditions[{index}]")
        return ParentRelation(ref, required, conditions)

    def _condition(self, raw: Any, path: str) -> dict[Result, Response]:
        if not isinstance(raw, str):
            self._problem(path, f'expected a text like "on_true -> run", got {_kind(raw)}')
            return {}
        words = "".join(raw.split()).split("->")
        if len(words) != 2:
            self._problem(path, f"cannot read {raw!r}", 'write it like "on_true -> run"')
            return {}
        result, response = _RESULTS.get(words[0]), _RESPONSES.get(words[1])
        if result is None:
            self._problem(path, f"unknown precondition {words[0]!r}", _one_of(_RESULTS), "unknown_word")
        if response is None:
            self._problem(path, f"unknown response {words[1]!r}", _one_of(_RESPONSES), "unknown_word")
        return {result: response} if result is not None and response is not None else {}

    def _ref(self, raw: Any, path: str) -> NodeRef | None:
        if not isinstance(raw, dict):
            self._problem(path, f"expected an object with name and instance_id, got {_kind(raw)}")
            return None
        name = self._text(raw, "name", path, needed=True)
        return NodeRef(name, self._instance_id(raw, path)) if name else None

    def _instance_id(self, raw: Mapping[str, Any], path: str) -> int:
        value = raw.get("instance_id", 0)
        if type(value) is int and 0 <= value <= MAX_INSTANCE_ID:
            return value
        whole = type(value) is float and value.is_integer()
        if not whole or not 0 <= value <= MAX_INSTANCE_ID:
            self._problem(
                _join(path, "instance_id"),
                f"expected a whole number from 0 to {MAX_INSTANCE_ID}, got {value!r}",
            )
            return 0
        return int(value)

    def _parameters(self, raw: Mapping[str, Any], key: str, path: str) -> dict[str, Parameter]:
        flat: dict[str, Parameter] = {}
        if key in raw:
            self._level(raw[key], "", _join(path, key), flat)
        for name in flat:
            level, _, _ = name.rpartition(SEPARATOR)
            if level in flat:
                self._problem(_join(path, key), f"{level!r} is both a parameter and a name level")
        return flat

    def _level(self, raw: Any, name: str, path: str, flat: dict[str, Parameter]) -> None:
        """One level of a parameter tree; leaves are read one by one, so that each can have its problem."""
        if not isinstance(raw, Mapping):
            self._problem(path, f"expected an object with pvf_type or a name level, got {_kind(raw)}")
            return
        for key, child in raw.items():
            inner, where = f"{name}{SEPARATOR}{key}" if name else str(key), f"{path}.{key}"
            if isinstance(child, Mapping) and "pvf_type" not in child:
                self._level(child, inner, where, flat)
                continue
            try:
                parameter = read_parameters({key: child}, path)[str(key)]
            except InvalidMessageError as error:
                self._problem(error.path, error.problem, "leave the key out if there is no value yet")
                continue
            if inner in flat:
                self._problem(where, f"the parameter {inner!r} is given twice", "keep one of the two")
            flat[inner] = parameter

    def _messages(self, raw: Mapping[str, Any], path: str) -> tuple[LogMessage, ...]:
        if "runtime" not in raw:
            return ()
        where = _join(path, "runtime")
        if not isinstance(raw["runtime"], Mapping):
            self._problem(where, f"expected an object, got {_kind(raw['runtime'])}")
            return ()
        found: list[LogMessage] = []
        for index, item in enumerate(self._list(raw["runtime"], "messages", where, needed=True)):
            if (
                isinstance(item, Mapping)
                and isinstance(item.get("timestamp"), int)
                and isinstance(item.get("message"), str)
            ):
                found.append(LogMessage(item["timestamp"], item["message"]))
            else:
                self._problem(
                    f"{where}.messages[{index}]", 'expected {"timestamp": <integer>, "message": <string>}'
                )
        return tuple(sorted(found, key=lambda message: message.timestamp)[-MAX_MESSAGES:])

    def _check_known(self, known: set[NodeRef], refs: list[NodeRef], key: str) -> None:
        for index, ref in enumerate(refs):
            if ref not in known:
                self._problem(
                    f"{key}[{index}]", f"{ref.full_name} is not among the actions", "", "missing_node"
                )

    def _text(self, raw: Mapping[str, Any], key: str, path: str, *, needed: bool = False) -> str:
        value = raw.get(key, "")
        if isinstance(value, str) and (value or not needed):
            return value
        if value == "":
            self._problem(_join(path, key), "is missing or empty", f"give {key} a text", "missing")
        else:
            self._problem(_join(path, key), f"expected a string, got {_kind(value)}")
        return ""

    def _list(self, raw: Mapping[str, Any], key: str, path: str, *, needed: bool = False) -> list[Any]:
        if key not in raw:
            if needed:
                self._problem(_join(path, key), "is missing", "give an array; it may be empty", "missing")
            return []
        value = raw[key]
        if not isinstance(value, list):
            self._problem(_join(path, key), f"expected an array, got {_kind(value)}")
            return []
        return value

    def _each(
        self,
        raw: Mapping[str, Any],
        key: str,
        path: str,
        read: Callable[[Any, str], T | None],
        *,
        needed: bool = False,
    ) -> tuple[T, ...]:
        items = self._list(raw, key, path, needed=needed)
        if not items:
            return ()
        where = _join(path, key)
        found = [read(item, f"{where}[{index}]") for index, item in enumerate(items)]
        return tuple([item for item in found if item is not None])

    def _state(self, raw: Mapping[str, Any], key: str, path: str, default: S) -> S:
        if key not in raw:
            return default
        value = raw[key]
        try:
            return type(default)(value)
        except ValueError:
            self._problem(
                _join(path, key), f"unknown state {value!r}", _one_of(type(default)), "unknown_word"
            )
            return default

    def _problem(self, path: str, message: str, remedy: str = "", code: str = "malformed") -> None:
        self.problems.append(Problem(path, message, remedy, code))


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _one_of(words: Any) -> str:
    return f"use one of {', '.join(sorted(words))}"


def _kind(value: Any) -> str:
    names = {bool: "a boolean", int: "a number", float: "a number", str: "a string", list: "an array"}
    return "null" if value is None else names.get(type(value), "an object")
