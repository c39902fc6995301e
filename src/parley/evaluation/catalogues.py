"""What the robots of the sets can do; a set may also bring actions of its own."""

from __future__ import annotations

from typing import Final

from parley.messages.status import ActionInfo

__all__ = ["CATALOGUES", "POSE"]

POSE: Final = {
    f"pose::{part}::{axis}": "number"
    for part, axes in (("position", "xyz"), ("orientation", "rpy"))
    for axis in axes
}
"""The flat parameters of a place in the map, metres and radians."""

_INSPECT = ActionInfo(
    name="Inspect",
    inputs={"inspect": "string"},
    outputs={"inspection_result": "string"},
    effects=("looks",),
    phrases=("inspect {inspect}", "look at {inspect}", "check {inspect}"),
)
_ASK = ActionInfo(
    name="AskOperator",
    inputs={"question": "string"},
    outputs={"answer": "string"},
    effects=("asks_operator",),
)
_NAVIGATE = ActionInfo(
    name="NavigateTo", inputs=POSE, effects=("moves",), phrases=("go to {place}", "drive to {place}")
)

CATALOGUES: Final[dict[str, tuple[ActionInfo, ...]]] = {
    "thesis": (
        ActionInfo(name="GetCoordinates", inputs={"target": "string"}, outputs=POSE, effects=("locates",)),
        _NAVIGATE,
        _INSPECT,
        _ASK,
    ),
    # The same without any hint but names, types and one other parameter name.
    "location": (
        ActionInfo(name="GetCoordinates", inputs={"location": "string"}, outputs=POSE),
        ActionInfo(name="NavigateTo", inputs=POSE),
        ActionInfo(name="Inspect", inputs={"inspect": "string"}, outputs={"inspection_result": "string"}),
        ActionInfo(name="AskOperator", inputs={"question": "string"}, outputs={"answer": "string"}),
    ),
    # The eight of Wang et al. for general purpose service robots.
    "primitives": (
        ActionInfo(name="move_to", inputs={"location": "string"}),
        ActionInfo(name="look_for_obj", inputs={"object": "string"}),
        ActionInfo(name="look_for_person", inputs={"person": "string"}),
        ActionInfo(name="follow", inputs={"person": "string"}),
        ActionInfo(name="grasp", inputs={"object": "string"}),
        ActionInfo(name="pass_to", inputs={"object": "string", "person": "string"}),
        ActionInfo(name="speak", inputs={"text": "string"}),
        ActionInfo(name="answer", inputs={"question": "string"}),
    ),
    "bare": (
        ActionInfo(name="MoveRobot", inputs={"goal": "string"}, description="Drive somewhere."),
        ActionInfo(name="VacuumFloor", inputs={"area": "string"}, description="Clean the floor of an area."),
        ActionInfo(
            name="switch_on", inputs={"device": "string"}, phrases=("turn on {device}", "switch on {device}")
        ),
        ActionInfo(name="WaveAt", inputs={"person": "string"}),
    ),
    "tools": (
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
            name="paint",
            inputs={"object": "string", "colour": "string"},
            phrases=("paint {object} {colour}",),
        ),
        ActionInfo(
            name="BlinkLights", inputs={"times": "number"}, phrases=("blink the lights {times} times",)
        ),
        ActionInfo(
            name="MeasureTemperature",
            inputs={"location": "string"},
            description="Measure the temperature of a place.",
        ),
    ),
}
"""By the name that a set uses."""
