"""Questions about what was told before: what somebody likes, what was taught, where something was."""

from __future__ import annotations

from parley.language.offline.dialogue.about_map import Answer
from parley.language.offline.facts.facts import TASTES, read_statement
from parley.language.offline.facts.protocols import read_protocol
from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the, whole_sentence
from parley.language.offline.words.text import Phrase, keys, plain, singular, tokens

__all__ = ["own_taste", "taught", "where_before"]

_HAVING = frozenset({"to", "drink", "eat", "have", "most", "best"})
_REFUSING = frozenset({"hate", "dislike"})
_TEACHING = frozenset({"teach", "taught", "rule", "rules", "instructed"})
_AROUND_TEACHING = frozenset({
    "what", "which", "did", "do", "i", "we", "you", "have", "has", "all", "everything", "tell",
    "me", "list", "show", "the", "your", "know", "so", "far", "are", "there", "that", "repeat",
    "give", "of", "been", "to", "already", "any", "things", "remember", "my", "us", "were",
    "learned", "learnt", "told", "and", "ever", "again", "please", "now",
})  # fmt: skip
_OPENING = {"the"} | frozenset(
    {"what", "which", "tell", "list", "show", "repeat", "give", "are", "do", "all", "did", "have"}
)
_EARLIER = frozenset({"before", "earlier", "previously", "formerly", "originally", "first", "last"})


def own_taste(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what do I like?", "do I like tea?".

    Args:
        words: The words of the question.
        flat: The same, as they are compared.
        scene: What is known.
    """
    plain_one = flat[:3] == ("what", "do", "i") and flat[3:4] != () and flat[3] in TASTES
    known_one = flat[-3:-1] == ("what", "i") and flat[-1] in TASTES and flat[:1] in {("do",), ("what",)}
    open_one = (plain_one and set(flat[4:]) <= _HAVING) or known_one
    closed = flat[:2] == ("do", "i") and len(flat) > 3 and flat[2] in TASTES
    if not open_one and not closed:
        return None
    told = [f for f in scene.facts if f.fact.relation in TASTES and keys(f.fact.subject) == ("operator",)]
    if closed:
        about = {singular(key) for key in keys(bare(words[3:]))}
        told = [item for item in told if about & {singular(key) for key in keys(item.fact.state)}]
    else:
        denied = flat[-1 if known_one else 3] in _REFUSING
        told = [f for f in told if (f.fact.negated or f.fact.relation in _REFUSING) == denied]
    for item in told:
        scene.use(item)
    said = [whole_sentence(f"you {item.fact.sentence[2:]}") for item in reversed(told)]
    return Answer(" ".join(said) or "I do not know that. Tell me, and I will remember it.")


def taught(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "what did I teach you?", "which rules do you know?": the rules, and else all that was told.

    Args:
        words: The words of the question.
        flat: The same, as they are compared.
        scene: What is known.
    """
    said = set(flat)
    if not _TEACHING & said or not said <= _TEACHING | _AROUND_TEACHING or flat[0] not in _OPENING:
        return None
    entries = [entry for entry in scene.situation.memory if entry.type == "text"]
    rules = [entry for entry in entries if read_protocol(entry.data, kept=True) is not None]
    kept = rules or ([] if {"rule", "rules"} & said else entries)
    if not kept:
        return Answer("You have not taught me anything yet.")
    return Answer("You told me: " + " ".join(whole_sentence(entry.data[:200]) for entry in kept[-20:]))


def where_before(words: Phrase, flat: tuple[str, ...], scene: Scene) -> Answer | None:
    """For "where was the key before?", "where did the key use to be?": the older facts, the latest first.

    Args:
        words: The words of the question.
        flat: The same, as they are compared.
        scene: What is known.
    """
    used = flat[:2] == ("where", "did") and flat[-2:] == ("to", "be")
    earlier = (
        flat[:1] == ("where",) and bool(_EARLIER & set(flat[2:])) and bool({"was", "were"} & set(flat[:3]))
    )
    if not used and not earlier:
        return None
    ends = _EARLIER | lexicon().be | {"use", "used", "to", "?", "that", "then", "kept", "stored"}
    about = words[2:]
    while about and about[-1].key in ends:
        about = about[:-1]
    about = bare(about)
    fact, several = find_fact(scene.referent(about), scene.facts) if about else (None, [])
    if fact is None or several:
        return None
    subject = _single(fact.fact.subject)
    older = [
        f.fact.sentence for f in scene.facts if f.fact.is_location and _single(f.fact.subject) == subject
    ]
    for turn in reversed(scene.situation.history):
        told = read_statement(tokens(turn.content)) if turn.role == "operator" else None
        if told is not None and told.is_location and _single(told.subject) == subject:
            older.append(told.sentence)
    left = [text for text in dict.fromkeys(older) if text != fact.fact.sentence]
    scene.use(fact)
    now = whole_sentence(fact.fact.sentence)
    if not left:
        return Answer(f"I only know where {the(plain(about))} is now: {now}")
    return Answer(f"You told me before: {whole_sentence(left[0])} Now I know: {now}")


def _single(phrase: Phrase) -> tuple[str, ...]:
    return tuple(singular(key) for key in keys(phrase))
