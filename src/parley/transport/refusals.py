"""What all transports refuse, and in which words."""

from __future__ import annotations

from typing import Any

from parley.errors import TransportError, TransportTimeoutError, TypeMismatchError, UnavailableError
from parley.messages.topics import Service, Topic

__all__ = [
    "answered_already", "check_message", "check_request", "failed", "nobody_answers", "too_late",
    "types_differ", "went_away",
]  # fmt: skip


def check_message(topic: Topic[Any], message: object) -> None:
    """Raises `TypeMismatchError` if a topic does not carry such a message."""
    if not isinstance(message, topic.type):
        raise TypeMismatchError(f"{topic.name} carries {topic.ros_type}; got a {type(message).__name__}")


def check_request(service: Service[Any, Any], request: object) -> None:
    """Raises `TypeMismatchError` if a service does not take such a request."""
    if not isinstance(request, service.request):
        raise TypeMismatchError(f"{service.name} takes {service.ros_type}; got a {type(request).__name__}")


def types_differ(name: str, known: str, ros_type: str) -> TypeMismatchError:
    """A name is in use with another type."""
    return TypeMismatchError(f"{name} is in use as {known}, not {ros_type}; use the same type on both sides")


def answered_already(name: str) -> UnavailableError:
    """A service has a server."""
    return UnavailableError(f"service {name} is answered already; stop the other one first")


def nobody_answers(name: str) -> UnavailableError:
    """A service has no server."""
    return UnavailableError(f"nobody answers service {name}; is its node running?")


def went_away(name: str) -> UnavailableError:
    """A server was closed during a call."""
    return UnavailableError(f"service {name} went away before it answered")


def failed(name: str, why: object) -> TransportError:
    """Who answers a service says that it could not."""
    return TransportError(f"service {name} failed: {why}")


def too_late(name: str, timeout_s: float) -> TransportTimeoutError:
    """A call has taken its time."""
    return TransportTimeoutError(f"service {name} did not answer within {timeout_s} s")
