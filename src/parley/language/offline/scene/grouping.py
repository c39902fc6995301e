"""A message with one word for each group of things it names, seen against what was spoken of before."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.language.offline.facts.stories import mentioned
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.group_nouns import Uncounted
from parley.language.offline.scene.group_words import BETTER
from parley.language.offline.scene.groups import GroupReader
from parley.language.offline.scene.labels import with_heads, with_kinds
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.states import restricted
from parley.language.offline.scene.subsets import only_exception, with_exception_behind
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["grouped", "ids_in", "names_things"]

_LAST_TURNS = 4


def grouped(words: Phrase, scene: Scene, *, pronouns: bool = True) -> Phrase:
    """The message with one word for each group of things that it names.

    Args:
        words: All words and punctuation.
        scene: What is known; "the others" are other than what this message or the last ones named.
        pronouns: Whether "them" and "each of them" are groups too.
    """

    def named(said: Phrase) -> Sequence[MapObject]:
        here = _named(said, scene)
        if here:
            return here
        turns = (t for t in scene.situation.history[-_LAST_TURNS:] if t.role == "operator")
        return [item for turn in turns for item in _named(tokens(turn.content), scene)]

    spoken_of = [turn.content for turn in scene.situation.history[-_LAST_TURNS:]]
    words = _restricted(only_exception(words), scene)
    words = with_exception_behind(with_heads(_labelled(words, scene, spoken_of), scene.objects, spoken_of))
    words = _without_stand_in(_told_of(_there_is_one(_which_then(_wrong_one(words)), scene), scene), scene)
    reader = GroupReader(scene.objects, scene.situation.robot_pose, scene.facts, named, pronouns=pronouns)
    read = reader.read(words)
    scene.uncounted = reader.uncounted or scene.uncounted
    if keys(read) != keys(words):
        scene.trace.note("words", f"groups found in “{plain(words)}”")
    return read


def _restricted(words: Phrase, scene: Scene) -> Phrase:
    """With a look at each of "all doors that are open" where nobody knows which these are; or it is asked."""

    def is_order(part: Phrase) -> bool:
        return opens_command(part, scene.catalogue.verbs)

    found = None if scene.situation.queue else restricted(words, scene.objects, scene.facts, is_order)
    if found is None:
        return words
    for fact in found.used:
        scene.use(fact)
    if found.used or any(scene.catalogue.all_with_role("look")):
        return found.words
    scene.uncounted = Uncounted(found.group, found.items)
    return words


def _labelled(words: Phrase, scene: Scene, spoken_of: Sequence[str]) -> Phrase:
    """With nouns in front of bare labels where something is denied, for that has to be known."""
    denies = {"not", "no", "skip", "leave", "never", "without", "neither", "avoid"} & set(keys(words))
    return with_kinds(words, scene.objects, spoken_of) if denies else words


def names_things(scene: Scene) -> Callable[[Phrase], bool]:
    """Whether words name one thing of the map, or all of a kind, and say nothing else."""
    known: dict[tuple[str, ...], bool] = {}
    described = (f"{item.description} {item.class_name}".lower().split() for item in scene.objects)
    said = frozenset(part for parts in described for part in parts)

    def names(words: Phrase) -> bool:
        flat = keys(words)
        if flat not in known:
            known[flat] = _names(words, scene, said)
        return known[flat]

    return names


def _names(words: Phrase, scene: Scene, said: frozenset[str]) -> bool:
    flat = keys(words)
    if len(words) == 1 and marks_of(words[0]):
        return True
    body = bare(words)
    if not body or len(words) > _LONGEST_NAME or not all(word.is_word for word in words):
        return False
    strange = [key for key in keys(body) if key not in said and singular(key) not in said]
    if len(strange) > 1 or (
        flat[0] in lexicon().vocabulary and flat[0] not in lexicon().determiners and flat[0] not in said
    ):
        return False
    found = ground_phrase(body, scene.objects, strict=True)
    plural = singular(body[-1].key) != body[-1].key
    return found.outcome == "match" or (plural and found.outcome == "ambiguous")


def ids_in(scene: Scene) -> Callable[[Phrase], Sequence[str]]:
    """The identifiers of what words name: one thing of the map, all of a kind, or a group found before."""

    def ids(words: Phrase) -> Sequence[str]:
        marks = next((found for word in words if (found := marks_of(word))), ())
        return marks or [
            item.id for item in ground_phrase(bare(words), scene.objects, strict=True).candidates
        ]

    return ids


_LONGEST_NAME = 7
_POINTING = (("that", "one"), ("to", "it"), ("it",), ("that",), ("there",), ("this", "one"))


def _which_then(words: Phrase) -> Phrase:
    """For "which door is nearer to the desk? check that one": check the door nearest to the desk."""
    flat = keys(words)
    link = next((i for i in range(2, min(6, len(flat))) if flat[i] in {"is", "stands", "lies"}), 0)
    end = next((i for i in range(link, len(flat)) if flat[i] in {"?", "."}), 0)
    if flat[:1] not in {("which",), ("what",)} or not link or not end or end + 2 > len(flat):
        return words
    rest = words[end + 1 :]
    at, size = next(
        ((i, len(m)) for i in range(len(rest)) for m in _POINTING if keys(rest[i : i + len(m)]) == m), (-1, 0)
    )
    start = link + 1 + (flat[link + 1] == "the")
    if at < 1 or start >= end:
        return words
    better = BETTER.get(flat[start])
    told = (Word(better, better), *words[start + 1 : end]) if better else words[start:end]
    to = (
        tokens("to")
        if keys(rest[at : at + size]) == ("there",)
        else rest[at : at + 1]
        if size == 2 and rest[at].key == "to"
        else ()
    )
    return (*rest[:at], *to, *tokens("the"), *words[1:link], *told, *rest[at + size :])


def _there_is_one(words: Phrase, scene: Scene) -> Phrase:
    """For "there is a van in the yard, check it", "between A and B there is a bench. Check it": V that van.

    So where the map has several such things, and says which of them stands there.
    """
    flat = keys(words)
    at = next((i for i in range(len(flat) - 4) if flat[i : i + 2] in {("there", "is"), ("there", "are")}), -1)
    if (
        at < 0
        or flat[at + 2] not in {"a", "an", "one", "another"}
        or (at and lexicon().places.match(flat) is None)
    ):
        return words
    end = next((i for i in range(at + 3, len(flat)) if not words[i].is_word or flat[i] == "and"), len(flat))
    before = tuple(word for word in words[:at] if word.is_word)
    noun = (*words[at + 3 : end], *before)
    rest = words[end + 1 :]
    place, size = next(
        ((i, len(m)) for i in range(len(rest)) for m in _POINTING if keys(rest[i : i + len(m)]) == m), (-1, 0)
    )
    found = scene.ground(noun)
    kind = scene.ground(words[at + 3 : end - (0 if before else _behind(words[at + 3 : end]))])
    if place < 1 or found.outcome != "match" or kind.outcome != "ambiguous":
        return words
    to = tokens("to") if keys(rest[place : place + size]) in {("there",), ("to", "it")} else ()
    named = tokens(the(describe(found.candidates[0], scene.objects)))
    return (*rest[:place], *to, *named, *rest[place + size :])


def _told_of(words: Phrase, scene: Scene) -> Phrase:
    """For "the gate is open, go and check", where there are several gates: check the gate."""
    flat = keys(words)
    link = next((i for i in range(2, min(7, len(flat))) if flat[i] in lexicon().be | {"has", "looks"}), 0)
    mark = (
        next((i for i in range(link + 2, len(flat)) if flat[i] in {",", ".", "!", ";", "and"}), 0)
        if link
        else 0
    )
    rest = tuple(key for key in flat[mark + 1 :] if key.isalpha()) if mark else ()
    while rest and rest[0] in _BEFORE_LOOK:
        rest = rest[1:]
    if flat[:1] not in {("the",), ("that",)} or rest not in _MERE_LOOKS:
        return words
    meant = scene.ground(words[:link])
    return (*tokens("check"), *words[:link]) if meant.outcome == "ambiguous" else words


_BEFORE_LOOK = frozenset({"please", "go", "and", "can", "could", "would", "you", "so", "then", "just", "to"})
_MERE_LOOKS = frozenset(
    tuple(text.split())
    for text in ("check", "look", "see", "have a look", "take a look", "check it", "inspect it", "look at it")
)


def _behind(words: Phrase) -> int:
    """How many words behind a noun say where it is."""
    flat = keys(words)
    return next((len(flat) - i for i in range(1, len(flat)) if lexicon().places.match(flat, i)), 0)


_NOT_THAT = frozenset(
    {
        ("not", "that", "one"),
        ("not", "this", "one"),
        ("not", "that"),
        ("not", "there"),
        ("not", "it"),
        ("not", "him"),
        ("no", "not", "that", "one"),
        ("no", "not", "there"),
        ("not", "those"),
        ("not", "these"),
        ("not", "them"),
    }
)


def _wrong_one(words: Phrase) -> Phrase:
    """For "you went to the wrong one, I wanted A": no, A."""
    flat = keys(words)
    cut = next((i for i in range(2, min(10, len(flat))) if flat[i] in {",", ".", "!", ";"}), 0)
    if flat[:cut] in _NOT_THAT and cut + 1 < len(flat):
        return (*tokens("no ,"), *words[cut + 1 :])
    if not cut or "wrong" not in flat[:cut] or cut + 2 > len(flat) or "not" in flat[:cut]:
        return words
    rest = words[cut + 1 :]
    wished = keys(rest[:2]) in {
        ("i", w) for w in ("wanted", "meant", "mean", "want", "said", "needed", "asked")
    }
    return (*tokens("no , i meant"), *rest[2:]) if wished else words


def _without_stand_in(words: Phrase, scene: Scene) -> Phrase:
    """For "the thing beside the desk, the printer": the printer."""
    flat = keys(words)
    for index in range(len(flat) - 4):
        if flat[index] != "the" or flat[index + 1] not in {"thing", "object", "place", "spot", "item", "one"}:
            continue
        comma = next((i for i in range(index + 2, min(index + 10, len(flat))) if flat[i] == ","), 0)
        if not comma or {"and", "or"} & set(flat[index:comma]):
            continue
        if flat[comma + 1 : comma + 2] and flat[comma + 1] in lexicon().goals_and_places:
            # "The one in a red hat, in the hall".
            continue
        end = next(
            (i for i in range(comma + 1, len(flat)) if flat[i] in {",", ".", "!", "?", "and", "then"}),
            len(flat),
        )
        if scene.ground(words[comma + 1 : end]).outcome == "match":
            return (*words[:index], *words[comma + 1 :])
    return words


def _named(words: Phrase, scene: Scene) -> list[MapObject]:
    return [item for phrase in mentioned(words, scene) for item in scene.ground(phrase).candidates[:1]]
