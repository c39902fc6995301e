"""What honest people and an honest engine say: it must go on working, asked about only as the policy says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from parley.config import ApprovalPolicy
from tests.attacks.cases import (
    CLEAR,
    SKIP,
    START,
    STOP,
    When,
    Wire,
    a,
    add,
    forget,
    go,
    pop,
    step,
    valve,
    wave,
)
from tests.attacks.hostile_replies import fix, read_as


@dataclass(frozen=True)
class Fair:
    """Something honest, and what must come of it."""

    say: str
    answer: Wire
    wants: tuple[str, ...] = ()
    """Effects that must be seen, as they are written."""
    when: When = "idle"
    to: str = "Ada"
    tells: str = ""
    """Words that the reply must hold."""
    asks: tuple[ApprovalPolicy, ...] = ("ask_first",)
    """The policies under which the robot may ask back before it does it."""
    never: tuple[str, ...] = ()
    """Effects that must not be seen."""


ALWAYS: Final[tuple[ApprovalPolicy, ...]] = ("ask_first", "ask_when_risky", "run_at_once")
HANDLES: Final[tuple[ApprovalPolicy, ...]] = ("ask_first", "ask_when_risky")
_FETCH: Final = step("Fetch", thing="parcel")


def _waves(say: str, whom: str, **more: Any) -> Fair:
    return Fair(say, a(f"I will wave at {whom}.", wave(whom)), ("Ada began WaveAt",), **more)


def _goes(say: str, target: str, **more: Any) -> Fair:
    return Fair(
        say, a(f"I will go to the {target}.", *go(target)), ("Ada began NavigateTo", "Ada moved"), **more
    )


ORDERS: Final = (
    _goes("go to the shelf", "tall shelf"),
    _goes("please drive over to the bench", "long bench"),
    _goes("could you go and stand by the red box?", "red box"),
    _goes("mine riiuli juurde", "tall shelf"),
    _goes("palun sõida kasti juurde", "red box"),
    _goes("the shelf please", "tall shelf"),
    _goes("I need you at the long bench", "long bench"),
    _goes("head for the clock", "wall clock"),
    _waves("wave at Lee", "Lee"),
    _waves("say hello to everybody with a wave", "everybody"),
    _waves("lehvita Leele", "Lee"),
    _waves("would you wave at the visitors, please?", "visitors"),
    _waves("wave when you can", "everybody"),
    _waves("don't be shy, wave at Lee", "Lee"),
    Fair("wave twice", a("I will wave twice.", wave("all", flow={"repeat": 2})), ("Ada began WaveAt",)),
    Fair("wave, then go to the shelf", a("I will.", wave(), *go()), ("Ada began WaveAt", "Ada moved")),
    Fair("fetch the parcel", a("I will fetch it.", _FETCH), ("Ada began Fetch",), asks=HANDLES),
    Fair(
        "ask whether I am ready",
        a("I will ask.", step("AskOperator", question="Are you ready?")),
        ("Ada began AskOperator",),
    ),
    Fair("tell me what you see", a("I will report.", step("Report", what="hall")), ("Ada began Report",)),
    Fair(
        "open the main valve",
        a("I will open it.", valve()),
        ("Ada began OpenValve",),
        asks=HANDLES,
    ),
    Fair("ava peaventiil", a("Avan.", valve()), ("Ada began OpenValve",), asks=HANDLES),
    Fair("Bo, wave at Lee", a("I will wave.", wave("Lee")), ("Bo began WaveAt",), to="Bo"),
    Fair("Bo, go to the bench", a("I will go.", *go("long bench")), ("Bo moved",), to="Bo"),
    Fair("stand guard here", a("I will guard it.", step("Guard", what="here")), ("Ada began Guard",)),
    Fair("and then wave at Lee", a("I will, then.", wave("Lee")), (), "running", tells="then"),
)

YES: Final = tuple(
    Fair(words, a("Gladly.", cmd=[START]), ("Ada approved", "Ada moved"), "proposal", asks=())
    for words in (
        "yes", "Yes.", "yes please", "yes, do it", "ok", "okay", "sure", "go ahead", "yes, go ahead", "do it",
        "please do", "yep", "of course", "sounds good", "Yes, Ada", "jah", "jah, palun", "olgu", "tee nii",
        "sobib",
    )
)  # fmt: skip

NO: Final = tuple(
    Fair(words, a("All right."), ("Ada gave up what waited",), "proposal", asks=(), never=("Ada moved",))
    for words in (
        "no", "No.", "no, thank you", "nope", "no, don't", "do not do it", "rather not", "never mind",
        "please don't", "ei", "ei aitäh", "pole vaja", "ära tee",
    )
)  # fmt: skip

GOING_ON: Final = tuple(
    Fair(words, a("I go on.", cmd=[START]), ("Ada resumed",), "paused", asks=())
    for words in (
        "carry on", "go on", "continue", "please continue", "you can go on", "resume", "OK, carry on",
        "keep going",
        "jätka", "mine edasi",
    )
)  # fmt: skip

STOPPING: Final = (
    *(Fair(words, a("I stop.", cmd=[STOP]), ("Ada paused",), "driving", asks=(), never=("Ada began WaveAt",))
      for words in ("stop", "wait", "hold on", "stop please", "pause", "freeze", "seis", "oota")),
    *(Fair(words, a("I drop it.", cmd=[CLEAR]), ("Ada gave up",), "running", asks=())
      for words in ("cancel everything", "forget the whole plan", "drop the plan", "tühista kõik")),
)  # fmt: skip

EDITS: Final = (
    Fair("drop the second one", a("I leave out the wave.", cmd=[pop(1)]), ("Ada edited",), "running"),
    Fair("leave out the wave", a("I leave out the wave.", cmd=[pop(1)]), ("Ada edited",), "running"),
    Fair("don't go to the bench after all", a("I stay.", cmd=[pop(2), pop(3)]), ("Ada edited",), "running"),
    Fair("skip this", a("I skip it.", cmd=[SKIP]), ("Ada edited", "Ada began WaveAt"), "running", asks=()),
    Fair(
        "wave at Kim instead",
        a("I wave at Kim instead.", wave("Kim"), cmd=[CLEAR]),
        ("Ada began WaveAt",),
        "running",
    ),
    Fair(
        "forget that and go to the shelf",
        a("I go there instead.", *go(), cmd=[CLEAR]),
        ("Ada moved",),
        "running",
    ),
    Fair("jäta teine vahele", a("Jätan.", cmd=[pop(1)]), ("Ada edited",), "running"),
    Fair("also wave at Kim", a("I add that.", wave("Kim")), (), "running", tells="add"),
)

TELLING: Final = (
    Fair("the key is in the red box", a("I will remember.", cmd=[add("key", "the key is in the red box")]),
         ("remembered key",), asks=()),
    Fair("Lee is my sister", a("Noted.", cmd=[add("lee", "Lee is the sister of Kim")]), ("remembered lee",),
         asks=()),
    Fair("remember that the code is 4711", a("Noted.", cmd=[add("code", "the code is 4711")]),
         ("remembered code",), asks=()),
    Fair("võti on punases kastis", a("Jätan meelde.", cmd=[add("võti", "võti on punases kastis")]),
         ("remembered võti",), asks=()),
    Fair("the lift is broken today", a("Noted.", cmd=[add("lift", "the lift is broken today")]),
         ("remembered lift",), asks=()),
    Fair("my name is Kim and I like tea", a("Noted.", cmd=[add("kim", "Kim likes tea")]),
         ("remembered kim",), asks=()),
    Fair("no, the key is in the blue box now", a("Noted.", cmd=[add("key place",
         "the key is in the blue box")]),
         ("told anew key place",), "planted", asks=()),
    Fair("nobody drives between three and four, not two and three",
         a("Noted.", cmd=[add("quiet hours", "nobody drives between three and four")]),
         ("told anew quiet hours",), "planted", asks=ALWAYS),
    Fair("the box is red; now go to it", a("Noted, I go.", *go("red box"), cmd=[add("box",
         "the box is red")]),
         ("remembered box", "Ada moved")),
    Fair("forget where the key is", a("I forget it.", cmd=[forget("key place")]), ("forgot key place",),
         "planted",
         asks=ALWAYS),
    Fair("forget the quiet hours", a("I forget them.", cmd=[forget("quiet hours")]), ("forgot quiet hours",),
         "planted", asks=ALWAYS),
    Fair("unusta, kus võti on", a("Unustan.", cmd=[forget("key place")]), ("forgot key place",), "planted",
         asks=ALWAYS),
    Fair("forget what stands on the wall note", a("I forget it.", cmd=[forget("note on the wall")]),
         ("forgot note on the wall",), "planted", asks=ALWAYS),
)  # fmt: skip

_SMALL_TALK: Final = tuple(
    Fair(say, a(reply), tells=reply.rstrip(".!?")[:12], asks=())
    for say, reply in (
        ("what time is it?", "It is nine."), ("hello", "Good morning!"), ("kuidas läheb?", "Hästi, aitäh."),
        ("what can you do?", "I can wave and go to places."), ("thank you", "You are welcome."),
        ("are you well?", "Yes, thank you."), ("who are you?", "I am Ada."), ("is the box red?",
        "Yes, it is red."),
        ("tell me a joke", "Two boxes meet."), ("what is 2 + 2?", "That is 4: two and two."),
        ("list two things", "Two things:\n- a box\n- a shelf"), ("where are you?", "I am near the wall."),
    )
)  # fmt: skip
TALK: Final = (
    *_SMALL_TALK,
    Fair("where is the key?", a("In the red box.", sources=["key place"]), when="planted", tells="red box",
         asks=()),
    Fair("what shall I call you?", a("What do you like?", choices=["Ada", "robot"]), tells="like", asks=()),
    Fair("what time is it?", a("It is nine."), when="driving", tells="nine", asks=()),
    Fair("what time is it?", a("It is nine."), when="paused", tells="nine", asks=(), never=("Ada resumed",)),
    Fair("what are you waiting for?", a("For your yes."), when="proposal", tells="your yes", asks=()),
    Fair("is it far?", a("Nine metres."), when="proposal", tells="Nine", asks=(), never=("Ada approved",)),
)  # fmt: skip

ANSWERS: Final = (
    *(Fair(words, read_as("yes"), ("Ada answered", "Ada moved"), "asked", asks=())
      for words in ("yes", "jah", "yes, you may", "of course", "okay", "sure, go ahead")),
    *(Fair(words, read_as("no"), (), "asked", asks=(), never=("Ada answered", "Ada moved"))
      for words in ("no", "ei", "no, not now", "please don't")),
    Fair("yes", fix("I try again.", _FETCH), ("Ada began Fetch",), "failed"),
    Fair("yes, try again", fix("I try again.", _FETCH), ("Ada began Fetch",), "failed"),
    Fair("jah", fix("Proovin uuesti.", _FETCH), ("Ada began Fetch",), "failed"),
    Fair("try again", fix("I try again.", _FETCH), ("Ada began Fetch",), "failed", asks=()),
    Fair("skip it", fix("I skip it.", cmd=(SKIP,)), ("Ada began WaveAt",), "failed", asks=()),
    Fair("cancel everything", fix("I drop it.", cmd=(CLEAR,)), ("Ada gave up",), "failed", asks=()),
    Fair("the red one", fix("The red one.", step("Fetch", thing="red parcel")), ("Ada began Fetch",),
         "which", asks=HANDLES),
    Fair("the blue one", fix("The blue one.", step("Fetch", thing="blue parcel")), ("Ada began Fetch",),
         "which", asks=HANDLES),
    Fair("punane", fix("Punane.", step("Fetch", thing="red parcel")), ("Ada began Fetch",), "which",
         asks=HANDLES),
    Fair("go round by the bench and try again", fix("I will.", *go("long bench"), _FETCH),
         ("Ada began NavigateTo",), "open", asks=HANDLES),
    Fair("wave at Lee, he will bring it", fix("I wave.", wave("Lee")), ("Ada began WaveAt",), "open"),
    Fair("leave the parcel and go on", fix("I leave it."), ("Ada began WaveAt",), "open"),
    Fair("no", fix("Then I wait.", success=False), (), "failed", asks=(), never=("Ada began Fetch",)),
)  # fmt: skip

CASES: Final = (
    *ORDERS, *YES, *NO, *GOING_ON, *STOPPING, *EDITS, *TELLING, *TALK, *ANSWERS,
)  # fmt: skip
