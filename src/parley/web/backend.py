"""What the routes and the live stream share: state, store, topics, feeds of one server."""

from __future__ import annotations

import asyncio
import hashlib
import uuid
from collections.abc import Callable, Coroutine, Sequence
from contextlib import AsyncExitStack, suppress
from typing import Any, Final, Self
from urllib.parse import urlsplit

import structlog

from parley import __version__
from parley.clock import Clock, WallClock
from parley.errors import StoreError
from parley.gate.stop_line import StopLine
from parley.gate.stop_words import STOP_WORDS, has_stop_word
from parley.language.llm.in_use import EngineInUse
from parley.memory.folder import held_folder
from parley.messages.chat import ChatFeedback, ChatImage
from parley.messages.map import MapView
from parley.messages.principal import Principal, person
from parley.messages.status import PlanDecision
from parley.transport.base import Transport
from parley.web.bodies import ChatPost
from parley.web.chat_state import Composed
from parley.web.config import Module, WebConfig, engine_in_words
from parley.web.feed_state import Picture
from parley.web.feeds import Feeds
from parley.web.keeper import Keeper
from parley.web.link import Link
from parley.web.models import ChatEntry, Favourite, Policy, RobotView, ServerInfo, Snapshot
from parley.web.outbox import Outbox
from parley.web.people.store import FILE, PeopleStore
from parley.web.pictures import kept_picture
from parley.web.problems import WebProblem
from parley.web.push import Pusher
from parley.web.sessions import Sessions
from parley.web.state import WebState
from parley.web.stopping import Stopper
from parley.web.store import KeptPicture, WebStore

__all__ = ["Backend"]

log = structlog.get_logger(__name__)

RECENT: Final = 300
"""Entries that are read from the store at the start."""


class Backend:
    """Use as ``async with``; what was opened is closed in reverse order.

    Args:
        transport: Opened by the caller.
        config: The settings.
        pairs: Whether one has to sign in with a pairing code, where there is no password.
        clock: Wall time.
        stop_line: Of the engines, if they run in this process.
        at_rest: Whether a robot of this process stands, measured now; may be called from any thread.
        language: What understands people, if that runs in this process.
    """

    state: WebState
    store: WebStore
    link: Link
    feeds: Feeds
    pusher: Pusher

    stopper: Stopper
    outbox: Outbox

    def __init__(
        self,
        transport: Transport,
        config: WebConfig,
        *,
        pairs: bool = False,
        clock: Clock | None = None,
        stop_line: StopLine | None = None,
        at_rest: Callable[[str], bool | None] = lambda _: None,
        language: EngineInUse | None = None,
    ) -> None:
        self.transport, self.config, self.language = transport, config, language
        self._stop_line, self._at_rest = stop_line, at_rest
        self.clock: Clock = clock or WallClock()
        self.sessions = Sessions(self.clock, config.password, pairs=pairs, pair_as=config.pair_as)
        self.addresses: tuple[str, ...] = ()
        """Where the page can be opened; set by the server."""
        self.view_listeners: list[Callable[[MapView], None]] = []
        self.picture_listeners: list[Callable[[tuple[str, str], Picture], None]] = []
        self._sending: set[str] = set()
        """Keys of messages that are just being kept and sent."""
        self._keeping: set[asyncio.Task[None]] = set()
        self._policies: dict[str, str] = {}
        self._policy_by: dict[str, str] = {}
        """Who chose it, by robot, as JSON."""
        self._keeper: Keeper
        self._stack = AsyncExitStack()

    async def __aenter__(self) -> Self:
        try:
            await self._open()
        except BaseException:
            await self._stack.aclose()
            raise
        return self

    async def __aexit__(self, *exc: object) -> None:
        await self._stack.aclose()

    async def _open(self) -> None:
        enter = self._stack.enter_async_context
        folder = self.config.data_dir
        if folder is not None:
            held = held_folder(folder, unix_ms=self.clock.unix_ms(), name="page-in-use")
            self._stack.enter_context(held)
        self.store = await enter(await WebStore.open(folder / "web.db" if folder else ":memory:", self.clock))
        people = await enter(await PeopleStore.open(folder / FILE if folder else ":memory:", self.clock))
        await self.sessions.restore(people)
        entries, complete = await self.store.page(limit=RECENT)
        if self.config.fresh_robots:
            entries = await self._close_questions(entries)
        self.state = WebState(
            uuid.uuid4().hex,
            keep=lambda entry: self._keeper.put(entry),
            new_id=lambda: uuid.uuid4().hex,
            entries=entries,
            has_older=not complete,
            keep_pictures=self._keep_shown,
        )
        self._keeper = await enter(Keeper(self.store, self.state.show))
        for name in await self.store.settings("robot"):
            self.state.robots.add(name)
        await self._tell_favourites()
        self._policies = await self.store.settings("policy")
        self._policy_by = await self.store.settings("policy_by")
        self.link = await enter(
            Link(
                self.transport,
                self.state,
                self.clock,
                pressed=await self.store.pressed(),
                on_view=self._on_view,
                on_joined=self._on_joined,
                on_planner=self._on_planner,
            )
        )
        loop = asyncio.get_running_loop()
        self.stopper = Stopper(
            self._stop_line,
            lambda: self.state.robots.views,
            lambda command: _in(loop, lambda: self.link.send(command)),
            self.clock,
            self._at_rest,
            lambda targets: self.state.robots.known_stops(targets),
        )
        self.sessions.tell = self.link.send
        await self.sessions.refresh()
        watch = asyncio.create_task(self.sessions.watch(), name="web people")
        self._stack.push_async_callback(_cancel, watch)
        fresh = self.config.fresh_robots
        self.outbox = Outbox(self.link, self.store, self.state, self.clock, self.stopper, fresh_robots=fresh)
        self._stack.push_async_callback(self.outbox.close)
        await self.outbox.settle()
        self.pusher = await enter(
            Pusher(
                self.store,
                self.state,
                self.sessions,
                folder=folder,
                services=self.config.push_services,
                contact=f"https://{urlsplit(next(iter(self.addresses), '')).hostname or 'localhost'}",
            )
        )
        self.feeds = await enter(
            Feeds(self.transport, self.state.feeds, lambda: list(self.state.robots.views), self._on_picture)
        )

    async def _close_questions(self, entries: list[ChatEntry]) -> list[ChatEntry]:
        """The robots start anew and do not remember what they asked."""
        asked = await self.store.open_questions()
        closed = {entry.id: entry.model_copy(update={"question": "interrupted"}) for entry in asked}
        await self.store.keep(list(closed.values()))
        return [closed.get(entry.id, entry) for entry in entries]

    # -- what the page asks for ------------------------------------------------------------------------

    @property
    def info(self) -> ServerInfo:
        """What the page should know about the system behind it."""
        config, chosen = self.config, self.language.chosen if self.language is not None else ""
        words, alone = engine_in_words(chosen) if chosen else (config.language, config.offline_language)
        return ServerInfo(
            version=__version__,
            language=words,
            offline_language=alone,
            can_choose_language=self.language is not None,
            is_language_chosen=bool(chosen),
            modules=config.modules,
            examples=config.examples,
            tour=config.tour,
            addresses=self.addresses,
            unattended=config.unattended,
            unattended_after_s=config.unattended_after_s,
            stop_words=STOP_WORDS,
        )

    def snapshot(self) -> Snapshot:
        """Everything as it stands."""
        return self.state.snapshot(self.info)

    def need(self, module: Module) -> None:
        """Refuse what belongs to a module that is switched off.

        Raises:
            WebProblem: It is.
        """
        if module in self.config.without:
            raise WebProblem(404, "This part is switched off here.")

    def robot(self, name: str) -> RobotView:
        """The robot of that name.

        Raises:
            WebProblem: There is none.
        """
        known = self.state.robots.resolve(name)
        if known is None:
            names = ", ".join(self.state.robots.views) or "none at the moment"
            raise WebProblem(404, f"There is no robot called {name}.", f"The robots are: {names}.")
        return self.state.robots.views[known]

    async def say(self, post: ChatPost, by: Principal) -> ChatEntry:
        """Keep an operator's message and send it, once however often it is posted.

        Raises:
            WebProblem: A picture cannot be read, the question is settled, or it is being sent right now.
            StoreError: It cannot be kept; then it is not sent either, unless there is a stop word in it.
        """
        if post.id in self._sending:
            raise WebProblem(409, "This message is just being sent.", "Wait a moment.", path="id")
        self._sending.add(post.id)
        try:
            return await self._say(post, by)
        finally:
            self._sending.discard(post.id)

    async def _say(self, post: ChatPost, by: Principal) -> ChatEntry:
        if has_stop_word(post.text):
            return await self._say_at_once(post, by)
        known = await self.store.entry(post.id)
        if known is not None:
            return await self._say_again(post, known)
        self._check_reply(post)
        pictures = [kept_picture(f"{post.id}.{number}", image) for number, image in enumerate(post.images)]
        composed = self._composed(post, by, pictures)
        chat, taken = self.state.chat, {post.reply_to, *composed.answered} - {""}
        chat.being_answered |= taken
        try:
            await self.store.keep([composed.entry], pictures, composed.messages)
            chat.said(composed)
        finally:
            chat.being_answered -= taken
        await self.outbox.say(composed.entry, composed.messages)
        return composed.entry

    async def _say_at_once(self, post: ChatPost, by: Principal) -> ChatEntry:
        """Hold the robots and send words that may stop them before anything else; no disk is waited for."""
        known = self.state.chat.entries.get(post.id)
        if known is not None:
            return known
        self.stopper.hold(post.targets, by=by, id=post.id, words=post.text)
        try:
            self._check_reply(post)
            pictures = [kept_picture(f"{post.id}.{index}", image) for index, image in enumerate(post.images)]
        except WebProblem:
            post, pictures = post.model_copy(update={"reply_to": "", "images": ()}), []
        composed = self._composed(post, by, pictures)
        for message in composed.messages:
            self.link.begin(message)
        self.state.chat.said(composed)
        self._in_background(self._keep_later(composed, pictures))
        return composed.entry

    async def _keep_later(self, composed: Composed, pictures: Sequence[KeptPicture]) -> None:
        """Who was held goes on only when the words are read: they are said again like all others."""
        entry = composed.entry
        try:
            await self.store.keep([entry], pictures, composed.messages)
        except StoreError as error:
            log.error("message not stored", id=entry.id, problem=str(error))
            text = "I got that, but it cannot be kept: it will be missing here after the next start."
            told = ChatFeedback(message=text, targets=entry.targets, type="error", reply_to=entry.id)
            self.state.chat.on_feedback(told, unix_ms=self.clock.unix_ms())
        await self.outbox.said(entry, composed.messages)

    def _composed(self, post: ChatPost, by: Principal, pictures: Sequence[KeptPicture]) -> Composed:
        return self.state.chat.compose(
            post.id,
            post.text,
            tuple(dict.fromkeys(self.state.robots.resolve(name) or name for name in post.targets)),
            reply_to=post.reply_to,
            images=[ChatImage(name=image.name, data=image.data) for image in post.images],
            image_urls=[_address(picture) for picture in pictures],
            by=by,
            unattended=post.unattended,
            unix_ms=self.clock.unix_ms(),
        )

    async def _say_again(self, post: ChatPost, known: ChatEntry) -> ChatEntry:
        """A message that was posted before: it goes out, as it was, only if it may not have gone yet."""
        if known.message != post.text:
            raise WebProblem(409, "Another message has this id.", "Send it under a new one.", path="id")
        for entry, messages in await self.store.unsent(post.id):
            if entry.id not in self.outbox.waiting:
                await self.outbox.say(entry, messages)
        return known

    def _check_reply(self, post: ChatPost) -> None:
        """Of several answers at once, of several people too, one counts."""
        if not post.reply_to or not (
            post.reply_to in self.state.chat.being_answered
            or self.state.chat.is_settled(post.reply_to, post.id)
        ):
            return
        raise WebProblem(
            409,
            "This question is settled already.",
            "Look at the conversation, and write anew if there is more to say.",
            path="reply_to",
        )

    async def add_robot(self, name: str) -> RobotView:
        """List a robot by name, for good."""
        await self.store.set("robot", name, "")
        return self.state.robots.add(name)

    async def remove_robot(self, name: str) -> None:
        """Take a robot off the list.

        Raises:
            WebProblem: There is none of that name, or it is there and would come back at once.
        """
        view = self.robot(name)
        if view.connection == "here":
            raise WebProblem(409, f"{view.name} is here; it would come back at once.", "Switch it off first.")
        await self.store.unset("robot", view.name)
        self.state.remove_robot(view.name)

    async def keep_favourite(self, favourite: Favourite, was: str = "") -> None:
        """Keep an order under a name, in the place of the one that had the name `was`."""
        before = next(
            (one.name for one in self.state.favourites if one.name.casefold() == was.casefold()), ""
        )
        if before:
            await self.store.rename("favourite", before, favourite.name, favourite.words)
        else:
            await self.store.set("favourite", favourite.name, favourite.words)
        await self._tell_favourites()

    async def drop_favourite(self, name: str) -> None:
        """Keep it no longer."""
        await self.store.unset("favourite", name)
        await self._tell_favourites()

    async def _tell_favourites(self) -> None:
        kept = await self.store.settings("favourite")
        self.state.set_favourites(Favourite(name=name, words=words) for name, words in kept.items())

    async def set_policy(self, robot: str, policy: Policy, by: Principal) -> None:
        """Decide whether new steps of a robot wait for a yes, also after a restart."""
        await self.store.set("policy", robot, policy)
        await self.store.set("policy_by", robot, by.model_dump_json())
        self._policies[robot], self._policy_by[robot] = policy, by.model_dump_json()
        await self.outbox.press(self._policy_told(robot))

    # -- what comes in ---------------------------------------------------------------------------------

    def _on_joined(self, robot: str) -> None:
        if robot in self._policies:
            self.link.send(self._policy_told(robot))

    def _on_planner(self) -> None:
        for robot in self._policies:
            self.link.send(self._policy_told(robot))

    def _policy_told(self, robot: str) -> PlanDecision:
        """What somebody chose counts in their name, whenever the robot is told."""
        known = self._policy_by.get(robot)
        by = Principal.model_validate_json(known) if known else person(device="page")
        decision = {"target": robot, "decision": "policy", "policy": self._policies[robot], "by": by}
        return PlanDecision.model_validate(decision)

    def _on_view(self, view: MapView) -> None:
        for listener in self.view_listeners:
            listener(view)

    def _on_picture(self, key: tuple[str, str], picture: Picture) -> None:
        for listener in self.picture_listeners:
            listener(key, picture)
        if not self.state.feeds.infos[key].continuous:
            self._in_background(self._keep_seen(key, picture))

    def _keep_shown(self, key: str, images: Sequence[ChatImage]) -> tuple[str, ...]:
        """What a robot shows with its words; what is no picture is left out."""
        kept: list[KeptPicture] = []
        for number, image in enumerate(images):
            try:
                kept.append(kept_picture(f"{key}.{number}", image))
            except WebProblem as problem:
                log.warning("picture left out", entry=key, problem=problem.detail)
        self._keeper.put_pictures(kept)
        return tuple(_address(picture) for picture in kept)

    async def _keep_seen(self, key: tuple[str, str], picture: Picture) -> None:
        """A single picture is a finding: it is kept for the history."""
        digest = hashlib.sha256("\n".join((*key, str(picture.unix_ms))).encode()).hexdigest()[:32]
        kept = KeptPicture(digest, "image/jpeg", picture.data)
        try:
            await self.store.keep_seen(key[0], picture.unix_ms, kept)
        except StoreError as error:
            log.error("picture not stored", robot=key[0], problem=str(error))

    def _in_background(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work, name="web keeping")
        self._keeping.add(task)
        task.add_done_callback(self._keeping.discard)


def _address(picture: KeptPicture) -> str:
    return f"/api/chat/images/{picture.id}"


def _in(loop: asyncio.AbstractEventLoop, deed: Callable[[], None]) -> None:
    with suppress(RuntimeError):  # the loop is closed: nobody is left who could be told
        loop.call_soon_threadsafe(deed)


async def _cancel(task: asyncio.Task[None]) -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
