"""How long a step has worked, and about when it is done."""

from __future__ import annotations

from parley.messages.status import GraphEvent
from parley.messages.work import Work


def told(at_ms: int, state: str = "", share: float | None = None) -> GraphEvent:
    """A transition, or progress."""
    kind = "node" if state else "progress"
    return GraphEvent(
        actor="A", graph_name="g", sequence=0, kind=kind, state=state, progress=share, unix_ms=at_ms
    )


def test_time_to_go_is_told_from_when_the_robot_got_going_and_without_the_time_it_stood() -> None:
    work = Work()
    for event in (told(1000, "RUNNING"), told(5000, share=0.05), told(6000, share=0.1)):
        work.on_event(event)  # it turned for four seconds
    assert work.left_s(6000) is None, "too early to tell"
    work.on_event(told(7000, "PAUSED"))
    work.on_event(told(60_000, "RUNNING"))
    work.on_event(told(61_000, share=0.35))
    assert work.ms == 6000
    assert work.left_s(61_000) == 6.5
    assert work.left_s(63_000) == 4.5
    assert work.left_s(70_000) is None, "later than thought: nobody knows"


def test_while_it_waits_nobody_knows_how_long_it_takes() -> None:
    work = Work()
    for event in (told(500, "RUNNING"), told(1000, share=0.1), told(2000, share=0.3), told(3000)):
        work.on_event(event)
    assert work.left_s(3000) is None
    for event in (told(9000, share=0.3), told(10_000, share=0.5)):
        work.on_event(event)
    assert work.left_s(10_000) == 2.5
