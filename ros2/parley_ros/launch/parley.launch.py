"""All nodes in one process, and the page in another; robots by `robot.launch.py`.

ros2 launch parley_ros parley.launch.py
ros2 launch parley_ros parley.launch.py without:=memory chat:=false
"""

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "namespace": ("", "before the relative names of all nodes"),
    "config": ("", "file with Parley's settings"),
    "log_level": ("info", "of what is logged: debug, info, warn, error, fatal"),
    "use_respawn": ("false", "whether what crashes is started again, after 2 s"),
    "params_file": ("", "file with parameters of the nodes"),
    "data": ("", "folder for memories, rules and records; empty: kept only while the nodes run"),
    "language": ("builtin", "what understands people: builtin, or provider:model"),
    "without": ("", "nodes that run elsewhere, or not at all: memory,display_interface"),
    "chat": ("true", "whether the page for operators is served"),
    "port": ("8400", "of the page"),
    "lan": ("false", "whether other devices may open the page"),
}


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    """What these arguments ask for."""
    told = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    shared = {name: told[name] for name in ("config", "language") if told[name]}
    files = [told["params_file"]] if told["params_file"] else []

    def part(executable: str, **parameters: object) -> Node:
        if told["data"]:
            parameters["data"] = f"{told['data']}/{executable}"
        return Node(
            package="parley_ros", executable=executable, namespace=told["namespace"], output="screen",
            parameters=[shared, *files, parameters],
            arguments=["--ros-args", "--log-level", told["log_level"]],
            respawn=told["use_respawn"].lower() == "true", respawn_delay=2.0,
        )  # fmt: skip

    found = [part("nodes", without=told["without"])]
    if told["chat"].lower() == "true":
        found.append(part("web", port=int(told["port"]), lan=told["lan"].lower() == "true"))
    return found


def generate_launch_description() -> LaunchDescription:
    """What `ros2 launch` asks for."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
