"""Indirect requests: what somebody wants or needs ("I would like some tea", "he is cold")."""

from __future__ import annotations

from dataclasses import replace

from parley.language.offline.facts.facts import read_statement
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.needs import as_reported
from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["need", "wish"]


def wish(words: Phrase, scene: Scene) -> Command | None:
    """For "I would like some tea", "he needs the cup": something is to be brought."""
    found = lexicon().wants.match(keys(words))
    if found is not None and found[0] < len(words):
        theme = words[found[0] :]
        if keys(theme)[0] == "you" and lexicon().places.match(keys(theme), 1):
            return read_command((Word("go", "go"), Word("to", "to"), *theme[1:]), scene.is_person)
        if keys(theme)[:2] in {("to", "see"), ("to", "know"), ("to", "look"), ("to", "check")}:
            return read_command(theme[1:], scene.is_person)
        if keys(theme)[0] in {"to", "you"} or _to_do(theme):
            return None
        command = read_command((Word("bring", "bring"), Word("me", "me"), *theme), scene.is_person)
        noun = noun_phrase(theme)
        if (
            command is not None
            and noun.core
            and len(noun.anchors) == 1
            and noun.relation in {"at", "in", "by", "near"}
        ):
            size = next(
                i
                for i in range(len(theme))
                if keys(theme[i:])[: len(noun.relation.split())] == tuple(noun.relation.split())
            )
            if find_fact(bare(theme[:size]), scene.facts)[0] is not None:
                return replace(command, theme=bare(theme[:size]), place=noun.anchors[0], recipient=())
        return command
    return None


def _to_do(theme: Phrase) -> bool:
    """For "everything to look nice": how things should be, nothing to be brought."""
    flat = keys(theme)
    at = flat.index("to") if "to" in flat[1:-1] else 0
    return bool(at) and lexicon().verbs.match(flat, at + 1) is not None and flat[:at] not in _SOMETHING


_SOMETHING = frozenset({("something",), ("anything",)})


def need(words: Phrase, scene: Scene) -> Command | None:
    """For "X is cold" and the like: what helps is to be brought to X, unless the message says what."""
    words = as_reported(words, scene)
    flat = keys(words)
    state = next((w for w in flat[2:] if w in lexicon().needs), None)
    link = next(
        (
            i
            for i in range(1, len(flat))
            if flat[i] in lexicon().be | {"feels", "looks", "feel", "seems", "gets"}
        ),
        0,
    )
    if state is None or not link or "not" in flat:
        return None
    told = read_statement(words)
    if told is not None and told.is_location:
        # "He is in the sick bay" says where.
        return None
    who = bare(words[:link])
    if not scene.is_person(who):
        return None
    scene.mention(who)
    return Command(
        "need", state, theme=tokens(lexicon().needs[state]), recipient=who, words=words, clause=words
    )
