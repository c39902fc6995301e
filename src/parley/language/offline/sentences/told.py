"""Long messages: where an order stands in the telling, and when it comes first though it is said last.

"When all that is done" is "then", "before all that, V" is V before everything, ", the dog is asleep there"
is a sentence of its own, "same thing there" says nothing that the order before did not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.units import Unit
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.order import due
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["in_order", "told_apart", "when_done"]

IsStop = Callable[[Phrase], bool]

_STOP, _COMMA = Word(".", "."), Word(",", ",")
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_WHEN = (
    ("when",),
    ("once",),
    ("after",),
    ("as", "soon", "as"),
    ("and", "when"),
    ("and", "once"),
    ("if", "you"),
)
_DOING = frozenset({
    "you", "all", "that", "it", "this", "everything", "those", "these", "is", "are", "have", "has",
    "been", "of", "with", "there", "done", "finished", "through", "ready", "over", "completed",
    "complete", "done.", "had", "both", "them", "got", "two", "three", "four",
})  # fmt: skip
_DONE = frozenset({"done", "finished", "through", "over", "completed", "complete"})
_SEEN = frozenset({"seen", "visited", "checked", "inspected"})
_LISTED = frozenset({"both", "them", "all", "everything", "those", "these", "two", "three"})
_AT_FIRST = due("early")
_SAME = frozenset(
    tuple(text.split())
    for text in (
        "same thing there", "same there", "same thing", "same again", "the same there", "likewise",
        "ditto", "same procedure", "the same", "same again there", "the same thing there",
        "the same again",
    )
)  # fmt: skip
_FINITE = lexicon().be | {"has", "have", "had", "needs", "likes", "says", "wants", "does", "will", "can"}
_LINKED = frozenset(
    {
        "if",
        "unless",
        "when",
        "whether",
        "once",
        "because",
        "that",
        "who",
        "which",
        "otherwise",
        "else",
        "check",
        "where",
    }
)


def in_order(words: Phrase, is_stop: IsStop) -> Phrase:
    """A long message with what is told apart from what is asked, and what comes first in front.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
    """
    words = when_done(_without_remarks(words))
    result: list[tuple[Phrase, Phrase]] = []
    front: list[tuple[Phrase, Phrase]] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS:
            continue
        sentence, early = _early(words[start:index])
        read = _going_on(_apart(sentence), is_stop)
        mark = words[index : index + 1] or ((_STOP,) if early else ())
        (front if early and result else result).append((read, mark))
        start = index + 1
    at = next((i for i, (sentence, _) in enumerate(result) if _orders(sentence)), len(result))
    result[at:at] = front
    return tuple(word for sentence, mark in _closed(result) for word in (*sentence, *mark))


def told_apart(words: Phrase, parts: Sequence[Unit]) -> Phrase:
    """The same message with what is told behind an order, or asked for behind a question, set apart.

    Why something is asked for goes, where it names nothing.

    Args:
        words: All words and punctuation.
        parts: The parts of the message.
    """
    result: list[Word] = []
    at = 0
    for before, part in pairwise(parts):
        start = part.start
        comma = keys(words[start - 1 : start]) == (",",) or keys(words[start : start + 1]) == (",",)
        if comma and before.kind == "asked" and _is_plain_order(part):
            # "Where is A, and can you look at it?"
            start += keys(words[start : start + 1]) == (",",)
            result += (*words[at : start - 1], _ASKED)
            at = start + (keys(words[start : start + 1]) == ("and",))
            continue
        if before.kind != "order" or not comma or part.kind not in {"told", "reason"}:
            continue
        start -= keys(words[start - 1 : start]) == (",",)
        flat = keys(part.words)
        if part.kind == "reason" and (part.names or flat[:1] not in _WHY):
            continue
        if part.kind == "told" and (len(flat) < _SHORTEST or flat[0] not in _TELLERS or _HANGING & set(flat)):
            continue
        result += (*words[at:start], *(() if part.kind == "reason" else (_STOP,)))
        at = part.end if part.kind == "reason" else start + 1
    return (*result, *words[at:]) if result else words


def _is_plain_order(part: Unit) -> bool:
    return part.kind == "order" and not {"if", "unless", "when", "otherwise", "then"} & set(keys(part.words))


_ASKED = Word("?", "?")
_WHY = frozenset({("since",), ("as",), ("because",)})
_SHORTEST = 4
_HANGING = frozenset({"if", "unless", "whether", "instead", "fine"})


def _closed(parts: list[tuple[Phrase, Phrase]]) -> list[tuple[Phrase, Phrase]]:
    """Every sentence but the last ends with a mark."""
    return [(s, m or ((_STOP,) if i < len(parts) - 1 and s else ())) for i, (s, m) in enumerate(parts)]


def _orders(sentence: Phrase) -> bool:
    return any(
        (i == 0 or not sentence[i - 1].is_word or sentence[i - 1].key in {"so", "and", "then"})
        and opens_command(sentence[i:])
        for i in range(len(sentence))
    )


def when_done(words: Phrase) -> Phrase:
    """For "when all that is done" "then"."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        marker = next((m for m in _WHEN if flat[index : index + len(m)] == m), ())
        end = index + len(marker)
        while marker and end < len(flat) and (flat[end] in _DOING | _SEEN or _others(flat, end)):
            end += 1
        seen = end > 1 and flat[end - 1] in _LISTED and flat[end - 2] in _SEEN
        if (
            marker
            and (seen or _DONE & set(flat[index:end]))
            and flat[end - 1] in _DOING - {"you", "is", "have", "with", "of"} | {"rest", "others", "lot"}
        ):
            result.append(Word("then", "then"))
            index = end + (flat[end : end + 1] == (",",))
            continue
        result.append(words[index])
        index += 1
    return tuple(result)


def _others(flat: tuple[str, ...], at: int) -> bool:
    """Whether "the rest" stands here."""
    return bool({"rest", "others", "lot"} & set(flat[at + (flat[at] == "the") : at + 2]))


_OPENING = frozenset({"right", "listen", "well", "ok", "okay", "so", "look", "alright"})
_TAILS = (
    ("that", "is", "it"),
    ("that", "is", "all"),
    ("that", "will", "be", "all"),
    ("that", "would", "be", "all"),
)
_TELLERS = frozenset(
    {"i", "we", "it", "he", "she", "they", "there", "nobody", "somebody", "everybody", "my", "our"}
)


def _without_remarks(words: Phrase) -> Phrase:
    """Without "listen" and "that is it"."""
    flat = keys(words)
    if len(flat) > 3 and flat[0] in _OPENING and flat[1] in _TELLERS | lexicon().determiners:
        words, flat = words[1:], flat[1:]
    tail = next((t for t in _TAILS if flat[-len(t) :] == t and len(flat) > 8), ())
    if tail:
        words, flat = words[: -len(tail)], flat[: -len(tail)]
    return words


def _early(sentence: Phrase) -> tuple[Phrase, bool]:
    """The sentence without "before all that", and whether it said so."""
    flat = keys(sentence)
    for index in range(len(flat)):
        marker = _AT_FIRST.match(flat, index)
        if marker is None:
            continue
        before, after = sentence[:index], sentence[index + marker[0] :]
        while after and after[0].key in {",", "please", "though"}:
            after = after[1:]
        while before and before[-1].key in {",", "please", "but", "and", "so"}:
            before = before[:-1]
        if not any(word.is_word for word in after):
            return before, True
        if not before or keys(before) in {("and",), ("but",), ("oh",), ("oh", ",", "and"), ("please",)}:
            return after, True
        return (*before, _COMMA, *after), False
    return sentence, False


def _apart(sentence: Phrase) -> Phrase:
    """A sentence of its own for what is told behind a comma; nothing for "same thing there"."""
    flat = keys(sentence)
    same = next((m for m in _SAME if flat[-len(m) :] == m and len(flat) > len(m) + 1), ())
    if same and not {"say", "speak", "announce", "repeat"} & set(flat[-len(same) - 2 : -len(same)]):
        sentence, flat = sentence[: -len(same)], flat[: -len(same)]
    if _LINKED & set(flat):
        return sentence
    result: list[Word] = []
    index = 0
    while index < len(sentence):
        if flat[index] == ",":
            end = next((i for i in range(index + 1, len(flat)) if flat[i] == ","), len(flat))
            part = flat[index + 1 : end]
            if part in _SAME:
                index = end
                continue
            told = _tells(sentence[index + 1 : end])
            result.append(_STOP if told and _asks(sentence[:index]) else sentence[index])
        else:
            result.append(sentence[index])
        index += 1
    return tuple(result)


def _asks(words: Phrase) -> bool:
    return opens_command(words) or keys(words[:1]) == ("not",) or opens_command(words[1:])


def _tells(part: Phrase) -> bool:
    """Whether a subject and its finite verb stand here ("the ducks are nesting", "somebody is ill")."""
    flat = keys(part)
    if len(flat) < 3 or opens_command(part):
        return False
    link = next((i for i in range(1, min(5, len(flat) - 1)) if flat[i] in _FINITE), 0)
    if not link or flat[0] in lexicon().question_starts | {"and", "or", "but", "then"}:
        return False
    simple = flat[0] in {
        "i",
        "we",
        "he",
        "she",
        "it",
        "they",
        "there",
        "nobody",
        "somebody",
        "someone",
        "everybody",
        "nothing",
    }
    return simple or (flat[0] in lexicon().determiners and link > 1)


def _going_on(sentence: Phrase, is_stop: IsStop) -> Phrase:
    """For "after the desk (please) to the door": going there."""
    flat = keys(sentence)
    result: list[Word] = []
    for index, word in enumerate(sentence):
        if (
            word.key == "to"
            and index > 1
            and flat[index - 1] not in {"back", "over", "up", "down", "on", "home"}
            and flat[0] in {"after", "afterwards", "finally", "then", "next"}
            and any(
                is_stop(sentence[index + 1 : end]) for end in range(index + 2, min(index + 6, len(flat)) + 1)
            )
            and not any(
                opens_command(sentence[i:]) and lemma(flat[i]) == flat[i]
                for i in range(max(0, index - 3), index)
            )
        ):
            result += (_COMMA, Word("go", "go"))
        result.append(word)
    return tuple(result)
