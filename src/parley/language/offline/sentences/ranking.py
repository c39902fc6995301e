"""Lists in an order that is said otherwise: "A first, B second", "A and B, ending at A"."""

from __future__ import annotations

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["all_of_those", "any_of_those", "named_first", "participle_order", "ranked", "ranked_stops"]

_RANKS = {
    "first": 1, "firstly": 1, "second": 2, "secondly": 2, "third": 3, "thirdly": 3, "fourth": 4, "fifth": 5,
    "next": 50, "afterwards": 50, "then": 50, "after": 50, "finally": 99, "lastly": 99, "last": 99,
}  # fmt: skip
_THEN = (Word(",", ","), Word("then", "then"))
_PAUSES = {",", "and", "but", "then"}


def _pieces(words: Phrase) -> list[Phrase]:
    """A list cut at commas and conjunctions."""
    pieces: list[list[Word]] = [[]]
    for word in words:
        if word.key in _PAUSES and not (word.key == "then" and not pieces[-1]):
            pieces.append([])
        elif word.is_word and word.key != "then":
            pieces[-1].append(word)
    return [tuple(piece) for piece in pieces if piece]


def ranked(words: Phrase) -> Phrase:
    """For "A first, B second, C last", "A and B, B first"."""
    body = words
    while body and not body[-1].is_word:
        body = body[:-1]
    flat = keys(body)
    if len(flat) < 5 or not set(flat) & {"first", "second", "last"} or set(flat) & {".", "?", "!", ";"}:
        return words
    pieces = _pieces(body)
    ranks = [_RANKS.get(piece[-1].key, 0) if len(piece) > 1 else 0 for piece in pieces]
    if (
        len(pieces) > 1
        and all(ranks[:2])
        and all(r or i > 1 for i, r in enumerate(ranks))
        and ranks != sorted(ranks)
    ) or (len(pieces) > 1 and ranks[0] == 1 and ranks[-1] > 1):
        return _in_order([p[:-1] if r else p for p, r in zip(pieces, ranks, strict=True)], ranks)
    if len(pieces) > 2 and ranks[-1] in {1, 99} and not any(ranks[:-1]):
        return _moved(pieces[:-1], pieces[-1][:-1], last=ranks[-1] == 99) or words
    return words


def all_of_those(words: Phrase) -> Phrase:
    """For "all A but B, please V them" "please V all A but B".

    Args:
        words: All words and punctuation.
    """
    flat = keys(words)
    end = next((i for i in range(len(flat)) if flat[i] in {".", "!", "?", ";", ":"}), len(flat))
    at = next((i for i in range(end) if flat[i] in _THOSE), 0)
    cut = next((i for i in range(at - 1, 0, -1) if flat[i] == ","), 0)
    if flat[:1] == () or flat[0] not in _ALL_OF or not cut or cut + 1 >= at:
        return words
    closed = lexicon().be | lexicon().auxiliaries
    opens = next((key for key in flat[cut + 1 : at] if key not in _ASKING), "")
    tells = closed & set(flat[:cut]) or opens in closed | _SUBJECTS or closed & set(flat[cut + 2 : at])
    if not opens or tells or flat[at + 1 : at + 2] in {("that",), ("which",), ("who",)}:
        return words
    return (*words[cut + 1 : at], *words[:cut], *words[at + 1 :])


_ALL_OF = frozenset({"all", "every", "each", "everything"})
_THOSE = frozenset({"them", "those", "these"})
_ASKING = frozenset({"please", "could", "can", "would", "will", "you", "kindly", "just"})
_SUBJECTS = frozenset(
    {"i", "we", "he", "she", "they", "it", "somebody", "someone", "nobody", "there", "to", "of"}
)


def any_of_those(words: Phrase) -> Phrase:
    """For "I do not care which A, just V one" "V any A".

    Args:
        words: All words and punctuation.
    """
    flat = keys(words)
    lead = next((len(m) for m in _CARELESS if flat[: len(m)] == m), 0)
    comma = next((i for i in range(lead + 1, min(len(flat), lead + 5)) if flat[i] in {",", ".", ";"}), 0)
    at = next((i for i in range(comma + 2, len(flat)) if flat[i] == "one"), 0) if lead and comma else 0
    if not at or any(word.is_word and word.key not in _AFTER_ONE for word in words[at + 1 : at + 2]):
        return words
    start = comma + 1
    while flat[start] in {"just", "so", "but", "simply", "please"}:
        start += 1
    return (*words[start:at], Word("any", "any"), *words[lead:comma], *words[at + 1 :])


_CARELESS = tuple(
    (*said, "which")
    for said in (
        ("i", "do", "not", "care"), ("i", "do", "not", "mind"), ("it", "does", "not", "matter"),
        ("no", "matter"), ("it", "is", "not", "important"), ("we", "do", "not", "mind"),
        ("we", "do", "not", "care"),
    )
)  # fmt: skip
_AFTER_ONE = frozenset({"and", "then", "please", "now", "for", "today"})


def named_first(words: Phrase) -> Phrase:
    """For "V A and B, the B first please, and then W" "V B, then V A. and then W"."""
    flat = keys(words)
    for at in range(5, len(flat)):
        comma = next((i for i in range(at - 2, max(at - 6, 3), -1) if flat[i] in {",", "."}), 0)
        behind = at + 1 + (flat[at + 1 : at + 2] == ("please",))
        ends = behind == len(flat) or not words[behind].is_word or flat[behind] in _NOT_LISTED
        if flat[at] not in {"first", "last"} or not comma or not ends:
            continue
        start = next((i + 1 for i in range(comma - 1, -1, -1) if flat[i] in {".", "!", "?", ";", ":"}), 0)
        named = tuple(word for word in words[comma + 1 : at] if word.key not in {"and", "but", "with"})
        end = comma - 2 if flat[comma - 2 : comma] == (",", "please") else comma
        members = _pieces(words[start:end])
        told = {"if", "when", "unless", "whether", "not", "then", "is", "before", "after"} & set(
            flat[start:end]
        )
        moved = (
            _moved(members, named, last=flat[at] == "last") if named and len(members) > 1 and not told else ()
        )
        if moved:
            return (*words[:start], *moved, *words[behind:])
    return words


_NOT_LISTED = frozenset({"and", "then", "because", "since", "so", "as"})
_COMING = frozenset({"comes", "goes", "is", "should", "be", "come", "will", "being"})
_MIDDLE = (("in", "the", "middle"), ("in", "between"), ("the", "middle", "one"))
_ALL_OF_THEM = frozenset({
    "go", "to", "all", "of", "them", "visit", "please", "these", "those", "each", "both", "in", "that",
    "order", "the", "two", "three", "four", "five", "do", "places", "stops", "rooms", "so", "now", "this",
})  # fmt: skip


def ranked_stops(words: Phrase) -> Phrase:
    """For "A comes last, B first, C in the middle. Go to all three." "go to B, then to C, then to A"."""
    flat = keys(words)
    end = next((i for i, key in enumerate(flat) if key in {".", "!", ":", ";"}), len(flat))
    if (
        not {"first", "last"} <= set(flat[:end])
        or opens_command(words)
        or not set(flat[end:]) <= (_ALL_OF_THEM | {".", "!", ":", ";"})
    ):
        return words
    pieces = [_plain_rank(piece) for piece in _pieces(words[:end])]
    ranks = [_RANKS.get(piece[-1].key, 0) if len(piece) > 1 else 0 for piece in pieces]
    told = any(opens_command(piece) or len(piece) > 6 for piece in pieces)
    if len(pieces) < 2 or not all(ranks) or told or ranks == sorted(ranks):
        return words
    go = (Word("go", "go"), Word("to", "to"))
    order = sorted(range(len(pieces)), key=lambda i: (ranks[i], i))
    return _joined([pieces[i][:-1] for i in order], go)


def _plain_rank(piece: Phrase) -> Phrase:
    """For "A comes last" "A last", for "A in the middle" "A next"."""
    flat = keys(piece)
    middle = next((m for m in _MIDDLE if flat[-len(m) :] == m and len(flat) > len(m)), ())
    if middle:
        piece = (*piece[: -len(middle)], Word("next", "next"))
    rank = piece[-1:]
    body = piece[:-1]
    while body and body[-1].key in _COMING:
        body = body[:-1]
    return (*body, *rank) if body else piece


def _in_order(pieces: list[Phrase], ranks: list[int]) -> Phrase:
    ranks = [rank or 50 for rank in ranks]
    order = sorted(range(len(pieces)), key=lambda i: (ranks[i], i))
    lead = _verb_of(pieces[0])
    pieces = [pieces[0][len(lead) :], *pieces[1:]]
    verb = lead or (Word("visit", "visit"),)
    return _joined([pieces[i] for i in order], verb)


def _joined(pieces: list[Phrase], verb: Phrase) -> Phrase:
    result: list[Word] = []
    for piece in pieces:
        result += _THEN if result else ()
        result += piece if opens_command(piece) and _verb_of(piece) else (*verb, *piece)
    return tuple(result)


def _verb_of(piece: Phrase) -> Phrase:
    """The verb at the start with its preposition: "go to" of "go to the desk"."""
    if not opens_command(piece):
        return ()
    found = lexicon().verbs.match(keys(piece))
    if found is None:
        return ()
    size = found[0]
    goal = lexicon().goals.match(keys(piece), size)
    size += goal[0] if goal is not None else 0
    return piece[:size] if size < len(piece) else ()


def _moved(members: list[Phrase], named: Phrase, *, last: bool) -> Phrase:
    """The members of a list with the named one at its start or end; empty if it names none."""
    lead = _verb_of(members[0])
    members = [members[0][len(lead) :], *members[1:]]
    wanted = keys(bare(named))
    at = next((i for i, m in enumerate(members) if keys(bare(m))[-len(wanted) :] == wanted), -1)
    if at < 0 or not lead or not wanted or any(opens_command(m) and _verb_of(m) for m in members):
        return ()
    rest = [m for i, m in enumerate(members) if i != at]
    return _joined([*rest, members[at]] if last else [members[at], *rest], lead)


_ENDING = {"ending": True, "finishing": True, "concluding": True, "starting": False, "beginning": False}


def participle_order(words: Phrase) -> Phrase:
    """For "visit A, B and C, ending at A", "check all boxes, starting with the red one"."""
    flat = keys(words)
    at = next((i for i in range(3, len(flat) - 2) if flat[i] in _ENDING), 0)
    if not at or flat[at + 1] not in {"at", "with", "in", "from", "by"}:
        return words
    body = words[:at]
    named = tuple(word for word in words[at + 2 :] if word.is_word)
    last = _ENDING[flat[at]]
    moved = _moved(_pieces(body), named, last=last)
    if moved:
        return moved
    while body and (not body[-1].is_word or body[-1].key in _PAUSES):
        body = body[:-1]
    pieces = _pieces(body)
    lead = _verb_of(pieces[0]) if pieces else ()
    if not lead:
        return words
    return (*body, *_THEN, *lead, *named) if last else (*lead, *named, *_THEN, *body)
