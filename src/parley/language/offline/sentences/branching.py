"""Conditions put so that the rest can read them: what is denied, pointed at or answered with yes and no.

"Nobody is there" becomes "somebody is there" the other way round, "V A if it is shut" names A twice,
"A if S and B if not S" has one condition, "yes: V, no: W" follow a question.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["branched"]

IsStop = Callable[[Phrase], bool]

_MARKS = frozenset({".", "!", "?", ";", "\n"})
_IFS = frozenset({"if", "unless"})
_POINTING = frozenset({"it", "there"})
_BEHIND = frozenset({"in", "on", "at", "inside", "under", "behind", "near", "by"})
_NOBODY = {"nobody": "somebody", "none": "some", "nothing": "something"}
_OPPOSITES = frozenset(
    pair
    for a, b in (
        ("open", "shut"),
        ("open", "closed"),
        ("on", "off"),
        ("free", "occupied"),
        ("empty", "full"),
        ("free", "busy"),
        ("empty", "occupied"),
        ("locked", "unlocked"),
        ("locked", "open"),
        ("clean", "dirty"),
        ("wet", "dry"),
        ("clear", "blocked"),
        ("free", "taken"),
        ("light", "dark"),
        ("hot", "cold"),
        ("there", "gone"),
        ("closed", "open"),
        ("free", "blocked"),
    )
    for pair in ((a, b), (b, a))
)
_LONGEST_STOP = 6


def branched(words: Phrase, is_stop: IsStop) -> Phrase:
    """The message with conditions in plainer shape.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
    """
    if not (
        {"if", "unless", "depending", "yes", "case", "when", "provided", "should", "long", "?"}
        & set(keys(words))
    ):
        return words
    words = _asked_then(_yes_and_no(_depending(_as_if(words), is_stop)))
    result: list[Word] = []
    place: Phrase = ()
    for sentence, mark in _sentences(words):
        sentence = _when_state(sentence, is_stop)
        if place and keys(sentence[:1]) in {("if",), ("unless",)}:
            end = next(
                (i for i, w in enumerate(sentence) if w.key in {",", "then", "try", "go", "come"}),
                len(sentence),
            )
            sentence = (sentence[0], *_with_name(sentence[1:end], place), *sentence[end:])
        place = _stop_in(sentence, is_stop)
        sentence = _both_ways(sentence, is_stop)
        sentence = _late_echo(sentence)
        sentence = _named(sentence, is_stop)
        sentence = _existing(sentence)
        result += (*_used(sentence, is_stop), *mark)
    return tuple(result)


def _sentences(words: Phrase) -> list[tuple[Phrase, Phrase]]:
    parts: list[tuple[Phrase, Phrase]] = []
    start = 0
    for index in range(len(words) + 1):
        if index == len(words) or words[index].key in _MARKS:
            if words[start:index] or words[index : index + 1]:
                parts.append((words[start:index], words[index : index + 1]))
            start = index + 1
    return parts


def _as_if(words: Phrase) -> Phrase:
    """For "in case it is not" "if it is not"."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        after = flat[index + 2 : index + 4]
        case = (
            flat[index : index + 2] == ("in", "case") and after and (index == 0 or flat[index - 1] != "just")
        )
        result += _words("if") if case else (words[index],)
        index += 2 if case else 1
    return tuple(result)


def _when_state(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "when A is shut V, when it is open W": if A is shut V, if it is open W."""
    result = list(words)
    flat = keys(words)
    for index in range(len(flat) - 3):
        if flat[index] != "when" or (index and flat[index - 1] not in {",", "and", "but"}):
            continue
        link = next((i for i in range(index + 2, min(index + 8, len(flat))) if flat[i] in lexicon().be), 0)
        state = flat[link + 1] if link and link + 1 < len(flat) else ""
        told = state in _STATES and (is_stop(words[index + 1 : link]) or flat[index + 1] in {"it", "they"})
        if told:
            result[index] = Word("if", "if")
    return tuple(result)


_STATES = frozenset(word for pair in _OPPOSITES for word in pair)


def _asked_then(words: Phrase) -> Phrase:
    """For "is there light in A? Then V, else W": if there is light in A, V, otherwise W."""
    flat = keys(words)
    asked = flat.index("?") if "?" in flat else 0
    there = flat[:2] in {("is", "there"), ("are", "there")}
    if not asked or not there or flat[asked + 1 : asked + 2] not in {("then",), ("if",)}:
        return words
    start = asked + 2
    if flat[asked + 1] == "if":
        if flat[asked + 2 : asked + 3] not in {("so",), ("yes",)}:
            return words
        start = asked + 3
    start += flat[start : start + 1] == (",",)
    return (*_words("if there"), words[0], *words[2:asked], *_words(","), *words[start:])


def _depending(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "depending on whether A is free, go there or to B": if A is free, go there, otherwise go to B."""
    flat = keys(words)
    start = next(
        (len(m) for m in (("depending", "on", "whether"), ("depending", "on", "if")) if flat[: len(m)] == m),
        0,
    )
    verbs = (
        i
        for i in range(start + 2, len(words))
        if flat[i - 1] not in lexicon().be and opens_command(words[i:])
    )
    verb = next(verbs, 0) if start else 0
    joint = next((i for i in range(verb + 1, len(flat)) if flat[i] == "or"), 0) if verb else 0
    if not joint:
        return words
    condition = words[start : verb - (flat[verb - 1] == ",")]
    second = words[joint + 1 :]
    second = (
        second if opens_command(second) else (*_words("go to"), *second[int(keys(second[:1]) == ("to",)) :])
    )
    return (*_words("if"), *condition, *_words(","), *words[verb:joint], *_words(", otherwise"), *second)


def _yes_and_no(words: Phrase) -> Phrase:
    """For "is it wet? yes: V, no: W": if so V, otherwise W."""
    flat = keys(words)
    asked = flat.index("?") if "?" in flat else len(flat)
    yes = next(
        (
            i
            for i in range(asked + 1, len(flat) - 1)
            if flat[i] == "yes" and flat[i + 1] in {",", ":", "then"}
        ),
        0,
    )
    no = next(
        (i for i in range(yes + 2, len(flat) - 1) if flat[i] == "no" and flat[i + 1] in {",", ":", "then"}), 0
    )
    if not yes or not no or not opens_command(words[yes + 2 :]):
        return words
    first = words[yes + 2 : no]
    while first and not first[-1].is_word:
        first = first[:-1]
    return (*words[:yes], *_words("if so ,"), *first, *_words(". if not ,"), *words[no + 2 :])


def _both_ways(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "V A if S and W B if not S": if S, V A, otherwise W B."""
    flat = keys(words)
    ifs = [i for i in range(len(flat)) if flat[i] == "if"]
    if len(ifs) != 2 or ifs[0] < 2 or not opens_command(words[: ifs[0]]):
        return words
    one, other = ifs
    joint = next((i for i in range(one + 2, other) if flat[i] in {"and", ",", "but"}), 0)
    second = words[joint + 1 : other] if joint else ()
    second = second[1:] if keys(second[:1]) in {("and",), ("but",)} else second
    told, opposite = set(flat[one:joint]), flat[other + 1 :]
    turned = "not" in opposite or any((a, b) in _OPPOSITES for a in told for b in opposite)
    if not second or not turned:
        return words
    if keys(second[:1]) == ("to",):
        second = (*_words("go"), *second)
    elif is_stop(second):
        second = (*_words("go to"), *second)
    first = words[:one]
    named = _stop_in(first, is_stop)
    condition = _with_name(words[one + 1 : joint], named) if named else words[one + 1 : joint]
    return (*_words("if"), *condition, *_words(","), *first, *_words(", otherwise"), *second)


def _late_echo(words: Phrase) -> Phrase:
    """For "see whether S and V if not": if not, V."""
    flat = keys(words)
    for echo in (
        ("if", "not"),
        ("if", "so"),
        ("if", "it", "is", "not"),
        ("if", "it", "is"),
        ("if", "yes"),
        ("if", "no"),
    ):
        if flat[-len(echo) :] != echo:
            continue
        body = words[: -len(echo)]
        cut = next(
            (
                i
                for i in range(len(body) - 1, 1, -1)
                if body[i].key in {"and", ","} and opens_command(body[i + 1 :])
            ),
            0,
        )
        if cut:
            return (*body[:cut], *_words("."), *words[-len(echo) :], *_words(","), *body[cut + 1 :])
    return words


def _named(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to A unless somebody is on it": unless somebody is on A."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in _IFS), 0)
    if not at or at + 2 > len(flat) or flat[at - 1] in {"see", "check", "whether", "know", "and", ","}:
        return words
    named = _stop_in(words[:at], is_stop)
    end = next((i for i in range(at, len(flat)) if flat[i] in {",", "otherwise", "else"}), len(flat))
    cut = next((i for i in range(at - 1, 1, -1) if flat[i] == "and" and opens_command(words[i + 1 :])), 0)
    pointing = any(
        flat[i] in _POINTING and flat[i - 1] in _BEHIND | {"is", "are"} for i in range(at + 1, end)
    )
    if named and cut and pointing and _stop_in(words[:cut], is_stop):
        # "Look into A and come back if somebody is there": the look comes first in any case.
        condition = _with_name(words[at + 1 : end], named)
        return (
            *words[:cut],
            *_words("."),
            words[at],
            *condition,
            *_words(","),
            *words[cut + 1 : at],
            *words[end:],
        )
    return (*words[: at + 1], *_with_name(words[at + 1 : end], named), *words[end:]) if named else words


def _with_name(condition: Phrase, named: Phrase) -> Phrase:
    """A condition with the name in place of "it" and "there" behind a preposition of place."""
    flat = keys(condition)
    result: list[Word] = []
    for index, word in enumerate(condition):
        behind = index and flat[index - 1] in _BEHIND
        if word.key in _POINTING and behind:
            result += named
        elif word.key == "there" and index == len(flat) - 1:
            result += (*_words("at"), *named)
        else:
            result.append(word)
    return tuple(result)


def _stop_in(words: Phrase, is_stop: IsStop) -> Phrase:
    """The only name in some words; empty if they have none or several."""
    found: list[Phrase] = []
    index = 0
    while index < len(words):
        sizes = range(min(_LONGEST_STOP, len(words) - index), 0, -1)
        size = next((s for s in sizes if is_stop(words[index : index + s])), 0)
        if size:
            found.append(words[index : index + size])
        index += size or 1
    return found[0] if len(found) == 1 else ()


def _existing(words: Phrase) -> Phrase:
    """For "if nobody is there" "unless somebody is there", for "if there is no X" "unless there is a X"."""
    flat = keys(words)
    lead = next((i for i in range(len(flat)) if flat[i] in _IFS | {"provided", "as", "assuming"}), -1)
    if lead < 0:
        return words
    start, holds = _condition_start(flat, lead)
    if not start:
        return words
    other = "unless" if holds else "if"
    here = flat[start : start + 4]
    if here[:1] and here[0] in _NOBODY and len(here) > 1 and here[1] != "of":
        return (*words[:lead], *_words(f"{other} {_NOBODY[here[0]]}"), *words[start + 1 :])
    if here[:2] == ("no", "one") and len(here) > 2:
        return (*words[:lead], *_words(f"{other} somebody"), *words[start + 2 :])
    if here[:1] == ("there",) and here[1:2] and here[1] in lexicon().be:
        denied = here[2:3]
        if denied in {("no",), ("not",)} and len(flat) > start + 3:
            after = start + 3 + (flat[start + 3 : start + 4] in {("any",), ("a",)})
            plural = here[1] == "are"
            return (
                *words[:lead],
                *_words(f"{other} there {here[1]}{'' if plural else ' a'}"),
                *words[after:],
            )
        if denied and denied[0] in _NOBODY and len(flat) > start + 3 and flat[start + 3] not in {",", "then"}:
            return (*words[:lead], *_words(f"{other} there is {_NOBODY[denied[0]]}"), *words[start + 3 :])
    if here[:1] == ("no",) and len(here) > 2 and lexicon().be & set(flat[start + 2 : start + 4]):
        return (*words[:lead], *_words(f"{other} a"), *words[start + 1 :])
    return words


def _condition_start(flat: tuple[str, ...], lead: int) -> tuple[int, bool]:
    """Where a condition begins behind what leads it, and whether it has to hold; 0 if none does."""
    for marker, holds in (
        (("if",), True), (("unless",), False), (("provided", "that"), True), (("provided",), True),
        (("as", "long", "as"), True), (("assuming", "that"), True), (("assuming",), True),
    ):  # fmt: skip
        if flat[lead : lead + len(marker)] == marker:
            return lead + len(marker), holds
    return 0, True


def _used(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "if A is shut use B", "if not try B": go to B."""
    flat = keys(words)
    for index in range(1, len(flat) - 1):
        if flat[index] not in {"use", "try"} or (
            not _IFS & set(flat[:index]) and flat[0] not in {"when", "otherwise"}
        ):
            continue
        end = next(
            (i for i in range(index + 1, len(flat)) if flat[i] in {",", "instead", "and", "then"}), len(flat)
        )
        if is_stop(words[index + 1 : end]):
            comma = () if flat[index - 1] in {",", "then"} else _words(",")
            return (*words[:index], *comma, *_words("go to"), *words[index + 1 :])
    return words


def _words(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
