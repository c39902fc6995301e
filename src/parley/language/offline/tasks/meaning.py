"""Which order a clause means: by its verb, by what was said before, by what somebody needs."""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.offline.dialogue.answering import Answering
from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.sentences.clauses import Clause, opens_command
from parley.language.offline.sentences.wishes import need, wish
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.parts import map_spans
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.quantities import quantities
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, tokens

__all__ = ["Meaning"]

_FOLLOW_ON = (
    *(
        (*verb, *same, end)
        for verb in ((), ("do",), ("and", "do"))
        for same in (
            ("the", "same"),
            ("same", "thing"),
            ("the", "same", "thing"),
            ("likewise",),
            ("that", "too"),
            ("it", "too"),
        )
        for end in ("for", "with", "at", "in", "to")
    ),
    *(
        (verb, it, end)
        for verb in ("repeat", "do")
        for it in ("that", "it", "this")
        for end in ("for", "with", "at", "in")
    ),
    ("ditto", "for"),
    ("likewise", "for"),
    ("what", "about"),
    ("how", "about"),
    ("the", "same", "for"),
    ("same", "for"),
    ("same", "with"),
)


_AFTER_IT = frozenset({"too", "also", "next", "then", "now", "please", "afterwards", "after", "later"})
"""Behind a thing that is done next."""
_ONCE_MORE = frozenset({"motion", "look", "search", "transfer", "whether"})


def _end_of(theme: Phrase, words: Phrase) -> int:
    """Where what is looked at ends in "the door is open"."""
    wanted = keys(theme)
    ends = (
        i + len(wanted) for i in range(len(words)) if wanted and keys(words[i : i + len(wanted)]) == wanted
    )
    return next(ends, 0)


_NO_NAMES = frozenset({
    "never", "whatever", "anyway", "because", "although", "while", "somebody", "someone", "nobody",
    "everybody", "we", "they", "i", "he", "she", "you", "there",
})  # fmt: skip
"""With these no name of a thing begins."""


_WANTING = tuple(
    tuple(text.split())
    for text in (
        "wants to",
        "want to",
        "would like to",
        "needs to",
        "need to",
        "wishes to",
        "is ready to",
        "are ready to",
        "is waiting to",
        "are waiting to",
    )
)


_OUR_WISHES = frozenset((who, verb) for who in ("i", "we") for verb in ("need", "want", "require"))


def _what_others_want(words: Phrase) -> Phrase:
    """For "table 3 wants to order": to order, for table 3; "the row needs 3 litres": to give it that."""
    flat = keys(words)
    if flat[:2] in _OUR_WISHES and len(flat) > 2 and flat[2] not in {"to", "you"}:
        return (Word("get", "get"), *words[2:])
    if flat[:1] in {("i",), ("we",), ("you",)}:
        return words
    for index in range(1, len(flat) - 1):
        size = next((len(want) for want in _WANTING if flat[index : index + len(want)] == want), 0)
        if size and index + size < len(flat):
            return (*words[index + size :], Word("for", "for"), *words[:index])
        if flat[index : index + 3] in {("needs", "to", "be"), ("wants", "to", "be"), ("has", "to", "be")}:
            verb = lemma(flat[index + 3]) if index + 3 < len(flat) else ""
            return (Word(verb, verb), *words[:index], *words[index + 4 :]) if verb else words
        if flat[index] not in {"needs", "need", "wants", "gets", "could"}:
            continue
        doing = flat[index + 1]
        if doing.endswith("ing") and lemma(doing) != doing:
            return (Word(lemma(doing), lemma(doing)), *words[:index], *words[index + 2 :])
        if any(quantity.units for quantity in quantities(words[index + 1 :])):
            return (Word("give", "give"), *words[:index], *words[index + 1 :])
    return words


def _is_so_already(flat: tuple[str, ...]) -> bool:
    """For "the gate is open": that is told, and nobody is to open it; "is to be opened" asks for it."""
    link = next((i for i, word in enumerate(flat) if word in lexicon().be and i), 0)
    return bool(link) and flat[link + 1 : link + 2] not in _DUE and "please" not in flat


_DUE = frozenset({("to",), ("due",), ("supposed",), ("meant",), ("wanted",), ("needed",)})


_STAYING = frozenset({"stays", "stay", "remains", "remain", "keeps"})


@dataclass
class Meaning(Answering):
    """How a clause becomes a command."""

    def _command(self, clause: Clause) -> Command | None:
        command = read_command(clause.words, self.scene.is_person, self.scene.catalogue.verbs)
        words = strip_openers(clause.words)
        exact = None if command is not None and command.negated else self.tasks.own_match(words)
        begun = strip_openers(words, requests=True)[:1] != words[:1]
        named = exact is not None and (exact.verb == 1.0 or (begun and exact.verb_first))
        if exact is not None and named and exact.complete and not opens_command(words[1:]):
            return Command("catalogue", words[0].key, theme=bare(words[1:]), words=words[1:], clause=words)
        told = lexicon().reporting.match(keys(words))
        if (
            told is not None
            and told[0] > 1
            and words[0].key in {"take", "make", "put", "jot"}
            and read_statement(words)
        ):
            return None
        if (
            keys(words)[:1] == ("you",)
            and keys(words)[2:3] == ("find",)
            and read_statement(words) is not None
        ):
            return None
        plain_words = strip_openers(words, requests=True)
        if len(self._follow_on(plain_words)) < len(plain_words):
            command = self._elliptical(plain_words) or command
        if command is None:
            command = (
                self._own_deed(words)
                or wish(words, self.scene)
                or need(words, self.scene)
                or self._going(words)
                or self._described(words)
                or self._elliptical(words)
            )
        if (
            command is not None
            and command.kind == "other"
            and read_statement(clause.words) is not None
            and not opens_command(clause.words)
        ):
            return None
        return command

    def _own_deed(self, words: Phrase) -> Command | None:
        """For an order that only an action of its own kind understands ("warm the block to 40 degrees")."""
        said = strip_openers(words, requests=True)
        words = _what_others_want(said)
        match = self.tasks.own_match(words, weak=words != said)
        told = words == said and read_statement(words) is not None
        if match is None or (told and not (match.complete and not match.filled.left)):
            return None
        if told and _is_so_already(keys(words)):
            return None
        if not match.verb_first and {"not", "until"} & set(keys(words)):
            return None
        # "Both rows need water".
        rest = words if marks_of(words[0]) else words[1:]
        return Command("catalogue", words[0].key, theme=bare(rest), words=rest, clause=words)

    def _described(self, words: Phrase) -> Command | None:
        """For a verb that only a phrase, an example or a description of the catalogue knows."""
        flat = keys(strip_openers(words, requests=True))
        small = lexicon().determiners | lexicon().question_starts | lexicon().be
        if not flat or flat[0] in small | {"it", "he", "she", "they", "we", "i"}:
            return None
        catalogue = self.scene.catalogue
        known = catalogue.by_phrase(flat)
        if known is None and self.tasks.own_match(words, weak=True) is None:
            return None
        words = strip_openers(words, requests=True)
        return Command("other", words[0].key, theme=bare(words[1:]), words=words[1:], clause=words)

    def _going(self, words: Phrase) -> Command | None:
        """For "to the desk": going needs no verb."""
        if keys(words)[:1] not in {("to",), ("over",), ("towards",), ("back",)} or len(words) < 2:
            return None
        return read_command((Word("go", "go"), *words), self.scene.is_person)

    def _elliptical(self, words: Phrase) -> Command | None:
        """For "Go to A, then B": a bare noun phrase does again what the clause before did."""
        given, words = words, self._follow_on(words)
        while len(words) > 1 and words[-1].key in _AFTER_IT:
            words = words[:-1]
        if self.last is not None and self.last.kind == "catalogue" and not self.last.negated:
            return self._own_once_more(self.last, words, asked=len(words) < len(given))
        if self.last is None or self.last.kind not in _ONCE_MORE or not words or len(words) > 9:
            return None
        negated = words[0].key == "not" and len(words) > 1
        words = words[1:] if negated else words
        found = lexicon().goals.match(keys(words))
        words = bare(words[found[0] :] if found and found[0] < len(words) else words)
        if not words or any(w.key in lexicon().be | _STAYING for w in words) or self._happens(words):
            return None
        words = self._labelled(words)
        if self.last.kind == "whether":
            rest = self.last.words[_end_of(self.last.theme, self.last.words) :]
            named = tokens(the(plain(words)))
            return replace(self.last, theme=words, place=(), words=(*named, *rest), clause=words)
        if self.last.kind == "motion":
            return replace(
                self.last, place=words, clause=(Word("go", "go"), Word("to", "to"), *words), negated=negated
            )
        there = self.last.place and self.last.kind in {"look", "search", "count"}
        sought = keys(words).index("for") if there and "for" in keys(words[:-1]) else 0
        if sought and self.scene.ground(words[:sought]).outcome == "match":
            # "Check A for cracks, then B for rust".
            named, thing = words[:sought], bare(words[sought + 1 :])
            return replace(self.last, place=named, theme=thing, clause=words, negated=negated)
        if (
            there
            and self.scene.ground(words).outcome == "match"
            and self.scene.ground(self.last.theme).outcome == "none"
        ):
            # "Check A for cracks, and B".
            return replace(self.last, place=words, clause=words, negated=negated)
        place = self.last.place if self.last.kind == "transfer" else ()
        return replace(self.last, theme=words, place=place, source=(), clause=words, negated=negated)

    def _own_once_more(self, last: Command, words: Phrase, *, asked: bool) -> Command | None:
        """The deed before for another thing ("empty A, next B"), one of the same kind unless `asked` for."""
        spans = [span for span in map_spans(last.clause, self.scene) if span[2] is not None]
        found = lexicon().goals.match(keys(words)) or lexicon().places.match(keys(words))
        words = bare(words[found[0] :] if found and found[0] < len(words) else words)
        meant = self.scene.ground(words) if words and spans else None
        if meant is None or meant.outcome != "match":
            return None
        start, end, before = spans[-1]
        if not asked and before is not None and before.class_name != meant.candidates[0].class_name:
            return None
        said = (*last.clause[:start], *words, *last.clause[end:])
        if self.tasks.own_match(said, weak=True) is None:
            return None
        return Command("catalogue", last.verb, theme=bare(said[1:]), words=said[1:], clause=said)

    def _happens(self, words: Phrase) -> bool:
        """Whether somebody did something ("the cook made soup"), as against a name with such a word in it."""
        first = words[0].key
        if first in _NO_NAMES or {"will", "would", "might", "must"} & set(keys(words[1:])):
            return True
        told = any(lemma(word.key) != word.key and not word.key.endswith(("s", "ing")) for word in words[1:])
        return told and len(words) > 2 and self.scene.ground(words).outcome == "none"

    def _labelled(self, words: Phrase) -> Phrase:
        """For "Go to room 1, then 2": a bare number or letter names another of the same kind."""
        named = bare(self.last.place or self.last.theme) if self.last is not None else ()
        label = len(words) == 1 and (words[0].key.isdigit() or len(words[0].key) == 1)
        if not label or len(named) < 2 or not (named[-1].key.isdigit() or len(named[-1].key) == 1):
            return words
        return (*named[:-1], *words)

    def _follow_on(self, words: Phrase) -> Phrase:
        """Also for "what about the desk?" and "and now the desk": as in the message before."""
        flat = keys(words)
        lead = next((lead for lead in _FOLLOW_ON if flat[: len(lead)] == lead), ())
        leads_on = self._leads_on or flat[-1:] in {("too",), ("also",)} or flat[-2:] == ("as", "well")
        if self.last is None and (lead or leads_on):
            self.last = self._previous
        return words[len(lead) :]
