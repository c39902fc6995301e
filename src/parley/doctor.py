"""What is installed, reachable and missing on this machine, in plain words, and how to get it.

Every check looks at one thing and never changes anything. `needed` things that are missing keep Parley from
working; others only keep one of its uses from working.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import importlib.util
import os
import re
import shutil
import socket
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from urllib.parse import SplitResult, urlsplit

from parley.config import EmbeddingSettings, NetworkSettings
from parley.errors import ConfigError
from parley.extras import model_extra, needs
from parley.findings import Finding
from parley.memory.embedder import configured_embedder
from parley.network_check import examine_network
from parley.robot_check import examine_robot, examine_time
from parley.robots.ros_file import RosRobotFile
from parley.ros_check import examine_ros

__all__ = ["Finding", "Subject", "examine"]

PYTHON: Final = (3, 11)
NODE: Final = (20, 19)
"""What the tools that build the page ask for."""
INSTALL: Final = "Run: pip install --upgrade parley-hri"
FREE_BYTES: Final = 200 * 1024 * 1024
TIMEOUT_S: Final = 3.0
BROWSERS: Final = (
    "xdg-open", "open", "firefox", "chromium", "chromium-browser", "google-chrome", "microsoft-edge",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Subject:
    """What is examined."""

    data_dir: Path
    """Where memories are kept."""
    static_dir: Path
    """Where the built page belongs."""
    port: int
    """Where the page is to be served."""
    language: str = "builtin"
    """`builtin`, `auto`, `provider:model` or `auto:provider:model`."""
    key_file: Path | None = None
    base_url: str = ""
    """Address of the model's server, where it is not in `language`."""
    memory: Path | None = None
    """The file with the memories, if not `memory.db` in `data_dir`."""
    embeddings: EmbeddingSettings | None = None
    network: NetworkSettings | None = None
    robot: RosRobotFile | None = None
    """A robot with ROS that is looked at; nothing is sent to it."""
    robot_name: str = "robot"


def examine(subject: Subject) -> Iterable[Finding]:
    """Check everything, one finding after the other."""
    checks: tuple[Callable[[Subject], Finding], ...] = (
        _python, _packages, _simulator, _server, _page, _browser, _node, _port, _folder, _space, _memory,
        _language, _embeddings, _zenoh,
    )  # fmt: skip
    for check in checks:
        yield check(subject)
    yield from examine_ros(subject.network.ros2 if subject.network is not None else None)
    yield from examine_network(subject.network)
    yield examine_time()
    if subject.robot is not None:
        yield from examine_robot(subject.robot, subject.robot_name, subject.network)


def _python(_: Subject) -> Finding:
    version = ".".join(map(str, sys.version_info[:3]))
    if sys.version_info[:2] >= PYTHON:
        return Finding("Python", "ok", version, needed=True)
    return Finding("Python", "wrong", version, "Install Python 3.11 or newer.", needed=True)


def _packages(_: Subject) -> Finding:
    """Whether everything that this version asks for is installed; optional extras do not count."""
    try:
        wanted = importlib.metadata.requires("parley-hri") or []
    except importlib.metadata.PackageNotFoundError:
        return Finding("packages", "missing", "Parley itself is not installed.", INSTALL, needed=True)
    names = [re.split(r"[^A-Za-z0-9._-]", item, maxsplit=1)[0] for item in wanted if "extra ==" not in item]
    absent = sorted(name for name in names if not _installed(name))
    if absent:
        return Finding("packages", "missing", f"Not installed: {', '.join(absent)}.", INSTALL, needed=True)
    return Finding("packages", "ok", f"all {len(names)} are installed", needed=True)


def _simulator(_: Subject) -> Finding:
    return _extra("sim", "simulator", "mujoco", "Not here; only simulated worlds need it.")


def _server(_: Subject) -> Finding:
    return _extra("web", "page server", "uvicorn", "Not here; only the page needs it.")


def _extra(extra: str, subject: str, module: str, text: str) -> Finding:
    """Whether something is there that is installed on its own."""
    if importlib.util.find_spec(module) is not None:
        return Finding(subject, "ok", "installed")
    return Finding(subject, "unused", text, f"Run: pip install 'parley-hri[{extra}]'")


def _installed(name: str) -> bool:
    try:
        importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


def _page(subject: Subject) -> Finding:
    if (subject.static_dir / "index.html").is_file():
        return Finding("page", "ok", "built")
    if importlib.util.find_spec("uvicorn") is None:
        return Finding("page", "unused", "Not here; nothing would serve it.")
    return Finding(
        "page",
        "missing",
        "It is not built.",
        "Install a released version, or run make page in the sources; or chat with --terminal.",
    )


def _browser(_: Subject) -> Finding:
    found = next((name for name in BROWSERS if shutil.which(name)), None)
    if found is not None or sys.platform in ("darwin", "win32"):
        return Finding("browser", "ok", found or "the system's own")
    return Finding(
        "browser",
        "unused",
        "None was found here.",
        "Open the page from another device (--lan), or use --terminal.",
    )


def _node(_: Subject) -> Finding:
    program = shutil.which("node")
    if program is None:
        return Finding(
            "Node.js", "unused", "Not installed; only building the page needs it, and fetches its own."
        )
    try:
        told = subprocess.run(
            [program, "--version"], capture_output=True, text=True, timeout=TIMEOUT_S, check=True
        ).stdout.strip()
    except (OSError, subprocess.SubprocessError) as error:
        return Finding("Node.js", "wrong", f"It does not start: {error}.", "Install it anew, or remove it.")
    numbers = tuple(int(part) for part in re.findall(r"\d+", told)[:2])
    if numbers >= NODE:
        return Finding("Node.js", "ok", told.removeprefix("v"))
    return Finding("Node.js", "unused", f"{told} is too old to build the page, which fetches its own.")


def _port(subject: Subject) -> Finding:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as end:
        end.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            end.bind(("127.0.0.1", subject.port))
        except OSError as error:
            return Finding(
                "port", "wrong", f"{subject.port} cannot be used: {error.strerror}.",
                "Perhaps Parley runs already. Another one is taken by itself, or name one with --port.",
            )  # fmt: skip
    return Finding("port", "ok", f"{subject.port} is free")


def _folder(subject: Subject) -> Finding:
    there = _nearest(subject.data_dir)
    if not there.is_dir():
        return Finding(
            "data folder", "wrong", f"{there} is a file.",
            "Move it away, or choose another folder with --data.", needed=True,
        )  # fmt: skip
    if os.access(there, os.W_OK | os.X_OK):
        new = "" if there == subject.data_dir else ", will be made"
        return Finding("data folder", "ok", f"{subject.data_dir}{new}", needed=True)
    return Finding(
        "data folder", "wrong", f"{there} cannot be written to.",
        "Give yourself the right to write there, or choose another folder with --data.", needed=True,
    )  # fmt: skip


def _space(subject: Subject) -> Finding:
    free = shutil.disk_usage(_nearest(subject.data_dir)).free
    text = f"{free / 2**30:.1f} GiB free"
    if free >= FREE_BYTES:
        return Finding("disk", "ok", text, needed=True)
    return Finding("disk", "wrong", text, "Make room: memories and pictures need some.", needed=True)


def _nearest(path: Path) -> Path:
    """The path itself, or the nearest one above it that exists."""
    return next((place for place in (path, *path.parents) if place.exists()), Path("/"))


def _memory(subject: Subject) -> Finding:
    """Whether the memory file is whole; it is only read."""
    file = subject.memory or subject.data_dir / "memory.db"
    if not file.is_file():
        return Finding("memory", "ok", "nothing is remembered yet")
    try:
        address = f"{file.resolve().as_uri()}?mode=ro"
        with contextlib.closing(sqlite3.connect(address, uri=True, timeout=TIMEOUT_S)) as db:
            told = db.execute("PRAGMA quick_check(1)").fetchone()[0]
            count = db.execute("SELECT count(*) FROM memory WHERE ended_unix_ms IS NULL").fetchone()[0]
    except sqlite3.Error as error:
        told, count = str(error), 0
    if told == "ok":
        return Finding("memory", "ok", f"{count} remembered")
    return Finding(
        "memory", "wrong", f"{file.name} is damaged: {told}.",
        "Put a copy back that you kept; else it is put aside at the next start, and a new one is begun.",
    )  # fmt: skip


def _language(subject: Subject) -> Finding:
    if subject.language in ("auto", "builtin"):
        return Finding("language", "ok", "built in; needs no model, key or network")
    try:
        with needs(model_extra(subject.language)):
            from parley.language.llm.models import ModelSpec, make_model, read_key
        spec = ModelSpec.parse(subject.language.removeprefix("auto:"), subject.base_url)
        model = make_model(spec, read_key(subject.key_file))
    except ConfigError as error:
        return Finding("language", "missing", str(error), "Or use --language builtin.", needed=True)
    address = urlsplit(spec.base_url or str(getattr(model, "base_url", "") or ""))
    if not address.hostname:
        return Finding("language", "ok", f"{spec.name}; its address is not known here", needed=True)
    place, problem = _listens(address)
    if problem:
        return Finding(
            "language", "wrong", f"{spec.name}: nobody answers at {place} ({problem}).",
            "Start the server or check the network. Until then what is built in answers.",
        )  # fmt: skip
    return Finding("language", "ok", f"{spec.name} at {place}", needed=True)


def _listens(address: SplitResult) -> tuple[str, str]:
    """Host and port of an address, and why nobody can be reached there; empty if somebody can."""
    port = address.port or (443 if address.scheme == "https" else 80)
    place = f"{address.hostname}:{port}"
    try:
        socket.create_connection((address.hostname or "", port), timeout=TIMEOUT_S).close()
    except OSError as error:
        return place, str(error)
    return place, ""


def _embeddings(subject: Subject) -> Finding:
    settings = subject.embeddings
    if settings is None:
        return Finding("embeddings", "unused", "Memories are found by their words.")
    try:
        configured_embedder(settings)
        place, problem = _listens(urlsplit(settings.url))
    except (ConfigError, ValueError) as error:
        return Finding("embeddings", "wrong", str(error), "Mend the settings.", needed=True)
    if problem:
        return Finding(
            "embeddings", "wrong", f"{settings.model}: nobody answers at {place} ({problem}).",
            "Start the server or check the network. Until then memories are found by their words.",
        )  # fmt: skip
    return Finding("embeddings", "ok", f"{settings.model} at {place}")


def _zenoh(_: Subject) -> Finding:
    return _extra("zenoh", "Zenoh", "zenoh", "Not here; only several machines without ROS need it.")
