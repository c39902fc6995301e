"""Statements in words of their own about what is known: "A gave the box to B", "the desk gets new drawers".

What no pattern of `facts` reads is still a fact if it says something of a thing on the map, of what is
remembered, or of somebody by name.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import Fact, strip_openers
from parley.language.offline.facts.groups import read_group
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.finite import verb_at
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.text import Phrase, Word, keys, plain
from parley.language.word_lists import load_data

__all__ = ["laid_down", "read_declared", "read_rule"]

_GIVING = frozenset(
    {"gave", "sold", "lent", "handed", "passed", "transferred", "assigned", "given", "rented"}
)
_OWN = frozenset(
    {
        "i",
        "we",
        "you",
        "it",
        "this",
        "that",
        "they",
        "he",
        "she",
        "there",
        "who",
        "what",
        "nobody",
        "somebody",
        "someone",
        "something",
    }
)
_TELLING = frozenset(
    {
        "called",
        "asked",
        "said",
        "told",
        "phoned",
        "texted",
        "wrote",
        "rang",
        "complained",
        "reported",
        "mentioned",
        "thinks",
        "thought",
        "says",
        "hopes",
        "hoped",
        "came",
        "promised",
        "seems",
        "asks",
        "calls",
        "wants",
        "wanted",
        "made",
        "makes",
        "knows",
        "knew",
        "heard",
        "hurts",
        "loved",
        "did",
    }
)
_RULES = tuple(tuple(text.split()) for text in load_data("telling")["rules"])
_MOST_WORDS = 24


def read_declared(words: Phrase, scene: Scene) -> Fact | None:
    """The fact that a statement declares; None if it says nothing of what is known.

    Args:
        words: One clause.
        scene: What is known.
    """
    said = tuple(word for word in strip_openers(words, reporting=True) if word.is_word)
    flat = keys(said)
    if not 3 <= len(said) <= _MOST_WORDS or flat[0] in _OWN or opens_command(said):
        return None
    if flat[0] in lexicon().question_starts | lexicon().auxiliaries | lexicon().be or {"you", "please"} & set(
        flat
    ):
        return None
    at = verb_at(said)
    if flat[0] in {"smells", "sounds", "stinks", "looks", "seems", "feels"}:
        return None
    if flat[at] in _TELLING or {"whether", "if"} & set(flat):
        return None
    subject = bare(said[:at]) if at else ()
    if not subject or at >= len(said) - 1:
        return None
    known = _is_known(subject, scene)
    if not known and not mentioned(said[at:], scene):
        return None
    text = plain(said)
    sentence = text[:1].upper() + text[1:]
    goal = next((i for i in range(at + 2, len(flat) - 1) if flat[i] == "to"), 0)
    if flat[at] in _GIVING and goal:
        thing = bare(said[at + 1 : goal])
        return Fact(thing, relation="belongs", state=said[goal:], sentence=sentence)
    return Fact(subject, relation=flat[at], state=said[at + 1 :], sentence=sentence)


def read_rule(words: Phrase) -> Fact | None:
    """What is to hold from now on ("from now on the boxes go to A"); None if it is said as an order."""
    while words and not words[-1].is_word:
        words = words[:-1]
    flat = keys(words)
    lead = next((lead for lead in _RULES if flat[: len(lead)] == lead), ())
    rest = words[len(lead) :]
    while rest and not rest[0].is_word:
        rest = rest[1:]
    if (
        not lead
        or len(rest) < 3
        or opens_command(rest)
        or keys(rest)[0] in {"you", "please", "do", "if", "when"}
    ):
        return None
    text = plain(words)
    return Fact(
        bare(rest[: max(1, verb_at(rest))])[-3:],
        relation="rule",
        state=rest,
        sentence=text[:1].upper() + text[1:],
    )


def _is_known(subject: Phrase, scene: Scene) -> bool:
    if any(scene.is_person(part) and part[0].is_capital for part in coordinated(subject)):
        return True
    if scene.is_person(subject) and (subject[0].is_capital or len(subject) > 1):
        return True
    if scene.ground(subject).outcome == "match" and set(keys(subject)) - lexicon().vocabulary:
        return True
    return bool(mentioned(subject, scene)) or any(
        keys(item.fact.subject) == keys(subject) for item in scene.facts
    )


_OPENING = frozenset(
    {"open", "close", "start", "finish", "meet", "eat", "ship", "deliver", "lock", "begin", "end"}
)
_TIMES = frozenset({"at", "on", "from", "until", "every", "after", "before", "daily", "around"})
_HABIT = frozenset(
    {
        "after",
        "before",
        "every",
        "until",
        "till",
        "always",
        "usually",
        "daily",
        "during",
        "between",
        "from",
        "since",
    }
)


def _habit(words: Phrase, scene: Scene) -> Fact | None:
    """For "A naps in the chair after lunch": what somebody does again and again, told without any order."""
    said = tuple(word for word in strip_openers(words, reporting=True) if word.is_word)
    at = verb_at(said)
    flat = keys(said)
    if flat[:1] == ("we",) and flat[1:2] and flat[1] in _OPENING and _TIMES & set(flat[2:]):
        text = plain(said[1:])
        return Fact(
            (Word("operator", "operator"),), relation=flat[1], state=said[2:], sentence=f"They {text}"
        )
    if not at and len(flat) > 3 and flat[1].endswith("s") and scene.is_person(said[:1]):
        at = 1
    third = at and flat[at].endswith("s") and flat[at] not in lexicon().be | {"has", "was", "does"}
    if (
        not third
        or not _HABIT & set(flat[at:])
        or {"and", "then", "if", "when"} & set(flat)
        or len(said) > 14
    ):
        return None
    if not scene.is_person(bare(said[:at])) or flat[0] in _OWN:
        return None
    text = plain(said)
    return Fact(
        bare(said[:at]), relation=flat[at], state=said[at + 1 :], sentence=text[:1].upper() + text[1:]
    )


def laid_down(words: Phrase, scene: Scene) -> tuple[tuple[Fact, ...], Phrase]:
    """What whole sentences of a message list or lay down for later, and the message without them.

    Args:
        words: All words and punctuation.
        scene: What is known.
    """
    left: list[Word] = []
    found: list[Fact] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in {".", "!", "?", ";", "\n"}:
            continue
        mark = words[index : index + 1]
        sentence = words[start:index]
        fact = (
            None
            if keys(mark) == ("?",)
            else read_group(sentence) or read_rule(sentence) or _habit(sentence, scene)
        )
        if fact is None:
            left += (*sentence, *mark)
        else:
            found.append(fact)
        start = index + 1
    return tuple(found), tuple(left)
