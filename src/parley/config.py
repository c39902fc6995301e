"""Settings of one running system: typed, checked once, unknown keys refused."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from parley.files import TextFile, read_text, validated_yaml
from parley.messages.attendance import Unattended
from parley.sentences import SpokenLanguage

__all__ = [
    "FOLDER",
    "ApprovalPolicy",
    "CallSettings",
    "EmailSettings",
    "EmbeddingSettings",
    "FeedSettings",
    "ModelPrice",
    "ModelSettings",
    "NetworkSettings",
    "SystemConfig",
    "TlsSettings",
    "UserSettings",
    "language_name",
]  # fmt: skip

ApprovalPolicy = Literal["run_at_once", "ask_when_risky", "ask_first"]
"""Which plans wait for a person's yes: none, those with a step of high risk, all."""

FOLDER = "folder"
"""Where a file of settings lies, for its validators."""


def _beside(path: Path, info: ValidationInfo) -> Path:
    """A path in a file of settings counts from that file's folder."""
    folder = (info.context or {}).get(FOLDER)
    return path if folder is None else folder / path.expanduser()


FilePath = Annotated[Path, AfterValidator(_beside)]


def language_name(name: str) -> str:
    """The name of a language engine, if there may be one called so.

    Raises:
        ValueError: There is none.
    """
    if name in ("offline", "old"):
        raise ValueError(f"the language engine {name!r} is gone; use builtin, which needs no model either")
    if name not in ("auto", "builtin") and not re.fullmatch(r"[A-Za-z0-9_.-]+:.+", name):
        raise ValueError(f"there is no language engine {name!r}; use auto, builtin or provider:model")
    return name


LanguageName = Annotated[str, AfterValidator(language_name)]


class ModelPrice(BaseModel):
    """What a model costs, in US dollars per million tokens."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    input: float = Field(ge=0)
    output: float = Field(ge=0)


class ModelSettings(BaseModel):
    """How language models are asked; the parameters are the thesis's (4.3.3)."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    base_url: str = ""
    """Address of an OpenAI-compatible server, for the first model."""
    key_file: FilePath | None = None
    """File with the first model's key; None: from the environment, as the provider names it."""
    temperature: float | None = Field(default=0.1, ge=0, le=2)
    """None leaves it to the model, as for `top_p`; some models take only one of them."""
    top_p: float | None = Field(default=0.6, gt=0, le=1)
    frequency_penalty: float = 0.0
    presence_penalty: float = 0.0
    reasoning: Literal["off", "minimal", "low", "medium", "high"] | None = None
    """How much a model thinks before it answers; None leaves it to the model."""
    small: str = ""
    """Another model for questions with short answers: `provider:model[@address]`, its key from the
    environment; what it cannot answer goes to the usual one."""
    max_plan_tokens: int = Field(default=2048, ge=64)
    max_memory_tokens: int = Field(default=1024, ge=64)
    output: Literal["tool", "native", "prompted"] = "tool"
    """How answers get their form: a tool call (plain JSON is accepted too), a JSON schema, or by asking."""
    pictures: bool = True
    """Whether the model is shown pictures that operators send or that are remembered."""
    timeout_s: float = Field(default=20.0, gt=0)
    """Time for one answer of one model, with all tries."""
    memory_timeout_s: float = Field(default=4.0, gt=0)
    """The same for picking memories, which comes before every answer."""
    retries: int = Field(default=2, ge=0, le=10)
    """Further tries when a model cannot be reached."""
    backoff_s: float = Field(default=0.5, gt=0)
    """Wait before the second try; doubles with each."""
    corrections: int = Field(default=2, ge=0, le=10)
    """How often an answer that cannot be used goes back to the model, with what is wrong."""
    breaker_failures: int = Field(default=3, ge=1)
    """Failed questions in a row after which a model is left alone."""
    breaker_open_s: float = Field(default=30.0, gt=0)
    """For how long."""
    max_tokens_per_hour: int | None = Field(default=None, ge=1)
    max_usd_per_hour: float | None = Field(default=None, gt=0)
    prices: dict[str, ModelPrice] = Field(default_factory=dict)
    """By model; wins over the price list that comes with the libraries."""
    record_file: FilePath | None = None
    """Every exchange is added to this file (JSON lines), for bug reports and replays."""


class EmbeddingSettings(BaseModel):
    """Where memories get vectors from, so that they are found by what they mean."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    url: str
    """Address of any server with OpenAI's ``POST /embeddings``, up to and without that."""
    model: str
    key_file: FilePath | None = None
    """File with the key; None: from the environment (``PARLEY_EMBEDDINGS_KEY``), or no key."""
    timeout_s: float = Field(default=2.0, gt=0)
    """Wall time an answer may take; then words alone decide."""
    min_alike: float = Field(default=0.2, ge=-1, le=1)
    """Least cosine of what counts as alike; models differ."""


class EmailSettings(BaseModel):
    """By which server an e-mail goes out, and to whom."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    to: tuple[str, ...] = Field(min_length=1)
    sender: str
    host: str
    port: int = Field(default=587, ge=1, le=65535)
    tls: Literal["starttls", "tls", "none"] = "starttls"
    user: str = ""
    """Empty: the server asks for no password."""
    password_file: FilePath | None = None

    @field_validator("to", "sender")
    @classmethod
    def _one_line(cls, value: str | tuple[str, ...]) -> str | tuple[str, ...]:
        for address in (value,) if isinstance(value, str) else value:
            if not re.fullmatch(r"[^\s@]+@[^\s@]+", address):
                raise ValueError(f"{address!r} is no e-mail address")
        return value


class CallSettings(BaseModel):
    """Who is called when a robot waits for a person: one of `webhook`, `webhook_file` and `email`."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    after_s: float = Field(default=60.0, ge=0)
    """Wall time that it must have waited."""
    webhook: str = Field(default="", pattern=r"^(https?://\S+)?$")
    """Address that gets a POST with `text`, `robot` and `waited_s` as JSON."""
    webhook_file: FilePath | None = None
    """File with the address, where that is a secret."""
    email: EmailSettings | None = None
    link: str = Field(default="", pattern=r"^(https?://\S+)?$")
    """Address of the page where it is answered, which is told as well."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if sum(map(bool, (self.webhook, self.webhook_file, self.email))) != 1:
            raise ValueError("give one of webhook, webhook_file and email")
        return self


class FeedSettings(BaseModel):
    """What is special about one display feed; what is left out is as for all."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    quality: int | None = Field(default=None, ge=1, le=95)
    """JPEG quality."""
    interval_s: float | None = Field(default=None, ge=0)
    """Shortest time between two pictures."""
    max_width_px: int | None = Field(default=None, ge=16, le=8192)
    """Wider pictures are made smaller."""


class TlsSettings(BaseModel):
    """Encryption between processes, in which each shows a certificate: files in PEM."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    authority: FilePath
    """Certificate of the authority that has signed those of all; who has another one is not let in."""
    certificate: FilePath
    """This process's own, for the names or addresses under which others connect to it."""
    key: FilePath
    """Its private key."""


class UserSettings(BaseModel):
    """By which name a process gets in where others ask for one."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: str = Field(min_length=1)
    password_file: FilePath


class Ros2Settings(BaseModel):
    """Into which ROS 2 a process goes: the one that is sourced where it is started, as its variables say."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    namespace: str = ""
    """Of relative names: `/ward`."""
    arguments: tuple[str, ...] = ()
    """As on the command line of a node: `[--ros-args, -r, "chat_interface_input:=orders"]`."""
    domain: int | None = Field(default=None, ge=0, le=232)
    """None: as ROS_DOMAIN_ID says."""


class NetworkSettings(BaseModel):
    """Into which network of Zenoh a process goes. As it stands: the processes of this machine."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    domain: int = Field(default=0, ge=0, le=232)
    """Processes of other domains are not seen (ROS: `ROS_DOMAIN_ID`)."""
    listen: tuple[str, ...] | None = None
    """Where others may connect: `tcp/0.0.0.0:7447`; None: from this machine only."""
    connect: tuple[str, ...] = ()
    """Whom to connect to: `tcp/192.168.1.5:7447`."""
    interface: str = "127.0.0.1"
    """Where to look for others: an address of this machine, a network of it, `auto`; empty: nowhere."""
    role: Literal["peer", "client", "router"] = "peer"
    """A `client` reaches others through a `router` only."""
    silence_s: float = Field(default=4.0, ge=0.5, le=60)
    """Whoever gives no sign of life for so long is taken for gone."""
    tls: TlsSettings | None = None
    """Encryption; None: none. With it all addresses begin with `tls/`."""
    user: UserSettings | None = None
    """Who this process is, where a name and a password are asked for."""
    users: FilePath | None = None
    """Who gets in here: a file with a line `name:password` for each; None: no name is asked for."""
    access: FilePath | None = None
    """Of a router: who may say and hear what; others pass it over. Needs `tls` or `users`."""
    rosbridge: str | None = Field(default=None, pattern=r"^wss?://")
    """The ROS behind this rosbridge instead: `ws://robot:9090`; besides it only `silence_s` counts."""
    ros2: Ros2Settings | None = None
    """The ROS 2 of this machine instead; besides it nothing counts."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        """Whoever names two would not know which is taken."""
        if self.ros2 is not None and self.rosbridge is not None:
            raise ValueError("name ros2 or rosbridge, not both")
        return self

    @model_validator(mode="after")
    def _all_encrypted_or_none(self) -> Self:
        """One address that is forgotten would be an open door."""
        begins = "tls/" if self.tls else "tcp/"
        for address in (*(self.listen or ()), *self.connect):
            if not address.startswith(begins):
                raise ValueError(
                    f"{address} should begin with {begins}, as tls is {'' if self.tls else 'not '}set"
                )
            port = address.rpartition(":")[2]
            if not port.isdecimal() or int(port) > 65535:
                raise ValueError(f"{address} should end with a port, e.g. :7447")
        return self

    @property
    def listens(self) -> tuple[str, ...]:
        """Where others may connect."""
        return (f"{'tls' if self.tls else 'tcp'}/127.0.0.1:0",) if self.listen is None else self.listen

    @property
    def beside(self) -> NetworkSettings:
        """Those of one more end on the same machine: with a port of its own, and by way of the first one."""
        ours = [address for address in self.listen or () if not address.endswith(":0")]
        if self.role != "peer" or not ours:
            return self
        near = (address.replace("0.0.0.0", "127.0.0.1").replace("[::]", "[::1]") for address in ours)
        own = (f"{address.rpartition(':')[0]}:0" for address in self.listen or ())
        return self.model_copy(update={"listen": tuple(own), "connect": (*self.connect, *near)})

    @property
    def as_router(self) -> NetworkSettings:
        """Those of the router that all others connect to, by their own settings."""
        return self.model_copy(
            update={"role": "router", "listen": self.listen or self.connect, "connect": (), "interface": ""}
        )


class SystemConfig(BaseModel, TextFile):
    """What may be chosen about a system; the defaults are the thesis's and the design's.

    A file of settings (`load`) is YAML with these names; paths in it count from its own folder.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    data_dir: FilePath | None = None
    """Where the memory file lives; None keeps memories only while the system runs."""
    memory: FilePath | None = None
    """Another file for the memories than `memory.db` in `data_dir`."""
    embeddings: EmbeddingSettings | None = None
    """How memories are found by what they mean; None: by their words alone."""
    rules_file: FilePath | None = None
    """What robots may do; None: `rules.yaml` in `data_dir`, or, without that, only while the system runs."""
    actions_dir: FilePath | None = None
    """Folder with more actions, watched while the system runs."""
    audit_months: int | None = Field(default=24, ge=1, le=1200)
    """How long the log of who did what is kept; None: for good."""
    language: LanguageName = "builtin"
    """What understands people: `builtin`, `provider:model`, `provider:model@address`, or
    `auto:provider:model`: the built-in engine where it is certain, that model for the rest (`auto` alone: the
    first model of `language_fallback`)."""
    language_fallback: tuple[LanguageName, ...] = ("builtin",)
    """Asked in this order when a model gives no answer."""
    model: ModelSettings = Field(default_factory=ModelSettings)
    """How language models are asked."""
    approval: ApprovalPolicy = "run_at_once"
    """Whether plans wait for a person's yes: none, those with a step of high risk, all."""
    unattended: Unattended = "go_on"
    """What robots do with their plans when nobody is connected, unless an order says otherwise: `go_on`,
    `hold` (wait for a person), `go_home` (drive to where they stood when the system started)."""
    unattended_after_s: float = Field(default=30.0, gt=0)
    """Wall time for which nobody must be connected for that."""
    calls: tuple[CallSettings, ...] = ()
    """Who is called when a robot waits for a yes or an answer; a later one, when nobody came."""
    approval_of: dict[str, ApprovalPolicy] = Field(default_factory=dict)
    """Robots for which that is otherwise, by name."""
    temoto: dict[str, str] = Field(default_factory=dict)
    """Robots whose engine is TeMoto's, by name, and the service that tells about it: `umrf_graph_get`."""
    foreign_planner: bool = False
    """Whether a planner that is not Parley's tells engines what to do: it tells no rules, and those of the
    file hold."""
    network: NetworkSettings | None = None
    """Where the parts of the system hear each other; None: within one process."""
    speed: float | None = Field(default=1.0, gt=0)
    """Simulated time per wall time; None: as fast as the machine can."""
    seed: int = 0
    """For everything random in the simulation."""
    speaks: SpokenLanguage = "en"
    """The language in which robots speak on topics and in the terminal; what a model words stays as it is."""
    history_exchanges: int = Field(default=10, ge=0, le=1000)
    """Exchanges of a conversation that are context for the next message."""
    max_attempts: int = Field(default=3, ge=1, le=20)
    """Questions to the operator about one failed step before the robot is held."""
    language_timeout_s: float = Field(default=30.0, gt=0)
    """Wall time the language engine may take for an answer."""
    camera_hz: float = Field(default=5.0, gt=0, le=30)
    """Pictures per second of a camera feed that somebody watches."""
    display_quality: int = Field(default=85, ge=1, le=95)
    """JPEG quality of display feeds."""
    display_interval_s: float = Field(default=0.1, ge=0)
    """Shortest time between two pictures of one feed."""
    display_feeds: dict[str, FeedSettings] = Field(default_factory=dict)
    """What differs for single feeds: by `robot/feed`, or by `feed` for that of every robot."""

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a file of settings.

        Raises:
            FileFormatError: Names the file, the line and the setting that is wrong or unknown.
        """
        return validated_yaml(cls, read_text(path), path.name, {FOLDER: path.parent})

    @classmethod
    def parse(cls, text: str, file: str = "settings") -> Self:
        """Read the text of a file of settings; paths in it count from where the process runs.

        Raises:
            FileFormatError: Names the file, the line and the setting that is wrong or unknown.
        """
        return validated_yaml(cls, text, file)

    def changed(self, changes: dict[str, Any]) -> Self:
        """These settings with others on top, section by section; what was not set before stays unset.

        A model's address and key are meant for the model they stand beside: another model gets neither.

        Raises:
            pydantic.ValidationError: One of the changes cannot be.
        """
        known = self.model_dump(exclude_unset=True)
        if changes.get("language", self.language) != self.language:
            known["model"] = {
                name: value
                for name, value in known.get("model", {}).items()
                if name not in ("base_url", "key_file")
            }
        return self.model_validate(_merged(known, changes))

    @property
    def memory_file(self) -> Path | None:
        """The memory's database file, None for a memory that is not kept."""
        if self.memory is not None:
            return self.memory
        return self.data_dir / "memory.db" if self.data_dir is not None else None

    @property
    def rules_path(self) -> Path | None:
        """Where rules are kept, None if they are not."""
        if self.rules_file is not None:
            return self.rules_file
        return self.data_dir / "rules.yaml" if self.data_dir is not None else None

    @property
    def incidents_file(self) -> Path | None:
        """The records of failures, None if they are not kept."""
        return self.data_dir / "incidents.db" if self.data_dir is not None else None

    @property
    def proposals_file(self) -> Path | None:
        """The plans that wait for a person's yes, None if they are not kept."""
        return self.data_dir / "proposals.db" if self.data_dir is not None else None

    @property
    def missions_file(self) -> Path | None:
        """The orders to teams that were followed last, None if they are not kept."""
        return self.data_dir / "missions.db" if self.data_dir is not None else None

    @property
    def found_file(self) -> Path | None:
        """What robots found and no map knew, None if it is not kept."""
        return self.data_dir / "found_things.json" if self.data_dir is not None else None

    @property
    def places_file(self) -> Path | None:
        """What people put on the maps, None if it is not kept."""
        return self.data_dir / "places.json" if self.data_dir is not None else None

    @property
    def audit_file(self) -> Path | None:
        """The log of who did what, None if it is not kept."""
        return self.data_dir / "audit.db" if self.data_dir is not None else None

    @property
    def stop_file(self) -> Path | None:
        """Who is held by an emergency stop, None if that is not kept."""
        return self.data_dir / "stops.json" if self.data_dir is not None else None

    @property
    def journal_file(self) -> Path | None:
        """The journal of what ran, None if it is not kept."""
        return self.data_dir / "journal.db" if self.data_dir is not None else None


def _merged(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    both = {
        name: _merged(below[name], value)
        for name, value in above.items()
        if isinstance(value, dict) and isinstance(below.get(name), dict)
    }
    return below | above | both
