"""A robot without a map, told what to do: `pip install parley-hri`, without any extra, is enough."""

import asyncio

from own_robot import Cart

from parley.api import Parley, person


async def main() -> None:
    async with Parley(robots=[Cart("Kim")], by=person("Ada")) as parley:
        reply = await parley.say("Kim", "turn left by 90 degrees")
        print("Kim:", reply.message)
        plan = await parley.settled("Kim", timeout_s=60)
        print([f"{step.label}: {step.state}" for step in plan.steps])


asyncio.run(main())
