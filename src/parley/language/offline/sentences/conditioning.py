"""Conditions in other shapes, put as "if S, V": "Locked? Then V", "V provided S", "once A has left, V"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.echoes import OPPOSITES, STATES, echo, leads, put_briefly
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["as_conditions", "awaited_first"]

Names = Callable[[Phrase], bool]

_LINKS = lexicon().be | {"has", "have"}
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_HAPPENS = frozenset(
    {
        "left",
        "leave",
        "gone",
        "go",
        "finished",
        "finish",
        "done",
        "out",
        "away",
        "arrived",
        "arrive",
        "come",
        "back",
        "ready",
        "wake",
        "awake",
        "asleep",
        "sleep",
        "called",
        "call",
        "over",
        "returned",
        "return",
    }
)
_WHEN = (
    ("as", "soon", "as"),
    ("when",),
    ("once",),
    ("after",),
    ("whenever",),
    ("only", "after"),
    ("only", "once"),
)
_ALLOWED = (
    ("you", "may"),
    ("you", "can"),
    ("you", "could"),
    ("may", "you"),
    ("then", "you", "can"),
    ("you", "are", "allowed", "to"),
    ("then", "you", "may"),
    ("you", "should"),
    ("you", "are", "free", "to"),
    ("then",),
    (",",),
)


def as_conditions(words: Phrase, is_stop: Names, is_person: Names) -> Phrase:
    """The same message with its conditions in the usual shape.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
        is_person: Whether words name a person.
    """
    words = _opposite(_with(_with_if(put_briefly(words, opens_command)), is_stop), is_stop)
    parts = _asked(_sentences(words), is_stop)
    result: list[Word] = []
    for sentence, mark in parts:
        result += _after_event(_must(sentence, is_stop), is_stop, is_person)
        result += (mark,) if mark is not None else ()
    return tuple(result)


def _word(text: str) -> Word:
    return Word(text, text)


def _words(text: str) -> Phrase:
    return tuple(_word(part) for part in text.split())


def _sentences(words: Phrase) -> list[tuple[Phrase, Word | None]]:
    result: list[tuple[Phrase, Word | None]] = []
    start = 0
    for index, word in enumerate(words):
        if word.key in _MARKS:
            result.append((words[start:index], word))
            start = index + 1
    return [*result, (words[start:], None)] if start < len(words) else result


def _with_if(words: Phrase) -> Phrase:
    """For "provided that S" "if S", for "but not if S" "unless S", wherever it stands."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        found = leads().match(flat, index)
        end = index + (found[0] if found is not None else 1)
        if found is not None and _leads_in(flat, index, end):
            if found[1] == "unless" and keys(result[-1:]) == (",",):
                result.pop()
            result += _words(found[1])
        else:
            result += words[index:end]
        index = end
    flat = keys(result)
    if flat[:1] == ("only",) and flat[1:2] != ("if",) and "if" in flat and opens_command(tuple(result[1:])):
        return tuple(result[1:])
    return tuple(result)


def _leads_in(flat: tuple[str, ...], index: int, end: int) -> bool:
    """Whether what may lead a condition in does so, and is not one of the plain words for it."""
    said, clause = flat[index:end], flat[end : end + 8]
    if said in _PLAIN or not clause:
        return False
    if said[:2] == ("in", "case"):
        begins = index == 0 or flat[index - 1] in _BEFORE_CASE or not flat[index - 1][0].isalnum()
        return begins or clause[0] in {"it", "that", "there", "not", "yes"}
    return flat[end - 1] in {"if", "when", "case"} or (
        clause[0] not in {"by", "with", "you", "for"} and _has_verb(clause)
    )


_PLAIN = frozenset({("if",), ("only", "if"), ("unless",), ("should",)})
_BEFORE_CASE = frozenset({"and", "but", "or", "only"})


def _with(words: Phrase, is_stop: Names) -> Phrase:
    """For "with the door shut, V" "if the door is shut, V"; for "the door, if it is shut, V" the same."""
    flat = keys(words)
    comma = flat.index(",") if "," in flat else 0
    if flat[:1] == ("with",) and comma > 2 and flat[comma - 1] in STATES and is_stop(words[1 : comma - 1]):
        return (*_words("if"), *words[1 : comma - 1], *_words("is"), *words[comma - 1 :])
    if (
        comma
        and flat[comma + 1 : comma + 4] in {("if", "it", "is"), ("unless", "it", "is")}
        and is_stop(words[:comma])
    ):
        return (words[comma + 1], *words[:comma], *words[comma + 3 :])
    return words


def _opposite(words: Phrase, is_stop: Names) -> Phrase:
    """For "if it is open V, if it is shut W": W otherwise."""
    flat = keys(words)
    first = next((i for i in range(len(flat) - 1) if flat[i] in _LINKS and flat[i + 1] in STATES), 0)
    if not first or "if" not in flat[:first]:
        return words
    for at in range(first + 2, len(flat) - 4):
        echoed = flat[at] in {"if", "with", "when"} and flat[at + 1] in {"it", "that", "they"}
        state = at + 2 + (flat[at] != "with")
        if echoed and state < len(flat) and (flat[first + 1], flat[state]) in OPPOSITES:
            rest = words[state + 1 :]
            rest = rest[1:] if keys(rest[:1]) == (",",) else rest
            return (*words[:at], *_with_verb((*_words("otherwise"), *rest), is_stop))
    return words


def _has_verb(flat: tuple[str, ...]) -> bool:
    return any(word in lexicon().be | {"has", "have"} or word.endswith("s") for word in flat[1:])


def _asked(parts: list[tuple[Phrase, Word | None]], is_stop: Names) -> list[tuple[Phrase, Word | None]]:
    """For "Locked? Then V", "Door open? V. If not W": conditions of the orders that follow."""
    result: list[tuple[Phrase, Word | None]] = []
    index, last = 0, ""
    while index < len(parts):
        sentence, mark = parts[index]
        asked = _state_asked(sentence, is_stop) if mark is not None and mark.key == "?" else None
        if asked is None or index + 1 >= len(parts):
            result.append((_with_verb(sentence, is_stop) if last else sentence, mark))
            last = last if keys(sentence[:1]) == ("otherwise",) else ""
            index += 1
            continue
        (thing, state), (then, end) = asked, parts[index + 1]
        then = _ordering(then, is_stop)
        other = not thing and (last, state) in OPPOSITES
        if then and thing and _looks_at(then, thing):
            # "Is the door open? Go and check it": no condition, but what is to be looked at.
            then = ()
        if not then:
            result.append((sentence, mark))
        elif other:
            result.append(((*_words("otherwise"), *then), end))
        else:
            result.append(((*_words("if"), *(thing or _words("it")), *_words(f"is {state} ,"), *then), end))
        last = "" if other else state
        index += 2 if then else 1
    return _joined(result)


def _looks_at(order: Phrase, thing: Phrase) -> bool:
    """Whether an order is to look at the very thing that was asked about."""
    flat = keys(order)
    looks = {"check", "look", "see", "inspect", "verify"} & set(flat[:4])
    rest = {word for word in flat if word not in lexicon().determiners}
    return bool(looks) and (
        bool({"it", "them", "that"} & rest) or set(keys(bare(thing))) <= rest or len(flat) < 4
    )


def _joined(parts: list[tuple[Phrase, Word | None]]) -> list[tuple[Phrase, Word | None]]:
    """What is to be done otherwise belongs to the sentence before."""
    result: list[tuple[Phrase, Word | None]] = []
    for sentence, mark in parts:
        if result and keys(sentence[:1]) == ("otherwise",) and keys(result[-1][0][:1]) == ("if",):
            before = result.pop()[0]
            result.append(((*before, *_words(","), *sentence), mark))
        else:
            result.append((sentence, mark))
    return result


def _state_asked(sentence: Phrase, is_stop: Names) -> tuple[Phrase, str] | None:
    """The thing, if it is named, and the state of a question without a verb."""
    body = tuple(word for word in sentence if word.is_word)
    flat = keys(body)
    while flat[:1] in {("is",), ("it",), ("still",), ("and",)} and len(flat) > 1:
        body, flat = body[1:], flat[1:]
    if not flat or len(flat) > 6 or (flat[-1] not in STATES and not flat[-1].endswith("ed")):
        return None
    if len(flat) == 1:
        return (), flat[0]
    return (body[:-1], flat[-1]) if is_stop(body[:-1]) else None


def _ordering(sentence: Phrase, is_stop: Names) -> Phrase:
    """The order after "then"; empty if there is none. Places need no verb."""
    words = sentence
    while words and (not words[0].is_word or words[0].key in {"then", "so"}):
        words = words[1:]
    again = echo(words, 0, lambda order: opens_command(order) or is_stop(order), answers=True)
    words = words[again.size if again is not None and again.holds else 0 :]
    pieces: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index == len(words) or words[index].key == ",":
            pieces += (*_with_verb(words[start:index], is_stop), *words[index : index + 1])
            start = index + 1
    ordered = tuple(pieces)
    while ordered and ordered[0].key == ",":
        ordered = ordered[1:]
    return ordered if opens_command(ordered) else ()


def _with_verb(piece: Phrase, is_stop: Names) -> Phrase:
    """For "otherwise the desk", "the desk": going there."""
    again = echo(piece, 0, lambda order: opens_command(order) or is_stop(order), answers=True)
    no = again is not None and not again.holds and again.size < len(piece)
    rest = piece[again.size if again is not None and no else 0 :]
    while rest and rest[0].key == ",":
        rest = rest[1:]
    lead = _words("otherwise") if no else ()
    if keys(rest[:1]) == ("to",) and is_stop(rest[1:]):
        return (*lead, *_words("go"), *rest)
    named = rest[:-1] if keys(rest[-1:]) in {("then",), ("instead",)} else rest
    if is_stop(named):
        return (*lead, *_words("go to"), *named)
    return (*lead, *rest) if no else piece


def _must(sentence: Phrase, is_stop: Names) -> Phrase:
    """For "the door must be shut, else V"."""
    flat = keys(sentence)
    at = next((i for i in range(1, len(flat) - 3) if flat[i] in {"must", "should", "has"}), 0)
    be = at + 1 + (flat[at + 1 : at + 2] == ("to",))
    other = next((i for i in range(be + 2, len(flat) - 1) if flat[i] in {"else", "otherwise"}), 0)
    if not at or not other or flat[be : be + 1] != ("be",) or not is_stop(sentence[:at]):
        return sentence
    state = sentence[be + 1 : other]
    while state and (not state[-1].is_word or state[-1].key == "or"):
        state = state[:-1]
    then = _with_verb(sentence[other + 1 :], is_stop)
    return (*_words("unless"), *sentence[:at], *_words("is"), *state, *_words(","), *then)


def _after_event(sentence: Phrase, is_stop: Names, is_person: Names) -> Phrase:
    """For "once A has left you may V", "you may V when A has left": waiting, then V."""
    flat = keys(sentence)
    for index in range(len(flat) - 2):
        marker = next((m for m in _WHEN if flat[index : index + len(m)] == m), ())
        start = index + len(marker)
        end = (_event_end(sentence, start, is_person) or _has_happened(sentence, start)) if marker else 0
        if not end:
            continue
        lead, rest = sentence[:index], sentence[end:]
        if "ask" in flat[:index] and "to" not in flat[:index]:
            # "Ask A when B leaves": that is the question.
            continue
        order = _allowed(rest if index == 0 else lead)
        if (index == 0 or not any(w.is_word for w in rest)) and _is_order(order):
            return (*_words("wait until"), *sentence[start:end], _word("."), *order)
        return sentence
    return sentence


def _is_order(words: Phrase) -> bool:
    """Whether words begin with an order; a verb of the robot's own may be unknown here."""
    closed = lexicon().question_starts | lexicon().determiners | lexicon().be | lexicon().auxiliaries
    return opens_command(words) or (
        len(words) > 1
        and words[0].key not in closed | _OWN_SUBJECTS | {"he", "she", "they"}
        and words[1].key in lexicon().determiners
    )


def _has_happened(words: Phrase, start: int) -> int:
    """Where "the bell has rung ," ends that begins at `start`; 0 if nothing of the kind does."""
    flat = keys(words)
    if start >= len(flat) or flat[start] in _OWN_SUBJECTS:
        return 0
    end = next((i for i in range(start + 2, len(flat)) if not words[i].is_word), len(flat))
    at = next((i for i in range(start + 1, end) if flat[i] in {"has", "have", "is", "are"}), 0)
    rest = tuple(key for key in flat[at + 1 : end] if key not in _ALREADY)
    if not at or not rest or "not" in rest:
        return 0
    if flat[at] in {"is", "are"}:
        return end if rest in _BEING_BACK else 0
    done = rest[0].endswith("ed") or lemma(rest[0]) != rest[0] or rest[0] in _HAPPENS
    return end if done else 0


_OWN_SUBJECTS = frozenset({"you", "i", "we", "it", "that", "this", "there", "all", "everything"})
_ALREADY = frozenset({"already", "just", "finally", "all", "safely"})
_BEING_BACK = frozenset({("back",), ("gone",), ("over",), ("here",), ("through",), ("past",)})


def awaited_first(words: Phrase) -> Phrase:
    """S in "wait until S. V"; empty if nothing is waited for, or nothing hangs on it.

    Args:
        words: All words and punctuation, as `as_conditions` puts them.
    """
    if keys(words[:2]) != ("wait", "until"):
        return ()
    end = next((i for i in range(2, len(words)) if words[i].key == "."), len(words))
    return words[2:end] if end < len(words) - 1 else ()


def _allowed(words: Phrase) -> Phrase:
    while True:
        lead = next((m for m in _ALLOWED if keys(words[: len(m)]) == m), ())
        if not lead:
            break
        words = words[len(lead) :]
    while words and not words[-1].is_word:
        words = words[:-1]
    return words[:-1] if keys(words[-1:]) == ("only",) else words


def _event_end(words: Phrase, start: int, is_person: Names) -> int:
    """Where "A has left" ends that begins at `start`; 0 if nothing of the kind does."""
    flat = keys(words)
    for size in range(1, min(4, len(flat) - start)):
        if not is_person(words[start : start + size]) or flat[start] in {"you", "i", "we", "it"}:
            continue
        at = start + size
        while at < len(flat) and flat[at] in lexicon().be | {
            "has",
            "have",
            "already",
            "just",
            "finally",
            "all",
        }:
            at += 1
        if at < len(flat) and (flat[at] in _HAPPENS or lemma(flat[at]) in _HAPPENS):
            return at + 1
    return 0
