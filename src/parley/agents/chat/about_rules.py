"""What people say about rules, heard before any language engine; code and a person's yes decide on it."""

from __future__ import annotations

from dataclasses import replace

from parley.agents.base import Node
from parley.agents.chat.holds import Holds
from parley.agents.chat.situations import Situations
from parley.agents.planner.asking import Offered
from parley.agents.presence import Presence
from parley.errors import FailureCode
from parley.gate.rule_talk import Listener, RuleReply, RuleTalk
from parley.language.dialogue.teaching import taught_in, with_names
from parley.memory.client import recall
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.status import PlanRuling
from parley.team.sharing import place_of

__all__ = ["AboutRules"]


class AboutRules:
    """Hears messages about rules and says what becomes of them.

    Args:
        node: Speaks, and has the transport.
        rules: Reads and keeps rules; None: nobody can make any.
        known: What each robot is at.
        presence: Which robots there are.
        holds: Who stands until an answer is there.
        offered: What waits for a yes.
    """

    def __init__(
        self,
        node: Node,
        rules: RuleTalk | None,
        known: Situations,
        presence: Presence,
        holds: Holds,
        offered: Offered,
    ) -> None:
        self._node, self._rules, self._known = node, rules, known
        self._presence, self._holds, self._offered = presence, holds, offered

    @property
    def has_rules(self) -> bool:
        """Whether there is any rule."""
        return self._rules is not None and self._rules.has_rules

    def asked(self, question: str) -> bool:
        """Whether a question, by its `id`, is one about rules."""
        return self._rules is not None and self._rules.asked(question)

    def stands(self, target: str) -> bool:
        """Whether a robot stands until what it has asked about a rule is answered."""
        return self._rules is not None and self._rules.stands(target)

    def on_failure(self, failure: ErrorHandlingMessage) -> None:
        """Take in which rule forbade a step that was under way."""
        if self._rules is not None and failure.code is FailureCode.FORBIDDEN:
            self._rules.refused(failure.target, [str(failure.details.get("rule", ""))])

    def on_ruling(self, ruling: PlanRuling) -> None:
        """Take in which rules forbade an order."""
        if self._rules is not None and (ruling.rules or ruling.outcome != "refused"):
            self._rules.refused(ruling.target, ruling.rules)

    async def handles(self, target: str, said: ChatInput, answers: str) -> bool:
        """Whether a message was about rules; it is answered then.

        Args:
            target: The robot.
            said: The message.
            answers: The `id` of our question that it answers; empty: of none.
        """
        if self._rules is None:
            return False
        to = self._listener(target)
        if self._rules.concerns(said.message, to):  # names of their own are names
            known = taught_in(await recall(self._node.transport, said.message, scope=target))
            to = replace(to, places=with_names(self._known.objects(target), known))
        reply = await self._rules.reply(said.message, said.who, to, answers=answers)
        if not reply:
            return False
        if (left := self._rules.left(answers)) is not None:  # first, so that a yes means what was told now
            self._reply(target, said, left)
        self._reply(target, said, reply, said.id)
        self._known.note(target, said.message, reply.text)
        return True

    def ask_again(self, target: str, said: ChatInput) -> None:
        """Whatever else is said, the robot stands until the answer, and says so."""
        if self._rules is not None and (reply := self._rules.again(target)) is not None:
            self._reply(target, said, reply)

    def _listener(self, target: str) -> Listener:
        status, offered = self._presence.get(target), self._offered.newest(target)
        waits = "; ".join(offered.lines) if offered is not None else ""
        last = self._known.log(target).newest_order
        return Listener(
            target,
            self._presence.names(),
            self._known.objects(target),
            status.catalogue if status else (),
            busy=self._known.state(target) != "idle",
            doing=self._known.doing(target) or waits,
            there=place_of(last.calls) if last is not None else "",
        )

    def _reply(self, target: str, said: ChatInput, reply: RuleReply, reply_to: str = "") -> None:
        feedback = ChatFeedback(
            message=self._node.spoken(reply.text), targets=(target,),
            type="request" if reply.id else "response",
            choices=tuple(map(self._node.spoken, reply.choices)), id=reply.id, closes=reply.closes,
            reply_to=reply_to, rules=reply.rules,
        )  # fmt: skip
        if reply.stands:
            self._holds.begin_for(reply.id, said, reply.stands)
        self._holds.end(reply.closes)
        self._node.publish(topics.CHAT_FEEDBACK, feedback)
