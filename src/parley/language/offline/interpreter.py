"""What a message asks for: the way from words to a Chat Action."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from parley.language.base import Situation
from parley.language.control import control_of
from parley.language.offline.dialogue import addressing
from parley.language.offline.dialogue.amending import amended
from parley.language.offline.dialogue.crew_words import for_another
from parley.language.offline.dialogue.crews import plainly_called
from parley.language.offline.dialogue.elsewhere import (
    elsewhere,
    in_place_of_misspelt,
    in_place_of_unclear,
    put_in_place,
)
from parley.language.offline.dialogue.followup import Request, declines, pending_request
from parley.language.offline.dialogue.offered import accepted_offer
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.protocols import protocol_memory, read_protocol
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.plan_changes.changing import CONTROL_REPLIES
from parley.language.offline.plan_changes.rearranging import rearranged
from parley.language.offline.readings.choosing import best_reading
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.forms import plainly_put
from parley.language.offline.sentences.intentions import straight_on, without_own_plans
from parley.language.offline.sentences.learners import usually_said
from parley.language.offline.sentences.moved import out_of_the_way, where_it_was_put
from parley.language.offline.sentences.spoken import orders_among_talk
from parley.language.offline.sentences.telling import plainly_so
from parley.language.offline.tasks.meeting import Meeting
from parley.language.offline.words import social
from parley.language.offline.words.courtesy import called_plainly, plainly
from parley.language.offline.words.explaining import Trace
from parley.language.offline.words.foreign import ONLY_ENGLISH, is_foreign
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.mending import mended
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.quantities import plain_coordinates, plain_units
from parley.language.offline.words.saying import listing
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.language.offline.words.wording import as_others_say, counted_plainly, shared_out, still_there
from parley.messages.chat import ChatAction, SystemCommand

__all__ = ["interpret"]

_LONGEST_CHARS = 6000


def interpret(situation: Situation, trace: Trace | None = None) -> ChatAction:
    """Understand one message.

    Args:
        situation: What is known.
        trace: Collects what was decided, for those who ask why.
    """
    trace = Trace() if trace is None else trace
    message = plain_units(plain_coordinates(situation.message.strip()))
    if not any(char.isalnum() for char in message):
        return _say(situation, "I did not get any words. What can I do for you?")
    if len(message) > _LONGEST_CHARS:
        return _say(situation, "That is too long for me to follow. Please tell me in a few short sentences.")
    controlled = _controlled(message, situation, trace)
    if controlled is None and is_foreign(tokens(message), _names(situation)):
        trace.note("answer", "another language")
        return _say(situation, ONLY_ENGLISH)
    return controlled or _given_up_for(message, situation, trace) or _read(message, situation, trace)


def _given_up_for(message: str, situation: Situation, trace: Trace) -> ChatAction | None:
    """For "forget it, V" with steps pending: none of them, but V; None if that is not what is said."""
    words = tokens(message)
    at = next((i for i, word in enumerate(words) if not word.is_word), 0)
    head, rest = keys(words[:at]), words[at + 1 :]
    kept = any(turn.content.startswith("I will remember") for turn in situation.history[-1:])
    if not situation.queue or head not in _ALL_OFF or kept or keys(rest[:1]) in _ADDING:
        return None
    asked = replace(situation, message=plain(rest), queue=(), status="idle")
    answer = interpret(asked) if rest else None
    if answer is None or not answer.queue:
        return None
    command, reply = CONTROL_REPLIES["clear"]
    trace.note("control", f"“{plain(words[:at])}” means all that is pending; then “{plain(rest)}”")
    return answer.model_copy(
        update={
            "system_cmd": (SystemCommand(command=command), *answer.system_cmd),
            "message_response": f"{reply} {answer.message_response}",
        }
    )


_ALL_OFF = frozenset(
    tuple(text.split())
    for text in (
        "forget it",
        "forget that",
        "forget about it",
        "forget about that",
        "forget all that",
        "scrap that",
        "cancel everything",
        "drop everything",
    )
)
_ADDING = frozenset({("but",), ("except",), ("only",), ("just",), ("and",)})


def _names(situation: Situation) -> frozenset[str]:
    """The words of the names that are known here, in whatever language they are."""
    told = (entry.data for entry in situation.memory if entry.type == "text")
    things = (f"{item.description} {item.class_name}" for item in situation.objects)
    said = " ".join((*things, *told, *situation.robots)).lower()
    return frozenset(re.findall(r"[^\W\d_]+", said))


def _controlled(message: str, situation: Situation, trace: Trace) -> ChatAction | None:
    """The answer to what is nothing but "stop" or one of its kin; None if it is more."""
    control = control_of(message, situation.robots)
    if control is None and _goes_on(message, situation):
        again = (SystemCommand(command="start"),) if situation.status == "paused" else ()
        return _say(situation, "All right, I go on.", commands=again)
    if control == "skip" and declines(message, situation):
        return _say(situation, "All right, I leave it.")
    if control is None and situation.queue and not declines(message, situation) and _gives_up(message):
        control = "clear"
    if control == "stop" and Meeting(Scene.of(situation)).ends_own(strip_openers(tokens(message))):
        return None
    if control == "clear" and not situation.queue and _clears_things(message, situation):
        return None
    if (
        control == "skip"
        and situation.queue
        and rearranged(_plain_words(message, situation), Scene.of(situation))
    ):
        # "A is being painted, so leave that one out": not what is being done now.
        return None
    if control is None or (control == "start" and _wants_again(message, situation)):
        return None
    command, reply = CONTROL_REPLIES[control]
    trace.note("control", f"the whole message means “{control}”, so the command is {command}")
    called = addressing.addressed(plainly_called(tokens(message), situation), situation)[1]
    return _say(situation, reply, commands=(SystemCommand(command=command),), targets=called)


def _goes_on(message: str, situation: Situation) -> bool:
    """Whether a message says that the robot is not to stop, and nothing else."""
    words = tuple(word for word in strip_openers(tokens(message)) if word.is_word)
    flat = keys(words)
    lead = next((lead for lead in _NEVER if flat[: len(lead)] == lead), ())
    rest = words[len(lead) :]
    for_somebody = keys(rest[:2]) in {(verb, "for") for verb in ("stop", "wait", "pause", "halt", "slow")}
    return bool(lead) and (for_somebody or control_of(plain(rest), situation.robots) == "stop")


_NEVER = (
    ("do", "not", "you", "dare"), ("do", "not", "ever"), ("you", "must", "not"), ("do", "not"), ("never",),
    ("there", "is", "no", "need", "to"), ("no", "need", "to"), ("you", "need", "not"), ("no", "reason", "to"),
    ("you", "do", "not", "need", "to"), ("you", "do", "not", "have", "to"),
    ("there", "is", "no", "reason", "to"),
)  # fmt: skip
_GIVING_UP = frozenset(
    tuple(text.split())
    for text in (
        "forget it", "forget about it", "never mind", "do not bother", "forget about that", "let it go",
        "it is all off", "i changed my mind", "i have changed my mind", "changed my mind", "never mind then",
        "forget it then",
    )
)  # fmt: skip


def _clears_things(message: str, situation: Situation) -> bool:
    """Whether "clear it" asks for something that this robot clears ("clear_snow"), with nothing planned."""
    said = set(keys(tokens(message)))
    return "it" in said and any(said & set(name_words(info.name)[:1]) for info in situation.catalogue)


def _gives_up(message: str) -> bool:
    """Whether a message with steps pending says that nothing of it is wanted any more."""
    words = tuple(word for word in strip_openers(tokens(message)) if word.is_word)
    return keys(words) in _GIVING_UP


def _read(message: str, situation: Situation, trace: Trace) -> ChatAction:
    words = _plain_words(message, situation)
    if plain(words) != plain(tokens(message)):
        trace.note("words", f"read as “{plain(words)}”")
    ready = _to_others(words, situation, trace)
    if ready is not None:
        return ready
    words = plainly_called(words, situation)
    others = addressing.other_robots(words, situation)
    if others:
        text = f"Which robot do you mean: {listing(list(others), 'or')}?"
        return _say(situation, text).model_copy(update={"choices": others})
    own = addressing.own_part(words, situation)
    if own is not None:
        trace.note("target", f"several robots get orders; the one of {own[2]} is “{plain(own[0])}”")
        mine = interpret(replace(situation, message=plain(own[0]), robot=own[2], robots=(own[2],)), trace)
        theirs = f"That is my part; {listing(own[1])} must get this message too."
        return mine.model_copy(
            update={"message_response": f"{mine.message_response} {theirs}", "targets": (own[2],)}
        )
    called, (words, targets) = words, addressing.addressed(words, situation)
    if targets:
        trace.note("target", f"addressed to {listing(targets)}")
    unknown = "" if targets else addressing.stranger(words, situation)
    if unknown:
        trace.note("target", f"{unknown} is none of the robots")
        robots = list(situation.robots)
        text = f"I do not know a robot called {unknown}. Which one do you mean: {listing(robots, 'or')}?"
        return _say(situation, text).model_copy(update={"choices": situation.robots})
    situation = replace(situation, robot=targets[0] if targets else situation.robot)
    words, targets = _or_elsewhere(words, targets, called, situation)
    if not any(word.is_word for word in words):
        return _say(situation, "Yes? What can I do for you?", targets=targets)
    taught = read_protocol(plain(words))
    if taught is not None and taught.standing and not _can_be_looked_at(words, taught.condition, situation):
        text = f"I will remember that: {taught.sentence}."
        return _say(situation, text, commands=(protocol_memory(taught),), targets=targets)
    request = pending_request(words, situation)
    offered = request is not None or accepted_offer(words, situation) is not None
    answer = None if offered else _sociable(words, situation)
    if answer is not None:
        trace.note("answer", "small talk, a greeting or thanks")
        return _say(situation, answer, targets=targets)
    offer = accepted_offer(words, situation)
    looks = not offer or bool({"look", "check"} & set(keys(offer)))
    action = _answered(request, situation, trace, targets) if request is not None and looks else None
    if offer is None or (action is not None and action.queue):
        return action or _following_up(words, situation, trace, targets)
    if not offer:
        return _say(situation, "All right, I leave it.", targets=targets)
    trace.note("words", f"agreed to what was offered: “{plain(offer)}”")
    return best_reading(offer, situation, (), trace, targets)


def _to_others(words: Phrase, situation: Situation, trace: Trace) -> ChatAction | None:
    """What is asked of the rest of the plan, not of the robots, and the last order for another robot."""
    if situation.queue and {"rest", "others"} & set(keys(words)) and rearranged(words, Scene.of(situation)):
        # "..., the rest stays": the rest of the plan, not of the robots.
        return best_reading(words, situation, (), trace, ())
    handed = () if situation.queue else for_another(words, situation)
    if not handed:
        return None
    trace.note("words", f"the last order for another robot: “{plain(handed)}”")
    robots = tuple(name for name in situation.robots if set(keys(tokens(name))) <= set(keys(words)))
    return best_reading(handed, replace(situation, robot=robots[0], history=()), (), trace, robots)


def _sociable(words: Phrase, situation: Situation) -> str | None:
    """The answer to small talk, greetings and other languages; None if anything is asked for besides."""
    opened = strip_openers(words)
    answer = social.reply(words) or (social.reply(opened) if opened != words else None)
    asks = answer is not None and orders_among_talk(words, Scene.of(situation))
    return None if asks else answer


def _plain_words(message: str, situation: Situation) -> Phrase:
    """The words of a message, mended, without courtesy and what is told of the operator's own plans."""
    scene = Scene.of(situation)
    called = frozenset(name.lower() for name in (situation.robot, *situation.robots))
    words = usually_said(called_plainly(mended(tokens(message), situation), called), scene)
    words = shared_out(counted_plainly(still_there(as_others_say(words))))
    words = where_it_was_put(straight_on(without_own_plans(plainly(words))))
    own = frozenset(name_words(info.name)[0] for info in scene.catalogue.of_own_kind if name_words(info.name))
    plainer = out_of_the_way(plainly_put(plainly_so(words), scene), own)
    # "Everything but A can be dropped" changes the plan as it stands.
    stands = situation.queue and plainer != words and rearranged(words, scene) is not None
    return words if stands else plainer


def _answered(request: Request, situation: Situation, trace: Trace, targets: tuple[str, ...]) -> ChatAction:
    """Understand the message that was asked about, now that the question is answered."""
    if request.declined:
        return _say(situation, "All right, I leave it.", targets=targets)
    hints = listing([f"“{hint}”" for hint in request.hints])
    trace.note("words", f"an answer to a question about “{request.message}”: {hints}")
    words, targets = addressing.addressed(_plain_words(request.message, situation), situation)
    situation = replace(situation, history=request.history)
    if request.instead:
        named, scene = tokens(request.hints[-1]), Scene.of(situation)
        for instead in (put_in_place, in_place_of_unclear, in_place_of_misspelt):
            found = instead(named, words, scene)
            if found:
                words = found
                break
    action = best_reading(words, situation, request.hints, trace, targets)
    return _or_small_talk(action, words, situation, trace)


def _following_up(words: Phrase, situation: Situation, trace: Trace, targets: tuple[str, ...]) -> ChatAction:
    """Understand a message that may be about the last order."""
    again = () if situation.queue else elsewhere(words, situation)
    if again:
        trace.note("words", f"the last order for another thing: “{plain(again)}”")
        words = again
    change = None if again else amended(words, situation)
    if change is not None:
        trace.note("words", f"the last order with another value: “{plain(change.words)}”")
        if change.instead and situation.queue:
            return _in_its_place(change.words, situation, trace, targets)
        words = change.words
    action = best_reading(words, situation, (), trace, targets)
    return _or_small_talk(action, words, situation, trace)


def _in_its_place(words: Phrase, situation: Situation, trace: Trace, targets: tuple[str, ...]) -> ChatAction:
    """An order in the place of what is left of the last one."""
    idle = replace(situation, queue=(), status="idle")
    order = best_reading(words, idle, (), trace, targets)
    names = [call.name for call in order.queue]
    pending = [call.name for call in situation.queue]
    left = next((n for n in range(min(len(names), len(pending)), 0, -1) if pending[-n:] == names[-n:]), 0)
    taken = range(len(pending) - 1, len(pending) - 1 - left, -1) if order.queue else ()
    pops = tuple(SystemCommand(command="pop", arguments={"parameters": i}) for i in taken)
    return order.model_copy(update={"system_cmd": (*pops, *order.system_cmd)})


def _or_small_talk(action: ChatAction, words: Phrase, situation: Situation, trace: Trace) -> ChatAction:
    """What was made of a message; if that is nothing and it is small talk, an answer to that."""
    if action.queue or action.system_cmd or action.sources or action.choices:
        return action
    talk = social.small_talk(words, action.message_response)
    if talk is None or mentioned(words, Scene.of(situation)):
        return action
    trace.note("answer", "small talk, of which nothing else was made")
    return action.model_copy(update={"message_response": talk})


def _or_elsewhere(
    words: Phrase, targets: tuple[str, ...], called: Phrase, situation: Situation
) -> tuple[Phrase, tuple[str, ...]]:
    """For "and the others?": other things, not the other robots, if the last order was about a thing."""
    said = {word.key for word in words if word.is_word}
    again = elsewhere(called, situation) if said <= {"as", "well", "too", "also", "please", "now"} else ()
    return (again, ()) if again else (words, targets)


def _can_be_looked_at(words: Phrase, condition: Phrase, situation: Situation) -> bool:
    """Whether "if the door is blocked, ..." is about one thing on the map: then it is looked at now."""
    if keys(words[:1]) not in {("if",), ("in",), ("should",), ("unless",)}:
        return False
    links = lexicon().be | lexicon().auxiliaries
    link = next((i for i, word in enumerate(condition) if word.key in links), 0)
    return link > 0 and ground_phrase(condition[:link], situation.objects, strict=True).outcome == "match"


def _wants_again(message: str, situation: Situation) -> bool:
    """Whether "again" cannot mean a pending plan, because there is none."""
    idle = situation.status == "idle" and not situation.queue and bool(situation.history)
    return idle and bool({"again", "repeat", "more"} & set(keys(tokens(message))))


def _say(
    situation: Situation, text: str, *, commands: Sequence[SystemCommand] = (), targets: Sequence[str] = ()
) -> ChatAction:
    return ChatAction(
        message_response=text,
        system_cmd=tuple(commands),
        targets=tuple(targets) or ((situation.robot,) if situation.robot else ()),
    )
