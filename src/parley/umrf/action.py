"""Python actions: a function with types and a docstring is an action; its descriptor is derived from it.

::

    @action(phrases=("wave at {target}",), effects=("moves",))
    async def wave_at(ctx: ActionContext, target: str) -> Waved:
        '''Wave at somebody (google style; an ``Args`` section describes the parameters).'''

The first argument is the context; every other one is an input parameter. ``str``, ``float``/``int``, ``bool``
and lists of them become the PVF types `string`, `number`, `bool`, `strings`, `numbers`, `bools`; a frozen
dataclass becomes a name level (``pose: Pose`` with ``position: Position`` gives ``pose::position::x``). An
argument with a default is not required. Outputs are the fields of the returned dataclass, flattened likewise;
returning None or True means `on_true` without outputs, returning False means `on_false` (an action that may
do either is annotated ``-> Found | bool``). To end with
`on_false` *and* outputs return an `Outcome` (``-> Found | Outcome``). For otherwise spelt parameters see
`action(inputs=.., outputs=..)`: an argument then stands for a flat name with ``__`` for ``::``.

The action's name is the function's name in camel case (``get_coordinates`` -> ``GetCoordinates``).
Plain (not async) functions run in a thread. Failing is raising `parley.errors.ActionFailure`.

An action that has to remember something between runs of one node is a class without constructor arguments
and with a method ``run(self, ctx, ...)``; each node of each graph run gets an instance of its own.
"""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, Literal, ParamSpec, Protocol, TypeVar, overload

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode
from parley.messages.pvf import NATIVE_TYPES, SEPARATOR, Parameter, fits_type
from parley.messages.status import Kind
from parley.umrf.motion import Motion
from parley.umrf.signature import (
    MISSING,
    build_argument,
    docstring_parts,
    flatten_type,
    flatten_value,
    is_record,
    resolve_hints,
    strip_optional,
)
from parley.umrf.text import clean_text

__all__ = [
    "Action",
    "ActionSpec",
    "Outcome",
    "RunHandle",
    "SayTest",
    "action",
    "bind_inputs",
    "outcome_of",
]

P = ParamSpec("P")
R = TypeVar("R")

Risk = Literal["none", "low", "high", ""]
"""What authors said before effects told it; empty: nothing. See `parley.gate.risk`."""


class RunHandle(Protocol):
    """What the executor gives to one run of one node; contexts are built around it."""

    actor: str
    graph_name: str
    node: str
    """Full name of the node."""
    clock: Clock
    motion: Motion
    """Whether it may move its robot; what drives looks at it."""

    def log(self, text: str) -> None:
        """Add a runtime message (at most 10 are kept)."""
        ...

    def progress(self, fraction: float | None, text: str = "") -> None:
        """Tell how far it is, 0 to 1, or None when that is not known; at most every 100 ms is sent on."""
        ...

    @property
    def paused(self) -> bool:
        """Whether the action should stand still now; long loops look at it every round."""
        ...

    async def wait_while_paused(self) -> None:
        """Return at once, or as soon as the pause is over."""
        ...

    @property
    def stop_requested(self) -> bool:
        """Plain (threaded) actions look at it; async ones are cancelled."""
        ...

    @property
    def result_asked(self) -> bool:
        """Whether an edge tells false from true: then not finding something is an answer, not a failure."""
        ...


@dataclass(frozen=True, slots=True)
class Outcome:
    """A result with outputs by flat name, where a dataclass does not fit."""

    result: bool = True
    outputs: Mapping[str, Any] = field(default_factory=dict)
    facts: Mapping[str, Any] = field(default_factory=dict)
    """Told in the event of the node's end and nowhere else: not declared, not handed on."""


@dataclass(frozen=True, slots=True)
class SayTest:
    """A sentence and what it has to give for an action's inputs; None: it must not lead to the action."""

    say: str
    inputs: Mapping[str, Any] | None


@dataclass(frozen=True, slots=True)
class ActionSpec:
    """Everything known about an action: its descriptor, how people ask for it, and what runs it."""

    name: str
    inputs: Mapping[str, Parameter]
    outputs: Mapping[str, Parameter]
    description: str = ""
    type: str = "sync"
    label: str = ""
    """What people read that it does, with ``{parameters}``; ``{place}`` stands for a pose."""
    phrases: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    risk: Risk = ""
    capabilities: tuple[str, ...] = ()
    """What the robot must have; without it the action is refused before anything runs."""
    examples: tuple[str, ...] = ()
    """Whole sentences by which people ask for it."""
    duration_s: float | None = None
    """About how long it takes, in robot time; None if that cannot be said beforehand."""
    timeout_s: float | None = None
    """Robot time, pauses left out, after which it is cancelled and fails as `timed_out`; None: never."""
    isolated: bool = False
    """Whether it runs in a process of its own, see `parley.umrf.isolated`."""
    pausable: bool = True
    """Whether the action honours a pause itself; if not, it is let finish and its children are held."""
    run: Callable[..., Any] | None = None
    """``run(context, **bind_inputs(spec, values))``, plain or async; None for a bare descriptor."""
    arguments: Mapping[str, Any] = field(default_factory=dict)
    """Python argument of `run` -> its type; empty where `run` takes flat names (``__`` for ``::``)."""
    help: Mapping[str, str] = field(default_factory=dict)
    """Argument -> what it means, from the docstring."""
    units: Mapping[str, str] = field(default_factory=dict)
    """Flat parameter name -> unit, where it has one."""
    kinds: Mapping[str, Kind] = field(default_factory=dict)
    """Flat parameter name -> what it takes; what is not told is derived (`parley.umrf.kinds`)."""
    tests: tuple[SayTest, ...] = ()
    """Sentences with what they have to give, for `parley actions check`."""
    make: Callable[[], Any] | None = None
    """For class actions: makes the object whose `run` runs one node."""

    def runner(self) -> Callable[..., Any] | None:
        """What runs one node of one graph; a class action gets a fresh object each time this is called."""
        runner: Callable[..., Any] | None = self.run if self.make is None else self.make().run
        return runner


class Action(Generic[P, R]):
    """A function (or class) that is an action: called as ever, and described by `spec`."""

    def __init__(self, target: Callable[P, R], spec: ActionSpec) -> None:
        self.spec = spec
        self._target = target
        functools.update_wrapper(self, target)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Call the function itself, with Python arguments."""
        return self._target(*args, **kwargs)


@overload
def action(target: Callable[P, R], /) -> Action[P, R]: ...


@overload
def action(
    *,
    name: str = "",
    description: str = "",
    label: str = "",
    phrases: tuple[str, ...] = (),
    effects: tuple[str, ...] = (),
    risk: Risk = "",
    capabilities: tuple[str, ...] = (),
    examples: tuple[str, ...] = (),
    duration_s: float | None = None,
    timeout_s: float | None = None,
    isolated: bool = False,
    pausable: bool = True,
    type: Literal["sync", "async", "spontaneous"] = "sync",
    inputs: Mapping[str, Parameter | str] | None = None,
    outputs: Mapping[str, Parameter | str] | None = None,
    units: Mapping[str, str] | None = None,
    kinds: Mapping[str, Kind] | None = None,
    tests: Mapping[str, Mapping[str, Any] | None] | None = None,
) -> Callable[[Callable[P, R]], Action[P, R]]: ...


def action(target: Callable[..., Any] | None = None, /, **options: Any) -> Any:
    """Make an action of a function or class (see the module's text).

    Args:
        target: The function, when used without brackets.
        **options: `name` and `description` instead of those of the function; `label`, `phrases`, `effects`,
            `risk`, `capabilities`, `examples`, `duration_s`, `timeout_s`, `isolated`, `pausable` (never so
            for an isolated one), `type` as in `ActionSpec`; `inputs` and `outputs` (flat name ->
            `Parameter` or PVF type) instead of what the signature says; `units` and `kinds` (flat name ->
            unit, kind); `tests` (sentence -> inputs, or None where it must not lead to this action).

    Raises:
        TypeError: The signature cannot be described; says which argument.
        ValueError: A duration or time-out is not a positive number; a unit or kind is of no input.
    """
    if target is not None:
        return Action(target, _describe(target, {}))
    return lambda wrapped: Action(wrapped, _describe(wrapped, options))


def _describe(target: Callable[..., Any], options: Mapping[str, Any]) -> ActionSpec:
    rest = dict(options)
    for key in ("duration_s", "timeout_s"):
        if rest.get(key) is not None and not 0 < rest[key] < math.inf:
            raise ValueError(f"{target.__name__}: {key} must be a positive number, not {rest[key]!r}")
    if rest.get("isolated"):
        rest["pausable"] = False  # its process cannot be told to stand still
    is_class = inspect.isclass(target)
    function: Callable[..., Any] = getattr(target, "run") if is_class else target  # noqa: B009 - not typed
    hints, returned = resolve_hints(function, skip=2 if is_class else 1)
    inputs, outputs = rest.pop("inputs", None), rest.pop("outputs", None)
    description, texts = docstring_parts(target)
    derived = _derive_inputs(hints, inspect.signature(function)) if inputs is None else _as_parameters(inputs)
    kinds, units = rest.pop("kinds", None) or {}, rest.pop("units", None) or {}
    for key, named in (("kinds", kinds), ("units", units)):
        if strange := sorted(named.keys() - derived.keys()):
            raise ValueError(f"{target.__name__}: {key}: there is no input {strange[0]!r}")
    tests = rest.pop("tests", None) or {}
    return ActionSpec(
        name=rest.pop("name", "") or _camel_case(target.__name__),
        description=rest.pop("description", "") or description,
        inputs=derived,
        outputs=_derive_outputs(returned) if outputs is None else _as_parameters(outputs),
        run=None if is_class else target,
        make=target if is_class else None,
        arguments=hints if inputs is None else {},
        help=texts,
        units=units,
        kinds=kinds,
        tests=tuple(SayTest(say, given) for say, given in tests.items()),
        **rest,
    )


def _derive_inputs(hints: Mapping[str, Any], signature: inspect.Signature) -> dict[str, Parameter]:
    flat: dict[str, Parameter] = {}
    for name, hint in hints.items():
        default = signature.parameters[name].default
        flat |= flatten_type(name, hint, MISSING if default is inspect.Parameter.empty else default)
    return flat


def _derive_outputs(returned: Any) -> dict[str, Parameter]:
    kind = strip_optional(strip_optional(returned, bool), Outcome)
    if kind in (None, type(None), bool, Outcome, Any):
        return {}
    if not is_record(kind):
        raise TypeError(f"an action returns None, bool, a dataclass or Outcome, not {kind}")
    return flatten_type("", kind)


def _as_parameters(given: Mapping[str, Parameter | str]) -> dict[str, Parameter]:
    return {name: Parameter(item) if isinstance(item, str) else item for name, item in given.items()}


def _camel_case(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def bind_inputs(spec: ActionSpec, values: Mapping[str, Any]) -> dict[str, Any]:
    """The keyword arguments of ``spec.run`` from flat `values`; what has no data is left to its default.

    Raises:
        ActionFailure: `internal`: a value is missing or does not fit the argument.
    """
    if not spec.arguments:
        return {name.replace(SEPARATOR, "__"): value for name, value in values.items()}
    built = {name: build_argument(name, hint, values) for name, hint in spec.arguments.items()}
    return {name: value for name, value in built.items() if value is not MISSING}


def outcome_of(spec: ActionSpec, returned: Any) -> Outcome:
    """What an action returned, as a result with outputs by flat name.

    Raises:
        ActionFailure: `internal`: an output is not declared or not of its type (NaN is no number here).
    """
    if returned is None or isinstance(returned, bool):
        return Outcome(result=returned is not False)
    if isinstance(returned, Outcome):
        if not isinstance(returned.result, bool) and str(getattr(returned.result, "dtype", "")) != "bool":
            text = f"{spec.name} returned {returned.result!r} as its result, which is neither true nor false."
            raise ActionFailure(FailureCode.INTERNAL, text)
        result, facts = bool(returned.result), _flat(returned.facts)
        flat = _flat(returned.outputs)
    else:
        result, facts, flat = True, {}, flatten_value(returned)
    for name, value in flat.items():
        parameter = spec.outputs.get(name)
        if parameter is None:
            raise ActionFailure(
                FailureCode.INTERNAL, f"{spec.name} returned {name or type(returned).__name__!r}, no output."
            )
        if parameter.type in NATIVE_TYPES and not fits_type(parameter.type, value):
            raise ActionFailure(
                FailureCode.INTERNAL,
                f"{spec.name} returned {value!r} as {name}, which is no {parameter.type}.",
            )
    return Outcome(result, flat, facts)


def _flat(values: Mapping[str, Any]) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in values.items():
        flat |= flatten_value(value, clean_text(str(name)))
    return flat
