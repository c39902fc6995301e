"""More sentences out of those that were written: slots filled, things exchanged, as spoken, with noise."""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from parley.language.builtin.labels import Act
from parley_train.markup import Annotated, RoleSpan, Trigger, read_line

__all__ = ["exchanged", "fill", "joined", "vary"]

_SLOT = re.compile(r"(\*?)\[(\w+)\]")
_CHOICE = re.compile(r"<<([^<>]*)>>")

_BEFORE = (
    "please", "can you", "could you", "can you please", "could you please", "would you", "would you please",
    "robot", "robot please", "robot can you", "okay", "ok", "okay now", "uh", "um", "uhh", "hm", "and",
    "and then",
    "now", "then", "okay and", "so", "I want you to", "I would like you to", "I need you to", "go ahead and",
    "let's", "you should", "alright", "right", "hey", "next", "please could you", "will you", "you need to",
)  # fmt: skip
_BEHIND = ("please", "now", "for me", "would you", "thanks", "if you can", "okay", "right away", "thank you")
_FILLERS = ("uh", "um", "uhm", "like", "er")
_BETWEEN = (".", ".", ",", "and", "then", "and then", ", then", "so", "uh", "")
_LONGEST = 40


def fill(template: str, words: Mapping[str, Sequence[str]], chance: random.Random) -> str:
    """A line of markup with its slots filled; `*[box]` puts the head where the words have it, else last."""

    def chosen(match: re.Match[str]) -> str:
        text = chance.choice(words[match[2]])
        if not match[1]:
            before = match.string[: match.start()]
            return text if before.count("(") > before.count(")") else text.replace("*", "")
        if "*" in text:
            return text
        before, _, last = text.rpartition(" ")
        return f"{before} *{last}" if before else f"*{last}"

    template = _CHOICE.sub(lambda match: chance.choice(match[1].split("|")), template)
    return re.sub(r" +", " ", _SLOT.sub(chosen, template))


def vary(sentences: Iterable[Annotated], chance: random.Random, exchange: float) -> list[Annotated]:
    """Each sentence once, with things exchanged among them, openings, fillers, as written or as spoken."""
    given = list(sentences)
    pool = [
        given[number].words[span.start : span.end]
        for number in range(len(given))
        for span in given[number].roles
        if span.role == "T" and span.end - span.start < 5 and span.head == span.end - 1
    ]
    return [_varied(sentence, pool, chance, exchange) for sentence in given]


def exchanged(sentences: Sequence[Annotated], chance: random.Random, share: float) -> list[Annotated]:
    """Each sentence once, some roles filled as the same are elsewhere, if they begin with the same word."""
    pool: dict[tuple[str, str], list[tuple[tuple[str, ...], int]]] = {}
    for sentence in sentences:
        for span in sentence.roles:
            words = sentence.words[span.start : span.end]
            if _apart(sentence, span):
                pool.setdefault((span.role, words[0].lower()), []).append((words, span.head - span.start))
    found = []
    for sentence in sentences:
        for number in range(len(sentence.roles)):
            span = sentence.roles[number]
            if _apart(sentence, span) and chance.random() < share:
                words, head = chance.choice(pool[span.role, sentence.words[span.start].lower()])
                sentence = _spliced(sentence, span.start, span.end, words, "")
                roles = list(sentence.roles)
                roles[number] = replace(roles[number], head=roles[number].start + head)
                sentence = replace(sentence, roles=tuple(roles))
        found.append(sentence)
    return found


def _apart(sentence: Annotated, span: RoleSpan) -> bool:
    """Whether a role of several words has no other part of the sentence inside."""
    inside = [trigger.start for trigger in sentence.triggers]
    inside += [other.start for other in sentence.roles if other is not span]
    alone = not any(span.start <= start < span.end for start in inside)
    return alone and span.role not in "TXY" and span.end - span.start > 1


def joined(sentences: Sequence[Annotated], chance: random.Random, share: float) -> list[Annotated]:
    """Each sentence once, some with another one behind, as one message."""
    others = list(sentences)
    chance.shuffle(others)
    return [
        _joined(one, other, chance.choice(_BETWEEN).split())
        if chance.random() < share and len(one.words) + len(other.words) < _LONGEST
        else one
        for one, other in zip(sentences, others, strict=True)
    ]


def _joined(one: Annotated, other: Annotated, between: Sequence[str]) -> Annotated:
    """Two sentences with words between, which belong to the second."""
    if one.words[-1] in ".!?":
        between = ()
    more, owners = len(one.words) + len(between), len(one.triggers)
    triggers = [
        Trigger(
            t.frame, t.start + more, t.end + more, t.mode, tuple(place + more for place in t.particles)
        )
        for t in other.triggers
    ]  # fmt: skip
    roles = [
        RoleSpan(
            r.role, r.start + more, r.end + more, r.head + more, None if r.owner is None else r.owner + owners
        )
        for r in other.roles
    ]  # fmt: skip
    return Annotated(
        (*one.words, *between, *other.words),
        (*one.acts, *(other.acts[:1] * len(between)), *other.acts),
        (*one.moves, *(other.moves[:1] * len(between)), *other.moves),
        (*one.triggers, *triggers),
        (*one.roles, *roles),
    )


def _varied(
    sentence: Annotated, pool: Sequence[tuple[str, ...]], chance: random.Random, exchange: float
) -> Annotated:
    for number in range(len(sentence.roles)):
        span = sentence.roles[number]  # where it stands now: what was exchanged before it may be longer
        deeds = any(span.start <= trigger.start < span.end for trigger in sentence.triggers)
        fits = span.role == "T" and span.head == span.end - 1 and span.end - span.start > 1 and not deeds
        if fits and chance.random() < exchange:
            sentence = _spliced(sentence, span.start, span.end, chance.choice(pool), "")
            grown = sentence.roles[number]
            roles = list(sentence.roles)
            roles[number] = replace(grown, head=grown.end - 1)
            sentence = replace(sentence, roles=tuple(roles))
    order = sentence.acts[0] == "order" and bool(sentence.triggers)
    bare = order and sentence.triggers[0].start == 0 and sentence.triggers[0].mode == "plain"
    if bare and chance.random() < 0.4:
        sentence = _spliced(sentence, 0, 0, tuple(chance.choice(_BEFORE).split()), "order")
    if order and chance.random() < 0.12:
        end = len(sentence.words) - (sentence.words[-1] in ".!?")
        said = any(span.role in ("X", "K") and span.end >= end for span in sentence.roles)
        if not said:
            sentence = _spliced(sentence, end, end, tuple(chance.choice(_BEHIND).split()), "order")
    if chance.random() < 0.08:
        at = chance.randrange(len(sentence.words) + 1)
        sentence = _spliced(sentence, at, at, (chance.choice(_FILLERS),), "")
    if chance.random() < 0.08:
        sentence = _mistyped(sentence, chance)
    return _spoken(sentence) if chance.random() < 0.5 else sentence


def _mistyped(sentence: Annotated, chance: random.Random) -> Annotated:
    """With two letters of a longer word exchanged, or one left out."""
    longer = [number for number, word in enumerate(sentence.words) if len(word) > 4 and word.isalpha()]
    if not longer:
        return sentence
    number = chance.choice(longer)
    word = sentence.words[number]
    at = chance.randrange(1, len(word) - 1)
    behind = word[at + 1] + word[at] + word[at + 2 :] if chance.random() < 0.5 else word[at + 1 :]
    words = (*sentence.words[:number], word[:at] + behind, *sentence.words[number + 1 :])
    return replace(sentence, words=words)


def _spoken(sentence: Annotated) -> Annotated:
    """In small letters, without marks."""
    for number in range(len(sentence.words) - 1, -1, -1):
        if sentence.words[number] in ".,!?;:-" and len(sentence.words) > 1:
            sentence = _spliced(sentence, number, number + 1, (), "")
    return replace(sentence, words=tuple(word.lower() for word in sentence.words))


def _spliced(sentence: Annotated, start: int, end: int, words: Sequence[str], act: Act | str) -> Annotated:
    """With other words from `start` to `end`; what stands behind moves, what is around grows."""
    more = len(words) - (end - start)

    def begin(place: int) -> int:
        return place + more if place >= end and (place > start or start == end) else place

    def finish(place: int) -> int:
        return place + more if place >= end and place > start else place

    neighbour = sentence.acts[min(start, len(sentence.acts) - 1)]
    acts = (*sentence.acts[:start], *((neighbour,) * len(words)), *sentence.acts[end:])
    moved = sentence.moves[min(start, len(sentence.moves) - 1)]
    moves = (*sentence.moves[:start], *((moved,) * len(words)), *sentence.moves[end:])
    triggers = tuple(
        Trigger(
            one.frame, begin(one.start), finish(one.end), one.mode,
            tuple(begin(place) for place in one.particles),
        )
        for one in sentence.triggers
    )  # fmt: skip
    roles = tuple(
        RoleSpan(one.role, begin(one.start), finish(one.end), begin(one.head), one.owner)
        for one in sentence.roles
    )
    return Annotated((*sentence.words[:start], *words, *sentence.words[end:]), acts, moves, triggers, roles)


def filled(
    templates: Iterable[str], words: Mapping[str, Sequence[str]], chance: random.Random, times: int
) -> list[Annotated]:
    """Sentences from templates, each filled so many times."""
    return [read_line(fill(template, words, chance)) for template in templates for _ in range(times)]
