"""A page in a real browser, for measuring: Chromium, steered from `frontend/e2e/measure.mjs`.

That is there in a source tree; where the page has not been built or no Chromium is installed it is said what
is missing, and nothing is measured.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import shutil
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from parley.errors import ParleyError

__all__ = ["BrowserFigures", "find_browser", "measure_browser"]

FRONTEND: Final = Path(__file__).parents[3] / "frontend"
CHROMIUMS: Final = ("chromium", "chromium-browser", "google-chrome")
TIMEOUT_S: Final = 120.0
"""What opening the page several times may take, beside the time of watching it."""
_TOLD: Final = 300
"""How many characters of a complaint are worth repeating."""


@dataclass(frozen=True, slots=True)
class BrowserFigures:
    """What a real browser made of the page while the server was under load."""

    files_kb: float
    files_gzip_kb: float
    """As they travel."""
    interactive_ms: tuple[float, ...]
    """From the beginning of each opening until one can write."""
    socket_ms: tuple[float, ...]
    """Wall time from a picture's taking until the browser hands it to the page."""
    painted_ms: tuple[float, ...]
    """The same until it is painted."""
    in_sight: int
    """How many feeds were seen at once; what is out of sight is not painted."""


def find_browser() -> tuple[Path, str]:
    """The npm of the tools, and the browser.

    Raises:
        ParleyError: One of them, or the built page, is not there.
    """
    npm = FRONTEND / "npm"
    if not npm.is_file():
        raise ParleyError("the page's sources are not here, only the built page")
    if not (FRONTEND.parent / "src/parley/web/static/index.html").is_file():
        raise ParleyError("the page is not built: run make page")
    names = [name for name in (os.environ.get("PARLEY_CHROMIUM"), *CHROMIUMS) if name]
    browser = next((found for name in names if (found := shutil.which(name))), None)
    if browser is None:
        raise ParleyError("there is no Chromium: install it, or name it in PARLEY_CHROMIUM")
    return npm, browser


async def measure_browser(address: str, seconds: float, feeds: int) -> BrowserFigures:
    """Open the page several times, then watch `feeds` feeds for so many seconds.

    Args:
        address: Where the page is, with a slash at the end; the last eight bytes of each picture that it
            shows are the nanoseconds of wall time at which it was taken.
        seconds: How long pictures are watched.
        feeds: How many there are; with none nothing is watched.

    Raises:
        ParleyError: No browser can be driven here, or it was and that did not work out; the text says why.
    """
    npm, browser = find_browser()
    process = await asyncio.create_subprocess_exec(
        npm, "run", "--silent", "measure", "--", address, str(seconds), str(feeds),
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        env={**os.environ, "PARLEY_CHROMIUM": browser}, start_new_session=True,
    )  # fmt: skip
    try:
        async with asyncio.timeout(seconds + TIMEOUT_S):
            out, complaints = await process.communicate()
    except TimeoutError:
        raise ParleyError("the browser did not come to an end in time") from None
    finally:
        with contextlib.suppress(ProcessLookupError):  # what it started may still be there
            os.killpg(process.pid, signal.SIGKILL)
        await process.wait()
    if process.returncode:
        raise ParleyError(f"the browser could not measure: {complaints.decode()[-_TOLD:].strip()}")
    found = json.loads(out)
    return BrowserFigures(
        files_kb=found["files_bytes"] / 1000,
        files_gzip_kb=found["files_gzip_bytes"] / 1000,
        interactive_ms=tuple(found["interactive_ms"]),
        socket_ms=tuple(found["socket_ms"]),
        painted_ms=tuple(found["painted_ms"]),
        in_sight=found["in_sight"],
    )
