from dataclasses import dataclass
from parley.api import action


@dataclass(frozen=True)
class Battery:
    share: float


@action(phrases=("report the battery", "check the battery level"), effects=("speaks",), timeout_s=5)
async def report_battery(ctx) -> Battery:
    """Report how full the battery is."""
    ctx.operator.tell(f"My battery is at {ctx.robot.battery() or 0:.0%}.")
    return Battery(ctx.robot.battery() or 0)
