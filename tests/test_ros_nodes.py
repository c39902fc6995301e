"""What the nodes of ROS are told, and the package that starts them; none of it needs ROS."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import structlog

from parley.cli.ros_nodes import NAMES, Parameters
from parley.demos.catalogue import load_demo
from parley.errors import ConfigError

PACKAGE = Path(__file__).parents[1] / "ros2" / "parley_ros"


def test_the_order_on_the_page_is_for_a_robot_of_the_world_that_it_starts() -> None:
    page = (PACKAGE.parents[1] / "docs" / "ros-nodes.md").read_text("utf-8")
    world, name = (
        re.search(r"simulation\.launch\.py world:=(\w+)", page),
        re.search(r'targets\\": \[\\"(\w+)', page),
    )
    assert world and name and name[1] in load_demo(world[1]).everybody


def test_parameters_become_settings_and_those_of_ros_are_passed_over(tmp_path: Path) -> None:
    (tmp_path / "parley.yaml").write_text("approval: ask_first\nnetwork: {domain: 3}\n", encoding="utf-8")
    told = Parameters.told({
        "config": str(tmp_path / "parley.yaml"), "data": str(tmp_path), "actor_name": "Kim, Ada",
        "without": "", "use_sim_time": False,
    })  # fmt: skip
    assert (told.actor_name, told.without) == (("Kim", "Ada"), ())
    settings = told.settings(["--ros-args", "-r", "__ns:=/ward"])
    assert (settings.approval, settings.data_dir) == ("ask_first", tmp_path)
    assert settings.network is not None
    assert settings.network.ros2 is not None
    assert settings.network.ros2.arguments == ("--ros-args", "-r", "__ns:=/ward")
    assert (settings.network.domain, settings.network.rosbridge) == (0, None)


def test_who_asks_for_simulated_time_is_told_that_there_is_none() -> None:
    with structlog.testing.capture_logs() as logged:
        Parameters.told({"use_sim_time": True})
    assert [line["log_level"] for line in logged] == ["warning"]


@pytest.mark.parametrize("file", sorted((PACKAGE / "launch").glob("*.py")), ids=lambda file: str(file.stem))
def test_every_argument_of_a_launch_file_is_described(file: Path) -> None:
    described = file.read_text(encoding="utf-8")
    docs = (PACKAGE.parents[1] / "docs" / "ros-nodes.md").read_text(encoding="utf-8")
    names = re.findall(r'^    "(\w+)": \(', described, re.MULTILINE)
    assert [name for name in names if f"`{name}" not in docs] == []


@pytest.mark.parametrize(("name", "value"), [("worlds", "warehouse"), ("speed", -1.0)])
def test_a_parameter_that_is_unknown_or_wrong_is_refused_by_name(name: str, value: object) -> None:
    with pytest.raises(ConfigError, match=f"parameter {name}: .*robot_class"):
        Parameters.told({name: value})


def test_the_package_has_an_executable_for_each() -> None:
    setup = (PACKAGE / "setup.py").read_text(encoding="utf-8")
    executables = re.search(r"EXECUTABLES = \((.*?)\)", setup, re.DOTALL)
    assert executables is not None
    assert set(re.findall(r'"(\w+)"', executables[1])) == set(NAMES)
    starts = (PACKAGE / "parley_ros" / "nodes.py").read_text(encoding="utf-8")
    assert dict(re.findall(r'^(\w+) = partial\(main, "(\w+)"\)$', starts, re.MULTILINE)) == {
        name: name for name in NAMES
    }
