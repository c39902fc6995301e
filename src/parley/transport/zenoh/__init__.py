"""The backend for several processes or machines without ROS: Zenoh, with the keys and bytes of rmw_zenoh."""

from parley.transport.zenoh.transport import ZenohTransport

__all__ = ["ZenohTransport"]
