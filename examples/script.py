"""A robot of your own on an empty floor, told what to do; it needs `pip install 'parley-hri[maps]'`."""

import asyncio

from own_robot import Cart

from parley.api import Parley, Site, person

SITE = Site.floor(6, 4, {"red box": (2.5, 1.5), "door": (5.5, 1.0)})


async def main() -> None:
    async with Parley(SITE, robots=[Cart("Kim")], by=person("Ada")) as parley:
        reply = await parley.say("Kim", "go to the red box")
        print("Kim:", reply.message)
        plan = await parley.settled("Kim", timeout_s=60)
        print([f"{step.label}: {step.state}" for step in plan.steps])


asyncio.run(main())
