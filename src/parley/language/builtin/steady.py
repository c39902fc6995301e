"""Whether a reading is steady: a word of courtesy before a message must change nothing of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from parley.language.builtin.folding import folded, requested
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading, read
from parley.language.builtin.retyping import PLACING
from parley.language.builtin.spans import Parse, parse
from parley.language.builtin.tagger import Scores, Tagger
from parley.language.builtin.tokens import Token

__all__ = ["Names", "named", "steadily"]

Names = Sequence[tuple[str, ...]]
"""Names of several words, in small letters; the longest first."""


def steadily(
    tagger: Tagger, tokens: Sequence[Token], lexicon: Lexicon, known: Names = ()
) -> tuple[Parse, Reading]:
    """What words are and say, with those that would say something else behind a "please".

    If there are such, more openers are tried: the mean of all is what it says, if most of them say the same.
    The words of a name that is known are no verbs, whatever they are elsewhere.
    """
    words, called = _written_out(tokens), named(tokens, known)
    plain = tagger.tag(words, called)
    found, reading = _read(tokens, plain, lexicon)
    polite = _behind(tagger, "okay" if words[0].lower() == "please" else "please", words, called)
    readings = [reading, _read(tokens, polite, lexicon)[1]]
    said = [_said(one, lexicon) for one in readings]
    if said[0] != said[1] and reading.acts == {"told"}:  # "please I left my box here" is no sentence
        readings[1] = _read(tokens, _behind(tagger, "well", words, called), lexicon)[1]
        said[1] = _said(readings[1], lexicon)
    if said[0] == said[1]:
        return found, replace(reading, unsteady=())
    more = [_behind(tagger, opener, words, called) for opener in ("now", "so", "robot")]
    every = [plain, polite, *more]
    if len({len(scores.act) for scores in every}) > 1:  # longer than the tagger reads
        return found, replace(reading, unsteady=_differing(said, lexicon))
    readings += [_read(tokens, scores, lexicon)[1] for scores in more]
    said += [_said(one, lexicon) for one in readings[len(said) :]]
    settled, meant = _read(tokens, _mean(every), lexicon)
    most = _said(meant, lexicon)
    same = sum(one == most for one in said)
    missed = sum(one < most and bool(reads.left_over) for one, reads in zip(said, readings, strict=True))
    if same > len(said) // 2 and same + missed >= _AGREEING:
        return settled, replace(meant, unsteady=())
    return found, replace(reading, unsteady=_differing(said, lexicon))


_AGREEING = 4
"""So many of the readings say the same, or miss a part of it and know that words are left over."""


def _differing(said: Sequence[frozenset[tuple[int, str, str]]], lexicon: Lexicon) -> tuple[str, ...]:
    """What plain words say and polite ones do not."""
    words = (words for _, words, *_ in sorted(said[0] ^ said[1]))
    return tuple(dict.fromkeys(word for word in words if word not in lexicon.classes["manner"]))


def _read(tokens: Sequence[Token], scores: Scores, lexicon: Lexicon) -> tuple[Parse, Reading]:
    found = folded(requested(parse(tuple(tokens), scores), lexicon), lexicon)
    return found, read(found, lexicon)


def _written_out(tokens: Sequence[Token]) -> list[str]:
    """The words as the tagger knows them: "Kim's at the desk" is "Kim is at the desk"."""
    behind = [token.low for token in tokens[1:]] + [""]
    pairs = zip(tokens, behind, strict=True)
    return [
        "is" if token.low == "'s" and after in PLACING | {"here", "there"} else token.text
        for token, after in pairs
    ]


def named(tokens: Sequence[Token], known: Names) -> list[tuple[int, int]]:
    """From where to where a known name of several words stands; a longer one hides those in it."""
    low, found, at = [token.low for token in tokens], [], 0
    while at < len(low):
        size = next((len(name) for name in known if (*low[at : at + len(name)],) == name), 0)
        found += [(at, at + size)] if size else []
        at += size or 1
    return found


def _behind(tagger: Tagger, opener: str, words: Sequence[str], named: Sequence[tuple[int, int]]) -> Scores:
    """The scores of words behind an opener, without its own."""
    scores = tagger.tag([opener, *words], [(start + 1, end + 1) for start, end in named])
    cut = {field.name: getattr(scores, field.name)[1:] for field in fields(Scores)}
    return Scores(**cut | {"arcs": np.delete(cut["arcs"], 1, axis=1)})


def _mean(every: Sequence[Scores]) -> Scores:
    return Scores(*(np.mean([getattr(one, field.name) for one in every], axis=0) for field in fields(Scores)))


def _said(reading: Reading, lexicon: Lexicon) -> frozenset[tuple[int, str, str]]:
    """Where each verb stands, with its words and its frame; and of all that fills its roles."""
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    found = set()
    for wish in reading.wishes:
        put = wish.act == "told" and wish.frame in ("PUT", "BELOC")  # "I left it on the desk": it is there
        found.add((wish.start, wish.verb, f"{'BELOC' if put else wish.frame} {wish.negated}"))
        whole_roles = "TLG" if put else "TL"
        told = sorted((f for f in wish.fillers if f.role in whole_roles), key=lambda filler: filler.start)
        for filler in wish.fillers:
            words = " ".join(word for word in filler.words if word not in small)
            if filler.role not in f"AM{whole_roles}" and words and words not in lexicon.classes["me"]:
                found.add((wish.start, words, filler.role))
        whole = " ".join(word for f in told for word in f.words if word not in small)
        if whole:
            found.add((wish.start, whole, "T"))
    return frozenset(found)
