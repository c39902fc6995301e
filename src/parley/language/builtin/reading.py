"""From spans to what is wished and told: frames with roles, who agrees on them, and what is left over."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from operator import itemgetter

from parley.language.builtin.amounts import amount_of, direction_of
from parley.language.builtin.lexicon import Lexicon, lemmas
from parley.language.builtin.retyping import PLACING, looks_here, retyped
from parley.language.builtin.spans import Filler, Parse, Span, Verb
from parley.language.builtin.wishes import Wish, Witness
from parley.language.lexicon import word_set
from parley.umrf.kinds import is_word_for

__all__ = ["Reading", "read"]


@dataclass(frozen=True, slots=True)
class Reading:
    """What a message says."""

    acts: frozenset[str]
    wishes: tuple[Wish, ...]
    """In their order, facts that are told among them."""
    loose: tuple[Filler, ...]
    """What belongs to no frame."""
    left_over: tuple[str, ...]
    """Words that no part of the reading accounts for."""
    manner: tuple[str, ...] = ()
    """Words about how it is to be done."""
    about: tuple[str, ...] = ()
    """Of whom or what something is told that is no frame: "Kim" in "Kim is tired"."""
    moves: frozenset[str] = frozenset()
    """Which answers and controls are in it: yes, no, stop, pause, resume, cancel, again."""
    unsteady: tuple[str, ...] = ()
    """Words that the tagger is not sure of: a word of courtesy before them changes what they are."""


def read(parse: Parse, lexicon: Lexicon) -> Reading:
    """What is wished and told."""
    wishes: list[Wish] = []
    parse = replace(parse, spans=tuple(_listed_on(parse, span) for span in parse.spans))
    spans = [
        part
        for span in _ordered_alone(parse, _merged(parse, lexicon))
        for part in _by_way(parse, span, lexicon)
    ]
    spans = [part for span in spans for part in _one_by_one(parse, span, lexicon)]
    for at, span in enumerate(spans):
        spans[at] = _going_on(parse, span, spans[:at])
    fillers = [_filler(parse, span, lexicon) for span in spans]
    for number, verb in enumerate(parse.verbs):
        mine = [filler for filler, span in zip(fillers, spans, strict=True) if span.owner == number]
        wishes.append(_wish(parse, verb, mine, lexicon))
    loose = [filler for filler, span in zip(fillers, spans, strict=True) if span.owner is None]
    steered = {*"HN"} <= {filler.role for filler in loose} and not parse.verbs  # "left thirty degrees"
    implied = [_implied(parse, filler, lexicon, steered) or _asked_for(parse, filler) for filler in loose]
    implied_wishes = _joined([wish for wish in implied if wish is not None])
    rest = tuple(filler for filler, wish in zip(loose, implied, strict=True) if wish is None)
    if len(implied_wishes) == 1 and implied_wishes[0].frame == "BRING":  # "I'd like the box from the desk"
        where = tuple(filler for filler in rest if filler.role in "SL")
        implied_wishes = [replace(implied_wishes[0], fillers=(*implied_wishes[0].fillers, *where))]
        rest = tuple(filler for filler in rest if filler not in where)
    ordered = sorted([*wishes, *implied_wishes], key=lambda wish: wish.start)
    wanted = _without_openers(_once([retyped(wish, lexicon) for wish in ordered]), parse)
    spread = [part for wish in _shared(wanted) for part in _spread(wish)]
    turns = _turns(spread, parse, lexicon)
    spread = [wish for _, wish in sorted(zip(turns, spread, strict=True), key=itemgetter(0))]
    idle = _left_over(parse, lexicon)
    manner = tuple(word for word in idle if word.lower() in lexicon.classes["manner"])
    looks = lexicon.classes["looking"] if any(wish.frame == "LOOK" for wish in spread) else frozenset()
    looks |= {"last"} if 2 in turns else frozenset()
    left = tuple(word for word in idle if word not in manner and word.lower() not in looks)
    moves = frozenset(parse.moves) - {"none"}
    return Reading(_acts(parse), tuple(spread), rest, left, manner, _about(parse, lexicon), moves)


def _acts(parse: Parse) -> frozenset[str]:
    """What is done by saying it; neither a call before "can you go there?" nor the mark behind it asks."""
    lows = [token.low for token in parse.tokens]
    at = next((at for at, pair in enumerate(pairwise(lows)) if pair in _REQUESTS), None)
    if at is None:
        return frozenset(parse.acts)
    first = at if lows[1:2] == [","] and at == 2 else 0
    pairs = list(zip(parse.acts, parse.tokens, strict=True))[first:]
    return frozenset(act for act, token in pairs if token.is_word)


_REQUESTS = {(modal, "you") for modal in ("can", "could", "will", "would")}


def _ordered_alone(parse: Parse, spans: list[Span]) -> list[Span]:
    """Where an order has what it wants, what was only told before it is not wanted as well."""
    wanted = {(span.owner, span.role) for span in spans if not _only_told(parse, span)}
    return [
        span
        for span in spans
        if span.owner is None or (span.owner, span.role) not in wanted or not _only_told(parse, span)
    ]


def _only_told(parse: Parse, span: Span) -> bool:
    """Whether a span stands in what is told besides an order: "Kim" in "Kim is tired, bring her tea"."""
    acts = {parse.acts[at] for at in range(span.start, span.end)}
    behind = next((verb.start for verb in parse.verbs if verb.start >= span.end), None)
    return acts <= {"need", "told"} and behind is not None and parse.acts[behind] == "order"


def _at_places(parse: Parse, last: Span, span: Span, lexicon: Lexicon) -> bool:
    """Whether a further place follows one in a statement: "if there is a box at the desk and the gate"."""
    low = [token.low for token in parse.tokens[last.start : last.end]]
    led = max((at for at, word in enumerate(low) if word in lexicon.classes["prepositions"]), default=0)
    states = {*low[led:]} & lexicon.classes["being"] or led == 0
    return last.role == "K" and span.role in "TLG" and not states


def _merged(parse: Parse, lexicon: Lexicon) -> list[Span]:
    """Spans of one role that touch each other are one; a role behind a later verb belongs to that one."""
    found: list[Span] = []
    for span in parse.spans:
        if _fills_nothing(parse, span):
            continue
        last = found[-1] if found else None
        letter = span.end - span.start == 1 and len(parse.tokens[span.start].low) == 1
        if last is not None and last.role == "E" and letter and last.end == span.start:
            found[-1] = replace(last, end=span.end)  # "but not lift A"
            continue
        if last is not None and last.role == span.role and last.end == span.start and span.role in "NGTSLHXK":
            head = span.head if span.role in "NH" else last.head
            found[-1] = replace(last, end=span.end, head=head, share=min(last.share, span.share))
            continue
        if last is not None and (same := _same_one(parse, last, span)) is not None:
            found[-1] = same
            continue
        alike = last is not None and (last.role == span.role == "L" or _at_places(parse, last, span, lexicon))
        if alike and last is not None and span.owner in (None, last.owner):
            between = [token.low for token in parse.tokens[last.end : span.start]]
            if {*between} <= {",", "and"} and "and" in between:  # "at the desk and at the gate"
                found[-1] = replace(last, end=span.end, share=min(last.share, span.share))
                continue
        if last is not None and last.end == span.start and _is_its_place(parse, last, span):
            found[-1] = replace(last, end=span.end)
            continue
        nearest = max((n for n, verb in enumerate(parse.verbs) if verb.start < span.start), default=None)
        if span.owner is not None and nearest is not None and span.owner < nearest and span.role in "TGSRHN":
            span = replace(span, owner=nearest)
        told = next((n for n, verb in enumerate(parse.verbs) if verb.start == span.end), None)
        other = parse.verbs[span.owner].frame if span.owner is not None else ""
        joined = span.start > 1 and parse.tokens[span.start - 1].low == "and"
        if span.role == "T" and joined and told and other == parse.verbs[told].frame == "BELOC":
            span = replace(span, owner=told)  # "... and Kim is at the desk": of whom that is told
        later = nearest is not None and span.owner is not None and span.owner > nearest
        if later and nearest is not None and _apart(parse, span, nearest):
            span = replace(span, owner=nearest)
        found.append(span)
    return found


def _same_one(parse: Parse, thing: Span, span: Span) -> Span | None:
    """One of which it is said behind a comma which one it is: "the crate, the one with the lid"."""
    if span.start != thing.end + 1:
        return None
    low = [token.low for token in parse.tokens[thing.end : span.end]]
    more = low[:3] == _THE_ONE and low[3:]
    return replace(thing, end=span.end) if more else thing if _which_one(parse, thing.end) else None


def _is_its_place(parse: Parse, thing: Span, place: Span) -> bool:
    """Whether a place is a part of how a thing is called: "the crane nearest to the desk, go there"."""
    if parse.tokens[thing.end - 1].low in _MOST and thing.role in "TG" and place.role in "GLS":
        return True
    if thing.role != "T" or thing.owner is not None or place.role not in "GL":
        return False
    if place.owner is None:
        return place.role == "L"
    verb = parse.verbs[place.owner].start
    return bool({token.low for token in parse.tokens[place.end : max(verb, place.end)]} & _BREAKS)


_MOST = frozenset({"nearest", "closest", "nearer", "closer", "furthest", "farthest", "further", "farther"})


def _fills_nothing(parse: Parse, span: Span) -> bool:
    """Whether a span is a word that only leads to another one: "over to the desk", "their question"."""
    word = parse.tokens[span.start].low
    behind = parse.tokens[span.end].low if span.end < len(parse.tokens) else ""
    if span.end - span.start > 1:
        return False
    led = any(span.end == other.start and other.role in "GR" for other in parse.spans)
    return word in _BARE or (word in _OVER and led) or (behind in _QUESTIONS and span.role in "TX")


def _listed_on(parse: Parse, span: Span) -> Span:
    """With the last of a row of letters or numbers that nothing else claims: "bays 1, 2 and 3", "bay A"."""
    last, *behind = parse.tokens[span.end - 1 : span.end + 2]
    taken = [(one.start, one.end) for one in parse.spans] + [(one.start, one.end) for one in parse.verbs]
    alone = not any(start <= span.end < end for start, end in taken)
    if behind and alone and _mark(behind[0].text) and is_word_for(last.low, "place"):
        return replace(span, end=span.end + 1)
    row = [token.low if token.low == "and" else _mark(token.text) for token in (last, *behind)]
    free = all(other.start > span.end + 1 or other.end <= span.end for other in parse.spans)
    if span.role not in "TGL" or row not in (["A", "and", "A"], ["1", "and", "1"]) or not free:
        return span
    return replace(span, end=span.end + 2)


def _one_by_one(parse: Parse, span: Span, lexicon: Lexicon) -> list[Span]:
    """Each of a list with commas of things that are called alike: "bay A, bay B"."""
    small, tokens = lexicon.classes["determiners"], parse.tokens
    begins = [at for at in range(span.start, span.end) if tokens[at].low not in small]
    alike = {at for at in begins if tokens[at].low == tokens[begins[0]].low}
    cuts = [at for at in range(span.start + 1, span.end - 1) if tokens[at].low == ","]
    cuts = [at for at in cuts if next((n for n in begins if n > at), -1) in alike]
    leads = lexicon.classes["prepositions"] | small | lexicon.classes["quantifiers"] | {"and", "or", ","}
    marks = {*cuts}
    cuts += [
        at
        for at in range(span.start + 2, span.end - 1)
        if span.role == "G" and tokens[at].low == "the" and tokens[at - 1].low not in leads
    ]  # "the bar the pool"
    edges = [span.start, *sorted(cuts), span.end] if span.role in "TG" else []
    parts = [(start + (start in marks), end) for start, end in pairwise(edges)]
    return [
        replace(span, start=a, end=b, head=span.head if a <= span.head < b else b - 1) for a, b in parts
    ] or [span]


def _going_on(parse: Parse, span: Span, before: Sequence[Span]) -> Span:
    """A thing that only "and then" leads to, as one more that the same is done with."""
    last = before[-1] if before else None
    if last is None or last.owner is None:
        return span
    on_the_spot = parse.verbs[last.owner].frame in _REPEATED - {"GO", "BRING", "TAKE"}
    ours = span.owner == last.owner or (span.owner is None and parse.tokens[span.start].low not in _BACK)
    stray = span.role == "G" and ours and last.role == "T" and on_the_spot
    if not stray and (span.role != "T" or span.owner is not None):
        return span
    between = [token.low for token in parse.tokens[last.end : span.start]]
    on = {*between} & _ON and {*between} <= _ON | {"and", ",", "also", "the", "please"}
    return replace(span, role=last.role, owner=last.owner) if on and last.role in "TG" else span


_BACK = frozenset({"to", "back", "home", "into", "over"})
_ON = frozenset({"then", "next", "afterwards", "finally", "lastly"})


def _mark(text: str) -> str:
    """What kind of name a letter or a number is."""
    return "1" if text.isdigit() else "A" if len(text) == 1 and text.isupper() and text != "I" else ""


_WAYS = frozenset({"past", "via", "through", "along", "around", "by", "across"})


def _by_way(parse: Parse, span: Span, lexicon: Lexicon) -> list[Span]:
    """Where to, apart from the way there: "past the desk" is no goal of "go past the desk to the door"."""
    low = [token.low for token in parse.tokens[span.start : span.end]]
    if span.role != "G" or low[0] not in _WAYS or "to" not in low[2:-1]:
        return [span]
    if {*low} & lexicon.classes["parts"]:  # "through the door to the front"
        return [span]
    to = span.start + low.index("to", 2)
    way = replace(span, role="M", end=to, head=min(span.head, to - 1))
    return [way, replace(span, start=to, head=span.end - 1)]


def _apart(parse: Parse, span: Span, nearest: int) -> bool:
    """Whether a role stands with the verb before it, parted by a mark from the later one it was given."""
    verb, owner = parse.verbs[nearest], parse.verbs[span.owner or 0]
    low = [token.low for token in parse.tokens]
    return not {*low[verb.end : span.start]} & _BREAKS and bool({*low[span.end : owner.start]} & _BREAKS)


_BARE = frozenset({"to", "for", "at", "of", "by", "from", "with"})
"""What fills no role alone."""
_QUESTIONS = frozenset({"question", "questions"})
_OVER = frozenset({"over", "back", "across"})
"""What fills none before a goal: "bring it over to the desk"."""


def _without_openers(wishes: list[Wish], parse: Parse) -> list[Wish]:
    """Without a bare "go" or "turn" that only opens the next wish ("go get a box", "turn and face it")."""
    kept: list[Wish] = []
    for wish, behind in zip(wishes, [*wishes[1:], None], strict=False):
        near = behind is not None and behind.start - wish.start <= len(wish.verb.split()) + 1
        opens = wish.frame in ("GO", "TURN", "MOVE") or wish.verb.split(" ")[0] in ("go", "come")
        bare = not wish.fillers and not wish.negated and opens
        between = parse.tokens[wish.start : behind.start] if behind is not None else ()
        apart = any(token.low in ("then", ",", ".") for token in between)
        reports = kept and wish.frame == "LOOK" and kept[-1].frame in ("LOOK", "FIND", "COUNT")
        if reports and looks_here(kept[-1]):
            kept[-1] = wish  # "look around and tell me what is on the desk"
            continue
        if (reports and not wish.fillers) or (
            near and bare and not apart and behind is not None and behind.act == wish.act
        ):
            continue
        kept.append(wish)
    return kept


def _once(wishes: list[Wish]) -> list[Wish]:
    """With one wish for a verb that was found twice: "go find" and the "find" in it."""
    found: list[Wish] = []
    for wish in wishes:
        last = found[-1] if found else None
        within = last is not None and wish.start < last.start + len(last.verb.split())
        if last is not None and within and last.frame == wish.frame:
            more = tuple(filler for filler in last.fillers if not wish.has(filler.role))
            found[-1] = replace(wish, fillers=(*wish.fillers, *more))
            continue
        found.append(wish)
    return found


def _shared(wishes: list[Wish]) -> list[Wish]:
    """With the thing of the next wish where a verb has none: "find and bring the box"."""
    found = list(wishes)
    for at in range(len(found) - 2, -1, -1):
        wish, behind = found[at], found[at + 1]
        near = behind.start - wish.start <= len(wish.verb.split()) + 1
        thing = behind.one("T")
        if near and not wish.fillers and thing is not None and wish.frame in _SHARING and not wish.negated:
            found[at] = replace(wish, fillers=(thing,))
        carried = behind.frame in _HANDING and wish.frame in _GETTING and behind.has("RG")
        if carried and wish.has("T") and not behind.has("T") and not (wish.negated or behind.negated):
            it = Filler("T", behind.start, behind.start, 0, ("it",), behind.share, "it")
            found[at + 1] = replace(behind, fillers=(*behind.fillers, it))  # "take the box and give to Kim"
    return found


_HANDING = frozenset({"GIVE", "PUT", "BRING"})
_GETTING = frozenset({"TAKE", "FIND", "BRING"})
_SHARING = frozenset({"FIND", "TAKE", "LOOK", "FOLLOW"})


def _turns(wishes: list[Wish], parse: Parse, lexicon: Lexicon) -> list[int]:
    """Of each wish whether it comes first (0) or last (2): "the gate last", "finish at the desk"."""
    low = [token.low for token in parse.tokens] + [""]
    words = {word for wish in wishes for filler in wish.fillers for word in filler.words}
    bound = words & (lexicon.classes["pronouns"] | lexicon.classes["there"])
    simple = all(wish.frame == wishes[0].frame and not wish.negated and wish.act != "told" for wish in wishes)
    if bound or not simple:
        return [1] * len(wishes)
    said = [{wish.verb.split(" ")[0], *(low[filler.end] for filler in wish.fillers)} for wish in wishes]
    return [0 if one & _BEGINS else 2 if one & _ENDS else 1 for one in said]


_BEGINS = frozenset({"start", "begin", "first"})
_ENDS = frozenset({"finish", "end", "last"})
_NAMED = frozenset("TGSLR")
"""Roles that name a thing, a place or a person."""
_ALONG = frozenset({"down", "up", "round", "over", "back", "home"})
_FOCUS = frozenset({"only", "just", "merely", "solely"})


def _filler(parse: Parse, span: Span, lexicon: Lexicon) -> Filler:
    start, end = span.start, span.end
    while end - 1 > span.head and not parse.tokens[end - 1].is_word:
        end -= 1
    if span.role in _NAMED:  # "only gate 1", "gate 1 only": that one
        while start < end - 1 and parse.tokens[start].low in _FOCUS:
            start += 1
        while end - 1 > start and parse.tokens[end - 1].low in _FOCUS:
            end -= 1
        if end - start > 2 and parse.tokens[end - 1].low == "there":  # "from the desk there"
            end -= 1
    asks = next((at for at in range(start, min(start + 2, end)) if parse.tokens[at].low == "where"), end)
    if span.role in "GLT" and end - asks > 2 and parse.tokens[end - 1].low in lexicon.classes["being"]:
        start, end = asks + 1, end - 1  # "to where the desk is"
    if span.role in "GLP" and end - start > 2 and parse.tokens[start].low in _ALONG:
        led = parse.tokens[start + 1].low
        start += led in ("to", "at") or led in lexicon.classes["determiners"]  # "down the hall", "up to it"
    words = tuple(token.low for token in parse.tokens[start:end])
    head = min(max(span.head, start), end - 1) - start
    glue = next((at for at in range(len(words)) if list(words[at : at + 3]) == _THE_ONE), len(words))
    words = (*words[:glue], *words[glue + 3 :])
    if span.role in "TG" and (which := _which_one(parse, end)):  # "the chair, the large one"
        words, head = (*words[:head], *which, *words[head:]), head + len(which)
    small = lexicon.classes["prepositions"] | lexicon.classes["determiners"]
    first = next((at for at, word in enumerate(words) if word not in small), None)
    if first is not None and span.role in _NAMED:
        behind = (at for at in range(first, len(words)) if words[at] in small - {"of", "'s"})
        stop = next(behind, len(words))
        if words[head] in small or head >= stop:
            head = stop - 2 if words[stop - 1] == "of" else stop - 1
    return Filler(span.role, span.start, span.end, head, words, span.share, parse.said(start, end))


_THE_ONE = [",", "the", "one"]


def _which_one(parse: Parse, end: int) -> tuple[str, ...]:
    """The words that say behind a thing which of several it is: "large" in "the chair, the large one"."""
    low = [token.low for token in parse.tokens[end : end + 6]]
    size = low.index("one") if "one" in low else 0
    marked = low[:1] in ([","], ["-"], ["–"], [":"]) and low[1:2] == ["the"] and size > 2
    return tuple(low[2:size]) if marked and all(word.isalpha() for word in low[2:size]) else ()


def _wish(parse: Parse, verb: Verb, mine: list[Filler], lexicon: Lexicon) -> Wish:
    words = [token.low for token in parse.tokens[verb.start : verb.end]]
    small = lexicon.classes["determiners"]
    particles = [word for at in verb.particles if (word := parse.tokens[at].low) not in small]
    while len(words) > 1 and words[-1] in small:
        words = words[:-1]
    while words and (words[0] in ("don't", "dont", "not", "never", "do") and len(words) > 1):
        words = words[1:]
    end, longer = _reach(parse, verb, lexicon)
    behind = tuple(token.low for token in parse.tokens[end : end + 2])
    if verb.frame == "GO" and behind in _TO_US and not any(filler.role == "G" for filler in mine):
        mine = [*(f for f in mine if f.start != end), Filler("G", end, end + 2, 1, behind, 1.0, "to me")]
    known = longer or lexicon.frames_of(words, particles)
    if len(words) > 1 and words[0] in ("go", "come"):
        known |= lexicon.frames_of(words[1:], particles)  # "go look at it"
    known |= {general for special, general in _KIND_OF.items() if special in known}
    lone = longer or (known if verb.share < _GUESSED else frozenset())  # several words leave no doubt
    meant = len(lone) == 1 and verb.frame not in known and parse.acts[verb.start] == "order"
    frame = next(iter(lone)) if meant else verb.frame
    witness: Witness = "agrees" if frame in known else "differs" if known else "unknown"
    negated = _negated(parse, verb, lexicon)
    if negated is None or verb.mode in _NOT_SIMPLY_NOW:
        witness = "differs"
    act = parse.acts[verb.start]
    said = " ".join([*words, *(token.low for token in parse.tokens[verb.end : end]), *particles])
    return Wish(frame, verb.start, said, tuple(mine), verb.share, witness, act, bool(negated), verb.otherwise)


_GUESSED = 0.5
"""Below that the lexicon is believed, where it knows a verb for one thing only: to "meet" is to find."""
_TO_US = frozenset({("to", "me"), ("to", "us")})
_NOT_SIMPLY_NOW = frozenset({"later", "earlier", "allowed"})
"""What the tagger sees in a clause by itself: its place is elsewhere, or it is let and not wanted."""


def _negated(parse: Parse, verb: Verb, lexicon: Lexicon) -> bool | None:
    """Whether a verb is forbidden; None if the tagger and the small words before it do not agree."""
    low = [token.low for token in parse.tokens]
    marks = [at for at in range(verb.start) if low[at] in _BREAKS]
    start = marks[-1] + 1 if marks else 0
    said = any(word in lexicon.classes["negations"] for word in low[start : verb.end])
    if said == verb.negated:
        return said
    if verb.negated and marks and low[marks[-1]] == "or":
        return True
    return False if verb.negated and marks and low[marks[-1]] != "and" else None


_BREAKS = frozenset({",", ";", ".", ":", "then", "but", "and", "or"})


def _reach(parse: Parse, verb: Verb, lexicon: Lexicon) -> tuple[int, frozenset[str]]:
    """Where a verb ends with the words behind it that the lexicon knows to belong to it, and what that is."""
    words = [token.low for token in parse.tokens[verb.start : verb.end]]
    behind = [token.low for token in parse.tokens[verb.end : verb.end + 2]]
    for size in range(len(behind), 0, -1):
        found = frozenset[str]() if verb.particles else lexicon.exactly([*words, *behind[:size]])
        if found:
            return verb.end + size, found
    return verb.end, frozenset()


_KIND_OF = {"FACE": "TURN", "MOVE": "GO"}


def _implied(parse: Parse, filler: Filler, lexicon: Lexicon, steered: bool) -> Wish | None:
    """The frame of a goal, a direction or an angle that stands without a verb."""
    acts = ("order", "edit", "answer") if steered else ("order", "edit")
    if parse.acts[filler.start] not in acts or filler.role not in "GHN":
        return None
    frame = "GO"
    if filler.role == "N":
        amount = amount_of(filler.words)
        frame = "TURN" if amount is not None and amount.kind == "angle" else "GO"
    elif filler.role == "H":
        frame = "TURN" if direction_of(filler.words, lexicon) in ("left", "right") else "GO"
    return Wish(
        frame, filler.start, "", (filler,), filler.share, "unknown" if filler.role == "G" else "agrees"
    )


def _asked_for(parse: Parse, filler: Filler) -> Wish | None:
    """The frame of a thing that somebody wants, without a word for what is done: "I'd like the box"."""
    low = [token.low for token in parse.tokens[: filler.start]]
    wants = {"i", "we"} & {*low} and {"like", "want", "have", "get"} & {*low[-2:]}
    if parse.verbs or filler.role != "T" or parse.acts[filler.start] != "order" or not wants:
        return None
    me = Filler("R", filler.end, filler.end, 0, ("me",), 1.0, "me")
    return Wish("BRING", filler.start, "bring", (filler, me), filler.share, "agrees")


def _joined(wishes: list[Wish]) -> list[Wish]:
    """A direction and an amount side by side are one wish."""
    found: list[Wish] = []
    for wish in wishes:
        last = found[-1] if found else None
        near = last is not None and wish.start - last.fillers[-1].end < 2
        if last is not None and near and {last.fillers[0].role, wish.fillers[0].role} == {"H", "N"}:
            frame = "TURN" if "TURN" in (last.frame, wish.frame) else "GO"
            fillers = (*last.fillers, *wish.fillers)
            found[-1] = replace(last, frame=frame, fillers=fillers, share=min(last.share, wish.share))
        else:
            found.append(wish)
    return found


_MANY = ("T", "G", "L")
_REPEATED = word_set("GO LOOK FIND ON OFF OPEN CLOSE COUNT CLEAN TAKE BRING DO PHOTO")


def _spread(wish: Wish) -> list[Wish]:
    """One wish for each of several goals or things, if that is all that there are several of."""
    for role in _MANY:
        several = wish.all(role)
        if role == "L" and (
            wish.frame != "LOOK" or wish.has("T") or any(f.words[0] in PLACING for f in several)
        ):
            continue  # "in the office near the desk" is one place
        if wish.negated and len(several) == 2 and several[1].start - several[0].end == 1:
            others = tuple(filler for filler in wish.fillers if filler.role != role)
            instead = replace(wish, start=several[1].start, negated=False, fillers=(*others, several[1]))
            return [replace(wish, fillers=(*others, several[0])), instead]
        if len(several) > 1 and wish.frame in _REPEATED:
            others = tuple(filler for filler in wish.fillers if filler.role != role)
            return [
                replace(wish, start=wish.start if not number else one.start, fillers=(*others, one))
                for number, one in enumerate(several)
            ]
    return [wish]


_LEADING = frozenset({"with", "to", "for", "at", "of", "by", "from", "in", "into"})
"""What may lead to a role without being part of it; "on" and "off" may be half a verb."""


def _is_name(word: str, lexicon: Lexicon) -> bool:
    """Whether the first word of a message may be left out: the name of who is called, "perfect, ..."."""
    verbs = any((lemma,) in lexicon.verbs for lemma in lemmas(word))
    return (
        word.isalpha()
        and len(word) > 2
        and not verbs
        and not any(word in words for name, words in lexicon.classes.items() if name != "openers")
    )


def _about(parse: Parse, lexicon: Lexicon) -> tuple[str, ...]:
    """The words before the first "is", "has" and the like of what is told."""
    low = [token.low for token in parse.tokens]
    told = (at for at, act in enumerate(parse.acts) if act in ("told", "need"))
    end = next((at for at in told if low[at] in lexicon.classes["being"]), 0)
    start = end
    while start and parse.tokens[start - 1].is_word and low[start - 1] not in _BREAKS:
        start -= 1
    words = tuple(word for word in low[start:end] if word not in lexicon.classes["small"])
    return words if end and len(words) < 4 else ()


def _runs_on(parse: Parse, at: int) -> bool:
    """Whether something told is no sentence of its own: without a verb, and not parted from an order."""
    start, end = at, at
    while start > 0 and parse.acts[start - 1] == parse.acts[at]:
        start -= 1
    while end < len(parse.tokens) and parse.acts[end] == parse.acts[at]:
        end += 1
    told = any(start <= verb.start < end for verb in parse.verbs)
    behind = end < len(parse.tokens) and parse.acts[end] == "order" and parse.tokens[end - 1].is_word
    marked = end < len(parse.tokens) and not parse.tokens[end].is_word
    joins = end < len(parse.tokens) and parse.tokens[end].low in ("and", "or")
    return behind and not marked and not told and joins


def _leading(parse: Parse, verb: Verb, lexicon: Lexicon) -> set[int]:
    """The words right before a verb that forbid it or only join it: "but do not", "and never"."""
    found: set[int] = set()
    for at in range(verb.start - 1, -1, -1):
        word = parse.tokens[at].low
        if word in lexicon.classes["negations"] and verb.negated and _negated(parse, verb, lexicon):
            found.add(at)
        elif word == "but":
            return found | {at}
        elif word not in lexicon.classes["small"]:
            return found
    return found


def _opened(parse: Parse, verb: Verb) -> set[int]:
    """A bare "go" or "come" before a verb, that the tagger gave no frame: "go and tell him"."""
    at = verb.start - 1
    at -= at > 0 and parse.tokens[at].low == "and"
    opens = at >= 0 and parse.tokens[at].low in ("go", "come") and parse.acts[at] == "order"
    return {at} if opens else set()


_STATES_OF_ONES_OWN = 3
"""So many words at most say how the speaker is."""


def _states(parse: Parse, lexicon: Lexicon) -> set[int]:
    """The words of "I am tired" and "it's really stuffy" beside an order: nothing is wished by them."""
    low = [token.low for token in parse.tokens]
    orders = [verb.start for verb in parse.verbs if parse.acts[verb.start] == "order"]
    named = {at for span in parse.spans if span.role in _NAMED for at in range(span.start, span.end)}
    kinds = ("logic", "mental", "prepositions", "determiners", "clock")
    found: set[int] = set()
    for at in range(len(low) - 2 if orders else 0):
        if low[at] not in _WHO or low[at + 1] not in _ARE or (at and low[at - 1] not in _BREAKS | _WHY):
            continue
        end = at + 2
        while end < len(low) and end not in orders and parse.tokens[end].is_word and low[end] not in _BREAKS:
            end += 1
        said = {*low[at + 2 : end]}
        bound = any(said & lexicon.classes[one] for one in kinds) or named & {*range(at + 2, end)}
        before = low[at] not in ("i", "we") or end <= max(orders)
        if said and len(said) <= _STATES and before and not bound:
            found |= {*range(at - (at > 0 and low[at - 1] in _WHY), end)}
    return found


_WHO = frozenset({"i", "we", "it", "he", "she", "they"})
_ARE = frozenset({"am", "'m", "are", "'re", "feel", "is", "'s", "was", "were", "has", "looks", "seems"})
_WHY = frozenset({"because", "since", "as"})
_STATES = 3
"""So many words at most say how somebody or something is."""


def _wanting(parse: Parse) -> set[int]:
    """The word before what is to be done with a thing: "the gate needs closing", "the gate wants a look"."""
    ordered = {verb.start for verb in parse.verbs if parse.acts[verb.start] == "order" and not verb.negated}
    said = [at for at, token in enumerate(parse.tokens) if token.low in _WANTING]
    return {at for at in said if ordered & {at + 1, at + 2}}


_WANTING = frozenset({"need", "needs", "want", "wants", "requires", "ought", "deserves"})


def _ones(lexicon: Lexicon) -> frozenset[str]:
    return lexicon.classes["determiners"] | {"one"}


def _left_over(parse: Parse, lexicon: Lexicon) -> tuple[str, ...]:
    taken: set[int] = set()
    for verb in parse.verbs:
        end, _ = _reach(parse, verb, lexicon)
        taken |= {*range(verb.start, end), *verb.particles}
        taken |= _leading(parse, verb, lexicon)
    for span in parse.spans:
        which = _which_one(parse, span.end)
        taken |= set(range(span.start, span.end + (len(which) + 3 if which else 0)))
    taken |= _states(parse, lexicon) | _wanting(parse)
    taken |= {at for verb in parse.verbs for at in _opened(parse, verb)}
    if any(verb.frame == "ANSWER" for verb in parse.verbs):
        asked = [at for at, token in enumerate(parse.tokens) if token.low in ("question", "questions")]
        taken |= {*asked, *(at - 1 for at in asked if parse.tokens[at - 1].low in _ones(lexicon))}
    low = [token.low for token in parse.tokens]
    starts = {span.start for span in parse.spans}
    small = lexicon.classes["small"]
    left = []
    for at, token in enumerate(parse.tokens):
        letter = at > 0 and len(low[at]) == 1 and token.text.isupper() and low[at] != "i"
        told = parse.acts[at] in ("social", "told", "need") and not _runs_on(parse, at)
        if at in taken or not token.is_word or told or (low[at] in small and not letter):
            continue
        leads = low[at] in _LEADING or low[at : at + 2] == ["close", "to"] or low[at] == "back"
        if leads and at + 1 in starts:
            continue
        if low[at] == "with" and low[at + 1 : at + 2] in (["me"], ["us"]):
            continue
        if low[at] == "but" and at + 1 in starts and any(verb.negated for verb in parse.verbs):
            continue
        if at == 0 and _is_name(token.low, lexicon) and len(low) > 1:
            continue
        if any(
            " ".join(low[max(at - back, 0) : at - back + size]) in small
            for size in (2, 3, 4, 5)
            for back in range(size)
        ):
            continue
        left.append(token.text)
    return tuple(left)
