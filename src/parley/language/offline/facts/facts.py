"""Statements: what the operator says is so, and what remembered sentences say about where things are."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from parley.language.offline.facts.fact import Fact
from parley.language.offline.facts.said_of import NO_PLACES, NOT_SUBJECTS, said_of
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, plain
from parley.language.word_lists import load_data

__all__ = ["NO_PLACES", "TASTES", "Fact", "only_before", "read_statement", "strip_openers", "where_only"]


@lru_cache(maxsize=8192)
def strip_openers(phrase: Phrase, *, requests: bool = False, reporting: bool = False) -> Phrase:
    """Without politeness (and, if asked for, wordings of requests or reports) at the start."""
    lex = lexicon()
    tables = [lex.polite, *([lex.requests] if requests else []), *([lex.reporting] if reporting else [])]
    while phrase:
        if not phrase[0].is_word:
            phrase = phrase[1:]
            continue
        flat = keys(phrase)
        sizes = [found[0] for table in tables if (found := table.match(flat)) is not None]
        if requests and flat[0] == "to" and lex.verbs.match(flat, 1) is not None:
            sizes.append(1)
        if not sizes or max(sizes) >= len(phrase):
            break
        forbids = lex.prohibitions.match(flat)
        if flat[0] == "no" and forbids is not None and forbids[0] > max(sizes):
            break
        verb = lex.verbs.match(flat)
        goes_on = lex.verbs.match(flat, max(sizes)) is None and requests
        longer = verb is not None and (verb[0] > max(sizes) or (verb[0] == max(sizes) and goes_on))
        if verb is not None and longer and not verb[1].startswith("other:"):
            break
        phrase = phrase[max(sizes) :]
    return phrase


def only_before(said: Phrase, stripped: Phrase) -> Phrase:
    """The word "only" right before what is left of a statement ("only A may V").

    Args:
        said: The whole statement.
        stripped: The same without what opens it.
    """
    at = next((i for i in range(len(said)) if said[i : i + 2] == stripped[:2]), 0)
    return said[at - 1 : at] if at and said[at - 1].key == "only" else ()


def read_statement(phrase: Phrase) -> Fact | None:
    """The fact that a clause states, or None if it states none."""
    said, phrase = phrase, _without_end(strip_openers(phrase, reporting=True))
    flat = keys(phrase)
    if len(flat) < 3 or flat[0] in lexicon().question_starts - {"when"} | lexicon().be:
        return None
    if flat[0] in {"i", "we"} and flat[1] in {"hope", "hoped", "wish", "wonder", "feel"}:
        return None
    denial = lexicon().corrections.match(flat)
    if denial is not None and flat[0] == "that" and len(flat) - denial[0] > 3:
        phrase = strip_openers(phrase[denial[0] :], reporting=True)
    taste = _taste(phrase)
    if taste is not None:
        return taste
    fact = (
        _there_is(phrase)
        or _left(phrase)
        or _holds(phrase)
        or _placed(phrase)
        or _place_first(phrase)
        or _found(phrase)
        or said_of(phrase)
    )
    if fact is None:
        return None
    sentence = _sentence((*only_before(said, phrase), *phrase))
    return replace(fact, place=where_only(fact.place), sentence=sentence)


TASTES = frozenset({"like", "love", "prefer", "hate", "dislike", "enjoy"})
"""What people say of themselves that is worth knowing when something is brought to them."""
_SURE = frozenset({"really", "always", "also", "much", "do", "not", "never", "especially", "just"})
_NO_TASTES = frozenset({
    "it", "you", "your", "this", "that", "these", "those", "them", "him", "her", "to", "how",
    "what", "when", "where", "the", "if", "me", "myself", "being", "seeing", "working", "idea",
    "going", "both", "my", "our", "mondays", "who",
})  # fmt: skip


def _taste(phrase: Phrase) -> Fact | None:
    """For "I like tea", "I do not like milk"."""
    flat = keys(phrase)
    at = next((i for i in range(1, len(flat)) if flat[i] not in _SURE), len(flat))
    liked = phrase[at + 1 :]
    if flat[0] != "i" or flat[at : at + 1] == () or flat[at] not in TASTES or not 0 < len(liked) < 6:
        return None
    if _NO_TASTES & set(keys(liked)) or any(not word.is_word for word in liked):
        return None
    negated = bool({"not", "never"} & set(flat[1:at]))
    return Fact(
        (Word("operator", "operator"),),
        relation=flat[at],
        state=liked,
        negated=negated,
        sentence=plain(phrase),
        another=True,
    )


_TIMES = tuple(tuple(text.split()) for text in load_data("telling")["when"])


def where_only(place: Phrase) -> Phrase:
    """Where something is, without when or since when."""
    flat = keys(place)
    at = next((i for i in range(1, len(flat)) if any(flat[i : i + len(t)] == t for t in _TIMES)), len(flat))
    return place[:at]


_LEAVING = (("has", "left"), ("have", "left"), ("just", "left"), ("left",))
_CONTAINING = frozenset({"holds", "contains", "stores", "houses", "hosts", "keeps"})


def _left(phrase: Phrase) -> Fact | None:
    """For "A has left the room": A is not there any more."""
    flat = keys(phrase)
    for index in range(1, min(6, len(flat) - 1)):
        size = next((len(verb) for verb in _LEAVING if flat[index : index + len(verb)] == verb), 0)
        if not size or flat[0] in {"i", "we", "they", "he", "she"} | NOT_SUBJECTS:
            continue
        if flat[index - 1] in lexicon().determiners | lexicon().be or lexicon().places.match(flat, index - 1):
            continue
        place, subject = bare(phrase[index + size :]), bare(phrase[:index])
        if not place or noun_phrase(place).anchors or any(not word.is_word for word in phrase[:index]):
            return None
        return Fact(subject, place, "in", negated=True)
    return None


def _holds(phrase: Phrase) -> Fact | None:
    """For "The box contains tea": the tea is in the box."""
    flat = keys(phrase)
    link = next((i for i in range(1, min(6, len(flat) - 1)) if flat[i] in _CONTAINING), 0)
    if link and flat[link + 1] == "now":
        phrase, flat = (*phrase[: link + 1], *phrase[link + 2 :]), (*flat[: link + 1], *flat[link + 2 :])
    if link and flat[link - 1] == "now":
        phrase, link = (*phrase[: link - 1], *phrase[link:]), link - 1
    if not link or flat[0] in NOT_SUBJECTS or link >= len(phrase) - 1:
        return None
    if flat[link - 1] in lexicon().person_words:
        return None
    return Fact(bare(phrase[link + 1 :]), bare(phrase[:link]), "in", another=True)


def _without_end(phrase: Phrase) -> Phrase:
    while phrase and not phrase[-1].is_word:
        phrase = phrase[:-1]
    return phrase


def _there_is(phrase: Phrase) -> Fact | None:
    flat = keys(phrase)
    if flat[0] != "there" or not (
        {flat[1]} <= lexicon().be or flat[1] in {"stands", "lies", "should", "used"}
    ):
        return None
    start = 2
    while start < len(flat) and flat[start] in {"be", "also", "now", "still", "not", "to"}:
        start += 1
    negated = "not" in flat[1:start] or flat[start : start + 1] == ("no",)
    another = "also" in flat[1:start] or flat[start : start + 1] == ("another",)
    rest = phrase[start + (1 if negated and flat[start] == "no" else 0) :]
    noun = noun_phrase(rest)
    if not noun.core or not noun.anchors:
        return None
    subject = noun.phrase[: _core_length(noun.phrase, noun.relation)]
    return Fact(bare(subject), _place(rest, noun.relation), noun.relation, negated=negated, another=another)


def _core_length(phrase: Phrase, relation: str) -> int:
    flat, wanted = keys(phrase), tuple(relation.split())
    return next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), len(flat))


def _place(phrase: Phrase, relation: str) -> Phrase:
    cut = _core_length(phrase, relation)
    return bare(phrase[cut + len(relation.split()) :])


def _placed(phrase: Phrase) -> Fact | None:
    """For "I put the box on the shelf", "we keep the keys in the drawer", "Anna moved it to the hall"."""
    flat = keys(phrase)
    lex = lexicon()
    own = flat[0] in {"i", "we", "somebody", "someone", "they", "he", "she"}
    named = phrase[0].is_capital and flat[0] not in lex.vocabulary
    if not own and not named:
        return None
    verb = next((i for i in range(1, min(4, len(flat))) if flat[i] in lex.placing_verbs), 0)
    if not verb or any(
        phrase[i].key not in lex.auxiliaries | {"just", "always", "usually", "also", "already", "now"}
        and not (named and phrase[i].is_capital)
        for i in range(1, verb)
    ):
        return None
    rest = phrase[verb + 1 :]
    noun = noun_phrase(rest)
    if noun.core and noun.relation and noun.anchors and noun.anchors[0]:
        return Fact(
            bare(rest[: _core_length(rest, noun.relation)]), _place(rest, noun.relation), noun.relation
        )
    for index, word in enumerate(rest):
        if word.key in {"to", "into", "onto"} and 0 < index < len(rest) - 1:
            return Fact(
                bare(rest[:index]), bare(rest[index + 1 :]), "at" if word.key == "to" else word.key[:2]
            )
    return None


def _place_first(phrase: Phrase) -> Fact | None:
    """For "In the drawer there is a key", "on the desk you will find the box"."""
    flat = keys(phrase)
    found = lexicon().places.match(flat)
    if found is None:
        return None
    for index in range(found[0] + 1, len(flat) - 1):
        if flat[index : index + 2] in {("there", "is"), ("there", "are")} or flat[index] in {
            "is",
            "are",
            "you",
        }:
            subject_at = index + 1
            while subject_at < len(flat) and flat[subject_at] in {"is", "are", "can", "will", "find", "see"}:
                subject_at += 1
            subject = bare(phrase[subject_at:])
            place = bare(phrase[found[0] : index])
            return Fact(subject, place, found[1]) if subject and place else None
    return None


def _found(phrase: Phrase) -> Fact | None:
    """For "You can find the keys in the drawer"."""
    flat = keys(phrase)
    if flat[0] not in {"you", "one", "we"} or "find" not in flat[1:5]:
        return None
    rest = phrase[flat.index("find") + 1 :]
    noun = noun_phrase(rest)
    if not noun.core or not noun.anchors:
        return None
    return Fact(bare(rest[: _core_length(rest, noun.relation)]), _place(rest, noun.relation), noun.relation)


def _sentence(phrase: Phrase) -> str:
    """The clause as a sentence about a third person, to be remembered."""
    flat = keys(phrase)
    if flat[0] in {"that"} and (denial := lexicon().corrections.match(flat)) is not None:
        return _sentence(strip_openers(phrase[denial[0] :], reporting=True))
    if flat[0] in {"i", "we"} and flat[1] in {"am", "are", "was", "were"}:
        text = "The operator is " + plain(phrase[2:])
    elif flat[0] in {"i", "we"}:
        theirs = (Word("their", "their") if word.key in {"my", "our"} else word for word in phrase[1:])
        text = "The operator " + plain(tuple(theirs))
    elif flat[0] in {"my", "our"}:
        text = "The operator's " + plain(phrase[1:])
    else:
        text = plain(phrase)
        text = text[0].upper() + text[1:]
    return text.rstrip(" ,;")
