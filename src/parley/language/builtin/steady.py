"""Whether a reading is steady: a word of courtesy before a message must change nothing of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading, read
from parley.language.builtin.requests import requested
from parley.language.builtin.spans import Parse, parse
from parley.language.builtin.tagger import Tagger
from parley.language.builtin.tokens import Token

__all__ = ["steadily"]


def steadily(tagger: Tagger, tokens: Sequence[Token], lexicon: Lexicon) -> tuple[Parse, Reading]:
    """What words are and say, with those that would say something else behind a "please"."""
    words = [token.text for token in tokens]
    found = requested(parse(tuple(tokens), tagger.tag(words)), lexicon)
    reading = read(found, lexicon)
    opener = "okay" if words[0].lower() == "please" else "please"
    again = requested(parse((Token(opener, 0, 0), *tokens), tagger.tag([opener, *words])), lexicon)
    other = _said(read(again, lexicon), lexicon, 1)
    unsteady = sorted(_said(reading, lexicon, 0) ^ other)
    unsure = dict.fromkeys(words for _, words, *_ in unsteady if words not in lexicon.classes["manner"])
    return found, replace(reading, unsteady=tuple(unsure))


def _said(reading: Reading, lexicon: Lexicon, skipped: int) -> frozenset[tuple[int, str, str]]:
    """Where each verb stands, with its words and its frame; and of all that fills its roles."""
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    found = set()
    for wish in reading.wishes:
        found.add((wish.start - skipped, wish.verb, f"{wish.frame} {wish.negated}"))
        told = sorted((f for f in wish.fillers if f.role in "TL"), key=lambda filler: filler.start)
        for filler in wish.fillers:
            words = " ".join(word for word in filler.words if word not in small)
            if filler.role not in "AMTL" and words and words not in lexicon.classes["me"]:
                found.add((wish.start - skipped, words, filler.role))
        whole = " ".join(word for f in told for word in f.words if word not in small)
        if whole:
            found.add((wish.start - skipped, whole, "T"))
    return frozenset(found)
