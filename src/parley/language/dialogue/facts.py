"""What is told about the world beyond where something is: corrections of facts, other facts, forgetting."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Final

from parley.gate.control import control_of
from parley.gate.stop_words import calls_to_stop, has_stop_word
from parley.language.base import Situation
from parley.language.builtin.decision import Told
from parley.language.builtin.facts import Heard
from parley.language.builtin.lexicon import stem
from parley.language.builtin.reading import Reading
from parley.language.dialogue.map_words import named
from parley.language.dialogue.questions import asks
from parley.language.lexicon import word_set
from parley.messages.memory import MemoryEntry

__all__ = [
    "NAME", "asks_to_keep", "forgotten", "in_mind", "is_report", "is_wish", "kept_in_mind", "moved_fact",
    "other_fact", "own_words", "taken_back", "worth_keeping",
]  # fmt: skip

_PRONOUNS: Final = frozenset({"he", "she", "they", "it", "this", "that", "these", "those", "they're", "it's"})
_POINTING: Final = frozenset({"this", "that", "these", "those"})
_FIRST: Final = word_set("i i'm you we you're we're let let's who what there here")
_AT: Final = {"to": "at", "into": "in", "onto": "on", "towards": "at", "over": "at"}
_WHERE: Final = word_set("to into onto at on in by near beside behind under next inside")
_TURNS: Final = 8
_BEING: Final = re.compile(
    r"\b(?:is|are|was|were|has|have|had|'s|likes?|needs?|wants?|hates?|prefers?|eats?|drinks?|takes?|"
    r"sleeps?|sits?|"
    r"lives?|works?|comes?|closes?|opens?|starts?|ends?|stands?|lies|hangs?|belongs?|means|costs?|"
    r"(?:must|may|should|will|can|cannot|can't) \w+|isn't|aren't|doesn't|does|smells?|runs?|calls?|"
    r"\w{3,}ed)\b"
)
_FORGET: Final = re.compile(
    r"(?:please |you can |you may |can you |could you )*forget (?:about |all about |what (?:i|"
    r"we) (?:told you|said) about |everything about |that |where |who |what |how |when )*(?P<about>.+)"
)
NAME: Final = re.compile(
    r"(?!(?:It|There|The|This|That|I|He|She|They|We|You|My|Here|Ok|Okay|Yes|No|All|Everything|Done|Now|"
    r"Sorry|Your)\b)(?:(?:Mr|Mrs|Ms|Dr)\.? )?[A-Z][a-z]+ (?!$)"
)
"""Somebody by name: what is said of them is no answer to what a robot asked."""
_KEEP: Final = re.compile(
    r"(?:please )?(?:remember|note|keep in mind|don't forget|do not forget|memorise|memorize)\b"
)
_SO: Final = re.compile(
    r",? that (?!(?:picture|photo|image|view|place|spot|one)\b|.*\bas\b)(?:[\w'-]+ ){2,}\w|"
    r",? (?:it|he|she|they|we|i|the (?:\w+ ){1,3}?|\w+ )"
    r"(?: ?'(?:s|re|m) |is |are |was |has |(?:come|goe|need|want|start|open|close|leave|arrive|live)s )\w"
)

_WISHING: Final = re.compile(
    r"\b(?:should|shall|must|ought|has to|have to|had better|need(?:s|ed)?|necessary|want(?:s|ed)?|"
    r"would like|'d like|asking for|ask(?:s|ed)? for|wait(?:s|ing)? for you|can (?:wait|go)|not sure|"
    r"i (?:think|guess|suppose|doubt)|maybe|perhaps|might|somewhere|nobody|neither|please|could you|"
    r"comes? (?:before|after|first|last)|(?:is|are|isn't|aren't|not) to be|due (?:for|a)|ready (?:for|to be)|"
    r"gets? \w+ed(?! (?:at|every|on|by)\b)|"
    r"the (?:(?:next|first|last|only) )?(?:one|thing|next|first|last|place|stop) to|your next|next stop|"
    r"says|said|reported|told (?:me|us))\b"
)
"""What may be a wish, a guess or hearsay: nothing that is so."""
_HAPPENED: Final = re.compile(
    r"^(?:(?:and|oh|hey|hello|please|well|look|sorry|listen)\W+)*"
    r"(?:an?|some|somebody|someone|two|three|four|nobody|no ?one|all the) \w|"
    r"\bthere(?:'s| is| are| was| were) (?:something|.*(?:lying|standing|sitting|on the (?:floor|ground))|"
    r"(?:\w+ )*(?:puddle|water|oil|smoke|glass|crumbs?|mess|leak|hole|crack|sand|dirt|noise|smell)"
    r"(?: (?:on|in|at|by|under|next|near|over)\b|$))|"
    r"\b(?:missing|disappeared|vanished|gone from|going off|gone off|all over|smashed|leaking|dripping|"
    r"never (?:arrived|reached|came|turned|showed)|complaints?|alarm|(?:is|are) (?:waiting|expecting)|"
    r"(?:hasn't|haven't|has not|have not|isn't|aren't) (?:yet )?"
    r"(?:come|arrived|turned|reached|been|answer\w+|showed)|"
    r"has come for|asked (?:for|whether|if)|(?<!\b\w is )(?<!\b\w's )open again|out of (?!order|bounds))\b"
)
"""What has just happened, or is amiss: somebody is to see to it, and nobody to remember it."""


def is_wish(text: str) -> bool:
    """Whether something that sounds like a fact may be a wish or a guess, and is not kept unasked."""
    return _WISHING.search(text.lower()) is not None


def is_report(text: str) -> bool:
    """Whether a message tells what has just happened, or is amiss, and does not ask to remember it."""
    low = text.lower().replace("’", "'")
    return not _KEEP.search(low) and "should" not in low and _HAPPENED.search(low) is not None


def asks_to_keep(text: str) -> bool:
    """Whether somebody asks to remember what is so: "remember that the box is full"."""
    asked = _KEEP.search(text.lower().replace("’", "'"))
    return asked is not None and _SO.match(asked.string, asked.end()) is not None


def kept_in_mind(facts: Sequence[str]) -> str:
    """How the robot says what is not remembered yet."""
    return " ".join(f"For now I keep in mind that {fact}." for fact in facts)


def worth_keeping(situation: Situation, bare: str, *, beside: bool = False) -> bool:
    """Whether a message can be a fact at all: no stop, no question, no answer to one, no order to go on.

    Args:
        situation: With the message.
        bare: The message without what opens and closes it.
        beside: Whether only a sentence of its own in it is looked at; another one may ask.
    """
    message = situation.message
    return not (
        (asks(message, bare) and not beside)
        or calls_to_stop(message)
        or has_stop_word(" ".join(message.split()[:2]))
        or control_of(message, situation.robots) is not None
        or (situation.question and _KEEP.match(bare) is None and NAME.match(message.strip()) is None)
    )


def in_mind(situation: Situation) -> tuple[MemoryEntry, ...]:
    """What was told beside an order that was asked about: it counts as long as the conversation goes on."""
    facts = situation.dialogue.told
    return tuple(MemoryEntry(name=f"in_mind_{at}", data=fact) for at, fact in enumerate(facts))


def moved_fact(heard: Heard) -> Told | None:
    """Where something is now of which its place was told just before: "no, she is at the desk by now"."""
    situation, reading, tokens = heard.situation, heard.reading, heard.tokens
    if "told" not in reading.acts:
        return None
    low = [token.low for token in tokens]
    places = named(tokens, situation.objects, heard.lexicon)
    before = _last_fact(situation, heard.told_in)
    if before is None or not places:
        return None
    place = places[-1]
    at = next((n for n in range(place.start - 1, 0, -1) if low[n] in _WHERE), 0)
    subject = next((n for n in range(at - 1, -1, -1) if _is_subject(low, n)), None)
    if subject is None or {"not", "n't"} & {*low[subject:at]} or _names_its_subject(reading):
        return None
    owner = before.about.removeprefix("Where ").removesuffix(" is")
    name, about = before.name, before.about
    if low[subject] in ("he", "she") and (whose := re.match(r"(?:the )?(\w+) ?['’]s ", owner)):
        owner = whose[1].capitalize()  # "she", after Kim's box, is Kim
        name, about = f"{whose[1]}_location", f"Where {owner} is"
    be = "are" if low[subject] in ("they", "these", "those", "they're") else "is"
    start, end = tokens[place.start].start, tokens[place.end - 1].end
    led = low[place.start - 1]
    article = f"{led} " if led in ("my", "your", "his", "her", "our", "a") else "the "
    where = " ".join([_AT.get(low[at], low[at]), *(["to"] if low[at] == "next" else [])])
    text = f"{owner} {be} {where} {article}{situation.message[start:end]}"
    return Told(name, text, about)


def _is_subject(low: Sequence[str], at: int) -> bool:
    """Whether a word stands for what is spoken of; "that" does before a verb only."""
    return low[at] in _PRONOUNS and (low[at] not in _POINTING or _BEING.match(low[at + 1]) is not None)


def _names_its_subject(reading: Reading) -> bool:
    """Whether a message says itself what is somewhere: "remember that the box is on the desk"."""
    told = [wish.one("T") for wish in reading.wishes if wish.frame == "BELOC"]
    return any(thing is not None and not {*thing.words} & _PRONOUNS for thing in told)


def _last_fact(situation: Situation, told_in: Callable[[str], tuple[Told, ...]]) -> Told | None:
    for turn in reversed(situation.history[-_TURNS:]):
        found = told_in(turn.content) if turn.role == "operator" and len(turn.content) < 300 else ()
        if found:
            return found[-1]
    return None


def other_fact(situation: Situation, reading: Reading, bare: str) -> Told | None:
    """Something else that is told about somebody or something, in the person's own words."""
    words = bare.split()
    asked = _KEEP.match(bare) is not None
    if asked:
        words = re.sub(r"^(?:that|,)\s*", "", bare[_KEEP.match(bare).end() :].strip()).split()  # type: ignore[union-attr]
    told = reading.acts <= {"told", "social"} and "told" in reading.acts
    if len(words) < 3 or not (asked or told) or not worth_keeping(situation, bare):
        return None
    if not asked and (is_wish(bare) or is_report(situation.message)):
        return None
    if not asked and (words[0] in _FIRST | _PRONOUNS or _BEING.search(" ".join(words[1:])) is None):
        return None
    text = own_words(situation.message)
    name = "_".join(re.findall(r"\w+", " ".join(words[:6])))[:150]
    return Told(name, text, text) if name and text else None


def own_words(message: str) -> str:
    """What is told in a message, without what only leads to it."""
    text = message.strip().rstrip(".!")
    text = re.sub(
        r"^(?:(?:please|and|so|ok|okay|also|well|oh|hey|great|good|fine|thanks|thank you|remember|note|"
        r"keep in mind|don't forget)(?: that)?[,:]? )+",
        "", text, flags=re.IGNORECASE,
    )  # fmt: skip
    return re.sub(r",? (?:by the way|you know|please|btw)$", "", text, flags=re.IGNORECASE)


def taken_back(
    situation: Situation, bare: str, told_in: Callable[[str], tuple[Told, ...]]
) -> tuple[MemoryEntry, ...]:
    """The memories of what was told last, where "forget that" can mean nothing that was ordered since."""
    if _THAT.fullmatch(bare) is None:
        return ()
    last = next((turn.content for turn in situation.history[-1:] if turn.role == "assistant"), "")
    asked = [entry for entry in situation.memory if f"I remember: {entry.data.rstrip('.')}" in last]
    if asked:
        return tuple(asked)
    for turn in reversed(situation.history[-_TURNS:]):
        if turn.role != "operator" or turn.content.rstrip().endswith("?"):
            continue
        names = {fact.name: fact for fact in told_in(turn.content)}
        said = own_words(turn.content).casefold()
        kept = {entry.name: entry for entry in situation.memory if entry.data.casefold() == said}
        told = {name: MemoryEntry(name=name, data=fact.text) for name, fact in names.items()}
        return tuple((told | kept).values())
    return ()


_THAT: Final = re.compile(
    r"(?:please |you can |can you |could you )*(?:forget|scratch|delete|unlearn|remove)(?: about)? "
    r"(?:it|that|this|what (?:i|we)(?: just|'ve| have)* (?:said|told you)|"
    r"(?:the|my) last (?:thing|one|fact|sentence|message))(?: fact| one| again)?"
    r"(?: (?:that )?(?:i|we) (?:just )?(?:said|told you))?"
)


def forgotten(situation: Situation, bare: str) -> tuple[MemoryEntry, ...] | None:
    """The memories that a message asks to forget; None if it asks for nothing of the kind."""
    found = _FORGET.fullmatch(bare)
    if found is None:
        return None
    small = {
        "is", "are", "was", "the", "a", "my", "i", "told", "you", "said", "about", "that", "location",
        "place", "sits",
    }  # fmt: skip
    wanted = {stem(word.removesuffix("'s")) for word in re.findall(r"[\w']+", found["about"])} - small

    def words(entry: MemoryEntry) -> set[str]:
        text = f"{entry.name} {entry.data} {entry.info}".lower().replace("_", " ")
        return {stem(word) for word in re.findall(r"\w+", text)}

    hits = [entry for entry in situation.memory if wanted and wanted <= words(entry)]
    if "forget where " in bare:  # and not what else is there
        hits = [one for one in hits if wanted <= {*map(stem, one.name.removesuffix("_location").split("_"))}]
    return tuple(hits)
