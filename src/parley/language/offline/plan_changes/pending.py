"""Which of the pending visits a phrase means: by name, by place in the row, as a group."""

from __future__ import annotations

from parley.language.offline.plan_changes.replanning import visit_of, visits
from parley.language.offline.scene.group_words import read_lead
from parley.language.offline.scene.groups import GroupReader
from parley.language.offline.scene.marks import members_of
from parley.language.offline.scene.members import in_order
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.text import Phrase, keys, lemma, singular, split_name, tokens
from parley.messages.chat import ActionCall
from parley.world.object_map import MapObject

__all__ = ["CURRENT", "pending_steps", "pending_visits", "ranked_steps", "said_of"]

_STOP_WORDS = frozenset({
    "stop", "visit", "place", "one", "item", "job", "part", "entry", "thing", "leg", "room",
    "destination", "waypoint", "station",
})  # fmt: skip
_NO_NAMES = frozenset(
    {"i", "we", "you", "can", "could", "should", "do", "not", "leave", "no", "please", "if", "put"}
)
_STILL_AHEAD = tuple(
    tuple(text.split())
    for text in (
        "still ahead", "still to come", "that are left", "that is left", "which are left", "still left",
        "still pending",
        "that remain", "that are still to come", "that are still ahead", "still on the list",
        "ahead of you", "to come", "of these", "of those", "of them",
    )
)  # fmt: skip
CURRENT = frozenset(
    tuple(text.split())
    for text in (
        "this", "this one", "this stop", "this visit", "the current one", "the current stop",
        "the current visit",
        "the current step", "the one you are doing", "what you are doing", "where you are now",
        "the one you are at",
        "the one you are on", "that one", "this step", "this place", "it", "this room",
    )
)  # fmt: skip
"""What is being done now, unless something was named before."""
_BOTH = frozenset(
    {
        ("both",),
        ("both", "of", "them"),
        ("the", "two"),
        ("them",),
        ("the", "two", "of", "them"),
        ("those", "two"),
    }
)


_PLACING = frozenset({"first", "last", "later", "instead", "next"})
"""What is said about a visit, and no part of its name."""


def pending_visits(phrase: Phrase, scene: Scene) -> list[int]:
    """The places among the pending visits of what a phrase names, in order; empty if a part names none."""
    known = scene.pending.get(keys(phrase))
    if known is None:
        known = scene.pending[keys(phrase)] = _found(phrase, scene)
    return list(known)


def _found(phrase: Phrase, scene: Scene) -> list[int]:
    listed = visits(scene)
    phrase = tuple(word for word in phrase if word.is_word or word.key == ",")
    tail = next((t for t in _STILL_AHEAD if keys(phrase[-len(t) :]) == t), ())
    phrase = phrase[: len(phrase) - len(tail)]
    flat = keys(phrase)
    if not flat or not listed:
        return []
    if flat in CURRENT:
        return [0] if flat[0] != "it" or len(listed) == 1 else []
    if flat in _BOTH:
        return [0, 1] if len(listed) == 2 else []
    ranked = _by_rank(phrase, scene)
    placed = any(a in _PLACING and b in {"and", ","} for a, b in zip(flat, (*flat[1:], ","), strict=True))
    if ranked or placed:
        return ranked
    one = visit_of(phrase, scene) if _is_name(phrase) else None
    if one is not None:
        return [one]
    return _together(phrase, scene) or _listed(phrase, scene) or _by_own_deed(phrase, scene)


def _by_own_deed(phrase: Phrase, scene: Scene) -> list[int]:
    """For "count the crates (first)", where that is pending: the stop at which it is done."""
    verb = lexicon().verbs.match(keys(phrase[:1]))
    if len(phrase) < 2 or (verb is not None and verb[1].partition(":")[0] in _GOING_OR_LOOKING):
        return []
    at = visit_of(phrase[1:], scene) if _is_name(phrase[1:]) else None
    deed = lemma(phrase[0].key)
    does = at is not None and any(deed in _words_of(step)[0] for step in visits(scene)[at].steps)
    return [at] if at is not None and does else []


_GOING_OR_LOOKING = frozenset({"motion", "look", "whether", "search", "back"})


def _is_name(phrase: Phrase) -> bool:
    """Whether a phrase may be a name: no order and no more than its words."""
    flat = keys(phrase)
    verb = lexicon().verbs.match(flat)
    return (
        len(phrase) <= 7
        and not set(flat) & _NO_NAMES
        and not (verb is not None and len(flat) > verb[0] and flat[0] not in {"stop", "visit"})
        and not ({",", "and"} & set(flat))
    )


def _by_rank(phrase: Phrase, scene: Scene) -> list[int]:
    """For "the second stop", "the last two", "number three", "the next one", "the first and the last"."""
    count, words = len(visits(scene)), keys(bare(phrase))
    stepwise = any(len(visit.steps) > 3 for visit in visits(scene))
    if stepwise and (words in {("next", "one"), ("next",), ("following", "one")} or words[:1] == ("number",)):
        # Where a stop is many steps, a step is meant.
        return []
    found = _ranked(phrase, count, _STOP_WORDS)
    return found if all(0 <= place < count for place in found) else []


def _ranked(phrase: Phrase, count: int, nouns: frozenset[str]) -> list[int]:
    """The places in a row that rank words name; they may lie beyond its end.

    Args:
        phrase: What is named.
        count: How many there are.
        nouns: What one of them may be called.
    """
    lead, at = read_lead(phrase, 0)
    flat = keys(phrase)
    named = {singular(word) for word in flat[at:]} <= nouns
    if lead.end and named:
        size = lead.count
        return list(range(size)) if lead.end == "first" or size > count else list(range(count - size, count))
    if lead.ordinals and named:
        return [place - 1 if place > 0 else count - 1 for place in lead.ordinals]
    words = keys(bare(phrase))
    size = lexicon().numbers.get(words[1], 0) if len(words) > 1 and words[0] in {"next", "following"} else 0
    if size > 1 and {singular(word) for word in words[2:]} <= nouns:
        return list(range(1, size + 1)) if count > size else list(range(size))
    if words[:1] and singular(words[0]) in nouns | {"number", "no"} and words[0] != "room":
        numbers = [
            int(w) if w.isdigit() else lexicon().numbers.get(w, 0) for w in words[1:] if w not in _JOINS
        ]
        return [number - 1 for number in numbers] if all(numbers) else []
    if not words or len(words) > 2 or (words[1:] and singular(words[1]) not in nouns):
        return []
    if words[0] in {"last", "final"}:
        return [count - 1]
    if words[0] in {"next", "following"}:
        return [1]
    place = lexicon().ordinals.get(words[0], 0)
    return [place - 1] if place > 0 and (len(words) > 1 or flat[0] == "the") else []


_JOINS = frozenset({"and", ",", "number", "no", "the"})
_STEPS = frozenset({"step", "action", "task", "order", "command", "number", "one", "item", "part", "thing"})
_PLANS = frozenset({"plan", "queue", "list", "route", "mission", "tour", "schedule", "round"})


def pending_steps(phrase: Phrase, scene: Scene) -> list[int]:
    """The pending steps, not whole visits, that a phrase means: "the second step", "the inspection"."""
    count = len(scene.situation.queue)
    found = ranked_steps(phrase, count)
    return sorted({i for i in found if i < count}) if found else _by_deed(phrase, scene)


def ranked_steps(phrase: Phrase, count: int) -> list[int]:
    """The places, from 0, of steps that are named by rank; they may lie beyond the `count` pending ones."""
    return _ranked(_of_plan(phrase), count, _STEPS)


def _of_plan(phrase: Phrase) -> Phrase:
    """Without "from the plan" and the like at the end."""
    while (
        len(phrase) > 3 and phrase[-1].key in _PLANS and phrase[-3].key in {"of", "from", "in", "on", "off"}
    ):
        phrase = phrase[:-3]
    return phrase


def _by_deed(phrase: Phrase, scene: Scene) -> list[int]:
    """For "the inspection", "the look at the door", "the counting": the one step that is meant, or all."""
    rest = keys(_of_plan(bare(phrase)))
    wanted = {singular(lemma(word)) for word in rest} - lexicon().determiners - _NO_DEED
    if not wanted or not all(word.is_word for word in phrase):
        return []
    named = [(i, *_words_of(step)) for i, step in enumerate(scene.situation.queue)]
    hits = [i for i, deed, about in named if wanted <= deed | about and wanted & deed]
    several = len(wanted) == 1 and any(word.endswith(("ing", "ion")) for word in rest)
    return hits if len(hits) == 1 or several else []


_NO_DEED = frozenset(
    {"part", "step", "to", "go", "at", "of", "trip", "visit", "bit", "business", "all", "that"}
)


def _words_of(step: ActionCall) -> tuple[set[str], set[str]]:
    """What the deed of a step may be called by, and what tells what it is about."""
    deed = {form for word in split_name(step.name) for form in (singular(lemma(word)), f"{word}ion")}
    deed |= {"inspection"} if deed & {"inspect", "look"} else set()
    values = [p.value for p in step.input_parameters.values() if isinstance(p.value, str)]
    return deed, {singular(lemma(word.key)) for value in (*values, step.reason) for word in tokens(value)}


def said_of(step: ActionCall) -> str:
    """What a pending step is called."""
    return step.reason or " ".join(split_name(step.name))


_SEVERAL = lexicon().quantifiers | {
    "and",
    ",",
    "other",
    "others",
    "rest",
    "except",
    "but",
    "both",
    "pair",
    "everything",
}


def _together(phrase: Phrase, scene: Scene) -> list[int]:
    """For "aisles 2 and 3", "all doors", "both rooms": those that are pending."""
    flat = keys(phrase)
    if not _SEVERAL & set(flat) and all(singular(word) == word for word in flat):
        return []
    named = list(range(len(visits(scene))))
    places = {index: _item(index, scene) for index in named}
    objects = [item for item in places.values() if item is not None]
    read = GroupReader(objects, scene.situation.robot_pose, scene.facts, lambda said: ()).read(phrase)
    members = members_of(read, objects) if len(bare(read)) == 1 else []
    if not members:
        return _of_kind(phrase, scene)
    order = [next(i for i, item in places.items() if item == member) for member in members]
    return sorted(order) if in_order(members) else order


def _item(index: int, scene: Scene) -> MapObject | None:
    visit = visits(scene)[index]
    for name in visit.names:
        found = scene.ground(tokens(name))
        if found.outcome == "match":
            return found.candidates[0]
    return None


def _of_kind(phrase: Phrase, scene: Scene) -> list[int]:
    """For "the doors": every visit of that kind."""
    words = bare(phrase)
    while words and words[0].key in {"any", "all", "more", "other", "further", "both", "of", "the"}:
        words = bare(words[1:])
    if not words or singular(words[-1].key) == words[-1].key or not all(word.is_word for word in words):
        return []
    wanted = {singular(word.key) for word in words}
    return [
        index
        for index, visit in enumerate(visits(scene))
        if any(wanted <= {singular(word.key) for word in tokens(name)} for name in visit.names)
    ]


def _listed(phrase: Phrase, scene: Scene) -> list[int]:
    """For "A and B": both."""
    parts = coordinated(phrase)
    if len(parts) < 2 or {"or"} & set(keys(phrase)):
        return []
    found = [pending_visits(part, scene) for part in parts]
    return [index for one in found for index in one] if all(found) else []
