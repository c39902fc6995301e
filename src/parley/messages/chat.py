"""Conversation payloads: what people say, what Parley answers, and what follows from it (Chat Action).

Thesis 4.3.5 and design section 2. Keys are the thesis's; `reason`, `flow`, `sources`, `choices`, `id` and
`reply_to` are ours and ignored by other programs.
"""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, field_validator, model_serializer, model_validator

from parley.messages.attendance import Unattended
from parley.messages.base import ParameterTree, Payload
from parley.messages.plain import LineText, ShownText
from parley.messages.principal import Principal
from parley.messages.rules import Rule

__all__ = [
    "SYSTEM_COMMANDS",
    "ActionCall",
    "Aside",
    "ChatAction",
    "ChatFeedback",
    "ChatImage",
    "ChatInput",
    "CommandName",
    "Flow",
    "FlowIf",
    "Outcome",
    "Press",
    "PressTaken",
    "ReplyDraft",
    "SystemCommand",
]

CommandName = Literal["stop", "pause", "start", "clear", "pop", "skip", "add_memory", "remove_memory"]
"""The closed table of system commands; `pause` is an alias of `stop`."""

SYSTEM_COMMANDS: tuple[CommandName, ...] = (
    "stop", "pause", "start", "clear", "pop", "skip", "add_memory", "remove_memory",
)  # fmt: skip


class ChatImage(Payload):
    """A picture that goes with a message."""

    name: str = ""
    """File name, for people."""
    data: str
    """Base64 of a JPEG or PNG."""


class ChatInput(Payload):
    """`chat_interface_input`: what an operator wrote."""

    message: str
    targets: tuple[str, ...] = ()
    """Robots it is meant for."""
    type: Literal["request", "response"] = "request"
    """`response` answers a question that a robot asked."""
    id: str = ""
    """Ours: chosen by the sender, to recognise a message sent twice."""
    reply_to: str = ""
    """Ours: `id` of the question that is answered."""
    author: str = ""
    """Ours: who writes, where several people operate."""
    images: tuple[ChatImage, ...] = ()
    """Ours: pictures attached to the message."""
    by: Principal | None = None
    """Ours: who says it. None: a person whose name is `author`, as the thesis's page sends it."""
    unattended: Unattended | None = None
    """Ours: what the robots do with this when nobody is connected for a while; None: as they do otherwise."""

    @property
    def who(self) -> Principal:
        """Who says it."""
        return self.by or Principal(kind="person", name=self.author, role="operator")


class ChatFeedback(Payload):
    """`chat_interface_feedback`: what an operator is told or asked."""

    message: ShownText
    targets: tuple[str, ...] = ()
    """Robots it comes from."""
    type: Literal["response", "request", "info", "error"] = "response"
    """`request` asks and awaits an answer."""
    sources: tuple[str, ...] = ()
    """Ours: names of the memories that were used."""
    choices: tuple[LineText, ...] = ()
    """Ours: answers that can be tapped."""
    id: str = ""
    """Ours: identifies a question."""
    closes: str = ""
    """Ours: `id` of a question that is settled and awaits no answer any more."""
    reply_to: str = ""
    """Ours: `id` of the operator's message that is answered."""
    engine: LineText = ""
    """Ours: which language engine worded it, where there are several; empty: ourselves, or the only one."""
    rules: tuple[Rule, ...] = ()
    """Ours: what a yes would make rules, each for one of the choices; whoever has a map draws them."""
    by_step: bool = False
    """Ours: an action that is carried out tells it."""
    images: tuple[ChatImage, ...] = ()
    """Ours: what it speaks of, as the robot saw it."""
    asks: bool = False
    """Ours, of a `response`: an order lacks something, and whatever is said next may tell it."""
    still_asks: str = ""
    """Ours: `id` of an earlier message whose reply asked for more and may be answered yet."""
    asks_yes: bool = False
    """Ours: it ends by asking for a yes to what is proposed; the words are only for people."""

    @property
    def asks_back(self) -> bool:
        """Whether a reply asks for more: what is said next answers it, though it is no `response`."""
        return self.type == "response" and (self.asks or bool(self.choices))


class ReplyDraft(Payload):
    """`/parley/reply_draft`: a reply that is still being written, as far as it is; sent whole each time.

    The `chat_interface_feedback` with the same `reply_to` takes its place.
    """

    reply_to: str
    """`id` of the operator's message that is answered."""
    targets: tuple[str, ...] = ()
    message: ShownText = ""


class Aside(Payload):
    """`/parley/aside`: a person's answer was none, and is to be taken as a message of its own.

    It says nothing in anybody's name: what counts is what the chat interface heard from the person.
    """

    actor: str
    """The robot that had asked."""
    reply_to: str
    """`id` of its question."""
    id: str = ""
    """Of the answer; empty: it had none."""
    message: str
    """The answer, to know one without an id by."""

    @property
    def request_id(self) -> str:
        """`id` of the message that becomes of it."""
        return f"{self.id or self.reply_to}~aside"


class ChatRead(Payload):
    """`/parley/chat_read`: an operator's message got to who reads them; what did not is sent again."""

    id: str = ""
    """Of the message; empty: whoever reads them is there."""


class Press(Payload):
    """Which press of a button a command or decision is: done once, and not after what was pressed later."""

    page: str
    """The page's server: one run of it."""
    number: int
    """Counts the presses there."""
    to: str
    """`PressTaken.run` of whoever told what was on the page then."""

    @property
    def id(self) -> str:
        """Names this press."""
        return f"{self.page}.{self.number}"


Outcome = Literal["done", "refused", "past"]
"""`past`: what it was for is another by now."""


class PressTaken(Payload):
    """`/parley/press_taken`: the press of a button got to the planner; what did not is sent again."""

    run: str
    """Of the planner, from its start to its end."""
    id: str = ""
    """Of the press; empty: the planner has come."""
    outcome: Literal["", Outcome] = ""
    """What came of it, told once more where it takes a while to say: of changed steps."""
    why: str = ""
    """Why it was refused, in plain words."""


class FlowIf(Payload):
    """Run only if an earlier step ended with this result."""

    step: int
    """0-based index of a step of the same queue."""
    result: bool = True


class Flow(Payload):
    """Ours: how a queue item runs beyond "after the one before"."""

    if_: FlowIf | None = Field(default=None, alias="if")
    together_with: int | None = None
    repeat: int | None = Field(default=None, ge=1, le=1000)


class ActionCall(Payload):
    """One action of a queue. In JSON ``{"<name>": {"input_parameters": .., "output_parameters": ..}}``."""

    name: str = Field(min_length=1)
    input_parameters: ParameterTree = Field(default_factory=dict)
    output_parameters: ParameterTree = Field(default_factory=dict)
    reason: LineText = ""
    """Ours: why this step, in the language engine's words."""
    flow: Flow | None = None

    @model_serializer
    def _write(self) -> dict[str, Any]:
        from parley.messages.pvf import write_parameters

        body: dict[str, Any] = {
            "input_parameters": write_parameters(self.input_parameters),
            "output_parameters": write_parameters(self.output_parameters),
        }
        if self.reason:
            body["reason"] = self.reason
        if self.flow is not None:
            body["flow"] = self.flow.model_dump(by_alias=True, exclude_none=True)
        return {self.name: body}

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: Any) -> Any:
        if not isinstance(value, dict) or "name" in value:
            return value
        if len(value) != 1:
            raise ValueError(f"expected one action name with its parameters, got {len(value)} keys")
        name, body = next(iter(value.items()))
        if body is None:
            body = {}
        if not isinstance(body, dict):
            raise ValueError(f"{name}: expected an object with input_parameters and output_parameters")
        return {**body, "name": name}


class SystemCommand(Payload):
    """One system command. In JSON ``{"<command>": {..arguments..}}``."""

    command: CommandName
    arguments: dict[str, Any] = Field(default_factory=dict)

    @model_serializer
    def _write(self) -> dict[str, Any]:
        return {self.command: self.arguments}

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: Any) -> Any:
        if isinstance(value, str):
            return {"command": value}
        if not isinstance(value, dict) or "command" in value:
            return value
        if len(value) != 1:
            raise ValueError(f"expected one command with its arguments, got {len(value)} keys")
        command, arguments = next(iter(value.items()))
        if command not in SYSTEM_COMMANDS:
            raise ValueError(f"unknown command {command!r}; known are {', '.join(SYSTEM_COMMANDS)}")
        if not isinstance(arguments, dict):
            arguments = {} if arguments is None else {"parameters": arguments}
        return {"command": command, "arguments": arguments}

    @property
    def pop_index(self) -> int | None:
        """The 0-based index of a `pop` (number or numeric text), or None if it has none."""
        raw = self.arguments.get("parameters", self.arguments.get("index"))
        if isinstance(raw, bool):
            return None
        if isinstance(raw, float) and raw.is_integer():
            return int(raw)
        if isinstance(raw, int):
            return raw
        text = raw.strip() if isinstance(raw, str) else ""
        return int(text) if text.isdecimal() and len(text) < 10 else None


class LeftOpen(Payload):
    """What a reply leaves open for the next messages, so that nobody has to read it out of the reply."""

    where: str = ""
    """Whose or what's place was asked for; `you` for who spoke."""
    about: str = ""
    """The order that it was asked about, where that is not the message: nor is an answer to that."""
    waits: bool = False
    """Whether the order is done when somebody tells what it waits for."""
    told: tuple[str, ...] = ()
    """Facts that count as long as the conversation goes on."""


class ChatAction(Payload):
    """`chat_action`, `umrf_correction` and the answer of the language engine to a message or an error."""

    message_response: str = ""
    queue: tuple[ActionCall, ...] = ()
    system_cmd: tuple[SystemCommand, ...] = ()
    targets: tuple[str, ...] = ()
    success: bool | None = None
    """Only for error resolutions: True, the correction is complete; False, `message_response` asks; None, it
    is said aside (an answer to a question, an order kept for afterwards), and what was asked remains open."""
    choices: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    delay_s: float = Field(default=0.0, ge=0.0, le=3600.0)
    """Ours, only for error resolutions: robot time to wait before the correction is carried out."""
    afterwards: tuple[ActionCall, ...] = ()
    """Ours, only for error resolutions: what was ordered besides, for when the rest is done."""
    others: tuple[ChatAction, ...] = ()
    """Ours, only in the answer to a message: what other robots are to do, each with queue and target."""
    engine: str = ""
    """Ours: which language engine answered; empty: the one that was asked."""
    by: Principal | None = None
    """Ours: who wants it; None: a program that nobody vouches for. A model's word is overwritten."""
    behalf: Principal | None = None
    """Ours: the person in answer to whom a language engine wants it."""
    words: str = ""
    """Ours: what that person said."""
    needs_yes: str = ""
    """Ours: why a person has to say yes first whatever the policy, in plain words; empty: the policy says."""
    id: str = ""
    """Ours: whoever gives one hears on `/parley/ruling` what became of it."""
    reply_to: str = ""
    """Ours: `id` of the operator's message that it follows from."""
    offer: tuple[ActionCall, ...] = ()
    """Ours: steps of which a language engine is not certain: they are proposed. `needs_yes` says which words
    it did not understand."""
    called: str = ""
    """Ours, only in the answer to a message: who is called in it, where no robot is called so."""
    replaces: str = ""
    """Ours: the proposal in whose place these steps are proposed."""
    after: tuple[str, ...] = ()
    """Ours: orders, by `id`, whose steps other robots must have done before these begin."""
    alarm: bool = False
    """Ours: a person speaks of danger, so everybody who is connected is told."""
    press: Press | None = None
    """Ours: the button that was pressed, where it is one."""
    left_open: LeftOpen = LeftOpen()
    """Ours, only in the answer to a message: what the next ones may refer to."""

    @model_validator(mode="before")
    @classmethod
    def _read(cls, value: Any) -> Any:
        """Accept `message` for `message_response` and `target` for `targets` (error handler's spelling)."""
        if not isinstance(value, dict):
            return value
        value = dict(value)
        if "message_response" not in value and isinstance(value.get("message"), str):
            value["message_response"] = value["message"]
        if "targets" not in value and isinstance(value.get("target"), str):
            value["targets"] = [value["target"]]
        return value

    @field_validator("queue", "afterwards", "offer", mode="before")
    @classmethod
    def _split_items(cls, value: Any) -> Any:
        """A queue item may hold several actions; each becomes one of its own, in order."""
        if not isinstance(value, list | tuple):
            return value
        split: list[Any] = []
        for item in value:
            if isinstance(item, dict) and "name" not in item and len(item) > 1:
                split.extend({name: body} for name, body in item.items())
            else:
                split.append(item)
        return split

    @field_validator("system_cmd", mode="before")
    @classmethod
    def _split_commands(cls, value: Any) -> Any:
        if isinstance(value, dict):
            return [{name: body} for name, body in value.items()]
        return value

    def to_wire(self) -> dict[str, Any]:
        """The JSON object of the thesis; our extras only where they say something."""
        wire: dict[str, Any] = {
            "message_response": self.message_response,
            "queue": [call.model_dump() for call in self.queue],
            "system_cmd": [command.model_dump() for command in self.system_cmd],
            "targets": list(self.targets),
        }
        if self.success is not None:
            wire["success"] = self.success
        if self.choices:
            wire["choices"] = list(self.choices)
        if self.sources:
            wire["sources"] = list(self.sources)
        if self.delay_s:
            wire["delay_s"] = self.delay_s
        if self.offer:
            wire["offer"] = [call.model_dump() for call in self.offer]
        if self.afterwards:
            wire["afterwards"] = [call.model_dump() for call in self.afterwards]
        if self.after:
            wire["after"] = list(self.after)
        if self.others:
            wire["others"] = [other.to_wire() for other in self.others]
        for name, told in (("by", self.by), ("behalf", self.behalf), ("press", self.press)):
            if told is not None:
                wire[name] = told.model_dump()
        wire |= {
            name: text
            for name in ("engine", "words", "needs_yes", "id", "reply_to", "replaces")
            if (text := getattr(self, name))
        }
        return wire
