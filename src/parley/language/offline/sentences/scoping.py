"""What a denial covers: "not A but B" is B, "do not go to A, just to B" is going to B.

A part of a message that only says what is not wanted is left out where another part says what is; the verb of
the denied part goes to the wanted one if that has none. What is denied alone stays: it is an order too.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from parley.language.offline.scene.marks import by_ids, marks_of
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.denials import (
    ABOUT,
    LINKS,
    MARKS,
    Part,
    led_in,
    names_stop,
    pointed,
    stop_end,
    with_denials,
    without_end,
    without_reasons,
    words_of,
)
from parley.language.offline.sentences.sparing import name_spans, names_in
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain
from parley.language.word_lists import load_data

__all__ = ["Scoped", "scoped"]

IsStop = Callable[[Phrase], bool]
IdsOf = Callable[[Phrase], Sequence[str]]

_DATA = load_data("scoping")
_TAILS = PhraseTable.of(_DATA["tails"])
_RATHER = PhraseTable.of(_DATA["rather"])
_PREFERRED = PhraseTable.of(_DATA["preferred_to"])
_SURE = PhraseTable.of(_DATA["sure"])
_SAID = frozenset({"said", "mean", "meant", "want", "wanted", "need", "needed", "say", "asked"})
_GOING = frozenset({"motion", "back", "wait"})


@dataclass(frozen=True)
class Scoped:
    """A message without what is only denied."""

    words: Phrase
    spared: frozenset[str] = frozenset()
    """The identifiers of what is to be left alone, whatever else is wanted."""


def scoped(words: Phrase, is_stop: IsStop, is_pending: IsStop, ids_of: IdsOf = lambda part: ()) -> Scoped:
    """The message without what is only denied, if it says what is wanted instead.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
        is_pending: Whether they name something that the robot is still to do; to deny that changes the plan.
        ids_of: The identifiers of what words name.
    """
    words = _contrasted(_stressed(_left_undone(words), is_stop), is_stop)
    plainer = _along(_each_asked(words), is_stop)
    preferred = _preferred(plainer, is_stop)
    if len(preferred) < len(plainer) and _from_group(plainer, preferred, is_stop, ids_of):
        preferred = plainer
    if len(preferred) < len(plainer) and _says(without_end(preferred), is_stop):
        preferred = (*words_of("go to"), *preferred[2:])
    words = _without_tail(_sure(preferred))
    parts = led_in(pointed(with_denials(words, is_stop), is_stop))
    denied = [part for part in parts if part.denied]
    if not denied or any(names_stop(part.words, is_pending) for part in denied):
        return Scoped(words)
    after_all = _wanted_after_all(parts)
    if after_all is not None:
        return Scoped(after_all or words)
    wanted = [name for part in parts if not part.denied for name in names_in(part.words, is_stop)]
    single = {found[0] for name in wanted if len(found := ids_of(name)) == 1 and not any(map(marks_of, name))}
    spared = frozenset(one for part in denied for name in part.names for one in ids_of(name)) - single
    if not wanted:
        return Scoped(words, spared)
    alone = not any(opens_command(_without_lead(p.words)) for p in parts if not p.denied)
    result: list[Word] = []
    verb: Phrase = ()
    for part in without_reasons(parts, is_stop):
        if part.denied:
            verb = part.verb or verb
            if result and part.mark and part.mark[0].key in MARKS and result[-1].key in {",", "but"}:
                result[-1:] = part.mark
            continue
        said = _spared_from(part.words, spared, is_stop, ids_of)
        clean = _wanted(said, verb, is_stop, alone=alone)
        verb = () if opens_command(clean) else verb
        result += (*clean, *part.mark)
    return Scoped(_without_comma(tuple(result)), spared)


def _from_group(words: Phrase, left: Phrase, is_stop: IsStop, ids_of: IdsOf) -> bool:
    """Whether what was taken out belongs to a group that is left ("check the doors, not the red one")."""
    kept = [ids_of(name) for name in names_in(left, is_stop)]
    gone = {one for name in names_in(words, is_stop) for one in ids_of(name)} - {
        i[0] for i in kept if len(i) == 1
    }
    gone -= {one for ids in kept if len(ids) > 1 for one in ids} - _only(words, is_stop, ids_of)
    return any(gone & set(ids) for ids in kept if len(ids) > 1)


def _only(words: Phrase, is_stop: IsStop, ids_of: IdsOf) -> set[str]:
    """The identifiers of what words name one by one."""
    return {ids[0] for name in names_in(words, is_stop) if len(ids := ids_of(name)) == 1}


def _spared_from(words: Phrase, spared: frozenset[str], is_stop: IsStop, ids_of: IdsOf) -> Phrase:
    """A part whose groups ("the doors", "doors 2 to 4") are without what is to be left alone."""
    result: list[Word] = []
    at = 0
    for start, end in name_spans(words, is_stop) if spared else ():
        ids = ids_of(words[start:end])
        left = [one for one in ids if one not in spared]
        result += words[at:start]
        if 0 < len(left) < len(ids):
            result.append(by_ids(left, plain(words[start:end])))
        else:
            result += words[start:end]
        at = end
    return (*result, *words[at:])


def _without_comma(words: Phrase) -> Phrase:
    return words[:-1] if keys(words[-1:]) in {(",",), ("but",), ("and",)} else words


def _wanted_after_all(parts: list[Part]) -> Phrase | None:
    """The order that goes back to what was denied: "do not look at A, only go there"; None if none does.

    Empty where it says no more than the message does.
    """
    for before, part in itertools.pairwise(parts):
        flat = keys(part.words)
        if not before.denied or part.denied or len(part.words) > 8:
            continue
        order = _without_lead(part.words)
        if before.names and keys(order[1:2]) in {("it",), ("them",)} and len(order) < _LONGEST_DENIED:
            # "Do not V A, just W it".
            return ()
        if not before.verb:
            continue
        if "there" not in flat[1:] and not (_BACK & set(flat) and opens_command(order)):
            continue
        passive = keys(before.words)[:2] in {("i", "do"), ("we", "do")}
        if not passive or len(parts) > 2 or len(before.names) != 1 or "there" not in flat:
            return ()
        at = flat.index("there")
        return (*part.words[:at], *words_of("to"), *before.names[0], *part.words[at + 1 :])
    return None


def _without_lead(words: Phrase) -> Phrase:
    while (found := _RATHER.match(keys(words))) is not None and found[0] < len(words):
        words = words[found[0] :]
    return words


def _without_tail(words: Phrase) -> Phrase:
    """Without ", nothing else" behind what is asked for."""
    end = len(words)
    while end and not words[end - 1].is_word:
        end -= 1
    size = _TAILS.match_end(keys(words[:end]))
    before = words[end - size - 1 : end - size]
    if not size or not before or before[0].key not in {",", ".", ";", "and", "but"} or end - size < 3:
        return words
    return (*words[: end - size - 1], *words[end:])


def _sure(words: Phrase) -> Phrase:
    """For "see to it that no door is open" "make sure that"."""
    flat = keys(words)
    for index in range(len(flat)):
        found = _SURE.match(flat, index)
        if found is not None and found[0] > 2 and found[1] not in {"make sure that", "make certain that"}:
            return (*words[:index], *words_of("make sure that"), *words[index + found[0] :])
    return words


def _stressed(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "it is (not) A I need looked at", "A is what I want inspected": (do not) look at A."""
    flat = keys(words)
    for start in (i for i in range(len(flat)) if not i or flat[i - 1] in MARKS | {",", "but", "and"}):
        lead = start + 2 if flat[start : start + 2] in {("it", "is"), ("it", "was")} else start
        at = lead + (lead > start and flat[lead : lead + 1] == ("not",))
        end = stop_end(words, at, is_stop)
        behind = end + (flat[end : end + 1] in {("that",), ("which",)})
        if lead == start:
            behind = end + 2 if flat[end : end + 2] in {("is", "what"), ("are", "what")} else len(flat)
        wish = next((m for m in _WISHES if flat[behind : behind + len(m)] == m), ())
        done = behind + len(wish)
        base = lemma(flat[done]) if end > at and wish and done < len(flat) else ""
        close = next(
            (i for i in range(done, len(flat)) if not words[i].is_word or flat[i] in {"and", "but"}),
            len(flat),
        )
        if (
            not base
            or (base == flat[done]) is not (wish[-1:] == ("to",))
            or lexicon().verbs.match((base, *flat[done + 1 : close])) is None
        ):
            continue
        verb = (Word(base, base), *words[done + 1 : close])
        denied = words_of("do not") if at > lead else ()
        return _stressed((*words[:start], *denied, *verb, *words[at:end], *words[close:]), is_stop)
    return words


_WISHES = tuple(
    (who, *want.split())
    for who in ("i", "we")
    for want in ("want you to", "need you to", "would like you to", "need", "want", "would like", "wanted")
)


def _contrasted(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "A does not need checking but B does", "neither A needs a visit, only B does": B needs it."""
    flat = keys(words)
    end = next((i for i in range(len(flat)) if flat[i] in MARKS), len(flat))
    joint = next((i for i in range(3, end - 2) if flat[i] in {"but", "only", ","}), 0)
    other = joint + 1 + (flat[joint + 1 : joint + 2] in {("but",), ("only",)})
    helper = flat[end - 1] if joint else ""
    if helper not in _HELPERS or not is_stop(words[other : end - 1]):
        return words
    told = without_end(_denied_of(words[:joint], is_stop))
    if not told or (told[0].key in lexicon().be) is not (helper in lexicon().be):
        return words
    verb = helper if helper in lexicon().be else told[0].key
    if helper == "does":
        verb = "has" if verb == "have" else f"{verb}s"
    return (*words[other : end - 1], Word(verb, verb), *told[1:], *words[end:])


_HELPERS = frozenset({"does", "do", "is", "are", "has", "have"})
_NEITHER = frozenset({"neither", "none", "no"})
_LONGEST_DENIED = 6


def _denied_of(words: Phrase, is_stop: IsStop) -> Phrase:
    """What is not so of what a clause is about, with its verb in its base form: "need checking"."""
    flat = keys(words)
    if flat[0] in _NEITHER:
        verb = next((i for i in range(2, min(len(flat), _LONGEST_DENIED)) if flat[i] in _NEEDING), 0)
        return (*words_of(_NEEDING[flat[verb]]), *words[verb + 1 :]) if verb else ()
    at = next((i for i in range(1, len(flat) - 1) if flat[i + 1] in {"not", "no"} and is_stop(words[:i])), 0)
    if not at:
        return ()
    if flat[at + 1] == "no":
        verb_said = _NEEDING.get(flat[at], "")
        return (*words_of(f"{verb_said} a"), *words[at + 2 :]) if verb_said not in {"", "is"} else ()
    return words[at + 2 :] if flat[at] in {"does", "do"} else (*words_of("is"), *words[at + 2 :])


_NEEDING = {
    "needs": "need", "need": "need", "has": "have", "have": "have", "wants": "want", "want": "want",
    "requires": "require", "require": "require", "is": "is", "are": "is",
}  # fmt: skip


def _along(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "up aisle 1, down aisle 2": to each of them."""
    flat = keys(words)
    result = list(words)
    for index in range(1, len(words) - 1):
        path = flat[index] in _PATHS and (flat[index - 1] == "," or flat[index - 1] in _GOING_VERBS)
        if path and stop_end(words, index + 1, is_stop) > index + 1:
            result[index] = Word("to", "to")
    return tuple(result)


_PATHS = frozenset({"up", "down", "along", "through", "past", "round", "across", "via", "by"})
_GOING_VERBS = frozenset({"go", "drive", "run", "move", "head", "roll", "walk", "then"})


def _each_asked(words: Phrase) -> Phrase:
    """For "I want to know of all doors whether they are shut": whether all doors are shut."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat)) if flat[i] in {"whether", "if"}), 0)
    lead = next((m for m in _KNOWING if flat[: len(m)] == m), ())
    points = flat[at + 1 : at + 2] in {("it",), ("they",)} or (
        at + 1 < len(words) and bool(marks_of(words[at + 1]))
    )
    if not at or not lead or at <= len(lead) or not points:
        return words
    return (*words_of("check whether"), *words[len(lead) : at], *words[at + 2 :])


_KNOWING = tuple(
    (*want, "know", of)
    for want in (
        ("i", "want", "to"),
        ("i", "need", "to"),
        ("i", "would", "like", "to"),
        ("we", "need", "to"),
        ("let", "me"),
    )
    for of in ("of", "about", "for")
)


def _preferred(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to B rather than A", "check B, not A": without A."""
    flat = keys(words)
    for index in range(2, len(flat) - 1):
        found = _PREFERRED.match(flat, index)
        if found is None or flat[index - 1] in {"is", "are", "do", "did", "does", "am", "if", "or"}:
            continue
        if found[1].startswith("than") and _compares(flat[:index]):
            continue
        start = index + found[0]
        start += flat[start : start + 1] != () and flat[start] in LINKS
        end = stop_end(words, start, is_stop)
        if found[1] not in {"not", "and not", "but not"} and end == start:
            marks = (i for i in range(start, len(flat)) if flat[i] in MARKS | {",", "and", "then"})
            end = min(next(marks, len(flat)), start + 6)
        close = end == len(flat) or flat[end] in MARKS | {",", "and", "then"}
        if end == start or not close or not names_stop(words[:index], is_stop):
            continue
        lead = index - (flat[index - 1] == ",")
        return _preferred((*words[:lead], *words[end:]), is_stop)
    return words


def _left_undone(words: Phrase) -> Phrase:
    """Without what is left undone or to others: "V A without being W-ed", "V A and leave the W-ing to me"."""
    flat = keys(words)
    for index in range(2, len(flat) - 2):
        end = next((i for i in range(index, len(flat)) if flat[i] in MARKS | {",", "and", "but"}), len(flat))
        undone = flat[index : index + 2] == ("without", "being") and end == index + 3
        at = index + 1 + (flat[index + 1] == "all")
        others = flat[index] == "leave" and flat[at : at + 1] == ("the",) and "to" in flat[at + 2 : end]
        others = others and flat[at + 1].endswith("ing") and flat[index - 1] in MARKS | {",", "and", "but"}
        if undone or others:
            start = index - others
            start -= others and flat[start - 1] == ","
            return (*words[:start], *words[end:])
    return words


def _compares(flat: tuple[str, ...]) -> bool:
    """Whether "than" follows a measure ("closer to A than B") and no wish ("rather A than B")."""
    if _PREFERRING & set(flat):
        return False
    return any(key in _MEASURING or key.endswith("er") for key in flat)


_PREFERRING = frozenset({"rather", "sooner", "better", "prefer", "preferably"})
_MEASURING = frozenset({"more", "less", "fewer", "other", "else", "worse", "different", "no", "is", "are"})
_BACK = frozenset({"there", "it", "them"})
_TRANSITIVE = frozenset({"enter", "visit", "approach", "reach", "tour", "patrol", "pass"})


def _wanted(words: Phrase, verb: Phrase, is_stop: IsStop, *, alone: bool) -> Phrase:
    """The wanted part as an order of its own, with the verb of the denied one if it has none.

    A mere name is somewhere to go if nothing else in the message is an order (`alone`).
    """
    rest = words
    while (found := _RATHER.match(keys(rest))) is not None and found[0] < len(rest):
        rest = rest[found[0] :]
    done = _wished_done(rest, is_stop)
    if done:
        return done
    if keys(rest[:2]) == ("it", "is") or _says(rest, is_stop):
        rest = rest[2:]
    while keys(rest[-2:]) != ("will", "do") and keys(rest[-1:]) in {
        ("instead",),
        ("rather",),
        ("yes",),
        ("does",),
        ("do",),
        ("is",),
        ("are",),
    }:
        rest = rest[:-1]
    start = int(bool(rest) and rest[0].key in LINKS)
    end = stop_end(rest, start, is_stop)
    chosen_one = _the_one(rest[end:]) if end > start else None
    if chosen_one is not None:
        return (*(chosen_one or verb or words_of("go to")), *rest[start:end])
    if end == start or not _nothing_more(rest[end:]):
        return rest if opens_command(rest) else words
    if not verb and (start or not alone):
        return rest
    if not verb:
        return words if words != rest and opens_command(words) else (*words_of("go to"), *rest)
    if (size := ABOUT.match_end(keys(without_end(rest[end:])))) and end + size == len(without_end(rest)):
        rest = rest[:end]
    goes = lexicon().verbs.match(keys(verb))
    moving = goes is not None and goes[1].partition(":")[0] in _GOING
    if moving and len(verb) == 1 and verb[0].key in _TRANSITIVE:
        return (*words_of("go to"), *rest[start:])
    link = () if start or not moving or verb[-1].key in LINKS else words_of("to")
    return (*verb, *link, *rest[start if verb[-1].key in LINKS else 0 :])


def _the_one(words: Phrase) -> Phrase | None:
    """What is to be done with "(A) is the one to inspect"; None if nothing of the kind is said."""
    flat = keys(words)
    if flat[:3] not in {
        ("is", "the", "one"),
        ("is", "the", "right"),
        ("is", "what", "i"),
        ("is", "where", "i"),
    }:
        return None
    rest = words[4:] if flat[3:4] == ("to",) else ()
    return rest if rest and opens_command(rest) else ()


def _wished_done(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "I want the desks checked": check the desks; empty if it is no such wish."""
    if keys(words[:1]) not in {("i",), ("we",)} or len(words) < 4 or words[1].key not in {"want", "need"}:
        return ()
    end, verb = stop_end(words, 2, is_stop), lemma(words[-1].key)
    if end != len(words) - 1 or end == 2 or verb == words[-1].key:
        return ()
    return (*words_of(verb), *words[2:end])


def _says(words: Phrase, is_stop: IsStop) -> bool:
    """For "I meant the desk": a thing and nothing else."""
    said = keys(words[:1]) in {("i",), ("we",)} and len(words) > 2 and words[1].key in _SAID
    end = stop_end(words, 2, is_stop) if said else 2
    return end > 2 and _nothing_more(words[end:])


def _nothing_more(words: Phrase) -> bool:
    rest = keys(without_end(words))
    return not rest or ABOUT.match_end(rest) == len(rest) or rest[0] in {"and", "then"}
