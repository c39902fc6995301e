"""Whether words can be what an action is about: a thing, somebody, a place, or what can be so or not.

"The window in the hall" can be looked at, "they are expecting you" or "somebody" cannot be a place.
"""

from __future__ import annotations

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, lemma

__all__ = ["is_request", "names_something"]

_LONGEST_NAME = 12
_LONGEST_STATE = 18
_NO_NAMES = frozenset({
    "i", "we", "you", "he", "she", "they", "who", "whom", "why", "how", "when", "what", "which", "whether",
    "if", "because", "and", "or", "but", "so", "then", "to", "be", "been", "is", "are", "was", "were", "am",
    "not", "never", "do", "does", "did", "will", "would", "can", "could", "should", "must", "may", "might",
    "have", "has", "had", "please", "just", "also", "too", "only", "maybe", "perhaps", "yes", "no", "ok",
    "really", "again", "soon", "than", "though", "although", "since", "until", "unless", "let", "well",
    "anyway", "instead", "while", "go", "ready", "off", "somebody", "someone", "everybody", "everyone",
    "nobody", "else", "otherwise", "it", "after", "before", "once", "of", "there", "sorry", "wait",
    "actually", "neither", "none", "nor", "either", "properly",
})  # fmt: skip
_PERSONS_AT_LARGE = frozenset({"somebody", "someone", "everybody", "everyone", "nobody", "anybody", "anyone"})
_NO_ENDS = frozenset({
    "the", "a", "an", "my", "your", "his", "their", "our", "to", "of", "and", "or", "but", "with", "from",
    "for", "is", "are", "was", "were", "i", "we", "you", "he", "she", "they", "if", "because", "so", "then",
    "please", "first", "second", "third", "next", "finally", "also", "way", "very", "who", "which", "when",
    "how", "than",
})  # fmt: skip
_FINITE = frozenset({
    "is", "are", "was", "were", "am", "will", "would", "could", "should", "must", "may", "might", "has",
    "does", "did", "do", "can", "had",
})  # fmt: skip
_RELATIVE = frozenset({"that", "which", "who", "whose", "where", "whatever", "whether", "how", "if"})
_SPEAKERS = frozenset({"i", "we", "you"})


def names_something(words: Phrase, *, people: bool = False) -> bool:
    """Whether words can name a thing, a place or somebody.

    Args:
        words: Without what is known to be named; nobody looks at the map here.
        people: Whether somebody at large ("anybody") will do.
    """
    words = tuple(word for word in words if word.is_word or word.key == ",")
    flat = keys(words)
    in_the_way = flat[-2:] == ("the", "way") and flat[-3:-2] in {("in",), ("blocking",)}
    ends = () if in_the_way or _labelled(words) else flat[-1:]
    if not flat or len(flat) > _LONGEST_NAME or set(ends) & _NO_ENDS or _ends_in_order(flat):
        return False
    if set(flat) <= _WHERE | {"it", "them", "there"}:
        return False
    if "to" in flat[1:3] and flat[0] in {"way", "on", "over", "back"}:
        return False
    core = flat[1:] if flat[0] in lexicon().determiners else flat
    if not core or core[0] in _NO_NAMES - (_PERSONS_AT_LARGE if people else frozenset()):
        return False
    if people and set(core) <= _PERSONS_AT_LARGE:
        return True
    if not any(_carries_meaning(word) for word in core):
        return False
    if any(flat[i] in {"and", ",", "then"} and _acts(words[i + 1 :]) for i in range(len(flat) - 1)):
        return False
    relative = next(
        (i for i, word in enumerate(flat) if word in _RELATIVE or word.endswith("ing")), len(flat)
    )
    return not any(word in _FINITE or word in _SPEAKERS for word in flat[:relative])


_NO_NOUNS = frozenset(
    {"before", "after", "but", "and", "is", "are", "of", "there", "if", "then", "not", "you", "i", "to", "a"}
)
_WHERE = frozenset({
    "under", "underneath", "beneath", "behind", "below", "above", "inside", "beside", "near", "around",
    "over", "by",
})  # fmt: skip


def _ends_in_order(flat: tuple[str, ...]) -> bool:
    """For "bay 1 look", "bay 1 same thing": a name with the next order."""
    same = flat.index("same") if "same" in flat else 0
    return (same > 0 and flat[same - 1] not in lexicon().determiners) or (
        len(flat) > 1
        and flat[-1] in {"look", "go", "check", "inspect", "drive", "see"}
        and (flat[-2].isdigit() or len(flat[-2]) == 1)
    )


def is_request(words: Phrase) -> bool:
    """Whether words can say what to look at: a thing, or whether or how something is."""
    flat = keys(words)
    if flat[:1] not in {("whether",), ("how",), ("if",), ("what",), ("where",), ("who",), ("which",)}:
        return names_something(words, people=True)
    rest = words[1:]
    articles = (i for i in range(len(flat) - 1) if flat[i] in {"the", "a", "an"})
    if any(flat[i + 1] in _NO_NOUNS and not _labelled(words[: i + 1]) for i in articles):
        return False
    if flat[:1] in {("what",), ("who",), ("how",), ("where",)} and len(flat) < 6:
        return True
    if not rest or len(rest) > _LONGEST_STATE or keys(rest)[0] in {"and", "or", "but", "then", "while"}:
        return False
    if any(
        flat[i] in {"and", ",", "then"} and _acts(words[i + 1 :]) for i in range(1, len(flat) - 1)
    ) or _runs_on(rest):
        return False
    ends = _NO_ENDS - {"first", "way"} - (lexicon().be if flat[0] == "how" else frozenset())
    return _labelled(rest) or keys(rest)[-1] not in ends


def _labelled(words: Phrase) -> bool:
    """Whether words end in a letter that something is called by ("meeting room A"), and in no article."""
    last = words[-1:]
    lettered = len(words) > 1 and words[-2].key in lexicon().nouns
    return bool(last) and last[0].key == "a" and (last[0].raw == "A" or lettered)


def _runs_on(words: Phrase) -> bool:
    """Whether an order stands in the middle of what is to be checked."""
    flat = keys(words)
    finite = next((i for i in range(1, len(flat)) if flat[i] in _FINITE), 0)
    return any(
        _acts(words[i:]) and flat[i - 1] not in {"to", "not"} for i in range(finite + 2, len(flat) - 1)
    )


def _acts(words: Phrase) -> bool:
    """Whether an order with something to do it to begins here."""
    flat = keys(words)
    found = lexicon().verbs.match(flat) if flat else None
    if found is None or found[1].startswith("other:") or lemma(flat[0]) != flat[0]:
        return False
    behind = flat[found[0] : found[0] + 1]
    # In "lift A" the letter is no article.
    article = len(flat) > found[0] + 1 and words[found[0]].raw != "A"
    directed = bool(behind) and (
        (article and behind[0] in lexicon().determiners) or behind[0] in {"it", "to", "them", "back"}
    )
    return directed and opens_command(words)


def _carries_meaning(word: str) -> bool:
    lex = lexicon()
    if word in lex.nouns or word in lex.meaningful or word.isdigit() or len(word) == 1:
        return True
    return word not in _NO_NAMES | _NO_ENDS and word not in lex.auxiliaries | lex.be | lex.determiners
