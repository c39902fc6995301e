"""Into which network a process goes, and how the library is set for it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Final, Literal

import zenoh

__all__ = ["ROUTER_PORT", "Network", "config"]

ROUTER_PORT: Final = 7447
"""Where routers listen, those of ROS too."""

ROUTER_WAIT_MS: Final = 5000
"""How long a client waits for its router when it begins."""
GIVE_UP_MS: Final = 2000
"""How long one who takes nothing may hold up what is sent to others; then the link to it is closed."""


@dataclass(frozen=True, slots=True)
class Network:
    """Which network, and how to reach it. As it stands: the processes of this machine, found by themselves.

    Attributes:
        domain: Processes of other domains are not seen (ROS: `ROS_DOMAIN_ID`).
        listen: Where others may connect, e.g. `tcp/0.0.0.0:7447`.
        connect: Whom to connect to, e.g. `tcp/192.168.1.5:7447`; tried again until they are there.
        interface: Where to look for others without being told of them: an address or name of a network
            interface, `auto` for that of the network; empty: nowhere.
        role: A `peer` talks to others directly. A `router` passes on what others send, for those who cannot
            reach each other; they are `client`s of it, and need it to be there when they begin.
        silence_s: Whoever gives no sign of life for so long is taken for gone. Both sides say their own.
    """

    domain: int = 0
    listen: tuple[str, ...] = ("tcp/127.0.0.1:0",)
    connect: tuple[str, ...] = ()
    interface: str = "127.0.0.1"
    role: Literal["peer", "client", "router"] = "peer"
    silence_s: float = 4.0


def config(network: Network) -> zenoh.Config:
    """The library's settings for this network."""
    made = zenoh.Config()
    settings: dict[str, Any] = {
        "mode": network.role,
        "listen/endpoints": list(network.listen),
        "connect/endpoints": list(network.connect),
        # A peer tries for ever, and meanwhile goes on without those who are not there yet.
        "connect/timeout_ms": ROUTER_WAIT_MS if network.role == "client" else -1,
        "connect/exit_on_failure": network.role == "client",
        "connect/retry": {"period_init_ms": 200, "period_max_ms": 1000, "period_increase_factor": 2},
        "scouting/multicast/enabled": bool(network.interface),
        "scouting/multicast/interface": network.interface or "auto",
        "timestamping/enabled": True,  # latched topics need it
        "transport/shared_memory/enabled": False,  # it makes small messages slower
        "transport/link/tx/lease": round(network.silence_s * 1000),
        "transport/link/tx/queue/congestion_control/block/wait_before_close": GIVE_UP_MS * 1000,
    }
    for name, value in settings.items():
        made.insert_json5(name, json.dumps(value))
    return made
