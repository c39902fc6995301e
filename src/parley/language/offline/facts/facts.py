"""Statements: what the operator says is so, and what remembered sentences say about where things are."""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, plain

__all__ = ["Fact", "read_statement", "strip_openers"]


@dataclass(frozen=True, slots=True)
class Fact:
    """Something that is said to be so."""

    subject: Phrase
    """What it is about, without determiner."""
    place: Phrase = ()
    """Where the subject is, without determiner; empty if it is not about a place."""
    relation: str = ""
    """Preposition of the place, or the word that links subject and state."""
    state: Phrase = ()
    """What else is said of the subject."""
    negated: bool = False
    sentence: str = ""
    """The whole, as a sentence."""
    another: bool = False
    """Said of one more thing of that kind, beside those already known."""

    @property
    def is_location(self) -> bool:
        """Whether it says where something is."""
        return bool(self.place)


_NOT_SUBJECTS = frozenset(
    [
        "what",
        "where",
        "who",
        "when",
        "why",
        "how",
        "which",
        "there",
        "you",
        "let",
        "if",
        "whether",
        "please",
        "can",
        "could",
        "would",
        "will",
        "do",
        "does",
        "did",
    ]
)
_STATE_VERBS = frozenset(
    [
        "has",
        "needs",
        "likes",
        "wants",
        "prefers",
        "hates",
        "loves",
        "means",
        "takes",
        "weighs",
        "costs",
        "belongs",
        "opens",
        "closes",
        "works",
        "lives",
        "feels",
        "looks",
    ]
) | frozenset(
    [
        "owns",
        "drives",
        "rents",
        "uses",
        "eats",
        "drinks",
        "starts",
        "ends",
        "begins",
        "speaks",
        "plays",
        "wears",
        "gets",
        "covers",
        "leads",
        "suffers",
        "smokes",
        "reads",
        "sleeps",
        "goes",
        "leaves",
        "arrives",
        "serves",
        "cleans",
        "repairs",
        "teaches",
        "studies",
        "manages",
        "runs",
    ]
)
_OF_SEVERAL = frozenset(
    {"end", "start", "begin", "need", "have", "like", "close", "open", "belong", "last", "cost"}
)
_NOT_WHERE = frozenset({"of", "from", "with", "against"})
_NOT_PLACES = frozenset(
    [
        "repair",
        "construction",
        "maintenance",
        "control",
        "sale",
        "duty",
        "vacation",
        "holiday",
        "renovation",
        "time",
        "order",
        "charge",
        "trouble",
        "fire",
        "danger",
        "love",
        "pain",
        "use",
    ]
)


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


def read_statement(phrase: Phrase) -> Fact | None:
    """The fact that a clause states, or None if it states none."""
    phrase = _without_end(strip_openers(phrase, reporting=True))
    flat = keys(phrase)
    if len(flat) < 3 or flat[0] in lexicon().question_starts - {"when"} | lexicon().be:
        return None
    if flat[0] in {"i", "we"} and flat[1] in {"hope", "hoped", "wish", "wonder", "feel"}:
        return None
    denial = lexicon().corrections.match(flat)
    if denial is not None and flat[0] == "that" and len(flat) - denial[0] > 3:
        phrase = strip_openers(phrase[denial[0] :], reporting=True)
    fact = (
        _there_is(phrase)
        or _left(phrase)
        or _holds(phrase)
        or _placed(phrase)
        or _place_first(phrase)
        or _found(phrase)
        or _said_of(phrase)
    )
    return None if fact is None else replace(fact, sentence=_sentence(phrase))


_LEAVING = (("has", "left"), ("have", "left"), ("just", "left"), ("left",))
_CONTAINING = frozenset({"holds", "contains", "stores", "houses", "hosts", "keeps"})


def _left(phrase: Phrase) -> Fact | None:
    """For "A has left the room": A is not there any more."""
    flat = keys(phrase)
    for index in range(1, min(6, len(flat) - 1)):
        size = next((len(verb) for verb in _LEAVING if flat[index : index + len(verb)] == verb), 0)
        if not size or flat[0] in {"i", "we", "they", "he", "she"} | _NOT_SUBJECTS:
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
    if not link or flat[0] in _NOT_SUBJECTS or link >= len(phrase) - 1:
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
    """For "I put the box on the shelf", "we keep the keys in the drawer"."""
    flat = keys(phrase)
    lex = lexicon()
    if flat[0] not in {"i", "we", "somebody", "someone", "they", "he", "she"}:
        return None
    verb = next((i for i in range(1, min(4, len(flat))) if flat[i] in lex.placing_verbs), 0)
    if not verb or any(
        word not in lex.auxiliaries | {"just", "always", "usually", "also", "already", "now"}
        for word in flat[1:verb]
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


def _said_of(phrase: Phrase) -> Fact | None:
    """For "X is on the Y", "X has moved to the Y", "X stands by the Y", "X is locked"."""
    lex = lexicon()
    flat = keys(phrase)
    if flat[0] in _NOT_SUBJECTS:
        return None
    link = next(
        (
            i
            for i in range(1, len(flat))
            if flat[i] in lex.be
            or (
                flat[i] in {"has", "have", "can", "will", "should"}
                and set(flat[i + 1 : i + 3]) & (lex.be | lex.transition_verbs | lex.location_verbs)
            )
            or (
                flat[i] in lex.location_verbs | lex.transition_verbs
                and lex.goals.match(flat, i + 1) is None
                and lex.places.match(flat, i + 1) is not None
            )
            or (flat[i] in lex.transition_verbs and flat[i + 1 : i + 2] in {("to",), ("into",), ("onto",)})
            or (flat[i] in lex.transition_verbs and flat[i + 1 : i + 3] in {("over", "to"), ("back", "to")})
            or (
                flat[i] in lex.location_verbs
                and lex.places.match(flat, i + 1) is not None
                and i + 2 < len(flat)
            )
            or flat[i] in _STATE_VERBS
            or (flat[i] in _OF_SEVERAL and flat[i - 1].endswith("s") and flat[i - 1] not in lex.vocabulary)
        ),
        0,
    )
    subject = bare(phrase[:link])
    if not link or not subject or link > 9 or any(not word.is_word for word in phrase[:link]):
        return None
    subject = _operator(subject)
    at, negated = _after_link(flat, link)
    if keys(subject[-2:]) == ("used", "to") and len(subject) > 2:
        # What used to be so is so no more.
        subject, negated = subject[:-2], True
    but = flat.index("but", at) if negated and "but" in flat[at:-1] else 0
    if but:
        # "Not on the desk but on the shelf".
        at, negated = but + 1, False
    if flat[at : at + 1] == ("from",) and "to" in flat[at + 1 : -1] and link < at + 1:
        # "Went from the desk to the shelf".
        goal = flat.index("to", at)
        if set(flat[link : at + 1]) & lex.transition_verbs:
            return Fact(subject, bare(phrase[goal + 1 :]), "at", negated=negated)
    if flat[at : at + 1] == ("with",) and at + 1 < len(flat) and phrase[at + 1].is_capital:
        return Fact(subject, bare(phrase[at + 1 :]), "with", negated=negated)
    found = lex.places.match(flat, at)
    moved = bool(set(flat[link:at]) & lex.transition_verbs) or flat[at - 1] in lex.transition_verbs
    if found is None and moved and flat[at : at + 1] in {("to",), ("into",), ("onto",)}:
        found = 1, {"to": "at", "into": "in", "onto": "on"}[flat[at]]
    if (
        found is not None
        and at + found[0] < len(flat)
        and flat[at + found[0]] not in _NOT_PLACES
        and found[1] not in _NOT_WHERE
    ):
        return Fact(subject, bare(phrase[at + found[0] :]), found[1], negated=negated)
    if subject[-1].key in {"location", "place", "position"} and len(subject) > 1 and at < len(flat):
        return Fact(_possessor(subject[:-1]), bare(phrase[at:]), "at", negated=negated)
    if keys(subject) in {("it",), ("that",), ("this",), ("these",), ("those",)}:
        # "That is good" says nothing worth keeping.
        return None
    state = phrase[at:]
    return Fact(subject, relation=flat[link], state=state, negated=negated) if state else None


def _possessor(phrase: Phrase) -> Phrase:
    last = phrase[-1]
    return (*phrase[:-1], Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s")))


def _after_link(flat: tuple[str, ...], link: int) -> tuple[int, bool]:
    """Where what is said begins, and whether it is denied."""
    lex = lexicon()
    at, negated = link, False
    fillers = {
        "now",
        "currently",
        "still",
        "always",
        "usually",
        "already",
        "just",
        "right",
        "again",
        "actually",
        "also",
        "there",
        "over",
        "recently",
        "all",
        "both",
    }
    while at < len(flat):
        if flat[at] in {"not", "never"} or flat[at : at + 2] == ("no", "longer"):
            negated = True
            at += 2 if flat[at] == "no" else 1
        elif (
            flat[at] in lex.be | fillers
            or (flat[at] in lex.auxiliaries and at == link and flat[at] not in {"has", "have"})
            or (
                flat[at] in {"has", "have"}
                and set(flat[at + 1 : at + 3])
                & (lex.be | lex.transition_verbs | lex.location_verbs | {"not"})
            )
            or (
                flat[at] in lex.location_verbs | lex.transition_verbs
                and (
                    lex.places.match(flat, at + 1) or flat[at + 1 : at + 2] in {("to",), ("into",), ("onto",)}
                )
            )
        ):
            at += 1
        else:
            break
    return at, negated


def _operator(subject: Phrase) -> Phrase:
    if keys(subject) in {("i",), ("we",)}:
        return (Word("operator", "operator"),)
    return subject


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
