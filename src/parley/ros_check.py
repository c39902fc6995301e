"""Whether the ROS 2 of this machine can be used as it is sourced, and what to do if not."""

from __future__ import annotations

import os
import sys
import sysconfig
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Final

from parley.config import Ros2Settings
from parley.errors import ConfigError
from parley.findings import Finding

__all__ = ["Sourced", "examine_ros", "need_ros"]

PACKAGES: Final = ("std_msgs", "sensor_msgs", "temoto_msgs", "nl_interface_msgs")
"""With the messages that Parley's own topics carry."""
DOMAINS: Final = range(233)
_BUILD: Final = "Build the packages in Parley's folder ros2 with colcon, and source install/setup.bash."
_OTHERWISE: Final = "or reach the robot through rosbridge or Zenoh"


@dataclass(frozen=True, slots=True)
class Sourced:
    """What of ROS a process sees."""

    environ: Mapping[str, str] = field(default_factory=lambda: os.environ)
    path: Sequence[str] = field(default_factory=lambda: sys.path)
    """Where Python looks."""
    installed: Path = Path("/opt/ros")
    suffix: str = field(default_factory=lambda: str(sysconfig.get_config_var("EXT_SUFFIX")))
    """How names of compiled modules end that this Python can load."""
    packages: Sequence[str] = PACKAGES
    """Whose messages are needed."""
    domain: int | None = None
    """As the settings say; None: as ROS_DOMAIN_ID does."""
    asked_for: bool = False
    """Whether nothing goes without it."""

    def findings(self) -> Iterator[Finding]:
        """What is wrong, the first thing to mend first, or what is there."""
        distro = self.environ.get("ROS_DISTRO", "")
        rclpy = PathFinder.find_spec("rclpy", list(self.path))
        if rclpy is None:
            yield self._not_sourced()
            return
        places = [Path(place) for place in rclpy.submodule_search_locations or ()]
        built = [file.name for place in places for file in place.glob("_rclpy_pybind11*")]
        if not any(name.endswith(self.suffix) for name in built):
            own = ".".join(map(str, sys.version_info[:2]))
            text = (
                f"It is built for another Python ({', '.join(built) or 'nothing is built'}), this is {own}."
            )
            remedy = f"Install Parley for the Python of {distro or 'this ROS'} (Jazzy: 3.12), {_OTHERWISE}."
            yield Finding("ROS 2", "wrong", text, remedy)
            return
        wrong = [*self._rmw(), *self._domain(), *self._packages()]
        rmw = self.environ.get("RMW_IMPLEMENTATION", "its usual RMW")
        told = f"{distro or 'found'}, {rmw}, domain {self._told_domain()}"
        if self._is_alone():
            told += "; only this machine is seen (ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_LOCALHOST_ONLY)"
        yield from wrong or [Finding("ROS 2", "ok", told)]

    def _is_alone(self) -> bool:
        reach = self.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
        return reach in ("LOCALHOST", "OFF") or self.environ.get("ROS_LOCALHOST_ONLY", "0") == "1"

    def _not_sourced(self) -> Finding:
        found = sorted(self.installed.glob("*/setup.bash"))
        if not found and self.asked_for:
            mend = f"Install ROS 2 (Jazzy or newer) and source its setup.bash, {_OTHERWISE}."
            return Finding("ROS 2", "missing", "It is not on this machine.", mend)
        if not found:
            return Finding("ROS 2", "unused", "Not here; only robots that speak it need it.")
        mend = f"Run: source {found[-1]}"
        return Finding("ROS 2", "missing", "It is installed, but not sourced in this window.", mend)

    def _has(self, kind: str, name: str) -> bool:
        places = filter(None, self.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep))
        return any((Path(at) / "share/ament_index/resource_index" / kind / name).exists() for at in places)

    def _rmw(self) -> Iterator[Finding]:
        wanted = self.environ.get("RMW_IMPLEMENTATION", "")
        if wanted and not self._has("rmw_typesupport", wanted):
            package = f"ros-{self.environ.get('ROS_DISTRO', 'jazzy')}-{wanted.replace('_', '-')}"
            text = f"RMW_IMPLEMENTATION is {wanted}, and that is not installed."
            yield Finding("ROS 2", "wrong", text, f"Run: sudo apt install {package}; or unset it.")

    def _told_domain(self) -> str:
        here = self.environ.get("ROS_DOMAIN_ID") or "0"
        if self.domain is None or str(self.domain) == here:
            return here
        return f"{self.domain} by the settings (ROS_DOMAIN_ID of this window: {here})"

    def _domain(self) -> Iterator[Finding]:
        domain = self.environ.get("ROS_DOMAIN_ID", "") if self.domain is None else ""
        if domain and not (domain.isdecimal() and int(domain) in DOMAINS):
            text = f"ROS_DOMAIN_ID is {domain!r}."
            yield Finding(
                "ROS 2", "wrong", text, f"Set it to a number of at most {DOMAINS[-1]}, or unset it."
            )

    def _packages(self) -> Iterator[Finding]:
        missing = [name for name in self.packages if not self._has("packages", name)]
        if missing:
            text = f"It does not know {', '.join(missing)}."
            yield Finding("ROS 2", "missing", text, _BUILD)


def examine_ros(ros2: Ros2Settings | None = None) -> Iterator[Finding]:
    """Look at the ROS of this process, for settings that ask for it or, None, do not."""
    yield from Sourced(domain=ros2.domain if ros2 else None, asked_for=ros2 is not None).findings()


def need_ros(sourced: Sourced | None = None) -> None:
    """Say clearly that ROS cannot be used, and how to mend it.

    Raises:
        ConfigError: It cannot.
    """
    first = next(iter(replace(sourced or Sourced(), asked_for=True).findings()))
    if first.state != "ok":
        raise ConfigError(f"ROS 2 cannot be used: {first.text} {first.remedy}")
