"""What belongs to whom, from facts in any of the ways in which people say so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.facts.naming_it import with_it_named
from parley.language.offline.facts.posts import by_their_roles, is_somebodys, without_called
from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.facts.told_here import told_here
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular, tokens

__all__ = ["Belonging", "belongings", "holder_of", "owner_of", "with_owners_named"]

_OWNING = frozenset({"owns", "own", "has", "have", "drives", "drive", "rents", "uses"})
_GETTING = frozenset({"gets", "receives", "wins", "won", "ordered", "orders", "got"})
"""What somebody does with what is remembered to be for them."""
_WITH = frozenset({"has", "have", "carries", "keeps", "holds", "wears", "owns"})
_GIVEN = frozenset(
    {"sold", "given", "lent", "assigned", "rented", "handed", "leased", "let", "transferred", "passed"}
)
_KEPT = frozenset({"reserved", "kept", "meant", "intended", "assigned", "booked"})
_HAVING = frozenset({"owned", "driven", "used", "rented"})
_LONGEST = 8


@dataclass(frozen=True, slots=True)
class Belonging:
    """That something is somebody's."""

    owner: Phrase
    thing: Phrase
    kind: str
    """What it is called as theirs ("car"); empty if only its own name is known."""
    source: Remembered


def belongings(facts: Sequence[Remembered]) -> list[Belonging]:
    """What belongs to whom, newest first; for each thing the last word counts."""
    result: list[Belonging] = []
    seen: set[tuple[str, ...]] = set()
    for item in facts:
        found = _belonging(item)
        if found is not None and (keys(found.thing) not in seen or found.kind):
            seen.add(keys(found.thing))
            result.append(found)
    return [*result, *_by_other_names(result, facts)]


def _by_other_names(known: Sequence[Belonging], facts: Sequence[Remembered]) -> list[Belonging]:
    """What belongs to A, for B too where A is remembered to be called B."""
    result: list[Belonging] = []
    for item in facts:
        fact = item.fact
        called = keys(fact.state[:1]) in {("called",), ("named",)} and not fact.negated
        name = without_called(fact.state) if called and fact.relation in lexicon().be else ()
        if name:
            result += (replace(one, owner=name) for one in known if keys(one.owner) == keys(fact.subject))
    return result


def owner_of(thing: Phrase, facts: Sequence[Remembered]) -> Belonging | None:
    """Whose something is; None if that is not known, or if several things are meant."""
    wanted = set(noun_phrase(thing).core)
    if not wanted - lexicon().determiners:
        return None
    fitting = [b for b in belongings(facts) if wanted <= set(noun_phrase(b.thing).core) | {b.kind}]
    exact = [b for b in fitting if wanted == set(noun_phrase(b.thing).core)]
    chosen = exact or fitting
    return chosen[0] if len({keys(b.owner) for b in chosen}) == 1 else None


def holder_of(thing: Phrase, facts: Sequence[Remembered]) -> Belonging | None:
    """Who is remembered to have something with them; None if that is not known."""
    found = owner_of(thing, facts)
    return found if found is not None and found.source.fact.relation in _WITH else None


_FORGETTING = frozenset({("forget",), ("delete",), ("erase",), ("remove",), ("unlearn",)})
_TELLING = frozenset({"told", "said", "know", "about", "remember", "memory", "mentioned"})


def with_owners_named(words: Phrase, facts: Sequence[Remembered]) -> tuple[Phrase, list[Remembered]]:
    """A message with "the owner of A" and "whoever owns A" by the owner's name, and the facts used."""
    flat = keys(words)
    if flat[:1] in _FORGETTING and _TELLING & set(flat):
        # What is to be forgotten is what goes by that name itself.
        return words, []
    facts = [*told_here(words), *facts]
    words = with_it_named(words, belongings(facts), facts) if facts else words
    flat = keys(words)
    if _SOMEBODY & set(flat) and facts:
        doer = _doer_named(words, flat, facts)
        if doer is not None:
            return doer
    words = _by_their_names(_trait_named(_its_owner(words, facts), facts), facts)
    flat = keys(words)
    theirs = _belonging_said(words, flat, facts)
    if theirs is not None:
        return theirs
    if not {"owner", "owns", "belongs", "driver", "owner's"} & set(flat) or not facts:
        return words, []
    used: list[Remembered] = []
    result: list[Word] = []
    index = 0
    while index < len(words):
        found = _owner_said(words, flat, index, facts)
        if found is None:
            result.append(words[index])
            index += 1
            continue
        end, belonging = found
        result += belonging.owner
        used.append(belonging.source)
        index = end
    return tuple(result), used


_ITS_OWNER = frozenset({"owner", "driver", "proprietor"})
_IT_IS_FOR = tuple(
    tuple(text.split())
    for text in (
        "it belongs to", "that it belongs to", "who it belongs to", "whom it belongs to",
        "to whom it belongs",
        "it is for", "that it is for", "who owns it", "it is meant for", "whose it is", "that owns it",
    )
)  # fmt: skip


def _its_owner(words: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """For "(take A) to its owner" and "to the person it belongs to" whose A is."""
    flat = keys(words)
    for index in range(2, len(flat)):
        size = 0
        if flat[index] in _ITS_OWNER and flat[index - 1] in {"its", "their", "the", "rightful"}:
            size = 0 if flat[index + 1 : index + 2] == ("of",) else 1
        elif flat[index] in _GENERAL | lexicon().person_words | {"to", "whoever"}:
            tail = next((t for t in _IT_IS_FOR if flat[index + 1 : index + 1 + len(t)] == t), ())
            size = len(tail) + 1 if tail else 0
        if not size:
            continue
        said = set(flat[:index])
        about = [b for b in belongings(facts) if set(noun_phrase(b.thing).core) <= said or b.kind in said]
        if len({keys(b.owner) for b in about}) != 1:
            return words
        start = index + (flat[index] == "to")
        while start > 1 and flat[start - 1] in {"its", "their", "the", "rightful", "a"}:
            start -= 1
        return (*words[:start], *about[0].owner, *words[index + size :])
    return words


_SOMEBODY = frozenset({"whoever", "who", "that", "with"})
_GENERAL = frozenset(
    {
        "one",
        "person",
        "man",
        "woman",
        "lady",
        "guy",
        "gentleman",
        "patient",
        "resident",
        "guest",
        "colleague",
        "visitor",
        "customer",
        "girl",
        "boy",
        "somebody",
        "someone",
        "employee",
        "worker",
        "driver",
    }
)


def _doer_named(
    words: Phrase, flat: tuple[str, ...], facts: Sequence[Remembered]
) -> tuple[Phrase, list[Remembered]] | None:
    """For "whoever has the key", "the patient who can not eat nuts": the one person remembered to."""
    if flat[0] in {"who", "whoever"} or (flat[0] in lexicon().question_starts):
        return None
    called = {keys(f.fact.subject) for f in facts if keys(f.fact.state[:1]) in {("called",), ("named",)}}
    for index in range(1, len(flat) - 1):
        start = index
        if flat[index] != "whoever":
            person = flat[index - 1] in _GENERAL | lexicon().person_words
            if flat[index] not in {"who", "that", "with"} or not person:
                continue
            start = index - 1 - (index > 1 and flat[index - 2] in lexicon().determiners)
        end = next(
            (i for i in range(index + 1, len(flat)) if not words[i].is_word or flat[i] in {"and", "then"}),
            len(flat),
        )
        wanted = _content(words[index + 1 : end])
        theirs = [f for f in facts if is_somebodys(f) or keys(f.fact.subject) in called]
        if flat[index] == "with":
            theirs = [f for f in theirs if f.fact.relation in _WITH and wanted <= _content(f.fact.state)]
        scored = [(len(wanted & _content((*f.fact.state, *f.fact.place))), f) for f in theirs]
        best = max((score for score, _ in scored), default=0)
        names = {keys(f.fact.subject): f for score, f in scored if score == best}
        if best and len(names) == 1:
            (known,) = names.values()
            return (*words[:start], *known.fact.subject, *words[end:]), [known]
        named = [f for f in facts if is_somebodys(f) and _alike(wanted, _content(f.fact.state))]
        if flat[index] == "with" and not best and len({keys(f.fact.subject) for f in named}) == 1:
            return (*words[:start], *named[0].fact.subject, *words[end:]), [named[0]]
        theirs_by = flat[index] == "with" or flat[index + 1] in _OWNING | _GETTING
        thing = bare(words[index + (1 if flat[index] == "with" else 2) : end])
        owner = owner_of(thing, facts) if theirs_by and thing and not best else None
        if owner is not None:
            return (*words[:start], *owner.owner, *words[end:]), [owner.source]
    return None


def _alike(wanted: frozenset[str], said: frozenset[str]) -> bool:
    """Whether all words are said, in whatever form ("the nut allergy", "allergic to nuts")."""
    return bool(wanted) and all(any(word[:5] == other[:5] for other in said) for word in wanted)


def _trait_named(words: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """For "the person allergic to dust" the name of the one person who is remembered to be that."""
    flat = keys(words)
    for index in range(2, len(flat) - 1):
        if flat[index - 1] not in _GENERAL or flat[index - 2] != "the" or flat[index] in _SOMEBODY:
            continue
        stops = lexicon().be | lexicon().auxiliaries | {"and", "then"}
        end = next(
            (i for i in range(index, len(flat)) if not words[i].is_word or flat[i] in stops), len(flat)
        )
        wanted = _content(words[index:end])
        fitting = {
            keys(f.fact.subject): f.fact.subject
            for f in facts
            if wanted and is_somebodys(f) and wanted <= _content((*f.fact.state, *f.fact.place))
        }
        if len(fitting) == 1:
            (name,) = fitting.values()
            return (*words[: index - 2], *name, *words[end:])
    return words


def _by_their_names(words: Phrase, facts: Sequence[Remembered]) -> Phrase:
    """For "A's dog" its name, if it is remembered what it is called."""
    said = keys(words)
    asks = said[:1] != () and said[0] in lexicon().question_starts | lexicon().be
    if {"name", "who"} & set(said) or ("called" in said and (asks or "?" in said)):
        return words
    words = by_their_roles(words, facts)
    for known in facts:
        state = known.fact.state
        flat = keys(state)
        at = next((i for i in range(1, len(flat) - 1) if flat[i] in {"called", "named"}), 0)
        if not at or known.fact.relation not in {"has", "have", "owns"} or known.fact.negated:
            continue
        kind = tuple(word for word in flat[:at] if word not in {"a", "an", known.fact.relation, "the"})[-1:]
        owner = keys(known.fact.subject)
        wanted = (*owner[:-1], f"{owner[-1]}'s", *kind)
        said = keys(words)
        where = next((i for i in range(len(said)) if said[i : i + len(wanted)] == wanted), -1)
        if kind and where >= 0:
            return (*words[:where], *state[at + 1 :], *words[where + len(wanted) :])
    return words


def _belonging_said(
    words: Phrase, flat: tuple[str, ...], facts: Sequence[Remembered]
) -> tuple[Phrase, list[Remembered]] | None:
    """For "the thing that belongs to A" the one thing that is A's."""
    at = next((i for i in range(1, len(flat) - 2) if flat[i : i + 2] == ("belongs", "to")), 0)
    if at < 2 or flat[at - 1] not in {"that", "which", "what"} or flat[0] in lexicon().question_starts:
        return None
    start = at - 1 if flat[at - 1] == "what" else at - 2
    start -= start > 0 and flat[start - 1] in lexicon().determiners
    end = next(
        (i for i in range(at + 2, len(flat)) if not words[i].is_word or flat[i] in {"and", "then"}), len(flat)
    )
    owner = set(noun_phrase(words[at + 2 : end]).core)
    theirs = {
        keys(b.thing): b for b in belongings(facts) if owner and owner <= set(noun_phrase(b.owner).core)
    }
    if len(theirs) != 1 or (flat[at - 2] not in {"thing", "one"} and flat[at - 1] != "what"):
        return None
    (belonging,) = theirs.values()
    return (*words[:start], Word("the", "the"), *belonging.thing, *words[end:]), [belonging.source]


def _content(words: Phrase) -> frozenset[str]:
    small = (
        lexicon().be
        | lexicon().auxiliaries
        | lexicon().determiners
        | {"not", "to", "in", "on", "at", "of", "for", "eat", "any"}
    )
    return frozenset(lemma(singular(word.key)) for word in words if word.is_word and word.key not in small)


_OWNER = (
    ("the", "owner", "of"),
    ("owner", "of"),
    ("whoever", "owns"),
    ("the", "person", "who", "owns"),
    ("the", "one", "who", "owns"),
    ("the", "man", "who", "owns"),
    ("the", "woman", "who", "owns"),
    ("the", "driver", "of"),
    ("the", "person", "that", "owns"),
    ("whom", "belongs"),
    ("the", "lady", "who", "owns"),
    ("the", "guy", "who", "owns"),
    ("the", "person", "owning"),
)


def _owner_said(
    words: Phrase, flat: tuple[str, ...], index: int, facts: Sequence[Remembered]
) -> tuple[int, Belonging] | None:
    lead = next((lead for lead in _OWNER if flat[index : index + len(lead)] == lead), ())
    if lead:
        start = index + len(lead)
        for end in range(min(len(words), start + _LONGEST), start, -1):
            belonging = owner_of(bare(words[start:end]), facts) if words[end - 1].is_word else None
            if belonging is not None:
                return end, belonging
        return None
    for end in range(index + 1, min(index + 6, len(words))):
        if flat[end] in {"owner", "driver"} and flat[end - 1].endswith("'s"):
            last = words[end - 1]
            stem = Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s"))
            belonging = owner_of(bare((*words[index : end - 1], stem)), facts)
            if belonging is not None and flat[index] in lexicon().determiners | {stem.key} | set(
                keys(belonging.thing)
            ):
                return end + 1, belonging
    return None


def _belonging(item: Remembered) -> Belonging | None:
    fact = item.fact
    if fact.negated or fact.is_location or not fact.state or not fact.subject:
        return None
    state = tuple(word for word in fact.state if word.is_word)
    if keys(state[:1]) == (fact.relation,):
        state = state[1:]
    if not state:
        return None
    if fact.relation in {"belongs", "belong"} and keys(state[:1]) == ("to",):
        return Belonging(bare(state[1:]), fact.subject, _head(fact.subject), item)
    if fact.relation in _OWNING:
        named = fact.subject[0].is_capital or keys(fact.subject)[-1] in lexicon().person_words
        return Belonging(fact.subject, bare(state), _head(bare(state)), item) if named else None
    if fact.relation in lexicon().be:
        return _by_name(item, state)
    return None


def _by_name(item: Remembered, state: Phrase) -> Belonging | None:
    """For "A is B's", "A is B's car", "B's car is A", "A is owned by B", "the owner of A is B"."""
    subject = item.fact.subject
    flat = keys(state)
    if flat[:1] and flat[0] in _HAVING and flat[1:2] == ("by",):
        return Belonging(bare(state[2:]), subject, _head(subject), item)
    given = flat[:1] and flat[0] in _GIVEN and flat[1:2] == ("to",)
    if given or (flat[:1] and flat[0] in _KEPT and flat[1:2] == ("for",)):
        return Belonging(bare(state[2:]), subject, _head(subject), item)
    if keys(subject)[:2] in {
        ("owner", "of"),
        ("driver", "of"),
        ("keeper", "of"),
        ("tenant", "of"),
        ("user", "of"),
    }:
        owner = state[1:] if flat[:1] in {("called",), ("named",)} else state
        return Belonging(bare(owner), bare(subject[2:]), _head(bare(subject[2:])), item)
    if flat[:2] == ("owner", "of") or flat[:3] == ("the", "owner", "of"):
        thing = bare(state[flat.index("of") + 1 :])
        return Belonging(subject, thing, _head(thing), item)
    if flat[0] in {"mine", "yours"} or flat[:1] == ("my",):
        return Belonging(tokens("operator"), subject, _head(subject), item)
    if flat[0] == "for" and state[1:2] and (state[1].is_capital or flat[-1] in lexicon().person_words):
        return Belonging(bare(state[1:]), subject, _head(subject), item)
    for side, other in ((state, subject), (subject, state)):
        at = next((i for i, word in enumerate(side) if word.key.endswith("'s")), -1)
        if at < 0:
            continue
        stem = Word(side[at].key.removesuffix("'s"), side[at].raw.removesuffix("'s"))
        kind = _head(side[at + 1 :])
        return Belonging(bare((*side[:at], stem)), bare(other), kind or _head(bare(other)), item)
    return None


def _head(phrase: Phrase) -> str:
    core = noun_phrase(phrase).core if phrase else ()
    return core[-1] if core else ""
