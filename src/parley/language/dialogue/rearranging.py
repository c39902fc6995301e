"""Another order of what is planned: first, last, before, after, only, up to, the other way round.

A message is matched with the things it names, and what it calls by number, in their places. It must be about
nothing else, so that a word that is not understood leaves the plan as it is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.amounts import ORDINALS
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.saying import counted
from parley.language.builtin.tokens import Token
from parley.language.dialogue.changes import Change, Visit, moved, reordered, visits
from parley.language.dialogue.map_words import Named, named
from parley.language.lexicon import load_data

__all__ = ["rearranged"]

_Groups = list[list[Visit]]
"""Steps in a row about the same thing, or about nothing else on the map: they stay together."""

_SLOT: Final = (
    r"(?:@\d+(?: and @\d+)*|ORD(?: and ORD)*(?: (?:two|three|ones?|stops?|steps?|things?|places?|trip|part|"
    r"point|task|bit|item))?|this(?: one)?)"
).replace(
    "ORD", r"(?:the )?(?:very )?(?:first|1st|second|2nd|third|3rd|fourth|4th|fifth|5th|last|next|final)"
)
_NUMBERS: Final = ORDINALS | {"next": 1}
_COUNTS: Final = {"two": 2, "three": 3}
_DO: Final = (
    r"(?:do|put|take|go to|visit|make|move|bring|leave|keep|have|check|squeeze in|squeeze|fit in|fit|add)?"
)
_REST: Final = r"(?:the )?(?:rest|others|other ones|remaining ones|everything else|all the others)"
_DROP: Final = (
    r"(?:skip|drop|cancel|forget(?: about)?|remove|delete|scratch|strike|cross out|throw out|leave out|leave)"
)


def rearranged(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon) -> Change | None:
    """What a message makes of the order of a plan; None if it is about something else."""
    plan = visits(situation)
    if not plan or situation.question:
        return None
    names = named(tokens, situation.places, lexicon)
    text = _with_slots(tokens, names)
    counts = not {*text.split()}.isdisjoint(_NUMBERS)  # as people count the lines of a plan on the page
    groups = [[visit] for visit in plan] if counts else _grouped(plan)
    for pattern, made in _patterns():
        found = pattern.fullmatch(f"{text} ")
        if found is not None:
            try:
                wanted = made(_Plan(groups, names), found.groupdict())
            except IndexError:
                only = counted(len(groups), "thing")
                return Change(question=f"I have only {only} left to do. Which one do you mean?")
            except LookupError:
                return None
            return _change(groups, wanted)
    return None


def _grouped(plan: Sequence[Visit]) -> _Groups:
    found: _Groups = []
    for visit in plan:
        if found and (not visit.things or found[-1][-1].things == visit.things):
            found[-1].append(visit)
        else:
            found.append([visit])
    return found


_OPENERS: Final = re.compile(
    r"^(?:(?:please|just|now|also|actually|oh|ok|okay|well|so|and|but|no,|sorry|hm+|change of plans?|"
    r"on second thoughts?|(?:can|could|would|may) (?:you|we)|you (?:can|may|could)|we (?:can|could)|let 's|"
    r"let's|i would like(?: you to)?|i (?:'d|want you to|want|'d like(?: you to)?)|i'd like(?: you to)?) )+"
)
_CLOSERS: Final = re.compile(
    r"(?: (?:please|instead|though|now|then|today|for now|thanks|thank you|okay|ok|this time|too|as well))+$"
)


def _with_slots(tokens: Sequence[Token], names: Sequence[Named]) -> str:
    """The words of a message with a number for each thing that is named."""
    words: list[str] = []
    at = 0
    starts = {name.start: (number, name) for number, name in enumerate(names)}
    while at < len(tokens):
        if at in starts:
            number, name = starts[at]
            while words and words[-1] in ("the", "a", "an", "my", "our", "both", "all", "rooms", "room"):
                words.pop()
            words.append(f"@{number}")
            at = name.end
            continue
        if tokens[at].is_word:
            words.append(tokens[at].low)
        elif words == ["no"]:
            words = ["no,"]  # "no, the gate" is not "no gate"
        at += 1
    text = " ".join(words)
    return _CLOSERS.sub("", _OPENERS.sub("", text))


class _Plan:
    """What is planned, as a message speaks of it."""

    def __init__(self, groups: _Groups, names: Sequence[Named]) -> None:
        self.groups = groups
        self.names = names

    def meant(self, slot: str) -> _Groups:
        """What a slot means; LookupError if nothing of it is planned, IndexError for a number beyond it."""
        words = slot.split()
        if words[0].startswith("@"):
            things = {item.id for at in re.findall(r"@(\d+)", slot) for item in self.names[int(at)].things}
            found = [group for group in self.groups if things & {item.id for item in group[0].things}]
            if len(found) < len(re.findall("@", slot)):
                raise LookupError(slot)
            return found
        if words[0] == "this":
            return self.groups[:1]
        count = next((_COUNTS[word] for word in words if word in _COUNTS), 1)
        starts = [
            at if at >= 0 else at - count + 1 for word in words if (at := _NUMBERS.get(word)) is not None
        ]
        return [self.groups[start + more] for start in starts for more in range(count)]

    def new(self, slot: str) -> _Groups:
        """What a slot means; what is not planned yet is done like the rest of the plan."""
        try:
            return self.meant(slot)
        except LookupError:
            found = []
            for at in re.findall(r"@(\d+)", slot):
                if len(self.names[int(at)].things) != 1:
                    raise
                thing = self.names[int(at)].things[0]
                like = [visit for visit in self.groups[-1] if moved(visit, thing) is not None]
                if not like:
                    raise
                calls = [(visit, moved(visit, thing) or ()) for visit in like]
                found.append([Visit((), (thing,), "", call, "") for _, call in calls])
            if not found:
                raise
            return found

    def without(self, gone: _Groups) -> _Groups:
        """The plan without these."""
        return [group for group in self.groups if group not in gone]


_Made = Callable[[_Plan, dict[str, str]], _Groups]


def _swap(plan: _Plan, slots: dict[str, str]) -> _Groups:
    pair = plan.meant(slots["a"])
    pair = [*pair, *plan.meant(slots["b"])] if slots.get("b") else pair
    if len(pair) != 2:
        raise LookupError("a pair")
    places = [plan.groups.index(group) for group in pair]
    made = list(plan.groups)
    made[places[0]], made[places[1]] = pair[1], pair[0]
    return made


def _beside(plan: _Plan, slots: dict[str, str], behind: int) -> _Groups:
    what, where = plan.new(slots["a"]), plan.meant(slots["b"])
    if any(group in where for group in what):
        raise LookupError("itself")
    rest = plan.without(what)
    at = rest.index(where[-1 if behind else 0]) + behind
    return [*rest[:at], *what, *rest[at:]]


def _first(plan: _Plan, slots: dict[str, str]) -> _Groups:
    what = plan.new(slots["a"])
    return [*what, *plan.without(what)]


def _last(plan: _Plan, slots: dict[str, str]) -> _Groups:
    what = plan.new(slots["a"])
    return [*plan.without(what), *what]


def _up_to(plan: _Plan, slots: dict[str, str]) -> _Groups:
    return plan.groups[: plan.groups.index(plan.meant(slots["a"])[-1]) + 1]


_MADE: Final[dict[str, _Made]] = {
    "swap": _swap,
    "reverse": lambda plan, _: plan.groups[::-1],
    "first": _first,
    "last": _last,
    "before": lambda plan, slots: _beside(plan, slots, 0),
    "after": lambda plan, slots: _beside(plan, slots, 1),
    "only": lambda plan, slots: plan.meant(slots["a"]),
    "up_to": _up_to,
    "from": lambda plan, slots: plan.groups[plan.groups.index(plan.meant(slots["a"])[0]) :],
    "out": lambda plan, slots: plan.without(plan.meant(slots["a"])),
}


@cache
def _patterns() -> tuple[tuple[re.Pattern[str], _Made], ...]:
    """What the lexicon says about changing the order of a plan."""
    read = {**load_data("rearranging")}
    parts: Mapping[str, str] = read.pop("parts")
    return tuple(
        (re.compile(_pattern(template, parts)), _MADE[name])
        for name, templates in read.items()
        for template in templates
    )


def _pattern(template: str, parts: Mapping[str, str]) -> str:
    """A template as a pattern for words, each followed by a blank."""
    text = re.sub(r"\{(\w+)\}", lambda found: parts[found[1]], template)
    pattern = ""
    for piece in re.findall(r"\([^()]+\)!?|\S+", text):
        if piece[0] == "(":
            choices = "|".join(f"{choice} " for choice in piece.strip("()!").split("|"))
            pattern += f"(?:{choices}){'' if piece.endswith('!') else '?'}"
        else:
            pattern += f"(?P<{piece.lower()}>{_SLOT}) " if piece in ("A", "B") else f"{piece} "
    return pattern


def _change(groups: _Groups, wanted: _Groups) -> Change | None:
    """The change that makes one plan of another: what stays at the front stays as it is."""
    if wanted == groups:
        return Change(question="That is how my plan is already. What shall I change?")
    same = next(
        (at for at, (one, other) in enumerate(zip(groups, wanted, strict=False)) if one != other), None
    )
    same = min(len(groups), len(wanted)) if same is None else same
    kept = [group for group in groups if group in wanted]
    if kept == wanted:
        gone = [visit for group in groups if group not in wanted for visit in group]
        return Change(
            tuple(sorted(place for visit in gone for place in visit.steps)), said=_said(groups, wanted)
        )
    behind = [visit for group in groups[same:] for visit in group]
    calls = tuple(call for group in wanted[same:] for visit in group for call in visit.calls)
    said = _said(groups, wanted)
    if not behind:
        return Change((), calls, "end", said=said)
    changed = reordered([], behind, [], "instead", calls, said)
    old = any(call.flow is not None for visit in behind for call in visit.calls)
    question = "My plan has conditions, so I cannot change its order. Shall I drop it all?"
    return Change(question=question) if old else changed


def _said(groups: _Groups, wanted: _Groups) -> str:
    """What becomes of the plan, in words."""
    gone = [group for group in groups if group not in wanted]
    if gone and len(gone) + len(wanted) == len(groups):
        return f"All right, I will not {', nor '.join(visit.said for group in gone for visit in group)}."
    places = [group[0].things[0].description if group[0].things else group[0].said for group in wanted]
    told = (one for at, one in enumerate(places) if places[at - 1 : at] != [one])  # each place once in a row
    return f"All right, in this order: {', '.join(told)}."
