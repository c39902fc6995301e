"""Questions about what is planned, being done or done, told by all of their words.

With the names of stops taken out only small words and words for plans and progress may be left (`planning` in
`data/questions.yaml`): "is the hall still on your list?", "are you nearly through?", "have you been to the
desk yet?", "when is it the gate's turn?".
"""

from __future__ import annotations

from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.dialogue.own_state import step_words
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.plan_changes.replanning import Visit, visit_of, visits
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, tokens
from parley.language.word_lists import load_data

__all__ = ["of_plan"]

_DATA = load_data("questions")["planning"]
_MARKS = frozenset(_DATA["marks"])
_SMALL = frozenset(_DATA["small"]) | _MARKS
_DONE = frozenset(_DATA["done"])
_GOING = frozenset(_DATA["going"])
_OMITTING = frozenset(_DATA["omitting"])
_RANKING = frozenset({"first", "next", "last", "before", "after"})
_WH = frozenset({"what", "where", "which", "who", "how", "when", "why"})
_MOVING = frozenset({"going", "heading", "headed", "bound", "driving", "doing"})
_PLANNING = {("will", "you"), ("are", "you"), ("do", "you")}
_LISTS = frozenset(
    {"list", "plan", "route", "tour", "round", "queue", "agenda", "schedule", "itinerary", "programme"}
)
_LATE = frozenset({"when", "soon", "turn", "long"})


def of_plan(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """The answer to a question about what is planned or done; None if it is none.

    Args:
        words: The question.
        flat: The same, as its words are compared.
        scene: What is known.
    """
    said = tuple(Word(w.key.removesuffix("'s"), w.raw.removesuffix("'s")) for w in words)
    names = mentioned(said[: _list_at(keys(said))], scene)
    rest = _without(keys(said), [keys(name) for name in names])
    at = visit_of(names[-1], scene) if names else None
    marked = set(rest) & _MARKS or (at is not None and rest[:2] in _PLANNING)
    if not rest or not set(rest) <= _SMALL or not marked or rest[0] == "why" or "not" in rest[:2]:
        return None
    if _RANKING & set(rest) and rest[0] in _WH:
        # What comes before or behind a stop is another question.
        return None
    if not names:
        return _in_all(rest, scene)
    if _DONE & {*rest, *map(lemma, rest)} and _is_past(rest) and not _OMITTING & set(rest):
        return _whether_done(names[-1], at, rest, scene)
    if not scene.situation.queue:
        return None
    name = the(plain(names[-1]))
    if at is None:
        return None if rest[0] in _WH else Answer(_not_planned(name, rest, scene))
    name, place = _name(visits(scene)[at]), _place(visits(scene), at)
    if rest[0] in _WH or _LATE & set(rest):
        return Answer(whole_sentence(f"{name} is {place}"))
    if _GOING & set(rest) and "on" in rest and "way" in rest and at:
        return Answer(f"Yes, I am on my way to {name}: it is {place}.")
    ranked = {"first": at == 0, "next": at <= 1, "last": at == len(visits(scene)) - 1}
    fits = all(right for word, right in ranked.items() if word in rest)
    lead = "" if _OMITTING & set(rest) else "Yes, " if fits else "No, "
    return Answer(whole_sentence(f"{lead}{name} is {place}"))


def _list_at(flat: tuple[str, ...]) -> int:
    """Where "on your list", "part of the plan" begins, which is part of no name; else where all ends."""
    for at in range(1, len(flat) - 2):
        if flat[at] in {"on", "in", "of"} and flat[at + 1] in {"your", "the"} and flat[at + 2] in _LISTS:
            return at
    return len(flat)


def _without(flat: tuple[str, ...], names: list[tuple[str, ...]]) -> tuple[str, ...]:
    """The words besides the names."""
    left = list(flat)
    for name in names:
        at = next((i for i in range(len(left)) if tuple(left[i : i + len(name)]) == name), -1)
        left[at : at + len(name)] = [] if at >= 0 else left[at : at + len(name)]
    return tuple(left)


def _is_past(rest: tuple[str, ...]) -> bool:
    """Whether a question asks for what was done, not for what will be."""
    later = {"will", "going", "would", "should", "can", "could", "when", "soon"} & set(rest)
    return not later and bool(
        {"have", "has", "did", "was", "were", "been", "done", "is", "are", "already"} & set(rest)
    )


def _whether_done(name: Phrase, at: int | None, rest: tuple[str, ...], scene: Scene) -> Answer | None:
    if at is not None:
        now = "I am on it now" if at == 0 else "it is still on my list"
        return Answer(f"Not yet, {now}.")
    asked = any(
        name in mentioned(tokens(turn.content), scene)
        or f" {' '.join(keys(name))} " in f" {' '.join(keys(tokens(turn.content)))} "
        for turn in scene.situation.history
        if turn.role == "operator"
    )
    if asked:
        return Answer(f"Yes, as far as I know: {the(plain(name))} is not among what I still have to do.")
    own = "you" in rest
    return Answer(f"No, nobody has sent me to {the(plain(name))} yet. Shall I go?") if own else None


def _not_planned(name: str, rest: tuple[str, ...], scene: Scene) -> str:
    lead = f"{name} is" if _OMITTING & set(rest) else f"no, {name} is"
    now = step_words(scene.situation.queue[0])
    return f"{whole_sentence(f'{lead} not in my plan')} I am at this step: {now}."


def _place(listed: list[Visit], at: int) -> str:
    behind = f", after {listing([_name(v) for v in listed[:at]])}" if at else ""
    return f"stop {at + 1} of {len(listed)}{behind}"


def _name(visit: Visit) -> str:
    return the(visit.names[0]) if visit.names else step_words(visit.steps[0])


def _in_all(rest: tuple[str, ...], scene: Scene) -> Answer | None:
    """How far the robot is with all of it."""
    mine = {"you", "your", "left", "remain", "remains", "remaining", "pending", "plan", "list", "queue"}
    if not mine & set(rest) or {"i", "we"} & set(rest[1:2]) or (rest[0] in _WH and _MOVING & set(rest)):
        return None
    listed = visits(scene)
    if not listed:
        return Answer("Nothing is left to do. I am waiting for your instructions.")
    steps, stops = len(scene.situation.queue), len(listed)
    count = (
        f"{stops} {'stop is' if stops == 1 else 'stops are'} left ({steps} step{'s' * (steps > 1)} in all)"
    )
    ready = rest[0] in lexicon().be | {"have"} and bool(
        {"done", "finished", "through", "ready", "finish"} & set(rest)
    )
    paused = " I am paused." if scene.situation.status == "paused" else ""
    lead = "Not yet: " if ready else ""
    return Answer(f"{lead}{count}: {listing([_name(visit) for visit in listed], 'and then')}.{paused}")
