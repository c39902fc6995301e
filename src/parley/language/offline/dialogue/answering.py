"""What is answered at once, and what is said in the end."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.dialogue import questions
from parley.language.offline.dialogue.to_be_seen import sees, with_owner_named
from parley.language.offline.dialogue.turning import turned
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.stories import mentioned, told_around
from parley.language.offline.plan_changes.changing import Changing
from parley.language.offline.repair.replies import agrees
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import UnclearError
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.tasks.abilities import abilities, cannot
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.going import UnableError
from parley.language.offline.words import social
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import in_turn, whole_sentence
from parley.language.offline.words.text import Phrase, Word, keys, plain
from parley.messages.chat import ActionCall, ChatAction

__all__ = ["Answering"]

_POINTING = frozenset({"it", "that", "this", "them", "him", "her", "all", "both", "each"})
_IN_TURN = (
    ("one", "after", "the", "other"),
    ("one", "after", "another"),
    ("one", "by", "one"),
    ("in", "turn"),
)


def _at_once(words: Phrase) -> Phrase:
    """Without "one after the other" behind."""
    flat = keys(words)
    size = next((len(tail) for tail in _IN_TURN if flat[len(flat) - len(tail) :] == tail), 0)
    return words[: len(words) - size]


@dataclass
class Answering(Changing):
    """How a message is answered."""

    def _spoken(self, clause: Clause) -> bool:
        """Questions, and what is only social."""
        clause = replace(clause, words=with_owner_named(clause.words, self.scene))
        if clause.is_question and self._goes_to_look():
            asked = turned(strip_openers(clause.words), self.scene)
            if asked:
                self._look_now(questions.Answer("", asked))
                self._parts = self._parts[: self._at + 1]
                return True
        answer = questions.answer(clause, self.scene)
        if answer is not None:
            self._mention_asked(clause.words)
            self.scene.trace.note("answer", f"a question: {answer.text}")
            if answer.look:
                self._look_for_answer(answer)
            else:
                self.replies.append(answer.text)
            return True
        small_talk = social.reply(clause.words, alone=False)
        if small_talk is not None:
            if not self.replies and small_talk:
                self.replies.append(small_talk)
            return True
        return False

    def _mention_asked(self, words: Phrase) -> None:
        """What a question names may be meant by what follows it."""
        for phrase in mentioned(words, self.scene):
            self.scene.mention(phrase)
            self.scene.places.append(phrase)

    @abstractmethod
    def _own_check(self, condition: Phrase) -> bool:
        """Tell whether something is so by an action of its own kind; what reads conditions says how."""

    def _look_for_answer(self, answer: questions.Answer) -> None:
        following = self._parts[self._at + 1 : self._at + 2]
        if following and following[0].conditional and not following[0].condition:
            # "Is it open? If so, ...": looking is what the rest depends on.
            self._look_now(answer)
            return
        if self._goes_to_look():
            self._look_now(answer)
            self._parts = self._parts[: self._at + 1]
            return
        if answer.look and self._own_check(answer.look):
            return
        if not sees(self.scene.catalogue):
            self.replies.append(
                "I do not know that, and I cannot look at it. Tell me, and I will remember it."
            )
            return
        if answer.now:
            self._look_now(answer)
            return
        if answer.counts and self.scene.catalogue.with_role("search") is not None:
            self._look_now(answer)
            return
        if self.scene.hints and agrees(self.scene.hints[0]) is True:
            self.scene.hints.pop(0)
            self._look_now(answer)
            return
        raise UnclearError(answer.text, ("yes", "no"))

    def _goes_to_look(self) -> bool:
        """Whether the next clause says to go and look, and nothing more: "Is it open? Please check."."""
        following = self._parts[self._at + 1 : self._at + 2]
        command = read_command(_at_once(following[0].words), self.scene.is_person) if following else None
        return (
            command is not None
            and command.kind in {"look", "whether", "count"}
            and not command.place
            and [word.raw.lower() for word in command.theme] in [[], *([word] for word in _POINTING)]
        )

    def _look_now(self, answer: questions.Answer) -> None:
        verb = (
            ("count",) if answer.counts else ("look",) if answer.look[0].key == "at" else ("check", "whether")
        )
        command = read_command((*(Word(v, v) for v in verb), *answer.look), self.scene.is_person)
        if command is not None:
            if answer.at and self._is_nowhere(command):
                command = replace(command, place=answer.at)
            self.tasks.do(command)

    def _is_nowhere(self, command: Command) -> bool:
        """Whether nothing that a look is about, or is said to be at, is on the map."""
        about = command.place or command.theme
        return ground_phrase(bare(about), self.scene.objects).outcome == "none"

    def _complain(self) -> None:
        """Ask about what was not understood, unless it was only told around something that was."""
        if not self.unread:
            return
        if not (self.tasks.steps or self.commands or self.replies):
            raise UnclearError(f"{social.not_understood(self.unread[0])} {abilities(self.scene)}", lost=True)
        for words in self.unread:
            if not told_around(words):
                self.replies.append(whole_sentence(f"I did not understand “{plain(words)[:80]}”"))

    def _reply(self) -> str:
        if self.last is not None and self.last.kind == "need" and not self.tasks.steps:
            self._serve_need(self.last)
            self.learn()
        parts = [*self.replies, *self.tasks.notes]
        known = [
            whole_sentence(f.fact.sentence)
            for f in self.scene.facts
            if f.entry.name in self.scene.sources and f.fact.sentence and f not in self._new()
        ]
        read = {f.entry.name for f in self.scene.facts}
        known += [
            whole_sentence(entry.data)
            for entry in self.scene.situation.memory
            if entry.name in self.scene.sources and entry.name not in read
        ]
        if self.tasks.steps and known:
            parts.append("I remember: " + " ".join(dict.fromkeys(known)))
        if self.tasks.will:
            parts.append(whole_sentence(f"I will {in_turn(self._will())}"))
        nothing = "I see. Tell me if there is something I can do." if self.told_only else "All right."
        return " ".join(part for part in parts if part) or nothing

    def _new(self) -> list[object]:
        names = {c.arguments.get("name") for c in self.commands if c.command == "add_memory"}
        return [f for f in self.scene.facts if f.entry.name in names and not f.entry.info]

    def _will(self) -> list[str]:
        said: list[str] = []
        for text in self.tasks.will:
            if not said or said[-1] != text:
                said.append(text)
        return said

    def _serve_need(self, need: Command) -> None:
        try:
            self.tasks.do(replace(need, kind="transfer", verb="bring"))
        except UnclearError as unclear:
            self.replies.append(unclear.question)
        except UnableError:
            self.replies.append(cannot("bring anything", self.scene))

    def _result(self, text: str, steps: Sequence[ActionCall], choices: Sequence[str] = ()) -> ChatAction:
        given = {c.arguments.get("name") for c in self.commands if c.command == "add_memory"}
        taken = {c.arguments.get("name") for c in self.commands if c.command == "remove_memory"} & given
        # Told and taken back in one message: nothing is to be kept of it.
        self.commands = [c for c in self.commands if c.arguments.get("name") not in taken or not taken]
        return ChatAction(
            message_response=_to_the_operator(text),
            queue=tuple(steps),
            system_cmd=tuple(self.commands),
            targets=self.targets or ((self.scene.situation.robot,) if self.scene.situation.robot else ()),
            choices=tuple(choices),
            sources=tuple(self.scene.sources),
        )


def _to_the_operator(text: str) -> str:
    """What is remembered of the operator, said to the operator."""
    for third, second in _SECOND_PERSON:
        text = text.replace(third, second)
    return text


_SECOND_PERSON = (
    ("The operator is ", "You are "), ("the operator is ", "you are "), ("The operator's ", "Your "),
    ("the operator's ", "your "),
)  # fmt: skip
