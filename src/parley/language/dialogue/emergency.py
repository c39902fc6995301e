"""Emergencies: everybody is told and a person is asked; an order beside what alarms is not lost."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.decision import Ask, Decision, Do, Edit
from parley.language.builtin.facts import Heard
from parley.language.builtin.lexicon import Lexicon, is_somebody, lemmas
from parley.language.builtin.reading import Reading
from parley.language.builtin.tokens import Token, tokenize
from parley.language.dialogue.map_words import named, named_alone, rooms
from parley.language.dialogue.standing import tells_in_case
from parley.language.lexicon import word_set

__all__ = ["NO_ALARM", "danger_is_past", "emergency", "is_emergency"]

_FALSE: Final = (
    r"(?:(?:(?:no|it was|it is|it's|that was|that's|just|only|a|an|the|sorry|it) )*(?:false alarm|"
    r"joke|mistake|test|drill|no emergency|nothing(?: happened| is wrong| at all)?|over|out)|"
    r"(?:all|everything|everybody|everyone|it|we|he|she|they)(?: is|'s| are|'re)? "
    r"(?:ok|okay|good|fine|clear|well|safe|all right|alright|under control))"
)
_OVER: Final = (
    r"(?:(?:and|so|ok|okay|well|now) )*(?:the|that|this|your|our) (?P<what>(?:(?!is |are |was )[\w-]+ ){1,3})"
    r"(?:is|are|was|were|has|have)(?: (?:all|been|now|already|finally))* "
    r"(?:gone|out|over|away|cleared|cleaned|mopped|put out|under control|dealt with|stopped)"
    r"(?: (?:up|now|again|already|away))*"
)
NO_ALARM: Final = re.compile(rf"{_FALSE}(?: (?:and |so |now )?{_FALSE})*(?: now| again)?")
_PIECE: Final = re.compile(
    r"\w.*?(?=[.,;:!?]+(?:\s|$)|\s+(?:and\s+)?(?:so|please|can you|could you|would you)\b|$)",
    re.IGNORECASE | re.DOTALL,
)
_TOLD: Final = frozenset({"told", "need", "alarm", "social"})
_BINDING: Final = word_set("if unless until till when while except otherwise else or before after")
"""Words on which an order may depend: what holds one is not left out of it."""
_LONGEST: Final = 60
"""So many words at most are looked through for an order beside what alarms."""


def is_emergency(situation: Situation) -> bool:
    """Whether somebody was just told of an emergency and asked what to do."""
    return situation.dialogue.asked is not None and situation.dialogue.asked.alarm


def emergency(heard: Heard) -> Decision | None:
    """What is decided where somebody is in need or something is on fire; None if nothing alarms.

    A complaint beside a clear order is no emergency. A real one is told and asked about, with the order.
    """
    situation, tokens, lexicon = heard.situation, heard.tokens, heard.lexicon
    reader, again = heard.reader, heard.again
    if (helps := _helps_robot(situation, lexicon, again)) is not None:
        return helps
    if _ASKS_FOR_HELP.fullmatch(situation.message.strip()) and not is_emergency(situation):
        return Ask("Say what to do, or where to go. If a person is in danger, please say so.")
    text = _LOST.sub(r"\g<what>", situation.message)
    acts = reader(text).acts
    suffers = _suffers(text, situation)
    pieces = [match.span() for match in _PIECE.finditer(text)] if len(tokens) <= _LONGEST else []
    names = " ".join([*situation.robots, *(item.description for item in situation.objects)]).lower().split()
    ends = [text[slice(*pieces[at])] for at in (0, -1)] if len(pieces) > 1 else []
    if len(ends) > 1 and _danger(text[: pieces[-1][0]], lexicon):
        del ends[1]  # "look for smoke, gas" is a list
    ends = [one for one in ends if {*_danger(one, lexicon)}.isdisjoint(names)]  # a "fire door" is none
    alarms = "alarm" in acts or any(_calls(one, lexicon, reader) for one in ends)
    calm = "question" in acts or not alarms or _is_calm(situation, tokens, lexicon) or _is_over(text, lexicon)
    if not suffers and (calm or _does_something(tokens, lexicon) or tells_in_case(text)):
        return None
    order, told = _beside(text, pieces, lexicon, reader, again)
    if suffers:
        return _alarm(situation, tokens, lexicon, order)
    plain = _NUISANCE.sub(" ", text)
    if not order and plain != text and not (_danger(plain, lexicon) or "alarm" in reader(plain).acts):
        return None
    serious = [one for one in told if _NUISANCE.search(one) is None]
    danger = any(_danger(one, lexicon) for one in told)
    if len(serious) < len(told) and not danger and not any("alarm" in reader(one).acts for one in serious):
        return again(order)
    if not order and not _concerns_people(text, lexicon):
        return _to_be_seen(situation, tokens, lexicon, again) or _alarm(situation, tokens, lexicon, order)
    return _alarm(situation, tokens, lexicon, order)


def _suffers(text: str, situation: Situation) -> bool:
    """Whether it says of a person what no healthy one does, whatever else is in it: "he is not breathing"."""
    known = {name.lower() for name in situation.robots}
    known |= {word for thing in situation.objects for word in thing.description.lower().split()}
    for found in _SUFFERING.finditer(text):
        who, before = found["who"] or found["down"] or "I", text[: found.start()]
        low = who.lower()
        named = (
            who.istitle() and len(who) > 1 and low not in known | _NOBODY and not _DESCRIBED.search(before)
        )
        person = named or low in _PEOPLE or (is_somebody(low) and low not in known)
        if person and _IN_CASE.search(before) is None:
            return True
    return False


_PEOPLE: Final = word_set("i he she they we somebody someone")
_NOBODY: Final = word_set(
    """it that this these those what which who there something everything nothing all one the nobody everybody
    water milk coffee tea oil paper juice soup food glass dirt breakfast lunch dinner wine beer box
    package parcel laundry towel cup plate book mail rubbish trash"""
)
"""What a sentence may begin with, in a capital letter, and is no name."""
_DESCRIBED: Final = re.compile(r"\b(?:the|an?|this|that|our|your|its)(?: [\w-]+){0,2} $", re.IGNORECASE)
_IN_CASE: Final = re.compile(r"\b(?:if|whether|when|unless|until|in case|once)\b[^.!;?]*$", re.IGNORECASE)
_NOT: Final = (
    r" ?(?:(?: ca| could| do| does| is| are| was| wo)n['’]?t|(?: can| could| does| do| is| are|['’]s|['’]m|"
    r" am| will) not| cannot|(?: has|['’]s)? stopped| hardly| barely) "
)
_SUFFERING: Final = re.compile(
    rf"\b(?P<who>[\w-]+){_NOT}(?:breath(?:e|es|ing)|respond(?:s|ing)?|react(?:s|ing)?|wak(?:e|ing)(?: up)?)\b"
    r"(?=\W*$|\s*[,.;!?]|\s+(?:and|any ?more|at all|properly|well|to (?:me|us|anything))\b)|"
    r"\b(?:my|his|her|their) chest (?:hurts|aches|is hurting)|\bpains? in (?:my|his|her|their|the) chest\b|"
    r"\b(?P<down>[\w-]+)(?: is|[’']s|[’']m| am)(?: lying| down)? on the (?:floor|ground)\b(?! floor)",
    re.IGNORECASE,
)


def _is_calm(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon) -> bool:
    """Whether each word of it only says that somebody is somewhere, and at rest: "she's in her room"."""
    classes, places = lexicon.classes, situation.objects + situation.rooms
    known = classes["small"] | classes["prepositions"] | classes["determiners"] | classes["being"]
    known |= classes["persons"] | classes["calm"] | {*rooms(situation.objects)}
    known |= {word for one in places for word in one.description.lower().split()}
    known |= {word for room in rooms(situation.objects) for word in room.split()}
    known -= {"lying", "under", "out"}
    words = [token for token in tokens if token.is_word]
    plain = (
        {token.low, *lemmas(token.low)} & known
        or token.text.istitle()
        or is_somebody(token.low)
        or token.low.endswith("room")
        for token in words
    )
    return len(words) > _CRY and not _danger(situation.message, lexicon) and all(plain)


def danger_is_past(text: str, lexicon: Lexicon) -> bool:
    """Whether nothing is said but that what somebody was in danger of is over: "the fire is out"."""
    return bool(_danger(text, lexicon)) and _is_over(text, lexicon)


def _is_over(text: str, lexicon: Lexicon) -> bool:
    """Whether it says of a thing that it is there no more: "the fire is out"; of a person that alarms."""
    words = re.sub(r"['’]s\b", " is", text.lower()).replace("'", "").split()
    found = re.fullmatch(_OVER, " ".join(words).strip(" .!"))
    return found is not None and not any(
        is_somebody(word) or word in lexicon.classes["persons"] for word in found["what"].split()
    )


def _does_something(tokens: Sequence[Token], lexicon: Lexicon) -> bool:
    """Whether it only says what somebody does: "somebody parked here", "someone else will take it"."""
    low = [token.low for token in tokens if token.is_word]
    verb = next((at for at in range(1, len(low)) if low[at] not in _HELPING_WORDS), 0)
    deeds = lexicon.frames_of(low[verb : verb + 1]) - {"BELOC", "STOP"} if verb else frozenset[str]()
    return bool(deeds) and low[0] in ("somebody", "someone") and not _danger(" ".join(low), lexicon)


_HELPING_WORDS: Final = word_set("else has have had will is just already must again going to")
_LOST: Final = re.compile(
    r"(?P<what>\b(?:can(?:'t|’t|not| not) find|(?:have|['’]ve) lost|misplaced|looking for)\b.*?)"
    r"[\s,;.!?]+(?:so |and )?(?:can|could|would|will) (?:you|u) (?:please )?help\b.*$",
    re.IGNORECASE,
)
"""Help in looking for something is no cry: "I can't find my keys, can you help?"."""
_CRY: Final = 2
"""So many words a cry has: "Ruth! Ruth!"."""


def _concerns_people(text: str, lexicon: Lexicon) -> bool:
    """Whether what alarms has a word of danger, or somebody in it: a box in the way is no emergency."""
    words = [token.low for token in tokenize(text) if token.is_word]
    people = lexicon.classes["persons"] | lexicon.classes["me"]
    named_so = any(word.istitle() for word in text.split()[1:])
    return bool(_danger(text, lexicon)) or named_so or any(is_somebody(w) or w in people for w in words)


def _to_be_seen(
    situation: Situation, tokens: Sequence[Token], lexicon: Lexicon, again: Callable[[str], Decision]
) -> Ask | None:
    """What is amiss with a thing is offered to be looked at; None if nobody knows where that is."""
    things = named_alone(tokens, situation.objects, lexicon)
    where = things[-1].description if things else ""
    made = again(f"check the {where}") if where else None
    if not isinstance(made, Do) or situation.status == "running":
        return None
    return Ask(f"Shall I go to the {where} and have a look?", offer=made.deeds)


def _helps_robot(situation: Situation, lexicon: Lexicon, again: Callable[[str], Decision]) -> Decision | None:
    """What is decided where one robot is told to help another: nobody is in need by that.

    Said to a robot itself, with its name behind, it is a cry: "help, Spot!".
    """
    found = _help_pattern(situation.robots).fullmatch(situation.message.strip())
    if found is None or _danger(found["rest"] or "", lexicon):
        return None
    helped, called = (found["helped"] or found["lent"]).lower(), (found["called"] or situation.robot).lower()
    if helped == called:
        return None
    made = again(found["rest"]) if found["rest"] and called == situation.robot.lower() else None
    if isinstance(made, Do):
        return made
    name = next(name for name in situation.robots if name.lower() == helped)
    return Ask(
        f"What is to be done to help {name}? Say what to do, or where to go. "
        "If a person is in danger, please say so."
    )


_ASKS_FOR_HELP: Final = re.compile(
    r"(?:(?:hello|hi|hey|sorry|please|excuse me)\W+)*(?:can|could|would|will) you (?:please )?help"
    r"(?: me| us)?(?: out)?(?: (?:please|with (?:it|this|that|something)))*\W*", re.IGNORECASE
)  # fmt: skip


def _help_pattern(robots: tuple[str, ...]) -> re.Pattern[str]:
    names = "|".join(map(re.escape, robots)) or "(?!)"
    return re.compile(
        rf"(?:(?P<called>{names})\W+)?(?:(?:please|now|quick|quickly|can|could|would|will|you|go|come|over|and|"
        r"hey|ok|okay|so|then)\W+)*"
        rf"(?:(?:help|assist|support)(?: out)? (?P<helped>{names})|(?:give|lend) (?P<lent>{names}) a hand)\b"
        r"(?:,? (?:out|please|now|quickly|at once|right away)\b)*(?: (?:with |to )?(?P<rest>.+?))?[\s.!?]*",
        re.IGNORECASE | re.DOTALL,
    )


def _danger(text: str, lexicon: Lexicon) -> list[str]:
    """The words of danger in a text, without those of a nuisance."""
    serious = [token.low for token in tokenize(_NUISANCE.sub(" ", text))]
    return [word for word in serious if not lexicon.classes["danger"].isdisjoint((word, *lemmas(word)))]


def _calls(text: str, lexicon: Lexicon, reader: Callable[[str], Reading]) -> bool:
    """Whether a part of a message alarms by itself: it is read so, or is nothing but a word of danger."""
    found = _danger(text, lexicon)
    rest = {token.low for token in tokenize(text) if token.is_word} - {*found} - lexicon.classes["small"]
    return bool(found) and (not rest or "alarm" in reader(text).acts)


def _beside(
    text: str,
    pieces: Sequence[tuple[int, int]],
    lexicon: Lexicon,
    reader: Callable[[str], Reading],
    again: Callable[[str], Decision],
) -> tuple[str, list[str]]:
    """The clear order in a message in which something alarms, and what is only told beside it.

    Nothing but what is told may stand before the order or behind it, and nothing that it may depend on.
    """
    said = [text[start:end] for start, end in pieces]
    told = [reader(one).acts <= _TOLD or _calls(one, lexicon, reader) for one in said]
    orders = [number for number, plain in enumerate(told) if not plain]
    if not orders:
        return "", []
    first, last = orders[0], orders[-1]
    order = text[pieces[first][0] : pieces[last][1]]
    beside = [*said[:first], *said[last + 1 :]]
    bound = any(not _BINDING.isdisjoint(one.lower().split()) for one in beside)
    if not beside or bound or not isinstance(again(order), Do | Edit):
        return "", []
    return order, beside


def _alarm(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon, order: str) -> Decision:
    """Say what can be done, stand still, ask; never a fact."""
    low = [token.low for token in tokens]
    places = named(tokens, situation.objects, lexicon)
    room = next((room for room in rooms(situation.objects) if set(room.split()) <= set(low)), "")
    where = f"the {room}" if room else f"the {places[-1].things[0].description}" if places else ""
    what = order or (f"Go to {where}" if where else "")
    moving = situation.status == "running"
    still = "I have stopped. " if moving else ""
    wanted = f"Shall I do as you say (“{order}”), or stay here?" if order else ""
    offer = wanted or (f"Shall I go to {where}, or stay here?" if where else "Where is it? Shall I go there?")
    return Ask(
        f"{still}That sounds like an emergency, and I cannot help with hands, nor call anybody by phone: "
        f"please get help at once. I tell everybody who is connected to me. {offer}",
        (what, "Stay here") if what else (),
        stops=moving,
        alarms=True,
    )


_NUISANCE: Final = re.compile(
    r"\b(?:my|our|his|her|their) (?:\w+ )?(?:back|knees?|foot|feet|legs?|head|neck|shoulders?|hips?|joints|"
    r"bones|muscles|throat|tooth|teeth)\b.{0,20}\b(?:killing|hurts?|hurting|ach(?:e|es|ing)|sore|stiff|tired|"
    r"splitting|bad|playing up|worn out|bother\w*)\b|"
    r"\bstuck (?:in|behind|at) (?:\w+ )*(?:traffic|work|meeting|jam)\b|\bdown (?:my|our) necks?\b|"
    r"\b(?:would|could|'d) (?:kill|murder) for\b|\bdying (?:for|to)\b|\bup to (?:my|our) (?:ears|eyes)\b|"
    r"\b(?:rushed|run|running) off (?:my|our) feet\b|\brunning late\b|"
    r"\bf[ae]ll(?:s|en|ing)? (?:fast |sound )?(?:asleep|in love)\b",
    re.IGNORECASE,
)
"""What is told to be a nuisance, and is no emergency."""
