"""The command line as people and programs use it: what it prints, exit codes, clear errors."""

from __future__ import annotations

import io
import json
import os
import pty
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from parley.cli import command_line, run
from parley.memory.embedding_server import EmbeddingServer
from parley.site import Site
from parley.world.geometry import Pose2D
from parley.world.object_map import MapArea, MapObject, ObjectMap
from parley.world.placed import Placed
from tests.sim.worlds import TWO_ROOMS

DEMO = Path(__file__).parents[1] / "src" / "parley" / "demos" / "nursing_home"


def parley(
    *arguments: str, text: str = "", env: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a command to its end in this process: starting one takes longer than most commands do."""
    out, err = io.StringIO(), io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
        patch.setattr(sys, "argv", ["parley", *arguments])
        patch.setattr(sys, "stdin", io.StringIO(text))
        for name, value in (env or {}).items():
            patch.setenv(name, value)
        try:
            code = run(command_line())
        except SystemExit as leaving:
            code = int(leaving.code or 0)
    return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())


def parley_started(*arguments: str, text: str = "") -> subprocess.CompletedProcess[str]:
    """The same in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "parley", *arguments],
        input=text, capture_output=True, text=True, timeout=100, check=False,
    )  # fmt: skip


def test_script_exits_0_and_every_line_is_json() -> None:
    done = parley_started("demo", "nursing-home", "--script", "--json")
    assert done.returncode == 0, done.stderr
    events = [json.loads(line) for line in done.stdout.splitlines()]
    assert events[-1]["event"] == "story"
    assert events[-1]["held"] is True


def test_script_that_breaks_exits_1_and_says_why() -> None:
    done = parley("demo", "nursing-home", "--script", "--variant", "dead_camera")
    assert done.returncode == 1
    assert "hardware" in done.stderr


def test_memories_of_a_demonstration_are_found_by_meaning_where_a_server_is_named(tmp_path: Path) -> None:
    key = tmp_path / "key"
    key.write_text("sesame")
    with EmbeddingServer(key="sesame") as server:
        named = f"small@{server.address}"
        done = parley(
            "demo", "nursing-home", "--script", "--embeddings", named, "--embeddings-key-file", str(key)
        )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert any("sofa" in text for texts in server.asked for text in texts)
    assert "sesame" not in done.stdout + done.stderr


def test_file_with_settings_is_followed(tmp_path: Path) -> None:
    (tmp_path / "key").write_text("sesame", encoding="utf-8")
    settings = tmp_path / "parley.yaml"
    with EmbeddingServer(key="sesame") as server:
        settings.write_text(
            f"embeddings: {{url: '{server.address}', model: small, key_file: key}}\n"
            "data_dir: data\nmemory: known.db\napproval: ask_first\n",
            encoding="utf-8",
        )
        said = "John is on the sofa.\ngo to the bookshelf\n"
        done = parley("demo", "--terminal", "--config", str(settings), text=said)
    assert done.returncode == 0, done.stderr
    assert any("sofa" in text for texts in server.asked for text in texts)
    assert "Shall I" in done.stdout
    assert (tmp_path / "known.db").is_file() and (tmp_path / "data" / "journal.db").is_file()
    assert not (tmp_path / "data" / "memory.db").exists()


def test_wrong_file_with_settings_is_one_line_and_exit_code_2(tmp_path: Path) -> None:
    settings = tmp_path / "parley.yaml"
    settings.write_text("seed: 1\nmodle: {}\n", encoding="utf-8")
    done = parley("demo", "nursing-home", "--config", str(settings))
    assert done.returncode == 2
    assert done.stderr.splitlines() == ["parley: parley.yaml, line 2: modle: there is no such setting"]


@pytest.mark.parametrize("named", ["small", "@http://localhost", "small@localhost:1"])
def test_server_for_embeddings_is_named_by_model_and_address(named: str) -> None:
    done = parley("demo", "nursing-home", "--script", "--embeddings", named)
    assert done.returncode == 2
    assert "model@address" in done.stderr


def test_unknown_variant_is_named_with_those_that_exist() -> None:
    done = parley("demo", "nursing-home", "--script", "--variant", "flood")
    assert done.returncode == 2
    assert "no_bottle" in done.stderr


@pytest.mark.spec("W9", "W11")
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("demo", "nursing-home", "--script", "--actions", "nowhere"), "no folder"),
        (("demo", "nursing-home", "--ros-args"), "--ros-args"),
        (("demo", "nursing-home", "--robots", "Kim"), "has: David, Ruth"),
        (("demo", "nursing-home", "--script", "--robots", "David"), "--robots does not go with --script"),
        (("graph", "check", "nowhere.json"), "nowhere.json"),
    ],
)
def test_what_is_wrong_at_the_start_is_one_line_and_exit_code_2(
    arguments: tuple[str, ...], words: str
) -> None:
    done = parley(*arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_the_terminal_has_the_robots_that_are_named(tmp_path: Path) -> None:
    said = "what can you do?\n"
    alone = parley("demo", "--terminal", "--data", str(tmp_path), text=said)
    both = parley("demo", "--terminal", "--robots", "David, Ruth", "--data", str(tmp_path), text=said)
    assert "David is here." in alone.stdout and "Ruth" not in alone.stdout
    assert "David is here." in both.stdout and "Ruth is here." in both.stdout


def test_unknown_demo_is_named_with_those_that_exist() -> None:
    done = parley("demo", "moon")
    assert done.returncode == 2
    assert "nursing-home" in done.stderr


def test_chat_over_a_pipe_answers_and_leaves_at_the_end_of_input(tmp_path: Path) -> None:
    done = parley_started(
        "demo", "--terminal", "--data", str(tmp_path), text="John is on the sofa.\nwhere is John?\n"
    )
    assert done.returncode == 0, done.stderr
    assert "sofa" in done.stdout.lower()


def test_a_folder_with_a_world_of_ones_own_is_run(tmp_path: Path) -> None:
    (tmp_path / "world.yaml").write_text(TWO_ROOMS, encoding="utf-8")
    done = parley(
        "demo",
        str(tmp_path),
        "--terminal",
        "--speed",
        "40",
        "--data",
        str(tmp_path / "data"),
        text="go to the green crate\n",
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "I will go to the green crate" in done.stdout
    played = parley("demo", str(tmp_path), "--script")
    assert played.returncode == 2 and "has no story.yaml" in played.stderr


def test_memories_of_a_chat_are_listed_afterwards(tmp_path: Path) -> None:
    parley("demo", "--terminal", "--data", str(tmp_path), text="John is on the sofa.\n")
    listed = parley("memory", "list", "--data", str(tmp_path), "--json")
    assert "John is on the sofa" in json.loads(listed.stdout.splitlines()[0])["data"]


def test_actions_are_listed_with_the_names_of_the_thesis() -> None:
    listed = parley("actions", "list", "--json")
    actions = {item["name"]: item for item in map(json.loads, listed.stdout.splitlines())}
    assert set(actions) > {"GetCoordinates", "NavigateTo", "Inspect", "AskOperator", "KeepPicture"}
    pose = {
        f"pose::{part}::{axis}"
        for part, axes in (("position", "xyz"), ("orientation", "rpy"))
        for axis in axes
    }
    assert set(actions["GetCoordinates"]["inputs"]) == {"target"}
    assert set(actions["GetCoordinates"]["outputs"]) == pose
    assert set(actions["NavigateTo"]["inputs"]) == pose
    assert actions["NavigateTo"]["outputs"] == {}
    assert (set(actions["Inspect"]["inputs"]), set(actions["Inspect"]["outputs"])) == (
        {"inspect"}, {"inspection_result"},
    )  # fmt: skip
    assert (set(actions["AskOperator"]["inputs"]), set(actions["AskOperator"]["outputs"])) == (
        {"question"},
        {"answer"},
    )


def test_show_prints_a_descriptor_and_names_near_misses() -> None:
    shown = json.loads(parley("actions", "show", "Inspect").stdout)
    assert shown["input_parameters"]["inspect"]["pvf_type"] == "string"
    missed = parley("actions", "show", "Inspekt")
    assert missed.returncode == 2
    assert "Inspect" in missed.stderr


def graph(tmp_path: Path, target: str = "bookshelf") -> Path:
    """A graph file that goes somewhere."""
    pose = {
        "pose": {
            "position": {axis: {"pvf_type": "number"} for axis in "xyz"},
            "orientation": {axis: {"pvf_type": "number"} for axis in "rpy"},
        }
    }
    content = {
        "graph_name": "errand",
        "graph_entry": [{"name": "GetCoordinates"}],
        "graph_exit": [{"name": "NavigateTo", "instance_id": 1}],
        "actions": [
            {
                "name": "GetCoordinates", "type": "sync",
                "input_parameters": {"target": {"pvf_type": "string", "pvf_value": target}},
                "output_parameters": pose,
                "children": [{"name": "NavigateTo", "instance_id": 1}],
            },
            {
                "name": "NavigateTo", "instance_id": 1, "type": "sync", "input_parameters": pose,
                "parents": [{"name": "GetCoordinates"}],
            },
        ],
    }  # fmt: skip
    file = tmp_path / "errand.umrf.graph.json"
    file.write_text(json.dumps(content), encoding="utf-8")
    return file


def test_graph_is_checked_and_run(tmp_path: Path) -> None:
    file = graph(tmp_path)
    assert parley("graph", "check", str(file)).returncode == 0
    ran = parley("graph", "run", str(file))
    assert ran.returncode == 0, ran.stderr
    assert "NavigateTo_1: FINISHED" in ran.stdout


def test_graph_that_fails_exits_1(tmp_path: Path) -> None:
    assert parley("graph", "run", str(graph(tmp_path, "swimming pool"))).returncode == 1


def test_wrong_graph_gets_every_problem_with_its_path(tmp_path: Path) -> None:
    file = graph(tmp_path)
    file.write_text(
        file.read_text().replace('"GetCoordinates", "type"', '"GetCoordinate", "type"'), encoding="utf-8"
    )
    done = parley("graph", "check", str(file), "--json")
    assert done.returncode == 1
    problems = [json.loads(line) for line in done.stdout.splitlines()]
    assert any("GetCoordinates" in problem["message"] + problem["remedy"] for problem in problems)


def test_interpret_answers_every_line_and_survives_bad_ones(tmp_path: Path) -> None:
    good = {
        "id": "1",
        "message": "go to the box",
        "objects": [{"id": "b", "description": "box", "x": 1, "y": 2}],
    }
    source, out = tmp_path / "in.jsonl", tmp_path / "out.jsonl"
    source.write_text(f"{json.dumps(good)}\n{{bad\n{json.dumps(good | {'id': '3'})}\n", encoding="utf-8")
    done = parley("interpret", "--situations", str(source), "--out", str(out), "--language", "builtin")
    assert done.returncode == 0, done.stderr
    lines = [json.loads(line) for line in out.read_text().splitlines()]
    assert [line.get("id") for line in lines] == ["1", None, "3"]
    assert [next(iter(item)) for item in lines[0]["output"]["queue"]] == ["GetCoordinates", "NavigateTo"]
    assert "error" in lines[1]


def test_what_people_put_on_a_map_is_an_object_map_for_a_robot(tmp_path: Path) -> None:
    out, folder = tmp_path / "object_map.json", tmp_path / "robot"
    done = parley("places", str(tmp_path), str(out))
    assert done.returncode == 2 and "nobody put anything" in done.stderr
    shelf = MapObject("shelf_1", "shelf", 1.0, 2.0, "place", stand=Pose2D(1.0, 1.0, 1.57))
    bench, hall = MapObject("bench_1", "bench", 3.0, 2.0, "bench"), MapArea("hall", ((0, 0), (4, 0), (4, 3)))
    placed = Placed().changed(None, shelf).changed(None, hall).changed(bench, None)
    told = {"maps": {"home": placed.to_json(), "yard": Placed().to_json()}}
    (tmp_path / "places.json").write_text(json.dumps(told))
    folder.mkdir()
    (folder / "object_map.json").write_text(json.dumps(ObjectMap((bench,)).to_json()))
    done = parley("places", str(tmp_path), str(out), "--site", str(folder))
    assert done.returncode == 2 and "home, yard" in done.stderr
    done = parley("places", str(tmp_path), str(out), "--site", str(folder), "--map", "home")
    assert done.stdout == "home: 1 things, 1 rooms\n"
    out.replace(folder / "object_map.json")
    assert Site.load(folder).objects == ObjectMap((shelf,), (hall,))


def test_world_is_checked_and_wrong_fields_are_named(tmp_path: Path) -> None:
    assert parley("world", "check", str(DEMO / "world.yaml")).returncode == 0
    broken = tmp_path / "world.yaml"
    broken.write_text((DEMO / "world.yaml").read_text().replace("pose: [1.2, 6.58", "poze: [1.2, 6.58"))
    done = parley("world", "check", str(broken))
    assert done.returncode == 2
    assert "world.yaml" in done.stderr
    assert "things[0]" in done.stderr


QUESTIONS = [
    ("people", "remove", "Kim", "--data", "."),
    ("robot", "check", "examples/own_robot.py:Cart"),
]


@pytest.mark.parametrize("words", QUESTIONS, ids=lambda words: words[0])
def test_where_nobody_can_say_yes_a_question_names_the_option_for_it(words: tuple[str, ...]) -> None:
    done = parley(*words)
    assert (done.returncode, "repeat with --yes" in done.stderr) == (2, True)


@pytest.mark.parametrize("answer", [b"n\r", b"\x04"], ids=["no", "Ctrl-D"])
def test_a_question_that_is_not_answered_with_yes_does_nothing(answer: bytes) -> None:
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "parley", *QUESTIONS[1]], stdin=theirs, stdout=theirs, stderr=subprocess.PIPE
    ) as asking:
        while b"[y/N]" not in os.read(ours, 1024):
            pass
        os.write(ours, answer)
        assert asking.communicate(timeout=20)[1].split(b"parley: ")[1:] == [b"nothing was done\n"]
    assert asking.returncode == 1
    os.close(ours)
    os.close(theirs)


def test_maps_and_pictures_of_a_world_are_written_where_one_says(tmp_path: Path) -> None:
    done = parley("world", "map", str(DEMO / "world.yaml"), str(tmp_path / "new" / "maps"))
    assert done.returncode == 0
    assert {file.name for file in (tmp_path / "new" / "maps").iterdir()} == {
        "object_map.json",
        "map.yaml",
        "map.pgm",
    }
    for out, why in (("picture", "let it end in .png"), ("none/picture.png", "cannot be written")):
        done = parley("world", "picture", str(DEMO / "world.yaml"), str(tmp_path / out))
        assert done.returncode == 2
        assert why in done.stderr
        assert "Traceback" not in done.stderr
