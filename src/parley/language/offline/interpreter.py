"""What a message asks for: the way from words to a Chat Action."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.language.base import Situation
from parley.language.control import control_of
from parley.language.offline.dialogue import addressing
from parley.language.offline.dialogue.crews import plainly_called
from parley.language.offline.dialogue.followup import declines, pending_request
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.protocols import protocol_memory, read_protocol
from parley.language.offline.plan_changes.changing import CONTROL_REPLIES
from parley.language.offline.readings.choosing import best_reading
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.intentions import without_own_plans
from parley.language.offline.sentences.moved import where_it_was_put
from parley.language.offline.sentences.spoken import orders_among_talk
from parley.language.offline.tasks.meeting import Meeting
from parley.language.offline.words import social
from parley.language.offline.words.courtesy import plainly
from parley.language.offline.words.explaining import Trace
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.mending import mended
from parley.language.offline.words.quantities import plain_coordinates
from parley.language.offline.words.saying import listing
from parley.language.offline.words.text import Phrase, keys, plain, tokens
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
    message = plain_coordinates(situation.message.strip())
    if not any(char.isalnum() for char in message):
        return _say(situation, "I did not get any words. What can I do for you?")
    if len(message) > _LONGEST_CHARS:
        return _say(situation, "That is too long for me to follow. Please tell me in a few short sentences.")
    return _controlled(message, situation, trace) or _read(message, situation, trace)


def _controlled(message: str, situation: Situation, trace: Trace) -> ChatAction | None:
    """The answer to what is nothing but "stop" or one of its kin; None if it is more."""
    control = control_of(message, situation.robots)
    if control == "skip" and declines(message, situation):
        return _say(situation, "All right, I leave it.")
    if control is None and situation.queue and not declines(message, situation) and _gives_up(message):
        control = "clear"
    if control == "stop" and Meeting(Scene.of(situation)).ends_own(strip_openers(tokens(message))):
        return None
    if control is None or (control == "start" and _wants_again(message, situation)):
        return None
    command, reply = CONTROL_REPLIES[control]
    trace.note("control", f"the whole message means “{control}”, so the command is {command}")
    called = addressing.addressed(plainly_called(tokens(message), situation), situation)[1]
    return _say(situation, reply, commands=(SystemCommand(command=command),), targets=called)


_GIVING_UP = frozenset(
    tuple(text.split())
    for text in (
        "forget it", "forget about it", "never mind", "do not bother", "forget about that", "let it go",
        "it is all off", "i changed my mind", "i have changed my mind", "changed my mind", "never mind then",
        "forget it then",
    )
)  # fmt: skip


def _gives_up(message: str) -> bool:
    """Whether a message with steps pending says that nothing of it is wanted any more."""
    words = tuple(word for word in strip_openers(tokens(message)) if word.is_word)
    return keys(words) in _GIVING_UP


def _read(message: str, situation: Situation, trace: Trace) -> ChatAction:
    words = where_it_was_put(without_own_plans(plainly(mended(tokens(message), situation))))
    if plain(words) != plain(tokens(message)):
        trace.note("words", f"read as “{plain(words)}”")
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
    words, targets = addressing.addressed(words, situation)
    if targets:
        trace.note("target", f"addressed to {listing(targets)}")
    unknown = "" if targets else addressing.stranger(words, situation)
    if unknown:
        trace.note("target", f"{unknown} is none of the robots")
        robots = list(situation.robots)
        text = f"I do not know a robot called {unknown}. Which one do you mean: {listing(robots, 'or')}?"
        return _say(situation, text).model_copy(update={"choices": situation.robots})
    situation = replace(situation, robot=targets[0] if targets else situation.robot)
    if not any(word.is_word for word in words):
        return _say(situation, "Yes? What can I do for you?", targets=targets)
    taught = read_protocol(plain(words))
    if taught is not None and taught.standing and not _can_be_looked_at(words, taught.condition, situation):
        text = f"I will remember that: {taught.sentence}."
        return _say(situation, text, commands=(protocol_memory(taught),), targets=targets)
    request = pending_request(words, situation)
    answer = social.reply(words) or social.reply(strip_openers(words)) if request is None else None
    if answer is not None and orders_among_talk(words, Scene.of(situation)):
        answer = None
    if answer is not None:
        trace.note("answer", "small talk, a greeting, thanks, or another language")
        return _say(situation, answer, targets=targets)
    if request is not None and request.declined:
        return _say(situation, "All right, I leave it.", targets=targets)
    if request is not None:
        hints = listing([f"“{hint}”" for hint in request.hints])
        trace.note("words", f"an answer to a question about “{request.message}”: {hints}")
        words, targets = addressing.addressed(mended(tokens(request.message), situation), situation)
        situation = replace(situation, history=request.history)
    return best_reading(words, situation, request.hints if request else (), trace, targets)


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
