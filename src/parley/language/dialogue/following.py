"""The last order once more about something else: "and room 14", "the same for the yard", "no, that one"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.saying import listed, which_one
from parley.language.builtin.spatial import beside
from parley.language.builtin.tokens import Token
from parley.language.dialogue.changes import Change, Visit, is_against, moved, visits, visits_of
from parley.language.dialogue.map_words import Named, named, same_kind
from parley.language.dialogue.state import Order
from parley.language.lexicon import word_set
from parley.messages.status import PlanStep
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = ["followed", "in_turn", "with_names_for_ones"]

_SMALL: Final = word_set("""and also too now then next the as well please same for with likewise ditto how
about in at to do it that thing again once more but no not i mean meant sorry oh just instead actually
rather wait this time after afterwards finally one other okay ok a try of near beside by close""")
_LINKING: Final = re.compile(
    r"\b(?:and|also|too|now|then|next|as well|same|likewise|ditto|how about|again|once more|after that|"
    r"no|not|i meant?|sorry|instead|rather|other)\b"
)
_GOING: Final = frozenset({"go", "drive", "move", "head"})
_LONGEST: Final = 12


def in_turn(message: str) -> str:
    """A message without "when you are done" and "tell me when you are": that is how it is done anyway.

    A "round of" some places goes to them; "the gate, is it open?" asks whether the gate is open.
    """
    for pattern, text in _PLAINER:
        message = pattern.sub(text, message)
    if _TELLING.search(message):
        return message
    return _DONE.sub(" ", message).strip(" ,") or message


def with_names_for_ones(situation: Situation) -> str:
    """A message with "the red one", "the one by the door" as what that is called in the plan."""
    names = {thing.description for visit in visits(situation) for thing in visit.things}
    if situation.question or (situation.dialogue.asked is not None and situation.dialogue.asked.choices):
        return situation.message  # it is one of those

    def called_so(found: re.Match[str]) -> str:
        said = {stem(word) for word in (found["which"] or found["where"]).lower().split()} - _LEADING
        hits = [name for name in names if said and said <= {stem(word) for word in name.lower().split()}]
        return f"the {hits[0]}" if len(hits) == 1 else found[0]

    return _ONE.sub(called_so, situation.message)


_LEADING: Final = word_set("the in at near by next to on behind under beside with from of close")
_ONE: Final = re.compile(
    r"\b(?:the|that) (?P<which>(?:(?!one\b)[\w'-]+ ){1,3})one\b|"
    r"\b(?:the|that) one (?P<where>(?:in|at|near|by|next to|on|behind|under|beside|with|from) [\w' -]+?)"
    r"(?=\W*(?:$|[,.;!?]|\b(?:and|first|last|too|instead|then|please|again|now|before|after|for|at)\b))",
    re.IGNORECASE,
)


_WAY: Final = re.compile(
    r"^(?:(?:ok|okay|and|then|but|please)\W+)*(?:on (?:your|the) way(?: back| home| there| past)?|"
    r"while you(?: are|['’]re) (?:there|at it|on it|in there|around))\W+"
    r"(?=(?:(?:please|also|just|then) )*(?:look|check|have|take|see|stop|go|inspect|bring|drive|pick)\b)",
    re.IGNORECASE,
)
"""What lies on the way is done next; which way a robot takes, it finds by itself."""
_AT_LAST: Final = re.compile(
    r"(?:(?<=\band)|(?<=[,;]))\s*(?:at|in) the (?:very )?end,?(?= (?!of |please\b|instead\b)\w)", re.I
)
_NAMED_FIRST: Final = re.compile(
    r"(?:^|(?<=[.!] ))(?:(?:and|what about|how about|ok|okay|so) )*"
    r"(?P<what>the [\w ]{2,40}?), (?P<be>is|are) (?:it|they)\b",
    re.I,
)
_ROUND: Final = re.compile(
    r"\b(?:do|make|take|run|go on|go for) (?:a|one|another|your) (?:\w+ )?"
    r"(?:round|lap|tour|circuit|patrol|loop) (?:of|round|around|past|through|by)\b", re.I
)  # fmt: skip
_REPORTING: Final = re.compile(
    r"(?<=\w)[\s,;.]+(?:(?:and|then|please|just)\s+)*(?:report\s+back(?:\s+to\s+(?:me|us))?|"
    r"(?:(?:tell|call|notify|inform|message)\s+(?:me|us)|let\s+(?:me|us)\s+know|report)\s+(?:when|once|as\s+soon\s+"
    r"as)\s+you(?:\s+(?:are|have|get)|['’](?:re|ve))\s+(?:all\s+)?(?:done|finished|through|there|arrived|ready))\W*$",
    re.IGNORECASE,
)
_MOVING: Final = r"(?P<go>go|drive|walk|run|move|head|travel|patrol|ride)(?: (?:back|straight|over))?"
_FROM: Final = (
    r"(?P<a>(?!(?:left|right|side|top|front|\d)\b)(?:(?!(?:to|and|from|then|or)\b)[\w'’-]+ ?){1,5}?)"
)
_ENDS: Final = r"(?=\W*$|\s*[,.;]| and\b| then\b)"
_PLAINER: Final = (
    (_WAY, ""), (_REPORTING, ""), (_AT_LAST, " then"), (_NAMED_FIRST, r"\g<be> \g<what>"), (_ROUND, "go to"),
    (re.compile(r"(?<=\w), the one (?=(?:in|near|by|next to|on|at|behind|under|beside)\b)", re.I), " "),
    (re.compile(r"\b(?:can|could|would|will) you (?:please )?do me a favou?r(?: and|[,:])? ", re.I), ""),
    (re.compile(r"\bnow,? (?=(?:show|give|get|send|bring|tell)\b)", re.I), ""),
    (re.compile(r"\btake a look(?= a?round\b)", re.I), "look"),
    (re.compile(r"\b(pictures?|photos?) (?:in|at) each(?: one| of them)?(?=\W*$|[,.;])", re.I), r"\1 there"),
    (re.compile(r"\btake (her|it)s? (picture|photo)\b", re.I), r"take a \2 of \1"),
    (re.compile(r"\btake his (picture|photo)\b", re.I), r"take a \1 of him"),
    (re.compile(r"\btake their (picture|photo)s?\b", re.I), r"take a \1 of them"),
    (re.compile(r"\btake ((?-i:[A-Z])\w+)['’]s (picture|photo)\b", re.I), r"take a \2 of \1"),
    (re.compile(rf"\b{_MOVING} from (?:here|there|where you are(?: now)?) to (?=\w)", re.I), r"\g<go> to "),
    (re.compile(rf"\b{_MOVING} from {_FROM} to (?=\w)", re.I), r"go to \g<a> and then to "),
    (re.compile(rf"\blook (?:right )?behind you(?:rself)?{_ENDS}", re.I), "turn around and look around"),
    (re.compile(rf"\blook (?:to (?:your|the) )?(left|right){_ENDS}", re.I),
     r"turn \1 by 90 degrees and look around"),
    (re.compile(rf"\blook (?:straight |right )?(?:ahead|in front of you){_ENDS}", re.I), "look around"),
    (re.compile(r"\b(go|head|come|drive|move) on (?=(?:over|down|out) )", re.I), r"\1 "),
    (re.compile(r"\bback(?: to)? where you (?:started|began|were|came)\b(?: from| before)?", re.I), "back"),
)  # fmt: skip
_TELLING: Final = re.compile(
    r"\b(?:tell|say|know|report|call|inform|notify|message|shout|beep)\b", re.IGNORECASE
)


_DONE: Final = re.compile(
    r"(?:^|,?\s*\b)(?:when|once|after|as soon as)\s+you(?:(?:\s+have|\s+get|\s+find|['’]ve(?:\s+got)?)"
    r"(?:\s+(?:a|the|some|spare))*\s+(?:time|minute|moment|second|sec|chance)\b|"
    r"(?:\s+are|'re|’re|\s+have|'ve|’ve)\s+(?:all\s+)?"
    r"(?:done|finished|through|free)\b(?:\s+(?:with\s+)?(?:that|this|it|there|here|everything|all\s+that|the\s+rest|"
    r"your\s+(?:work|task|job|round|plan)|what\s+you\s+are\s+doing))?(?=\s*(?:[.,!]|$|\bplease\b)))[\s,]*",
    re.IGNORECASE,
)


def followed(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon, last: Order) -> Change | None:
    """What was ordered last, about the things that are named now; None if a message says anything else.

    Nothing may be planned then, and nothing be asked.
    """
    words = [token.low for token in tokens if token.is_word]
    said = " ".join(words)
    asks = situation.message.rstrip().endswith("?") and not said.startswith(("how about", "and"))
    if asks or not last.calls or situation.queue or situation.question or len(words) > _LONGEST:
        return None
    names = named(tokens, situation.places, lexicon)
    taken = {at for name in names for at in range(name.start, name.end)}
    rest = [token.low for at, token in enumerate(tokens) if token.is_word and at not in taken]
    done = _last_visits(last, situation)
    if not done or not {*rest} - _which(rest) <= _SMALL | _GOING or _LINKING.search(said) is None:
        return None
    before, low = done[0].things[0], [token.low for token in tokens]
    names = [name for name in names if not is_against(low, name)]
    chosen = [_near(before, name, {*rest}, lexicon) for name in names]
    which = next((things for things in chosen if len(things) > 1), ())
    if which and not _GOING & {*words}:
        fitting = tuple(thing.description for thing in which)
        return Change(question=which_one(fitting), choices=fitting)
    things = [things[0] for things in chosen] or _other(before, words, situation.objects)
    if _GOING & {*words} and (names or _looks(done, situation)):
        return None  # an order of its own
    if len(things) > 1 and not names:
        return Change(
            question=f"Which other one: {listed([called(one.description) for one in things], 'or')}?"
        )
    if not things or before in things:
        return None
    calls = tuple(
        call for thing in things for visit in done for call in moved(visit, thing, before) or visit.calls
    )
    finding = {info.name for info in situation.catalogue if info.only_finds}
    reasons = dict.fromkeys(call.reason for call in calls if call.reason and call.name not in finding)
    what = " and then ".join(reasons) or f"do the same with the {things[0].description}"
    return Change(add=calls, said=f"I will {what}.")


def _near(before: MapObject, name: Named, rest: set[str], lexicon: Lexicon) -> tuple[MapObject, ...]:
    """What is named, or of several the one beside what came before: "the chair next to it"."""
    near = (
        beside(before, name.things) if rest & lexicon.classes["pronouns"] and len(name.things) > 1 else None
    )
    return (near,) if near is not None else name.things


def _last_visits(last: Order, situation: Situation) -> list[Visit]:
    """What was done about the thing that an order was about last, and asked there; none if unclear."""
    found = visits_of([PlanStep(action=call) for call in last.calls], situation)
    things = next((visit.things for visit in reversed(found) if visit.things), ())
    start = next((at for at, visit in enumerate(found) if visit.things == things), 0)
    done = found[start:]
    plain = all(visit.things in ((), things) and not any(call.flow for call in visit.calls) for visit in done)
    return done if len(things) == 1 and plain and moved(done[0], things[0]) is not None else []


def _which(words: Sequence[str]) -> set[str]:
    """The word before "one" that says which: "green" in "the green one"."""
    at = words.index("one") if "one" in words else 0
    return {words[at - 1]} - _SMALL if at else set()


def _other(before: MapObject, words: Sequence[str], objects: Sequence[MapObject]) -> list[MapObject]:
    """For "the other one" the only other thing of the kind; for "the next one" that with the next number."""
    name = before.description.lower().split()
    kind = [item for item in objects if same_kind(item, before)]
    if which := _which(words):
        said = [item for item in kind if which <= {*item.description.lower().split()}]
        return said if len(said) == 1 else []
    if "next" in words and name[-1].isdigit():
        wanted = [*name[:-1], str(int(name[-1]) + 1)]
        return [item for item in objects if item.description.lower().split() == wanted]
    return [item for item in kind if item != before] if "other" in words else []


def _looks(done: Sequence[Visit], situation: Situation) -> bool:
    looking = {info.name for info in situation.catalogue if "looks" in info.effects}
    return any(call.name in looking for visit in done for call in visit.calls)
