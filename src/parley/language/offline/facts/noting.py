"""What a message tells: facts that are to be remembered."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from parley.language.offline.facts.facts import Fact, read_statement, strip_openers
from parley.language.offline.facts.remembering import memory_name
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the, whole_sentence
from parley.language.offline.words.text import keys, lemma, plain, singular, tokens
from parley.messages.chat import SystemCommand

__all__ = ["Noting"]


@dataclass
class Noting:
    """Collects commands and replies of one message; here those that keep facts."""

    scene: Scene
    commands: list[SystemCommand] = field(default_factory=list)
    replies: list[str] = field(default_factory=list)

    def state(self, clause: Clause) -> bool:
        """Keep what a clause states; False if it states nothing."""
        fact = None if clause.is_question else read_statement(clause.words)
        if fact is None:
            return self._note(clause)
        fact = self._about(fact)
        if fact.negated and fact.is_location:
            self.remember(replace(fact, sentence=fact.sentence))
        else:
            self.remember(fact)
        return True

    def _note(self, clause: Clause) -> bool:
        """For "Remember that <anything>": kept as it was said."""
        words = strip_openers(clause.words)
        found = lexicon().reporting.match(keys(words))
        if (
            found is None
            or found[0] >= len(words) - 1
            or lemma(words[0].key)
            not in lexicon().verb_classes["remember"] | {"keep", "do", "be", "bear", "know", "please"}
        ):
            return False
        rest = strip_openers(words[found[0] :])
        sentence = plain(rest)
        self.remember(
            Fact(rest[:4], relation="note", state=rest, sentence=sentence[:1].upper() + sentence[1:])
        )
        return True

    def _about(self, fact: Fact) -> Fact:
        """Pronouns of a statement replaced by what they stand for."""
        flat = keys(fact.subject)
        if len(flat) == 1 and flat[0] in lexicon().person_pronouns | lexicon().thing_pronouns:
            subject = bare(self.scene.referent(fact.subject))
            old = plain(fact.subject)
            rest = (
                fact.sentence[len(old) :]
                if fact.sentence.lower().startswith(old.lower())
                else f" is {fact.relation} {plain(fact.place)}"
            )
            return replace(fact, subject=subject, sentence=whole_sentence(the(plain(subject)) + rest)[:-1])
        return fact

    def remember(self, fact: Fact) -> None:
        """Keep a fact, use it at once, and say so."""
        name = memory_name(fact, self.scene.facts)
        self.scene.trace.note("memory", f"kept as {name}: {fact.sentence}")
        where = (
            f"where {the(plain(fact.subject))} {'are' if _is_plural(fact.sentence) else 'is'}"
            if fact.is_location
            else f"about {the(plain(fact.subject))}"
        )
        arguments = {"data": fact.sentence, "info": where[0].upper() + where[1:], "name": name}
        # Said twice in one message ("not on the desk, in the box"), the last word counts.
        self.commands = [c for c in self.commands if c.arguments.get("name") != name]
        self.commands.append(SystemCommand(command="add_memory", arguments=arguments))
        self.scene.add_fact(fact, name)
        self.scene.mention(fact.subject)
        if fact.place:
            self.scene.places.append(fact.place)
        said = fact.sentence
        first = said.split()[0] if said else ""
        known = bool(said) and singular(first.lower()) in lexicon().vocabulary
        keep = not known and (
            self.scene.is_person(tokens(first))
            or first.isupper()
            or (fact.subject and plain(fact.subject).startswith(first) and fact.subject[0].is_capital)
        )
        said = said.replace(" their ", " your ", 1) if said.startswith("The operator ") else said
        said = said if keep else said[:1].lower() + said[1:]
        said = (
            said.replace("the operator's", "your", 1)
            .replace("the operator", "you", 1)
            .replace("you is", "you are", 1)
        )
        self.replies.append(f"I will remember that {said}.")

    def learn(self) -> None:
        """Keep what answers to earlier questions stated."""
        for fact in self.scene.learned:
            self.remember(fact)
        self.scene.learned.clear()


def _is_plural(sentence: str) -> bool:
    words = sentence.lower().split()
    return "are" in words[:6] or "were" in words[:6]
