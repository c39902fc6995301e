"""The error handler node: repairs a failed step alone, or by asking the operator (thesis 4.3.7)."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from typing import ClassVar, Literal

from parley.agents.base import Mailboxes, Node
from parley.agents.planner.orders import WAITING
from parley.agents.presence import Presence
from parley.agents.questions import OpenQuestions, SeenIds
from parley.agents.recovery.advice import Advice, plain_question
from parley.agents.recovery.asides import Asides
from parley.agents.recovery.freed import Freed
from parley.agents.recovery.incident_log import IncidentLog
from parley.agents.recovery.repair import (
    MAX_ALONE,
    Ending,
    Repair,
    ending_of,
    steps_left,
)
from parley.agents.recovery.which_robot import WhichRobot
from parley.agents.thinking import PATIENCE_S, Thinking
from parley.clock import Clock
from parley.errors import InvalidMessageError
from parley.gate.assent import assent_of
from parley.gate.cards import labels_of, lines_of
from parley.gate.control import Control, control_of
from parley.gate.orders import engine
from parley.gate.rule_talk import Listener, RuleTalk
from parley.gate.table import Effect, verdict
from parley.language.base import Language, Turn
from parley.memory.incidents import IncidentStore
from parley.messages import topics
from parley.messages.chat import (
    ActionCall,
    ChatAction,
    ChatFeedback,
    ChatInput,
    SystemCommand,
)
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.incident import GetIncidents, Incident
from parley.messages.passages import PassageList
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.status import ActionInfo, ActorStatus, PlanProposal, PlanUpdate, StopCommand, StopReport
from parley.messages.wire import decode, encode
from parley.sentences import sentence
from parley.team.wishes import turned_wish
from parley.transport.base import Transport
from parley.world.object_map import MapObject

__all__ = ["ErrorHandler"]

_ENDED_BY: dict[Control, Ending] = {
    "stop": "held", "emergency_stop": "held", "clear": "cancelled", "skip": "skipped",
}  # fmt: skip


_STARTED_ANEW = (
    "I was started anew, so you need not answer my last question any more. Please tell me what to do."
)
_THINKING = "I am still working out what to do. You can say “stop” or “skip it” meanwhile."
_STOPPED = "I was stopped for safety. Release the stop first; then I ask you again."


class ErrorHandler(Node):
    """One repair per robot at a time, attempts bounded across repeated failures of the same step.

    Args:
        transport: Where the topics are.
        language: What understands.
        clock: Robot time for corrections that wait, wall time for the rest.
        objects: The things a robot's map knows, by the robot's name.
        max_attempts: How often the operator is asked before the robot is held.
        language_timeout_s: Wall time an answer of the language engine may take.
        incidents: Where failures are written down, open; its owner closes it. None: kept while the node is
            open.
        patience_s: Wall time after which the operator is told that it takes long.
        rules: Knows what is said about rules, which answers no question about a failed step.
    """

    name: ClassVar[str] = "error_handler"
    apart = True

    def __init__(
        self,
        transport: Transport,
        language: Language,
        clock: Clock,
        *,
        objects: Callable[[str], Sequence[MapObject]] = lambda _: (),
        max_attempts: int = 3,
        language_timeout_s: float = 30.0,
        incidents: IncidentStore | None = None,
        patience_s: float = PATIENCE_S,
        rules: RuleTalk | None = None,
    ) -> None:
        super().__init__(transport)
        self._rules = rules
        self._language, self._objects, self._clock = language, objects, clock
        self._max_attempts = max_attempts
        self._thinking = Thinking(language_timeout_s, patience_s)
        self._store = incidents
        self._log: IncidentLog
        self._presence = Presence(clock)
        self._questions = OpenQuestions()
        self._seen_ids = SeenIds()
        self.left_over: Sequence[Incident] = ()
        """Failures that an earlier process left open; they were closed when this one began."""
        self._which = WhichRobot()
        self._mailboxes: Mailboxes[str] = Mailboxes(self._on_defect)
        self._repairs: dict[str, Repair] = {}
        """What is being worked out, by robot."""
        self._trying: dict[str, Repair] = {}
        """Corrections under way, to see whether they help."""
        self._latched: set[str] = set()
        """Robots that were stopped for safety and may not move before a person releases that."""
        self._asides = Asides()
        self._freed = Freed(lambda robot, text: self._say(robot, text, "info"))
        self._advice = Advice(transport, language, self._thinking, self._presence, objects)

    async def open(self) -> None:
        """See `Node.open`."""
        store = self._store
        if store is None:
            own = await IncidentStore.open(":memory:", self._clock)
            store = await self.opened.enter_async_context(own)
        self._log = IncidentLog(store, self._clock)
        self.left_over = await self._log.settle_left_over()
        self.opened.push_async_callback(self._log.flush)
        await self.opened.enter_async_context(self._mailboxes)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        await self.subscribe(topics.PASSAGES, PassageList, self._freed.on_passages)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.ERROR_HANDLING, ErrorHandlingMessage, self._on_failure)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)
        await self.subscribe(topics.STOP, StopCommand, self._on_stop)
        await self.subscribe(topics.STOP_REPORT, StopReport, self._on_stop_report)
        await self.subscribe_plans(self._on_plan)
        server = await self.transport.serve(topics.GET_INCIDENTS, self._on_get)
        self.opened.push_async_callback(server.close)
        for incident in self.left_over:
            if incident.questions:
                closes = _question_id(incident)
                self._say(incident.robot, _STARTED_ANEW, "info", closes=closes)

    # -- from the wire ---------------------------------------------------------------------------------

    def _on_status(self, status: ActorStatus) -> None:
        self._presence.on_status(status)
        self._freed.on_status(status)

    def _on_failure(self, failure: ErrorHandlingMessage) -> None:
        target, earlier = failure.target, self._trying.get(failure.target)
        known = [repair for repair in (self._repairs.get(target), earlier) if repair is not None]
        if failure.failure_id and any(repair.failure.failure_id == failure.failure_id for repair in known):
            return  # the same failure, reported twice
        self._freed.on_failure(failure)
        if target in self._repairs:
            self._end(self._repairs.pop(target), "replaced", "Another step failed in the meantime.")
        self._trying.pop(target, None)
        if earlier is not None and earlier.is_repeated_by(failure):
            repair = earlier
            repair.again(failure)
        else:
            if earlier is not None:
                self._end(earlier, "solved")
            now_ms, label = self._clock.unix_ms(), self._label(failure)
            repair = Repair.begin(failure, incident_id=uuid.uuid4().hex, unix_ms=now_ms, label=label)
        self._repairs[target] = repair
        self._record(repair)
        self._mailboxes.post(target, lambda: self._attempt(repair, None))

    def _label(self, failure: ErrorHandlingMessage) -> str:
        """What people read of the step that failed, whatever it hung on."""
        catalogue = self._catalogue(failure.target)
        steps = (failure.action_called, *failure.umrf_queue)
        calls = [call.model_copy(update={"flow": None}) for call in steps]
        return lines_of(calls, labels_of(calls, catalogue, self._objects(failure.target)), catalogue)[0]

    def _catalogue(self, target: str) -> Sequence[ActionInfo]:
        status = self._presence.get(target)
        return status.catalogue if status is not None else ()

    def _on_said(self, feedback: ChatFeedback) -> None:
        self._questions.on_feedback(feedback)
        for target in self._asides.on_feedback(feedback):
            repair = self._repairs.get(target)
            if repair is not None and repair.question is not None and not repair.question_id:
                self._put(repair, repair.question)

    def _on_input(self, said: ChatInput) -> None:
        if not self._seen_ids.is_new(said.id):
            return
        control = control_of(said.message, self._presence.names())
        if self._questions.is_late(said) and control not in ("stop", "clear", "emergency_stop"):
            return  # the chat interface says so
        if control is None and verdict(said.who, Effect.ANSWER) != "allow":
            return  # the chat interface says so
        if control is not None and not (control == "start" and said.type == "response"):
            meant = self._presence.meant_by(said.message, control)
            for target in meant or [self._presence.resolve(name) or name for name in said.targets]:
                self._controlled(target, control, said.message)
            self._questions.on_input(said)
            return
        addressed = self._which.addressed(said, self._questions.robots())
        if addressed is not None:
            self.publish(topics.CHAT_INPUT, addressed)
            return
        answered = self._questions.answered(said)
        self._asides.on_input(said, self._questions)
        self._questions.on_input(said)
        for target, question in answered:
            repair = self._repairs.get(target)
            if repair is None or repair.question_id != question.id:
                continue
            self._take_answer(repair, said)
        if not answered and self._which.needed(said, self._questions.robots()):
            self._ask_which(said)

    def _take_answer(self, repair: Repair, said: ChatInput) -> None:
        """Somebody replies to the question of a repair, perhaps with something else."""
        target = repair.failure.target
        if self._is_for_others(said, target):
            self._decline(repair)
            self._refer(repair, said)
        elif self._is_about_rules(said, target):
            repair.question_id = ""
            self._refer(repair, said)
        elif target in self._latched:
            self._say(target, _STOPPED, "response")
        else:
            repair.question_id = ""
            self._mailboxes.post(target, lambda: self._attempt(repair, said))

    def _controlled(self, target: str, control: Control, words: str) -> None:
        """The chat interface acts on it and closes the question; what is still worked out moves nobody."""
        if control == "start" and target in self._latched:
            return  # it cannot go on; the question about the failed step stays as it is
        repair = self._repairs.pop(target, None)
        if repair is None:
            return  # what becomes of a correction under way, the plan will tell
        if words:
            repair.note_answered(words)
        if control == "start":
            self._record(repair)
            self._watch(repair, ())
            return
        if control == "emergency_stop":
            self._hold(target)
        self._end(repair, _ENDED_BY[control])

    def _on_stop(self, command: StopCommand) -> None:
        """The stop button: what is still worked out, or waits for its time, is dropped; a question stays."""
        if command.command != "stop":
            return
        for target in command.targets or tuple(self._repairs):
            repair = self._repairs.get(self._presence.resolve(target) or target)
            if repair is not None and not repair.question_id:
                self._controlled(repair.failure.target, "emergency_stop", "")

    def _on_stop_report(self, report: StopReport) -> None:
        """Ask again what was open while the robot was stopped for safety: it may move again."""
        target = self._presence.resolve(report.actor) or report.actor
        if report.state != "reset":
            self._latched.add(target)
            return
        was_latched = target in self._latched
        self._latched.discard(target)
        repair = self._repairs.get(target)
        if was_latched and repair is not None and repair.question_id and repair.question is not None:
            self._put(repair, repair.question, instead_of=repair.question_id)

    def _ask_which(self, said: ChatInput) -> None:
        robots = self._questions.robots()
        question = self._which.ask(said, robots, uuid.uuid4().hex, self.spoken)
        self.publish(topics.CHAT_FEEDBACK, question)

    def _on_plan(self, update: PlanUpdate | PlanProposal) -> None:
        """A repair ends when the robot is no longer held, whoever brought that about."""
        if isinstance(update, PlanProposal):
            return
        if update.state != "held" and update.target not in self._repairs:
            self._freed.forget(update.target)
        trying = self._trying.get(update.target)
        if trying is not None and (outcome := trying.outcome(update)) != "open":
            del self._trying[update.target]
            self._end(trying, outcome)
        repair = self._repairs.get(update.target)
        if repair is None:
            return
        if update.state == "held":
            repair.seen_held = True
        elif repair.seen_held:
            del self._repairs[update.target]
            self._end(repair, "cancelled" if update.state == "idle" else "replaced")
            if repair.question_id:
                text = "You need not answer my question any more."
                self._say(update.target, text, "info", closes=repair.question_id)

    async def _on_get(self, asked: ChatRequest) -> ChatResponse:
        try:
            request = decode(GetIncidents, asked.message or "{}")
        except InvalidMessageError as error:
            self.refuse(topics.GET_INCIDENTS.name, error)
            raise
        return ChatResponse(encode(await self._log.newest(request.robot, request.limit)))

    # -- repairing -------------------------------------------------------------------------------------

    async def _attempt(self, repair: Repair, answer: ChatInput | None) -> None:
        if not self._is_current(repair):
            return  # settled otherwise in the meantime
        reply = answer.message if answer is not None else None
        said = reply or ("(a picture)" if answer is not None and answer.images else "")
        if answer is not None:
            repair.note_answered(said)
            self._record(repair)
            if assent_of(answer.message, self._presence.names()) is False:
                self._decline(repair)
                return
        resolution = await self._advice.on(
            repair,
            reply,
            answer.images if answer is not None else (),
            lambda: self._say(repair.failure.target, _THINKING, "info"),
        )
        if not self._is_current(repair):
            return
        resolution = self._advice.admitted(repair, resolution, answer)
        if reply is not None:
            repair.note_turn(Turn("operator", said))
        if resolution.success and reply is None and self._is_used_up(repair, resolution):
            resolution = plain_question(repair.failure)
        if resolution.success:
            self._solve(repair, resolution, alone=reply is None)
        elif resolution.success is None and answer is not None and repair.question is not None:
            if not (resolution.message_response or resolution.queue or resolution.system_cmd):
                self._refer(repair, answer)
            else:
                self._answer_aside(repair, resolution, repair.question)
        elif repair.attempts >= self._max_attempts:
            self._give_up(repair)
        else:
            self._ask(repair, resolution)

    def _decline(self, repair: Repair) -> None:
        """A literal no: nothing is tried, whatever an engine would make of it."""
        target = repair.failure.target
        del self._repairs[target]
        self._end(repair, "held")
        self._hold(target)
        self._say(target, WAITING, "info")

    def _is_current(self, repair: Repair) -> bool:
        return self._repairs.get(repair.failure.target) is repair

    def _is_used_up(self, repair: Repair, correction: ChatAction) -> bool:
        """Nothing is tried the same way twice without asking, nor for ever, nor while it must not move."""
        latched = repair.failure.target in self._latched
        return latched or repair.alone >= MAX_ALONE or repair.is_known(correction)

    def _solve(self, repair: Repair, resolution: ChatAction, *, alone: bool) -> None:
        target = repair.failure.target
        text = resolution.message_response or "Thank you, I am going on."
        repair.alone += alone
        repair.note_tried(text, alone=alone, unix_ms=self._clock.unix_ms())
        self._record(repair)
        if resolution.delay_s:
            # Beside the mailbox: whoever says something meanwhile is heard, and may settle it otherwise.
            self.spawn(self._solve_later(repair, resolution), name=f"waiting {target}")
        else:
            self._correct(repair, resolution)
        self._say(target, text, "info")

    async def _solve_later(self, repair: Repair, resolution: ChatAction) -> None:
        await self._clock.sleep(resolution.delay_s)
        if self._is_current(repair):
            self._correct(repair, resolution)

    def _correct(self, repair: Repair, resolution: ChatAction) -> None:
        target = repair.failure.target
        del self._repairs[target]
        correction = resolution.model_copy(update={"targets": (target,), "success": True, "afterwards": ()})
        ending = ending_of(resolution)
        if ending == "open":
            self._watch(repair, resolution.queue)
        else:
            self._end(repair, ending)
        self.publish(topics.UMRF_CORRECTION, correction)
        self._keep_for_later(repair, resolution)

    def _keep_for_later(self, repair: Repair, resolution: ChatAction) -> None:
        """The planner keeps an order while the robot is held, and appends it to the plan afterwards."""
        if resolution.afterwards:
            self.publish(topics.CHAT_ACTION, _order_of(resolution, resolution.afterwards, repair))

    def _watch(self, repair: Repair, correction: Sequence[ActionCall]) -> None:
        """See whether the correction helps (none: the step as it was)."""
        repair.note_correction(correction)
        self._trying[repair.failure.target] = repair

    def _answer_aside(self, repair: Repair, resolution: ChatAction, question: ChatAction) -> None:
        """Answer what the operator asked, keep what they ordered for later, and ask again: no attempt."""
        target = repair.failure.target
        repair.note_turn(Turn("assistant", resolution.message_response))
        later = (*resolution.queue, *resolution.afterwards)
        if later or resolution.system_cmd:
            order = _order_of(resolution, later, repair)
            self.publish(topics.CHAT_ACTION, order.model_copy(update={"system_cmd": resolution.system_cmd}))
        self._say(target, resolution.message_response, "response", sources=resolution.sources)
        self._put(repair, question)

    def _refer(self, repair: Repair, said: ChatInput) -> None:
        """Let what is no answer be understood like any message; then the question is put again."""
        self.publish(
            topics.CHAT_INPUT, self._asides.begin(said, repair.failure.target, _question_id(repair.incident))
        )

    def _is_about_rules(self, said: ChatInput, target: str) -> bool:
        """Whether a message tells, asks for or lifts a rule: that is no answer to a question of ours."""
        to = Listener(target, self._presence.names(), self._objects(target), self._catalogue(target))
        return self._rules is not None and self._rules.concerns(said.message, to)

    def _is_for_others(self, said: ChatInput, target: str) -> bool:
        """Whether there is an order behind words of stopping that is not for the robot that asks alone."""
        wish = turned_wish(said.message, self._presence.ever(), (target,))
        return wish is not None and any(part.robot != target for part in wish.parts)

    def _ask(self, repair: Repair, resolution: ChatAction) -> None:
        repair.attempts += 1
        self._keep_for_later(repair, resolution)
        repair.note_turn(Turn("assistant", resolution.message_response))
        self._put(repair, resolution)

    def _put(self, repair: Repair, question: ChatAction, *, instead_of: str = "") -> None:
        repair.note_asked(question.message_response, self._clock.unix_ms())
        if repair.question is None or not question.choices or repair.question.choices != question.choices:
            repair.question = (
                question  # once more it is asked as at first: "I did not understand" is over then
            )
        repair.question_id = _question_id(repair.incident)
        self._record(repair)
        self._say(
            repair.failure.target,
            question.message_response,
            "request",
            choices=question.choices,
            question_id=repair.question_id,
            closes=instead_of,
        )
        self._freed.on_asked(repair.failure.target)

    def _give_up(self, repair: Repair) -> None:
        """Hold the robot and say what remains (design section 2, last row of the table)."""
        target = repair.failure.target
        del self._repairs[target]
        self._end(repair, "held")
        self._hold(target)
        steps = [repair.failure.action_called, *repair.failure.umrf_queue]
        left = steps_left(steps, self._catalogue(target))
        text = sentence(
            "I could not solve this, so I am waiting here. {problem} {left} Say “try again”, “skip it” or "
            "“cancel everything”, or give me another order.",
            problem=repair.failure.error_message,
            left=left,
        )
        self._say(target, text, "info", choices=("try again", "skip it", "cancel everything"))

    def _hold(self, target: str) -> None:
        """No repair any more: the plan waits, and the next order goes on."""
        stop = SystemCommand(command="stop", arguments={})
        self.publish(
            topics.UMRF_CORRECTION,
            ChatAction(system_cmd=(stop,), targets=(target,), success=False, by=engine(self._language.label)),
        )

    # -- helpers ---------------------------------------------------------------------------------------

    def _record(self, repair: Repair) -> None:
        self.publish(topics.INCIDENT, repair.incident)
        self._log.write(repair.incident)

    def _end(self, repair: Repair, ending: Ending, note: str = "") -> None:
        self._thinking.give_up(repair.failure.target)
        repair.note_end(ending, self._clock.unix_ms(), note)
        self._record(repair)

    def _say(
        self,
        target: str,
        text: str,
        kind: Literal["request", "response", "info", "error"],
        *,
        choices: Sequence[str] = (),
        sources: Sequence[str] = (),
        question_id: str = "",
        closes: str = "",
    ) -> None:
        feedback = ChatFeedback(
            message=self.spoken(text), targets=(target,), type=kind, choices=tuple(choices),
            sources=tuple(sources),
            id=question_id, closes=closes,
        )  # fmt: skip
        self.publish(topics.CHAT_FEEDBACK, feedback)

    def _on_defect(self, target: str, error: Exception) -> None:
        repair = self._repairs.get(target)
        if repair is not None:
            self._give_up(repair)


def _order_of(resolution: ChatAction, calls: Sequence[ActionCall], repair: Repair) -> ChatAction:
    """What is ordered besides a repair, on the same account."""
    return ChatAction(
        queue=tuple(calls),
        targets=(repair.failure.target,),
        by=resolution.by,
        behalf=resolution.behalf,
        words=resolution.words,
        needs_yes=resolution.needs_yes,
    )


def _question_id(incident: Incident) -> str:
    """Of the last question: known from the record, so that the next process can close what this one asked."""
    return f"{incident.id}-{incident.questions}"
