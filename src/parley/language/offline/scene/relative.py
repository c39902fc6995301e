"""Descriptions by what is remembered or denied: "the chair A is on", "the door that is not red"."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.facts.facts import where_only
from parley.language.offline.facts.owning import holder_of
from parley.language.offline.facts.remembering import Remembered, find_fact
from parley.language.offline.facts.sharing import alike, content_of, shared
from parley.language.offline.scene.grounding import ground_phrase, matching
from parley.language.offline.scene.links import linked_thing, worked_with
from parley.language.offline.scene.owned import owned_thing
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys
from parley.world.object_map import MapObject

__all__ = ["described_by_facts"]

_PRONOUNS = frozenset({"that", "which", "where", "who"})
_HOLDING = frozenset({"with", "containing", "holding", "has", "holds", "contains", "stores", "keeps"})
_MAX_HOPS = 3


def described_by_facts(
    phrase: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """The one object that a relative clause or a remembered thing in it singles out, and the facts used."""
    words = tuple(word for word in phrase if word.is_word)
    words = _where(words)
    if len(words) > 4 and keys(words[-2:]) in {("on", "it"), ("in", "it"), ("at", "it"), ("under", "it")}:
        # "The shelf with A on it".
        words = words[:-2]
    if not 2 < len(words) <= 14:
        return (
            _the_same(words, objects, facts)
            or owned_thing(words, objects, facts)
            or linked_thing(words, objects, facts)
        )
    return (
        _the_same(words, objects, facts)
        or owned_thing(words, objects, facts)
        or _with_adjective(words, objects)
        or _excluded(words, objects)
        or _where_something_is(words, objects, facts)
        or _holding(words, objects, facts)
        or _beside(words, objects, facts)
        or _as_told(words, objects, facts)
        or linked_thing(words, objects, facts)
    )


def _where(words: Phrase) -> Phrase:
    """With "where A is" for "wherever A is", "there where A is" and "the place to where A is"."""
    flat = keys(words)
    if flat[:1] == ("wherever",):
        return (Word("where", "where"), *words[1:])
    at = flat.index("where") if "where" in flat[:3] else 0
    return (
        words[at:] if at and set(flat[:at]) <= {"there", "over", "to", "exactly", "right", "back"} else words
    )


def _the_same(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "A's car", where it is remembered that A's car is the green one; or that the green one is A's."""
    about = keys(bare(words))
    if not about or any(item.description.lower() == " ".join(about) for item in objects):
        return None
    for known in facts:
        fact = known.fact
        if (
            fact.is_location
            or fact.negated
            or fact.relation not in lexicon().be | {"belongs"}
            or not fact.state
        ):
            continue
        for name, other in ((fact.subject, fact.state), (fact.state, fact.subject)):
            if not _names_same(about, keys(bare(name)), belongs=fact.relation == "belongs"):
                continue
            found = ground_phrase(other, objects, strict=True)
            if found.outcome == "match":
                return found.candidates[0], (known,)
    return None


def _names_same(about: tuple[str, ...], name: tuple[str, ...], *, belongs: bool) -> bool:
    """Whether two names mean the same: word by word, or as owner ("Ben's" and "to Ben" for "Ben's car")."""
    if about == name:
        return True
    at = next((i for i, word in enumerate(about) if word.endswith("'s")), -1)
    if at < 0:
        return False
    owner = (*about[:at], about[at].removesuffix("'s"))
    name = tuple(word for word in name if word not in {"the", "a", "an"})
    return name == (*owner[:-1], f"{owner[-1]}'s") or (belongs and name == ("to", *owner))


def _where_something_is(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the chair (that) A is (not) on", "where A is"."""
    flat = keys(words)
    link, negated = _link(flat)
    if not link:
        return None
    for start in range(1, link):
        subject = words[start:link]
        head = words[: start - 1] if flat[start - 1] in _PRONOUNS else words[:start]
        item, used = _located(subject, objects, facts)
        if item is None:
            continue
        if not bare(head) or keys(bare(head)) in {("place",), ("one",), ("spot",)}:
            return None if negated else (item, used)
        candidates = matching(head, objects)
        left = [c for c in candidates if (c == item) != negated]
        if len(left) == 1 and candidates:
            return left[0], used
    return None


def _link(flat: tuple[str, ...]) -> tuple[int, bool]:
    """Where the verb of a relative clause at the end stands, and whether it is denied; 0 if there is none."""
    lex = lexicon()
    end, negated = len(flat), False
    while end and (
        lex.places.match(flat, end - 1) is not None
        or flat[end - 1] in lex.location_verbs | {"not", "now", "currently", "to", "right"}
    ):
        negated = negated or flat[end - 1] == "not"
        end -= 1
    if 1 < end <= len(flat) and flat[end - 1] in lex.be:
        return end - 1, negated
    # "where A sits": the verb is one of place itself.
    return (end, negated) if 1 < end < len(flat) and flat[end] in lex.location_verbs else (0, False)


def _located(
    subject: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject | None, tuple[Remembered, ...]]:
    """The object that something is remembered to be at, over several facts if need be."""
    used: list[Remembered] = []
    about = bare(subject)
    for _ in range(_MAX_HOPS):
        fact, _several = find_fact(about, facts)
        owner = holder_of(about, facts) if fact is None else None
        if owner is not None and owner.source not in used:
            # "A has it": where A is.
            used.append(owner.source)
            about = owner.owner
            continue
        worked = worked_with(about, objects, facts) if fact is None else None
        if worked is not None:
            return worked[0], (*used, worked[1])
        if fact is None or fact in used:
            return None, ()
        used.append(fact)
        found = ground_phrase(fact.fact.place, objects)
        if found.outcome == "match":
            return found.candidates[0], tuple(used)
        about = fact.fact.place
    return None, ()


def _holding(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the desk with the cup", "the box that contains the keys"."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in _HOLDING), 0)
    if not at:
        return None
    head = words[: at - 1] if flat[at - 1] in _PRONOUNS else words[:at]
    if ground_phrase(words, objects).outcome == "match" or not bare(head):
        return None
    item, used = _located(words[at + 1 :], objects, facts)
    return (item, used) if item is not None and item in matching(head, objects) else None


def _beside(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the chair next to A", where A is no object but remembered to be at one."""
    noun = noun_phrase(words)
    if not noun.core or len(noun.anchors) != 1 or noun.relation in {"of", "from"} or not noun.anchors[0]:
        return None
    if ground_phrase(words, objects).outcome == "match":
        return None
    if ground_phrase(noun.anchors[0], objects).outcome == "match":
        return None
    item, used = _located(noun.anchors[0], objects, facts)
    if item is None:
        return None
    relation = tuple(noun.relation.split())
    size = next((i for i in range(len(words)) if keys(words[i:])[: len(relation)] == relation), 0)
    if not size:
        return None
    found = matching(words[:size], objects)
    if item in found:
        return item, used
    nearest = sorted(found, key=lambda o: (o.x_m - item.x_m) ** 2 + (o.y_m - item.y_m) ** 2)
    return (nearest[0], used) if nearest else None


def _with_adjective(
    words: Phrase, objects: Sequence[MapObject]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the door that is red" the red door."""
    flat = keys(words)
    for index in range(1, len(flat) - 2):
        if flat[index] in {"that", "which"} and flat[index + 1] in lexicon().be and len(flat) == index + 3:
            found = ground_phrase((words[index + 2], *bare(words[:index])), objects)
            return (found.candidates[0], ()) if found.outcome == "match" else None
    return None


def _excluded(words: Phrase, objects: Sequence[MapObject]) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the door that is not red", "the desk without a lamp", "the box, not the old one"."""
    flat = keys(words)
    for index in range(1, len(flat) - 1):
        size = next(
            (
                len(marker)
                for marker in (
                    ("that", "is", "not"),
                    ("which", "is", "not"),
                    ("without",),
                    ("not",),
                    ("with", "no"),
                )
                if flat[index : index + len(marker)] == marker
            ),
            0,
        )
        if not size or index + size >= len(flat):
            continue
        head, refused = bare(words[:index]), bare(words[index + size :])
        if not head or not refused:
            return None
        candidates = matching(head, objects)
        if lexicon().places.match(keys(refused)):
            there = ground_phrase((*head, *words[index + size :]), objects)
            rest = [item for item in candidates if item not in there.candidates]
            told = there.outcome == "match" and len(rest) == 1
            return (rest[0], ()) if told else None
        wanted = {word for word in noun_phrase(refused).core if word not in {"one"}}
        left = [item for item in candidates if not wanted & set(item.description.lower().split())]
        return (left[0], ()) if wanted and len(left) == 1 and len(candidates) > 1 else None
    return None


_TELLING = frozenset({"where", "with", "that", "which", "whose", "what", "whatever", "holding"})
_ANY_HEAD = frozenset({
    "place", "spot", "one", "thing", "location", "there", "position", "object", "whatever", "what", "device",
    "machine", "point", "somewhere", "item",
})  # fmt: skip


def _as_told(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "the place where A turned up", "the hall with the broken lamp": by the fact that says most."""
    flat = keys(words)
    at = next((i for i, key in enumerate(flat) if key in _TELLING and i < len(flat) - 1), -1)
    wanted = content_of(words[at + 1 :]) if at >= 0 and facts else []
    if not wanted or {"not", "no", "never", "without", "nobody", "neither"} & set(flat):
        return None
    head = words[:at]
    while head and lexicon().places.match(keys(head[-1:])) is not None:
        # "The thing under which A is".
        head = head[:-1]
    head = bare(head)
    anything = not head or keys(head)[-1] in _ANY_HEAD
    named = [] if anything else matching(head, objects)
    # "The piece that is on loan": whatever it is called, if all of that was told of one thing.
    candidates = named or (list(objects) if anything or _is_noun(head) else [])
    found: dict[str, tuple[float, MapObject, tuple[Remembered, ...]]] = {}
    for item in reversed(_last_words(facts)):
        score = _fits(wanted, item)
        score = score if anything or named or score == len(wanted) else 0.0
        about = _thing_of(item, objects, facts) if score else None
        # "The gate that is jammed": "the gate of A" need not be on the map itself.
        called = noun_phrase(item.fact.subject).core[-1:] == keys(head)[-1:]
        if about is not None and (about[0] in candidates or called):
            found[about[0].id] = (score, *about)
    best = max((score for score, _, _ in found.values()), default=0.0)
    chosen = [entry for entry in found.values() if entry[0] == best]
    return (chosen[0][1], chosen[0][2]) if len(chosen) == 1 else None


_SAYING = frozenset({
    "remember", "note", "say", "says", "said", "know", "think", "thought", "hope", "hear", "heard", "told",
    "means", "mean", "sure", "so", "such", "now", "it", "is", "are", "believe", "afraid", "notice", "like",
})  # fmt: skip


def _is_noun(head: Phrase) -> bool:
    """Whether words can be what something is called, and no order."""
    lex, flat = lexicon(), keys(head)
    orders = any(lex.verbs.match(flat, i) or lex.reporting.match(flat, i) for i in range(len(flat)))
    return 0 < len(head) < 4 and not orders and not _SAYING & set(flat)


def _last_words(facts: Sequence[Remembered]) -> list[Remembered]:
    """The newest of what is said in the same way of the same thing."""
    newest: dict[tuple[object, ...], Remembered] = {}
    for item in facts:
        fact = item.fact
        kind = "where" if fact.is_location else fact.relation
        newest.setdefault((keys(fact.subject), item.entry.name if fact.another else kind), item)
    return list(newest.values())


def _fits(wanted: Sequence[str], item: Remembered) -> float:
    """How much of what is wanted a fact says; nothing if it is about something else."""
    if item.fact.negated or not item.fact.subject:
        return 0.0
    score = shared(wanted, item)
    if score == len(wanted):
        return score
    subject = item.fact.subject
    relative = next((i for i, word in enumerate(subject) if i and word.key in _PRONOUNS), len(subject))
    core = noun_phrase(subject[:relative]).core
    named = bool(core) and any(core[-1] in alike(word) for word in wanted)
    return score if named and score >= len(wanted) / 2 else 0.0


def _thing_of(
    item: Remembered, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """The object that a fact is about: where its subject is, the subject, or where that is said to be."""
    fact = item.fact
    if fact.is_location:
        found = ground_phrase(fact.place, objects)
        if found.outcome == "match":
            return found.candidates[0], (item,)
        where, used = _located(fact.place, objects, facts)
        if where is not None:
            return where, (item, *used)
    of = keys(fact.subject).index("of") + 1 if "of" in keys(fact.subject) else len(fact.subject)
    for phrase in (fact.subject, *noun_phrase(fact.subject).anchors, fact.subject[of:]):
        found = ground_phrase(phrase, objects, strict=True)
        if found.outcome == "match":
            return found.candidates[0], (item,)
    for index, word in enumerate(fact.state[:-1]):
        if word.key in _TO_PLACES:
            found = ground_phrase(where_only(fact.state[index + 1 :]), objects, strict=True)
            if found.outcome == "match":
                return found.candidates[0], (item,)
    where, used = _located(fact.subject, objects, facts)
    return (where, (item, *used)) if where is not None else None


_TO_PLACES = frozenset({"from", "to", "at", "in", "on", "through", "via", "by", "into"})
