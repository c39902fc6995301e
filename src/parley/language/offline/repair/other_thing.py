"""Another thing in the place of the one that a step failed on: "the other one", "use the table instead"."""

from __future__ import annotations

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.offline.facts.redirecting import redirects
from parley.language.offline.repair.failed_step import perceives, solved, with_words, words_of
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.tasks.catalogue import Catalogue, roles_of
from parley.language.offline.words.saying import the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, tokens
from parley.messages.chat import ActionCall, ChatAction
from parley.world.object_map import MapObject

__all__ = ["place_in_its_stead", "way_to", "with_other_thing"]

_LEADING = frozenset({"no", "then", "ok", "okay", "well", "so", "just", "rather", "sorry", "oh", "but"})
_TAKING = frozenset({"try", "take", "use", "choose", "pick"})
_SMALL = frozenset({"instead", "please", "then", "the", "a", "an", "one", "now"})
_MISSED = frozenset({FailureCode.BLOCKED, FailureCode.UNREACHABLE, FailureCode.TIMED_OUT})


def with_other_thing(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """For "try the blue one instead", "the other one": the failed step with another thing.

    Args:
        situation: The failure.
        reply: What the operator said.
    """
    words = tuple(word for word in tokens(reply) if word.is_word)
    while words and words[0].key in _LEADING:
        words = words[1:]
    flat = keys(words)
    taken = bool(words) and words[0].key in _TAKING
    named = tuple(w for w in (words[1:] if taken else words) if w.key not in {"instead", "please", "then"})
    old = _meant_so_far(situation)
    kind = set(keys(tokens(f"{old.description} {old.class_name}"))) if old is not None else set()
    if "other" in flat and set(flat) <= _SMALL | _TAKING | {"other"} | kind:
        new = _the_other(situation, old)
    else:
        new = _named(situation, named, old, taken=taken, instead="instead" in flat)
    return None if new is None else _with_it(situation, new)


def place_in_its_stead(situation: ErrorSituation) -> ChatAction | None:
    """Where the way to a place is barred: what is remembered to be used in its place."""
    if situation.code not in _MISSED or perceives(situation):
        return None
    old = _meant_so_far(situation)
    for _, said, entry in redirects(situation.memory) if old is not None else ():
        if ground_phrase(said.place, situation.objects).candidates != (old,):
            continue
        found = ground_phrase(said.other, situation.objects) if said.other else None
        if said.reopened or found is None or found.outcome != "match":
            return None
        repair = _with_it(situation, found.candidates[0])
        if repair is None:
            return None
        text = f"I remember: {whole_sentence(entry.data)} {repair.message_response}"
        return repair.model_copy(update={"message_response": text, "sources": (entry.name,)})
    return None


def way_to(situation: ErrorSituation, place: str) -> list[ActionCall] | None:
    """The steps that bring the robot to a place; None if it cannot go."""
    catalogue = Catalogue.of(situation.catalogue)
    mover = catalogue.mover
    return catalogue.chain(mover, {}, place, f"go to {the(place)}") if mover is not None else None


def _meant_so_far(situation: ErrorSituation) -> MapObject | None:
    """What the failed step is about, or what the operator named last for it."""
    said = [turn.content for turn in situation.dialogue if turn.role == "operator"][::-1]
    located = words_of(situation.failed_action) or _sent_to(situation)
    for text in (located, *said) if situation.code is not FailureCode.AMBIGUOUS else (*said, located):
        found = ground_phrase(tokens(text), situation.objects) if text else None
        if found is not None and found.outcome == "match":
            return found.candidates[0]
    return _said_to_be_barred(situation)


def _said_to_be_barred(situation: ErrorSituation) -> MapObject | None:
    """The thing of the map that the failure names as where it was to go ("no path to A")."""
    words = tuple(word for word in tokens(situation.error_message) if word.is_word)
    for at in range(len(words)):
        if words[at].key not in {"to", "reach", "towards"}:
            continue
        for end in range(min(len(words), at + 6), at + 1, -1):
            found = ground_phrase(words[at + 1 : end], situation.objects, strict=True)
            if found.outcome == "match":
                return found.candidates[0]
    return None


def _sent_to(situation: ErrorSituation) -> str:
    """The words of the place that the robot was to go to."""
    infos = {info.name: info for info in situation.catalogue}
    for step in reversed(situation.completed):
        if step.name in infos and "locate" in roles_of(infos[step.name]):
            return words_of(step)
    return ""


def _the_other(situation: ErrorSituation, old: MapObject | None) -> MapObject | None:
    """The only thing of the kind besides the one that was meant."""
    if old is None:
        return None
    head = keys(tokens(old.description))[-1:]
    same = [
        item
        for item in situation.objects
        if item.id != old.id
        and (
            item.class_name == old.class_name
            if old.class_name
            else keys(tokens(item.description))[-1:] == head
        )
    ]
    return same[0] if len(same) == 1 else None


def _named(
    situation: ErrorSituation, named: Phrase, old: MapObject | None, *, taken: bool, instead: bool
) -> MapObject | None:
    """The thing that a reply names, and nothing besides, to be taken in place of the old one."""
    bare_name = not perceives(situation) and situation.code in _MISSED
    if not named or not (taken or instead or (bare_name and old is not None)):
        return None
    found = ground_phrase(named, situation.objects, situation.robot_pose, strict=not taken)
    if found.outcome != "match" or found.candidates == (old,):
        return None
    new = found.candidates[0]
    known = set(keys(tokens(f"{new.description} {new.class_name}")))
    if not taken and not set(keys(named)) <= known | _SMALL:
        return None
    goes = not words_of(situation.failed_action)
    like = old is not None and new.class_name == old.class_name
    return new if instead or bare_name or like or (goes and old is None) else None


def _with_it(situation: ErrorSituation, new: MapObject) -> ChatAction | None:
    name = describe(new, situation.objects)
    step = situation.failed_action
    old = ground_phrase(tokens(words_of(step)), situation.objects) if words_of(step) else None
    like = old is not None and any(item.class_name == new.class_name for item in old.candidates)
    steps: list[ActionCall] | None
    if words_of(step):
        there = [] if like or not perceives(situation) else way_to(situation, name)
        steps = None if there is None else [*there, with_words(step, name)]
    else:
        steps = way_to(situation, name)
    return None if not steps else solved(situation, f"All right, I take {the(name)}.", steps)
