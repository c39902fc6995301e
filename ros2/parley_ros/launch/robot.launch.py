"""A robot with its engine, on the robot or beside it; or several in one process.

ros2 launch parley_ros robot.launch.py actor_name:=Kim robot_class:=robots.py:Kim
ros2 launch parley_ros robot.launch.py actor_name:=Kim,Ada robot_class:=robots.py:Kim
"""

from launch import LaunchContext, LaunchDescription, LaunchDescriptionEntity
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    "namespace": ("", "before the relative names of all nodes; the same as theirs"),
    "actor_name": ("", "what people call the robot, or robots: Kim,Ada; empty: all of the world"),
    "robot_class": ("", "MODULE:CLASS or FILE.py:CLASS of a robot of your own; empty: simulated"),
    "world": ("", "where it is: a folder with maps, or a demonstration by name"),
    "actions_path": ("", "folder with more actions"),
    "speed": ("1.0", "simulated seconds per second"),
    "config": ("", "file with Parley's settings"),
    "data": ("", "folder for what the robot does and finds; empty: kept only while it runs"),
}


def start(context: LaunchContext) -> list[LaunchDescriptionEntity]:
    """What these arguments ask for."""
    told = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    parameters = {name: told[name] for name in ARGUMENTS if name not in ("namespace", "speed") and told[name]}
    return [
        Node(
            package="parley_ros",
            executable="engine",
            namespace=told["namespace"],
            output="screen",
            parameters=[parameters | {"speed": float(told["speed"])}],
        )
    ]


def generate_launch_description() -> LaunchDescription:
    """What `ros2 launch` asks for."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, (default, text) in ARGUMENTS.items()
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=start)])
