"""What the page sees: one model for REST and for the live stream (snapshot, then changes).

Every entity has a key, and a change carries the whole entity: applying a change twice does no harm, and the
newest wins. `/openapi.json` is made of these types, and the page's own types are made of that.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from parley.gate.risk import risk_of
from parley.messages.attendance import Unattended
from parley.messages.audit import AuditChain
from parley.messages.incident import Incident
from parley.messages.map import MapView
from parley.messages.plain import LineText, ShownText
from parley.messages.principal import Principal
from parley.messages.rules import RiskClass, Rule
from parley.messages.status import ActionInfo, PoseInfo, Trouble
from parley.messages.team import MissionInfo

__all__ = [
    "AbilityView",
    "Change",
    "ChatEntry",
    "Favourite",
    "FeedInfo",
    "Handover",
    "HistoryPage",
    "MemoryItem",
    "ModelOffer",
    "ParameterView",
    "PlanView",
    "ProposalView",
    "RobotView",
    "RoundState",
    "RoundView",
    "RulesChange",
    "ServerInfo",
    "Snapshot",
    "StepView",
    "StopView",
]

Policy = Literal["run_at_once", "ask_when_risky", "ask_first"]


class WebModel(BaseModel):
    """Base of everything below: closed, so that page and server cannot drift apart unseen."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class StopView(WebModel):
    """How far an emergency stop of one robot has come."""

    state: Literal["none", "sent", "received", "at_rest", "moves", "silent"] = "none"
    """`sent`: published; `received`: the engine told; `at_rest`: its measured velocity is zero. After the
    deadline `moves`: it knows and does not stand; `silent`: it does not answer. Latched in every state but
    `none`."""
    id: str = ""
    sent_unix_ms: int = 0
    at_rest_unix_ms: int = 0
    release: Literal["none", "sent", "lost"] = "none"
    """`sent`: a person released it, and it has not said that it heard; it is told again once it is heard.
    `lost`: it did not hear that in time, and stays stopped until somebody releases it anew."""


class AbilityView(ActionInfo):
    """One action that a robot can do."""

    kind: RiskClass = RiskClass.UNKNOWN
    """By what it does to the world."""

    @staticmethod
    def of(info: ActionInfo) -> AbilityView:
        """What the robot says of it, and its kind."""
        return AbilityView.model_construct(**dict(info), kind=risk_of(info))


class RobotView(WebModel):
    """One robot. Key: `name`."""

    name: str
    state: Literal["idle", "running", "paused", "stopped", "leaving", "unknown"] = "unknown"
    connection: Literal["here", "lost", "left", "never_seen"] = "never_seen"
    """`lost`: no heartbeat; `left`: it said goodbye; `never_seen`: added by name only."""
    last_seen_unix_ms: int = 0
    pose: PoseInfo | None = None
    at_rest: bool | None = None
    battery: float | None = None
    """0 to 1; None: not known."""
    trouble: Trouble = ""
    map_name: str = ""
    policy: Policy = "run_at_once"
    stop: StopView = StopView()
    graphs: dict[str, str] = Field(default_factory=dict)
    """Graph name -> graph state."""
    catalogue: tuple[AbilityView, ...] = ()


class ChatEntry(WebModel):
    """One thing said. Key: `id`."""

    id: str
    seq: int = 0
    """Order in the conversation; grows, never reused."""
    unix_ms: int
    who: Literal["operator", "robot"]
    author: LineText = ""
    """The person's name, if it is known."""
    device: LineText = ""
    """Through what a person said it, e.g. ``page on a phone``."""
    targets: tuple[str, ...] = ()
    """To whom (operator) or from whom (robot)."""
    type: Literal["request", "response", "info", "error"]
    message: ShownText
    images: tuple[str, ...] = ()
    """Addresses of attached pictures, below this server."""
    choices: tuple[str, ...] = ()
    shown_choices: tuple[str, ...] = ()
    """The same as the reader is shown them; empty: as they are. What is answered is the choice itself."""
    rules: tuple[Rule, ...] = ()
    """What a yes would make rules, to be drawn on the map before it."""
    sources: tuple[str, ...] = ()
    """Names of the memories it is founded on."""
    engine: str = ""
    """Which language engine worded it, where there are several."""
    question: Literal["", "open", "answered", "closed", "interrupted"] = ""
    """Of what a robot asks, in a reply too: whether it awaits an answer; `interrupted`: who asked ended."""
    answer_id: str = ""
    """Key of the message that answered it."""
    asks_yes: bool = False
    """Whether a robot asks for a yes to what it proposes: as long as that waits."""
    reply_to: str = ""
    """Key of the question or message that this one answers."""
    draft: bool = False
    """Still being written; it is replaced by the finished one under the same key."""


class ParameterView(WebModel):
    """One parameter of a step, flat."""

    name: str
    type: str = ""
    value: Any = None
    """JSON value; null if it has none yet."""


class StepView(WebModel):
    """One step of a plan or graph. Key within its plan: `id`."""

    id: str
    planned: str = ""
    """What the planner calls it, also before it has begun; empty: it is in no plan."""
    action: str
    """Name of the action."""
    label: str
    """For people: what it does, in words that our code wrote."""
    reason: str = ""
    """Why it is there, in the words of whoever planned it."""
    state: Literal[
        "queued", "running", "finished", "failed", "stopped", "skipped", "paused", "stopping", "waiting"
    ]
    """`waiting`: for the operator's answer."""
    inputs: tuple[ParameterView, ...] = ()
    outputs: tuple[ParameterView, ...] = ()
    progress: float | None = None
    progress_text: str = ""
    message: str = ""
    """Why it failed, in plain words."""
    risk: RiskClass = RiskClass.UNKNOWN
    """What kind of step it is, by what it does to the world."""
    only_finds: bool = False
    """Whether it only finds out where something is; people see that as a part of the step behind it."""
    call: dict[str, Any] = Field(default_factory=dict)
    """The step in Chat Action form, for edits."""
    started_unix_ms: int = 0
    ended_unix_ms: int = 0
    worked_ms: int = 0
    """For how long it has worked, until `working_since_unix_ms` if it works; standing does not count."""
    working_since_unix_ms: int = 0
    """Since when it works; 0: it does not."""
    ends_unix_ms: int = 0
    """About when it is done if it goes on like that; 0: nobody knows."""


class PlanView(WebModel):
    """One plan or other graph of a robot. Key: `robot` and `graph_name` (empty while a plan has no graph)."""

    robot: str
    graph_name: str = ""
    kind: Literal["plan", "graph"] = "plan"
    """`plan`: from conversation, can be edited; `graph`: started otherwise, only watched."""
    state: Literal["idle", "awaiting_approval", "running", "paused", "held", "ended"] = "idle"
    revision: int = 0
    steps: tuple[StepView, ...] = ()
    changed: tuple[str, ...] = ()
    """Ids of the steps that the newest change of a running plan added or altered."""
    held_by: Principal | None = None
    """Who told the robot to stand still."""


class ProposalView(WebModel):
    """Steps that wait for a yes. Key: `id`."""

    id: str
    robot: str
    message: str = ""
    """What whoever proposes it says about it."""
    changes: tuple[str, ...] = ()
    """What a yes changes before the steps begin, in words that our code wrote."""
    steps: tuple[StepView, ...] = ()
    """Their `label`s are written by our code, not by whoever proposes."""
    digest: str = ""
    """Of what is shown; a yes names it."""
    by: Principal | None = None
    """On whose account it is proposed."""
    why: str = ""
    """Why a yes is needed though the policy would not ask; empty: the policy asks."""


class FeedInfo(WebModel):
    """One picture feed. Key: `robot` and `name`."""

    robot: str
    name: str
    continuous: bool = False
    """A camera or map, rather than single pictures."""
    width: int = 0
    height: int = 0
    last_unix_ms: int = 0
    """When its last picture came; 0 if none did yet."""


class MemoryItem(WebModel):
    """One memory. Key: `name` and `scope`."""

    name: str
    scope: str = ""
    type: Literal["text", "image"] = "text"
    data: str
    """The text; for a picture its address below this server."""
    info: str = ""
    told: str = ""
    """The text, or what is on the picture, as the reader is told it."""
    source: str = ""
    way: Literal["told", "seen", "concluded", ""] = ""
    """How it is known; `concluded` by a language engine, which nobody said."""
    words: str = ""
    """The person's own words that it was taken from."""
    created_unix_ms: int = 0
    updated_unix_ms: int = 0
    used_unix_ms: int = 0
    used_count: int = 0


class ServerInfo(WebModel):
    """What the page should know about the system behind it."""

    version: str
    language: str
    """The language engine in words for people."""
    offline_language: bool
    """Whether it works without a model, which the page says plainly."""
    can_choose_language: bool = False
    """Whether another one can be put in its place while the system runs."""
    is_language_chosen: bool = False
    """Whether that was done, and can be undone."""
    modules: dict[str, bool] = Field(default_factory=dict)
    """chat, plan, display, map, memory, robots, incidents, log: what is switched on."""
    examples: tuple[str, ...] = ()
    """Sentences to begin with."""
    shown_examples: tuple[str, ...] = ()
    """The same as the reader is shown them; empty: as they are. What is said is the sentence itself."""
    tour: tuple[str, ...] = ()
    """What is said in a story that can be played on the page, one after the other."""
    addresses: tuple[str, ...] = ()
    """Where else this page can be opened, e.g. from a phone in the same network."""
    unattended: Unattended = "go_on"
    """What robots do when nobody is connected for `unattended_after_s`, unless an order says otherwise."""
    unattended_after_s: float = 30.0
    stop_words: str = ""
    """An expression for the words that stop robots: the page sends them until they get through."""


class ModelOffer(WebModel):
    """A language model that could understand people here, and is not used."""

    language: str
    """What `--language` would be; up to the colon: which of its models is for people to choose."""
    found: str
    """Where it was found: a program, or the name of a variable with a key."""


class Favourite(WebModel):
    """An order that is kept under a name. Key: `name`, whatever its capitals."""

    name: str
    words: str
    """Its parts, one a line."""


class Snapshot(WebModel):
    """Everything as it stands."""

    run: str
    """Which log `seq` counts in; another one means: begin anew."""
    seq: int
    """Number of the newest change that is contained."""
    info: ServerInfo
    robots: tuple[RobotView, ...] = ()
    chat: tuple[ChatEntry, ...] = ()
    """The newest ones, oldest first; older ones by `GET /api/chat`."""
    chat_complete: bool = True
    """Whether `chat` holds the beginning of the conversation."""
    plans: tuple[PlanView, ...] = ()
    proposals: tuple[ProposalView, ...] = ()
    feeds: tuple[FeedInfo, ...] = ()
    incidents: tuple[Incident, ...] = ()
    views: tuple[MapView, ...] = ()
    favourites: tuple[Favourite, ...] = ()
    missions: tuple[MissionInfo, ...] = ()
    """Orders to several robots, oldest first."""


class LogLine(WebModel):
    """One entry of the log of who did what."""

    number: int
    unix_ms: int
    effect: str
    outcome: str
    robot: str = ""
    text: str
    """What happened, in one sentence."""
    words: str = ""
    """For an order: what the person said."""


class LogPage(WebModel):
    """Some of the log, newest first."""

    lines: tuple[LogLine, ...] = ()
    complete: bool = True
    """Whether nothing older fits."""
    chain: AuditChain | None = None
    """What checking found, if it was asked for."""
    problem: str = ""
    """Why some of it is not written yet."""


RoundState = Literal["running", "done", "partly", "failed", "ended", "unrecorded"]


class RoundView(WebModel):
    """One thing that a robot was told to do, and how it ended. Key: `number`."""

    number: int
    """Of the entry of the log with which it began."""
    robot: str
    words: str = ""
    """What was said; empty: it was not said but pressed or sent."""
    by: str = ""
    approved_by: str = ""
    unix_ms: int
    ended_unix_ms: int = 0
    """0: it goes on, or its end was never heard."""
    worked_ms: int | None = None
    """How long the robot worked at it until its end: while it stood, or waited for an answer or a yes, does
    not count. None: that is not known."""
    state: RoundState
    """`partly`: done but for `left`; `ended`: before it was done; `unrecorded`: the log has no end of it,
    and it does not go on."""
    steps: tuple[str, ...] = ()
    left: tuple[str, ...] = ()
    """Those of them that were left out."""
    reason: str = ""
    """Why it failed."""
    found: tuple[str, ...] = ()
    """What it came upon that needed a person, in the words in which it was told."""
    pictures: tuple[str, ...] = ()
    """Addresses of what the robot took pictures of meanwhile, below this server."""


class HistoryPage(WebModel):
    """Some of what robots did, newest first."""

    rounds: tuple[RoundView, ...] = ()
    complete: bool = True
    """Whether nothing older fits."""


class Handover(WebModel):
    """What the next shift has to know; written by our code from the log and from what stands now."""

    since_unix_ms: int
    until_unix_ms: int
    rounds: tuple[RoundView, ...] = ()
    """Oldest first."""
    complete: bool = True
    """Whether all of them are here."""
    waits: tuple[str, ...] = ()
    """What stands still until a person does something, now."""
    stops: tuple[tuple[int, str], ...] = ()
    """When and what."""
    rules: tuple[tuple[int, str], ...] = ()


class RobotChange(WebModel):
    """A robot appeared or changed."""

    kind: Literal["robot"] = "robot"
    seq: int
    robot: RobotView


class RobotGone(WebModel):
    """A robot was taken off the list."""

    kind: Literal["robot_gone"] = "robot_gone"
    seq: int
    name: str


class ChatChange(WebModel):
    """Something was said, or changed (a question was answered, a draft grew)."""

    kind: Literal["chat"] = "chat"
    seq: int
    entry: ChatEntry


class PlanChange(WebModel):
    """A plan or graph changed."""

    kind: Literal["plan"] = "plan"
    seq: int
    plan: PlanView


class PlanGone(WebModel):
    """A plan or graph is no longer listed."""

    kind: Literal["plan_gone"] = "plan_gone"
    seq: int
    robot: str
    graph_name: str


class ProposalChange(WebModel):
    """Steps wait for a yes."""

    kind: Literal["proposal"] = "proposal"
    seq: int
    proposal: ProposalView


class ProposalGone(WebModel):
    """A proposal is decided."""

    kind: Literal["proposal_gone"] = "proposal_gone"
    seq: int
    id: str


class FeedChange(WebModel):
    """A feed appeared or changed its size; not sent for every picture."""

    kind: Literal["feed"] = "feed"
    seq: int
    feed: FeedInfo


class MemoryChange(WebModel):
    """Memories changed: ask again."""

    kind: Literal["memory"] = "memory"
    seq: int
    event: Literal["added", "removed", "failed"]
    name: str
    message: str = ""


class FavouritesChange(WebModel):
    """The favourites are these now."""

    kind: Literal["favourites"] = "favourites"
    seq: int
    favourites: tuple[Favourite, ...]


class InfoChange(WebModel):
    """Something else understands people now."""

    kind: Literal["info"] = "info"
    seq: int
    info: ServerInfo


class MissionsChange(WebModel):
    """The orders to several robots are these now."""

    kind: Literal["missions"] = "missions"
    seq: int
    missions: tuple[MissionInfo, ...]


class RulesChange(WebModel):
    """A rule holds or was dropped: ask again."""

    kind: Literal["rules"] = "rules"
    seq: int


class IncidentChange(WebModel):
    """A failure happened, or its record changed."""

    kind: Literal["incident"] = "incident"
    seq: int
    incident: Incident


class RejectionChange(WebModel):
    """Something was refused, in plain words."""

    kind: Literal["rejection"] = "rejection"
    seq: int
    robot: str = ""
    message: str


Change = Annotated[
    RobotChange
    | RobotGone
    | ChatChange
    | PlanChange
    | PlanGone
    | ProposalChange
    | ProposalGone
    | FeedChange
    | MemoryChange
    | FavouritesChange
    | InfoChange
    | MissionsChange
    | RulesChange
    | IncidentChange
    | RejectionChange,
    Field(discriminator="kind"),
]
"""One entry of the live stream. `MapView`s travel beside it, unnumbered: the newest wins."""
