"""One function for each executable."""

from functools import partial

from parley.cli.ros_nodes import main

chat_interface = partial(main, "chat_interface")
umrf_planner = partial(main, "umrf_planner")
error_handler = partial(main, "error_handler")
memory = partial(main, "memory")
display_interface = partial(main, "display_interface")
nodes = partial(main, "nodes")
engine = partial(main, "engine")
web = partial(main, "web")
