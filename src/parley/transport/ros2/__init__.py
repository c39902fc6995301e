"""The ROS 2 of this machine, by its own library: any RMW, and all that ROS people expect of a node."""

from parley.transport.ros2.parameters import parameters
from parley.transport.ros2.transport import Ros2Transport

__all__ = ["Ros2Transport", "parameters"]
