"""Changes of the plan put as statements: "X is not needed", "X can wait", "somebody has checked X".

What is said is the visits that are named and a rest of small words; the rest tells by its cues what is
meant. Words that belong to none of it, and it is no change of the plan.
"""

from __future__ import annotations

from itertools import combinations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.plan_changes.pending import CURRENT, pending_visits, ranked_steps, said_of
from parley.language.offline.plan_changes.replanning import Edit, left, pops, visit_names, visits
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import listing
from parley.language.offline.words.text import Phrase, keys, singular, tokens
from parley.language.word_lists import load_data

__all__ = ["named_visits", "placed", "restated"]

_DATA = load_data("restated")
_SMALL = frozenset(_DATA["small"])
_LOOKING = frozenset(
    {"look", "inspect", "check", "looking", "inspecting", "checking", "examine", "see", "inspection"}
)
_GOING = frozenset(
    {"go", "drive", "going", "driving", "visit", "come", "there", "stop", "move", "head", "pass"}
)
_NEEDING = frozenset({
    "need", "needs", "needed", "necessary", "required", "require", "requires", "want", "wanted", "have",
    "bother", "interested", "use", "care", "worth", "wants", "point", "urgent",
})  # fmt: skip
_NEEDLESS = frozenset({
    "unnecessary", "superfluous", "redundant", "obsolete", "needless", "pointless", "cancelled",
    "unneeded", "canceled",
})  # fmt: skip
_DONE = frozenset({
    "done", "checked", "visited", "inspected", "seen", "finished", "looked", "been", "covered",
    "examined", "handled", "sorted", "was",
})  # fmt: skip
_MATTERING = frozenset({
    "matter", "matters", "count", "counts", "interest", "interests", "important", "needed", "left",
    "relevant",
    "remain", "remains", "stay", "stays",
})  # fmt: skip
_OUT = frozenset({
    "leave", "forget", "drop", "skip", "scrap", "cut", "take", "strike", "spare", "cross", "minus",
    "omit", "leaving", "without", "keep", "scratch", "dropped", "skipped", "scrapped", "removed", "off",
})  # fmt: skip
_OUTRIGHT = frozenset({
    "out", "forget", "drop", "skip", "scrap", "strike", "minus", "omit", "dropped", "skipped", "scrapped",
    "removed",
})  # fmt: skip
_DENIALS = frozenset({"not", "no", "nobody", "none", "longer", "never", "without"})
_LATER = frozenset({"last", "end", "wait", "later", "urgent", "hurry"})
_ORDINAL_NOUNS = frozenset({
    "one", "stop", "visit", "place", "ones", "stops", "visits", "places", "these", "those", "of", "the",
    "two", "three",
})  # fmt: skip
_LONGEST = 9
_LONGEST_STEP = 4
_LEADING = frozenset({
    "actually", "oh", "well", "sorry", "also", "by", "way", "hm", "right", "ok", "okay", "then", "and", "but",
})  # fmt: skip
_ALL_BUT = frozenset(
    (all_of, *but)
    for all_of in ("everything", "all", "anything", "everywhere", "stops", "places")
    for but in (("but",), ("except",), ("except", "for"), ("apart", "from"), ("besides",), ("other", "than"))
)
_INSIDE = frozenset({("at",), ("in",), ("on",), ("inside",), ("there",)})
_ENOUGH = frozenset({"enough", "suffice", "suffices", "sufficient"})
_BEFORE = frozenset({"before", "sooner", "earlier"})
_ONCE = frozenset({"once", "when"})
_AFTER = _ONCE | {"after", "behind", "following", "later"}
_HOLDING = frozenset({"until", "till"})
_THEN = frozenset({"then"})
_RELATING = _BEFORE | _AFTER | _HOLDING | _THEN
_WAITING = frozenset(
    {"wait", "hold", "leave", "keep", "save", "postpone", "delay", "put", "stay", "off", "may"}
)
_TELLING = frozenset({"was", "were", "went", "came", "did", "had"})
"""What only tells of something that is over."""
Named = tuple[int, int, list[int]]


def restated(words: Phrase, scene: Scene) -> Edit | None:
    """The change of what is pending that a statement or an order means; None if it means none."""
    if not scene.situation.queue or len(words) > 26 or "?" in keys(words):
        return None
    refuses = keys(words[:1]) == ("no",) and keys(words[1:2]) != (",",)
    only = keys(words[:1]) in {("only",), ("just",)}
    body = tuple(word for word in (words if refuses or only else strip_openers(words)) if word.is_word)
    while body and body[0].key in _LEADING:
        body = body[1:]
    named = named_visits(body, scene)
    several = bool({".", ";", "!"} & set(keys(words[:-1])))
    for one, other in () if several else combinations(sorted(named), 2):
        edit = _related(body, one, other, scene) if one[1] <= other[0] else None
        if edit is not None:
            return edit
    for start, end, indices in named:
        excepting = next((n for n in (2, 3, 4) if keys(body[max(start - n, 0) : start]) in _ALL_BUT), 0)
        if excepting:
            # "Everything but A can be dropped" is about the others.
            indices = [i for i in range(len(visits(scene))) if i not in indices]
        left_over, sought = _without_looked_for((*body[: start - excepting], *body[end:]), indices, scene)
        inside = keys(body[max(start - 1, 0) : start]) in _INSIDE
        rest = _without_somebody(left_over, scene)
        meant = _meaning(rest, there=inside and sought)
        if meant:
            return _carried_out(meant, indices, scene)
    return _without_step(body, scene)


def _without_step(body: Phrase, scene: Scene) -> Edit | None:
    """For "step two is not necessary": a step that is no whole visit."""
    for size in range(min(_LONGEST_STEP, len(body) - 1), 1, -1):
        for start in range(len(body) - size + 1):
            part = body[start : start + size]
            named = "step" in {singular(key) for key in keys(part)}
            gone = ranked_steps(part, len(scene.situation.queue)) if named else []
            rest = keys((*body[:start], *body[start + size :]))
            if gone and max(gone) < len(scene.situation.queue) and _meaning(rest) == "drop":
                said = [said_of(scene.situation.queue[i]) for i in gone]
                return Edit(pops(gone), f"I leave out {listing(said)}.")
    return None


def _related(body: Phrase, one: Named, other: Named, scene: Scene) -> Edit | None:
    """For "A can wait until after B", "not A until B is done": A in its place to B."""
    (start, end, first), (start_2, end_2, second) = one, other
    if set(first) & set(second):
        return None
    before, between, behind = keys(body[:start]), keys(body[end:start_2]), keys(body[end_2:])
    said = {*before, *between, *behind}
    if not said <= _SMALL | _RELATING | {"than"}:
        return None
    if set(before[:3]) & {"swap", "switch", "exchange"} and between and between[-1] in {"and", "with", "for"}:
        return _swapped(first, second, scene)
    # "After A, B": what stands behind the word of order is what the other one is placed by.
    fronted = [word for word in before if word in _BEFORE | _AFTER]
    placing = [word for word in between if word in _RELATING]
    if not (fronted or placing) or said & _TELLING:
        return None
    word, moved, by = (placing[-1], first, second) if placing else (fronted[-1], second, first)
    denied = bool(said & _DENIALS)
    if word in _ONCE and not said & _DONE | {"over", "through", "ready"}:
        return None
    if _HOLDING & set(between):
        return placed(moved, by, scene, after=True) if denied or said & _WAITING else None
    if word in _THEN:
        return None if denied or "first" not in said else placed(moved, by, scene, after=False)
    return None if denied and word in _AFTER else placed(moved, by, scene, after=denied or word in _AFTER)


def _swapped(first: list[int], second: list[int], scene: Scene) -> Edit | None:
    if len(first) != 1 or len(second) != 1:
        return None
    turned = {first[0]: second[0], second[0]: first[0]}
    return left([turned.get(i, i) for i in range(len(visits(scene)))], scene)


def placed(moved: list[int], by: list[int], scene: Scene, *, after: bool) -> Edit | None:
    """Some pending visits right before or behind others; None if they are the same."""
    if set(moved) & set(by):
        return None
    rest = [i for i in range(len(visits(scene))) if i not in moved]
    at = rest.index(max(by)) + 1 if after else rest.index(min(by))
    return left([*rest[:at], *moved, *rest[at:]], scene)


def named_visits(body: Phrase, scene: Scene) -> list[Named]:
    """Each part of a statement that names pending visits, longest first."""
    found: list[Named] = []
    for size in range(min(_LONGEST, len(body)), 0, -1):
        for start in range(len(body) - size + 1):
            part = body[start : start + size]
            if set(keys(part[:1] + part[-1:])) & (_SMALL - lexicon().determiners - _ORDINAL_NOUNS):
                continue
            small = lexicon().determiners - {"these", "those"}
            if not part or (part[-1].key in small and not part[-1].is_capital):
                continue
            told = keys(part) in CURRENT or {"with", "for"} & set(keys(part[1:-1]))
            indices = [] if told else pending_visits(part, scene)
            if indices:
                found.append((start, start + size, indices))
    return found


def _without_looked_for(rest: Phrase, named: list[int], scene: Scene) -> tuple[Phrase, bool]:
    """Without what the visits look for ("you need not look for bags there"), and whether it was said."""
    listed = visits(scene)
    sought = {
        singular(word.key)
        for i in named
        for name in listed[i].names[1:]
        for word in tokens(name)
        if word.is_word
    }
    kept = tuple(word for word in rest if singular(word.key) not in sought - _SMALL)
    return kept, len(kept) < len(rest)


def _without_somebody(rest: Phrase, scene: Scene) -> tuple[str, ...]:
    """The rest without the person who did it ("A has already checked ...", "... checked by A")."""
    by = next((i for i in range(1, len(rest) - 1) if rest[i].key == "by"), 0)
    if by and (all(word.is_capital for word in rest[by + 1 :]) or scene.is_person(rest[by + 1 :])):
        return keys(rest[:by])
    for size in range(min(3, len(rest) - 1), 0, -1):
        following = keys(rest[size : size + 1])
        if set(keys(rest[:size])) <= _SMALL or not following or following[0] not in _SMALL | {"has", "have"}:
            continue
        if scene.is_person(rest[:size]):
            return ("somebody", *keys(rest[size:]))
    return keys(rest)


def _meaning(rest: tuple[str, ...], *, there: bool = False) -> str:
    """What the small words around the visits mean: "drop", "look" (drop only that), "last", "first".

    Args:
        rest: The words around.
        there: Whether something is said of what is looked for at the visits.
    """
    said = set(rest)
    if not said or not said <= _SMALL:
        return ""
    denied = bool(said & _DENIALS)
    if there and denied and said & _LOOKING:
        return "look"
    if (
        denied
        and said & _LOOKING
        and said & _GOING
        and (said & {"just", "only", "enough", "but"} or "need" in said)
    ):
        return "look"
    wanted = said & _MATTERING | (said & _NEEDING if said & {"i", "we"} else set())
    if _is_taken_over(said) and not denied:
        return "drop" if said & _TAKING_OVER else ""
    enough = said & _ENOUGH and not said & _RELATING
    enough = enough or ({"will", "do"} <= said and not said & {"you", "i", "we"})
    if not denied and ((said & {"only", "just"} and wanted) or enough):
        return "keep"
    if (
        said & _LATER
        and not said & _OUT
        and (said & {"can", "could", "may", "should", "is", "do", "comes", "not"})
    ):
        return "last"
    if "first" in said and said & {"rest", "others", "else", "remaining"}:
        return "first"
    dropped = (
        (denied and said & _NEEDING)
        or (rest[:2] == ("do", "not") and set(rest[2:3]) & (_LOOKING | _GOING))
        or said & _NEEDLESS
        or ("no" in said and said & {"more", "after"} and not said & {"there", "is"})
        or rest in {("no",), ("no", "please")}
        or (said & _DONE and (said & {"already", "has", "have"}) and not denied)
        or (said & _OUT and said & _OUTRIGHT and not denied)
    )
    return "drop" if dropped else ""


def _is_taken_over(said: set[str]) -> bool:
    """For "somebody else will do A", "I will look at A myself": that somebody does it."""
    others = bool(said & {"somebody", "someone", "else", "me", "myself"})
    others = others or any({"i", modal} <= said for modal in ("will", "can"))
    return others and bool(said & {"do", "does", "done", "take", "takes", "handle", "care", "see", "look"})


_TAKING_OVER = frozenset({"will", "does", "takes", "is", "has", "can"})


def _carried_out(meant: str, named: list[int], scene: Scene) -> Edit | None:
    listed = visits(scene)
    names = visit_names(named, scene)
    others = [i for i in range(len(listed)) if i not in named]
    if meant == "last":
        return left([*others, *named], scene)
    if meant == "first":
        now = others[:1] if scene.situation.status == "running" and 0 not in named else []
        return left([*now, *named, *(i for i in others if i not in now)], scene)
    if meant == "keep":
        return left(named, scene, f"I keep only {names}.")
    if meant == "drop":
        return left(others, scene, f"I leave out {names}.")
    steps = ((listed[i].start + n, step) for i in named for n, step in enumerate(listed[i].steps))
    gone = pops(index for index, step in steps if _looks(step.name, scene))
    return Edit(gone, f"I will go to {names} without looking at it.") if gone else None


def _looks(name: str, scene: Scene) -> bool:
    info = scene.catalogue.get(name)
    return info is not None and bool(scene.catalogue.roles(info) & {"look", "search"})
