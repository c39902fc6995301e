"""The other witness: what the lexicon knows of verbs, frames, roles and small words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache

from parley.language.lexicon import load_data, word_map
from parley.umrf.kinds import is_word_for

__all__ = ["Frame", "Lexicon", "is_somebody", "lemmas", "lexicon", "stem", "stems"]

_IRREGULAR = word_map("""took:take taken:take brought:bring went:go gone:go found:find gave:give
given:give told:tell said:say got:get made:make lit:light held:hold seen:see saw:see laid:lay kept:keep
drove:drive came:come sent:send tying:tie lying:lie does:do did:do has:have goes:go""")


_ENDINGS = (
    ("ies", "y"), ("es", ""), ("s", ""), ("ied", "y"), ("ed", ""), ("ed", "e"), ("ing", ""), ("ing", "e"),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Frame:
    """One thing that may be wanted."""

    name: str
    gloss: str
    roles: Mapping[str, str]
    """Role -> type of what fills it."""
    say: str
    """How it is said in a reply."""
    tests: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Lexicon:
    """Frames, the verbs that call them up, and closed classes of words."""

    frames: Mapping[str, Frame]
    verbs: Mapping[tuple[str, ...], frozenset[str]]
    classes: Mapping[str, frozenset[str]]
    hints: Mapping[str, frozenset[str]]
    """Role -> words in names of parameters that speak for it."""
    synonyms: Mapping[tuple[str, ...], frozenset[tuple[str, ...]]]
    """Name of a thing -> what else it may be called, each word by word."""

    def exactly(self, words: Sequence[str]) -> frozenset[str]:
        """What these words together may call up, in any form of the first; none if they are not known."""
        for form in _forms(tuple(words)):
            if form in self.verbs:
                return self.verbs[form]
        meant = _turned(words[0].lower()) if words else ""
        return self.verbs.get((meant, *words[1:]), frozenset()) if meant else frozenset()

    def frames_of(self, verb: Sequence[str], particles: Sequence[str] = ()) -> frozenset[str]:
        """What a verb may call up with its particles, else alone, else by its first words."""
        tries = [[*verb, *particles], *(verb[:size] for size in range(len(verb), 0, -1))]
        return next((found for words in tries if (found := self.exactly(words))), frozenset())


def _forms(words: tuple[str, ...]) -> list[tuple[str, ...]]:
    """With each lemma the first word may have."""
    return [(first, *words[1:]) for first in lemmas(words[0])] if words else []


@lru_cache(maxsize=1024)
def _turned(word: str) -> str:
    """The one verb of which a word has two letters the wrong way round: "moev"; empty if there is none."""
    known = {verb[0] for verb in lexicon().verbs}
    if len(word) < 4 or word in known:
        return ""
    swaps = (f"{word[:at]}{word[at + 1]}{word[at]}{word[at + 2 :]}" for at in range(len(word) - 1))
    found = {swap for swap in swaps if swap != word and swap in known}
    return found.pop() if len(found) == 1 else ""


def lemmas(word: str) -> tuple[str, ...]:
    """What a word may be a form of, the likeliest first."""
    word = word.lower()
    found = [word]
    if word in _IRREGULAR:
        found.append(_IRREGULAR[word])
    for ending, instead in _ENDINGS:
        if word.endswith(ending) and len(word) - len(ending) > 1:
            cut = word[: -len(ending)] + instead
            found.append(cut)
            if len(cut) > 2 and cut[-1] == cut[-2]:
                found.append(cut[:-1])
    return tuple(dict.fromkeys(found))


def stem(word: str) -> str:
    """A noun without its plural, in small letters."""
    word = word.lower().replace("’", "'")
    if len(word) > 4 and word.endswith("ies"):
        return word[:-3] + "y"
    if word.endswith(("shelves", "loaves", "halves", "calves", "wolves", "scarves", "thieves")):
        return word[:-3] + "f"
    if len(word) > 4 and word.endswith(("ches", "shes", "sses", "xes", "oes")):
        return word[:-2]
    return (
        word[:-1] if len(word) > 3 and word.endswith("s") and not word.endswith(("ss", "us", "is")) else word
    )


def stems(words: Sequence[str]) -> tuple[str, ...]:
    """The words of a name, each without its plural; parts of ids and of words with a hyphen apart."""
    return tuple(stem(part) for word in words for part in word.replace("_", " ").replace("-", " ").split())


@cache
def lexicon() -> Lexicon:
    """The one that lies beside this program."""
    frames: dict[str, Frame] = {}
    verbs: dict[tuple[str, ...], set[str]] = {}
    for name, entry in load_data("frames").items():
        frames[name] = Frame(name, entry["gloss"], entry["roles"], entry["say"], tuple(entry["tests"]))
        for verb in entry.get("verbs", ()):
            verbs.setdefault(tuple(verb.split()), set()).add(name)
    classes = {name: frozenset(words) for name, words in load_data("classes").items()}
    hints = {name: frozenset(words) for name, words in load_data("parameters").items()}
    called = {words: frozenset(names) for words, names in verbs.items()}
    return Lexicon(frames, called, classes, hints, _synonyms())


def _synonyms() -> dict[tuple[str, ...], frozenset[tuple[str, ...]]]:
    """The other names of things; of kinds only upwards: a paperback is a book."""
    read = load_data("synonyms")
    found: dict[tuple[str, ...], set[tuple[str, ...]]] = {}
    for group in read["same"]:
        names = [tuple(name.split()) for name in group]
        for name in names:
            found.setdefault(name, set()).update(other for other in names if other != name)
    for general, special in read["kind_of"].items():
        for name in special:
            found.setdefault(tuple(name.split()), set()).add(tuple(general.split()))
    return {name: frozenset(others) for name, others in found.items()}


def is_somebody(word: str) -> bool:
    """Whether a noun is one for people."""
    people = load_data("people")["people"]
    return (
        is_word_for(word, "person") or stem(word) in people or word.endswith(("man", "men", "woman", "women"))
    )
