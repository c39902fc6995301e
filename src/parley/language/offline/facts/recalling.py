"""What a message and those before it were about, for pronouns and follow-ups."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.facts.owning import with_owners_named
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.facts.stated_first import stated_first
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.sentences.clauses import Clause, clauses, opens_command
from parley.language.offline.sentences.look_only import as_look, confirming, looking_in
from parley.language.offline.sentences.rounds import watched_for
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.doing import Doing
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, keys, plain, tokens

__all__ = ["Recalling"]


_FAILED = frozenset({"cannot", "not", "unable", "failed", "?", "which", "where"})


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
                self._mention_seen(tokens(turn.content))
                if _FAILED & set(keys(tokens(turn.content.lower()))):
                    self.tasks.carried = ()
                continue
            for part in clauses(tokens(turn.content), opens_command):
                fact = read_statement(part.words)
                own = read_command(part.words, self.scene.is_person, self.scene.catalogue.verbs)
                special = own is not None and self._is_own(own)
                command = read_command(part.words, self.scene.is_person) or (own if special else None)
                if command is not None:
                    self._previous = None if command.negated else own if special else command
                    self._hold(command)
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

    def _is_own(self, command: Command) -> bool:
        """Whether an order is for an action of a kind of its own."""
        catalogue = self.scene.catalogue
        return command.kind == "catalogue" and catalogue.for_verb(command.verb) in catalogue.of_own_kind

    def _hold(self, command: Command) -> None:
        """What the robot still has after an earlier order: what it fetched and gave to nobody."""
        if command.negated or command.kind not in {"grasp", "transfer", "place"}:
            return
        kept = command.kind != "place" and not command.recipient and not command.place
        self.tasks.carried = bare(command.theme) if kept and not self.scene.situation.queue else ()

    def _mention_seen(self, words: Phrase) -> None:
        """What the robot reported that it saw: things on the map, before the place where they are."""
        flat = keys(words)
        at = next((i for i in range(len(flat)) if _reports(flat, i)), -1)
        if at < 0 or "?" in flat:
            return
        end = next((i for i in range(at, len(flat)) if flat[i] in {".", "!"}), len(flat))
        named = mentioned(words[at:end], self.scene)
        seen = [phrase for phrase in named if lexicon().places.match(keys(phrase)) is None]
        for phrase in [*seen[1:], *seen[:1]]:
            self.scene.mention(phrase)

    def with_owners(self, words: Phrase) -> Phrase:
        """Owners of things by their names, as far as it is known whose the things are."""
        named, used = with_owners_named(words, self.scene.facts)
        for item in used:
            self.scene.use(item)
        return named

    def arranged(self, parts: Sequence[Clause]) -> list[Clause]:
        """Clauses put so that what is needed is known first, and that say plainly what is to be looked at."""
        parts = [replace(part, words=as_look(part.words)) for part in parts]
        parts = looking_in(stated_first(parts, self.scene.is_person), self.scene.is_person)
        return watched_for(
            confirming(parts),
            lambda words: len(self.scene.several(words)) > 1,
            lambda words: words[-1].is_capital or self.scene.ground(words).outcome != "none",
        )

    def _mention_answer(self) -> None:
        """Where something is that was asked for just now: "there" in what follows."""
        turns = self.scene.situation.history[-2:]
        if len(turns) < 2 or turns[1].role == "operator" or "?" in turns[1].content:
            return
        first = strip_openers(tokens(turns[0].content))[:1]
        if turns[0].role == "operator" and first and first[0].key in lexicon().question_starts:
            self.scene.places.extend(mentioned(tokens(turns[1].content), self.scene))

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


_SEEING = (
    ("there", "is"),
    ("there", "are"),
    ("i", "see"),
    ("i", "saw"),
    ("i", "found"),
    ("i", "can", "see"),
    ("i", "have", "found"),
    ("i", "noticed"),
    ("i", "spotted"),
)


def _reports(flat: tuple[str, ...], index: int) -> bool:
    """Whether the robot says there what it saw; "no" and "nothing" name nothing."""
    lead = next((lead for lead in _SEEING if flat[index : index + len(lead)] == lead), ())
    return bool(lead) and not {"no", "nothing", "not"} & set(flat[index : index + len(lead) + 2])
