"""Answers `/parley/places`: people put rooms and things on the maps of robots; every engine is told.

What they changed is kept for each map by its name, over what the object maps of the robots there say
(`parley.world.placed`).
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Final

from parley.agents.base import Node
from parley.agents.display.map_service import room_of, thing_of
from parley.agents.presence import Presence
from parley.clock import Clock
from parley.errors import ConfigError, FileFormatError, InvalidMessageError
from parley.files import parse_json, read_text, replace_text
from parley.gate.book import RuleBook
from parley.gate.table import Effect, verdict
from parley.language.dialogue.teaching import key, reserved
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.map import MapRoom, MapThing, PlaceChange, PlaceChanged, PlacesKept
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.status import ActorStatus
from parley.messages.wire import decode, encode
from parley.sentences import in_language, sentence
from parley.transport.base import Transport
from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D
from parley.world.object_map import MapArea, MapObject, ObjectMap
from parley.world.occupancy import NO_MAP
from parley.world.placed import Placed, key_of, names_of, new_id, same_name
from parley.world.telling import Surroundings
from parley.world.whereabouts import Place, middle_of

__all__ = ["Places", "read_places"]

_LONGEST: Final = 80
_SMALLEST_ROOM_M2: Final = 0.01


@dataclass(frozen=True, slots=True)
class _Weighed:
    """A change that can be made."""

    was: Place | None
    put: Place | None


class Places(Node):
    """Keeps what people put on the maps.

    Args:
        transport: Where it answers.
        maps: Robot -> what is known of its surroundings, with what is kept here.
        book: Where robots may not go.
        clock: Held while a way is looked for.
        file: Where it is kept; None: nowhere.

    Raises:
        FileFormatError: The file cannot be read.
    """

    name: ClassVar[str] = "places"

    def __init__(
        self,
        transport: Transport,
        maps: Mapping[str, Surroundings],
        book: RuleBook,
        clock: Clock,
        file: Path | None = None,
    ) -> None:
        super().__init__(transport)
        self._maps, self._book, self._clock, self._file = maps, book, clock, file
        self._placed = read_places(file) if file is not None and file.exists() else {}
        self._presence = Presence(clock)
        self._changing = asyncio.Lock()

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._presence.on_status)
        self._tell()
        server = await self.transport.serve(topics.PLACES, self._on_request)
        self.opened.push_async_callback(server.close)

    async def _on_request(self, asked: ChatRequest) -> ChatResponse:
        try:
            change = decode(PlaceChange, asked.message)
        except InvalidMessageError as error:
            self.refuse(topics.PLACES.name, error)
            return ChatResponse(encode(PlaceChanged(problem=f"{error.path}: {error.problem}")))
        try:
            async with self._changing:  # whoever comes second is compared with what the first made
                answer = await self._done(change)
        except (ConfigError, FileFormatError) as error:
            answer = PlaceChanged(problem=str(error))
        told = {"problem": in_language(answer.problem, change.language)}
        notes = tuple(in_language(note, change.language) for note in answer.notes)
        return ChatResponse(encode(answer.model_copy(update=told | {"notes": notes})))

    async def _done(self, change: PlaceChange) -> PlaceChanged:
        site = self._maps.get(change.robot)
        if site is None:
            return PlaceChanged(problem=sentence("There is no robot {robot} here.", robot=change.robot))
        if site.occupancy is NO_MAP:
            return PlaceChanged(problem=sentence("{robot} drives without a map.", robot=change.robot))
        placed = self._placed.get(site.occupancy.name, Placed())
        known = placed.applied(site.objects)
        if change.what == "whole":
            own = replace(known, objects=tuple(item for item in known.objects if not item.found))
            return PlaceChanged(whole=own.to_json())
        if change.what != "try" and verdict(change.by, Effect.MAP) != "allow":
            self._audit(change, {}, refused=_MAY_NOT)
            return PlaceChanged(problem=_MAY_NOT)
        if change.what == "load":
            whole = ObjectMap.of_json(change.whole)
            await self._keep(site.occupancy.name, placed.loaded(whole, known))
            self._audit(change, {"loaded": len(whole.objects) + len(whole.areas)})
            return PlaceChanged()
        return await self._change(change, site, placed, known)

    async def _change(
        self, change: PlaceChange, site: Surroundings, placed: Placed, known: ObjectMap
    ) -> PlaceChanged:
        found = _weighed(change, known, tuple(self._maps))
        if isinstance(found, PlaceChanged):
            return found
        notes = await self._notes(change.robot, site, found.put) if found.put is not None else ()
        put = _told(found.put) if found.put is not None else None
        if change.what == "change":
            await self._keep(site.occupancy.name, placed.changed(found.was, found.put))
            names = {"was": found.was, "put": found.put}
            detail = {name: _facts(place) for name, place in names.items() if place is not None}
            self._audit(change, detail | {"map": site.occupancy.name})
        return PlaceChanged(put=put, notes=notes)

    async def _keep(self, map_name: str, placed: Placed) -> None:
        """Write it down, then tell everybody.

        Raises:
            ConfigError: It cannot be written.
        """
        after = self._placed | {map_name: placed}
        if self._file is not None:
            told = {"maps": {name: one.to_json() for name, one in after.items()}}
            text = json.dumps(told, ensure_ascii=False, indent=1) + "\n"
            try:
                await asyncio.to_thread(replace_text, self._file, text)
            except OSError as error:
                raise ConfigError(f"{self._file.name} cannot be written: {error}") from error
        self._placed = after
        self._tell()

    def _tell(self) -> None:
        maps = {name: placed.to_json() for name, placed in self._placed.items()}
        self.publish(topics.PLACES_KEPT, PlacesKept(maps=maps))

    def _audit(self, change: PlaceChange, detail: dict[str, Any], refused: str = "") -> None:
        event = AuditEvent(
            effect=Effect.MAP,
            by=change.by,
            robot=change.robot,
            words=change.words,
            detail=detail,
            outcome="refused" if refused else "done",
            reason=refused,
        )
        self.publish(topics.AUDIT, event)

    async def _notes(self, robot: str, site: Surroundings, place: Place) -> tuple[str, ...]:
        """What people should know of a place: that no robot gets there, or may go there."""
        status = self._presence.get(robot)
        told = status.pose if status is not None else None
        thing = place if isinstance(place, MapObject) else place.goal
        spot: Pose2D | None = None
        notes: list[str] = []
        if thing.stand is not None and not site.occupancy.is_free(thing.stand.x_m, thing.stand.y_m):
            notes.append(sentence("Nobody can stand there: the map shows no free floor."))
        elif told is not None:
            here = Pose2D(told.x, told.y, told.yaw)
            with self._clock.hold():
                spot = await asyncio.to_thread(
                    approach_pose, site.occupancy, thing, here, radius_m=site.radius_m
                )
            wished = thing.stand
            if spot is None or (wished is not None and spot != wished):
                notes.append(sentence("{robot} finds no free spot there that it can get to.", robot=robot))
        at = spot or thing.stand
        x, y = (at.x_m, at.y_m) if at is not None else middle_of(place)
        for rule in self._book.closed_to(robot, None):
            if self._book.shape(rule).distance_to(x, y) < 0:
                zone = rule.name or rule.id
                notes.append(
                    sentence("It lies in “{zone}”, where {robot} may not go.", zone=zone, robot=robot)
                )
        return tuple(notes)


_MAY_NOT: Final = "Only supervisors put names on the map."
_CHANGED: Final = "Somebody else changed that meanwhile. Look at it again."


def read_places(file: Path) -> dict[str, Placed]:
    """What is kept in a file, by the name of the map.

    Raises:
        FileFormatError: Names the file and the field.
    """
    try:
        kept = PlacesKept.model_validate(parse_json(read_text(file), file.name))
    except ValueError as error:
        raise FileFormatError(file.name, "maps", "expected an object map for each name") from error
    return {name: Placed.of_json(told, file.name) for name, told in kept.maps.items()}


def _weighed(change: PlaceChange, known: ObjectMap, robots: Sequence[str]) -> _Weighed | PlaceChanged:
    """What is to be changed into what, or why that cannot be."""
    was, before = None, change.was
    if before is not None:
        was = _found(known, before)
        if was is None or _told(was) != before:
            return PlaceChanged(problem=_CHANGED)
    elif isinstance(change.put, MapThing) and _found(known, change.put) is not None:
        return PlaceChanged(problem=_CHANGED)
    if change.put is None:
        return PlaceChanged(problem=_CHANGED) if was is None else _Weighed(was, None)
    put = _place(change.put)
    if isinstance(put, MapObject) and not put.id:
        put = replace(put, id=new_id(put.description, known.objects))
    if isinstance(put, MapArea) and isinstance(was, MapArea):  # how many have room in it nobody draws
        put = replace(put, capacity=was.capacity)
    if problem := _problem(put, robots):
        return PlaceChanged(problem=problem)
    renamed = was is None or names_of(was)[0] != names_of(put)[0]
    same = same_name(known, names_of(put)[0], was) if renamed else ()
    own = isinstance(put, MapArea) and any(isinstance(place, MapArea) for place in same)
    if same and (own or not change.anyway):
        return PlaceChanged(same=tuple(_told(place) for place in same))
    return _Weighed(was, put)


def _problem(place: Place, robots: Sequence[str]) -> str:
    name = names_of(place)[0]
    if not name or len(name) > _LONGEST:
        return sentence("A name has 1 to {most} letters.", most=_LONGEST)
    if (why := reserved(name)) is not None:
        return why
    called = {robot.casefold() for robot in robots} & {key(name), *key(name).split()}
    if called:
        return sentence("“{words}” calls a robot, so it cannot mean anything else.", words=name)
    if isinstance(place, MapArea) and _area_m2(place) < _SMALLEST_ROOM_M2:
        return sentence("A room needs at least three corners that are not in one line.")
    return ""


def _area_m2(area: MapArea) -> float:
    sides = zip(area.corners, area.corners[1:] + area.corners[:1], strict=True)
    return abs(sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in sides)) / 2


def _found(known: ObjectMap, told: MapRoom | MapThing) -> Place | None:
    """What is meant, as it is on the map now."""
    if isinstance(told, MapThing):
        return known.get(told.id)
    return next((area for area in known.areas if area.name == told.name), None)


def _told(place: Place) -> MapRoom | MapThing:
    return thing_of(place) if isinstance(place, MapObject) else room_of(place)


def _place(told: MapRoom | MapThing) -> Place:
    if isinstance(told, MapRoom):
        return MapArea(" ".join(told.name.split()), told.corners)
    stand = Pose2D(told.stand.x, told.stand.y, told.stand.yaw) if told.stand is not None else None
    return MapObject(
        told.id, " ".join(told.description.split()), told.x, told.y, told.kind, told.width, told.height,
        told.aliases, told.front, stand,
    )  # fmt: skip


def _facts(place: Place) -> dict[str, Any]:
    """What the log keeps of a place."""
    x, y = middle_of(place)
    return {"id": key_of(place), "name": names_of(place)[0], "x": round(x, 2), "y": round(y, 2)}
