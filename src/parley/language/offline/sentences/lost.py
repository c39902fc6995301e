"""What "it" is in an order: the thing told before to be lost ("look for it") or needed ("bring it here")."""

from __future__ import annotations

from typing import Final

from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma, tokens
from parley.language.word_lists import load_data

__all__ = ["with_what_was_lost"]

_LOSING: Final = tuple(
    tuple(line.split()) for line in sorted(load_data("units")["losing"], key=lambda line: -len(line.split()))
)
_MARKS: Final = frozenset({".", "!", "?", ";", "\n"})
_IT: Final = frozenset({"it", "them"})
_WHOSE: Final = frozenset({"my", "his", "her", "their", "our", "the", "a", "an"})
_ENDS: Final = frozenset({
    "and", "but", "so", "again", "somewhere", "anywhere", "near", "this", "that", "last", "yesterday",
    "today",
    "it", "there", "when", "while", "because", "i", "he", "she", "they", "we", "behind", "around", "is",
    "are",
    "was", "were", "from", "with", "earlier", "could", "please", "can", "would", "who", "which", "off", "out",
})  # fmt: skip
_LONGEST: Final = 4


def with_what_was_lost(words: Phrase) -> Phrase:
    """For "I dropped my A near B. Look for it" "... Look for the A"."""
    words = _left_by_others(_without_who_wanted_it(words))
    words = _asked_of(
        _done_to_what_is_needed(_with_what_is_needed(_sought_for(_fetched_for(_not_right(_how_bad(words))))))
    )
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in _IT and flat[i - 1] == "for"), 0)
    thing = _lost(words, flat, at) if at and _searches(flat, at) else ()
    return (*words[:at], Word("the", "the"), *thing, *words[at + 1 :]) if thing else words


def _without_who_wanted_it(words: Phrase) -> Phrase:
    """For "V the A to B, he asked for it this morning" "V the A to B": the order is given already."""
    flat = keys(words)
    if not _IT & set(flat[4:]):
        return words
    result: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS | {","}:
            continue
        part = words[start:index]
        if _told_to_be_wanted(keys(part), keys(result)):
            result = result[:-1] if result[-1].key == "," else result
            result += words[index : index + 1] if result[-1].is_word else ()
        else:
            result += words[start : index + 1]
        start = index + 1
    return tuple(result)


def _left_by_others(words: Phrase) -> Phrase:
    """For "the painters left the A in B. Take it" "... Take the A from B"; "N left A open. V it" is "V A"."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 3) if flat[i] in _LEFT and _begins(words, i)), 0)
    end = next((i for i in range(at + 2, len(flat)) if flat[i] in _MARKS), 0) if at else 0
    it = next((i for i in range(end + 2, min(end + _NEAR, len(flat))) if flat[i] in _IT), 0) if end else 0
    if not it or lexicon().determiners & set(flat[end:it]) or flat[it - 1] in lexicon().be | {"if", "that"}:
        return words
    where = next((i for i in range(at + 2, end) if lexicon().places.match(flat, i) is not None), end)
    if "," in flat[at:end] or "and" in flat[at:end]:
        return words
    thing, place = words[at + 1 : where], words[where:end]
    while where == end and len(thing) > 1 and _is_state(thing[-1].key):
        thing = thing[:-1]
    labelled = thing[-1].key.isdigit() or len(thing[-1].key) == 1
    article = () if labelled and flat[at + 1] not in lexicon().determiners else (Word("the", "the"),)
    named = thing[1:] if flat[at + 1] in lexicon().determiners else thing
    if not 0 < len(named) <= _LONGEST or set(keys(named)) & _ENDS:
        return words
    there = "there" in flat[end:it] or flat[it + 1 : it + 2] in {("from",), ("there",), ("in",), ("at",)}
    order = flat[end + 1 : it]
    if there or not place or not {*order} & (_FETCHING | {"look", "search", "find"}):
        place = ()
    elif {*order} & _FETCHING:
        size = lexicon().places.match(keys(place))
        place = (Word("from", "from"), *place[size[0] if size else 1 :])
    return (*words[:it], *article, *named, *place, *words[it + 1 :])


_LEFT: Final = frozenset({"left", "forgot", "parked", "abandoned", "dumped", "dropped"})
_NEAR: Final = 7
_NOT_OTHERS: Final = frozenset({"i", "you", "if", "when", "that", "is", "are", "was", "were"})
_OTHERS: Final = frozenset({"the", "a", "some", "our", "somebody", "someone"})
_STATES: Final = frozenset({
    "open", "dirty", "empty", "closed", "full", "wet", "messy", "on", "off", "untidy", "cold", "warm", "hot",
    "dry", "loose", "behind",
})  # fmt: skip


def _is_state(word: str) -> bool:
    return word in _STATES or word.endswith(("ing", "ed"))


def _begins(words: Phrase, at: int) -> bool:
    """Whether some others are the subject of the verb there, and a thing follows it."""
    start = next((i + 1 for i in range(at - 1, -1, -1) if not words[i].is_word), 0)
    who = [key for key in keys(words[start:at]) if key not in {"has", "have", "had"}]
    others = who[:1] and (who[0] in _OTHERS or words[start].is_capital)
    theirs = words[at + 1].key not in {"his", "her", "their", "my", "me", "us", "it", "them", "you"}
    return bool(others) and len(who) <= _LONGEST and not _NOT_OTHERS & {*who} and theirs


_WANTED: Final = frozenset(
    tuple(text.split()) for text in (
        "ordered", "asked for", "has asked for", "asked twice for", "has ordered", "requested", "knows about",
        "know about", "knows all about", "paid for", "has paid for", "is waiting for", "are waiting for",
        "waits for", "wait for", "wanted", "expects", "is expecting", "expect", "has requested", "called for",
        "asked me for", "insists on", "insisted on",
    )
)  # fmt: skip
_SOMEBODY: Final = frozenset({"he", "she", "they"})
_MOST_SAID: Final = 9


def _told_to_be_wanted(flat: tuple[str, ...], before: tuple[str, ...]) -> bool:
    """Whether words say no more than who wanted "it", behind an order that says what is done with it."""
    it = next((i for i, key in enumerate(flat) if key in _IT), 0)
    wanted = next((size for size in (1, 2, 3) if 0 < it - size < 3 and flat[it - size : it] in _WANTED), 0)
    if not wanted or len(flat) > _MOST_SAID or not set(flat[it + 1 :]) <= _SINCE:
        return False
    start = next((i + 1 for i in range(len(before) - 2, -1, -1) if before[i] in _MARKS | {","}), 0)
    while before[start : start + 1] and before[start] in _ASKING_FOR | _FIRST:
        start += 1
    deed = _deed(before[start:])
    return bool(deed) and (flat[0] in _SOMEBODY or not deed.startswith(_ABOUT_THINGS))


_FIRST: Final = frozenset({"first", "finally", "lastly", "afterwards", "also", "next"})
_ABOUT_THINGS: Final = ("transfer", "grasp", "search", "look", "whether")
"""With these orders, who wanted "it" may be who is to get it."""


def _deed(flat: tuple[str, ...]) -> str:
    """Which kind of order a sentence is; nothing if it is none."""
    lex = lexicon()
    found = lex.verbs.match(flat) if flat else None
    if found is not None:
        return found[1]
    tells = {*flat} & (lex.be | {"has", "have", "had"}) or flat[:1] == () or flat[0] in lex.determiners
    return "" if tells else "own"


_SINCE: Final = frozenset({
    "this", "morning", "last", "week", "yesterday", "twice", "already", "today", "again", "for", "hours",
    "ages", "an", "hour", "ago", "night", "long", "time", "since", "monday", "tuesday", "wednesday",
    "thursday", "friday", "urgently", "specially", "back", "before", "days", "minutes", "impatiently",
})  # fmt: skip


def _sought_for(words: Phrase) -> Phrase:
    """For "find him for her" "find him"."""
    flat = keys(words)
    for at in range(len(flat) - 3):
        whom = flat[at + 1] in _IT | {"him", "her"} and flat[at + 2] == "for"
        if flat[at] == "find" and whom and flat[at + 3] in {"her", "him", "me", "us", "them"}:
            return (*words[: at + 2], *words[at + 4 :])
    return words


def _fetched_for(words: Phrase) -> Phrase:
    """For "fetch the A, B needs it" "bring the A to B"."""
    flat = keys(words)
    at = next((i for i in range(len(flat)) if flat[i] in {"fetch", "get", "bring", "grab", "collect"}), -1)
    comma = next((i for i in range(at + 2, len(flat)) if not words[i].is_word), 0) if at >= 0 else 0
    need = next((i for i in range(comma + 2, min(comma + 6, len(flat) - 1)) if flat[i] in _NEEDING), 0)
    if not comma or not need or flat[need + 1] not in _IT or any(w.is_word for w in words[need + 2 :]):
        return words
    who, thing = words[comma + 1 : need], words[at + 1 : comma]
    named = who[-1].is_capital or who[0].key == "the"
    if not named or {"to", "for", "me", "him", "her", "it"} & set(keys(thing)):
        return words
    return (*words[:at], Word("bring", "bring"), *thing, Word("to", "to"), *who)


_NEEDING: Final = frozenset({"needs", "wants", "need", "want"})


def _how_bad(words: Phrase) -> Phrase:
    """For "have a look how bad it is" "have a look at it"."""
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        if flat[at] != "how" or flat[at + 1] not in _BAD or flat[at + 2] not in _IT | {"that", "this"}:
            continue
        if flat[at + 3] not in lexicon().be | {"looks", "look"} or flat[at + 4 : at + 5] not in _NO_MORE:
            continue
        it = Word("it", "it")
        if flat[at - 1] in {"look", "glance", "peek"}:
            return (*words[:at], Word("at", "at"), it, *words[at + 4 :])
        size = 2 if flat[at - 2 : at] in {("find", "out"), ("tell", "me"), ("tell", "us")} else 1
        see = size == 2 or flat[at - 1] in {"see", "check"}
        order = (Word("inspect", "inspect"),) if see else words[at - 1 : at]
        return (*words[: at - size], *order, it, *words[at + 4 :])
    return words


def _not_right(words: Phrase) -> Phrase:
    """For "there is something wrong with A, look at it" "A is not right, ..."; "it" is A, and no wrong."""
    flat = keys(words)
    for at in range(len(flat) - 4):
        lead = next((m for m in _SOMETHING if flat[at : at + len(m)] == m), ())
        odd = at + len(lead)
        link = odd + 1
        if lead and lead[-1] != "something":
            link = odd
        elif flat[odd : odd + 1] != () and flat[odd] not in _ODD:
            continue
        if not lead or flat[link : link + 1] not in {("with",), ("about",)}:
            continue
        end = next((i for i in range(link + 1, len(flat)) if not words[i].is_word or flat[i] in _JOINTS), 0)
        if end > link + 1 and any(word.is_word for word in words[end:]):
            told = tuple(Word(part, part) for part in ("is", "not", "right"))
            return (*words[:at], *words[link + 1 : end], *told, *words[end:])
    return words


_ODD: Final = frozenset({
    "wrong", "odd", "strange", "funny", "weird", "off", "amiss", "unusual", "fishy", "up", "broken",
})  # fmt: skip
_SOMETHING: Final = (
    ("there", "is", "something"), ("there", "seems", "to", "be", "something"),
    ("there", "must", "be", "something"), ("there", "might", "be", "something"),
    ("something", "is", "wrong"), ("something", "seems", "wrong"), ("something", "is", "odd"),
    ("something", "seems", "to", "be", "wrong"), ("something", "is", "not", "right"),
    ("something", "is", "up"), ("something", "is", "off"), ("something", "is", "the", "matter"),
)  # fmt: skip
_JOINTS: Final = frozenset({"so", "and", "please", "could", "can"})
_BAD: Final = frozenset({
    "bad", "badly", "serious", "severe", "dangerous", "urgent",
})  # fmt: skip
_NO_MORE: Final = frozenset({(), (".",), (",",), ("?",), ("!",), (";",), ("and",), ("please",), ("then",)})


def _searches(flat: tuple[str, ...], at: int) -> bool:
    """Whether "for it" belongs to looking or searching."""
    return bool({"look", "search", "looking", "searching", "hunt", "eye", "lookout"} & set(flat[at - 5 : at]))


def _lost(words: Phrase, flat: tuple[str, ...], before: int) -> Phrase:
    """What was told to be lost, last before a word; nothing if nothing was."""
    for index in range(before - 1, -1, -1):
        verb = next((v for v in _LOSING if flat[index : index + len(v)] == v), ())
        start = index + len(verb)
        if not verb or flat[start : start + 1] == () or flat[start] not in _WHOSE:
            continue
        end = start + 1
        while end < before and words[end].is_word and not _ends(flat, end):
            end += 1
        between = {key for key in flat[end:before] if key in _MARKS | {",", "so", "could", "would", "please"}}
        if start + 1 < end <= start + 1 + _LONGEST and between:
            return words[start + 1 : end]
    return ()


def _ends(flat: tuple[str, ...], index: int) -> bool:
    return flat[index] in _ENDS or lexicon().places.match(flat, index) is not None


_NEEDS: Final = PhraseTable.of(load_data("units")["needing"])
_FETCHING: Final = frozenset({
    "bring", "take", "get", "fetch", "give", "deliver", "carry", "hand", "pass", "grab", "collect", "put",
})  # fmt: skip
_FOR_IT: Final = frozenset({"it", "them", "some", "one", "that"})
_THOSE: Final = frozenset({"him", "her", "them"})
_LONGEST_WHO: Final = 6
_LONGEST_NEED: Final = 7


def _with_what_is_needed(words: Phrase) -> Phrase:
    """For "A needs a B from C. Get it from there and bring it to her" "Get the B from C and bring it to A".

    Args:
        words: All words and punctuation.
    """
    flat = keys(words)
    order = next((i for i in range(5, len(flat) - 1) if _fetches(flat, i)), 0)
    need = _need(words, flat, order) if order else None
    if need is None:
        return words
    start, end, who, thing, source = need
    rest = words[order + 2 :]
    told = keys(rest[: next((i for i, word in enumerate(rest) if word.key in _MARKS), len(rest))])
    there = next((i for i in range(len(told) - 1) if told[i : i + 2] == ("from", "there")), -1)
    if source and there >= 0:
        rest = (*rest[:there], *source, *rest[there + 2 :])
    elif source and "from" not in told:
        thing = (*thing, *source)
    if keys(who[:1]) in {("i",), ("we",)}:
        who = (Word("me", "me"),)
    for_whom = {"to", "for", "me", "us", "him", "her", "them", "on", "in", "back"} & set(told)
    named = next((i for i in range(len(told)) if _receives(told, i) and keys(who) != ("me",)), -1)
    if named > 0 and told[named - 1] in {"to", "give", "bring", "hand", "for"}:
        rest = (*rest[:named], *who, *rest[named + 1 :])
    if not for_whom:
        rest = (
            (*tokens("and bring it to"), *who, *rest)
            if not told
            else (*rest[: len(told)], *tokens("and bring it to"), *who, *rest[len(told) :])
        )
    between = _placed(words[end:order], thing)
    return (*words[:start], *between, words[order], Word("the", "the"), *thing, *rest)


def _receives(told: tuple[str, ...], at: int) -> bool:
    """Whether a word is for who needs something: "bring them A", not "bring them to A"."""
    carried = told[at] == "them" and told[at + 1 : at + 2] in {("to",), ("over",), ("back",), ("here",)}
    return told[at] in _THOSE and not carried


def _done_to_what_is_needed(words: Phrase) -> Phrase:
    """For "we need the A on B, call it" "call the A on B"."""
    flat = keys(words)
    order = next((i for i in range(4, len(flat) - 1) if _is_order(words, i)), 0)
    at = next((i for i in range(1, order - 1) if _NEEDS.match(flat, i) is not None), 0)
    found = _NEEDS.match(flat, at) if at else None
    start = next((i + 1 for i in range(at - 1, -1, -1) if not words[i].is_word or flat[i] in _JOINS), 0)
    if (
        found is None
        or not 0 < at - start <= _LONGEST_WHO
        or flat[start] in {"you", "if", "it", "there", "do"}
    ):
        return words
    first = at + found[0]
    end = next((i for i in range(first, order) if not words[i].is_word or flat[i] in {"and", "so", "but"}), 0)
    thing = words[first:end]
    if not thing or flat[first] not in lexicon().determiners or {"to", "you", "that"} & set(flat[first:end]):
        return words
    if any(word.is_word and word.key not in _ASKING_FOR for word in words[end:order]):
        return words
    if len(thing) > _LONGEST_NEED or {"i", "we", "he", "she", "they"} & set(keys(thing)):
        return words
    verb = words[order].key
    if len(thing) > 2 and (thing[-1].key == verb or lemma(thing[-1].key) == verb):
        # "The gate open": what is to be done is said again by the order.
        thing = thing[:-1]
    return (*words[:start], words[order], *thing, *words[order + 2 :])


_ASKING_FOR: Final = frozenset({
    "please", "can", "could", "would", "you", "so", "and", "then", "just", "kindly", "now", "but",
})  # fmt: skip
_NO_ORDERS: Final = frozenset(
    {"do", "is", "are", "was", "has", "have", "does", "did", "about", "for", "of", "with"}
)


def _is_order(words: Phrase, at: int) -> bool:
    """Whether an order for "it" or "one" stands there."""
    before, word, it = words[at - 1], words[at], words[at + 1]
    begins = not before.is_word or before.key in _ASKING_FOR - {"now"}
    verb = word.is_word and word.key not in _NO_ORDERS | _FETCHING | lexicon().question_starts
    last = at + 2 == len(words) or words[at + 2].key != "of"
    return begins and verb and it.key in {"it", "one", "them"} and last


def _asked_of(words: Phrase) -> Phrase:
    """For "how heavy is the A? Put it on B" "... Put the A on B"."""
    flat = keys(words)
    if flat[:1] != ("how",) or "?" not in flat[4:-3] or flat[2] not in lexicon().be:
        return words
    end = flat.index("?")
    thing, it = words[3:end], next((i for i in range(end + 2, len(flat)) if flat[i] in _IT), 0)
    labelled = bool(thing) and (thing[-1].key.isdigit() or len(thing[-1].key) == 1)
    named = 1 < len(thing) <= _LONGEST + 1 and (labelled or flat[3] in lexicon().determiners | {"my"})
    order = [word for word in words[end + 1 : it] if word.key not in _ASKING_FOR]
    if not it or not named or len(order) != 1 or order[0].key in _NO_ORDERS:
        return words
    return (*words[:it], *thing, *words[it + 1 :])


def _fetches(flat: tuple[str, ...], at: int) -> bool:
    """Whether "bring it" stands there as an order."""
    before = flat[at - 1]
    return (
        flat[at] in _FETCHING and flat[at + 1] in _FOR_IT and before not in {"i", "we", "they", "to", "not"}
    )


def _need(words: Phrase, flat: tuple[str, ...], order: int) -> tuple[int, int, Phrase, Phrase, Phrase] | None:
    """Where a need is told before an order: its start and end, who needs it, what, and "from" where."""
    for at in range(order - 3, 0, -1):
        found = _NEEDS.match(flat, at)
        start = next((i + 1 for i in range(at - 1, -1, -1) if not words[i].is_word or flat[i] in _JOINS), 0)
        who = words[start:at]
        if found is None or not 0 < len(who) <= _LONGEST_WHO or flat[start] in {"you", "if", "it", "there"}:
            continue
        first = at + found[0]
        end = next(
            (i for i in range(first, order) if not words[i].is_word or flat[i] in {"and", "so", "but"}), 0
        )
        body = flat[first:end]
        cut = body.index("from") if "from" in body else len(body)
        size = next((i for i in range(1, cut) if lexicon().places.match(body, i)), cut)
        thing = tuple(
            w for w in words[first : first + size] if w.key not in lexicon().determiners | {"some", "more"}
        )
        if end and 0 < len(thing) <= _LONGEST and not {"to", "you", "that", "me"} & set(keys(thing)):
            stop = end + (flat[end] in _MARKS | {","})
            return start, stop, who, thing, words[first + cut : end]
    return None


def _placed(words: Phrase, thing: Phrase) -> Phrase:
    """For "it is in C" behind a need "the B is in C"; nothing but joints is nothing."""
    flat = keys(words)
    if "unless" in flat:
        # "It is in C, unless somebody has taken it".
        words = (*words[: flat.index("unless")], _STOP)
    if flat[:1] in {("it",), ("they",)} and flat[1:2] in {("is",), ("are",)}:
        return (Word("the", "the"), *thing, *words[1:])
    if flat[:3] in {("there", "are", "some"), ("there", "is", "one"), ("there", "is", "some")}:
        return (Word("the", "the"), *thing, *words[1:2], *words[3:])
    return (
        words
        if any(word.is_word and word.key not in _JOINS | {"please", "can", "could", "you"} for word in words)
        else ()
    )


_STOP: Final = Word(".", ".")
_JOINS: Final = frozenset({"and", "but", "so", "because", "then", "since"})
