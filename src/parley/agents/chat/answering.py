"""From a message to an order and to a reply that says what really became of it."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractAsyncContextManager
from dataclasses import replace

from parley.agents.base import Node
from parley.agents.chat import texts
from parley.agents.chat.drafts import Drafts
from parley.agents.chat.memories import Confirmations, keeping_order
from parley.agents.chat.recollections import Recollections
from parley.agents.chat.rulings import Rulings
from parley.agents.chat.situations import Situations
from parley.agents.planner.asking import SHALL_I, wish_of
from parley.agents.planner.check import check_calls, complete_calls
from parley.agents.presence import Presence
from parley.agents.thinking import DroppedError, Thinking
from parley.clock import Clock
from parley.errors import LanguageError
from parley.gate.orders import UNSURE_OF_ALL, Admitted, Heard, admit
from parley.language.base import Language, Situation
from parley.language.dialogue.facts import kept_in_mind
from parley.language.dialogue.state import Asked
from parley.memory.sayings import for_oneself
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.completing import bound_to_steps, completed_answer
from parley.messages.status import ActionInfo, PlanProposal, PlanRuling
from parley.sentences import together

__all__ = ["Answering"]


class Answering:
    """Understands messages, hands orders on, and says just what was done.

    Args:
        node: Whose topics and language.
        language: What understands.
        clock: Wall time.
        known: What was heard of each robot.
        presence: Who is there.
        thinking: How long understanding may take.
        recollections: Says why something is so.
        confirmations: Hears what the memory kept.
        halts: How often a robot was told to stop: what was asked for before that is dropped.
        offered: What of a robot waits for a yes.
        has_rules: Whether there are rules by which an order may be refused.
    """

    def __init__(
        self,
        node: Node,
        language: Language,
        clock: Clock,
        *,
        known: Situations,
        presence: Presence,
        thinking: Thinking,
        recollections: Recollections,
        confirmations: Confirmations,
        halts: Callable[[str], int],
        offered: Callable[[str], PlanProposal | None],
        has_rules: Callable[[], bool],
    ) -> None:
        self._node, self._language, self._clock = node, language, clock
        self._known, self._presence, self._thinking = known, presence, thinking
        self._recollections, self._confirmations = recollections, confirmations
        self._offered, self._has_rules = offered, has_rules
        self._halts, self._rulings = halts, Rulings(node.transport)

    async def open(self) -> None:
        """Hear what the planner rules; closed with the node."""
        await self._node.subscribe(topics.RULING, PlanRuling, self._rulings.on_ruling)

    def say(
        self, targets: Sequence[str], text: str, kind: str, reply_to: str = "", *, asks_yes: bool = False
    ) -> None:
        """Say one of our own sentences in the conversation with some robots."""
        feedback = ChatFeedback.model_validate(
            {
                "message": self._node.spoken(text),
                "targets": tuple(targets),
                "type": kind,
                "reply_to": reply_to,
                "asks_yes": asks_yes,
                "still_asks": self._known.log(targets[0]).still_asks
                if len(targets) == 1 and reply_to
                else "",
            }
        )
        self._node.publish(topics.CHAT_FEEDBACK, feedback)

    def still_thinking(self, target: str, message: str, newer: str = "") -> None:
        """Say that a message takes long, and perhaps that a newer one waits behind it."""
        text = texts.still_thinking(message, newer)
        feedback = ChatFeedback(
            message=self._node.spoken(text), targets=(target,), type="info", choices=(texts.NEVER_MIND,)
        )
        self._node.publish(topics.CHAT_FEEDBACK, feedback)

    async def answer(self, target: str, said: ChatInput, halts: Mapping[str, int]) -> None:
        """Understand a message and do what it says.

        Args:
            target: The robot it was said to.
            said: The message.
            halts: How often each robot had been told to stop when it was said.
        """
        message = said.message
        own = for_oneself(message)
        # What may have to wait for a yes, or be forbidden, is not announced while it is being worked out.
        drafts = Drafts(
            "" if self._known.may_have_to_ask(target) or self._has_rules() else said.id,
            target,
            lambda draft: self._node.publish(topics.REPLY_DRAFT, draft),
            self._clock,
        )
        try:
            async with self.thinking(target, said):
                situation = await self._known.of(
                    target, own or message, said, sees_pictures=self._language.sees_pictures,
                    proposal=self._offered(target),
                )  # fmt: skip
                understood = keeping_order(situation) or await self._language.interpret(
                    situation, on_draft=drafts
                )
        except (LanguageError, TimeoutError) as error:
            self.not_understood(target, said, halts, error)
            return
        if understood.offer and not understood.queue:  # the gate asks for a yes: it is not certain
            why = understood.needs_yes or UNSURE_OF_ALL
            understood = understood.model_copy(update={"queue": understood.offer, "needs_yes": why})
        wants = understood.queue or understood.system_cmd or understood.others
        if wants and self.halted_since(halts, target):
            self.say((target,), texts.left(message), "response", said.id)
            return
        heard = self._heard(target, said, situation, understood, own=bool(own))
        admitted = admit(bound_to_steps(understood, situation.steps), heard)
        if understood.targets and not admitted.order.targets:  # it is not for whoever hears it, then
            self.say((target,), admitted.refused[0], "response", said.id)
            return
        order = self.trusted(target, admitted.order)
        if order is None:
            self.say((target,), texts.CANNOT, "error", said.id)
            return
        for other in admitted.others:
            if not self.halted_since(halts, other.targets[0]):
                self._node.spawn(self.hand_over(other, target, said), name=f"order for {other.targets[0]}")
        order = self._own_share(order, target, said)
        if not order.targets:
            text = admitted.refused[0] if admitted.refused else texts.that_is_for(understood.targets)
            self.say((target,), text, "response", said.id)
            return
        await self._carry_out(target, said, understood, replace(admitted, order=order), situation)

    def thinking(self, target: str, said: ChatInput) -> AbstractAsyncContextManager[None]:
        """Around the work of understanding a message; see `Thinking.about`."""
        return self._thinking.about(target, lambda: self.still_thinking(target, said.message), said.message)

    def not_understood(
        self, target: str, said: ChatInput, halts: Mapping[str, int], error: LanguageError | TimeoutError
    ) -> None:
        """Say that nothing came of a message, and why."""
        if isinstance(error, DroppedError):
            self.say((target,), texts.dropped(said.message), "response", said.id)
            return
        if isinstance(error, TimeoutError) and self.halted_since(halts, target):
            self.say((target,), texts.left(said.message), "response", said.id)
            return
        self._node.log.warning("not understood", target=target, error=repr(error))
        plain = error.plain if isinstance(error, LanguageError) else ""
        self.say((target,), texts.nothing_started(plain), "error", said.id)

    def halted_since(self, halts: Mapping[str, int], target: str) -> bool:
        """Whether a robot was told to stop since `halts` were counted."""
        return halts.get(target, 0) != self._halts(target)

    async def hand_over(self, other: ChatAction, target: str, said: ChatInput) -> None:
        """Hand on what another robot is to do, and let it say if it cannot, or asks first."""
        order, name = self.trusted(target, other), other.targets[0]
        if order is None or not self._presence.is_there(name):
            self.say((name,), texts.CANNOT if order is None else texts.not_there(name), "error")
            return
        order = order.model_copy(update={"id": uuid.uuid4().hex, "reply_to": said.id})
        for ruling in await self.submit(order, said) or ():
            if ruling.outcome == "asked":
                text = together(wish_of(ruling.lines, ruling.why), SHALL_I)
                self.say((name,), text, "info", asks_yes=True)

    async def submit(self, order: ChatAction, said: ChatInput, why: str = "") -> Sequence[PlanRuling] | None:
        """Hand an order with an id on, `why` it is this robot; what became of it, see `Rulings.about`."""
        self._rulings.expect(order)
        self._order(order, said, why)
        return await self._rulings.about(order)

    async def _carry_out(
        self, target: str, said: ChatInput, understood: ChatAction, admitted: Admitted, situation: Situation
    ) -> None:
        """Hand an order on, hear what became of it, and say just that."""
        words = _ordered(understood, situation) or admitted.order.words
        order = admitted.order.model_copy(
            update={"id": uuid.uuid4().hex, "reply_to": said.id, "words": words}
        )
        wanted = [
            command
            for command in order.system_cmd
            if command.command == "add_memory" or (command.command == "remove_memory" and not order.needs_yes)
        ]
        confirmations = [self._confirmations.wait_for(str(c.arguments["name"])) for c in wanted]
        self._rulings.expect(order)
        if order.queue or order.system_cmd or order.replaces:
            self._order(order, said)
        failed = await self._confirmations.confirmed(confirmations)
        rulings = await self._rulings.about(order)
        asked = next((ruling for ruling in rulings or () if ruling.outcome == "asked"), None)
        reply = failed or understood.message_response or "Done."
        if not failed:
            reply = self._honest(target, reply, order, admitted, rulings)
        refused = bool(rulings) and all(ruling.outcome == "refused" for ruling in rulings or ())
        if not failed and not refused and self._waits_behind_a_question(order, situation):
            reply = together(reply, texts.AFTERWARDS)
        if not (order.queue or order.system_cmd or order.replaces or understood.choices):
            reply = texts.still_standing(reply, said.message, paused=self._known.state(target) == "paused")
        speakers = order.targets if order.queue or not (order.system_cmd or order.replaces) else (target,)
        if target not in speakers:
            self.say((target,), texts.that_is_for(speakers), "response", said.id)
        for speaker in speakers:
            self._known.note(speaker, said.message, reply)
        if order.alarm:
            self.say(self._presence.names(), texts.alarm(target, said.message), "error")
        told = {str(command.arguments.get("name")) for command in order.system_cmd}
        known = {entry.name for entry in situation.memory}
        sources = tuple(name for name in understood.sources if name in known and name not in told)
        why = "" if failed else self._recollections.why(target, said, sources, situation.memory)
        asks_yes = asked is not None and not failed
        reply = together(reply, why, SHALL_I if asks_yes else "")
        left, unsettled = understood.left_open, not understood.queue and asked is None
        offers = unsettled and bool(understood.choices)
        lacks = bool(left.where) or texts.asks_back(understood.message_response)
        asks = offers or (unsettled and lacks and understood.message_response in reply)
        if offers or left.where or order.alarm:
            about = Asked(left.about or said.message, understood.choices, left.where, order.alarm)
            for name in {target, *speakers}:  # it may be answered where it was said, too
                self._known.log(name).on_asked(about, said.id if asks else "")
        self._known.log(target).lacks = asks
        self._known.log(target).on_left_open(said.message, left)
        self._node.publish(
            topics.CHAT_FEEDBACK,
            ChatFeedback(
                message=self._node.spoken(reply),
                targets=speakers,
                type="error" if failed else "response",
                sources=tuple(name for name in understood.sources if name in known | told),
                choices=understood.choices if offers else (),
                asks=asks,
                asks_yes=asks_yes,
                still_asks="" if asks else self._known.log(speakers[0]).still_asks,
                reply_to=said.id,
                engine=understood.engine,
            ),
        )
        for command in order.system_cmd if not failed else ():
            if command.arguments.get("name") in admitted.concluded:
                self._show_concluded(target, command)

    def _honest(
        self,
        target: str,
        reply: str,
        order: ChatAction,
        admitted: Admitted,
        rulings: Sequence[PlanRuling] | None,
    ) -> str:
        """The engine's reply where what it says was done; else what was done instead, in our words."""
        if rulings is None:
            return texts.UNSURE
        asked = next((ruling for ruling in rulings if ruling.outcome == "asked"), None)
        if asked is not None:
            return together(kept_in_mind(order.left_open.told), wish_of(asked.lines, asked.why))
        if rulings and all(ruling.outcome == "refused" for ruling in rulings):
            return together(texts.NOT_DONE, *admitted.refused)
        if admitted.resumes and not order.queue:
            return texts.SAY_CARRY_ON if self._known.state(target) != "idle" else texts.NOTHING_TO_RESUME
        return together(reply, *admitted.refused)

    def _heard(
        self, target: str, said: ChatInput, situation: Situation, understood: ChatAction, *, own: bool
    ) -> Heard:
        order = _ordered(understood, situation)
        return Heard(
            words=said.message,
            by=said.who,
            robot=target,
            named=tuple(
                name for name in self._presence.named_in(f"{said.message} {order}") if name != target
            ),
            engine=understood.engine or self._language.label,
            own=own,
            known=situation.memory,
            earlier=tuple(turn.content for turn in situation.history if turn.role == "operator"),
        )

    def _show_concluded(self, target: str, command: SystemCommand) -> None:
        """What an engine adds by itself is shown, and undone by a tap."""
        name, data = str(command.arguments["name"]), str(command.arguments.get("data", ""))
        if command.arguments.get("type") == "image":
            data = name
        feedback = ChatFeedback(
            message=self._node.spoken(texts.concluded(data)),
            targets=(target,),
            type="info",
            choices=(self._node.spoken(texts.undo(name)),),
        )
        self._node.publish(topics.CHAT_FEEDBACK, feedback)

    def _order(self, order: ChatAction, said: ChatInput, why: str = "") -> None:
        self._known.on_order(said, order, why)
        self._node.publish(topics.CHAT_ACTION, order)

    def _waits_behind_a_question(self, order: ChatAction, situation: Situation) -> bool:
        """Whether an order is kept until the robot's question about a failed step is answered."""
        held = self._known.state(situation.robot) == "held" and bool(situation.question)
        control = {command.command for command in order.system_cmd} - {"add_memory", "remove_memory"}
        return held and situation.robot in order.targets and bool(order.queue) and not control

    def trusted(self, target: str, understood: ChatAction) -> ChatAction | None:
        """The order with its addressees, if each robot named can carry it out; None if not."""
        named = [self._presence.resolve(name) for name in understood.targets]
        targets = tuple(name for name in named if name is not None) or (target,)
        if None in named:
            return None
        catalogue: tuple[ActionInfo, ...] = ()
        for name in targets:
            status = self._presence.get(name)
            catalogue = catalogue or (status.catalogue if status is not None else ())
            if status is None or not status.catalogue or not understood.queue:
                continue
            problems = check_calls(complete_calls(understood.queue, status.catalogue), status.catalogue)
            if problems:
                self._node.log.warning(
                    "plan refused", target=name, problems=[str(problem) for problem in problems]
                )
                return None
        whole = completed_answer(understood, catalogue)
        return whole.model_copy(update={"targets": targets})

    def _own_share(self, order: ChatAction, target: str, said: ChatInput) -> ChatAction:
        """The order without the other robots that got the same message: each of them reads it for itself."""
        others = {self._presence.resolve(name) for name in said.targets} - {target}
        left = tuple(name for name in order.targets if name not in others)
        return order.model_copy(update={"targets": left})


def _ordered(understood: ChatAction, situation: Situation) -> str:
    """The order that a message answers what was asked back about, if it does: that is what was wanted."""
    asked, about = situation.dialogue.asked, understood.left_open.about
    if asked is None or not understood.queue:
        return ""
    answers = situation.message.strip(" .!").casefold() in {choice.casefold() for choice in asked.choices}
    return asked.words if answers or about == asked.words else ""
