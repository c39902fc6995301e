"""Carrying out commands of a message one by one: refused, repeated, on conditions."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import Fact
from parley.language.offline.scene.scene import UnclearError
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.sentences.conditions import is_rule
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.meaning import Meaning
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, plain, tokens
from parley.messages.chat import Flow, FlowIf

__all__ = ["Doing"]


@dataclass
class Doing(Meaning):
    """How commands become steps, and on what they depend."""

    def _do(self, command: Command) -> None:
        self.scene.trace.note("frame", command.said())
        if command.negated:
            self._do_not(command)
            self.last = self.last or replace(command, negated=False)
            return
        if command.kind == "transfer" and command.verb in {"take"} and "instead" in keys(command.clause):
            command = replace(command, kind="motion", verb="go", place=command.theme, theme=())
        if command.kind == "need":
            # Said before what is wanted ("X is cold, get him Z"), the need only explains; alone it asks.
            self.last = command
            return
        self.last = command
        self._before_last = len(self.tasks.steps), len(self.tasks.will)
        if (
            command.kind == "transfer"
            and not command.recipient
            and not command.place
            and self._carried_on(command)
        ):
            self.tasks.collect(command)
            return
        own = self.scene.catalogue.for_verb(command.verb)
        if own is not None and any(kind == "number" for kind in own.inputs.values()) and not own.outputs:
            self.tasks.do(command)
            return
        for _ in range(self._times(command)):
            self.tasks.do(_without_times(command))
            if self._times(command) > 1:
                self.tasks.here = ""

    def _carried_on(self, command: Command) -> bool:
        """Whether a later clause says where what is fetched goes ("get the box and bring it to A")."""
        later = (read_command(c.words, self.scene.is_person) for c in self._parts[self._at + 1 :])
        return any(c is not None and c.kind in {"transfer", "place", "guide"} for c in later)

    def _times(self, command: Command) -> int:
        flat = keys(command.clause)
        if flat[-1:] == ("twice",):
            return 2
        if flat[-1:] == ("times",) and len(flat) > 1:
            word = flat[-2]
            return min(lexicon().numbers.get(word, int(word) if word.isdigit() else 1), 10)
        return 1

    def _condition(self, clause: Clause) -> None:
        """Look first, then act or not."""
        if not clause.condition:
            self._checked = ((), self._last_look())
        elif not self._same_condition(clause):
            if is_rule(clause.condition):
                said = f"If {plain(clause.condition)}, {plain(clause.words)}"
                self.remember(
                    Fact(bare(clause.condition[-2:]), relation="protocol", state=clause.words, sentence=said)
                )
                return
            look = read_command(
                (Word("check", "check"), Word("whether", "whether"), *self._named_later(clause)),
                self.scene.is_person,
            )
            if look is None:
                raise UnclearError(f"How can I tell whether {plain(clause.condition)}?")
            before = len(self.tasks.steps)
            self.tasks.do(look)
            self._one_look(before)
            self._checked = (clause.condition, len(self.tasks.steps) - 1)
        start, told = len(self.tasks.steps), len(self.tasks.will)
        self._clause(replace(clause, condition=(), conditional=False), alone=False, index=1)
        flow = Flow(if_=FlowIf(step=self._checked[1], result=not clause.otherwise))
        self.tasks.steps[start:] = [
            step.model_copy(update={"flow": flow}) for step in self.tasks.steps[start:]
        ]
        word = "if not" if clause.otherwise else "if so"
        if len(self.tasks.will) > told:
            self.tasks.will[told] = f"{word}, {self.tasks.will[told]}"

    def _named_later(self, clause: Clause) -> Phrase:
        """For "Go to the desk only if it is free": the condition with what the order names."""
        condition = clause.condition
        mentioned = bool(self.scene.things or self.scene.persons) and not clause.late
        if keys(condition)[0] not in {"it", "they", "he", "she"} or mentioned:
            return condition
        command = read_command(clause.words, self.scene.is_person, self.scene.catalogue.verbs)
        named = tokens(the(plain(bare(command.place or command.theme)))) if command is not None else ()
        return (*named, *condition[1:]) if named else condition

    def _one_look(self, before: int) -> None:
        """Looking whether something is so takes the place of a look at the same thing just before."""
        steps = self.tasks.steps
        if before < 1 or len(steps) != before + 1 or steps[before].name != steps[before - 1].name:
            return
        if steps[before - 1].flow is not None:
            return
        general, special = (
            [str(p.value).lower() for p in step.input_parameters.values() if isinstance(p.value, str)]
            for step in steps[before - 1 :]
        )
        if len(general) == len(special) == 1 and general[0] in special[0]:
            del steps[before - 1]
            del self.tasks.will[-2:-1]

    def _last_look(self) -> int:
        """The step that looked last, for "if not, ...".

        Raises:
            UnclearError: Nothing was looked at.
        """
        looks = {
            info.name
            for info in self.scene.catalogue.infos
            if self.scene.catalogue.roles(info) & {"look", "search"}
        }
        for index in range(len(self.tasks.steps) - 1, -1, -1):
            if self.tasks.steps[index].name in looks:
                return index
        raise UnclearError("What does that depend on? Please tell me what I should look at first.")

    def _same_condition(self, clause: Clause) -> bool:
        return bool(self._checked[0]) and keys(self._checked[0]) == keys(clause.condition)

    def _side_by_side(self, start: int) -> None:
        """The steps from `start` on are done at the same time as the one before them, if that was asked."""
        steps, beside = self.tasks.steps, self.tasks.beside
        self.tasks.beside = False
        if beside and start < len(steps) and steps[start].flow is None and steps[start - 1].flow is None:
            steps[start] = steps[start].model_copy(update={"flow": Flow(together_with=start - 1)})
            self.tasks.will[-1] = f"{self.tasks.will[-1]} at the same time"

    @abstractmethod
    def _clause(self, clause: Clause, *, alone: bool, index: int) -> None:
        """Read one clause; what reads whole messages says how."""


def _without_times(command: Command) -> Command:
    """Without "twice" and "three times" at the end of its parts."""

    def cut(phrase: Phrase) -> Phrase:
        flat = keys(phrase)
        if flat[-1:] == ("twice",):
            return phrase[:-1]
        return phrase[:-2] if flat[-1:] == ("times",) and len(flat) > 2 else phrase

    return replace(command, place=cut(command.place), theme=cut(command.theme))
