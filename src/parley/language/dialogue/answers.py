"""Answers to questions about the robot itself, from the state of the dialogue."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.lexicon import lexicon, stem
from parley.language.builtin.saying import counted, listed, with_article
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.map_words import distance_m, in_room, lies, named, room_of, rooms, whereabouts
from parley.language.dialogue.questions import Question
from parley.language.dialogue.state import Deed, Dialogue, Order
from parley.language.lexicon import word_set
from parley.messages.status import ActionInfo, PlanStep
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = ["answer", "deed_words", "differences", "step_words"]

_OPEN: Final = ("queued", "running", "waiting", "paused")
_MOST: Final = 5
_BESIDE_M: Final = 2.0
_AROUND_M: Final = 5.0
_SPEED: Final = (
    "I choose my speed by myself and cannot change it for one way. Say “stop” at any time. A limit can be "
    "made a rule: “do not drive faster than 0.2 m/s”."
)
_IDLE: Final = "I have nothing to do at the moment."


def answer(question: Question, situation: Situation) -> str:
    """What is known about it; empty if nothing is."""
    found = _TOPICS.get(question.topic)
    return found(situation, question.about) if found is not None else ""


# -- words --------------------------------------------------------------------------------------------


def step_words(label: str) -> str:
    """What a step does, inside a sentence."""
    label = re.sub(r"“([^”]*)”", lambda found: with_article(found[1]), label)
    first, _, rest = label.partition(" ")
    return f"{first.lower()} {rest}".strip() if first.istitle() else label


def deed_words(deed: Deed) -> str:
    """What was done, and what came of it."""
    words = step_words(deed.label)
    told = f" – {deed.told[-1].rstrip('.')}" if deed.told else ""
    ends = {"failed": " (it did not work)", "stopped": " (given up)", "left out": " (left out)"}
    return f"{words}{ends.get(deed.ending, '')}{told}"


def _at(unix_ms: int) -> str:
    return f"at {datetime.fromtimestamp(unix_ms / 1000):%H:%M}"


def _visible(deeds: Sequence[Deed]) -> list[Deed]:
    return [deed for deed in deeds if tuple(deed.effects) != ("locates",)]


def _steps_left(situation: Situation) -> list[PlanStep]:
    hidden = {info.name for info in situation.catalogue if info.only_finds}
    return [
        step for step in situation.dialogue.steps if step.state in _OPEN and step.action.name not in hidden
    ]


def _wanted(order: Order) -> str:
    who = f"{order.by} asked" if order.by else "you asked"
    return f"Because {who} me {_at(order.unix_ms)}: “{order.words.strip()}”"


# -- topics -------------------------------------------------------------------------------------------


def _where(situation: Situation, about: str) -> str:
    here = f"I am {whereabouts(situation.objects, situation.robot_pose)}."
    running = [step for step in _steps_left(situation) if step.state == "running"]
    return f"{here} I am on it: {step_words(running[0].label)}." if running else here


def _where_going(situation: Situation, about: str) -> str:
    moving = {info.name for info in situation.catalogue if "moves" in info.effects}
    left = [step for step in _steps_left(situation) if step.action.name in moving]
    if left:
        still = situation.dialogue.plan in ("paused", "held")
        return f"{'I stand still at the moment, but I was to' if still else 'I'} {step_words(left[0].label)}."
    last = [deed for deed in situation.dialogue.deeds if deed.moved]
    if last:
        return f"I am not going anywhere now. The last thing was: {deed_words(last[-1])}."
    return "I am not going anywhere now."


def _going_before(situation: Situation, about: str) -> str:
    orders = situation.dialogue.orders
    if len(orders) < 2:
        return "You have not asked me for anything before that."
    before = orders[-2]
    what = listed(
        list(dict.fromkeys(call.reason for call in before.calls if call.reason)) or ["something else"]
    )
    return f"Before that, {_at(before.unix_ms)}, I was to {what}: you said “{before.words.strip()}”."


def _doing(situation: Situation, about: str) -> str:
    dialogue, left = situation.dialogue, _steps_left(situation)
    if dialogue.latched:
        return "I stand still: my emergency stop is on. Somebody has to release it."
    if situation.question:
        return _failed(situation) or f"I wait for an answer to this: {situation.question}"
    if not left:
        return f"{_IDLE} I am {whereabouts(situation.objects, situation.robot_pose)}."
    what = step_words(left[0].label)
    if dialogue.plan == "paused":
        return f"I stand still{', as I was told' * bool(dialogue.stopped)}. Say “carry on” and I {what}."
    return f"This is what I am doing: {what}.{_left_time(dialogue)}"


def _left(situation: Situation, about: str) -> str:
    left, proposal = _steps_left(situation), situation.dialogue.proposal
    if not left and proposal is not None:
        return (
            f"Nothing is begun. This waits for your yes: {listed([step_words(x) for x in proposal.lines])}."
        )
    if not left:
        return _failed(situation) or f"Nothing is left to do. {_did(situation, '') if about else ''}".strip()
    told = f"Left to do: {'; '.join(step_words(step.label) for step in left)}."
    return f"Not yet. {told}" if about else told


def _beside(situation: Situation, about: str) -> str:
    """What comes behind or before a step that is named; empty if there is no plan to speak of."""
    side, _, name = about.partition(" ")
    left, proposal = _steps_left(situation), situation.dialogue.proposal
    plan = [step_words(step.label) for step in left]
    plan = plan or ([step_words(line) for line in proposal.lines] if proposal is not None else [])
    wanted = _stems(name)
    if not plan or not wanted:
        return _left(situation, "") if plan else ""
    meant = [at for at, words in enumerate(plan) if wanted <= _stems(words)]
    if not meant:
        return f"That is not in my plan. Left to do: {'; '.join(plan)}."
    found = plan[: meant[0]] if side == "before" else plan[meant[-1] + 1 :]
    if not found:
        return "Nothing comes before that." if side == "before" else "Nothing is planned after that."
    return f"{'Before' if side == 'before' else 'After'} that: {'; '.join(found)}."


def _did(situation: Situation, about: str) -> str:
    begun = _visible(situation.dialogue.deeds)
    if not begun:
        return "I have not done anything yet since I was started."
    parts = [deed_words(deed) for deed in begun if deed.ending != "running"]
    more = f"{counted(len(parts) - _MOST, 'other thing')} before that; " if len(parts) > _MOST else ""
    done = f"I did this: {more}{'; '.join(parts[-_MOST:])}." if parts else "Nothing is done yet."
    now = list(dict.fromkeys(step_words(deed.label) for deed in begun if deed.ending == "running"))
    failed = _failed(situation) if re.search(r"\b(?:wrong|happened)\b", situation.message.lower()) else ""
    return f"{done} I have begun to {listed(now)}." if now else f"{done} {failed}".rstrip()


def _asked(situation: Situation, about: str) -> str:
    """What somebody ordered last, and what came of it."""
    orders = situation.dialogue.orders
    words = f"You said: “{orders[-1].words.strip()}”. " if orders else ""
    return f"{words}{_did(situation, about)}"


def _when_did(situation: Situation, about: str) -> str:
    """When it was last done with what is about a thing."""
    names = [thing.description.lower() for thing in _things(situation, about)]
    ended = [deed for deed in _visible(situation.dialogue.deeds) if deed.ending in ("done", "no")]
    meant = [deed for deed in ended if any(name in deed.label.lower() for name in names)]
    if not names or not meant:
        return "Not since I was started." if names else ""
    return f"I was done with this {_at(meant[-1].unix_ms)}: {step_words(meant[-1].label)}."


def _said_last(situation: Situation, about: str) -> str:
    """What the robot itself said last, once more."""
    last = next((turn.content for turn in reversed(situation.history) if turn.role == "assistant"), "")
    return f"I said: “{last.strip()}”" if last else "I have not said anything yet."


def _who_am_i(situation: Situation, about: str) -> str:
    return f"You are {situation.speaker}." if situation.speaker else "I do not know your name."


def _before_stop(situation: Situation, about: str) -> str:
    """What was under way when somebody told it to stand still."""
    left = [step for step in _steps_left(situation) if step.state != "queued"]
    words = [step_words(step.label) for step in left]
    words += [step_words(deed.label) for deed in situation.dialogue.deeds if deed.ending == "stopped"][-1:]
    stopped = situation.dialogue.stopped
    when = f", when I was told to stop {_at(stopped.unix_ms)}" if stopped is not None else ""
    return f"I was to {words[0]}{when}." if words else _did(situation, about)


def _there_yet(situation: Situation, about: str) -> str:
    left = _steps_left(situation)
    if left:
        still = " I stand still at the moment." if situation.dialogue.plan in ("paused", "held") else ""
        todo = "; ".join(step_words(step.label) for step in left)
        return f"Not yet. Left to do: {todo}.{still}{_left_time(situation.dialogue)}"
    done = _visible(situation.dialogue.deeds)
    if not done:
        return f"{'Yes, I hear you. ' if about == 'there' else ''}I was not asked to do anything yet."
    kinds = {"looks"} if about[:5] in ("check", "inspe") else {"asks_operator", "grasps", "places"}
    alike = [deed for deed in done if kinds & {*deed.effects}] if about not in ("", "there") else done
    if not alike:
        return f"No. What I did last: {deed_words(done[-1])}."
    last = alike[-1]
    if last.ending in ("done", "no"):
        here = whereabouts(situation.objects, situation.robot_pose)
        return f"Yes, that is done: {deed_words(last)}. I am {here}."
    return f"No: {deed_words(last)}."


def _been(situation: Situation, about: str) -> str:
    wanted = _stems(about)
    ways = [deed for deed in situation.dialogue.deeds if deed.moved and deed.ending in ("done", "no")]
    named = {item.description: item for item in situation.objects}
    found = [deed for deed in ways if wanted <= _stems(deed.label) | _stems(_room(deed.label, named))]
    if found:
        return f"Yes, {_at(found[-1].unix_ms)}: {deed_words(found[-1])}."
    running = [step for step in _steps_left(situation) if wanted <= _stems(step.label)]
    if running:
        return f"Not yet, but it is in my plan: {step_words(running[0].label)}."
    been = f" I have been here: {'; '.join(deed_words(deed) for deed in ways[-_MOST:])}." if ways else ""
    return f"No, not since I was started.{been}"


def _room(label: str, named: dict[str, MapObject]) -> str:
    item = next((item for name, item in named.items() if name in label), None)
    return room_of(item) if item is not None else ""


def _stems(text: str) -> set[str]:
    """Words of content; in "area A" the letter is one, too."""
    letter = {"a"} if re.search(r"\w A\b|\w [Aa]\W*$", text) else set()
    return {stem(word) for word in re.findall(r"[^\W_]+", text.lower())} - (_SMALL - letter)


_SMALL: Final = word_set("the a an to in at of my your any some there there's")


def _why_stopped(situation: Situation, about: str) -> str:
    dialogue = situation.dialogue
    if situation.question:
        return _failed(situation) or f"I wait for an answer to this: {situation.question}"
    if dialogue.stopped is not None:
        who = f"{dialogue.stopped.by} told" if dialogue.stopped.by else "you told"
        return f"Because {who} me to, {_at(dialogue.stopped.unix_ms)}: “{dialogue.stopped.words.strip()}”."
    if dialogue.latched:
        return "Because my emergency stop is on."
    if dialogue.plan == "running":
        return f"I have not stopped. {_doing(situation, about)}"
    if dialogue.plan == "paused" and _steps_left(situation):
        return _doing(situation, about)  # a button was pressed, or it was told before it was started anew
    return f"I am done. {_did(situation, about)}"


def _waiting(situation: Situation, about: str) -> str:
    dialogue = situation.dialogue
    if situation.question:
        return f"I wait for your answer to this: {situation.question}"
    if dialogue.proposal is not None:
        waits = listed([step_words(label) for label in dialogue.proposal.lines])
        return f"I wait for your yes to this: {waits}."
    if dialogue.plan == "paused":
        return _why_stopped(situation, about)
    return _doing(situation, about) if _steps_left(situation) else f"For nothing but your next order. {_IDLE}"


def _failed(situation: Situation) -> str:
    """What was to be done when a step failed, on whose word, and what went wrong; empty if none did."""
    failure = situation.failure
    if failure is None:
        return ""
    step = failure.failed_action.reason or "do the next step"
    orders = situation.dialogue.orders
    asked = f" {_wanted(orders[-1])}." if orders else ""
    return f"I was to {step}, and that did not work: {failure.error_message}{asked}"


def _why(situation: Situation, about: str) -> str:
    dialogue = situation.dialogue
    if situation.question:
        wanted = f"{_wanted(dialogue.orders[-1])}." if dialogue.orders else ""
        return _failed(situation) or wanted or f"I wait for an answer to this: {situation.question}"
    if dialogue.refused:
        return _why_not(situation, about)
    if dialogue.plan in ("paused", "held"):
        return _why_stopped(situation, about)
    if dialogue.orders:
        last = dialogue.orders[-1]
        chosen = f" I was chosen for it: {last.why}." if last.why else ""
        return f"{_wanted(last)}.{chosen}"
    return "Nobody has asked me to do anything yet."


def _why_not(situation: Situation, about: str) -> str:
    if situation.failure is not None:
        return f"Because of what I was told, or found: {situation.failure.error_message}"
    if situation.dialogue.refused:
        return f"Because of what I was told: {situation.dialogue.refused}"
    said = next((turn.content for turn in reversed(situation.history) if turn.role == "assistant"), "")
    return f"As I said: {said}" if said else "There is nothing that I refused."


def _why_not_go(situation: Situation, about: str) -> str:
    wanted = _stems(about)
    out = [
        deed
        for deed in situation.dialogue.deeds
        if wanted <= _stems(deed.label) and deed.ending == "left out"
    ]
    if out:
        looks = [deed for deed in situation.dialogue.deeds if deed.looked and deed.ending in ("no", "done")]
        seen = f" When I looked: {looks[-1].told[-1]}" if looks and looks[-1].told else ""
        return f"Because that was only to be done in another case.{seen}"
    if situation.dialogue.refused:
        return _why_not(situation, about)
    asked = [order for order in situation.dialogue.orders if wanted <= _stems(order.words)]
    if not asked:
        return "Nobody asked me to."
    looks = [deed for deed in situation.dialogue.deeds if deed.looked and deed.told]
    seen = f" When I looked: {looks[-1].told[-1]}" if looks else ""
    return f"You asked me: “{asked[-1].words.strip()}”, and it was not to be done in this case.{seen}"


def _looks(situation: Situation) -> list[Deed]:
    return [deed for deed in situation.dialogue.deeds if deed.looked and (deed.told or deed.seen)]


def _seen(situation: Situation, about: str) -> str:
    looks = [deed for deed in _looks(situation) if _stems(about) <= _stems(deed.label)]
    now = _NOW.search(situation.message.lower())  # that is looked at, not told
    if not looks and now and (about or re.search(r"\bit\b", situation.message)):
        return ""
    if about and not looks:
        return "I have not looked there with my camera since I was started."
    if not looks:
        here = f"I am {whereabouts(situation.objects, situation.robot_pose)}. Say “look around”, and I do."
        found = [item.description for item in situation.objects if item.found]
        told = f"The map has what was found before: {listed(found)}." if found else here
        return f"I have not looked at anything with my camera since I was started. {told}"
    last = looks[-1]
    meant = looks[-1:] if _THERE.search(situation.message) else [d for d in looks if d.order == last.order]
    newest = [*{deed.label: deed for deed in meant}.values()][-_MOST:]
    lead = "No: " if last.ending == "no" else ""  # that a look ended well does not say that it found anything
    told = " ".join(d.told[-1] if d.told else f"I saw {listed(d.seen)}." for d in newest)
    return f"{lead if len(newest) == 1 else ''}{told} {_when(last)}"


def _when(look: Deed) -> str:
    return f"That was {_at(look.unix_ms)}, when I was to {step_words(look.label)}."


_NOW: Final = re.compile(r"\b(?:now|is there|are there)\b|^\W*any")
_THERE: Final = re.compile(r"\b(?:there|here|it|inside)\b", re.IGNORECASE)
"""Said of the last look alone; else all that was looked at for the same order counts."""


def _seen_labels(situation: Situation) -> tuple[Deed | None, list[str]]:
    """The last look, and what was seen that is on no map: what stands there all the time is nothing new."""
    looks = [deed for deed in _looks(situation) if deed.seen]
    if not looks:
        return None, []
    known = {
        name.lower()
        for item in situation.objects
        if not item.found
        for name in (item.description, item.class_name, *item.aliases)
    }
    return looks[-1], [label for label in dict.fromkeys(looks[-1].seen) if label.lower() not in known]


def _else(situation: Situation, about: str) -> str:
    look, labels = _seen_labels(situation)
    if look is None:
        return _seen(situation, about)
    others = [label for label in labels if not _stems(label) <= _stems(look.label)]
    return f"I also saw {listed(others)}." if others else "I saw nothing else there that is not on my map."


def _seen_thing(situation: Situation, about: str) -> str:
    look, labels = _seen_labels(situation)
    if _ANYTHING.match(about) or (look is None and _SEE.search(situation.message.lower())):
        return _seen(situation, "")
    if look is None:
        return ""
    wanted = _stems(about)
    hits = [label for label in look.seen if wanted & _stems(label)]
    if hits:
        return f"Yes, I saw {listed(hits)} there {_at(look.unix_ms)}."
    before = [d for d in _looks(situation) if d.told and any(wanted & _stems(label) for label in d.seen)]
    if before and not _THERE.search(situation.message):
        return f"{before[-1].told[-1]} {_when(before[-1])}"
    known = [item for item in situation.objects if not item.found and _stems(item.description) <= wanted]
    if known and not any(_stems(item.description) <= _stems(look.label) for item in known):
        return ""  # it is somewhere else by the map
    rest = f" I saw {listed(labels)}." if labels else ""
    return f"I did not see any there, when I looked {_at(look.unix_ms)}.{rest}"


_SEE: Final = re.compile(r"\byou (?:see|seen|find|found|notice|noticed|spot|spotted)\b")
_ANYTHING: Final = re.compile(r"(?:any|some)thing\b")


def _left_time(dialogue: Dialogue) -> str:
    if dialogue.left_s is None:
        return f" {dialogue.left_text}." if dialogue.left_text else ""
    seconds = max(1, round(dialogue.left_s))
    words = counted(seconds, "second") if seconds < 90 else counted(round(seconds / 60), "minute")
    return f" About {words} more for this step."


def _how_long(situation: Situation, about: str) -> str:
    dialogue, left = situation.dialogue, _steps_left(situation)
    if not left and dialogue.proposal is not None:
        return "I have not begun, so I cannot tell yet. I wait for your yes."
    if not left and re.search(r"\b(?:far|close)\b", situation.message.lower()):
        been = next((deed.label for deed in reversed(dialogue.deeds) if deed.moved), "")
        near = _things(situation, been)
        return _how_far(situation, been) if len(near) == 1 else _where(situation, about)
    if not left:
        return "Nothing is left to do."
    if dialogue.plan in ("paused", "held"):
        return "I stand still at the moment, so I cannot tell."
    more = f" Then {counted(len(left) - 1, 'more step')}." if len(left) > 1 else ""
    return f"{_left_time(dialogue).strip() or 'I have only just begun: I can tell in a moment.'}{more}"


_ENDS: Final = re.compile(r"(?:^| )(?:from|to|and|between|apart) ")


def _how_far(situation: Situation, about: str) -> str:
    """How far something of the map is, from here or another thing; of "it", how long the way still takes."""
    about = re.sub(r"^(?:from|between) (?:here|you|where you are) (?:to|and) ", "", about)
    between = about.startswith(("from ", "between ", "apart ")) or " from " in about
    both = [thing for part in _ENDS.split(about) for thing in _things(situation, part)] if between else []
    if len(both) == 2:
        gap_m = both[0].gap_m(both[1].x_m, both[1].y_m)
        return f"By my map they are about {round(max(gap_m, 2.0))} metres apart."
    things = _things(situation, about)
    if len(things) != 1 or between:
        return _how_long(situation, about) if situation.dialogue.steps and not things else ""
    name = called(things[0].description)
    return f"{name[:1].upper()}{name[1:]} is {lies(things[0], situation.objects, situation.robot_pose)}."


def _whats_in(situation: Situation, about: str) -> str:
    """What the map knows in a room, or around a thing."""
    room = about.lower() if about.lower() in rooms(situation.objects) else ""
    things = _things(situation, about) if not room else ()
    ends = [thing for part in about.split(" and ") for thing in _things(situation, part)]
    if "between" in situation.message.lower() and len(ends) == 2:
        return _between(situation, *ends)
    found = in_room(room, situation.objects, situation.robot_pose) if room else ()
    at, far_m = situation.robot_pose if about in ("", "here", "you", "me", "us") else None, _AROUND_M
    if len(things) == 1:
        at, far_m = Pose2D(things[0].x_m, things[0].y_m, 0.0), _BESIDE_M
    if at is not None:
        near = sorted(situation.objects, key=lambda item: distance_m(item, at))
        found = tuple(item for item in near if item not in things and distance_m(item, at) < far_m)
    names = [called(item.description) for item in found[:_MOST]]
    return f"By my map: {listed(names)}. What is there now I only see when I look." if names else ""


def _between(situation: Situation, one: MapObject, other: MapObject) -> str:
    middle = Pose2D((one.x_m + other.x_m) / 2, (one.y_m + other.y_m) / 2, 0.0)
    far_m = distance_m(one, middle)
    names = [
        called(item.description)
        for item in situation.objects
        if item not in (one, other) and distance_m(item, middle) < far_m
    ]
    return f"By my map: {listed(names[:_MOST])}." if names else "By my map there is nothing between them."


def _places(situation: Situation, about: str) -> str:
    """Where it can go: the rooms, and the things on the map that are nearest."""
    at = situation.robot_pose
    near = sorted(situation.objects, key=lambda item: distance_m(item, at) if at is not None else 0.0)
    names = [called(name) for name in (*rooms(situation.objects), *(item.description for item in near))]
    shown = [*dict.fromkeys(names)]
    more = f" More places on my map: {len(shown) - _PLACES}." if len(shown) > _PLACES else ""
    return f"I can go to {listed(shown[:_PLACES], 'or')}.{more}" if shown else ""


_PLACES: Final = 12


def _amiss(situation: Situation, about: str) -> str:
    """What of the last order was left out, given up or failed."""
    done = _visible(situation.dialogue.deeds)
    last = [deed for deed in done if deed.order == done[-1].order]
    bad = [deed_words(deed) for deed in last if deed.ending in ("failed", "stopped", "left out")]
    if bad or not done:
        return f"Not all of it was done: {'; '.join(bad)}." if bad else _did(situation, about)
    left = f" {_left(situation, about)}" if _steps_left(situation) else ""
    return f"So far I left nothing out, and nothing failed.{left}"


def _things(situation: Situation, about: str) -> tuple[MapObject, ...]:
    names = named(tokenize(about), situation.places, lexicon())
    return names[0].things if len(names) == 1 else ()


def _well(situation: Situation, about: str) -> str:
    low = situation.dialogue.battery is not None and situation.dialogue.battery <= 0.2
    return _battery(situation, about) if low else "I am well, thank you."


def _will_visit(situation: Situation, about: str) -> str:
    things = _things(situation, about)
    words = " ".join(step.label for step in _steps_left(situation)).lower()
    comes = "Yes" if any(thing.description.lower() in words for thing in things) else "No"
    waits = not words and situation.dialogue.proposal is not None
    return f"{'' if waits else f'{comes}. '}{_left(situation, '')}" if things else ""


def _battery(situation: Situation, about: str) -> str:
    battery = situation.dialogue.battery
    return (
        "I cannot tell how full my battery is."
        if battery is None
        else f"My battery is {battery * 100:.0f} % full."
    )


def abilities(catalogue: Sequence[ActionInfo]) -> str:
    """What can be asked for, in the words of the actions' makers."""
    shown = [info for info in catalogue if not (info.only_finds or info.for_programs)]
    parts = [(re.split(r"[.;]", info.description)[0] or info.label or info.name) for info in shown]
    return "; ".join(dict.fromkeys(f"{part[:1].lower()}{part[1:]}" for part in parts))


def _able(situation: Situation, about: str) -> str:
    parts = abilities(situation.catalogue)
    if not parts:
        return "I do not know yet what I can do: my robot has not told me."
    return (
        f"I can do this: {parts}. I remember what you tell me, keep to what you forbid me, and tell where I "
        "am, what I did and what I saw. Say “stop” at any time."
    )


def _name(situation: Situation, about: str) -> str:
    return f"I am {situation.robot}, a robot." if situation.robot else "I am a robot."


def _time(situation: Situation, about: str) -> str:
    now = situation.dialogue.now_unix_ms
    return (
        f"By my clock it is {datetime.fromtimestamp(now / 1000):%H:%M, %Y-%m-%d}."
        if now
        else "I cannot tell the time."
    )


def _told_about(situation: Situation, about: str) -> str:
    wanted = _stems(about)
    facts = [
        entry
        for entry in situation.memory
        if entry.type == "text" and wanted & _stems(f"{entry.name} {entry.data}")
    ]
    if facts:
        return f"I remember: {'; '.join(entry.data.rstrip('.') for entry in facts[-3:])}."
    forgot = [at for at, turn in enumerate(situation.history) if turn.content.startswith("I forget this")]
    said = [
        t.content
        for t in situation.history[(forgot or [-1])[-1] + 1 :]
        if t.role == "operator" and wanted & _stems(t.content) and not t.content.rstrip().endswith("?")
    ]
    return (
        f"You told me: “{said[-1].strip()}”"
        if said
        else f"You have not told me anything about {about or 'that'}."
    )


def differences(names: Sequence[str], objects: Sequence[MapObject]) -> str:
    """Where each of several things is, so that a person can tell them apart."""
    others = [item for item in objects if item.description not in names]
    at = {item.description: Pose2D(item.x_m, item.y_m, 0.0) for item in objects}
    parts = [f"the {name} is {whereabouts(others, at[name])}" for name in names if name in at and others]
    text = "; ".join(parts) or f"I know them as {listed([f'the {name}' for name in names])}"
    return f"{text[:1].upper()}{text[1:]}."


def _told_all(situation: Situation, about: str) -> str:
    facts = [entry.data.rstrip(".") for entry in situation.memory if entry.type == "text"]
    things = len(situation.objects)
    known = f" Of {things} things I know from my map where they are." if things else ""
    if not facts:
        return f"You have not told me anything yet that I remember.{known}"
    more = f" and {len(facts) - _MOST} more" if len(facts) > _MOST else ""
    return f"I remember: {'; '.join(facts[-_MOST:])}{more}.{known}"


def _difference(situation: Situation, about: str) -> str:
    choices = situation.question
    return f"{choices}" if choices else ""


_TOPICS: Final[dict[str, Callable[[Situation, str], str]]] = {
    "where_are_you": _where, "been": _been, "there_yet": _there_yet, "going_before": _going_before,
    "where_going": _where_going, "why_stopped": _why_stopped, "waiting_for": _waiting, "why_not": _why_not,
    "why_not_go": _why_not_go, "why": _why, "what_doing": _doing, "what_left": _left, "what_did": _did,
    "will_visit": _will_visit, "before_stop": _before_stop, "beside_step": _beside, "asked": _asked,
    "when_did": _when_did, "said_last": _said_last, "who_am_i": _who_am_i,
    "what_seen": _seen, "what_else_seen": _else, "seen_thing": _seen_thing, "how_long": _how_long,
    "how_far": _how_far, "whats_in": _whats_in, "places": _places, "amiss": _amiss,
    "battery": _battery, "able": _able, "name": _name, "time": _time, "told_about": _told_about,
    "told_all": _told_all, "difference": _difference,
    "hear": lambda situation, about: "Yes, I hear you: I read every word.",
    "how_are_you": lambda situation, about: f"{_well(situation, about)} {_doing(situation, about)}",
    "in_the_way": lambda situation, about: "Sorry. Tell me where I shall go.",
    "speed": lambda situation, about: _SPEED,
    "will_tell": lambda situation, about: f"I tell you as soon as I am done. {_doing(situation, about)}",
    "undo": lambda situation, about: f"I cannot take back what is done. {_did(situation, about)}",
    "speaks": lambda situation, about: "I understand plain English.",
    "joke": lambda situation, about: "I am no good at that, sorry: I drive, look and remember.",
}  # fmt: skip
"""What answers which topic."""
