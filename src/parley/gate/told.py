"""Rules that people tell in plain language, turned into rules by code; they count after a person's yes.

Only what says clearly that it holds from now on is a rule: "never", "nobody", "always ask", "must not". All
else is None, and goes on to whoever understands orders.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from parley.gate.told_hours import hours_in
from parley.messages.rules import Hours, Rule
from parley.messages.status import ActionInfo
from parley.sentences import sentence
from parley.world.object_map import MapArea, MapObject

__all__ = ["DraftRule", "NotUnderstood", "keeps_away", "lifted_place", "named_place", "told_rule"]


@dataclass(frozen=True, slots=True)
class DraftRule:
    """A rule that somebody told; it does not hold yet."""

    rule: Rule
    others: tuple[Rule, ...] = field(default=())
    """Other ways in which it can be meant."""


@dataclass(frozen=True, slots=True)
class NotUnderstood:
    """It is a rule, but not clear which."""

    sentence: str
    """What is missing, for the person."""


_MAX_CHARS: Final = 300
_MARGIN_M: Final = 0.3
_AROUND_M: Final = 1.0
_BEFORE_M: Final = 0.7
"""Around a thing that is not to be gone to: where one stands who is there."""

_BEGIN: Final = re.compile(
    r"^(?:(?:please|from now on|remember|note|rule|palun|edaspidi|reegel)\b[:,]?\s*(?:that\s+)?)+"
)
_ASK: Final = re.compile(
    r"^(?:always ask|ask (?:me |us )?every time|ask(?= (?:me|us) before)|küsi alati|alati küsi)"
    r"(?: me| us| somebody| minult| meilt| luba)?(?: first)?,?"
    r" (?:before|enne kui|enne) (?P<rest>.+)$"
)
_SPEED: Final = re.compile(
    r"^(?P<who>.*?)\s*\b(?:not|no|never|mitte|ära sõida)\b(?: (?:drive|go|move|be|kunagi))*"
    r" (?:faster|kiiremini|quicker)"
    r"(?: than|,? kui) (?P<number>half a|a half|one|two|pool|poole|üks|kaks|\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>m/s|met(?:re|er)s? (?:per|a) second|meetrit sekundis|km/h|kilomet(?:re|er)s? (?:per|an) hour"
    r"|kilomeetrit tunnis)(?:\s*(?:in|inside|through|within)? (?P<place>.+))?$"
)
_NEVER: Final = re.compile(
    r"^(?:(?P<all>nobody|no one|no robots?|none of you|keegi|ükski robot)"
    r"(?: (?:may|must|shall|should|ought to|is to|has to|needs to|is allowed to|ei tohi|ei sõida|ei lähe))?"
    r"(?: ever| kunagi)?"
    r"|(?P<you>never|you (?:must|may|shall|should|ought to) (?:not|never)|you shouldn't|you mustn't"
    r"|you are (?:not|never) allowed to"
    r"|(?:i(?:'d| would) (?:rather|prefer it if)|i don't want|it would be better if)"
    r" you (?:to (?:not|never)|not to|didn't|did not|don't|never)|i (?:don't|do not) want you to"
    r"|ära kunagi|ärge kunagi|sa ei tohi(?: kunagi)?)"
    r"|(?P<keep>(?:keep|stay) (?:out of|away from|clear of|off)|avoid|hoia eemale|hoidke eemale)"
    r"|(?P<who>[\w ]+?) (?:must|may|shall|should) (?:not|never)(?: ever)?"
    r"|(?P<whom>[\w ]+?) (?:is|are) (?:not|never) allowed to"
    r"|(?P<kes>[\w ]+?) ei tohi(?: kunagi)?)\s+(?P<rest>.+)$"
)
_APART: Final = re.compile(
    r"^(?:(?:keep|stay)(?: at least| a minimum of)?|(?:never|you must(?: not|n't)|nobody may) "
    r"(?:go|come|drive|get|move) (?:closer|nearer) than)"
    r" (?P<number>half a|an?|one|two|three|four|five|\d+(?:[.,]\d+)?) ?"
    r"(?P<unit>cm|met(?:re|er)s?|m|feet|foot)(?: or more)?"
    r"(?: away| clear| off| distance)? (?:from|of|to) (?P<place>.+)$"
)
_UNITS_M: Final = {"c": 0.01, "f": 0.3048}
_NUMBERS: Final = {
    "half a": 0.5,
    "a": 1.0,
    "an": 1.0,
    "one": 1.0,
    "two": 2.0,
    "three": 3.0,
    "four": 4.0,
    "five": 5.0,
}
"""How far away one has to stay: "stay at least 3 metres away from the gate"."""
_CLOSED: Final = re.compile(
    r"^(?P<place>.+?) (?:is|are) (?:off[- ]limits|out of bounds|closed(?: off)?|a no[- ]go (?:area|zone)|"
    r"cordoned off|sealed off)(?: (?:to|for) (?:you|robots|everybody|everyone|all))?$"
)
"""Only of parts of the map: a closed door is a door."""
_UNASKED: Final = re.compile(r" without (?:asking|my permission|permission)(?: \w+)*$")
_AREAS: Final = frozenset({"area", "zone", "room"})
_INTO: Final = re.compile(
    r"^(?:(?:go|goes|drive|drives|come|comes|move|moves|be|sõita|sõida|minna|mine|minema|tulla)\s+)?"
    r"(?:(?:in|into|inside|to|through|near|on|at|by|enter|enters)\s+)+(?P<place>.+)$"
)
_TO: Final = re.compile(r"(?:\w+\s+)?(?:to|near|by|at)\s")
_INTO_ET: Final = re.compile(r"^(?:(?:sõita|sõida|sõitke|minna|mine|minge|siseneda|sisene)\s+)(?P<place>.+)$")
_DRIVE: Final = frozenset({
    "drive", "go", "move", "drives", "moves", "goes", "driving", "moving", "going",
    "sõidad", "sõita", "sõidab", "liikuda", "liigud", "liigub",
})  # fmt: skip
_ANYTHING: Final = frozenset({"do anything", "act", "do something", "teha midagi", "midagi teha", "work"})
_TOUCH: Final = frozenset({"touch", "handle", "handles", "touches", "puudutada", "puudutad"})
_SPEEDS: Final = {"half a": 0.5, "a half": 0.5, "pool": 0.5, "poole": 0.5, "one": 1.0, "üks": 1.0, "two": 2.0,
                  "kaks": 2.0}  # fmt: skip
_EVERYBODY: Final = frozenset(
    {"robots", "the robots", "robot", "all robots", "every robot", "any robot", "robotid"}
)
_ESTONIAN: Final = {"avada": "open", "avad": "open", "sulgeda": "close", "sulged": "close", "tõsta": "lift",
                    "tõstad": "lift", "sõita": "drive", "sõidad": "drive", "puudutada": "touch"}  # fmt: skip
_ENDINGS: Final = ("", "i", "u", "e", "a", "sse", "isse", "usse", "esse", "asse", "s", "is", "us", "es", "as")
"""Of Estonian nouns that say into what or where."""
_YOU: Final = re.compile(r"^(?:you|sa|te|anybody|anyone|keegi)\s+")


@dataclass(frozen=True, slots=True)
class _World:
    """What is known when a rule is told."""

    places: Sequence[MapObject]
    catalogue: Sequence[ActionInfo]
    robots: Sequence[str]
    robot: str
    zones: Sequence[Rule]
    areas: Sequence[MapArea]


def told_rule(
    text: str,
    *,
    places: Sequence[MapObject],
    catalogue: Sequence[ActionInfo],
    robots: Sequence[str],
    robot: str = "",
    zones: Sequence[Rule] = (),
    areas: Sequence[MapArea] = (),
    busy: bool = True,
    doing: str = "",
) -> DraftRule | NotUnderstood | None:
    """What a person told as a rule; None if it is no rule.

    Args:
        text: What was said.
        places: What is on the map.
        catalogue: What the robot can do.
        robots: Names of all robots.
        robot: Who is spoken to; "you" means it.
        zones: Zones that there are already: their names are places, too.
        areas: Rooms and other named parts of the map.
        busy: Whether the robot has something to do: then "don't go there" is about that, and no rule.
        doing: What that is in words, if it is known: what does not go there is not what "don't" is about.
    """
    if len(text) > _MAX_CHARS or text.rstrip().endswith("?"):
        return None
    said = re.sub(r"\s+", " ", text.replace("’", "'").casefold()).strip(" .!")
    said = _BEGIN.sub("", said).replace("don't ever", "never").replace("do not ever", "never")
    may_be_plan = busy and _DONT.match(said) is not None
    said = said if busy and not doing else _DONT.sub("never ", said)
    world = _World(places, catalogue, robots, robot, zones, areas)
    missed: NotUnderstood | None = None
    # Why it holds may stand behind it, and until when: that is asked without, and ends when people say so.
    for tried in dict.fromkeys((said, _REASON.sub("", said), _UNTIL.sub("", said))):
        meant, plain = hours_in(tried)
        for form in (_asked, _slowed, _forbidden):
            found = form(_FOR_NOW.sub("", plain), world)
            if isinstance(found, NotUnderstood):
                missed = None if may_be_plan else found
            elif found is not None and may_be_plan and _is_named(found.get("name", ""), doing):
                return None
            elif found is not None:
                return _drafted(found, meant, text, world)
    return missed


def _is_named(place: str, doing: str) -> bool:
    """Whether what a robot is doing has to do with a place."""
    return {*re.findall(r"\w+", place.casefold())} <= {*re.findall(r"\w+", doing.casefold())}


_DONT: Final = re.compile(
    r"^(?:(?:you )?(?:don't|do not)|stop) (?=(?:go|drive|come|move|going|driving|enter)\b)"
)
_REASON: Final = re.compile(r"(?:\s*(?:,|;|:|\.|\s-|–)\s*|\s+(?:because|since|as|sest)\s+).*$")
_UNTIL: Final = re.compile(
    r",? (?:until|till|while|whilst|as long as|so long as|"
    r"(?:before|unless) (?:i|we|somebody|someone|he|she|they)|(?:seni )?kuni) .+$"
)
_FOR_NOW: Final = re.compile(
    r"(?: (?:today|tonight|for now|for the moment|at the moment|right now|now|any ?more|until further notice|"
    r"this (?:morning|afternoon|evening)|for a while|from now on|at all times|for good|please|täna|praegu))+$"
)
_LIFTED: Final = (
    re.compile(
        r"(?:you|robots?|everybody|he|she|sa) (?:may|can|could|are allowed to|is allowed to|võid|"
        r"tohid) (?:now |again )?"
        r"(?:go |drive |come |move |be |sõita |minna )?(?:back )?(?:(?:in|into|inside|to|through|near|"
        r"at) )?(?P<place>.+?)"
        r"(?: again| now| now again|,? if you like)*"
    ),
    re.compile(
        r"(?P<place>.+?) (?:is|are) (?:fine|ok|okay|open|free|clear|dry|safe|allowed|accessible|all right|"
        r"available|"
        r"yours)(?: again| now| to enter| for you)+"
    ),
    re.compile(
        r"(?P<place>.+?) (?:(?:(?:is|are) (?:no longer|not|never)|isn't|aren't) (?:closed(?: off)?|"
        r"off[- ]limits|forbidden|out of bounds)|"
        r"(?:(?:was|were|has|have)(?: been)? )?(?:re-?opened|opened again))"
        r"(?: any ?more| any longer| again| now)*"
    ),
    re.compile(
        r"(?:they|we|i|somebody|someone)(?:'ve| have| has)? (?:re-?opened|opened(?= .+ again))(?: up)? "
        r"(?P<place>.+?)(?: again| now)*"
    ),
)
_IS: Final = re.compile(r"(?<=\w)'s (?=(?:\w+ )*(?:again|now|longer|any ?more)$)")
_THERE: Final = re.compile(
    r"\b(?:(?P<verb>go|drive|come|move)|(?P<off>out of|away from|clear of|off|near|into|in)) there\b",
    re.IGNORECASE,
)


def keeps_away(text: str) -> bool:
    """Whether words keep a robot from "there": of one that goes nowhere that is no word of stopping."""
    said = text.replace("’", "'").casefold().removeprefix("please ")
    return re.match(r"(?:stay|keep|don't|do not)\b", said) is not None and _THERE.search(said) is not None


def named_place(text: str, place: str) -> str:
    """Words in which "there" is called by its name."""
    found = _THERE.search(text) if place else None
    if found is None:
        return text
    return f"{text[: found.start()]}{found['off'] or found['verb'] + ' to'} {place}{text[found.end() :]}"


def lifted_place(text: str) -> str:
    """The place that a person says a robot may go to again; empty if they say nothing of the kind."""
    said = _IS.sub(" is ", re.sub(r"\s+", " ", text.replace("’", "'").casefold()).strip(" .!"))
    parts = [part.strip() for part in re.split(r"[,.;]|\band\b|\bso\b|\bnow\b(?= you)", said) if part.strip()]
    for part in reversed(parts if not said.endswith("?") else []):
        for form in _LIFTED:
            if found := form.fullmatch(re.sub(r"^(?:ok|okay|well|and|then|so|now) ", "", part)):
                return re.sub(r"^(?:the|a|an) ", "", found["place"])
    return ""


def _drafted(fields: dict[str, Any], meant: Sequence[Hours | None], text: str, world: _World) -> DraftRule:
    taken = {rule.id for rule in world.zones}
    fields = {"id": _new_id(fields, taken), "words": text.strip()[:500]} | fields
    first, *rest = (Rule(**fields, when=hours) for hours in meant)
    others = list(rest)
    if first.robots and len(world.robots) > 1:
        others += [rule.model_copy(update={"robots": ()}) for rule in (first, *rest)]
    return DraftRule(first, tuple(others))


def _new_id(fields: dict[str, Any], taken: set[str]) -> str:
    words = re.findall(r"[a-z0-9]+", f"{fields['kind']} {fields.get('name', '')}".casefold())
    base = "-".join(words)[:50] or "rule"
    return next(name for name in (base, *(f"{base}-{n}" for n in range(2, 10_000))) if name not in taken)


# -- the forms ----------------------------------------------------------------------------------------


def _asked(said: str, world: _World) -> dict[str, Any] | NotUnderstood | None:
    """For "always ask me before you drive at night"."""
    found = _ASK.match(said)
    if found is None:
        return None
    rest = found["rest"]
    who, rest = _subject(rest, world)
    if (place := _goes_into(rest)) is not None:
        area = _area(place, world)
        return area if isinstance(area, NotUnderstood) else {"kind": "ask_zone", "robots": who} | area
    deed = _deed(rest, world)
    if isinstance(deed, NotUnderstood):
        return deed
    return {"kind": "action", "verdict": "ask", "robots": who} | deed


def _slowed(said: str, world: _World) -> dict[str, Any] | NotUnderstood | None:
    """For "not faster than half a metre per second in the hall"."""
    found = _SPEED.match(said)
    if found is None:
        return None
    number = found["number"]
    speed = _SPEEDS[number] if number in _SPEEDS else float(number.replace(",", "."))
    if found["unit"].startswith("k"):
        speed = round(speed / 3.6, 2)
    if not 0 < speed <= 20:
        return NotUnderstood(sentence("I cannot drive at such a speed."))
    who = _named(found["who"], world)
    limit: dict[str, Any] = {"max_speed_mps": speed, "robots": who or ()}
    if not found["place"]:
        return {"kind": "speed"} | limit
    area = _area(found["place"], world)
    return area if isinstance(area, NotUnderstood) else {"kind": "slow"} | limit | area


def _forbidden(said: str, world: _World) -> dict[str, Any] | NotUnderstood | None:
    """For "nobody into the ward", "Ada must not open doors"."""
    if asking := _UNASKED.search(said):
        subject, _, wish = re.sub(r"\b(?:don't|do not) ", "never ", said[: asking.start()]).partition(
            "never "
        )
        return _asked(f"always ask before {wish}", world) if wish and not subject.strip() else None
    if closed := _CLOSED.match(said):
        name = re.sub(r"^(?:the|our) ", "", closed["place"])
        areas = [item for item in world.places if item.area is not None or item.class_name in _AREAS]
        known = {label.casefold() for item in areas for label in (item.description, *item.aliases)}
        known |= {area.name.casefold() for area in world.areas}
        shut = _area(name, world) if name in known else None
        return {"kind": "keep_out", "robots": ()} | shut if isinstance(shut, dict) else None
    if apart := _APART.match(said):
        number = _NUMBERS.get(apart["number"]) or float(apart["number"].replace(",", "."))
        around = _area(apart["place"], world, number * _UNITS_M.get(apart["unit"][0], 1.0))
        return around if isinstance(around, NotUnderstood) else {"kind": "keep_out", "robots": ()} | around
    found = _NEVER.match(said)
    if found is None:
        return None
    who: tuple[str, ...] | None = ()
    if found["you"] and world.robot:
        who = (world.robot,)
    elif subject := found["who"] or found["whom"] or found["kes"]:
        who = _named(subject, world)
        if who is None:
            return None  # "Kim must not lift boxes" is about a person
    rest = _NO_LONGER.sub("", found["rest"])
    place = rest if found["keep"] else _goes_into(rest)
    if place is not None:
        area = _area(place, world, _BEFORE_M if _TO.match(found["rest"]) else _MARGIN_M)
        if isinstance(area, NotUnderstood):
            return area
        return {"kind": "keep_out", "robots": who} | area
    verb, _, where = rest.partition(" ")
    if verb in _DRIVE and where and where != "anywhere":  # not to go there is not to go nowhere
        return _unknown(where)
    deed = _deed(found["rest"], world)
    if isinstance(deed, NotUnderstood):
        # "Never mind", "nobody is here" and the like are no rules.
        return deed if found["who"] or found["whom"] or found["kes"] else None
    return {"kind": "action", "robots": who} | deed


# -- what is spoken of --------------------------------------------------------------------------------


def _named(words: str, world: _World) -> tuple[str, ...] | None:
    """The robots that are named; empty for all, None if it is no robot."""
    words = words.strip(" ,")
    if not words or words in _EVERYBODY:
        return ()
    known = {name.casefold(): name for name in world.robots}
    parts = [part.strip() for part in re.split(r",|\band\b|\bja\b", words) if part.strip()]
    return tuple(known[part] for part in parts) if all(part in known for part in parts) else None


def _subject(rest: str, world: _World) -> tuple[tuple[str, ...], str]:
    """Who is to do it, and what."""
    if found := _YOU.match(rest):
        mine = (world.robot,) if world.robot and found[0].split()[0] in ("you", "sa") else ()
        return mine, rest[found.end() :]
    for name in world.robots:
        if rest.startswith(name.casefold() + " "):
            return (name,), rest[len(name) + 1 :]
    for words in _EVERYBODY:
        if rest.startswith(words + " "):
            return (), rest[len(words) + 1 :]
    return ((world.robot,) if world.robot else ()), rest


def _goes_into(rest: str) -> str | None:
    found = _INTO.match(rest) or _INTO_ET.match(rest)
    return found["place"] if found is not None else None


def _deed(words: str, world: _World) -> dict[str, Any] | NotUnderstood:
    """The actions that words mean, from the robot's catalogue."""
    words = " ".join(sorted(words.strip(" ,").split(), key=lambda word: word not in _ESTONIAN))
    first, _, rest = words.partition(" ")
    first = _ESTONIAN.get(first, first)
    if words in _ANYTHING:
        return {}
    if first in _DRIVE and not rest:
        return {"classes": ("moves",)}
    if first in _TOUCH:
        return {"classes": ("handles_things",)}
    verb, nouns = _stem(first), {_stem(word) for word in rest.split()}
    fitting = [info for info in world.catalogue if verb in _verbs(info)]
    closer = [info for info in fitting if nouns & _words(info)]
    if not fitting:
        return NotUnderstood(sentence("I know no action of mine that is called “{words}”.", words=words))
    return {"actions": tuple(info.name for info in closer or fitting)}


def _verbs(info: ActionInfo) -> set[str]:
    """With which words people ask for an action."""
    name = re.findall(r"[A-Z]?[a-z]+", info.name)
    return {_stem(text.split()[0]) for text in (*info.phrases, *(name[:1])) if text.split()}


def _words(info: ActionInfo) -> set[str]:
    texts = (*info.phrases, *re.findall(r"[A-Z]?[a-z]+", info.name))
    return {_stem(word.strip("{}")) for text in texts for word in text.split()}


def _stem(word: str) -> str:
    return re.sub(r"(?:ing|es|s)$", "", word.casefold().strip(".,")) if len(word) > 3 else word.casefold()


def _area(words: str, world: _World, margin_m: float = _MARGIN_M) -> dict[str, Any] | NotUnderstood:
    """The place on the map that words mean."""
    words = re.sub(r"^(?:the|a|an|my|our)\s+|^(?:läbi)\s+", "", words.strip(" ,."))
    for zone in world.zones:
        if zone.corners and words in {zone.name.casefold() + end for end in _ENDINGS}:
            return {"name": zone.name, "map": zone.map, "rectangle": zone.rectangle, "polygon": zone.polygon}
    for area in world.areas:
        if words in {area.name.casefold() + end for end in _ENDINGS}:
            return {"name": area.name, "polygon": area.corners}
    named = [item for item in world.places if words in _names(item)] or [
        item for item in world.places if any(words == n + end for n in _names(item) for end in _ENDINGS)
    ]
    if len(named) == 1:
        return _box(words, named, margin_m)
    inside = [item for item in world.places if re.search(rf"\b(?:in|of) (?:the )?{re.escape(words)}$",
                                                         item.description.casefold())]  # fmt: skip
    if inside and not named:
        return _box(words, inside, _AROUND_M)
    if named:
        return NotUnderstood(sentence("I know several places that are called “{words}”.", words=words))
    return _unknown(words)


_CASE: Final = re.compile(r".+? (?P<case>(?:when|while|whenever|if|unless|until|as long as) .+)")


def _unknown(words: str) -> NotUnderstood:
    if (case := _CASE.fullmatch(words)) is not None:
        text = sentence(
            "I can keep a rule always or from one time of day to another, not “{words}”.", words=case["case"]
        )
        return NotUnderstood(text)
    return NotUnderstood(
        sentence("I do not know where “{words}” is. You can draw it on the page Rules.", words=words)
    )


_NO_LONGER: Final = re.compile(
    r" (?:any ?more|any longer|again|ever)(?= (?:tonight|today|tomorrow|until|till)\b|$)"
)


def _names(item: MapObject) -> set[str]:
    return {name.casefold() for name in (item.description, item.id, item.class_name, *item.aliases) if name}


def _box(words: str, items: Sequence[MapObject], margin_m: float) -> dict[str, Any]:
    west = min(item.x_m - item.width_m / 2 for item in items) - margin_m
    east = max(item.x_m + item.width_m / 2 for item in items) + margin_m
    south = min(item.y_m - item.height_m / 2 for item in items) - margin_m
    north = max(item.y_m + item.height_m / 2 for item in items) + margin_m
    corners = (round(west, 2), round(south, 2), round(east, 2), round(north, 2))
    return {"name": words, "rectangle": corners}
