"""Where an order begins: its verb, and the words before it that only say that it is one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.offline.grammar.small import base, is_past, small, verb_class
from parley.language.offline.grammar.things import Item
from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.tasks.roles import is_narrow_look
from parley.language.offline.words.lexicon import lexicon

__all__ = ["Head", "Heads"]

_CLASSES = {
    "motion": "go", "back": "go", "look": "look", "whether": "whether", "search": "search",
    "count": "count", "wait": "go", "drop_step": "leave_out", "dock": "other",
}  # fmt: skip
_MAY = frozenset(("you", word) for word in ("can", "will", "may", "might", "would", "could"))


_HOLDING_ON = frozenset({("hang", "on"), ("hold", "on"), ("bear", "with")})


@dataclass(frozen=True, slots=True)
class Head:
    """The verb of an order."""

    at: int
    """Where it stands."""
    end: int
    """Where what belongs to it begins."""
    kind: str
    negated: bool
    framed: bool
    """Whether words before it say that it is asked for."""
    gives: bool = False
    """Whether it is a noun for what is done ("a look")."""


@dataclass
class Heads:
    """Finds verbs of orders among the items of a message."""

    items: Sequence[Item]
    catalogue: Catalogue

    def __post_init__(self) -> None:
        self._found: dict[tuple[int, bool], Head | None] = {}
        self.past = False
        """Whether an order was put in the past ("I would love it if you went"): others go on with it."""
        self._own = {verb[0] for verb in self.catalogue.verbs if verb}
        narrow = any(is_narrow_look(info) for info in self.catalogue.of_own_kind)
        self._looks = narrow or self.catalogue.with_role("look", "search") is not None

    def key(self, at: int) -> str:
        """The word at a position; "." behind the end."""
        return self.items[at].key if 0 <= at < len(self.items) else "."

    def flat(self, at: int, size: int = 8) -> tuple[str, ...]:
        """The next words, up to a thing."""
        found: list[str] = []
        for item in self.items[at : at + size]:
            if item.thing is not None:
                break
            found.append(item.key)
        return tuple(found)

    def head(self, at: int) -> Head | None:
        """The verb of the order that begins at a position; None if none does."""
        key = at, self.past
        if key not in self._found:
            self._found[key] = self._head(at)
        return self._found[key]

    def _head(self, at: int) -> Head | None:
        found: Head | None = None
        j = at
        while j < len(self.items) and j - at < 16:
            key = self.key(j)
            here = self._candidate(at, j, found)
            if here is not None:
                found = here
            if key not in small().frame and key not in small().adverbs and here is None:
                break
            j += 1
        return found

    def _candidate(self, at: int, j: int, before: Head | None) -> Head | None:
        key = self.key(j)
        frame = self.flat(at, j - at) if j > at else ()
        if len(frame) < j - at:
            return None
        if before is not None and before.gives and base(key) == key:
            return None
        if key in {"know", "hear"} and frame[:1] in {("i",), ("we",)} and set(frame) & small().wishes:
            asks = self.key(j + 1) in {"if", "whether"}
            return Head(j, j + 1, "whether", _negated(frame), True) if asks else None
        deed = small().deeds.get(key)
        behind = self.key(j - 1) if j > at else "."
        noun = bool({"a", "an", "the", "another", "your", "some"} & set(frame[-4:])) or key == "eyes"
        if deed and key in {"rest", "break", "pause", "stay"} and "the" in frame[-2:]:
            return None
        if deed and noun and j > at:
            asked = set(frame) & (small().wishes | {"you"})
            light = bool({base(w) for w in frame} & small().light) or bool(asked)
            return Head(j, j + 1, deed, _negated(frame), True, gives=True) if light else None
        if (
            behind in lexicon().determiners | small().sets["praise"]
            or not verb_class(key)
            or self._is_no_order(j)
        ):
            return None
        if before is not None and not self._reaches(before, j):
            return None
        if not self._fits(frame, key):
            return None
        end, kind = self.kind(j)
        kind = "other" if key == "read" and self._reads_out(end) else kind
        return Head(j, end, kind, _negated(frame), bool(frame))

    def _reads_out(self, at: int) -> bool:
        """For "(read) N a W", "(read) the W to N": that is no look."""
        whom = at < len(self.items) and self.items[at].thing is not None
        if whom and self.key(at + 1) in lexicon().determiners:
            return True
        end = next((i for i in range(at, len(self.items)) if self.key(i) in {".", "!", ",", "and"}), 0)
        said = self.items[at : end or len(self.items)]
        to = next((i for i, item in enumerate(said[:-1]) if item.key == "to"), 0)
        named = to > 0 and said[to + 1].thing is not None and said[to - 1].key not in {"next", "close", "up"}
        return named or "aloud" in {item.key for item in said}

    def _is_no_order(self, j: int) -> bool:
        """Whether a verb orders nothing here: "help", "change of plan", a copula before an adjective."""
        key, behind = base(self.key(j)), self.key(j + 1)
        if key in self._own:
            return False
        if key in {"time", "like", "mind"} or self.flat(j, 2) in _HOLDING_ON:
            return True
        if small().go_on.match((key, *self.flat(j + 1, 4))) is not None:
            return False
        if key in small().talk or (behind == "of" and small().verbs.get(key, "other") == "other"):
            return True
        return key in small().sets["states"] and not self._goes_to(j)

    def is_own(self, j: int) -> bool:
        """Whether a word is the verb of an action of the catalogue."""
        return base(self.key(j)) in self._own

    def is_talk(self, j: int) -> bool:
        """Whether a verb is one of those that order nothing."""
        return base(self.key(j)) in small().talk or self.flat(j, 2) in _HOLDING_ON

    def _goes_to(self, j: int) -> bool:
        """Whether "to", "over", "at" and the like stand behind a verb that means going only with them."""
        flat = self.flat(j + 1, 4)
        while flat[:1] and flat[0] in {"straight", "right", "directly", "just", "quickly", "immediately"}:
            flat = flat[1:]
        found = lexicon().verbs.match((base(self.key(j)), *flat))
        if found is not None and found[0] > 1:
            return True
        if flat[:1] and flat[0] in {"yourself", "it"}:
            flat = flat[1:]
        return bool(flat) and flat[0] in small().prepositions | {"home", "yourself", "there", "here"} - {"of"}

    def _reaches(self, before: Head, j: int) -> bool:
        """Whether an earlier verb only leads to this one ("go and see", "start with checking")."""
        key = self.key(j)
        if before.end > j:
            return False
        if before.end == j:
            return (
                key.endswith("ing")
                or base(self.key(before.at)) in small().sets["light"]
                or before.kind == "go"
            )
        between = self.flat(before.end, j - before.end)
        if key.endswith("ing") or base(self.key(before.at)) in small().sets["light"]:
            return True
        joins = {
            "to",
            "and",
            "please",
            "you",
            "then",
            "that",
            "just",
            "over",
            "out",
            "ahead",
            "back",
            "if",
            "go",
        }
        if between[-1:] == ("and",) and before.kind != "go":
            return False
        return bool(between) and (between[-1] in joins or between[-1] in small().adverbs)

    def _fits(self, frame: tuple[str, ...], key: str) -> bool:
        """Whether these words before a verb in this form make it an order."""
        words = set(frame)
        wishes = words & small().wishes
        if words & small().questions or ("why" in words and not words & {"not"}):
            return False
        if frame in {("i", "am"), ("we", "are")} and key in {"looking", "searching"}:
            return True
        if "how" in words and not words & {"about", "mind"}:
            return False
        if frame[:2] in _MAY and base(key) in small().sets["perceiving"]:
            return False
        planned = bool(wishes or {"you", "do"} <= words) and "is" in words
        if "what" in words and not words & {"about", "if"} and not planned:
            return False
        if words & small().past_frames and not words & {"better", "wish", "wanted", "needed"}:
            return False
        if frame[:3] == ("are", "you", "to"):
            return True
        if (
            frame[:2] in {("have", "you"), ("are", "you"), ("were", "you"), ("is", "it")}
            and not wishes
            and "able" not in words
        ):
            return False
        if frame[:2] in {("do", "you"), ("does", "it"), ("do", "i"), ("do", "we")} and not wishes:
            return False
        return self._form_fits(frame, key) and self._subject_fits(frame)

    def _form_fits(self, frame: tuple[str, ...], key: str) -> bool:
        words = set(frame)
        form = base(key)
        if form == key:
            return True
        if key.endswith("ing"):
            return bool(words & (small().wishes | {"about", "by", "start", "begin", "with", "keep", "worth"}))
        if is_past(key):
            return (self.past and not words - {"also", "then"}) or (
                bool(words & {"if", "wish", "rather", "time"}) and "you" in words
            )
        return False

    def _subject_fits(self, frame: tuple[str, ...]) -> bool:
        words = set(frame)
        if words & small().sets["somebody"] and not words & small().sets["modals"]:
            return False
        if (
            "i" in words
            and "you" not in words
            and not {"what", "do", "is"} <= words
            and not words & {"suggest", "propose", "recommend", "favour", "favor"}
        ):
            return False
        if "we" in words and not words & (small().sets["modals"] | {"let", "to"}):
            return False
        return not (
            "it" in words
            and not words & (small().wishes | {"time", "important", "essential", "urgent", "up"})
        )

    def kind(self, j: int) -> tuple[int, str]:
        """What the verb at `j` asks for, and where what belongs to it begins."""
        flat = self.flat(j)
        flat = (base(flat[0]), *flat[1:])
        own = max((v for v in self.catalogue.verbs if flat[: len(v)] == v), key=len, default=())
        found = lexicon().verbs.match(flat)
        size, kind = 1, small().verbs.get(flat[0], "other")
        if kind == "go_to":
            kind = "go" if self._goes_to(j) else "other"
        kind = "go" if (flat[1:2] == ("yourself",) and kind == "other") else kind
        if found is not None:
            name = found[1].partition(":")[0]
            if found[0] > 1 or kind == "other":
                size, kind = found[0], _CLASSES.get(name, "other")
        if (
            kind in {"look", "whether"}
            and flat[0] in {"tell", "report", "say", "let"}
            and {"what", "who", "where"} & set(flat[:size])
        ):
            return j + size, "other"
        idiom = self._idiom(flat)
        if idiom is not None:
            return j + idiom[0], idiom[1]
        if flat[0] in small().sets["noting"] and flat[1:2] == ("any",):
            return j + 1, "search"
        left = small().leave_out.match(flat)
        if left is not None:
            return j + left[0], "leave_out"
        if kind == "go" and (flat[1:2] in {("it",), ("them",)} or self._carries(j, flat)):
            kind = "other"
        if kind in {"look", "search", "whether", "count"} and not self._looks:
            kind = "other"
        if own and len(own) >= size and not self._is_general(own):
            size, kind = len(own), "other"
        if kind == "leave_out" and flat[0] not in small().verbs:
            kind = "other"
        return j + size, kind

    def _idiom(self, flat: tuple[str, ...]) -> tuple[int, str] | None:
        """For "pop your head", "make certain": how many words they are, and what they ask for."""
        going = small().go_on.match(flat)
        if going is not None:
            return going[0], "go"
        ensuring = small().ensuring.match(flat) if self._looks else None
        return (ensuring[0], "whether") if ensuring is not None else None

    def _carries(self, j: int, flat: tuple[str, ...]) -> bool:
        """For "move the box from A to B": a thing is taken somewhere."""
        following = self.items[j + 1] if j + 1 < len(self.items) else None
        if following is None or following.thing is None or flat[0] not in small().sets["carrying"]:
            return False
        return self.key(j + 2) in {"from", "to", "into", "onto", "over"}

    def _is_general(self, own: tuple[str, ...]) -> bool:
        """Whether a verb of the catalogue is its way of going or looking."""
        info = self.catalogue.for_verb(" ".join(own))
        return info is not None and bool(self.catalogue.roles(info) & {"motion", "look", "search", "whether"})


def _negated(frame: tuple[str, ...]) -> bool:
    """Whether the words before a verb forbid it."""
    words = set(frame)
    if not words & {"not", "never", "no", "without"}:
        return False
    if "why" in words or words & {"forget", "hesitate", "mind", "fail"}:
        return False
    return frame[:1] not in {("would",), ("could",), ("will",), ("can",)}
