"""Noun phrases: what is named, by which words, and where it is said to be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular

__all__ = ["NounPhrase", "bare", "beside_at", "coordinated", "noun_phrase", "number_of", "split_exception"]


@dataclass(frozen=True, slots=True)
class NounPhrase:
    """A noun phrase cut into its parts; compared words are singular and lower case."""

    phrase: Phrase
    """As written, without determiner and without what only politeness adds."""
    core: tuple[str, ...]
    """The words before any place: modifiers, then the head noun last."""
    relation: str = ""
    """Preposition of place, if any."""
    anchors: tuple[Phrase, ...] = ()
    """What the relation refers to; two for "between"."""
    quantifier: str = ""
    excluded: Phrase = ()
    """After "except"."""

    @property
    def text(self) -> str:
        """As written, without determiner."""
        return plain(self.phrase)


_EXCEPT = (
    "but leave out",
    "and leave out",
    "leave out",
    "leaving out",
    "but skip",
    "but omit",
    "but exclude",
    "but ignore",
    "skip",
    "and skip",
    "excepting",
    "with the exception of",
    "minus",
    "except for",
    "except",
    "but not",
    "apart from",
    "other than",
    "besides",
    "excluding",
    "aside from",
    "but",
)
_THAT_ARE_NOT = ("that is not", "that are not", "which is not", "which are not", "who are not")
_SUPERLATIVES = frozenset({"nearest", "closest", "farthest", "furthest"})
_RELATIVE = frozenset({"that", "which", "who", "where"})


def bare(phrase: Phrase) -> Phrase:
    """Without punctuation and fillers around it and without determiners before it."""
    lex = lexicon()
    words = list(phrase)
    while True:
        while words and not words[-1].is_word:
            words.pop()
        size = lex.adverbs.match_end(keys(words))
        if not size or size >= len(words):
            break
        sided = words[-1].key == "right" or words[-1].key in lex.ordinals
        if size == 1 and sided and words[-2].key in lex.determiners | {"far", "very"} - {"a"}:
            # "The door on the right": a side, no manner.
            break
        words = words[:-size]
    while words and (not words[0].is_word or words[0].key in lex.determiners):
        # A lone letter after a noun is a name ("area A"), at the start it is the article.
        if len(words) == 1 and words[0].is_word:
            break
        words.pop(0)
    return tuple(words)


def _sided(phrase: Phrase) -> Phrase:
    """For "the desk to your right", "... furthest to the east": "the desk on your right", "... far east".

    That is where it is, and not where to go.
    """
    phrase = _outermost(phrase)
    flat = keys(phrase)
    at = len(flat) - 1 - (flat[-1:] in {("side",), ("end",)})
    if at < 2 or flat[at] not in _DIRECTIONS:
        return phrase
    lead = at - (flat[at - 1] in {"the", "your"})
    to = lead - (lead > 0 and flat[lead - 1] in {"to", "towards", "toward"})
    most = to - (to > 0 and flat[to - 1] in _SUPERLATIVES | {"most", "far"})
    placed = flat[most - 1] in lexicon().determiners | {"on", "at", "in"}
    if (most == to and (to == lead or lead == at)) or most < 1 or placed:
        return phrase
    far = most < to and flat[at] in {"left", "right"}
    side = (Word("far", "far"), phrase[at]) if far else phrase[at:]
    return (*phrase[:most], Word("on", "on"), *(phrase[lead:at] or (Word("the", "the"),)), *side)


def _outermost(phrase: Phrase) -> Phrase:
    """For "the most northern desk" "the northernmost desk"."""
    flat = keys(phrase)
    at = next((i for i in range(len(flat) - 1) if flat[i] == "most" and flat[i + 1][:-3] in _DIRECTIONS), -1)
    if at < 0 or not flat[at + 1].endswith("ern"):
        return phrase
    word = Word(f"{flat[at + 1]}most", f"{flat[at + 1]}most")
    return (*phrase[:at], word, *phrase[at + 2 :])


_DIRECTIONS = frozenset({
    "left", "right", "north", "south", "east", "west", "north-east", "north-west", "south-east", "south-west",
    "northeast", "northwest", "southeast", "southwest",
})  # fmt: skip
_BEFORE_PLACE = frozenset({
    "just", "right", "directly", "immediately", "straight", "standing", "located", "situated", "sitting",
    "lying", "parked", "placed", "somewhere", "stands", "lies", "sits",
})  # fmt: skip


@lru_cache(maxsize=8192)
def noun_phrase(phrase: Phrase) -> NounPhrase:
    """Read a noun phrase."""
    lex = lexicon()
    excluded: Phrase = ()
    flat = keys(phrase)
    quantified = bool(set(flat[:2]) & lex.quantifiers)
    for marker in (*_EXCEPT, *(_THAT_ARE_NOT if quantified else ())):
        at = _find(flat, tuple(marker.split()))
        if at > 0:
            left_out = phrase[at + len(marker.split()) :]
            counted = keys(left_out[-1:]) and (left_out[-1].key in lex.ordinals or left_out[-1].key == "last")
            phrase, excluded = phrase[:at], left_out[-1:] if counted else bare(left_out)
            break
    phrase = _partitive(bare(_sided(phrase)))
    quantifier = ""
    while phrase and (phrase[0].key in lex.quantifiers | lex.free_choice or _is_rest(phrase)):
        quantifier = quantifier or ("rest" if _is_rest(phrase) else phrase[0].key)
        counted = _is_rest(phrase) and keys(phrase[1:2])[:1] and phrase[1].key in lex.numbers
        phrase = bare(_without_of(phrase[2 if counted else 1 :]))
    cut, size = _first_relation(phrase)
    core_words = _without_link(phrase[:cut]) if cut < len(phrase) else phrase
    core = tuple(number_of(singular(word.key)) for word in core_words if word.is_word)
    if cut == len(phrase):
        return NounPhrase(phrase, core, quantifier=quantifier, excluded=excluded)
    relation = " ".join(keys(_without_relative(phrase[cut : cut + size])))
    relation = "with" if relation.endswith((" has", " have", " had")) else relation
    rest = bare(phrase[cut + size :])
    anchors = tuple(coordinated(rest)) if "between" in relation else (rest,)
    if relation.startswith("halfway"):
        relation = "between"
    return NounPhrase(phrase, core, relation, anchors, quantifier, excluded)


def _without_relative(words: Phrase) -> Phrase:
    """For "that is on", "which lies to" "on", "to"."""
    if words[0].key not in {"that", "which"} or len(words) < 3:
        return words
    rest = words[2:]
    while len(rest) > 1 and rest[0].key in _BEFORE_PLACE:
        rest = rest[1:]
    return rest


def beside_at(flat: tuple[str, ...], at: int) -> int:
    """Where "next to", "lying in" and the like end, which only tell where a thing is; `at` if none begins."""
    lying = at + (flat[at : at + 1] != () and flat[at] in _RESTING)
    found = lexicon().places.match(flat, lying)
    return at if found is None or (lying == at and found[1] in _AT_PLACE) else lying + found[0]


_RESTING = frozenset({"standing", "located", "situated", "sitting", "lying", "parked", "hanging", "leaning"})
_AT_PLACE = frozenset({
    "in", "at", "on", "inside", "of", "with", "from", "into", "onto", "upon", "around", "along", "under",
    "underneath", "beneath", "below", "above", "over", "within", "outside", "against", "by", "behind",
})  # fmt: skip


def _without_link(words: Phrase) -> Phrase:
    """Without what stands between a thing and its place: "the bin that is (right behind A)"."""
    while len(words) > 1 and words[-1].key in _BEFORE_PLACE:
        words = words[:-1]
    related = keys(words[-2:-1]) in {("that",), ("which",)} and words[-1].key in lexicon().be
    return words[:-2] if related and len(words) > 2 else words


def split_exception(phrase: Phrase) -> tuple[Phrase, Phrase]:
    """What is named, and what is left out of it ("except ..."), with its marker."""
    flat = keys(phrase)
    for marker in _EXCEPT:
        at = _find(flat, tuple(marker.split()))
        if at > 0:
            return phrase[:at], phrase[at:]
    return phrase, ()


def _is_rest(phrase: Phrase) -> bool:
    """Whether it begins like "rest of ...", "remaining boxes", "other boxes"."""
    if phrase[0].key in {"rest", "remaining", "others"}:
        return True
    head = next((w.key for w in reversed(phrase) if w.is_word), "")
    if (
        phrase[0].key == "other"
        and len(phrase) > 1
        and (phrase[1].key in lexicon().numbers and phrase[1].key != "one")
    ):
        return True
    return phrase[0].key == "other" and len(phrase) > 1 and singular(head) != head and head != "ones"


_COMPARING = frozenset(
    [
        "bigger",
        "biggest",
        "larger",
        "largest",
        "smaller",
        "smallest",
        "nearer",
        "nearest",
        "closer",
        "closest",
        "farther",
        "farthest",
        "furthest",
        "taller",
        "tallest",
        "newer",
        "older",
        "left",
        "right",
        "leftmost",
        "rightmost",
    ]
)
_AS_SUPERLATIVE = {"nearer": "nearest", "closer": "closest", "farther": "farthest"}


def _partitive(phrase: Phrase) -> Phrase:
    """For "the bigger of the two boxes" "bigger box", for "one of the boxes" "any box"."""
    flat = keys(phrase)
    if len(flat) < 3 or flat[1] != "of" or flat[0] not in _COMPARING | {"one", "any", "either"}:
        return phrase
    rest = phrase[2:]
    while len(rest) > 1 and (rest[0].key in lexicon().determiners or rest[0].key in lexicon().numbers):
        rest = rest[1:]
    if flat[0] in {"one", "any", "either"}:
        if singular(rest[-1].key) == rest[-1].key:
            return phrase
        return (replace(phrase[0], key="any", raw="any"), *_as_singular(rest))
    word = _AS_SUPERLATIVE.get(flat[0], flat[0])
    return (replace(phrase[0], key=word, raw=word), *_as_singular(rest))


def _as_singular(phrase: Phrase) -> Phrase:
    last = phrase[-1]
    return (*phrase[:-1], replace(last, key=singular(last.key), raw=singular(last.raw)))


def number_of(word: str) -> str:
    """Numerals as digits ("two", "second" -> "2"); "one" stays, it also means a thing."""
    lex = lexicon()
    if word in lex.ordinals:
        return str(lex.ordinals[word])
    if word in lex.numbers and word != "one":
        return str(lex.numbers[word])
    return word


def coordinated(phrase: Phrase) -> list[Phrase]:
    """The members of "A, B and C", each without its determiner."""
    members: list[Phrase] = []
    current: list[int] = []
    for index, word in enumerate(phrase):
        if word.key in {"and", ",", "or", "&", "plus"}:
            if current:
                members.append(bare(tuple(phrase[i] for i in current)))
            current = []
        else:
            current.append(index)
    if current:
        members.append(bare(tuple(phrase[i] for i in current)))
    return [cleared for member in members if (cleared := _without_also(member))]


def _without_also(member: Phrase) -> Phrase:
    """For "(A and) also the desk" the desk."""
    while len(member) > 1 and member[0].key in {
        "also",
        "then",
        "even",
        "maybe",
        "perhaps",
        "especially",
        "finally",
    }:
        member = bare(member[1:])
    return member


def _first_relation(phrase: Phrase) -> tuple[int, int]:
    """Where the first preposition of place stands and how many words it has; the length if there is none."""
    lex = lexicon()
    flat = keys(phrase)
    for index in range(len(phrase)):
        if flat[index] in _RELATIVE and index > 0:
            # "the one that is by the window" reads like "the one by the window".
            skip = index + 1
            if flat[skip : skip + 1] in {("has",), ("have",), ("had",)} and skip + 1 < len(flat):
                # "The one that has a lid" reads like "the one with a lid".
                return index, 2
            while skip < len(flat) and flat[skip] in lex.be | lex.location_verbs:
                skip += 1
            found = lex.places.match(flat, skip)
            if found:
                return index, skip - index + found[0]
        if flat[index] in lex.location_verbs and index > 0 and flat[index - 1] not in lex.determiners:
            found = lex.places.match(flat, index + 1)
            if found:
                return index, 1 + found[0]
        if (
            index
            and flat[index] in {"nearest", "closest"}
            and index + 1 < len(flat)
            and flat[index + 1] in lex.determiners | {"area", "gate"}
        ):
            # "The chair nearest the door".
            return index, 1
        if flat[index] in _SUPERLATIVES and flat[index + 1 : index + 2] not in {
            ("to",),
            ("from",),
            ("away",),
            (),
        }:
            continue
        found = lex.places.match(flat, index)
        if found and flat[index] not in {"of"} and index + found[0] < len(flat):
            return index, found[0]
    return len(phrase), 0


def _without_of(phrase: Phrase) -> Phrase:
    return phrase[1:] if phrase and phrase[0].key == "of" else phrase


def _find(flat: tuple[str, ...], wanted: tuple[str, ...]) -> int:
    for index in range(len(flat) - len(wanted) + 1):
        if flat[index : index + len(wanted)] == wanted:
            return index
    return -1
