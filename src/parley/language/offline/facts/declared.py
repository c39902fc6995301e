"""Statements in words of their own about what is known: "A gave the box to B", "the desk gets new drawers".

What no pattern of `facts` reads is still a fact if it says something of a thing on the map, of what is
remembered, or of somebody by name.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import Fact, only_before, read_statement, strip_openers
from parley.language.offline.facts.framed import asked_to_keep
from parley.language.offline.facts.groups import read_group
from parley.language.offline.facts.redirecting import read_redirect
from parley.language.offline.facts.stories import mentioned
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.finite import verb_at
from parley.language.offline.sentences.telling import is_usual
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.text import Phrase, Word, keys, plain, tokens
from parley.language.word_lists import load_data

__all__ = ["is_statement", "laid_down", "read_declared", "read_rule"]

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
_PAST = frozenset(load_data("units")["past"])


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
    at = verb_at(said) or _unknown_verb(said, scene)
    if flat[0] in {"smells", "sounds", "stinks", "looks", "seems", "feels"}:
        return None
    if flat[at] in _TELLING or {"whether", "if"} & set(flat):
        return None
    subject = bare(said[:at]) if at else ()
    if len(subject) > 1 and subject[-1].key in {"may", "can", "must"}:
        # "Only A may V": of A.
        subject = subject[int(subject[0].key == "only") : -1]
    if not subject or (at >= len(said) - 1 and verb_at(said)):
        return None
    known = _is_known(subject, scene)
    if not known and not mentioned(said[at:], scene):
        return None
    text = plain((*only_before(words, said), *said))
    sentence = text[:1].upper() + text[1:]
    goal = next((i for i in range(at + 2, len(flat) - 1) if flat[i] == "to"), 0)
    if flat[at] in _GIVING and goal:
        thing = bare(said[at + 1 : goal])
        return Fact(thing, relation="belongs", state=said[goal:], sentence=sentence)
    return Fact(subject, relation=flat[at], state=said[at + 1 :], sentence=sentence)


def _unknown_verb(said: Phrase, scene: Scene) -> int:
    """Where a verb that no list has stands behind a thing of the map ("the machine refuses coins")."""
    for at in range(min(5, len(said) - 1), 0, -1):
        verb = said[at].key
        third = len(verb) > 3 and verb.endswith("s") and "'" not in verb and not verb.endswith("ss")
        unknown = (third and verb not in lexicon().vocabulary) or verb in _PAST
        if unknown and scene.ground(said[:at]).outcome == "match":
            return at
    return 0


def is_statement(words: Phrase) -> bool:
    """Whether a clause plainly tells something, of whatever it is ("the harbour master retires next year").

    Args:
        words: One clause.
    """
    said = tuple(word for word in strip_openers(words) if word.is_word)
    flat = keys(said)
    begins = lexicon().determiners | {"we", "they", "he", "she", "people", "it"}
    if (
        not begins & set(flat[:1])
        or len(said) < 3
        or {"you", "your", "please"} & set(flat)
        or opens_command(said)
    ):
        return False
    third = (
        i
        for i in range(1, min(6, len(flat)))
        if flat[i].endswith("s") and flat[i] not in lexicon().vocabulary and len(flat[i]) > 3
    )
    return bool(verb_at(said)) or next(third, 0) > 0


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


_LEAVE = frozenset({
    "asking", "telling", "calling", "informing", "warning", "consulting", "my", "our", "permission", "being",
})  # fmt: skip
_SAYING = frozenset({"tell", "tells", "ask", "asks", "say", "says", "order", "orders", "want", "wants"})


_ASK_FIRST = tuple(
    (*said, *asked)
    for said in (
        (),
        ("always",),
        ("you", "should", "always"),
        ("you", "must", "always"),
        ("please", "always"),
    )
    for asked in (
        ("ask", "me"),
        ("ask",),
        ("tell", "me"),
        ("ask", "us"),
        ("call", "me"),
        ("check", "with", "me"),
    )
    if said or asked == ("ask", "me")
)


def _reserved(words: Phrase) -> Fact | None:
    """For "never V A without asking me", "do not V A unless I say so", "only V A if N asks you to"."""
    words = tuple(words[: len(words) - (bool(words) and not words[-1].is_word)])
    flat = keys(words)
    lead = next((lead for lead in _ASK_FIRST if flat[: len(lead)] == lead), ())
    if (
        lead
        and "before" in flat[: len(lead) + 2]
        and {"you", "going", "doing", "entering"} & set(flat[len(lead) :])
    ):
        text = plain(words)
        behind = bare(words[flat.index("before") + 2 :])[-3:]
        return Fact(behind, relation="rule", state=words, sentence=text[:1].upper() + text[1:])
    found = lexicon().prohibitions.match(flat)
    size = found[0] if found is not None else int(flat[:1] == ("only",))
    if not size or not opens_command(words[size:]):
        return None
    bound = (
        {"without": _LEAVE, "unless": _SAYING | {"i", "we"}}
        if found is not None
        else {"if": _SAYING, "when": _SAYING}
    )
    at = next((i for i in range(size + 2, len(flat)) if flat[i] in bound), 0)
    if not at or not bound[flat[at]] & set(flat[at + 1 : at + 4]):
        return None
    text = plain(words)
    sentence = text[:1].upper() + text[1:]
    return Fact(bare(words[size:at])[-3:], relation="rule", state=words, sentence=sentence)


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
        or not (_HABIT & set(flat[at:]) or is_usual(flat))
        or {"and", "then", "if", "when"} & set(flat)
        or len(said) > 14
    ):
        return None
    somebody = scene.is_person(bare(said[:at])) or (is_usual(flat) and at < _LONGEST_SUBJECT)
    if not somebody or flat[0] in _OWN:
        return None
    text = plain(said)
    return Fact(
        bare(said[:at]), relation=flat[at], state=said[at + 1 :], sentence=text[:1].upper() + text[1:]
    )


_LONGEST_SUBJECT = 6
_SENTENCE_ENDS = frozenset({".", "!", "?", ";", "\n"})
_USING = frozenset(
    {"use", "using", "used", "everything", "moved", "replaces", "replaced", "contents", "stuff"}
)


def _goes_on(words: Phrase, start: int, end: int) -> bool:
    """For "A is closed. Use B instead": the second sentence says what is used in the place of A."""
    behind = next((i for i in range(end + 1, len(words)) if words[i].key in _SENTENCE_ENDS), len(words))
    if words[end].key not in {".", ";", "!"} or not {"use", "using"} & set(keys(words[end + 1 : end + 4])):
        return False
    first = read_redirect(plain(words[start:end]))
    both = read_redirect(plain((*words[start:end], Word(",", ","), *words[end + 1 : behind])))
    return first is not None and both is not None and not first.other and bool(both.other)


def _replacement(words: Phrase, scene: Scene) -> Fact | None:
    """What is used in the place of something that is closed or has moved; an order changed so is none."""
    words = strip_openers(words, reporting=True)
    told = read_redirect(plain(words)) if _USING & set(keys(words)) and not scene.situation.queue else None
    if told is None or not told.other or scene.ground(told.other).outcome != "match":
        return None
    fact = read_statement(words) if told.moved else None
    if fact is not None and fact.is_location and keys(fact.subject) == keys(told.place):
        # "A has moved to B": where A is.
        return None
    said = next((turn for turn in reversed(scene.situation.history) if turn.role == "operator"), None)
    last = keys(tokens(said.content)) if said is not None else ()
    name = keys(told.place)
    if any(last[i : i + len(name)] == name for i in range(len(last))):
        return None
    text = plain(words).strip(" ,")
    return Fact(told.place, relation="is", state=words, sentence=text[:1].upper() + text[1:])


def _kept_whole(sentence: Phrase, scene: Scene) -> Fact | None:
    """For "remember that A always goes to B": what is asked to be kept, with an order's words in it."""
    said = asked_to_keep(strip_openers(sentence))
    inner = (i for i in range(1, len(said)) if lexicon().verbs.match(keys(said), i) is not None)
    if not said or next(inner, None) is None or opens_command(said, scene.catalogue.verbs):
        return None
    if not verb_at(said) and not is_usual(keys(said)):
        return None
    text = plain(said)
    return Fact(said[:4], relation="note", state=said, sentence=text[:1].upper() + text[1:])


def _kept_beside(sentence: Phrase) -> Fact | None:
    """For "And remember that A is B" among other sentences: kept, whatever is made of those."""
    said = asked_to_keep(strip_openers(sentence))
    fact = read_statement(said) if said else None
    pronouns = lexicon().person_pronouns | lexicon().thing_pronouns | lexicon().operator_pronouns
    return None if fact is None or pronouns & set(keys(fact.subject)) else fact


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
        if index < len(words) and (words[index].key not in _SENTENCE_ENDS or _goes_on(words, start, index)):
            continue
        mark = words[index : index + 1]
        sentence = words[start:index]
        fact = (
            None
            if keys(mark) == ("?",)
            else read_group(sentence)
            or read_rule(sentence)
            or _reserved(sentence)
            or _habit(sentence, scene)
            or _replacement(sentence, scene)
            or _kept_whole(sentence, scene)
            or (_kept_beside(sentence) if len(sentence) < len(words) - 1 else None)
        )
        if fact is None:
            left += (*sentence, *mark)
        else:
            found.append(fact)
        start = index + 1
    return tuple(found), tuple(left)
