"""Actions as a language engine planned them, spelt out so that they can be carried out as they stand."""

from __future__ import annotations

from parley.messages.chat import ActionCall
from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo

__all__ = ["completed"]


def completed(call: ActionCall, info: ActionInfo) -> ActionCall:
    """The call with what was left out; a graph must name all inputs and outputs (`spec/umrf.md` 7.2).

    Args:
        call: With the values it has.
        info: What the robot says of the action.
    """
    inputs = {name: Parameter(kind) for name, kind in info.inputs.items()} | dict(call.input_parameters)
    outputs = {name: Parameter(kind) for name, kind in info.outputs.items()} | dict(call.output_parameters)
    return call.model_copy(update={"input_parameters": inputs, "output_parameters": outputs})
