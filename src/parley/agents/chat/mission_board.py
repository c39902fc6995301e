"""Missions on their way to people: told whenever one changes, written down, closed with a sentence."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence

from parley.agents.base import Node
from parley.errors import StoreError
from parley.memory.missions import MissionStore
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.status import PlanProposal, PlanUpdate
from parley.messages.team import MissionInfo, MissionList, MissionPart
from parley.sentences import Sentence
from parley.team.mission import MissionBook

__all__ = ["MissionBoard"]


class MissionBoard:
    """What has become of all missions, for everybody.

    Args:
        node: Whose topics and language.
        store: Keeps them over restarts, closed by its owner; None keeps nothing.
    """

    def __init__(self, node: Node, store: MissionStore | None) -> None:
        self._node, self._store = node, store
        self._book = MissionBook(self._close)
        self._told: tuple[MissionInfo, ...] = ()
        self._writer: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Take up what an earlier process followed; closed with the node."""
        self._node.announce(topics.MISSIONS)
        await self._node.subscribe(topics.CHAT_ACTION, ChatAction, self._on_order)
        self._node.opened.push_async_callback(self._written)
        if self._store is not None:
            try:
                self._book.restore((await self._store.kept()).missions)
            except (StoreError, ValueError) as error:
                self._node.log.error("missions cannot be read", problem=str(error))
        self._show()

    def begin(self, info: MissionInfo) -> None:
        """A team is told to do something."""
        self._book.begin(info)
        self._show()

    def of(self, order: str) -> MissionInfo | None:
        """See `MissionBook.of`."""
        return self._book.of(order)

    def relieve(self, robot: str, others: Sequence[MissionPart]) -> bool:
        """See `MissionBook.relieve`."""
        found = self._book.relieve(robot, others)
        self._show()
        return found

    def beside(self, robot: str) -> list[MissionPart]:
        """See `MissionBook.beside`."""
        return self._book.beside(robot)

    def going(self, robot: str) -> MissionPart | None:
        """See `MissionBook.going`."""
        return self._book.going(robot)

    def progress(self, what: str, *, ended: bool) -> Sentence | None:
        """See `MissionBook.progress`."""
        return self._book.progress(what, ended=ended)

    def drop(self, part: MissionPart, said: ChatInput) -> None:
        """Drop what a robot still does of a mission, and nothing else of it."""
        drop = SystemCommand(command="clear", arguments={"order": part.order})
        order = ChatAction(
            system_cmd=(drop,), targets=(part.robot,), by=said.who, words=said.message, reply_to=said.id
        )
        self._node.publish(topics.CHAT_ACTION, order)

    def refuse(self, order: str) -> None:
        """A part is not done at all."""
        self._book.refuse(order)
        self._show()

    def on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        """The planner speaks."""
        if isinstance(told, PlanProposal):
            self._book.on_proposal(told)
        else:
            self._book.on_update(told)
        self._show()

    def on_presence(self, robot: str, joined: bool) -> None:
        """A robot came or left."""
        self._book.on_presence(robot, there=joined)
        self._show()

    def _on_order(self, order: ChatAction) -> None:
        for command in order.system_cmd:
            for robot in order.targets if command.command == "clear" and not order.needs_yes else ():
                self._book.drop(str(command.arguments.get("order", "")), robot)
        self._show()

    def _close(self, mission: MissionInfo, text: Sentence) -> str:
        robots = tuple(dict.fromkeys(part.robot for part in mission.parts))
        said = self._node.spoken(text)
        self._node.publish(topics.CHAT_FEEDBACK, ChatFeedback(message=said, targets=robots, type="info"))
        return said

    def _show(self) -> None:
        shown = self._book.shown
        if shown == self._told:
            return
        self._told = shown
        self._node.publish(topics.MISSIONS, MissionList(missions=shown))
        if self._store is not None and (self._writer is None or self._writer.done()):
            self._writer = asyncio.get_running_loop().create_task(self._write(self._store), name="missions")

    async def _write(self, store: MissionStore) -> None:
        written: tuple[MissionInfo, ...] | None = None
        while written != self._told:
            written = self._told
            try:
                await store.keep(MissionList(missions=written))
            except StoreError as error:
                self._node.log.error("missions not written", problem=str(error))

    async def _written(self) -> None:
        if self._writer is not None:
            await asyncio.wait([self._writer])
