"""The plan changed by a message, and the last order carried out once more but differently."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from parley.language.base import Situation
from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.dialogue.asked import asked
from parley.language.offline.dialogue.own_state import ABOUT_ITSELF
from parley.language.offline.dialogue.plain_question import plain_question
from parley.language.offline.dialogue.questions import unwrapped
from parley.language.offline.facts.recalling import Recalling
from parley.language.offline.plan_changes.once_more import changed_again
from parley.language.offline.plan_changes.rearranging import rearranged, without_going_on
from parley.language.offline.plan_changes.replanning import Change, Edit, visit_of, visits
from parley.language.offline.scene.grouping import grouped, names_things
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.branching import branched
from parley.language.offline.sentences.scoping import scoped
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, tokens
from parley.messages.chat import ActionCall, ChatAction, SystemCommand

__all__ = ["Rereading"]


@dataclass
class Rereading(Recalling):
    """How what is pending or was asked for last becomes another plan."""

    reread: Callable[[Phrase, Situation], ChatAction] | None = field(default=None, kw_only=True)
    """Understands an earlier message anew."""

    @abstractmethod
    def read(self, words: Phrase) -> ChatAction:
        """Understand a whole message."""

    def changed_plan(self, words: Phrase) -> ChatAction | None:
        """What a message changes of the plan as it stands, if that is all that it asks for."""
        self._mention_history()
        words = without_going_on(words)
        about_plan = _asked_of_plan(words, self.scene) if self.scene.situation.queue else None
        if about_plan is not None:
            return self._result(about_plan.text, ())
        change = rearranged(words, self.scene)
        return None if change is None else self._rearranged(change)

    def _changed_again(self, words: Phrase) -> ChatAction | None:
        """The last order once more, in another order or with other stops; None if that is not asked for."""
        different = () if self.scene.situation.queue else changed_again(words)
        if keys(different[:1]) in {("with",), ("for",), ("at",), ("in",), ("to",), ("on",)}:
            different = (*tokens("replace this one with"), *different[1:])
        orders = [turn.content for turn in self.scene.situation.history if turn.role == "operator"]
        if not different or not orders:
            return None
        situation = replace(self.scene.situation, history=(), status="idle")
        reader = type(self)(Scene.of(situation))
        last = reader.read(reader._grouped(tokens(orders[-1])))
        scene = Scene.of(replace(situation, queue=last.queue))
        change = rearranged(different, scene) if last.queue else None
        if change is None:
            return None
        action = type(self)(scene)._rearranged(change)
        gone = {command.pop_index for command in action.system_cmd}
        kept = [step for index, step in enumerate(last.queue) if index not in gone]
        return self._result(action.message_response, (*kept, *action.queue))

    def last_order(self) -> tuple[ActionCall, ...]:
        """The steps of what the operator asked for last, if that is the last thing that was said."""
        orders = [turn.content for turn in self.scene.situation.history if turn.role == "operator"]
        if not orders or self.reread is None:
            return ()
        situation = replace(self.scene.situation, history=(), status="idle", queue=())
        action = self.reread(tokens(orders[-1]), situation)
        return () if action.system_cmd else action.queue

    def _rearranged(self, change: Change) -> ChatAction:
        """Change what is pending, and do what is new in its place."""
        edit, queue = change.edit or Edit((), ""), self.scene.situation.queue
        if not change.order:
            self.scene.trace.note("edit", edit.reply)
            self.commands.extend(edit.commands)
            return self._result(edit.reply, edit.queue)
        gone = {command.pop_index for command in edit.commands}
        after = tuple(step for index, step in enumerate(queue) if index >= change.at and index not in gone)
        if any(step.flow is not None for step in after):
            after = ()
        taken = [i for i in range(len(queue)) if i in gone or (after and i >= change.at)]
        plain_scene = replace(self.scene, situation=replace(self.scene.situation, queue=()))
        new = type(self)(plain_scene, targets=self.targets).read(self._grouped(change.order))
        if not new.queue and self.reread is not None:
            new = self.reread(change.order, replace(plain_scene.situation, status="idle"))
        if not new.queue:
            new = self._at_stop(change, plain_scene) or new
        if not new.queue:
            return new
        pops = [SystemCommand(command="pop", arguments={"parameters": i}) for i in reversed(taken)]
        self.commands.extend(pops)
        reply = f"{edit.reply} {new.message_response}".strip()
        self.scene.trace.note("edit", reply)
        return self._result(reply, (*new.queue, *after))

    def _at_stop(self, change: Change, scene: Scene) -> ChatAction | None:
        """A new order that is due at a pending stop, and needs no more than to be there."""
        stop = next((v for v in visits(self.scene) if v.start + len(v.steps) == change.at and v.names), None)
        if stop is None or self.reread is None:
            return None
        words = (*change.order, *tokens("at the"), *tokens(stop.names[0]))
        found = self.reread(words, replace(scene.situation, status="idle"))
        there = [step.name for step in stop.steps[:2]]
        going = next((n for n in (2, 1) if [step.name for step in found.queue[:n]] == there[:n]), 0)
        return found.model_copy(update={"queue": found.queue[going:]}) if found.queue else None

    def _grouped(self, words: Phrase) -> Phrase:
        """The message with one word for each group, and without what is only denied."""
        read = grouped(words, self.scene)
        names = names_things(self.scene)
        return branched(scoped(read, names, lambda part: visit_of(part, self.scene) is not None).words, names)


def _asked_of_plan(words: Phrase, scene: Scene) -> Answer | None:
    """The answer to a message that only asks about the plan: it is not to be changed then."""
    asking = unwrapped(plain_question(words, marked=keys(words[-1:]) == ("?",)))[0]
    starts = keys(asking)[:1] in {(start,) for start in lexicon().question_starts}
    several = {".", "!", ";", "?", "\n"} & set(keys(words[:-1]))
    if several or not starts:
        return None
    left = keys(asking) == ("what", "is", "left")
    found = Answer(ABOUT_ITSELF["left"](scene, ())) if left else asked(asking, keys(asking), scene)
    return None if found is not None and found.look else found
