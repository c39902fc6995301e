"""Who may say, hear, ask and answer what: a short file of names, and the rules of Zenoh's routers made of it.

::

    robots: {ward-pc: [Ada, Kim]}     # who carries out plans for which robots
    agents: [planner]
    pages: [desk]
    programs: {door: {says: [door_state]}}

A name is that of a certificate (its common name) or of a user. Whoever is in no list may nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Final, Self

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

from parley.config import NetworkSettings
from parley.errors import ConfigError
from parley.files import TextFile, validated_yaml
from parley.messages import topics
from parley.messages.topics import Service, Topic
from parley.transport.zenoh.keys import KINDS

__all__ = ["AccessFile", "Allowed", "Program", "access_control"]

Who = Annotated[str, StringConstraints(min_length=1)]
Name = Annotated[str, StringConstraints(pattern=r"^/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*(/\*\*)?$")]
"""Of a topic or service, or with `/**` all whose names begin so."""

_ANY: Final = "**"
_SHARED: Final = tuple(topic.name for topic in topics.ALL_TOPICS)
_ANSWERED: Final = tuple(service.name for service in topics.ALL_SERVICES)
_OF_ROBOTS: Final = ("*/parley_site",)
_FEEDS: Final = "webapp/display_feed"


def _names(*used: Topic[Any] | Service[Any, Any]) -> tuple[str, ...]:
    return tuple(each.name for each in used)


@dataclass(frozen=True, slots=True)
class Allowed:
    """What somebody may do, by names of topics and services; `*` in one stands for a part, `**` for any."""

    says: tuple[str, ...] = ()
    hears: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()
    answers: tuple[str, ...] = ()

    def with_all(self, names: Iterable[str]) -> Allowed:
        """The same, and everything that is called so."""
        more = tuple(names)
        return Allowed(self.says + more, self.hears + more, self.asks + more, self.answers + more)


_ROBOT: Final = Allowed(
    says=_names(
        topics.ACTOR_STATUS, topics.ADD_TO_MEMORY, topics.ASIDE, topics.CHAT_FEEDBACK, topics.DISPLAY_FEED,
        topics.GRAPH_EVENTS, topics.GRAPH_FEEDBACK, topics.MAP_VIEW, topics.NOTICE, topics.REJECTION,
        topics.STOP_REPORT, topics.SYNC,
    ),
    hears=_names(
        topics.ACTOR_STATUS, topics.CHAT_FEEDBACK, topics.CHAT_INPUT, topics.GRAPH_MODIFY, topics.GRAPH_PAUSE,
        topics.GRAPH_PAUSE_TEMOTO, topics.GRAPH_RESUME, topics.GRAPH_START, topics.GRAPH_STOP,
        topics.PASSAGES, topics.PLACES_KEPT, topics.PLAN, topics.PULSE, topics.RULES_IN_FORCE, topics.STEP,
        topics.STOP, topics.SYNC,
    ),
    asks=_names(topics.GET_MEMORY),
    answers=_names(topics.GRAPH_GET),
)  # fmt: skip
"""An engine: it tells what becomes of plans, and says nothing in a person's name; its own come on top."""
_AGENT: Final = Allowed(
    says=(*_SHARED, f"{_FEEDS}/{_ANY}"),
    hears=(*_SHARED, *_OF_ROBOTS),
    asks=(*_ANSWERED, "*/umrf_graph_get", "*/parley_unfinished"),
    answers=_names(
        topics.GET_MEMORY,
        topics.GET_INCIDENTS,
        topics.GET_MAP,
        topics.GET_AUDIT,
        topics.RULES,
        topics.PLACES,
    ),
)
_WATCHER: Final = Allowed(hears=(*_SHARED, *_OF_ROBOTS, f"{_FEEDS}/{_ANY}"))
_PAGE: Final = Allowed(
    says=_names(
        topics.ADD_TO_MEMORY, topics.ATTENDANCE, topics.AUDIT, topics.CHAT_ACTION, topics.CHAT_FEEDBACK,
        topics.CHAT_INPUT, topics.GRAPH_PAUSE, topics.GRAPH_PAUSE_TEMOTO, topics.GRAPH_RESUME,
        topics.PLAN_DECISION, topics.PULSE, topics.REMOVE_MEMORY, topics.STOP,
    ),
    hears=_WATCHER.hears,
    asks=_ANSWERED,
)  # fmt: skip


class Program(BaseModel):
    """What a program of yours, or another robot's base, may do, by names of topics and services."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    says: tuple[Name, ...] = ()
    """Topics that it publishes."""
    hears: tuple[Name, ...] = ()
    asks: tuple[Name, ...] = ()
    """Services that it calls; an action is three of them: `drive/_action/**`."""
    answers: tuple[Name, ...] = ()


class AccessFile(BaseModel, TextFile):
    """See the module. Names of robots are as people call them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    robots: dict[Who, tuple[Who, ...]] = Field(default_factory=dict)
    """Engines -> their robots: what is called `<robot>/...` is theirs alone, e.g. velocities of a base."""
    bases: dict[Who, tuple[Who, ...]] = Field(default_factory=dict)
    """Robots' own computers, if they are on this network: what is called so, and no more."""
    agents: tuple[Who, ...] = ()
    """Who understands, plans and remembers."""
    pages: tuple[Who, ...] = ()
    """Pages and terminals: orders, answers, stops and their releases."""
    watchers: tuple[Who, ...] = ()
    """They see and hear what pages do, and say nothing."""
    programs: dict[Who, Program] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _named_once(self) -> Self:
        every = [*self.robots, *self.bases, *self.agents, *self.pages, *self.watchers, *self.programs]
        if not every:
            raise ValueError("it names nobody, so that nobody could do anything")
        if twice := sorted({who for who in every if every.count(who) > 1}):
            raise ValueError(f"{twice[0]!r} is in two lists; whoever is two things needs two names")
        driven = [robot for theirs in self.robots.values() for robot in theirs]
        if twice := sorted({robot for robot in driven if driven.count(robot) > 1}):
            raise ValueError(f"two have the robot {twice[0]!r}; one carries out its plans")
        return self

    @classmethod
    def parse(cls, text: str, file: str = "access") -> Self:
        """Read the text of such a file.

        Raises:
            FileFormatError: Names the file, the line and what is wrong or unknown.
        """
        return validated_yaml(cls, text, file)

    def allowed(self) -> Mapping[str, Allowed]:
        """Name -> what whoever has it may do."""
        return {
            **{who: _engine_of(its) for who, its in self.robots.items()},
            **{who: Allowed().with_all(_own(its)) for who, its in self.bases.items()},
            **dict.fromkeys(self.agents, _AGENT),
            **dict.fromkeys(self.pages, _PAGE),
            **dict.fromkeys(self.watchers, _WATCHER),
            **{who: Allowed(**program.model_dump()) for who, program in self.programs.items()},
        }


def _own(robots: Iterable[str]) -> tuple[str, ...]:
    return tuple(f"{topics.ros_name(robot)}/{_ANY}" for robot in robots)


def _engine_of(robots: Iterable[str]) -> Allowed:
    own = _own(robots)
    feeds = tuple(f"{_FEEDS}/{name}" for name in own)
    return replace(_ROBOT, says=_ROBOT.says + feeds).with_all(own)


def access_control(network: NetworkSettings, file: AccessFile) -> dict[str, Any]:
    """The section `access_control` of a Zenoh router: all that the file does not allow is denied.

    Args:
        network: Of the router. With `tls` a name is that of a certificate, with `users` of a user.
        file: Who may what.

    Raises:
        ConfigError: The router could not tell who is who.
    """
    if network.tls is None and network.users is None:
        raise ConfigError("rules of access need tls or users in the network: nobody says who he is")
    rules: list[dict[str, Any]] = []
    subjects, policies = [], []
    for who, allowed in file.allowed().items():
        subject: dict[str, Any] = {"id": who}
        if network.tls is not None:
            subject["cert_common_names"] = [who]
        if network.users is not None:
            subject["usernames"] = [who]
        own = [*_rules(network.domain, who, allowed)]
        rules += own
        subjects.append(subject)
        policies.append({"rules": [rule["id"] for rule in own], "subjects": [who]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


_LOOK: Final = ["liveliness_query", "declare_liveliness_subscriber"]
_WAYS: Final[Mapping[str, tuple[list[str], list[str]]]] = {
    "says": (["put", "delete", "reply"], ["declare_subscriber"]),
    "hears": (["declare_subscriber"], ["put", "delete", "reply"]),
    "asks": (["query"], ["reply", "declare_queryable"]),
    "answers": (["declare_queryable", "reply"], ["query"]),
}
"""What the router takes from whoever does this, and what it hands to him."""
_LATE: Final[Mapping[str, tuple[list[str], list[str]]]] = {
    "says": (["declare_queryable", "reply", "liveliness_token"], ["query", "declare_subscriber", *_LOOK]),
    "hears": (["query", "declare_subscriber", *_LOOK], ["reply", "declare_queryable", "liveliness_token"]),
}
"""The same beside the topic, where who comes late, or was away, asks for what was said meanwhile."""
_SHOWN: Final = {
    "says": KINDS["publisher"],
    "hears": KINDS["subscription"],
    "answers": KINDS["server"],
    "asks": "SC",
}


def _rules(domain: int, who: str, allowed: Allowed) -> Iterator[dict[str, Any]]:
    """What one may do, and that others see he does."""
    tokens: list[str] = []
    for way, (takes, gives) in _WAYS.items():
        names = [name.strip("/") for name in getattr(allowed, way)]
        if not names:
            continue
        keys = [_key(domain, name) for name in names]
        yield _rule(f"{who} {way}", "ingress", takes, keys)
        yield _rule(f"to {who}, who {way}", "egress", gives, keys)
        if way in _LATE:
            takes, gives = _LATE[way]
            beside = [f"{key}/@adv/**" for key in keys]
            yield _rule(f"{who} {way}, late", "ingress", takes, beside)
            yield _rule(f"to {who}, who {way}, late", "egress", gives, beside)
        tokens += (f"@ros2_lv/{domain}/*/*/*/{_SHOWN[way]}/*/*/*/{_shown(name)}/*/*/*" for name in names)
    everybody = f"@ros2_lv/{domain}/**"
    yield _rule(f"{who} shows", "ingress", ["liveliness_token"], [f"@ros2_lv/{domain}/*/*/*/NN/**", *tokens])
    yield _rule(f"{who} looks", "ingress", _LOOK, [everybody])
    yield _rule(f"{who} sees", "egress", ["liveliness_token"], [everybody])


def _key(domain: int, name: str) -> str:
    """Of all types and hashes, and of names that begin so."""
    return f"{domain}/{name}" if name.endswith(_ANY) else f"{domain}/{name}/*/*"


def _shown(name: str) -> str:
    """A name in a token, where it is one part."""
    return "%" + name.replace(f"/{_ANY}", "/*").replace("*", "$*").replace("/", "%")


def _rule(id: str, flow: str, messages: list[str], keys: list[str]) -> dict[str, Any]:
    return {"id": id, "permission": "allow", "flows": [flow], "messages": messages, "key_exprs": keys}
