"""All nodes and the robots of a simulated world.

ros2 launch parley_ros simulation.launch.py world:=parking
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """What `ros2 launch` asks for; the arguments of both files are taken too."""

    def also(file: str, **arguments: object) -> IncludeLaunchDescription:
        path = PathJoinSubstitution([FindPackageShare("parley_ros"), "launch", file])
        return IncludeLaunchDescription(path, launch_arguments=list(arguments.items()))

    return LaunchDescription(
        [
            DeclareLaunchArgument("world", default_value="warehouse", description="a folder, or one by name"),
            also("parley.launch.py"),
            also("robot.launch.py", world=LaunchConfiguration("world")),
        ]
    )
