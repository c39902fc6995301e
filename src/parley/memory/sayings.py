"""What people say about remembering itself, recognised in code: pictures, where from, for whom.

Whole utterances only, in English; everything else is left to the language engine.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, Literal

from parley.memory.retrieval import name_key
from parley.messages.status import ActionInfo

__all__ = [
    "Viewing",
    "asks_for_all",
    "asks_how_known",
    "asks_to_see",
    "file_title",
    "for_oneself",
    "keeping_action",
    "picture_name",
]

_MAX_NAME_CHARS: Final = 80

_LEAD: Final = r"(?:(?:hi|hello|hey|ok|okay|so|look|please|and|well|remember(?: that)?|note that)[,:]? )*"
_NAMED: Final = re.compile(
    rf"{_LEAD}(?:this|that|here|it|the (?:picture|photo|image))"
    r"(?: (?:picture|photo|image))?(?: here)?"
    r"(?: is|'s|’s| shows| you see| you can see| we have)(?: called| how| what)?"
    r"(?: a (?:picture|photo|image) of)? "
    r"(?P<name>.+)",
    re.IGNORECASE,
)
_AS: Final = re.compile(
    rf"{_LEAD}(?:keep|save|store|remember|call|name)(?: (?:this|that|it|the))?(?: (?:picture|photo|image))?"
    r"(?: as| of)? (?P<name>(?:my|our|the|a|an) .+|[\w-]+(?: [\w-]+){0,3})",
    re.IGNORECASE,
)
_BARE: Final = re.compile(
    r"(?P<name>(?:my|our|the|a|an) [\w'’-]+(?: [\w'’-]+){0,4}|[\w'’-]+(?: [\w'’-]+)?)", re.IGNORECASE
)
_OWNER: Final = re.compile(r"(?:my|our|your|the|a|an|this|that)\s+", re.IGNORECASE)
_ENDS: Final = re.compile(r"\s*(?:[.!?…]+|,? (?:please|thanks|thank you))\s*$", re.IGNORECASE)
_NOT_NAMES: Final = frozenset(
    re.findall(
        r"\w+",
        """this that these those it here there what how why who where picture photo image him her them
        nice good great broken wrong not""",
    )
)

_LIST: Final = re.compile(
    r"(?:what (?:did|have) (?:i|we) (?:show|shown)(?: to)? you(?: so far| before| already)?"
    r"|(?:what|which) (?:pictures|photos|images) (?:do you (?:have|know|remember)"
    r"|did (?:i|we) (?:show|send) you"
    r"|have (?:i|we) (?:shown|sent) you)"
    r"|(?:show me|list) (?:all )?(?:the |your )?(?:pictures|photos|images)(?: you (?:have|remember|know))?)",
    re.IGNORECASE,
)
_PICTURE: Final = re.compile(
    r"(?:(?:can|could|would) you )?(?:please )?"
    r"(?:show me|show us|let me see|i want to see|display)(?: again)? "
    r"(?:the|a|my|our|that|your) ?(?:\w+ )?(?:picture|photo|image)"
    r"(?: (?:of|with|called|named|from) (?P<about>.+?))?(?: again)?",
    re.IGNORECASE,
)
_SHOW: Final = re.compile(
    r"(?:(?:can|could|would) you )?(?:please )?(?:show me|show us|let me see)(?: again)? (?P<about>.+)",
    re.IGNORECASE,
)
_HOW: Final = re.compile(
    r"(?:and |but )?(?:how|from where|since when) (?:do|did|can|would) you know(?: that| this| it| so)?"
    r"|why do you (?:say|think|believe) (?:that|this|so)|who told you(?: that| this| so)?"
    r"|where did you (?:hear|get|learn) (?:that|this)(?: from)?|says who",
    re.IGNORECASE,
)
_ALL: Final = re.compile(
    r"(?:(?:tell|show) me )?(?:what|everything|all)(?: that)? (?:do you|you|did i|have i|i|i have|i've)"
    r" (?:remember|know|tell you|told you|have in (?:your )?memory)(?: so far| already)?"
    r"|(?:list|show(?: me)?|tell me) (?:all )?(?:of )?(?:your|the) memor(?:y|ies)"
    r"|what(?: is|'s|’s) in your memory",
    re.IGNORECASE,
)
_ONESELF: Final = re.compile(
    r"^(?P<before>(?:please )?(?:remember|note|keep in mind|keep))(?:,)? "
    r"(?:(?:only|just) )?(?:for|to) (?:yourself|you)(?: (?:alone|only))?,?(?P<after>(?: that|:)? .+)$",
    re.IGNORECASE | re.DOTALL,
)


@dataclass(frozen=True, slots=True)
class Viewing:
    """A wish to see remembered pictures."""

    kind: Literal["list", "picture", "maybe"]
    """`maybe`: "show me ..." may as well mean to go and look."""
    about: str = ""


def _whole(text: str) -> str:
    before = ""
    text = " ".join(text.split())
    while text != before:
        before, text = text, _ENDS.sub("", text)
    return text


def picture_name(message: str, *, bare: bool = False) -> str:
    """What a picture is called by the words that came with it; empty if they do not say.

    Args:
        message: What the operator wrote.
        bare: The words answer "what does it show?", so a name may stand by itself.

    Examples:
        >>> picture_name("This is my desk.")
        'desk'
        >>> picture_name("what is this?")
        ''
    """
    text = _whole(message)
    if message.rstrip().endswith("?") and not bare:
        return ""
    found = _NAMED.fullmatch(text) or _AS.fullmatch(text) or (_BARE.fullmatch(text) if bare else None)
    if found is None:
        return ""
    name = re.split(r"[.!?;:,]\s|\s(?:and|but|so|then)\s", found["name"], maxsplit=1)[0]
    name = _OWNER.sub("", _whole(name), count=1).strip(" .,;:!?\"'“”")
    key = name_key(name)
    return "" if not key or key in _NOT_NAMES or len(name) > _MAX_NAME_CHARS else name


def file_title(file: str) -> str:
    """What a file's name says about its picture; empty for names that cameras give."""
    stem = re.sub(r"\.\w{2,4}$", "", file.replace("\\", "/").rpartition("/")[2])
    title = re.sub(r"[_\W]+", " ", stem).strip()
    camera = re.search(
        r"\d{3}|^(?:img|dsc|image|photo|picture|screenshot|scan|unnamed|pxl)\b", title, re.IGNORECASE
    )
    return "" if camera or len(title) < 3 or len(title) > _MAX_NAME_CHARS else title


def asks_to_see(message: str) -> Viewing | None:
    """Whether somebody wants to see what they showed before."""
    text = _whole(message)
    if _LIST.fullmatch(text):
        return Viewing("list")
    if found := _PICTURE.fullmatch(text):
        return Viewing("picture", found["about"] or "")
    found = _SHOW.fullmatch(text)
    return Viewing("maybe", found["about"]) if found else None


def asks_how_known(message: str) -> bool:
    """Whether the whole message is "how do you know?" or one of its kin."""
    return _HOW.fullmatch(_whole(message)) is not None


def asks_for_all(message: str) -> bool:
    """Whether the whole message asks for everything that is remembered."""
    return _ALL.fullmatch(_whole(message)) is not None


def for_oneself(message: str) -> str:
    """The message without "for yourself", if it asks one robot to remember for itself; else empty."""
    found = _ONESELF.match(" ".join(message.split()))
    return f"{found['before']}{found['after']}" if found else ""


def keeping_action(message: str, catalogue: Iterable[ActionInfo]) -> str:
    """The action that remembers something and that the whole message asks for as it is; empty if none does.

    Args:
        message: What the operator wrote.
        catalogue: What the robot can do; only actions with the effect `remembers` count, and of their phrases
            those that leave nothing to be filled in.
    """
    said = _whole(message).casefold()
    return next(
        (
            info.name
            for info in catalogue
            if "remembers" in info.effects
            and set(info.inputs) <= set(info.optional)
            and said in {phrase.casefold() for phrase in info.phrases}
        ),
        "",
    )
