"""What the planner does with an order: at once, after a yes, or not at all. Pure."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final, Literal

from parley.gate.table import Effect, verdict
from parley.messages.chat import ActionCall, SystemCommand
from parley.messages.principal import Principal

__all__ = ["EFFECT_OF", "Policy", "Ruling", "rule"]

Policy = Literal["run_at_once", "ask_when_risky", "ask_first"]

EFFECT_OF: Final[dict[str, Effect]] = {
    "stop": Effect.PAUSE,
    "pause": Effect.PAUSE,
    "start": Effect.RESUME,
    "clear": Effect.CLEAR,
    "pop": Effect.EDIT,
    "skip": Effect.EDIT,
    "add_memory": Effect.REMEMBER,
    "remove_memory": Effect.FORGET,
}


@dataclass(frozen=True, slots=True)
class Ruling:
    """What becomes of an order for one robot."""

    do: tuple[SystemCommand, ...] = ()
    """Commands that are carried out now."""
    ask: tuple[SystemCommand, ...] = ()
    """Commands that wait for a yes, together with the steps."""
    refused: tuple[SystemCommand, ...] = ()
    begins: Literal["now", "ask", "refuse"] = "now"
    """What becomes of the steps."""


def rule(
    by: Principal | None,
    policy: Policy,
    calls: Sequence[ActionCall],
    commands: Sequence[SystemCommand],
    *,
    needs_yes: bool = False,
    risky: bool = False,
    held_by: Principal | None = None,
    harmless: Collection[SystemCommand] = (),
    begin: Effect = Effect.BEGIN,
) -> Ruling:
    """Decide about an order.

    Args:
        by: Who wants it.
        policy: The robot's.
        calls: The steps.
        commands: Without those for memories.
        needs_yes: Whether the gate wants a yes whatever the policy.
        risky: Whether the steps are of the kind that `ask_when_risky` asks about.
        held_by: Who holds the robot, if somebody told it to stand still.
        harmless: Changes after which a robot that was told to stand still goes on standing, with a plan.
        begin: `BEGIN`, or `REPAIR` for steps in the place of one that failed.
    """
    held_by_person = held_by is not None and held_by.is_person
    asks = needs_yes or policy == "ask_first" or (policy == "ask_when_risky" and risky)
    do: list[SystemCommand] = []
    ask: list[SystemCommand] = []
    refused: list[SystemCommand] = []
    for command in commands:
        found = verdict(by, EFFECT_OF[command.command])
        if found == "own":
            found = "allow" if held_by == by and not held_by_person else "refuse"
        if found == "policy":
            found = "yes" if asks or (held_by_person and command not in harmless) else "allow"
        (do if found == "allow" else ask if found == "yes" else refused).append(command)
    found = verdict(by, begin)
    begins: Literal["now", "ask", "refuse"] = "now"
    if calls and found == "refuse":
        begins = "refuse"
    elif calls and (ask or found == "yes" or (found == "policy" and asks)):
        begins = "ask"
    if begins == "ask" or ask:  # one question about all of it; what was to come first waits too
        halting = [command for command in do if EFFECT_OF[command.command] is Effect.PAUSE]
        ask = [command for command in commands if command not in halting and command not in refused]
        do = halting
    return Ruling(tuple(do), tuple(ask), tuple(refused), begins)
