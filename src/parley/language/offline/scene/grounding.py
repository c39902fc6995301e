"""Which object of the map a description means.

Words are compared in steps, each looser than the one before: the same words, the same head noun with all
modifiers, words of the same meaning, a general word for that kind of thing, any words of the description, and
last typing errors. The first step that finds anything decides. Letters and numbers are compared exactly in
every step. Then what is said about the place, the size and the distance chooses among the finds.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from rapidfuzz import fuzz
from rapidfuzz.distance import OSA

from parley.language.base import Grounding
from parley.language.offline.scene import spatial
from parley.language.offline.scene.called import (
    Profile,
    comparable,
    head_of,
    is_label,
    profile_of,
    variants,
)
from parley.language.offline.scene.marks import members_of
from parley.language.offline.scene.sided import sided
from parley.language.offline.scene.viewing import by_view, is_view
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import NounPhrase, bare, noun_phrase
from parley.language.offline.words.text import (
    Phrase,
    Word,
    closest,
    plain,
    singular,
    tokens,
)
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = [
    "BESIDE",
    "describe",
    "ground",
    "ground_phrase",
    "matching",
    "uncounted",
    "with_kinds",
]


def ground(description: str, objects: Sequence[MapObject], pose: Pose2D | None = None) -> Grounding:
    """Find the object that `description` means, seen from `pose`."""
    return ground_phrase(tokens(description), objects, pose)


def ground_phrase(
    phrase: Phrase,
    objects: Sequence[MapObject],
    pose: Pose2D | None = None,
    among: Sequence[MapObject] = (),
    *,
    strict: bool = False,
) -> Grounding:
    """As `ground`, for words already cut.

    Args:
        phrase: The description.
        objects: The map.
        pose: The robot's.
        among: The only objects that may be meant, if given; the others may still be referred to.
        strict: Whether the object must be called so: no other word of its description, no typing error.
    """
    if among or not isinstance(objects, tuple):
        return _ground(phrase, objects, pose, among, strict=strict)
    known = _LOOKED_UP.of(objects)
    key = (phrase, pose, strict)
    if key not in known:
        known[key] = _ground(phrase, objects, pose, (), strict=strict)
    return known[key]


@dataclass(slots=True)
class _LookedUp:
    """What was found on the map that was asked about last; one message asks about the same words often."""

    objects: tuple[MapObject, ...] = ()
    found: dict[tuple[Phrase, Pose2D | None, bool], Grounding] = field(default_factory=dict)

    def of(self, objects: tuple[MapObject, ...]) -> dict[tuple[Phrase, Pose2D | None, bool], Grounding]:
        if objects is not self.objects or len(self.found) > _MOST_LOOKED_UP:
            self.objects, self.found = objects, {}
        return self.found


_LOOKED_UP = _LookedUp()
_MOST_LOOKED_UP = 10_000


def _ground(
    phrase: Phrase,
    objects: Sequence[MapObject],
    pose: Pose2D | None,
    among: Sequence[MapObject],
    *,
    strict: bool,
) -> Grounding:
    eligible = among or objects
    written = plain(phrase).lower()
    named = [item for item in eligible if item.description.lower() == written] if len(phrase) > 1 else []
    if len(named) == 1:
        return Grounding("match", (named[0],))
    together = members_of(phrase, eligible) if len(bare(phrase)) == 1 else []
    if together:
        return _grounding(together)
    by_id = [item for item in eligible if item.id.lower() == plain(phrase).lower()]
    if by_id and not _is_kind(plain(phrase).lower(), eligible):
        return Grounding("match", (by_id[0],))
    whole = bare(phrase)
    if not whole or not objects:
        return Grounding("none")
    profiles = [profile_of(item) for item in eligible]
    exact = _exact(whole, profiles)
    if exact:
        return _grounding(exact)
    noun = noun_phrase(phrase)
    noun = sided(noun)
    if not noun.core and noun.anchors:
        # "in front of the door", "next to the box": the object named is what is meant (thesis 5.1.1).
        return ground_phrase(noun.anchors[0], eligible, pose, strict=strict)
    found, leftover = _candidates(noun, profiles, strict=strict)
    if not found:
        return Grounding("none", tuple(_near_misses(noun, eligible)))
    if noun.relation and ("between" in noun.relation or spatial.is_across(noun.relation)):
        found = _of_a_kind(noun, found, profiles, objects, pose)
    return _grounding(_narrow(noun, leftover, found, objects, pose))


def _is_kind(word: str, objects: Sequence[MapObject]) -> bool:
    """Whether a word is what several things are, and the description of none: an id, then, is no name."""
    if any(item.description.lower() == word for item in objects):
        return False
    return sum(item.class_name.lower() == word for item in objects) > 1


def matching(phrase: Phrase, objects: Sequence[MapObject], pose: Pose2D | None = None) -> list[MapObject]:
    """Every object that a description fits, for "all chairs" and the like."""
    found = ground_phrase(phrase, objects, pose)
    return [] if found.outcome == "none" else list(found.candidates)


def describe(item: MapObject, objects: Iterable[MapObject]) -> str:
    """The words that name an object: its description, or its id where another has the same description."""
    same = [other for other in objects if other.description.lower() == item.description.lower()]
    return item.description if len(same) <= 1 else item.id


def _exact(phrase: Phrase, profiles: Sequence[Profile]) -> list[MapObject]:
    wanted = comparable(phrase)
    same = [profile.item for profile in profiles if wanted in profile.names]
    if same and not (len(wanted) == 1 and _is_kind(wanted[0], [profile.item for profile in profiles])):
        return same
    others = set(variants(wanted)[1:])
    return [profile.item for profile in profiles if others & profile.names and _labels_fit(wanted, profile)]


def _candidates(
    noun: NounPhrase, profiles: Sequence[Profile], *, strict: bool
) -> tuple[list[Profile], tuple[str, ...]]:
    """Profiles that fit the core of the phrase, and the modifiers that no description settles."""
    core = noun.core
    generic = _without_generic(core, profiles)
    settled = tuple(word for word in generic if not _settled_later(word))
    if not settled:
        told = [p for p in _by_any_word(generic, profiles) if _labels_fit(generic, p)] if generic else []
        return (told, ()) if told else (list(profiles), generic)
    later = tuple(word for word in generic if _settled_later(word))
    steps = (_by_head, _by_synonym, _by_kind, _by_any_word, _by_typo)
    for step in steps[:-2] if strict else steps:
        for words, rest in ((generic, ()), (settled, later)):
            found = [profile for profile in step(words, profiles) if _labels_fit(words, profile)]
            if found:
                return found, rest
    return [], ()


_LARGE = ("large", "big", "huge", "largest", "biggest", "larger", "bigger")
_SMALL = ("small", "little", "tiny", "smallest", "smaller")
_SIZES = dict.fromkeys(_LARGE, 1.0) | dict.fromkeys(_SMALL, -1.0)


def _settled_later(word: str) -> bool:
    return word in _SIZES or is_view(word)


def _without_generic(core: tuple[str, ...], profiles: Sequence[Profile]) -> tuple[str, ...]:
    """Drop "one", "thing" and the like where no object is called so ("area one" is "area 1")."""
    known = {word for profile in profiles for word in profile.words}
    heads = {head for profile in profiles for head in profile.heads}
    if len(core) > 1 and core[-1] == "one" and "1" in known and core[-2] in heads | {"number"}:
        return (*core[:-1], "1")
    dropped = lexicon().generic_things | {"number", "kind"}
    return tuple(word for word in core if word not in dropped or word in known)


def _by_head(words: tuple[str, ...], profiles: Sequence[Profile]) -> list[Profile]:
    head = head_of(words)
    return [p for p in profiles if head in p.heads and set(words) <= p.words | p.heads]


def _by_synonym(words: tuple[str, ...], profiles: Sequence[Profile]) -> list[Profile]:
    return _unique(p for other in variants(words)[1:] for p in _by_head(other, profiles))


def _by_kind(words: tuple[str, ...], profiles: Sequence[Profile]) -> list[Profile]:
    head = head_of(words)
    members = lexicon().kinds.get(head, frozenset())
    rest = set(words) - {head}
    return [p for p in profiles if p.heads & members and rest <= p.words]


def _by_any_word(words: tuple[str, ...], profiles: Sequence[Profile]) -> list[Profile]:
    return _unique(p for other in variants(words) for p in profiles if set(other) <= p.words)


def _by_typo(words: tuple[str, ...], profiles: Sequence[Profile]) -> list[Profile]:
    known = {word for profile in profiles for word in profile.words | profile.heads}
    common = lexicon().synonyms
    known_words = lexicon().nouns | lexicon().person_words
    mended = tuple(
        word
        if word in known or word in common or word in known_words or is_label(word)
        else closest(word, known, dropped=word not in lexicon().vocabulary)
        or closest(f"{word}s", known)
        or word
        for word in words
    )
    if mended == words and len(words) > 1 and words[0] in known:
        mended = _mended_beside(words, profiles)
    if mended == words:
        joined = "".join(words)
        return _by_head((joined,), profiles) if len(words) > 1 else []
    return _by_head(mended, profiles) or _by_synonym(mended, profiles) or _by_any_word(mended, profiles)


def _mended_beside(words: tuple[str, ...], profiles: Sequence[Profile]) -> tuple[str, ...]:
    """A short last word mended where all others fit one object: "charging pol" beside "charging pole"."""
    fitting = [p for p in profiles if set(words[:-1]) <= p.words]
    heads = {head for p in fitting for head in p.heads if head[:1] == words[-1][:1] and len(words[-1]) > 2}
    near = [head for head in heads if OSA.distance(head, words[-1]) == 1]
    unknown = words[-1] not in lexicon().vocabulary | lexicon().nouns and not is_label(words[-1])
    return (*words[:-1], near[0]) if len(near) == 1 and unknown else words


def _labels_fit(words: Iterable[str], profile: Profile) -> bool:
    """Letters and numbers must be there exactly: "area A" is never "area B"."""
    return all(word in profile.words for word in words if is_label(word))


def _unique(profiles: Iterable[Profile]) -> list[Profile]:
    return list({profile.item.id: profile for profile in profiles}.values())


def _narrow(
    noun: NounPhrase,
    leftover: tuple[str, ...],
    found: list[Profile],
    objects: Sequence[MapObject],
    pose: Pose2D | None,
) -> list[MapObject]:
    """Choose among finds by place, size and distance."""
    items = [profile.item for profile in found]
    if noun.relation and len(items) > 1:
        items = _by_relation(noun, found, objects, pose)
    for word in leftover:
        if len(items) < 2:
            break
        if word in _SIZES:
            sized = spatial.by_size(items, _SIZES[word])
            said = [i for i in items if any(set(o) <= profile_of(i).words for o in variants((word,)))]
            items = said if len(sized) > 1 and said else sized
        else:
            items = by_view(items, word, pose, objects)
    return items


def _by_relation(
    noun: NounPhrase, found: list[Profile], objects: Sequence[MapObject], pose: Pose2D | None
) -> list[MapObject]:
    items = [profile.item for profile in found]
    anchors = _anchors(noun, found, objects, pose)
    wanted = tuple(sorted({word for anchor in noun.anchors for word in comparable(anchor)}))
    compares = "between" in noun.relation or noun.relation.startswith(("far", "fur", "away"))
    told = (
        []
        if compares and len(anchors) == len(noun.anchors)
        else [
            p.item
            for p in found
            if any(set(other) <= p.words for other in variants(wanted))
            and (p.item not in anchors or noun.relation == "with")
        ]
    )
    if "between" in noun.relation and len(noun.anchors) == 1:
        told = []
    if len(anchors) == 2 and set(noun.core) <= lexicon().generic_things:
        # "The thing between A and B": anything that really is.
        inside = spatial.between(items, *anchors)
        return spatial.by_anchor(inside, noun.relation, anchors, pose) or items
    if told or len(anchors) < len(noun.anchors):
        return told or _beside_any(noun, items, objects, pose)
    return spatial.by_anchor([i for i in items if i not in anchors] or items, noun.relation, anchors, pose)


def _beside_any(
    noun: NounPhrase, items: list[MapObject], objects: Sequence[MapObject], pose: Pose2D | None
) -> list[MapObject]:
    """For "the desk by the window(s)", where there are several of both: those that stand together."""
    if len(noun.anchors) != 1 or noun.relation not in BESIDE:
        return items
    others = ground_phrase(noun.anchors[0], objects, pose)
    if others.outcome != "ambiguous" or not all(
        _is_called(one, noun.anchors[0]) for one in others.candidates
    ):
        return items
    return spatial.nearest_to_any(items, others.candidates)


BESIDE = frozenset({
    "next to", "right next to", "by", "right by", "near", "near to", "beside", "close to", "alongside",
    "adjacent to", "nearby", "nearest to", "closest to", "nearest", "closest", "at", "with",
})  # fmt: skip
"""Relations by which a thing stands close to another."""


def _anchors(
    noun: NounPhrase, found: list[Profile], objects: Sequence[MapObject], pose: Pose2D | None
) -> list[MapObject]:
    """What something is said to be beside, between or across from, as far as it is known."""
    items = {profile.item.id for profile in found}
    anchors: list[MapObject] = []
    for anchor in with_kinds([_named_so(part, noun) for part in noun.anchors], noun.core):
        where = ground_phrase(anchor, [o for o in objects if o.id not in items] or objects, pose)
        if where.outcome != "match" or not _is_called(where.candidates[0], anchor):
            where = ground_phrase(anchor, objects, pose)
        if where.outcome == "match" and _is_called(where.candidates[0], anchor):
            anchors.append(where.candidates[0])
    if "between" in noun.relation and len(noun.anchors) == 1:
        pair = ground_phrase(uncounted(noun.anchors[0]), objects, pose)
        if pair.outcome == "ambiguous" and len(pair.candidates) == 2:
            return list(pair.candidates)
    return anchors


def _of_a_kind(
    noun: NounPhrase,
    found: list[Profile],
    profiles: Sequence[Profile],
    objects: Sequence[MapObject],
    pose: Pose2D | None,
) -> list[Profile]:
    """What is only of that kind ("room" for a hall), where nothing called so is between two things."""
    anchors = _anchors(noun, found, objects, pose)
    if len(anchors) != 2 or spatial.between([p.item for p in found], *anchors):
        return found
    head = head_of(noun.core)
    compounds = [p for p in profiles if head and any(word.endswith(head) for word in p.heads)]
    kinds = _by_synonym(noun.core, profiles) + _by_kind(noun.core, profiles) + compounds
    wider = [p for p in _unique(kinds) if p.item not in anchors]
    inside = spatial.between([p.item for p in wider], *anchors)
    return [p for p in wider if p.item in inside] or found


def _named_so(anchor: Phrase, noun: NounPhrase) -> Phrase:
    """For "(the box between) the red one (and the blue one)": the red box."""
    kind = next((word for word in reversed(noun.core) if not is_label(word)), "")
    at = next((i for i, word in enumerate(anchor) if word.key in {"one", "ones"}), -1)
    if at < 0 or not kind or len(anchor) < 2:
        return anchor
    return (*anchor[:at], Word(kind, kind), *anchor[at + 1 :])


def with_kinds(anchors: Sequence[Phrase], core: Sequence[str] = ()) -> list[Phrase]:
    """For "(between) berths 3 and 4" "berth 3" and "berth 4"; for "(the area between) B and D" the areas.

    Args:
        anchors: What something is said to be between.
        core: What it is called itself.
    """
    kind = next((word for word in reversed(core) if not is_label(word)), "")
    head: Phrase = (Word(kind, kind),) if kind else ()
    result: list[Phrase] = []
    for anchor in anchors:
        named = bare(anchor)
        labelled = bool(named) and is_label(named[-1].key)
        if labelled and len(named) > 1:
            last = named[-2]
            head = (*named[:-2], Word(singular(last.key), singular(last.raw)))
        result.append((*head, named[-1]) if labelled and len(anchors) > 1 and head else anchor)
    return result


def uncounted(phrase: Phrase) -> Phrase:
    """For "the two doors" "the doors"."""
    words = bare(phrase)
    while len(words) > 1 and (words[0].key in lexicon().numbers or words[0].key in {"both", "all"}):
        words = bare(words[1:])
    return words


def _is_called(item: MapObject, phrase: Phrase) -> bool:
    """Whether the phrase names the object itself and not only something its description mentions."""
    profile = profile_of(item)
    core = noun_phrase(phrase).core
    return comparable(bare(phrase)) in profile.names or any(
        head_of(o) in profile.heads for o in variants(core)
    )


def _near_misses(noun: NounPhrase, objects: Sequence[MapObject]) -> list[MapObject]:
    """Up to three objects that sound or mean something like it."""
    words = set(noun.core)
    text = " ".join(noun.core)
    scored = sorted(
        ((_likeness(words, text, item), -index, item) for index, item in enumerate(objects)),
        key=lambda s: s[:2],
        reverse=True,
    )
    return [item for score, _, item in scored[:3] if score > 0.62]


def _likeness(words: set[str], text: str, item: MapObject) -> float:
    profile = profile_of(item)
    shared = len({word for word in words & profile.words if not is_label(word)})
    return shared + fuzz.ratio(text, item.description.lower()) / 100.0


def _grounding(items: Sequence[MapObject]) -> Grounding:
    return Grounding("match" if len(items) == 1 else "ambiguous", tuple(items))
