"""Who is there, by their heartbeats; time is told by hand."""

from __future__ import annotations

import pytest

from parley.agents.presence import LOST_AFTER_S, STARVED_AFTER_S, Presence, linked_to
from parley.clock import WallClock
from parley.messages import ros, topics
from parley.messages.principal import Principal, person
from parley.messages.status import ActorStatus, StopCommand, StopReport
from parley.transport.local import LocalTransport


class ManualClock(WallClock):
    """Wall time moves when the test says so."""

    def __init__(self) -> None:
        self.time_s = 100.0

    def wall_s(self) -> float:
        return self.time_s


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock()


def beat(presence: Presence, *names: str, state: str = "idle") -> None:
    for name in names:
        presence.on_status(ActorStatus.model_validate({"actor": name, "state": state}))


def test_who_beats_is_there(clock: ManualClock) -> None:
    presence = Presence(clock, ("Z",))
    beat(presence, "B", "A")
    assert presence.names() == ("A", "B", "Z")
    assert presence.known_text() == "I know A, B, Z."
    status = presence.get("A")
    assert status is not None
    assert status.actor == "A"
    assert presence.get("Z") is None
    assert presence.is_there("A")
    assert presence.is_there("Z")
    assert not presence.is_there("C")


def test_nobody_is_said_in_a_sentence(clock: ManualClock) -> None:
    assert Presence(clock).known_text() == "No robot is there at the moment."


def test_who_is_silent_for_too_long_is_gone_and_who_beats_is_not(clock: ManualClock) -> None:
    presence = Presence(clock)
    beat(presence, "A", "B")
    clock.time_s += LOST_AFTER_S - 0.1
    beat(presence, "B")
    presence.expire()
    assert presence.names() == ("A", "B")
    clock.time_s += 0.2
    presence.expire()
    assert presence.names() == ("B",)


def test_nobody_is_gone_for_the_time_in_which_nobody_could_be_heard(clock: ManualClock) -> None:
    presence = Presence(clock)
    beat(presence, "A")
    clock.time_s += 3 * LOST_AFTER_S
    presence.expire(late_s=2.5 * LOST_AFTER_S)
    assert presence.names() == ("A",)
    clock.time_s += LOST_AFTER_S / 2 + 0.1
    presence.expire()
    assert presence.names() == ()


def test_lateness_never_counts_as_a_heartbeat_to_come(clock: ManualClock) -> None:
    presence = Presence(clock)
    beat(presence, "A")
    presence.expire(late_s=10 * LOST_AFTER_S)
    clock.time_s += LOST_AFTER_S + 0.1
    presence.expire()
    assert presence.names() == ()


def test_silent_robot_whose_engine_is_still_linked_is_slow_not_gone(clock: ManualClock) -> None:
    linked = {"A"}
    presence = Presence(clock, linked=linked.__contains__)
    beat(presence, "A", "B")
    clock.time_s += LOST_AFTER_S + 0.1
    presence.expire()
    assert presence.names() == ("A",)
    linked.clear()
    presence.expire()
    assert presence.names() == ()


def test_even_a_linked_robot_is_not_waited_for_for_ever(clock: ManualClock) -> None:
    presence = Presence(clock, linked=lambda _: True)
    beat(presence, "A")
    clock.time_s += STARVED_AFTER_S + 0.1
    presence.expire()
    assert presence.names() == ()


async def test_engine_is_linked_as_long_as_it_can_be_asked() -> None:
    async def answer(_: ros.UmrfGraphGetRequest) -> ros.UmrfGraphGetResponse:
        return ros.UmrfGraphGetResponse()

    async with LocalTransport() as transport:
        linked = linked_to(transport)
        server = await transport.serve(topics.actor_graph_get("Ada Two"), answer)
        assert linked("Ada Two") and not linked("Ada")
        await server.close()
        assert not linked("Ada Two")


def test_configured_robot_is_never_gone(clock: ManualClock) -> None:
    presence = Presence(clock, ("Z",))
    clock.time_s += 10 * LOST_AFTER_S
    presence.expire()
    assert presence.names() == ("Z",)


def test_changes_are_told_once_each(clock: ManualClock) -> None:
    seen: list[tuple[str, bool]] = []
    presence = Presence(clock, on_change=lambda name, joined: seen.append((name, joined)))
    beat(presence, "A", "A")
    beat(presence, "A", "A", state="leaving")
    beat(presence, "A")
    clock.time_s += LOST_AFTER_S + 1
    presence.expire()
    presence.expire()
    assert seen == [("A", True), ("A", False), ("A", True), ("A", False)]


def test_newest_status_counts(clock: ManualClock) -> None:
    presence = Presence(clock)
    beat(presence, "A")
    beat(presence, "A", state="running")
    status = presence.get("A")
    assert status is not None
    assert status.state == "running"


@pytest.mark.parametrize("name", ["Ruth", "ruth", " RUTH "])
def test_robot_is_found_whatever_the_capitals(clock: ManualClock, name: str) -> None:
    presence = Presence(clock)
    beat(presence, "Ruth")
    assert presence.resolve(name) == "Ruth"
    assert presence.resolve("Rut") is None


def test_robot_that_left_is_still_meant_but_not_there(clock: ManualClock) -> None:
    presence = Presence(clock)
    beat(presence, "A")
    beat(presence, "A", state="leaving")
    assert presence.resolve("a") == "A"
    assert presence.named_in("A, stop!") == ["A"]
    assert not presence.is_there("A")
    assert presence.names() == ()


def test_leaving_of_somebody_unknown_is_nothing(clock: ManualClock) -> None:
    seen: list[tuple[str, bool]] = []
    presence = Presence(clock, on_change=lambda name, joined: seen.append((name, joined)))
    beat(presence, "A", state="leaving")
    assert seen == []
    assert presence.resolve("A") is None


@pytest.mark.parametrize(
    ("message", "named"),
    [("Ruth, stop!", ["Ruth"]), ("stop both, ruth and A.", ["A", "Ruth"]), ("a truth", ["A"]), ("stop", [])],
)
def test_robots_are_named_by_whole_words(clock: ManualClock, message: str, named: list[str]) -> None:
    presence = Presence(clock)
    beat(presence, "A", "Ruth")
    assert presence.named_in(message) == named


def test_a_stop_counts_before_the_next_heartbeat_says_so(clock: ManualClock) -> None:
    presence = Presence(clock)
    presence.on_status(ActorStatus(actor="A", state="running"))
    presence.on_stop_report(StopReport(actor="A", state="received"))
    status = presence.get("A")
    assert status is not None and status.state == "stopped"


@pytest.mark.parametrize(("graphs", "then"), [({"g": "PAUSED"}, "paused"), ({}, "idle")])
def test_released_robot_is_no_longer_taken_for_a_stopped_one(
    clock: ManualClock, graphs: dict[str, str], then: str
) -> None:
    presence = Presence(clock)
    presence.on_status(ActorStatus(actor="A", state="stopped", graphs=graphs))
    for report in ("at_rest", "reset"):
        presence.on_stop_report(StopReport.model_validate({"actor": "A", "state": report}))
    status = presence.get("A")
    assert status is not None and status.state == then


@pytest.mark.parametrize(
    ("by", "targets", "then"),
    [
        (person(), ("A",), "idle"),
        (person(), (), "idle"),
        (person(), ("B",), "stopped"),
        (None, (), "stopped"),
    ],
)
def test_who_releases_a_stop_may_say_at_once_to_go_on(
    clock: ManualClock, by: Principal | None, targets: tuple[str, ...], then: str
) -> None:
    presence = Presence(clock)
    presence.on_status(ActorStatus(actor="A", state="stopped"))
    presence.on_reset(StopCommand(command="reset", targets=targets, by=by))
    status = presence.get("A")
    assert status is not None and status.state == then
