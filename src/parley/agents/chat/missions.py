"""One order to a team: each robot's part passes the gate by itself, people are told of all in one."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from parley.agents.base import Node
from parley.agents.chat import texts
from parley.agents.chat.answering import Answering
from parley.agents.chat.mission_board import MissionBoard
from parley.agents.chat.situations import Situations
from parley.agents.chat.team import GIVES_UP, STOPPED, Mission, Share, TeamTalk
from parley.agents.planner.asking import SHALL_I, counted, wish_of
from parley.agents.planner.check import complete_calls
from parley.agents.presence import Presence
from parley.errors import LanguageError
from parley.gate.cards import labels_of, lines_of
from parley.gate.orders import Heard, admit
from parley.language.base import Language
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.questions import plain, question_of
from parley.language.dialogue.state import Order
from parley.latest import Latest
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.status import ActionInfo, PlanDecision, PlanRuling, PlanUpdate
from parley.messages.team import MissionInfo, MissionPart
from parley.sentences import Sentence, sentence, together
from parley.team.wish import TeamWish

__all__ = ["Missions"]


@dataclass(frozen=True, slots=True)
class _Decided:
    """How work was given out."""

    words: str
    reasons: Mapping[str, Sentence]
    """By robot its part and why it has it, if that was left to the robots."""
    behind: Order | None
    """What the robot that keeps this had been told last then."""


WOULD_DO: Final = sentence("This is how we would do it.")
DOES: Final = sentence("This is how we do it.")


class Missions:
    """Orders to teams.

    Args:
        node: Whose topics and language.
        talk: Understands them.
        answering: Hands orders on.
        known: What was heard of each robot.
        presence: Who is there.
        board: Where it is followed what becomes of them.
        language: In whose name it happens.
        hear: Has a robot hear words in its own conversation.
        drop: Drops a robot's part, after a yes if somebody else gave the order.
    """

    def __init__(
        self,
        node: Node,
        talk: TeamTalk,
        answering: Answering,
        known: Situations,
        presence: Presence,
        board: MissionBoard,
        language: Language,
        hear: Callable[[str, ChatInput], None],
        drop: Callable[[MissionPart, ChatInput], None],
    ) -> None:
        self._hear, self._drop = hear, drop
        self._node, self._talk, self._answering, self._board = node, talk, answering, board
        self._known, self._presence, self._language = known, presence, language
        self._mates: Latest[str, frozenset[str]] = Latest()
        """By robot who else was asked about in the same breath."""
        self._teams: Latest[str, tuple[str, ...]] = Latest()
        """By robot the team whose work it has a part of."""
        self._decided: Latest[str, _Decided] = Latest()
        """By robot the last work that it heard given out."""
        self._relieves: Latest[str, ChatAction] = Latest()
        """By robot what is given up once its yes is there."""
        self._told_of: Latest[tuple[str, str], bool] = Latest()
        """Which robots' parts were offered already, and in which graph."""

    def on_plan(self, update: PlanUpdate) -> None:
        """A robot's plan changed: where it stands, somebody else of the team may take its part over."""
        if update.state in ("held", "paused"):
            self._offer(update.target, update.graph_name)
        elif update.state == "idle":
            self._teams.pop(update.target, None)

    def on_presence(self, robot: str, joined: bool) -> None:
        """A robot came or left."""
        self._board.on_presence(robot, joined)
        if not joined:
            plan = self._known.plans.get(robot)
            self._offer(robot, f"gone from {plan.graph_name if plan is not None else ''}")

    def keep_part(self, robot: str) -> None:
        """Offer nobody else for a robot's part: it is asked about whether anybody shall do it."""
        plan = self._known.plans.get(robot)
        self._told_of[robot, plan.graph_name if plan is not None else ""] = True

    def _offer(self, robot: str, about: str) -> None:
        team = self._teams.get(robot)
        if team is not None and (robot, about) not in self._told_of:
            self._told_of[robot, about] = True
            self._node.spawn(self._offer_part(robot, team), name=f"part of {robot}")

    async def _offer_part(self, robot: str, team: Sequence[str]) -> None:
        """Ask whether another robot shall take over what a robot leaves undone; nothing is done by itself."""
        try:
            found = await self._talk.stand_in(robot, team)
        except LanguageError as error:
            self._node.log.warning("no part offered", robot=robot, error=repr(error))
            return
        if found is None or not self._talk.left(robot):
            return
        other, reason = found
        words = str(sentence("Let {other} take over from {robot}", other=other, robot=robot))
        text = sentence("{other} could do what is left of {robot}’s part ({why}). Say “{words}” if it shall.",
                        other=other, robot=robot, why=reason, words=words)  # fmt: skip
        feedback = ChatFeedback(
            message=self._node.spoken(text), targets=(robot, other), type="info", choices=(words,)
        )
        self._node.publish(topics.CHAT_FEEDBACK, feedback)

    def mates(self, robot: str) -> frozenset[str]:
        """Whose parts a yes or a no to this robot is meant for, too, if nothing else was said since; once."""
        return self._mates.pop(robot, frozenset()) - {robot}

    async def handles(
        self, target: str, said: ChatInput, halts: Mapping[str, int], team: Sequence[str] = ()
    ) -> bool:
        """Whether a message was for several robots together, and has been answered.

        Args:
            target: The robot it was said to.
            said: The message.
            halts: How often each robot had been told to stop when it was said.
            team: All it was said to, if that is more than one.
        """
        wish = self.turned(said) or self._talk.wish(said.message, target)
        if (reasons := self._reasons(target, said, wish)) is not None:
            self._say((target,), reasons, said)
            return True
        if wish is not None and wish.kind == "progress":
            told, wish = self._progress(target, wish, said)
            if told is not None or wish is None:
                return told is not None and self._say((target,), told, said)
        if wish is not None and wish.kind == "why":
            return False
        if wish is not None and wish.kind in ("drop", "bar"):
            self._tell(target, wish, said)
            return True
        try:
            async with self._answering.thinking(target, said):
                mission = await self._talk.unread(target, said) if wish is None else None
                if mission is None and (len(team) > 1 or wish is not None):
                    mission = await self._talk.mission(wish, target, said, team)
        except (LanguageError, TimeoutError) as error:
            self._answering.not_understood(target, said, halts, error)
            return True
        if mission is None:
            return False
        if mission.stands:
            stop = SystemCommand(command="stop")
            order = ChatAction(system_cmd=(stop,), targets=mission.stands, by=said.who, words=said.message)
            self._node.publish(topics.CHAT_ACTION, order)
        if mission.itself is not None:
            robot, words = mission.itself
            self._hear(robot, said.model_copy(update={"message": words, "targets": (robot,)}))
        elif mission.shares:
            await self._carry_out(target, said, mission, halts)
        else:
            self._answer(target, said, mission)
        return True

    def _answer(self, target: str, said: ChatInput, mission: Mission) -> None:
        """Say what comes of words of which nobody does anything yet; what is told next may be lacking."""
        if mission.asked is not None:
            self._known.log(mission.asked[0]).on_asked(mission.asked[1])
        self._say((target,), mission.text, said, mission.choices, asks=texts.asks_back(mission.text))

    def turned(self, said: ChatInput) -> TeamWish | None:
        """What is said to be done behind words of stopping; None if whoever hears it reads that itself."""
        return self._talk.turned(said)

    def _progress(
        self, target: str, wish: TeamWish, said: ChatInput
    ) -> tuple[Sentence | None, TeamWish | None]:
        """How far the work is that is asked about; else as what it is read, if not about the hearer's own."""
        busy = [name for name in self._presence.names() if self._talk.is_busy(name)]
        told = self._board.progress(wish.about, ended=not busy)
        own = {*busy} <= {target} and question_of(plain(tokenize(said.message))) is not None
        return told, None if own else wish.otherwise

    def _tell(self, target: str, wish: TeamWish, said: ChatInput) -> None:
        """What a person says of one robot, to that robot: to give up its part, or where not to go."""
        robot = wish.robot
        if robot and (part := self._board.going(robot)) is not None:
            self._drop(part, said)
            if self._known.of_others(robot, said):  # that one asks about it
                if target != robot:
                    self._say((target,), texts.that_is_for((robot,)), said)
                return
            text = sentence(GIVES_UP, robot=robot)
            self._known.note(target, said.message, text)
            self._say(tuple(dict.fromkeys((target, robot))), text, said)
            return
        for name, words in [(part.robot, part.order) for part in wish.parts] or [
            (robot, "cancel everything")
        ]:
            if not self._presence.is_there(name):
                self._say((target,), texts.not_there(name), said)
            elif robot and not self._talk.left(robot):
                self._say((target,), sentence("{robot} has nothing left to do.", robot=robot), said)
            else:
                self._hear(name, said.model_copy(update={"message": words, "targets": (name,)}))

    def _reasons(self, target: str, said: ChatInput, wish: TeamWish | None) -> Sentence | None:
        """Why work went to those who have it; None if that is not asked, or nothing is known of it.

        A mere "why?" whoever has a part answers for itself.
        """
        robot = wish.robot if wish is not None else ""
        decided = self._decided.get(target)
        if wish is not None:
            decided = next(reversed(self._decided.values()), None) if wish.kind == "why" else None
        elif decided is not None and not self._is_about(decided, target, said):
            decided = None
        if decided is None:
            return None
        told = [decided.reasons[robot]] if robot in decided.reasons else [*decided.reasons.values()]
        return (
            together(*told) if told else sentence("Because you asked for it: “{words}”.", words=decided.words)
        )

    def _is_about(self, decided: _Decided, target: str, said: ChatInput) -> bool:
        """Whether a mere "why?" means what a robot has only heard given to others."""
        asked = question_of(plain(tokenize(said.message)))
        newest = self._known.log(target).newest_order
        return asked is not None and asked.topic == "why" and not asked.about and newest is decided.behind

    async def _carry_out(
        self, target: str, said: ChatInput, mission: Mission, halts: Mapping[str, int]
    ) -> None:
        """Hand the parts on, hear what became of each, and say just that."""
        orders = self._orders(target, said, mission)
        if orders is None:
            self._say((target,), texts.CANNOT, said)
            return
        ids = {order.targets[0]: order.id for order in orders}
        before = {name: self._known.log(name).newest_order for name in (target, *ids)}
        await self._talk.give_on(target, said, tuple(ids))
        self._follow(said, mission, ids)
        reasons = {share.robot: share.why for share in mission.shares}
        rulings: dict[str, PlanRuling] = {}
        halted: set[str] = set()
        for order in orders:
            name = order.targets[0]
            if self._answering.halted_since(halts, name):
                halted.add(name)
                continue
            for ruling in await self._answering.submit(order, said, str(reasons.get(name, ""))) or ():
                rulings[ruling.target] = ruling
        for name, order_id in ids.items():
            if name not in rulings or rulings[name].outcome == "refused":
                self._board.refuse(order_id)
        self._relieve(said, mission, rulings)
        team = self._presence.names() if any(share.why for share in mission.shares) else ()
        for share in mission.shares if team else ():
            self._teams[share.robot] = team
        told = [
            self._stopped(share) if share.robot in halted else self._told(share, rulings.get(share.robot))
            for share in mission.shares
        ]
        asked = frozenset(name for name, ruling in rulings.items() if ruling.outcome == "asked")
        for name in {target, *asked} if asked else ():  # the hearer may be the one that is told yes
            self._mates[name] = asked
        reply = together(WOULD_DO if asked else DOES, *told, mission.text, SHALL_I if asked else "")
        if asked == {target} == {*ids}:  # it asks for itself
            reply = together(wish_of(rulings[target].lines, rulings[target].why), mission.text, SHALL_I)
        robots = tuple(dict.fromkeys((target, *ids)))
        given = {share.robot: part for share, part in zip(mission.shares, told, strict=True) if share.why}
        for name in robots:
            self._known.note(name, said.message, reply)
            self._decided[name] = _Decided(said.message, given, before[name])
        self._say(robots, reply, said, asks_yes=bool(asked))

    def _follow(self, said: ChatInput, mission: Mission, ids: Mapping[str, str]) -> None:
        """Let it be seen as one, from before the first robot hears of it."""
        parts = tuple(
            MissionPart(
                robot=share.robot,
                order=ids[share.robot],
                lines=tuple(self._node.spoken(line) for line in self._lines(share)),
                why=self._node.spoken(share.why),
                after=share.after or tuple(filter(None, share.awaits[:1])),
                steps=tuple(self._calls(share)),
            )
            for share in mission.shares
        )
        known = [
            self._board.relieve(name, [part for part in parts if part.robot == taker])
            for name, taker in mission.relieved.items()
            if taker
        ]
        if len(parts) > 1 and not any(known):
            self._board.begin(
                MissionInfo(
                    id=uuid.uuid4().hex,
                    words=said.message,
                    by=said.who,
                    reply_to=said.id,
                    parts=parts,
                )
            )

    def _lines(self, share: Share) -> Sequence[Sentence]:
        """What a part is, as people read it."""
        calls, catalogue = self._calls(share), self._catalogue(share.robot)
        return lines_of(calls, labels_of(calls, catalogue, self._known.objects(share.robot)), catalogue)

    def _calls(self, share: Share) -> list[ActionCall]:
        """What a part is, as its robot gets it."""
        return complete_calls(share.calls, self._catalogue(share.robot))

    def _catalogue(self, robot: str) -> Sequence[ActionInfo]:
        status = self._presence.get(robot)
        return status.catalogue if status is not None else ()

    def _relieve(self, said: ChatInput, mission: Mission, rulings: Mapping[str, PlanRuling]) -> None:
        """Give up what others take over, or nobody does: now, or once their yes is there."""
        outcomes = {ruling.outcome for ruling in rulings.values()}
        names = tuple(name for name in mission.relieved if name not in rulings)
        if not names or not outcomes or "refused" in outcomes:
            return
        order = ChatAction(
            system_cmd=(SystemCommand(command="clear"),), targets=names, by=said.who, words=said.message
        )
        if outcomes == {"done"}:
            self._node.publish(topics.CHAT_ACTION, order)
        else:
            self._relieves[mission.shares[0].robot] = order

    def on_decision(self, decision: PlanDecision) -> None:
        """Somebody decided about a robot's steps."""
        order = self._relieves.pop(decision.target, None)
        if order is not None and decision.decision == "approve":
            self._node.publish(topics.CHAT_ACTION, order)

    def _orders(self, target: str, said: ChatInput, mission: Mission) -> list[ChatAction] | None:
        """The parts as orders on the person's account; None if some robot could not carry its part out."""
        parts = tuple(ChatAction(queue=share.calls, targets=(share.robot,)) for share in mission.shares)
        named = tuple(share.robot for share in mission.shares)
        heard = Heard(said.message, said.who, target, named, self._language.label)
        admitted = admit(ChatAction(others=parts), heard)
        ids = {share.robot: uuid.uuid4().hex for share in mission.shares}
        found: list[ChatAction] = []
        for order, share in zip(admitted.others, mission.shares, strict=True):
            doubt = share.needs_yes
            if doubt != STOPPED:  # words that were not understood
                doubt = admit(ChatAction(needs_yes=doubt), heard).order.needs_yes
            trusted = self._answering.trusted(share.robot, order)
            if trusted is None:
                return None
            own = {
                "id": ids[share.robot],
                "reply_to": said.id,
                "needs_yes": doubt,
                "after": (*(ids[name] for name in share.after), *filter(None, share.awaits[1:])),
                "system_cmd": share.drops,
                "replaces": mission.dropped.get(share.robot, ""),
            }
            found.append(trusted.model_copy(update=own))
        for name, proposal in mission.dropped.items():
            if name not in ids:  # it is given on: what waited here for a yes waits no more
                found.append(admitted.order.model_copy(update={"targets": (name,), "replaces": proposal}))
        return found

    def _stopped(self, share: Share) -> Sentence:
        """A part whose robot was stopped while it was found out who does what."""
        text = "{robot} was stopped meanwhile, so nobody does its part: {steps}."
        return sentence(text, robot=share.robot, steps=counted(self._lines(share)))

    def _told(self, share: Share, ruling: PlanRuling | None) -> Sentence:
        """A part in words: what will really be done of it, and why by that robot."""
        lines: Sequence[str] = self._lines(share)
        if ruling is not None and ruling.lines:
            lines = ruling.lines
        steps = counted(lines)
        if ruling is None or ruling.outcome == "refused":
            return sentence(
                "{robot} leaves its part, so nobody does it: {steps}.", robot=share.robot, steps=steps
            )
        if before := (*share.after, *filter(None, share.awaits[:1])):
            others = ", ".join(before)
            return sentence("{robot}, as soon as {others} has done its part: {steps}.",
                            robot=share.robot, others=others, steps=steps)  # fmt: skip
        if share.why:
            return sentence("{robot}: {steps} ({why}).", robot=share.robot, steps=steps, why=share.why)
        return sentence("{robot}: {steps}.", robot=share.robot, steps=steps)

    def _say(
        self,
        robots: Sequence[str],
        text: str,
        said: ChatInput,
        choices: Sequence[str] = (),
        *,
        asks: bool = False,
        asks_yes: bool = False,
    ) -> bool:
        """Say something, which answers a message."""
        feedback = ChatFeedback(
            message=self._node.spoken(text), targets=tuple(robots), type="response", choices=tuple(choices),
            asks=asks, asks_yes=asks_yes, reply_to=said.id,
        )  # fmt: skip
        self._node.publish(topics.CHAT_FEEDBACK, feedback)
        return True
