"""The packages for ROS in `ros2/`: what they define is what goes over our other transports."""

from __future__ import annotations

from pathlib import Path

import pytest

from parley.transport.zenoh.definitions import OWN

PACKAGES = Path(__file__).parents[2] / "ros2"


@pytest.mark.parametrize("package", ["temoto_msgs", "nl_interface_msgs"])
def test_a_package_defines_what_other_transports_send_and_builds_all_of_it(package: str) -> None:
    ours, theirs = ({
        file.relative_to(root).as_posix(): file.read_text(encoding="utf-8")
        for root in (top / package,)
        for file in root.glob("*/*.*")
    } for top in (OWN, PACKAGES))  # fmt: skip
    assert theirs == ours
    built = (PACKAGES / package / "CMakeLists.txt").read_text(encoding="utf-8")
    assert all(f'"{name}"' in built for name in ours)
