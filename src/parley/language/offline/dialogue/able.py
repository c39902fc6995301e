"""Questions about what the robot is able to do: "can you carry things?", "are you able to dance?"."""

from __future__ import annotations

from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.abilities import abilities, cannot
from parley.language.offline.tasks.tasks import Tasks
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, lemma, plain, singular
from parley.messages.status import ActionInfo

__all__ = ["KNOWING_HOW", "able"]

KNOWING_HOW = ("do", "you", "know", "how", "to")
"""How a question about a skill begins that would else be one about knowledge."""

_ABLE = (
    ("are", "you", "able", "to"),
    ("can", "you"),
    ("could", "you"),
    ("do", "you", "know", "how", "to"),
    ("are", "you", "capable", "of"),
)
_GENERIC = frozenset(
    [
        "thing",
        "object",
        "something",
        "stuff",
        "people",
        "person",
        "item",
        "place",
        "anything",
        "someone",
        "somebody",
        "around",
    ]
)


def _own_deed(words: Phrase, scene: Scene) -> ActionInfo | None:
    """The action of its own kind that does what is asked about."""
    match = Tasks(scene).own_match(words, weak=True, incomplete=True)
    return match.info if match is not None else None


def _joined(words: Phrase, flat: tuple[str, ...], size: int) -> tuple[Phrase, tuple[str, ...]]:
    """With "pick up things" for "pick things up", where that is one verb."""
    together = (lemma(flat[size]), flat[-1])
    found = lexicon().verbs.match(together) if len(flat) == size + 3 else None
    if found is None or found[0] != len(together):
        return words, flat
    return (*words[: size + 1], words[-1], words[size + 1]), (*flat[: size + 1], flat[-1], flat[size + 1])


def able(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "can you carry things?", "are you able to drive?": about abilities, not about doing it now."""
    size = next((len(start) for start in _ABLE if flat[: len(start)] == start), 0)
    if not size or size >= len(flat):
        return None
    words, flat = _joined(words, flat, size)
    base = (lemma(flat[size]), *flat[size + 1 :])
    found = lexicon().verbs.match(base)
    rest = flat[size + found[0] :] if found is not None else ()
    asks = flat[:size] not in {("can", "you"), ("could", "you")}
    if found is None:
        own = scene.catalogue.for_verb(base[0]) or _own_deed(words[size:], scene)
        unable = asks and own is None and len(base) > 1
        return Answer(cannot(plain((Word(base[0], base[0]), *words[size + 1 :])), scene)) if unable else None
    own = scene.catalogue.for_verb(base[0]) or _own_deed(words[size:], scene)
    if asks and found[1].startswith("other:") and own is None:
        return Answer(cannot(plain((Word(base[0], base[0]), *words[size + 1 :])), scene))
    several = len(rest) == 1 and singular(rest[0]) != rest[0] and rest[0] not in lexicon().vocabulary
    kinds = several and not asks
    indefinite = kinds or (
        asks and (not rest or rest[0] in {"a", "an", "any", "some"} or singular(rest[-1]) != rest[-1])
    )
    kind = found[1].partition(":")[0]
    lifts = asks and kind == "grasp" and scene.catalogue.with_role("fetch", "grasp") is None
    if any(singular(word) not in _GENERIC for word in rest) and not (indefinite or lifts):
        return None
    said = plain((Word(base[0], base[0]), *words[size + 1 :]))
    roles = {"whether": {"look"}, "transfer": {"fetch", "grasp", "ask_operator"}, "back": {"motion"}}.get(
        kind, {kind}
    )
    if (
        kind in {"transfer", "grasp", "place"}
        and scene.catalogue.with_role("fetch", "grasp") is None
        and own is None
    ):
        text = f"I cannot {said} by myself: somebody has to put things on me. {abilities(scene)}"
        return Answer(text)
    if kinds and kind == "motion" and own is None:
        return Answer(cannot(said, scene))
    if scene.catalogue.with_role(*sorted(roles)) is not None or scene.catalogue.for_verb(base[0]) is not None:
        return Answer(f"Yes, I can {said}. {abilities(scene)}")
    return None if kind in {"look", "search", "motion"} and not rest else Answer(cannot(said, scene))
