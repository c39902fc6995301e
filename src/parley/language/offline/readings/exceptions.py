"""What nothing tells: "all rooms but the one with the piano", "the two rooms" of three.

What is to be left out must not be done, nor what may not be meant: who does not know what that is asks.
"""

from __future__ import annotations

from typing import Final

from parley.language.offline.readings.judging import gone_to
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.group_words import exception_at
from parley.language.offline.scene.grouping import grouped
from parley.language.offline.scene.marks import by_ids, marks_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import coordinated
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.messages.chat import ChatAction

__all__ = ["unknown_exception", "which_of_those", "with_answer"]

_ALL: Final = frozenset({"all", "every", "each", "any", "both", "everything", "everywhere"})
_ONES: Final = frozenset({"one", "ones"})


def unknown_exception(words: Phrase) -> tuple[int, int] | None:
    """Where an exception stands that is still a description, once all that is known has been named.

    Args:
        words: All words and punctuation, groups put together.
    """
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        start = at + exception_at(flat, at)
        if start == at or flat[at] == "," or not _ALL & set(flat[:at]):
            continue
        if flat[start : start + 1] == ("the",) and flat[start + 1 : start + 2] and flat[start + 1] in _ONES:
            end = next((i for i in range(start + 2, len(flat)) if not words[i].is_word), len(flat))
            if end > start + 3 or (end > start + 2 and flat[start + 2] not in lexicon().be):
                return start, end
    return None


def which_of_those(action: ChatAction, scene: Scene) -> ChatAction | None:
    """A question where a plan goes to some of "the two rooms" of three; None if it need not be asked."""
    several = scene.uncounted
    if several is None or scene.situation.queue or scene.hints:
        return None
    choices = [describe(item, scene.objects) for item in several.items]
    if not gone_to(action, scene) & {item.id for item in several.items}:
        return None
    known = f"I know {len(choices)} of those: {listing([the(one) for one in choices])}."
    text = f"{known} Which do you mean by “{plain(several.words)}”?"
    return ChatAction(message_response=text, targets=action.targets, choices=tuple(choices))


def with_answer(words: Phrase, hints: list[str], scene: Scene) -> Phrase:
    """The words with the answers to questions about them in the place of what was asked about.

    That is an exception that nothing tells, or a kind of thing of which the answer means some ("all but A").
    """
    place = unknown_exception(words)
    answer = next((tokens(hint) for hint in hints if scene.ground(tokens(hint)).outcome == "match"), ())
    if place is not None and answer:
        return (*words[: place[0]], *answer, *words[place[1] :])
    counted = _told_later(words, hints, scene) if hints else words
    if counted != words:
        return counted
    for hint in hints:
        said = tokens(hint)
        if exception_at(keys(said), 0) and (kind := _kind_of(words, set(), scene)) is not None:
            said = (*words[kind[0] : kind[1]], *said)
        several: Phrase = next(((word,) for word in grouped(said, scene) if marks_of(word)), ())
        meant = set(marks_of(several[0])) if several else set()
        if not several:
            several, meant = tokens(hint), set(_listed(tokens(hint), scene))
        span = _kind_of(words, meant, scene) if meant else None
        if span is not None:
            return (*words[: span[0]], *several, *words[span[1] :])
    return words


def _told_later(words: Phrase, hints: list[str], scene: Scene) -> Phrase:
    """The words with those that an answer names in the place of "the two rooms" of three."""
    grouped(words, scene)
    several, flat = scene.uncounted, keys(words)
    if several is None:
        return words
    asked = keys(several.words)
    at = next((i for i in range(len(flat)) if flat[i : i + len(asked)] == asked), -1)
    for said in map(tokens, hints) if at >= 0 else ():
        for named in (said, (*several.words[-1:], *said), (*said[:1], *several.words[-1:])):
            listed = _listed(named, scene)
            group = (by_ids(listed, plain(named)),) if listed else grouped(named, scene)
            if len(group) == 1 and marks_of(group[0]):
                scene.uncounted = None
                return (*words[:at], *group, *words[at + len(asked) :])
    return words


def _listed(words: Phrase, scene: Scene) -> list[str]:
    """The things that "A, B and C" are; empty if that is no such list."""
    found = [scene.ground(part) for part in coordinated(words)]
    whole = len(found) > 1 and all(one.outcome == "match" for one in found)
    return [one.candidates[0].id for one in found] if whole else []


def _kind_of(words: Phrase, meant: set[str], scene: Scene) -> tuple[int, int] | None:
    """Where words name a kind of thing that all of these belong to."""
    for start in range(len(words)):
        for end in range(min(len(words), start + _LONGEST_KIND), start, -1):
            if not words[end - 1].is_word or (start and not words[start].is_word):
                continue
            found = scene.ground(words[start:end])
            if found.outcome == "ambiguous" and meant <= {item.id for item in found.candidates}:
                return start, end
    return None


_LONGEST_KIND = 5
