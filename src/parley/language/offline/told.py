"""Long messages: where an order stands in the telling, and when it comes first though it is said last.

"When all that is done" is "then", "before all that, V" is V before everything, ", the dog is asleep there" is a
sentence of its own, "same thing there" says nothing that the order before did not.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.clauses import opens_command
from parley.language.offline.lexicon import lexicon
from parley.language.offline.text import Phrase, Word, keys, lemma

__all__ = ["in_order"]

IsStop = Callable[[Phrase], bool]

_STOP, _COMMA = Word(".", "."), Word(",", ",")
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_WHEN = (("when",), ("once",), ("after",), ("as", "soon", "as"), ("and", "when"), ("and", "once"))
_DOING = frozenset({"you", "all", "that", "it", "this", "everything", "those", "these", "is", "are", "have", "has", "been", "of",
                    "with", "there", "done", "finished", "through", "ready", "over", "completed", "complete", "done.", "had", "both",
                    "them", "got"})  # fmt: skip
_DONE = frozenset({"done", "finished", "through", "over", "completed", "complete"})
_AT_FIRST = tuple(
    tuple(text.split())
    for text in (
        "before all that", "before all of that", "before anything else", "before everything else", "before all this",
        "before any of that", "before all else", "before everything", "before doing any of that", "before all",
        "before you do any of that", "before you do all that", "but before all that", "but before anything else",
        "ahead of all that", "prior to all that", "first and foremost", "most urgently", "most important of all",
    )
)  # fmt: skip
_SAME = frozenset(
    tuple(text.split())
    for text in ("same thing there", "same there", "same thing", "same again", "the same there", "likewise", "ditto",
                 "same procedure", "the same", "same again there", "the same thing there", "the same again")
)  # fmt: skip
_FINITE = lexicon().be | {"has", "have", "had", "needs", "likes", "says", "wants", "does", "will", "can"}
_LINKED = frozenset({"if", "unless", "when", "whether", "once", "because", "that", "who", "which", "otherwise", "else", "check", "where"})


def in_order(words: Phrase, is_stop: IsStop) -> Phrase:
    """A long message with what is told apart from what is asked, and what comes first in front.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
    """
    words = _then(words)
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


def _closed(parts: list[tuple[Phrase, Phrase]]) -> list[tuple[Phrase, Phrase]]:
    """Every sentence but the last ends with a mark."""
    return [(s, m or ((_STOP,) if i < len(parts) - 1 and s else ())) for i, (s, m) in enumerate(parts)]


def _orders(sentence: Phrase) -> bool:
    return any(
        (i == 0 or not sentence[i - 1].is_word or sentence[i - 1].key in {"so", "and", "then"}) and opens_command(sentence[i:])
        for i in range(len(sentence))
    )


def _then(words: Phrase) -> Phrase:
    """For "when all that is done" "then"."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        marker = next((m for m in _WHEN if flat[index : index + len(m)] == m), ())
        end = index + len(marker)
        while marker and end < len(flat) and flat[end] in _DOING:
            end += 1
        if marker and _DONE & set(flat[index:end]) and flat[end - 1] in _DOING - {"you", "is", "have"}:
            result.append(Word("then", "then"))
            index = end + (flat[end : end + 1] == (",",))
            continue
        result.append(words[index])
        index += 1
    return tuple(result)


def _early(sentence: Phrase) -> tuple[Phrase, bool]:
    """The sentence without "before all that", and whether it said so."""
    flat = keys(sentence)
    for index in range(len(flat)):
        marker = next((m for m in _AT_FIRST if flat[index : index + len(m)] == m), ())
        if not marker:
            continue
        before, after = sentence[:index], sentence[index + len(marker) :]
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
    if same:
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
    """Whether a subject and its finite verb stand here ("the ducks are nesting", "somebody is asleep there")."""
    flat = keys(part)
    if len(flat) < 3 or opens_command(part):
        return False
    link = next((i for i in range(1, min(5, len(flat) - 1)) if flat[i] in _FINITE), 0)
    if not link or flat[0] in lexicon().question_starts | {"and", "or", "but", "then"}:
        return False
    simple = flat[0] in {"i", "we", "he", "she", "it", "they", "there", "nobody", "somebody", "someone", "everybody", "nothing"}
    return simple or (flat[0] in lexicon().determiners and link > 1)


def _going_on(sentence: Phrase, is_stop: IsStop) -> Phrase:
    """For "after the desk (please) to the door": going there."""
    flat = keys(sentence)
    result: list[Word] = []
    for index, word in enumerate(sentence):
        if (
            word.key == "to"
            and index > 1
            and flat[0] in {"after", "afterwards", "finally", "then", "next"}
            and any(is_stop(sentence[index + 1 : end]) for end in range(index + 2, min(index + 6, len(flat)) + 1))
            and not any(opens_command(sentence[i:]) and lemma(flat[i]) == flat[i] for i in range(max(0, index - 3), index))
        ):
            result += (_COMMA, Word("go", "go"))
        result.append(word)
    return tuple(result)
