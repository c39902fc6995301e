"""Whether an answer is right (design section 5), strictly: whatever was not asked for is wrong.

The same actions in the same order with arguments that name the same object, the same commands and memories,
an answer or a question where one is due.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterable, Sequence

from parley.evaluation.cases import Case, Expected
from parley.evaluation.naming import contains_all, names
from parley.evaluation.steps import Step, pending, read_steps
from parley.language.base import ErrorSituation, Situation
from parley.messages.chat import ChatAction
from parley.world.object_map import MapObject

__all__ = ["wrong"]

_SHORT = re.compile(
    r"(?:(?P<flow>(?:if|unless|with|times) \d+): )?(?P<verb>\w+)(?P<optional>~)? ?(?P<rest>.*)$"
)
_NEAR_M = 0.3
"""How far numbers may be from the place that is meant."""
_DECLINES = re.compile(
    r"\b(?:cannot|can't|can not|could not|couldn't|not able|unable|not possible|impossible|no way"
    r"|not something|(?:do not|don't) have (?:a|an|any|the)|not equipped|not allowed"
    r"|(?:do not|don't) know how|lack)\b",
    re.IGNORECASE,
)


_LOST = re.compile(
    r"not sure what you mean|(?:did|do|could) not understand|n't understand|what do you mean by that",
    re.IGNORECASE,
)


def wrong(case: Case, situation: Situation | ErrorSituation, action: ChatAction) -> list[str]:
    """What is not as it should be; empty if all is. Of several fair readings the nearest counts."""
    return min((_wrong(e, situation, action) for e in case.expectations), key=len)


def _wrong(expected: Expected, situation: Situation | ErrorSituation, action: ChatAction) -> list[str]:
    problems = [
        *_unknown_actions(situation, action),
        *_plan_problems(expected, situation, action),
        *_command_problems(expected, action),
        *_memory_problems(expected, action),
        *_reply_problems(expected, action),
    ]
    if expected.success is not None and action.success is not expected.success:
        problems.append(f"success: expected {expected.success}, got {action.success}")
    if expected.targets is not None and sorted(action.targets) != sorted(expected.targets):
        problems.append(f"targets: expected {expected.targets}, got {list(action.targets)}")
    if expected.choices is not None:
        problems += _choice_problems(expected.choices, action, situation.objects)
    if not set(expected.uses) <= set(action.sources):
        problems.append(f"uses: expected {expected.uses}, got {list(action.sources)}")
    if not action.message_response.strip() and not isinstance(situation, ErrorSituation):
        problems.append("says nothing")
    return [*problems, f"reply: {action.message_response}"] if problems else []


def _unknown_actions(situation: Situation | ErrorSituation, action: ChatAction) -> list[str]:
    known = {info.name for info in situation.catalogue}
    unknown = sorted({call.name for call in action.queue} - known)
    return [f"unknown actions: {unknown}"] if unknown else []


def _plan_problems(
    expected: Expected, situation: Situation | ErrorSituation, action: ChatAction
) -> list[str]:
    if expected.any_do:
        return []
    queue = action.queue
    if (expected.final is not None or expected.final_any) and isinstance(situation, Situation):
        queue = tuple(pending(situation.queue, action))
        right = expected.final_any or [expected.final or []]
    else:
        right = expected.do_any or [expected.do]
    if expected.declines:
        right = [*right, ["ask"]]
    if expected.any_order:
        right = list(itertools.chain.from_iterable(_orders(plan) for plan in right))
    got = read_steps(queue, situation.catalogue)
    if any(_fits(plan, got, situation) for plan in right):
        return []
    return [f"do: expected {right[0]}, got {[str(step) for step in got]}"]


def _orders(plan: Sequence[str]) -> list[list[str]]:
    """A plan with its stops in every order."""
    groups: list[list[str]] = []
    for step in plan:
        if step.startswith("go ") or not groups:
            groups.append([])
        groups[-1].append(step)
    return [list(itertools.chain(*order)) for order in itertools.permutations(groups)]


def _fits(expected: Sequence[str], got: Sequence[Step], situation: Situation | ErrorSituation) -> bool:
    if not expected:
        return not got
    read = _SHORT.match(expected[0])
    if read is None:
        raise ValueError(f"no step: {expected[0]!r}")
    if got and _step_fits(read, got[0], situation) and _fits(expected[1:], got[1:], situation):
        return True
    return bool(read["optional"]) and _fits(expected[1:], got, situation)


def _step_fits(read: re.Match[str], got: Step, situation: Situation | ErrorSituation) -> bool:
    if (read["flow"] or "") != got.flow:
        return False
    rest, objects = read["rest"], situation.objects
    if read["verb"] in {"back", "at"}:
        return _goes_to_numbers(rest, got, situation)
    if read["verb"] == "go" and got.place is not None and not _near(got.place, _places(rest, objects)):
        return False
    if read["verb"] == "go" and got.verb == "at":
        return True
    if read["verb"] != got.verb:
        return False
    if got.verb == "look":
        return contains_all(rest, " ".join(got.arguments))
    return got.verb == "ask" or _arguments_fit(rest, got.arguments, objects)


def _arguments_fit(rest: str, given: Sequence[str], objects: Sequence[MapObject]) -> bool:
    wanted = [part.strip() for part in rest.strip("()").split(",")] if rest.startswith("(") else [rest]
    wanted = [part for part in wanted if part]
    return len(wanted) == len(given) and all(
        names(one, value, objects) for one, value in zip(wanted, given, strict=True)
    )


def _goes_to_numbers(rest: str, got: Step, situation: Situation | ErrorSituation) -> bool:
    if got.verb != "at" or got.place is None:
        return False
    if rest:
        x_m, y_m = (float(number) for number in rest.split())
    elif situation.robot_pose is None:
        return True
    else:
        x_m, y_m = situation.robot_pose.x_m, situation.robot_pose.y_m
    return _near(got.place, [(x_m, y_m, 0.0)])


def _places(wanted: str, objects: Sequence[MapObject]) -> list[tuple[float, float, float]]:
    """Where the object is, and how far from there one may stand."""
    return [
        (item.x_m, item.y_m, 1.0 + math.hypot(item.width_m, item.height_m) / 2)
        for item in objects
        if item.id == wanted or item.description == wanted
    ]


def _near(place: tuple[float, float], places: Iterable[tuple[float, float, float]]) -> bool:
    return any(math.dist(place, (x_m, y_m)) <= _NEAR_M + more_m for x_m, y_m, more_m in places)


def _command_problems(expected: Expected, action: ChatAction) -> list[str]:
    if expected.any_commands or expected.final is not None or expected.final_any:
        return []
    wanted = [command for command in expected.commands if " " not in command]
    control = [c.command for c in action.system_cmd if c.command not in {"add_memory", "remove_memory"}]
    control = ["stop" if command == "pause" else command for command in control]
    return [] if control == wanted else [f"commands: expected {wanted}, got {control}"]


def _memory_problems(expected: Expected, action: ChatAction) -> list[str]:
    problems: list[str] = []
    new = [c.arguments for c in action.system_cmd if c.command == "add_memory"]
    gone = [str(c.arguments.get("name", "")) for c in action.system_cmd if c.command == "remove_memory"]
    texts = [str(one.get("data", "")) for one in new]
    named = [command.removeprefix("add ") for command in expected.commands if command.startswith("add ")]
    free = expected.may_remember or (expected.any_commands and not expected.remember)
    for words in expected.remember:
        if not any(contains_all(" ".join(words), text) for text in texts):
            problems.append(f"remember: expected {words}, got {texts}")
    if named and sorted(named) != sorted(str(one.get("name", "")) for one in new):
        problems.append(f"remember: expected {named}, got {[one.get('name') for one in new]}")
    elif not named and not free:
        besides = [t for t in texts if not any(contains_all(" ".join(w), t) for w in expected.remember)]
        problems += [f"remembers besides: {besides}"] if besides else []
    forget = [*expected.forget, *(c.removeprefix("remove ") for c in expected.commands if "remove " in c)]
    left = [name for name in gone if name not in expected.may_forget]
    if sorted(left) != sorted(forget) and not (expected.any_commands and not forget):
        problems.append(f"forget: expected {forget}, got {gone}")
    return problems


def _reply_problems(expected: Expected, action: ChatAction) -> list[str]:
    said = action.message_response
    lowered = said.casefold()
    problems = []
    lost = bool(_LOST.search(said))
    if expected.asks and (lost or not ("?" in said or "tell me" in lowered)):
        problems.append("asks: no question about what was said")
    if expected.understands and lost:
        problems.append("understands: says that it does not")
    if expected.declines and not _DECLINES.search(said):
        problems.append("declines: does not say that it cannot be done")
    for part in expected.says:
        if not any(option.casefold() in lowered for option in part.split("|")):
            problems.append(f"says: {part!r} missing")
    for part in expected.says_not:
        if any(option.casefold() in lowered for option in part.split("|")):
            problems.append(f"says: {part!r} said")
    return problems


def _choice_problems(wanted: Sequence[str], action: ChatAction, objects: Sequence[MapObject]) -> list[str]:
    offered = action.choices
    fits = len(offered) == len(wanted) and all(any(names(w, c, objects) for c in offered) for w in wanted)
    return [] if fits else [f"choices: expected {list(wanted)}, got {list(offered)}"]
