"""What is said about the ROS of a machine, on machines that the tests make; none of them has one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from parley.config import NetworkSettings, Ros2Settings
from parley.doctor import Subject, examine
from parley.errors import ConfigError
from parley.findings import Finding
from parley.ros_check import PACKAGES, Sourced, need_ros

SUFFIX = ".cpython-312-x86_64-linux-gnu.so"

Change = Callable[[Path, dict[str, str]], object]


def machine(root: Path, change: Change = lambda *_: None) -> Sourced:
    """One where ROS is sourced and whole, but for what `change` does to it."""
    prefix = root / "ros" / "jazzy"
    index = prefix / "share/ament_index/resource_index"
    for kind, names in (("packages", PACKAGES), ("rmw_typesupport", ("rmw_fastrtps_cpp",))):
        (index / kind).mkdir(parents=True)
        for name in names:
            (index / kind / name).touch()
    (prefix / "setup.bash").touch()
    rclpy = prefix / "python" / "rclpy"
    rclpy.mkdir(parents=True)
    (rclpy / "__init__.py").touch()
    (rclpy / f"_rclpy_pybind11{SUFFIX}").touch()
    environ = {"ROS_DISTRO": "jazzy", "AMENT_PREFIX_PATH": f"{root / 'ours'}:{prefix}"}
    change(prefix, environ)
    return Sourced(environ, [str(prefix / "python")], root / "ros", SUFFIX)


def without_package(prefix: Path, _: dict[str, str]) -> None:
    (prefix / "share/ament_index/resource_index/packages/temoto_msgs").unlink()


def for_another_python(prefix: Path, _: dict[str, str]) -> None:
    built = prefix / "python/rclpy" / f"_rclpy_pybind11{SUFFIX}"
    built.rename(built.with_name("_rclpy_pybind11.cpython-310-x86_64-linux-gnu.so"))


def not_sourced(prefix: Path, _: dict[str, str]) -> None:
    (prefix / "python").rename(prefix / "lib")


def not_there(prefix: Path, environ: dict[str, str]) -> None:
    not_sourced(prefix, environ)
    (prefix / "setup.bash").unlink()


def with_variable(name: str, value: str) -> Change:
    return lambda _, environ: environ.update({name: value})


@pytest.mark.parametrize(
    ("change", "state", "said", "mend"),
    [
        (not_there, "unused", "Not here", ""),
        (not_sourced, "missing", "not sourced", "jazzy/setup.bash"),
        (for_another_python, "wrong", "cpython-310", "Jazzy: 3.12"),
        (with_variable("RMW_IMPLEMENTATION", "rmw_x_cpp"), "wrong", "rmw_x_cpp", "ros-jazzy-rmw-x-cpp"),
        (with_variable("ROS_DOMAIN_ID", "ward 3"), "wrong", "'ward 3'", "at most 232"),
        (without_package, "missing", "temoto_msgs", "colcon"),
    ],
)
def test_what_is_wrong_is_said_with_how_to_mend_it(
    tmp_path: Path, change: Change, state: str, said: str, mend: str
) -> None:
    here = machine(tmp_path, change)
    (finding,) = here.findings()
    assert (finding.subject, finding.state) == ("ROS 2", state)
    assert said in finding.text
    assert mend in finding.remedy
    with pytest.raises(ConfigError, match="ROS 2 cannot be used"):
        need_ros(here)


def test_where_the_settings_ask_for_a_ros_that_is_not_here_that_is_no_matter_of_taste(
    tmp_path: Path,
) -> None:
    (finding,) = replace(machine(tmp_path, not_there), asked_for=True).findings()
    assert (finding.state, finding.text) == ("missing", "It is not on this machine.")
    assert "rosbridge" in finding.remedy


def test_a_ros_that_can_be_used_is_told_with_its_rmw_and_domain(tmp_path: Path) -> None:
    here = machine(
        tmp_path,
        lambda _, environ: environ.update(RMW_IMPLEMENTATION="rmw_fastrtps_cpp", ROS_DOMAIN_ID="7"),
    )
    (finding,) = here.findings()
    assert (finding.state, finding.text) == ("ok", "jazzy, rmw_fastrtps_cpp, domain 7")
    need_ros(here)


def test_the_domain_of_the_settings_is_told_and_that_of_the_window_beside_it(tmp_path: Path) -> None:
    here = replace(machine(tmp_path, with_variable("ROS_DOMAIN_ID", "7")), domain=42)
    (finding,) = here.findings()
    assert finding.text.endswith("domain 42 by the settings (ROS_DOMAIN_ID of this window: 7)")
    assert next(replace(here, domain=7).findings()).text.endswith("domain 7")


def test_a_window_whose_domain_makes_no_sense_is_no_matter_where_the_settings_name_one(
    tmp_path: Path,
) -> None:
    need_ros(replace(machine(tmp_path, with_variable("ROS_DOMAIN_ID", "ward 3")), domain=42))


def test_doctor_asks_for_the_domain_of_the_settings(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked: list[Ros2Settings | None] = []

    def examine_ros(ros2: Ros2Settings | None) -> tuple[Finding, ...]:
        asked.append(ros2)
        return ()

    monkeypatch.setattr("parley.doctor.examine_ros", examine_ros)
    wanted = Ros2Settings(domain=42)
    for network in (None, NetworkSettings(ros2=wanted)):
        subject = Subject(data_dir=tmp_path, static_dir=tmp_path, port=8690, network=network)
        for finding in examine(subject):
            if finding.subject == "network":
                break
    assert asked == [None, wanted]
