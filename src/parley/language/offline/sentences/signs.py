"""Signs by which the parts of a message are told apart: where an order, a condition, something told begins.

Nothing is looked up but whether words name a thing on the map, and which verbs there are.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.sentences.talk import introduces, is_talk
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.order import phrases_due
from parley.language.offline.words.text import Phrase, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["BE", "HELPING", "JOINTS", "LEADING", "MARKS", "OPEN", "REASONS", "Kind", "Signs", "spans"]

IsStop = Callable[[Phrase], bool]
Opens = Callable[[Phrase], bool]
Kind = str
"""`order`, `wish`, `name`, `told`, `asked`, `reason`, `condition`, `who` (is speaking), `mood` or `idle`."""

MARKS = frozenset({".", "!", "?", ";", "\n", "(", ")"})

_DATA = load_data("units")
JOINTS = frozenset(_DATA["joints"])
REASONS = PhraseTable.of(_DATA["reasons"])
_CONDITIONS = PhraseTable.of(_DATA["conditions"])
LEADING = PhraseTable.of(
    [
        *_DATA["leading"],
        *phrases_due(
            "early",
            "opening",
            "earlier",
            "late",
            "closing",
            "following",
            "next",
            "counting",
            "between",
            "back",
        ),
    ]
)
_IDLE = PhraseTable.of(_DATA["idle"])
_PAST = frozenset(_DATA["past"])
_PRESENT = frozenset(_DATA["present"])
_SUBJECTS = frozenset(_DATA["subjects"])
_PRESENT_OF_SEVERAL = frozenset(lemma(word) for word in _PRESENT) - {
    "need",
    "want",
    "has",
    "do",
    "does",
    "check",
}
OPEN = frozenset(_DATA["open"])
_RANKS = frozenset(_DATA["ranks"])
_TAGS = frozenset(tuple(text.split()) for text in _DATA["tags"])
_NO_DEEDS = PhraseTable.of(_DATA["no_deeds"])
_SAME = PhraseTable.of(_DATA["same"])
_BEFORE_SAME = frozenset(
    {",", ":", "and", "for", "do", "with", "is", "gets", "wants", "needs", "checking", "please"}
)
_AT_PLACES = frozenset({"at", "in", "for", "with", "by", "on", "to", "over"})
_BEHIND_SAME = frozenset({",", ".", "and", "please", "there", "then", "again", "but", "so", "!", "?", ";"})
BE = frozenset({"is", "are", "was", "were", "am"})
HELPING = frozenset({
    "has", "have", "had", "do", "does", "did", "will", "would", "can", "could", "must", "should", "may",
    "might", "ought",
})  # fmt: skip
_STRONG = frozenset({
    "motion", "back", "look", "whether", "search", "transfer", "grasp", "place", "speak", "follow", "guide",
    "meet", "count", "dock", "wait", "ask", "answer",
})  # fmt: skip
_POINTING = frozenset({
    "it", "them", "there", "here", "him", "her", "me", "us", "back", "whether", "if", "everything",
    "around", "straight", "over", "up", "for", "everybody", "everyone", "somebody", "each", "every", "both",
    "all", "any", "to", "into", "what", "who", "how", "where", "that", "those", "these",
})  # fmt: skip
_FRAME = re.compile(
    r"(?:so )?"
    r"(?:(?:(?:i|we) (?:(?:would|will|do|am|are|was|were|just|really|also|only|must|have|to|going|not) )*"
    r"(?:like|love|need|want|prefer|expect|ask|asking|wondering|wonder|hoping|hope|wish|appreciate|beg|"
    r"grateful|glad|happy|suggest|propose|request|mind)"
    r"(?: it| if| whether| that| for| perhaps| maybe)* )?"
    r"(?:(?:can|could|would|will|may|might|should|do) )?you"
    r"(?: (?:can|could|would|will|may|might|should|must|to|have(?= to| got to)|need(?= to)|ought|had|better|"
    r"please|just|then|also|perhaps|maybe|kindly|possibly|quickly|first|now|mind|be|able|so|kind|as|gonna|"
    r"going|are|think|still|free(?= to)|welcome(?= to)|allowed(?= to)))*"
    r"|let us|why do not you|how about you"
    r"|the robot(?: first| then| now)? (?:is to|shall|should|must|will|has to|needs to|is supposed to)"
    r"(?: first| then)?"
    r"|(?:your|the) (?:\w+ )?(?:job|task|mission|order|next thing)(?: \w+)? is to"
    r"|(?:i|we) (?:just |only |really |also )*(?:need|want|would like|would love|have) to"
    r"(?= (?:know|see|check|find|make sure))) "
)
_LONGEST_NAME = 6
_LONGEST_SUBJECT = 9
_LONGEST_TALK = 14
_UNDECIDED: tuple[str, str] = ("", "")


def spans(words: Phrase, is_stop: IsStop) -> list[tuple[int, int]]:
    """Where things on the map are named, longest names first, in their order."""
    found: list[tuple[int, int]] = []
    index = 0
    while index < len(words):
        sizes = range(min(_LONGEST_NAME, len(words) - index), 0, -1)
        end = next((index + size for size in sizes if is_stop(words[index : index + size])), index)
        if end > index:
            found.append((index, end))
        index = max(end, index + 1)
    return found


@dataclass
class Signs:
    """The words of a message, and what may begin at each of them."""

    words: Phrase
    is_stop: IsStop
    opens: Opens
    flat: tuple[str, ...] = field(init=False)
    found: list[tuple[int, int]] = field(init=False)
    named: frozenset[int] = field(init=False)
    """The words that are part of a name."""
    begun: frozenset[int] = field(init=False)
    talk: dict[tuple[int, int], tuple[Kind, str] | None] = field(init=False, default_factory=dict)
    """Which parts were looked at already."""

    def __post_init__(self) -> None:
        self.flat = keys(self.words)
        self.found = spans(self.words, self.is_stop)
        self.named = frozenset(i for start, end in self.found for i in range(start, end))
        self.begun = frozenset(start for start, _ in self.found)

    def _order_behind(self, index: int, end: int) -> bool:
        return any(self._order_at(i, end) >= 0 for i in range(index + 2, end))

    def _strong(self, index: int) -> bool:
        return self.flat[index - 1] not in OPEN

    def _clearly(self, verb: int) -> bool:
        """Whether nothing but an order can be meant by the verb here."""
        found = lexicon().verbs.match(self.flat, verb)
        if found is None or found[1].partition(":")[0] not in _STRONG:
            return False
        behind = verb + found[0]
        rest = self.flat[behind : behind + 1]
        if not rest or found[0] > 2:
            return found[0] > 1
        look = lexicon().verbs.match(self.flat, behind)
        if (
            self.flat[verb] in _SERIAL
            and look is not None
            and look[1].startswith(("look:", "whether:", "search:"))
        ):
            return True
        if rest[0] == "and":
            return self.flat[verb] in _SERIAL and self._order_at(behind + 1, len(self.flat)) >= 0
        return rest[0] in lexicon().determiners | _POINTING or behind in self.named

    def _behind_leading(self, index: int) -> int:
        """Past what stands in front of an order."""
        while index < len(self.flat):
            sizes = [t.match(self.flat, index) for t in (LEADING, _IDLE)]
            size = max((found[0] for found in sizes if found is not None), default=0)
            if not size and not self.words[index].is_word:
                size = 1
            if not size or index + size > len(self.flat):
                return index
            index += size
        return index

    def _conditional(self, index: int) -> bool:
        return _CONDITIONS.match(self.flat, index) is not None

    def _order_at(self, index: int, end: int) -> int:
        """Where the verb of an order stands that begins here; -1 if none does."""
        at = self._behind_leading(index)
        if at >= end or self.flat[at] in MARKS:
            return -1
        if self._participial(at, end):
            return at
        framed = self._frame_end(at, end)
        if framed < end and self._doing(framed):
            return framed
        if framed < end and self._commands(framed, framed > at, first=framed == at > index):
            return framed
        return -1

    def _wanted_at(self, at: int) -> bool:
        """For "(I need you) at the desk"."""
        link = at + (self.flat[at] in {"over", "down", "up", "back"})
        places = {"at", "in", "by", "near", "on", "outside"}
        return (
            self.flat[at - 1] == "you"
            and self.flat[link : link + 1] != ()
            and (self.flat[link] in places and link + 1 in self.begun)
        )

    def _doing(self, at: int) -> bool:
        """For "(would you mind) going there"."""
        word = self.flat[at]
        asked = at > 1 and self.flat[at - 1] == "mind" and self.flat[at - 2] in {"you", "not"}
        found = lexicon().verbs.match((lemma(word), *self.flat[at + 1 : at + 5]))
        return bool(asked and word.endswith("ing") and found is not None)

    def _participial(self, at: int, end: int) -> int:
        """For "(I want) the desk checked": where the verb stands; 0 if there is none."""
        start = at
        if self.flat[at : at + 1] in {("i",), ("we",)} and self.flat[at + 1 : at + 2] in {
            ("want",),
            ("need",),
        }:
            start = at + 2
        stop = next((b for a, b in self.found if a == start), 0)
        if not stop or stop >= end or not self.flat[stop].endswith("ed"):
            return 0
        base = lemma(self.flat[stop])
        found = lexicon().verbs.match((base, *self.flat[stop + 1 : end]))
        after = self.flat[stop + found[0] : stop + found[0] + 1] if found is not None else ()
        ends = after in {(), (",",), (".",), ("and",), ("please",), ("too",), ("first",), ("again",)}
        return stop if found is not None and found[1].startswith("look:") and ends else 0

    def _frame_end(self, at: int, end: int) -> int:
        text = " ".join(self.flat[at : min(end, at + 16)]) + " "
        found = _FRAME.match(text)
        skipped = at + found.group().count(" ") if found is not None else at
        doing = next((i for i in range(at + 2, min(skipped + 1, end)) if self._doing(i)), 0)
        if doing:
            return doing
        asked = strip_openers(self.words[skipped:end], requests=True)
        return end - len(asked) if asked and self._asks(asked, skipped, end) else skipped

    def _asks(self, asked: Phrase, skipped: int, end: int) -> bool:
        return len(asked) < end - skipped and self.opens(asked)

    def _commands(self, at: int, framed: bool, *, first: bool) -> bool:
        """Whether a verb in its base form stands here, as an order."""
        word = self.flat[at]
        if framed and self._wanted_at(at):
            return True
        if _NO_DEEDS.match(self.flat, at) is not None:
            return False
        before = self.flat[at - 1] if at and not first else ""
        if at in self.named or lemma(word) != word or before in lexicon().determiners | {"to"}:
            return framed and lemma(word) == word and self.opens(self.words[at : at + 6])
        if word in {"do", "not"} and self.flat[at : at + 2] in {("do", "not"), ("not", "to")}:
            about = self.flat[at + 2 : at + 4] == ("worry", "about")
            verb = self.flat[at + 2 : at + 3]
            return about or verb not in {("know",), ("have",), ("mind",), ("worry",), ()}
        if not self.opens(self.words[at : at + 8]):
            return False
        found = lexicon().verbs.match(self.flat, at)
        if word in {"know", "see", "mean", "remember"} and framed and self.flat[at - 1] == "you":
            return word == "see" and self.flat[at + 1 : at + 2] not in {(",",), ()}
        if framed and word in _FOUND and self.flat[at - 2] == "you" and self.flat[at - 1] in HELPING:
            # "You will find the keys in the drawer" tells where they are.
            return False
        if found is None or found[1].startswith("other:"):
            behind = at + (found[0] if found is not None else 1)
            rest = self.flat[behind : behind + 1]
            return (
                framed
                or bool(rest and (rest[0] in lexicon().determiners | _POINTING))
                or behind in self.named
            )
        finite = self.flat[at + found[0] : at + found[0] + 1]
        return not (finite and finite[0] in BE | {"has", "was"})

    def _told(self, index: int, end: int) -> bool:
        """Whether a subject with its finite verb stands here."""
        at = index
        while at < end - 1 and self.flat[at] in {"then", "and", "but", "also"}:
            at += 1
        if self.flat[at] == "to":
            return False
        if self.flat[at] in lexicon().question_starts or self.flat[at] in BE | HELPING:
            return False
        if self.flat[at] == "you":
            modal = self.flat[at + 1 : at + 2] in _MODALS and self.flat[at + 2 : at + 3] in _FINDING
            return modal or self.flat[at + 1 : at + 2] in _YOU_TOLD
        if self.flat[at] in {"that", "this", "these", "those"} and self.flat[at - 1 : at] == (",",):
            verb, behind = self.flat[at + 1 : at + 2], self.flat[at + 2 : at + 3]
            return verb in {(word,) for word in BE | {"has", "will"}} and behind not in {("from",), ("to",)}
        stop = min(end, at + _LONGEST_SUBJECT)
        comma = next((i for i in range(at, stop) if self.flat[i] == ","), stop)
        if self.flat[at] in _SUBJECTS - {"some", "both", "all", "that", "this", "these", "those", "most"}:
            return self.flat[at + 1 : at + 2] not in {(",",), ("and",), ("or",), ()} and at + 1 < end
        return any(self._finite(i) for i in range(at + 1, comma)) or self._several_do(at, comma) > 0

    def _several_do(self, at: int, end: int) -> int:
        """For "the guests arrive at noon": where the verb of several stands; 0 if there is none."""
        if self.flat[at] not in _OURS:
            return 0
        for index in range(at + 2, min(at + 5, end)):
            before, verb = self.flat[index - 1], self.flat[index]
            plural = before.endswith("s") and not before.endswith("ss") and index - 1 not in self.named
            if plural and verb in _PRESENT_OF_SEVERAL:
                return index
        return 0

    def _finite(self, index: int) -> bool:
        word, before = self.flat[index], self.flat[index - 1]
        if index in self.named or before in lexicon().determiners or before in _NO_SUBJECT:
            return False
        if word in BE or word in HELPING - {"do", "have"} or word in _PRESENT:
            return True
        if word in {"do", "have"}:
            return before not in {"to", "and"}
        return (word in _PAST or (word.endswith("ed") and len(word) > 4)) and before not in {
            "be",
            "is",
            "are",
        }

    def _same_at(self, start: int, end: int) -> int:
        """Where the name ends in "then the desk, same thing"; 0 if nothing is put like that."""
        at = self._behind_leading(start)
        name = next((b for a, b in self.found if a == at or (a == at + 1 and self._small(at))), 0)
        if not name:
            return self._same_before(at, end)
        if name >= end:
            return 0
        behind = next((i for i in range(name, end) if self.flat[i] not in _BEFORE_SAME), end)
        same = _SAME.match(self.flat, behind)
        if same is None or behind + same[0] > end:
            return 0
        rest = self.flat[behind + same[0] : behind + same[0] + 1]
        return name if not rest or rest[0] in _BEHIND_SAME else 0

    def _same_before(self, at: int, end: int) -> int:
        """Where the name ends in "do the same at the desk"; 0 if nothing is put like that."""
        at += self.flat[at : at + 1] == ("do",)
        same = _SAME.match(self.flat, at)
        if same is None:
            return 0
        link = at + same[0]
        name = next((b for a, b in self.found if a == link + 1 and self.flat[link] in _AT_PLACES), 0)
        rest = self.flat[name : name + 1]
        return name if name and name <= end and (name == end or rest[0] in _BEHIND_SAME) else 0

    def _small(self, at: int) -> bool:
        return self.flat[at] in {"to", "at", "the", "on", "in", "into"}

    def _ranked(self, start: int, end: int) -> bool:
        """For "the desk comes first"."""
        left = {self.flat[i] for i in range(start, end) if i not in self.named}
        return (
            start in self.begun | {i - 1 for i in self.begun}
            and bool(left & _RANKING)
            and left <= _RANKS | _RANKING
        )

    def _numbered_stop(self, start: int, end: int) -> bool:
        """For "your first stop is the desk", "the desk is to be your first stop"."""
        rank = start + (self.flat[start] in {"your", "the"})
        ranked = self.flat[rank : rank + 1] and self.flat[rank] in _STOP_RANKS
        stop = self.flat[rank + 1 : rank + 2] and self.flat[rank + 1] in _STOPS
        if ranked and stop:
            return bool(self.named & set(range(rank + 2, end)))
        return (
            self.flat[end - 1] in _STOPS
            and self.flat[end - 2] in _STOP_RANKS
            and any(start <= a and b < end - 2 for a, b in self.found)
        )

    def _due(self, start: int, end: int) -> bool:
        """For "the desk has to be checked"."""
        flat = self.flat[start:end]
        at = flat.index("be") if "be" in flat else 0
        gets = next((i for i in range(1, len(flat)) if flat[i] in {"gets", "get"}), 0)
        at = at or gets
        done = flat[at + 1 : at + 2]
        modal = gets or {"must", "should", "needs", "need", "has", "have", "ought"} & set(flat[:at])
        return bool(modal and at and done and lemma(done[0]) != done[0] and flat[0] not in _PRONOUNS)

    def _only_names(self, index: int, end: int) -> bool:
        """Whether names and words of order are all that follows, up to the next comma."""
        stop = next((i for i in range(index, end) if self.flat[i] in {",", ":"}), end)
        left = [self.flat[i] for i in range(index, stop) if i not in self.named]
        return bool(self.named & set(range(index, stop))) and set(left) <= _RANKS

    def _kind(self, start: int, end: int) -> Kind:
        return self._label(start, end)[0]

    def _label(self, start: int, end: int) -> tuple[Kind, str]:
        """What a part of a message is, and why: the one place where that is decided."""
        at = self._behind_leading(start)
        talk = self._talk(start, at, end)
        if talk is not None:
            return talk
        if at >= end:
            return "idle", "nothing but small words"
        order = self._order_at(start, end)
        if order < 0 and any(REASONS.match(self.flat, i) is not None for i in range(start, at + 1)):
            return "reason", "begins as a reason"
        if order >= 0:
            return "order", f"“{self.flat[order]}” asks for something"
        if self._conditional(at):
            behind = self._order_behind(at, end)
            return ("order", "an order under a condition") if behind else ("condition", "nothing hangs on it")
        if self.flat[at] in lexicon().question_starts | BE | HELPING:
            return "asked", f"begins with “{self.flat[at]}”"
        if self._ranked(at, end) or self._numbered_stop(at, end):
            return "name", "says when a place comes"
        if self._told(at, end):
            waits = {"until", "till"} & set(self.flat[at:end]) and "wait" in self.flat[at:end]
            wish = _WISHING & set(self.flat[at + 1 : at + 6]) or self._due(at, end) or waits
            return ("wish", "says what is needed") if wish else ("told", "a subject with its verb")
        if self._only_names(at, end) or self._mostly_names(at, end):
            return "name", "little but names"
        return "idle", "no order, no statement"

    def _talk(self, start: int, at: int, end: int) -> tuple[Kind, str] | None:
        """What is said around orders and has nothing to do with them."""
        if not 0 < end - start <= _LONGEST_TALK + 2 or self.named & set(range(start, at)):
            return None
        found = self.talk.get((start, end), _UNDECIDED)
        if found is not _UNDECIDED:
            return found
        kept = [i for i in (start, at) if i < end]
        trimmed = [self.words[i:end] for i in dict.fromkeys(kept)]
        decided: tuple[Kind, str] | None = None
        if self.flat[end : end + 1] == ("?",) and start and self.flat[start:end] in _TAGS:
            self.talk[start, end] = ("mood", "asks whether it was understood")
            return self.talk[start, end]
        if end - start > 1 and any(introduces(words, first_is_thing=at in self.begun) for words in trimmed):
            decided = "who", "says who is speaking"
        elif (
            not self.named & set(range(start, end))
            and any(is_talk(words) for words in trimmed)
            and not self._order_behind(start, end)
        ):
            decided = "mood", "said to the listener, nothing is asked for"
        self.talk[start, end] = decided
        return decided

    def _mostly_names(self, start: int, end: int) -> bool:
        left = [
            i for i in range(start, end) if i not in self.named and self.flat[i] not in _RANKS | {",", ":"}
        ]
        return start in self.begun and len(left) <= 2


_MODALS = frozenset((word,) for word in _DATA["modals"])
_FINDING = frozenset((word,) for word in _DATA["finding"])
_YOU_TOLD = frozenset((word,) for word in _DATA["you_told"])
_FOUND = frozenset(_DATA["finding"])
_RANKING = frozenset({"comes", "goes", "is", "are", "come", "go", "follows", "should", "be", "must"})
_WISHING = frozenset({"wants", "needs"})
_NO_SUBJECT = frozenset({
    "to", "you", "that", "which", "for", "of", "with", "without", "from", "about", "any", "no", "some",
    "many",
})  # fmt: skip
_OURS = frozenset(
    {
        "the",
        "our",
        "my",
        "your",
        "their",
        "his",
        "her",
        "some",
        "these",
        "those",
        "many",
        "most",
        "two",
        "three",
    }
)
_STOP_RANKS = frozenset({"first", "second", "third", "next", "last", "final"})
_STOPS = frozenset({"stop", "destination", "place", "port", "station"})
_PRONOUNS = frozenset({"i", "we", "you", "he", "she", "they", "it", "somebody", "someone", "people"})
_SERIAL = frozenset(
    {"go", "come", "run", "please", "just", "and", "head", "drive", "you", "now", "then", "hurry"}
)
