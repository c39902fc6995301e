"""Repairs that need no question (thesis 4.3.7.3): a protocol, changed memory, mended words, a missing step.

Each is a small named condition on the failure's code and facts; what was tried in vain is not tried again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, Situation
from parley.language.offline.facts.protocols import Protocol, applying
from parley.language.offline.facts.remembering import Remembered, find_fact, remembered
from parley.language.offline.repair.failed_step import perceives, solved, with_words, words_of
from parley.language.offline.repair.other_thing import place_in_its_stead, way_to, with_other_thing
from parley.language.offline.repair.prose import says_away
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import place_said
from parley.language.offline.tasks.catalogue import roles_of
from parley.language.offline.tasks.commands import read_command
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["NEAR_M", "Interpret", "as_message", "looked_there", "remembered_places", "repaired_alone"]

Interpret = Callable[[Situation], ChatAction]
"""Understands an order; handed in, because understanding messages is built on top of this."""

_MOST_HOPS = 4
NEAR_M = 2.5
"""Farther away from a thing than this, looking at it is worth another try from close by."""


def repaired_alone(
    situation: ErrorSituation, candidates: Sequence[MapObject], interpret: Interpret
) -> ChatAction | None:
    """The first repair that is known to fit and was not tried yet, or None: then the operator is asked."""
    for repair in (
        _by_protocol(situation, interpret),
        place_in_its_stead(situation),
        _among(situation, candidates),
        _moved(situation),
        _looked_for_elsewhere(situation),
        _better_words(situation),
        _from_close_by(situation),
        _with_what_was_missing(situation),
    ):
        if repair is not None and not _tried(situation, repair):
            return repair
    return None


def _tried(situation: ErrorSituation, repair: ChatAction) -> bool:
    wanted = [_key(step) for step in repair.queue]
    return bool(wanted) and any([_key(step) for step in steps] == wanted for steps in situation.tried)


def _key(step: ActionCall) -> tuple[object, ...]:
    words = tuple((name, p.value) for name, p in step.input_parameters.items() if p.type == "string")
    return step.name, words


# -- protocols --


def _by_protocol(situation: ErrorSituation, interpret: Interpret) -> ChatAction | None:
    for protocol, entry in applying(situation):
        repair = _carried_out(protocol, situation, interpret)
        if repair is not None and not _tried(situation, repair):
            return repair.model_copy(update={"sources": (entry.name,)})
    return None


def _carried_out(protocol: Protocol, situation: ErrorSituation, interpret: Interpret) -> ChatAction | None:
    """What a protocol asks for as a correction; None if it only asks to tell or ask the operator."""
    failed = whole_sentence(situation.error_message)
    told = f"You told me: “{protocol.sentence}”."
    if protocol.has("cancel"):
        text = f"{failed} {told} So I drop the rest of the plan."
        return solved(situation, text, [], [SystemCommand(command="clear")])
    if protocol.has("stop"):
        text = f"{failed} {told} So I have stopped. Say “carry on” to try again, or tell me what to do."
        return solved(situation, text, [], [SystemCommand(command="stop")])
    steps: list[ActionCall] = []
    for act in protocol.acts:
        if act.kind in ("again", "around"):
            steps.append(situation.failed_action)
        elif act.kind == "order":
            ordered = _ordered_by(act.words, situation, interpret)
            if not ordered:
                return None
            steps += ordered
    if not steps and not protocol.has("skip"):
        return None
    repair = solved(situation, f"{failed} {told} I do so now.", steps)
    return repair.model_copy(update={"delay_s": protocol.delay_s})


def _ordered_by(words: str, situation: ErrorSituation, interpret: Interpret) -> tuple[ActionCall, ...]:
    """The steps of an order of a rule; "use B" means B in the place of what failed."""
    other = with_other_thing(situation, words)
    if other is not None:
        return other.queue
    return looked_there(situation, words) or interpret(as_message(situation, words)).queue


def looked_there(situation: ErrorSituation, words: str) -> tuple[ActionCall, ...]:
    """For "look on the shelf", where something could not be seen: go there and look for it; else nothing."""
    command = read_command(tokens(words), lambda _: False) if perceives(situation) else None
    place = command.place or command.theme if command is not None else ()
    if command is None or command.kind not in {"look", "search"} or not place:
        return ()
    found = ground_phrase(place, situation.objects, situation.robot_pose)
    wanted = set(keys(tokens(words_of(situation.failed_action))))
    if found.outcome != "match" or wanted & set(keys(place)):
        return ()
    steps = way_to(situation, describe(found.candidates[0], situation.objects))
    return (*steps, situation.failed_action) if steps is not None else ()


def as_message(situation: ErrorSituation, words: str) -> Situation:
    """What is known about a failure, for understanding `words` as a message of their own."""
    return Situation(
        words,
        memory=situation.memory,
        objects=situation.objects,
        robot_pose=situation.robot_pose,
        robot=situation.robot,
        catalogue=situation.catalogue,
    )


# -- memory --


def _among(situation: ErrorSituation, candidates: Sequence[MapObject]) -> ChatAction | None:
    """The candidate that a fact about what this step is for singles out."""
    if situation.code is not FailureCode.AMBIGUOUS or len(candidates) < 2:
        return None
    about = set(keys(tokens(situation.failed_action.reason)))
    for item in remembered(situation.memory):
        fact = item.fact
        subject = set(noun_phrase(fact.subject).core)
        if not fact.is_location or fact.negated or not subject or not subject <= about:
            continue
        found = ground_phrase(fact.place, candidates)
        if found.outcome == "match":
            words = describe(found.candidates[0], candidates)
            text = f"I remember: {whole_sentence(fact.sentence)} So I take {the(words)}."
            return _with_other_words(situation, words, text, item.entry)
    return None


def _moved(situation: ErrorSituation) -> ChatAction | None:
    """What the map does not know by its name is remembered to be somewhere that it knows."""
    if situation.code is not FailureCode.NO_MATCH or perceives(situation):
        return None
    item = _fact_about(tokens(words_of(situation.failed_action)), situation)
    if item is None:
        return None
    found = ground_phrase(item.fact.place, situation.objects)
    if found.outcome != "match":
        return None
    words = describe(found.candidates[0], situation.objects)
    return _with_other_words(
        situation, words, f"I remember: {whole_sentence(item.fact.sentence)}", item.entry
    )


def remembered_places(situation: ErrorSituation) -> tuple[str, list[MapObject]]:
    """For a thing that the map lacks: what is remembered of where it is, if several places fit that."""
    if situation.code is not FailureCode.NO_MATCH or perceives(situation):
        return "", []
    item = _fact_about(tokens(words_of(situation.failed_action)), situation)
    found = ground_phrase(item.fact.place, situation.objects) if item is not None else None
    if item is None or found is None or found.outcome != "ambiguous":
        return "", []
    return whole_sentence(item.fact.sentence), list(found.candidates)


def _looked_for_elsewhere(situation: ErrorSituation) -> ChatAction | None:
    """What is not to be seen here is remembered to be in another place: go there and look."""
    if situation.code is not FailureCode.NO_MATCH or not perceives(situation):
        return None
    item = _fact_about(tokens(words_of(situation.failed_action)), situation)
    found = ground_phrase(item.fact.place, situation.objects) if item is not None else None
    if item is None or found is None or found.outcome != "match":
        return None
    place = found.candidates[0]
    if _is_at(situation, place) and not _sees_another_place(situation, place):
        return None
    words = describe(place, situation.objects)
    steps = way_to(situation, words)
    if steps is None:
        return None
    text = f"I remember: {whole_sentence(item.fact.sentence)} I go to {the(words)} and look there."
    return solved(situation, text, [*steps, situation.failed_action]).model_copy(
        update={"sources": (item.entry.name,)}
    )


def _sees_another_place(situation: ErrorSituation, place: MapObject) -> bool:
    """Whether what was seen is a thing of the map, and not the one where something should be."""
    seen = situation.details.get("seen")
    names = [str(item) for item in seen] if isinstance(seen, list | tuple) else []
    found = [ground_phrase(tokens(name), situation.objects, strict=True) for name in names]
    known = [one.candidates[0].id for one in found if one.outcome == "match"]
    return bool(known) and place.id not in known


def _fact_about(wanted: Phrase, situation: ErrorSituation) -> Remembered | None:
    """The one fact that says where the thing is now."""
    phrase, facts = bare(wanted), remembered(situation.memory)
    found = find_fact(phrase, facts)[0] if phrase else None
    for _ in range(_MOST_HOPS):
        # What something is in may be remembered to be somewhere itself.
        place = bare(found.fact.place) if found is not None else ()
        if not place or ground_phrase(place, situation.objects).outcome != "none":
            break
        found = find_fact(place, facts)[0] or found
    return found


def _with_other_words(
    situation: ErrorSituation, words: str, text: str, entry: MemoryEntry | None = None
) -> ChatAction:
    repair = solved(situation, text, [with_words(situation.failed_action, words)])
    return repair.model_copy(update={"sources": (entry.name,)}) if entry is not None else repair


# -- parameters and missing steps --


def _better_words(situation: ErrorSituation) -> ChatAction | None:
    """A place that was given as a whole order or with words around it ("go to the box")."""
    if situation.code is not FailureCode.NO_MATCH or perceives(situation):
        return None
    said = tokens(words_of(situation.failed_action))
    command = read_command(said, lambda _: False)
    place = command.place if command is not None and command.place else ()
    if not place:
        where = place_said(said)
        place = where[1] if where is not None else ()
    if not place or keys(place) == keys(said):
        return None
    found = ground_phrase(place, situation.objects, situation.robot_pose)
    if found.outcome != "match":
        return None
    words = describe(found.candidates[0], situation.objects)
    return _with_other_words(situation, words, f"I take “{plain(said)}” to mean {the(words)}.")


def _from_close_by(situation: ErrorSituation) -> ChatAction | None:
    """A thing was looked at from where it cannot be seen well: go there first."""
    if situation.code not in {FailureCode.NO_MATCH, FailureCode.BLOCKED} or not perceives(situation):
        return None
    found = ground_phrase(tokens(words_of(situation.failed_action)), situation.objects, situation.robot_pose)
    away = says_away(situation.error_message)
    if found.outcome != "match" and away:
        found = ground_phrase(_behind_away(situation.error_message), situation.objects, situation.robot_pose)
    if found.outcome != "match" or (not away and _is_at(situation, found.candidates[0])):
        return None
    words = describe(found.candidates[0], situation.objects)
    steps = way_to(situation, words)
    if steps is None:
        return None
    text = f"I am not at {the(words)}. I go there and look again."
    return solved(situation, text, [*steps, situation.failed_action])


def _behind_away(message: str) -> Phrase:
    """The thing that a failure says the robot is not near."""
    words = tokens(message)
    flat = keys(words)
    at = max(
        (i for i in range(len(flat)) if flat[i] in {"near", "from", "to", "of", "at"}), default=len(flat)
    )
    return bare(tuple(word for word in words[at + 1 :] if word.is_word))


def _with_what_was_missing(situation: ErrorSituation) -> ChatAction | None:
    """Something that an earlier step gives never arrived: do that step again first."""
    step, missing = situation.failed_action, situation.details.get("missing")
    blank = {str(name) for name in missing} if isinstance(missing, list) else set()
    giver = next((s for s in reversed(situation.completed) if blank & set(s.output_parameters)), None)
    if not blank or giver is None:
        return None
    return solved(situation, "Something I need for this step got lost. I work it out again.", [giver, step])


def _is_at(situation: ErrorSituation, thing: MapObject) -> bool:
    """Whether the robot stands by a thing: it was sent there last, or is near."""
    infos = {info.name: info for info in situation.catalogue}
    for step in reversed(situation.completed):
        info = infos.get(step.name)
        if info is not None and roles_of(info) & {"locate", "motion"} and words_of(step):
            found = ground_phrase(tokens(words_of(step)), situation.objects)
            if found.outcome == "match" and found.candidates[0].id == thing.id:
                return True
            break
    pose = situation.robot_pose
    if pose is None:
        return False
    dx = max(abs(pose.x_m - thing.x_m) - thing.width_m / 2, 0.0)
    dy = max(abs(pose.y_m - thing.y_m) - thing.height_m / 2, 0.0)
    return dx * dx + dy * dy <= NEAR_M * NEAR_M
