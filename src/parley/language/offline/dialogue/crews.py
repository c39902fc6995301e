"""Ways of giving orders to robots by name, put as "A and B, V": the one way that `addressing` reads.

"A should V", "send A to X", "A goes to X", "A: X", "both A and B to X", "X needs a visit, A will do it", and
names that are misspelt. What is said of robots that have nothing to do is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.base import Situation
from parley.language.offline.dialogue.crew_words import (
    DUTY,
    idles,
    is_verb,
    lead_size,
    only_greets,
    pronoun_named,
    sentences,
    spelled,
    turn_of,
    vocative_first,
    without_only,
    without_whoever,
)
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.sentences.itineraries import warns
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular, tokens
from parley.language.word_lists import load_data

__all__ = ["plainly_called"]

_DATA = load_data("crews")
_SENDING = PhraseTable.of(_DATA["sending"])
_CALLING = PhraseTable.of(_DATA["calling"])
_DOING_IT = PhraseTable.of(_DATA["doing_it"])
_IDLING = PhraseTable.of(_DATA["idling"])
_BOUNDS = frozenset({"and", "while", "but", "whereas", "meanwhile", "then", ",", ":", "so"})
_ALL_ELSE = frozenset(
    {("the", "others"), ("the", "rest"), ("everyone", "else"), ("everybody", "else"), ("all", "others")}
)
_TAKING = PhraseTable.of(_DATA["taking"])
_TOGETHER = PhraseTable.of(_DATA["together"])
_FILLERS = PhraseTable.of(_DATA["fillers"])
_NEEDED = PhraseTable.of(load_data("needs")["wanted"])
_TOWARDS = frozenset({"to", "at", "in", "into", "for", "towards", "over"})


@dataclass(frozen=True)
class _Call:
    """Where robots are named and what they are to do begins."""

    start: int
    end: int
    names: tuple[str, ...]


def plainly_called(words: Phrase, situation: Situation) -> Phrase:
    """The message with each order behind the names it is for.

    Args:
        words: All words and punctuation.
        situation: Its robots, and the map for orders without a verb.
    """
    robots = situation.robots
    if situation.robot in robots:
        # The one that is spoken to comes first.
        robots = (situation.robot, *(name for name in robots if name != situation.robot))
    situation = replace(situation, robots=robots)
    words = pronoun_named(without_whoever(spelled(words, situation)), situation)
    if not robots:
        return words
    result: list[Word] = []
    for sentence, mark in sentences(words):
        said = _sentence(sentence, situation)
        if said is not None and not said:
            continue
        result += (*(sentence if said is None else said), *mark)
    return tuple(result) if any(word.is_word for word in result) else words


def _sentence(words: Phrase, situation: Situation) -> Phrase | None:
    """One sentence in plain calls, empty if it leaves nothing to do; None if it is as it should be."""
    words, changed = _without_refused(words, situation)
    words = turn_of(words, situation.robots)
    words = vocative_first(_you_named(words, situation), situation.robots)
    if only_greets(words, situation.robots):
        return ()
    calls = [call for call in _calls(words, situation) if call.start == 0 or _bounded(words, call.start)]
    handed = _handed_over(words, calls)
    if handed is not None:
        return handed
    parts: list[Phrase] = []
    for number, call in enumerate(calls):
        following = calls[number + 1] if number + 1 < len(calls) else None
        if (
            following is not None
            and _sender(words, following.start) > following.start
            and not _trimmed(words[call.end : following.start])
        ):
            # "A, tell B to V": A is only called to pass it on.
            continue
        end = calls[number + 1].start if number + 1 < len(calls) else len(words)
        order = _order(_trimmed(_without_exception(words[call.end : end], situation.robots)), situation)
        if order is None:
            return words if changed else None
        if order:
            parts.append((*_named(call.names), *tokens(","), *order))
    if not calls:
        return words if changed else None
    lead = _trimmed(words[: calls[0].start])
    if lead and lead_size(keys(lead)) < len(lead):
        told = len(parts) == 1 and not is_verb(lead[0].key) and lead[0].key == lemma(lead[0].key)
        if not told or keys(words[calls[0].start - 1 : calls[0].start]) != (",",):
            return words if changed else None
        # "We are at the desk, A, come here".
        size = len(_named(calls[0].names)) + 1
        return (*parts[0][:size], *lead, *tokens("."), *parts[0][size:])
    if not parts:
        return ()
    result = parts[0]
    for part in parts[1:]:
        result = (*result, *tokens("."), *part)
    return result


def _you_named(words: Phrase, situation: Situation) -> Phrase:
    """For "you go to A and the others go to B": by name."""
    flat = keys(words)
    others = any(flat[i : i + len(m)] == m for i in range(3, len(flat)) for m in _THE_OTHERS)
    if (
        flat[:1] != ("you",)
        or not others
        or len(flat) < 6
        or not is_verb(flat[1])
        or len(situation.robots) < 2
    ):
        return words
    at = next(i for i in range(3, len(flat)) for m in _THE_OTHERS if flat[i : i + len(m)] == m)
    names, end = _others_at(words, at, situation.robots)
    if not names:
        return words
    return (*tokens(situation.robots[0]), *words[1:at], *_named(names), *words[end:])


def _bounded(words: Phrase, start: int) -> bool:
    return words[start - 1].key in _BOUNDS or _CALLING.match_end(keys(words[:start])) > 0 or start == 0


def _without_refused(words: Phrase, situation: Situation) -> tuple[Phrase, bool]:
    """Without "not you, A:", "only" and "leave it to A" in front."""
    alone = without_only(words)
    if alone != words and _names_at(alone, 0, situation.robots)[0]:
        return alone, True
    flat = keys(words)
    if flat[:2] == ("not", "you"):
        end = next((i for i in range(2, min(6, len(flat))) if flat[i] in {":", ","} and i > 2), 0)
        if flat[2:3] == (",",) and end == 0:
            end = 2
        if flat[2:3] in {(",",), (":",)} and not _names_at(words, 3, situation.robots)[0]:
            end = 2
        named, last = _names_at(words, 2 + (flat[2:3] == (",",)), situation.robots)
        if named and last >= len(words):
            # "Not you, A. B, V".
            return (), True
        return (words[end + 1 :], True) if end else (words, False)
    if flat[:2] in _ALL_ELSE and "," in flat:
        comma = flat.index(",")
        order = _order(words[2 + (flat[2:4] == ("of", "you")) * 2 : comma], situation)
        return (_trimmed(words[comma:]), True) if order == () else (words, False)
    if flat[:2] == ("leave", "it") or flat[:2] == ("leave", "that"):
        names, end = _names_at(words, 3, situation.robots)
        return ((), True) if names and end >= len(words) else (words, False)
    return words, False


def _calls(words: Phrase, situation: Situation) -> list[_Call]:
    """Where robots are named, one after the other, and an order may follow."""
    result: list[_Call] = []
    index = 0
    flat = keys(words)
    while index < len(words):
        if index and words[index - 1].key not in _BOUNDS and not _leads(flat, index):
            index += 1
            continue
        start = _sender(words, index)
        names, end = _names_at(words, start, situation.robots)
        spoken_to = bool(result) and words[index - 1].key == "," and flat[index] == "you" and not names
        if spoken_to and _order(words[index + 1 :], situation) and situation.robot not in result[-1].names:
            # "A does X, you do Y".
            names, end = (situation.robots[0],), index + 1
        told = keys(words[end : end + 2]) in {("and", "i"), ("and", "me")} or (
            keys(words[end : end + 1]) in {("was",), ("has",), ("were",)}
            and keys(words[end + 1 : end + 2]) != ("to",)
        )
        if not names or told:
            index += 1
            continue
        names, words = _without_late(words, names, end, situation.robots)
        flat = keys(words)
        result.append(_Call(index, end, names))
        index = end
    return result


def _without_late(
    words: Phrase, names: tuple[str, ...], end: int, robots: Sequence[str]
) -> tuple[tuple[str, ...], Phrase]:
    """For "everyone to X, except A": without A."""
    flat = keys(words)
    if len(names) < len(robots):
        return names, words
    for index in range(end + 1, len(flat) - 1):
        size = next((len(m) for m in _EXCEPT if flat[index : index + len(m)] == m), 0)
        gone, _ = _names_at(words, index + size, robots) if size else ((), 0)
        if gone and len(gone) < len(names):
            return tuple(name for name in names if name not in gone), words
    return names, words


_EXCEPT = (
    ("except", "for"),
    ("except",),
    ("but", "not"),
    ("apart", "from"),
    ("other", "than"),
    ("just", "not"),
    ("not",),
)


def _leads(flat: tuple[str, ...], index: int) -> bool:
    """Whether all before `index` only calls for attention."""
    return lead_size(flat[:index]) >= index


def _sender(words: Phrase, at: int) -> int:
    flat = keys(words)
    found = _SENDING.match(flat, at)
    while found is not None:
        at += found[0]
        found = _SENDING.match(flat, at)
    return at + (flat[at : at + 1] == ("both",) and flat[at + 1 : at + 2] not in {("of",), ("robots",)})


def _names_at(words: Phrase, at: int, robots: Sequence[str]) -> tuple[tuple[str, ...], int]:
    """The robots that are named from a word on, and where their names end."""
    others = _others_at(words, at, robots)
    if others[0]:
        return others
    counted = keys(words[at : at + 3])
    number = lexicon().numbers.get(counted[1], 0) if len(counted) == 3 and counted[0] == "all" else 0
    if number == len(robots) > 1 and (counted[2] in _TOWARDS or is_verb(counted[2])):
        return tuple(robots), at + 2
    pair = keys(words[at : at + 2]) in {("you", "two"), ("you", "three"), ("you", "both")}
    if pair:
        more = at + 2 + (keys(words[at + 2 : at + 3]) == (",",))
        named, end = _names_at(words, more, robots)
        if named:
            return named, end
    everybody = lexicon().everybody.match(keys(words), at)
    if everybody is not None:
        end = at + everybody[0]
        excepted = keys(words[end : end + 1]) in {("but",), ("except",), ("apart",), ("other",)}
        return ((), at) if excepted else (tuple(robots), end)
    names: list[str] = []
    end = at
    while True:
        name = next((n for n in robots if keys(words[end : end + len(tokens(n))]) == keys(tokens(n))), "")
        if not name:
            break
        names.append(name)
        end += len(tokens(name))
        joint = end
        while keys(words[joint : joint + 1]) in {(",",), ("and",), ("plus",), ("&",)}:
            joint += 1
        if joint == end or not any(
            keys(words[joint : joint + len(tokens(n))]) == keys(tokens(n)) for n in robots
        ):
            break
        if keys(words[end : end + 1]) == (",",) and _lists_end(words, joint, robots):
            break
        end = joint
    return tuple(dict.fromkeys(names)), end


def _others_at(words: Phrase, at: int, robots: Sequence[str]) -> tuple[tuple[str, ...], int]:
    """For "(you go to A and) the others (go to B)": all but the first, who is spoken to."""
    flat = keys(words)
    size = next((len(m) for m in _THE_OTHERS if flat[at : at + len(m)] == m), 0)
    if not size or flat[:1] != ("you",) or at < 3 or len(robots) < 2:
        return (), at
    return tuple(robots[1:]), at + size


_THE_OTHERS = (
    ("the", "other", "robots"),
    ("the", "other", "two"),
    ("the", "other", "one"),
    ("the", "other"),
    ("the", "others"),
    ("the", "rest"),
    ("all", "the", "others"),
    ("everyone", "else"),
    ("everybody", "else"),
)


def _lists_end(words: Phrase, at: int, robots: Sequence[str]) -> bool:
    """Whether the name at a word begins a call of its own: "A, B goes to X" is none of A's."""
    name = next((n for n in robots if keys(words[at : at + len(tokens(n))]) == keys(tokens(n))), "")
    after = keys(words[at + len(tokens(name)) :])[:1]
    return bool(after) and after[0].endswith("s") and is_verb(lemma(after[0]))


def _handed_over(words: Phrase, calls: Sequence[_Call]) -> Phrase | None:
    """For "X needs a visit, A will do it": A, X needs a visit."""
    if not calls or calls[-1].start < 3:
        return None
    rest = _trimmed(words[calls[-1].end :])
    duty = DUTY.match(keys(rest))
    rest = rest[duty[0] :] if duty is not None else rest
    base = (lemma(rest[0].key), *keys(rest[1:])) if rest else ()
    found = _DOING_IT.match(base)
    if found is None or found[0] < len(rest):
        return None
    before = _trimmed(words[: calls[-1].start])
    return (*_named(calls[-1].names), *tokens(","), *before) if before else None


def _order(rest: Phrase, situation: Situation) -> Phrase | None:
    """What robots that were named are to do; empty if nothing, None if it is no order."""
    flat = keys(rest)
    if not rest:
        return None
    if idles(flat):
        return ()
    rest = _as_told(rest)
    flat = keys(rest)
    if flat[0] in lexicon().be and any(_NEEDED.match(flat, i) for i in range(1, min(5, len(flat)))):
        # "A is wanted at the door".
        return (*tokens("you"), *rest)
    duty = DUTY.match(flat)
    towards = flat[0] in _TOWARDS and not (
        rest[1:] and is_verb(rest[1].key) and not _is_place(rest[1:], situation)
    )
    if towards:
        return (*tokens("go"), *rest) if flat[0] in {"to", "into", "over"} else (*tokens("go to"), *rest[1:])
    had_duty = duty is not None and duty[0] < len(rest)
    while duty is not None and duty[0] < len(rest):
        rest, flat = rest[duty[0] :], flat[duty[0] :]
        duty = DUTY.match(flat)
    base = lemma(flat[0])
    if _IDLING.match((base, *flat[1:])) == (len(flat), " ".join((base, *flat[1:]))) or idles(flat):
        return ()
    taken = _TAKING.match((base, *flat[1:])) or _TAKING.match((flat[0].removesuffix("s"), *flat[1:]))
    if taken is not None and _is_place(rest[taken[0] :], situation):
        return (*tokens("visit"), *rest[taken[0] :])
    if _is_place(rest, situation) and not warns(rest):
        return (*tokens("go to"), *rest)
    if base != flat[0] and flat[0].endswith("s") and is_verb(base) and not had_duty:
        return (Word(base, base), *rest[1:])
    return rest if had_duty or is_verb(flat[0]) or flat[0] in {"do", "please", "never", "not"} else None


def _as_told(rest: Phrase) -> Phrase:
    """Without "both", and without "that she" in what somebody is to be told ("that she should V")."""
    flat = keys(rest)
    filler = _FILLERS.match(flat)
    end = filler[0] if filler is not None else 0
    if end and flat[end : end + 1] in {(":",), (",",)} and end + 1 < len(rest):
        rest = rest[end + 1 :]
        flat = keys(rest)
    together = _TOGETHER.match(flat)
    if together is not None and together[0] < len(rest):
        rest, flat = rest[together[0] :], flat[together[0] :]
    if flat[:1] == ("that",) and len(flat) > 3:
        rest, flat = rest[1:], flat[1:]
    who = flat[:1] in {("he",), ("she",), ("it",), ("they",)}
    return rest[1:] if who and DUTY.match(flat, 1) is not None else rest


def _is_place(words: Phrase, situation: Situation) -> bool:
    body = tuple(word for word in words if word.is_word)
    if not body or len(body) > 7 or body[0].key in {"and", "then"}:
        return False
    one = ground_phrase(body, situation.objects, strict=True).outcome == "match"
    return one or _are_places(body, situation)


def _are_places(body: Phrase, situation: Situation) -> bool:
    """Whether words are nothing but names of several things ("lines 1 and 2")."""
    flat = keys(body)
    named = {part for item in situation.objects for part in keys(tokens(item.description))}
    joined = {"and", "to", "through", "the", "both", "all"}
    first = next((key for key in flat if key not in joined), "")
    return (
        bool({"and", "to", "through"} & set(flat))
        and singular(first) in named
        and all(key in joined or key in named or singular(key) in named for key in flat)
    )


def _trimmed(words: Phrase) -> Phrase:
    while words and (not words[0].is_word or words[0].key in {"and", "but"}):
        words = words[1:]
    while words and (not words[-1].is_word or words[-1].key in _BOUNDS | {"and"}):
        words = words[:-1]
    return words


def _without_exception(words: Phrase, robots: Sequence[str]) -> Phrase:
    """An order without ", except A" behind it."""
    flat = keys(words)
    for index in range(1, len(flat) - 1):
        size = next((len(m) for m in _EXCEPT if flat[index : index + len(m)] == m), 0)
        if size and _names_at(words, index + size, robots)[0]:
            return words[: index - (flat[index - 1] == ",")]
    return words


def _named(names: Sequence[str]) -> Phrase:
    return tuple(
        word for i, name in enumerate(names) for word in (*(tokens("and") if i else ()), *tokens(name))
    )
