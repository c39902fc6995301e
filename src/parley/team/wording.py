"""The words in which work is spread over a team, as patterns; the lists stand in `wishes.yaml`."""

from __future__ import annotations

import itertools
import re
from functools import cache
from typing import Final

from parley.files import words_in
from parley.language.builtin.lexicon import lemmas, lexicon

__all__ = ["NUMBERS", "Wording", "acts", "goes", "in_base_form", "lists", "opened_by", "plain_words"]

NUMBERS: Final = {"both": 2, "two": 2, "three": 3, "four": 4, "five": 5}


@cache
def lists() -> dict[str, list[str]]:
    """The ways to say each thing, by its name."""
    return {
        name: text.splitlines()
        for name, text in words_in("parley.team", "wishes").items()
        if isinstance(text, str)
    }


class Wording:
    """The patterns, for robots of these names.

    Args:
        robots: Their names.
        hearer: Whom "you" means, where one robot hears it.
    """

    def __init__(self, robots: tuple[str, ...], hearer: str = "") -> None:
        self.robots = {name.lower(): name for name in robots}
        self.hearer = hearer

    def of(self, name: str) -> str:
        """A list as one pattern."""
        filled = "|".join(sorted(lists()[name], key=len, reverse=True))
        filled = re.sub(r"(?<!\?P)<(\w+)>", lambda found: self.of(found[1]), filled)
        some = f"{self.names}(?:(?:,? and|,? or|,) {self.names})*"
        return f"(?:{filled.replace('{robots}', some).replace('{robot}', self.names)})"

    @property
    def names(self) -> str:
        """Any of the robots' names."""
        return f"(?:{'|'.join(re.escape(name) for name in self.robots)})"

    @staticmethod
    def match(pattern: str, text: str) -> re.Match[str] | None:
        """Whether a whole text is said so, in small letters or not."""
        return re.fullmatch(pattern, text, re.IGNORECASE)

    def begun(self, text: str) -> str:
        """Without what only opens a sentence."""
        while found := re.match(rf"{self.of('lead')}(?:\s+|(?<=[ ,]))", text, re.IGNORECASE):
            text = text[found.end() :]
        return text

    def count(self, text: str) -> int:
        """How many robots a message speaks of."""
        told = "|".join(self.of(name) for name in ("all", "each", "one", "between"))
        said = " ".join(found[0] for found in re.finditer(rf"\b(?:{told})\b", text, re.IGNORECASE)).lower()
        return next((number for word, number in NUMBERS.items() if word in said.split()), 0)

    def calling(self, text: str) -> tuple[str, str] | None:
        """The one robot that is called, first or behind a comma at the end, and what else is said."""
        names = re.findall(rf"\b{self.names}\b", text, re.IGNORECASE)
        found = self.match(rf"(?P<robot>{self.names})\W+(?P<said>.+)", text) or self.match(
            rf"(?P<said>.+?), ?(?P<robot>{self.names})", text
        )
        return (self.robots[found["robot"].lower()], found["said"]) if found and len(names) == 1 else None

    def called(self, text: str) -> tuple[str, ...]:
        """The robots that are named."""
        return tuple(
            self.robots[name.lower()] for name in re.findall(rf"\b{self.names}\b", text, re.IGNORECASE)
        )

    def gone(self, order: str) -> str:
        """Who opens the way to a place, or comes together there, goes there."""
        for name in ("opening", "meeting"):
            if found := re.match(self.of(name), order, re.IGNORECASE):
                order = f"go to{order[found.end() :]}"
        return order

    def robot(self, subject: str) -> str:
        """The robot that is called so, or the one that hears it; empty if that is none."""
        return self.robots.get(subject.lower(), self.hearer if subject.lower() == "you" else "")


def plain_words(message: str) -> str:
    """A message without what only presses or ends it."""
    text = re.sub(r"\s+", " ", message.replace("’", "'")).strip(" .!?")
    return re.sub(
        r",? (?:quick|quickly|asap|hurry(?: up)?|at once|right away|will you|then)$",
        "",
        text,
        flags=re.IGNORECASE,
    )


def acts(order: str) -> bool:
    """Whether words begin with what one can do."""
    first = order.split(" ")[0].lower()
    return (first,) in lexicon().verbs and first not in lexicon().classes["being"]


def goes(order: str) -> bool:
    """Whether words only say where one is to be."""
    frames = lexicon().verbs.get((order.split(" ")[0].lower(),), frozenset())
    return not frames.isdisjoint({"GO", "WAIT"}) and " and " not in order


def opened_by(order: str) -> str:
    """The verb of an order, with what leads to its place: "go to"."""
    first, *rest = order.split(" ")
    small = lexicon().classes["prepositions"] - lexicon().classes["determiners"]
    return " ".join([first, *itertools.takewhile(lambda word: word.lower() in small, rest)])


def in_base_form(order: str) -> str:
    """What somebody else does, as one says it to them: "goes to the gate" is "go to the gate"."""
    first, _, rest = order.partition(" ")
    verbs = lexicon().verbs
    now = first.lower().endswith("s")  # "went to the gate" tells what was, and is no order
    base = next((form for form in lemmas(first) if now and (form,) in verbs), first)
    return f"{base} {rest}".strip() if (first.lower(),) not in verbs else order
