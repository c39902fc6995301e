"""Questions about where things are to one another, how far, and about anything that was told."""

from __future__ import annotations

import math
from dataclasses import dataclass

from parley.language.offline.dialogue.own_state import told_about
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import NounPhrase, bare, noun_phrase
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular

__all__ = ["Answer", "attribute", "how_far", "known_there", "near", "told", "which"]


@dataclass(frozen=True, slots=True)
class Answer:
    """What is said; `look` are the words of a yes-or-no question that only looking can answer."""

    text: str
    look: Phrase = ()
    counts: bool = False
    """Whether `look` names what is to be counted instead."""
    at: Phrase = ()
    """Where it is to be seen, if that is known."""
    now: bool = False
    """Whether it is looked at at once, because it is about how things are now; else looking is offered."""


_COMPARING = frozenset({"closest", "nearest", "farthest", "furthest", "nearer", "closer", "next"})


def which(words: Phrase, flat: tuple[str, ...], scene: Scene, _: bool) -> Answer | None:
    """For "which box is nearest to the door?", "what is next to the door?"."""
    if flat[0] not in {"which", "what"}:
        return None
    link = next((i for i in range(1, len(flat)) if flat[i] in lexicon().be), 0)
    if not link or link + 2 >= len(flat) or flat[link + 1] not in _COMPARING:
        return None
    kind = words[1:link]
    if kind:
        found = ground_phrase((*kind, *words[link + 1 :]), scene.objects, scene.situation.robot_pose)
    else:
        found = ground_phrase(words[link + 1 :], scene.objects, scene.situation.robot_pose)
        place = lexicon().places.match(flat, link + 1)
        anchor = found.candidates[0] if found.outcome == "match" else None
        if place is None or anchor is None:
            return None
        others = sorted(
            (item for item in scene.objects if item is not anchor),
            key=lambda item: math.hypot(item.x_m - anchor.x_m, item.y_m - anchor.y_m),
        )
        if not others:
            return None
        return Answer(f"Nearest to it on my map is {the(describe(others[0], scene.objects))}.")
    if found.outcome == "none":
        return None
    names = listing([the(describe(item, scene.objects)) for item in found.candidates], "or")
    return Answer(f"It is {names}.")


def known_there(subject: Phrase, place: Phrase, there: bool, scene: Scene) -> Answer | None:
    """What is remembered of whether something is somewhere.

    Args:
        subject: What it is asked of.
        place: Where; empty if that is not said.
        there: Whether it is asked if there is any ("is there ink in the machine?").
        scene: What is known.
    """
    fact, _ = find_fact(subject, scene.facts) if subject and (there or place) else (None, [])
    wanted = set(noun_phrase(place).core) if place else set()
    same = fact is not None and (not place or wanted <= set(noun_phrase(fact.fact.place).core))
    if fact is not None and place and not same:
        # That some of it is elsewhere says nothing of this place.
        here = there and ground_phrase(place, scene.objects).outcome == "match"
        fact = None if here or not fact.fact.is_location else fact
    if fact is not None:
        scene.use(fact)
        return Answer(("Yes: " if same else "As far as I know, no: ") + whole_sentence(fact.fact.sentence))
    denied = next((f for f in scene.facts if f.fact.negated and keys(f.fact.subject) == keys(subject)), None)
    if denied is not None and place and wanted <= set(noun_phrase(denied.fact.place).core):
        scene.use(denied)
        return Answer(f"As far as I know, no: {whole_sentence(denied.fact.sentence)}")
    return None


def near(subject: Phrase, noun: NounPhrase, scene: Scene) -> Answer | None:
    """For "is the box next to the door?", where both are on the map.

    Args:
        subject: What it is asked of.
        noun: The question's noun phrase, with what is beside it.
        scene: What is known.
    """
    if noun.relation not in _NEAR or not subject:
        return None
    ends = [ground_phrase(part, scene.objects, strict=True) for part in (subject, noun.anchors[0])]
    if any(end.outcome != "match" for end in ends):
        return None
    first, second = (end.candidates[0] for end in ends)
    away_m = math.hypot(first.x_m - second.x_m, first.y_m - second.y_m)
    names = [the(describe(item, scene.objects)) for item in (first, second)]
    return Answer(f"On my map {names[0]} is about {away_m:.1f} m from {names[1]}.")


_NEAR = frozenset({"next to", "near", "beside", "close to", "by", "nearby", "near to", "alongside"})


def how_far(words: Phrase, flat: tuple[str, ...], scene: Scene, _: bool) -> Answer | None:
    """For "how far (away) is the box?", as the crow flies."""
    pose = scene.situation.robot_pose
    if flat[:2] != ("how", "far") or pose is None:
        return None
    rest = words[2:]
    while len(rest) > 1 and rest[0].key in lexicon().be | {"away", "it", "to", "from", "here", "off"}:
        rest = rest[1:]
    found = ground_phrase(rest, scene.objects, pose)
    if found.outcome != "match":
        return None
    item = found.candidates[0]
    away_m = math.hypot(item.x_m - pose.x_m, item.y_m - pose.y_m)
    return Answer(f"{the(describe(item, scene.objects)).capitalize()} is about {away_m:.1f} m from here.")


def told(words: Phrase, flat: tuple[str, ...], scene: Scene, asked: bool) -> Answer | None:
    """For "what does A like?", "when does B open?", "do you know A?": what was told about it."""
    if flat[:3] == ("do", "you", "know") and len(flat) < 7:
        known = told_about(bare(words[3:]), scene)
        for item in known:
            scene.use(item)
        said = " ".join(whole_sentence(item.fact.sentence) for item in known)
        return Answer(said) if known else None
    if not asked or flat[0] not in lexicon().question_starts:
        return None
    text = f" {' '.join(flat)} "
    about = {singular(lemma(word)) for word in flat if word not in lexicon().auxiliaries | lexicon().be}
    for item in scene.facts:
        subject = keys(item.fact.subject)
        if not subject or f" {' '.join(subject)} " not in text:
            continue
        content = {singular(lemma(word.key)) for word in (*item.fact.state, *item.fact.place)}
        content.add(singular(lemma(item.fact.relation)))
        if (about - set(subject)) & content - lexicon().determiners:
            scene.use(item)
            return Answer(whole_sentence(item.fact.sentence or plain(item.fact.subject)))
    return None


def attribute(words: Phrase, flat: tuple[str, ...], scene: Scene, asked: bool) -> Answer | None:
    """For "what colour is the dock?", "does A like tea?": what is remembered of it."""
    if flat[0] in {"does", "did", "has"}:
        start = 1
    elif (
        flat[0] in {"what", "which"} and len(flat) > 3 and flat[1] not in lexicon().be | lexicon().auxiliaries
    ):
        start = next((i + 1 for i in range(2, min(5, len(flat))) if flat[i] in _LINKS), 0)
    else:
        return None
    for end in range(len(words), start, -1) if start else ():
        about = bare(words[start:end])
        known, _ = find_fact(about, scene.facts, locations=False) if about else (None, [])
        if known is None or known.fact.is_location or set(keys(known.fact.subject)) - set(keys(about)):
            continue
        told = {lemma(word) for word in (*keys(known.fact.state), known.fact.relation)}
        wanted = {lemma(word) for word in flat[end:]} - {"have", "be"}
        if flat[0] in {"does", "did", "has"} and not wanted & told:
            return None
        scene.use(known)
        fitting = wanted <= told
        lead = (
            "" if flat[0] in {"what", "which"} or not fitting else "No: " if known.fact.negated else "Yes: "
        )
        return Answer(lead + whole_sentence(known.fact.sentence))
    return None


_LINKS = lexicon().be | {"does", "do", "did", "has", "have"}
