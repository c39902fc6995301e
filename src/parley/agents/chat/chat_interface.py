"""The chat interface node: from what an operator writes to a reply and a Chat Action (thesis 4.3.5).

Stop words and their kin are recognised in code before any language engine is asked and never wait behind it.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Awaitable, Callable, Sequence
from typing import ClassVar, Final

from parley.agents.base import Mailboxes, Node
from parley.agents.chat import texts
from parley.agents.chat.about_rules import AboutRules
from parley.agents.chat.answering import Answering
from parley.agents.chat.controls import HALTING, Controls
from parley.agents.chat.finds import Finds
from parley.agents.chat.finishing import Finishing
from parley.agents.chat.holds import Holds
from parley.agents.chat.log_answers import log_answer
from parley.agents.chat.memories import Confirmations
from parley.agents.chat.mission_board import MissionBoard
from parley.agents.chat.missions import Missions
from parley.agents.chat.placing import Placing
from parley.agents.chat.recollections import Recollections
from parley.agents.chat.situations import Situations
from parley.agents.chat.teaching import Teaching
from parley.agents.chat.team import TeamTalk
from parley.agents.planner.asking import Offered
from parley.agents.planner.orders import no_robot
from parley.agents.presence import ACQUAINTED_S, Presence, linked_to
from parley.agents.questions import SeenIds, WrongAnswers
from parley.agents.thinking import PATIENCE_S, Thinking
from parley.clock import Clock
from parley.gate.assent import assent_of, begins_with_no, gives_up
from parley.gate.control import Control, control_of
from parley.gate.rule_talk import RuleTalk
from parley.gate.stop_words import asked_behind, calls_to_stop, is_no, only_takes_back, opens_with_no
from parley.gate.table import Effect, verdict
from parley.gate.told import keeps_away
from parley.language.base import Language
from parley.memory.missions import MissionStore
from parley.messages import topics
from parley.messages.chat import Aside, ChatAction, ChatFeedback, ChatInput, ChatRead, SystemCommand
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.memory import AddToMemory, MemoryBody, MemoryEntry, MemoryEvent, RemoveMemory
from parley.messages.principal import Principal
from parley.messages.repeats import Repeats
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanRuling,
    PlanUpdate,
    Rejection,
    RejectionProblem,
    StopCommand,
    StopReport,
)
from parley.team.outlook import Survey
from parley.transport.base import Transport
from parley.world.object_map import MapObject

__all__ = ["ChatInterface"]

_ALL_OF_YOU: Final = re.compile(
    r"\b(?:every(?:body|one)|(?:all|both|each) of you|you (?:all|two|three)|all (?:the )?robots)\b",
    re.IGNORECASE,
)
_REPEATING: Final = {"again", "once", "another"}
"""In "do it again", "once more", "another time"."""


class ChatInterface(Node):
    """Understands messages, one conversation per robot, different robots side by side.

    Args:
        transport: Where the topics are.
        language: What understands.
        clock: Wall time.
        objects: The things a robot's map knows, by the robot's name.
        language_timeout_s: Wall time an answer of the language engine may take.
        history_exchanges: How many exchanges are remembered as context.
        known_robots: Robots that send no heartbeat of ours.
        patience_s: Wall time after which the operator is told that an answer takes long.
        rules: Hears what people say about rules before any language engine does.
        rooms: Parts of a robot's map with a name, as goals.
        soon: Waits a moment for what a robot has to tell of its map when it comes.
        survey: Says what each robot has before it, for sharing work; None: nobody can tell.
        missions: Keeps what teams were told over restarts; None keeps it only while this process lives.
    """

    name: ClassVar[str] = "chat_interface"
    apart = True

    def __init__(
        self,
        transport: Transport,
        language: Language,
        clock: Clock,
        *,
        objects: Callable[[str], Sequence[MapObject]] = lambda _: (),
        language_timeout_s: float = 30.0,
        history_exchanges: int = 10,
        known_robots: Sequence[str] = (),
        patience_s: float = PATIENCE_S,
        rules: RuleTalk | None = None,
        rooms: Callable[[str], Sequence[MapObject]] = lambda _: (),
        soon: Callable[[str], Awaitable[None]] | None = None,
        survey: Survey | None = None,
        missions: MissionStore | None = None,
    ) -> None:
        super().__init__(transport)
        self._soon = soon
        self._clock = clock
        self._early: list[ChatInput] | None = []
        """What waits for the first heartbeats; None: they have come."""
        self._thinking = Thinking(language_timeout_s, patience_s)
        self._presence = Presence(
            clock,
            tuple(known_robots),
            lambda *told: self._missions.on_presence(*told),
            linked=linked_to(transport),
        )
        self._known = Situations(transport, self._presence, objects, history_exchanges, clock, rooms)
        self._questions = self._known.questions
        self._mailboxes: Mailboxes[str] = Mailboxes(self._on_defect)
        self._offered, self._finishing = Offered(), Finishing(clock.now_s)
        self._seen_ids, self._repeats = SeenIds(), Repeats()
        self._wrong_answers = WrongAnswers(clock.now_s)
        self._holds = Holds(lambda command: self.publish(topics.STOP, command))
        self._rules = AboutRules(self, rules, self._known, self._presence, self._holds, self._offered)
        self._confirmations = Confirmations()
        self._recollections = Recollections(self, clock, self._remember, self._presence.names)
        self._placing = Placing(self, self._known, self._presence)
        self._teaching = Teaching(self, language, self._known, self._remember)
        self._answering = Answering(
            self,
            language,
            clock,
            known=self._known,
            presence=self._presence,
            thinking=self._thinking,
            recollections=self._recollections,
            confirmations=self._confirmations,
            halts=lambda target: self._controls.halts().get(target, 0),
            offered=self._offered.newest,
            has_rules=lambda: self._rules.has_rules,
        )
        self._say = self._answering.say
        talk = TeamTalk(language, self._known, self._presence, survey, self._offered.newest)
        self._board = MissionBoard(self, missions)
        self._missions = Missions(
            self, talk, self._answering, self._known, self._presence, self._board, language,
            lambda robot, said: self._hear(robot, said, None),
            lambda part, said: self._controls.drop_part(part, said),
        )  # fmt: skip
        self._finds = Finds(self, self._answering, self._known, self._board, language)
        self._controls = Controls(
            self, known=self._known, presence=self._presence, holds=self._holds, offered=self._offered,
            thinking=self._thinking, rules=self._rules, answering=self._answering, board=self._board,
            missions=self._missions,
        )  # fmt: skip

    async def open(self) -> None:
        """See `Node.open`."""
        await self.opened.enter_async_context(self._mailboxes)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        await self.subscribe(topics.STOP_REPORT, StopReport, self._presence.on_stop_report)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.MEMORY_EVENT, MemoryEvent, self._confirmations.on_event)
        await self.subscribe(topics.STOP, StopCommand, self._on_emergency)
        await self.subscribe(topics.ERROR_HANDLING, ErrorHandlingMessage, self._on_failure)
        await self.subscribe(topics.RULING, PlanRuling, self._rules.on_ruling)
        await self.subscribe_plans(self._on_plan)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._known.on_event)
        await self.subscribe(topics.PLAN_DECISION, PlanDecision, self._on_decision)
        await self._answering.open()
        await self._board.open()
        await self._finds.open()
        await self.subscribe(topics.ASIDE, Aside, self._on_aside)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input, in_charge=True)
        self.publish(topics.CHAT_READ, ChatRead())
        self.spawn(self._presence.watch(), name="presence")
        self.spawn(self._get_acquainted(), name="first heartbeats")

    async def _get_acquainted(self) -> None:
        """Take in what was said to robots before anything was heard of them."""
        await asyncio.sleep(ACQUAINTED_S)
        early, self._early = self._early or (), None
        for said in early:
            self._on_input(said)

    def _on_status(self, status: ActorStatus) -> None:
        self._presence.on_status(status)
        if self._holds.on_status(status):
            pause = SystemCommand(command="stop")
            self.publish(topics.CHAT_ACTION, ChatAction(system_cmd=(pause,), targets=(status.actor,)))

    # -- from the wire ---------------------------------------------------------------------------------

    def _on_input(self, said: ChatInput) -> None:
        """Hear a message; where a word of stopping is in it, its robots stand while it is read."""
        if self._early is not None and (self._early or not self._presence.knows_all(said.targets)):
            self._early.append(said)
            if said.id:  # the hold of what has none could not be ended
                self._holds.begin(said, said.targets)
            return
        if said.id:
            self.publish(topics.CHAT_READ, ChatRead(id=said.id))
        targets = (self._presence.resolve(name) or name for name in said.targets)
        held = self._holds.begin(said, (*targets, *self._presence.called_in(said.message)))
        try:
            self._read(said)
        finally:
            self._holds.end(held)

    def _on_aside(self, aside: Aside) -> None:
        if (made := self._wrong_answers.on_aside(aside)) is not None:
            self.publish(topics.CHAT_INPUT, made)

    def _keep_answer(self, said: ChatInput) -> None:
        if said.type == "response" and verdict(said.who, Effect.ANSWER) == "allow":
            for made in self._wrong_answers.on_answer(said):
                self.publish(topics.CHAT_INPUT, made)

    def _read(self, said: ChatInput) -> None:
        if not self._seen_ids.is_new(said.id) or self._is_repeated(said):
            return
        if problem := texts.unreadable(said.message, bare=bool(said.images)):
            self._say(said.targets, problem, "error", said.id)
            return
        control = self._control_in(said)
        if control not in HALTING and verdict(said.who, Effect.SPEAK) != "allow":
            self._only_stops(said)
            return
        self._keep_answer(said)
        if (
            self._controls.tells_apart(said, control)
            or self._turns(said, control)
            or self._needs_none(said, control)
        ):
            return
        if control is None and said.type == "response" and not said.targets and self._questions.robots():
            self._questions.on_input(said)
            return  # an answer; where several robots wait, the error handler asks which is meant
        self._take_up(said, control)
        self._questions.on_input(said)

    def _take_up(self, said: ChatInput, control: Control | None) -> None:
        """Have each robot that a message is for stand, act, or understand it."""
        calls, lets_go = calls_to_stop(said.message), texts.is_never_mind(said.message)
        refuses = lets_go or self._says_no(said.message, control)
        called = self._called_off(said) if calls else []
        behind = asked_behind(said.message) if calls else ""
        corrected: list[str] = []
        asked: list[tuple[str, ChatFeedback | None]] = []
        hear: list[tuple[str, ChatFeedback | None]] = []
        for target in self._meant(said, control, calls=calls, refuses=refuses):
            question = self._question(target, said, control)
            offered = self._offered.newest(target) is not None and question is None
            wanted_back = question is None and not offered and self._gives_up(target, said, control)
            refusing = refuses and not (lets_go and self._thinking.is_at_work(target))
            unasked = refusing and question is None and not offered
            moves = self._known.moves(target, self._presence.get(target))
            # Somebody else may just have said yes: what begins by that has not set the robot in motion yet.
            stands = self._known.state(target) == "paused"
            halts = (calls and (moves or target in called)) or (
                unasked and (moves or stands or self._known.is_under_way(target))
            )
            turns = question is None and control in (None, "stop")
            objects = moves and not (offered or refuses) and control is None and opens_with_no(said.message)
            if wanted_back:
                self._leave(target, said)
            elif behind and turns:  # "wait, is it open?"
                if halts or stands:
                    self._controls.act(target, "stop", said, more=False)
                asked.append((target, None))
            elif turns and (objects or only_takes_back(said.message, moves=moves)):
                corrected.append(target)
            elif halts and control not in HALTING:
                self._controls.act(target, "stop", said, more=control is None)
            elif control is not None and not (
                self._answers(target, question, control, said)
                or (offered and control == "skip" and self._refuses(target, said))
            ):
                self._controls.act_or_ask(target, control, said)
            elif not self._presence.is_there(target):
                text = texts.not_there(target)
                self._say((target,), text, "error", said.id)
            else:
                hear.append((target, question))
        self._hear_all(hear, corrected, said)
        self._hear_all(asked, (), said.model_copy(update={"message": behind}))

    def _question(self, target: str, said: ChatInput, control: Control | None) -> ChatFeedback | None:
        """The question that a message answers; yes and no to a rule for which a robot stands need no mark."""
        asked = self._questions.newest(target)
        marked = said.type == "response" or (
            asked is not None
            and control is None
            and self._rules.stands(target)
            and self._rules.asked(asked.id)
            and assent_of(said.message, self._presence.names()) is not None
        )
        return asked if marked else None

    def _control_in(self, said: ChatInput) -> Control | None:
        """What a whole message means at once; "stay away from there" says so only to whoever is under way."""
        control = control_of(said.message, self._presence.names())
        if control == "stop" and keeps_away(said.message) and not any(map(self._is_under_way, said.targets)):
            return None
        return control

    def _turns(self, said: ChatInput, control: Control | None) -> bool:
        """Whether there is an order behind words of stopping, which is taken up while all stand then."""
        wish = self._missions.turned(said) if control is None and said.type != "response" else None
        robots = self._meant(said, control, calls=True, refuses=False) if wish is not None else []
        if wish is None or not robots:
            return wish is not None  # nobody is there
        hearers = [name for target in said.targets if (name := self._presence.resolve(target))] or robots[:1]
        if wish.turns == "asked":
            for name in filter(self._is_under_way, robots):
                self._controls.act(name, "stop", said, more=False)
            robots = []
        robots = [name for name in robots if self._is_under_way(name)]
        named = [part.robot for part in wish.parts if part.robot]
        team = [*dict.fromkeys((*hearers, *named))] if len(hearers) > 1 else hearers
        self._mailboxes.post(hearers[0], self._correction(team, said, robots))
        self._questions.on_input(said)
        return True

    def _needs_none(self, said: ChatInput, control: Control | None) -> bool:
        """Whether nothing is to be done about a message, and that is told."""
        stopped = [
            name
            for target in said.targets
            if (name := self._presence.resolve(target)) and (status := self._presence.get(name))
            and status.state == "stopped"
        ]  # fmt: skip
        if stopped and texts.RELEASING.fullmatch(said.message):
            self._say(tuple(stopped), texts.RELEASED_BY_PRESS, "response", said.id)
            return True
        return self._is_late(said, control)

    def _is_late(self, said: ChatInput, control: Control | None) -> bool:
        """Whether a message answers a question that is settled, and is no stop; that is told."""
        if late := control not in HALTING and self._questions.is_late(said):
            self._say(said.targets, texts.settled(said.message), "response", said.id)
        return late

    def _is_repeated(self, said: ChatInput) -> bool:
        """Whether a program says the same on and on, which is told once; to stop counts every time."""
        if calls_to_stop(said.message) or control_of(said.message, self._presence.names()) in HALTING:
            return False
        count = self._repeats.count(said, self._clock.wall_s())
        if count == 1:
            self._say(said.targets, texts.SAID_AGAIN, "info")
        return count > 0

    def _hear_all(
        self, hear: Sequence[tuple[str, ChatFeedback | None]], corrected: Sequence[str], said: ChatInput
    ) -> None:
        """Have something understood by those it was said to, each with the question that it answers."""
        if corrected:
            self._mailboxes.post(corrected[0], self._correction(corrected, said, self._moving(corrected)))
        team = tuple(target for target, _ in hear)
        if len(hear) > 1 and all(question is None for _, question in hear):
            self._hear(team[0], said, None, team)
            return
        for target, question in hear:
            self._hear(target, said, question)

    def _hear(
        self, target: str, said: ChatInput, question: ChatFeedback | None, team: Sequence[str] = ()
    ) -> None:
        """Have something understood, unless it answers `question` or is about what waits or takes long.

        Args:
            target: The robot.
            said: The message.
            question: What it answers.
            team: All that hear it with this one: one understands it, and the others only what is not for all.
        """
        if question is None and (
            self._decides(target, said) or self._set_aside(target, said) or self._undoes(target, said)
        ):
            pass
        elif self._understands(target, said, question, team):
            return
        for other_robot in team[1:]:
            self._hear(other_robot, said, None)

    def _decides(self, target: str, said: ChatInput) -> bool:
        """Whether a message is a yes or a no to steps of a robot, or of those it has just asked for."""
        names = self._presence.names()
        own = self._offered.decided(target, said, names)
        asked_for_others = self._offered.newest(target) is None and self._offered.is_asked(target)
        if own is not None:
            if not self._controls.hand_on(target, own, said):
                return True  # it asks once more, and so the others wait, too
        elif not asked_for_others:
            return False
        mates = [
            mate for mate in self._missions.mates(target) - {*said.targets} if self._offered.is_asked(mate)
        ]
        others = [one for mate in mates if (one := self._offered.decided(mate, said, names)) is not None]
        for other in others:
            self.publish(topics.PLAN_DECISION, other)
        return own is not None or bool(others)

    def _understands(
        self, target: str, said: ChatInput, question: ChatFeedback | None, team: Sequence[str]
    ) -> bool:
        """Have a message understood; whether that is seen to for all of `team`."""
        about = said.reply_to or (question.id if question else "")
        known = self._rules.asked(about) or self._recollections.asked(about) or self._placing.asked(about)
        ours = about if known and (said.type == "response" or question is not None) else ""
        if question is None or ours:
            self._mailboxes.post(target, self._work(target, said, ours, team))
            return True
        if said.images:
            self._mailboxes.post(target, self._keep_pictures(target, said, question.message))
        return False

    def _only_stops(self, said: ChatInput) -> None:
        """Hear who may give no orders: everybody may call to stop, and what else is in it does not count."""
        if not calls_to_stop(said.message):
            self._say(said.targets, texts.ONLY_LOOKS, "error", said.id)
            return
        for target in self._meant(said, None, calls=True, refuses=False):
            self._controls.act(target, "stop", said)

    def _meant(self, said: ChatInput, control: Control | None, *, calls: bool, refuses: bool) -> list[str]:
        """Whom a message is for; a call to stop also for those under way whom its words call."""
        targets = self._addressed(said)
        if control is None and refuses and not calls:  # "A, never mind"
            return self._presence.named_in(said.message) or targets
        if control is not None:
            own = self._controls.own_of_all(said) if control == "start" else ()
            if control == "clear" and _ALL_OF_YOU.search(said.message):  # "cancel all" is about steps
                called = self._presence.called_in(said.message)
                own = [name for name in called if self._known.state(name) != "idle"]
            return list(dict.fromkeys((*(self._presence.meant_by(said.message, control) or targets), *own)))
        return list(dict.fromkeys((*targets, *(self._called_off(said) if calls else ()))))

    def _called_off(self, said: ChatInput) -> list[str]:
        """The robots at something that the words of a call to stop name, be it all of them."""
        return [name for name in self._presence.called_in(said.message) if self._is_under_way(name)]

    def _is_under_way(self, name: str) -> bool:
        """Whether a robot is at something, or moves by itself."""
        return self._known.is_under_way(name) or self._known.moves(name, self._presence.get(name))

    def _on_said(self, feedback: ChatFeedback) -> None:
        self._known.on_feedback(feedback)
        self._offered.on_said(feedback)

    def _set_aside(self, target: str, said: ChatInput) -> bool:
        """Whether a message is only about an older one that takes long; else tell that it waits behind it."""
        if texts.is_never_mind(said.message) and self._thinking.drop(target):
            self._say((target,), "All right.", "response", said.id)
            return True
        if slow := self._thinking.slow_message(target):
            self._answering.still_thinking(target, slow, said.message)
        return False

    def _answers(self, target: str, question: ChatFeedback | None, control: Control, said: ChatInput) -> bool:
        """Whether "go on" answers a question, or "again" is an order; to a paused robot it says to go on."""
        state = self._known.state(target)
        again = state == "idle" and bool(_REPEATING & {*said.message.lower().strip(" .!").split()})
        return control == "start" and state != "paused" and (question is not None or again)

    def _says_no(self, message: str, control: Control | None) -> bool:
        """Whether somebody says no in any words that are not a control word."""
        refuses = control is None and assent_of(message, self._presence.names()) is False
        return refuses or is_no(message)

    def _gives_up(self, target: str, said: ChatInput, control: Control | None) -> bool:
        """Whether a no is to what a robot has just asked back about an order; "cancel" ends a drive too.

        A mere no while it moves and asks for words may mean the drive; "never mind" does not.
        """
        means_more = control in HALTING and not (control == "clear" and self._known.state(target) == "idle")
        log = self._known.log(target)
        lacks = bool(log.lacks or log.still_asks) and texts.is_never_mind(said.message)
        return (
            (log.has_just_asked or lacks)
            and not means_more
            and gives_up(said.message, self._presence.names())
        )

    def _leave(self, target: str, said: ChatInput) -> None:
        """Do without the order that was asked about."""
        self._known.log(target).on_given_up()
        self._known.note(target, said.message, texts.LEFT)
        self._say((target,), texts.LEFT, "response", said.id)

    def _refuses(self, target: str, said: ChatInput) -> bool:
        """Whether "leave it" is a no to what the robot asked last, not a step that is to be left out."""
        waits = self._known.state(target) == "awaiting_approval"  # there is no step yet
        asked = waits or self._offered.is_asked(target) or begins_with_no(said.message)
        return asked and assent_of(said.message, self._presence.names()) is False

    def _work(
        self,
        target: str,
        said: ChatInput,
        ours: str = "",
        team: Sequence[str] = (),
        hear: Callable[[str], None] | None = None,
    ) -> Callable[[], Awaitable[None]]:
        halts, left = self._controls.halts(), [*team[1:]]

        def others() -> None:
            while left:
                name = left.pop(0)
                self._hear(name, said, None) if hear is None else hear(name)

        async def understood() -> bool:
            """Whether it was an order to all together."""
            if self._soon is not None:
                await self._soon(target)
            if await self._rules.handles(target, said, ours):
                return False
            if await self._placing.handles(target, said, ours, team):
                return True
            mine = ours if self._recollections.asked(ours) else ""
            together_done = False
            if not mine and (answer := await log_answer(self.transport, self._clock, target, said)):
                self._say((target,), answer, "response", said.id)
            elif not await self._recollections.handles(target, said, mine):
                order = await self._teaching.handles(target, said)
                heard = said.model_copy(update={"message": order}) if order else said
                together_done = order != "" and await self._missions.handles(target, heard, halts, team)
                if order != "" and not together_done:
                    others()  # they need not wait until this one has answered
                    await self._answering.answer(target, heard, halts)
            self._rules.ask_again(target, said)
            return together_done

        async def work() -> None:
            if not await understood():
                others()

        return work

    def _moving(self, robots: Sequence[str]) -> list[str]:
        return [name for name in robots if self._known.moves(name, self._presence.get(name))]

    def _correction(
        self, team: Sequence[str], said: ChatInput, stand: Sequence[str]
    ) -> Callable[[], Awaitable[None]]:
        """Of "wait, not that one": it is read while robots `stand`, and they go on standing in doubt."""
        held = self._holds.begin(said, tuple(stand), "reading") if stand else ""
        alone: list[str] = []

        def hear(name: str) -> None:
            alone.append(name)
            self._mailboxes.post(name, self._correction((name,), said, self._moving((name,))))

        async def correct() -> None:
            before = {name: self._known.changes(name) for name in stand}
            try:
                await self._work(team[0], said, team=team if len(team) > 1 else (), hear=hear)()
                for name in stand:
                    if name not in alone and self._known.changes(name) == before[name]:
                        self._controls.act(name, "stop", said, more=False)
            finally:
                self._holds.end(held)

        return correct

    def _keep_pictures(self, target: str, said: ChatInput, question: str) -> Callable[[], Awaitable[None]]:
        """Of an answer with pictures: whoever asked gets the words."""

        async def work() -> None:
            await self._recollections.keep_with_answer(target, said, question)

        return work

    def _addressed(self, said: ChatInput) -> list[str]:
        """The robots a message is for; without an addressee nothing may move."""
        names = self._presence.names()
        if not said.targets and len(names) == 1:
            return [names[0]]
        if not said.targets:
            self._say((), texts.which_robot(self._presence.known_text()), "error", said.id)
        found: list[str] = []
        for name in said.targets:
            known = self._presence.resolve(name)
            if known is None:
                text = no_robot(name, self._presence.known_text())
                self._say((name,), text, "error", said.id)
                problem = RejectionProblem(
                    path="targets", message=f"unknown robot {name!r}", code="unknown_robot"
                )
                self.publish(
                    topics.REJECTION,
                    Rejection(
                        source=self.name, target=name, what=topics.CHAT_INPUT.name, problems=(problem,)
                    ),
                )
            elif known not in found:
                found.append(known)
        return found

    def _on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        if isinstance(told, PlanProposal):
            self._offered.on_proposal(told)
            self._board.on_plan(told)
            return
        self._known.on_plan(told)
        self._offered.on_update(told)
        self._holds.on_update(told)
        self._missions.on_plan(told)
        self._board.on_plan(told)
        self._finds.on_plan(told)
        status = self._presence.get(told.target)
        if done := self._finishing.on_update(told, status.catalogue if status else ()):
            self._say((told.target,), done, "info")

    def _on_failure(self, failure: ErrorHandlingMessage) -> None:
        self._known.on_failure(failure)
        self._rules.on_failure(failure)

    def _on_decision(self, decision: PlanDecision) -> None:
        self._offered.on_decision(decision)
        self._missions.on_decision(decision)

    def _on_emergency(self, command: StopCommand) -> None:
        """The stop button: what was asked for before it is dropped, as if it had been said."""
        if command.command == "stop":
            for target in command.targets or self._presence.ever():
                self._controls.halt(target)
        elif command.command == "reset":
            self._holds.on_reset()
            self._presence.on_reset(command)

    def _undoes(self, target: str, said: ChatInput) -> bool:
        """Whether a message is a tap on what undoes a memory; it is done then."""
        name = texts.undone(said.message)
        if not name or verdict(said.who, Effect.FORGET) != "allow":
            return False
        self.publish(topics.REMOVE_MEMORY, RemoveMemory.of(name, said.who))
        self._say((target,), texts.forgotten(name), "response", said.id)
        return True

    # -- memory ----------------------------------------------------------------------------------------

    async def _remember(self, entry: MemoryEntry, by: Principal) -> str:
        """Store what a person told; the plain reason if it is not durable in time."""
        wait = self._confirmations.wait_for(entry.name)
        body = MemoryBody.model_validate(entry.model_dump() | {"way": "told", "by": by})
        self.publish(topics.ADD_TO_MEMORY, AddToMemory({entry.name: body}))
        return await self._confirmations.confirmed([wait])

    def _on_defect(self, target: str, error: Exception) -> None:
        self._say(
            (target,), "Something went wrong on my side. Nothing was started; please try again.", "error"
        )
