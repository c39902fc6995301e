"""Conditions put so that the rest can read them: what is denied, pointed at or answered with yes and no.

"Nobody is there" becomes "somebody is there" the other way round, "V A if it is shut" names A twice,
"A if S and B if not S" has one condition, "yes: V, no: W" follow a question.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.echoes import OPPOSITES, STATES, Echo, echo
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
    words = _looked_first(words)
    words = _answered(_state_alone(_depending(words, is_stop)), is_stop, turn)
    result: list[Word] = []
    place: Phrase = ()
    about: Phrase = ()
    for sentence, mark in _sentences(words):
        sentence = _cut_off(_when_state(sentence, is_stop), is_stop)
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
        result += (*_used(sentence, is_stop, tuple(result)), *mark)
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
        elif flat[lead + 1] == "it" and number and about and not echoes and (state, told) not in OPPOSITES:
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
        bare = word.key in _IFS and set(flat[denied : denied + 1]) & STATES - {"light"}
        if bare and index and (flat[denied + 1 : denied + 2] == (",",) or opens_command(words[denied + 1 :])):
            result += _words("it is")
    return tuple(result)


def _cut_off(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "check A if it is full V (if not W)", said without any mark: check A. If it is full, V."""
    flat = keys(words)
    lead = next((i for i in range(2, len(flat) - 4) if flat[i] == "if"), 0)
    link = lead + 2
    if not lead or flat[0] not in _LOOKS or flat[lead + 1] not in {"it", "they"} or flat[link] not in _LINKS:
        return words
    state = link + 1 + (flat[link + 1] == "not")
    told = flat[state] in STATES or not opens_command(words[state:])
    ends = told and state + 1 < len(words) and opens_command(words[state + 1 :])
    return (*words[:lead], *_words("."), *words[lead:]) if ends and _stop_in(words[:lead], is_stop) else words


def _when_state(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "when A is shut V, when it is open W": if A is shut V, if it is open W."""
    result = list(words)
    flat = keys(words)
    for index in range(len(flat) - 3):
        if flat[index] != "when" or (index and flat[index - 1] not in {",", "and", "but"}):
            continue
        link = next((i for i in range(index + 2, min(index + 8, len(flat))) if flat[i] in lexicon().be), 0)
        state = flat[link + 1] if link and link + 1 < len(flat) else ""
        subject = words[index + 1 : link]
        told = state in STATES and (is_stop(subject) or flat[index + 1] in {"it", "they"})
        # "Check A and, when its lid is open, V": what is looked at tells.
        looked = _LOOKS & set(flat[:index]) and bool(_stop_in(words[:index], is_stop))
        of_it = state and not any(word.is_capital for word in subject) and flat[index + 1] in _PARTS_OF_IT
        if told or (looked and of_it) or (state in STATES and _is_at_stop(subject, is_stop)):
            result[index] = Word("if", "if")
    return tuple(result)


_LOOKS = frozenset({"check", "look", "inspect", "see", "examine"})
_PARTS_OF_IT = frozenset({"its", "their", "the", "there"})


def _is_at_stop(subject: Phrase, is_stop: IsStop) -> bool:
    """Whether something is said to be at a place that is known ("the light in A")."""
    flat = keys(subject)
    return any(flat[i] in _BEHIND and is_stop(subject[i + 1 :]) for i in range(1, len(subject) - 1))


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
        skipped = _aside(keys(rest))
        rest = rest[skipped:]
        rest = _said_again(sentence, rest) if keys(mark) == ("?",) else rest
        if keys(mark) == ("?",) and _echo(rest, 0, is_stop) is not None:
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


def _said_again(asked: Phrase, rest: Phrase) -> Phrase:
    """For "(is A shut?) If it is shut, V" "if so, V", for "if it is open" "if not"."""
    flat = keys(rest)
    if flat[:1] != ("if",) or flat[1:2] not in _IT or flat[2:3] not in {("is",), ("are",)} or not asked:
        return rest
    denied = flat[3:4] == ("not",)
    state, end = keys(asked)[-1], 4 + denied
    same = flat[3 + denied : end] == (state,)
    other = flat[3 + denied : end] != () and (state, flat[3 + denied]) in OPPOSITES
    if not (same or other):
        return rest
    return (*_words("if so" if same != denied else "if not"), *rest[end:])


_IT = frozenset({("it",), ("they",), ("that",), ("he",), ("she",)})


def _aside(flat: tuple[str, ...]) -> int:
    """How many words only lead on to what follows from an answer ("because (if it is)", "well, (if so)")."""
    size = next((i for i, key in enumerate(flat) if key not in _LEADING_ON), len(flat))
    return size if flat[size : size + 1] in {("if",), ("unless",), ("in",), ("yes",), ("no",)} else 0


_LEADING_ON = frozenset({"because", "cause", "since", "and", "so", "well", "now", "ok", "okay", ",", "but"})


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
    while (found := _echo(words, at, is_stop)) is not None:
        at += found.size
        while flat[at : at + 1] and flat[at] in {",", ":", "-", "then", "please"}:
            at += 1
        ends = (
            i
            for i in range(at, len(flat))
            if flat[i] in _MARKS or _echo(words, _joint(flat, i), is_stop) is not None
        )
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
        result += (*_words("if so ," if found.holds else "if not ,"), *order, *_words("."))
        at = max(_joint(flat, end), end)
    return tuple(result), at


def _joint(flat: tuple[str, ...], at: int) -> int:
    """Where the words behind a mark and "and" begin; -1 if none stands there."""
    start = at
    while flat[at : at + 1] and flat[at] in _MARKS | {",", "and", "but", "or"}:
        at += 1
    return at if at > start else -1


def _echo(words: Phrase, at: int, is_stop: IsStop) -> Echo | None:
    """What says "if so" or "if not" behind a question; None if nothing does, or nothing follows."""
    found = echo(words, at, lambda order: opens_command(order) or is_stop(order), answers=True)
    return found if found is not None and at + found.size < len(words) else None


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
    turned = "not" in opposite or any((a, b) in OPPOSITES for a in told for b in opposite)
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
    last = next((i for i in range(len(words) - 1, 1, -1) if words[i].key in {"if", "when", "unless"}), 0)
    again = echo(words, last, opens_command) if last else None
    if again is None or last + again.size != len(words) or again.kind != "state":
        return words
    body = words[:last]
    joints = [i for i in range(len(body) - 1, 1, -1) if body[i].key in {"and", ","} and body[i + 1 :]]
    cut = next((i for i in joints if opens_command(body[i + 1 :])), 0)
    if not cut and {"if", "whether"} & set(keys(words[1:4])):
        # Verbs that only the catalogue knows.
        cut = joints[0] if joints else 0
    if not cut:
        return words
    return (*body[:cut], *_words(". if so ," if again.holds else ". if not ,"), *body[cut + 1 :])


def _named(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to A unless somebody is on it": unless somebody is on A."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in _IFS), 0)
    if not at or at + 2 > len(flat) or flat[at - 1] in {"see", "check", "whether", "know", "and"}:
        return words
    behind = range(at + 2, len(words))
    if flat[at - 1] == "," and any(flat[i] == "," or opens_command(words[i:]) for i in behind):
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
    """A condition with the name in place of "it" and "there" ("it is on it", "the door there is open")."""
    flat = keys(condition)
    result: list[Word] = []
    for index, word in enumerate(condition):
        behind = index and flat[index - 1] in _BEHIND
        part = index and flat[index + 1 : index + 2] and flat[index + 1] in _LINKS
        if word.key in _POINTING and behind:
            result += named
        elif word.key == "there" and (index == len(flat) - 1 or part):
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
    lead = next((i for i in range(len(flat)) if flat[i] in _IFS), -1)
    if lead < 0:
        return words
    start = lead + 1
    other = "unless" if flat[lead] == "if" else "if"
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


def _used(words: Phrase, is_stop: IsStop, before: Phrase) -> Phrase:
    """For "if A is shut use B", "if not try B": go to B; what was sought before is sought there."""
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
            sought = flat[index] == "try" and _seeks((*before, *words[:index]))
            return (*words[:index], *comma, *_words("check" if sought else "go to"), *words[index + 1 :])
    return words


def _seeks(words: Phrase) -> bool:
    """Whether a thing is looked for, or whether it is at a place is asked; where people are, one goes."""
    flat = keys(words)
    for at in range(len(flat)):
        size = 2 if flat[at : at + 2] == ("look", "for") else int(flat[at] in {"search", "find", "locate"})
        if size:
            return not any(word.is_capital for word in words[at + size : at + size + 1])
    asked = next((i for i, key in enumerate(flat) if key in {"if", "whether"}), len(flat))
    links = (i for i in range(asked + 2, len(flat) - 1) if flat[i] in lexicon().be)
    placed = any(flat[i + 1] in _BEHIND or flat[i + 2 : i + 3] in {("in",), ("on",), ("at",)} for i in links)
    return placed and not words[asked + 1].is_capital


def _words(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
