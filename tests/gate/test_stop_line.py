"""The line that stops robots: drives first, latched on disk, whatever else is broken."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from parley.errors import ActionFailure, FailureCode
from parley.gate.stop_line import StopLine
from parley.messages.principal import Principal, person
from parley.messages.status import StopCommand

KIM = person("Kim")


class Drive:
    """A robot's end of the line."""

    def __init__(self, line: StopLine, name: str, *, broken: bool = False) -> None:
        self.halted, self.broken = False, broken
        self.commands: list[StopCommand] = []
        self.detach = line.attach(name, halt=self.halt, resume=self.resume, told=self.commands.append)

    def halt(self) -> None:
        if self.broken:
            raise ActionFailure(FailureCode.HARDWARE, "no power")
        self.halted = True

    def resume(self) -> None:
        self.halted = False


def test_a_pull_halts_all_even_if_one_drive_is_broken_and_says_so() -> None:
    line = StopLine()
    broken, ada = Drive(line, "Bob", broken=True), Drive(line, "Ada")
    line.hold(["ada"], id="m", by=None)
    assert (ada.halted, broken.commands) == (True, []), "capitals do not matter"
    outcomes = {item.robot: item for item in line.pull(by=None, id="1", words="stop!!")}
    assert ada.halted
    assert outcomes["Ada"].state == "halted"
    assert (outcomes["Bob"].state, outcomes["Bob"].problem) == ("failed", "no power")
    assert [command.words for command in broken.commands] == ["stop!!"]
    line.pull(by=None, id="1")
    assert len(ada.commands) == 2, "the same stop over another way tells the owner nothing new"


def test_only_a_person_releases_and_nothing_but_the_named() -> None:
    line = StopLine()
    ada, bob = Drive(line, "Ada"), Drive(line, "Bob")
    line.pull(by=KIM)
    engine = Principal(kind="engine", name="model")
    for by in (None, engine, person("Eve", role="viewer"), Principal(kind="program", key="k")):
        assert [problem.code for problem in line.reset(by=by)] == ["reset_refused"]
    assert ada.halted
    assert line.reset(["Ada"], by=KIM) == ()
    assert (ada.halted, bob.halted, line.latched("Ada"), line.latched("Bob")) == (False, True, False, True)


def _fails() -> None:
    raise ActionFailure(FailureCode.HARDWARE, "no power")


def test_a_drive_that_cannot_be_released_stays_latched() -> None:
    line = StopLine()
    line.attach("Ada", halt=lambda: None, resume=_fails, told=lambda _: None)
    line.pull(by=None)
    assert [problem.code for problem in line.reset(by=KIM)] == ["reset_failed"]
    assert line.latched("Ada")


def test_a_robot_that_is_away_is_held_when_it_comes() -> None:
    line = StopLine(robots=["Ada"])
    outcomes = line.pull(["Ada", "Zed"], by=KIM)
    assert {(item.robot, item.state) for item in outcomes} == {("Ada", "absent"), ("Zed", "absent")}
    assert Drive(line, "Ada").halted
    assert Drive(line, "Zed").halted
    assert not Drive(line, "Bob").halted
    line.pull(by=KIM)
    stranger = Drive(line, "Mo")
    assert stranger.halted, "all is all, whoever comes later"
    line.reset(["Ada", "Zed", "Bob", "Mo"], by=KIM)
    assert not Drive(line, "New").halted, "once everybody was released, strangers are free, too"


def test_holds_overlap_and_an_emergency_stop_wins() -> None:
    line = StopLine()
    ada = Drive(line, "Ada")
    line.hold(["Ada"], id="a", by=KIM)
    line.hold(id="b", by=KIM)
    line.go_on("a")
    assert ada.halted
    assert line.held_by("Ada")
    line.go_on("b")
    assert not ada.halted
    line.hold(["Ada"], id="c", by=KIM)
    line.pull(["Ada"], by=None)
    line.go_on("c")
    assert ada.halted
    line.hold(["Ada"], id="d", by=KIM)
    line.reset(["Ada"], by=KIM)
    assert not ada.halted, "a person's release ends a hold whose reader may have died"
    line.go_on("late")
    line.hold(["Ada"], id="late", by=KIM)
    line.hold(["Ada"], id="a", by=KIM)
    assert not ada.halted, "what comes behind its end, or a second time after it, holds nobody"


def test_the_latch_is_on_disk_before_it_is_reported_and_in_doubt_everybody_is_latched(tmp_path: Path) -> None:
    file = tmp_path / "stops.json"
    line = StopLine(file)
    Drive(line, "Ada")
    (outcome,) = line.pull(["Ada"], by=KIM, wait_s=10)
    assert outcome.written
    killed = StopLine(file)  # nothing was closed
    assert killed.latched("Ada")
    assert not killed.latched("Bob")
    killed.close()
    for text in ("", "{", '{"stopped": {"everybody": 0, "names": []}}', '{"stopped": 3}', "[" * 100_000):
        file.write_text(text, encoding="utf-8")
        doubtful = StopLine(file)
        assert doubtful.latched("Bob"), text[:20]
        doubtful.close()
    again = StopLine(file)
    again.reset(by=KIM)
    assert again.written.result(10) == ""
    assert json.loads(file.read_text(encoding="utf-8"))["stopped"] == {"everybody": False, "names": []}


def test_without_room_on_disk_the_robot_is_halted_and_the_next_process_takes_it_for_stopped(
    tmp_path: Path,
) -> None:
    file = tmp_path / "stops.json"
    line = StopLine(file)
    ada = Drive(line, "Ada")
    assert line.written.result(10) == ""
    (tmp_path / "stops.json.new").mkdir()  # nothing new can be written
    (outcome,) = line.pull(["Ada"], by=KIM, wait_s=10)
    assert ada.halted
    assert not outcome.written
    assert line.written.result(10)
    assert StopLine(file).latched("Ada")
    (tmp_path / "stops.json.new").rmdir()
    line.close()  # else it would try again, and say so, while other tests run


async def test_a_blocked_loop_delays_nobody() -> None:
    line = StopLine()
    ada = Drive(line, "Ada")
    pulled = threading.Event()

    def pull() -> None:
        line.pull(by=KIM)
        pulled.set()

    threading.Thread(target=pull).start()
    assert pulled.wait(5), "this blocks the loop on purpose"
    assert ada.halted
    await asyncio.sleep(0)


def test_a_release_that_comes_late_does_not_undo_a_stop_that_it_does_not_know() -> None:
    line = StopLine()
    ada, bob = Drive(line, "Ada"), Drive(line, "Bob")
    line.pull(by=KIM, id="first")
    line.pull(["Ada"], by=KIM, id="second")
    (problem,) = line.reset(by=KIM, id="late", stops=("first",))
    assert (problem.code, "Ada" in problem.message) == ("stopped_since", True)
    assert (ada.halted, bob.halted) == (True, False)
    assert line.in_force("Ada") == "second"
    assert line.reset(["Ada"], by=KIM, id="late", stops=("first",)) == ()  # heard before, and done
    assert ada.halted
    assert line.reset(by=KIM, id="next", stops=("first", "second")) == ()
    assert (ada.halted, line.in_force("Ada")) == (False, "")


@pytest.mark.parametrize("round_", range(3))
def test_a_release_never_undoes_a_later_stop(round_: int) -> None:
    line = StopLine()
    ada = Drive(line, "Ada")

    def come_and_go(name: str) -> None:
        for number in range(300):
            line.hold(id=f"{name}{number}", by=None)
            line.go_on(f"{name}{number}")

    threads = [threading.Thread(target=come_and_go, args=(name,)) for name in "ab"]
    for thread in threads:
        thread.start()
    line.pull(by=KIM)
    for thread in threads:
        thread.join()
    assert ada.halted, round_


def test_a_log_that_cannot_be_written_keeps_no_robot_from_being_halted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("parley.gate.notes.log.error", full, raising=False)
    line = StopLine()
    Drive(line, "Ada", broken=True)
    bob = Drive(line, "Bob")
    line.pull(by=None)
    assert bob.halted


def test_after_kill_9_right_behind_the_report_it_is_latched(tmp_path: Path) -> None:
    file = tmp_path / "stops.json"
    script = """
import os, signal, sys
from pathlib import Path
from parley.gate.stop_line import StopLine
line = StopLine(Path(sys.argv[1]))
line.attach("Ada", halt=lambda: None, resume=lambda: None, told=lambda _: None)
if line.pull(["Ada"], by=None, wait_s=10)[0].written:
    os.kill(os.getpid(), signal.SIGKILL)
"""
    ended = subprocess.run([sys.executable, "-c", script, str(file)], check=False, timeout=60)
    assert ended.returncode == -signal.SIGKILL
    again = StopLine(file)
    assert (again.latched("Ada"), again.latched("Bob")) == (True, False)
    again.close()
