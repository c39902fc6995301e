"""Corrections, refusals and changes of the plan in one message."""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.control import control_of
from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.plan_changes import edits
from parley.language.offline.plan_changes.replanning import visit_of, without
from parley.language.offline.reading import Reading
from parley.language.offline.sentences.clauses import Clause, opens_command
from parley.language.offline.tasks.commands import Command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import whole_sentence
from parley.language.offline.words.text import keys, lemma, plain
from parley.messages.chat import CommandName, SystemCommand

__all__ = ["CONTROL_REPLIES", "Changing"]

CONTROL_REPLIES: dict[str, tuple[CommandName, str]] = {
    "stop": ("stop", "I stop here and wait. Say “carry on” when I may go on."),
    "emergency_stop": ("stop", "I stop at once."),
    "start": ("start", "I carry on."),
    "skip": ("skip", "I leave this step out."),
    "clear": ("clear", "I cancel everything that was planned."),
}


_NOTHING_ELSE = frozenset(
    {("the", "rest"), ("the", "others"), ("everything", "else"), ("all", "others"), ("all", "the", "others")}
)


@dataclass
class Changing(Reading):
    """How a message takes back or changes what was asked for."""

    def _corrected(self, clause: Clause) -> Clause:
        """For "... I mean the desk": what the clause before it asked for is taken back."""
        found = lexicon().corrections.match(keys(clause.words))
        further = lexicon().corrections.match(keys(clause.words), found[0]) if found is not None else None
        if found is not None and further is not None:
            # "Actually, make it the box".
            found = found[0] + further[0], further[1]
        if found is not None and self.last is None and self._previous is not None:
            return self._corrected_before(clause, found[0])
        if (
            found is None
            or self.last is None
            or found[0] >= len(clause.words)
            or found[1] in {"no longer", "not any more"}
        ):
            return clause
        if read_statement(clause.words[found[0] :]) is not None:
            return clause
        steps, will = self._before_last
        del self.tasks.steps[steps:]
        del self.tasks.will[will:]
        self.tasks.here = ""
        return replace(clause, words=clause.words[found[0] :])

    def _corrected_before(self, clause: Clause, size: int) -> Clause:
        """For "I meant the desk", said of the message before: what is still pending of it is taken back."""
        if clause.words[0].key == "wrong" and self._at < len(self._parts) - 1:
            # "Wrong box, I meant ...": what is right follows.
            return replace(clause, words=())
        rest = clause.words[size:]
        previous = self._previous
        if previous is None or not rest or read_statement(rest) is not None or opens_command(rest):
            return clause
        if self.scene.ground(rest).outcome == "none":
            return clause
        self.last = previous
        at = visit_of(previous.place or previous.theme, self.scene)
        if at is not None:
            self.commands.extend(without(at, self.scene).commands)
        return replace(clause, words=rest)

    def _order(self, clause: Clause, alone: bool, index: int) -> bool:
        """Stop words among other clauses, and changes of the plan."""
        words = strip_openers(clause.words)
        control = None if clause.is_question else control_of(plain(words))
        if control is not None and self.tasks.ends_own(words):
            return False
        if control == "stop" and not alone and {"until", "till"} & set(keys(words)):
            # "Wait until I call you, then go to the desk": a step that waits.
            control = None
        if control is not None:
            if control == "start" and not alone:
                return True
            if control == "stop" and not alone:
                # "Stop and go to the desk": the new order takes the place of the old ones. Elsewhere ("go to
                # the desk and wait there") standing still is what the robot does anyway.
                if index or keys(words)[0] not in {"stop", "halt"}:
                    return True
                ordered = any(opens_command(part.words) for part in self._parts[1:])
                control = "clear" if ordered else "stop"
            command, reply = CONTROL_REPLIES[control]
            self._command_once(SystemCommand(command=command), reply)
            return True
        verb = edits.drop_verb(words)
        if verb and self.tasks.steps and keys(words[verb:]) in _NOTHING_ELSE:
            self.replies.append("I leave out the rest.")
            return True
        edit = edits.read_edit(words, self.scene)
        if edit is not None:
            self.scene.trace.note("edit", edit.reply)
            self.commands.extend(edit.commands)
            self.replies.append(edit.reply)
            return True
        return False

    def _do_not(self, command: Command) -> None:
        to = max((i + 1 for i, word in enumerate(command.theme[:-1]) if word.key == "to"), default=0)
        self.scene.mention(bare(command.recipient or command.theme[to or len(command.theme) :]))
        for phrase in (command.place, command.theme):
            # What is refused may be spoken of later, but what was wanted comes to mind first.
            wanted = list(self.scene.things) if self.tasks.steps else []
            self.scene.mention(bare(phrase))
            self.scene.things += wanted[-1:]
            if phrase:
                self.scene.places.insert(max(len(self.scene.places) - 1, 0), bare(phrase))
        words = " ".join([lemma(command.clause[0].key), plain(command.clause[1:])]).strip()
        dropped = edits.steps_of(command, self.scene)
        self.commands.extend(
            SystemCommand(command="pop", arguments={"parameters": i}) for i in reversed(dropped)
        )
        self.replies.append(whole_sentence(f"All right, I will not {words}"))

    def _command_once(self, command: SystemCommand, reply: str) -> None:
        if command not in self.commands:
            self.commands.append(command)
            self.replies.append(reply)
