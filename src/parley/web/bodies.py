"""What the page sends, and answers that are no part of the live stream; bounded, closed, typed."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, StringConstraints, model_validator

from parley.messages.attendance import Unattended
from parley.messages.chat import ActionCall
from parley.messages.map import MapRoom, MapThing
from parley.messages.principal import Role
from parley.sentences import SpokenLanguage
from parley.web.models import ChatEntry, Policy, WebModel
from parley.web.people.records import Way

__all__ = [
    "ChatPage",
    "ChatPost",
    "CodeInfo",
    "CodePost",
    "CredentialPost",
    "DecisionPost",
    "DeviceInfo",
    "Done",
    "FavouritePut",
    "FeedKey",
    "FrameMeta",
    "Health",
    "ImageUpload",
    "LanguagePut",
    "MemoryPut",
    "MyAccount",
    "MyPasskey",
    "MyPassword",
    "PasskeyPost",
    "PasskeyQuestion",
    "PeopleInfo",
    "PersonInfo",
    "PersonPost",
    "PersonPut",
    "PlanCommandPost",
    "PolicyPut",
    "ProblemDetail",
    "RobotPost",
    "RobotStop",
    "RuleTryPost",
    "SessionInfo",
    "SessionPost",
    "StepsPut",
    "StopAnswer",
    "StopPost",
]

Name = Annotated[str, StringConstraints(min_length=1, max_length=100, strip_whitespace=True)]
Secret = Annotated[str, StringConstraints(max_length=200)]
Key = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_.-]{1,64}$")]

MAX_IMAGE_CHARS = 4_000_000
"""Of a picture in base64: about 3 MB."""


class Done(WebModel):
    """It was done, or sent on its way."""

    ok: Literal[True] = True


class Health(WebModel):
    """Whether the server is well."""

    ok: bool
    version: str


class ProblemDetail(WebModel):
    """Why something was not done (RFC 9457), in words for people."""

    type: str = "about:blank"
    title: str
    status: int
    detail: str
    """What is wrong, in plain words."""
    remedy: str = ""
    """What to do about it."""
    path: str = ""
    """Which field of the request, if it is one."""


class SessionPost(WebModel):
    """Sign in."""

    secret: Secret = ""
    """Password or pairing code; empty where none is asked for."""
    name: Annotated[str, StringConstraints(max_length=60, strip_whitespace=True)] = ""
    """Of the account; where there are none, how the person wants to be called."""


class SessionInfo(WebModel):
    """Who is signed in."""

    required: bool
    """Whether one has to sign in here."""
    authenticated: bool
    """Whether this visitor is let in."""
    way: Way
    """How one comes in: `account` (name and password, or a passkey), `password`, `code`, or `open`."""
    name: str = ""
    role: Role | Literal[""] = ""
    may: tuple[str, ...] = ()
    """Effects that this visitor is allowed, e.g. `speak`."""
    passkeys: bool = False
    """Whether browsers have passkeys at this address."""


class PasskeyQuestion(WebModel):
    """What the browser is to be asked."""

    id: str
    """To be sent back with the answer."""
    options: dict[str, Any]
    """As `PublicKeyCredential.parseCreationOptionsFromJSON` and its kin take them."""


class CredentialPost(WebModel):
    """What the browser answered."""

    id: Annotated[str, StringConstraints(max_length=100)]
    credential: dict[str, Any]
    """`PublicKeyCredential.toJSON()`."""


class PasskeyPost(CredentialPost):
    """A new passkey."""

    name: Annotated[str, StringConstraints(min_length=1, max_length=60, strip_whitespace=True)]
    """How to tell it from others."""


class DeviceInfo(WebModel):
    """A browser in which somebody is signed in."""

    id: str
    name: str
    role: Role
    paired: bool
    """Let in by a code, without an account."""
    kind: Literal["phone", "tablet", "computer", "program"]
    browser: str = ""
    address: str = ""
    here: bool = False
    """It is the one that asks."""
    created_unix_ms: int = 0
    seen_unix_ms: int = 0


class MyPasskey(WebModel):
    """A passkey of one's own."""

    id: str
    name: str
    created_unix_ms: int = 0
    seen_unix_ms: int = 0
    """0: not used yet."""


class MyAccount(WebModel):
    """What there is of oneself."""

    account: bool
    """Whether one has an account."""
    devices: tuple[DeviceInfo, ...] = ()
    passkeys: tuple[MyPasskey, ...] = ()


class MyPassword(WebModel):
    """Change one's own password."""

    old: Secret
    new: Secret


class PersonInfo(WebModel):
    """Somebody with an account."""

    name: str
    role: Role
    disabled: bool
    created_unix_ms: int
    seen_unix_ms: int
    """When they signed in last; 0: not yet."""
    passkeys: int = 0


class PeopleInfo(WebModel):
    """Everybody who may come in."""

    people: tuple[PersonInfo, ...] = ()
    devices: tuple[DeviceInfo, ...] = ()


class PersonPost(WebModel):
    """Make an account."""

    name: Annotated[str, StringConstraints(min_length=1, max_length=60, strip_whitespace=True)]
    role: Role = "operator"
    """The first account is a supervisor's whatever is said here."""
    password: Secret


class PersonPut(WebModel):
    """Change one thing of an account."""

    role: Role | None = None
    password: Secret | None = None
    disabled: bool | None = None

    @model_validator(mode="after")
    def _changes_one(self) -> Self:
        if sum(each is not None for each in (self.role, self.password, self.disabled)) != 1:
            raise ValueError("say one of role, password, disabled")
        return self


class CodePost(WebModel):
    """Make a pairing code."""

    role: Role = "operator"


class CodeInfo(WebModel):
    """A pairing code, for one device and one hour."""

    code: str
    role: Role


class ImageUpload(WebModel):
    """A picture that goes with a message."""

    name: Annotated[str, StringConstraints(max_length=200)] = ""
    data: Annotated[str, StringConstraints(min_length=1, max_length=MAX_IMAGE_CHARS)]
    """Base64 of a JPEG or PNG."""


class ChatPost(WebModel):
    """Say something to robots."""

    id: Key
    """Chosen by the page; the same message sent again under the same id does nothing more."""
    text: Annotated[str, StringConstraints(max_length=10_000)] = ""
    """May be empty where a picture says it all."""
    targets: Annotated[tuple[Name, ...], Field(min_length=1, max_length=100)]
    reply_to: Annotated[str, StringConstraints(max_length=200)] = ""
    """Key of the question that is answered, if a certain one is meant."""
    images: Annotated[tuple[ImageUpload, ...], Field(max_length=4)] = ()
    unattended: Unattended | None = None
    """What the robots do with it when nobody is connected for a while; null: as they do otherwise."""

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if not self.text.strip() and not self.images:
            raise ValueError("there are neither words nor a picture")
        return self


class FavouritePut(WebModel):
    """Keep an order under a name."""

    words: Annotated[str, StringConstraints(min_length=1, max_length=2000, strip_whitespace=True)]
    """Its parts, one a line."""
    was: Annotated[str, StringConstraints(max_length=60, strip_whitespace=True)] = ""
    """The name it had so far; empty: it is new."""


class PushKey(WebModel):
    """What a browser needs to be called."""

    key: str
    """The server's public key."""


class LanguagePut(WebModel):
    """Let a model that was offered understand people."""

    language: Annotated[str, StringConstraints(max_length=200, strip_whitespace=True)]
    """As it was offered, with the model's name where that was left open; empty: what was there first."""


class PushPut(WebModel):
    """Where a browser is called, as it says itself."""

    endpoint: Annotated[str, StringConstraints(min_length=1, max_length=1000)]
    p256dh: Annotated[str, StringConstraints(min_length=1, max_length=200)]
    auth: Annotated[str, StringConstraints(min_length=1, max_length=100)]


class ChatPage(WebModel):
    """A piece of the conversation."""

    entries: tuple[ChatEntry, ...]
    """Oldest first."""
    complete: bool
    """Whether nothing older is left."""


class RuleTryPost(WebModel):
    """A plan to be judged, not driven: steps, then a point, then places in words."""

    robot: Name
    steps: Annotated[tuple[ActionCall, ...], Field(max_length=200)] = ()
    after: Annotated[tuple[ActionCall, ...], Field(max_length=200)] = ()
    """What the robot does before that."""
    goal: tuple[float, float] | None = None
    """x, y on the map, metres."""
    words: Annotated[tuple[Annotated[str, StringConstraints(max_length=300)], ...], Field(max_length=20)] = ()
    language: SpokenLanguage = "en"


class PlacePost(WebModel):
    """One room or thing of a map: as it was shown, and as it is to be."""

    was: MapRoom | MapThing | None = None
    """None: it is new."""
    put: MapRoom | MapThing | None = None
    """None: it is taken off the map."""
    anyway: bool = False
    """Whether it may have the name of another one."""
    only_try: bool = False
    """Tell what would come of it, and change nothing."""
    language: SpokenLanguage = "en"


class StopPost(WebModel):
    """Emergency stop, or its reset."""

    command: Literal["stop", "reset"] = "stop"
    targets: Annotated[tuple[Name, ...], Field(max_length=100)] = ()
    """Empty: all robots."""
    id: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_.-]{0,64}$")] = ""


RobotStop = Literal["sent", "stands", "moves", "silent"]
"""`sent`: nothing is known yet; `stands`: its measured velocity is zero; `moves`: it knows of the stop and
does not stand (yet); `silent`: it does not answer."""


class StopAnswer(WebModel):
    """What became of an emergency stop."""

    ok: Literal[True] = True
    id: str
    robots: dict[str, RobotStop]
    """Of each robot that was meant."""
    kept: bool = True
    """Whether it is in force after a kill of the process, too, as far as the server knows."""


class PlanCommandPost(WebModel):
    """Control the plan of a robot."""

    command: Literal["pause", "resume", "skip", "clear", "pop"]
    index: Annotated[int, Field(ge=0, le=10_000)] | None = None
    """For `pop`: which pending step, from 0."""
    step: Annotated[str, Field(max_length=200)] = ""
    """For `skip`: the step that was shown; none if that is over by then. Empty: whichever runs."""


class MissionCommandPost(WebModel):
    """Control what several robots do together, or one robot's part of it."""

    command: Literal["pause", "resume", "clear", "approve", "reject"]
    robot: Annotated[str, Field(max_length=100)] = ""
    """Whose part; empty: all parts."""
    shown: Annotated[dict[str, str], Field(max_length=100)] = Field(default_factory=dict)
    """For `approve`: by key of each proposal its digest, as it was shown."""


class DecisionPost(WebModel):
    """Decide about a proposal."""

    id: Annotated[str, StringConstraints(min_length=1, max_length=100)]
    """Key of the proposal."""
    decision: Literal["approve", "reject", "edit"]
    steps: Annotated[tuple[ActionCall, ...], Field(max_length=200)] = ()
    """For `edit`: the steps to run instead, in Chat Action form."""
    digest: Annotated[str, StringConstraints(max_length=200)] = ""
    """For `approve`: `ProposalView.digest` as it was shown."""


class PolicyPut(WebModel):
    """Whether new steps of a robot wait for a yes."""

    policy: Policy


class StepsPut(WebModel):
    """Replace all steps of the plan in progress that have not begun."""

    steps: Annotated[tuple[ActionCall, ...], Field(max_length=200)]
    revision: Annotated[int, Field(ge=0)]
    """`PlanView.revision` that the edit was made from."""
    undoes: Annotated[tuple[str, ...], Field(max_length=200)] = ()
    """`StepView.planned` of steps that are over, or being done, and are among `steps` anew."""


class RobotPost(WebModel):
    """Add a robot by name."""

    name: Name


class MemoryPut(WebModel):
    """What is to be remembered."""

    type: Literal["text", "image"] = "text"
    data: Annotated[str, StringConstraints(min_length=1, max_length=MAX_IMAGE_CHARS)]
    """The text, or the picture as base64 of a JPEG or PNG."""
    info: Annotated[str, StringConstraints(max_length=1000)] = ""
    scope: Annotated[str, StringConstraints(max_length=100)] = ""
    again: bool = False
    """Bring back what was forgotten last under this name: unchanged, it keeps where it came from."""


class FeedKey(WebModel):
    """Names a feed, for the live event `watch`."""

    robot: Name
    name: Name


class FrameMeta(WebModel):
    """Goes before the bytes of a picture in the live event `frame`."""

    robot: str
    name: str
    unix_ms: int
    """When it was taken."""
    number: int
    """Counts the pictures of the feed; gaps are pictures that were left out."""
    type: Literal["image/jpeg"] = "image/jpeg"
    """Media type."""
