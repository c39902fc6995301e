"""Cutting a message into clauses, in the order in which they are to be done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from parley.language.control import control_of
from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.sentences.conditions import is_rule, split_condition
from parley.language.offline.sentences.inverted import asks
from parley.language.offline.sentences.reasons import without_reason
from parley.language.offline.sentences.simultaneous import side_by_side
from parley.language.offline.words.durations import is_clock
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.order import due, phrases_due
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain

__all__ = ["Clause", "clauses", "opens_command"]

Opens = Callable[[Phrase], bool]


@dataclass(frozen=True, slots=True)
class Clause:
    """One clause of a message."""

    words: Phrase
    is_question: bool = False
    """Whether its sentence ends with a question mark."""
    condition: Phrase = ()
    """What must be so before it is done ("if ..."); empty with `conditional` for what was looked at last."""
    conditional: bool = False
    late: bool = False
    """Whether the condition was said behind the clause."""
    anew: bool = False
    """Whether its condition begins with it, and does not only go on."""
    otherwise: bool = False
    """To be done if the condition of the clause before does not hold."""
    first: bool = False
    """To be done before everything else ("but first ...")."""
    whole: bool = False
    """With `first`: before all of its sentence, not only before what was said last."""
    sentence: int = 0
    beside: bool = False
    """To be done at the same time as what comes before it."""
    passing: bool = False
    """Only says where somebody is whom an order is about ("meet A, she is at the gate"): nothing to keep."""

    def said(self) -> str:
        """The clause with what marks it, readable."""
        return _said(self)


def _said(clause: Clause) -> str:
    marks = ["question"] if clause.is_question else []
    marks += ["before the rest"] if clause.first else []
    marks += ["at the same time"] if clause.beside else []
    if clause.condition or clause.conditional:
        what = f"“{plain(clause.condition)}”" if clause.condition else "what was looked at last"
        marks.append(f"{'unless' if clause.otherwise else 'if'} {what}")
    return f"“{plain(clause.words)}”" + (f" ({', '.join(marks)})" if marks else "")


def clauses(message: Phrase, opens: Opens) -> list[Clause]:
    """The clauses of a message.

    Args:
        message: All words and punctuation.
        opens: Whether a command begins with these words (it knows the verbs and the catalogue).
    """
    result: list[Clause] = []
    for number, (sentence, asked) in enumerate(_sentences(message)):
        sentence = without_reason(sentence, opens)
        parts = _parts_of(sentence, opens)
        result.extend(
            replace(
                clause,
                is_question=(
                    asked and not _has_a(clause) and (clause is parts[-1] or _inverted(clause.words))
                )
                or (clause is parts[0] and asks(clause.words)),
                sentence=number,
            )
            for clause in parts
        )
    ordered: list[Clause] = []
    for clause in result:
        if clause.first and ordered:
            # "..., but first V" comes before its whole sentence, "before that V" before the last clause.
            same = [i for i, other in enumerate(ordered) if other.sentence == clause.sentence]
            whole = clause.whole and same
            ordered.insert(same[0] if whole else len(ordered) - 1, clause)
        else:
            ordered.append(clause)
    return ordered


def _has_a(clause: Clause) -> bool:
    """For "have a look at A(, would you?)": an order, whatever its mark."""
    found = lexicon().verbs.match(keys(clause.words))
    return (
        found is not None and found[0] > 2 and clause.words[0].key == "have" and found[0] < len(clause.words)
    )


def _parts_of(sentence: Phrase, opens: Opens) -> list[Clause]:
    both = side_by_side(sentence, opens)
    if both is None:
        return _begun_first(_conditional(sentence, opens))
    first, second = (_conditional(_trim(part), opens) if part else [] for part in both[:2])
    return [*first, *(replace(clause, beside=both[2]) for clause in second)]


_BEGINNING = frozenset({"begin", "start", "commence", "beginning", "starting"})


def _begun_first(parts: list[Clause]) -> list[Clause]:
    """For "end at A but begin at B": where to begin comes first, wherever it is said."""
    return [
        replace(clause, first=True, whole=True)
        if index
        and clause.words[0].key in _BEGINNING
        and {"at", "with", "from", "in", "by"} & set(keys(clause.words[1:4]))
        else clause
        for index, clause in enumerate(parts)
    ]


def opens_command(words: Phrase, extra_verbs: Sequence[tuple[str, ...]] = ()) -> bool:
    """Whether a clause begins like an order: a verb in its base form after politeness."""
    unasked = strip_openers(words)
    words = strip_openers(words, requests=True)
    flat = keys(words)
    if not flat:
        return False
    if flat[:2] in {("do", "not"), ("not", "to")} or flat[0] in {"never", "avoid"}:
        return len(flat) > 2
    base = (lemma(flat[0]), *flat[1:])
    if any(base[: len(verb)] == verb for verb in extra_verbs):
        return True
    found = lexicon().verbs.match(base)
    if found is None:
        return False
    kind = found[1].partition(":")[0]
    if flat[1:2] in _FINITE_BEHIND and flat[0] not in {"do", "have", "be"}:
        # "Water is dripping": what looks like a verb is the subject.
        return False
    if kind in {"motion", "guide"} and flat[2:3] in _FINITE_BEHIND and _is_noun(flat[1]):
        # "Head office is calling".
        return False
    if base[0] != flat[0] and flat[0].endswith("ed") and len(words) == len(unasked):
        return False
    if flat[0] in lexicon().transition_verbs | lexicon().placing_verbs and base[0] != flat[0]:
        return False
    # Many words of the last class are nouns too ("water", "light"): alone they are not an order.
    return kind != "other" or len(words) > found[0]


def _is_noun(word: str) -> bool:
    """Whether a word can be the noun of a subject behind another one."""
    small = lexicon().determiners | lexicon().operator_pronouns | {"to", "it", "there", "where", "what"}
    return word.isalpha() and word not in small and lexicon().places.match((word,)) is None


_FINITE_BEHIND = frozenset({("is",), ("are",), ("was",), ("were",), ("has",), ("keeps",)})


def _inverted(words: Phrase) -> bool:
    """Whether a clause has the order of words of a question."""
    first = keys(strip_openers(words))[:1]
    return bool(first) and first[0] in lexicon().question_starts | lexicon().be | lexicon().auxiliaries


def _sentences(message: Phrase) -> list[tuple[Phrase, bool]]:
    result: list[tuple[Phrase, bool]] = []
    start = 0
    for index, word in enumerate(message):
        if word.key in {".", "!", "?", ";", "\n"} or word.key.startswith(".."):
            if any(part.is_word for part in message[start:index]):
                result.append((message[start:index], word.key == "?"))
            start = index + 1
    if any(part.is_word for part in message[start:]):
        result.append((message[start:], False))
    return result


def _conditional(sentence: Phrase, opens: Opens) -> list[Clause]:
    """What is done in any case, then what is done under a condition and what otherwise."""
    parts = split_condition(sentence, opens)
    if parts is None:
        return _before_after(sentence, opens)
    condition = _trim(parts.condition)
    if is_rule(condition):
        # A rule for later ("if you see smoke, stop and tell me") is kept whole.
        return [Clause(_trim(parts.then), condition=condition)]
    result = _before_after(_trim(parts.before), opens) if parts.before else []
    for words, otherwise in ((parts.then, False), (parts.otherwise, True)):
        for index, clause in enumerate(_conditional(_trim(words), opens) if words else ()):
            hanging = replace(
                clause,
                condition=condition,
                conditional=True,
                otherwise=otherwise,
                late=parts.late,
                anew=not index,
            )
            result.append(clause if clause.condition or clause.conditional else hanging)
    return result


def _bare_verb_noun(flat: tuple[str, ...], index: int) -> bool:
    return flat[index - 1] in lexicon().determiners | {"to", "of"}


_VIA = (
    ("via",),
    ("by", "way", "of"),
    ("passing", "by"),
    ("passing",),
    ("stopping", "at"),
    ("stopping", "by"),
    ("with", "a", "stop", "at"),
)
_ON_THE_WAY = (("on", "your", "way", "to"), ("on", "the", "way", "to"), ("on", "your", "way", "back", "to"))


def _on_the_way(sentence: Phrase) -> tuple[Phrase, Phrase] | None:
    """For "go to A via B" and "visit B on your way to A": B, then A."""
    flat = keys(strip_openers(sentence))
    sentence = strip_openers(sentence)
    for way in _ON_THE_WAY:
        # "On your way to A (,) visit B": B first.
        start = len(way)
        if flat[:start] != way:
            continue
        cut = next((i for i in range(start + 1, len(flat)) if flat[i] == ","), 0)
        cut = cut or next((i for i in range(start + 1, len(flat)) if _opens_verb(sentence[i:])), 0)
        if cut:
            return _trim(sentence[cut:]), (Word("visit", "visit"), *_trim(sentence[start:cut]))
    markers: tuple[tuple[str, ...], ...] = (*_VIA, *_ON_THE_WAY)
    for index in range(1, len(flat) - 1):
        for marker in markers:
            size = len(marker)
            if flat[index : index + size] != marker or index + size >= len(flat):
                continue
            before, after = sentence[:index], sentence[index + size :]
            if flat[index - 1] in {"without", "not"}:
                return None
            visit = (Word("visit", "visit"), *after)
            if marker not in _VIA:
                return before, visit
            cut = next((i for i in range(1, len(after)) if after[i].key in {",", "then"}), len(after))
            return visit[: cut + 1], (*before, *after[cut:])
    return None


def _opens_verb(words: Phrase) -> bool:
    """Whether an order begins here that cannot be a noun ("stop at", "inspect", "go")."""
    found = lexicon().verbs.match(keys(words))
    return found is not None and opens_command(words) and (found[0] > 1 or not found[1].startswith("other:"))


def _before_after(sentence: Phrase, opens: Opens) -> list[Clause]:
    passed = _on_the_way(sentence)
    if passed is not None and opens(passed[0]) and opens(passed[1]):
        return [clause for part in passed for clause in _cut(_trim(part), opens)]
    flat = keys(sentence)
    lead = strip_openers(sentence)
    lead_flat = keys(lead)
    event = _event(lead, opens)
    if event[1]:
        wait = (Word("wait", "wait"), Word("until", "until"), *_trim(lead[event[0] : event[1]]))
        return [Clause(wait), *_cut(_trim(lead[event[1] :]), opens)]
    if _sets_order(lead_flat):
        cut = next((i for i in range(2, len(lead)) if lead_flat[i] == ","), 0) or next(
            (i for i in range(3, len(lead)) if opens(lead[i:]) and not _bare_verb_noun(lead_flat, i)), 0
        )
        if cut:
            head = _trim(_without_you(lead[3 if lead_flat[0] == "as" else 1 : cut]))
            main = _cut(_trim(lead[cut:]), opens)
            first = _cut(_with_verb(head, opens), opens)
            return [*main, *first] if lead_flat[0] == "before" else [*first, *main]
    for marker in ("before", "after"):
        for index in range(2, len(flat) - 1):
            if flat[index - 1] == "one" and flat[index + 1] in {"another", "the"}:
                # "One after another".
                continue
            then = (
                marker == "after" and flat[index - 1] in {"and", ","} and _opens_verb(sentence[index + 1 :])
            )
            if then and not flat[index + 1].endswith("ing"):
                # "A and after do B".
                done = _cut(_trim(sentence[: index - 1]), opens)
                return [*done, *_before_after(_trim(sentence[index + 1 :]), opens)]
            if flat[index] == marker and flat[index + 1] not in {"that", "this", "all", ","}:
                clock = is_clock(flat[index + 1 :]) and not {"never", "not"} & set(flat[:2])
                if clock or (marker == "before" and flat[index + 1] == "i"):
                    # "Before nine", "before I go home": no order, and what is told keeps its time.
                    return _cut(_trim(sentence if clock and not opens(sentence) else sentence[:index]), opens)
                main = _cut(_trim(sentence[:index]), opens)
                other = _cut(_with_verb(_trim(_without_you(sentence[index + 1 :])), opens), opens)
                return [*main, *other] if marker == "before" else [*other, *main]
    return _cut(sentence, opens)


def _event(words: Phrase, opens: Opens) -> tuple[int, int]:
    """For "when A leaves, V": where the event that is waited for begins and ends; (0, 0) if there is none."""
    flat = keys(words)
    start = next((len(m) for m in (("when",), ("once",), ("as", "soon", "as")) if flat[: len(m)] == m), 0)
    if not start or flat[start : start + 1] in {("you",), ("that",), ("this",), ("it",), ("i",), ("we",), ()}:
        return 0, 0
    comma = next((i for i in range(start + 2, len(flat)) if flat[i] == ","), 0)
    happens = any(word.key.endswith("s") and lemma(word.key) != word.key for word in words[start + 1 : comma])
    calm = set(flat[start:comma]) & lexicon().be
    told = happens and not calm and comma and not opens(words[start:comma])
    return (start, comma) if told and opens(words[comma + 1 :]) else (0, 0)


def _sets_order(flat: tuple[str, ...]) -> bool:
    """Whether a sentence begins with what comes before or after something else."""
    if flat[:1] in {("before",), ("after",), ("once",)}:
        return flat[1:2] != ("that",)
    return flat[:2] in {("as", "soon"), ("when", "you")}


def _with_verb(words: Phrase, opens: Opens) -> Phrase:
    """For "After the desk, ...": a place without verb is one to visit."""
    if (
        opens(words)
        or not words
        or words[0].key in lexicon().question_starts
        or read_statement(words) is not None
    ):
        return words
    return (Word("visit", "visit"), *words)


_BEEN = frozenset(
    ("been", way) for way in ("to", "at", "in", "round", "around", "by", "past", "through", "over")
)


def _without_you(words: Phrase) -> Phrase:
    flat = keys(words)
    if flat[:1] in {("you",), ("i",), ("we",)}:
        skip = 2 if flat[1:2] and flat[1] in lexicon().auxiliaries | lexicon().be else 1
        words = words[skip:]
        if keys(words[:2]) in _BEEN:
            return (Word("visit", "visit"), *words[2:])
        # "Once you have inspected it": what is done is meant.
        return (Word(lemma(words[0].key), lemma(words[0].key)), *words[1:]) if words else words
    return words


_FOLLOWING = due("following", "closing")
_WHEN = due("earlier", "late", "early", "between")
_EARLIER = frozenset(phrases_due("earlier"))


def _said_when(sentence: Phrase, index: int, start: int, opens: Opens) -> tuple[int, str] | None:
    """Whether "before that" or "to finish with" stands here, at the front of what is then to be done."""
    found = _WHEN.match(keys(sentence), index)
    if found is None or (index > start and sentence[index - 1].key not in {",", "and", "but"}):
        return None
    rest = sentence[index + found[0] :]
    return found if rest and (found[1] == "before that" or not rest[0].is_word or opens(rest)) else None


def _cut(sentence: Phrase, opens: Opens) -> list[Clause]:
    """Cut at sequence words, and at commas and conjunctions where a new clause begins."""
    flat = keys(sentence)
    pieces: list[tuple[int, int, str]] = []
    start, index, first = 0, 0, ""
    while index < len(flat):
        found = _FOLLOWING.match(flat, index) or _said_when(sentence, index, start, opens)
        if found is None and flat[index] == "next" and index and flat[index - 1] in {",", "and"}:
            found = 1, "next"
        if (
            found is None
            and flat[index : index + 2] == ("from", "there")
            and index
            and flat[index - 1] == ","
        ):
            found = 2, "from there"
        if found and not (flat[index] == "next" and flat[index + 1 : index + 2] == ("to",)):
            if index > start:
                pieces.append((start, index, first))
            start, first = index + found[0], "one" if found[1] in _EARLIER else ""
            if flat[start : start + 1] == ("there",) and found[1].endswith(("done", "finished")):
                start += 1
            index = start
            continue
        if index > start and flat[index] == "without" and opens(sentence[index + 1 :]):
            pieces.append((start, index, first))
            start, first = index, ""
        if (
            index > start
            and flat[index] in {",", "and", "but", "&", ":"}
            and _new_clause(sentence, start, index, opens)
        ):
            pieces.append((start, index, first))
            start = index + 1
            following = flat[index : index + 3] if flat[index] == "but" else flat[index + 1 : index + 3]
            early = following[:2] == ("but", "first") or (
                "but" in flat[index : index + 2]
                and flat[-1] == "first"
                and not {",", "then"} & set(flat[index + 2 :])
            )
            first = "all" if early else ""
        index += 1
    if len(flat) > start:
        pieces.append((start, len(flat), first))
    trimmed = ((_trim(sentence[a:b]), early) for a, b, early in pieces)
    return [Clause(words, first=bool(early), whole=early == "all") for words, early in trimmed if words]


def _new_clause(sentence: Phrase, start: int, index: int, opens: Opens) -> bool:
    """Whether a clause of its own begins behind the comma or conjunction at `index`."""
    before, rest = sentence[start:index], sentence[index + 1 :]
    if not rest or (sentence[index].key in {"but", ","} and _leaves_out(sentence[:index], rest)):
        return False
    found = lexicon().polite.match(keys(before))
    mistaken = lexicon().corrections.match(keys(before))
    if len(before) in {found[0] if found else 0, mistaken[0] if mistaken else 0}:
        return False
    if keys(strip_openers(before, requests=True)) in _SERIAL_VERBS:
        return False
    if opens(rest) and any(word.is_word for word in before):
        return keys(rest[:1])[0] not in lexicon().person_words
    if _corrects(before, rest, opens) or _is_control_or_count(sentence, index, rest):
        return True
    return _tells_or_asks(sentence[index].key, before, rest)


_TAKING_BACK = frozenset({"i", "or", "no", "wait", "rather", "sorry", "oops", "correction"})


def _corrects(before: Phrase, rest: Phrase, opens: Opens) -> bool:
    """Whether what follows takes back or narrows down what came before."""
    if lexicon().corrections.match(keys(rest)) and keys(rest)[0] in _TAKING_BACK:
        return True
    if rest[0].key in {"just", "only", "but"} and lexicon().prohibitions.match(keys(before)):
        # "Do not go to the box, just to the door": what is wanted instead.
        return True
    head = strip_openers(before, requests=True)
    drops = bool(head) and lemma(head[0].key) in {v.split()[0] for v in lexicon().verb_classes["drop_step"]}
    return keys(rest[:2]) in _THE_REST and (drops or opens(before))


def _is_control_or_count(sentence: Phrase, index: int, rest: Phrase) -> bool:
    """Whether "stop there" and the like follow, or the next of "first A, second B"."""
    if keys(rest[:1]) not in {("go",), ("start",)} and control_of(" ".join(keys(rest))) is not None:
        return True
    counts = keys(rest[:1])[0] in _COUNTING and keys(sentence[:1])[0] in {"first", "firstly"}
    return sentence[index].key == "," and counts


def _tells_or_asks(mark: str, before: Phrase, rest: Phrase) -> bool:
    """Whether a refusal, a question, a wish or a statement follows that stands for itself."""
    flat = keys(strip_openers(rest))
    if flat[:4] == ("i", "do", "not", "mean"):
        return True
    if mark == "," and flat[:2] in {("i", "am"), ("we", "are")} and read_statement(rest) is not None:
        return True
    if flat[:1] == ("not",) or flat[:2] == ("do", "not"):
        return not set(keys(before)) & lexicon().quantifiers
    if flat and flat[0] in lexicon().question_starts and flat[1:2] and flat[1] in lexicon().be:
        return True
    if read_statement(before) is not None:
        wanted = lexicon().wants.match(flat) or lexicon().requests.match(keys(rest))
        return read_statement(rest) is not None or wanted is not None
    wishes = lexicon().wants.match(flat)
    if wishes is not None and wishes[0] < len(flat) and len(before) > 3 and flat[0] in {"i", "we"}:
        return True
    return mark == "," and len(before) <= 3 and read_statement(rest) is not None


def _leaves_out(before: Phrase, rest: Phrase) -> bool:
    """For "all boxes, but skip the red one": an exception and no order of its own."""
    flat = keys(rest[1:] if keys(rest[:1]) == ("but",) else rest)
    return flat[:1] in _SKIPPING and bool(set(keys(before)) & lexicon().quantifiers)


_COUNTING = frozenset(
    {"second", "secondly", "third", "thirdly", "fourth", "fifth", "finally", "lastly", "last"}
)
_SKIPPING = frozenset({("skip",), ("omit",), ("exclude",), ("ignore",), ("leave",)})
_THE_REST = frozenset(
    {("the", "rest"), ("the", "others"), ("everything", "else"), ("nothing", "else"), ("all", "else")}
)
_SERIAL_VERBS = frozenset((verb,) for verb in ("go", "come", "run", "hurry", "drive", "head", "try"))


def _trim(words: Phrase) -> Phrase:
    while words and (not words[0].is_word or words[0].key in {"and", "then", "but"}):
        words = words[1:]
    while words and (not words[-1].is_word or words[-1].key in {"and", "then", "but"}):
        words = words[:-1]
    return words
