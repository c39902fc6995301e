"""What people say somebody needs without asking for it ("A has not eaten yet"), read as an order to bring it.

Who, why (something is wanted, due, lacking, or shows) and what are found apart from one another; what is
meant where nothing is named comes from what it would be used for. The words are data (`data/needs.yaml`).
"""

from __future__ import annotations

from functools import cache
from typing import Any

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.grammar.small import is_past
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, singular, tokens
from parley.language.word_lists import load_data

__all__ = ["as_reported", "granted", "needed"]

_MOST_WORDS = 18
_LONGEST_NAME = 7
_TIME = (
    ("it", "is", "time", "for"),
    ("it", "is", "high", "time", "for"),
    ("it", "is", "about", "time", "for"),
    ("time", "for"),
    ("high", "time", "for"),
    ("it", "is", "time", "that"),
    ("it", "is", "nearly", "time", "for"),
    ("now", "is", "the", "time", "for"),
    ("about", "time", "for"),
    ("it", "is", "now", "time", "for"),
    ("it", "is", "past", "time", "for"),
    ("it", "is", "time", "to", "give"),
    ("time", "to", "give"),
)


def needed(words: Phrase, scene: Scene) -> Phrase | None:
    """The order that a clause about somebody's need means; None if it is about none.

    Args:
        words: One clause.
        scene: Who and what is known.
    """
    said = tuple(w for w in strip_openers(words) if w.is_word and w.key not in {"still", "simply", "just"})
    said = as_reported(said, scene)
    if not 2 <= len(said) <= _MOST_WORDS:
        return None
    found = (
        _in_state(said, scene)
        or _without_it(said, scene)
        or _handed(said, scene)
        or _due(said, scene)
        or _wanted(said, scene)
        or _shown(said, scene)
    )
    if found is None:
        return None
    who, what = found
    return _order(*(_delivered(what, scene) or (who, what)))


def as_reported(said: Phrase, scene: Scene) -> Phrase:
    """For "A says she can not sleep" "A can not sleep".

    Args:
        said: The words of one clause.
        scene: Who is known.
    """
    flat = keys(said)
    for at in range(1, min(_LONGEST_NAME, len(flat) - 5)):
        asks = flat[at] in {"asked", "asks", "wonders"} and flat[at + 1] in {"whether", "if"}
        if (
            asks
            and flat[at + 2] in {"she", "he", "they"}
            and flat[at + 3] in {"could", "can", "may", "might"}
        ):
            return (*said[:at], Word("wants", "wants"), Word("to", "to"), *said[at + 4 :])
    for at in range(1, min(_LONGEST_NAME, len(flat) - 2)):
        size = next((len(v) for v in _SAYING if flat[at : at + len(v)] == v), 0)
        begin = at + size + (flat[at + size : at + size + 1] == ("that",))
        if size and flat[begin : begin + 1] in {("she",), ("he",), ("they",)} and _who(said[:at], scene):
            return (*said[:at], *said[begin + 1 :])
    return said


_SAYING = (
    ("says",),
    ("said",),
    ("complains",),
    ("told", "me"),
    ("tells", "me"),
    ("told", "us"),
    ("thinks",),
    ("mentioned",),
)


def granted(words: Phrase, scene: Scene) -> Phrase | None:
    """The order for "see that A gets tea", "make sure A has tea"."""
    said = tuple(word for word in strip_openers(words, requests=True) if word.is_word)
    if not 4 <= len(said) <= _MOST_WORDS:
        return None
    asked = len(said) < sum(word.is_word for word in words)
    found = _granted(said, scene) or (_handed(said, scene) if asked else None)
    if found is None:
        return None
    who, what = found
    return _order(*(_delivered(what, scene) or (who, what)))


def _delivered(what: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "(A wants) B at the desk": where B is wanted, and B, if B is not known to be there already."""
    noun = noun_phrase(what)
    if len(noun.anchors) != 1 or noun.relation not in {"in", "at", "on", "by"} or not noun.core:
        return None
    cut = len(what) - len(noun.anchors[0])
    while cut and keys(what[cut - 1 : cut]) != tuple(noun.relation.split())[-1:]:
        cut -= 1
    thing = what[: max(cut - 1, 0)]
    place = scene.ground(noun.anchors[0])
    known = find_fact(bare(thing), scene.facts)[0] if thing else None
    if known is None or place.outcome != "match":
        return None
    there = scene.ground(known.fact.place)
    if there.outcome == "match" and there.candidates[0] == place.candidates[0]:
        return None
    return noun.anchors[0], thing


def _order(who: Phrase, what: Phrase) -> Phrase | None:
    what = _without_tail(what)
    if not what or keys(what)[0] in {"to", "you", "that", "it", "not", "up", "off", "from"}:
        return None
    return (Word("bring", "bring"), *what, Word("to", "to"), *who)


@cache
def _data() -> Any:
    return load_data("needs")


@cache
def _table(kind: str) -> PhraseTable:
    return PhraseTable.of(_data()[kind])


@cache
def _uses() -> PhraseTable:
    return PhraseTable({verb: kind or "-" for verb, kind in _data()["uses"].items()})


def _who(words: Phrase, scene: Scene) -> Phrase | None:
    """Somebody whom the first words name, and nothing else; the operator is somebody too."""
    if not words or len(words) > _LONGEST_NAME:
        return None
    flat = keys(words)
    if flat in {("i",), ("we",), ("me",), ("us",)}:
        return (Word("me", "me"),)
    if flat[-1] in {"you", "it", "this", "that", "which", "what", "nobody"} or {"to", "of"} & set(flat):
        return None
    named = bare(words)
    if named and keys(named)[0] not in {"it", "you"} and scene.is_person(named):
        return words
    return _somebody_at(named, scene)


def _somebody_at(words: Phrase, scene: Scene) -> Phrase | None:
    """For "the lady in room 2", "Anna at the desk": somebody, and where they are."""
    noun = noun_phrase(words)
    if not noun.core or len(noun.anchors) != 1:
        return None
    person = noun.core[-1] in lexicon().person_words or scene.is_person(noun.phrase[: len(noun.core)])
    return words if person and scene.ground(noun.anchors[0]).outcome == "match" else None


def _handed(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "tea to room 2" and "water for A": something known to be somewhere else, and where it goes."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in {"to", "for"}), 0)
    what = bare(words[:at])
    if not at or not what or len(what) > _LONGEST_NAME or lexicon().verbs.match(flat) is not None:
        return None
    core = noun_phrase(what).core
    kinds = lexicon().kinds
    portable = find_fact(what, scene.facts)[0] is not None or any(
        core[-1:] and core[-1] in kinds[k] for k in ("drink", "food", "medicine")
    )
    if not portable or not all(word.is_word for word in what) or scene.ground(what).outcome == "match":
        return None
    goal = words[at + 1 :]
    who = _who(goal, scene)
    if who is None and flat[at] == "to" and scene.ground(goal).outcome == "match":
        who = goal
    return (who, words[:at]) if who else None


def _what(words: Phrase, scene: Scene, kind: str = "") -> Phrase:
    """What is named, or what is meant by a use ("to drink")."""
    flat = keys(words)
    if " ".join(flat) in lexicon().need_phrases:
        return words
    if (
        not words
        or flat[0] in {"something", "anything", "somewhat", "nothing"}
        or _tail_at(flat, 0) == len(flat)
    ):
        use = _uses().match(flat, 2) if flat[1:2] == ("to",) else None
        meant = use[1] if use is not None and use[1] != "-" else kind
        need = lexicon().need_words.get(meant, "")
        return tokens(need) if need else ()
    while len(words) > 1 and words[0].key in {"any", "some", "of", "more", "her", "his", "their"}:
        words = words[1:]
    return words


def _due(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "it is time for A's tea", "time for A to have tea", "tea time for A"."""
    flat = keys(words)
    lead = next((lead for lead in _TIME if flat[: len(lead)] == lead), ())
    if not lead:
        at = next((i for i in range(len(flat) - 2) if flat[i : i + 2] == ("time", "for")), 0)
        who = _who(words[at + 2 :], scene) if at else None
        what = tuple(word for word in words[:at] if word.key not in {"it", "is", "the"})
        return (who, what) if who and what else None
    rest = words[len(lead) :]
    owner = next((i for i, word in enumerate(rest) if word.key.endswith("'s")), -1)
    if 0 <= owner < len(rest) - 1:
        name = rest[owner]
        stem = Word(name.key.removesuffix("'s"), name.raw.removesuffix("'s"))
        who = _who((*rest[:owner], stem), scene)
        return (who, _as_remembered(rest[: owner + 1], rest[owner + 1 :], scene)) if who else None
    for cut in range(min(_LONGEST_NAME, len(rest) - 1), 0, -1):
        who = _who(rest[:cut], scene)
        if who and rest[cut].key == "to":
            return _using(who, rest[cut + 1 :], scene)
        if who and lead[-1] == "give":
            return who, rest[cut:]
    return None


def _as_remembered(owner: Phrase, thing: Phrase, scene: Scene) -> Phrase:
    """By the name "A's tea" if that is remembered, else "tea"."""
    whole = (*owner, *thing)
    told = any(keys(item.fact.subject) == keys(bare(whole)) for item in scene.facts)
    return whole if told else thing


def _using(who: Phrase, rest: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "have tea", "drink something", "eat"."""
    use = _uses().match(keys(rest))
    if use is None:
        return None
    what = _what(rest[use[0] :], scene, "" if use[1] == "-" else use[1])
    return (who, what) if what else None


def _wanted(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "A would like to drink something", "A has not had any tea yet", "A should eat"."""
    for cut in range(1, min(_LONGEST_NAME, len(words) - 1) + 1):
        flat = keys(words)
        lead, lack = _table("leads").match(flat, cut), _table("lacking").match(flat, cut)
        desire = _table("desires").match(flat, cut)
        who = _who(words[:cut], scene) if lead or lack or desire else None
        if who is None and desire is not None:
            who = _waiting_place(words[:cut], words[cut + desire[0] :], scene)
        if who is None or (lead is not None and _allowed(flat[cut : cut + 2])):
            continue
        if lead is not None and _is_done(flat[cut + lead[0] :]):
            return None
        rest = words[cut:]
        used = _using(who, rest[lead[0] :], scene) if lead is not None else None
        if used is not None and lead is not None:
            return None if keys(who) == ("me",) and lead[1] in _OWN_PLANS else used
        if keys(who) == ("me",):
            continue
        if desire is not None and keys(rest[desire[0] : desire[0] + 1]) not in {("to",), ("you",)}:
            what = _desired(desire[1], _theirs(who, rest[desire[0] :], scene), scene)
            if what is not None:
                return who, what
        elif lack is not None:
            return who, _lacked(lack[1], _theirs(who, rest[lack[0] :], scene), scene)
    return None


def _waiting_place(words: Phrase, what: Phrase, scene: Scene) -> Phrase | None:
    """For "the truck (is waiting for) A": a thing of the map, if A is known to be elsewhere."""
    known = scene.ground(words).outcome == "match" and find_fact(bare(what), scene.facts)[0] is not None
    return words if known and scene.ground(what).outcome != "match" else None


def _desired(said: str, rest: Phrase, scene: Scene) -> Phrase | None:
    """What is desired; "gets" is a habit unless it is known where that is."""
    what = _what(rest, scene)
    habit = said == "gets" and (find_fact(what, scene.facts)[0] is None or {"every", "at"} & set(keys(rest)))
    return None if habit else what


def _allowed(said: tuple[str, ...]) -> bool:
    """For "A may use B": a rule, and nothing that A is to be given."""
    return said in {(may, use) for may in ("may", "can") for use in ("use", "wear", "take", "read")}


def _is_done(rest: tuple[str, ...]) -> bool:
    """For "(they should) have closed it by now": nothing that they are to be given."""
    done = rest[:1] == ("have",) and rest[1:2] and (rest[1].endswith("ed") or is_past(rest[1]))
    return bool(done) and rest[2:3] != () and rest[2] in lexicon().thing_pronouns | lexicon().determiners


def _lacked(said: str, rest: Phrase, scene: Scene) -> Phrase:
    """What somebody has not had, also if only the use of it is said."""
    kind = next((k for w, k in _data()["lacking_kind"].items() if w in said), "")
    use = _uses().match(keys(rest))
    if use is not None and use[1] != "-":
        rest, kind = rest[use[0] :], use[1]
    return _what(rest, scene, kind)


_OWN_PLANS = frozenset(
    {
        "will",
        "is going to",
        "can",
        "may",
        "could",
        "have to",
        "must",
        "should",
        "need to",
        "has to",
        "wish to",
    }
)
"""Of the operator these speak of what is done without help."""


def _shown(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "A's mouth is dry", "A is shivering": signs of a need."""
    flat = keys(words)
    said = set(flat) | {singular(word) for word in flat}
    if {"not", "no", "never"} & said:
        return None
    kind = next((kind for signs, kind in _data()["signs"] if set(signs) <= said), "")
    if not kind:
        return None
    at = next((i for i in range(min(4, len(words))) if words[i].key.endswith("'s")), -1)
    if at >= 0:
        stem = Word(words[at].key.removesuffix("'s"), words[at].raw.removesuffix("'s"))
        who = _who((*words[:at], stem), scene)
    elif flat[0] in {"his", "her"} and scene.persons:
        who = scene.persons[-1]
    elif flat[0] == "my":
        who = (Word("me", "me"),)
    else:
        sizes = range(min(_LONGEST_NAME, len(words) - 1), 0, -1)
        who = next((who for cut in sizes if (who := _who(words[:cut], scene)) is not None), None)
    return (who, tokens(lexicon().need_words[kind])) if who else None


def _in_state(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "A hungry", as people type it."""
    kind = lexicon().needs.get(words[-1].key, "")
    who = _who(words[:-1], scene) if kind and len(words) < 5 else None
    return (who, tokens(lexicon().need_words[kind])) if who else None


def _without_it(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "A can not read without her glasses"."""
    flat = keys(words)
    at = flat.index("without") if "without" in flat[2:-1] else 0
    link = next(
        (i for i in range(1, min(_LONGEST_NAME, at)) if flat[i] in {"can", "could", "does", "will", "is"}), 0
    )
    if not at or not link or "not" not in flat[link:at]:
        return None
    who = _who(words[:link], scene)
    return (who, _theirs(who, words[at + 1 :], scene)) if who else None


def _theirs(who: Phrase, what: Phrase, scene: Scene) -> Phrase:
    """For "her glasses" "A's glasses", if they are remembered by that name."""
    if keys(what)[:1] not in {("her",), ("his",), ("their",), ("my",)}:
        return what
    last = who[-1]
    thing = _without_tail(what[1:])
    full = (*bare(who)[:-1], Word(f"{last.key}'s", f"{last.raw}'s"), *thing)
    return full if find_fact(full, scene.facts)[0] is not None else thing


def _granted(words: Phrase, scene: Scene) -> tuple[Phrase, Phrase] | None:
    """For "see that A gets tea", "A should be given tea"."""
    lead = _table("seeing_to").match(keys(words))
    flat = keys(words)
    if lead is not None:
        for cut in range(lead[0] + 1, min(lead[0] + _LONGEST_NAME, len(flat) - 1) + 1):
            given = _table("granting").match(flat, cut + (flat[cut] == "to"))
            who = _who(words[lead[0] : cut], scene) if given is not None else None
            if given is not None and who is not None:
                return who, _what(words[cut + (flat[cut] == "to") + given[0] :], scene)
    return None


def _tail_at(flat: tuple[str, ...], at: int) -> int:
    """Where the words that mean nothing for what is brought, which begin at `at`, end."""
    while at < len(flat):
        found = _table("tails").match(flat, at)
        if found is None and flat[at] == "since":
            return len(flat)
        if found is None:
            break
        at += found[0]
    return at


def _without_tail(what: Phrase) -> Phrase:
    flat = keys(what)
    cut = next((i for i in range(1, len(flat)) if _tail_at(flat, i) == len(flat)), len(flat))
    return what[:cut]
