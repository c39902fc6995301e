"""Changes of the plan put as statements: "X is not needed", "X can wait", "somebody has checked X".

What is said is the visits that are named and a rest of small words; the rest tells by its cues what is
meant. Words that belong to none of it, and it is no change of the plan.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.plan_changes.edits import Edit
from parley.language.offline.plan_changes.pending import CURRENT, pending_visits
from parley.language.offline.plan_changes.replanning import ordered, visits
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, keys, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.chat import SystemCommand

__all__ = ["named_visits", "restated"]

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
    "omit", "leaving", "without", "keep", "scratch",
})  # fmt: skip
_DENIALS = frozenset({"not", "no", "nobody", "none", "longer", "never", "without"})
_LATER = frozenset({"last", "end", "wait", "later", "urgent", "hurry"})
_ORDINAL_NOUNS = frozenset({
    "one", "stop", "visit", "place", "ones", "stops", "visits", "places", "these", "those", "of", "the",
    "two", "three",
})  # fmt: skip
_LONGEST = 9


def restated(words: Phrase, scene: Scene) -> Edit | None:
    """The change of what is pending that a statement means; None if it means none."""
    if not scene.situation.queue or len(words) > 26 or "?" in keys(words):
        return None
    refuses = keys(words[:1]) == ("no",) and keys(words[1:2]) != (",",)
    body = tuple(word for word in (words if refuses else strip_openers(words)) if word.is_word)
    while body and body[0].key in {
        "actually",
        "oh",
        "well",
        "sorry",
        "also",
        "by",
        "way",
        "hm",
        "right",
        "ok",
        "okay",
    }:
        body = body[1:]
    for start, end, named in named_visits(body, scene):
        left = _without_looked_for((*body[:start], *body[end:]), named, scene)
        rest = _without_somebody(left, scene)
        meant = _meaning(rest)
        if meant:
            return _carried_out(meant, named, scene)
    return None


def named_visits(body: Phrase, scene: Scene) -> list[tuple[int, int, list[int]]]:
    """Each part of a statement that names pending visits, longest first."""
    found: list[tuple[int, int, list[int]]] = []
    for size in range(min(_LONGEST, len(body)), 0, -1):
        for start in range(len(body) - size + 1):
            part = body[start : start + size]
            if set(keys(part[:1] + part[-1:])) & (_SMALL - lexicon().determiners - _ORDINAL_NOUNS):
                continue
            if not part or keys(part)[-1] in lexicon().determiners - {"these", "those"}:
                continue
            told = keys(part) in CURRENT or {"with", "for"} & set(keys(part[1:-1]))
            indices = [] if told else pending_visits(part, scene)
            if indices:
                found.append((start, start + size, indices))
    return found


def _without_looked_for(rest: Phrase, named: list[int], scene: Scene) -> Phrase:
    """Without what the visits that are named look for ("you need not look for bags there")."""
    listed = visits(scene)
    sought = {
        singular(word.key)
        for i in named
        for name in listed[i].names[1:]
        for word in tokens(name)
        if word.is_word
    }
    return tuple(word for word in rest if singular(word.key) not in sought - _SMALL)


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


def _meaning(rest: tuple[str, ...]) -> str:
    """What the small words around the visits mean: "drop", "look" (drop only that), "last", "first"."""
    said = set(rest)
    if not said or not said <= _SMALL:
        return ""
    denied = bool(said & _DENIALS)
    if (
        denied
        and said & _LOOKING
        and said & _GOING
        and (said & {"just", "only", "enough", "but"} or "need" in said)
    ):
        return "look"
    if said & {"only", "just"} and said & _MATTERING and not denied:
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
        or said & _NEEDLESS
        or ("no" in said and said & {"more", "after"} and not said & {"there", "is"})
        or rest in {("no",), ("no", "please")}
        or (said & _DONE and (said & {"already", "has", "have"}) and not denied)
        or (
            said & _OUT
            and (said & {"out", "forget", "drop", "skip", "scrap", "strike", "minus", "omit"})
            and not denied
        )
    )
    return "drop" if dropped else ""


def _carried_out(meant: str, named: list[int], scene: Scene) -> Edit | None:
    listed = visits(scene)
    names = listing([the(listed[i].names[0]) if listed[i].names else "this step" for i in named])
    if meant in {"last", "first"}:
        rest = [i for i in range(len(listed)) if i not in named]
        if meant == "last":
            return ordered([*rest, *named], scene)
        now = rest[:1] if scene.situation.status == "running" and 0 not in named else []
        return ordered([*now, *named, *(i for i in rest if i not in now)], scene)
    left_out = [i for i in range(len(listed)) if (i in named) != (meant == "keep")]
    gone = [
        visit.start + offset
        for visit in (listed[i] for i in left_out)
        for offset, step in enumerate(visit.steps)
        if meant in {"drop", "keep"} or _looks(step.name, scene)
    ]
    pops = tuple(
        SystemCommand(command="pop", arguments={"parameters": i}) for i in sorted(gone, reverse=True)
    )
    if meant == "look":
        return Edit(pops, f"I will go to {names} without looking at it.") if pops else None
    return Edit(pops, f"I keep only {names}." if meant == "keep" else f"I leave out {names}.")


def _looks(name: str, scene: Scene) -> bool:
    info = scene.catalogue.get(name)
    return info is not None and bool(scene.catalogue.roles(info) & {"look", "search"})
