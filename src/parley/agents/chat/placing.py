"""What the chat does about places that people name where a robot stands: asks, and puts them on its map.

Wiring only; what a message names is read in `parley.agents.chat.place_names`, before any language engine
sees it, and what may be put on the map is decided where it is kept (`parley.agents.places`).
"""

from __future__ import annotations

import math
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from parley.agents.base import Node
from parley.agents.chat.place_names import corrected_place, forgotten_place, named_here, taken_off
from parley.agents.chat.situations import Situations
from parley.agents.display.map_service import room_of, thing_of
from parley.agents.presence import Presence
from parley.errors import InvalidMessageError, TransportError
from parley.gate.assent import assent_of
from parley.gate.table import Effect, verdict
from parley.latest import Latest
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.map import MapRoom, MapThing, PlaceChange, PlaceChanged
from parley.messages.ros import ChatRequest
from parley.messages.status import PoseInfo
from parley.messages.wire import decode, encode
from parley.sentences import sentence, together
from parley.world.object_map import PLACE, MapArea, MapObject, ObjectMap
from parley.world.placed import same_name

__all__ = ["Placing"]

_KEPT: Final = 100
_WITHIN_S: Final = 10.0
_HERE_M: Final = 1.0
"""What is no farther away stands where the robot stands."""
_YES: Final = "yes"
_ALL_RIGHT: Final = "All right?"
_AS_IT_WAS: Final = "All right, the map stays as it is."
_MAY_NOT: Final = "Only supervisors put names on the map."
_MOVES: Final = "I am under way. Tell me again when I stand there."
_LOST: Final = "I do not know where I am, so I cannot put anything on the map."
_ONE: Final = "Tell that to one of us only: to the one that stands there."
_NOT_NOW: Final = "The map cannot be changed just now. Please say it again later."


@dataclass(frozen=True, slots=True)
class _Asked:
    """A change that waits for a yes."""

    change: PlaceChange
    text: str


class Placing:
    """Helper of one chat interface.

    Args:
        node: Through whom it speaks.
        known: What is known of each robot.
        presence: Which robots there are, and where.
    """

    def __init__(self, node: Node, known: Situations, presence: Presence) -> None:
        self._node, self._known, self._presence = node, known, presence
        self._asked: Latest[str, _Asked] = Latest(_KEPT)
        self._noted: dict[str, MapThing] = {}
        """What each robot put on the map last, as long as nothing else was said to it."""

    def asked(self, question: str) -> bool:
        """Whether this question is one of ours."""
        return question in self._asked

    async def handles(self, target: str, said: ChatInput, answers: str, team: Sequence[str] = ()) -> bool:
        """Do what a message says of places, if it does; whether nothing is left to do.

        Args:
            target: The robot that is spoken to.
            said: The message.
            answers: The question of ours that it answers, if it does.
            team: All robots that it is said to.
        """
        noted = self._noted.pop(target, None)
        if self.asked(answers):
            return await self._answer(answers, target, said)
        if noted is not None and (name := corrected_place(said.message)):
            await self._rename(noted, name, target, said)
            return True
        gone, off = forgotten_place(said.message), taken_off(said.message)
        if said.images or not (gone or off or named_here(said.message)):
            return False
        if gone and not (gone := self._is_ours(target, gone)):
            return False
        if verdict(said.who, Effect.MAP) != "allow" or not said.who.is_person:
            self._tell(target, said, _MAY_NOT, "error")
        elif name := gone or off:
            await self._forget(name, target, said)
        elif len(team) > 1:
            self._tell(target, said, _ONE)
        else:
            await self._name(named_here(said.message), target, said)
        return True

    def _map(self, target: str) -> ObjectMap:
        rooms = (room.area for room in self._known.rooms(target))
        return ObjectMap(tuple(self._known.objects(target)), tuple(room for room in rooms if room))

    def _is_ours(self, target: str, name: str) -> str:
        """The name, if it is that of a room or a place; "forget the chair" is about what was told of it."""
        found = same_name(self._map(target), name)
        ours = any(isinstance(place, MapArea) or place.class_name == PLACE for place in found)
        return name if ours else ""

    # -- asking --

    async def _name(self, name: str, target: str, said: ChatInput, closes: str = "") -> None:
        status = self._presence.get(target)
        if self._known.moves(target, status):
            self._tell(target, said, _MOVES)
            return
        pose = status.pose if status is not None else None
        if pose is None:
            self._tell(target, said, _LOST, "error")
            return
        place = MapThing(id="", kind=PLACE, description=name, x=pose.x, y=pose.y, stand=pose)
        change = PlaceChange(robot=target, put=place, words=said.message, by=said.who)
        tried = await self._change(change, only_try=True)
        if tried.problem:
            self._tell(target, said, tried.problem, "error")
        elif tried.same:
            self._there_already(tried.same[0], change, pose, said, closes)
        else:
            note = sentence("I note “{words}” here, where I stand.", words=name)
            self._ask(change, together(note, *tried.notes, _ALL_RIGHT), said, closes)

    def _there_already(
        self, same: MapRoom | MapThing, change: PlaceChange, pose: PoseInfo, said: ChatInput, closes: str
    ) -> None:
        """A name that is taken: is it here, or is it to be here from now on?"""
        if isinstance(same, MapRoom):
            inside = MapArea(same.name, same.corners).holds(pose.x, pose.y)
            here = sentence("I know: this is in “{words}”.", words=same.name)
            taken = sentence(
                "“{words}” is a room on my map already, and I am not in it. Give this place another name.",
                words=same.name,
            )
            self._tell(change.robot, said, here if inside else taken, closes=closes)
            return
        away_m = math.hypot(same.x - pose.x, same.y - pose.y)
        if away_m <= _HERE_M and same.stand is not None:
            text = sentence("I know: “{words}” is here.", words=same.description)
            self._tell(change.robot, said, text, closes=closes)
            return
        moved = same.model_copy(update={"x": pose.x, "y": pose.y, "stand": pose, "found": False})
        where = sentence(
            "“{words}” is on my map already, {metres} m from here. Shall I move it to where I stand?",
            words=same.description,
            metres=f"{away_m:.1f}",
        )
        self._ask(change.model_copy(update={"was": same, "put": moved}), where, said, closes)

    async def _rename(self, noted: MapThing, name: str, target: str, said: ChatInput) -> None:
        put = noted.model_copy(update={"description": name})
        change = PlaceChange(robot=target, was=noted, put=put, words=said.message, by=said.who)
        tried = await self._change(change, only_try=True)
        if tried.problem or tried.same:
            taken = sentence("“{words}” is on my map already, so I changed nothing.", words=name)
            self._tell(target, said, tried.problem or taken)
            return
        note = sentence("I note “{words}” here in place of “{before}”.", words=name, before=noted.description)
        self._ask(change, together(note, _ALL_RIGHT), said)

    async def _forget(self, name: str, target: str, said: ChatInput) -> None:
        found = same_name(self._map(target), name)
        if len(found) != 1:
            none = sentence("There is no “{words}” on my map.", words=name)
            several = sentence(
                "Several are called “{words}” on my map. Take the right one off on the page's map.",
                words=name,
            )
            self._tell(target, said, several if found else none)
            return
        was = thing_of(found[0]) if isinstance(found[0], MapObject) else room_of(found[0])
        change = PlaceChange(robot=target, was=was, words=said.message, by=said.who)
        self._ask(change, sentence("I take “{words}” off the map. All right?", words=name), said)

    def _ask(self, change: PlaceChange, text: str, said: ChatInput, closes: str = "") -> None:
        question = uuid.uuid4().hex
        self._asked[question] = _Asked(change, text)
        choices = (sentence(_YES), sentence("no"))
        self._say(change.robot, said, text, "request", question, choices, closes)

    # -- answers --

    async def _answer(self, question: str, target: str, said: ChatInput) -> bool:
        asked = self._asked[question]
        assent = assent_of(said.message, self._presence.names())
        name = corrected_place(said.message) if assent is None else ""
        if assent is None and not name:
            return False
        del self._asked[question]
        if name and asked.change.put is not None and asked.change.was is None:
            await self._name(name, target, said, closes=question)
        elif name and isinstance(asked.change.was, MapThing):
            self._say(target, said, _AS_IT_WAS, "response", closes=question)
            await self._rename(asked.change.was, name, target, said)
        elif assent:
            await self._do(asked.change.model_copy(update={"by": said.who}), question, said)
        else:
            self._say(target, said, _AS_IT_WAS, "response", closes=question)
        return True

    async def _do(self, change: PlaceChange, question: str, said: ChatInput) -> None:
        done = await self._change(change)
        if done.problem or done.same:
            self._say(change.robot, said, done.problem or _NOT_NOW, "error", closes=question)
            return
        if isinstance(done.put, MapThing):
            self._noted[change.robot] = done.put
            text = sentence("“{words}” is on the map now.", words=done.put.description)
        else:
            name = (
                change.was.name if isinstance(change.was, MapRoom) else change.was and change.was.description
            )
            text = sentence("“{words}” is off the map.", words=name)
        self._say(change.robot, said, text, "response", closes=question)

    async def _change(self, change: PlaceChange, *, only_try: bool = False) -> PlaceChanged:
        asked = change.model_copy(update={"what": "try"}) if only_try else change
        try:
            reply = await self._node.transport.call(
                topics.PLACES, ChatRequest(encode(asked)), timeout_s=_WITHIN_S
            )
            return decode(PlaceChanged, reply.response)
        except (TransportError, InvalidMessageError) as error:
            self._node.log.warning("the map is not changed", error=repr(error))
            return PlaceChanged(problem=_NOT_NOW)

    def _tell(
        self, target: str, said: ChatInput, text: str, kind: str = "response", closes: str = ""
    ) -> None:
        self._say(target, said, text, kind, closes=closes)

    def _say(
        self,
        target: str,
        said: ChatInput,
        text: str,
        kind: str,
        question: str = "",
        choices: Sequence[str] = (),
        closes: str = "",
    ) -> None:
        self._known.note(target, said.message, text)
        spoken = self._node.spoken
        feedback = ChatFeedback.model_validate(
            {
                "message": spoken(text),
                "targets": (target,),
                "type": kind,
                "id": question,
                "choices": tuple(map(spoken, choices)),
                "closes": closes,
                "reply_to": said.id,
            }
        )
        self._node.publish(topics.CHAT_FEEDBACK, feedback)
