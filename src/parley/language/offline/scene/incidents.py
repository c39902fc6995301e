"""Situations that people report so that somebody has a look ("water is dripping at A", "B never arrived").

A report names a place of the map, and something happens there, is heard or seen there, or is missing. What is
usually so ("the lift is broken") is no such report but a fact. The words are data (`data/incidents.yaml`).
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.missing import left_by_somebody, missing_at, missing_from
from parley.language.offline.scene.report_words import (
    TELLERS,
    ordinary_words,
    phrase_of,
    phrases_for,
    place_named,
    without_hedges,
    words_for,
)
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.unattended import complained_of, told_by, unanswered, unattended
from parley.language.offline.sentences.finite import verb_at
from parley.language.offline.words.inflecting import forms
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular, tokens

__all__ = ["happened"]

_MOST_WORDS = 26
_MOST_SOUGHT = 4


def happened(words: Phrase, scene: Scene, *, alone: bool = True) -> Phrase | None:
    """The order to have a look that a report means; None if a clause reports nothing of the kind."""
    said = _without_nobody(tuple(word for word in strip_openers(words) if word.is_word))
    flat = keys(said)
    if not 3 <= len(said) <= _MOST_WORDS or flat[0] in _NO_REPORTS:
        return None
    if flat[0] in words_for("renewing") and flat[1] in lexicon().determiners:
        # "Change the light bulb in A" is an order, which nobody here can do.
        return None
    said = without_hedges(said)
    teller, said = told_by(said, scene)
    silent, alone_there = unanswered(said, scene), unattended(said)
    if silent is not None or len(said) < 3 or (_denies(flat) and not alone_there):
        return silent
    if said[0].key in {"smells", "sounds", "stinks", "reeks"}:
        said = (Word("it", "it"), *said)
    flat = keys(said)
    lost = left_by_somebody(said, scene) or missing_from(said, scene)
    if lost is not None:
        return lost
    where = place_named(said, scene)
    faulty = where is not None and flat[where[1] : where[1] + 1] != () and flat[where[1]] in _faulty()
    alarming = faulty or _alarming(said) or alone_there or (bool(teller) and complained_of(flat))
    if not (alarming or (alone and _seems_so(said))):
        return None
    from_where = place_named(teller, scene) if teller else None
    if from_where is not None and (where is None or not _named_in_full(said[slice(*where)], scene)):
        return phrase_of("inspect the", bare(teller[slice(*from_where)]))
    if where is None and flat[-1] == "there" and scene.places and not lexicon().be & set(flat):
        return phrase_of("inspect the", bare(scene.places[-1]))
    if where is None:
        who = said[: verb_at(said)]
        fell = bool(words_for("happened") & set(flat)) and scene.is_person(who)
        return phrase_of("check", who) if fell else None
    start, end = where
    place = bare(said[start:end])
    left = _left_so(flat, end)
    if left:
        return phrase_of("check whether the", place, f"is {left}")
    what = _smelled(said) or _filling(said) or _sought(said, start)
    return phrase_of("inspect the", place, "for", what) if what else phrase_of("inspect the", place)


_NO_REPORTS = (
    lexicon().question_starts | lexicon().auxiliaries | lexicon().be | {"if", "when", "unless", "you"}
)


@cache
def _events() -> frozenset[str]:
    """Each verb of an event as it is used of what goes on now."""
    return forms(words_for("events"))


@cache
def _faulty() -> frozenset[str]:
    """What something does that is not all right, as it is said of one thing."""
    return frozenset(f"{verb}es" if verb[-1] in "zhx" else f"{verb}s" for verb in words_for("faults"))


def _named_in_full(words: Phrase, scene: Scene) -> bool:
    """Whether words are all of what something on the map is called."""
    found = scene.ground(words)
    return found.outcome == "match" and len(tokens(found.candidates[0].description)) <= len(bare(words))


def _without_nobody(words: Phrase) -> Phrase:
    """Without "and nobody is there" behind what is reported."""
    flat = keys(words)
    ends = (i for i in range(4, len(flat) - 1) if flat[i] in {"and", "but"} and flat[i + 1] in _NOBODY_ELSE)
    return words[: next(ends, len(words))]


_ALIVE = frozenset({
    "somebody", "someone", "something", "kids", "children", "teenagers", "stranger", "strangers", "people",
    "dog", "bird",
})  # fmt: skip
_NOBODY_ELSE = frozenset({"nobody", "no", "i", "we", "they", "it", "she", "he"})


def _denies(flat: tuple[str, ...]) -> bool:
    return bool({"no", "nothing", "nobody", "without"} & set(flat)) and not any(missing_at(flat))


def _alarming(said: Phrase) -> bool:
    """Whether something goes on, or is perceived, that somebody should see to."""
    flat = keys(said)
    if any(one == "last" and other in _LONG_AGO for one, other in pairwise(flat)):
        return False
    if _somebody_acts(flat):
        return True
    events, happened_ = _events() & set(flat), words_for("happened") & set(flat)
    ordinary = {f"{one} {other}" for one, other in pairwise(flat)} & ordinary_words()
    heads = [word for word in flat if not any(pair.startswith(f"{word} ") for pair in ordinary)]
    things = words_for("things") & ({singular(word) for word in heads} | set(heads))
    perceived = any(
        (flat[i] in words_for("perceiving") or flat[i].removesuffix("ing") in words_for("perceiving"))
        and flat[i - 1] in TELLERS | {"can", "could", "just", "also", "have", "am", "are", "keep"}
        for i in range(1, min(8, len(flat)))
        if flat[0] in TELLERS
    )
    told = bool(words_for("reporting") & set(flat[1:5])) and flat[0] not in {"you"}
    found = words_for("states") & set(flat)
    fragment = not verb_at(said) and not lexicon().be & set(flat) and bool(things & set(flat[:3]))
    pairs = {f"{one} {other}" for one, other in pairwise(flat)}
    if pairs & words_for("accidents") or _turned(flat) or _filled(flat, things):
        return True
    if _went_off(flat):
        return True
    if {"yesterday"} & set(flat) or (flat[0] in {"i", "we"} and not perceived and not _there_is(flat)):
        return False
    if things and words_for("making") & set(flat):
        return True
    left = _left_so(flat, 0) and {"left", "forgot", "forgotten", "wide"} & set(flat)
    if left or fragment or happened_:
        return True
    if events and (flat[0] in _SOME | {"there", "it"} or perceived or told or _goes_on(flat, events)):
        return True
    doing = next((i for i, word in enumerate(flat) if word.endswith("ing") and flat[i - 1] in _GOING_ON), 0)
    if doing and flat[doing - 1] in {"keeps", "keep"} and flat[doing] in words_for("again and again"):
        return True
    usual = doing and (flat[doing] == "being" or lemma(flat[doing]) in words_for("usual") | {"be"})
    if not usual and (things if flat[0] in _ANY else things - _ALIVE) & (
        {singular(word) for word in flat[:doing]} | set(flat[:doing])
    ):
        # "Sparks are flying from A".
        return True
    if usual and flat[0] in _ALIVE and lemma(flat[doing]) in _MENDING:
        return False
    return bool((found or things) and (perceived or told or flat[0] in _SOME | {"it"} or _there_is(flat)))


def _went_off(flat: tuple[str, ...]) -> bool:
    """For "the alarm went off", "the lamp at A has gone off"."""
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in _GOING and flat[i + 1] == "off"), 0)
    named = words_for("going off") & set(flat) if {"gone", "went", "going", "goes"} & set(flat) else set()
    known = at > 1 and flat[0] in {"the", "our"}
    return bool(named and "off" in flat) or (known and flat[at + 2 :] in _NO_MORE)


_GOING = frozenset({"gone", "went"})
_NO_MORE = frozenset({(), ("again",), ("suddenly",), ("now",), ("just", "now")})


def _turned(flat: tuple[str, ...]) -> bool:
    """For "A went dark", "B is stuck in C": something became as it should not be."""
    for one, other in pairwise(flat):
        if other in words_for("turned") and one in {"went", "gone", "goes", "going", "turned"}:
            return True
    at = next((i for i in range(1, len(flat) - 2) if flat[i] in words_for("caught")), 0)
    return (
        bool(at) and flat[at - 1] in _GOING_ON | {"got"} and lexicon().places.match(flat, at + 1) is not None
    )


def _filled(flat: tuple[str, ...], things: set[str] | frozenset[str]) -> bool:
    """For "A is full of smoke"."""
    at = next((i for i in range(2, len(flat) - 1) if flat[i - 1 : i + 1] in _FULL), 0)
    return bool(at) and bool(things & ({singular(word) for word in flat[at:]} | set(flat[at:])))


_FULL = frozenset({
    ("full", "of"), ("covered", "in"), ("covered", "with"), ("littered", "with"), ("filled", "with"),
    ("filling", "with"), ("crawling", "with"), ("soaked", "in"),
})  # fmt: skip


_MENDING = frozenset(
    {"repair", "mend", "fix", "clean", "paint", "replace", "check", "inspect", "mop", "sweep"}
)
_LONG_AGO = frozenset({
    "year", "week", "month", "summer", "winter", "spring", "autumn", "monday", "tuesday", "wednesday",
    "thursday", "friday", "saturday", "sunday", "time",
})  # fmt: skip


def _somebody_acts(flat: tuple[str, ...]) -> bool:
    """For "a man is climbing over A": somebody or something that nobody knows does what is not usual."""
    begin = 2 if flat[:2] in {("there", "is"), ("there", "are")} else 0
    if flat[begin] not in _ANY or flat[begin + 1 : begin + 2] == ("of",):
        return False
    for at in range(begin + 1, min(begin + 7, len(flat))):
        goes_on = begin > 0 or bool({"is", "are", "keeps", "keep", "been"} & set(flat[1:at]))
        if flat[at].endswith("ing") and goes_on and at + 1 < len(flat):
            base = lemma(flat[at])
            return base != flat[at] and base not in words_for("usual")
        if flat[at - 1] in {"has", "have", "just"} and at + 2 < len(flat) and not begin:
            base = lemma(flat[at])
            return base != flat[at] and base not in words_for("usual")
    return False


_ANY = frozenset({
    "a", "an", "some", "somebody", "someone", "something", "people", "two", "three", "four", "five",
    "several", "kids", "children", "teenagers", "strangers", "many", "lots", "another", "one",
})  # fmt: skip


def _seems_so(said: Phrase) -> bool:
    """For "A looks dry": how something seems, unless it seems to be all right."""
    flat = keys(said)
    verb = verb_at(said)
    seeming = bool(verb) and flat[verb] in {"looks", "seems", "appears", "sounds"} and len(flat) > verb + 1
    return seeming and not _FINE & set(flat[verb + 1 :]) and flat[0] not in TELLERS | {"it", "that", "this"}


def _there_is(flat: tuple[str, ...]) -> bool:
    """Whether something is said to be there, or to be had that nobody wants ("we have water coming in")."""
    having = flat[:2] in {("we", "have"), ("i", "have"), ("they", "have")}
    there = flat[:1] == ("there",) and flat[1:2] and flat[1] in lexicon().be | _MAYBE
    return bool(there) or (
        having and "been" not in flat[:4] and any(word.endswith("ing") for word in flat[3:])
    )


_MAYBE = frozenset({"has", "have", "may", "might", "could", "must", "seems", "appears"})
_FINE = frozenset(
    {
        "nice",
        "good",
        "fine",
        "great",
        "lovely",
        "beautiful",
        "ok",
        "okay",
        "right",
        "clean",
        "perfect",
        "wonderful",
        "ready",
        "like",
        "happy",
        "to",
    }
)
_SOME = frozenset({"something", "somebody", "someone", "some", "somewhere", "people"})


def _goes_on(flat: tuple[str, ...], events: set[str] | frozenset[str]) -> bool:
    """Whether an event is said to go on: "is leaking", "keeps beeping"."""
    return any(
        word in events and word.endswith("ing") and index and flat[index - 1] in _GOING_ON
        for index, word in enumerate(flat)
    )


_GOING_ON = lexicon().be | {
    "stop",
    "keeps",
    "keep",
    "starts",
    "started",
    "still",
    "just",
    "constantly",
    "kept",
    "been",
}


def _left_so(flat: tuple[str, ...], end: int) -> str:
    """How something was left that should not be so: "open", "on"."""
    if not {"left", "forgot", "forgotten", "still", "wide", "stands", "standing"} & set(flat):
        return ""
    rest = flat[end:]
    return next((word for word in rest if word in words_for("left") and word not in {"off", "out"}), "")


def _filling(words: Phrase) -> Phrase:
    """For "A is full of smoke" the smoke."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat) - 1) if flat[i - 1 : i + 1] in _FULL), 0)
    return bare(words[at + 1 :]) if at and len(flat) - at < 5 else ()


def _smelled(words: Phrase) -> Phrase:
    """For "A reeks of gas" the gas."""
    flat = keys(words)
    smell = words_for("smelling")
    at = next((i for i in range(len(flat) - 2) if flat[i] in smell and flat[i + 1] in {"of", "like"}), -1)
    what = words[at + 2 : at + 5] if at >= 0 else ()
    end = next((i for i, word in enumerate(what) if lexicon().places.match((word.key,))), len(what))
    return bare(what[:end])


def _sought(words: Phrase, place_at: int) -> Phrase:
    """What is to be looked for: what is perceived, is there, or does something, before the place."""
    flat = keys(words)
    end = _owned_until(flat, place_at)
    while end and (size := _preposition_ends(flat, end) or flat[end - 1] in _BEFORE_PLACES):
        end -= size
    start = next((i + 1 for i in range(end - 1, -1, -1) if _leads(flat, i)), 0)
    if start >= end and start > 1:
        # "Glass is all over A", "a box was found at A".
        end = start - 1
        while end and flat[end - 1] in lexicon().be:
            end -= 1
        start = next((i + 1 for i in range(end - 1, -1, -1) if _leads(flat, i)), 0)
    if flat[:2] == ("it", "is"):
        return ()
    if 1 < start <= end - 1 <= start + 1 and _is_past(flat[end - 1]) and flat[end - 2] == "been":
        # "A box has been left".
        end = next((i for i in range(1, start) if flat[i] in {"has", "have", "had"}), start)
        start = next((i + 1 for i in range(end - 1, -1, -1) if _leads(flat, i)), 0)
    linked = start > 1 and flat[start - 1] in lexicon().be | {"has", "have"}
    if linked and "there" not in flat[: start - 1] and not _handled(words[start:end]):
        # "Water is dripping": what drips is looked for.
        end = start - 1
        start = next((i + 1 for i in range(end - 1, -1, -1) if _leads(flat, i)), 0)
    what = tuple(word for word in words[start:end] if word.key not in _LIGHT)
    where = (i for i in range(2, len(what)) if lexicon().places.match(keys(what), i))
    what = what[: next(where, len(what))]
    while what and what[0].key in lexicon().determiners:
        what = what[1:]
    what = _handled(what) or what[: next((i for i in range(1, len(what)) if _does(what, i)), len(what))]
    if keys(what) == ("there",):
        # "There is someone in A".
        return tuple(word for word in words if word.key in {"somebody", "someone"})[:1]
    alone = len(what) == 1 and what[0].key in _NOBODY | lexicon().person_pronouns | lexicon().thing_pronouns
    alone = alone or (len(what) == 1 and _is_past(what[0].key))
    return what if 0 < len(what) <= _MOST_SOUGHT and not alone and what[0].key not in _NO_THING else ()


def _owned_until(flat: tuple[str, ...], end: int) -> int:
    """Where what is sought ends: before "(a bag) nobody owns", "(a bag) that belongs to nobody"."""
    table = phrases_for("unattended")
    return next(
        (
            i
            for i in range(2, end)
            if flat[i] in _WHOSE and any(table.match(flat, j) is not None for j in (i, i + 1))
        ),
        end,
    )


_WHOSE = frozenset({"nobody", "no", "that", "which", "who", "belonging"})


def _handled(what: Phrase) -> Phrase:
    """For "(somebody) left the tap running" the tap: what somebody did something to."""
    flat = keys(what)
    at = next((i for i in range(len(flat) - 2) if flat[i + 1] in _THE and _is_past(flat[i])), -1)
    stuff = flat[1:2] and flat[1] not in _WAYS
    if at not in {0, 1} and not (stuff and _is_past(flat[0])):
        return ()
    rest = what[at + 2 :] if at >= 0 else what[1:]
    return rest[: next((i for i in range(1, len(rest)) if _does(rest, i)), len(rest))]


_WAYS = frozenset({
    "away", "down", "off", "over", "out", "up", "back", "apart", "loose", "open", "again", "into", "through",
    "in", "by", "itself", "himself", "herself", "badly", "completely", "suddenly", "around", "about",
})  # fmt: skip


def _is_past(word: str) -> bool:
    return (lemma(word) != word or word.endswith("ed")) and not word.endswith(("ing", "s"))


def _leads(flat: tuple[str, ...], index: int) -> bool:
    """Whether a word comes before what is perceived; "smell" only as a verb."""
    if flat[index] in {"smell", "got"} and index:
        return flat[index - 1] in TELLERS | {"can", "you", "could", "have"}
    if flat[index] == "people" and index:
        # "Two people (are waiting)": those who are there, not those who tell it.
        return flat[index - 1] in lexicon().determiners
    if flat[index] in {"of", "about", "like"}:
        return index > 0 and flat[index - 1] in words_for("reporting") | words_for("smelling")
    return flat[index] in _LEADS


def _does(what: Phrase, at: int) -> bool:
    """Whether a word says what something does or is, and no more what it is called."""
    word = what[at].key
    so = word in words_for("states") or (word.endswith("ing") and lemma(word) != word)
    if keys(what[:at]) in _VAGUE:
        # "Something burning" is sought as such.
        return not so
    noun = word == lemma(word) and not what[at - 1].key.endswith("s")
    known = word in words_for("happened") | _KEEPING or (word in _events() and not noun)
    return so or known or (not noun and bool(verb_at(what[at - 1 : at + 1])))


def _preposition_ends(flat: tuple[str, ...], end: int) -> int:
    """How many words before `end` are a preposition of place."""
    return next(
        (
            end - start
            for start in range(max(0, end - 4), end)
            if (found := lexicon().places.match(flat, start)) is not None and start + found[0] == end
        ),
        0,
    )


_VAGUE = frozenset({("something",), ("somebody",), ("someone",), ("some",), ("people",)})
_THE = frozenset({"a", "an", "the", "some", "his", "her", "their", "my"})
_NOBODY = frozenset({"something", "somebody", "someone", "some", "people", "somewhere"})
_KEEPING = frozenset(
    {
        "got",
        "gets",
        "getting",
        "keeps",
        "keep",
        "kept",
        "just",
        "all",
        "everywhere",
        "to",
        "that",
        "who",
        "which",
    }
)
_NO_THING = frozenset({"not", "never", "to", "you", "your", "that", "this", "what", "because", "and"})
_BEFORE_PLACES = lexicon().determiners | {
    "somewhere", "coming", "from", "to", "into", "against", "onto", "right", "around", "over", "out",
    "middle", "centre", "center", "corner",
    "of", "in", "off", "down", "up",
}  # fmt: skip
_LEADS = (
    lexicon().be
    | lexicon().auxiliaries
    | TELLERS
    | words_for("perceiving")
    | words_for("reporting")
    | {"that", "me", "us", "of", "about", "like", "has", "have", "had"}
) - {"light", "sound"}
_LIGHT = frozenset({
    "some", "very", "quite", "really", "just", "still", "now", "again", "apparently",
    "also", "suddenly", "lots", "loads", "plenty",
})  # fmt: skip
