"""A literal yes or no, read by code before any language engine is asked, and never turned by one. Pure."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from typing import Final

from parley.gate.control import control_of

__all__ = ["assent_of", "begins_with_no", "gives_up", "takes_all_back"]

_YES: Final = frozenset({
    "yes", "yes please", "yes do", "yes do it", "yes do that", "yes go ahead", "yeah", "yep", "yup", "ok",
    "okay", "sure", "of course", "agreed", "fine", "alright", "all right", "do it", "do that", "do so",
    "please do", "go for it", "you may", "approved", "sounds good", "that is fine", "yes thank you",
    "yes thanks", "go ahead then", "yes sure", "ok do it", "okay do it", "yes i do", "yes that is right",
    "that is right", "correct", "exactly", "right", "affirmative", "by all means", "jah", "jaa", "jah palun",
    "jah tee", "olgu", "sobib", "tee nii", "tee ära", "muidugi", "õige", "nõus", "ole lahke", "palun tee",
})  # fmt: skip
_NO: Final = frozenset({
    "no", "nope", "nah", "no thanks", "no thank you", "no do not", "do not", "do not do it", "do not do that",
    "please do not", "rather not", "better not", "never mind", "leave it", "no leave it", "rejected",
    "no way", "not now", "not yet", "certainly not", "absolutely not", "of course not", "no not now",
    "no not yet", "no never", "no never mind", "never", "not at all", "negative", "no no", "no no no",
    "no i do not", "no that is wrong", "that is wrong", "wrong", "forget it", "no forget it", "no stop",
    "no wait",
    "ei", "ei aitäh", "ära tee", "ei ära tee", "pole vaja", "ei ole vaja", "mitte praegu", "ei mitte",
    "kindlasti mitte", "vale", "ei taha", "ära",
})  # fmt: skip

_YES_PARTS: Final = frozenset({
    "like that", "that way", "just like that", "go for it", "go on", "fine by me", "fine with me", "good",
    "great", "perfect", "lovely", "works for me", "that works", "good idea", "why not", "be my guest",
    "i agree", "i approve", "i am fine with that", "i am ok with that", "make it so", "let us do it",
    "let us do that", "let us go", "very good", "that is good", "that is ok", "that is okay",
    "that is what i want", "that is what i meant", "that sounds good", "sounds great", "sounds fine",
    "you can", "you can do that", "you can do it", "start", "proceed", "carry on", "begin", "absolutely",
    "definitely", "certainly", "indeed", "confirmed", "go", "aye", "you have my ok", "all good",
    "it is fine", "it is ok", "please go ahead", "yes yes", "go ahead",
})  # fmt: skip
_NO_PARTS: Final = frozenset({
    "i changed my mind", "changed my mind", "i have changed my mind", "i do not want that",
    "i do not want it", "i would rather not", "let us not", "do not bother", "drop it", "drop that",
    "scrap that", "scrap it", "leave that", "leave it be", "not today", "not any more", "not anymore",
    "no need", "not necessary", "that is not necessary", "that is not needed", "not needed", "forget that",
    "cancel that", "cancel it", "cancel", "stay", "stay here", "stay there", "stay where you are", "stop",
    "maybe later", "later", "another time", "some other time", "not like that", "i do not think so",
    "better not do that", "skip it", "i said no", "not that", "not that one", "not this", "not this one",
    "not those", "wrong one", "the wrong one", "that is the wrong one", "not what i meant",
    "that is not what i meant", "you may not", "you must not",
})  # fmt: skip
_TO_SEE: Final = frozenset({
    "go and check it out", "go check it out", "check it out", "have a look at it", "look into it",
    "go and see", "go see", "go and look", "go look", "have a look", "take a look", "go and have a look",
    "go and take a look", "go and check", "go check", "look", "check", "check it", "see for yourself",
    "go there and look", "go there and see", "go over there", "find out", "go and find out",
    "mine vaata", "vaata järele",
})  # fmt: skip
"""A yes where it was offered to go and look."""
_FILLERS: Final = frozenset({
    "please", "thanks", "thank you", "then", "now", "well", "oh", "um", "uh", "so", "sorry", "actually",
    "hm", "hmm", "dear", "mate", "buddy", "just", "man", "palun", "aitäh",
})  # fmt: skip
_IN_FULL: Final = (
    (r"\bdon'?t\b", "do not"), (r"\b(that|it)'?s\b", r"\1 is"), (r"\bi'?m\b", "i am"),
    (r"\bi'd\b", "i would"),
    (r"\blet'?s\b", "let us"), (r"\bi've\b", "i have"), (r"\bnever ?mind\b", "never mind"),
)  # fmt: skip
_GIVING_UP: Final = frozenset(
    {"stop", "cancel", "drop", "skip", "scrap", "forget", "stay", "leave", "bother"}
)
_LONGEST: Final = 8
"""So many words such phrases put together have at most."""


_NEGATION: Final = re.compile(
    r"\W*(?:no|nope|nah|not|never|neither|none|nothing|nowhere|don['’]?t|do not|ei|mitte|ära|pole)\b",
    re.IGNORECASE,
)


def assent_of(text: str, names: Sequence[str] = (), *, to_see: bool = False) -> bool | None:
    """Whether a whole utterance is a yes (True) or a no (False); None for everything else.

    Args:
        text: What the person said.
        names: Names of robots, which may be called before or after.
        to_see: Whether it was offered to go and look: "go and see" is a yes then.
    """
    if "?" in text:
        return None
    low = unicodedata.normalize("NFC", text).casefold().replace("’", "'")
    for short, full in _IN_FULL:
        low = re.sub(short, full, low)
    words = [word for word in re.split(r"\W+", low) if word]
    called = {part for name in names for part in name.casefold().split()}
    said = " ".join(word for word in words if word not in called)
    bare = said.removeprefix("please ").removesuffix(" please").removesuffix(" thanks")
    if said in _YES or bare in _YES:
        return True
    if said in _NO or bare in _NO:
        return False
    spoken = said.split()
    found = _put_together(spoken, _TO_SEE if to_see else frozenset())
    if found is None and spoken[:1] and spoken[0] in _RESIGNED and "no" not in spoken:  # "ok, leave it"
        return False if _put_together(spoken[1:]) is False else None
    return found


_RESIGNED: Final = frozenset({"ok", "okay", "fine", "well", "right", "alright", "hm", "oh", "ah"})


def _put_together(words: Sequence[str], more: frozenset[str] = frozenset()) -> bool | None:
    """A yes or a no of several such phrases ("yes, like that", "nah, leave it"); one word more is neither."""
    found: set[bool] = set()
    at, negated = 0, False
    while at < len(words) <= _LONGEST:
        for end in range(len(words), at, -1):
            phrase = " ".join(words[at:end])
            agrees = phrase in _YES | _YES_PARTS | more
            if phrase in _FILLERS or agrees or phrase in _NO | _NO_PARTS:
                if negated and words[at] in _GIVING_UP:
                    return None  # "don't stop", "never cancel it": no refusal at all
                negated = phrase.endswith(("do not", "never", "must not", "rather not"))
                if phrase not in _FILLERS:
                    found.add(agrees)
                at = end
                break
        else:
            return None
    return found.pop() if len(found) == 1 else None


_ONE_OF_THEM: Final = re.compile(r"\b(?:not (?:that|this|those|the|like|what)|wrong)\b", re.IGNORECASE)


def gives_up(text: str, names: Sequence[str] = ()) -> bool:
    """Whether a whole utterance is a no to a question of which one is meant, and not to one of them alone."""
    if takes_all_back(text):
        return True
    return assent_of(text, names) is False and not _ONE_OF_THEM.search(text)


_AT_LAST: Final = re.compile(
    r"[\w'’].*?(?:\s*[,.;!…–—]|\s+-|(?=\s\w))\s*"
    r"(?P<led>(?:\b(?:no|oh|ah|um|uh|hm+|well|ok|okay|actually|wait|sorry|hang on|hold on|"
    r"on second thoughts?)[\s,.!…–—-]+)*)(?P<but>but\s+)?"
    r"(?:(?P<plain>never ?mind(?: it| that)?|forget (?:it|that)|scratch that|scrap that|"
    r"i(?:['’]ve| have)? changed my mind)|"
    r"do(?:n['’]?t| not)(?: bother)?|(?:drop|cancel|leave) (?:it|that)|not now|better not|rather not|no)"
    r"\W*",
    re.IGNORECASE | re.DOTALL,
)
_BOUND: Final = re.compile(
    r"\b(?:if|unless|when(?:ever)?|until|in case|say|tell|ask|shout|write|says?|said)\b", re.IGNORECASE
)


def takes_all_back(text: str) -> bool:
    """Whether somebody takes back in the end what they began to say: "and bring the ... oh, never mind".

    "If it is shut, leave it" does not.
    """
    found = _AT_LAST.fullmatch(text.strip())
    if found is None or text.rstrip().endswith("?") or _BOUND.search(text) or assent_of(text) is False:
        return False
    began = text.strip()[: found.start("led")]
    if control_of(began.rstrip(" ,.;!…–—-")) is not None:  # "drop it all, I changed my mind"
        return False
    marked = re.search(r"[,.;!…–—-]\s*$", began) is not None
    return bool(found["led"] or (found["plain"] and (found["but"] or marked)))


def begins_with_no(text: str) -> bool:
    """Whether somebody begins with a negation: whatever follows, no language engine may call it a yes."""
    return _NEGATION.match(unicodedata.normalize("NFC", text)) is not None
