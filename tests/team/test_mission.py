"""An order to a team as one: what has become of each part, and a closing line that is true."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from parley.messages.chat import ActionCall
from parley.messages.status import PlanProposal, PlanStep, PlanUpdate
from parley.messages.team import MissionInfo, MissionPart
from parley.sentences import Sentence
from parley.team.mission import MissionBook


class Follower:
    """A book of one mission of Ada and Kim, and how it was closed."""

    def __init__(self) -> None:
        self.closed: list[str] = []
        self.book = MissionBook(self._close)
        parts = [MissionPart(robot=robot, order=robot, lines=(f"see {robot}",)) for robot in ("Ada", "Kim")]
        self.book.begin(MissionInfo(id="m", words="see all", parts=tuple(parts)))

    def _close(self, mission: MissionInfo, text: Sentence) -> str:
        self.closed.append(str(text))
        return str(text)

    def plan(self, robot: str, *steps: PlanStep, state: Any = "running", **more: Any) -> None:
        self.book.on_update(PlanUpdate(target=robot, state=state, steps=steps, **more))

    @property
    def states(self) -> list[str]:
        return [part.state for part in self.book.shown[-1].parts]


def step(robot: str, what: str, state: Any = "queued", action: str = "Look") -> PlanStep:
    return PlanStep(
        action=ActionCall(name=action), id=f"{robot} {what}", label=what, state=state, order=robot
    )


def ended(robot: str, whats: Sequence[str]) -> list[PlanStep]:
    return [step(robot, what, "finished") for what in whats]


def test_a_mission_is_done_when_all_of_all_parts_is() -> None:
    told = Follower()
    told.plan("Ada", step("Ada", "a door", "finished"), step("Ada", "a box", "running"))
    told.plan("Kim", *ended("Kim", ["a desk"]), state="idle")
    ada = told.book.shown[0].parts[0]
    assert (told.states, ada.label, ada.done, ada.count) == (["running", "done"], "a box", 1, 2)
    assert not told.closed
    told.plan("Ada", *ended("Ada", ["a door", "a box"]), state="idle")
    told.plan("Ada", state="idle")  # the next plan begins: what was done stays done
    assert told.closed == ["All of “see all” is done."]


def test_what_was_left_out_dropped_or_refused_is_named_when_it_ends() -> None:
    told = Follower()
    told.plan("Ada", step("Ada", "a door"), step("Ada", "a box"), step("Ada", "a desk"))
    told.plan("Ada", step("Ada", "a door", "skipped"), step("Ada", "a desk", "finished"), state="idle")
    told.book.refuse("Kim")
    assert told.states == ["undone", "refused"]
    (text,) = told.closed
    assert text.startswith("“see all” has ended, and not all of it is done.")
    assert "Ada left out: a door, a box." in text
    assert "Kim had to leave its part: see Kim." in text


def test_who_leaves_something_out_hears_what_and_no_complaint() -> None:
    told = Follower()
    told.plan("Ada", *ended("Ada", ["a door"]), state="idle")
    told.plan("Kim", step("Kim", "a desk"))
    told.plan("Kim", step("Kim", "a desk", "stopped"), state="idle")
    assert told.closed == ["“see all” has ended. Kim left out: a desk."]


def test_what_took_the_place_of_a_failed_step_counts_for_it() -> None:
    told = Follower()
    told.plan("Kim", *ended("Kim", ["a desk"]), state="idle")
    told.plan("Ada", step("Ada", "the box", "failed"), state="held")
    assert told.states == ["held", "done"]
    told.plan("Ada", step("Ada", "the red box", "finished"), state="idle")
    assert told.closed == ["All of “see all” is done."]


def test_a_part_waits_for_a_yes_then_for_others_and_a_no_ends_it() -> None:
    told = Follower()
    told.book.on_proposal(PlanProposal(id="p", target="Kim", order="Kim", lines=("see Kim",)))
    told.plan("Kim", waits=("p",), state="awaiting_approval")
    assert told.states == ["queued", "asked"]
    waiting = PlanStep(action=ActionCall(name="WaitForRobot"), id="w", state="running", order="Kim")
    told.plan("Kim", waiting, step("Kim", "a desk"), waits=())
    assert told.states == ["queued", "waiting"]
    assert told.book.shown[0].parts[1].count == 1  # waiting is no step of the work
    told.plan("Kim", state="idle")
    assert told.states == ["queued", "undone"]


def test_a_part_whose_yes_first_ends_what_went_before_is_not_over() -> None:
    told = Follower()
    told.book.on_proposal(PlanProposal(id="p", target="Kim", order="Kim", lines=("see Kim",)))
    told.plan("Kim", state="idle", waits=())  # what it had to do before is given up
    told.plan("Kim", step("Kim", "a desk", "running"))
    assert told.states == ["queued", "running"]
    told.plan("Ada", *ended("Ada", ["a door"]), state="idle")
    assert not told.closed
    told.plan("Kim", *ended("Kim", ["a desk"]), state="idle")
    assert told.closed == ["All of “see all” is done."]


def test_what_another_robot_takes_over_is_a_part_of_the_same_mission() -> None:
    told = Follower()
    told.plan("Kim", *ended("Kim", ["a desk"]), state="idle")
    told.plan("Ada", step("Ada", "a box", "failed"), state="held")
    assert told.book.relieve("Ada", [MissionPart(robot="Kim", order="more", lines=("a box",))])
    told.plan("Ada", step("Ada", "a box", "stopped"), state="idle")
    told.plan(
        "Kim", PlanStep(action=ActionCall(name="Look"), id="k", state="finished", order="more"), state="idle"
    )
    assert told.states == ["given", "done", "done"]
    assert told.closed == ["All of “see all” is done."]


def test_after_a_restart_nothing_is_claimed_until_it_is_seen_again() -> None:
    told = Follower()
    told.plan("Kim", *ended("Kim", ["a desk"]), state="idle")
    again = Follower()
    again.book.restore(told.book.shown)
    again.plan("Ada", state="idle")
    assert again.states == ["interrupted", "done"]
    again.plan("Ada", step("Ada", "a box", "queued"), state="paused")
    assert again.states == ["paused", "done"]
    assert not again.closed
    again.plan("Ada", *ended("Ada", ["a box"]), state="idle")
    assert again.closed == ["All of “see all” is done."]


def test_how_far_it_is_is_told_of_what_was_asked() -> None:
    told = Follower()
    told.plan("Ada", step("Ada", "a door", "finished"), step("Ada", "the red box", "running"))
    told.plan("Kim", *ended("Kim", ["the blue box"]), state="idle")
    assert str(told.book.progress("the door")) == "Ada has done: a door."
    assert (
        str(told.book.progress("both boxes"))
        == "Ada still has to do: the red box. Kim has done: the blue box."
    )
    assert str(told.book.progress()).startswith("Not all of “see all” is done yet. Ada has done: a door.")
    assert told.book.progress("the gate") is None
    told.plan("Ada", step("Ada", "a door", "finished"), step("Ada", "the red box", "skipped"), state="idle")
    assert str(told.book.progress("both boxes")) == "Ada left out: the red box. Kim has done: the blue box."
    assert str(told.book.progress("everything")).startswith("“see all” has ended. Ada has done: a door.")
    assert told.book.progress("everything", ended=False) is None  # somebody is at something else


def test_of_what_nobody_followed_nothing_is_claimed() -> None:
    told = Follower()
    again = Follower()
    again.book.restore(told.book.shown)
    assert "What has become of the part of Kim is not known." in str(again.book.progress())


def test_of_a_robot_only_the_part_is_found_that_goes_on() -> None:
    told = Follower()
    told.plan("Kim", *ended("Kim", ["a desk"]), state="idle")
    assert told.book.going("Kim") is None
    assert (found := told.book.going("Ada")) is not None
    assert found.order == "Ada"
