"""Courtesy around an order, in whatever words: "I was wondering whether you might V", "... thanks a lot"."""

from __future__ import annotations

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["called_plainly", "plainly"]

_WORDS = load_data("courtesy")
_FIRST = frozenset(_WORDS["first"])
_COURTEOUS = frozenset(_WORDS["courteous"])
_MODAL = frozenset(_WORDS["modal"])
_OPEN_FIRST = frozenset(_WORDS["open_first"])
_OPEN = frozenset(_WORDS["open"])
_LAST = frozenset(_WORDS["last"])
_ORDERS = frozenset(_WORDS["orders"])
_DEEDS = frozenset(verb for verbs in load_data("grammar")["verbs"].values() for verb in verbs) - frozenset(
    _WORDS["no_deeds"]
)
_THANKS = (
    ("thank", "you"),
    ("thanks",),
    ("many", "thanks"),
    ("cheers",),
    ("much", "appreciated"),
    ("thx",),
    ("ty",),
    ("ta",),
)


_PET_NAMES = frozenset(_WORDS["pet_names"])
_FOND = frozenset(_WORDS["fond"])
_SPEAKING = frozenset({"say", "tell", "speak", "announce", "shout", "whisper", "greet", "write"})
_MOST_FOND = 5


def called_plainly(words: Phrase, robots: frozenset[str]) -> Phrase:
    """Without pet names in an address: for "V, my dear A" and "A my friend, V" "V, A" and "A, V".

    Args:
        words: All words and punctuation.
        robots: What the robots are called, in lower case.
    """
    flat = keys(words)
    if not {*flat} & (_PET_NAMES | _FOND) or _SPEAKING & {*flat}:
        return words
    result: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].is_word:
            continue
        part, mark = words[start:index], words[index : index + 1]
        start = index + 1
        address = _fond(keys(part), robots) and (keys(result[-1:]) == (",",) or keys(mark) == (",",))
        if not address:
            result += (*part, *mark)
            continue
        name = [word for word in part if word.key in robots]
        if name:
            result += (*name, *mark)
        elif keys(mark) == (",",):
            # In the middle it stands between two sentences, which are read apart.
            result += (*part, *mark)
        else:
            result = [*result[:-1], *mark]
    return tuple(result)


def _fond(flat: tuple[str, ...], robots: frozenset[str]) -> bool:
    """Whether words are a pet name, or a robot's name with one."""
    named = bool(robots & {*flat})
    fond = {*flat} <= _PET_NAMES | _FOND | robots and not {*flat} <= robots
    return fond and 0 < len(flat) <= _MOST_FOND and (named or bool({*flat} & _PET_NAMES))


def plainly(words: Phrase) -> Phrase:
    """A message without the courtesy at its start and its end."""
    words = _forbidden(_going(_without_thanks(_apart(words))))
    start = 0
    result: list[Word] = []
    for index in range(len(words) + 1):
        if index == len(words) or words[index].key in {".", "!", "?", ";", "\n"}:
            sentence = words[start:index]
            if not result or not _leaves_it_open(keys(sentence)):
                sentence = _without_open_end(_minding(sentence))
                result += (*_without_frame(sentence), *words[index : index + 1])
            start = index + 1
    return tuple(result)


def _forbidden(words: Phrase) -> Phrase:
    """For "under no circumstances V", "you are not allowed to V" "do not V", so that nobody reads V alone."""
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        begins = not index or not words[index - 1].is_word or flat[index - 1] in {"and", "but", "so"}
        found = lexicon().prohibitions.match(flat, index) if begins else None
        size = found[0] if found is not None and _STRICT & set(flat[index : index + found[0]]) else 0
        if size and flat[index + size - 2 : index + size] == ("go", "to"):
            size -= 2
        done = flat[index + size] if size and index + size < len(flat) else ""
        verb = lexicon().verbs.match(flat, index + size) if done and lemma(done) == done else None
        if verb is None:
            result.append(words[index])
            index += 1
            continue
        result += (Word("do", "do"), Word("not", "not"))
        index += size
    return tuple(result)


_STRICT = frozenset({"circumstances", "account", "time", "means", "case", "forbidden", "allowed"})


def _leaves_it_open(flat: tuple[str, ...]) -> bool:
    """For "only when it suits you, of course", said behind an order."""
    enough = len(flat) > 2 or (len(flat) == 2 and flat[1] in _OPEN - _COURTEOUS)
    # "If it is, V" repeats a condition.
    enough = enough and not set(flat) <= _REPEATING
    return enough and flat[0] in _OPEN_FIRST and set(flat[1:]) <= _COURTEOUS | _OPEN | {","}


_REPEATING = frozenset({
    "one", "any", "none", "some", "case", "if", "when", "it", "is", "that", "they", "are", "not", "there",
    "so", "he", "she", "does", "do", "you",
})  # fmt: skip


def _without_open_end(sentence: Phrase) -> Phrase:
    """Without "..., take your time" at the end, and "if it is no trouble, ..." at the start."""
    first = next((i for i, word in enumerate(sentence) if word.key == ","), 0)
    opens = keys(sentence[:1]) in _OPEN_START and keys(sentence[first + 2 : first + 3]) not in {(), (",",)}
    if opens and _leaves_it_open(keys(sentence[:first])):
        sentence = sentence[first + 1 :]
    at = max((i for i, word in enumerate(sentence) if word.key == ","), default=0)
    return sentence[:at] if at and _leaves_it_open(keys(sentence[at + 1 :])) else sentence


_OPEN_START = {("if",), ("when",), ("whenever",), ("no",), ("at",)}


def _minding(sentence: Phrase) -> Phrase:
    """For "would you mind awfully V-ing" "would you mind V-ing"."""
    flat = keys(sentence)
    at = flat.index("mind") + 1 if "mind" in flat[:5] else 0
    much = at and flat[at : at + 1] and flat[at] in {"awfully", "terribly", "very", "too", "ever", "so"}
    end = at + 1 + (flat[at + 1 : at + 2] in {("much",), ("so",)}) if much else at
    return (*sentence[:at], *sentence[end:])


def _without_frame(sentence: Phrase) -> Phrase:
    """Without a frame of nothing but courteous words before an order."""
    meant = sentence
    while keys(meant[:2]) in _TAKING_BACK:
        meant = meant[2:]
    if keys(meant[:2]) in {("i", "meant"), ("i", "mean")}:
        sentence = meant
    flat = keys(word for word in sentence)
    tail = next((tail for tail in _HYPOTHETICAL if flat[-len(tail) :] == tail), ())
    if (
        tail
        and flat[:2] in {("could", "you"), ("can", "you"), ("would", "you")}
        and len(flat) > len(tail) + 2
    ):
        # "Could you lift a box if you had to": asked about, not asked for.
        return (*(Word(part, part) for part in ("are", "you", "able", "to")), *sentence[2 : -len(tail)])
    if (
        len(flat) < 4
        or flat[0] not in _FIRST
        or (flat[:2] in {("have", "you"), ("do", "not")} and "time" not in flat[:5])
    ):
        return sentence
    at = 0
    while at < len(flat) and (flat[at] in _COURTEOUS or flat[at] == ","):
        at += 1
    for cut in range(min(at, len(flat) - 1), 2, -1):
        lead = flat[:cut]
        if "not" in lead and not _COURTEOUS_DENIAL & set(lead):
            # "I do not want you to V" is no courtesy.
            continue
        if lead[-1] not in _LAST or not set(lead) & _MODAL or not {"you", "trouble", "bother"} & set(lead):
            continue
        doing = flat[cut] in {"are", "be"} and flat[cut + 1 : cut + 2] and flat[cut + 1].endswith("ing")
        if doing:
            # "I want that you are going to A".
            base = lemma(flat[cut + 1])
            sentence = (*sentence[:cut], Word(base, base), *sentence[cut + 2 :])
            flat = keys(sentence)
        if _orders(flat, cut) and not _asks_for_knowledge(flat[cut:]) and len(flat) > cut + 1:
            return sentence[cut:]
    return sentence


def _orders(flat: tuple[str, ...], at: int) -> bool:
    """Whether a verb stands there that asks for something to be done, also one of a robot's own actions."""
    found = lexicon().verbs.match(flat, at)
    if found is not None:
        return found[1].partition(":")[0] in _ORDERS
    return flat[at] in _DEEDS and flat[at] not in _COURTEOUS


_MOVING = frozenset({
    "get", "take", "bring", "move", "haul", "drag", "place", "position", "station", "park", "put",
    "transport", "transfer", "carry", "lead", "shift", "send", "drive",
})  # fmt: skip
_ALONG = frozenset({"over", "up", "back", "across", "along", "round", "around", "out", "off", "quickly"})


def _going(words: Phrase) -> Phrase:
    """For "get yourself over to the desk" "go to the desk"."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] == "yourself" and flat[i - 1] in _MOVING), 0)
    if not at or flat[at + 1] in {"down", "some", "a", "the", "together", "ready"}:
        return words
    end = at + 1
    if flat[end] in _ALONG and flat[end + 1 : end + 2] != ("of",):
        end += 1
    back = (Word("back", "back"),) if flat[end - 1] == "back" else ()
    return (*words[: at - 1], Word("go", "go"), *back, *words[end:])


_HYPOTHETICAL = tuple(
    tuple(text.split())
    for text in (
        "if you had to",
        "if you wanted to",
        "if you tried",
        "if it came to it",
        "if you were asked to",
    )
)
_COURTEOUS_DENIAL = frozenset(
    {"mind", "trouble", "bother", "if", "too", "whether", "inconvenient", "suppose", "why", "disturb"}
)
_TAKING_BACK = frozenset(
    (word, ",") for word in ("sorry", "oops", "no", "wait", "actually", "ah", "oh", "my")
)


def _asks_for_knowledge(flat: tuple[str, ...]) -> bool:
    return flat[:1] in {("know",), ("remember",), ("like",), ("mind",)} or (
        flat[:2] in {("tell", "me"), ("have", "a")}
        and "look" not in flat[:5]
        and flat[2:4] != ("how", "many")
    )


def _without_thanks(words: Phrase) -> Phrase:
    """Without "thank you so much, you are a star" at the end."""
    flat = keys(words)
    for at in range(3, len(flat)):
        if flat[at - 1] in {"say", "tell", "him", "her", "them", "to", "you"}:
            continue
        if any(flat[at : at + len(t)] == t for t in _THANKS) and len(flat) - at <= 12:
            rest = flat[at:]
            orders = any(
                lexicon().verbs.match(rest, i) and rest[i - 1] in {",", ".", "and"}
                for i in range(2, len(rest))
            )
            return words if orders else words[:at]
    return words


def _apart(words: Phrase) -> Phrase:
    """A sentence of its own for "could you V" in the middle of dictated words."""
    flat = keys(words)
    if len(flat) < 8:
        return words
    result: list[Word] = []
    dictated = len(flat) > 14 and all(word.is_word for word in words[:-1])
    for index, word in enumerate(words):
        if index > 2 and (
            flat[index : index + 3] == ("by", "the", "way")
            or (dictated and flat[index - 1] not in _LEADING and _tells(flat, index))
        ):
            result.append(Word(".", "."))
        begins = flat[index : index + 2] in _ASKING and lexicon().verbs.match(flat, index + 2) is not None
        joined = (
            index
            and flat[index - 3 : index] != ("by", "the", "way")
            and (not words[index - 1].is_word or flat[index - 1] in _JOINING or flat[index - 1] in _COURTEOUS)
        )
        if begins and index > 2 and not joined:
            result.append(Word(".", "."))
        result.append(word)
    return tuple(result)


_LEADING = frozenset({
    "if", "unless", "when", "that", "because", "whether", "where", "while", "since", "until", "once",
    "case", "as",
})  # fmt: skip


def _tells(flat: tuple[str, ...], index: int) -> bool:
    """Whether a sentence about the speaker begins in words dictated without a mark."""
    starts = flat[index] in {"i", "we", "my", "there"} and flat[index + 1 : index + 2] != ()
    having = {"have"} - ({"have"} if flat[index] == "there" else set())
    link = flat[index + 1] in lexicon().be | having if starts else False
    before = index - 1
    taken = lexicon().verbs.match((lemma(flat[before]),)) or lexicon().places.match(flat, before)
    return (
        starts and (link or (flat[index] == "my" and taken is None)) and flat[index - 1] not in _SUBORDINATE
    )


_SUBORDINATE = _COURTEOUS | frozenset(_WORDS["joining"])
_ASKING = frozenset((modal, "you") for modal in ("could", "can", "would", "will"))
_JOINING = frozenset(
    {"and", "or", "but", "then", "so", "what", "where", "how", "when", "why", "who", "which", "way"}
)
