"""Follow-ups that only name another thing: the last order or question is meant, with that in its place.

"And the other belt?", "same at gate 4", "perhaps it is in the library": nothing but small words stand
around a name.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.turning import turned
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.grammar.things import Item, items_of
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.known import UnclearError
from parley.language.offline.scene.members import alike
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.world.object_map import MapObject

__all__ = ["elsewhere", "in_place_of_misspelt", "in_place_of_unclear", "put_in_place"]

_DATA = load_data("elsewhere")
_MARKS = frozenset(_DATA["marks"])
_SMALL = frozenset(_DATA["small"])
_PASSED = frozenset(tuple(text.split()) for text in _DATA["passed"])
_OTHERS = frozenset({"other", "others", "rest", "remaining"})
_ALL = frozenset({"all", "both", "each", "every", "everyone"})
_OF_THEM = frozenset({"of", "them", "these", "those", "the", "one", "single"})
_ONES = frozenset({"one", "ones"})
_AGAIN = frozenset(_DATA["again"])
_REPEATING = frozenset(_DATA["repeating"])
_EXCEPTING = frozenset({"except", "excluding", "apart", "excepting"})
_LONGEST = 16
_LONGEST_ORDER = 24
_DEEPEST = 4


def elsewhere(words: Phrase, situation: Situation, depth: int = 0) -> Phrase:
    """The last order or question, about what is named now; empty if a message is no such follow-up.

    Args:
        words: All words and punctuation.
        situation: What is known, with what was said before.
        depth: How many follow-ups lie between.
    """
    asked = _asked_before(situation.history)
    if asked is None or depth > _DEEPEST or not 0 < len(words) <= _LONGEST:
        return ()
    if _ONES & set(keys(words)) and _EXCEPTING & set(keys(words)):
        return ()
    scene = Scene.of(situation)
    again = _repeats(words)
    named = None if again else _named(words)
    if named is None and not again:
        return ()
    turn, before = asked
    earlier = Situation(
        message=turn.content,
        memory=situation.memory,
        history=before,
        objects=situation.objects,
        robot_pose=situation.robot_pose,
        robot=situation.robot,
        robots=situation.robots,
        catalogue=situation.catalogue,
    )
    said = tokens(turn.content)
    said = elsewhere(said, earlier, depth + 1) or said
    said = said if named is None else put_in_place(named, said, scene)
    asks = bool(said) and said[0].key in lexicon().be | {"has", "have", "does", "do", "did"}
    asks = asks and keys(said[:2]) not in {("have", "a"), ("have", "another"), ("do", "the")}
    turns = [turned(part, scene) for part in _sentences(said)] if asks else []
    if not turns or not all(turns):
        return said
    result: list[Word] = []
    for whether in turns:
        result += [*([Word(".", ".")] if result else []), *tokens("check whether"), *whether]
    return tuple(result)


def _sentences(words: Phrase) -> list[Phrase]:
    """What stands between full stops and question marks."""
    result: list[list[Word]] = [[]]
    for word in words:
        if word.key in {".", "?"}:
            result.append([])
        else:
            result[-1].append(word)
    return [tuple(part) for part in result if part]


def _asked_before(history: Sequence[Turn]) -> tuple[Turn, tuple[Turn, ...]] | None:
    """What the operator asked for last, and what was said before it; None if the robot asked back."""
    if history and history[-1].role != "operator" and "?" in history[-1].content[-80:]:
        return None
    for at in range(len(history) - 1, -1, -1):
        turn = history[at]
        spoken = tuple(word for word in tokens(turn.content) if word.is_word)
        if turn.role == "operator" and spoken and keys(spoken) not in _PASSED:
            return turn, tuple(history[:at])
    return None


def _repeats(words: Phrase) -> bool:
    """For "look again", "is it still there?": what was asked for last is meant as it was."""
    flat = keys(word for word in words if word.is_word)
    return bool(_AGAIN & set(flat)) and set(flat) <= _SMALL | _AGAIN | _REPEATING and len(flat) > 2


def _named(words: Phrase) -> Phrase | None:
    """What a follow-up names; None if more is said than that, or nothing marks it."""
    words = _instead_of(words)
    flat = keys(words)
    refused = flat[:2] == ("no", ",") and flat[2:3] in {("to",), ("at",), ("in",), ("for",), ("from",)}
    if (not _MARKS & set(flat) and "?" not in flat and not refused) or "but" in flat:
        return None
    inner = [i for i, word in enumerate(words) if word.is_word and word.key not in _SMALL]
    if not inner:
        return None
    start, end = inner[0], inner[-1] + 1
    if any(not word.is_word and word.key != "," for word in words[start:end]):
        return None
    tail = words[end : end + 1]
    if {"not"} & set(flat[start:end]) or (tail and tail[0].key in {"is", "are", "it"}):
        return None
    return words[start:end]


def _instead_of(words: Phrase) -> Phrase:
    """For "not A, B" and "B, not A": B instead."""
    said = tuple(word for word in words if word.is_word or word.key == ",")
    flat = keys(said)
    cut = flat.index(",") if flat.count(",") == 1 else 0
    if not cut or flat[:2] == ("not", ","):
        return words
    if flat[0] == "not":
        return (*said[cut + 1 :], Word("instead", "instead"))
    return (*said[:cut], Word("instead", "instead")) if flat[cut + 1 : cut + 2] == ("not",) else words


def put_in_place(named: Phrase, said: Phrase, scene: Scene) -> Phrase:
    """What was said, about what is named now; empty if it names nothing that could give way to that.

    Args:
        named: What is named now.
        said: An order or a question.
        scene: What is known.
    """
    items = items_of(said, scene)
    places = [i for i, item in enumerate(items) if item.thing is not None and not item.thing.known]
    if len(said) > _LONGEST_ORDER:
        return ()
    meant = [(at, _objects(items[at], scene)) for at in places]
    fitting = [(at, old, _meant(named, old, scene)) for at, old in meant if old]
    if len(fitting) > 1:
        # Two things were named before: what is of the same kind as one of them takes its place.
        fitting = [(at, old, new) for at, old, new in fitting if new and _kinds(new) == _kinds(old)]
    if len(fitting) != 1 or not fitting[0][2]:
        return _told_in_place(named, said, scene)
    at, old, new = fitting[0]
    if set(new) <= set(old):
        return ()
    before = tuple(word for item in items[:at] for word in item.words)
    after = tuple(word for item in items[at + 1 :] for word in item.words)
    after = tuple(Word("it", "it") if word.key in {"he", "she"} else word for word in after)
    while len(new) > 1 and after and not after[-1].is_word:
        after = after[:-1]
    result: list[Word] = []
    for item in new:
        result += [*([Word(".", ".")] if result else []), *before]
        result += [*tokens(the(describe(item, scene.objects))), *after]
    return tuple(result)


def _told_in_place(named: Phrase, said: Phrase, scene: Scene) -> Phrase:
    """For "where is A?" and "and B?", where one of them or both are remembered: the question about B."""
    noun = bool(named) and (named[0].key in lexicon().determiners or named[0].is_capital)
    if keys(said[:2]) in {("where", "is"), ("where", "are")} and noun and len(named) < 5:
        return (*said[:2], *named, *(said[-1:] if not said[-1].is_word else ()))
    if find_fact(named, scene.facts, locations=False)[0] is None:
        found = ground_phrase(named, scene.objects, scene.situation.robot_pose, strict=True)
        if found.outcome != "match":
            return ()
    flat, subjects = keys(said), {keys(bare(known.fact.subject)) for known in scene.facts}
    for size in range(4, 0, -1):
        for start in range(len(flat) - size + 1):
            if flat[start : start + size] in subjects:
                lead = start - (start > 0 and flat[start - 1] in lexicon().determiners)
                return (*said[:lead], *named, *said[start + size :])
    return ()


_NAME_ENDS = frozenset(
    {"and", "then", "for", "to", "at", "in", "on", "from", "with", "if", "whether", "please"}
)


def in_place_of_misspelt(named: Phrase, said: Phrase, scene: Scene) -> Phrase:
    """What was said, with `named` for the last name in it that only sounds like one of the map, or is none.

    Empty if there is no such name in it.

    Args:
        named: What is meant, after what the robot took it for was refused.
        said: The order whose name was not understood.
        scene: What is known.
    """
    for start in range(len(said) - 1, 0, -1):
        name = said[start : start + 1]
        if not name[0].is_word or said[start - 1].key not in {"the", "a", "an", "to"}:
            continue
        if ground_phrase(name, scene.objects, scene.situation.robot_pose).outcome == "match":
            kept = start - (said[start - 1].key != "to")
            return (*said[:kept], *named, *said[start + 1 :])
    for start in range(len(said) - 1, 0, -1):
        end = start
        while end < len(said) and said[end].is_word and said[end].key not in _NAME_ENDS:
            end += 1
        if said[start - 1].key in {"the", "a", "an"} and end > start:
            unknown = ground_phrase(said[start:end], scene.objects, strict=True).outcome == "none"
            return (*said[: start - 1], *named, *said[end:]) if unknown else ()
    return ()


def in_place_of_unclear(named: Phrase, said: Phrase, scene: Scene) -> Phrase:
    """What was said, with `named` for what could have been several things; empty if nothing could.

    Args:
        named: What is meant, and is none of those.
        said: The order that was asked about.
        scene: What is known.
    """
    for start in range(len(said)):
        if said[start].key not in lexicon().determiners:
            continue
        for end in range(min(len(said), start + 5), start + 1, -1):
            if ground_phrase(said[start:end], scene.objects).outcome == "ambiguous":
                return (*said[:start], *named, *said[end:])
    return ()


def _kinds(items: Sequence[MapObject]) -> set[str]:
    return {item.class_name for item in items}


def _objects(item: Item, scene: Scene) -> list[MapObject]:
    members = item.thing.members if item.thing is not None else ()
    found = (ground_phrase(member, scene.objects, scene.situation.robot_pose) for member in members)
    return [one.candidates[0] for one in found if one.outcome == "match"]


def _meant(named: Phrase, old: Sequence[MapObject], scene: Scene) -> list[MapObject]:
    """The things on the map that the follow-up names, the noun of the last order filled in."""
    flat = keys(named)
    noun = singular(_noun(old[0]))
    if _ALL & set(flat) and set(flat) <= _ALL | _OF_THEM | set(lexicon().numbers):
        # "Not just that one, all three".
        alike = [item for item in scene.objects if _kind_name(item) == _kind_name(old[0])]
        count = next((int(lexicon().numbers[key]) for key in flat if key in lexicon().numbers), len(alike))
        return alike if len(alike) == count > 1 else []
    if _OTHERS & set(flat):
        return _others(named, noun, old, scene)
    if flat[-1] in _ONES:
        named = (*named[:-1], Word(noun, noun))
    elif len(flat) == 1 and (flat[0].isdigit() or len(flat[0]) == 1):
        named = (Word(noun, noun), *named)
    try:
        phrases = scene.several(named)
    except UnclearError:
        phrases = []
    found = [ground_phrase(p, scene.objects, scene.situation.robot_pose) for p in phrases]
    if not found or any(one.outcome != "match" for one in found):
        alone = ground_phrase(
            (*named, Word(noun, noun)), scene.objects, scene.situation.robot_pose, strict=True
        )
        return list(alone.candidates) if alone.outcome == "match" else []
    return [one.candidates[0] for one in found]


def _noun(item: MapObject) -> str:
    """What a thing is called without its label."""
    words = [word.key for word in tokens(item.description) if word.is_word]
    plain_words = [word for word in words if not word.isdigit() and len(word) > 1]
    return plain_words[-1] if plain_words else words[-1]


def _kind_name(item: MapObject) -> str:
    """A description without its label: "dressing room" of "dressing room 2"."""
    words = [word.key for word in tokens(item.description) if word.is_word]
    return " ".join(word for word in words if not word.isdigit() and len(word) > 1)


def _others(named: Phrase, noun: str, old: Sequence[MapObject], scene: Scene) -> list[MapObject]:
    """For "the other one", "the rest of the gates": those of the kind that were not spoken of."""
    passed = _OTHERS | _ONES | _SMALL | set(lexicon().numbers) | {"of", "them", "all", "these", "those"}
    content = [key for key in keys(named) if key not in passed and key.isalpha()]
    if len(content) > 1:
        return []
    wanted = singular(content[0]) if content else noun
    kind = {old[0].class_name} if old[0].class_name else set()
    like = [item for item in scene.objects if _kind_name(item) == _kind_name(old[0])]
    things = like if len(like) > len(old) and not content else list(scene.objects)
    asked = " ".join(turn.content.lower() for turn in scene.situation.history if turn.role == "operator")
    words = keys(tokens(asked))
    found = [
        item
        for item in things
        if item not in old
        and (singular(_noun(item)) == wanted or (item.class_name in kind and not content))
        and not _spoken_of(item, words)
    ]
    found = list(alike(tuple(found), old))
    several = bool({"others", "rest", "remaining", "ones"} & set(keys(named))) or plain(named).endswith("s")
    count = next((lexicon().numbers[key] for key in keys(named) if key in lexicon().numbers), 1)
    return found if several or len(found) == int(count) else []


def _spoken_of(item: MapObject, words: tuple[str, ...]) -> bool:
    name = keys(tokens(item.description.lower()))
    return any(words[i : i + len(name)] == name for i in range(len(words) - len(name) + 1))
