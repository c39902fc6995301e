"""`parley doctor` on machines that the tests make: it says what is wrong, and changes nothing."""

from __future__ import annotations

import ast
import importlib.util
import json
import os
import re
import socket
import sqlite3
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

import parley
from parley.cli import command_line
from parley.config import EmbeddingSettings
from parley.doctor import Finding, Subject, examine
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry


def free_port() -> int:
    with socket.socket() as end:
        end.bind(("127.0.0.1", 0))
        return int(end.getsockname()[1])


@pytest.fixture
def machine(tmp_path: Path) -> Subject:
    static = tmp_path / "static"
    static.mkdir()
    (static / "index.html").write_text("<!doctype html>", encoding="utf-8")
    return Subject(data_dir=tmp_path / "data" / "home", static_dir=static, port=free_port())


def found(machine: Subject, subject: str) -> Finding:
    return next(finding for finding in examine(machine) if finding.subject == subject)


def test_a_machine_that_has_everything_needed_is_not_hindered(machine: Subject) -> None:
    findings = list(examine(machine))
    assert [finding for finding in findings if finding.hinders] == []
    assert all(finding.remedy for finding in findings if finding.state in ("missing", "wrong"))
    assert not machine.data_dir.exists(), "looking changes nothing"


def test_whatever_can_be_found_wrong_is_told_with_how_to_mend_it() -> None:
    calls = [
        call
        for file in (Path(parley.__file__).parent).glob("*.py")
        for call in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "Finding"
    ]
    wrong = [
        call
        for call in calls
        if {"'missing'", "'wrong'"} & set(re.findall(r"'\w+'", ast.unparse(call.args[1])))
    ]
    assert len(wrong) > 20
    assert [ast.unparse(call) for call in wrong if len(call.args) < 4] == []


def test_a_page_that_is_not_built_is_missing_but_the_terminal_works(machine: Subject) -> None:
    (machine.static_dir / "index.html").unlink()
    page = found(machine, "page")
    assert (page.state, page.hinders) == ("missing", False)
    assert "--terminal" in page.remedy


def test_a_page_that_nothing_would_serve_is_not_missing(
    machine: Subject, monkeypatch: pytest.MonkeyPatch
) -> None:
    (machine.static_dir / "index.html").unlink()
    real = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "uvicorn" else real(name))
    assert found(machine, "page").state == "unused"


def test_a_port_in_use_is_named(machine: Subject) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = found(replace(machine, port=taken.getsockname()[1]), "port")
    assert port.state == "wrong"
    assert "--port" in port.remedy


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write everywhere")
def test_a_folder_without_the_right_to_write_hinders(machine: Subject) -> None:
    machine.data_dir.mkdir(parents=True)
    machine.data_dir.chmod(0o500)
    folder = found(machine, "data folder")
    assert (folder.state, folder.hinders) == ("wrong", True)


def test_a_file_where_the_folder_should_be_hinders(machine: Subject) -> None:
    machine.data_dir.parent.write_text("", encoding="utf-8")
    folder = found(machine, "data folder")
    assert (folder.state, folder.hinders) == ("wrong", True)


async def test_a_whole_memory_file_is_counted(machine: Subject) -> None:
    machine.data_dir.mkdir(parents=True)
    async with await MemoryStore.open(machine.data_dir / "memory.db") as store:
        await store.add(MemoryEntry(name="box", data="by the door"))
        assert found(machine, "memory").text == "1 remembered"


def test_a_damaged_memory_file_is_told_and_left_as_it_is(machine: Subject) -> None:
    machine.data_dir.mkdir(parents=True)
    file = machine.data_dir / "memory.db"
    file.write_bytes(b"no database" * 100)
    memory = found(machine, "memory")
    assert (memory.state, memory.hinders) == ("wrong", False)
    assert file.read_bytes() == b"no database" * 100


def test_a_database_of_somebody_else_is_told(machine: Subject) -> None:
    machine.data_dir.mkdir(parents=True)
    with sqlite3.connect(machine.data_dir / "memory.db") as db:
        db.execute("CREATE TABLE other (x)")
    db.close()
    assert found(machine, "memory").state == "wrong"


def test_without_node_the_page_can_still_be_built(machine: Subject, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    node = found(machine, "Node.js")
    assert (node.state, node.hinders) == ("unused", False)


@pytest.mark.parametrize(
    ("version", "state"), [("v20.19.0", "ok"), ("v24.1.0", "ok"), ("v18.20.1", "unused")]
)
@pytest.mark.skipif(sys.platform == "win32", reason="a shell script stands for Node.js")
def test_an_old_node_is_told(
    machine: Subject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, version: str, state: str
) -> None:
    node = tmp_path / "node"
    node.write_text(f"#!/bin/sh\necho {version}\n", encoding="utf-8")
    node.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    assert found(machine, "Node.js").state == state


def test_a_model_server_that_is_away_is_told_and_does_not_hinder(machine: Subject) -> None:
    server = f"local:some-model@http://127.0.0.1:{free_port()}/v1"
    language = found(replace(machine, language=server), "language")
    assert (language.state, language.hinders) == ("wrong", False)
    assert "127.0.0.1" in language.text


def test_a_model_server_that_listens_is_ok(machine: Subject) -> None:
    with socket.socket() as server:
        server.bind(("127.0.0.1", 0))
        server.listen()
        name = f"local:some-model@http://127.0.0.1:{server.getsockname()[1]}/v1"
        assert found(replace(machine, language=name), "language").state == "ok"


def test_a_model_without_its_key_hinders_and_the_remedy_names_what_works_without(machine: Subject) -> None:
    language = found(replace(machine, language="nobody:model"), "language")
    assert (language.state, language.hinders) == ("missing", True)
    assert "--language builtin" in language.remedy


def test_the_exit_code_says_whether_something_needed_is_missing(tmp_path: Path) -> None:
    runner = CliRunner()
    port = str(free_port())
    well = runner.invoke(command_line(), ["doctor", "--json", "--data", str(tmp_path), "--port", port])
    assert well.exit_code == 0
    assert {json.loads(line)["subject"] for line in well.stdout.splitlines()} >= {"Python", "page", "memory"}
    (tmp_path / "file").write_text("", encoding="utf-8")
    ill = runner.invoke(command_line(), ["doctor", "--data", str(tmp_path / "file"), "--port", port])
    assert ill.exit_code == 1
    assert "✗ data folder" in ill.stdout


def test_settings_are_read_and_what_they_name_is_looked_for(tmp_path: Path) -> None:
    settings = tmp_path / "parley.yaml"
    nobody = free_port()
    settings.write_text(
        f"language: local:some@http://127.0.0.1:{nobody}/v1\ndata_dir: data\n"
        f"embeddings: {{url: 'http://127.0.0.1:{nobody}', model: small}}\n",
        encoding="utf-8",
    )
    runner, port = CliRunner(), str(free_port())
    told = runner.invoke(command_line(), ["doctor", "--json", "--config", str(settings), "--port", port])
    findings = {line["subject"]: line for line in map(json.loads, told.stdout.splitlines())}
    assert findings["settings"]["state"] == "ok"
    assert str(tmp_path / "data") in findings["data folder"]["text"]
    for subject in ("language", "embeddings"):
        assert (findings[subject]["state"], str(nobody) in findings[subject]["text"]) == ("wrong", True)
    settings.write_text("langauge: builtin\n", encoding="utf-8")
    broken = runner.invoke(command_line(), ["doctor", "--config", str(settings), "--port", port])
    assert broken.exit_code == 1
    assert "line 1: langauge: there is no such setting" in broken.stdout


def test_embeddings_without_their_key_file_hinder(machine: Subject, tmp_path: Path) -> None:
    gone = EmbeddingSettings(url="http://127.0.0.1:1", model="m", key_file=tmp_path / "gone")
    finding = found(replace(machine, embeddings=gone), "embeddings")
    assert (finding.state, finding.hinders) == ("wrong", True)
    assert found(machine, "embeddings").state == "unused"
