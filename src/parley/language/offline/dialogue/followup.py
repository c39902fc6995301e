"""Answers to questions that Parley asked about a message: they complete that message."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.offered import chosen_by_answer, plain_answer, without_tail
from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.repair.replies import agrees
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import clauses, opens_command
from parley.language.offline.words import social
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain, tokens

__all__ = ["Request", "declines", "pending_request"]

_ASKING_BACK = (
    "which one do you mean",
    "where is",
    "where are you",
    "do you mean",
    "what should i",
    "where should i",
    "shall i",
    "should i",
    "would you like me to",
    "do you want me to",
    "tell me where",
    "who do you mean",
    "what do you mean",
    "please name",
    "which",
    *(
        f"how {much}"
        for much in ("many", "much", "long", "fast", "far", "high", "often", "hot", "warm", "bright")
    ),
)
_WHAT_FOR = ("what should i look for", "what shall i look for", "what am i to look for", "look for what")
_LONGEST_ANSWER = 14
_MEANING = (("i", "mean"), ("i", "meant"), ("i", "was", "thinking", "of"), ("i", "wanted", "to", "say"))
_QUANTIFIED = frozenset({"all", "every", "each", "both", "except", "but", "any"})


@dataclass(frozen=True, slots=True)
class Request:
    """An earlier message with the answers that complete it."""

    message: str
    hints: tuple[str, ...] = ()
    history: tuple[Turn, ...] = ()
    """What was said before that message."""
    declined: bool = False
    instead: bool = False
    """Whether what the robot took it for is refused, and the answer names another thing."""


def pending_request(words: Phrase, situation: Situation) -> Request | None:
    """The message that was asked about, if `words` answer the question."""
    history, words = situation.history, _meant_instead(without_tail(words))
    if not history or not _asks(history[-1]) or not _is_answer(words, history[-1]):
        return None
    told = _where_told(words, situation)
    answer = plain(told) if told else plain_answer(words, history[-1], situation.objects)
    hints = [answer]
    at = len(history) - 1
    while at > 0 and _asks(history[at]):
        at -= 1
        turn = history[at]
        if turn.role != "operator":
            return None
        if at > 0 and _asks(history[at - 1]) and _is_answer(tokens(turn.content), history[at - 1]):
            hints.insert(0, turn.content)
            at -= 1
            continue
        free = any(lexicon().your_choice.match(keys(words), i) for i in range(len(words)))
        chooses = bool(chosen_by_answer(words, history[-1], situation.objects))
        refuses = agrees(plain(words)) is False and len(words) <= 4 and not free and not chooses
        meant = next((m for m in _MEANING if keys(words[: len(m)]) == m and len(words) > len(m)), ())
        if meant:
            hints[-1] = answer = plain(words[len(meant) :])
        instead = (
            bool(refuses or meant) and ground_phrase(tokens(answer), situation.objects).outcome == "match"
        )
        sought = any(text in history[-1].content.lower() for text in _WHAT_FOR)
        message = f"{turn.content.rstrip(' .!?')} for {answer}" if sought else turn.content
        return Request(message, tuple(hints), history[:at], refuses and not instead, instead)
    return None


def _meant_instead(words: Phrase) -> Phrase:
    """For "none of them, A": "I meant A"; other answers come back unchanged."""
    lead = next((n for n in _NEITHER if keys(words[: len(n)]) == n), ())
    rest = words[len(lead) :]
    while rest and (not rest[0].is_word or rest[0].key in {"but", "please"}):
        rest = rest[1:]
    if not lead or not rest or opens_command(rest):
        return words
    said = any(keys(rest[: len(m)]) == m for m in _MEANING)
    return rest if said else (*tokens("I meant"), *rest)


_NEITHER = tuple(
    tuple(text.split())
    for text in ("none of them", "none of those", "none of these", "neither of them", "neither of those",
                 "neither one", "neither", "none")
)  # fmt: skip


def _tells_where(flat: tuple[str, ...]) -> tuple[int, int]:
    """Where what is spoken of stands in "(the one) where A is", "the one with A in it"; nothing elsewhere."""
    at = next((i for i in range(min(4, len(flat))) if flat[i] in {"where", "with"}), -1)
    described = at >= 0 and flat[:at] in {(), ("the", "one"), ("one",), ("that",)}
    if not described or len(flat) < at + 3:
        return 0, 0
    if flat[at] == "where":
        return (at + 1, len(flat) - 1) if flat[-1] in lexicon().be | lexicon().location_verbs else (0, 0)
    inside = flat[-2:] in {("in", "it"), ("on", "it"), ("at", "it"), ("by", "it")}
    return (at + 1, len(flat) - 2 * inside) if at else (0, 0)


def _where_told(words: Phrase, situation: Situation) -> Phrase:
    """The place that "(the one) where A is" means, where it is remembered; empty if it is none."""
    words = tuple(word for word in words if word.is_word)
    start, end = _tells_where(keys(words))
    about = bare(words[start:end])
    known = find_fact(about, Scene.of(situation).facts)[0] if about else None
    return known.fact.place if known is not None else ()


def declines(message: str, situation: Situation) -> bool:
    """Whether a message says no to a question that was just asked."""
    asked = bool(situation.history) and _asks(situation.history[-1])
    if any(lexicon().your_choice.match(keys(tokens(message)), i) for i in range(len(tokens(message)))):
        return False
    return asked and agrees(message) is False


def _asks(turn: Turn) -> bool:
    text = turn.content.lower()
    return (
        turn.role == "assistant"
        and ("?" in text[-140:] or "tell me where" in text)
        and any(q in text for q in _ASKING_BACK)
    )


def _is_answer(words: Phrase, question: Turn) -> bool:
    """A fragment, a yes or no, or a place; a new order or question is none."""
    parts = clauses(words, opens_command)
    if (
        len(parts) > 1
        and agrees(plain(words)) is not True
        and opens_command(parts[-1].words)
        and "one" not in keys(parts[-1].words)
    ):
        # "Forget it, go to the box": a new order.
        return False
    words = tuple(word for word in words if word.is_word)
    if not words or len(words) > _LONGEST_ANSWER:
        return False
    flat = keys(strip_openers(words))
    free = any(lexicon().your_choice.match(keys(words), i) is not None for i in range(len(words)))
    if len(words) <= 5 and (free or agrees(plain(words)) is not None):
        return True
    if _tells_where(flat)[1] and flat[0] == "where":
        return True
    if flat[0] in lexicon().question_starts or social.reply(words) is not None:
        return False
    asked_where = any(
        text in question.content.lower()
        for text in ("where is", "where are", "where should", "tell me where")
    )
    if asked_where and read_statement(words) is not None:
        return True
    if opens_command(words):
        # "Go to the small one" answers "which one?" as well as "the small one" does.
        return "one" in flat and flat[0] in {"go", "take", "use"} and not _QUANTIFIED & set(flat)
    return read_statement(words) is None or flat[0] in {"it", "he", "she", "they", "i"}
