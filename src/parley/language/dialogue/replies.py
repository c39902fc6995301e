"""How an answer to a robot's question is meant: only what fits the question closes it."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Final

from parley.gate.assent import assent_of, begins_with_no
from parley.gate.control import control_of
from parley.gate.stop_words import calls_to_stop
from parley.language.base import ReplyReading
from parley.language.builtin.amounts import ORDINALS
from parley.language.builtin.lexicon import stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.tokens import tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.questions import asks, plain
from parley.language.lexicon import word_set

__all__ = ["chosen", "is_done", "is_thinking", "names_deed", "read_reply", "words_of"]

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
