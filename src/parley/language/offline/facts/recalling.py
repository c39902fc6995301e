"""What a message and those before it were about, for pronouns and follow-ups."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.sentences.clauses import Clause, clauses, opens_command
from parley.language.offline.tasks.commands import read_command
from parley.language.offline.tasks.doing import Doing
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, plain, tokens

__all__ = ["Recalling"]


@dataclass
class Recalling(Doing):
    """How things are kept in mind."""

    def _named(self, clause: Clause) -> bool:
        """For "the chair A is on, go there": named by what is remembered, asked for by the next clause."""
        words = strip_openers(clause.words)
        if self._at == len(self._parts) - 1 or opens_command(words):
            return False
        item = self.scene.told_apart(words)
        if (
            item is None
            or not noun_phrase(words).core
            or read_command(words, self.scene.is_person) is not None
        ):
            return False
        self.scene.mention(tokens(item.description))
        self.scene.places.append(tokens(item.description))
        return True

    def _grounded(self, phrase: Phrase) -> str:
        from parley.language.offline.scene.grounding import ground_phrase

        found = ground_phrase(phrase, self.scene.objects)
        return plain(phrase) if found.outcome != "none" else ""

    def _mention_history(self) -> None:
        """What was spoken of before, for pronouns."""
        for turn in self.scene.situation.history[-6:]:
            if turn.role != "operator":
                continue
            for part in clauses(tokens(turn.content), opens_command):
                fact = read_statement(part.words)
                command = read_command(part.words, self.scene.is_person)
                if command is not None:
                    self._previous = None if command.negated else command
                    for phrase in (command.source, command.place, command.theme, command.recipient):
                        self.scene.mention(bare(phrase))
                    if command.place:
                        self.scene.places.append(command.place)
                elif fact is not None:
                    self.scene.mention(fact.subject)
                    if fact.place:
                        self.scene.places.append(fact.place)
                else:
                    self._mention_names(part.words)

    def _mention_names(self, words: Phrase) -> None:
        """What a question or a fragment was about."""
        about = words
        while len(about) > 1 and about[0].key in lexicon().question_starts | lexicon().be | {
            "about",
            "do",
            "you",
            "know",
        }:
            about = about[1:]
        known = find_fact(bare(about), self.scene.facts, locations=False)[0]
        if known is not None:
            self.scene.mention(bare(about))
            return
        for phrase in mentioned(words, self.scene):
            self.scene.mention(phrase)
            self.scene.places.append(phrase)
