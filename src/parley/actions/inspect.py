"""Inspect: look with the camera and report (thesis 5.1.3)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from parley.actions.context import ActionContext
from parley.actions.looking import view
from parley.errors import ActionFailure, FailureCode, LanguageError
from parley.language.base import InspectionReport
from parley.robots.base import CameraImage, Detection
from parley.sentences import sentence, together
from parley.umrf.action import Outcome, action
from parley.world.object_map import ObjectMap
from parley.world.whereabouts import Footprint, Place, called, named_place, nearest, standing

__all__ = ["FEED", "Inspection", "inspect", "not_seen"]

FEED: Final = "inspection"
"""Name of the display feed that gets the pictures."""

COVERING_SHARE: Final = 0.04
"""A thing that nobody expects and that covers more of the picture than this may hide what is looked for."""

_SURE: Final = 0.5
"""So sure a detector has to be of what nobody asked about, to put it on the map."""


@dataclass(frozen=True, slots=True)
class Inspection:
    """What was seen."""

    inspection_result: str
    """In words for the operator."""


@action(
    label="Look with the camera: {inspect}",
    phrases=("inspect {inspect}", "look at {inspect}", "check {inspect}", "look for {inspect}"),
    effects=("looks",),
    capabilities=("camera",),
    pausable=False,
    kinds={"inspect": "text"},
    tests={
        "look at the pump": {"inspect": "pump"},
        "don't look at the pump": None,
    },
)
async def inspect(ctx: ActionContext, inspect: str) -> Inspection | Outcome:
    """Take a picture of what is in front, show it, and say what can be seen.

    Args:
        inspect: What to look for or to look at.
    """
    # Before the picture: a base that is silent for a moment after it spoils nothing.
    place, known = named_place(inspect, ctx.world.objects, ctx.robot.pose())
    where = ctx.whereabouts()
    seen = await view(ctx.robot, place)
    image = seen.image
    ctx.display.show(FEED, image, {"request": inspect})
    told = await _told(ctx, inspect)
    try:
        report = await ctx.language.inspect(image, inspect, told, known)
    except LanguageError as error:
        raise ActionFailure(
            FailureCode.UNAVAILABLE, "I took the picture, but I cannot tell what is in it just now."
        ) from error
    if (
        not (seen.is_whole or report.things) and report.found is not None
    ):  # it may stand where nothing is seen
        told_whole = together(report.text, sentence("I cannot see all of it from here."))
        report = replace(report, text=told_whole, found=None if ctx.run.result_asked else report.found)
    ctx.operator.tell(report.text, image)
    found = await _kept(ctx, report, image, where)
    if place is not None and seen.is_whole:
        await _forget_gone(ctx, place, image)
    if report.rules:
        text = f"{report.text} You told me: “{'” and “'.join(report.rules)}”."
        raise _alarm(text, report, found, rules=[*report.rules])
    if ctx.run.result_asked:
        return _answered(ctx, inspect, image, report, found)
    # What the map has by that very name is looked at because somebody knows of it.
    is_known = any(item.description.lower() == inspect.lower() for item in ctx.world.objects.objects)
    if report.attention or (report.found and report.unwanted and not is_known):
        raise _alarm(report.text, report, found)
    if report.found is False and not report.unwanted:
        raise not_seen(image, report.wanted or inspect, report.text, ctx.world.objects)
    return Outcome(True, {"inspection_result": report.text}, _facts(image))


def _answered(
    ctx: ActionContext, request: str, image: CameraImage, report: InspectionReport, found: Sequence[str]
) -> Outcome:
    """The answer to a question of the plan.

    Raises:
        ActionFailure: Nobody can tell; what depends on it is not done by guessing.
    """
    if report.found is None:
        raise _alarm(report.text, replace(report, wanted=request), found)
    if not report.found and not report.unwanted:
        failure = not_seen(image, report.wanted or request, report.text, ctx.world.objects)
        if failure.code is not FailureCode.NO_MATCH:
            raise failure
    return Outcome(report.found, {"inspection_result": report.text}, _facts(image))


def _alarm(text: str, report: InspectionReport, found: Sequence[str], **more: Any) -> ActionFailure:
    """A person should decide what follows."""
    details = {"wanted": report.wanted} | ({"found": [*found]} if found else {}) | more
    return ActionFailure(FailureCode.ATTENTION, text, details)


async def _kept(ctx: ActionContext, report: InspectionReport, image: CameraImage, where: str) -> list[str]:
    """Take down what was found: on the map, for all robots to go to, and in the memory, with its picture."""
    names: list[str] = []
    for thing in report.things:
        name = await _placed(ctx, thing)
        _note_sighting(ctx, name, thing, image, where)
        names.append(name)
    if report.found is None and not report.things:  # nothing in particular was looked for: all counts
        for thing in image.detections or ():
            if thing.confidence is None or thing.confidence >= _SURE:
                await _placed(ctx, thing)
    if report.found and report.wanted and not (report.things or report.unwanted):
        _note_sighting(ctx, report.wanted, None, image, where)
    return names


async def _placed(ctx: ActionContext, thing: Detection) -> str:
    """Put something on the map, if it stays where it is and that is known; how people call it."""
    name = thing.label
    walks = name.startswith("robot ") or name in {"person", *(person.name for person in ctx.robot.people())}
    if walks or thing.x_m is None or thing.y_m is None:
        return name
    placed = await ctx.world.note(name, Footprint(thing.x_m, thing.y_m, *thing.span_m))
    return placed.description if placed is not None else name


async def _told(ctx: ActionContext, wanted: str) -> list[str]:
    """What people told the robots, for an engine that can tell what of it applies to a picture."""
    if not ctx.language.sees_pictures:
        return []
    found = await ctx.memory.find(wanted)
    return [entry.data for entry in found if entry.type == "text" and entry.is_told]


def _facts(image: CameraImage) -> dict[str, list[str]]:
    """All that was recognised, whatever was asked for: somebody may have said what to do about it."""
    seen = dict.fromkeys(detection.label for detection in image.detections or ())
    return {"seen": list(seen)} if seen else {}


async def _forget_gone(ctx: ActionContext, place: Place, image: CameraImage) -> None:
    """What was found in a place that is seen as a whole, and is not there now, is not on the map any more."""
    seen = " ".join(found.label.lower() for found in image.detections or ())
    for item in ctx.world.objects.objects if image.detections is not None else ():
        footprint = Footprint(item.x_m, item.y_m, item.width_m, item.height_m)
        if item.found and item.class_name not in seen and standing(footprint, place) != "outside":
            await ctx.world.forget(item)


def _note_sighting(
    ctx: ActionContext, wanted: str, thing: Detection | None, image: CameraImage, where: str
) -> None:
    """For all robots: what was found, where, how it looks; the newest replaces the rest."""
    name = "_".join(re.findall(r"\w+", wanted.lower()))[:150]
    sentence = f"I saw the {wanted} from where I stood, {where}."
    if thing is not None and thing.x_m is not None and thing.y_m is not None:
        sentence = f"I saw the {wanted} at the point ({thing.x_m:.1f}, {thing.y_m:.1f})"
        others = (item for item in ctx.world.objects.objects if item.description != wanted)
        by = nearest(thing.x_m, thing.y_m, others)
        sentence += f", by {called(by.description)}." if by is not None else "."
    ctx.remember(f"{name}_sighting", sentence, info=f"Where {ctx.actor} saw the {wanted}")
    ctx.remember_picture(f"picture of the {wanted[:150]}", image, info=f"The {wanted}, as {ctx.actor} saw it")


def not_seen(image: CameraImage, wanted: str, text: str, known: ObjectMap) -> ActionFailure:
    """Missing and hidden call for different help, so they are different failures."""
    hiding = _in_the_way(image, known)
    seen = [detection.label for detection in image.detections or ()]
    if hiding:
        return ActionFailure(
            FailureCode.BLOCKED,
            f"I cannot see the {wanted}: a {hiding} is in the way.",
            {"wanted": wanted, "in_the_way": hiding, "seen": seen},
        )
    return ActionFailure(FailureCode.NO_MATCH, text, {"wanted": wanted, "seen": seen})


def _in_the_way(image: CameraImage, known: ObjectMap) -> str:
    """The label of something large in the picture that is on no map, or an empty text."""
    expected = {
        name.lower() for item in known.objects for name in (item.description, item.class_name, item.id)
    }
    threshold = COVERING_SHARE * image.width * image.height
    strangers = [
        detection
        for detection in image.detections or ()
        if detection.pixels >= threshold and detection.label.lower() not in expected
    ]
    strangers.sort(key=lambda detection: detection.distance_m or 0.0)
    return strangers[0].label if strangers else ""
