"""Actions as a language engine planned them, spelt out so that they can be carried out as they stand."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo

__all__ = ["bound_to_steps", "completed", "completed_answer"]


def completed(call: ActionCall, info: ActionInfo) -> ActionCall:
    """The call with what was left out; a graph must name all inputs and outputs (`spec/umrf.md` 7.2).

    Args:
        call: With the values it has.
        info: What the robot says of the action.
    """
    inputs = {name: Parameter(kind) for name, kind in info.inputs.items()} | dict(call.input_parameters)
    outputs = {name: Parameter(kind) for name, kind in info.outputs.items()} | dict(call.output_parameters)
    return call.model_copy(update={"input_parameters": inputs, "output_parameters": outputs})


def completed_answer(answer: ChatAction, catalogue: Iterable[ActionInfo]) -> ChatAction:
    """The answer with all its calls completed; an action that is not in the catalogue stays as it is."""
    infos = {info.name: info for info in catalogue}

    def whole(calls: Iterable[ActionCall]) -> tuple[ActionCall, ...]:
        return tuple(completed(call, infos[call.name]) if call.name in infos else call for call in calls)

    return answer.model_copy(update={"queue": whole(answer.queue), "afterwards": whole(answer.afterwards)})


def bound_to_steps(answer: ChatAction, steps: Sequence[str]) -> ChatAction:
    """The answer with each step to be dropped named by its id, whatever ends before it is dropped.

    Args:
        answer: As an engine gave it; it may only know places.
        steps: The ids of the pending steps that the engine was shown.
    """

    def bound(command: SystemCommand) -> SystemCommand:
        place = command.pop_index if command.command == "pop" else None
        if place is None or not 0 <= place < len(steps) or command.arguments.get("step"):
            return command
        return command.model_copy(update={"arguments": {**command.arguments, "step": steps[place]}})

    return answer.model_copy(update={"system_cmd": tuple(map(bound, answer.system_cmd))})
