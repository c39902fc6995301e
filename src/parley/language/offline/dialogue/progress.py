"""Questions about what was done already: "have you been to the desk yet?", "did you check A?"."""

from __future__ import annotations

from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.dialogue.own_state import step_words
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.plan_changes.replanning import visit_of, visits
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, keys, lemma, plain, tokens

__all__ = ["progress"]

_STARTS = (
    ("have", "you"),
    ("did", "you"),
    ("has", "anybody"),
    ("has", "anyone"),
    ("are", "you", "through"),
    ("are", "you", "finished"),
    ("are", "you", "done"),
    ("were", "you"),
    ("is",),
    ("has",),
    ("was",),
    ("you", "have"),
    ("when", "did", "you"),
)
_GOING = (
    ("are", "you", "on", "your", "way"),
    ("are", "you", "going"),
    ("are", "you", "heading"),
    ("are", "you", "headed"),
    ("are", "you", "driving"),
    ("are", "you", "still", "going"),
    ("are", "you", "already", "on"),
    ("are", "you", "off", "to"),
    ("is", "the", "robot", "on", "its", "way"),
    ("are", "you", "coming"),
)
_DONE = frozenset(
    {
        "check",
        "visit",
        "inspect",
        "look",
        "go",
        "be",
        "been",
        "do",
        "finish",
        "see",
        "reach",
        "get",
        "arrive",
        "pass",
        "examine",
        "cover",
        "complete",
        "through",
        "patrol",
        "scan",
        "search",
        "drive",
        "done",
        "finished",
        "manage",
        "deal",
        "make",
        "deliver",
        "bring",
        "fetch",
    }
)


def progress(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """The answer to whether something of the plan was done already; None if that is not asked.

    Args:
        words: The question.
        flat: The same, as its words are compared.
        scene: What is known.
    """
    going = next((lead for lead in _GOING if flat[: len(lead)] == lead), ())
    if going and scene.situation.queue:
        named = mentioned(words, scene)
        at = visit_of(named[-1], scene) if named else None
        if at is not None:
            more = "" if at == 0 else f", after {at} other {'stop' if at == 1 else 'stops'}"
            return Answer(f"Yes, I am on my way to {the(plain(named[-1]))}{more}.")
        if named:
            return Answer(f"No, {the(plain(named[-1]))} is not in my plan. {_first(scene)}")
    start = next((start for start in _STARTS if flat[: len(start)] == start), ())
    passive = len(start) == 1
    if not start or not ({lemma(word) for word in flat[len(start) :]} | set(flat)) & _DONE:
        return None
    if passive and not {"been", "done", "finished", "checked", "visited", "inspected"} & set(flat[1:]):
        return None
    names = mentioned(words, scene)
    if not names:
        return None
    name = names[-1]
    at = visit_of(name, scene)
    if at is not None:
        now = "I am on it now" if at == 0 and visits(scene) else "it is still on my list"
        return Answer(f"Not yet, {now}.")
    asked = any(
        name in mentioned(tokens(turn.content), scene)
        or f" {' '.join(keys(name))} " in f" {' '.join(keys(tokens(turn.content)))} "
        for turn in scene.situation.history
        if turn.role == "operator"
    )
    if asked:
        return Answer(f"Yes, as far as I know: {the(plain(name))} is not among what I still have to do.")
    return None if passive else Answer(f"No, nobody has sent me to {the(plain(name))} yet. Shall I go?")


def _first(scene: Scene) -> str:
    return f"I am at this step: {step_words(scene.situation.queue[0])}."
