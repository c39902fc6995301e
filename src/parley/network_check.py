"""What `parley doctor` finds on the network that the settings name."""

from __future__ import annotations

import asyncio
import os
import socket
import struct
from collections.abc import Iterable
from typing import Final

from parley.clock import WallClock
from parley.config import NetworkSettings, SystemConfig
from parley.door_check import ABSENT, NOT_OURS, examine_door
from parley.errors import InvalidMessageError, MissingExtraError, ParleyError, UnavailableError
from parley.findings import Finding
from parley.messages import topics
from parley.messages.ros import String
from parley.messages.status import ActorStatus
from parley.messages.wire import decode
from parley.network import transport_of
from parley.transport.base import Transport

__all__ = ["closed_doors", "examine_network"]

LISTENS_S: Final = 3.0
"""Robots tell every second that they are there."""
APART_MS: Final = 1000
"""Clocks that differ by less do no harm."""
CONNECTS_WITHIN_S: Final = 2.0
GROUP: Final = "224.0.0.224"
"""Where Zenoh looks for others."""
_SAME: Final = "Look at domain, interface and tls: all parts need the same."
LOOPBACK: Final = ("lo", "lo0")
START_BRIDGE: Final = (
    "Start it on the robot: ros2 launch rosbridge_server rosbridge_websocket_launch.xml "
    "call_services_in_new_thread:=true send_action_goals_in_new_thread:=true; or mend its address."
)
_SAME_BRIDGE: Final = "Look whether all parts name a bridge of one ROS, and whether rosapi runs beside it."
_NO_INTERFACE: Final = "network.interface"  # as it begins that this machine is not on it
_ROBOTS: Final = "parley engine"
_PLANS: Final = "parley node agents"
_SAME_ROS: Final = (
    "Compare ROS_DOMAIN_ID, RMW_IMPLEMENTATION and ROS_AUTOMATIC_DISCOVERY_RANGE: all parts need the same."
)


def examine_network(network: NetworkSettings | None) -> Iterable[Finding]:
    """Look who is there; nothing of it is needed."""
    if network is None:
        yield Finding("network", "unused", "The settings name none; all is in one process.")
        return
    if network.ros2 is None and network.rosbridge is None:
        yield from _domain(network.domain)
        yield from _multicast(network.interface)
    try:
        transport = transport_of(SystemConfig(network=network), node="parley_doctor")
    except MissingExtraError as missing:
        yield Finding("network", "missing", f"{missing.what} is not installed.", missing.remedy)
        return
    except ParleyError as error:
        yield Finding("network", "wrong", str(error), "See ROS 2 above.")
        return
    doors = _doors(network)
    yield from doors
    if network.role == "client" and doors and all(door.state == "wrong" for door in doors):
        return  # there is no other way in
    try:
        yield from asyncio.run(_listen(transport, network))
    except ParleyError as error:
        above = network.ros2 is not None or _NO_INTERFACE in str(error)
        mend = "See above." if above else START_BRIDGE if network.rosbridge is not None else NOT_OURS
        yield Finding("network", "wrong", str(error), mend)


def closed_doors(network: NetworkSettings) -> list[Finding]:
    """Where somebody answers and does not let a peer in; who is not there yet is no such."""
    if network.role != "peer" or network.ros2 is not None or network.rosbridge is not None:
        return []  # a client does not begin then
    return [door for door in _doors(network) if door.state == "wrong" and door.remedy != ABSENT]


def _doors(network: NetworkSettings) -> list[Finding]:
    return [_entered(examine_door(address, network), address, network) for address in network.connect]


def _entered(door: Finding, address: str, network: NetworkSettings) -> Finding:
    """Whether one gets in there: a peer that is not let in tries for ever, and nobody says so."""
    if door.state != "ok" or network.ros2 is not None or network.rosbridge is not None:
        return door
    way = {"role": "client", "connect": (address,), "listen": None, "interface": ""}
    transport = transport_of(SystemConfig(network=network.model_copy(update=way)), node="parley_doctor")
    try:
        asyncio.run(_open(transport))
    except UnavailableError:
        who = f"the user {network.user.name!r}" if network.user is not None else "this"
        return Finding("network", "wrong", f"{address} answers, and does not let {who} in", NOT_OURS)
    return door


async def _open(transport: Transport) -> None:
    async with transport:
        pass


def _domain(domain: int) -> Iterable[Finding]:
    """Whoever speaks with robots by rmw_zenoh needs theirs."""
    of_ros = os.environ.get("ROS_DOMAIN_ID", "")
    if of_ros.isdecimal() and int(of_ros) != domain:
        text = f"the settings say domain {domain}, and ROS_DOMAIN_ID is {of_ros}"
        yield Finding("domain", "wrong", text, "Write the same number in both, to see its robots.")


def _multicast(interface: str) -> Iterable[Finding]:
    """Whether others can be looked for there: what is sent to all comes back to who sends it."""
    if not interface:
        return
    names = [interface]
    if interface == "auto":
        names = [name for _, name in socket.if_nameindex() if name not in LOOPBACK]
    problems = [why for name in names if (why := _deaf(name))]
    if len(problems) == len(names):
        text = f"others cannot be looked for on {interface}: {problems[0] if problems else 'there is none'}"
        mend = "Name another `interface`, or `connect` to an address: not every network lets multicast pass."
        yield Finding("discovery", "wrong", text, mend)
    else:
        where = "this machine alone" if interface == "127.0.0.1" else interface
        yield Finding("discovery", "ok", f"others are looked for on {where}")


def _deaf(name: str) -> str:
    """Why nothing comes back from one network; empty: it does."""
    try:
        at = _interface(name)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
            end.settimeout(CONNECTS_WITHIN_S)
            end.bind(("", 0))
            end.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + at)
            end.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, at if len(at) == 4 else bytes(4) + at)
            end.sendto(b"parley", (GROUP, end.getsockname()[1]))
            end.recv(16)
    except OSError as error:
        return str(error)
    return ""


def _interface(name: str) -> bytes:
    """Its address, as sockets take it."""
    try:
        return socket.inet_aton(name)
    except OSError:
        return bytes(4) + struct.pack("@i", socket.if_nametoindex(name))  # any address, on that network


async def _listen(transport: Transport, network: NetworkSettings) -> list[Finding]:
    clock = WallClock()
    apart_ms: dict[str, int] = {}

    def heard(message: String) -> None:
        try:
            status = decode(ActorStatus, message.data)
        except InvalidMessageError:
            return
        apart_ms[status.actor] = status.unix_ms - clock.unix_ms() if status.unix_ms else 0

    async with transport:
        await transport.subscribe(topics.ACTOR_STATUS, heard)
        await asyncio.sleep(LISTENS_S)
        others = [end for end in transport.endpoints() if end.elsewhere]
    plans = any(end.name == topics.RULES.name and end.role == "server" for end in others)
    pages = sum(end.name == topics.ATTENDANCE.name and end.role == "publisher" for end in others)
    same = _SAME_ROS if network.ros2 else _SAME_BRIDGE if network.rosbridge else _SAME
    if not others:
        text = f"nobody was there in {LISTENS_S:g} s"
        return [Finding("network", "missing", text, same)]
    robots = ", ".join(sorted(apart_ms)) or "none"
    told = f"robots: {robots}; who plans: {'there' if plans else 'not there'}; pages: {pages}"
    absent = [command for command, there in ((_ROBOTS, apart_ms), (_PLANS, plans)) if not there]
    mend = f"Start with the same settings: {' and '.join(absent)}; if that runs, {same[0].lower()}{same[1:]}"
    found = [Finding("network", "missing" if absent else "ok", told, mend if absent else "")]
    for robot, difference_ms in sorted(apart_ms.items()):
        if abs(difference_ms) > APART_MS:
            text = f"the clock of {robot} is {difference_ms / 1000:+.0f} s from this one"
            found.append(Finding("clocks", "wrong", text, "Let both set their clocks by the network (NTP)."))
    return found
