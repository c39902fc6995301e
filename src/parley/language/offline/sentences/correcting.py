"""What is taken back in the same breath: "A, no wait, B" is B, "A and B, other way round" is B and A."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from parley.language.offline.sentences.laconic import SEEN
from parley.language.offline.sentences.units import spans
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = ["corrected"]

IsStop = Callable[[Phrase], bool]
Opens = Callable[[Phrase], bool]

_DATA = load_data("correcting")
_TAKING_BACK = PhraseTable.of(_DATA["taking_back"])
_AROUND = PhraseTable.of(_DATA["around"])
_OTHER_WAY = PhraseTable.of(_DATA["other_way"])
_MARKS = frozenset({".", "!", "?", ";", "\n", "..."})
_CLEAR = frozenset({
    "no wait", "wait no", "no sorry", "i mean", "i meant", "scratch that", "strike that", "or rather",
    "make that", "no actually", "actually no", "no hang on", "no hold on", "hang on no", "hold on no",
    "my mistake", "er no", "sorry i meant", "sorry i mean", "correction", "what am i saying",
})  # fmt: skip
"""These take something back even where no comma stands before them."""
_LINKS = frozenset({"to", "at", "in", "into", "from", "by", "for"})
_PAUSES = frozenset({",", "and", "then", "so", "but", "please"})


def corrected(words: Phrase, is_stop: IsStop, opens: Opens) -> Phrase:
    """The message as the speaker wants it in the end; unchanged if nothing is taken back.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one thing on the map.
        opens: Whether a command begins with these words.
    """
    for index in range(2, len(words) - 1):
        left = _dropped(words, index, is_stop, opens)
        if left is not None:
            return corrected(left, is_stop, opens)
        end, sure = _taken_back(words, index)
        if not end or end >= len(words):
            continue
        if keys(words[index:end])[:1] == ("no",) and "yes" in keys(words[:index]):
            # "Yes: V, no: W".
            continue
        said, rest = _undenied(_ended(words[:index])), _meant(words[end:], opens)
        said_flat = keys(words[index:end])
        held = {"hold", "wait", "hang"} & set(said_flat) and "actually" not in said_flat
        if held and not any(_TAKING_BACK.match(said_flat, i) for i in range(end - index)):
            better = _explained_anew(said, rest, is_stop, opens)
            if better is not None:
                return corrected(better, is_stop, opens)
            continue
        better = (
            _explained_anew(said, rest, is_stop, opens)
            or _turned(said, rest, is_stop, opens)
            or _ordered_anew(said, rest, opens)
            or _named_anew(said, rest, is_stop, sure=sure)
        )
        if better is not None:
            return corrected(better, is_stop, opens)
    return words


_BEHIND_NO = frozenset((word,) for word in (*lexicon().determiners, "to", "not", "go", "in", "at", "first"))
_DROPPING = PhraseTable.of(_DATA["dropping"])
_ENOUGH = frozenset(_DATA["enough"])


def _dropped(words: Phrase, start: int, is_stop: IsStop, opens: Opens) -> Phrase | None:
    """For "V A and W B. Skip A(, B is enough)": what is left of it; None if nothing is dropped here."""
    flat = keys(words)
    if flat[start - 1] not in _MARKS | {","}:
        return None
    lead = start
    while lead < len(flat) - 2:
        back = _TAKING_BACK.match(flat, lead) if flat[lead] not in {"not", "forget"} else None
        if back is None and flat[lead] not in {"but", "actually", "and", "oh", "or", ","}:
            break
        lead += back[0] if back is not None else 1
    found = _DROPPING.match(flat, lead)
    at = lead + (found[0] if found is not None else 0)
    size = next((n for n in range(min(6, len(words) - at), 0, -1) if is_stop(words[at : at + n])), 0)
    end = at + size
    end += flat[end : end + 1] in {("alone",), ("out",), ("off",)}
    if found is None or not size or not (end == len(words) or not words[end].is_word):
        return None
    name = keys(_bare(words[at : at + size]))
    listed = _unlisted(words[:start], name, is_stop)
    if listed is not None and end <= len(words):
        return (*_ended(listed), *(words[end:] if not set(flat[end:]) & _ENOUGH - {"is"} else words[-1:]))
    starts = [*_orders(words[:start], opens), start]
    tail = words[end + 1 :]
    if len(starts) == 2 and name in {keys(_bare(words[a:b])) for a, b in spans(words[:start], is_stop)}:
        return tail if opens(tail) else None
    for first, last in pairwise(starts):
        named = spans(words[first:last], is_stop)
        said = [keys(_bare(words[first + a : first + b])) for a, b in named]
        if len(starts) > 2 and said == [name]:
            tail = words[end:] if not set(flat[end:]) & _ENOUGH - {"is"} else ()
            return _ended((*words[:first], *words[last:start])) + (tail or (words[-1],))
    return None


def _unlisted(said: Phrase, name: tuple[str, ...], is_stop: IsStop) -> Phrase | None:
    """Without one name of a list ("A, B and C"); None if it stands in no list."""
    named = spans(said, is_stop)
    flat = keys(said)
    for a, b in named:
        if keys(_bare(said[a:b])) != name or len(named) < 2:
            continue
        if flat[b : b + 1] in {("and",), (",",)} and any(c == b + 1 for c, _ in named):
            return (*said[:a], *said[b + 1 :])
        if flat[a - 1] in {"and", ","} and any(d == a - 1 for _, d in named):
            return (*said[: a - 1], *said[b:])
    return None


def _first_of_two(said: Phrase, name: Phrase, rest: Phrase, named: list[tuple[int, int]]) -> Phrase | None:
    """For "A, then B, sorry, B first": B, then A."""
    (a, b), (c, d) = named[-2:]
    if keys(_bare(said[c:d])) != keys(_bare(name)):
        return None
    return (*said[:a], *said[c:d], *said[b:c], *said[a:b], *said[d:], *rest)


def _is_label(word: str) -> bool:
    return len(word) == 1 or word.isdigit() or word in lexicon().numbers


def _bare(words: Phrase) -> Phrase:
    return words[1:] if words and words[0].key in lexicon().determiners else words


def _taken_back(words: Phrase, start: int) -> tuple[int, bool]:
    """Where the words that take something back end, if they begin at `start`; 0 if none do."""
    flat = keys(words)
    pause = flat[start - 1] in _MARKS | {","}
    index, clear = start, ""
    while index < len(flat):
        found = _TAKING_BACK.match(flat, index)
        other = _AROUND.match(flat, index)
        if found is None and (other is None or (flat[index] in {",", ":"} and index == start)):
            break
        if found is not None and (other is None or found[0] >= other[0]):
            clear = found[1] if found[1] in _CLEAR or not clear else clear
            index += found[0]
        elif other is not None:
            index += other[0]
    if flat[start:index] == ("actually", ",") or (flat[start:index] == ("actually",) and pause):
        clear = "actually"
    labels = _is_label(flat[start - 1]) and flat[index : index + 1] != () and _is_label(flat[index])
    if not clear and pause and {"hold", "wait", "hang"} & set(flat[start:index]):
        # "Hold on, it is locked, go to B": only if another order follows.
        return index, False
    if not clear or not (pause or clear in _CLEAR or labels):
        return 0, False
    if flat[start:index] == ("no",) and not labels and flat[index : index + 1] not in _BEHIND_NO:
        # "No rush", "no need to".
        return 0, False
    return index, clear in _CLEAR


def _ended(words: Phrase) -> Phrase:
    while words and not words[-1].is_word:
        words = words[:-1]
    return words


def _undenied(said: Phrase) -> Phrase:
    """For "no, do not check A, (I meant B)" "check A": what is taken back is that it was A."""
    flat = keys(said)
    lead = next((i for i in range(len(flat)) if flat[i] not in {"no", ",", ".", "!", "please"}), 0)
    return said[lead + 2 :] if flat[lead : lead + 2] == ("do", "not") and len(flat) > lead + 3 else said


def _orders(words: Phrase, opens: Opens) -> list[int]:
    """Where orders begin."""
    flat = keys(words)
    starts = [i for i in range(len(words)) if i == 0 or flat[i - 1] in _PAUSES | _MARKS]
    return [i for i in starts if words[i].is_word and flat[i] not in _PAUSES and opens(words[i:])]


def _turned(said: Phrase, rest: Phrase, is_stop: IsStop, opens: Opens) -> Phrase | None:
    """For "A and B, no, the other way round"."""
    found = _OTHER_WAY.match(keys(rest))
    if found is None:
        return None
    tail = rest[found[0] :]
    starts = _orders(said, opens)
    if len(starts) > 1:
        first, second = starts[-2:]
        joint = second
        while joint > first and (not said[joint - 1].is_word or said[joint - 1].key in _PAUSES):
            joint -= 1
        return (*said[:first], *said[second:], *said[joint:second], *said[first:joint], *tail)
    named = spans(said, is_stop)
    if len(named) < 2:
        return None
    (a, b), (c, d) = named[-2:]
    return (*said[:a], *said[c:d], *said[b:c], *said[a:b], *said[d:], *tail)


def _ordered_anew(said: Phrase, rest: Phrase, opens: Opens) -> Phrase | None:
    """For "V A, no wait, W B": the last order is taken back."""
    starts = _orders(said, opens)
    if not starts or not opens(rest) or keys(rest)[0] in {"not", "do"}:
        return None
    sentence = next((i for i, word in enumerate(rest) if word.key in _MARKS), len(rest))
    if keys(rest[:sentence])[-1:] == ("first",):
        return (*said[: starts[-1]], *rest[: sentence - 1], *_then(said[starts[-1] :]), *rest[sentence:])
    return (*said[: starts[-1]], *rest)


def _meant(rest: Phrase, opens: Opens) -> Phrase:
    """What is wanted in "I said A but I meant B" and in "do not go there, go to B"."""
    flat = keys(rest)
    at = next((i for i in range(2, min(10, len(flat) - 1)) if flat[i] in {"meant", "mean"}), 0)
    if flat[:2] == ("i", "said") and at:
        return rest[at + 1 :]
    cut = next((i for i in range(2, min(8, len(flat) - 1)) if flat[i] in {",", "."}), 0)
    if flat[:2] == ("do", "not") and cut and opens(rest[cut + 1 :]):
        return rest[cut + 1 :]
    return rest


def _explained_anew(said: Phrase, rest: Phrase, is_stop: IsStop, opens: Opens) -> Phrase | None:
    """For "go to A, hold on, it is locked, go to B": why it is taken back stands between."""
    flat = keys(rest)
    cut = next((i for i in range(1, len(flat)) if flat[i] in {",", "."}), 0)
    behind = cut + 1
    while behind < len(flat) and flat[behind] in {"so", "please", "then", "just", "better", ","}:
        behind += 1
    finite = {"is", "are", "was", "has", "does", "can", "will", "looks", "had", "were"}
    subject = flat[0] in {"it", "that", "they", "there", "he", "she"}
    told = bool(cut) and subject and bool(flat[1:2]) and flat[1] in finite
    if not told or opens(rest[:cut]) or spans(rest[:cut], is_stop):
        return None
    starts = _orders(said, opens)
    if not starts or not opens(rest[behind:]):
        return None
    return (*said[: starts[-1]], *rest[behind:])


def _then(words: Phrase) -> Phrase:
    from parley.language.offline.words.text import Word

    return (Word(",", ","), Word("then", "then"), *words)


def _named_anew(said: Phrase, rest: Phrase, is_stop: IsStop, *, sure: bool) -> Phrase | None:
    """For "V A, no wait, B": the last name, or the one behind the same word, is taken back."""
    named = spans(said, is_stop)
    if not named:
        return _said_anew(said, rest) if sure else None
    if rest[0].key in {"only", "just"} and len(named) > 1:
        only = next((n for n in range(min(6, len(rest) - 1), 0, -1) if is_stop(rest[1 : 1 + n])), 0)
        listed = {keys(_bare(said[c:d])) for c, d in named}
        if only and keys(_bare(rest[1 : 1 + only])) in listed:
            return (*said[: named[0][0]], *rest[1:])
    if rest[0].key == "not":
        rest = _rest_of_denied(rest, is_stop)
    if not rest:
        return None
    link = rest[0].key if rest[0].key in _LINKS else ""
    skip = 1 if link else 0
    size = next((n for n in range(min(6, len(rest) - skip), 0, -1) if is_stop(rest[skip : skip + n])), 0)
    a, b = next((s for s in reversed(named) if link and said[s[0] - 1].key == link), named[-1])
    if size and keys(rest[skip + size : skip + size + 1]) == ("first",) and len(named) > 1:
        return _first_of_two(said, rest[skip : skip + size], rest[skip + size + 1 :], named)
    if not size:
        # "A, no, my other left, B".
        later = next(((c, d) for c, d in spans(rest, is_stop) if c < 8 and rest[c - 1].key == ","), None)
        if later is not None and not any(word.key in _MARKS for word in rest[: later[0]]):
            return (*said[:a], *rest[later[0] : later[1]], *said[b:], *rest[later[1] :])
    if size:
        return (*said[:a], *rest[skip : skip + size], *said[b:], *rest[skip + size :])
    label = rest[skip].key
    last = said[b - 1].key
    if _is_label(label) and _is_label(last) and is_stop((*said[a : b - 1], rest[skip])):
        return (*said[: b - 1], rest[skip], *said[b:], *rest[skip + 1 :])
    if not sure:
        return _word_anew(said, rest)
    return _described_anew(said, rest, a, b, is_stop) or _said_anew(said, rest)


def _said_anew(said: Phrase, rest: Phrase) -> Phrase | None:
    """For "the roses, I mean the lilies", of what no name on the map is: from the last article on."""
    end = next((i for i, word in enumerate(rest) if not word.is_word), len(rest))
    at = next((i for i in range(len(said) - 1, 0, -1) if said[i].key in lexicon().determiners), 0)
    if not at or not 1 < end <= 5 or rest[0].key not in lexicon().determiners:
        return None
    return (*said[:at], *rest)


def _word_anew(said: Phrase, rest: Phrase) -> Phrase | None:
    """For "is locked, sorry, closed": one word for another."""
    end = next((i for i, word in enumerate(rest) if not word.is_word), len(rest))
    states = {"is", "are", "was", "it", "still", "really", "been"}
    if end != 1 or len(said) < 3 or said[-2].key not in states or rest[0].key in lexicon().vocabulary - SEEN:
        return None
    return (*said[:-1], *rest)


def _rest_of_denied(rest: Phrase, is_stop: IsStop) -> Phrase:
    """For "not A, (but) B": B and what follows."""
    named = spans(rest, is_stop)
    if len(named) < 2 or named[0][0] > 2:
        return ()
    at = named[0][1]
    while at < named[1][0] and rest[at].key in {",", "but", "the", "to", "rather"} - {rest[named[1][0]].key}:
        at += 1
    return rest[at:]


def _described_anew(said: Phrase, rest: Phrase, a: int, b: int, is_stop: IsStop) -> Phrase | None:
    """For "the red box, no wait, the blue one"."""
    flat = keys(rest)
    one = next((i for i in range(1, min(4, len(flat))) if flat[i] == "one"), 0)
    start = 1 if flat[0] in lexicon().determiners else 0
    if not one:
        return None
    kind = (*rest[start:one], said[b - 1])
    return (*said[:a], *kind, *said[b:], *rest[one + 1 :]) if is_stop(kind) else None
