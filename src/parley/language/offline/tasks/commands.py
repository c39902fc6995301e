"""One clause that asks for something to be done: its verb and what belongs to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import NO_PLACES, strip_openers
from parley.language.offline.tasks.sources import from_off, from_one_to_another
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain

__all__ = ["Command", "read_command"]


@dataclass(frozen=True, slots=True)
class Command:
    """What a clause asks for."""

    kind: str
    """Verb class, or "catalogue" for a verb that only an action's name or phrase knows."""
    verb: str
    """Base form."""
    negated: bool = False
    theme: Phrase = ()
    """What is acted on."""
    place: Phrase = ()
    """Where to, or where."""
    source: Phrase = ()
    """Where from."""
    recipient: Phrase = ()
    """Who gets it."""
    words: Phrase = ()
    """Everything after the verb."""
    clause: Phrase = ()
    """Verb and all."""
    asked_politely: bool = False

    def said(self) -> str:
        """The command with its parts, readable."""
        parts = {
            "what": self.theme, "where": self.place, "from": self.source, "for": self.recipient,
        }  # fmt: skip
        named = [f"{name} “{plain(phrase)}”" for name, phrase in parts.items() if phrase]
        verb = f"{'do not ' if self.negated else ''}{self.verb} ({self.kind})"
        return ": ".join([verb, ", ".join(named)]) if named else verb


IsPerson = Callable[[Phrase], bool]

_SERIAL = frozenset(
    {"go", "come", "run", "head", "drive", "move", "walk", "hurry", "proceed", "return", "travel", "roll"}
)
_DIRECTIONS = frozenset(["left", "right", "up", "down", "forward", "back", "to", "the", "your"])
_HERE = frozenset({"here", "around", "there", "everything", "surroundings"})


def read_command(
    clause: Phrase, is_person: IsPerson, extra_verbs: Sequence[tuple[str, ...]] = ()
) -> Command | None:
    """Read a clause as a command; None if it does not begin with a verb."""
    lex = lexicon()
    words = strip_openers(clause)
    polite = strip_openers(words, requests=True)
    requested = len(polite) != len(words)
    words, negated = _negation(words)
    if not negated:
        words, negated = _negation(strip_openers(words, requests=True))
    if not words:
        return None
    words = strip_openers(words, requests=True)
    while negated and len(words) > 1 and words[0].key in {"you", "can", "could"}:
        words = words[1:]
    flat = _base(words)
    extra = max((verb for verb in extra_verbs if flat[: len(verb)] == verb), key=len, default=())
    found = lex.verbs.match(flat)
    if extra and (found is None or len(extra) >= found[0]):
        rest = words[len(extra) :]
        kind = (
            found[1].partition(":")[0]
            if found and found[1].partition(":")[2] == " ".join(extra)
            else "catalogue"
        )
        kind = "catalogue" if kind == "other" else kind
        return _fill(
            Command(kind, " ".join(extra), negated, words=rest, clause=words, asked_politely=requested),
            is_person,
        )
    if found is None:
        return _refused(clause, words) if negated else None
    kind, _, verb = found[1].partition(":")
    if flat[0] != words[0].key and words[0].key.endswith("ed") and not requested:
        return None
    rest = words[found[0] :]
    moved = verb in _MOVING_THINGS and keys(rest[:1]) and rest[0].key in lexicon().determiners | _THINGS
    if (verb == "move" or moved) and _moves_something(keys(rest)):
        kind = "transfer"
    staying = verb.split()[-1:] in (["in"], ["at"], ["by"])
    if rest and kind == "motion" and rest[0].key.endswith("ing") and not staying:
        doing = lex.verbs.match(_base(rest))
        if doing is not None and not doing[1].startswith("other:"):
            return read_command(rest, is_person, extra_verbs)
    serial = _serial(flat[0], rest, kind)
    if serial is not None:
        inner = read_command(serial, is_person, extra_verbs)
        if inner is not None and (inner.kind != "other" or _acts(serial)):
            return replace(inner, negated=negated or inner.negated, asked_politely=requested)
    return _fill(Command(kind, verb, negated, words=rest, clause=words, asked_politely=requested), is_person)


def _refused(clause: Phrase, words: Phrase) -> Command | None:
    """What is forbidden in words that no list of verbs knows: "do not <verb> X", "avoid X"."""
    if clause[0].key == "do" and len(words) > 1 and words[0].key not in lexicon().determiners | {"mean"}:
        return Command("other", words[0].key, True, theme=bare(words[1:]), words=words[1:], clause=words)
    if clause[0].key in {"avoid", "without"} and len(words) < 6:
        return Command("motion", "go", True, place=bare(words), words=words, clause=words)
    return None


_MOVING_THINGS = frozenset({"run", "drive", "roll", "wheel", "head", "fly"})
_THINGS = frozenset({"it", "them"})


def _moves_something(flat: tuple[str, ...]) -> bool:
    """For "Move the box to the door", as against "move to the door"."""
    lex = lexicon()
    return "to" in flat[1:] and not (
        lex.goals.match(flat) or lex.places.match(flat) or lex.adverbs.match(flat)
    )


def _base(words: Phrase) -> tuple[str, ...]:
    flat = keys(words)
    return (lemma(flat[0]), *flat[1:])


def _negation(words: Phrase) -> tuple[Phrase, bool]:
    flat = keys(words)
    found = lexicon().prohibitions.match(flat)
    if found is not None and found[0] < len(words):
        return words[found[0] :], True
    return words, False


def _acts(words: Phrase) -> bool:
    """For "(go) open the door": a verb with what it acts on, as against "(go) home"."""
    found = lexicon().verbs.match(_base(words)) if words else None
    if found is None or not found[1].startswith("other:"):
        return False
    return keys(words[found[0] : found[0] + 1])[:1] in {(w,) for w in lexicon().determiners | {"it", "them"}}


def _serial(verb: str, rest: Phrase, kind: str) -> Phrase | None:
    """For "Go (and) inspect X", "go to check X": the second verb is the one that counts."""
    if kind not in {"motion", "back"} or verb not in _SERIAL:
        return None
    while rest and rest[0].key in {"and", "to", "over", "back", "ahead", "out", "there"} and len(rest) > 1:
        labelled = len(rest) > 2 and (rest[2].key.isdigit() or len(rest[2].key) == 1)
        labelled = labelled and (len(rest) == 3 or rest[2].key != "a" or rest[2].is_capital)
        if rest[0].key == "to" and (rest[1].key in lexicon().determiners or labelled):
            # "Go to the check-in", "go to track 4".
            return None
        rest = rest[1:]
    if keys(rest[:1]) in {("left",), ("right",)}:
        return None
    found = lexicon().verbs.match(_base(rest)) if rest else None
    if _acts(rest):
        return rest
    if (
        found is None
        or found[1].partition(":")[0] in {"motion", "other", "wait", "back"}
        or rest[0].is_capital
    ):
        return None
    return rest if len(rest) > found[0] else None


def _fill(command: Command, is_person: IsPerson) -> Command:
    match command.kind:
        case "motion" | "back" | "wait" | "dock":
            return _motion(command)
        case "look" | "count":
            return _look(command)
        case "whether":
            return _whether(command)
        case "search" | "meet":
            return _search(command)
        case "follow":
            parts = _cut_at(_trim_end(command.words), frozenset({"from", "to", "into", "towards"}))
            return replace(
                command,
                theme=bare(parts.get("", ())),
                source=bare(parts.get("from", ())),
                place=bare(parts.get("to", ())),
            )
        case "transfer" | "grasp" | "place" | "guide":
            return _transfer(command, is_person)
    return replace(command, theme=bare(command.words))


def _motion(command: Command) -> Command:
    lex = lexicon()
    words = command.words
    while words:
        flat = keys(words)
        skip = lex.goals.match(flat)
        if skip and skip[0] < len(words) and not (lex.places.match(flat) or (0, ""))[0] > skip[0]:
            words = words[skip[0] :]
            continue
        if flat[0] in lex.place_pronouns:
            break
        adverb = lex.adverbs.match(flat)
        if adverb and adverb[0] < len(words) and not lex.places.match(flat):
            words = words[adverb[0] :]
            continue
        if flat[0] in {"left", "right", "straight"} and flat[1:2] == ("to",) and len(words) > 2:
            words = words[1:]
            continue
        if flat[0] in {"back", "up", "over", "down", "out", "through"} and len(words) > 1:
            words = words[1:]
            continue
        break
    flat = keys(words)
    if flat[:1] == ("from",) and "to" in flat:
        return replace(
            command, source=bare(words[1 : flat.index("to")]), place=bare(words[flat.index("to") + 1 :])
        )
    if (
        flat[:1] in {("in",), ("on",), ("at",), ("inside",)}
        and len(words) > 1
        and lex.places.match(flat, 0) != (3, "in front of")
    ):
        single = lex.places.match(flat)
        if single and single[0] == 1:
            words = words[1:]
    return replace(command, place=_trim_article(words))


def _trim_article(words: Phrase) -> Phrase:
    return bare(words)


def _counted(words: Phrase) -> Phrase:
    """For "boxes there are on the desk" and "boxes on the desk are open": what is counted."""
    flat = keys(words)
    for index in range(1, len(flat) - 1):
        if flat[index : index + 2] in {("there", "are"), ("are", "there"), ("there", "is")}:
            return (*words[:index], *words[index + 2 :])
        if flat[index] == "are":
            found = lexicon().places.match(flat, index + 1)
            if found is not None:
                return (*words[:index], *words[index + 1 :])
            noun = noun_phrase(words[:index])
            size = len(words[:index]) - len(noun.anchors[0]) if noun.anchors else index
            at = _at(flat[:index], tuple(noun.relation.split())) if noun.relation else size
            return (*words[:at], *words[index + 1 :], *words[at:index])
    return words


def _without_listener(words: Phrase) -> Phrase:
    """Without "to me" or "for us" at the end."""
    return words[:-2] if len(words) > 3 and keys(words[-2:]) in _TO_ME else words


_TO_ME = frozenset((to, whom) for to in ("to", "for") for whom in ("me", "us"))


def _look(command: Command) -> Command:
    words = _without_listener(command.words)
    if command.kind == "count":
        words = _counted(words)
        command = replace(command, words=words)
    if words and set(keys(words)) <= _DIRECTIONS:
        return replace(command, theme=words)
    while len(words) > 1 and words[0].key in _LOOKING_ALONG:
        words = words[1:]
    flat = keys(words)
    if flat and flat[0] in _HERE and (anchors := noun_phrase(words).anchors) and anchors[0]:
        # "Inspect everything in the room": the room.
        return replace(command, theme=anchors[0])
    if flat and (flat[0] in _HERE or words == ()):
        return replace(command, theme=())
    if command.verb in _VERIFYING and (link := _finite(flat)):
        return _whether(replace(command, kind="whether")) if link else command
    if flat[:1] and flat[0] in {"for"} and command.kind == "look":
        return _search(replace(command, kind="search", words=words[1:]))
    for index in range(1, len(flat) - 1):
        if flat[index] == "for" and not lexicon().adverbs.match(flat, index):
            return replace(command, place=bare(words[:index]), theme=bare(words[index + 1 :]))
        if flat[index : index + 2] == ("to", "see") and flat[index + 2 : index + 3] in {
            ("if",),
            ("whether",),
        }:
            return replace(
                _whether(replace(command, words=words[index + 3 :])),
                kind="whether",
                place=bare(words[:index]),
            )
        if flat[index] in {"whether", "if"}:
            return replace(
                _whether(replace(command, words=words[index + 1 :])),
                kind="whether",
                place=bare(words[:index]),
            )
    return replace(command, theme=bare(words))


_LOOKING_ALONG = frozenset({
    "at", "on", "into", "in", "inside", "over", "around", "down", "along", "round", "through", "across", "up",
})  # fmt: skip
_VERIFYING = frozenset({"verify", "check", "double check", "assess", "see", "test"})
_FINITE = frozenset(
    {"works", "functions", "runs", "opens", "closes", "needs", "looks", "smells", "leaks", "work", "has"}
)


def _finite(flat: tuple[str, ...]) -> int:
    """Where the verb of a whole statement stands ("(check) the door is shut"); 0 if it is none."""
    at = next((i for i in range(1, len(flat)) if flat[i] in lexicon().be | _FINITE), 0)
    relative = {"that", "which", "who", "where", "what", "if", "whether", "how", "for", "to"} & set(flat[:at])
    return 0 if relative or (at == len(flat) - 1 and flat[at] in lexicon().be) else at


_LINKS = frozenset({
    "has", "have", "looks", "needs", "works", "look", "need", "does", "can", "seems", "still", "stands",
    "sits", "lies", "hangs", "feels",
})  # fmt: skip


def _how_much(words: Phrase) -> int:
    """How many words at the start only say how: "crowded" in "(how) crowded the hall"."""
    if len(words) < 2 or words[0].is_capital or words[0].key in lexicon().determiners | lexicon().nouns:
        return 0
    return 1 + (words[0].key in {"very", "many", "much"} and len(words) > 2)


_STATES_OF_USE = frozenset({("on",), ("off",), ("up",), ("down",), ("out",)})


_HAVING = frozenset({("we",), ("they",), ("you",)})
_AT_HAND = frozenset({
    ("within", "reach"), ("in", "reach"), ("at", "hand"), ("in", "sight"), ("in", "view"),
    ("within", "sight"),
})  # fmt: skip


def _whether(command: Command) -> Command:
    """For "Whether S": the subject of S is what to look at."""
    lex = lexicon()
    words = _trim_end(command.words)
    flat = keys(words)
    if flat[:1] == ("there",) and len(flat) > 2 and flat[1] in lex.be:
        return replace(_search(replace(command, words=words[2:])), kind="whether", words=words)
    link = next((i for i in range(1, len(flat)) if flat[i] in lex.be | _LINKS), len(flat))
    if link < len(flat) and flat[link - 1] in {"that", "which", "who"} and link > 1:
        # "The gate that is jammed is shut": the second verb is the one of the sentence.
        link = next((i for i in range(link + 1, len(flat)) if flat[i] in lex.be), link)
    start = _how_much(words[:link]) if command.verb.endswith("how") else 0
    subject = bare(words[start:link])
    if keys(subject) in _HAVING and flat[link : link + 1] in {("has",), ("have",), ("still",)}:
        # "Whether we still have any A in B" is about A.
        having = link + 1 + (flat[link] == "still" or flat[link + 1 : link + 2] == ("got",))
        return replace(_search(replace(command, words=words[having:])), kind="whether", words=words)
    at = link + 1
    while at < len(flat) and flat[at] in {"still", "not", "there", "now", "really", "also"}:
        at += 1
    # "The lights are on in the hall".
    at += flat[at : at + 1] in _STATES_OF_USE and lex.places.match(flat, at + 1) is not None
    at += 2 * (flat[at : at + 2] in _AT_HAND)
    found = lex.places.match(flat, at)
    place = bare(words[at + found[0] :]) if found and link < len(flat) else ()
    place = () if keys(place[:1])[:1] and place[0].key in NO_PLACES else place
    return replace(command, theme=subject, place=place, words=words)


def _trim_end(words: Phrase) -> Phrase:
    while words and not words[-1].is_word:
        words = words[:-1]
    return words


def _search(command: Command) -> Command:
    flat = keys(command.words)
    if command.verb in {"search", "scan", "comb"} and "for" in flat[1:-1]:
        at = flat.index("for", 1)
        return replace(command, place=bare(command.words[:at]), theme=bare(command.words[at + 1 :]))
    noun = noun_phrase(command.words)
    if noun.relation and noun.core and noun.anchors and noun.anchors[0]:
        core = command.words[: _at(keys(command.words), tuple(noun.relation.split()))]
        return replace(command, theme=bare(core), place=noun.anchors[0])
    return replace(command, theme=bare(command.words))


def _at(flat: tuple[str, ...], wanted: tuple[str, ...]) -> int:
    return next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), len(flat))


def _transfer(command: Command, is_person: IsPerson) -> Command:
    """Theme, source, goal and recipient, in either order of objects."""
    words = _trim_end(command.words)
    if len(words) > 1 and words[0].key in {"up", "over", "back", "along", "out", "away"}:
        words = words[1:]
    words = from_off(_as_kinds(words))
    from_there = from_one_to_another(words) if command.kind == "place" else None
    if from_there is not None:
        theme, source, place = from_there
        return replace(command, theme=bare(theme), source=bare(source), place=bare(place))
    parts = _cut_at(words, frozenset({"from", "to", "for", "into", "onto", "towards"}))
    theme = parts.pop("", ())
    recipient, theme = _double_object(theme, is_person)
    result = replace(command, recipient=recipient, source=bare(parts.get("from", ())))
    placed = noun_phrase(recipient)
    if placed.relation and placed.anchors:
        who = recipient[: _at(keys(recipient), tuple(placed.relation.split()))]
        result = replace(result, recipient=bare(who), place=placed.anchors[0])
    for marker in ("to", "for", "into", "onto", "towards"):
        goal = bare(parts.get(marker, ()))
        if not goal:
            continue
        noun = noun_phrase(goal)
        person = goal if not noun.relation else goal[: _at(keys(goal), tuple(noun.relation.split()))]
        if is_person(person):
            place = noun.anchors[0] if noun.anchors else ()
            result = replace(result, recipient=bare(person), place=place or result.place)
        elif marker != "for":
            result = replace(result, place=goal)
    if len(theme) > 1 and theme[-1].key in {"back", "over", "along", "up", "down", "out", "across"}:
        theme = theme[:-1]
    noun = noun_phrase(theme)
    if command.kind in {"grasp", "place"} and len(theme) > 1 and theme[-1].key in {"up", "down"}:
        theme = theme[:-1]
    if command.kind == "place" and noun.relation and noun.anchors and not result.place:
        return replace(
            result, theme=bare(theme[: _at(keys(theme), tuple(noun.relation.split()))]), place=noun.anchors[0]
        )
    return replace(result, theme=bare(theme))


def _as_kinds(words: Phrase) -> Phrase:
    """For "Something to drink" is one thing, whatever its words."""
    flat = keys(words)
    for said, kind in lexicon().need_phrases.items():
        wanted = tuple(said.split())
        for index in range(len(flat) - len(wanted) + 1):
            if len(wanted) > 1 and flat[index : index + len(wanted)] == wanted:
                return (*words[:index], Word(kind, kind), *words[index + len(wanted) :])
    return words


def _cut_at(words: Phrase, markers: frozenset[str]) -> dict[str, Phrase]:
    parts: dict[str, Phrase] = {}
    current, start = "", 0
    for index, word in enumerate(words):
        if word.key in markers and not (
            word.key == "to" and index and words[index - 1].key in {"next", "close", "nearest"}
        ):
            if words[index + 1 : index + 2] and current in parts and word.key == current:
                continue
            parts.setdefault(current, words[start:index])
            current, start = word.key, index + 1
    parts.setdefault(current, words[start:])
    return parts


_PARTICLES = frozenset({"over", "back", "along", "up", "down", "out", "across"})


def _double_object(words: Phrase, is_person: IsPerson) -> tuple[Phrase, Phrase]:
    """For "him water", "the man the cup": who gets it stands first."""
    lex = lexicon()
    words = tuple(word for word in words if word.is_word)
    if len(words) < 2 or (len(words) == 2 and words[1].key in _PARTICLES):
        return (), words
    if words[0].key in (lex.person_pronouns | lex.operator_pronouns) and not (
        words[0].key == "her" and False
    ):
        return words[:1], words[1:]
    for index in range(1, len(words)):
        starts_theme = words[index].key in lex.determiners | {"something"} and words[index - 1].key not in {
            "of",
            "with",
        }
        noun = noun_phrase(words[:index])
        who = (
            words[: _at(keys(words[:index]), tuple(noun.relation.split()))]
            if noun.relation
            else words[:index]
        )
        if starts_theme and who and is_person(bare(who)):
            return bare(words[:index]), words[index:]
    for index in range(1, min(3, len(words))):
        if is_person(words[:index]) and not is_person(words[: index + 1]):
            return bare(words[:index]), words[index:]
    return (), words
