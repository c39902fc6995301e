"""Ctrl-C and SIGTERM end every command in order, at any moment, with 130 and 143."""

from __future__ import annotations

import os
import pty
import random
import signal
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import parley.cli
from parley.memory.folder import held_folder

INT, TERM = signal.SIGINT, signal.SIGTERM
DEMO = ["demo", "nursing-home"]
GRAPH = Path(__file__).parent.parent / "examples" / "graphs" / "visit.graph.json"
WITH_DATA = {
    "script": [*DEMO, "--script", "--speed", "1"],
    "page": [*DEMO, "--no-open", "--port", "0"],
    "terminal": [*DEMO, "--terminal"],
    "prompt": [*DEMO, "--terminal"],
    "memory": ["memory", "list"],
    "audit": ["audit", "show"],
    "people": ["people", "add", "Ada"],
}
COMMANDS = WITH_DATA | {
    "interpret": ["interpret", "--situations", "-"],
    "eval": ["eval", "--set", "development"],
    "graph": ["graph", "run", str(GRAPH), "--timeout", "60"],
    "transcripts": ["transcripts", "nursing-home"],
    "openapi": ["web", "openapi"],
    "doctor": ["doctor"],
    **{f"bench {name}": ["bench", name] for name in ("engine", "memory", "stop", "language", "demo", "web")},
}
ON_TERMINAL = {"prompt", "people"}
ENDS_WITHIN_S = 20
OWN_END = 2
"""How a command ends of itself that finds no database."""
BEGUN = 1 << (TERM - 1)


@contextmanager
def running(name: str, folder: Path) -> Iterator[subprocess.Popen[str]]:
    """A command in a session of its own that has begun; its input is kept open as a person's is."""
    data = ["--data", str(folder)] if name in WITH_DATA else []
    ours, theirs = pty.openpty()
    on_terminal = name in ON_TERMINAL
    process = subprocess.Popen(
        [sys.executable, "-m", "parley", *COMMANDS[name], *data], text=True, start_new_session=True,
        stdin=theirs if on_terminal else subprocess.PIPE,
        stdout=theirs if on_terminal else subprocess.PIPE,
        stderr=subprocess.PIPE,
    )  # fmt: skip
    os.close(theirs)
    if on_terminal:
        threading.Thread(target=drained, args=(ours,), daemon=True).start()
    else:
        os.close(ours)
    with process:
        try:
            while process.poll() is None and not caught(process) & BEGUN:  # until then it is only Python
                time.sleep(0.0005)
            yield process
        finally:
            if process.poll() is None:
                process.kill()


def drained(fd: int) -> None:
    try:
        while os.read(fd, 65536):
            pass
    except OSError:  # nobody has the other end any more
        os.close(fd)


def caught(process: subprocess.Popen[str]) -> int:
    """The signals that it takes care of."""
    text = Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    return next((int(line.split()[1], 16) for line in text.splitlines() if line.startswith("SigCgt")), 0)


def ended(process: subprocess.Popen[str], folder: Path, *codes: int) -> None:
    """It has ended with one of the codes, without a word, and has left nothing behind.

    A signal that comes when Python itself is shutting down ends it by the signal; shells call that the same.
    """
    killer = threading.Timer(ENDS_WITHIN_S, process.kill)
    killer.start()
    output = "" if process.stdout is None else process.stdout.read()
    assert process.stderr is not None
    errors = process.stderr.read().strip()  # a question for a password ends with a space
    process.wait()
    killer.cancel()
    code = process.returncode
    assert (128 - code if code < 0 else code) in codes, (process.args, errors, output[-500:])
    assert errors == "" or (len(codes) > 1 and "Traceback" not in errors), (
        process.args,
        errors,
    )
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)
    with held_folder(folder, unix_ms=0):
        pass


@pytest.mark.parametrize(
    ("name", "sent", "after_s"),
    [
        ("eval", INT, 0.0),
        ("page", INT, 0.05),
        ("memory", TERM, 0.2),
        ("terminal", INT, 1.0),
        ("script", TERM, 2.0),
    ],
)
def test_a_command_ends_at_any_moment(
    tmp_path: Path, name: str, sent: signal.Signals, after_s: float
) -> None:
    with running(name, tmp_path) as process:
        time.sleep(after_s)
        process.send_signal(sent)
        own = (OWN_END,) if name == "memory" else ()  # it may just have said that there is none
        ended(process, tmp_path, 128 + sent, *own)


def test_a_question_for_a_password_leaves_the_terminal_as_it_was() -> None:
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "parley", "people", "add", "Ada", "--data", "."],
        stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True,
    ) as process:  # fmt: skip
        while b"Password" not in os.read(ours, 1024):
            pass
        process.send_signal(INT)
        assert process.wait(ENDS_WITHIN_S) == 130
    assert termios.tcgetattr(theirs)[3] & termios.ECHO
    os.close(ours)
    os.close(theirs)


HEARD_LATE = """
import asyncio, os, signal, threading, time
from parley.cli.on_loop import interruptible, on_loop

def elsewhere():  # it breaks off no call of the main thread, as when it came right before that began
    time.sleep(0.5)
    signal.pthread_kill(threading.get_ident(), signal.{})

def read():
    with interruptible():
        os.read(os.pipe()[0], 1)

threading.Thread(target=elsewhere).start()
{}
"""


@pytest.mark.parametrize("waits", ["read()", "on_loop(asyncio.sleep(60))"])
@pytest.mark.parametrize("sent", [INT, TERM])
def test_a_signal_right_before_a_wait_begins_ends_it_all_the_same(waits: str, sent: signal.Signals) -> None:
    command = [sys.executable, "-c", HEARD_LATE.format(sent.name, waits)]
    assert subprocess.run(command, check=False, timeout=ENDS_WITHIN_S).returncode == 128 + sent


def test_a_command_that_waits_for_input_ends(tmp_path: Path) -> None:
    with running("interpret", tmp_path) as process:
        assert process.stdin is not None and process.stdout is not None
        process.stdin.write("{}\n")
        process.stdin.flush()
        process.stdout.readline()  # it is at work, and waits for the next line
        process.send_signal(INT)
        ended(process, tmp_path, 130)


@pytest.mark.parametrize("sent", [INT, TERM])
def test_a_second_press_cuts_the_closing_not_short(tmp_path: Path, sent: signal.Signals) -> None:
    with running("script", tmp_path) as process:
        assert process.stdout is not None
        process.stdout.readline()
        for _ in range(3):
            process.send_signal(sent)
            time.sleep(0.03)
        ended(process, tmp_path, 128 + sent)


def test_no_command_leaves_its_loop_to_python() -> None:
    files = Path(parley.cli.__file__).parent.glob("*.py")
    assert [file.name for file in files if "asyncio.run(" in file.read_text()] == ["on_loop.py"]


@pytest.mark.soak
@pytest.mark.parametrize("index", range(40))
@pytest.mark.parametrize("again", [False, True])
@pytest.mark.parametrize("sent", [INT, TERM])
def test_every_command_ends_at_any_moment(
    tmp_path: Path, sent: signal.Signals, again: bool, index: int
) -> None:
    chance = random.Random(f"{sent}{again}{index}")
    with running([*COMMANDS][index % len(COMMANDS)], tmp_path) as process:
        time.sleep(chance.choice((chance.uniform(0.0, 0.3), chance.uniform(0.0, 8.0))))
        if process.poll() is None:
            process.send_signal(sent)
            if again:
                time.sleep(chance.uniform(0.0, 0.4))
                process.send_signal(sent)
        # It may just have come to its own end; a signal that comes after the last line ends Python itself.
        ended(process, tmp_path, 128 + sent, -sent, 0, 1, 2)
