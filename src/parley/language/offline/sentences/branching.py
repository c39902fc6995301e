"""Conditions put so that the rest can read them: what is denied, pointed at or answered with yes and no.

"Nobody is there" becomes "somebody is there" the other way round, "V A if it is shut" names A twice,
"A if S and B if not S" has one condition, "yes: V, no: W" follow a question.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.conditioning import OPPOSITES
from parley.language.offline.sentences.expecting import FINDING
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["branched"]

IsStop = Callable[[Phrase], bool]
Turn = Callable[[Phrase], Phrase]


def _table(*texts: str) -> tuple[tuple[str, ...], ...]:
    return tuple(sorted((tuple(text.split()) for text in texts), key=len, reverse=True))


_MARKS = frozenset({".", "!", "?", ";", "\n"})
_IFS = frozenset({"if", "unless"})
_POINTING = frozenset({"it", "there"})
_BEHIND = frozenset({"in", "on", "at", "inside", "under", "behind", "near", "by"})
_NOBODY = {"nobody": "somebody", "none": "some", "nothing": "something"}
_OPPOSITES = OPPOSITES | {("there", "gone"), ("gone", "there")}
_LINKS = lexicon().be | {"has", "does"}
_LONGEST_STOP = 6


def branched(words: Phrase, is_stop: IsStop, turn: Turn = lambda asked: ()) -> Phrase:
    """The message with conditions in plainer shape.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
        turn: What follows "whether" for a question; empty for other words.
    """
    if not (
        {"if", "unless", "depending", "yes", "case", "when", "provided", "should", "long", "?"}
        & set(keys(words))
    ):
        return words
    words = _found_or_not(_looked_first(words), is_stop)
    words = _answered(_state_alone(_depending(_as_if(words), is_stop)), is_stop, turn)
    result: list[Word] = []
    place: Phrase = ()
    about: Phrase = ()
    for sentence, mark in _sentences(words):
        sentence = _when_state(sentence, is_stop)
        if place and keys(sentence[:1]) in {("if",), ("unless",)}:
            end = next(
                (i for i, w in enumerate(sentence) if w.key in {",", "then", "try", "go", "come"}),
                len(sentence),
            )
            sentence = (sentence[0], *_with_name(sentence[1:end], place), *sentence[end:])
        place = _stop_in(sentence, is_stop)
        sentence, about = _of_the_same(sentence, about, is_stop)
        sentence = _both_ways(sentence, is_stop)
        sentence = _late_echo(sentence)
        sentence = _named(sentence, is_stop)
        sentence = _existing(sentence)
        result += (*_used(sentence, is_stop), *mark)
    return tuple(result)


def _of_the_same(sentence: Phrase, about: Phrase, is_stop: IsStop) -> tuple[Phrase, Phrase]:
    """For "if A is shut, V B, and if it is open, W": if A is open; and what further conditions are about.

    Args:
        sentence: One sentence.
        about: What the conditions of the sentence before were about.
        is_stop: Whether words name something on the map.
    """
    flat = keys(sentence)
    ifs = [
        i for i in range(len(flat) - 2) if flat[i] in _IFS and (not i or flat[i - 1] in {",", "and", "but"})
    ]
    if not ifs:
        return sentence, _stop_in(sentence, is_stop)
    result: list[Word] = []
    at, state = 0, ""
    for number, lead in enumerate(ifs):
        link = next((i for i in range(lead + 2, len(flat) - 1) if flat[i] in _LINKS), 0)
        named = sentence[lead + 1 : link] if link and is_stop(sentence[lead + 1 : link]) else ()
        told = flat[link + 1] if link else ","
        echoes = told in {",", "not", "then", "so"} or opens_command(sentence[link + 1 :])
        if named:
            about = named
        elif flat[lead + 1] == "it" and number and about and not echoes and (state, told) not in _OPPOSITES:
            result += (*sentence[at : lead + 1], *about)
            at = lead + 2
        state = told
    return (*result, *sentence[at:]), about


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
        opens = index == 0 or not words[index - 1].is_word or flat[index - 1] in {"and", "but", "or", "only"}
        pointed = after[:1] in {("it",), ("that",), ("there",), ("not",), ("yes",)}
        case = flat[index : index + 2] == ("in", "case") and after and (opens or pointed)
        result += _words("if") if case else (words[index],)
        index += 2 if case else 1
    return tuple(result)


def _found_or_not(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "if you find X at A, V; if not, W": if there is X at A. What is done otherwise makes it no rule."""
    flat = keys(words)
    start = next((i for i in range(len(flat) - 4) if flat[i : i + 2] == ("if", "you")), -1)
    if start < 0 or flat[start + 2] not in FINDING:
        return words
    comma = next((i for i in range(start + 4, len(flat)) if flat[i] == ","), len(flat))
    ends = (i for i in range(comma + 1, len(flat)) if _echo(flat, _joint(flat, i))[1] == "if not")
    end = next(ends, 0)
    named = any(is_stop(words[i:comma]) for i in range(start + 4, comma))
    if not (end and named and opens_command(words[comma + 1 :])):
        return words
    at = _joint(flat, end)
    rest = words[at + _echo(flat, at)[0] :]
    rest = rest[int(keys(rest[:1]) == (",",)) :]
    link = "are" if flat[start + 3].endswith("s") and not flat[start + 3].endswith("ss") else "is"
    there = (*words[: start + 1], *_words(f"there {link}"), *words[start + 3 : end])
    return (*there, *_words(". if not ,"), *rest)


def _looked_first(words: Phrase) -> Phrase:
    """For "V unless S, check that first": V unless S; that is looked at first in any case."""
    flat = keys(words)
    lead = next((i for i in range(len(flat)) if flat[i] in _IFS), len(flat))
    for at in range(lead + 2, len(flat) - 2):
        begin = at + (flat[at] in {"so", "and", "please", "but"})
        verb = next((len(m) for m in _LOOKING if flat[begin : begin + len(m)] == m), 0)
        end = begin + verb + 2
        pointed = flat[begin + verb : end - 1] and flat[begin + verb] in _POINTING | {"that", "this", "them"}
        if (
            verb
            and pointed
            and flat[end - 1 : end] in {("first",), ("beforehand",)}
            and not words[at - 1].is_word
        ):
            return (*words[: at - 1], *words[end:])
    return words


_LOOKING = _table(
    "check", "check on", "look at", "have a look at", "take a look at", "see", "inspect", "look into",
    "verify", "check for", "find out", "have a look", "look",
)  # fmt: skip


def _state_alone(words: Phrase) -> Phrase:
    """For "if open, V" behind something that was looked at: if it is open, V."""
    flat = keys(words)
    result: list[Word] = []
    for index, word in enumerate(words):
        result.append(word)
        denied = index + 1 + (flat[index + 1 : index + 2] in {("not",), ("still",)})
        bare = word.key in _IFS and set(flat[denied : denied + 1]) & _STATES - {"there", "light"}
        if bare and index and (flat[denied + 1 : denied + 2] == (",",) or opens_command(words[denied + 1 :])):
            result += _words("it is")
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


def _answered(words: Phrase, is_stop: IsStop, turn: Turn) -> Phrase:
    """For "is A open? If yes, V, if no, W", "is there X in A? Then V": check whether A is open. If so, V."""
    start = 0
    for sentence, mark in _sentences(words):
        end = start + len(sentence)
        rest = words[end + len(mark) :]
        if keys(mark) == ("?",) and _echo(keys(rest), 0)[0]:
            said, after = _branches(rest, is_stop)
            lead = 1 if keys(sentence[:1]) in {("and",), ("so",), ("ok",), ("but",), ("please",)} else 0
            topic, question = _topic_of(sentence[lead:], is_stop)
            asked = turn(question) if said else ()
            asked = (*topic, *asked[1:]) if topic and keys(asked[:1]) == ("it",) else asked
            if asked:
                look = (*_words("check whether"), *asked, *_words("."))
                return (*words[:start], *look, *said, *_answered(rest[after:], is_stop, turn))
        start = end + len(mark)
    return words


def _topic_of(asked: Phrase, is_stop: IsStop) -> tuple[Phrase, Phrase]:
    """For "the pump: is it wet" the pump, and the question."""
    mark = next((i for i, word in enumerate(asked) if not word.is_word), 0)
    named = bool(mark) and is_stop(asked[:mark]) and keys(asked[mark + 1 : mark + 3])[1:] == ("it",)
    return (asked[:mark], asked[mark + 1 :]) if named else ((), asked)


def _branches(words: Phrase, is_stop: IsStop) -> tuple[Phrase, int]:
    """What is to be done if so and if not, as sentences, and where that ends; nothing if one is no order."""
    flat = keys(words)
    result: list[Word] = []
    at = 0
    while (found := _echo(flat, at))[0]:
        size, meant = found
        at += size
        while flat[at : at + 1] and flat[at] in {",", ":", "-", "then", "please"}:
            at += 1
        ends = (i for i in range(at, len(flat)) if flat[i] in _MARKS or _echo(flat, _joint(flat, i))[0])
        end = next(ends, len(flat))
        order = words[at:end]
        while order and not order[-1].is_word:
            order = order[:-1]
        if keys(order[:1]) == ("to",) and is_stop(order[1:]):
            order = (*_words("go"), *order)
        elif is_stop(order):
            order = (*_words("go to"), *order)
        if not opens_command(order):
            return (), 0
        result += (*_words(f"{meant} ,"), *order, *_words("."))
        at = max(_joint(flat, end), end)
    return tuple(result), at


def _joint(flat: tuple[str, ...], at: int) -> int:
    """Where the words behind a mark and "and" begin; -1 if none stands there."""
    start = at
    while flat[at : at + 1] and flat[at] in _MARKS | {",", "and", "but", "or"}:
        at += 1
    return at if at > start else -1


def _echo(flat: tuple[str, ...], at: int) -> tuple[int, str]:
    """How many words say "if so" or "if not", and which of both; 0 if none do."""
    if at < 0:
        return 0, ""
    for meant, echoes in _ECHOES:
        size = next((len(e) for e in echoes if flat[at : at + len(e)] == e), 0)
        if size and flat[at + size : at + size + 1] != ():
            return size, meant
    return 0, ""


_NOT_SO = _table(
    "if not", "if no", "if it is not", "if it does not", "if they are not", "if there is not",
    "if there are not", "if there is none", "if there are none", "if he is not", "if she is not",
    "when not", "when it is not", "no", "else", "otherwise", "or else", "if it has not", "if none",
    "if that is not the case", "if you do not", "if you find none", "if you find nothing", "if you see none",
    "if you see nothing",
)  # fmt: skip
_SO = _table(
    "if so", "if yes", "if it is", "if it does", "if they are", "if there is", "if there are", "if he is",
    "if she is", "when so", "when it is", "when it does", "yes", "then", "if it has", "in that case",
    "if there is one", "if that is the case", "if that is so", "and if so",
)  # fmt: skip
_NOBODY_THERE = _table(
    "if nobody is there", "if no one is there", "if there is nobody there", "if there is nobody",
    "if there is no one there", "if there is no one", "if nobody is",
)  # fmt: skip
_SOMEBODY_THERE = _table(
    "if somebody is there", "if someone is there", "if anyone is there", "if anybody is there",
    "if there is somebody there", "if there is somebody", "if there is someone there", "if there is someone",
    "if somebody is", "if someone is", "if there is anyone", "if there is anybody",
)  # fmt: skip
_ECHOES = (
    ("if not", (*_NOBODY_THERE, *_NOT_SO)), ("if so", (*_SOMEBODY_THERE, *_SO)),
)  # fmt: skip


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
    echo = next((one for one in _LATE if flat[-len(one) :] == one), ())
    body = words[: len(words) - len(echo)]
    joints = [i for i in range(len(body) - 1, 1, -1) if body[i].key in {"and", ","} and body[i + 1 :]]
    cut = next((i for i in joints if opens_command(body[i + 1 :])), 0)
    if not cut and {"if", "whether"} & set(flat[1:4]):
        # Verbs that only the catalogue knows.
        cut = joints[0] if joints else 0
    if not (echo and cut):
        return words
    return (*body[:cut], *_words("."), *words[len(body) :], *_words(","), *body[cut + 1 :])


_LATE = tuple(
    sorted(
        (one for one in (*_SO, *_NOT_SO) if one[0] in {"if", "when"} and len(one) > 1), key=len, reverse=True
    )
)
"""Conditions that only repeat one, longest first."""


def _named(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to A unless somebody is on it": unless somebody is on A."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in _IFS), 0)
    if not at or at + 2 > len(flat) or flat[at - 1] in {"see", "check", "whether", "know", "and", ","}:
        return words
    named = _stop_in(words[:at], is_stop)
    end = next((i for i in range(at, len(flat)) if flat[i] in {",", "otherwise", "else"}), len(flat))
    cut = next((i for i in range(at - 1, 1, -1) if flat[i] == "and" and opens_command(words[i + 1 :])), 0)
    looked = _stop_in(words[:cut], is_stop) if cut and not named else ()
    link = next((i for i in range(at + 2, end) if flat[i] in _LINKS), 0)
    if looked and link and set(keys(bare(words[at + 1 : link]))) <= set(keys(looked)):
        # "Check the back door and go to A only if the door is shut".
        order = words[cut + 1 : at - (flat[at - 1] == "only")]
        condition = (*looked, *words[link:end])
        return (*words[:cut], *_words("."), words[at], *condition, *_words(","), *order, *words[end:])
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
