"""The measurement of transports measures messages that came back."""

from __future__ import annotations

from pathlib import Path

from parley.bench.transport import SIZES, TransportFigures, TransportReport, measure_transport
from parley.ros_check import Sourced
from tests.transport.backends import NEEDS_ROS

NO_ROS = Sourced(environ={}, path=(), installed=Path("nowhere"))


def assert_all_came(report: TransportReport, times: int, *backends: str) -> None:
    figures = report.figures
    assert [(one.backend, one.size) for one in figures] == [
        (backend, size) for backend in backends for size in SIZES
    ]
    assert all(len(one.latency_ms) == times and min(one.latency_ms) > 0 and one.lost == 0 for one in figures)
    assert all(one.messages_per_s > 0 for one in figures)


async def test_messages_go_there_and_back_over_each_backend_and_it_says_that_ros_is_not_here() -> None:
    report = await measure_transport(7, NO_ROS)
    assert_all_came(report, 7, "local", "zenoh")
    assert report.rmw == ""
    assert report.without_ros == "Not here; only robots that speak it need it."
    assert [report.to_rclpy(one) for one in report.figures] == [None] * 4


def test_what_is_compared_with_rclpy_is_of_its_size() -> None:
    own = TransportFigures("zenoh", "200_B", (1.0, 2.0, 3.0), 500.0, 0)
    its = TransportFigures("rclpy", "200_B", (4.0, 4.0, 4.0), 250.0, 0)
    large = TransportFigures("rclpy", "1_MB", (40.0,), 10.0, 0)
    report = TransportReport((own, its, large), "rmw_of_test", "")
    compared = report.to_rclpy(own)
    assert compared is not None
    assert (compared.latency, compared.throughput) == (0.5, 2.0)
    assert report.to_rclpy(its) is None


@NEEDS_ROS[0]
@NEEDS_ROS[1]
async def test_where_ros_is_rclpy_itself_is_measured_in_the_same_run() -> None:
    report = await measure_transport(7)
    assert_all_came(report, 7, "local", "zenoh", "ros2", "rclpy")
    assert report.rmw.startswith("rmw_")
    assert report.without_ros == ""
    for one in report.figures:
        assert (report.to_rclpy(one) is None) == (one.backend == "rclpy")
