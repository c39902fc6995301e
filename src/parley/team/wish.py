"""What a message to a team comes to: who is to do what, or what is asked about whom."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final, Literal

__all__ = ["WHO", "Part", "TeamWish", "Who", "is_in_turn", "is_of_several"]


Who = Literal["one", "some", "rest", "all", "each", "named"]
WHO: Final[tuple[Who, ...]] = ("one", "some", "rest", "each", "all", "named")


@dataclass(frozen=True, slots=True)
class Part:
    """What some robots are to do."""

    who: Who
    order: str
    """In words that one robot understands; empty: what was said last, or (with `home`) going back."""
    robot: str = ""
    """For `named`."""
    after: bool = False
    """Whether it waits until the part before it is done."""
    of: str = ""
    """Whose work it is that is taken over."""
    count: int = 1
    """For `some`: how many."""
    nearest: bool = False
    """For `one`: whoever has the shortest way, and nobody else."""
    without: tuple[str, ...] = ()
    """Robots that are left out of it by name."""
    home: bool = False
    """Whether it is to go back, and it is not said where to."""
    fullest: bool = False
    """For `one`: whoever has most left in its battery."""
    idle: bool = False
    """For `one`: somebody who has nothing to do, if there is one."""
    stays: bool = False
    """Whether it is to do nothing."""
    awaits: str = ""
    """The robot that has to be done with what it is at before."""
    instead: bool = False
    """Whether it does what the hearer, or `of`, has to do."""
    alike: str = ""
    """What the words may mean if nobody understands them: the same as others do."""

    @property
    def of_before(self) -> bool:
        """Whether it is what was said before, or is at work already."""
        return not (self.order or self.alike or self.home or self.of or self.stays)


@dataclass(frozen=True, slots=True)
class TeamWish:
    """How a message spreads work over robots, or what it asks about them."""

    kind: Literal[
        "share",
        "parts",
        "nearest",
        "about",
        "why",
        "swap",
        "progress",
        "drop",
        "bar",
        "judged",
        "help",
        "alone",
        "stranger",
    ]
    parts: tuple[Part, ...] = ()
    """For `share` one, of all, and perhaps where each goes behind it; for `swap` those that are named; for
    `bar` where each of them shall not go; of several robots, for `about`, what each is asked."""
    about: str = ""
    """For `nearest` the place, for `about` the question as that robot would be asked, for `progress` what was
    asked of, if not all of it, for `judged` words that judge nothing, for `stranger` who is no robot here."""
    robot: str = ""
    """For `about`, empty: each of them is asked. For `why` who was chosen or was not, if one is named. For
    `drop` whose part is given up, for `help` whose work it is."""
    one_each: bool = False
    """For `share`: nobody takes more than one."""
    count: int = 0
    """How many robots are spoken of ("you two"); 0: that is not said."""
    bare: bool = False
    """Only things are named, not what is to be done there."""
    anew: bool = False
    """Whether what was wanted before is wanted no more."""
    otherwise: TeamWish | None = None
    """For `progress`: what it asks if no such work is known."""
    turns: Literal["", "done", "asked"] = ""
    """Behind words of stopping, it comes in place of what its doers are at: at once, or after a yes."""


_SEVERAL: Final = re.compile(r"\b(?:all|every|each|both|any|two|three|four|five|six|[2-9])\b", re.IGNORECASE)
_IN_TURN: Final = re.compile(
    r"\b(?:then|first|after|afterwards|before|finally|next|second|until|when|once|if)\b", re.IGNORECASE
)


def is_of_several(order: str) -> bool:
    """Whether words speak of several things as a set, which may be shared without another word."""
    return _SEVERAL.search(order) is not None


def is_in_turn(order: str) -> bool:
    """Whether words say in which order things are to be done, so that they are not shared."""
    return _IN_TURN.search(order) is not None
