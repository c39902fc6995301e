"""The names that rmw_zenoh gives to topics, services and whoever uses them, and what goes with each message.

A key is `<domain>/<name>/<type>/<hash>`. Whoever is there shows it by a token that lives as it does:
`@ros2_lv/<domain>/<session>/<node>/<end>/<kind>/<enclave>/<namespace>/<node name>`. That of an end has
`/<name>/<type>/<hash>/<qos>` behind it.
"""

from __future__ import annotations

import hashlib
import struct
from dataclasses import dataclass
from typing import Final

from parley.messages.topics import QoS
from parley.transport.base import Endpoint

__all__ = ["KINDS", "Attachment", "Node", "all_tokens", "endpoint_of", "gid_of", "key"]

KINDS: Final = {"publisher": "MP", "subscription": "MS", "server": "SS"}
_ROLES: Final = {kind: role for role, kind in KINDS.items()}
_ADMIN: Final = "@ros2_lv"
_PARTS: Final = 13
"""Of the token of an end; that of a node has fewer."""


def key(domain: int, name: str, ros_type: str, type_hash: str) -> str:
    """Under which a topic's messages or a service's calls go."""
    return f"{domain}/{name.strip('/')}/{_dds(ros_type)}/{type_hash}"


def all_tokens(domain: int) -> str:
    """Fits the tokens of everybody in this domain."""
    return f"{_ADMIN}/{domain}/**"


@dataclass(frozen=True, slots=True)
class Node:
    """Whose ends they are."""

    domain: int
    session: str
    name: str
    """Without slashes."""

    def token(self, end: int = 0, kind: str = "NN") -> str:
        """What shows that it is there; the beginning of the tokens of its ends."""
        return f"{_ADMIN}/{self.domain}/{self.session}/0/{end}/{kind}/%/%/{self.name}"

    def end_token(self, end: int, endpoint: Endpoint, type_hash: str, qos: QoS) -> str:
        """What shows that an end is there; `end` counts them within the session."""
        name = endpoint.name.replace("/", "%")
        described = f"{name}/{_dds(endpoint.ros_type)}/{type_hash}/{_qos(qos)}"
        return f"{self.token(end, KINDS[endpoint.role])}/{described}"


def endpoint_of(token: str) -> Endpoint | None:
    """Whose token this is; None: of nobody that counts here (a node, who calls a service)."""
    parts = token.split("/")
    if len(parts) != _PARTS or parts[5] not in _ROLES:
        return None
    return Endpoint(parts[9].replace("%", "/"), _ros(parts[10]), _ROLES[parts[5]], elsewhere=True)


def gid_of(token: str) -> bytes:
    """Names an end in what it sends: 16 bytes that no two share."""
    return hashlib.blake2b(token.encode(), digest_size=16).digest()


@dataclass(frozen=True, slots=True)
class Attachment:
    """What goes with each message."""

    number: int
    """Counts up from 1."""
    unix_ns: int
    gid: bytes
    """Whose count it is."""

    def to_bytes(self) -> bytes:
        """33 bytes."""
        return _ATTACHMENT.pack(self.number, self.unix_ns, len(self.gid), self.gid)

    @classmethod
    def from_bytes(cls, data: bytes) -> Attachment | None:
        """None: it is something else, of somebody who is no ROS."""
        if len(data) != _ATTACHMENT.size:
            return None
        number, unix_ns, _, gid = _ATTACHMENT.unpack(data)
        return cls(number, unix_ns, gid)


_ATTACHMENT: Final = struct.Struct("<qqB16s")


def _dds(ros_type: str) -> str:
    package, kind, name = ros_type.split("/")
    return f"{package}::{kind}::dds_::{name}_"


def _ros(dds_type: str) -> str:
    return dds_type.replace("::dds_::", "::").replace("::", "/").removesuffix("_")


def _qos(qos: QoS) -> str:
    """What differs from ROS's own: reliable, volatile, the last of so many (42 if not said)."""
    reliability = "" if qos.reliable else "2"
    durability = "1" if qos.latched else ""
    history = "2" if qos.keep_all else ""
    return f"{reliability}:{durability}:{history},{qos.depth}:,:,:,,"
