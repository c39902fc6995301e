"""The language engine that asks a model."""

from __future__ import annotations

import io
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Sequence
from typing import Any, Final, Generic, TypeVar, cast

import httpx2
import structlog
from PIL import Image
from pydantic_ai import Agent, BinaryContent, CachePoint, capture_run_messages
from pydantic_ai.messages import ModelMessage, ModelResponse, UserContent
from pydantic_ai.models import Model
from pydantic_ai.usage import RunUsage

from parley.clock import Clock
from parley.config import ModelPrice, ModelSettings
from parley.errors import LanguageError
from parley.language.base import (
    DraftHandler,
    ErrorSituation,
    Grounding,
    InspectionReport,
    Picture,
    ReplyReading,
    Situation,
)
from parley.language.llm import reading
from parley.language.llm.agents import draft_handler, make_agent
from parley.language.llm.failures import ModelFailedError, UnusableError, sorted_failure
from parley.language.llm.forms import Known, form_of
from parley.language.llm.guard import Breaker, Budget
from parley.language.llm.naming import chosen, named
from parley.language.llm.opened import Opened
from parley.language.llm.options import SMALL_KINDS, Options
from parley.language.llm.reading import AnswerRefusedError, PlanCheck
from parley.language.llm.recording import Recorder, Redactor
from parley.language.llm.usage import Exchange, Usage
from parley.language.prompts import (
    Prompt,
    compose_ground,
    compose_inspect,
    compose_interpret,
    compose_reply,
    compose_resolve,
    compose_selection,
)
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage, Detection
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap
from parley.world.whereabouts import Footprint, nearest, standing

__all__ = ["LlmLanguage"]

log = structlog.get_logger(__name__)

R = TypeVar("R")

_FEW_MEMORIES: Final = 20
"""So many are shown as they are; only of more a model picks those that matter."""
_AGENTS_KEPT: Final = 32
_RAISED: Final = (
    RuntimeError, OSError, ValueError, TypeError, LookupError, AttributeError, AssertionError,
    httpx2.HTTPError,
)  # fmt: skip
"""What the libraries raise when a server talks nonsense; errors of the agents are among the first."""
_NOT_FEASIBLE: Final = "I found no way to do that with what I can do."


class LlmLanguage(Opened):
    """Asks one model; checks every answer before anybody else sees it. Use as ``async with``.

    Args:
        model: Whom to ask.
        name: What people know it by.
        settings: How it is asked.
        clock: Wall time, for time-outs, waits and limits.
        check: Whether a plan can be carried out.
        usage: Adds up what it takes.
        budget: What it may take; shared by the models of one system.
        redactor: Keeps keys out of texts.
        recorder: Keeps exchanges; None: nothing is kept.
        streams: Whether the model can be heard while it writes.
        marks: Whether the provider is told up to where a question may be kept.
        small: Asked first where a short answer will do.
    """

    def __init__(
        self,
        model: Model[Any],
        name: str,
        settings: ModelSettings,
        *,
        clock: Clock,
        check: PlanCheck,
        usage: Usage | None = None,
        budget: Budget | None = None,
        redactor: Redactor | None = None,
        recorder: Recorder | None = None,
        streams: bool = True,
        marks: bool = False,
        small: LlmLanguage | None = None,
    ) -> None:
        super().__init__((model, small))
        self._model, self._name, self._settings = model, name, settings
        self._clock, self._check, self._streams = clock, check, streams
        self._options, self._marks, self._small = Options(settings), marks, small
        self.usage = usage or Usage()
        self._budget = budget or Budget(clock)
        self._redactor, self._recorder = redactor or Redactor(), recorder
        self.breaker = Breaker(clock, failures=settings.breaker_failures, open_s=settings.breaker_open_s)
        self._agents: OrderedDict[tuple[Known, bool], Agent[Callable[[Any], object], Any]] = OrderedDict()

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return f"language model {self._name}"

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return self._settings.pictures

    @property
    def timeout_s(self) -> float:
        """How long it may take over an answer, picking memories apart."""
        return self._settings.timeout_s

    # -- the questions ---------------------------------------------------------------------------------

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`."""
        return await self._shown(
            situation.pictures, lambda shown: self._interpret(situation, shown, on_draft)
        )

    async def _interpret(
        self, situation: Situation, shown: Sequence[bytes], on_draft: DraftHandler | None
    ) -> ChatAction:
        return await self._ask(
            compose_interpret(situation, sees=bool(shown)),
            Known(
                "interpret", situation.catalogue, situation.robot, situation.robots, _ids(situation.objects)
            ),
            lambda answer: reading.read_plan(answer, situation, self._check),
            pictures=shown,
            on_draft=on_draft,
        )

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`."""
        return await self._shown(situation.pictures, lambda shown: self._resolve(situation, shown))

    async def _resolve(self, situation: ErrorSituation, shown: Sequence[bytes]) -> ChatAction:
        return await self._ask(
            compose_resolve(situation, sees=bool(shown)),
            Known("resolve", situation.catalogue, situation.robot, things=_ids(situation.objects)),
            lambda answer: reading.read_resolution(answer, situation, self._check),
            pictures=shown,
        )

    async def _shown(
        self, pictures: Sequence[Picture], ask: Callable[[Sequence[bytes]], Awaitable[ChatAction]]
    ) -> ChatAction:
        """Ask with pictures; without them if the question is refused, this once: why is seldom said."""
        shown = [each.jpeg for each in pictures] if self.sees_pictures else []
        try:
            return await ask(shown)
        except ModelFailedError as error:
            if not shown or not error.rejected:
                raise
            log.warning("asked again without its pictures", model=self._name, error=str(error))
            return await ask([])

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`."""
        if len(index) <= _FEW_MEMORIES:
            return [entry.name for entry in index]
        prompt, known = compose_selection(query, index), Known("select_memories")
        return await self._ask(prompt, known, lambda answer: reading.read_selection(answer, index))

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """See `Language.ground`; what is named word for word is found without asking."""
        if not objects:
            return Grounding("none")
        if (found := named(description, objects)) is not None:
            return found
        known = Known("ground", things=_ids(objects))
        prompt = compose_ground(description, objects, pose)
        return await self._ask(prompt, known, lambda answer: reading.read_grounding(answer, objects))

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> InspectionReport:
        """See `Language.inspect`."""
        seen = None if image.detections is None else [_seen(found, known) for found in image.detections]
        return await self._ask(
            compose_inspect(request, seen, rules),
            Known("inspect", rules=len(rules)),
            lambda answer: reading.read_report(answer, rules, image.detections or ()),
            pictures=[_jpeg(image)],
        )

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """See `Language.read_reply`; a choice that is given word for word is found without asking."""
        if (choice := chosen(reply, choices)) is not None:
            return ReplyReading("choice", choice)
        prompt, known = compose_reply(question, reply, choices), Known("read_reply", choices=tuple(choices))
        return await self._ask(prompt, known, lambda answer: reading.read_reading(answer, choices))

    # -- asking ----------------------------------------------------------------------------------------

    async def _ask(
        self,
        prompt: Prompt,
        known: Known,
        read: Callable[[Any], R],
        *,
        pictures: Sequence[bytes] = (),
        on_draft: DraftHandler | None = None,
    ) -> R:
        """Ask, within time, budget and breaker; a smaller model first, where that will do.

        Raises:
            LanguageError: There is no answer that can be used.
        """
        if self._small is not None and prompt.kind in SMALL_KINDS:
            try:
                return await self._small._ask(prompt, known, read)
            except LanguageError as error:
                log.warning("the smaller model gave no answer", kind=prompt.kind, error=str(error))
        self._budget.admit()
        self.breaker.admit()
        short = prompt.kind == "select_memories"
        limit_s = self._settings.memory_timeout_s if short else self._settings.timeout_s
        try:
            async with self._clock.timeout(limit_s):
                answer = await self._tries(prompt, known, read, pictures, on_draft)
        except TimeoutError:
            self.breaker.failed()
            text = f"{self._name} gave no answer within {limit_s:g} s"
            raise LanguageError(text, plain="My language service takes too long.") from None
        except ModelFailedError:
            self.breaker.failed()
            raise
        except LanguageError:
            self.breaker.succeeded()  # it is there, whatever it said
            raise
        except BaseException:
            self.breaker.left()
            raise
        self.breaker.succeeded()
        return answer

    async def _tries(
        self,
        prompt: Prompt,
        known: Known,
        read: Callable[[Any], R],
        pictures: Sequence[bytes],
        on_draft: DraftHandler | None,
    ) -> R:
        wait_s, left = self._settings.backoff_s, self._settings.retries
        while True:
            try:
                return await self._once(prompt, known, read, pictures, on_draft)
            except ModelFailedError as error:
                if error.rejected and (option := self._options.refused(str(error))) is not None:
                    log.warning("asked again without what is refused", model=self._name, option=option)
                    continue
                if not error.may_help or not left:
                    raise
                log.warning("model is asked again", model=self._name, error=str(error))
                pause_s = max(wait_s, error.wait_s or 0.0)
            left -= 1
            await self._clock.sleep(pause_s)
            wait_s *= 2
            self._budget.admit()

    async def _once(
        self,
        prompt: Prompt,
        known: Known,
        read: Callable[[Any], R],
        pictures: Sequence[bytes],
        on_draft: DraftHandler | None,
    ) -> R:
        start_s, usage = self._clock.wall_s(), RunUsage()
        failure = LanguageError("nobody waits for the answer any more")  # unless something else happens
        answered = False
        refused = _Refusals(read)
        with capture_run_messages() as messages:
            try:
                result = await self._agent(known).run(
                    _content(prompt, pictures, marks=self._marks),
                    model=self._model,
                    deps=refused,
                    instructions=prompt.instructions,
                    model_settings=self._options.of(prompt.kind),
                    usage=usage,
                    event_stream_handler=draft_handler(on_draft) if on_draft and self._streams else None,
                )
                answer = refused.read(result.output)
                answered = True
                return answer
            except LanguageError as error:
                failure = error
                raise
            except _RAISED as error:
                failure = self._failure(error, refused)
                raise failure from None  # what is behind it may hold a key
            finally:
                error_text = "" if answered else str(failure)
                await self._note(prompt, messages, usage, self._clock.wall_s() - start_s, error_text)

    def _failure(self, error: Exception, refused: _Refusals[Any]) -> LanguageError:
        text = self._redactor.clean(f"{self._name}: {str(error) or type(error).__name__}")[:1000]
        failure = sorted_failure(error, text)
        if isinstance(failure, UnusableError) and refused.last is not None:
            problems = self._redactor.clean("; ".join(refused.last.problems))[:1000]
            return UnusableError(f"{text}: {problems}", plain=_NOT_FEASIBLE)
        return failure

    def _agent(self, known: Known) -> Agent[Callable[[Any], object], Any]:
        """The agent for a question; those that were asked last are kept, as their forms take time to make."""
        key, own = (known, self._options.strict), self._settings
        if key not in self._agents:
            form = form_of(known)
            self._agents[key] = make_agent(known.kind, form, own.output, own.corrections, strict=key[1])
            if len(self._agents) > _AGENTS_KEPT:
                self._agents.popitem(last=False)
        self._agents.move_to_end(key)
        return self._agents[key]

    # -- accounting ------------------------------------------------------------------------------------

    async def _note(
        self, prompt: Prompt, messages: Sequence[ModelMessage], usage: RunUsage, latency_s: float, error: str
    ) -> None:
        cost_usd = self._cost(messages, usage)
        exchange = Exchange(
            kind=prompt.kind,
            model=self._name,
            prompt_version=prompt.version,
            outcome="failed" if error else "answered",
            requests=usage.requests,
            input_tokens=usage.input_tokens,
            output_tokens=usage.output_tokens,
            cost_usd=cost_usd,
            latency_s=round(latency_s, 4),
            error=error,
        )
        self.usage.note(exchange)
        self._budget.spend(usage.input_tokens + usage.output_tokens, cost_usd or 0.0)
        if self._recorder is not None:
            await self._recorder.keep(prompt, exchange, messages)

    def _cost(self, messages: Sequence[ModelMessage], usage: RunUsage) -> float | None:
        price: ModelPrice | None = self._settings.prices.get(self._name)
        if price is not None:
            return (usage.input_tokens * price.input + usage.output_tokens * price.output) / 1e6
        try:
            responses = [message for message in messages if isinstance(message, ModelResponse)]
            return float(sum(response.cost().total_price for response in responses))
        except (LookupError, ValueError, AssertionError):
            return None  # nobody knows what this model costs


class _Refusals(Generic[R]):
    """Reads answers, once each, and remembers why the last one could not be used."""

    def __init__(self, read: Callable[[Any], R]) -> None:
        self._read = read
        self._last: tuple[Any, R] | None = None
        self.last: AnswerRefusedError | None = None

    def __call__(self, answer: Any) -> R:
        self.last = self._last = None
        try:
            result = self._read(answer)
        except AnswerRefusedError as refused:
            self.last = refused
            raise
        self._last = (answer, result)
        return result

    def read(self, answer: Any) -> R:
        """What `answer` means; it was probably the last one that was read."""
        if self._last is not None and self._last[0] is answer:
            return self._last[1]
        return self(answer)


def _ids(things: Sequence[MapObject]) -> tuple[str, ...]:
    return tuple(thing.id for thing in things)


def _content(prompt: Prompt, pictures: Sequence[bytes], *, marks: bool) -> str | list[UserContent]:
    marked = marks and prompt.lasting
    if not pictures and not marked:
        return prompt.content
    text: list[UserContent] = [prompt.content]
    if marked:
        text = [prompt.content[: prompt.lasting], CachePoint(), prompt.content[prompt.lasting :]]
    return [*text, *(BinaryContent(each, media_type="image/jpeg") for each in pictures)]


def _seen(found: Detection, known: ObjectMap | None) -> str:
    """What a detector saw, and where it stands: in or at the edge of what, or by what."""
    if found.x_m is None or found.y_m is None or known is None:
        return found.label
    others = [item for item in known.objects if item.description != found.label]
    by = nearest(found.x_m, found.y_m, others)
    if by is None:
        return found.label
    where = {"in": "in", "edge": "at the edge of", "outside": "near"}
    place = Footprint(found.x_m, found.y_m, *found.span_m)
    return f"{found.label} ({where[standing(place, by)]} {by.description})"


def _jpeg(image: CameraImage) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(cast(Any, image.data)).save(buffer, "JPEG", quality=85)
    return buffer.getvalue()
