"""What only says once more that something is so or is not: "if so", "if it isn't", "unless you find one".

The one reader of such words; everything else knows them as "if so ,", "if not ," and "otherwise".
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Final

from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data, written_out

__all__ = ["FINDING", "OPPOSITES", "STATES", "Echo", "echo", "leads", "phrases", "put_briefly"]

_DATA: Final = load_data("conditions")
FINDING: Final = frozenset(_DATA["finding"])
"""How people say that something turns up."""
_PAIRS: Final = frozenset((pair.split()[0], pair.split()[1]) for pair in _DATA["states"])
OPPOSITES: Final = _PAIRS | {(b, a) for a, b in _PAIRS}
"""States of which a thing has one or the other."""
STATES: Final = frozenset(word for pair in _PAIRS for word in pair) - {"there", "gone"}
_SUBJECTS: Final = frozenset(_DATA["subjects"])
_HOLDING: Final = frozenset(_DATA["holding"])
_DENIALS: Final = frozenset(_DATA["denials"])
_FILLERS: Final = frozenset(_DATA["fillers"])
_GONE: Final = frozenset(_DATA["gone"])
_AGAIN: Final = frozenset(_DATA["again"])
_NONE_AGAIN: Final = frozenset(_DATA["none_again"])
_HELPING: Final = frozenset(_DATA["helping"])
_ANYBODY: Final = frozenset({"somebody", "someone", "anybody", "anyone"})
_MARKS: Final = frozenset({".", "!", "?", ";", "\n", ",", ":", "-"})
_ENDS: Final = frozenset({".", "!", "?", ";", "\n"})
_HOLDS: Final = frozenset((word,) for word in _HOLDING)
_PLEASED: Final = frozenset({"good", "great", "fine", "ok", "okay", "right", "perfect"})
_JOINTS: Final = frozenset({"and", "or", "but", "then", "please", "just", "simply", "otherwise", "else"})
_SOMETHING: Final = frozenset(
    {"something", "someone", "somebody", "anything", "anyone", "anybody", "nothing", "nobody", "everything",
     "everyone", "everybody", "what", "where", "who", "one", "somewhere", "anywhere", "all"}
)  # fmt: skip


@cache
def phrases(kind: str) -> PhraseTable:
    """All phrases of one kind of `data/conditions.yaml`."""
    return PhraseTable.of(_DATA[kind])


@cache
def leads() -> PhraseTable:
    """What stands before a condition; the value is "if", "only if" or "unless"."""
    table = {p: word for word, kind in (("if", "leads"), ("only if", "only"), ("unless", "denying"))
             for text in _DATA[kind] for p in written_out(text)}  # fmt: skip
    return PhraseTable(table)


@dataclass(frozen=True, slots=True)
class Echo:
    """Words that only repeat a condition."""

    size: int
    holds: bool
    kind: str = "state"
    """What it speaks of.

    "state": "if so", "if it is not"; "there": "if there are none"; "found": "if you see one";
    "present": "if nobody is there"; "else": "otherwise"; "answer": "yes", "then".
    """


def echo(words: Phrase, at: int, opens: Callable[[Phrase], bool], *, answers: bool = False) -> Echo | None:
    """What is said once more at `at`; None if it is something else.

    Args:
        words: All words and punctuation.
        at: Where to read.
        opens: Whether an order begins with these words.
        answers: Whether "yes" and "no" alone count, as behind a question.
    """
    if not 0 <= at < len(words) or words[at].key not in _STARTS:
        return None
    flat = keys(words)
    found = _said(flat, at) or _pointed(flat, at) or _alone(flat, at, answers=answers)
    return found if found is not None and _ends(words, at + found.size, flat, found, opens) else None


def _answers_itself(words: Phrase, at: int, flat: tuple[str, ...]) -> Echo | None:
    """For a sentence that is only "It is?" or "It isn't.", said of what is looked at."""
    begins = at == 0 or flat[at - 1] in _ENDS
    none = phrases("no_luck").match(flat, at) if begins and at else None
    if none is not None and flat[at + none[0] : at + none[0] + 1] == ("?",):
        return Echo(none[0], False)
    if not begins or flat[at] not in _SUBJECTS - {"that", "there"} or flat[at + 1 : at + 2] not in _HOLDS:
        return None
    denied = flat[at + 2 : at + 3] == ("not",)
    end = at + 2 + denied
    return Echo(end - at, not denied) if flat[end : end + 1] == ("?",) else None


def put_briefly(words: Phrase, opens: Callable[[Phrase], bool]) -> Phrase:
    """The message with "if so", "if not" and "otherwise" for all words that say no more than that."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        fine = phrases("fine").match(flat, index)
        if fine is not None and _IF_SO & {tuple(keys(result[i : i + 2])) for i in range(len(result))}:
            # "If so, V; if all is well, W".
            result += [Word("otherwise", "otherwise")]
            index += fine[0]
            continue
        found = echo(words, index, opens) if flat[index] in _FIRST else _answers_itself(words, index, flat)
        begins = not index or not words[index - 1].is_word or flat[index - 1] in _JOINTS
        if found is not None and not begins and _ends_condition(words, index, opens):
            # "V if S otherwise W", said without any mark.
            result.append(Word(",", ","))
            begins = True
        if found is None or found.kind not in {"state", "there", "else"} or not begins:
            result.append(words[index])
            index += 1
            continue
        said = "otherwise" if found.kind == "else" else "if so" if found.holds else "if not"
        result += [Word(part, part) for part in said.split()]
        index += found.size
        if flat[index : index + 1] == ("?",):
            # "It is? Good, then V".
            index += 1
            while index < len(flat) and flat[index] in _PLEASED | {",", "then"}:
                index += 1
    return tuple(result)


def _ends_condition(words: Phrase, at: int, opens: Callable[[Phrase], bool]) -> bool:
    """Whether "otherwise" stands behind a condition and not behind an order."""
    flat = keys(words)
    held = next((i for i in range(at - 1, -1, -1) if flat[i] in _IF_HELD), -1)
    inside = range(held + 2, at)
    return flat[at] in {"otherwise", "else"} and held >= 0 and not any(opens(words[i:at]) for i in inside)


_IF_HELD: Final = frozenset({"if", "unless", "whether"})
_IF_SO: Final = frozenset({("if", "so")})
_FIRST: Final = frozenset(
    text.split()[0]
    for kind in ("leads", "only", "denying", "so", "not_so")
    for whole in _DATA[kind]
    for text in written_out(whole)
) | {"else"}

_STARTS: Final = _FIRST | {"when", "once", "as", "yes", "no", "then"}


def _said(flat: tuple[str, ...], at: int) -> Echo | None:
    """Set phrases ("in that case", "failing that"), and "if so" and "if not"."""
    for kind, holds in (("so", True), ("not_so", False)):
        found = phrases(kind).match(flat, at)
        if found is not None:
            other = found[1].endswith(("otherwise", "else", "other case")) or found[1] == "failing that"
            return Echo(found[0], holds, "else" if other else "state")
    if flat[at : at + 1] == ("else",) and (not at or flat[at - 1] not in _SOMETHING):
        return Echo(1, False, "else")
    lead = _lead(flat, at)
    if lead is None:
        return None
    end, holds = at + lead[0], lead[1]
    word = flat[end] if end < len(flat) else ""
    if word in {"so", "yes"}:
        return Echo(end + 1 - at, holds)
    if word in {"not", "no", "none"}:
        end += 1 + (flat[end + 1 : end + 2] == ("so",))
        return Echo(end - at, not holds)
    return None


def _lead(flat: tuple[str, ...], at: int) -> tuple[int, bool] | None:
    """How long what leads a condition is, and whether it must hold."""
    found = leads().match(flat, at)
    if found is not None:
        return found[0], found[1] != "unless"
    return (1, True) if flat[at] == "when" else None


def _pointed(flat: tuple[str, ...], at: int) -> Echo | None:
    """For "if it is(n't)", "if there are none", "if nobody is there", "if you can't find it"."""
    lead = _lead(flat, at)
    if lead is None:
        found_later = flat[at] == "once", flat[at : at + 3] == ("as", "soon", "as")
        lead = (1, True) if found_later[0] else (3, True) if found_later[1] else None
        if lead is None or flat[at + lead[0] : at + lead[0] + 1] != ("you",):
            return None
    start, holds = at + lead[0], lead[1]
    if start >= len(flat):
        return None
    subject = flat[start]
    if subject == "you":
        return _finding(flat, at, start + 1, holds)
    if subject in _SUBJECTS and flat[start + 1 : start + 2] and flat[start + 1] in _HOLDING:
        return _being(flat, at, start + 2, holds, there=subject == "there")
    none = 2 if flat[start : start + 2] == ("no", "one") else int(subject in {"nobody", "none", "nothing"})
    anyone = none or int(subject in _ANYBODY)
    if anyone and flat[start + anyone : start + anyone + 1] in {("is",), ("are",)}:
        end = start + anyone + 1
        end += flat[end : end + 1] == ("there",)
        return Echo(end - at, holds != bool(none), "present")
    return None


def _being(flat: tuple[str, ...], at: int, end: int, holds: bool, *, there: bool) -> Echo:
    """Behind "if it is", "if there are"."""
    kind = "state"
    while end < len(flat) and flat[end] in _DENIALS | _FILLERS | _GONE:
        if flat[end] == "then":
            break
        if there and (flat[end] in _ANYBODY | {"nobody"} or flat[end : end + 2] == ("no", "one")):
            kind = "present"
        elif kind == "state" and flat[end] in _GONE | {"there"}:
            kind = "found"
        # "Gone missing" says it once.
        gone = flat[end] in _GONE and flat[end - 1] not in _GONE
        holds = holds != (gone or flat[end] in _DENIALS)
        end += 1 + (flat[end : end + 2] == ("no", "one"))
    kind = "there" if there and kind == "state" else kind
    if flat[end : end + 2] == ("any", "more") or flat[end : end + 1] in {("anymore",), ("either",)}:
        end += 1 + (flat[end] == "any")
    return Echo(end - at, holds, kind)


def _finding(flat: tuple[str, ...], at: int, end: int, holds: bool) -> Echo | None:
    """Behind "if you": "find one", "cannot see it there", "don't"."""
    start = end
    while end < len(flat) and flat[end] in _HELPING | {"not"}:
        holds = holds != (flat[end] == "not")
        end += 1
    if end < len(flat) and flat[end] in FINDING:
        thing = flat[end + 1] if end + 1 < len(flat) else ""
        if thing not in _AGAIN | _NONE_AGAIN:
            return None
        holds = holds != (thing in _NONE_AGAIN)
        end += 2
        found = phrases("where_again").match(flat, end)
        return Echo(end + (found[0] if found is not None else 0) - at, holds, "found")
    return (
        Echo(end - at, holds, "found")
        if end > start and flat[end - 1] in {"do", "can", "not", "did"}
        else None
    )


def _alone(flat: tuple[str, ...], at: int, *, answers: bool) -> Echo | None:
    """For "yes" and "no" where a question was asked."""
    if not answers or flat[at] not in {"yes", "then", "no"}:
        return None
    return Echo(1, flat[at] != "no", "answer")


def _ends(
    words: Phrase, end: int, flat: tuple[str, ...], found: Echo, opens: Callable[[Phrase], bool]
) -> bool:
    """Whether nothing more of a condition follows ("if it is open" says something of its own)."""
    if end >= len(flat) or flat[end] in _MARKS | _JOINTS:
        return True
    if found.kind in {"else", "answer"} or flat[end - 1] in {"so", "yes", "case"}:
        return True
    behind = set(flat[end + 1 : end + 2])
    if (
        (flat[end] in STATES and not behind & (lexicon().determiners | _AGAIN))
        or lemma(flat[end]) != flat[end]
        or (found.kind == "there" and flat[end - 1] in _HOLDING)
    ):
        return False
    if found.kind == "there" and (flat[end - 1] == "no" or (flat[end - 1] == "any" and _is_thing(flat, end))):
        # "There is no water in the tank": no verb.
        return False
    noun = flat[end + 1 : end + 2] in {(",",), ("then",)} or flat[end - 1] == "there"
    return opens(words[end:]) and not (noun and found.kind in {"state", "there"})


def _is_thing(flat: tuple[str, ...], at: int) -> bool:
    """Whether a word that may be a verb is a thing there: "(any) water in the tank", "(any) water left"."""
    found = lexicon().verbs.match(flat, at)
    behind = flat[at + 1 : at + 2]
    placed = behind in {("left",), (",",), ()} or lexicon().places.match(flat, at + 1) is not None
    return found is not None and found[1].startswith("other") and placed
