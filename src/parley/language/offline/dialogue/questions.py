"""Questions: about abilities, places, memory, plan and state, answered at once and without acting."""

from __future__ import annotations

from functools import cache

from parley.language.offline.dialogue import about_map
from parley.language.offline.dialogue.able import KNOWING_HOW, able
from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.dialogue.about_told import taught
from parley.language.offline.dialogue.asked import asked, told_of
from parley.language.offline.dialogue.own_state import ABOUT_ITSELF, told_about
from parley.language.offline.dialogue.plain_question import plain_question
from parley.language.offline.dialogue.retrieval import (
    condition_of,
    known_of,
    recalled,
    recalled_fully,
    when_told,
)
from parley.language.offline.dialogue.to_be_seen import at_once, seen_there
from parley.language.offline.dialogue.turning import third, turned
from parley.language.offline.facts.facts import NO_PLACES
from parley.language.offline.facts.remembering import find_fact, newest
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import Clause, opens_command
from parley.language.offline.tasks.abilities import abilities
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import a, capital, listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, Word, keys, plain, tokens
from parley.language.word_lists import load_data

__all__ = ["Answer", "answer", "unwrapped"]


@cache
def _starts(kind: str) -> tuple[tuple[str, ...], ...]:
    """The word sequences with which questions of a kind begin, longest first."""
    return tuple(
        sorted((tuple(text.split()) for text in load_data("questions")[kind]), key=len, reverse=True)
    )


_ALSO_WRAPPED = ("left", "memory", "status", "objects")
"""Kinds of questions that need no question word behind "tell me" and the like."""


_ASKED_ABOUT = frozenset({"you", "i", "we", "they", "he", "she", "it"})


def answer(clause: Clause, scene: Scene) -> Answer | None:
    """The answer if the clause is a question, else None.

    Raises:
        UnclearError: It can be read in several ways.
    """
    words = plain_question(clause.words, marked=clause.is_question)
    wrapped = unwrapped(words)[1]
    if (
        clause.is_question
        and not wrapped
        and words[:1]
        and words[0].key in {"any", "anything", "anybody", "anyone"}
    ):
        words = (Word("is", "is"), *turned(words, scene)[:1], *words)
    whole = recalled_fully(words, scene) if keys(words)[:1] in _WH else None
    if whole is not None:
        for item in whole[1]:
            scene.use(item)
        return Answer(whole[0])
    knows_how = clause.is_question and keys(words)[:5] == KNOWING_HOW
    found = able(words, keys(words), scene) if knows_how else told_of(words, keys(words), scene)
    found = found or (taught(words, keys(words), scene) if keys(words)[:1] in _RECITING else None)
    found = found or _read(words, clause, scene)
    if found is not None and found.look:
        return at_once(found, words, scene)
    if found is None or found.text.startswith(_AT_A_LOSS):
        owned = None if keys(words)[:1] in _NOW else recalled(words, scene)
        statement, place = seen_there(words, scene) if owned is None else ((), ())
        if statement:
            ask = f"I do not know. Shall I go to {the(plain(place))} and have a look?"
            return Answer(ask, statement, at=place, now=True)
    if found is None and not _asks_of_others(clause, keys(words)):
        return None
    if found is not None and (found.look or not found.text.startswith(_AT_A_LOSS)):
        return found
    told = recalled(words, scene) or when_told(words, scene) or known_of(words, scene)
    if told is None:
        return found
    for item in told[1]:
        scene.use(item)
    return Answer(told[0])


_RECITING = frozenset({("list",), ("repeat",), ("show",), ("tell",), ("give",)})
_WH = frozenset({("what",), ("who",), ("whose",), ("which",), ("why",)})
_NOW = frozenset({("is",), ("are",)})
_MAY = frozenset({"can", "could", "may", "should", "must", "will", "would"})
"""How questions begin that ask whether something may or will be done, by whomever but the robot."""
_AT_A_LOSS = "I do not know"


def _read(words: Phrase, clause: Clause, scene: Scene) -> Answer | None:
    words, wrapped = unwrapped(words)
    if wrapped and _to_be_done(keys(words), keys(clause.words), scene):
        return None
    flat = keys(words)
    if not flat:
        return None
    text = " ".join(flat)
    if text in {"help", "help me", "i need help", "can you help me", "could you help me", "i need your help"}:
        return Answer(abilities(scene))
    if " ".join(flat[:4]).startswith(
        ("what do you see", "what can you see", "what you see", "what you find")
    ):
        return None
    question = (
        clause.is_question
        or flat[0] in lexicon().question_starts
        or flat[0] in lexicon().be
        or flat[0] in {"do", "did", "have", "has", "does"}
        or wrapped
    )
    if not question:
        return None
    marked = clause.is_question
    ready = able(words, flat, scene) if marked else None
    ready = ready or asked(words, flat, scene)
    if ready is not None:
        return ready
    for kind, reply in ABOUT_ITSELF.items():
        for start in _starts(kind):
            if _begins(flat, start):
                return Answer(reply(scene, words[len(start) :]))
    for reader in (
        _does,
        about_map.attribute,
        about_map.which,
        about_map.how_far,
        _where,
        _what_in,
        _how_many,
        _who,
        _whether,
    ):
        found = reader(words, flat, scene, marked or wrapped)
        if found is not None:
            return found
    return about_map.told(words, flat, scene, marked or wrapped) or _open_question(words, clause.is_question)


def _asks_of_others(clause: Clause, flat: tuple[str, ...]) -> bool:
    """For "can the guests use the pool?": not about what the robot is to do."""
    others = flat[:1] and flat[0] in _MAY and flat[1:2] not in {("you",), ("we",)}
    return bool(clause.is_question and others and lexicon().wants.match(flat) is None)


def _to_be_done(asked: tuple[str, ...], said: tuple[str, ...], scene: Scene) -> bool:
    """For "tell me how many boxes there are in A", "say what day it is": an order for an action."""
    catalogue = scene.catalogue
    if said[:1] == ("say",) and catalogue.with_role("speak") is not None:
        return True
    counted = asked[:2] == ("how", "many") and catalogue.with_role("count") is not None
    return counted and len(asked) > 3 and asked[2] not in {"robots", "steps"}


def unwrapped(words: Phrase) -> tuple[Phrase, bool]:
    """A question without "tell me", "do you know" and the like in front, and whether there was any.

    Args:
        words: The words of a question.
    """
    flat = keys(words)
    for wrapper in _starts("wrappers"):
        rest = words[len(wrapper) :]
        if flat[: len(wrapper)] == wrapper and rest:
            lead = keys(rest)[0]
            asked = (
                lead in lexicon().question_starts
                or lead in {"about", "your", "everything", "all", "if", "whether"}
                or any(_begins(keys(rest), start) for kind in _ALSO_WRAPPED for start in _starts(kind))
            )
            if asked and not (
                lead in {"if", "whether"} or (lead in {"all", "everything"} and wrapper[0] == "show")
            ):
                return rest, True
    return words, False


def _begins(flat: tuple[str, ...], start: tuple[str, ...]) -> bool:
    if start[-1] == "left" and flat[len(start) : len(start) + 1] == ("of",):
        # "What is left of the door?" is about the door.
        return False
    if start[-1] == "next" and flat[len(start) : len(start) + 1] == ("to",):
        # "What is next to the door?" is about the door.
        return False
    if (len(start) == 2 and start[0] in {"the", "your"}) or start[0] in {
        "all",
        "next",
        "remaining",
        "pending",
        "current",
        "everything",
    }:
        return flat[: len(start)] == start and len(flat) <= len(start) + 3
    return flat[: len(start)] == start


def _open_question(words: Phrase, marked: bool) -> Answer | None:
    flat = keys(words)
    if (
        flat[0] in {"do", "does", "did", "have", "has", "are"}
        and flat[1:2]
        and (flat[1] in _ASKED_ABOUT or (marked and flat[0] in {"does", "did", "has"}))
        and flat[1:3] != ("you", "mind")
    ):
        return Answer("I do not know that. Tell me, and I will remember it.")
    inverted = flat[1:2] and flat[1] in lexicon().be | lexicon().auxiliaries
    if flat[0] in lexicon().question_starts and (flat[0] != "when" or marked or inverted):
        if flat[1:2] == ("about",) or opens_command(words):
            # "Why don't you go to ..." asks for it.
            return None
        return Answer("I do not know that. Tell me, and I will remember it.")
    return None


def _where(words: Phrase, flat: tuple[str, ...], scene: Scene, _: bool) -> Answer | None:
    """For "Where is X?", "where can I find X?", "have you seen X?"."""
    if flat[0] == "where":
        rest = words[1:]
        while len(rest) > 1 and rest[0].key in lexicon().be | lexicon().auxiliaries | {
            "i",
            "find",
            "you",
            "we",
            "see",
            "to",
            "exactly",
            "put",
            "get",
            "keep",
            "leave",
            "store",
            "place",
            "hide",
            "last",
        }:
            rest = rest[1:]
    elif flat[:3] in {("have", "you", "seen"), ("did", "you", "see"), ("what", "room", "is")}:
        rest = words[3:]
    elif flat[:1] in {("which",), ("what",)} and flat[1:2] in {("room",), ("place",)} and "is" in flat:
        rest = words[flat.index("is") + 1 :]
    else:
        return None
    about = bare(rest)
    while len(about) > 1 and about[-1].key in lexicon().be | lexicon().location_verbs | {"now", "in", "at"}:
        about = bare(about[:-1])
    need = lexicon().need_phrases.get(" ".join(keys(about)))
    about = tokens(need) if need else scene.referent(about)
    fact, several = find_fact(about, scene.facts)
    hits = [fact] if fact is not None else several
    hits += [said for item in hits if (said := scene.closing_of(item)) is not None]
    for item in hits:
        scene.use(item)
    scene.mention(bare(about))
    if hits:
        return Answer(" ".join(whole_sentence(item.fact.sentence) for item in hits))
    denied = next(
        (f for f in scene.facts if f.fact.negated and keys(f.fact.subject) == keys(bare(about))), None
    )
    if denied is not None and not hits:
        scene.use(denied)
        return Answer(f"I only know this: {whole_sentence(denied.fact.sentence)}")
    named = len(about) == 1 and about[0].is_capital
    found = ground_phrase(about, scene.objects, scene.situation.robot_pose, strict=named)
    if found.outcome == "match":
        thing = found.candidates[0]
        name = capital(the(describe(thing, scene.objects)))
        return Answer(f"{name} is on my map at x {thing.x_m:.1f} m, y {thing.y_m:.1f} m.")
    if found.outcome == "ambiguous":
        names = listing([the(describe(i, scene.objects)) for i in found.candidates])
        return Answer(f"I know several on my map: {names}.")
    return Answer(f"I do not know where {the(plain(about))} is. Tell me and I will remember it.")


def _what_in(words: Phrase, flat: tuple[str, ...], scene: Scene, _: bool) -> Answer | None:
    """For "What is in X?", "who is on X?": the remembered facts about that place."""
    if flat[0] not in {"what", "who"} or len(flat) < 4 or flat[1] not in lexicon().be:
        return None
    at = 3 if flat[2] in lexicon().location_verbs | {"there"} else 2
    found = lexicon().places.match(flat, at)
    if found is None or set(flat[at + found[0] :][:1]) & NO_PLACES:
        return None
    place = bare(words[at + found[0] :])
    wanted = set(noun_phrase(place).core)
    hits = [
        f
        for f in newest(scene.facts)
        if wanted
        and wanted <= set(noun_phrase(f.fact.place).core)
        and (flat[0] != "who" or scene.is_person(f.fact.subject))
    ]
    for item in hits:
        scene.use(item)
    if hits:
        return Answer(" ".join(whole_sentence(item.fact.sentence) for item in hits))
    if ground_phrase(place, scene.objects).outcome != "none":
        ask = f"I do not know what is {found[1]} {the(plain(place))}. Shall I go there and have a look?"
        return Answer(ask, (Word("at", "at"), *place))
    return Answer(f"I do not know what is {found[1]} {the(plain(place))}. Tell me and I will remember it.")


def _how_many(words: Phrase, flat: tuple[str, ...], scene: Scene, _: bool) -> Answer | None:
    start = 2 if flat[:2] == ("how", "many") else 1
    owned = next(
        (i for i in range(2, len(flat)) if flat[i].endswith("'s") and flat[i - 1] in lexicon().be), 0
    )
    if start == 1 and owned and flat[0] in {"which", "what"}:
        item = scene.told_apart((words[owned], *words[1 : owned - 1]))
        if item is not None:
            return Answer(f"It is {the(describe(item, scene.objects))}.")
    if len(flat) < 3 or (
        start == 1 and (flat[0] not in {"which", "what"} or flat[1] in lexicon().be | lexicon().auxiliaries)
    ):
        return None
    end = next((i for i in range(start + 1, len(flat)) if flat[i] in _COUNTED_BY), len(flat))
    about = bare(words[start:end])
    found = ground_phrase(about, scene.objects) if about else None
    where = noun_phrase(words[start:]) if start == 2 else None
    unknown = found is None or found.outcome == "none"
    placed = where is not None and bool(where.core) and len(where.anchors) == 1 and where.relation != "of"
    if where is not None and placed and unknown:
        anchor = where.anchors[0]
        if ground_phrase(anchor, scene.objects).outcome == "match":
            text = f"I do not know. Shall I go to {the(plain(anchor))} and have a look?"
            return Answer(text, (*about, *tokens(where.relation), *anchor), counts=True)
    if found is None or found.outcome == "none":
        return Answer(f"I do not know of any {plain(about)}.") if start == 2 else None
    names = listing([the(describe(item, scene.objects)) for item in found.candidates])
    return Answer(f"I know {len(found.candidates)} on my map: {names}.")


_COUNTED_BY = lexicon().be | {"do", "can", "have", "has", "did", "does", "got", "will", "could"}


def _who(words: Phrase, flat: tuple[str, ...], scene: Scene, _: bool) -> Answer | None:
    if flat[:2] not in {("who", "is"), ("what", "is"), ("what", "are"), ("who", "are")} or len(flat) < 3:
        return None
    about = bare(words[2:])
    found = told_about(about, scene)
    for item in found:
        scene.use(item)
    if found:
        return Answer(" ".join(whole_sentence(item.fact.sentence) for item in found))
    return Answer(f"I do not know anything about {the(plain(about))}. Tell me, and I will remember it.")


def _without_here(words: Phrase, *, there: bool) -> Phrase:
    """For "is there an X (anywhere) near here?", "is there an X in this building?": on the map or not."""
    somebody = words[2].key.endswith(("body", "one", "thing"))
    while len(words) > 3 and words[-1].key in {"somewhere", "anywhere", "here", "around", "left", "nearby"}:
        words = words[:-1]
        if there and not somebody and words[-1].key in {"near", "around", "close", "by"}:
            words = words[:-1]
    here = keys(words[-3:-1]) in {("in", "this"), ("on", "this")} and words[-1].key in _HEREABOUTS
    return words[:-3] if there and here and len(words) > 5 else words


_HEREABOUTS = frozenset({"building", "house", "floor", "place", "site", "area", "level", "town"})


def _whether(words: Phrase, flat: tuple[str, ...], scene: Scene, asked: bool) -> Answer | None:
    """For "Is there an X in the Y?", "is the X open?": from memory, else looking is offered."""
    if flat[0] not in lexicon().be or len(flat) < 3 or flat[1] == "you" or (not asked and flat[1] != "there"):
        return None
    words = tuple(
        word for word in words if word.key not in {"still", "already", "really", "currently", "now"}
    )
    flat = keys(words)
    if len(flat) < 3:
        return None
    if flat[1] in lexicon().thing_pronouns | lexicon().person_pronouns and (scene.things or scene.persons):
        words = (words[0], *bare(scene.referent(words[1:2])), *words[2:])
        flat = keys(words)
    there = flat[1] == "there"
    words = _without_here(words, there=there)
    flat = keys(words)
    rest = words[2:] if there else words[1:]
    noun = noun_phrase(rest)
    subject = bare(rest[: _cut(rest, noun.relation)])
    place = noun.anchors[0] if noun.anchors else ()
    told = find_fact(subject, scene.facts)[0] if subject and place else None
    beside = about_map.near(subject, noun, scene)
    if beside is not None:
        return beside
    if not there and (told is None or keys(told.fact.subject) != keys(subject)):
        about = _grounded_prefix(rest, scene)
        if about and about < len(rest) and lexicon().places.match(keys(rest), about) is None:
            return _state(rest, scene, words)
    ready = about_map.known_there(subject, place, there, scene)
    if ready is not None:
        return ready
    if place and ground_phrase(place, scene.objects).outcome != "none":
        inner = lexicon().places.match(keys(place))
        # "Are the lights on in the hall": the hall.
        place = place[inner[0] :] if inner is not None and inner[0] < len(place) else place
        return Answer(
            f"I do not know. Shall I go to {the(plain(place))} and have a look?",
            turned(words, scene) or _statement(there, words),
        )
    known = ground_phrase(subject, scene.objects) if subject else None
    if there and known is not None and known.outcome != "none" and not place:
        return Answer(f"Yes, I know {listing([a(describe(i, scene.objects)) for i in known.candidates])}.")
    if not there:
        return _state(rest, scene, words)
    return Answer(
        f"I do not know of {a(plain(subject))}{' there' if place else ''}. Tell me if there is one."
    )


def _state(rest: Phrase, scene: Scene, words: Phrase) -> Answer:
    """For "Is the X open?"."""
    size = _grounded_prefix(rest, scene)
    for cut in (size, len(rest) - 1):
        known, _ = find_fact(bare(rest[:cut]), scene.facts, locations=False) if cut > 0 else (None, [])
        if known is None or known.fact.is_location or not keys(known.fact.state):
            continue
        if keys(known.fact.subject) != keys(bare(rest[:cut])):
            continue
        asked, told = set(keys(rest[cut:])), set(keys(known.fact.state))
        if asked & told:
            scene.use(known)
            agrees_ = (asked <= told) and not known.fact.negated
            return Answer(
                ("Yes: " if agrees_ else "As far as I know, no: ") + whole_sentence(known.fact.sentence)
            )
    told_so = _so_told(rest, size or len(rest) - 1, scene)
    if told_so is not None:
        return told_so
    if size:
        about = scene.with_part(rest, size)
        said = (*rest[:about], Word(words[0].key, words[0].key), *rest[about:])
        return Answer(f"I do not know. Shall I go to {the(plain(bare(rest[:size])))} and have a look?", said)
    fact, _ = find_fact(bare(rest[:-1]) or rest, scene.facts, locations=False)
    if fact is not None:
        scene.use(fact)
        return Answer("I remember: " + whole_sentence(fact.fact.sentence))
    return Answer("I do not know that. Tell me, and I will remember it.")


def _does(words: Phrase, flat: tuple[str, ...], scene: Scene, asked: bool) -> Answer | None:
    """For "does the box need paint?", "do the lamps work?": only looking can tell."""
    if flat[0] not in {"does", "do", "did", "has", "have"} or not asked or len(flat) < 3:
        return None
    rest = words[1:]
    size = _grounded_prefix(rest, scene)
    if not size or lexicon().places.match(keys(rest), size) is not None:
        return None
    told_so = _so_told(rest, size, scene)
    if told_so is not None:
        return told_so
    held = flat[0] in {"has", "have"}
    said = (Word(flat[0], flat[0]), *rest[size:]) if held else (third(rest[size]), *rest[size + 1 :])
    return Answer(
        f"I do not know. Shall I go to {the(plain(bare(rest[:size])))} and have a look?",
        (*rest[:size], *said),
    )


def _so_told(rest: Phrase, size: int, scene: Scene) -> Answer | None:
    """What was told of how it is, where a question asks whether it is in order."""
    known = condition_of(rest[:size], rest[size:], scene)
    if known is None:
        return None
    scene.use(known)
    return Answer(f"I remember: {whole_sentence(known.fact.sentence)}")


def _grounded_prefix(rest: Phrase, scene: Scene) -> int:
    """How many of the first words name one object of the map; 0 if none do."""
    for size in range(len(rest) - 1, 0, -1):
        if ground_phrase(rest[:size], scene.objects).outcome == "match":
            return size
    return 0


def _statement(there: bool, words: Phrase) -> Phrase:
    """The question turned into what follows "whether"."""
    if there:
        return (words[1], words[0], *words[2:])
    noun = noun_phrase(words[1:])
    cut = _cut(words[1:], noun.relation)
    return (*words[1 : 1 + cut], words[0], *words[1 + cut :])


def _cut(words: Phrase, relation: str) -> int:
    flat, wanted = keys(words), tuple(relation.split())
    return next((i for i in range(len(flat)) if relation and flat[i : i + len(wanted)] == wanted), len(flat))
