"""Changes of the plan said in several clauses: with reasons around them, and with pronouns.

"Barrel 2 was done this morning, so there is no point in it" drops barrel 2; "the hall can wait, do the
gate before it" puts the gate before the hall. Each clause changes what the clauses before it left; whatever
neither changes anything nor only tells makes the whole message something else.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

from parley.language.offline.grammar.small import is_past
from parley.language.offline.grammar.things import items_of
from parley.language.offline.plan_changes.pending import pending_visits
from parley.language.offline.plan_changes.replanning import Change, Edit, pops, same_steps, visit_of
from parley.language.offline.plan_changes.restated import named_visits, restated
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, tokens
from parley.messages.chat import ActionCall

__all__ = ["by_clause"]

Bare = Callable[[Phrase], Phrase]
Read = Callable[[Phrase, Scene], Change | None]

_MOST_CLAUSES = 7
_MARKS = frozenset({",", ".", ";", "!", ":", "-"})
_REASONS = frozenset({"because", "since", "as", "seeing", "for"})
_JOINS = frozenset({"so", "but", "though", "although", "therefore"})
_POINTING = (("that", "one"), ("this", "one"), ("it",), ("them",), ("there",), ("that",))
_FINITE = frozenset(
    {"has", "have", "had", "did", "does", "will", "would", "got", "can", "could", "says", "wants"}
)
_WANTING = frozenset({"one", "need", "want", "rather", "instead", "better", "prefer", "should"})
_IN_PLACE = frozenset({
    "i", "said", "will", "would", "do", "instead", "is", "what", "meant", "mean", "need", "want",
    "wanted", "please",
    "rather", "yes", "we", "the", "for", "that", "me", "was", "have", "take", "visit", "just", "put",
    "in", "its", "place",
})  # fmt: skip
_KEEPING = frozenset({("only",), ("just",), ("keep",), ("leave",)})
_OTHERS = frozenset({"rest", "others", "other", "else", "ones", "remaining"})
_STAYING = frozenset({
    "the", "all", "stays", "stands", "stay", "stand", "yes", "is", "are", "as", "it", "they", "was", "were",
    "planned", "before", "unchanged", "same", "fine", "ok", "okay", "remains", "remain", "good",
    "please", "do", "everything", "keep", "leave", "two", "three", "after", "that", "then", "later",
    "afterwards", "and", "go", "on",
})  # fmt: skip
_SAME = frozenset(
    tuple(text.split())
    for text in (
        "same check", "same thing", "same thing there", "same there", "the same check", "same again",
        "likewise",
        "same as the others", "same job", "same treatment", "ditto", "the same there", "the same", "same",
    )
)  # fmt: skip


def by_clause(words: Phrase, scene: Scene, bare: Bare, read: Read) -> Change | None:
    """The change of the plan that the clauses of a message come to; None if one asks for anything else.

    Args:
        words: All words and punctuation.
        scene: What is known, with its pending steps.
        bare: Takes off what only leads up to a change ("actually", "could you").
        read: Reads a change that is said in one clause.
    """
    parts = _parts(words)
    whole = restated(words, scene) if len(parts) > 1 else None
    if whole is not None:
        return Change(whole)
    return _Clauses(scene, bare, read).all(parts) if len(parts) <= _MOST_CLAUSES else None


def _parts(words: Phrase) -> list[tuple[Phrase, bool]]:
    """The clauses, and whether each only says why."""
    parts: list[tuple[Phrase, bool]] = []
    now: list[int] = []
    reason = False
    for i, word in enumerate((*words, None)):
        key = "." if word is None else word.key
        starts = key in _REASONS and i + 2 < len(words) and _tells(words[i + 1 : i + 6])
        if key in _MARKS or key in _JOINS or starts:
            if now:
                parts.append((words[now[0] : now[-1] + 1], reason))
            now, reason = [], starts
        else:
            now.append(i)
    return parts


def _names_other(words: Phrase, scene: Scene) -> bool:
    """Whether something of the map is named."""
    return any(item.thing is not None for item in items_of(words, scene))


def _tells(words: Phrase) -> bool:
    """Whether a clause tells something, and asks for nothing."""
    flat = keys(words)
    finite = bool(set(flat) & (lexicon().be | _FINITE)) or any(
        is_past(word) or word.endswith(("'s", "'ve", "'d")) for word in flat[1:] + flat[:1]
    )
    return finite and not opens_command(words)


_STAYS = lexicon().be | {"can", "may", "could", "should", "need", "needs", "stays", "stay", "has", "have"}
_LONGEST_STEP = 4


@dataclass
class _Clauses:
    """Clauses read one after the other."""

    scene: Scene
    bare: Bare
    read: Read
    topic: Phrase = ()
    """What was named last."""
    loose: bool = False
    """Whether a clause was passed over that is only right if another one says more about its topic."""
    order: Phrase = ()
    at: int = 0
    gone: Phrase = ()
    """What the clause before left out."""
    before: list[tuple[int, ActionCall]] = field(default_factory=list)
    """The plan before that."""
    alone: bool = False
    """Whether the clause before was nothing but a name."""
    dropped: bool = False
    changed: bool = False
    replies: list[str] = field(default_factory=list)

    def all(self, parts: Sequence[tuple[Phrase, bool]]) -> Change | None:
        """The change that all clauses come to."""
        queue = self.scene.situation.queue
        self.left: list[tuple[int, ActionCall]] = list(enumerate(queue))
        for words, reason in parts:
            if not (self._tell(words) if reason else self._clause(self.bare(words))):
                return None
        if not self.changed or self.loose:
            return None
        if self.order:
            places = [i for i, _ in self.left]
            if places != sorted(places) or -1 in places:
                return None
            gone = set(range(len(queue))) - set(places)
            at = places[self.at] if self.at < len(places) else len(queue)
            return Change(Edit(pops(gone), " ".join(self.replies)), self.order, at)
        kept = [step for _, step in self.left]
        same = next(
            (i for i, (a, b) in enumerate(zip(queue, kept, strict=False)) if a is not b),
            min(len(queue), len(kept)),
        )
        again = tuple(kept[same:])
        if any(step.flow is not None for step in again):
            return None
        return Change(Edit(pops(range(same, len(queue))), " ".join(self.replies), again))

    def _now(self) -> Scene:
        """The scene with what is left of the plan."""
        return Scene.of(replace(self.scene.situation, queue=tuple(step for _, step in self.left)))

    def _clause(self, words: Phrase) -> bool:
        """Carry out what a clause changes; whether it was understood."""
        if not words:
            return True
        now = self._now()
        if self._adds_same(words, now):
            return True
        if not self.left or self.order:
            return self._tell(words)
        if self._confirms(words, now) or self._each(words):
            return True
        change = self._change(words, now)
        if change is None and self.alone:
            change = self._change((*self.topic, *words), now)
        if change is None and self.topic and keys(words[-1:]) == ("instead",):
            # "A is closed. Go to B instead."
            change = self.read((*words[:-1], *tokens("instead of"), *self.topic), now)
        if change is None and self.gone:
            change = self._in_its_place(words)
        self.alone = False
        if change is not None:
            self._remember(change, words, now)
            self._apply(change)
            self._note(words, now)
            return True
        return self._goes_on(words) or self._tell(words)

    def _goes_on(self, words: Phrase) -> bool:
        """For "drop A, go to B": a new order comes at the end."""
        idle = words[0].key in {"do", "just", "only", "then", "simply"}
        words = words[1:] if idle and opens_command(words[1:]) else words
        if not self.dropped or not opens_command(words) or not _names_other(words, self.scene):
            return False
        if visit_of(words, self._now()) == 0:
            # "Forget A, go straight to B", which comes next anyway.
            return True
        self.order, self.at = words, len(self.left)
        return True

    def _remember(self, change: Change, words: Phrase, now: Scene) -> None:
        """Keep in mind what a clause leaves out, for what may come in its place."""
        drops = (
            change.edit is not None
            and bool(change.edit.commands)
            and not change.edit.queue
            and not change.order
        )
        found = named_visits(tuple(w for w in words if w.is_word), now) if drops else []
        self.gone = tuple(w for w in words if w.is_word)[found[0][0] : found[0][1]] if found else ()
        self.before = list(self.left)

    def _in_its_place(self, words: Phrase) -> Change | None:
        """For "leave A out, B will do": what is dropped gives way to what is named."""
        body = tuple(word for word in words if word.is_word)
        while body and body[-1].key in _IN_PLACE:
            body = body[:-1]
        while body and body[0].key in _IN_PLACE - {"one", "the"}:
            body = body[1:]
        if not body or len(body) > 6:
            return None
        after, self.left = self.left, self.before
        change = self.read((*body, *tokens("instead of"), *self.gone), self._now())
        if change is None:
            self.left = after
        else:
            self.replies.pop()
        return change

    def _each(self, words: Phrase) -> bool:
        """For "A first and B last": one change after the other, if each part is one."""
        if "and" not in keys(words):
            return False
        parts: list[Phrase] = [()]
        for word in words:
            if word.key == "and":
                parts.append(())
            else:
                parts[-1] = (*parts[-1], word)
        trial = replace(self, replies=list(self.replies))
        trial.left = list(self.left)
        for part in parts:
            known = len(trial.replies)
            if not part or not trial._clause(self.bare(part)) or len(trial.replies) == known:
                return False
        self.__dict__.update(trial.__dict__)
        return True

    def _change(self, words: Phrase, now: Scene) -> Change | None:
        named = self._pointed(words) if not named_visits(words, now) or "it" in keys(words) else words
        change = self.read(named, now)
        if change is not None:
            return change
        edit = restated(named, now)
        return Change(edit) if edit is not None else None

    def _pointed(self, words: Phrase) -> Phrase:
        """With what was named before in the place of "it" and "there"."""
        flat = keys(words)
        for said in _POINTING if self.topic else ():
            for at in range(len(flat) - len(said) + 1):
                behind = flat[at + len(said) : at + len(said) + 1]
                if flat[at : at + len(said)] == said and not (behind and behind[0] in lexicon().be | {"'s"}):
                    self.loose = False
                    return (*words[:at], *self.topic, *words[at + len(said) :])
        return words

    def _tell(self, words: Phrase) -> bool:
        """Whether a clause may be passed over: it tells something, or names what the next one is about."""
        now = self._now()
        known = self._note(words, now)
        if set(keys(words)) & _WANTING and not known and _names_other(words, now):
            # "Never mind A, B is the one I need".
            return False
        self.alone = bool(pending_visits(words, now))
        if (
            _tells(words)
            or self.alone
            or (set(keys(words)) & _OTHERS and set(keys(words)) <= _OTHERS | _STAYING)
        ):
            return True
        if keys(words[:1]) in {("whatever",), ("everything",), ("all",), ("anything",)}:
            self.topic, self.loose = words, True
            return True
        self.loose = self.loose or known
        return known and not self.order

    def _note(self, words: Phrase, now: Scene) -> bool:
        """Keep in mind what is named; whether anything pending is."""
        found = named_visits(tuple(w for w in words if w.is_word), now)
        if found:
            start, end, _ = found[0]
            self.topic = tuple(w for w in words if w.is_word)[start:end]
            return True
        deed = self._only_step(words, now)
        self.topic = deed or self.topic
        return bool(deed)

    def _only_step(self, words: Phrase, now: Scene) -> Phrase:
        """For "the curtain can stay open": the words for a pending step that nothing of the map names."""
        flat = keys(words)
        link = next((i for i in range(1, len(flat)) if flat[i] in _STAYS), 0)
        if not link or flat[0] not in lexicon().determiners or link > _LONGEST_STEP:
            return ()
        change = self.read((*tokens("leave out"), *words[:link]), now)
        drops = change is not None and change.edit is not None and not change.edit.queue and not change.order
        return words[:link] if drops else ()

    def _confirms(self, words: Phrase, now: Scene) -> bool:
        """For "drop the gates, only the hall": what is left anyway is named."""
        flat = keys(words)
        return self.dropped and flat[:1] in _KEEPING and bool(pending_visits(words[1:], now))

    def _adds_same(self, words: Phrase, now: Scene) -> bool:
        """For "put A in before B, same check": what is done at B is done at A."""
        if keys(words) not in _SAME or not self.order or keys(self.order[:1]) != ("visit",):
            return False
        return self._same_as(now)

    def _same_as(self, now: Scene) -> bool:
        found = same_steps(self.order[1:], now, self.at)
        if found is None:
            return False
        self.left[self.at : self.at] = [(-1, step) for step in found[1]]
        self.order = ()
        self.replies.append(f"I will do the same at {found[0]}.")
        return True

    def _apply(self, change: Change) -> None:
        self.changed = True
        edit = change.edit or Edit((), "")
        gone = {command.pop_index for command in edit.commands}
        kept = [item for i, item in enumerate(self.left) if i not in gone]
        self.dropped = self.dropped or bool(gone and not edit.queue)
        if change.order:
            self.order = change.order
            self.at = change.at - sum(1 for i in gone if i is not None and i < change.at)
        before = {id(step): i for i, step in self.left}
        self.left = [*kept, *((before.get(id(step), -1), step) for step in edit.queue)]
        self.replies += [edit.reply] if edit.reply else []
