"""A robot that runs Nav2, told what to do through the rosbridge on it."""

import asyncio

from parley.api import DriveLimits, Nav2Robot, Nav2Setup, Parley, RosTopics, Site, person

SITE = Site.floor(6, 4, {"red box": (1.8, 1.0), "door": (5.2, 1.0)})
SETUP = Nav2Setup(
    release="jazzy",
    topics=RosTopics(base_frame="base_link", camera="camera/image_raw/compressed"),
    radius_m=0.22,
    limits=DriveLimits(max_speed_mps=0.26, max_turn_radps=1.8),
)


def robot(name: str) -> Nav2Robot:
    return Nav2Robot(name, "ws://127.0.0.1:9090", SETUP)


async def main() -> None:
    async with Parley(SITE, robots=[robot("Kim")], by=person("Ada")) as parley:
        reply = await parley.say("Kim", "go to the red box")
        print("Kim:", reply.message)
        plan = await parley.settled("Kim", timeout_s=120)
        print([f"{step.label}: {step.state}" for step in plan.steps])


if __name__ == "__main__":
    asyncio.run(main())
