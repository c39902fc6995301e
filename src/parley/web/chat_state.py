"""The conversation with all robots as one chronology: who said what to whom, and what awaits an answer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from parley.gate.control import control_of
from parley.messages.attendance import Unattended
from parley.messages.chat import ChatFeedback, ChatImage, ChatInput, ReplyDraft
from parley.messages.principal import Principal
from parley.messages.repeats import Repeats
from parley.web.models import ChatEntry

__all__ = ["KEPT_ENTRIES", "ChatBook", "Composed", "KeepPictures"]

KeepPictures = Callable[[str, Sequence[ChatImage]], tuple[str, ...]]

KEPT_ENTRIES: Final = 500
"""How many of the newest entries are held ready; older ones are in the store."""


@dataclass(frozen=True, slots=True)
class Composed:
    """What one message of an operator becomes: one entry for people, one or more messages for robots."""

    entry: ChatEntry
    messages: tuple[ChatInput, ...]
    answered: tuple[str, ...]
    """Keys of the questions that it answers."""


class ChatBook:
    """The newest part of the conversation.

    Args:
        emit: Gets each entry that is new or has changed.
        new_id: Makes keys for what comes without one.
        entries: The end of the conversation so far, oldest first.
        keep_pictures: Keeps what a robot shows with the entry of a key; gives the addresses of it.
    """

    def __init__(
        self,
        emit: Callable[[ChatEntry], None],
        new_id: Callable[[], str],
        entries: Iterable[ChatEntry] = (),
        keep_pictures: KeepPictures = lambda key, images: (),
    ) -> None:
        self._emit, self._new_id, self._keep_pictures = emit, new_id, keep_pictures
        self.entries: dict[str, ChatEntry] = {entry.id: entry for entry in entries}
        self.next_seq = max((entry.seq for entry in self.entries.values()), default=0) + 1
        self._asked_as: dict[str, str] = {}
        """Key of an open question -> its id on the wire, perhaps empty."""
        self.being_answered: set[str] = set()
        """Keys of questions whose answer is not kept yet: nothing else answers them."""
        self._left_open: dict[str, None] = {}
        """Keys of replies that ask for more: whatever is said next to the robot settles them."""
        self._wishes = dict.fromkeys(key for key, entry in self.entries.items() if entry.asks_yes)
        """Keys of messages that ask for a yes to what is proposed."""
        self._said_as: dict[str, str] = {}
        """Id of a message on the wire -> key of its entry, where they differ."""
        self._repeats = Repeats()

    # -- what operators say ----------------------------------------------------------------------------

    def compose(
        self,
        key: str,
        text: str,
        targets: Sequence[str],
        *,
        reply_to: str = "",
        images: Sequence[ChatImage] = (),
        image_urls: Sequence[str] = (),
        by: Principal,
        unattended: Unattended | None = None,
        unix_ms: int,
    ) -> Composed:
        """What an operator's message becomes; nothing is changed yet, see `said`.

        Robots that await an answer get the message as one, the others as a new request. Words of control
        ("stop") answer nothing.

        Args:
            key: Key of the entry.
            text: The operator's words.
            targets: Names of robots.
            reply_to: Key of the question that is meant, where a robot asked several.
            images: Attached pictures.
            image_urls: Where the page finds them.
            by: Who says it.
            unattended: What becomes of it when nobody is connected.
            unix_ms: Now.
        """
        asked = {target: self._question_of(target, reply_to) for target in targets}
        if control_of(text, tuple(targets)) not in (None, "start"):
            asked = dict.fromkeys(targets)
        answered = tuple(dict.fromkeys(question for question in asked.values() if question is not None))
        ordered = [target for target in targets if asked[target] is None]
        groups = [("", ordered)] if ordered else []
        groups += [(q, [target for target in targets if asked[target] == q]) for q in answered]
        messages = tuple(
            ChatInput(
                message=text,
                targets=tuple(group),
                type="response" if question else "request",
                id=key if number == 0 else f"{key}~{number}",
                reply_to=self._asked_as.get(question, ""),
                author=by.name,
                by=by,
                images=tuple(images),
                unattended=unattended,
            )
            for number, (question, group) in enumerate(groups)
        )
        entry = ChatEntry(
            id=key,
            seq=self.next_seq,
            unix_ms=unix_ms,
            who="operator",
            author=by.name,
            device=by.device,
            targets=tuple(targets),
            type="response" if answered and not ordered else "request",
            message=text,
            images=tuple(image_urls),
            reply_to=answered[0] if answered else "",
        )
        self.next_seq += 1
        return Composed(entry, messages, answered)

    def said(self, composed: Composed) -> None:
        """The message was kept and sent."""
        self._put(composed.entry)
        for message in composed.messages:
            if message.id != composed.entry.id:
                self._said_as[message.id] = composed.entry.id
        for question in (*composed.answered, *self._left_open_by(composed.entry.targets)):
            self._settle(question, answer_id=composed.entry.id)

    def on_input(self, said: ChatInput, *, unix_ms: int) -> None:
        """A message on the wire: of another client, or the echo of our own."""
        if said.id in self.entries or said.id in self._said_as or self._repeats.count(said, unix_ms / 1000):
            return
        origin = said.id.partition("~")[0]
        if origin in self.entries:  # an answer that turned out to be something else, taken up as a request
            self._said_as[said.id] = origin
            return
        key = said.id or self._new_id()
        questions = [self._question_of(name, self._key_of_question(said.reply_to)) for name in said.targets]
        answered = [q for q in questions if q is not None] if said.type == "response" else []
        self._put(
            ChatEntry(
                id=key,
                seq=self._take_seq(),
                unix_ms=unix_ms,
                who="operator",
                author=said.who.name,
                device=said.who.device,
                targets=said.targets,
                type=said.type,
                message=said.message,
                reply_to=answered[0] if answered else "",
            )
        )
        for question in (*answered, *self._left_open_by(said.targets)):
            self._settle(question, answer_id=key)

    # -- what robots say -------------------------------------------------------------------------------

    def on_feedback(self, feedback: ChatFeedback, *, unix_ms: int) -> None:
        """A robot speaks."""
        self._close_questions(feedback)
        draft = self.entries.get(_draft_key(feedback.reply_to, feedback.targets))
        is_reply = draft is not None and draft.draft
        if feedback.type == "request" and self._is_repeated(feedback):
            return
        key = draft.id if draft is not None and is_reply else feedback.id
        if not key or (key in self.entries and not is_reply):
            key = self._new_id()
        self._put(
            ChatEntry(
                id=key,
                seq=draft.seq if draft is not None and is_reply else self._take_seq(),
                unix_ms=unix_ms,
                who="robot",
                targets=feedback.targets,
                type=feedback.type,
                message=feedback.message,
                choices=feedback.choices,
                rules=feedback.rules,
                sources=feedback.sources,
                images=self._keep_pictures(key, feedback.images) if feedback.images else (),
                engine=_short(feedback.engine),
                question="open" if feedback.type == "request" or feedback.asks_back else "",
                asks_yes=feedback.asks_yes,
                reply_to=self._said_as.get(feedback.reply_to, feedback.reply_to),
            )
        )
        if feedback.type == "request":
            self._asked_as[key] = feedback.id
        elif feedback.asks_back:
            self._left_open[key] = None
        if self.entries[key].asks_yes:
            self._wishes[key] = None
        if feedback.still_asks:
            self._ask_on(feedback)

    def on_draft(self, draft: ReplyDraft, *, unix_ms: int) -> None:
        """A reply grows; drafts come too late or not at all without doing harm."""
        key = _draft_key(draft.reply_to, draft.targets)
        known = self.entries.get(key)
        if known is not None and not known.draft:
            return
        self._put(
            ChatEntry(
                id=key,
                seq=known.seq if known is not None else self._take_seq(),
                unix_ms=known.unix_ms if known is not None else unix_ms,
                who="robot",
                targets=draft.targets,
                type="response",
                message=draft.message,
                reply_to=self._said_as.get(draft.reply_to, draft.reply_to),
                draft=True,
            )
        )

    def on_decided(self, robot: str) -> None:
        """Nothing that a robot proposed waits for a yes any more."""
        for key in [key for key in self._wishes if _awaits(self.entries.get(key), robot)]:
            del self._wishes[key]
            self._put(self.entries[key].model_copy(update={"asks_yes": False}))

    def on_restart(self, robot: str) -> None:
        """A robot was started anew: it does not remember what it asked."""
        asked = [key for key in self._asked_as if _awaits(self.entries.get(key), robot)]
        for key in (*asked, *self._left_open_by((robot,))):
            self._settle(key)

    # -- questions -------------------------------------------------------------------------------------

    def is_open(self, key: str) -> bool:
        """Whether the entry `key` is a question that awaits an answer."""
        return key in self._asked_as

    def is_settled(self, key: str, answer_id: str) -> bool:
        """Whether an entry is a question that was answered otherwise, or an offer that was followed up."""
        asked = self.entries.get(key)
        if asked is None or asked.question == "open" or asked.answer_id == answer_id:
            return False
        later = [one for one in self.entries.values() if one.seq > asked.seq]
        orders = {one.id for one in later if one.who == "operator"}
        # Whom it was said to, or who replied to it as they were called in it.
        about = (one for one in later if one.id in orders or one.reply_to in orders)
        return asked.question != "" or any(set(one.targets) & set(asked.targets) for one in about)

    def _question_of(self, robot: str, wanted: str) -> str | None:
        """The question of `robot` that an answer settles: the wanted one, else the newest."""
        open_ones = (key for key in self._asked_as if key not in self.being_answered)
        waiting = [key for key in open_ones if _awaits(self.entries.get(key), robot)]
        return wanted if wanted in waiting else next(reversed(waiting), None)

    def _left_open_by(self, robots: Sequence[str]) -> list[str]:
        """The replies of robots that ask for more."""
        return [key for key in self._left_open if any(_awaits(self.entries.get(key), one) for one in robots)]

    def _key_of_question(self, wire_id: str) -> str:
        return next((key for key, asked in self._asked_as.items() if asked and asked == wire_id), "")

    def _is_repeated(self, feedback: ChatFeedback) -> bool:
        key = self._key_of_question(feedback.id)
        return key != "" and self.entries[key].message == feedback.message

    def _close_questions(self, feedback: ChatFeedback) -> None:
        """Questions are closed by name; those without one last until the robot's next words."""
        if feedback.closes and (key := self._key_of_question(feedback.closes)):
            self._settle(key)
        if feedback.type in ("request", "response"):
            said = self.entries.get(self._said_as.get(feedback.reply_to, feedback.reply_to))
            for key in self._left_open_by(feedback.targets) if feedback.type == "response" else ():
                if said is None or said.seq > self.entries[key].seq:
                    self._settle(key, answer_id=said.id if said is not None else "")
            for robot in feedback.targets:
                nameless = [key for key, asked in self._asked_as.items() if not asked]
                for key in [key for key in nameless if _awaits(self.entries.get(key), robot)]:
                    self._settle(key)

    def _ask_on(self, feedback: ChatFeedback) -> None:
        """What was said next was no answer to what a reply asked: it may be answered yet."""
        message = self._said_as.get(feedback.still_asks, feedback.still_asks)
        for key, entry in tuple(self.entries.items()):
            is_it = entry.reply_to == message and any(_awaits(entry, robot) for robot in feedback.targets)
            if is_it and entry.type == "response" and entry.question == "answered":
                self._left_open[key] = None
                self._put(entry.model_copy(update={"question": "open", "answer_id": ""}))

    def _settle(self, key: str, *, answer_id: str = "") -> None:
        self._asked_as.pop(key, None)
        self._left_open.pop(key, None)
        entry = self.entries.get(key)
        if entry is not None and entry.question == "open":
            state = "answered" if answer_id else "closed"
            self._put(entry.model_copy(update={"question": state, "answer_id": answer_id}))

    # -- keeping ---------------------------------------------------------------------------------------

    def newest(self, limit: int = 100) -> list[ChatEntry]:
        """The newest entries and all open questions, oldest first."""
        ordered = sorted(self.entries.values(), key=lambda entry: entry.seq)
        cut = max(len(ordered) - limit, 0)
        return [entry for entry in ordered[:cut] if entry.question == "open"] + ordered[cut:]

    def _take_seq(self) -> int:
        self.next_seq += 1
        return self.next_seq - 1

    def _put(self, entry: ChatEntry) -> None:
        self.entries[entry.id] = entry
        if len(self.entries) > 2 * KEPT_ENTRIES:
            ordered = sorted(self.entries.values(), key=lambda item: item.seq)
            for old in ordered[:-KEPT_ENTRIES]:
                if old.id not in self._asked_as and old.id not in self._left_open:
                    del self.entries[old.id]
            kept = set(self.entries)
            self._wishes = {key: None for key in self._wishes if key in kept}
            self._said_as = {wire: key for wire, key in self._said_as.items() if key in kept}
        self._emit(entry)


def _short(engine: str) -> str:
    """A language engine's name without what is said about it."""
    return engine.partition(" (")[0]


def _draft_key(reply_to: str, targets: Sequence[str]) -> str:
    """One message to several robots gets several replies."""
    return f"reply-{reply_to}-{'+'.join(targets)}" if reply_to else ""


def _awaits(entry: ChatEntry | None, robot: str) -> bool:
    wanted = robot.casefold()
    return entry is not None and any(target.casefold() == wanted for target in entry.targets)
