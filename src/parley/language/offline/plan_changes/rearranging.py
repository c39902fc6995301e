"""Changes of what is pending, read by patterns whose open phrases are pending visits or new orders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache

from parley.language.control import control_of
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.plan_changes.by_clause import by_clause
from parley.language.offline.plan_changes.patterns import Part, matches, parsed
from parley.language.offline.plan_changes.pending import pending_steps, pending_visits, said_of
from parley.language.offline.plan_changes.replanning import (
    Change,
    Edit,
    left,
    pops,
    renamed,
    same_steps,
    visit_names,
    visits,
)
from parley.language.offline.plan_changes.restated import named_visits, placed
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.tasks.commands import read_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, tokens
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["rearranged", "without_going_on"]

_LONGEST = 40
_LEADS = tuple(tuple(text.split()) for line in load_data("plan_changes")["leads"] for text in line.split(","))
_KINDS = (
    "rest", "reverse", "copy", "nth", "no_look", "between", "keep", "until", "from", "swap", "instead",
    "before", "after", "first", "last", "drop",
    "then_after", "then_before", "before_all", "added", "same",
)  # fmt: skip


@cache
def _patterns() -> tuple[tuple[str, tuple[Part, ...]], ...]:
    data = load_data("plan_changes")
    return tuple((kind, parsed(text, data["named"])) for kind in _KINDS for text in data[kind])


def rearranged(words: Phrase, scene: Scene) -> Change | None:
    """The change of what is pending that a message asks for; None if it asks for none.

    Args:
        words: All words and punctuation.
        scene: What is known, with its pending steps.
    """
    words = without_going_on(_without_courtesy(_uncontracted(words)))
    if not scene.situation.queue or len(words) > _LONGEST or "?" in keys(words):
        return None
    body = _bare(words)
    several = bool({",", ".", ";", ":"} & set(keys(body)))
    control = control_of(" ".join(keys(body)))
    # "A is being painted, so leave that one out": A, not what is being done now.
    named = several and control == "skip" and _names_one(body, scene)
    if len(body) < 2 or (control is not None and not named):
        return None
    change = by_clause(words, scene, _bare, _read) if several else None
    change = change or _read(body, scene)
    return change if change is not None or several else by_clause(words, scene, _bare, _read)


def _names_one(body: Phrase, scene: Scene) -> bool:
    """Whether a pending visit is named, and not only by its rank ("the next one")."""
    ranks = {"next", "first", "last", "second", "following"}
    return any(not ranks & set(keys(body[a:b])) for a, b, _ in named_visits(body, scene))


_GOING_ON = tuple(
    ("when", "you", *verb.split())
    for verb in ("continue", "go on", "carry on", "resume", "start again", "get going again", "move on")
)


def without_going_on(words: Phrase) -> Phrase:
    """For "leave out A when you continue" and "when you go on, leave out A": leave out A."""
    flat = keys(words)
    for said in _GOING_ON:
        size = len(said)
        if flat[: size + 1] == (*said, ","):
            return words[size + 1 :]
        body = len(flat) - (not words[-1].is_word if words else 0)
        if size < body and flat[body - size : body] == said:
            return (*words[: body - size], *words[body:])
    return words


def _uncontracted(words: Phrase) -> Phrase:
    """For "A's off": "A is off"."""
    result: list[Word] = []
    for i, word in enumerate(words):
        following = words[i + 1].key if i + 1 < len(words) else ""
        if word.key.endswith("'s") and following in _SAID_OF_IT:
            result += [Word(word.key[:-2], word.raw[:-2]), Word("is", "is")]
        else:
            result.append(word)
    return tuple(result)


_SAID_OF_IT = frozenset(
    {
        "off",
        "out",
        "done",
        "not",
        "no",
        "already",
        "been",
        "finished",
        "checked",
        "cancelled",
        "first",
        "last",
        "next",
        "now",
    }
)


def _without_courtesy(words: Phrase) -> Phrase:
    """For "(Could you) put A first?": no question."""
    asked = keys(words[-1:]) == ("?",) and "?" not in keys(words[:-1])
    requests = lexicon().requests.match(keys(words)) is not None
    return words[:-1] if asked and (requests or opens_command(words)) else words


def _read(body: Phrase, scene: Scene) -> Change | None:
    for kind, parts in _patterns():
        for slots in matches(parts, body):
            change = _CHANGES[kind](slots, scene)
            if change is not None:
                return change
    tail = next((t for t in _TAILS if len(body) > len(t) + 1 and keys(body[-len(t) :]) == t), ())
    return _read(_bare(body[: -len(tail)]), scene) if tail else None


_TAILS = tuple(
    tuple(text.split())
    for text in (
        "for today", "for now", "today", "please", "thanks", "thank you", "for the moment", "if you can",
        "if possible", "then", "now", "after all", "will you", "would you", "could you", "can you", "for me",
        "this time", "tonight", "this morning", "this afternoon", "if you like", "ok", "okay", "anyway",
    )
)  # fmt: skip
"""What changes nothing behind a change of the plan."""


def _bare(words: Phrase) -> Phrase:
    body = tuple(Word(",", ",") if word.key in {".", ";", "!", ":"} else word for word in words)
    while body:
        lead = next((lead for lead in _LEADS if keys(body[: len(lead)]) == lead), ())
        if (lead == ("no",) and keys(body[1:2]) != (",",)) or not (lead or body[0].key == ","):
            break
        behind = keys(body[len(lead) : len(lead) + 1])
        if lead and (
            behind in {("about",), ("with",)} or (lead == ("on", "the", "way") and behind != (",",))
        ):
            break
        body = body[len(lead) or 1 :]
    while body and not body[-1].is_word:
        body = body[:-1]
    return body


def _left(scene: Scene, order: Sequence[int], text: str = "") -> Change:
    return Change(left(order, scene, text))


def _named(slots: dict[str, Phrase], scene: Scene, *names: str) -> list[list[int]] | None:
    found = [pending_visits(slots[name], scene) for name in names if name in slots]
    return found if len(found) == len(names) and all(found) else None


def _drop(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    if "b" in slots and not pending_visits(slots["b"], scene):
        return None
    if found is None:
        gone = pending_steps(slots["a"], scene)
        steps = [said_of(scene.situation.queue[i]) for i in gone]
        return Change(Edit(pops(gone), f"I leave out {listing(steps)}.")) if gone else None
    gone = sorted(set(found[0]))
    text = f"I leave out {visit_names(gone, scene)}."
    return _left(scene, [i for i in range(len(visits(scene))) if i not in gone], text)


def _keep(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    return (
        None
        if found is None
        else _left(scene, sorted(found[0]), f"I keep only {visit_names(found[0], scene)}.")
    )


def _rest(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    """For "cancel the rest": what is being done now is finished."""
    return _left(scene, [0], f"I keep only {visit_names([0], scene)}.") if visits(scene) else None


def _until(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    if found is None:
        return None
    last = max(found[0])
    return _left(scene, list(range(last + 1)), f"I leave out everything after {visit_names([last], scene)}.")


def _from(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    if found is None or min(found[0]) == 0:
        return None
    first = min(found[0])
    rest = list(range(first, len(visits(scene))))
    return _left(scene, rest, f"I go on with {visit_names([first], scene)} and leave out what comes before.")


def _swap(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a", "b") if "b" in slots else _named(slots, scene, "a")
    if found is None:
        return None
    one, other = (found[0], found[1]) if len(found) == 2 else (found[0][:1], found[0][1:])
    if len(one) != 1 or len(other) != 1 or one == other:
        return None
    order = list(range(len(visits(scene))))
    order[one[0]], order[other[0]] = other[0], one[0]
    return _left(scene, order)


def _first(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a", "b") if "b" in slots else _named(slots, scene, "a")
    if found is None:
        return None
    moved = found[0]
    rest = [i for i in range(len(visits(scene))) if i not in moved]
    now = rest[:1] if scene.situation.status == "running" and 0 not in moved else []
    return _left(scene, [*now, *moved, *(i for i in rest if i not in now)])


def _last(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    if found is None:
        return None
    return _left(scene, [*(i for i in range(len(visits(scene))) if i not in found[0]), *found[0]])


def _moved(after: bool) -> Callable[[dict[str, Phrase], Scene], Change | None]:
    def change(slots: dict[str, Phrase], scene: Scene) -> Change | None:
        found = _named(slots, scene, "a", "b")
        edit = placed(found[0], found[1], scene, after=after) if found is not None else None
        return Change(edit) if edit is not None else None

    return change


def _instead(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    if found is None:
        return None
    if len(slots.get("x", ())) == 1 and pending_visits((*slots["a"], *slots["x"]), scene):
        # "(Drop) the second stop": one phrase, though a bus stop is on the map.
        return None
    listed, at = visits(scene), found[0][0]
    names = listed[at].names
    kind = tokens(names[0])[-1:] if names else ()
    said = tuple(
        part for word in slots.get("x", ()) for part in (kind if word.key == "one" and kind else (word,))
    )
    order = _new(said, scene)
    if not order:
        return None
    if keys(order[:1]) == ("visit",) and keys(said[:1]) != ("visit",) and len(found[0]) == 1:
        return _renamed(at, order[1:], scene)
    looked = any(scene.catalogue.roles(info) & {"look"} for info in _infos(at, scene))
    if looked and keys(order[:1]) == ("visit",):
        order = (Word("inspect", "inspect"), *order[1:])
    gone = pops(listed[i].start + n for i in found[0] for n in range(len(listed[i].steps)))
    edit = Edit(gone, f"I leave out {visit_names(found[0], scene)}.")
    return Change(edit, order, listed[min(found[0])].start)


def _renamed(at: int, named: Phrase, scene: Scene) -> Change | None:
    """What was to be done at one visit, done at another thing."""
    listed, found = visits(scene), scene.ground(named)
    if found.outcome != "match" or not listed[at].names:
        return None
    name = describe(found.candidates[0], scene.objects)
    old = tokens(listed[at].names[0])
    steps = [renamed(step, old, name, scene) for step in listed[at].steps]
    after = scene.situation.queue[listed[at].start + len(steps) :]
    again = (*steps, *after)
    if any(step.flow is not None for step in again):
        return None
    text = f"I will go to {the(name)} instead of {the(listed[at].names[0])}."
    return Change(Edit(pops(range(listed[at].start, len(scene.situation.queue))), text, again))


def _infos(at: int, scene: Scene) -> list[ActionInfo]:
    infos = (scene.catalogue.get(step.name) for step in visits(scene)[at].steps)
    return [info for info in infos if info is not None]


def _insert(after: bool, needs_b: bool = False) -> Callable[[dict[str, Phrase], Scene], Change | None]:
    def change(slots: dict[str, Phrase], scene: Scene) -> Change | None:
        found = _named(slots, scene, "a", "b") if needs_b else _named(slots, scene, "a")
        order = _new(slots.get("x", ()), scene)
        if found is None or not order:
            return None
        listed = visits(scene)
        at = max(found[0]) + 1 if after else min(found[0])
        return Change(None, order, listed[at].start if at < len(listed) else len(scene.situation.queue))

    return change


def _before_all(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    order = _new(slots.get("x", ()), scene)
    if {",", "then"} & set(keys(slots.get("x", ()))):
        return None
    said = keys(order[:1]) in _STOPPING or opens_command(slots["x"])
    return Change(None, order, 0) if order and said else None


def _no_look(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    gone = [
        index
        for index, step in enumerate(scene.situation.queue)
        if (info := scene.catalogue.get(step.name)) is not None
        and scene.catalogue.roles(info) & {"look", "search"}
    ]
    return Change(Edit(pops(gone), "I will go there without looking.")) if gone else None


def _reverse(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    order = list(range(len(visits(scene))))
    now = 1 if scene.situation.status == "running" and len(order) > 2 else 0
    return _left(scene, [*order[:now], *order[now:][::-1]])


def _copy(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    found = _named(slots, scene, "a")
    if found is None:
        return None
    listed = visits(scene)
    steps = tuple(step for index in found[0] for step in listed[index].steps if step.flow is None)
    return (
        Change(Edit((), f"I do {visit_names(found[0], scene)} once more at the end.", steps))
        if steps
        else None
    )


def _nth(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    order, listed = _new(slots.get("x", ()), scene), visits(scene)
    place = lexicon().ordinals.get(" ".join(keys(slots.get("n", ()))), 0)
    if not order or not 0 < place <= len(listed) + 1:
        return None
    at = listed[place - 1].start if place <= len(listed) else len(scene.situation.queue)
    return Change(None, order, at)


def _added(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    order = _new(slots.get("x", ()), scene)
    return Change(None, order, len(scene.situation.queue)) if keys(order[:1]) in _STOPPING else None


def _same(slots: dict[str, Phrase], scene: Scene) -> Change | None:
    """For "the same in A": what is done at the last stop is done at A."""
    found = same_steps(slots["x"], scene, len(scene.situation.queue))
    return None if found is None else Change(Edit((), f"I will do the same at {the(found[0])}.", found[1]))


_STOPPING = {("visit",), ("inspect",)}
_CHANGES: dict[str, Callable[[dict[str, Phrase], Scene], Change | None]] = {
    "drop": _drop,
    "keep": _keep,
    "until": _until,
    "from": _from,
    "swap": _swap,
    "first": _first,
    "last": _last,
    "before": _moved(False),
    "after": _moved(True),
    "instead": _instead,
    "between": _insert(True, True),
    "then_after": _insert(True),
    "then_before": _insert(False),
    "before_all": _before_all,
    "no_look": _no_look,
    "rest": _rest,
    "reverse": _reverse,
    "copy": _copy,
    "nth": _nth,
    "added": _added,
    "same": _same,
}

_ADDING = frozenset({
    "add", "insert", "squeeze", "fit", "slot", "include", "throw", "slip", "stick", "put", "do",
    "visit", "go",
    "have",
    "pop", "work", "schedule", "plan", "take",
})  # fmt: skip
_DOING = frozenset({"put", "do", "visit", "go", "have", "plan", "take"})
"""Of these words those that may also be said of what is pending already."""
_LOOKS = tuple(
    tuple(text.split())
    for text in ("an inspection of", "a look at", "a check of", "a quick look at", "a look into")
)
_VISITS = tuple(
    tuple(text.split())
    for text in (
        "a visit to", "a stop at", "a trip to", "stop at", "stop by", "stop by at", "call at", "call in at",
        "drop by", "drop in at", "swing by", "pass by", "pop into", "pop over to", "nip to", "to", "by", "at",
    )
)  # fmt: skip


def _new(words: Phrase, scene: Scene) -> Phrase:
    """A new order: as said, or a visit to what is named; empty if it is neither, or is pending already."""
    rest = strip_openers(words, requests=True)
    rest = tuple(word for word in rest if word.is_word)
    while rest and keys(rest[-1:]) in {("in",), ("too",), ("also",), ("instead",), ("please",)}:
        rest = rest[:-1]
    if not rest:
        return ()
    body = rest[1:] if rest[0].key in _ADDING else rest
    body = body[1:] if keys(body[:1]) in {("in",), ("over",), ("also",)} else body
    look = next((m for m in _LOOKS if keys(body[: len(m)]) == m), ())
    visit = next((m for m in _VISITS if keys(body[: len(m)]) == m), ())
    named = body[len(look or visit) :]
    if 0 < len(named) <= 8 and scene.ground(named).outcome == "match":
        if pending_visits(named, scene) and rest[0].key not in _ADDING - _DOING:
            return ()
        return (Word("inspect" if look else "visit", "inspect" if look else "visit"), *named)
    verbs = Catalogue.of(scene.situation.catalogue).verbs
    plainly = opens_command(rest, verbs) and lemma(rest[0].key) == rest[0].key != "do"
    if not plainly or len(rest) < 2:
        return ()
    going = read_command(rest, scene.is_person, verbs)
    pending = going is not None and going.kind == "motion" and pending_visits(bare(going.place), scene)
    # "Skip A and carry on with B": no order that is new.
    return () if pending else rest
