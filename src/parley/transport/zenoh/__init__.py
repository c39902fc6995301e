"""The backend for several processes or machines without ROS: Zenoh, with the keys and bytes of rmw_zenoh."""

from parley.transport.zenoh.session import ROUTER_PORT, Network
from parley.transport.zenoh.transport import ZenohTransport

__all__ = ["ROUTER_PORT", "Network", "ZenohTransport"]
