"""Messages with names put so that the rest can read them: what is left out, said apart or said twice.

"Check 2 and 3" gets its zones, "the red one, that is mine" one subject, "where A is, there you go" an order,
"order 17 is late" an article, so that it is no order to buy something.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import read_statement
from parley.language.offline.facts.owning import with_owners_named
from parley.language.offline.scene.grounding import describe
from parley.language.offline.scene.labels import with_kinds
from parley.language.offline.scene.missing import left_by_somebody
from parley.language.offline.scene.owned import owned_thing
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.sought import only_looks
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.finite import dislocated, has_verb, joined_lines, verb_at
from parley.language.offline.sentences.rounds import as_round
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, tokens

__all__ = ["plainly_named"]

_MARKS = frozenset({".", "!", "?", ";", "\n"})
_LEFT_OUT = (("of", "interest"), ("of", "ours"), ("on", "our", "list"), ("in", "question"))
_TAILS = tuple(
    tuple(text.split())
    for text in (
        "is not it",
        "are not they",
        "is it not",
        "was not it",
        "does not it",
        "do not they",
        "is not he",
        "is not she",
        "if i asked you to",
        "if i asked you",
        "if i asked",
        "if you had to",
        "if you must",
        "if necessary",
        "if need be",
        "if i ask you to",
        "if you were asked to",
        "if needed",
        "if i told you to",
        "if you wanted to",
        "if you wanted",
        "if i wanted you to",
        "if i said so",
        "if push came to shove",
    )
)
_SEARCHING = (
    ("i", "am", "looking", "for"),
    ("we", "are", "looking", "for"),
    ("i", "am", "searching", "for"),
    ("we", "are", "searching", "for"),
    ("i", "am", "after"),
    ("we", "are", "after"),
    ("what", "i", "am", "looking", "for", "is"),
)


def plainly_named(words: Phrase, scene: Scene) -> Phrase:
    """The message with all that is named put plainly.

    Args:
        words: All words and punctuation.
        scene: What is known.
    """
    before = [turn.content for turn in scene.situation.history[-4:]]
    words = _without_neither(_without_tail(_without_left_out(words, scene)))
    words = _without_hesitation(_without_never_mind(joined_lines(words)))
    words = _able(_forgetting(_where_first(dislocated(words))))
    words, used = with_owners_named(_each_state(words), scene.facts)
    for fact in used:
        scene.use(fact)
    words = _owned(words, scene)
    words = with_kinds(as_round(words), scene.objects, before)
    return _as_names(_left(_reporting(_searching(words)), scene), scene)


def _without_left_out(words: Phrase, scene: Scene) -> Phrase:
    """Without "of interest" and the like, unless something is called so."""
    flat = keys(words)
    names = {part for item in scene.objects for part in item.description.lower().split()}
    for tail in _LEFT_OUT:
        at = next((i for i in range(1, len(flat)) if flat[i : i + len(tail)] == tail), 0)
        if at and not set(tail) & names:
            words = (*words[:at], *words[at + len(tail) :])
            flat = keys(words)
    return words


def _without_tail(words: Phrase) -> Phrase:
    """Without "if I asked you to" at the end."""
    body = words[:-1] if words and not words[-1].is_word else words
    flat = keys(body)
    tail = next((tail for tail in _TAILS if flat[-len(tail) :] == tail and len(flat) > len(tail) + 2), ())
    if not tail:
        return words
    cut = body[: -len(tail)]
    if flat[:2] in {("could", "you"), ("can", "you"), ("would", "you")}:
        cut = (*_words("are you able to"), *cut[2:])
    elif "you" in tail and opens_command(cut):
        # "(Could you) lift a box if you had to": what only could be is asked about.
        cut = (*_words("are you able to"), *cut)
    return (*(cut[:-1] if cut[-1].key == "," else cut), *words[len(body) :])


def _without_neither(words: Phrase) -> Phrase:
    """For "that is neither A nor B" "that is not A or B"."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] == "neither" and flat[i - 1] in lexicon().be), 0)
    nor = flat.index("nor", at) if at and "nor" in flat[at:] else 0
    if not nor or flat[at - 2] not in {"that", "which", "who"}:
        return words
    return (*words[:at], Word("not", "not"), *words[at + 1 : nor], Word("or", "or"), *words[nor + 1 :])


def _where_first(words: Phrase) -> Phrase:
    """For "where A is, there you go" "go to where A is"."""
    flat = keys(words)
    comma = flat.index(",") if "," in flat else 0
    if flat[:1] not in {("where",), ("wherever",)} or not 2 < comma < 8:
        return words
    rest = flat[comma + 1 :]
    if "go" not in rest[:4] or not set(rest[:4]) & {"there", "you"} or "?" in rest:
        return words
    at = rest.index("go")
    behind = words[comma + 2 + at :]
    behind = behind[1:] if keys(behind[:1]) == ("there",) else behind
    return (*_words("go to where"), *words[1:comma], *behind)


_DROPPING = frozenset(
    {
        "scrap",
        "disregard",
        "ignore",
        "drop",
        "cancel",
        "delete",
        "erase",
        "dismiss",
        "strike",
        "discard",
        "wipe",
        "remove",
        "unlearn",
        "scratch",
        "clear",
        "bin",
        "lose",
        "cross",
    }
)
_NEEDLESS = tuple(
    tuple(text.split())
    for text in (
        "you do not need to remember",
        "you do not have to remember",
        "no need to remember",
        "there is no need to remember",
        "you need not remember",
        "stop remembering",
        "you can stop remembering",
        "you no longer need to remember",
        "you no longer have to remember",
        "do not bother remembering",
        "you do not need to keep in mind",
        "you may forget",
        "it is ok to forget",
        "it is okay to forget",
    )
)
_NOTES = frozenset(
    {
        "information",
        "info",
        "fact",
        "facts",
        "note",
        "notes",
        "memory",
        "memories",
        "entry",
        "knowledge",
        "data",
        "bit",
        "thing",
        "things",
        "stuff",
        "part",
        "story",
        "news",
        "line",
        "point",
        "remark",
        "detail",
        "details",
    }
)
_NO_LONGER = (("any", "longer"), ("any", "more"), ("anymore",), ("now",))


def _without_never_mind(words: Phrase) -> Phrase:
    """Without "never mind the box" before something else."""
    flat = keys(words)
    if flat[:2] != ("never", "mind") or len(flat) < 4:
        return words
    end = next((i for i in range(2, len(flat)) if not words[i].is_word), len(flat))
    rest = words[end + 1 :]
    return rest if 2 < end < 9 and len(rest) > 2 else words


_WAITING = (
    ("no", ",", "wait", ","),
    ("no", "wait", ","),
    ("wait", ","),
    ("no", "wait"),
    ("hang", "on", ","),
    ("hold", "on", ","),
    ("oh", "wait", ","),
    ("oh", ",", "wait", ","),
)


def _without_hesitation(words: Phrase) -> Phrase:
    """Without "no, wait," before a statement that corrects another."""
    flat = keys(words)
    lead = next((lead for lead in _WAITING if flat[: len(lead)] == lead), ())
    rest = words[len(lead) :]
    fact = read_statement(rest) if lead else None
    return rest if fact is not None and not opens_command(rest) else words


def _forgetting(words: Phrase) -> Phrase:
    """For "scrap what I said about A" and "drop that bit about A" "forget what I told you about A"."""
    flat = keys(words)
    needless = next((lead for lead in _NEEDLESS if flat[: len(lead)] == lead), ())
    if needless and len(flat) > len(needless):
        rest = words[len(needless) :]
        tail = next((tail for tail in _NO_LONGER if keys(rest)[-len(tail) :] == tail), ())
        return (*_words("forget about"), *(rest[: len(rest) - len(tail)] if tail else rest))
    words = _told_and_forgotten(words)
    flat = keys(words)
    listed = next(
        (i for i in range(2, len(flat) - 2) if flat[i : i + 2] in _YOUR and flat[i + 2] in _FROM_MEMORY), 0
    )
    if listed and flat[0] in _DROPPING and not {"step", "steps", "stop", "stops"} & set(flat):
        return (*_words("forget what i told you about"), *words[1:listed])
    for index in range(len(flat) - 3):
        if flat[index] not in _DROPPING | {"forget"}:
            continue
        about = next((i for i in range(index + 2, min(index + 12, len(flat) - 1)) if flat[i] in _ABOUT), 0)
        between = set(flat[index + 1 : about])
        noted = bool(between & (_NOTES | _SAID)) or (flat[index] in _WIPING and bool(between & _EVERYTHING))
        if about and noted and between <= _NOTES | _SAID | _EVERYTHING | _AROUND_NOTES:
            lead = words[:index] if keys(words[:index]) not in _ALLOWING else ()
            end = next((i for i in range(about + 1, len(flat)) if not words[i].is_word), len(flat))
            rest = _without_from_memory(words[about + 1 : end])
            return (*lead, *_words("forget what i told you about"), *rest, *words[end:])
    return words


def _told_and_forgotten(words: Phrase) -> Phrase:
    """For "A was fetched, so you can delete that" "forget what I told you about A"."""
    body = _without_from_memory(words[:-1] if words and not words[-1].is_word else words)
    flat = keys(body)
    verb = len(flat) - 2
    if verb < 4 or flat[verb] not in _DROPPING | {"forget"} or flat[-1] not in {"that", "it", "this"}:
        return words
    cut = verb
    while cut and flat[cut - 1] in _ALLOWED:
        cut -= 1
    head = body[:cut]
    if "about" in keys(head) and {"told", "said"} & set(keys(head)):
        return head
    fact = read_statement(head) if cut < verb or flat[cut - 1] == "," else None
    if fact is None or opens_command(head):
        return words
    return (*_words("forget what i told you about"), *fact.subject)


_ALLOWED = frozenset(
    {"so", ",", "you", "can", "may", "please", "and", "just", "should", "now", "kindly", "therefore"}
)
_ABOUT = frozenset({"about", "on", "regarding", "concerning", "of"})
_SAID = frozenset({"said", "told", "mentioned", "say", "know", "remember", "heard", "learned", "wrote"})
_EVERYTHING = frozenset({"everything", "all", "anything", "whatever"})
_WIPING = frozenset({"wipe", "erase", "delete", "forget"})
_AROUND_NOTES = frozenset({
    "the", "that", "this", "your", "my", "of", "what", "i", "we", "you", "were", "was", "have", "has", "had",
    "been", "just", "earlier", "ever", "out", "off", "away", "those", "these", "any", "in", "memory", "to",
    "they", "he", "she", "somebody", "whole", "from",
})  # fmt: skip
_YOUR = (("off", "your"), ("from", "your"), ("off", "the"), ("out", "of"))
_FROM_MEMORY = frozenset({"memory", "notes", "records", "list", "brain", "head", "books", "files"})


def _without_from_memory(words: Phrase) -> Phrase:
    """Without "from your notes" at the end."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in {"from", "off", "in"}), 0)
    return words[:at] if at and flat[-1] in _FROM_MEMORY and len(flat) - at < 5 else words


_ALLOWING = frozenset(
    {
        ("you", "can"),
        ("you", "may"),
        ("please",),
        ("you", "should"),
        ("you", "can", "also"),
        ("just",),
        ("better",),
    }
)
_TRUTH = (
    ("is", "it", "true", "that", "you", "can"),
    ("is", "it", "correct", "that", "you", "can"),
    ("is", "it", "right", "that", "you", "can"),
    ("they", "say", "you", "can"),
    ("i", "heard", "you", "can"),
    ("is", "it", "true", "you", "can"),
    ("am", "i", "right", "that", "you", "can"),
)


def _able(words: Phrase) -> Phrase:
    """For "is it true that you can V?" "are you able to V?"."""
    flat = keys(words)
    lead = next((lead for lead in _TRUTH if flat[: len(lead)] == lead), ())
    return (*_words("are you able to"), *words[len(lead) :]) if lead and flat[-1:] == ("?",) else words


_ASKING = frozenset({"know", "check", "see", "out", "me", "verify", "confirm", "tell", "ascertain", "look"})


def _each_state(words: Phrase) -> Phrase:
    """For "find out if A is ready and whether B is free" two sentences."""
    flat = keys(words)
    first = next(
        (i for i in range(1, len(flat)) if flat[i] in {"if", "whether"} and flat[i - 1] in _ASKING), 0
    )
    if not first:
        return words
    at = next(
        (i for i in range(first + 3, len(flat) - 3) if flat[i] == "and" and flat[i + 1] == "whether"), 0
    )
    if not at or not has_verb(words[at + 2 :]):
        return words
    return (*words[:at], Word(".", "."), *_words("check whether"), *words[at + 2 :])


def _searching(words: Phrase) -> Phrase:
    """For "..., I am looking for A" "..., look for A"."""
    flat = keys(words)
    for index in range(2, len(flat)):
        lead = next((lead for lead in _SEARCHING if flat[index : index + len(lead)] == lead), ())
        if lead and flat[index - 1] in {",", ".", ";", "and", "because", "as"}:
            cut = index - 1 if flat[index - 1] in {"because", "as"} else index
            return (*words[:cut], *_words("look for"), *words[index + len(lead) :])
    return words


def _reporting(words: Phrase) -> Phrase:
    """For "walk the halls and report anything odd" looking for it."""
    flat = keys(words)
    at = next((i for i in range(2, len(flat) - 2) if flat[i] in _TELLING and flat[i + 1] in _ANYTHING), 0)
    if not at or flat[at - 1] not in {"and", ","} or flat[at + 2] in {"to", "you", "that"}:
        return words
    return (*words[:at], *_words("look for"), *words[at + 1 :])


_TELLING = frozenset({"report", "flag", "note", "spot", "notice"})
_ANYTHING = frozenset({"anything", "any", "anyone", "anybody", "everything"})


def _left(words: Phrase, scene: Scene) -> Phrase:
    """With "somebody put a bag in A" as the order to look for it."""
    if not {"someone", "somebody", "they", "people"} & set(keys(words)):
        return words
    result: list[Word] = []
    start, order = 0, None
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS | {","}:
            continue
        sentence, mark = words[start:index], words[index : index + 1]
        if order and (only_looks(sentence) or _guessed_where(sentence, scene)):
            start = index + 1
            continue
        order = left_by_somebody(sentence, scene) if keys(mark) != ("?",) else None
        result += (*(order or sentence), *((Word(".", "."),) if order and mark else mark))
        start = index + 1
    return tuple(result)


def _guessed_where(sentence: Phrase, scene: Scene) -> bool:
    """Whether it only says more exactly where: "apparently under a table", of a place that is not known."""
    at = next((i for i in range(min(3, len(sentence))) if lexicon().places.match(keys(sentence), i)), -1)
    words = {"apparently", "probably", "maybe", "perhaps", "i", "think", "possibly", "likely", "somewhere"}
    led = at > 0 and set(keys(sentence[:at])) <= words
    return led and len(sentence) < 8 and scene.ground(sentence[at + 1 :]).outcome == "none"


def _owned(words: Phrase, scene: Scene) -> Phrase:
    """With "A's car" as the car that is remembered to be A's."""
    if keys(words)[:1] in {(word,) for word in lexicon().question_starts | lexicon().be}:
        return words
    for index, word in enumerate(words):
        if not (word.key.endswith("'s") or word.raw.endswith("s'")):
            continue
        for start in range(max(0, index - 3), index + 1):
            for end in range(min(len(words), index + 4), index + 1, -1):
                span = words[start:end]
                if not all(part.is_word for part in span) or scene.ground(span).outcome == "none":
                    continue
                found = owned_thing(span, scene.objects, scene.facts)
                if found is not None:
                    for fact in found[1]:
                        scene.use(fact)
                    name = tokens(the(describe(found[0], scene.objects)))
                    return (*words[: _article(words, start)], *name, *words[end:])
    return words


def _article(words: Phrase, at: int) -> int:
    return at - 1 if at and words[at - 1].key in {"the", "a", "an"} else at


def _as_names(words: Phrase, scene: Scene) -> Phrase:
    """With an article before names that begin like an order ("order 17 is at A")."""
    result: list[Word] = []
    start = 0
    for index, word in enumerate(words):
        if index == start and word.is_word and _begins_name(words[index : index + 8], scene):
            result.append(Word("the", "the"))
        if word.key in _MARKS | {","}:
            start = index + 1
        result.append(word)
    return tuple(result)


def _begins_name(words: Phrase, scene: Scene) -> bool:
    flat = keys(words)
    if lexicon().verbs.match((lemma(flat[0]), *flat[1:])) is None:
        return False
    verb = verb_at(words)
    if flat[0].endswith("ing") and 1 < verb < 4 and all(word.is_word for word in words[:verb]):
        return flat[1] not in lexicon().determiners | {"to", "for", "at", "on", "in", "it", "me"}
    for size in range(min(5, len(words) - 1), 1, -1):
        known = any(keys(item.fact.subject) == flat[:size] for item in scene.facts)
        ends = flat[size] in lexicon().be | lexicon().auxiliaries | {"never", "needs"}
        if ends and (known or scene.ground(words[:size]).outcome == "match"):
            return True
    return False


def _words(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
