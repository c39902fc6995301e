"""The engine on its topics: commands in, feedback, events and refusals out."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import Any

import pytest

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.messages import ros, topics
from parley.messages.failure import FailureReport
from parley.messages.status import StepCommand
from parley.messages.wire import to_string
from tests.umrf.spec_actions import CATALOGUE, chain, node, planner_chain

from .rig import DummyRobot, engine_of, rigged


@pytest.mark.spec("D16", "12.2-better", "W4")
async def test_a_graph_runs_and_its_events_come_once_each_in_order() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("JoinText", 0, left="a", right="b"), node("NoOp", 1)]))
        await rig.until_graph("g", "FINISHED")
        assert [item.sequence for item in rig.events] == list(range(len(rig.events)))
        told = [(item.node or "graph", item.state, item.result) for item in rig.events]
        assert told == [
            ("graph", "RUNNING", ""),
            ("JoinText_0", "RUNNING", ""),
            ("JoinText_0", "FINISHED", "on_true"),
            ("NoOp_1", "RUNNING", ""),
            ("NoOp_1", "FINISHED", "on_true"),
            ("graph", "FINISHED", "on_true"),
        ]
        assert rig.events[2].outputs["text"].value == "a-b"


@pytest.mark.spec("12.2-better", "D16", "12.5")
async def test_feedback_ends_with_the_last_state_of_each_graph() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("NoOp", index) for index in range(30)]))
        await rig.until_graph("g", "FINISHED")
        await rig.until(lambda: rig.feedback and rig.last_feedback("g")["graph_state"] == "FINISHED")
        assert len(rig.feedback) < 30, "changes in quick succession are coalesced"
        assert {message.actor for message in rig.feedback} == {"A"}
        assert {item["state"] for item in rig.last_feedback("g")["actions"]} == {"FINISHED"}


async def test_whoever_comes_back_is_told_how_graphs_stand_though_nothing_changes() -> None:
    async with rigged() as rig, engine_of("B", rig) as engine:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]), targets=("B",))
        await rig.until(lambda: rig.last_feedback("g").get("actions", [{}])[0].get("state") == "RUNNING")
        rig.feedback.clear()
        engine.beat()
        await rig.until(lambda: rig.last_feedback("g")["graph_state"] == "RUNNING")


@pytest.mark.spec("12.3", "W7")
async def test_messages_for_others_are_ignored_and_wake_words_are_heard() -> None:
    async with rigged(wake_words=("everybody",)) as rig:
        rig.start(chain("not_ours", [node("NoOp")]), targets=("B",))
        rig.start(chain("no_targets", [node("NoOp")]), targets=())
        rig.start(chain("ours", [node("NoOp")]), targets=("B", "everybody"))
        await rig.until_graph("ours", "FINISHED")
        assert {item.graph_name for item in rig.events} == {"ours"}
        assert not rig.rejections


@pytest.mark.spec("11.3-better", "D17")
async def test_pause_and_resume_are_told_and_a_paused_graph_stands_still() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=0.01), node("NoOp", 1)]))
        await rig.until_graph("g", "RUNNING")
        rig.pause("g")
        await rig.until_graph("g", "PAUSED")
        await rig.until(lambda: rig.last_feedback("g")["graph_state"] == "PAUSED")
        rig.resume("g")
        await rig.until_graph("g", "FINISHED")
        assert rig.graph_states("g") == ["RUNNING", "PAUSED", "RUNNING", "FINISHED"]


@pytest.mark.spec("W1", "12.4", "17")
async def test_the_misspelt_pause_topic_of_the_reference_is_heard() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        rig.transport.publisher(topics.GRAPH_PAUSE_TEMOTO).publish(ros.UmrfGraphPause("g", ("A",)))
        await rig.until_graph("g", "PAUSED")


@pytest.mark.spec("11.2", "8.1")
async def test_stop_ends_stopped() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60), node("NoOp", 1)]))
        await rig.until(lambda: rig.node_states("g", "WaitFor_0"))
        rig.stop("g")
        await rig.until_graph("g", "STOPPED")
        assert rig.node_states("g", "WaitFor_0") == ["RUNNING", "STOPPING", "FINISHED"]
        assert not rig.node_states("g", "NoOp_1")


@pytest.mark.spec("12.6", "D17", "10.3-better")
async def test_a_failure_reaches_clients_as_the_newest_log_line_of_its_node() -> None:
    async with rigged() as rig:
        rig.start(planner_chain("g", [node("Fail", 0, reason="A box is in the way."), node("NoOp", 1)]))
        await rig.until_graph("g", "HALTED")
        [failed] = [item for item in rig.events if item.state == "ERROR"]
        report = FailureReport.parse(failed.message)
        assert (report.message, report.code, report.details) == (
            "A box is in the way.",
            "blocked",
            {"by": "a box"},
        )
        await rig.until(lambda: rig.last_feedback("g")["graph_state"] == "HALTED")
        [shown] = [item for item in rig.last_feedback("g")["actions"] if item["state"] == "ERROR"]
        assert shown["runtime"]["messages"][-1]["message"] == failed.message


@pytest.mark.spec("D13", "11.1-better")
async def test_starting_a_running_graph_again_is_refused_and_the_run_goes_on() -> None:
    async with rigged() as rig:
        graph = chain("g", [node("WaitFor", 0, seconds=60)])
        rig.start(graph)
        rig.start(graph)
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "already_running"
        assert (rig.rejections[0].what, rig.rejections[0].target) == ("umrf_graph_start", "A")
        assert rig.graph_states("g") == ["RUNNING"]


@pytest.mark.spec("D8", "11.1", "11.1-better")
async def test_an_ended_graph_may_be_started_again_and_is_matched_again() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("NoOp", 0)]))
        await rig.until_graph("g", "FINISHED")
        rig.start({"graph_name": "g", "actions": [{"name": "Unknown", "type": "sync"}]})
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "unknown_action"
        rig.start(chain("g", [node("NoOp", 0)]))
        await rig.until(lambda: rig.graph_states("g").count("FINISHED") == 2)


async def test_a_graph_that_was_started_anew_is_silent_about_its_old_run() -> None:
    async with rigged() as rig:
        left_over = {
            "graph_name": "g",
            "graph_entry": [{"name": "NoOp"}, {"name": "WaitFor"}],
            "graph_exit": [{"name": "NoOp"}],
            "actions": [node("NoOp"), node("WaitFor", 0, seconds=60)],
        }
        rig.start(left_over)
        await rig.until_graph("g", "FINISHED")
        seen = len(rig.events)
        rig.start(chain("g", [node("WaitFor", 1, seconds=0.01)]))
        await rig.until(lambda: rig.graph_states("g").count("FINISHED") == 2)
        told = [(item.sequence, item.node, item.state) for item in rig.events[seen:]]
        assert told == [
            (0, "", "RUNNING"),
            (1, "WaitFor_1", "RUNNING"),
            (2, "WaitFor_1", "FINISHED"),
            (3, "", "FINISHED"),
        ]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("{", "malformed"),
        ("[]", "malformed"),
        ("x" * 100_000, "malformed"),
        ('{"graph_name": "g"}', "missing"),
        ('{"graph_name": "g", "graph_entry": 3, "graph_exit": [], "actions": []}', "malformed"),
    ],
)
@pytest.mark.spec("W2", "2", "12.5-better")
async def test_malformed_graphs_are_refused_with_a_reason(text: str, code: str) -> None:
    async with rigged() as rig:
        rig.start(text)
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == code
        assert not rig.events


def fly(instance_id: int) -> dict[str, Any]:
    return {"name": "FlyTo", "instance_id": instance_id, "type": "sync"}


@pytest.mark.parametrize("tells", [True, False])
@pytest.mark.spec("12.5-better", "12.6")
async def test_a_planner_that_reads_only_feedback_is_told_there_what_was_refused(*, tells: bool) -> None:
    async with rigged(foreign_planner=tells) as rig:
        rig.start(planner_chain("g", [node("NoOp"), fly(1)]))
        rig.start("{")
        rig.modify(planner_chain("nowhere", [node("NoOp")]))
        await rig.until(lambda: len(rig.rejections) == 3)
        if not tells:
            assert rig.feedback == []
            return
        at_fault = {"g": ("FlyTo_1", "A has no action 'FlyTo'"), "nowhere": ("NoOp_0", "nowhere")}
        await rig.until(lambda: all(f'"graph_name": "{name}"' in str(rig.feedback) for name in at_fault))
        for name, (step, why) in at_fault.items():
            told = rig.last_feedback(name)
            states = {f"{item['name']}_{item['instance_id']}": item["state"] for item in told["actions"]}
            assert told["graph_state"] == "ERROR"
            assert [full for full, state in states.items() if state == "ERROR"] == [step]
            [failed] = [item for item in told["actions"] if item["state"] == "ERROR"]
            assert why in failed["runtime"]["messages"][-1]["message"]


async def test_what_runs_is_told_to_such_a_planner_as_it_stands_beside_what_was_refused() -> None:
    async with rigged(foreign_planner=True) as rig:
        first = node("WaitFor", 0, seconds=60)
        rig.start(planner_chain("g", [first]))
        await rig.until_graph("g", "RUNNING")
        rig.modify(planner_chain("g", [first, fly(1)]), continue_from="WaitFor_0")
        await rig.until(lambda: "FlyTo" in str(rig.feedback))
        told = rig.last_feedback("g")
        assert told["graph_state"] == "RUNNING"
        assert {item["name"]: item["state"] for item in told["actions"]} == {
            "WaitFor": "RUNNING",
            "FlyTo": "ERROR",
        }


async def test_an_empty_start_names_no_graph_and_is_refused() -> None:
    async with rigged() as rig:
        rig.start("")
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "unknown_graph"


@pytest.mark.parametrize("command", ["pause", "resume", "stop"])
@pytest.mark.spec("11.1", "11.2", "11.3", "11.4", "W2", "12.5-better")
async def test_commands_to_unknown_graphs_are_refused(command: str) -> None:
    async with rigged() as rig:
        getattr(rig, command)("nowhere")
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "unknown_graph"
        assert rig.rejections[0].graph_name == "nowhere"


@pytest.mark.spec("D11", "11.5-better", "W2")
async def test_a_refused_modify_leaves_the_graph_as_it_was() -> None:
    async with rigged() as rig:
        rig.start(planner_chain("g", [node("WaitFor", 0, seconds=60), node("NoOp", 1)]))
        await rig.until_graph("g", "RUNNING")
        rig.modify(planner_chain("g", [node("NoOp", 1)]))
        await rig.until(lambda: rig.rejections)
        assert rig.rejections[0].problems[0].code == "node_active"
        assert rig.graph_states("g") == ["RUNNING"]
        found = await rig.transport.call(topics.actor_graph_get("A"), ros.UmrfGraphGetRequest(), timeout_s=5)
        assert len(json.loads(found.graph_jsons_running[0])["actions"]) == 2


@pytest.mark.spec("11.5", "D1", "17")
async def test_a_modify_appends_to_a_running_graph_without_disturbing_it() -> None:
    async with rigged() as rig:
        first = [node("WaitFor", 0, seconds=0.05)]
        rig.start(planner_chain("g", first))
        await rig.until_graph("g", "RUNNING")
        rig.modify(planner_chain("g", [*first, node("NoOp", 1)]), continue_from="WaitFor_0")
        await rig.until_graph("g", "HALTED")
        assert rig.node_states("g", "WaitFor_0") == ["RUNNING", "FINISHED"]
        assert rig.node_states("g", "NoOp_1") == ["RUNNING", "FINISHED"]


async def test_one_step_can_be_ended_and_the_plan_goes_on_elsewhere() -> None:
    async with rigged() as rig:
        publisher = rig.transport.publisher(topics.STEP)
        rig.start(planner_chain("g", [node("WaitFor", 0, seconds=60), node("NoOp", 1)]))
        await rig.until_graph("g", "RUNNING")
        publisher.publish(to_string(StepCommand(target="B", graph_name="g", node="WaitFor_0")))
        publisher.publish(to_string(StepCommand(target="A", graph_name="g", node="WaitFor_0")))
        await rig.until_graph("g", "HALTED")
        assert rig.node_states("g", "WaitFor_0") == ["RUNNING", "STOPPING", "FINISHED"]
        assert not rig.node_states("g", "NoOp_1")


async def test_unusable_step_commands_are_refused() -> None:
    async with rigged() as rig:
        publisher = rig.transport.publisher(topics.STEP)
        rig.start(planner_chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        publisher.publish(ros.String("{"))
        publisher.publish(to_string(StepCommand(target="A", graph_name="h", node="WaitFor_0")))
        publisher.publish(to_string(StepCommand(target="A", graph_name="g", node="WaitFor_7")))
        await rig.until(lambda: len(rig.rejections) == 3)
        codes = [item.problems[0].code for item in rig.rejections]
        assert codes == ["malformed", "unknown_graph", "unknown_node"]


@pytest.mark.spec("12.4")
async def test_the_query_service_lists_descriptors_and_graphs_under_both_names() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("NoOp", 0)]))
        await rig.until_graph("g", "FINISHED")
        for service in (topics.actor_graph_get("A"), topics.GRAPH_GET):
            found = await rig.transport.call(service, ros.UmrfGraphGetRequest(), timeout_s=5)
            assert "WaitFor" in {json.loads(text)["name"] for text in found.umrf_jsons}
            assert [json.loads(text)["graph_name"] for text in found.graph_jsons_running] == ["g"]


@pytest.mark.spec("11.6")
async def test_old_graphs_are_forgotten() -> None:
    async with rigged() as rig:
        for index in range(30):
            rig.start(chain(f"g{index}", [node("NoOp", 0)]))
            await rig.until_graph(f"g{index}", "FINISHED")
        found = await rig.transport.call(topics.GRAPH_GET, ros.UmrfGraphGetRequest(), timeout_s=5)
        names = [json.loads(text)["graph_name"] for text in found.graph_jsons_running]
        assert len(names) <= 21
        assert names[-1] == "g29"


async def test_status_tells_catalogue_pose_and_state_and_says_goodbye() -> None:
    async with rigged(DummyRobot()) as rig:
        await rig.until(lambda: rig.statuses)
        first = rig.statuses[0]
        assert (first.actor, first.state, first.sequence, first.at_rest) == ("A", "idle", 0, True)
        assert first.pose is not None and first.pose.yaw == 0.5
        assert "WaitFor" in {item.name for item in first.catalogue}
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until(lambda: rig.statuses[-1].state == "running")
        rig.pause("g")
        await rig.until(lambda: rig.statuses[-1].state == "paused")
        assert rig.statuses[-1].graphs == {"g": "PAUSED"}
    assert rig.statuses[-1].state == "leaving"
    assert [item.sequence for item in rig.statuses] == list(range(len(rig.statuses)))


async def test_the_heart_beats_without_any_change() -> None:
    async with rigged(heartbeat_s=0.005) as rig:
        await rig.until(lambda: len(rig.statuses) >= 4)


async def test_progress_is_an_event_but_no_feedback() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("InThread", 0, text="hi")]))
        await rig.until_graph("g", "FINISHED")
        [progress] = [item for item in rig.events if item.kind == "progress"]
        assert (progress.progress, progress.progress_text, progress.node) == (0.5, "half", "InThread_0")


@pytest.mark.spec("11.6")
async def test_closing_stops_what_runs_and_publishes_its_last_state() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
    assert rig.graph_states("g") == ["RUNNING", "STOPPING", "STOPPED"]
    assert rig.last_feedback("g")["graph_state"] == "STOPPED"


@pytest.mark.spec("D27")
async def test_two_engines_share_a_transport() -> None:
    async with (
        rigged() as rig,
        ActionEngine(
            "B",
            transport=rig.transport,
            catalogue=CATALOGUE,
            clock=WallClock(),
            make_context=lambda handle: handle,
        ),
    ):
        rig.start(chain("g", [node("NoOp", 0)]), targets=("A", "B"))
        await rig.until(lambda: rig.graph_states("g").count("FINISHED") == 2)
        await asyncio.sleep(0)
        assert {item.actor for item in rig.events} == {"A", "B"}


@pytest.mark.parametrize(
    "name",
    [
        "a b",
        "ö/ü",
        "a__b__0",
        "..",
        "x" * 5000,
        "two\nlines",
        "'; DROP TABLE run;--",
        "%s {0}",
        "\u202e",
        "💡",
    ],
    ids=lambda name: ascii(name)[:20],
)
async def test_a_graph_may_have_any_name(name: str, tmp_path: Path) -> None:
    async with (
        await Journal.open(tmp_path / "journal.db", WallClock()) as journal,
        rigged(journal=journal) as rig,
    ):
        rig.start(chain(name, [node("NoOp", 0), node("WaitFor", 1, seconds=60.0)]))
        await rig.until_node(name, "WaitFor_1", ["RUNNING"])
        rig.pause(name)
        await rig.until_graph(name, "PAUSED")
        rig.stop(name)
        await rig.until_graph(name, "STOPPED")
        assert rig.rejections == []
        await journal.flush()


async def test_a_graph_of_a_thousand_actions_runs_and_is_stopped_on_its_way() -> None:
    async with rigged() as rig:
        rig.start(chain("bigger", [node("NoOp", index) for index in range(1001)]))
        last = node("WaitFor", 999, seconds=60.0)
        rig.start(chain("big", [*(node("NoOp", index) for index in range(999)), last]))
        async with asyncio.timeout(60):
            while rig.node_states("big", "WaitFor_999") != ["RUNNING"]:  # noqa: ASYNC110 - 2000 events
                await asyncio.sleep(0.1)
        rig.stop("big")
        await rig.until_graph("big", "STOPPED")
        sequences = [event.sequence for event in rig.events if event.graph_name == "big"]
        assert sequences == list(range(len(sequences)))
        assert len(sequences) == 2 * 999 + 6  # each begins and ends; the last stops in between; the graph
        assert [(item.code, item.path) for item in rig.rejections[0].problems] == [("too_large", "actions")]


@pytest.mark.parametrize(
    ("end", "told"), [("", "done"), ("skip", "left"), ("fail", "failed"), ("stop", "left")]
)
async def test_whoever_waits_for_an_order_hears_how_far_it_is(end: str, told: str) -> None:
    async with rigged() as rig:
        lasts = {"": node("NoOp", 1), "fail": node("Fail", 1, reason="a box")}
        graph = planner_chain("g", [node("NoOp", 0), lasts.get(end) or node("WaitFor", 1, seconds=60)])
        for item in graph["actions"]:
            item["gui_attributes"] = {"parley_order": "o"}
        rig.start(graph)
        if end in ("skip", "stop"):
            await rig.until_node("g", "WaitFor_1", ["RUNNING"])
            skip = StepCommand(target="A", graph_name="g", node="WaitFor_1")
            rig.stop("g") if end == "stop" else rig.transport.publisher(topics.STEP).publish(to_string(skip))
        await rig.until(lambda: rig.statuses and rig.statuses[-1].orders == {"o": told})
