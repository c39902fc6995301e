"""Sentences of people's own in a message: alone, or one after the other with orders that are understood."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from parley.gate.cards import labels_of
from parley.language.base import Situation
from parley.language.builtin.decision import Answer, Ask, Decision, Deed, Do
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reply import to_chat
from parley.language.builtin.skills import Skill
from parley.language.builtin.tokens import Token, tokenize
from parley.language.dialogue.teaching import Taught, key, meant, named, problem_of, taught_in

__all__ = ["own_words"]

Decider = Callable[[Situation], Decision]

_JOINING = frozenset({"and", "then", ",", ";", ".", "first", "please", "next", "afterwards"})


def own_words(situation: Situation, lexicon: Lexicon, decide: Decider) -> Decision | None:
    """What comes of the sentences of somebody's own in a message; None if there are none."""
    whole = meant(situation)
    if whole is not None:
        return _meaning(whole, situation, lexicon, decide)
    tokens = tokenize(situation.message)
    low = [token.low for token in tokens]
    logic = {word for name, words in lexicon.classes.items() if name.startswith("link_") for word in words}
    if {*low} & (logic | lexicon.classes["logic"]) - _JOINING:
        return None
    for one in taught_in(situation.memory):
        at = _place(low, one.words.split())
        if at is not None and (one.action or not named(one.means, situation.objects)):
            behind = at + len(one.words.split())
            return _joined(one, (tokens[:at], tokens[behind:]), situation, lexicon, decide)
    return None


def _place(low: Sequence[str], words: Sequence[str]) -> int | None:
    """Where words stand by themselves between what joins orders."""
    size = len(words)
    for at in range(len(low) - size + 1):
        before, behind = low[:at], low[at + size :]
        if low[at : at + size] == list(words) and {*before[-1:], *behind[:1]} <= _JOINING:
            return at
    return None


def _joined(
    one: Taught, around: tuple[Sequence[Token], Sequence[Token]], situation: Situation, lexicon: Lexicon,
    decide: Decider,
) -> Decision:  # fmt: skip
    """What comes before, the meaning, and what comes behind, if all of it is certain."""
    made: list[Do] = []
    for text in (_text(around[0], situation), one, _text(around[1], situation)):
        if isinstance(text, Taught):
            found = _meaning(text, situation, lexicon, decide)
        elif text:
            found = decide(replace(situation, message=text))
        else:
            continue
        if not isinstance(found, Do):
            return Ask(f"I am not certain of all of that. Please say “{one.words}” alone.")
        made.append(found)
    return Do(
        tuple(deed for do in made for deed in do.deeds),
        tuple(note for do in made for note in do.notes),
        tuple(fact for do in made for fact in do.told),
        made[0].robots,
    )


def _text(tokens: Sequence[Token], situation: Situation) -> str:
    """What words say without what joins them to others."""
    kept = list(tokens)
    while kept and kept[-1].low in _JOINING:
        kept.pop()
    while kept and kept[0].low in _JOINING:
        kept.pop(0)
    return situation.message[kept[0].start : kept[-1].end] if kept else ""


def _meaning(one: Taught, situation: Situation, lexicon: Lexicon, decide: Decider) -> Decision:
    """What comes of a sentence of somebody's own: what comes of its meaning."""
    told = f"You taught me that “{one.words}” means “{one.meaning}”."
    rest = tuple(entry for entry in situation.memory if key(entry.taught) != one.words)
    without = decide(replace(situation, message=one.words, memory=rest))
    if not isinstance(without, Ask | Answer):
        return without  # what is understood anyway keeps its meaning, whoever wrote something else down
    if not one.action:
        made = decide(replace(situation, message=one.means, memory=rest))
        return replace(made, question=f"{told} {made.question}") if isinstance(made, Ask) else made
    if (problem := problem_of(one, situation.catalogue)) is not None:
        return Ask(f"{told} {problem}")
    info = next(info for info in situation.catalogue if info.name == one.action)
    bare = Deed("DO", Skill(info, "DO", {}), one.arguments, {})
    (label,) = labels_of(to_chat(Do((bare,)), lexicon).queue, situation.catalogue)
    return Do((replace(bare, text=f"{label[:1].lower()}{label[1:]}"),))
