"""Python actions: a function with types and a docstring is an action; its descriptor is derived from it.

::

    @action(phrases=("wave at {target}",), effects=("moves",), risk="low")
    async def wave_at(ctx: ActionContext, target: str) -> Waved:
        '''Wave at somebody (google style; an ``Args`` section describes the parameters).'''

The first argument is the context; every other one is an input parameter. ``str``, ``float``/``int``, ``bool``
and lists of them become the PVF types `string`, `number`, `bool`, `strings`, `numbers`, `bools`; a frozen
dataclass becomes a name level (``pose: Pose`` with ``position: Position`` gives ``pose::position::x``). An
argument with a default is not required. Outputs are the fields of the returned dataclass, flattened likewise;
returning None or True means `on_true` without outputs, returning False means `on_false`. To end with
`on_false` *and* outputs, or otherwise spelt parameters, see `Outcome` and `action(inputs=.., outputs=..)`.

The action's name is the function's name in camel case (``get_coordinates`` -> ``GetCoordinates``).
Plain (not async) functions run in a thread. Failing is raising `parley.errors.ActionFailure`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

from parley.clock import Clock
from parley.messages.pvf import Parameter

__all__ = ["ActionSpec", "Outcome", "RunHandle"]


class RunHandle(Protocol):
    """What the executor gives to one run of one node; contexts are built around it."""

    actor: str
    graph_name: str
    node: str
    """Full name of the node."""
    clock: Clock

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


@dataclass(frozen=True, slots=True)
class Outcome:
    """A result with outputs by flat name, where a dataclass does not fit."""

    result: bool = True
    outputs: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ActionSpec:
    """Everything known about an action: its descriptor, how people ask for it, and what runs it."""

    name: str
    inputs: Mapping[str, Parameter]
    outputs: Mapping[str, Parameter]
    description: str = ""
    type: str = "sync"
    phrases: tuple[str, ...] = ()
    effects: tuple[str, ...] = ()
    risk: Literal["none", "low", "high"] = "low"
    capabilities: tuple[str, ...] = ()
    pausable: bool = True
    """Whether the action honours a pause itself; if not, it is let finish and its children are held."""
    run: Callable[..., Any] | None = None
    """``run(context, **arguments)``, plain or async; None for a bare descriptor."""
