"""Which robot a message is for."""

from __future__ import annotations

from parley.language.base import Situation
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, closest, keys, tokens

__all__ = ["addressed", "other_robots", "own_part", "stranger"]

_CALLS = frozenset(
    {"hey", "hi", "hello", "ok", "okay", "dear", "tell", "have", "let", "ask", "make", "and", "please", "get"}
)  # fmt: skip


def addressed(words: Phrase, situation: Situation) -> tuple[Phrase, tuple[str, ...]]:
    """The message without the names it calls, and the robots it is for (empty: nobody was named)."""
    words = _others_named(words, situation)
    group = lexicon().everybody.match(keys(words))
    if group is not None and group[0] < len(words) and situation.robots:
        return _except(_going(words[group[0] :]), situation.robots)
    before = _all_called_last(words) if len(situation.robots) > 1 else ()
    if before:
        return before, situation.robots
    sent = _sent(words, situation.robots)
    if sent is not None:
        return sent
    named: list[str] = []
    rest = words
    while True:
        shorter, name = _called_first(rest, situation.robots)
        if not name:
            break
        rest = shorter
        named.append(name)
    rest, last = _called_last(rest, situation.robots)
    if last:
        named.append(last)
    return rest, tuple(dict.fromkeys(named))


_OTHERS = (
    ("the", "other", "robots"), ("the", "other", "robot"), ("the", "other", "two"), ("your", "colleague"),
    ("your", "colleagues"), ("the", "others"), ("one", "of", "you"), ("any", "of", "you"),
    ("either", "of", "you"), ("you", "other", "two"), ("you", "others"), ("you", "other", "robots"),
)  # fmt: skip
_BEFORE_OTHERS = frozenset({"let", "tell", "have", "send", "ask", "get", "make", "should", "could", "and"})


def _others_named(words: Phrase, situation: Situation) -> Phrase:
    """The names of the other robots for "the other robot", that of the one spoken to for "one of you"."""
    flat = keys(words)
    for at in range(min(4, len(flat))):
        marker = next((m for m in _OTHERS if flat[at : at + len(m)] == m), ())
        if not marker or (at and flat[at - 1] not in _BEFORE_OTHERS) or at + len(marker) >= len(flat):
            continue
        names = [name for name in situation.robots if name != situation.robot]
        names = (
            [situation.robot or situation.robots[0]] if marker[-1] == "you" and situation.robots else names
        )
        if not names or (marker[-1] in {"robot", "colleague"} and len(names) > 1):
            return words
        called = tuple(
            word for i, n in enumerate(names) for word in (*(tokens("and") if i else ()), *tokens(n))
        )
        return (*words[:at], *called, *words[at + len(marker) :])
    return words


def other_robots(words: Phrase, situation: Situation) -> tuple[str, ...]:
    """The robots that "the other robot" may mean, if there are several."""
    flat = keys(words)
    for at in range(min(4, len(flat) - 3)):
        if flat[at : at + 3] == ("the", "other", "robot") and (not at or flat[at - 1] in _BEFORE_OTHERS):
            names = tuple(name for name in situation.robots if name != situation.robot)
            return names if len(names) > 1 else ()
    return ()


def own_part(words: Phrase, situation: Situation) -> tuple[Phrase, tuple[str, ...], str] | None:
    """For "A, go to x and B, go to y": one robot's part, who else is told something, and whose part it is.

    The part is that of the robot that is spoken to, else of the one that is named first.

    None if the message does not give several robots orders of their own.
    """
    starts = _calls(words, situation.robots)
    names = tuple(dict.fromkeys(name for _, name in starts))
    if len(names) < 2:
        return None
    parts: dict[str, Phrase] = {}
    lead: list[str] = []
    for number, (at, name) in enumerate(starts):
        end = starts[number + 1][0] if number + 1 < len(starts) else len(words)
        part = words[at + len(tokens(name)) : end]
        while part and not part[0].is_word:
            part = part[1:]
        if keys(part[:1]) == ("you",):
            part = part[1:]
        gapped = keys(part[:1]) in {("to",), ("into",), ("at",)} and not (part[1:] and _is_verb(part[1].key))
        # "A go to x and B to y": the verb is understood.
        part = (*tokens("go"), *part) if gapped else _without_lead(part)
        lead.append(name)
        if any(word.is_word and word.key not in {"and", "while", "then", "but"} for word in part):
            # "A and B, go to x. C, go to y": names without order share the next one.
            for each in lead:
                parts[each] = (*parts.get(each, ()), *_without_end(part), *tokens("."))
            lead = []
    if len({keys(part) for part in parts.values()}) < 2:
        return None
    own = situation.robot if situation.robot in parts else next(iter(parts))
    return parts[own], tuple(name for name in parts if name != own), own


def _except(words: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, tuple[str, ...]]:
    """For "everyone but A, go to x"."""
    flat = keys(words)
    size = next((len(m) for m in _EXCEPT if flat[: len(m)] == m), 0)
    left_out: list[str] = []
    rest = words[size:]
    while size and rest:
        name = next((n for n in robots if keys(rest[: len(tokens(n))]) == keys(tokens(n))), "")
        if not name and (rest[0].is_word and rest[0].key not in {"and", "or"}):
            break
        left_out += [name] if name else []
        rest = rest[len(tokens(name)) if name else 1 :]
    if not left_out:
        return words, robots
    return _going(rest), tuple(name for name in robots if name not in left_out)


def _going(rest: Phrase) -> Phrase:
    """What several are to do: where only a place is named ("to A"), go there."""
    gapped = keys(rest[:1]) in {("to",), ("into",)} and not (rest[1:] and _is_verb(rest[1].key))
    return (*tokens("go"), *rest) if gapped else _without_lead(rest)


_EXCEPT = (("except", "for"), ("except",), ("but", "not"), ("but",), ("apart", "from"), ("other", "than"))


def _sent(words: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, tuple[str, ...]] | None:
    """For "send A to the door", "I want A to look at it", "A should go there", "could A go there"."""
    flat = keys(words)
    for name in robots:
        called = keys(tokens(name))
        for index in range(len(flat) - len(called)):
            if flat[index : index + len(called)] != called:
                continue
            before, rest = flat[:index], words[index + len(called) :]
            rest, others = _further_names(rest, robots)
            if _ends_with(before, _SENDING) and rest:
                verb = () if rest[0].key == "to" and len(rest) > 1 and _is_verb(rest[1].key) else tokens("go")
                rest = rest[1:] if not verb else rest
                return (*verb, *rest), (name, *others)
            if rest and (
                (_ends_with(before, _WISHING) and rest[0].key == "to") or (before and before[-1] in _ASKING)
            ):
                return _without_lead(rest), (name, *others)
    return None


def _further_names(rest: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, tuple[str, ...]]:
    """For "(send A) and B to the door": the other names, and the words behind them."""
    others: list[str] = []
    while keys(rest[:1]) in {("and",), (",",)}:
        name = next((n for n in robots if keys(rest[1 : 1 + len(tokens(n))]) == keys(tokens(n))), "")
        if not name:
            break
        others.append(name)
        rest = rest[1 + len(tokens(name)) :]
    return rest, tuple(others)


def stranger(words: Phrase, situation: Situation) -> str:
    """The name of a robot that is called ("X, go to the door") but that nobody knows; empty if none is."""
    while len(words) > 4 and (
        words[0].key in _CALLS | {"oi", "yo"} or keys(words[:2]) == ("good", "morning")
    ):
        words = words[1:]
    if len(words) > 5 and words[1].key.isdigit() and words[2].key in {",", ":"}:
        # "Robot 2, go to the door".
        words = (words[0], *words[2:])
    if len(words) > 4 and words[1].key in {"should", "must", "shall"} and len(situation.robots) > 1:
        # "X should go to the door".
        words = (words[0], *tokens(","), *words[2:])
    if (
        len(words) < 4
        or words[1].key not in {",", ":", "!"}
        or not words[0].is_capital
        or not situation.robots
    ):
        return ""
    name = words[0].key
    known = (
        _NOBODY | lexicon().vocabulary | {part for robot in situation.robots for part in keys(tokens(robot))}
    )
    told = {word.key for entry in situation.memory for word in tokens(entry.data[:400])}
    mapped = {word.key for item in situation.objects for word in tokens(item.description)}
    ordered = next((w.key for w in words[2:] if w.key not in {"please", "can", "you", "could"}), "")
    orders = _is_verb(ordered) or ordered in {"back", "to", "over", "off", "into", "straight"}
    named = len(name) > 2 or any(char.isdigit() for char in name)
    return words[0].raw if orders and name not in known | told | mapped and named else ""


_NOBODY = frozenset({"neither", "none", "nobody", "nowhere", "anyway", "anyhow", "either", "both"})
_SENDING = (("send",), ("dispatch",), ("direct",), ("route",))
_WISHING = (
    ("i", "want"), ("i", "need"), ("we", "want"), ("we", "need"), ("would", "like"), ("instruct",),
    ("order",),
    ("command",), ("tell",), ("ask",), ("get",), ("remind",), ("i", "would", "like"),
)  # fmt: skip
_ASKING = frozenset({"could", "can", "would", "will", "should", "let", "have", "make", "may", "might"})


def _ends_with(flat: tuple[str, ...], endings: tuple[tuple[str, ...], ...]) -> bool:
    return any(flat[-len(end) :] == end for end in endings)


def _is_verb(word: str) -> bool:
    return lexicon().verbs.match((word,)) is not None


def _calls(words: Phrase, robots: tuple[str, ...]) -> list[tuple[int, str]]:
    """Where robots are called: at the start of a clause, before an order."""
    flat = keys(words)
    found: list[tuple[int, str]] = []
    for index in range(len(flat)):
        for name in robots:
            called = keys(tokens(name))
            opens = index == 0 or flat[index - 1] in _BEFORE_CALLS or not words[index - 1].is_word
            told = flat[index + len(called) : index + len(called) + 2] in {("and", "i"), ("and", "me")}
            if flat[index : index + len(called)] == called and opens and not told:
                found.append((index, name))
    return found


_BEFORE_CALLS = frozenset(
    {"and", "while", "but", "then", "hey", "meanwhile", "whereas", "let", "have", "tell", "send"}
)  # fmt: skip


def _without_end(words: Phrase) -> Phrase:
    while words and (not words[-1].is_word or words[-1].key in _BEFORE_CALLS):
        words = words[:-1]
    return words


def _called_first(words: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, str]:
    flat = keys(words)
    start = 0
    greeting = lexicon().greetings.match(flat)
    if greeting is not None:
        start = greeting[0]
    while start < len(flat) and (flat[start] in _CALLS or not words[start].is_word):
        start += 1
    for name in robots:
        called = keys(tokens(name))
        if flat[start : start + len(called)] == called:
            after = start + len(called)
            verb_of_statement = after < len(flat) and flat[after] in {
                "is",
                "was",
                "has",
                "needs",
                "wants",
                "feels",
            }
            if after >= len(flat) or not verb_of_statement:
                return _without_lead(words[after:]), name
    if len(flat) > start + 1 and flat[start + 1] == "," and words[start].is_capital:
        meant = closest(flat[start], [name.lower() for name in robots])
        if meant:
            return _without_lead(words[start + 2 :]), next(n for n in robots if n.lower() == meant)
    return words, ""


def _without_lead(words: Phrase) -> Phrase:
    while words and (not words[0].is_word or words[0].key in {"to", "should", "must", "and"}):
        words = words[1:]
    return words


def _all_called_last(words: Phrase) -> Phrase:
    """For "V, all of you": V; empty if not everybody is called behind it."""
    end = len(words)
    while end and not words[end - 1].is_word:
        end -= 1
    comma = next((i for i in range(end - 1, 0, -1) if not words[i].is_word), 0)
    group = lexicon().everybody.match(keys(words[:end]), comma + 1) if comma else None
    called = group is not None and comma + 1 + group[0] == end
    return (*words[:comma], *words[end:]) if called else ()


def _called_last(words: Phrase, robots: tuple[str, ...]) -> tuple[Phrase, str]:
    end = len(words)
    while end and not words[end - 1].is_word:
        end -= 1
    for name in robots:
        called = keys(tokens(name))
        start = end - len(called)
        if start > 0 and keys(words[start:end]) == called:
            if words[start - 1].key == ",":
                return (*words[: start - 1], *words[end:]), name
            if keys(words[:start]) in lexicon().thanks or keys(words[:start]) in lexicon().greetings:
                return words[:start], name
    return words, ""
