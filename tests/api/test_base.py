"""What is installed without extras is enough for a robot without a map; what is missing is named."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"
SCRIPT = """
import asyncio
import sys

for library in ("argon2", "fastapi", "mujoco", "pydantic_ai", "scipy", "skimage"):
    sys.modules[library] = None

from own_robot import Cart
from typer.testing import CliRunner

from pathlib import Path

from parley.api import MapObject, MissingExtraError, ObjectMap, Parley, Site, person
from parley.cli import command_line
from parley.doctor import Subject, examine


class Guide(Cart):
    async def go(self, goal, control, *, timeout_s):
        self._pose = goal
        return goal


async def main():
    known = Site(ObjectMap((MapObject("box_1", "red box", 5.0, 1.0, width_m=0.6),)))
    guide = Guide("Kim")  # finds its way by itself
    async with Parley(known, robots=[guide], by=person("Ada")) as parley:
        await parley.say("Kim", "go to the red box")
        plan = await parley.settled("Kim", timeout_s=20)
        print(plan.state, [step.state for step in plan.steps], f"{guide.pose().x_m:.2f}")
    async with Parley(robots=[Cart("Kim")], by=person("Ada")) as parley:
        reply = await parley.say("Kim", "turn left by 90 degrees")
        plan = await parley.settled("Kim", timeout_s=20)
        print(reply.message, [step.state for step in plan.steps])
    for more in ({"world": Site.floor(6, 4)}, {"language": "anthropic:x"}, {"language": "auto:local:x@http://[::1]"}):
        try:
            async with Parley(robots=[Cart("Kim")], **more):
                print("it works")
        except MissingExtraError as error:
            print(error.extra)
    subject = Subject(Path("."), Path("."), 0, language="ollama:x")
    print(*(item.text for item in examine(subject) if item.subject == "language"))


asyncio.run(main())
robot = CliRunner().invoke(command_line(), ["robot", "check", "own_robot.py:Cart", "--yes"])
print(robot.exception)
"""


def test_a_robot_without_a_map_needs_no_extra(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        cwd=EXAMPLES,
        env={"HOME": str(tmp_path), "PYTHONPATH": ":".join(sys.path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.stdout.splitlines() == [
        "idle ['finished', 'finished'] 3.95",
        "I will turn left by 90 degrees. ['finished']",
        "maps",
        "anthropic",
        "openai",
        "what language models need is not installed; to get it: pip install 'parley-hri[openai]'",
        "driving by a map is not installed; to get it: pip install 'parley-hri[maps]'",
    ], done.stderr
