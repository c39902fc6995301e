"""What the chat interface does about remembering itself: pictures that come and go, and why things are said.

Wiring only; the words are read in `parley.memory.sayings` and made in `parley.memory.because`.
"""

from __future__ import annotations

import asyncio
import uuid
from collections import deque
from collections.abc import Awaitable, Callable, Sequence
from datetime import datetime
from typing import Final

import structlog

from parley.agents.base import Node
from parley.clock import Clock
from parley.errors import InvalidMessageError, TransportError
from parley.latest import Latest
from parley.memory.because import OPERATOR, because, origin, reasons, when
from parley.memory.client import ask_memory
from parley.memory.pictures import MAX_PICTURES, PictureError, modest_jpeg
from parley.memory.retrieval import name_key, query_terms, words
from parley.memory.sayings import Viewing, asks_how_known, asks_to_see, file_title, picture_name
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.display import DisplayFeed
from parley.messages.memory import GetMemory, MemoryEntry, RemoveMemory
from parley.messages.principal import Principal

__all__ = ["FEED", "Recollections"]

FEED: Final = "memory"
"""Name of the display feed on which remembered pictures are shown."""
_KEPT_QUESTIONS: Final = 100
_WHAT: Final = "What does the picture show?"
_WHICH: Final = "What do the pictures show?"

log = structlog.get_logger(__name__)


class Recollections:
    """Helper of one chat interface.

    Args:
        node: Through whom it speaks.
        clock: Its wall time is named in replies.
        remember: Stores a memory and waits until it is durable; returns the plain reason if it is not.
        robots: All robots' names.
    """

    def __init__(
        self,
        node: Node,
        clock: Clock,
        remember: Callable[[MemoryEntry, Principal], Awaitable[str]],
        robots: Callable[[], Sequence[str]],
    ) -> None:
        self._node, self._clock, self._remember, self._robots = node, clock, remember, robots
        self._founded: Latest[str, tuple[MemoryEntry, ...]] = Latest()
        """The memories on which each robot's last reply was founded."""
        self._unnamed: Latest[str, tuple[MemoryEntry, ...]] = Latest(_KEPT_QUESTIONS)
        """Pictures that wait for a name, by the question about them; they are stored already."""
        self._taken: deque[ChatInput] = deque(maxlen=20)

    def asked(self, question_id: str) -> bool:
        """Whether this question is one of ours."""
        return question_id in self._unnamed

    async def handles(self, target: str, said: ChatInput, answers: str = "") -> bool:
        """Do what a message asks for, if it is about remembering itself; whether nothing is left to do.

        Args:
            target: The robot that is spoken to.
            said: The message.
            answers: The question of ours that it answers, if it does.
        """
        if answers:
            await self._name(answers, target, said)
            return True
        if said.images:
            return await self._take(target, said)
        if asks_how_known(said.message):
            self._tell((target,), self._reasons(target, said), said)
            return True
        wish = asks_to_see(said.message)
        return wish is not None and await self._show(target, said, wish)

    def why(self, target: str, said: ChatInput, sources: Sequence[str], known: Sequence[MemoryEntry]) -> str:
        """Why a reply says what it says, as one sentence; it is kept for "how do you know?".

        Args:
            target: The robot that replies.
            said: The message that is answered.
            sources: Names of the memories the reply is founded on.
            known: The memories it could be founded on.
        """
        self._founded[target] = found = tuple(entry for entry in known if entry.name in sources)
        return because(
            found,
            now_unix_ms=self._clock.unix_ms(),
            asker=said.author,
            robots=self._robots(),
            robot=target,
        )

    def _reasons(self, target: str, said: ChatInput) -> str:
        found = self._founded.get(target, ())
        if not found:
            return "What I said last does not rest on anything that I was told or saw earlier."
        return reasons(
            found, now_unix_ms=self._clock.unix_ms(), asker=said.author, robots=self._robots(), robot=target
        )

    # -- pictures that come ----------------------------------------------------------------------------

    async def _take(self, target: str, said: ChatInput, *, asks: bool = True) -> bool:
        """Keep the pictures of a message, once however many robots it is for; `asks` what they are."""
        if any(said is other or said.id == other.id != "" for other in self._taken):
            return True
        self._taken.append(said)
        targets = said.targets or (target,)
        if len(said.images) > MAX_PICTURES:
            text = f"Those are too many pictures at once: I take {MAX_PICTURES}. I kept none of them."
            self._tell(targets, text, said, "error")
            return True
        try:
            data = [await asyncio.to_thread(modest_jpeg, image.data) for image in said.images]
        except PictureError as error:
            self._tell(targets, f"I cannot use that: {error}. I kept nothing.", said, "error")
            return True
        name = picture_name(said.message)
        titles = [name or file_title(image.name) for image in said.images]
        entries = await self._keep(target, said, data, titles)
        if entries is None:
            return True
        if all(titles) or not asks:
            shown = " and ".join(f"“{entry.name}”" for entry in entries)
            self._tell(targets, f"I will remember what you showed me as {shown}.", said)
            return bool(name) or not said.message.strip()
        question = uuid.uuid4().hex
        self._unnamed[question] = entries
        text = f"I have kept it. {_WHAT if len(entries) == 1 else _WHICH}"
        self._node.publish(
            topics.CHAT_FEEDBACK,
            ChatFeedback(message=text, targets=tuple(targets), type="request", id=question, reply_to=said.id),
        )
        return not said.message.strip()

    async def keep_with_answer(self, target: str, said: ChatInput, question: str) -> None:
        """Store the pictures of an answer to somebody's question, without asking what they show."""
        about = said.message.strip() or f"Shown when I asked: {question}"
        await self._take(target, said.model_copy(update={"message": about}), asks=False)

    async def _keep(
        self, target: str, said: ChatInput, data: Sequence[str], titles: Sequence[str]
    ) -> tuple[MemoryEntry, ...] | None:
        """Store pictures under names of their own; None, and the operator told, if that fails."""
        moment = datetime.fromtimestamp(self._clock.unix_ms() / 1000)
        spare = f"picture {moment:%Y-%m-%d %H:%M:%S}"
        kept: list[MemoryEntry] = []
        for number, (picture, title) in enumerate(zip(data, titles, strict=True), 1):
            name = title or spare
            if any(entry.name == name for entry in kept):
                name = f"{name} {number}"
            info = said.message.strip()[:200] or name
            entry = MemoryEntry(
                name=name,
                type="image",
                data=picture,
                info=info,
                source=said.author or OPERATOR,
                way="told",
                words=said.message,
            )
            if problem := await self._remember(entry, said.who):
                self._tell(said.targets or (target,), problem, said, "error")
                return None
            kept.append(entry)
        return tuple(kept)

    async def _name(self, question: str, target: str, said: ChatInput) -> None:
        """Call pictures what the operator answered; without a usable answer they keep the name they have."""
        entries = self._unnamed.pop(question, None)
        if entries is None:
            return
        title = picture_name(said.message, bare=True)
        if not title:
            title = " ".join(said.message.split())[:80].strip(" .!?")
        data = [entry.data for entry in entries]
        kept = await self._keep(target, said, data, [title] * len(entries)) if title else None
        if kept is None:
            return
        for entry in entries:
            if entry.name not in {new.name for new in kept}:
                self._node.publish(topics.REMOVE_MEMORY, RemoveMemory.of(entry.name, said.who, entry.scope))
        shown = " and ".join(f"“{entry.name}”" for entry in kept)
        self._tell(said.targets or (target,), f"Thank you. I will remember it as {shown}.", said)

    # -- pictures that are shown back ------------------------------------------------------------------

    async def _show(self, target: str, said: ChatInput, wish: Viewing) -> bool:
        try:
            found = await self._find(target, wish)
            if wish.kind == "maybe" and not found:
                return False
            if not found:
                about = f" of {wish.about}" if wish.about else ""
                self._tell((target,), f"I do not remember any picture{about}.", said)
                return True
            request = GetMemory(request=found[0].name, scope=target, kind="named", type="image")
            whole = await ask_memory(self._node.transport, request)
        except (TransportError, InvalidMessageError) as error:
            log.warning("pictures not found", problem=str(error))
            self._tell((target,), "My memory does not answer at the moment. Please ask again.", said, "error")
            return True
        for entry in whole[-1:]:
            self._node.publish(
                topics.DISPLAY_FEED,
                DisplayFeed(target=target, name=FEED, image=entry.data, info={"name": entry.name}),
            )
        self._tell((target,), self._shown_text(target, said, wish, found), said, sources=(found[0].name,))
        self._founded[target] = found[:1]
        return True

    async def _find(self, target: str, wish: Viewing) -> tuple[MemoryEntry, ...]:
        """Pictures, without their data, the one to be shown first."""
        if wish.kind == "list" or not wish.about:
            request = GetMemory(request="", scope=target, kind="list", type="image", pictures=False)
            return tuple(reversed(await ask_memory(self._node.transport, request)))
        request = GetMemory(
            request=wish.about, scope=target, kind="search", type="image", pictures=False, limit=10
        )
        found = await ask_memory(self._node.transport, request)
        wanted = {word for term in query_terms(wish.about) for word in term} or set(words(wish.about))
        fitting = [entry for entry in found if wanted <= set(words(f"{entry.name} {entry.info}"))]
        exact = [entry for entry in fitting if set(name_key(entry.name).split()) == wanted]
        if wish.kind == "maybe":
            return tuple(exact)
        return tuple(exact or fitting)

    def _shown_text(self, target: str, said: ChatInput, wish: Viewing, found: Sequence[MemoryEntry]) -> str:
        name = found[0].name
        if wish.kind == "list" and len(found) > 1:
            names = ", ".join(f"“{entry.name}”" for entry in found[:10])
            more = f" and {len(found) - 10} more" if len(found) > 10 else ""
            return f"I remember {len(found)} pictures: {names}{more}. On the screen is “{name}”."
        who = origin(found[0], said.author, self._robots(), target)
        return f"Here is “{name}”: {who} {when(found[0], self._clock.unix_ms())}.".replace(" .", ".")

    def _tell(
        self,
        targets: Sequence[str],
        text: str,
        said: ChatInput,
        kind: str = "response",
        sources: Sequence[str] = (),
    ) -> None:
        self._node.publish(
            topics.CHAT_FEEDBACK,
            ChatFeedback.model_validate(
                {
                    "message": text,
                    "targets": tuple(targets),
                    "type": kind,
                    "reply_to": said.id,
                    "sources": tuple(sources),
                }
            ),
        )
