"""The lookout: does what operators taught for the case that something is seen, when an action tells of it.

"If you see a crack, stop and tell me" is about failures too, which the error handler takes care of; here is
what actions say that did not fail: their results, what they tell on the way, and what they remember.
"""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Sequence
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.agents.planner.steps import OPEN_STATES
from parley.clock import Clock
from parley.errors import InvalidMessageError, TransportError
from parley.language.dialogue.standing import StandingRule, read_sighting_rule, sighted
from parley.latest import Latest
from parley.memory.client import ask_memory
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, CommandName, SystemCommand
from parley.messages.memory import AddToMemory, GetMemory, MemoryEntry, MemoryEvent
from parley.messages.principal import Principal
from parley.messages.status import GraphEvent, PlanProposal, PlanUpdate
from parley.sentences import sentence, together
from parley.transport.base import Transport

__all__ = ["Lookout"]

_RULE_WORDS: Final = "protocol see notice spot discover find come across whenever"
"""Words of such rules, to find those of earlier days."""
_MOST_RULES: Final = 500
_STOPPED: Final = "So I have stopped. Say “carry on” when I should go on, or tell me what to do."
_WAITING: Final = "So I wait here. Please tell me what to do."
_TEXT_TYPES: Final = ("string", "strings")

_Key = tuple[str, str]
"""Name and scope of a memory."""


class Lookout(Node):
    """Compares what actions tell with the rules in the memory; each rule fires once in a step.

    Args:
        transport: Where the topics are.
        clock: Robot time, for rules that wait.
    """

    name: ClassVar[str] = "lookout"

    def __init__(self, transport: Transport, clock: Clock) -> None:
        super().__init__(transport)
        self._clock = clock
        self._rules: dict[_Key, tuple[StandingRule, MemoryEntry]] = {}
        self._fired: Latest[str, set[_Key]] = Latest()
        """What was done already in the steps that run, by robot."""
        self._plans: dict[str, PlanUpdate] = {}
        self._waits: dict[str, asyncio.Task[None]] = {}

    async def open(self) -> None:
        """See `Node.open`; the memory node should be there already."""
        await self.subscribe(topics.MEMORY_EVENT, MemoryEvent, self._on_memory)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._on_event)
        await self.subscribe(topics.ADD_TO_MEMORY, AddToMemory, self._on_remembered)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)
        await self.subscribe_plans(self._on_plan)
        self.spawn(
            self._learn(GetMemory(request=_RULE_WORDS, kind="search", limit=_MOST_RULES)), name="rules"
        )

    # -- the rules -------------------------------------------------------------------------------------

    def _on_memory(self, event: MemoryEvent) -> None:
        if event.kind == "failed":
            return
        for key in [key for key in self._rules if key[0] == event.name]:
            del self._rules[
                key
            ]  # one without a scope may have been forgotten in all: what holds is read anew
        self.spawn(self._learn(GetMemory(request=event.name, kind="named")), name="rule")

    async def _learn(self, request: GetMemory) -> None:
        wanted = request.model_copy(update={"type": "text", "pictures": False})
        try:
            entries = await ask_memory(self.transport, wanted)
        except (TransportError, InvalidMessageError) as error:
            self.log.warning("rules not read", error=str(error))
            return
        for entry in entries:
            rule = read_sighting_rule(entry.data) if entry.is_told else None
            if rule is not None:
                self._rules[entry.name, entry.scope] = (rule, entry)

    # -- what is told ----------------------------------------------------------------------------------

    def _on_event(self, event: GraphEvent) -> None:
        if event.kind == "node" and event.state == "RUNNING" and event.cause != "resume":
            self._fired.pop(event.actor, None)
        if self._rules and event.result != "on_error":
            self._compare(event.actor, _reports(event), event.node if event.result else "")

    def _on_remembered(self, message: AddToMemory) -> None:
        for entry in message.entries() if self._rules else ():
            robot, by_action, _ = entry.source.partition("/")
            if by_action:
                self._compare(robot, [entry.data if entry.type == "text" else entry.info])

    def _compare(self, robot: str, reports: Sequence[str], ended: str = "") -> None:
        fired = self._fired.setdefault(robot, set())
        for key, (rule, entry) in list(self._rules.items()) if reports else ():
            if entry.scope not in ("", robot) or key in fired:
                continue
            if seen := sighted(rule, reports):
                fired.add(key)
                self._carry_out(robot, rule, entry, seen, self._has_more(robot, ended))

    # -- what is done ----------------------------------------------------------------------------------

    def _carry_out(
        self, robot: str, rule: StandingRule, entry: MemoryEntry, seen: str, has_more: bool
    ) -> None:
        """Do what the rule says; going on and trying again are what happens anyway."""
        orders = [act.words for act in rule.acts if act.kind == "order"]
        if not orders and not any(rule.has(kind) for kind in ("stop", "tell", "cancel", "wait")):
            return
        then = sentence("")
        if rule.has("cancel"):
            self._command(robot, "clear", entry)
            then = sentence("So I drop the rest of the plan.")
        elif rule.has("stop"):
            then = sentence(_STOPPED if has_more else _WAITING)
            self._command(robot, "stop", entry)
        elif rule.delay_s and has_more:
            self._command(robot, "stop", entry)
            self._waits[robot] = self.spawn(
                self._go_on_later(robot, rule.delay_s, entry), name=f"waiting {robot}"
            )
            then = sentence("So I wait, and then go on.")
        elif orders:
            then = sentence("I do so now.")
        taught = sentence("{seen}. You told me: “{rule}”.", seen=seen.rstrip("."), rule=rule.sentence)
        told = self.spoken(together(taught, then))
        self.publish(
            topics.CHAT_FEEDBACK,
            ChatFeedback(message=told, targets=(robot,), type="info", sources=(entry.name,)),
        )
        for words in orders:
            order = ChatInput(message=words, targets=(robot,), id=uuid.uuid4().hex, by=_rule_of(entry))
            self.publish(topics.CHAT_INPUT, order)

    async def _go_on_later(self, robot: str, delay_s: float, entry: MemoryEntry) -> None:
        await self._clock.sleep(delay_s)
        self._waits.pop(robot, None)
        self._command(robot, "start", entry)

    def _on_input(self, said: ChatInput) -> None:
        """Whoever says something while a robot waits by a rule decides what follows."""
        for robot in said.targets or tuple(self._waits):
            if (wait := self._waits.pop(robot, None)) is not None:
                wait.cancel()

    def _on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        if isinstance(told, PlanUpdate):
            self._plans[told.target] = told

    def _has_more(self, robot: str, ended: str) -> bool:
        """Whether there is something left to do; that a step has `ended` the planner may not know yet."""
        plan = self._plans.get(robot)
        steps = plan.steps if plan is not None else ()
        return any(step.state in OPEN_STATES and (not ended or step.node != ended) for step in steps)

    def _command(self, robot: str, command: CommandName, entry: MemoryEntry) -> None:
        commands = (SystemCommand(command=command),)
        order = ChatAction(system_cmd=commands, targets=(robot,), by=_rule_of(entry), words=entry.data)
        self.publish(topics.CHAT_ACTION, order)


def _rule_of(entry: MemoryEntry) -> Principal:
    """The standing rule behind what is done, and whose it is."""
    return Principal(kind="rule", name=entry.source)


def _reports(event: GraphEvent) -> list[str]:
    """What an action says in an event: on the way, or in what it gives at its end."""
    texts = [event.progress_text] if event.progress_text else []
    for item in event.outputs.values() if event.kind == "node" else ():
        if item.has_data and item.type in _TEXT_TYPES:
            labels = (
                [item.value] if isinstance(item.value, str) else [f"I see: {label}" for label in item.value]
            )
            texts += labels
    return texts
