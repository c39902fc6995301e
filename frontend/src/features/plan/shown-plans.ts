/** Which plans there are to look at, in which order. Plain functions. */
import type { PlanView, ProposalView, RobotView } from '@/live/types';
import { planKey } from '@/live/world';

/** Every robot's plan, then whatever else it is doing; robots in alphabetical order. */
export function shownPlans(
  plans: Readonly<Record<string, PlanView>>,
  robots: Readonly<Record<string, RobotView>>,
): readonly PlanView[] {
  const all = Object.values(plans);
  const planned = new Set(all.filter((plan) => plan.kind === 'plan').map((plan) => plan.robot));
  const idle = Object.keys(robots)
    .filter((name) => !planned.has(name))
    .map(idlePlan);
  return [...all, ...idle].sort(
    (a, b) =>
      a.robot.localeCompare(b.robot) || rank(a) - rank(b) || a.graph_name.localeCompare(b.graph_name),
  );
}

/** The plan to show: the picked one while it exists, else the own plan of the first robot spoken to. */
export function pickPlan(plans: readonly PlanView[], picked: string, chosen: readonly string[]): PlanView | null {
  return (
    plans.find((plan) => planKey(plan) === picked) ??
    plans.find((plan) => plan.robot === chosen[0]) ??
    plans[0] ??
    null
  );
}

/** What of a robot waits for a yes. */
export function proposalsOf(
  proposals: Readonly<Record<string, ProposalView>>,
  robot: string,
): readonly ProposalView[] {
  return Object.values(proposals).filter((proposal) => proposal.robot === robot);
}

function idlePlan(robot: string): PlanView {
  return { robot, graph_name: '', kind: 'plan', state: 'idle', revision: 0, steps: [], changed: [] };
}

const rank = (plan: PlanView) => (plan.kind === 'plan' ? 0 : 1);
