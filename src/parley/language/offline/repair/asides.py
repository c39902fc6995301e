"""Questions that an operator asks in the middle of a repair: answered, while the robot's own stays open."""

from __future__ import annotations

from collections.abc import Sequence

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, Situation, Turn
from parley.language.offline.dialogue import questions
from parley.language.offline.dialogue.own_state import step_words
from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.repair.failed_step import candidates_of, in_words, words_of
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.scene import Scene, UnclearError
from parley.language.offline.sentences.clauses import Clause, opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import a, capital, listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.messages.chat import ActionCall, ChatAction
from parley.world.object_map import MapObject

__all__ = ["about_failure", "answered_aside", "asks"]

_WHY = (
    ("why",), ("how", "come"), ("what", "happened"), ("what", "is", "wrong"), ("what", "went", "wrong"),
    ("what", "is", "the", "problem"), ("what", "is", "the", "matter"), ("what", "is", "the", "issue"),
    ("what", "do", "you", "mean"), ("what", "is", "it", "about"), ("for", "what"), ("what", "for"),
)  # fmt: skip
_DOING = (
    ("what", "were", "you"), ("what", "did", "you", "want"), ("what", "was", "the", "plan"),
    ("what", "was", "your"), ("what", "did", "you", "try"), ("what", "are", "you", "doing"),
    ("what", "are", "you", "trying"), ("where", "were", "you", "going"), ("where", "are", "you", "going"),
    ("where", "did", "you", "want"), ("what", "were", "you", "up", "to"),
)  # fmt: skip
_SEEING = (
    ("what", "do", "you", "see"), ("what", "can", "you", "see"), ("what", "did", "you", "see"),
    ("what", "have", "you", "seen"), ("can", "you", "see"), ("do", "you", "see"), ("what", "is", "it"),
    ("what", "is", "in", "the", "way"), ("what", "is", "in", "your", "way"), ("what", "is", "blocking"),
    ("what", "is", "there"), ("what", "blocks"), ("what", "is", "that"), ("who", "is", "it"),
)  # fmt: skip
_WHERE_IT = (
    ("where", "is", "it"), ("where", "is", "that"), ("where", "exactly"), ("where",), ("which", "place"),
    ("where", "is", "the", "obstacle"), ("where", "is", "the", "problem"), ("where", "are", "you", "stuck"),
)  # fmt: skip
_OTHER_WAY = ("another way", "other way", "way around", "different way", "any way", "alternative")
_SHORT = {("why",), ("where",), ("which",)}
_CHOICES = (
    ("which",), ("what", "are", "the", "options"), ("what", "can", "i", "choose"), ("what", "choices"),
    ("what", "are", "my", "options"), ("what", "are", "my", "choices"), ("what", "are", "the", "choices"),
    ("what", "options"), ("what", "is", "there", "to", "choose"), ("between", "what"), ("how", "many", "are"),
)  # fmt: skip


def asks(reply: str) -> bool:
    """Whether a reply asks something, and is not a request put politely ("can you try again?")."""
    words = strip_openers(tokens(reply.strip()))
    flat = keys(words)
    if not flat or not any(word.is_word for word in words):
        return False
    if questions.unwrapped(words)[1]:
        return True
    if opens_command(words) and flat[0] not in lexicon().question_starts:
        return False
    starts = lexicon().question_starts | {"why", "how"}
    return reply.strip().endswith("?") or flat[0] in starts


def about_failure(situation: ErrorSituation, message: str) -> ChatAction | None:
    """The answer to a question about the failure; None if the message asks no such thing."""
    if not asks(message):
        return None
    text = _about_failure(situation, keys(word for word in strip_openers(tokens(message)) if word.is_word))
    return ChatAction(message_response=text) if text else None


def answered_aside(situation: ErrorSituation, reply: str) -> ChatAction | None:
    """The answer to a question about the failure, the robot or what it knows; None if there is none."""
    words = tuple(word for word in strip_openers(tokens(reply)) if word.is_word)
    words = tuple(w for w in questions.unwrapped(words)[0] if w.key not in {"exactly", "actually", "just"})
    flat = keys(words)
    if len(flat) < 2 and flat not in _SHORT:
        return None
    text = _about_failure(situation, flat) or _known(situation, words)
    if not text:
        return None
    return ChatAction(message_response=text, targets=(situation.robot,) if situation.robot else ())


def _about_failure(situation: ErrorSituation, flat: tuple[str, ...]) -> str:
    text = " ".join(flat)
    if any(words in text for words in _OTHER_WAY) and situation.code in {
        FailureCode.BLOCKED,
        FailureCode.UNREACHABLE,
    }:
        return f"{in_words(situation)} I know of no other way at the moment; I can look again if you say so."
    if _begins(flat, _DOING):
        return _doing(situation)
    if _begins(flat, _WHY):
        return f"{in_words(situation)} {_purpose(situation.failed_action)}".strip()
    if _begins(flat, _SEEING):
        return _seen(situation)
    if flat in _WHERE_IT or flat[:3] in {("where", "is", "it"), ("where", "is", "that")}:
        return _where(situation)
    candidates = candidates_of(situation)
    if candidates and _begins(flat, _CHOICES):
        names = [the(describe(item, candidates)) for item in candidates]
        return f"I know {listing(names)}."
    return ""


def _begins(flat: tuple[str, ...], starts: Sequence[tuple[str, ...]]) -> bool:
    return any(flat[: len(start)] == start for start in starts)


def _purpose(step: ActionCall) -> str:
    return f"I wanted to {step.reason}." if step.reason else ""


def _doing(situation: ErrorSituation) -> str:
    done = f"I was at this step: {step_words(situation.failed_action)}."
    if not situation.pending:
        return f"{done} It is the last one."
    left = listing([step_words(step) for step in situation.pending], "and then")
    return f"{done} After that I am to {left}."


def _seen(situation: ErrorSituation) -> str:
    details = situation.details
    hiding, seen = details.get("in_the_way"), details.get("seen")
    if isinstance(hiding, str) and hiding:
        return f"I see {a(hiding)}, and it is in the way."
    if isinstance(seen, Sequence) and not isinstance(seen, str) and seen:
        return f"When I looked, I saw {listing([a(str(item)) for item in seen])}."
    if isinstance(seen, Sequence):
        return "When I looked, I saw nothing that I know."
    return f"{in_words(situation)} I have not looked closer; I stand still until you tell me what to do."


def _where(situation: ErrorSituation) -> str:
    """Where what went wrong is: the obstacle, else the thing that the step is about."""
    at, near = situation.details.get("at"), situation.details.get("near")
    thing = next((item for item in situation.objects if item.id == near), None)
    if thing is None and isinstance(at, dict):
        thing = _nearest(situation.objects, at.get("x"), at.get("y"))
    if thing is not None:
        return f"It is by {the(describe(thing, situation.objects))}."
    wanted = words_of(situation.failed_action)
    if wanted and len(wanted.split()) <= 6:
        asked = (Word("where", "where"), Word("is", "is"), *tokens(the(wanted)))
        known = _known(situation, tuple(word for word in asked if word.is_word))
        return known or f"I do not know where {the(wanted)} is."
    pose = situation.robot_pose
    here = _nearest(situation.objects, pose.x_m, pose.y_m) if pose is not None else None
    return f"I am by {the(describe(here, situation.objects))}." if here is not None else ""


def _nearest(objects: Sequence[MapObject], x_m: object, y_m: object) -> MapObject | None:
    if not isinstance(x_m, int | float) or not isinstance(y_m, int | float) or not objects:
        return None
    return min(objects, key=lambda item: (item.x_m - x_m) ** 2 + (item.y_m - y_m) ** 2)


def _known(situation: ErrorSituation, words: Phrase) -> str:
    """What the engine says to this question at any other time, without anything being done."""
    history = [Turn(turn.role, turn.content) for turn in situation.dialogue]
    scene = Scene.of(
        Situation(
            " ".join(word.raw for word in words),
            memory=situation.memory,
            history=tuple(history),
            queue=(situation.failed_action, *situation.pending),
            status="paused",
            objects=situation.objects,
            robot_pose=situation.robot_pose,
            robot=situation.robot,
            robots=(situation.robot,) if situation.robot else (),
            catalogue=situation.catalogue,
        )
    )
    scene.mention(tokens(words_of(situation.failed_action)))
    try:
        answer = questions.answer(Clause(words, is_question=True), scene)
    except UnclearError as unclear:
        return unclear.question
    if answer is None:
        return ""
    if answer.look:
        return capital(whole_sentence("I would have to look, and I stand still until you answer me"))
    return answer.text
