"""Small things that people say around what they mean, put briefly before a message is cut into its parts.

"To me" beside a place, "A, he is over there, has left B", "look for it" where the telling names the thing,
one of several that is picked, conditions dictated without a mark. What is only said around: `asides`.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.sentences.asides import without_asides
from parley.language.offline.sentences.finite import subject_apart
from parley.language.offline.sentences.lost import with_what_was_lost
from parley.language.offline.sentences.moved import what_was_left
from parley.language.offline.sentences.ranking import all_of_those, any_of_those, named_first, ranked_stops
from parley.language.offline.sentences.reasons import closed_reasons
from parley.language.offline.sentences.said_before import named_before
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.rewriting import rewritten
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular, tokens

__all__ = ["briefly"]

_ENDING = frozenset({",", ".", "!", "?", ";", "and", "then", "please", "but", "so"})
_STOP = Word(".", ".")


def briefly(words: Phrase) -> Phrase:
    """The same message, with less around what is meant."""
    words = with_what_was_lost(
        what_was_left(subject_apart(without_asides(named_before(any_of_those(all_of_those(words))))))
    )
    words = ranked_stops(
        named_first(_picked(_there_and_with(_the_same(_asked_apart(_sought_first(closed_reasons(words)))))))
    )
    return _without_me(_with_short_conditions(_as_well(_seeing(words))))


def _sought_first(words: Phrase) -> Phrase:
    """For "cracks? check A" "check A for cracks"."""
    flat = keys(words)
    at = flat.index("?") if "?" in flat[1:3] else 0
    end = next((i for i in range(at + 1, len(flat)) if not words[i].is_word), len(flat))
    looks = flat[at + 1 : at + 2] and flat[at + 1] in _LOOKING and end > at + 2
    if not at or not looks or _SOUGHT & set(flat[at + 1 : end]):
        return words
    if any(key in lexicon().vocabulary and key not in lexicon().nouns for key in flat[:at]):
        return words
    return (*words[at + 1 : end], Word("for", "for"), *(Word(w.key, w.key) for w in words[:at]), *words[end:])


_LOOKING = frozenset({"check", "inspect", "examine", "look", "search", "scan", "go"})
_SOUGHT = frozenset({"for", "whether", "if", "then", "it", "there", "them", "that", "go", "tell"})


def _asked_apart(words: Phrase) -> Phrase:
    """For "check A: is it open?" "check A. is it open?"."""
    flat = keys(words)
    for at in range(2, len(flat) - 2):
        if flat[at] != ":" or flat[at + 1] not in _ASKED or "?" not in flat[at:]:
            continue
        start = next((i + 1 for i in range(at - 1, -1, -1) if flat[i] in {".", "!", "?"}), 0)
        verb = lexicon().verbs.match(flat, start)
        if verb is not None and verb[1].startswith(_GOING) and flat[start] not in {"tell", "say"}:
            return (*words[:at], _STOP, *words[at + 1 :])
    return words


_ASKED = frozenset({"is", "are", "was", "were", "has", "have", "does", "do", "can"})


def _picked(words: Phrase) -> Phrase:
    """For "of the two doors, pick the one nearer to A and go there" "of the two doors, go to the one ..."."""
    words = _one_of_those(words)
    flat = keys(words)
    for at in range(len(flat) - 4):
        if flat[at] not in _PICKING or flat[at + 1] != "the":
            continue
        if flat[at] == "take" and not {"one", "nearer", "closer", "nearest", "closest"} & set(flat[at:]):
            continue
        end = next((i for i in range(at + 3, len(flat)) if flat[i] in {",", "and", "."}), len(flat))
        rest = tuple(key for key in flat[end:] if key not in _ENDING)
        if rest in {("go", "there"), ("go", "to", "it"), ("drive", "there"), ("visit", "it")}:
            return (*words[:at], *tokens("go to"), *words[at + 1 : end])
    return words


def _one_of_those(words: Phrase) -> Phrase:
    """For "of the two doors, V the one nearer to A" "V the door nearer to A"."""
    flat = keys(words)
    start = 2 + (flat[2:3] != () and flat[2] in lexicon().numbers)
    end = flat.index(",", start) if "," in flat[start : start + 5] else 0
    if flat[:2] not in {("of", "the"), ("of", "these"), ("of", "those")} or end <= start:
        return words
    last = words[end - 1]
    one = Word(singular(last.key), singular(last.raw))
    at = next((i for i in range(end + 2, len(flat)) if flat[i - 1 : i + 1] == ("the", "one")), 0)
    if not at or one.key == last.key:
        return words
    return (*words[end + 1 : at], *words[start : end - 1], one, *words[at + 1 :])


_PICKING = frozenset({"pick", "choose", "select", "take"})


def _the_same(words: Phrase) -> Phrase:
    """For "do the very same at A", "do exactly the same thing at A" "do the same at A"."""
    flat = keys(words)
    left = {
        i
        for i in range(1, len(flat))
        if (flat[i] == "very" and flat[i - 1] == "the" and flat[i + 1 : i + 2] == ("same",))
        or (flat[i] in _JUST and flat[i - 1] == "do" and flat[i + 1 : i + 3] == ("the", "same"))
        or (
            flat[i] in {"thing", "things"} and flat[max(0, i - 2) : i] == ("the", "same") and "do" in flat[:i]
        )
    }
    return tuple(word for i, word in enumerate(words) if i not in left) if left else words


_JUST = frozenset({"exactly", "just", "precisely", "much"})


def _there_and_with(words: Phrase) -> Phrase:
    """For "the box that is lying there" "the box", "to Ann, who is in A right now, " "to Ann in A".

    "When you have handed it over, V" behind an order to bring it is no second order, but "then V".
    """
    flat = keys(words)

    def put(at: int, before: Sequence[Word]) -> tuple[int, Phrase] | None:
        del before
        end = _lying_there(flat, at) or _who_is(words, flat, at)
        if end:
            return end - at, words[at + 3 : _now_starts(flat, at + 3, end)] if flat[at] == "," else ()
        end = _handed(flat, at)
        return (end - at, (Word("then", "then"),)) if end else None

    return rewritten(words, put)


def _lying_there(flat: tuple[str, ...], index: int) -> int:
    """Where "that are lying there" ends that begins at `index` behind a thing; 0 if it does not."""
    if flat[index] not in {"that", "which"} or flat[index + 1 : index + 2] not in {("is",), ("are",)}:
        return 0
    if not {"the", "a", "all", "any", "some", "those", "these"} & set(flat[max(0, index - 4) : index - 1]):
        return 0
    at = index + 2
    at += flat[at : at + 1] != () and flat[at] in _RESTING
    ended = flat[at + 1 : at + 2] == () or flat[at + 1] in _ENDING
    return at + 1 if flat[at : at + 1] == ("there",) and ended else 0


_RESTING = frozenset({"lying", "standing", "sitting", "kept", "stored", "waiting", "left", "already"})


def _who_is(words: Phrase, flat: tuple[str, ...], index: int) -> int:
    """Where ", who is in A right now" ends, behind somebody's name; 0 if it does not begin at `index`."""
    if (
        flat[index] != ","
        or not index
        or not words[index - 1].is_capital
        or flat[index + 1 : index + 2] != ("who",)
    ):
        return 0
    where = flat[index + 3 : index + 4] != () and flat[index + 3] in {"in", "at", "on", "by"}
    if not where or flat[index + 2] not in {"is", "sits", "works", "waits", "lives", "lies", "stays"}:
        return 0
    end = next(
        (i for i in range(index + 4, len(flat)) if not words[i].is_word or flat[i] == "and"), len(flat)
    )
    bare_end = end + (flat[end : end + 1] == (",",) and flat[end + 1 : end + 2] not in {("and",), ("then",)})
    return min(bare_end, len(flat)) if end - index < 11 else 0


_NOW = (("right", "now"), ("at", "the", "moment"), ("now",), ("currently",), ("today",), ("this", "morning"))


def _now_starts(flat: tuple[str, ...], start: int, end: int) -> int:
    """Where "right now" begins at the end of what is said, or its end."""
    end -= flat[end - 1] == ","
    return end - next((len(now) for now in _NOW if flat[max(start, end - len(now)) : end] == now), 0)


def _handed(flat: tuple[str, ...], index: int) -> int:
    """Where "when you have handed it over," ends behind an order to bring it; 0 if it does not begin here."""
    if flat[index] not in {"when", "once", "after"} or flat[index + 1 : index + 3] != ("you", "have"):
        return 0
    if (
        flat[index + 3 : index + 4] == ()
        or flat[index + 3] not in _HANDED
        or not _BRINGING & set(flat[:index])
    ):
        return 0
    at = index + 4
    while at < len(flat) and flat[at] in _WHAT_TO_WHOM:
        at += 1
    return at + 1 if at > index + 4 and flat[at : at + 1] == (",",) else 0


_HANDED = frozenset({"handed", "given", "delivered", "dropped", "brought", "passed"})
_BRINGING = frozenset({"bring", "take", "give", "deliver", "hand", "carry", "pass"})
_WHAT_TO_WHOM = frozenset({"it", "them", "that", "those", "everything", "over", "off", "to", "him", "her"})


def _seeing(words: Phrase) -> Phrase:
    """For "see if you can tell what it is" "see what it is", for "see if you can find A" "look for A"."""
    flat = keys(words)
    for at in range(len(flat) - 6):
        if flat[at] not in {"see", "check", "look"} or flat[at + 1] not in {"if", "whether"}:
            continue
        if flat[at + 2 : at + 4] not in {("you", "can"), ("you", "could")}:
            continue
        verb = next((v for v in _MAKING_OUT if flat[at + 4 : at + 4 + len(v)] == v), ())
        behind = at + 4 + len(verb)
        asks = flat[behind : behind + 1] != () and flat[behind] in lexicon().question_starts | {
            "whether",
            "if",
        }
        if verb and (asks or verb[-1] in {"find", "spot", "see"}):
            plainly = tokens("see") if asks else tokens("look for")
            return (*words[:at], *plainly, *_seeing(words[behind:]))
    return words


def _as_well(words: Phrase) -> Phrase:
    """For "see if A is open, and B as well" "see if A is open. and B as well"."""
    flat = keys(words)
    for at in range(6, len(flat) - 2):
        start = next((i + 1 for i in range(at - 1, -1, -1) if flat[i] in {".", "!", "?", ";"}), 0)
        end = next((i for i in range(at + 2, min(at + 7, len(flat))) if flat[i] in {"too", "as", "also"}), 0)
        behind = end + 1 + (flat[end : end + 2] == ("as", "well"))
        ended = behind >= len(flat) or not words[behind].is_word or flat[behind] in {"and", "then", "please"}
        if flat[at] != "and" or not end or not ended or not {"if", "whether"} & set(flat[start + 1 : at - 2]):
            continue
        named = flat[at + 1 : end]
        verb = lexicon().verbs.match(flat, at + 1) is not None or lexicon().be & set(named)
        if not verb and all(word.is_word for word in words[at:end]) and flat[start] not in {"if", "and"}:
            return (*words[: at - (flat[at - 1] == ",")], _STOP, *words[at:])
    return words


_MAKING_OUT = (
    ("find", "out"), ("work", "out"), ("make", "out"), ("figure", "out"), ("tell",), ("see",), ("spot",),
    ("find",),
)  # fmt: skip


def _without_me(words: Phrase) -> Phrase:
    """For "come to me at the desk" "come to the desk"."""
    flat = keys(words)
    for index in range(1, len(flat) - 3):
        if flat[index] == "find" and flat[index + 1] in {"me", "us"} and flat[index + 2] in _WHERE_AT:
            start = index - 2 * (flat[index - 1] == "and" and flat[max(0, index - 2)] in {"go", "come"})
            return (*words[:start], *tokens("come to"), *words[index + 3 :])
        if flat[index] in {"to", "by"} and flat[index + 1] in {"me", "us"} and flat[index + 2] in _WHERE_AT:
            verb = next((flat[i] for i in range(index - 1, max(-1, index - 4), -1) if flat[i] in _COMING), "")
            if verb and "report" in flat[max(0, index - 2) : index]:
                start = next(i for i in range(index - 1, -1, -1) if flat[i] == "report")
                return (*words[:start], *tokens("come to"), *words[index + 3 :])
            if verb:
                return (*words[: index + 1], *words[index + 3 :])
    return words


_WHERE_AT = frozenset({"at", "in", "by", "on", "near", "outside"})
_COMING = frozenset(
    {"come", "go", "return", "report", "drive", "get", "head", "back", "run", "hurry", "over"}
)


def _with_short_conditions(words: Phrase) -> Phrase:
    """For "if it is go to A if it is not go to B", dictated: with marks where they belong."""
    flat = keys(words)
    result: list[Word] = []
    for index, word in enumerate(words):
        begins = word.key in {"if", "unless"} and flat[index + 1 : index + 2] in _IT
        verb = _order_behind(words, flat, index) if begins else 0
        if verb and index and words[index - 1].is_word and flat[index - 1] not in _JOINED_TO:
            result.append(_STOP)
        result.append(word)
        hanging = next((i for i in range(max(0, index - 5), index) if flat[i] in {"if", "unless"}), -1)
        waits = hanging >= 0 and flat[hanging + 1 : hanging + 2] in _IT and word.is_word
        if waits and _order_behind(words, flat, hanging) == index + 1:
            result.append(Word(",", ","))
    return tuple(result)


_IT = frozenset({("it",), ("that",), ("they",), ("so",), ("not",), ("there",)})
_JOINED_TO = frozenset({
    "and", "but", "or", "see", "check", "know", "whether", "me", "us", "out", "look", "sure", "then", "then,",
    "only", "even", "verify", "ask", "tell", "wonder",
})  # fmt: skip
_GOING = ("motion:", "back:", "look:", "dock:", "wait:", "search:")


def _order_behind(words: Phrase, flat: tuple[str, ...], start: int) -> int:
    """Where an order begins right behind "if it is (not)", with nothing to mark it; 0 if it does not."""
    at = start + 1
    while at < len(flat) and flat[at] in _SHORTLY:
        at += 1
    if at < start + 2 or at + 1 >= len(flat) or not all(word.is_word for word in words[start:at]):
        return 0
    found = lexicon().verbs.match(flat, at)
    return at if found is not None and found[1].startswith(_GOING) and flat[at] == lemma(flat[at]) else 0


_SHORTLY = frozenset(
    {"it", "that", "they", "so", "not", "there", "is", "are", "was", "does", "do", "one", "any"}
)
