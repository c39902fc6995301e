"""The demonstration with a second robot, as a process: ``python -m tests.web.e2e.two_robots --data FOLDER``.

A line ``vanish NAME`` on standard input makes that robot fall silent, as if its power had gone;
``propose NAME COUNT`` shows a plan of so many steps that waits for a yes.
"""

from __future__ import annotations

import argparse
import asyncio
import sys
from pathlib import Path

from parley.cli.output import quiet_logs
from parley.cli.web import serve_until_interrupted
from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.messages import topics
from parley.messages.chat import ActionCall
from parley.messages.status import PlanProposal
from parley.messages.wire import to_string
from parley.transport.base import Transport
from parley.web.config import WebConfig
from parley.web.server import WebServer

SECOND = {"Ruth": (7.5, 5.0, 0.0)}
"""Name and place of the second robot: x and y in metres, heading in radians."""


def listen(transport: Transport) -> None:
    """Do what a line on standard input says."""
    match sys.stdin.readline().split():
        case ["vanish", name]:
            [heartbeat] = [task for task in asyncio.all_tasks() if task.get_name() == f"heartbeat {name}"]
            heartbeat.cancel()
        case ["propose", name, count]:
            steps = (ActionCall(name="Inspect"),) * int(count)
            labels = tuple(f"look at box {number}" for number in range(int(count)))
            proposal = PlanProposal(
                id="long", target=name, message="A long round.", steps=steps, labels=labels
            )
            transport.publisher(topics.PLAN).publish(to_string(proposal))


async def main(data: Path, port: int, speed: float) -> None:
    """Serve until interrupted."""
    demo = load_demo("nursing-home")
    story = demo.story.model_copy(update={"robots": SECOND})
    config = SystemConfig(speed=speed, data_dir=data)
    page = WebConfig(port=port, data_dir=data, examples=story.examples, fresh_robots=True)
    async with (
        demo.system_for(story, config) as system,
        WebServer(system.transport, page, stop_line=system.stop_line, at_rest=system.at_rest) as server,
    ):
        asyncio.get_running_loop().add_reader(sys.stdin.fileno(), listen, system.transport)
        await serve_until_interrupted(server, opens=False)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--speed", type=float, default=1.0)
    options = parser.parse_args()
    quiet_logs(False)
    try:
        asyncio.run(main(options.data, options.port, options.speed))
    except KeyboardInterrupt:
        sys.exit(130)
