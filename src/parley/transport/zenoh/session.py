"""How the library is set for a network."""

from __future__ import annotations

import json
import re
import socket
from contextlib import suppress
from ipaddress import ip_address
from typing import Any, Final

import zenoh

from parley.config import NetworkSettings
from parley.errors import UnavailableError
from parley.files import read_text
from parley.transport.zenoh.access import AccessFile, access_control

__all__ = ["config", "reason"]

ROUTER_WAIT_MS: Final = 5000
"""How long a client waits for its router when it begins."""
GIVE_UP_MS: Final = 2000
"""How long one who takes nothing may hold up what is sent to others; then the link to it is closed."""


def reason(error: zenoh.ZError, network: NetworkSettings) -> str:
    """What the library says, without where in its source it says so; of a closed door it says nothing."""
    said = re.sub(r"\s+at /\S+\.rs:\d+\.?", "", str(error))
    if "Unable to connect" not in said:
        return said
    where = " or ".join(network.connect)
    return f"nobody at {where} answers and lets this in; parley doctor --config FILE says which it is"


def config(network: NetworkSettings) -> zenoh.Config:
    """The library's settings for this network.

    Raises:
        ConfigError: A file of it cannot be read or is wrong.
        UnavailableError: This machine does not have the network on which others are to be looked for.
    """
    _need_interface(network.interface)
    made = zenoh.Config()
    settings: dict[str, Any] = {
        "mode": network.role,
        "listen/endpoints": list(network.listens),
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
    if network.tls is not None:
        for file in (network.tls.authority, network.tls.certificate, network.tls.key):
            read_text(file)  # as with `users` below
        certificate, key = str(network.tls.certificate), str(network.tls.key)
        settings |= {
            "transport/link/protocols": ["tls"],
            "transport/link/tls/root_ca_certificate": str(network.tls.authority),
            "transport/link/tls/enable_mtls": True,
            "transport/link/tls/listen_certificate": certificate,
            "transport/link/tls/listen_private_key": key,
            "transport/link/tls/connect_certificate": certificate,
            "transport/link/tls/connect_private_key": key,
        }
    if network.user is not None:
        settings["transport/auth/usrpwd/user"] = network.user.name
        settings["transport/auth/usrpwd/password"] = read_text(network.user.password_file).strip()
    if network.users is not None:
        read_text(network.users)  # says that it is not there better than the library does
        settings["transport/auth/usrpwd/dictionary_file"] = str(network.users)
    if network.access is not None and network.role == "router":
        settings["access_control"] = access_control(network, AccessFile.load(network.access))
    for name, value in settings.items():
        made.insert_json5(name, json.dumps(value))
    return made


def _need_interface(name: str) -> None:
    """The library only logs that it is not there, and then finds nobody."""
    if name in ("", "auto"):
        return
    names = [known for _, known in socket.if_nameindex()]
    try:
        family = socket.AF_INET6 if ip_address(name).version == 6 else socket.AF_INET
    except ValueError:
        if name in names:
            return
    else:
        with suppress(OSError), socket.socket(family, socket.SOCK_DGRAM) as end:
            end.bind((name, 0))
            return
    raise UnavailableError(
        f"network.interface: this machine is not on {name} now; its networks: {', '.join(names)}"
    )
