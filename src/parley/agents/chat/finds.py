"""Where one robot of a team finds what others still look for, it is asked whether they leave that out."""

from __future__ import annotations

import uuid
from typing import Final

from parley.agents.base import Node
from parley.agents.chat.answering import Answering
from parley.agents.chat.mission_board import MissionBoard
from parley.agents.chat.situations import Situations
from parley.agents.planner.asking import SHALL_I, wish_of
from parley.gate.evidence import speaks_of_searching
from parley.gate.orders import engine
from parley.language.base import Language
from parley.latest import Latest
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatInput, SystemCommand
from parley.messages.memory import AddToMemory
from parley.messages.status import PlanUpdate
from parley.messages.team import MissionInfo, MissionPart
from parley.sentences import sentence, together
from parley.team.finds import is_that, needless, sought

__all__ = ["Finds"]

_SIGHTING: Final = "_sighting"


class Finds:
    """What robots find while teams look for it.

    Args:
        node: Whose topics and language.
        answering: Hands orders on.
        known: What was heard of each robot.
        board: Follows what has become of the work of teams.
        language: In whose name it happens.
    """

    def __init__(
        self, node: Node, answering: Answering, known: Situations, board: MissionBoard, language: Language
    ) -> None:
        self._node, self._answering, self._known = node, answering, known
        self._board, self._language = board, language
        self._seen: Latest[str, set[str]] = Latest()
        """By robot what it has seen since it began its newest look."""
        self._looks: Latest[str, str] = Latest()
        """By robot that look."""
        self._told: Latest[tuple[str, str], None] = Latest()
        """What was found, by mission."""

    async def open(self) -> None:
        """Hear what robots see; closed with the node."""
        await self._node.subscribe(topics.ADD_TO_MEMORY, AddToMemory, self._on_remembered)

    def _on_remembered(self, told: AddToMemory) -> None:
        for entry in told.entries():
            robot, by_action, _ = entry.source.partition("/")
            if by_action and entry.name.endswith(_SIGHTING):
                self._seen.setdefault(robot, set()).add(entry.name.removesuffix(_SIGHTING))
                self._compare(robot)

    def on_plan(self, update: PlanUpdate) -> None:
        """A robot's plan changed: it has begun to look, or has looked."""
        robot, catalogue = update.target, self._known.catalogue(update.target)
        for step in update.steps:
            looks = step.state == "running" and sought(step.action, catalogue)
            if looks and self._looks.get(robot) != step.id:
                self._looks[robot] = step.id
                self._seen.pop(robot, None)
        self._compare(robot)

    def _compare(self, robot: str) -> None:
        """A look that alarms or misses what it looks for does not finish; what is found then ends nothing."""
        plan, look = self._known.plans.get(robot), self._looks.get(robot)
        for step in plan.steps if plan is not None else ():
            what = sought(step.action, self._known.catalogue(robot)) if step.id == look else ""
            if step.state != "finished" or not any(is_that(seen, what) for seen in self._seen.get(robot, ())):
                continue
            mission = self._board.of(step.order)
            if mission is None or not speaks_of_searching(mission.words):
                continue
            if (mission.id, what) not in self._told:
                self._told[mission.id, what] = None
                for part in mission.parts:
                    self._node.spawn(self._offer(robot, what, mission, part), name=f"find of {robot}")

    async def _offer(self, robot: str, what: str, mission: MissionInfo, part: MissionPart) -> None:
        """Ask whether the rest of the search is left out; until then it goes on."""
        plan = self._known.plans.get(part.robot)
        own = [step for step in plan.steps if step.order == part.order] if plan is not None else []
        left = needless(own, self._known.catalogue(part.robot), what)
        if not left:
            return
        order = ChatAction(
            # From behind, so that the step in progress is ended when nothing of the search could follow it.
            system_cmd=tuple(
                SystemCommand(command="pop", arguments={"step": step.id}) for step in reversed(left)
            ),
            targets=(part.robot,),
            by=engine(self._language.label),
            behalf=mission.by,
            words=mission.words,
            needs_yes=sentence("{robot} has found “{what}”", robot=robot, what=what),
            id=uuid.uuid4().hex,
        )
        said = ChatInput(message=mission.words, targets=(part.robot,), by=mission.by)
        for ruling in await self._answering.submit(order, said) or ():
            if ruling.outcome == "asked":
                text = together(wish_of(ruling.lines, ruling.why), SHALL_I)
                self._answering.say((part.robot,), text, "info", asks_yes=True)
