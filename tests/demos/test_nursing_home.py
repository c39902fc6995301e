"""The demonstration of thesis 5.2.2, whole, and what else operators say in that home."""

from __future__ import annotations

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import Demo, load_demo
from parley.demos.runner import play
from parley.messages import topics
from parley.messages.principal import person
from parley.messages.status import StopCommand
from tests.demos.house import FULL_SPEED, House, running


@pytest.fixture(scope="module")
def demo() -> Demo:
    return load_demo("nursing-home")


@pytest.fixture
async def home(demo: Demo) -> AsyncIterator[House]:
    async with running(demo.system(FULL_SPEED)) as house:
        yield house


async def test_story_holds_and_every_action_ends_finished(demo: Demo, tmp_path: Path) -> None:
    events: list[dict[str, Any]] = []
    config = SystemConfig(speed=None, data_dir=tmp_path)
    result = await play(demo.story, lambda variant: demo.system(config, variant), emit=events.append)
    assert (result.held, result.text) == (True, "The story held.")
    ends = [event for event in events if event["event"] == "transition" and event.get("result")]
    assert [end["node"].partition("_")[0] for end in ends if end["result"] == "on_true"] == [
        "GetCoordinates", "NavigateTo", "Inspect", "AskOperator", "GetCoordinates", "NavigateTo",
    ]  # fmt: skip
    assert [event["code"] for event in events if event["event"] == "failure"] == ["ambiguous"]


@pytest.mark.parametrize(
    "variant", ["no_bottle", "hidden_bottle", "blocked_door", "one_sofa", "nonsense_answers", "dead_camera"]
)
async def test_changed_story_ends_for_its_own_reason(demo: Demo, tmp_path: Path, variant: str) -> None:
    config = SystemConfig(speed=None, data_dir=tmp_path)
    result = await play(demo.story, lambda changed: demo.system(config, changed), variant=variant)
    assert result.reason == demo.story.variant(variant).fails, result.text


@pytest.mark.parametrize(
    ("text", "actions", "object_id"),
    [
        ("Go to both sofas, then to the fridge.", ["GetCoordinates", "NavigateTo"] * 3, "refrigerator_1"),
        ("After the bookshelf, go to the TV", ["GetCoordinates", "NavigateTo"] * 2, "tv_1"),
        (
            "if there is milk in the fridge, go to the TV, otherwise go to the bookshelf",
            ["GetCoordinates", "NavigateTo", "Inspect", *["GetCoordinates", "NavigateTo"] * 2],
            "tv_1",
        ),
        (
            "if there is a box at the TV go to the fridge, if not go to the bookshelf",
            ["GetCoordinates", "NavigateTo", "Inspect", *["GetCoordinates", "NavigateTo"] * 2],
            "bookshelf_1",
        ),
    ],
)
async def test_logic_of_an_order_is_driven(demo: Demo, text: str, actions: list[str], object_id: str) -> None:
    async with running(demo.system(FULL_SPEED)) as home:
        await home.say(text)
        await home.done()
        assert (home.actions(), home.distance_m(object_id) < 1.0) == (actions, True)


async def test_every_variant_is_tested(demo: Demo) -> None:
    marks = test_changed_story_ends_for_its_own_reason.pytestmark  # type: ignore[attr-defined]
    assert set(demo.story.variants) == {*marks[0].args[1], "other_words", "more_words"}


@pytest.mark.parametrize(
    ("text", "object_id"),
    [
        ("Go to the dining table.", "dining_table_1"),
        ("please drive over to the bookshelf", "bookshelf_1"),
        ("Could you move to the TV?", "tv_1"),
        ("I'd like you to go to the small couch", "sofa_small"),
        ("head for the fridge", "refrigerator_1"),
        ("the plant by the bedroom door, go there", "plant_2"),
    ],
)
async def test_going_somewhere_in_many_words(home: House, text: str, object_id: str) -> None:
    await home.say(text)
    assert set(await home.done()) == {"finished"}
    assert home.distance_m(object_id) < 1.0


async def test_checking_on_something_goes_there_and_looks(home: House) -> None:
    await home.say("Could you check whether the plant near the TV is all right?")
    assert set(await home.done()) == {"finished"}
    assert home.actions() == ["GetCoordinates", "NavigateTo", "Inspect"]
    assert home.distance_m("plant_1") < 1.0
    assert ("David", "inspection") in home.observer.feeds


async def test_going_and_coming_back(home: House) -> None:
    start = home.system.robots["David"].pose()
    await home.say("go to the dining table, then come back")
    assert set(await home.done()) == {"finished"}
    assert home.system.robots["David"].pose().distance_to(start) < 0.3


async def test_two_places_in_the_order_of_the_words(home: House) -> None:
    await home.say("After the bookshelf, go to the TV")
    assert set(await home.done()) == {"finished"}
    assert home.distance_m("tv_1") < 1.0


async def test_ambiguous_order_asks_at_once_and_the_follow_up_completes_it(home: House) -> None:
    question = await home.say("go to the sofa")
    assert "small sofa" in question.message
    assert "large sofa" in question.message
    assert home.actions() == []
    await home.say("the large one")
    assert set(await home.done()) == {"finished"}
    assert home.distance_m("sofa_large") < 1.0


async def test_unknown_thing_is_said_to_be_unknown(home: House) -> None:
    reply = await home.say("go to the swimming pool")
    assert "swimming pool" in reply.message
    assert home.actions() == []


async def test_impossible_request_says_what_is_possible_instead(home: House) -> None:
    reply = await home.say("fly to the moon")
    assert home.actions() == []
    assert "can" in reply.message


async def test_what_can_you_do_names_abilities_in_plain_words(home: House) -> None:
    reply = await home.say("what can you do?")
    assert "drive to a place" in reply.message
    assert "GetCoordinates" not in reply.message


async def test_where_is_somebody_comes_from_memory(home: House) -> None:
    assert "know" in (await home.say("where is John?")).message
    await home.say("John is in the bedroom")
    reply = await home.say("where is John?")
    assert "bedroom" in reply.message
    assert reply.sources


async def test_later_fact_wins_and_forgetting_forgets(home: House) -> None:
    await home.say("John is on the large sofa")
    await home.say("John is in the bedroom now")
    assert "bedroom" in (await home.say("where is John?")).message
    await home.say("forget that")
    assert "bedroom" not in (await home.say("where is John?")).message


async def test_what_are_you_doing_tells_the_step(home: House) -> None:
    assert home.actions() == []
    await home.say("go to the dining table")
    await home.state("running")
    reply = await home.say("what are you doing?")
    assert reply.message
    await home.done()


async def test_stop_keeps_the_plan_and_carry_on_finishes_it(demo: Demo) -> None:
    async with running(demo.system(SystemConfig(speed=20))) as home:
        await home.say("go to the fridge")
        await home.state("running")
        await home.say("stop")
        await home.state("paused")
        held = home.system.robots["David"].pose()
        await home.system.clock.sleep(2)
        assert home.system.robots["David"].pose().distance_to(held) < 0.05
        await home.say("carry on")
        assert set(await home.done()) == {"finished"}
        assert home.distance_m("refrigerator_1") < 1.0


async def test_skip_it_goes_on_with_the_next_step(demo: Demo) -> None:
    async with running(demo.system(SystemConfig(speed=20))) as home:
        await home.say("go to the fridge and then to the bookshelf")
        await home.observer.until(lambda: _driving(home), timeout_s=20)
        await home.say("skip it")
        states = await home.done()
        assert sorted(set(states)) == ["finished", "skipped"]
        assert home.distance_m("bookshelf_1") < 1.0


async def test_cancel_everything_forgets_the_plan(demo: Demo) -> None:
    async with running(demo.system(SystemConfig(speed=20))) as home:
        await home.say("go to the fridge and then to the bookshelf")
        await home.observer.until(lambda: _driving(home), timeout_s=20)
        await home.say("cancel everything")
        await home.state("idle")
        await home.say("go to the TV")
        assert set(await home.done()) == {"finished"}
        assert home.distance_m("tv_1") < 1.0


async def test_dropping_a_later_step(demo: Demo) -> None:
    async with running(demo.system(SystemConfig(speed=20))) as home:
        await home.say("inspect the TV and then go to the bookshelf")
        await home.observer.until(lambda: _driving(home), timeout_s=20)
        await home.say("drop the second step")
        await home.done()
        assert "Inspect" not in home.actions()


async def test_emergency_stop_latches_until_it_is_released(demo: Demo) -> None:
    async with running(demo.system(SystemConfig(speed=20))) as home:
        await home.say("go to the fridge")
        await home.observer.until(lambda: _driving(home), timeout_s=20)
        await home.say("emergency stop")
        await home.observer.until(
            lambda: any(report.state == "at_rest" for report in home.observer.stop_reports), timeout_s=20
        )
        assert "Release the stop first" in (await home.say("carry on")).message
        home.observer.publish(topics.STOP, StopCommand(command="reset", by=person("Kim")))
        await home.observer.until(
            lambda: any(report.state == "reset" for report in home.observer.stop_reports), timeout_s=20
        )
        await home.say("carry on")
        assert set(await home.done()) == {"finished"}


def _driving(home: House) -> bool:
    plan = home.observer.plans.get(home.robot)
    return plan is not None and any(
        s.action.name == "NavigateTo" and s.state == "running" for s in plan.steps
    )
