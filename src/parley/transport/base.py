"""The doorway between nodes: publish, subscribe, serve, call, and ask for long tasks (design section 3).

Handlers run on the loop, one message of a subscription after the other. `Publisher.publish` never blocks and
never raises because of a subscriber. A handler that raises is logged and goes on with the next message.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Generic, Protocol, Self, TypeVar

from parley.messages.actions import Action, GoalState
from parley.messages.topics import Service, Topic

__all__ = [
    "ActionClient",
    "Endpoint",
    "Handler",
    "Outcome",
    "Publisher",
    "SentGoal",
    "Server",
    "Subscription",
    "Transport",
    "absolute",
]

M = TypeVar("M")
M_contra = TypeVar("M_contra", contravariant=True)
Req = TypeVar("Req")
Res = TypeVar("Res")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")
Goal_contra = TypeVar("Goal_contra", contravariant=True)
Result_co = TypeVar("Result_co", covariant=True)
Feedback_co = TypeVar("Feedback_co", covariant=True)

Handler = Callable[[M], Awaitable[None] | None]
"""Gets each message; plain or async."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One end of a topic or service, as seen in the graph of who is there."""

    name: str
    ros_type: str
    role: str
    """`publisher`, `subscription`, `server`."""
    elsewhere: bool = field(default=False, compare=False)
    """Whether it is in another process."""


class Publisher(Protocol[M_contra]):
    """The sending end of a topic."""

    def publish(self, message: M_contra) -> None:
        """Hand the message over; returns at once."""
        ...

    def close(self) -> None:
        """Take the end away; idempotent."""
        ...


class Subscription(Protocol):
    """The receiving end of a topic."""

    @property
    def dropped(self) -> int:
        """Messages that were dropped because this subscriber was slower than its depth allows."""
        ...

    async def close(self) -> None:
        """Stop receiving; a handler that runs is finished first or cancelled. Idempotent."""
        ...


class Server(Protocol):
    """The answering end of a service."""

    async def close(self) -> None:
        """Stop answering. Idempotent."""
        ...


@dataclass(frozen=True, slots=True)
class Outcome(Generic[Result_co]):
    """How a goal ended."""

    state: GoalState
    """`SUCCEEDED`, `CANCELED` or `ABORTED`; `UNKNOWN` if the server knows the goal no more."""
    result: Result_co


class SentGoal(Protocol[Result_co]):
    """A goal that an action server has accepted."""

    @property
    def state(self) -> GoalState:
        """Where it stands, as far as the server has told."""
        ...

    async def outcome(self, *, timeout_s: float) -> Outcome[Result_co]:
        """Wait until it is over, at most `timeout_s` of wall time. Giving up waiting does not call it off.

        Raises:
            UnavailableError: The server went away.
            TransportTimeoutError: It is not over yet; may be asked again.
        """
        ...

    async def cancel(self, *, timeout_s: float) -> bool:
        """Call it off; whether the server does so. It is over when `outcome` says so, not before.

        Raises:
            UnavailableError: The server went away.
            TransportTimeoutError: No answer in time.
        """
        ...


class ActionClient(Protocol[Goal_contra, Result_co, Feedback_co]):
    """The asking end of an action."""

    async def send(
        self, goal: Goal_contra, *, timeout_s: float, on_feedback: Handler[Feedback_co] | None = None
    ) -> SentGoal[Result_co]:
        """Ask for `goal`; returns when the server has accepted it.

        Args:
            goal: What to reach.
            timeout_s: How long to wait for the server's word.
            on_feedback: Gets what the server tells on the way.

        Raises:
            UnavailableError: Nobody serves this action.
            TransportTimeoutError: No word in time; the goal may have been accepted all the same.
            GoalRefusedError: The server does not take it.
        """
        ...

    async def close(self) -> None:
        """Take the end away; goals go on without it. Idempotent."""
        ...


class Transport(Protocol):
    """One backend. Use as ``async with``; everything opened through it is closed with it."""

    async def __aenter__(self) -> Self: ...

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def publisher(self, topic: Topic[M]) -> Publisher[M]:
        """Open the sending end of `topic`.

        Raises:
            TypeMismatchError: The name is in use with another type.
        """
        ...

    async def subscribe(
        self,
        topic: Topic[M],
        handler: Handler[M],
        *,
        depth: int | None = None,
        along: Subscription | None = None,
        late: bool = False,
    ) -> Subscription:
        """Open the receiving end of `topic`; a latched topic hands over its last message first.

        Args:
            topic: What to hear.
            handler: Gets each message.
            depth: How many may wait; of more the oldest are dropped.
            along: A subscription whose messages and these are handled in the order in which they came, as far
                as the backend can tell that order.
            late: Whether what was missed while the connection was away is heard afterwards, in its turn, as
                far as senders keep it (`QoS.kept`) and the backend can: for who shows or writes down, not for
                who acts.

        Raises:
            TypeMismatchError: The name is in use with another type.
        """
        ...

    async def serve(self, service: Service[Req, Res], handler: Callable[[Req], Awaitable[Res]]) -> Server:
        """Answer `service`.

        Raises:
            UnavailableError: Somebody answers it already.
        """
        ...

    async def call(self, service: Service[Req, Res], request: Req, *, timeout_s: float) -> Res:
        """Call a service and wait for its answer, at most `timeout_s` of wall time.

        Raises:
            UnavailableError: Nobody answers this name.
            TransportTimeoutError: No answer in time.
            TransportError: The server's handler failed.
        """
        ...

    async def action_client(
        self, action: Action[Goal, Result, Feedback]
    ) -> ActionClient[Goal, Result, Feedback]:
        """Open the asking end of `action`.

        Raises:
            TypeMismatchError: Its names are in use with other types.
        """
        ...

    def named(self, name: str) -> Transport:
        """The same, for a part that others may know by a name of its own; open for as long as this is."""
        ...

    def endpoints(self) -> tuple[Endpoint, ...]:
        """Who is there now."""
        ...

    def on_endpoints_changed(self, handler: Callable[[], Any]) -> Callable[[], None]:
        """Call `handler` whenever `endpoints` changes; returns how to stop that."""
        ...


def absolute(name: str) -> str:
    """Relative names live in the root namespace here."""
    return name if name.startswith("/") else f"/{name}"
