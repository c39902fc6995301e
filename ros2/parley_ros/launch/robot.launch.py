"""A robot with its engine, on the robot or beside it; or several in one process.

ros2 launch parley_ros robot.launch.py actor_name:=Kim robot_class:=robots.py:Kim
ros2 launch parley_ros robot.launch.py actor_name:=Kim,Ada robot_class:=nav2.yaml
"""

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "namespace": ("", "before the relative names of all nodes; the same as theirs"),
    "actor_name": ("", "what people call the robot, or robots: Kim,Ada; empty: all of the world"),
    "robot_class": ("", "FILE.yaml of robots with Nav2, or FILE.py:CLASS, MODULE:CLASS; empty: simulated"),
    "world": ("", "where it is: a folder with maps, or a demonstration by name"),
    "actions_path": ("", "folder with more actions"),
    "speed": ("1.0", "simulated seconds per second"),
    "config": ("", "file with Parley's settings"),
    "log_level": ("info", "of what is logged: debug, info, warn, error, fatal"),
    "use_respawn": ("false", "whether what crashes is started again, after 2 s"),
    "data": ("", "folder for what the robot does and finds; empty: kept only while it runs"),
}


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    """What these arguments ask for."""
    told = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    of_launch = ("namespace", "speed", "log_level", "use_respawn")
    parameters = {name: told[name] for name in ARGUMENTS if name not in of_launch and told[name]}
    return [
        Node(
            package="parley_ros",
            executable="engine",
            namespace=told["namespace"],
            output="screen",
            parameters=[parameters | {"speed": float(told["speed"])}],
            arguments=["--ros-args", "--log-level", told["log_level"]],
            respawn=told["use_respawn"].lower() == "true",
            respawn_delay=2.0,
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """What `ros2 launch` asks for."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
