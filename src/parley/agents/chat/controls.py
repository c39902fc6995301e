"""Words of control: stop, go on, leave out, drop. They act at once, ahead of anything that is understood."""

from __future__ import annotations

import uuid
from collections import Counter
from collections.abc import Sequence
from typing import Final

from parley.agents.base import Node
from parley.agents.chat import texts
from parley.agents.chat.about_rules import AboutRules
from parley.agents.chat.answering import Answering
from parley.agents.chat.holds import Holds
from parley.agents.chat.mission_board import MissionBoard
from parley.agents.chat.missions import Missions
from parley.agents.chat.situations import Situations
from parley.agents.planner.asking import SHALL_I, Offered, wish_of
from parley.agents.planner.steps import LATCHED
from parley.agents.presence import Presence
from parley.agents.thinking import Thinking
from parley.gate.control import Control
from parley.gate.orders import engine
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.status import PlanDecision, PlanProposal, StopCommand
from parley.messages.team import MissionPart
from parley.sentences import listed, sentence, together
from parley.team.halting import halting

__all__ = ["HALTING", "Controls"]

HALTING: Final = ("stop", "clear", "emergency_stop")
"""Controls after which nothing that was said before may still set a robot in motion."""
STAND_ON: Final = "That lets nobody but those go on whom you have stopped; {robots} still stands."
_MISSION: Final = "mission"
_AGAIN: Final = {"again", "retry"}


class Controls:
    """Stops robots and lets them go on, and says so.

    Args:
        node: Speaks; what a robot is asked to drop is asked in its name.
        known: What each robot is at.
        presence: Which robots there are.
        holds: Who stands until something is settled.
        offered: What waits for a yes.
        thinking: What is still being understood.
        rules: Asks about rules, and asks again.
        answering: Says things, and hands orders over.
        board: Which missions there are.
        missions: What teams are told.
    """

    def __init__(
        self,
        node: Node,
        *,
        known: Situations,
        presence: Presence,
        holds: Holds,
        offered: Offered,
        thinking: Thinking,
        rules: AboutRules,
        answering: Answering,
        board: MissionBoard,
        missions: Missions,
    ) -> None:
        self._node, self._known, self._presence, self._holds = node, known, presence, holds
        self._offered, self._thinking, self._rules = offered, thinking, rules
        self._answering, self._board, self._missions = answering, board, missions
        self._halts: Counter[str] = Counter()

    def halts(self) -> dict[str, int]:
        """How often each robot was told to stop, now."""
        return dict(self._halts)

    def halt(self, target: str) -> None:
        """Give up what is being understood for a robot: nothing that was said before may move it."""
        self._halts[target] += 1
        self._thinking.give_up(target)

    def act(self, target: str, control: Control, said: ChatInput, *, more: bool | None = None) -> None:
        """Act at once.

        Args:
            target: The robot.
            control: What to do.
            said: The words.
            more: Whether nobody reads what else is in them; None: there is hardly more in it.
        """
        self._call_off(target, control, said)
        if control in HALTING:
            self.halt(target)
            self._known.on_stop(target, said)
            if control == "stop" and self._known.moves(target, self._presence.get(target)):
                self._holds.keep(target, said)
        state, status = self._known.state(target), self._presence.get(target)
        offered = self._offered.newest(target)
        latched = control == "start" and status is not None and status.state == "stopped"
        reply = LATCHED if latched else self._nothing_to_do(target, control, said)
        if control == "start" and not latched and offered and self._goes_on_with(offered, state):
            self._say_yes(target, offered, said)
            return
        if control == "emergency_stop":
            stop = StopCommand(targets=(target,), id=uuid.uuid4().hex, by=said.who, words=said.message)
            self._node.publish(topics.STOP, stop)
        elif control in HALTING or not reply:  # a stop is sent in any case: the plan may be newer than known
            self._send(target, control, said)
        self._reply(target, control, said, reply or texts.CONTROL_REPLIES[control], state, more)

    def act_or_ask(self, target: str, control: Control, said: ChatInput) -> None:
        """Act at once, unless it would drop what somebody else told the robot."""
        if control == "clear" and (whose := self._known.of_others(target, said)):
            self._call_off(target, control, said)
            self._ask_to_drop(target, whose, said)
        else:
            self.act(target, control, said)

    def _goes_on_with(self, offered: PlanProposal, state: str) -> bool:
        """Whether to go on means to do what waits, which is in no doubt where a robot stands in its work."""
        asked = state == "paused" and self._offered.is_asked(offered.target) and not offered.why
        return asked or state in ("awaiting_approval", "held")

    def _nothing_to_do(self, target: str, control: Control, said: ChatInput) -> str:
        state, status = self._known.state(target), self._presence.get(target)
        if state == "idle":  # where its engine holds a graph, that is no plan of ours
            nothing = status is None or status.state != "paused"
        else:  # a plan that waits for approval has no step yet: only approving or dropping it does anything
            nothing = state == "awaiting_approval" and control in ("stop", "skip")
        return texts.nothing_to_do(control, said.message) if nothing else ""

    def _say_yes(self, target: str, offered: PlanProposal, said: ChatInput) -> None:
        yes = PlanDecision(
            id=offered.id, target=target, decision="approve", digest=offered.digest, by=said.who
        )
        self.hand_on(target, yes, said)

    def _send(self, target: str, control: Control, said: ChatInput) -> None:
        held = control == "start" and self._known.state(target) == "held"
        command = SystemCommand(
            command="skip" if held and self._offers_past(target, said.message) else control
        )
        order = ChatAction(
            system_cmd=(command,), targets=(target,), by=said.who, words=said.message, reply_to=said.id
        )
        self._node.publish(topics.CHAT_ACTION, order)

    def _reply(
        self, target: str, control: Control, said: ChatInput, reply: str, state: str, more: bool | None
    ) -> None:
        """Say what was done where a robot was in `state`."""
        if control == "start" and state == "paused" and self._offered.newest(target) is not None:
            reply = together(sentence(reply), texts.STILL_ASKED)
        if control == "start" and state != "idle" and self._rules.stands(target):
            reply = texts.AFTER_ANSWER
        if control == "start" and (still := self._called_but_still(target, said)):
            reply = together(sentence(reply), sentence(STAND_ON, robots=", ".join(still)))
        hardly = more is None and control == "stop"
        longest = texts.FEW_WORDS if more else texts.TALK_WORDS if hardly else texts.MAX_CHARS
        if len(said.message.split()) > longest:  # there may be an order in it
            reply = together(sentence(reply), texts.REST_LEFT)
        self._known.note(target, said.message, reply)
        asked = self._known.questions.newest(target) if state == "held" else None
        closes = asked.id if asked is not None and not self._rules.asked(asked.id) else ""
        told = ChatFeedback(
            message=self._node.spoken(reply), targets=(target,), closes=closes, reply_to=said.id
        )
        self._node.publish(topics.CHAT_FEEDBACK, told)
        self._rules.ask_again(target, said)

    def _ask_to_drop(self, target: str, whose: Sequence[str], said: ChatInput, order: str = "") -> None:
        """Of what somebody else told a robot: it stands at once, and gives it up after a yes."""
        self._missions.keep_part(target)
        self.act(target, "stop", said)
        drop = SystemCommand(command="clear", arguments={"order": order} if order else {})
        asked = ChatAction(
            system_cmd=(drop,), targets=(target,),
            by=engine(self._node.name), behalf=said.who, words=said.message,
            needs_yes=sentence("{people} told me to do this", people=listed(whose)),
        )  # fmt: skip
        self._node.spawn(self._answering.hand_over(asked, target, said), name=f"dropping for {target}")

    def drop_part(self, part: MissionPart, said: ChatInput) -> None:
        """Drop what a robot still does of a mission, and nothing else of it."""
        if whose := self._known.of_others(part.robot, said):
            self._ask_to_drop(part.robot, whose, said, part.order)
        else:
            self._board.drop(part, said)

    def _call_off(self, target: str, control: Control, said: ChatInput) -> None:
        """Drop the others' parts, too, where it is the mission that is to be dropped."""
        for part in (
            self._board.beside(target) if control == "clear" and _MISSION in said.message.lower() else ()
        ):
            self.drop_part(part, said)

    def hand_on(self, target: str, decision: PlanDecision, said: ChatInput) -> bool:
        """Whether a yes or no is handed on: if that was asked last; else the robot asks again."""
        offered = self._offered.newest(target)
        if decision.decision == "reject" or offered is None or self._offered.is_asked(target):
            self._node.publish(topics.PLAN_DECISION, decision)
            return True
        text = together(wish_of(offered.lines, offered.why), SHALL_I)
        self._answering.say((target,), text, "response", said.id, asks_yes=True)
        return False

    def tells_apart(self, said: ChatInput, control: Control | None) -> bool:
        """Whether some robots were told to stand or to go on, and others not; that is done then."""
        hearers = [name for target in said.targets if (name := self._presence.resolve(target))]
        told = halting(said.message, self._presence.ever(), hearers)
        if told is None or (control == "start" and len(told.goes) == len(self._presence.ever())):
            return False
        named = {*self._presence.named_in(said.message)}
        stands = [name for name in told.goes if self._known.state(name) == "paused"]
        lets_go = [name for name in stands if name in named or name in self.own_of_all(said)]
        drives = [name for name in told.goes if self._known.state(name) == "running"]
        for name in told.stops:  # also who is at nothing: what it is just being told is not done either
            self.act(name, "stop", said)
        for name in lets_go:
            self.act(name, "start", said)
        for name in drives:
            self._answering.say((name,), texts.CONTROL_REPLIES["start"], "response", said.id)
        if not (told.stops or lets_go or drives):
            several = stands or told.goes
            idle = "{robots} is not under way." if len(several) == 1 else "{robots} are not under way."
            text = sentence(STAND_ON if stands else idle, robots=", ".join(several))
            self._answering.say(hearers[:1], text, "response", said.id)
        return True

    def own_of_all(self, said: ChatInput) -> list[str]:
        """Those of all that are called who stand because whoever calls them told them to."""
        called = self._presence.called_in(said.message)
        return [name for name in called if self._known.stands_for(name, said.who)]

    def _called_but_still(self, target: str, said: ChatInput) -> list[str]:
        """Who stands on though all were called: with all one only lets go on whom one has stopped oneself."""
        others = {*self._presence.called_in(said.message)} - {target, *said.targets, *self.own_of_all(said)}
        return sorted(name for name in others if self._known.state(name) == "paused")

    def _offers_past(self, target: str, message: str) -> bool:
        """Whether "go on" means to leave what was seen as it is: a robot asks just that."""
        asked = self._known.questions.newest(target)
        return asked is not None and "go on" in asked.choices and not _AGAIN & {*message.lower().split()}
