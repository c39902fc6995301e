"""What a descriptor of ours says besides UMRF, under the key `parley`; other engines ignore it."""

from __future__ import annotations

from typing import Annotated, Any, Final

from pydantic import BaseModel, ConfigDict, Field, StrictStr, ValidationError

from parley.errors import Problem
from parley.messages.status import Kind
from parley.umrf.action import ActionSpec, Risk, SayTest

__all__ = ["EXTRAS", "KNOWN_KEYS", "read_extras", "write_extras"]

EXTRAS: Final = "parley"
"""The key of a node or a descriptor for what UMRF does not know."""

_Texts = Annotated[tuple[StrictStr, ...], Field(strict=False)]
_Seconds = Annotated[float, Field(gt=0, allow_inf_nan=False)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _Parameter(_Strict):
    kind: Kind | None = None
    unit: str = ""
    help: str = ""


class _Test(_Strict):
    say: Annotated[str, Field(min_length=1)]
    inputs: dict[str, str | float | bool] | None


class _Extras(_Strict):
    label: str = ""
    phrases: _Texts = ()
    examples: _Texts = ()
    effects: _Texts = ()
    capabilities: _Texts = ()
    risk: Risk = ""
    duration_s: _Seconds | None = None
    timeout_s: _Seconds | None = None
    parameters: dict[str, _Parameter] = Field(default_factory=dict)
    tests: tuple[_Test, ...] = ()


KNOWN_KEYS: Final = frozenset({*_Extras.model_fields, "retries", "skipped"})
"""What may stand under `EXTRAS` of a node: what is said of its action, and what only graphs say."""


def read_extras(raw: Any, inputs: Any) -> tuple[dict[str, Any], list[Problem]]:
    """What is said, as arguments of `ActionSpec`, and what is wrong with it.

    Args:
        raw: What stands under `EXTRAS`; None if nothing does.
        inputs: The names of the action's inputs.
    """
    try:
        read = _Extras.model_validate({} if raw is None else raw)
    except ValidationError as error:
        return {}, [_problem(item) for item in error.errors(include_url=False, include_input=False)]
    problems = [
        Problem(
            f"{EXTRAS}.parameters.{name}", "there is no such input", f"inputs: {', '.join(inputs) or 'none'}"
        )
        for name in read.parameters
        if name not in inputs
    ]
    problems += [
        Problem(f"{EXTRAS}.tests[{number}].inputs.{name}", "there is no such input")
        for number, test in enumerate(read.tests)
        for name in test.inputs or ()
        if name not in inputs
    ]
    said = read.model_dump(exclude={"parameters", "tests"}, exclude_defaults=True)
    told = read.parameters
    return said | {
        "kinds": {name: item.kind for name, item in told.items() if item.kind},
        "units": {name: item.unit for name, item in told.items() if item.unit},
        "help": {name: item.help for name, item in told.items() if item.help},
        "tests": tuple(SayTest(test.say, test.inputs) for test in read.tests),
    }, problems


def _problem(item: Any) -> Problem:
    path = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in item["loc"])
    if item["type"] == "extra_forbidden":
        known = (
            ", ".join(_known_at(item["loc"][0])) if len(item["loc"]) > 1 else ", ".join(_Extras.model_fields)
        )
        return Problem(EXTRAS + path, "unknown key", f"known are {known}", "unknown_key")
    return Problem(EXTRAS + path, item["msg"])


def _known_at(section: Any) -> list[str]:
    models: dict[str, type[BaseModel]] = {"parameters": _Parameter, "tests": _Test}
    return list(models.get(section, _Extras).model_fields)


def write_extras(spec: ActionSpec) -> dict[str, Any]:
    """What stands under `EXTRAS` for an action; empty if nothing does."""
    parameters = {
        name: {
            "kind": spec.kinds.get(name),
            "unit": spec.units.get(name, ""),
            "help": spec.help.get(name, ""),
        }
        for name in spec.inputs
    }
    read = _Extras.model_validate(
        {
            **{key: getattr(spec, key) for key in _Extras.model_fields if key not in ("parameters", "tests")},
            "parameters": {name: told for name, told in parameters.items() if any(told.values())},
            "tests": [{"say": test.say, "inputs": test.inputs} for test in spec.tests],
        }
    )
    written = read.model_dump(mode="json", exclude_defaults=True)
    if read.tests:  # None is what a test says here, and no default
        written["tests"] = [test.model_dump(mode="json") for test in read.tests]
    return written
