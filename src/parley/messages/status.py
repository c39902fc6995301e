"""Our own topics under `/parley/` (design section 2): presence, events, plans, stop, refusals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal

from pydantic import Field, model_validator

from parley.messages.base import ParameterTree, Payload
from parley.messages.chat import ActionCall, Press, SystemCommand
from parley.messages.passages import PassageClaim
from parley.messages.plain import LineText, ShownText
from parley.messages.principal import Principal

__all__ = [
    "NOT_TAKEN",
    "ActionInfo",
    "ActorStatus",
    "GraphEvent",
    "Kind",
    "OrderState",
    "ParameterInfo",
    "PlanDecision",
    "PlanProposal",
    "PlanRuling",
    "PlanStep",
    "PlanUpdate",
    "PoseInfo",
    "Pulse",
    "Rejection",
    "RejectionProblem",
    "StepCommand",
    "StopCommand",
    "StopReport",
    "SyncEntry",
    "SyncNotice",
    "Trouble",
]


class PoseInfo(Payload):
    """A planar pose in the map frame (REP 103: metres, radians)."""

    x: float
    y: float
    yaw: float = 0.0


Kind = Literal[
    "place", "thing", "person", "direction", "distance", "angle", "duration", "number", "text", "choice", "id"
]
"""What an input of an action takes, as people speak of it; `id`: by what programs know something."""


class ParameterInfo(Payload):
    """What is known about one input of an action besides its PVF type."""

    kind: Kind = "thing"
    unit: str = ""
    """Of a number: metres, degrees, seconds or any other word."""
    default: str | float | bool | None = None
    """What counts if nothing is said."""
    choices: tuple[str, ...] = ()
    """What it may be, if that is a closed list."""
    help: str = ""
    """What it means."""


class ActionInfo(Payload):
    """One action of a robot's catalogue, as language and people need it."""

    name: str
    inputs: dict[str, str] = Field(default_factory=dict)
    """Flat parameter name -> PVF type."""
    optional: tuple[str, ...] = ()
    """Inputs that may be left without a value."""
    parameters: dict[str, ParameterInfo] = Field(default_factory=dict)
    """Flat parameter name -> its kind and the like; what is not told is derived (`parley.umrf.kinds`)."""
    outputs: dict[str, str] = Field(default_factory=dict)
    description: str = ""
    label: LineText = ""
    """What people read that it does; ``{parameter}`` stands for a value, ``{place}`` for a pose."""
    phrases: tuple[str, ...] = ()
    """How people ask for it; ``{parameter}`` stands for a value."""
    effects: tuple[str, ...] = ()
    """What holds afterwards, from a small open vocabulary: `moves`, `looks`, `asks_operator`, ..."""
    risk: Literal["none", "low", "high", ""] = ""
    """What was declared before effects told it; only `parley.gate.risk` reads it."""
    capabilities: tuple[str, ...] = ()
    """What the robot must have, e.g. `drive`, `camera`."""
    examples: tuple[str, ...] = ()
    """Whole sentences by which people ask for it."""
    duration_s: float | None = None
    """About how long it takes, in robot time; None if that is not known."""
    timeout_s: float | None = None
    """Robot time after which it is cancelled and fails; None: never."""

    @property
    def only_finds(self) -> bool:
        """Whether it finds out where something is and does nothing else."""
        return set(self.effects) == {"locates"}

    @property
    def for_programs(self) -> bool:
        """Whether it takes what only programs know: nobody asks for it in words."""
        return any(told.kind == "id" for told in self.parameters.values())


OrderState = Literal["open", "failed", "done", "left"]
"""How far an engine is with the steps of one order: `failed`: at one of them, and it stands; `left`: nothing
more comes of it, and not all of it was done."""

Trouble = Literal["", "silent", "pressed", "misset"]
"""What keeps a robot from moving: `silent`: its base does not answer; `pressed`: a button on it; `misset`: it
takes no velocities, as those who listen for them do not agree on their type."""


class ActorStatus(Payload):
    """`/parley/actor_status`: heartbeat of one engine."""

    actor: str
    engine: Literal["parley", "temoto"] = "parley"
    """Whose it is: one of TeMoto tells whole graphs only, and has neither events nor an emergency stop."""
    state: Literal["idle", "running", "paused", "stopped", "leaving"] = "idle"
    """`stopped`: latched by an emergency stop."""
    sequence: int = 0
    """Counts heartbeats of one run of the engine; a smaller number means a restart."""
    pose: PoseInfo | None = None
    at_rest: bool | None = None
    """Whether the measured velocity is zero; None if the robot cannot tell."""
    battery: float | None = Field(default=None, ge=0, le=1)
    """How full it is; None if the robot cannot tell."""
    trouble: Trouble = ""
    graphs: dict[str, str] = Field(default_factory=dict)
    """Graph name -> graph state."""
    orders: dict[str, OrderState] = Field(default_factory=dict)
    """Order `id` -> how far it is, of those newest orders whose steps say which one they carry out."""
    claim: PassageClaim | None = None
    """What it wants of places that only so many robots may be in; None: it knows of none."""
    catalogue: tuple[ActionInfo, ...] = ()
    """Sent with every heartbeat, so that who comes late knows it too."""
    map_name: str = ""
    unix_ms: int = 0
    """What the clock of its machine showed."""
    stop: str = ""
    """Of `stopped`: the id of the emergency stop in force; empty: it was before the engine started."""
    holds: tuple[str, ...] = ()
    """The ids of the holds by which its drive stands still: whoever reads messages ends those it begins."""


class GraphEvent(Payload):
    """`/parley/graph_events`: every transition once, in order."""

    actor: str
    graph_name: str
    sequence: int
    """Per graph, from 0, without gaps."""
    kind: Literal["graph", "node", "progress"]
    state: str = ""
    """Node or graph state after the transition; empty for progress."""
    node: str = ""
    """Full name of the node; empty for graph transitions."""
    instance_id: int = -1
    cause: str = ""
    """What brought it about: `start`, `edge`, `stop`, `pause`, `resume`, `modify`, `run`, `dry`, ..."""
    result: str = ""
    """`on_true`, `on_false`, `on_error`, `on_stopped` when a node ended."""
    outputs: ParameterTree = Field(default_factory=dict)
    message: str = ""
    """Newest log line of a node that failed."""
    progress: float | None = None
    """0 to 1."""
    progress_text: str = ""
    robot_time_s: float = 0.0
    unix_ms: int = 0


class PlanStep(Payload):
    """One step of a plan as people see it."""

    action: ActionCall
    id: str = ""
    """What it is called as long as the plan has it."""
    node: str = ""
    """Full name of its node in the graph; empty before the graph exists."""
    label: LineText = ""
    """What it does, in words that our code wrote from action, arguments and map."""
    state: Literal["queued", "running", "finished", "failed", "stopped", "skipped", "paused", "waiting"] = (
        "queued"
    )
    for_next: bool = False
    """Whether it only finds out what the next one needs: people read the two as one."""
    order: str = ""
    """`id` of the order that it carries out, if that has one."""


class PlanUpdate(Payload):
    """`/parley/plan`, kind `update`: the plan of one robot as the planner sees it, after each change."""

    kind: Literal["update"] = "update"
    target: str
    graph_name: str = ""
    state: Literal["idle", "awaiting_approval", "running", "paused", "held"] = "idle"
    steps: tuple[PlanStep, ...] = ()
    revision: int = 0
    """Counts the changes of this robot's plan; an edit says which one it was made from."""
    policy: Literal["run_at_once", "ask_when_risky", "ask_first"] = "run_at_once"
    """Whether new steps of this robot wait for a person's yes."""
    held_by: Principal | None = None
    """Who told the robot to stand still; None: nobody."""
    waits: tuple[str, ...] | None = None
    """The proposals that wait for a yes, by their ids, oldest first: no other does. None: it is not told."""
    continues: str = ""
    """The graph that an earlier process left, of which this is what was still to be done."""


class PlanProposal(Payload):
    """`/parley/plan`, kind `proposal`: steps that wait for a person's yes."""

    kind: Literal["proposal"] = "proposal"
    id: str
    target: str
    message: ShownText = ""
    """What a language engine says about it; its words, not ours."""
    steps: tuple[ActionCall, ...] = ()
    commands: tuple[SystemCommand, ...] = ()
    """What a yes changes before the steps begin, e.g. a step that is left out."""
    labels: tuple[LineText, ...] = ()
    """What each command and then each step does, in words that our code wrote from action, arguments and map.
    """
    lines: tuple[LineText, ...] = ()
    """What people read of `labels`: a search that is made only for the next step belongs to that step."""
    digest: str = ""
    """Of robot, steps and what their arguments mean on the map; a yes names it."""
    by: Principal | None = None
    """On whose account it is proposed."""
    why: str = ""
    """Why a yes is needed though the policy would not ask, in plain words; empty: the policy asks."""
    words: str = ""
    """What the person said who wants it."""
    order: str = ""
    """`id` of the order it comes from."""
    after: tuple[str, ...] = ()
    """Orders whose steps other robots must have done before these begin."""

    @model_validator(mode="before")
    @classmethod
    def _without_lines(cls, told: Any) -> Any:
        """Where nobody says what people read of it, they read all."""
        if isinstance(told, Mapping) and not told.get("lines"):
            return {**told, "lines": told.get("labels", ())}
        return told


class PlanRuling(Payload):
    """`/parley/ruling`: what the planner did with a Chat Action that has an id, for one robot."""

    order: str
    """`id` of the Chat Action."""
    target: str
    outcome: Literal["done", "asked", "refused"] = "done"
    """`asked`: all of it, or what is left of it, waits for a yes."""
    lines: tuple[str, ...] = ()
    """What would be done, as people read it, in words that our code wrote."""
    why: str = ""
    """Why it is asked or refused, in plain words."""
    rules: tuple[str, ...] = ()
    """The rules that forbid it; also told, with an empty `order`, of what nobody gave an id."""


class PlanDecision(Payload):
    """`/parley/plan_decision`: what a person decided about a proposal, or a change of policy."""

    id: str = ""
    target: str
    decision: Literal["approve", "reject", "edit", "policy"]
    steps: tuple[ActionCall, ...] = ()
    """For `edit`: the steps to run instead of the proposed ones; with an empty `id`, instead of all steps of
    the plan in progress that have not begun."""
    revision: int | None = None
    """For an `edit` of the plan in progress: the `PlanUpdate.revision` it was made from; refused if past."""
    undoes: tuple[str, ...] = ()
    """For an `edit` of the plan in progress: the ids of steps that are over, or being done, and are among
    `steps` anew. What is being done is ended first; none of them is among those that were left out."""
    policy: Literal["run_at_once", "ask_when_risky", "ask_first", ""] = ""
    """For `policy`; `ask_when_risky` asks when a step's risk is `high`."""
    digest: str = ""
    """For `approve`: the `digest` of the proposal as it was shown; a yes to anything else does not count."""
    by: Principal | None = None
    """Who decided; None: a program that nobody vouches for."""
    press: Press | None = None
    """The button that was pressed, where it is one."""


class StepCommand(Payload):
    """`/parley/step`: end one running step of a graph.

    It becomes FINISHED as stopped, and its edges say what follows. UMRF has commands for whole graphs only;
    "skip this" needs one for a node.
    """

    target: str
    graph_name: str
    node: str
    """Full name of the node to end."""
    command: Literal["end"] = "end"


class StopCommand(Payload):
    """`/parley/stop`: emergency stop or its reset, or a short hold; empty `targets` means all."""

    command: Literal["stop", "reset", "hold", "go_on"] = "stop"
    """`hold`: the drive stands still while a message is read, until `go_on` with the same `id` (or a reset);
    it is not latched, and an emergency stop wins over it."""
    targets: tuple[str, ...] = ()
    id: str = ""
    by: Principal | None = None
    """Who stops or releases; a reset counts only from a person."""
    words: str = ""
    """What was said or pressed."""
    stops: tuple[str, ...] = ()
    """Of `reset`: the stops that whoever releases knows of, by id. One that came after them stays in force,
    however late the release arrives. None: whichever is in force."""


class Pulse(Payload):
    """`/parley/pulse`: whoever is at this page or terminal could stop robots; told again and again."""

    server: str
    """Names the page's server or the terminal, for as long as it runs."""
    stops: tuple[StopCommand, ...] = ()
    """Emergency stops that robots have not confirmed: said until they do."""
    leaving: bool = False
    """It ends, in order: nobody stands still for that."""


class StopReport(Payload):
    """`/parley/stop_report`: an engine says what became of a stop command."""

    actor: str
    id: str = ""
    state: Literal["received", "at_rest", "moving", "silent", "reset"]
    """`received`: its drive was told, and that is on disk (or somebody was told that it is not). Then one of
    three: `at_rest`: it stands, measured; `moving`: it does not stand in time (`at_rest` may still follow);
    `silent`: it does not answer. Of whom no report comes in time, nobody knows either: it does not answer.
    `reset`: it may move again."""


NOT_TAKEN: Final = "not_taken"
"""Code of a rejection: asked for the graph that it was sent, an engine does not have it."""


class RejectionProblem(Payload):
    """One reason of a refusal."""

    path: str = ""
    message: str
    remedy: str = ""
    code: str = "invalid"


class Rejection(Payload):
    """`/parley/rejection`: a graph, command or message was refused and nothing was changed."""

    source: str
    """The node or engine that refuses."""
    target: str = ""
    """The robot it concerns, if known."""
    what: str
    """E.g. `umrf_graph_start` or `chat_interface_input`."""
    graph_name: str = ""
    problems: tuple[RejectionProblem, ...] = ()
    detail: dict[str, Any] = Field(default_factory=dict)


class SyncEntry(Payload):
    """One thing that an engine says to the others that carry out a graph with it."""

    kind: Literal["ended", "command", "ask", "answer"]
    """`ended` hands the result of a node over; `command` passes on what the speaker was told to do with the
    graph; `ask` asks whether everybody could change it so, which `answer` says, before anybody does."""
    graph_name: str
    """The graph, or one inside of it."""
    node: str = ""
    """Full name of the node that ended or is to end."""
    result: str = ""
    """`on_true`, `on_false`, `on_error`, `on_stopped`."""
    outputs: ParameterTree = Field(default_factory=dict)
    message: str = ""
    """The failure report of a node that failed; why the answer is no, empty for yes."""
    command: Literal["stop", "pause", "resume", "modify", "end", ""] = ""
    """`end` ends the node."""
    targets: tuple[str, ...] = ()
    """Of a `command`: to whom it was given, so that they do not carry it out twice."""
    graph_json: str = ""
    """Of `modify` and `ask`: the new form of the graph."""
    continue_from: str = ""
    id: str = ""
    """Of `ask` and its `answer`."""


class SyncNotice(Payload):
    """`/parley/sync`: where one engine is in a graph that several carry out together (`spec/umrf.md` 13).

    TeMoto's own format is not public, so this is ours alone.
    """

    actor: str
    """Who speaks."""
    graph_name: str
    run: str
    """The speaker's own id of this run of the graph."""
    heard: dict[str, tuple[str, int]] = Field(default_factory=dict)
    """Other actor -> its id of the run, and how many of its entries were taken."""
    first: int = Field(default=0, ge=0)
    """Number of the first entry in `said`; earlier ones were confirmed by all, or given up."""
    said: tuple[SyncEntry, ...] = ()
    """What not all have confirmed, in the order in which it happened."""
    answer: bool = False
    """Whether everybody is to say how far they are."""
