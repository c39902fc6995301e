"""What a message tells: facts that are to be remembered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from parley.language.offline.facts.declared import read_declared
from parley.language.offline.facts.facts import Fact, read_statement, strip_openers
from parley.language.offline.facts.remembering import memory_name
from parley.language.offline.facts.worth import is_idle, worth_keeping
from parley.language.offline.scene.known import ONLY_NOW
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.sentences.telling import telling
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.saying import the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.messages.chat import SystemCommand

__all__ = ["Noting", "mention_listed"]


_ANNOUNCED = frozenset(
    {"thing", "fact", "point", "the", "following", "these", "this", "a", "few", "couple", "of"}
)


def mention_listed(told: Sequence[Fact], scene: Scene) -> None:
    """What a message lists may be meant by "each of them"."""
    for fact in told:
        for part in coordinated(fact.state) if fact.relation == "are" else ():
            if scene.ground(part).outcome == "match":
                scene.mention(part)
                scene.places.append(part)


@dataclass
class Noting:
    """Collects commands and replies of one message; here those that keep facts."""

    scene: Scene
    commands: list[SystemCommand] = field(default_factory=list)
    replies: list[str] = field(default_factory=list)
    told: tuple[Fact, ...] = ()
    """What whole sentences, taken out of the message before, list or lay down for later."""
    told_only: bool = False
    """Whether something was told that is not worth keeping."""

    def state(self, clause: Clause) -> bool:
        """Keep what a clause states; False if it states nothing."""
        fact = None if clause.is_question else read_statement(clause.words)
        if fact is None:
            return self._note(clause) or self._declared(clause)
        if not self._asked_to_keep(clause.words) and not worth_keeping(fact, clause.words):
            self.scene.trace.note("memory", f"not kept: {fact.sentence}")
            self.scene.mention(fact.subject)
            if self.scene.ground(fact.subject).outcome == "match":
                self.scene.places.append(fact.subject)
            self.told_only = True
            return True
        told = telling(clause.words, Deeds.of(self.scene))
        if told is not None and told.kind == "undone" and not self._asked_to_keep(clause.words):
            # It is done, or only explains what is.
            self.scene.mention(fact.subject)
            self.scene.places.extend((fact.place,) if fact.place else ())
            self.told_only = True
            return True
        if clause.passing and not self._asked_to_keep(clause.words):
            self._use_once(fact)
            return True
        self.remember(self._about(fact))
        return True

    def _use_once(self, fact: Fact) -> None:
        """Use where somebody is said to be for the order that it explains."""
        self.scene.trace.note("memory", f"only for this order: {fact.sentence}")
        self.scene.add_fact(fact, ONLY_NOW)
        self.scene.mention(fact.subject)
        self.scene.places.append(fact.place)

    def _declared(self, clause: Clause) -> bool:
        """Keep what is said of things that are known; pass over what is said of the time of day."""
        fact = None if clause.is_question else read_declared(clause.words, self.scene)
        if fact is not None and worth_keeping(fact, clause.words):
            self.remember(fact)
            return True
        if fact is not None or (not clause.is_question and is_idle(clause.words)):
            self.told_only = True
            return True
        return False

    def keep_lists(self) -> None:
        """Keep what sentences of the message listed or laid down."""
        spoken_of = (self.scene.things, self.scene.places, self.scene.persons)
        before = [len(found) for found in spoken_of]
        for fact in self.told:
            self.remember(fact)
        for found, size in zip(spoken_of, before, strict=True):
            # "There" is what orders name, before what is only to be remembered beside them.
            found[:] = [*found[size:], *found[:size]]
        mention_listed(self.told, self.scene)

    def _asked_to_keep(self, words: Phrase) -> bool:
        """Whether it is to be remembered whatever it is."""
        found = lexicon().reporting.match(keys(strip_openers(words)))
        return found is not None and bool(
            {"remember", "note", "keep", "memorize", "memorise"} & set(found[1].split())
        )

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
        if {singular(word) for word in keys(rest)} <= _ANNOUNCED | set(lexicon().numbers):
            # "Remember two things." What they are follows.
            return True
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
        name = self._own_name(fact, memory_name(fact, self.scene.facts))
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
        elif self.scene.ground(fact.subject).outcome == "match":
            self.scene.places.append(fact.subject)
        said = fact.sentence
        first = said.split()[0] if said else ""
        known = bool(said) and singular(first.lower()) in lexicon().vocabulary
        keep = not known and (
            self.scene.is_person(tokens(first))
            or first.isupper()
            or (fact.subject and plain(fact.subject).startswith(first) and fact.subject[0].is_capital)
        )
        said = said.replace(" their ", " your ", 1) if said.startswith("The operator ") else said
        said = f"you {said[2:]}" if first == "I" else said if keep else said[:1].lower() + said[1:]
        said = (
            said.replace("the operator's", "your", 1)
            .replace("the operator", "you", 1)
            .replace("you is", "you are", 1)
        )
        orders = fact.relation == "rule" and keys(fact.state) == keys(tokens(fact.sentence))
        self.replies.append(
            f"I will remember that: {fact.sentence}." if orders else f"I will remember that {said}."
        )

    def _own_name(self, fact: Fact, name: str) -> str:
        """Two things said of one in the same message ("A is called B and is allergic to C") are kept both."""
        given = {c.arguments.get("name"): str(c.arguments.get("data")) for c in self.commands}
        before = given.get(name, "")
        words = [word.key for word in fact.state if word.is_word and word.key not in lexicon().vocabulary]
        if fact.is_location or not before or " not " in f" {before} " or not words:
            return name
        return f"{name}_{words[-1]}"

    def learn(self) -> None:
        """Keep what answers to earlier questions stated."""
        for fact in self.scene.learned:
            self.remember(fact)
        self.scene.learned.clear()


def _is_plural(sentence: str) -> bool:
    words = sentence.lower().split()
    return "are" in words[:6] or "were" in words[:6]
