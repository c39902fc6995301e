"""Reads the second set of situations and says what is wrong with an answer (design section 5).

A case names a world, what is said (`say`) and, where it matters, `history`, `queue`, `status` and `robot`.
What is right: `do` (the plan in short), `final` (what is pending once commands and plan have been applied),
`commands`, `remember` (words of each new memory), `forget`, `says` (alternatives joined by ``|``), `asks`,
`choices`, `targets`. `do_any` and `final_any` list several right plans; `any_order`, `any_do` and
`any_commands` leave open what their names say.

A step in short: ``go X``, ``look X``, ``ask``, ``locate X``, ``driving`` (NavigateTo with values of an
earlier step), ``back`` (NavigateTo to numbers), ``Name(arg, arg)``; ``~`` behind the verb makes it optional,
``if 2:`` and ``unless 2:`` before it condition it. X is an object's id or words, with ``|`` between
alternatives.
"""

from __future__ import annotations

import hashlib
import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import yaml

from parley.language.base import ErrorSituation, Situation
from parley.language.situations import read_situation
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject
from tests.language.dev_set import CATALOGUES, DATA, POSE

TOOLS = (
    ActionInfo(name="DriveTo", inputs={"location": "string"}, description="Drive to a place."),
    ActionInfo(name="Wait", inputs={"duration_s": "number"}, description="Wait for some seconds."),
    ActionInfo(name="TightenValve", inputs={"valve": "string"}, description="Tighten a valve."),
    ActionInfo(name="OpenGripper", description="Open the gripper."),
    ActionInfo(
        name="set_volume",
        inputs={"percent": "number"},
        phrases=("set the volume to {percent}", "turn the volume to {percent}"),
    ),
    ActionInfo(
        name="paint", inputs={"object": "string", "colour": "string"}, phrases=("paint {object} {colour}",)
    ),
    ActionInfo(name="BlinkLights", inputs={"times": "number"}, phrases=("blink the lights {times} times",)),
    ActionInfo(
        name="MeasureTemperature",
        inputs={"location": "string"},
        description="Measure the temperature of a place.",
    ),
)
"""Actions that nothing in the engine can know."""

_SHORT = re.compile(r"(?:(?P<flow>if|unless) (?P<of>\d+): )?(?P<verb>\w+)(?P<optional>~)? ?(?P<rest>.*)$")
_NOTHING = ("", "the", "a", "an")


@dataclass(frozen=True)
class Case:
    """One situation and what should come of it."""

    phenomenon: str
    body: dict[str, Any]
    world: dict[str, Any]

    @property
    def id(self) -> str:
        """What tells this case from all others."""
        parts = (self.phenomenon, self.body["say"], self.body.get("robot", ""), self.body.get("code", ""))
        return ": ".join(part for part in parts if part.strip())

    @property
    def held_out(self) -> bool:
        """Whether it belongs to the half whose failures nobody looks at."""
        return hashlib.sha256(self.id.encode()).digest()[0] % 2 == 1

    @property
    def situation(self) -> Situation | ErrorSituation:
        """The situation as a line of `parley interpret` would give it."""
        return read_situation(self.line, _catalogue(self.world))

    @property
    def line(self) -> dict[str, Any]:
        """The JSON object of design section 5."""
        body, world = self.body, self.world
        x, y, yaw = world["pose"]
        common: dict[str, Any] = {
            "memory": [{"name": name, "data": data} for name, data in world["memory"]],
            "objects": [
                dict(zip(("id", "description", "x", "y", "class", "width", "height"), o, strict=False))
                for o in world["objects"]
            ],
            "robot_pose": {"x": x, "y": y, "yaw": yaw},
            "robot": body.get("robot", world["robot"]),
        }
        if "failed" in body:
            return common | {
                "kind": "error",
                "error_message": body["error"],
                "code": body["code"],
                "details": body.get("details", {}),
                "failed_action": _calls(body["failed"], world)[0],
                "pending": _calls(body.get("pending", []), world),
                "reply": body.get("reply"),
            }
        return common | {
            "message": body["say"],
            "history": [
                {"role": role, "content": text}
                for role, text in zip(
                    itertools.cycle(("operator", "assistant")), body.get("history", []), strict=False
                )
            ],
            "queue": _calls(body.get("queue", []), world),
            "status": body.get("status", "idle"),
            "robots": world["robots"],
        }


def cases(name: str = "second_set") -> list[Case]:
    """All of a set."""
    read = _data(name)
    worlds = read["worlds"]
    for world in worlds.values():
        world.update({**worlds.get(world.get("like"), {}), **world})
    return [
        Case(phenomenon, body, worlds[body["in"]])
        for phenomenon, listed in read["cases"].items()
        for body in listed
    ]


@cache
def _data(name: str) -> dict[str, Any]:
    read: dict[str, Any] = yaml.safe_load((DATA / f"{name}.yaml").read_text(encoding="utf-8"))
    return read


def _catalogue(world: dict[str, Any]) -> tuple[ActionInfo, ...]:
    named = world["catalogue"]
    if isinstance(named, list):
        return tuple(ActionInfo.model_validate(action) for action in named)
    return TOOLS if named == "tools" else CATALOGUES[named]


def _calls(short: Sequence[str], world: dict[str, Any]) -> list[dict[str, Any]]:
    """The actions of a queue given in short."""
    calls: list[dict[str, Any]] = []
    for text in short:
        verb, _, rest = text.partition(" ")
        if verb in {"go", "locate"}:
            target = _description(rest, world)
            calls.append({"GetCoordinates": {"input_parameters": _text("target", target)}})
        if verb in {"go", "driving"}:
            unset = {name: {"pvf_type": kind} for name, kind in POSE.items()}
            calls.append({"NavigateTo": {"input_parameters": unset}})
        if verb == "look":
            calls.append({"Inspect": {"input_parameters": _text("inspect", rest)}})
    return calls


def _text(name: str, value: str) -> dict[str, Any]:
    return {name: {"pvf_type": "string", "pvf_value": value}}


def _description(identifier: str, world: dict[str, Any]) -> str:
    return next((str(listed[1]) for listed in world["objects"] if listed[0] == identifier), identifier)


@dataclass(frozen=True)
class Step:
    """One step of an answer in short."""

    verb: str
    arguments: tuple[str, ...] = ()
    flow: str = ""


def steps(queue: Sequence[ActionCall]) -> list[Step]:
    """A queue in short."""
    found: list[Step] = []
    for call in queue:
        flow = ""
        if call.flow is not None and call.flow.if_ is not None:
            flow = f"{'if' if call.flow.if_.result else 'unless'} {call.flow.if_.step}"
        values = tuple(str(p.value) for p in call.input_parameters.values() if p.has_data)
        if call.name == "NavigateTo" and not values and found and found[-1].verb == "locate":
            found[-1] = Step("go", found[-1].arguments, found[-1].flow)
        elif call.name == "NavigateTo":
            found.append(Step("back" if values else "driving", (), flow))
        else:
            verb = {"GetCoordinates": "locate", "Inspect": "look", "AskOperator": "ask"}.get(
                call.name, call.name
            )
            found.append(Step(verb, values, flow))
    return found


def pending(queue: Sequence[ActionCall], action: ChatAction) -> list[ActionCall]:
    """What is pending once the commands and the plan of an answer have been applied."""
    left = list(queue)
    pops = [c.pop_index for c in action.system_cmd if c.command == "pop"]
    for index in sorted((i for i in pops if i is not None), reverse=True):
        del left[index : index + 1]
    if any(c.command == "clear" for c in action.system_cmd):
        left = []
    return [*left, *action.queue]


def _fits(expected: Sequence[str], got: Sequence[Step], objects: Sequence[MapObject]) -> bool:
    if not expected:
        return not got
    read = _SHORT.match(expected[0])
    assert read is not None, expected[0]
    if got and _step_fits(read, got[0], objects) and _fits(expected[1:], got[1:], objects):
        return True
    return bool(read["optional"]) and _fits(expected[1:], got, objects)


def _step_fits(read: re.Match[str], got: Step, objects: Sequence[MapObject]) -> bool:
    flow = f"{read['flow']} {read['of']}" if read["flow"] else ""
    if read["verb"] != got.verb or flow != got.flow:
        return False
    rest = read["rest"]
    if got.verb == "look":
        return _all_in(rest, " ".join(got.arguments), objects)
    if got.verb == "ask":
        return True
    arguments = [part.strip() for part in rest.strip("()").split(",")] if rest.startswith("(") else [rest]
    arguments = [part for part in arguments if part]
    return len(arguments) == len(got.arguments) and all(
        _names(wanted, value, objects) for wanted, value in zip(arguments, got.arguments, strict=True)
    )


def _words(text: str) -> set[str]:
    return {word for word in re.split(r"[^\w']+|'s\b", text.casefold()) if word not in _NOTHING}


def _all_in(wanted: str, text: str, objects: Sequence[MapObject]) -> bool:
    """Whether all words (or one of their alternatives) are in a text."""
    lowered = text.casefold().replace("turned ", "")
    return all(
        any(option in lowered for option in part.split("|"))
        for part in wanted.casefold().replace('"', "").split()
    )


def _names(wanted: str, value: str, objects: Sequence[MapObject]) -> bool:
    """Whether an argument names what is wanted: by id, by words of the description, or by the words said."""
    if re.fullmatch(r"-?[\d.]+", wanted):
        return bool(re.fullmatch(r"-?[\d.]+", value)) and float(wanted) == float(value)
    for item in objects:
        if item.id == wanted:
            if value == item.id:
                return True
            mine = _words(value)
            fitting = [o for o in objects if mine and mine <= _words(f"{o.description} {o.class_name}")]
            exact = [o for o in objects if mine == _words(o.description)]
            return item in exact if exact else fitting == [item]
    return any(option.casefold() in value.casefold() for option in wanted.replace('"', "").split("|"))


def wrong(case: Case, situation: Situation | ErrorSituation, action: ChatAction) -> list[str]:
    """What is not as it should be; empty if all is."""
    body = case.body
    problems = [*_plan_problems(body, situation, action), *_command_problems(body, action)]
    said = action.message_response
    if body.get("asks") and not ("?" in said or "Tell me" in said):
        problems.append("asks: no question")
    if "success" in body and action.success is not body["success"]:
        problems.append(f"success: expected {body['success']}, got {action.success}")
    if "targets" in body and sorted(action.targets) != sorted(body["targets"]):
        problems.append(f"targets: expected {body['targets']}, got {list(action.targets)}")
    if "choices" in body:
        fits = len(action.choices) == len(body["choices"]) and all(
            any(_names(wanted, choice, situation.objects) for choice in action.choices)
            for wanted in body["choices"]
        )
        problems += [] if fits else [f"choices: expected {body['choices']}, got {list(action.choices)}"]
    for part in body.get("says", []):
        if not any(option in said for option in part.split("|")):
            problems.append(f"says: {part!r} missing")
    if not said.strip() and not isinstance(situation, ErrorSituation):
        problems.append("says nothing")
    return [*problems, f"reply: {said}"] if problems else []


def _plan_problems(
    body: dict[str, Any], situation: Situation | ErrorSituation, action: ChatAction
) -> list[str]:
    if "final" in body or "final_any" in body:
        assert isinstance(situation, Situation)
        right, got = body.get("final_any", [body.get("final")]), steps(pending(situation.queue, action))
    else:
        right, got = body.get("do_any", [body.get("do", [])]), steps(action.queue)
    if body.get("any_do"):
        return []
    if body.get("any_order"):
        pairs = list(_pairs(right[0]))
        right = [list(itertools.chain(*order)) for order in itertools.permutations(pairs)]
    fits = any(_fits(plan, got, situation.objects) for plan in right)
    return [] if fits else [f"do: expected {right[0]}, got {got}"]


def _pairs(plan: Sequence[str]) -> list[list[str]]:
    """A plan in groups that begin with going."""
    groups: list[list[str]] = []
    for step in plan:
        if step.startswith("go ") or not groups:
            groups.append([])
        groups[-1].append(step)
    return groups


def _command_problems(body: dict[str, Any], action: ChatAction) -> list[str]:
    problems = []
    added = [str(c.arguments.get("data", "")) for c in action.system_cmd if c.command == "add_memory"]
    for words in body.get("remember", []):
        if not any(all(word.casefold() in text.casefold() for word in words) for text in added):
            problems.append(f"remember: expected {words}, got {added}")
    gone = [str(c.arguments.get("name", "")) for c in action.system_cmd if c.command == "remove_memory"]
    if sorted(gone) != sorted(body.get("forget", [])) and not (
        "forget" not in body and body.get("any_commands")
    ):
        problems.append(f"forget: expected {body.get('forget', [])}, got {gone}")
    if "remember" not in body and added and not body.get("any_commands"):
        problems.append(f"remembers {added}")
    control = [c.command for c in action.system_cmd if c.command not in {"add_memory", "remove_memory"}]
    edits = "final" in body or "final_any" in body or body.get("any_commands")
    if not edits and control != body.get("commands", []):
        problems.append(f"commands: expected {body.get('commands', [])}, got {control}")
    return problems
