"""A message read by what the robot offers: which of its actions every part of it asks for, and in what order.

A message is cut wherever a part may end, and of all ways to put the pieces together again the one is taken
in which an action explains every piece best, with all its inputs. What is said about when each is due
("before all that", "last", "B once you have done A") are constraints that are solved once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.spoken import Names
from parley.language.offline.tasks.commands import read_command
from parley.language.offline.tasks.matching import Match
from parley.language.offline.tasks.parts import map_spans
from parley.language.offline.tasks.roles import parameter_role
from parley.language.offline.tasks.signature import STATES
from parley.language.offline.tasks.tasks import Tasks
from parley.language.offline.words.concepts import LIGHT_VERBS
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.order import due
from parley.language.offline.words.text import Phrase, Word, keys, lemma, tokens
from parley.language.word_lists import load_data

__all__ = ["Asked", "asked_of_catalogue"]

_DATA = load_data("offering")
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_CUTS = frozenset({",", "and", "but", "then", "plus", "also", "so", "before", "after", "once", "when"})
_JOINTS = frozenset({",", "and", "but", "then", "plus", "also", "so", "&", ":"})
_MOST_CUTS, _MOST_WORDS = 9, 90
_LONGEST = 4
"""How many stretches between cuts one order may have."""
_LONG_STORY = 14
_LONGEST_ORDER = 18
"""Words of what only tells and is not looked through, and of one order at most."""
_ORDINARY = frozenset(
    {"motion", "look", "whether", "search", "back", "dock", "follow", "grasp", "speak", "guide"}
)
_PLAIN_ORDER = 1.5
"""What a piece counts that a common kind of task explains."""
_ASIDE = -0.5
"""What it counts that a piece is passed over because it only tells something."""
_TELLING = lexicon().person_pronouns | lexicon().thing_pronouns | lexicon().determiners | {"there", "we", "i"}
_LEAST = 0.7
"""How like the verb of an action what is said has to be, where only its description tells more."""
_SEVERAL = 2
_STOP = Word(".", ".")
_UNSAID = frozenset(_DATA["unsaid"])


@cache
def _table(kind: str) -> PhraseTable:
    listed = _DATA[kind]
    return PhraseTable.of([one for line in listed for one in (line if isinstance(line, list) else [line])])


_DUE = {
    "early": ("early", "opening", "beginning"),
    "earlier": ("earlier",),
    "ahead": ("opening", "earlier", "early"),
    "late": ("late", "closing", "kept", "ending", "arriving"),
    "between": ("between",),
    "following": ("following", "next", "counting", "next_thing"),
}


def _due(kind: str) -> PhraseTable:
    return due(*_DUE[kind])


@dataclass(frozen=True, slots=True)
class _Piece:
    """One order of a message."""

    words: Phrase
    score: float
    match: Match | None = None
    when: str = ""
    """What is said about when it is due."""
    hangs: str = ""
    """Whether it is named only to say what comes "before" or "after" it."""
    changed: bool = False
    """Whether it was put in other words than it is said."""
    sentence: int = 0
    named: bool = False
    """Whether it only names a place."""
    told: bool = False
    """Whether it is no order, and only tells something around them."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What a message asks for, by what the robot offers."""

    words: Phrase
    """The orders in the order of doing, each one plainly."""
    own: bool
    """Whether any of them is for an action of a kind of its own."""
    ranked: bool
    """Whether anything is said about when one of them is due."""


def asked_of_catalogue(words: Phrase, tells: Callable[[Phrase], bool], scene: Scene) -> Asked | None:
    """The orders of a message in the order of doing, each one plainly; None unless all of them are plain.

    Args:
        words: All words and punctuation.
        tells: Whether a sentence only tells something, and may be left out.
        scene: What is known.
    """
    if scene.situation.queue or len(words) > _MOST_WORDS:
        return None
    reading = _Cutting(scene, tells)
    pieces: list[_Piece] = []
    skipped = False
    sentences = list(_sentences(words))
    for number, sentence in enumerate(sentences):
        story = len(sentences) > 1 and len(sentence) > _LONG_STORY and tells(sentence)
        found = None if story else reading.pieces(sentence)
        if found is None:
            if story or tells(sentence):
                skipped = True
                continue
            return None
        aside = any(piece.told for piece in found)
        pieces += [
            replace(piece, sentence=number, changed=piece.changed or aside)
            for piece in found
            if not piece.told
        ]
    own = any(piece.match is not None for piece in pieces)
    ranked = any(piece.when or piece.hangs for piece in pieces)
    if not (own or (ranked and not skipped)) or (len(pieces) < 2 and not pieces[0].changed):
        return None
    if len({keys(piece.words) for piece in pieces}) < len(pieces):
        return None
    ordered = _in_order(pieces)
    said = _resolved(pieces, ordered)
    return Asked(tuple(word for piece in ordered for word in (*said[id(piece)], _STOP)), own, ranked)


def _sentences(words: Phrase) -> Iterator[Phrase]:
    start, quoted = 0, False
    for index, word in enumerate(words):
        quoted ^= word.key == '"'
        if word.key in _MARKS and not quoted:
            if index > start:
                yield words[start:index]
            start = index + 1
    if start < len(words):
        yield words[start:]


class _Cutting:
    """Cuts sentences into orders."""

    def __init__(self, scene: Scene, tells: Callable[[Phrase], bool]) -> None:
        self.scene, self.tells = scene, tells
        self.tasks = Tasks(scene)
        self.is_stop = Names(scene).is_stop
        self.known: dict[tuple[str, ...], _Piece | None] = {}

    def pieces(self, sentence: Phrase) -> list[_Piece] | None:
        """The orders of a sentence; None if any of it is no order."""
        cuts = _cuts(sentence)
        if len(cuts) > _MOST_CUTS:
            return None
        best: list[tuple[float, list[_Piece]] | None] = [(0.0, [])] + [None] * (len(cuts) - 1)
        for end in range(1, len(cuts)):
            for start in range(max(0, end - _LONGEST), end):
                before = best[start]
                if before is None:
                    continue
                part = sentence[cuts[start] : cuts[end]]
                piece = self._piece(part, first=start == 0)
                if piece is None or piece.named or part[-1].key in STATES:
                    piece = self._alike(part, before[1]) or piece
                piece = piece or self._aside(
                    part, marked="," in keys((*sentence[: cuts[start]][-1:], part[-1]))
                )
                if piece is None:
                    continue
                score = before[0] + piece.score
                here = best[end]
                if here is None or score > here[0]:
                    best[end] = score, [*before[1], piece]
        whole = best[-1]
        orders = [piece for piece in whole[1] if not piece.told] if whole is not None else []
        if len(orders) > 1 and orders[0].named and not (orders[0].when or orders[1].named):
            # "The desk and the shelf need dusting".
            return None
        return whole[1] if whole is not None and any(not piece.hangs for piece in orders) else None

    def _piece(self, words: Phrase, *, first: bool) -> _Piece | None:
        """What one stretch of a sentence asks for; None if that is not plain."""
        core, when, hangs = _framed(words, first=first)
        if not core or len(core) > _LONGEST_ORDER or _UNSAID & set(keys(core)):
            return None
        flat = keys(core)
        if flat not in self.known:
            self.known[flat] = self._in_one(core) or self._order(core, hangs=hangs)
        found = self.known[flat]
        return None if found is None else replace(found, when=when, hangs=hangs)

    def _in_one(self, core: Phrase) -> _Piece | None:
        """For "start it at 40 degrees, no spin": one order, where an action explains all of it."""
        words = tuple(word for word in core if word.key != ",")
        match = self._match(words) if len(words) < len(core) and not _JOINTS & set(keys(words)) else None
        if match is None or not match.verb_first or match.filled.left or len(match.filled.values) < _SEVERAL:
            return None
        return _Piece(words, 1.0 + match.score, match, changed=True)

    def _alike(self, part: Phrase, pieces: Sequence[_Piece]) -> _Piece | None:
        """For "open A halfway and B wide": the deed before once more, with all inputs said anew."""
        last = pieces[-1] if pieces else None
        core, when, hangs = _framed(part, first=False)
        if last is None or last.match is None or hangs or not core or (_JOINTS | _UNSAID) & set(keys(core)):
            return None
        tells = core[0].key in _TELLING - lexicon().determiners or _LINKS & set(keys(core))
        opened = last.match.verb_first or last.words[0].key in LIGHT_VERBS
        if not opened or opens_command(core, self.scene.catalogue.verbs) or tells:
            return None
        said = set(last.match.filled.values)
        if not said or any(parameter_role(name) == "text" for name in said):
            return None
        values = {word for phrase in last.match.filled.phrases.values() for word in phrase}
        explained = (word for i, word in enumerate(last.words) if i in last.match.explained)
        named = tuple(word for word in explained if word not in values)
        told = tuple(word for word in named if word.key not in STATES)
        for lead in filter(None, (told, named, (last.words[0], *told), last.words[:1])):
            match = self._match((*lead, *core))
            if match is not None and match.info is last.match.info and set(match.filled.values) == said:
                return _Piece((*lead, *core), 1.0 + match.score, match, when=when, changed=True)
        return None

    def _aside(self, words: Phrase, *, marked: bool) -> _Piece | None:
        """What only tells something behind a comma or before one ("..., it is far too loud")."""
        core = _stripped(words)
        subject = bool(core) and (core[0].key in _TELLING or bool(lexicon().be & set(keys(core[1:3]))))
        if not (marked and subject) or len(core) <= _SEVERAL or not self.tells(core):
            return None
        return _Piece(core, _ASIDE, told=True)

    def _order(self, core: Phrase, *, hangs: str) -> _Piece | None:
        if self.is_stop(core):
            return _Piece((*tokens("go to"), *core), _PLAIN_ORDER, changed=True, named=True)
        others = _plainer(core, hangs=hangs)
        found = [
            _Piece(words, 1.0 + match.score, match, changed=keys(words) != keys(core))
            for words in dict.fromkeys((*others, core) if hangs else (core, *others))
            if (match := self._match(words)) is not None
        ]
        for piece in found:
            if piece.match is not None and piece.match.verb_first:
                return piece
        if _JOINTS & set(keys(core)):
            return None
        if found:
            return found[0]
        command = read_command(core, self.scene.is_person)
        ordinary = command is not None and command.kind in _ORDINARY and not command.negated
        if not ordinary or command is None or not self._can(command.kind):
            return None
        named = [phrase for phrase in (command.place, command.theme) if phrase]
        grounded = bool(map_spans(core, self.scene)) or not self.scene.objects
        grounded = grounded or any(self.scene.ground(phrase).outcome != "none" for phrase in named[:1])
        return _Piece(core, _PLAIN_ORDER) if named and grounded else None

    def _match(self, words: Phrase) -> Match | None:
        """The action that explains an order wholly."""
        match = self.tasks.own_match(words, weak=True)
        if match is None:
            return None
        if not match.strong:
            several = len(match.filled.values) >= _SEVERAL
            all_said = (
                several and words[0].key in LIGHT_VERBS and match.filled.exact and not match.filled.left
            )
            if not (match.complete and match.filled.values and (match.verb_first or all_said)):
                return None
            if match.verb < _LEAST and not several:
                return None
        return match if _whole(match) else None

    def _can(self, kind: str) -> bool:
        role = {"whether": "look", "back": "motion"}.get(kind, kind)
        return self.scene.catalogue.with_role(role) is not None


def _whole(match: Match) -> bool:
    """Whether nothing is missing and nothing is left over."""
    return not match.filled.missing and not match.filled.numbers_left and match.plain


def _cuts(sentence: Phrase) -> list[int]:
    """Where a part may begin, both ends included."""
    found, quoted = [0], False
    for index, word in enumerate(sentence):
        quoted ^= word.key == '"'
        if quoted or not index:
            continue
        joined = sentence[index - 1].key in _JOINTS and word.key not in _JOINTS
        begins = word.key in _CUTS - _JOINTS and sentence[index - 1].key not in _JOINTS
        if joined or begins:
            found.append(index)
    return [*found, len(sentence)]


def _framed(words: Phrase, *, first: bool) -> tuple[Phrase, str, str]:
    """An order without what is said about when it is due; and that, and on what it hangs."""
    words = _stripped(words)
    when = hangs = ""
    while words:
        flat = keys(words)
        if flat[0] == "first" and len(words) > 1 and not first:
            when, words = "ahead", _stripped(words[1:])
            continue
        if flat[0] == "first" and len(words) > 1:
            words = _stripped(words[1:])
            continue
        found = next(
            (
                (kind, m[0])
                for kind in ("early", "earlier", "late", "between", "following")
                if (m := _due(kind).match(flat))
            ),
            None,
        )
        if found is not None and found[1] < len(words) and not _names_number(found[0], words, found[1]):
            when, words = (found[0] if found[0] != "following" else when), _stripped(words[found[1] :])
            continue
        break
    words, behind = _behind(words)
    when = behind or when
    flat = keys(words)
    for kind in ("after", "before"):
        marker = _table(kind).match(flat)
        if marker is not None and marker[0] < len(words):
            hangs, words = kind, _stripped(words[marker[0] :])
            break
    return words, when, hangs


def _names_number(kind: str, words: Phrase, size: int) -> bool:
    """Whether "second" and the like belong to a name."""
    return kind == "following" and words[size].key in {"floor", "row", "one", "from"}


def _behind(words: Phrase) -> tuple[Phrase, str]:
    """Without when it is due, said behind it."""
    for size in range(min(4, len(words) - 1), 0, -1):
        tail = keys(words[-size:])
        for kind in ("early", "earlier", "ahead", "late", "between", "following"):
            found = _due(kind).match(tail)
            if (
                found is not None
                and found[0] == size
                and (tail[0] not in {"start", "begin", "finish", "end"})
            ):
                rest = _stripped(words[:-size])
                return rest, "" if kind == "following" else kind
    return words, ""


def _stripped(words: Phrase) -> Phrase:
    """Without joining words and courtesy at both ends."""
    around = _table("around")
    while words:
        if not words[0].is_word and words[0].key != '"':
            words = words[1:]
            continue
        found = around.match(keys(words))
        if found is None or found[0] >= len(words):
            break
        words = words[found[0] :]
    while words and (
        (not words[-1].is_word and words[-1].key != '"')
        or (words[-1].key in {"please", "too", "also", "and", "but", "then", "thanks", "now", "so"})
    ):
        words = words[:-1]
    return words


def _plainer(core: Phrase, *, hangs: str) -> list[Phrase]:
    """Other ways to put an order: without its subject, its verb in the base form, a passive as active."""
    found: list[Phrase] = []
    done = _table("done").match(keys(core))
    rest = core[done[0] :] if done is not None and done[0] < len(core) else core
    base = lemma(rest[0].key) if rest else ""
    if keys(rest[:2]) in {("been", "to"), ("been", "at"), ("been", "in")}:
        found.append((*tokens("go to"), *rest[2:]))
    elif rest and (done is not None or (base != rest[0].key and (hangs or rest[0].key.endswith("ing")))):
        found.append((Word(base, base), *rest[1:]))
        found.append(rest)
    flat = keys(core)
    link = next((i for i in range(1, len(flat)) if flat[i] in _LINKS), 0)
    at = link
    while at and at < len(flat) and flat[at] in _LINKS | _BETWEEN_LINKS:
        at += 1
    told = not hangs and flat[link] in {"is", "are"} and at == link + 1
    if link and at < len(flat) and not told:
        # "The gate is closed" does not ask for it to be closed, "the gate must be closed" does.
        verb = lemma(flat[at])
        if verb != flat[at] or flat[at - 1] in {"be", "been"}:
            tail = core[at + 1 :]
            found.append((Word(verb, verb), *core[:link], *tail))
            found.append((Word(verb, verb), *tail, *core[:link]))
    done_at = next((i for i in range(1, len(flat)) if not link and _is_done(flat[i])), 0)
    if done_at:
        verb = lemma(flat[done_at])
        found.append((Word(verb, verb), *core[:done_at], *core[done_at + 1 :]))
        found.append((Word(verb, verb), *core[done_at + 1 :], *core[:done_at]))
    return found


def _is_done(word: str) -> bool:
    """Whether a word says that something was done to what stands before it ("the deck scrubbed")."""
    base = lemma(word)
    return base != word and not word.endswith(("s", "ing")) and lexicon().verbs.match((base,)) is not None


_LINKS = frozenset(
    {"is", "are", "has", "have", "should", "must", "needs", "need", "wants", "be", "ought", "can", "could"}
)
_BETWEEN_LINKS = frozenset({"to", "been", "being", "be", "now", "all", "also", "still"})


def _in_order(pieces: Sequence[_Piece]) -> list[_Piece]:
    """The orders in the order of doing."""
    result: list[_Piece] = []
    waiting: _Piece | None = None
    for piece in pieces:
        if piece.hangs:
            at = _place_of_hanging(piece, result)
            if at is None:
                waiting = piece
                result.append(piece)
            else:
                result.insert(at, piece)
            continue
        if waiting is not None and waiting.hangs == "before":
            result.insert(result.index(waiting), piece)
        else:
            result.insert(_place(piece, result, pieces), piece)
        waiting = None
    front = [piece for piece in result if piece.when == "early"]
    back = [piece for piece in result if piece.when == "late"]
    middle = [piece for piece in result if piece.when not in {"early", "late"}]
    return [*reversed(front), *middle, *back] if len(front) > 1 else [*front, *middle, *back]


def _place_of_hanging(piece: _Piece, result: Sequence[_Piece]) -> int | None:
    """Where what hangs on the order before it comes; None if it hangs on the one that follows."""
    last = next((i for i in range(len(result) - 1, -1, -1) if result[i].sentence == piece.sentence), None)
    if last is None or result[last].hangs:
        return None
    return last if piece.hangs == "after" else last + 1


def _place(piece: _Piece, result: Sequence[_Piece], pieces: Sequence[_Piece]) -> int:
    if piece.when not in {"earlier", "ahead"} or not result:
        return len(result)
    same = [i for i, other in enumerate(result) if other.sentence == piece.sentence]
    if same:
        return same[0] if piece.when == "ahead" else same[-1]
    number = max(other.sentence for other in result)
    return next(i for i, other in enumerate(result) if other.sentence == number)


def _resolved(pieces: Sequence[_Piece], ordered: Sequence[_Piece]) -> dict[int, Phrase]:
    """What each order says, with a name for "it" where what it stands for comes later now."""
    said: dict[int, Phrase] = {}
    for number, piece in enumerate(pieces):
        words = piece.words
        before = pieces[number - 1] if number else None
        moved = before is not None and list(ordered).index(piece) < list(ordered).index(before)
        if moved and before is not None and before.match is not None:
            words = _named(words, piece, before.match)
        said[id(piece)] = words
    return said


def _named(words: Phrase, piece: _Piece, match: Match) -> Phrase:
    """With what another order is about for "it"; what an input of the same name takes, if there is one."""
    takes = piece.match.info.inputs if piece.match is not None else {}
    said = {name: p for name, p in match.filled.phrases.items() if parameter_role(name) != "text"}
    things = [said[name] for name in said if name in takes] or list(said.values())
    flat = keys(words)
    at = next((i for i, word in enumerate(flat) if word in {"it", "them", "there"}), -1)
    if at < 0 or not things or flat[at - 1 : at] == ("of",):
        return words
    thing = things[0]
    article = () if thing[0].key in lexicon().determiners or thing[-1].key.isdigit() else tokens("the")
    place = tokens("at") if flat[at] == "there" else ()
    return (*words[:at], *place, *article, *thing, *words[at + 1 :])
