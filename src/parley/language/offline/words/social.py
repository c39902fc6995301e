"""Small talk: greetings, thanks, insults."""

from __future__ import annotations

from functools import cache

from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, plain
from parley.language.word_lists import load_data

__all__ = ["not_understood", "reply", "small_talk"]

_SHORT = {
    **dict.fromkeys(
        ("yes", "ok", "okay", "yeah", "sure", "fine", "all right", "alright", "right", "i see"), "All right."
    ),
    **dict.fromkeys(
        ("no", "nope", "never mind", "nothing", "forget it", "no thanks"), "All right, then nothing."
    ),
    **dict.fromkeys(("sorry", "i am sorry", "oops", "my mistake"), "No problem."),
    **dict.fromkeys(
        (
            "are you ok",
            "are you okay",
            "are you fine",
            "are you ready",
            "are you there",
            "are you all right",
            "can you hear me",
            "do you hear me",
            "do you understand me",
        ),
        "I am here and ready.",
    ),
    **dict.fromkeys(
        ("that is wrong", "you are wrong", "wrong", "that is not right"),
        "I am sorry. Please tell me what is right.",
    ),
    "shut up": "All right, I say no more.",
}


def reply(words: Phrase, *, alone: bool = True) -> str | None:
    """The answer to what is only social; None if the words are about something."""
    lex = lexicon()
    flat = tuple(word.key for word in words if word.is_word)
    if not flat:
        return None
    while (
        len(flat) > 1
        and flat[-1] in {"robot", "there", "please", "again", "everyone", "friend", "much"}
        and flat not in lex.thanks
    ):
        flat = flat[:-1]
    if flat in lex.greetings:
        return "Hello! What can I do for you?" if alone else ""
    if flat in lex.thanks or flat[:2] == ("thank", "you") or (flat[:1] == ("thanks",) and len(flat) < 5):
        return "You are welcome." if alone else ""
    if flat in lex.farewells:
        return "Goodbye! I am here when you need me."
    if not alone:
        return None
    text = " ".join(flat)
    if text in _SHORT:
        return _SHORT[text]
    if set(flat) & lex.insults and (len(flat) <= 3 or flat[0] in {"you", "i", "what", "this", "that"}):
        return "I am sorry if I did something wrong. Tell me what I should do."
    if (
        flat[:2] == ("i", "am")
        and "not" not in flat
        and set(flat[2:]) & {"bored", "sad", "happy", "tired", "lonely", "angry"}
    ):
        return "I am sorry, I cannot help with feelings. Is there something to look at for you?"
    if _asks_for_fun(flat):
        return str(load_data("social")["replies"]["trivia"])
    return None


def _told_to_others(flat: tuple[str, ...]) -> bool:
    """For "tell a joke to the man in the hall", "tell Anna a joke"."""
    if flat[0] != "tell":
        return False
    whom = flat[flat.index("to") + 1 :][:1] if "to" in flat[1:-1] else flat[1:2]
    return bool(whom) and whom[0] not in {"me", "us", "a", "another", "some", "one"}


_ABOUT_YOU = frozenset({"old", "age", "opinion", "favourite", "favorite", "love"})
"""Small talk about the robot, but not about others."""


def _asks_for_fun(flat: tuple[str, ...]) -> bool:
    """For "tell me a joke", "how old are you"; not for "how old is A"."""
    said = set(flat) & lexicon().jokes
    if said <= _ABOUT_YOU and not {"you", "your"} & set(flat):
        return False
    first = {"do", "what", "how", "tell", "who", "is", "are", "sing", "can", "which", "should"}
    return bool(said) and flat[0] in first and len(flat) <= 10 and not _told_to_others(flat)


_KINDS = ("insult", "praise", "wishes", "self", "trivia", "weather", "feeling", "exclaimed", "remark")
_MOST_WORDS = 22


@cache
def _talk() -> tuple[tuple[str, PhraseTable], ...]:
    data = load_data("social")
    return tuple((kind, PhraseTable.of(data[kind])) for kind in _KINDS)


def small_talk(words: Phrase, said: str) -> str | None:
    """The answer to small talk of which nothing else was made; None if it is none.

    Args:
        words: All words and punctuation.
        said: What would be answered without that.
    """
    flat = tuple(word.key for word in words if word.is_word)
    kinds = next((kinds for failure, kinds in _FAILURES if said.startswith(failure)), ())
    if not kinds or not 0 < len(flat) <= _MOST_WORDS:
        return None
    for kind, table in _talk():
        starts = 2 if said.startswith("I cannot") or kind == "remark" else len(flat)
        if kind in kinds and any(_says(table, flat, at) for at in range(starts)):
            return str(load_data("social")["replies"][kind])
    if _thanks(flat):
        return str(load_data("social")["replies"]["thanks"])
    if "remark" in kinds and _only_feels(flat):
        return str(load_data("social")["replies"]["remark"])
    return None


def _says(table: PhraseTable, flat: tuple[str, ...], at: int) -> bool:
    """Whether talk stands there; "this morning" says when, and greets nobody."""
    return table.match(flat, at) is not None and (not at or flat[at - 1] not in _DATING)


_DATING = frozenset({"this", "the", "last", "every", "each", "yesterday", "tomorrow", "next", "one", "all"})


def _thanks(flat: tuple[str, ...]) -> bool:
    """For "that was lovely of you", "how thoughtful of you": whatever the word of praise."""
    while flat[1:] and flat[0] in {"thanks", "thank", "you", "cheers", "ta", "oh", "wow", "well", "and"}:
        flat = flat[1:]
    starts = flat[0] in {"that", "it", "this", "how", "so", "very", "really", "most", "what", "awfully"}
    some = {
        "one",
        "both",
        "all",
        "two",
        "three",
        "some",
        "which",
        "each",
        "none",
        "most",
        "many",
        "rest",
        "front",
        "instead",
        "because",
        "ahead",
        "out",
        "the",
    }
    return flat[-2:] == ("of", "you") and starts and not some & set(flat[-3:-2])


def _only_feels(flat: tuple[str, ...]) -> bool:
    """Whether words without a verb only say how something is felt to be ("a bit quiet tonight")."""
    lex = lexicon()
    degree = PhraseTable.of(load_data("social")["degrees"]).match(flat)
    return degree is not None and degree[0] < len(flat) < _SHORT_REMARK and lex.verbs.match(flat) is None


_SHORT_REMARK = 8
_FAILURES = (
    ("I am not sure what you mean", _KINDS),
    ("I did not understand", _KINDS),
    ("I cannot", ("insult", "praise", "wishes")),
    ("I do not know", ("insult", "praise", "wishes", "self", "trivia", "weather", "remark")),
    ("Where", ("insult", "praise", "wishes", "exclaimed")),
)
"""How an answer begins that says that nothing was made of a message, and what small talk may be behind it."""


def not_understood(words: Phrase) -> str:
    """The sentence for words that mean nothing here."""
    text = plain(words)
    shown = text if len(text) <= 60 else text[:57] + "..."
    return f"I am not sure what you mean by “{shown}”."
