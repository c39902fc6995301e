/** How a robot fares, in one word. */
import { useLive, useWorld } from '@/live/store';
import type { PlanView, ProposalView, RobotView } from '@/live/types';

export type Mood = 'away' | 'stopped' | 'waiting' | 'paused' | 'running' | 'idle' | 'unknown';

/** In these a plan goes on only when a person has said something. */
const NEEDS: readonly PlanView['state'][] = ['held', 'awaiting_approval'];

interface Seen {
  robots: Readonly<Record<string, RobotView>>;
  plans: Readonly<Record<string, PlanView>>;
  proposals: Readonly<Record<string, ProposalView>>;
}

export function moodOf(name: string, { robots, plans, proposals }: Seen): Mood {
  const robot = robots[name];
  if (robot?.connection !== 'here') return 'away';
  if (robot.state === 'stopped' || robot.stop.state !== 'none') return 'stopped';
  const waits =
    Object.values(plans).some((plan) => plan.robot === name && NEEDS.includes(plan.state)) ||
    Object.values(proposals).some((proposal) => proposal.robot === name);
  // A step that asks has nobody else to go on with.
  const open = Object.values(plans).flatMap((plan) => (plan.robot === name ? plan.steps : []));
  const asks = open.some((step) => step.state === 'waiting') && !open.some((step) => step.state === 'running');
  if (robot.state === 'running' ? asks : waits) return 'waiting';
  // What an earlier process of it left does not run, and is not over.
  const isKept = robot.state === 'idle' && Object.values(plans).some((plan) => plan.robot === name && plan.state === 'paused');
  if (isKept) return 'paused';
  return robot.state === 'leaving' ? 'unknown' : robot.state;
}

/** How a robot fares now; not known while this page is not connected. */
export function useMood(name: string): Mood {
  const mood = useWorld((world) => moodOf(name, world));
  const lost = useLive((live) => live.connection === 'lost');
  return lost ? 'unknown' : mood;
}
