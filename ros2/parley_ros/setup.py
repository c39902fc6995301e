"""Installs the executables, launch files and parameters where ROS looks for them."""

from pathlib import Path

from setuptools import setup

NAME = "parley_ros"
EXECUTABLES = (
    "chat_interface", "umrf_planner", "error_handler", "memory", "display_interface", "nodes", "engine",
    "web",
)  # fmt: skip

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", [str(file) for file in Path("launch").glob("*.launch.py")]),
        (f"share/{NAME}/config", ["config/parley.yaml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="Parley developers",
    maintainer_email="parley@example.org",
    description="Talk to robots: Parley's nodes for ROS 2.",
    license="Apache-2.0",
    entry_points={"console_scripts": [f"{name} = {NAME}.nodes:{name}" for name in EXECUTABLES]},
)
