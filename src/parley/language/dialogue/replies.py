"""How an answer to a robot's question is meant, and what it settles: only what fits a question closes it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Literal

from parley.gate.assent import assent_of, begins_with_no
from parley.gate.control import control_of
from parley.gate.stop_words import calls_to_stop
from parley.language.base import ReplyReading
from parley.language.builtin.amounts import ORDINALS, amount_of, in_unit
from parley.language.builtin.lexicon import stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.tokens import tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.questions import asks, plain
from parley.language.lexicon import word_set

__all__ = [
    "Settled",
    "chosen",
    "is_done",
    "is_thinking",
    "names_deed",
    "parts_of",
    "read_reply",
    "settled",
    "words_of",
]

_ORDINALS: Final = ORDINALS | {"one": 0, "two": 1, "three": 2, "1": 0, "2": 1, "3": 2, "4": 3}
_NOT: Final = word_set("""not no don't dont never can't cannot didn't haven't isn't nope nah without neither
none hasn't won't aren't couldn't""")
_DONE: Final = re.compile(
    r"(?!(?:is|are|was|did|has|have|can|do) (?:you|it|i|he|she|they|we|that|the)\b)"
    r"(?:(?:(?:there|here) (?:you (?:go|are)|we go)|"
    r"ok|okay|right|there|so|yes|yep|now|all|just|already|and|i|we|he|she|it|that|they|everything|"
    r"somebody|someone|you|the \w+|'s|'m|'ve|'re|s|is|are|has|have|was|were|did|been)\b ?)*"
    r"\b(?:done|did|loaded|ready|finished|put|placed|set|given|gave|handed|got|taken|took|moved|cleared|opened|"
    r"fixed|removed|completed?|over|sorted|brought|laid|left|packed|stowed|secured|strapped|slid|sitting|lying|"
    r"mounted|shut|closed|plugged|freed|pushed|pulled|gone|away|settled|aboard|accomplished|yours|with you|"
    r"in (?:place|it goes|(?:your|the) (?:tray|basket|box))|"
    r"(?:on|in|onto)(?= (?:it|you|your|top|board|there|tray|basket|now|already)\b|$)|"
    r"(?:there|here)(?= (?:it is|they are|now|we (?:go|are)|you (?:go|are))$|$))\b.*|"
    r"voila|all good|good to go|mission accomplished|"
    r"(?:you are|you're) good|you(?: have|'ve)(?: got)?(?: it| them)?(?: now)?|off you go|"
    r"take (?:it|them) away|"
    r"(?:you (?:can|may) )?(?:go on|carry on|continue|go ahead|drive on|move on|go|drive|leave|take it)"
    r"(?: now)?"
)  # fmt: skip
_ORDERED: Final = re.compile(r"(?:put|set|shut)\b(?!.*\b(?:it|them|you|your)\b)")
"""What begins so is an order: "put the radio on"; "put it on you" may be told."""
_RUN_TOGETHER: Final = re.compile(
    r"\b(?:(that|it|there|here|he|she)(s)|(i|you|we|they)(ve)|(you|they)(re))\b"
)
_MANY: Final = frozenset({"except", "all", "both", "each", "every"})
"""What takes several things together, or all but one."""
_TO_COME: Final = frozenset({"will", "i'll", "we'll", "let", "shall", "would", "going", "must", "should"})
_ONTO: Final = re.compile(
    r"\b(?:put|placed|laid|set|loaded|slid|strapped|tied|hung|gave|handed|packed|stowed)\b(?: \w+){0,4} "
    r"(?:(?:on|in|into|onto|to)(?: top of)? (?:you|your)\b|on$|in$|down$|already$)"
)
"""Whoever did it: "Kim put it on your tray"."""
_NO_MORE: Final = re.compile(
    r"\b(?:none|nothing|nobody|no ?one|no more|any more|(?:we are|we're|i am|i'm) out of|(?:run|ran) out|"
    r"empty|too (?:heavy|big|large|hot|far|high)|(?:does not|doesn't|won't) (?:fit|work|open)|broke|"
    r"impossible|missing|can't|cannot|couldn't|unable|"
    r"some(?:one|body)(?: else)?(?: has|'s)? (?:took|taken))\b|"
    r"^(?:it|they|the \w+)(?:'s| is| are|'re)(?: already| all)* gone$"
)
"""Why somebody does not do what was asked of them."""
_THINKING: Final = re.compile(
    r"(?:let me (?:think|see|check|look)(?: .*)?|(?:hang on|hold on|wait|just|give me|one|a|half a|only|"
    r"in)?(?: ?(?:just|a|one|me))*"
    r" ?(?:moment|minute|second|sec|while|tick|mo)(?: please| .*full.*| .*busy.*)?|i(?:'m|"
    r" am) (?:thinking|not sure|busy|coming|on my way|on it)"
    r"(?: .*)?|i(?:'ll| will) (?:think|be right (?:there|back)|come|do it (?:later|soon|in)).*|i (?:don't|"
    r"do not) know(?: yet)?|not sure(?: yet)?|"
    r"good question|.*\bmy hands are (?:full|busy|wet|dirty).*|busy|coming|not ready(?: yet)?|"
    r"wait(?: a .*)?|(?:(?:maybe|i'll do it|do it|no|not now) )?later|soon|be patient|"
    r"not (?:now|yet)|.*\byet|(?:almost|nearly|about to)\b.*)"
)
_NEVER: Final = re.compile(r"\W*never (?!mind\b)\w+ \w", re.IGNORECASE)
"""What begins so is a rule, and no answer."""
_FEW: Final = 2
_SURE: Final = 0.3
_OPEN: Final = re.compile(r"\b(?:what|which|who|whom|where|when|how|why)\b[^.?]*\?\s*$", re.IGNORECASE)


def _is_sure(wish: Wish) -> bool:
    """Whether something is really ordered."""
    return wish.act == "order" and not wish.negated and wish.witness == "agrees" and wish.share > _SURE


def words_of(text: str) -> list[str]:
    """The words of a text in small letters, in order."""
    return [token.low for token in tokenize(text) if token.is_word]


def names_deed(words: Sequence[str]) -> bool:
    """Whether somebody orders something rather than telling which one they mean."""
    return (
        bool({"go", "drive", "bring", "come", "check", "look", "take"} & {*words[:4]}) and "one" not in words
    )


def is_done(bare: str) -> bool:
    """Whether somebody says that what was asked of them is done."""
    bare = _RUN_TOGETHER.sub(lambda found: "'".join(filter(None, found.groups())), bare)
    done = _DONE.fullmatch(bare) or _ONTO.search(bare)
    if _ORDERED.match(bare) is not None:
        return False
    return not (_NOT | _TO_COME) & set(bare.split()) and done is not None


def is_thinking(text: str) -> bool:
    """Whether somebody asks for time."""
    whole = " ".join(words_of(text))
    return any(_THINKING.fullmatch(words) for words in (whole, plain(tokenize(text))))


def chosen(
    words: Collection[str], names: Sequence[str], also: Mapping[str, Sequence[str]] = MappingProxyType({})
) -> str | None:
    """The one of several names that words tell from the others, by what it is or by what it is not.

    Args:
        words: What was said.
        names: What is offered.
        also: What else each is called.
    """
    same = [name for name in names if words_of(name) == [*words]]
    if same:
        return same[0]
    said = {stem(word) for word in words}
    called = [" ".join([name, *also.get(name, ())]) for name in names]
    own = [{stem(word) for word in text.lower().split()} for text in called]
    shared = set.intersection(*own) if own else set()
    scores = [len(said & (mine - shared)) for mine in own]
    best = max(scores, default=0)
    if best and not (_NOT | _MANY) & set(words) and scores.count(best) == 1:
        return names[scores.index(best)]
    if _MANY & {*words}:
        return None
    if _NOT & set(words) and scores:
        left = [name for name, score in zip(names, scores, strict=True) if not score]
        return left[0] if len(left) == 1 and best else None
    place = next((_ORDINALS[word] for word in words if word in _ORDINALS and word != "one"), None)
    return names[place] if place is not None and names and place < len(names) else None


def read_reply(question: str, reply: str, choices: Sequence[str], reading: Reading | None) -> ReplyReading:
    """How an answer to a question is meant.

    Args:
        question: What was asked.
        reply: What was said.
        choices: What was offered.
        reading: Of the reply; None if there is no word in it.
    """
    asked = {*words_of(question)} - {"on", "in", "it", "done", "put", "me", "you", "i", "is"}
    words, bare = words_of(reply), plain(tokenize(reply))
    bare = " ".join(word for word in bare.split() if word not in asked) or bare
    if reading is None or not words:
        return ReplyReading("unclear")
    literal = assent_of(reply)
    waits = is_thinking(bare) and (len(words) > _FEW or control_of(reply) is None)
    if waits or is_thinking(" ".join(words)) or _NEVER.match(reply):
        return ReplyReading("aside")
    if control_of(reply) is not None and not (literal and not choices):
        return ReplyReading("control" if control_of(reply) != "start" else "yes")
    if choices and (choice := chosen(words, choices)) is not None:
        return ReplyReading("choice", choice)
    if literal is not None:
        return ReplyReading("yes" if literal else "no")
    if _NO_MORE.search(bare) and "?" not in reply:
        return ReplyReading("no")
    if is_done(bare) and not _NOT & {*words} and "?" not in reply:
        return ReplyReading("yes")
    if asks(reply, bare) or is_thinking(reply) or "alarm" in reading.acts or calls_to_stop(reply):
        return ReplyReading("aside")
    needs = "need" in reading.acts and len(words) > _FEW and not begins_with_no(reply)  # but "no box here"
    if any(_is_sure(wish) for wish in reading.wishes) or needs:
        return ReplyReading("aside")
    if begins_with_no(reply) or _NOT & set(words[:3]):
        return ReplyReading("no")
    if _OPEN.search(question) and not choices:
        return ReplyReading("answer")
    return ReplyReading("aside" if "told" in reading.acts and len(words) > 2 else "unclear")


# -- what an answer to "what shall I do about this failure?" settles, by the shape of its parts --


Way = Literal["again", "without", "stop", "clear", "done", "promise"]
"""Try once more; leave the step out; stand still; drop the plan; a person did it; a person will do it."""
_AGAIN: Final = re.compile(
    r"\b(?:again|retry|repeat|once more|one more time|keep trying|try (?:it|that|now)|detour|way around|"
    r"(?:an|one|a) ?(?:other|more|second|different) (?:try|go|attempt|shot|look|way|route|path|time)|"
    r"(?:go|drive|move|get|come|try) (?:it )?(?:round|around)|the other way)\b|^try$"
)
_LOOKING: Final = re.compile(r"(?:please )?(?:look|check|inspect)(?: (?:it|there))? again(?: please)?")
_WITHOUT: Final = re.compile(
    r"\b(?:without|skip|leave (?:it|that|this|out)|never ?mind|ignore|next step|"
    r"(?:do|(?:go|carry) on with|continue with|on with) the rest|"
    r"(?:forget|drop|omit)(?: about)? (?:it|that|this|the)|no (?:need|longer needed)|"
    r"(?:not|n't|don't|doesn't) (?:important|matter|needed|necessary|bother|need|want))\b"
)
_GIVING_UP: Final = re.compile(r"(?:no )?(?:(?:forget|drop|leave)(?: about)? (?:it|that|this)|never ?mind)")
_PROMISE: Final = re.compile(
    r"(?:(?:i|we|he|she|they|somebody|someone)(?:'ll| will|'m| am|'re| are|'s| is)"
    r"(?: (?:just|now|already|quickly))* (?!not\b|in\b|at\b|on the \b|sorry\b|here\b|sure\b)\w+.*|"
    r"let (?:me|us) \w+.*|(?:on (?:my|our|the) way|coming)(?: .*)?)"
)
_WAITING: Final = re.compile(r"\b(?:wait|give (?:it|them|him|her|me)|in|after|for)\b")
_JOINT: Final = re.compile(
    r"\s*(?:[.;,!:]+\s*(?:(?:and|then|but|so) )*|\b(?:and then|then|and|but)\b)\s*", re.IGNORECASE
)
_DENYING: Final = frozenset({"not", "n't", "don't", "no", "never", "nor"})
_OWN: Final = frozenset({"myself", "ourselves", "himself", "herself", "themselves"})
_CLEARING: Final = re.compile(
    r"\b(?:moved|removed|opened|cleared|pushed|pulled|freed|fixed|closed|plugged)\b"
)
"""What somebody does for a robot that goes on then; else what they did themselves is the step."""
_FREED: Final = re.compile(
    r"(?P<what>(?!i\b|we\b|it\b|that\b|this\b).+) (?:has|have) (?:now |just |all )?been "
    r"(?:moved|removed|cleared|taken away|picked up|put away|fixed|closed|opened)(?: now| again)?"
)
"""What is told to have been done, of something that is named: worth remembering as well."""
_CLEAR: Final = re.compile(
    r"(?:\w+(?: \w+){0,4}?)(?: is| are|'s|'re)(?: all| now| just)* "
    r"(?:gone|away|clear|free|empty|open|out of the way)(?: now| again)*"
)
"""What is told to be in nobody's way any more."""
_MOST_WORDS: Final = 9
_LONGEST_S: Final = 3600.0


@dataclass(frozen=True, slots=True)
class Settled:
    """What is done about a failed step, and what is said behind that."""

    way: Way
    delay_s: float = 0.0
    rest: str = ""
    """What is said besides, which may be an order: for afterwards, or with `clear` in place of the plan."""
    fact: str = ""
    """What is so from now on, in the person's words."""


def settled(reply: str, things: Collection[str], *, in_the_way: bool = False) -> Settled | None:
    """What an answer settles; None if it is no such answer.

    Args:
        reply: What was said.
        things: The stems of words that name other things than the step is about: with one of them in it an
            answer is more than this.
        in_the_way: Whether something was in the way, or where nothing should be.
    """
    wait_s = 0.0
    if re.match(r"\W*(?:go|come|drive) and \w", reply, re.IGNORECASE):
        return None  # "go and charge" is an order
    for piece, rest in parts_of(reply):
        way, seconds = _way(piece, things), _seconds(piece)
        if in_the_way and _is_clear(piece, things):
            way = "done"
        while way == "done" and rest and in_the_way:  # "done, the box is gone, go on to the desk"
            more, behind = next(parts_of(rest))
            if not (_is_clear(more, things) or is_done(plain(tokenize(more)))):
                break
            rest = behind
        if seconds and way in (None, "stop") and _WAITING.search(piece.lower()):
            wait_s += seconds
            continue
        if way == "again":
            later = _seconds(rest)
            return Settled(way, min(wait_s + seconds + later, _LONGEST_S), "" if later else rest)
        if way is None and _FREED.fullmatch(plain(tokenize(piece))) and not {*words_of(piece)} & _DENYING:
            return Settled("done", 0.0, rest, piece.strip())
        gives_up = way == "without" and rest and _GIVING_UP.fullmatch(plain(tokenize(piece)))
        return None if way is None else Settled("clear" if gives_up else way, 0.0, rest)
    return Settled("again", min(wait_s, _LONGEST_S)) if wait_s else None


def parts_of(reply: str) -> Iterator[tuple[str, str]]:
    """The parts of an answer, each with all that is said behind it."""
    text = reply.strip().rstrip(".!")
    cuts = [cut for cut in _JOINT.finditer(text) if cut.start() and cut.end() < len(text)]
    starts = [0, *(cut.end() for cut in cuts)]
    for start, end in zip(starts, [*(cut.start() for cut in cuts), len(text)], strict=True):
        behind = next((later for later in starts if later > start), len(text))
        yield text[start:end], text[behind:]


def _is_clear(piece: str, things: Collection[str]) -> bool:
    words = words_of(piece)
    about = {stem(word) for word in words} & {*things}
    return _CLEAR.fullmatch(plain(tokenize(piece))) is not None and not (about or _DENYING & {*words})


def _way(piece: str, things: Collection[str]) -> Way | None:
    words, bare = words_of(piece), plain(tokenize(piece))
    command = control_of(piece)
    if command in ("stop", "emergency_stop", "clear"):
        return "clear" if command == "clear" else "stop"
    short = len(words) <= _MOST_WORDS and not {stem(word) for word in words} & {*things}
    if command == "skip" or (short and _WITHOUT.search(bare)):
        return "without"
    if (
        short
        and (_AGAIN.search(bare) or _LOOKING.fullmatch(piece.lower().strip(" .!")))
        and not _DENYING & {*words}
    ):
        return "again"
    if is_done(bare):
        return "without" if _OWN & {*words} and not _CLEARING.search(bare) else "done"
    return "promise" if _PROMISE.fullmatch(bare) and not _DENYING & {*words} else None


def _seconds(text: str) -> float:
    """The span of time in a text; 0 if there is none."""
    words = words_of(text)
    for start in range(len(words)):
        for end in range(min(len(words), start + 4), start + 1, -1):
            if (span := _span(words[start:end])) is not None:
                return span
    return 0.0


def _span(words: Sequence[str]) -> float | None:
    amount = amount_of(words)
    return in_unit(amount, "s") if amount is not None and amount.kind == "duration" else None
