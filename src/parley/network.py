"""Where the parts of a system hear each other: in this process, or on a network."""

from __future__ import annotations

from parley.config import SystemConfig
from parley.extras import needs
from parley.ros_check import Sourced, need_ros
from parley.transport.base import Transport
from parley.transport.local import LocalTransport

__all__ = ["transport_of"]


def transport_of(config: SystemConfig, *, node: str = "parley", release: str = "") -> Transport:
    """The transport that these settings name.

    Args:
        config: The settings.
        node: How this process is called in a network; a bridge calls all its clients alike.
        release: Of ROS, whose types count where releases differ; empty: the usual ones.

    Raises:
        MissingExtraError: What the network needs is not installed.
        ConfigError: ROS is not sourced, or not for this Python.
    """
    if config.network is None:
        return LocalTransport()
    if config.network.rosbridge is not None:
        with needs("rosbridge"):
            from parley.transport.rosbridge import RosbridgeTransport
        return RosbridgeTransport(config.network.rosbridge, silence_s=config.network.silence_s)
    if (ros2 := config.network.ros2) is not None:
        need_ros(Sourced(domain=ros2.domain))
        from parley.transport.ros2 import Ros2Transport

        return Ros2Transport(
            node=node, arguments=ros2.arguments, namespace=ros2.namespace, domain=ros2.domain
        )
    with needs("zenoh"):
        from parley.transport.zenoh import ZenohTransport
        from parley.transport.zenoh.definitions import of_release
    return ZenohTransport(config.network, node=node, definitions=(of_release(release),) if release else ())
