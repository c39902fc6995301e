"""Robots whose machine runs rosbridge: ROS 1 and ROS 2 over a websocket, from a machine without ROS."""

from parley.transport.rosbridge.server import RosbridgeServer
from parley.transport.rosbridge.transport import RosbridgeTransport

__all__ = ["RosbridgeServer", "RosbridgeTransport"]
