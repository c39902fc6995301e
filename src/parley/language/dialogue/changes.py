"""Corrections of what runs or waits: which steps are taken back, what comes in their place, and where.

A correction is bound to the steps it is about when it is read: a step is left out as the one that it was
then, not as the one that stands in its place later.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

from parley.language.base import Situation
from parley.language.builtin.amounts import ORDINALS
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.saying import listed, which_one
from parley.language.builtin.tokens import Token
from parley.language.dialogue.answers import answer, step_words
from parley.language.dialogue.map_words import Named, named
from parley.language.dialogue.questions import Question
from parley.messages.chat import ActionCall
from parley.messages.status import PlanStep
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = [
    "Change", "Visit", "before_all", "change_of", "is_against", "moved", "reordered", "texts_of", "visits",
    "visits_of",
]  # fmt: skip

_OPEN: Final = ("queued", "running", "waiting", "paused", "failed")
_AGAINST: Final = re.compile(
    r"\b(?:not|no|without|skip(?:ping)?|leave(?: \w+)? out|leaving out|drop|omit|forget(?: about)?|except|"
    r"but not|instead of|rather than|cancel|remove|delete|scratch|never mind|don't(?: \w+){0,3}|"
    r"do not(?: \w+){0,3}|no need "
    r"(?:to|for)(?: \w+){0,2}|cut out|strike|spare)(?: (?:the|a|an|my|to|at|by|about|going|to go|for|"
    r"go to|going to|visit|visiting|that|this|trip|bit|part|stop|step|of|with))*$"
)
_TAKING_BACK: Final = re.compile(
    r"\b(?:no|nope|not|sorry|oops|actually|instead|rather|scratch|forget (?:it|that|this|about)|"
    r"wait(?! (?:at|in|by|near|before|behind|beside|outside|for|until|till|with|here|there)\b)|"
    r"i (?:mean|meant)|"
    r"make (?:it|that)|never ?mind|on second thoughts?|changed? my mind|correction|better|hang on|hold on|"
    r"leave (?:it|that)|drop (?:it|that)|cancel (?:it|that)|change of plan)\b"
)
_ASKING: Final = re.compile(
    r"(?:^|\W)(?:is|are|was|were|wh(?:at|ere|en|y|o|ich)|how|do|does|did|has|have)\b(?! about)[^.!,;]*\?\s*$",
    re.IGNORECASE,
)
_FRONT: Final = re.compile(
    r"\b(?:first|before (?:all )?that|before you (?:do|go)|beforehand|on the way|on your way|before "
    r"(?:you |we )?(?:go(?:ing)? on|carry(?:ing)? on|mov(?:e|ing) on|continu(?:e|ing)|proceed(?:ing)?|"
    r"resum(?:e|ing)|leav(?:e|ing)|anything|everything))\b"
)
_GIVEN_UP: Final = r"instead|rather|scratch|forget|never ?mind|drop|cancel|leave|changed? my mind"
_INSTEAD: Final = re.compile(rf"\b(?:{_GIVEN_UP}|no|nope|not|(?:i|we) (?:mean|meant)|make (?:it|that))\b")
"""What takes back also what comes "first"; "actually" and "wait" do not."""
_ADDING: Final = re.compile(
    r"^(?:(?:ok|okay|yes|please|and) )*(?:and|now)\b(?!.*\?)|"
    r"\b(?:also|add|too|as well|and then|then|after (?:that|this|wards?)|afterwards|at the end|finally|"
    r"besides|plus|include|append|on top|later|when you are done|when done|next)\b"
)
_ALSO: Final = re.compile(r"\b(?:as well|too|also|in addition|on top|besides|include)\b")
_THEN: Final = re.compile(r"(?:(?:yes|ok|okay|sure|and|but)\W+)*(?:and|then|after (?:that|this))\b")
_FOR_GOOD: Final = re.compile(rf"\b(?:{_GIVEN_UP}|change of plan)\b")
"""What takes back even beside "too"; "no, wait" only breaks in."""
_ALL: Final = re.compile(
    r"\b(?:all|everything|forget (?:it|that|this)|scratch|cancel|drop (?:it|that)|never ?mind)\b"
)
_ALL_OF_IT: Final = re.compile(r"\b(?:all|everything)\b|^stop\b")


@dataclass(frozen=True, slots=True)
class Visit:
    """Steps of a plan that belong together: the way to a place, or one deed."""

    steps: tuple[int, ...]
    """Places among what is still to be done."""
    things: tuple[MapObject, ...]
    said: str
    """In words, for the reply."""
    calls: tuple[ActionCall, ...]
    """All of it, those that are over already among them."""
    words: str


@dataclass(frozen=True, slots=True)
class Change:
    """What becomes of a plan."""

    drop: tuple[int, ...] = ()
    """Places among what is still to be done."""
    add: tuple[ActionCall, ...] = ()
    where: Literal["end", "instead", "front"] = "end"
    rest: tuple[ActionCall, ...] = ()
    """What was behind and is to come after what is added."""
    clears: bool = False
    """Whether nothing of the plan remains."""
    kept: tuple[ActionCall, ...] = ()
    """What comes before it, where the whole is proposed anew."""
    said: str = ""
    """In words, for the reply."""
    question: str = ""
    """What has to be asked first; nothing is changed then."""
    choices: tuple[str, ...] = ()


def visits(situation: Situation) -> list[Visit]:
    """What a plan, or what waits for a yes, still consists of."""
    dialogue = situation.dialogue
    if dialogue.proposal is not None and not any(step.state in _OPEN for step in dialogue.steps):
        labels = dialogue.proposal.labels[len(dialogue.proposal.commands) :]
        steps = [
            PlanStep(action=call, label=labels[at] if at < len(labels) else call.reason)
            for at, call in enumerate(dialogue.proposal.steps)
        ]
    else:
        steps = list(dialogue.steps) or _pending(situation)
    return visits_of(steps, situation)


def visits_of(steps: Sequence[PlanStep], situation: Situation) -> list[Visit]:
    """The steps of a plan that are not over, those together that belong together."""
    finding = {info.name for info in situation.catalogue if info.only_finds}
    finding |= {one.action.name for one, other in itertools.pairwise(steps) if _leads_to(one, other)}
    found: list[Visit] = []
    before: list[PlanStep] = []
    places: list[int] = []
    left = 0
    for step in steps:
        is_open = step.state in _OPEN
        place, left = (left, left + 1) if is_open else (-1, left)
        if step.action.name in finding:
            before, places = [step], [place] if is_open else []
            continue
        if is_open:
            whole = [*before, step]
            words = " ".join(
                [step.label, step.action.reason, *(text for one in whole for text in texts_of(one.action))]
            )
            things = _things_in(whole, situation.places)
            calls = tuple(one.action for one in whole)
            found.append(Visit((*places, place), things, step_words(step.label), calls, words.lower()))
        before, places = [], []
    return found


def _leads_to(one: PlanStep, other: PlanStep) -> bool:
    """Whether a step only finds out where the next one goes."""
    return not any("::" in name for name in one.action.input_parameters) and any(
        "::" in name for name in other.action.input_parameters
    )


def _pending(situation: Situation) -> list[PlanStep]:
    """What is pending, where nothing else is known of the plan than that."""
    running = situation.status == "running"
    return [
        PlanStep(
            action=call,
            label=call.reason or f"do that with the {', the '.join(texts_of(call)) or 'next step'}",
            state="running" if running and not place else "queued",
        )
        for place, call in enumerate(situation.queue)
    ]


def texts_of(call: ActionCall) -> list[str]:
    """The words that an action is given."""
    return [
        str(item.value) for item in call.input_parameters.values() if item.type == "string" and item.has_data
    ]


def _things_in(steps: Sequence[PlanStep], objects: Sequence[MapObject]) -> tuple[MapObject, ...]:
    """The things that steps are about: named in full in their labels or arguments."""
    text = " ".join(
        [*(step.label for step in steps), *(text for step in steps for text in texts_of(step.action))]
    ).lower()
    hits = [
        item
        for item in objects
        if any(
            re.search(rf"\b{re.escape(n.lower())}\b", text)
            for n in (item.description, item.id, *item.aliases)
        )
    ]
    longest = max((len(item.description) for item in hits if item.description.lower() in text), default=0)
    exact = [item for item in hits if len(item.description) == longest and item.description.lower() in text]
    return tuple(exact or hits)


def change_of(
    situation: Situation, tokens: Sequence[Token], lexicon: Lexicon, *, orders: bool
) -> Change | None:
    """What a message changes of what runs or waits; None if it changes nothing.

    It `orders` where an order was read in it that can be carried out as it stands: its steps are put into
    the change by whoever read it.
    """
    if _ASKING.search(situation.message) is not None:
        return None  # "wait, where is the desk?"
    plan, names = visits(situation), named(tokens, situation.places, lexicon)
    low = [token.low for token in tokens]
    text = " ".join(low)
    against: list[Named] = []
    for at, name in enumerate(names):
        joined = names[at - 1] in against and _is_joined(low[names[at - 1].end : name.start]) if at else False
        if joined or is_against(low, name):
            against.append(name)
    for_ = [name for name in names if name not in against]
    takes_back = _TAKING_BACK.search(text) is not None
    if _FRONT.search(text) is not None and _INSTEAD.search(text) is None:
        takes_back = False
    if not against and _ALSO.search(text) is not None and _FOR_GOOD.search(text) is None:
        takes_back = False
    if orders:
        return _with_order(situation, plan, against, text, takes_back=takes_back) if plan else None
    if not _is_bare(tokens, names, lexicon):
        return None
    if against and not for_:
        return _left_out(situation, plan, against)
    if not names or not plan:
        return None
    if takes_back or against:
        return _replaced(plan, against, for_[0], text) if len(for_) == 1 else None
    return _put_in(situation, plan, for_, text)


def _is_bare(tokens: Sequence[Token], names: Sequence[Named], lexicon: Lexicon) -> bool:
    """Whether there is nothing in a message but what is named and the words of changing a plan."""
    taken = {at for name in names for at in range(name.start, name.end)}
    small = lexicon.classes["small"] | lexicon.classes["logic"] | lexicon.classes["prepositions"]
    small = small | lexicon.classes["determiners"] | lexicon.classes["changing"] | {*ORDINALS, "next"}
    return all(at in taken or not token.is_word or token.low in small for at, token in enumerate(tokens))


def _with_order(
    situation: Situation, plan: Sequence[Visit], against: Sequence[Named], text: str, *, takes_back: bool
) -> Change | None:
    """What an order takes the place of: what it names, what runs, or nothing."""
    old = [visit for name in against for visit in _meant(plan, name)]
    if not old and _FRONT.search(text) is not None and not takes_back:
        return reordered(plan, [], plan, "front")
    on_top = _ALSO.search(text) or _THEN.match(text)
    if not (old or takes_back or situation.queue) and on_top:
        return Change(said="That comes on top.")
    if not old and takes_back:
        old = list(plan) if _ALL.search(text) is not None else _deed_of(plan, plan[0])
    if not old:
        return None
    meant, old = old, _with_what_depends(plan, old, situation, runs=not against)
    whole = len(old) == len(plan) > 1
    more = " What belongs to it is left out, too." if len(old) > len(meant) else ""
    said = "I drop the rest of my plan." if whole else f"{_dropping(meant).said}{more}"
    return replace(reordered(plan, old, _behind(plan, old), "instead", said=said), clears=whole)


def _with_what_depends(
    plan: Sequence[Visit], old: Sequence[Visit], situation: Situation, *, runs: bool
) -> list[Visit]:
    """Also what was to be done where it does not go any more, and the way on with what it gets there.

    Args:
        plan: What is still to be done.
        old: What is left out of it.
        situation: Its catalogue says what actions do.
        runs: Whether it is what runs: nothing of what is done here is done elsewhere.
    """
    effects = {info.name: {*info.effects} for info in situation.catalogue}

    def does(visit: Visit, *wanted: str) -> bool:
        return any(effects.get(call.name, set()) & {*wanted} for call in visit.calls)

    found: list[Visit] = []
    there, gets = False, False
    for visit in plan:
        moves = does(visit, "moves", "follows")
        if moves:
            there, gets = visit in old or gets, False
        elif visit in old and runs:
            there = True
        if there or visit in old:
            found.append(visit)
            gets = gets or does(visit, "grasps", "asks_operator")
    return found


def before_all(situation: Situation) -> Change:
    """What is ordered comes before all that is planned."""
    plan = visits(situation)
    return reordered(plan, [], plan, "front")


def _behind(plan: Sequence[Visit], old: Sequence[Visit]) -> list[Visit]:
    last = max((place for visit in old for place in visit.steps), default=-1)
    return [visit for visit in plan if min(visit.steps) > last]


def reordered(
    plan: Sequence[Visit], old: Sequence[Visit], behind: Sequence[Visit], where: Literal["instead", "front"],
    calls: tuple[ActionCall, ...] = (), said: str = "",
) -> Change:  # fmt: skip
    """Some steps are left out, and those behind come after what is put there."""
    rest = tuple(call for visit in behind for call in visit.calls)
    if any(call.flow is not None for call in rest):
        return Change(question="My plan has conditions, so I cannot put that into it. Shall I drop it all?")
    drop = (place for visit in (*old, *behind) for place in visit.steps)
    return Change(tuple(sorted(drop)), calls, where, rest, said=said)


def _is_joined(between: Sequence[str]) -> bool:
    """Whether nothing but "and the" stands between two names."""
    return {"and"} <= {*between} <= {"and", "the", "a", "an", ",", "or", "also"}


def is_against(low: Sequence[str], name: Named) -> bool:
    """Whether the words before a name say that it is not meant: "not the desk"."""
    before: list[str] = []
    for word in reversed(low[: name.start]):
        if not (word[0].isalnum() or word[0] == "'") or word in ("and", "then"):
            break
        before.insert(0, word)
    return _AGAINST.search(" ".join(before)) is not None


def _meant(plan: Sequence[Visit], name: Named) -> list[Visit]:
    ids = {item.id for item in name.things}
    found: list[Visit] = []
    for before, visit in zip([None, *plan], plan, strict=False):
        there = not visit.things and before is not None and before in found  # what is done where it goes
        if there or ids & {item.id for item in visit.things}:
            found.append(visit)
    return found or [visit for visit in plan if {*name.words} <= {*re.findall(r"\w+", visit.words)}]


def _left_out(situation: Situation, plan: Sequence[Visit], against: Sequence[Named]) -> Change | None:
    out = [visit for visit in plan if any(visit in _meant(plan, name) for name in against)]
    over = [item.description for name in against if not _meant(plan, name) for item in name.things]
    ended = [deed.label for deed in situation.dialogue.deeds if deed.ending in ("done", "no", "left out")]
    if strange := [name for name in over if not any(name in label for label in ended)]:
        if out or not plan or situation.dialogue.asked is not None or situation.question:
            return None
        told = f"{listed([*map(called, strange)])} is not in my plan."
        return Change(question=f"{told[:1].upper()}{told[1:]} {answer(Question('what_left'), situation)}")
    told = f"I am done with {listed([*map(called, over)])} already." if over else ""
    if not out:
        return Change(question=f"{told} {answer(Question('what_left'), situation)}") if over else None
    return replace(_dropping(out), said=f"{told} {_dropping(out).said}".strip())


def _deed_of(plan: Sequence[Visit], first: Visit) -> list[Visit]:
    """A step, and those next to it that are about the same: the way to a thing, and a look at it."""
    ids = {item.id for item in first.things}
    behind = plan[plan.index(first) + 1 :]
    return [first, *itertools.takewhile(lambda visit: ids & {item.id for item in visit.things}, behind)]


def _dropping(out: Sequence[Visit]) -> Change:
    said = ", nor ".join(visit.said for visit in out)
    return Change(
        tuple(sorted(place for visit in out for place in visit.steps)), said=f"All right, I will not {said}."
    )


def _replaced(plan: Sequence[Visit], against: Sequence[Named], wanted: Named, text: str) -> Change | None:
    """Another thing in the place of one that is under way."""
    old = [visit for name in against for visit in _meant(plan, name)]
    if not old and not against and _ALL_OF_IT.search(text) is not None:
        return Change(question=f"Shall I drop all that is planned, or only take the {wanted.text} instead?")
    if not old and not against:
        old = [visit for visit in plan if visit.things][:1]
    if not old:
        return None
    if len(wanted.things) > 1:
        names = tuple(item.description for item in wanted.things)
        return Change(question=which_one(names), choices=names)
    target = wanted.things[0]
    if any(target in visit.things for visit in plan if visit not in old[:1] or not against):
        name = called(target.description)
        asked = "is in my plan already. Shall I go there first, or leave it out?"
        return Change(question=f"{name[:1].upper()}{name[1:]} {asked}")
    deed = _deed_of(plan, old[0])
    calls = tuple(call for visit in deed for call in moved(visit, target) or ())
    if moved(old[0], target) is None or target in old[0].things:
        return None
    other = _reason(old[0].said, _names_of(old[0].things), target)
    other = other if other != old[0].said else f"take {called(target.description)}"
    there = [visit for visit in old if visit not in deed] if against else []  # a look there is one here
    gone = [*deed, *itertools.dropwhile(lambda visit: not visit.things, there)]
    said = f"I do not {', nor '.join(visit.said for visit in old if visit in gone)}. Instead I {other}."
    behind = [visit for visit in _behind(plan, deed) if visit not in gone]
    return reordered(plan, gone, behind, "instead", calls, said)


def moved(old: Visit, target: MapObject, before: MapObject | None = None) -> tuple[ActionCall, ...] | None:
    """The same deed about another thing than `before`, or its own; None if it is not about one thing."""
    names = _names_of(old.things if before is None else (*old.things, before))
    calls, changed = [], False
    for call in old.calls:
        inputs = {}
        for name, parameter in call.input_parameters.items():
            if "::" in name and len(old.calls) > 1:
                continue  # found out anew by the step before
            value = str(parameter.value).lower() if parameter.has_data else ""
            if parameter.type == "string" and value in names:
                parameter, changed = replace(parameter, value=target.description), True
            elif parameter.type == "string" and value:  # "whether the blue cup is full" of the red one
                text = _renamed(str(parameter.value), names, target)
                changed = changed or (before is not None and text != parameter.value)
                parameter = replace(parameter, value=text)
            inputs[name] = parameter
        reason = _reason(call.reason, names, target)
        calls.append(call.model_copy(update={"input_parameters": inputs, "reason": reason, "flow": None}))
    return tuple(calls) if changed else None


def _names_of(things: Sequence[MapObject]) -> set[str]:
    return {n.lower() for item in things for n in (item.description, item.id, *item.aliases)}


def _reason(reason: str, names: set[str], target: MapObject) -> str:
    renamed = _renamed(reason, names, target)
    return (
        f"go to {called(target.description)}" if renamed == reason and reason.startswith("go to") else renamed
    )


def _renamed(text: str, names: set[str], target: MapObject) -> str:
    """A text about one thing, about another one."""
    hit = next((known for known in sorted(names, key=len, reverse=True) if known in text.lower()), "")
    at = text.lower().index(hit)
    return text[:at] + target.description + text[at + len(hit) :] if hit else text


def _looks_everywhere(plan: Sequence[Visit], situation: Situation) -> list[Visit]:
    """What is looked for at each place of a plan, whatever place that is; nothing if it is not so at each."""
    looking = {info.name for info in situation.catalogue if "looks" in info.effects}
    rows: list[list[Visit]] = []
    for visit in plan:
        if visit.things:
            rows.append([])
        elif rows and {call.name for call in visit.calls} <= looking:
            rows[-1].append(visit)
    same = all([one.calls for one in row] == [one.calls for one in rows[0]] for row in rows)
    return rows[0] if rows and same else []


def _put_in(situation: Situation, plan: Sequence[Visit], wanted: Sequence[Named], text: str) -> Change | None:
    """A further place, at the end or before everything."""
    front = _FRONT.search(text) is not None
    if not front and _ADDING.search(text) is None:
        return None
    like = next((visit for visit in plan if moved(visit, wanted[0].things[0]) is not None), None)
    planned = {thing.id for visit in plan for thing in visit.things}
    if like is None or any(len(name.things) > 1 or name.things[0].id in planned for name in wanted):
        return None
    deed = _deed_of(plan, like)
    deed += _looks_everywhere(plan, situation)
    before = next(iter(like.things), None)
    calls = tuple(
        call
        for name in wanted
        for visit in deed
        for call in moved(visit, name.things[0], before) or (() if visit.things else visit.calls)
    )
    names = " and ".join(called(name.things[0].description) for name in wanted)
    if front:
        return reordered(plan, [], plan, "front", calls, f"First {names}, then on with the rest.")
    return Change((), calls, "end", said=f"I add {names}.")
